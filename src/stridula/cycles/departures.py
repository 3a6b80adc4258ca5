"""Departure of neighbouring motions from a motion that does not repeat: torus or chaos."""

from __future__ import annotations

import numpy as np

from ..integration.period_map import PeriodMap
from ..integration.state_vectors import StateVectors
from .returning import PERTURBED, Orbit, Return

# Periods over which departure is measured, after those in which its direction settles.
MEASURED, SETTLING = 40, 10
SEED = 1


def departure(of_period: PeriodMap, vectors: StateVectors, orbit: Orbit) -> float:
    """Return the rate [1/s] at which neighbouring motions depart: the largest Lyapunov exponent, over some periods.

    Raises
    ------
    MarchEnded
        If a march ends within a period.
    """
    step = orbit.period / of_period.steps
    now = Return.of(of_period, vectors, orbit)
    direction = vectors.random(SEED, orbit.vector)
    grown = 0.0
    for number in range(SETTLING + MEASURED):
        change = now.product(direction)
        size = vectors.norm(change)
        if not size > PERTURBED * vectors.norm(direction):
            return -np.inf
        if number >= SETTLING:
            grown += float(np.log(size / vectors.norm(direction)))
        direction = change / size
        now = Return.of(
            of_period, vectors, Orbit(vectors.vector(now.passed.state, step), orbit.period, now.status_after)
        )
    return grown / (MEASURED * orbit.period)
