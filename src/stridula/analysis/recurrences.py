"""Recurrences: the time after which events return, however a record is cut."""

from __future__ import annotations

import numpy as np

from ..arrays import Array

# Largest number of events in a pattern that recurs.
LONGEST_PATTERN = 6
# Deviation from their median up to which times are alike [1], the largest where events are known to the nearest sample
# only, and the share of times that must be alike.
ALIKE, COARSE, MOST = 0.1, 0.2, 0.8


def period(places: Array) -> float:
    """Return the time after which events recur, NaN if they do not.

    Events recur after m of them, with m the smallest number for which most times from each event to the m-th after it
    are alike. The period is the mean of those that are, so that neither gaps between bursts of events nor a few missing
    or additional ones change it.

    Parameters
    ----------
    places : ndarray, shape (events,)
        Places of the events, in order [samples].
    """
    for count in range(1, min(LONGEST_PATTERN, places.size - 2) + 1):
        apart = places[count:] - places[:-count]
        middle = float(np.median(apart))
        away = np.abs(apart - middle)
        if np.mean(away <= max(ALIKE * middle, min(1.0, COARSE * middle))) >= MOST:
            return float(apart[away <= max(ALIKE * middle, 1.0)].mean())
    return float("nan")
