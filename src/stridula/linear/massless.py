"""Small vibration of systems with residual shapes, which have stiffness and no mass.

Motions that contacts allow are split into those with mass, a, and those without, b. Without damping of b these follow
instantaneously, else they creep::

    M a'' + D_a a' + D_b b' + K_a a + K_b b + B z = 0    in rows with mass, without M in the others

Only as many of them creep as damping acts on: usually one for each contact, across its slip. The others are eliminated
as well, so that the eigenproblem does not grow with the number of residual shapes.
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
# Damping of massless motions relative to their stiffness, at the highest frequency, that counts as round-off.
UNDAMPED = 1e-9
# Shift of the eigenvalue problem, relative to the highest angular frequency.
BESIDE = 0.3
# An exponent counts as infinite if its inverse is below this, relative to the largest.
ENDLESS = 1e-13
# Damping of a motion without mass, relative to the largest one and to its stiffness, that counts as round-off.
CREEPS = 1e-12


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


def massless_exponents(motion: Vibration, shapes: bool = True) -> Exponents:
    """Return all exponents of a system with residual shapes, by a dense solver; shapes are empty if not wanted."""
    highest = float(np.sqrt(np.diag(motion.stiffness)[motion.mass > 0.0].max(initial=1.0)))
    split = _split(motion, np.where(motion.mass > 0.0, 1.0, highest))
    if _is_damped(motion, split):
        return _creeping(motion, split, shapes)
    first, followed = _first_order(motion, split)
    if not shapes:
        values = scipy.linalg.eigvals(first, check_finite=False, overwrite_a=True)
        return Exponents(values[values.imag >= 0.0], np.empty((len(motion.mass), 0)))
    values, vectors = scipy.linalg.eig(first, check_finite=False, overwrite_a=True)
    chosen = values.imag >= 0.0
    values, vectors = values[chosen], vectors[:, chosen]
    elastic = split.heavy.shape[1] - split.rigid
    drift = vectors[elastic : elastic + split.rigid] / np.where(values == 0.0, 1.0, values)
    moved = np.concatenate([drift, vectors[:elastic]])
    return Exponents(values, split.heavy @ moved + split.light @ (followed @ vectors))


def _split(motion: Vibration, scale: Array) -> _Split:
    """Return motions and equations split by mass; `scale` makes the coordinates comparable."""
    free, held, pushes = motion.free, motion.held * scale, motion.pushes * scale
    allowed = _null(held) if len(held) else np.eye(len(scale))
    balanced = _null(pushes) if len(pushes) else np.eye(len(scale))
    moving = motion.mass > 0.0
    left, sizes, right = _divided((balanced[moving].T * motion.mass[moving]).T, allowed[moving])
    heavy = int(np.sum(sizes > MASSLESS * sizes[0]))
    moves, light = allowed @ right[:, :heavy], allowed @ right[:, heavy:]
    # The same without the free rigid motions, up to their parts without mass.
    others = scipy.linalg.qr(moves.T @ free)[0][:, free.shape[1] :] if free.shape[1] else np.eye(heavy)
    rows, size = balanced @ left, scale[:, None]
    moves = np.hstack([free, moves @ others])
    return _Split(size * moves, size * light, size * rows[:, :heavy], size * rows[:, heavy:], free.shape[1])


def _divided(left: Array, right: Array) -> tuple[Array, Array, Array]:
    """Return the singular value decomposition of ``left^T right``, square, which has few rows between large sides.

    Columns of both square orthogonal matrices beyond the singular values belong to singular values of zero.
    """
    few = len(left)
    if few >= min(left.shape[1], right.shape[1]):
        turned, sizes, others = np.linalg.svd(left.T @ right)
        return turned, sizes, others.T
    (rows, first), (columns, second) = scipy.linalg.qr(left.T), scipy.linalg.qr(right.T)
    turned, sizes, others = np.linalg.svd(first[:few] @ second[:few].T)
    rows[:, :few], columns[:, :few] = rows[:, :few] @ turned, columns[:, :few] @ others.T
    return rows, sizes, columns


def _is_damped(motion: Vibration, split: _Split) -> bool:
    """Return whether damping acts on motions without mass."""
    if not motion.damping.any() or not split.light.size:
        return False
    seen = np.abs(motion.damping @ split.light).max(initial=0.0) * np.abs(split.light).max(initial=0.0)
    stiff = np.abs(motion.stiffness @ split.light).max(initial=0.0) * np.abs(split.light).max(initial=0.0)
    return bool(seen * float(np.sqrt(np.abs(np.diag(motion.stiffness)).max(initial=0.0))) > UNDAMPED * stiff)


def _creeping(motion: Vibration, split: _Split, shapes: bool = True) -> Exponents:
    """Return the exponents if damping acts on motions without mass, whose velocities then matter.

    The vector s has displacements along all motions with mass except free rigid ones, velocities along all, states, and
    motions without mass that are damped; the others follow: ``left s' = right s``.
    """
    # The unit of time is the inverse of the highest angular frequency, so that numbers are comparable.
    rate = float(np.sqrt(np.diag(motion.stiffness)[motion.mass > 0.0].max(initial=1.0)))
    stiffness, damping, by_state = motion.stiffness / rate**2, motion.damping / rate, motion.by_state / rate**2
    heavy, rigid, states = split.heavy, split.rigid, len(motion.state)
    damped, still, creeping, following = _by_damping(split, damping)
    bent = heavy[:, rigid:]
    sizes = np.cumsum([0, bent.shape[1], heavy.shape[1], states, damped.shape[1]])
    x, v, z, y = (slice(*pair) for pair in pairwise(sizes.tolist()))
    # Displacements are `placed s`, without free rigid motions; velocities are `moving s' + speed s`.
    placed, moving, speed = np.zeros((3, len(heavy), sizes[-1]))
    placed[:, x], placed[:, y], speed[:, v] = bent, damped, heavy
    pulls = stiffness @ placed + damping @ speed
    pulls[:, z] += by_state
    if still.shape[1]:
        stiff = stiffness @ still
        follows = -np.linalg.solve(following.T @ stiff, following.T @ pulls)
        placed += still @ follows
        pulls += stiff @ follows
        moving = still @ follows
    moving[:, y] += damped
    braked = damping @ moving
    left, right = np.zeros((2, sizes[-1], sizes[-1]))
    left[x, x], right[x, sizes[1] + rigid : sizes[2]] = np.eye(bent.shape[1]), np.eye(bent.shape[1])
    for rows, test in ((v, split.with_mass), (y, creeping)):
        right[rows], left[rows] = -test.T @ pulls, test.T @ braked
    left[v, v] += split.with_mass.T @ (motion.mass[:, None] * heavy)
    left[z] = -motion.from_velocity @ moving
    left[z, z] += np.eye(states)
    right[z] = motion.from_displacement @ placed / rate + motion.from_velocity @ speed
    right[z, z] += np.diag(motion.state) / rate
    # Inverse about a shift off the imaginary axis: infinite exponents are its zeros.
    inverse = np.linalg.solve(right - BESIDE * left, left)
    if not shapes:
        inverse, vectors = scipy.linalg.eigvals(inverse, check_finite=False), np.empty((sizes[-1], 0))
    else:
        inverse, vectors = scipy.linalg.eig(inverse, check_finite=False)
    finite = np.abs(inverse) > ENDLESS * np.abs(inverse).max(initial=0.0)
    values = rate * (BESIDE + 1.0 / inverse[finite])
    chosen = values.imag >= 0.0
    values = values[chosen]
    if not shapes:
        return Exponents(values, np.empty((len(heavy), 0)))
    vectors = vectors[:, finite][:, chosen]
    drift = rate * vectors[sizes[1] : sizes[1] + rigid] / np.where(values == 0.0, 1.0, values)
    return Exponents(values, heavy[:, :rigid] @ drift + placed @ vectors)


def _by_damping(split: _Split, damping: Array) -> tuple[Array, Array, Array, Array]:
    """Return the motions without mass that are damped and those that are not, and the equations of both.

    Damping of motions without mass acts on the first ones and in their equations only.
    """
    matrix = split.without.T @ (damping @ split.light)
    rows, triangle, order = scipy.linalg.qr(matrix, pivoting=True)
    size = np.abs(np.diag(triangle))
    count = int(np.sum(size > CREEPS * max(size.max(initial=0.0), 1.0)))
    kept = np.empty((count, len(matrix)))
    kept[:, order] = triangle[:count]
    columns = scipy.linalg.qr(kept.T)[0]
    light, without = split.light @ columns, split.without @ rows
    return light[:, :count], light[:, count:], without[:, :count], without[:, count:]


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
