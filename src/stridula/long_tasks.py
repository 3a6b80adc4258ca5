"""Notification of long tasks, such as the search for the modes of large bodies, through the package's logger."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager

# Called with the name of a task when it begins, and with None when it is done.
Tell = Callable[[str | None], None]


class TaskHandler(logging.Handler):
    """Handler that passes on the names of long tasks."""

    def __init__(self, tell: Tell) -> None:
        super().__init__(logging.INFO)
        self.tell = tell

    def emit(self, record: logging.LogRecord) -> None:
        """Pass on the task of a record."""
        if hasattr(record, "task"):
            self.tell(record.task)


@contextmanager
def notified_of_tasks(tell: Tell) -> Iterator[None]:
    """Pass the names of long tasks to a function; earlier handlers are suspended meanwhile."""
    logger = logging.getLogger("stridula")
    level, handlers = logger.level, logger.handlers[:]
    logger.handlers[:] = [TaskHandler(tell)]
    logger.setLevel(logging.INFO)
    try:
        yield
    finally:
        logger.setLevel(level)
        logger.handlers[:] = handlers
