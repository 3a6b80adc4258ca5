"""Decks of Nastran: bulk data with solid elements, in any coordinate system."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array
from .deck import Block, Deck, Elastic, Lump
from .mirrored import right_handed
from .nastran_cards import Card, Where, cards, refused
from .nastran_systems import BASIC, BY_GRIDS, BY_POINTS, Definition, definitions, systems_of


@dataclass(frozen=True)
class _Solid:
    """Solid elements of a card.

    Attributes
    ----------
    kinds : tuple of str
        Kinds without and with nodes in the middle of edges.
    corners : int
        Number of corners.
    order : tuple of int
        Places in the card of all nodes in the order of VTK.
    """

    kinds: tuple[str, str]
    corners: int
    order: tuple[int, ...]


_TETRA = _Solid(("tetra", "tetra10"), 4, tuple(range(10)))
_PYRAMID = _Solid(("pyramid", "pyramid13"), 5, tuple(range(13)))
# Cards of hexahedra and wedges name the middles of upright edges before those of the upper face.
_HEXAHEDRON = _Solid(("hexahedron", "hexahedron20"), 8, (*range(12), *range(16, 20), *range(12, 16)))
_WEDGE = _Solid(("wedge", "wedge15"), 6, (*range(9), *range(12, 15), *range(9, 12)))
SOLIDS = {"CTETRA": _TETRA, "CHEXA": _HEXAHEDRON, "CPENTA": _WEDGE, "CPYRAM": _PYRAMID, "CPYRA": _PYRAMID}
SHELLS = {
    **dict.fromkeys(("CTRIA3", "CTRIA6", "CTRIAR"), ("triangle", 3)),
    **dict.fromkeys(("CQUAD4", "CQUAD8", "CQUADR"), ("quad", 4)),
}
# Elements, constraints, materials, matrices and sets that are not read, but counted.
LEFT_OUT = re.compile(
    r"C(?!ORD|END$|AERO|LOAD$|REEP$|SET)\w+|RB\w+|RROD|RJOINT|RTRPLT1?|RSPLINE|RSSCON|MPC|GENEL|DMIG|MAT(?!1$)\w+|SET\d?|CORD(?![12][RCS]$)\w+"
)


def read_nastran(path: str | os.PathLike[str]) -> Deck:
    """Read a deck of Nastran.

    Parameters
    ----------
    path : str or Path
        The deck; files that it includes must be below its folder.

    Returns
    -------
    Deck
        Its parts and element sets are the properties of solid elements, its surfaces those of triangles and
        quadrilaterals, all named by their number; node sets such as "SPC 5" are constrained grids. Densities are
        multiplied by the parameter WTMASS. Elements with corners in the other sense, which Nastran allows, are
        mirrored.

    Raises
    ------
    DeckError
        If a line cannot be read.
    OSError
        If the file cannot be read.
    """
    model = _Model()
    readers = model.readers()
    for card in cards(path, readers.keys()):
        read = readers.get(card.name)
        if read is not None:
            read(card)
        elif LEFT_OUT.fullmatch(card.name):
            model.left_out[card.name] += 1
    with np.errstate(all="ignore"):
        return model.deck()


@dataclass
class _Grids:
    """Grids in the order of the deck, in their own coordinate systems; turned ones have directions of their own."""

    number: dict[int, int] = field(default_factory=dict)
    systems: list[int | None] = field(default_factory=list)
    coordinates: list[tuple[float, float, float]] = field(default_factory=list)
    where: list[Where] = field(default_factory=list)
    default: int = BASIC
    is_turned: dict[int, bool] = field(default_factory=dict)
    is_default_turned: bool = False

    def add(self, card: Card) -> None:
        """Add the grid of a card."""
        grid = card.whole(0, "ID")
        system = card.whole(1, "CP") if card.text(1) else None
        place = card.number(2, "X1", 0.0), card.number(3, "X2", 0.0), card.number(4, "X3", 0.0)
        if card.text(5):
            self.is_turned[grid] = card.text(5) != "0"
        at = self.number.setdefault(grid, len(self.number))
        if at == len(self.systems):
            self.systems.append(system)
            self.coordinates.append(place)
            self.where.append(card.where)
        elif (self.systems[at], self.coordinates[at]) != (system, place):
            raise refused(card.where, f"GRID {grid} is also in line {self.where[at][0]}, at another place")

    def indices(self, grids: list[int], user: str, where: Where) -> list[int]:
        """Return the indices of grids, or raise DeckError in the name of their user."""
        number = self.number
        try:
            return [number[grid] for grid in grids]
        except KeyError as error:
            raise refused(where, f"{user} refers to the grid {error.args[0]}, which is missing") from None

    def system_of(self, grid: int, user: str, where: Where) -> int:
        """Return the system of a grid."""
        system = self.systems[self.indices([grid], user, where)[0]]
        return self.default if system is None else system

    def coordinates_of(self, grid: int) -> Array:
        """Return the coordinates of a grid in its system."""
        return np.array(self.coordinates[self.number[grid]])

    def places(self, defined: dict[int, Definition]) -> Array:
        """Return the places of all grids in the basic system, shape (grids, 3)."""
        systems = systems_of(defined, self)
        used = np.array([self.default if one is None else one for one in self.systems], dtype=np.int64)
        places = np.array(self.coordinates, dtype=float).reshape(-1, 3)
        for system in np.unique(used).tolist():
            these = np.flatnonzero(used == system)
            if system not in systems:
                grid = next(name for name, at in self.number.items() if at == these[0])
                words = f"GRID {grid} refers to the coordinate system {system}, which is missing"
                raise refused(self.where[these[0]], words)
            if system != BASIC:
                places[these] = systems[system].places(places[these])
        return places


@dataclass
class _Elements:
    """Elements of one kind: numbers of their grids in the order of VTK, of their properties and lines."""

    grids: list[list[int]] = field(default_factory=list)
    properties: list[int] = field(default_factory=list)
    users: list[str] = field(default_factory=list)
    where: list[Where] = field(default_factory=list)

    def add(self, card: Card, grids: list[int]) -> None:
        """Add the element of a card."""
        element = card.whole(0, "EID")
        self.grids.append(grids)
        self.properties.append(card.whole(1, "PID", element))
        self.users.append(f"{card.name} {element}")
        self.where.append(card.where)

    def nodes(self, grids: _Grids) -> Array:
        """Return the indices of the nodes, shape (elements, nodes of one)."""
        rows = zip(self.grids, self.users, self.where, strict=True)
        return np.array([grids.indices(*row) for row in rows], dtype=np.int64)


@dataclass
class _Model:
    """The content of the cards read so far."""

    grids: _Grids = field(default_factory=_Grids)
    systems: dict[int, Definition] = field(default_factory=dict)
    solids: dict[str, _Elements] = field(default_factory=dict)
    shells: dict[str, _Elements] = field(default_factory=dict)
    lines: dict[int, int] = field(default_factory=dict)
    materials: dict[str, Elastic] = field(default_factory=dict)
    material_of: dict[str, str] = field(default_factory=dict)
    constraints: list[Card] = field(default_factory=list)
    masses: list[Card] = field(default_factory=list)
    springs: list[Card] = field(default_factory=list)
    stiffness: dict[int, float] = field(default_factory=dict)
    mass_factor: float = 1.0
    left_out: Counter[str] = field(default_factory=Counter)

    def readers(self) -> dict[str, Callable[[Card], None]]:
        """Return the function that reads a card, by its name."""
        return {
            "GRID": self.grids.add,
            "GRDSET": self._read_default,
            "PARAM": self._read_parameter,
            "MAT1": self._read_material,
            "PSOLID": self._read_property,
            "CONM2": self.masses.append,
            "CELAS1": self.springs.append,
            "CELAS2": self.springs.append,
            "PELAS": self._read_spring_property,
            "SPC": self.constraints.append,
            "SPC1": self.constraints.append,
            **dict.fromkeys((*BY_POINTS, *BY_GRIDS), self._read_systems),
            **dict.fromkeys(SOLIDS, self._read_solid),
            **dict.fromkeys(SHELLS, self._read_shell),
        }

    def deck(self) -> Deck:
        """Return the deck of all cards."""
        points = self.grids.places(self.systems)
        blocks = [
            Block(kind, right_handed(kind, elements.nodes(self.grids), points))
            for kind, elements in self.solids.items()
        ]
        parts = _by_property([n for elements in self.solids.values() for n in elements.properties])
        materials = {
            name: Elastic(one.young, one.poisson, one.density * self.mass_factor)
            for name, one in self.materials.items()
        }
        return Deck(
            points=points,
            blocks=blocks,
            element_sets=dict(parts),
            node_sets=self._node_sets(),
            surfaces=self._surfaces(),
            parts=parts,
            materials=materials,
            material_of={name: self.material_of[name] for name in parts if name in self.material_of},
            lumps=[*self._mass_lumps(), *self._spring_lumps()],
            left_out=self.left_out,
        )

    def _read_default(self, card: Card) -> None:
        self.grids.default = card.whole(1, "CP", BASIC)
        self.grids.is_default_turned = card.text(5) not in ("", "0")

    def _read_parameter(self, card: Card) -> None:
        if card.text(0).upper() == "WTMASS":
            self.mass_factor = card.number(1, "the value", 1.0)

    def _read_systems(self, card: Card) -> None:
        for number, one in definitions(card):
            if number in self.systems:
                line = self.systems[number].where[0]
                raise refused(card.where, f"the coordinate system {number} is also in line {line}")
            self.systems[number] = one

    def _read_solid(self, card: Card) -> None:
        kind = SOLIDS[card.name]
        element = card.whole(0, "EID")
        line = self.lines.setdefault(element, card.where[0])
        grids = _grids_of(card, kind)
        if line != card.where[0]:
            raise refused(card.where, f"the element {element} is also in line {line}")
        has_middles = len(grids) > kind.corners
        name = kind.kinds[has_middles]
        ordered = [grids[at] for at in kind.order] if has_middles else grids
        self.solids.setdefault(name, _Elements()).add(card, ordered)

    def _read_shell(self, card: Card) -> None:
        kind, corners = SHELLS[card.name]
        grids = [card.whole(2 + at, f"G{at + 1}") for at in range(corners)]
        self.shells.setdefault(kind, _Elements()).add(card, grids)

    def _read_material(self, card: Card) -> None:
        number = card.whole(0, "MID")
        young, shear, poisson, density = (
            card.number(at, title, np.nan) for at, title in enumerate(("E", "G", "NU", "RHO"), 1)
        )
        if np.isnan(poisson) and shear > 0.0:
            poisson = young / (2.0 * shear) - 1.0
        if np.isnan(young):
            young = 2.0 * shear * (1.0 + poisson)
        found = Elastic(young, poisson, density)
        if repr(self.materials.setdefault(str(number), found)) != repr(found):
            raise refused(card.where, f"MAT1 {number} is given twice, with other values")

    def _read_property(self, card: Card) -> None:
        name, material = str(card.whole(0, "PID")), str(card.whole(1, "MID"))
        if self.material_of.setdefault(name, material) != material:
            raise refused(card.where, f"PSOLID {name} is given twice, with other materials")

    def _read_spring_property(self, card: Card) -> None:
        for at in (0, 4):
            if card.text(at):
                self.stiffness[card.whole(at, "PID")] = card.number(at + 1, "K", np.nan)
                if card.number(at + 2, "GE", 0.0):
                    self.left_out["structural damping of a PELAS"] += 1

    def _mass_lumps(self) -> Iterator[Lump]:
        """Yield the masses at grids; those beside their grid are counted."""
        for card in self.masses:
            grid, value = card.whole(1, "G"), self.mass_factor * card.number(3, "M", 0.0)
            has_offset = card.text(2) == "-1" or any(card.number(at, f"X{at - 3}", 0.0) for at in (4, 5, 6))
            if has_offset or grid not in self.grids.number or not value > 0.0:
                self.left_out[card.name] += 1
                continue
            if any(card.number(at, "an inertia", 0.0) for at in range(8, 14)):
                self.left_out["rotary inertia of a CONM2"] += 1
            yield Lump(card.name, (self.grids.number[grid],), (f"node {grid}",), value)

    def _spring_lumps(self) -> Iterator[Lump]:
        """Yield the springs between grids along x, y or z; others are counted."""
        for card in self.springs:
            of, grids = card.number(1, "K", np.nan), [card.whole(at, "G", 0) for at in (2, 4)]
            ways = [card.whole(at, "C", 0) for at, grid in zip((3, 5), grids, strict=True) if grid]
            given = [grid for grid in grids if grid]
            stiffness = of if card.name == "CELAS2" else self.stiffness.get(card.whole(1, "PID", card.whole(0, "EID")))
            is_known = all(
                grid in self.grids.number and not self.grids.is_turned.get(grid, self.grids.is_default_turned)
                for grid in given
            )
            if not (
                given and is_known and stiffness and stiffness > 0.0 and len(set(ways)) == 1 and ways[0] in (1, 2, 3)
            ):
                self.left_out[card.name] += 1
                continue
            if card.name == "CELAS2" and card.number(6, "GE", 0.0):
                self.left_out["structural damping of a CELAS2"] += 1
            points = tuple(self.grids.number[grid] for grid in given)
            direction = tuple(np.eye(3)[ways[0] - 1].tolist())
            yield Lump(card.name, points, tuple(f"node {grid}" for grid in given), stiffness, direction)

    def _surfaces(self) -> dict[str, list[Block]]:
        found: dict[str, list[Block]] = {}
        for kind, elements in self.shells.items():
            nodes = elements.nodes(self.grids)
            for name, these in _by_property(elements.properties).items():
                found.setdefault(name, []).append(Block(kind, nodes[these]))
        return found

    def _node_sets(self) -> dict[str, Array]:
        ids = np.array(list(self.grids.number), dtype=np.int64)
        found: dict[str, list[int]] = {}
        for card in self.constraints:
            these = found.setdefault(f"SPC {card.whole(0, 'SID')}", [])
            for first, last in _constrained(card):
                if first < last:
                    these.extend(np.flatnonzero((ids >= first) & (ids <= last)).tolist())
                elif first in self.grids.number:
                    these.append(self.grids.number[first])
                else:
                    # Perhaps a scalar point, which exists without a card of its own.
                    self.left_out[card.name] += 1
        return {name: np.unique(these) for name, these in found.items() if these}


def _grids_of(card: Card, kind: _Solid) -> list[int]:
    """Return the grids of a solid element: the corners alone, or all."""
    count = len(kind.order)
    given = [card.whole(2 + at, f"G{at + 1}", 0) for at in range(min(count, len(card.fields) - 2))]
    corners, middles = given[: kind.corners], given[kind.corners :]
    if not all(corners) or len(corners) < kind.corners:
        there = sum(map(bool, corners))
        raise refused(card.where, f"{card.name} {card.text(0)} must have {kind.corners} corners, got {there}")
    if any(card.fields[2 + count :]):
        raise refused(card.where, f"{card.name} {card.text(0)} must have at most {count} grids, got more")
    there = sum(map(bool, middles))
    if there not in (0, count - kind.corners):
        words = f"must have all {count - kind.corners} nodes in the middle of edges, or none, got {there}"
        remedy = "convert the mesh to elements of one order in the program that wrote the deck"
        raise refused(card.where, f"{card.name} {card.text(0)} {words}: {remedy}")
    return given if there else corners


def _by_property(properties: list[int]) -> dict[str, Array]:
    """Return numbers of elements by their property, in the order of these."""
    every = np.array(properties, dtype=np.int64)
    order = np.argsort(every, kind="stable")
    numbers, starts = np.unique(every[order], return_index=True)
    parts = np.split(order, starts[1:])
    return {str(number): part for number, part in zip(numbers.tolist(), parts, strict=False)}


def _constrained(card: Card) -> Iterator[tuple[int, int]]:
    """Yield the first and last number of each range of grids that a card constrains."""
    if card.name == "SPC1":
        yield from _ranges(card, 2)
        return
    for at in range(1, len(card.fields), 3):
        if card.text(at):
            grid = card.whole(at, "G")
            yield grid, grid


def _ranges(card: Card, at: int) -> Iterator[tuple[int, int]]:
    """Yield the first and last number of each range in the fields of a card from `at` on, such as 1, THRU, 10."""
    while at < len(card.fields):
        if card.text(at):
            first = last = card.whole(at, "a number")
            if card.text(at + 1).upper() == "THRU":
                last, at = card.whole(at + 2, "the number after THRU"), at + 2
            yield first, last
        at += 1
