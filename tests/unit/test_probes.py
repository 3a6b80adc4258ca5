"""Probes: refused arguments, labels, directions and reactions."""

from __future__ import annotations

import numpy as np
import pytest
from physics.cases import SCHEMES, every_step, pair, slider, track

import stridula as st
from stridula.checks import brief
from stridula.records.dataset import probe_label

ROD, BAR = slider(30.0), track()
MOTIONS = (st.Displacement, st.Velocity, st.Acceleration)


@pytest.mark.parametrize("kind", MOTIONS)
@pytest.mark.parametrize("value", [None, ROD, 0.1, "tip"])
def test_bad_points(kind, value):
    with pytest.raises(ValueError, match=r"^point must be a BodyPoint") as caught:
        kind(value)
    assert brief(value) in str(caught.value)


@pytest.mark.parametrize("kind", MOTIONS)
@pytest.mark.parametrize("value", [None, 1, "w", "axail", True, (1.0, 2.0), (0.0, 0.0, 0.0)])
def test_bad_directions(kind, value):
    with pytest.raises(ValueError, match=r"^direction must be (one of )?x, y, z, axial, transverse") as caught:
        kind(ROD.tip, value)
    assert brief(value) in str(caught.value)
    assert ("did you mean 'axial'" in str(caught.value)) == (value == "axail")


def test_bad_reactions():
    for value in (None, BAR, ROD.root, "slider"):
        with pytest.raises(ValueError, match=r"^body must be a FiniteElementBeam"):
            st.Reaction(value)
    for value in (None, "z", 2):
        with pytest.raises(ValueError, match=r"^component must be one of x, y, moment"):
            st.Reaction(ROD, value)


def test_bad_support_forces():
    for value in (None, ROD, BAR.centre, "track"):
        with pytest.raises(ValueError, match=r"^body must be a ModalBeam"):
            st.SupportForce(value)
    for value in (None, "tip", 0):
        with pytest.raises(ValueError, match=r"^end must be one of left, right"):
            st.SupportForce(BAR, value)
    other = st.SupportForce(track(length=0.7))
    with pytest.raises(ValueError, match=r"^probe must be on a body of this system, got one on a ModalBeam$"):
        st.simulate(pair(lambda _: [], 0.5, rod=ROD, bar=BAR), 1e-3, probes=[other])


def test_labels_tell_probes_apart():
    probes = [
        st.Displacement(ROD.tip),
        st.Displacement(ROD.root, "axial"),
        st.Displacement(ROD.at(0.123)),
        st.Displacement(BAR.centre),
        st.Displacement(BAR.at(0.123), "x"),
        st.Displacement(BAR.centre, [3, -4.5, 0]),
        st.Reaction(ROD, "x"),
        st.SupportForce(BAR, "right"),
    ]
    labels = [probe_label(probe, pair(lambda _: [], 0.5, rod=ROD, bar=BAR)) for probe in probes]
    assert labels == [
        "slider tip y",
        "slider root axial",
        "slider 0.123 m y",
        "track centre y",
        "track 0.123 m x",
        "track centre (3, -4.5, 0)",
        "slider root x",
        "track right end",
    ]


def test_directions_are_projections_of_the_world():
    """Axial and transverse follow from x and y by the axes of the body, at every step."""
    for point in (ROD.at(0.2), BAR.at(0.3)):
        slanted = (3.0, -4.0, 0.0)
        probes = [st.Velocity(point, d) for d in ("x", "y", "axial", "transverse", slanted)]
        system = pair(lambda _: [st.Force(ROD.root, x=0.3, y=-1.0), st.Gravity()], 0.6, rod=ROD, bar=BAR, gap=0.0)
        run = every_step(system, 500, SCHEMES[1], probes=probes)
        world, own = run.velocity.values[:, :2], run.velocity.values[:, 2:]
        assert np.abs(world).max() > 0
        ways = np.vstack([point.body.axes, [0.6, -0.8]])
        np.testing.assert_allclose(own, world @ ways.T, atol=1e-12 * np.abs(world).max())


def test_a_direction_in_space_is_kept_in_a_scenario():
    mass = st.RigidBody(1.0)
    system = st.System(st.PointContact(mass.centre, st.RigidTrack()), [st.InitialVelocity(mass, x=1.0, y=2.0, z=-3.0)])
    probe = st.Velocity(mass.centre, (1.0, 2.0, 2.0))
    run = st.simulate(system, 1e-3, step=1e-4, sample_rate=1e3, probes=[probe])
    np.testing.assert_allclose(run.velocity, [[-1.0 / 3.0]], rtol=1e-12)
    again = st.load_scenario(run)
    np.testing.assert_array_equal(again.simulate().velocity, run.velocity)
    assert again.probes == (probe,)
    with pytest.raises(st.ArgumentError, match=r"^direction must have no component along z on a body in the plane"):
        st.Velocity(ROD.tip, (1.0, 0.0, 1e-9))


def test_a_probe_of_the_slider_shares_an_imposed_motion():
    """Upright, pressed by nothing: every point moves at v t exactly, the track not at all."""
    rod = slider(0.0)
    system = pair(lambda _: [st.ImposedVelocity(rod.root, 0.3)], 0.5, rod=rod, gap=1.0)
    probes = [kind(point, "x") for kind in MOTIONS for point in (rod.tip, rod.root, track().centre)]
    run = every_step(system, 400, SCHEMES[1], probes=probes)
    t = run.time.values
    np.testing.assert_allclose(run.displacement, np.stack([0.3 * t, 0.3 * t, 0 * t], axis=1), atol=1e-15)
    np.testing.assert_allclose(run.velocity, np.tile([0.3, 0.3, 0.0], (400, 1)), atol=1e-12)
    np.testing.assert_allclose(run.acceleration, 0.0, atol=1e-12)


def test_reaction_of_a_held_direction_answers_a_force_put_on_it():
    """A force on a clamped root does not move the slider: the support gives its opposite at once."""
    rod = slider(30.0, root_support="clamped")
    system = pair(lambda _: [st.Force(rod.root, x=3.0, y=-2.0)], 0.5, rod=rod, gap=1.0)
    run = every_step(system, 20, SCHEMES[1], probes=[st.Reaction(rod, c) for c in ("x", "y", "moment")])
    np.testing.assert_allclose(run.reaction, np.tile([-3.0, 2.0, 0.0], (20, 1)), atol=1e-9)


def test_reaction_is_zero_where_the_root_is_free():
    rod = slider(30.0, root_support="free")
    system = pair(lambda _: [st.Force(rod.root, x=3.0, y=-2.0)], 0.5, rod=rod, gap=1.0)
    run = every_step(system, 20, SCHEMES[1], probes=[st.Reaction(rod, c) for c in ("x", "y", "moment")])
    assert np.all(run.reaction == 0.0)
