"""Friction in series with a tangential stiffness: the contact deforms along its tangents before it slips."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from .curves import Curve, in_pieces
from .friction_law import CLOSE, CURVE, SLOWEST, FrictionLaw
from .linearised import Linearised


@dataclass(frozen=True)
class ElasticFriction(FrictionLaw):
    """A law of friction in series with a spring and a dashpot along the tangents.

    With the slip velocity v of the bodies, the deflection z of the spring and the normal force N::

        tangential force T = stiffness z + damping z',    |T| <= mu(|v|) N,    z' = v while the contact sticks

    Beyond the limit the contact slips: T is along ``stiffness z + damping z'`` and has the size of the limit.

    Attributes
    ----------
    friction : FrictionLaw
        Law that limits the force.
    stiffness, damping : float
        Tangential stiffness [N/m] and damping [N s/m].
    normal_force : float
        Normal force about which it is linearised [N].
    """

    law: ClassVar[str] = "elastic"
    set_valued: ClassVar[bool] = False
    state_units: ClassVar[str] = "m"
    state_is_vector: ClassVar[bool] = True
    friction: FrictionLaw
    stiffness: float
    damping: float
    normal_force: float = 1.0

    def __post_init__(self) -> None:
        """Leave the checks to those of the contact and of the law within."""

    @property
    def kernel_code(self) -> str:
        """Name of its constant in the layout of the march."""
        return "IN_SERIES"

    @property
    def depends_on_speed(self) -> bool:  # type: ignore[override]
        """Whether friction in sliding depends on the slip speed."""
        return self.friction.depends_on_speed

    @cached_property
    def curve(self) -> Curve:
        """The coefficient in sliding as a curve in pieces."""
        if not self.friction.depends_on_speed:
            return in_pieces(self.friction.coefficient_at, np.array([0.0, 1.0]), 1, 0.0)
        return super().curve

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        own = self.friction.parameters() if self.friction.kernel_code == CURVE else super().parameters()
        return {**own, "stiffness": self.stiffness, "damping": self.damping}

    @property
    def pieces(self) -> Array:
        """Numbers of the curve of its friction behind its parameters in the march."""
        return self.friction.pieces if self.friction.kernel_code == CURVE else self.curve.flat

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s]."""
        return self.friction.coefficient_at(velocity)

    def under(self, normal_force: float) -> ElasticFriction:
        """Return the law about a normal force [N]."""
        return replace(self, friction=self.friction.under(normal_force), normal_force=normal_force)

    @property
    def depends_on_pressure(self) -> bool:
        """Whether friction depends on the pressure."""
        return self.friction.depends_on_pressure

    def slope_over_normal(self, velocity: float, normal_force: float) -> float:
        """Return the change of the coefficient with the normal force [1/N], in steady sliding at a velocity [m/s]."""
        return self.friction.slope_over_normal(velocity, normal_force)

    def state_in_sliding(self, velocity: float, change: float = 0.0) -> float:
        """Return the deflection [m] in steady sliding at `velocity` [m/s], not 0, plus `change`."""
        limit = float(self.coefficient_at(velocity)) * self.normal_force / self.stiffness
        return float(np.sign(velocity) * (limit + change))

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0: the force is the limit."""
        return self.friction.linearised_at(velocity)

    def linearised_across(self, velocity: float) -> Linearised:
        """Return the law linearised across steady sliding at `velocity` [m/s], not 0: the joint follows the slip."""
        ratio, speed = float(self.coefficient_at(velocity)), abs(velocity)
        limit = ratio * self.normal_force
        whole = limit + self.damping * speed
        return Linearised(
            ratio * self.damping / whole,
            ratio * self.stiffness / whole,
            limit / whole,
            -self.stiffness * speed / whole,
        )

    @property
    def holding(self) -> float:
        """Ratio up to which a contact is held at rest [1]."""
        return self.friction.holding

    @property
    def fastest(self) -> float:
        """Slip speed up to which its friction was measured [m/s], infinite for formulas."""
        return self.friction.fastest

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return self.friction.reach

    def __str__(self) -> str:
        damped = f" and {self.damping:.3g} N s/m" if self.damping else ""
        return f"{self.friction}, in series with {self.stiffness:.3g} N/m{damped}"


def check_in_series(law: FrictionLaw, stiffness: Any) -> None:
    """Raise ValueError unless a law may limit the force of a tangential stiffness."""
    if law.has_state:
        raise ArgumentError(
            "tangential_stiffness", f"be left out under {law.law} friction, which has its own", stiffness
        )
    for one in law.sections:
        slow = float(np.asarray(one.coefficient_at(np.array([SLOWEST * law.reach]))).flat[0])
        if one.holding > (1.0 + CLOSE) * slow:
            words = "be left out under friction that holds more at rest than in the slowest sliding"
            got = f"{one.holding:.4g} and {slow:.4g} ({law.law})"
            raise ArgumentError("tangential_stiffness", words, stiffness, got=got)
