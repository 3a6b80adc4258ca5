"""Universal files of meshes: nodes, elements and groups of I-DEAS, Salome, gmsh and test systems."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array
from ..reading.deck_error import DeckError
from ..reading.universal import Dataset, datasets
from .deck import Block, Deck
from .mirrored import right_handed

# Solid elements by the number of their type: kind, and places in the file of all nodes in the order of VTK. Corners and
# middles of edges take turns around the faces.
SOLIDS = {
    111: ("tetra", range(4)),
    112: ("wedge", range(6)),
    115: ("hexahedron", range(8)),
    118: ("tetra10", (0, 2, 4, 9, 1, 3, 5, 6, 7, 8)),
    113: ("wedge15", (0, 2, 4, 9, 11, 13, 1, 3, 5, 10, 12, 14, 6, 7, 8)),
    116: ("hexahedron20", (0, 2, 4, 6, 12, 14, 16, 18, 1, 3, 5, 7, 13, 15, 17, 19, 8, 9, 10, 11)),
}
# Shells: kind, number of nodes and places of the corners.
_TRIANGLES = (("triangle", 3, (0, 1, 2)), ("triangle", 6, (0, 2, 4)))
_QUADRILATERALS = (("quad", 4, (0, 1, 2, 3)), ("quad", 8, (0, 2, 4, 6)))
SHELLS = {
    **{tens + 1: _TRIANGLES[0] for tens in (40, 50, 60, 80, 90)},
    **{tens + 2: _TRIANGLES[1] for tens in (40, 50, 60, 70, 80, 90)},
    **{tens + 4: _QUADRILATERALS[0] for tens in (40, 50, 60, 80, 90)},
    **{tens + 5: _QUADRILATERALS[1] for tens in (40, 50, 60, 70, 80, 90)},
    71: _QUADRILATERALS[0],
    74: _TRIANGLES[0],
}
# Rods and beams have a line of their own before their nodes.
BEAMS = (11, 21, 22, 23, 24, 25)
# Members of groups, and the numbers for each in a group.
NODES, ELEMENTS = 7, 8
WIDE_GROUPS, NARROW_GROUPS = (2435, 2452, 2467, 2477), (2417, 2429, 2430, 2432)
# Header.
WITHOUT_MESH = ("151",)
# Relative difference of a factor of units from 1 that is due to rounding.
ROUNDING = 1e-6


def read_universal(path: str | os.PathLike[str]) -> Deck:
    """Read the mesh of a universal file.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Deck
        Its element sets, surfaces and node sets are the groups by their names. Other datasets are counted.

    Raises
    ------
    DeckError
        If a line cannot be read.
    OSError
        If the file cannot be read.
    """
    model = _Model()
    for one in datasets(path):
        model.read(one)
    return model.deck()


@dataclass
class _Elements:
    """Elements of one type: their labels, nodes and lines."""

    labels: list[int] = field(default_factory=list)
    nodes: list[list[int]] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)


@dataclass
class _Model:
    """The content of the datasets read so far."""

    nodes: dict[int, tuple[float, ...]] = field(default_factory=dict)
    system_of: dict[int, int] = field(default_factory=dict)
    other_systems: dict[int, int] = field(default_factory=dict)
    elements: dict[int, _Elements] = field(default_factory=dict)
    labels: dict[int, int] = field(default_factory=dict)
    groups: list[tuple[str, list[int], list[int]]] = field(default_factory=list)
    left_out: Counter[str] = field(default_factory=Counter)

    def read(self, one: Dataset) -> None:
        """Read a dataset."""
        readers: dict[str, Callable[[Dataset], None]] = {
            "15": self._read_short_nodes,
            "18": self._read_other_systems,
            **dict.fromkeys(("781", "2411"), self._read_nodes),
            **dict.fromkeys(("780", "2412"), self._read_elements),
            "164": self._read_units,
            "2420": self._read_systems,
            **dict.fromkeys(map(str, (*WIDE_GROUPS, *NARROW_GROUPS)), self._read_groups),
        }
        name = one.name.split()[0] if one.name.split() else ""
        if name in readers:
            readers[name](one)
        elif name not in WITHOUT_MESH:
            self.left_out[f"dataset {name[:20]}"] += 1

    def _read_units(self, one: Dataset) -> None:
        """Mention another unit of length than the metre: values in it are divided by the factor given."""
        factor = one.numbers(1, 1)[0]
        if factor > 0.0 and abs(factor - 1.0) > ROUNDING:
            self.left_out[f"unit of length of {1.0 / factor:.6g} m, see scale"] += 1

    def deck(self) -> Deck:
        """Return the deck of all datasets."""
        for node, system in self.system_of.items():
            if system in self.other_systems:
                words = f"node {node} is given in the coordinate system {system}, which is not that of the file"
                raise DeckError(self.other_systems[system], f"{words}: export the nodes in the global system")
        index = dict(zip(self.nodes, range(len(self.nodes)), strict=True))
        points = np.array(list(self.nodes.values()), dtype=float).reshape(-1, 3)
        deck, numbers, count = Deck(points, left_out=self.left_out), dict[int, int](), 0
        for of, (kind, order) in SOLIDS.items():
            if of in self.elements:
                nodes = self._indices(of, index)[:, list(order)]
                deck.blocks.append(Block(kind, right_handed(kind, nodes, points)))
                labels = self.elements[of].labels
                numbers |= dict(zip(labels, range(count, count + len(labels)), strict=True))
                count += len(labels)
        faces, ends = dict[int, tuple[str, Array]](), dict[int, Array]()
        in_groups = {label for _, _, labels in self.groups for label in labels}
        for of, those in self.elements.items():
            if of in SHELLS:
                kind, _, corners = SHELLS[of]
                rows = self._indices(of, index)[:, list(corners)]
                faces |= dict(zip(those.labels, ((kind, row) for row in rows), strict=True))
            elif of in BEAMS:
                # Those in groups are edges of solids.
                if lone := sum(label not in in_groups for label in those.labels):
                    self.left_out[f"elements of type {of}"] += lone
                for at, label in enumerate(those.labels):
                    ends[label] = np.array([index[one] for one in those.nodes[at] if one in index], dtype=np.int64)
        for name, in_nodes, in_elements in self.groups:
            lost = [one for one in in_nodes if one not in index]
            lost += [one for one in in_elements if one not in self.labels]
            if lost:
                self.left_out[f"members of the group {name!r}, which are not there,"] += len(lost)
            points_of = [np.array([index[one] for one in in_nodes if one in index], dtype=np.int64)]
            points_of += [ends[one] for one in in_elements if one in ends]
            _add(deck.node_sets, name, np.unique(np.concatenate(points_of)))
            solid = [numbers[one] for one in in_elements if one in numbers]
            _add(deck.element_sets, name, np.array(solid, dtype=np.int64))
            for kind in ("triangle", "quad"):
                faces_of = [faces[one][1] for one in in_elements if one in faces and faces[one][0] == kind]
                if faces_of:
                    deck.surfaces.setdefault(name, []).append(Block(kind, np.array(faces_of, dtype=np.int64)))
        return deck

    def _indices(self, of: int, index: dict[int, int]) -> Array:
        """Return the indices of the nodes of all elements of a type."""
        those = self.elements[of]
        for label, nodes, line in zip(those.labels, those.nodes, those.lines, strict=True):
            if lost := [one for one in nodes if one not in index]:
                raise DeckError(line, f"element {label} has node {lost[0]}, which is not in the file")
        return np.array([[index[one] for one in nodes] for nodes in those.nodes], dtype=np.int64)

    def _put(self, one: Dataset, at: int, header: list[int], place: list[float]) -> None:
        """Add a node."""
        if self.nodes.setdefault(header[0], tuple(place)) != tuple(place):
            raise one.wrong(at, f"gives node {header[0]} twice, at different places")
        self.system_of[header[0]] = header[1]

    def _read_nodes(self, one: Dataset) -> None:
        for at in range(0, len(one.lines), 2):
            self._put(one, at, one.whole(at, 2), one.numbers(at + 1, 3))

    def _read_short_nodes(self, one: Dataset) -> None:
        for at in range(len(one.lines)):
            label, system, _, _, *place = one.numbers(at, 7)
            self._put(one, at, [int(label), int(system)], place)

    def _read_systems(self, one: Dataset) -> None:
        for at in range(2, len(one.lines), 6):
            label, form, *_ = one.whole(at, 2)
            given = np.array([one.numbers(at + 2 + row, 3) for row in range(4)])
            if form != 0 or not np.allclose(given, np.eye(4)[:, :3], atol=1e-12):
                self.other_systems[label] = one.first + at

    def _read_other_systems(self, one: Dataset) -> None:
        for at in range(0, len(one.lines), 4):
            self.other_systems[one.whole(at, 1)[0]] = one.first + at

    def _read_elements(self, one: Dataset) -> None:
        at = 0
        while at < len(one.lines):
            start, header = at, one.whole(at, 6)
            label, of, count = header[0], header[1], header[-1]
            at += 2 if of in BEAMS else 1
            nodes: list[int] = []
            while len(nodes) < count:
                nodes += one.whole(at, 1)
                at += 1
            is_known = of in SOLIDS or of in SHELLS
            wanted = len(SOLIDS[of][1]) if of in SOLIDS else SHELLS[of][1] if of in SHELLS else count
            if len(nodes) != wanted and is_known:
                raise one.wrong(start, f"has element {label} of type {of}, which has {wanted} nodes, got {len(nodes)}")
            line = self.labels.setdefault(label, one.first + start)
            if line != one.first + start:
                raise one.wrong(start, f"gives element {label} again, which is also in line {line}")
            if is_known or of in BEAMS:
                those = self.elements.setdefault(of, _Elements())
                those.labels.append(label)
                those.nodes.append(nodes)
                those.lines.append(one.first + start)
            else:
                self.left_out[f"elements of type {of}"] += 1

    def _read_groups(self, one: Dataset) -> None:
        width = 4 if int(one.name) in WIDE_GROUPS else 2
        at = 0
        while at < len(one.lines):
            header = one.whole(at, 2)
            name = one.lines[at + 1].strip() if at + 1 < len(one.lines) else ""
            at += 2
            members: list[int] = []
            while len(members) < width * header[-1]:
                members += one.whole(at, 1)
                at += 1
            kinds, tags = members[::width], members[1::width]
            found = {kind: [tag for of, tag in zip(kinds, tags, strict=True) if of == kind] for kind in set(kinds)}
            for kind in set(kinds) - {NODES, ELEMENTS}:
                self.left_out[f"members of type {kind} of groups"] += len(found[kind])
            self.groups.append((name or f"group {header[0]}", found.get(NODES, []), found.get(ELEMENTS, [])))


def _add(sets: dict[str, Array], name: str, those: Array) -> None:
    """Add numbers to a set, if there are any."""
    if those.size:
        sets[name] = np.unique(np.concatenate([sets.get(name, those[:0]), those]))
