"""Progress bars on standard error, with the time left."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from types import TracebackType
from typing import Protocol

from ..checks import instance
from ..long_tasks import notified_of_tasks
from .compiled_code import tell_of_compiling
from .watchers import Progress, Watcher

# Arguments: amount done, total, and both in words.
Show = Callable[[float, float, str], None]
PREPARING, COMPILING = "preparing", "compiling, only once: a minute or two"
# Cells of a bar written as text, and the least time between two updates [s].
CELLS, SELDOM = 20, 0.1
# Number of lines in a log for a whole computation.
STEPS = 10


class Bar(Protocol):
    """A progress bar."""

    def say(self, words: str) -> None:
        """Show a text beside the bar."""

    def show(self, done: float, total: float, words: str) -> None:
        """Show how much is done, with a text."""


@contextmanager
def bar(title: str, asked: bool = False) -> Iterator[Show]:
    """Show a bar, with a note while code is compiled or modes are computed.

    Parameters
    ----------
    title : str
        Name of the computation.
    asked : bool, optional
        Whether it is also shown if standard error is not a terminal: in notebooks as a line that changes, in logs as a
        line for each tenth.
    """
    with _bar(title, asked) as shown:

        def tell(task: str | None) -> None:
            shown.say(PREPARING if task is None else f"{task} ...")

        with notified_of_tasks(tell), tell_of_compiling(lambda: shown.say(COMPILING)):
            yield shown.show


@contextmanager
def time_shown(progress: bool, title: str) -> Iterator[list[Watcher]]:
    """Yield the watchers of a march that show a bar; none if `progress` is false."""
    instance("progress", progress, bool)
    if not progress:
        yield []
        return
    with bar(title, asked=True) as show:
        yield [told_of_time(show)]


def told_of_time(show: Show) -> Watcher:
    """Return a watcher that shows the simulated time and the speed relative to real time."""

    def watch(report: Progress) -> None:
        speed = report.time / max(report.wall_time, 1e-9)
        words = f"{report.time:.3f} of {report.duration:.3f} s, {speed:.2f} x real time"
        show(report.time, report.duration, words)

    return watch


def _bar(title: str, asked: bool) -> AbstractContextManager[Bar]:
    """Return the bar for the environment: that of rich in terminals, else a line of text."""
    is_notebook = _is_notebook()
    if not is_notebook:
        try:
            from .rich_bars import RichBar
        except ModuleNotFoundError:
            pass
        else:
            drawn = RichBar(title, PREPARING)
            if drawn.console.is_terminal or not asked:
                return drawn
    return LineBar(title, changes=is_notebook or sys.stderr.isatty())


def _is_notebook() -> bool:
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    return hasattr(shell, "kernel")


class LineBar:
    """A bar as text on standard error: a line that changes, or a line for each tenth.

    Parameters
    ----------
    title : str
        Name of the computation.
    changes : bool
        Whether lines can be overwritten.
    """

    def __init__(self, title: str, changes: bool) -> None:
        self._title, self._changes = title, changes
        self._began, self._last, self._tenth, self._width = time.perf_counter(), 0.0, -1, 0
        self._share, self._words = 0.0, PREPARING

    def __enter__(self) -> LineBar:
        if self._changes:
            self._write()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._changes:
            self._write()
            sys.stderr.write("\n")
            sys.stderr.flush()

    def say(self, words: str) -> None:
        """Show a text in place of the progress."""
        self._words = words
        if self._changes or words != PREPARING:
            self._write()

    def show(self, done: float, total: float, words: str) -> None:
        """Show how much is done, with a text."""
        share = min(done / total, 1.0) if total > 0.0 else 0.0
        now, tenth = time.perf_counter(), int(STEPS * share + 1e-9)
        is_due = now - self._last >= SELDOM or share == 1.0 if self._changes else tenth > self._tenth
        self._share, self._words = share, f"{words}{self._left(share)}"
        if is_due:
            self._last, self._tenth = now, tenth
            self._write()

    def _left(self, share: float) -> str:
        """Return the time left in words, once it is known."""
        if not 0.0 < share < 1.0:
            return ""
        seconds = round((time.perf_counter() - self._began) * (1.0 - share) / share)
        hours, minutes = divmod(seconds // 60, 60)
        return f", {hours}:{minutes:02}:{seconds % 60:02} left"

    def _write(self) -> None:
        filled = int(CELLS * self._share)
        line = f"{self._title} [{'#' * filled}{'.' * (CELLS - filled)}] {self._words}"
        # Spaces overwrite a longer line, which works everywhere.
        sys.stderr.write(f"\r{line:<{self._width}}" if self._changes else f"{line}\n")
        sys.stderr.flush()
        self._width = len(line)
