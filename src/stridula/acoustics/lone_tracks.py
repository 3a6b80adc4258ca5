"""The sound of a track without its system: contacts along it are heard, notes name everything else that acts on it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import ModalBeam, ModalPlate
from ..checks import listed
from ..records.changes import check_one_track
from ..records.checked import record
from ..records.on_tracks import OnTrack, on_track
from .air import Air
from .bodies_sound import Listening, bodies_sound
from .driven import pressed_motion
from .listeners import check_in_front, ears, listeners_of
from .moments import moment_note
from .motions import Motion
from .open_surfaces import Heard
from .panels import Panel
from .recorded import pressing
from .recorded_motion import RECORDED, recorded_motion
from .responses import way_of
from .sounding import Flat

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

    def moved(panel: Panel) -> Motion:
        motion = recorded_motion(heard, track) or pressed_motion(panel, pressing(heard, panel))
        check_one_track(heard)
        return motion if motion.words == RECORDED else replace(motion, notes=[*motion.notes, *_notes(heard, acting)])

    def unheard(panel: Panel, responses: Heard, pressure: Array) -> list[str]:
        return moment_note(heard, track, panel.only(responses.numbers), responses.responses[0], pressure)

    return panel_sound(moved, track, listener, baffled, air, sample_rate, unheard)


def panel_sound(
    moved: Callable[[Panel], Motion],
    track: Any,
    listener: Any,
    baffled: bool,
    air: Air,
    sample_rate: float | None,
    unheard: Callable[[Panel, Heard, Array], list[str]] = lambda *_: [],
) -> tuple[Array, Array, Array, dict[str, Any]]:
    """Return the sound of a track in its own axes.

    `moved` takes its panel and returns its motion; `unheard` takes the panel, the modes heard and the sound at the
    first listener, and returns notes. Other arguments, results and errors are those of `lone_sound`.
    """
    way = way_of(track, baffled)
    listeners = listeners_of(ears(track) if listener is None else listener)
    if baffled:
        check_in_front(listeners)
    flat = Flat("", way, np.eye(3), np.zeros(3))
    pressure, time, attributes = bodies_sound(
        [flat],
        lambda: [moved(way.panel)],
        Listening(listeners, air, flat.wall, sample_rate),
        lambda _, heard, first: unheard(way.panel, heard, first),
    )
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
