"""The compiled march against its slow twin, step by step.

Both follow the same equations by different arithmetic: increments against two positions, closed contact solve against
trial of every state. The two-position form with ``1 - a + b`` computed by cancellation has a relative error of
``eps / (w h)² ~ 2e-16 / (2 pi 50 x 5e-6)² = 1e-10`` on the lowest bending mode, and a contact force follows from a gap
that is a difference of positions some 10 to 1000 times larger: 1e-8 holds for positions and energies, 1e-6 of
the peak for forces. A start perturbed by 1e-9 of the gap moves the forces by 1e-9 to 3e-8 over the same steps: no
chaos yet.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physics.cases import CASES, SCHEMES, STEP, every_step

import stridula as st
from kernels import twin
from stridula._kernels.layout import columns as layout
from stridula.lowering.blocks import Recurrence

STEPS = 1500
BOTH = [pytest.param(SCHEMES[0], twin.central, id="central"), pytest.param(SCHEMES[1], twin.exact, id="exact")]
COLUMNS = {
    "normal_force": ("normal", 1e-6),
    "tangential_force": ("tangential", 1e-6),
    "contact_position": ("position", 1e-10),
    "contact_height": ("height", 1e-8),
    "kinetic_and_elastic": ("stored", 1e-8),
    "drive_work": ("drive", 1e-8),
    "contact_work": ("contact", 1e-6),
    "friction_loss": ("friction", 1e-6),
    "convection_work": ("convection", 1e-6),
    "damping_loss": ("damping", 1e-8),
}


def early(name: str) -> st.System:
    """The case with a gap of 10 nm, so that contact begins within the steps compared."""
    system = CASES[name]()
    return replace(system, contact=replace(system.contact, gap=1e-8))


def disagreements(run, trail) -> dict[str, float]:
    """Largest difference of each recorded column over its peak, relative to its tolerance, where above 1."""
    found = {}
    for name, (attribute, tolerance) in COLUMNS.items():
        expected = np.array(getattr(trail, attribute))
        off = np.abs(run[name].values - expected).max() / np.abs(expected).max()
        if off > tolerance:
            found[name] = off
    return found


@pytest.mark.parametrize(("scheme", "form"), BOTH)
@pytest.mark.parametrize("name", CASES)
def test_kernel_and_twin_agree_at_every_step(name, scheme, form):
    system = early(name)
    run, trail = every_step(system, STEPS, scheme), twin.march(system, form, STEP, STEPS)
    assert set(run.status.values) - {0}, "no contact in the steps compared: the case tests nothing"
    np.testing.assert_array_equal(run.status.values, trail.status)
    np.testing.assert_array_equal(run.landings.values, trail.landings)
    # A share is a ratio of the distances of a gap or a force from its border, down to a hundredth of the peaks of
    # COLUMNS.
    np.testing.assert_allclose(run.status_share.values, trail.share, atol=1e-4)
    assert disagreements(run, trail) == {}
    position, before = trail.last[1], trail.last[0]
    scale = np.abs(position).max()
    np.testing.assert_allclose(run.state_modal.values[0], position, atol=1e-8 * scale, rtol=0)
    # An increment is the difference of two positions: the same absolute error.
    np.testing.assert_allclose(run.state_modal.values[1], position - before, atol=1e-8 * scale, rtol=0)
    # A gap is a difference of heights: their absolute error.
    np.testing.assert_allclose(run.gap.values, trail.gap, atol=1e-8 * np.abs(trail.height).max(), rtol=0)
    assert set(trail.consistent_states) == {1}


@pytest.mark.parametrize("change", ["friction", "scheme", "lean", "gap"])
def test_comparison_rejects_a_wrong_twin(change):
    """Negative control: a small wrong number, the other scheme or the other lean must show."""
    system = early("squeal")
    run = every_step(system, STEPS, SCHEMES[1])
    contact, form = system.contact, twin.exact
    if change == "friction":
        system = replace(system, contact=replace(contact, friction=st.Coulomb(1.5 * (1 + 1e-4))))
    elif change == "gap":
        system = replace(system, contact=replace(contact, gap=1e-8 * (1 + 1e-4)))
    elif change == "scheme":
        form = twin.central
    else:
        rod = replace(system.slider, angle=-system.slider.angle)
        system = st.System(replace(contact, tip=rod.tip), [st.Force(rod.root, transverse=-0.5)])
    assert disagreements(run, twin.march(system, form, STEP, STEPS))


@pytest.mark.parametrize("scheme", SCHEMES, ids=["central", "exact"])
@pytest.mark.parametrize("name", CASES)
def test_energy_identity_holds_at_each_step(name, scheme):
    """``dE + d(damping) = d(drive) + d(contact)`` step by step, an identity of the recurrence.

    Round-off: a sum over 60 modes of terms up to the largest energy in play, 60 x 2.2e-16 < 1e-13 of it.
    """
    run = every_step(CASES[name](), STEPS, scheme)
    terms = ["kinetic_and_elastic", "damping_loss", "drive_work", "contact_work"]
    e, lost, given, contact = (np.diff(run[term].values) for term in terms)
    largest = max(np.abs(run[term].values).max() for term in terms)
    assert np.abs(e + lost - given - contact).max() <= 1e-13 * largest


def test_stored_energy_is_the_energy_of_an_oscillation():
    """Exact scheme, undamped: q = A sin(w t) has the same energy at every step, A² w² / 2 for small ones."""
    angular, amplitude = np.array([2 * np.pi * 440.0]), 1e-3
    for step, tolerance in ((1e-4, 2e-2), (1e-5, 2e-4), (1e-6, 2e-6)):
        k = st.ExactModal().coefficients(angular, 0 * angular, step)
        block = np.zeros((layout.COEFFICIENT_ROWS, 1))
        block[layout.R], block[layout.HALF_OVER_LOAD] = k.r, 0.5 / k.load
        energies = []
        for t in np.linspace(0.0, 3e-3, 7):
            now, before = (amplitude * np.sin(angular * s) for s in (t, t - step))
            modes = Recurrence(block, np.zeros((layout.MATRICES, 0, 0)), np.zeros((0, 1)), np.zeros((0, 1)))
            energies.append(modes.stored_energy(np.array([now, now - before])))
        np.testing.assert_allclose(energies, energies[0], rtol=1e-9)
        # It is that times cos²(wh/2), which differs from 1 by (wh)²/4.
        assert energies[0] == pytest.approx(0.5 * (angular[0] * amplitude) ** 2, rel=tolerance)
