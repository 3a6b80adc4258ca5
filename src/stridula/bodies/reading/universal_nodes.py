"""Nodes, coordinate systems and units of universal files of test systems."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array
from .deck_error import DeckError
from .universal import Dataset

CARTESIAN, CYLINDRICAL = 0, 1
# Relative difference of factors of units, and of axes from those of the world, that is due to rounding.
ROUNDING = 1e-6
# Rows of a coordinate system: three axes and its origin.
IDENTITY = np.eye(4)[:, :3]


@dataclass(frozen=True)
class _Node:
    """A node: its coordinates, the numbers of the systems of its place and of its displacements, and its line."""

    given: tuple[float, ...]
    of_place: int
    of_displacement: int
    line: int
    dataset: str


@dataclass(frozen=True)
class _System:
    """A coordinate system: its kind, and its axes and origin in the world as rows, shape (4, 3)."""

    kind: int
    rows: Array
    line: int

    @property
    def is_world(self) -> bool:
        """Whether it is that of the world."""
        return self.kind == CARTESIAN and bool(np.allclose(self.rows, IDENTITY, atol=ROUNDING))

    def place(self, given: Array) -> Array:
        """Return the world place of coordinates: (x, y, z), or (r, angle in degrees, z)."""
        if self.kind == CYLINDRICAL:
            angle = np.radians(given[1])
            given = np.array([given[0] * np.cos(angle), given[0] * np.sin(angle), given[2]])
        return np.asarray(given @ self.rows[:3] + self.rows[3])

    def axes(self, place: Array) -> Array:
        """Return the directions of displacements at a world place as rows, shape (3, 3)."""
        if self.kind == CARTESIAN:
            return self.rows[:3]
        x, y, _ = self.rows[:3] @ (place - self.rows[3])
        radius = np.hypot(x, y)
        along, across = (x / radius, y / radius) if radius > 0.0 else (1.0, 0.0)
        return np.asarray(np.array([[along, across, 0.0], [-across, along, 0.0], [0.0, 0.0, 1.0]]) @ self.rows[:3])


@dataclass
class Geometry:
    """Nodes, coordinate systems and units of the datasets read so far.

    Attributes
    ----------
    units : tuple of float
        Length and force of the file per metre and per newton; None if it does not state them.
    """

    units: tuple[float, float] | None = None
    _nodes: dict[int, _Node] = field(default_factory=dict)
    _systems: dict[int, _System] = field(default_factory=dict)

    def read(self, one: Dataset) -> bool:
        """Read a dataset and return whether it is of one of these kinds."""
        readers = {
            "15": self._read_short_nodes,
            "781": self._read_nodes,
            "2411": self._read_nodes,
            "2420": self._read_systems,
            "164": self._read_units,
        }
        reader = readers.get(one.name)
        if reader is not None:
            reader(one)
        return reader is not None

    @property
    def numbers(self) -> tuple[int, ...]:
        """Numbers of the nodes."""
        return tuple(self._nodes)

    def place(self, number: int) -> Array:
        """Return the world place of a node in the unit of the file."""
        node = self._nodes[number]
        system = self._system(node, node.of_place)
        if node.dataset != "15" and not system.is_world:
            words = f"node {number} has the coordinate system {node.of_place}, and dataset {node.dataset} leaves open"
            raise DeckError(node.line, f"{words} whether its place is in it: export the nodes in the global system")
        return system.place(np.array(node.given))

    def has_own_axes(self, number: int) -> bool:
        """Return whether displacements of a node are in a system other than that of the world."""
        node = self._nodes.get(number)
        return node is not None and not self._system(node, node.of_displacement).is_world

    def axes(self, number: int) -> Array:
        """Return the directions of the displacements of a node as rows, shape (3, 3)."""
        node = self._nodes[number]
        return self._system(node, node.of_displacement).axes(self.place(number))

    def _system(self, node: _Node, number: int) -> _System:
        # 0 and 1 are the global system of programs that write no systems.
        if number in self._systems:
            return self._systems[number]
        if number in (0, 1) or not self._systems:
            return _System(CARTESIAN, IDENTITY, 0)
        raise DeckError(node.line, f"names the coordinate system {number}, which is not in the file")

    def _read_units(self, one: Dataset) -> None:
        length, force = one.numbers(1, 2)
        if not (length > 0.0 and force > 0.0):
            raise one.wrong(1, f"needs factors of units above 0, got {length:g} and {force:g}")
        if self.units is not None and not np.allclose((length, force), self.units, rtol=ROUNDING, atol=0.0):
            was = f"{self.units[0]:g} and {self.units[1]:g}"
            raise one.wrong(1, f"has the factors {length:g} and {force:g}, after {was}: units must not be mixed")
        self.units = length, force

    def _put(self, one: Dataset, at: int, header: list[int], given: list[float]) -> None:
        node = _Node(tuple(given), header[1], header[2], one.first + at, one.name)
        same = self._nodes.setdefault(header[0], node)
        if (same.given, same.of_place, same.of_displacement) != (node.given, node.of_place, node.of_displacement):
            raise one.wrong(at, f"gives node {header[0]} again, otherwise than in line {same.line}")

    def _read_nodes(self, one: Dataset) -> None:
        for at in range(0, len(one.lines), 2):
            self._put(one, at, one.whole(at, 3), one.numbers(at + 1, 3))

    def _read_short_nodes(self, one: Dataset) -> None:
        for at in range(len(one.lines)):
            *header, _, x, y, z = one.numbers(at, 7)
            if any(value != round(value) for value in header):
                raise one.wrong(at, f"needs whole numbers of node and systems, got {one.lines[at].strip()[:60]!r}")
            self._put(one, at, list(map(round, header)), [x, y, z])

    def _read_systems(self, one: Dataset) -> None:
        for at in range(2, len(one.lines), 6):
            label, kind, *_ = one.whole(at, 2)
            if kind not in (CARTESIAN, CYLINDRICAL):
                raise one.wrong(
                    at, f"has a coordinate system of type {kind}; 0, Cartesian, and 1, cylindrical, are read"
                )
            rows = np.array([one.numbers(at + 2 + row, 3) for row in range(4)])
            if not np.allclose(rows[:3] @ rows[:3].T, np.eye(3), atol=1e-4):
                raise one.wrong(at + 2, f"has axes of the coordinate system {label} that are not at right angles")
            self._systems[label] = _System(kind, rows, one.first + at)
