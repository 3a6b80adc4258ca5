"""Random points of uncertain parameters, independent or correlated by a Gaussian copula."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.special

from ..arrays import Array
from ..checks import ArgumentError, brief, count, listed, within
from .distributions import described_distribution, distributions_of, values_of
from .points import MOST_POINTS, POINT, Layout

# Smallest eigenvalue of a matrix of correlations, beyond rounding.
LEAST = 1e-12


@dataclass(frozen=True)
class RandomPoints:
    """Points drawn at random from distributions of some keys, independent of each other or correlated.

    Parameters
    ----------
    distributions : mapping
        Distribution of each parameter by key: the two ends of a uniform one, a `Range`, or a frozen distribution of
        ``scipy.stats`` in SI. One of whole numbers gives whole numbers, such as the seed of a `random_field`.
    count : int
        Number of points.
    correlations : mapping, optional
        Correlations by pair of keys, strictly between -1 and 1; other pairs are independent. They are those of a
        Gaussian copula: of normal numbers whose quantile levels are those of the parameters. For normal distributions
        they are Pearson's coefficients of the parameters; otherwise Spearman's coefficient of a pair is
        ``6 / pi arcsin(correlation / 2)``.
    seed : int, optional
        Seed of the points: equal seeds give equal points, and a larger `count` adds others.

    Raises
    ------
    ValueError
        If an argument is out of its range, or no variables have these correlations.
    """

    distributions: Mapping[str, Any]
    count: int
    correlations: Mapping[tuple[str, str], float] | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        count("count", self.count, high=MOST_POINTS)
        count("seed", self.seed, low=0)
        object.__setattr__(self, "distributions", distributions_of("distributions", self.distributions))
        object.__setattr__(self, "correlations", _pairs(self.correlations, list(self.distributions)))
        # Refuses those that are impossible.
        _ = self.correlation

    @property
    def correlation(self) -> Array:
        """Correlations of all keys, shape (keys, keys)."""
        keys, found = list(self.distributions), np.eye(len(self.distributions))
        for (one, other), number in (self.correlations or {}).items():
            row, column = keys.index(one), keys.index(other)
            found[row, column] = found[column, row] = number
        if np.linalg.eigvalsh(found)[0] <= LEAST:
            words = "be possible together: their matrix must be positive definite"
            raise ArgumentError("correlations", words, self.correlations)
        return found

    def scores(self) -> Array:
        """Return the normal numbers whose quantile levels are those of the points, shape (points, keys)."""
        return np.asarray(self.independent_scores() @ np.linalg.cholesky(self.correlation).T)

    def independent_scores(self) -> Array:
        """Return independent normal numbers, of which the correlated ones are combinations, shape (points, keys)."""
        return np.random.default_rng(self.seed).standard_normal((self.count, len(self.distributions)))

    def values(self) -> dict[str, list[Any]]:
        """Return the values of each key at all points."""
        return values_at(self.distributions, self.scores())

    def layout(self) -> Layout:
        """Return the points in sequence."""
        columns = self.values()
        pairs = [[*pair, number] for pair, number in (self.correlations or {}).items()]
        asked = {
            "distributions": {key: described_distribution(one) for key, one in self.distributions.items()},
            "count": self.count,
            "correlations": pairs,
            "seed": self.seed,
            # Some quantiles do not determine a distribution.
            "values": hashlib.sha256(json.dumps(columns).encode()).hexdigest()[:16],
        }
        values = tuple(zip(*columns.values(), strict=True))
        return Layout(tuple(columns), values, {POINT: self.count}, False, {"random": asked})


def values_at(distributions: Mapping[str, Any], scores: Array) -> dict[str, list[Any]]:
    """Return the values of distributions by key at normal numbers, shape (points, keys)."""
    shares = scipy.special.ndtr(scores)
    return {key: values_of(one, column) for (key, one), column in zip(distributions.items(), shares.T, strict=True)}


def _pairs(given: Any, keys: Sequence[str]) -> dict[tuple[str, str], float]:
    """Return correlations by pair of different keys."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise ArgumentError("correlations", "be numbers by pair of keys", given)
    found: dict[tuple[str, str], float] = {}
    for pair, number in given.items():
        words = f"be by pairs of different keys of {listed(keys)}"
        if not isinstance(pair, tuple) or len(pair) != 2 or pair[0] == pair[1]:
            raise ArgumentError("correlations", words, pair)
        unknown = next((key for key in pair if key not in keys), None)
        if unknown is not None:
            raise ArgumentError("correlations", words, unknown)
        if pair[::-1] in found:
            raise ArgumentError("correlations", "name each pair once", pair, got=f"{brief(pair)} both ways")
        found[pair] = within(f"correlations[{pair!r}]", number, -1.0, 1.0, ends=False)
    return found
