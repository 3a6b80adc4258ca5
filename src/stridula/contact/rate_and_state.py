"""Friction that depends on slip velocity and on the age of the contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np

from ..arrays import Array
from ..declared import Choice, Length, PositiveRatio, Speed, Time
from .friction_law import FrictionLaw
from .linearised import Linearised


@dataclass(frozen=True)
class RateAndState(FrictionLaw):
    """Rate-and-state friction (Dieterich 1979; Ruina 1983, J. Geophys. Res. 88), regularised at rest.

    With the slip velocity V, the state theta [s], ``D = slip_distance``, ``V0 = velocity`` (Rice & Ben-Zion 1996)::

        tangential / normal force = a asinh( V / (2 V0) exp((reference + b ln(V0 theta / D)) / a) )
        aging:  theta' = 1 - |V| theta / D
        slip:   theta' = -|V| theta / D ln(|V| theta / D)

    which is ``reference + a ln(V/V0) + b ln(V0 theta/D)`` while the contact slides forward. The state is integrated
    exactly over a step at constant slip velocity. There is no exact sticking: a contact counts as sticking while its
    slip speed is below `velocity`. The state is reset when a contact opens.

    Parameters
    ----------
    reference : float
        Coefficient of friction in steady sliding at `velocity` [1].
    a : float
        Direct effect of the slip velocity [1].
    b : float
        Effect of the state [1]; friction weakens where ``b > a``.
    slip_distance : float
        Slip over which the state changes [m].
    velocity : float
        Reference slip velocity [m/s].
    evolution : {"aging", "slip"}, optional
        Law of evolution of the state: aging (Dieterich's) or slip (Ruina's).
    initial_state : float, optional
        State at the start [s]; if left out that of steady sliding at `velocity`, ``slip_distance / velocity``.
    """

    law: ClassVar[str] = "rate and state"
    set_valued: ClassVar[bool] = False
    over_decades: ClassVar[bool] = True
    state_units: ClassVar[str] = "s"
    state_is_positive: ClassVar[bool] = True
    reference: PositiveRatio
    a: PositiveRatio
    b: PositiveRatio
    slip_distance: Length
    velocity: Speed
    evolution: Annotated[str, Choice(("aging", "slip"))] = "aging"
    initial_state: Time | None = None

    @property
    def state_at_start(self) -> float:
        """State of a new contact [s]."""
        return float(self.slip_distance / self.velocity if self.initial_state is None else self.initial_state)

    @property
    def state_at_landing(self) -> float:
        """State of a contact that closes later [s]: that of a new one."""
        return self.state_at_start

    def state_in_sliding(self, velocity: float, change: float = 0.0) -> float:
        """Return the state [s] in steady sliding at `velocity` [m/s], not 0, plus `change`."""
        return self.slip_distance / abs(velocity) + change

    @property
    def kernel_code(self) -> str:
        """Name of its constant in the layout of the march, one for each law of evolution."""
        return self.evolution.upper()

    def parameters(self) -> dict[str, float]:
        """Return the parameters of the law in the march."""
        own = {"reference": self.reference, "a": self.a, "b": self.b}
        return {**own, "slip_distance": self.slip_distance, "velocity": self.velocity}

    @property
    def reach(self) -> float:
        """Slip speed [m/s] up to which its curve is characteristic, for plots."""
        return 1e4 * self.velocity

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s], 0 at rest."""
        speed = np.abs(np.asarray(velocity, dtype=float))
        moving = np.where(speed == 0.0, self.velocity, speed) / self.velocity
        exponent = (self.reference - self.b * np.log(moving)) / self.a + np.log(moving / 2.0)
        # asinh(exp(x)) without overflow.
        ratio = self.a * np.where(exponent > 30.0, exponent + np.log(2.0), np.arcsinh(np.exp(np.minimum(exponent, 30))))
        return np.where(speed == 0.0, 0.0, ratio)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return the law linearised about steady sliding at `velocity` [m/s], not 0, where ``theta = D / |V|``."""
        speed = abs(velocity)
        # u / sqrt(1 + u²) for the argument u of asinh; it is 1 except in the regularised range.
        share = float(np.tanh(self.coefficient_at(speed) / self.a))
        return Linearised(
            slope=self.a * share / speed,
            by_state=self.b * share * speed / self.slip_distance,
            state_by_velocity=-1.0 / speed,
            state_by_state=-speed / self.slip_distance,
        )

    def __str__(self) -> str:
        return f"rate and state ({self.evolution}), {self.reference:.4g}, a {self.a:.3g}, b {self.b:.3g}"
