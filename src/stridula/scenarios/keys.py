"""Changes to a scenario by key: a full path into its tables, or any unique ending of one."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from typing import Any

from ..checks import LONGEST, brief, listed
from . import outline
from .errors import MOST_PROBLEMS, ScenarioError
from .outline import Path
from .schema import json_schema


def overridden(tables: dict[str, Any], overrides: Mapping[str, Any]) -> tuple[dict[str, Any], list[str]]:
    """Return the tables with values set by key, and the problems of keys that are unknown or ambiguous.

    Parameters
    ----------
    tables : dict
        The tables of a scenario, as in its file.
    overrides : mapping
        Values by keys such as ``contact.friction.coefficient`` or ``coefficient``; a text is read as TOML if
        possible.

    """
    changed, _, problems = located(tables, overrides)
    return changed, problems


def located(tables: dict[str, Any], overrides: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Path], list[str]]:
    """Return the tables with values set by key, the path of each valid key, and the problems of the others."""
    changed = copy.deepcopy(tables)
    places: dict[str, Path] = {}
    problems: list[str] = []
    for number, (key, value) in enumerate(overrides.items()):
        if len(problems) >= MOST_PROBLEMS - 1:
            # Each problem requires a search of the whole outline.
            problems.append(f"keys must be valid before others are checked; {len(overrides) - number} were not checked")
            break
        if key == "base":
            problems.append(f"base must be written in the file and cannot be set by key, got {brief(value)}")
            continue
        value = plain_value(value)
        try:
            places[key] = find(key, changed, is_table=isinstance(value, dict))
        except ScenarioError as error:
            problems += error.problems
            continue
        _set(changed, places[key], value)
    return changed, places, problems


def with_values(tables: dict[str, Any], values: Iterable[tuple[Path, Any]]) -> dict[str, Any]:
    """Return the tables with values set at paths returned by `located`."""
    changed = copy.deepcopy(tables)
    for path, value in values:
        _set(changed, path, copy.deepcopy(value))
    return changed


def find(key: str, tables: dict[str, Any], is_table: bool = False) -> Path:
    """Return the path of a key; the key of a table refers to its only number unless `is_table`."""
    asked = tuple(part.strip() for part in str(key).split("."))
    there = _placed(asked, tables)
    if asked[0] not in outline.SHARED and outline.look_up(tables, there) is not None and outline.node_at(there, tables):
        # A full path to a present value needs no search among all keys.
        return there if is_table else _only_number(key, there, tables)
    known = dict(outline.paths(tables))
    if "bodies" in tables and not outline.beams(tables):
        # Values shared by beams have no meaning without beams.
        known = {path: node for path, node in known.items() if path[0] not in outline.SHARED}
    # The key of a friction refers to that of all contacts if the scenario has one, else to that of a contact.
    known = {
        path: node for path, node in known.items() if path[0] not in outline.SHARED_BY_CONTACTS or path[0] in tables
    }
    full = [path for path in known if _text(path) == asked]
    ending = [path for path in known if _text(path)[-len(asked) :] == asked]
    present = [path for path in ending if outline.look_up(tables, path) is not None]
    # Among keys left out, those in existing tables take precedence.
    beside = [path for path in ending if isinstance(outline.look_up(tables, path[:-1]), (dict, list))]
    candidates = full or present or beside or ending
    if not candidates:
        raise ScenarioError(
            [f"key must be a key of the scenario, got {brief(key)}{_nearest(asked, list(known), tables)}"]
        )
    if len(candidates) > 1:
        places = listed(".".join(_text(path)) for path in candidates)
        raise ScenarioError([f"key must name one place, got {brief(key)}, which fits {places}"])
    path = candidates[0]
    return path if is_table else _only_number(key, path, tables)


def _placed(asked: tuple[str, ...], tables: Any) -> Path:
    """Return the parts of a key as a full path, with numbers for the entries of lists."""
    path: list[str | int] = []
    for part in asked:
        is_entry = isinstance(tables, list) and part.isdecimal()
        path.append(int(part) if is_entry else part)
        tables = outline.look_up(tables, path[-1:])
    return tuple(path)


def _only_number(key: str, path: Path, tables: dict[str, Any]) -> Path:
    node = outline.node_at(path, tables)
    below = outline.properties(node, outline.look_up(tables, path))
    if not below or (node is not None and outline.is_number(node)):
        return path
    numbers = [name for name, node in below.items() if outline.is_number(node)]
    given = [name for name in numbers if outline.look_up(tables, (*path, name)) is not None]
    if len(given or numbers) == 1:
        return (*path, (given or numbers)[0])
    raise ScenarioError([f"key must name one value, got {brief(key)}, a table: set one of its keys {listed(below)}"])


def _set(tables: dict[str, Any], path: Path, value: Any) -> None:
    _make_shared(tables, path)
    table: Any = tables
    for part in path[:-1]:
        held = table.get(part) if isinstance(table, dict) else table[part]
        if not isinstance(held, (dict, list)):
            table[part] = {}
        table = table[part]
    if path[-1] in outline.TAGS and table.get(path[-1]) != value:
        # A table of another kind starts empty: the keys of the old kind do not apply.
        table.clear()
    table[path[-1]] = value


def _make_shared(tables: dict[str, Any], path: Path) -> None:
    """Remove a value that is set for all beams, or all contacts, from each of them."""
    of_contacts = path[0] in outline.SHARED_BY_CONTACTS
    if not of_contacts and path[0] not in outline.SHARED:
        return
    own = path[:-1] if path[-1] in outline.TAGS else path
    for one in outline.contacts(tables) if of_contacts else outline.beams(tables):
        table = outline.look_up(tables, (*one, *own[:-1]))
        if isinstance(table, dict):
            table.pop(own[-1], None)


def plain_value(value: Any) -> Any:
    """Return the TOML value of a text; return anything else unchanged."""
    if not isinstance(value, str):
        return value
    text = value
    try:
        return tomllib.loads(f"value = {text}")["value"] if "\n" not in text else text
    except (ValueError, RecursionError):
        return text


def _of_named(asked: tuple[str, ...], known: list[Path], tables: dict[str, Any]) -> str:
    """Return the nearest key of the contact or connection whose name a key begins with, or an empty text."""
    for path in known:
        if len(asked) > 1 and path[-1] == "name" and outline.look_up(tables, path) == asked[0]:
            below = [other for other in known if other[: len(path) - 1] == path[:-1] and len(other) >= len(path)]
            endings = {".".join(_text(other)[-len(asked) + 1 :]): ".".join(_text(other)) for other in below[::-1]}
            near = get_close_matches(".".join(asked[1:]), endings, n=1, cutoff=0.6)
            return endings[near[0]] if near else ".".join(_text(path[:-1]))
    return ""


def _text(path: Path) -> tuple[str, ...]:
    return tuple(map(str, path))


def _nearest(asked: tuple[str, ...], known: list[Path], tables: dict[str, Any]) -> str:
    if len(".".join(asked)) > LONGEST:
        return ""
    named = _of_named(asked, known, tables)
    if named:
        return f"; did you mean {named!r}?"
    full = [".".join(_text(path)) for path in known]
    endings = [".".join(_text(path)[-len(asked) :]) for path in known]
    near = get_close_matches(".".join(asked), dict.fromkeys([*endings, *full]), n=1, cutoff=0.6)
    return (
        f"; did you mean {near[0]!r}?" if near else f"; the tables are {', '.join(outline.properties(json_schema()))}"
    )
