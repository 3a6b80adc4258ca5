"""The sound of a system: that of its bodies and of beams carried along, with notes on what is left out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import Modes, is_track
from ..checks import ArgumentError, listed
from ..system import System
from .bodies_sound import Listening, bodies_sound, joined
from .carried import carried, carried_motion, is_carried
from .moments import moment_note
from .motions import Motion
from .open_surfaces import Heard
from .panels import line_of, panel_of
from .recorded import along_track
from .sounding import Sounding
from .travels import travel_note, travel_of


def chosen(system: System, bodies: Sequence[Any] | None, heard: list[Any]) -> tuple[list[Any], list[str]]:
    """Return the audible bodies that are wanted and, if all are wanted, the names of the silent ones.

    Raises
    ------
    ValueError
        If there are none, or a selected one has no surface.
    """
    silent = [system.body_name(body) for body in system.bodies if body not in heard]
    if bodies is None:
        if not heard:
            raise ArgumentError(
                "system", "have a body with a surface, which radiates sound", got=f"none of {listed(silent)}"
            )
        return heard, silent
    if isinstance(bodies, str) or not isinstance(bodies, Sequence) or not bodies:
        raise ArgumentError("bodies", "be one or more bodies of the system", bodies)
    for number, body in enumerate(bodies):
        if body not in heard:
            names = [system.body_name(one) for one in heard]
            raise ArgumentError(f"bodies[{number}]", f"be a body of the system with a surface: {listed(names)}", body)
    return list(dict.fromkeys(bodies)), []


def system_sound(
    run: xr.Dataset,
    system: System,
    sources: Mapping[Any, Sounding],
    moved: Callable[[], Mapping[Any, Motion]],
    listening: Listening,
    silent: Sequence[str],
) -> tuple[Array, Array, dict[str, Any]]:
    """Return the sound of bodies of a system (listeners, samples) [Pa], its times [s] and its attributes.

    Parameters
    ----------
    run : xarray.Dataset
        The record.
    system : System
        Its system.
    sources : mapping
        Bodies as sources of sound.
    moved : callable
        Returns the motions of these bodies.
    listening : Listening
        The listeners.
    silent : sequence of str
        Names of bodies that are left out.

    Raises
    ------
    ValueError
        If a listener is in a body or behind the baffle, or the record is not usable.
    """
    lines: list[Any] = [one for body, one in sources.items() if one.is_line and is_carried(system, body)]
    wholes = [carried(one) for one in lines]
    bodies = {one.name: body for body, one in sources.items()}

    def motions() -> list[Motion]:
        found = moved()
        along = [carried_motion(system, found[bodies[one.name]]) for one in wholes]
        return [*(found[body] for body in sources), *along]

    def unheard(one: Sounding, heard: Heard, pressure: Array) -> list[str]:
        return _moments(run, system, bodies[one.name], heard, pressure)

    pressure, time, attributes = bodies_sound([*sources.values(), *wholes], motions, listening, unheard)
    notes = [attributes["notes"]]
    for body, one in sources.items():
        notes += travel_note(one.name, travel_of(run, system, body)[1])
    if silent:
        notes.append(f"not included, without a surface: {listed(silent)}")
    notes.append(ends_of({one.name: body.modes(system.is_held(body)) for body, one in sources.items()}))
    return pressure, time, attributes | {"notes": joined(notes)}


def _moments(run: xr.Dataset, system: System, body: Any, heard: Heard, pressure: Array) -> list[str]:
    """Return notes on the moments of friction on a track, from its modes that sound and the sound at a listener."""
    if not is_track(body) or all(one.path_body != body for one in system.contacts):
        return []
    track: Any = body
    panel = panel_of(track) if hasattr(track, "track_line") else line_of(track)
    bending = np.flatnonzero(heard.numbers < len(panel.wavenumbers))
    first = replace(heard.responses[0], taps=heard.responses[0].taps[:, bending])
    notes = moment_note(along_track(run, system, body), body, panel.only(heard.numbers[bending]), first, pressure)
    return [f"{system.body_name(body)}: {note}" for note in notes]


def ends_of(heard: Mapping[str, Modes]) -> str:
    """Return a note on the highest modes of bodies by name."""
    highest = {name: float(modes.frequency[~modes.massless].max()) for name, modes in heard.items()}
    return f"modes end at: {', '.join(f'{name} {frequency:.4g} Hz' for name, frequency in highest.items())}"
