"""Branches of periodic motions over a parameter, by pseudo-arclength continuation through folds."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from math import ceil
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..integration.period_map import MarchEnded, PeriodMap
from ..integration.state_vectors import StateVectors
from ..lowering import Assembly
from .drive_periods import drive_period
from .linearised import Condition, Linearised
from .newton import closed_orbit
from .returning import Orbit, Return

# Change of the parameter, relative to its range, for the derivative.
PERTURBED = 1e-6
# Largest change of the parameter in a search, relative to its range.
STRAY = 0.5
# Most steps of Newton's method for a point, and those up to which the next point may lie farther away.
MOST_STEPS, EASY = 10, 4
# Factors of the distance to the next point after an easy point and after one that was not found.
LONGER, SHORTER = 1.4, 0.4
# Shortest distance to the next point, relative to the longest.
SHORTEST = 3e-4
# Steps of a period may be this much longer or shorter than the first ones.
COARSER, FINER = 1.3, 0.6

# Cosine of the angle by which a branch may turn from point to point.
BENT = 0.8
# Changes of the size at a corner, relative to it; cosine of the angle up to which a point lies back along the branch.
CORNERS, SAME_WAY = (-0.01, 0.01, -0.003, 0.003, -0.03, 0.03), 0.98

AssemblyOf = Callable[[float], Assembly]


class Point(NamedTuple):
    """A periodic motion on a branch.

    Attributes
    ----------
    value : float
        Value of the parameter.
    cycle : Return
        The motion.
    is_round_corner : bool, optional
        Whether a corner, as at a grazing, lies between the last point and this one.
    """

    value: float
    cycle: Return
    is_round_corner: bool = False


class NotFound(Exception):
    """No periodic motion was found for a point; the message has the reason in words."""


@dataclass
class Branch:
    """The continuation of a branch.

    Attributes
    ----------
    assembly_of : callable
        Function of a value that returns the system as flat arrays.
    scale : float
        Range of the parameter.
    tolerance : float
        Largest residual of a point [1].
    is_driven : bool
        Whether drives prescribe the period.
    step : float
        Time step at the beginning [s].
    size : float
        Size of the motion at the beginning, in the norm of energy.
    """

    assembly_of: AssemblyOf
    scale: float
    tolerance: float
    is_driven: bool
    step: float
    size: float

    def at(self, value: float, near: Return) -> Point:
        """Return the periodic motion at a value of the parameter near another one.

        Raises
        ------
        NotFound
            If there is none.
        """
        start = self._moved(near.of_period, value, near.orbit.vector, near.orbit.period, near)
        try:
            found = closed_orbit(
                start.of_period, start.vectors, start.orbit, self.is_driven, self.tolerance, lambda *_: None, MOST_STEPS
            )
        except MarchEnded as error:
            raise NotFound(str(error)) from None
        if not found.is_periodic:
            raise NotFound(found.reason)
        return Point(value, found.best)

    def beyond(self, before: Point, last: Point, distance: float) -> tuple[Point, int]:
        """Return the point at a distance beyond the last one, and the number of steps of Newton's method.

        The distance is measured along the line through the last two points, in the norm of energy relative to the size
        of the motion, and in the parameter relative to its range; the point lies in the plane across that line.

        Raises
        ------
        NotFound
            If there is none.
        """
        came, length = self._way(before, last)
        point, steps = self._across(before, last, 1.0 + distance / length)
        goes, far = self._way(last, point)
        if came @ goes < BENT * length * far:
            raise NotFound("the branch bends too much")
        return point, steps

    def between(self, one: Point, other: Point, share: float) -> Point:
        """Return the point in the plane across the line between two others, at a share of the way.

        Raises
        ------
        NotFound
            If there is none.
        """
        return self._across(one, other, share)[0]

    def _across(self, one: Point, other: Point, share: float) -> tuple[Point, int]:
        """Return the point in the plane across the line through two others, and the number of Newton's steps."""
        orbit, there = one.cycle.orbit, other.cycle.orbit
        change, rise = there.vector - orbit.vector, other.value - one.value
        squared = float((rise / self.scale) ** 2 + (other.cycle.vectors.norm(change) / self.size) ** 2)
        along = Condition(change / (self.size**2 * squared), [rise / (self.scale**2 * squared)])
        return self._corrected(
            orbit.vector + share * change,
            orbit.period + share * (there.period - orbit.period),
            one.value + share * rise,
            along,
            other.cycle,
        )

    def round_corner(self, points: Sequence[Point]) -> Point | None:
        """Return a point on the other side of a corner at the last point, None if none is found.

        At a grazing two branches meet at an angle. Motions of another size than the last one are tried, with the
        parameter free; one in the direction from which the branch comes is not another branch.
        """
        last = points[-1]
        swing = last.cycle.swing
        along = Condition(swing / last.cycle.vectors.norm(swing) ** 2, [0.0])
        for share in CORNERS:
            vector = last.cycle.orbit.vector + share * swing
            try:
                found, _ = self._corrected(vector, last.cycle.orbit.period, last.value, along, last.cycle)
            except NotFound:
                continue
            if self._turns(points, found):
                return found
        return None

    def _turns(self, points: Sequence[Point], found: Point) -> bool:
        """Return whether a point does not lie back along a branch, seen from its end."""
        last = points[-1]
        way, far = self._way(last, found)
        back = [self._way(last, one) for one in points[:-1]]
        there, distance = min(back, key=lambda one: abs(np.log(one[1] / far)))
        return bool(way @ there < SAME_WAY * far * distance)

    def _way(self, origin: Point, other: Point) -> tuple[Array, float]:
        """Return the way from a point to another, in state but for its phase and in the parameter, and its length."""
        counted = origin.cycle.vectors.counted
        change, flow = counted(other.cycle.orbit.vector - origin.cycle.orbit.vector), counted(origin.cycle.flow)
        if not self.is_driven:
            change = change - flow * (flow @ change)
        way = np.append(change / self.size, (other.value - origin.value) / self.scale)
        return way, float(np.linalg.norm(way))

    def _corrected(
        self, vector: Array, period: float, value: float, along: Condition, near: Return
    ) -> tuple[Point, int]:
        """Return the periodic motion next to a guess, in the plane across a direction."""
        guessed = value
        try:
            now = self._moved(near.of_period, value, vector, period, near)
            for number in range(MOST_STEPS):
                if now.residual < self.tolerance:
                    return Point(value, now), number
                by_value = self._by_value(now, value)
                others, conditions = [by_value], [along]
                if not self.is_driven:
                    others = [now.by_period(), by_value]
                    conditions = [Condition(now.flow, [0.0, 0.0]), Condition(along.state, [0.0, *along.factors])]
                step = Linearised.of(now, others, conditions, [by_value]).step()
                value += step.amounts[-1]
                period += 0.0 if self.is_driven else step.amounts[0]
                if not 0.2 * near.orbit.period < period < 5.0 * near.orbit.period:
                    raise NotFound("the period does not stay near")
                if not abs(value - guessed) < STRAY * self.scale:
                    raise NotFound("the parameter does not stay near")
                now = self._moved(near.of_period, value, step.vector, period, now)
                if not now.residual < np.inf:
                    break
        except MarchEnded as error:
            raise NotFound(str(error)) from None
        raise NotFound("the search does not come nearer")

    def _moved(self, of_period: PeriodMap, value: float, vector: Array, period: float, near: Return) -> Return:
        """Return a motion at a value of the parameter after its period."""
        try:
            flat = self.assembly_of(value)
        except ValueError as error:
            raise NotFound(str(error)) from None
        if flat.mode_count != len(near.vectors.arrays.angular_frequency):
            raise NotFound(f"the number of modes changes at {value:.6g}")
        if self.is_driven:
            period = self._multiple(near) * float(drive_period(flat) or 0.0)
        moved = replace(of_period, arrays=flat, kept={})
        vectors = StateVectors(flat, near.vectors.period)
        vectors.of_states = near.vectors.of_states
        return Return.of(moved, vectors, Orbit(vector, period, near.status_after))

    def _multiple(self, near: Return) -> int:
        """Return the number of periods of the drives in that of a motion."""
        return round(near.orbit.period / float(drive_period(near.vectors.arrays) or near.orbit.period))

    def _by_value(self, now: Return, value: float) -> Array:
        """Return the derivative of the state after the period with respect to the parameter."""
        amount = PERTURBED * self.scale
        there = self._moved(now.of_period, value + amount, now.orbit.vector, now.orbit.period, now)
        return (there.end - now.end) / amount

    def resized(self, point: Point) -> Point:
        """Return a point with steps of about the first length, found anew if their number changes."""
        cycle = point.cycle
        if FINER * self.step < cycle.step < COARSER * self.step:
            return point
        steps = ceil(cycle.orbit.period / self.step)
        turns = cycle.of_period.first_step // cycle.of_period.steps
        of_period = replace(cycle.of_period, steps=steps, first_step=turns * steps, kept={})
        found = self.at(point.value, Return.of(of_period, cycle.vectors, cycle.orbit))
        return found._replace(is_round_corner=point.is_round_corner)


def followed(branch: Branch, points: list[Point], longest: float) -> Iterator[Point]:
    """Yield and append the points of a branch beyond its last two, through folds and round corners.

    The distances adapt to the branch.

    Raises
    ------
    NotFound
        If the branch cannot be followed any farther.
    """
    distance = longest
    while True:
        try:
            point, steps = branch.beyond(points[-2], points[-1], distance)
        except NotFound:
            distance *= SHORTER
            if distance > SHORTEST * longest:
                continue
            if points[-1].cycle.size < longest * branch.size:
                raise
            turned = branch.round_corner(points)
            if turned is None:
                raise
            point, steps, distance = turned._replace(is_round_corner=True), EASY, longest * abs(CORNERS[0])
        if steps <= EASY:
            distance = min(longest, distance * LONGER)
        points.append(branch.resized(point))
        yield points[-1]
