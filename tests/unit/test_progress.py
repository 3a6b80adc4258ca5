"""Progress bars from Python: in terminals, notebooks and logs, with and without rich."""

from __future__ import annotations

import sys
from types import SimpleNamespace

import numpy as np
import pytest

import stridula as st
from stridula.integration import bars


def squeal() -> st.System:
    return st.load_scenario("squeal").system


def spread(points):
    """Return the distance of each point from 2."""
    return [{"miss of it": abs(point["x"] - 2.0)} for point in points]


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
    monkeypatch.setitem(sys.modules, "stridula.integration.rich_bars", None)
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
