"""Time and memory of a contact between faces of ordinary meshes: a pad of tetrahedra on a disc of tetrahedra.

A fresh process meshes both, computes their modes and residual shapes at the patches of their faces, places the contacts
and finds the growing modes. The forces of the contacts agree with the load.
"""

from __future__ import annotations

import itertools
import math
import sys
import time
from collections.abc import Iterator

import numpy as np

import stridula as st
from meshes import in_fresh_process
from ratios import Ratio, must_agree, show, sized

TITLE = "contact of faces of ordinary meshes: a pad of tetrahedra on a disc, from meshes to growing modes"
# Elements, cut into six tetrahedra each, along radius, angle and axis.
DISC, PAD = sized(((6, 78, 2), (8, 21, 2)), ((2, 24, 1), (2, 4, 1)))
LOAD = 1e3
MINUTE, BAR_BYTES = 60.0, 2e9
# Tetrahedra of a hexahedron by its corners.
TETRAHEDRA = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]


def rows() -> Iterator[Ratio | str]:
    """Yield time and memory, measured once: they are long compared with disturbances."""
    (taken, disc, pad, contacts), peak = in_fresh_process(__file__)
    words = f"faces of {int(disc)} and {int(pad)} triangles, {int(contacts)} contacts"
    yield Ratio(f"{words}: time over 1 min", [taken / MINUTE], most=1.0)
    if peak is None:
        yield f"{words}: memory skipped, this system does not report the memory of a process"
    else:
        yield Ratio(f"{words}: peak memory over 2 GB", [peak / BAR_BYTES], most=1.0)


def tetrahedra(
    radii: tuple[float, float], angles: tuple[float, float], bottom: float, height: float, divisions: tuple[int, ...]
) -> st.SolidMesh:
    """Return a sector of a ring about z in tetrahedra, with the faces "top", "bottom" and "inner"."""
    mesh = st.SolidMesh.sector(radii, angles, height, divisions, axis="z")
    corners, numbers = np.unique(mesh.elements[:, :8], return_inverse=True)
    nodes = np.array(mesh.nodes[corners])
    elements = numbers.reshape(-1, 8)[:, TETRAHEDRA].reshape(-1, 4)
    radius = np.hypot(nodes[:, 0], nodes[:, 1])
    on = {"top": nodes[:, 2] > height - 1e-9, "bottom": nodes[:, 2] < 1e-9, "inner": radius < radii[0] + 1e-9}
    faces: dict[str, list[tuple[int, int]]] = {name: [] for name in on}
    sides = st.SolidMesh(nodes, elements, "tetra").element_kind.faces
    for (element, row), side in itertools.product(enumerate(elements), range(len(sides))):
        for name, there in on.items():
            if there[row[list(sides[side])]].all():
                faces[name].append((element, side))
    named = {name: np.array(found) for name, found in faces.items()}
    return st.SolidMesh(nodes, elements, "tetra", faces=named).moved((0.0, 0.0, bottom))


def touch() -> None:
    """Print the time from the meshes to the growing modes [s], numbers of triangles, and of contacts."""
    began = time.perf_counter()
    ring = tetrahedra((0.08, 0.14), (0.0, 2.0 * math.pi), 0.0, 0.02, DISC)
    sector = tetrahedra((0.09, 0.13), (-0.5, 0.5), 0.02, 0.015, PAD)
    iron, lining = st.Material(1.2e11, 7200.0, 0.27), st.Material(5e9, 2500.0, 0.25)
    disc = st.SolidBody(ring, iron, fixed=["inner"], cutoff=8e3, damping=2e-3, contact_faces=["top"], name="disc")
    pad = st.SolidBody(
        sector, lining, fixed={"top": "xy"}, cutoff=15e3, damping=0.01, contact_faces=["bottom"], name="pad"
    )
    turning = ((0.0, 0.0, 1.0), (0.0, 0.0, 0.0), 10.0)
    face = st.SurfaceContact(pad, "bottom", disc, "top", st.Coulomb(0.4), stiffness=1e12, turning=turning)
    theory = st.sliding_stability(st.System(face, [st.Force(pad.at("top"), z=-LOAD)]))
    taken = time.perf_counter() - began
    must_agree("forces of the contacts and the load", [float(theory.normal_force.sum())], [LOAD], 1e-3)
    triangles = (len(one.mesh.faces[name]) for one, name in ((disc, "top"), (pad, "bottom")))
    print(taken, *triangles, len(face.contacts))


if __name__ == "__main__":
    if "child" in sys.argv:
        touch()
    else:
        show(TITLE, rows())
