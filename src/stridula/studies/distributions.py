"""Distributions of uncertain parameters: ranges, and frozen distributions of SciPy."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError
from .points import range_of

# Quantile levels beyond which no value is taken: for many distributions that at exactly 0 is infinite.
LOWEST_SHARE = 1e-12
# Quantile levels that describe a distribution.
DESCRIBED_AT = (0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99)


def distributions_of(name: str, given: Any) -> dict[str, Any]:
    """Return distributions by key: each a `Range`, uniform, or a frozen distribution of ``scipy.stats``.

    Parameters
    ----------
    name : str
        Name of the argument, for messages.
    given : mapping
        Two ends, a `Range` or a frozen distribution by key.

    Raises
    ------
    ValueError
        If `given` is anything else, or the ends of a range do not increase.
    """
    if not isinstance(given, Mapping) or not given:
        raise ArgumentError(name, "be distributions by key", given)
    found: dict[str, Any] = {}
    for key, one in given.items():
        is_distribution = callable(getattr(one, "ppf", None))
        if is_distribution and not _is_one_number(one):
            raise ArgumentError(f"{name}[{key!r}]", "be a frozen distribution of one number", one)
        found[str(key)] = one if is_distribution else range_of(f"{name}[{key!r}]", one)
    return found


def is_range(distribution: Any) -> bool:
    """Return whether a distribution is a `Range`, uniform between its ends; the others have quantiles."""
    return not hasattr(distribution, "ppf")


def values_of(distribution: Any, shares: Array) -> list[Any]:
    """Return the values of a distribution at quantile levels, whole numbers if it has no others."""
    if is_range(distribution):
        return [distribution.value(share) for share in shares.tolist()]
    numbers = np.asarray(distribution.ppf(np.clip(shares, LOWEST_SHARE, 1.0 - LOWEST_SHARE)), dtype=float)
    return [int(number) for number in numbers] if hasattr(distribution, "pmf") else numbers.tolist()


def described_distribution(distribution: Any) -> Any:
    """Return a distribution as plain numbers and texts: the ends of a range, or some quantiles."""
    if is_range(distribution):
        return vars(distribution)
    return [float(distribution.ppf(share)) for share in DESCRIBED_AT]


def _is_one_number(distribution: Any) -> bool:
    try:
        return math.isfinite(float(distribution.ppf(0.5)))
    except (TypeError, ValueError):
        return False
