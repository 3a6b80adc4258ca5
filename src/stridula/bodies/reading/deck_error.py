"""The error that a line of a model cannot be read."""

from __future__ import annotations


class DeckError(ValueError):
    """A line of a deck cannot be read.

    Parameters
    ----------
    line : int
        The line, from 1; 0 in files without lines.
    words : str
        The fault and a remedy.
    file : str, optional
        Name of the included file with this line; the deck itself if left out.
    """

    def __init__(self, line: int, words: str, file: str = "") -> None:
        place = f"line {line}: " if line else ""
        super().__init__(f"{file}, {place}{words}" if file else f"{place}{words}")
