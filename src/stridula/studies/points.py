"""Points of a sweep: a grid, a Latin hypercube or a list, laid out one after another."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from numbers import Real
from typing import Any

import numpy as np

from ..checks import count, finite
from ..scenarios.quantities import parts

POINT = "point"


@dataclass(frozen=True)
class Grid:
    """Every combination of the values of some keys of a scenario.

    Parameters
    ----------
    values : mapping
        Values by key: a full key such as ``contact.friction.coefficient``, or any unique ending of one. Numbers are in
        SI, texts such as ``"10 deg"`` in the unit that they name. The first key varies slowest.

    Raises
    ------
    ValueError
        If a key has no values, or a value is not finite.
    """

    values: Mapping[str, Sequence[Any]]

    def __post_init__(self) -> None:
        if not isinstance(self.values, Mapping) or not self.values:
            raise ValueError(f"values must be lists of values by key, got {self.values!r}")
        for key, given in self.values.items():
            if isinstance(given, str) or not isinstance(given, (Sequence, np.ndarray)):
                raise ValueError(f"values[{key!r}] must be a list of values, got {given!r}")
            if not len(given):
                raise ValueError(f"values[{key!r}] must hold at least one value, got none")
        object.__setattr__(self, "values", {key: _plain(key, given) for key, given in self.values.items()})

    @property
    def count(self) -> int:
        """Number of points."""
        return math.prod(len(given) for given in self.values.values())


@dataclass(frozen=True)
class LatinHypercube:
    """Points that fill ranges of some keys evenly: cut into as many strips as there are points, each has one point.

    Parameters
    ----------
    ranges : mapping
        Lowest and highest value by key, both numbers in SI or both texts of one unit such as ``("10 deg", "80 deg")``.
    count : int
        Number of points.
    seed : int, optional
        Seed of the points: equal seeds give equal points.

    Raises
    ------
    ValueError
        If a range does not rise, or an argument is out of its range.
    """

    ranges: Mapping[str, tuple[Any, Any]]
    count: int
    seed: int = 0

    def __post_init__(self) -> None:
        count("count", self.count)
        count("seed", self.seed, low=0)
        if not isinstance(self.ranges, Mapping) or not self.ranges:
            raise ValueError(f"ranges must be pairs of values by key, got {self.ranges!r}")
        for key, given in self.ranges.items():
            if isinstance(given, str) or not isinstance(given, (Sequence, np.ndarray)) or len(given) != 2:
                raise ValueError(f"ranges[{key!r}] must be a pair of values, got {given!r}")
        object.__setattr__(self, "ranges", {key: tuple(_plain(key, given)) for key, given in self.ranges.items()})
        for key in self.ranges:
            self._ends(key)

    def _ends(self, key: str) -> tuple[float, float, str]:
        """Return the ends of a range and their unit."""
        known = [parts(value) for value in self.ranges[key]]
        if None in known:
            raise ValueError(f"ranges[{key!r}] must be two numbers, got {self.ranges[key]!r}")
        (low, unit), (high, other) = [found for found in known if found]
        if unit != other:
            raise ValueError(f"ranges[{key!r}] must have one unit, got {self.ranges[key]!r}")
        for end in (low, high):
            finite(f"ranges[{key!r}]", end)
        if low >= high:
            raise ValueError(f"ranges[{key!r}] must rise, got {self.ranges[key]!r}")
        return low, high, unit

    def values(self) -> dict[str, list[Any]]:
        """Return the values of each key, point by point."""
        random = np.random.default_rng(self.seed)
        found: dict[str, list[Any]] = {}
        for key in self.ranges:
            low, high, unit = self._ends(key)
            shares = (random.permutation(self.count) + random.random(self.count)) / self.count
            numbers = (low + (high - low) * shares).tolist()
            found[key] = [f"{number!r} {unit}" for number in numbers] if unit else numbers
        return found


@dataclass(frozen=True)
class Layout:
    """Points one after another.

    Attributes
    ----------
    keys : tuple of str
        What is varied.
    values : tuple of tuple
        Values of the keys at each point.
    dimensions : dict
        Sizes of the dimensions that the points fill, the last one fastest.
    is_grid : bool
        Whether each key has a dimension of its own.
    asked : dict
        The points as they were asked for, in plain numbers and texts.
    """

    keys: tuple[str, ...]
    values: tuple[tuple[Any, ...], ...]
    dimensions: dict[str, int]
    is_grid: bool
    asked: dict[str, Any]


def laid_out(points: Grid | LatinHypercube | Sequence[Mapping[str, Any]]) -> Layout:
    """Return points one after another.

    Parameters
    ----------
    points : Grid, LatinHypercube or sequence of mapping
        The points; of a list each entry has a value for each of the same keys.

    Raises
    ------
    ValueError
        If they are none of these.
    """
    if isinstance(points, Grid):
        sizes = {key: len(given) for key, given in points.values.items()}
        return Layout(tuple(sizes), tuple(product(*points.values.values())), sizes, True, {"grid": dict(points.values)})
    if isinstance(points, LatinHypercube):
        columns = points.values()
        ranges = {key: list(ends) for key, ends in points.ranges.items()}
        asked = {"latin hypercube": {"ranges": ranges, "count": points.count, "seed": points.seed}}
        return Layout(tuple(columns), tuple(zip(*columns.values(), strict=True)), {POINT: points.count}, False, asked)
    if isinstance(points, (str, Mapping)) or not isinstance(points, Sequence):
        raise ValueError(f"points must be a Grid, a LatinHypercube or a list of values by key, got {points!r}")
    return _listed(points)


def _listed(points: Sequence[Mapping[str, Any]]) -> Layout:
    if not points:
        raise ValueError("points must hold at least one point, got none")
    for number, point in enumerate(points):
        if not isinstance(point, Mapping) or not point:
            raise ValueError(f"points[{number}] must be values by key, got {point!r}")
        if set(point) != set(points[0]):
            raise ValueError(f"points[{number}] must have the keys of points[0], {', '.join(points[0])}, got {point!r}")
    keys = tuple(points[0])
    columns = [_plain(key, [point[key] for point in points]) for key in keys]
    values = tuple(zip(*columns, strict=True))
    asked = {"list": [dict(zip(keys, one, strict=True)) for one in values]}
    return Layout(keys, values, {POINT: len(values)}, False, asked)


def _plain(key: str, given: Sequence[Any]) -> list[Any]:
    """Return values as Python's own, finite where they are numbers."""
    if not isinstance(key, str) or not key.strip():
        raise ValueError(f"key must be a text, got {key!r}")
    plain = [plain_python(value) for value in given]
    for value in plain:
        if isinstance(value, Real) and not math.isfinite(value):
            raise ValueError(f"{key} must be finite, got {value!r}")
    return plain


def plain_python(value: Any) -> Any:
    """Return NumPy's numbers and arrays as Python's, anything else as it is."""
    return value.tolist() if isinstance(value, (np.generic, np.ndarray)) else value
