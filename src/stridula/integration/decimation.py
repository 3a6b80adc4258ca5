"""Low-pass and decimation of probes, from every step to every sample."""

from __future__ import annotations

from copy import copy

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ..arrays import Array
from ..records.low_pass import reach_of, taps_of


class Decimator:
    """A linear-phase low-pass that keeps one value of every `ratio` steps, with piecewise input.

    A Kaiser-windowed sinc over 16 sample intervals: flat to 0.1 % up to a quarter of the sample rate, -6 dB at 0.75 of
    half of it, more than 60 dB attenuation beyond half of it. The value of a sample is centred at the end of its
    interval, so that the last samples need `lookahead` further steps.

    Parameters
    ----------
    ratio : int
        Steps per sample; no filter at 1.
    before : ndarray, shape (memory, probes), optional
        Values at the last steps before the first input; the first value, repeated, if left out.

    Attributes
    ----------
    last : ndarray, shape (1, probes), or None
        Values at the last step.
    """

    def __init__(self, ratio: int, before: Array | None = None) -> None:
        self.ratio = ratio
        self.reach = reach_of(ratio)
        self.memory = max(self.reach - ratio, 0)
        self.lookahead = self.reach + 1
        self.taps = taps_of(ratio)
        self.last = None if before is None or not before.size else before[-1:]
        self._pending = before
        self._skip = max(ratio - self.reach, 0)

    def feed(self, raw: Array) -> Array:
        """Take values at the next steps and return the completed samples, shape (samples, probes)."""
        if self._pending is None:
            self._pending = np.repeat(raw[:1], self.memory, axis=0)
        if raw.shape[0]:
            self.last = raw[-1:].copy()
        raw, self._skip = raw[self._skip :], max(self._skip - raw.shape[0], 0)
        joined = np.concatenate([self._pending, raw])
        count = max(0, (joined.shape[0] - self.taps.size) // self.ratio + 1)
        self._pending = joined[count * self.ratio :]
        if count == 0:
            return np.empty((count, raw.shape[1]))
        return np.asarray(sliding_window_view(joined, self.taps.size, axis=0)[:: self.ratio] @ self.taps)


class DelayedProbes:
    """Probes on their way through the low-pass, with as many samples as are marched.

    Parameters
    ----------
    ratio : int
        Steps per sample.
    count : int
        Number of probes.

    Attributes
    ----------
    delay : int
        Samples by which they are delayed.
    """

    def __init__(self, ratio: int, count: int) -> None:
        self._low_pass, self._waiting = Decimator(ratio), np.zeros((0, count))
        self.delay = -(-self._low_pass.lookahead // ratio)

    def next(self, raw: Array, samples: int) -> Array:
        """Take values at the next steps and return the next samples, shape (samples, probes).

        The first one, repeated, or zero before the low-pass gives any.
        """
        waiting = np.concatenate([self._waiting, self._low_pass.feed(raw)])
        missing = max(0, samples - len(waiting))
        first = waiting[:1] if len(waiting) else np.zeros((1, waiting.shape[1]))
        waiting = np.concatenate([np.repeat(first, missing, axis=0), waiting])
        self._waiting = waiting[samples:]
        return waiting[:samples]

    def copy(self) -> DelayedProbes:
        """Return the same probes, which continue on their own."""
        other = copy(self)
        other._low_pass = copy(self._low_pass)
        return other
