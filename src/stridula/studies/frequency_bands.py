"""Bands of frequency, in which modes of many systems are counted together."""

from __future__ import annotations

import numpy as np

from ..arrays import Array


def edges_between(frequencies: Array, gap: float) -> Array:
    """Return the edges [Hz] of bands: in the middle of all gaps between frequencies that are wide enough.

    Parameters
    ----------
    frequencies : ndarray, shape (modes,)
        Frequencies [Hz] in any order.
    gap : float
        Width of a gap, relative to the frequency above it [1].
    """
    rising = np.sort(frequencies)
    low, high = rising[:-1], rising[1:]
    wide = high - low > gap * high
    return 0.5 * (low + high)[wide]


def bands_of(frequencies: Array, edges: Array) -> Array:
    """Return the number of the band of each frequency; a frequency on an edge belongs to the band above."""
    return np.searchsorted(edges, frequencies, side="right")
