"""The sound of the bodies of a system in space, in open air or in front of a baffle."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array, in_space
from ..checks import ArgumentError
from ..places import origins_in_space
from ..records.changes import check_one_system
from ..records.checked import record
from ..system import System
from .air import Air
from .bodies_sound import Listening, bodies_sound, joined
from .carried import carried, carried_motion, is_carried
from .listeners import HEIGHT, SPACING, listeners_of
from .motions import Motion
from .panels import is_flat
from .recorded_motion import at_one_rate, recorded_motion
from .redriven import redriven
from .sounding import Sounding, line_in_space, sounding_of, wall_of
from .system_sound import chosen, system_sound
from .travels import travel_of


def bodies_heard(system: System) -> list[Any]:
    """Return the bodies of a system that have a surface in space."""
    return [body for body in system.bodies if getattr(body, "has_surface", False)]


def free_sound(
    run: xr.Dataset,
    system: System,
    listener: Any,
    bodies: Sequence[Any] | None,
    baffled: bool | None,
    air: Air,
    sample_rate: float | None,
) -> tuple[Array, Array, Array, dict[str, Any]]:
    """Return pressures (listeners, samples), their times, the listeners and attributes; arguments are as in `radiate`.

    Raises
    ------
    ValueError
        If a body has no surface, none is flat that is wanted in a baffle, a listener is in a body or behind the baffle,
        or the record is not usable.
    """
    heard, silent = chosen(system, bodies, bodies_heard(system))
    if baffled and not any(map(is_flat, heard)):
        words = "be False, or left out, for bodies in space without a plate or a beam of rectangular section"
        raise ArgumentError("baffled", words, baffled)
    run = at_one_rate(record("run", run), system, heard)
    # Bodies that touch nothing have the origin of the world.
    origins = dict.fromkeys(heard, np.zeros(3)) | origins_in_space(system)
    sources = {}
    for body in heard:
        origins[body] = origins[body] + travel_of(run, system, body)[0]
        name, held = system.body_name(body), system.is_held(body)
        sources[body] = sounding_of(name, body, held, origins[body], baffled=bool(baffled), air=air)
    wall = wall_of(list(sources.values()))
    normal, tangent = map(in_space, system.contacts[0].frame[:2])
    places = listeners_of(ears_above(normal, tangent, list(sources.values())) if listener is None else listener)
    listening = Listening(places, air, wall, sample_rate)
    moved = cache(lambda: _motions(run, system, heard))
    pressure, time, attributes = system_sound(run, system, sources, moved, listening, silent)
    for body, one in sources.items():
        if is_carried(system, body) and not one.is_line:
            whole = carried(line_in_space(one.name, body, True, origins[body]))
            motion = carried_motion(system, moved()[body])
            alone, *_ = bodies_sound([whole], lambda motion=motion: [motion], listening)  # type: ignore[misc]
            attributes["notes"] = joined([attributes["notes"], _rigid_note(one.name, alone[0], pressure[0])])
    return pressure, time, places, attributes


def _rigid_note(name: str, carried: Array, heard: Array) -> str:
    """Return a note on the sound of a beam that moves with its root, which is left out."""
    left_out, level = (float(np.sqrt(np.mean(one**2))) for one in (carried, heard))
    words = f"{20.0 * np.log10(left_out / level):.0f} dB relative to what is heard" if level else f"{left_out:.2g} Pa"
    return f"{name}: changes of its imposed velocity are heard by its vibration alone, not as a whole: about {words}"


def _motions(run: xr.Dataset, system: System, bodies: Sequence[Any]) -> dict[Any, Motion]:
    """Return how bodies move: as recorded where it is, else driven again."""
    check_one_system(run)
    names = {body: system.body_name(body) for body in bodies}
    found = {body: recorded_motion(run, body, name, system.is_held(body)) for body, name in names.items()}
    if None not in found.values():
        return {body: one for body, one in found.items() if one is not None}
    again = redriven(run, system)
    return {body: one or again.of(names[body]) for body, one in found.items()}


def ears_above(normal: Array, tangent: Array, heard: Sequence[Sounding]) -> list[list[float]]:
    """Return two ears above the middle of the bodies, along a normal and side by side along a tangent."""
    points = np.concatenate([one.points for one in heard])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    up = middle + (float((points @ normal).max()) + HEIGHT - float(middle @ normal)) * normal
    return [(up + side * SPACING / 2.0 * tangent).tolist() for side in (-1.0, 1.0)]
