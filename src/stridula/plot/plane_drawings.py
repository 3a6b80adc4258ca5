"""Drawing of a system in the plane before its run: bodies to scale, supports, contacts, drives and connections."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from ..arrays import Array
from ..cards import spoken
from ..connections import ends, unit
from ..histories import History
from ..lines import outlines_of, places_in
from ..system import System
from .colours import LINE, LINES
from .slidings import sliding_of
from .symbols import CONNECTIONS, SUPPORTS, across, ground

FORCE, VELOCITY, SLIDING, CONTACT, JOINT = LINES[1], LINES[2], LINES[3], LINES[4], "0.25"
TRACK = "0.45"
# Lengths relative to the extent of the bodies: of arrows, of symbols of supports, and of springs, and the width of
# springs.
ARROW, SYMBOL, LENGTH, WIDTH = 0.16, 0.03, 0.13, 0.03
# Things with the same label that are closer than this are drawn once.
NEAR = 0.06
# Assumed extent of a point [m], length of a rigid track to both sides, and smallest ratio of height to width.
ALONE, REACH, LOWEST = 0.1, 0.45, 0.35
# Gaps that may be due to rounding [m].
CLOSED = 1e-12
# Labels stand above an arrow if the cosine of its angle to the horizontal is above this.
FLAT = 0.9
# Marks of supports in the legend.
MARKS = {"pinned": "^", "clamped": "|", "guided": "o"}


@dataclass(frozen=True)
class Cluster:
    """Nearby things with the same label.

    Attributes
    ----------
    words : str
        Label of each.
    things : list
        The things.
    place : ndarray
        Place of the first one [m].
    """

    words: str
    things: list[Any]
    place: Array

    @property
    def label(self) -> str:
        """Label, with the number of things."""
        count = len(self.things)
        return self.words if count == 1 else f"{self.words}, each of {count}"


# A thing, its key (shared by things that may be drawn as one), its label and its place [m].
Placed = tuple[Any, Hashable, str, Array]


def clustered(things: Iterable[Placed], near: float) -> list[Cluster]:
    """Return things, each with key, label and place, grouped where they are near and alike."""
    found: list[tuple[Hashable, Cluster]] = []
    for thing, kind, words, place in things:
        for known, one in found:
            if known == kind and one.words == words and np.linalg.norm(one.place - place) < near:
                one.things.append(thing)
                break
        else:
            found.append((kind, Cluster(words, [thing], place)))
    return [one for _, one in found]


def run_of(names: Iterable[str]) -> str:
    """Return the first and the last of several names, or one."""
    every = list(names)
    return every[0] if len(every) == 1 else f"{every[0]} to {every[-1]}"


def in_time(history: History) -> str:
    """Return a description of a drive over time, empty for a constant one."""
    return "" if history.settled == 0.0 else f", {history.kind}"


class PlaneDrawing:
    """Drawing of a system in the plane before its run.

    Parameters
    ----------
    axes : matplotlib.axes.Axes
        Axes to draw in.
    system : System
        The system.

    Attributes
    ----------
    caption : list of str
        Parts of the system without a place in the drawing.
    handles : list of Line2D
        Handles of the legend.
    shape : float
        Ratio of height to width of the drawing.
    """

    def __init__(self, axes: Axes, system: System) -> None:
        self.axes, self.system = axes, system
        self.outlines, self.tips = outlines_of(system)
        self.place: Callable[[Any], Array | None] = places_in(system)
        everything = np.concatenate([self.tips, *(one.ends for one in self.outlines)])
        self.middle = 0.5 * (everything.min(axis=0) + everything.max(axis=0))
        self.extent = float(np.ptp(everything, axis=0).max()) or ALONE
        self.seen, self.caption, self._handles = [everything], list[str](), dict[str, Line2D]()
        self._draw_tracks()
        self._draw_bodies()
        self._draw_supports()
        self._draw_connections()
        self._draw_contacts()
        self._draw_drives()
        self._set_limits()

    @property
    def handles(self) -> list[Line2D]:
        """Handles of the legend."""
        return list(self._handles.values())

    def _lines(self, lines: Sequence[Array], **look: Any) -> None:
        """Draw lines of one look."""
        self.axes.add_collection(LineCollection(list(lines), capstyle="round", **look))
        self.seen += lines

    def _arrow(self, tail: Array, head: Array, colour: str, words: str, label: str, at_tail: bool = True) -> None:
        """Draw an arrow with a label at one end, described in the legend."""
        look = {
            "arrowstyle": "-|>",
            "color": colour,
            "linewidth": 1.8,
            "shrinkA": 0,
            "shrinkB": 0,
            "mutation_scale": 13,
        }
        self.axes.annotate("", _pair(head), _pair(tail), arrowprops=look, zorder=6)
        self.seen.append(np.array([tail, head]))
        way = (tail - head if at_tail else head - tail) / np.linalg.norm(head - tail)
        if label and abs(way[0]) > FLAT:
            self._say(label, 0.5 * (tail + head), np.array([0.0, 1.0]), colour)
        elif label:
            self._say(label, tail if at_tail else head, way, colour)
        if words not in self._handles:
            self._handles[words] = handle(words, colour, marker=">", markersize=5, linewidth=1.8)

    def _say(self, words: str, place: Array, way: Array, colour: str) -> None:
        """Write words at a place, away from it along a direction."""
        side = "left" if way[0] > 0.3 else "right" if way[0] < -0.3 else "center"
        up = "bottom" if way[1] > 0.3 else "top" if way[1] < -0.3 else "center"
        look: dict[str, Any] = {"color": colour, "fontsize": 8, "ha": side, "va": up, "zorder": 9}
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 0.5}
        self.axes.annotate(words, _pair(place), _pair(5.0 * way), textcoords="offset points", bbox=box, **look)

    def _draw_bodies(self) -> None:
        sliding = {contact.tip.body for contact in self.system.contacts}
        points = []
        for one in self.outlines:
            colour = LINE if one.body in sliding else TRACK
            name = self.system.body_name(one.body)
            if len(one.ends) == 1:
                self.axes.plot(*one.ends.T, "s", color=colour, markersize=9, zorder=3)
                points.append((name, colour, "", one.ends[0]))
            else:
                self._draw_line(one.ends, thickness_of(one.body), colour)
                tension = getattr(one.body, "tension", 0.0)
                words = name + (f", tension {spoken(tension, 'N')}" if tension else "")
                self._say(words, *self._beside(one), colour)
        for cluster in clustered(points, NEAR * self.extent):
            self._say(run_of(dict.fromkeys(cluster.things)), cluster.place, np.array([0.9, 0.9]), LINE)

    def _draw_line(self, places: Array, thickness: float, colour: str) -> None:
        way = (places[1] - places[0]) / np.linalg.norm(places[1] - places[0])
        half = 0.5 * thickness * np.array([-way[1], way[0]])
        corners = np.array([places[0] + half, places[1] + half, places[1] - half, places[0] - half])
        self.axes.fill(*corners.T, facecolor=colour, alpha=0.3, edgecolor=colour, linewidth=0.8, zorder=2)
        self.axes.plot(*places.T, color=colour, linewidth=1.2, zorder=2.5)
        self.seen.append(corners)

    def _beside(self, one: Any) -> tuple[Array, Array]:
        """Return place and direction for the name of a line: below tracks, beside sliders."""
        is_path = any(contact.path_body == one.body for contact in self.system.contacts)
        share = 0.8 if is_path else 0.6
        place = (1.0 - share) * one.ends[0] + share * one.ends[1]
        along = one.ends[1] - one.ends[0]
        way = np.array([along[1], -along[0]]) / np.linalg.norm(along)
        return place, way if is_path or way[0] > 0.0 else -way

    def _draw_tracks(self) -> None:
        """Draw rigid tracks, which are infinite, with their velocities."""
        tracks = []
        for contact, tip in zip(self.system.contacts, self.tips, strict=True):
            if contact.rigid_track is not None:
                normal, tangent = contact.frame
                origin = tip - contact.gap * normal
                tracks.append(((normal, tangent, contact.rigid_track), tangent.tobytes(), "", origin))
        for one in clustered(tracks, REACH * self.extent):
            normal, tangent, track = one.things[0]
            width = 2.0 * REACH * self.extent
            surface = [one.place + width * np.array(share) * tangent for share in (-0.5, 0.5)]
            marks = [one.place + share * width * tangent for share in np.linspace(-0.5, 0.5, 25)]
            stroke = 0.018 * self.extent * (-normal - tangent)
            self._lines([np.array(surface)], colors=TRACK, linewidths=2.0, zorder=1)
            self._lines([np.array([mark, mark + stroke]) for mark in marks], colors="0.65", linewidths=0.8, zorder=1)
            self._say("rigid track", surface[1] - 0.06 * self.extent * normal, -normal, TRACK)
            self._draw_travel(one.place, normal, tangent, track)

    def _draw_travel(self, place: Array, normal: Array, tangent: Array, track: Any) -> None:
        values = (
            (track.velocity, tangent, "m/s", "history"),
            (track.normal_velocity, normal, "m/s", "normal_history"),
            (track.acceleration, tangent, "m/s²", "history"),
            (track.normal_acceleration, normal, "m/s²", "normal_history"),
        )
        for number, (value, way, units, history) in enumerate(values):
            if value:
                tail = place - (0.08 + 0.04 * number) * self.extent * normal - 0.3 * self.extent * tangent
                moved = np.sign(value) * way
                label = f"track {spoken(abs(value), units)}{in_time(getattr(track, history))}"
                self._arrow(tail, tail + ARROW * self.extent * moved, VELOCITY, "prescribed velocity", label)

    def _draw_supports(self) -> None:
        for one in self.outlines:
            for end, kind in zip(one.ends, supports_of(one.body), strict=False):
                if kind in SUPPORTS:
                    inwards = self._inwards(one, end, kind)
                    lines = SUPPORTS[kind](end, inwards, SYMBOL * self.extent)
                    self._lines(lines, colors="0.2", linewidths=1.0, zorder=2.8)
                    look = {"marker": MARKS[kind], "linestyle": "none", "markerfacecolor": "none"}
                    self._handles[kind] = handle(f"{kind} end", "0.2", **look)

    def _inwards(self, one: Any, end: Array, kind: str) -> Array:
        """Return the direction from an end into its support: beyond the end, or below a pinned beam."""
        outwards = end - one.ends.mean(axis=0)
        outwards /= np.linalg.norm(outwards)
        if kind != "pinned":
            return np.asarray(outwards)
        side = np.array([-outwards[1], outwards[0]])
        return side if side[1] < 0.0 or (side[1] == 0.0 and side[0] < 0.0) else -side

    def _draw_connections(self) -> None:
        found: list[Placed] = []
        for connection in self.system.connections:
            known = [self.place(point) for point in ends(connection)]
            places = [place for place in known if place is not None]
            words = f"{connection.kind} {connection_value(connection)}"
            if len(places) < len(known):
                self.caption.append(f"{words}, not drawn")
                continue
            way = unit(connection)[:2]
            between = places[1] - places[0] if len(places) > 1 else np.zeros(2)
            kind = (connection.kind, way.tobytes(), between.round(9).tobytes(), len(places))
            found.append(((connection, way, between, len(places)), kind, words, places[0]))
        together: dict[bytes, list[Cluster]] = {}
        for one in clustered(found, NEAR * self.extent):
            _, way, _, _ = one.things[0]
            key = np.round(np.append(one.place, np.abs(way)) / (NEAR * self.extent), 0).tobytes()
            together.setdefault(key, []).append(one)
        for several in together.values():
            for number, one in enumerate(several):
                self._draw_connection(one, number, len(several))

    def _draw_connection(self, one: Cluster, number: int, count: int) -> None:
        """Draw one of several connections beside each other."""
        connection, way, between, points = one.things[0]
        is_grounded = points == 1
        size, width = LENGTH * self.extent, WIDTH * self.extent
        is_joint = not is_grounded and float(np.linalg.norm(between)) > 0.3 * size
        if is_grounded:
            # It points away from the other bodies.
            away = float(way @ (one.place - self.middle))
            way = way if away > 1e-9 * self.extent else -way
        along = between if is_joint else size * way
        shift = 1.5 * width * number * np.array([-along[1], along[0]]) / np.linalg.norm(along)
        start, end = one.place + shift, one.place + along + shift
        lines = CONNECTIONS[connection.kind](start, end, width)
        if number:
            lines.append(np.array([one.place, start]))
        if is_grounded:
            lines += ground(end, along / np.linalg.norm(along), 1.5 * width)
        self._lines(lines, colors=JOINT, linewidths=1.2, zorder=2.6)
        side = along / np.linalg.norm(along)
        if not is_grounded or abs(side[0]) > FLAT:
            below = across(side) * (-1.0 if across(side)[1] > 0.0 else 1.0)
            self._say(one.label, 0.5 * (start + end) + width * below, below, JOINT)
        else:
            away = 0.0 if count == 1 else 1.0 if number else -1.0
            self._say(one.label, end + 0.5 * width * side, side + away * across(side), JOINT)

    def _draw_contacts(self) -> None:
        found, laws = [], dict[str, list[str]]()
        for name, contact, tip in zip(self.system.contact_names, self.system.contacts, self.tips, strict=True):
            sliding = sliding_of(contact, self.system)
            way = None if sliding is None else sliding.way
            kind = (contact.frame.tobytes(), None if way is None else way.round(6).tobytes())
            found.append(((name, contact, way), kind, "" if sliding is None else sliding.words, tip))
            gap = f", gap {spoken_small(contact.gap)}" if abs(contact.gap) > CLOSED else ""
            laws.setdefault(f"friction {contact.friction}{gap}", []).append(name)
        self.axes.plot(*self.tips.T, "o", color=CONTACT, markeredgecolor="black", markersize=6.5, zorder=8)
        dot = {"marker": "o", "markeredgecolor": "black", "linestyle": "none", "markersize": 6.5}
        self._handles["contact"] = handle("contact", CONTACT, **dot)
        for one in clustered(found, NEAR * self.extent):
            _, contact, way = one.things[0]
            normal = contact.frame[0]
            head = one.place + 0.5 * ARROW * self.extent * normal
            look = {"arrowstyle": "->", "color": "black", "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0}
            self.axes.annotate("", _pair(head), _pair(one.place), arrowprops=look, zorder=7)
            self._handles["normal"] = handle("normal of the contact", "black", linewidth=1.0, marker="4")
            self.seen.append(head[None])
            if way is not None:
                tail = one.place + 0.25 * ARROW * self.extent * normal
                words = "direction in which the tip slides"
                self._arrow(tail, tail + 0.8 * ARROW * self.extent * way, SLIDING, words, one.words, at_tail=False)
        for words, names in laws.items():
            self.caption.append(
                f"{run_of(names) if len(self.system.contacts) > 1 else names[0].removesuffix(' 1')}: {words}"
            )

    def _draw_drives(self) -> None:
        forces = []
        for drive in self.system.drives:
            if drive.push is None or not drive.push[2].any():
                continue
            history, point, components = drive.push
            place, size = self.place(point), float(np.linalg.norm(components))
            words = f"{spoken(size, 'N')}{in_time(history)}"
            if place is None:
                self.caption.append(f"{self.system.body_name(point.body)}: {drive}, not drawn")
            else:
                way = components[:2] / size
                forces.append((way, way.round(9).tobytes(), words, place))
        for one in clustered(forces, NEAR * self.extent):
            tail = one.place - ARROW * self.extent * one.things[0]
            self._arrow(tail, one.place, FORCE, "force", one.label)
        self._draw_motions()
        self._draw_fall()
        for drive in self.system.drives:
            if drive.push is None and drive.fall is None and drive.uniform_velocity is None:
                name = "" if drive.acted_on is None else f"{self.system.body_name(drive.acted_on)}: "
                self.caption.append(f"{name}{drive}")

    def _draw_motions(self) -> None:
        """Draw the imposed velocity and the initial velocities."""
        imposed = self.system.imposed_velocity
        if imposed is not None and imposed.velocity:
            place = self.place(imposed.point)
            if place is not None:
                label = f"{spoken(abs(imposed.velocity), 'm/s')}{in_time(imposed.history)}"
                head = place + ARROW * self.extent * np.array([np.sign(imposed.velocity), 0.0])
                self._arrow(place, head, VELOCITY, "prescribed velocity", label, at_tail=False)
        for drive in self.system.drives:
            moved = drive.uniform_velocity
            if moved is None or not moved.any():
                continue
            speed = float(np.linalg.norm(moved))
            place = next(one.ends.mean(axis=0) for one in self.outlines if one.body == drive.acted_on)
            tail = place + 0.04 * self.extent * np.array([-moved[1], moved[0]]) / speed
            head = tail + ARROW * self.extent * moved[:2] / speed
            words = f"{spoken(speed, 'm/s')} at the start"
            self._arrow(tail, head, VELOCITY, "prescribed velocity", words, at_tail=False)

    def _draw_fall(self) -> None:
        for drive in self.system.drives:
            if drive.fall is not None:
                size = float(np.linalg.norm(drive.fall))
                tail = tuple(-34.0 * drive.fall[:2] / size)
                look = {"arrowstyle": "-|>", "color": FORCE, "linewidth": 1.8, "shrinkA": 0, "shrinkB": 0}
                where: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "offset points", "arrowprops": look}
                words: dict[str, Any] = {"color": FORCE, "fontsize": 8, "ha": "left", "va": "bottom"}
                self.axes.annotate(f"gravity {size:.4g} m/s²", (0.05, 0.82), tail, **where, **words)

    def _set_limits(self) -> None:
        places = np.concatenate([np.reshape(one, (-1, 2)) for one in self.seen])
        low, high = places.min(axis=0), places.max(axis=0)
        width = float((high - low).max())
        room = np.maximum(high - low, LOWEST * width) + np.array([0.24, 0.14]) * width
        middle = 0.5 * (low + high)
        self.axes.set(
            xlim=(middle[0] - 0.5 * room[0], middle[0] + 0.5 * room[0]),
            ylim=(middle[1] - 0.5 * room[1], middle[1] + 0.5 * room[1]),
        )
        self.axes.set_aspect("equal")
        self.shape = float(room[1] / room[0])
        has_cut = any(hasattr(one.body, "track_line") for one in self.outlines)
        self.axes.set_xlabel("x along the cut through the plate [m]" if has_cut else "x [m]")
        self.axes.set_ylabel("y [m]")
        self.axes.grid(alpha=0.25, linewidth=0.5)


def _pair(place: Array) -> tuple[float, float]:
    return float(place[0]), float(place[1])


def handle(words: str, colour: Any, **look: Any) -> Line2D:
    """Return the handle of a legend for a thing without a line of its own."""
    return Line2D([], [], color=colour, label=words, **look)


def thickness_of(body: Any) -> float:
    """Return the thickness of a body in the plane [m], for a section without a shape that of an equal rectangle."""
    section = getattr(body, "section", None)
    if section is None:
        return float(getattr(body, "thickness", 0.0))
    for name in ("height", "diameter"):
        if hasattr(section, name):
            return float(getattr(section, name))
    return float(np.sqrt(12.0 * section.second_moment / section.area))


def supports_of(body: Any) -> tuple[str, ...]:
    """Return the supports of both ends of a line."""
    if hasattr(body, "root_support"):
        return body.tip_support, body.root_support
    return ("pinned", "pinned") if hasattr(body, "harmonics") else ()


def connection_value(connection: Any) -> str:
    """Return a description of the stiffness or coefficient of a connection, and of its motion."""
    if not hasattr(connection, "rates"):
        return str(connection).removeprefix(connection.kind).strip()
    if hasattr(connection, "stiffness_at_rest"):
        return f"{spoken(connection.stiffness_at_rest, 'N/m')} at rest"
    if connection.bend is not None:
        return f"from {connection.velocity[0]:.4g} to {connection.velocity[-1]:.4g} m/s"
    stiffness, damping = connection.rates
    words = spoken(stiffness, "N/m") if stiffness else spoken(damping, "N s/m")
    return f"{words}, moved{in_time(connection.history)}" if connection.moved_by else words


def spoken_small(length: float) -> str:
    """Return a length with a prefix to its unit [m]."""
    for prefix, size in (("", 1.0), ("m", 1e-3), ("µ", 1e-6)):
        if abs(length) >= size:
            return f"{length / size:.4g} {prefix}m"
    return f"{length / 1e-9:.4g} nm"
