"""Points of a sweep, from options of the command line or from tables."""

from __future__ import annotations

import csv
import io
import math
import re
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from ..checks import ArgumentError, brief, listed
from ..disk import LARGEST_TEXT, read
from ..scenarios.quantities import parts
from ..studies.points import Grid, LatinHypercube, Range

Points = Grid | LatinHypercube | list[dict[str, str]]
# More points than this need confirmation.
MANY = 10_000
_WHOLE = re.compile(r"[+-]?\d+")


@dataclass(frozen=True)
class Span:
    """Evenly spaced numbers between two ends.

    Attributes
    ----------
    low, high : float
        Ends, in `unit`.
    unit : str
        Unit as written, empty if none.
    count : int or None
        Number of values, None if not given.
    """

    low: float
    high: float
    unit: str
    count: int | None

    def ends(self) -> tuple[float, float] | tuple[str, str]:
        """Return both ends, as texts if there is a unit."""
        return (f"{self.low!r} {self.unit}", f"{self.high!r} {self.unit}") if self.unit else (self.low, self.high)

    @property
    def size(self) -> int:
        """Number of values."""
        return self.count or 1

    def values(self) -> list[float] | list[str]:
        """Return the numbers, ends included, as texts if there is a unit."""
        numbers: list[float] = np.linspace(self.low, self.high, self.size).tolist()
        return [f"{number!r} {self.unit}" for number in numbers] if self.unit else numbers


@dataclass(frozen=True)
class Words:
    """Values given as a list.

    Attributes
    ----------
    words : list of str
        The values as written.
    """

    words: list[str]

    @property
    def size(self) -> int:
        """Number of values."""
        return len(self.words)

    def ends(self) -> None:
        """Return None: a list has no range."""

    def values(self) -> list[str]:
        """Return the values."""
        return self.words


def points_of(vary: list[str], sample: int | None, seed: int | None, table: str | None, yes: bool) -> Points:
    """Return the points given by options.

    Parameters
    ----------
    vary : list of str
        ``KEY=START:STOP:COUNT``, ``KEY=START:STOP`` or ``KEY=A,B,C``.
    sample, seed : int or None
        Number of points of a Latin hypercube, and its seed.
    table : str or None
        CSV file with one point per row.
    yes : bool
        Whether there may be more than 10 000 points.

    Raises
    ------
    ValueError
        If an option is invalid, or excluded by another one.
    OSError
        If the table cannot be read.
    """
    if (table is None) == (not vary):
        raise ArgumentError("points", "be given by --vary or by --points", got="neither" if table is None else "both")
    if seed is not None and sample is None:
        raise ArgumentError("--seed", "be used with --sample", got=f"{seed} alone")
    if table is not None:
        if sample is not None:
            raise ArgumentError("--sample", "be used with --vary", got="--points")
        rows = _rows(table)
        check_count(len(rows), yes)
        return rows
    if sample is None:
        return _grid(_asked(vary, is_sampled=False), yes)
    return _hypercube(_asked(vary, is_sampled=True), sample, seed, yes)


def numbers_of(text: str) -> tuple[str, list[float], str]:
    """Return the key, the numbers and the unit of ``KEY=START:STOP:COUNT`` or ``KEY=A,B,C``.

    Raises
    ------
    ValueError
        If they are not at least 2 rising numbers of one unit, or more than 10 000.
    """
    ((key, asked),) = _asked([text], is_sampled=False).items()
    if asked.size > MANY:
        raise ArgumentError("--vary", f"have a COUNT of at most {MANY} here", text)
    known = [parts(value) for value in asked.values()]
    numbers, units = [one[0] for one in known if one], {one[1] for one in known if one}
    rises = all(one < other for one, other in pairwise(numbers))
    if None in known or len(units) != 1 or len(numbers) < 2 or not rises:
        raise ArgumentError("--vary", "give at least 2 increasing numbers in one unit for this command", text)
    return key, numbers, units.pop()


def _asked(vary: list[str], is_sampled: bool) -> dict[str, Span | Words]:
    asked: dict[str, Span | Words] = {}
    for text in vary:
        key, equals, values = (part.strip() for part in text.partition("="))
        if not equals or not key or not values:
            raise ArgumentError("--vary", "be KEY=START:STOP:COUNT or KEY=A,B,C", text)
        if key in asked:
            raise ArgumentError("--vary", "name each key once", key, got=f"{key!r} twice")
        asked[key] = _range(text, values, is_sampled) if ":" in values else Words(_list(text, values))
    return asked


def ranges_of(vary: list[str]) -> dict[str, Range]:
    """Return the ranges given by ``KEY=LOW:HIGH`` or ``KEY=LOW:HIGH:log``.

    Raises
    ------
    ValueError
        If a text has another form, or a key appears twice.
    """
    found: dict[str, Range] = {}
    for text in vary:
        key, equals, values = (part.strip() for part in text.partition("="))
        ends, _, word = values.rpartition(":")
        logarithmic = word.strip() == "log"
        if not equals or not key or (ends if logarithmic else values).count(":") != 1:
            raise ArgumentError("--vary", "be KEY=LOW:HIGH or KEY=LOW:HIGH:log", text)
        if key in found:
            raise ArgumentError("--vary", "name each key once", key, got=f"{key!r} twice")
        low, high = _range(text, ends if logarithmic else values, is_sampled=True).ends()
        try:
            found[key] = Range(low, high, logarithmic)
        except ArgumentError as error:
            raise error.inside(f"--vary {key}") from None
    return found


def _hypercube(asked: dict[str, Span | Words], sample: int, seed: int | None, yes: bool) -> LatinHypercube:
    check_count(sample, yes)
    ranges: dict[str, tuple[Any, Any]] = {}
    for key, given in asked.items():
        ends = given.ends()
        if ends is None:
            raise ArgumentError("--vary", "be KEY=START:STOP with --sample", got=f"a list for {key!r}")
        ranges[key] = ends
    return LatinHypercube(ranges, sample, seed or 0)


def _grid(asked: dict[str, Span | Words], yes: bool) -> Grid:
    check_count(math.prod(given.size for given in asked.values()), yes)
    return Grid({key: given.values() for key, given in asked.items()})


def check_count(count: int, yes: bool) -> None:
    """Raise ValueError if there are more than 10 000 points and they are not confirmed."""
    if count > MANY and not yes:
        raise ArgumentError(f"a sweep of more than {MANY} points", "be confirmed with --yes", got=f"{count} points")


def _list(text: str, values: str) -> list[str]:
    found = [value.strip() for value in values.split(",")]
    if not all(found):
        raise ArgumentError("--vary", "have a value between commas", text)
    return found


def _range(text: str, values: str, is_sampled: bool) -> Span:
    wanted = "KEY=START:STOP with --sample" if is_sampled else "KEY=START:STOP:COUNT"
    pieces = values.split(":")
    if len(pieces) != (2 if is_sampled else 3):
        raise ArgumentError("--vary", f"be {wanted}", text)
    (low, unit_of_low), (high, unit) = (_number(text, piece) for piece in pieces[:2])
    if unit_of_low not in ("", unit):
        raise ArgumentError("--vary", "have one unit for both ends", text)
    count = None if is_sampled else _count(text, pieces[2].strip())
    if low >= high and count != 1:
        raise ArgumentError("--vary", "have START below STOP", text)
    return Span(low, high, unit, count)


def _number(text: str, piece: str) -> tuple[float, str]:
    known = parts(piece)
    if known is None:
        raise ArgumentError("--vary", "have numbers for START and STOP", text)
    if not math.isfinite(known[0]):
        raise ArgumentError("--vary", "have finite numbers", text)
    return known


def _count(text: str, piece: str) -> int:
    if not _WHOLE.fullmatch(piece):
        raise ArgumentError("--vary", "have a whole number for COUNT", text)
    if int(piece) < 1:
        raise ArgumentError("--vary", "have a COUNT of at least 1", text)
    return int(piece)


def _rows(path: str) -> list[dict[str, str]]:
    """Return the rows of a table as dictionaries keyed by its header."""
    try:
        text = read(path, most=LARGEST_TEXT).decode("utf-8-sig")
        lines = [(number, row) for number, row in enumerate(csv.reader(io.StringIO(text)), start=1) if any(row)]
    except (UnicodeDecodeError, csv.Error) as error:
        raise ArgumentError("--points", "be a CSV file in UTF-8", path, got=f"{path!r}: {error}") from None
    if len(lines) < 2:
        raise ArgumentError(
            "--points", "hold a row of keys and at least one of values", got=f"{len(lines)} in {path!r}"
        )
    header = [key.strip() for key in lines[0][1]]
    if not all(header) or len(set(header)) < len(header):
        raise ArgumentError("--points", "name each key once in its first row", got=f"{listed(header)} in {path!r}")
    for number, row in lines[1:]:
        if len(row) != len(header) or not all(value.strip() for value in row):
            raise ArgumentError(
                "--points",
                f"have a value for each of {listed(header)}",
                row,
                got=f"{brief(row)} in line {number} of {path!r}",
            )
        wrong = next((value for value in row if (known := parts(value)) and not math.isfinite(known[0])), None)
        if wrong is not None:
            raise ArgumentError(
                "--points", "have finite numbers", wrong, got=f"{wrong.strip()!r} in line {number} of {path!r}"
            )
    return [dict(zip(header, (value.strip() for value in row), strict=True)) for _, row in lines[1:]]
