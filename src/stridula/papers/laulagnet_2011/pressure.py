"""Frequency of the relaxations over the load, as medians over starts: section 3.4."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from ... import analysis
from ...analysis.stability import sliding_stability
from ...arrays import Array
from ...integration import simulate_many
from ...studies.ensembles import perturbed_starts
from .runs import Runs, median_over_starts

PRESSURES = tuple(float(load) for load in np.round(np.geomspace(10.0, 200.0, 24), 1))
LOADS = (20.0, 40.0, 80.0, 150.0)
# Starts under each load, computed side by side.
STARTS = 8


@dataclass(frozen=True)
class Relaxations:
    """Frequencies of the relaxations under one load.

    Attributes
    ----------
    load : float
        Normal load [N].
    frequency, resolution : ndarray, shape (starts,)
        Dominant frequency inside the relaxations and its resolution [Hz]; NaN for a start without relaxations.
    """

    load: float
    frequency: Array
    resolution: Array

    @property
    def median(self) -> float:
        """Median frequency over the starts [Hz]."""
        return median_over_starts(self.frequency)[0]

    @property
    def resolved(self) -> float:
        """Median resolution over the starts [Hz]."""
        return median_over_starts(self.resolution)[0]


def relaxation(run: xr.Dataset) -> tuple[float, float]:
    """Return the dominant frequency in the relaxations of a run and its resolution [Hz]."""
    between = analysis.bursts(run)
    force = run["normal_force"]
    return analysis.dominant_frequency(force, between), analysis.frequency_resolution(force, between)


def relaxations(runs: Runs, loads: Sequence[float] = PRESSURES) -> list[Relaxations]:
    """Return the relaxations under each of some loads [N], computed once for a set of runs."""
    return [runs.once(f"relaxations under {load:g} N", partial(_under, runs, load)) for load in loads]


def _under(runs: Runs, load: float) -> Relaxations:
    runs.report(f"relaxations under {load:g} N from {STARTS} starts")
    scenario = runs.scenario("strong-pressure", normal_load=load)
    systems = perturbed_starts(scenario.system, STARTS)
    found = np.array(simulate_many(systems, scenario.duration, relaxation, probes=(), provenance=False))
    known = np.isfinite(found[:, 0])
    return Relaxations(load, found[:, 0], np.where(known, found[:, 1], np.nan))


def largest_fall(runs: Runs) -> float:
    """Return the largest fall of the median frequency below that of a lower load, in resolutions [1]."""
    known = _known(runs)
    falls = [
        (before.median - after.median) / max(before.resolved, after.resolved)
        for k, after in enumerate(known)
        for before in known[:k]
    ]
    return max(0.0, *falls) if len(falls) > 1 else float("nan")


def rise(runs: Runs) -> float:
    """Return the median frequency under the highest load over that under the lowest with relaxations [1]."""
    known = _known(runs)
    return known[-1].median / known[0].median if known else float("nan")


def rise_without_a_fall(runs: Runs) -> float:
    """Return `rise`, or NaN if the frequency falls by more than its resolution between two loads."""
    return rise(runs) if largest_fall(runs) <= 1.0 else float("nan")


def ladder_words(runs: Runs) -> str:
    """Return the median frequency under each load and the largest fall as text."""
    return f"largest fall {largest_fall(runs):.3g} resolutions; " + ", ".join(
        f"{one.load:g} N: {one.median:.0f} Hz" for one in relaxations(runs)
    )


def _known(runs: Runs) -> list[Relaxations]:
    return [one for one in relaxations(runs) if np.isfinite(one.median)]


def growing_modes(runs: Runs) -> list[tuple[float, float, str]]:
    """Return frequency [Hz], growth rate [1/s] and name of the growing modes of steady sliding.

    A mode is named after the nearest mode in frequency of the slider with its tip pinned.
    """
    system = runs.scenario("strong-pressure").system
    found: Any = sliding_stability(system)
    pinned = replace(system.slider, tip_support="pinned").modes().frequency
    pinned = pinned[pinned > 0.0]
    modes = []
    for k in np.flatnonzero(found["unstable"].values):
        frequency, growth = float(found["frequency"][k]), float(found["growth_rate"][k])
        near = int(np.argmin(np.abs(pinned - frequency)))
        modes.append((frequency, growth, f"slider with its tip pinned, mode {near + 1} ({pinned[near]:.0f} Hz)"))
    return modes
