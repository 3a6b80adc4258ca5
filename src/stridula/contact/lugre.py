"""LuGre's law: friction as the mean deflection of elastic bristles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from ..declared import Coefficient, Number, OneOrEach, PositiveRatio, Slope, Speed
from .friction_law import StaticAndKinetic
from .linearised import Linearised
from .weakening import stribeck_curve, stribeck_slope


@dataclass(frozen=True)
class LuGre(StaticAndKinetic):
    """LuGre friction (Canudas de Wit, Olsson, Åström & Lischinsky 1995, IEEE Trans. Automatic Control 40).

    With the slip velocity v and the bristles' deflection z::

        z' = v - stiffness |v| z / g(v),    g(v) = kinetic + (static - kinetic) exp(-(v / velocity)²)
        tangential force = normal force * (stiffness z + damping z' + viscous v)

    In space z, v and the force are vectors of the tangent plane, with the magnitude of v in g; bristles turn after v.

    All coefficients are per unit of normal force. The deflection is integrated exactly over a step at constant slip
    velocity and the force is solved for together with the contact, so that the step need not resolve the bristles.
    There is no exact sticking: a contact counts as sticking while its slip speed is below `velocity`. Bristles are
    reset when a contact opens. `friction_loss` includes the energy stored in the bristles. Their stiffness follows the
    normal force: bristles that are bent under a small force and released under a large one give more than they took.

    Parameters
    ----------
    static : float
        Coefficient of friction at which the bristles give way at low speed [1], at least `kinetic`.
    kinetic : float
        Coefficient of friction in fast sliding [1], above 0.
    velocity : float
        Stribeck's velocity [m/s].
    stiffness : float
        Stiffness of the bristles per unit of normal force [1/m], sigma0.
    damping : float, optional
        Damping of the bristles per unit of normal force [s/m], sigma1.
    viscous : float, optional
        Increase with speed per unit of normal force [s/m], sigma2.
    initial_state : float or sequence of float, optional
        Deflection of the bristles at the start [m]; in steady sliding at v it is ``sign(v) g(v) / stiffness``. In space
        along the first tangent, or two numbers, one for each tangent.
    """

    law: ClassVar[str] = "lugre"
    set_valued: ClassVar[bool] = False
    state_units: ClassVar[str] = "m"
    state_is_vector: ClassVar[bool] = True
    is_passive: ClassVar[bool] = False
    static: Coefficient
    kinetic: PositiveRatio
    velocity: Speed
    stiffness: Annotated[float, Number("1/m", above=0.0)]
    damping: Slope = 0.0
    viscous: Slope = 0.0
    initial_state: Annotated[float | Sequence[float], OneOrEach(Number("m"))] = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if np.size(self.initial_state) not in (1, 2):
            raise ArgumentError("initial_state", "be one number, or two in space", self.initial_state)

    @property
    def state_at_start(self) -> float:
        """Deflection of the bristles at the start [m]; zero for a contact that lands later."""
        return self.states_at_start[0]

    @property
    def states_at_start(self) -> tuple[float, float]:
        """Deflection of the bristles at the start along both tangents [m]."""
        first, *others = np.atleast_1d(self.initial_state).tolist()
        return first, others[0] if others else 0.0

    def state_in_sliding(self, velocity: float, change: float = 0.0) -> float:
        """Return the deflection of the bristles [m] in steady sliding at `velocity` [m/s], not 0, plus `change`."""
        bristles = (float(self.coefficient_at(velocity)) - self.viscous * abs(velocity)) / self.stiffness
        return float(np.sign(velocity) * (bristles + change))

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        own = {"static": self.static, "kinetic": self.kinetic, "velocity": self.velocity}
        return {**own, "stiffness": self.stiffness, "damping": self.damping, "viscous": self.viscous}

    @property
    def holding(self) -> float:
        """Ratio up to which the bristles hold [1]."""
        return self.static

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return 5.0 * self.velocity

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s], 0 at rest."""
        curve = stribeck_curve(self.static, self.kinetic, self.velocity, 2.0, self.viscous, velocity)
        return np.where(np.asarray(velocity) == 0.0, 0.0, curve)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0, where ``z = g(v) / stiffness``."""
        speed = abs(velocity)
        curve = float(stribeck_curve(self.static, self.kinetic, self.velocity, 2.0, 0.0, speed))
        slope = stribeck_slope(self.static, self.kinetic, self.velocity, 2.0, 0.0, speed)
        by_velocity, by_state = speed * slope / curve, -self.stiffness * speed / curve
        return Linearised(
            self.damping * by_velocity + self.viscous, self.stiffness + self.damping * by_state, by_velocity, by_state
        )

    def linearised_across(self, velocity: float) -> Linearised:
        """Return the law linearised across steady sliding at `velocity` [m/s], not 0: bristles turn after the slip."""
        speed = abs(velocity)
        curve = float(stribeck_curve(self.static, self.kinetic, self.velocity, 2.0, 0.0, speed))
        by_state = -self.stiffness * speed / curve
        return Linearised(self.damping + self.viscous, self.stiffness + self.damping * by_state, 1.0, by_state)

    def __str__(self) -> str:
        return f"LuGre, {self.static:.4g} to {self.kinetic:.4g}, bristles {self.stiffness:.3g} 1/m"
