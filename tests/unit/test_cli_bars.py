"""Bars of the command line: their texts, and the time left."""

from __future__ import annotations

import dataclasses
import sys

import numba
import numpy as np
import pytest
from numba.core import event
from rich.progress import Progress

import stridula as st
from stridula.bars import rich_bars
from stridula.cli.long_tasks import tasks_shown
from stridula.integration import bars, compiled_code

STEEL = st.Material(2.1e11, 7800.0, 0.3)


@pytest.fixture
def said(monkeypatch):
    """Return the text beside a bar."""
    words: list[str] = []
    show = rich_bars.Progress.update

    def update(self, *arguments, **fields):
        words.append(fields["words"])
        show(self, *arguments, **fields)

    monkeypatch.setattr(rich_bars.Progress, "update", update)
    return words


def test_compiling_is_reported_when_it_happens(said, tmp_path, monkeypatch):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    monkeypatch.setenv("STRIDULA_CACHE_DIR", str(tmp_path / "kept"))

    def twice(number):
        return 2 * number

    compiling = f"{bars.COMPILING}a minute or two"
    with bars.bar("squeal") as show:
        numba.njit(cache=True)(twice)(1)
        assert said == [compiling]
        numba.njit(cache=True)(twice)(1)
        show(1.0, 2.0, "half")
    assert said == [compiling, "half"], "what is loaded from disk is not compiled"
    numba.njit(twice)(1)
    assert said == [compiling, "half"], "nothing is said when the bar has gone"


def test_the_time_of_compiling_is_that_of_last_time(said, tmp_path, monkeypatch):
    """Also where code is compiled for other code: its parts are not told apart."""
    monkeypatch.setenv("STRIDULA_CACHE_DIR", str(tmp_path))
    times = iter([10.0, 52.4, 60.0, 60.3, 70.0, 75.0])
    monkeypatch.setattr(compiled_code.clock, "perf_counter", lambda: next(times))

    def compiled():
        @numba.njit
        def inner(number):
            return 3 * number

        @numba.njit
        def outer(number):
            return inner(number) + 1

        assert outer(1) == 4

    with bars.bar("squeal"):
        for _ in range(3):
            compiled()
    assert said == [bars.COMPILING + time for time in ("a minute or two", "42 s last time", "a moment")]


def test_a_compilation_that_began_before_the_bar_has_no_time(said, tmp_path, monkeypatch):
    """One in another thread may be under way as a bar begins: its end is none of the bar's."""
    monkeypatch.setenv("STRIDULA_CACHE_DIR", str(tmp_path))
    with event.trigger_event("numba:compile", {"dispatcher": numba.njit(lambda: 1), "args": ()}):
        listening = bars.bar("squeal")
        listening.__enter__()
    listening.__exit__(None, None, None)
    assert said == []
    assert not list(tmp_path.iterdir())


def test_a_run_that_compiles_nothing_does_not_report_compiling(stridula, said):
    for _ in range(2):
        assert stridula("run", "squeal", "--duration", "2 ms")[0] == 0
    assert said[-1].startswith("0.002 of 0.002 s, ")
    assert sum(words.startswith(bars.COMPILING) for words in said) <= 1


def test_a_sensitivity_shows_its_progress(stridula, said):
    arguments = ("--vary", "friction=1:1.5", "--duration", "2 ms", "--samples", "32")
    assert stridula("sensitivity", "squeal", *arguments)[0] == 0
    points = [words for words in said if not words.startswith(bars.COMPILING)]
    assert len(points) == 2
    assert points[-1] == "96 of 96 points"


def test_the_time_left_is_shown_once_it_is_known():
    clock = iter(range(100))
    progress = Progress(get_time=lambda: float(next(clock)))
    task = progress.add_task("run", total=10.0)
    column = rich_bars.TimeLeft()
    column.max_refresh = None
    assert column.render(progress.tasks[0]).plain == ""
    for done in (1.0, 2.0, 3.0):
        progress.update(task, completed=done)
    assert column.render(progress.tasks[0]).plain.endswith(" left")
    progress.update(task, completed=10.0)
    assert column.render(progress.tasks[0]).plain == ""


@pytest.fixture
def block():
    """Return a body of 1245 degrees of freedom."""
    return st.SolidBody.block((0.1, 0.02, 0.03), (12, 2, 3), STEEL, cutoff=2000.0, fixed=["left"])


@pytest.mark.parametrize("name", ["pad", ""])
def test_the_search_for_the_modes_of_a_large_body_is_reported(block, caplog, name):
    body = dataclasses.replace(block, name=name, cutoff=2000.0 + len(name))
    with caplog.at_level("INFO", "stridula"):
        body.modes()
        body.modes()
    begin, end = caplog.records
    words = f"modes of {name or 'the solid body'} ({3 * len(body.mesh.nodes):,} degrees of freedom)".replace(",", " ")
    assert begin.getMessage() == f"{words} ..."
    assert begin.task == words
    assert end.getMessage().startswith(f"{words}: ")
    assert end.task is None


def test_other_large_bodies_also_report_it(caplog):
    count = 1100
    mass, stiffness = np.ones(count), 1e4 * np.arange(1.0, count + 1.0)
    with caplog.at_level("INFO", "stridula"):
        reduced = st.ReducedBody(
            np.diag(mass), np.diag(stiffness), points={"tip": np.eye(2, count)}, cutoff=50.0, name="chain"
        )
        profile = st.RectangleProfile({"disc": ((0.05, 0.15), (0.0, 0.01))})
        disc = st.AxisymmetricBody(profile, STEEL, cutoff=3000.0, name="disc")
        small = st.SolidBody.block((0.1, 0.02, 0.03), (2, 1, 1), STEEL, cutoff=9000.0)
        for body in (reduced, disc, small):
            body.modes()
    begun = [record.task for record in caplog.records if record.task]
    assert [words.split("(")[0] for words in begun] == ["modes of chain ", "modes of disc "]


def test_a_bar_reports_the_search_for_modes(said, block):
    with bars.bar("squeal"):
        dataclasses.replace(block, cutoff=2010.0).modes()
    assert [words.split("(")[0] for words in said] == ["modes of the solid body ", bars.PREPARING]
    dataclasses.replace(block, cutoff=2020.0).modes()
    assert len(said) == 2, "nothing is said when the bar has gone"


@pytest.mark.parametrize("is_terminal", [True, False])
def test_commands_without_a_bar_report_the_search_for_modes_and_leave_nothing(is_terminal, block, monkeypatch, capsys):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("TTY_COMPATIBLE", "1" if is_terminal else "0")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: is_terminal, raising=False)
    with tasks_shown():
        dataclasses.replace(block, cutoff=2030.0 + is_terminal).modes()
    shown = capsys.readouterr().err
    if is_terminal:
        assert "modes of the solid body" in shown
        assert shown.endswith("\x1b[2K"), "the line is erased"
    else:
        assert shown == ""
