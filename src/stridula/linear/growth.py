"""Exponents of small vibration about the equilibrium of a system, without shapes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..system import System
from .equilibrium import JAMMED, Equilibrium, find_equilibrium
from .given import Velocity, given_velocity
from .modes import exponents_alone, has_all_exponents, round_off
from .structure import SLIDING, Structure
from .vibration import vibration


@dataclass(frozen=True)
class Growth:
    """Exponents about an equilibrium.

    Attributes
    ----------
    equilibrium : Equilibrium
        The equilibrium.
    exponents : ndarray of complex, or None
        The exponents [1/s], one of each conjugate pair; None if nothing slides, since only sliding feeds a vibration.
    round_off : float
        Growth that may be due to rounding [1/s].
    complete : bool
        Whether these are all exponents; else the lowest ones.
    """

    equilibrium: Equilibrium
    exponents: Array | None
    round_off: float
    complete: bool

    @property
    def growing(self) -> Array:
        """The exponents of the modes that grow [1/s]."""
        found = np.empty(0, dtype=complex) if self.exponents is None else self.exponents
        return found[found.real > self.round_off]


def growth_of(system: System, velocity: Velocity | None = None) -> Growth:
    """Return the exponents of a system about its equilibrium, as for `sliding_stability`.

    Parameters
    ----------
    system : System
        The system.
    velocity : float or sequence of float, optional
        Slip velocity [m/s] of contacts for which nothing prescribes it.
    """
    structure = Structure(system)
    equilibrium = find_equilibrium(structure, given_velocity(velocity, structure))
    slides = equilibrium.kind != JAMMED and SLIDING in equilibrium.status
    found = exponents_alone(structure, vibration(structure, equilibrium)) if slides else None
    return Growth(equilibrium, found, round_off(structure), has_all_exponents(structure))
