"""Matrices become mass-normalised modes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg

from ..checks import at_least, at_most
from .matrix_input import ROUND_OFF, Rayleigh, smallest_eigenvalue
from .modes import Array, Modes

COUPLING = 1e-10


@dataclass(frozen=True)
class Reduction:
    """Modes of a body and their shapes.

    Attributes
    ----------
    modes : Modes
        The modes.
    shapes : ndarray, shape (n, modes)
        Their mass-normalised shapes on the degrees of freedom.
    """

    modes: Modes
    shapes: Array


def reduce_body(body: Any) -> Reduction:
    """Return the modes of a `ReducedBody` and their shapes."""
    angular, shapes = _all_modes(body)
    damping, rounding = _modal_damping(body.damping, angular, shapes)
    kept = np.full(angular.size, True) if body.cutoff is None else angular <= 2.0 * np.pi * body.cutoff
    if not kept.any():
        first = angular[0] / (2.0 * np.pi)
        raise ValueError(f"cutoff must leave at least one mode (first at {at_least(first)} Hz), got {body.cutoff!r} Hz")
    angular, shapes = angular[kept], shapes[:, kept]
    shapes.flags.writeable = False
    translation = np.zeros((2, angular.size))
    if body.translation is not None:
        translation = body.translation @ body.mass @ shapes
    if damping is None:
        return Reduction(Modes(angular, _given_ratios(body.damping, angular), translation), shapes)
    ratios, matrix = _ratios(damping[np.ix_(kept, kept)], rounding, angular)
    return Reduction(Modes(angular, ratios, translation, matrix), shapes)


def _all_modes(body: Any) -> tuple[Array, Array]:
    """Return the angular frequencies, rising, and the mass-normalised shapes."""
    # Scaled to a unit diagonal, so that rotations and translations have the same weight in rounding errors.
    scale = 1.0 / np.sqrt(np.diag(body.mass))
    both = np.outer(scale, scale)
    with np.errstate(over="ignore", invalid="ignore"):
        mass, stiffness = body.mass * both, body.stiffness * both
    if not (np.isfinite(mass).all() and np.isfinite(stiffness).all()):
        raise ValueError(
            f"stiffness must be of a size that mass can carry, got up to {np.abs(body.stiffness).max():.6g} N/m on "
            f"masses from {np.diag(body.mass).min():.6g} kg: frequencies overflow"
        )
    squared, shapes = scipy.linalg.eigh(stiffness, mass)
    threshold = ROUND_OFF * np.abs(squared).max()
    if squared[0] < -threshold:
        least = smallest_eigenvalue(body.stiffness)
        raise ValueError(
            f"stiffness must be positive semidefinite, got the smallest eigenvalue {least:.6g}, "
            f"a squared frequency of {at_most(squared[0])} 1/s² where rounding gives no less than "
            f"{at_least(-threshold, 1)}"
        )
    return np.sqrt(np.where(squared <= threshold, 0.0, squared)), scale[:, None] * shapes


def _modal_damping(damping: Any, angular: Array, shapes: Array) -> tuple[Array | None, float]:
    """Return ``Phi^T C Phi`` and how large its rounding errors may be; None if the damping is given by ratios."""
    if isinstance(damping, Rayleigh):
        return np.diag(damping.mass + damping.stiffness * angular**2), 0.0
    if not isinstance(damping, np.ndarray) or damping.ndim == 1:
        return None, 0.0
    matrix = shapes.T @ damping @ shapes
    return 0.5 * (matrix + matrix.T), ROUND_OFF * float(np.diag(matrix).max())


def _ratios(matrix: Array, rounding: float, angular: Array) -> tuple[Array, Array | None]:
    """Return the damping ratios on the diagonal of a modal damping matrix, and the matrix if they do not say it all."""
    diagonal = np.where(np.diag(matrix) > rounding, np.diag(matrix), 0.0)
    elastic = angular > 0.0
    ratios = np.where(elastic, diagonal / np.where(elastic, 2.0 * angular, 1.0), 0.0)
    coupled = np.abs(matrix) > COUPLING * np.sqrt(np.outer(diagonal, diagonal)) + rounding
    np.fill_diagonal(coupled, False)
    if coupled.any():
        return ratios, matrix
    said = not diagonal[~elastic].any() and bool((ratios < 1.0).all())
    return ratios, None if said else np.diag(diagonal)


def _given_ratios(damping: Any, angular: Array) -> Array:
    if isinstance(damping, np.ndarray) and damping.size != angular.size:
        raise ValueError(f"damping must have one ratio for each of the {angular.size} modes kept, got {damping.size}")
    return np.where(angular > 0.0, damping, 0.0)
