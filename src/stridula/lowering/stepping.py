"""A time scheme applied to the modes of a system: uncoupled, coupled, and residual shapes, which have no mass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from .assembly import Assembly
from .schemes import Coefficients, Scheme

# Recurrence of residual shapes: share of an increment kept, stiffness of a step. They act like shapes with a mass that
# vanishes with the step: four steps are a period. A share (1 - 0.98) / 1.98 of a step remains as a lag, which damps
# contacts at first order.
KEPT, STIFFNESS = 0.98, 1.98


@dataclass(frozen=True)
class Stepping:
    """A time scheme applied to the modes of a system.

    Residual shapes follow forces within a few steps: ``b = 0.98``, ``r = l = 1.98``, in units of their stiffness.

    Attributes
    ----------
    arrays : Assembly
        The system.
    scheme : Scheme
        The scheme.
    """

    arrays: Assembly
    scheme: Scheme

    @property
    def limit(self) -> float:
        """Step [s] below which it is stable."""
        arrays, coupled = self.arrays, self._moving[: self.arrays.coupled]
        return min(
            self.scheme.limit(*self._alone),
            self.scheme.coupled_limit(_part(arrays.stiffness, coupled), _part(arrays.dissipation, coupled)),
        )

    def coefficients(self, step: float) -> Coefficients:
        """Return the coefficients of uncoupled modes, each of shape (modes,)."""
        found, moving = self.scheme.coefficients(*self._alone, step), self._moving
        rows = np.zeros((3, moving.size)) + np.array([[KEPT], [STIFFNESS], [STIFFNESS]])
        rows[:, moving] = found.b, found.r, found.load
        return Coefficients(*rows)

    def coupled_coefficients(self, step: float) -> Coefficients:
        """Return the coefficients of coupled modes, each of shape (coupled, coupled)."""
        arrays, moving = self.arrays, self._moving[: self.arrays.coupled]
        parts = _part(arrays.stiffness, moving), _part(arrays.dissipation, moving)
        found = self.scheme.coupled_coefficients(*parts, step)
        b, r, load = (np.diag(~moving * still) for still in (KEPT, STIFFNESS, STIFFNESS))
        where = np.ix_(moving, moving)
        b[where], r[where], load[where] = found.b, found.r, found.load
        return Coefficients(b, r, load)

    def first_increment(self, step: float, position: Array, velocity: Array, force: Array) -> Array:
        """Return ``q[0] - q[-1]`` of motion that passes `position` with `velocity` under a constant `force`.

        All have the shape (modes,), or (motions, modes).
        """
        arrays, moving, size = self.arrays, self._moving, self.arrays.coupled
        found = step * velocity
        motion = [one[..., moving] for one in (position, velocity, force)]
        found[..., moving] = self.scheme.first_increment(*self._alone, step, *motion)
        if size:
            inside = moving[:size]
            parts = _part(arrays.stiffness, inside), _part(arrays.dissipation, inside)
            motion = [one[..., :size][..., inside] for one in (position, velocity, force)]
            found[..., :size][..., inside] = self.scheme.coupled_first_increment(*parts, step, *motion)
        return np.asarray(found)

    @property
    def _moving(self) -> Array:
        return ~self.arrays.massless

    @property
    def _alone(self) -> tuple[Array, Array]:
        return self.arrays.angular_frequency[self._moving], self.arrays.damping_rate[self._moving]


def _part(matrix: Array, chosen: Array) -> Array:
    return matrix[np.ix_(chosen, chosen)]
