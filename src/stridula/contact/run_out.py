"""The shape of a turning track's surface: its height over the angle about its axis."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, count, finite, instance, positive, rising
from ..columns import read_rising
from ..declared import Each, Number, check_declared
from .axes import along_circle
from .profile import Profile

TURN = 2.0 * math.pi
# Difference from a whole turn that is due to rounding [rad]: angles in degrees have a few digits.
ROUND_OFF = 1e-6
# Points of the shortest wave.
POINTS_OF_WAVE = 128
# Fewest points of a table, and the longest arc without one, relative to the longest between two others.
FEWEST, OPEN = 4, 2.0


@dataclass(frozen=True)
class RunOut:
    """Height of the surface of a turning track over the angle about its axis: wobble, thickness variation, hot spots.

    A periodic cubic spline through the points. It turns with the track: where the track turns at :math:`\\Omega`, a
    fixed point at the angle :math:`\\theta` sees the height at :math:`\\theta - \\Omega t`.

    Parameters
    ----------
    angle : sequence of float
        Angles about the axis of the track, in its material at the start, at which the height is given [rad], rising
        over one turn. If the last one is not the first a turn later, the first height closes the turn.
    height : sequence of float
        Height at each, towards the face that slides [m].

    Raises
    ------
    ValueError
        If angles do not increase or do not go round, the numbers of entries differ, or heights differ a turn later.

    Examples
    --------
    >>> wobble = st.RunOut.waves({1: 20e-6, 2: 5e-6})
    >>> print(f"{float(wobble.height_at(0.0)):.3g} m")
    2.5e-05 m
    """

    angle: Annotated[Sequence[float], Each(Number("rad"))]
    height: Annotated[Sequence[float], Each(Number("m"))]

    def __post_init__(self) -> None:
        check_declared(self)
        if len(self.angle) < FEWEST:
            raise ArgumentError("angle", f"have {FEWEST} values or more", self.angle, got=str(len(self.angle)))
        rising("angle", self.angle)
        if len(self.height) != len(self.angle):
            words = f"have as many values as angle, {len(self.angle)}"
            raise ArgumentError("height", words, got=str(len(self.height)))
        self._close()

    def _close(self) -> None:
        """End the table with its first height a turn later."""
        angles, heights = list(self.angle), list(self.height)
        left = angles[0] + TURN - angles[-1]
        if left < -ROUND_OFF:
            got = f"{angles[-1] - angles[0]:.6g} rad from the first to the last"
            raise ArgumentError("angle", "be within one turn, 2 pi (6.28319 rad)", got=got)
        if left > ROUND_OFF:
            if left > OPEN * float(np.diff(angles).max()):
                got = f"{angles[-1] - angles[0]:.6g} rad from the first to the last"
                raise ArgumentError("angle", "go round one turn, 2 pi (6.28319 rad)", got=got)
            angles, heights = [*angles, angles[0] + TURN], [*heights, heights[0]]
        angles[-1] = angles[0] + TURN
        # The profile refuses heights that differ a turn later.
        whole = Profile(angles, heights, periodic=True)
        object.__setattr__(self, "angle", tuple(angles))
        object.__setattr__(self, "height", tuple(whole.height))

    @classmethod
    def read(
        cls,
        path: str | Path,
        columns: Sequence[str | int] = (0, 1),
        *,
        angle_unit: float = 1.0,
        height_unit: float = 1.0,
    ) -> RunOut:
        """Read the heights of one turn from a text file, such as a CSV.

        Parameters
        ----------
        path : str or Path
            File with a line for each angle; values are separated by commas, semicolons, tabs or blanks. A first line
            may name the columns; lines that begin with ``#`` are skipped. Lines need not be in order.
        columns : sequence, optional
            Columns of angle and height, by name or by number from 0.
        angle_unit, height_unit : float, optional
            Units in the file, such as 0.017453292519943295 for degrees and 1e-6 for µm [rad, m].

        Raises
        ------
        ValueError
            If the file has no such table; the message names file and line.
        """
        if len(columns) != 2:
            raise ArgumentError("columns", "be two, of angle and height", columns)
        angles, heights = read_rising(path, columns)
        try:
            angles = angles * positive("angle_unit", angle_unit)
            return cls(angles.tolist(), (heights * finite("height_unit", height_unit)).tolist())
        except ArgumentError as error:
            raise error.inside(str(path)) from None

    @classmethod
    def waves(cls, amplitude: Mapping[int, float], phase: Mapping[int, float] | None = None) -> RunOut:
        """Return a sum of waves, ``amplitude cos(order angle + phase)``: order 1 is a wobble.

        Parameters
        ----------
        amplitude : mapping of int to float
            Amplitude by order, the number of waves in a turn [m].
        phase : mapping of int to float, optional
            Phase by order [rad], 0 where left out.
        """
        instance("amplitude", amplitude, Mapping)
        phases = dict(phase or {})
        if not amplitude:
            raise ArgumentError("amplitude", "have one order or more", got="none")
        for order in phases:
            if order not in amplitude:
                raise ArgumentError(f"phase[{order!r}]", "be that of an order in amplitude", got=repr(order))
        orders = [count("amplitude, order", order) for order in amplitude]
        angle = np.linspace(0.0, TURN, POINTS_OF_WAVE * max(orders) + 1)
        height = np.zeros(angle.size)
        for order in orders:
            shift = finite(f"phase[{order}]", phases.get(order, 0.0))
            height += finite(f"amplitude[{order}]", amplitude[order]) * np.cos(order * angle + shift)
        return cls(angle.tolist(), [*height[:-1].tolist(), float(height[0])])

    @property
    def highest(self) -> float:
        """Largest height in a turn [m]."""
        return self._profile.highest

    @cached_property
    def _profile(self) -> Profile:
        """Its profile over the angle."""
        return Profile(self.angle, self.height, periodic=True)

    def height_at(self, angle: Array | float) -> Array:
        """Return the height at angles [m]."""
        return self._profile.height_at(angle)

    def around(self, radius: float, sense: float = 1.0) -> Profile:
        """Return its profile along a circle, over the abscissa `sense` times radius times angle.

        Parameters
        ----------
        radius : float
            Radius of the circle [m].
        sense : {1.0, -1.0}, optional
            Direction of the abscissa: with the angle or against it.
        """
        return Profile(*along_circle(self.angle, self.height, radius, sense), periodic=True)
