"""Long tasks, such as the search for the modes of large bodies: notification by the logger, and their early end."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

Result = TypeVar("Result")

# Called with the name of a task when it begins, and with None when it is done.
Tell = Callable[[str | None], None]
_GIVEN_UP: ContextVar[threading.Event | None] = ContextVar("given_up", default=None)


class GivenUp(Exception):
    """Nobody waits for the result of a long task any more."""


def until(given_up: threading.Event, function: Callable[..., Result], *words: object) -> Result:
    """Return the result of a function, or raise GivenUp soon after an event; for a thread of its own."""
    token = _GIVEN_UP.set(given_up)
    try:
        return function(*words)
    finally:
        _GIVEN_UP.reset(token)


def check_wanted() -> None:
    """Raise GivenUp if nobody waits for the result of the present task any more."""
    given_up = _GIVEN_UP.get()
    if given_up is not None and given_up.is_set():
        raise GivenUp


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
