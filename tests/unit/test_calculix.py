"""CalculiX itself: its matrices of a block give its own frequencies, and those of the body from the same mesh."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest
from test_solid_files import STEEL, TIP, abaqus, mesh_of

import stridula as st
from stridula.bodies.solids import elements

CCX = shutil.which("ccx")
MISSING = "takes CalculiX: ccx of Debian's calculix-ccx is not there"
MODES = 6
MATERIAL = """*MATERIAL, NAME=steel
*ELASTIC
2.1e11, 0.3
*DENSITY
7800.0
*SOLID SECTION, ELSET=steel, MATERIAL=steel
"""
SPACE = (1, 2, 3)


def deck(kind, is_held, solver):
    """Return a block of elements whose integrals are exact, for one step of CalculiX."""
    mesh = abaqus(mesh_of(kind)).replace("C3D20R", "C3D20").partition("*STEP")[0]
    held = "*BOUNDARY\nclamp, 1, 3\n" if is_held else ""
    return f"{mesh}{MATERIAL}{held}*STEP\n*FREQUENCY{solver}\n{MODES}\n*END STEP\n"


def solved(folder, kind="hexahedron20", is_held=True):
    """Make CalculiX write the matrices of a block and, in another job, compute its frequencies."""
    if CCX is None:
        pytest.skip(MISSING)
    for job, solver in (("stored", ", SOLVER=MATRIXSTORAGE"), ("solved", "")):
        (folder / f"{job}.inp").write_text(deck(kind, is_held, solver))
        done = subprocess.run([CCX, job], cwd=folder, capture_output=True, text=True)
        assert "Job finished" in done.stdout, done.stdout[-2000:]
    table = (folder / "solved.dat").read_text().partition("P A R T I C I P A T I O N")[0]
    rows = [line.split() for line in table.splitlines() if len(line.split()) == 5]
    return np.array([float(row[3]) for row in rows if row[0].isdigit()])


@pytest.mark.parametrize("kind", ["hexahedron20", "tetra10", "hexahedron"])
def test_frequencies_are_those_that_calculix_finds(kind, tmp_path, monkeypatch):
    wanted = solved(tmp_path, kind)[:MODES]
    body = st.ReducedBody.read(tmp_path / "stored.sti", mesh=tmp_path / "stored.inp", points={"tip": TIP}, cutoff=60e3)
    assert wanted.size == MODES
    np.testing.assert_allclose(body.modes().frequency[:MODES], wanted, rtol=1e-5)
    if kind != "hexahedron":
        # For eight nodes CalculiX uses a mean volume strain; the mass of ten it integrates at four points, ours is
        # exact.
        monkeypatch.setattr(elements, "DEGREES", (2, 2, 2) if kind == "tetra10" else elements.DEGREES)
        solid = st.SolidBody.read(tmp_path / "stored.inp", {"steel": STEEL}, fixed=["clamp"], cutoff=60e3)
        np.testing.assert_allclose(solid.modes().frequency[:MODES], wanted, rtol=1e-5)


def test_points_are_nodes_by_number_or_by_place(tmp_path):
    solved(tmp_path)
    files = {"mass": tmp_path / "stored.mas", "stiffness": tmp_path / "stored.sti", "cutoff": 60e3}
    solid = st.SolidBody.read(
        tmp_path / "stored.inp", {"steel": STEEL}, points={"tip": TIP}, fixed=["clamp"], cutoff=60e3
    )
    node = 10 * (solid.mesh.node_at(TIP) + 1)
    labels = tuple((node, direction) for direction in SPACE)
    points = {"number": node, "labels": labels, "place": TIP}
    body = st.ReducedBody.read(**files, mesh=tmp_path / "stored.inp", points=points, translation=SPACE)
    wanted = receptance(solid, "tip")
    for point in points:
        np.testing.assert_allclose(receptance(body, point), wanted, atol=1e-4 * np.abs(wanted).max())
    with pytest.raises(ValueError, match=r"^points\['x'\] must be within .* m of a node, got .* \(0.1, 0.04, 0.03\)$"):
        st.ReducedBody.read(**files, mesh=tmp_path / "stored.inp", points={"x": (0.1, 0.04, 0.05)})
    held = 10 * (solid.mesh.node_at((0.0, 0.0, 0.0)) + 1)
    with pytest.raises(
        ValueError, match=rf"^points\['x'\] must name a node .* \(no node {held}, or all of it is held\)"
    ):
        st.ReducedBody.read(**files, points={"x": held})


def receptance(body, point):
    """Return the displacement of a point of a body under forces on it."""
    modes, trace = body.modes(), body.trace(point)
    return trace / np.where(modes.massless, 1.0, modes.angular_frequency**2) @ trace.T


def test_a_free_block_moves_as_one_whose_mass_is_known(tmp_path):
    solved(tmp_path, is_held=False)
    body = st.ReducedBody.read(tmp_path / "stored.mas", points={"tip": 10}, translation=SPACE, cutoff=60e3)
    assert np.count_nonzero(body.modes().frequency == 0.0) == 6
    assert body.total_mass == pytest.approx(7800.0 * 0.1 * 0.04 * 0.03, rel=1e-9)
