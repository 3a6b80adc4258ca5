"""Maps of regimes over two parameters, with the linear analysis over them."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..bodies.modes import Array
from .colours import FAILED_COLOUR, REGIME_COLOURS

# Growth rates at which contours are drawn, as percentiles of those on the map, and the fewest that give any.
PERCENTILES, FEWEST = (15.0, 45.0, 75.0), 8


def regime_map(found: xr.Dataset) -> Figure:
    """Draw the regimes of a sweep over two parameters by colour, with the linear analysis as lines over them.

    The first parameter is along x. A thick line bounds where linear theory has a mode that grows, thin ones are
    contours of its growth rate [1/s]; a dashed line bounds where it has a contact that slides steadily. Where colours
    and lines do not go together, the two disagree.

    Parameters
    ----------
    found : xarray.Dataset
        What `sweep` returned for a grid of two parameters and the measure ``regime``.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If there is no regime over two parameters of at least 2 values each.
    """
    if "regime" not in found or found["regime"].ndim != 2 or min(found["regime"].shape) < 2:
        shape = dict(found["regime"].sizes) if "regime" in found else "none"
        raise ValueError(f"found must have the regime over two parameters of at least 2 values each, got {shape}")
    across, along = (str(name) for name in found["regime"].dims)
    figure = Figure(figsize=(8.0, 6.0), layout="constrained", dpi=120)
    axes = figure.subplots()
    codes = _codes(found["regime"].values)
    colours = [*REGIME_COLOURS.values(), FAILED_COLOUR]
    norm = BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours))
    x, y = found[across].values, found[along].values
    axes.pcolormesh(x, y, codes.T, cmap=ListedColormap(colours), norm=norm, shading="nearest", rasterized=True)
    lines = _draw_linear(axes, found, x, y)
    axes.set_xlabel(_label(found, across))
    axes.set_ylabel(_label(found, along))
    title = str(found.attrs.get("title", ""))
    axes.set_title(title, fontsize=11)
    patches = [
        Patch(facecolor=colour, edgecolor="0.5", linewidth=0.5, label=f"{word} ({np.count_nonzero(codes == k)})")
        for k, (word, colour) in enumerate([*REGIME_COLOURS.items(), ("failed", FAILED_COLOUR)])
        if (codes == k).any()
    ]
    figure.legend(handles=[*patches, *lines], loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure


def _codes(regimes: Array) -> Array:
    """Return the number of each regime in the order of the colours, failed ones last."""
    codes = np.full(regimes.shape, len(REGIME_COLOURS))
    for number, word in enumerate(REGIME_COLOURS):
        codes[regimes == word] = number
    return codes


def _draw_linear(axes: Axes, found: xr.Dataset, x: Array, y: Array) -> list[Line2D]:
    """Draw what linear theory says, and return the handles of the legend."""
    if "equilibrium" not in found or "unstable_modes" not in found:
        return []
    handles: list[Line2D] = []
    slides = found["equilibrium"].values == "sliding"
    grows = np.where(slides, found["unstable_modes"].values > 0, np.nan)
    if np.nanmin(grows, initial=1.0) < np.nanmax(grows, initial=0.0):
        # Bounds lie halfway between points: a level of a growth rate would be drawn by how fast it falls beside.
        axes.contour(x, y, grows.T, levels=[0.5], colors="black", linewidths=2.0)
        handles.append(Line2D([], [], color="black", linewidth=2.0, label="linear theory: a mode begins to grow"))
    rates = np.where(grows == 1.0, found["growth_rate"].values, np.nan)
    levels = _round_levels(rates[np.isfinite(rates)])
    if levels:
        drawn = axes.contour(x, y, rates.T, levels=levels, colors="black", linewidths=0.7)
        axes.clabel(drawn, fontsize=7, fmt="%g /s")
        handles.append(Line2D([], [], color="black", linewidth=0.7, label="its growth rate"))
    if slides.any() and not slides.all():
        axes.contour(x, y, slides.T.astype(float), levels=[0.5], colors="black", linewidths=1.2, linestyles="--")
        words = "linear theory: bound of steady sliding"
        handles.append(Line2D([], [], color="black", linewidth=1.2, linestyle="--", label=words))
    return handles


def _round_levels(rates: Array) -> list[float]:
    """Return growth rates that part all evenly, rounded; they may rise without bound where sliding jams."""
    if rates.size < FEWEST:
        return []
    return sorted({float(f"{rate:.1g}") for rate in np.percentile(rates, PERCENTILES)})


def _label(found: xr.Dataset, key: str) -> str:
    units = str(found[key].attrs.get("units", ""))
    return f"{key} [{units}]" if units and units != "1" else key
