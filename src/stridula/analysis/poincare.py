"""Sections of motions by Poincaré: values of a record where a signal crosses a level, or once in each period."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, choice, finite, listed, positive, within
from ..records import checked
from ..records.variables import described

UP, DOWN, BOTH = "up", "down", "both"
DIRECTIONS = (UP, DOWN, BOTH)
# How variables are related to their sample interval: values at its end, means over it, and those of the interval.
AT_END, MEANS, OF_INTERVAL = ("point", "low-pass"), ("mean",), ("mode", "sum", "maximum")


def poincare_section(
    run: xr.Dataset,
    signal: str | xr.DataArray | None = None,
    crossing: float = 0.0,
    direction: str = UP,
    *,
    period: float | None = None,
    phase: float = 0.0,
    start: float = 0.0,
    variables: Sequence[str] | None = None,
) -> xr.Dataset:
    """Return the values of a record where a signal crosses a level, or once in each period.

    Cycles have as many points as crossings in a period, tori have closed curves, chaos has more. Values are
    interpolated linearly between samples: the error is up to an eighth of the square of the phase between two samples.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    signal : str or xarray.DataArray, optional
        The signal that crosses the level: the name of a variable over time alone, or values over the time of the
        record, such as ``run.velocity[:, 0]``. Left out with a `period`.
    crossing : float, optional
        The level, in the unit of the signal.
    direction : {"up", "down", "both"}, optional
        Direction in which the signal crosses it.
    period : float, optional
        Time between two points of a stroboscopic section [s], such as that of a drive, in place of a signal.
    phase : float, optional
        Share of the period at which its points are taken, from 0 to 1: at ``(k + phase) period`` since time 0.
    start : float, optional
        Time at the beginning of the record that is ignored [s].
    variables : sequence of str, optional
        Names of the variables to return; all over time if left out.

    Returns
    -------
    xarray.Dataset
        The variables over ``crossing`` in place of ``time``, with the ``time`` of each [s] as a coordinate. Means over
        a sample interval count in its middle; the status is that of the interval.

    Raises
    ------
    ValueError
        If an argument is out of its range, or if a signal is missing or is not one of the record.
    """
    checked.record("run", run, least=2)
    choice("direction", direction, DIRECTIONS)
    finite("crossing", crossing)
    within("phase", phase, 0.0, 1.0)
    every = [str(name) for name, values in run.data_vars.items() if _is_over_time(values)]
    names = every if variables is None else _chosen(variables, every)
    times = run["time"].values
    first = times[0] + within("start", start, 0.0, float(times[-1] - times[0]))
    if (signal is None) == (period is None):
        got = "neither" if signal is None else "both"
        raise ArgumentError("signal or period", "be given, one of them", got=got)
    if period is not None:
        positive("period", period)
        count = np.arange(np.ceil(first / period - phase), np.floor(times[-1] / period - phase) + 1.0)
        at = (count + phase) * period
    else:
        at = _crossings(times, _values(run, signal), crossing, direction)
    at = at[(at >= first) & (at <= times[-1])]
    coordinates: dict[str, Any] = {"time": ("crossing", at, described("s", "time of the crossing"))}
    kept = {name: values for name, values in run.coords.items() if "time" not in values.dims}
    data = {name: (("crossing", *run[name].dims[1:]), _at(run[name], times, at), run[name].attrs) for name in names}
    words = {word: run.attrs[word] for word in ("title", "scenario", "stridula_version") if word in run.attrs}
    found = xr.Dataset(data, coordinates, words)
    return found.assign_coords({name: one for name, one in kept.items() if set(one.dims) <= set(found.dims)})


def _is_over_time(values: xr.DataArray) -> bool:
    return values.dims[:1] == ("time",) and values.dtype.kind in checked.NUMBERS


def _chosen(variables: Any, known: Sequence[str]) -> list[str]:
    if isinstance(variables, str) or not isinstance(variables, Sequence):
        raise ArgumentError("variables", "be a list of names", variables)
    for name in variables:
        if name not in known:
            raise ArgumentError("variables", f"be among {listed(known)}", name)
    return list(variables)


def _values(run: xr.Dataset, signal: Any) -> Array:
    """Return the values of a signal over the time of a record, those of means moved to the ends of intervals."""
    if isinstance(signal, str):
        known = [str(name) for name, values in run.data_vars.items() if _is_over_time(values) and values.ndim == 1]
        choice("signal", signal, known)
        signal = run[signal]
    values = checked.signal("signal", signal)
    if values.dims != ("time",):
        raise ArgumentError("signal", "have the one dimension time", got=listed(map(str, values.dims)))
    if not np.array_equal(values["time"].values, run["time"].values):
        raise ArgumentError("signal", "be over the time of the run", got="other times")
    plain = values.values.astype(float)
    return _at(values, run["time"].values, run["time"].values) if _method(values) in MEANS else plain


def _method(values: xr.DataArray) -> str:
    return str(values.attrs.get("cell_methods", "time: point")).partition(": ")[2]


def _crossings(times: Array, values: Array, level: float, direction: str) -> Array:
    """Return the times at which values cross a level, by straight lines between samples."""
    before, after = values[:-1] - level, values[1:] - level
    up, down = (before < 0.0) & (after >= 0.0), (before > 0.0) & (after <= 0.0)
    found = np.flatnonzero(up if direction == UP else down if direction == DOWN else up | down)
    share = before[found] / (before[found] - after[found])
    return np.asarray(times[found] + share * (times[found + 1] - times[found]))


def _at(values: xr.DataArray, times: Array, at: Array) -> Array:
    """Return the values of a variable at some times."""
    method, plain = _method(values), values.values
    if method in OF_INTERVAL:
        return np.asarray(plain[np.minimum(np.searchsorted(times, at), times.size - 1)])
    places = times - 0.5 * np.diff(times, prepend=2.0 * times[0] - times[1]) if method in MEANS else times
    columns = plain.reshape(times.size, -1).T
    found = np.array([np.interp(at, places, column) for column in columns]).reshape(len(columns), at.size)
    return np.asarray(found.T.reshape(at.size, *plain.shape[1:]))
