"""Shipped scenarios as TOML, with the names of the Python API, and their loader."""

from __future__ import annotations

from typing import Any

from ..extras import on_first_use

_HOME = {
    "Case": "shipped",
    "Scenario": "load",
    "ScenarioError": "errors",
    "list_scenarios": "shipped",
    "load_scenario": "load",
    "scenario_schema": "show",
    "scenario_text": "show",
}
__all__ = [*_HOME]


def __getattr__(name: str) -> Any:
    """Import a name from its module on first use, so that a list of cases needs no compiler."""
    return on_first_use(__name__, _HOME, name)
