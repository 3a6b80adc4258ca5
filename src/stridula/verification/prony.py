"""Exponents of a motion, from its samples."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..arrays import Array

SLIDING = 2


def only_sliding(run: xr.Dataset) -> None:
    """Raise RuntimeError unless every step of a run slid."""
    if bool((run["status"] != SLIDING).any()):
        raise RuntimeError("the contact must slide all the time")


def exponents(motion: Array, interval: float, unit: float, count: int = 2) -> Array:
    """Return the exponents with positive frequency of samples that are sums of `count` pairs and a constant (Prony).

    Each difference of samples is a linear combination of the 2 `count` before it, the same in all channels; the roots
    of that recurrence are the exponentials over an interval.
    """
    moves = np.diff(motion, axis=0)
    moves /= np.abs(moves).max()
    past = np.stack([moves[k : len(moves) - 2 * count + k] for k in range(2 * count)], axis=-1)
    weights = np.linalg.lstsq(past.reshape(-1, 2 * count), moves[2 * count :].reshape(-1), rcond=None)[0]
    roots = np.roots(np.concatenate([[1.0], -weights[::-1]]))
    found = np.log(roots.astype(complex)) / interval
    found = found[found.imag > 0.0]
    found = found[np.lexsort((-found.imag, -np.round(found.real * unit, 5)))][:count]
    return np.pad(found, (0, count - found.size), constant_values=complex(np.nan, np.nan))
