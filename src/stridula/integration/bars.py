"""Bars of computations on standard error, with notes on compilation and on searches for modes."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ..bars.line_bars import PREPARING, Show, drawn_bar
from ..checks import instance
from ..long_tasks import notified_of_tasks
from .compiled_code import tell_of_compiling
from .watchers import Progress, Watcher

COMPILING = "compiling, only once: "


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
    with drawn_bar(title, asked) as shown:

        def tell(task: str | None, done: int, total: int) -> None:
            if task is None:
                shown.say(PREPARING)
            elif not total:
                shown.say(f"{task} ...")
            elif shown.changes:
                shown.say(f"{task}: {done} of {total} ...")

        with notified_of_tasks(tell), tell_of_compiling(lambda time: shown.say(COMPILING + time)):
            yield shown.show


@contextmanager
def bar_if(wanted: bool, title: str) -> Iterator[Show]:
    """Show a bar, also where standard error is not a terminal, if it is wanted; else nothing.

    Parameters
    ----------
    wanted : bool
        Whether there is a bar.
    title : str
        Name of the computation.
    """
    if not wanted:
        yield lambda done, total, words, before=0.0: None
        return
    with bar(title, asked=True) as show:
        yield show


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
