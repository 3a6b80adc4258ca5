"""Sounds whose levels are known."""

from __future__ import annotations

import numpy as np
import xarray as xr


def heard(values, rate=48e3, start=0.0, **attributes) -> xr.DataArray:
    """Return samples as a sound pressure over time, with listeners if there are two dimensions."""
    values = np.asarray(values, dtype=float)
    time = start + np.arange(values.shape[0]) / rate
    return xr.DataArray(values, dims=("time", "listener")[: values.ndim], coords={"time": time}, attrs=attributes)


def tone(frequency=1000.0, level=60.0, duration=1.0, rate=48e3, **attributes) -> xr.DataArray:
    """Return a tone of a sound pressure level [dB]."""
    time = np.arange(round(duration * rate)) / rate
    amplitude = np.sqrt(2.0) * 20e-6 * 10.0 ** (level / 20.0)
    return heard(amplitude * np.sin(2.0 * np.pi * frequency * time), rate, **attributes)


def noise(level=60.0, duration=1.0, rate=48e3) -> xr.DataArray:
    """Return white noise of a sound pressure level [dB], always the same."""
    values = np.random.default_rng(1).standard_normal(round(duration * rate))
    return heard(values * 20e-6 * 10.0 ** (level / 20.0) / np.sqrt(np.mean(values**2)), rate)
