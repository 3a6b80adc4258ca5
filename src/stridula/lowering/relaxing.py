"""Coordinates of viscoelastic springs: the inner motion to which each of their branches relaxes."""

from __future__ import annotations

import numpy as np

from ..bodies.modes import Modes
from ..connections import elements_of
from ..system import System


class Relaxing:
    """The inner motions of all branches of connections, which stand beside the modes of the bodies.

    Parameters
    ----------
    system : System
        The system.
    """

    def __init__(self, system: System) -> None:
        elements = [element for one in system.connections for element in elements_of(one)]
        self.branches = [branch for element in elements for branch in element.branches]

    def modes(self, is_held: bool) -> Modes:
        """Return the inner motions as modes, which no uniform acceleration drives."""
        frequencies = np.array([one.angular_frequency for one in self.branches])
        rates = np.array([one.damping_rate for one in self.branches])
        return Modes(frequencies, rates, np.zeros((3, len(self.branches))))
