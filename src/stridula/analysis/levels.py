"""Strength and steadiness of a recorded force."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import positive, within
from .signals import blocks, pieces, samples


def peak_level(signal: xr.DataArray, percentile: float = 99.9, window: float = 1e-3) -> float:
    """Return a percentile of a signal's maxima over successive windows, in its own unit.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,)
        A recorded signal.
    percentile : float, optional
        Percentile, from 0 to 100.
    window : float, optional
        Length of a window [s].
    """
    within("percentile", percentile, 0.0, 100.0)
    values, interval = samples(signal)
    return float(np.percentile(blocks(values, positive("window", window), interval).max(axis=1), percentile))


def largest_jump(signal: xr.DataArray, rate: float = 10e3) -> float:
    """Return the largest change between successive means of a signal over ``1 / rate`` s, in its own unit."""
    values, interval = samples(signal)
    means = blocks(values, 1.0 / positive("rate", rate), interval).mean(axis=1)
    return float(np.abs(np.diff(means)).max(initial=0.0))


def swing(signal: xr.DataArray, intervals: Array) -> float:
    """Return the median over the intervals of peak-to-peak value over mean [1]; NaN without intervals."""
    values, _ = samples(signal)
    chosen = pieces(signal, values, intervals)
    ratios = [np.ptp(piece) / abs(piece.mean()) if piece.any() else 0.0 for piece in chosen]
    return float(np.median(ratios)) if ratios else float("nan")
