"""Laws of dry friction with constant coefficients."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..bodies.modes import Array
from ..checks import ArgumentError, non_negative
from .linearised import Linearised


@dataclass(frozen=True)
class Coulomb:
    """Coulomb friction with one constant coefficient: ``|tangential force| <= coefficient * normal force``.

    Parameters
    ----------
    coefficient : float
        Coefficient of friction mu [1], the same in sticking and in sliding.
    """

    law: ClassVar[str] = "coulomb"
    state_units: ClassVar[str] = ""
    state_at_start: ClassVar[float] = 0.0
    coefficient: float

    def __post_init__(self) -> None:
        non_negative("coefficient", self.coefficient)

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return np.full(np.shape(velocity), float(self.coefficient))

    def linearised_at(self, velocity: float) -> Linearised:
        """Return small changes about steady sliding at `velocity` [m/s]: none."""
        return Linearised()

    def __str__(self) -> str:
        return f"{self.coefficient:.4g}"


@dataclass(frozen=True)
class StaticKinetic:
    """Coulomb friction with a static coefficient that must be overcome and a kinetic one in sliding.

    A contact that sticks goes on sticking up to `static`; one that slides, or lands, is held from then on only below
    `kinetic`. A contact that starts closed and at rest sticks.

    Parameters
    ----------
    static : float
        Coefficient of friction of a sticking contact [1], at least `kinetic`.
    kinetic : float
        Coefficient of friction in sliding [1].
    """

    law: ClassVar[str] = "static-kinetic"
    state_units: ClassVar[str] = ""
    state_at_start: ClassVar[float] = 0.0
    static: float
    kinetic: float

    def __post_init__(self) -> None:
        check_static(self.static, self.kinetic)

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]; the static one at 0."""
        return np.where(np.asarray(velocity) == 0.0, self.static, self.kinetic)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return small changes about steady sliding at `velocity` [m/s]: none."""
        return Linearised()

    def __str__(self) -> str:
        return f"{self.static:.4g} static, {self.kinetic:.4g} kinetic"


def check_static(static: float, kinetic: float) -> None:
    """Raise unless both coefficients are not negative and the static one is not the smaller."""
    non_negative("kinetic", kinetic)
    if non_negative("static", static) < kinetic:
        raise ArgumentError("static", f"be at least kinetic ({kinetic!r})", static)
