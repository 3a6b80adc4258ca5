"""Meshes without some of their elements: what is left, and the faces that come to the surface."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stridula as st
from stridula.bodies.solids.kinds import KINDS, outer_faces

STEEL = st.Material(2.1e11, 7800.0, 0.3)


def block(kind):
    mesh = st.SolidMesh.block((0.06, 0.03, 0.04), (5, 3, 4))
    whole = st.SolidMesh(mesh.nodes, mesh.elements, mesh.kind, {"all": np.arange(60)}, mesh.faces)
    if kind == mesh.kind:
        return whole
    linear = mesh.elements[:, :8]
    used, numbers = np.unique(linear, return_inverse=True)
    corners = numbers.reshape(linear.shape)
    if kind.startswith("hexahedron"):
        return st.SolidMesh(mesh.nodes[used], corners, "hexahedron", {"all": np.arange(60)})
    # Five tetrahedra in every box would not meet: six about a diagonal do.
    six = np.array([(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)])
    made = st.SolidMesh(mesh.nodes[used], corners[:, six].reshape(-1, 4), "tetra", {"all": np.arange(360)})
    return made.quadratic() if kind == "tetra10" else made


@pytest.mark.parametrize("kind", ["hexahedron", "hexahedron20", "tetra", "tetra10"])
@pytest.mark.parametrize("seed", range(3))
def test_what_is_left_of_a_mesh_is_the_rest_with_a_closed_surface(kind, seed):
    random = np.random.default_rng(seed)
    mesh = block(kind)
    low = random.uniform([0.005, 0.012, -0.01], [0.02, 0.02, 0.01])
    high = low + random.uniform([0.015, 0.02, 0.012], [0.03, 0.03, 0.02])

    def inside(place):
        return ((place > low) & (place < high)).all(axis=1)

    corners = len(KINDS[kind].corners)
    gone = inside(mesh.nodes[mesh.elements[:, :corners]].mean(axis=1))
    cut = mesh.cut(inside, "slot")
    assert len(cut.elements) == (~gone).sum()
    assert cut.volume.sum() == pytest.approx(mesh.volume[~gone].sum(), rel=1e-12)
    np.testing.assert_allclose(cut.nodes[cut.elements], mesh.nodes[mesh.elements[~gone]], atol=0.0)
    assert cut.volumes["all"].size == (~gone).sum()
    # The faces of the slot are the surface that the mesh did not have; with the rest of it the surface is closed.
    slot = cut.face("slot")
    outer = {tuple(sorted(face)) for face in faces_by_place(mesh)}
    bare = [face for face in faces_by_place(cut) if tuple(sorted(face)) not in outer]
    assert len(bare) == len(slot.area)
    named = [name for name in cut.faces if name != "slot"]
    if len(named) == 6:
        total = sum((cut.face(name).area @ cut.face(name).normal for name in cut.faces), np.zeros(3))
        np.testing.assert_allclose(total, 0.0, atol=1e-15)


def faces_by_place(mesh):
    """The corners of every face on the surface, by their places."""
    kind = mesh.element_kind
    element, side = outer_faces(kind, mesh.elements).T
    corners = mesh.elements[element[:, None], np.array(kind.faces)[side]]
    return [tuple(map(tuple, np.round(mesh.nodes[face], 9).tolist())) for face in corners]


def test_modes_of_a_cut_block_are_those_of_the_same_block_built_without_a_cut():
    long = st.SolidMesh.block((0.12, 0.01, 0.02), (6, 1, 2))
    short = st.SolidMesh.block((0.08, 0.01, 0.02), (4, 1, 2))
    cut = long.cut(lambda place: place[:, 0] > 0.08, "end")
    ours, theirs = (st.SolidBody(mesh, STEEL, fixed=["left"], cutoff=2e4).modes() for mesh in (cut, short))
    np.testing.assert_allclose(ours.angular_frequency, theirs.angular_frequency, rtol=1e-10)
    assert "right" not in cut.faces
    assert cut.face("end").area.sum() == pytest.approx(2e-4, rel=1e-12)


def test_holes_split_the_modes_of_a_disc_whose_number_of_waves_they_match():
    whole = st.SolidMesh.sector((0.05, 0.13), (0.0, 2.0 * math.pi), 0.01, (4, 24, 1))

    def drilled(count):
        def inside(place):
            angle = np.arctan2(place[:, 2], place[:, 0])
            return (np.cos(count * (angle - math.radians(7.5))) > 0.99) & (
                np.abs(np.hypot(*place[:, ::2].T) - 0.1) < 0.02
            )

        return whole.cut(inside, "holes")

    # Of the pairs of orders 1, 2 and 3, with 4 holes that of order 2 is split, with 6 that of order 3.
    for mesh, pairs in ((whole, 3), (drilled(4), 2), (drilled(6), 2)):
        body = st.SolidBody(mesh, STEEL, fixed=["inner"], cutoff=3.5e3)
        hertz = body.modes().angular_frequency[:7] / (2.0 * np.pi)
        apart = np.diff(hertz) / hertz[1:]
        assert (apart < 1e-7).sum() == pairs
        assert apart[apart >= 1e-7].min() > 1e-4


@pytest.mark.parametrize(
    ("inside", "words"),
    [
        (lambda place: place[:, 0] > 1.0, "inside must hold the middles of some elements, not of all, got none"),
        (lambda place: place[:, 0] > -1.0, "inside must hold the middles of some elements, not of all, got all"),
        (lambda place: place, "inside must return a truth value for each of 60 places"),
        (lambda place: np.abs(place[:, 0] - 0.03) < 0.007, "elements must form one part, got 2"),
    ],
)
def test_cuts_that_leave_nothing_or_parts_are_refused(inside, words):
    with pytest.raises(ValueError, match=words):
        block("hexahedron20").cut(inside)


def test_names_and_ties_of_cut_meshes_are_checked():
    mesh = block("hexahedron20")
    with pytest.raises(ValueError, match="name must be that of no face yet, got 'top'"):
        mesh.cut(lambda place: place[:, 0] > 0.05, "top")
    part = st.SolidMesh.block((0.02, 0.01, 0.02), (2, 1, 2))
    tied = st.SolidMesh.tied({"low": part, "high": part.moved((0.0, 0.01, 0.0))}, [("low/top", "high/bottom")])
    with pytest.raises(ValueError, match="ties must be left out: cut the parts before they are tied"):
        tied.cut(lambda place: place[:, 0] > 0.01)
