"""Squeal surveys: growing modes, their fates in time, and saving and resuming of surveys."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula.linear.reach import modes_at_rest
from stridula.scenarios import Scenario
from stridula.studies.fates import Options, Runs
from stridula.studies.survey_task import without_start
from stridula.studies.swings import growth_in_time

from .mode_coupling import MODEL, flutter

SLIDING = st.InitialEquilibrium(status="sliding")


@pytest.fixture(autouse=True)
def in_an_empty_folder(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)


def test_a_mode_grows_in_time_as_its_eigenvalue_says_and_lives_on():
    found = st.squeal_survey(flutter, {"friction": [0.8, 0.9, 1.0]}).isel(mode=0)
    known = np.array([MODEL.exponents(friction)[0] for friction in found.friction.values])
    for name in ("growth_rate", "seen_growth_rate"):
        np.testing.assert_allclose(found[name], known.real, rtol=1e-2 if "seen" in name else 1e-6)
    np.testing.assert_allclose(found.seen_frequency, np.abs(known.imag) / (2.0 * np.pi), rtol=1e-3)
    # Negative control: the next point's eigenvalue is far off.
    assert (np.abs(found.seen_growth_rate.values[:-1] / known.real[1:] - 1.0) > 0.1).all()
    assert set(found.fate.values) == {"lives"}
    assert set(found.regime.values) == {"squeal"}
    assert (found.reached * found.steady == 1.0).all()
    # Its tone is lower, as the contact opens, and the next ones are multiples of it.
    strongest = found.tone_frequency.isel(tone=0)
    assert ((strongest < found.frequency) & (strongest > 0.95 * found.frequency)).all()
    np.testing.assert_allclose(
        found.tone_mode.isel(tone=slice(0, 3)), np.repeat(found.frequency.values, 3).reshape(3, 3)
    )
    np.testing.assert_array_equal(found.tone_order.isel(tone=slice(0, 3)), [[1.0, 2.0, 3.0]] * 3)
    shares = sum(found[f"{word}_share"] for word in ("separated", "sticking", "sliding"))
    np.testing.assert_allclose(shares, 1.0)
    assert (found.separated_share > 0.1).all()
    assert np.isnan(found.sound_level).all()


def test_a_point_that_does_not_grow_has_a_verdict_and_without_kicks_no_run(monkeypatch):
    monkeypatch.setattr(Scenario, "simulate", lambda *words, **more: pytest.fail("it ran"))
    found = st.squeal_survey(flutter, {"friction": [0.2, 0.5]}, kicks=0)
    assert found.verdict.values.tolist() == ["stable", "stable"]
    assert found.unstable_modes.values.tolist() == [0.0, 0.0]
    assert found.equilibria.values.tolist() == ["one", "one"]
    assert found.sizes["mode"] == 0
    assert st.squeal_survey("squeal", [{"friction": 1.5}]).verdict.item() == "held"
    jammed = st.squeal_survey("weak-pressure", [{"friction": 2.0}])
    assert (jammed.verdict.item(), np.isnan(jammed.unstable_modes.item())) == ("jammed", True)
    up = st.squeal_survey("squeal", [{"friction": 0.9}], overrides={"angle": "-45 deg"})
    assert up.verdict.item() == "lifted off"


def test_a_survey_without_modes_can_be_kept():
    found = st.squeal_survey(flutter, {"friction": [0.2]}, out="none.nc")
    xr.testing.assert_identical(st.load("none.nc"), found)


@pytest.mark.parametrize(
    ("friction", "longest", "options", "fate"),
    [
        (0.8, 0.02, {}, "not reached"),
        (0.9, 1.0, {"stops": 0.05}, "dies"),
    ],
)
def test_runs_without_vibration_at_the_end_are_reported(friction, longest, options, fate):
    found = st.squeal_survey(flutter, {"friction": [friction]}, longest=longest, overrides=options).squeeze()
    assert found.fate.item() == fate
    assert float(found.duration) <= longest * 1.001
    assert float(found.living_modes) == 0.0
    if fate == "dies":
        assert np.isnan(found.tone_frequency).all()


@pytest.mark.parametrize("seed", range(6))
def test_a_mode_has_left_linear_theory_once_its_mass_can_stick_and_not_before(seed):
    """A mass on a belt under linear weakening vibrates linearly until it stops on the belt, after a known time."""
    random = np.random.default_rng(seed)
    frequency, growth = 10.0 ** random.uniform(-1.0, 2.0), random.uniform(0.01, 0.1)
    growth *= frequency
    mass, belt = st.PointMass(1.0), st.RigidTrack(velocity=1.0)
    law, load = st.LinearWeakening(0.9, slope=0.2), 2.0 * growth / 0.2
    spring = st.Spring(mass.centre, stiffness=(2.0 * np.pi * frequency) ** 2)

    def system(load):
        return st.System([st.PointContact(mass.centre, belt, friction=law)], [st.Force(mass.centre, y=-load)], [spring])

    # Its slip velocity swings by 1/1000 of that of the belt at the start.
    stops = np.log(1e3) / growth
    short = (random.uniform(0.45, 4.0) / (frequency * stops) for _ in range(4))
    for share, left in [*((one, 0.0) for one in short), (random.uniform(0.02, 0.9), 0.0), (0.9, 0.0), (1.3, 1.0)]:
        found = st.squeal_survey(system, {"load": [load]}, duration=share * stops, amplitude=1e-3, progress=False)
        assert found.message.item() == ""
        assert found.reached.item() == left, (frequency, growth, share)
        assert (found.fate.item() == "not reached") == (left == 0.0)


def test_a_run_of_few_samples_is_refused_in_words():
    found = st.squeal_survey(flutter, {"friction": [0.9]}, longest=1e-6)
    assert "longest must last 8 samples" in found.message.item()


def test_a_run_that_leaves_its_track_is_reported():
    found = st.squeal_survey("weak-pressure", [{"friction": 0.9}], overrides={"contact.at": 1.6285}).squeeze()
    assert found.fate.item() == "off the track"


def runs_of(system: st.System, amplitude: float) -> Runs:
    bare, _ = without_start(system, None)
    scenario = Scenario("", "", bare, 1.0, st.ExactModal(), None, 1e6, ())
    options = Options(None, 1.0, amplitude, 0.1, np.inf, None, cycles=False, kicks=0)
    return Runs(scenario, SLIDING, modes_at_rest(bare, SLIDING), options, lambda: None)


@pytest.mark.parametrize("speed", [1.0, 1e-4])
@pytest.mark.parametrize(("share", "changes"), [(0.9, False), (1.1, True)])
def test_a_contact_opens_or_stops_where_the_reach_of_a_mode_ends(speed, share, changes):
    """Fast belts open it, slow ones stop it. The small growth of the mode within a period is subtracted."""
    system = flutter(0.8, speed)
    runs = runs_of(system, 1e-3)
    (number,) = runs.rest.reach
    period = 2.0 * np.pi / runs.rest.exponents[number].imag
    assert runs.rest.exponents[number].real * period < 0.4
    grown = np.exp(runs.rest.exponents[number].real * period) if share < 1.0 else 1.0
    start = st.InitialEquilibrium(status="sliding", mode=number, amplitude=share * runs.rest.reach[number] / grown)
    run = st.simulate(st.System(system.contact, [system.drives[0], start]), period, sample_rate=1e5)
    assert bool((run.status_share.sel(contact_status="sliding") < 1.0).any()) == changes


def test_growth_and_limit_cycle_do_not_depend_on_how_small_the_start_is():
    small, large = (
        st.squeal_survey(flutter, {"friction": [0.9]}, amplitude=amplitude).squeeze() for amplitude in (1e-5, 1e-2)
    )
    for name, slack in (("seen_growth_rate", 1e-4), ("normal_force_rms", 1e-3), ("separated_share", 1e-2)):
        assert float(small[name]) == pytest.approx(float(large[name]), rel=slack)
    assert float(small.duration) > float(large.duration)


def test_growth_is_not_given_where_several_modes_contribute():
    """Negative control: the run of another system does not contain this mode."""
    runs, others = (runs_of(flutter(friction), 1e-3) for friction in (0.8, 1.2))
    (number,) = runs.rest.reach
    run = runs.of(number).run
    assert growth_in_time(run, runs.still, runs.rest, number, 1e-3).real == pytest.approx(
        runs.rest.exponents[number].real, rel=1e-3
    )
    late = run.isel(time=slice(run.sizes["time"] // 2, None))
    assert np.isnan(growth_in_time(late, runs.still, runs.rest, number, 1e-3))
    strange = others.of(number).run
    assert growth_in_time(strange, others.still, runs.rest, number, 1e-3).real > 1.5 * runs.rest.exponents[number].real


def test_a_track_that_can_be_heard_has_a_level():
    found = st.squeal_survey("weak-pressure", {"friction": [0.9]}).squeeze()
    assert 40.0 < float(found.sound_level) < 70.0
    assert found.regime.item() == "squeal"
    assert float(found.seen_growth_rate) == pytest.approx(float(found.growth_rate), rel=0.05)


def test_a_slip_velocity_is_taken_where_nothing_prescribes_it():
    mass = st.PointMass(1.0)

    def on_a_floor(static):
        contact = st.PointContact(mass.centre, st.RigidTrack(), friction=st.Stribeck(static, 0.25, 0.5))
        return st.System(contact, [st.Gravity(10.0)], [st.Spring(mass.centre, stiffness=400.0)])

    asked = st.squeal_survey(on_a_floor, {"static": [0.28]})
    assert asked.verdict.item() == "not started"
    assert "velocity must be given" in asked.message.item()
    given = st.squeal_survey(on_a_floor, {"static": [0.28]}, velocity=0.5, duration=0.5).squeeze()
    assert given.verdict.item() == "unstable"
    assert float(given.frequency) == pytest.approx(20.0 / (2.0 * np.pi), rel=1e-2)


POINTS = st.Grid({"friction": [0.5, 0.8, 0.9], "load": [-1.0, 100.0]})
SHORT = {"duration": "20 ms"}


def complete(path, **options) -> bytes:
    st.squeal_survey(flutter, POINTS, out=path, **SHORT, **options)
    assert not os.path.exists(f"{path}.parts")
    return Path(path).read_bytes()


def test_a_stopped_survey_ends_in_the_same_bytes_for_any_workers(monkeypatch):
    one = complete("one.nc", workers=1)
    assert complete("two.nc", workers=2) == one

    def stop(progress):
        if progress.done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        complete("stopped.nc", workers=1, watchers=[stop])
    assert sorted(path.name for path in Path("stopped.nc.parts").iterdir())[-1] == "survey.json"
    with pytest.raises(ValueError, match="hold parts of this survey, got others, of other points or options"):
        st.squeal_survey(flutter, POINTS, out="stopped.nc", duration=0.03)
    seen = []
    assert complete("stopped.nc", watchers=[seen.append]) == one
    assert (seen[0].done, seen[-1].done) == (3, 6)
    found = st.load("one.nc")
    assert found.verdict.values.tolist() == [["not built", "stable"]] + [["not built", "unstable"]] * 2
    assert found.message.values[0, 0] == "flutter: it is pressed"
    monkeypatch.setattr(Scenario, "simulate", lambda *words, **more: pytest.fail("it ran"))
    xr.testing.assert_identical(st.squeal_survey(flutter, POINTS, out="one.nc", **SHORT), found)
    with pytest.raises(ValueError, match="out must be a new file or that of this sweep"):
        st.sweep(flutter, POINTS, "stability", out="one.nc", duration=1e-3)


KILLED = """
import os, signal, sys
sys.path[:0] = {paths!r}
import stridula as st
from physics.mode_coupling import flutter

def kill(progress):
    if progress.done == 2:
        os.kill(os.getpid(), signal.SIGKILL)

points = st.Grid({{"friction": [0.5, 0.8, 0.9], "load": [-1.0, 100.0]}})
st.squeal_survey(flutter, points, out="killed.nc", duration="20 ms", workers=1, watchers=[kill])
"""


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="nothing is killed so here")
def test_a_survey_that_was_killed_is_resumed():
    assert flutter.__module__ == "physics.mode_coupling"
    paths = [str(Path(file).resolve().parents[1]) for file in (__file__, st.__file__)]
    code = KILLED.format(paths=paths)
    stopped = subprocess.run([sys.executable, "-c", code], check=False)
    assert stopped.returncode == -signal.SIGKILL
    assert len(list(Path("killed.nc.parts").glob("0*.json"))) == 2
    seen = []
    assert complete("killed.nc", workers=1, watchers=[seen.append]) == complete("whole.nc")
    assert seen[0].done == 2


def test_a_run_that_fails_is_the_message_of_its_point(monkeypatch):
    def fails(self, **words):
        raise RuntimeError("no room")

    monkeypatch.setattr(Scenario, "simulate", fails)
    found = st.squeal_survey(flutter, {"friction": [0.5, 0.9]})
    quiet, growing = found.message.values.tolist()
    assert (quiet.startswith("kick of the mode at "), quiet.endswith(" Hz: no room")) == (True, True)
    assert growing == "mode at 1006 Hz: no room"
    assert found.fate.values.ravel().tolist() == ["", "failed"]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"amplitude": 0.5}, "amplitude must be from 1e-06 to 0.1, got 0.5"),
        ({"longest": 0}, "longest must be above 0, got 0"),
        ({"longest": "1 m"}, "longest must be a number in s"),
        ({"duration": -1.0}, "duration must be above 0"),
        ({"resolution": 2}, "resolution must be from 0 to 0.5, got 2"),
        ({"highest": "x"}, "highest must be a number in Hz"),
        ({"velocity": "fast"}, "velocity must be a number, got 'fast'"),
        ({"workers": 0}, "workers must be at least 1"),
        ({"watchers": 3}, "watchers must be a list"),
        ({"client": 3}, "client must be a client of dask.distributed"),
        (
            {"points": {"mode": [1, 2]}},
            "key must not have the name of a result of the survey, got 'mode': write its full",
        ),
        ({"points": {"speed": [1.0]}}, r"flutter must take the parameters speed, got one of"),
        ({"points": []}, "points must hold at least one point"),
    ],
)
def test_bad_arguments_are_one_line_and_nothing_is_written(options, message):
    with pytest.raises(ValueError, match=message) as error:
        st.squeal_survey(flutter, **({"points": {"friction": [0.8]}, "out": "a.nc"} | options))
    assert "\n" not in str(error.value)
    assert list(Path().iterdir()) == []
