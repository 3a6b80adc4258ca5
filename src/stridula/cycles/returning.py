"""The linearised motion about an orbit over a period."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..integration.period_map import Passed, PeriodMap
from ..integration.state_vectors import StateVectors

# Size of perturbations relative to that of the motion, and to its residual where this is larger: where contacts jump,
# the derivative is that over the distance to the periodic motion.
PERTURBED, OF_RESIDUAL = 1e-6, 0.1


class Orbit(NamedTuple):
    """A motion that may be periodic.

    Attributes
    ----------
    vector : ndarray
        State at its start, as a vector.
    period : float
        Its period [s].
    status : ndarray, shape (contacts,)
        Status of the contacts at its start.
    """

    vector: Array
    period: float
    status: Array


@dataclass(frozen=True)
class Return:
    """An orbit after a period, and orbits next to it.

    Attributes
    ----------
    of_period : PeriodMap
        March of a period.
    vectors : StateVectors
        States as vectors.
    orbit : Orbit
        The orbit.
    passed : Passed
        Its march.
    """

    of_period: PeriodMap
    vectors: StateVectors
    orbit: Orbit
    passed: Passed

    @classmethod
    def of(cls, of_period: PeriodMap, vectors: StateVectors, orbit: Orbit) -> Return:
        """Return an orbit after a period.

        Raises
        ------
        MarchEnded
            If the march ends within the period.
        """
        state = vectors.state(orbit.vector, orbit.period / of_period.steps, orbit.status)
        return cls(of_period, vectors, orbit, of_period.after(state, orbit.period))

    @property
    def step(self) -> float:
        """Time step [s]."""
        return self.orbit.period / self.of_period.steps

    @cached_property
    def end(self) -> Array:
        """State after the period, as a vector."""
        return self.vectors.vector(self.passed.state, self.step)

    @property
    def status_after(self) -> Array:
        """Status of the contacts after the period."""
        return self.vectors.status(self.passed.state)

    @property
    def missing(self) -> Array:
        """Difference between the states after the period and at its start."""
        return np.asarray(self.end - self.orbit.vector)

    @cached_property
    def size(self) -> float:
        """Size of the motion about its mean, in the norm of the vectors."""
        motions = self.passed.motions
        mean = motions.mean(axis=0)
        return float(np.sqrt(np.mean([self.vectors.norm(self._of_modes(one - mean)) ** 2 for one in motions])))

    @cached_property
    def swing(self) -> Array:
        """Difference of the state at the start from the mean, by its modes."""
        count, mean = 2 * self.vectors.count, self._of_modes(self.passed.motions.mean(axis=0))
        mean[:count] = self.orbit.vector[:count] - mean[:count]
        return np.asarray(mean)

    @cached_property
    def residual(self) -> float:
        """Norm of that difference relative to the size of the motion."""
        return self.vectors.norm(self.missing) / self.size if self.size > 0.0 else np.inf

    @cached_property
    def flow(self) -> Array:
        """Direction in which the motion passes the end of the period, of norm 1, by its modes."""
        change = self._of_modes(self.passed.state.modal - self.passed.before.modal)
        return change / self.vectors.norm(change)

    def product(self, direction: Array, of_residual: float = OF_RESIDUAL) -> Array:
        """Return the derivative of the state after the period in a direction of its start."""
        amount = max(PERTURBED, of_residual * self.residual) * self.size / self.vectors.norm(direction)
        state = self.vectors.state(self.orbit.vector + amount * direction, self.step, self.orbit.status)
        end = self.of_period.end(state, self.orbit.period)
        return (self.vectors.vector(end, self.step) - self.end) / amount

    def mean_product(self, direction: Array) -> Array:
        """Return the same as a difference of two states as far apart as the motion goes in two steps.

        It averages over the places of events within their steps.
        """
        amount = 2.0 * np.pi / self.of_period.steps * self.size / self.vectors.norm(direction)
        ends = []
        for sign in (1.0, -1.0):
            vector = self.orbit.vector + sign * amount * direction
            state = self.vectors.state(vector, self.step, self.orbit.status)
            ends.append(self.vectors.vector(self.of_period.end(state, self.orbit.period), self.step))
        return np.asarray((ends[0] - ends[1]) / (2.0 * amount))

    def by_period(self) -> Array:
        """Return the derivative of the state after the period with respect to the period, for the same vector."""
        longer = self.orbit.period * (1.0 + PERTURBED)
        step = longer / self.of_period.steps
        end = self.of_period.end(self.vectors.state(self.orbit.vector, step, self.orbit.status), longer)
        return (self.vectors.vector(end, step) - self.end) / (longer - self.orbit.period)

    def _of_modes(self, modal: Array) -> Array:
        return self.vectors.of_modes(modal, self.step)
