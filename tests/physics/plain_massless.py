"""Exponents of systems with residual shapes in the plain form: every motion without mass keeps its own equation."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import scipy.linalg


def split(motion):
    """Motions with mass, free rigid ones first, and without; projections of the forces onto both."""
    highest = np.sqrt(np.diag(motion.stiffness)[motion.mass > 0.0].max(initial=1.0))
    scale = np.where(motion.mass > 0.0, 1.0, highest)
    held, pushes = motion.held * scale, motion.pushes * scale
    allowed = scipy.linalg.null_space(held) if len(held) else np.eye(len(scale))
    balanced = scipy.linalg.null_space(pushes) if len(pushes) else np.eye(len(scale))
    left, sizes, right = np.linalg.svd((balanced.T * motion.mass) @ allowed)
    heavy = int(np.sum(sizes > 1e-9 * sizes[0]))
    light = allowed @ right[heavy:].T
    taken = scipy.linalg.orth(np.hstack([motion.free, light]))
    others = allowed - taken @ (taken.T @ allowed)
    basis = np.linalg.svd(others, full_matrices=False)[0][:, : heavy - motion.free.shape[1]]
    rows = scale[:, None] * (balanced @ left)
    moves = scale[:, None] * np.hstack([motion.free, basis])
    return moves, scale[:, None] * light, rows[:, :heavy], rows[:, heavy:]


def exponents(motion) -> np.ndarray:
    """All finite exponents, those of conjugate pairs once."""
    heavy, light, with_mass, without = split(motion)
    rate = np.sqrt(np.diag(motion.stiffness)[motion.mass > 0.0].max(initial=1.0))
    stiffness, damping, rigid = motion.stiffness / rate**2, motion.damping / rate, motion.free.shape[1]
    bent, states = heavy[:, rigid:], len(motion.state)
    ends = np.cumsum([0, bent.shape[1], heavy.shape[1], states, light.shape[1]])
    x, v, z, y = (slice(*pair) for pair in pairwise(ends.tolist()))
    left, right = np.zeros((2, ends[-1], ends[-1]))
    left[x, x], right[x, ends[1] + rigid : ends[2]] = np.eye(bent.shape[1]), np.eye(bent.shape[1])
    for rows, test in ((v, with_mass), (y, without)):
        right[rows, x], right[rows, y] = -test.T @ stiffness @ bent, -test.T @ stiffness @ light
        right[rows, v], left[rows, y] = -test.T @ damping @ heavy, test.T @ damping @ light
        right[rows, z] = -test.T @ motion.by_state / rate**2
    left[v, v] = with_mass.T @ (motion.mass[:, None] * heavy)
    left[z, z], left[z, y] = np.eye(states), -motion.from_velocity @ light
    right[z, x], right[z, y] = motion.from_displacement @ bent / rate, motion.from_displacement @ light / rate
    right[z, v], right[z, z] = motion.from_velocity @ heavy, np.diag(motion.state) / rate
    inverse = scipy.linalg.eigvals(np.linalg.solve(right - 0.3 * left, left))
    inverse = inverse[np.abs(inverse) > 1e-13 * np.abs(inverse).max()]
    values = rate * (0.3 + 1.0 / inverse)
    return values[values.imag >= 0.0]
