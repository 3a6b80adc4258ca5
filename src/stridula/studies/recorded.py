"""Calibration to a recording: parameters whose run vibrates as measured, and how well it determines them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy  # its parts are imported on first use
import xarray as xr

from ..arrays import Array
from ..checks import by_key
from ..doubtful import warn_of
from .calibration import calibrate
from .points import Range, ranges_of
from .signal_measures import Measured, OfSignal, Signal, measured_of
from .sources import SystemOf, check_takes
from .sweeps import sweep

# Share of a range by which a parameter is changed for derivatives: at most, at least, over its standard deviation.
MOST, LEAST, OF_DEVIATION = 0.02, 1e-3, 0.5
# Standard deviations of an interval of 95 %, and the width of it over the range from which nothing is determined.
INTERVAL, WIDE = 1.96, 0.5
# Variance of a parameter of which only its range is known, over the square of this.
OF_RANGE = 1.0 / 12.0
# Ratio of the changes on both sides of a parameter from which the larger one is another vibration.
JUMP = 5.0
# Runs on either side of a parameter that tell whether its measures scatter, the variance of the third difference of
# numbers that do over theirs, and the scatter in standard deviations from which a vibration is chaotic.
REACH, OF_THIRDS, SCATTERS = 4, 20.0, 0.3
# Correlation from which two parameters are determined together only.
TOGETHER = 0.95
# Most steps of least squares, error of a run that cannot be measured, and errors at which the search of the start ends.
STEPS, FAILED, NEAR = 30, 1e3, 2.0
# Misfit from which a warning says that the model does not reach the recording.
DOUBTFUL = 5.0
WORDS = {
    "value": "best value",
    "lowest": "lower end of the range",
    "highest": "upper end of the range",
    "low": "lower end of the interval of 95 %",
    "high": "upper end of the interval of 95 %",
    "determined": "whether the interval is narrower than half of the range",
    "correlation": "correlation of the errors of two parameters, on the scales of their ranges",
    "measured": "measure of the recording",
    "deviation": "standard deviation of that measure",
    "computed": "measure of the run at the best values",
    "error": "computed less measured, in standard deviations",
}


def calibrate_to(
    recording: xr.DataArray,
    source: str | Path | xr.Dataset | SystemOf,
    ranges: Mapping[str, Range | tuple[Any, Any]],
    *,
    signal: Signal,
    measures: Mapping[str, OfSignal] | None = None,
    deviations: Mapping[str, float] | None = None,
    parts: int = 8,
    population: int = 24,
    generations: int = 20,
    seed: int = 0,
    progress: bool = False,
    **options: Any,
) -> xr.Dataset:
    """Find parameters whose run vibrates as a recording, with their uncertainty.

    Measures of the run are compared with those of the recording: `calibrate` finds a start, then least squares
    (``scipy.optimize.least_squares``) the parameters with the smallest sum of squared errors in standard deviations.
    Derivatives are differences of runs side by side. The intervals hold where the measures are nearly linear in the
    parameters; they are widened by the root of the mean squared error where the model does not reach the recording, and
    by the scatter of the measures of chaotic vibration, which no two runs have in common: there they are rough, and
    held the truth in eight of twelve trials. They never exceed the range, of which all values are equally likely
    without a recording.

    Parameters
    ----------
    recording : xarray.DataArray, shape (time,)
        A steady vibration, as `read_signal` returns it.
    source : str, Path, xarray.Dataset or callable
        A scenario, or a function of the parameters by name that makes a system, as for `sweep`.
    ranges : mapping
        Range of each parameter: a `Range` or its two ends.
    signal : str or callable
        What of a record is compared, in the unit of the recording: a variable of one probe, or a function of the
        record. The first tenth of a run is left out.
    measures : mapping, optional
        Functions of a vibration by name; their units are those of what they return (``attrs["units"]``) or of their
        attribute ``units``, else ``unknown``. By default the ``frequency`` [Hz] and, of a tone, the level of each
        harmonic that is clear of the noise; of any other vibration its ``level``, and that in bands within 20 dB of the
        strongest [dB].
    deviations : mapping, optional
        Standard deviations of measures by name. By default those of the means over `parts`, at least 0.1 % of a
        frequency or another measure, and 0.1 dB of a level.
    parts : int, optional
        Parts of the recording, at least 4.
    population, generations, seed : int, optional
        Arguments of `calibrate` for the start.
    progress : bool, optional
        Whether the search of the start shows a bar on standard error.
    **options
        Arguments of `sweep` such as `overrides`, `duration`, `sample_rate` and `workers`.

    Returns
    -------
    xarray.Dataset
        Over ``parameter`` the ``value`` and the ends ``low`` and ``high`` of its interval of 95 %, in the unit of its
        range from ``lowest`` to ``highest``, and whether it is ``determined``; the ``correlation`` with each ``other``.
        Over ``measure``, with its ``measure_unit``, what is ``measured``, with its ``deviation``, and ``computed``, and
        the ``error`` in standard deviations. Scalar ``scatter``, the standard deviation of errors between nearly equal
        runs: above 0.3 a warning says that the vibration is chaotic, and errors are the means of many runs; and
        ``misfit``, the root of the squared errors per degree of freedom [1]: about 1 where the model fits; a warning
        says so if it is 5 or more. The attribute ``undetermined`` says what the recording does not determine, and is
        empty if it determines all.

    Raises
    ------
    ScenarioError
        If the scenario is invalid, or a key is unknown.
    ValueError
        If an argument is out of its range, or no set of the first generation can be run.
    """
    searched = ranges_of("ranges", ranges)
    if callable(source):
        check_takes(source, [*searched, *by_key("overrides", options.get("overrides"))])
    measured = measured_of(recording, measures, parts, by_key("deviations", deviations))
    fit = _Fit(source, searched, measured, signal, options)
    start = calibrate(
        source,
        ranges,
        measured.targets(NEAR),
        measures=measured.of_record(signal),
        population=population,
        generations=generations,
        seed=seed,
        progress=progress,
        **options,
    )
    shares = np.array([one.share(_with_unit(float(start[name]), one)) for name, one in searched.items()])
    best = scipy.optimize.least_squares(
        fit.errors, np.clip(shares, 1e-6, 1.0 - 1e-6), fit.slopes, bounds=(0.0, 1.0), max_nfev=STEPS
    )
    found = fit.dataset(best.x)
    if found["scatter"] > SCATTERS:
        words = f"its measures scatter by {float(found['scatter']):.2g} standard deviations from run to run"
        warn_of([f"the vibration is chaotic: {words}, and the intervals are rough; longer runs scatter less"])
    if found["misfit"] > DOUBTFUL:
        errors = f"{float(found['misfit']):.3g} standard deviations"
        warn_of([f"the model does not reach the recording: its measures differ by {errors} in the mean, see 'error'"])
    return found


def _with_unit(number: float, one: Range) -> float | str:
    return f"{number!r} {one.unit}" if one.unit else number


@dataclass(frozen=True)
class _Lines:
    """Straight lines through the errors of many runs about a set of parameters.

    Attributes
    ----------
    scatter : float
        Scatter of the errors of nearly equal runs, from their third differences, which smooth changes hardly have.
    errors : ndarray, shape (measures,)
        Mean errors at the set.
    slopes : ndarray, shape (measures, parameters)
        Slopes of the lines.
    information : ndarray, shape (parameters, parameters)
        What the slopes tell of the parameters, less what the scatter alone would give them.
    """

    scatter: float
    errors: Array
    slopes: Array
    information: Array

    def covariance(self, misfit: float) -> Array:
        """Return the covariance of the parameters."""
        return _inverse(self.information / max(1.0, misfit) ** 2)


@dataclass(frozen=True)
class _Fit:
    """The comparison of runs with a recording; parameters are shares of their ranges."""

    source: Any
    ranges: dict[str, Range]
    measured: Measured
    signal: Signal
    options: Mapping[str, Any]

    def errors_of(self, sets: Array) -> Array:
        """Return the errors of the runs of some sets, in standard deviations, a row each; NaN for a failed run."""
        points = [
            {name: one.value(float(share)) for (name, one), share in zip(self.ranges.items(), shares, strict=True)}
            for shares in sets
        ]
        functions = self.measured.of_record(self.signal)
        found = sweep(self.source, points, [functions], **self.options)
        values = np.stack([np.asarray(found[name].values, dtype=float) for name in functions], axis=1)
        return np.asarray((values - self.measured.values) / self.measured.deviations)

    def errors(self, shares: Array) -> Array:
        """Return the errors of a run; large ones if it cannot be measured."""
        found = self.errors_of(shares[None])[0]
        return np.where(np.isfinite(found), found, FAILED)

    def slopes(self, shares: Array, sizes: Array | None = None) -> Array:
        """Return the derivatives of the errors, shape (measures, parameters), by differences within the ranges.

        Where the vibration ceases or becomes another on one side, the other side counts.
        """
        count, sizes = shares.size, np.full(shares.size, MOST) if sizes is None else sizes
        ends = np.clip(shares + np.outer([-1.0, 1.0], sizes), 0.0, 1.0)
        sets = np.tile(shares, (2, count, 1))
        sets[:, np.arange(count), np.arange(count)] = ends
        found = self.errors_of(np.concatenate([shares[None], sets.reshape(-1, count)]))
        changes = found[1:].reshape(2, count, -1) - found[0]
        jumps = np.linalg.norm(np.where(np.isfinite(changes), changes, np.inf), axis=2)
        counts = (jumps <= JUMP * jumps[::-1]) & np.isfinite(jumps) & (ends != shares)
        signed = np.where(counts[..., None], np.sign(ends - shares)[..., None] * changes, 0.0)
        ways = np.where(counts, np.abs(ends - shares), 0.0).sum(axis=0)
        return np.asarray(signed.sum(axis=0) / np.where(ways > 0.0, ways, 1.0)[:, None]).T

    def covariance(self, shares: Array, misfit: float) -> Array:
        """Return the covariance of the parameters, with derivatives over differences of the size of their errors."""
        sizes = np.full(shares.size, MOST)
        for _ in range(2):
            slopes = self.slopes(shares, sizes) / max(1.0, misfit)
            covariance = _inverse(slopes.T @ slopes)
            sizes = np.clip(OF_DEVIATION * np.sqrt(np.diag(covariance)), LEAST, MOST)
        return covariance

    def lines(self, shares: Array) -> _Lines:
        """Return straight lines through the errors of many runs about a set."""
        steps = np.arange(-REACH, REACH + 1)
        middle = np.clip(shares, REACH * MOST, 1.0 - REACH * MOST)
        sets = np.tile(shares, (shares.size, steps.size, 1))
        for k in range(shares.size):
            sets[k, :, k] = middle[k] + steps * MOST
        found = self.errors_of(sets.reshape(-1, shares.size)).reshape(shares.size, steps.size, -1)
        thirds = np.mean(np.diff(found, 3, axis=1) ** 2, axis=2) / OF_THIRDS
        scatter = float(np.sqrt(np.nanmedian(thirds))) if np.isfinite(thirds).any() else 0.0
        squares = float(steps @ steps) * MOST**2
        slopes = np.nan_to_num(np.tensordot(steps * MOST, found, (0, 1))) / squares
        # Those of a parameter near an end of its range are moved back along its line.
        back = np.einsum("pm,p->pm", slopes, shares - middle)
        mean = np.nan_to_num((found.mean(axis=1) + back).mean(axis=0), nan=FAILED)
        sizes, ways = np.linalg.eigh(slopes @ slopes.T)
        known = np.maximum(sizes - scatter**2 * slopes.shape[1] / squares, 0.0)
        return _Lines(scatter, mean, slopes.T, (ways * known) @ ways.T / (1.0 + scatter**2))

    def dataset(self, shares: Array) -> xr.Dataset:
        """Return the results at the best parameters."""
        lines = self.lines(shares)
        is_chaotic = lines.scatter > SCATTERS
        # A single chaotic run may be near the recording by chance.
        errors = lines.errors if is_chaotic else self.errors(shares)
        freedom = max(errors.size - shares.size, 1)
        misfit = float(np.sqrt(errors @ errors / freedom))
        covariance = lines.covariance(misfit) if is_chaotic else self.covariance(shares, misfit)
        sizes = np.sqrt(np.diag(covariance))
        correlation = covariance / np.outer(sizes, sizes)
        ends = np.clip(shares + np.outer([-INTERVAL, 0.0, INTERVAL], sizes), 0.0, 1.0)
        low, value, high, lowest, highest = (
            [one.number(float(share)) for one, share in zip(self.ranges.values(), row, strict=True)]
            for row in (*ends, np.zeros(shares.size), np.ones(shares.size))
        )
        determined = ends[2] - ends[0] < WIDE
        data: dict[str, Any] = {
            "value": ("parameter", value),
            "low": ("parameter", low),
            "high": ("parameter", high),
            "lowest": ("parameter", lowest),
            "highest": ("parameter", highest),
            "determined": ("parameter", determined),
            "correlation": (("parameter", "other"), correlation),
            "measured": ("measure", self.measured.values),
            "deviation": ("measure", self.measured.deviations),
            "computed": ("measure", self.measured.values + errors * self.measured.deviations),
            "error": ("measure", errors),
        }
        names, units = list(self.ranges), [one.unit or "SI" for one in self.ranges.values()]
        places = {"parameter": names, "other": names, "measure": list(self.measured.measures)}
        found = xr.Dataset(data, places, {"undetermined": _undetermined(names, determined, correlation)})
        for name, meaning in WORDS.items():
            found[name].attrs["long_name"] = meaning
        found = found.assign_coords(
            unit=("parameter", units), measure_unit=("measure", list(self.measured.measure_units))
        )
        words = "standard deviation of the errors of nearly equal runs"
        found["scatter"] = ((), lines.scatter, {"units": "1", "long_name": words})
        found["misfit"] = ((), misfit, {"units": "1", "long_name": "root mean square of the errors"})
        return found


def _inverse(information: Array) -> Array:
    """Return the covariance of parameters from what is known of them, beside their ranges."""
    return np.asarray(np.linalg.inv(information + np.eye(len(information)) / OF_RANGE))


def _undetermined(names: list[str], determined: Array, correlation: Array) -> str:
    """Return what a recording does not determine."""
    words = [f"{name} (its interval is wider than half of its range)" for name in np.array(names)[~determined]]
    rows, columns = np.nonzero(np.triu(np.abs(correlation) > TOGETHER, 1))
    words += [
        f"{names[i]} apart from {names[j]} (correlation {correlation[i, j]:.2f})"
        for i, j in zip(rows, columns, strict=True)
    ]
    return "; ".join(words)
