"""Modes in results of Ansys, ``.rst``: header, nodes and displacements (layout of fdresu.inc)."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from ...arrays import Array
from ...disk import opened
from ..reading.deck_error import DeckError
from .computed_modes import ComputedModes, Units, frequencies_of
from .mapdl_records import Records

# Word of the header of results, after the standard header of the file.
HEADER = 103
RESULTS = 12
MODAL = 2
ANALYSES = {0: "static", 1: "buckling", 3: "harmonic", 4: "transient", 7: "substructure", 8: "spectrum"}
# Units by their number: metre and newton twice, centimetre and dyne, millimetre and newton.
UNITS = {1: Units(1.0, 1.0), 2: Units(1e2, 1e5), 5: Units(1.0, 1.0), 6: Units(1e3, 1.0)}
OTHER_UNITS = {3: "feet", 4: "inches", 7: "micrometres"}
# Displacements by the numbers of their degrees of freedom.
DISPLACEMENTS = (1, 2, 3)
# Value of a displacement that was not computed.
NOT_COMPUTED = 2.0**100


@dataclass(frozen=True)
class _Header:
    """The header of results.

    Attributes
    ----------
    words : list of int
        Its numbers.
    """

    words: list[int]

    def pointer(self, low: int, high: int) -> int:
        """Return a place in the file [words] of two numbers."""
        return (self.words[high] << 32) + (self.words[low] & 0xFFFFFFFF)

    def check(self) -> None:
        """Raise DeckError unless the results are modes of a whole model, real ones."""
        words = self.words
        if words[7] != MODAL:
            got = ANALYSES.get(words[7], f"kind {words[7]}")
            raise DeckError(0, f"must have modes, ANTYPE,MODAL, got results of the kind {got}")
        if words[20] > 1 or words[16]:
            raise DeckError(0, "has modes of a sector (cyclic symmetry): expand them to a whole model and export it")
        if words[48] not in (0, words[2]):
            raise DeckError(0, f"has {words[2]} of {words[48]} nodes, as of a distributed run: combine its files first")
        if words[32] or words[51]:
            raise DeckError(0, "has complex modes, of a damped solver: real modes are read")
        if not (words[2] > 0 and words[8] > 0):
            raise DeckError(0, f"must have nodes and modes, got {words[2]} and {words[8]}")
        if words[3] < words[8]:
            raise DeckError(0, f"must have room for {words[8]} modes, got {words[3]}: it is damaged")


def read_rst(path: str | os.PathLike[str]) -> ComputedModes:
    """Read the modes of a file of results of Ansys.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    ComputedModes
        Its modes, without modal masses: the file does not state how they are normalised (MODOPT, Nrmkey).

    Raises
    ------
    DeckError
        If the file is damaged, compressed by zlib, or has no real modes of a whole model.
    OSError
        If it cannot be read.
    """
    with opened(path) as file:
        records = Records(file)
        standard = records.whole(0, 20, "the standard header")
        if standard[0] != RESULTS:
            raise DeckError(0, f"must be a file of results (kind {RESULTS}), got kind {standard[0]} of Ansys")
        header = _Header(records.whole(HEADER, 60, "the header of results"))
        header.check()
        return _modes(records, header, standard[4])


def _modes(records: Records, header: _Header, units: int) -> ComputedModes:
    """Return the modes after the header."""
    if units in OTHER_UNITS:
        raise DeckError(0, f"is in {OTHER_UNITS[units]}: export it in metres or millimetres")
    nodes = np.array(records.whole(header.pointer(14, 45), header.words[2], "the numbers of the nodes"))
    numbers, places, angles = _nodes(records, header)
    rows = np.searchsorted(numbers, nodes)
    lost = (rows >= numbers.size) | (numbers[np.minimum(rows, numbers.size - 1)] != nodes)
    if lost.any() or np.unique(nodes).size != nodes.size:
        raise DeckError(0, "has displacements of nodes that are twice, or not among its nodes: it is damaged")
    count = header.words[8]
    times = records.at(header.pointer(11, 41), "the frequencies")
    if times.dtype.kind != "f" or times.size < count or not np.isfinite(times[:count]).all():
        raise DeckError(0, f"must have {count} frequencies, got {times.size}: it is damaged")
    table = records.whole(header.pointer(10, 40), header.words[3] + count, "the places of the modes")
    shapes = np.full((nodes.size, 3, count), np.nan)
    for mode in range(count):
        start = (table[header.words[3] + mode] << 32) + (table[mode] & 0xFFFFFFFF)
        shapes[:, :, mode] = _shape(records, start, nodes.size, mode)
    here = np.isfinite(shapes).all(axis=(1, 2))
    if not here.any():
        raise DeckError(0, "has no node with displacements in every mode: write them with OUTRES,NSOL,ALL")
    doubts = (f"{int((~here).sum())} nodes without displacements are left out",) if not here.all() else ()
    order = np.flatnonzero(here)[np.argsort(nodes[here])]
    axes = Rotation.from_euler("ZXY", angles[rows[order]], degrees=True).as_matrix()
    where = tuple(f"mode {mode + 1}" for mode in range(count))
    signed = times[:count].astype(float)
    return ComputedModes(
        nodes[order],
        places[rows[order]],
        frequencies_of(np.sign(signed) * (2.0 * np.pi * signed) ** 2, where),
        np.einsum("nka,nam->nkm", axes, shapes[order]),
        None,
        where,
        UNITS.get(units),
        doubts,
    )


def _nodes(records: Records, header: _Header) -> tuple[Array, Array, Array]:
    """Return numbers in rising order, places (n, 3) and the angles of the axes [deg], (n, 3), of all nodes."""
    words = records.whole(header.pointer(15, 46), 28, "the header of the geometry")
    count = words[3]
    start = (words[27] << 32) + (words[26] & 0xFFFFFFFF) or words[8]
    if not 0 < count <= records.size:
        raise DeckError(0, f"must have nodes, got {count}")
    rows = np.zeros((count, 7))
    for at in range(count):
        row = records.at(start, "a node")
        if row.dtype.kind != "f" or row.size < 4 or not np.isfinite(row).all():
            raise records.wrong(start, f"must have number, place and angles of a node, got {row.size} {row.dtype}")
        rows[at, : min(row.size, 7)] = row[:7]
        start = records.end
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    return rows[:, 0].astype(np.int64), rows[:, 1:4], rows[:, 4:]


def _shape(records: Records, start: int, size: int, mode: int) -> Array:
    """Return the displacements of a mode in directions of the nodes, shape (nodes, 3), NaN where there are none."""
    words = records.whole(start, 106, f"the header of mode {mode + 1}")
    if words[18]:
        raise DeckError(0, f"mode {mode + 1} is complex: real modes are read")
    freedoms = words[20 : 20 + max(0, min(words[19], 30))]
    across = words[19] + words[97]
    place = (words[105] << 32) + (words[104] & 0xFFFFFFFF) or words[10]
    if not place or not set(freedoms) & set(DISPLACEMENTS):
        raise DeckError(0, f"mode {mode + 1} has no displacements: write them with OUTRES,NSOL,ALL")
    values = records.at(start + place, f"the displacements of mode {mode + 1}")
    if across < len(freedoms) or values.size % across or values.dtype.kind != "f":
        raise records.wrong(start + place, f"must have {across} reals at each node, got {values.size} {values.dtype}")
    rows = values.reshape(-1, across)[:size].astype(float)
    rows = np.where(rows == NOT_COMPUTED, np.nan, rows)
    which = np.arange(size)
    if len(rows) < size:
        which = np.array(records.whole(records.end, len(rows), f"the nodes of mode {mode + 1}"))[: len(rows)] - 1
        if which.size and not (which.min() >= 0 and which.max() < size):
            raise DeckError(0, f"mode {mode + 1} has displacements of nodes that are not there: it is damaged")
    shape = np.full((size, 3), np.nan)
    shape[which] = 0.0
    for column, freedom in enumerate(freedoms):
        if freedom in DISPLACEMENTS:
            shape[which, freedom - 1] = rows[:, column]
    return shape
