"""LuGre's law: friction as the mean deflection of elastic bristles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..bodies.modes import Array
from ..checks import finite, non_negative, positive
from .coulomb import check_static
from .linearised import Linearised
from .weakening import stribeck_curve, stribeck_slope


@dataclass(frozen=True)
class LuGre:
    """LuGre friction (Canudas de Wit, Olsson, Åström & Lischinsky 1995, IEEE Trans. Automatic Control 40).

    With the slip velocity v and the bristles' deflection z::

        z' = v - stiffness |v| z / g(v),    g(v) = kinetic + (static - kinetic) exp(-(v / velocity)²)
        tangential force = normal force * (stiffness z + damping z' + viscous v)

    All coefficients are per unit of normal force. The deflection moves exactly over a step at constant slip velocity
    and the force is solved for together with the contact, so that the step need not resolve the bristles. There is no
    exact sticking: a contact counts as sticking while its slip speed is below `velocity`. An open contact forgets its
    bristles. `friction_loss` includes what the bristles store.

    Parameters
    ----------
    static : float
        Coefficient of friction at which the bristles give way at low speed [1], at least `kinetic`.
    kinetic : float
        Coefficient of friction in fast sliding [1], above 0.
    velocity : float
        Stribeck's velocity [m/s].
    stiffness : float
        Stiffness of the bristles, sigma0 [1/m].
    damping : float, optional
        Damping of the bristles, sigma1 [s/m].
    viscous : float, optional
        Rise with speed, sigma2 [s/m].
    initial_state : float, optional
        Deflection of the bristles at the start [m]; in steady sliding at v it is ``sign(v) g(v) / stiffness``.
    """

    law: ClassVar[str] = "lugre"
    state_units: ClassVar[str] = "m"
    static: float
    kinetic: float
    velocity: float
    stiffness: float
    damping: float = 0.0
    viscous: float = 0.0
    initial_state: float = 0.0

    def __post_init__(self) -> None:
        check_static(self.static, positive("kinetic", self.kinetic))
        positive("velocity", self.velocity)
        positive("stiffness", self.stiffness)
        non_negative("damping", self.damping)
        non_negative("viscous", self.viscous)
        finite("initial_state", self.initial_state)

    @property
    def state_at_start(self) -> float:
        """Deflection of the bristles at the start [m]; those of a contact that lands later are straight."""
        return self.initial_state

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s], 0 at rest."""
        curve = stribeck_curve(self.static, self.kinetic, self.velocity, 2.0, self.viscous, velocity)
        return np.where(np.asarray(velocity) == 0.0, 0.0, curve)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return small changes about steady sliding at `velocity` [m/s], not 0, where ``z = g(v) / stiffness``."""
        speed = abs(velocity)
        curve = float(stribeck_curve(self.static, self.kinetic, self.velocity, 2.0, 0.0, speed))
        slope = stribeck_slope(self.static, self.kinetic, self.velocity, 2.0, 0.0, speed)
        by_velocity, by_state = speed * slope / curve, -self.stiffness * speed / curve
        return Linearised(
            self.damping * by_velocity + self.viscous, self.stiffness + self.damping * by_state, by_velocity, by_state
        )

    def __str__(self) -> str:
        return f"LuGre, {self.static:.4g} to {self.kinetic:.4g}, bristles {self.stiffness:.3g} 1/m"
