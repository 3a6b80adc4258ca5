"""Modes alone, in pairs or in groups as invariant subspaces of a pencil, with derivatives of their matrices."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ..arrays import Array
from .pencils import Pencil
from .vibration import ROUND_OFF

# Distance of the shift from the middle of the exponents, relative to that of the nearest other one: each iteration
# reduces errors by about this factor.
BESIDE = 0.05
# Most iterations, and angle between subspaces, relative to rounding, that ends them.
PASSES, SETTLED = 60, 8.0
# Angle below which its rise is that of rounding.
ROUGH = 1e-6
Vectors = tuple[Array, Array, Array, Array]


@dataclass(frozen=True)
class InvariantPair:
    """Right and left invariant subspaces of a few exponents, and the matrix of which these are the eigenvalues.

    With a vector ``x = (q, v, z, m)`` of `Pencil` as ``B x' = A x``: ``A right = B right matrix``, and likewise for the
    left ones.

    Attributes
    ----------
    matrix : ndarray of complex, shape (group, group)
        Its eigenvalues are the exponents [1/s].
    right : tuple of ndarray
        Displacements, velocities, states and multipliers, each of shape (..., group).
    left : tuple of ndarray
        The same for the equations of q, v, z and of the constraints, multiplied by the inverse of ``left^T B right``.
    """

    matrix: Array
    right: Vectors
    left: Vectors

    def derivative(self, change: Pencil) -> Array:
        """Return the derivative of the matrix by a parameter, from that of the pencil, shape (group, group).

        That of its trace is the derivative of the sum of the exponents, also where these are equal or merge; where they
        are distinct, its diagonal on the eigenvectors has their derivatives (Lancaster 1964).
        """
        place, speed, own, forces = self.right
        _, to_motion, to_states, to_constraints = self.left
        pushed = change.pushes.T @ forces - change.damping @ speed - change.stiffness @ place - change.by_state @ own
        pushed = pushed - change.mass @ speed @ self.matrix
        driven = change.from_velocity @ speed + change.from_displacement @ place + change.state[:, None] * own
        return to_motion.T @ pushed + to_states.T @ driven + to_constraints.T @ (change.held @ place)


def invariant_pair(pencil: Pencil, exponents: Sequence[complex], shapes: Array, gap: float) -> InvariantPair:
    """Return the invariant subspaces of exponents, by inverse iteration from their approximate shapes.

    Parameters
    ----------
    pencil : Pencil
        The pencil.
    exponents : sequence of complex
        A few exponents that lie close together [1/s].
    shapes : ndarray of complex, shape (modes, group)
        Their modal displacements.
    gap : float
        Distance of the nearest other exponent from their middle [1/s].
    """
    values = np.array(exponents)
    shift = complex(values.mean() + BESIDE * gap * np.exp(0.25j * np.pi))
    about = _About(pencil, shift)
    start = about.started(values, shapes)
    before, right = _settled(about.right, start, abs(shift))
    _, left = _settled(about.left, start, 1.0 / abs(shift))
    place, speed, own, _ = right
    to_place, to_motion, to_states, _ = left
    mass = pencil.mass
    overlap = to_place.T @ place + to_motion.T @ mass @ speed + to_states.T @ own
    came = to_place.T @ before[0] + to_motion.T @ mass @ before[1] + to_states.T @ before[2]
    matrix = shift * np.eye(values.size) + np.linalg.solve(overlap, came)
    return InvariantPair(matrix, right, _times(left, np.linalg.inv(overlap).T))


class _About:
    """The inverse of a pencil about a shift, ``(A - shift B)^-1 B``, for right and left vectors."""

    def __init__(self, pencil: Pencil, shift: complex) -> None:
        self.pencil, self.shift = pencil, shift
        self._inner = 1.0 / (pencil.state - shift)[:, None]
        self._driven = pencil.from_displacement + shift * pencil.from_velocity
        dynamic = pencil.stiffness + shift * pencil.damping + shift**2 * pencil.mass
        dynamic = dynamic - pencil.by_state @ (self._inner * self._driven)
        corner = np.zeros((len(pencil.held),) * 2)
        self._factors = scipy.linalg.lu_factor(np.block([[dynamic, -pencil.pushes.T], [pencil.held, corner]]))

    def started(self, values: Array, shapes: Array) -> Vectors:
        """Return the vectors of approximate exponents and shapes, without multipliers."""
        one = self.pencil
        moving = shapes * values
        rates = values - one.state[:, None]
        driven = one.from_velocity @ moving + one.from_displacement @ shapes
        # A state that no motion drives has its own rate as an exponent, with any amplitude.
        is_own = np.abs(rates) <= ROUND_OFF * np.abs(values)
        own = np.where(is_own, 1.0, driven / np.where(is_own, 1.0, rates))
        return shapes, moving, own, np.zeros((len(one.held), values.size))

    def right(self, vectors: Vectors) -> Vectors:
        """Return right vectors after an iteration."""
        one, (place, speed, own, _) = self.pencil, vectors
        force = one.mass @ (speed + self.shift * place) + one.damping @ place
        force = force + one.by_state @ (self._inner * (own - one.from_velocity @ place))
        solved = self._solved(-force, np.zeros((len(one.held), place.shape[1])), 0)
        moved, multipliers = np.split(solved, [len(place)])
        states = self._inner * (own - one.from_velocity @ place - self._driven @ moved)
        return moved, place + self.shift * moved, states, multipliers

    def left(self, vectors: Vectors) -> Vectors:
        """Return left vectors after an iteration."""
        one, (to_place, to_motion, to_states, _) = self.pencil, vectors
        force = to_place + self.shift * (one.mass.T @ to_motion) - self._driven.T @ (self._inner * to_states)
        solved = self._solved(force, np.zeros((len(one.held), to_place.shape[1])), 1)
        opposed, constraints = np.split(solved, [len(to_place)])
        motion = -opposed
        states = self._inner * (to_states + one.by_state.T @ motion)
        place = one.mass.T @ (to_motion + self.shift * motion) + one.damping.T @ motion - one.from_velocity.T @ states
        return place, motion, states, constraints

    def _solved(self, force: Array, values: Array, transposed: int) -> Array:
        return np.asarray(scipy.linalg.lu_solve(self._factors, np.vstack([force, values]), trans=transposed))


def _settled(iterate: Callable[[Vectors], Vectors], start: Vectors, scale: float) -> tuple[Vectors, Vectors]:
    """Return vectors of the subspace at which iterations settle, and these after an iteration."""
    now, closest = _normalised(iterate(_normalised(start, scale)), scale), np.inf
    for _ in range(PASSES):
        before, now = now, _normalised(iterate(now), scale)
        angle = _angle(before, now, scale)
        # Where rounding ends the approach, the angle begins to rise.
        if angle <= SETTLED * np.finfo(float).eps or (angle < ROUGH and angle >= closest):
            break
        closest = angle
    return now, iterate(now)


def _angle(before: Vectors, now: Vectors, scale: float) -> float:
    """Return the sine of the largest angle between two subspaces."""
    first, second = (np.vstack([scale * one[0], one[1]]) for one in (before, now))
    return float(np.linalg.norm(second - first @ (first.conj().T @ second), 2))


def _normalised(vectors: Vectors, scale: float) -> Vectors:
    """Return vectors as combinations whose first parts, times a scale, and second parts are orthonormal together."""
    first, second, *_ = vectors
    triangle = scipy.linalg.qr(np.vstack([scale * first, second]), mode="r")[0][: first.shape[1]]
    return _times(vectors, scipy.linalg.solve_triangular(triangle, np.eye(len(triangle))))


def _times(vectors: Vectors, matrix: Array) -> Vectors:
    first, second, third, fourth = vectors
    return first @ matrix, second @ matrix, third @ matrix, fourth @ matrix
