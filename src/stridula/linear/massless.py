"""Small vibration of systems with residual shapes, which have stiffness and no mass.

Motions that contacts allow are split into those with mass, a, and those without, b. Without damping of b these follow
instantaneously, else they creep::

    M a'' + D_a a' + D_b b' + K_a a + K_b b + B z = 0    in rows with mass, without M in the others
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy.linalg

from ..arrays import Array
from .vibration import Exponents, Vibration

# Relative mass below which a motion counts as massless.
MASSLESS = 1e-9
# Damping of massless motions relative to their stiffness, at the highest frequency, that is due to rounding.
UNDAMPED = 1e-9
# Shift of the eigenvalue problem over the highest angular frequency.
BESIDE = 0.3
# Relative inverse of infinite exponents due to rounding.
ENDLESS = 1e-13


@dataclass(frozen=True)
class _Split:
    """Motions with mass, free rigid ones first, and without; likewise equations.

    Attributes
    ----------
    heavy, light : ndarray, shape (modes, motions)
        Bases of the motions.
    with_mass, without : ndarray, shape (modes, equations)
        Projections of the forces, free of the contact constraints.
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
    if _is_damped(motion, split):
        return _creeping(motion, split)
    first, followed = _first_order(motion, split)
    values, vectors = scipy.linalg.eig(first, check_finite=False, overwrite_a=True)
    chosen = values.imag >= 0.0
    values, vectors = values[chosen], vectors[:, chosen]
    elastic = split.heavy.shape[1] - split.rigid
    drift = vectors[elastic : elastic + split.rigid] / np.where(values == 0.0, 1.0, values)
    moved = np.concatenate([drift, vectors[:elastic]])
    return Exponents(values, split.heavy @ moved + split.light @ followed @ vectors)


def _split(motion: Vibration, scale: Array) -> _Split:
    """Return motions and equations split by mass; `scale` makes the coordinates comparable."""
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


def _is_damped(motion: Vibration, split: _Split) -> bool:
    """Return whether damping acts on motions without mass."""
    seen = np.abs(motion.damping @ split.light).max(initial=0.0) * np.abs(split.light).max(initial=0.0)
    stiff = np.abs(motion.stiffness @ split.light).max(initial=0.0) * np.abs(split.light).max(initial=0.0)
    return bool(seen * float(np.sqrt(np.abs(np.diag(motion.stiffness)).max(initial=0.0))) > UNDAMPED * stiff)


def _creeping(motion: Vibration, split: _Split) -> Exponents:
    """Return the exponents if damping acts on motions without mass, whose velocities then matter.

    The vector s has displacements along all motions with mass except free rigid ones, velocities along all, states, and
    motions without mass: ``left s' = right s``, singular if a motion without mass is undamped.
    """
    heavy, light, rigid = split.heavy, split.light, split.rigid
    bent, states = heavy[:, rigid:], len(motion.state)
    sizes = np.cumsum([0, bent.shape[1], heavy.shape[1], states, light.shape[1]])
    x, v, z, y = (slice(*pair) for pair in pairwise(sizes.tolist()))
    # In units of the inverse of the highest angular frequency, so that numbers are comparable.
    rate = float(np.sqrt(np.diag(motion.stiffness)[motion.mass > 0.0].max(initial=1.0)))
    stiffness, damping = motion.stiffness / rate**2, motion.damping / rate
    left, right = np.zeros((2, sizes[-1], sizes[-1]))
    left[x, x], right[x, sizes[1] + rigid : sizes[2]] = np.eye(bent.shape[1]), np.eye(bent.shape[1])
    for rows, test in ((v, split.with_mass), (y, split.without)):
        right[rows, x], right[rows, y] = -test.T @ stiffness @ bent, -test.T @ stiffness @ light
        right[rows, v], left[rows, y] = -test.T @ damping @ heavy, test.T @ damping @ light
        right[rows, z] = -test.T @ motion.by_state / rate**2
    left[v, v] = split.with_mass.T @ (motion.mass[:, None] * heavy)
    left[z, z], left[z, y] = np.eye(states), -motion.from_velocity @ light
    right[z, x], right[z, y] = motion.from_displacement @ bent / rate, motion.from_displacement @ light / rate
    right[z, v], right[z, z] = motion.from_velocity @ heavy, np.diag(motion.state) / rate
    # Inverse about a shift off the imaginary axis: infinite exponents are its zeros.
    inverse, vectors = scipy.linalg.eig(np.linalg.solve(right - BESIDE * left, left), check_finite=False)
    finite = np.abs(inverse) > ENDLESS * np.abs(inverse).max(initial=0.0)
    values, vectors = rate * (BESIDE + 1.0 / inverse[finite]), vectors[:, finite]
    chosen = values.imag >= 0.0
    values, vectors = values[chosen], vectors[:, chosen]
    drift = rate * vectors[sizes[1] : sizes[1] + rigid] / np.where(values == 0.0, 1.0, values)
    return Exponents(values, heavy @ np.concatenate([drift, vectors[x]]) + light @ vectors[y])


def _null(rows: Array) -> Array:
    """Return an orthonormal basis of the null space of independent rows."""
    return np.asarray(scipy.linalg.qr(rows.T)[0][:, len(rows) :])


def _first_order(motion: Vibration, split: _Split) -> tuple[Array, Array]:
    """Return the first-order matrix, and the matrix from its vector to motions without mass.

    Its vector has displacements along all motions with mass except free rigid ones, velocities along all, and states.
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
