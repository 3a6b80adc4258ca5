"""Laws of friction as users write them: a formula, and nothing of the package but its base class."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import stridula as st


@dataclass(frozen=True)
class Polymer(st.FrictionLaw):
    """Friction with a peak at a speed, as that of rubber: ``base + rise 2 s / (1 + s^2)``, s the speed over that."""

    base: float
    rise: float
    peak: float

    def coefficient_at(self, velocity):
        share = np.abs(velocity) / self.peak
        return self.base + 2.0 * self.rise * share / (1.0 + share**2)


@dataclass(frozen=True)
class OwnStribeck(st.FrictionLaw):
    """Stribeck's formula, written out."""

    static: float
    kinetic: float
    velocity: float

    def coefficient_at(self, velocity):
        return self.kinetic + (self.static - self.kinetic) * np.exp(-((np.abs(velocity) / self.velocity) ** 2))
