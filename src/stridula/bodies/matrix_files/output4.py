"""OUTPUT4 files of Nastran, text and binary: matrices by columns, full or in strings of nonzero numbers."""

from __future__ import annotations

import math
import os
import re
import struct
from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, BinaryIO, Protocol

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError
from ...disk import opened
from ..limits import LARGEST_SPARSE, check_size
from ..reading.text import Lines, text_of
from .entries import Entries, check_full, filled_in
from .nastran import Held, chosen

SYMMETRIC = 6
# Words of four bytes per number by type: real and complex, in single and double precision.
WORDS = {1: 1, 2: 2, 3: 2, 4: 4}
HEADING = re.compile(r"([ \d-]{8})" * 4 + r"\s*([A-Za-z]\w{0,7})\s*(?:1P,?\s*)?(?:(\d+)[ED](\d+)\.\d+)?")
# A short string begins with its first row and, in the upper half of a word, its length.
HALF = 65536
# Bytes of the heading of a matrix in a binary file, and of one with integers of 64 bits.
HEADING_BYTES, LONG_HEADING_BYTES = 24, 48
# Bytes of the heading of a column.
COLUMN_BYTES = 12


@dataclass(frozen=True)
class Heading:
    """The heading of a matrix.

    Attributes
    ----------
    name : str
        Name.
    columns, rows : int
        Numbers of columns and rows.
    form, kind : int
        Codes of its form, such as square or symmetric, and of the type of its numbers.
    has_long_strings : bool
        Whether strings begin with two words.
    across, width : int
        In a text file, numbers in a line and characters of each.
    """

    name: str
    columns: int
    rows: int
    form: int
    kind: int
    has_long_strings: bool
    across: int = 5
    width: int = 16

    @property
    def is_real(self) -> bool:
        """Whether its numbers are real."""
        return self.kind <= 2


# First row from 0, and the numbers from this row on.
String = tuple[int, Array]


class Source(Protocol):
    """A file, one matrix after the other."""

    def heading(self) -> Heading | None:
        """Return the heading of the next matrix, None at the end."""
        ...

    def column(self, heading: Heading, keep: bool) -> tuple[int, list[String]]:
        """Return the number of a column from 1 and its strings; numbers are read only if they are kept."""
        ...


def is_output4(head: bytes) -> bool:
    """Return whether a file with this beginning is an OUTPUT4 file."""
    if _order(head):
        return True
    match = HEADING.match(head.split(b"\n", 1)[0].decode("latin-1"))
    return match is not None and match[6] is not None


def held_in_output4(path: str | os.PathLike[str]) -> list[Held]:
    """Return the matrices in a file."""
    with _opened(path) as source:
        return list(_walk(source))


def read_output4(role: str, path: str | os.PathLike[str]) -> Entries:
    """Read the matrix of a file that is mass, stiffness or damping by its name."""
    matrix = chosen(role, held_in_output4(path))
    check_size(role, matrix.size, LARGEST_SPARSE)
    rows, columns, values = array("i"), array("i"), array("d")
    with _opened(path) as source:
        for _ in _walk(source, matrix.number, (rows, columns, values)):
            pass
    i, j, numbers = np.array(rows), np.array(columns), np.array(values)
    if not matrix.is_symmetric:
        check_full(i, j, matrix.size, f"as the form of {matrix.name} is square")
        return Entries(i, j, numbers, matrix.size)
    return Entries(*filled_in(i, j, numbers, matrix.size, lambda k: k + 1), matrix.size)


def _walk(source: Source, wanted: int = -1, into: tuple[array[Any], ...] = ()) -> Iterator[Held]:
    """Iterate over the matrices of a file, and collect the entries of the wanted one."""
    number = 0
    while (heading := source.heading()) is not None:
        is_empty, keep = True, number == wanted
        while True:
            column, strings = source.column(heading, keep)
            if column > heading.columns:
                break
            is_empty = is_empty and not strings
            for row, numbers in strings if keep else ():
                held = np.flatnonzero(numbers)
                into[0].frombytes((row + held).astype(np.int32).tobytes())
                into[1].frombytes(np.full(held.size, column - 1, dtype=np.int32).tobytes())
                into[2].frombytes(numbers[held].tobytes())
        size, is_square = heading.rows, heading.rows == heading.columns
        yield Held(heading.name, number, is_square, heading.form == SYMMETRIC, heading.is_real, is_empty, size)
        number += 1


def _checked(heading: Heading) -> Heading:
    if heading.columns < 0 or heading.rows < 0 or heading.kind not in WORDS:
        raise ArgumentError(
            f"the heading of {heading.name}",
            "have numbers of columns and rows and a type from 1 to 4",
            got=f"{heading.columns}, {heading.rows} and {heading.kind}",
        )
    return heading


def _string(heading: Heading, first: int, count: int) -> tuple[int, int]:
    """Return the row from 0 that a string begins with and its length, or raise ValueError if it does not fit."""
    rows = count if heading.is_real else count // 2
    if min(first, count + 1) < 1 or first + rows > heading.rows + 1:
        raise ValueError(
            f"{heading.name} has {heading.rows} rows, but a column has {count} numbers from row {first} on"
        )
    return first - 1, count


def _begun(words: list[int]) -> tuple[int, int]:
    """Return the first row of a string and its number of words, from its one or two leading words."""
    length, first = words if len(words) == 2 else divmod(words[0], HALF)
    return first, length - 1


class _Text:
    """A text file."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._file = text_of(path)
        self._lines = Lines(self._file)

    def __enter__(self) -> _Text:
        return self

    def __exit__(self, *error: object) -> None:
        self._file.close()

    def heading(self) -> Heading | None:
        line = self._lines.take()
        while line and not line.strip():
            line = self._lines.take()
        if not line:
            return None
        match = HEADING.match(line)
        if match is None:
            raise self._lines.bad("columns, rows, form, type and name of a matrix", line)
        columns, rows, form, kind = (self._integer(match[k]) for k in range(1, 5))
        shape = (int(match[6]), int(match[7])) if match[6] else (5, 16)
        if min(shape) < 1 or shape[1] > 64:
            raise self._lines.bad("the format of numbers, such as 1P,5E16.9", line)
        return _checked(Heading(match[5].upper(), columns, abs(rows), form, kind, rows < 0, *shape))

    def column(self, heading: Heading, keep: bool) -> tuple[int, list[String]]:
        column, first, words = self._integers(
            3, f"the number of a column of {heading.name}, its first row and its words"
        )
        if column > heading.columns or first > 0:
            # The numbers of the column after the last one are skipped.
            begin, count = (0, words) if column > heading.columns else _string(heading, first, words)
            return column, [(begin, self._numbers(heading, count, keep))]
        strings = []
        while words > 0:
            given = self._integers(2 if heading.has_long_strings else 1, "the beginning of a string")
            first, length = _begun(given)
            words -= length + len(given)
            begin, count = _string(heading, first, length // (1 if heading.kind in (1, 3) else 2))
            strings.append((begin, self._numbers(heading, count, keep)))
        return column, strings

    def _numbers(self, heading: Heading, count: int, keep: bool) -> Array:
        if keep:
            return self._lines.numbers(count, heading.across, heading.width)
        for _ in range(math.ceil(count / heading.across)):
            self._lines.need("numbers")
        return np.empty(0)

    def _integers(self, count: int, wanted: str) -> list[int]:
        words = self._lines.need(wanted)
        fields = words.split()
        if len(fields) != count:
            raise self._lines.bad(wanted, words)
        return [self._integer(field) for field in fields]

    def _integer(self, field: str) -> int:
        try:
            return int(field)
        except ValueError:
            raise self._lines.bad("of whole numbers", field) from None


class _Binary:
    """A binary file: records with their length before and after them."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self._file: BinaryIO = opened(path)
        self._end = os.stat(path).st_size
        self._order = _order(self._file.read(64))
        self._file.seek(0)

    def __enter__(self) -> _Binary:
        return self

    def __exit__(self, *error: object) -> None:
        self._file.close()

    def heading(self) -> Heading | None:
        if self._file.tell() >= self._end:
            return None
        record = self._record()
        if len(record) == LONG_HEADING_BYTES:
            raise ValueError("it has 64-bit integers; write it with 32-bit integers or as text")
        if len(record) != HEADING_BYTES:
            raise ValueError(f"the heading of a matrix must have {HEADING_BYTES} bytes, but has {len(record)}")
        columns, rows, form, kind = struct.unpack(f"{self._order}4i", record[:16])
        name = record[16:].decode("latin-1").strip("\0 ").upper()
        return _checked(Heading(name, columns, abs(rows), form, kind, rows < 0))

    def column(self, heading: Heading, keep: bool) -> tuple[int, list[String]]:
        record = self._record(None if keep else COLUMN_BYTES)
        if len(record) < COLUMN_BYTES:
            raise ValueError(f"it ends within {heading.name}")
        column, first, words = struct.unpack(f"{self._order}3i", record[:COLUMN_BYTES])
        data = record[COLUMN_BYTES:]
        if not keep:
            return column, [(0, np.empty(0))]
        if words < 0 or len(data) < 4 * words:
            wanted = f"hold the {words} words that it announces"
            raise ValueError(f"column {column} of {heading.name} must {wanted}, but holds fewer")
        if column > heading.columns:
            return column, []
        if first > 0:
            return column, [self._numbers(heading, first, data[: 4 * words])]
        strings, place = [], 0
        count = 2 if heading.has_long_strings else 1
        while place + count <= words:
            row, length = _begun(list(struct.unpack_from(f"{self._order}{count}i", data, 4 * place)))
            place += count
            if length < 1 or place + length > words:
                raise ValueError(
                    f"column {column} of {heading.name} must hold strings of numbers, but holds something else"
                )
            strings.append(self._numbers(heading, row, data[4 * place : 4 * (place + length)]))
            place += length
        return column, strings

    def _numbers(self, heading: Heading, first: int, data: bytes) -> String:
        of = np.dtype(f"{self._order}f{4 if heading.kind in (1, 3) else 8}")
        if len(data) % of.itemsize:
            raise ValueError(f"a column of {heading.name} ends within a number")
        numbers = np.frombuffer(data, dtype=of)
        begin, _ = _string(heading, first, numbers.size)
        return begin, numbers.astype(float)

    def _record(self, most: int | None = None) -> bytes:
        """Return the content of the next record, or its first `most` bytes."""
        length = self._length()
        end = self._file.tell() + length
        if not (length >= 0 and end <= self._end - 4):
            raise ValueError("it ends within a record")
        record = self._file.read(length if most is None else min(most, length))
        self._file.seek(end)
        if self._length() != length:
            raise ValueError("the lengths before and after a record must be equal")
        return record

    def _length(self) -> int:
        word = self._file.read(4)
        if len(word) < 4:
            raise ValueError("it ends within a record")
        return int(struct.unpack(f"{self._order}i", word)[0])


def _order(head: bytes) -> str:
    """Return the byte order of a binary file with this beginning, empty for any other file."""
    for order in "<>":
        for length in (HEADING_BYTES, LONG_HEADING_BYTES):
            word = struct.pack(f"{order}i", length)
            if head.startswith(word) and (head[4 + length : 8 + length] == word or len(head) < 8 + length):
                return order
    return ""


def _opened(path: str | os.PathLike[str]) -> _Text | _Binary:
    with opened(path) as file:
        is_binary = bool(_order(file.read(64)))
    return _Binary(path) if is_binary else _Text(path)
