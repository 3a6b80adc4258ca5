"""The axis about which a track turns, and places around it."""

from __future__ import annotations

import math
from typing import NamedTuple

from ..arrays import Array


class Axis(NamedTuple):
    """The axis about which a track turns.

    Attributes
    ----------
    origin : ndarray, shape (3,)
        A point on it [m].
    first, second : ndarray, shape (3,)
        Unit vectors across it, towards the angle zero and a quarter turn counter-clockwise from there.
    sense : float
        1 if the track turns counter-clockwise, -1 if clockwise.
    """

    origin: Array
    first: Array
    second: Array
    sense: float

    def around(self, place: Array) -> tuple[float, float]:
        """Return the distance of a place from the axis [m] and its angle about it [rad]."""
        arm = place - self.origin
        x, y = float(arm @ self.first), float(arm @ self.second)
        return math.hypot(x, y), math.atan2(y, x)
