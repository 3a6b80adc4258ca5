"""Accelerations of modes that springs, dashpots and damping matrices couple.

With mass-normalised modes of the stiffness, at angular frequencies w, and the damping matrix D between them, the states
``w q`` and ``q'`` follow

    (w q)' = w q',    (q')' = -w (w q) - D q' + f.

Each eigenvalue s of this system adds ``v (i w) / (i w - s) (u f)`` to the accelerations, with the lower halves v and u
of its right and left eigenvectors. Two eigenvalues, a conjugate pair or two real ones, have the poles of an oscillator,
whose acceleration a and velocity b under u f give the part of the first one, ``v (a - s' b)``, s' being the other one.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg

from ..arrays import Array
from .driven import FASTEST, Modes, respond

# Off-diagonal damping, over that of the two modes, below which it is rounding.
ROUND_OFF = 1e-12
# Condition of eigenvectors above which two have merged, as of a critically damped mode, and the relative change of the
# damping that parts them.
DEFECTIVE, APART = 1e6, 1e-7
# Samples ahead and back from which accelerations are computed.
DEGREE = 8


def coupled_response(stiffness: Array, dissipation: Array, forces: Array, interval: float) -> tuple[Array, int]:
    """Return the accelerations of coupled modes under impulses ``interval * forces``, and the number left out.

    Parameters
    ----------
    stiffness, dissipation : ndarray, shape (modes, modes)
        Stiffness [1/s²] and damping matrix [1/s] of mass-normalised coordinates.
    forces : ndarray, shape (modes, samples)
        Forces on them [N kg^(-1/2)].
    interval : float
        Sample interval [s].

    Returns
    -------
    accelerations : ndarray, shape (modes, samples)
        Accelerations [m kg^(1/2) / s²].
    left_out : int
        Number of modes of the coupled system that are too fast for the samples, and left out.
    """
    squared, shapes = scipy.linalg.eigh(stiffness)
    angular, damping = np.sqrt(np.maximum(squared, 0.0)), shapes.T @ dissipation @ shapes
    on_modes = shapes.T @ forces
    found = np.zeros_like(on_modes)
    alone = ~_mixed(damping)
    kept = alone & (angular * interval < FASTEST)
    found[kept] = respond(Modes(angular[kept], np.diag(damping)[kept]), on_modes[kept], interval)
    left_out = int((alone & ~kept).sum())
    if not alone.all():
        among = np.ix_(~alone, ~alone)
        found[~alone], fast = _mixed_response(angular[~alone], damping[among], on_modes[~alone], interval)
        left_out += fast
    return shapes @ found, left_out


def _mixed(damping: Array) -> Array:
    """Return a mask of the modes whose damping couples them to others."""
    scale = np.sqrt(np.outer(np.diag(damping), np.diag(damping)))
    across = np.abs(damping - np.diag(np.diag(damping)))
    return np.asarray((across > ROUND_OFF * scale).any(axis=1))


def _mixed_response(angular: Array, damping: Array, forces: Array, interval: float) -> tuple[Array, int]:
    """Return the accelerations of modes of the stiffness that damping couples, and the number of pairs left out."""
    values, right, left = _eigenvectors(angular, damping)
    rising = np.flatnonzero(values.imag > 0.0)
    kept = rising[values.imag[rising] * interval < FASTEST]
    found = np.zeros_like(forces)
    poles = values[kept]
    modes = Modes(np.abs(poles), -2.0 * poles.real)
    for part, factor in ((left[kept].real, 1.0), (left[kept].imag, 1j)):
        change, speed = (respond(modes, part @ forces, interval, derivative, DEGREE) for derivative in (2, 1))
        found += 2.0 * (factor * right[:, kept] @ (change - poles.conj()[:, None] * speed)).real
    still = np.flatnonzero(values.imag == 0.0)
    still = still[np.argsort(values.real[still])]
    first, second = still[::2], still[1::2]
    modes = Modes(
        np.sqrt(np.maximum((values[first] * values[second]).real, 0.0)), -(values[first] + values[second]).real
    )
    for one, other in ((first, second), (second, first)):
        change, speed = (respond(modes, left[one].real @ forces, interval, derivative, DEGREE) for derivative in (2, 1))
        found += right[:, one].real @ (change - values[other].real[:, None] * speed)
    return found, int(rising.size - kept.size)


def _eigenvectors(angular: Array, damping: Array) -> tuple[Array, Array, Array]:
    """Return the eigenvalues [1/s] of damped modes, and the lower halves of their right and left eigenvectors."""
    size = angular.size
    for change in (0.0, APART):
        lower = np.hstack([-np.diag(angular), -(1.0 + change) * damping])
        values, right = scipy.linalg.eig(np.vstack([np.eye(size, 2 * size, size) * angular[:, None], lower]))
        if np.linalg.cond(right) < DEFECTIVE:
            break
    return values, right[size:], np.linalg.inv(right)[:, size:]
