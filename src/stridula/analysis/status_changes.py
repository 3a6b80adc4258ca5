"""How often the status of a contact changes, between samples and within them, and since when it does not."""

from __future__ import annotations

import numpy as np

from ..bodies.modes import Array
from .phases import moving_mean

MIXED = -1


def whole_status(share: Array) -> Array:
    """Return the status of each sample that is wholly in one, `MIXED` for the others.

    Parameters
    ----------
    share : ndarray, shape (samples, 3)
        Share of each status in each sample.
    """
    status = np.where(share[:, 1] == 1.0, 1, np.where(share[:, 2] == 1.0, 2, MIXED))
    return np.where(share[:, 0] == 1.0, 0, status)


def last_rest(status: Array) -> int:
    """Return the first sample of the last stretch of one status, or the number of samples if a longer one came before.

    A stretch that others have outlasted is one phase among many.

    Parameters
    ----------
    status : ndarray, shape (samples,)
        Status of each sample.
    """
    if status[-1] == MIXED:
        return status.size
    ends = np.flatnonzero(status[1:] != status[:-1]) + 1
    edges = np.concatenate([[0], ends, [status.size]])
    lengths = np.where(status[edges[:-1]] == MIXED, 0, np.diff(edges))
    return int(edges[-2]) if lengths[-1] == lengths.max() else status.size


def changes(status: Array) -> int:
    """Return the least number of changes of status that explains the samples.

    A sample of mixed status has one change if those about it are of two statuses, else two: it began and ended alike.

    Parameters
    ----------
    status : ndarray, shape (samples,)
        Status of each sample.
    """
    mixed = status == MIXED
    between = ~mixed[:-2] & mixed[1:-1] & ~mixed[2:] & (status[:-2] != status[2:])
    direct = ~mixed[:-1] & ~mixed[1:] & (status[:-1] != status[1:])
    return int(2 * mixed.sum() - between.sum() + direct.sum())


def least_landings(separated: Array) -> int:
    """Return the least number of landings that explains the shares of separation.

    Parameters
    ----------
    separated : ndarray, shape (samples,)
        Share of separation in each sample.
    """
    before, now = separated[:-1], separated[1:]
    closed = (before > 0.0) & (now == 0.0)
    again = (before > 0.0) & (before < 1.0) & (now > 0.0) & (now < 1.0)
    return int(closed.sum() + again.sum())


def stick_onsets(sticking: Array, width: int) -> Array:
    """Return the samples at which phases of sticking begin, those of a moving mean of the share above one half.

    Parameters
    ----------
    sticking : ndarray, shape (samples,)
        Share of sticking in each sample.
    width : int
        Odd number of samples of the moving mean.
    """
    prevails = moving_mean(sticking, width) > 0.5
    return np.flatnonzero(prevails[1:] & ~prevails[:-1]) + 1


def between_stops(sticking: Array, width: int) -> Array:
    """Return a weight that is 1 between stops and falls to 0 at their edges; 1 throughout if sticking always prevails.

    Parameters
    ----------
    sticking : ndarray, shape (samples,)
        Share of sticking in each sample.
    width : int
        Odd number of samples of the moving mean that tells a stop, and of the fall.
    """
    moves = (moving_mean(sticking, width) < 0.5).astype(float)
    if not moves.any():
        return np.ones(sticking.size)
    inside = np.maximum(2.0 * moving_mean(moves, width) - 1.0, 0.0)
    return np.asarray(inside * inside * (3.0 - 2.0 * inside))


def regularity(places: Array) -> float:
    """Return how regular the distances between places are, ``1 / (1 + (deviation / mean)²)``; NaN for fewer than two.

    It is 1 for equal distances and one half for places thrown at random.

    Parameters
    ----------
    places : ndarray, shape (places,)
        Where events happen, in order.
    """
    distances = np.diff(places)
    return float(1.0 / (1.0 + (distances.std() / distances.mean()) ** 2)) if distances.size > 1 else float("nan")
