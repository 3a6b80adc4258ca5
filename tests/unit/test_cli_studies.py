"""Commands over many parameters: stability, calibrate, sensitivity."""

from __future__ import annotations

import re
import tomllib

import numpy as np
import pytest
import scipy.stats

import stridula as st
from stridula.cli import searching
from stridula.studies.measures import MEASURES

SHORT = ("--duration", "2 ms")


def test_stability_prints_equilibrium_and_modes(stridula):
    code, out, err = stridula("stability", "weak-pressure", "--set", "friction=1.2")
    assert (code, err) == (0, "")
    modes = st.sliding_stability(st.load_scenario("weak-pressure", {"friction": 1.2}).system)
    grows = int(modes["unstable"].sum())
    assert f"slides steadily; {grows} modes grow (of {modes.sizes['mode']})." in out
    assert f"{float(modes['growth_rate'].max()):.5g}" in out
    code, out, _ = stridula("stability", "squeal")
    assert "Equilibrium: held by friction; no mode grows" in out
    code, out, _ = stridula("stability", "squeal", "--status", "sliding")
    assert "about the contacts as given" in out


ON_A_FLOOR = """
[bodies.mass]
kind = "point mass"
mass = 1

[[contacts]]
tip = { body = "mass" }
track = { kind = "rigid" }
friction = { law = "stribeck", static = 0.28, kinetic = 0.25, velocity = 0.5 }

[[connections]]
kind = "spring"
first = { body = "mass" }
stiffness = 4

[[drives]]
kind = "gravity"
acceleration = 10

[simulation]
duration = 0.1
"""


def test_one_mode_is_not_in_the_plural(stridula, tmp_path):
    assert "Equilibrium: slides steadily; no mode grows (of 1)." in stridula("stability", "belt")[1]
    (tmp_path / "floor.toml").write_text(ON_A_FLOOR, encoding="utf-8")
    assert "; 1 mode grows (of 1)." in stridula("stability", "floor.toml", "--velocity", "0.5")[1]


def test_a_sweep_compares_regimes_with_linear_theory_in_a_table(stridula):
    grid = ("--vary", "friction=0.5,1.5", "--measure", "regime", "--duration", "0.2", "--out", "map.nc")
    code, out, _ = stridula("sweep", "weak-pressure", *grid)
    assert code == 0
    counts = st.agreement(st.load("map.nc"))
    assert "runs compared   both agree   vibration, no growth   growth, no vibration" in out
    row = [int(counts[word]) for word in ("compared", "agree", "missed", "false_alarms")]
    assert re.search(r"^ *" + r" +".join(map(str, row)) + r" *$", out, re.MULTILINE)


def test_stability_takes_slip_velocities(stridula, tmp_path):
    (tmp_path / "floor.toml").write_text(ON_A_FLOOR, encoding="utf-8")
    for velocity, slip in (("0.5", 0.5), ("-50 cm/s", -0.5), ("0.5,", None), ("fast", None)):
        code, out, err = stridula("stability", "floor.toml", "--velocity", velocity)
        if slip is None:
            assert (code, out) == (2, "")
            assert "--velocity must be a number" in err
        else:
            assert f"slip {slip:g} m/s" in out
            assert "0.22073" in out
    code, out, err = stridula(
        "stability", "floor.toml", "--velocity", "0.5", "--vary", "contacts.0.friction.static=0.26:0.3:2"
    )
    assert (code, out, err) == (0, "unstable at all 2 values of contacts.0.friction.static\n", "")


def test_stability_over_a_parameter_prints_draws_and_writes(stridula, tmp_path):
    arguments = ("--vary", "friction=0.5:2:7", "--highest", "4000", "--out", "loci.nc", "--plot", "loci.png")
    code, out, err = stridula("stability", "weak-pressure", *arguments)
    assert (code, err) == (0, "")
    first, second = out.splitlines()
    assert re.fullmatch(r"unstable from friction = 0\.877\d+ \(within \S+\) on, at 278\d\.\d+ Hz", first)
    assert re.fullmatch(r"jammed from friction = 1\.84\d+ \(within \S+\) on", second)
    loci = st.load("loci.nc")
    assert loci["friction"].values.tolist() == np.linspace(0.5, 2.0, 7).tolist()
    assert float(loci["frequency"].max()) <= 4000.0
    assert (tmp_path / "loci.png").read_bytes().startswith(b"\x89PNG")


def test_stability_reports_an_unchanged_verdict(stridula):
    code, out, _ = stridula("stability", "squeal", "--vary", "friction=0.5,1.5,1.6")
    assert (code, out) == (
        0,
        "no mode grows at any of the 3 values of friction: slides steadily at 1, held by friction at 2\n",
    )
    _, out, _ = stridula("stability", "weak-pressure", "--vary", "friction=1:1.2:2")
    assert out == "unstable at all 2 values of friction\n"
    # Modes that are left out of the figure still count.
    _, out, _ = stridula("stability", "weak-pressure", "--vary", "friction=1:1.2:2", "--highest", "5")
    assert out == "unstable at all 2 values of friction\n"


def test_stability_by_parameters_prints_the_largest_effect_first(stridula, tmp_path):
    keys = ("--by", "slider.damping.rise", "--by", "friction")
    code, out, err = stridula("stability", "weak-pressure", *keys, "--out", "effects.nc", "--plot", "effects.png")
    assert (code, err) == (0, "")
    assert out.startswith("mode at 2830.8 Hz, growth 1181.4 1/s; 10 % more:")
    assert re.search(r"friction +1\.2 +\+606\.4 +\+10\.33 +lower\b.*slider\.damping\.rise .* raise", out, re.DOTALL)
    effects = st.load("effects.nc")
    assert effects.parameter.values.tolist() == ["slider.damping.rise", "friction"]
    assert effects["d_growth_rate"].dims == ("parameter", "mode")
    assert (tmp_path / "effects.png").read_bytes().startswith(b"\x89PNG")


def test_stability_at_random_prints_the_probability(stridula, tmp_path):
    given = ("--random", "friction=normal:0.9:0.1", "--random", "angle=-50deg:-40deg", "--samples", "40", "--seed", "2")
    more = ("--correlation", "friction,angle=0.5", "--out", "found.nc", "--plot", "found.png", "--workers", "1")
    code, out, _ = stridula("stability", "weak-pressure", *given, *more)
    assert code == 0
    found = st.load("found.nc")
    pairs = {("friction", "angle"): 0.5}
    uncertain = {"friction": scipy.stats.norm(0.9, 0.1), "angle": ("-50 deg", "-40 deg")}
    same = st.mode_probability("weak-pressure", uncertain, samples=40, seed=2, correlations=pairs)
    np.testing.assert_array_equal(found.probability, same.probability)
    assert f"Any mode grows: {float(same.any_probability):.3f}" in out
    assert out.endswith("40 points: 40 done, 0 failed\n")
    assert (tmp_path / "found.png").read_bytes().startswith(b"\x89PNG")


RANDOM = ("--random", "friction=0.8:1")
VARY = ("--vary", "friction=0.5:1:3")
BAD_STABILITY = [
    (("--samples", "9"), "--samples must be used with --random, got 9 alone"),
    (("--workers", "1"), "--workers must be used with --random, got 1 alone"),
    ((*RANDOM, "--vary", "friction=0:1:3"), "--vary must be left out with --random"),
    ((*RANDOM, "--status", "sliding"), "--status must be left out with --random"),
    ((*RANDOM, *RANDOM), "--random must name each key once, got 'friction' twice"),
    (("--random", "friction"), "--random must be KEY=LOW:HIGH"),
    (("--random", "friction=normal:1:0"), "--random must be KEY=LOW:HIGH, KEY=LOW:HIGH:log or KEY=normal:MEAN:DEV"),
    ((*RANDOM, "--correlation", "friction=1"), "--correlation must be KEY,KEY=NUMBER, got 'friction=1'"),
    ((*RANDOM, "--samples", "0"), "samples must be at least 1, got 0"),
    ((*RANDOM, "--out", "a.csv"), "--out must be a NetCDF file"),
    (("--plot", "a.png"), "--plot must be used with --vary, --by or --random, got 'a.png' alone"),
    (("--out", "a.nc"), "--out must be used with --vary, --by or --random, got 'a.nc' alone"),
    (("--highest", "9"), "--highest must be used with --vary or --random, got 9.0 alone"),
    (("--set", "frition=1"), "did you mean 'friction'?"),
    (("--status", "slding"), "did you mean 'sliding'?"),
    (("--status", "sliding,sliding"), "status must have one value for each contact, 1 in all"),
    (("--velocity", "0"), "velocity must not be 0, got 0.0"),
    (("--velocity", "nan"), "velocity must be finite, got 'nan'"),
    (("--vary", "frition=0:1:3"), "did you mean 'friction'?"),
    (("--vary", "friction"), "--vary must be KEY=START:STOP:COUNT"),
    (("--vary", "friction=1:0:3"), "--vary must have START below STOP"),
    (("--vary", "friction=0:inf:3"), "--vary must have finite numbers"),
    (("--vary", "friction=0.5"), "--vary must give at least 2 increasing numbers in one unit for this command"),
    (("--vary", "friction=0.6,0.5"), "--vary must give at least 2 increasing numbers in one unit for this command"),
    (("--vary", "angle=10 deg,0.5"), "--vary must give at least 2 increasing numbers in one unit for this command"),
    (
        ("--vary", "root_support=guided,clamped"),
        "--vary must give at least 2 increasing numbers in one unit for this command",
    ),
    (("--vary", "friction=0:1:10001"), "--vary must have a COUNT of at most 10000 here"),
    (("--vary", "friction=0:1 N:3"), "contact.friction.coefficient must be a number, got '0.0 N'"),
    (("--vary", "elements=4:6:5"), "slider.elements must be a whole number, got 4.5"),
    (("--vary", "angle=80deg:100deg:3"), "slider.angle must be strictly between"),
    ((*VARY, "--set", "friction=1"), "key must be set or varied, got both for 'friction'"),
    ((*VARY, "--by", "friction"), "--vary must be left out with --by, got 'friction=0.5:1:3'"),
    (("--by", "friction", "--highest", "9"), "--highest must be left out with --by, got 9.0"),
    (("--by", "frition"), "did you mean 'friction'?"),
    (("--by", "slider.elements"), "parameters must not be whole numbers, got 20 for slider.elements"),
    (("--by", "contact.tangential_damping"), "be numbers that are given, got None for contact.tangential_damping"),
    (("--by", "contact.gap", "--set", "contact.gap=0"), "set a small one in overrides, got 0 for contact.gap"),
    ((*VARY, "--highest", "0"), "highest must be above 0, got 0.0"),
    ((*VARY, "--out", "none/a.nc"), "there is no folder 'none'"),
    ((*VARY, "--out", "."), "it is a directory"),
    ((*VARY, "--plot", "a.xyz"), "--plot must end in one of"),
    ((*VARY, "--out", "a.png", "--plot", "a.png"), "--plot must differ from --out"),
]

SEARCH = ("--vary", "friction=0.1:0.6", "--target", "travel=0:1", *SHORT)
BAD_CALIBRATIONS = [
    ((), "Missing option '--vary'"),
    (("--vary", "friction=0:1"), "Missing option '--target'"),
    (("--vary", "friction=0:1", "--target", "travel"), "--target must be NAME=LOW:HIGH"),
    (("--vary", "friction=0:1", "--target", "travel=1:2:3:4"), "--target must be NAME=LOW:HIGH"),
    (("--vary", "friction=0:1", "--target", "travel=a:b"), "--target must have numbers for LOW, HIGH and SCALE, in SI"),
    (("--vary", "friction=0:1", "--target", "travel=1 mm:2 mm"), "--target must have numbers for LOW, HIGH and SCALE"),
    (
        ("--vary", "friction=0:1", "--target", "travel=2:1"),
        "low and high must be bounds in order, at least one of them finite",
    ),
    (
        ("--vary", "friction=0:1", "--target", "travel=:"),
        "low and high must be bounds in order, at least one of them finite",
    ),
    (("--vary", "friction=0:1", "--target", "travel=1:1"), "scale must be given for a target at one value"),
    (("--vary", "friction=0:1", "--target", "travel=nan:1"), "low must be a number, got nan"),
    (("--vary", "friction=0:1", "--target", "trvel=0:1"), "did you mean 'travel'?"),
    (("--vary", "friction=0:1", "--target", "regime=sqeal"), "did you mean 'squeal'?"),
    (("--vary", "friction=0:1", "--target", "travel=1"), "target of travel must be bounds, got '1'"),
    ((*SEARCH, "--target", "travel=2:3"), "--target must name each measure once, got 'travel' twice"),
    (("--vary", "frition=0:1", "--target", "travel=0:1"), "did you mean 'friction'?"),
    (("--vary", "friction=1:0", "--target", "travel=0:1"), "--vary must have START below STOP"),
    (("--vary", "friction=0:1:log", "--target", "travel=0:1"), "low must be above 0 on a logarithmic range"),
    (("--vary", "friction=0:1:5", "--target", "travel=0:1"), "--vary must be KEY=LOW:HIGH or KEY=LOW:HIGH:log"),
    (("--vary", "friction=0:nan", "--target", "travel=0:1"), "--vary must have finite numbers"),
    (("--vary", "friction=0:1 N", "--target", "travel=0:1"), "contact.friction.coefficient must be a number"),
    (("--vary", "elements=4:8", "--target", "travel=0:1"), "slider.elements must be a whole number"),
    (("--vary", "angle=95deg:99deg", "--target", "travel=0:1"), "ranges must contain sets that can be run, got 32"),
    ((*SEARCH, "--vary", "friction=0:1"), "--vary must name each key once"),
    ((*SEARCH, "--vary", "coefficient=0:1"), "which both mean contact.friction.coefficient"),
    ((*SEARCH, "--set", "friction=1"), "key must be set or varied"),
    ((*SEARCH, "--population", "4"), "population must be at least 5, got 4"),
    ((*SEARCH, "--generations", "0"), "generations must be at least 1, got 0"),
    ((*SEARCH, "--seed", "-1"), "seed must be at least 0, got -1"),
    ((*SEARCH, "--workers", "0"), "workers must be at least 1, got 0"),
    ((*SEARCH, "--out", "none/a.toml"), "there is no folder 'none'"),
    ((*SEARCH, "--out", "."), "it is a directory"),
]

UNCERTAIN = ("--vary", "friction=0.1:0.6", *SHORT)
BAD_SENSITIVITIES = [
    ((), "Missing option '--vary'"),
    (("--vary", "frition=0:1"), "did you mean 'friction'?"),
    (("--vary", "friction=0:1:5"), "--vary must be KEY=LOW:HIGH or KEY=LOW:HIGH:log"),
    ((*UNCERTAIN, "--measure", "regim"), "did you mean 'regime'?"),
    ((*UNCERTAIN, "--samples", "7"), "samples must be a power of 2, got 7"),
    ((*UNCERTAIN, "--samples", "0"), "samples must be at least 1, got 0"),
    ((*UNCERTAIN, "--samples", "4096"), "more than 10000 points must be confirmed with --yes, got 12288 points"),
    ((*UNCERTAIN, "--seed", "-1"), "seed must be at least 0, got -1"),
    ((*UNCERTAIN, "--out", "none/a.nc"), "there is no folder 'none'"),
    ((*UNCERTAIN, "--duration", "x"), "simulation.duration must be a number in s"),
]
BAD = [
    *[(("stability", "squeal", *given), message) for given, message in BAD_STABILITY],
    *[(("calibrate", "squeal", *given), message) for given, message in BAD_CALIBRATIONS],
    *[(("sensitivity", "squeal", *given), message) for given, message in BAD_SENSITIVITIES],
]


@pytest.mark.parametrize(("arguments", "message"), BAD, ids=[" ".join([a[0], *a[2:]]) for a, _ in BAD])
def test_bad_input_is_one_line_and_writes_nothing(stridula, tmp_path, monkeypatch, arguments, message):
    monkeypatch.setattr("stridula.studies.task.simulate_many", lambda *args, **kwargs: pytest.fail("it ran"))
    (tmp_path / "kept").write_text("kept")
    can_keep = "--out" not in arguments and (arguments[0] != "stability" or "--vary" in arguments)
    code, out, err = stridula(*arguments, *(("--out", "kept") if can_keep else ()))
    assert (code, out, err.count("\n")) == (2, "", 1)
    assert message in err
    assert [path.name for path in tmp_path.iterdir()] == ["kept"]
    assert (tmp_path / "kept").read_text() == "kept"


def test_the_calibrated_scenario_reruns_the_best_set(stridula, tmp_path):
    (tmp_path / "mine.toml").write_text(
        'base = "stable-sliding"\ntitle = "Mine"\n[[simulation.probes]]\nbody = "track"\nquantity = "velocity"\n'
        'point = "centre"\n'
    )
    arguments = ("--vary", "friction=0.1:0.6", "--vary", "slider.length=0.5:0.6 m", "--target", "peak_force=:1e6")
    arguments = (*arguments, "--target", "travel=0:1", "--duration", "20 ms", "--set", "contact.gap=2e-6")
    code, out, err = stridula("calibrate", "mine.toml", *arguments, "--population", "6", "--out", "found.toml")
    assert (code, err) == (0, "generation 0 of 50: miss 0\n")
    assert "0.5 to 0.6 m" in out
    assert re.search(r"travel +\S+ +0 to 1 +yes", out)
    written = tomllib.loads((tmp_path / "found.toml").read_text())
    assert written["title"] == "Mine"
    assert [probe["quantity"] for probe in written["simulation"]["probes"]] == ["velocity"]
    assert written["contact"]["gap"] == 2e-6
    assert stridula("run", "found.toml", "--out", "run.nc")[0] == 0
    run = st.load("run.nc")
    assert run.attrs["title"] == "Mine"
    for name in ("travel", "peak_force"):
        (value,) = MEASURES[name].of_record(run).values()
        assert f"{value:.5g}" in re.search(rf"^ *{name} .*$", out, re.MULTILINE)[0]


def test_a_search_is_kept_and_read_again(stridula, tmp_path):
    arguments = ("--vary", "friction=1.2:1.8", "--target", "equilibrium=held", *SHORT, "--population", "5")
    arguments += ("--generations", "2", "--search")
    code, out, err = stridula("calibrate", "squeal", *arguments, str(tmp_path / "search.nc"))
    assert (code, "generation 0 of 2" in err) == (0, True)
    # A finished search is read, not made again.
    again = stridula("calibrate", "squeal", *arguments, str(tmp_path / "search.nc"))
    assert again == (0, out, "")
    code, _, err = stridula("calibrate", "squeal", *arguments, str(tmp_path / "search.csv"))
    assert (code, err.count("\n")) == (2, 1)
    assert "--search must" in err


def test_the_calibrated_scenario_gives_the_same_numbers(stridula, tmp_path):
    ranges = {"friction": (0.1, 0.6), "slider.length": ("0.5 m", "0.6 m")}
    found = st.calibrate(
        "stable-sliding", ranges, {"travel": (1.0, 2.0)}, population=5, generations=1, duration="20 ms"
    )
    arguments = ("--vary", "friction=0.1:0.6", "--vary", "slider.length=0.5:0.6 m", "--target", "travel=1:2")
    arguments = (*arguments, "--population", "5", "--generations", "1", "--duration", "20 ms", "--out", "found.toml")
    code, out, _ = stridula("calibrate", "stable-sliding", *arguments)
    assert code == 1, "the target is not met"
    assert re.search(r"travel .* no", out)
    run = st.load_scenario("found.toml").simulate()
    assert run.attrs["step"] == float(found["step"])
    assert run["time"].values[0] == float(found["sample_interval"])
    (travel,) = MEASURES["travel"].of_record(run).values()
    assert travel == pytest.approx(float(found["travel"]), rel=1e-9)
    assert "acceleration" in run, "probes left to themselves still are"


def test_a_word_is_a_target(stridula):
    code, out, _ = stridula(
        "calibrate", "squeal", "--vary", "friction=1.2:1.8", "--target", "equilibrium=held", *SHORT, "--population", "5"
    )
    assert code == 0
    assert re.search(r"equilibrium +held +held +yes", out)


def interrupt(*arguments, **fields):
    raise KeyboardInterrupt


def test_ctrl_c_prints_the_best_so_far(stridula, monkeypatch, tmp_path):
    arguments = (*SEARCH, "--population", "5", "--out", "found.toml")
    with monkeypatch.context() as patch:
        patch.setattr(searching, "calibrate", interrupt)
        expected = "stridula: interrupted; best so far: nothing yet\n"
        assert stridula("calibrate", "stable-sliding", *arguments) == (130, "", expected)
    real = searching.calibrate

    def stopped(*given, watchers, **options):
        return real(*given, watchers=[*watchers, interrupt], **options)

    monkeypatch.setattr(searching, "calibrate", stopped)
    code, out, err = stridula("calibrate", "stable-sliding", *arguments)
    assert (code, out) == (130, "")
    assert re.search(r"^stridula: interrupted; best so far: friction=0\.\d+$", err, re.MULTILINE)
    monkeypatch.setattr(searching, "sensitivity", interrupt)
    expected = "stridula: interrupted; nothing was kept\n"
    assert stridula("sensitivity", "squeal", *UNCERTAIN, "--out", "a.nc") == (130, "", expected)
    assert list(tmp_path.iterdir()) == []


def test_sensitivity_prints_and_writes(stridula):
    arguments = ("--vary", "friction=0.2:2.0", "--vary", "angle=30deg:80deg", "--samples", "8", "--seed", "1")
    code, out, err = stridula("sensitivity", "squeal", *arguments, "--duration", "20 ms", "--out", "shares.nc")
    assert (code, err) == (0, "")
    assert out.rstrip().endswith("32 runs: 32 done, 0 failed; written to shares.nc")
    assert "Probability of each regime" in out
    assert re.search(r"^ *sliding +-?\d\.\d\d \[", out, re.MULTILINE)
    found = st.load("shares.nc")
    assert found.sizes["parameter"] == 2
    assert float(found["probability"].sum()) == pytest.approx(1.0)


def test_sensitivity_explains_missing_shares(stridula):
    code, out, _ = stridula("sensitivity", "squeal", "--vary", "angle=95deg:99deg", *SHORT, "--samples", "8")
    assert code == 0
    assert "No shares of the variance: they need 8 samples in which all runs give numbers, got 0." in out
    said, counted = out.splitlines()[-2:]
    assert counted == "24 runs: 0 done, 24 failed"
    assert said == "24 of 24 failures: slider.angle must be strictly between -pi/2 and pi/2 rad (90 deg)"
    _, out, _ = stridula("sensitivity", "squeal", "--vary", "friction=1.5:1.6", *SHORT, "--samples", "8")
    assert "no quantity varies" in out
