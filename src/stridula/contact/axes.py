"""The axis about which a track turns, and places around it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from ..arrays import Array
from ..checks import positive

T = TypeVar("T")


def along_circle(
    angle: Sequence[float], values: Sequence[T], radius: float, sense: float
) -> tuple[list[float], list[T]]:
    """Return values at rising angles over the abscissa along a circle, `sense` times radius times angle [m].

    Parameters
    ----------
    angle : sequence of float
        Angles [rad].
    values : sequence
        The value at each.
    radius : float
        Radius of the circle [m].
    sense : {1.0, -1.0}
        Direction of the abscissa: with the angle or against it.
    """
    place = positive("radius", radius) * np.array(angle)
    if sense > 0.0:
        return place.tolist(), list(values)
    return (-place[::-1]).tolist(), list(values[::-1])


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

    def abscissa(self, radius: float, angle: float) -> float:
        """Return the place of a point along its circle, in the sense in which the track turns [m]."""
        return self.sense * radius * angle
