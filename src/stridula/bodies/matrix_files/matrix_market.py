"""Matrix Market files."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

import numpy as np
import scipy.io

from ...arrays import Array
from ...checks import ArgumentError
from ..limits import LARGEST_SIZE, LARGEST_SPARSE, check_size
from ..reading.text import Layout, first_bad, table, text_of
from .entries import Entries, check_full, with_mirror_images

# For files without it.
HEADER = "the first line must be '%%MatrixMarket matrix coordinate real symmetric' or a similar one"

ENTRY = Layout(3, "'row column value'", "%")
VALUE = Layout(1, "one number", "%")


def read_matrix_market(name: str, path: str | os.PathLike[str]) -> Entries:
    """Read a Matrix Market file; SciPy reads only the header, as it may end the process on a truncated file."""
    rows, columns, entries, layout, field, symmetry = scipy.io.mminfo(os.fspath(path))
    if rows != columns:
        raise ArgumentError(name, "be square", got=f"{rows} x {columns}")
    check_size(name, rows, LARGEST_SIZE if layout == "array" else LARGEST_SPARSE)
    if field not in ("real", "integer", "unsigned-integer") or entries > rows * columns:
        raise ValueError(
            f"the header must announce at most {rows * columns} real entries, but announces {entries} {field}"
        )
    if symmetry not in ("general", "symmetric"):
        raise ValueError(f"the header must announce a general or symmetric matrix, but announces {symmetry}")
    symmetric = symmetry == "symmetric"
    if layout == "array":
        count = rows * (rows + 1) // 2 if symmetric else entries
        (values,) = _numbers(path, VALUE, count)
        # Column by column; for a symmetric matrix the lower triangle.
        j, i = np.triu_indices(rows) if symmetric else np.divmod(np.arange(count), max(rows, 1))
    else:
        i, j, values = _numbers(path, ENTRY, entries)
        i, j = i - 1, j - 1
        if not ((i >= 0) & (i < rows) & (j >= 0) & (j < rows)).all():
            raise ValueError(f"rows and columns must be numbered from 1 to {rows}, got {_beyond(i + 1, j + 1, rows)}")
    kept = values != 0.0
    i, j, values = i[kept], j[kept], values[kept]
    if symmetric:
        i, j, values = with_mirror_images(i, j, values)
    else:
        check_full(i, j, rows, "as its header declares it general")
    return Entries(i, j, values, rows)


def _beyond(rows: Array, columns: Array, size: int) -> int:
    numbers = np.append(rows, columns)
    return int(numbers[(numbers < 1) | (numbers > size)][0])


def _numbers(path: str | os.PathLike[str], layout: Layout, count: int) -> list[Array]:
    """Return the columns of numbers below the header; their number must be that of the header."""
    if not count:
        return table([], layout, str)
    with _below_header(path) as (file, _):
        # One line more than announced shows that there are more.
        columns = table(file, layout, lambda: _bad_line(path, layout), count + 1)
    held = columns[-1].size
    if held != count:
        words = "more" if held > count else held or "none"
        raise ValueError(f"it must hold {count} entries, as its header announces, but holds {words}")
    return columns


@contextmanager
def _below_header(path: str | os.PathLike[str]) -> Iterator[tuple[TextIO, int]]:
    """Open a file at its first entry; yield it with the number of lines above."""
    with text_of(path) as file:
        lines = enumerate(iter(file.readline, ""), 1)
        yield file, next(number for number, line in lines if line.partition("%")[0].strip())


def _bad_line(path: str | os.PathLike[str], layout: Layout) -> str:
    with _below_header(path) as (file, above):
        return first_bad(file, above, layout)
