"""Columns of numbers in text files."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .arrays import Array
from .checks import ArgumentError
from .disk import opened


def read_columns(path: str | Path, columns: Sequence[str | int]) -> list[list[float]]:
    """Return columns of numbers of a text file, by name in its header or by number from 0.

    Values are separated by commas, semicolons, tabs or blanks; lines that begin with ``#`` are skipped.

    Raises
    ------
    ValueError
        If a column is missing or a value is not a number; the message has file and line.
    """
    path, places = Path(path), None
    found: list[list[float]] = [[] for _ in columns]
    with opened(path) as file:
        lines = file.read().decode("utf-8-sig").splitlines()
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        cells = _cells(line)
        if places is None:
            is_header = not _is_number(cells[0])
            places = [_place(column, cells if is_header else [], len(cells), path, number) for column in columns]
            if is_header:
                continue
        for place, column in zip(places, found, strict=True):
            if place >= len(cells) or not _is_number(cells[place]):
                got = repr(cells[place]) if place < len(cells) else "nothing"
                raise ArgumentError(f"column {place + 1}", "be a number", got=got, where=f"{path}, line {number}")
            column.append(float(cells[place]))
    if not found[0]:
        raise ArgumentError("table", "have lines of numbers", got="none", where=str(path))
    return found


def read_rising(path: str | Path, columns: Sequence[str | int]) -> list[Array]:
    """Do `read_columns`, with the lines in the order of the first column, those of equal values as in the file."""
    found = [np.array(one) for one in read_columns(path, columns)]
    order = np.argsort(found[0], kind="stable")
    return [one[order] for one in found]


def _cells(line: str) -> list[str]:
    for separator in (";", "\t", ","):
        if separator in line:
            return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
    return line.split()


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _place(column: str | int, header: Sequence[str], count: int, path: Path, line: int) -> int:
    """Return the number of a column, given by name or number."""
    where = f"{path}, line {line}"
    if isinstance(column, str):
        if column not in header:
            known = ", ".join(header) or "numbers, as the file names none"
            raise ArgumentError("columns", f"be out of {known}", column, where=where)
        return header.index(column)
    if not 0 <= column < count:
        raise ArgumentError("columns", f"be below {count}, the number of columns", column, where=where)
    return column
