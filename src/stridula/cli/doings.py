"""A transient line on standard error during slow work, such as computing the modes of large bodies."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ..doings import told_of_doings


@contextmanager
def doings_shown() -> Iterator[None]:
    """Show slow work on a line if standard error is a terminal and no progress bar shows it."""
    line: Any = None

    def tell(doing: str | None) -> None:
        nonlocal line
        if doing is None:
            line.stop()
            return
        # Imported here because most commands do no slow work.
        from rich.console import Console
        from rich.status import Status
        from rich.text import Text

        line = line or Status("", console=Console(stderr=True))
        line.update(Text(f"{doing} ..."))
        if line.console.is_terminal:
            line.start()

    try:
        with told_of_doings(tell):
            yield
    finally:
        if line is not None:
            line.stop()
