"""Lowest modes of sparse matrices, by Lanczos' method for blocks of vectors with the inverse about a shift.

A block finds modes of equal frequency together, and the factors solve for several vectors in half the time for each, as
they are read once for all (Golub & Underwood 1977; Grimes, Lewis & Simon 1994).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import Array
from ...long_tasks import check_wanted
from .factorisation import Solve

# Vectors in a block.
WIDTH = 4
# Most vectors of a search before it begins again beside the modes found: they take memory, and time by their square.
LONGEST = 400
# Relative residuals of a mode: one that still shows whether it lies beyond a limit, and one that is round-off. Length
# of a vector beside others that is round-off.
COARSE, SETTLED, LOST = 1e-2, 64.0 * float(np.finfo(float).eps), 1e-10


@dataclass(frozen=True)
class Inverse:
    """The inverse of ``K + s M`` on motions orthogonal to some known ones.

    Attributes
    ----------
    mass : scipy sparse, shape (n, n)
        Mass matrix M.
    solve : callable
        Solves with ``K + s M``.
    shift : float
        Shift s of squared frequencies [1/s²].
    known : ndarray, shape (n, known)
        Known motions, orthonormal in the mass.
    """

    mass: Any
    solve: Solve
    shift: float
    known: Array

    def beside(self, vectors: Array) -> Array:
        """Return the part of vectors that is orthogonal to the known motions."""
        for _ in range(2 if self.known.shape[1] else 0):
            vectors = vectors - self.known @ (self.known.T @ (self.mass @ vectors))
        return vectors


@dataclass(frozen=True)
class Found:
    """Modes of a search.

    Attributes
    ----------
    squared : ndarray, shape (count,)
        Squared angular frequencies, rising.
    shapes : ndarray, shape (n, modes)
        Mass-normalised shapes.
    following : ndarray, shape (n, width)
        Approximate shapes of the next modes.
    is_complete : bool
        Whether the next mode lies beyond the limit.
    """

    squared: Array
    shapes: Array
    following: Array
    is_complete: bool


def lowest(
    inverse: Inverse, start: Array, highest: float, least: int = 0, longest: int = LONGEST, tolerance: float = SETTLED
) -> Found:
    """Return the lowest modes up to a squared frequency, fewer if they are not found among the longest basis.

    Parameters
    ----------
    inverse : Inverse
        The inverse, whose known motions are left out.
    start : ndarray, shape (n, width)
        First block.
    highest : float
        Largest squared frequency [1/s²].
    least : int, optional
        Number of modes that are found also beyond it.
    longest : int, optional
        Number of vectors of the basis with which the search ends.
    tolerance : float, optional
        Relative residual of a mode that is found.
    """
    mass, width = inverse.mass, start.shape[1]
    size = len(start) - inverse.known.shape[1]
    stored = np.empty((len(start), min(size, longest) + 2 * width), order="F")
    block, _ = _orthonormal(mass, inverse.beside(start), stored[:, :0])
    # Rows and columns of the inverse between the vectors of all blocks.
    matrix = np.zeros((0, 0))
    while True:
        check_wanted()
        taken = len(matrix)
        stored[:, taken : taken + block.shape[1]] = block
        basis = stored[:, : taken + block.shape[1]]
        answer = inverse.beside(inverse.solve(mass @ block))
        columns = basis.T @ (mass @ answer)
        matrix = np.pad(matrix, (0, block.shape[1]))
        matrix[:, taken:], matrix[taken:] = columns, columns.T
        block, beyond = _orthonormal(mass, answer - basis @ columns, basis)
        values, vectors = np.linalg.eigh(matrix)
        values, vectors = values[::-1], vectors[:, ::-1]
        residual = np.linalg.norm(beyond @ vectors[taken:], axis=0)
        settled = residual <= tolerance * values
        count = int(np.argmin(np.append(settled, False)))
        # The next one need not be exact to lie beyond.
        passed = least <= count < len(values) and values[count] + residual[count] < 1.0 / (highest + inverse.shift)
        passed = passed and residual[count] <= COARSE * values[count]
        ended = not block.shape[1] or len(matrix) >= size
        if passed or ended or len(matrix) >= longest:
            break
    following = basis @ vectors[:, count : count + width]
    return Found(1.0 / values[:count] - inverse.shift, basis @ vectors[:, :count], following, bool(passed or ended))


def _orthonormal(mass: Any, vectors: Array, basis: Array) -> tuple[Array, Array]:
    """Return vectors of unit mass that span given ones beside a basis, and coordinates of the given ones on them.

    Directions that only rounding has are left out.
    """
    coordinates, total = np.eye(vectors.shape[1]), 0.0
    # Twice, since the first pass leaves the rounding of what it removes.
    for _ in range(2):
        moved = mass @ vectors
        total = total or float(np.sqrt(np.sum(vectors * moved, axis=0).max(initial=0.0)))
        vectors = vectors - basis @ (basis.T @ moved)
        product = vectors.T @ moved
        squared, turned = np.linalg.eigh(0.5 * (product + product.T))
        kept = squared > (LOST * total) ** 2
        sizes = np.sqrt(squared[kept])
        vectors = vectors @ (turned[:, kept] / sizes)
        coordinates = (sizes[:, None] * turned[:, kept].T) @ coordinates
        total = 1.0
    return vectors, coordinates
