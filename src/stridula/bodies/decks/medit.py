"""Meshes of Medit, as FreeFEM, mmg and TetGen write them: text of keywords, each with a number of rows."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array
from ...disk import opened
from ..reading.deck_error import DeckError
from .deck import CORNERS, Block, Deck
from .mirrored import right_handed

SOLIDS = {
    "Tetrahedra": "tetra",
    "TetrahedraP2": "tetra10",
    "Hexahedra": "hexahedron",
    "Hexaedra": "hexahedron",
    "Prisms": "wedge",
    "Pyramids": "pyramid",
}
SHELLS = {
    "Triangles": ("triangle", 3),
    "TrianglesP2": ("triangle", 6),
    "Quadrilaterals": ("quad", 4),
    "QuadrilateralsQ2": ("quad", 9),
}
EDGES = {"Edges": 2, "EdgesP2": 3}
KEYWORD = re.compile(r"(?!nan\b|inf)[a-z]\w*", re.IGNORECASE)


def read_medit(path: str | os.PathLike[str]) -> Deck:
    """Read a mesh of Medit.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Deck
        Its element sets, surfaces and node sets are elements, faces and edges of each reference number: "volume 1",
        "face 3", "edge 2". Other keywords are counted.

    Raises
    ------
    DeckError
        If a line cannot be read.
    OSError
        If the file cannot be read.
    """
    with opened(path) as file:
        lines = file.read().decode("latin-1").split("\n")
    sections = {"End": _Section("End", len(lines))}
    for one in _sections(lines):
        if one.name in sections and one.name != "End":
            raise DeckError(one.line, f"{one.name} is also in line {sections[one.name].line}")
        sections[one.name] = one
    dimension = sections.get("Dimension")
    if dimension is None or dimension.words[:1] != ["3"]:
        raise DeckError(dimension.line if dimension else 1, "the Dimension of a mesh must be 3")
    if "Vertices" not in sections:
        raise DeckError(1, "a mesh of Medit must have Vertices")
    deck = Deck(sections.pop("Vertices").rows(4)[:, :3])
    for name in ("End", "Dimension", "MeshVersionFormatted"):
        sections.pop(name, None)
    for one in sections.values():
        _read(one, deck)
    return deck


@dataclass
class _Section:
    """A keyword, its line, and the words up to the next keyword."""

    name: str
    line: int
    words: list[str] = field(default_factory=list)

    def rows(self, width: int) -> Array:
        """Return the numbers, shape (rows, width)."""
        try:
            count = int(self.words[0])
            numbers = np.array(self.words[1:], dtype=float)
        except (ValueError, IndexError):
            raise DeckError(self.line, f"{self.name} needs a number of rows, and rows of {width} numbers") from None
        if numbers.size != count * width or not np.isfinite(numbers).all():
            words = f"{self.name} needs {count} rows of {width} finite numbers, {count * width} in all"
            raise DeckError(self.line, f"{words}, got {numbers.size}")
        return numbers.reshape(count, width)

    def cells(self, width: int, points: int) -> tuple[Array, Array]:
        """Return indices of the nodes of each cell, and its reference number."""
        rows = self.rows(width + 1)
        whole = rows.astype(np.int64)
        nodes = whole[:, :width] - 1
        if (whole != rows).any() or (nodes.size and (nodes.min() < 0 or nodes.max() >= points)):
            raise DeckError(self.line, f"{self.name} must have nodes from 1 to {points}, got {nodes.max() + 1}")
        return nodes, whole[:, width]


def _sections(lines: list[str]) -> Iterator[_Section]:
    """Yield the keywords up to the end."""
    now = _Section("", 1)
    for number, line in enumerate(lines, 1):
        words = line.partition("#")[0].split()
        if words and KEYWORD.fullmatch(words[0]):
            if now.name:
                yield now
            now = _Section(words[0], number, words[1:])
            if now.name == "End":
                return
        else:
            if words and not now.name:
                raise DeckError(number, f"a mesh of Medit begins with MeshVersionFormatted, got {words[0][:40]!r}")
            now.words += words
    raise DeckError(len(lines), "the keyword End is missing: the file is cut off")


def _read(one: _Section, deck: Deck) -> None:
    """Add the cells of a keyword to a deck."""
    if one.name in SOLIDS:
        kind = SOLIDS[one.name]
        width = int(kind.removeprefix("tetra") or 4) if kind.startswith("tetra") else CORNERS[kind]
        nodes, numbers = one.cells(width, len(deck.points))
        first = deck.count
        if len(nodes):
            deck.blocks.append(Block(kind, right_handed(kind, nodes, deck.points)))
        for number in np.unique(numbers).tolist():
            _add(deck.element_sets, f"volume {number}", first + np.flatnonzero(numbers == number))
    elif one.name in SHELLS:
        kind, width = SHELLS[one.name]
        nodes, numbers = one.cells(width, len(deck.points))
        for number in np.unique(numbers).tolist():
            corners = nodes[numbers == number][:, : CORNERS[kind]]
            deck.surfaces.setdefault(f"face {number}", []).append(Block(kind, corners))
    elif one.name in EDGES:
        nodes, numbers = one.cells(EDGES[one.name], len(deck.points))
        for number in np.unique(numbers).tolist():
            _add(deck.node_sets, f"edge {number}", nodes[numbers == number].ravel())
    elif one.name.endswith("Ordering"):
        raise DeckError(one.line, f"{one.name} is not read: write the nodes in the order of Medit itself")
    else:
        count = one.words[0] if one.words and one.words[0].isdigit() else "1"
        deck.left_out[one.name[:40]] += min(int(count[:12]), 10**9)


def _add(sets: dict[str, Array], name: str, those: Array) -> None:
    """Add numbers to a set."""
    sets[name] = np.unique(np.concatenate([sets.get(name, those[:0]), those]))
