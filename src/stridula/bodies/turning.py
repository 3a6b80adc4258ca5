"""Bodies that turn about their axis, seen from a frame at rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, count, counted, finite, instance
from ..histories import HISTORIES, Constant, History


@dataclass(frozen=True, repr=False)
class Turning:
    """Rotation of the pairs of modes of a body that turns about its axis.

    The two modes of a pair, a quarter of a wave apart, are oscillators in the material. Seen from a frame at rest, the
    pair is carried round with the material; due to Coriolis forces the waves lag behind it where they move along the
    surface (Bryan 1890).

    Parameters
    ----------
    velocity : float
        Angular velocity about the axis, counter-clockwise with the axis pointing at the viewer [rad/s].
    pairs : sequence of pairs of int
        Numbers of the two modes of each pair; the second is the first turned by a quarter of a wave.
    order : sequence of int
        Number of waves round the axis of each pair, n.
    drag : sequence of float
        Phase by which the waves of each pair turn for one radian of the body [1]: n less the share of Coriolis forces.
    history : Constant, Ramp, Harmonic or Sampled, optional
        Factor on the angular velocity over time.

    Raises
    ------
    ValueError
        If an argument is out of its range or does not fit the others.
    """

    velocity: float
    pairs: Any
    order: Any
    drag: Any
    history: History = field(default_factory=Constant)

    def __post_init__(self) -> None:
        object.__setattr__(self, "velocity", finite("velocity", self.velocity))
        instance("history", self.history, HISTORIES)
        pairs = _each("pairs", self.pairs)
        for number, pair in enumerate(pairs):
            if len(_each(f"pairs[{number}]", pair)) != 2:
                raise ArgumentError(f"pairs[{number}]", "be the numbers of two modes", pair)
        object.__setattr__(self, "pairs", tuple((_number(first), _number(second)) for first, second in pairs))
        numbers = [number for pair in self.pairs for number in pair]
        if len(set(numbers)) < len(numbers):
            raise ArgumentError("pairs", "have each mode once", self.pairs)
        for name in ("order", "drag"):
            values = [finite(f"{name}[{k}]", one) for k, one in enumerate(_each(name, getattr(self, name)))]
            if len(values) != len(self.pairs):
                raise ArgumentError(name, f"have one number for each pair, {len(self.pairs)}", got=len(values))
            object.__setattr__(self, name, tuple(values))

    def __repr__(self) -> str:
        return f"Turning({self.velocity!r} rad/s, {counted(len(self.pairs), 'pair')} of modes)"

    def angles(self, time: Array, step: float) -> Array:
        """Return the angles turned between consecutive times, a step apart [rad]."""
        if self.history.settled == 0.0:
            # Avoids the rounding of differences of times.
            return np.asarray(step * self.rate(time[1:]))
        return np.asarray(self.velocity * np.diff(self.history.integral(time)))

    def rate(self, time: Array) -> Array:
        """Return the angular velocity [rad/s]."""
        return np.asarray(self.velocity * self.history.factor(time))


def _number(given: Any) -> int:
    return count("pairs", int(given) if float(given).is_integer() else given, low=0)


def _each(name: str, given: Any) -> Any:
    if isinstance(given, (str, bytes)) or not isinstance(given, (Sequence, np.ndarray)):
        raise ArgumentError(name, "be a list", given)
    return given
