"""Planar bodies in space: their motion does not depend on the plane."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import stridula as st

STEEL, STRIP = st.Material(2.1e11, 7800.0), st.Rectangle(0.02, 0.009)
ROD = st.FiniteElementBeam(STEEL, STRIP, 0.3, angle=np.radians(-50.0), damping=0.01, cutoff=8e3, name="rod")
TRACK = st.ModalBeam(STEEL, STRIP, 1.1, damping=0.01, cutoff=8e3, name="track")
WORDS = {"friction": st.Coulomb(0.4), "surface_velocity": 0.3}
LOAD, STEP, DURATION = np.array([4.0, -60.0, 0.0]), 2e-6, 4e-3


def placed(turn):
    """The rod on the track, put into a plane."""
    x, y = turn[:, 0], turn[:, 1]
    rod = st.ModalBody.placed(ROD, {"tip": "tip", "root": "root"}, x, y)
    track = st.ModalBody.placed(TRACK, {"under": 0.45}, x, y)
    contact = st.PointContact(rod.at("tip"), track.at("under"), normal=tuple(y), tangent=tuple(x), **WORDS)
    push = dict(zip("xyz", (turn @ LOAD).tolist(), strict=True))
    system = st.System(contact, [st.Force(rod.at("root"), history=st.Ramp(1e-3), **push)])
    return st.simulate(system, DURATION, step=STEP, sample_rate=5e4, probes=[])


@pytest.fixture(scope="module")
def plane():
    contact = st.PointContact(ROD.tip, TRACK.at(0.45), **WORDS)
    system = st.System(contact, [st.Force(ROD.root, x=LOAD[0], y=LOAD[1], history=st.Ramp(1e-3))])
    run = st.simulate(system, DURATION, step=STEP, sample_rate=5e4, probes=[])
    assert float(run.normal_force.max()) > 30.0
    return run


@pytest.mark.parametrize("seed", range(5))
def test_results_do_not_depend_on_the_plane(plane, seed):
    turn = np.eye(3) if seed == 0 else Rotation.random(random_state=seed).as_matrix()
    run = placed(turn)
    for name in ("normal_force", "tangential_force"):
        found = run[name] if "tangent" not in run[name].dims else run[name].isel(tangent=0)
        size = float(np.abs(plane[name]).max())
        np.testing.assert_allclose(found, plane[name], atol=1e-9 * size)
    assert float(np.abs(run.tangential_force.isel(tangent=1)).max()) < 1e-9 * float(plane.normal_force.max())


def test_bad_placements_are_refused():
    solid = st.RigidBody(1.0)
    for make, words in (
        (lambda: st.ModalBody.placed(solid, {"centre": "centre"}), "body must be a body in the plane"),
        (lambda: st.ModalBody.placed(3.0, {"centre": "centre"}), "body must be a body in the plane"),
        (lambda: st.ModalBody.placed(TRACK, {"a": 0.1}, x=(1.0, 0.0, 0.0), y=(1.0, 0.0, 0.0)), "at right angles"),
        (lambda: st.ModalBody.placed(TRACK, {"a": 0.1}, x=(2.0, 0.0, 0.0)), "unit vectors"),
        (lambda: st.ModalBody.placed(TRACK, {"a": 7.0}), "position"),
        (lambda: st.ModalBody.placed(TRACK, {}), "points"),
    ):
        with pytest.raises(st.ArgumentError, match=words):
            make()


def test_a_mass_keeps_its_weight():
    """A point mass that falls along the former y."""
    turn = Rotation.from_euler("z", 90.0, degrees=True).as_matrix()
    mass = st.ModalBody.placed(st.PointMass(0.5), {"centre": "centre"}, turn[:, 0], turn[:, 1])
    assert mass.total_mass == pytest.approx(0.5)
    np.testing.assert_allclose(
        mass.trace("centre") @ mass.trace("centre").T, np.diag([1.0, 1.0, 0.0]) / 0.5, atol=1e-15
    )


def test_with_an_origin_it_has_its_surface_there():
    """The surface of the beam in its own plane, turned and shifted."""
    turn, place = Rotation.random(random_state=7).as_matrix(), np.array([0.3, -0.2, 0.1])
    body = st.ModalBody.placed(ROD, {"tip": "tip", "end": 0.3}, turn[:, 0], turn[:, 1], origin=place)
    known, found = ROD.surface(), body.surface()
    np.testing.assert_allclose((found.points - place) @ turn, known.points, atol=1e-15)
    np.testing.assert_allclose(found.normals @ turn, known.normals, atol=1e-14)
    np.testing.assert_array_equal(found.shapes, known.shapes)
    np.testing.assert_allclose((found.corners.reshape(-1, 3) - place) @ turn, known.corners.reshape(-1, 3), atol=1e-15)
    np.testing.assert_allclose(body.at("tip").place, place)
    np.testing.assert_allclose(body.at("end").place, place + 0.3 * turn[:, :2] @ ROD.axes[0])
    assert body.has_surface
    assert not st.ModalBody.placed(ROD, {"tip": "tip"}).has_surface
    for given in ((0.0, 1.0), [[0.0, 0.0, 0.0]]):
        with pytest.raises(st.ArgumentError, match=r"^origin must be three numbers"):
            st.ModalBody.placed(ROD, {"tip": "tip"}, origin=given)
    with pytest.raises(st.ArgumentError, match=r"^origin must be three numbers, for a beam or a plate only"):
        st.ModalBody.placed(st.PointMass(1.0), {"centre": "centre"}, origin=place)
