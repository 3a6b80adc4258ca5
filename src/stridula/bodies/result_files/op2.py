"""Modes in binary results of Nastran, ``.op2``: tables of eigenvectors, eigenvalues and geometry."""

from __future__ import annotations

import os
from dataclasses import dataclass, field

import numpy as np

from ...arrays import Array
from ..reading.deck_error import DeckError
from .computed_modes import ComputedModes, frequencies_of
from .nastran_nodes import NastranNodes, add_records
from .output2 import Table, tables

# Words of the header of results.
HEADER = 146
# Approaches: real eigenvalues; others in words.
REAL = 2
APPROACHES = {1: "static", 5: "frequency response", 6: "transient", 8: "buckling", 9: "complex eigenvalues"}
# Displacements and eigenvectors by the code of their table.
VECTORS = (1, 7)
# Words of a point with three displacements and three rotations, and those of complex ones.
WIDE, COMPLEX = 8, 14
# Types of points: grids; scalar and other points have no place.
GRID = 1
# Tables whose directions are those of the basic system, and one of which both are known.
BASIC, EITHER = ("BOUG", "BOPHIG"), "OUGV1PAT"
GLOBAL, LOCAL = "global", "local"
# Relative difference of eigenvalues in two tables that is due to rounding.
ROUNDING = 1e-4


@dataclass
class _Vector:
    """A mode as it is read: its subcase, number and eigenvalue, points and displacements."""

    table: str
    subcase: int
    number: int
    eigenvalue: float
    points: Array
    moved: Array
    other_points: int

    @property
    def where(self) -> str:
        """Its place in the file."""
        return f"mode {self.number} of table {self.table}"


@dataclass
class _Model:
    """The tables read so far."""

    nodes: NastranNodes = field(default_factory=NastranNodes)
    vectors: list[_Vector] = field(default_factory=list)
    masses: dict[int, list[tuple[float, float]]] = field(default_factory=dict)
    others: set[str] = field(default_factory=set)


def read_op2(
    path: str | os.PathLike[str], nodes: NastranNodes | None = None, directions: str | None = None
) -> ComputedModes:
    """Read the real modes of a file of Nastran.

    Parameters
    ----------
    path : str or Path
        The file, of 4 or 8 bytes a word.
    nodes : NastranNodes, optional
        Nodes of the deck, in place of the table GEOM1.
    directions : {"global", "local"}, optional
        Directions of displacements at nodes with a displacement coordinate system, where the file leaves them open.

    Raises
    ------
    DeckError
        If the file is damaged, or has no real modes, no nodes, or modes of several subcases.
    OSError
        If it cannot be read.
    """
    model = _Model()
    for table in tables(path):
        if table.name.startswith("GEOM1"):
            for record in table.records:
                _read_geometry(model, table, record)
        elif table.name.startswith("LAMA"):
            _read_masses(model, table)
        elif table.records:
            _read_vectors(model, table)
    model.nodes = nodes or model.nodes
    return _modes(model, directions)


def _read_geometry(model: _Model, table: Table, record: bytes) -> None:
    words = table.whole(record)
    if words.size >= 3:
        add_records(model.nodes, table.name, int(words[0]), words[3:])


def _read_masses(model: _Model, table: Table) -> None:
    """Read eigenvalues and modal masses: records of seven words for each mode, each after a header."""
    for data in table.records[1::2]:
        if len(data) % (7 * table.words.itemsize):
            raise table.wrong(f"must have seven words for each mode, got {len(data)} bytes")
        numbers = table.whole(data).reshape(-1, 7)[:, 0].tolist()
        for number, row in zip(numbers, table.reals(data).reshape(-1, 7).tolist(), strict=True):
            model.masses.setdefault(number, []).append((row[2], row[5]))


def _read_vectors(model: _Model, table: Table) -> None:
    """Read displacements: a header and a record for each mode."""
    for header, data in zip(table.records[::2], table.records[1::2], strict=False):
        words, reals = table.whole(header), table.reals(header)
        if words.size < HEADER:
            raise table.wrong(f"must have headers of {HEADER} words, got {words.size}")
        approach, code = int(words[0]) // 10, int(words[1])
        if approach != REAL or code % 1000 not in VECTORS:
            if code % 1000 in VECTORS:
                model.others.add(APPROACHES.get(approach, f"approach {approach}"))
            continue
        if code // 1000 not in (0, 2) or int(words[9]) != WIDE:
            got = "complex ones" if int(words[9]) == COMPLEX else f"{words[9]} words, sorted by {code // 1000}"
            raise table.wrong(f"must have modes of six real numbers a point, sorted by mode (SORT1), got {got}")
        if len(data) % (WIDE * table.words.itemsize):
            raise table.wrong(f"must have {WIDE} words for each point, got {len(data)} bytes")
        rows, values = table.whole(data).reshape(-1, WIDE), table.reals(data).reshape(-1, WIDE)
        is_grid = rows[:, 1] == GRID
        points, moved = rows[is_grid, 0] // 10, values[is_grid, 2:5].astype(float)
        key = int(words[3]), int(words[4])
        if not np.isfinite(moved).all():
            raise table.wrong(f"mode {key[1]} has displacements that are not finite")
        model.vectors.append(
            _Vector(table.name, *key, float(reals[5]), points.astype(np.int64), moved, int((~is_grid).sum()))
        )


def _modes(model: _Model, directions: str | None) -> ComputedModes:
    """Return the modes of the tables that have been read."""
    if not model.vectors:
        got = f"results of other kinds ({', '.join(sorted(model.others))})" if model.others else "none"
        raise DeckError(0, f"must have real modes, as of SOL 103 with DISPLACEMENT(PLOT) = ALL, got {got}")
    vectors = _of_one_table(model.vectors)
    if not model.nodes.grids:
        words = "has no nodes, table GEOM1, as PARAM,POST,-1 writes it"
        raise DeckError(0, f'{words}: pass the deck of the model, geometry="model.bdf"')
    numbers, places, axes = model.nodes.placed()
    _check_directions(vectors[0].table, axes, directions)
    shapes = np.zeros((numbers.size, 3, len(vectors)))
    for at, one in enumerate(vectors):
        rows = np.searchsorted(numbers, one.points)
        lost = (rows >= numbers.size) | (numbers[np.minimum(rows, numbers.size - 1)] != one.points)
        if lost.any():
            raise DeckError(0, f"{one.where}: moves node {one.points[lost][0]}, which is not among the nodes")
        if np.unique(rows).size != rows.size:
            raise DeckError(0, f"{one.where}: has a node twice")
        shapes[rows, :, at] = one.moved
    if directions == LOCAL or (directions is None and not vectors[0].table.startswith(BASIC)):
        shapes = np.einsum("nam,nak->nkm", shapes, axes)
    where = tuple(one.where for one in vectors)
    eigenvalues = np.array([one.eigenvalue for one in vectors])
    masses = _masses(model, vectors, eigenvalues)
    frequency = frequencies_of(eigenvalues, where)
    others = max(one.other_points for one in vectors)
    doubts = (f"{others} scalar or other points without a place are left out",) if others else ()
    return ComputedModes(numbers, places, frequency, shapes, masses, where, doubts=doubts)


def _of_one_table(vectors: list[_Vector]) -> list[_Vector]:
    """Return the modes of one table: in the basic system if a file has both; those of one subcase."""
    subcases = sorted({one.subcase for one in vectors})
    if len(subcases) > 1:
        got = ", ".join(map(str, subcases))
        raise DeckError(0, f"must have the modes of one subcase, got {got}: export one of them")
    names = sorted({one.table for one in vectors}, key=lambda name: not name.startswith(BASIC))
    return [one for one in vectors if one.table == names[0]]


def _check_directions(table: str, axes: Array, directions: str | None) -> None:
    """Raise DeckError where it is open whether displacements are in systems of the nodes."""
    if table == EITHER and directions is None and not np.allclose(axes, np.eye(3), atol=1e-6):
        words = "has nodes with displacement coordinate systems of their own, whose directions are open"
        raise DeckError(0, f'table {table}: {words}: pass directions="local" for shapes in them, "global" for others')


def _masses(model: _Model, vectors: list[_Vector], eigenvalues: Array) -> Array | None:
    """Return the modal masses of modes, None if the file lacks them."""
    if not all(one.number in model.masses for one in vectors):
        return None
    highest = np.abs(eigenvalues).max()
    masses = []
    for one in vectors:
        # Several tables are those of several subcases, which they do not name.
        given = model.masses[one.number]
        eigenvalue, mass = min(given, key=lambda row, own=one.eigenvalue: abs(row[0] - own))  # type: ignore[misc]
        if abs(eigenvalue - one.eigenvalue) > ROUNDING * max(abs(eigenvalue), ROUNDING * highest):
            words = f"has the eigenvalue {one.eigenvalue:.7g}, in the table of eigenvalues {eigenvalue:.7g}"
            raise DeckError(0, f"{one.where}: {words}")
        if not mass > 0.0:
            raise DeckError(0, f"{one.where}: has the modal mass {mass:g}, but it must be above 0")
        masses.append(mass)
    return np.array(masses)
