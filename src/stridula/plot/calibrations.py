"""Figure of a calibration to a recording."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .colours import LINE, LINES
from .results import check_result

NEEDED = ("value", "low", "high", "lowest", "highest", "measured", "error", "misfit")
# Height of a row and of what surrounds them [inches].
ROW, REST = 0.34, 1.5
# Units that are not shown.
UNKNOWN = "unknown"
SILENT = (UNKNOWN, "1")
# Errors up to which a model fits, in standard deviations.
FITS = 2.0


def calibration(found: xr.Dataset) -> Figure:
    """Draw the parameters with their intervals in their ranges, and the errors of all measures.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `calibrate_to`.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `found` is anything else.
    """
    check_result("found", found, "calibrate_to", NEEDED)
    rows = max(found.sizes["parameter"], found.sizes["measure"])
    figure = Figure(figsize=(10.0, REST + ROW * rows), layout="constrained", dpi=120)
    left, right = figure.subplots(1, 2)
    _draw_parameters(left, found)
    _draw_errors(right, found)
    undetermined = found.attrs.get("undetermined", "")
    words = f"\nnot determined: {undetermined}" if undetermined else ""
    figure.suptitle(f"Misfit {float(found['misfit']):.3g} standard deviations{words}", fontsize=9, wrap=True)
    return figure


def _draw_parameters(axes: Axes, found: xr.Dataset) -> None:
    places = np.arange(found.sizes["parameter"])
    low, high = found["lowest"].values, found["highest"].values
    value, first, last = ((found[name].values - low) / (high - low) for name in ("value", "low", "high"))
    reach = np.maximum([value - first, last - value], 0.0)
    colours = [LINE if one else LINES[1] for one in found["determined"].values]
    for place, colour in zip(places, colours, strict=True):
        axes.errorbar(
            value[place], place, xerr=reach[:, [place]], fmt="o", color=colour, markersize=5, capsize=4, linewidth=1.6
        )
    for place, one in zip(places, found["value"].values, strict=True):
        unit = str(found["unit"].values[place])
        axes.annotate(
            f"{one:.4g}{'' if unit == 'SI' else f' {unit}'}",
            (value[place], place),
            (0, 7),
            ha="center",
            textcoords="offset points",
            fontsize=8,
        )
    ends = [f"{name}\n{a:.4g} to {b:.4g}" for name, a, b in zip(found["parameter"].values, low, high, strict=True)]
    axes.set_yticks(places, ends, fontsize=8)
    axes.set_ylim(places.size - 0.4, -0.6)
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("place in the range, 95 % interval")
    axes.grid(axis="x", alpha=0.3, linewidth=0.5)


def _draw_errors(axes: Axes, found: xr.Dataset) -> None:
    places = np.arange(found.sizes["measure"])
    axes.axvspan(-FITS, FITS, color="0.85", linewidth=0)
    axes.axvline(0.0, color="0.3", linewidth=0.8)
    axes.plot(found["error"].values, places, "o", color=LINE, markersize=5)
    # Results of before have no units of measures.
    units = found["measure_unit"].values if "measure_unit" in found.coords else [UNKNOWN] * places.size
    rows = zip(found["measure"].values, found["measured"].values, units, strict=True)
    names = [f"{name}\n{one:.5g}{'' if unit in SILENT else f' {unit}'}" for name, one, unit in rows]
    axes.set_yticks(places, names, fontsize=8)
    axes.set_ylim(places.size - 0.4, -0.6)
    most = 1.1 * max(float(np.abs(found["error"].values).max()), 1.5 * FITS)
    axes.set_xlim(-most, most)
    axes.set_xlabel("computed less measured [standard deviations]")
    axes.grid(axis="x", alpha=0.3, linewidth=0.5)
