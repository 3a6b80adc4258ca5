"""Probability of growth against closed forms: modes that merge, two bodies in two bands, a falling law of friction."""

from __future__ import annotations

from dataclasses import replace
from math import exp, sqrt

import numpy as np
import pytest
import scipy.stats

import stridula as st
from stridula.studies.frequency_bands import bands_of, edges_between
from stridula.verification.probabilities import BELT, FALLS, LOAD, probability_of_growth, weakening_slider
from stridula.verification.systems.mode_coupling import hoffmann

MERGE = 0.75


def shares_agree(found: float, known: float, samples: int) -> bool:
    """Return whether a share is within five standard errors of a probability."""
    return abs(found - known) <= 5.0 * sqrt(known * (1.0 - known) / samples)


def two_masses(first: float, second: float) -> st.System:
    """Return Hoffmann's mass and a stiffer one, whose modes merge at ten times the frequency, on belts of their own."""
    contacts, drives = [], []
    for name, scale, friction in (("soft", 1.0, first), ("stiff", 100.0, second)):
        model = hoffmann(scale)
        body = replace(model.body(), name=name)
        belt = st.RigidTrack(velocity=-1e3 * sqrt(scale), name=f"belt of {name}")
        contacts.append(st.PointContact(body.at("floor"), belt, friction=st.Coulomb(friction), name=name))
        drives.append(st.Force(body.at("mass"), y=-1.0))
    return st.System(contacts, drives)


@pytest.mark.parametrize("seed", range(3))
def test_modes_grow_where_they_have_merged(seed):
    """Each point by itself: growth and frequency of Hoffmann's modes from their polynomial."""
    friction = scipy.stats.norm(0.75, 0.2)
    found = st.mode_probability(hoffmann().system, {"friction": friction}, samples=80, seed=seed, workers=1)
    values = found.friction.values
    np.testing.assert_array_equal(found.unstable_modes.values, (values > MERGE).astype(float))
    np.testing.assert_array_equal(found.verdict.values == "unstable", values > MERGE)
    known = np.array([hoffmann().exponents(float(one))[0] for one in values])
    grows = values > MERGE
    np.testing.assert_allclose(found.growth_rate.values[grows], known.real[grows], rtol=1e-6)
    np.testing.assert_allclose(found.band_growth_rate.values[grows, 0], known.real[grows], rtol=1e-6)
    assert np.isnan(found.band_growth_rate.values[~grows]).all()
    low, high = found.frequency_range.values[0]
    seen = known.imag[grows] / (2.0 * np.pi)
    assert (low, high) == pytest.approx((seen.min(), seen.max()), rel=1e-6)
    assert shares_agree(float(found.probability[0]), float(friction.sf(MERGE)), 80)


@pytest.mark.parametrize(("seed", "correlation"), [(0, 0.0), (1, 0.8), (2, -0.9)])
def test_two_bodies_have_two_bands(seed, correlation):
    """The probability of each band is that of its friction; that of any is an orthant of the normal distribution."""
    given = {"first": scipy.stats.norm(0.7, 0.1), "second": scipy.stats.norm(0.8, 0.1)}
    pairs = {("first", "second"): correlation}
    samples = 150
    found = st.mode_probability(two_masses, given, samples=samples, correlations=pairs, seed=seed, workers=1)
    assert found.sizes["band"] == 2
    assert found.frequency.values[1] == pytest.approx(10.0 * found.frequency.values[0], rel=0.05)
    for band, one in enumerate(given.values()):
        grows = found[list(given)[band]].values > MERGE
        np.testing.assert_array_equal(np.isfinite(found.band_growth_rate.values[:, band]), grows)
        assert shares_agree(float(found.probability[band]), float(one.sf(MERGE)), samples)
    scores = [(MERGE - one.mean()) / one.std() for one in given.values()]
    neither = scipy.stats.multivariate_normal([0.0, 0.0], [[1.0, correlation], [correlation, 1.0]]).cdf(scores)
    assert shares_agree(float(found.any_probability), 1.0 - float(neither), samples)
    assert found.kind_probability.sel(kind="unstable") == found.any_probability
    assert found.kind_probability.sum() == pytest.approx(1.0)


@pytest.mark.parametrize("seed", range(6))
def test_correlated_coefficients_have_the_probability_of_their_slope(seed):
    """Random means, deviations and correlations of a falling law and a dashpot, point by point and as a share."""
    dice = np.random.default_rng(seed)
    deviations = {
        "static": (dice.uniform(0.5, 0.7), dice.uniform(0.01, 0.03)),
        "kinetic": (dice.uniform(0.25, 0.35), dice.uniform(0.01, 0.03)),
        "dashpot": (dice.uniform(6.0, 11.0), dice.uniform(0.3, 1.0)),
    }
    first, second = dice.uniform(-0.65, 0.65, 2).tolist()
    given = {name: scipy.stats.norm(*numbers) for name, numbers in deviations.items()}
    pairs = {("static", "kinetic"): first, ("kinetic", "dashpot"): second}
    samples = 100
    found = st.mode_probability(weakening_slider, given, samples=samples, correlations=pairs, seed=seed, workers=1)
    fall = LOAD * exp(-BELT / FALLS) / FALLS * (found.static.values - found.kinetic.values)
    np.testing.assert_allclose(found.growth_rate.values, 0.5 * (fall - found.dashpot.values), atol=1e-7)
    assert shares_agree(float(found.any_probability), probability_of_growth(deviations, first, second), samples)


def test_a_scenario_grows_beyond_its_critical_value():
    """A shipped case by its keys, in one process and in several: the same numbers."""
    onset = float(st.critical_value("weak-pressure", "friction", 0.5, 1.0).value)
    given = {"friction": (0.8, 1.0)}
    one, two = (st.mode_probability("weak-pressure", given, samples=24, workers=n) for n in (1, 2))
    np.testing.assert_array_equal(one.verdict.values == "unstable", one.friction.values > onset)
    assert one.equals(two)
    assert 2600.0 < float(one.frequency[0]) < 3000.0
    assert not bool(one.beyond_cutoff[0])


def test_a_stopped_study_is_resumed(tmp_path):
    out = tmp_path / "found.nc"

    def stop(progress):
        if progress.done >= 32:
            raise KeyboardInterrupt

    given = {"friction": (0.6, 0.9)}
    words = {"samples": 70, "out": out, "workers": 1}
    with pytest.raises(KeyboardInterrupt):
        st.mode_probability(hoffmann().system, given, watchers=[stop], **words)
    assert list((tmp_path / "found.nc.parts").glob("0*.json"))
    whole = st.mode_probability(hoffmann().system, given, **words)
    np.testing.assert_array_equal(whole.unstable_modes, whole.friction > MERGE)
    with pytest.raises(ValueError, match="of other points or options"):
        st.mode_probability(hoffmann().system, given, seed=1, **words)


def test_points_that_fail_widen_the_intervals():
    """A coefficient of friction below zero is no system: such points count for either side."""
    friction = scipy.stats.norm(0.5, 0.4)
    found = st.mode_probability(hoffmann().system, {"friction": friction}, samples=60, workers=1)
    values = found.friction.values
    failed, grows = int((values < 0.0).sum()), int((values > MERGE).sum())
    assert failed > 0
    assert int(found.failed) == failed
    assert f"{failed} of {failed} failures" in found.attrs["failure"]
    assert float(found.any_probability) == grows / (60 - failed)
    low, high = found.any_probability_interval.values
    ends = [scipy.stats.binomtest(count, 60).proportion_ci(0.95, "wilson") for count in (grows, grows + failed)]
    assert (low, high) == (ends[0].low, ends[1].high)
    with pytest.raises(ValueError, match="coefficient must be 0 or above"):
        st.mode_probability(hoffmann().system, {"friction": (-2.0, -1.0)}, samples=4)


def test_verdicts_without_sliding_are_told_apart():
    """A rod that digs in jams beyond a friction of cot 45 degrees, under a force along it."""
    found = st.mode_probability("squeal", {"friction": (0.8, 1.2)}, samples=30, workers=1)
    above = found.friction.values > 1.0
    assert set(found.verdict.values[above]) <= {"held", "jammed"}
    assert set(found.verdict.values[~above]) <= {"stable", "unstable"}
    assert np.isnan(found.growth_rate.values[above]).all()
    assert float(found.any_probability) == 0.0
    assert found.sizes["band"] == 1
    assert np.isnan(found.frequency.values).all()


def test_edges_and_highest_choose_what_is_counted():
    given = {"first": (0.8, 1.0), "second": (0.8, 1.0)}
    frequency = st.mode_probability(two_masses, given, samples=5, workers=1).frequency.values
    edges = [0.1, "1 Hz", 10.0]
    found = st.mode_probability(two_masses, given, samples=5, edges=edges, workers=1)
    assert found.probability.values.tolist() == [0.0, 1.0, 1.0, 0.0]
    assert found.edge.values.ravel().tolist() == [0.0, 0.1, 0.1, 1.0, 1.0, 10.0, 10.0, np.inf]
    low = st.mode_probability(two_masses, given, samples=5, highest=float(frequency.mean()), workers=1)
    assert low.sizes["band"] == 1
    assert low.unstable_modes.values.tolist() == [1.0] * 5


@pytest.mark.parametrize("seed", range(20))
def test_bands_are_separated_in_every_wide_gap(seed):
    """Neighbours nearer than the gap share a band, others do not, and each edge lies between both sides."""
    dice = np.random.default_rng(seed)
    frequencies = np.exp(dice.uniform(0.0, 3.0, 12))
    edges = edges_between(frequencies, 0.1)
    order = np.sort(frequencies)
    bands = bands_of(order, edges)
    wide = (order[1:] - order[:-1]) > 0.1 * order[1:]
    np.testing.assert_array_equal(np.diff(bands), wide.astype(int))
    assert edges_between(np.empty(0), 0.1).size == 0


BAD = [
    ({"uncertain": {}}, "uncertain|distributions"),
    ({"samples": 0}, "samples"),
    ({"gap": 1.0}, "gap"),
    ({"confidence": 0.0}, "confidence"),
    ({"edges": []}, "edges"),
    ({"edges": "1 kHz"}, "edges"),
    ({"edges": [2.0, 1.0]}, "edges"),
    ({"edges": [0.0]}, "edges"),
    ({"highest": "3 m"}, "highest"),
    ({"velocity": "fast"}, "velocity"),
    ({"uncertain": {"band": (0.0, 1.0)}}, "not have the name of a result"),
    ({"uncertain": {"frictions": (0.0, 1.0)}}, "frictions"),
    ({"correlations": {("friction", "angle"): 0.5}}, "correlations"),
    ({"workers": 0}, "workers"),
]


@pytest.mark.parametrize(("given", "message"), BAD)
def test_wrong_arguments_are_refused_in_a_line(given, message):
    words = {"uncertain": {"friction": (0.2, 0.4)}, "samples": 2} | given
    with pytest.raises(ValueError, match=message) as refused:
        st.mode_probability("weak-pressure", **words)
    assert "\n" not in str(refused.value)


def test_a_figure_has_a_bar_for_each_band():
    given = {"first": (0.6, 0.9), "second": (0.6, 1.0)}
    found = st.mode_probability(two_masses, given, samples=20, workers=1)
    left, right = st.plot.mode_probability(found).axes
    assert [bar.get_width() for bar in left.patches] == found.probability.values.tolist()
    assert len(left.get_yticklabels()) == len(right.lines) == 2
    drawn = [np.sort(line.get_xdata()) for line in right.lines]
    for band, rates in enumerate(drawn):
        known = found.band_growth_rate.values[:, band]
        np.testing.assert_array_equal(rates, np.sort(known[np.isfinite(known)]))
    with pytest.raises(ValueError, match="found must be the result of mode_probability"):
        st.plot.mode_probability(found.drop_vars("frequency"))


def test_a_random_field_is_one_of_the_parameters():
    """A field whose seed is a whole number: equal seeds give equal growth."""

    def fielded(field):
        factor = st.random_field([[0.0]], 1.0, 0.2, seed=field)[0]
        return hoffmann().system(MERGE * factor)

    given = {"field": scipy.stats.randint(0, 1000)}
    found = st.mode_probability(fielded, given, samples=30, workers=1)
    known = [st.random_field([[0.0]], 1.0, 0.2, seed=int(seed))[0] > 1.0 for seed in found.field.values]
    np.testing.assert_array_equal(found.unstable_modes.values > 0.0, known)
