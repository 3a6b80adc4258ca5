"""Linear theory of a brake with hundreds of contacts: time of a point, once the modes of the bodies are known.

Two linings on a disc that turns, touching at nodes with and without a stiffness: some forty modes and a thousand
residual shapes. The forces of both sides agree with the load.
"""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np

import stridula as st
from ratios import REPEATS, WARM_UP, Ratio, must_agree, show, sized
from space import IRON, LINING

TITLE = "linear theory of many contacts: time of a point over 1 s"
# Elements of each lining along radius, angle and thickness; at most so many of the nodes of its face touch.
DIVISIONS, NODES = sized(((5, 10, 1), 180), ((1, 2, 1), 6))
LOAD, FRICTION = 2000.0, 0.45
STIFFNESSES = {"rigid": None, "on a stiffness": 1e8}
SECOND, BAR = 1.0, 5.0


def rows() -> Iterator[Ratio]:
    """Yield the time of a point of a map for each kind of contact: description, equilibrium and all exponents."""
    disc = st.AxisymmetricBody(
        st.RectangleProfile({"disc": ((0.06, 0.13), (-0.01, 0.01))}),
        IRON, 6e3, "inner", damping=0.001, axis=(0.0, 1.0, 0.0), turning=20.0, name="disc",
    )  # fmt: skip
    pads = [lining(side) for side in (1.0, -1.0)]
    for words, stiffness in STIFFNESSES.items():
        taken = []
        for _ in range(WARM_UP + REPEATS):
            began = time.perf_counter()
            system = brake(disc, pads, stiffness)
            found = st.sliding_stability(system)
            taken.append((time.perf_counter() - began) / SECOND)
        forces = found.normal_force.values.reshape(2, -1).sum(axis=1)
        must_agree(f"forces of linings that are {words} and the load", forces, [LOAD, LOAD], 1e-6)
        modes = [body.modes() for body in system.bodies]
        massless = sum(int(one.massless.sum()) for one in modes)
        size = f"{len(system.contacts)} contacts, {sum(one.count for one in modes) - massless} modes, {massless} shapes"
        yield Ratio(f"{size}, {words}", taken[WARM_UP:], most=BAR)


def lining(side: float) -> tuple[st.SolidBody, dict[str, np.ndarray]]:
    """Return a lining above or below the disc, and the places of its points by name."""
    mesh = st.SolidMesh.sector((0.085, 0.125), (-0.4, 0.4), 0.012, DIVISIONS, axis="y")
    mesh = mesh.moved((0.0, 0.01 * side, 0.0), (0.0, 0.0, 0.5 * np.pi * (1.0 - side))).quadratic()
    nodes = mesh.nodes_of("bottom")
    nodes = nodes[np.unique(np.linspace(0, len(nodes) - 1, NODES).round().astype(int))]
    points = {f"node {node}": int(node) for node in nodes}
    name = "upper" if side > 0.0 else "lower"
    body = st.SolidBody(mesh, LINING, points, cutoff=9e3, damping=0.01, name=name)
    return body, {point: mesh.nodes[node] for point, node in points.items()}


def brake(disc: st.AxisymmetricBody, pads: list, stiffness: float | None) -> st.System:
    """Return both linings pressed on the disc, each held along it by springs at both ends."""
    contacts, loads, springs = [], [], []
    for (body, places), side in zip(pads, (1.0, -1.0), strict=True):
        for name, place in places.items():
            x, y, z = disc.frame @ place
            across = np.cross(disc.axis, place)
            touched = disc.at((float(np.hypot(x, y)), float(np.arctan2(y, x)), float(z)))
            words = {"normal": (0.0, side, 0.0), "tangent": tuple((across / np.linalg.norm(across)).tolist())}
            yields = None if stiffness is None else st.LinearStiffness(stiffness)
            law = st.Coulomb(FRICTION)
            contacts.append(st.PointContact(body.at(name), touched, friction=law, stiffness=yields, **words))
        loads.append(st.Force(body.at("top"), y=-LOAD * side))
        springs += [st.Spring(body.at(end), stiffness=2e7, direction=way) for end in ("start", "end") for way in "xz"]
    return st.System(contacts, loads, springs)


if __name__ == "__main__":
    show(TITLE, rows())
