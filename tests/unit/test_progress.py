"""Progress bars from Python: in terminals, notebooks and logs, with and without rich."""

from __future__ import annotations

import os
import sys
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import stridula as st
from stridula.acoustics import fits
from stridula.acoustics.ring_sources import RingSources
from stridula.bars import line_bars
from stridula.integration import bars


def squeal() -> st.System:
    return st.load_scenario("squeal").system


def spread(points):
    """Return the distance of each point from 2."""
    return [{"miss of it": abs(point["x"] - 2.0)} for point in points]


STEEL, RING = st.Material(2.1e11, 7800.0, 0.3), st.RectangleProfile({"disc": ((0.05, 0.15), (0.0, 0.01))})
SHORT = {"duration": 2e-3, "sample_rate": 20e3}
ASKED = {
    "simulate": lambda **shown: st.simulate(squeal(), 2e-3, **shown),
    "simulate_many": lambda **shown: st.simulate_many([squeal()] * 2, 2e-3, workers=1, **shown),
    "sweep": lambda **shown: st.sweep("squeal", {"friction": [0.5, 1.0]}, "regime", **SHORT, **shown),
    "squeal_survey": lambda **shown: st.squeal_survey("squeal", {"friction": [0.0, 0.1]}, **SHORT, **shown),
    "ensemble": lambda **shown: st.ensemble(squeal(), 2e-3, {"zero": lambda run: 0.0}, runs=2, workers=1, **shown),
    "sensitivity": lambda **shown: st.sensitivity(
        "squeal", {"friction": (0.5, 1.0)}, "regime", samples=4, resamples=1, **SHORT, **shown
    ),
    "mode_sensitivity": lambda **shown: st.mode_sensitivity("squeal", ["friction", "slider.damping.rise"], **shown),
    "calibrate": lambda **shown: st.calibrate(
        spread, {"x": (0.0, 9.0)}, {"miss of it": (0.0, 1e-9)}, population=5, generations=4, **shown
    ),
}


@pytest.mark.parametrize("name", ASKED)
def test_progress_is_shown_when_requested(name, capsys):
    ASKED[name]()
    assert capsys.readouterr().err == ""
    ASKED[name](progress=True)
    lines = capsys.readouterr().err.splitlines()
    assert "[####################]" in lines[-1]
    assert all("[" in line for line in lines)
    with pytest.raises(ValueError, match="progress must be a bool"):
        ASKED[name](progress="yes")


def test_a_log_has_a_line_for_each_tenth(capsys):
    with bars.bar("squeal", asked=True) as show:
        for done in range(1001):
            show(done, 1000, f"{done} of 1000")
    lines = capsys.readouterr().err.splitlines()
    assert [line.split("] ")[1].split(",")[0] for line in lines] == [
        f"{k}00 of 1000" if k else "0 of 1000" for k in range(11)
    ]
    assert lines[5].startswith("squeal [##########..........] 500 of 1000, 0:00:0")
    assert lines[5].endswith(" left")
    assert "left" not in lines[-1]


def test_a_command_writes_nothing_to_a_log(capsys):
    with bars.bar("squeal") as show:
        show(1.0, 2.0, "half")
    assert capsys.readouterr().err == ""


def shown_in_one_line(capsys) -> list[str]:
    """Return the successive texts in the one line of a bar."""
    with bars.bar("squeal", asked=True) as show:
        show(1.0, 2.0, "half of it all")
        show(2.0, 2.0, "all")
    text = capsys.readouterr().err
    assert text.endswith("\n")
    assert text.count("\n") == 1
    assert "\x1b" not in text
    return text.rstrip("\n").split("\r")[1:]


def test_a_terminal_without_rich_has_a_line_that_changes(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "stridula.bars.rich_bars", None)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    lines = shown_in_one_line(capsys)
    assert lines[0] == f"squeal [{'.' * 20}] {bars.PREPARING}"
    assert lines[-1].rstrip() == f"squeal [{'#' * 20}] all"
    widths = np.array([len(line) for line in lines])
    assert (widths[1:] >= [len(line.rstrip()) for line in lines[:-1]]).all(), "the rest of a longer line stays"


def test_a_notebook_has_a_line_that_changes(monkeypatch, capsys):
    shell = SimpleNamespace(kernel=object())
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    assert shown_in_one_line(capsys)[-1].rstrip() == f"squeal [{'#' * 20}] all"


def test_a_terminal_has_the_bar_of_the_command_line(monkeypatch, capsys):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setenv("TTY_COMPATIBLE", "1")
    with bars.bar("squeal", asked=True) as show:
        show(1.0, 2.0, "half")
    shown = capsys.readouterr().err
    assert "\u2501" in shown
    assert shown.endswith("\x1b[2K"), "the line is erased"


def test_the_time_left_after_a_resume_counts_the_work_done_since(monkeypatch, capsys):
    now = [0.0]
    monkeypatch.setattr(line_bars.time, "perf_counter", lambda: now[0])
    shown = line_bars.LineBar("sweep", changes=True)
    lines = []
    for now[0], done in ((0.0, 90), (20.0, 95), (40.0, 100)):
        shown.show(done, 100, f"{done} of 100 points", before=90)
        lines.append(capsys.readouterr().err.split("] ")[-1].strip())
    assert lines[1:] == ["95 of 100 points, 0:00:20 left", "100 of 100 points"]
    assert "left" not in lines[0]


def test_a_resumed_sweep_tells_how_much_was_done_before(tmp_path):
    points = {"friction": np.linspace(0.5, 1.5, 65).tolist()}
    words = SHORT | {"out": tmp_path / "found.nc", "workers": 1}
    reached = []

    def stop(progress):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        st.sweep("squeal", points, "regime", watchers=[stop], **words)
    st.sweep("squeal", points, "regime", watchers=[reached.append], **words)
    assert [one.resumed for one in reached] == [reached[0].done] * len(reached)
    assert 0 < reached[0].resumed < 65 == reached[-1].done


# Long tasks: searches for modes, and sound.


def test_long_tasks_inside_have_a_bar_each(capsys):
    disc = st.AxisymmetricBody(
        st.RectangleProfile({"disc": ((0.05, 0.15), (0.0, 0.01))}),
        st.Material(2.1e11, 7800.0, 0.3),
        3010.0,
        name="disc",
    )
    pad = st.SolidBody.block((0.1, 0.02, 0.03), (12, 2, 3), st.Material(2.1e11, 7800.0, 0.3), cutoff=2040.0, name="pad")
    with st.show_progress():
        disc.modes()
        pad.modes()
    lines = capsys.readouterr().err.splitlines()
    of_disc = [line.split("] ")[1] for line in lines if line.startswith("modes of disc (")]
    assert of_disc[0] == "..."
    assert of_disc[1].startswith("0 of ")
    assert of_disc[-1] == "done"
    assert len(of_disc) > 3
    assert [line.split("] ")[1] for line in lines if line.startswith("modes of pad (")] == ["...", "done"]
    replace(pad, cutoff=2050.0).modes()
    with st.show_progress(False):
        replace(pad, cutoff=2060.0).modes()
    assert capsys.readouterr().err == ""
    with pytest.raises(ValueError, match="progress must be a bool"), st.show_progress("yes"):
        pass


@pytest.fixture
def rung():
    """Return a record of a disc in space that is hit, and its system."""
    disc = st.AxisymmetricBody(
        st.RectangleProfile({"disc": ((0.05, 0.15), (0.0, 0.01))}),
        st.Material(2.1e11, 7800.0, 0.3),
        1500.0,
        name="disc",
    )
    ball = st.RigidBody(0.01, 1e-6, {"tip": (0.0, 0.0, 0.0)}, name="ball")
    contact = st.PointContact(
        ball.at("tip"), disc.at((0.15, 0.0, 0.01)), normal=(0.0, 0.0, 1.0), stiffness=1e6, name="hit"
    )
    system = st.System(contact, [st.InitialVelocity(ball, z=-1.0)])
    return st.simulate(system, 2e-3, sample_rate=10e3), system


def test_sound_has_a_bar_and_keeps_what_is_done(rung, capsys, monkeypatch, tmp_path):
    monkeypatch.setenv("STRIDULA_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(fits, "WORTH", 0.0)
    fits.fits_of.cache_clear()
    fit, made = RingSources.fit, []

    def interrupted(self, wavenumber):
        made.append(wavenumber)
        if len(made) == 4:
            raise KeyboardInterrupt
        return fit(self, wavenumber)

    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    monkeypatch.setattr(RingSources, "fit", interrupted)
    with pytest.raises(KeyboardInterrupt):
        st.radiate(*rung, (0.0, 0.0, 1.0))
    assert capsys.readouterr().err == ""
    # Another process goes on from the cache.
    fits.fits_of.cache_clear()
    done, made[:] = made[:3], []
    monkeypatch.setattr(RingSources, "fit", lambda self, wavenumber: made.append(wavenumber) or fit(self, wavenumber))
    st.radiate(*rung, (0.0, 0.0, 1.0), progress=True)
    assert made
    assert not set(done) & set(made)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == f"sound of a body at {len(made)} frequencies [{'.' * 20}] ..."
    assert lines[-1].endswith(f"] {len(made)} of {len(made)}")
