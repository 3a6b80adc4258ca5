"""Harwell-Boeing files, as written by Ansys' HBMAT."""

from __future__ import annotations

import os
import re

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError
from ..limits import LARGEST_SPARSE, check_size
from ..reading.text import Lines, text_of
from .entries import Entries, both_triangles, check_full

KIND = re.compile(rb"[RCPrcp][SUHZRsuhzr][AEae]\s+\d+\s+\d+\s+\d+")
FORM = re.compile(r"\(\s*(?:\d+P\s*,?\s*)?(\d*)\s*[IEDFGiedfg](\d+)(?:\.\d+)?(?:E\d+)?\s*\)")


def is_harwell_boeing(head: bytes) -> bool:
    """Return whether a file with this beginning is a Harwell-Boeing file."""
    lines = head.split(b"\n", 3)
    return len(lines) > 3 and KIND.match(lines[2]) is not None


def read_harwell_boeing(name: str, path: str | os.PathLike[str]) -> Entries:
    """Read an assembled matrix of real numbers; a right-hand side is ignored."""
    with text_of(path) as file:
        lines = Lines(file)
        lines.need("a title")
        counts = lines.need("the numbers of lines").split()
        kind, size, held = _heading(name, lines)
        text = lines.need("the formats of numbers")
        forms = [(int(match[1] or 1), int(match[2])) for match in FORM.finditer(text)]
        if len(forms) < 3 or min(min(form) for form in forms) < 1:
            raise lines.bad("three formats such as (8I10) or (4E20.12)", text)
        if len(counts) > 4 and counts[4] not in ("0", ""):
            lines.need("the format of the right-hand side")
        starts = lines.numbers(size + 1, *forms[0]) - 1
        rows = lines.numbers(held, *forms[1]) - 1
        values = lines.numbers(held, *forms[2])
    if starts[0] != 0 or starts[-1] != held or (np.diff(starts) < 0).any():
        raise ValueError(f"its columns must begin from 1 on to {held + 1}, rising")
    if held and (rows.min() < 0 or rows.max() >= size):
        raise ValueError(f"rows must be numbered from 1 to {size}")
    columns = np.repeat(np.arange(size, dtype=np.int32), np.diff(starts).astype(np.int64))
    i, j, values = _kept(rows.astype(np.int32), columns, values)
    if kind[1] == "S":
        return Entries(*both_triangles(i, j, values, "as its header declares it symmetric"), size)
    check_full(i, j, size, "as its header declares it unsymmetric")
    return Entries(i, j, values, size)


def _heading(name: str, lines: Lines) -> tuple[str, int, int]:
    """Return the kind of matrix, its number of rows and its number of entries."""
    text = lines.need("the kind of matrix and its size")
    kind, *numbers = text.split()[:4]
    rows, columns, held = map(int, numbers)
    kind = kind.upper()
    if kind[0] != "R":
        raise ValueError(f"{name} must be real, got {kind}: {'complex numbers' if kind[0] == 'C' else 'a pattern'}")
    if kind[1] not in "SU" or kind[2] != "A":
        raise ValueError(f"{name} must be assembled and symmetric or unsymmetric (RSA, RUA), got {kind}")
    if rows != columns:
        raise ArgumentError(name, "be square", got=f"{rows} x {columns}")
    check_size(name, rows, LARGEST_SPARSE)
    if held > rows * columns:
        raise ValueError(f"the header must announce at most {rows * columns} entries, but announces {held}")
    return kind, rows, held


def _kept(rows: Array, columns: Array, values: Array) -> tuple[Array, Array, Array]:
    kept = values != 0.0
    return rows[kept], columns[kept], values[kept]
