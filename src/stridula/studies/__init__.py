"""Studies of many runs: ensembles, sweeps and maps, squeal surveys, root loci, calibration, sensitivity."""

from __future__ import annotations

from importlib import import_module
from typing import Any

_HOME = {
    "CalibrationProgress": "calibration",
    "Grid": "points",
    "LatinHypercube": "points",
    "Range": "points",
    "SweepProgress": "computed",
    "Target": "calibration",
    "agreement": "verdicts",
    "calibrate": "calibration",
    "critical_value": "loci",
    "ensemble": "ensembles",
    "mean_and_interval": "ensembles",
    "root_loci": "loci",
    "sensitivity": "sobol",
    "share_of": "ensembles",
    "squeal_survey": "surveys",
    "survey_table": "tables",
    "sweep": "sweeps",
}
__all__ = [*_HOME]


def __getattr__(name: str) -> Any:
    """Import a name from its module on first use, since an ensemble needs no scenarios."""
    if name not in _HOME:
        raise AttributeError(f"module 'stridula.studies' has no attribute {name!r}")
    return getattr(import_module(f".{_HOME[name]}", __name__), name)
