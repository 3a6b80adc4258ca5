"""The paper's figures 2 to 21, with the same quantities and axes, and the frequency over the load."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ... import analysis
from ...plot import timeline
from ...plot.colours import LINES
from .pressure import STARTS, growing_modes, relaxations
from .runs import Runs, median_over_starts


@dataclass(frozen=True)
class PaperFigure:
    """One figure of the paper.

    Attributes
    ----------
    number : int
        Number of the figure.
    case : str
        Case that it shows.
    variable : str
        Variable drawn over time.
    caption : str
        Caption.
    zoomed : bool
        Whether it shows one burst only.
    """

    number: int
    case: str
    variable: str
    caption: str
    zoomed: bool = False

    @property
    def file_name(self) -> str:
        """Name of its file."""
        return f"figure-{self.number:02d}.png"

    def draw(self, runs: Runs) -> Figure:
        """Draw the figure from the run of the case."""
        run = runs.record(self.case)
        title = f"Figure {self.number}. {self.caption}"
        names = [self.variable, "status"] if self.zoomed else [self.variable]
        return timeline(run, names, span=_one_burst(run) if self.zoomed else None, title=title)


def _one_burst(run: xr.Dataset) -> tuple[float, float]:
    """Return a span around the first complete burst after 0.2 s, or around 0.2 s if there is none."""
    found = analysis.bursts(run)
    late = found[found[:, 0] > 0.2]
    first, last = late[0] if len(late) else (0.2, 0.25)
    margin = 0.5 * (last - first)
    return float(first - margin), float(last + margin)


def pressure_figure(runs: Runs) -> Figure:
    """Draw the frequencies of all starts over the load, their medians, and the growing modes of steady sliding."""
    figure = Figure(figsize=(8.0, 5.0), layout="constrained")
    axes = figure.subplots()
    known = relaxations(runs)
    loads = np.repeat([one.load for one in known], STARTS)
    axes.plot(loads, np.concatenate([one.frequency for one in known]), "o", color=LINES[0], alpha=0.25, mec="none")
    medians = np.array([one.median for one in known])
    bounds = np.array([median_over_starts(one.frequency)[1] or (np.nan, np.nan) for one in known])
    at = [one.load for one in known]
    axes.vlines(at, *bounds.T, color=LINES[0])
    axes.plot(
        at, medians, "-", color=LINES[0], marker="_", markersize=10, label=f"median of {STARTS} starts, its interval"
    )
    for frequency, growth, name in growing_modes(runs):
        axes.axhline(frequency, color="0.4", linewidth=0.8, linestyle="--")
        words = f"{frequency:.0f} Hz, grows at {growth:.0f} 1/s: {name}"
        axes.annotate(words, (1.0, frequency), (-4, 3), ("axes fraction", "data"), "offset points", ha="right", size=8)
    axes.set(xscale="log", xlabel="Normal load [N]", ylabel="Frequency of the relaxations [Hz]", ylim=(0.0, None))
    axes.set_xticks([10, 20, 50, 100, 200], labels=["10", "20", "50", "100", "200"])
    axes.legend(loc="upper left", frameon=False)
    axes.set_title("Frequency of the relaxations at 1 cm/s over the load")
    return figure


PRESSURE_FIGURE = "frequency-over-load.png"
FIGURES = (
    PaperFigure(2, "stable-sliding", "contact_position", "Trajectory of the contact point, stable case"),
    PaperFigure(3, "stable-sliding", "status", "Status of the contact point, stable case"),
    PaperFigure(4, "stable-sliding", "normal_force", "Normal contact force, stable case"),
    PaperFigure(5, "stable-sliding", "tangential_force", "Tangential contact force, stable case"),
    PaperFigure(6, "squeal", "contact_position", "Trajectory of the contact point, squealing case"),
    PaperFigure(7, "squeal", "status", "Status of the contact point, squealing case"),
    PaperFigure(8, "squeal", "normal_force", "Normal contact force, squealing case"),
    PaperFigure(9, "squeal", "tangential_force", "Tangential contact force, squealing case"),
    PaperFigure(10, "squeal", "normal_force", "The squeal appears and disappears", zoomed=True),
    PaperFigure(11, "judder", "contact_position", "Trajectory of the contact point, juddering case"),
    PaperFigure(12, "judder", "status", "Status of the contact point, juddering case"),
    PaperFigure(13, "judder", "normal_force", "Normal contact force, juddering case"),
    PaperFigure(14, "judder", "tangential_force", "Tangential contact force, juddering case"),
    PaperFigure(15, "weak-pressure", "normal_force", "Normal contact force, 1 cm/s under 2 N"),
    PaperFigure(16, "weak-pressure", "contact_position", "Trajectory of the contact point, 1 cm/s under 2 N"),
    PaperFigure(17, "weak-pressure", "acceleration", "Acceleration of the track's centre, 1 cm/s under 2 N"),
    PaperFigure(18, "strong-pressure", "normal_force", "Normal contact force, 1 cm/s under 50 N"),
    PaperFigure(19, "strong-pressure", "contact_position", "Trajectory of the contact point, 1 cm/s under 50 N"),
    PaperFigure(20, "strong-pressure", "acceleration", "Acceleration of the track's centre, 1 cm/s under 50 N"),
    PaperFigure(21, "strong-pressure", "status", "Status of the contact point, 1 cm/s under 50 N"),
)
