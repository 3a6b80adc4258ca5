"""Small vibration of systems with residual shapes, which have stiffness and no mass.

Motions that contacts allow split into those with mass, a, and those without, b, which no damping and no slope of
friction sees. They follow at once::

    M a'' + D a' + K_a a + K_b b + B z = 0    in rows with mass, without M in the others
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ..arrays import Array
from .vibration import Exponents, Vibration

# Relative mass below which a motion has none.
MASSLESS = 1e-9


@dataclass(frozen=True)
class _Split:
    """Motions with mass, free rigid ones first, and without; equations with mass and without.

    Attributes
    ----------
    heavy, light : ndarray, shape (modes, motions)
        Bases of the motions.
    with_mass, without : ndarray, shape (modes, equations)
        What the forces are projected on: nothing that the contacts hold has a share.
    rigid : int
        Number of free rigid motions.
    """

    heavy: Array
    light: Array
    with_mass: Array
    without: Array
    rigid: int


def massless_exponents(motion: Vibration) -> Exponents:
    """Return all exponents of a system with residual shapes, by a dense solver."""
    highest = float(np.sqrt(np.diag(motion.stiffness)[motion.mass > 0.0].max(initial=1.0)))
    split = _split(motion, np.where(motion.mass > 0.0, 1.0, highest))
    first, followed = _first_order(motion, split)
    values, vectors = scipy.linalg.eig(first, check_finite=False, overwrite_a=True)
    chosen = values.imag >= 0.0
    values, vectors = values[chosen], vectors[:, chosen]
    elastic = split.heavy.shape[1] - split.rigid
    drift = vectors[elastic : elastic + split.rigid] / np.where(values == 0.0, 1.0, values)
    moved = np.concatenate([drift, vectors[:elastic]])
    return Exponents(values, split.heavy @ moved + split.light @ followed @ vectors)


def _split(motion: Vibration, scale: Array) -> _Split:
    """Return motions and equations split by mass; with `scale` the coordinates are of one size."""
    free, held, pushes = motion.free, motion.held * scale, motion.pushes * scale
    allowed = _null(held) if len(held) else np.eye(len(scale))
    balanced = _null(pushes) if len(pushes) else np.eye(len(scale))
    left, sizes, right = np.linalg.svd((balanced.T * motion.mass) @ allowed)
    heavy = int(np.sum(sizes > MASSLESS * sizes[0]))
    light = allowed @ right[heavy:].T
    taken = scipy.linalg.orth(np.hstack([free, light])) if free.shape[1] or light.shape[1] else free
    others = allowed - taken @ (taken.T @ allowed)
    basis = np.linalg.svd(others, full_matrices=False)[0][:, : heavy - free.shape[1]]
    moves, rows, size = np.hstack([free, basis]), balanced @ left, scale[:, None]
    return _Split(size * moves, size * light, size * rows[:, :heavy], size * rows[:, heavy:], free.shape[1])


def _null(rows: Array) -> Array:
    """Return a basis of what independent rows do not feel, orthonormal."""
    return np.asarray(scipy.linalg.qr(rows.T)[0][:, len(rows) :])


def _first_order(motion: Vibration, split: _Split) -> tuple[Array, Array]:
    """Return the matrix of first order, and how motions without mass follow what it moves.

    It moves displacements along all motions with mass but the free rigid ones, velocities along all, and states.
    """
    heavy, rigid = split.heavy, split.rigid
    elastic, speeds, states = heavy.shape[1] - rigid, heavy.shape[1], len(motion.state)
    pulls = np.hstack([motion.stiffness @ heavy[:, rigid:], motion.damping @ heavy, motion.by_state])
    followed = -np.linalg.solve(split.without.T @ motion.stiffness @ split.light, split.without.T @ pulls)
    mass = split.with_mass.T @ (motion.mass[:, None] * heavy)
    first = np.zeros((elastic + speeds + states,) * 2)
    velocities, own = slice(elastic, elastic + speeds), slice(elastic + speeds, None)
    first[:elastic, elastic + rigid : elastic + speeds] = np.eye(elastic)
    pulls = split.with_mass.T @ (pulls + motion.stiffness @ split.light @ followed)
    first[velocities] = -np.linalg.solve(mass, pulls)
    first[own, velocities] = motion.from_velocity @ heavy
    first[own, :elastic] = motion.from_displacement @ heavy[:, rigid:]
    first[own, own] = np.diag(motion.state)
    first[own] += motion.from_displacement @ split.light @ followed
    return first, followed
