"""`stridula mesh`: sizes, quality, mass and likely units of the parts of mesh files, and their drawing."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from written_decks import brake_deck

import stridula as st
from stridula import plot
from stridula.bodies.solids import mesh_quality
from stridula.bodies.solids.kinds import KINDS

STEEL = "MAT1,7,210000.,,.3,7.8-9\n"
WEDGES = """BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,10.,0.,0.
GRID,3,,10.,10.,0.
GRID,4,,0.,10.,0.
GRID,5,,0.,0.,5.
GRID,6,,10.,0.,5.
GRID,7,,10.,10.,5.
GRID,8,,0.,10.,5.
GRID,9,,0.,0.,7.
CPENTA,1,3,1,2,3,5,6,7
CPENTA,2,3,1,3,4,5,7,8
CBAR,3,4,1,9
CONM2,4,9,,1.
PSOLID,3,7
"""


def random_mesh(kind: str, rng: np.random.Generator) -> st.SolidMesh:
    """Return a mesh whose corners are shifted, with the middles of its edges in between."""
    x, y, z = np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij")
    nodes = np.stack([x, y, z], axis=-1).reshape(-1, 3) + rng.uniform(-0.2, 0.2, (64, 3))
    first = (16 * np.arange(3)[:, None, None] + 4 * np.arange(3)[:, None] + np.arange(3)).ravel()
    boxes = first[:, None] + np.array([0, 16, 20, 4, 1, 17, 21, 5])
    if kind.startswith("tetra"):
        order = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
        boxes = boxes[:, order].reshape(-1, 4)
    mesh = st.SolidMesh(nodes * rng.uniform(0.5, 2.0, 3), boxes, kind.rstrip("0123456789"))
    return mesh if kind == mesh.kind else mesh.quadratic()


@pytest.mark.parametrize("kind", ["tetra", "tetra10", "hexahedron", "hexahedron20"])
@pytest.mark.parametrize("seed", range(3))
def test_the_scaled_jacobian_is_that_of_verdict(kind, seed):
    pyvista = pytest.importorskip("pyvista")
    mesh = random_mesh(kind, np.random.default_rng(seed))
    corners = mesh.elements[:, : len(mesh.element_kind.corners)]
    cell = {4: pyvista.CellType.TETRA, 8: pyvista.CellType.HEXAHEDRON}[corners.shape[1]]
    grid = pyvista.UnstructuredGrid({cell: corners}, mesh.nodes)
    theirs = grid.cell_quality("scaled_jacobian").cell_data["scaled_jacobian"]
    np.testing.assert_allclose(mesh.scaled_jacobian, theirs, rtol=1e-9)


@pytest.mark.parametrize("kind", list(KINDS))
def test_regular_elements_have_a_scaled_jacobian_of_one(kind):
    """Also a turned one of any size; one whose height is a share of that of the regular element has less."""
    unit = KINDS[kind].nodes
    if kind.startswith("tetra"):
        # Three edges of a cube's diagonals.
        unit = unit @ np.array([[1.0, 1.0, 0.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]])[::-1]
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    elements = np.arange(len(unit))[None]
    values = [mesh_quality.scaled_jacobians(KINDS[kind], unit * flat @ turn, elements) for flat in (3.0, [1, 1, 1e-3])]
    np.testing.assert_allclose(values[0], 1.0, rtol=1e-12)
    assert values[1] < 0.01 if kind.startswith("tetra") else values[1] == pytest.approx(1.0)


@pytest.mark.parametrize("kind", ["tetra", "tetra10", "hexahedron", "hexahedron20"])
def test_volumes_add_up_to_that_inside_the_surface(kind):
    """By the theorem of Gauss over the faces cut into triangles, for random corners."""
    mesh = random_mesh(kind, np.random.default_rng(7))
    if kind.startswith("tetra"):
        a, b, c, d = mesh.nodes[mesh.elements[:, :4]].transpose(1, 0, 2)
        np.testing.assert_allclose(mesh.volume, np.einsum("ei,ei->e", np.cross(b - a, c - a), d - a) / 6.0, rtol=1e-12)
        return
    # A bilinear face and the mean of its two cuts have the same volume below them.
    pairs = [(k, side) for k in range(len(mesh.elements)) for side in range(6)]
    total = np.zeros(len(mesh.elements))
    for element, side in pairs:
        a, b, c, d = mesh.nodes[mesh.elements[element, list(mesh.element_kind.faces[side])]]
        for one in ((a, b, c), (a, c, d), (a, b, d), (b, c, d)):
            total[element] += np.dot(one[0], np.cross(one[1], one[2])) / 12.0
    np.testing.assert_allclose(mesh.volume, total, rtol=1e-12)


def test_the_mass_of_a_part_is_that_of_its_body(tmp_path):
    (tmp_path / "brake.inp").write_text(brake_deck(), encoding="utf-8")
    for part in st.read_parts(tmp_path / "brake.inp", scale=1e-3).values():
        body = st.SolidBody(part.mesh, part.materials, cutoff=2e3)
        assert part.mass == pytest.approx(body.total_mass, rel=1e-12)


def test_parts_of_a_deck_are_printed_and_drawn(stridula, tmp_path):
    Path("brake.inp").write_text(brake_deck(), encoding="utf-8")
    code, out, err = stridula("mesh", "brake.inp", "--scale", "1 mm", "--plot", "brake.png")
    assert (code, err) == (0, "")
    parts = st.read_parts("brake.inp", scale=1e-3)
    assert out.startswith("brake.inp: 3 parts\n")
    assert out.endswith("brake.png\n")
    for name, part in parts.items():
        assert f"\n{name} " in out
        assert f"{part.mass:.4g} kg" in out
    for words in (
        "0.26 x 0.012 x 0.26 m",
        "48 hexahedra of 20 nodes",
        "456, 1368 degrees of freedom",
        "LINING (8 elements)",
        "HUB (120 nodes)",
        "LINING: 8 GPa, 2500 kg/m³, Poisson's ratio 0.25",
        f"UPPER ({parts['DISC-1'].mesh.face('UPPER').area.sum():.4g} m²)",
    ):
        assert words in out
    assert (tmp_path / "brake.png").read_bytes().startswith(b"\x89PNG")
    alone = stridula("mesh", "brake.inp", "--scale", "0.001", "--part", "pad-lower")[1]
    assert "PAD-LOWER" in alone
    assert "PAD-UPPER" not in alone


def test_a_deck_of_wedges_with_other_things(stridula):
    Path("wedges.bdf").write_text(WEDGES, encoding="utf-8")
    code, out, err = stridula("mesh", "wedges.bdf", "--scale", "1 mm")
    assert (code, err) == (0, "")
    # Six tetrahedra of a box: its twelve edges, a diagonal on each of its six faces, one inside.
    assert "24, 72" not in out
    assert "2 wedges of 6 nodes, cut into 6 tetrahedra of 4 nodes" in " ".join(out.replace("│", " ").split())
    assert "8, 81 degrees of freedom with nodes in the middle of edges" in " ".join(out.split())
    assert "not read: 1 CBAR, 1 CONM2" in out
    assert "7 has no Young's modulus, density, Poisson's ratio" in " ".join(out.replace("│", " ").split())
    assert " kg" not in out
    Path("wedges.bdf").write_text(WEDGES + STEEL, encoding="utf-8")
    assert f"{7800.0 * 0.01 * 0.01 * 0.005:.4g} kg" in stridula("mesh", "wedges.bdf", "--scale", "1 mm")[1]


@pytest.mark.parametrize(
    ("scale", "material", "words"),
    [
        ("1", STEEL, "materials look like millimetres: try --scale 0.001"),
        ("1", "", "sizes look like millimetres: try --scale 0.001"),
        ("1 mm", STEEL, ""),
        ("1 mm", "", ""),
        ("1 um", "", "sizes look like millimetres: try --scale 0.001"),
        ("1 mm", "MAT1,7,2.1+11,,.3,7800.\n", "materials look like metres: try --scale 1"),
        ("1", "MAT1,7,2.1+11,,.3,7800.\n", ""),
        ("1", "MAT1,7,210.,,.3,7.8\n", "doubtful: density of 7.8 kg/m3; did you mean g/cm3?"),
    ],
)
def test_likely_units(scale, material, words, stridula):
    Path("wedges.bdf").write_text(WEDGES + material, encoding="utf-8")
    code, out, _ = stridula("mesh", "wedges.bdf", "--scale", scale)
    assert code == 0
    if words:
        assert out.splitlines()[-1] == words
    else:
        assert "look like" not in out
        assert "doubtful" not in out


def test_slivers_are_counted(stridula):
    Path("flat.bdf").write_text(WEDGES.replace("5.\n", "5-3\n") + STEEL, encoding="utf-8")
    out = " ".join(stridula("mesh", "flat.bdf", "--scale", "0.001")[1].replace("│", " ").split())
    assert "6 slivers below 0.2" in out


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("none.inp",), "cannot read 'none.inp'"),
        (("deck.stl",), "FILE must end in"),
        (("deck.bdf", "--part", "9"), "--part must be one of 3, got '9'"),
        (("deck.bdf", "--scale", "0"), "--scale must be"),
        (("deck.bdf", "--scale", "1 kg"), "--scale must be a number"),
        (("deck.bdf", "--plot", "mesh.docx"), "--plot must end in"),
        (("bad.bdf",), "line 1: "),
    ],
)
def test_errors_are_one_line(words, message, stridula):
    Path("deck.bdf").write_text(WEDGES, encoding="utf-8")
    Path("deck.stl").write_text("solid\n", encoding="utf-8")
    Path("bad.bdf").write_text("GRID,1,,a,0.,0.\n", encoding="utf-8")
    code, out, err = stridula("mesh", *words)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert message in err


def test_each_mesh_is_drawn_in_a_colour_of_its_own(tmp_path):
    (tmp_path / "brake.inp").write_text(brake_deck(), encoding="utf-8")
    parts = st.read_parts(tmp_path / "brake.inp", scale=1e-3)
    figure = plot.meshes(parts, title="brake")
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()][:3] == list(parts)
    assert len({to_rgb(patch.get_facecolor()) for patch in legend.get_patches()[:3]}) == 3
    for bad in ({}, {"a": 1}, [parts]):
        with pytest.raises(ValueError, match="meshes"):
            plot.meshes(bad)
