"""Reduction of matrices to mass-normalised modes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg

from ...arrays import Array
from ...checks import ArgumentError, at_least, at_most
from ..damping import damping_rates
from ..matrix_input import ROUND_OFF, smallest_eigenvalue
from ..modes import Modes

COUPLING = 1e-10
# Relative singular value of a residual shape below which it is round-off.
RESIDUAL = 1e-8
# Relative size of a sum below which it is round-off.
ROUNDING = 1e-10


@dataclass(frozen=True)
class Reduction:
    """Modes of a body and their shapes.

    Attributes
    ----------
    modes : Modes
        The modes, residual shapes last.
    shapes : ndarray, shape (n, modes)
        Their shapes on the degrees of freedom.
    """

    modes: Modes
    shapes: Array


def reduce_body(body: Any) -> Reduction:
    """Return the modes of a `ReducedBody` and their shapes."""
    angular, shapes = _all_modes(body)
    kept = np.full(angular.size, True) if body.cutoff is None else angular <= 2.0 * np.pi * body.cutoff
    if not kept.any():
        first = angular[0] / (2.0 * np.pi)
        raise ArgumentError(
            "cutoff", f"leave at least one mode (first at {at_least(first)} Hz)", body.cutoff, got=f"{body.cutoff!r} Hz"
        )
    rates, matrix = damping_in_modes(body.damping, angular, shapes, kept)
    residual = np.zeros((len(shapes), 0))
    if body.residual_flexibility and not kept.all():
        residual = _residual_shapes(body, angular[~kept], shapes[:, ~kept])
    return reduction_of(body, angular[kept], shapes[:, kept], residual, rates, matrix)


def reduction_of(
    body: Any, angular: Array, shapes: Array, residual: Array, rates: Array, matrix: Array | None
) -> Reduction:
    """Return the modes of a body and its residual shapes, with the damping of the modes."""
    count = residual.shape[1]
    angular, rates = np.append(angular, np.full(count, np.inf)), np.append(rates, np.zeros(count))
    shapes = np.hstack([shapes, residual])
    shapes.flags.writeable = False
    matrix = None if matrix is None else np.pad(matrix, (0, count))
    translation = np.zeros((len(next(iter(body.points.values()))), angular.size))
    if body.translation is not None:
        translation = body.translation @ body.mass @ shapes
    return Reduction(Modes(angular, rates, translation, matrix), shapes)


def _residual_shapes(body: Any, angular: Array, shapes: Array) -> Array:
    """Return the static responses of the modes left out to forces at the points and to gravity, shape (n, shapes).

    They are orthonormal in the stiffness, so that ``Psi Psi^T`` is the flexibility of the modes left out wherever
    these forces act (MacNeal 1971).
    """
    forces = list(body.points.values())
    if body.translation is not None:
        forces.append(body.translation @ body.mass)
    pushes = np.concatenate(forces)
    answers = (pushes @ shapes / angular).T
    sizes = np.linalg.norm(answers, axis=0)
    # Gravity moves a free body as a whole: the response of the modes left out is pure rounding.
    felt = sizes > ROUNDING * np.linalg.norm(np.abs(pushes) @ np.abs(shapes) / angular, axis=1)
    if not felt.any():
        return np.zeros((len(shapes), 0))
    answers = answers[:, felt] / sizes[felt]
    basis, share, _ = scipy.linalg.svd(answers, full_matrices=False)
    return np.asarray(shapes / angular @ basis[:, share > RESIDUAL * share[0]])


def _all_modes(body: Any) -> tuple[Array, Array]:
    """Return the angular frequencies, rising, and the mass-normalised shapes."""
    # Scaled to a unit diagonal, so that rotations and translations have the same weight in rounding errors.
    scale = 1.0 / np.sqrt(np.diag(body.mass))
    both = np.outer(scale, scale)
    with np.errstate(over="ignore", invalid="ignore"):
        mass, stiffness = body.mass * both, body.stiffness * both
    if not (np.isfinite(mass).all() and np.isfinite(stiffness).all()):
        raise ArgumentError(
            "stiffness",
            "be of an ordinary size relative to mass",
            got=(
                f"up to {np.abs(body.stiffness).max():.6g} N/m on masses from {np.diag(body.mass).min():.6g} "
                "kg: frequencies overflow"
            ),
        )
    squared, shapes = scipy.linalg.eigh(stiffness, mass)
    threshold = ROUND_OFF * np.abs(squared).max()
    if squared[0] < -threshold:
        least = smallest_eigenvalue(body.stiffness)
        raise ArgumentError(
            "stiffness",
            "be positive semidefinite",
            got=(
                f"the smallest eigenvalue {least:.6g}, a squared frequency of {at_most(squared[0])} 1/s² "
                f"where rounding gives no less than {at_least(-threshold, 1)}"
            ),
        )
    return np.sqrt(np.where(squared <= threshold, 0.0, squared)), scale[:, None] * shapes


def damping_in_modes(
    damping: Any, angular: Array, shapes: Array, kept: Array, largest: float = 0.0
) -> tuple[Array, Array | None]:
    """Return the damping of the modes kept, and its matrix where that is not diagonal.

    Parameters
    ----------
    damping : float, ndarray or DampingLaw
        Damping of the body.
    angular : ndarray, shape (modes,)
        Angular frequencies [rad/s].
    shapes : ndarray, shape (n, modes)
        Mass-normalised shapes.
    kept : ndarray of bool, shape (modes,)
        Mask of the modes kept.
    largest : float, optional
        Least value of the largest modal damping [1/s], for its rounding, if these are not all modes.
    """
    if not isinstance(damping, np.ndarray) or damping.ndim == 1:
        return damping_rates(damping, angular[kept]), None
    matrix = shapes.T @ damping @ shapes
    # Taken over all modes: rounding errors of the highest show among the lowest.
    rounding = ROUND_OFF * max(float(np.diag(matrix).max()), largest)
    matrix = 0.5 * (matrix + matrix.T)[np.ix_(kept, kept)]
    diagonal = np.where(np.diag(matrix) > rounding, np.diag(matrix), 0.0)
    coupled = np.abs(matrix) > COUPLING * np.sqrt(np.outer(diagonal, diagonal)) + rounding
    np.fill_diagonal(coupled, False)
    return diagonal, matrix if coupled.any() else None
