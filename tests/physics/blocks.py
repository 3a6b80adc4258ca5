"""Rigid blocks on points of a belt: equilibria and vibration in plain NumPy, every set of closed points tried."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
import scipy.linalg
from scipy.optimize import root

import stridula as st

LEAST = 1e-9


@dataclass(frozen=True)
class Block:
    """A block on supports, pressed on points of a belt.

    Attributes
    ----------
    mass, stiffness : ndarray, shape (n, n)
        Matrices of the block on its supports.
    normal, drag, across : ndarray, shape (points, n)
        Displacement of each point away from the belt, along the velocity of the belt and across it.
    gap : ndarray, shape (points,)
        Gaps [m].
    friction, speed : float
        Coefficient of friction, and speed of the belt [m/s].
    springs : list
        Coefficient and exponent of the stiffness of each point, None where it is rigid.
    load : ndarray, shape (n,)
        Forces.
    """

    mass: np.ndarray
    stiffness: np.ndarray
    normal: np.ndarray
    drag: np.ndarray
    across: np.ndarray
    gap: np.ndarray
    friction: float
    speed: float
    springs: list
    load: np.ndarray

    @property
    def pushes(self) -> np.ndarray:
        """Forces of unit normal forces with their friction."""
        return self.normal + self.friction * self.drag

    def with_closed(self, closed: list[int]) -> tuple[np.ndarray, np.ndarray] | None:
        """Return displacement and normal forces with some points closed, None if these do not balance."""
        soft = [k for k in closed if self.springs[k]]
        hard = [k for k in closed if not self.springs[k]]
        count = len(self.load)

        def solved(slopes: np.ndarray, forces: np.ndarray, about: np.ndarray) -> np.ndarray:
            """Newton's step: springs of some slopes with some forces about indentations."""
            matrix = np.zeros((count + len(hard),) * 2)
            right = np.concatenate([self.load, -self.gap[hard]])
            matrix[:count, :count] = self.stiffness
            matrix[:count, count:] = -self.pushes[hard].T
            matrix[count:, :count] = self.normal[hard]
            for k, slope, force, indented in zip(soft, slopes, forces, about, strict=True):
                matrix[:count, :count] += slope * np.outer(self.pushes[k], self.normal[k])
                right[:count] += self.pushes[k] * (force - slope * (indented + self.gap[k]))
            if not len(matrix):
                return right
            size = np.abs(matrix).max(axis=1)
            if not size.all():
                return np.full(len(right), np.nan)
            size = np.sqrt(size)
            scaled = matrix / np.outer(size, size)
            if np.linalg.cond(scaled / np.abs(scaled).max(axis=0)) > 1e13:
                return np.full(len(right), np.nan)
            return np.linalg.solve(scaled, right / size) / size

        k = np.array([self.springs[one][0] for one in soft])
        p = np.array([self.springs[one][1] for one in soft])
        if (p == 1.0).all():
            found = solved(k, np.zeros(len(soft)), np.zeros(len(soft)))
        else:
            # A power law continued to negative indentations by its secant, so that a pulling point shows.
            indented = (np.abs(self.load).max() / k) ** (1.0 / p)
            least = 1e-6 * indented

            def residual(about: np.ndarray) -> np.ndarray:
                at = np.maximum(about, least)
                forces = np.where(about > least, k * at**p, k * least ** (p - 1.0) * about)
                slopes = np.where(about > least, p * k * at ** (p - 1.0), k * least ** (p - 1.0))
                return -(self.gap[soft] + self.normal[soft] @ solved(slopes, forces, about)[:count]) - about

            for start in (indented, 0.1 * indented, 1e-3 * indented, -indented):
                answer = root(residual, start, method="hybr", options={"xtol": 1e-14})
                if np.abs(answer.fun).max() <= 1e-9 * np.abs(answer.x).max():
                    break
            else:
                return None
            at = np.maximum(answer.x, least)
            forces = np.where(answer.x > least, k * at**p, k * least ** (p - 1.0) * answer.x)
            slopes = np.where(answer.x > least, p * k * at ** (p - 1.0), k * least ** (p - 1.0))
            found = solved(slopes, forces, answer.x)
        if not np.isfinite(found).all():
            return None
        place, forces = found[:count], np.zeros(len(self.gap))
        forces[hard] = found[count:]
        indented = -(self.gap[soft] + self.normal[soft] @ place)
        forces[soft] = k * np.sign(indented) * np.abs(indented) ** p
        return place, forces

    def equilibria(self) -> list[tuple[list[int], np.ndarray, np.ndarray]]:
        """Return closed points, displacement and normal forces of every set in which all push and no other overlaps."""
        found = []
        for closed in product((True, False), repeat=len(self.gap)):
            chosen = [k for k, one in enumerate(closed) if one]
            solution = self.with_closed(chosen)
            if solution is None:
                continue
            place, forces = solution
            opening, scale = self.gap + self.normal @ place, np.abs(self.gap + np.abs(self.normal @ place)).max()
            free = np.delete(opening, chosen)
            if (forces >= -LEAST * np.abs(self.load).max()).all() and (free >= -LEAST * scale).all():
                found.append((chosen, place, forces))
        return found

    def growth(self, closed: list[int], forces: np.ndarray) -> float:
        """Return the largest growth of small vibration with these points closed [1/s]."""
        stiffness, damping = self.stiffness.copy(), np.zeros_like(self.stiffness)
        hard = []
        for k in closed:
            damping += self.friction * forces[k] / self.speed * np.outer(self.across[k], self.across[k])
            if self.springs[k] is None:
                hard.append(k)
            else:
                coefficient, p = self.springs[k]
                slope = coefficient * p * (forces[k] / coefficient) ** ((p - 1.0) / p)
                stiffness += slope * np.outer(self.pushes[k], self.normal[k])
        moves = scipy.linalg.null_space(self.normal[hard]) if hard else np.eye(len(stiffness))
        tests = scipy.linalg.null_space(self.pushes[hard]) if hard else moves
        if not moves.shape[1]:
            return -np.inf
        mass, damping, stiffness = (tests.T @ one @ moves for one in (self.mass, damping, stiffness))
        size = len(mass)
        first = np.block(
            [[np.zeros((size, size)), np.eye(size)], [-np.linalg.solve(mass, np.hstack([stiffness, damping]))]]
        )
        return float(np.linalg.eigvals(first).real.max())

    def system(self) -> st.System:
        """Return the same block as a system."""
        ways = 2 if len(self.load) == 3 else 3
        points = {}
        for k in range(len(self.gap)):
            points[f"p{k}"] = np.array([self.drag[k], self.normal[k], self.across[k]])[:ways]
        # Forces along the degrees of freedom, two or three at a time.
        eye, drives = np.vstack([np.eye(len(self.load)), np.zeros((1, len(self.load)))]), []
        for first in range(0, len(self.load), ways):
            points[f"load {first}"] = eye[first : first + ways]
        body = st.ReducedBody(self.mass, self.stiffness, points, name="block")
        for first in range(0, len(self.load), ways):
            parts = dict(zip("xyz", self.load[first : first + ways].tolist(), strict=False))
            drives.append(st.Force(body.at(f"load {first}"), **parts))
        contacts = [
            st.PointContact(
                body.at(f"p{k}"),
                st.RigidTrack(velocity=self.speed, name=f"belt {k}"),
                friction=st.Coulomb(self.friction),
                gap=float(self.gap[k]),
                stiffness=None if spring is None else st.PowerStiffness(*spring) if spring[1] > 1 else spring[0],
                surface="face",
                name=f"p{k}",
            )
            for k, spring in enumerate(self.springs)
        ]
        return st.System(contacts, drives)


def random_block(rng: np.random.Generator, spatial: bool, kind: str) -> Block:
    """Return a random block on 3 to 6 points.

    Parameters
    ----------
    rng : Generator
        Random numbers.
    spatial : bool
        Whether the block moves in space.
    kind : str
        ``linear``, ``power``, ``rigid`` or ``mixed`` points.
    """
    count = int(rng.integers(3, 7))
    height, friction = rng.uniform(0.02, 0.3), rng.uniform(0.1, 0.8)
    along, sideways = np.sort(rng.uniform(-0.1, 0.1, count)), rng.uniform(-0.05, 0.05, count)
    gap = rng.uniform(0.0, 2e-5, count) * (rng.random(count) < 0.5)
    push, at, side = rng.uniform(50.0, 500.0), rng.uniform(-0.05, 0.05), rng.uniform(-0.03, 0.03)
    supports, one, zero = 10.0 ** rng.uniform(3.5, 6.5, 6), np.ones(count), np.zeros(count)
    # Rigid points determine their forces only on a support that is elastic in all directions; others may be free.
    if kind in ("linear", "power") and rng.random() < 0.5:
        supports[[1, 3, 5]] = 0.0
    lever = np.array([1e-2, 1e-2, 1e-2])
    if spatial:
        # Displacements along x, y, z; rotations about x, y, z of a point at (x, -h, z).
        normal = np.array([zero, one, zero, -sideways, zero, along]).T
        drag = np.array([one, zero, zero, zero, sideways, height * one]).T
        across = np.array([zero, zero, one, -height * one, -along, zero]).T
        mass, stiffness = np.diag([1.0, 1.0, 1.0, *lever]), np.diag(supports * [1, 1, 1, 1e-2, 1e-2, 1e-2])
        load = -push * np.array([0.0, 1.0, 0.0, -side, 0.0, at])
    else:
        normal, drag = np.array([zero, one, along]).T, np.array([one, zero, height * one]).T
        across = np.zeros((count, 3))
        mass, stiffness = np.diag([1.0, 1.0, 1e-2]), np.diag(supports[[0, 1, 5]] * [1, 1, 1e-2])
        load = -push * np.array([0.0, 1.0, at])
    springs = []
    for _ in range(count):
        chosen = str(rng.choice(["linear", "power", "rigid"])) if kind == "mixed" else kind
        size = 10.0 ** rng.uniform(-1.0, 1.0)
        springs.append({"linear": (1e7 * size, 1.0), "power": (2e9 * size, 1.5), "rigid": None}[chosen])
    return Block(mass, stiffness, normal, drag, across, gap, friction, rng.uniform(0.5, 2.0), springs, load)
