"""Steps of Newton's method from an orbit, in a space of directions spanned by products of the derivative."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from .returning import Return

# Share of the residual that the linear equations may leave: at least, and at most, where the residual itself is larger.
LINEAR, LINEAR_FAR = 1e-3, 3e-2
# Most products of the derivative for a step.
MOST_PRODUCTS = 80
# Norm of a direction, relative to the last one, below which it is due to rounding; singular values likewise.
ROUND_OFF, SINGULAR = 1e-10, 1e-13
# Halvings of an interval for the damping that gives a step its length.
HALVINGS = 40


class Condition(NamedTuple):
    """A linear equation for the change of an orbit.

    The product of `state` with the change of the state, in the norm of energy, and those of `factors` with the other
    changes sum up to zero.

    Attributes
    ----------
    state : ndarray
        Vector for the change of the state.
    factors : list of float
        Factors of the other changes.
    """

    state: Array
    factors: list[float]


class Step(NamedTuple):
    """A step of Newton's method.

    Attributes
    ----------
    vector : ndarray
        The state at the start of the period after the step, as a vector.
    amounts : list of float
        Changes of the other unknowns.
    length : float
        Norm of the change of the state.
    left : float
        Residual that the linearised motion leaves [1].
    """

    vector: Array
    amounts: list[float]
    length: float
    left: float


@dataclass(frozen=True)
class Linearised:
    """The linearised motion about an orbit in a space of directions.

    Attributes
    ----------
    now : Return
        The orbit and its march.
    directions, products : list of ndarray
        Orthonormal directions, and products of the derivative with them.
    others : sequence of ndarray
        Derivatives of the state after the period with respect to other unknowns, such as the period.
    matrix, right : ndarray
        Equations for the amounts of directions and others: the missing of the motion, then the conditions.
    """

    now: Return
    directions: list[Array]
    products: list[Array]
    others: Sequence[Array]
    matrix: Array
    right: Array

    @classmethod
    def of(
        cls, now: Return, others: Sequence[Array], conditions: Sequence[Condition], seeds: Sequence[Array] = ()
    ) -> Linearised:
        """Return the linearised motion in directions that solve its equations, up to a number of products.

        Parameters
        ----------
        now : Return
            The orbit and its march.
        others : sequence of ndarray
            Derivatives with respect to other unknowns.
        conditions : sequence of Condition
            As many conditions.
        seeds : sequence of ndarray, optional
            Directions from which the space is built, besides the difference that a period makes.
        """
        counted = now.vectors.counted
        missing = counted(now.missing)
        columns = np.array([counted(one) for one in others]).reshape(len(others), missing.size).T
        states = np.array([counted(one.state) for one in conditions]).reshape(len(conditions), missing.size)
        below = np.array([one.factors for one in conditions]).reshape(len(conditions), len(others))
        right = np.append(-missing, np.zeros(len(conditions)))
        directions, products, changes, along = (list[Array]() for _ in range(4))
        matrix = np.vstack([columns, below])
        enough = float(np.clip(now.residual, LINEAR, LINEAR_FAR)) * np.linalg.norm(missing)
        for direction, product in krylov(now, [now.missing, *seeds]):
            directions.append(direction)
            products.append(product)
            changes.append(counted(product - direction))
            along.append(states @ counted(direction))
            matrix = np.block([[np.array(changes).T, columns], [np.array(along).T, below]])
            scale = _scale(matrix)
            solution = np.linalg.lstsq(matrix / scale, right, rcond=SINGULAR)[0] / scale
            if np.linalg.norm(matrix @ solution - right) < enough:
                break
        return cls(now, directions, products, others, matrix, right)

    def step(self, longest: float = np.inf) -> Step:
        """Return the step that leaves the least residual, up to a length in the norm of energy.

        A longer one is damped (Levenberg 1944).
        """
        count, scale = len(self.directions), _scale(self.matrix)
        # Directions have norm 1, so that their amounts have the length of the step.
        scale[:count] = 1.0
        solution = self._damped(scale, 0.0)
        if np.linalg.norm(solution[:count]) > longest:
            low, high = -12.0, 6.0
            for _ in range(HALVINGS):
                middle = 0.5 * (low + high)
                found = self._damped(scale, 10.0**middle)
                low, high = (middle, high) if np.linalg.norm(found[:count]) > longest else (low, middle)
            solution = self._damped(scale, 10.0**high)
        left = float(np.linalg.norm(self.matrix @ solution - self.right)) / self.now.size
        return Step(self._vector(solution), solution[count:].tolist(), float(np.linalg.norm(solution[:count])), left)

    def _damped(self, scale: Array, damping: float) -> Array:
        """Return the solution with the least sum of the residual and of a share of the length."""
        count = len(self.directions)
        extra = np.zeros((count, self.matrix.shape[1]))
        extra[:, :count] = damping * np.eye(count)
        matrix, right = np.vstack([self.matrix / scale, extra]), np.append(self.right, np.zeros(count))
        return np.asarray(np.linalg.lstsq(matrix, right, rcond=SINGULAR)[0] / scale)

    def _vector(self, solution: Array) -> Array:
        """Return the state after a step; all that contacts carry follows the march."""
        start, end = self.now.orbit.vector.copy(), self.now.end.copy()
        for amount, direction, product in zip(solution, self.directions, self.products, strict=False):
            start += amount * direction
            end += amount * product
        for amount, change in zip(solution[len(self.directions) :], self.others, strict=True):
            end += amount * change
        modes = 2 * self.now.vectors.count
        return np.concatenate([start[:modes], end[modes:]])


def _scale(matrix: Array) -> Array:
    scale = np.linalg.norm(matrix, axis=0)
    return np.asarray(np.where(scale > 0.0, scale, 1.0))


def krylov(now: Return, seeds: Sequence[Array]) -> Iterator[tuple[Array, Array]]:
    """Yield directions, orthonormal in the norm of energy, with the products by the derivative that span them."""
    counted, norm = now.vectors.counted, now.vectors.norm
    found: list[tuple[Array, Array]] = []
    waiting = list(seeds)
    while waiting and len(found) < MOST_PRODUCTS:
        direction = waiting.pop(0)
        before = norm(direction)
        for _ in range(2):
            for one, numbers in found:
                direction = direction - one * (numbers @ counted(direction))
        size = norm(direction)
        if size > ROUND_OFF * before:
            direction = direction / size
            found.append((direction, counted(direction)))
            waiting.append(now.product(direction))
            yield direction, waiting[-1]
