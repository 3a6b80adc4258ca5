"""A law of friction close to steady sliding."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Linearised:
    """Small changes of tangential over normal force, and of the internal state, about steady sliding forward.

    With changes v of the slip velocity and z of the state::

        change of the ratio = slope v + by_state z,    z' = state_by_velocity v + state_by_state z

    Attributes
    ----------
    slope : float
        Change of the ratio with the slip velocity [s/m]; below zero where friction weakens.
    by_state : float
        Change of the ratio with the state, in one over its unit; zero without a state.
    state_by_velocity : float
        How the slip velocity moves the state, in its unit per metre.
    state_by_state : float
        How the state moves itself [1/s], below zero.
    """

    slope: float = 0.0
    by_state: float = 0.0
    state_by_velocity: float = 0.0
    state_by_state: float = 0.0
