"""What the package does for long, such as finding the modes of large bodies, on a line that does not stay."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

# Told what is being done, and None when it is done.
Tell = Callable[[str | None], None]


class Doings(logging.Handler):
    """Hears of what takes long."""

    def __init__(self, tell: Tell) -> None:
        super().__init__(logging.INFO)
        self.tell = tell

    def emit(self, record: logging.LogRecord) -> None:
        """Tell of it."""
        if hasattr(record, "doing"):
            self.tell(record.doing)


@contextmanager
def told_of_doings(tell: Tell) -> Iterator[None]:
    """Tell of what takes long; whoever was told before is not meanwhile."""
    logger = logging.getLogger("stridula")
    level, handlers = logger.level, logger.handlers[:]
    logger.handlers[:] = [Doings(tell)]
    logger.setLevel(logging.INFO)
    try:
        yield
    finally:
        logger.setLevel(level)
        logger.handlers[:] = handlers


@contextmanager
def doings_shown() -> Iterator[None]:
    """Show what takes long where standard error is a terminal, and no bar says so."""
    line: Any = None

    def tell(doing: str | None) -> None:
        nonlocal line
        if doing is None:
            line.stop()
            return
        # Here, not above: most commands have nothing that takes long.
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
