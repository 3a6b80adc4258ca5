"""Results of CalculiX, ``.frd``, as text and binary (manual of cgx, *Result Format*)."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from typing import BinaryIO

import numpy as np

from ...arrays import Array
from ...disk import opened
from ..reading.deck_error import DeckError
from .computed_modes import ComputedModes

# Formats of blocks: text with numbers of 5 and of 10 digits, binary of 4 and of 8 bytes.
SHORT, LONG, SINGLE, DOUBLE = 0, 1, 2, 3
NODES, ELEMENTS, RESULTS, PARAMETER, END = "2C", "3C", "100C", "1P", "9999"
# Nodes of an element by its type.
ELEMENT_NODES = {1: 8, 2: 6, 3: 4, 4: 20, 5: 15, 6: 10, 7: 3, 8: 6, 9: 4, 10: 8, 11: 2, 12: 3}
# Kind of analysis of modes; others in words.
MODAL = 2
ANALYSES = {0: "static", 1: "transient", 3: "frequency response", 4: "buckling or another eigenvalue"}
# Relative difference between modal stiffness and that of frequency and modal mass.
ROUNDING = 1e-3
# Longest line that is read.
LONGEST = 4096


@dataclass
class _Mode:
    """A mode as it is read."""

    line: str
    frequency: float
    mass: float
    stiffness: float
    nodes: Array
    shape: Array


@dataclass
class _File:
    """A file of results, read line by line."""

    file: BinaryIO
    number: int = 0
    nodes: dict[int, Array] = field(default_factory=dict)
    modes: list[_Mode] = field(default_factory=list)
    parameters: dict[str, float] = field(default_factory=dict)
    others: set[str] = field(default_factory=set)
    is_binary: bool = False

    @property
    def size(self) -> int:
        """Size of the file [bytes]."""
        return os.fstat(self.file.fileno()).st_size

    def line(self) -> str:
        """Return the next line, empty at the end of the file."""
        text = self.file.readline(LONGEST)
        self.number += bool(text)
        return text.decode("latin-1")

    def need(self, wanted: str) -> str:
        """Return the next line, which must be there."""
        text = self.line()
        if not text:
            raise self.wrong(f"must have {wanted}, but the file ends: it is cut off")
        return text

    def wrong(self, words: str) -> DeckError:
        """Return the error that what was last read is wrong; in binary files a line is a record of text."""
        return DeckError(0 if self.is_binary else self.number, f"{self.place}{words}")

    @property
    def place(self) -> str:
        """Place in a binary file, for messages."""
        return f"before byte {self.file.tell()}: " if self.is_binary else ""

    def whole(self, text: str, wanted: str) -> int:
        """Return a whole number in columns of a line."""
        try:
            return int(text)
        except ValueError:
            raise self.wrong(f"needs {wanted}, got {text.strip()[:40]!r}") from None

    def real(self, text: str, wanted: str) -> float:
        """Return a finite number in columns of a line."""
        try:
            value = float(text)
        except ValueError:
            value = np.nan
        if not np.isfinite(value):
            raise self.wrong(f"needs {wanted}, got {text.strip()[:40]!r}")
        return value


def read_frd(path: str | os.PathLike[str]) -> ComputedModes:
    """Read the modes of a file of CalculiX.

    Parameters
    ----------
    path : str or Path
        The file, as text or binary.

    Returns
    -------
    ComputedModes
        Its modes; none if it has no results of a step ``*FREQUENCY``.

    Raises
    ------
    DeckError
        If a line cannot be read, or the modes are complex or those of a sector.
    OSError
        If the file cannot be read.
    """
    with opened(path) as file:
        held = _File(file)
        first = held.line()
        if first[:6].strip() != "1C":
            raise held.wrong(f"must begin with 1C, as results of CalculiX, got {first.strip()[:40]!r}")
        while text := held.line():
            key = text[:6].strip()
            if key == END:
                break
            if key.startswith(PARAMETER):
                _read_parameter(held, text)
            elif key == NODES:
                _read_nodes(held, text)
            elif key == ELEMENTS:
                _skip_elements(held, text)
            elif text[:6] == "  100C":
                _read_results(held, text)
            elif not key.startswith("1"):
                raise held.wrong(f"must begin a block, got {text.strip()[:40]!r}")
        else:
            raise held.wrong("must have 9999 as last line, but the file ends: it is cut off")
    return _modes(held)


def _modes(held: _File) -> ComputedModes:
    """Return the modes of a file that has been read."""
    if not held.modes:
        got = f"results of other kinds ({', '.join(sorted(held.others))})" if held.others else "no results"
        raise DeckError(0, f"must have modes, as of a step *FREQUENCY with U in *NODE FILE, got {got}")
    numbers = np.array(sorted(held.nodes), dtype=np.int64)
    shapes = np.zeros((numbers.size, 3, len(held.modes)))
    for at, mode in enumerate(held.modes):
        rows = np.searchsorted(numbers, mode.nodes)
        lost = (rows >= numbers.size) | (numbers[np.minimum(rows, numbers.size - 1)] != mode.nodes)
        if lost.any():
            raise DeckError(0, f"{mode.line}: moves node {mode.nodes[lost][0]}, which is not among the nodes")
        shapes[rows, :, at] = mode.shape
    masses = np.array([mode.mass for mode in held.modes])
    frequency = np.array([mode.frequency for mode in held.modes])
    for mode in held.modes:
        implied = mode.mass * (2.0 * np.pi * mode.frequency) ** 2
        if np.isfinite(implied) and abs(implied - mode.stiffness) > ROUNDING * (implied + mode.stiffness) + 1e-30:
            words = f"has the frequency {mode.frequency:g} Hz, the modal mass {mode.mass:g} and the modal stiffness"
            raise DeckError(0, f"{mode.line}: the mode {words} {mode.stiffness:g}, which do not fit")
    return ComputedModes(
        numbers,
        np.array([held.nodes[node] for node in numbers.tolist()]),
        frequency,
        shapes,
        masses if np.isfinite(masses).all() else None,
        tuple(mode.line for mode in held.modes),
    )


def _read_parameter(held: _File, text: str) -> None:
    """Read a parameter of the results that follow: modal mass GM, stiffness GK, nodal diameter HID."""
    name = text[6:12].strip()
    if name == "STEP":
        held.parameters = {}
    elif name in ("GM", "GK", "HID"):
        held.parameters[name] = held.real(text[12:].split()[0] if text[12:].strip() else "", f"a number for {name}")


def _read_nodes(held: _File, text: str) -> None:
    """Read the nodes."""
    count, form = held.whole(text[24:36], "the number of nodes"), held.whole(text[73:75], "the format of the block")
    numbers, places = _values(held, count, form, 3, single=np.float32 if form == SINGLE else np.float64)
    if not np.isfinite(places).all():
        at = int(np.flatnonzero(~np.isfinite(places).all(axis=1))[0])
        raise held.wrong(f"has a place of node {numbers[at]} that is not finite")
    for node, place in zip(numbers.tolist(), places, strict=True):
        if node in held.nodes and not np.array_equal(held.nodes[node], place):
            raise held.wrong(f"ends nodes that have node {node} at two places")
        held.nodes[node] = place


def _skip_elements(held: _File, text: str) -> None:
    """Leave out the elements."""
    count, form = held.whole(text[24:36], "the number of elements"), held.whole(text[73:75], "the format of the block")
    _check(held, count, form)
    if form in (SHORT, LONG):
        _skip_lines(held)
        return
    for _ in range(count):
        header = np.frombuffer(_bytes(held, 16), "<i4")
        if int(header[1]) not in ELEMENT_NODES:
            raise held.wrong(f"has an element of type {header[1]}; 1 to 12 are known")
        _bytes(held, 4 * ELEMENT_NODES[int(header[1])])


def _read_results(held: _File, text: str) -> None:
    """Read results at nodes: displacements of a mode are kept."""
    line = held.place.removesuffix(": ") or f"line {held.number}"
    value = held.real(text[12:24], "the frequency or time of the results")
    count, form = held.whole(text[24:36], "the number of nodes"), held.whole(text[73:75], "the format of the block")
    kind = held.whole(text[56:58], "the kind of analysis")
    header = held.need("the name of the results")
    if not header.startswith(" -4"):
        raise held.wrong(f"must name the results, got {header.strip()[:40]!r}")
    name, components = header[5:13].strip(), held.whole(header[13:18], "the number of components")
    stored = 0
    for _ in range(components):
        row = held.need("the name of a component")
        if not row.startswith(" -5"):
            raise held.wrong(f"must name a component, got {row.strip()[:40]!r}")
        # Components that are calculated from others are not in the file.
        stored += row[33:38].strip() in ("", "0")
    is_mode = kind == MODAL and name.startswith("DISP")
    if is_mode and (name != "DISP" or held.parameters.get("HID", -1.0) >= 0.0):
        raise held.wrong("has complex modes or those of a sector (*CYCLIC SYMMETRY): modes of a whole model are read")
    if name == "DISP" and kind != MODAL:
        held.others.add(ANALYSES.get(kind, f"kind {kind}"))
    if is_mode and stored != 3:
        raise held.wrong(f"must have three components, got {stored}")
    if not is_mode:
        _skip_values(held, count, form, stored)
        return
    nodes, shape = _values(held, count, form, stored, single=np.float32)
    if np.unique(nodes).size != nodes.size:
        raise held.wrong("ends results that have a node twice")
    if value < 0.0 or not np.isfinite(shape).all():
        raise held.wrong(f"ends a mode of {value:g} Hz whose frequency or displacements cannot be")
    mass, stiffness = held.parameters.get("GM", np.nan), held.parameters.get("GK", np.nan)
    held.modes.append(_Mode(line, value, mass, stiffness, nodes, shape))


def _values(held: _File, count: int, form: int, width: int, single: type) -> tuple[Array, Array]:
    """Return the numbers of nodes, and the values at each, of a block."""
    _check(held, count, form)
    if form in (SHORT, LONG):
        return _text_values(held, count, 5 if form == SHORT else 10, width)
    row = np.dtype([("node", "<i4"), ("values", np.dtype(_number(form, single)).newbyteorder("<"), (width,))])
    rows = np.frombuffer(_bytes(held, count * row.itemsize), row)
    return rows["node"].astype(np.int64), rows["values"].astype(float)


def _skip_values(held: _File, count: int, form: int, width: int) -> None:
    """Leave out the values of a block."""
    _check(held, count, form)
    if form in (SHORT, LONG):
        _skip_lines(held)
    else:
        _bytes(held, count * (4 + width * np.dtype(_number(form, np.float32)).itemsize))


def _number(form: int, single: type) -> type:
    return np.float64 if form == DOUBLE else single


def _check(held: _File, count: int, form: int) -> None:
    """Raise DeckError if a block cannot have so many nodes: it must not ask for more memory than the file is large."""
    if form not in (SHORT, LONG, SINGLE, DOUBLE):
        raise held.wrong(f"has a block of format {form}; 0 to 3 are known")
    if not 0 <= count <= held.size:
        raise held.wrong(f"has a block of {count} nodes, more than the file can have")
    held.is_binary |= form in (SINGLE, DOUBLE)


def _skip_lines(held: _File) -> None:
    """Leave out lines up to the end of their block."""
    while not held.need("the end of a block").startswith(" -3"):
        pass


def _text_values(held: _File, count: int, digits: int, width: int) -> tuple[Array, Array]:
    """Return the numbers of nodes, and the values at each, of a block of text."""
    size = 3 + digits + 12 * width
    rows = []
    for at in range(count):
        row = held.need("a node").rstrip("\r\n")
        if not row.startswith(" -1") or len(row) < size:
            wanted = f"a node with {width} numbers of 12 characters, the {at + 1}. of {count}"
            raise held.wrong(f"must have {wanted}, got {row.strip()[:40]!r}")
        rows.append(row[3:size])
    end = held.need("the end of a block")
    if not end.startswith(" -3"):
        raise held.wrong(f"must end a block of {count} nodes with -3, got {end.strip()[:40]!r}")
    if not rows:
        return np.empty(0, np.int64), np.empty((0, width))
    table = np.array(rows, dtype=f"S{size - 3}").view("S1").reshape(count, size - 3)
    try:
        nodes = np.ascontiguousarray(table[:, :digits]).view(f"S{digits}").astype(np.int64)[:, 0]
        values = np.ascontiguousarray(table[:, digits:]).view("S12").astype(float)
    except ValueError:
        raise _bad_row(held, rows, digits) from None
    if not np.isfinite(values).all():
        raise _bad_row(held, rows, digits)
    return nodes, values


def _bad_row(held: _File, rows: list[str], digits: int) -> DeckError:
    """Return the error of the first row with a cell that is not a finite number."""
    last = held.number
    for at, row in enumerate(rows):
        held.number = last - len(rows) + at
        try:
            held.whole(row[:digits], "the number of a node")
            for cell in re.findall(".{12}", row[digits:]):
                held.real(cell, "finite numbers of 12 characters")
        except DeckError as error:
            return error
    held.number = last
    return held.wrong("ends a block with a number that cannot be read")


def _bytes(held: _File, size: int) -> bytes:
    """Return the next bytes."""
    rest = held.size - held.file.tell()
    if size > rest:
        raise held.wrong(f"needs {size} more bytes, got {rest}: the file is cut off")
    return held.file.read(size)
