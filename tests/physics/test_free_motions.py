"""Rigid motions that nothing holds are named: the body, the translation, the axis of the rotation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from stridula.linear.free_motions import free_words, words_of
from stridula.linear.structure import Structure

STEEL, LINING = st.Material(2.1e11, 7800.0, 0.3), st.Material(5e9, 2500.0, 0.3)
WAYS = "xyz"


def disc():
    profile = st.RectangleProfile({"disc": ((0.05, 0.15), (0.0, 0.01))})
    return st.AxisymmetricBody(profile, STEEL, 3e3, "inner", damping=1e-3, axis=(0.0, 1.0, 0.0), turning=30.0)


def turned_mesh():
    mesh = st.SolidMesh.sector((0.05, 0.15), (0.0, 2.0 * np.pi), 0.01, (2, 12, 1))
    return st.SolidBody(mesh, STEEL, fixed=["inner"], cutoff=3e3, contact_faces=["top"], name="disc")


def braked(held, track=None, start=(), rotation=(0.0, 0.0, 0.0), above=0.0, points=("bottom",)):
    """Return a pad on a disc that turns, held by springs at the mean of its back, at several places of it, or not."""
    track = disc() if track is None else track
    mesh = (
        st.SolidMesh.block((0.03, 0.015, 0.02), (2, 1, 2)).moved((-0.015, 0.01 + above, -0.01)).moved((0.11, 0.0, 0.0))
    )
    pad = st.SolidBody(
        mesh.moved(rotation=rotation), LINING, cutoff=2e4, damping=1e-3, contact_faces=points, name="pad"
    )
    words = {"turning": ((0.0, 1.0, 0.0), (0.0, 0.0, 0.0), 30.0), "track_face": "top"} if track.kind == "solid" else {}
    face = st.SurfaceContact(pad, "bottom", track, friction=st.Coulomb(0.3), stiffness=5e11, name="lining", **words)
    places = {"mean": ["top"], "several": pad.face_points("top").place[::3].tolist(), "no": []}[held]
    springs = [st.Spring(pad.at(one), stiffness=1e7, direction=way) for one in places for way in WAYS]
    return st.System(face, [st.Force(pad.at("top"), y=-200.0), *start], springs)


def started(system):
    return st.simulate(st.System(system.contact, [*system.drives, st.InitialEquilibrium()], system.connections), 1e-4)


@pytest.mark.parametrize("track", [disc, turned_mesh])
@pytest.mark.parametrize("call", [st.sliding_stability, started])
def test_a_pad_that_can_yaw_on_a_turning_disc_is_named(track, call):
    with pytest.raises(
        ValueError, match=r"^connections must hold each motion in which friction carries a body"
    ) as caught:
        call(braked("mean", track()))
    assert "got none that hold pad: rotation about y through (0.11, 0.0114, 0) m" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_pad_that_nothing_holds_is_named():
    words = "pad: translation along x and z and rotation about y$"
    with pytest.raises(ValueError, match=words):
        st.sliding_stability(braked("no"))
    assert free_words(braked("no")) == "pad: translation along x and z and rotation about y"
    few = braked("no", points={"bottom": 4})
    with pytest.raises(
        st.Diverged, match="; nothing but friction holds pad: translation along x and z and rotation"
    ) as run:
        st.simulate(few, 5e-3, contact_solve=st.GaussSeidel(sweeps=1))
    assert run.value.record.attrs["ended"] == "contact unsolved"


def test_a_pad_that_nothing_holds_is_carried_along():
    """Friction accelerates it to the velocity of the disc, where it sticks."""
    run = st.simulate(braked("no"), 5e-3)
    assert run.unsolved_steps[-1] == 0
    velocity, late = 30.0 * 0.11, run.isel(time=slice(-40, None))
    way = np.abs(late.contact_position.isel(tangent=0).squeeze())
    np.testing.assert_allclose(np.gradient(way, run.time[-40:]), velocity, rtol=0.02)
    assert run.surface_sticking_area[-1].sum() > 0.5 * run.surface_closed_area[-1].sum()


def test_a_pad_held_at_several_places_slides():
    assert st.sliding_stability(braked("several")).attrs["equilibrium"] == "sliding"
    assert free_words(braked("several")) == ""


def test_the_axis_of_a_hinge_is_found_in_any_direction():
    """A block held at both ends of an edge turns about that edge, wherever it lies."""
    mesh = st.SolidMesh.block((0.03, 0.015, 0.02), (1, 1, 1)).moved((0.1, 0.2, 0.3)).moved(rotation=(0.3, 0.7, -0.4))
    block = st.SolidBody(mesh, LINING, name="block")
    corners = mesh.nodes[np.abs(mesh.nodes - mesh.nodes[0]).argsort(axis=0)[:1].ravel()]
    first = corners[0]
    others = mesh.nodes[np.argsort(np.linalg.norm(mesh.nodes - first, axis=1))]
    second = next(one for one in others if np.isclose(np.linalg.norm(one - first), 0.03))
    springs = [
        st.Spring(block.at(tuple(end.tolist())), stiffness=1e6, direction=way)
        for end in (first, second)
        for way in WAYS
    ]
    contact = st.PointContact(block.at(tuple(first.tolist())), st.RigidTrack(1.0))
    structure = Structure(st.System(contact, [], springs))
    words = words_of(structure, structure.rigid)
    axis = second - first
    axis = axis / np.linalg.norm(axis)
    axis *= np.sign(axis[np.flatnonzero(np.abs(axis) > 1e-9)[0]])
    assert words.startswith(f"block: rotation about ({', '.join(f'{one:.3g}' for one in axis)}) through (")
    place = np.array([float(one) for one in words.split("through (")[1].split(")")[0].split(",")])
    away = place - first
    assert np.linalg.norm(away - axis * (axis @ away)) < 1e-3


def test_bodies_without_places_have_a_translation_or_a_rotation():
    rigid = {"left": [[1.0, 0.0], [0.0, 0.0]], "right": [[1.0, 0.0], [0.0, 1.0]]}
    beam = st.ModalBody([0.0, 0.0], rigid, name="lever")
    structure = Structure(st.System(st.PointContact(beam.at("left"), st.RigidTrack(1.0), normal=None)), 0.0)
    assert words_of(structure, structure.rigid) == "lever: translation along x and rotation"


def test_a_braked_free_motion_is_named():
    mass = st.PointMass(1.0, name="block")
    contact = st.PointContact(mass.centre, st.RigidTrack(1.0), friction=st.Coulomb(0.1))
    system = st.System(
        contact, [st.Force(mass.centre, y=-1.0, x=5.0)], [st.Dashpot(mass.centre, coefficient=1.0, direction="x")]
    )
    with pytest.raises(ValueError, match=r"^connections must not brake .*, got block: translation along x$"):
        st.sliding_stability(system, status="sliding")


def test_systems_beyond_linear_theory_have_no_words():
    """A tip carried along a circle is refused by linear theory; a message of a run must not fail with it."""
    body = disc()
    tip = st.RigidBody(0.01, 1e-6, {"tip": (0.0, 0.0, 0.0)}, name="ball")
    contact = st.PointContact(
        tip.at("tip"), replace(body, turning=0.0).circle((0.1, 0.0, 0.01), velocity=1.0), normal=(0.0, 1.0, 0.0)
    )
    system = st.System(contact)
    with pytest.raises(ValueError, match=r"^track must not be carried along its circle by contact 1 in linear theory"):
        Structure(system)
    assert free_words(system) == ""
