"""A railway wheel that squeals: modes, energy from falling friction, waves in rolling, growth, limit cycle."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.signal import butter, hilbert, sosfiltfilt

import stridula as st
from stridula import analysis
from stridula.linear.reach import modes_at_rest

from .mode_coupling import flutter

RADIUS, LOAD, CREEP = 0.46, 5e4, 0.1
STANDING = {"turning": 0.0, "contacts.0.surface_velocity.1": 0.0}
LATERAL = "contacts.0.surface_velocity.0"


def wheel(**changes: Any) -> st.System:
    return st.load_scenario("wheel", changes).system


def axial(body: st.AxisymmetricBody, order: int) -> tuple[float, np.ndarray]:
    """Frequency of the first pair of an order, and displacements of the tread across and along the axis."""
    pair = [int(np.flatnonzero((body.numbers == (order, 0, side)).all(axis=1))[0]) for side in (0, 1)]
    rows = body.trace((RADIUS, -np.pi / 2.0, 0.0))[:, pair]
    return float(body.modes().frequency[pair[0]]), np.abs(rows[1:]).max(axis=1)


def near(system: st.System, frequency: float) -> np.ndarray:
    """Exponents near a frequency that hardly decay, the fastest growing first."""
    theory = st.sliding_stability(system)
    found = theory.growth_rate.values + 2j * np.pi * theory.frequency.values
    found = found[(np.abs(theory.frequency.values / frequency - 1.0) < 0.02) & (found.real > -4.0)]
    return found[np.argsort(-found.real)]


def test_its_rim_has_the_axial_modes_of_wheels_of_its_size():
    """Those of two to four nodal diameters, no nodal circle, lie near 0.4, 1 and 1.8 kHz (Thompson 2009)."""
    body = wheel().contact.tip.body
    assert 300.0 < body.total_mass < 400.0
    for order, around in ((2, 400.0), (3, 1000.0), (4, 1800.0)):
        frequency, (upwards, sideways) = axial(body, order)
        assert frequency == pytest.approx(around, rel=0.15)
        assert sideways > 3.0 * upwards


@pytest.mark.parametrize("order", [2, 3, 4, 5])
def test_falling_friction_feeds_the_mode_as_in_the_formula(order):
    """``a = -N mu'`` pushes by ``a Z / (Z - a)`` times the velocity of the rim, Z the impedance of the rail sideways.

    At the same coefficient without a fall the load alone changes the growth.
    """
    system = wheel(**STANDING)
    law = system.contact.friction
    frequency, (_, sideways) = axial(wheel().contact.tip.body, order)
    w = 2.0 * np.pi * frequency
    fall = LOAD * (law.static - law.kinetic) / law.velocity * np.exp(-CREEP / law.velocity)
    rail = 1.1e5 + 1j * (20.0 * w - 2e7 / w)
    coefficient = float(law.coefficient_at(CREEP))
    constant = wheel(**STANDING, **{"friction.law": "coulomb", "friction.coefficient": coefficient})
    gained = near(system, frequency)[0].real - near(constant, frequency)[0].real
    assert gained == pytest.approx(0.5 * sideways**2 * (fall * rail / (rail - fall)).real, rel=0.08)


@pytest.mark.parametrize("order", [3, 4, 5])
def test_rolling_splits_a_pair_into_two_waves_that_share_its_growth(order):
    """Turning couples both modes by the drag d: ``mean + sqrt(half the difference² - d²)`` of their exponents.

    Standing, one of them passes the contact with its antinode and grows, the other with its node.
    """
    body = wheel().contact.tip.body
    frequency, _ = axial(body, order)
    fed, other = near(wheel(**STANDING), frequency)[:2]
    turning = body.modes().turning
    first = int(np.flatnonzero((body.numbers == (order, 0, 0)).all(axis=1))[0])
    drag = turning.velocity * turning.drag[[pair[0] for pair in turning.pairs].index(first)]
    split = np.sqrt((fed - other) ** 2 / 4.0 - drag**2)
    waves = sorted([(fed + other) / 2.0 + split, (fed + other) / 2.0 - split], key=lambda one: one.imag)
    found = sorted(near(wheel(), frequency)[:2], key=lambda one: one.imag)
    np.testing.assert_allclose([one.real for one in found], [one.real for one in waves], rtol=0.02)
    np.testing.assert_allclose([one.imag for one in found], [one.imag for one in waves], rtol=3e-4)
    # Negative control: without the coupling one of them would not grow.
    assert other.real < 0.0
    assert min(one.real for one in found) > 10.0


def test_nothing_slips_along_the_rail():
    theory = st.sliding_stability(wheel())
    np.testing.assert_allclose(theory.slip_velocity.values.ravel(), [-CREEP, 0.0], atol=1e-12)
    assert float(theory.normal_force.squeeze()) == pytest.approx(LOAD)


def test_a_survey_of_creep_has_growth_in_time_and_the_mode_lives():
    found = st.squeal_survey("wheel", {LATERAL: [0.1, 0.3, 0.6]}, highest=358.0).isel(mode=0)
    assert (np.diff(found.growth_rate) < 0.0).all()
    np.testing.assert_allclose(found.seen_growth_rate, found.growth_rate, rtol=0.02)
    np.testing.assert_allclose(found.seen_frequency, found.frequency, rtol=1e-3)
    assert set(found.fate.values) == {"lives"}
    # Negative control: the eigenvalue of the next creep is another one.
    assert (np.abs(found.seen_growth_rate.values[:-1] / found.growth_rate.values[1:] - 1.0) > 0.2).all()


def test_a_stiff_contact_has_the_reach_of_a_rigid_one():
    rigid = flutter(0.9)
    stiff = replace(rigid, contact=replace(rigid.contact, stiffness=1e13))
    start = st.InitialEquilibrium(status="sliding")
    reach = [modes_at_rest(system, start).reach for system in (rigid, stiff)]
    assert [len(one) for one in reach] == [1, 1]
    assert [*reach[1].values()] == pytest.approx([*reach[0].values()], rel=1e-3)


def test_the_shipped_case_squeals_as_a_wave_against_the_turning():
    """The rim moves sideways about as fast as it creeps; relative to the rail the wave is slower than in the wheel."""
    case = st.load_scenario("wheel")
    body = case.system.contact.tip.body
    probes = [st.Velocity(body.at((RADIUS, angle, 0.0)), "z") for angle in (-np.pi / 2.0, -np.pi / 4.0)]
    run = case.simulate(probes=probes, sample_rate=5e4)
    assert analysis.regime_of(run)["regime"] == "squeal"
    late = run.velocity.values[run.time.values > 0.4]
    spectrum = np.abs(np.fft.rfft(late[:, 0] * np.hanning(len(late)), 1 << 20))
    tone = float(np.fft.rfftfreq(1 << 20, 2e-5)[spectrum.argmax()])
    frequency, _ = axial(body, 2)
    assert 0.96 * frequency < tone < 0.99 * frequency
    assert CREEP < np.abs(late[:, 0]).max() < 2.0 * CREEP
    band = butter(4, [0.8 * tone, 1.2 * tone], "bandpass", fs=5e4, output="sos")
    here, further = (hilbert(sosfiltfilt(band, one))[2500:-2500] for one in late.T)
    # exp(i (w t - n angle)) is ahead with the turning.
    ahead, back = (np.abs(here + sign * 1j * further).mean() for sign in (1.0, -1.0))
    assert back > 3.0 * ahead


def test_growth_that_faster_modes_hide_is_left_out():
    """Nonlinear friction excites faster growing modes than the one on top; the remaining growth agrees with theory."""
    found = st.squeal_survey("wheel", {LATERAL: [0.2]}, highest=1010.0).squeeze()
    seen = found.seen_growth_rate.values
    assert np.isnan(seen).any()
    good = ~np.isnan(seen)
    assert good.sum() >= 2
    np.testing.assert_allclose(seen[good], found.growth_rate.values[good], rtol=0.02)
