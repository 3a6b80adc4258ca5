"""Profiles of tracks: their values, what is refused, scenarios, notes, continued runs."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import stridula as st
from stridula._kernels.contacts.profiles import height_at
from stridula._kernels.layout.contact_values import Profile as Marched
from stridula.integration.live import LiveMarch
from stridula.lowering import assemble
from stridula.lowering.blocks import blocks_of

ROUGH = st.Profile.random(2e-6, 5e-3, 0.1, seed=2)
DIP = st.Profile([0.0, 1e-3, 2e-3, 3e-3, 4e-3], [0.0, 0.0, -2e-5, 0.0, 0.0])


def on_belt(profile, speed=1.0, *, friction=0.3, **changes) -> st.System:
    mass = st.PointMass(0.2)
    belt = st.RigidTrack(velocity=speed, profile=profile, **changes)
    contact = st.PointContact(mass.centre, belt, friction=st.Coulomb(friction), stiffness=st.LinearStiffness(1e6, 20.0))
    start = st.InitialState(mass, displacement=(0.0, -2e-5))
    return st.System(contact, [st.Force(mass.centre, y=-20.0), start], [st.Spring(mass.centre, stiffness=2e4)])


def run_of(system, duration=0.01, step=5e-5, **settings):
    return st.simulate(system, duration, **({"step": step, "probes": []} | settings))


def in_march(profile, places):
    system = on_belt(profile)
    table = blocks_of(assemble(system), st.ExactModal(), 1e-5).contacts.profiles
    return np.array([height_at(float(place), Marched(table, 0)) for place in places])


@pytest.mark.parametrize("periodic", [True, False])
@pytest.mark.parametrize("seed", range(10))
def test_a_profile_is_the_cubic_spline_of_scipy(seed, periodic):
    random = np.random.default_rng(seed)
    count = int(random.integers(4, 40))
    place, height = np.cumsum(random.exponential(0.01, count)) - 0.1, random.uniform(-1e-5, 1e-5, count)
    if periodic:
        height[-1] = height[0]
    profile = st.Profile(place, height, periodic)
    at = random.uniform(place[0] - 1.0, place[-1] + 1.0, 300)
    if periodic:
        expected = CubicSpline(place, height, bc_type="periodic")(at)
    else:
        expected = CubicSpline(place, height, bc_type="clamped")(np.clip(at, place[0], place[-1]))
    scale = np.abs(height).max()
    np.testing.assert_allclose(profile.height_at(at), expected, atol=1e-10 * scale)
    np.testing.assert_allclose(in_march(profile, at), expected, atol=1e-10 * scale)
    small = 1e-6 * np.diff(place).min()
    slope = (profile.height_at(at + small) - profile.height_at(at - small)) / (2 * small)
    np.testing.assert_allclose(profile.slope_at(at), slope, atol=1e-5 * profile.steepest)
    assert np.abs(profile.slope_at(at)).max() <= profile.steepest * (1 + 1e-12)
    assert profile.beyond(at).any() != periodic


def test_a_sine_has_its_amplitude_wavelength_and_phase():
    wave = st.Profile.sine(3e-6, 0.02, 0.4)
    at = np.linspace(-1.0, 1.0, 1001)
    k = 2 * np.pi / 0.02
    np.testing.assert_allclose(wave.height_at(at), 3e-6 * np.sin(k * at + 0.4), atol=3e-14)
    np.testing.assert_allclose(wave.slope_at(at), 3e-6 * k * np.cos(k * at + 0.4), atol=1e-6 * 3e-6 * k)
    assert wave.wavelength == pytest.approx(0.02, rel=1e-3)
    assert wave.steepest == pytest.approx(3e-6 * k, rel=1e-5)


def test_random_heights_have_their_rms_and_their_correlation():
    """The correlation is a mean over 200 profiles of 20 correlation lengths: 1e-2 are four standard errors."""
    length, rms = 5e-3, 2e-6
    shifts = np.array([0.0, 0.5, 1.0, 2.0]) * length
    found = np.zeros(4)
    for seed in range(200):
        rough = st.Profile.random(rms, length, 20 * length, seed=seed)
        at = np.linspace(0.0, 20 * length, 4000, endpoint=False)
        height = rough.height_at(at)
        assert np.sqrt(np.mean(height**2)) == pytest.approx(rms, rel=1e-3)
        assert abs(height.mean()) < 1e-9 * rms
        found += [np.mean(height * rough.height_at(at + shift)) / 200 for shift in shifts]
    # Without its mean, the correlation is lower everywhere by the share of the mean.
    mean = np.sqrt(np.pi) / 20
    expected = (np.exp(-((shifts / length) ** 2)) - mean) / (1 - mean)
    np.testing.assert_allclose(found / rms**2, expected, atol=1e-2)
    assert st.Profile.random(rms, length, 0.1, seed=1) == st.Profile.random(rms, length, 0.1, seed=1)
    assert st.Profile.random(rms, length, 0.1, seed=1) != st.Profile.random(rms, length, 0.1, seed=2)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: st.Profile([0.0, 1.0], [0.3]), "height must have as many values as place, 2, got 1"),
        (lambda: st.Profile([0.0], [0.3]), "place must have 2 values or more, got 1"),
        (lambda: st.Profile([0.0, 1.0, 2.0], [0.0] * 3, True), "place must have 4 values or more, got 3"),
        (lambda: st.Profile([0.0, 1.0, 1.0], [0.0] * 3), "place[2] must be above 1.0, the one before it, got 1.0"),
        (lambda: st.Profile([0.0, 1.0], [0.0, float("nan")]), "height[1] must be finite, got nan"),
        (lambda: st.Profile([0.0, 1.0], [0.0, 1.0], 1), "periodic must be a bool, got 1"),
        (
            lambda: st.Profile([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 3.0], True),
            "height[3] must be 0.0, the first one, a period later, got 3.0",
        ),
        (lambda: st.Profile.sine(1e-6, 0.0), "wavelength must be above 0, got 0.0"),
        (lambda: st.Profile.random(1e-6, 1.0, 3.0), "length must be at least four correlation lengths, 4.0 m, got 3.0"),
        (lambda: st.Profile.random(0.0, 1.0, 5.0), "rms must be above 0, got 0.0"),
        (lambda: st.RigidTrack(profile=3.0), "profile must be a Profile, got 3.0"),
    ],
)
def test_wrong_arguments_are_refused_in_one_line(make, message):
    with pytest.raises(st.ArgumentError, match=f"^{re.escape(message)}$"):
        make()


def test_texts_of_profiles_and_of_their_systems_are_short():
    assert repr(DIP) == "Profile(place=(0.0, 0.001, 0.002, 0.003, 0.004), height=(0.0, 0.0, -2e-05, 0.0, 0.0))"
    wave = st.Profile.sine(5e-6, 0.02)
    assert repr(wave) == "Profile(257 points from 0 to 0.02 m, heights from -5e-06 to 5e-06 m, periodic=True)"
    assert "on a rigid track with a profile at 0 m, friction 0.3" in repr(on_belt(wave))
    assert "a rigid track with a profile" in on_belt(wave)._repr_html_()


def test_a_file_is_read_with_its_units_in_any_order(tmp_path):
    path = tmp_path / "rail.csv"
    path.write_text("# measured\nplace;height\n20;0\n0;0\n5;3\n10;0\n15;-3\n")
    read = st.Profile.read(path, periodic=True, place_unit=1e-3, height_unit=1e-6)
    assert read == st.Profile(np.arange(0, 21, 5) * 1e-3, np.array([0.0, 3, 0, -3, 0]) * 1e-6, True)
    assert read == st.Profile.read(path, ("place", "height"), periodic=True, place_unit=1e-3, height_unit=1e-6)


@pytest.mark.parametrize(
    ("text", "columns", "message"),
    [
        ("0,1\n1,x\n", (0, 1), "{path}, line 2: column 2 must be a number, got 'x'"),
        ("0,1\n1,2\n", (0, 2), "{path}, line 1: columns must be below 2, the number of columns, got 2"),
        ("s,p\n0,1\n1,2\n", ("s", "q"), "{path}, line 1: columns must be out of s, p, got 'q'"),
        ("0,1\n0,2\n", (0, 1), "{path}: place[1] must be above 0.0, the one before it, got 0.0"),
        ("0,1\n1,2\n", (0,), "columns must be two, of place and height, got (0,)"),
    ],
)
def test_a_wrong_file_is_refused_with_its_line(tmp_path, text, columns, message):
    path = tmp_path / "rail.csv"
    path.write_text(text)
    with pytest.raises(st.ArgumentError) as refused:
        st.Profile.read(path, columns)
    assert str(refused.value) == message.format(path=path)


def test_a_record_runs_again_from_its_scenario():
    run = run_of(on_belt(ROUGH))
    assert tomllib.loads(run.attrs["scenario"])["contacts"][0]["track"]["profile"]["periodic"] is True
    again = st.load_scenario(run).simulate()
    assert np.array_equal(run.normal_force, again.normal_force)
    assert again.attrs["scenario"] == run.attrs["scenario"]


def test_a_profile_may_be_left_out_and_changes_the_run():
    flat, rough = (run_of(on_belt(profile)) for profile in (None, ROUGH))
    assert "profile" not in tomllib.loads(flat.attrs["scenario"])["contacts"][0]["track"]
    assert float(np.abs(flat.normal_force - rough.normal_force).max()) > 0.1


def test_a_continued_run_stays_on_its_profile():
    whole, first = run_of(on_belt(ROUGH), 0.02), run_of(on_belt(ROUGH))
    second = run_of(on_belt(ROUGH), start=first)
    assert np.array_equal(whole.contact_height[-len(second.time) :], second.contact_height)
    # At another speed of the belt it continues at its place, without a jump of the gap.
    faster = run_of(on_belt(ROUGH, 1.2), start=first)
    assert abs(float(faster.gap[0] - first.gap[-1])) < 1e-7
    with pytest.raises(st.ArgumentError, match=re.escape("start must have the same contact")):
        run_of(on_belt(st.Profile.random(2e-6, 5e-3, 0.1, seed=3)), start=first)


def test_side_by_side_every_run_has_its_own_profile():
    profiles = [st.Profile.random(2e-6, 5e-3, 0.1, seed=seed) for seed in range(9)]
    systems = [on_belt(one) for one in (*profiles, DIP, None)]
    for system, run in zip(systems, st.simulate_many(systems, 0.01, step=5e-5, probes=[]), strict=True):
        alone = run_of(system)
        np.testing.assert_allclose(run.contact_height, alone.contact_height, rtol=0, atol=1e-15)


def test_the_default_step_resolves_the_waves():
    """Forty steps in the passage of a wave; speeds that forces cause are named in a note."""
    wave = st.Profile.sine(1e-7, 2e-3)
    run = st.simulate(on_belt(wave, 5.0), 0.01, probes=[])
    assert 2e-3 / (5.0 * run.attrs["step"]) >= 40
    assert "passed the shortest waves" not in run.attrs["notes"]
    late = on_belt(wave, 5.0, history=st.Ramp(5e-3))
    assert st.simulate(late, 0.01, probes=[]).attrs["step"] == run.attrs["step"]
    coarse = run_of(on_belt(wave, 5.0), step=2.5e-5)
    assert "contact 1 passed the shortest waves of its profile in 16 steps" in coarse.attrs["notes"]


def test_notes_name_ends_and_steep_slopes():
    assert "left the profile" not in run_of(on_belt(ROUGH, -1.0)).attrs["notes"]
    notes = run_of(on_belt(DIP, -1.0, friction=0.0)).attrs["notes"]
    found = re.search(r"contact 1 left the profile of its track, which is flat beyond, at (\S+) s", notes)
    assert float(found[1]) == pytest.approx(4e-3, abs=2e-4)
    steep = replace(DIP, height=10 * np.array(DIP.height))
    assert "contact 1: its profile is as steep as 0.2" in run_of(on_belt(steep, -0.1)).attrs["notes"]


@pytest.mark.parametrize(
    "ask",
    [
        st.sliding_stability,
        st.limit_cycle,
        st.lyapunov_exponent,
        # A contact without a stiffness cannot start in equilibrium either.
        lambda system: st.simulate(
            st.System(replace(system.contact, stiffness=None), [*system.drives, st.InitialEquilibrium()]), 0.01
        ),
    ],
)
def test_questions_of_steady_sliding_are_refused(ask):
    with pytest.raises(st.ArgumentError, match=r"^track.profile must be left out .*, over which no sliding is steady$"):
        ask(on_belt(ROUGH))


def test_points_of_a_face_have_places_about_its_middle():
    block = st.SolidBody.block((0.02, 0.01, 0.02), (2, 1, 1), st.Material(2.1e11, 7800.0, 0.3), cutoff=80e3)
    face = st.SurfaceContact(block, "bottom", st.RigidTrack(profile=ROUGH))
    along = np.array([one.at for one in face.contacts])
    np.testing.assert_allclose(along, face.places[:, 0] - 0.01, atol=1e-15)
    gaps = np.array([one.gap for one in face.contacts])
    heights = ROUGH.height_at(along)
    # It starts as near to the surface as to a flat one.
    np.testing.assert_allclose(gaps, heights.max() - heights, atol=1e-15)


def test_a_live_march_stays_on_the_profile_and_begins_anew_on_another():
    system = on_belt(ROUGH)
    live = LiveMarch(system, ())
    parts = [live.advance(samples)[0] for samples in (200, 280)]
    run = st.simulate(system, 480 / 48e3, sample_rate=48e3, step=live.step, probes=[])
    gaps = np.concatenate([part.contact["gap"] for part in parts])
    assert np.array_equal(run.gap.values, gaps)
    assert live.change(on_belt(ROUGH, friction=0.25), ())
    after = live.advance(10)[0].contact["gap"]
    assert abs(after[0] - gaps[-1]) < 1e-7
    assert not live.change(on_belt(DIP), ())
