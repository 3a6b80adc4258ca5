"""Coordinates of viscoelastic springs: the inner motion to which each of their branches relaxes."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..bodies.modes import Modes
from ..connections import branches_of
from ..connections.branches import Branch
from ..system import System


class InnerMotion(NamedTuple):
    """A branch of a viscoelastic spring, with the coordinate that it adds.

    Attributes
    ----------
    spring : ViscoelasticSpring
        The spring.
    branch : Branch
        The branch.
    """

    spring: Any
    branch: Branch


class Relaxing:
    """The inner motions of all viscoelastic springs, which stand beside the modes of the bodies.

    Parameters
    ----------
    system : System
        The system.
    """

    def __init__(self, system: System) -> None:
        pairs = [(one, branch) for one in system.connections for branch in branches_of(one)]
        self.motions = [InnerMotion(*pair) for pair in pairs]

    def modes(self, is_held: bool) -> Modes:
        """Return the coordinates as modes, which no uniform acceleration drives."""
        frequencies = np.array([one.branch.angular_frequency for one in self.motions])
        rates = np.array([one.branch.damping_rate for one in self.motions])
        return Modes(frequencies, rates, np.zeros((3, len(self.motions))))
