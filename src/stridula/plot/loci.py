"""Figures of the modes of sliding over a parameter."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..arrays import Array
from ..checks import ArgumentError, instance, listed
from .colours import LINE, LINES

UNSTABLE = LINES[1]
# Share of the axis that a label occupies.
LABEL_WIDTH = 0.09
# States without steady sliding, drawn as bands.
BANDS = {"held": "#cccccc", "lifted off": "#56b4e9", "jammed": "#cc79a7"}


def root_loci(loci: xr.Dataset, critical: Sequence[xr.Dataset] = ()) -> Figure:
    """Draw frequencies and growth rates of the modes of sliding over a parameter.

    Modes that grow are drawn thick and in another colour. Modes lock in where two frequencies merge. Modes that decay
    by a factor e within a period are not drawn, which the legend says. Values without steady sliding have a band in the
    background.

    Parameters
    ----------
    loci : xarray.Dataset
        Result of `root_loci`.
    critical : sequence of xarray.Dataset, optional
        Values of the parameter where stability changes, as `critical_value` returns them.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `loci` is not a result of `root_loci`.
    """
    instance("loci", loci, xr.Dataset)
    lacking = [name for name in ("frequency", "growth_rate", "unstable", "equilibrium") if name not in loci]
    if lacking or loci["equilibrium"].ndim != 1:
        raise ArgumentError("loci", "be the result of root_loci", loci, got=listed(map(str, loci.data_vars)))
    if not isinstance(critical, Sequence) or not all(map(_is_critical, critical)):
        raise ArgumentError("critical", "be a list of results of critical_value", critical)
    key = str(loci["equilibrium"].dims[0])
    loci, hidden = _without_decays(loci)
    figure = Figure(figsize=(8.0, 7.0), layout="constrained", dpi=120)
    above, below = figure.subplots(2, 1, sharex=True)
    for axes, name in ((above, "frequency"), (below, "growth_rate")):
        _draw_modes(axes, loci, key, name)
        _draw_bands(axes, loci, key)
        for one in critical:
            axes.axvline(float(one["value"]), color="0.3", linewidth=0.8, linestyle="--")
        axes.grid(alpha=0.3, linewidth=0.5)
        axes.set_ylabel(f"{name.replace('_', ' ')} [{loci[name].attrs['units']}]")
        axes.margins(x=0.0)
    above.set_ylim(bottom=0.0)
    _scale_growth(below, loci)
    _name_critical(above, loci[key].values, critical)
    below.set_xlabel(with_unit(key, loci[key]))
    present = set(loci["equilibrium"].values)
    _legend(above, [kind for kind in BANDS if kind in present], hidden)
    return figure


def _is_critical(one: object) -> bool:
    return isinstance(one, xr.Dataset) and {"value", "frequency"} <= set(one.variables) and "beyond" in one.attrs


def _without_decays(loci: xr.Dataset) -> tuple[xr.Dataset, bool]:
    """Return the modes without those that decay within a period, of any frequency, and whether there are any."""
    names = ("frequency", "growth_rate")
    vibrates = loci["unstable"] | ~(loci["growth_rate"] < -loci["frequency"])
    return loci.assign({name: loci[name].where(vibrates) for name in names}), not bool(vibrates.all())


def _draw_modes(axes: Axes, loci: xr.Dataset, key: str, name: str) -> None:
    values, grid = loci[name].values, loci[key].values
    grows = loci["unstable"].values
    axes.plot(grid, values, color=LINE, linewidth=0.8)
    # With a marker, a mode that grows at a single value is visible, too.
    drawn = np.where(grows, values, np.nan)
    axes.plot(grid, drawn, color=UNSTABLE, linewidth=2.2, marker="o", markersize=2.2, markeredgewidth=0.0)


def _name_critical(axes: Axes, grid: Array, critical: Sequence[xr.Dataset]) -> None:
    """Label each critical value with its value and the mode that vibrates, below the last label if they overlap."""
    reach, width, row = -np.inf, LABEL_WIDTH * float(grid[-1] - grid[0]), 0
    for one in sorted(critical, key=lambda one: float(one["value"])):
        value, beyond = float(one["value"]), str(one.attrs["beyond"])
        row = row + 1 if value < reach else 0
        is_last = value + width > grid[-1]
        reach = value + (0.0 if is_last else width)
        axes.annotate(
            f"{value:.4g}\n{float(one['frequency']):.0f} Hz" if beyond == "stable" else f"{value:.4g}\n{beyond}",
            (value, 0.98 - 0.1 * row),
            (-3 if is_last else 3, 0),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            ha="right" if is_last else "left",
            va="top",
            fontsize=8,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 1.0},
        )


def _draw_bands(axes: Axes, loci: xr.Dataset, key: str) -> None:
    grid, kinds = loci[key].values, loci["equilibrium"].values
    edges = np.concatenate([[grid[0]], 0.5 * (grid[1:] + grid[:-1]), [grid[-1]]])
    for number, kind in enumerate(kinds):
        if kind in BANDS:
            axes.axvspan(edges[number], edges[number + 1], color=BANDS[kind], alpha=0.35, linewidth=0, zorder=0)


def _scale_growth(axes: Axes, loci: xr.Dataset) -> None:
    """Scale the growth axis over decades on both sides of zero: growth may rise without bound where sliding jams."""
    rates = np.abs(loci["growth_rate"].values[loci["unstable"].values])
    if rates.size:
        typical, largest = float(np.median(rates)), float(rates.max())
        axes.set_yscale("symlog", linthresh=10.0 ** np.floor(np.log10(0.1 * typical)))
        axes.set_ylim(-2.0 * largest, 2.0 * largest)
    axes.axhline(0.0, color="0.3", linewidth=0.8)


def _legend(axes: Axes, kinds: Sequence[str], hidden: bool) -> None:
    decays = "decays, not within a period" if hidden else "decays"
    axes.plot([], [], color=LINE, linewidth=0.8, label=decays)
    axes.plot([], [], color=UNSTABLE, linewidth=2.2, label="grows")
    for kind in kinds:
        axes.fill_between([], [], color=BANDS[kind], alpha=0.35, linewidth=0, label=kind)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2 + len(kinds), fontsize=8, frameon=False)


def with_unit(name: str, values: xr.DataArray) -> str:
    """Return a name with the unit of values, if they have one."""
    units = str(values.attrs.get("units", ""))
    return f"{name} [{units}]" if units not in ("", "1") else name
