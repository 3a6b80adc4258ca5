"""A rectangular plate given by its exact modes: simply supported along its edges, rigid or elastic in its plane."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, ClassVar

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, at_least, at_most, count, finite, instance, positive, within, within_a_turn
from ...doubtful import doubts_of_size, warn_of
from ...ordinary import check_first_modes, check_mode_count, of_ordinary_size
from ..body_surfaces import HIGHEST, PointSurface, largest_part
from ..damping import DampingLaw, check_damping_count, checked_damping, damping_rates
from ..drawn_lines import places_between
from ..modes import Modes
from ..paths import Path, Waves, along_one_angle
from ..planes import InPlane, checked_plane
from ..points import BodyPoint
from ..sections import SHORTEST_WAVE, Material
from .plane_stress import PlaneStress, lowest, plane_stress, rigid
from .prism_surfaces import cells_of, plate_mesh, prism_surface

# Largest sine or cosine of a right angle due to rounding.
ALONG_AN_EDGE = 1e-15
FROM_0 = "two whole numbers of at least 0, along length and width, not both 0"


@dataclass(frozen=True)
class Line:
    """A straight line on a plate, along which a contact slides: abscissa s is ``origin + s (cos, sin)``.

    Parameters
    ----------
    origin : tuple of float
        Point of abscissa 0: its distances along length and width from the plate's corner [m].
    direction : float, optional
        Angle from the plate's length to the line [rad], towards its width.
    """

    origin: tuple[float, float]
    direction: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "origin", _pair("origin", self.origin))
        within_a_turn("direction", self.direction)

    @property
    def tangent(self) -> tuple[float, float]:
        """Unit vector along the line, along length and width of the plate."""
        cosine, sine = math.cos(self.direction), math.sin(self.direction)
        # Exact zeros where the line lies along an edge.
        return (0.0 if abs(cosine) < ALONG_AN_EDGE else cosine), (0.0 if abs(sine) < ALONG_AN_EDGE else sine)

    def point(self, abscissa: float | Array) -> tuple[Any, Any]:
        """Return the point of the plate at an abscissa [m], along length and width."""
        (x, y), (cosine, sine) = self.origin, self.tangent
        return x + abscissa * cosine, y + abscissa * sine


@dataclass(frozen=True)
class ModalPlate(InPlane):
    """A thin rectangular plate in its exact modes, bending modes first, each kind by increasing frequency.

    Kirchhoff, simply supported along its edges: ``w = sin(m pi x / length) sin(n pi y / width)`` and
    ``w_mn = pi² ((m / length)² + (n / width)²) sqrt(D / rho h)`` with ``D = E h³ / 12 (1 - nu²)``; modal mass
    ``rho h length width / 4`` (Leissa 1969, Vibration of Plates). Bodies slide on it along a line: world x is along the
    line, world y along the plate's normal, towards the slider.

    In its own plane it is rigid, or, with `in_plane`, elastic in plane stress, its edges held along their normals and
    free along themselves: ``u = A sin(kx x) cos(ky y)`` along the length,
    ``v = B cos(kx x) sin(ky y)`` along the width, with ``(kx, ky) = (m pi / length, n pi / width)``. Longitudinal modes
    have ``(A, B)`` along ``(kx, ky)`` and ``w = c_L |k|``, ``c_L² = E / rho (1 - nu²)``; shear modes, with m and n of
    at least 1, have it along ``(ky, -kx)`` and ``w = c_T |k|``, ``c_T² = E / 2 rho (1 + nu)``. Modal mass
    ``rho h length width / 4`` for unit ``(A, B)``, twice that where m or n is 0 (Xing & Liu 2009, Int. J. Mech. Sci.
    51, 246-255). Contacts are in the middle plane: normal forces do not stretch it, and friction does not bend it.

    Parameters
    ----------
    material : Material
        Material, including its Poisson's ratio.
    thickness, length, width : float
        Thickness and sides [m].
    bending_modes : tuple of int, optional
        Numbers of half-waves kept along the length and along the width; each pair of them is a bending mode.
    damping : float, sequence of float, Rayleigh, RisingDamping or SampledDamping, optional
        Damping ratio of every mode [1], from 0 to 1 (1 excluded), one for each mode in their order (bending as in
        `numbers`, then in the plane as in `in_plane_numbers`), or a law of their frequency.
    cutoff : float, optional
        Keep all the modes up to this frequency [Hz] instead of `bending_modes` and `in_plane_modes`.
    line : Line, optional
        Line along which bodies slide on it; along its length through the middle of its width, from the edge, if left
        out.
    name : str, optional
        Name in records; distinguishes equal bodies.
    in_plane : bool, optional
        Whether it is elastic in its plane; else it is rigid there.
    in_plane_modes : tuple of int, optional
        Largest numbers of half-waves along the length and along the width of the modes in the plane, counted from 0;
        not both 0. Each pair of numbers is a longitudinal mode and, where neither is 0, a shear mode.
    plane : sequence, optional
        Unit vectors along its line and along its normal, [[x, y, z], [x, y, z]], for a plate in space; they replace
        world x and y above.

    Raises
    ------
    ValueError
        If an argument is out of its range, if no mode of a requested kind lies below `cutoff`, or if the line does not
        cross the plate.
    """

    kind: ClassVar[str] = "modal plate"
    point_names: ClassVar[tuple[str, ...]] = ("centre",)
    has_positions: ClassVar[bool] = True
    has_translation: ClassVar[bool] = True
    has_surface: ClassVar[bool] = True
    material: Material
    thickness: float
    length: float
    width: float
    bending_modes: tuple[int, int] = (12, 12)
    damping: float | Sequence[float] | DampingLaw = 0.0
    cutoff: float | None = None
    line: Line | None = None
    name: str = ""
    in_plane: bool = False
    in_plane_modes: tuple[int, int] = (6, 6)
    plane: Sequence[Sequence[float]] | None = None

    @of_ordinary_size("material, thickness, length and width")
    def __post_init__(self) -> None:
        instance("material", self.material, Material)
        for side in ("thickness", "length", "width"):
            positive(side, getattr(self, side))
        words = "two whole numbers of at least 1, along length and width"
        object.__setattr__(self, "bending_modes", _pair("bending_modes", self.bending_modes, count, words))
        instance("in_plane", self.in_plane, bool)
        object.__setattr__(self, "in_plane_modes", _pair("in_plane_modes", self.in_plane_modes, _count_from_0, FROM_0))
        if not any(self.in_plane_modes):
            raise ArgumentError("in_plane_modes", f"be {FROM_0}", self.in_plane_modes)
        object.__setattr__(self, "damping", checked_damping(self.damping))
        if self.plane is not None:
            object.__setattr__(self, "plane", checked_plane("plane", self.plane))
        instance("name", self.name, str)
        if self.cutoff is not None:
            check_first_modes((2.0 * math.pi * self._frequency(1, 1),), positive("cutoff", self.cutoff))
            self._check_cutoff(positive("cutoff", self.cutoff) * (1.0 + 1e-12))
        check_damping_count(self.damping, sum(self.harmonics))
        if self.line is not None:
            instance("line", self.line, Line)
            self._check_line(self.line)
        warn_of(doubts_of_size(self.largest_side))

    @property
    def thick_from(self) -> float:
        """Frequency [Hz] from which it has waves of bending shorter than six thicknesses, or infinity."""
        found = 2.0 * math.pi / (SHORTEST_WAVE * self.thickness) ** 2 * math.sqrt(self.rigidity / self.surface_density)
        return found if float(self._frequency(*self.numbers.T).max()) > found else math.inf

    @property
    def largest_side(self) -> float:
        """Larger of length and width [m]."""
        return max(self.length, self.width)

    @property
    def dimensions(self) -> str:
        """Size in words."""
        return f"{self.length:.4g} m x {self.width:.4g} m x {self.thickness:.4g} m"

    @property
    def posture(self) -> str:
        """Orientation in words: empty, as tracks lie along world x."""
        return ""

    @property
    def centre(self) -> BodyPoint:
        """The point in the middle of the plate."""
        return BodyPoint(self, (self.length / 2.0, self.width / 2.0))

    def at(self, position: float | tuple[float, float]) -> BodyPoint:
        """Return the point at an abscissa of the line [m], or at distances along length and width [m]."""
        return BodyPoint(self, position if isinstance(position, (int, float)) else _pair("position", position))

    def check_position(self, position: Any) -> None:
        """Raise ValueError if `position`, an abscissa or a pair [m], is not on the plate."""
        if not isinstance(position, tuple):
            within("position", position, *self.ends)
        elif not self._holds(*_pair("position", position)):
            corner = f"({at_most(self.length)}, {at_most(self.width)})"
            raise ArgumentError("position", f"be on the plate, from (0, 0) to {corner}", position)

    @property
    def track_line(self) -> Line:
        """The line along which bodies slide on it."""
        return self.line or Line((0.0, self.width / 2.0))

    @property
    def ends(self) -> tuple[float, float]:
        """Abscissas at which the line enters and leaves the plate [m]."""
        return _ends(self, self.track_line)

    @property
    def drawn_places(self) -> Array:
        """Abscissas of the line at which it is drawn, as a cut along it [m], four for each half-wave of bending."""
        # Along the line the highest wavenumber of a product of two sines is the sum of theirs.
        highest = float((self.wavenumbers @ np.abs(self.track_line.tangent)).max())
        low, high = self.ends
        return places_between(self.ends, math.ceil(4.0 * highest * (high - low) / math.pi))

    def abscissa(self, position: float | tuple[float, float]) -> float:
        """Return the abscissa of the point of the line nearest to a position [m]."""
        if not isinstance(position, tuple):
            return position
        return float(np.subtract(position, self.track_line.origin) @ np.array(self.track_line.tangent))

    def offset(self, position: float | tuple[float, float]) -> Array:
        """Return the place at rest of a position relative to that of abscissa 0 of its line [m], shape (3,)."""
        return np.asarray(np.subtract(self._point(position), self.track_line.origin) @ self.frame[:2])

    @property
    def rigidity(self) -> float:
        """Bending stiffness ``D = E h³ / 12 (1 - nu²)`` [N m]."""
        return self.material.young * self.thickness**3 / (12.0 * (1.0 - self.material.poisson**2))

    @property
    def surface_density(self) -> float:
        """Mass per area ``rho h`` [kg/m²]."""
        return self.material.density * self.thickness

    @property
    def total_mass(self) -> float:
        """Mass [kg]."""
        return self.surface_density * self.length * self.width

    @property
    def amplitude(self) -> float:
        """Largest value of a mass-normalised bending shape [kg^(-1/2)], ``sqrt(4 / rho h length width)``."""
        return float(np.sqrt(4.0 / self.total_mass))

    @property
    def harmonics(self) -> tuple[int, int]:
        """Numbers of bending modes and of modes in the plane kept."""
        return len(self.numbers), len(self.in_plane_numbers)

    @property
    def numbers(self) -> Array:
        """Numbers (m, n) of half-waves of each bending mode along length and width, shape (bending modes, 2)."""
        return _numbers(self)

    @property
    def wavenumbers(self) -> Array:
        """Wavenumbers (m pi / length, n pi / width) of each bending mode [rad/m], shape (bending modes, 2)."""
        return np.asarray(self.numbers * (np.pi / np.array([self.length, self.width])))

    @property
    def in_plane_numbers(self) -> Array:
        """Numbers (m, n) of half-waves of each mode in the plane along length and width, shape (in-plane modes, 2)."""
        return _in_plane(self).numbers

    @property
    def polarisations(self) -> Array:
        """Unit vectors (A, B) of each mode in the plane, shape (in-plane modes, 2).

        Along ``(m / length, n / width)`` for a longitudinal mode, along ``(n / width, -m / length)`` for a shear mode.
        """
        return _in_plane(self).polarisations

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes; `held_x` is for bodies with a driven root and must be false."""
        if held_x:
            raise ArgumentError("held_x", "be False for a ModalPlate: its edges are fixed", held_x)
        return _modes(self)

    def shapes(self, x: Any, y: Any) -> Array:
        """Return the mass-normalised shapes of the bending modes at points of the plate.

        Parameters
        ----------
        x, y : array_like, shape (...)
            Distances along length and width from the corner [m].

        Returns
        -------
        ndarray, shape (..., bending modes)
            Displacement along the normal for unit modes [kg^(-1/2)].
        """
        along, across = self.wavenumbers.T
        x, y = np.asarray(x, dtype=float)[..., None], np.asarray(y, dtype=float)[..., None]
        return np.asarray(self.amplitude * np.sin(along * x) * np.sin(across * y))

    def in_plane_shapes(self, x: Any, y: Any) -> Array:
        """Return the mass-normalised shapes of the modes in the plane at points of the plate.

        Parameters
        ----------
        x, y : array_like, shape (...)
            Distances along length and width from the corner [m].

        Returns
        -------
        ndarray, shape (..., 2, in-plane modes)
            Displacements along length and width for unit modes [kg^(-1/2)].
        """
        sheet = _in_plane(self)
        along, across = sheet.wavenumbers
        x, y = np.asarray(x, dtype=float)[..., None], np.asarray(y, dtype=float)[..., None]
        shapes = [np.sin(along * x) * np.cos(across * y), np.cos(along * x) * np.sin(across * y)]
        return np.asarray(sheet.amplitudes * np.stack(shapes, axis=-2) / math.sqrt(self.total_mass))

    def trace(self, position: Any, held_x: bool = False) -> Array:
        """Return the rows that give the displacement at `position` from the modes.

        Parameters
        ----------
        position : float or tuple of float
            Abscissa of the line, or distances along length and width [m].
        held_x : bool, optional
            Without effect.

        Returns
        -------
        ndarray, shape (2, modes) or (3, modes)
            Displacements along the line and along the normal, with a plane along world x, y and z, for unit modes
            [kg^(-1/2)].
        """
        x, y = self._point(position)
        bending, in_plane = self.harmonics
        rows = np.zeros((2, bending + in_plane))
        rows[1, :bending] = self.shapes(x, y)
        rows[0, bending:] = np.array(self.track_line.tangent) @ self.in_plane_shapes(x, y)
        return self.in_the_world(rows)

    def path(self) -> Path:
        """Return the path along which other bodies slide.

        Modes are products of sines and cosines of the angles along both sides. On a line along a side the angle across
        it is constant, so that one sine remains.
        """
        (x, y), direction = self.track_line.origin, np.array(self.track_line.tangent)
        sides = np.array([self.length, self.width])
        rate, phase = np.pi / sides * direction, np.pi / sides * [x, y]
        numbers, in_plane, (u, v) = self.numbers, self.in_plane_numbers, self.in_plane_shares
        for side in (0, 1):
            if rate[1 - side] == 0.0:
                across, there = phase[1 - side], (rate[[side, 1 - side]], phase[[side, 1 - side]])
                bending = along_one_angle(numbers[:, side], self.amplitude * np.sin(numbers[:, 1 - side] * across))
                moved = (u, v)[side] * np.cos(in_plane[:, 1 - side] * across)
                return Path(self.ends, *there, bending, along_one_angle(in_plane[:, side], moved))
        bending = Waves(numbers, np.tile([0.0, self.amplitude], (len(numbers), 1)), cosines=True)
        return Path(self.ends, rate, phase, bending, Waves(in_plane, np.stack([u, v], axis=1)))

    @property
    def frame(self) -> Array:
        """World components of the directions along its length and width and along its normal, shape (3, 3)."""
        cosine, sine = self.track_line.tangent
        line, across, normal = super().frame
        return np.array([cosine * line - sine * across, sine * line + cosine * across, normal])

    def surface(self, frequency: float = HIGHEST) -> PointSurface:
        """Return the outer surface as points, fine enough for sound up to a frequency [Hz], and how modes move it.

        Both faces and the edges; abscissa 0 of its line, in its middle plane, is the origin of the world.
        """
        return _surface(self, largest_part(frequency))

    @property
    def in_plane_shares(self) -> Array:
        """Coefficients of the products of sines S and cosines C, of kx x times of ky y, in each mode in the plane.

        Displacement along the line is ``shares[0] S C + shares[1] C S`` [kg^(-1/2)]; shape (2, in-plane modes).
        """
        direction = np.array(self.track_line.tangent)[:, None]
        return np.asarray(direction * _in_plane(self).amplitudes / math.sqrt(self.total_mass))

    def _point(self, position: Any) -> tuple[float, float]:
        """Return the distances along length and width [m] of an abscissa or a pair."""
        self.check_position(position)
        return position if isinstance(position, tuple) else self.track_line.point(position)

    def _frequency(self, m: Any, n: Any) -> Any:
        squared = (m / self.length) ** 2 + (n / self.width) ** 2
        return 0.5 * np.pi * squared * math.sqrt(self.rigidity / self.surface_density)

    def _check_cutoff(self, highest: float) -> None:
        first = self._frequency(1, 1)
        if highest < first:
            raise ArgumentError(
                "cutoff",
                f"leave at least one mode (first at {at_least(first)} Hz)",
                self.cutoff,
                got=f"{self.cutoff!r} Hz",
            )
        first = lowest(self.material, self.length, self.width)
        if self.in_plane and highest < first:
            raise ArgumentError(
                "cutoff",
                f"leave at least one mode in the plane where in_plane is true (first at {at_least(first)} Hz)",
                self.cutoff,
                got=f"{self.cutoff!r} Hz",
            )

    def _holds(self, x: float, y: float) -> bool:
        return 0.0 <= x <= self.length and 0.0 <= y <= self.width

    def _check_line(self, line: Line) -> None:
        if not self._holds(*line.origin):
            raise ArgumentError("line", "have its origin on the plate", line)
        low, high = _ends(self, line)
        x, y = line.point((low + high) / 2.0)
        if not (high > low and 0.0 < x < self.length and 0.0 < y < self.width):
            raise ArgumentError("line", "cross the plate inside its edges", line)


def _count_from_0(name: str, value: Any) -> int:
    return count(name, value, low=0)


def _pair(
    name: str,
    values: Any,
    check: Callable[[str, Any], Any] = finite,
    words: str = "two finite distances, along length and width",
) -> tuple[Any, Any]:
    try:
        first, second = values if isinstance(values, (tuple, list)) else ()
        return check(name, first), check(name, second)
    except ValueError:
        raise ArgumentError(name, f"be {words}", values) from None


def _ends(plate: ModalPlate, line: Line) -> tuple[float, float]:
    low, high = -math.inf, math.inf
    for start, rate, side in zip(line.origin, line.tangent, (plate.length, plate.width), strict=True):
        if rate:
            first, second = sorted((-start / rate, (side - start) / rate))
            low, high = max(low, first), min(high, second)
    # Turns -0.0 into 0.0.
    return low + 0.0, high + 0.0


@lru_cache(maxsize=16)
def _numbers(plate: ModalPlate) -> Array:
    if plate.cutoff is None:
        most = plate.bending_modes
    else:
        # Half-waves at the cutoff with waves along one side alone.
        waves = math.sqrt(2.0 * plate.cutoff / (math.pi * math.sqrt(plate.rigidity / plate.surface_density)))
        most = (int(waves * plate.length) + 1, int(waves * plate.width) + 1)
    check_mode_count(math.prod(most), plate.cutoff)
    m, n = (numbers.ravel() for numbers in np.meshgrid(*(np.arange(1, k + 1) for k in most), indexing="ij"))
    frequency = plate._frequency(m, n)
    order = np.argsort(frequency, kind="stable")
    if plate.cutoff is not None:
        order = order[frequency[order] <= plate.cutoff * (1.0 + 1e-12)]
    numbers = np.stack([m[order], n[order]], axis=1)
    numbers.flags.writeable = False
    return numbers


@lru_cache(maxsize=16)
def _in_plane(plate: ModalPlate) -> PlaneStress:
    if not plate.in_plane:
        return rigid(plate.length, plate.width)
    return plane_stress(plate.material, plate.length, plate.width, plate.in_plane_modes, plate.cutoff)


@lru_cache(maxsize=16)
@of_ordinary_size("material, thickness, length and width")
def _modes(plate: ModalPlate) -> Modes:
    m, n = plate.numbers.T
    # The integral of rho h sin sin over the plate: only odd half-waves move on average.
    mean = (1.0 - (-1.0) ** m) / (m * np.pi) * (1.0 - (-1.0) ** n) / (n * np.pi)
    translation = np.zeros((2, sum(plate.harmonics)))
    translation[1, : len(m)] = plate.total_mass * plate.amplitude * mean
    # In the plane, only those whose cosine has no half-wave.
    sheet = _in_plane(plate)
    along, across = sheet.numbers.T
    moved = sheet.amplitudes * [_mean_of_sine(along) * (across == 0), _mean_of_sine(across) * (along == 0)]
    translation[0, len(m) :] = math.sqrt(plate.total_mass) * (np.array(plate.track_line.tangent) @ moved)
    angular = 2.0 * np.pi * np.concatenate([plate._frequency(m, n), sheet.frequency])
    return Modes(
        angular, damping_rates(plate.damping, angular, plate.material.loss_factor), plate.in_the_world(translation)
    )


def _mean_of_sine(half_waves: Array) -> Array:
    return np.asarray((1.0 - (-1.0) ** half_waves) / (np.maximum(half_waves, 1) * np.pi))


@lru_cache(maxsize=4)
def _surface(plate: ModalPlate, largest: float) -> PointSurface:
    bending, in_plane = plate.harmonics
    most = np.concatenate([plate.numbers, plate.in_plane_numbers]).max(axis=0)
    sides, frame = (plate.length, plate.width), plate.frame

    def moved(places: Array) -> Array:
        x, y, _ = places.T
        found = np.zeros((len(places), 3, bending + in_plane))
        found[:, :2, bending:] = plate.in_plane_shapes(x, y)
        found[:, 2, :bending] = plate.shapes(x, y)
        return np.einsum("aw,nam->nwm", frame, found)

    mesh = plate_mesh(sides, plate.thickness, (cells_of(most[0]), cells_of(most[1])))
    return prism_surface(mesh, frame, -np.array([*plate.track_line.origin, 0.0]) @ frame, moved, largest)
