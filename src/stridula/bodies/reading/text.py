"""Numbers in the lines of text files, read piece by piece; errors name the number of the line."""

from __future__ import annotations

import io
import itertools
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from typing import TextIO

import numpy as np

from ...arrays import Array
from ...disk import opened

# Lines that are converted to numbers at once.
PIECE = 2**18
# Upper bound of numbers of rows, nodes and degrees of freedom.
LARGEST_NUMBER = 2**40


@dataclass(frozen=True)
class Layout:
    """Layout of a line with an entry of a matrix.

    Attributes
    ----------
    width : int
        Count of numbers; all but the last are whole.
    wanted : str
        Description for messages.
    remark : str
        Beginning of a remark.
    comma : str, optional
        Separator of numbers; None for blanks.
    """

    width: int
    wanted: str
    remark: str
    comma: str | None = None


def table(lines: Iterable[str], layout: Layout, bad_line: Callable[[], str], most: int | None = None) -> list[Array]:
    """Return the columns of lines of numbers: those of whole numbers, then that of values.

    Parameters
    ----------
    lines : iterable of str
        The lines; empty ones and remarks are ignored.
    layout : Layout
        Layout of the lines.
    bad_line : callable
        Returns the error of the first bad line, empty if there is none.
    most : int, optional
        Number of lines to read, all if left out.

    Raises
    ------
    ValueError
        If a line is not an entry; the message names it.
    """
    held = (line for line in lines if line.partition(layout.remark)[0].strip())
    entries = itertools.islice(held, most)
    pieces: list[list[Array]] = []
    try:
        while piece := list(itertools.islice(entries, PIECE)):
            pieces.append(_columns(piece, layout))
    except ValueError as error:
        raise ValueError(bad_line() or str(error)) from error
    if not pieces:
        return [np.empty(0, dtype=np.int32)] * (layout.width - 1) + [np.empty(0)]
    return [np.concatenate([piece.pop(0) for piece in pieces]) for _ in range(layout.width)]


def _columns(lines: list[str], layout: Layout) -> list[Array]:
    numbers = np.loadtxt(lines, delimiter=layout.comma, comments=layout.remark, ndmin=2)
    if numbers.shape[1] != layout.width or not _are_numbers(numbers[:, :-1]):
        raise ValueError("it is not a matrix")
    whole = numbers[:, :-1].T
    small = np.int32 if np.abs(whole).max(initial=0.0) < 2**31 else np.int64
    return [*whole.astype(small), numbers[:, -1].copy()]


def _are_numbers(numbers: Array) -> bool:
    """Return whether numbers of rows and columns are whole and not too large."""
    return bool(((numbers == np.round(numbers)) & (np.abs(numbers) < LARGEST_NUMBER)).all())


def first_bad(lines: Iterable[str], above: int, layout: Layout) -> str:
    """Return the error message for the first line, after `above` others, that is not an entry, or an empty string."""
    for number, line in enumerate(lines, above + 1):
        text = line.partition(layout.remark)[0].strip()
        if text and not _is_entry(text.split(layout.comma), layout.width):
            return f"line {number} must be {layout.wanted}, got {text[:60]!r}"
    return ""


def _is_entry(words: list[str], width: int) -> bool:
    try:
        values = [float(word) for word in words]
    except ValueError:
        return False
    return len(words) == width and all(v.is_integer() and abs(v) < LARGEST_NUMBER for v in values[:-1])


class Lines:
    """The lines of a file, counted as they are taken."""

    def __init__(self, file: TextIO) -> None:
        self._file = file
        self.number = 0

    def __iter__(self) -> Iterator[str]:
        return iter(self.take, "")

    def take(self) -> str:
        """Return the next line without its end, empty at the end of the file."""
        line = self._file.readline()
        self.number += bool(line)
        return line.rstrip("\r\n") or ("\n" if line else "")

    def need(self, wanted: str) -> str:
        """Return the next line, which must be there.

        Raises
        ------
        ValueError
            If the file has ended.
        """
        line = self.take()
        if not line:
            raise ValueError(f"line {self.number + 1} must be {wanted}, but the file ends before it")
        return line

    def bad(self, wanted: str, got: str) -> ValueError:
        """Return the error to raise if the line last taken has another form."""
        return ValueError(f"line {self.number} must be {wanted}, got {got.strip()[:60]!r}")

    def numbers(self, count: int, across: int, width: int) -> Array:
        """Return `count` numbers in columns of `width` characters, `across` in a line.

        Raises
        ------
        ValueError
            If a line holds something else; the message names it.
        """
        wanted = f"{across} numbers of {width} characters" if across > 1 else f"a number of {width} characters"
        pieces = []
        while count > 0:
            taken = min(-(-count // across), PIECE)
            first = self.number + 1
            lines = [self.need(wanted) for _ in range(taken)]
            here = min(count, taken * across)
            pieces.append(self._piece(lines, first, wanted, (here, across, width)))
            count -= here
        return np.concatenate(pieces) if pieces else np.empty(0)

    def _piece(self, lines: list[str], first: int, wanted: str, form: tuple[int, int, int]) -> Array:
        count, across, width = form
        fixed = np.array([_fortran(line).encode("ascii", "replace") for line in lines], dtype=f"S{across * width}")
        cells = fixed.view(f"S{width}")[:count]
        try:
            return cells.astype(float)
        except ValueError:
            pass
        # SciPy announces columns that are wider than those it writes.
        words = [line.split() for line in map(_fortran, lines)]
        if [len(line) for line in words] == [min(across, count - at) for at in range(0, count, across)]:
            with suppress(ValueError):
                return np.array([float(word) for line in words for word in line])
        for at, cell in enumerate(cells.tolist()):
            try:
                float(cell)
            except ValueError:
                self.number = first + at // across
                raise self.bad(wanted, lines[at // across]) from None
        raise ValueError(f"line {first} must be {wanted}")


def _fortran(line: str) -> str:
    return line.replace("D", "E").replace("d", "e")


def text_of(path: str | os.PathLike[str]) -> TextIO:
    """Open a file as text of any encoding."""
    return io.TextIOWrapper(opened(path), encoding="latin-1")
