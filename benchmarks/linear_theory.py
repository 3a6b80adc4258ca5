"""Linear theory of a brake with hundreds of contacts: time of a point, once the modes of the bodies are known.

Two linings on a disc that turns, touching at nodes with and without a stiffness: some forty modes and a thousand
residual shapes. The forces of both sides agree with the load. The shipped brake then has points of another friction
each: a point whose matrices are those of the last, with the residual shapes that nothing sees eliminated, against a
point with all of them, and the time of 10 000 points on two processors that follows from it. The exponents agree. Last
come the derivatives of its growing modes by all parameters, in systems solved again.
"""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np
import xarray as xr

import stridula as st
from ratios import REPEATS, WARM_UP, Ratio, must_agree, over, seconds, show, sized
from space import IRON, LINING
from stridula.linear.equilibrium import find_equilibrium
from stridula.linear.given import given_velocity
from stridula.linear.growth import Growths
from stridula.linear.modes import exponents_alone
from stridula.linear.structure import Structure
from stridula.linear.vibration import vibration
from stridula.studies.task import one_thread_each

TITLE = "linear theory of many contacts: time of a point over 1 s"
# Elements of each lining along radius, angle and thickness; at most so many of the nodes of its face touch.
DIVISIONS, NODES = sized(((5, 10, 1), 180), ((1, 2, 1), 6))
LOAD, FRICTION = 2000.0, 0.45
STIFFNESSES = {"rigid": None, "on a stiffness": 1e8}
SECOND, BAR = 1.0, 5.0
# Values of friction of the points of the shipped brake, and the time of 10 000 points over ten minutes.
FRICTIONS = sized(np.linspace(0.3, 0.5, 8), np.array([0.3, 0.5])).tolist()
POINTS, PROCESSORS, MINUTES = 10_000, 2, 600.0
# Parameters of the derivatives; None for all from which its modes follow.
PARAMETERS = sized(None, ("friction.coefficient",))


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

    yield from many_points()
    yield from derivatives()


def many_points() -> Iterator[Ratio]:
    """Yield the time of many points of the shipped brake, from the scenario to the exponents, for both ways."""

    def systems() -> Iterator[st.System]:
        for friction in FRICTIONS:
            yield st.load_scenario("brake", {"friction": friction}).system

    def kept() -> list[float]:
        growths = Growths()
        return [float(growths.of(system).exponents.real.max()) for system in systems()]

    def anew() -> list[float]:
        return [growth_of_all_shapes(system) for system in systems()]

    def agree(found: list[float], expected: list[float]) -> None:
        must_agree("growth of the brake", found, expected, 1e-9)

    with one_thread_each():
        kept_times, times = seconds(kept, anew, agree=agree)
    words = f"the shipped brake, {len(FRICTIONS)} values of friction"
    yield Ratio(f"{words}: all shapes at each over what changes", over(times, kept_times))
    each = POINTS / len(FRICTIONS) / PROCESSORS / MINUTES
    yield Ratio(f"{words}: {POINTS} points on two processors over 10 min", [each * one for one in kept_times])


def derivatives() -> Iterator[Ratio]:
    """Yield the time of the derivatives of the growing modes of the shipped brake over that of a system solved again.

    The derivative by the friction agrees with the difference of two systems solved again.
    """
    friction, change = 0.45, 1e-4

    def solved(value: float = friction) -> xr.Dataset:
        return st.sliding_stability(st.load_scenario("brake", {"friction": value}).system)

    def all_of_them() -> xr.Dataset:
        return st.mode_sensitivity("brake", PARAMETERS)

    with one_thread_each():
        found_times, times = seconds(all_of_them, solved)
        found = all_of_them()
        fastest = found.isel(mode=int(np.argmax(found.growth_rate.values)))
        more, less = (solved(friction + side * change).sel(mode=fastest.mode) for side in (1.0, -1.0))
    by_friction = float(fastest.d_growth_rate.sel(parameter="friction.coefficient"))
    difference = float(more.growth_rate - less.growth_rate) / (2.0 * change)
    must_agree("derivative of the growth by the friction", by_friction, difference, 1e-5)
    count = found.sizes["parameter"]
    yield Ratio(
        f"the shipped brake, derivatives by {count} parameters over a system solved again", over(found_times, times)
    )


def growth_of_all_shapes(system: st.System) -> float:
    """Return the growth of the fastest mode with every residual shape [1/s]."""
    structure = Structure(system)
    equilibrium = find_equilibrium(structure, given_velocity(None, structure))
    return float(exponents_alone(structure, vibration(structure, equilibrium)).real.max())


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
