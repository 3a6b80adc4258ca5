"""Periodic motions by Newton's method on the march of a period, with products of its derivative alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ..integration.period_map import MarchEnded, PeriodMap
from ..integration.state_vectors import StateVectors
from .linearised import Condition, Linearised
from .returning import Orbit, Return

# Most steps of the method, and steps in a row that may fail to reduce the residual to this share.
MOST_STEPS, VAIN, ENOUGH = 60, 6, 0.7
# Longest first step, relative to the size of the motion; factors of the longest step after one whose residual falls
# nearly as that of the linearised motion, and after one whose residual does not; shares of its fall between these.
LONGEST, LONGER, SHORTER = 0.2, 2.5, 0.4
WELL, BADLY, VAINLY = 0.6, 0.25, 0.05
# Most steps that are tried from an orbit.
MOST_TRIED = 8
# Size of a motion, relative to that at the start and to its state, below which it has died away.
FAINT, ROUND_OFF = 1e-6, 1e-11
# Change of the period in a step, as a factor.
CHANGE = 2.0
# Residual, relative to the part of a period that a step is, that a jump within a step may leave.
OF_A_STEP = 0.1

# Called with the number of each step of the method, its residual, and the periods marched so far.
Tell = Callable[[int, float, float], None]


@dataclass
class Found:
    """Result of a search for a periodic motion.

    Attributes
    ----------
    best : Return
        Motion with the smallest residual.
    residuals : list of float
        Residual after each step of the method.
    reason : str
        Reason for the end of the search, empty if the motion is periodic to the tolerance.
    """

    best: Return
    residuals: list[float] = field(default_factory=list)
    reason: str = ""

    @property
    def is_periodic(self) -> bool:
        """Whether the motion is periodic to the tolerance."""
        return not self.reason


def closed_orbit(
    of_period: PeriodMap,
    vectors: StateVectors,
    orbit: Orbit,
    is_driven: bool,
    tolerance: float,
    tell: Tell,
    steps: int = MOST_STEPS,
    most: float = np.inf,
) -> Found:
    """Search for a periodic motion near an orbit.

    Parameters
    ----------
    of_period : PeriodMap
        March of a period.
    vectors : StateVectors
        States as vectors.
    orbit : Orbit
        Start of the search.
    is_driven : bool
        Whether drives prescribe the period.
    tolerance : float
        Largest residual [1].
    tell : callable
        Called with the progress.
    steps : int, optional
        Most steps of the method.
    most : float, optional
        Periods marched after which no further step begins.

    Raises
    ------
    MarchEnded
        If the march of the start ends within a period.
    """
    now = Return.of(of_period, vectors, orbit)
    _weigh(now)
    found, first = Found(now, [now.residual]), now
    longest, vain = LONGEST * now.size, 0
    for number in range(steps):
        tell(number, now.residual, of_period.counter.marched)
        if now.residual < tolerance:
            return found
        if not now.size > max(FAINT * first.size, ROUND_OFF * vectors.norm(now.orbit.vector)):
            found.reason = "the motion dies away to rest or to steady sliding"
            return found
        now, longest = _improved(now, is_driven, longest)
        vain = 0 if now.residual < ENOUGH * found.best.residual else vain + 1
        found.residuals.append(now.residual)
        if now.residual < found.best.residual:
            found.best = now
        if of_period.counter.marched > most:
            break
        if vain == VAIN or (vain > 1 and _is_within_a_step(found.best)):
            break
    if found.best.residual >= tolerance and not _is_within_a_step(found.best):
        found.reason = "the search does not come nearer"
    return found


def _weigh(now: Return) -> None:
    """Give the internal states of friction laws the weight of the motion's energy."""
    if any(contact.contact.law.has_state for contact in now.vectors.arrays.contacts):
        now.vectors.weigh_states(now.passed.friction_states, now.size**2)


def _is_within_a_step(now: Return) -> bool:
    """Return whether a motion is periodic as far as steps can tell: contacts jump at a step, not within it."""
    return now.residual < OF_A_STEP * 2.0 * np.pi / now.of_period.steps


def _improved(now: Return, is_driven: bool, longest: float) -> tuple[Return, float]:
    """Return the orbit after a step of Newton's method, and the longest next one.

    The longest step follows the accuracy of the linearised motion (a trust region).
    """
    others, conditions = ([], []) if is_driven else ([now.by_period()], [Condition(now.flow, [0.0])])
    linearised = Linearised.of(now, others, conditions)
    best: Return | None = None
    for _ in range(MOST_TRIED):
        step = linearised.step(longest)
        period = now.orbit.period + (step.amounts[0] if step.amounts else 0.0)
        tried = _tried(now, Orbit(step.vector, period, now.status_after))
        fall = -np.inf if tried is None else (now.residual - tried.residual) / max(now.residual - step.left, 1e-300)
        if tried is not None and (best is None or tried.residual < best.residual):
            best = tried
        if fall < BADLY:
            longest = SHORTER * min(longest, step.length)
        elif fall > WELL and step.length > 0.8 * longest:
            longest *= LONGER
        if fall > VAINLY:
            break
    if best is None:
        raise MarchEnded("no step of the method could be marched")
    return best, longest


def _tried(now: Return, orbit: Orbit) -> Return | None:
    """Return an orbit and its march, None if it cannot be marched."""
    if not 1.0 / CHANGE < orbit.period / now.orbit.period < CHANGE:
        return None
    try:
        tried = Return.of(now.of_period, now.vectors, orbit)
    except MarchEnded:
        return None
    return tried if np.isfinite(tried.residual) else None
