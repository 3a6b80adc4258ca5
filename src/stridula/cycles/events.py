"""Events on a branch of periodic motions: folds, changes of stability, grazings; each located between two points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from .branch import Branch, NotFound, Point
from .floquet import FOLD, Multipliers

GRAZING, HOPF = "grazing", "Hopf"
# Width of the interval in which a change of stability lies in the end, relative to the range of the parameter, and most
# points for it.
WIDTH, MOST = 1e-4, 14
# Points by which a fold is located.
PASSES = 3

MultipliersOf = Callable[[Point], Multipliers]


class Event(NamedTuple):
    """An event on a branch.

    Attributes
    ----------
    kind : str
        Fold, period doubling, Neimark-Sacker, grazing or Hopf.
    value : float
        Value of the parameter.
    frequency : float
        Frequency of the cycle there [Hz].
    """

    kind: str
    value: float
    frequency: float

    @classmethod
    def at(cls, kind: str, point: Point) -> Event:
        """Return an event at a point of a branch."""
        return cls(kind, point.value, 1.0 / point.cycle.orbit.period)


def events_between(branch: Branch, points: Sequence[Point], multipliers_of: MultipliersOf) -> list[Event]:
    """Return the events at the last point but one of a branch, or between the last two.

    Parameters
    ----------
    branch : Branch
        The branch.
    points : sequence of Point
        Its last points, four of them if there are as many.
    multipliers_of : callable
        Function of a point that returns its multipliers.
    """
    *_, before, last = points
    if last.is_round_corner:
        return []
    if before.is_round_corner:
        return [_corner(*points)]
    found = []
    if len(points) > 2 and _turns_back(*points[-3:]):
        found.append(Event.at(FOLD, _fold(branch, *points[-3:])))
    stable = [multipliers_of(one).is_stable for one in (before, last)]
    if stable[0] != stable[1]:
        change = _change(branch, before, last, multipliers_of)
        # At a fold a multiplier passes 1.
        if change.kind != FOLD:
            found.append(change)
    return found


def _corner(first: Point, second: Point, third: Point, last: Point) -> Event:
    """Return the corner at which the lines through two points before it and two points after it meet."""
    sizes = np.array([one.cycle.size for one in (first, second, third, last)])
    values = np.array([one.value for one in (first, second, third, last)])
    before, after = (values[1] - values[0]) / (sizes[1] - sizes[0]), (values[3] - values[2]) / (sizes[3] - sizes[2])
    size = (values[2] - values[1] + before * sizes[1] - after * sizes[2]) / (before - after)
    return Event(GRAZING, float(values[1] + before * (size - sizes[1])), 1.0 / second.cycle.orbit.period)


def birth(points: Sequence[Point]) -> Event:
    """Return the Hopf bifurcation from which a branch begins whose motion dies away at its end.

    The square of the size grows in proportion to the distance of the parameter from it.
    """
    before, last = points[-2:]
    small, large = last.cycle.size**2, before.cycle.size**2
    return Event(
        HOPF, last.value - small * (before.value - last.value) / (large - small), 1.0 / last.cycle.orbit.period
    )


def _turns_back(first: Point, middle: Point, last: Point) -> bool:
    return (middle.value - first.value) * (last.value - middle.value) < 0.0


def _fold(branch: Branch, first: Point, middle: Point, last: Point) -> Point:
    """Return the point of a branch with the largest or smallest value between three points."""
    sign = np.sign(middle.value - first.value)
    places, points = [-1.0, 0.0, 1.0], [first, middle, last]
    for _ in range(PASSES):
        a, b, _ = np.polyfit(places, [one.value for one in points], 2)
        place = float(np.clip(-0.5 * b / a, -0.9, 0.9)) if a else 0.0
        side = (middle, last) if place > 0.0 else (middle, first)
        try:
            found = branch.between(*side, abs(place))
        except NotFound:
            break
        keep = sorted(zip([*places, place], [*points, found], strict=True), key=lambda one: abs(one[0] - place))[:3]
        if len({round(one[0], 9) for one in keep}) < 3:
            break
        places, points = [list(each) for each in zip(*keep, strict=True)]
    return max(points, key=lambda one: sign * one.value)


def _change(branch: Branch, before: Point, last: Point, multipliers_of: MultipliersOf) -> Event:
    """Return the change of stability between two points, by bisection."""
    stable, unstable = (before, last) if multipliers_of(before).is_stable else (last, before)
    for _ in range(MOST):
        if abs(stable.value - unstable.value) < WIDTH * branch.scale:
            break
        try:
            middle = branch.between(stable, unstable, 0.5)
        except NotFound:
            break
        if multipliers_of(middle).is_stable:
            stable = middle
        else:
            unstable = middle
    return Event.at(multipliers_of(unstable).kind, unstable)
