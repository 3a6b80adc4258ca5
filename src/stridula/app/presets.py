"""The cases that the page offers."""

from __future__ import annotations

from functools import cache
from typing import Any

from ..scenarios.load import load_scenario
from .playable import CASES


@cache
def presets() -> list[dict[str, Any]]:
    """Return name, title and description of each case."""
    found = []
    for name in CASES:
        scenario = load_scenario(name)
        found.append({"name": name, "title": scenario.title, "description": scenario.description})
    return found
