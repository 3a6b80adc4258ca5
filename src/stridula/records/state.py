"""State of a march."""

from __future__ import annotations

from dataclasses import dataclass

from ..arrays import Array

# Incremented whenever the meaning of a State, or of its record, changes.
LAYOUT = 7


@dataclass
class State:
    """State of a march, sufficient to continue it.

    Attributes
    ----------
    modal : ndarray, shape (2, modes)
        Positions and last increments of the modes.
    remainder : ndarray, shape (2, modes)
        Rounding remainders of these in the units of the march, so that it continues bit by bit.
    carried : ndarray, shape (contacts, scalars)
        Scalars of each contact in the march.
    springs : ndarray, shape (springs,)
        Increment of the stretch of each nonlinear spring, or dashpot, in the step before the last one.
    energies : ndarray, shape (energies,)
        Energies since the start.
    """

    modal: Array
    remainder: Array
    carried: Array
    springs: Array
    energies: Array
