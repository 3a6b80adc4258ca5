"""Figures of orbit diagrams and of basins of attraction."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.colors import BoundaryNorm, ListedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..arrays import Array
from ..checks import ArgumentError, instance, listed
from .colours import FAILED_COLOUR, LINE, LINES, REGIME_COLOURS
from .loci import with_unit
from .maps import edges

# Colours and marks of sweeps: those of a falling value are rings below the others, so that both are seen.
SWEEPS = {"up": (LINE, "."), "down": (LINES[1], "o"), "anew": (LINES[2], ".")}
UNSETTLED = "white"
# Share of white by which each further motion of a regime is paler.
PALER = 0.45


def orbit_diagram(found: xr.Dataset) -> Figure:
    """Draw an orbit diagram: the extremes of the motion over the parameter, in a colour for each sweep.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `orbit_diagram`.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `found` is not a result of `orbit_diagram`.
    """
    instance("found", found, xr.Dataset)
    if "orbit" not in found or found["orbit"].dims[1:] != ("sweep", "extreme"):
        raise ArgumentError("found", "be the result of orbit_diagram", found, got=listed(map(str, found.data_vars)))
    orbit = found["orbit"]
    key = str(orbit.dims[0])
    figure = Figure(figsize=(8.0, 5.5), layout="constrained", dpi=120)
    axes = figure.subplots()
    handles = []
    for number, sweep in enumerate(found["sweep"].values.tolist()):
        colour, mark = SWEEPS.get(sweep, (LINES[number % len(LINES)], "."))
        points = orbit.values[:, number]
        places = np.broadcast_to(found[key].values[:, None], points.shape)
        known = np.isfinite(points)
        is_ring = mark == "o"
        look: dict[str, Any] = {"color": colour, "fillstyle": "none" if is_ring else "full", "markeredgewidth": 0.6}
        size = 3.5 if is_ring else 2.5
        order = 2.0 if is_ring else 3.0
        axes.plot(places[known], points[known], mark, markersize=size, zorder=order, rasterized=True, **look)
        handles.append(Line2D([], [], linestyle="", marker=mark, markersize=6.0, label=sweep, **look))
    axes.grid(alpha=0.3, linewidth=0.5)
    axes.set_xlabel(with_unit(key, found[key]))
    axes.set_ylabel(with_unit(str(orbit.attrs.get("long_name", "orbit")), orbit))
    axes.set_title(str(found.attrs.get("title", "")), fontsize=10)
    axes.legend(handles=handles, loc="best", fontsize=8, frameon=False)
    return figure


def basin(found: xr.Dataset) -> Figure:
    """Draw the basins of attraction over two coordinates of the start, in a colour for each motion.

    Motions have the colour of their regime, those of larger amplitude paler; starts that had not settled are white.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `basin`.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `found` is not a result of `basin`.
    """
    instance("found", found, xr.Dataset)
    lacking = [name for name in ("attractor", "attractor_regime", "attractor_amplitude") if name not in found]
    if lacking or found["attractor"].ndim != 2:
        raise ArgumentError("found", "be the result of basin", found, got=listed(map(str, found.data_vars)))
    across, along = (str(name) for name in found["attractor"].dims)
    figure = Figure(figsize=(7.5, 6.0), layout="constrained", dpi=120)
    axes = figure.subplots()
    numbers = np.where(found["message"].values != "", -2, found["attractor"].values)
    labels = ["failed", "not settled"]
    colours: list[Any] = [FAILED_COLOUR, UNSETTLED]
    seen: dict[str, int] = {}
    motions = zip(found["attractor_regime"].values, found["attractor_amplitude"].values, strict=True)
    for regime, amplitude in motions:
        colours.append(_paler(REGIME_COLOURS.get(regime, LINE), seen.get(regime, 0)))
        seen[regime] = seen.get(regime, 0) + 1
        labels.append(f"{regime}, amplitude {amplitude:.3g} m")
    norm = BoundaryNorm(np.arange(-2, len(colours) - 1) - 0.5, len(colours))
    x, y = (found[key].values.astype(float) for key in (across, along))
    axes.pcolormesh(edges(x), edges(y), numbers.T, cmap=ListedColormap(colours), norm=norm, rasterized=True)
    axes.set_xlabel(with_unit(across, found[across]))
    axes.set_ylabel(with_unit(along, found[along]))
    axes.set_title(str(found.attrs.get("title", "")), fontsize=11)
    patches = [
        Patch(facecolor=colour, edgecolor="0.5", linewidth=0.5, label=f"{label} ({(numbers == number - 2).mean():.1%})")
        for number, (colour, label) in enumerate(zip(colours, labels, strict=True))
        if (numbers == number - 2).any()
    ]
    figure.legend(handles=patches, loc="outside lower center", ncols=2, fontsize=8, frameon=False)
    return figure


def _paler(colour: str, times: int) -> tuple[float, ...]:
    left = (1.0 - PALER) ** times
    kept: Array = 1.0 - left * (1.0 - np.array(to_rgb(colour)))
    return tuple(kept.tolist())
