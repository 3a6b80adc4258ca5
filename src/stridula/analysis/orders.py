"""Orders of a vibration: multiples of the speed of a shaft that changes."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_most, positive, within
from .signals import samples

# Revolutions per second of one unit of speed.
UNITS = {
    "Hz": 1.0,
    "1/s": 1.0,
    "rpm": 1.0 / 60.0,
    "1/min": 1.0 / 60.0,
    "rad/s": 0.5 / math.pi,
}
HIGHEST, REVOLUTIONS = 20.0, 8.0
# Most orders of a spectrum.
MOST = 10_000.0


def order_spectrum(
    signal: xr.DataArray, speed: xr.DataArray, *, highest: float = HIGHEST, revolutions: float = REVOLUTIONS
) -> xr.DataArray:
    """Return the orders of a signal over a speed.

    The angle of the shaft is the integral of its speed. In windows of whole `revolutions` that overlap by half, the
    Fourier integral is taken over the angle under a Hann window, at the samples themselves: nothing is resampled, so a
    component of fixed order keeps its value while the speed changes.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,)
        A vibration or a sound.
    speed : xarray.DataArray, shape (time,)
        Speed at the same times, 0 or above, in ``rpm``, ``1/min``, ``Hz``, ``1/s`` or ``rad/s`` as its attribute
        ``units`` says.
    highest : float, optional
        Highest order [1].
    revolutions : float, optional
        Length of a window [1]; orders are one over it apart.

    Returns
    -------
    xarray.DataArray, shape (time, order)
        Effective value of each order, in units of the signal, over the times of the middles of the windows; NaN above
        half of the sample rate. ``speed`` [Hz] is the mean of each window.

    Raises
    ------
    ValueError
        If the times differ, the speed has another unit or is negative, or the shaft turns less than a window.
    """
    values, interval = samples(signal)
    turning = _speed(speed, signal)
    positive("highest", highest)
    within("revolutions", revolutions, 1.0, MOST / highest)
    fastest = float(turning.max()) * interval
    if 0.25 * revolutions < fastest:
        raise ArgumentError("speed", f"be at most {at_most(0.25 * revolutions / interval)} Hz", got="more")
    # Of samples at the values of speed at their times, by the trapezoidal rule.
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (turning[1:] + turning[:-1]))]) * interval
    count = math.floor(highest * revolutions * (1.0 + 1e-9))
    if count < 1:
        raise ArgumentError("highest", f"be at least one over the revolutions, {1.0 / revolutions:.4g}", highest)
    if angle[-1] < revolutions * (1.0 - 1e-9):
        least = at_most(float(angle[-1]))
        raise ArgumentError("revolutions", f"be at most the {least} of the shaft", revolutions)
    begins = 0.5 * revolutions * np.arange(max(1, math.floor((angle[-1] / revolutions - 1.0) * 2.0 * (1.0 + 1e-9)) + 1))
    orders = np.arange(1, count + 1) / revolutions
    time = signal["time"].values
    found, middles, means = np.empty((begins.size, count)), np.empty(begins.size), np.empty(begins.size)
    for row, begin in enumerate(begins):
        first, last = np.searchsorted(angle, (begin, begin + revolutions), side="right")
        piece = slice(max(first - 1, 0), min(last + 1, angle.size))
        fastest = float(turning[piece].max())
        found[row] = _window(values[piece], angle[piece] - begin, turning[piece], revolutions, count)
        found[row, orders * fastest * interval > 0.5] = np.nan
        middles[row] = np.interp(begin + 0.5 * revolutions, angle, time)
        ends = np.interp((begin, begin + revolutions), angle, time)
        means[row] = revolutions / (ends[1] - ends[0])
    words = {"units": str(signal.attrs.get("units", "1")), "long_name": "effective value of the order"}
    return xr.DataArray(
        found,
        {
            "time": ("time", middles, {"units": "s"}),
            "order": ("order", orders, {"units": "1", "long_name": "order"}),
            "speed": ("time", means, {"units": "Hz", "long_name": "mean speed of the window"}),
        },
        ("time", "order"),
        "order_spectrum",
        words,
    )


def _window(values: Array, angle: Array, turning: Array, revolutions: float, count: int) -> Array:
    """Return the effective values of the orders of one window whose angle begins at 0."""
    share = np.clip(angle / revolutions, 0.0, 1.0)
    weight = np.sin(np.pi * share) ** 2 * turning
    total = weight.sum()
    weight = weight / total if total > 0.0 else weight
    about = weight * (values - weight @ values)
    turn = np.exp(-2.0j * np.pi * share)
    sums, wave = np.empty(count), about.astype(complex)
    for number in range(count):
        wave = wave * turn
        sums[number] = abs(wave.sum())
    return np.asarray(math.sqrt(2.0) * sums)


def _speed(speed: xr.DataArray, signal: xr.DataArray) -> Array:
    """Return a speed in revolutions per second."""
    values, _ = samples(speed)
    if values.size != signal.size or np.abs(speed["time"].values - signal["time"].values).max() > 1e-9 + 1e-3 * abs(
        float(signal["time"].values[1] - signal["time"].values[0])
    ):
        raise ArgumentError("speed", "have the times of the signal", speed, got="others")
    units = str(speed.attrs.get("units", "none"))
    if units not in UNITS:
        raise ArgumentError("speed", f"be in {', '.join(UNITS)}", got=repr(units))
    if not np.isfinite(values).all() or values.min() < 0.0:
        time = float(speed["time"].values[int(np.argmin(np.where(np.isfinite(values), values, -np.inf)))])
        raise ArgumentError("speed", "be finite and 0 or above", got=f"another value at {time:.6g} s")
    return values * UNITS[units]
