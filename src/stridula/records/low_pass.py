"""Low-pass from the steps of a march to the samples of probes."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from ..arrays import Array

HALF_SPAN = 8
CUTOFF = 0.75
KAISER = 6.2


def reach_of(steps: int) -> int:
    """Return the number of steps on each side that contribute to a sample of `steps` steps."""
    return HALF_SPAN * steps if steps > 1 else 0


@lru_cache(maxsize=32)
def taps_of(steps: int) -> Array:
    """Return the filter for samples of `steps` steps: a Kaiser-windowed sinc, shape (2 reach + 1,)."""
    if steps == 1:
        return np.ones(1)
    reach = reach_of(steps)
    number = np.arange(-reach, reach + 1)
    taps = np.sinc(CUTOFF / steps * number) * np.kaiser(2 * reach + 1, KAISER)
    return np.asarray(taps / taps.sum())


def gain(frequency: Array, steps: int) -> Array:
    """Return the gain of the low-pass, which has no delay, at frequencies over the sample rate."""
    reach = reach_of(steps)
    return np.asarray(np.cos(2.0 * np.pi * np.outer(frequency, np.arange(-reach, reach + 1) / steps)) @ taps_of(steps))
