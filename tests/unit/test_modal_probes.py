"""Probes of modes: together they are the motion of every point of their body."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st


@pytest.fixture(scope="module")
def rig():
    """Return the pin on a disc."""
    return st.load_scenario("pin-on-disc")


@pytest.mark.parametrize("name", ["pad-on-disc", "pin-on-disc"])
def test_modes_make_up_the_motion_of_points(name):
    """With springs at the pad, which mix its residual shapes with its modes."""
    scenario = st.load_scenario(name)
    for body in scenario.system.bodies:
        point = (
            scenario.system.contacts[3].tip
            if body == scenario.system.slider
            else scenario.system.contacts[3].touched_point
        )
        modes = range(body.modes().count)
        probes = [kind(body, k) for kind in (st.ModalDisplacement, st.ModalVelocity) for k in modes]
        probes += [kind(point, way) for kind in (st.Displacement, st.Velocity) for way in "xyz"]
        run = scenario.simulate(duration=2e-3, sample_rate=25e3, probes=probes)
        rows = body.trace(point.position)
        for modal, whole in ((run.modal_displacement, run.displacement), (run.modal_velocity, run.velocity)):
            expected = modal.values @ rows.T
            assert np.abs(expected).max() > 0.0
            np.testing.assert_allclose(whole.values, expected, atol=1e-9 * np.abs(expected).max())


def test_probes_of_modes_are_labelled_and_survive_provenance(rig):
    disc = rig.system.bodies[1]
    run = rig.simulate(duration=1e-4, probes=[st.ModalDisplacement(disc, 3), st.ModalVelocity(disc, 0)])
    assert list(run.modal_displacement_probe.values) == ["disc mode 3"]
    assert run.modal_velocity.attrs["units"] == "kg^(1/2) m/s"
    again = st.load_scenario(run).simulate()
    np.testing.assert_allclose(again.modal_displacement, run.modal_displacement, rtol=1e-9)


def test_modes_that_a_body_does_not_have_are_refused(rig):
    disc = rig.system.bodies[1]
    count = disc.modes().count
    with pytest.raises(ValueError, match=f"^mode must be at most {count - 1}, got {count}$"):
        st.ModalVelocity(disc, count)
    with pytest.raises(ValueError, match=r"^body must be a body of stridula"):
        st.ModalVelocity("disc", 0)
    with pytest.raises(ValueError, match=r"^probe must be on a body of this system"):
        rig.simulate(duration=1e-4, probes=[st.ModalVelocity(st.PointMass(1.0), 0)])
