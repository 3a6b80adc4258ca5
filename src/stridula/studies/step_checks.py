"""The step of a run on trial: the run again at half its step, and how far its results move."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from ..analysis.regimes import regime_of
from ..arrays import Array
from ..checks import ArgumentError
from ..integration import Diverged
from ..records import checked
from ..records.changes import played
from ..scenarios.load import load_scenario

# Two runs have parted if their forces differ by more than this fraction of the fluctuation.
PARTED = 0.1
# Number of windows of a record in which runs are compared and their growth is measured.
WINDOWS = 100
# Conditions for growth: smallest number of windows, smallest rise of the fluctuation, and largest scatter of its
# logarithm about a straight line.
FEWEST, RISE, SCATTER = 8, 3.0, 0.1
# A step is fine enough if halving it changes results by less than this: relative, in decibels, and in shares of the
# time.
RELATIVE, DECIBELS, SHARE = 0.01, 0.5, 0.02
NUMBERS = {"frequency": ("Hz", RELATIVE), "level": ("dB", DECIBELS), "growth": ("1/s", RELATIVE)}
SHARES = ("separated", "sticking", "sliding")


@dataclass(frozen=True)
class Moved:
    """A result of a run and of the same run at half the step.

    Attributes
    ----------
    name, units : str
        Name and units.
    value, finer : float
        The result at the step and at half of it; NaN if a run has none.
    change : float
        Change: relative, for levels in decibels and for shares absolute.
    allowed : float
        Largest change of a step that is fine enough.
    """

    name: str
    units: str
    value: float
    finer: float
    change: float
    allowed: float

    @property
    def is_small(self) -> bool:
        """Whether the change is small; so is that of a result that neither run has."""
        return bool(abs(self.change) <= self.allowed) or (math.isnan(self.value) and math.isnan(self.finer))

    def __str__(self) -> str:
        """Return the result in words."""
        if math.isnan(self.value) or math.isnan(self.finer):
            at_step, at_half = (
                "none" if math.isnan(number) else f"{number:.4g} {self.units}" for number in (self.value, self.finer)
            )
            return f"{self.name} {at_step}, {at_half} at half the step"
        if self.name == "level":
            return f"{self.name} {self.change:+.2g} dB"
        change = f"{self.change:+.2g}" if self.units == "1" else f"{100.0 * self.change:+.2g} %"
        units = "" if self.units == "1" else f" {self.units}"
        return f"{self.name} {self.value:.4g}{units} ({change})"


@dataclass(frozen=True)
class StepCheck:
    """A run held against the same run at half its step.

    Attributes
    ----------
    step : float
        Step of the run [s].
    regimes : tuple of str
        Regime of the run and of that at half the step.
    parted : float
        Time from which the forces of both differ by a tenth of their fluctuation [s]; infinite if they never do.
    moved : tuple of Moved
        Results of both over the whole time: frequency, level, shares of the states and, of a vibration that grows, its
        growth.
    before : tuple of Moved
        The same over the time before the runs part; empty if they do not, or do so at once.
    finer : xarray.Dataset
        The record at half the step.
    """

    step: float
    regimes: tuple[str, str]
    parted: float
    moved: tuple[Moved, ...]
    before: tuple[Moved, ...]
    finer: xr.Dataset

    @property
    def is_fine(self) -> bool:
        """Whether regime and results hardly change: over the whole time, or before the runs part."""
        return self._is_fine_throughout or (bool(self.before) and all(one.is_small for one in self.before))

    @property
    def _is_fine_throughout(self) -> bool:
        return self.regimes[0] == self.regimes[1] and all(one.is_small for one in self.moved)

    def __str__(self) -> str:
        """Return the result in a few lines."""
        lines = [f"at half the step, {0.5 * self.step:.3g} s: {'; '.join(map(str, self.moved))}"]
        if self.regimes[0] != self.regimes[1]:
            lines.append(f"regime {self.regimes[0]}, {self.regimes[1]} at half the step")
        if math.isinf(self.parted):
            lines.append("forces agree throughout")
        elif self.parted == float(self.finer["time"].values[0]):
            lines.append(f"forces part within the first {1.0 / WINDOWS:.0%} of the time")
        else:
            lines.append(f"forces agree until {self.parted:.4g} s")
        if self.before:
            lines.append(f"until then: {'; '.join(map(str, self.before))}")
        lines.append(self._verdict())
        return "\n".join(lines)

    def _verdict(self) -> str:
        if self._is_fine_throughout:
            return "the step is fine enough for these results"
        if self.is_fine:
            return "the step is fine enough; later the motion depends on the smallest changes, as chaos does"
        late = [one.name for one in (self.before or self.moved) if not one.is_small]
        return f"the step is too coarse for {', '.join(late) if late else 'the regime'}: give a smaller one"


def check_step(run: xr.Dataset, **kwargs: Any) -> StepCheck:
    """Repeat a run at half its step and return how far its results move.

    Parameters
    ----------
    run : xarray.Dataset
        A record of `simulate` from its start on.
    **kwargs
        Arguments of `simulate` for the repetition: `watchers` and `progress`.

    Returns
    -------
    StepCheck
        Printed, it says in words by how much frequency, level, shares and growth move and whether the step is fine
        enough: frequency and growth within 1 %, the level of the forces within 0.5 dB, shares within 0.02, over the
        whole run or, where the motion is chaotic, over the time before the two runs part.

    Raises
    ------
    ValueError
        If the record continues another one, was changed while it ran or has fewer than two samples.
    """
    checked.record("run", run, "normal_force", "tangential_force", "status_share", least=2)
    interval, since = float(run.attrs["sample_interval"]), float(run["time"].values[0])
    if since > 1.5 * interval:
        raise ArgumentError("run", "begin at its start", run, got=f"one that goes on from {since - interval:.6g} s")
    if played(run):
        raise ArgumentError("run", "have one scenario throughout", run, got="one that was changed while it ran")
    step = float(run.attrs["step"])
    asked = {"step": 0.5 * step, "sample_rate": 1.0 / interval, "duration": run.sizes["time"] * interval}
    try:
        finer = load_scenario(run).simulate(**asked, **kwargs)
    except Diverged as stop:
        finer = stop.record
    return held_against(run, finer)


def held_against(run: xr.Dataset, finer: xr.Dataset) -> StepCheck:
    """Return a run held against the same run at half the step."""
    shared = min(run.sizes["time"], finer.sizes["time"])
    pair = run.isel(time=slice(shared)), finer.isel(time=slice(shared))
    whole = [_measured(one) for one in pair]
    until = _parting(*(_forces(one) for one in pair))
    before: tuple[Moved, ...] = ()
    if 2 * FEWEST <= until < shared:
        before = _moved(*(_measured(one.isel(time=slice(until))) for one in pair))
    return StepCheck(
        step=float(run.attrs["step"]),
        regimes=(whole[0].regime, whole[1].regime),
        parted=math.inf if until == shared else float(run["time"].values[until]),
        moved=_moved(*whole),
        before=before,
        finer=finer,
    )


def _forces(run: xr.Dataset) -> Array:
    """Return all contact forces of a record, shape (forces, samples)."""
    columns = [run[name].transpose("time", ...).values for name in ("normal_force", "tangential_force")]
    return np.concatenate([column.reshape(len(column), -1).T for column in columns])


def _fluctuation(forces: Array) -> float:
    """Return the root mean square of all forces about their means [N]."""
    return float(np.sqrt(np.sum(np.var(forces, axis=1))))


def _windows(samples: int) -> Array:
    """Return the ends of windows of equal lengths."""
    return np.unique(np.linspace(0, samples, min(WINDOWS, samples) + 1).astype(int))


def _parting(forces: Array, finer: Array) -> int:
    """Return the sample from which two runs differ, their number of samples if they never do."""
    samples = forces.shape[1]
    ends = _windows(samples)
    largest = _fluctuation(finer)
    for begin, end in pairwise(ends):
        apart = float(np.sqrt(np.sum(np.mean((forces[:, begin:end] - finer[:, begin:end]) ** 2, axis=1))))
        if apart > PARTED * largest:
            return int(begin)
    return samples


class Measured(NamedTuple):
    """Results of a run: its regime, and numbers by name."""

    regime: str
    numbers: dict[str, float]


def _moved(run: Measured, finer: Measured) -> tuple[Moved, ...]:
    """Return the results of two runs side by side."""
    moved = []
    for name, (units, allowed) in NUMBERS.items():
        value, half = run.numbers[name], finer.numbers[name]
        if name == "growth" and math.isnan(value) and math.isnan(half):
            continue
        moved.append(Moved(name, units, value, half, half - value if units == "dB" else half / value - 1.0, allowed))
    for name in SHARES:
        value, half = run.numbers[name], finer.numbers[name]
        moved.append(Moved(name, "1", value, half, half - value, SHARE))
    return tuple(moved)


def _measured(run: xr.Dataset) -> Measured:
    """Return the regime of a run, frequency, level and growth of its forces, and shares of the states."""
    found, forces = regime_of(run), _forces(run)
    spread = _fluctuation(forces)
    numbers = {name: float(found[name]) for name in ("frequency", *SHARES)}
    numbers["level"] = 20.0 * math.log10(spread) if spread > 0.0 else math.nan
    numbers["growth"] = growth_of(forces, float(run.attrs["sample_interval"]))
    return Measured(str(found["regime"]), numbers)


def growth_in_forces(run: xr.Dataset) -> float:
    """Return the rate at which the fluctuation of the forces of a run grows from its start on [1/s], NaN if not."""
    return growth_of(_forces(run), float(run.attrs["sample_interval"])) if run.sizes["time"] > 1 else math.nan


def growth_of(forces: Array, interval: float) -> float:
    """Return the rate at which the fluctuation of the forces grows from the start on [1/s], NaN if it does not.

    The longest beginning whose logarithm, window by window, is a straight line that rises.
    """
    ends = _windows(forces.shape[1])
    if ends.size <= FEWEST or np.diff(ends).min() < 4:
        return math.nan
    spread = np.array([_fluctuation(forces[:, begin:end]) for begin, end in pairwise(ends)])
    if not np.all(spread > 0.0):
        return math.nan
    time, heights = 0.5 * (ends[:-1] + ends[1:]) * interval, np.log(spread)
    for count in range(len(spread), FEWEST - 1, -1):
        slope, offset = np.polyfit(time[:count], heights[:count], 1)
        scatter = float(np.abs(heights[:count] - slope * time[:count] - offset).max())
        if scatter < SCATTER:
            return float(slope) if heights[count - 1] - heights[0] > math.log(RISE) else math.nan
    return math.nan
