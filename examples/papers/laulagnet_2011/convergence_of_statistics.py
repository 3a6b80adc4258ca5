"""Convergence of the statistics of unstable cases, as docs/images/statistics.png.

Squeal and judder of the paper are refined in time step, in elements of the slider and in the cut-off of the modes, each
alone. Every point is the mean over starts perturbed by parts in a million, with its 95 % interval. A few minutes.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import stridula as st
from stridula import analysis, plot
from stridula.studies import share_of

TARGET = Path(__file__).resolve().parents[3] / "docs" / "images" / "statistics.png"
DURATION = 1.0
STATES = ("separated", "sticking", "sliding")
FACTORS = (4.0, 2.0, 1.0, 0.5)
ELEMENTS = (5, 10, 20, 40)
CUTOFFS = (0.25, 0.5, 1.0, 2.0)


def ringing(run: xr.Dataset) -> float:
    """Return the dominant frequency of the normal force between the stops [Hz]."""
    return analysis.dominant_frequency(run["normal_force"], analysis.bursts(run))


def peaks(run: xr.Dataset) -> float:
    """Return the 99th percentile of the normal force [N]."""
    return float(np.percentile(run["normal_force"], 99.0))


# Besides the shares, one measure of each case: its tone or its largest forces.
CASES = {
    "squeal": ("frequency\n[Hz]", ringing),
    "judder": ("99th percentile\nof force [N]", peaks),
    "strong-pressure": ("frequency\n[Hz]", ringing),
}


def refinements(case: str) -> dict[str, list[tuple[float, st.Scenario, float]]]:
    """Return, for each kind of refinement, its abscissa, the scenario and the step."""
    shipped = st.load_scenario(case)
    step = float(shipped.simulate(duration=1e-4).attrs["step"])
    cutoff = shipped.system.slider.cutoff
    # Finer modes need shorter steps: the step follows the cut-off.
    return {
        "time step [µs]": [(1e6 * step * f, shipped, step * f) for f in FACTORS],
        "elements of the slider": [(n, st.load_scenario(case, {"slider.elements": n}), step) for n in ELEMENTS],
        "cut-off of the modes [kHz]": [
            (1e-3 * cutoff * f, st.load_scenario(case, {"cutoff": cutoff * f}), step / max(f, 1.0)) for f in CUTOFFS
        ],
    }


def means(scenario: st.Scenario, own: Callable[[xr.Dataset], float], step: float) -> xr.Dataset:
    """Return the means of the measures over perturbed starts."""
    measures = {state: share_of(state) for state in STATES} | {"own": own}
    return st.ensemble(scenario.system, DURATION, measures, runs=8, step=step, sample_rate=100e3, probes=())


def draw(axes: Axes, places: list[float], found: list[xr.Dataset], names: tuple[str, ...]) -> None:
    """Draw means with their intervals over the refined quantity."""
    for name in names:
        middle = np.array([float(one[f"{name}_mean"]) for one in found])
        half = np.array([float(one[f"{name}_interval"][1] - one[f"{name}_mean"]) for one in found])
        colour = plot.STATUS_COLOURS.get(name, plot.LINE)
        axes.errorbar(places, middle, half, marker="o", markersize=4, capsize=3, color=colour, label=name)
    axes.set_xscale("log")
    axes.set_xticks(places, [f"{place:.3g}" for place in places])
    axes.minorticks_off()
    axes.grid(alpha=0.3, linewidth=0.5)


def main() -> None:
    """Run every refinement and draw it."""
    figure = Figure(figsize=(11.0, 3.2 * len(CASES)), layout="constrained", dpi=110)
    panels = figure.subplots(2 * len(CASES), 3, sharex="col", height_ratios=[2.0, 1.0] * len(CASES))
    for row, (case, (words, own)) in enumerate(CASES.items()):
        for column, (kind, levels) in enumerate(refinements(case).items()):
            found = [means(scenario, own, step) for _, scenario, step in levels]
            print(f"{case}, {kind}: {[round(float(one['separated_mean']), 4) for one in found]}", file=sys.stderr)
            places = [place for place, _, _ in levels]
            shares, below = panels[2 * row, column], panels[2 * row + 1, column]
            draw(shares, places, found, STATES)
            draw(below, places, found, ("own",))
            shares.set_ylim(0.0, 1.0)
            below.set_ylim(0.0, 1.3 * max(float(one["own"].max()) for one in found))
            if column == 0:
                shares.set_ylabel(f"{case}\nshare of time")
                below.set_ylabel(words)
            if row == len(CASES) - 1:
                below.set_xlabel(kind)
    panels[0, 0].legend(fontsize=8)
    plot.save(figure, TARGET)


if __name__ == "__main__":
    main()
