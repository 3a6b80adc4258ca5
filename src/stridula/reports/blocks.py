"""Parts of a report: tables, lines of text, figures and sounds, collected in sections."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar


@dataclass(frozen=True)
class Facts:
    """Words by name, compared with those of another design.

    Attributes
    ----------
    facts : mapping
        Words by name.
    """

    facts: Mapping[str, str]
    kind: ClassVar[str] = "facts"


@dataclass(frozen=True)
class Table:
    """A table.

    Attributes
    ----------
    columns : mapping
        Cells of each column by its heading.
    title : str
        Title.
    strong : sequence of bool
        Whether a row stands out; no row where empty.
    """

    columns: Mapping[str, Sequence[str]]
    title: str = ""
    strong: Sequence[bool] = ()
    kind: ClassVar[str] = "table"

    @property
    def rows(self) -> list[tuple[tuple[str, ...], bool]]:
        """Cells of each row, and whether it stands out."""
        cells = list(zip(*self.columns.values(), strict=True))
        return list(zip(cells, self.strong or [False] * len(cells), strict=True))


@dataclass(frozen=True)
class Lines:
    """Lines of text.

    Attributes
    ----------
    lines : sequence of str
        The lines.
    """

    lines: Sequence[str]
    kind: ClassVar[str] = "lines"


@dataclass(frozen=True)
class Picture:
    """A figure.

    Attributes
    ----------
    image : str
        An SVG element, or an image of pixels as HTML.
    words : str
        Caption.
    """

    image: str = field(repr=False)
    words: str
    kind: ClassVar[str] = "picture"


@dataclass(frozen=True)
class Player:
    """A sound to play.

    Attributes
    ----------
    content : str
        A WAV file in base 64.
    words : str
        Its description.
    """

    content: str = field(repr=False)
    words: str
    kind: ClassVar[str] = "player"


@dataclass(frozen=True)
class Section:
    """A section of the report of a design.

    Attributes
    ----------
    title : str
        Title.
    blocks : sequence
        Its parts.
    answers : mapping
        Its results in few words, by name, for the first table of the report.
    """

    title: str
    blocks: Sequence[Any]
    answers: Mapping[str, str] = field(default_factory=dict)
