"""Phases of sticking, sliding and separation: phases, stops, bursts and settling."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import choice, positive
from ..records import checked
from ..records.variables import STATUS_WORDS
from .signals import checked_intervals, record_of_one

SMOOTHING = 5e-3
SHORTEST_STOP = 20e-3
# A status with a smaller share of a sample may result from rounding.
ROUND_OFF = 1e-9


def phases(run: xr.Dataset, status: str, smoothing: float = SMOOTHING) -> Array:
    """Return the intervals in which one status prevails.

    The share of the status is averaged over a centred window; it prevails where the average exceeds one half, so
    that interruptions shorter than half the window do not end a phase and its ends do not move.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    status : {"separated", "sticking", "sliding"}
        Status of the contact.
    smoothing : float, optional
        Length of the window [s].

    Returns
    -------
    ndarray, shape (phases, 2)
        Starts and ends [s].
    """
    choice("status", status, STATUS_WORDS)
    positive("smoothing", smoothing)
    share = record_of_one(run, "status_share")["status_share"].values[:, STATUS_WORDS.index(status)]
    time, interval = _clock(run)
    width = max(1, 2 * round(smoothing / interval / 2.0) + 1)
    prevails = moving_mean(share, width) > 0.5
    edges = np.flatnonzero(np.diff(np.concatenate([[False], prevails, [False]])))
    return np.asarray(time[0] + interval * (edges.reshape(-1, 2) - 1.0))


def stops(run: xr.Dataset, shortest: float = SHORTEST_STOP) -> Array:
    """Return the intervals in which the tip sticks for at least `shortest` seconds, shape (stops, 2) [s].

    An interruption shorter than 2.5 ms does not end a stop (see `phases`).
    """
    positive("shortest", shortest)
    found = phases(run, "sticking")
    return found[found[:, 1] - found[:, 0] >= shortest]


def bursts(run: xr.Dataset, shortest_stop: float = SHORTEST_STOP) -> Array:
    """Return the intervals from the end of a stop to the start of the next one, shape (bursts, 2) [s]."""
    found = stops(run, shortest_stop)
    return np.stack([found[:-1, 1], found[1:, 0]], axis=1) if len(found) > 1 else np.empty((0, 2))


def complete(intervals: Array, run: xr.Dataset) -> Array:
    """Return the intervals that are not cut by an end of the record, shape (intervals, 2) [s]."""
    time, interval = _clock(run)
    intervals = checked_intervals(intervals)
    inside = (intervals[:, 0] > time[0] - interval / 2.0) & (intervals[:, 1] < time[-1] - interval / 2.0)
    return intervals[inside]


def status_share(run: xr.Dataset, status: str, intervals: Array | None = None) -> float:
    """Return the share of the time in which the contact has a status [1], in the intervals or the whole run."""
    choice("status", status, STATUS_WORDS)
    share = record_of_one(run, "status_share")["status_share"].values[:, STATUS_WORDS.index(status)]
    chosen = share if intervals is None else share[inside(run, intervals)]
    return float(np.mean(chosen)) if chosen.size else float("nan")


def settling_time(run: xr.Dataset) -> float:
    """Return the time [s] from which the contact slides at every step to the end; NaN if it does not end sliding."""
    time, interval = _clock(run)
    slides = (
        record_of_one(run, "status_share")["status_share"].values[:, STATUS_WORDS.index("sliding")] >= 1.0 - ROUND_OFF
    )
    if not slides[-1]:
        return float("nan")
    others = np.flatnonzero(~slides)
    return float(time[others[-1]]) if others.size else float(time[0] - interval)


def longest_unchanged(run: xr.Dataset) -> float:
    """Return the longest time [s] during which the status does not change."""
    _, interval = _clock(run)
    share = record_of_one(run, "status_share")["status_share"].values
    pure = np.where(share.max(axis=1) >= 1.0 - ROUND_OFF, share.argmax(axis=1), -1)
    changes = np.flatnonzero(np.diff(pure)) + 1
    starts = np.concatenate([[0], changes])
    lengths = np.diff(np.concatenate([starts, [pure.size]]))[pure[starts] >= 0]
    return float(lengths.max(initial=0) * interval)


def advance(run: xr.Dataset, intervals: Array | None = None) -> float:
    """Return the net displacement of the contact point along the track [m], in the intervals or the whole run.

    In space it is the distance between its first and last positions.
    """
    position = record_of_one(run, "contact_position")["contact_position"].values
    time, _ = _clock(run)
    if position.ndim == 2:
        return float(np.linalg.norm([_advanced(time, one, intervals) for one in position.T]))
    return _advanced(time, position, intervals)


def _advanced(time: Array, position: Array, intervals: Array | None) -> float:
    if intervals is None:
        return float(position[-1] - position[0])
    ends = np.interp(checked_intervals(intervals), time, position)
    return float(np.sum(ends[:, 1] - ends[:, 0]))


def inside(run: xr.Dataset, intervals: Array) -> Array:
    """Return whether each sample lies in one of the intervals, shape (time,) of bool."""
    time, interval = _clock(run)
    middle = time - interval / 2.0
    chosen = np.zeros(time.size, dtype=bool)
    for first, last in checked_intervals(intervals):
        chosen |= (middle > first) & (middle < last)
    return chosen


def moving_mean(values: Array, width: int) -> Array:
    """Return the mean over an odd number of samples around each, with the signal mirrored at both ends.

    So a record may end anywhere in a fast cycle of stick and slip: the shares of its statuses near the end stay those
    of the cycle.
    """
    half = width // 2
    if half > values.size:
        return np.full(values.size, values.mean())
    mirrored = np.concatenate([values[:half][::-1], values, values[values.size - half :][::-1]])
    sums = np.cumsum(np.concatenate([[0.0], mirrored]))
    return np.asarray(sums[width:] - sums[:-width]) / width


def repeated_ends(values: Array, before: int, after: int) -> Array:
    """Return values with the first repeated `before` times and the last `after` times."""
    whole = np.empty(before + values.size + after, dtype=values.dtype)
    whole[:before], whole[before : before + values.size] = values[0], values
    whole[before + values.size :] = values[-1]
    return whole


def _clock(run: xr.Dataset) -> tuple[Array, float]:
    """Return the times of the samples and the interval between them [s]."""
    time = checked.record("run", run, least=2)["time"].values
    return time, float((time[-1] - time[0]) / (time.size - 1))
