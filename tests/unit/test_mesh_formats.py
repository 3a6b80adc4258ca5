"""Meshes in MED, Medit and universal files: files of gmsh 4.15, and random meshes written by meshio and by hand."""

from __future__ import annotations

import warnings
from pathlib import Path

import h5py
import meshio
import numpy as np
import pytest
from test_mesh_command import random_mesh

import stridula as st
from stridula.bodies.solids.cut_elements import CUT_KINDS
from stridula.bodies.solids.kinds import KINDS
from stridula.doubtful import DoubtfulValue

# A block of 50 mm x 40 mm x 30 mm with groups, in each kind of elements.
FILES = sorted((Path(__file__).parent / "meshes").iterdir())
SIDES = (0.05, 0.04, 0.03)
COUNTS = {"tetra": (12, 12), "wedge": (12, 12), "hexahedron": (12, 2), "hexahedron20": (32, 2), "hexahedron27": (45, 2)}
COUNTS |= {"tetra10": (45, 12), "wedge15": (45, 12)}


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_meshes_of_gmsh(path):
    """Volume, areas, numbers, and middle nodes that are in the middle of their edges and faces."""
    mesh = st.SolidMesh.read(path)
    assert (len(mesh.nodes), len(mesh.elements)) == COUNTS[path.stem]
    np.testing.assert_allclose(mesh.size, SIDES, rtol=1e-9)
    assert mesh.volume.sum() == pytest.approx(np.prod(SIDES), rel=1e-9)
    assert (mesh.volume > 0.0).all()
    kind = mesh.element_kind
    if kind.middles:
        corners = mesh.nodes[mesh.elements[:, : len(kind.corners)]]
        groups = [*kind.edges, *(kind.faces if kind.middles == 2 else ())]
        for at, those in enumerate(groups, len(kind.corners)):
            np.testing.assert_allclose(
                mesh.nodes[mesh.elements[:, at]], corners[:, list(those)].mean(axis=1), atol=1e-9
            )
    is_medit = path.suffix == ".mesh"
    volume, bottom, top, edge = (
        ("volume 1", "face 1", "face 26", "edge 1") if is_medit else ("steel", "bottom", "top", "edge")
    )
    assert list(mesh.volumes) == [volume]
    assert mesh.volumes[volume].size == len(mesh.elements)
    for name, height, way in ((bottom, 0.0, -1.0), (top, 0.03, 1.0)):
        face = mesh.face(name)
        assert face.area.sum() == pytest.approx(0.05 * 0.04, rel=1e-9)
        np.testing.assert_allclose(face.normal, np.tile([0.0, 0.0, way], (len(face.area), 1)), atol=1e-9)
        np.testing.assert_allclose(mesh.nodes[face.nodes][..., 2], height, atol=1e-12)
    along = mesh.nodes[mesh.node_sets[edge]]
    assert len(along) == (3 if kind.middles else 2)
    np.testing.assert_allclose(along[:, 1:], 0.0, atol=1e-12)


def test_each_kind_has_a_file_of_gmsh():
    """Pyramids are not among them: gmsh writes none to universal files, and needs a mesh of its own for others."""
    stems = {ending: {path.stem for path in FILES if path.suffix == ending} for ending in (".med", ".unv", ".mesh")}
    assert stems[".med"] == (set(KINDS) | set(CUT_KINDS)) - {"pyramid", "pyramid13"}
    assert stems[".unv"] == stems[".med"] - {"hexahedron27"}
    assert stems[".mesh"] == {"tetra", "tetra10", "hexahedron"}


# Places of corners and middles in universal files: they take turns around each face.
ROUND = {
    "tetra": [0, 1, 2, 3],
    "hexahedron": [*range(8)],
    "tetra10": [0, (0, 1), 1, (1, 2), 2, (2, 0), (0, 3), (1, 3), (2, 3), 3],
    "hexahedron20": [
        *(0, (0, 1), 1, (1, 2), 2, (2, 3), 3, (3, 0), (0, 4), (1, 5), (2, 6), (3, 7)),
        *(4, (4, 5), 5, (5, 6), 6, (6, 7), 7, (7, 4)),
    ],
}
TYPES = {"tetra": 111, "tetra10": 118, "hexahedron": 115, "hexahedron20": 116}


def universal(mesh, rng, names: dict[str, tuple[list[int], list[int]]], mirrored: bool = False) -> str:
    """Return a universal file with labels in any order; groups are given by nodes and elements."""
    nodes = rng.permutation(9 * len(mesh.nodes))[: len(mesh.nodes)] + 1
    labels = rng.permutation(9 * len(mesh.elements))[: len(mesh.elements)] + 1
    lines = [
        "    -1",
        "   164",
        "         1  SI: Meters           2",
        "  1. 1. 1.",
        "  0.",
        "    -1",
        "    -1",
        "  2411",
    ]
    for at in rng.permutation(len(nodes)):
        lines.append(f"{nodes[at]:10d}         1         1        11")
        lines.append("".join(f"{value:25.16E}" for value in mesh.nodes[at]).replace("E", "D"))
    lines += ["    -1", "    -1", "  2412"]
    pairs = [frozenset(edge) for edge in mesh.element_kind.edges]
    corners = len(mesh.element_kind.corners)
    swap = {0: 0, 1: 3, 2: 2, 3: 1, 4: 4, 5: 7, 6: 6, 7: 5} if corners == 8 else {0: 0, 1: 2, 2: 1, 3: 3}
    for at in rng.permutation(len(labels)):
        turned = swap if mirrored else {k: k for k in swap}
        row = [
            turned[one] if isinstance(one, int) else corners + pairs.index(frozenset(turned[k] for k in one))
            for one in ROUND[mesh.kind]
        ]
        words = nodes[mesh.elements[at, row]].tolist()
        lines.append(f"{labels[at]:10d}{TYPES[mesh.kind]:10d}         1         1         7{len(words):10d}")
        lines += ["".join(f"{one:10d}" for one in words[k : k + 8]) for k in range(0, len(words), 8)]
    lines += ["    -1", "    -1", "  2467"]
    for number, (name, (points, elements)) in enumerate(names.items(), 1):
        members = [f"{7:10d}{nodes[k]:10d}{0:10d}{0:10d}" for k in points]
        members += [f"{8:10d}{labels[k]:10d}{0:10d}{0:10d}" for k in elements]
        lines += [f"{number:10d}" + 6 * f"{0:10d}" + f"{len(members):10d}", name]
        lines += ["".join(members[k : k + 2]) for k in range(0, len(members), 2)]
    return "\n".join([*lines, "    -1", ""])


def same_places(one, other) -> bool:
    """Return whether elements have the same nodes in the same places, in any order of nodes and elements."""
    volumes = [
        np.sort(np.round(mesh.nodes[mesh.elements].mean(axis=1) @ [1.0, np.pi, np.e], 9)) for mesh in (one, other)
    ]
    return len(one.nodes) == len(other.nodes) and np.allclose(*volumes, rtol=0.0, atol=1e-8)


@pytest.mark.parametrize("kind", list(TYPES))
@pytest.mark.parametrize("seed", range(4))
def test_random_meshes_in_universal_files(kind, seed, tmp_path):
    rng = np.random.default_rng(seed)
    mesh = random_mesh(kind, rng)
    some = np.sort(rng.choice(len(mesh.elements), 5, replace=False)).tolist()
    points = np.sort(rng.choice(len(mesh.nodes), 7, replace=False)).tolist()
    groups = {"some of them": ([], some), "points": (points, []), "both": (points[:2], some[:3])}
    (tmp_path / "mesh.unv").write_text(universal(mesh, rng, groups, mirrored=seed % 2 == 1), encoding="latin-1")
    read = st.SolidMesh.read(tmp_path / "mesh.unv")
    assert read.kind == kind
    assert same_places(read, mesh)
    np.testing.assert_allclose(np.sort(read.volume), np.sort(mesh.volume), rtol=1e-12)
    for name, (in_nodes, in_elements) in groups.items():
        if in_elements:
            assert np.sort(read.volume[read.volumes[name]]) == pytest.approx(
                np.sort(mesh.volume[in_elements]), rel=1e-12
            )
        if in_nodes:
            ours, theirs = (
                np.sort(one @ [1.0, np.pi, np.e]) for one in (read.nodes[read.node_sets[name]], mesh.nodes[in_nodes])
            )
            np.testing.assert_allclose(ours, theirs, rtol=1e-12)


# meshio writes no middle nodes to Medit.
WRITTEN = [*(("med", kind) for kind in TYPES), ("mesh", "tetra"), ("mesh", "hexahedron")]


@pytest.mark.parametrize(("form", "kind"), WRITTEN)
@pytest.mark.parametrize("seed", range(2))
def test_random_meshes_written_by_meshio(form, kind, seed, tmp_path):
    rng = np.random.default_rng(seed)
    mesh = random_mesh(kind, rng)
    tags = -1 - rng.integers(0, 3, len(mesh.elements))
    nodes = np.where(rng.random(len(mesh.nodes)) < 0.3, 4, 0)
    told = meshio.Mesh(mesh.nodes, [(kind, mesh.elements)])
    if form == "med":
        told.cell_data, told.point_data = {"cell_tags": [tags]}, {"point_tags": nodes}
        told.cell_tags, told.point_tags = (
            {-1: ["one", "both"], -2: ["other", "both"], -3: ["third"]},
            {4: ["some nodes"]},
        )
        wanted = {"one": tags == -1, "other": tags == -2, "third": tags == -3, "both": tags >= -2}
    else:
        told.cell_data = {"medit:ref": [-tags]}
        wanted = {f"volume {number}": tags == -number for number in (1, 2, 3)}
    told.write(tmp_path / f"mesh.{form}", file_format="med" if form == "med" else "medit")
    read = st.SolidMesh.read(tmp_path / f"mesh.{form}")
    assert read.kind == kind
    np.testing.assert_allclose(read.nodes[read.elements], mesh.nodes[mesh.elements], rtol=1e-12)
    assert {name: those.tolist() for name, those in read.volumes.items()} == {
        name: np.flatnonzero(those).tolist() for name, those in wanted.items()
    }
    if form == "med":
        assert read.node_sets["some nodes"].tolist() == np.flatnonzero(nodes).tolist()


@pytest.mark.parametrize("form", ["med", "mesh"])
@pytest.mark.parametrize("is_mirrored", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_pyramids_in_either_sense(form, is_mirrored, seed, tmp_path, monkeypatch):
    """A block of random sides as six pyramids about a random place inside."""
    # meshio writes these, but does not list their dimension.
    monkeypatch.setitem(meshio._mesh.topological_dimension, "pyramid13", 3)
    rng = np.random.default_rng(seed)
    unit = KINDS["hexahedron"]
    nodes = np.vstack([unit.nodes, rng.uniform(0.3, 0.7, 3)]) * rng.uniform(0.1, 2.0, 3)
    # Faces are counter-clockwise from outside, the first face of a pyramid from the top.
    pyramids = np.array([[*face[::-1], 8] for face in unit.faces])
    if is_mirrored:
        pyramids[:, [1, 3]] = pyramids[:, [3, 1]]
    kind = "pyramid"
    if form == "med":
        kind, ends = "pyramid13", [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)]
        pairs = np.sort(pyramids[:, ends].reshape(-1, 2), axis=1)
        edges, number = np.unique(pairs, axis=0, return_inverse=True)
        pyramids = np.hstack([pyramids, 9 + number.reshape(6, 8)])
        nodes = np.vstack([nodes, nodes[edges].mean(axis=1)])
    meshio.Mesh(nodes, [(kind, pyramids)]).write(
        tmp_path / f"a.{form}", file_format="med" if form == "med" else "medit"
    )
    mesh = st.SolidMesh.read(tmp_path / f"a.{form}")
    assert mesh.kind == ("tetra10" if form == "med" else "tetra")
    assert len(mesh.elements) == 12
    assert mesh.volume.sum() == pytest.approx(np.prod(nodes[:8].max(axis=0)), rel=1e-9)


BRICK = """    -1
  2411
         1         1         1        11
   0.0000000000000000D+00   0.0000000000000000D+00   0.0000000000000000D+00
         2         1         1        11
   5.0000000000000003D-02   0.0000000000000000D+00   0.0000000000000000D+00
         3         1         1        11
   0.0000000000000000D+00   4.0000000000000001D-02   0.0000000000000000D+00
         4         1         1        11
   0.0000000000000000D+00   0.0000000000000000D+00   2.9999999999999999D-02
    -1
    -1
  2412
         1       111         1         1         7         4
         1         2         3         4
    -1
"""
SYSTEM = """    -1
  2420
         1
parts
         1         {0}         0
local
   1.0D+00   0.0D+00   0.0D+00
   0.0D+00   1.0D+00   0.0D+00
   0.0D+00   0.0D+00   1.0D+00
   {1}D+00   0.0D+00   0.0D+00
    -1
"""


def read_unv(tmp_path, text):
    path = tmp_path / "brick.unv"
    path.write_text(text, encoding="latin-1")
    return st.SolidMesh.read(path)


def test_other_datasets_and_elements_are_counted(tmp_path):
    beam = BRICK.replace(
        "         1         2         3         4\n    -1",
        "         1         2         3         4\n         2        21         1         1         7         2\n"
        "         0         1         1\n         1         2\n"
        "         3       161         1         1         7         1\n         4\n    -1",
    )
    text = beam + 2 * "    -1\n    58\nfunction\n    -1\n" + SYSTEM.format(0, "0.0")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        mesh = read_unv(tmp_path, text)
    assert mesh.volume.sum() == pytest.approx(0.05 * 0.04 * 0.03 / 6.0, rel=1e-12)
    assert [str(one.message).partition("not read: ")[2] for one in caught] == [
        "1 elements of type 161, 2 dataset 58, 1 elements of type 21"
    ]


UNITS = """    -1
   164
         {}mm (newton)                 2
   {}D+00   1.0D+00   1.0D+00
   2.7315D+02
    -1
"""


@pytest.mark.parametrize(("factor", "words"), [("1.0", ""), ("1000.0", "1 unit of length of 0.001 m, see scale")])
def test_units_other_than_metres_are_mentioned(factor, words, tmp_path):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        read_unv(tmp_path, UNITS.format(5, factor) + BRICK)
    assert [str(one.message).partition("not read: ")[2] for one in caught] == ([words] if words else [])


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("         4\n    -1\n", "         5\n    -1\n", "line 14: element 1 has node 5, which is not in the file"),
        ("       111", "       118", "line 14: dataset 2412 has element 1 of type 118, which has 10 nodes, got 4"),
        ("5.0000000000000003D-02", "5.0000000000000003X-02", "line 6: dataset 2411 needs 3 numbers in a line, got '5"),
        ("         3         1 ", "         x         1 ", "line 7: dataset 2411 needs whole numbers, got 'x"),
        (
            "         3         1 ",
            "         2         1 ",
            "line 7: dataset 2411 gives node 2 twice, at different places",
        ),
        ("         4\n    -1\n", "         4\n", "line 12: the dataset that begins here has no end"),
    ],
)
def test_wrong_universal_files_are_refused_in_one_line(old, new, words, tmp_path):
    assert old in BRICK
    with pytest.raises(ValueError, match=r"brick.unv") as caught:
        read_unv(tmp_path, BRICK[::-1].replace(old[::-1], new[::-1], 1)[::-1])
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("form", "shift"), [(1, "0.0"), (0, "2.0"), (2, "0.0")])
def test_nodes_in_other_systems_are_refused(form, shift, tmp_path):
    assert len(read_unv(tmp_path, SYSTEM.format(0, "0.0") + BRICK).nodes) == 4
    with pytest.raises(
        ValueError, match="line 5: node 1 is given in the coordinate system 1, which is not that of the"
    ):
        read_unv(tmp_path, SYSTEM.format(form, shift) + BRICK)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("MeshVersionFormatted 2\nDimension 2\nEnd\n", "line 2: the Dimension of a mesh must be 3"),
        ("MeshVersionFormatted 2\nDimension 3\nVertices\n1\n0 0 0 1\n", "the keyword End is missing"),
        ("MeshVersionFormatted 2\nDimension 3\nEnd\n", "must have Vertices"),
        ("1 2 3\n", "line 1: a mesh of Medit begins with MeshVersionFormatted, got '1'"),
        ("Dimension 3\nVertices 1\n0 0 nan 1\nEnd\n", "line 2: Vertices needs 1 rows of 4 finite numbers"),
        (
            "Dimension 3\nVertices 1\n0 0 0 1\nTetrahedra 1\n1 2 3 4 1\nEnd\n",
            "line 4: Tetrahedra must have nodes from 1 to",
        ),
        ("Dimension 3\nVertices 1\n0 0 0 1\nVertices 1\n0 0 0 1\nEnd\n", "line 4: Vertices is also in line 2"),
    ],
)
def test_wrong_meshes_of_medit_are_refused_in_one_line(text, words, tmp_path):
    (tmp_path / "a.mesh").write_text(text, encoding="latin-1")
    with pytest.raises(ValueError, match=r"a\.mesh") as caught:
        st.SolidMesh.read(tmp_path / "a.mesh")
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_other_keywords_of_medit_are_counted(tmp_path):
    text = next(path for path in FILES if path.name == "tetra.mesh").read_text(encoding="latin-1")
    (tmp_path / "a.mesh").write_text(
        text.replace(" End", " Corners\n 2\n 1 2\n Ridges\n 1\n 3\n End"), encoding="latin-1"
    )
    with pytest.warns(DoubtfulValue, match="not read: 2 Corners, 1 Ridges"):
        st.SolidMesh.read(tmp_path / "a.mesh")


def linked_to_another_file(file) -> None:
    del file["ENS_MAA"]
    file["ENS_MAA"] = h5py.ExternalLink("other.h5", "/")


def with_announced_numbers(file) -> None:
    del file[f"{STEP}/NOE/COO"]
    file[f"{STEP}/NOE"].create_dataset("COO", shape=(3 * 10**12,), dtype=float, chunks=(1000,))


def changed(path: Path, change) -> None:
    with h5py.File(path, "r+") as file:
        change(file)


STEP = "ENS_MAA/block/-0000000000000000001-0000000000000000001"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            lambda file: file.copy("ENS_MAA/block", "ENS_MAA/other"),
            "one mesh in one state, got 2 meshes: 'block', 'other'",
        ),
        (lambda file: file["ENS_MAA/block"].attrs.modify("REP", 1), "in Cartesian coordinates"),
        (lambda file: file.pop(f"{STEP}/NOE/COO"), "'COO' is missing"),
        (lambda file: file[f"{STEP}/MAI/TE4/NOD"].__setitem__(0, 99), "cells TE4 have nodes from 1 to 12, got 99"),
        (with_announced_numbers, "'COO' announces 3000000000000 numbers, but at most"),
        (linked_to_another_file, "'ENS_MAA' is missing, or outside"),
    ],
)
def test_wrong_med_files_are_refused_in_one_line(change, words, tmp_path):
    path = tmp_path / "a.med"
    path.write_bytes(next(one for one in FILES if one.name == "tetra.med").read_bytes())
    changed(path, change)
    with pytest.raises(ValueError, match=r"a\.med") as caught:
        st.SolidMesh.read(path)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("ending", [".unv", ".med", ".mesh"])
def test_damaged_files_are_read_or_refused_in_one_line(ending, seed, tmp_path):
    rng = np.random.default_rng(seed)
    for path in (one for one in FILES if one.suffix == ending):
        content = bytearray(path.read_bytes())
        if seed % 2:
            content = content[: int(rng.integers(1, len(content)))]
        else:
            for at in rng.integers(0, len(content), 5):
                content[at] = int(rng.choice(list(b"\x00-9 zD\n")))
        (tmp_path / f"a{ending}").write_bytes(bytes(content))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DoubtfulValue)
            said = ""
            try:
                st.SolidMesh.read(tmp_path / f"a{ending}")
            except (ValueError, OSError) as error:
                said = str(error)
        assert "\n" not in said
