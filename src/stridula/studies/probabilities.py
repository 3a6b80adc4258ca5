"""Probabilities as shares of random samples, with Wilson's intervals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.stats
import xarray as xr

from ..analysis.regimes import REGIMES
from ..checks import ArgumentError, instance, listed, within
from ..records.variables import described
from .points import POINT
from .swept import failures, usual_failure

BOUNDS = ("low", "high")


def wilson_interval(seen: int, size: int, confidence: float, unknown: int = 0) -> list[float]:
    """Return the ends of Wilson's interval of a probability (Wilson 1927, J. Am. Stat. Assoc. 22).

    Parameters
    ----------
    seen : int
        Number of samples in which the event was seen.
    size : int
        Number of samples in which it was seen or not.
    confidence : float
        Level of the interval [1].
    unknown : int, optional
        Number of other samples, of which nothing is known: the interval is that of none and of all of them.
    """
    if not size + unknown:
        return [np.nan, np.nan]
    ends = [
        scipy.stats.binomtest(k, size + unknown).proportion_ci(confidence, "wilson") for k in (seen, seen + unknown)
    ]
    return [float(ends[0].low), float(ends[1].high)]


def shares_of(words: Sequence[str], seen: Any, confidence: float, unknown: int = 0) -> tuple[list[float], Any]:
    """Return the share of each word among those that were seen, and the ends of its interval."""
    size = len(seen)
    counts = [int(np.count_nonzero(seen == word)) for word in words]
    shares = [one / size if size else np.nan for one in counts]
    return shares, [wilson_interval(one, size, confidence, unknown) for one in counts]


def regime_probability(found: xr.Dataset, confidence: float = 0.95) -> xr.Dataset:
    """Return the probability of each regime from runs at random points.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `sweep` with the measure ``regime`` at `RandomPoints`, or at a list of points that were drawn at
        random elsewhere.
    confidence : float, optional
        Level of the intervals [1], strictly between 0 and 1.

    Returns
    -------
    xarray.Dataset
        Over ``regime`` its ``probability``, the share of the runs that did not fail, and ``probability_interval`` over
        ``bound``: Wilson's interval, widened by the runs that failed, as if none or all of them had ended in the
        regime. The numbers of ``runs`` and of those that ``failed``; ``attrs["failure"]`` has their most frequent
        message.

    Raises
    ------
    ValueError
        If there are no regimes, all runs failed, or the points form a grid, whose shares are no probabilities.
    """
    instance("found", found, xr.Dataset)
    within("confidence", confidence, 0.0, 1.0, ends=False)
    for name in ("regime", "message"):
        if name not in found:
            words = f"have {name}, as a sweep with the measure regime"
            raise ArgumentError("found", words, found, got=listed(map(str, found.data_vars)))
    if found["regime"].dims != (POINT,):
        words = "be of points drawn at random, such as RandomPoints"
        raise ArgumentError("found", words, found, got=f"regimes over {listed(map(str, found['regime'].dims))}")
    messages = failures(found)
    good = found["regime"].values[found["message"].values == ""]
    if not len(good):
        raise ArgumentError("found", "have a run that did not fail", found, got=usual_failure(messages) or "no runs")
    shares, bounds = shares_of(REGIMES, good, confidence, len(messages))
    data = {
        "probability": ("regime", shares, described("1", "probability of the regime")),
        "probability_interval": (("regime", "bound"), bounds, described("1", "interval of the probability")),
        "runs": ((), found.sizes[POINT], described("1", "number of runs")),
        "failed": ((), len(messages), described("1", "number of runs that failed")),
    }
    attributes: dict[str, Any] = {"confidence": confidence} | ({"failure": usual_failure(messages)} if messages else {})
    return xr.Dataset(data, {"regime": list(REGIMES), "bound": list(BOUNDS)}, attributes)
