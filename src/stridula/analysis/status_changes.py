"""Changes of the status of a contact, between samples and within them, and its last rest."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from .phases import ROUND_OFF, repeated_ends

MIXED = -1


def whole_status(share: Array) -> Array:
    """Return the status of each sample that is entirely in one status, `MIXED` for the others.

    Parameters
    ----------
    share : ndarray, shape (samples, 3)
        Share of each status in each sample.
    """
    found = np.full(len(share), MIXED)
    # If several apply, the one with the lowest number is kept.
    for status in (2, 1, 0):
        found[share[:, status] >= 1.0 - ROUND_OFF] = status
    return found


def last_rest(status: Array) -> int:
    """Return the first sample of the last stretch of one status, or the number of samples if an earlier one was longer.

    A stretch shorter than an earlier one is one phase among many.

    Parameters
    ----------
    status : ndarray, shape (samples,)
        Status of each sample.
    """
    if status[-1] == MIXED:
        return status.size
    firsts = _begun(status[1:] != status[:-1])
    lengths = np.where(status[firsts] == MIXED, 0, _lengths(firsts, status.size))
    return int(firsts[-1]) if lengths[-1] == lengths.max() else status.size


def changes(status: Array) -> int:
    """Return the least number of changes of status that explains the samples.

    A sample of mixed status has one change if its neighbours have different statuses, else two.

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


def slips(sticking: Array, noise: float, fastest: float) -> Array:
    """Return the intervals in which a contact slips, or opens, between two stick phases.

    A sample that sticks for a share of its interval slips next to the neighbour that sticks less. A slip that follows
    within `fastest` belongs to the same slip if the stick between is chatter: shorter than a quarter of `fastest`, and
    than a quarter of the sticks that make up half of the time of sticking.

    Parameters
    ----------
    sticking : ndarray, shape (samples,)
        Share of sticking in each sample.
    noise : float
        Longest stick, and longest slip, that is ignored [samples].
    fastest : float
        Shortest time from the end of a slip to the end of the next [samples].

    Returns
    -------
    ndarray, shape (slips, 2)
        Starts and ends [samples]; the last may be cut by the end.
    """
    sticks, lengths = _joined(*_pieces(sticking))
    sticks, lengths = _joined(sticks & (lengths > noise), lengths)
    ends, moves = np.cumsum(lengths), np.flatnonzero(~sticks)
    if not moves.size:
        return np.empty((0, 2))
    found = _beside((ends - lengths)[moves], ends[moves])
    firsts = _firsts(found, fastest, min(fastest, prevailing(lengths[sticks])) / 4.0)
    return _merged(found, firsts)[np.add.reduceat(lengths[moves], firsts) > noise]


def vibrations(found: Array, fastest: float) -> Array:
    """Return slips, merging those that end within `fastest` of the previous one, however long the stick between them.

    Parameters
    ----------
    found : ndarray, shape (slips, 2)
        Starts and ends, as returned by `slips`.
    fastest : float
        Shortest time from the end of a vibration to the end of the next, in the unit of `found`.
    """
    return _merged(found, _firsts(found, fastest, np.inf)) if len(found) else found


def _firsts(found: Array, fastest: float, longest: float) -> Array:
    """Return the slips separated from the previous one by a long stick, or by the distance of their ends."""
    stuck, period = found[1:, 0] - found[:-1, 1], found[1:, 1] - found[:-1, 1]
    return _begun((stuck >= longest) | (period >= fastest))


def _merged(found: Array, firsts: Array) -> Array:
    """Return slips merged from each of `firsts` to the last before the next of them."""
    lasts = firsts + _lengths(firsts, len(found)) - 1
    return _beside(found[firsts, 0], found[lasts, 1])


def _pieces(sticking: Array) -> tuple[Array, Array]:
    """Return three pieces of time of each sample: whether they stick, and their lengths [samples].

    Successive samples that stick, or slip, for their whole interval count as one.
    """
    mixed = (sticking > 0.0) & (sticking < 1.0)
    firsts = _begun(mixed[1:] | (sticking[1:] != sticking[:-1]))
    share, size = sticking[firsts], _lengths(firsts, sticking.size)[:, None]
    beside = repeated_ends(share, 1, 1)
    before, after = beside[:-2], beside[2:]
    level = before == after
    slips_amid = level & (share <= before)
    sticks = _beside((before > after) | slips_amid, level & ~slips_amid, (before < after) | slips_amid)
    inner = np.where(level, np.where(slips_amid, 1.0 - share, share), 0.0)
    first = np.where(level, (1.0 - inner) / 2.0, np.where(before > after, share, 1.0 - share))
    return sticks.ravel(), (_beside(first, inner, 1.0 - first - inner) * size).ravel()


def _beside(*columns: Array) -> Array:
    """Return columns side by side, shape (rows, columns)."""
    found = np.empty((columns[0].size, len(columns)), dtype=columns[0].dtype)
    for number, column in enumerate(columns):
        found[:, number] = column
    return found


def _begun(changes: Array) -> Array:
    """Return the first index, and the indices of changes from the previous entry."""
    begun = np.empty(changes.size + 1, dtype=bool)
    begun[0], begun[1:] = True, changes
    return begun.nonzero()[0]


def _lengths(firsts: Array, end: int) -> Array:
    """Return the distance from each of `firsts` to the next, and from the last to `end`."""
    found = np.empty(firsts.size, dtype=firsts.dtype)
    found[:-1], found[-1] = firsts[1:], end
    return found - firsts


def _joined(sticks: Array, lengths: Array) -> tuple[Array, Array]:
    """Return pieces of time with successive ones of a kind merged, and without empty ones."""
    kept = lengths > ROUND_OFF
    sticks, lengths = sticks[kept], lengths[kept]
    firsts = _begun(sticks[1:] != sticks[:-1])
    return sticks[firsts], np.add.reduceat(lengths, firsts)


def prevailing(lengths: Array) -> float:
    """Return the length such that longer ones make up half of the sum of all, infinite if there are none.

    Parameters
    ----------
    lengths : ndarray, shape (lengths,)
        Lengths.
    """
    if not lengths.size:
        return float("inf")
    ordered = np.sort(lengths)[::-1]
    return float(ordered[np.searchsorted(np.cumsum(ordered), 0.5 * ordered.sum())])


def regularity(places: Array) -> float:
    """Return the regularity of the distances between places, ``1 / (1 + (deviation / mean)²)``; NaN for fewer than two.

    It is 1 for equal distances and one half for random places.

    Parameters
    ----------
    places : ndarray, shape (places,)
        Places of events, in order.
    """
    distances = np.diff(places)
    return float(1.0 / (1.0 + (distances.std() / distances.mean()) ** 2)) if distances.size > 1 else float("nan")
