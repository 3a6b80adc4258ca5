"""Who hears what the package does for long, such as finding the modes of large bodies: records of its logger."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager

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
