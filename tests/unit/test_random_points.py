"""Random points: distributions, a Gaussian copula, and what is refused; probabilities with Wilson's intervals."""

from __future__ import annotations

import math

import numpy as np
import pytest
import scipy.stats
import xarray as xr

import stridula as st
from stridula.analysis.regimes import REGIMES
from stridula.studies.points import laid_out
from stridula.studies.probabilities import wilson_interval

COUNT = 20_000


def columns(points: st.RandomPoints) -> np.ndarray:
    return np.array(list(points.values().values()))


@pytest.mark.parametrize("seed", range(4))
def test_values_have_their_distributions(seed):
    """Kolmogorov's test of each, at a level that one of a million samples misses."""
    given = {"a": scipy.stats.norm(3.0, 0.5), "b": scipy.stats.lognorm(0.4), "c": scipy.stats.beta(2.0, 5.0)}
    pairs = {("a", "b"): 0.7, ("c", "a"): -0.4}
    points = st.RandomPoints(given, COUNT, pairs, seed=seed)
    for values, one in zip(columns(points), given.values(), strict=True):
        assert scipy.stats.kstest(values, one.cdf).pvalue > 1e-6


@pytest.mark.parametrize("seed", range(6))
def test_correlations_are_those_of_a_gaussian_copula(seed):
    """Random matrices of three keys: Pearson's coefficient of scores, Spearman's of values by its closed form."""
    root = np.random.default_rng(seed).standard_normal((3, 3))
    matrix = root @ root.T
    matrix /= np.sqrt(np.outer(matrix.diagonal(), matrix.diagonal()))
    pairs = {(one, other): matrix[j, k] for j, one in enumerate("abc") for k, other in enumerate("abc") if j < k}
    given = {"a": scipy.stats.norm(), "b": scipy.stats.expon(), "c": st.Range(1.0, 1e3, logarithmic=True)}
    points = st.RandomPoints(given, COUNT, pairs, seed)
    np.testing.assert_allclose(points.correlation, matrix)
    rank = scipy.stats.spearmanr(columns(points).T).statistic
    # Five standard errors of a coefficient of independent numbers, which exceed those of correlated ones.
    error = 5.0 / math.sqrt(COUNT)
    np.testing.assert_allclose(np.corrcoef(points.scores().T), matrix, atol=error)
    np.testing.assert_allclose(rank, 6.0 / math.pi * np.arcsin(matrix / 2.0), atol=error)


def test_more_points_add_to_fewer():
    given = {"a": (0.0, 1.0), "b": scipy.stats.norm()}
    few, more = (st.RandomPoints(given, count, {("a", "b"): 0.5}, seed=3) for count in (5, 9))
    np.testing.assert_array_equal(columns(more)[:, :5], columns(few))
    assert not np.array_equal(columns(few), columns(st.RandomPoints(given, 5, {("a", "b"): 0.5}, seed=4)))


def test_units_and_whole_numbers_are_kept():
    points = st.RandomPoints({"angle": ("40 deg", "50 deg"), "field": scipy.stats.randint(0, 10)}, 50)
    angles, fields = points.values().values()
    assert all(one.endswith(" deg") and 40.0 <= float(one.split()[0]) <= 50.0 for one in angles)
    assert all(type(one) is int and 0 <= one < 10 for one in fields)
    assert len(laid_out(points).values) == 50


def test_studies_with_other_tails_differ():
    """Two distributions with equal quantiles from 1 % to 99 % are told apart by their values."""
    one = laid_out(st.RandomPoints({"a": scipy.stats.norm()}, 1000)).asked

    class Cut:
        def ppf(self, share):
            return np.clip(scipy.stats.norm.ppf(share), -2.5, 2.5)

    other = laid_out(st.RandomPoints({"a": Cut()}, 1000)).asked
    assert one["random"]["distributions"] == other["random"]["distributions"]
    assert one != other


BAD = [
    ({"distributions": {}}, "be distributions by key"),
    ({"distributions": {"a": scipy.stats.beta}}, "be a frozen distribution of one number"),
    ({"distributions": {"a": (2.0, 1.0)}}, "above low"),
    ({"count": 0}, "count must"),
    ({"seed": -1}, "seed must"),
    ({"correlations": 0.5}, "be numbers by pair of keys"),
    ({"correlations": {"ab": 0.5}}, "be by pairs of different keys of a, b, c"),
    ({"correlations": {("a", "a"): 0.5}}, "be by pairs of different keys"),
    ({"correlations": {("a", "d"): 0.5}}, "got 'd'"),
    ({"correlations": {("a", "b"): 1.0}}, "strictly between -1"),
    ({"correlations": {("a", "b"): 0.5, ("b", "a"): 0.5}}, "both ways"),
    ({"correlations": {("a", "b"): 0.9, ("b", "c"): 0.9, ("a", "c"): -0.9}}, "be possible together"),
]


@pytest.mark.parametrize(("given", "message"), BAD)
def test_what_is_no_distribution_is_refused_in_a_line(given, message):
    words = {"distributions": dict.fromkeys("abc", (0.0, 1.0)), "count": 3} | given
    with pytest.raises(ValueError, match=message) as refused:
        st.RandomPoints(**words)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("confidence", [0.9, 0.95, 0.99])
def test_the_interval_is_the_root_of_its_equation(confidence):
    """(share - p)^2 = z^2 p (1 - p) / n at both ends (Wilson 1927)."""
    z = scipy.stats.norm.ppf(0.5 + confidence / 2.0)
    for seen, size in ((0, 7), (3, 40), (40, 40), (500, 1000)):
        for end in wilson_interval(seen, size, confidence):
            assert (seen / size - end) ** 2 == pytest.approx(z**2 * end * (1.0 - end) / size, abs=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_intervals_cover_random_probabilities_as_often_as_stated(seed):
    """Averaged over random probabilities, the coverage of Wilson's interval is its level within a per cent."""
    dice = np.random.default_rng(seed)
    trials, size = 1500, 60
    known = dice.uniform(size=trials)
    ends = [wilson_interval(int(dice.binomial(size, one)), size, 0.95) for one in known]
    covered = np.mean([low <= one <= high for (low, high), one in zip(ends, known, strict=True)])
    # Four standard errors of the count, beside that per cent.
    assert abs(covered - 0.95) < 0.01 + 4.0 * math.sqrt(0.95 * 0.05 / trials)


def test_samples_of_which_nothing_is_known_widen_the_interval():
    low, high = wilson_interval(3, 10, 0.95, unknown=5)
    assert low == wilson_interval(3, 15, 0.95)[0]
    assert high == wilson_interval(8, 15, 0.95)[1]


def swept(regimes, message=None) -> xr.Dataset:
    words = ["" if one else "no" for one in regimes] if message is None else message
    return xr.Dataset({"regime": ("point", np.array(regimes, dtype=object)), "message": ("point", words)})


def test_regimes_are_counted_with_intervals():
    found = st.regime_probability(swept(["squeal"] * 3 + ["judder"] * 5 + ["", ""]), confidence=0.9)
    assert int(found.runs) == 10
    assert int(found.failed) == 2
    assert "2 of 2 failures: no" in found.attrs["failure"]
    assert found.regime.values.tolist() == list(REGIMES)
    shares = found.probability.to_series()
    assert shares["squeal"] == 3 / 8
    assert shares["judder"] == 5 / 8
    assert shares.sum() == 1.0
    squeal = found.probability_interval.sel(regime="squeal").values.tolist()
    assert squeal == wilson_interval(3, 8, 0.9, unknown=2)


def test_shares_of_a_grid_are_no_probabilities():
    grid = xr.Dataset({"regime": ("friction", ["squeal"]), "message": ("friction", [""])})
    with pytest.raises(ValueError, match="drawn at random, such as RandomPoints, got regimes over friction"):
        st.regime_probability(grid)
    with pytest.raises(ValueError, match="have regime"):
        st.regime_probability(xr.Dataset())
    with pytest.raises(ValueError, match="a run that did not fail, got 1 of 1 failures: no"):
        st.regime_probability(swept([""]))
    with pytest.raises(ValueError, match="confidence"):
        st.regime_probability(swept(["squeal"]), 1.0)


def test_runs_at_random_points_give_regimes():
    """A few short runs of a shipped case, whose correlated parameters are coordinates of the sweep."""
    given = {"friction": scipy.stats.norm(1.0, 0.1), "angle": ("40 deg", "50 deg")}
    points = st.RandomPoints(given, 6, {("friction", "angle"): 0.9})
    found = st.sweep("squeal", points, ["regime"], duration=0.02)
    counted = st.regime_probability(found)
    assert int(counted.runs) == 6
    assert counted.probability.sum() == pytest.approx(1.0)
    assert found.angle.attrs["units"] == "deg"
