"""Figures of the probability that modes grow."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from .colours import LINE, LINES
from .results import check_result

NEEDED = ("probability", "probability_interval", "band_growth_rate", "frequency")
# Height of a row and of the rest of the figure [inches].
ROW, REST = 0.5, 1.6


def mode_probability(found: xr.Dataset) -> Figure:
    """Draw the probability of growth in each band with its interval, and the growth rates there.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `mode_probability`.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `found` is anything else.
    """
    check_result("found", found, "mode_probability", NEEDED)
    places = np.arange(found.sizes["band"])
    figure = Figure(figsize=(9.0, REST + ROW * places.size), layout="constrained", dpi=120)
    left, right = figure.subplots(1, 2, sharey=True)
    shares, ends = found["probability"].values, found["probability_interval"].transpose("bound", "band").values
    # Points that failed may put the share on an end of the interval, but never beyond.
    reach = np.maximum([shares - ends[0], ends[1] - shares], 0.0)
    left.barh(places, shares, color=LINE, alpha=0.35)
    left.errorbar(shares, places, xerr=reach, fmt="o", color=LINE, markersize=4, capsize=3)
    left.set_xlim(0.0, 1.0)
    left.set_xlabel(f"probability of growth, {100.0 * found.attrs['confidence']:g} % interval")
    for place, rates in zip(places, found["band_growth_rate"].transpose("band", "point").values, strict=True):
        grown = np.sort(rates[np.isfinite(rates)])
        right.plot(
            grown, place - 0.35 + 0.7 * np.arange(grown.size) / max(grown.size, 1), ".", color=LINES[1], markersize=3
        )
    right.set_xlabel("growth rate where one grows, in rising order [1/s]")
    for axes in (left, right):
        axes.grid(axis="x", alpha=0.3, linewidth=0.5)
    names = [f"{one:.5g} Hz" if np.isfinite(one) else "none grows" for one in found["frequency"].values]
    left.set_yticks(places, names)
    left.set_ylim(-0.6, places.size - 0.4)
    failed = int(found["failed"])
    words = f", {failed} failed" if failed else ""
    figure.suptitle(
        f"Probability that any mode grows: {float(found['any_probability']):.3f} "
        f"({int(found['samples'])} points{words})",
        fontsize=11,
    )
    return figure
