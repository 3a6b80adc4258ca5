"""Friction laws linearised about steady sliding."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Linearised:
    """Linear changes of tangential over normal force, and of the internal state, about steady sliding forward.

    With changes v of the slip velocity and z of the state::

        change of the ratio = slope v + by_state z,    z' = state_by_velocity v + state_by_state z

    Attributes
    ----------
    slope : float
        Change of the ratio with the slip velocity [s/m]; below zero where friction weakens.
    by_state : float
        Change of the ratio with the state, in the inverse of its unit; zero without a state.
    state_by_velocity : float
        Rate of the state per slip velocity, in its unit per metre.
    state_by_state : float
        Rate of the state per state [1/s], below zero.
    """

    slope: float = 0.0
    by_state: float = 0.0
    state_by_velocity: float = 0.0
    state_by_state: float = 0.0
