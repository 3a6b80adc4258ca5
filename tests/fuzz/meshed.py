"""Wrong scenarios of meshed bodies, checked without making meshes, which may be as large as the memory."""

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
    """Return scenarios as the bytes of their files, and overrides."""
    return wrong("meshed", seed, count, is_meshed=True)


def check(given: Given) -> str:
    """Return the outcome of a scenario."""
    content, overrides = given
    with folder():
        Path("case.toml").write_bytes(content)

        def run() -> None:
            tables, problems = overridden(read_tables("case.toml"), overrides)
            text_of(tables)
            _checked(tables, problems)

        return outcome(run)
