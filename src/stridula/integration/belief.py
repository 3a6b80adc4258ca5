"""Plausibility checks of a march, chunk by chunk."""

from __future__ import annotations

from copy import copy

import numpy as np

from .._kernels.books.ledger import Account, believed, keep_beside
from .._kernels.layout import columns as at
from ..arrays import Array
from ..lowering import Assembly
from ..lowering.blocks import Blocks
from ..system import System
from .marches import Chunk


class Belief:
    """Energies of a march so far, with which its next chunk is checked.

    Parameters
    ----------
    system : System
        The system.
    arrays : Assembly
        The same as flat arrays.
    blocks : Blocks
        The same in the form for the march.
    energies : ndarray, shape (energies,)
        Present energies.
    initial_energy : float
        Stored energy at the start [J].
    largest_energy : float, optional
        Largest energy so far [J].
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
        self.passive = all(contact.law.is_passive for contact in system.contacts)
        self.dissipative = not any(contact.law.has_state for contact in system.contacts)
        self.damped_alone = not arrays.coupled

    def of(self, chunk: Chunk, rows: Array | None = None, first: int = 0) -> tuple[int, int]:
        """Return the number of valid samples of the next chunk, and the code of its end.

        Parameters
        ----------
        chunk : Chunk
            The chunk.
        rows : ndarray, shape (energies, samples), optional
            Record in which its energies are stored.
        first : int, optional
            First sample of the chunk in the record.
        """
        samples = chunk.completed
        kept = np.empty((at.ENERGIES, samples)) if rows is None else rows
        if chunk.energies.flags.c_contiguous:
            kept[:, first : first + samples] = chunk.energies[:samples].T
        else:
            # With another layout, `believed` would be compiled again.
            keep_beside(chunk.energies, samples, kept, first)
        completed, ended, largest = believed(
            kept,
            first,
            samples,
            Account(
                self.last_energies,
                self.initial_energy,
                self.largest_energy,
                self.energy_of_loads,
                self.passive,
                self.dissipative,
                self.damped_alone,
            ),
        )
        if ended == at.ENERGY_CREATED:
            return completed, ended
        if completed:
            self.largest_energy = largest if ended < 0 else self._largest(kept[:, first : first + completed])
            self.last_energies = kept[:, first + completed - 1].copy()
        return completed, chunk.ended if ended < 0 else ended

    def copy(self) -> Belief:
        """Return the same energies, which continue on their own."""
        return copy(self)

    def _largest(self, energies: Array) -> float:
        return max(self.largest_energy, float(np.abs(energies[: at.DAMPING_LOSS + 1]).max()))
