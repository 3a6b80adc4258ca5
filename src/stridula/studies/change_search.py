"""Search of the smallest change of parameters after which no mode of sliding grows."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import scipy  # its parts are imported on first use

from ..arrays import Array
from ..bars.line_bars import Show
from ..linear.growth import Growth, Growths
from ..long_tasks import check_wanted
from .changed_systems import Range, Systems

# Members of the population for each parameter.
POPULATION = 10
# Directions tried for each parameter, their first spread [1], width of the interval of a size relative to it [1], and
# largest size tried along other directions, relative to the known one [1].
TURNS, SPREAD, WIDTH, LONGER = 20, 0.15, 1e-3, 1.2
# Size of a change that silences nothing [1], above any other.
NOTHING = 1e3
# Sizes tried along each direction at first.
ALONG = 12


@dataclass(frozen=True)
class State:
    """Small motions of a system.

    Attributes
    ----------
    growth : float
        Largest growth rate of the modes that vibrate [1/s], minus infinity without one.
    kind : str
        Kind of the equilibrium.
    round_off : float
        Growth that may be due to rounding [1/s].
    """

    growth: float
    kind: str
    round_off: float

    @property
    def slides(self) -> bool:
        """Whether it slides steadily."""
        return self.kind == "sliding"


@dataclass
class Search:
    """The search, and what it has tried.

    Attributes
    ----------
    systems : Systems
        Systems of changes and conditions.
    over : dict
        Lowest and highest value of each condition.
    margin, velocity, most, seed : optional
        As for `smallest_change`.
    show : callable
        Shows how much is done.
    tried : int
        Number of changes tried in this repetition.
    loud : tuple of float
        Condition at which a mode grew last.
    """

    systems: Systems
    over: dict[str, Range]
    margin: float
    velocity: Any
    most: int
    seed: int
    show: Show
    tried: int = field(default=0, init=False)
    loud: tuple[float, ...] = field(default=(), init=False)
    _growths: Growths = field(default_factory=Growths, init=False)
    _before: dict[tuple[float, ...], State] = field(default_factory=dict, init=False)

    @cached_property
    def names(self) -> list[str]:
        """Names of the parameters."""
        return list(self.systems.given)

    @cached_property
    def widths(self) -> Array:
        """Widths of the ranges of the parameters."""
        return np.array([np.subtract(*self.systems.ranges[name][::-1]) for name in self.names])

    @cached_property
    def bounds(self) -> Array:
        """Smallest and largest change of each parameter over its width, shape (parameters, 2)."""
        given = np.array([self.systems.given[name] for name in self.names])
        ends = np.array([self.systems.ranges[name] for name in self.names])
        return (ends - given[:, None]) / self.widths[:, None]

    def values(self, change: Array) -> dict[str, float]:
        """Return the parameters after a change, within their ranges."""
        given = np.array([self.systems.given[name] for name in self.names])
        low, high = np.array([self.systems.ranges[name] for name in self.names]).T
        return dict(zip(self.names, np.clip(given + change * self.widths, low, high).tolist(), strict=True))

    def grid(self, points: int) -> list[tuple[float, ...]]:
        """Return the conditions of a grid."""
        axes = [np.linspace(low, high, points).tolist() for low, high in self.over.values()]
        return list(itertools.product(*axes))

    def state(self, change: Array, condition: Sequence[float]) -> State:
        """Return the growth after a change at a condition."""
        check_wanted()
        numbers = self.values(change) | dict(zip(self.over, condition, strict=True))
        return _state_of(self._growths.of(self.systems.make(numbers), self.velocity))

    def before(self, condition: tuple[float, ...]) -> State:
        """Return the growth without a change at a condition."""
        if condition not in self._before:
            self._before[condition] = self.state(np.zeros(len(self.names)), condition)
        return self._before[condition]

    def excess(self, change: Array, conditions: Sequence[tuple[float, ...]]) -> float:
        """Return the largest growth above what is allowed [1/s], 0 or below where no mode grows."""
        self.tried += 1
        self.show(float(self.tried), float(self.most), f"{self.tried} changes")
        return max(self.above(self.state(change, one), one) for one in conditions)

    def above(self, state: State, condition: tuple[float, ...]) -> float:
        """Return the growth of a state above what is allowed [1/s]; infinite where it does not slide any longer."""
        if not state.slides:
            return -np.inf if state.kind == self.before(condition).kind else np.inf
        return state.growth + self.margin if self.margin else state.growth - state.round_off

    def smallest(self, conditions: Sequence[tuple[float, ...]], known: Array | None) -> tuple[Array, float]:
        """Return the smallest change for some conditions, or the best one, and the excess of growth after it."""
        self.tried = 0
        none = np.zeros(len(self.names))
        if (given := self.excess(none, conditions)) <= 0.0:
            return none, given
        largest = float(np.linalg.norm(np.abs(self.bounds).max(axis=1)))

        def rank(change: Array) -> float:
            over = self.excess(change, conditions)
            size = float(np.linalg.norm(change))
            return size if over <= 0.0 else largest * (2.0 - 1.0 / (1.0 + over)) + NOTHING

        scanned = self._scanned(conditions, known)
        rounds = max(1, self.most // (2 * POPULATION * len(self.names)) - 1)
        first = known if scanned is None else scanned
        if first is not None:
            first = np.clip(first, *self.bounds.T)
        evolved = scipy.optimize.differential_evolution(
            rank, self.bounds, popsize=POPULATION, maxiter=rounds, tol=1e-3, seed=self.seed, polish=False, x0=first
        )
        best = np.asarray(evolved.x, dtype=float)
        if evolved.fun >= NOTHING:
            return best, self.excess(best, conditions)
        starts = [best] if scanned is None else [best, scanned]
        found = [self._refined(one, conditions) for one in starts]
        return min(found, key=lambda one: float(np.linalg.norm(one[0])))

    def _scanned(self, conditions: Sequence[tuple[float, ...]], known: Array | None) -> Array | None:
        """Return the smallest change along directions all around, some sizes along each; None if a mode always grows.

        Thin regions without growth, which few members of a population meet, begin at some size and mostly go on.
        """
        count = len(self.names)
        ways = np.vstack([np.eye(count), -np.eye(count)])
        if count > 1:
            drawn = scipy.stats.qmc.Halton(count, seed=self.seed).random(self.most // (2 * ALONG) + count)
            ways = np.vstack([ways, scipy.stats.norm.ppf(np.clip(drawn, 1e-9, 1.0 - 1e-9))])
        if known is not None and known.any():
            ways = np.vstack([known, ways])
        best, longest = None, np.inf
        for way in ways / np.linalg.norm(ways, axis=1)[:, None]:
            sizes = min(longest, self._end(way)) * np.arange(1, ALONG + 1) / ALONG
            size = next((one for one in sizes.tolist() if one and self._is_quiet(one * way, conditions)), None)
            if size is not None:
                best, longest = size * way, size
        return best

    def _end(self, way: Array) -> float:
        """Return the largest size of a change along a direction of unit length within the ranges."""
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.where(way > 0.0, self.bounds[:, 1], self.bounds[:, 0]) / way
        return float(np.where(way == 0.0, np.inf, ends).min())

    def _refined(self, change: Array, conditions: Sequence[tuple[float, ...]]) -> tuple[Array, float]:
        """Return the smallest change near a known one: of all directions near its own, that with the smallest size."""
        known = float(np.linalg.norm(change))
        way = change / known
        if change.size > 1:

            def size(direction: Array) -> float:
                return self._size_along(direction, conditions, LONGER * known, WIDTH * known)

            options = {"initial_simplex": _simplex(way), "xatol": WIDTH, "fatol": WIDTH, "maxfev": TURNS * change.size}
            turned = scipy.optimize.minimize(size, way, method="Nelder-Mead", options=options)
            if turned.fun < known:
                way, known = turned.x / np.linalg.norm(turned.x), turned.fun
        # Rounding of the direction may make a mode grow at the known size itself.
        found = way * min(known, self._size_along(way, conditions, known, WIDTH**2))
        return found, self.excess(found, conditions)

    def _size_along(
        self, direction: Array, conditions: Sequence[tuple[float, ...]], longest: float, width: float
    ) -> float:
        """Return the size along a direction from which no mode grows up to the longest size, NOTHING if one does there.

        Parameters
        ----------
        direction : ndarray, shape (parameters,)
            The direction, of any length.
        conditions : sequence of tuple
            The conditions.
        longest : float
            Largest size.
        width : float
            Width of the interval in which the size is found.
        """
        way = direction / np.linalg.norm(direction)
        low, high = 0.0, min(longest, self._end(way))
        if not self._is_quiet(high * way, conditions):
            return NOTHING
        while high - low > width:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self._is_quiet(middle * way, conditions) else (middle, high)
        return high

    def _is_quiet(self, change: Array, conditions: Sequence[tuple[float, ...]]) -> bool:
        """Return whether no mode grows after a change; the condition at which one grew last comes first."""
        self.tried += 1
        self.show(float(self.tried), float(self.most), f"{self.tried} changes")
        for one in sorted(conditions, key=lambda one: one != self.loud):
            if self.above(self.state(change, one), one) > 0.0:
                self.loud = one
                return False
        return True


def _simplex(way: Array) -> Array:
    """Return a simplex of directions about one, shape (parameters + 1, parameters)."""
    return np.vstack([way, way + SPREAD * np.eye(way.size)])


def _state_of(known: Growth) -> State:
    """Return the largest growth of the modes that vibrate; none where nothing slides, which feeds no vibration."""
    if known.exponents is None:
        return State(-np.inf, known.equilibrium.kind, known.round_off)
    rates = known.exponents.real[np.abs(known.exponents) > known.round_off]
    return State(float(rates.max(initial=-np.inf)), known.equilibrium.kind, known.round_off)
