"""Figures of records over time."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..arrays import Array
from ..checks import ArgumentError, finite, listed
from ..records.by_surface import by_surface
from ..records.checked import record
from ..records.variables import STATUS_WORDS
from .colours import LINES, STATUS_COLOURS

COLUMNS = 1600
# Relative variation of a force below which it counts as steady.
STEADY = 1e-3


def timeline(
    run: xr.Dataset, variables: Sequence[str], span: tuple[float, float] | None = None, title: str | None = None
) -> Figure:
    """Draw recorded variables in panels over one time axis.

    A ``status`` is drawn as a ribbon whose height is divided among the three states at every instant. Each of several
    contacts has its own line and ribbon. The points of a surface are drawn as one contact, with the sum of the forces
    and the mean of other variables.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    variables : sequence of str
        Names of variables over time; each of several contacts or probes has its own line in the legend.
    span : tuple of float, optional
        Start and end of the time axis [s]; if left out, the whole run.
    title : str, optional
        Title of the figure; if left out, that of the run.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with ``figure.savefig(path)``.

    Raises
    ------
    ValueError
        If a variable is not in the run, or nothing was recorded in the span.
    """
    record("run", run)
    if isinstance(variables, str) or not isinstance(variables, Sequence) or not variables:
        raise ArgumentError("variables", "be a list of names", variables)
    missing = [name for name in variables if name not in run or "time" not in run[name].dims]
    if missing:
        known = listed(str(name) for name in run.data_vars if "time" in run[name].dims)
        raise ArgumentError("variables", f"be recorded over time in the run ({known})", missing[0])
    record("run", run, *variables, *(["status_share"] if "status" in variables else []))
    shown = by_surface(run if span is None else run.sel(time=slice(*_ends(span))))
    if shown.sizes["time"] < 2:
        raise ArgumentError("span", "hold at least 2 samples of the run", span)
    ribbons = shown.sizes.get("contact", 1)
    heights = [0.15 + 0.3 * ribbons if name == "status" else 1.0 for name in variables]
    figure = Figure(figsize=(9.0, 1.2 + 2.4 * sum(heights)), layout="constrained", dpi=120)
    panels = figure.subplots(len(variables), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    for name, axes in zip(variables, panels, strict=True):
        _PANELS.get(name, draw_line)(axes, shown, name)
        axes.margins(x=0.0)
    panels[-1].set_xlabel("time [s]")
    figure.suptitle(run.attrs.get("title", "") if title is None else title, fontsize=11)
    return figure


def overview(run: xr.Dataset) -> Figure:
    """Draw trajectory, forces, status and the first acceleration probe of a run."""
    record("run", run)
    names = ["contact_position", "normal_force", "tangential_force", "status", "acceleration"]
    return timeline(run, [name for name in names if name in run])


def _ends(span: object) -> tuple[float, float]:
    if not isinstance(span, Sequence) or isinstance(span, str) or len(span) != 2:
        raise ArgumentError("span", "be a start and an end in s", span)
    return finite("span[0]", span[0]), finite("span[1]", span[1])


def draw_line(axes: Axes, run: xr.Dataset, name: str) -> None:
    variable = run[name]
    lines = variable.values.reshape(variable.shape[0], -1).T
    labels = _labels(variable) if len(lines) > 1 else [""]
    for number, (values, label) in enumerate(zip(lines, labels, strict=True)):
        _draw(axes, run["time"].values, values, LINES[number % len(LINES)], label)
    words = name.replace("_", " ")
    axes.set_ylabel(f"{words}\n[{_unit(variable)}]")
    axes.grid(alpha=0.3, linewidth=0.5)
    if len(lines) > 1:
        _legend(axes, min(len(lines), 4))


def _labels(variable: xr.DataArray) -> list[str]:
    """Return a label for each line of a variable with more dimensions than time."""
    named = [variable[dimension].values if dimension in variable.coords else None for dimension in variable.dims[1:]]
    sizes = variable.shape[1:]
    return [
        ", ".join(str(place if names is None else names[place]) for place, names in zip(places, named, strict=True))
        for places in np.ndindex(*sizes)
    ]


def _legend(axes: Axes, columns: int) -> None:
    axes.legend(
        loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, fontsize=8, frameon=False, borderaxespad=0.2
    )


def _unit(variable: xr.DataArray) -> str:
    return str(variable.attrs.get("units", "1")).replace("m/s2", "m/s²")


def _draw(axes: Axes, time: Array, values: Array, colour: str, label: str) -> None:
    """Draw a line or, with more samples than pixels, the band from minimum to maximum of each column."""
    if time.size <= 2 * COLUMNS:
        axes.plot(time, values, color=colour, linewidth=0.9, label=label)
        return
    edges = np.linspace(0, time.size, COLUMNS + 1).astype(int)
    low = np.minimum.reduceat(values, edges[:-1])
    high = np.maximum.reduceat(values, edges[:-1])
    # Neighbouring columns are joined, so that a smooth line stays a line.
    low[1:] = np.minimum(low[1:], values[edges[1:-1] - 1])
    high[1:] = np.maximum(high[1:], values[edges[1:-1] - 1])
    middle = time[(edges[:-1] + edges[1:]) // 2]
    axes.fill_between(middle, low, high, color=colour, linewidth=0.8, label=label)


def draw_status(axes: Axes, run: xr.Dataset, name: str) -> None:
    share = run["status_share"].values
    ribbons = share.reshape(share.shape[0], -1, share.shape[-1])
    count = ribbons.shape[1]
    for row in range(count):
        # The first contact is on top.
        _draw_ribbon(axes, run["time"].values, ribbons[:, row], float(count - 1 - row), labelled=row == 0)
    axes.set_ylim(0.0, float(count))
    axes.set_yticks([])
    axes.set_ylabel("status")
    if count > 1:
        names = [str(contact) for contact in run["contact"].values]
        axes.set_yticks([count - 0.5 - row for row in range(count)], names, fontsize=8)
        axes.hlines(range(1, count), *run["time"].values[[0, -1]], color="white", linewidth=1.5)
    _legend(axes, 3)


def draw_contact(above: Axes, below: Axes, run: xr.Dataset) -> list[Line2D]:
    """Draw forces and status under a film, and return the lines that mark the current time.

    For several contacts, the total force and the mean shares are drawn. Tangential forces in space, which have
    different directions, are left out.
    """
    names = [name for name in ("normal_force", "tangential_force") if "tangent" not in run[name].dims]
    lines = run[names].to_array("force_name").assign_attrs(units="N")
    share = run["status_share"]
    if "contact" in share.dims:
        lines, share = lines.sum("contact", keep_attrs=True), share.mean("contact")
    name = names[0] if len(names) == 1 else "force"
    lines["force_name"] = [one.removesuffix("_force") for one in names]
    draw_line(above, xr.Dataset({name: lines.transpose("time", "force_name")}), name)
    if np.ptp(lines.values) < STEADY * np.abs(lines.values).max():
        # The automatic range would magnify a force that hardly varies and give illegible ticks.
        above.set_ylim(*sorted((0.0, 1.2 * float(lines.mean()))))
    shown = run[[]].assign(status_share=share)
    draw_status(below, shown, "status")
    first, last = run["time"].values[[0, -1]]
    cursors = []
    for axes in (above, below):
        axes.set_xlim(first, last)
        axes.tick_params(labelsize=8)
        axes.yaxis.label.set_fontsize(8)
        cursors.append(axes.axvline(first, color="black", linewidth=1.0))
    above.tick_params(labelbottom=False)
    below.set_xlabel("time [s]", fontsize=8)
    return cursors


def _draw_ribbon(axes: Axes, time: Array, share: Array, bottom: float, labelled: bool) -> None:
    columns = min(COLUMNS, time.size)
    edges = np.linspace(0, time.size, columns + 1).astype(int)
    means = np.add.reduceat(share, edges[:-1], axis=0) / np.diff(edges)[:, None]
    tops = bottom + np.cumsum(means, axis=1)
    first = time[np.minimum(edges, time.size - 1)]
    below = np.full(columns, bottom)
    for column, word in enumerate(STATUS_WORDS):
        top = tops[:, column]
        axes.fill_between(
            first,
            np.append(below, below[-1]),
            np.append(top, top[-1]),
            step="post",
            color=STATUS_COLOURS[word],
            linewidth=0,
            label=word if labelled else None,
        )
        below = top


_PANELS: dict[str, Callable[[Axes, xr.Dataset, str], None]] = {"status": draw_status}
