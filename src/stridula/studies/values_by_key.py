"""Numbers of a scenario or a system by key: one of a table, or those of several contacts or beams together."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from numbers import Real
from pathlib import Path as FilePath
from typing import Any

import numpy as np
import xarray as xr

from ..checks import ArgumentError, brief, listed, suggestion
from ..records.provenance import scenario_toml
from ..scenarios import outline
from ..scenarios.errors import ScenarioError
from ..scenarios.keys import find, overridden, with_values
from ..scenarios.load import scenario_of_tables, tables_in_si
from ..scenarios.outline import Path
from ..scenarios.read import read_tables
from ..system import System

# Tables whose entries have names.
NAMED = ("contact", "contacts", "surfaces", "connections")
# Tables all of whose numbers change the modes; other numbers that do, anywhere and in drives; drives that only start.
LAWS = ("friction", "stiffness", "damping", "turning")
WORDS = (
    *("young", "density", "mass", "coefficient", "tension"),
    *("tangential_stiffness", "tangential_damping", "surface_velocity", "normal_load", "axial", "transverse"),
)
# Speeds of what contacts may have in common.
SPEEDS = ("track.velocity", "surface_velocity")
OF_DRIVES = ("x", "y", "z", "velocity", "acceleration")
STARTS = ("initial velocity", "initial state", "initial equilibrium")
# Numbers of laws that do not change their slopes in sliding.
LEFT_OUT = ("initial_state",)


@dataclass(frozen=True)
class Value:
    """A number of a scenario, or the mean of several that change in proportion.

    Attributes
    ----------
    key : str
        Its key.
    paths : tuple of tuple
        Places in the tables.
    numbers : tuple of float
        Numbers there, in SI.
    units : str
        SI unit.
    tables : dict
        Tables of the scenario, in SI.
    """

    key: str
    paths: tuple[Path, ...]
    numbers: tuple[float, ...]
    units: str
    tables: dict[str, Any]

    @property
    def value(self) -> float:
        """The number, or the mean of several."""
        return float(np.mean(self.numbers))

    def system(self, value: float) -> System:
        """Return the system with another value.

        Raises
        ------
        ArgumentError
            If there is none.
        """
        factor = value / self.value
        given = [(path, factor * number) for path, number in zip(self.paths, self.numbers, strict=True)]
        try:
            return scenario_of_tables(with_values(self.tables, given)).system
        except ScenarioError as error:
            raise ArgumentError(self.key, f"be free to change: {error.problems[0]}", value) from None


def is_written(source: Any) -> bool:
    """Return whether a source is a scenario that is written, unlike a system."""
    return isinstance(source, (str, FilePath, xr.Dataset))


def si_tables(source: Any, overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Return the tables of a scenario or a system in SI, with shared values in each body or contact.

    Parameters
    ----------
    source : str, Path, xarray.Dataset or System
        The scenario, or the system.
    overrides : mapping
        Values by key.

    Raises
    ------
    ScenarioError
        If the scenario cannot be used.
    """
    written = read_tables(source) if is_written(source) else tomllib.loads(scenario_toml(source, (), {"duration": 1.0}))
    tables, problems = overridden(written, overrides)
    if problems:
        raise ScenarioError(problems)
    # The scenario of a system has numbers in SI, and shares none.
    return in_si(tables) if is_written(source) else tables


def in_si(written: dict[str, Any]) -> dict[str, Any]:
    """Return tables as written in SI, with shared values in each body or contact."""
    found: dict[str, Any] = _with_lists(tables_in_si(written))
    return found


def _with_lists(tables: Any) -> Any:
    """Return tables with lists in place of tuples, as they are written."""
    if isinstance(tables, dict):
        return {key: _with_lists(one) for key, one in tables.items()}
    return [_with_lists(one) for one in tables] if isinstance(tables, (list, tuple)) else tables


def value_of(key: str, tables: dict[str, Any]) -> Value:
    """Return the number of a key.

    Raises
    ------
    ScenarioError
        If there is no such key, or it means several places.
    ArgumentError
        If it has no number other than 0.
    """
    paths = _paths(key, tables)
    found = [outline.look_up(tables, path) for path in paths]
    other = [one for one in found if isinstance(one, bool) or not isinstance(one, Real)]
    if other:
        raise ArgumentError("parameters", "be numbers that are given", got=f"{brief(other[0])} for {key}")
    numbers = tuple(float(one) for one in found)
    if not np.mean(numbers):
        words = "be numbers other than 0, whose size is that of their changes: set a small one in overrides"
        raise ArgumentError("parameters", words, got=f"0 for {key}")
    if outline.is_whole(outline.node_at(paths[0], tables)):
        raise ArgumentError("parameters", "not be whole numbers", got=f"{brief(found[0])} for {key}")
    return Value(key, tuple(paths), numbers, units_of(paths[0], tables), tables)


def all_values(tables: dict[str, Any]) -> list[Value]:
    """Return the numbers, other than lengths and places, from which modes follow, that are given and not 0.

    They are those of each contact or surface, connection, body and drive, and the friction of all contacts.
    """
    return [value_of(key, tables) for key in dict.fromkeys(_keys(tables))]


def _keys(tables: dict[str, Any]) -> Iterator[str]:
    contacts = outline.contacts(tables)
    if len(contacts) > 1:
        laws = [outline.look_up(tables, (*path, "friction")) or {} for path in contacts]
        if all(one.get("law") == laws[0].get("law") for one in laws):
            yield from (
                ".".join(("friction", name)) for name in laws[0] if _is_one(tables, (*contacts[0], "friction", name))
            )
    together = [word for word in SPEEDS if _are_equal(tables, word)]
    yield from (f"contacts.{word}" for word in together)
    for path, _ in outline.paths(tables):
        if _is_one(tables, path) and _counts(path, tables) and ".".join(map(str, path[2:])) not in together:
            yield _key(path, tables)


def _are_equal(tables: dict[str, Any], word: str) -> bool:
    """Return whether several contacts have the same number, such as the speed of one track."""
    numbers = [outline.look_up(one, word.split(".")) for one in tables.get("contacts", ())]
    return len(numbers) > 1 and numbers[0] is not None and all(one == numbers[0] for one in numbers)


def units_of(path: Path, tables: dict[str, Any]) -> str:
    """Return the SI unit of a number, empty if it has none; a stiffness of surfaces is one of an area."""
    units = outline.units(outline.node_at(path, tables))
    if len(units) != 1:
        return ""
    is_per_area = path[0] == "surfaces" and "stiffness" in path and units[0] in ("N/m", "N s/m")
    return units[0] + ("3" if is_per_area else "")


def _is_one(tables: dict[str, Any], path: Path) -> bool:
    number = outline.look_up(tables, path)
    is_number = isinstance(number, Real) and not isinstance(number, bool)
    return is_number and bool(number) and not outline.is_whole(outline.node_at(path, tables))


def _counts(path: Path, tables: dict[str, Any]) -> bool:
    """Return whether modes follow from a number, which is none of geometry, history, run or start."""
    last = path[-1]
    if path[0] == "drives":
        return (
            last in (*WORDS, *OF_DRIVES)
            and outline.look_up(tables, (*path[:-1], "kind")) not in STARTS
            and len(path) == 3
        )
    if path[0] not in (*NAMED, "bodies", "slider", "track") or last in LEFT_OUT or "history" in path:
        return False
    return last in WORDS or any(part in LAWS for part in path) or (path[-2:] == ("track", "velocity"))


def _key(path: Path, tables: dict[str, Any]) -> str:
    """Return the key of a path: by the name of the contact or surface, else its full key."""
    if path[0] in NAMED and len(path) > 2 and isinstance(path[1], int):
        entry = outline.look_up(tables, path[:2])
        name = entry.get("surface") or entry.get("name")
        if name:
            return ".".join(map(str, (name, *path[2:])))
    return ".".join(map(str, path))


def _paths(key: str, tables: dict[str, Any]) -> list[Path]:
    """Return the places of a key: that of a path, or those of all entries of a name, all contacts or all beams."""
    if not isinstance(key, str):
        raise ArgumentError("parameters", "be keys", key)
    for name, entries in _names(tables).items():
        if key.startswith(f"{name}."):
            return [_below(entry, key[len(name) + 1 :], key, tables) for entry in entries]
    head, _, rest = key.partition(".")
    if isinstance(tables.get(head), list) and rest and not rest.partition(".")[0].isdigit():
        return _of_all(head, rest, key, tables)
    if head in outline.SHARED_BY_CONTACTS:
        return [_below(entry, key, key, tables) for entry in outline.contacts(tables)]
    if head in outline.SHARED and outline.beams(tables):
        return [_below(entry, key, key, tables) for entry in outline.beams(tables)]
    return [find(key, tables)]


def _of_all(word: str, rest: str, key: str, tables: dict[str, Any]) -> list[Path]:
    """Return the places of a key below all entries of a list that have a number there."""
    places: list[Path] = [(word, number, *rest.split(".")) for number in range(len(tables[word]))]
    given = [place for place in places if _is_one(tables, place)]
    if not given:
        raise ScenarioError([f"key must be a number that an entry of {word} has, got {brief(key)}"])
    return given


def _names(tables: dict[str, Any]) -> dict[str, list[Path]]:
    """Return the places of contacts, surfaces and connections by name; points of a surface also by that of theirs."""
    found: dict[str, list[Path]] = {}
    for word in NAMED:
        entries = tables.get(word)
        for number, entry in enumerate(entries if isinstance(entries, list) else ()):
            for name in {entry.get("name"), entry.get("surface")} - {None, ""}:
                found.setdefault(name, []).append((word, number))
    # A name may begin with another one and a dot.
    return dict(sorted(found.items(), key=lambda one: -len(one[0])))


def _below(entry: Path, rest: str, key: str, tables: dict[str, Any]) -> Path:
    """Return the place of the rest of a key below an entry."""
    try:
        return find(".".join(map(str, (*entry, *rest.split(".")))), tables)
    except ScenarioError:
        known = [
            ".".join(map(str, path[len(entry) :])) for path, _ in outline.paths(tables) if path[: len(entry)] == entry
        ]
        there = [one for one in known if _is_one(tables, (*entry, *one.split(".")))]
        raise ScenarioError(
            [f"key must have a number, got {brief(key)}{suggestion(rest, there)}; these are {listed(there)}"]
        ) from None
