"""The sound of the bodies of a system in space, in open air."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array, in_space
from ..bodies.body_surfaces import BodySurface
from ..checks import ArgumentError, at_least, listed
from ..system import System
from .air import Air
from .convolution import Convolution
from .delays import Response
from .flat_patches import patch_integrals
from .free_responses import LEFT, Sent, free_responses
from .listeners import HEIGHT, SPACING, listeners_of
from .recorded_motion import recorded_motion
from .redriven import Moved, redriven
from .resampling import bandwidth_of, ratio_of, resample

# Largest bandwidth of a sound [Hz], the limit of hearing.
HIGHEST = 20e3
# Error of the normal motion at a mode's own frequency above which a note states it.
SAID = 0.05
# Smallest distance of a listener over the size of the body.
NEAREST = 1e-3


def bodies_heard(system: System) -> list[Any]:
    """Return the bodies of a system that have a surface in space."""
    return [body for body in system.bodies if getattr(body, "has_surface", False)]


def check_in_open_air(baffled: bool | None) -> None:
    """Raise ValueError if bodies in space are to be baffled."""
    if baffled:
        raise ArgumentError("baffled", "be False, or left out, for bodies in space", baffled)


def free_sound(
    run: xr.Dataset,
    system: System,
    listener: Any,
    bodies: Sequence[Any] | None,
    air: Air,
    sample_rate: float | None,
) -> tuple[Array, Array, Array, dict[str, Any]]:
    """Return pressures (listeners, samples), their times, the listeners and attributes; arguments are as in `radiate`.

    Raises
    ------
    ValueError
        If a body has no surface, a listener is in a body, or the record is not usable.
    """
    heard, silent = chosen(system, bodies, bodies_heard(system))
    normal, tangent = map(in_space, system.contacts[0].frame[:2])
    named = {system.body_name(body): body for body in heard}
    pressure, time, places, attributes, moved = bodies_sound(
        lambda: recorded_motion(run, system, heard) or redriven(run, system),
        named,
        (normal, tangent),
        listener,
        air,
        sample_rate,
    )
    notes = [attributes["notes"], *lacks(system, heard, silent, moved)]
    return pressure, time, places, attributes | {"notes": "; ".join(filter(None, notes))}


def bodies_sound(
    motion: Callable[[], Moved],
    heard: dict[str, Any],
    above: tuple[Array, Array],
    listener: Any,
    air: Air,
    sample_rate: float | None,
) -> tuple[Array, Array, Array, dict[str, Any], Moved]:
    """Return pressures (listeners, samples), their times, the listeners, attributes and the motion, of bodies by name.

    If `listener` is None, two ears are taken: above the middle of the bodies along the first direction of `above`, side
    by side along the second one.

    Raises
    ------
    ValueError
        If a listener is in a body, or there is no such motion.
    """
    surfaces = [body.surface() for body in heard.values()]
    places = listeners_of(_ears(above, surfaces) if listener is None else listener)
    distances = np.array([distances_to(surface, places) for surface in surfaces])
    moved = motion()
    recorded = 1.0 / moved.interval
    ratio = ratio_of(sample_rate, recorded, moved.samples)
    bandwidth = min(bandwidth_of(ratio, recorded), HIGHEST)
    shift = (moved.first - moved.start) / moved.interval
    pressure, notes, errors = np.zeros((len(places), moved.samples)), [], {}
    for (name, body), surface, away in zip(heard.items(), surfaces, distances, strict=True):
        first, _ = moved.spans[name]
        modes = first + np.flatnonzero(~body.modes().massless)
        frequency = body.modes().frequency[: modes.size]
        # A body that does not vibrate moves as a rigid one at any frequency.
        highest = float(frequency.max(initial=0.0)) or np.inf
        sent = free_responses(surface, places, away, air, moved.interval, shift, bandwidth, highest)
        pressure += convolved(sent.responses, moved, modes)
        said, worst = _doubts(name, frequency, sent)
        notes += said
        errors[name] = worst
    sounding = resample(pressure, ratio)
    times = np.arange(sounding.shape[1]) * moved.interval / float(ratio)
    arrival = distances.min(axis=0) / air.speed
    sounding[times < arrival[:, None]] = 0.0
    if moved.pushed is None:
        notes.append("silence: nothing pushes")
    elif (arrival + moved.pushed > times[-1]).any():
        notes.append("silence: the sound does not arrive within the record")
    attributes = {
        "bandwidth": bandwidth,
        "modes": int(sum(surface.shapes.shape[1] for surface in surfaces)),
        "baffled": 0,
        "distance": distances.min(axis=0).tolist(),
        "bodies": list(heard),
        "fit_error": list(errors.values()),
        "motion": moved.words,
        **air.attributes,
        "notes": "; ".join(notes),
    }
    return sounding, moved.start + times, places, attributes, moved


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


def _ears(above: tuple[Array, Array], surfaces: Sequence[BodySurface]) -> list[list[float]]:
    """Return two ears above the middle of the surfaces, along a normal and side by side along a tangent."""
    normal, tangent = above
    points = np.concatenate([surface.as_points.points for surface in surfaces])
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    above = middle + (float((points @ normal).max()) + HEIGHT - float(middle @ normal)) * normal
    return [(above + side * SPACING / 2.0 * tangent).tolist() for side in (-1.0, 1.0)]


def distances_to(surface: BodySurface, places: Array) -> Array:
    """Return the distances of places to the nearest points of a surface [m].

    Raises
    ------
    ValueError
        If a place is in the body or on it.
    """
    points = surface.as_points
    size, found = float(np.linalg.norm(np.ptp(points.points, axis=0))), []
    for place in places:
        away = points.points - place
        distance = np.linalg.norm(away, axis=1)
        if surface.form == "points":
            # Exact for patches, as a body may be thinner than its patches are long.
            corners = points.corners.reshape(-1, 4, 3)
            angle = float(patch_integrals(np.repeat(place[None], len(corners), axis=0), corners)[1].sum())
        else:
            angle = float((points.areas * (points.normals * away).sum(axis=1) / distance**3).sum())
        if angle > 2.0 * np.pi or distance.min() < NEAREST * size:
            words = f"be outside of the bodies, {at_least(NEAREST * size, 3)} m from them"
            raise ArgumentError("listener", words, got=f"{tuple(place.tolist())}")
        found.append(float(distance.min()))
    return np.array(found)


def convolved(responses: Sequence[Response], moved: Moved, modes: Array) -> Array:
    """Return the pressures at the samples of the record, shape (listeners, samples)."""
    acceleration = moved.accelerations[modes]
    sound = Convolution(responses, acceleration.shape[1])
    sound.add(acceleration, slice(None))
    return sound.signals()[:, : moved.samples]


def _doubts(name: str, frequency: Array, sent: Sent) -> tuple[list[str], float]:
    """Return notes on doubtful responses of a body, and the largest error of a mode at its own frequency."""
    within = np.flatnonzero(frequency <= sent.frequencies[-1])
    own = np.array([np.interp(frequency[k], sent.frequencies, sent.errors[:, k]) for k in within])
    worst, notes = float(own.max(initial=0.0)), []
    if worst > SAID:
        at = frequency[within[int(own.argmax())]]
        notes.append(f"{name}: error of {100.0 * worst:.2g} % in its normal motion at {at:.4g} Hz")
    if sent.left > LEFT:
        notes.append(f"{name}: {100.0 * sent.left:.2g} % of its response lasts longer than is included")
    return notes, worst


def ends_of(heard: dict[str, Any], moved: Moved) -> list[str]:
    """Return notes on the highest modes of bodies by name."""
    notes = []
    if moved.left_out.any():
        left_out = int(moved.left_out.sum())
        notes.append(f"{left_out} modes above what the record's sample rate carries are left out")
    highest = {name: float(body.modes().frequency[~body.modes().massless].max()) for name, body in heard.items()}
    words = [f"{name} {frequency:.4g} Hz" for name, frequency in highest.items()]
    return [*notes, f"modes end at: {', '.join(words)}"]


def lacks(system: System, heard: Sequence[Any], silent: Sequence[str], moved: Moved) -> list[str]:
    """Return notes on what is left out."""
    notes = []
    if silent:
        notes.append(f"without a surface and not heard: {listed(silent)}")
    notes += ends_of({system.body_name(body): body for body in heard}, moved)
    if moved.is_recorded:
        return notes
    if moved.start > 0.5 * moved.interval:
        notes.append("the record continues another one; vibration left from that one is not included")
    elif started := [str(drive) for drive in system.drives if drive.starts_motion]:
        notes.append(f"vibration at the start is not included: {listed(started)}")
    return notes
