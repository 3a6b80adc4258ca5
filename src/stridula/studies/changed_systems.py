"""Systems with changed parameters, under varied conditions: from a function, or from the tables of a scenario."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from ..checks import ArgumentError, by_key, finite, instance, listed
from ..scenarios.keys import with_values
from ..scenarios.load import scenario_of_tables
from ..system import System
from .mode_derivatives import point_of
from .modified import modify
from .values_by_key import Value, is_written, si_tables, value_of

Range = tuple[float, float]


def _value(name: str, key: str, tables: dict[str, Any]) -> Value:
    try:
        return value_of(key, tables)
    except ArgumentError as error:
        raise error.renamed(name) from None


@dataclass(frozen=True)
class Systems:
    """Systems of changes and conditions.

    Attributes
    ----------
    given : dict
        Present value of each parameter.
    ranges : dict
        Lowest and highest value of each.
    units : dict
        Their units.
    make : callable
        Function of values of parameters and conditions that returns the system.
    """

    given: dict[str, float]
    ranges: dict[str, Range]
    units: dict[str, str]
    make: Callable[[Mapping[str, float]], System]

    def __post_init__(self) -> None:
        for name, (low, high) in self.ranges.items():
            if not low <= self.given[name] <= high:
                words = f"contain the present value, {self.given[name]:.6g}"
                raise ArgumentError(f"ranges[{name!r}]", words, (low, high))


def systems_of_function(
    source: Any, ranges: dict[str, Range], start: Any, masses: Any, overrides: Any
) -> Systems | None:
    """Return the systems of a function, None for another source."""
    if not callable(source):
        if start is not None:
            raise ArgumentError("start", "be left out: the source has the present values", start)
        return None
    for name, value in (("masses", masses), ("overrides", overrides)):
        if value is not None:
            raise ArgumentError(name, "be left out for a function", value)
    given = by_key("start", start)
    lacking = [name for name in ranges if name not in given]
    if lacking or len(given) > len(ranges):
        raise ArgumentError("start", f"have a value for each of {listed(ranges)}", given, got=listed(given) or "none")
    values = {name: finite(f"start[{name!r}]", given[name]) for name in ranges}

    def make(numbers: Mapping[str, float]) -> System:
        made = source(**numbers)
        instance("source", made, System)
        return made

    return Systems(values, ranges, dict.fromkeys(ranges, ""), make)


def systems_of_tables(
    source: Any, ranges: dict[str, Range], over: dict[str, Range], lumps: dict[str, Any], overrides: Mapping[str, Any]
) -> Systems:
    """Return the systems of a scenario or a system, with masses at points."""
    if not is_written(source):
        instance("source", source, System)
    tables = si_tables(source, overrides)
    values = {key: _value(name, key, tables) for name, keys in (("ranges", ranges), ("over", over)) for key in keys}
    clash = next((name for name in lumps if name in values), None)
    if clash is not None:
        raise ArgumentError("masses", "have other names than keys", clash)

    def make(numbers: Mapping[str, float]) -> System:
        changed = [
            (path, numbers[key] / value.value * number)
            for key, value in values.items()
            if key in numbers
            for path, number in zip(value.paths, value.numbers, strict=True)
        ]
        system = scenario_of_tables(with_values(tables, changed)).system
        added = [(point_of(name, where, system), numbers[name]) for name, (where, _) in lumps.items() if numbers[name]]
        return modify(system, masses=added) if added else system

    given = {key: values[key].value for key in ranges} | dict.fromkeys(lumps, 0.0)
    allowed = ranges | {name: (0.0, largest) for name, (_, largest) in lumps.items()}
    units = {key: values[key].units for key in ranges} | dict.fromkeys(lumps, "kg")
    return Systems(given, allowed, units, make)
