"""Tables of binary files of Nastran, ``.op2``: records of words between their lengths (DMAP module OUTPUT2)."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import BinaryIO

import numpy as np

from ...arrays import Array
from ...disk import named, opened
from ..reading.deck_error import DeckError

# Tables that are kept begin with one of these.
KEPT = ("GEOM1", "LAMA", "OUG", "BOUG", "ROUG", "OPHIG", "BOPHIG")


@dataclass
class Table:
    """A table.

    Attributes
    ----------
    name : str
        Its name.
    at : int
        Byte of the file at which it begins.
    words : numpy.dtype
        Kind of its whole numbers.
    records : list of bytes
        Its records after name and date; those of a table that is not kept are left out.
    """

    name: str
    at: int
    words: np.dtype
    records: list[bytes] = field(default_factory=list)

    def wrong(self, words: str) -> DeckError:
        """Return the error that the table cannot be read."""
        return DeckError(0, f"table {self.name} at byte {self.at}: {words}")

    def whole(self, record: bytes) -> Array:
        """Return a record as whole numbers."""
        if len(record) % self.words.itemsize:
            raise self.wrong(f"has a record of {len(record)} bytes, not of whole words")
        return np.frombuffer(record, self.words)

    def reals(self, record: bytes) -> Array:
        """Return a record as reals."""
        return self.whole(record).view(np.dtype(f"f{self.words.itemsize}").newbyteorder(self.words.byteorder))


def tables(path: str | os.PathLike[str]) -> Iterator[Table]:
    """Yield the tables of a file, those of modes and nodes with their records.

    Parameters
    ----------
    path : str or Path
        The file.

    Raises
    ------
    DeckError
        If it is damaged, or not a binary file of this kind.
    OSError
        If it cannot be read.
    """
    with opened(path) as file:
        reader = _Reader(file, _words(file, path))
        if reader.is_labelled():
            reader.skip_label()
        while (table := reader.table()) is not None:
            yield table


def _words(file: BinaryIO, path: str | os.PathLike[str]) -> np.dtype:
    """Return the kind of the words: that of the length of the first record, which is one word."""
    start = file.read(4)
    file.seek(0)
    for order in "<>":
        for size in (4, 8):
            if start == int(size).to_bytes(4, "little" if order == "<" else "big"):
                return np.dtype(f"{order}i{size}")
    words = "must begin with a record of one word, as binary results of PARAM,POST,-1, -2 or -4"
    raise DeckError(0, f"{words}, got {start!r}: not a binary .op2 ({named(path)})")


@dataclass
class _Reader:
    """A file of records of words; a record of one word before another one is its number of words, its key."""

    file: BinaryIO
    words: np.dtype

    def wrong(self, words: str) -> DeckError:
        """Return the error that what was last read is wrong."""
        return DeckError(0, f"byte {self.file.tell()}: {words}")

    def block(self, keep: bool = True) -> bytes:
        """Return the next record between its lengths, empty if it is not kept or at the end of the file."""
        length = self._length()
        if length is None:
            return b""
        here = self.file.tell()
        if not 0 < length <= os.fstat(self.file.fileno()).st_size - here - 4:
            raise self.wrong(f"a record of {length} bytes begins here, after which the file ends: it is cut off")
        found = self.file.read(length) if keep else b""
        self.file.seek(here + length)
        if self._length() != length:
            raise self.wrong(f"a record of {length} bytes must end here with its length: the file is damaged")
        return found

    def _length(self) -> int | None:
        got = self.file.read(4)
        if len(got) < 4:
            return None
        return int(np.frombuffer(got, np.dtype("i4").newbyteorder(self.words.byteorder))[0])

    def key(self) -> int | None:
        """Return the next key, None at the end of the file."""
        got = self.block()
        if not got:
            return None
        if len(got) != self.words.itemsize:
            raise self.wrong(f"a key of {self.words.itemsize} bytes must end here, got {len(got)}: the file is damaged")
        return int(np.frombuffer(got, self.words)[0])

    def is_labelled(self) -> bool:
        """Return whether the file begins with the date and the label of PARAM,POST,-1."""
        key = self.key()
        self.file.seek(0)
        return key == 3

    def skip_label(self) -> None:
        """Leave out date, label and version."""
        while key := self.key():
            if key > 0:
                self.block(keep=False)

    def table(self) -> Table | None:
        """Return the next table, None at the end of the file."""
        at = self.file.tell()
        key = self.key()
        if not key:
            return None
        name = self.block().decode("latin-1")
        if self.words.itemsize == 8:
            # A word has four characters and four blanks.
            name = "".join(name[start : start + 4] for start in range(0, len(name), 8))
        found = Table(name.strip(), at, self.words)
        keep = found.name.startswith(KEPT)
        record: list[bytes] = []
        while key := self._needed(found):
            if key > 0:
                record.append(self.block(keep))
                if keep and len(record[-1]) != key * self.words.itemsize:
                    raise self.wrong(f"a record of {key} words must end here, got {len(record[-1])} bytes")
                continue
            # The first three are name, trailer, and name with date; others begin with their type.
            if keep and key < -3 and len(record) > 1:
                found.records.append(b"".join(record[1:]))
            record = []
        return found

    def _needed(self, table: Table) -> int:
        key = self.key()
        if key is None:
            raise table.wrong("has no end: the file is cut off")
        return key
