"""Places of nodes by their numbers, from decks of Abaqus, CalculiX and Nastran."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, finite
from ..reading.finite import check_finite_in
from ..reading.nastran_fields import fields_of, real
from ..reading.text import Lines, text_of
from .formats import PathLike, format_of, whole_file

# Largest distance of a place from a node, relative to the size of the mesh.
TOLERANCE = 1e-3


@dataclass(frozen=True)
class Nodes:
    """Nodes of a deck.

    Attributes
    ----------
    numbers : ndarray of int, shape (nodes,)
        Numbers in the deck.
    places : ndarray, shape (nodes, 3)
        Coordinates [m].
    """

    numbers: Array
    places: Array

    def nearest(self, word: str, place: Sequence[float]) -> int:
        """Return the number of the node at a place, or raise ValueError if none is near."""
        there = np.array([finite(word, value) for value in place])
        distance = np.linalg.norm(self.places - there, axis=1)
        allowed = TOLERANCE * float(np.linalg.norm(np.ptp(self.places, axis=0)))
        found = int(np.argmin(distance))
        if distance[found] > allowed:
            where = ", ".join(f"{value:.6g}" for value in self.places[found])
            got = (
                f"{tuple(there.tolist())}, {distance[found]:.3g} m from the nearest, {self.numbers[found]} at ({where})"
            )
            raise ArgumentError(word, f"be within {allowed:.3g} m of a node", place, got=got)
        return int(self.numbers[found])


def read_nodes(path: PathLike) -> Nodes:
    """Return the nodes of a deck: ``*NODE`` in ``.inp``, ``GRID`` in any other file.

    Raises
    ------
    OSError
        If it cannot be read.
    ValueError
        If it is too large, holds no nodes, or has a line that is not a node.
    """
    format_of(path)
    reader = _of_abaqus if Path(path).suffix.lower() == ".inp" else _of_nastran
    with whole_file(path):
        with text_of(path) as file:
            held = list(reader(Lines(file)))
        if not held:
            raise ValueError("it holds no nodes")
        numbers = np.array([number for number, _ in held], dtype=np.int64)
        places = np.array([place for _, place in held])
        if np.unique(numbers).size < numbers.size:
            raise ValueError("nodes must have different numbers")
    check_finite_in(path, "nodes", places)
    return Nodes(numbers, places)


def _of_abaqus(lines: Lines) -> Iterator[tuple[int, list[float]]]:
    within = False
    for line in lines:
        text = line.strip()
        if text.startswith("**") or not text:
            continue
        if text.startswith("*"):
            word, *parameters = (part.strip().upper() for part in text.split(","))
            within = word == "*NODE"
            if within and any(part.startswith("SYSTEM") for part in parameters):
                raise lines.bad("*NODE in rectangular coordinates", text)
            if word in ("*SYSTEM", "*INCLUDE", "*NGEN", "*NFILL", "*NCOPY"):
                raise lines.bad("of nodes that are all written out here", text)
        elif within:
            number, *place = text.rstrip(",").split(",")
            if len(place) > 3:
                raise lines.bad("'node, x, y, z'", text)
            yield _node(lines, text, number, place)


def _of_nastran(lines: Lines) -> Iterator[tuple[int, list[float]]]:
    for line in lines:
        text = line.partition("$")[0].rstrip()
        first, fields = fields_of(text)
        if first.rstrip("*").upper() != "GRID":
            continue
        if first.endswith("*"):
            fields += fields_of(lines.need("the rest of the card"))[1]
        number, system, *place = fields[:5]
        if system not in ("", "0"):
            raise lines.bad("a GRID in the basic coordinate system", text)
        yield _node(lines, text, number, place)


def _node(lines: Lines, text: str, number: str, place: list[str]) -> tuple[int, list[float]]:
    try:
        return int(number), [real(word.strip() or "0") for word in (place + [""] * 3)[:3]]
    except ValueError:
        raise lines.bad("the number of a node and its coordinates", text) from None
