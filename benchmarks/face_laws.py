"""Laws of points in contact, in NumPy: what forces miss of them, whatever found the forces.

A point presses or is open; where it presses its gap is zero, or that of its stiffness; friction lies in its cone, where
the point slides on the border and against the slip. What counts as slip follows from the last steps, see *All together*
in docs/model-several-contacts.rst: each reading of a point is a pair of an apex and a shift. Where slips end, several
readings are allowed, and that with the least residual counts.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from face_problems import SLIDING, STICKING, Problem

# Gauss's quadrature of three points, exact for the products of a triangle and a parabola.
NODES, WEIGHTS = np.array([-np.sqrt(0.6), 0.0, np.sqrt(0.6)]), np.array([5.0, 8.0, 5.0]) / 9.0
# Smallest slope of a force, times the compliance of its point: forces of points that lift off may fall with the gap.
FLATTEST = 1e-4
# Share of its friction by which a point that slides may be inside its cone.
BORDER = 1e-6


def press_on_path(inside: float, now: float, before: float) -> tuple[float, float]:
    """Return the mean indentation, weighted by a triangle, on the parabola through three; and its slope in the first.

    Only where the path is inside it counts, and nothing if it is outside in all three steps.
    """
    if max(inside, now, before) <= 0.0:
        return 0.0, 0.0
    path = np.array([0.5 * (inside - 2.0 * now + before), 0.5 * (inside - before), now])
    roots = np.roots(path) if path[:2].any() else np.array([])
    cuts = [root.real for root in roots if abs(root.imag) == 0.0 and -1.0 < root.real < 1.0]
    ends = np.unique([-1.0, 0.0, 1.0, *cuts])
    middle, half = 0.5 * (ends[1:] + ends[:-1]), 0.5 * np.diff(ends)
    places, weights = middle[:, None] + half[:, None] * NODES, half[:, None] * WEIGHTS
    depth = np.polyval(path, places)
    weights = weights * (1.0 - np.abs(places)) * (np.polyval(path, middle) > 0.0)[:, None]
    return float((weights * depth).sum()), float((weights * 0.5 * places * (places + 1.0)).sum())


def press_by_energies(inside: float, before: float) -> tuple[float, float]:
    """Return the difference of half the squares of two indentations over theirs, and its slope in the first."""
    x, was = max(inside, 0.0), max(before, 0.0)
    if inside == before:
        return x, 0.5 * (x > 0.0)
    mean = 0.5 * (x * x - was * was) / (inside - before)
    return mean, (x - mean) / (inside - before)


def press(problem: Problem, i: int, inside: float) -> tuple[float, float]:
    """Return the force of the stiffness of a point for an indentation, and its slope."""
    now, before = -problem.gaps[i]
    steepness = problem.stiffness[i] * problem.reach[i]
    share = max(1.0 - 1.0 / steepness, 0.0)
    both = np.array([press_on_path(inside, now, before), press_by_energies(inside, before)])
    force, slope = problem.stiffness[i] * ((1.0 - share) * both[0] + share * both[1])
    return float(force), float(slope)


def as_rigid(problem: Problem, forces: np.ndarray) -> Problem:
    """Return points that yield linearly about their gaps under forces as rigid ones with a larger compliance."""
    compliance, free = problem.compliance.copy(), problem.free.copy()
    own, moved = free.shape[1], problem.moved(forces)
    for i in np.flatnonzero(problem.stiffness):
        force, slope = press(problem, i, -moved[i, 0])
        slope = max(slope, FLATTEST / compliance[own * i, own * i])
        if force > 0.0:
            compliance[own * i, own * i] += 1.0 / slope
            free[i, 0] -= moved[i, 0] + force / slope
    return replace(problem, compliance=compliance, free=free, stiffness=np.zeros(len(free)))


def own_compliance(problem: Problem, i: int) -> np.ndarray:
    """Return the compliance of a point for its own forces."""
    own = problem.free.shape[1]
    return problem.compliance[own * i : own * (i + 1), own * i : own * (i + 1)]


def before_its_end(problem: Problem, forces: np.ndarray, i: int, way: np.ndarray) -> np.ndarray:
    """Return the forces with which a point would slide on along a direction, times the share before its slip ends."""
    w, slid = own_compliance(problem, i), problem.last[i] @ way
    free, along = problem.moved(forces)[i] - w @ forces[i], np.array([1.0, *(-problem.friction[i] * way)])
    clear = w[0] @ along
    if clear <= 0.0 or free[0] >= 0.0 or slid <= 0.0:
        return np.zeros(len(along))
    on = -free[0] / clear
    farther = (free + on * w @ along)[1:] @ way
    return np.asarray((slid / (slid - farther) if farther < 0.0 else 0.0) * on * along)


def missed(force: np.ndarray, gap: float, slip: np.ndarray, friction: float, soft: float) -> float:
    """Return what the forces of a point miss of the laws of contact and friction [N]; `soft` makes forces of gaps."""
    normal, pulled = force[0], force[1:]
    size, speed = np.linalg.norm(pulled), np.linalg.norm(slip) / soft
    contact = max(-normal, -gap / soft, min(normal, abs(gap) / soft))
    within, border = size - friction * normal, min(speed, abs(friction * normal - size))
    wrong_way = min(speed, np.linalg.norm(pulled + size * slip / (soft * speed))) if speed > 0.0 else 0.0
    return float(max(contact, within, border, wrong_way))


def goes_on(problem: Problem, forces: np.ndarray, i: int) -> bool:
    """Return whether point `i` slides on in space: its friction acts against its last slips and that of the step."""
    pulled, last = forces[i, 1:], problem.last[i]
    against = [pulled @ slip < 0.0 for slip in (problem.moved(forces)[i, 1:], last, 6.0 * last + problem.earlier[i])]
    slides = np.linalg.norm(pulled) > (1.0 - BORDER) * problem.friction[i] * forces[i, 0]
    return len(pulled) > 1 and bool(problem.status[i] != STICKING and slides and all(against))


def readings(problem: Problem, forces: np.ndarray, i: int) -> tuple[list[float], list[float]]:
    """Return what point `i` misses of its law for each meaning that its slip should have, and for others it may have.

    A point whose slip was found to end keeps the meaning of that, also if it then slides on, and an end that does not
    settle is forgotten.
    """
    moved, force, mu = problem.moved(forces)[i], forces[i], problem.friction[i]
    gap, slip, last, w = moved[0], moved[1:], problem.last[i], own_compliance(problem, i)
    soft, carried_on = np.trace(w) / len(w), (6.0 * last + problem.earlier[i]) / 9.0
    alone = missed(force, gap, slip + problem.away[i], mu, soft)
    ends = list(endings(problem, forces, i))
    if len(slip) == 2:
        sticks = mu * force[0] - np.linalg.norm(force[1:])
        on = max(missed(force, gap, slip + carried_on, mu, soft), sticks)
        return ([on], [alone, *ends]) if goes_on(problem, forces, i) else ([on, alone, *ends], [])
    return (ends, [alone]) if ends else ([alone], [])


def endings(problem: Problem, forces: np.ndarray, i: int) -> Iterator[float]:
    """Yield what point `i` misses of its law if its slip ends or turns round in the step."""
    last, pulled, moved, w = problem.last[i], forces[i, 1:], problem.moved(forces)[i], own_compliance(problem, i)
    if problem.status[i] != SLIDING or not last.any():
        return
    way = last / np.linalg.norm(last)
    force = forces[i] - before_its_end(problem, forces, i, way)
    yield missed(force, moved[0], moved[1:], problem.friction[i], np.trace(w) / len(w))
    if len(last) == 2:
        yield along_a_line(problem, forces, i, way)
        if pulled.any():
            yield along_a_line(problem, forces, i, -pulled / np.linalg.norm(pulled))


def along_a_line(problem: Problem, forces: np.ndarray, i: int, way: np.ndarray) -> float:
    """Return what a point of few misses whose slip ends, which is solved as one of the plane along a direction."""
    moved, w = problem.moved(forces)[i], own_compliance(problem, i)
    sense = way if way @ problem.last[i] >= 0.0 else -way
    force = forces[i] - before_its_end(problem, forces, i, sense)
    across = force[1:] - (force[1:] @ way) * way
    in_plane = np.array([force[0], force[1:] @ way])
    left = missed(in_plane, moved[0], moved[1:] @ way * np.ones(1), problem.friction[i], np.trace(w) / len(w))
    return max(left, float(np.linalg.norm(across)))


def judge(problem: Problem, forces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what the forces of each point miss of its law, over the largest normal force.

    The second array is for the meaning alone that its slip should have.
    """
    largest = forces[:, 0].max()
    if not (np.isfinite(forces).all() and largest > 0.0):
        return np.full(len(forces), np.inf), np.full(len(forces), np.inf)
    rigid = as_rigid(problem, forces)
    both = [readings(rigid, forces, i) for i in range(len(forces))]
    left = np.array([(min(own + other), min(own)) for own, other in both]) / largest
    return left[:, 0], left[:, 1]
