"""The scenarios shipped with the package: their texts and their list, read without heavy imports."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib.resources import files

FOLDER = files(__package__)


@dataclass(frozen=True)
class Case:
    """A shipped scenario.

    Attributes
    ----------
    name, title, source : str
        Name, title and source.
    """

    name: str
    title: str
    source: str


def list_scenarios() -> list[Case]:
    """Return the shipped scenarios, in the order of their sources."""
    tables = {name: tomllib.loads(text) for name, text in shipped("cases").items()}
    cases = [Case(name, table["title"], table["source"]) for name, table in tables.items()]
    return sorted(cases, key=lambda case: case.source)


def shipped(folder: str) -> dict[str, str]:
    """Return the texts of the shipped ``cases`` or ``bases`` by name."""
    found = FOLDER.joinpath(folder).iterdir()
    texts = {entry.name.removesuffix(".toml"): entry for entry in found if entry.name.endswith(".toml")}
    return {name: texts[name].read_text(encoding="utf-8") for name in sorted(texts)}
