"""Decks of keywords, as Abaqus and CalculiX write them: each keyword with its parameters and the rows below it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from ...disk import opened
from ..reading.deck_error import DeckError

# Deepest chain of includes.
DEEPEST = 20


@dataclass(frozen=True)
class Row:
    """A row of data.

    Attributes
    ----------
    line : int
        Its line, from 1.
    words : list of str
        Its entries without blanks around them; an empty one after a comma at the end is left out.
    """

    line: int
    words: list[str]


@dataclass(frozen=True)
class Card:
    """A keyword with its rows.

    Attributes
    ----------
    keyword : str
        Keyword in capitals, without the star, with single blanks: "SOLID SECTION".
    parameters : dict
        Values by the names of parameters in capitals; an empty text for those without a value.
    line : int
        Line of the keyword, from 1.
    file : str
        Name of the included file with this line, empty for the deck itself.
    rows : list of Row
        Rows of data.
    """

    keyword: str
    parameters: dict[str, str]
    line: int
    file: str = ""
    rows: list[Row] = field(default_factory=list)

    def wrong(self, words: str, row: Row | None = None) -> DeckError:
        """Return the error that a row, or the keyword, cannot be read."""
        return DeckError(row.line if row else self.line, words, self.file)

    def number(self, row: Row, at: int, left_out: float | None = None) -> float:
        """Return an entry of a row as a number; `left_out` if there is none."""
        word = row.words[at] if at < len(row.words) else ""
        if not word and left_out is not None:
            return left_out
        try:
            return float(word.lower().replace("d", "e"))
        except ValueError:
            raise self.wrong(f"*{self.keyword} needs a number as entry {at + 1}, got {word[:40]!r}", row) from None

    def whole(self, row: Row, at: int) -> int:
        """Return an entry of a row as a whole number."""
        word = row.words[at] if at < len(row.words) else ""
        try:
            return int(word)
        except ValueError:
            raise self.wrong(
                f"*{self.keyword} needs a whole number as entry {at + 1}, got {word[:40]!r}", row
            ) from None


def read_cards(path: Path) -> Iterator[Card]:
    """Yield the keywords of a deck in their order, those of included files in place of the include.

    Raises
    ------
    DeckError
        If a line cannot be read, or a file is included that is not below the folder of the deck, or includes itself.
    OSError
        If a file cannot be read.
    """
    yield from _cards_of(path, "", path.resolve().parent, (path.resolve(),))


def _cards_of(path: Path, name: str, folder: Path, within: tuple[Path, ...]) -> Iterator[Card]:
    card: Card | None = None
    with opened(path) as file:
        text = file.read().decode("latin-1")
    lines = iter(enumerate(text.splitlines(), 1))
    for number, line in lines:
        stripped = line.strip()
        if not stripped or stripped.startswith("**"):
            continue
        if not stripped.startswith("*"):
            if card is not None and card.keyword != "HEADING":
                words = [word.strip() for word in stripped.split(",")]
                card.rows.append(Row(number, words[:-1] if len(words) > 1 and not words[-1] else words))
            continue
        if card is not None:
            yield card
        whole = stripped
        while whole.endswith(","):
            _, more = next(lines, (0, ""))
            if not more or more.strip().startswith("*"):
                raise DeckError(number, "the keyword ends in a comma, and its next line has no parameters", name)
            whole += more.strip()
        card = _card(whole, number, name)
        if card.keyword == "INCLUDE":
            yield from _included(card, folder, within)
            card = None
    if card is not None:
        yield card


def _card(line: str, number: int, name: str) -> Card:
    keyword, *others = _divided(line[1:])
    pairs = (one.partition("=") for one in others)
    parameters = {word.strip().upper(): value.strip().strip('"') for word, _, value in pairs if word.strip()}
    return Card(" ".join(keyword.upper().split()), parameters, number, name)


def _divided(line: str) -> list[str]:
    """Return the parts of a line between commas that are not within quotation marks."""
    parts, quoted = [""], False
    for sign in line:
        quoted ^= sign == '"'
        if sign == "," and not quoted:
            parts.append("")
        else:
            parts[-1] += sign
    return parts


def _included(card: Card, folder: Path, within: tuple[Path, ...]) -> Iterator[Card]:
    given = card.parameters.get("INPUT", "")
    if not given:
        raise card.wrong("*INCLUDE needs INPUT= with the name of a file")
    path = (folder / given).resolve()
    if not path.is_relative_to(folder):
        raise card.wrong(f"*INCLUDE must name a file below the folder of the deck, got {given[:200]!r}")
    if path in within or len(within) > DEEPEST:
        raise card.wrong(f"*INCLUDE of {given[:200]!r}, which includes itself")
    yield from _cards_of(path, given, folder, (*within, path))
