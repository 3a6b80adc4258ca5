"""Nodes of Nastran with their coordinate systems, from tables of results or from decks."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array
from ..decks.nastran_cards import Card, Where, cards, refused
from ..decks.nastran_systems import BASIC, BY_GRIDS, BY_POINTS, ByGrids, ByPoints, Definition, definitions, systems_of
from ..reading.deck_error import DeckError

# Rectangular, cylindrical and spherical systems by the number of their kind.
KINDS = {1: "R", 2: "C", 3: "S"}
# Displacement system of points of fluid, which have none.
FLUID = -1
# Words of reals in a row, and whether they are double ones in a file of short words, by the size of the row.
REALS = {6: (0, False), 8: (3, False), 11: (6, True), 13: (9, False), 22: (18, True), 26: (18, True)}


@dataclass
class NastranNodes:
    """Grids and coordinate systems as read.

    Attributes
    ----------
    grids : dict
        System of the place, coordinates in it, system of the displacements, and line, by number.
    systems : dict
        Definitions of coordinate systems by number.
    """

    grids: dict[int, tuple[int, tuple[float, ...], int, Where]] = field(default_factory=dict)
    systems: dict[int, Definition] = field(default_factory=dict)

    def add_grid(self, number: int, system: int, place: tuple[float, ...], turned: int, where: Where) -> None:
        """Add a grid; the same one may come again."""
        one = self.grids.setdefault(number, (system, place, turned, where))
        if one[:3] != (system, place, turned):
            raise refused(where, f"GRID {number} is there twice, with other numbers")

    def add_system(self, number: int, one: Definition) -> None:
        """Add a coordinate system."""
        self.systems.setdefault(number, one)

    def system_of(self, grid: int, user: str, where: Where) -> int:
        """Return the system of a grid."""
        if grid not in self.grids:
            raise refused(where, f"{user} refers to the grid {grid}, which is missing")
        return self.grids[grid][0]

    def coordinates_of(self, grid: int) -> Array:
        """Return the coordinates of a grid in its system."""
        return np.array(self.grids[grid][1])

    def placed(self) -> tuple[Array, Array, Array]:
        """Return numbers in rising order, places (n, 3) and directions of displacements (n, 3, 3), a row each.

        Raises
        ------
        DeckError
            If a system is missing or has no axes.
        """
        systems = systems_of(self.systems, self)
        numbers = np.array(sorted(self.grids), dtype=np.int64)
        held = [self.grids[number] for number in numbers.tolist()]
        places = np.array([one[1] for one in held], dtype=float).reshape(-1, 3)
        of_place, turned = (np.array([one[at] for one in held], dtype=np.int64) for at in (0, 2))
        turned[turned == FLUID] = BASIC
        for used in (of_place, turned):
            for at, system in enumerate(used.tolist()):
                if system not in systems:
                    words = f"GRID {numbers[at]} refers to the coordinate system {system}, which is missing"
                    raise refused(held[at][3], words)
        for system in set(of_place.tolist()) - {BASIC}:
            these = of_place == system
            places[these] = systems[system].places(places[these])
        directions = np.broadcast_to(np.eye(3), (numbers.size, 3, 3)).copy()
        for system in set(turned.tolist()) - {BASIC}:
            these = turned == system
            directions[these] = systems[system].directions(places[these])
        return numbers, places, directions


def nodes_of_deck(path: str | os.PathLike[str]) -> NastranNodes:
    """Return the nodes of a deck of Nastran.

    Raises
    ------
    DeckError
        If a line cannot be read, or there are no grids.
    OSError
        If the file cannot be read.
    """
    found, grids, default = NastranNodes(), [], (BASIC, BASIC)
    for card in cards(path, {"GRID", "GRDSET", *BY_POINTS, *BY_GRIDS}):
        if card.name == "GRID":
            grids.append(card)
        elif card.name == "GRDSET":
            default = card.whole(1, "CP", BASIC), card.whole(5, "CD", BASIC)
        elif card.name in (*BY_POINTS, *BY_GRIDS):
            for number, one in definitions(card):
                found.add_system(number, one)
    if not grids:
        raise DeckError(0, "has no GRID: pass the deck of the model")
    for card in grids:
        found.add_grid(*_grid(card, default), card.where)
    return found


def _grid(card: Card, default: tuple[int, int]) -> tuple[int, int, tuple[float, ...], int]:
    place = tuple(card.number(at, f"X{at - 1}", 0.0) for at in (2, 3, 4))
    return card.whole(0, "ID"), card.whole(1, "CP", default[0]), place, card.whole(5, "CD", default[1])


def add_records(found: NastranNodes, table: str, key: int, words: Array) -> None:
    """Add the grids or coordinate systems of a record of a table of geometry.

    Parameters
    ----------
    found : NastranNodes
        Nodes read so far.
    table : str
        Name of the table, for messages.
    key : int
        First number of the record, its kind.
    words : ndarray of int32 or int64, shape (words,)
        The record after its three numbers.
    """
    if key == 4501:
        for row, places in zip(*_rows(words, (8, 11), f"GRID of {table}", 2, _is_grid), strict=True):
            found.add_grid(int(row[0]), int(row[1]), tuple(places[:3].tolist()), int(row[-3]), (0, ""))
    elif key in (2101, 2001, 2201):
        for row, given in zip(*_rows(words, (13, 22, 26), f"CORD2 of {table}", 4, _is_by_points), strict=True):
            name = f"CORD2{KINDS[int(row[1])]} {row[0]}"
            found.add_system(int(row[0]), ByPoints(name, (0, ""), int(row[3]), given[:9].reshape(3, 3)))
    elif key in (1801, 1701, 1901):
        for row in _rows(words, (6,), f"CORD1 of {table}", 6, _is_by_grids)[0]:
            name = f"CORD1{KINDS[int(row[1])]} {row[0]}"
            first, second, third = row[3:6].tolist()
            found.add_system(int(row[0]), ByGrids(name, (0, ""), (first, second, third)))


def _is_grid(rows: Array) -> bool:
    """Return whether rows are grids: numbers, systems, displacement systems, constraints and superelements."""
    constraints, superelements = rows[:, -2], rows[:, -1]
    own = ((rows[:, 0] > 0) & (rows[:, 1] >= 0) & (rows[:, -3] >= FLUID)).all()
    return bool(own and ((constraints >= 0) & (constraints <= 123456) & (superelements >= 0)).all())


def _is_by_points(rows: Array) -> bool:
    return bool((np.isin(rows[:, 1], list(KINDS)) & (rows[:, 2] == 2) & (rows[:, 0] > 0)).all())


def _is_by_grids(rows: Array) -> bool:
    return bool((np.isin(rows[:, 1], list(KINDS)) & (rows[:, 2] == 1) & (rows[:, 0] > 0)).all())


def _rows(
    words: Array, sizes: tuple[int, ...], name: str, first: int, fits: Callable[[Array], bool]
) -> tuple[Array, Array]:
    """Return whole numbers and reals from word `first` on of each row; the size of rows is the one that fits."""
    for size in sizes:
        if words.size % size:
            continue
        rows = words.reshape(-1, size)
        # In rows of 26 words, numbers have two words each.
        step = 2 if size == 26 else 1
        if fits(rows[:, ::step]):
            count, is_double = REALS[size]
            is_double |= words.dtype.itemsize == 8
            reals = np.ascontiguousarray(rows[:, step * first : step * first + count])
            kind = np.dtype(f"f{8 if is_double else 4}").newbyteorder(words.dtype.byteorder)
            return rows[:, ::step], reals.view(kind).astype(float)
    raise DeckError(0, f"{name} have another form: {words.size} words")
