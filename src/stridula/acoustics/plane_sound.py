"""The sound of a system in the plane: its tracks, and its slim beams as lines of dipoles.

Bodies have the axes along world x, across the plane and along world y. A wall that tracks are flush with reflects the
sound of beams in front of it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError
from ..connections import ends
from ..lines import Outline, outlines_of
from ..records.changes import check_one_system, check_one_track
from ..records.checked import record
from ..system import System
from .air import Air
from .bodies_sound import Listening
from .driven import pressed_motion
from .listeners import HEIGHT, SPACING, check_in_front, ears, listeners_of
from .motions import Motion
from .panels import Panel, panel_of
from .recorded import along_track, pressing
from .recorded_motion import at_one_rate, recorded_motion
from .redriven import redriven
from .responses import Way, way_of
from .slim_beams import SlimBeam, line_along
from .sounding import Flat, Sounding, Wall
from .system_sound import chosen, system_sound
from .travels import travel_of

# Tracks whose heights differ by less lie in one plane [m].
LEVEL = 1e-9


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
    tracks = _tracks(system)
    heard, silent = chosen(system, bodies, plane_bodies(system))
    run = at_one_rate(run, system, heard)
    outlines = {one.body: one for one in outlines_of(system)[0]}
    is_walled = _is_walled(tracks, outlines, baffled)
    if listener is None:
        listener = ears(tracks[0]) if tracks else _ears(heard, outlines)
    places = listeners_of(listener)
    if is_walled:
        check_in_front(places)
    # Listeners have the axes of the first track.
    frame, corner = _axes(tracks[0], outlines[tracks[0]]) if tracks else (np.eye(3), np.zeros(3))
    wall = Wall(corner, frame[2]) if is_walled else None
    ways = {one: way_of(one, is_walled, system.body_name(one)) for one in tracks if one in heard}
    sources: dict[Any, Sounding] = {
        one: Flat(system.body_name(one), way, *_axes(one, outlines[one])) for one, way in ways.items()
    }
    sources |= {one: _line(run, system, one, outlines[one]) for one in heard if one not in ways}
    listening = Listening(corner + places @ frame, air, wall, sample_rate)
    pressure, time, attributes = system_sound(
        run, system, sources, lambda: _motions(run, system, heard, ways), listening, silent
    )
    return pressure, time, places, attributes


def plane_bodies(system: System) -> list[Any]:
    """Return the bodies of a system in the plane that can be heard, its tracks first."""
    return [*_tracks(system), *_beams(system)]


def check_plane(system: System) -> None:
    """Raise ValueError if `plane_sound` would refuse the tracks of a system with its default arguments."""
    tracks = _tracks(system)
    _is_walled(tracks, {one.body: one for one in outlines_of(system)[0]}, None)
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


def _is_walled(tracks: Sequence[Any], outlines: Mapping[Any, Outline], baffled: bool | None) -> bool:
    """Return whether tracks are flush with a baffle."""
    if baffled is False or (baffled is None and not tracks):
        return False
    if not tracks:
        raise ArgumentError("baffled", "be False, or left out, without a track that radiates sound", baffled)
    heights = [float(outlines[one].place[1]) for one in tracks]
    if max(heights) - min(heights) > LEVEL:
        raise ArgumentError("baffled", "be False where tracks do not lie in one plane", got=baffled or "left out")
    return True


def _axes(track: Any, outline: Outline) -> tuple[Array, Array]:
    """Return directions of a track along x, along y and across its surface, shape (3, 3), and where both are zero."""
    place = np.array([outline.place[0], 0.0, outline.place[1]])
    if not hasattr(track, "track_line"):
        return np.eye(3), place
    start, end = np.column_stack(panel_of(track).place(np.array([0.0, 1.0])))
    along, left = end - start
    frame = np.array([[along, -left, 0.0], [left, along, 0.0], [0.0, 0.0, 1.0]])
    return frame, place - start @ frame[:2]


def _ears(heard: Sequence[Any], outlines: dict[Any, Outline]) -> list[tuple[float, float, float]]:
    """Return two ears above the middle of the bodies."""
    ends = np.concatenate([outlines[body].ends for body in heard])
    middle, height = 0.5 * (ends[:, 0].min() + ends[:, 0].max()), ends[:, 1].max() + HEIGHT
    return [(float(middle + side * SPACING / 2.0), 0.0, float(height)) for side in (-1.0, 1.0)]


def _line(run: xr.Dataset, system: System, beam: Any, outline: Outline) -> SlimBeam:
    """Return a beam as a line of dipoles, in the middle of its path."""
    travel, _ = travel_of(run, system, beam)
    along, across, origin = (np.array([x, 0.0, y]) for x, y in (*beam.axes, outline.place + travel[:2]))
    return line_along(system.body_name(beam), beam, system.is_held(beam), along, across, origin)


def _motions(run: xr.Dataset, system: System, bodies: Sequence[Any], ways: Mapping[Any, Way]) -> dict[Any, Motion]:
    """Return how bodies move: as recorded, as a track under the contacts along it alone, else driven again."""
    check = check_one_track if len(ways) == len(bodies) else check_one_system
    check(run)
    found, others = {}, []
    for body in bodies:
        motion = recorded_motion(run, body, system.body_name(body), system.is_held(body))
        if motion is None and body in ways and not _is_driven_otherwise(system, body):
            motion = _pressed(run, system, body, ways[body].panel)
        if motion is None:
            others.append(body)
        else:
            found[body] = motion
    again = redriven(run, system, others) if others else None
    return found | {body: again.of(system.body_name(body)) for body in others if again is not None}


def _pressed(run: xr.Dataset, system: System, track: Any, panel: Panel) -> Motion:
    """Return the motion of a track under the contacts along it, which may have been in equilibrium before."""
    run = along_track(run, system, track)
    if system.initial_equilibrium is None:
        return pressed_motion(panel, pressing(run, panel))
    changes = run["normal_force"] - run["normal_force"].isel(time=0)
    return pressed_motion(panel, pressing(run.assign(normal_force=changes), panel), "its forces never change")


def _is_driven_otherwise(system: System, track: Any) -> bool:
    """Return whether drives, a start in motion, connections or contacts at a fixed point act on a track."""
    moves = any(drive.starts_motion and drive.acted_on in (None, track) for drive in system.drives)
    joined = any(point.body == track for connection in system.connections for point in ends(connection))
    pushed = any(
        drive.fall is not None or (drive.push is not None and drive.acted_on == track) for drive in system.drives
    )
    touched = any(
        point is not None and point.body == track
        for contact in system.contacts
        for point in (contact.tip, contact.touched_point)
    )
    return moves or joined or pushed or touched or track.modes().damping_matrix is not None
