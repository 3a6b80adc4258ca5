"""Figures of the effects of parameters on a mode of sliding."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ..analysis.mode_effects import mode_of, what_helps
from ..checks import ArgumentError, count
from .colours import LINES

LOWERS, RAISES = LINES[2], LINES[1]
# Height of a bar and of the rest of the figure [inches].
BAR, REST = 0.26, 1.4


def mode_sensitivity(found: xr.Dataset, mode: int | None = None, *, most: int = 20) -> Figure:
    """Draw the changes of growth rate and frequency of a mode by each parameter, the largest first.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `mode_sensitivity`.
    mode : int, optional
        Number of the mode; that which grows fastest if left out.
    most : int, optional
        Largest number of parameters.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `found` is anything else, has no such mode, or predicts no change by a parameter, as with masses alone.
    """
    count("most", most)
    one, table = mode_of(found, mode), what_helps(found, mode)
    table = table.isel(parameter=np.isfinite(table["growth_rate_change"].values)).isel(parameter=slice(0, most))
    if not table.sizes["parameter"]:
        raise ArgumentError("found", "have changes by parameters", found, got="none")
    size = (9.0, REST + BAR * table.sizes["parameter"])
    figure = Figure(figsize=size, layout="constrained", dpi=120)
    left, right = figure.subplots(1, 2, sharey=True)
    places = np.arange(table.sizes["parameter"])
    for axes, name in ((left, "growth_rate"), (right, "frequency")):
        values = table[f"{name}_change"].values
        axes.barh(places, values, color=[RAISES if value > 0.0 else LOWERS for value in values])
        axes.axvline(0.0, color="0.3", linewidth=0.8)
        axes.grid(axis="x", alpha=0.3, linewidth=0.5)
        axes.set_xlabel(f"change of {name.replace('_', ' ')} [{found[name].attrs['units']}]")
    left.set_yticks(places, [str(name) for name in table["parameter"].values], fontsize=8)
    left.invert_yaxis()
    words = f"{float(one['frequency']):.5g} Hz, growth {float(one['growth_rate']):.4g} 1/s"
    figure.suptitle(f"{words}: {100.0 * found.attrs['change']:g} % more of each", fontsize=11)
    return figure
