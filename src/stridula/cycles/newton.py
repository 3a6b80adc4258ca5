"""Periodic motions by Newton's method on the march of a period, with products of its derivative alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..integration.period_map import MarchEnded, PeriodMap
from ..integration.state_vectors import StateVectors
from .returning import Orbit, Return

# Share of the residual that the linear equations may leave, and most products for them.
LINEAR, MOST_PRODUCTS = 1e-3, 80
# Most steps of the method, most halvings of a step, and steps in a row that may fail to halve the residual.
MOST_STEPS, HALVINGS, VAIN = 40, 5, 8
# Size of a motion, relative to that at the start, below which it has died away.
FAINT = 1e-6
# Shortest period that a step may lead to, relative to the last one.
SHORTEST = 0.2
# Norm of a direction, relative to the last one, below which it is due to rounding.
ROUND_OFF = 1e-10

# Called with the number of each step of the method, its residual, and the periods marched so far.
Tell = Callable[[int, float, float], None]


@dataclass
class Found:
    """Result of a search for a periodic motion.

    Attributes
    ----------
    best : Return
        Motion with the smallest residual.
    residuals : list of float
        Residual after each step of the method.
    reason : str
        Reason for the end of the search, empty if the motion is periodic to the tolerance.
    """

    best: Return
    residuals: list[float] = field(default_factory=list)
    reason: str = ""

    @property
    def is_periodic(self) -> bool:
        """Whether the motion is periodic to the tolerance."""
        return not self.reason


def closed_orbit(
    of_period: PeriodMap,
    vectors: StateVectors,
    orbit: Orbit,
    is_driven: bool,
    tolerance: float,
    tell: Tell,
    steps: int = MOST_STEPS,
) -> Found:
    """Search for a periodic motion near an orbit.

    Parameters
    ----------
    of_period : PeriodMap
        March of a period.
    vectors : StateVectors
        States as vectors.
    orbit : Orbit
        Start of the search.
    is_driven : bool
        Whether drives prescribe the period.
    tolerance : float
        Largest residual [1].
    tell : callable
        Called with the progress.
    steps : int, optional
        Most steps of the method.

    Raises
    ------
    MarchEnded
        If the march of the start ends within a period.
    """
    now = Return.of(of_period, vectors, orbit)
    _weigh(now)
    found, first, vain = Found(now, [now.residual]), now, 0
    for number in range(steps):
        tell(number, now.residual, of_period.counter.marched)
        if now.residual < tolerance:
            return found
        if not now.size > FAINT * first.size or not np.isfinite(now.residual):
            found.reason = "the motion dies away to rest or to steady sliding"
            return found
        now = _improved(now, is_driven)
        vain = 0 if now.residual < 0.5 * found.best.residual else vain + 1
        found.residuals.append(now.residual)
        if now.residual < found.best.residual:
            found.best = now
        if vain == VAIN:
            break
    if found.best.residual >= tolerance:
        found.reason = "the search does not come nearer"
    return found


def _weigh(now: Return) -> None:
    """Give the internal states of friction laws the weight of the motion's energy."""
    if any(contact.contact.friction.has_state for contact in now.vectors.arrays.contacts):
        now.vectors.weigh_states(now.passed.friction_states, now.size**2)


def _improved(now: Return, is_driven: bool) -> Return:
    """Return the orbit after a step of Newton's method, shortened while the residual does not fall."""
    step = newton_step(now, [] if is_driven else [now.by_period()], [] if is_driven else [Condition(now.flow, [0.0])])
    share, best = 1.0, None
    for _ in range(HALVINGS + 1):
        period = now.orbit.period + (share * step.amounts[0] if step.amounts else 0.0)
        if period > SHORTEST * now.orbit.period:
            try:
                tried = Return.of(now.of_period, now.vectors, Orbit(step.vector(share), period, now.status_after))
            except MarchEnded:
                tried = None
            if tried is not None and (best is None or tried.residual < best.residual):
                best = tried
            if best is not None and best.residual < (1.0 - 0.25 * share) * now.residual:
                break
        share *= 0.5
    if best is None:
        raise MarchEnded("no step of the method could be marched")
    return best


class Condition(NamedTuple):
    """A linear equation for the change of an orbit: products of both with the changes sum up to `right`.

    Attributes
    ----------
    state : ndarray
        Vector for the change of the state, in the product of energy.
    factors : list of float
        Factors of the other changes.
    right : float, optional
        Right side.
    """

    state: Array
    factors: list[float]
    right: float = 0.0


class NewtonStep(NamedTuple):
    """A step of Newton's method.

    Attributes
    ----------
    begun, target : ndarray
        The vector of the orbit, and that at which the linearised motion is periodic.
    amounts : list of float
        Changes of the other unknowns.
    """

    begun: Array
    target: Array
    amounts: list[float]

    def vector(self, share: float) -> Array:
        """Return the vector after a share of the step."""
        return np.asarray(self.begun + share * (self.target - self.begun))


def newton_step(
    now: Return, others: Sequence[Array], conditions: Sequence[Condition], seeds: Sequence[Array] = ()
) -> NewtonStep:
    """Return the step to the orbit whose linearised motion is periodic and fulfils other conditions.

    Parameters
    ----------
    now : Return
        The orbit and its march.
    others : sequence of ndarray
        Derivatives of the state after the period with respect to other unknowns, such as the period.
    conditions : sequence of Condition
        As many conditions.
    seeds : sequence of ndarray, optional
        Directions from which the solution is sought, besides the difference that a period makes.
    """
    count, counted = now.vectors.count, now.vectors.counted
    missing = counted(now.missing)
    columns = np.array([counted(one) for one in others]).reshape(len(others), missing.size).T
    states = [counted(one.state) for one in conditions]
    below = np.array([one.factors for one in conditions]).reshape(len(conditions), len(others))
    right = np.append(-missing, [one.right for one in conditions])
    directions: list[Array] = []
    products: list[Array] = []
    solution = np.zeros(len(others))
    for direction, product in _krylov(now, [now.missing, *seeds]):
        directions.append(direction)
        products.append(product)
        changes = np.array([counted(b - a) for a, b in zip(directions, products, strict=True)]).T
        along = np.array([[one @ counted(direction) for direction in directions] for one in states])
        matrix = np.block([[changes, columns], [along.reshape(len(states), len(directions)), below]])
        scale = np.linalg.norm(matrix, axis=0)
        scale[scale == 0.0] = 1.0
        solution = np.linalg.lstsq(matrix / scale, right, rcond=1e-13)[0] / scale
        if np.linalg.norm(matrix @ solution - right) < LINEAR * np.linalg.norm(missing):
            break
    start, end = now.orbit.vector.copy(), now.end.copy()
    for amount, direction, product in zip(solution, directions, products, strict=False):
        start += amount * direction
        end += amount * product
    amounts = solution[len(directions) :].tolist()
    for amount, change in zip(amounts, others, strict=True):
        end += amount * change
    # All that contacts carry follows the march.
    return NewtonStep(now.orbit.vector, np.concatenate([start[: 2 * count], end[2 * count :]]), amounts)


def _krylov(now: Return, seeds: Sequence[Array]) -> Iterator[tuple[Array, Array]]:
    """Yield directions, orthogonal in the norm of energy, with the products by the derivative that span them."""
    counted, norm = now.vectors.counted, now.vectors.norm
    directions: list[Array] = []
    waiting = list(seeds)
    while waiting and len(directions) < MOST_PRODUCTS:
        direction = waiting.pop(0)
        before = norm(direction)
        for _ in range(2):
            for one in directions:
                direction = direction - one * (counted(one) @ counted(direction))
        size = norm(direction)
        if size > ROUND_OFF * before:
            directions.append(direction / size)
            waiting.append(now.product(directions[-1]))
            yield directions[-1], waiting[-1]
