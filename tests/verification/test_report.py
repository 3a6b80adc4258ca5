"""The framework: verdicts, files and exit codes, on cases made up for it."""

from __future__ import annotations

import functools
import json
import math
import os
import signal
import sys

import numpy as np
import pytest

import stridula as st
from stridula import verification
from stridula.cli import main
from stridula.verification.case import Case, Curve, Outcome, Row, Sketch, schemes
from stridula.verification.report import closing_line, verify


def outcome(obtained: float) -> Outcome:
    curves = [Curve(np.array([0.0, 1.0]), np.array([1.0, obtained]), "line")]
    row = Row("a | quantity", 1.0, obtained, 0.1, "first order: h", "m", "a scheme")
    return Outcome([row], Sketch("x", "y", curves), ["a note"])


def broken() -> Outcome:
    raise RuntimeError("the state is\nno longer finite")


def interrupted() -> Outcome:
    raise KeyboardInterrupt


GOOD = Case("fine", "A case that is met", "someone 1999", lambda: outcome(1.05))
SHORT = Case("short", "A case that falls short", "someone 2001", lambda: outcome(1.2))
BROKEN = Case("broken", "A case that breaks", "someone 2003", broken)
STOPPED = Case("stopped", "A case that is interrupted", "someone 2005", interrupted)


@pytest.fixture
def stridula(monkeypatch, capsys, tmp_path):
    """Run `stridula verify` on made-up cases in an empty folder; return exit code, output and error."""
    monkeypatch.chdir(tmp_path)

    def run(cases: list[Case], *arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(verification, "verify", functools.partial(verify, cases=cases))
        monkeypatch.setattr(sys, "argv", ["stridula", "verify", *arguments])
        with pytest.raises(SystemExit) as stop:
            main()
        captured = capsys.readouterr()
        return stop.value.code, captured.out, captured.err

    return run


@pytest.mark.parametrize(
    ("obtained", "holds"), [(1.0, True), (1.1 - 1e-12, True), (0.9 + 1e-12, True), (1.11, False), (math.nan, False)]
)
def test_a_row_holds_within_its_tolerance(obtained, holds):
    assert Row("q", 1.0, obtained, 0.1, "theory").holds is holds


def test_every_case_met_is_a_good_end(stridula, tmp_path):
    code, out, err = stridula([GOOD])
    assert code == 0
    assert "1 of 1 quantities within their tolerance" in out
    assert "someone 1999" in out
    assert err == "1 of 1: A case that is met\n"
    folder = tmp_path / "results" / "verify"
    assert sorted(path.name for path in folder.iterdir()) == ["fine.png", "verification.json", "verification.md"]
    assert (folder / "fine.png").read_bytes().startswith(b"\x89PNG")


def test_a_case_that_falls_short_is_reported_everywhere(stridula, tmp_path):
    code, out, err = stridula([GOOD, SHORT], "--out", "there")
    assert code == 1
    assert out.count("falls short") == 1
    assert err.splitlines()[-1] == (
        "stridula: 1 of 2 quantities within their tolerance; not: short: a | quantity a scheme"
    )
    rows = json.loads((tmp_path / "there" / "verification.json").read_text())
    assert [row["holds"] for row in rows] == [True, False]
    assert rows[1] == {
        "case": "short",
        "quantity": "a | quantity",
        "scheme": "a scheme",
        "expected": 1.0,
        "obtained": 1.2,
        "error": pytest.approx(0.2),
        "tolerance": 0.1,
        "reason": "first order: h",
        "units": "m",
        "holds": False,
        "source": "someone 2001",
    }
    page = (tmp_path / "there" / "verification.md").read_text()
    assert "| a \\| quantity | a scheme | 1 m | 1.2 m | 0.2 | 0.1 | **no** | first order: h |" in page
    assert "![A case that falls short](short.png)" in page
    assert "- a note" in page


def test_a_case_that_breaks_falls_short_and_the_others_run(stridula, tmp_path):
    code, _, err = stridula([BROKEN, GOOD], "--out", "there")
    assert code == 1
    assert "RuntimeError: the state is no longer finite" in err.splitlines()[-1]
    rows = json.loads((tmp_path / "there" / "verification.json").read_text())
    assert [(row["case"], row["obtained"], row["holds"]) for row in rows] == [
        ("broken", None, False),
        ("fine", 1.05, True),
    ]


def test_interrupted_it_leaves_no_table(stridula, tmp_path):
    code, out, err = stridula([GOOD, STOPPED], "--out", "there")
    assert (code, out) == (130, "")
    assert err.splitlines()[-1] == "stridula: interrupted; figures of the finished cases are in there"
    assert [path.name for path in (tmp_path / "there").iterdir()] == ["fine.png"]


class Interrupting(st.Constant):
    """A history that presses Ctrl-C when a run asks for it."""

    def factor(self, time):
        os.kill(os.getpid(), signal.SIGINT)
        return super().factor(time)


def test_ctrl_c_in_the_last_chunk_of_a_run_is_not_lost(stridula):
    """A run delays it until its chunk is done, and succeeds if that was the last: the rest must still stop."""

    def short_run() -> Outcome:
        body = st.PointMass(1.0)
        drives = [st.Force(body.centre, y=-1.0, history=Interrupting())]
        system = st.System(st.PointContact(body.centre, st.RigidTrack()), drives=drives)
        st.simulate(system, 1e-3, step=1e-5, sample_rate=1e5, probes=[])
        return outcome(1.0)

    assert stridula([Case("quick", "A case of one short run", "someone 2007", short_run), GOOD])[0] == 130
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_only_chooses_by_name_or_title(stridula, tmp_path):
    assert stridula([GOOD, SHORT], "--only", "MET")[0] == 0
    code, out, err = stridula([GOOD, SHORT], "--only", "nothing", "--out", "elsewhere")
    assert (code, out) == (2, "")
    assert err == "stridula: only must be part of the name or title of a case: fine, short, got 'nothing'\n"
    assert not (tmp_path / "elsewhere").exists()


def test_a_folder_that_cannot_be_made_is_named(stridula, tmp_path):
    (tmp_path / "file").write_text("")
    code, _, err = stridula([GOOD], "--out", "file/there")
    assert code == 2
    assert "'file/there'" in err


def test_names_of_cases_are_different_and_every_scheme_is_there():
    names = [case.name for case in verification.report.CASES]
    assert len(set(names)) == len(names)
    assert {scheme.name for scheme in schemes()} >= {"central difference", "exact modal"}


def test_closing_line_names_what_is_missed():
    rows = [{"case": "a", "quantity": "b", "scheme": "", "holds": False}]
    assert closing_line(rows) == "0 of 1 quantities within their tolerance; not: a: b"
