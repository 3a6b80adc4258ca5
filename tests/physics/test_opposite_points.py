"""Points of two faces opposite each other, also curved: where they are, and the layer and the contact between them."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula import analysis
from stridula.bodies.solids.kinds import KINDS
from stridula.bodies.solids.opposite import opposite_place
from stridula.bodies.solids.places import on_facet

STEEL = st.Material(young=210e9, density=7800.0, poisson=0.3)


def block(sides, divisions, corner=(0.0, 0.0, 0.0), rotation=(0.0, 0.0, 0.0), name=""):
    mesh = st.SolidMesh.block(sides, divisions).moved(corner, rotation)
    return st.SolidBody(mesh, STEEL, cutoff=20e3, name=name)


@pytest.mark.parametrize("seed", range(4))
def test_points_lie_on_both_faces_opposite_each_other(seed):
    """Blocks of random sizes, meshes and positions, turned as a whole."""
    random = np.random.default_rng(seed)
    sides, gap = random.uniform(0.02, 0.06, 3), random.uniform(0.0, 1e-3)
    rotation = random.standard_normal(3)
    lower = block(sides, random.integers(1, 4, 3), rotation=rotation, name="lower")
    wide = sides * [1.5, 1.0, 1.5]
    mesh = st.SolidMesh.block(wide, random.integers(1, 4, 3)).moved((-0.2 * sides[0], sides[1] + gap, -0.2 * sides[2]))
    upper = st.SolidBody(mesh.moved((0.0, 0.0, 0.0), rotation), STEEL, cutoff=20e3, name="upper")
    wanted = int(random.integers(4, 20))
    first, second, area = st.opposite_points(lower, "top", upper, "bottom", points=wanted)
    assert area.sum() == pytest.approx(sides[0] * sides[2])
    assert 0.5 * wanted <= len(first) <= 2 * wanted
    normal = lower.face("top").normal[0]
    for one, other in zip(first, second, strict=True):
        np.testing.assert_allclose(other.place - one.place, gap * normal, atol=1e-12)
    middle = area @ np.array([one.place for one in first]) / area.sum()
    expected = lower.face_points("top")
    np.testing.assert_allclose(middle, expected.area @ expected.place / expected.area.sum(), atol=1e-12)


def test_a_layer_has_its_stiffness_whatever_the_meshes():
    """A uniform approach of the faces: the shares of the pairs add up to the whole."""
    lower, upper = (
        block((0.04, 0.01, 0.03), (3, 1, 2), name="lower"),
        block((0.04, 0.01, 0.03), (2, 1, 5), (0.0, 0.011, 0.0), name="upper"),
    )
    first, second, area = st.opposite_points(lower, "top", upper, "bottom", points=9)
    layer = st.viscoelastic_layer(
        first, second, area=area, frequency=[1e3], stiffness={"y": [2e8], "x": [1e7]}, loss_factor=[0.2]
    )
    for direction, whole in (("y", 2e8), ("x", 1e7)):
        parts = [float(np.real(one.complex_stiffness(1e3))) for one in layer if one.direction == direction]
        assert sum(parts) == pytest.approx(whole, rel=1e-3)


def test_points_on_curved_faces_lie_on_them():
    lining = st.SolidMesh.sector((0.05, 0.06), (-0.3, 0.3), 0.02, (1, 8, 2), axis="z")
    drum = st.SolidMesh.sector((0.06, 0.07), (-0.5, 0.5), 0.02, (1, 9, 3), axis="z")
    inner, outer = (
        st.SolidBody(mesh, STEEL, cutoff=2e4, name=name) for mesh, name in ((lining, "lining"), (drum, "drum"))
    )
    first, second, area = st.opposite_points(inner, "outer", outer, "inner", points=10)
    radii = np.array([[np.hypot(*one.place[:2]) for one in points] for points in (first, second)])
    np.testing.assert_allclose(radii, 0.06, rtol=2e-3)
    assert area.sum() == pytest.approx(0.6 * 0.06 * 0.02, rel=2e-3)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"face": "topp"}, "face must be one of .*did you mean 'top'"),
        ({"other_face": "side"}, "other_face must be one of"),
        ({"points": 0}, "points must be"),
        ({"body": st.PointMass(1.0)}, "body must be a SolidBody"),
        ({"other_face": "top"}, "farthest must be at least the distance between the faces, got 0.02 m at"),
        ({"farthest": 1e-5}, "farthest must be at least the distance between the faces, got 0.001 m at"),
        ({"other": "beside"}, "other_face must lie opposite the whole face 'top', got nothing opposite"),
    ],
)
def test_faces_that_do_not_meet_are_refused(change, message):
    bodies = {
        "above": block((0.04, 0.019, 0.03), (1, 1, 1), (0.0, 0.011, 0.0), name="above"),
        "beside": block((0.04, 0.019, 0.03), (1, 1, 1), (0.03, 0.011, 0.0), name="beside"),
    }
    given = {"body": block((0.04, 0.01, 0.03), (1, 1, 1)), "face": "top", "other": "above", "other_face": "bottom"}
    given |= change
    given["other"] = bodies[given["other"]]
    with pytest.raises(ValueError, match=message):
        st.opposite_points(**given)


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron", "hexahedron20", "hexahedron27", "tetra"])
def test_a_line_meets_a_curved_facet_where_its_shape_functions_are(kind):
    """Facets of elements whose nodes are displaced at random."""
    random = np.random.default_rng(len(kind))
    nodes = KINDS[kind].nodes + 0.04 * random.standard_normal(KINDS[kind].nodes.shape)
    sides = range(len(KINDS[kind].faces))
    faces = {f"side {one}": [[0, one]] for one in sides}
    mesh = st.SolidMesh(nodes, [list(range(len(nodes)))], kind, faces=faces)
    for side in sides:
        for _ in range(10):
            u, v = random.uniform(0.05, 0.45, 2)
            at, first, second, _ = on_facet(mesh, mesh.faces[f"side {side}"][0], np.array([[u, v]]))
            normal = np.cross(first[0], second[0])
            normal = normal / np.linalg.norm(normal) + 0.1 * random.standard_normal(3)
            normal /= np.linalg.norm(normal)
            there, facing, distance = opposite_place(mesh, f"side {side}", at[0] - 0.02 * normal, normal)
            np.testing.assert_allclose(there, at[0], atol=1e-12)
            assert distance == pytest.approx(0.02, abs=1e-12)
            np.testing.assert_array_equal(facing, normal)
    aside = np.add(mesh.nodes.mean(axis=0), (30.0, 0.0, 0.0))
    assert opposite_place(mesh, "side 0", aside, np.array([0.0, 1.0, 0.0])) is None


def drum_and_shoe(play, inside):
    """Return a shoe and a drum about the z axis, of radii that differ by the play: the shoe inside or outside."""
    radius, thick = 0.06, 0.01
    own = (radius - play - thick, radius - play) if inside else (radius + play, radius + play + thick)
    others = (radius, radius + thick) if inside else (radius - thick, radius)
    sectors = (own, (-0.3, 0.3), 9, "shoe"), (others, (-0.5, 0.5), 13, "drum")
    return [
        st.SolidBody(st.SolidMesh.sector(radii, angles, 0.02, (1, count, 2), axis="z"), STEEL, cutoff=2e4, name=name)
        for radii, angles, count, name in sectors
    ]


@pytest.mark.parametrize("inside", [True, False])
@pytest.mark.parametrize("play", [0.0, 2e-5, 1e-3])
def test_gaps_of_round_faces_are_their_play(inside, play):
    """A face outside whose facets were taken for flat had gaps wrong by 3e-5 m; one inside was refused."""
    shoe, drum = drum_and_shoe(play + 1e-7, inside)
    faces = ("outer", "inner") if inside else ("inner", "outer")
    contact = st.SurfaceContact(shoe, faces[0], drum, faces[1], friction=st.Coulomb(0.3), stiffness=1e12)
    gaps = np.array([one.gap for one in contact.contacts])
    np.testing.assert_allclose(gaps, play, atol=3e-7)


def test_a_shoe_in_a_turning_drum_takes_the_power_of_its_normal_force():
    """Friction times radius times angular velocity times the sum of the normal forces; its load is carried."""
    shoe, drum = drum_and_shoe(0.0, inside=True)
    turning = ((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), 10.0)
    face = st.SurfaceContact(
        shoe, "outer", drum, "inner", friction=st.Coulomb(0.3), gap=1e-7, stiffness=1e12, turning=turning, name="shoe"
    )
    mounts = [
        st.Spring(one.at(side), stiffness=1e8, direction=way)
        for one in (shoe, drum)
        for side in ("start", "end")
        for way in "xyz"
        if not (one is shoe and way == "x")
    ]
    system = st.System(face, [st.Force(shoe.at("inner"), x=500.0), st.InitialEquilibrium()], mounts)
    found = analysis.surface(st.simulate(system, duration=2e-4, probes=()), face).isel(time=0)
    pressed = float((found.pressure * face.areas).sum())
    assert float(found.friction_power) == pytest.approx(0.3 * pressed * 0.06 * 10.0, rel=1e-3)
    assert float(found.force.sel(axis="x")) == pytest.approx(-500.0, rel=1e-6)
    assert (found.pressure > 0.0).all()
