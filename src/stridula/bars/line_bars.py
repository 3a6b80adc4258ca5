"""Bars on standard error, with the time left: in terminals, notebooks and logs."""

from __future__ import annotations

import sys
import time
from contextlib import AbstractContextManager
from types import TracebackType
from typing import Protocol

PREPARING = "preparing"
# Number of cells of a bar written as text, and shortest time between two updates [s].
CELLS, SELDOM = 20, 0.1
# Number of lines in a log for a whole computation.
STEPS = 10


class Bar(Protocol):
    """A progress bar.

    Attributes
    ----------
    changes : bool
        Whether its text changes, and is no line of a log.
    """

    changes: bool

    def say(self, words: str) -> None:
        """Show a text beside the bar."""

    def show(self, done: float, total: float, words: str, before: float = 0.0) -> None:
        """Show how much is done, with a text; the time left follows from the part done since `before`."""


class Show(Protocol):
    """Shows how much of a computation is done."""

    def __call__(self, done: float, total: float, words: str, before: float = 0.0) -> None:
        """Show the amount done, the total, both in words, and the amount done before the computation."""


def drawn_bar(title: str, asked: bool) -> AbstractContextManager[Bar]:
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
        self._title, self.changes = title, changes
        self._began, self._last, self._tenth, self._width = time.perf_counter(), 0.0, -1, 0
        self._share, self._words = 0.0, PREPARING

    def __enter__(self) -> LineBar:
        if self.changes:
            self._write()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self.changes:
            self._write()
            sys.stderr.write("\n")
            sys.stderr.flush()

    def say(self, words: str) -> None:
        """Show a text in place of the progress."""
        self._words = words
        if self.changes or words != PREPARING:
            self._write()

    def show(self, done: float, total: float, words: str, before: float = 0.0) -> None:
        """Show how much is done, with a text; the time left follows from the part done since `before`."""
        share = min(done / total, 1.0) if total > 0.0 else 0.0
        earlier = before / total if total > 0.0 else 0.0
        now, tenth = time.perf_counter(), int(STEPS * share + 1e-9)
        is_due = now - self._last >= SELDOM or share == 1.0 if self.changes else tenth > self._tenth
        self._share, self._words = share, f"{words}{self._left(share, earlier)}"
        if is_due:
            self._last, self._tenth = now, tenth
            self._write()

    def _left(self, share: float, earlier: float) -> str:
        """Return the time left in words, once it is known; an earlier share took no time here."""
        if not earlier < share < 1.0:
            return ""
        seconds = round((time.perf_counter() - self._began) * (1.0 - share) / (share - earlier))
        hours, minutes = divmod(seconds // 60, 60)
        return f", {hours}:{minutes:02}:{seconds % 60:02} left"

    def _write(self) -> None:
        filled = int(CELLS * self._share)
        line = f"{self._title} [{'#' * filled}{'.' * (CELLS - filled)}] {self._words}"
        # Spaces overwrite a longer line, which works everywhere.
        sys.stderr.write(f"\r{line:<{self._width}}" if self.changes else f"{line}\n")
        sys.stderr.flush()
        self._width = len(line)
