"""Values of wrong inputs."""

from __future__ import annotations

import math
import random
from typing import Any

TINY, HUGE = 5e-324, 1.7e308
FLOATS = (0.0, -0.0, 1.0, -1.0, 0.5, 1e-3, 1e3, 1e6, 1e12, 1e-12, 1e30, 1e-30, 1e150, 1e300, 1e-300, TINY, HUGE)
NOT_FINITE = (math.inf, -math.inf, math.nan)
WHOLE = (0, 1, 2, -1, 3, 7, 100, 10**4, 10**6, 10**9, 10**18, -(10**18), 2**31, 2**63 - 1)
TEXTS = (
    "",
    "x",
    "tip",
    "root",
    "centre",
    "slider",
    "track",
    "coulomb",
    "beam",
    "45 deg",
    "2 cm/s",
    "15 kHz",
    "210 GPa",
)
ODD = (
    "1e999 m",
    "-1 m",
    "nan",
    "inf m",
    "5 kg",
    "1 m m",
    "%",
    "1 %",
    "0x10",
    "x" * 3000,
    "\0",
    "\u202e",
    "音",
    "a.b",
    "'",
)


def number(dice: random.Random) -> float | int:
    """Return a number, likely an unusual one."""
    draw = dice.random()
    if draw < 0.3:
        return dice.choice(FLOATS) * dice.choice((1, 1, 1, -1))
    if draw < 0.4:
        return dice.choice(NOT_FINITE)
    if draw < 0.6:
        return dice.choice(WHOLE)
    return dice.choice((1, 1, -1)) * 10.0 ** dice.uniform(-12, 12)


def plain(dice: random.Random, depth: int = 0) -> Any:
    """Return a value as in files: a number, a text, or a list or table of these."""
    draw = dice.random()
    if draw < 0.5 or depth > 3:
        return number(dice)
    if draw < 0.7:
        return dice.choice(TEXTS + ODD)
    if draw < 0.78:
        return dice.random() < 0.5
    if draw < 0.9:
        return [plain(dice, depth + 1) for _ in range(dice.choice((0, 1, 2, 3, 20)))]
    return {dice.choice(("x", "kind", "law", "coefficient", "shape", "音")): plain(dice, depth + 1) for _ in range(2)}


def flipped(dice: random.Random, content: bytes) -> bytes:
    """Return bytes with some cut off, flipped, left out or repeated."""
    draw, some = dice.random(), bytearray(content)
    if not some:
        return content
    if draw < 0.3:
        return content[: dice.randrange(len(content))]
    if draw < 0.75:
        for _ in range(dice.choice((1, 1, 2, 8, 64))):
            some[dice.randrange(len(some))] ^= 1 << dice.randrange(8)
    else:
        first = dice.randrange(len(some))
        last = min(len(some), first + dice.choice((1, 4, 64, 1000)))
        some[first:last] = some[first:last] * 2 if draw < 0.88 else b""
    return bytes(some)
