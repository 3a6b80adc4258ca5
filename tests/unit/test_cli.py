"""The command line: output, files, exit codes."""

from __future__ import annotations

import errno
import gc
import json
import os
import re
import signal
import subprocess
import sys
import tomllib
import warnings

import numpy as np
import pytest
import scipy.io

import stridula as st
from stridula.analysis.doubts import doubts
from stridula.analysis.record_card import facts_of as card
from stridula.analysis.regimes import regime_of
from stridula.bars import rich_bars
from stridula.cli import running
from stridula.cli.running import how_to_get_the_level
from stridula.plot.colours import REGIME_COLOURS
from stridula.studies.measures import MEASURES, Column, Measure

SHORT = ("--duration", "2 ms")


def test_version_and_help(stridula):
    assert stridula("--version") == (0, f"stridula {st.__version__}\n", "")
    code, out, err = stridula("--help")
    assert (code, err) == (0, "")
    assert all(
        verb in out for verb in ("list", "show", "schema", "run", "sweep", "export", "compare", "paper", "verify")
    )
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


def test_a_scenario_and_the_schema_are_written_to_a_file(stridula, tmp_path):
    for words in (("show", "squeal"), ("schema",)):
        printed = stridula(*words)[1]
        assert stridula(*words, "--out", "text") == (0, "", "")
        assert (tmp_path / "text").read_bytes() == printed.encode()
    assert stridula("show", "squeal", "--out", "none/a.toml")[0] == 2


# Runs verbs in one process, with a zero after the output of each.
VERBS = """
import sys
from stridula.cli import main
for words in ("show squeal", "schema", "list"):
    sys.argv[1:] = words.split()
    try:
        main()
    except SystemExit as stop:
        assert not stop.code
    sys.stdout.flush()
    sys.stdout.buffer.write(bytes(1))
"""


@pytest.mark.parametrize("encoding", ["cp1252", "cp932", "ascii"])
def test_texts_do_not_depend_on_the_code_page(encoding):
    surroundings = os.environ | {"PYTHONIOENCODING": encoding}
    done = subprocess.run([sys.executable, "-c", VERBS], env=surroundings, capture_output=True, check=True)
    show, schema, listed, rest = done.stdout.split(bytes(1))
    assert show.decode() == st.scenario_text("squeal")
    assert json.loads(schema.decode()) == st.scenario_schema()
    assert listed
    assert not rest


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig"])
def test_scenarios_with_a_mark_of_their_encoding_are_read(encoding, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(st.scenario_text("squeal"), encoding=encoding)
    assert st.load_scenario(path).system == st.load_scenario("squeal").system


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"young": 210, "cutoff": 10.0}, "Young's modulus of 210 Pa; did you mean GPa?"),
        ({"density": 7.8}, "density of 7.8 kg/m3; did you mean g/cm3?"),
        ({"section.height": 8.624}, "8.624 m thick and "),
        ({"track.length": 1360.0}, "modes below its cutoff"),
        ({"track.length": 60.0}, "track: size of 60 m; did you mean mm?"),
    ],
)
def test_doubtful_values_are_named(changes, words):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", st.DoubtfulValue)
        system = st.load_scenario("squeal", changes).system
    assert any(words in line for line in doubts(system))


def test_shipped_scenarios_raise_no_doubts_and_the_card_shows_doubts(stridula):
    assert not any(doubts(st.load_scenario(case.name).system) for case in st.list_scenarios())
    assert "doubtful" not in stridula("run", "squeal", *SHORT)[1]
    out = stridula("run", "squeal", *SHORT, "--set", "density=7.8", "--set", "cutoff=5e3")[1]
    assert "did you mean g/cm3?" in out


def test_the_card_says_which_files_were_replaced(stridula):
    arguments = ("run", "squeal", *SHORT, "--out", "run.nc")
    assert "replaced" not in stridula(*arguments)[1]
    assert "run.nc, replaced" in stridula(*arguments, "--plot", "run.png")[1]
    assert "run.png, replaced" not in stridula(*arguments)[1]


def test_show_reports_doubts_beside_the_text(stridula, tmp_path):
    (tmp_path / "mine.toml").write_text('base = "squeal"\n[track.material]\ndensity = 7.8\n')
    code, out, err = stridula("show", "mine.toml")
    assert (code, tomllib.loads(out)["track"]["material"]["density"]) == (0, 7.8)
    assert err == "stridula: doubtful: track: density of 7.8 kg/m3; did you mean g/cm3?\n"
    assert stridula("show", "mine.toml", "--out", "whole.toml") == (0, "", err)
    # A scenario that cannot run can be shown.
    (tmp_path / "mine.toml").write_text('base = "squeal"\n[track]\nlength = -1\n')
    assert stridula("show", "mine.toml")[::2] == (0, "")


def test_every_command_names_doubtful_values_once_in_a_line(stridula):
    code, _, err = stridula("stability", "squeal", "--set", "density=7.8", "--set", "cutoff=5e3")
    assert (code, err) == (0, "stridula: doubtful: density of 7.8 kg/m3; did you mean g/cm3?\n")
    assert stridula("run", "squeal", *SHORT, "--set", "density=7.8", "--set", "cutoff=5e3")[2].count("doubtful") == 0


def test_a_run_leaves_garbage_collection_on(stridula):
    assert stridula("run", "squeal", *SHORT)[0] == 0
    assert gc.isenabled()


def test_run_checks_its_step(stridula):
    """With half the step in the words."""
    code, out, err = stridula("run", "squeal", *SHORT, "--check-step")
    assert (code, err) == (0, "")
    assert "at half the step, 2.5e-06 s: " in out
    assert "the step is fine enough for these results" in out


def test_run_writes_record_and_figure_and_reports_the_result(stridula, tmp_path):
    code, out, err = stridula("run", "squeal", *SHORT, "--set", "friction=0.4", "--out", "run.nc", "--plot", "run.png")
    assert (code, err) == (0, "")
    words = (
        "simulated",
        "0.002 s",
        "computed in",
        "separated",
        "dominant frequency",
        "normal force",
        "residual",
        "run.nc",
        "run.png",
    )
    for word in (*words, "squeals", "(confidence 0.50)", "`stridula sound run.nc` prints it at 1 m"):
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
    (("run", "squeal", "--out", "a.csv"), "--out must be a NetCDF file, .nc, got 'a.csv'"),
    (("run", "squeal", "--out", "a.PNG"), "--out must be a NetCDF file, .nc, got 'a.PNG'"),
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
    (("run", "squeal", "--out", "a.png", "--plot", "a.png"), "must differ from --out"),
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
    (tmp_path / "binary.toml").write_bytes(b"\xff\x00\x80")
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


def test_the_card_of_the_violin_has_its_motion(stridula):
    code, out, _ = stridula("run", "violin")
    assert code == 0
    lines = " ".join(out.replace("│", " ").split())
    assert "squeals no, stick-slip (confidence" in lines
    assert "pitch 195" in lines
    assert "bowed string Helmholtz at 195" in lines
    assert "slips in a period of 196 Hz" in lines


@pytest.mark.usefixtures("pad")
def test_a_reduced_body_on_two_contacts_runs_exports_and_compares(stridula, tmp_path):
    code, out, err = stridula("run", "pad.toml", "--out", "run.nc", "--plot", "run.png")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert sum("contact 1" in line for line in lines) == sum("heel" in line for line in lines) == 1
    # Both together, and each.
    assert out.count("(confidence ") == 3
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
        (
            "contacts.0.friction.law=lugr",
            ", lugre, rate and state, tabulated, over temperature, along track, around track, got 'lugr'; did you mean "
            "'lugre'?",
        ),
    ],
)
@pytest.mark.usefixtures("pad")
def test_errors_of_bodies_and_contacts_are_one_line(stridula, change, message):
    code, out, err = stridula("run", "pad.toml", "--set", change)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert message in err


def test_records_of_other_sampling_cannot_be_compared_and_bad_tables_not_written(stridula, tmp_path):
    for name, rate in (("a.nc", "100 kHz"), ("b.nc", "50 kHz")):
        assert stridula("run", "squeal", *SHORT, "--set", f"sample_rate={rate}", "--out", name)[0] == 0
    code, out, err = stridula("compare", "a.nc", "b.nc")
    assert (code, out) == (2, "")
    assert err == "stridula: b must have the same sample interval as a, 1e-05 s, got 2e-05 s\n"
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
    assert "simulated" in out


def interrupt(*arguments, **fields):
    raise KeyboardInterrupt


def terminate(*arguments, **fields):
    signal.raise_signal(signal.SIGTERM)


@pytest.mark.parametrize("stop", [interrupt, terminate])
def test_ctrl_c_and_sigterm_keep_what_was_recorded(stridula, monkeypatch, stop):
    monkeypatch.setattr(rich_bars.RichBar, "show", stop)
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
        "it is drawn in part.png" if samples > 1 else f"no figure was drawn: a figure needs two samples, got {samples}"
    )
    assert err.endswith(f"; nothing was kept (no --out); {words}\n")


def test_an_interrupted_run_reports_that_nothing_was_drawn(stridula, monkeypatch, tmp_path):
    monkeypatch.setattr(rich_bars.RichBar, "show", interrupt)
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


SWEEP = ("sweep", "squeal", *SHORT, "--measure", "mean_force", "--out", "map.nc")


def test_sweep_writes_a_map_and_prints_the_number_of_points_done(stridula, tmp_path):
    grid = ("--vary", "friction=0.2:2.0:3", "--vary", "angle=20deg:80 deg:2")
    code, out, err = stridula(*SWEEP, *grid, "--measure", "shares", "--set", "transverse=3")
    assert (code, out, err) == (0, "6 points: 6 done; written to map.nc\n", "")
    found = st.load("map.nc")
    assert dict(found.sizes) == {"friction": 3, "angle": 2}
    assert found["angle"].values.tolist() == [20.0, 80.0]
    assert {"mean_force", "sliding_share"} <= set(found)
    before = (tmp_path / "map.nc").read_bytes()
    assert stridula(*SWEEP, *grid, "--measure", "shares", "--set", "transverse=3")[:2] == (code, out)
    assert (tmp_path / "map.nc").read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["map.nc"]


def test_the_card_distinguishes_compiling_from_marching():
    record = st.load_scenario("squeal", {"duration": "2 ms"}).simulate()
    record.attrs |= {"wall_time": 0.5, "compile_time": 0.0}
    assert card(record)["computed in"] == "0.5 s, 0.00 x real time"
    for time, words in ((1.234, "1.2 s"), (14.21, "14 s"), (104.2, "104 s")):
        record.attrs["compile_time"] = time
        assert card(record)["computed in"] == f"0.5 s, 0.00 x real time, after {words} of compiling"
    del record.attrs["compile_time"]
    assert card(record)["computed in"] == "0.5 s, 0.00 x real time"


def test_the_card_begins_with_the_audible_tone():
    """The pitch in the bursts, near the paper's 900 Hz; the tone of the landings and others, no partials, later."""
    record = st.load_scenario("squeal").simulate()
    rows = card(record)
    assert list(rows)[:5] == ["squeals", "pitch", "sound level", "normal force", "other tones"]
    pitch, *others = (float(word) for word in re.findall(r"([\d.]+) Hz", rows["pitch"] + rows["other tones"]))
    assert 840.0 < pitch < 900.0
    assert 300.0 < others[0] < 340.0
    assert all(abs(other / pitch - round(other / pitch)) > 0.02 * other / pitch for other in others[1:])
    assert rows["other tones"].endswith(" in the bursts")
    assert sum(str(words).count(rows["pitch"]) for words in rows.values()) == 1
    found = st.regime(record)
    assert rows["squeals"] == f"yes (confidence {float(found.confidence):.2f})"
    assert rows["pitch"] == f"{float(found.frequency):.4g} Hz"
    assert rows["normal force"].startswith(f"mean {float(record.normal_force.mean()):.4g} N, fluctuation ")
    assert (rows["simulated"], "ended" in rows) == ("1 s", False)


@pytest.mark.parametrize(
    ("regime", "frequency", "answer", "pitch"),
    [
        ("squeal", 896.04, "yes", "896 Hz"),
        ("squeal", 1e5, "yes", "100000 Hz or more"),
        ("stick-slip", 0.2733, "no, stick-slip", "0.2733 Hz"),
        ("judder", 329.68, "no, judder", "loudest at 329.7 Hz"),
        ("stable sliding", np.nan, "no, stable sliding", None),
    ],
)
def test_the_card_says_at_which_frequency(monkeypatch, regime, frequency, answer, pitch):
    record = st.load_scenario("squeal", {"duration": "2 ms"}).simulate()
    found = regime_of(record) | {"regime": regime, "frequency": frequency, "confidence": 1.0}
    monkeypatch.setattr("stridula.analysis.record_card.regime_of", lambda run: found)
    rows = card(record)
    assert (rows["squeals"], rows.get("pitch")) == (f"{answer} (confidence 1.00)", pitch)


def test_the_card_says_how_to_get_the_level():
    squeal = st.load_scenario("squeal", {"duration": "2 ms"})
    record, belt = squeal.simulate(), st.load_scenario("belt")
    assert how_to_get_the_level(record, squeal, "a.nc") == "not computed: `stridula sound a.nc` prints it at 1 m"
    assert how_to_get_the_level(record, squeal, None) == "not computed: --wav FILE.wav computes it at 1 m"
    assert how_to_get_the_level(record, belt, None) == "none: no body of the system radiates sound"
    assert how_to_get_the_level(record.assign_attrs(ended="energy created"), squeal, None) == ""


def test_the_card_names_an_early_end_first_and_a_later_start():
    scenario = st.load_scenario("belt", {"duration": "50 ms"})
    first = scenario.simulate()
    rows = card(scenario.simulate(start=first))
    assert rows["simulated"] == "0.05 s, from t = 0.05 s to 0.1 s"
    first.attrs |= {"ended": "energy created", "modes": 1}
    rows = card(first)
    assert next(iter(rows.items())) == ("ended", "failed: energy was created without a source at t = 0.05 s")
    assert rows["step"].endswith(", 1 mode")
    assert rows["normal force"] == "10 N, constant"


def test_points_of_a_sweep_that_fail_are_counted(stridula):
    code, out, err = stridula(*SWEEP, "--vary", "angle=80:95 deg:4")
    assert (code, err) == (0, "")
    said, counted = out.splitlines()
    assert said == "2 of 2 failures: slider.angle must be strictly between -pi/2 and pi/2 rad (90 deg)"
    assert counted == "4 points: 2 done, 2 failed (messages in 'message' of map.nc)"
    assert st.load("map.nc")["angle"].values.tolist() == [80.0, 85.0, 90.0, 95.0]


def test_a_failure_common_to_all_points_is_reported_once(stridula):
    code, out, err = stridula(*SWEEP, "--vary", "friction=0.2:2.0:3", "--set", "sample_rate=10 Hz")
    assert (code, err) == (0, "")
    assert out.startswith("3 of 3 failures: duration must be at least half a sample interval of 0.1 s, got 0.0")
    assert out.endswith("\n3 points: 0 done, 3 failed (messages in 'message' of map.nc)\n")
    assert out.count("\n") == 2


def test_sweeps_of_samples_lists_and_tables(stridula, tmp_path):
    ranges = ("--vary", "friction=0.2:2", "--vary", "angle=10:80 deg")
    assert stridula(*SWEEP, *ranges, "--sample", "5", "--seed", "2")[0] == 0
    assert st.load("map.nc").sizes == {"point": 5}
    (tmp_path / "map.nc").unlink()
    assert stridula(*SWEEP, "--vary", "root_support=guided, clamped", "--vary", "elements=4:8:3")[0] == 0
    found = st.load("map.nc")
    assert found["root_support"].values.tolist() == ["guided", "clamped"]
    assert found["elements"].values.tolist() == [4, 6, 8]
    (tmp_path / "map.nc").unlink()
    (tmp_path / "points.csv").write_text("friction,angle\n0.3,10 deg\n\n0.4,20 deg\n")
    assert stridula(*SWEEP, "--points", "points.csv")[0] == 0
    found = st.load("map.nc")
    assert (found["friction"].values.tolist(), found["angle"].values.tolist()) == ([0.3, 0.4], [10.0, 20.0])


VARY = ("--vary", "friction=0.2:2:3")
BAD_SWEEPS = [
    (("--vary", "frction=1:2:3"), "did you mean 'friction'?"),
    (("--vary", "length=1:2:3"), "key must name one place"),
    ((*VARY, *VARY), "--vary must name each key once, got 'friction' twice"),
    ((*VARY, "--vary", "coefficient=1:2:3"), "which both mean contact.friction.coefficient"),
    ((*VARY, "--set", "coefficient=1"), "key must be set or varied, got both 'coefficient' and 'friction'"),
    (("--vary", "friction=1:2:0"), "--vary must have a COUNT of at least 1"),
    (("--vary", "friction=2:1:3"), "--vary must have START below STOP"),
    (("--vary", "friction=1:1:3"), "--vary must have START below STOP"),
    (("--vary", "friction=1:2:3.5"), "--vary must have a whole number for COUNT"),
    (("--vary", "friction=1:inf:3"), "--vary must have finite numbers"),
    (("--vary", "friction=nan:2:3"), "--vary must have finite numbers"),
    (("--vary", "friction=a:b:3"), "--vary must have numbers for START and STOP"),
    (("--vary", "friction=1:2"), "--vary must be KEY=START:STOP:COUNT, got"),
    (("--vary", "friction"), "--vary must be KEY=START:STOP:COUNT or KEY=A,B,C"),
    (("--vary", "root_support=guided,,free"), "--vary must have a value between commas"),
    (("--vary", "root_support=guidd"), "did you mean 'guided'?"),
    (("--vary", "angle=1 N:2 N:3"), "slider.angle must be a number in rad or deg, got '1.0 N'"),
    (("--vary", "angle=1 deg:2:3"), "--vary must have one unit for both ends"),
    (("--vary", "elements=1:2:3"), "slider.elements must be a whole number, got 1.5"),
    (("--vary", "friction=0:1:10001"), "more than 10000 points must be confirmed with --yes, got 10001 points"),
    (("--vary", "friction=0:1:1000000000", "--vary", "angle=0:1:1000"), "got 1000000000000 points"),
    ((*VARY, "--measure", "regim"), "did you mean 'regime'?"),
    ((*VARY, "--sample", "3"), "--vary must be KEY=START:STOP with --sample"),
    (("--vary", "friction=1,2", "--sample", "3"), "got a list for 'friction'"),
    (("--vary", "friction=1:2", "--sample", "0"), "count must be at least 1"),
    ((*VARY, "--seed", "3"), "--seed must be used with --sample"),
    ((), "points must be given by --vary or by --points, got neither"),
    ((*VARY, "--points", "good.csv"), "points must be given by --vary or by --points, got both"),
    (("--points", "none.csv"), "cannot read 'none.csv'"),
    (("--points", "ragged.csv"), "--points must have a value for each of friction, angle, got ['0.3'] in line 3"),
    (("--points", "header.csv"), "--points must hold a row of keys and at least one of values"),
    (("--points", "twice.csv"), "--points must name each key once"),
    ((*VARY, "--plot", "map.xyz"), "--plot must end in one of"),
    ((*VARY, "--plot", "map.png"), "--plot must be used with a grid of two keys"),
    ((*VARY, "--vary", "angle=0:1:2", "--plot", "map.png"), "--plot must be used with --measure regime"),
    ((*VARY, "--workers", "0"), "workers must be at least 1"),
    ((*VARY, "--out", "folder"), "it is a directory"),
    ((*VARY, "--out", "none/map.nc"), "there is no folder 'none'"),
    ((*VARY, "--out", "good.csv"), "--out must be a NetCDF file, .nc, got 'good.csv'"),
    ((*VARY, "--out", "text.nc"), "out must be a new file or that of this sweep, got 'text.nc', another file"),
    ((*VARY, "--out", "other.nc"), "got 'other.nc', of another scenario and other points or options"),
    ((*VARY, "--scheduler", "nonsense://x"), "scheduler must answer, got 'nonsense://x'"),
]


@pytest.fixture(scope="module")
def other_sweep(tmp_path_factory):
    path = tmp_path_factory.mktemp("other") / "other.nc"
    st.sweep("squeal", [{"friction": 0.3}], "mean_force", duration="1 ms", out=path)
    return path.read_bytes()


@pytest.mark.parametrize(("arguments", "message"), BAD_SWEEPS, ids=[message for _, message in BAD_SWEEPS])
def test_a_bad_sweep_is_one_line_and_writes_nothing(stridula, tmp_path, monkeypatch, other_sweep, arguments, message):
    (tmp_path / "folder").mkdir()
    (tmp_path / "other.nc").write_bytes(other_sweep)
    tables = {"good": "friction\n0.3\n", "ragged": "friction,angle\n0.3,1\n0.3\n", "header": "friction\n"}
    for name, text in {**tables, "twice": "friction,friction\n1,2\n"}.items():
        (tmp_path / f"{name}.csv").write_text(text)
    (tmp_path / "text.nc").write_text("no record")
    monkeypatch.setattr("stridula.studies.task.simulate_many", lambda *args, **kwargs: pytest.fail("it ran"))
    before = {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()}
    code, out, err = stridula(*SWEEP, *arguments)
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert message in err
    assert {path: path.read_bytes() for path in tmp_path.rglob("*") if path.is_file()} == before
    assert not (tmp_path / "map.nc.parts").exists()


@pytest.mark.parametrize("option", ["--out", "--measure"])
def test_a_sweep_needs_a_file_and_a_measure(stridula, option):
    given = {"--out": "map.nc", "--measure": "travel"}
    rest = [word for pair in given.items() if pair[0] != option for word in pair]
    code, out, err = stridula("sweep", "squeal", *VARY, *rest)
    assert (code, out, err) == (2, "", f"stridula: Missing option '{option}'.\n")


def test_ctrl_c_in_a_sweep_reports_saved_parts_and_the_same_command_resumes(stridula, monkeypatch, tmp_path):
    many = (*SWEEP, "--vary", "friction=0.2:2:100")
    with monkeypatch.context() as patch:
        patch.setattr(rich_bars.RichBar, "show", interrupt)
        code, out, err = stridula(*many)
    assert (code, out) == (130, "")
    found = re.fullmatch(
        r"stridula: interrupted; (\d+) of 100 points are saved in map.nc.parts; the same command resumes from there\n",
        err,
    )
    assert found
    assert found[1] in ("36", "64")
    assert [path.name for path in tmp_path.iterdir()] == ["map.nc.parts"]
    assert stridula(*many)[:2] == (0, "100 points: 100 done; written to map.nc\n")
    assert [path.name for path in tmp_path.iterdir()] == ["map.nc"]


def test_a_full_disk_in_a_sweep_is_one_line_and_fails(stridula, monkeypatch, tmp_path):
    def full(*args):
        raise OSError(errno.ENOSPC, "cannot write 'map.nc': no space left on device")

    monkeypatch.setattr("stridula.studies.parts.save", full)
    code, out, err = stridula(*SWEEP, *VARY)
    assert (code, out, err) == (1, "", "stridula: cannot write 'map.nc': no space left on device\n")
    assert len(list((tmp_path / "map.nc.parts").iterdir())) == 2


def test_a_map_is_drawn_where_the_measures_have_regimes(stridula, monkeypatch, tmp_path):
    regime = Measure(
        "regime", (Column("regime", "", "regime", is_text=True),), lambda run: {"regime": next(iter(REGIME_COLOURS))}
    )
    monkeypatch.setitem(MEASURES, "regime", regime)
    assert stridula(*SWEEP, *VARY, "--vary", "angle=1", "--measure", "regime", "--plot", "map.png")[0] == 2
    grid = ("--vary", "friction=0.2:2.0:2", "--vary", "angle=20:80 deg:2")
    assert stridula(*SWEEP, *grid, "--measure", "regime", "--measure", "stability", "--plot", "map.png")[0] == 0
    assert (tmp_path / "map.png").read_bytes().startswith(b"\x89PNG")
