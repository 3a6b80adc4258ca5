"""Figures of the modal assurance criterion between measured and computed modes."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ..checks import ArgumentError, instance

COLOURS = "Blues"
# Size of a cell and of the rest of the figure [inches], and most cells whose values are written.
CELL, REST, SMALLEST, LARGEST = 0.42, 2.2, 4.0, 12.0
MOST_NUMBERS = 400
# Least value that is written into its cell.
LEAST = 0.1


def mac(found: xr.DataArray, *, title: str = "") -> Figure:
    """Draw the agreement of measured with computed mode shapes as a table.

    Parameters
    ----------
    found : xarray.DataArray
        Result of `mac`.
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `found` is anything else.
    """
    instance("found", found, xr.DataArray)
    if found.dims != ("measured", "computed") or "measured_frequency" not in found.coords:
        raise ArgumentError("found", "be the result of mac, measured by computed modes", found, got=dict(found.sizes))
    down, across = found.shape
    size = [float(np.clip(CELL * count + REST, SMALLEST, LARGEST)) for count in (across, down)]
    figure = Figure(figsize=(size[0] + 0.8, size[1]), layout="constrained", dpi=120)
    axes = figure.subplots()
    image = axes.pcolormesh(found.values, cmap=COLOURS, vmin=0.0, vmax=1.0, edgecolors="white", linewidth=0.5)
    figure.colorbar(image, ax=axes, label="modal assurance criterion")
    if found.size <= MOST_NUMBERS:
        for row, column in zip(*np.nonzero(found.values >= LEAST), strict=True):
            value = float(found.values[row, column])
            colour = "white" if value > 0.6 else "black"
            axes.text(column + 0.5, row + 0.5, f"{value:.2f}", ha="center", va="center", fontsize=7, color=colour)
    for axis, word in ((axes.xaxis, "computed"), (axes.yaxis, "measured")):
        count = found.sizes[word]
        every = max(1, count // 30)
        shown = np.arange(0, count, every)
        axis.set_ticks(shown + 0.5, [f"{found[f'{word}_frequency'].values[k]:.4g}" for k in shown], fontsize=8)
        axis.set_label_text(f"{word} mode [Hz]")
    axes.tick_params(axis="x", rotation=90)
    axes.invert_yaxis()
    axes.set_title(title, fontsize=11)
    return figure
