"""Progress bars on standard error, with the time left."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import BarColumn, Progress, Task, TextColumn, TimeRemainingColumn
from rich.text import Text

from ..integration.compiled_code import tell_of_compiling
from .doings import told_of_doings

# Amount done, total amount, and both as text.
Show = Callable[[float, float, str], None]
PREPARING, COMPILING = "preparing", "compiling, once: some ten seconds"


class TimeLeft(TimeRemainingColumn):
    """The time left, once it is known."""

    def render(self, task: Task) -> Text:
        """Return the time left as text."""
        known = task.total is not None and task.time_remaining is not None and not task.finished
        return super().render(task).append(" left") if known else Text("")


@contextmanager
def bar(title: str) -> Iterator[Show]:
    """Show a progress bar if standard error is a terminal, and name slow preparations such as compilation."""
    console = Console(stderr=True)
    progress = Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TextColumn("{task.fields[words]}", markup=False),
        TimeLeft(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )
    with progress:
        task = progress.add_task(title, total=None, words=PREPARING)

        def tell(doing: str | None) -> None:
            progress.update(task, words=PREPARING if doing is None else f"{doing} ...")

        with told_of_doings(tell), tell_of_compiling(lambda: progress.update(task, words=COMPILING)):
            yield lambda done, total, words: progress.update(task, completed=done, total=total, words=words)
