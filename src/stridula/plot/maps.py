"""Maps of regimes over two parameters, overlaid with the linear analysis."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..arrays import Array
from ..checks import ArgumentError, instance
from .colours import FAILED_COLOUR, REGIME_COLOURS

# Growth rates at which contours are drawn, as percentiles of those on the map.
PERCENTILES = (15.0, 45.0, 75.0)


def regime_map(found: xr.Dataset) -> Figure:
    """Draw the regimes of a sweep over two parameters by colour, overlaid with the linear analysis as lines.

    The first parameter is along x. A thick line bounds the region where a mode of linear theory grows, thin lines are
    contours of its growth rate [1/s], and a dashed line bounds the region of steady sliding. Runs and linear theory
    disagree where colours and lines do not match. Numbers are drawn in rising order, words in the order given.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `sweep` for a grid of two parameters and the measure ``regime``.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If it lacks the regime over two parameters of at least 2 values each.
    """
    instance("found", found, xr.Dataset)
    if "regime" not in found or found["regime"].ndim != 2 or min(found["regime"].shape) < 2:
        shape = dict(found["regime"].sizes) if "regime" in found else "none"
        raise ArgumentError("found", "have the regime over two parameters of at least 2 values each", found, got=shape)
    across, along = (str(name) for name in found["regime"].dims)
    found = in_order(in_order(found, across), along)
    figure = Figure(figsize=(8.0, 6.0), layout="constrained", dpi=120)
    axes = figure.subplots()
    codes = _codes(found["regime"].values)
    colours = [*REGIME_COLOURS.values(), FAILED_COLOUR]
    norm = BoundaryNorm(np.arange(len(colours) + 1) - 0.5, len(colours))
    x, y = places_of(found, across), places_of(found, along)
    axes.pcolormesh(edges(x), edges(y), codes.T, cmap=ListedColormap(colours), norm=norm, rasterized=True)
    lines = _draw_linear(axes, found, x, y)
    name_axis(axes, found, across, "x")
    name_axis(axes, found, along, "y")
    axes.set_title(str(found.attrs.get("title", "")), fontsize=11)
    patches = [
        Patch(facecolor=colour, edgecolor="0.5", linewidth=0.5, label=f"{word} ({np.count_nonzero(codes == k)})")
        for k, (word, colour) in enumerate([*REGIME_COLOURS.items(), ("failed", FAILED_COLOUR)])
        if (codes == k).any()
    ]
    figure.legend(handles=[*patches, *lines], loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure


def in_order(found: xr.Dataset, key: str) -> xr.Dataset:
    """Return a sweep with the numbers of a key in rising order, each once."""
    if not _is_number(found, key):
        return found
    return found.isel({key: np.unique(found[key].values, return_index=True)[1]})


def _is_number(found: xr.Dataset, key: str) -> bool:
    return found[key].dtype.kind in "fiu"


def places_of(found: xr.Dataset, key: str) -> Array:
    """Return the places of the values of a key on their axis: numbers at their value, words at 0, 1, 2, ..."""
    return found[key].values.astype(float) if _is_number(found, key) else np.arange(found.sizes[key], dtype=float)


def edges(places: Array) -> Array:
    """Return the bounds of cells about their places: halfway between them, the outer ones symmetric about theirs."""
    if places.size == 1:
        return np.array([places[0] - 0.5, places[0] + 0.5])
    middle = 0.5 * (places[1:] + places[:-1])
    return np.concatenate([[2.0 * places[0] - middle[0]], middle, [2.0 * places[-1] - middle[-1]]])


def _codes(regimes: Array) -> Array:
    """Return the number of each regime in the order of the colours, failed ones last."""
    codes = np.full(regimes.shape, len(REGIME_COLOURS))
    for number, word in enumerate(REGIME_COLOURS):
        codes[regimes == word] = number
    return codes


def _draw_linear(axes: Axes, found: xr.Dataset, x: Array, y: Array) -> list[Line2D]:
    """Draw the bounds of linear theory, and return the handles of the legend."""
    if "equilibrium" not in found or "unstable_modes" not in found:
        return []
    handles: list[Line2D] = []
    slides = found["equilibrium"].values == "sliding"
    grows = slides & (np.nan_to_num(found["unstable_modes"].values) > 0)
    if grows.any():
        words = "linear theory: bound of growth" if not grows.all() else "linear theory: a mode grows everywhere"
        # Growth also ends where sliding ends, but that bound is the dashed one.
        handles.append(draw_bound(axes, np.where(slides, grows, np.nan), x, y, "-", words))
        drawn = _draw_growth(axes, np.where(grows, found["growth_rate"].values, np.nan), x, y)
        handles += [Line2D([], [], color="black", linewidth=0.7, label="its growth rate")] if drawn else []
    if slides.any() and not slides.all():
        words = "linear theory: bound of steady sliding"
        handles.append(draw_bound(axes, slides.astype(float), x, y, "--", words))
    return handles


def draw_bound(axes: Axes, inside: Array, x: Array, y: Array, style: str, words: str) -> Line2D:
    """Draw the cell sides between cells inside, 1, and outside, 0, and return the handle of the legend."""
    look: dict[str, Any] = {"linewidth": 2.2 if style == "-" else 1.4, "linestyle": style}
    if np.nanmin(inside) < np.nanmax(inside):
        # Each cell has its own corners, so that the level between two cells lies on the side that they share.
        across, along = (np.repeat(edges(places), 2)[1:-1] for places in (x, y))
        cells = np.repeat(np.repeat(inside, 2, axis=0), 2, axis=1)
        widths, styles = look.values()
        axes.contour(across, along, cells.T, levels=[0.5], colors="black", linewidths=widths, linestyles=styles)
    return Line2D([], [], color="black", label=words, **look)


def _draw_growth(axes: Axes, rates: Array, x: Array, y: Array) -> bool:
    """Draw contours of the growth rate, and return whether there are any."""
    known = rates[np.isfinite(rates)]
    levels = [level for level in _round_levels(known) if known.min() < level < known.max()]
    if min(rates.shape) < 2 or not levels:
        return False
    drawn = axes.contour(x, y, rates.T, levels=levels, colors="black", linewidths=0.7)
    axes.clabel(drawn, fontsize=7, fmt="%g /s")
    return True


def _round_levels(rates: Array) -> list[float]:
    """Return rounded percentiles of the growth rates: these may rise without bound where sliding jams."""
    return sorted({float(f"{rate:.1g}") for rate in np.percentile(rates, PERCENTILES)})


def name_axis(axes: Axes, found: xr.Dataset, key: str, name: str) -> None:
    units = str(found[key].attrs.get("units", ""))
    axis = axes.xaxis if name == "x" else axes.yaxis
    axis.set_label_text(f"{key} [{units}]" if units and units != "1" else key)
    if not _is_number(found, key):
        axis.set_ticks(range(found.sizes[key]), labels=[str(value) for value in found[key].values])
