"""Friction that depends on slip velocity and on the age of the contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..bodies.modes import Array
from ..checks import choice, positive
from .linearised import Linearised


@dataclass(frozen=True)
class RateAndState:
    """Rate-and-state friction (Dieterich 1979; Ruina 1983, J. Geophys. Res. 88), regularised at rest.

    With the slip velocity V, the state theta [s], ``D = slip_distance``, ``V0 = velocity`` (Rice & Ben-Zion 1996)::

        tangential / normal force = a asinh( V / (2 V0) exp((reference + b ln(V0 theta / D)) / a) )
        aging:  theta' = 1 - |V| theta / D
        slip:   theta' = -|V| theta / D ln(|V| theta / D)

    which is ``reference + a ln(V/V0) + b ln(V0 theta/D)`` wherever the contact slides forward. The state moves exactly
    over a step at constant slip velocity. There is no exact sticking: a contact counts as sticking while its slip speed
    is below `velocity`. An open contact forgets its state.

    Parameters
    ----------
    reference : float
        Coefficient of friction in steady sliding at `velocity` [1].
    a, b : float
        Direct effect of the slip velocity and effect of the state [1]; weakening where ``b > a``.
    slip_distance : float
        Slip over which the state changes [m].
    velocity : float
        Reference slip velocity [m/s].
    evolution : {"aging", "slip"}, optional
        Law of evolution of the state, Dieterich's or Ruina's.
    initial_state : float, optional
        State at the start [s]; that of steady sliding at `velocity`, ``slip_distance / velocity``, if left out.
    """

    law: ClassVar[str] = "rate and state"
    state_units: ClassVar[str] = "s"
    reference: float
    a: float
    b: float
    slip_distance: float
    velocity: float
    evolution: str = "aging"
    initial_state: float | None = None

    def __post_init__(self) -> None:
        for name in ("reference", "a", "b", "slip_distance", "velocity"):
            positive(name, getattr(self, name))
        choice("evolution", self.evolution, ("aging", "slip"))
        if self.initial_state is not None:
            positive("initial_state", self.initial_state)

    @property
    def state_at_start(self) -> float:
        """State of a new contact [s]."""
        return float(self.slip_distance / self.velocity if self.initial_state is None else self.initial_state)

    def coefficient_at(self, velocity: Array | float) -> Array:
        """Return tangential over normal force [1] in steady sliding at `velocity` [m/s], 0 at rest."""
        speed = np.abs(np.asarray(velocity, dtype=float))
        moving = np.where(speed == 0.0, self.velocity, speed) / self.velocity
        exponent = (self.reference - self.b * np.log(moving)) / self.a + np.log(moving / 2.0)
        # asinh(exp(x)) without overflow.
        ratio = self.a * np.where(exponent > 30.0, exponent + np.log(2.0), np.arcsinh(np.exp(np.minimum(exponent, 30))))
        return np.where(speed == 0.0, 0.0, ratio)

    def linearised_at(self, velocity: float) -> Linearised:
        """Return small changes about steady sliding at `velocity` [m/s], not 0, where ``theta = D / |V|``."""
        speed = abs(velocity)
        # u / sqrt(1 + u²) of asinh's argument u, which is 1 but where regularised.
        share = float(np.tanh(self.coefficient_at(speed) / self.a))
        return Linearised(
            slope=self.a * share / speed,
            by_state=self.b * share * speed / self.slip_distance,
            state_by_velocity=-1.0 / speed,
            state_by_state=-speed / self.slip_distance,
        )

    def __str__(self) -> str:
        return f"rate and state ({self.evolution}), {self.reference:.4g}, a {self.a:.3g}, b {self.b:.3g}"
