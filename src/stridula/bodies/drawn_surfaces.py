"""Outer surfaces of bodies in space for drawing: polygons, and the mode shapes at their corners."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, counted, listed

# Least number of angles at which a surface of revolution is drawn, and angles per wave.
FEWEST_ANGLES, ANGLES_OF_WAVE = 60, 5


@dataclass(frozen=True, eq=False, repr=False)
class DrawnSurface:
    """The surface of a body as polygons.

    Attributes
    ----------
    place : ndarray, shape (points, 3)
        World places of the corners at rest [m].
    polygons : ndarray of int, shape (polygons, corners)
        Corners of each, counter-clockwise about its outward normal.
    shapes : ndarray, shape (points, 3, modes)
        World displacement of each corner for unit modes [kg^(-1/2)].
    """

    place: Array
    polygons: Array
    shapes: Array

    def __repr__(self) -> str:
        return f"DrawnSurface({counted(len(self.polygons), 'polygon')}, {counted(self.shapes.shape[-1], 'mode')})"

    @property
    def swept(self) -> DrawnSurface:
        """Itself, as it is made of polygons."""
        return self

    @property
    def at_rest(self) -> DrawnSurface:
        """The surface without modes."""
        return replace(self, shapes=self.shapes[..., :0])

    @property
    def normals(self) -> Array:
        """Outward unit normals of the polygons at rest, shape (polygons, 3); zero for one without an area."""
        corners = self.place[self.polygons]
        # Relative to a corner the products do not cancel.
        apart = corners - corners[:, :1]
        vectors = np.cross(apart, np.roll(apart, -1, axis=1)).sum(axis=1)
        size = np.linalg.norm(vectors, axis=1, keepdims=True)
        return np.asarray(vectors / np.where(size > 0.0, size, 1.0))


@dataclass(frozen=True, eq=False, repr=False)
class DrawnRings:
    """The surface of a body of revolution, given by its outline, to be swept round the axis.

    Attributes
    ----------
    place : ndarray, shape (points, 2)
        r and z of the corners of the outline [m].
    sides : ndarray of int, shape (sides, 2)
        Corners of its sides, with the profile to their left.
    shapes : ndarray, shape (points, 3, modes)
        Amplitudes along r, theta and z of each corner for unit modes [kg^(-1/2)].
    orders, phases : ndarray of int, shape (modes,)
        Number of waves round the axis, and whether a mode varies as their cosine, 0, or their sine, 1.
    frame : ndarray, shape (3, 3)
        World components of the directions theta = 0 and theta = 90 degrees and of the axis.
    origin : ndarray, shape (3,)
        World place of the point of the axis where z is 0 [m].
    """

    place: Array
    sides: Array
    shapes: Array
    orders: Array
    phases: Array
    frame: Array
    origin: Array

    def __repr__(self) -> str:
        return f"DrawnRings({counted(len(self.sides), 'side')}, {counted(self.shapes.shape[-1], 'mode')})"

    @property
    def at_rest(self) -> DrawnSurface:
        """Polygons of the surface without modes."""
        still = np.zeros(1, dtype=int)
        return replace(self, shapes=np.zeros((len(self.place), 3, 1)), orders=still, phases=still).swept.at_rest

    @property
    def swept(self) -> DrawnSurface:
        """Polygons of the surface, with five or more angles for each wave round the axis."""
        count = max(FEWEST_ANGLES, ANGLES_OF_WAVE * int(self.orders.max()))
        angles = 2.0 * np.pi * np.arange(count) / count
        first, second, axial = self.frame
        cosine, sine = np.cos(angles)[:, None], np.sin(angles)[:, None]
        radial, across = cosine * first + sine * second, cosine * second - sine * first
        (r, z), (u, v, w) = self.place.T[:, :, None, None], self.shapes.transpose(1, 0, 2)[:, :, None]
        turned = np.multiply.outer(angles, self.orders)
        along = np.where(self.phases == 0, np.cos(turned), np.sin(turned))
        askew = np.where(self.phases == 0, np.sin(turned), -np.cos(turned))
        shapes = np.einsum("pam,ad->padm", u * along, radial) + np.einsum("pam,ad->padm", v * askew, across)
        shapes += np.einsum("pam,d->padm", w * along, axial)
        here, there = np.arange(count), np.roll(np.arange(count), -1)
        start, end = (count * corner[:, None] for corner in self.sides.T)
        polygons = np.stack([start + here, start + there, end + there, end + here], axis=2).reshape(-1, 4)
        on_axis = self.place[self.sides][..., 0].max(axis=1) <= 0.0
        return DrawnSurface(
            (self.origin + r * radial + z * axial).reshape(-1, 3),
            polygons[~np.repeat(on_axis, count)],
            shapes.reshape(len(self.place) * count, 3, -1),
        )


Drawn = DrawnSurface | DrawnRings


def is_drawn(body: Any) -> bool:
    """Return whether the surface of a body is known, without computing it."""
    return hasattr(type(body), "drawn") and getattr(body, "is_drawn", True)


def drawn_table(drawn: Drawn) -> dict[str, Array]:
    """Return a surface as arrays by name, shapes in single precision, with a row for each direction of a corner."""
    found = {one.name: np.asarray(getattr(drawn, one.name)) for one in fields(drawn)}
    return {**found, "shapes": found["shapes"].reshape(3 * len(drawn.place), -1).astype(np.float32)}


def drawn_of(values: Mapping[str, Any], modes: int) -> Drawn:
    """Return a surface from arrays or lists by name, as `drawn_table` gives them.

    Raises
    ------
    ValueError
        If arrays are missing, or their shapes do not match each other or the number of modes.
    """
    given = {name: np.asarray(value, dtype=float) for name, value in values.items() if value is not None}
    kind: Any = DrawnSurface if "polygons" in given else DrawnRings
    names = [one.name for one in fields(kind)]
    if set(names) != set(given):
        raise ArgumentError("drawn", f"have {listed(names)}", got=listed(given))
    rows = len(given["place"])
    corners = given["polygons" if kind is DrawnSurface else "sides"]
    wanted: dict[str, tuple[int, ...]] = {
        "place": (rows, 3 if kind is DrawnSurface else 2),
        "shapes": (3 * rows, modes),
    }
    wanted |= {"orders": (modes,), "phases": (modes,), "frame": (3, 3), "origin": (3,)}
    for name, shape in wanted.items():
        if name in given and (given[name].shape != shape or not np.isfinite(given[name]).all()):
            raise ArgumentError(f"drawn.{name}", f"be finite numbers of the shape {shape}", got=given[name].shape)
    if corners.ndim != 2 or not corners.size or not np.isin(corners, np.arange(rows)).all():
        raise ArgumentError("drawn", f"name corners from 0 to {rows - 1}", got=f"{corners.shape}")
    for name in {"polygons", "sides", "orders", "phases"} & set(given):
        given[name] = given[name].astype(int)
    given["shapes"] = given["shapes"].reshape(rows, 3, modes)
    found: Drawn = kind(**given)
    return found
