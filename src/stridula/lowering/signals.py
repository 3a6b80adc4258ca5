"""Signals of a system: functions of time that scale its loads, and the motion imposed on a root."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ..arrays import Array

# A function of times and of the step [s] that returns a value for each time.
Signal = Callable[[Array, float], Array]


@dataclass(frozen=True)
class Signals:
    """Signals of a system.

    Attributes
    ----------
    loads : tuple of callable
        Factors of the loads [1]; the acceleration [m/s²] where an imposed velocity is a load.
    displacement, velocity, acceleration : callable
        Motion along x of the root under an imposed velocity [m, m/s, m/s²], zero without one.
    """

    loads: tuple[Signal, ...]
    displacement: Signal
    velocity: Signal
    acceleration: Signal

    def __iter__(self) -> Iterator[Signal]:
        """Yield all signals in the order of the march: those of the loads, then the imposed motion."""
        yield from (*self.loads, self.displacement, self.velocity, self.acceleration)

    def __len__(self) -> int:
        """Return the number of signals."""
        return len(self.loads) + 3

    def factors(self, times: Array, step: float) -> Array:
        """Return the factors of the loads, shape (loads, times)."""
        return np.array([signal(times, step) for signal in self.loads]).reshape(len(self.loads), times.size)

    def since(self, time: float) -> Signals:
        """Return the same signals with the time counted from `time` [s]."""
        *loads, displacement, velocity, acceleration = (later(signal, time) for signal in self)
        return Signals(tuple(loads), displacement, velocity, acceleration)


def later(signal: Signal, time: float) -> Signal:
    """Return a signal with the time counted from `time` [s]."""
    return lambda times, step: signal(times + time, step)
