"""Text files of matrices by Abaqus, and any other text of rows, columns and values."""

from __future__ import annotations

import os
from collections import Counter

import numpy as np

from ..reading.text import Layout, first_bad, table, text_of
from .entries import LABEL_BASE, Entries, by_position, filled_in, key_of, labels_of
from .matrix_market import HEADER

LABELLED = Layout(5, "'node, dof, node, dof, value'", "*")
NUMBERED = Layout(3, "'row column value'", "*")


def read_abaqus(_: str, path: str | os.PathLike[str]) -> Entries:
    """Read ``FORMAT=MATRIX INPUT``, five numbers a line, or ``FORMAT=COORDINATE``, three, without lines with ``*``."""
    layout = _first_layout(path)
    with text_of(path) as file:
        columns = table(file, layout, lambda: _bad_line(path))
    if layout.width == LABELLED.width:
        if any((dof < 0).any() or (dof >= LABEL_BASE).any() for dof in columns[1:4:2]):
            raise ValueError(f"degrees of freedom of a node must be numbered from 0 to {LABEL_BASE - 1}")
        node, dof, other_node, other_dof = (column.astype(np.int64) for column in columns[:-1])
        i, j, keys = by_position(key_of(node, dof), key_of(other_node, other_dof))
        entries = filled_in(i, j, columns[-1], keys.size, lambda k: tuple(labels_of(keys[[k]])[0].tolist()))
        return Entries(*entries, keys=keys, is_penalised=True)
    rows, others, values = columns
    least = min(int(rows.min()), int(others.min()))
    if least < 1:
        raise ValueError(f"rows and columns must be numbered from 1, got {least}")
    if rows.size > 1 and rows[0] == others[0] == max(rows.max(), others.max()) and values[0] == rows.size - 1:
        raise ValueError(f"{HEADER}, but it begins with '{rows[0]} {others[0]} {values[0]:.0f}', the size of a matrix")
    i, j, keys = by_position(rows - 1, others - 1)
    i, j, values = filled_in(i, j, values, keys.size, lambda k: int(keys[k]) + 1)
    return Entries(keys[i], keys[j], values, is_penalised=True)


def _first_layout(path: str | os.PathLike[str]) -> Layout:
    with text_of(path) as file:
        first = next((line for line in file if line.strip() and not line.lstrip().startswith("*")), "")
    if not first:
        raise ValueError("it holds no number")
    comma = "," if "," in first else None
    return _layout(comma, len(first.split(comma)))


def _layout(comma: str | None, width: int) -> Layout:
    kind = LABELLED if width == LABELLED.width else NUMBERED
    return Layout(kind.width, kind.wanted, kind.remark, comma)


def _bad_line(path: str | os.PathLike[str]) -> str:
    """Return the error message for the first line that is not a matrix entry, or an empty string."""
    layout = _usual_layout(path)
    with text_of(path) as file:
        return first_bad(file, 0, layout)


def _usual_layout(path: str | os.PathLike[str]) -> Layout:
    """Return the most common layout of the lines of a file with damaged lines."""
    counts: Counter[tuple[str | None, int]] = Counter()
    with text_of(path) as file:
        for line in file:
            text, _, remark = line.partition("*")
            if not text.strip() and remark.upper().startswith("MATRIX INPUT"):
                return _layout(",", 5)
            if text.strip():
                comma = "," if "," in text else None
                counts[comma, len(text.split(comma))] += 1
    known = [layout for layout, _ in counts.most_common() if layout[1] in (3, 5)]
    # If no line is intact, commas indicate MATRIX INPUT.
    return _layout(*known[0]) if known else _layout(",", 5) if any(comma for comma, _ in counts) else _layout(None, 3)
