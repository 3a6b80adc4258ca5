"""Parts of mesh files as bodies: names, places, groups and materials."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from written_decks import MATERIALS, brake_deck

import stridula as st
from stridula.doubtful import DoubtfulValue

TUTORIAL = Path(__file__).parents[2] / "examples" / "tutorials" / "brake.inp"
CUBE = """*NODE
1, 0, 0, 0
2, 10, 0, 0
3, 10, 10, 0
4, 0, 10, 0
5, 0, 0, 10
6, 10, 0, 10
7, 10, 10, 10
8, 0, 10, 10
*ELEMENT, TYPE=C3D8, ELSET=ALL
1, 1, 2, 3, 4, 5, 6, 7, 8
"""
SECTION = "*SOLID SECTION, ELSET=ALL, MATERIAL=STEEL\n*MATERIAL, NAME=STEEL\n"
STEEL = st.Material(2.1e11, 7800.0, 0.3)


def written(tmp_path, text, name="deck.inp"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def brake(tmp_path_factory):
    return st.read_parts(written(tmp_path_factory.mktemp("brake"), brake_deck()), scale=1e-3)


def test_the_deck_of_the_tutorial_is_the_one_of_the_tests():
    assert TUTORIAL.read_text(encoding="utf-8") == brake_deck()


def test_instances_are_parts_at_their_places(brake):
    assert list(brake) == ["DISC-1", "PAD-UPPER", "PAD-LOWER"]
    boxes = {name: np.array([one.mesh.nodes.min(axis=0), one.mesh.nodes.max(axis=0)]) for name, one in brake.items()}
    np.testing.assert_allclose(boxes["DISC-1"], [[-0.13, 0.0, -0.13], [0.13, 0.012, 0.13]], atol=1e-9)
    np.testing.assert_allclose(boxes["PAD-UPPER"][:, 1], [0.012, 0.027], atol=1e-12)
    np.testing.assert_allclose(boxes["PAD-LOWER"][:, 1], [-0.015, 0.0], atol=1e-12)
    # Half a turn about the z axis.
    upper, lower = (brake[name].mesh.nodes for name in ("PAD-UPPER", "PAD-LOWER"))
    np.testing.assert_allclose(lower, (upper - (0.0, 0.012, 0.0)) * (-1.0, -1.0, 1.0), atol=1e-12)


def test_parts_keep_their_groups(brake):
    assert {name: set(one.mesh.faces) for name, one in brake.items()} == {
        "DISC-1": {"UPPER", "LOWER", "HUB"},
        "PAD-UPPER": {"RUB", "BACK"},
        "PAD-LOWER": {"RUB", "BACK"},
    }
    for name, way in (("PAD-UPPER", -1.0), ("PAD-LOWER", 1.0)):
        face = brake[name].mesh.face("RUB")
        np.testing.assert_allclose(face.normal, np.tile((0.0, way, 0.0), (len(face.area), 1)), atol=1e-9)
        assert face.area.sum() == pytest.approx(0.4 * (0.125**2 - 0.085**2), rel=0.02)


def test_materials_are_in_si_units(brake):
    iron, lining, steel = (st.Material(1e6 * young, 1e12 * rho, nu) for young, nu, rho in MATERIALS.values())
    assert brake["DISC-1"].materials == iron
    for name in ("PAD-UPPER", "PAD-LOWER"):
        assert brake[name].materials == {"LINING": lining, "PLATE": steel}
        pad = st.SolidBody(brake[name].mesh, brake[name].materials, cutoff=8e3)
        volume = 0.4 * (0.125**2 - 0.085**2)
        assert pad.total_mass == pytest.approx(volume * (0.01 * lining.density + 0.005 * steel.density), rel=1e-4)


def test_bodies_of_a_deck_are_those_of_the_meshes(brake):
    """The same pad from the mesh without the deck has the same frequencies, up to the six digits of the deck."""
    made = st.SolidMesh.sector((0.085, 0.125), (-0.4, 0.4), {"LINING": 0.01, "PLATE": 0.005}, (2, 4, 1))
    part = brake["PAD-LOWER"]
    ours, theirs = (st.SolidBody(mesh, part.materials, cutoff=9e3) for mesh in (part.mesh, made))
    np.testing.assert_allclose(ours.modes().frequency, theirs.modes().frequency, rtol=1e-5, atol=1e-6)


def test_parts_are_short_in_print(brake):
    assert repr(brake["DISC-1"]) == "MeshPart('DISC-1', 0.26 x 0.012 x 0.26 m, 48 elements, 110 GPa, 7100 kg/m3)"
    assert "110 GPa" not in repr(brake["PAD-UPPER"])


def test_a_nastran_deck_gives_parts_and_materials(tmp_path):
    """Two blocks of two properties each: bodies are what share no node, not properties."""
    text, numbers = "BEGIN BULK\n", 0
    for block in range(2):
        for layer in range(3):
            for k, (x, y) in enumerate([(0, 0), (10, 0), (10, 10), (0, 10)]):
                text += f"GRID,{100 * block + 4 * layer + k + 1},,{x + 50.0 * block},{float(y)},{5.0 * layer}\n"
        for layer in range(2):
            numbers += 1
            grids = [100 * block + 4 * layer + k + 1 for k in range(8)]
            text += f"CHEXA,{numbers},{layer + 1},{','.join(map(str, grids[:6]))}\n,{grids[6]},{grids[7]}\n"
    text += "PSOLID,1,7\nPSOLID,2,8\nMAT1,7,8000.,,.25,2.5-9\nMAT1,8,210000.,80769.2,,7.8-9\nENDDATA\n"
    parts = st.read_parts(written(tmp_path, text, "two.bdf"), scale=1e-3)
    assert len(parts) == 2
    for part in parts.values():
        assert len(part.mesh.elements) == 2
        assert part.materials["1"] == st.Material(8e9, 2500.0, 0.25)
        assert part.materials["2"].poisson == pytest.approx(0.3, rel=1e-5)


def test_one_part_has_the_name_of_its_group_or_file(tmp_path):
    whole = SECTION + "*ELASTIC\n210000., .3\n*DENSITY\n7.8e-9\n"
    assert list(st.read_parts(written(tmp_path, CUBE + whole), scale=1e-3)) == ["ALL"]
    (part,) = st.read_parts(written(tmp_path, CUBE + whole), scale=1e-3).values()
    assert part.materials == STEEL
    other = CUBE.replace(", ELSET=ALL", "")
    assert list(st.read_parts(written(tmp_path, other, "lump.inp"), scale=1e-3)) == ["lump"]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("", "deck.inp' gives a material to 0 of 1 elements"),
        (SECTION + "*ELASTIC\n210000., .3\n", "STEEL has no density"),
        (SECTION + "*DENSITY\n7.8e-9\n", "STEEL has no Young's modulus, Poisson's ratio"),
    ],
)
def test_missing_materials_are_named_when_they_are_used(lines, words, tmp_path):
    (part,) = st.read_parts(written(tmp_path, CUBE + lines), scale=1e-3).values()
    assert words in part.missing
    assert words in repr(part)
    with pytest.raises(ValueError, match=r"materials must be given for the part 'ALL', got .*" + words[-20:]):
        _ = part.materials
    assert st.SolidBody(part.mesh, STEEL).total_mass == pytest.approx(7.8e-3)


def test_units_that_cannot_be_meant_are_doubted(tmp_path):
    text = CUBE + SECTION + "*ELASTIC\n2.1e11, .3\n*DENSITY\n7800.\n"
    with pytest.warns(DoubtfulValue, match="Young's modulus of 2.1e"):
        st.read_parts(written(tmp_path, text), scale=1e-3)


def test_sets_of_the_assembly_keep_their_names_beside_those_of_a_part(tmp_path):
    text = brake_deck().replace("*END ASSEMBLY", "*NSET, NSET=RUB, INSTANCE=PAD-UPPER\n1, 2\n*END ASSEMBLY")
    part = st.read_parts(written(tmp_path, text), scale=1e-3)["PAD-UPPER"]
    assert part.mesh.node_sets["RUB"].size == 2
    assert "PAD-UPPER.RUB" in part.mesh.faces


def test_a_group_of_faces_and_nodes_is_named_once(tmp_path):
    mesh = st.SolidMesh.read(written(tmp_path, CUBE + "*NSET, NSET=BASE\n1, 2, 3, 4\n"))
    assert "BASE" in mesh.faces
    assert repr(mesh) == "SolidMesh(8 nodes, 1 hexahedra of 8 nodes, groups ALL, BASE)"


@pytest.mark.parametrize(
    ("nodes", "name"), [("1, 2, 3, 4", "BASE"), ("1, 2, 3", "surface BASE"), ("1, 2, 3, 4, 5", "surface BASE")]
)
def test_a_surface_and_a_set_of_other_nodes_keep_apart(nodes, name, tmp_path):
    text = CUBE + f"*SURFACE, NAME=BASE\n1, S1\n*NSET, NSET=BASE\n{nodes}\n"
    mesh = st.SolidMesh.read(written(tmp_path, text))
    assert mesh.face(name).area.sum() == pytest.approx(100.0)
    assert mesh.node_sets["BASE"].size == len(nodes.split(","))


def test_a_body_is_read_by_its_part(tmp_path):
    path = written(tmp_path, brake_deck())
    pad = st.SolidBody.read(path, {"LINING": STEEL, "PLATE": STEEL}, scale=1e-3, part="pad-lower", cutoff=2e4)
    assert len(pad.mesh.elements) == 16
