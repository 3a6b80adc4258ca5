"""The sound of a track without its system: contacts along it are heard, notes name everything else that acts on it."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..checks import listed
from ..records.checked import record
from ..records.on_tracks import OnTrack, on_track
from .air import Air
from .recorded_motion import RecordedModes
from .track_sound import track_sound

UNKNOWN = "the record does not say whether more than contacts acts on the track: its system includes all"


def lone_sound(
    run: xr.Dataset, track: ModalBeam | ModalPlate, listener: Any, baffled: bool, air: Air, sample_rate: float | None
) -> tuple[Array, Array, Array, dict[str, Any]]:
    """Return pressures (listeners, samples), their times, the listeners and attributes; arguments are as in `radiate`.

    Raises
    ------
    ValueError
        If the record is not usable, the track has no such surface, or a listener is on it or behind the baffle.
    """
    run = record("run", run)
    acting = on_track(run, getattr(track, "name", ""))
    heard = run if acting is None else _along(run, acting)
    pressure, time, listeners, attributes = track_sound(heard, track, listener, baffled, air, sample_rate)
    if attributes["motion"] != RecordedModes.words:
        notes = _notes(heard, acting)
        attributes["notes"] = "; ".join(filter(None, [attributes["notes"], *notes]))
    return pressure, time, listeners, attributes


def _along(run: xr.Dataset, acting: OnTrack) -> xr.Dataset:
    """Return a record with the forces of contacts along a track, as changes from those of a start in equilibrium."""
    if "normal_force" not in run:
        return run
    force = run["normal_force"]
    if acting.in_equilibrium:
        force = force - force.isel(time=0)
    if acting.touching:
        force = force.where(~force["contact"].isin(acting.touching), 0.0) if "contact" in force.coords else 0.0 * force
    return run.assign(normal_force=force)


def _notes(run: xr.Dataset, acting: OnTrack | None) -> list[str]:
    """Return notes on what acts on a track and is not heard."""
    if acting is None:
        return [UNKNOWN] if "stridula_version" in run.attrs else []
    notes = []
    silent = [*acting.others, *(f"{name} at a fixed point" for name in acting.touching)]
    if silent:
        varies = float(np.sqrt(run["normal_force"].var("time").sum()))
        heard = f"only contacts along the track are heard, whose forces vary by {varies:.3g} N (root mean square)"
        notes.append(f"{heard}; not included without its system: {listed(silent)}")
    if acting.elsewhere:
        notes.append(f"contacts on other bodies press on the track, too: {listed(acting.elsewhere)}")
    return notes
