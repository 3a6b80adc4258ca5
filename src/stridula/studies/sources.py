"""Sources of the scenario at each point of a study: a scenario with varied keys, or a function of values."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Protocol

from ..checks import ArgumentError, brief, listed, positive, suggestion
from ..integration.settings import NAMES, Settings
from ..records.provenance import toml
from ..scenarios.errors import ScenarioError
from ..scenarios.keys import located, with_values
from ..scenarios.load import Scenario, load_scenario, scenario_of_tables, with_matrices
from ..scenarios.outline import Path
from ..scenarios.quantities import parts, quantity, unit_of
from ..scenarios.read import read_tables
from ..scenarios.varied import Varied, varied_keys
from ..system import System
from .measures import message_of
from .points import Layout
from .values_by_key import in_si as in_si_tables
from .values_by_key import si_tables

# Samples per second recorded unless the scenario or the study sets fewer: enough for the named measures.
SAMPLE_RATE = 20e3
# Arguments of a simulation that a function may return with its system.
ARGUMENTS = ("duration", *NAMES)
SystemOf = Callable[..., Any]


class Source(Protocol):
    """Maker of a scenario from the values of a point."""

    def scenario(self, values: Sequence[Any]) -> Scenario:
        """Return the scenario of a point; ValueError if it cannot be built."""

    def tables(self, values: Sequence[Any], scenario: Scenario) -> dict[str, Any]:
        """Return the tables of a point in SI, in which numbers are found by key, from its values and its scenario."""


@dataclass(frozen=True)
class Varying:
    """A source and its points.

    Attributes
    ----------
    source : Source
        Source of the scenarios.
    keys : list of Varied
        Varied keys.
    values : list of tuple
        Values of the keys at each point.
    attributes : dict of str
        Attributes that record the origin of results: ``title``, and ``scenario`` or ``function``.
    """

    source: Source
    keys: list[Varied]
    values: list[tuple[Any, ...]]
    attributes: dict[str, str]


@dataclass(frozen=True)
class OfTables:
    """A scenario with some of its keys varied.

    Attributes
    ----------
    written : dict
        Complete tables of the scenario.
    paths : tuple of tuple
        Paths of the varied keys.
    highest_rate : float
        Largest number of samples recorded per second [Hz].
    """

    written: dict[str, Any]
    paths: tuple[Path, ...]
    highest_rate: float = SAMPLE_RATE

    def scenario(self, values: Sequence[Any]) -> Scenario:
        """Return the scenario of a point.

        Raises
        ------
        ScenarioError
            If it cannot be built.
        """
        made = scenario_of_tables(with_values(self.written, zip(self.paths, values, strict=True)))
        return replace(made, sample_rate=min(made.sample_rate, self.highest_rate))

    def tables(self, values: Sequence[Any], scenario: Scenario) -> dict[str, Any]:
        """Return the tables of a point in SI."""
        return in_si_tables(with_values(self.written, zip(self.paths, values, strict=True)))


@dataclass(frozen=True)
class OfFunction:
    """A function that makes scenarios from values by name.

    Attributes
    ----------
    function : callable
        Function that returns a System, a Scenario, or a System and a dictionary of arguments of `simulate`.
    units : dict of str or None
        SI unit of each parameter whose values may be texts, by name, in the order of the values of a point.
    fixed : dict
        Values of other parameters, the same at every point.
    given : dict
        Duration [s] and sample rate [Hz] that override those of the function.
    highest_rate : float
        Largest number of samples recorded per second [Hz], unless a larger one is given.
    """

    function: SystemOf
    units: dict[str, str | None]
    fixed: dict[str, Any]
    given: dict[str, float]
    highest_rate: float = SAMPLE_RATE

    def scenario(self, values: Sequence[Any]) -> Scenario:
        """Return the scenario of a point.

        Raises
        ------
        ValueError
            If the function raises an exception, or returns anything else.
        """
        units = zip(self.units.items(), values, strict=True)
        named = {name: quantity(value, unit) if unit else value for (name, unit), value in units}
        return _made(self.function, self.fixed | named, self.given, self.highest_rate)

    def tables(self, values: Sequence[Any], scenario: Scenario) -> dict[str, Any]:
        """Return the tables of the system of a point in SI, as its record has them."""
        return si_tables(scenario.system, {})


def _made(function: SystemOf, values: Mapping[str, Any], given: Mapping[str, Any], highest_rate: float) -> Scenario:
    """Return the scenario that a function makes from values.

    Parameters
    ----------
    function : callable
        Function that returns a System, a Scenario, or a System and a dictionary of arguments of `simulate`.
    values : mapping
        Its arguments.
    given : mapping
        Arguments of `simulate` that override those of the function.
    highest_rate : float
        Largest number of samples recorded per second [Hz], unless a larger one is given.

    Raises
    ------
    ValueError
        If the function raises an exception, returns anything else, or no duration is given.
    """
    name = name_of(function)
    try:
        made = function(**values)
    except MemoryError:
        raise
    except Exception as error:
        raise ValueError(f"{name}: {message_of(error)}") from error
    if isinstance(made, Scenario):
        return replace(made, **({"sample_rate": min(made.sample_rate, highest_rate)} | dict(given)))
    words = {"sample_rate": min(Settings.sample_rate, highest_rate), **_arguments(name, made), **given}
    system = made[0] if isinstance(made, tuple) else made
    if words.get("duration") is None:
        raise ArgumentError("duration", f"be given, as an argument or by {name}", got="none")
    positive("duration", words["duration"])
    if words.get("probes") is not None:
        words["probes"] = tuple(words["probes"])
    return Scenario(title=name, description="", system=system, **words)


def made_once(given: Any, values: Mapping[str, Any], timing: Mapping[str, Any]) -> Scenario:
    """Return a scenario, or the scenario made by a function, at one set of values.

    Parameters
    ----------
    given : str, Path, xarray.Dataset or callable
        A scenario, or a function of values.
    values : mapping
        Values of keys of the scenario, or of parameters of the function.
    timing : mapping
        ``duration``, if given.

    Raises
    ------
    ScenarioError
        If the scenario cannot be used.
    ValueError
        If a function takes other parameters, raises an exception or returns anything else.
    """
    if callable(given):
        check_takes(given, [*values])
        return _made(given, in_si(values), timing_in_si(timing), math.inf)
    return load_scenario(given, {**values, **{f"simulation.{name}": value for name, value in timing.items()}})


def _arguments(name: str, made: Any) -> dict[str, Any]:
    """Return the arguments of `simulate` beside a system."""
    if isinstance(made, System):
        return {}
    is_pair = isinstance(made, tuple) and len(made) == 2
    if not is_pair or not isinstance(made[0], System) or not isinstance(made[1], Mapping):
        raise ArgumentError(name, "return a System, a Scenario, or a System and arguments of simulate by name", made)
    unknown = next((word for word in made[1] if word not in ARGUMENTS), None)
    if unknown is not None:
        known = listed(ARGUMENTS)
        near = suggestion(unknown, ARGUMENTS)
        raise ArgumentError(name, f"return arguments among {known}", unknown, got=f"{brief(unknown)}{near}")
    return dict(made[1])


def name_of(function: SystemOf) -> str:
    """Return the name of a function."""
    while isinstance(function, partial):
        function = function.func
    return str(getattr(function, "__name__", type(function).__name__))


def takes(function: SystemOf, names: Sequence[str]) -> bool:
    """Return whether a function takes arguments of these names and needs no others."""
    return _mismatch(function, names) is None


def takes_one(function: SystemOf) -> bool:
    """Return whether a function may be called with one argument."""
    try:
        inspect.signature(function).bind(None)
    except TypeError:
        return False
    except ValueError:
        return True
    return True


def check_takes(function: SystemOf, names: Sequence[str]) -> None:
    """Raise ValueError unless a function takes arguments of these names and needs no others."""
    why = _mismatch(function, names)
    if why is None:
        return
    own = [str(one) for one in inspect.signature(function).parameters.values()]
    takes = f"take the parameters {listed(names) if names else 'none'}"
    raise ArgumentError(name_of(function), takes, got=f"one of ({', '.join(own)}): {why}")


def _mismatch(function: SystemOf, names: Sequence[str]) -> str | None:
    """Return why a function does not take arguments of these names, None if it does or has no signature."""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        return None
    try:
        signature.bind(**dict.fromkeys(names))
    except TypeError as error:
        return str(error)
    return None


def varying(
    scenario: Any,
    fixed: Mapping[str, Any],
    timing: Mapping[str, Any],
    layout: Layout,
    highest_rate: float = SAMPLE_RATE,
) -> Varying:
    """Return the checked source and points of a study.

    Parameters
    ----------
    scenario : str, Path, xarray.Dataset or callable
        A scenario, or a function of values.
    fixed : mapping
        Values of other keys, the same at every point.
    timing : mapping
        ``duration`` and ``sample_rate``, if given.
    layout : Layout
        The points.
    highest_rate : float, optional
        Largest number of samples recorded per second [Hz], unless the scenario or the study sets a larger one.

    Raises
    ------
    ScenarioError
        If the scenario is invalid, or a key is unknown, ambiguous or takes values of another kind.
    ValueError
        If a function takes other parameters, or fails at both the first and the last point.
    """
    return (_of_function if callable(scenario) else _of_scenario)(scenario, fixed, timing, layout, highest_rate)


def _of_scenario(
    scenario: Any, fixed: Mapping[str, Any], timing: Mapping[str, Any], layout: Layout, highest_rate: float
) -> Varying:
    """Return the scenario that all points share, the keys that are varied, and their values at each point."""
    given = {**fixed, **{f"simulation.{name}": value for name, value in timing.items()}}
    tables, places, problems = located(read_tables(scenario), given)
    if problems:
        raise ScenarioError(problems)
    keys = varied_keys(tables, layout.keys, layout.values)
    for key in keys:
        twin = next((name for name, path in places.items() if path == key.path), None)
        if twin is not None:
            raise ScenarioError([f"key must be set or varied, got both {twin!r} and {key.key!r}"])
    columns = [
        [key.read(value) for value in column]
        for key, column in zip(keys, zip(*layout.values, strict=True), strict=True)
    ]
    values = list(zip(*columns, strict=True))
    has_own_rate = ("simulation", "sample_rate") in [*places.values(), *(key.path for key in keys)]
    tables = _usable(tables, keys, values)
    source = OfTables(tables, tuple(key.path for key in keys), math.inf if has_own_rate else highest_rate)
    return Varying(source, keys, values, {"title": str(tables.get("title", "")), "scenario": toml(tables)})


def _usable(tables: dict[str, Any], keys: Sequence[Varied], values: Sequence[Sequence[Any]]) -> dict[str, Any]:
    """Return the tables with matrices in place of files, after checking that they make a scenario.

    They must do so alone, or at the first or last point, since keys may be given by the points only.
    """
    errors = []
    for given in (None, values[0], values[-1]):
        tried = tables if given is None else with_values(tables, [(key.path, given[n]) for n, key in enumerate(keys)])
        try:
            scenario_of_tables(tried)
        except ScenarioError as error:
            errors.append(error)
        else:
            return with_matrices(tables, tried)
    raise errors[0]


def _of_function(
    function: SystemOf, fixed: Mapping[str, Any], timing: Mapping[str, Any], layout: Layout, highest_rate: float
) -> Varying:
    """Return a function, checked at the first and the last point, and the points."""
    twin = next((name for name in layout.keys if name in fixed), None)
    if twin is not None:
        raise ArgumentError("key", "be set or varied", twin, got=f"{twin!r} as both")
    check_takes(function, [*layout.keys, *fixed])
    columns = list(zip(*layout.values, strict=True))
    keys = [_key(name, column) for name, column in zip(layout.keys, columns, strict=True)]
    units = {key.key: key.unit for key in keys}
    source = OfFunction(function, units, in_si(fixed), timing_in_si(timing), highest_rate)
    errors = []
    for given in (layout.values[0], layout.values[-1]):
        try:
            source.scenario(given)
        except ValueError as error:
            errors.append(error)
    if len(errors) == 2:
        raise errors[0]
    name = f"{getattr(function, '__module__', '')}.{name_of(function)}"
    return Varying(source, keys, list(layout.values), {"title": name_of(function), "function": name})


def _key(name: str, values: Sequence[Any]) -> Varied:
    """Return a parameter of a function as a key, with the unit of its texts."""
    unit = next((unit for unit in map(_unit, values) if unit), None)
    for value in values if unit else ():
        try:
            quantity(value, str(unit))
        except ArgumentError as error:
            raise error.renamed(name) from None
    return Varied(name, (name,), name, unit, {})


def _unit(value: Any) -> str | None:
    """Return the SI unit of a text such as ``"20 mm"``, None for anything else."""
    known = parts(value) if isinstance(value, str) else None
    return unit_of(known[1]) if known and known[1] else None


def in_si(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values by name with texts such as ``"20 mm"`` as numbers in SI."""
    return {name: quantity(value, unit) if (unit := _unit(value)) else value for name, value in values.items()}


def timing_in_si(timing: Mapping[str, Any]) -> dict[str, float]:
    """Return a duration [s] and a sample rate [Hz], if given.

    Raises
    ------
    ValueError
        If one has another unit.
    """
    found = {}
    for name, unit in (("duration", "s"), ("sample_rate", "Hz")):
        if name in timing:
            try:
                found[name] = quantity(timing[name], unit)
            except ArgumentError as error:
                raise error.renamed(name) from None
    return found
