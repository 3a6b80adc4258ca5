"""Accelerations of modes from their recorded velocities, where a record has all modes of a body.

A recorded velocity is a centred difference over two steps, low-passed. One short antisymmetric filter differentiates
it and compensates for both, up to 5/12 of the sample rate.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import scipy  # its parts are imported on first use
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError
from ..records.dataset import MOTION_TIME
from ..records.low_pass import gain
from ..records.probes import ModalMotion
from ..system import System
from .driven import UNDONE
from .motions import Motion
from .recorded import sampled

RECORDED = "recorded"
VARIABLE = ModalMotion.quantity
MODES, BODY, FREQUENCY = (f"{VARIABLE}_{word}" for word in ("probe", "body", "frequency"))
# Samples on each side from which an acceleration is computed, and number of frequencies of the fit.
REACH, FITTED = 32, 400
# Relative difference up to which frequencies are equal.
SAME = 1e-9


def recorded_motion(run: Any, body: Any, name: str | None = None, held: bool = False) -> Motion | None:
    """Return the motion of the modes of a body if it is recorded.

    Parameters
    ----------
    run : xarray.Dataset
        The record.
    body : object
        The body.
    name : str, optional
        Its name in the record, any if left out.
    held : bool, optional
        Whether its root follows an imposed velocity.
    """
    if VARIABLE not in getattr(run, "variables", ()):
        return None
    frequency = body.modes(held).frequency
    names = dict.fromkeys(run[BODY].values.tolist()) if name is None else [name]
    found = (_columns(run, one, frequency) for one in names)
    columns = next((one for one in found if one is not None), None)
    if columns is None:
        return None
    start, interval, steps, velocities = _recorded(run)
    own = velocities[columns]
    return Motion(
        start,
        interval,
        own.shape[1],
        start + interval,
        0.0 if own.any() else None,
        np.arange(frequency.size),
        lambda modes: accelerations(own[modes], interval, steps),
        words=RECORDED,
        still="it does not move",
    )


def accelerations(velocities: Array, interval: float, steps: int) -> Array:
    """Return the accelerations at the samples of recorded velocities, shape (modes, samples) each.

    Parameters
    ----------
    velocities : ndarray, shape (modes, samples)
        Velocities; constant before the first sample and after the last one.
    interval : float
        Sample interval [s].
    steps : int
        Steps of the march in it.
    """
    padded = np.pad(velocities.astype(float), ((0, 0), (REACH, REACH)), mode="edge")
    return np.asarray(scipy.signal.oaconvolve(padded, _derivative(steps)[None, :], mode="valid", axes=1) / interval)


@lru_cache(maxsize=16)
def _derivative(steps: int) -> Array:
    """Return the filter from velocities to accelerations, times the interval, shape (2 REACH + 1,)."""
    turned = 2.0 * np.pi * np.linspace(0.0, UNDONE, FITTED + 1)[1:]
    # Gain of the centred difference, times that of the low-pass.
    recorded = np.sinc(turned / steps / np.pi) * gain(turned / (2.0 * np.pi), steps)
    wanted = turned / recorded
    sines = 2.0 * np.sin(np.outer(turned, np.arange(1, REACH + 1)))
    half = np.linalg.lstsq(sines / wanted[:, None], np.ones(FITTED), rcond=1e-12)[0]
    return np.concatenate([half[::-1], [0.0], -half])[::-1] * -1.0


def at_one_rate(run: xr.Dataset, system: System, bodies: Sequence[Any]) -> xr.Dataset:
    """Return a record from which the sounds of bodies of a system have one sample rate and can be added.

    If motion was recorded at a rate of its own, but not that of all these bodies, none is used.
    """
    if VARIABLE not in run.variables or MOTION_TIME not in run[VARIABLE].dims:
        return run
    names = ((system.body_name(body), body.modes(system.is_held(body)).frequency) for body in bodies)
    lacks = any(_columns(run, name, frequency) is None for name, frequency in names)
    return run.drop_vars(VARIABLE) if lacks else run


def _recorded(run: xr.Dataset) -> tuple[float, float, int, Array]:
    """Return the start [s], the sample interval [s] and the steps in it, and all velocities, shape (modes, samples).

    They are those within the time of the record.
    """
    start, interval, steps, _ = sampled(run)
    values = run[VARIABLE]
    if MOTION_TIME not in values.dims:
        return start, interval, steps, _finite(values, "time")
    ends = run[MOTION_TIME].values
    slack = 0.5 * interval
    values = values.isel({MOTION_TIME: (ends > start + slack) & (ends < run["time"].values[-1] + slack)})
    # As evenly sampled as any record.
    own = values.to_dataset().rename({MOTION_TIME: "time"}).assign_attrs(run.attrs)
    first, interval_of_motion, _, _ = sampled(own)
    every = round(interval_of_motion / interval)
    return first, interval_of_motion, steps * every, _finite(values, MOTION_TIME)


def _finite(values: xr.DataArray, along: str) -> Array:
    """Return velocities, shape (modes, samples)."""
    found = np.asarray(values.transpose(MODES, along).values)
    if not np.isfinite(found).all():
        raise ArgumentError(VARIABLE, "be finite", got=f"{found[~np.isfinite(found)][0]}")
    return found


def _columns(run: xr.Dataset, name: str, frequency: Array) -> slice | None:
    """Return the columns of all modes of a body among the recorded ones, None if not all are recorded."""
    found = np.flatnonzero(run[BODY].values == name)
    if found.size != frequency.size or not np.allclose(run[FREQUENCY].values[found], frequency, rtol=SAME, atol=0.0):
        return None
    return slice(int(found[0]), int(found[0]) + found.size) if found.size else None
