"""Derivatives of the growing modes of a survey by parameters, about the equilibrium from which their runs start."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ..drives import InitialEquilibrium
from ..linear.equilibrium import Equilibrium
from ..linear.reach import equilibrium_at_start
from ..linear.starts import at_rest
from ..linear.structure import Structure
from ..records.variables import described
from ..system import System
from .mode_derivatives import Base
from .task import Outcome, failing, one_thread_each
from .values_by_key import value_of

Velocity = float | tuple[float, ...] | None
NO_DERIVATIVE = "no derivative"


def differentiate(
    known: dict[str, Any], keys: Sequence[str], tables: dict[str, Any], system: System, velocity: Velocity
) -> str:
    """Add the derivatives of the growing modes to the results of a point, and return why there are none by a key.

    Parameters
    ----------
    known : dict
        Results of the point. Each of its ``modes`` gets ``by``, the derivatives of growth rate [1/s] and frequency [Hz]
        for each key, NaN where there are none; the point gets ``by``, value and units of each.
    keys : sequence of str
        Keys, as for `mode_sensitivity`.
    tables : dict
        Tables of the point in SI.
    system : System
        The system of the point, with its own start.
    velocity : float, tuple of float or None
        Slip velocity where nothing prescribes it [m/s].

    Returns
    -------
    str
        The first reason, empty if there is none.
    """
    numbers, reasons = [mode["number"] for mode in known["modes"]], list[str]()
    known["by"] = {}
    for mode in known["modes"]:
        mode["by"] = {key: [float("nan")] * 2 for key in keys}
    with one_thread_each():
        base = Base(system, lambda changed: _at_start(changed, velocity))
        for key in keys:
            told: Outcome = {"ended": "", "message": ""}
            with failing(told, NO_DERIVATIVE):
                value = value_of(key, tables)
                known["by"][key] = [value.value, value.units]
                for mode, slope in zip(known["modes"], base.slopes(value, numbers), strict=True):
                    mode["by"][key] = [slope.real, slope.imag / (2.0 * np.pi)]
            reasons += [f"{key}: {told['message']}"] if told["message"] else []
    return next(iter(reasons), "")


def slopes_over_modes(
    points: Sequence[Mapping[str, Any]],
    rows: Sequence[Mapping[int, Mapping[str, Any]]],
    keys: Sequence[str],
    dimensions: Mapping[str, int],
    count: int,
) -> xr.Dataset:
    """Return the derivatives of the modes of a survey, over the points, ``mode`` and ``parameter``.

    Parameters
    ----------
    points : sequence of mapping
        Results of each point.
    rows : sequence of mapping
        Its modes by their names in the survey.
    keys : sequence of str
        The parameters.
    dimensions : mapping
        Sizes of the dimensions of the points.
    count : int
        Number of modes.
    """
    slopes, values = np.full((2, len(rows), count, len(keys)), np.nan), np.full((len(rows), len(keys)), np.nan)
    units = [""] * len(keys)
    for at, (point, row) in enumerate(zip(points, rows, strict=True)):
        for number, key in enumerate(keys):
            if key in point.get("by", {}):
                values[at, number], units[number] = point["by"][key]
            for name, mode in row.items():
                slopes[:, at, name, number] = mode.get("by", {}).get(key, np.nan)
    shape, over = tuple(dimensions.values()), tuple(dimensions)
    slopes = slopes.reshape(2, *shape, count, len(keys))
    both = (*over, "mode", "parameter")
    return xr.Dataset(
        {
            "d_growth_rate": (both, slopes[0], described("1/s", "derivative of the growth rate, per unit")),
            "d_frequency": (both, slopes[1], described("Hz", "derivative of the frequency, per unit")),
            "parameter_value": (
                (*over, "parameter"),
                values.reshape(*shape, len(keys)),
                {"long_name": "value of the parameter, in its units"},
            ),
        },
        {"parameter": list(keys), "parameter_units": ("parameter", units)},
    )


def _at_start(system: System, velocity: Velocity) -> tuple[Structure, Equilibrium]:
    """Return a system as matrices with its contact points in equilibrium, and the equilibrium at its start."""
    system, start = without_start(system, velocity)
    status = equilibrium_at_start(system, start).status
    _, structure, at = at_rest(system, replace(start, status=status))
    return structure, at


def without_start(system: System, velocity: Velocity) -> tuple[System, InitialEquilibrium]:
    """Return a system without its own start, and the equilibrium to start from.

    Parameters
    ----------
    system : System
        The system; statuses and slip velocities of its initial equilibrium, if any, are kept.
    velocity : float, tuple of float or None
        Slip velocity where nothing prescribes it [m/s], in place of those.
    """
    own = system.initial_equilibrium
    kept = [
        drive for drive in system.drives if drive is not own and drive.uniform_velocity is None and not drive.vectors
    ]
    asked = InitialEquilibrium() if own is None else replace(own, mode=None, amplitude=0.0, phase=0.0)
    return replace(system, drives=kept), asked if velocity is None else replace(asked, velocity=velocity)
