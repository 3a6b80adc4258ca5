"""Limit cycles against integration from event to event: known systems, random ones, and runs that continue them."""

from __future__ import annotations

from dataclasses import replace
from itertools import islice

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st
from stridula.verification.limit_cycles import multipliers_of, nearest
from stridula.verification.systems.cycles import DenHartog, LiftingMass, NotPeriodic, Stopped, Weakening
from stridula.verification.systems.mode_coupling import AT_CONTACT, GROUNDED

from .test_circular_paths import carried_past, on_a_circle_at, riders

BAR = 1e-3


def test_stick_slip_has_the_known_period_and_ends():
    cycle = Weakening(1.0).stick_slip()
    assert cycle.period == pytest.approx(6.431383, abs=5e-7)
    assert cycle.lowest[0] == pytest.approx(-0.577428, abs=5e-7)
    assert cycle.highest[0] == pytest.approx(1.788131, abs=5e-7)


def test_the_unstable_cycle_about_sliding_has_the_known_multiplier():
    belt = Weakening(1.2)
    cycle = belt.around_sliding(0.3, 0.5)
    assert cycle.highest[0] - belt.equilibrium == pytest.approx(0.457845, abs=5e-7)
    assert cycle.period == pytest.approx(6.285167, abs=5e-7)
    assert cycle.multipliers[0] == pytest.approx(1.062185, abs=5e-7)


def test_a_small_cycle_about_sliding_grows_as_linear_theory_where_sliding_loses_stability():
    """At 1.151293 m/s the growth is zero; close to it the cycle shrinks and its multiplier tends to 1."""
    known = Weakening(1.151293)
    slope = (known.static - known.kinetic) / known.velocity * np.exp(-known.belt / known.velocity)
    assert slope == pytest.approx(known.dashpot, rel=1e-6)
    cycle = Weakening(1.1515).around_sliding(0.01, 0.1)
    assert abs(cycle.multipliers[0] - 1.0) < 1e-3


def test_the_lifting_mass_has_the_known_cycle():
    mass = LiftingMass()
    growth = mass.equations().sliding()[0]
    assert growth.real == pytest.approx(0.132171, abs=5e-7)
    assert abs(growth.imag) == pytest.approx(1.422701, abs=5e-7)
    cycle = mass.cycle()
    assert cycle.period == pytest.approx(4.560150545, abs=2e-9)
    np.testing.assert_allclose(cycle.lowest, [-0.1693028, -1.1726881], atol=6e-8)
    np.testing.assert_allclose(cycle.highest, [0.0264501, 0.3022319], atol=6e-8)
    assert -mass.contact * cycle.lowest[1] == pytest.approx(1.5635841, abs=6e-8)
    assert cycle.open == pytest.approx(0.3148, abs=5e-5)
    known = np.array([0.796118, 0.164785 + 0.876906j, 0.164785 - 0.876906j])
    np.testing.assert_allclose(nearest(known, cycle.multipliers), known, atol=1e-6)


def test_masses_against_a_stop_have_the_known_motion():
    without, with_contact = Stopped(0.5).cycle(), Stopped(0.65).cycle()
    assert without.open == 1.0
    assert without.harmonic(1)[1] == pytest.approx(0.2397891, abs=6e-8)
    assert with_contact.harmonic(1)[1] == pytest.approx(0.6931117, abs=6e-8)
    assert with_contact.highest[0] == pytest.approx(1.0303033, abs=6e-8)
    known = np.array([0.430685 + 0.773329j])
    np.testing.assert_allclose(nearest(known, with_contact.multipliers), known, atol=1e-6)


def test_multipliers_under_dry_friction_are_those_of_the_equations():
    """The closed form, by differences of the motion over a period integrated from reversal to reversal."""
    rubbed = DenHartog(0.8, 0.2)
    steep = 1e5
    first, second = rubbed.multipliers
    assert first * second == pytest.approx(rubbed.product, rel=1e-12)
    assert abs(first) ** 2 == pytest.approx(rubbed.product, rel=1e-12)
    derivative = np.array([(_after(rubbed, up, steep) - _after(rubbed, -up, steep)) / 2e-4 for up in 1e-4 * np.eye(2)])
    found = np.linalg.eigvals(derivative)
    np.testing.assert_allclose(nearest(rubbed.multipliers, found), rubbed.multipliers, atol=1e-3)


def _after(rubbed: DenHartog, change: np.ndarray, steep: float) -> np.ndarray:
    """Change of place and velocity a period after one at a moment between reversals, friction steep in velocity."""
    period, w = rubbed.period, rubbed.angular
    # The force is cos p at the highest place; V and U as in `den_hartog`.
    wide = np.sin(np.pi / w) / (w * (1.0 + np.cos(np.pi / w)))
    phase = -np.arcsin(rubbed.friction * wide * (1.0 - w**2))

    def rates(time, state):
        sense = np.clip(steep * state[1], -1.0, 1.0)
        force = np.cos(w * time + phase)
        return [state[1], force - state[0] - rubbed.friction * sense]

    quarter = period / 4.0
    places = rubbed.places(quarter + 1e-4 * np.array([-1.0, 0.0, 1.0]))
    start = np.array([places[1], (places[2] - places[0]) / 2e-4])
    span = (quarter, quarter + period)
    found = solve_ivp(rates, span, start + change, method="LSODA", rtol=1e-11, atol=1e-13, max_step=1e-2)
    return found.y[:, -1] - start


def lifting(seed: int) -> LiftingMass:
    """A random mass under mode coupling."""
    draw = np.random.default_rng(seed).uniform
    grounded = tuple((stiffness * draw(0.7, 1.3), turn + draw(-0.15, 0.15)) for stiffness, turn in GROUNDED)
    return LiftingMass(draw(0.8, 1.3), AT_CONTACT * draw(0.8, 1.25), draw(0.03, 0.1), grounded, belt=20.0)


def stopped(seed: int) -> Stopped:
    """A random pair of masses, driven hard enough to reach the stop in most cases."""
    draw = np.random.default_rng(seed).uniform
    springs = (draw(0.8, 1.2), draw(0.8, 1.2))
    return Stopped(draw(0.55, 0.75), draw(0.1, 0.3), springs, draw(0.04, 0.1), draw(20.0, 100.0), draw(0.5, 1.0))


def growing():
    """Random masses whose sliding is unstable."""
    return (seed for seed in range(100) if lifting(seed).equations().sliding()[0].real > 0.02)


def touching():
    """Random pairs of masses that touch the stop in a periodic motion: a stable one, which others do not leave."""
    for seed in range(100):
        try:
            known = stopped(seed).cycle()
        except NotPeriodic:
            continue
        if known.open < 1.0 and np.abs(known.multipliers).max() < 1.0:
            yield seed


def compare(system, known) -> None:
    """Require period and multipliers of a cycle at default settings, the latter relative to 1."""
    cycle = st.limit_cycle(system)
    assert float(cycle["period"]) == pytest.approx(known.period, rel=BAR)
    np.testing.assert_allclose(nearest(known.multipliers, multipliers_of(cycle)), known.multipliers, atol=BAR)
    assert bool(cycle["stable"]) == bool(np.abs(known.multipliers).max() <= 1.0)


@pytest.mark.parametrize("seed", list(islice(growing(), 10)))
def test_random_masses_lift_off_in_the_cycle_of_the_equations(seed):
    mass = lifting(seed)
    known = mass.cycle()
    assert 0.0 < known.open < 1.0
    compare(mass.system(), known)


def test_random_masses_against_a_stop_move_as_the_equations():
    for seed in islice(touching(), 5):
        pair = stopped(seed)
        compare(pair.system(), pair.cycle())


def test_friction_one_per_cent_off_is_refused():
    """Negative control of the comparison of random masses."""
    for seed in islice(growing(), 3):
        mass = lifting(seed)
        with pytest.raises(AssertionError):
            compare(mass.system(), replace(mass, friction=1.01 * mass.friction).cycle())


@pytest.mark.parametrize(
    "known", [Weakening(1.0), LiftingMass(), Stopped(0.65), DenHartog(0.8, 0.2)], ids=lambda one: type(one).__name__
)
def test_a_run_stays_on_a_cycle_for_ten_periods(known):
    """The error of round-off, 1e-15 of the size a step, does not grow on a stable cycle."""
    system = known.system()
    probes = [st.Displacement(system.contacts[0].tip, axis) for axis in "xy"]
    cycle = st.limit_cycle(system, probes=probes, tolerance=1e-12)
    step = cycle.attrs["step"]
    run = st.simulate(
        system, 10.0 * float(cycle["period"]), start=cycle, step=step, sample_rate=1.0 / step, probes=probes
    )
    steps = cycle.sizes["time"]
    assert run.sizes["time"] == 10 * steps
    size = np.abs(cycle["displacement"].values).max()
    for number in range(10):
        period = run["displacement"].values[number * steps : (number + 1) * steps]
        np.testing.assert_allclose(period, cycle["displacement"].values, atol=1e-10 * size, rtol=0.0)


def test_a_run_leaves_an_unstable_cycle_as_fast_as_its_multiplier():
    """Control of the test above, and a test of the multiplier: a small departure grows by it in each period."""
    belt = Weakening(1.2)
    system = belt.system()
    start = st.InitialEquilibrium(mode="most unstable", amplitude=0.45)
    probes = [st.Displacement(system.contacts[0].tip, "x")]
    cycle = st.limit_cycle(system, start, probes=probes, tolerance=1e-12)
    assert not bool(cycle["stable"])
    step, steps = cycle.attrs["step"], cycle.sizes["time"]
    run = st.simulate(
        system, 500.0 * float(cycle["period"]), start=cycle, step=step, sample_rate=1.0 / step, probes=probes
    )
    places = run["displacement"].values[:, 0].reshape(500, steps)
    away = np.abs(places - cycle["displacement"].values[:, 0]).max(axis=1)
    between = (away > 1e-9) & (away < 1e-4)
    assert between.sum() > 50
    rate = np.polyfit(np.flatnonzero(between), np.log(away[between]), 1)[0]
    assert np.exp(rate) == pytest.approx(float(multipliers_of(cycle)[0].real), rel=1e-3)


def test_a_cycle_goes_round_with_a_contact_that_is_carried_round():
    """A rider carried round a disc, and a rider at rest past which the waves of the same disc are carried."""
    law = st.ExponentialWeakening(static=0.6, kinetic=0.2, velocity=0.2)
    found = []
    for track in (on_a_circle_at(0.3), carried_past(0.3)):
        system = riders(track, law)
        run = st.simulate(system, 0.4, step=4e-6, sample_rate=125e3, probes=[])
        found.append(st.limit_cycle(system, run))
    round_, past = found
    assert float(round_["period"]) == pytest.approx(float(past["period"]), rel=2e-5)
    assert bool(round_["stable"])
    assert bool(past["stable"])
    known = multipliers_of(past)[:6]
    np.testing.assert_allclose(nearest(known, multipliers_of(round_)), known, atol=1e-3)


def test_a_wheel_leaves_its_cycle_as_its_multipliers_say():
    """A run that begins on the unstable cycle, after a slight push, spirals away with the pair outside the circle."""
    system = st.load_scenario("wheel").system
    torus = st.simulate(system, 3.0)
    cycle = st.limit_cycle(system, torus)
    # From another place on the torus it is the same.
    other = st.limit_cycle(system, st.simulate(system, 0.05, start=torus))
    assert float(other["period"]) == pytest.approx(float(cycle["period"]), rel=1e-6)
    pair = multipliers_of(cycle)[0]
    assert abs(pair) > 1.001
    assert not bool(cycle["stable"])
    step, period, steps = cycle.attrs["step"], float(cycle["period"]), cycle.sizes["time"]
    tip = system.contacts[0].tip
    arguments = {"step": step, "sample_rate": 1.0 / step, "probes": [st.Displacement(tip, axis) for axis in "xyz"]}
    contact = replace(system.contact, friction=replace(system.contacts[0].friction, static=0.4004))
    pushed = st.simulate(st.System(contact, system.drives, system.connections), 5.0 * period, start=cycle, **arguments)
    run = st.simulate(system, 900.0 * period, start=pushed, **arguments)
    apart = run["displacement"].values[steps - 1 :: steps, 2] - cycle["displacement"].values[-1, 2]
    apart = apart[300:]
    # The pair obeys x[n+2] = 2 Re(pair) x[n+1] - |pair|^2 x[n], beside a drift along the cycle.
    numbers = np.arange(len(apart) - 2)
    known = np.stack([apart[1:-1], apart[:-2], np.ones(len(numbers)), numbers], axis=1)
    first, second, *_ = np.linalg.lstsq(known / np.abs(known).max(axis=0), apart[2:])[0] / np.abs(known).max(axis=0)
    assert np.sqrt(-second) == pytest.approx(abs(pair), abs=2e-4)
    assert np.arccos(0.5 * first / np.sqrt(-second)) == pytest.approx(abs(np.angle(pair)), rel=3e-3)
