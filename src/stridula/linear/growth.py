"""Exponents of small vibration about the equilibrium of a system, without shapes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..system import System
from .condensed import Condensed, condensed
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
        The equilibrium; its modal displacement is that of the modes without eliminated shapes.
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
    return Growths().of(system, velocity)


class Growths:
    """Exponents of systems one after another, which keeps what does not change from one to the next.

    Matrices, their elimination and the static response of the bodies are those of the last system where only laws and
    stiffnesses of contacts differ from it, or loads. Results are the same to the last bit.
    """

    def __init__(self) -> None:
        self._last: Condensed | None = None

    def of(self, system: System, velocity: Velocity | None = None) -> Growth:
        """Return the exponents of a system, as `growth_of` does."""
        now = self._condensed(system)
        if now is None:
            structure = Structure(system)
            return _about(structure, structure, velocity)
        try:
            return _about(now.whole, now.small, velocity)
        except ArgumentError:
            # Its message may have motions in words, for which all modes are needed.
            if now.small is now.whole:
                raise
        return _about(now.whole, now.whole, velocity)

    def _condensed(self, system: System) -> Condensed | None:
        """Return a system without unseen shapes, None if all exponents are too many."""
        kept = None if self._last is None else self._last.with_laws(system)
        if kept is None:
            structure = Structure(system)
            if not has_all_exponents(structure):
                return None
            kept = None if self._last is None else self._last.with_loads(structure)
            kept = condensed(structure) if kept is None else kept
        self._last = kept
        return kept


def _about(whole: Structure, structure: Structure, velocity: Velocity | None) -> Growth:
    """Return the exponents of a system, or of the same with some shapes eliminated, about its equilibrium."""
    equilibrium = find_equilibrium(structure, given_velocity(velocity, structure))
    slides = equilibrium.kind != JAMMED and SLIDING in equilibrium.status
    found = exponents_alone(structure, vibration(structure, equilibrium)) if slides else None
    return Growth(equilibrium, found, round_off(whole), has_all_exponents(whole))
