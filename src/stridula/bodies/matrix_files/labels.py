"""Files with the node and degree of freedom of each row: ``.dof`` of CalculiX, ``.mapping`` of Ansys."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...checks import listed
from ..limits import LARGEST_SPARSE
from ..reading.text import text_of

# Numbers of degrees of freedom, common to all programs, by Ansys' names.
NAMES = {"UX": 1, "UY": 2, "UZ": 3, "ROTX": 4, "ROTY": 5, "ROTZ": 6, "WARP": 7}
DOF = re.compile(r"(\d{1,12})\.(\d)")
MAPPING = re.compile(r"(\d{1,12})\s+(\d{1,12})\s+([A-Za-z]\w*)")
HEADING = re.compile(r"\s*Matrix\s+Eqn\b", re.IGNORECASE)


def read_labels(path: str | os.PathLike[str]) -> Array:
    """Return node and degree of freedom of every row, shape (rows, 2).

    Raises
    ------
    ValueError
        If a line has another form, or repeats the label of an earlier one.
    """
    with text_of(path) as file:
        first = file.readline()
        rows = _of_ansys(file) if HEADING.match(first) else _of_calculix([first], file)
        labels = np.array([label for _, label in rows], dtype=np.int64).reshape(-1, 2)
    if not len(labels):
        raise ValueError("it names no row")
    _, place, times = np.unique(labels, axis=0, return_index=True, return_counts=True)
    if times.max() > 1:
        node, dof = labels[place[np.argmax(times > 1)]].tolist()
        raise ValueError(f"each row must be a different degree of freedom, but node {node} has {dof} twice")
    return labels


def beside(path: str | os.PathLike[str], endings: tuple[str, ...]) -> Path | None:
    """Return the file of labels beside a file of a matrix: the same name with an ending added or replaced."""
    there = Path(path)
    for ending in endings:
        for found in (Path(f"{there}{ending}"), there.with_suffix(ending) if there.name else there):
            if found != there and found.is_file():
                return found
    return None


def _of_calculix(first: list[str], rest: Iterator[str]) -> Iterator[tuple[int, tuple[int, int]]]:
    for number, text in _lines(1, iter([*first, *rest])):
        match = DOF.fullmatch(text)
        if match is None:
            raise ValueError(
                f"line {number} must be 'node.direction' or, first, 'Matrix Eqn  Node  DOF', got {text[:60]!r}"
            )
        yield number, (int(match[1]), int(match[2]))


def _of_ansys(rest: Iterator[str]) -> Iterator[tuple[int, tuple[int, int]]]:
    for row, (number, text) in enumerate(_lines(2, rest), 1):
        match = MAPPING.fullmatch(text)
        if match is None or int(match[1]) != row:
            raise ValueError(f"line {number} must be '{row} node dof', got {text[:60]!r}")
        dof = NAMES.get(match[3].upper())
        if dof is None:
            raise ValueError(f"line {number} must name one of {listed(NAMES)}, got {match[3][:20]!r}")
        yield number, (int(match[2]), dof)


def _lines(first: int, lines: Iterator[str]) -> Iterator[tuple[int, str]]:
    for count, (number, line) in enumerate(((n, text) for n, text in enumerate(lines, first) if text.strip()), 1):
        if count > LARGEST_SPARSE:
            raise ValueError(f"it must name at most {LARGEST_SPARSE} rows, but names more")
        yield number, line.strip()
