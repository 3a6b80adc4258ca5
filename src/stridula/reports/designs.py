"""A design: a scenario with the tables from which it follows, and the options of its report."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from ..analysis.stability import sliding_stability
from ..arrays import Array
from ..checks import ArgumentError, instance
from ..disk import RECORDS, is_there
from ..linear.given import Status, Velocity
from ..records.files import load
from ..records.provenance import scenario_toml
from ..scenarios import outline
from ..scenarios.errors import ScenarioError
from ..scenarios.keys import overridden, with_values
from ..scenarios.load import Scenario, scenario_of_tables
from ..scenarios.outline import Path as Key
from ..scenarios.read import read_tables
from ..studies.values_by_key import in_si, is_written
from ..system import System

# Keys of coefficients of friction in the tables of laws.
COEFFICIENTS = ("coefficient", "static", "kinetic", "slope")
FRICTION, COEFFICIENT, RELATIVE = "friction", "friction.coefficient", "friction / given"
# Values of the friction from none to twice that given.
POINTS, MOST_FRICTION = 25, 2.0
# Duration of systems, which have none [s].
LASTS = 1.0


@dataclass(frozen=True)
class Options:
    """Options of a report.

    Attributes
    ----------
    overrides : mapping
        Values by key.
    duration : float, str or None
        Time to simulate [s]; that of the scenario if None.
    key : str
        Parameter of the root loci.
    values : ndarray or None
        Its values, in `units`.
    units : str
        Their unit.
    run, sound, effects, check, fates : bool
        Whether there is a run, its sound, effects of parameters, checks of step and cutoff, and fates of growing modes.
    remedies : mapping or None
        Lowest and highest value of each parameter that may change to silence the system.
    uncertain : mapping or None
        Distribution of each uncertain parameter by key.
    samples : int
        Number of random points.
    status, velocity : optional
        As for `sliding_stability`.
    """

    overrides: Mapping[str, Any]
    duration: float | str | None
    key: str
    values: Array | None
    units: str
    run: bool
    sound: bool
    effects: bool
    check: bool
    fates: bool
    remedies: Mapping[str, Any] | None
    uncertain: Mapping[str, Any] | None
    samples: int
    status: Status | None
    velocity: Velocity | None


@dataclass(frozen=True)
class Design:
    """A scenario of a report.

    Attributes
    ----------
    name : str
        Its name.
    source : str, Path, xarray.Dataset or System
        Its source.
    tables : dict
        Its tables, as written.
    record : xarray.Dataset or None
        Its run, if it has been computed.
    options : Options
        Options of the report.
    """

    name: str
    source: Any
    tables: dict[str, Any]
    record: xr.Dataset | None
    options: Options

    @cached_property
    def scenario(self) -> Scenario:
        """The scenario."""
        return scenario_of_tables(self.tables)

    @cached_property
    def system(self) -> System:
        """Its system."""
        return self.scenario.system

    @property
    def title(self) -> str:
        """Its title, or its name."""
        return self.scenario.title or self.name

    @cached_property
    def si(self) -> dict[str, Any]:
        """The tables in SI, with shared values in each body or contact."""
        return in_si(self.tables)

    @property
    def is_written(self) -> bool:
        """Whether it is a scenario, whose parameters have keys."""
        return is_written(self.source)

    @property
    def given(self) -> dict[str, Any]:
        """Arguments of linear theory."""
        return {"status": self.options.status, "velocity": self.options.velocity}

    @cached_property
    def modes(self) -> xr.Dataset:
        """Its modes of sliding."""
        return sliding_stability(self.system, **self.given)

    def numbers(self, last: Sequence[str], within: str = "") -> list[tuple[Key, float]]:
        """Return the paths and values of numbers with a key, within a table of a name if one is given."""
        found = []
        for path, _ in outline.paths(self.si):
            number = outline.look_up(self.si, path)
            is_number = isinstance(number, (int, float)) and not isinstance(number, bool)
            if is_number and path[-1] in last and (not within or within in path):
                found.append((path, float(number)))
        return found

    def scaled(self, numbers: Sequence[tuple[Key, float]], factor: float) -> System:
        """Return the system with numbers times a factor."""
        given = [(path, factor * number) for path, number in numbers]
        return scenario_of_tables(with_values(self.si, given)).system

    def over(self) -> tuple[str, Array, str, Callable[[float], System]] | None:
        """Return parameter, values, unit and systems of the root loci; None if there is no friction to vary."""
        asked = self.options
        if asked.key != FRICTION or asked.values is not None:
            return asked.key, _values(asked), asked.units, self._with(asked.key, asked.units)
        numbers = self.numbers(COEFFICIENTS, FRICTION)
        if not any(number for _, number in numbers):
            return None
        shares = np.linspace(0.0, MOST_FRICTION, POINTS)
        # Friction of a single coefficient has it as the axis, any other one its share.
        first = numbers[0][1]
        if all(path[-1] == COEFFICIENTS[0] and number == first for path, number in numbers):
            return COEFFICIENT, first * shares, "", lambda value: self.scaled(numbers, value / first)
        return RELATIVE, shares, "", lambda share: self.scaled(numbers, share)

    def _with(self, key: str, units: str) -> Callable[[float], System]:
        def system(value: float) -> System:
            number = int(value) if value.is_integer() else value
            tables, problems = overridden(self.tables, {key: f"{value!r} {units}" if units else number})
            return scenario_of_tables(tables, problems).system

        return system


def _values(asked: Options) -> Array:
    if asked.values is None:
        raise ArgumentError("values", "be given with a key", got=f"none for {asked.key!r}")
    return asked.values


def design_of(source: Any, options: Options) -> Design:
    """Return a design.

    Parameters
    ----------
    source : str, Path, xarray.Dataset or System
        A scenario, a record, whose run is that of the report, or a system.
    options : Options
        Options of the report.

    Raises
    ------
    ScenarioError
        If the scenario or an override cannot be used.
    OSError
        If a file cannot be read.
    """
    record = _record_of(source)
    if not is_written(source):
        instance("source", source, System)
        lasts = LASTS if options.duration is None else options.duration
        written = tomllib.loads(scenario_toml(source, (), {"duration": lasts}))
    else:
        written = read_tables(source)
    changes = dict(options.overrides)
    if options.duration is not None:
        changes["simulation.duration"] = options.duration
    tables, problems = overridden(written, changes)
    if problems:
        raise ScenarioError(problems)
    name = source if isinstance(source, (str, Path)) else "Record" if isinstance(source, xr.Dataset) else "System"
    design = Design(str(name), source, tables, None if changes else record, options)
    # Errors of the scenario come before the first computation.
    _ = design.scenario, design.si
    return design


def _record_of(source: Any) -> xr.Dataset | None:
    """Return the record of a source, None if it is none."""
    if isinstance(source, xr.Dataset):
        return source if {"normal_force", "status_share"} <= set(source) and "ended" in source.attrs else None
    is_file = isinstance(source, (str, Path)) and Path(source).suffix.lower() in RECORDS and is_there(source)
    return load(source) if is_file else None
