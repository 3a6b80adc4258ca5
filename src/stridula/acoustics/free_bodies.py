"""The sound of the bodies of a system in space, in open air."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array, in_space
from ..bodies import Modes
from ..checks import ArgumentError, listed
from ..lowering import assemble
from ..places import origins_in_space
from ..records.checked import record
from ..system import System
from .air import Air
from .convolution import Convolution
from .delays import Response, Sampling
from .driving import starts_are_heard
from .listeners import HEIGHT, SPACING, listeners_of
from .panels import is_flat
from .recorded_motion import at_one_rate, recorded_motion
from .redriven import Moved, redriven
from .resampling import bandwidth_of, ratio_of, resample
from .sounding import Sounding, sounding_of, wall_of
from .travels import travel_note, travel_of


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
    normal, tangent = map(in_space, system.contacts[0].frame[:2])
    # Bodies that touch nothing have the origin of the world.
    origins = dict.fromkeys(heard, np.zeros(3)) | origins_in_space(system)
    run, sounding, slid = at_one_rate(record("run", run), system, heard), [], []
    for body in heard:
        name, (travel, reach) = system.body_name(body), travel_of(run, system, body)
        sounding.append(
            sounding_of(name, body, system.is_held(body), origins[body] + travel, baffled=bool(baffled), air=air)
        )
        slid += travel_note(name, reach)
    pressure, time, places, attributes, motions = bodies_sound(
        lambda: _motions(run, system, heard),
        sounding,
        (normal, tangent),
        listener,
        air,
        sample_rate,
    )
    notes = [attributes["notes"], *slid, *lacks(system, heard, silent, motions.values())]
    return pressure, time, places, attributes | {"notes": "; ".join(filter(None, notes))}


def _motions(run: xr.Dataset, system: System, bodies: Sequence[Any]) -> dict[str, Moved]:
    """Return how bodies move, by their names: as recorded where it is, else driven again."""
    found = {system.body_name(body): recorded_motion(run, system, [body]) for body in bodies}
    again = redriven(run, system) if None in found.values() else None
    motions = {name: again if one is None else one for name, one in found.items()}
    return {name: one for name, one in motions.items() if one is not None}


def bodies_sound(
    motion: Callable[[], dict[str, Moved]],
    heard: Sequence[Sounding],
    above: tuple[Array, Array],
    listener: Any,
    air: Air,
    sample_rate: float | None,
) -> tuple[Array, Array, Array, dict[str, Any], dict[str, Moved]]:
    """Return pressures (listeners, samples), their times, the listeners, attributes and the motion of each body.

    All motions have the samples of one record. If `listener` is None, two ears are taken: above the middle of the
    bodies along the first direction of `above`, side by side along the second one. Bodies in front of a baffle are
    heard by the listeners and by their images in it.

    Raises
    ------
    ValueError
        If a listener is in a body or behind the baffle, or there is no such motion.
    """
    wall = wall_of(heard)
    places = listeners_of(_ears(above, heard) if listener is None else listener)
    distances = np.array([one.distances(places) for one in heard])
    motions = motion()
    moved = motions[heard[0].name]
    recorded = 1.0 / moved.interval
    ratio = ratio_of(sample_rate, recorded, moved.samples)
    bandwidth = min(bandwidth_of(ratio, recorded), *(one.most for one in heard))
    pressure, modes = np.zeros((len(places), moved.samples)), 0
    notes: list[str] = []
    errors: list[float] = []
    for one in heard:
        moved = motions[one.name]
        first, last = moved.spans[one.name]
        shift = (moved.first - moved.start) / moved.interval
        moving = np.flatnonzero(moved.accelerations[first:last].any(axis=1))
        seen = places if wall is None or one.wall is not None else np.concatenate([places, wall.images(places)])
        sent = one.heard(moving, seen, air, Sampling(moved.interval, bandwidth, shift))
        if sent.numbers.size:
            signals = convolved(sent.responses, moved, first + sent.numbers)
            pressure += signals.reshape(-1, *pressure.shape).sum(axis=0)
        notes += sent.notes
        errors.append(sent.error)
        modes += int(sent.numbers.size)
    sounding = resample(pressure, ratio)
    times = np.arange(sounding.shape[1]) * moved.interval / float(ratio)
    arrival = distances.min(axis=0) / air.speed
    sounding[times < arrival[:, None]] = 0.0
    pushed = [one.pushed for one in motions.values() if one.pushed is not None]
    if not pushed:
        notes.append("silence: nothing pushes")
    elif (arrival + min(pushed) > times[-1]).any():
        notes.append("silence: the sound does not arrive within the record")
    attributes = {
        "bandwidth": bandwidth,
        "modes": modes,
        "baffled": int(wall is not None),
        "distance": distances.min(axis=0).tolist(),
        "bodies": [one.name for one in heard],
        "fit_error": errors,
        "motion": " or ".join(dict.fromkeys(one.words for one in motions.values())),
        **air.attributes,
        "notes": "; ".join(notes),
    }
    return sounding, moved.start + times, places, attributes, motions


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


def _ears(above: tuple[Array, Array], heard: Sequence[Sounding]) -> list[list[float]]:
    """Return two ears above the middle of the bodies, along a normal and side by side along a tangent."""
    normal, tangent = above
    points = np.concatenate([one.points for one in heard])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    up = middle + (float((points @ normal).max()) + HEIGHT - float(middle @ normal)) * normal
    return [(up + side * SPACING / 2.0 * tangent).tolist() for side in (-1.0, 1.0)]


def convolved(responses: Sequence[Response], moved: Moved, modes: Array) -> Array:
    """Return the pressures at the samples of the record, shape (listeners, samples)."""
    acceleration = moved.accelerations[modes]
    sound = Convolution(responses, acceleration.shape[1])
    sound.add(acceleration, slice(None))
    return sound.signals()[:, : moved.samples]


def ends_of(heard: dict[str, Modes], moved: Moved | None) -> list[str]:
    """Return notes on the highest modes of bodies by name."""
    notes = []
    if moved is not None and moved.left_out.any():
        left_out = int(moved.left_out.sum())
        notes.append(f"{left_out} modes above the limit of the record's sample rate are left out")
    highest = {name: float(modes.frequency[~modes.massless].max()) for name, modes in heard.items()}
    words = [f"{name} {frequency:.4g} Hz" for name, frequency in highest.items()]
    return [*notes, f"modes end at: {', '.join(words)}"]


def lacks(system: System, heard: Sequence[Any], silent: Sequence[str], motions: Iterable[Moved]) -> list[str]:
    """Return notes on parts that are left out."""
    notes = []
    if silent:
        notes.append(f"not included, without a surface: {listed(silent)}")
    moved = next((one for one in motions if not one.is_recorded), None)
    notes += ends_of({system.body_name(body): body.modes(system.is_held(body)) for body in heard}, moved)
    imposed = system.imposed_velocity
    if imposed is not None and imposed.point.body in heard and imposed.history.kind != "constant":
        notes.append(f"{system.body_name(imposed.point.body)}: changes of its imposed velocity are not included")
    if moved is None:
        return notes
    if moved.start > 0.5 * moved.interval:
        notes.append("the record continues another one; vibration left from the earlier record is not included")
    return [*notes, *start_notes(system)]


def start_notes(system: System) -> list[str]:
    """Return a note on drives whose vibration at the start is left out."""
    heard = starts_are_heard(assemble(system))
    moved = [one for one in system.drives if one.starts_motion]
    left_out = [str(one) for one in moved if not heard or (one.uniform_velocity is None and not one.vectors)]
    return [f"vibration at the start is not included: {listed(left_out)}"] if left_out else []
