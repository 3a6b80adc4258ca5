"""Laws of dry friction with constant coefficients."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..declared import Coefficient
from .friction_law import FrictionLaw, StaticAndKinetic


@dataclass(frozen=True)
class Coulomb(FrictionLaw):
    """Coulomb friction with one constant coefficient: ``|tangential force| <= coefficient * normal force``.

    Parameters
    ----------
    coefficient : float
        Coefficient of friction mu [1], the same for sticking and sliding.
    """

    law: ClassVar[str] = "coulomb"
    linear_in: ClassVar[tuple[str, ...]] = ("coefficient",)
    depends_on_speed: ClassVar[bool] = False
    coefficient: Coefficient

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        return {"coefficient": self.coefficient}

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return np.full(np.shape(velocity), float(self.coefficient))

    def __str__(self) -> str:
        return f"{self.coefficient:.4g}"


@dataclass(frozen=True)
class StaticKinetic(StaticAndKinetic):
    """Coulomb friction with a static coefficient that must be overcome and a kinetic one in sliding.

    A sticking contact holds up to `static`; a contact that slides or lands starts to stick only below `kinetic`. A
    contact that starts closed and at rest sticks.

    Parameters
    ----------
    static : float
        Coefficient of friction of a sticking contact [1], at least `kinetic`.
    kinetic : float
        Coefficient of friction in sliding [1].
    """

    law: ClassVar[str] = "static-kinetic"
    linear_in: ClassVar[tuple[str, ...]] = ("static", "kinetic")
    depends_on_speed: ClassVar[bool] = False
    static: Coefficient
    kinetic: Coefficient

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        return {"static": self.static, "kinetic": self.kinetic}

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]; the static one at 0."""
        return np.where(np.asarray(velocity) == 0.0, self.static, self.kinetic)

    def __str__(self) -> str:
        return f"{self.static:.4g} static, {self.kinetic:.4g} kinetic"
