"""Departure of neighbouring motions from a motion, period by period: the largest Lyapunov exponent."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

import numpy as np

from ..integration.period_map import PeriodMap
from ..integration.state_vectors import StateVectors
from .returning import PERTURBED, Orbit, Return

# Periods over which departure is measured, after those in which its direction settles.
MEASURED, SETTLING = 40, 10
# Factor in a period below which neighbours count as having met: smaller ones are lost in round-off.
MET = 1e-6
# Size of a motion at least, relative to its state: without one, distances would be lost in round-off.
AT_REST = 1e-3
SEED = 1


def departure(of_period: PeriodMap, vectors: StateVectors, orbit: Orbit) -> float:
    """Return the rate [1/s] at which neighbouring motions depart: the largest Lyapunov exponent, over some periods.

    Raises
    ------
    MarchEnded
        If a march ends within a period.
    """
    grown = list(islice(growths(of_period, vectors, orbit), SETTLING, SETTLING + MEASURED))
    return float(np.sum(grown)) / (MEASURED * orbit.period) if len(grown) == MEASURED else -np.inf


def growths(of_period: PeriodMap, vectors: StateVectors, orbit: Orbit) -> Iterator[float]:
    """Yield the logarithm of the factor by which a neighbour departs in each period, by Benettin's method.

    Neighbours are marched like the motion itself, from states next to it, and brought back to their first distance
    after each period. None follow once they have met the motion.

    Raises
    ------
    MarchEnded
        If a march ends within a period.
    """
    now = Return.of(of_period, vectors, orbit)
    distance = PERTURBED * (max(now.size, AT_REST * vectors.norm(orbit.vector)) or 1.0)
    direction = vectors.random(SEED, orbit.vector)
    direction = direction / vectors.norm(direction)
    while True:
        beside = orbit._replace(vector=orbit.vector + distance * direction)
        change = (Return.of(of_period, vectors, beside).end - now.end) / distance
        size = vectors.norm(change)
        if not size > MET:
            return
        yield float(np.log(size))
        direction = change / size
        orbit = Orbit(now.end, orbit.period, now.status_after)
        now = Return.of(of_period, vectors, orbit)
