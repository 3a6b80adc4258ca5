"""Coulomb's law of dry friction."""

from __future__ import annotations

from dataclasses import dataclass

from ..checks import non_negative


@dataclass(frozen=True)
class Coulomb:
    """Coulomb friction with one constant coefficient: ``|tangential force| <= coefficient * normal force``.

    Parameters
    ----------
    coefficient : float
        Coefficient of friction mu [1], the same in sticking and in sliding.
    """

    coefficient: float

    def __post_init__(self) -> None:
        non_negative("coefficient", self.coefficient)
