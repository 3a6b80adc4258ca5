"""The cases offered by the page."""

from __future__ import annotations

from functools import cache
from typing import Any

from ..scenarios.read import read_tables
from .playable import CASES


@cache
def presets() -> list[dict[str, Any]]:
    """Return name, title and description of each case."""
    tables = {name: read_tables(name) for name in CASES}
    return [
        {"name": name, "title": one.get("title", name), "description": one.get("description", "")}
        for name, one in tables.items()
    ]
