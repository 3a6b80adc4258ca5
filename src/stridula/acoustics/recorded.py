"""Forces on a track from a record."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_least, at_most, count
from ..records.checked import record
from ..records.endings import FAILED
from ..system import System
from .panels import Panel

# Share of the impulse of the first step that lies before the start of a run.
BEFORE = 0.5


@dataclass(frozen=True)
class Pressing:
    """Normal forces on a track and their places.

    Attributes
    ----------
    start : float
        Time at which the first sample interval begins [s].
    interval : float
        Sample interval [s].
    steps : int
        Steps of the march in a sample interval.
    force : ndarray, shape (contacts, samples)
        Means over the sample intervals [N], compressive.
    position : ndarray, shape (contacts, samples)
        Abscissas in the middle of the intervals [m].
    later : float
        Delay of the forces after the middle of the impulses of their intervals [s].
    """

    start: float
    interval: float
    steps: int
    force: Array
    position: Array
    later: float = 0.0

    @property
    def samples(self) -> int:
        """Number of samples."""
        return self.force.shape[1]


def pressing(run: xr.Dataset, panel: Panel) -> Pressing:
    """Return the normal forces in a record.

    Raises
    ------
    ValueError
        If it is not a record, has one sample, is not evenly sampled, diverged, holds NaN, or presses beyond the track.
    """
    start, interval, steps, (force, position) = sampled(run, "normal_force", "contact_position")
    if position.ndim == 3:
        # In space the track lies along the first tangent.
        position = position[:, 0]
    _check_on_track(position, panel)
    if start < 0.5 * interval:
        force = force.copy()
        force[:, 0] *= 1.0 - BEFORE / steps
    before = np.concatenate([position[:, :1], position[:, :-1]], axis=1)
    middle = (before + position) / 2.0
    if start > 0.5 * interval:
        # The forces before a continued record have already bent the track.
        force = np.concatenate([force, np.broadcast_to(-force[:, :1], force.shape)])
        middle = np.concatenate([middle, np.broadcast_to(middle[:, :1], middle.shape)])
    return Pressing(start, interval, steps, force, middle)


def along_track(run: xr.Dataset, system: System, track: Any) -> xr.Dataset:
    """Return the contacts of a record that move along a track."""
    numbers = [number for number, contact in enumerate(system.contacts) if contact.path_body == track]
    if "contact" not in run.dims:
        return run
    names, shown = [system.contact_names[number] for number in numbers], run["contact"].values.tolist()
    if not set(shown) & set(system.contact_names):
        return run.isel(contact=numbers)
    return run.sel(contact=[name for name in names if name in shown])


def sampled(run: xr.Dataset, *names: str) -> tuple[float, float, int, list[Array]]:
    """Return the begin of the first sample interval, its length [s], the steps in it, and variables of contacts.

    Variables have the shape (contacts, samples); those along tangents (contacts, tangents, samples).

    Raises
    ------
    ValueError
        If it is not a record, has one sample, is not evenly sampled, diverged or holds NaN.
    """
    run = record("run", run).transpose("time", ...)
    record("run", run, *names, least=2)
    if run.attrs.get("ended") in FAILED:
        raise ArgumentError("run", "be one that did not diverge", run, got=f"one that ended {run.attrs['ended']!r}")
    time = run["time"].values
    interval = float((time[-1] - time[0]) / (time.size - 1))
    if not (interval > 0.0 and np.allclose(np.diff(time), interval, rtol=1e-3, atol=0.0)):
        raise ArgumentError("run", "be evenly sampled in rising time", run, got="uneven times")
    found = [_by_contact(run[name]) for name in names]
    for name, values in zip(names, found, strict=True):
        if not np.isfinite(values).all():
            at = np.isfinite(values).all(axis=tuple(range(values.ndim - 1)))
            bad = time[np.flatnonzero(~at)[0]]
            raise ArgumentError(name, "be finite", got=f"{values[~np.isfinite(values)][0]} at {bad:.6g} s")
    steps = count("steps_per_sample", run.attrs.get("steps_per_sample", 1_000_000))
    return float(time[0]) - interval, interval, steps, found


def _by_contact(signal: xr.DataArray) -> Array:
    if "contact" not in signal.dims:
        signal = signal.expand_dims("contact")
    return np.asarray(signal.transpose("contact", ..., "time").values, dtype=float)


def _check_on_track(position: Array, panel: Panel) -> None:
    # The tip of a run that left the track is at most one step beyond its end.
    slack = 1e-3 * (panel.ends[1] - panel.ends[0])
    low, high = float(position.min(initial=panel.ends[1])), float(position.max(initial=panel.ends[0]))
    if low < panel.ends[0] - slack or high > panel.ends[1] + slack:
        worst = low if low < panel.ends[0] - slack else high
        raise ArgumentError(
            "track",
            f"include all contact positions, here from {at_least(panel.ends[0])} to {at_most(panel.ends[1])} m",
            got=f"a contact_position of {worst:.6g} m",
        )
