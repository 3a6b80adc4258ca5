"""Tied meshes: names of groups, kinds of elements, refusals and doubts, equality, scenarios."""

from __future__ import annotations

import pickle
import warnings

import numpy as np
import pytest
import tomli_w

import stridula as st
from stridula.scenarios.load import with_matrices
from stridula.scenarios.read import names_files, read_tables

STEEL, LINING = st.Material(2.1e11, 7800.0), st.Material(5e9, 2500.0)
PLATE = st.SolidMesh.block((0.04, 0.02, 0.005), (4, 2, 1)).named("corner", [0]).moved((0.0, 0.0, 0.01))
PAD = st.SolidMesh.block((0.04, 0.02, 0.01), (6, 3, 2))
TIE = ("plate/back", "lining/front")


def tied(plate=PLATE, lining=PAD, ties=(TIE,), **options):
    return st.SolidMesh.tied({"plate": plate, "lining": lining}, ties, **options)


def refused(make, *words):
    with pytest.raises(st.ArgumentError) as caught:
        make()
    text = str(caught.value)
    assert "\n" not in text
    for word in words:
        assert word in text, text


def of_first_order(mesh):
    """Return a mesh of hexahedra without the nodes in the middle of edges."""
    used, number = np.unique(mesh.elements[:, :8], return_inverse=True)
    return st.SolidMesh(mesh.nodes[used], number.reshape(-1, 8), "hexahedron", faces=mesh.faces)


def of_tetrahedra(mesh):
    """Return a mesh of hexahedra as the package cuts it beside a tetrahedron."""
    single = st.SolidMesh(
        [[9, 9, 9], [10, 9, 9], [9, 10, 9], [9, 9, 10]], [[0, 1, 2, 3]], "tetra", faces={"a": [[0, 0]]}
    )
    parts = {"one": mesh, "far": single.moved((-8.0, -8.0, -8.0))}
    return st.bodies.solids.assembly.assembly(parts)


def test_groups_have_the_names_of_their_parts():
    mesh = tied()
    assert set(mesh.volumes) == {"plate", "lining"}
    assert len(mesh.volumes["plate"]) == 8
    assert len(mesh.volumes["lining"]) == 36
    assert set(mesh.faces) == {f"{part}/{face}" for part in ("plate", "lining") for face in PAD.faces}
    assert list(mesh.node_sets) == ["plate/corner"]
    for part, own in (("plate", PLATE), ("lining", PAD)):
        for face in own.faces:
            assert mesh.face(f"{part}/{face}").area.sum() == pytest.approx(own.face(face).area.sum(), rel=1e-12)
            np.testing.assert_allclose(mesh.face(f"{part}/{face}").normal, own.face(face).normal)
    body = st.SolidBody(mesh, {"plate": STEEL, "lining": LINING}, cutoff=3e4)
    assert body.point_names == ("plate/corner",)
    assert body.total_mass == pytest.approx(0.04 * 0.02 * (0.005 * 7800.0 + 0.01 * 2500.0), rel=1e-12)
    assert "1 tie" in repr(mesh)
    layers = st.SolidMesh.sector((0.1, 0.12), (0.0, 0.5), {"below": 0.01, "above": 0.01}, (1, 2, 1))
    assert "plate/above" in st.SolidMesh.tied({"plate": layers}, []).volumes


def test_tied_meshes_are_compared_by_content_and_travel():
    mesh, same = tied(), tied()
    assert mesh == same
    assert hash(mesh) == hash(same)
    assert mesh != tied(tolerance=1e-4)
    sent = pickle.loads(pickle.dumps(mesh))
    assert sent == mesh
    np.testing.assert_array_equal(sent.outer_faces, mesh.outer_faces)
    np.testing.assert_allclose((sent.moved((1.0, 0.0, 0.0)).shares - mesh.shares).toarray(), 0.0, atol=1e-9)


def test_meshes_without_ties_are_as_before():
    assert (PAD.shares != np.eye(len(PAD.nodes))).sum() == 0
    assert PAD.leads.all()
    one = st.SolidMesh.tied({"lining": PAD}, [])
    np.testing.assert_array_equal(one.nodes, PAD.nodes)
    np.testing.assert_array_equal(one.outer_faces, PAD.outer_faces)


@pytest.mark.parametrize("first", [True, False])
def test_parts_of_other_kinds_become_alike(first):
    plate, lining = (PLATE, of_first_order(PAD)) if first else (of_first_order(PLATE), PAD)
    assert tied(plate, lining).kind == "hexahedron20"
    both = tied(of_first_order(PLATE), of_first_order(PAD))
    assert both.kind == "hexahedron"
    # Middles of edges are tied, too.
    assert both.quadratic().leads.sum() == tied().leads.sum()
    assert st.SolidBody(both, STEEL, cutoff=3e4).mesh == both.quadratic()


@pytest.mark.parametrize("middles", [True, False])
def test_hexahedra_beside_tetrahedra_are_cut(middles):
    mesh = (PLATE if middles else of_first_order(PLATE)).named("edge", [0, 1])
    found = of_tetrahedra(mesh if middles else st.SolidMesh(mesh.nodes, mesh.elements, mesh.kind, faces=mesh.faces))
    assert found["kind"] == ("tetra10" if middles else "tetra")
    apart = st.SolidMesh(
        found["nodes"][: found["elements"][:-1].max() + 1],
        found["elements"][:-1],
        found["kind"],
        faces={name: one for name, one in found["faces"].items() if name != "far/a"},
    )
    assert apart.volume.sum() == pytest.approx(0.04 * 0.02 * 0.005, rel=1e-12)
    for face in mesh.faces:
        cut = apart.face(f"one/{face}")
        assert len(cut.area) == 2 * len(mesh.faces[face])
        assert cut.area.sum() == pytest.approx(mesh.face(face).area.sum(), rel=1e-12)
        np.testing.assert_allclose(cut.normal, mesh.face(face).normal[0] + 0.0 * cut.normal, atol=1e-12)
    assert len(apart.outer_faces) == sum(len(one) for one in apart.faces.values())
    if middles:
        assert found["node_sets"]["one/edge"].size >= 2


def test_elements_with_nodes_in_the_middle_of_faces_stay_alone():
    cube = st.SolidMesh(st.bodies.solids.kinds.KINDS["hexahedron27"].nodes, [range(27)], "hexahedron27")
    refused(
        lambda: st.SolidMesh.tied({"a": cube, "b": PAD}, []), "parts must have nodes in the middle of faces all or none"
    )


def test_wrong_names_are_refused():
    refused(lambda: tied(ties=[("plte/back", "lining/front")]), "ties[0][0]", "did you mean 'plate/back'?")
    refused(lambda: tied(ties=[TIE, ("plate/back", "lining/frnt")]), "ties[1][1]", "did you mean 'lining/front'?")
    refused(lambda: tied(ties=[("plate/back", "plate/back")]), "ties[0] must name two faces")
    refused(lambda: tied(ties=["plate/back"]), "ties[0] must be a pair of faces")
    refused(lambda: tied(ties=[("plate/back",)]), "ties[0] must be a pair of faces")
    refused(lambda: tied(ties=3), "ties must be")
    refused(lambda: tied(ties=[]), "elements must form one part", "2 that share no node")
    refused(lambda: tied(tolerance=0.0), "tolerance must be above 0")
    refused(lambda: st.SolidMesh.tied({}, []), "parts must hold at least one mesh")
    refused(lambda: st.SolidMesh.tied({"a/b": PAD}, []), "parts must have names", "'/'", "a/b")
    refused(lambda: st.SolidMesh.tied({"a": 3}, []), "parts['a']")
    refused(lambda: st.SolidMesh.tied([PAD], []), "parts")
    refused(lambda: st.SolidMesh.tied({"pad": tied(), "other": PAD}, []), "parts['pad'] must not be tied itself")
    third = PAD.moved((0.5, 0.0, 0.0))
    refused(
        lambda: st.SolidMesh.tied({"plate": PLATE, "lining": PAD, "third": third}, [TIE]),
        "elements must form one part",
        "2 that share no node and no tie",
    )


def test_faces_too_far_apart_are_refused_with_their_distance():
    refused(
        lambda: tied(PLATE.moved((0.0, 0.0, 0.002))),
        "ties[0] must name faces within 5% of an element",
        "'lining/front' 0.002 m from 'plate/back'",
        "same unit",
    )
    refused(lambda: tied(PLATE.moved((0.0, 0.0, 3.0))), "'lining/front' 3 m from 'plate/back'")
    refused(
        lambda: tied(PLATE.moved((0.0, 0.0, 1e-4)), tolerance=5e-5),
        "within 5e-05 m and half an element",
        "0.0001 m from",
    )
    refused(
        lambda: tied(PLATE.moved((0.0, 0.0, 0.004)), tolerance=0.01), "within 0.01 m and half an element", "0.004 m"
    )
    mesh = tied(PLATE.moved((0.0, 0.0, 0.002)), tolerance=0.0021)
    assert mesh.leads.sum() == tied().leads.sum()


def test_ties_in_a_circle_are_refused():
    refused(lambda: tied(ties=[TIE, TIE]), "ties[1] must name a second face that is free to follow")
    refused(lambda: tied(ties=[TIE, TIE[::-1]]), "ties[1]", "followed by 'lining/front'")


def test_a_part_that_is_not_tied_is_told():
    with pytest.warns(st.DoubtfulValue, match=r"'lining/front' is tied to 'plate/back' at \d+ of its 73 nodes") as told:
        mesh = tied(PLATE.moved((0.015, 0.0, 0.0)))
    assert len(told) == 1
    assert told[0].filename == __file__
    free = mesh.leads[mesh.nodes_of("lining/front")]
    np.testing.assert_array_equal(free, mesh.nodes[mesh.nodes_of("lining/front")][:, 0] < 0.0145)
    with pytest.warns(st.DoubtfulValue, match=r"did you mean to tie \('plate/back', 'lining/front'\)"):
        tied(ties=[TIE[::-1]])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        tied()
        tied().quadratic().moved((1.0, 0.0, 0.0))


def test_names_of_points_and_faces_of_a_body_follow():
    body = st.SolidBody(
        tied(),
        {"plate": STEEL, "lining": LINING},
        points={"tip": (0.0, 0.0, 0.0)},
        fixed={"plate/front": "xyz"},
        contact_faces={"lining/back": 6},
        cutoff=2e4,
    )
    assert body.at("lining/back[6]").body == body
    assert len(body.face_points("lining/back").area) == 6
    # A place on the seam moves alike whichever element holds it.
    place = (0.013, 0.009, 0.01)
    below, above = (body.trace((*place[:2], 0.01 + apart)) for apart in (-1e-9, 1e-9))
    np.testing.assert_allclose(below, above, atol=0.02 * np.abs(body.trace("tip")).max())
    refused(lambda: st.SolidBody(tied(), {"plate": STEEL}), "36 of 44 without a material", "lining")
    refused(lambda: st.SolidBody(tied(), STEEL, fixed=["front"]), "did you mean 'plate/front'?")


PARTS = {
    "plate": {"shape": "block", "lengths": ["40 mm", "20 mm", "5 mm"], "divisions": [4, 2, 1], "offset": [0, 0, 0.01]},
    "lining": {"shape": "block", "lengths": [0.04, 0.02, 0.01], "divisions": [6, 3, 2]},
}


def scenario(folder, mesh=None, **body):
    tables = {
        "bodies": {
            "pad": {
                "kind": "solid",
                "mesh": {"shape": "tied", "parts": PARTS, "ties": [list(TIE)], **(mesh or {})},
                "materials": {
                    "plate": {"young": 2.1e11, "density": 7800.0},
                    "lining": {"young": 5e9, "density": 2500.0},
                },
                "fixed": ["plate/front"],
                "cutoff": 3e4,
                **body,
            }
        },
        "contacts": [{"tip": {"body": "pad", "point": "lining/back"}, "track": {"kind": "rigid"}}],
        "simulation": {"duration": "1 ms"},
    }
    (folder / "case.toml").write_text(tomli_w.dumps(tables), encoding="utf-8")
    return folder / "case.toml"


def test_a_scenario_has_tied_parts(tmp_path):
    case = st.load_scenario(scenario(tmp_path))
    lined = st.SolidBody(
        tied(st.SolidMesh.block((0.04, 0.02, 0.005), (4, 2, 1)).moved((0.0, 0.0, 0.01))),
        {"plate": STEEL, "lining": LINING},
        fixed=["plate/front"],
        cutoff=3e4,
        name="pad",
    )
    assert case.system.bodies[0] == lined
    looser = st.load_scenario(scenario(tmp_path, {"tolerance": "0.1 mm", "offset": [0, 0, "1 mm"]}))
    assert looser.system.bodies[0].mesh.tolerance == 1e-4
    assert looser.system.bodies[0].mesh.nodes[:, 2].min() == pytest.approx(1e-3)


def test_problems_of_a_scenario_are_named_by_their_keys(tmp_path):
    def told(mesh):
        with pytest.raises(st.ScenarioError) as caught:
            st.load_scenario(scenario(tmp_path, mesh))
        assert "\n" not in str(caught.value)
        return str(caught.value)

    assert "bodies.pad.mesh.ties.0.1 must be one of" in told({"ties": [["plate/back", "lining/frnt"]]})
    assert "bodies.pad.mesh.ties.0 must be two names of faces" in told({"ties": [["plate/back"]]})
    bad = {"parts": {**PARTS, "lining": {**PARTS["lining"], "divisions": [6, 0, 1]}}}
    assert "bodies.pad.mesh.parts.lining.divisions must be" in told(bad)
    flat = {
        "parts": {
            **PARTS,
            "plate": {"shape": "sector", "radii": [2, 1], "angles": [0, 1], "height": 1, "divisions": [1, 1, 1]},
        }
    }
    assert "bodies.pad.mesh.parts.plate.radii must increase" in told(flat)


def test_files_of_parts_are_found_beside_the_scenario(tmp_path):
    """And known as files, which pages must not read; tables with their content are the same body."""
    deck = ["*NODE"]
    deck += [f"{k + 1}, {x:.17g}, {y:.17g}, {z:.17g}" for k, (x, y, z) in enumerate(1e3 * PAD.nodes)]
    deck.append("*ELEMENT, TYPE=C3D20, ELSET=ALL")
    for number, element in enumerate(PAD.elements + 1):
        deck.append(f"{number + 1}, " + ", ".join(map(str, element[:15])) + ",")
        deck.append(", ".join(map(str, element[15:])))
    deck += ["*NSET, NSET=FRONT"] + [str(node + 1) for node in PAD.nodes_of("front")]
    deck += ["*NSET, NSET=BACK"] + [str(node + 1) for node in PAD.nodes_of("back")]
    (tmp_path / "lining.inp").write_text("\n".join(deck) + "\n", encoding="utf-8")
    parts = {**PARTS, "lining": {"shape": "file", "file": "lining.inp", "scale": "1 mm"}}
    path = scenario(tmp_path, {"parts": parts, "ties": [["plate/back", "lining/FRONT"]]})
    text = path.read_text(encoding="utf-8").replace("lining/back", "lining/BACK")
    path.write_text(text, encoding="utf-8")
    tables = read_tables(path)
    assert names_files(tables["bodies"]["pad"])
    assert not names_files(read_tables(scenario(tmp_path))["bodies"]["pad"])
    path.write_text(text, encoding="utf-8")
    case = st.load_scenario(path)
    assert len(case.system.bodies[0].mesh.volumes["lining"]) == 36
    filled = with_matrices(tables, tables)
    assert not names_files(filled["bodies"]["pad"])
    assert filled["bodies"]["pad"]["mesh"]["ties"] == [["plate/back", "lining/FRONT"]]
