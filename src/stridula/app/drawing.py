"""Drawings of a system on the page: two beams, lines as in films, or surfaces in space."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, Protocol

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint
from ..connections import ends, unit
from ..integration.live import LiveChunk, LiveMarch
from ..lines import Line, Touch, lines_of
from ..records.provenance import is_pair
from ..system import System
from .drawing_space import Surfaces
from .parts import Shapes, contacts_now

TRACK_POINTS = 65
# Largest number of points drawn of a line.
MOST_POINTS = 129


class Drawing(Protocol):
    """Drawing of a system."""

    @property
    def system(self) -> System:
        """The system."""

    @property
    def described(self) -> dict[str, Any]:
        """Description for the page, in plain numbers and texts."""

    def shapes(self, live: LiveMarch, chunk: LiveChunk) -> Shapes:
        """Return the positions of the bodies at the end of a chunk."""


def drawing_of(system: System) -> Drawing:
    """Return the drawing of a system."""
    if system.is_spatial:
        return Surfaces(system)
    return TwoBeams(system) if is_pair(system) else Lines(system)


@dataclass(frozen=True)
class TwoBeams:
    """A slider and the beam that it slides on.

    Attributes
    ----------
    system : System
        The system.
    """

    system: System

    @property
    def described(self) -> dict[str, Any]:
        """Lengths and angle."""
        slider, track = self.system.slider, self.system.track
        return {"slider": {"length": slider.length, "angle": slider.angle}, "track": {"length": track.length}}

    def shapes(self, live: LiveMarch, chunk: LiveChunk) -> Shapes:
        """Return the positions of the bodies at the end of a chunk."""
        position, spans, system = live.position, live.spans, self.system
        slider, track = system.slider, system.track
        nodes = slider.node_traces(system.is_held(slider)) @ position[slice(*spans[system.body_name(slider)])]
        moved = nodes.reshape(-1, 3)[:, :2]
        first, _ = spans[system.body_name(track)]
        waves = track.harmonics[0]
        deflection = _sines(waves) @ (track.amplitude * position[first : first + waves])
        place, height = (float(chunk.contact[name][-1]) for name in ("contact_position", "contact_height"))
        return Shapes(place, height, moved - moved[0], np.asarray(deflection))


@lru_cache(maxsize=64)
def _sines(waves: int) -> Array:
    """Return the values of sines over a track, shape (points, waves)."""
    return np.sin(np.outer(np.linspace(0.0, np.pi, TRACK_POINTS), np.arange(1, waves + 1)))


@dataclass(frozen=True)
class _Drawn:
    """A line with fewer points, and the contact with which it travels along its track."""

    line: Line
    kept: Array
    slides: int | None

    @cached_property
    def shapes(self) -> Array:
        return self.line.shapes[self.kept]

    def row(self, row: int) -> int:
        """Return the index of a point of the whole line among those kept."""
        return int(np.flatnonzero(self.kept == row)[0])


class Lines:
    """Bodies drawn as lines, as in films, or as points.

    Parameters
    ----------
    system : System
        The system.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        lines, self.touches = lines_of(system)
        self.lines = [_drawn(number, line, self.touches) for number, line in enumerate(lines)]

    @cached_property
    def described(self) -> dict[str, Any]:
        """Places at rest, contacts and connections."""
        lines = [
            {
                "name": one.line.name,
                "count": int(np.count_nonzero(one.kept < one.line.count)),
                "places": one.line.place[one.kept].tolist(),
                "slides": one.slides is not None,
            }
            for one in self.lines
        ]
        contacts = [self._contact(number) for number in range(len(self.touches))]
        joined = [
            {"ends": [self._end(point) for point in ends(one)], "along": unit(one)[:2].tolist()}
            for one in self.system.connections
            if all(map(self._is_drawn, ends(one)))
        ]
        return {"lines": lines, "contacts": contacts, "joined": joined}

    def shapes(self, live: LiveMarch, chunk: LiveChunk) -> Shapes:
        """Return the positions of the bodies at the end of a chunk."""
        places = chunk.contacts["contact_position"][:, -1]
        moved = []
        for one in self.lines:
            departed = one.shapes @ live.position[slice(*live.spans[one.line.name])]
            travel = np.zeros(2)
            if one.slides is not None:
                touch = self.touches[one.slides]
                tangent = touch.contact.frame[1]
                travel = (places[one.slides] - touch.contact.at) * tangent
                departed = departed - (departed[one.row(touch.tip[1])] @ tangent) * tangent
            moved += [travel[None], departed]
        height = float(chunk.contact["contact_height"][-1])
        return Shapes(float(places[0]), height, np.concatenate(moved), np.zeros(0), contacts_now(live, chunk))

    def _contact(self, number: int) -> dict[str, Any]:
        touch = self.touches[number]
        contact, (normal, tangent) = touch.contact, touch.contact.frame
        line, row = touch.tip
        told: dict[str, Any] = {
            "name": self.system.contact_names[number],
            "tip": [line, self.lines[line].row(row)],
            "normal": normal.tolist(),
            "tangent": tangent.tolist(),
            "touched": None,
            "passes": bool(contact.surface_velocities[0]) or touch.touched is None,
        }
        if touch.fixed is not None:
            on, place = touch.fixed
            told["touched"] = [on, self.lines[on].row(place)]
        return told

    def _is_drawn(self, point: BodyPoint) -> bool:
        """Return whether a point is drawn: for bodies without a line only points of contacts or connections."""
        return any(self._has(one, point) for one in self.lines)

    def _has(self, one: _Drawn, point: BodyPoint) -> bool:
        return one.line.name == self.system.body_name(point.body) and point.position in one.line.rows

    def _end(self, point: BodyPoint) -> list[int]:
        number, found = next((number, one) for number, one in enumerate(self.lines) if self._has(one, point))
        return [number, found.row(found.line.rows[point.position])]


def _drawn(number: int, line: Line, touches: list[Touch]) -> _Drawn:
    """Return a line with at most `MOST_POINTS` points, plus those of contacts and connections."""
    along = np.unique(np.linspace(0, line.count - 1, min(line.count, MOST_POINTS)).round().astype(int))
    kept = np.concatenate([along, np.arange(line.count, len(line.place))])
    slides = [k for k, one in enumerate(touches) if one.tip[0] == number and one.fixed is None]
    return _Drawn(line, kept, slides[0] if slides else None)
