"""Sensitivity of regime, frequency or level to uncertain parameters, with the probability of each regime."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import scipy.stats
import xarray as xr

from ..analysis.regimes import REGIMES
from ..arrays import Array
from ..checks import ArgumentError, count, within
from ..records.variables import described
from .distributions import LOWEST_SHARE, distributions_of, values_of
from .probabilities import BOUNDS, shares_of
from .sources import SystemOf
from .sweeps import sweep
from .swept import failures, usual_failure

MOST_SAMPLES, MOST_RESAMPLES = 2**16, 100_000
# Attributes of a sweep that record its origin.
ORIGIN = ("title", "scenario", "function", "stridula_version")
# With fewer samples there is no interval.
FEWEST = 8


def sensitivity(
    scenario: str | Path | xr.Dataset | SystemOf,
    uncertain: Mapping[str, Any],
    measures: Any = ("regime",),
    *,
    samples: int = 256,
    seed: int = 0,
    confidence: float = 0.95,
    resamples: int = 999,
    progress: bool = False,
    **options: Any,
) -> xr.Dataset:
    """Return Sobol indices of measures, and the probability of each regime, for uncertain parameters.

    The first-order index of a parameter is the share of the variance of an output that it causes alone, the total-order
    index the share to which it contributes (Saltelli et al. 2010, Comput. Phys. Commun. 181;
    ``scipy.stats.sobol_indices``). They need ``samples (parameters + 2)`` runs, at points of a Sobol sequence.

    Parameters
    ----------
    scenario : str, Path, xarray.Dataset or callable
        A scenario, or a function of the parameters by name that makes a system, as for `sweep`.
    uncertain : mapping
        Distribution of each parameter by key: the two ends of a uniform one, a `Range`, or a frozen distribution of
        ``scipy.stats`` in SI. They are independent of each other.
    measures : str, mapping or sequence of them, optional
        Measures, as for `sweep`.
    samples : int, optional
        Samples of each of the two sets, a power of 2.
    seed : int, optional
        Seed of the points and of the resampling: equal seeds give equal results.
    confidence : float, optional
        Level of the intervals [1], strictly between 0 and 1.
    resamples : int, optional
        Bootstrap resamples for the intervals of the indices.
    progress : bool, optional
        Whether a bar on standard error shows how many runs are done and how long the others will take.
    **options
        Arguments of `sweep` such as `overrides`, `duration`, `out`, `workers` and `client`.

    Returns
    -------
    xarray.Dataset
        ``first_order`` and ``total_order`` over ``output`` and ``parameter`` with their bootstrap percentile intervals
        over ``bound``; the outputs are the numbers measured and, with the measure ``regime``, for each regime whether
        it was seen. ``used``: the number of samples in which all runs gave an output; other samples are not used. NaN
        below 8 such samples, or for an output that never varies. ``probability`` of each ``regime`` with Wilson's
        interval, and the numbers of ``runs`` and of those that ``failed``; the attribute ``failure`` has their most
        frequent message.

    Raises
    ------
    ValueError
        If an argument is out of its range, or as in `sweep`.
    """
    named = distributions_of("uncertain", uncertain)
    if count("samples", samples, high=MOST_SAMPLES) & (samples - 1):
        raise ArgumentError("samples", "be a power of 2", samples)
    count("seed", seed, low=0)
    count("resamples", resamples, high=MOST_RESAMPLES)
    within("confidence", confidence, 0.0, 1.0, ends=False)
    shares = shares_for_indices(len(named), samples, seed)
    columns = [values_of(one, column) for one, column in zip(named.values(), shares.T, strict=True)]
    points = [dict(zip(named, row, strict=True)) for row in zip(*columns, strict=True)]
    found = sweep(scenario, points, measures, progress=progress, **options)
    outputs = _outputs(found)
    keys = list(named)
    data: dict[str, Any] = sobol_indices(outputs, len(keys), samples, seed, confidence, resamples)
    coordinates: dict[str, Any] = {"output": list(outputs), "parameter": keys, "bound": list(BOUNDS)}
    messages = failures(found)
    data["runs"], data["failed"] = ((), len(points)), ((), len(messages))
    if "regime" in found:
        # The two sets are independent draws; the mixed ones are not.
        data |= _probabilities(found["regime"].values[: 2 * samples], confidence)
        coordinates["regime"] = list(REGIMES)
    origin = {name: found.attrs[name] for name in ORIGIN if name in found.attrs}
    if messages:
        origin["failure"] = usual_failure(messages)
    return xr.Dataset(data, coordinates, origin | {"confidence": confidence, "samples": samples, "seed": seed})


def shares_for_indices(parameters: int, samples: int, seed: int) -> Array:
    """Return the points as quantile levels: set A, set B, then A with each column taken from B in turn."""
    drawn = scipy.stats.qmc.Sobol(2 * parameters, rng=np.random.default_rng(seed)).random(samples)
    first, second = drawn[:, :parameters], drawn[:, parameters:]
    mixed = [first.copy() for _ in range(parameters)]
    for number, one in enumerate(mixed):
        one[:, number] = second[:, number]
    # The quantile at exactly 0 may be infinite.
    return np.clip(np.concatenate([first, second, *mixed]), LOWEST_SHARE, 1.0 - LOWEST_SHARE)


def _outputs(found: xr.Dataset) -> dict[str, Array]:
    """Return the outputs over the points: numeric measures, and for each regime whether it was seen."""
    outputs: dict[str, Array] = {}
    for name, values in found.data_vars.items():
        if values.dims == ("point",) and values.dtype.kind in "fiu":
            outputs[str(name)] = values.values.astype(float)
    if "regime" in found:
        seen, good = found["regime"].values, found["message"].values == ""
        for word in REGIMES:
            outputs[f"is {word}"] = np.where(good, (seen == word).astype(float), np.nan)
    return outputs


def sobol_indices(
    outputs: Mapping[str, Array], parameters: int, samples: int, seed: int, confidence: float, resamples: int
) -> dict[str, Any]:
    """Return the indices of each output with their intervals, and the number of samples used."""
    size = (len(outputs), parameters)
    first, total = np.full((2, *size), np.nan)
    intervals = np.full((2, *size, 2), np.nan)
    used = np.zeros(len(outputs), dtype=np.int64)
    for row, values in enumerate(outputs.values()):
        sets = values.reshape(parameters + 2, samples)
        sets = sets[:, np.isfinite(sets).all(axis=0)]
        used[row] = sets.shape[1]
        if used[row] < FEWEST or np.ptp(sets[:2]) == 0.0:
            continue
        first[row], total[row] = _sobol(sets)
        random = np.random.default_rng(seed)
        drawn = np.array([_sobol(sets[:, random.integers(0, used[row], used[row])]) for _ in range(resamples)])
        # An output that varies in few samples is constant in some resamples.
        drawn = drawn[np.isfinite(drawn).all(axis=(1, 2))]
        tails = [50.0 * (1.0 - confidence), 50.0 * (1.0 + confidence)]
        if len(drawn):
            intervals[:, row] = np.moveaxis(np.percentile(drawn, tails, axis=0), 0, -1)
    along = ("output", "parameter")
    return {
        "first_order": (along, first, described("1", "share of the variance caused by the parameter alone")),
        "first_order_interval": ((*along, "bound"), intervals[0]),
        "total_order": (along, total, described("1", "share of the variance to which the parameter contributes")),
        "total_order_interval": ((*along, "bound"), intervals[1]),
        "used": ("output", used, described("1", "samples in which all runs gave the output")),
    }


def _sobol(sets: Array) -> tuple[Array, Array]:
    """Return first-order and total-order indices of values at the sets A, B and the mixed ones, shape (parameters,)."""
    # The estimators are those of scipy's sobol_indices, which accepts only powers of 2.
    whole = sets[:2].ravel()
    mean, variance = whole.mean(), whole.var()
    if variance == 0.0:
        return np.full(len(sets) - 2, np.nan), np.full(len(sets) - 2, np.nan)
    a, b, mixed = sets[0] - mean, sets[1] - mean, sets[2:] - mean
    return np.mean(b * (mixed - a), axis=1) / variance, 0.5 * np.mean((a - mixed) ** 2, axis=1) / variance


def _probabilities(regimes: Array, confidence: float) -> dict[str, Any]:
    shares, bounds = shares_of(REGIMES, regimes[regimes != ""], confidence)
    return {
        "probability": ("regime", shares, described("1", "probability of the regime")),
        "probability_interval": (("regime", "bound"), bounds),
    }
