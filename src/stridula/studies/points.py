"""Points of a sweep: a grid, a Latin hypercube or a list, in one sequence."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import product
from numbers import Real
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, brief, count, finite, listed
from ..scenarios.quantities import parts

POINT = "point"
# Values of one key.
Values = Sequence[Any] | Array
MOST_POINTS = 1_000_000


@dataclass(frozen=True)
class Range:
    """A range of numbers between two ends in the same unit.

    Parameters
    ----------
    low, high : float or str
        Ends, both numbers in SI or both texts in one unit such as ``"10 deg"``.
    logarithmic : bool, optional
        Whether the scale is logarithmic; both ends must then be above 0.

    Raises
    ------
    ValueError
        If `high` is not above `low`, or the ends are not in one unit.
    """

    low: float | str
    high: float | str
    logarithmic: bool = False

    def __post_init__(self) -> None:
        (low, unit), (high, other) = self._end("low"), self._end("high")
        if unit != other:
            raise ArgumentError(
                "high", "be in the unit of low", self.low, got=f"{brief(self.low)} and {brief(self.high)}"
            )
        if low >= high:
            raise ArgumentError("high", f"be above low ({brief(self.low)})", self.high)
        if self.logarithmic and low <= 0.0:
            raise ArgumentError("low", "be above 0 on a logarithmic range", self.low)

    @property
    def unit(self) -> str:
        """Unit of the ends as written, empty for SI."""
        return self._end("low")[1]

    def number(self, share: float) -> float:
        """Return the number at a fraction of the range, from 0 to 1, in its unit."""
        low, high = self._end("low")[0], self._end("high")[0]
        return float(low * (high / low) ** share if self.logarithmic else low + (high - low) * share)

    def value(self, share: float) -> float | str:
        """Return the value at a fraction of the range, in the form that scenarios accept."""
        number = self.number(share)
        return f"{number!r} {self.unit}" if self.unit else number

    def share(self, value: float | str) -> float:
        """Return the position of a value in the range, 0 at its low end and 1 at its high end."""
        known = parts(value)
        if known is None or known[1] != self.unit:
            raise ArgumentError("start", f"be in the unit of its range ({self.unit or 'SI'})", value)
        low, high = self._end("low")[0], self._end("high")[0]
        if self.logarithmic:
            return math.log(known[0] / low) / math.log(high / low) if known[0] > 0.0 else -math.inf
        return (known[0] - low) / (high - low)

    def _end(self, name: str) -> tuple[float, str]:
        given = getattr(self, name)
        known = parts(given)
        if known is None:
            raise ArgumentError(name, "be a number, with a unit or in SI", given)
        finite(name, known[0])
        return known


@dataclass(frozen=True)
class Grid:
    """Every combination of the values of some keys of a scenario.

    Parameters
    ----------
    values : mapping
        Values by key: a full key such as ``contact.friction.coefficient``, or any unique ending of one. Numbers are in
        SI, texts such as ``"10 deg"`` in their unit. The first key varies slowest.

    Raises
    ------
    ValueError
        If a key has no values, or a value is not finite.
    """

    values: Mapping[str, Values]

    def __post_init__(self) -> None:
        if not isinstance(self.values, Mapping) or not self.values:
            raise ArgumentError("values", "be lists of values by key", self.values)
        for key, given in self.values.items():
            if isinstance(given, str) or not isinstance(given, (Sequence, np.ndarray)):
                raise ArgumentError(f"values[{key!r}]", "be a list of values", given)
            if not len(given):
                raise ArgumentError(f"values[{key!r}]", "hold at least one value", got="none")
        object.__setattr__(self, "values", {key: _plain(key, given) for key, given in self.values.items()})
        if self.count > MOST_POINTS:
            raise ArgumentError("values", f"make at most {MOST_POINTS} points", self.values, got=self.count)

    @property
    def count(self) -> int:
        """Number of points."""
        return math.prod(len(given) for given in self.values.values())

    def layout(self) -> Layout:
        """Return the points in sequence."""
        sizes = {key: len(given) for key, given in self.values.items()}
        return Layout(tuple(sizes), tuple(product(*self.values.values())), sizes, True, {"grid": dict(self.values)})


@dataclass(frozen=True)
class LatinHypercube:
    """Points that fill ranges of some keys evenly: each of `count` equal strips of a range holds one point.

    Parameters
    ----------
    ranges : mapping
        A `Range` or its two ends by key.
    count : int
        Number of points.
    seed : int, optional
        Seed of the points: equal seeds give equal points.

    Raises
    ------
    ValueError
        If the ends of a range do not increase, or an argument is out of its range.
    """

    ranges: Mapping[str, Any]
    count: int
    seed: int = 0

    def __post_init__(self) -> None:
        count("count", self.count, high=MOST_POINTS)
        count("seed", self.seed, low=0)
        object.__setattr__(self, "ranges", ranges_of("ranges", self.ranges))

    def values(self) -> dict[str, list[Any]]:
        """Return the values of each key at all points."""
        random = np.random.default_rng(self.seed)
        found: dict[str, list[Any]] = {}
        for key, one in self.ranges.items():
            shares = (random.permutation(self.count) + random.random(self.count)) / self.count
            found[key] = [one.value(share) for share in shares.tolist()]
        return found

    def layout(self) -> Layout:
        """Return the points in sequence."""
        columns = self.values()
        ranges = {key: asdict(one) for key, one in self.ranges.items()}
        asked = {"latin hypercube": {"ranges": ranges, "count": self.count, "seed": self.seed}}
        return Layout(tuple(columns), tuple(zip(*columns.values(), strict=True)), {POINT: self.count}, False, asked)


def ranges_of(name: str, given: Any) -> dict[str, Range]:
    """Return ranges by key.

    Parameters
    ----------
    name : str
        Name of the argument, for messages.
    given : mapping
        A `Range` or its two ends by key.

    Raises
    ------
    ValueError
        If `given` is anything else, or the ends of a range do not increase.
    """
    if not isinstance(given, Mapping) or not given:
        raise ArgumentError(name, "be ranges by key", given)
    return {str(key): range_of(f"{name}[{key!r}]", one) for key, one in given.items()}


def range_of(name: str, given: Any) -> Range:
    """Return a range from itself or its two ends.

    Parameters
    ----------
    name : str
        Name of the argument, for messages.
    given : Range or pair
        The range, or its ends.

    Raises
    ------
    ValueError
        If `given` is neither, or the ends do not increase.
    """
    if isinstance(given, Range):
        return given
    if isinstance(given, str) or not isinstance(given, (Sequence, np.ndarray)) or len(given) != 2:
        raise ArgumentError(name, "be a Range or its two ends", given)
    try:
        return Range(*(plain_python(end) for end in given))
    except ArgumentError as error:
        raise error.inside(name) from None


@dataclass(frozen=True)
class Layout:
    """Points in sequence.

    Attributes
    ----------
    keys : tuple of str
        Varied keys.
    values : tuple of tuple
        Values of the keys at each point.
    dimensions : dict
        Sizes of the dimensions of the points, the last one varying fastest.
    is_grid : bool
        Whether each key has its own dimension.
    asked : dict
        The points as requested, as plain numbers and texts.
    """

    keys: tuple[str, ...]
    values: tuple[tuple[Any, ...], ...]
    dimensions: dict[str, int]
    is_grid: bool
    asked: dict[str, Any]


def laid_out(points: Grid | LatinHypercube | Mapping[str, Values] | Sequence[Mapping[str, Any]]) -> Layout:
    """Return points in sequence.

    Parameters
    ----------
    points : Grid, LatinHypercube, mapping or sequence of mapping
        The points; a mapping is that of a grid, and every entry of a list has a value for each of the same keys.

    Raises
    ------
    ValueError
        If they are none of these.
    """
    if isinstance(points, Mapping):
        points = Grid(points)
    if hasattr(points, "layout"):
        found: Layout = points.layout()
        return found
    if isinstance(points, str) or not isinstance(points, Sequence):
        raise ArgumentError("points", "be a Grid, a LatinHypercube or a list of values by key", points)
    return _listed(points)


def _listed(points: Sequence[Mapping[str, Any]]) -> Layout:
    if not points:
        raise ArgumentError("points", "hold at least one point", points, got="none")
    for number, point in enumerate(points):
        if not isinstance(point, Mapping) or not point:
            raise ArgumentError(f"points[{number}]", "be values by key", point)
        if set(point) != set(points[0]):
            raise ArgumentError(f"points[{number}]", f"have the keys of points[0], {listed(points[0])}", point)
    keys = tuple(points[0])
    columns = [_plain(key, [point[key] for point in points]) for key in keys]
    values = tuple(zip(*columns, strict=True))
    asked = {"list": [dict(zip(keys, one, strict=True)) for one in values]}
    return Layout(keys, values, {POINT: len(values)}, False, asked)


def _plain(key: str, given: Values) -> list[Any]:
    """Return values as Python objects, checking that numbers are finite."""
    if not isinstance(key, str) or not key.strip():
        raise ArgumentError("key", "be a text", key)
    plain = [plain_python(value) for value in given]
    for value in plain:
        if isinstance(value, Real) and not isinstance(value, bool):
            finite(key, value)
    return plain


def plain_python(value: Any) -> Any:
    """Return NumPy numbers and arrays as Python objects, anything else unchanged."""
    return value.tolist() if isinstance(value, (np.generic, np.ndarray)) else value
