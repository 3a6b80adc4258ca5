"""Static response of bodies to forces on their contacts, with rigid motions."""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dgetrf, dgetrs

from ..arrays import Array
from .structure import UNMOVED, Structure


class Response:
    """Static response of the bodies of a system, computed once for all sets of contacts.

    A modal force f gives ``q = C f + (R - C K R) c`` and accelerations ``a = L f - E c`` of the rigid motions R, whose
    places c are those that contacts hold::

        K q + R a = f,    R^T (q - R c) = 0

    Parameters
    ----------
    structure : Structure
        The system.

    Attributes
    ----------
    rows : ndarray, shape (3 contacts, modes)
        Contacts along their normals, their tangents, and across them.
    compliance : ndarray, shape (3 contacts, 3 contacts)
        Displacements along `rows` by unit forces along them.
    pull : ndarray, shape (rigid, 3 contacts)
        Accelerations of rigid motions by unit forces along `rows`.
    felt : ndarray, shape (3 contacts, rigid)
        Displacements along `rows` by rigid motions alone.
    moved : ndarray, shape (3 contacts, rigid)
        The same with the deformation by forces that rigid motions cause, as on bodies that turn.
    motions, opposed : ndarray, shapes (modes, rigid) and (rigid, rigid)
        Displacements ``R - C K R`` and decelerations E by rigid motions.
    """

    def __init__(self, structure: Structure) -> None:
        lines, rigid, size = structure.lines, structure.rigid, structure.mode_count
        words = ("normal", "tangent", "across")
        self.rows = np.array([getattr(line, word) for word in words for line in lines]).reshape(-1, size)
        matrix = np.zeros((size + rigid.shape[1],) * 2)
        matrix[:size, :size], matrix[:size, size:], matrix[size:, :size] = structure.stiffness, rigid, rigid.T
        self._scale = np.sqrt(np.maximum(np.abs(np.diag(matrix)), 1.0))
        self._factors = Factors(matrix / np.outer(self._scale, self._scale))
        self._size = size
        moved, self.pull = self.to(self.rows.T)
        self.compliance = self.rows @ moved
        self._sizes = np.abs(self.rows[: len(lines)])
        self._terms = self._sizes @ np.abs(moved)
        bent, self.opposed = self.to(structure.stiffness @ rigid)
        self.motions = rigid - bent
        felt = self.rows @ rigid
        least = UNMOVED * np.linalg.norm(self.rows, axis=1, keepdims=True)
        self.felt = np.where(np.abs(felt) < least, 0.0, felt)
        self.moved = self.felt - self.rows @ bent

    def to(self, force: Array) -> tuple[Array, Array]:
        """Return displacements ``C f`` and accelerations ``L f`` of rigid motions by modal forces, (modes, ...)."""
        right = np.zeros((len(self._scale), *force.shape[1:]))
        right[: self._size] = force
        scale = self._scale.reshape((-1,) + (1,) * (force.ndim - 1))
        found = self._factors.solved(right / scale) / scale
        return found[: self._size], found[self._size :]

    def terms(self, displacement: Array, forces: Array) -> Array:
        """Return the sizes of the modal terms of openings, from which their rounding follows [m], shape (contacts,).

        Parameters
        ----------
        displacement : ndarray, shape (modes,)
            Modal displacements by the loads.
        forces : ndarray, shape (3 contacts,)
            Contact forces along `rows`.
        """
        return np.asarray(self._sizes @ np.abs(displacement) + self._terms @ np.abs(forces))


class Factors:
    """The LU factors of a square matrix, and the sign of its determinant, 0 if it is singular."""

    def __init__(self, matrix: Array) -> None:
        self._factors: Array
        self._pivots: Array
        self._factors, self._pivots, _ = dgetrf(matrix) if matrix.size else (matrix, np.zeros(0, np.int32), 0)
        swaps = int(np.count_nonzero(self._pivots != np.arange(len(matrix))))
        self.sign = float(np.prod(np.sign(np.diag(self._factors))) * (-1.0) ** swaps)

    def solved(self, right: Array) -> Array:
        """Return the solution for right-hand sides, NaN if the matrix is singular."""
        if not self.sign:
            return np.full(right.shape, np.nan)
        return np.asarray(dgetrs(self._factors, self._pivots, right)[0]) if right.size else right
