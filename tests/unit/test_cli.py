"""The command line: what it prints, what it writes, how it ends."""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
import tomllib

import numpy as np
import pytest
import scipy.io

import stridula as st
from stridula.cli import main, running

SHORT = ("--duration", "2 ms")


@pytest.fixture
def stridula(monkeypatch, capsys, tmp_path):
    """Run the command line in an empty folder; return exit code, output and error."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["stridula", *arguments])
        with pytest.raises(SystemExit) as stop:
            main()
        captured = capsys.readouterr()
        return stop.value.code, captured.out, captured.err

    return run


def test_version_and_help(stridula):
    assert stridula("--version") == (0, f"stridula {st.__version__}\n", "")
    code, out, err = stridula("--help")
    assert (code, err) == (0, "")
    assert all(verb in out for verb in ("list", "show", "schema", "run", "export", "compare", "paper", "verify"))
    assert stridula()[:1] == (0,)


def test_list_names_every_case_with_its_section(stridula):
    code, out, err = stridula("list")
    assert (code, err) == (0, "")
    assert [line.split()[0] for line in out.splitlines()] == [case.name for case in st.list_scenarios()]
    assert "section 3.2" in next(line for line in out.splitlines() if line.startswith("squeal "))


def test_show_prints_toml_and_schema_json(stridula):
    code, out, _ = stridula("show", "squeal")
    assert code == 0
    assert tomllib.loads(out)["contact"]["friction"]["coefficient"] == 1.5
    code, out, _ = stridula("schema")
    assert code == 0
    assert json.loads(out) == st.scenario_schema()


def test_a_run_leaves_garbage_collection_on(stridula):
    assert stridula("run", "squeal", *SHORT)[0] == 0
    assert gc.isenabled()


def test_run_writes_record_and_figure_and_says_what_came_of_it(stridula, tmp_path):
    code, out, err = stridula("run", "squeal", *SHORT, "--set", "friction=0.4", "--out", "run.nc", "--plot", "run.png")
    assert (code, err) == (0, "")
    words = ("finished at t = 0.002 s", "separated", "dominant frequency", "peak", "residual", "run.nc", "run.png")
    for word in (*words, "regime", "(confidence 0.50)"):
        assert word in out
    assert st.load_scenario("run.nc").system.contact.friction == st.Coulomb(0.4)
    assert (tmp_path / "run.png").read_bytes().startswith(b"\x89PNG")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run.nc", "run.png"]


def test_a_record_runs_again(stridula):
    assert stridula("run", "squeal", *SHORT, "--out", "one.nc")[0] == 0
    assert stridula("run", "one.nc", "--out", "two.nc")[0] == 0
    assert st.load("one.nc")["normal_force"].equals(st.load("two.nc")["normal_force"])


def test_a_tip_off_its_track_is_a_good_end(stridula):
    end = st.load_scenario("squeal").system.track.length - 1e-4
    pushed = ("--set", f"contact.at={end}", "--set", "friction=0", "--set", "drives.0.transverse=2000")
    code, out, err = stridula("run", "squeal", "--duration", "0.1", *pushed, "--out", "off.nc")
    assert (code, err) == (0, "")
    assert "ran off the end of its track" in out
    assert st.load("off.nc").attrs["ended"] == "off the track"


BAD = [
    (("run", "sqeal"), "did you mean 'squeal'?"),
    (("run", "none.toml"), "must be a file"),
    (("run", "."), "a directory"),
    (("run", "empty.toml"), "must not be empty"),
    (("run", "binary.toml"), "UTF-8"),
    (("run", "syntax.toml"), "line 2"),
    (("run", "nan.toml"), "contact.gap must be finite, got nan"),
    (("run", "squeal", "--set", "friction"), "--set must be KEY=VALUE, got 'friction'"),
    (("run", "squeal", "--set", "frction=1"), "did you mean 'friction'?"),
    (("run", "squeal", "--set", "elements=true"), "must be a whole number, got True"),
    (("run", "squeal", "--set", "contact.at=20"), "contact.at must be strictly between 0 and "),
    (("run", "squeal", "--set", "gap=-1"), "contact.gap must be 0 or above, got -1"),
    (("run", "squeal", "--set", "step=1e-3"), "simulation.step must be below"),
    (("run", "squeal", "--duration", "nan"), "simulation.duration must be finite, got nan"),
    (("run", "squeal", "--duration", "0"), "simulation.duration must be above 0, got 0"),
    (("run", "squeal", "--duration", "1e9"), "simulation.duration must give a record below"),
    (("run", "squeal", "--out", "none/run.nc"), "there is no folder 'none'"),
    (("run", "squeal", "--out", "."), "it is a directory"),
    (("run", "squeal", "--plot", "run.xyz"), "--plot must end in one of"),
    (("run", "squeal", "--out", "a.png", "--plot", "a.png"), "another file"),
    (("run", "squeal", "--nope"), "No such option"),
    (("run",), "Missing argument"),
    (("nope",), "No such command"),
    (("show", "sqeal"), "did you mean 'squeal'?"),
    (("export", "none.nc", "--out", "a.csv"), "cannot read 'none.nc'"),
    (("export", "nan.toml", "--out", "a.csv"), "path must be a record"),
    (("export", "nan.toml"), "Missing option"),
    (("compare", "none.nc", "none.nc"), "cannot read 'none.nc'"),
    (("compare", "nan.toml", "nan.toml"), "path must be a record"),
]


@pytest.mark.parametrize(
    ("arguments", "message"), BAD, ids=lambda value: " ".join(value) if value != str(value) else ""
)
def test_bad_input_is_one_line_and_writes_nothing(stridula, tmp_path, arguments, message):
    (tmp_path / "empty.toml").touch()
    (tmp_path / "binary.toml").write_bytes(b"\xff\x00\x81")
    (tmp_path / "syntax.toml").write_text("a = 1\nb = ]\n")
    (tmp_path / "nan.toml").write_text('base = "squeal"\n[contact]\ngap = nan\n')
    before = sorted(tmp_path.iterdir())
    keep = ("--out", "kept.nc") if arguments[0] == "run" and len(arguments) > 1 and "--out" not in arguments else ()
    code, out, err = stridula(*arguments, *keep)
    assert (code, out) == (2, "")
    assert err.startswith("stridula: ")
    assert err.count("\n") == 1
    assert message in err
    assert sorted(tmp_path.iterdir()) == before


def test_outputs_are_checked_before_the_run(stridula, monkeypatch):
    monkeypatch.setattr(st.Scenario, "simulate", lambda self, **kwargs: pytest.fail("it ran"))
    assert stridula("run", "squeal", "--out", "none/run.nc")[0] == 2
    assert stridula("run", "squeal", "--plot", "none/run.png")[0] == 2


PAD = """
title = "Pad on a belt"
[bodies.pad]
kind = "reduced"
file = "matrices/pad.npz"
[[contacts]]
tip = { body = "pad", point = "tip" }
track = { kind = "rigid", velocity = "20 cm/s" }
gap = "1 um"
friction = { law = "lugre", static = 0.5, kinetic = 0.3, velocity = "5 mm/s", stiffness = "100 1/mm", damping = 10.0 }
[[contacts]]
name = "heel"
tip = { body = "pad", point = "heel" }
track = { kind = "rigid" }
friction = 0.2
[[drives]]
kind = "force"
body = "pad"
point = "tip"
y = -50
[simulation]
duration = "2 ms"
"""


@pytest.fixture
def pad(tmp_path):
    """Write a scenario of a reduced body whose matrices lie in a folder beside it."""
    (tmp_path / "matrices").mkdir()
    stiffness = np.array([[4e5, -1e5, 0, 0], [-1e5, 4e5, 0, 0], [0, 0, 9e5, -2e5], [0, 0, -2e5, 9e5]])
    body = st.ReducedBody(np.eye(4) * 0.1, stiffness, {"tip": (0, 2), "heel": (1, 3)}, damping=st.Rayleigh(1.0, 1e-6))
    body.save(tmp_path / "matrices" / "pad.npz")
    (tmp_path / "pad.toml").write_text(PAD)


@pytest.mark.usefixtures("pad")
def test_a_reduced_body_on_two_contacts_runs_exports_and_compares(stridula, tmp_path):
    code, out, err = stridula("run", "pad.toml", "--out", "run.nc", "--plot", "run.png")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert sum("contact 1" in line for line in lines) == sum("heel" in line for line in lines) == 1
    assert out.count("(confidence ") == 2
    for path in (tmp_path / "matrices").iterdir():
        path.unlink()
    assert stridula("run", "run.nc", "--out", "again.nc")[0] == 0
    code, out, _ = stridula("compare", "run.nc", "again.nc", "--tolerance", "0")
    assert (code, "Within 0 everywhere" in out) == (0, True)
    assert stridula("run", "run.nc", "--set", "contacts.1.friction=0.3", "--out", "other.nc")[0] == 0
    code, out, _ = stridula("compare", "run.nc", "other.nc")
    assert code == 1
    assert "scenario.contacts.1.friction.coefficient" in out
    assert stridula("compare", "run.nc", "other.nc", "--tolerance", "1e9")[0] == 0
    for name in ("run.csv", "run.mat"):
        assert stridula("export", "run.nc", "--out", name) == (0, "", "")
    assert (tmp_path / "run.csv").read_text().count("\n") > 200
    assert scipy.io.loadmat("run.mat")["normal_force"].shape == (200, 2)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("pad.file=none.npz", "bodies.pad: cannot read 'none.npz': no such file"),
        ("pad.file=matrices", "bodies.pad.file must be a file, got 'matrices'"),
        ("contacts.0.tip.point=tipp", "contacts.0.tip.point must be one of tip, heel, got 'tipp'; did you mean 'tip'?"),
        ("contacts.1.tip.body=bad", "contacts.1.tip.body must be one of pad, got 'bad'; did you mean 'pad'?"),
        ("stiffness=12 N", "contacts.0.friction.stiffness must be a number in 1/m or 1/mm, got '12 N'"),
        ("contacts.0.friction.law=lugr", "exponential weakening, linear weakening, lugre, rate and state, got 'lugr'"),
    ],
)
@pytest.mark.usefixtures("pad")
def test_what_is_wrong_with_bodies_and_contacts_is_one_line(stridula, change, message):
    code, out, err = stridula("run", "pad.toml", "--set", change)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert message in err


def test_records_of_other_sampling_cannot_be_compared_and_bad_tables_not_written(stridula, tmp_path):
    for name, rate in (("a.nc", "100 kHz"), ("b.nc", "50 kHz")):
        assert stridula("run", "squeal", *SHORT, "--set", f"sample_rate={rate}", "--out", name)[0] == 0
    code, out, err = stridula("compare", "a.nc", "b.nc")
    assert (code, out) == (2, "")
    assert err == "stridula: b must have the sample interval of a, 1e-05 s, got 2e-05 s\n"
    before = sorted(tmp_path.iterdir())
    for name, message in (("a.txt", "path must end in .csv or .mat"), ("none/a.csv", "no folder"), (".", "must end")):
        code, out, err = stridula("export", "a.nc", "--out", name)
        assert (code, out, err.count("\n")) == (2, "", 1)
        assert message in err
    assert sorted(tmp_path.iterdir()) == before


def test_a_shorter_record_is_compared_over_what_both_have(stridula):
    assert stridula("run", "squeal", *SHORT, "--out", "a.nc")[0] == 0
    assert stridula("run", "squeal", "--duration", "3 ms", "--out", "b.nc")[0] == 0
    code, out, _ = stridula("compare", "a.nc", "b.nc")
    assert code == 0
    assert "Compared over the 200 samples that both have; a has 200, b has 300." in out


def test_a_constant_force_has_no_frequency(stridula):
    code, out, _ = stridula("run", "belt", "--duration", "4")
    assert code == 0
    assert "the normal force is constant" in out


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_full_disk_is_one_line_and_fails(stridula):
    code, out, err = stridula("run", "squeal", *SHORT, "--out", "/dev/full")
    assert (code, err) == (1, "stridula: cannot write '/dev/full': no space left on device\n")
    assert "finished" in out


def interrupt(*arguments, **fields):
    raise KeyboardInterrupt


def test_ctrl_c_keeps_what_was_recorded(stridula, monkeypatch):
    monkeypatch.setattr(running.Progress, "update", interrupt)
    code, out, err = stridula("run", "squeal", "--duration", "0.25", "--out", "part.nc")
    assert code == 130
    assert err.startswith("stridula: interrupted at t = ")
    assert "the record so far is in part.nc" in err
    assert err.count("\n") == 1
    assert "interrupted" in out
    part = st.load("part.nc")
    assert part.attrs["ended"] == "interrupted"
    assert 0 < part.sizes["time"] < 25_000


def test_ctrl_c_before_the_run_keeps_nothing(stridula, monkeypatch, tmp_path):
    monkeypatch.setattr(running, "load_scenario", interrupt)
    assert stridula("run", "squeal", "--out", "part.nc") == (130, "", "stridula: interrupted; nothing was kept\n")
    assert list(tmp_path.iterdir()) == []


def test_a_failed_run_is_one_line_and_keeps_its_record(stridula, monkeypatch):
    record = st.load_scenario("squeal", {"duration": "1 ms"}).simulate()
    record.attrs["ended"] = "not finite"

    def fail(self, **kwargs):
        raise st.Diverged(record, "contact sliding")

    monkeypatch.setattr(st.Scenario, "simulate", fail)
    code, out, err = stridula("run", "squeal", "--out", "part.nc")
    assert code == 1
    assert err.startswith("stridula: the state is no longer finite")
    assert err.count("\n") == 1
    assert "failed" in out
    assert st.load("part.nc").attrs["ended"] == "not finite"


@pytest.mark.parametrize("samples", [0, 1, 2, 100])
def test_a_failed_run_is_drawn_as_far_as_it_went(stridula, monkeypatch, tmp_path, samples):
    record = st.load_scenario("squeal", {"duration": "1 ms"}).simulate().isel(time=slice(samples))
    record.attrs["ended"] = "not finite"
    if samples > 2:
        for name in ("normal_force", "gap", "acceleration", "contact_height", "contact_position"):
            record[name][-1] = np.nan
            record[name][-2] = np.inf

    def fail(self, **kwargs):
        raise st.Diverged(record, "contact sliding")

    monkeypatch.setattr(st.Scenario, "simulate", fail)
    code, _, err = stridula("run", "squeal", "--plot", "part.png")
    assert (code, err.count("\n")) == (1, 1)
    assert (tmp_path / "part.png").exists() == (samples > 1)
    words = (
        "it is drawn in part.png" if samples > 1 else f"no figure was drawn: a figure takes two samples, got {samples}"
    )
    assert err.endswith(f"; nothing was asked to be kept (no --out); {words}\n")


def test_an_interrupted_run_says_that_nothing_was_drawn(stridula, monkeypatch, tmp_path):
    monkeypatch.setattr(running.Progress, "update", interrupt)
    code, _, err = stridula("run", "squeal", "--duration", "0.25", "--plot", "part.png")
    assert (code, err.endswith("; no figure was drawn\n")) == (130, True)
    assert list(tmp_path.iterdir()) == []


def test_the_closing_words_of_a_comparison_name_what_differs(stridula):
    run = st.load_scenario("belt", {"duration": "50 ms"}).simulate()
    other = run.copy(deep=True)
    other["normal_force"] *= 1.01
    other["gap"] += 1e-22
    st.save(run, "a.nc")
    st.save(other, "b.nc")
    code, out, _ = stridula("compare", "a.nc", "b.nc")
    assert code == 1
    assert out.rstrip().splitlines()[-1].startswith("Beyond 1e-06: normal_force by ")
    assert out.rstrip().endswith(" N, 0.01 relative.")
    other["tangential_force"] *= 1.001
    st.save(other, "b.nc")
    _, out, _ = stridula("compare", "a.nc", "b.nc")
    assert " ".join(out.split()).endswith(" N, 0.01 relative; 1 more is beyond it.")
    st.save(run.isel(time=slice(0, 0)), "empty.nc")
    for pair in (("a.nc", "empty.nc"), ("empty.nc", "a.nc")):
        word = "ab"[pair.index("empty.nc")]
        message = f"stridula: {word} must have samples to compare, got a record without any\n"
        assert stridula("compare", *pair) == (2, "", message)


@pytest.mark.parametrize("shell", ["{0} show squeal | head -1", "{0} list | head -1"])
def test_a_closed_pipe_is_quiet(shell):
    command = shell.format(f'"{sys.executable}" -c "from stridula.cli import main; main()"')
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, check=True)
    assert done.stdout.count("\n") == 1
    assert done.stderr == ""
