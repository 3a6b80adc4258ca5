"""Studies of many runs: ensembles, sweeps, surveys, root loci, calibration, sensitivity, probabilities."""

from __future__ import annotations

from typing import Any

from ..extras import on_first_use

_HOME = {
    "CalibrationProgress": "calibration",
    "Grid": "points",
    "LatinHypercube": "points",
    "RandomPoints": "random_points",
    "Range": "points",
    "SweepProgress": "computed",
    "Target": "calibration",
    "agreement": "verdicts",
    "basin": "basins",
    "StepCheck": "step_checks",
    "calibrate": "calibration",
    "calibrate_to": "recorded",
    "check_step": "step_checks",
    "critical_value": "loci",
    "ensemble": "ensembles",
    "follow_cycle": "branches",
    "mean_and_interval": "ensembles",
    "mode_probability": "growth_probability",
    "mode_sensitivity": "mode_derivatives",
    "modify": "modified",
    "mode_surrogate": "surrogates",
    "orbit_diagram": "orbit_diagrams",
    "regime_probability": "probabilities",
    "root_loci": "loci",
    "sensitivity": "sobol",
    "share_of": "ensembles",
    "smallest_change": "smallest_changes",
    "squeal_survey": "surveys",
    "survey_table": "tables",
    "sweep": "sweeps",
}
__all__ = [*_HOME]


def __getattr__(name: str) -> Any:
    """Import a name from its module on first use, since an ensemble needs no scenarios."""
    return on_first_use(__name__, _HOME, name)
