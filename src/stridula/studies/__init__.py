"""What many runs say: ensembles of one system from starts left to chance, sweeps of a scenario over its parameters."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "Grid": "points",
    "LatinHypercube": "points",
    "SweepProgress": "sweeps",
    "ensemble": "ensembles",
    "mean_and_interval": "ensembles",
    "share_of": "ensembles",
    "sweep": "sweeps",
}
__all__ = [*_HOME]


def __getattr__(name: str) -> Any:
    """Import a name from its home on first use: an ensemble needs no scenarios."""
    if name not in _HOME:
        raise AttributeError(f"module 'stridula.studies' has no attribute {name!r}")
    return getattr(import_module(f".{_HOME[name]}", __name__), name)
