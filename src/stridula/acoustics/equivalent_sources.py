"""Sources within a body whose sound moves the air at its surface as the body does.

Wave superposition (Koopmann, Song & Fahnline 1989, J. Acoust. Soc. Am. 86, 2433-2438): the sound of a body is the
field of any sources within it whose field has the body's normal acceleration a all over the surface,
``dp/dn = -rho a``. The strengths follow from least squares with Tikhonov regularisation, as those of deep sources
would otherwise grow without bound. Every other source lies deeper: sources on a single surface cannot produce all
fields at the frequencies at which the inside of that surface resonates.
"""

from __future__ import annotations

from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np
import scipy.linalg

from ..arrays import Array

# Regularisation: fraction of the largest singular value of the matrix with columns of unit length.
HELD_BACK = 1e-7
# Largest depth of sources over the distance to their neighbours and over the radius of the ball within the body, and
# factor by which every other one is deeper.
DEPTH_OF_SPACING, DEPTH_OF_BALL, DEEPER = 1.5, 0.6, 1.2


class Radiator(Protocol):
    """A body as its equivalent sources."""

    error_in: ClassVar[str]

    @property
    def surface(self) -> Any:
        """Its surface."""

    @property
    def size(self) -> float:
        """Largest extent of the body [m]."""

    def fit(self, wavenumber: float) -> Fit:
        """Return the strengths of the sources at a wavenumber of the sound [rad/m]."""

    def heard(self, fit: Fit, wavenumber: float, places: Array) -> Array:
        """Return the pressures at places (listeners, 3) [m] for unit modal accelerations, shape (listeners, modes).

        Complex, to be multiplied by the density of the air [kg/m³] and by ``exp(i w t)``.
        """


class Fit(NamedTuple):
    """Strengths of sources.

    Attributes
    ----------
    strengths : tuple of ndarray
        Strengths of the sources for each mode, in the form of the radiator.
    errors : ndarray, shape (modes,)
        Relative errors: of the normal motion over the surface, or for sheets of the force of the air on the mode.
    """

    strengths: tuple[Array, ...]
    errors: Array


def depths(spacing: Array, ball: Array) -> Array:
    """Return the depths of sources below the surface [m], from their spacing and the radii of inscribed balls [m]."""
    deeper = np.where(np.arange(len(spacing)) % 2, DEEPER, 1.0)
    return np.asarray(deeper * np.minimum(DEPTH_OF_SPACING * spacing, DEPTH_OF_BALL * ball))


def least_squares(matrix: Array, wanted: Array, held_back: float = 0.0) -> Array:
    """Return the least-squares solution of equations, by normal equations, for several right-hand sides.

    Parameters
    ----------
    matrix : ndarray of complex, shape (equations, unknowns)
        The equations.
    wanted : ndarray, shape (equations, sides)
        The right-hand sides.
    held_back : float, optional
        Tikhonov regularisation, about a fraction of the largest singular value.

    Returns
    -------
    ndarray, shape (unknowns, sides)
        In the precision of the matrix.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the equations do not determine the unknowns in double precision.
    """
    try:
        return _by_normal_equations(matrix, wanted, held_back)
    except np.linalg.LinAlgError:
        if matrix.dtype != np.complex64:
            raise
        # Normal equations square the condition: above some thousands, the seven digits of single precision are lost.
        return _by_normal_equations(matrix.astype(complex), wanted, held_back).astype(matrix.dtype)


def _by_normal_equations(matrix: Array, wanted: Array, held_back: float) -> Array:
    """Return the least-squares solution of equations, by Cholesky factors of their normal equations."""
    solve = scipy.linalg.cho_solve
    # In real numbers, as products of a matrix with itself take half the time and let other threads run.
    parts = np.concatenate([matrix.real, matrix.imag])
    real, mixed = parts.T @ parts, parts[: len(matrix)].T @ parts[len(matrix) :]
    square = real + 1j * (mixed - mixed.T)
    largest = float(np.abs(square).sum(axis=0).max())
    square[np.diag_indices_from(square)] += held_back**2 * largest
    factor = scipy.linalg.cho_factor(square, lower=True, overwrite_a=True, check_finite=False)
    adjoint, wanted = matrix.conj().T, wanted.astype(matrix.dtype)
    found = solve(factor, adjoint @ wanted, check_finite=False)
    if not held_back:
        # The normal equations square the condition of the matrix; one refinement restores the accuracy.
        found += solve(factor, adjoint @ (wanted - matrix @ found), check_finite=False)
    return np.asarray(found)


def fitted(matrix: Array, wanted: Array, areas: Array, spacing: Array) -> tuple[Array, Array]:
    """Return the strengths that fit the wanted values in least squares, and the remaining errors.

    Squares are weighted by the areas and by the spacing of the points, which falls towards edges: there the velocity
    of the air is unbounded, and its error would otherwise spread over the whole surface.

    Parameters
    ----------
    matrix : ndarray, shape (points, sources)
        Value of each source of unit strength at the points.
    wanted : ndarray, shape (points, modes)
        Values wanted there.
    areas, spacing : ndarray, shape (points,)
        Areas of the points, and distances between them, each up to a constant factor.

    Returns
    -------
    strengths : ndarray, shape (sources, modes)
        The strengths.
    errors : ndarray, shape (modes,)
        Weighted root mean square of the residual over that of the wanted values; 0 where these are zero.
    """
    weights = np.sqrt(areas * spacing)[:, None]
    rows, aims = matrix * weights, wanted * weights
    sizes = np.linalg.norm(rows, axis=0)
    # The fields of rings very close to the axis vanish for waves round it.
    sizes = np.where(sizes > 0.0, sizes, 1.0)
    rows = rows / sizes
    strengths = least_squares(rows, aims, HELD_BACK) / sizes[:, None]
    size = np.linalg.norm(aims, axis=0)
    errors = np.linalg.norm(weights * (matrix @ strengths - wanted), axis=0) / np.where(size > 0.0, size, 1.0)
    return strengths, np.where(size > 0.0, errors, 0.0)
