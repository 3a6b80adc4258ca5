"""The shape of a track's surface: its height over the place, as measured or as a wave."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, count, finite, instance, positive, rising
from ..columns import read_rising
from ..declared import Each, Number, check_declared

# Points of a sine: its curvature is then right to 5e-5.
POINTS_OF_SINE = 256
# Points over a correlation length, and fewest points, of random heights.
POINTS_OF_LENGTH, FEWEST = 8, 16
# Largest number of points in its text.
FEW = 8
# Difference of the heights at both ends of a period, relative to the range, that is due to rounding.
ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Profile:
    """Height of a surface over the place along it: run-out, corrugation, roughness, dips.

    A cubic spline through the points, with a continuous curvature. A periodic profile repeats for ever. Any other is
    flat before its first and after its last point, with a continuous slope; a note in a record says if the tip got
    there. Slopes are small: forces keep the directions of the plane.

    Parameters
    ----------
    place : sequence of float
        Places along the surface at which the height is given [m], rising.
    height : sequence of float
        Height at each, towards the tip [m].
    periodic : bool, optional
        Whether it repeats, as on a wheel or a closed belt; the last point is then the first of the next period.

    Raises
    ------
    ValueError
        If places do not increase, the numbers of entries differ, or the ends of a period have different heights.
    """

    place: Annotated[Sequence[float], Each(Number("m"))]
    height: Annotated[Sequence[float], Each(Number("m"))]
    periodic: bool = False

    def __post_init__(self) -> None:
        check_declared(self)
        instance("periodic", self.periodic, bool)
        least = 4 if self.periodic else 2
        if len(self.place) < least:
            raise ArgumentError("place", f"have {least} values or more", self.place, got=str(len(self.place)))
        rising("place", self.place)
        if len(self.height) != len(self.place):
            words = f"have as many values as place, {len(self.place)}"
            raise ArgumentError("height", words, self.height, got=str(len(self.height)))
        if self.periodic:
            first, last = self.height[0], self.height[-1]
            if abs(last - first) > ROUND_OFF * float(np.ptp(self.height)):
                raise ArgumentError(
                    f"height[{len(self.height) - 1}]", f"be {first!r}, the first one, a period later", last
                )
            object.__setattr__(self, "height", (*self.height[:-1], first))

    def __repr__(self) -> str:
        repeats = ", periodic=True" if self.periodic else ""
        if len(self.place) <= FEW:
            return f"Profile(place={self.place!r}, height={self.height!r}{repeats})"
        heights = f"heights from {min(self.height):.3g} to {max(self.height):.3g} m"
        return (
            f"Profile({len(self.place)} points from {self.place[0]:.4g} to {self.place[-1]:.4g} m, {heights}{repeats})"
        )

    @classmethod
    def read(
        cls,
        path: str | Path,
        columns: Sequence[str | int] = (0, 1),
        *,
        periodic: bool = False,
        place_unit: float = 1.0,
        height_unit: float = 1.0,
    ) -> Profile:
        """Read a profile from a text file, such as a CSV.

        Parameters
        ----------
        path : str or Path
            File with a line for each place; values are separated by commas, semicolons, tabs or blanks. A first line
            may name the columns; lines that begin with ``#`` are skipped. Lines need not be in order.
        columns : sequence, optional
            Columns of place and height, by name or by number from 0.
        periodic : bool, optional
            Whether it repeats.
        place_unit, height_unit : float, optional
            Units in the file, such as 1e-3 for mm and 1e-6 for µm [m].

        Raises
        ------
        ValueError
            If the file has no such table; the message names file and line.
        """
        if len(columns) != 2:
            raise ArgumentError("columns", "be two, of place and height", columns)
        places, heights = read_rising(path, columns)
        try:
            given = (
                places * positive("place_unit", place_unit),
                heights * finite("height_unit", height_unit),
            )
            return cls(given[0].tolist(), given[1].tolist(), periodic)
        except ArgumentError as error:
            raise error.inside(str(path)) from None

    @classmethod
    def sine(cls, amplitude: float, wavelength: float, phase: float = 0.0) -> Profile:
        """Return a wave without end, ``amplitude sin(2 pi place / wavelength + phase)``: corrugation, run-out.

        Parameters
        ----------
        amplitude : float
            Amplitude of the height [m].
        wavelength : float
            Length of a wave [m].
        phase : float, optional
            Phase at place 0 [rad].
        """
        share = np.linspace(0.0, 1.0, POINTS_OF_SINE + 1)
        place = positive("wavelength", wavelength) * share
        height = finite("amplitude", amplitude) * np.sin(2.0 * np.pi * share + finite("phase", phase))
        return cls(place.tolist(), height.tolist(), periodic=True)

    @classmethod
    def random(cls, rms: float, correlation_length: float, length: float, seed: int = 0) -> Profile:
        """Return a rough surface that repeats after a length.

        Its waves have random phases and the spectrum whose autocorrelation is
        ``rms² exp(-(distance / correlation_length)²)``.

        Parameters
        ----------
        rms : float
            Root mean square of the height [m].
        correlation_length : float
            Distance at which the autocorrelation has fallen to 1 / e [m].
        length : float
            Length after which it repeats [m], at least four correlation lengths.
        seed : int, optional
            Seed of the phases.
        """
        positive("correlation_length", correlation_length)
        if positive("length", length) < 4.0 * correlation_length:
            raise ArgumentError(
                "length", f"be at least four correlation lengths, {4.0 * correlation_length!r} m", length
            )
        points = max(FEWEST, int(np.ceil(POINTS_OF_LENGTH * length / correlation_length)))
        waves = np.fft.rfftfreq(points, 1.0 / points)
        size = np.exp(-0.5 * (np.pi * waves * correlation_length / length) ** 2)
        # Neither a mean height nor a wave between the points.
        size[0] = size[-1] = 0.0
        phases = np.random.default_rng(count("seed", seed, low=0)).uniform(0.0, 2.0 * np.pi, waves.size)
        height = np.fft.irfft(size * np.exp(1j * phases), points)
        height *= positive("rms", rms) / np.sqrt(np.mean(height**2))
        place = length * np.arange(points + 1) / points
        return cls(place.tolist(), [*height.tolist(), float(height[0])], periodic=True)

    def height_at(self, place: Array | float) -> Array:
        """Return the height at places along the surface [m]."""
        return self._derived(place, 0)

    def slope_at(self, place: Array | float) -> Array:
        """Return the slope at places along the surface [1]."""
        return self._derived(place, 1)

    def beyond(self, place: Array) -> Array:
        """Return whether places are before the first or after the last point; never on a periodic profile."""
        low, high = self.place[0], self.place[-1]
        return np.asarray(((place < low) | (place > high)) & (not self.periodic))

    @cached_property
    def highest(self) -> float:
        """Largest height of its surface [m]."""
        tops = self._spline.derivative().roots(extrapolate=False)
        return float(self._spline(np.concatenate([self.place, tops[np.isfinite(tops)]])).max())

    @cached_property
    def steepest(self) -> float:
        """Largest slope of its surface [1]."""
        bends = self._spline.derivative(2).roots(extrapolate=False)
        places = np.concatenate([self.place, bends[np.isfinite(bends)]])
        return float(np.abs(self._spline(places, 1)).max())

    @cached_property
    def wavelength(self) -> float:
        """Length of the shortest waves that bend it, infinite if it is straight [m].

        From the largest curvature and its largest change along the surface; of a sine, its wavelength.
        """
        if not np.ptp(self.height):
            return np.inf
        curvature = float(np.abs(self._spline(self.place, 2)).max())
        changes = float(np.abs(self._spline.derivative(3).c).max())
        return float(2.0 * np.pi * curvature / changes)

    @cached_property
    def pieces(self) -> Array:
        """Coefficients of its pieces, those of the powers of the distance from their beginning, (pieces, 4)."""
        return np.ascontiguousarray(self._spline.c[::-1].T)

    @cached_property
    def _spline(self) -> Any:
        # Imported here, as it takes longer than many a run.
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.place, self.height, bc_type="periodic" if self.periodic else "clamped")

    def _derived(self, place: Array | float, order: int) -> Array:
        low, high = self.place[0], self.place[-1]
        there = low + np.mod(place - np.float64(low), high - low) if self.periodic else np.clip(place, low, high)
        return np.asarray(self._spline(there, order))
