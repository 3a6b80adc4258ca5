"""Laws of dry friction whose coefficient falls with the speed of sliding; sticking stays exact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..bodies.modes import Array
from ..checks import non_negative, positive
from .coulomb import check_static
from .linearised import Linearised


@dataclass(frozen=True)
class Stribeck:
    """Friction ``kinetic + (static - kinetic) exp(-(|v| / velocity)^exponent) + viscous |v|``.

    Continuous at rest, where it holds up to `static` (Bo & Pavelescu 1982; Armstrong-Hélouvry, Dupont & Canudas de Wit
    1994, Automatica 30).

    Parameters
    ----------
    static : float
        Coefficient of friction of a sticking contact [1], at least `kinetic`.
    kinetic : float
        Coefficient of friction in fast sliding [1].
    velocity : float
        Slip speed over which it falls, Stribeck's velocity [m/s].
    exponent : float, optional
        Exponent [1]: 2 is Gauss's curve, 1 an exponential.
    viscous : float, optional
        Rise with speed [s/m], per unit of normal force.
    """

    law: ClassVar[str] = "stribeck"
    state_units: ClassVar[str] = ""
    state_at_start: ClassVar[float] = 0.0
    static: float
    kinetic: float
    velocity: float
    exponent: float = 2.0
    viscous: float = 0.0

    def __post_init__(self) -> None:
        check_static(self.static, self.kinetic)
        positive("velocity", self.velocity)
        positive("exponent", self.exponent)
        non_negative("viscous", self.viscous)

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return stribeck_curve(self.static, self.kinetic, self.velocity, self.exponent, self.viscous, velocity)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return small changes about steady sliding at `velocity` [m/s], not 0."""
        return Linearised(
            stribeck_slope(self.static, self.kinetic, self.velocity, self.exponent, self.viscous, velocity)
        )

    def __str__(self) -> str:
        return f"Stribeck, {self.static:.4g} to {self.kinetic:.4g} over {self.velocity:.3g} m/s"


@dataclass(frozen=True)
class ExponentialWeakening:
    """Friction ``kinetic + (static - kinetic) exp(-|v| / velocity)`` (Oden & Martins 1985, CMAME 52).

    Parameters
    ----------
    static : float
        Coefficient of friction of a sticking contact [1], at least `kinetic`.
    kinetic : float
        Coefficient of friction in fast sliding [1].
    velocity : float
        Slip speed over which it falls [m/s].
    """

    law: ClassVar[str] = "exponential weakening"
    state_units: ClassVar[str] = ""
    state_at_start: ClassVar[float] = 0.0
    static: float
    kinetic: float
    velocity: float

    def __post_init__(self) -> None:
        check_static(self.static, self.kinetic)
        positive("velocity", self.velocity)

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return stribeck_curve(self.static, self.kinetic, self.velocity, 1.0, 0.0, velocity)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return small changes about steady sliding at `velocity` [m/s], not 0."""
        return Linearised(stribeck_slope(self.static, self.kinetic, self.velocity, 1.0, 0.0, velocity))

    def __str__(self) -> str:
        return f"exponential, {self.static:.4g} to {self.kinetic:.4g} over {self.velocity:.3g} m/s"


@dataclass(frozen=True)
class LinearWeakening:
    """Friction ``static - slope |v|``, not below `kinetic` (the classic cause of negative damping, Mills 1938).

    Parameters
    ----------
    static : float
        Coefficient of friction of a sticking contact [1], at least `kinetic`.
    slope : float
        Fall with slip speed [s/m].
    kinetic : float, optional
        Coefficient of friction at which the fall ends [1].
    """

    law: ClassVar[str] = "linear weakening"
    state_units: ClassVar[str] = ""
    state_at_start: ClassVar[float] = 0.0
    static: float
    slope: float
    kinetic: float = 0.0

    def __post_init__(self) -> None:
        check_static(self.static, self.kinetic)
        non_negative("slope", self.slope)

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return np.maximum(self.static - self.slope * np.abs(velocity), self.kinetic)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return small changes about steady sliding at `velocity` [m/s], not 0."""
        return Linearised(-self.slope if self.static - self.slope * abs(velocity) > self.kinetic else 0.0)

    def __str__(self) -> str:
        return f"linear, {self.static:.4g} falling by {self.slope:.3g} s/m to {self.kinetic:.4g}"


def stribeck_curve(
    static: float, kinetic: float, velocity: float, exponent: float, viscous: float, at: Array | float
) -> Array:
    """Return Stribeck's curve at slip velocities `at` [m/s]."""
    speed = np.abs(at)
    return kinetic + (static - kinetic) * np.exp(-((speed / velocity) ** exponent)) + viscous * speed


def stribeck_slope(static: float, kinetic: float, velocity: float, exponent: float, viscous: float, at: float) -> float:
    """Return the slope [s/m] of Stribeck's curve over the slip speed, at slip velocity `at` [m/s], not 0."""
    speed = abs(at)
    power = (speed / velocity) ** exponent
    return float(viscous - (static - kinetic) * exponent * power / speed * np.exp(-power))
