"""Signals in text files of columns: their header, separators, times and missing values."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, choice
from ..disk import LARGEST_TEXT, read
from .channels import TIMES, UNKNOWN, Channel, Uneven, checked_rate, grid, plain_units, seconds

COMMENTS = ("#", "%", "//")
MISSING = frozenset(("", "nan", "na", "n/a", "null", "none", "-"))

# A name with its unit in brackets.
NAMED = re.compile(r"(?P<name>.*?)\s*[\[(](?P<units>[^\])]*)[\])]\s*$")
# The same between blanks.
BLANK_NAMED = re.compile(r"[^\s\[(]+(?:\s*[\[(][^\])]*[\])])?")
UNITS_LINE = re.compile(r"#\s*units:\s*(.*)")
# Words that are units where a line of them follows that of the names.
UNITS = frozenset(
    word
    for words in (
        (
            "s",
            "ms",
            "us",
            "µs",
            "min",
            "m",
            "mm",
            "µm",
            "um",
            "nm",
            "m/s",
            "mm/s",
            "m/s2",
            "mm/s2",
            "g",
            "n",
            "kn",
            "mn",
        ),
        ("n.m", "n*m", "pa", "kpa", "mpa", "bar", "v", "mv", "a", "hz", "khz", "rpm", "1/min", "rad", "rad/s", "deg"),
        ("°", "°c", "degc", "c", "k", "%", "-", "1", "w", "kw", "db", "db(a)"),
    )
    for word in words
)


@dataclass(frozen=True)
class Layout:
    """Layout of a table.

    Attributes
    ----------
    first : int
        Number of the first line of numbers, from 0.
    separator : str
        Separator of its columns, empty for blanks.
    names, units : list of str
        Names and units of the columns, `UNKNOWN` where they are not said.
    """

    first: int
    separator: str
    names: list[str]
    units: list[str]


def read_table(path: Path, sample_rate: float | None, units: Mapping[str, str], decimal: str) -> list[Channel]:
    """Return the channels of a table.

    Parameters
    ----------
    path : Path
        The file.
    sample_rate : float or None
        Sample rate [Hz] of a table without times.
    units : mapping
        Units by name of a column, also of ``time``.
    decimal : {".", ","}
        Decimal mark of the numbers.

    Raises
    ------
    ValueError
        If a line cannot be read, a value is missing, or times are uneven; the message has file and line.
    """
    choice("decimal", decimal, (".", ","))
    lines = _text(path).splitlines()
    layout = _layout(path, lines, decimal)
    numbers, rows = _numbers(path, lines, layout, decimal)
    if len(numbers) < 2:
        raise ArgumentError("table", "have at least 2 lines of numbers", got=len(numbers), where=str(path))
    place = next((k for k, name in enumerate(layout.names) if name.lower() in TIMES), None)
    start, rate = 0.0, 0.0
    if place is not None:
        start, rate = _grid(path, lines, layout, place, numbers[:, place], rows, units, decimal)
        rate = checked_rate(str(path), rate, sample_rate)
    elif sample_rate is None:
        got = ", ".join(map(repr, layout.names))
        raise ArgumentError("sample_rate", "be given for a table without a column named time", got=got, where=str(path))
    else:
        rate = sample_rate
    kept = [k for k in range(len(layout.names)) if k != place]
    if not kept:
        raise ArgumentError("table", "have a column beside time", got="none", where=str(path))
    return [Channel(layout.names[k], layout.units[k], numbers[:, k].copy(), rate, start) for k in kept]


def _text(path: Path) -> str:
    content = read(path, most=LARGEST_TEXT)
    if b"\0" in content[:4096]:
        raise ArgumentError("path", "be a text file of columns", str(path), got="a binary file")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _is_comment(line: str) -> bool:
    return line.lstrip().startswith(COMMENTS)


def _cells(line: str, separator: str) -> list[str]:
    if not separator:
        return line.split()
    if '"' not in line:
        return [cell.strip() for cell in line.split(separator)]
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, skipinitialspace=True))]


def _number(cell: str, decimal: str) -> float | None:
    """Return a cell as a number, NaN for a missing one, None if it is something else."""
    if cell.lower() in MISSING:
        return math.nan
    if decimal == "," and "." not in cell:
        cell = cell.replace(",", ".")
    elif decimal == ",":
        return None
    try:
        return None if "_" in cell else float(cell)
    except ValueError:
        return None


def _separator(line: str, decimal: str) -> str:
    found = (mark for mark in (";", "\t", ",") if mark in line and mark != decimal)
    return next(found, "")


def _layout(path: Path, lines: list[str], decimal: str) -> Layout:
    """Return the layout of a table: the first line of numbers, and the names and units in the lines before it."""
    before: list[int] = []
    stated: list[str] = []
    for number, line in enumerate(lines):
        if found := UNITS_LINE.match(line):
            stated = [cell.strip() for cell in found[1].split(",")]
        if not line.strip() or _is_comment(line):
            continue
        separator = _separator(line, decimal)
        cells = _cells(line, separator)
        if len(cells) > 1 and not cells[-1]:
            cells.pop()
        values = [_number(cell, decimal) for cell in cells]
        if all(value is not None for value in values) and not all(map(math.isnan, values)):  # type: ignore[arg-type]
            names, units = _header(path, lines, before, separator, len(cells), stated)
            return Layout(number, separator, names, units)
        if decimal == "." and separator != "," and all(re.fullmatch(r"[-+\d.,eE]+", cell) for cell in cells):
            raise ArgumentError(
                "decimal", "be ',' for its numbers", got=repr(cells[0]), where=f"{path}, line {number + 1}"
            )
        before.append(number)
    raise ArgumentError("table", "have lines of numbers", got="none", where=str(path))


def _header(
    path: Path, lines: list[str], before: list[int], separator: str, count: int, stated: list[str]
) -> tuple[list[str], list[str]]:
    """Return names and units of the columns from the lines before the numbers, and a comment with units."""
    rows = [_headings(lines[number], separator, count) for number in before[-2:]]
    if not rows or len(rows[-1]) != count:
        if rows and len(rows[-1]) > 1:
            got = f"{len(rows[-1])} in line {before[-1] + 1} over {count} columns"
            raise ArgumentError("header", "have a name for each column", got=got, where=str(path))
        return [f"column {k + 1}" for k in range(count)], [UNKNOWN] * count
    names, units = rows[-1], [UNKNOWN] * count
    if len(stated) == count:
        return names, [plain_units(unit) or UNKNOWN for unit in stated]
    if len(rows) == 2 and len(rows[0]) == count and all(map(_is_unit, names)):
        names, units = rows[0], [plain_units(word.strip("[]()")) or UNKNOWN for word in names]
    for k, name in enumerate(names):
        if found := NAMED.match(name):
            names[k], units[k] = found["name"], plain_units(found["units"]) or UNKNOWN
        names[k] = names[k] or f"column {k + 1}"
    for name in names:
        if names.count(name) > 1:
            where = f"{path}, line {before[-1] + 1}"
            raise ArgumentError("header", "have different names", got=f"{name!r} twice", where=where)
    return names, units


def _headings(line: str, separator: str, count: int) -> list[str]:
    cells = _cells(line, separator) if separator else BLANK_NAMED.findall(line)
    return cells[:-1] if len(cells) == count + 1 and not cells[-1] else cells


def _is_unit(word: str) -> bool:
    return plain_units(word.strip("[]() ")).lower() in UNITS or (word[:1] in "[(" and word[-1:] in "])")


def _numbers(path: Path, lines: list[str], layout: Layout, decimal: str) -> tuple[Array, list[int]]:
    """Return the numbers, shape (rows, columns), and the number of each row's line, from 1."""
    count, mark = len(layout.names), layout.separator
    rows = [k for k in range(layout.first, len(lines)) if lines[k].strip() and not _is_comment(lines[k])]
    kept = [lines[k] for k in rows]
    if mark:
        kept = [line.rstrip().removesuffix(mark) if line.count(mark) == count else line for line in kept]
        sizes = [line.count(mark) + 1 if '"' not in line else len(_cells(line, mark)) for line in kept]
    else:
        sizes = [len(line.split()) for line in kept]
    for k, size in zip(rows, sizes, strict=True):
        if size != count:
            raise ArgumentError(
                "columns", f"be {count}, as in line {layout.first + 1}", got=size, where=f"{path}, line {k + 1}"
            )
    body = (mark or " ").join(kept)
    if '"' not in body and "_" not in body:
        plain = body.replace(",", ".") if decimal == "," and "." not in body else body
        with suppress(ValueError):
            numbers = np.fromiter(map(float, plain.split(mark or None)), float, len(rows) * count)
            if np.isfinite(numbers).all():
                return numbers.reshape(len(rows), count), [k + 1 for k in rows]
    return _slowly(path, rows, kept, layout, decimal), [k + 1 for k in rows]


def _slowly(path: Path, rows: list[int], kept: list[str], layout: Layout, decimal: str) -> Array:
    """Return the numbers one by one, or raise ValueError with the line of the first that is missing or none."""
    found = np.empty((len(rows), len(layout.names)))
    for row, (k, line) in enumerate(zip(rows, kept, strict=True)):
        for column, cell in enumerate(_cells(line, layout.separator)):
            value = _number(cell, decimal)
            if value is None or not math.isfinite(value):
                got = "a missing value" if value is not None and math.isnan(value) else repr(cell)
                name = layout.names[column]
                raise ArgumentError(repr(name), "be a finite number", got=got, where=f"{path}, line {k + 1}")
            found[row, column] = value
    return found


def _grid(
    path: Path,
    lines: list[str],
    layout: Layout,
    place: int,
    times: Array,
    rows: list[int],
    units: Mapping[str, str],
    decimal: str,
) -> tuple[float, float]:
    """Return start [s] and rate [Hz] of the times of a table."""
    name = layout.names[place]
    word = next((units[key] for key in units if str(key).lower() == name.lower()), layout.units[place])
    scale = seconds(word)
    if scale is None:
        got = f"{word!r}; state it as {name} [s], or in units" if word == UNKNOWN else repr(word)
        raise ArgumentError(name, "have a unit of time", got=got, where=str(path))
    cells = (_cells(lines[k - 1], layout.separator)[place] for k in rows)
    digits = _digits(times, np.array([_last_digit(cell, decimal) for cell in cells]))
    try:
        return grid(times * scale, digits * scale)
    except Uneven as error:
        raise ValueError(f"{path}, line {rows[error.sample]}: {error.words}") from None


def _last_digit(cell: str, decimal: str) -> float:
    """Return the value of the last digit of a number as it is written."""
    mantissa, _, exponent = cell.lower().partition("e")
    places = len(mantissa.partition(decimal)[2])
    return float(10.0 ** (int(exponent or 0) - places))


def _digits(times: Array, last: Array) -> Array:
    """Return the digit to which each time is known: the finest one of the times of its size.

    Programs that leave out zeros at the end write some times shorter than they know them.
    """
    size = np.floor(np.log10(np.where(times == 0.0, last.min(), np.abs(times))))
    known = last.copy()
    for one in np.unique(size):
        known[size == one] = last[size == one].min()
    return known
