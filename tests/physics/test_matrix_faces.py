"""Faces of bodies given by matrices: the same contact as that of the mesh, and of superelements."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse

import stridula as st
from stridula.bodies.solids.solid_body import _assembled
from stridula.doubtful import DoubtfulValue

LINING = st.Material(5e9, 2500.0, 0.25)
MESH = st.SolidMesh.block((0.03, 0.015, 0.02), (3, 2, 2))
DISC = st.AxisymmetricBody(
    st.RectangleProfile({"disc": ((0.04, 0.13), (-0.02, -0.008))}),
    st.Material(1.1e11, 7100.0, 0.28),
    6e3,
    "inner",
    damping=2e-3,
    axis=(0.0, 1.0, 0.0),
    turning=20.0,
    name="disc",
)
PLACED = MESH.moved((0.09, -0.008, -0.01))


def matrices(fixed="top"):
    """Return mass, stiffness and numbers of degrees of freedom of the pad, held at a face."""
    body = st.SolidBody(PLACED, LINING, fixed=[fixed], cutoff=2e4)
    node_mass, stiffness = _assembled(body)
    mass, free = np.kron(node_mass.toarray(), np.eye(3)), body._free
    degrees = np.where(free, np.cumsum(free) - 1, -1).reshape(-1, 3)
    return mass[free][:, free], stiffness[free][:, free].toarray(), degrees


def reduced(division, **words):
    mass, stiffness, degrees = matrices()
    face = st.MatrixFace(PLACED, "bottom", degrees, division)
    return st.ReducedBody(mass, stiffness, {}, damping=0.01, cutoff=5e4, faces={"rub": face}, name="pad", **words)


def pressed(pad, face):
    surface = st.SurfaceContact(pad, face, DISC, friction=st.Coulomb(0.4), stiffness=2e12, name="lining", gap=1e-9)
    pushes = [st.Force(surface.contacts[0].tip, y=-20.0)]
    return st.System(surface, pushes)


@pytest.mark.parametrize("division", ["integration", (4, 3), 20])
def test_a_pad_of_matrices_rubs_as_that_of_the_mesh(division):
    solid = st.SolidBody(
        PLACED, LINING, fixed=["top"], damping=0.01, cutoff=5e4, contact_faces={"bottom": division}, name="pad"
    )
    pad = reduced(division)
    np.testing.assert_allclose(pad.face_points("rub").place, solid.face_points("bottom").place, atol=1e-15)
    theirs, ours = (pressed(*one) for one in ((solid, "bottom"), (pad, "rub")))
    assert len(ours.contacts) == len(theirs.contacts)
    expected, found = (st.sliding_stability(one) for one in (theirs, ours))
    np.testing.assert_allclose(found.normal_force, expected.normal_force, rtol=1e-6, atol=1e-6)
    slow = expected.frequency.values < 4e4
    count = int(slow.sum())
    for name in ("frequency", "growth_rate"):
        wanted = np.sort(expected[name].values[slow])
        got = np.sort(found[name].values[found.frequency.values < 4e4])
        assert len(got) == count
        np.testing.assert_allclose(got, wanted, rtol=1e-4, atol=1e-3)


def test_a_superelement_has_the_static_flexibility_of_its_mesh():
    """Condensed to the nodes of its face (Guyan 1965), which is exact for static forces there."""
    mass, stiffness, degrees = matrices()
    nodes = PLACED.nodes_of("bottom")
    kept = degrees[nodes].ravel()
    others = np.setdiff1d(np.arange(len(mass)), kept)
    inner = -scipy.linalg.solve(stiffness[np.ix_(others, others)], stiffness[np.ix_(others, kept)])
    shape = np.zeros((len(mass), kept.size))
    shape[kept], shape[others] = np.eye(kept.size), inner
    small = np.full_like(degrees, -1)
    small[nodes] = np.arange(kept.size).reshape(-1, 3)
    face = st.MatrixFace(PLACED, "bottom", small, 12)
    element = st.ReducedBody(shape.T @ mass @ shape, shape.T @ stiffness @ shape, {}, faces={"rub": face}, name="pad")
    whole = reduced(12)
    flexibilities = []
    for body in (element, whole):
        modes = body.modes()
        rows = np.concatenate([body.trace(one) for one in body.point_names])
        flexibilities.append((rows / np.where(modes.massless, 1.0, modes.angular_frequency) ** 2) @ rows.T)
    np.testing.assert_allclose(*flexibilities, rtol=1e-6, atol=1e-9 * np.abs(flexibilities[0]).max())


def test_a_record_of_a_superelement_runs_again():
    system = pressed(reduced((3, 2)), "rub")
    run = st.simulate(system, 2e-4)
    again = st.simulate(st.load_scenario(run).system, 2e-4)
    np.testing.assert_array_equal(again.surface_force, run.surface_force)
    np.testing.assert_array_equal(again.surface_centre_of_pressure, run.surface_centre_of_pressure)


def test_a_record_keeps_damping_that_couples_modes():
    mass, stiffness, degrees = matrices()
    damping = np.zeros_like(stiffness)
    damping[5, 5] = 40.0
    face = st.MatrixFace(PLACED, "bottom", degrees, (3, 2))
    pad = st.ReducedBody(mass, stiffness, {}, damping=damping, cutoff=5e4, faces={"rub": face}, name="pad")
    assert pad.modes().damping_matrix is not None
    run = st.simulate(pressed(pad, "rub"), 2e-4)
    again = st.simulate(st.load_scenario(run).system, 2e-4)
    # The places of its points are lost with the face, so that each is a contact of its own.
    np.testing.assert_allclose(again.normal_force.sum("contact"), run.normal_force, rtol=1e-12)


def test_bodies_with_faces_are_equal_by_content():
    pad = reduced(12)
    assert pickle.loads(pickle.dumps(pad)) == pad == reduced(12)
    assert pad != reduced(13)
    assert pad.place("rub[1]") == pytest.approx(pad.face_points("rub").place[0])
    assert pad.face_names == ("rub",)


def test_held_nodes_of_a_face_are_mentioned():
    mass, stiffness, degrees = matrices("left")
    with pytest.warns(DoubtfulValue, match=r"5 nodes of 29 of the face 'bottom' not in the matrices, taken as held"):
        face = st.MatrixFace(PLACED, "bottom", degrees, 12)
    pad = st.ReducedBody(mass, stiffness, {}, cutoff=5e4, faces={"rub": face})
    assert len(pad.point_names) == 12


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"degrees": np.zeros((4, 3))}, r"degrees must have the shape \(111, 3\)"),
        ({"degrees": np.full((111, 3), -1)}, "degrees must keep the nodes of the face, got none of 29 of 'bottom'"),
        ({"degrees": np.full((111, 3), 0.5)}, "degrees must be whole numbers from 0, or -1 for none"),
        ({"face": "sole"}, "face must be one of left, right"),
        ({"division": 0}, "division must"),
    ],
)
def test_faces_that_are_refused(words, message):
    arguments = {"mesh": PLACED, "face": "bottom", "degrees": matrices()[2], "division": 12}
    with pytest.raises(ValueError, match=message):
        st.MatrixFace(**arguments | words)


def test_points_beside_faces():
    mass, stiffness, degrees = matrices()
    faces = {"rub": st.MatrixFace(PLACED, "bottom", degrees, 12)}
    with pytest.raises(ValueError, match=r"points must not have the name of a contact point of a face, got 'rub\[2\]'"):
        st.ReducedBody(mass, stiffness, {"rub[2]": (0, 1, 2)}, faces=faces)
    pad = st.ReducedBody(mass, stiffness, {"rub[200]": (0, 1, 2)}, faces=faces)
    assert pad.place("rub[200]") is None
    assert pad.place("rub[2]") is not None


def test_bodies_with_faces_that_are_refused(tmp_path):
    mass, stiffness, degrees = matrices()
    face = st.MatrixFace(PLACED, "bottom", degrees + 10_000 * (degrees >= 0), 12)
    with pytest.raises(ValueError, match="degrees must be numbers of degrees of freedom from 0 to"):
        st.ReducedBody(mass, stiffness, {}, faces={"rub": face})
    pad = reduced(12)
    with pytest.raises(ValueError, match="faces must be left out to be saved, got rub"):
        pad.save(tmp_path / "pad.npz")
    with pytest.raises(ValueError, match="overlay must be False for a ReducedBody"):
        st.SurfaceContact(pad, "rub", DISC, overlay=True)
    with pytest.raises(ValueError, match="face must be one of rub, got 'bottom'"):
        st.SurfaceContact(pad, "bottom", DISC)
