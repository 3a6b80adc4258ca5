"""Laws of dry friction whose coefficient falls with the slip speed; sticking is exact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..declared import Coefficient, PositiveRatio, Slope, Speed
from .friction_law import StaticAndKinetic
from .linearised import Linearised


@dataclass(frozen=True)
class Stribeck(StaticAndKinetic):
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
        Slip speed over which it falls [m/s], Stribeck's velocity.
    exponent : float, optional
        Exponent [1]: 2 is Gauss's curve, 1 an exponential.
    viscous : float, optional
        Increase with speed per unit of normal force [s/m].
    """

    law: ClassVar[str] = "stribeck"
    linear_in: ClassVar[tuple[str, ...]] = ("static", "kinetic", "viscous")
    static: Coefficient
    kinetic: Coefficient
    velocity: Speed
    exponent: PositiveRatio = 2.0
    viscous: Slope = 0.0

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        own = {"static": self.static, "kinetic": self.kinetic, "velocity": self.velocity}
        return {**own, "exponent": self.exponent, "viscous": self.viscous}

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return 5.0 * self.velocity

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return stribeck_curve(self.static, self.kinetic, self.velocity, self.exponent, self.viscous, velocity)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0."""
        return Linearised(
            stribeck_slope(self.static, self.kinetic, self.velocity, self.exponent, self.viscous, velocity)
        )

    def __str__(self) -> str:
        return f"Stribeck, {self.static:.4g} to {self.kinetic:.4g} over {self.velocity:.3g} m/s"


@dataclass(frozen=True)
class ExponentialWeakening(StaticAndKinetic):
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
    linear_in: ClassVar[tuple[str, ...]] = ("static", "kinetic")
    static: Coefficient
    kinetic: Coefficient
    velocity: Speed

    @property
    def kernel_code(self) -> str:
        """Name of its constant in the layout of the march: that of Stribeck's law with exponent 1."""
        return Stribeck.law.upper()

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        own = {"static": self.static, "kinetic": self.kinetic, "velocity": self.velocity}
        return {**own, "exponent": 1.0, "viscous": 0.0}

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return 5.0 * self.velocity

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return stribeck_curve(self.static, self.kinetic, self.velocity, 1.0, 0.0, velocity)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0."""
        return Linearised(stribeck_slope(self.static, self.kinetic, self.velocity, 1.0, 0.0, velocity))

    def __str__(self) -> str:
        return f"exponential, {self.static:.4g} to {self.kinetic:.4g} over {self.velocity:.3g} m/s"


@dataclass(frozen=True)
class LinearWeakening(StaticAndKinetic):
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
    static: Coefficient
    slope: Slope
    kinetic: Coefficient = 0.0

    @property
    def end(self) -> float:
        """Slip speed [m/s] at which the fall ends, 0 if the coefficient does not fall."""
        return (self.static - self.kinetic) / self.slope if self.slope else 0.0

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        own = {"static": self.static, "slope": self.slope, "kinetic": self.kinetic}
        return {**own, "end": self.end or 1.0}

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return 1.5 * self.end or 1.0

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return np.maximum(self.static - self.slope * np.abs(velocity), self.kinetic)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0."""
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
