"""Random faces of points in contact: steps whose forces are sought, and the forces that the kernel finds.

A face has 4 to 64 points, in the plane or in space, rigid or with a stiffness, on bodies with fewer modes than the
forces of the points, down to half. It is solved from rest, for motions drawn at random, or in a run of some steps on a
belt, in which points land, stick, slide and lift off; the run ends with the first step that is not solved.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from stridula._kernels.layout import columns as at
from stridula._kernels.layout.laws import LAW_COLUMNS, STATIC
from stridula.integration.contact_solve import GaussSeidel
from stridula.integration.forces import solved

OPEN, STICKING, SLIDING = range(3)
KINDS = tuple(
    (start, kind, where)
    for start in ("from rest", "in a run")
    for kind in ("rigid", "yielding")
    for where in ("plane", "space")
)
POINTS, RANKS, FRICTION = (4, 64), (0.5, 1.0), (0.05, 0.6)
# Stiffness of a point times the size of its sawtooth under unit forces on all: up to 1 the step resolves it.
RESOLVED = (0.05, 10.0)
# Steps of a run, and the step at which its belt may turn round.
STEPS, TURNS = (2, 13), (1, 12)
SOLVE, STEP = GaussSeidel(), 1e-5
ALONG_TANGENTS = (
    (at.MATERIAL, at.LAST_SLIP, at.EARLIER_SLIP, at.LAST_TANGENTIAL),
    (at.MATERIAL_B, at.LAST_SLIP_B, at.EARLIER_SLIP_B, at.LAST_TANGENTIAL_B),
)


@dataclass(frozen=True)
class Problem:
    """Points in a step, forces as ``(normal, -tangential)``.

    Attributes
    ----------
    compliance : ndarray, shape (rows, rows)
        Gaps and slips for unit forces [m/N].
    free : ndarray, shape (points, 1 + tangents)
        Gaps and slips without forces [m].
    friction : ndarray, shape (points,)
        Coefficients of friction.
    status : ndarray, shape (points,)
        What they were in the last step.
    away, last, earlier : ndarray, shape (points, tangents)
        Distances from the anchors of those that stuck, slips of the last two steps [m].
    force : ndarray, shape (points, 1 + tangents)
        Forces of the last step [N].
    stiffness, reach : ndarray, shape (points,)
        Stiffness of each point, zero if rigid [N/m], and the size of its sawtooth under unit forces on all [m].
    gaps : ndarray, shape (points, 2)
        Gaps of the last two steps, the latest first [m].
    """

    compliance: np.ndarray
    free: np.ndarray
    friction: np.ndarray
    status: np.ndarray
    away: np.ndarray
    last: np.ndarray
    earlier: np.ndarray
    force: np.ndarray
    stiffness: np.ndarray
    reach: np.ndarray
    gaps: np.ndarray

    def moved(self, forces: np.ndarray) -> np.ndarray:
        """Return gaps and slips under forces, shape (points, 1 + tangents)."""
        return np.asarray(self.free + (self.compliance @ forces.ravel()).reshape(self.free.shape))

    def plain(self) -> Problem:
        """Return the same step without the last slips: the slip of the step alone has the direction of friction."""
        return replace(self, last=np.zeros_like(self.last), earlier=np.zeros_like(self.last))

    def carried(self) -> np.ndarray:
        """Return what the points carry from step to step."""
        carried = np.zeros((len(self.friction), at.CARRIED))
        carried[:, at.STATUS], carried[:, at.LAST_NORMAL] = self.status, self.force[:, 0]
        carried[:, [at.LAST_GAP, at.EARLIER_GAP]] = self.gaps
        for k in range(self.last.shape[1]):
            numbers = self.away[:, k], self.last[:, k], self.earlier[:, k], -self.force[:, 1 + k]
            carried[:, ALONG_TANGENTS[k]] = np.column_stack(numbers)
        return carried


class Found(NamedTuple):
    """Forces that the kernel returns, the sweeps or steps of Newton's method, and its error, relative to the largest.

    Attributes
    ----------
    forces : ndarray, shape (points, 1 + tangents)
        Forces [N].
    status : ndarray, shape (points,)
        What the points are.
    sweeps : int
        Number that a record has as ``contact_sweeps``.
    error : float
        Error that decides whether the step counts as solved.
    """

    forces: np.ndarray
    status: np.ndarray
    sweeps: int
    error: float

    @property
    def solved(self) -> bool:
        """Whether the kernel says so."""
        return self.error <= SOLVE.tolerance


def solve(problem: Problem) -> Found:
    """Return the forces that the kernel finds."""
    count, own = problem.free.shape
    laws, constants = np.zeros((count, LAW_COLUMNS)), np.zeros((count, at.CONTACT_CONSTANTS))
    laws[:, STATIC] = constants[:, at.AT_REST] = problem.friction
    constants[:, at.YIELD_STIFFNESS], constants[:, at.YIELD_EXPONENT] = problem.stiffness, 1.0
    constants[:, at.YIELD_REACH] = problem.reach
    given = (np.full(count, at.COULOMB), laws), problem.carried(), STEP, SOLVE
    free = problem.free
    found = solved(free[:, 0], free[:, 1:], problem.compliance, *given, constants=constants)
    forces = found.forces(own - 1) * np.array([1.0, *[-1.0] * (own - 1)])
    return Found(forces, found.now[:, at.STATUS_NOW], found.sweeps, found.error)


def shapes_of(random: np.random.Generator, rows: int) -> np.ndarray:
    """Return rows of fewer modes, at least half of them, shape (rows, modes)."""
    modes = int(np.ceil(rows * random.uniform(*RANKS)))
    return np.asarray(random.standard_normal((rows, modes)) / np.sqrt(modes))


def friction_of(random: np.random.Generator, count: int) -> np.ndarray:
    """Return coefficients of friction, one for the face or one for each point."""
    return np.asarray(np.broadcast_to(random.uniform(*FRICTION, random.choice([1, count])), count))


def stiffness_of(random: np.random.Generator, kind: str, compliance: np.ndarray, own: int) -> np.ndarray:
    """Return stiffness and size of the sawtooth of each point, shape (2, points); a sawtooth is slower than masses."""
    reach = 0.25 * np.abs(compliance[::own, ::own]).sum(axis=1)
    yields = np.exp(random.uniform(*np.log(RESOLVED))) if kind == "yielding" else 0.0
    return np.array([yields / reach, reach])


def at_rest(random: np.random.Generator, kind: str, count: int, own: int) -> Problem:
    """Return a face from rest: motions that forces in and beyond their cones would undo, and others.

    Some points are nearly unloaded.
    """
    shapes = shapes_of(random, own * count)
    compliance, tangents = shapes @ shapes.T, own - 1
    normal = np.abs(random.standard_normal(count)) * random.choice([0.01, 1.0], count)
    spread = random.choice([0.0, 0.3, 1.0])
    given = np.column_stack([normal, spread * normal[:, None] * random.standard_normal((count, tangents))])
    free = random.choice([0.0, 0.05]) * shapes @ random.standard_normal(shapes.shape[1]) - compliance @ given.ravel()
    nothing = np.zeros((count, tangents))
    return Problem(
        compliance,
        free.reshape(count, own),
        friction_of(random, count),
        np.zeros(count),
        *[nothing] * 3,
        np.zeros((count, own)),
        *stiffness_of(random, kind, compliance, own),
        np.zeros((count, 2)),
    )


class Run:
    """A face on a belt, marched by central differences in steps of unit time on modes of unit mass."""

    def __init__(self, random: np.random.Generator, kind: str, count: int, own: int) -> None:
        self.shapes = shapes_of(random, own * count)
        modes, tangents, compliance = self.shapes.shape[1], own - 1, self.shapes @ self.shapes.T
        # Squares of the angles of the modes in a step.
        self.angles = random.uniform(0.02, 1.0, modes) ** 2
        normal = np.abs(random.standard_normal(count)) * random.choice([0.01, 1.0], count)
        pressed = np.column_stack([normal, np.zeros((count, tangents))])
        self.load = -(self.shapes.T @ pressed.ravel())
        self.q = np.zeros(modes)
        self.d = random.choice([0.01, 0.1, 0.5]) * random.standard_normal(modes)
        way = random.standard_normal(tangents)
        self.belt = random.choice([0.0, 0.01, 0.1, 1.0]) * way / np.linalg.norm(way)
        self.opening = random.choice([0.0, 0.3]) * np.abs(random.standard_normal(count))
        nothing = np.zeros((count, tangents))
        self.problem = Problem(
            compliance,
            np.zeros((count, own)),
            friction_of(random, count),
            np.zeros(count),
            *[nothing] * 3,
            np.zeros((count, own)),
            *stiffness_of(random, kind, compliance, own),
            np.column_stack([self.opening] * 2),
        )

    def next(self) -> Problem:
        """Return the points in the next step."""
        moving = self.d - self.angles * self.q + self.load
        free, slip = ((self.shapes @ part).reshape(self.problem.free.shape) for part in (self.q + moving, moving))
        free[:, 0] += self.opening
        free[:, 1:] = slip[:, 1:] - self.belt
        return replace(self.problem, free=free)

    def keep(self, problem: Problem, found: Found) -> None:
        """Complete the step, and carry what the points are."""
        self.d = self.d - self.angles * self.q + self.load + self.shapes.T @ found.forces.ravel()
        self.q = self.q + self.d
        moved, stuck = problem.moved(found.forces), (found.status == STICKING)[:, None]
        goes_on = stuck & (problem.status == STICKING)[:, None]
        self.problem = replace(
            problem,
            status=found.status,
            away=np.where(stuck, moved[:, 1:] + goes_on * problem.away, 0.0),
            last=np.where(stuck, 0.0, moved[:, 1:]),
            earlier=problem.last,
            force=found.forces,
            gaps=np.column_stack([moved[:, 0], problem.gaps[:, 0]]),
        )


def in_a_run(random: np.random.Generator, kind: str, count: int, own: int) -> Problem:
    """Return the last step of a run, or the first that is not solved."""
    run, steps, turns = Run(random, kind, count, own), int(random.integers(*STEPS)), int(random.integers(*TURNS))
    for step in range(steps):
        if step == turns:
            run.belt = -run.belt
        problem = run.next()
        if step == steps - 1:
            break
        found = solve(problem)
        if not found.solved:
            break
        run.keep(problem, found)
    return problem


def drawn(seed: int) -> tuple[tuple[str, str, str], Problem]:
    """Return kind and problem of a seed; the kinds follow in turn."""
    start, kind, where = KINDS[seed % len(KINDS)]
    random = np.random.default_rng(seed)
    count, own = int(random.integers(POINTS[0], POINTS[1] + 1)), 3 if where == "space" else 2
    return KINDS[seed % len(KINDS)], (at_rest if start == "from rest" else in_a_run)(random, kind, count, own)
