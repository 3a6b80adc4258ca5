"""Datasets of universal files: lines between two lines of -1."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...disk import opened
from .deck_error import DeckError


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

    def numbers(self, at: int, count: int) -> list[float]:
        """Return the numbers of a line."""
        words = self.lines[at].upper().replace("D", "E").split() if at < len(self.lines) else []
        try:
            found = list(map(float, words))
        except ValueError:
            found = []
        if len(found) < count or not np.isfinite(found).all():
            got = self.lines[at].strip()[:60] if at < len(self.lines) else "none"
            raise self.wrong(at, f"needs {count} numbers in a line, got {got!r}")
        return found[:count]


def datasets(path: str | os.PathLike[str]) -> Iterator[Dataset]:
    """Return the datasets of a universal file in their order.

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
        lines = file.read().decode("latin-1").replace("\r\n", "\n").split("\n")
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
