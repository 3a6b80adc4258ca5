"""Drawing of a system in space before its run: bodies in perspective, contacts, drives and connections."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint
from ..cards import eye_of, spoken
from ..checks import counted
from ..connections import ends, unit
from ..system import System
from .moved_bodies import check_surfaces, surfaces_of
from .plane_drawings import (
    CLOSED,
    CONTACT,
    FORCE,
    JOINT,
    NEAR,
    SLIDING,
    VELOCITY,
    Cluster,
    Placed,
    clustered,
    connection_value,
    handle,
    in_time,
    run_of,
    spoken_small,
)
from .rigid_surfaces import centres_of
from .slidings import sliding_of
from .space_sketches import SpaceSketch

# Lengths as shares of the extent: arrows, springs.
ARROW, LENGTH = 0.18, 0.1
# Largest numbers of contacts with drawn normals and with written speeds.
MOST_NORMALS, MOST_WORDS = 8, 3
# Angle of the arrow round a turning body [rad].
ARC = 0.35 * np.pi


class SpaceDrawing(SpaceSketch):
    """Drawing of a system in space before its run, with a title; other arguments as of `SpaceSketch`."""

    def __init__(self, system: System, view: tuple[float, float], title: str) -> None:
        check_surfaces(system)
        self.system = system
        super().__init__(surfaces_of(system, eye_of(view), moving=False), view)
        self._centres = centres_of(system)
        self._draw_bodies()
        self._draw_connections()
        self._draw_contacts()
        self._draw_drives()
        self._finish(title)

    def _place(self, point: BodyPoint) -> Array | None:
        """Return the place of a point, if it is known [m]."""
        body: Any = point.body
        return self._centres[body] + body.offset(point.position) if body in self._centres else point.place

    def _draw_bodies(self) -> None:
        bodies = {self.system.body_name(body): body for body in self.system.bodies}
        turning = {}
        for one in self._shown:
            turns = getattr(bodies[one.name], "turning", 0.0)
            if isinstance(turns, float) and turns != 0.0:
                turning[one.name] = turns
        self._draw_surfaces(
            [
                f"{one.name}, turns at {spoken(turning[one.name], 'rad/s')}" if one.name in turning else one.name
                for one in self._shown
            ]
        )
        for one in self._shown:
            if one.name in turning:
                self._draw_turn(bodies[one.name], one.surface.place)
        drawn = {one.name for one in self._shown}
        left = [name for name in bodies if name not in drawn]
        if left:
            self.caption.append(f"not drawn, as their places are not known: {', '.join(left)}")

    def _draw_turn(self, body: Any, places: Array) -> None:
        """Draw the sense in which a body turns as an arc round its axis."""
        first, second, axis = body.frame
        away = places - np.array(body.origin)
        radius = 1.06 * float(np.linalg.norm(away - np.outer(away @ axis, axis), axis=1).max())
        height = float((away @ axis).max())
        angles = np.sign(body.turning) * np.linspace(0.0, ARC, 40)
        ring = np.outer(np.cos(angles), first) + np.outer(np.sin(angles), second)
        arc = np.array(body.origin) + height * axis + radius * ring
        self._line(arc, VELOCITY, 1.8)
        self._head(arc[-1], arc[-1] - arc[-2], VELOCITY)
        self._legend("prescribed velocity", VELOCITY)

    def _draw_connections(self) -> None:
        found: list[Placed] = []
        for connection in self.system.connections:
            place = self._place(connection.first)
            words = f"{connection.kind} {connection_value(connection)}"
            if place is None:
                self.caption.append(f"{words}, not drawn")
                continue
            way = unit(connection)
            others = [self._place(point) for point in ends(connection)[1:]]
            if others and others[0] is not None:
                found.append((others[0] - place, (connection.kind, "joint"), words, place))
            else:
                away = way if way @ (place - self.middle) > 0.0 else -way
                found.append((LENGTH * self.extent * away, (connection.kind, np.abs(way).tobytes()), words, place))
        counts: dict[str, int] = {}
        for one in clustered(found, 0.0):
            end = one.place + one.things[0]
            self._line(np.array([one.place, end]), JOINT, 1.3, linestyle=":" if "dashpot" in one.words else "-")
            self._dots(end[None], "s", JOINT, 3.0)
            counts[one.words] = counts.get(one.words, 0) + len(one.things)
        for words, count in counts.items():
            label = words if count == 1 else f"{words}, each of {count}"
            style = ":" if "dashpot" in words else "-"
            self._handles[words] = handle(label, JOINT, linestyle=style, marker="s", markersize=3)

    def _draw_contacts(self) -> None:
        found, places = [], []
        for contact in self.system.contacts:
            known = [self._place(end) for end in (contact.tip, contact.touched_point) if end is not None]
            place = next((one for one in known if one is not None), None)
            if place is not None:
                places.append(place)
                sliding = sliding_of(contact, self.system)
                towards = None if sliding is None else sliding.way.round(1).tobytes()
                kind = (contact.surface, contact.frame[0].round(1).tobytes(), towards)
                found.append(((contact, sliding), kind, "", place))
        self.caption += contact_lines(self.system)
        if not places:
            return
        self._dots(np.array(places), "o", CONTACT, 4.0, markeredgecolor="black", markeredgewidth=0.5)
        self._handles["contact"] = handle("contact", CONTACT, marker="o", markeredgecolor="black", linestyle="none")
        words, shown = "direction in which a tip slides", spread(clustered(found, NEAR * self.extent), MOST_NORMALS)
        speeds = [sliding.words for (_, sliding), *_ in found if sliding is not None and sliding.words]
        if len(shown) > MOST_WORDS and speeds:
            words = f"{words}, at {run_of(dict.fromkeys(sorted(speeds, key=lambda one: float(one.split()[0]))))}"
        for one in shown:
            contact, sliding = one.things[0]
            normal = np.resize(contact.frame[0], 3) if len(contact.frame) == 3 else np.append(contact.frame[0], 0.0)
            self._arrow(
                one.place, one.place + 0.4 * ARROW * self.extent * normal, "black", "normal of a contact", "", 1.0
            )
            if sliding is not None:
                way = np.append(sliding.way, 0.0)[:3]
                start = one.place + 0.04 * self.extent * normal
                label = sliding.words if len(shown) <= MOST_WORDS else ""
                self._arrow(start, start + 0.7 * ARROW * self.extent * way, SLIDING, words, label)

    def _draw_drives(self) -> None:
        forces = []
        for drive in self.system.drives:
            name = "" if drive.acted_on is None else f"{self.system.body_name(drive.acted_on)}: "
            if drive.push is None:
                self.caption.append(f"{name}{drive}")
                continue
            history, point, components = drive.push
            place, size = self._place(point), float(np.linalg.norm(components))
            if place is None or not size:
                self.caption.append(f"{name}{drive}, not drawn")
            else:
                way = components / size
                forces.append((way, way.round(9).tobytes(), f"{spoken(size, 'N')}{in_time(history)}", place))
        for one in clustered(forces, NEAR * self.extent):
            tail = one.place - ARROW * self.extent * one.things[0]
            self._arrow(tail, one.place, FORCE, "force", one.label, at_tail=True)


def contact_lines(system: System) -> list[str]:
    """Return friction and gaps of contacts in words: a line for each surface, and for others that are alike."""
    alike: dict[tuple[str, str, str], list[tuple[str, float]]] = {}
    for name, contact in zip(system.contact_names, system.contacts, strict=True):
        gap = contact.gap if abs(contact.gap) > CLOSED else 0.0
        key = contact.surface, str(contact.friction), "" if contact.surface else spoken_small(gap)
        alike.setdefault(key, []).append((name, gap))
    lines = []
    for (surface, friction, _), contacts in alike.items():
        names, gaps = zip(*contacts, strict=True)
        ends = dict.fromkeys(spoken_small(one) if one else "0" for one in (min(gaps), max(gaps)))
        gap_words = f", gap {' to '.join(ends)}" if any(gaps) else ""
        who = f"{surface}, {counted(len(names), 'point')}" if surface else run_of(names)
        lines.append(f"{who}: friction {friction}{gap_words}")
    return lines


def spread(things: list[Cluster], most: int) -> list[Cluster]:
    """Return at most a given number of things, taken evenly."""
    return things if len(things) <= most else [things[k] for k in np.linspace(0, len(things) - 1, most).astype(int)]
