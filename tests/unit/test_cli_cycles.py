"""`stridula cycle` and `stridula follow`."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import stridula as st

WEAKENING = """
[bodies.block]
kind = "point mass"
mass = 1

[[contacts]]
tip = { body = "block" }
track = { kind = "rigid", velocity = 1.0 }
friction = { law = "exponential weakening", static = 1.0, kinetic = 0.5, velocity = 0.5 }

[[connections]]
kind = "spring"
first = { body = "block" }
stiffness = 1

[[connections]]
kind = "dashpot"
first = { body = "block" }
coefficient = 0.1

[[drives]]
kind = "force"
body = "block"
y = -1

[simulation]
duration = 150
step = 0.05
sample_rate = 10
"""


@pytest.fixture
def weakening(tmp_path) -> str:
    (tmp_path / "weakening.toml").write_text(WEAKENING, encoding="utf-8")
    return "weakening.toml"


def test_cycle_prints_the_cycle_of_a_run_and_writes_it(stridula, weakening):
    code, out, _ = stridula("cycle", weakening, "--out", "cycle.nc", "--plot", "multipliers.png")
    assert code == 0
    period = float(re.search(r"period ([\d.]+) s", out)[1])
    assert period == pytest.approx(6.431383, rel=1e-4)
    assert "stable: neighbouring motions return" in out
    assert re.search(r"\d+ steps of Newton's method, \d+ periods marched", out)
    assert float(st.load("cycle.nc")["period"]) == pytest.approx(period, rel=1e-5)
    assert Path("multipliers.png").stat().st_size > 0
    # The cycle is a start, too.
    code, out, _ = stridula("cycle", weakening, "--from", "cycle.nc", "--set", "track.velocity=1.05")
    assert code == 0
    assert float(re.search(r"period ([\d.]+) s", out)[1]) < period


def test_cycle_begins_from_a_mode(stridula, weakening):
    code, out, _ = stridula("cycle", weakening, "--set", "track.velocity=1.2", "--amplitude", "450 mm")
    assert code == 0
    assert "unstable: neighbouring motions depart without turning back, by a factor of 1.062 in a period" in out


def test_no_cycle_is_said_in_one_line(stridula, weakening):
    words = ("--set", "track.velocity=3", "--set", "duration=1000", "--frequency", "0.159 Hz")
    code, out, err = stridula("cycle", weakening, *words)
    assert (code, out) == (1, "")
    assert "no cycle near the start: the motion dies away to rest or to steady sliding" in err.splitlines()[-1]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--from", "missing.nc"), "missing.nc"),
        (("--from", "weakening.toml"), "path must be a record that stridula wrote"),
        (("--amplitude", "1 s"), "--amplitude must be"),
        (("--frequency", "fast"), "--frequency must be"),
        (("--from", "run.nc", "--amplitude", "1 mm"), "--amplitude must be left out with --from"),
        (("--out", "cycle.csv"), "--out must"),
    ],
)
def test_wrong_options_are_refused(stridula, weakening, words, message):
    code, out, err = stridula("cycle", weakening, *words)
    assert (code, out) == (2, "")
    assert message in err.splitlines()[-1]


def test_follow_prints_the_ends_of_a_branch(stridula, weakening):
    options = ("--over", "track.velocity=0.9:1.2", "--at", "1.0", "--points", "30")
    code, out, _ = stridula("follow", weakening, *options, "--out", "branch.nc", "--plot", "branch.png")
    assert code == 0
    lines = out.splitlines()
    assert re.fullmatch(r"\d+ points from track.velocity = 0.9 to 1.2, \d+ of them stable", lines[0])
    assert lines[1:] == ["begins: end of the range", "ends: end of the range"]
    assert st.load("branch.nc").sizes["point"] > 5
    assert Path("branch.png").stat().st_size > 0


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--over", "track.velocity=1.2:0.9"), "--over must have START below STOP"),
        (("--over", "velocity"), "--over must be KEY=LOW:HIGH"),
        (("--over", "track.velocity=0.9:1.2:log"), "--over must be KEY=LOW:HIGH, got"),
        (("--over", "track.velocity=0.9:1.2", "--at", "2"), "value must be"),
        (("--over", "track.velocity=0.9:1.2", "--at", "1 mm"), "--at must be a number without a unit"),
    ],
)
def test_wrong_ranges_are_refused(stridula, weakening, words, message):
    code, _, err = stridula("follow", weakening, *words)
    assert code == 2
    assert message in err.splitlines()[-1]
