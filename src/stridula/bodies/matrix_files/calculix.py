"""Files of CalculiX with ``SOLVER=MATRIXSTORAGE``: ``job.sti``, ``job.mas`` and, for their rows, ``job.dof``."""

from __future__ import annotations

import os

from ..limits import LARGEST_SPARSE, check_size
from ..reading.text import Layout, first_bad, table, text_of
from .entries import Entries, both_triangles

ENTRY = Layout(3, "'row column value'", "*")


def read_calculix(name: str, path: str | os.PathLike[str]) -> Entries:
    """Read a triangle of a matrix, lines of row, column and value, rows from 1."""
    with text_of(path) as file:
        rows, columns, values = table(file, ENTRY, lambda: _bad_line(path))
    if not values.size:
        raise ValueError("it holds no number")
    least = min(int(rows.min()), int(columns.min()))
    if least < 1:
        raise ValueError(f"rows and columns must be numbered from 1, got {least}")
    # Every row has an entry on the diagonal, even if it is zero.
    size = max(int(rows.max()), int(columns.max()))
    check_size(name, size, LARGEST_SPARSE)
    kept = values != 0.0
    i, j = rows[kept] - 1, columns[kept] - 1
    return Entries(*both_triangles(i, j, values[kept], "as CalculiX writes it"), size)


def _bad_line(path: str | os.PathLike[str]) -> str:
    with text_of(path) as file:
        return first_bad(file, 0, ENTRY)
