"""Rigid joints: coordinates of joined bodies in which they move only together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from ..arrays import Array

# Relative singular value below which a row of a joint repeats others, or a motion does not strain a body.
SAME = 1e-10
# Size of a row relative to the longest that is round-off.
NOTHING = 1e-12


@dataclass(frozen=True)
class JointModes:
    """Natural modes of bodies under rigid joints, as coordinates in place of those of the bodies.

    There are as many coordinates as before: first the modes, then residual shapes, then as many that move nothing as
    joints prevent motions.

    Attributes
    ----------
    blend : ndarray, shape (coordinates, coordinates)
        Coordinates of the bodies for units of these.
    squared : ndarray, shape (modes,)
        Squared angular frequencies of the modes [1/s²], zero for rigid motions.
    shapes : int
        Number of residual shapes.
    """

    blend: Array
    squared: Array
    shapes: int

    @property
    def massless(self) -> Array:
        """Mask of the coordinates without mass."""
        return np.arange(len(self.blend)) >= self.squared.size

    @property
    def stiffness(self) -> Array:
        """Stiffness of each coordinate [1/s²]: one for a residual shape, zero for what moves nothing."""
        found = np.zeros(len(self.blend))
        found[: self.squared.size] = self.squared
        found[self.squared.size : self.squared.size + self.shapes] = 1.0
        return found


def joint_modes(rows: Array, squared: Array, massless: Array) -> JointModes:
    """Return the natural modes of bodies under rigid joints.

    Residual shapes yield first: those that the joints strain follow the modes at once.

    Parameters
    ----------
    rows : ndarray, shape (motions, coordinates)
        Motions that the joints prevent, for units of the coordinates of the bodies.
    squared : ndarray, shape (coordinates,)
        Squared angular frequencies of the coordinates [1/s²]; of residual shapes not used.
    massless : ndarray of bool, shape (coordinates,)
        Mask of the residual shapes, of unit stiffness.
    """
    rows = _unit_rows(rows, NOTHING * np.linalg.norm(rows, axis=1).max())
    moving, shapes = np.flatnonzero(~massless), np.flatnonzero(massless)
    left, size, right = scipy.linalg.svd(rows[:, shapes], full_matrices=True)
    strained = int(np.sum(size > SAME))
    free = _null_space(_unit_rows(left[:, strained:].T @ rows[:, moving], SAME))
    follow = -left[:, :strained].T @ rows[:, moving] / size[:strained, None]
    follow = right[:strained].T @ follow @ free
    values, turned = _natural(free, follow, squared[moving])
    blend = np.zeros((len(squared), len(squared)))
    modes, kept = values.size, len(shapes) - strained
    blend[np.ix_(moving, np.arange(modes))] = free @ turned
    blend[np.ix_(shapes, np.arange(modes))] = follow @ turned
    blend[np.ix_(shapes, np.arange(modes, modes + kept))] = right[strained:].T
    return JointModes(blend, values, kept)


def _natural(free: Array, follow: Array, squared: Array) -> tuple[Array, Array]:
    """Return the squared angular frequencies of free motions and their shapes, those of rigid ones exactly zero."""
    strains = np.vstack([free[squared > 0.0], follow])
    rigid = _null_space(_unit_rows(strains, SAME))
    others = _null_space(rigid.T)
    moved, felt = free @ others, follow @ others
    stiffness = (moved.T * squared) @ moved + felt.T @ felt
    values, shapes = np.linalg.eigh(0.5 * (stiffness + stiffness.T))
    return np.concatenate([np.zeros(rigid.shape[1]), values]), np.hstack([rigid, others @ shapes])


def _null_space(rows: Array) -> Array:
    """Return orthonormal columns that rows of length 1 do not feel."""
    return np.asarray(scipy.linalg.null_space(rows, rcond=SAME)) if len(rows) else np.eye(rows.shape[1])


def _unit_rows(rows: Array, least: float) -> Array:
    """Return the rows longer than `least`, each of length 1."""
    length = np.linalg.norm(rows, axis=1)
    kept = length > least
    return np.asarray(rows[kept] / length[kept, None])
