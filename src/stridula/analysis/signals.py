"""Recorded signals as plain arrays: samples, pieces in intervals of time, successive blocks."""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_most, listed
from ..records import checked

Recorded = TypeVar("Recorded", xr.Dataset, xr.DataArray)


def samples(signal: xr.DataArray) -> tuple[Array, float]:
    """Return the values of a signal over time and their interval [s]."""
    of_one_contact(signal)
    checked.signal("signal", signal)
    if signal.dims != ("time",) or signal.size < 2:
        raise ArgumentError(
            "signal", "have the one dimension time and at least 2 samples", signal, got=dict(signal.sizes)
        )
    time = signal["time"].values
    return signal.values.astype(float), float((time[-1] - time[0]) / (time.size - 1))


def of_one_contact(recorded: Recorded) -> Recorded:
    """Return a record or a signal after checking that it is of one contact.

    Raises
    ------
    ValueError
        If it has the dimension ``contact``.
    """
    if "contact" in getattr(recorded, "dims", ()):
        names = listed(repr(str(name)) for name in recorded["contact"].values)
        kind = "run" if isinstance(recorded, xr.Dataset) else "signal"
        raise ArgumentError(kind, "be of one contact", got=f"those of {names}: choose one with {kind}.sel(contact=...)")
    return recorded


def record_of_one(run: xr.Dataset, *needed: str) -> xr.Dataset:
    """Return a record of one contact that has the variables needed.

    Raises
    ------
    ValueError
        If it is not a record, lacks a variable, or has several contacts.
    """
    return checked.record("run", of_one_contact(run), *needed)


def checked_intervals(intervals: Any) -> Array:
    """Return intervals as an array of finite starts and ends, shape (intervals, 2)."""
    try:
        pairs = np.asarray(intervals, dtype=float)
    except (TypeError, ValueError):
        pairs = np.empty(0)
    if pairs.ndim != 2 or pairs.shape[1] != 2 or not np.isfinite(pairs).all():
        raise ArgumentError("intervals", "be pairs of start and end in s", intervals)
    return pairs


def pieces(signal: xr.DataArray, values: Array, intervals: Array | None) -> list[Array]:
    """Return the values in each interval of at least 8 samples, or all of them without intervals."""
    if intervals is None:
        return [values]
    time = signal["time"].values
    bounds = np.searchsorted(time, checked_intervals(intervals))
    return [values[first:last] for first, last in bounds if last - first >= 8]


def blocks(values: Array, window: float, interval: float) -> Array:
    """Return the values in successive blocks of a window, shape (blocks, samples)."""
    size = max(1, round(window / interval))
    if values.size < size:
        raise ArgumentError("window", f"be at most the signal's {at_most(values.size * interval)} s", window)
    return values[: values.size // size * size].reshape(-1, size)
