"""Several contacts as one: their shares of the load, their common status, and their common rest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from .status_changes import MIXED, changes, least_landings, whole_status

# Contacts that carry more than this share of the load decide for all of them. It is above one half, so that two equal
# contacts decide only together.
MAJORITY = 0.55


def loads(forces: Array, rare: float) -> Array:
    """Return the share of the load carried by each contact, zero for contacts with a negligible load.

    Parameters
    ----------
    forces : ndarray, shape (samples, contacts)
        Normal forces [N].
    rare : float
        Share of an equal load [1] below which a contact does not count.

    Returns
    -------
    ndarray, shape (contacts,)
        Shares, which add up to 1; equal shares without any load.
    """
    carried = np.abs(forces).mean(axis=0)
    kept = np.where(carried >= rare * carried.mean(), carried, 0.0)
    total = kept.sum()
    return np.asarray(kept / total) if total > 0.0 else np.full(kept.size, 1.0 / kept.size)


def mean_shares(share: Array, carried: Array) -> Array:
    """Return the shares of the time in each status, weighted by the loads of the contacts, shape (3,).

    Parameters
    ----------
    share : ndarray, shape (samples, contacts, 3)
        Share of each status in each sample.
    carried : ndarray, shape (contacts,)
        Share of the load on each contact, as returned by `loads`.
    """
    return np.asarray(carried @ share.mean(axis=0))


def together(share: Array, carried: Array) -> Array:
    """Return the share of each sample in which contacts with most of the load have a status.

    Parameters
    ----------
    share : ndarray, shape (samples, contacts)
        Share of the status in each sample.
    carried : ndarray, shape (contacts,)
        Share of the load on each contact.
    """
    if carried.size == 1:
        return share[:, 0]
    order = np.argsort(-share, axis=1, kind="stable")
    # The last contact carries the rest, so that rounding of the sum has no effect.
    enough = np.cumsum(carried[order], axis=1)[:, :-1] > MAJORITY
    last = np.where(enough.any(axis=1), enough.argmax(axis=1), carried.size - 1)
    samples = np.arange(len(share))
    return np.asarray(share[samples, order[samples, last]])


def statuses(share: Array, carried: Array) -> Array:
    """Return the whole status of each contact that counts in each sample, `MIXED` in others.

    Parameters
    ----------
    share : ndarray, shape (samples, contacts, 3)
        Share of each status in each sample.
    carried : ndarray, shape (contacts,)
        Share of the load on each contact.

    Returns
    -------
    ndarray, shape (contacts that count, samples)
        Statuses.
    """
    return np.array([whole_status(share[:, number]) for number in np.flatnonzero(carried)])


def stretches(found: Array) -> Array:
    """Return a number for each sample that changes with the status of any contact, `MIXED` where one is mixed.

    Parameters
    ----------
    found : ndarray, shape (contacts, samples)
        Statuses.
    """
    numbers = np.zeros(found.shape[1], dtype=int)
    numbers[1:] = np.cumsum((found[:, 1:] != found[:, :-1]).any(axis=0))
    return np.where((found == MIXED).any(axis=0), MIXED, numbers)


def cycles(found: Array, landed: Array) -> float:
    """Return the least number of cycles, of the contact with most changes, that explains the samples.

    Parameters
    ----------
    found : ndarray, shape (contacts, samples)
        Statuses.
    landed : ndarray, shape (contacts,)
        Number of landings of each.
    """
    return max(max(changes(one) / 2.0, float(times)) for one, times in zip(found, landed, strict=True))


def landings_of(landings: Array | None, separated: Array) -> Array:
    """Return the number of landings of each contact, shape (contacts,).

    Parameters
    ----------
    landings : ndarray, shape (samples, contacts), or None
        Landings in each sample [1]; counted from the shares if None.
    separated : ndarray, shape (samples, contacts)
        Share of separation in each sample.
    """
    if landings is None:
        return np.array([float(least_landings(one)) for one in separated.T])
    return np.asarray(landings.sum(axis=0), dtype=float)


def sums(values: Array, members: Sequence[Sequence[int]]) -> list[Array]:
    """Return the sum of a value over the contacts of each group, each of shape (samples,).

    Parameters
    ----------
    values : ndarray, shape (samples, contacts)
        Values.
    members : sequence of sequence of int
        Numbers of the contacts of each group.
    """
    return [values[:, one[0]] if len(one) == 1 else values[:, one].sum(axis=1) for one in members]
