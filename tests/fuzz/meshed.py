"""Shipped scenarios of meshed bodies that are wrong, as far as their tables: a mesh may be as large as memory is."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from stridula.scenarios.keys import overridden
from stridula.scenarios.load import _checked
from stridula.scenarios.read import read_tables
from stridula.scenarios.show import text_of

from .outcomes import folder, outcome
from .scenarios import Given, wrong


def inputs(seed: int, count: int) -> Iterator[Given]:
    """Return scenarios as the bytes of their files, and what is set by key."""
    return wrong("meshed", seed, count, is_meshed=True)


def check(given: Given) -> str:
    """Return what comes of a scenario."""
    content, overrides = given
    with folder():
        Path("case.toml").write_bytes(content)

        def run() -> None:
            tables, problems = overridden(read_tables("case.toml"), overrides)
            text_of(tables)
            _checked(tables, problems)

        return outcome(run)
