"""Cards of Nastran: small, large and free fields, and the numbers in them."""

from __future__ import annotations

import re

SMALL, LARGE = 8, 16
# A number may lack the letter of its exponent: 1.5-3.
BARE_EXPONENT = re.compile(r"([0-9.])([+-]\d+)$")


def fields_of(line: str) -> tuple[str, list[str]]:
    """Return the first field of a line and the four (large) or eight that follow, including empty ones."""
    if "," in line:
        first, *found = (word.strip() for word in line.split(","))
        count = 4 if "*" in first else 8
    else:
        text = line.expandtabs(SMALL)
        first = text[:SMALL].strip()
        count, width = (4, LARGE) if "*" in first else (8, SMALL)
        found = [text[at : at + width].strip() for at in range(SMALL, SMALL + count * width, width)]
    return first, (found + [""] * count)[:count]


def real(field: str) -> float:
    """Return a field as a number, or raise ValueError if it is not one."""
    try:
        return float(field)
    except ValueError:
        return float(BARE_EXPONENT.sub(r"\1e\2", field.upper().replace("D", "E")))
