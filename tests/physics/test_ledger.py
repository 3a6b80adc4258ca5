"""The ledger closes over two seconds: stored + damping = work of drives + work of contact, to round-off.

The identity is exact for every step; a sum of 4e5 steps rounded at the size of the sum gives 4e5 x 2.2e-16 = 1e-10 at
the very worst, and some 1e-13 when the roundings are random.
"""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from physics.cases import CASES, SCHEME_NAMES, SCHEMES, STEP, dragged, pair
from stridula.integration.marches import March

TERMS = ["kinetic_and_elastic", "damping_loss", "drive_work", "contact_work"]


def residual(run) -> float:
    """Largest residual over the largest term."""
    return float(np.abs(run.ledger_residual.values).max() / max(np.abs(run[term].values).max() for term in TERMS))


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
@pytest.mark.parametrize("name", CASES)
def test_ledger_closes_over_two_seconds(name, scheme):
    run = st.simulate(CASES[name](), 2.0, scheme=scheme, step=STEP)
    assert run.attrs["ended"] == "finished"
    assert residual(run) < 1e-10
    # The residual follows its definition, and the contact's work is the sum of its three parts.
    balance = (
        run.kinetic_and_elastic + run.damping_loss - run.drive_work - run.contact_work - run.attrs["initial_energy"]
    )
    np.testing.assert_allclose(run.ledger_residual, balance, atol=1e-14 * float(np.abs(run.drive_work).max()))
    parts = run.convection_work - run.friction_loss - run.impact_loss
    scale = float(np.abs(run.friction_loss).max())
    np.testing.assert_allclose(run.contact_work, parts, atol=1e-12 * scale)
    assert np.all(np.diff(run.damping_loss) >= 0)


def test_harness_rejects_a_march_that_leaks(monkeypatch):
    """Negative control: an error of 1e-7 in the increment of one mode, once in 20 000 steps, ends the run."""
    advance = March.advance

    def leaking(march, *arguments):
        march.modes.rows[0, 1, 1] *= 1 + 1e-7
        return advance(march, *arguments)

    monkeypatch.setattr(March, "advance", leaking)
    with pytest.raises(st.Diverged, match="energy was created"):
        st.simulate(CASES["squeal"](), 0.25, scheme=SCHEMES[1], step=STEP)


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
def test_work_of_an_imposed_velocity_is_friction_times_travel(scheme):
    """In the frame of the root: drive work = sum of tangential force x v h + load x descent of the root."""
    system = pair(dragged(0.02, 2.0), mu=0.4)
    run = st.simulate(
        system, 0.5, scheme=scheme, step=STEP, sample_rate=1 / STEP, probes=[st.Displacement(system.slider.root, "y")]
    )
    dragging = np.cumsum(run.tangential_force.values) * 0.02 * STEP
    height = run.displacement.values[:, 0]
    # An impulse at step n works over (q[n+1] - q[n-1]) / 2: summed, minus the mean of the last two heights.
    lowering = -2.0 * (height[1:] + height[:-1]) / 2
    scale = np.abs(run.drive_work.values).max()
    np.testing.assert_allclose(run.drive_work.values[1:], (dragging[1:] + lowering), atol=2e-5 * scale)


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
def test_work_of_a_constant_force_is_force_times_displacement(scheme):
    """Free flight under 0.3 N at the root: work = F . (displacement of the point)."""
    system = pair(lambda rod: [st.Force(rod.root, x=0.2, y=0.3)], mu=0.5)
    words = {"scheme": scheme, "step": STEP, "sample_rate": 1 / STEP}
    probes = [st.Displacement(system.slider.root, "x"), st.Displacement(system.slider.root, "y")]
    run = st.simulate(system, 0.02, probes=probes, **words)
    assert np.all(run.status == 0)
    moved = run.displacement.values @ [0.2, 0.3]
    middle = (moved[1:] + moved[:-1]) / 2
    scale = np.abs(run.drive_work.values).max()
    # The exact scheme's load coefficient is 1/w² times its stiffness, not h c: other by (w h)²/12 of each mode's share,
    # of which the stiff modes have little.
    exactly = 1e-11 if scheme.name == "central difference" else 1e-3
    work = run.drive_work.values[1:]
    np.testing.assert_allclose(work - work[0], middle - middle[0], atol=exactly * scale)
    kinetic = run.kinetic_and_elastic.values - run.attrs["initial_energy"]
    np.testing.assert_allclose(kinetic + run.damping_loss.values, run.drive_work.values, atol=1e-11 * scale)
