"""Faces in patches: areas, pressures, gaps and flexibility that do not depend on the mesh."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import scipy.sparse.linalg

import stridula as st
from stridula.bodies.reduction.sparse_reduction import COMPLIANCE
from stridula.bodies.solids import solid_body
from stridula.bodies.solids.face_patches import patched
from stridula.bodies.solids.places import face_mean
from stridula.bodies.solids.solid_body import _assembled
from stridula.doubtful import DoubtfulValue
from stridula.linear.equilibrium import find_equilibrium
from stridula.linear.structure import Structure

STEEL, LINING = st.Material(2.1e11, 7800.0, 0.3), st.Material(5e9, 2500.0, 0.25)
LONG, WIDE, THICK = 0.06, 0.04, 0.01
# Largest shift of a node, relative to an element.
SHIFT = 0.15
# The six tetrahedra of a hexahedron, by its corners.
KUHN = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]


def hexahedra(seed, divisions=(7, 5, 2)):
    """Return a plate of linear elements above z = 0 whose inner nodes are shifted at random."""
    mesh = st.SolidMesh.block((LONG, WIDE, THICK), divisions)
    corners, numbers = np.unique(mesh.elements[:, :8], return_inverse=True)
    nodes, rng = np.array(mesh.nodes[corners]), np.random.default_rng(seed)
    for axis, side in enumerate((LONG, WIDE, THICK)):
        inside = (nodes[:, axis] > 1e-9) & (nodes[:, axis] < side - 1e-9)
        nodes[inside, axis] += SHIFT * side / divisions[axis] * rng.uniform(-1.0, 1.0, inside.sum())
    return st.SolidMesh(nodes, numbers.reshape(-1, 8), "hexahedron")


def sole(mesh):
    """Return a mesh with the faces below z = 0 as a group."""
    kind, found = mesh.element_kind, []
    for element, side in itertools.product(range(len(mesh.elements)), range(len(mesh.element_kind.faces))):
        if np.all(mesh.nodes[mesh.elements[element, list(kind.faces[side])], 2] < 1e-9):
            found.append((element, side))
    return st.SolidMesh(mesh.nodes, mesh.elements, mesh.kind, faces={"sole": np.array(found)})


def plate(seed, kind="hexahedra", divisions=(7, 5, 2)):
    mesh = hexahedra(seed, divisions)
    if kind == "tetrahedra":
        elements = mesh.elements[:, KUHN].reshape(-1, 4)
        mesh = st.SolidMesh(mesh.nodes, elements, "tetra")
    return sole(mesh).quadratic()


KINDS = ["hexahedra", "tetrahedra"]


@pytest.mark.parametrize("division", [(6, 4), (5, 3), (1, 1), 24, 96, (17, 13)])
def test_cells_of_a_rectangle_are_equal_whatever_the_mesh(division):
    found = patched(plate(3, "tetrahedra"), "sole", division).points
    counts = division if isinstance(division, tuple) else {24: (6, 4), 96: (12, 8)}[division]
    np.testing.assert_allclose(found.area, LONG * WIDE / math.prod(counts), rtol=1e-9)
    x, y = ((np.arange(n) + 0.5) * side / n for n, side in zip(counts, (LONG, WIDE), strict=True))
    expected = np.array([(a, b, 0.0) for a in x for b in y])
    np.testing.assert_allclose(found.place, expected, atol=1e-9)
    np.testing.assert_allclose(found.normal, np.tile((0.0, 0.0, -1.0), (len(expected), 1)), atol=1e-9)
    # Lines of the grid are slightly bent on quadrilaterals that are no parallelograms.
    bent = patched(plate(3), "sole", counts).points
    assert np.abs(bent.place - expected).max() < 0.05 * LONG / 7.0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(5))
def test_a_uniform_pressure_is_that_of_the_face(kind, seed):
    """Also on faces turned in space, and with cells that are joined."""
    rng = np.random.default_rng(seed)
    mesh = plate(seed, kind).moved((0.1, -0.2, 0.3), rotation=tuple(rng.uniform(-3.0, 3.0, 3)))
    patches = patched(mesh, "sole", int(rng.integers(1, 200)))
    total = patches.points.area.sum()
    assert total == pytest.approx(LONG * WIDE, rel=1e-12)
    np.testing.assert_allclose(
        patches.points.area @ patches.mean.toarray() / total, face_mean(mesh, "sole"), atol=1e-12
    )
    # A linear displacement is met at the centres.
    slope = rng.normal(size=(3, 3))
    np.testing.assert_allclose(patches.mean @ (mesh.nodes @ slope.T), patches.points.place @ slope.T, atol=1e-12)


def test_the_grid_follows_the_sides_of_a_turned_face():
    angle = 0.4
    flat = patched(plate(0), "sole", (6, 4)).points
    mesh = plate(0).moved(rotation=(0.0, 0.0, angle))
    turned = patched(mesh, "sole", (6, 4)).points
    way = np.array([[math.cos(angle), -math.sin(angle), 0.0], [math.sin(angle), math.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    expected = {tuple(one) for one in (flat.place @ way.T).round(9) + 0.0}
    assert {tuple(one) for one in turned.place.round(9) + 0.0} == expected


def test_a_ring_is_divided_without_slivers_and_a_rim_on_all_sides():
    mesh = st.SolidMesh.sector((0.05, 0.09), (0.0, 2.0 * math.pi), 0.01, (5, 40, 1)).quadratic()
    top = patched(mesh, "top", 60).points
    assert 40 <= len(top.area) <= 80
    assert top.area.min() > 0.2 * top.area.max()
    assert top.area.sum() == pytest.approx(math.pi * (0.09**2 - 0.05**2), rel=1e-5)
    rim = patched(mesh, "outer", 40).points
    assert rim.area.sum() == pytest.approx(math.pi * 0.18 * 0.01, rel=1e-5)
    radius = np.hypot(rim.place[:, 0], rim.place[:, 2])
    assert np.all((radius > 0.085) & (radius < 0.0901))
    with pytest.raises(ValueError, match="have one number for a face that is not nearly flat"):
        patched(mesh, "outer", (8, 5))


def body(mesh, division, cutoff=2e4, **words):
    return st.SolidBody(mesh, LINING, cutoff=cutoff, contact_faces={"sole": division}, **words)


@pytest.mark.parametrize("kind", KINDS)
def test_patches_keep_their_static_flexibility(kind):
    """Against the solution of all degrees of freedom of a held plate."""
    mesh = plate(1, kind, (6, 4, 2))
    held = np.flatnonzero(mesh.nodes[:, 2] > THICK - 1e-9)
    mesh = st.SolidMesh(mesh.nodes, mesh.elements, mesh.kind, faces=mesh.faces, node_sets={"top": held})
    plated = body(mesh, 40, fixed=["top"], cutoff=9e4)
    patches = plated.patches("sole")
    free = plated._free
    loads = np.kron(patches.mean.toarray().T, np.eye(3))
    answers = scipy.sparse.linalg.spsolve(_assembled(plated)[1][free][:, free].tocsc(), loads[free])
    exact = loads[free].T @ answers
    modes = plated.modes()
    traces = np.concatenate([plated.trace(f"sole[{k + 1}]") for k in range(len(patches.points.area))])
    stiff = np.where(modes.massless, 1.0, modes.angular_frequency)
    ours = (traces / stiff**2) @ traces.T
    scale = np.sqrt(np.diag(exact))
    lost = (exact - ours) / scale[:, None] / scale
    assert np.abs(lost).max() < COMPLIANCE
    # Without residual shapes a large part is missing.
    alone = (traces[:, ~modes.massless] / stiff[~modes.massless] ** 2) @ traces[:, ~modes.massless].T
    assert np.abs((exact - alone) / scale[:, None] / scale).max() > 0.1


def test_residual_shapes_of_many_patches_are_compressed():
    mesh = plate(2, "hexahedra", (4, 3, 2))
    plated = body(mesh, 400)
    count = int(plated.modes().massless.sum())
    assert 20 < count < 3 * len(plated.face_points("sole").area) / 4


def test_the_deflection_under_a_patch_does_not_depend_on_the_mesh():
    found = []
    for kind, divisions in (("hexahedra", (9, 6, 3)), ("tetrahedra", (12, 9, 4))):
        mesh = plate(4, kind, divisions)
        held = np.flatnonzero(mesh.nodes[:, 2] > THICK - 1e-9)
        mesh = st.SolidMesh(mesh.nodes, mesh.elements, mesh.kind, faces=mesh.faces, node_sets={"top": held})
        plated = body(mesh, (6, 4), fixed=["top"], cutoff=9e4)
        modes = plated.modes()
        stiff = np.where(modes.massless, 1.0, modes.angular_frequency)
        traces = np.concatenate([plated.trace(f"sole[{k + 1}]")[2:] for k in range(24)])
        found.append(np.sum((traces / stiff) ** 2, axis=1))
    np.testing.assert_allclose(*found, rtol=0.05)


def test_names_and_places_of_patches():
    plated = body(plate(0, "tetrahedra"), (6, 4), name="plate")
    assert plated.at("sole[1]").place == pytest.approx((0.005, 0.005, 0.0))
    assert plated.contact_point("sole", 23).position == "sole[24]"
    for wrong in ("sole[0]", "sole[25]", "sole[-1]", "sole[1", "sole[]", "other[1]"):
        with pytest.raises(ValueError, match=r"position must be one of .*got '"):
            plated.at(wrong)
    face = st.SurfaceContact(plated, "sole", st.RigidTrack(1.0), friction=st.Coulomb(0.3))
    assert [one.tip.position for one in face.contacts] == [f"sole[{k + 1}]" for k in range(24)]
    assert face.areas.sum() == pytest.approx(LONG * WIDE)


def test_a_point_may_not_have_the_name_of_a_patch():
    with pytest.raises(
        ValueError, match=r"points must not have the name of a contact point of a face, got 'sole\[3\]'"
    ):
        body(plate(0), 24, points={"sole[3]": 0})
    assert body(plate(0), 24, points={"sole[300]": 0}).at("sole[300]").place == pytest.approx(plate(0).nodes[0])


def test_points_of_a_face_are_short_in_print():
    assert repr(body(plate(0), 24).face_points("sole")) == "FacePoints(24 points, 0.0024 m2)"


def test_the_usual_division_is_the_points_of_integration_if_they_are_few():
    few, many = plate(0, divisions=(4, 4, 1)), plate(0, divisions=(5, 4, 1))
    assert len(st.SolidBody(few, LINING, cutoff=2e4, contact_faces=["sole"]).face_points("sole").area) == 64
    assert len(st.SolidBody(many, LINING, cutoff=2e4, contact_faces=["sole"]).face_points("sole").area) == 32
    assert len(st.SolidBody(many, LINING, cutoff=2e4).face_points("sole").area) == 32
    assert len(body(many, "integration").face_points("sole").area) == 80


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (3, "contact_faces must be names of faces, or divisions by name"),
        ({"sole": 0}, r"contact_faces\['sole'\] must be .*1.*, got 0"),
        ({"sole": 2.5}, r"contact_faces\['sole'\] must be a number of patches, two numbers of cells or 'integration'"),
        ({"sole": (3, 0)}, r"contact_faces\['sole'\]\[1\] must be"),
        ({"sole": (3,)}, r"contact_faces\['sole'\] must be a number of patches"),
        ({"sole": (100, 100)}, r"contact_faces\['sole'\] must be .*got 10000"),
        ({"sole": "all"}, "'integration', got 'all'"),
        ({"slo": 3}, "contact_faces must be one of sole, got 'slo'"),
    ],
)
def test_divisions_that_are_refused(given, words):
    with pytest.raises(ValueError, match=words):
        st.SolidBody(plate(0), LINING, cutoff=2e4, contact_faces=given)


def test_bodies_beyond_the_memory_are_refused_before_the_work(monkeypatch):
    plated = body(plate(0), 24)
    monkeypatch.setattr(solid_body, "available_memory", lambda: 1e6)
    with pytest.raises(ValueError, match=r"contact_faces must need less memory than there is, got .* for 72 residual"):
        plated.modes()


def test_long_work_is_mentioned_before_it_begins(monkeypatch):
    """With a limit so low that a small body exceeds it."""
    monkeypatch.setattr(solid_body, "LONG", 1e-3)
    with pytest.warns(DoubtfulValue, match=r"72 residual shapes of \d+ degrees of freedom take some .* min and .* GiB"):
        body(plate(0), (6, 4)).modes()


def test_more_points_than_can_be_marched_are_mentioned():
    plated = body(plate(0, divisions=(4, 3, 1)), 300)
    with pytest.warns(DoubtfulValue, match=r"\d+ points of 'surface': a second of motion with 120 takes minutes"):
        st.SurfaceContact(plated, "sole", st.RigidTrack(1.0))


def test_gaps_of_concentric_surfaces_are_means():
    """The centre of a patch lies within the surface; the mean gap between concentric arcs is exact."""
    angle, gap, radius = 0.5, 2e-5, 0.1
    turned = (0.5 * math.pi - angle, 0.5 * math.pi + angle)
    pad = st.SolidMesh.sector((radius - 0.01, radius), turned, 0.03, (2, 24, 6), axis="y").quadratic()
    ring = st.AxisymmetricBody(
        st.RectangleProfile({"ring": ((radius + gap, radius + 0.02), (-0.01, 0.04))}), STEEL, 5e3, "top", axis=(0, 1, 0)
    )
    shoe = st.SolidBody(pad, LINING, cutoff=2e4, contact_faces={"outer": (5, 2)})
    face = st.SurfaceContact(shoe, "outer", ring, friction=st.Coulomb(0.3))
    np.testing.assert_allclose([one.gap for one in face.contacts], gap, rtol=1e-3)
    inside = radius - np.hypot(face.places[:, 0], face.places[:, 2])
    assert inside.min() > 5.0 * gap


@pytest.mark.parametrize("seed", range(4))
def test_a_pressed_pad_balances_its_load_and_moments(seed):
    rng = np.random.default_rng(seed)
    force, place = 500.0, np.array([*rng.uniform(0.35, 0.65, 2) * (LONG, WIDE), 0.5 * THICK])
    ends = [(0.0, 0.0, THICK), (LONG, 0.0, THICK), (0.0, WIDE, THICK)]
    pad = body(plate(seed), int(rng.integers(20, 60)))
    face = st.SurfaceContact(pad, "sole", st.RigidTrack(0.0))
    springs = [st.Spring(pad.at(one), stiffness=1e5, direction=way) for one in ends for way in "xy"]
    system = st.System(face, [st.Force(pad.at(tuple(place.tolist())), z=-force)], springs)
    normal = find_equilibrium(Structure(system), np.zeros(len(face.contacts))).normal_force
    assert normal.min() >= 0.0
    assert np.ptp(normal / face.areas) > 0.0
    assert normal.sum() == pytest.approx(force, rel=1e-9)
    np.testing.assert_allclose(normal @ face.places[:, :2] / force, place[:2], rtol=1e-3)
