"""Figures from Datasets (matplotlib lives here and nowhere else)."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .bodies.modes import Array
from .records.files import write
from .records.variables import STATUS_WORDS

COLUMNS = 1600
LINE = "#1f4e79"
# Okabe & Ito's colours, told apart by colour-blind eyes.
STATUS_COLOURS = {"separated": "#56b4e9", "sticking": "#d55e00", "sliding": "#f0e442"}


def timeline(
    run: xr.Dataset, variables: Sequence[str], span: tuple[float, float] | None = None, title: str | None = None
) -> Figure:
    """Draw recorded variables under each other over one time axis.

    A ``status`` is drawn as a ribbon: at every instant its height is shared among the three states.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    variables : sequence of str
        Names of variables over time; of a variable with several probes, each probe is a line.
    span : tuple of float, optional
        Start and end of the time axis [s]; the whole run if left out.
    title : str, optional
        Title of the figure; the run's own if left out.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with ``figure.savefig(path)``.

    Raises
    ------
    ValueError
        If a variable is not in the run, or nothing was recorded in the span.
    """
    missing = [name for name in variables if name not in run or "time" not in run[name].dims]
    if missing:
        known = ", ".join(str(name) for name in run.data_vars if "time" in run[name].dims)
        raise ValueError(f"variables must be recorded over time in the run ({known}), got {missing[0]!r}")
    shown = run.sel(time=slice(*span)) if span is not None else run
    if shown.sizes["time"] < 2:
        raise ValueError(f"span must hold at least 2 samples of the run, got {span!r}")
    heights = [0.45 if name == "status" else 1.0 for name in variables]
    figure = Figure(figsize=(9.0, 1.2 + 2.4 * sum(heights)), layout="constrained", dpi=120)
    panels = figure.subplots(len(variables), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    for name, axes in zip(variables, panels, strict=True):
        _PANELS.get(name, _line)(axes, shown, name)
        axes.margins(x=0.0)
    panels[-1].set_xlabel("time [s]")
    figure.suptitle(run.attrs.get("title", "") if title is None else title, fontsize=11)
    return figure


def overview(run: xr.Dataset) -> Figure:
    """Draw trajectory, forces, status and the first acceleration probe of a run."""
    names = ["contact_position", "normal_force", "tangential_force", "status", "acceleration"]
    return timeline(run, [name for name in names if name in run])


def _line(axes: Axes, run: xr.Dataset, name: str) -> None:
    variable = run[name]
    for values in np.atleast_2d(variable.values.T):
        _draw(axes, run["time"].values, values)
    words = name.replace("_", " ")
    axes.set_ylabel(f"{words}\n[{_unit(variable)}]")
    axes.grid(alpha=0.3, linewidth=0.5)


def _unit(variable: xr.DataArray) -> str:
    return str(variable.attrs.get("units", "1")).replace("m/s2", "m/s²")


def _draw(axes: Axes, time: Array, values: Array) -> None:
    """Draw a line, or where there are more samples than pixels the band from minimum to maximum of each column."""
    if time.size <= 2 * COLUMNS:
        axes.plot(time, values, color=LINE, linewidth=0.9)
        return
    edges = np.linspace(0, time.size, COLUMNS + 1).astype(int)
    low = np.minimum.reduceat(values, edges[:-1])
    high = np.maximum.reduceat(values, edges[:-1])
    # Neighbouring columns are joined, so that a smooth line stays a line.
    low[1:] = np.minimum(low[1:], values[edges[1:-1] - 1])
    high[1:] = np.maximum(high[1:], values[edges[1:-1] - 1])
    middle = time[(edges[:-1] + edges[1:]) // 2]
    axes.fill_between(middle, low, high, color=LINE, linewidth=0.8)


def _status(axes: Axes, run: xr.Dataset, name: str) -> None:
    share = run["status_share"].values
    time = run["time"].values
    columns = min(COLUMNS, time.size)
    edges = np.linspace(0, time.size, columns + 1).astype(int)
    means = np.add.reduceat(share, edges[:-1], axis=0) / np.diff(edges)[:, None]
    tops = np.cumsum(means, axis=1)
    first = time[np.minimum(edges, time.size - 1)]
    below = np.zeros(columns)
    for column, word in enumerate(STATUS_WORDS):
        top = tops[:, column]
        axes.fill_between(
            first,
            np.append(below, below[-1]),
            np.append(top, top[-1]),
            step="post",
            color=STATUS_COLOURS[word],
            linewidth=0,
            label=word,
        )
        below = top
    axes.set_ylim(0.0, 1.0)
    axes.set_yticks([])
    axes.set_ylabel("status")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3, fontsize=8, frameon=False, borderaxespad=0.2)


_PANELS: dict[str, Callable[[Axes, xr.Dataset, str], None]] = {"status": _status}


def save(figure: Figure, path: str | Path) -> None:
    """Write a figure in the format that the name's end asks for, whole or not at all.

    Raises
    ------
    ValueError
        If matplotlib does not know the format.
    OSError
        If the file cannot be written.
    """
    kind = Path(path).suffix.lower().removeprefix(".")
    image = io.BytesIO()
    figure.savefig(image, format=kind)
    write(path, image.getvalue())
