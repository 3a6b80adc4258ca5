"""An elastic block on a moving belt that lifts off at a part of its face: its equilibrium by hand."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st

from .test_equilibrium_starts import growth, starting

STIFFNESSES = [5e11, 1e12, 1e13]
LOAD, FRICTION = 21.0, 0.3


def pressed(stiffness: float) -> st.System:
    """Return a block of lining, 60 x 30 x 40 mm, pressed on a belt; springs at its top hold it along the belt."""
    lining = st.Material(2e9, 1200.0, 0.3)
    body = st.SolidBody.block((0.06, 0.03, 0.04), (4, 2, 3), lining, cutoff=20e3, name="block")
    belt = st.RigidTrack(velocity=1.0)
    face = st.SurfaceContact(body, "bottom", belt, friction=st.Coulomb(FRICTION), stiffness=stiffness, name="face")
    top = body.face_points("top")
    shares = (top.area / top.area.sum()).tolist()
    loads = [st.Force(body.at(at), y=-LOAD * share) for at, share in zip(top.place.tolist(), shares, strict=True)]
    springs = [st.Spring(body.at(top.place[k].tolist()), stiffness=1e7, direction=way) for k in (0, -1) for way in "xz"]
    return st.System(face, loads, springs)


@pytest.mark.parametrize("stiffness", STIFFNESSES)
def test_every_inequality_holds_where_the_face_lifts_off(stiffness):
    """The force of each closed point is that of its indentation, and each open point has a gap."""
    system = pressed(stiffness)
    found = st.sliding_stability(system)
    assert (found.attrs["equilibrium"], found.attrs["equilibria"], found.attrs["violated"]) == ("sliding", "one", "")
    force, height = found.normal_force.values, found.tip_displacement.sel(direction="y").values
    slope = np.array(
        [one.stiffness if np.isscalar(one.stiffness) else one.yields.numbers[0] for one in system.contacts]
    )
    closed = (found.status != "separated").values
    assert 0 < (~closed).sum() < closed.size
    assert (force[closed] > 0.0).all()
    assert (height[closed] < 0.0).all()
    assert (height[~closed] > 0.0).all()
    np.testing.assert_allclose(force, np.maximum(-slope * height, 0.0), rtol=1e-9, atol=1e-9 * force.max())
    assert force.sum() == pytest.approx(LOAD, rel=1e-9)
    np.testing.assert_allclose(np.linalg.norm(found.tangential_force, axis=1), FRICTION * force, rtol=1e-12)


@pytest.mark.parametrize("stiffness", STIFFNESSES)
def test_a_start_in_equilibrium_stays_and_growth_is_that_of_linear_theory(stiffness):
    """At the default step; the most unstable modes have 10 to 42 kHz."""
    system = pressed(stiffness)
    forces = st.sliding_stability(system).normal_force.values
    run = st.simulate(starting(system), 2e-4, probes=[], surface_rate="all")
    away = np.abs(run.normal_force.values - forces).max()
    assert away < 1e-9 * forces.max()
    step = run.attrs["step"]
    probe = st.Displacement(system.contacts[0].tip, "y")
    known, seen, _ = growth(system, probe, step, 4e-4, 4, scheme=None, amplitude=1e-12)
    assert known.real > 1000.0
    assert seen.real == pytest.approx(known.real, rel=1e-3)
    assert seen.imag == pytest.approx(known.imag, rel=1e-4)
