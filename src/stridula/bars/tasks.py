"""A bar for each long task of a computation."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

from ..checks import instance
from ..long_tasks import notified_of_tasks
from .line_bars import Bar, drawn_bar


@contextmanager
def show_progress(progress: bool = True) -> Iterator[None]:
    """Show a bar on standard error for each long task inside: searches for modes, fits of sound.

    Computations with ``progress=True`` have a bar of their own.

    Parameters
    ----------
    progress : bool, optional
        Whether it is shown.
    """
    instance("progress", progress, bool)
    if not progress:
        yield
        return
    with ExitStack() as open_bars:
        shown: Bar | None = None

        def tell(task: str | None, done: int, total: int) -> None:
            nonlocal shown
            if task is None:
                if shown is not None:
                    shown.show(1.0, 1.0, "done")
                open_bars.close()
                shown = None
            elif not total:
                open_bars.close()
                shown = open_bars.enter_context(drawn_bar(task, asked=True))
                shown.say("...")
            elif shown is not None and total:
                shown.show(done, total, f"{done} of {total}")

        with notified_of_tasks(tell):
            yield
