"""Contact forces move bodies as loads do; contact, stick and reversals are timed to second order.

With default steps unless stated otherwise.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stridula as st
from stridula._kernels.contact import exact as contact
from stridula._kernels.layout import columns as layout
from stridula._kernels.layout.contact_values import Before, Compliance, Free, Law
from stridula.verification.prony import exponents
from stridula.verification.systems import mode_coupling
from stridula.verification.systems.on_belts import Slider, den_hartog, swing

from .cases import SCHEME_NAMES, SCHEMES
from .sliding_systems import bar, dragged

BOTH = pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
SEPARATED, STICKING, SLIDING = 0, 1, 2
MASS = st.PointMass(1.0)


def rubbed(*joints, friction=0.3, belt=1.0) -> st.System:
    """A mass of 1 kg pressed with 10 N on a belt, on joints."""
    track = st.RigidTrack(velocity=belt)
    touch = st.PointContact(MASS.centre, track, friction=st.Coulomb(friction))
    return st.System(touch, [st.Force(MASS.centre, y=-10.0)], joints)


@BOTH
@pytest.mark.parametrize("coupled", [False, True])
def test_a_mass_on_a_spring_rests_where_friction_holds_it(coupled, scheme):
    """At mu N / k; it was at (wh/2) / tan(wh/2) of that, -2.1 %, under exact modes."""
    joints = [st.Spring(MASS.centre, stiffness=100.0), st.Dashpot(MASS.centre, coefficient=4.0)]
    if coupled:
        other = st.PointMass(0.3)
        between = st.Spring(MASS.centre, other.centre, stiffness=500.0)
        joints += [between, st.Spring(other.centre, stiffness=50.0), st.Dashpot(other.centre, coefficient=1.0)]
    system, probe = rubbed(*joints), st.Displacement(MASS.centre, "x")
    run = st.simulate(system, 30.0, scheme=scheme, sample_rate=5.0, probes=[probe])
    stiffness = 100.0 + (500.0 * 50.0 / 550.0 if coupled else 0.0)
    assert float(run.displacement[-1, 0]) == pytest.approx(3.0 / stiffness, rel=1e-12)


def growing(system, probe, duration, rate, scheme):
    """Exponent of the most unstable mode, and the one seen at the default step."""
    drives = [drive for drive in system.drives if not isinstance(drive, st.InitialState)]
    theory = st.sliding_stability(system)
    fastest = int(np.argmax(theory.growth_rate.values))
    moved = []
    for words in ({}, {"mode": "most unstable", "amplitude": 1e-9}):
        start = replace(system, drives=[*drives, st.InitialEquilibrium(**words)])
        run = st.simulate(start, duration, scheme=scheme, sample_rate=rate, probes=[probe])
        assert (run.status == SLIDING).all()
        moved.append(run.displacement.values)
    known = complex(theory.growth_rate[fastest], 2.0 * pi * theory.frequency[fastest])
    return known, complex(exponents(moved[1] - moved[0], 1.0 / rate, 1.0 / abs(known), 1)[0])


@pytest.mark.parametrize("friction", [0.76, 0.9])
def test_a_light_foot_grows_at_the_default_step_as_theory_says(friction):
    """Hoffmann's mass over a foot that weighs nothing: growth was 87 % too fast just above the onset."""
    system = mode_coupling.hoffmann().system(friction)
    known, seen = growing(system, st.Displacement(system.slider.at("mass"), "x"), 20.0, 50.0, st.ExactModal())
    assert seen.real == pytest.approx(known.real, rel=1e-3)
    assert seen.imag == pytest.approx(known.imag, rel=1e-3)


def test_a_pair_of_beams_grows_at_the_default_step_as_theory_says():
    """Flutter at 561 Hz; the highest modes kept, at 12 kHz, set the step."""
    track = bar(12e3, damping=0.002)
    system = dragged(track.at(0.17), degrees=-45.0, friction=1.0, elements=6, damping=0.002, cutoff=12e3)
    known, seen = growing(system, st.Displacement(track.at(0.17), "y"), 8e-3, 20e3, st.ExactModal())
    assert known.real > 100.0
    assert seen.real == pytest.approx(known.real, rel=1e-3)
    assert seen.imag == pytest.approx(known.imag, rel=1e-3)


# A mass that turns round.


@BOTH
@pytest.mark.parametrize(("frequency", "friction"), [(0.8, 0.2), (1.3, 0.4)])
def test_reversals_are_of_second_order(frequency, friction, scheme):
    """Whole numbers of steps a period, to which it would lock; 1e-4 at T/400 took T/16000."""
    expected = den_hartog(frequency, friction)
    errors = [abs(swing(frequency, friction, steps, scheme) / expected - 1.0) for steps in (100, 400, 800)]
    assert errors[1] < 1e-4
    assert np.log2(errors[0] / errors[2]) / 3.0 == pytest.approx(2.0, abs=0.4)
    assert abs(swing(frequency, friction, 401.7, scheme) / expected - 1.0) < 1e-4


def test_the_previous_slip_decides_on_a_reversal():
    """Negative control: the same push on a contact that was open has friction of one sense for the whole step."""
    free = Free(-1e-3, -1e-3, 0.0, Compliance(1e-4, 0.0, 0.0, 1e-4), 0.0)
    law = Law(layout.COULOMB, np.array([[0.3] + [0.0] * 7]), 0, 0.3, 0.0)
    forces = []
    for status in (SLIDING, SEPARATED):
        before = Before(float(status), 2e-3, 2e-3, 0.0, 0.0, 0.0, 0.0)
        forces.append(contact.solve_contact.py_func(free, law, before, 1e-2).tangential)
    assert forces[1] == pytest.approx(-3.0)
    assert abs(forces[0]) < 2.9


# Time in contact and in stick.


@BOTH
def test_time_in_contact_is_of_second_order(scheme):
    """A mass on a floor shaken by 1.2 g: it leaves when the floor falls faster, and lands after a parabola.

    Whole steps, which `status` counts, are a step too many each time.
    """
    fall, frequency, angular = 9.81, 30.0, 2.0 * pi * 30.0
    size = 1.2 * fall / angular**2
    leaves = np.arcsin(1.0 / 1.2) / angular

    def above(t):
        flown = t - leaves
        rise = size * (np.sin(angular * leaves) + angular * np.cos(angular * leaves) * flown)
        return rise - fall * flown**2 / 2.0 - size * np.sin(angular * t)

    expected = 1.0 - frequency * (brentq(above, leaves + 1e-3, leaves + 1.5 / frequency) - leaves)
    floor = st.RigidTrack(normal_velocity=size * angular, normal_history=st.Harmonic(frequency, phase=pi / 2.0))
    system = st.System(st.PointContact(MASS.centre, floor), [st.Gravity(fall)])
    errors, whole = [], []
    for step in (1e-3, 5e-4, 2.5e-4, 1.25e-4):
        run = st.simulate(system, 2.0, scheme=scheme, step=step, sample_rate=1.0 / step, probes=[])
        late = run.isel(time=slice(run.sizes["time"] // 2, None))
        assert late.landings.sum() == 30
        errors.append(1.0 - float(late.status_share[:, SEPARATED].mean()) - expected)
        whole.append(float((late.status != SEPARATED).mean()) - expected)
    orders = np.log2(np.abs(errors[:-1]) / np.abs(errors[1:]))
    np.testing.assert_allclose(orders, 2.0, atol=0.1)
    assert min(whole) > 0.9 * frequency * 1.25e-4


@BOTH
def test_time_in_stick_ends_where_the_force_leaves_the_cone(scheme):
    """A mass on a belt drawn against a spring sticks until k v t = mu_s N: between two steps, wherever that is."""
    law = st.StaticKinetic(0.6, 0.4)
    touch = st.PointContact(MASS.centre, st.RigidTrack(velocity=0.03), friction=law)
    drives = [st.Force(MASS.centre, y=-10.0), st.InitialVelocity(MASS, x=0.03)]
    system = st.System(touch, drives, [st.Spring(MASS.centre, stiffness=100.0)])
    for step in (1.1e-2, 7e-3):
        run = st.simulate(system, 2.2, scheme=scheme, step=step, sample_rate=1.0 / step, probes=[])
        stuck = float(run.status_share[:, STICKING].sum()) * step
        # The interval of the shares begins a step before the start.
        assert stuck == pytest.approx(2.0 + step, abs=1e-3 * step)


# Speed-dependent laws.


@BOTH
def test_stiff_friction_stops_a_mass_within_a_step(scheme):
    """Steady sliding at 1 um/s, the mass a tenth of that too fast: ``h dF/dv`` is fifty times the mass.

    The surplus decays as ``exp(-50 t / h)``, its mean over the first step is a fiftieth, and nothing rings on.
    """
    law = st.RateAndState(0.6, 0.005, 0.01, 1e-5, 1e-6)
    touch = st.PointContact(MASS.centre, st.RigidTrack(velocity=1e-6), friction=law)
    start = st.InitialState(MASS, (0.06, 0.0), (1e-7, 0.0))
    drives, spring = [st.Force(MASS.centre, y=-10.0), start], st.Spring(MASS.centre, stiffness=100.0)
    run = st.simulate(st.System(touch, drives, [spring]), 0.03, scheme=scheme, step=1e-3, sample_rate=1e3, probes=[])
    off = np.abs(run.slip_velocity.values + 1e-6)
    assert off[0] == pytest.approx(1e-7 / 50.0, rel=0.1)
    assert np.all(off[1:] < 0.03 * off[0])
    assert np.all(off[3:] < 1e-3 * off[0])


def rate_and_state(law, mass, stiffness, normal, faster, until):
    """Ratio of forces over time after the belt jumps from 1 to 10 um/s: the same equations by an implicit method."""

    def ratio(v, belt, age):
        inner = (law.reference + law.b * (age + np.log(law.velocity / law.slip_distance))) / law.a
        return law.a * np.arcsinh((belt - v) / (2.0 * law.velocity) * np.exp(inner))

    def rates(_, y):
        x, v, age = y
        force = -stiffness * x + normal * ratio(v, faster, age)
        return [v, force / mass, np.exp(-age) - abs(faster - v) / law.slip_distance]

    start = [law.reference * normal / stiffness, 0.0, np.log(law.slip_distance / law.velocity)]
    found = solve_ivp(rates, (0.0, until), start, method="Radau", rtol=1e-9, atol=1e-16, dense_output=True)
    return lambda t: ratio(found.sol(t)[1], faster, found.sol(t)[2])


@BOTH
def test_a_step_of_the_velocity_under_rate_and_state(scheme):
    """mu0 = 0.6, a = 0.005, b = 0.01, D = 10 um, k = 2 k_c, from steady sliding at 1 to 10 um/s, at steps of 1 ms.

    There ``h dF/dv`` is fifty times the mass. Before the jump nothing moves; then the ratio peaks and falls.
    """
    law, normal, jump = st.RateAndState(0.6, 0.005, 0.01, 1e-5, 1e-6), 10.0, 0.5
    stiffness = 2.0 * normal * (law.b - law.a) / law.slip_distance
    history = st.Sampled([0.0, jump, jump, 100.0], [1.0, 1.0, 10.0, 10.0])
    held = Slider(1.0, stiffness, normal, law, law.reference * normal / stiffness)
    system = held.system(st.RigidTrack(velocity=1e-6, history=history))
    run = st.simulate(system, 6.0, scheme=scheme, step=1e-3, sample_rate=1e3, probes=[])
    ratio = -(run.tangential_force / run.normal_force).values
    time = run.time.values - 1e-3 - jump
    np.testing.assert_allclose(ratio[time < -1e-9], law.reference, rtol=1e-9)
    known = rate_and_state(law, 1.0, stiffness, normal, 1e-5, 5.5)(time[time > 0.02])
    np.testing.assert_allclose(ratio[time > 0.02], known, atol=2e-6)
    assert ratio.max() == pytest.approx(known.max(), abs=1e-6)


def test_bristles_start_where_they_are_told():
    """Steady sliding of LuGre's mass: nothing moves from the first step on; straight bristles do."""
    law = st.LuGre(0.6, 0.4, 0.1, 1e4, 10.0)
    held = law.coefficient_at(0.3) / law.stiffness

    def moved(law):
        sliding = Slider(1.0, 100.0, 10.0, law, float(law.coefficient_at(0.3)) * 10.0 / 100.0, belt=0.3)
        run = sliding.run(0.05, 1e-4, st.ExactModal())
        return np.ptp(run.tangential_force.values) / 4.0

    assert moved(replace(law, initial_state=-float(held))) < 1e-9
    assert moved(law) > 0.1
