"""Scenario files: their paths, contents and bases."""

from __future__ import annotations

import sys
import tomllib
from codecs import BOM_UTF16_BE, BOM_UTF16_LE
from functools import cache
from pathlib import Path
from typing import Any

import xarray as xr

from ..checks import brief, suggestion
from ..disk import LARGEST_TEXT, irregular, is_there, named, read
from ..records.files import is_record, scenario_of
from ..records.packed import is_packed
from .errors import ScenarioError, shown
from .inheritance import merged, spelled_out
from .quantities import is_quantity
from .shipped import shipped

FILES = ("file", "mass", "stiffness", "damping", "labels", "mesh")
# Tables of a body that may also name a file.
MESHES = ("profile", "mesh")
# Parts of a scenario whose tables may be in files.
WITH_TABLES = ("contact", "contacts", "surfaces", "connections")
# Table of a mesh with those of its parts.
PARTS = "parts"

# Name of the scenario that another program writes into a pipe.
PIPED = "-"
# Scenarios need 5; functions that recurse over tables allow far more.
DEEPEST = 50


def read_tables(name_or_path: str | Path | xr.Dataset) -> dict[str, Any]:
    """Return the tables of a shipped case, a scenario file or a record, with those of its base.

    Raises
    ------
    ScenarioError
        If it does not exist, is not TOML, or is none of these.
    OSError
        If the file cannot be read.
    """
    if isinstance(name_or_path, xr.Dataset):
        return _record_tables(name_or_path)
    if not isinstance(name_or_path, (str, Path)):
        raise ScenarioError([f"scenario must be a name, a path or a record, got {shown(name_or_path)}"])
    if str(name_or_path) == PIPED:
        return _with_base(_tables_of(_standard_input(), "standard input", Path()), Path(), ())
    cases = shipped("cases")
    if str(name_or_path) in cases:
        return _with_base(_parsed(cases[str(name_or_path)], str(name_or_path)), Path(), ())
    path = Path(name_or_path)
    if not is_there(path):
        raise ScenarioError(
            [
                f"scenario must be a file or one of {', '.join(cases)}, got {named(name_or_path)}"
                f"{suggestion(str(name_or_path), list(cases))}"
            ]
        )
    return _with_base(_file_tables(path), path.parent, (path.resolve(),))


def tables_of_text(text: str, name: str) -> dict[str, Any]:
    """Return the tables of a scenario given as text, with those of a shipped base.

    Parameters
    ----------
    text : str
        The scenario, TOML.
    name : str
        Name in messages.

    Raises
    ------
    ScenarioError
        If it is not TOML, is empty, or names a file.
    """
    tables = _parsed(text, name)
    if not tables:
        raise ScenarioError([f"scenario must not be empty, got {name}: `stridula show squeal` prints one to edit"])
    bases = shipped("bases") | shipped("cases")
    base = tables.get("base")
    if base is not None and not (isinstance(base, str) and base in bases):
        near = suggestion(base, list(bases))
        raise ScenarioError([f"base must be one of {', '.join(bases)} in a text, got {brief(base)}{near}"])
    for key in WITH_TABLES:
        if _has_file(tables.get(key)):
            raise ScenarioError([f"{key} must not name files in a text"])
    named = tables.get("bodies")
    for body in named.values() if isinstance(named, dict) else ():
        if names_files(body):
            raise ScenarioError([f"bodies must not name files in a text, got {brief(', '.join(_files_of(body)))}"])
    return _with_base(tables, Path(), ())


def _record_tables(record: xr.Dataset) -> dict[str, Any]:
    text = record.attrs.get("scenario")
    if not isinstance(text, str):
        raise ScenarioError(["scenario must be a record of simulate, got a Dataset without the attribute scenario"])
    return {"title": str(record.attrs.get("title", ""))} | _parsed(text, "the attribute scenario")


def _file_tables(path: Path) -> dict[str, Any]:
    kind = irregular(path)
    if kind:
        way = f"; {PIPED} reads the standard input" if kind == "pipe" else ""
        raise ScenarioError([f"scenario must be a file, got {str(path)!r}, a {kind}{way}"])
    if is_record(path):
        title, text = scenario_of(path)
        return {"title": title} | _parsed(text, str(path))
    return _tables_of(read(path, most=LARGEST_TEXT), str(path), path.parent)


@cache
def _standard_input() -> bytes:
    """Return the standard input, read only once: several functions may load the same scenario by name."""
    return sys.stdin.buffer.read()


def _tables_of(content: bytes, name: str, folder: Path) -> dict[str, Any]:
    """Return the tables of a text, with the files of bodies found from a folder."""
    try:
        # PowerShell writes UTF-16, marked by the first two bytes.
        text = content.decode("utf-16" if content.startswith((BOM_UTF16_LE, BOM_UTF16_BE)) else "utf-8-sig")
    except UnicodeDecodeError:
        raise ScenarioError(
            [f"scenario must be text in UTF-8 or, with a byte order mark, UTF-16, got {name!r}"]
        ) from None
    tables = _parsed(text, name)
    if not tables:
        raise ScenarioError([f"scenario must not be empty, got {name!r}: `stridula show squeal` prints one to edit"])
    return _with_files(tables, folder)


def _with_files(tables: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return the tables with the files of bodies and of tables resolved relative to the folder of the scenario file."""
    tables = tables | {key: _with_tables_of(tables[key], folder) for key in WITH_TABLES if key in tables}
    bodies = tables.get("bodies")
    if not isinstance(bodies, dict):
        return tables
    return tables | {"bodies": {name: _with_own_files(body, folder) for name, body in bodies.items()}}


def _with_tables_of(part: Any, folder: Path) -> Any:
    """Return a part of a scenario with the files of its laws, profiles and springs found from a folder."""
    if isinstance(part, list):
        return [_with_tables_of(one, folder) for one in part]
    if not isinstance(part, dict):
        return part
    inside = {key: _with_tables_of(value, folder) for key, value in part.items()}
    return inside | ({"file": str(folder / part["file"])} if isinstance(part.get("file"), str) else {})


def _has_file(part: Any) -> bool:
    """Return whether a law, a profile or a spring in a part of a scenario names a file."""
    if isinstance(part, list):
        return any(map(_has_file, part))
    return isinstance(part, dict) and ("file" in part or any(map(_has_file, part.values())))


def _with_own_files(body: Any, folder: Path) -> Any:
    if not isinstance(body, dict):
        return body
    inside = {key: _with_own_files(body[key], folder) for key in MESHES if isinstance(body.get(key), dict)}
    if isinstance(body.get(PARTS), dict):
        inside[PARTS] = {name: _with_own_files(part, folder) for name, part in body[PARTS].items()}
    return body | inside | {key: str(folder / text) for key, text in _own_files(body).items()}


def names_files(body: Any) -> bool:
    """Return whether the table of a body names files with its matrices or its mesh."""
    return bool(_files_of(body))


def _files_of(body: Any) -> list[str]:
    """Return the files named in the table of a body, of its mesh and of the parts of that."""
    if not isinstance(body, dict):
        return []
    parts = body.get(PARTS)
    tables = [*map(body.get, MESHES), *(parts.values() if isinstance(parts, dict) else ())]
    return [file for table in tables for file in _files_of(table)] + list(_own_files(body).values())


def _own_files(table: dict[str, Any]) -> dict[str, str]:
    """Return the files named directly in the table of a body or of its mesh."""
    if table.get("kind", "reduced") != "reduced":
        return {}
    texts = {key: table[key] for key in FILES if isinstance(table.get(key), str)}
    # A damping of "1 %" is not a file.
    return {key: text for key, text in texts.items() if not is_packed(text) and not is_quantity(text, "1")}


def _parsed(text: str, name: str) -> dict[str, Any]:
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        where = str(error).replace("at end of document", f"at its end, line {text.count(chr(10))}")
        raise ScenarioError([f"scenario must be TOML, got {name!r}: {where}"]) from None
    if _is_deeper(tables, DEEPEST):
        raise ScenarioError([f"scenario must nest its tables at most {DEEPEST} deep, got {name!r} with more"])
    return spelled_out(tables)


def _is_deeper(tables: dict[str, Any], depth: int) -> bool:
    """Return whether tables and lists are nested deeper than `depth`."""
    level: list[Any] = [tables]
    for _ in range(depth):
        inside = [value.values() if isinstance(value, dict) else value for value in level]
        level = [value for values in inside for value in values if isinstance(value, (dict, list))]
    return bool(level)


def _with_base(tables: dict[str, Any], folder: Path, above: tuple[Path, ...]) -> dict[str, Any]:
    """Return the tables merged onto those of their base, a shipped one or a file relative to `folder`."""
    if "base" not in tables:
        return tables
    base, own = tables["base"], {key: value for key, value in tables.items() if key != "base"}
    bases = shipped("bases") | shipped("cases")
    if isinstance(base, str) and base in bases:
        return merged(_with_base(_parsed(bases[base], base), folder, above), own)
    path = folder / base if isinstance(base, str) else None
    if path is None or not is_there(path) or not path.is_file():
        allowed = f"base must be a scenario file or one of {', '.join(bases)}"
        raise ScenarioError([f"{allowed}, got {brief(base)}{suggestion(base, list(bases))}"])
    if path.resolve() in above:
        raise ScenarioError([f"base must not refer back to the scenario itself, got {brief(base)}"])
    return merged(_with_base(_file_tables(path), path.parent, (*above, path.resolve())), own)
