"""Bodies in the plane as lines, or as points if they have no line: their places and mode shapes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .arrays import Array
from .bodies import BodyPoint
from .checks import ArgumentError
from .connections import ends
from .contact import PointContact
from .places import joints_of, origins_of, touched_at_rest


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
    origins = _origins(system)
    outlines = []
    for thing, origin in origins.items():
        is_line = hasattr(thing, "drawn_places")
        ends = origin + np.outer(thing.ends, thing.axes[0]) if is_line else origin[None]
        outlines.append(Outline(thing if is_line else thing.body, origin, ends))
    tips = [origins[_thing(contact.tip)] + _offset(contact.tip)[:2] for contact in system.contacts]
    return outlines, np.array(tips)


def places_in(system: Any) -> Callable[[BodyPoint], Array | None]:
    """Return a function that gives the place of a point of a system in the plane at rest [m], as in `lines_of`.

    Its result has the shape (2,), and is None for a point that touches nothing, is joined to nothing and is on no line.
    """
    origins = _origins(system)

    def place(point: BodyPoint) -> Array | None:
        origin = origins.get(_thing(point))
        return None if origin is None else np.asarray(origin + _offset(point)[:2])

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
    joints = list(joints_of(system))
    points = [point for joint in joints for point in (joint.first, joint.second) if point is not None]
    points += [point for one in system.connections for point in ends(one)]
    origins = _origins(system)
    numbers = {thing: number for number, thing in enumerate(origins)}
    lines = [_line(thing, origin, points, system) for thing, origin in origins.items()]

    def found(point: BodyPoint) -> tuple[int, int]:
        number = numbers[_thing(point)]
        return number, lines[number].rows[point.position]

    touches = []
    for contact in system.contacts:
        touched = touched_at_rest(contact)
        touches.append(Touch(contact, found(contact.tip), None if touched is None else found(touched)))
    return lines, touches


def check_in_plane(system: Any) -> None:
    """Raise ValueError if bodies of a system are in space."""
    if system.is_spatial:
        kinds = sorted({type(body).__name__ for body in system.bodies if body.is_spatial})
        words = "be in the plane, or have a SolidBody or an AxisymmetricBody, to be filmed"
        raise ArgumentError("system", words, system, got=", ".join(kinds))


def _thing(point: BodyPoint) -> Any:
    """Return the thing drawn for a point: its body if that has a line, else the point."""
    return point.body if hasattr(point.body, "drawn_places") else point


def _abscissa(point: BodyPoint) -> float:
    """Return the abscissa of a point on the line of its body [m]."""
    body: Any = point.body
    position: Any = point.position
    return float(body.abscissa(position) if hasattr(body, "abscissa") else position)


def _offset(point: BodyPoint) -> Array:
    """Return the place of a point relative to the drawn thing that it belongs to [m], shape (3,)."""
    body: Any = point.body
    return np.asarray(body.offset(point.position)) if _thing(point) is body else np.zeros(3)


def _origins(system: Any) -> dict[Any, Array]:
    """Return the places of all drawn things of a system in the plane [m], shape (2,) each."""
    return {thing: place[:2] for thing, place in origins_of(joints_of(system), _thing, _offset, {}).items()}


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
