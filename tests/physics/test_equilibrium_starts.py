"""Starts in sliding equilibrium stay there; with a mode on top they follow linear theory."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

import stridula as st
from stridula.integration.live import LiveMarch
from stridula.linear import starts
from stridula.studies.ensembles import _perturbed
from stridula.verification.prony import exponents
from stridula.verification.systems import mode_coupling

from .sliding_systems import STEADY, TRAVELLING, bar, dragged, mass_on_a_belt, pushed, reduced, rod

SLIDING = 2
EXPLICIT = st.CentralDifference()
SCHEMES = [pytest.param(EXPLICIT, id="central"), pytest.param(st.ExactModal(), id="exact")]


def starting(system: st.System, **words) -> st.System:
    """The system with no other start than its equilibrium."""
    others = [drive for drive in system.drives if not isinstance(drive, st.InitialState)]
    return replace(system, drives=[*others, st.InitialEquilibrium(**words)])


def change(values) -> float:
    """Largest change over time, relative to the mean, of any contact."""
    values = np.asarray(values).reshape(len(values), -1)
    return float((np.ptp(values, axis=0) / np.abs(values.mean(axis=0))).max())


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("name", STEADY)
def test_a_start_in_sliding_equilibrium_stays_there(name, scheme):
    system = STEADY[name]()
    theory = st.sliding_stability(system)
    assert theory.attrs["equilibrium"] == "sliding"
    assert not theory.unstable.any()
    run = st.simulate(starting(system), 0.1, scheme=scheme, probes=[])
    assert (run.status == SLIDING).all()
    for force in ("normal_force", "tangential_force"):
        known = theory[force].values
        np.testing.assert_allclose(run[force].values, np.broadcast_to(known, run[force].shape), rtol=1e-9)
    assert change(run.normal_force) < 1e-9
    slip = theory.slip_velocity.values
    np.testing.assert_allclose(run.slip_velocity.values, np.broadcast_to(slip, run.slip_velocity.shape), rtol=1e-8)


def test_a_law_that_depends_on_speed_stays_there_where_its_force_turns_the_normal_one():
    law = st.Stribeck(0.3, 0.2, 0.5, viscous=0.3)
    run = st.simulate(starting(reduced(law)), 0.1, scheme=EXPLICIT, probes=[])
    assert change(run.normal_force) < 1e-9


@pytest.mark.parametrize("name", STEADY)
def test_a_start_without_deflection_does_not_stay(name):
    """Negative control: the same systems from their undeformed state."""
    run = st.simulate(STEADY[name](), 0.02, scheme=EXPLICIT, probes=[])
    moved = max(change(run.normal_force), change(run.tangential_force), change(run.slip_velocity))
    assert moved > 1e-4


@pytest.mark.parametrize("name", TRAVELLING)
def test_the_deflection_travels_steadily_with_the_contact(name, monkeypatch):
    """Nothing is exactly steady there; a start without the travel is worse."""
    system = TRAVELLING[name]()
    run = st.simulate(starting(system), 0.02, scheme=EXPLICIT, probes=[])
    kept = change(run.normal_force)
    assert (run.status == SLIDING).all()
    plain = st.simulate(system, 0.02, scheme=EXPLICIT, probes=[])
    assert kept < 1e-3 * change(plain.normal_force)
    np.testing.assert_allclose(run.normal_force, float(st.sliding_stability(system).normal_force), rtol=1e-3)
    if name == "rod pushed along a beam":
        return
    monkeypatch.setattr(starts, "travelling", lambda structure, at, speed: 0.0 * at.displacement)
    left_out = st.simulate(starting(system), 0.02, scheme=EXPLICIT, probes=[])
    later = slice(5, None)
    assert change(run.normal_force[later]) < 0.05 * change(left_out.normal_force[later])


def growth(system: st.System, probe, step: float, duration: float, every: int, scheme=EXPLICIT, **words):
    """Exponent of the most unstable mode, and that of the departure of a run from its equilibrium."""
    theory = st.sliding_stability(system, time=0.0)
    values = theory.growth_rate.values + 2j * pi * theory.frequency.values
    known = values[np.where(values.imag > 0.0, values.real, -np.inf).argmax()]
    asked = {"scheme": scheme, "step": step, "sample_rate": 1.0 / step, "probes": [probe]}
    rest = st.simulate(starting(system), duration, **asked)
    run = st.simulate(starting(system, mode="most unstable", **words), duration, **asked)
    assert (run.status == rest.status).all()
    away = run.displacement.values - rest.displacement.values
    return complex(known), complex(exponents(away[::every], every * step, 1.0 / abs(known), 1)[0]), away


def hoffmann() -> tuple:
    """Flutter of a mass of two degrees of freedom."""
    system = mode_coupling.hoffmann().system(0.9)
    return system, st.Displacement(system.slider.at("mass"), "x"), 5e-3, 40.0, 200, 1e-4


def frozen_pair() -> tuple:
    """Flutter of two beams at 561 Hz."""
    track = bar(12e3, damping=0.002)
    system = dragged(track.at(0.17), degrees=-45.0, friction=1.0, elements=6, damping=0.002, cutoff=12e3)
    return system, st.Displacement(track.at(0.17), "y"), 1e-6, 5e-3, 100, 1e-10


def travelling_pair() -> tuple:
    """The same with a contact that moves along the beam."""
    track = bar(12e3, damping=0.002)
    system = dragged(track, 0.17, 1e-3, -45.0, 1.0, elements=6, damping=0.002, cutoff=12e3)
    return system, st.Displacement(track.at(0.17), "y"), 1e-6, 5e-3, 100, 1e-10


def stribeck() -> tuple:
    """A mass that friction feeds on its belt."""
    system = mass_on_a_belt(st.Stribeck(0.35, 0.2, 0.5), braking=0.0)
    return system, st.Displacement(system.slider.centre, "x"), 1e-4, 2.0, 100, 1e-6


def aging() -> tuple:
    """A law with a state below its critical stiffness."""
    system = mass_on_a_belt(st.RateAndState(0.5, 0.01, 0.015, 1e-3, 1e-2), 40.0, braking=0.0)
    belt = replace(system.contacts[0], track=st.RigidTrack(velocity=0.02))
    system = replace(system, contact=belt)
    return system, st.Displacement(system.slider.centre, "x"), 5e-4, 4.0, 200, 1e-7


@pytest.mark.parametrize("make", [hoffmann, frozen_pair, travelling_pair, stribeck, aging])
def test_a_mode_on_top_grows_as_linear_theory_says(make):
    system, probe, step, duration, every, amplitude = make()
    known, seen, away = growth(system, probe, step, duration, every, amplitude=amplitude)
    assert known.real > 0.0
    assert seen.real == pytest.approx(known.real, rel=2e-3)
    assert seen.imag == pytest.approx(known.imag, rel=2e-3)
    # The mode alone: envelope and phase from the first step on, without a decay of others.
    time = step * (1.0 + np.arange(len(away)))
    waves = np.exp(known * time)
    fitted, *_ = np.linalg.lstsq(np.stack([waves.real, waves.imag], axis=1), away[:, 0], rcond=None)
    left = away[:, 0] - np.stack([waves.real, waves.imag], axis=1) @ fitted
    assert np.abs(left / np.abs(waves)).max() < 0.02 * np.hypot(*fitted)


def test_the_fit_distinguishes_another_exponent():
    """Negative control: a mode computed without friction is a different one, and does not persist."""
    system, probe, step, duration, every, amplitude = hoffmann()
    known, _, away = growth(system, probe, step, duration, every, amplitude=amplitude)
    waves = np.exp((known - 0.01) * step * (1.0 + np.arange(len(away))))
    columns = np.stack([waves.real, waves.imag], axis=1)
    fitted, *_ = np.linalg.lstsq(columns, away[:, 0], rcond=None)
    assert np.abs((away[:, 0] - columns @ fitted) / np.abs(waves)).max() > 0.02 * np.hypot(*fitted)


@pytest.mark.parametrize("phase", [0.0, 1.0, -2.5])
def test_amplitude_and_phase_are_of_the_largest_displacement_of_a_contact_point(phase):
    system = dragged(bar().at(0.17), friction=0.1)
    theory = st.sliding_stability(system)
    amplitude, number = 1e-7, 2
    exponent = complex(theory.growth_rate[number], 2.0 * pi * theory.frequency[number])
    rod, track = system.slider, system.contacts[0].track
    probes = [st.Displacement(point, way) for point in (rod.tip, track) for way in "xy"]
    asked = {"scheme": EXPLICIT, "step": 1e-7, "sample_rate": 1e7, "probes": probes}
    rest = st.simulate(starting(system), 2e-5, **asked)
    run = st.simulate(starting(system, mode=number, amplitude=amplitude, phase=phase), 2e-5, **asked)
    away = (run.displacement - rest.displacement).values / amplitude
    largest = max(range(4), key=lambda k: np.abs(away[:, k]).max())
    expected = np.exp(exponent * run.time.values + 1j * phase).real
    np.testing.assert_allclose(away[:, largest], expected, atol=1e-4)


@pytest.mark.parametrize("name", ["rod against a point of a beam", "body given by matrices on two belts"])
def test_theory_says_where_the_contact_points_are_in_equilibrium(name):
    system = STEADY[name]()
    theory = st.sliding_stability(system)
    points = [point for one in system.contacts for point in (one.tip, one.track) if isinstance(point, st.BodyPoint)]
    probes = [st.Displacement(point, way) for point in points for way in "xy"]
    run = st.simulate(starting(system), 1e-4, scheme=EXPLICIT, step=1e-6, sample_rate=1e6, probes=probes)
    found = run.displacement.values.reshape(len(run.time), len(points), 2)
    if system.imposed_velocity:
        found[:, 0, 0] -= 0.05 * run.time.values
        known = [theory.tip_displacement, theory.track_displacement]
    else:
        known = list(theory.tip_displacement)
        assert not theory.track_displacement.any()
    np.testing.assert_allclose(found, np.broadcast_to(np.stack(known), found.shape), rtol=1e-7, atol=1e-16)


def test_an_initial_state_taken_from_theory_is_accepted():
    """Rounding of a gap, in the solve and in physical displacements, is not an overlap."""
    refused = 0
    for seed in range(40):
        random = np.random.default_rng(seed)
        half = random.standard_normal((6, 6))
        stiffness = 1e6 * (half @ half.T + 0.01 * np.eye(6))
        body = st.ReducedBody(np.diag(random.uniform(0.5, 2.0, 6)), stiffness, {"p": random.standard_normal((2, 6))})
        contact = st.PointContact(body.at("p"), st.RigidTrack(velocity=-1.0), friction=st.Coulomb(0.1))
        system = st.System(contact, [st.Force(body.at("p"), x=3.0, y=-40.0)])
        theory = st.sliding_stability(system)
        rest = body.shapes @ theory.modal_displacement.values
        assert theory.attrs["equilibrium"] == "sliding"
        placed = replace(system, drives=[*system.drives, st.InitialState(body, displacement=rest)])
        run = st.simulate(placed, 1e-4, scheme=EXPLICIT, probes=[])
        np.testing.assert_allclose(run.normal_force, float(theory.normal_force), rtol=1e-6)
        refused += float(body.points["p"][1] @ rest) < 0.0
    assert refused > 5


def test_a_true_overlap_is_refused():
    mass = st.PointMass(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack())
    start = st.InitialState(mass, displacement=(1e-3, -1e-14))
    with pytest.raises(ValueError, match="got an overlap of 1e-14 m"):
        st.simulate(st.System(contact, [start]), 1e-3)


def test_a_live_march_starts_in_equilibrium():
    system = starting(TRAVELLING["rod drawn along a beam"]())
    live = LiveMarch(system, (), EXPLICIT)
    chunk, ended = live.advance(100)
    assert ended == "finished"
    np.testing.assert_allclose(chunk.contact["normal_force"], 2.0, rtol=1e-3)


def test_runs_side_by_side_and_ensembles_start_in_equilibrium():
    systems = [starting(dragged(bar(), 0.17, friction=friction)) for friction in (0.1, 0.2, 0.3, 0.4)]
    for run in st.simulate_many(systems, 2e-3, scheme=EXPLICIT, probes=[]):
        np.testing.assert_allclose(run.normal_force, 2.0, rtol=1e-3)
    found = st.ensemble(
        systems[0], 2e-3, {"force": lambda run: float(run.normal_force.mean())}, runs=3, scheme=EXPLICIT
    )
    np.testing.assert_allclose(found.force, 2.0, rtol=1e-2)
    assert np.ptp(found.force.values) > 0.0
    # A gap that the equilibrium closes is no perturbation: the slider is pushed.
    apart = replace(systems[0], contact=replace(systems[0].contact, gap=1e-6))
    (_, moved) = (_perturbed(apart, share) for share in (0.0, 1e-3))
    assert moved.contact == apart.contact
    assert isinstance(moved.drives[-1], st.InitialVelocity)


DRAWN = """
base = "weak-pressure"

[contact]
gap = 0

[[drives]]
kind = "imposed velocity"
velocity = 0.01
normal_load = 2

[[drives]]
kind = "initial equilibrium"
mode = 1
amplitude = 1e-9

[simulation]
duration = "1 ms"
scheme = "central difference"
"""


def test_a_scenario_that_starts_in_equilibrium_can_be_swept(tmp_path):
    (tmp_path / "drawn.toml").write_text(DRAWN, encoding="utf-8")
    grid = st.Grid({"amplitude": [1e-7, 2e-7], "friction": [0.1, 0.2]})
    found = st.sweep(tmp_path / "drawn.toml", grid, {"swing": lambda run: float(np.ptp(run.slip_velocity.values))})
    assert set(found.message.values.ravel()) == {""}
    one, two = found.swing.values
    np.testing.assert_allclose(two, 2.0 * one, rtol=0.05)


def test_a_run_continues_from_a_start_in_equilibrium():
    system = starting(dragged(bar().at(0.17)))
    whole = st.simulate(system, 2e-3, scheme=EXPLICIT, probes=[])
    half = st.simulate(system, 1e-3, scheme=EXPLICIT, probes=[])
    rest = st.simulate(system, 1e-3, scheme=EXPLICIT, probes=[], start=half)
    np.testing.assert_array_equal(rest.normal_force, whole.normal_force[-len(rest.time) :])
    again = st.load_scenario(half).simulate()
    np.testing.assert_array_equal(again.normal_force, half.normal_force)


def test_an_open_equilibrium_hangs_still():
    mass = st.PointMass(2.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=1.0), gap=0.03, friction=st.Coulomb(0.3))
    system = st.System(contact, [st.Gravity(10.0)], [st.Spring(mass.centre, stiffness=1e3, direction="y")])
    with pytest.raises(ValueError, match="contact 1 is lifted off: press it down, or status='separated' starts it"):
        st.simulate(starting(system), 1e-3)
    probe = st.Displacement(mass.centre, "y")
    run = st.simulate(starting(system, status="separated"), 0.1, scheme=EXPLICIT, probes=[probe])
    assert (run.status == 0).all()
    np.testing.assert_allclose(run.displacement, -0.02, rtol=1e-12)
    near = replace(system, contact=replace(contact, gap=0.019))
    with pytest.raises(ValueError, match=r"gap must leave the bodies apart at the start, got an overlap of 0\.001 m"):
        st.simulate(starting(near, status="separated"), 1e-3)


def test_a_start_at_rest_under_load_needs_the_status():
    """A rod on a floor under its weight, held: nothing moves, and its support has full force from the first step."""
    slider = rod()
    contact = st.PointContact(slider.tip, st.RigidTrack(), friction=st.Coulomb(0.5))
    system = st.System(contact, [st.Gravity(), st.Force(slider.root, x=0.1)])
    with pytest.raises(ValueError, match="is held by friction: status='sticking' starts it so"):
        st.simulate(starting(system), 1e-3)
    run = st.simulate(starting(system, status="sticking"), 0.01, scheme=EXPLICIT, probes=[])
    assert (run.status == 1).all()
    np.testing.assert_allclose(run.normal_force, slider.total_mass * 9.80665, rtol=1e-9)
    np.testing.assert_allclose(run.tangential_force, 0.1, rtol=1e-9)


def test_a_given_slip_velocity_is_that_of_the_start():
    slider = rod()
    contact = st.PointContact(slider.tip, bar(), at=0.17, friction=st.Stribeck(0.3, 0.2, 0.1))
    system = st.System(contact, [st.Force(slider.root, x=-1.0, y=-2.0)])
    run = st.simulate(starting(system, velocity=-0.2), 1e-3, scheme=EXPLICIT, probes=[])
    theory = st.sliding_stability(system, velocity=-0.2)
    assert float(theory.slip_acceleration) < 0.0
    expected = -0.2 + float(theory.slip_acceleration) * (run.time - 0.5 * run.attrs["sample_interval"])
    np.testing.assert_allclose(run.slip_velocity, expected, rtol=1e-3)
    np.testing.assert_allclose(run.normal_force, 2.0, rtol=1e-2)


def lifted() -> st.System:
    slider = rod()
    contact = st.PointContact(slider.tip, bar(), at=0.17, friction=st.Coulomb(0.3))
    return st.System(contact, [st.Force(slider.root, y=2.0)])


def rising() -> st.System:
    slider = rod(root_support="clamped")
    contact = st.PointContact(slider.tip, st.RigidTrack(velocity=0.7, normal_velocity=0.1))
    return st.System(contact, [st.Force(slider.tip, y=-5.0)])


def jammed() -> st.System:
    slider = rod(40.0, root_support="pinned")
    contact = st.PointContact(slider.tip, st.RigidTrack(velocity=0.7), friction=st.Coulomb(0.9))
    return st.System(contact, [st.Force(slider.tip, y=-5.0)])


@pytest.mark.parametrize(
    ("make", "words", "message"),
    [
        (lifted, {}, "initial equilibrium must slide, got one in which contact 1 is lifted off: press it down"),
        (lifted, {"status": "sliding"}, "status must leave contact 1 open, which would pull with 2 N"),
        (jammed, {}, "initial equilibrium must slide, got one in which contact 1 is jammed"),
        (jammed, {"status": "sliding"}, "contact 1 is jammed"),
        (mass_on_a_belt, {"velocity": 0.1}, "velocity must be left out: drives and tracks prescribe the slip"),
        (mass_on_a_belt, {"mode": 5, "amplitude": 1e-6}, "mode must be below 1, the number of modes, got 5"),
        (mass_on_a_belt, {"status": ["sliding", "sliding"]}, "status must have one value for each contact, 1 in all"),
        (
            lambda: dragged(st.RigidTrack(), velocity=0.0),
            {"velocity": 0.1},
            "velocity must be one at which bodies move",
        ),
        (lambda: dragged(st.RigidTrack(), velocity=0.0), {}, "contact 1 is held by friction"),
        (rising, {}, "drives must let bodies follow the motion along the normal of contact 1"),
        (mass_on_a_belt, {"status": "sticking"}, "status must let contact 1 slide: nothing can follow its track"),
        (
            pushed,
            {"status": "sticking"},
            "status must let contact 1 slide, which would stick with 1 N of at most 0.6 N",
        ),
    ],
)
def test_a_start_without_equilibrium_is_refused_in_one_line(make, words, message):
    with pytest.raises(ValueError, match=message) as caught:
        st.simulate(starting(make(), **words), 1e-3)
    assert "\n" not in str(caught.value)
