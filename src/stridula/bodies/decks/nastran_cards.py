"""Cards of Nastran: lines of small, large and free fields with their continuations, and included files."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from ...disk import is_there, named, opened
from ..reading.deck_error import DeckError
from ..reading.nastran_fields import real
from ..reading.text import text_of

SMALL = [(at, at + 8) for at in range(8, 72, 8)]
LARGE = [(at, at + 16) for at in range(8, 72, 16)]
MARKER = slice(72, 80)
BEGINNING = re.compile(r"\s*BEGIN(?![\w,*])", re.IGNORECASE)
END = re.compile(r"\s*ENDDATA\b", re.IGNORECASE)
INCLUDE = re.compile(r"\s*INCLUDE(?=[\s'\"])", re.IGNORECASE)
# Sets and parameters of case control.
CONTROL = re.compile(r"\s*(?:(SET)\s+\d+\s*=|(PARAM)\s*,)", re.IGNORECASE)
NUMBER = re.compile(r"[+-]?\.?\d[\d.]*(?:[ED]?[+-]?\d+)?", re.IGNORECASE)
LARGEST_NUMBER = 2**62
# First letters of lines that repeat cards with other numbers, and of lines without a name.
OTHER_LINES = tuple("=0123456789.-/")
CONTINUED = ("", "+", "*", *OTHER_LINES)
# Files that include each other.
DEEPEST = 20
# A mark of UTF-8 at the beginning of a file, read as Latin-1.
BYTE_ORDER = "\xef\xbb\xbf"

Where = tuple[int, str]


@dataclass(slots=True)
class Card:
    """A card with its continuations.

    Attributes
    ----------
    name : str
        Its name in capitals.
    fields : list of str
        Its fields after the name, eight for each line of small fields; empty where the deck has none.
    where : tuple of int and str
        Number of its first line, and name of the file if this is an included one.
    marker : str
        Marker at the end of its last line.
    """

    name: str
    fields: list[str]
    where: Where
    marker: str = ""

    def text(self, at: int) -> str:
        """Return a field, empty if the card is too short."""
        return self.fields[at] if at < len(self.fields) else ""

    def whole(self, at: int, title: str, default: int | None = None) -> int:
        """Return a field as a whole number, named `title` in messages; `default` if it is empty."""
        text = self.text(at)
        if not text and default is not None:
            return default
        try:
            value = int(text)
        except ValueError:
            raise self.bad(title, "a whole number", text) from None
        if "_" in text or abs(value) > LARGEST_NUMBER:
            raise self.bad(title, "a whole number", text)
        return value

    def number(self, at: int, title: str, default: float) -> float:
        """Return a field as a number, named `title` in messages; `default` if it is empty."""
        text = self.text(at)
        if not text:
            return default
        try:
            value = real(text)
        except ValueError:
            raise self.bad(title, "a number", text) from None
        if "_" in text or not math.isfinite(value):
            raise self.bad(title, "a number", text)
        return value

    def bad(self, title: str, wanted: str, got: str) -> DeckError:
        """Return the error of a field."""
        label = " ".join([self.name, *self.fields[:1]]).strip()[:40]
        return refused(self.where, f"{title} of {label} must be {wanted}, got {got[:60]!r}")


def refused(where: Where, words: str) -> DeckError:
    """Return the error of a line, which may be in an included file."""
    line, file = where
    return DeckError(line, f"in the included file {named(file)}, {words}" if file else words)


def cards(path: str | os.PathLike[str], names: Collection[str]) -> Iterator[Card]:
    """Yield the cards of a deck and of the files that it includes; those of case control are SET and PARAM.

    Parameters
    ----------
    path : str or Path
        The deck.
    names : collection of str
        Names of the cards that are read; others have no fields.

    Raises
    ------
    DeckError
        If a line cannot be read, or a file is included that is not below the folder of the deck.
    OSError
        If the deck cannot be read.
    """
    opened(path).close()
    deck = Path(path)
    reader = _Reader(names, deck.parent.resolve(), {deck.resolve()})
    yield from reader.cards(deck, "", 0)


@dataclass
class _Reader:
    names: Collection[str]
    folder: Path
    begun: set[Path] = field(default_factory=set)

    def cards(self, path: Path, file: str, depth: int) -> Iterator[Card]:
        start, control = _control(path, file)
        yield from control
        card: Card | None = None
        lines = _lines(path, start)
        for number, text in lines:
            where = number, file
            if END.match(text):
                break
            if BEGINNING.match(text):
                raise refused(where, f"{text.strip()!r} begins another model: remove all models but one from the deck")
            if _first(text)[:1] in CONTINUED and not INCLUDE.match(text):
                self._go_on(card, text, where)
                continue
            if card is not None:
                yield card
            card = None
            if INCLUDE.match(text):
                target = self._target(_quoted(text, lines), path, where)
                yield from self._included(target, where, depth)
            else:
                card = self._begun(text, where)
        if card is not None:
            yield card

    def _begun(self, text: str, where: Where) -> Card:
        """Return the card that begins with a line."""
        name = _first(text).rstrip("*").rstrip().upper()
        card = Card(name, [], where)
        if name in self.names:
            card.fields, card.marker = _fields(text, where)
        return card

    def _go_on(self, card: Card | None, text: str, where: Where) -> None:
        """Append a line to a card."""
        if card is None:
            raise refused(where, f"the line {text.strip()[:60]!r} has no card before it")
        if card.name not in self.names:
            return
        first = _first(text)
        if first[:1] in OTHER_LINES:
            words = "must begin with the name of a card, a blank, a comma, + or *"
            raise refused(where, f"a line after {card.name} {words}, got {text.strip()[:60]!r}")
        _check_marker(first, card.marker, where)
        fields, card.marker = _fields(text, where)
        if len(fields) >= len(SMALL):
            # The second half of a line of large fields may be left out.
            card.fields += [""] * (-len(card.fields) % len(SMALL))
        card.fields += fields

    def _target(self, name: str, path: Path, where: Where) -> Path:
        """Return the file that an INCLUDE names, from the folder of its own file or of the deck."""
        try:
            found = [(folder / name.replace("\\", "/")).resolve() for folder in (path.parent, self.folder)]
        except (OSError, RuntimeError, ValueError):
            raise refused(where, f"INCLUDE must name a file, got {name[:60]!r}") from None
        target = next((one for one in found if is_there(one)), found[0])
        if not name or not target.is_relative_to(self.folder):
            raise refused(where, f"INCLUDE must name a file below the folder of the deck, got {name[:60]!r}")
        if target in self.begun:
            raise refused(where, f"{name[:60]!r} must be included only once")
        return target

    def _included(self, target: Path, where: Where, depth: int) -> Iterator[Card]:
        self.begun.add(target)
        if depth == DEEPEST:
            raise refused(where, f"at most {DEEPEST} files may include each other")
        try:
            yield from self.cards(target, str(target.relative_to(self.folder)), depth + 1)
        except OSError as error:
            raise refused(where, str(error)) from error


def _lines(path: Path, start: int = 0) -> Iterator[tuple[int, str]]:
    """Yield the lines after line `start` with their numbers, without comments and without empty ones."""
    with text_of(path) as file:
        for number, line in enumerate(file, 1):
            text = line.partition("$")[0].rstrip()
            if number == 1:
                text = text.removeprefix(BYTE_ORDER)
            if text and number > start:
                yield number, text


def _control(path: Path, file: str) -> tuple[int, list[Card]]:
    """Return the number of the line BEGIN BULK, 0 if there is none, and the cards of the case control before it."""
    found: list[Card] = []
    for number, text in _lines(path):
        if BEGINNING.match(text):
            return number, found
        if name := CONTROL.match(text):
            fields = [word.strip() for word in text.split(",")[1:]]
            found.append(Card((name[1] or name[2]).upper(), fields, (number, file)))
    return 0, []


def _quoted(text: str, lines: Iterator[tuple[int, str]]) -> str:
    """Return the name after INCLUDE; a name in quotes may go on in the next lines."""
    name = INCLUDE.sub("", text, count=1).strip()
    quote = name[:1]
    if quote not in ("'", '"'):
        return name
    while name.count(quote) < 2:
        _, further = next(lines, (0, quote))
        name += further.strip()
    return name.split(quote)[1]


def _first(text: str) -> str:
    """Return the first field of a line."""
    return text.partition(",")[0].strip() if "," in text else text.expandtabs(8)[:8].strip()


def _fields(text: str, where: Where) -> tuple[list[str], str]:
    """Return the fields of a line after the first, eight small or four large ones, and the marker at its end."""
    first = _first(text)
    columns = LARGE if first.startswith("*") or first.endswith("*") else SMALL
    if "," in text:
        return _free_fields(text, len(columns), where)
    text = text.expandtabs(8)
    return [text[start:end].strip() for start, end in columns], text[MARKER].strip()


def _free_fields(text: str, count: int, where: Where) -> tuple[list[str], str]:
    """Return the fields and the marker of a line of free fields, which may be longer than a line of small ones."""
    fields = [word.strip() for word in text.rstrip(", ").split(",")[1:]]
    further = fields[count:]
    if all(NUMBER.fullmatch(word) for word in further):
        return fields + [""] * (count - len(fields)), ""
    if len(further) > 1:
        words = f"a line with more than {count} fields must have a marker or only numbers after them"
        raise refused(where, f"{words}, got {text.strip()[:80]!r}")
    return fields[:count], further[0]


def _check_marker(first: str, marker: str, where: Where) -> None:
    """Raise DeckError if the marker at the beginning of a line is not the one at the end of the line before it."""
    begins, ends = first[1:].strip().upper(), marker.upper()
    if begins and ends and begins not in (ends, ends[1:].strip()):
        words = f"the continuation {first!r} must follow the line that ends with it, got one that ends with {marker!r}"
        raise refused(where, words)
