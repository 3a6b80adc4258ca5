"""Every law of friction in motion: steady sliding, order in time, independence of the step, stick-slip."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st
from physics.cases import SCHEME_NAMES, SCHEMES
from physics.own_friction import Polymer
from stridula.verification.systems.on_belts import Slider, rubbing_of

BOTH = pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
LOAD = 5.0
STIFFNESS = 3e3
LAWS = {
    "coulomb": st.Coulomb(0.4),
    "static and kinetic": st.StaticKinetic(0.6, 0.4),
    "stribeck": st.Stribeck(0.6, 0.35, 0.2, 1.5, 0.3),
    "exponential": st.ExponentialWeakening(0.6, 0.35, 0.2),
    "linear": st.LinearWeakening(0.6, 0.3, 0.2),
    "tabulated": st.TabulatedFriction([0.0, 0.1, 0.2, 0.5, 1.0, 2.0], [0.5, 0.42, 0.38, 0.3, 0.32, 0.35], 0.6),
    "own": Polymer(0.3, 0.2, 0.05),
    "bristles": st.LuGre(0.6, 0.4, 0.2, 3e2, 1.0, 0.3),
    "aging": st.RateAndState(0.5, 0.02, 0.012, 1e-3, 1e-2),
    "slip": st.RateAndState(0.5, 0.012, 0.02, 2e-3, 1e-2, "slip"),
}


def on_a_belt(law, belt, dashpot, x=0.0, velocity=0.0) -> Slider:
    """A mass on a belt, held by a spring and a dashpot."""
    return Slider(0.4, STIFFNESS, LOAD, law, x, velocity, belt, dashpot=dashpot)


@BOTH
@pytest.mark.parametrize("belt", [0.03, -0.3, 1.5])
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_steady_sliding_is_on_the_curve_of_the_law(law, belt, scheme):
    """A mass held against a belt by a strong dashpot comes to rest: tangential over normal force is the law's.

    The tip slides towards -x along a belt that moves to +x; the force on the track has the sense of the slip.
    """
    run = st.simulate(on_a_belt(law, belt, 200.0).system(), 1.5, scheme=scheme, step=1e-4, sample_rate=1e3, probes=[])
    last = run.isel(time=-1)
    assert float(last.slip_velocity) == pytest.approx(-belt, rel=1e-6)
    ratio = float(last.tangential_force / last.normal_force)
    assert ratio == pytest.approx(-np.sign(belt) * float(law.coefficient_at(belt)), rel=1e-6)
    assert float(last.normal_force) == pytest.approx(LOAD, rel=1e-12)


def test_steady_sliding_distinguishes_the_laws():
    """Negative control: no two laws of the table are the same at 0.3 m/s, and the curves depend on the velocity."""
    ratios = [float(law.coefficient_at(0.3)) for law in LAWS.values() if not isinstance(law, st.StaticKinetic)]
    assert min(abs(a - b) for n, a in enumerate(ratios) for b in ratios[:n]) > 1e-3


def error(law, scheme, step, duration=0.04):
    """Error of position and friction's loss at the end of a smooth slide, relative to their size."""
    belt, dashpot = 1.0, 2.0
    slider = on_a_belt(law, belt, dashpot, x=1e-3, velocity=0.05)
    run = slider.run(duration, step, scheme)
    assert np.all(run.status == 2)
    state = law.slip_distance / law.velocity if isinstance(law, st.RateAndState) else 0.0
    start = [1e-3, 0.05 - belt, state]
    # The curvature of a table jumps at its points, which long steps of the solver would not notice.
    longest = duration / 400
    exact = solve_ivp(slider.rates(), (0, duration), start, rtol=1e-12, atol=1e-15, method="DOP853", max_step=longest)
    return abs(float(run.contact_position[-1]) - exact.y[0, -1]) / np.abs(exact.y[0]).max()


@BOTH
@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_order_in_smooth_sliding_is_at_least_two(law, scheme):
    if isinstance(scheme, st.ExactModal) and isinstance(law, (st.Coulomb, st.StaticKinetic)):
        # A constant force is exact.
        assert error(law, scheme, 4e-4) < 1e-12
        return
    order = np.log2(error(law, scheme, 1e-5) / error(law, scheme, 5e-6))
    assert order > 1.9


class LateVelocity(st.CentralDifference):
    """Declared of second order, but damped by the backward difference of the increments."""

    def coupled_coefficients(self, stiffness, damping, step):
        k = super().coupled_coefficients(stiffness, 0 * damping, step)
        return type(k)(b=k.b - step * damping, r=k.r, load=k.load)

    def coefficients(self, angular, damping, step):
        k = super().coefficients(angular, 0 * damping, step)
        return type(k)(b=k.b - 2 * damping * angular * step, r=k.r, load=k.load)


@pytest.mark.parametrize("law", [LAWS["coulomb"], LAWS["stribeck"]])
def test_harness_rejects_a_first_order_scheme(law):
    """Negative control."""
    assert np.log2(error(law, LateVelocity(), 2e-4) / error(law, LateVelocity(), 1e-4)) < 1.5


def explicit_bristles(law, belt, step, duration):
    """The same mass under LuGre's law by explicit Euler for the bristles and semi-implicit Euler for the mass."""
    x = v = z = 0.0
    peak, rubbing = 0.0, rubbing_of(law)
    for _ in range(round(duration / step)):
        ratio, rate = rubbing(v - belt, z)
        z += step * rate
        v += step * (-STIFFNESS * x - 20.0 * v - ratio * LOAD) / 0.4
        x += step * v
        peak = max(peak, abs(z))
        if not abs(v) < 1e3:
            return np.inf
    return peak


STIFF = st.LuGre(0.6, 0.4, 0.2, 3e6, 0.0)


def test_bristles_do_not_depend_on_the_step():
    """Bristles of 2e-7 m, crossed in 1 us, at steps of 1e-4 to 1e-5 s: the same deflection and force to 1 %.

    Negative control: explicit Euler needs steps below 2 g / stiffness |v|, 1.3 us here, and blows up at these.
    """
    deflections, forces = [], []
    for step in (1e-4, 3e-5, 1e-5):
        run = st.simulate(on_a_belt(STIFF, 0.3, 20.0).system(), 0.03, step=step, sample_rate=1 / step, probes=[])
        settled = run.isel(time=slice(int(0.01 / step), None))
        deflections.append(np.abs(settled.friction_state.values).max())
        forces.append(float(settled.tangential_force[-1]))
        assert explicit_bristles(STIFF, 0.3, step, 0.03) > 10 * deflections[-1]
    assert np.ptp(deflections) < 0.01 * deflections[0]
    assert np.ptp(forces) < 0.01 * abs(forces[0])
    assert explicit_bristles(STIFF, 0.3, 2e-7, 0.002) < 1.1 * STIFF.static / STIFF.stiffness


def test_the_state_does_not_depend_on_the_step():
    """A slip distance of 1 um crossed in 3 us, at steps ten and a hundred times as long: the state is D / |v|."""
    law = st.RateAndState(0.5, 0.02, 0.012, 1e-6, 1e-2)
    for step in (3e-4, 3e-5):
        run = st.simulate(on_a_belt(law, 0.3, 200.0).system(), 1.2, step=step, sample_rate=1 / step, probes=[])
        slip = np.abs(run.slip_velocity.values[-1])
        assert run.friction_state.values[-1] == pytest.approx(1e-6 / slip, rel=1e-6)
        ratio = float(run.tangential_force[-1] / run.normal_force[-1])
        assert ratio == pytest.approx(-float(law.coefficient_at(slip)), rel=1e-3)


@BOTH
def test_a_viscous_law_takes_the_energy_of_the_slide(scheme):
    """Friction's loss over a slide is the integral of ratio x load x slip speed, to second order."""
    law = LAWS["stribeck"]
    run = st.simulate(on_a_belt(law, 1.0, 2.0).system(), 0.1, scheme=scheme, step=1e-4, sample_rate=1e4, probes=[])
    speed = np.abs(run.slip_velocity.values)
    # A constant speed within a step, whose mean is that of the two velocities around it.
    expected = np.cumsum(law.coefficient_at(speed) * LOAD * speed * 1e-4)
    # The contact forces begin half a step into the first one.
    lost = run.friction_loss.values
    np.testing.assert_allclose(lost[1:] - lost[0], expected[1:] - expected[0], rtol=1e-3)


@BOTH
def test_stick_slip_of_a_static_and_a_kinetic_coefficient(scheme):
    """The textbook's mass on a slow belt: it sticks until k x = mu_s N, then swings by mu_k N / k +- amplitude.

    In the slide from x_s = mu_s N / k at the belt's velocity V: m x'' = -k x + mu_k N until x' = V again. Without
    damping the amplitude about mu_k N / k is sqrt(((mu_s - mu_k) N / k)² + (V / w)²).
    """
    law, belt = st.StaticKinetic(0.6, 0.4), 0.02
    run = st.simulate(on_a_belt(law, belt, 1e-9).system(), 1.0, scheme=scheme, step=2e-5, sample_rate=5e4, probes=[])
    x, status = run.contact_position.values, run.status.values
    middle, angular = 0.4 * LOAD / STIFFNESS, np.sqrt(STIFFNESS / 0.4)
    amplitude = np.hypot(0.2 * LOAD / STIFFNESS, belt / angular)
    late = slice(x.size // 2, None)
    assert {1, 2} == set(status[late])
    # A break may be late by the travel of one step.
    assert x[late].max() == pytest.approx(middle + amplitude, rel=1e-3)
    assert x[late].min() == pytest.approx(middle - amplitude, rel=3e-3)
    breaks = np.flatnonzero((status[:-1] == 1) & (status[1:] == 2))
    np.testing.assert_allclose(x[breaks[breaks > x.size // 2]], 0.6 * LOAD / STIFFNESS, rtol=2e-3)
