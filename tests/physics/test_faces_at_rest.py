"""Blocks that rest on each other and are pushed: they stick as a whole, though many forces close the same gaps."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st

ALUMINIUM, NYLON = st.Material(7e10, 2700.0, 0.33), st.Material(3e9, 1150.0, 0.35)
CORNERS = ((0.02, 0.0), (0.06, 0.0), (0.02, 0.04), (0.06, 0.04))
SETTLING = 0.02


def slab(height, below, **settings):
    mesh = st.SolidMesh.block((0.04, height, 0.04), (2, 1, 2)).moved((0.02, below, 0.0))
    points = {f"{k}": (x, below + height, z) for k, (x, z) in enumerate(CORNERS)}
    words = {"points": points, "cutoff": 25e3, "damping": 0.02, "contact_faces": ["bottom"], "name": "slab"}
    return st.SolidBody(mesh, ALUMINIUM, **(words | settings))


def pushed(body, contact, weight, push):
    """Return the body under a weight and a push along x [N], shared by its upper corners."""
    return st.System(contact, [st.Force(body.at(f"{k}"), y=-weight / 4.0, x=push / 4.0) for k in range(4)])


def on_a_block(friction, stiffness=None, weight=80.0, push=8.0):
    base = st.SolidBody.block(
        (0.08, 0.02, 0.04),
        (4, 1, 2),
        NYLON,
        fixed=["bottom"],
        cutoff=25e3,
        damping=0.02,
        contact_faces=["top"],
        name="b",
    )
    body = slab(0.01, 0.02)
    face = st.SurfaceContact(body, "bottom", base, "top", friction=st.Coulomb(friction), stiffness=stiffness)
    return pushed(body, face, weight, push)


def on_a_floor(friction, stiffness=None, weight=80.0, push=8.0):
    body = slab(0.01, 0.0)
    face = st.SurfaceContact(body, "bottom", st.RigidTrack(), friction=st.Coulomb(friction), stiffness=stiffness)
    return pushed(body, face, weight, push)


def settled(system, duration=SETTLING):
    """Return a run, and the resultants of its face at the end [N], normal and along both tangents."""
    run = st.simulate(system, duration, sample_rate=2e4, probes=[])
    assert int(run.unsolved_steps.sum()) == 0
    assert np.abs(run.ledger_residual).max() < 1e-10 * run.drive_work.max()
    last = run.isel(time=slice(-20, None)).mean("time")
    return run, np.array([float(last.normal_force.sum()), *last.tangential_force.values.reshape(-1)[:2]])


@pytest.mark.parametrize("make", [on_a_block, on_a_floor])
@pytest.mark.parametrize(
    ("friction", "weight", "push"), [(0.35, 80.0, 8.0), (0.35, 800.0, 80.0), (0.035, 80.0, 0.8), (10.0, 80.0, 8.0)]
)
def test_a_rigid_face_carries_what_rests_on_it(make, friction, weight, push):
    run, found = settled(make(friction, weight=weight, push=push))
    np.testing.assert_allclose(found, [weight, push, 0.0], atol=1e-6 * weight)
    assert float(run.slip_velocity[-1].max()) < 1e-6


def test_a_slab_pushed_beyond_friction_slides():
    system = on_a_block(0.35, push=80.0)
    run, found = settled(system, 0.005)
    assert found[1] == pytest.approx(0.35 * found[0], rel=1e-3)
    # Mass 43.2 g, pushed by 80 N against 28 N.
    assert float(run.slip_velocity[-1].max()) == pytest.approx((80.0 - 28.0) / 0.0432 * 0.005, rel=0.05)


@pytest.mark.parametrize("stiffness", [1e12, 1e13])
def test_a_face_with_a_stiffness_carries_what_rests_on_it(stiffness):
    """It still bounces a little on its stiffness."""
    _, found = settled(on_a_floor(0.35, stiffness=stiffness), 0.01)
    np.testing.assert_allclose(found, [80.0, 8.0, 0.0], atol=0.2)
