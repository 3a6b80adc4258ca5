"""The part of a motion that repeats: its mean over many periods, where a second tone or chaos is on top of it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..arrays import Array
from ..integration.period_map import Passed, PeriodMap
from ..integration.state_vectors import StateVectors
from .returning import Orbit, Return

# Periods over which the mean is taken, and steps after which all that contacts carry follows a mean.
PERIODS, PAST = 60, 5
# Most means that follow one another, residual from which no other one follows, and most in a row that are no nearer.
MEANS, NEAR, VAIN = 10, 2e-3, 3
# Difference of a motion from itself a period later, relative to its size, above which its mean is nearer to a cycle.
FAR = 0.05
# Growth of a motion in a period, relative to its size, above which it is marched on; periods between two looks at it,
# and most periods marched.
GROWING, BETWEEN, LONGEST = 0.005, 10, 200


def repeating(of_period: PeriodMap, vectors: StateVectors, orbit: Orbit, is_driven: bool) -> Orbit:
    """Return an orbit or, if that is nearer to a periodic one, the mean at the same phase of many periods.

    Of all tones, only the harmonics of the period remain in such a mean. The period is that of the strongest of them.
    The motion from the mean has less of the other tones, so that its mean is nearer still: around an unstable cycle on
    a torus, a few means lead to it.

    Raises
    ------
    MarchEnded
        If a march ends within a period.
    """
    best = Return.of(of_period, vectors, orbit)
    if best.residual < FAR:
        return orbit
    vain = 0
    for _ in range(MEANS):
        orbit = _mean(of_period, vectors, orbit, is_driven)
        mean = Return.of(of_period, vectors, orbit)
        vain = 0 if mean.residual < best.residual else vain + 1
        best = min(best, mean, key=lambda one: one.residual)
        if best.residual < NEAR or vain == VAIN:
            break
    return best.orbit


def _mean(of_period: PeriodMap, vectors: StateVectors, orbit: Orbit, is_driven: bool) -> Orbit:
    """Return the mean at the same phase of many periods of a motion."""
    if not is_driven:
        orbit = orbit._replace(period=_period(of_period, vectors, orbit))
    step = orbit.period / of_period.steps
    ends = [vectors.vector(passed.state, step) for passed in _periods(of_period, vectors, orbit)]
    modes, last = 2 * vectors.count, ends[-1].copy()
    last[:modes] = np.mean(ends, axis=0)[:modes]
    state = vectors.state(last, step, orbit.status)
    past = of_period.steps if is_driven else PAST
    state = of_period.after(state, orbit.period, past).state
    return Orbit(vectors.vector(state, step), orbit.period, vectors.status(state))


def grown(of_period: PeriodMap, vectors: StateVectors, orbit: Orbit) -> Orbit:
    """Return a motion once it no longer grows: from a small one, Newton's method would lead to rest.

    Raises
    ------
    MarchEnded
        If a march ends within a period.
    """
    now = Return.of(of_period, vectors, orbit)
    for number in range(LONGEST):
        after = Return.of(of_period, vectors, Orbit(now.end, orbit.period, now.status_after))
        if number % BETWEEN == 0 and after.size <= (1.0 + GROWING) * now.size:
            break
        now = after
    return now.orbit


def _periods(of_period: PeriodMap, vectors: StateVectors, orbit: Orbit) -> Iterator[Passed]:
    """Yield consecutive periods of a motion."""
    state = vectors.state(orbit.vector, orbit.period / of_period.steps, orbit.status)
    for _ in range(PERIODS):
        passed = of_period.after(state, orbit.period)
        state = passed.state
        yield passed


def _period(of_period: PeriodMap, vectors: StateVectors, orbit: Orbit) -> float:
    """Return the period near that of an orbit [s] of which the strongest tone is a harmonic, from its phase."""
    step = orbit.period / of_period.steps
    tones = np.array([_harmonics(vectors, passed, step) for passed in _periods(of_period, vectors, orbit)])
    strongest = int(np.argmax(np.linalg.norm(tones, axis=(0, 2))))
    of_strongest = tones[:, strongest]
    advance = np.angle(np.sum(of_strongest[:-1].conj() * of_strongest[1:])) / (strongest + 1)
    return float(orbit.period / (1.0 + advance / (2.0 * np.pi)))


def _harmonics(vectors: StateVectors, passed: Passed, step: float) -> Array:
    """Return the amplitudes of the first harmonics in a period, shape (harmonics, numbers)."""
    motions = np.array([vectors.counted(vectors.of_modes(one, step)) for one in passed.motions])
    return np.asarray(np.fft.fft(motions, axis=0)[1 : len(motions) // 2])
