"""How a drive's amplitude goes in time: a factor on its stated value, and its integral."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .bodies.modes import Array
from .checks import finite, positive


class History(Protocol):
    """A factor over time t [s] from the start of the run; vectorised over t."""

    def factor(self, time: Array) -> Array:
        """Return the factor [1]."""
        ...

    def integral(self, time: Array) -> Array:
        """Return its integral from 0 [s]."""
        ...

    @property
    def settled(self) -> float | None:
        """Time [s] from which it no longer varies, None if it always does."""
        ...


@dataclass(frozen=True)
class Constant:
    """The stated value from the start to the end."""

    @property
    def settled(self) -> float:
        """Time [s] from which it no longer varies: 0."""
        return 0.0

    def factor(self, time: Array) -> Array:
        """Return 1."""
        return np.ones_like(time)

    def integral(self, time: Array) -> Array:
        """Return the time."""
        return np.array(time, dtype=float)


@dataclass(frozen=True)
class Ramp:
    """A straight rise from zero to the stated value, which then stays.

    Parameters
    ----------
    duration : float
        Length of the rise [s].
    """

    duration: float

    def __post_init__(self) -> None:
        positive("duration", self.duration)

    @property
    def settled(self) -> float:
        """Time [s] from which it no longer varies: the end of the rise."""
        return self.duration

    def factor(self, time: Array) -> Array:
        """Return ``min(t / duration, 1)``."""
        return np.clip(time / self.duration, 0.0, 1.0)

    def integral(self, time: Array) -> Array:
        """Return the area under the factor."""
        risen = np.clip(time, 0.0, self.duration)
        return risen**2 / (2.0 * self.duration) + np.maximum(time - self.duration, 0.0)


@dataclass(frozen=True)
class Harmonic:
    """A sine about a mean: ``mean + amplitude sin(2 pi frequency t + phase)`` times the stated value.

    Parameters
    ----------
    frequency : float
        Frequency [Hz].
    amplitude, mean : float, optional
        Amplitude and mean of the factor [1].
    phase : float, optional
        Phase at t = 0 [rad].
    """

    frequency: float
    amplitude: float = 1.0
    mean: float = 0.0
    phase: float = 0.0

    def __post_init__(self) -> None:
        positive("frequency", self.frequency)
        for name in ("amplitude", "mean", "phase"):
            finite(name, getattr(self, name))

    @property
    def settled(self) -> float | None:
        """None, since it always varies, unless its amplitude is 0."""
        return None if self.amplitude else 0.0

    def factor(self, time: Array) -> Array:
        """Return the mean plus the sine."""
        return self.mean + self.amplitude * np.sin(self._angle(time))

    def integral(self, time: Array) -> Array:
        """Return the integral of mean and sine."""
        swing = (np.cos(self.phase) - np.cos(self._angle(time))) / (2.0 * np.pi * self.frequency)
        return self.mean * time + self.amplitude * swing

    def _angle(self, time: Array) -> Array:
        return 2.0 * np.pi * self.frequency * time + self.phase


@dataclass(frozen=True)
class Sampled:
    """Any history given at points in time, straight between them, level before the first and after the last.

    Parameters
    ----------
    time : tuple of float
        Times [s], rising, from 0 on.
    value : tuple of float
        Factors at those times [1].
    """

    time: tuple[float, ...]
    value: tuple[float, ...]

    def __post_init__(self) -> None:
        for name in ("time", "value"):
            numbers = getattr(self, name)
            if isinstance(numbers, str) or not isinstance(numbers, Iterable):
                raise ValueError(f"{name} must be a sequence of numbers, got {numbers!r}")
            checked = tuple(finite(f"{name}[{k}]", number) for k, number in enumerate(numbers))
            object.__setattr__(self, name, checked)
        if len(self.time) < 2 or len(self.time) != len(self.value):
            raise ValueError(
                f"time and value must have the same length, at least 2, got {len(self.time)} and {len(self.value)}"
            )
        if self.time[0] < 0.0 or np.any(np.diff(self.time) <= 0.0):
            raise ValueError(f"time must rise from 0 or above, got {self.time!r}")

    @property
    def settled(self) -> float:
        """Time [s] from which it no longer varies: its last."""
        return self.time[-1]

    def factor(self, time: Array) -> Array:
        """Return the interpolated value."""
        return np.interp(time, self.time, self.value)

    def integral(self, time: Array) -> Array:
        """Return the area under the interpolated value from 0."""
        knots = np.concatenate([[0.0], self.time]) if self.time[0] > 0.0 else np.array(self.time)
        values = self.factor(knots)
        areas = np.concatenate([[0.0], np.cumsum(np.diff(knots) * (values[1:] + values[:-1]) / 2.0)])
        piece = np.clip(np.searchsorted(knots, time, side="right") - 1, 0, knots.size - 1)
        return areas[piece] + (time - knots[piece]) * (values[piece] + self.factor(time)) / 2.0


HISTORIES = (Constant, Ramp, Harmonic, Sampled)
