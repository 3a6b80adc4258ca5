"""Friction between two laws, such as those at two pressures or at two temperatures."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from ..arrays import Array
from .friction_law import CURVE, FrictionLaw
from .linearised import Linearised


@dataclass(frozen=True)
class Between(FrictionLaw):
    """Friction on a straight line between two laws of the same kind.

    Attributes
    ----------
    first, last : FrictionLaw
        The law below and above.
    share : float
        Share of the way from the first to the last.
    """

    law: ClassVar[str] = "between"
    first: FrictionLaw
    last: FrictionLaw
    share: float

    def __post_init__(self) -> None:
        """Leave the checks to the laws."""

    def _on_line(self, first: Array | float, last: Array | float) -> Array:
        """Return what lies between two values; exactly the first where both are equal."""
        return np.asarray(first + self.share * (np.asarray(last) - first))

    @property
    def depends_on_speed(self) -> bool:  # type: ignore[override]
        """Whether friction in sliding depends on the slip speed."""
        return self.first.depends_on_speed or self.last.depends_on_speed

    @property
    def depends_on_pressure(self) -> bool:
        """Whether friction depends on the pressure."""
        return self.first.depends_on_pressure or self.last.depends_on_pressure

    @property
    def kernel_code(self) -> str:
        """Name of its constant in the layout of the march."""
        return self.first.kernel_code

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        last = self.last.parameters()
        return {name: float(self._on_line(value, last[name])) for name, value in self.first.parameters().items()}

    @property
    def pieces(self) -> Array:
        """Numbers of its curves behind its parameters in the march."""
        return self._on_line(self.first.pieces, self.last.pieces) if self.kernel_code == CURVE else np.zeros(0)

    def on(self, area: float) -> Between:
        """Return the law of a contact that represents an area [m²], with normal forces in place of pressures."""
        return replace(self, first=self.first.on(area), last=self.last.on(area))

    def under(self, normal_force: float) -> Between:
        """Return the law about a normal force [N]."""
        return replace(self, first=self.first.under(normal_force), last=self.last.under(normal_force))

    def slope_over_normal(self, velocity: float, normal_force: float) -> float:
        """Return the change of the coefficient with the normal force [1/N], in steady sliding at a velocity [m/s]."""
        slopes = (one.slope_over_normal(velocity, normal_force) for one in (self.first, self.last))
        return float(self._on_line(*slopes))

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]; at 0, the largest at rest."""
        return self._on_line(*(one.coefficient_at(velocity) for one in (self.first, self.last)))

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0."""
        return Linearised(float(self._on_line(*(one.linearised_at(velocity).slope for one in (self.first, self.last)))))

    @property
    def holding(self) -> float:
        """Ratio up to which a contact is held at rest [1]."""
        return float(self._on_line(self.first.holding, self.last.holding))

    @property
    def fastest(self) -> float:
        """Slip speed up to which its friction was measured [m/s]."""
        return self.first.fastest

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return max(self.first.reach, self.last.reach)

    def __str__(self) -> str:
        return f"{self.first} to {self.last}"
