"""Where a march is."""

from __future__ import annotations

from dataclasses import dataclass

from ..arrays import Array

# Raised whenever what a State, or the record of one, holds means something else.
LAYOUT = 2


@dataclass
class State:
    """Where a march is, enough to go on from there.

    Attributes
    ----------
    modal : ndarray, shape (2, modes)
        Positions and last increments of the modes.
    remainder : ndarray, shape (2, modes)
        What they lack in the units of the march, by rounding: with it a march goes on to the last bit.
    carried : ndarray, shape (contacts, scalars)
        Scalars that the march carries for each contact.
    energies : ndarray, shape (energies,)
        Energies since the start.
    """

    modal: Array
    remainder: Array
    carried: Array
    energies: Array
