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
from .checks import instance
from .contact import LAWS, ExponentialWeakening, FrictionLaw, LinearWeakening, LuGre, RateAndState, Stribeck
from .disk import write
from .records.variables import STATUS_WORDS

COLUMNS = 1600
LINE = "#1f4e79"
# Okabe & Ito's others, for several lines in one panel.
LINES = (LINE, "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000")
# Okabe & Ito's colours, told apart by colour-blind eyes.
STATUS_COLOURS = {"separated": "#56b4e9", "sticking": "#d55e00", "sliding": "#f0e442"}


def timeline(
    run: xr.Dataset, variables: Sequence[str], span: tuple[float, float] | None = None, title: str | None = None
) -> Figure:
    """Draw recorded variables under each other over one time axis.

    A ``status`` is drawn as a ribbon: at every instant its height is shared among the three states. Of several contacts
    each is a line, and has its own ribbon.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate`.
    variables : sequence of str
        Names of variables over time; of one with several contacts or probes, each is a line with a legend.
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
    ribbons = shown.sizes.get("contact", 1)
    heights = [0.15 + 0.3 * ribbons if name == "status" else 1.0 for name in variables]
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
    """Return what to call each line of a variable with more dimensions than time."""
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
    """Draw a line, or where there are more samples than pixels the band from minimum to maximum of each column."""
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


def _status(axes: Axes, run: xr.Dataset, name: str) -> None:
    share = run["status_share"].values
    ribbons = share.reshape(share.shape[0], -1, share.shape[-1])
    count = ribbons.shape[1]
    for row in range(count):
        # The first contact on top.
        _ribbon(axes, run["time"].values, ribbons[:, row], float(count - 1 - row), labelled=row == 0)
    axes.set_ylim(0.0, float(count))
    axes.set_yticks([])
    axes.set_ylabel("status")
    if count > 1:
        names = [str(contact) for contact in run["contact"].values]
        axes.set_yticks([count - 0.5 - row for row in range(count)], names, fontsize=8)
        axes.hlines(range(1, count), *run["time"].values[[0, -1]], color="white", linewidth=1.5)
    _legend(axes, 3)


def _ribbon(axes: Axes, time: Array, share: Array, bottom: float, labelled: bool) -> None:
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


_PANELS: dict[str, Callable[[Axes, xr.Dataset, str], None]] = {"status": _status}


def friction(law: FrictionLaw, velocities: Array | Sequence[float] | None = None) -> Figure:
    """Draw the coefficient of friction of a law over slip velocity, in steady sliding.

    Where the law sticks, all that it can hold at rest is a vertical line; where bristles or the state of the contact
    hold, a dotted one or none. Rate and state, which goes over decades of speed, is drawn over its logarithm, forward
    sliding only.

    Parameters
    ----------
    law : Coulomb, StaticKinetic, Stribeck, ExponentialWeakening, LinearWeakening, LuGre or RateAndState
        The law.
    velocities : array_like, optional
        Slip velocities to draw it at [m/s], of both signs or one; a range that shows it all if left out.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If an argument is of another kind, or there are less than 2 velocities.
    """
    instance("law", law, LAWS)
    over_decades = isinstance(law, RateAndState)
    chosen = np.unique(_shown_range(law) if velocities is None else _velocities(velocities))
    if over_decades:
        chosen = chosen[chosen > 0.0]
        if chosen.size < 2:
            raise ValueError(f"velocities must be at least 2 above 0 for rate and state, got {velocities!r}")
    figure = Figure(figsize=(6.4, 4.2), layout="constrained", dpi=120)
    axes = figure.subplots()
    for side in (chosen[chosen < 0.0], chosen[chosen > 0.0]):
        axes.plot(side, np.sign(side) * law.coefficient_at(side), color=LINE, linewidth=1.5)
    if not over_decades:
        _draw_rest(axes, law, chosen)
        axes.axhline(0.0, color="0.6", linewidth=0.6, zorder=0)
    else:
        axes.set_xscale("log")
    axes.set_xlabel("slip velocity [m/s]")
    axes.set_ylabel("tangential over normal force [1]")
    axes.grid(alpha=0.3, linewidth=0.5)
    words = str(law) if str(law)[0].isalpha() else f"{law.law}, {law}"
    axes.set_title(words[0].upper() + words[1:], fontsize=11)
    return figure


def _velocities(given: Array | Sequence[float]) -> Array:
    try:
        values = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        values = np.empty(0)
    if values.ndim != 1 or values.size < 2 or not np.isfinite(values).all():
        raise ValueError(f"velocities must be a list of at least 2 finite numbers, got {given!r}")
    return values


def _shown_range(law: FrictionLaw) -> Array:
    """Return velocities over which a law shows all that it does."""
    if isinstance(law, RateAndState):
        return law.velocity * np.geomspace(1e-4, 1e4, 401)
    if isinstance(law, (Stribeck, ExponentialWeakening, LuGre)):
        reach = 5.0 * law.velocity
    elif isinstance(law, LinearWeakening) and law.slope > 0.0 and law.static > law.kinetic:
        reach = 1.5 * (law.static - law.kinetic) / law.slope
    else:
        reach = 1.0
    # Dense about rest, where most laws fall.
    forward = reach * np.linspace(0.0, 1.0, 401)[1:] ** 2
    return np.concatenate([-forward, forward])


def _draw_rest(axes: Axes, law: FrictionLaw, velocities: Array) -> None:
    """Draw what a law can hold at rest, if rest is in sight."""
    if velocities[0] > 0.0 or velocities[-1] < 0.0:
        return
    holds = law.static if isinstance(law, LuGre) else float(law.coefficient_at(np.zeros(1))[0])
    style, words = (":", "bristles hold") if isinstance(law, LuGre) else ("-", "sticking")
    ends = [-holds if velocities[0] < 0.0 else 0.0, holds if velocities[-1] > 0.0 else 0.0]
    axes.plot([0.0, 0.0], ends, color=LINES[1], linewidth=1.5, linestyle=style, label=words)
    axes.legend(fontsize=8, frameon=False, loc="upper left")


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
