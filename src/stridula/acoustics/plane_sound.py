"""The sound of a system in the plane: its tracks, and its slim beams as lines of dipoles.

A wall that tracks are flush with reflects the sound of beams in front of it: their sound at the image of the listener
behind the wall is added.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, listed
from ..lines import Outline, outlines_of
from ..records.checked import record
from ..system import System
from .air import Air
from .delays import Sampling
from .free_bodies import chosen, convolved, lacks
from .listeners import HEIGHT, SPACING, check_in_front, ears, listeners_of
from .panels import panel_of
from .recorded_motion import at_one_rate, recorded_motion
from .redriven import redriven
from .resampling import bandwidth_of, ratio_of, resample
from .responses import line_note
from .slim_beams import slim_beam
from .track_motion import TrackMotion, is_driven_otherwise
from .track_sound import track_sound
from .travels import travel_note, travel_of

# Tracks whose heights differ by less lie in one plane [m].
LEVEL = 1e-9


@dataclass(frozen=True)
class _Axes:
    """Axes of a track in the coordinates of its listeners: an origin and a tangent."""

    origin: Array
    tangent: Array

    def along_and_across(self, places: Array) -> Array:
        """Return abscissa, distance across to the left and height of listeners, shape (listeners, 3)."""
        away = places[:, :2] - self.origin
        left = np.array([-self.tangent[1], self.tangent[0]])
        return np.column_stack([away @ self.tangent, away @ left, places[:, 2]])

    def listeners(self, places: Array) -> Array:
        """Return listeners of an abscissa, a distance across and a height, shape (listeners, 3)."""
        left = np.array([-self.tangent[1], self.tangent[0]])
        flat = self.origin + np.outer(places[:, 0], self.tangent) + np.outer(places[:, 1], left)
        return np.column_stack([flat, places[:, 2]])


def plane_sound(
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
        If no body radiates sound, a listener is inside a body or behind the baffle, or the record is not usable.
    """
    run = record("run", run)
    tracks, beams = _tracks(system), _beams(system)
    heard, silent = chosen(system, bodies, [*tracks, *beams])
    run = at_one_rate(run, system, heard)
    outlines = {one.body: one for one in outlines_of(system)[0]}
    wall = _wall(tracks, outlines, baffled)
    if listener is None:
        listener = ears(tracks[0]) if tracks else _ears(heard, outlines)
    places = listeners_of(listener)
    if wall is not None:
        check_in_front(places)
    seen = _in_the_plane(places, tracks, outlines)
    parts = [
        _of_track(run, system, one, outlines[one], seen, wall is not None, air, sample_rate)
        for one in tracks
        if one in heard
    ]
    if slim := [one for one in beams if one in heard]:
        parts.append(_of_beams(run, system, slim, outlines, seen, wall, air, sample_rate, silent))
    pressure, attributes = _added(parts)
    attributes["bodies"] = [system.body_name(body) for body in heard]
    attributes |= air.attributes
    if silent and not slim:
        attributes["notes"] = "; ".join(filter(None, [attributes["notes"], f"not included: {listed(silent)}"]))
    return pressure, parts[0][1], places, attributes


def plane_bodies(system: System) -> list[Any]:
    """Return the bodies of a system in the plane that can be heard, its tracks first."""
    return [*_tracks(system), *_beams(system)]


def check_plane(system: System) -> None:
    """Raise ValueError if `plane_sound` would refuse the tracks of a system with its default arguments."""
    tracks = _tracks(system)
    _wall(tracks, {one.body: one for one in outlines_of(system)[0]}, None)
    for track in tracks:
        panel_of(track)


def _tracks(system: System) -> list[Any]:
    """Return the tracks that contacts move along and that can be heard."""
    unknown = panel_of.dispatch(object)
    found = [contact.path_body for contact in system.contacts if contact.path_body is not None]
    return [body for body in dict.fromkeys(found) if panel_of.dispatch(type(body)) is not unknown]


def _beams(system: System) -> list[Any]:
    """Return the beams whose section is known, other than tracks."""
    tracks = _tracks(system)
    return [body for body in system.bodies if body not in tracks and _is_slim(body)]


def _is_slim(body: Any) -> bool:
    """Return whether a body is a beam whose section is known."""
    return hasattr(body, "drawn_places") and hasattr(getattr(body, "section", None), "across")


def _wall(tracks: Sequence[Any], outlines: dict[Any, Outline], baffled: bool | None) -> float | None:
    """Return the height of the baffle above the first track [m], None without one."""
    if baffled is False or (baffled is None and not tracks):
        return None
    if not tracks:
        raise ArgumentError("baffled", "be False, or left out, without a track that radiates sound", baffled)
    heights = [float(outlines[one].place[1]) for one in tracks]
    if max(heights) - min(heights) > LEVEL:
        raise ArgumentError("baffled", "be False where tracks do not lie in one plane", got=baffled or "left out")
    return heights[0]


def _in_the_plane(places: Array, tracks: Sequence[Any], outlines: dict[Any, Outline]) -> Array:
    """Return where listeners are along world x, across the plane and along world y, from those of the first track."""
    if not tracks:
        return places
    x, y = outlines[tracks[0]].place
    return _axes(tracks[0]).along_and_across(places) + np.array([x, 0.0, y])


def _axes(track: Any) -> _Axes:
    ends = np.column_stack(panel_of(track).place(np.array([0.0, 1.0]))) if hasattr(track, "track_line") else None
    if ends is None:
        return _Axes(np.zeros(2), np.array([1.0, 0.0]))
    return _Axes(ends[0], ends[1] - ends[0])


def _ears(heard: Sequence[Any], outlines: dict[Any, Outline]) -> list[tuple[float, float, float]]:
    """Return two ears above the middle of the bodies."""
    ends = np.concatenate([outlines[body].ends for body in heard])
    middle, height = 0.5 * (ends[:, 0].min() + ends[:, 0].max()), ends[:, 1].max() + HEIGHT
    return [(float(middle + side * SPACING / 2.0), 0.0, float(height)) for side in (-1.0, 1.0)]


Part = tuple[Array, Array, dict[str, Any]]


def _of_track(
    run: xr.Dataset,
    system: System,
    track: Any,
    outline: Outline,
    seen: Array,
    baffled: bool,
    air: Air,
    sample_rate: float | None,
) -> Part:
    name, starts = system.body_name(track), system.initial_equilibrium is not None
    pressing = _on_it(run, system, track)
    if starts:
        # It has been in equilibrium before.
        pressing = pressing.assign(normal_force=pressing["normal_force"] - pressing["normal_force"].isel(time=0))
    places = _axes(track).listeners(seen - [outline.place[0], 0.0, outline.place[1]])
    otherwise = is_driven_otherwise(system, track)
    still = "its forces never change" if starts else "the contact never presses"
    pressure, time, _, attributes = track_sound(
        pressing,
        track,
        places,
        baffled,
        air,
        sample_rate,
        (f"{name} is silent", "nothing pushes" if otherwise else still),
        name,
        (lambda: TrackMotion(run, system, track)) if otherwise else None,
    )
    return pressure, time, attributes


def _on_it(run: xr.Dataset, system: System, track: Any) -> xr.Dataset:
    """Return the contacts of a record that move along a track."""
    numbers = [number for number, contact in enumerate(system.contacts) if contact.path_body == track]
    if "contact" not in run.dims:
        return run
    names, shown = [system.contact_names[number] for number in numbers], run["contact"].values.tolist()
    if not set(shown) & set(system.contact_names):
        return run.isel(contact=numbers)
    return run.sel(contact=[name for name in names if name in shown])


def _of_beams(
    run: xr.Dataset,
    system: System,
    beams: Sequence[Any],
    outlines: dict[Any, Outline],
    seen: Array,
    wall: float | None,
    air: Air,
    sample_rate: float | None,
    silent: Sequence[str],
) -> Part:
    """Return the sound of slim beams, with that of their images behind a wall."""
    moved = recorded_motion(run, system, beams) or redriven(run, system, beams)
    recorded = 1.0 / moved.interval
    ratio = ratio_of(sample_rate, recorded, moved.samples)
    bandwidth, shift = bandwidth_of(ratio, recorded), (moved.first - moved.start) / moved.interval
    pressure = np.zeros((len(seen), moved.samples))
    distances: list[Array] = []
    notes = ["silence: nothing pushes the beams"] if moved.pushed is None else []
    images = [seen] if wall is None else [seen, seen * [1.0, 1.0, -1.0] + [0.0, 0.0, 2.0 * wall]]
    for body in beams:
        first, last = moved.spans[system.body_name(body)]
        numbers = first + np.flatnonzero(moved.accelerations[first:last].any(axis=1))
        travel, reach = travel_of(run, system, body)
        x, y = outlines[body].place
        # Along world x, across the plane and along world y.
        along, across = (np.array([axis[0], 0.0, axis[1]]) for axis in body.axes)
        frame, origin = np.array([along, [0.0, 1.0, 0.0], across]), np.array([x + travel[0], 0.0, y + travel[1]])
        beam = slim_beam(body, system.is_held(body), numbers - first, frame, origin)
        distances.append(beam.distances(seen))
        for places in images if numbers.size else []:
            responses = beam.responses(places, air, Sampling(moved.interval, bandwidth, shift))
            pressure += convolved(responses, moved, numbers)
        name = system.body_name(body)
        notes += [line_note(name, body, air), *travel_note(name, reach)]
    sounding = resample(pressure, ratio)
    times = np.arange(sounding.shape[1]) * moved.interval / float(ratio)
    nearest = np.min(distances, axis=0)
    sounding[times < nearest[:, None] / air.speed] = 0.0
    modes = sum(last - first for first, last in (moved.spans[system.body_name(body)] for body in beams))
    notes += lacks(system, beams, silent, [moved])
    attributes = {"bandwidth": bandwidth, "modes": modes, "baffled": int(wall is not None), "motion": moved.words}
    return sounding, moved.start + times, {**attributes, "distance": nearest.tolist(), "notes": "; ".join(notes)}


def _added(parts: Sequence[Part]) -> tuple[Array, dict[str, Any]]:
    """Return the sum of sounds and their common attributes."""
    attributes = dict(parts[0][2])
    attributes["modes"] = sum(one["modes"] for *_, one in parts)
    attributes["motion"] = " or ".join(dict.fromkeys(one["motion"] for *_, one in parts))
    attributes["distance"] = np.min([one["distance"] for *_, one in parts], axis=0).tolist()
    notes = [note for *_, one in parts for note in one["notes"].split("; ") if note]
    attributes["notes"] = "; ".join(dict.fromkeys(notes))
    return np.sum([pressure for pressure, *_ in parts], axis=0), attributes
