"""Solid bodies and their meshes: refusals, points, faces, equality, other processes."""

from __future__ import annotations

import pickle
import subprocess
import sys

import numpy as np
import pytest

import stridula as st
from stridula.bodies.reduction import factorisation, sparse_reduction
from stridula.bodies.reduction.factorisation import dissection, factorised
from stridula.bodies.solids.solid_body import _assembled

STEEL = st.Material(2.1e11, 7800.0, 0.3)
CUBE = st.SolidMesh.block((1.0, 1.0, 1.0), (1, 1, 1))
PAIR = st.SolidMesh.block((2.0, 1.0, 1.0), (2, 1, 1))


def refused(make, *words):
    with pytest.raises(st.ArgumentError) as caught:
        make()
    text = str(caught.value)
    assert "\n" not in text
    for word in words:
        assert word in text, text
    return caught.value


def parts(mesh, **changed):
    given = {name: getattr(mesh, name) for name in ("nodes", "elements", "kind", "volumes", "faces", "node_sets")}
    return st.SolidMesh(**{**given, **changed})


def test_inverted_elements_are_counted():
    nodes = PAIR.nodes.copy()
    nodes[:, 0] *= np.where(nodes[:, 0] > 1.0, 0.2, 1.0)
    refused(lambda: parts(PAIR, nodes=nodes), "positive Jacobian", "1 of 2", "number 1")
    refused(lambda: parts(PAIR, nodes=PAIR.nodes * [1, 1, -1]), "2 of 2")
    refused(lambda: parts(PAIR, nodes=PAIR.nodes * [1, 1, 0]), "2 of 2")


def test_disconnected_parts_are_counted():
    far = PAIR.nodes + np.array([0.0, 0.0, 5.0])
    both = np.vstack([PAIR.nodes, far])
    elements = np.vstack([PAIR.elements, PAIR.elements + len(PAIR.nodes)])
    refused(lambda: st.SolidMesh(both, elements, PAIR.kind), "elements must form one part", "2 that share no node")


def test_parts_that_hinge_on_an_edge_are_refused():
    nodes = np.array(list(np.ndindex(2, 2, 2)), dtype=float)
    far = nodes + np.array([1.0, 1.0, 0.0])
    both, number = np.unique(np.vstack([nodes, far]), axis=0, return_inverse=True)
    order = [0, 4, 6, 2, 1, 5, 7, 3]
    elements = number.reshape(2, 8)[:, order]
    for cutoff in (None, 1e4):
        hinged = st.SolidBody(st.SolidMesh(both, elements, "hexahedron"), STEEL, cutoff=cutoff)
        refused(hinged.modes, "mesh must be rigidly connected", "1 motions without stiffness")


def test_lonely_nodes_and_wrong_numbers_are_refused():
    lonely = np.append(CUBE.nodes, [[9.0, 9.0, 9.0]], axis=0)
    refused(lambda: parts(CUBE, nodes=lonely), "1 without", "number 20")
    refused(lambda: parts(CUBE, elements=CUBE.elements + 1), "from 0 to 19")
    refused(lambda: parts(CUBE, elements=CUBE.elements[:, :8]), "(elements, 20)")
    refused(lambda: parts(CUBE, kind="wedge"), "kind must be one of")
    refused(lambda: parts(CUBE, nodes=CUBE.nodes * np.nan), "nodes must be finite")
    refused(lambda: parts(CUBE, faces={"a": [[0, 6]]}), "faces['a']")
    refused(lambda: parts(CUBE, volumes={"a": [1]}), "volumes['a']")
    refused(lambda: CUBE.named("a", [20]), "node_sets['a']")
    twice = np.where(CUBE.elements == CUBE.elements[0, 0], CUBE.elements[0, 1], CUBE.elements)
    kept = np.unique(twice, return_inverse=True)
    refused(
        lambda: st.SolidMesh(CUBE.nodes[kept[0]], kept[1].reshape(1, -1), CUBE.kind),
        "elements must name each node once",
    )


def test_nodes_in_the_middle_of_an_edge_are_shared():
    elements = PAIR.elements.copy()
    shared = np.intersect1d(elements[0, 8:], elements[1, 8:])[0]
    elements[1, elements[1] == shared] = len(PAIR.nodes)
    nodes = np.vstack([PAIR.nodes, PAIR.nodes[shared]])
    refused(lambda: parts(PAIR, nodes=nodes, elements=elements, faces={}), "share the middle node")


@pytest.mark.parametrize("density", [7.8e-9, 7.8e-6])
def test_units_of_tonnes_and_millimetres_are_detected(density):
    steel = st.Material(210000.0, density)
    refused(lambda: st.SolidBody(CUBE, steel), "materials", "millimetres", "kg/m³")


def test_materials_cover_the_mesh_once():
    halves = parts(PAIR, volumes={"one": [0], "other": [1], "all": [0, 1]})
    refused(lambda: st.SolidBody(halves, {"one": STEEL}), "1 of 2 without a material", "other, all")
    refused(lambda: st.SolidBody(halves, {"one": STEEL, "all": STEEL}), "1 of 2 of two")
    refused(lambda: st.SolidBody(halves, {"ohter": STEEL}), "did you mean 'other'?")
    refused(lambda: st.SolidBody(CUBE, {"steel": STEEL}), "none")
    refused(lambda: st.SolidBody(CUBE, {}), "materials")
    refused(lambda: st.SolidBody(CUBE, 2.1e11), "materials", "Material")
    assert st.SolidBody(halves, {"one": STEEL, "other": STEEL}) != st.SolidBody(halves, STEEL)


def test_bad_fixed_faces_are_refused():
    refused(lambda: st.SolidBody(CUBE, STEEL, fixed=["lfet"]), "did you mean 'left'?")
    refused(lambda: st.SolidBody(CUBE, STEEL, fixed="left"), "fixed")
    refused(lambda: st.SolidBody(CUBE, STEEL, fixed={"left": "w"}), "directions of x, y and z")
    refused(lambda: st.SolidBody(CUBE, STEEL, fixed={"left": ""}), "directions of x, y and z")
    every = CUBE.named("every", np.arange(20))
    refused(lambda: st.SolidBody(every, STEEL, fixed=["every"]), "leave something free")


def test_a_cutoff_is_needed_for_many_degrees_of_freedom():
    large = st.SolidMesh.block((1.0, 1.0, 1.0), (7, 7, 7))
    refused(lambda: st.SolidBody(large, STEEL), "cutoff must be given for more than 4000")
    low = st.SolidBody(CUBE, STEEL, fixed=["left"], cutoff=1.0)
    refused(low.modes, "cutoff must leave at least one mode")
    counted = st.SolidBody(CUBE, STEEL, damping=[0.1, 0.1])
    refused(counted.modes, "damping must have one ratio or 60")


def test_a_cutoff_beyond_most_modes_finds_all_at_once(monkeypatch):
    mesh = st.SolidMesh.block((1.0, 1.0, 1.0), (3, 3, 3))
    every = st.SolidBody(mesh, STEEL).modes()
    body = st.SolidBody(mesh, STEEL, cutoff=2.0 * every.frequency[-1])
    assert every.count > 600
    np.testing.assert_array_equal(body.modes().angular_frequency, every.angular_frequency)
    monkeypatch.setattr(sparse_reduction, "MOST_MODES", 30)
    large = st.SolidMesh.block((1.0, 1.0, 1.0), (12, 6, 4))
    refused(st.SolidBody(large, STEEL, cutoff=1e5).modes, "cutoff must leave at most 30 modes", "100000 Hz")


def test_points_by_set_number_and_place():
    mesh = PAIR.named("tip", [5]).named("face", [1, 2])
    body = st.SolidBody(mesh, STEEL, {"a": 7, "b": (2.0, 1.0, 1.0), "c": "tip"})
    assert body.point_names == ("tip", "a", "b", "c")
    assert body.points["c"] == body.points["tip"] == 5
    np.testing.assert_array_equal(mesh.nodes[body.points["b"]], [2.0, 1.0, 1.0])
    assert body.at("a").point_name == "a"
    assert body.trace("a").shape == (3, body.modes().count)
    refused(lambda: st.SolidBody(mesh, STEEL, {"a": "face"}), "points['a']")
    refused(lambda: st.SolidBody(mesh, STEEL, {"a": 99}), "points['a']")
    refused(lambda: st.SolidBody(mesh, STEEL, {"a": (2.0, 1.0, 1.2)}), "points['a']", "nearest", "(2, 1, 1)")
    refused(lambda: st.SolidBody(mesh, STEEL, {"a": (2.0, 1.0)}), "points['a']")
    refused(lambda: body.at("d"), "position must be one of")
    refused(lambda: body.modes(held_x=True), "held_x")
    refused(lambda: body.modal_coordinates(np.zeros(3)), "vector")


def test_faces_are_kept_with_areas_and_normals():
    body = st.SolidBody(PAIR, STEEL)
    face = body.face("right")
    assert body.face_names == ("left", "right", "bottom", "top", "back", "front")
    assert face.nodes.shape == (1, 8)
    assert face.area == pytest.approx(1.0)
    np.testing.assert_allclose(face.normal, [[1.0, 0.0, 0.0]])
    refused(lambda: body.face("rihgt"), "did you mean 'right'?")


def test_linear_elements_become_quadratic_unless_kept():
    corners = parts(PAIR, nodes=PAIR.nodes[:12], elements=PAIR.elements[:, :8], kind="hexahedron", faces=PAIR.faces)
    assert st.SolidBody(corners, STEEL).mesh == PAIR
    assert st.SolidBody(corners, STEEL, linear=True).mesh == corners


def test_bad_shapes_are_refused():
    refused(lambda: st.SolidMesh.block((1, 1), (1, 1, 1)), "lengths must be three numbers")
    refused(lambda: st.SolidMesh.block((1, 1, -1), (1, 1, 1)), "lengths[2]")
    refused(lambda: st.SolidMesh.block((1, 1, 1), (1, 1, 0)), "divisions[2]")
    refused(lambda: st.SolidMesh.sector((2, 1), (0, 1), 1, (1, 1, 1)), "radii must increase")
    refused(lambda: st.SolidMesh.sector((1, 2), (0, 7), 1, (1, 1, 1)), "angles must increase, by at most 2 pi in all")
    refused(lambda: st.SolidMesh.sector((1, 2), (0, 1), 1, (1, 1, 1), axis="r"), "axis")
    refused(lambda: st.SolidMesh.extrusion([[0, 0], [1, 0], [1, 1]], [[0, 1, 2]], 1, 1), "(elements, 4)")
    refused(lambda: st.SolidMesh.extrusion([[0, 0], [0, 1], [1, 1], [1, 0]], [[0, 1, 2, 3]], 1, 1), "Jacobian")


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_drawn_meshes_stand_along_their_axis(axis):
    at = "xyz".index(axis)
    ring = st.SolidMesh.sector((1.0, 2.0), (0.0, np.pi / 2), 0.5, (1, 4, 1), axis)
    assert ring.size[at] == pytest.approx(0.5)
    np.testing.assert_allclose(ring.face("top").normal[:, at], 1.0)
    # The arc of parabolas keeps the area to (angle / 2)^4 / 180 of each element.
    assert ring.face("top").area.sum() == pytest.approx(0.75 * np.pi, rel=(np.pi / 16) ** 4)
    drawn = st.SolidMesh.extrusion([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2, 3]], 0.5, 2, axis)
    assert drawn.size[at] == 0.5
    assert drawn.face("side").area.sum() == pytest.approx(2.0)


def test_bodies_are_compared_by_content_and_travel_with_their_modes():
    body = st.SolidBody(PAIR, STEEL, {"tip": (2.0, 1.0, 1.0)}, ["left"], 2000.0)
    same = st.SolidBody(
        st.SolidMesh.block((2.0, 1.0, 1.0), (2, 1, 1)), STEEL, {"tip": (2.0, 1.0, 1.0)}, ["left"], 2000.0
    )
    assert body == same
    assert hash(body) == hash(same)
    assert body != st.SolidBody(PAIR, STEEL, {"tip": (2.0, 1.0, 1.0)}, ["left"], 2000.0, name="other")
    assert body.modes() is same.modes()
    sent = pickle.loads(pickle.dumps(body))
    assert sent == body
    assert "_reduction" in vars(sent)
    np.testing.assert_array_equal(sent.shapes, body.shapes)
    assert not sent.shapes.flags.writeable
    assert not sent.mesh.nodes.flags.writeable
    with pytest.raises(TypeError):
        body.points["tip"] = 3
    with pytest.raises(ValueError):
        body.mesh.nodes[0] = 1.0
    assert "40" not in repr(body) or repr(body).startswith("SolidBody(")


def test_modes_are_the_same_in_each_run():
    """The search starts from random numbers: equal to the last bit in another process."""
    code = (
        "import stridula as st; mesh = st.SolidMesh.block((0.1, 0.03, 0.02), (6, 3, 2));"
        "modes = st.SolidBody(mesh, st.Material(2.1e11, 7800.0), cutoff=4e4).modes();"
        "print(modes.angular_frequency.tobytes().hex())"
    )
    runs = {subprocess.run([sys.executable, "-c", code], capture_output=True, check=True).stdout for _ in range(2)}
    assert len(runs) == 1


def test_a_plain_import_brings_neither_library():
    code = "import stridula as st, sys; st.SolidBody; print({'skfem', 'meshio'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_dissection_orders_every_node_once_and_saves_entries():
    mesh = st.SolidMesh.block((1.0, 1.0, 1.0), (6, 6, 6))
    body = st.SolidBody(mesh, STEEL, cutoff=1e3)
    graph, stiffness = _assembled(body)
    order = dissection(graph, mesh.nodes)
    np.testing.assert_array_equal(np.sort(order), np.arange(len(mesh.nodes)))
    shifted = stiffness + 1e-3 * stiffness.diagonal().min() * _eye(stiffness.shape[0])
    right = np.random.default_rng(1).standard_normal((stiffness.shape[0], 2))
    by_dissection = factorised(shifted, (3 * order[:, None] + np.arange(3)).ravel())(right)
    # Rounding times the condition, the least eigenvalue being the shift.
    rounding = np.finfo(float).eps * np.abs(stiffness).sum(axis=0).max() / (1e-3 * stiffness.diagonal().min())
    np.testing.assert_allclose(by_dissection, factorised(shifted)(right), atol=rounding * np.abs(by_dissection).max())


def _eye(size):
    import scipy.sparse

    return scipy.sparse.eye_array(size, format="csr")


def test_coincident_places_are_dissected_too():
    graph = _eye(500)
    order = dissection(graph, np.zeros((500, 3)))
    np.testing.assert_array_equal(np.sort(order), np.arange(500))


def test_other_libraries_are_taken_where_they_are(monkeypatch):
    """The first installed library factorises."""
    asked = []

    def fake(matrix):
        asked.append(matrix.shape)
        dense = np.linalg.inv(matrix.toarray())
        return lambda right: dense @ right

    def broken(matrix):
        asked.append("broken")
        raise ImportError("no shared library")

    monkeypatch.setattr(factorisation, "find_spec", lambda name: object())
    monkeypatch.setattr(factorisation, "LIBRARIES", {"sksparse": broken, "pypardiso": fake})
    expected = st.SolidBody(PAIR, STEEL, {"tip": (2.0, 1.0, 1.0)}, ["left"], 2001.0).modes()
    assert asked[0] == "broken"
    assert len(asked) == 2
    monkeypatch.undo()
    found = st.SolidBody(PAIR, STEEL, {"tip": (2.0, 1.0, 1.0)}, ["left"], 2002.0).modes()
    np.testing.assert_allclose(found.angular_frequency, expected.angular_frequency, rtol=1e-9)
