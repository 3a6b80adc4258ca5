"""Whether a march can be believed, chunk by chunk."""

from __future__ import annotations

import numpy as np

from .._kernels import layout as at
from ..arrays import Array
from ..assembly import Assembly
from ..system import System
from .blocks import Blocks
from .marches import Chunk
from .stops import energy_created


class Belief:
    """What a march had of energy, against which its next chunk is held.

    Parameters
    ----------
    system : System
        What marches.
    arrays : Assembly
        The same as flat arrays.
    blocks : Blocks
        The same as the march reads it.
    energies : ndarray, shape (energies,)
        Its energies now.
    initial_energy : float
        Stored energy at the start [J].
    largest_energy : float, optional
        Largest energy met before [J].
    """

    def __init__(
        self,
        system: System,
        arrays: Assembly,
        blocks: Blocks,
        energies: Array,
        initial_energy: float,
        largest_energy: float = 0.0,
    ) -> None:
        self.initial_energy = initial_energy
        self.last_energies = energies.copy()
        self.largest_energy = max(largest_energy, float(np.abs(energies[: at.DAMPING_LOSS + 1]).max()))
        self.energy_of_loads = blocks.modes.energy_of_loads()
        self.dissipative = not any(contact.friction.has_state for contact in system.contacts)
        self.damped_alone = not arrays.coupled

    def of(self, chunk: Chunk) -> tuple[int, int]:
        """Return how many samples of the next chunk can be believed, and what ended it."""
        completed, ended = chunk.completed, chunk.ended
        energies = np.ascontiguousarray(chunk.energies[:completed].T)
        bad = np.flatnonzero(~np.isfinite(energies).all(axis=0))
        if bad.size:
            completed, ended = int(bad[0]), at.NOT_FINITE
            energies = energies[:, :completed]
        wrong = energy_created(
            energies,
            self.last_energies,
            self.initial_energy,
            self.largest_energy,
            self.energy_of_loads,
            self.dissipative,
            self.damped_alone,
        )
        if wrong is not None:
            return wrong, at.ENERGY_CREATED
        if completed:
            self.largest_energy = max(self.largest_energy, float(np.abs(energies[: at.DAMPING_LOSS + 1]).max()))
            self.last_energies = energies[:, -1].copy()
        return completed, ended
