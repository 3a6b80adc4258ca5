"""Measures of a sweep by name, of the record of a point, of its system, or of both."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from numbers import Real
from typing import Any

import numpy as np
import xarray as xr

from ..analysis import advance, dominant_frequency, status_share
from ..analysis.regimes import LIMITS, MEANINGS, TAKEN, regime_of
from ..analysis.several_contacts import loads, mean_shares
from ..analysis.signals import samples
from ..analysis.stability import stability_of
from ..checks import ArgumentError, brief, suggestion
from ..records.by_point import by_point
from ..records.plain import PlainRecord
from ..records.variables import STATUS_WORDS
from ..system import System

Value = float | str
Values = Mapping[str, Value]
Run = xr.Dataset | PlainRecord
# Variables that every sweep has.
OWN = ("ended", "message", "point")


@dataclass(frozen=True)
class Column:
    """A variable of a measure: a number or a word at each point.

    Attributes
    ----------
    name : str
        Name of the variable.
    units : str
        Unit, empty for words.
    long_name : str
        Description.
    is_text : bool
        Whether the values are words.
    """

    name: str
    units: str
    long_name: str
    is_text: bool = False


@dataclass(frozen=True)
class Measure:
    """A measure at each point.

    Attributes
    ----------
    name : str
        Name by which it is requested.
    columns : tuple of Column
        Its variables.
    of_record : callable or None
        Function of a record, labelled or plain, that returns the values of the columns by name.
    of_system : callable or None
        Function of a system that returns the values of the columns by name; it needs no run.
    also : tuple of str
        Other measures that it includes.
    needs : tuple of str
        Variables of a record that it uses.
    """

    name: str
    columns: tuple[Column, ...]
    of_record: Callable[[Run], Values] | None = None
    of_system: Callable[[System], Values] | None = None
    also: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()


def _labelled(run: Run, *names: str) -> xr.Dataset:
    """Return a record with labels on at least these variables."""
    given: Any = run
    found: xr.Dataset = given.labelled(*names) if hasattr(given, "labelled") else given
    return found


def _shares(run: Run) -> Values:
    """Return the shares of the time; for several contacts their mean weighted by load."""
    known = by_point(_labelled(run, "status_share", "normal_force"))
    if "contact" in known.dims:
        carried = loads(known["normal_force"].values, LIMITS.rare)
        found = mean_shares(known["status_share"].values, carried).tolist()
        return {f"{status}_share": share for status, share in zip(STATUS_WORDS, found, strict=True)}
    return {f"{status}_share": status_share(known, status) for status in STATUS_WORDS}


def _normal_force(run: Run) -> xr.DataArray:
    """Return the normal force; for several contacts their sum."""
    force = _labelled(run, "normal_force")["normal_force"]
    return force.sum("contact") if "contact" in force.dims else force


def _dominant_frequency(run: Run) -> Values:
    return {"dominant_frequency": dominant_frequency(_normal_force(run))}


def _peak_force(run: Run) -> Values:
    return {"peak_force": float(samples(_normal_force(run))[0].max())}


def _mean_force(run: Run) -> Values:
    return {"mean_force": float(samples(_normal_force(run))[0].mean())}


def _travel(run: Run) -> Values:
    return {"travel": advance(_labelled(run, "contact_position"))}


def _step(run: Run) -> Values:
    return {name: float(run.attrs[name]) for name in ("step", "sample_interval")}


def _regime_column(name: str) -> Column:
    units, meaning = MEANINGS[name]
    return Column(name, "" if name == "regime" else units, meaning, is_text=name == "regime")


# To add a measure, add an entry here and a row to the table of docs/command-line.rst.
MEASURES = {
    measure.name: measure
    for measure in (
        Measure(
            "shares",
            (
                Column("separated_share", "1", "share of the time in which the contact is separated"),
                Column("sticking_share", "1", "share of the time in which the contact sticks"),
                Column("sliding_share", "1", "share of the time in which the contact slides"),
            ),
            _shares,
            needs=("status_share", "normal_force"),
        ),
        Measure(
            "dominant_frequency",
            (Column("dominant_frequency", "Hz", "dominant frequency of the normal force"),),
            _dominant_frequency,
            needs=("normal_force",),
        ),
        Measure(
            "peak_force",
            (Column("peak_force", "N", "largest normal force, averaged over the sample interval"),),
            _peak_force,
            needs=("normal_force",),
        ),
        Measure("mean_force", (Column("mean_force", "N", "mean normal force"),), _mean_force, needs=("normal_force",)),
        Measure(
            "travel",
            (Column("travel", "m", "net displacement of the contact point along the track"),),
            _travel,
            needs=("contact_position",),
        ),
        Measure(
            "step",
            (Column("step", "s", "time step of the run"), Column("sample_interval", "s", "time between samples")),
            _step,
        ),
        Measure("regime", tuple(map(_regime_column, MEANINGS)), regime_of, also=("stability",), needs=TAKEN),
        Measure(
            "stability",
            (
                Column("growth_rate", "1/s", "largest growth rate of linear theory"),
                Column("flutter_frequency", "Hz", "frequency of the mode that grows fastest"),
                Column("unstable_modes", "1", "number of modes that grow"),
                Column("equilibrium", "", "kind of equilibrium by linear theory", is_text=True),
                Column("equilibria", "", "number of equilibria in words", is_text=True),
            ),
            of_system=stability_of,
        ),
    )
}


@dataclass(frozen=True)
class Asked:
    """Requested measures.

    Attributes
    ----------
    names : tuple of str
        Names of measures of the table.
    functions : dict
        Functions of a record by name.
    """

    names: tuple[str, ...]
    functions: dict[str, Callable[[xr.Dataset], Value]]

    @property
    def measures(self) -> tuple[Measure, ...]:
        """The measures of the table, including those included by others, each once."""
        found: dict[str, Measure] = {}
        waiting = list(self.names)
        while waiting:
            name = waiting.pop(0)
            if name not in found:
                found[name] = MEASURES[name]
                waiting += MEASURES[name].also
        return tuple(found.values())

    @property
    def needs_record(self) -> bool:
        """Whether any measure needs a record."""
        return bool(self.functions) or any(measure.of_record for measure in self.measures)

    @property
    def variables(self) -> tuple[str, ...] | None:
        """The variables of a record that are used, None if functions may use all."""
        needed = [name for measure in self.measures for name in measure.needs]
        return None if self.functions else tuple(dict.fromkeys(needed))

    @property
    def columns(self) -> tuple[Column, ...]:
        """The variables of the measures; for functions only their names are known."""
        known = [column for measure in self.measures for column in measure.columns]
        return (*known, *(Column(name, "", name) for name in self.functions))

    def of_record(self, run: Run) -> dict[str, Value]:
        """Return the measures of a record; functions receive a labelled one.

        Raises
        ------
        ValueError
            If a measure fails, or returns neither numbers nor texts; the message names it.
        """
        found: dict[str, Value] = {}
        for measure in self.measures:
            if measure.of_record is not None:
                with _naming(measure.name):
                    found |= {name: value_of(value) for name, value in measure.of_record(run).items()}
        for name, function in self.functions.items():
            with _naming(name):
                found[name] = value_of(function(run))  # type: ignore[arg-type]
        return found

    def of_system(self, system: System) -> dict[str, Value]:
        """Return the measures of a system."""
        found: dict[str, Value] = {}
        for measure in self.measures:
            if measure.of_system is not None:
                with _naming(measure.name):
                    found |= {name: value_of(value) for name, value in measure.of_system(system).items()}
        return found


def asked_for(measures: Any) -> Asked:
    """Return the requested measures.

    Parameters
    ----------
    measures : str, mapping or sequence of them
        Names from the table `MEASURES`, or functions of a record by names of your own.

    Raises
    ------
    ValueError
        If a name is unknown, or two are the same.
    """
    entries = [measures] if isinstance(measures, (str, Mapping)) else measures
    if not isinstance(entries, Sequence) or not entries:
        raise ArgumentError("measures", "be names of measures or functions by name", measures)
    names: list[str] = []
    functions: dict[str, Callable[[xr.Dataset], Value]] = {}
    for entry in entries:
        if isinstance(entry, Mapping):
            functions |= {_own_name(name, function): function for name, function in entry.items()}
        elif not isinstance(entry, str) or entry not in MEASURES:
            known = ", ".join(MEASURES)
            raise ArgumentError(
                "measure", f"be one of {known}", entry, got=f"{brief(entry)}{suggestion(entry, list(MEASURES))}"
            )
        elif entry not in names:
            names.append(entry)
    asked = Asked(tuple(names), functions)
    given = [column.name for column in asked.columns]
    clash = next((name for name in given if given.count(name) > 1 or name in OWN), None)
    if clash is not None:
        raise ArgumentError("measures", f"have names other than {', '.join(OWN)} and those of others", clash)
    return asked


def _own_name(name: Any, function: Any) -> str:
    if not isinstance(name, str) or not name or "/" in name or not callable(function):
        raise ArgumentError(
            "measures", "be functions of a record by name", name, got=f"{brief(name)}: {brief(function)}"
        )
    return name


@contextmanager
def _naming(name: str) -> Iterator[None]:
    """Turn an exception of a measure, other than MemoryError, into a ValueError that names the measure."""
    try:
        yield
    except MemoryError:
        raise
    except Exception as error:
        raise ValueError(f"measure {name!r}: {message_of(error)}") from error


def message_of(error: BaseException) -> str:
    """Return an exception in one line, with its type if its message may not explain itself."""
    words = " ".join(str(error).split())
    return words if words and isinstance(error, (ValueError, RuntimeError)) else f"{type(error).__name__}: {words}"


def value_of(value: Any) -> Value:
    """Return a value of a measure as a Python number or text.

    Parameters
    ----------
    value : object
        A number, a text, or an array with one of them.

    Raises
    ------
    ValueError
        If it is neither a number nor a text.
    """
    single = isinstance(value, (np.ndarray, np.generic, xr.DataArray)) and value.size == 1
    plain = value.item() if single else value
    if isinstance(plain, str):
        return plain
    if not isinstance(plain, Real):
        raise ValueError(f"must return a number or a text, got a {type(value).__name__}")
    return float(plain)
