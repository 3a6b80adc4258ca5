"""Shipped scenarios as TOML, with the names of the Python API, and their loader."""

from __future__ import annotations

from importlib import import_module
from typing import Any

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
    if name not in _HOME:
        raise AttributeError(f"module 'stridula.scenarios' has no attribute {name!r}")
    return getattr(import_module(f".{_HOME[name]}", __name__), name)
