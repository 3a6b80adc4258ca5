"""Coordinate systems of Nastran: rectangular, cylindrical and spherical, by points or by grids."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from graphlib import CycleError, TopologicalSorter
from typing import Protocol

import numpy as np

from ...arrays import Array
from .nastran_cards import Card, Where, refused

# Cards of systems by points and by grids; the last letter is the kind of coordinates.
BY_POINTS = ("CORD2R", "CORD2C", "CORD2S")
BY_GRIDS = ("CORD1R", "CORD1C", "CORD1S")
BASIC = 0


@dataclass(frozen=True)
class System:
    """A coordinate system.

    Attributes
    ----------
    kind : str
        Kind of coordinates: "R" for x, y, z; "C" for r, theta [deg], z; "S" for r, theta [deg] from z, phi [deg].
    origin : ndarray, shape (3,)
        Its place in the basic system.
    axes : ndarray, shape (3, 3)
        Its unit vectors x, y, z in the basic system, one a row.
    """

    kind: str
    origin: Array
    axes: Array

    def places(self, coordinates: Array) -> Array:
        """Return places in the basic system for coordinates of this one, both of shape (points, 3)."""
        found: Array = self.origin + _rectangular(self.kind, coordinates) @ self.axes
        return found

    def directions(self, places: Array) -> Array:
        """Return the unit vectors of its coordinates at places in the basic system, a row each, (points, 3, 3).

        Where an angle is not defined, on the axis, it is 0.
        """
        if self.kind == "R":
            return np.broadcast_to(self.axes, (len(places), 3, 3))
        x, y, z = self.axes @ (places - self.origin).T
        phi = np.arctan2(y, x)
        theta = np.arctan2(np.hypot(x, y), z) if self.kind == "S" else np.full_like(phi, 0.5 * np.pi)
        none = np.zeros_like(phi)
        outward = [np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)]
        down = [np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), -np.sin(theta)]
        around = [-np.sin(phi), np.cos(phi), none]
        upward = [none, none, np.ones_like(phi)]
        rows = [outward, down, around] if self.kind == "S" else [outward, around, upward]
        found: Array = np.einsum("rak->kra", np.array(rows)) @ self.axes
        return found


def _rectangular(kind: str, coordinates: Array) -> Array:
    if kind == "R":
        return coordinates
    radius, second, third = coordinates.T
    theta = np.radians(second)
    if kind == "C":
        return np.stack([radius * np.cos(theta), radius * np.sin(theta), third], axis=1)
    phi, across = np.radians(third), radius * np.sin(theta)
    return np.stack([across * np.cos(phi), across * np.sin(phi), radius * np.cos(theta)], axis=1)


class Grids(Protocol):
    """Grids as read, in their own systems."""

    def system_of(self, grid: int, user: str, where: Where) -> int:
        """Return the system of a grid, or raise DeckError in the name of its user."""
        ...

    def coordinates_of(self, grid: int) -> Array:
        """Return the coordinates of a grid in its system, shape (3,)."""
        ...


class Definition(Protocol):
    """The card of a system."""

    @property
    def name(self) -> str:
        """Name of the card and number of the system."""
        ...

    @property
    def where(self) -> Where:
        """Line of the card."""
        ...

    def needed(self, grids: Grids) -> list[int]:
        """Return the systems in which its points are given."""
        ...

    def points(self, grids: Grids, systems: Mapping[int, System]) -> Array:
        """Return origin, a point of the axis z and one of the plane x-z in the basic system, shape (3, 3)."""
        ...


@dataclass(frozen=True)
class ByPoints:
    """A system by three points in another one.

    Attributes
    ----------
    name : str
        Name of the card and number of the system.
    where : tuple of int and str
        Line of the card.
    reference : int
        Number of the other system.
    given : ndarray, shape (3, 3)
        Coordinates of the points.
    """

    name: str
    where: Where
    reference: int
    given: Array

    def needed(self, grids: Grids) -> list[int]:
        """Return the systems in which its points are given."""
        return [self.reference]

    def points(self, grids: Grids, systems: Mapping[int, System]) -> Array:
        """Return its points in the basic system."""
        return systems[self.reference].places(self.given)


@dataclass(frozen=True)
class ByGrids:
    """A system by three grids.

    Attributes
    ----------
    name : str
        Name of the card and number of the system.
    where : tuple of int and str
        Line of the card.
    given : tuple of int
        Numbers of the grids.
    """

    name: str
    where: Where
    given: tuple[int, int, int]

    def needed(self, grids: Grids) -> list[int]:
        """Return the systems of its grids."""
        return [grids.system_of(grid, self.name, self.where) for grid in self.given]

    def points(self, grids: Grids, systems: Mapping[int, System]) -> Array:
        """Return the places of its grids in the basic system."""
        places = zip(self.needed(grids), map(grids.coordinates_of, self.given), strict=True)
        return np.vstack([systems[system].places(coordinates[None]) for system, coordinates in places])


def definitions(card: Card) -> Iterator[tuple[int, Definition]]:
    """Yield numbers and definitions of the systems of a card, at most two."""
    if card.name in BY_POINTS:
        number = card.whole(0, "CID")
        titles = [f"{point}{axis}" for point in "ABC" for axis in (1, 2, 3)]
        given = [card.number(at, title, 0.0) for at, title in enumerate(titles, 2)]
        name = f"{card.name} {number}"
        yield number, ByPoints(name, card.where, card.whole(1, "RID", BASIC), np.reshape(given, (3, 3)))
        return
    for start in (0, 4):
        if start == 0 or card.text(start):
            number = card.whole(start, "CID")
            first, second, third = (card.whole(start + at, f"G{at}") for at in (1, 2, 3))
            yield number, ByGrids(f"{card.name} {number}", card.where, (first, second, third))


def systems_of(defined: Mapping[int, Definition], grids: Grids) -> dict[int, System]:
    """Return all systems in the basic one, which is system 0.

    Raises
    ------
    DeckError
        If a system refers to one that is missing, or to itself, or if its points lie on a line.
    """
    needed = {number: one.needed(grids) for number, one in defined.items()}
    for number, others in needed.items():
        for other in others:
            if other != BASIC and other not in defined:
                one = defined[number]
                raise refused(one.where, f"{one.name} refers to the coordinate system {other}, which is missing")
    found = {BASIC: System("R", np.zeros(3), np.eye(3))}
    try:
        order = list(TopologicalSorter(needed).static_order())
    except CycleError as error:
        one = defined[error.args[1][0]]
        raise refused(one.where, f"{one.name} refers to itself, by {_chain(error.args[1])}") from None
    for number in order:
        if number != BASIC:
            one = defined[number]
            found[number] = _system(one, one.points(grids, found))
    return found


def _chain(numbers: list[int]) -> str:
    shown = [str(number) for number in numbers[:8]]
    return " and ".join(shown) + (" and others" if len(numbers) > len(shown) else "")


def _system(one: Definition, points: Array) -> System:
    axis, side = points[1] - points[0], points[2] - points[0]
    z = axis / np.linalg.norm(axis)
    across = np.cross(z, side / np.linalg.norm(side))
    y = across / np.linalg.norm(across)
    if not (np.isfinite(y).all() and np.linalg.norm(across) > 1e-12):
        raise refused(one.where, f"the three points of {one.name} must not lie on a line")
    return System(one.name.split()[0][-1], points[0], np.array([np.cross(y, z), y, z]))
