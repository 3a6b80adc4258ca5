"""DMIG cards of Nastran, as in punch files: matrices by node and degree of freedom."""

from __future__ import annotations

import os
import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..reading.nastran_fields import fields_of, real
from ..reading.text import Lines, text_of
from .entries import LABEL_BASE, Entries, by_position, check_full, filled_in, labels_of
from .nastran import Held, chosen

# Forms and types of matrices.
SQUARE, SYMMETRIC = 1, 6
REAL = (1, 2)
BEGINNING = re.compile(rb"^DMIG\*?[ ,]", re.IGNORECASE | re.MULTILINE)
LARGEST_NODE = 2**40


def is_dmig(head: bytes) -> bool:
    """Return whether a file with this beginning holds DMIG cards."""
    return BEGINNING.search(head) is not None


def held_in_dmig(path: str | os.PathLike[str]) -> list[Held]:
    """Return the matrices in a file."""
    forms: dict[str, tuple[int, int]] = {}
    filled = set[str]()
    with text_of(path) as file:
        for card in _cards(Lines(file)):
            name = card.fields[0].upper()
            if card.fields[1] == "0":
                forms[name] = card.integer(card.fields[2]), card.integer(card.fields[3])
            else:
                filled.add(name)
    return [
        Held(name, at, form in (SQUARE, SYMMETRIC), form == SYMMETRIC, kind in REAL, name not in filled)
        for at, (name, (form, kind)) in enumerate(forms.items())
    ]


def read_dmig(role: str, path: str | os.PathLike[str]) -> Entries:
    """Read the matrix of a file that is mass, stiffness or damping by its name."""
    matrix = chosen(role, held_in_dmig(path))
    rows, columns, values = array("q"), array("q"), array("d")
    with text_of(path) as file:
        for card in _cards(Lines(file)):
            if card.fields[0].upper() != matrix.name or card.fields[1] == "0":
                continue
            column = card.label(card.fields[1:3])
            for at in range(4, len(card.fields), 4):
                node, dof, value, imaginary = card.fields[at : at + 4]
                if not (node or dof or value):
                    continue
                if imaginary:
                    raise card.bad("hold real numbers", f"{value} and {imaginary}")
                rows.append(card.label([node, dof]))
                columns.append(column)
                values.append(card.number(value))
    i, j, keys = by_position(np.array(rows, dtype=np.int64), np.array(columns, dtype=np.int64))
    full = filled_in(i, j, np.array(values), keys.size, lambda k: tuple(labels_of(keys[[k]])[0].tolist()))
    if not matrix.is_symmetric:
        check_full(i, j, keys.size, f"as the form of {matrix.name} is square")
        return Entries(i, j, np.array(values), keys=keys)
    return Entries(*full, keys=keys)


@dataclass(frozen=True)
class _Card:
    """A card with the number of its first line: its fields from the name on, in fours."""

    line: int
    fields: list[str]

    def bad(self, wanted: str, got: str) -> ValueError:
        return ValueError(f"the card at line {self.line} must {wanted}, got {got[:60]!r}")

    def label(self, fields: list[str]) -> int:
        node, dof = (self.integer(field or "0") for field in fields)
        if not (0 < node < LARGEST_NODE and 0 <= dof <= 6):
            raise self.bad("name a node from 1 on and a degree of freedom from 0 to 6", ", ".join(fields))
        return node * LABEL_BASE + dof

    def integer(self, field: str) -> int:
        try:
            return int(field)
        except ValueError:
            raise self.bad("have a whole number", field) from None

    def number(self, field: str) -> float:
        try:
            return real(field)
        except ValueError:
            raise self.bad("have a number", field) from None


def _cards(lines: Lines) -> Iterator[_Card]:
    """Yield each DMIG card, with the fields of its continuation lines."""
    card: _Card | None = None
    for line in lines:
        text = line.partition("$")[0].rstrip()
        if not text:
            continue
        first, found = fields_of(text)
        if first.rstrip("*").upper() == "DMIG":
            if card is not None:
                yield card
            card = _Card(lines.number, found)
            if not (found[0] and found[1]):
                raise card.bad("be 'DMIG, name, node, dof, , node, dof, value'", text)
        elif card is not None and (not first or first[0] in "+*"):
            card.fields.extend(found)
        elif card is not None:
            yield card
            card = None
    if card is not None:
        yield card
