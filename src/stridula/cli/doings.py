"""A transient line on standard error during slow work, such as computing the modes of large bodies."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

# Called with the name of the work when it starts, and with None when it ends.
Tell = Callable[[str | None], None]


class Doings(logging.Handler):
    """Handler that passes on log records of slow work."""

    def __init__(self, tell: Tell) -> None:
        super().__init__(logging.INFO)
        self.tell = tell

    def emit(self, record: logging.LogRecord) -> None:
        """Pass on the name of the work."""
        if hasattr(record, "doing"):
            self.tell(record.doing)


@contextmanager
def told_of_doings(tell: Tell) -> Iterator[None]:
    """Pass log records of slow work to `tell`, in place of the previous handlers."""
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
