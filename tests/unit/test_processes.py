"""Parts of a sweep in other processes: the same to the last bit, also if processes end."""

from __future__ import annotations

import sys
import threading
import types

import numpy as np
import pytest
from unit.test_function_sources import squeal

import stridula as st
from stridula.studies import processes
from stridula.studies.measures import asked_for
from stridula.studies.points import laid_out
from stridula.studies.processes import Helper, Helpers, portable
from stridula.studies.sources import varying
from stridula.studies.task import Task, one_thread_each

# Longest wait for a process to begin [s].
PATIENCE = 120.0
POINTS = {"friction": np.linspace(0.2, 2.0, 12).tolist()}


def task_of(source="squeal", measures=("regime",), duration="20 ms"):
    """Return a task and the values of its points."""
    found = varying(source, {}, {"duration": duration}, laid_out(POINTS))
    return Task(found.source, asked_for(list(measures)), bool(isinstance(measures[-1], dict))), found.values


def printed(run):
    print("nothing that anyone asked for")
    return float(run["normal_force"].max())


@pytest.fixture
def helper_of():
    """Begin a process for a task; it is ended with the test."""
    begun = []

    def begin(task):
        ready = threading.Event()
        asked = portable(task)
        assert asked is not None
        begun.append(Helper(asked, lambda helper: ready.set()))
        assert ready.wait(PATIENCE)
        return begun[-1]

    yield begin
    for helper in begun:
        helper.end()


@pytest.mark.parametrize(
    ("source", "measures"), [("squeal", ("regime",)), (squeal, ("shares", {"peak": printed}))], ids=["case", "function"]
)
def test_another_process_gives_the_same_to_the_last_bit(helper_of, source, measures):
    task, points = task_of(source, measures)
    helper = helper_of(task)
    with one_thread_each():
        expected = task.outcomes(points)
    assert repr(helper.outcomes(points)) == repr(expected)
    assert repr(helper.outcomes(points[:4])) == repr(expected[:4]) or len(points) < 8


def test_a_lost_process_is_reported(helper_of):
    task, points = task_of(measures=("mean_force",))
    helper = helper_of(task)
    helper._process.kill()
    helper._process.wait()
    assert helper.outcomes(points) is None


def test_functions_that_cannot_be_imported_stay_in_threads(monkeypatch):
    assert portable(task_of()[0]) is not None
    assert portable(task_of(squeal)[0]) is not None
    assert portable(task_of(measures=({"peak": lambda run: 0.0},))[0]) is None
    monkeypatch.setattr(printed, "__module__", "__main__")
    monkeypatch.setattr("__main__.printed", printed, raising=False)
    assert portable(task_of(measures=({"peak": printed},))[0]) is None


def test_a_process_that_cannot_import_a_function_is_never_ready_and_says_nothing(monkeypatch, capfd):
    nowhere = types.ModuleType("nowhere")
    nowhere.printed = printed
    monkeypatch.setitem(sys.modules, "nowhere", nowhere)
    monkeypatch.setattr(printed, "__module__", "nowhere")
    seen = []
    helper = Helper(portable(task_of(measures=({"peak": printed},))[0]), seen.append)
    assert helper._process.wait(PATIENCE) == 1
    helper.end()
    assert seen == []
    assert capfd.readouterr().err == ""


def test_processes_begin_once_threads_wait_for_each_other(monkeypatch):
    """They replace the threads, with the same results; idle ones are ended with the sweep."""
    begun = []
    monkeypatch.setattr(processes, "Helper", lambda asked, ready: begun.append(Eager(ready)) or begun[-1])
    monkeypatch.setattr(processes, "COST", -1e9)
    monkeypatch.setattr("stridula.studies.sweeps.POINTS_OF_A_PART", 4)
    found = st.sweep("squeal", POINTS, "mean_force", duration="2 ms", workers=2)
    assert len(begun) == 1
    assert begun[0].ended
    monkeypatch.setattr(processes, "COST", 1e9)
    assert found.identical(st.sweep("squeal", POINTS, "mean_force", duration="2 ms", workers=2))
    assert len(begun) == 1


class Eager:
    """A process that is ready at once, and gone when it is used."""

    def __init__(self, ready):
        self.ended = False
        ready(self)

    def outcomes(self, points):
        return None

    def end(self):
        self.ended = True


def test_one_worker_needs_no_process():
    task, points = task_of(measures=("mean_force",))
    helpers = Helpers(task, 2, 1)
    assert helpers.outcomes(points, 1, lambda: None) == task.outcomes(points)
    assert helpers.decided
    helpers.close()


def test_threads_continue_if_no_process_can_start(monkeypatch):
    def fails(asked, ready):
        raise OSError("no more processes")

    monkeypatch.setattr(processes, "Helper", fails)
    monkeypatch.setattr(processes, "COST", -1e9)
    monkeypatch.setattr("stridula.studies.sweeps.POINTS_OF_A_PART", 4)
    found = st.sweep("squeal", POINTS, "mean_force", duration="2 ms", workers=2)
    assert set(found["message"].values.tolist()) == {""}
