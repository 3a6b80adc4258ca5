"""Long tasks, such as the search for the modes of large bodies: notification by the logger, and their early end.

Messages have the logger "stridula": beginning and end of a task at INFO, how much of it is done at DEBUG.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from time import perf_counter
from typing import TypeVar

Result = TypeVar("Result")

LOGGER = logging.getLogger("stridula")
# A function that is called with the name of a task, the amount done and the total (0 if unknown), and with None when
# the task is done.
Tell = Callable[[str | None, int, int], None]
_PRESENT: ContextVar[str] = ContextVar("present", default="")
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


@contextmanager
def task_told(task: str) -> Iterator[None]:
    """Log the beginning and the end of a task.

    The first record describes it in ``task``, the last one has None.
    """
    LOGGER.info("%s ...", task, extra={"task": task})
    start, token = perf_counter(), _PRESENT.set(task)
    try:
        yield
    finally:
        _PRESENT.reset(token)
        LOGGER.info("%s: %.3g s", task, perf_counter() - start, extra={"task": None})


def tell_done(done: int, total: int) -> None:
    """Log how much of the present task is done; nothing outside of a task."""
    if task := _PRESENT.get():
        LOGGER.debug("%s: %d of %d", task, done, total, extra={"task": task, "done": done, "total": total})


class TaskHandler(logging.Handler):
    """Handler that passes on the names of long tasks."""

    def __init__(self, tell: Tell) -> None:
        super().__init__(logging.DEBUG)
        self.tell = tell

    def emit(self, record: logging.LogRecord) -> None:
        """Pass on the task of a record."""
        if hasattr(record, "task"):
            self.tell(record.task, getattr(record, "done", 0), getattr(record, "total", 0))


@contextmanager
def notified_of_tasks(tell: Tell) -> Iterator[None]:
    """Pass the names of long tasks, and how much is done, to a function; earlier handlers are suspended meanwhile."""
    level, handlers = LOGGER.level, LOGGER.handlers[:]
    LOGGER.handlers[:] = [TaskHandler(tell)]
    LOGGER.setLevel(logging.DEBUG)
    try:
        yield
    finally:
        LOGGER.setLevel(level)
        LOGGER.handlers[:] = handlers
