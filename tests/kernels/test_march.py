"""The compiled march of one slider on one beam against the twin, step by step, its energies, and an oscillation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from physics.cases import CASES, SCHEMES, STEP, every_step

import stridula as st
from kernels import twin
from kernels.agreement import COLUMNS, disagreements
from stridula._kernels.layout import columns as layout
from stridula.lowering.blocks import Recurrence

STEPS = 1500
BOTH = [pytest.param(SCHEMES[0], twin.central, id="central"), pytest.param(SCHEMES[1], twin.exact, id="exact")]


def early(name: str) -> st.System:
    """The case with a gap of 10 nm, so that contact begins within the steps compared."""
    system = CASES[name]()
    return replace(system, contact=replace(system.contact, gap=1e-8))


@pytest.mark.parametrize(("scheme", "form"), BOTH)
@pytest.mark.parametrize("name", CASES)
def test_kernel_and_twin_agree_at_every_step(name, scheme, form):
    system = early(name)
    run, trail = every_step(system, STEPS, scheme), twin.march(system, form, STEP, STEPS)
    assert set(run.status.values) - {0}, "no contact in the steps compared: the case tests nothing"
    assert disagreements(run, trail, vanishing=False) == {}
    np.testing.assert_allclose(
        run.contact_position.values, trail.position[:, 0], atol=1e-10 * trail.position.max(), rtol=0
    )
    before, position = trail.last
    scale = np.abs(position).max()
    np.testing.assert_allclose(run.state_modal.values[0], position, atol=1e-8 * scale, rtol=0)
    # An increment is the difference of two positions: the same absolute error.
    np.testing.assert_allclose(run.state_modal.values[1], position - before, atol=1e-8 * scale, rtol=0)
    # All combinations of states were tried at every step.
    assert set(trail.solutions) == {1}


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
    assert disagreements(run, twin.march(system, form, STEP, STEPS), vanishing=False).keys() & COLUMNS.keys()


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
