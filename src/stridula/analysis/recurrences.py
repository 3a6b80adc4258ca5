"""Recurrences: the time after which events return, however a record is cut."""

from __future__ import annotations

import numpy as np

from ..arrays import Array

# Largest number of events in a pattern that recurs.
LONGEST_PATTERN = 6
# Times are alike if they deviate by at most the first value [1], or the second one if events are known only to the
# nearest sample; the third is the share of times that must be alike.
ALIKE, COARSE, MOST = 0.1, 0.5, 0.8
# Smallest number of events that can recur.
FEWEST = 3
# A pause longer than this multiple of the median time separates two series of events.
GAP = 2.5


def recurrence(events: Array) -> tuple[float, float]:
    """Return the period after which events recur, and the share of them that do; NaN and 0 if they do not recur.

    Events recur after m of them, with m the smallest number for which most times from the end of each event to the end
    of the m-th after it are alike. The period is the mean of those that are, so that a few missing or additional events
    do not change it. Times over a long rest, as between bursts of events, do not count.

    Parameters
    ----------
    events : ndarray, shape (events, 2)
        Starts and ends of the events, in order [samples].
    """
    ends = events[:, 1]
    if len(events) < FEWEST:
        return float("nan"), 0.0
    is_gap = events[1:, 0] - ends[:-1] > GAP * np.median(np.diff(ends))
    series = np.concatenate([[0], np.cumsum(is_gap)])
    for count in range(1, min(LONGEST_PATTERN, len(events) - 2) + 1):
        apart = (ends[count:] - ends[:-count])[series[count:] == series[:-count]]
        if apart.size < FEWEST - 1:
            break
        about = _alike(apart, float(np.median(apart)))
        alike = _alike(apart, float(apart[about].mean())) if about.any() else about
        if alike.mean() >= MOST:
            return float(apart[alike].mean()), float(alike.mean())
    return float("nan"), 0.0


def _alike(apart: Array, middle: float) -> Array:
    """Return which times are alike, to the nearest sample."""
    return np.abs(apart - middle) <= max(ALIKE * middle, min(1.0, COARSE * middle))
