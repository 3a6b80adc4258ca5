"""Decks of Abaqus and CalculiX: parts placed by instances, sets, surfaces and materials of solid elements."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...arrays import Array
from .abaqus_lumps import FORMS, Lumps, add_lumps
from .abaqus_sets import Entry, Named, Sets, entries_of
from .deck import Block, Deck, Elastic
from .keywords import Card, Row, read_cards

# Kinds of solid elements by their number of nodes.
SOLID = re.compile(r"D?C3D(\d+)[A-Z]*")
KINDS = {
    4: "tetra",
    5: "pyramid",
    6: "wedge",
    8: "hexahedron",
    10: "tetra10",
    13: "pyramid13",
    15: "wedge15",
    20: "hexahedron20",
    27: "hexahedron27",
}
# Middle of the element, then of the faces S1 to S6, in the order of VTK: faces across x, y and z, the middle.
TWENTY_SEVEN = [*range(20), 26, 24, 23, 25, 21, 22, 20]
# Corners of the faces S1, S2 and so on by the number of corners of the element.
FACES = {
    4: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)),
    5: ((0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)),
    6: ((0, 1, 2), (3, 5, 4), (0, 3, 4, 1), (1, 4, 5, 2), (2, 5, 3, 0)),
    8: ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
}
# Largest relative difference of the radii at both ends of an arc, from decks of a few digits.
LARGEST_RADIUS_ERROR = 1e-3
# Keywords that make nodes or elements from others.
MADE = ("NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "EL GEN", "EL COPY")


@dataclass
class Scope:
    """Nodes, elements and sets of a part, of an assembly, or of a deck without parts.

    Attributes
    ----------
    name : str
        Its name.
    nodes : dict
        Coordinates by the number of the node.
    elements : dict
        Kind and numbers of nodes by the number of the element.
    sets : Sets
        Sets of nodes and of elements.
    surfaces : dict
        Type and rows of surfaces by name: an element or a set, and the name of a face.
    sections : list
        Names of a set of elements and of its material.
    lumps : Lumps
        Masses and springs.
    """

    name: str = ""
    nodes: dict[int, tuple[float, float, float]] = field(default_factory=dict)
    elements: dict[int, tuple[str, list[int]]] = field(default_factory=dict)
    sets: Sets = field(default_factory=Sets)
    surfaces: dict[str, list[tuple[Entry, str]]] = field(default_factory=dict)
    sections: list[tuple[str, str]] = field(default_factory=list)
    lumps: Lumps = field(default_factory=Lumps)


@dataclass(frozen=True)
class Placed:
    """A scope at its place: an instance of a part, the assembly, or the whole deck.

    Attributes
    ----------
    name : str
        Name of the instance, empty for the assembly and the deck.
    scope : Scope
        Its content.
    moved : callable
        Function that places points.
    """

    name: str
    scope: Scope
    moved: Callable[[Array], Array]


def read_abaqus(path: str | os.PathLike[str]) -> Deck:
    """Return the content of a deck.

    Raises
    ------
    DeckError
        If a line cannot be read, or if nodes or elements would be lost.
    OSError
        If a file cannot be read.
    """
    return _Reader().read(Path(path))


class _Reader:
    """Reader of the keywords of a deck, one after the other."""

    def __init__(self) -> None:
        self.deck_scope, self.assembly = Scope(), Scope()
        self.parts: dict[str, Scope] = {}
        self.instances: list[Placed] = []
        self.materials: dict[str, Elastic] = {}
        self.left_out: Counter[str] = Counter()
        self.scope, self.material = self.deck_scope, ""
        self.local: Callable[[Array], Array] = _as_given
        self.open: list[Scope] = []
        self.has_transform = False
        self.does: dict[str, Callable[[Card], None]] = {
            "PART": self.part,
            "END PART": self.end,
            "ASSEMBLY": self.begin_assembly,
            "END ASSEMBLY": self.end,
            "INSTANCE": self.instance,
            "END INSTANCE": self.end,
            "SYSTEM": self.system,
            "NODE": self.node,
            "NGEN": self.between,
            "ELEMENT": self.element,
            "NSET": self.node_set,
            "ELSET": self.element_set,
            "SURFACE": self.surface,
            "MATERIAL": self.begin_material,
            "ELASTIC": self.elastic,
            "DENSITY": self.density,
            "SOLID SECTION": self.section,
            "MASS": self.lump,
            "SPRING": self.lump,
            "TRANSFORM": self.transform,
        }

    def read(self, path: Path) -> Deck:
        """Return the content of a file."""
        for card in read_cards(path):
            if card.keyword in MADE:
                raise card.wrong(f"*{card.keyword} is not read: write its nodes and elements into the deck")
            if act := self.does.get(card.keyword):
                act(card)
        return _joined(self)

    def begin(self, scope: Scope) -> None:
        """Let the next keywords belong to a scope."""
        self.open.append(self.scope)
        self.scope, self.local = scope, _as_given

    def end(self, card: Card) -> None:
        """Return to the scope before."""
        if not self.open:
            raise card.wrong(f"*{card.keyword} ends nothing that began")
        self.scope, self.local = self.open.pop(), _as_given

    def part(self, card: Card) -> None:
        """Begin a part."""
        name = _named(card, "NAME")
        if name.upper() in self.parts:
            raise card.wrong(f"two parts have the name {name!r}")
        self.parts[name.upper()] = Scope(name)
        self.begin(self.parts[name.upper()])

    def begin_assembly(self, card: Card) -> None:
        """Begin the assembly."""
        self.begin(self.assembly)

    def instance(self, card: Card) -> None:
        """Begin an instance of a part, moved by its rows."""
        name, of = _named(card, "NAME"), _named(card, "PART")
        if of.upper() not in self.parts:
            known = ", ".join(part.name for part in self.parts.values()) or "none"
            raise card.wrong(f"instance {name!r} is of part {of!r}, which the deck has not; its parts: {known}")
        if any(one.name.upper() == name.upper() for one in self.instances):
            raise card.wrong(f"two instances have the name {name!r}")
        part = self.parts[of.upper()]
        own = Scope(
            name,
            dict(part.nodes),
            dict(part.elements),
            part.sets.copied(),
            dict(part.surfaces),
            [*part.sections],
            part.lumps.copied(),
        )
        self.instances.append(Placed(name, own, _motion(card)))
        self.begin(own)

    def system(self, card: Card) -> None:
        """Set the local system of the next nodes."""
        self.local = _local_system(card)

    def node(self, card: Card) -> None:
        """Read nodes."""
        form = _form(card)
        numbers, places = [], []
        for row in card.rows:
            numbers.append(card.whole(row, 0))
            places.append([card.number(row, at, 0.0) for at in (1, 2, 3)])
        given = np.array(places, dtype=float).reshape(-1, 3)
        if not np.isfinite(given).all():
            row = card.rows[int(np.flatnonzero(~np.isfinite(given).all(axis=1))[0])]
            raise card.wrong("coordinates must be finite", row)
        given = _rectangular(form, given)
        self.put_nodes(card, numbers, self.local(given))
        if name := card.parameters.get("NSET"):
            self.scope.sets.nodes.add(name, numbers)

    def put_nodes(self, card: Card, numbers: list[int], places: Array) -> None:
        """Add nodes to the scope; a node given twice must be at the same place."""
        for at, (number, place) in enumerate(zip(numbers, map(tuple, places.tolist()), strict=True)):
            if self.scope.nodes.setdefault(number, place) != place:
                row = card.rows[at] if at < len(card.rows) else None
                raise card.wrong(f"node {number} is given twice, at different places", row)

    def between(self, card: Card) -> None:
        """Make nodes on the straight line or the arc between two."""
        line, form = card.parameters.get("LINE", "").upper(), _form(card)
        if line not in ("", "C"):
            words = "is not read: write the nodes on the curve into the deck, or use an arc, LINE=C"
            raise card.wrong(f"*NGEN, LINE={line} {words}")
        for row in card.rows:
            first, last = card.whole(row, 0), card.whole(row, 1)
            by = card.whole(row, 2) if len(row.words) > 2 and row.words[2] else 1
            if by == 0 or (last - first) % by or not {first, last} <= self.scope.nodes.keys():
                raise card.wrong(f"*NGEN needs two nodes and an increment that leads from {first} to {last}", row)
            if (last - first) // by > 1_000_000:
                raise card.wrong("*NGEN makes more than a million nodes", row)
            ends = np.array([self.scope.nodes[first], self.scope.nodes[last]])
            numbers = list(range(first, last, by))[1:]
            share = np.arange(1, len(numbers) + 1)[:, None] / (len(numbers) + 1)
            places = ends[0] + share * (ends[1] - ends[0])
            if line == "C":
                places = _arc(card, row, ends, self.extra_point(card, row, form), share)
            self.put_nodes(card, numbers, places)
            if name := card.parameters.get("NSET"):
                self.scope.sets.nodes.add(name, [first, *numbers, last])

    def extra_point(self, card: Card, row: Row, form: str) -> Array:
        """Return the centre of an arc: a node, or coordinates."""
        if len(row.words) > 3 and row.words[3]:
            node = card.whole(row, 3)
            if node not in self.scope.nodes:
                raise card.wrong(f"*NGEN has the centre {node}, a node which was not given", row)
            return np.array(self.scope.nodes[node])
        if self.local is not _as_given:
            raise card.wrong("*NGEN below *SYSTEM needs the number of a node as the centre of its arc", row)
        return _rectangular(form, np.array([[card.number(row, at) for at in (4, 5, 6)]]))[0]

    def element(self, card: Card) -> None:
        """Read elements; all but solids are counted."""
        form = _named(card, "TYPE").upper()
        solid = SOLID.fullmatch(form)
        count = int(solid[1]) if solid else 0
        if form in FORMS:
            self.scope.lumps.add(card, form)
            return
        if count not in KINDS:
            self.left_out[form] += len(card.rows)
            return
        numbers = []
        for row, words in _wrapped(card, 1 + count):
            try:
                number, *nodes = map(int, words)
            except ValueError:
                raise card.wrong(f"*ELEMENT needs whole numbers, got {', '.join(words)[:60]!r}", row) from None
            if lost := [one for one in nodes if one not in self.scope.nodes]:
                raise card.wrong(f"element {number} has node {lost[0]}, which was not given", row)
            if self.scope.elements.setdefault(number, (KINDS[count], nodes)) != (KINDS[count], nodes):
                raise card.wrong(f"element {number} is given twice, with different nodes", row)
            numbers.append(number)
        if name := card.parameters.get("ELSET"):
            self.scope.sets.elements.add(name, numbers)

    def node_set(self, card: Card) -> None:
        """Read a set of nodes, or the nodes of a set of elements."""
        name = _named(card, "NSET")
        given = entries_of(card)
        if of := card.parameters.get("ELSET"):
            of_elements = Named(of, card.parameters.get("INSTANCE", ""), is_elements=True)
            given.append(Entry(named=of_elements, where=card))
        self.scope.sets.nodes.extend(name, given, "INTERNAL" in card.parameters)

    def element_set(self, card: Card) -> None:
        """Read a set of elements."""
        self.scope.sets.elements.extend(_named(card, "ELSET"), entries_of(card), "INTERNAL" in card.parameters)

    def surface(self, card: Card) -> None:
        """Read a surface of elements, or of nodes, which becomes a set."""
        name, form = _named(card, "NAME"), card.parameters.get("TYPE", "ELEMENT").upper()
        if form == "NODE":
            rows = [replaced(card, [Row(row.line, row.words[:1]) for row in card.rows])]
            self.scope.sets.nodes.extend(name, [entry for one in rows for entry in entries_of(one)], is_internal=False)
        elif form == "ELEMENT" and "COMBINE" not in card.parameters:
            listed = self.scope.surfaces.setdefault(name, [])
            for row in card.rows:
                (entry,) = entries_of(replaced(card, [Row(row.line, row.words[:1])]))
                listed.append((entry, row.words[1].upper() if len(row.words) > 1 else ""))
        else:
            self.left_out[f"*SURFACE, TYPE={form}"] += 1

    def begin_material(self, card: Card) -> None:
        """Begin a material."""
        self.material = _named(card, "NAME")
        self.materials.setdefault(self.material, Elastic())

    def elastic(self, card: Card) -> None:
        """Read isotropic elasticity; other kinds stay unknown."""
        if self.material and card.rows and card.parameters.get("TYPE", "ISO").upper().startswith("ISO"):
            row, now = card.rows[0], self.materials[self.material]
            found = Elastic(card.number(row, 0), card.number(row, 1, 0.0), now.density)
            self.materials[self.material] = found

    def density(self, card: Card) -> None:
        """Read a density."""
        if self.material and card.rows:
            now = self.materials[self.material]
            self.materials[self.material] = Elastic(now.young, now.poisson, card.number(card.rows[0], 0))

    def section(self, card: Card) -> None:
        """Note the material of a set of elements."""
        if "ELSET" in card.parameters and "MATERIAL" in card.parameters:
            self.scope.sections.append((card.parameters["ELSET"], card.parameters["MATERIAL"]))

    def lump(self, card: Card) -> None:
        """Note the value of masses or springs."""
        self.scope.lumps.values.append(card)

    def transform(self, card: Card) -> None:
        """Note that nodes have directions of their own."""
        self.has_transform = True


def replaced(card: Card, rows: list[Row]) -> Card:
    """Return a card with other rows and without parameters."""
    return Card(card.keyword, {}, card.line, card.file, rows)


def _named(card: Card, parameter: str) -> str:
    """Return a parameter that must be given."""
    name = card.parameters.get(parameter, "")
    if not name:
        raise card.wrong(f"*{card.keyword} needs {parameter}=")
    return name


def _wrapped(card: Card, count: int) -> Iterable[tuple[Row, list[str]]]:
    """Yield the entries of each element, which may go on in further rows, with its first row."""
    words: list[str] = []
    first = None
    for row in card.rows:
        first = first or row
        words += [word for word in row.words if word]
        if len(words) > count:
            form = card.parameters["TYPE"]
            raise card.wrong(f"{form} has {count - 1} nodes, got {len(words) - 1} or more: change the type", first)
        if len(words) == count:
            yield first, words
            words, first = [], None
    if first is not None:
        raise card.wrong(f"an element needs {count - 1} nodes, got {len(words) - 1}", first)


def _form(card: Card) -> str:
    """Return the form of coordinates: R, C or S."""
    form = card.parameters.get("SYSTEM", "R").upper()
    if form not in ("R", "RC", "C", "S"):
        words = "rectangular (R), cylindrical (C) or spherical (S) coordinates"
        raise card.wrong(f"*{card.keyword}, SYSTEM={form} is not read: give {words}")
    return form[0]


def _rectangular(form: str, given: Array) -> Array:
    """Return places from rectangular, cylindrical or spherical coordinates, with angles in degrees.

    The second angle of spherical coordinates is the latitude, from the plane of x and y towards z: radius, longitude
    and latitude form a right-handed system, as the axes of ``*TRANSFORM, TYPE=S`` do.
    """
    if form == "R":
        return given
    radius, longitude, height = given[:, 0], np.radians(given[:, 1]), given[:, 2]
    if form == "S":
        latitude = np.radians(height)
        radius, height = radius * np.cos(latitude), radius * np.sin(latitude)
    return np.stack([radius * np.cos(longitude), radius * np.sin(longitude), height], axis=1)


def _arc(card: Card, row: Row, ends: Array, centre: Array, share: Array) -> Array:
    """Return places on the arc between two places at shares of its angle.

    It turns about its normal by the right hand; without a normal it is the arc of less than 180 degrees.
    """
    start, end = ends - centre
    radii = np.linalg.norm([start, end], axis=1)
    if not radii.all() or abs(radii[1] / radii[0] - 1.0) > LARGEST_RADIUS_ERROR:
        got = f"{radii[0]:.6g} and {radii[1]:.6g}"
        raise card.wrong(f"*NGEN, LINE=C needs ends that are equally far from the centre, got {got}", row)
    given = np.array([card.number(row, at, 0.0) for at in (7, 8, 9)])
    across = np.cross(start, end)
    is_flat = float(np.linalg.norm(across)) <= 1e-9 * radii.prod()
    if is_flat and not given.any():
        raise card.wrong("*NGEN, LINE=C needs the normal of an arc of 180 degrees or more as entries 8 to 10", row)
    # The plane of an arc is that of its ends and centre, unless these are on a line.
    normal = across if not is_flat else given - (given @ start) / radii[0] ** 2 * start
    if given @ normal < 0.0:
        normal = -normal
    size = float(np.linalg.norm(normal))
    if not size:
        raise card.wrong("*NGEN, LINE=C needs a normal across the radius of the arc", row)
    normal = normal / size
    angle = float(np.arctan2(normal @ across, start @ end))
    if given.any() and angle <= 1e-9:
        angle += 2.0 * np.pi
    side = np.cross(normal, start)
    turned = np.cos(angle * share) * start + np.sin(angle * share) * side
    # Given in a few digits, the ends have slightly different radii.
    return np.asarray(centre + turned * (1.0 + share * (radii[1] / radii[0] - 1.0)))


def _as_given(places: Array) -> Array:
    return places


def _local_system(card: Card) -> Callable[[Array], Array]:
    """Return the function from a local system, given by its origin and points on the x axis and in the plane."""
    given = [card.number(row, at) for row in card.rows for at in range(len(row.words)) if row.words[at]]
    if not given:
        return _as_given
    if len(given) not in (3, 6, 9):
        raise card.wrong(f"*SYSTEM needs the coordinates of one, two or three points, got {len(given)} numbers")
    origin, *others = np.array(given).reshape(-1, 3)
    along = others[0] - origin if others else np.array([1.0, 0.0, 0.0])
    # Without a third point the axis z stays that of the deck.
    in_plane = others[1] - origin if len(others) > 1 else np.cross([0.0, 0.0, 1.0], along)
    out = np.cross(along, in_plane)
    if not np.linalg.norm(along) or not np.linalg.norm(out):
        raise card.wrong("*SYSTEM needs three points that are not on a line")
    along, out = along / np.linalg.norm(along), out / np.linalg.norm(out)
    axes = np.array([along, np.cross(out, along), out])
    return lambda places: np.asarray(origin + places @ axes)


def _motion(card: Card) -> Callable[[Array], Array]:
    """Return the motion of an instance: a shift, then a turn about the line through two points."""
    rows = card.rows[:2]
    shift = np.array([card.number(rows[0], at, 0.0) for at in range(3)]) if rows else np.zeros(3)
    if len(rows) < 2:
        return lambda places: np.asarray(places + shift)
    numbers = np.array([card.number(rows[1], at) for at in range(7)])
    start, axis, angle = numbers[:3], numbers[3:6] - numbers[:3], np.radians(numbers[6])
    length = float(np.linalg.norm(axis))
    if not length:
        raise card.wrong("the two points of the axis of an instance must differ", rows[1])
    x, y, z = axis / length
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn = np.eye(3) + np.sin(angle) * skew + (1.0 - np.cos(angle)) * skew @ skew
    return lambda places: np.asarray(start + (places + shift - start) @ turn.T)


def _joined(read: _Reader) -> Deck:
    """Return the placed scopes in one deck."""
    placed = [one for one in read.instances if one.scope.nodes]
    placed += [Placed("", one, _as_given) for one in (read.assembly, read.deck_scope) if one.nodes]
    if not placed and read.parts:
        # Parts without an assembly are where their nodes are.
        placed = [Placed(one.name, one, _as_given) for one in read.parts.values()]
    deck = Deck(np.zeros((0, 3)), materials=read.materials, left_out=read.left_out)
    points, where = [np.zeros((0, 3))], []
    first_point = first_element = 0
    for one in placed:
        numbers = np.fromiter(one.scope.nodes, dtype=np.int64, count=len(one.scope.nodes))
        places = np.array(list(one.scope.nodes.values()), dtype=float).reshape(-1, 3)
        points.append(one.moved(places))
        point_of = dict(zip(numbers.tolist(), range(first_point, first_point + len(numbers)), strict=True))
        element_of = _blocks(one.scope, point_of, first_element, deck)
        where.append((one, point_of, element_of))
        if one.name:
            deck.parts[one.name] = np.arange(first_element, first_element + len(element_of))
        first_point, first_element = first_point + len(numbers), first_element + len(element_of)
    deck.points = np.concatenate(points)
    _name_groups(read, deck, where)
    scopes = [(one.scope, point_of, one.moved) for one, point_of, _ in where]
    if not any(scope is read.assembly for scope, _, _ in scopes):
        scopes.append((read.assembly, {}, _as_given))
    of_scopes = [(scope.lumps, scope.sets, point_of, moved) for scope, point_of, moved in scopes]
    add_lumps(deck, of_scopes, {one.name.upper(): points for one, points, _ in where if one.name}, read.has_transform)
    return deck


def _blocks(scope: Scope, point_of: dict[int, int], first: int, deck: Deck) -> dict[int, int]:
    """Add the elements of a scope to a deck, by kind; return their numbers in the deck by those of the scope."""
    by_kind: dict[str, list[int]] = {}
    for number, (kind, _) in scope.elements.items():
        by_kind.setdefault(kind, []).append(number)
    found: dict[int, int] = {}
    for kind, numbers in by_kind.items():
        nodes = np.array([[point_of[node] for node in scope.elements[number][1]] for number in numbers], dtype=np.int64)
        deck.blocks.append(Block(kind, nodes[:, TWENTY_SEVEN] if kind == "hexahedron27" else nodes))
        found.update(zip(numbers, range(first + len(found), first + len(found) + len(numbers)), strict=True))
    return found


Where = list[tuple[Placed, dict[int, int], dict[int, int]]]


def _name_groups(read: _Reader, deck: Deck, where: Where) -> None:
    """Add sets, surfaces and materials to a deck; names that several instances have are preceded by the instance."""
    several = {
        kind: Counter(name.upper() for one, _, _ in where for name in names(one.scope))
        for kind, names in (
            ("node_sets", lambda scope: scope.sets.nodes.names),
            ("element_sets", lambda scope: scope.sets.elements.names),
            ("surfaces", lambda scope: scope.surfaces),
        )
    }
    every = [*where]
    if not any(one.scope is read.assembly for one, _, _ in where):
        every.append((Placed("", read.assembly, _as_given), {}, {}))
    instances = {one.name.upper(): (one.scope.sets, points, elements) for one, points, elements in where if one.name}
    for one, point_of, element_of in every:
        finder = one.scope.sets.finder(one.scope.elements, point_of, element_of, instances, read)

        def called(name: str, kind: str, placed: Placed = one) -> str:
            return f"{placed.name}.{name}" if placed.name and several[kind][name.upper()] > 1 else name

        for name in one.scope.sets.nodes.shown:
            deck.node_sets[called(name, "node_sets")] = finder.nodes(name)
        for name in one.scope.sets.elements.shown:
            deck.element_sets[called(name, "element_sets")] = finder.elements(name)
        for name, rows in one.scope.surfaces.items():
            blocks = _faces(deck, [(finder.entry_elements(entry), face) for entry, face in rows])
            deck.surfaces[called(name, "surfaces")] = blocks
        for of, material in one.scope.sections:
            key = next((name for name in read.materials if name.upper() == material.upper()), material)
            spelled = one.scope.sets.elements.spelling(of)
            deck.material_of[called(spelled, "element_sets")] = key


def _faces(deck: Deck, rows: list[tuple[Array, str]]) -> list[Block]:
    """Return the faces of elements as triangles and quadrilaterals; those of shells are left out and counted."""
    found: dict[int, list[list[int]]] = {3: [], 4: []}
    starts = np.cumsum([0, *(len(block.nodes) for block in deck.blocks)])
    for elements, face in rows:
        if not re.fullmatch(r"S[1-6]", face):
            deck.left_out[f"faces {face or 'without a number'} of a *SURFACE"] += max(len(elements), 1)
            continue
        for number in elements.tolist():
            at = int(np.searchsorted(starts, number, side="right")) - 1
            block = deck.blocks[at]
            sides = FACES[block.corners.shape[1]]
            if int(face[1]) > len(sides):
                deck.left_out[f"faces {face} of a *SURFACE"] += 1
                continue
            nodes = block.nodes[number - starts[at]][list(sides[int(face[1]) - 1])]
            found[len(nodes)].append(nodes.tolist())
    return [
        Block({3: "triangle", 4: "quad"}[count], np.array(those, dtype=np.int64))
        for count, those in found.items()
        if those
    ]
