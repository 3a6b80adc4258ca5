"""A limit cycle over any time: the record of its period, repeated."""

from __future__ import annotations

from math import ceil
from typing import Any

import numpy as np
import xarray as xr

from ..checks import ArgumentError, instance, listed, positive
from .variables import ENERGY

# Variables over time that go on from period to period.
GROWING = tuple(one.name for one in ENERGY if one.name not in ("kinetic_and_elastic", "ledger_residual"))


def repeat_cycle(cycle: xr.Dataset, duration: float) -> xr.Dataset:
    """Return the record of a limit cycle over a time, for its sound, its regime and figures of many periods.

    Parameters
    ----------
    cycle : xarray.Dataset
        Result of `limit_cycle`.
    duration : float
        Time [s], rounded up to whole periods.

    Returns
    -------
    xarray.Dataset
        A record as of `simulate`, but without a state from which a run could continue; unstable cycles are repeated
        like stable ones.

    Raises
    ------
    ValueError
        If `cycle` is not a result of `limit_cycle`, or `duration` is not above 0.
    """
    instance("cycle", cycle, xr.Dataset)
    if "period" not in cycle or "time" not in cycle.dims:
        raise ArgumentError("cycle", "be the result of limit_cycle", cycle, got=listed(map(str, cycle.variables)))
    count = max(1, ceil(positive("duration", duration) / float(cycle["period"]) - 1e-9))
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
