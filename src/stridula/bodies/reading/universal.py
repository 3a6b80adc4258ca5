"""Datasets of universal files: lines between two lines of -1."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...disk import opened
from .deck_error import DeckError

# Place between a number with an exponent and a negative number without a blank.
TOUCHING = re.compile(r"(?:(?<=E[+-]\d\d)|(?<=E[+-]\d\d\d))(?=-)")
# Beginning of a binary dataset: order of bytes, form of numbers, and counts of lines and of bytes.
BINARY = re.compile(rb"(?m)^[ ]*-1[ ]*\r?\n[ ]*58b[ ]+\d+[ ]+\d+[ ]+(\d+)[ ]+(\d+)[^\n]*\n")


@dataclass(frozen=True)
class Dataset:
    """A dataset.

    Attributes
    ----------
    name : str
        Its number.
    first : int
        Number of its first line in the file, from 1.
    lines : list of str
        Its lines after the number.
    """

    name: str
    first: int
    lines: list[str]

    def wrong(self, at: int, words: str) -> DeckError:
        """Return the error that a line cannot be read."""
        return DeckError(self.first + at, f"dataset {self.name} {words}")

    def whole(self, at: int, least: int = 0) -> list[int]:
        """Return the whole numbers of a line."""
        words = self.lines[at].split() if at < len(self.lines) else []
        try:
            found = list(map(int, words))
        except ValueError:
            raise self.wrong(at, f"needs whole numbers, got {self.lines[at].strip()[:60]!r}") from None
        if len(found) < least:
            raise self.wrong(at, f"needs {least} whole numbers in a line, got {len(found)}")
        return found

    def words(self, at: int) -> list[str]:
        """Return the numbers of a line as text; negative ones may follow another number without a blank."""
        text = self.lines[at].upper().replace("D", "E") if at < len(self.lines) else ""
        return TOUCHING.sub(" ", text).split()

    def numbers(self, at: int, count: int) -> list[float]:
        """Return the numbers of a line."""
        words = self.words(at)
        try:
            found = list(map(float, words))
        except ValueError:
            found = []
        if len(found) < count or not np.isfinite(found).all():
            got = self.lines[at].strip()[:60] if at < len(self.lines) else "none"
            raise self.wrong(at, f"needs {count} numbers in a line, got {got!r}")
        return found[:count]


def datasets(path: str | os.PathLike[str]) -> Iterator[Dataset]:
    """Return the datasets of a universal file in their order, binary functions without their numbers.

    Parameters
    ----------
    path : str or Path
        The file.

    Raises
    ------
    DeckError
        If a dataset has no end.
    OSError
        If the file cannot be read.
    """
    with opened(path) as file:
        lines = _without_binary(file.read()).decode("latin-1").replace("\r\n", "\n").split("\n")
    at = 0
    while at < len(lines):
        at += 1
        if lines[at - 1].strip() != "-1":
            continue
        end = next((k for k in range(at, len(lines)) if lines[k].strip() == "-1"), None)
        if end is None:
            if any(line.strip() for line in lines[at:]):
                raise DeckError(at, "the dataset that begins here has no end, a line of -1: the file is cut off")
            return
        if end > at:
            yield Dataset(lines[at].strip(), at + 2, lines[at + 1 : end])
        # An end without a dataset before it would take the next beginning for its end.
        at = end + 1 if end > at else at


def _without_binary(content: bytes) -> bytes:
    """Return the content of a file without the numbers of binary functions, which may look like lines."""
    kept, at = [], 0
    for match in BINARY.finditer(content):
        if match.start() < at:
            continue
        stop = match.end()
        for _ in range(int(match[1])):
            stop = content.find(b"\n", stop) + 1 or len(content)
        kept.append(content[at:stop])
        at = stop + int(match[2])
        if at > len(content):
            line = content.count(b"\n", 0, match.start()) + 2
            raise DeckError(line, f"a binary function of {match[2].decode()} bytes begins here: the file is cut off")
    return b"".join([*kept, content[at:]])
