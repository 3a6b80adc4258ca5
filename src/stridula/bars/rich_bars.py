"""Progress bars of the package rich, which is used only here and in the command line."""

from __future__ import annotations

from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, Progress, Task, TextColumn, TimeRemainingColumn
from rich.text import Text


class TimeLeft(TimeRemainingColumn):
    """The time left, once it is known."""

    def render(self, task: Task) -> Text:
        """Return the time left in words."""
        known = task.total is not None and task.time_remaining is not None and not task.finished
        return super().render(task).append(" left") if known else Text("")


class RichBar:
    """A transient bar on standard error; nothing if that is not a terminal.

    Parameters
    ----------
    title : str
        Name of the computation.
    words : str
        Initial text beside it.
    """

    changes = True

    def __init__(self, title: str, words: str) -> None:
        self.console = Console(stderr=True)
        self._progress = Progress(
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            TextColumn("{task.fields[words]}", markup=False),
            TimeLeft(),
            console=self.console,
            transient=True,
            disable=not self.console.is_terminal,
        )
        self._task = self._progress.add_task(title, total=None, words=words)

    def __enter__(self) -> RichBar:
        self._progress.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self._progress.stop()

    def say(self, words: str) -> None:
        """Show a text beside the bar."""
        self._progress.update(self._task, words=words)

    def show(self, done: float, total: float, words: str, before: float = 0.0) -> None:
        """Show how much is done, with a text; the time left follows from the part done since `before`."""
        # The speed is measured between updates, so that work done before the first one does not count.
        self._progress.update(self._task, completed=done, total=total, words=words)
