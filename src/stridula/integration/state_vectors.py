"""States of a march as vectors whose numbers do not depend on the step, with the norm of energy."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from .._kernels.layout import columns as at
from ..arrays import Array
from ..lowering import Assembly
from ..records.state import State

# Columns of what contacts carry that are displacements in a step.
PER_STEP = [at.LAST_SLIP, at.EARLIER_SLIP, at.LAST_SLIP_B, at.EARLIER_SLIP_B]
# Columns that are kept as differences from another one: in a step, or in space.
BEFORE = ((at.EARLIEST_GAP, at.EARLIER_GAP), (at.EARLIER_GAP, at.LAST_GAP), (at.ABSCISSA_BEFORE, at.ABSCISSA))
FROM_MATERIAL = ((at.ANCHOR, at.MATERIAL), (at.ANCHOR_B, at.MATERIAL_B))
# Columns of both tangents that follow a displacement along them.
ALONG_TANGENTS = (
    (at.MATERIAL, at.MATERIAL_B),
    (at.ABSCISSA, at.ABSCISSA_B),
    (at.LAST_SLIP, at.LAST_SLIP_B),
    (at.EARLIER_SLIP, at.EARLIER_SLIP_B),
)
SHARES = [at.CLOSED_SHARE, at.STUCK_SHARE]
STATES = [at.FRICTION_STATE, at.FRICTION_STATE_B]


class StateVectors:
    """States of a march as vectors: positions and velocities of the modes, then all that contacts carry.

    Everything that a contact carries follows the motion of the last steps, except for the internal states of friction
    laws. The norm is therefore that of modes and these states alone, but all numbers are combined alike: combinations
    of states that a march has reached are again states that it could reach, to first order.

    Parameters
    ----------
    arrays : Assembly
        The system as flat arrays.
    period : float
        Period of its motion [s]: motions without stiffness have that of this period in the norm.
    """

    def __init__(self, arrays: Assembly, period: float) -> None:
        self.arrays, self.period, self.count = arrays, period, arrays.mode_count
        # Energy [J] of the unit of each internal state; they do not count until their size is known.
        self.of_states = np.zeros((len(arrays.contacts), len(STATES)))

    def vector(self, state: State, step: float) -> Array:
        """Return a state at a step [s] as a vector."""
        carried = state.carried.copy()
        carried[:, PER_STEP] /= step
        for column, after in BEFORE:
            carried[:, column] = (state.carried[:, after] - state.carried[:, column]) / step
        for column, origin in FROM_MATERIAL:
            carried[:, column] -= state.carried[:, origin]
        return np.concatenate([state.modal[at.Q], state.modal[at.D] / step, carried.ravel(), state.springs / step])

    def state(self, vector: Array, step: float, status: Array) -> State:
        """Return the state of a vector at a step [s], with the status of each contact."""
        modal = vector[: 2 * self.count].reshape(2, self.count) * np.array([[1.0], [step]])
        carried = self._carried(vector).copy()
        carried[:, PER_STEP] *= step
        for column, after in reversed(BEFORE):
            carried[:, column] = carried[:, after] - carried[:, column] * step
        for column, origin in FROM_MATERIAL:
            carried[:, column] += carried[:, origin]
        carried[:, at.STATUS] = status
        carried[:, SHARES] = np.clip(carried[:, SHARES], 0.0, 1.0)
        springs = vector[vector.size - len(self.arrays.springs.bends) :] * step
        return State(modal, np.zeros_like(modal), carried, springs, np.zeros(at.ENERGIES))

    def _carried(self, vector: Array) -> Array:
        """Return what contacts carry in a vector, shape (contacts, scalars)."""
        first, contacts = 2 * self.count, len(self.arrays.contacts)
        return vector[first : first + contacts * at.CARRIED].reshape(contacts, at.CARRIED)

    @staticmethod
    def status(state: State) -> Array:
        """Return the status of each contact in a state."""
        return state.carried[:, at.STATUS].copy()

    def weigh_states(self, sizes: Array, energy: float) -> None:
        """Give the internal states of friction laws, of given sizes, the weight of an energy [J] in the norm."""
        self.of_states = np.where(sizes > 0.0, energy / np.where(sizes > 0.0, sizes, 1.0) ** 2, 0.0)

    def counted(self, vector: Array) -> Array:
        """Return the numbers of a vector that count, scaled so that the sum of their squares is twice the energy."""
        n, coupled = self.count, self.arrays.coupled
        position, velocity = vector[:n], np.where(self.arrays.massless, 0.0, vector[n : 2 * n])
        swung = self._angular * position
        swung[:coupled] = self._root @ position[:coupled]
        states = self._carried(vector)[:, STATES] * np.sqrt(self.of_states)
        return np.concatenate([swung, velocity, states.ravel()])

    def of_modes(self, modal: Array, step: float) -> Array:
        """Return positions and increments of the modes, shape (2, modes), as a vector without anything else."""
        rest = np.zeros(len(self.arrays.contacts) * at.CARRIED + len(self.arrays.springs.bends))
        return np.concatenate([modal[at.Q], modal[at.D] / step, rest])

    def moved(self, position: Array, velocity: Array, vector: Array) -> Array:
        """Return a change of positions and velocities of the modes as a vector, with contacts that follow it.

        Parameters
        ----------
        position, velocity : ndarray, shape (modes,)
            The change.
        vector : ndarray
            State that is changed.
        """
        places = self._carried(vector)[:, at.ABSCISSA].tolist()
        carried = np.zeros((len(places), at.CARRIED))
        for own, one, place in zip(carried, self.arrays.contacts, places, strict=True):
            (rise, *slips), (speed, *rates) = one.rows_at(place) @ position, one.rows_at(place) @ velocity
            own[[at.LAST_GAP, at.EARLIER_GAP, at.EARLIEST_GAP]] = rise, speed, speed
            own[at.ABSCISSA_BEFORE] = rates[0]
            for material, abscissa, last, earlier, slip, rate in zip(*ALONG_TANGENTS, slips, rates, strict=False):
                own[[material, abscissa]] = slip
                own[[last, earlier]] = rate
        return np.concatenate([position, velocity, carried.ravel(), self.arrays.springs.rows @ velocity])

    def random(self, seed: int, vector: Array) -> Array:
        """Return a random change of positions and velocities, of similar energy in all modes; see `moved`."""
        position, velocity = np.random.default_rng(seed).standard_normal((2, self.count))
        return self.moved(position / self._angular, np.where(self.arrays.massless, 0.0, velocity), vector)

    def norm(self, vector: Array) -> float:
        """Return the norm of a vector, the square root of twice an energy."""
        return float(np.linalg.norm(self.counted(vector)))

    @cached_property
    def _angular(self) -> Array:
        """Angular frequency of each mode in the norm [rad/s], 1 for residual shapes."""
        slowest = 2.0 * np.pi / self.period
        return np.where(self.arrays.massless, 1.0, np.maximum(self.arrays.angular_frequency, slowest))

    @cached_property
    def _root(self) -> Array:
        """Root of the stiffness of the coupled modes, with that of the period added where they have mass."""
        has_mass = ~self.arrays.massless[: self.arrays.coupled]
        stiffness = self.arrays.stiffness + np.diag(np.where(has_mass, (2.0 * np.pi / self.period) ** 2, 0.0))
        return np.asarray(np.linalg.cholesky(stiffness).T)
