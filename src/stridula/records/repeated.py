"""A limit cycle over any time: the record of its period, repeated."""

from __future__ import annotations

from math import ceil
from typing import Any, overload

import numpy as np
import xarray as xr

from ..checks import ArgumentError, instance, listed, positive
from .variables import ENERGY

# Variables over time that go on from period to period.
GROWING = tuple(one.name for one in ENERGY if one.name not in ("kinetic_and_elastic", "ledger_residual"))


@overload
def repeat_cycle(cycle: xr.Dataset, duration: float) -> xr.Dataset: ...


@overload
def repeat_cycle(cycle: xr.DataArray, duration: float) -> xr.DataArray: ...


def repeat_cycle(cycle: xr.Dataset | xr.DataArray, duration: float) -> xr.Dataset | xr.DataArray:
    """Return the record of a limit cycle, or its sound, over a time: for its regime and figures of many periods.

    Parameters
    ----------
    cycle : xarray.Dataset or xarray.DataArray
        Result of `limit_cycle`, or its sound by `radiate`.
    duration : float
        Time [s], rounded up to whole periods.

    Returns
    -------
    xarray.Dataset or xarray.DataArray
        A record as of `simulate`, but without a state from which a run could continue, or the sound; unstable cycles
        are repeated like stable ones.

    Raises
    ------
    ValueError
        If `cycle` is neither a result of `limit_cycle` nor its sound, or `duration` is not above 0.
    """
    instance("cycle", cycle, (xr.Dataset, xr.DataArray))
    if isinstance(cycle, xr.DataArray):
        return _repeated_sound(cycle, duration)
    if not is_cycle(cycle):
        raise ArgumentError("cycle", "be the result of limit_cycle", cycle, got=listed(map(str, cycle.variables)))
    count = _whole_periods(duration, float(cycle["period"]))
    steps, step = cycle.sizes["time"], float(cycle.attrs["step"])
    first = float(cycle["time"][0])
    data: dict[str, Any] = {}
    for name, values in cycle.data_vars.items():
        if values.dims and values.dims[0] == "time":
            data[str(name)] = (values.dims, _repeated(str(name), values.values, count), values.attrs)
    coordinates = {name: one for name, one in cycle.coords.items() if "time" not in one.dims}
    times = ("time", first + step * np.arange(count * steps), cycle["time"].attrs)
    kept = {name: value for name, value in cycle.attrs.items() if name != "verdict"}
    return xr.Dataset(data, {**_used(coordinates, data), "time": times}, kept)


def is_cycle(run: Any) -> bool:
    """Return whether a value is the record of a limit cycle, as of `limit_cycle`."""
    return isinstance(run, xr.Dataset) and "period" in run and "time" in run.dims


def _whole_periods(duration: float, period: float) -> int:
    """Return the number of periods that a time takes, rounded up."""
    return max(1, ceil(positive("duration", duration) / period - 1e-9))


def _repeated_sound(sound: xr.DataArray, duration: float) -> xr.DataArray:
    """Return one period of a sound, repeated over a time."""
    if "period" not in sound.attrs or "time" not in sound.dims:
        raise ArgumentError("cycle", "be the sound of a limit cycle", sound, got="a sound without a period")
    period, steps = float(sound.attrs["period"]), sound.sizes["time"]
    count = _whole_periods(duration, period)
    again = sound.isel(time=np.tile(np.arange(steps), count))
    times = float(sound["time"][0]) + period / steps * np.arange(count * steps)
    return again.assign_coords(time=("time", times, sound["time"].attrs))


def _repeated(name: str, values: np.ndarray, count: int) -> np.ndarray:
    """Return values of a period, repeated; sums since the start go on."""
    again = np.tile(values, (count, *[1] * (values.ndim - 1)))
    if name in GROWING:
        again = again + np.repeat(np.arange(count) * values[-1], len(values))
    return again


def _used(coordinates: dict[Any, xr.DataArray], data: dict[str, Any]) -> dict[Any, xr.DataArray]:
    """Return the coordinates along dimensions of the data."""
    dimensions = {dimension for dims, *_ in data.values() for dimension in dims}
    return {name: one for name, one in coordinates.items() if set(one.dims) <= dimensions and one.dims}
