"""Bodies in the plane as lines, or as points if they have no line: their places and mode shapes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import Array
from .bodies import BodyPoint
from .checks import ArgumentError
from .connections import ends
from .contact import PointContact


@dataclass(frozen=True, eq=False)
class Line:
    """A body in the plane as a line, or one of its points.

    Attributes
    ----------
    name : str
        Name of the body.
    along : ndarray, shape (points,)
        Abscissas of its points on the body [m]: first those of the line in order, then others.
    place : ndarray, shape (points, 2)
        World places at rest [m].
    shapes : ndarray, shape (points, 2, modes)
        World displacement of each point for unit modes [kg^(-1/2)].
    count : int
        Number of points that make the line.
    rows : mapping
        Number of the point at a position of the body, for positions in contact or joined.
    is_held : bool
        Whether it also moves along x by its imposed velocity.
    is_cut : bool
        Whether it is the cut through a plate.
    """

    name: str
    along: Array
    place: Array
    shapes: Array
    count: int
    rows: Mapping[Any, int]
    is_held: bool
    is_cut: bool

    def moved(self, modal: Array) -> Array:
        """Return the displacements of the points for modes in frames, shape (frames, modes), as (frames, points, 2)."""
        return np.einsum("pim,fm->fpi", self.shapes, modal)


@dataclass(frozen=True, eq=False)
class Touch:
    """A contact between lines.

    Attributes
    ----------
    contact : PointContact
        The contact.
    tip : tuple of int
        Number of the line of its tip, and number of the tip among its points.
    touched : tuple of int or None
        The same for the point that it touches at rest, None for a rigid track.
    """

    contact: PointContact
    tip: tuple[int, int]
    touched: tuple[int, int] | None

    @property
    def fixed(self) -> tuple[int, int] | None:
        """The point that it touches wherever the tip goes, None for a track along which the tip slides."""
        return self.touched if self.contact.path_body is None else None


@dataclass(frozen=True, eq=False)
class _Joint:
    """Two points and the offset at rest of the first from the second, or from the origin without a second [m]."""

    first: BodyPoint
    second: BodyPoint | None
    away: Array


@dataclass(frozen=True, eq=False)
class Outline:
    """A body in the plane at rest, without its modes.

    Attributes
    ----------
    body : object
        The body.
    place : ndarray, shape (2,)
        Place of the abscissa 0 of a line, or of the point if the body has no line [m].
    ends : ndarray, shape (points, 2)
        World places of both ends of a line, or of the point [m].
    """

    body: Any
    place: Array
    ends: Array


def outlines_of(system: Any) -> tuple[list[Outline], Array]:
    """Return the places of the lines and points of a system in the plane, and of its tips [m], shape (contacts, 2).

    The same as in `lines_of`, without a search for modes.
    """
    origins = _origins(list(_joints(system)))
    outlines = []
    for thing, origin in origins.items():
        is_line = hasattr(thing, "drawn_places")
        ends = origin + np.outer(thing.ends, thing.axes[0]) if is_line else origin[None]
        outlines.append(Outline(thing if is_line else thing.body, origin, ends))
    tips = [origins[_thing(contact.tip)] + _offset(contact.tip) for contact in system.contacts]
    return outlines, np.array(tips)


def places_in(system: Any) -> Callable[[BodyPoint], Array | None]:
    """Return what says where a point of a system in the plane is at rest [m], shape (2,), as `lines_of` has it.

    None of a point that touches nothing, is joined to nothing and lies on no line.
    """
    origins = _origins(list(_joints(system)))

    def place(point: BodyPoint) -> Array | None:
        origin = origins.get(_thing(point))
        return None if origin is None else np.asarray(origin + _offset(point))

    return place


def lines_of(system: Any) -> tuple[list[Line], list[Touch]]:
    """Return the lines and points of a system in the plane, and the contacts between them.

    The track of the first contact is where it is defined, along x; all others are where contacts and connections put
    them. Bodies without a line are points, one for each place where they touch another body or are joined to one.

    Raises
    ------
    ValueError
        If bodies are in space.
    """
    check_in_plane(system)
    joints = list(_joints(system))
    points = [point for joint in joints for point in (joint.first, joint.second) if point is not None]
    points += [point for one in system.connections for point in ends(one)]
    origins = _origins(joints)
    numbers = {thing: number for number, thing in enumerate(origins)}
    lines = [_line(thing, origin, points, system) for thing, origin in origins.items()]

    def found(point: BodyPoint) -> tuple[int, int]:
        number = numbers[_thing(point)]
        return number, lines[number].rows[point.position]

    touches = []
    for contact in system.contacts:
        touched = _touched(contact)
        touches.append(Touch(contact, found(contact.tip), None if touched is None else found(touched)))
    return lines, touches


def check_in_plane(system: Any) -> None:
    """Raise ValueError if bodies of a system are in space."""
    if system.is_spatial:
        kinds = sorted({type(body).__name__ for body in system.bodies if body.is_spatial})
        words = "be in the plane, or have a SolidBody or an AxisymmetricBody, to be filmed"
        raise ArgumentError("system", words, system, got=", ".join(kinds))


def _touched(contact: PointContact) -> BodyPoint | None:
    """Return the point that a contact touches at rest, None for a rigid track."""
    return contact.touched_point if contact.path_body is None else BodyPoint(contact.path_body, contact.at)


def _joints(system: Any) -> Iterator[_Joint]:
    for contact in system.contacts:
        normal, tangent = contact.frame
        along = 0.0 if contact.rigid_track is None else contact.at
        yield _Joint(contact.tip, _touched(contact), along * tangent + contact.gap * normal)
    for first, *second in map(ends, system.connections):
        for other in second:
            yield _Joint(first, other, np.zeros(2))


def _thing(point: BodyPoint) -> Any:
    """Return the thing drawn for a point: its body if that has a line, else the point."""
    return point.body if hasattr(point.body, "drawn_places") else point


def _abscissa(point: BodyPoint) -> float:
    """Return the abscissa of a point on the line of its body [m]."""
    body: Any = point.body
    position: Any = point.position
    return float(body.abscissa(position) if hasattr(body, "abscissa") else position)


def _offset(point: BodyPoint) -> Array:
    """Return the place of a point relative to the drawn thing that it belongs to [m]."""
    return _abscissa(point) * point.body.axes[0] if _thing(point) is point.body else np.zeros(2)


def _origins(joints: list[_Joint]) -> dict[Any, Array]:
    """Return the places of all drawn things [m]."""
    found: dict[Any, Array] = {}
    left = list(joints)
    while left:
        # A group that is joined to nothing placed so far starts where it would be alone.
        known = (
            k
            for k, one in enumerate(left)
            if one.second is None or {_thing(one.first), _thing(one.second)} & found.keys()
        )
        joint = left.pop(next(known, 0) if found else 0)
        away = joint.away + (0.0 if joint.second is None else _offset(joint.second)) - _offset(joint.first)
        if joint.second is None:
            found.setdefault(_thing(joint.first), away)
        elif _thing(joint.first) in found:
            found.setdefault(_thing(joint.second), found[_thing(joint.first)] - away)
        else:
            found[_thing(joint.first)] = found.setdefault(_thing(joint.second), np.zeros(2)) + away
    return found


def _line(thing: Any, origin: Array, points: list[BodyPoint], system: Any) -> Line:
    """Return the line of a body, or a point alone, with its points in contact or joined."""
    is_line = hasattr(thing, "drawn_places")
    body = thing if is_line else thing.body
    drawn = thing.drawn_places.tolist() if is_line else []
    ours = list(dict.fromkeys(point for point in points if _thing(point) == thing))
    along = np.array([*drawn, *(_abscissa(point) if is_line else 0.0 for point in ours)])
    held = system.is_held(body)
    shapes = np.array([body.trace(position, held) for position in (*drawn, *(point.position for point in ours))])
    if any(contact.path_body == body for contact in system.contacts):
        # The place of a tip along its track does not depend on the track's motion along itself.
        shapes[:, 0] = 0.0
    place = origin + along[:, None] * body.axes[0]
    rows = {point.position: len(drawn) + number for number, point in enumerate(ours)}
    return Line(system.body_name(body), along, place, shapes, len(drawn) or 1, rows, held, hasattr(body, "track_line"))
