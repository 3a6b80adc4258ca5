"""DMIG cards of Nastran: matrices by node and degree of freedom, as punch files have them."""

from __future__ import annotations

import os
import re
from array import array
from collections.abc import Iterator

import numpy as np

from .entries import LABEL_BASE, Entries, by_position, check_full, filled_in, labels_of
from .nastran import Held, chosen
from .nastran_cards import fields_of, real
from .text import Lines, text_of

# Forms and types of matrices.
SQUARE, SYMMETRIC = 1, 6
REAL = (1, 2)
BEGINNING = re.compile(rb"^DMIG\*?[ ,]", re.IGNORECASE | re.MULTILINE)
CARD = "a card 'DMIG, name, node, dof, , node, dof, value'"
LARGEST_NODE = 2**40


def is_dmig(head: bytes) -> bool:
    """Return whether a file that begins so holds such cards."""
    return BEGINNING.search(head) is not None


def held_in_dmig(path: str | os.PathLike[str]) -> list[Held]:
    """Return what matrices a file holds."""
    forms: dict[str, tuple[int, int]] = {}
    filled = set[str]()
    with text_of(path) as file:
        lines = Lines(file)
        for fields in _cards(lines):
            name = fields[0].upper()
            if fields[1] == "0":
                forms[name] = _integer(lines, fields[2]), _integer(lines, fields[3])
            else:
                filled.add(name)
    return [
        Held(name, at, form in (SQUARE, SYMMETRIC), form == SYMMETRIC, kind in REAL, name not in filled)
        for at, (name, (form, kind)) in enumerate(forms.items())
    ]


def read_dmig(role: str, path: str | os.PathLike[str]) -> Entries:
    """Read the matrix of a file whose name says that it is mass, stiffness or damping."""
    matrix = chosen(role, held_in_dmig(path))
    rows, columns, values = array("q"), array("q"), array("d")
    with text_of(path) as file:
        lines = Lines(file)
        for fields in _cards(lines):
            if fields[0].upper() != matrix.name or fields[1] == "0":
                continue
            column = _label(lines, fields[1:3])
            entries = fields[4:]
            for at in range(0, len(entries), 4):
                node, dof, value, *imaginary = entries[at : at + 4]
                if not (node or dof or value):
                    continue
                if any(imaginary):
                    raise lines.bad("of real numbers", ", ".join(entries[at : at + 4]))
                rows.append(_label(lines, [node, dof]))
                columns.append(column)
                values.append(_real(lines, value))
    i, j, keys = by_position(np.array(rows, dtype=np.int64), np.array(columns, dtype=np.int64))
    full = filled_in(i, j, np.array(values), keys.size, lambda k: tuple(labels_of(keys[[k]])[0].tolist()))
    if not matrix.is_symmetric:
        check_full(i, j, keys.size, f"as the form of {matrix.name} is square")
        return Entries(i, j, np.array(values), keys=keys)
    return Entries(*full, keys=keys)


def _cards(lines: Lines) -> Iterator[list[str]]:
    """Yield the fields of each DMIG card from its name on, with those of the lines that go on with it."""
    fields: list[str] = []
    for line in lines:
        text = line.partition("$")[0].rstrip()
        if not text:
            continue
        first, found = fields_of(text)
        if first.rstrip("*").upper() == "DMIG":
            if fields:
                yield fields
            if not (found[0] and found[1]):
                raise lines.bad(CARD, text)
            fields = found
        elif fields and (not first or first[0] in "+*"):
            fields += found
        elif fields:
            yield fields
            fields = []
    if fields:
        yield fields


def _label(lines: Lines, fields: list[str]) -> int:
    node, dof = (_integer(lines, field or "0") for field in fields)
    if not (0 < node < LARGEST_NODE and 0 <= dof <= 6):
        raise lines.bad("with a node from 1 on and a degree of freedom from 0 to 6", ", ".join(fields))
    return node * LABEL_BASE + dof


def _integer(lines: Lines, field: str) -> int:
    try:
        return int(field)
    except ValueError:
        raise lines.bad("with a whole number", field) from None


def _real(lines: Lines, field: str) -> float:
    try:
        return real(field)
    except ValueError:
        raise lines.bad("with a number", field) from None
