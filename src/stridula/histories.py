"""Amplitude of a drive over time: a factor on its stated value, its integral and its double integral."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, ClassVar, Protocol

import numpy as np

from .arrays import Array
from .checks import ArgumentError, brief, finite, within_a_turn
from .declared import Angle, Each, Frequency, Number, Ratio, Time, check_declared

# A time this close to a jump, relative to it, counts as that of the jump: steps divide a time exactly only up to
# rounding.
ROUND_OFF = 1e-12
# Largest number of points in the text of a history.
FEW = 8


class History(Protocol):
    """A factor over time t [s] from the start of the run; vectorised over t."""

    def factor(self, time: Array) -> Array:
        """Return the factor [1]."""
        ...

    def integral(self, time: Array) -> Array:
        """Return its integral from 0 [s]."""
        ...

    def second_integral(self, time: Array) -> Array:
        """Return the integral of its integral from 0 [s²]."""
        ...

    @property
    def settled(self) -> float | None:
        """Time [s] from which it is constant, None if it always varies."""
        ...

    kind: ClassVar[str]


@dataclass(frozen=True)
class Constant:
    """The stated value from the start to the end."""

    kind: ClassVar[str] = "constant"

    @property
    def largest(self) -> float:
        """Largest size of the factor."""
        return 1.0

    @property
    def settled(self) -> float:
        """Time [s] from which it is constant: 0."""
        return 0.0

    def factor(self, time: Array) -> Array:
        """Return 1."""
        return np.ones_like(time)

    def integral(self, time: Array) -> Array:
        """Return the time."""
        return np.array(time, dtype=float)

    def second_integral(self, time: Array) -> Array:
        """Return half the square of the time."""
        return np.asarray(time**2 / 2.0)


@dataclass(frozen=True)
class Ramp:
    """A linear rise from zero to the stated value, which then stays constant.

    Parameters
    ----------
    duration : float
        Duration of the linear rise from zero [s].
    """

    kind: ClassVar[str] = "ramp"
    duration: Time

    def __post_init__(self) -> None:
        check_declared(self)

    @property
    def largest(self) -> float:
        """Largest size of the factor."""
        return 1.0

    @property
    def settled(self) -> float:
        """Time [s] from which it is constant: the end of the rise."""
        return self.duration

    def factor(self, time: Array) -> Array:
        """Return ``min(t / duration, 1)``."""
        return np.clip(time / self.duration, 0.0, 1.0)

    def integral(self, time: Array) -> Array:
        """Return the area under the factor."""
        risen = np.clip(time, 0.0, self.duration)
        return risen**2 / (2.0 * self.duration) + np.maximum(time - self.duration, 0.0)

    def second_integral(self, time: Array) -> Array:
        """Return the area under the integral."""
        risen, after = np.clip(time, 0.0, self.duration), np.maximum(time - self.duration, 0.0)
        return np.asarray(risen**3 / (6.0 * self.duration) + after * (self.duration + after) / 2.0)


@dataclass(frozen=True)
class Harmonic:
    """A sine about a mean: ``mean + amplitude sin(2 pi frequency t + phase)`` times the stated value.

    Parameters
    ----------
    frequency : float
        Frequency of the sine [Hz].
    amplitude : float, optional
        Amplitude of the sine, as a factor [1].
    mean : float, optional
        Mean about which it swings, as a factor [1].
    phase : float, optional
        Phase at the start [rad], from -2 pi to 2 pi.
    """

    kind: ClassVar[str] = "harmonic"
    frequency: Frequency
    amplitude: Ratio = 1.0
    mean: Ratio = 0.0
    phase: Angle = 0.0

    def __post_init__(self) -> None:
        check_declared(self)
        within_a_turn("phase", self.phase)

    @property
    def largest(self) -> float:
        """Largest size of the factor."""
        return abs(self.mean) + abs(self.amplitude)

    @property
    def settled(self) -> float | None:
        """None, since it always varies; 0 if its amplitude is 0."""
        return None if self.amplitude else 0.0

    def factor(self, time: Array) -> Array:
        """Return the mean plus the sine."""
        return self.mean + self.amplitude * np.sin(self._angle(time))

    def integral(self, time: Array) -> Array:
        """Return the integral of mean and sine."""
        swing = (np.cos(self.phase) - np.cos(self._angle(time))) / (2.0 * np.pi * self.frequency)
        return self.mean * time + self.amplitude * swing

    def second_integral(self, time: Array) -> Array:
        """Return the integral of the integral: the sine leaves a drift unless it starts as a cosine."""
        angular = 2.0 * np.pi * self.frequency
        swing = (angular * time * np.cos(self.phase) - np.sin(self._angle(time)) + np.sin(self.phase)) / angular**2
        return np.asarray(self.mean * time**2 / 2.0 + self.amplitude * swing)

    def _angle(self, time: Array) -> Array:
        return 2.0 * np.pi * self.frequency * time + self.phase


@dataclass(frozen=True, repr=False)
class Sampled:
    """A history given at points in time, linear between them, constant before the first and after the last.

    Two points at the same time are a jump, from the first to the second. At exactly that time the factor is their mean,
    so that a load sampled at the steps gives the right impulse.

    Parameters
    ----------
    time : tuple of float
        Times [s], rising from 0 on; the same twice at a jump, which must be above 0.
    value : tuple of float
        Factors at those times [1].
    """

    kind: ClassVar[str] = "sampled"
    time: Annotated[tuple[float, ...], Each(Number("s", least=0.0))]
    value: Annotated[tuple[float, ...], Each(Number())]

    def __post_init__(self) -> None:
        for name in ("time", "value"):
            numbers = getattr(self, name)
            if isinstance(numbers, str) or not isinstance(numbers, Iterable):
                raise ArgumentError(name, "be a sequence of numbers", numbers)
            checked = tuple(finite(f"{name}[{k}]", number) for k, number in enumerate(numbers))
            object.__setattr__(self, name, checked)
        if len(self.time) < 2 or len(self.time) != len(self.value):
            raise ArgumentError(
                "time and value", "have the same length, at least 2", got=f"{len(self.time)} and {len(self.value)}"
            )
        self._check_times()

    def __repr__(self) -> str:
        if len(self.time) <= FEW:
            return f"Sampled(time={self.time!r}, value={self.value!r})"
        return f"Sampled({len(self.time)} points from {self.time[0]!r} to {self.time[-1]!r} s)"

    def _check_times(self) -> None:
        times = np.array(self.time)
        if self.time[0] < 0.0:
            raise ArgumentError(
                "time", "start at 0 or above", self.time, got=f"{brief(self.time)}, from {self.time[0]!r}"
            )
        falls = np.flatnonzero(times[1:] < times[:-1]) + 1
        thrice = np.flatnonzero(times[2:] == times[:-2]) + 2
        for allowed, wrong in (("increase", falls), ("have at most two points, a jump, at the same time", thrice)):
            if wrong.size:
                k = int(wrong[0])
                got = f"time[{k}] = {self.time[k]!r} after {self.time[k - 1]!r}"
                raise ArgumentError("time", allowed, self.time, got=f"{brief(self.time)}, with {got}")
        if self.time[1] == 0.0:
            raise ArgumentError("time", "be above 0 at a jump", self.time)

    @property
    def largest(self) -> float:
        """Largest size of the factor."""
        return max(map(abs, self.value))

    @property
    def settled(self) -> float:
        """Time [s] after which it is constant: the last one."""
        return self.time[-1]

    def factor(self, time: Array) -> Array:
        """Return the interpolated value; at a jump the mean of both values."""
        values = np.interp(time, self.time, self.value)
        times, means = self._jumps
        if times.size:
            beyond = np.searchsorted(times, time)
            for near in (np.maximum(beyond - 1, 0), np.minimum(beyond, times.size - 1)):
                values = np.where(np.abs(time - times[near]) <= ROUND_OFF * times[near], means[near], values)
        return np.asarray(values)

    def integral(self, time: Array) -> Array:
        """Return the area under the interpolated value from 0."""
        knots, values, areas, _ = self._sums
        piece, since, now = self._piece(knots, time)
        return np.asarray(areas[piece] + since * (values[piece] + now) / 2.0)

    def second_integral(self, time: Array) -> Array:
        """Return the area under the integral from 0."""
        knots, values, areas, seconds = self._sums
        piece, since, now = self._piece(knots, time)
        return np.asarray(seconds[piece] + since * areas[piece] + since**2 * (2.0 * values[piece] + now) / 6.0)

    @cached_property
    def _jumps(self) -> tuple[Array, Array]:
        """Return the times of the jumps, and the mean of the two values at each."""
        times, values = np.array(self.time), np.array(self.value)
        jumps = np.flatnonzero(times[1:] == times[:-1])
        return times[jumps], (values[jumps] + values[jumps + 1]) / 2.0

    @cached_property
    def _sums(self) -> tuple[Array, Array, Array, Array]:
        """Return the points from 0 on with the integrals up to each."""
        late = self.time[0] > 0.0
        knots = np.array([0.0, *self.time] if late else self.time)
        values = np.array([self.value[0], *self.value] if late else self.value)
        since = np.diff(knots)
        areas = np.concatenate([[0.0], np.cumsum(since * (values[1:] + values[:-1]) / 2.0)])
        grown = since * areas[:-1] + since**2 * (2.0 * values[:-1] + values[1:]) / 6.0
        return knots, values, areas, np.concatenate([[0.0], np.cumsum(grown)])

    def _piece(self, knots: Array, time: Array) -> tuple[Array, Array, Array]:
        """Return the last point before each time, the time since then and the value now; after a jump the second."""
        piece = np.clip(np.searchsorted(knots, time, side="right") - 1, 0, knots.size - 1)
        return piece, time - knots[piece], np.interp(time, self.time, self.value)


HISTORIES = (Constant, Ramp, Harmonic, Sampled)
