"""Scenarios as complete TOML text, and their schema for editors."""

from __future__ import annotations

import copy
import re
from pathlib import Path as FilePath
from typing import Any

import tomli_w
import xarray as xr

from ..records.provenance import toml
from .outline import TAGS, Path, node_at, properties
from .read import read_tables
from .schema import json_schema

COMMENT_COLUMN = 32
# Longer lists of rows have each row on its own line.
LONGEST_ROW = 100
_BARE = re.compile(r"[A-Za-z0-9_-]+")


def scenario_text(name_or_path: str | FilePath | xr.Dataset) -> str:
    """Return a scenario as complete TOML, its base merged in and every key explained, to copy and edit."""
    return text_of(read_tables(name_or_path))


def text_of(tables: dict[str, Any]) -> str:
    """Return the tables of a scenario as TOML, every key explained."""
    return "\n".join(_lines(tables, (), tables)).strip() + "\n"


def scenario_schema() -> dict[str, Any]:
    """Return the JSON schema of scenario files, for editors; a key may be left out where a base can give it."""
    schema: dict[str, Any] = _relaxed(copy.deepcopy(json_schema()))
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema, "title": "stridula scenario"}


def _lines(table: dict[str, Any], path: Path, tables: dict[str, Any]) -> list[str]:
    """Return the lines of a table: its values first, then its tables and lists of tables."""
    known = list(properties(node_at(path, tables), table))
    order = [tag for tag in TAGS if tag in known] + [key for key in known if key not in TAGS]
    ordered = sorted(table.items(), key=lambda item: order.index(item[0]) if item[0] in order else len(order))
    lines = []
    for key, value in ordered:
        if not _has_header(value):
            lines += _value_lines(key, value, (*path, key), tables)
    for key, value in ordered:
        if isinstance(value, dict):
            # A table that holds only tables needs no header.
            only_tables = bool(value) and all(isinstance(entry, dict) for entry in value.values())
            header = [] if only_tables else ["", f"[{_header((*path, key))}]"]
            lines += [*header, *_lines(value, (*path, key), tables)]
        elif _has_header(value):
            for number, entry in enumerate(value):
                lines += ["", f"[[{_header((*path, key))}]]", *_lines(entry, (*path, key, number), tables)]
    return lines


def _value_lines(key: str, value: Any, path: Path, tables: dict[str, Any]) -> list[str]:
    is_text = isinstance(value, str) and "\n" in value
    text = tomli_w.dumps({key: value}, multiline_strings=True) if is_text else _with_rows(key, value)
    lines = text.rstrip("\n").split("\n")
    comment = (node_at(path, tables) or {}).get("description")
    if comment and len(path) > 1 and len(lines) == 1:
        lines = [f"{lines[0]:<{COMMENT_COLUMN}}  # {comment}"]
    return lines


def _with_rows(key: str, value: Any) -> str:
    """Return a key and its value, with short lists and rows on one line."""
    name = toml({key: 0}).rpartition(" = ")[0]
    if not isinstance(value, list) or "{" in str(value):
        return toml({key: value})
    line = f"{name} = {_row(value)}"
    if len(line) <= LONGEST_ROW or not any(isinstance(each, list) for each in value):
        return line
    return "\n".join([f"{name} = [", *(f"    {_row(each)}," for each in value), "]"])


def _row(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(map(_row, value))}]"
    return tomli_w.dumps({"x": value}).partition(" = ")[2].strip()


def _has_header(value: Any) -> bool:
    return isinstance(value, dict) or (
        isinstance(value, list) and bool(value) and all(isinstance(entry, dict) for entry in value)
    )


def _header(path: Path) -> str:
    return ".".join(part if _BARE.fullmatch(part) else _quoted(part) for part in path if isinstance(part, str))


def _quoted(key: str) -> str:
    return tomli_w.dumps({key: 0}).rpartition(" = ")[0]


def _relaxed(node: Any) -> Any:
    if isinstance(node, list):
        return [_relaxed(entry) for entry in node]
    if not isinstance(node, dict):
        return node
    kept = {key: value for key, value in node.items() if key not in ("required", "discriminator", "unit")}
    return {"anyOf" if key == "oneOf" else key: _relaxed(value) for key, value in kept.items()}
