"""Observed order of the schemes on smooth motions with a closed form, and the exactness of the exact modal one."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from physics.cases import SCHEME_NAMES, SCHEMES, pair, slider, track
from stridula.verification.systems.smooth import DURATION, forced_track, motion, thrown_slider


def error(case, scheme, step) -> float:
    """Relative error of the modal positions of a body at the end."""
    run = st.simulate(case.system, DURATION, scheme=scheme, step=step, sample_rate=1 / step)
    assert np.all(run.status == 0)
    first = 0 if case.body == case.system.slider else case.system.slider.modes().count
    got = run.state_modal.values[0, first : first + case.modal.size]
    return float(np.linalg.norm(got - case.modal) / np.linalg.norm(case.modal))


def observed_order(case, scheme) -> float:
    # The highest mode (12.9 kHz axial of the track, 3 kHz of the slider) at 1 and 0.5 us: (w h)² < 0.01.
    return float(np.log2(error(case, scheme, 1e-6) / error(case, scheme, 5e-7)))


@pytest.mark.parametrize("case", [forced_track, thrown_slider])
@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
def test_order_is_two(scheme, case):
    assert observed_order(case(), scheme) == pytest.approx(2.0, abs=0.1)


class LazyStart(st.CentralDifference):
    """Central differences that forget the force in the first increment: a velocity off by f h / 2, of first order."""

    def first_increment(self, angular, rate, step, position, velocity, force):
        return super().first_increment(angular, rate, step, position, velocity, 0 * force)


class OneSided(st.CentralDifference):
    """Damping by a backward difference, of first order."""

    def coefficients(self, angular, rate, step):
        k = super().coefficients(angular, rate, step)
        return type(k)(
            b=1 - rate * step,
            r=(angular * step) ** 2,
            load=step**2 + 0 * angular,
        )


@pytest.mark.parametrize(
    ("wrong", "case"), [(LazyStart, thrown_slider), (LazyStart, forced_track), (OneSided, forced_track)]
)
def test_harness_rejects_a_first_order_scheme(wrong, case):
    """Negative control."""
    assert observed_order(case(), wrong()) < 1.5


@pytest.mark.parametrize("fraction", [0.03, 0.2, 0.9])
def test_exact_scheme_is_exact_for_free_damped_motion(fraction):
    """Thrown up with every mode above zero frequency ringing; at any step below the limit, to round-off.

    A free body thrown as a whole does not ring: a pinned root makes it. Error of the exact coefficients: eps a step,
    and the phase adds up, n eps with n < 1e4 steps.
    """
    rod = slider(25.0, root_support="pinned", damping=0.01)
    system = pair(lambda _: [st.InitialVelocity(rod, x=0.1, y=0.4)], 0.5, rod=rod, bar=track(cutoff=500.0), gap=1.0)
    modes = rod.modes()
    limit = st.ExactModal().limit(modes.angular_frequency, modes.damping_rate)
    step = DURATION / np.ceil(DURATION / (fraction * limit))
    run = st.simulate(system, DURATION, scheme=st.ExactModal(), step=step, sample_rate=1 / step)
    v = modes.translation.T @ [0.1, 0.4]
    expected = motion(modes.angular_frequency, modes.damping, 0 * v, v, DURATION)
    got = run.state_modal.values[0, : modes.count]
    assert np.linalg.norm(got - expected) <= 1e4 * 2.3e-16 * np.linalg.norm(expected)
    central = st.CentralDifference()
    if step < 0.9 * central.limit(modes.angular_frequency, modes.damping_rate):
        other = st.simulate(system, DURATION, scheme=central, step=step, sample_rate=1 / step)
        off = other.state_modal.values[0, : modes.count] - expected
        assert np.linalg.norm(off) > 1e-6 * np.linalg.norm(expected), "control: central differences are not exact"


def test_constant_force_moves_the_rest_point_exactly():
    """Static deflection under a constant force, both schemes, once the ringing is damped out: f / w² in every mode."""
    bar = track(damping=0.5, cutoff=2e3)
    for scheme in SCHEMES:
        system = pair(lambda _: [st.Force(bar.at(0.3), y=1.0)], 0.5, bar=bar, gap=1.0)
        run = st.simulate(system, 0.5, scheme=scheme, step=1e-5)
        count = system.slider.modes().count
        rest = bar.trace(0.3)[1] / bar.modes().angular_frequency ** 2
        np.testing.assert_allclose(run.state_modal.values[0, count:], rest, rtol=1e-9, atol=1e-12 * rest.max())
