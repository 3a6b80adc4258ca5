"""Problems of a scenario, as messages that name the key, the value and the allowed values."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches
from itertools import accumulate
from typing import Any

from pydantic import ValidationError

from ..checks import LONGEST, listed, suggestion
from . import outline
from .outline import Path
from .schema import GENERAL, JOINING, PAIR, TOUCHING

# Problems listed one by one; the rest is counted.
MOST_PROBLEMS = 20
# Greatest length of the whole text, and of one problem.
LONGEST_TEXT, LONGEST_LINE = 1800, 500
# Bodies, contacts, connections or drives of one scenario.
MOST_TABLES = 1000


class ScenarioError(ValueError):
    """An invalid scenario; `problems` holds the first 20 problems, one line each, and the number of others.

    Parameters
    ----------
    problems : sequence of str
        Messages.
    others : int, optional
        Number of further problems without messages.
    """

    def __init__(self, problems: Sequence[str], others: int = 0) -> None:
        lines = tuple(dict.fromkeys(_in_one_line(problem) for problem in problems))
        others = max(others, 0) + max(0, len(lines) - MOST_PROBLEMS)
        lines = lines[:MOST_PROBLEMS]
        self.problems = (*lines, *_counted(others))
        told = _fitting(lines)
        super().__init__("; ".join((*told, *_counted(others + len(lines) - len(told)))))


def _in_one_line(problem: str) -> str:
    line = " ".join(problem.split())
    return line if len(line) <= LONGEST_LINE else f"{line[: LONGEST_LINE - 3]}..."


def _counted(others: int) -> tuple[str, ...]:
    return (f"{others} other problem{'s' if others > 1 else ''}",) if others else ()


def _fitting(lines: Sequence[str]) -> Sequence[str]:
    """Return as many lines as fit into a readable text, at least one."""
    ends = accumulate(len(line) + 2 for line in lines)
    return lines[: max(1, sum(end <= LONGEST_TEXT for end in ends))]


def explain(error: ValidationError, tables: dict[str, Any], written: dict[str, Any]) -> list[str]:
    """Return messages for the first errors of validated `tables`, with the keys as `written` before sharing."""
    details = error.errors(include_url=False)[: MOST_PROBLEMS + 1]
    return [_line(dict(one), tables, written) for one in details]


def wrong_form(tables: dict[str, Any]) -> list[str]:
    """Return the problems of form: keys missing for a pair of beams or for bodies in contacts, and excluded keys.

    Parameters
    ----------
    tables : dict
        The tables as written, before sharing.
    """
    is_general = any(key in tables for key in (*GENERAL, *JOINING))
    wanted, others = (GENERAL, PAIR) if is_general else (PAIR, GENERAL)
    left_out = TOUCHING if any(key in tables for key in TOUCHING) else TOUCHING[1:]
    problems = [
        f"{key} must be left out where there are bodies and contacts, got both" for key in others if key in tables
    ]
    if is_general and isinstance(tables.get("bodies"), dict) and not outline.beams(tables):
        shared = [key for key in outline.SHARED if key in tables]
        problems += [
            f"{key} must be set in a body, got one at the top level, which applies to beams and plates only"
            for key in shared
        ]
    for key in (*GENERAL, *JOINING, "drives"):
        held = tables.get(key)
        if isinstance(held, (dict, list)) and len(held) > MOST_TABLES:
            problems.append(f"{key} must hold at most {MOST_TABLES}, got {len(held)}")
    for key in wanted:
        if key not in tables and key not in left_out:
            problems.append(f"{key} must be given: {(outline.node_at((key,), tables) or {})['description']}")
        elif key in GENERAL and key in tables and not tables[key]:
            problems.append(f"{key} must not be empty, got {shown(tables[key])}")
    return problems


def as_written(path: Path, written: dict[str, Any]) -> str:
    """Return a key as text, without the name of a body or contact that takes the value from the top level."""
    sharers = (*outline.beams(written), *outline.contacts(written))
    body = next((one for one in sharers if path[: len(one)] == one), path)
    shared = path[len(body) :]
    is_shared = bool(shared) and shared[0] in (*outline.SHARED, *outline.SHARED_BY_CONTACTS)
    # A missing key belongs to the table in which it is missing.
    for length in range(len(shared), 0, -1) if is_shared else ():
        if outline.look_up(written, (*body, *shared[:length])) is not None:
            break
        if outline.look_up(written, shared[:length]) is not None:
            return _dotted(shared)
    return _dotted(path)


def _dotted(path: Path) -> str:
    return ".".join(text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..." for text in map(str, path))


def shown(value: Any) -> str:
    """Return a value as text for a message, truncated if long."""
    try:
        text = repr(value)
    except ValueError:
        # An integer of 5000 digits cannot be converted to text.
        return f"a {type(value).__name__}"
    return text if len(text) <= LONGEST else f"{text[: LONGEST - 3]}..."


def _line(error: dict[str, Any], tables: dict[str, Any], written: dict[str, Any]) -> str:
    path = outline.plain(error["loc"], tables)
    context = error.get("ctx", {})
    kind, value = error["type"], error["input"]
    if kind.startswith("union_tag"):
        tag = context["discriminator"].strip("'")
        path, value = (*path, tag), value.get(tag)
        kind = "missing" if kind == "union_tag_not_found" else "literal_error"
    key = as_written(path, written)
    node = outline.node_at(path, tables)
    if kind == "missing":
        return f"{key} must be given: {(node or {}).get('description', 'it is needed')}"
    if kind == "extra_forbidden":
        known = list(outline.properties(outline.node_at(path[:-1], tables), outline.look_up(tables, path[:-1])))
        return (
            f"{key} must be one of the known keys {listed(known)}, got {_dotted(path[-1:])} = {shown(value)}"
            f"{suggestion(path[-1], known) or _elsewhere(path[-1], tables)}"
        )
    if kind == "literal_error":
        allowed = outline.words(node)
        return f"{key} must be one of {', '.join(allowed)}, got {shown(value)}{suggestion(value, allowed)}"
    words = {"list_type": "must be a list", "string_type": "must be a text"}
    words |= dict.fromkeys(("bool_type", "bool_parsing"), "must be true or false")
    words |= dict.fromkeys(("model_type", "model_attributes_type", "dict_type"), "must be a table")
    return f"{key} {context.get('words') or words.get(kind, error['msg'])}, got {shown(value)}"


def _elsewhere(name: str | int, tables: dict[str, Any]) -> str:
    """Return a suggestion of the nearest key of any table."""
    places = {str(place[-1]): ".".join(map(str, place)) for place, _ in outline.paths(tables)}
    near = get_close_matches(str(name), places, n=1, cutoff=0.6) if len(str(name)) <= LONGEST else []
    return f"; did you mean {places[near[0]]!r}?" if near else ""
