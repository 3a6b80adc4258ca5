"""Sound pressures as plain arrays, and values for each listener as labelled ones."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_least, at_most, instance
from ..signals.channels import FULL_SCALE

# Fraction of the sample interval by which samples may be off an even grid: rounding of times causes far less.
EVEN = 1e-3

# Relative rounding error allowed in durations and rates.
ROUNDING = 1e-9


def channels(pressure: xr.DataArray) -> tuple[Array, float]:
    """Return sound pressures as an array and their sample rate.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], evenly sampled over ``time`` [s].

    Returns
    -------
    values : ndarray, shape (samples, listeners)
        Sound pressure [Pa].
    rate : float
        Sample rate [Hz].

    Raises
    ------
    ValueError
        If it has other dimensions or units, or values that are not finite.
    """
    instance("pressure", pressure, xr.DataArray)
    if pressure.dims not in (("time",), ("time", "listener")) or pressure.sizes["time"] < 2 or not pressure.size:
        raise ArgumentError(
            "pressure", "have the dimensions time (at least 2 samples) and listener", pressure, got=dict(pressure.sizes)
        )
    units = pressure.attrs.get("units", "Pa")
    if units != "Pa":
        way = ", relative to full scale: give read_signal its calibration and units" if units == FULL_SCALE else ""
        raise ArgumentError("pressure", "be in Pa", units, got=f"{units!r}{way}")
    values = pressure.values.astype(float).reshape(pressure.shape[0], -1)
    if not np.isfinite(values).all():
        raise ArgumentError(
            "pressure",
            "be finite",
            pressure,
            got=f"{np.count_nonzero(~np.isfinite(values))} values that are infinite or NaN",
        )
    return values, 1.0 / _interval(pressure)


def _interval(pressure: xr.DataArray) -> float:
    if "time" not in pressure.coords:
        raise ArgumentError("pressure", "have the coordinate time [s]", pressure, got="none")
    time = pressure["time"].values.astype(float)
    interval = float((time[-1] - time[0]) / (time.size - 1))
    if not interval > 0.0 or np.abs(np.diff(time) - interval).max() > EVEN * interval:
        raise ArgumentError("pressure", "be evenly sampled over time", pressure, got="uneven times")
    return interval


def positions(pressure: xr.DataArray) -> Array | None:
    """Return the places of the listeners [m], shape (listeners, 3), or None without the coordinates x, y, z."""
    instance("pressure", pressure, xr.DataArray)
    if not all(name in pressure.coords and pressure[name].dims == ("listener",) for name in "xyz"):
        return None
    return np.stack([pressure[name].values.astype(float) for name in "xyz"], axis=1)


def of_listeners(pressure: xr.DataArray, values: Array, name: str, units: str, meaning: str) -> xr.DataArray:
    """Return one number for each listener, with the listeners' coordinates.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure at the listeners.
    values : ndarray, shape (listeners,)
        The numbers.
    name, units, meaning : str
        Their name, units and long name.

    Returns
    -------
    xarray.DataArray, shape () or (listener,)
    """
    bare = pressure.isel(time=0, drop=True)
    shaped = np.asarray(values, dtype=float).reshape(bare.shape)
    return bare.copy(data=shaped).rename(name).assign_attrs(units=units, long_name=meaning)


def over_time(pressure: xr.DataArray, time: Array, values: Array, name: str, units: str, meaning: str) -> xr.DataArray:
    """Return a signal for each listener at other times than those of the pressure, with the listeners' coordinates.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure at the listeners.
    time : ndarray, shape (times,)
        Times since its first sample [s].
    values : ndarray, shape (times, listeners)
        The signals.
    name, units, meaning : str
        Their name, units and long name.

    Returns
    -------
    xarray.DataArray, shape (times,) or (times, listener)
    """
    at = xr.Variable("time", float(pressure["time"][0]) + time, {"units": "s"})
    bare = pressure.isel(time=0, drop=True).expand_dims(time=at)
    shaped = np.asarray(values, dtype=float).reshape(bare.shape)
    return bare.copy(data=shaped).rename(name).assign_attrs(units=units, long_name=meaning)


def is_enough(value: float, least: float) -> bool:
    """Return whether a duration or a rate is at least another one, up to rounding."""
    return value >= least * (1.0 - ROUNDING)


def check_length(pressure: xr.DataArray, shortest: float, what: str) -> None:
    """Raise ValueError if a pressure lasts less than `shortest` seconds, which `what` requires."""
    lasts = pressure.sizes["time"] * _interval(pressure)
    if not is_enough(lasts, shortest):
        got = at_most(lasts * (1.0 + ROUNDING), 3)
        raise ArgumentError("pressure", f"last at least {at_least(shortest, 3)} s for {what}", pressure, got=f"{got} s")


def check_rate(rate: float, lowest: float, what: str) -> None:
    """Raise ValueError if a sample rate is below `lowest` [Hz], which `what` requires."""
    if not is_enough(rate, lowest):
        raise ArgumentError(
            "pressure", f"be sampled at {at_least(lowest)} Hz or more for {what}", got=f"{at_most(rate)} Hz"
        )
