"""Faces of bodies read from files of matrices, on the mesh of their deck."""

from __future__ import annotations

import subprocess

import numpy as np
import pytest
from test_calculix import CCX, MISSING, deck, solved
from test_solid_files import STEEL, abaqus, mesh_of
from written_decks import brake_deck

import stridula as st
from stridula.bodies.solids.solid_body import _assembled
from stridula.doubtful import DoubtfulValue

CUTOFF = 60e3
MESH = mesh_of("hexahedron20")
END = np.flatnonzero(MESH.nodes[:, 0] == MESH.nodes[:, 0].max())
END_SET = "\n".join(["*NSET, NSET=end", *map(str, 10 * (END + 1))])
TRACK = st.RigidTrack(velocity=1.0)


def written(folder, left_out=()):
    """Write the matrices of the clamped block as Abaqus does, one triangle with labels, and its deck."""
    body = st.SolidBody(MESH, {"steel": STEEL}, fixed=["clamp"], cutoff=CUTOFF)
    node_mass, stiffness = _assembled(body)
    free = body._free.copy()
    for node in left_out:
        free[3 * node : 3 * node + 3] = False
    for name, matrix in (("mass", np.kron(node_mass.toarray(), np.eye(3))), ("stiffness", stiffness.toarray())):
        rows, columns = np.nonzero(np.tril(matrix * np.outer(free, free)))
        lines = [
            f"{10 * (i // 3 + 1)}, {i % 3 + 1}, {10 * (j // 3 + 1)}, {j % 3 + 1}, {float(matrix[i, j])!r}"
            for i, j in zip(rows.tolist(), columns.tolist(), strict=True)
        ]
        (folder / f"{name}.mtx").write_text("\n".join([*lines, ""]), encoding="utf-8")
    text = abaqus(MESH).replace("*STEP", f"{END_SET}\n*STEP")
    (folder / "block.inp").write_text(text, encoding="utf-8")
    return {"mass": folder / "mass.mtx", "stiffness": folder / "stiffness.mtx", "mesh": folder / "block.inp"}


def solid(division):
    mesh = st.SolidMesh(MESH.nodes, MESH.elements, MESH.kind, MESH.volumes, MESH.faces, {"end": END})
    return st.SolidBody(
        with_end(mesh), {"steel": STEEL}, fixed=["clamp"], cutoff=CUTOFF, contact_faces={"end": division}, name="block"
    )


def with_end(mesh):
    """Return a mesh with the faces all of whose nodes are in the set "end"."""
    sides = mesh.element_kind.face_nodes
    there = np.isin(mesh.elements[:, sides], mesh.node_sets["end"]).all(axis=2)
    faces = {**mesh.faces, "end": np.argwhere(there)}
    return st.SolidMesh(mesh.nodes, mesh.elements, mesh.kind, mesh.volumes, faces)


def modes_of(body, face):
    surface = st.SurfaceContact(body, face, TRACK, friction=st.Coulomb(0.3), stiffness=1e13, name="end")
    system = st.System(surface, [st.Force(surface.contacts[0].tip, x=200.0)])
    theory = st.sliding_stability(system)
    slow = theory.frequency.values < 5e4
    return np.sort(theory.frequency.values[slow]), np.sort(theory.growth_rate.values[slow])


@pytest.mark.parametrize("division", [(2, 2), "integration", 9])
def test_a_face_of_labelled_matrices_is_that_of_the_mesh(division, tmp_path):
    body = st.ReducedBody.read(**written(tmp_path), cutoff=CUTOFF, faces={"end": division}, name="block")
    expected = solid(division)
    np.testing.assert_allclose(body.face_points("end").place, expected.face_points("end").place, atol=1e-12)
    for found, wanted in zip(modes_of(body, "end"), modes_of(expected, "end"), strict=True):
        np.testing.assert_allclose(found, wanted, rtol=1e-5, atol=1e-3)


def test_a_face_of_calculix_is_that_of_the_mesh(tmp_path):
    solved(tmp_path)
    text = deck("hexahedron20", True, "").replace("*STEP", f"{END_SET}\n*STEP")
    (tmp_path / "stored.inp").write_text(text, encoding="utf-8")
    body = st.ReducedBody.read(
        tmp_path / "stored.sti", mesh=tmp_path / "stored.inp", cutoff=CUTOFF, faces={"end": (2, 2)}, name="block"
    )
    for found, wanted in zip(modes_of(body, "end"), modes_of(solid((2, 2)), "end"), strict=True):
        np.testing.assert_allclose(found, wanted, rtol=1e-4, atol=1e-3)


def test_held_nodes_are_mentioned_and_missing_faces_are_refused(tmp_path):
    files = written(tmp_path)
    with pytest.raises(ValueError, match="degrees must keep the nodes of the face, got none of"):
        st.ReducedBody.read(**files, cutoff=CUTOFF, faces=["clamp"])
    few = written(tmp_path, left_out=END[:3].tolist())
    with pytest.warns(DoubtfulValue, match=r"3 nodes of \d+ of the face 'end' not in the matrices, taken as held"):
        st.ReducedBody.read(**few, cutoff=CUTOFF, faces=["end"])


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"faces": ["side"]}, r"faces\[0\] must be one of clamp, end, got 'side'"),
        ({"faces": {"end": 0}}, r"faces\['end'\] must"),
        ({"mesh": None, "faces": ["end"]}, "mesh must be given with faces"),
    ],
)
def test_faces_of_files_that_are_refused(words, message, tmp_path):
    with pytest.raises(ValueError, match=message):
        st.ReducedBody.read(**written(tmp_path) | {"points": {"tip": int(10 * (END[0] + 1))}} | words, cutoff=CUTOFF)


def test_unlabelled_matrices_have_no_faces(tmp_path):
    files = written(tmp_path)
    for name in ("mass", "stiffness"):
        lines = files[name].read_text(encoding="utf-8").splitlines()
        entries = ["%%MatrixMarket matrix coordinate real symmetric", "3 3 3", "1 1 1.0", "2 2 1.0", "3 3 1.0"]
        assert lines
        files[name].write_text("\n".join([*entries, ""]), encoding="utf-8")
    with pytest.raises(ValueError, match="be left out where files do not name the nodes of their rows"):
        st.ReducedBody.read(**files, faces=["end"])


# The brake of the tutorial, with pads from matrices of CalculiX.


def flat(part):
    """Return a pad as a deck of CalculiX in metres, held along the disc at its back, for its matrices."""
    mesh = part.mesh
    lines = ["*NODE", *(f"{k + 1}, {x:.12g}, {y:.12g}, {z:.12g}" for k, (x, y, z) in enumerate(mesh.nodes.tolist()))]
    for name, material in part.materials.items():
        lines.append(f"*ELEMENT, TYPE=C3D20, ELSET={name}")
        for element in mesh.volumes[name]:
            row = [element + 1, *(mesh.elements[element] + 1)]
            lines += [", ".join(map(str, row[:11])) + ",", ", ".join(map(str, row[11:]))]
        lines += [f"*MATERIAL, NAME=M{name}", "*ELASTIC", f"{material.young!r}, {material.poisson!r}"]
        lines += ["*DENSITY", f"{material.density!r}", f"*SOLID SECTION, ELSET={name}, MATERIAL=M{name}"]
    for name in ("RUB", "BACK"):
        lines += [f"*NSET, NSET={name}", *(str(node + 1) for node in mesh.nodes_of(name))]
    steps = ["*BOUNDARY", "BACK, 1", "BACK, 3", "*STEP", "*FREQUENCY, SOLVER=MATRIXSTORAGE", "1", "*END STEP", ""]
    return "\n".join([*lines, *steps])


def stability_of(disc, pads):
    turning = ((0.0, 1.0, 0.0), (0.0, 0.0, 0.0), 20.0)
    faces = [
        st.SurfaceContact(pad, "RUB", disc, face, st.Coulomb(0.4), stiffness=1e11, turning=turning, name=pad.name)
        for pad, face in zip(pads, ("UPPER", "LOWER"), strict=True)
    ]
    loads = [st.Force(pad.at("push"), y=way * 1e3) for pad, way in zip(pads, (-1.0, 1.0), strict=True)]
    theory = st.sliding_stability(st.System(faces, loads))
    slow = theory.frequency.values < 1.2e4
    return theory.normal_force.values, theory.frequency.values[slow], theory.growth_rate.values[slow]


def test_a_brake_with_pads_of_calculix_is_that_of_the_deck(tmp_path):
    if CCX is None:
        pytest.skip(MISSING)
    path = tmp_path / "brake.inp"
    path.write_text(brake_deck(), encoding="utf-8")
    disc_part, *pad_parts = st.read_parts(path, scale=1e-3).values()
    disc = st.SolidBody(
        disc_part.mesh, disc_part.materials, fixed=["HUB"], cutoff=9e3, damping=0.004,
        contact_faces={"UPPER": 48, "LOWER": 48}, name="disc",
    )  # fmt: skip
    solids, reduced = [], []
    for part in pad_parts:
        mesh, words = part.mesh, {"cutoff": 9e3, "damping": 0.004, "name": part.name}
        back = mesh.nodes_of("BACK")
        middle = mesh.nodes[back].mean(axis=0)
        node = int(back[np.argmin(np.linalg.norm(mesh.nodes[back] - middle, axis=1))])
        solids.append(
            st.SolidBody(mesh, part.materials, {"push": node}, fixed={"BACK": "xz"}, contact_faces={"RUB": 12}, **words)
        )
        job = tmp_path / f"{part.name}.inp"
        job.write_text(flat(part), encoding="utf-8")
        done = subprocess.run([CCX, part.name], cwd=tmp_path, capture_output=True, text=True)
        assert "Job finished" in done.stdout, done.stdout[-2000:]
        push = {"push": (None, (node + 1, 2), None)}
        reduced.append(st.ReducedBody.read(job.with_suffix(".sti"), mesh=job, points=push, faces={"RUB": 12}, **words))
    expected, found = stability_of(disc, solids), stability_of(disc, reduced)
    assert (expected[2] > 100.0).any()
    for ours, theirs in zip(found, expected, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-4, atol=1e-2)
