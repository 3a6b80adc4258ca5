"""Figures of branches of limit cycles and of Floquet multipliers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..arrays import Array
from ..checks import ArgumentError, instance, listed
from .colours import LINE, LINES
from .loci import with_unit
from .results import check_result

STABLE, UNSTABLE, RUNS = LINE, LINES[1], LINES[2]
# Marks of the events on a branch.
MARKS = {"fold": "o", "grazing": "v", "period doubling": "s", "Neimark-Sacker": "D", "Hopf": "^"}


def bifurcation(branch: xr.Dataset, amplitude: str | None = None, runs: xr.DataArray | None = None) -> Figure:
    """Draw amplitude and frequency of a branch of limit cycles over its parameter.

    Stable parts are drawn as lines, unstable ones dashed; folds and other events are marked.

    Parameters
    ----------
    branch : xarray.Dataset
        Result of `follow_cycle`.
    amplitude : str, optional
        Label of the probe whose amplitude is drawn; that with the largest amplitude if left out.
    runs : xarray.DataArray, optional
        Amplitudes of runs for comparison, over a coordinate with the name of the parameter.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `branch` is not a result of `follow_cycle`, or has no such probe.
    """
    instance("branch", branch, xr.Dataset)
    names = [str(name) for name in branch.data_vars if str(name).endswith("_amplitude")]
    if "leading_multiplier" not in branch or not names:
        raise ArgumentError("branch", "be the result of follow_cycle", branch, got=listed(map(str, branch.data_vars)))
    key = str(branch.attrs["parameter"])
    drawn = _amplitude(branch, names, amplitude)
    figure = Figure(figsize=(8.0, 6.5), layout="constrained", dpi=120)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[2.0, 1.0])
    values, stable = branch[key].values, branch["stable"].values
    kind = str(drawn.name).removesuffix("_amplitude")
    for axes, heights in ((above, drawn.values), (below, branch["frequency"].values)):
        _draw(axes, values, heights, stable)
        axes.grid(alpha=0.3, linewidth=0.5)
    _mark_events(above, branch, values, drawn.values)
    if runs is not None:
        above.plot(runs[key], runs, ".", color=RUNS, markersize=5.0, label="runs")
    above.set_ylabel(f"amplitude of the {kind} [{drawn.attrs['units']}]")
    above.set_ylim(bottom=0.0)
    above.set_title(_label_of(drawn), fontsize=9)
    below.set_ylabel("frequency [Hz]")
    below.set_xlabel(with_unit(key, branch[key]))
    above.legend(loc="best", fontsize=8, frameon=False)
    return figure


def multipliers(cycle: xr.Dataset) -> Figure:
    """Draw the Floquet multipliers of a limit cycle in the complex plane, with the unit circle.

    Parameters
    ----------
    cycle : xarray.Dataset
        Result of `limit_cycle`.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `cycle` is not a result of `limit_cycle`.
    """
    check_result("cycle", cycle, "limit_cycle", ("multiplier", "trivial"))
    real, imaginary = cycle["multiplier"].values.T
    trivial = cycle["trivial"].values
    outside = ~trivial & (np.hypot(real, imaginary) > 1.0 + 1e-6)
    figure = Figure(figsize=(6.0, 6.4), layout="constrained", dpi=120)
    axes = figure.subplots()
    turn = np.linspace(0.0, 2.0 * np.pi, 361)
    axes.plot(np.cos(turn), np.sin(turn), color="0.5", linewidth=0.8)
    inside = ~trivial & ~outside
    for chosen, colour, mark, label in (
        (inside, STABLE, "o", "return"),
        (outside, UNSTABLE, "s", "depart"),
        (trivial, "0.3", "+", "along the cycle"),
    ):
        if chosen.any():
            axes.plot(real[chosen], imaginary[chosen], mark, color=colour, markersize=7.0, label=label)
    axes.set_aspect("equal")
    axes.grid(alpha=0.3, linewidth=0.5)
    axes.set_xlabel("real part of the multiplier")
    axes.set_ylabel("imaginary part of the multiplier")
    axes.set_title(str(cycle.attrs["verdict"]), fontsize=9, wrap=True)
    axes.legend(loc="upper left", fontsize=8)
    return figure


def _amplitude(branch: xr.Dataset, names: Sequence[str], wanted: str | None) -> xr.DataArray:
    """Return the amplitudes of a probe along a branch."""
    found = {}
    for name in names:
        dimension = str(branch[name].dims[-1])
        for k, label in enumerate(branch[dimension].values.tolist()):
            found[label, name] = branch[name].isel({dimension: k})
    if wanted is None:
        names_of_displacement = [one for one in found if one[1] == "displacement_amplitude"] or list(found)
        return max((found[one] for one in names_of_displacement), key=lambda values: float(values.max()))
    for (label, _), values in found.items():
        if label == wanted:
            return values
    raise ArgumentError("amplitude", f"be one of {listed(label for label, _ in found)}", wanted)


def _label_of(drawn: xr.DataArray) -> str:
    dimension = f"{str(drawn.name).removesuffix('_amplitude')}_probe"
    return str(drawn[dimension].item()) if dimension in drawn.coords else ""


def _draw(axes: Axes, values: Array, heights: Array, stable: Array) -> None:
    """Draw a quantity along a branch, stable and unstable parts apart; both have the segment between them."""
    for chosen, colour, style, label in (
        (stable, STABLE, "-", "stable"),
        (~stable, UNSTABLE, "--", "unstable"),
    ):
        shown = chosen | np.append(False, chosen[:-1] & ~chosen[1:])
        if chosen.any():
            drawn = np.where(shown, heights, np.nan)
            axes.plot(values, drawn, style, color=colour, linewidth=1.6, label=label, marker=".", markersize=3.0)


def _mark_events(axes: Axes, branch: xr.Dataset, values: Array, heights: Array) -> None:
    """Mark the events of a branch, at the amplitude of the nearest point; a Hopf bifurcation has none."""
    seen = set()
    for kind, value in zip(branch["event_kind"].values.tolist(), branch["event_value"].values.tolist(), strict=True):
        height = 0.0 if kind == "Hopf" else float(heights[np.argmin(np.abs(values - value))])
        axes.plot(
            [value],
            [height],
            MARKS.get(kind, "x"),
            color="black",
            markersize=7.0,
            fillstyle="none",
            clip_on=False,
            label=kind if kind not in seen else None,
        )
        seen.add(kind)
