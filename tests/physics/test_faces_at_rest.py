"""Blocks that rest on each other and are pushed: they stick as a whole, though many forces close the same gaps."""

from __future__ import annotations

from dataclasses import replace

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


def stack(friction):
    """Return five blocks on a rigid floor, in turn of aluminium and nylon, under 80 N down and 8 N sideways."""
    bodies = []
    for k, material in enumerate((ALUMINIUM, NYLON, ALUMINIUM, NYLON, ALUMINIUM)):
        mesh = st.SolidMesh.block((0.04, 0.01, 0.04), (2, 1, 2)).moved((0.02, 0.01 * k, 0.0))
        points = {f"{i}": (x, 0.05, z) for i, (x, z) in enumerate(CORNERS)} if k == 4 else {}
        faces = ["bottom"] if k == 4 else ["bottom", "top"]
        words = {"points": points, "cutoff": 25e3, "damping": 0.2, "contact_faces": faces, "name": f"block {k}"}
        bodies.append(st.SolidBody(mesh, material, **words))
    below = [(st.RigidTrack(),), *[(body, "top") for body in bodies[:-1]]]
    contacts = [
        st.SurfaceContact(body, "bottom", *under, friction=st.Coulomb(friction), name=f"under block {k}")
        for k, (body, under) in enumerate(zip(bodies, below, strict=True))
    ]
    return pushed(bodies[-1], contacts, 80.0, 8.0)


def test_five_blocks_on_each_other_stay():
    """80 contacts, of which the motions of free blocks see 72 numbers: each face carries all that is above it."""
    run = st.simulate(stack(0.35), 0.016, sample_rate=2e4, probes=[])
    assert int(run.unsolved_steps.sum()) == 0
    assert np.abs(run.ledger_residual).max() < 1e-10 * run.drive_work.max()
    last = run.isel(time=slice(-20, None)).mean("time")
    np.testing.assert_allclose(last.normal_force, 80.0, rtol=1e-3)
    np.testing.assert_allclose(last.tangential_force.sel(tangent=last.tangent[0]), 8.0, rtol=1e-2)


def lap(friction):
    """Return two plates that overlap, held at one end, pressed on each other and pulled apart along x."""
    lower = st.SolidMesh.block((0.08, 0.004, 0.03), (4, 1, 2))
    upper = st.SolidMesh.block((0.08, 0.004, 0.03), (4, 1, 2)).moved((0.04, 0.004, 0.0))
    below = upper.faces["bottom"]
    middle = np.array([upper.nodes[upper.elements[element], 0].mean() for element, _ in below])
    upper = replace(upper, faces={**upper.faces, "lap": below[middle < 0.08]})
    bolts = [(0.06, 0.0), (0.06, 0.03), (0.08, 0.015)]
    under, over = ({f"{k}": (x, y, z) for k, (x, z) in enumerate(bolts)} for y in (0.0, 0.008))
    words = {"cutoff": 20e3, "damping": 0.2}
    held = st.SolidBody(lower, ALUMINIUM, fixed=["left"], contact_faces=["top"], points=under, name="lower", **words)
    pulled = st.SolidBody(
        upper, ALUMINIUM, contact_faces=["lap"], points={**over, "end": (0.12, 0.004, 0.015)}, name="upper", **words
    )
    face = st.SurfaceContact(pulled, "lap", held, "top", friction=st.Coulomb(friction))
    loads = [st.Force(pulled.at("end"), x=40.0)]
    for k in range(len(bolts)):
        loads += [st.Force(pulled.at(f"{k}"), y=-100.0), st.Force(held.at(f"{k}"), y=100.0)]
    return st.System(face, loads)


def test_a_bolted_lap_holds():
    """The faces carry the bolts' 300 N and the pull; with too little friction the plates slide apart."""
    run, found = settled(lap(0.35), 0.01)
    np.testing.assert_allclose(found[:2], [300.0, 40.0], rtol=5e-3)
    run = st.simulate(lap(0.1), 0.002, sample_rate=2e4, probes=[])
    assert int(run.unsolved_steps.sum()) == 0
    assert float(np.abs(run.slip_velocity[-1]).max()) > 0.1


def test_a_pad_at_rest_on_a_disc_that_starts_to_turn_sticks_then_slides():
    profile = st.RectangleProfile({"disc": ((0.06, 0.13), (-0.01, 0.01))})
    turning = {"axis": (0.0, 1.0, 0.0), "turning": 0.5, "turning_history": st.Ramp(0.01)}
    disc = st.AxisymmetricBody(profile, ALUMINIUM, 8e3, "inner", damping=0.01, **turning)
    mesh = st.SolidMesh.sector((0.085, 0.125), (-0.4, 0.4), 0.012, (2, 3, 1), axis="y").moved((0.0, 0.01, 0.0))
    pad = st.SolidBody(mesh, NYLON, cutoff=8e3, damping=0.05, contact_faces=["bottom"], name="pad")
    face = st.SurfaceContact(pad, "bottom", disc, friction=st.Coulomb(0.35))
    springs = [st.Spring(pad.at(end), stiffness=2e6, direction=way) for end in ("start", "end") for way in "xz"]
    run = st.simulate(st.System(face, [st.Force(pad.at("top"), y=-500.0)], springs), 0.02, sample_rate=1e4, probes=[])
    assert int(run.unsolved_steps.sum()) == 0
    assert np.abs(run.ledger_residual).max() < 1e-10 * run.drive_work.max()
    share = np.linalg.norm(run.tangential_force, axis=1) / run.normal_force
    assert float(share.max()) <= 0.35 * (1.0 + 1e-9)
    assert float(share[10:30].max()) < 0.3
    assert float(share[-50:].max()) > 0.25
    assert float(np.abs(run.slip_velocity[-50:]).max()) > 0.01
    assert float(run.normal_force[-50:].mean()) == pytest.approx(500.0, rel=0.02)
