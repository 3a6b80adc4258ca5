"""A transient line on standard error during slow work, such as computing the modes of large bodies."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from ..long_tasks import notified_of_tasks


@contextmanager
def tasks_shown() -> Iterator[None]:
    """Show slow work on a line if standard error is a terminal and no progress bar shows it."""
    line: Any = None

    def tell(task: str | None, done: int, total: int) -> None:
        nonlocal line
        if task is None:
            line.stop()
            return
        # Imported here because most commands do no slow work.
        from rich.console import Console
        from rich.status import Status
        from rich.text import Text

        line = line or Status("", console=Console(stderr=True))
        line.update(Text(f"{task}: {done} of {total} ..." if total else f"{task} ..."))
        if line.console.is_terminal:
            line.start()

    try:
        with notified_of_tasks(tell):
            yield
    finally:
        if line is not None:
            line.stop()
