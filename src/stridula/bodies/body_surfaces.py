"""The outer surface of a body in space for sound: points, normals, areas and mode shapes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any, ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, counted, listed, positive

# Default highest frequency of sound that surfaces are cut for [Hz], parts of a surface per wavelength, and the speed
# of sound [m/s].
HIGHEST, PARTS_IN_WAVE, SOUND = 24e3, 4.0, 340.0
# Sine of the angle below which points lie in one plane.
FLAT = 1e-6
# Pairs of points whose distances are held at once.
PAIRS_AT_ONCE = 100_000
# Shapes of the fields.
SIZES: dict[str, tuple[Any, ...]] = {
    "points": ("rows", 3),
    "places": ("rows", 2),
    "normals": ("rows", "axes"),
    "areas": ("rows",),
    "widths": ("rows",),
    "shapes": ("rows", "modes"),
    "corners": ("pieces", 12),
    "owners": ("pieces",),
    "orders": ("modes",),
    "sides": ("modes",),
    "frame": (3, 3),
    "origin": (3,),
}
# Fields that may be left out.
OPTIONAL = {"corners", "owners"}
# Points round a body of revolution for one wave of its highest order, and the least number.
POINTS_A_WAVE, LEAST_ROUND = 8, 24


@dataclass(frozen=True, eq=False, repr=False)
class PointSurface:
    """The outer surface of a body as points, each in the middle of a patch.

    Attributes
    ----------
    points : ndarray, shape (points, 3)
        World places [m].
    normals : ndarray, shape (points, 3)
        World components of the outward unit normals.
    areas : ndarray, shape (points,)
        Areas that the points represent [m²].
    shapes : ndarray, shape (points, modes)
        Outward displacement of each point in each mode [kg^(-1/2)]; without residual shapes.
    corners : ndarray, shape (pieces, 12), optional
        World places of the four corners of each flat piece of a patch, one after the other, counter-clockwise about its
        outward normal [m]; the last one twice for a triangle. Squares round the points if left out.
    owners : ndarray of int, shape (pieces,), optional
        Number of the point whose patch each piece belongs to; one piece for each patch if left out.
    """

    form: ClassVar[str] = "points"
    points: Array
    normals: Array
    areas: Array
    shapes: Array
    corners: Array = field(default=None)  # type: ignore[arg-type]
    owners: Array = field(default=None)  # type: ignore[arg-type]

    def __post_init__(self) -> None:
        if self.corners is None:
            object.__setattr__(self, "corners", _squares(self.points, self.normals, self.areas))
        if self.owners is None:
            object.__setattr__(self, "owners", np.arange(len(self.points)))

    def __repr__(self) -> str:
        return f"PointSurface({_size_of(self, 'point')})"

    @property
    def as_points(self) -> PointSurface:
        """The surface as points: itself."""
        return self

    def only(self, modes: Sequence[int]) -> PointSurface:
        """Return the surface with some of its modes, by number."""
        return replace(self, shapes=self.shapes[:, modes])

    def placed(self, frame: Array, origin: Array) -> PointSurface:
        """Return the surface with its axes along the rows of a frame and its origin at a place [m]."""
        corners = self.corners.reshape(-1, 3) @ frame + origin
        return PointSurface(
            self.points @ frame + origin,
            self.normals @ frame,
            self.areas,
            self.shapes,
            corners.reshape(self.corners.shape),
            self.owners,
        )

    @property
    def content(self) -> tuple[bytes, ...]:
        """Content of all arrays, for comparison."""
        return _content(self)


@dataclass(frozen=True, eq=False, repr=False)
class RingSurface:
    """The outer surface of a body of revolution as rings, two close together over each part of its profile.

    Attributes
    ----------
    places : ndarray, shape (rings, 2)
        Radius r and place z along the axis of each ring [m]; rings 2 k and 2 k + 1 are the halves of a part.
    normals : ndarray, shape (rings, 2)
        Outward unit normals along r and z.
    widths : ndarray, shape (rings,)
        Width of the surface that each ring represents [m].
    shapes : ndarray, shape (rings, modes)
        Amplitude of the outward motion of each mode [kg^(-1/2)]; without residual shapes.
    orders, sides : ndarray of int, shape (modes,)
        Number of waves round the axis, and whether a mode varies as their cosine, 0, or their sine, 1.
    frame : ndarray, shape (3, 3)
        World components of the directions theta = 0 and theta = 90 degrees and of the axis.
    origin : ndarray, shape (3,)
        World place of the point of the axis where z is 0 [m].
    """

    form: ClassVar[str] = "rings"
    places: Array
    normals: Array
    widths: Array
    shapes: Array
    orders: Array
    sides: Array
    frame: Array
    origin: Array

    def __repr__(self) -> str:
        return f"RingSurface({_size_of(self, 'ring')})"

    @property
    def content(self) -> tuple[bytes, ...]:
        """Content of all arrays, for comparison."""
        return _content(self)

    def only(self, modes: Sequence[int]) -> RingSurface:
        """Return the surface with some of its modes, by number."""
        return replace(self, shapes=self.shapes[:, modes], orders=self.orders[modes], sides=self.sides[modes])

    def round(self, theta: Array) -> Array:
        """Return the cosine or the sine of each mode at angles [rad], shape (..., modes)."""
        turned = np.multiply.outer(theta, self.orders)
        return np.where(self.sides == 0, np.cos(turned), np.sin(turned))

    @property
    def as_points(self) -> PointSurface:
        """The rings as points."""
        count = max(LEAST_ROUND, POINTS_A_WAVE * int(self.orders.max(initial=0)))
        theta = (np.arange(count) + 0.5) * 2.0 * np.pi / count
        way = np.cos(theta)[:, None] * self.frame[0] + np.sin(theta)[:, None] * self.frame[1]
        (r, z), (across, along) = self.places.T, self.normals.T
        points = self.origin + r[:, None, None] * way + z[:, None, None] * self.frame[2]
        normals = across[:, None, None] * way + along[:, None, None] * self.frame[2]
        areas = np.repeat(2.0 * np.pi / count * r * self.widths, count)
        shapes = self.shapes[:, None] * self.round(theta)
        return PointSurface(points.reshape(-1, 3), normals.reshape(-1, 3), areas, shapes.reshape(len(areas), -1))


BodySurface = PointSurface | RingSurface


def surface_of(values: Mapping[str, Any]) -> BodySurface:
    """Return a surface from its fields by name, as lists or arrays.

    Raises
    ------
    ValueError
        If fields are missing, or shapes do not match.
    """
    given = {name: np.asarray(value, dtype=float) for name, value in values.items() if value is not None}
    kind = RingSurface if "places" in given else PointSurface
    names = [one.name for one in fields(kind)]
    if not set(names) - OPTIONAL <= set(given) <= set(names):
        raise ArgumentError("outer_surface", f"have {listed(names)}", got=f"{listed(given)}")
    for name in ("orders", "sides", "owners"):
        if name in given:
            given[name] = given[name].astype(int)
    found: BodySurface = kind(**given)
    check_surface("outer_surface", found, found.shapes.shape[-1])
    return found


def check_surface(name: str, surface: BodySurface, modes: int) -> None:
    """Raise ValueError unless all numbers of a surface are finite and all shapes match, with that number of modes."""
    for one in fields(surface):
        values = getattr(surface, one.name)
        sizes = {"rows": len(surface.normals), "modes": modes, "pieces": len(getattr(surface, "owners", ()))}
        wanted = tuple(sizes.get(size, size) for size in SIZES[one.name])
        axes = surface.normals.shape[-1:]
        wanted = tuple(axes[0] if size == "axes" else size for size in wanted)
        if values.shape != wanted or not np.isfinite(values).all():
            raise ArgumentError(f"{name}.{one.name}", f"be finite numbers of the shape {wanted}", got=values.shape)
    owners = getattr(surface, "owners", None)
    if owners is not None and not np.array_equal(np.unique(owners), np.arange(len(surface.normals))):
        raise ArgumentError(f"{name}.owners", "have the number of each point, from 0", got=np.unique(owners).tolist())


def _size_of(surface: BodySurface, part: str) -> str:
    rows, modes = np.shape(surface.shapes)
    return f"{counted(rows, part)}, {counted(modes, 'mode')}"


def _content(surface: BodySurface) -> tuple[bytes, ...]:
    return tuple(np.asarray(getattr(surface, one.name), dtype=float).tobytes() for one in fields(surface))


def _squares(points: Array, normals: Array, areas: Array) -> Array:
    """Return the corners of squares round points, in any orientation about their normals."""
    askew = np.eye(3)[np.abs(normals).argmin(axis=1)]
    first = np.cross(normals, askew)
    first /= np.linalg.norm(first, axis=1)[:, None]
    half = 0.5 * np.sqrt(areas)[:, None]
    first, second = half * first, half * np.cross(normals, first)
    return np.concatenate([points + a * first + b * second for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)


def largest_part(frequency: float) -> float:
    """Return the largest length of parts of a surface for sound up to a frequency [Hz], in m."""
    return SOUND / (PARTS_IN_WAVE * positive("frequency", frequency))


def inscribed_radius(points: Array, normals: Array, others: Array) -> Array:
    """Return the radii of the largest balls within a surface that touch it at points [m], shape (points,).

    A ball that touches at x with the normal n and reaches y has the radius ``|x - y|² / (2 n . (x - y))``.

    Parameters
    ----------
    points, normals : ndarray, shape (points, d)
        Points of contact, and the outward unit normals there.
    others : ndarray, shape (others, d)
        Points all over the surface.
    """
    found = np.full(len(points), np.inf)
    at_once = max(1, PAIRS_AT_ONCE // len(others))
    for first in range(0, len(points), at_once):
        part = slice(first, first + at_once)
        depth, square = np.zeros((2, len(points[part]), len(others)))
        for place, normal, other in zip(points[part].T, normals[part].T, others.T, strict=True):
            away = place[:, None] - other
            depth += away * normal[:, None]
            square += away**2
        inside = depth > FLAT * np.sqrt(square)
        radius = square / np.where(inside, 2.0 * depth, 1.0)
        found[part] = np.where(inside, radius, np.inf).min(axis=1)
    return found
