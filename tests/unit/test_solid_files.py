"""Meshes read from files written by hand: every format gives the same body."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

import stridula as st
from stridula.bodies.solids.cut_elements import CUT_KINDS
from stridula.bodies.solids.elements import assembled
from stridula.bodies.solids.kinds import KINDS, outer_faces

STEEL = st.Material(2.1e11, 7800.0, 0.3)
BLOCK = st.SolidMesh.block((0.1, 0.04, 0.03), (3, 2, 1))
TIP = (0.1, 0.04, 0.03)
# Numbers of elements and of faces in gmsh; where its nodes in the middle of edges stand in the order of VTK.
GMSH = {
    "tetra": (4, 2, None),
    "tetra10": (11, 9, [0, 1, 2, 3, 5, 4]),
    "hexahedron": (5, 3, None),
    "hexahedron20": (17, 16, [0, 3, 8, 1, 9, 2, 10, 11, 4, 7, 5, 6]),
}
ABAQUS = {"tetra": "C3D4", "tetra10": "C3D10", "hexahedron": "C3D8", "hexahedron20": "C3D20R"}


def mesh_of(kind):
    """Return the block in elements of a kind, with faces on the left."""
    corners = st.SolidMesh(BLOCK.nodes[: BLOCK.elements[:, :8].max() + 1], BLOCK.elements[:, :8], "hexahedron")
    if kind.startswith("tetra"):
        cuts = np.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])
        corners = st.SolidMesh(corners.nodes, corners.elements[:, cuts].reshape(-1, 4), "tetra")
    mesh = corners if kind in ("tetra", "hexahedron") else corners.quadratic()
    sides = mesh.element_kind.face_nodes
    on_left = (mesh.nodes[mesh.elements[:, sides], 0] == 0.0).all(axis=2)
    return st.SolidMesh(
        mesh.nodes, mesh.elements, mesh.kind, {"steel": np.arange(len(mesh.elements))}, {"clamp": np.argwhere(on_left)}
    )


def frequencies(mesh, **options):
    body = st.SolidBody(mesh, {"steel": STEEL}, fixed=["clamp"], linear=True, cutoff=40e3, **options)
    return body.modes().frequency[:6]


def gmsh_cells(mesh):
    """Return the connectivity of solids and of the faces on the left, from 1, in the order of gmsh."""
    _, _, middles = GMSH[mesh.kind]
    corners = len(mesh.element_kind.corners)
    order = list(range(corners)) + ([corners + k for k in middles] if middles else [])
    return mesh.elements[:, order] + 1, mesh.face("clamp").nodes + 1


def gmsh_22(mesh):
    solid, face = gmsh_cells(mesh)
    solid_type, face_type, _ = GMSH[mesh.kind]
    tip = mesh.node_at(TIP) + 1
    cells = [(15, 3, [tip]), *((face_type, 2, row) for row in face), *((solid_type, 1, row) for row in solid)]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "3"]
    lines += ['0 3 "tip"', '2 2 "clamp"', '3 1 "steel"', "$EndPhysicalNames", "$Nodes", str(len(mesh.nodes))]
    lines += [f"{k} {x!r} {y!r} {z!r}" for k, (x, y, z) in enumerate(mesh.nodes.tolist(), 1)]
    lines += ["$EndNodes", "$Elements", str(len(cells))]
    lines += [f"{k} {kind} 2 {tag} {tag} {' '.join(map(str, row))}" for k, (kind, tag, row) in enumerate(cells, 1)]
    return "\n".join([*lines, "$EndElements", ""])


def gmsh_41(mesh):
    solid, face = gmsh_cells(mesh)
    solid_type, face_type, _ = GMSH[mesh.kind]
    count, box = len(mesh.nodes), "0 0 0 1 1 1"
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "3"]
    lines += ['0 3 "tip"', '2 2 "clamp"', '3 1 "steel"', "$EndPhysicalNames"]
    lines += ["$Entities", "1 0 1 1", "1 0.1 0.04 0.03 1 3", f"1 {box} 1 2 0", f"1 {box} 1 1 0", "$EndEntities"]
    lines += ["$Nodes", f"1 {count} 1 {count}", f"3 1 0 {count}", *map(str, range(1, count + 1))]
    lines += [f"{x!r} {y!r} {z!r}" for x, y, z in mesh.nodes.tolist()]
    total = 1 + len(face) + len(solid)
    lines += ["$EndNodes", "$Elements", f"3 {total} 1 {total}", "0 1 15 1", f"1 {mesh.node_at(TIP) + 1}"]
    number = 2
    for head, rows in ((f"2 1 {face_type}", face), (f"3 1 {solid_type}", solid)):
        lines.append(f"{head} {len(rows)}")
        for row in rows:
            lines.append(f"{number} {' '.join(map(str, row))}")
            number += 1
    return "\n".join([*lines, "$EndElements", ""])


def abaqus(mesh):
    """Node numbers with gaps, two blocks of elements of one set, a set of nodes for the face."""
    number = 10 * np.arange(1, len(mesh.nodes) + 1)
    lines = ["*HEADING", "block", "** a remark", "*NODE"]
    lines += [f"{n}, {x!r}, {y!r}, {z!r}" for n, (x, y, z) in zip(number, mesh.nodes.tolist(), strict=True)]
    half = len(mesh.elements) // 2
    for first, rows in ((1, mesh.elements[:half]), (half + 1, mesh.elements[half:])):
        lines.append(f"*ELEMENT, TYPE={ABAQUS[mesh.kind]}, ELSET=steel")
        for label, row in enumerate(rows, first):
            words = [str(label), *map(str, number[row])]
            lines += [", ".join(words[:11]) + ("," if len(words) > 11 else "")]
            lines += [", ".join(words[11:])] if len(words) > 11 else []
    lines += ["*NSET, NSET=clamp", *map(str, number[np.unique(mesh.face("clamp").nodes)])]
    lines += ["*NSET, NSET=tip", str(number[mesh.node_at(TIP)])]
    return "\n".join([*lines, "*STEP", "*END STEP", ""])


def nastran(mesh):
    """Free fields would be shorter; these are the short fields of eight, as most programs write them."""
    word = "CTETRA" if mesh.kind.startswith("tetra") else "CHEXA"
    lines = ["SOL 103", "CEND", "BEGIN BULK", "MAT1,1,2.1+11,,.3,7800."]
    for n, place in enumerate(mesh.nodes.tolist(), 1):
        lines.append(f"{'GRID':8}{n:8d}{'':8}" + "".join(f"{value:8.5f}" for value in place))
    order = list(range(mesh.elements.shape[1]))
    if mesh.kind == "hexahedron20":
        # Nastran has the upright edges before the upper ones.
        order = [*range(12), *range(16, 20), *range(12, 16)]
    for n, row in enumerate(mesh.elements[:, order] + 1, 1):
        words = [f"{word:8}{n:8d}{7:8d}" + "".join(f"{k:8d}" for k in row[:6])]
        words += ["+".ljust(8) + "".join(f"{k:8d}" for k in row[at : at + 8]) for at in range(6, len(row), 8)]
        lines += [line + "+" if line is not words[-1] else line for line in words]
    return "\n".join([*lines, "ENDDATA", ""])


TEXTS = {"gmsh 2.2": (gmsh_22, "msh"), "gmsh 4.1": (gmsh_41, "msh"), "abaqus": (abaqus, "inp")}


@pytest.mark.parametrize("form", list(TEXTS))
@pytest.mark.parametrize("kind", list(GMSH))
def test_named_groups_and_frequencies_come_back(tmp_path, form, kind):
    mesh = mesh_of(kind)
    write, ending = TEXTS[form]
    path = tmp_path / f"block.{ending}"
    path.write_text(write(mesh))
    read = st.SolidMesh.read(path)
    assert read.kind == kind
    assert read.volumes["steel"].size == len(mesh.elements)
    assert read.face("clamp").area.sum() == pytest.approx(0.04 * 0.03, rel=1e-12)
    np.testing.assert_allclose(read.face("clamp").normal, np.tile([-1.0, 0.0, 0.0], (len(read.faces["clamp"]), 1)))
    body = st.SolidBody(read, {"steel": STEEL}, fixed=["clamp"], linear=True, cutoff=40e3)
    assert body.point_names == ("tip",)
    np.testing.assert_allclose(read.nodes[body.points["tip"]], TIP)
    np.testing.assert_allclose(body.modes().frequency[:6], frequencies(mesh, points={"tip": TIP})[:6], rtol=1e-9)


@pytest.mark.parametrize("kind", list(GMSH))
def test_nastran_names_elements_by_their_property(tmp_path, kind):
    """Fields of eight have five decimals, of half edges of 0.015 m and more."""
    mesh = mesh_of(kind)
    path = tmp_path / "block.bdf"
    path.write_text(nastran(mesh))
    read = st.SolidMesh.read(path)
    assert read.kind == kind
    left = read.named("clamp", np.flatnonzero(read.nodes[:, 0] == 0.0))
    body = st.SolidBody(left, {"7": STEEL}, fixed=["clamp"], linear=True, cutoff=40e3)
    found, expected = body.modes().frequency[:6], frequencies(mesh)
    np.testing.assert_allclose(found, expected, rtol=2.0 * 0.5e-5 / 0.015)


@pytest.mark.parametrize("ending", ["vtk", "vtu"])
@pytest.mark.parametrize("kind", [*GMSH, "hexahedron27"])
def test_vtk_names_groups_by_arrays_of_whole_numbers(tmp_path, ending, kind):
    meshio = pytest.importorskip("meshio")
    mesh = mesh_of("hexahedron20" if kind == "hexahedron27" else kind)
    if kind == "hexahedron27":
        from physics.test_solid_bodies import of_27_nodes

        whole = of_27_nodes(mesh)
        faces = np.argwhere((whole.nodes[whole.elements[:, whole.element_kind.face_nodes], 0] == 0.0).all(axis=2))
        mesh = st.SolidMesh(
            whole.nodes, whole.elements, kind, {"steel": np.arange(len(whole.elements))}, {"clamp": faces}
        )
    path = tmp_path / f"block.{ending}"
    side = (mesh.nodes[:, 0] == 0.0).astype(np.int64)
    region = np.full(len(mesh.elements), 3)
    held = meshio.Mesh(mesh.nodes, [(mesh.kind, mesh.elements)], {"side": side}, {"region": [region]})
    held.write(path)
    read = st.SolidMesh.read(path)
    body = st.SolidBody(read, {"region 3": STEEL}, fixed=["side 1"], linear=True, cutoff=40e3)
    np.testing.assert_allclose(body.modes().frequency[:6], frequencies(mesh), rtol=1e-9)


def test_lengths_are_scaled(tmp_path):
    path = tmp_path / "block.msh"
    path.write_text(gmsh_22(mesh_of("hexahedron20")))
    np.testing.assert_allclose(st.SolidMesh.read(path, scale=0.001).size, [1e-4, 4e-5, 3e-5])


def test_elements_of_two_groups_stand_once_and_lonely_nodes_are_left_out(tmp_path):
    """gmsh 2.2 writes an element once for each of its groups, and geometry points without elements."""
    mesh = mesh_of("tetra")
    text = gmsh_22(mesh)
    count = len(mesh.nodes)
    head, tail = text.split("$EndNodes")
    head = head.replace(f"$Nodes\n{count}", f"$Nodes\n{count + 1}") + f"{count + 1} 9.0 9.0 9.0\n"
    solid = gmsh_cells(mesh)[0][0]
    total = 1 + len(mesh.faces["clamp"]) + len(mesh.elements)
    again = f"{total + 1} 4 2 4 1 {' '.join(map(str, solid))}\n"
    tail = tail.replace(f"$Elements\n{total}", f"$Elements\n{total + 1}").replace(
        "$EndElements", again + "$EndElements"
    )
    path = tmp_path / "block.msh"
    path.write_text(head + "$EndNodes" + tail)
    read = st.SolidMesh.read(path)
    assert (len(read.nodes), len(read.elements)) == (count, len(mesh.elements))
    assert read.volumes["4"].size == 1


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("block.stl", "solid", "end in"),
        ("block.msh", "", "is empty"),
        ("block.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n7\n1 0 0\n", "cannot read"),
        ("block.inp", "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=C3D4\n1, 1, 2, 3, 4\n", "cannot read"),
        ("block.inp", "*HEADING\nnothing\n", "got none"),
        ("block.bdf", "GRID,one\n", "cannot read"),
        ("block.vtu", "<VTKFile", "cannot read"),
        ("block.vtk", "no header", "cannot read"),
    ],
)
def test_damaged_files_are_refused_in_one_line(tmp_path, name, text, words):
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(ValueError, match=words) as caught:
        st.SolidMesh.read(path)
    assert "\n" not in str(caught.value)


def test_cut_files_are_refused_in_one_line(tmp_path):
    """A cut file is refused, or gives a mesh that lacks no solid element."""
    for write, ending in TEXTS.values():
        text = write(mesh_of("tetra10"))
        path = tmp_path / f"cut.{ending}"
        for share in np.linspace(0.05, 0.95, 19):
            path.write_text(text[: int(share * len(text))])
            said = one_line_of(path)
            assert said is None or "\n" not in said


@pytest.mark.parametrize("form", [*TEXTS, "nastran"])
def test_files_with_wrong_characters_are_read_or_refused_in_one_line(tmp_path, form):
    write, ending = {**TEXTS, "nastran": (nastran, "bdf")}[form]
    text, path = write(mesh_of("hexahedron20")), tmp_path / f"wrong.{ending}"
    random = np.random.default_rng(1)
    said = []
    for wrong in np.tile([1, 3, 20], 12):
        letters = np.array(list(text))
        letters[random.integers(0, letters.size, wrong)] = random.choice(list("0123456789-.,e *$\n"), wrong)
        path.write_text("".join(letters))
        said.append(one_line_of(path))
    assert any(said)
    assert not any("\n" in line for line in said if line)


def one_line_of(path):
    """Return the message for a refused file, None if it is read."""
    try:
        st.SolidMesh.read(path)
    except (ValueError, OSError) as error:
        return str(error)
    return None


def test_a_missing_file_is_reported(tmp_path):
    with pytest.raises(FileNotFoundError, match="cannot read"):
        st.SolidMesh.read(tmp_path / "none.msh")


CUBE = KINDS["hexahedron"].corners
EDGES = {name: kind.edges for name, kind in CUT_KINDS.items()}
MIXED = {"hexahedron": "C3D8", "wedge": "C3D6", "hexahedron20": "C3D20", "wedge15": "C3D15", "pyramid": "C3D5"}


def swept(divisions, quadratic, sizes=(0.1, 0.04, 0.03), parts="half"):
    """Return nodes and blocks of hexahedra and of wedges, two for each hexahedron far along x."""
    mesh = st.SolidMesh.block(sizes, divisions)
    elements = mesh.elements[:, :8]
    nodes = mesh.nodes[: elements.max() + 1]
    far = nodes[elements, 0].mean(axis=1) > (0.5 * sizes[0] if parts == "half" else 0.0)
    wedges = elements[far][:, [[0, 1, 3, 4, 5, 7], [1, 2, 3, 5, 6, 7]]].reshape(-1, 6)
    blocks = {"hexahedron": elements[~far], "wedge": wedges}
    if not quadratic:
        return nodes, blocks
    found, bent = {}, {}
    places = nodes.tolist()
    for name, rows in blocks.items():
        full = []
        for row in rows.tolist():
            middles = []
            for pair in (frozenset(row[k] for k in edge) for edge in EDGES[name]):
                if pair not in found:
                    found[pair] = len(places)
                    places.append(nodes[list(pair)].mean(axis=0).tolist())
                middles.append(found[pair])
            full.append(row + middles)
        bent[{"hexahedron": "hexahedron20", "wedge": "wedge15"}[name]] = np.array(full).reshape(
            -1, len(full[0]) if full else 20
        )
    return np.array(places), bent


def mixed_deck(nodes, blocks, sets):
    lines = ["*NODE", *(f"{k}, {x!r}, {y!r}, {z!r}" for k, (x, y, z) in enumerate(nodes.tolist(), 1))]
    number = 1
    for name, rows in blocks.items():
        lines += [f"*ELEMENT, TYPE={MIXED[name]}, ELSET={name}"] if len(rows) else []
        for row in (rows + 1).tolist():
            words = [str(number), *map(str, row)]
            lines += [", ".join(words[:11]) + ("," if len(words) > 11 else "")]
            lines += [", ".join(words[11:])] if len(words) > 11 else []
            number += 1
    for name, those in sets.items():
        lines += [f"*NSET, NSET={name}", *(str(k + 1) for k in those)]
    return "\n".join([*lines, ""])


def read_mixed(tmp_path, *arguments, **options):
    nodes, blocks = swept(*arguments, **options)
    sets = {"clamp": np.flatnonzero(nodes[:, 0] == 0.0), "end": np.flatnonzero(nodes[:, 0] == nodes[:, 0].max())}
    path = tmp_path / "swept.inp"
    path.write_text(mixed_deck(nodes, blocks, sets))
    return st.SolidMesh.read(path), blocks


@pytest.mark.parametrize("quadratic", [False, True])
def test_hexahedra_and_wedges_become_tetrahedra_that_fit(tmp_path, quadratic):
    mesh, blocks = read_mixed(tmp_path, (4, 2, 3), quadratic)
    six, three = (len(rows) for rows in blocks.values())
    assert mesh.kind == ("tetra10" if quadratic else "tetra")
    assert {name: one.size for name, one in mesh.volumes.items()} == dict(
        zip(blocks, (6 * six, 3 * three), strict=True)
    )
    for name in ("clamp", "end"):
        assert mesh.face(name).area.sum() == pytest.approx(0.04 * 0.03, rel=1e-12)
    # Mismatched faces would also lie on the surface.
    outer = st.SolidMesh(
        mesh.nodes, mesh.elements, mesh.kind, faces={"all": outer_faces(mesh.element_kind, mesh.elements)}
    )
    expected = 2.0 * (0.1 * 0.04 + 0.1 * 0.03 + 0.04 * 0.03)
    assert outer.face("all").area.sum() == pytest.approx(expected, rel=1e-12)
    material = st.Material(1.0, 1.0, 0.3)
    _, stiffness = assembled(mesh.element_kind, mesh.nodes, mesh.elements, [(material, np.arange(len(mesh.elements)))])
    gradient = np.array([[0.3, -0.2, 0.1], [0.5, 0.1, -0.4], [0.2, 0.6, -0.1]])
    forces = (stiffness @ (mesh.nodes @ gradient.T).ravel()).reshape(-1, 3)
    inside = ((mesh.nodes > 1e-9) & (mesh.nodes < mesh.nodes.max(axis=0) - 1e-9)).all(axis=1)
    assert inside.any()
    assert np.abs(forces[inside]).max() < 1e-12 * np.abs(forces).max()


@pytest.mark.parametrize("parts", ["half", "all"])
def test_blocks_of_wedges_come_to_the_frequencies_of_one_of_hexahedra(tmp_path, parts):
    block = st.SolidBody.block((0.1, 0.04, 0.03), (14, 6, 4), STEEL, fixed=["left"], cutoff=20e3)
    expected = block.modes().frequency[:6]
    errors = []
    for divisions in ((5, 2, 2), (10, 4, 3)):
        mesh, _ = read_mixed(tmp_path, divisions, True, parts=parts)
        found = st.SolidBody(mesh, STEEL, fixed=["clamp"], cutoff=20e3).modes().frequency[:6]
        errors.append(np.abs(found / expected - 1.0).max())
    assert errors[1] < 0.01
    assert errors[1] < errors[0] / 3.0


def test_pyramids_join_hexahedra(tmp_path):
    """A cube of six pyramids beside a hexahedron."""
    corners = np.array([*np.ndindex(2, 2, 2)], dtype=float)[[0, 4, 6, 2, 1, 5, 7, 3]]
    nodes = np.vstack([corners, [[0.5, 0.5, 0.5]], corners[[1, 2, 6, 5]] + [1.0, 0.0, 0.0]])
    sides = [[*face[::-1], 8] for face in CUT_KINDS["hexahedron"].faces]
    blocks = {"pyramid": np.array(sides), "hexahedron": np.array([[1, 9, 10, 2, 5, 12, 11, 6]])}
    held = meshio.Mesh(nodes, list(blocks.items()), cell_sets={})
    held.write(tmp_path / "joined.vtu")
    mesh = st.SolidMesh.read(tmp_path / "joined.vtu")
    assert len(mesh.elements) == 6 * 2 + 6
    outer = st.SolidMesh(
        mesh.nodes, mesh.elements, "tetra", faces={"all": outer_faces(mesh.element_kind, mesh.elements)}
    )
    assert outer.face("all").area.sum() == pytest.approx(10.0, rel=1e-12)


@pytest.mark.parametrize("fits", [True, False])
def test_triangles_on_a_quadrilateral_fit_its_cut_or_are_refused(tmp_path, fits):
    """Two tetrahedra over the upper face of a cube, 4 to 7, which is cut from its lowest corner, 4, to 6."""
    nodes = np.vstack([np.array(CUBE, dtype=float), [[0.5, 0.5, 2.0]]])
    tetra = [[4, 5, 6, 8], [4, 6, 7, 8]] if fits else [[4, 5, 7, 8], [5, 6, 7, 8]]
    meshio.Mesh(nodes, [("hexahedron", [list(range(8))]), ("tetra", tetra)]).write(tmp_path / "cube.vtu")
    if fits:
        assert len(st.SolidMesh.read(tmp_path / "cube.vtu").elements) == 8
        return
    with pytest.raises(ValueError, match=r"^path must have pyramids where .*, got 2 triangles on quadrilaterals$"):
        st.SolidMesh.read(tmp_path / "cube.vtu")


def test_middles_of_curved_edges_stay(tmp_path):
    nodes, blocks = swept((4, 2, 2), True)
    bent = nodes.copy()
    bent[:, 1] += 2.0 * nodes[:, 0] ** 2
    path = tmp_path / "bent.inp"
    path.write_text(mixed_deck(bent, blocks, {}))
    mesh = st.SolidMesh.read(path)
    # Of second degree, like the shapes of faces and elements: the middles of cuts are correct.
    low = mesh.nodes[:, 1] - 2.0 * mesh.nodes[:, 0] ** 2
    assert low.min() > -1e-12
    assert low.max() < 0.04 + 1e-12
    np.testing.assert_allclose(low / 0.005, np.round(low / 0.005), atol=1e-9)


def test_faces_of_four_corners_are_cut_as_their_elements(tmp_path):
    nodes, blocks = swept((2, 1, 1), False)
    on_left = blocks["hexahedron"][:, [0, 4, 7, 3]]
    cells = [*((name, rows) for name, rows in blocks.items()), ("quad", on_left)]
    tags = [np.full(len(rows), number) for number, (_, rows) in enumerate(cells, 1)]
    held = meshio.Mesh(
        nodes,
        cells,
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={"clamp": np.array([3, 2])},
    )
    meshio.write(tmp_path / "swept.msh", held, file_format="gmsh22", binary=False)
    mesh = st.SolidMesh.read(tmp_path / "swept.msh")
    assert len(mesh.faces["clamp"]) == 2
    assert mesh.face("clamp").area.sum() == pytest.approx(0.04 * 0.03, rel=1e-12)
    assert (mesh.volumes["1"].size, mesh.volumes["2"].size) == (6, 6)


def test_mixtures_of_orders_are_refused(tmp_path):
    nodes = "".join(f"{k}, {x}, {y}, {z}\n" for k, (x, y, z) in enumerate(np.ndindex(2, 2, 2), 1))
    wedge = "*ELEMENT, TYPE=C3D6\n1, 1, 2, 3, 5, 6, 7\n"
    tetra = "*ELEMENT, TYPE=C3D10\n2, 1, 2, 3, 5, 6, 7, 8, 1, 2, 3\n"
    path = tmp_path / "block.inp"
    for text, got in ((tetra + wedge, "one order.*, got tetra10, wedge$"), ("", "none")):
        path.write_text("*NODE\n" + nodes + text)
        with pytest.raises(ValueError, match=got):
            st.SolidMesh.read(path)
