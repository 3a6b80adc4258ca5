"""Bars of the command line: the words beside them, and the time left."""

from __future__ import annotations

import numba
import pytest
from rich.progress import Progress

from stridula.cli import bars


@pytest.fixture
def said(monkeypatch):
    """Return what is said beside a bar."""
    words: list[str] = []
    show = bars.Progress.update

    def update(self, *arguments, **fields):
        words.append(fields["words"])
        show(self, *arguments, **fields)

    monkeypatch.setattr(bars.Progress, "update", update)
    return words


def test_compiling_is_said_where_something_is_compiled(said, tmp_path, monkeypatch):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))

    def twice(number):
        return 2 * number

    with bars.bar("squeal") as show:
        numba.njit(cache=True)(twice)(1)
        assert said == [bars.COMPILING]
        numba.njit(cache=True)(twice)(1)
        show(1.0, 2.0, "half")
    assert said == [bars.COMPILING, "half"], "what is loaded from disk is not compiled"
    numba.njit(twice)(1)
    assert said == [bars.COMPILING, "half"], "nothing is said when the bar has gone"


def test_a_run_that_compiles_nothing_does_not_say_so(stridula, said):
    for _ in range(2):
        assert stridula("run", "squeal", "--duration", "2 ms")[0] == 0
    assert said[-1].startswith("0.002 of 0.002 s, ")
    assert said.count(bars.COMPILING) <= 1


def test_a_sensitivity_says_how_far_it_is(stridula, said):
    arguments = ("--vary", "friction=1:1.5", "--duration", "2 ms", "--samples", "32")
    assert stridula("sensitivity", "squeal", *arguments)[0] == 0
    points = [words for words in said if words != bars.COMPILING]
    assert len(points) == 2
    assert points[-1] == "96 of 96 points"


def test_the_time_left_is_shown_once_it_is_known():
    clock = iter(range(100))
    progress = Progress(get_time=lambda: float(next(clock)))
    task = progress.add_task("run", total=10.0)
    column = bars.TimeLeft()
    column.max_refresh = None
    assert column.render(progress.tasks[0]).plain == ""
    for done in (1.0, 2.0, 3.0):
        progress.update(task, completed=done)
    assert column.render(progress.tasks[0]).plain.endswith(" left")
    progress.update(task, completed=10.0)
    assert column.render(progress.tasks[0]).plain == ""
