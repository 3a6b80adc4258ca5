"""Keys of a scenario that are varied: their places and accepted values."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import Any

from ..checks import ArgumentError, brief, suggestion
from . import outline
from .errors import ScenarioError, as_written, shown
from .keys import located, plain_value
from .outline import Node, Path
from .quantities import parts, quantity
from .read import MESHES, names_files

# Keys of files of a body, whose matrices are read once.
READ_ONCE = ("file", "mass", "stiffness", "labels", "mesh")
_UNIT = re.compile(r"\s*\[[^]]*\]$")


@dataclass(frozen=True)
class Varied:
    """A key that is varied.

    Attributes
    ----------
    key : str
        Key as given.
    path : tuple
        Path in the tables.
    full : str
        Its full key.
    unit : str or None
        SI unit of its numbers, None if it accepts anything else.
    node : dict
        Its node in the schema.
    """

    key: str
    path: Path
    full: str
    unit: str | None
    node: Node

    @property
    def long_name(self) -> str:
        """Description, without the unit."""
        return _UNIT.sub("", str(self.node.get("description", self.full)))

    def read(self, value: Any) -> Any:
        """Return a value in the form that the scenario accepts; its range is checked when the scenario is built.

        Parameters
        ----------
        value : object
            A number, a text such as ``"10 deg"``, a word, or any other value that the key accepts.

        Raises
        ------
        ScenarioError
            If the key does not accept values of its type.
        """
        value = plain_value(value)
        words = outline.words(self.node)
        is_number = isinstance(value, Real) and not isinstance(value, bool)
        number = parts(value) if is_number else None
        if number is not None and not math.isfinite(number[0]):
            raise ScenarioError([f"{self.full} must be finite, got {shown(value)}"])
        if self.unit is not None:
            try:
                quantity(value, self.unit, self.full)
            except ArgumentError as error:
                raise ScenarioError([str(error)]) from None
        elif outline.is_whole(self.node):
            if not is_number or value != int(value):
                raise ScenarioError([f"{self.full} must be a whole number, got {shown(value)}"])
            return int(value)
        elif outline.is_choice(self.node) and value not in words:
            near = suggestion(value, words)
            raise ScenarioError([f"{self.full} must be one of {', '.join(words)}, got {shown(value)}{near}"])
        return value

    def coordinate(self, values: Sequence[Any]) -> tuple[list[Any], dict[str, str]]:
        """Return values as numbers with their unit, or as words, and the attributes of the coordinate.

        Parameters
        ----------
        values : sequence
            Values returned by `read`. Texts in one unit keep it; mixed units are converted to SI.

        Returns
        -------
        values : list of float, int or str
            Plain numbers or words.
        attributes : dict
            ``long_name``, ``key``, and the ``units`` of numbers.
        """
        words = {"long_name": self.long_name, "key": self.full}
        if self.unit is not None:
            known = [found for found in map(parts, values) if found]
            (spelling, *others) = dict.fromkeys(unit for _, unit in known)
            if others:
                return [quantity(value, self.unit) for value in values], words | {"units": self.unit}
            return [number for number, _ in known], words | {"units": spelling or self.unit}
        if all(isinstance(value, Real) and not isinstance(value, bool) for value in values):
            return list(values), words
        return [value if isinstance(value, str) else json.dumps(value, default=str) for value in values], words


def varied_keys(tables: dict[str, Any], keys: Sequence[str], sets: Sequence[Sequence[Any]]) -> list[Varied]:
    """Return the keys that are varied, in their order.

    Parameters
    ----------
    tables : dict
        The tables of a scenario.
    keys : sequence of str
        The keys, full or any unique ending.
    sets : sequence of sequence
        Values of the keys, one set for each point.

    Raises
    ------
    ScenarioError
        If a key is unknown or ambiguous, refers to the same place as another one, or names a file.
    """
    changed, places = _places(tables, keys, sets)
    found: list[Varied] = []
    for key in keys:
        path = places[key]
        full = as_written(path, changed)
        twin = next((one.key for one in found if one.path == path), None)
        if twin is not None:
            raise ScenarioError([f"key must be varied once, got {twin!r} and {key!r}, which both mean {full}"])
        body = outline.look_up(changed, path[:2]) if path[0] == "bodies" else None
        if outline.look_up(body, ("kind",)) == "reduced" and path[-1] in READ_ONCE:
            raise ScenarioError([f"key must not be {full}: matrices are read once for all points, got {brief(key)}"])
        if names_files(body) and path[2] in MESHES:
            raise ScenarioError([f"key must not be {full}: meshes are read once for all points, got {brief(key)}"])
        node = _node(path, changed)
        units = outline.units(node)
        found.append(Varied(key, path, full, units[0] if len(units) == 1 else None, node))
    return found


def _node(path: Path, tables: dict[str, Any]) -> Node:
    """Return the schema node of a key; for a tag, the node with the words of all kinds."""
    if path[-1] in outline.TAGS:
        return outline.properties(outline.node_at(path[:-1], tables))[str(path[-1])]
    return outline.node_at(path, tables) or {}


def _places(
    tables: dict[str, Any], keys: Sequence[str], sets: Sequence[Sequence[Any]]
) -> tuple[dict[str, Any], Mapping[str, Path]]:
    """Return tables in which the keys are known, and the paths of the keys.

    A key may exist only for one of several values of another key, such as the parameters of a law of friction.
    """
    kinds = [number for number, key in enumerate(keys) if key.rpartition(".")[2] in outline.TAGS]
    tried = {tuple(str(values[number]) for number in kinds): values for values in reversed(sets)}
    first: list[str] = []
    for values in reversed(tried.values()):
        changed, places, problems = located(tables, dict(zip(keys, values, strict=True)))
        if not problems:
            return changed, places
        first = first or problems
    raise ScenarioError(first)
