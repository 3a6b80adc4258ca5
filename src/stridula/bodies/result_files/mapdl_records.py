"""Records of binary files of Ansys: length, flags and values, which may be without zeros (layout of fdresu.inc)."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from ...arrays import Array
from ..reading.deck_error import DeckError

# First number of every file: the length of its standard header [words].
FIRST = 100
# Flags of a record, bits of its second word: without zeros, as windows, compressed, short, whole numbers.
SPARSE, WINDOWS, COMPRESSED, SHORT, WHOLE = (1 << bit for bit in (27, 28, 29, 30, 31))
# Largest number of values of a record [1].
LARGEST = 2**31


@dataclass
class Records:
    """A binary file by the records at its words.

    Attributes
    ----------
    file : BinaryIO
        The file.
    """

    file: BinaryIO

    def __post_init__(self) -> None:
        self.size = os.fstat(self.file.fileno()).st_size
        self.end = 0
        start = self.file.read(4)
        if start == FIRST.to_bytes(4, "big"):
            raise DeckError(0, "must have the lowest byte first, as files of today's machines, got the highest first")
        if start != FIRST.to_bytes(4, "little"):
            raise DeckError(0, f"must begin with {FIRST}, as binary files of Ansys, got {start!r}")

    def wrong(self, at: int, words: str) -> DeckError:
        """Return the error that the record at a word is wrong."""
        return DeckError(0, f"the record at byte {4 * at} {words}")

    def at(self, word: int, wanted: str) -> Array:
        """Return the values of the record at a word, whole numbers or reals; `end` is the word after it.

        Raises
        ------
        DeckError
            If there is no such record.
        """
        if not 0 <= 4 * word <= self.size - 12:
            raise self.wrong(word, f"must have {wanted}, but the file has {self.size} bytes: it is cut off")
        self.file.seek(4 * word)
        length, flags = np.frombuffer(self.file.read(8), "<u4").tolist()
        if 4 * (word + length + 3) > self.size:
            raise self.wrong(word, f"must have {wanted} in {4 * length} bytes, but the file ends: it is cut off")
        if flags & COMPRESSED:
            raise self.wrong(word, "is compressed by zlib: write the results with /FCOMP,RST,0")
        self.end = word + length + 3
        raw = self.file.read(4 * length)
        letter, size = ("i", 4) if flags & WHOLE else ("f", 8)
        kind = np.dtype(f"<{letter}{size // 2 if flags & SHORT else size}")
        try:
            if flags & SPARSE:
                return _without_zeros(raw, kind)
            if flags & WINDOWS:
                return _windows(raw, kind)
            return np.frombuffer(raw, kind)
        except (ValueError, IndexError):
            raise self.wrong(
                word, f"must have {wanted}, but its {4 * length} bytes do not fit: it is damaged"
            ) from None

    def whole(self, word: int, least: int, wanted: str) -> list[int]:
        """Return the whole numbers of the record at a word, at least so many."""
        found = self.at(word, wanted)
        if found.dtype.kind != "i" or found.size < least:
            raise self.wrong(word, f"must have {wanted}, {least} whole numbers or more, got {found.size} {found.dtype}")
        return [int(value) for value in found.tolist()]


def _without_zeros(raw: bytes, kind: np.dtype) -> Array:
    """Return up to 32 values of which a word of bits says which are there."""
    size, bits = np.frombuffer(raw, "<u4", 2).tolist()
    if size > 32:
        raise ValueError("size")
    there = (bits >> np.arange(size)) & 1 == 1
    values = np.zeros(size, kind)
    values[there] = np.frombuffer(raw, kind, int(there.sum()), 8)
    return values


def _windows(raw: bytes, kind: np.dtype) -> Array:
    """Return values that are 0 outside of windows: lone values, runs of values and runs of one value."""
    size, count = np.frombuffer(raw, "<i4", 2).tolist()
    if not 0 <= size < LARGEST or kind.itemsize < 4:
        raise ValueError("size")
    values = np.zeros(size, kind)
    words, at = np.frombuffer(raw, "<i4"), 2
    for _ in range(count):
        start = int(words[at])
        at += 1
        length = 1
        if start <= 0:
            start, length = -start, int(words[at])
            at += 1
        stored = length if length > 0 else 1
        if start + abs(length) > size or not length:
            raise ValueError("window")
        values[start : start + abs(length)] = np.frombuffer(raw, kind, stored, 4 * at)
        at += stored * kind.itemsize // 4
    return values
