"""Polynomial chaos and kriging of modes against closed forms and sampling, and their error at fresh points."""

from __future__ import annotations

from math import exp

import numpy as np
import pytest
import scipy.stats

import stridula as st
from stridula.studies.surrogates import EVALUATED, _coefficients, _roots
from stridula.verification.probabilities import BELT, FALLS, LOAD, probability_of_growth, weakening_slider
from stridula.verification.systems.mode_coupling import hoffmann

pytest.importorskip("openturns")

MERGE = 0.75
KINDS = ("chaos", "kriging")
FEW = {"samples": 40, "checks": 40, "workers": 1}


def within(low_and_high, value: float) -> bool:
    low, high = low_and_high
    return bool(low <= value <= high)


@pytest.mark.parametrize("kind", KINDS)
def test_modes_are_followed_through_their_merge(kind):
    """Hoffmann's modes: growth has a root at 0.75, but sum and product of the exponents are smooth there."""
    friction = scipy.stats.norm(0.72, 0.1)
    found = st.mode_surrogate(hoffmann().system, {"friction": friction}, (0.1, 0.5), kind=kind, **FEW)
    assert int(found.modes) == 2
    assert float(found.error) < 1e-4
    assert int(found.missed) == int(found.false_alarms) == 0
    assert float(found.probability) == pytest.approx(float(friction.sf(MERGE)), abs=5.0 * 0.5 / np.sqrt(EVALUATED))
    sampled = st.mode_probability(hoffmann().system, {"friction": friction}, samples=200, seed=7, workers=1)
    low, high = sampled.probability_interval.values[0]
    assert max(low, float(found.probability_interval[0])) < min(high, float(found.probability_interval[1]))
    known = hoffmann().exponents(float(friction.ppf(0.95)))[0].real
    assert float(found.growth_rate.sel(share=0.95)) == pytest.approx(known, rel=0.02)
    # One parameter causes all.
    np.testing.assert_allclose(found.first_order.values, 1.0, atol=0.1)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(3))
def test_random_laws_have_their_probability_and_indices(kind, seed):
    """Growth that is linear in three normal parameters: indices are shares of the sum of their variances."""
    dice = np.random.default_rng(seed)
    deviations = {
        "static": (dice.uniform(0.5, 0.7), dice.uniform(0.01, 0.03)),
        "kinetic": (dice.uniform(0.25, 0.35), dice.uniform(0.01, 0.03)),
        "dashpot": (dice.uniform(7.0, 10.0), dice.uniform(0.3, 1.0)),
    }
    given = {name: scipy.stats.norm(*numbers) for name, numbers in deviations.items()}
    found = st.mode_surrogate(weakening_slider, given, (5.0, 30.0), kind=kind, seed=seed, **FEW)
    known = probability_of_growth(deviations, 0.0, 0.0)
    assert float(found.probability) == pytest.approx(known, abs=5.0 * 0.5 / np.sqrt(EVALUATED))
    assert within(found.probability_interval.values, known)
    weight = LOAD * exp(-BELT / FALLS) / FALLS
    variances = (np.array([weight, weight, 1.0]) * np.array(list(deviations.values()))[:, 1]) ** 2
    for name in ("first_order", "total_order"):
        np.testing.assert_allclose(found[name].sel(output="growth_rate"), variances / variances.sum(), atol=0.02)
    pairs = {("static", "kinetic"): 0.6, ("kinetic", "dashpot"): -0.3}
    words = FEW | {"correlations": pairs, "seed": seed, "kind": kind}
    correlated = st.mode_surrogate(weakening_slider, given, (5.0, 30.0), **words)
    known = probability_of_growth(deviations, 0.6, -0.3)
    assert float(correlated.probability) == pytest.approx(known, abs=5.0 * 0.5 / np.sqrt(EVALUATED))
    assert np.isnan(correlated.first_order).all()


@pytest.mark.parametrize("seed", range(5))
def test_indices_of_sampling_and_of_chaos_agree(seed):
    """Of a uniform friction and a uniform dashpot: intervals of both overlap."""
    given = {"static": (0.55, 0.65), "dashpot": (8.0, 9.0)}

    def made(static, dashpot):
        return weakening_slider(static, 0.3, dashpot), {"duration": 1.0}

    by_chaos = st.mode_surrogate(made, given, (5.0, 30.0), seed=seed, **FEW)
    sampled = st.sensitivity(made, given, ["stability"], samples=64, seed=seed, resamples=99, workers=1)
    for name in ("first_order", "total_order"):
        one = by_chaos[f"{name}_interval"].sel(output="growth_rate").values
        other = sampled[f"{name}_interval"].sel(output="growth_rate").values
        assert (np.maximum(one[:, 0], other[:, 0]) <= np.minimum(one[:, 1], other[:, 1])).all()


@pytest.mark.parametrize("modes", range(1, 7))
def test_roots_are_those_of_their_polynomial(modes):
    dice = np.random.default_rng(modes)
    exponents = dice.uniform(-1.0, 1.0, (50, modes)) + 1.0j * dice.uniform(-1.0, 1.0, (50, modes))
    found = _roots(_coefficients(exponents))
    for one, other in zip(found, exponents, strict=True):
        np.testing.assert_allclose(np.sort_complex(one), np.sort_complex(other), atol=1e-6)


def test_a_bad_fit_is_refused():
    """A friction that falls over the speed of the belt only for some points: growth has a jump."""

    def jumping(friction, other):
        return weakening_slider(0.6 if np.sin(40.0 * friction) * np.sin(40.0 * other) > 0.0 else 0.4, 0.3, 4.0)

    given = {"friction": (0.0, 1.0), "other": (0.0, 1.0)}
    for kind in KINDS:
        with pytest.raises(ValueError, match=r"at most 0\.1 of its deviation, got .* or mode_probability"):
            st.mode_surrogate(jumping, given, (5.0, 30.0), kind=kind, **FEW)


def test_modes_that_enter_the_band_are_refused():
    with pytest.raises(ValueError, match="band must hold the same number of modes, 1 to 6, at every point, got 0 to 2"):
        st.mode_surrogate(hoffmann().system, {"friction": (0.2, 1.2)}, (0.2245, 0.2255), **FEW)
    with pytest.raises(ValueError, match="at every point, got 0 from 5 to 6 Hz"):
        st.mode_surrogate(hoffmann().system, {"friction": (0.2, 1.2)}, (5.0, 6.0), **FEW)


def test_points_that_fail_or_stick_are_refused():
    with pytest.raises(ValueError, match="uncertain must leave no point that fails, got"):
        st.mode_surrogate(hoffmann().system, {"friction": scipy.stats.norm(0.5, 0.4)}, (0.1, 0.5), **FEW)
    with pytest.raises(ValueError, match="let the contacts slide at every point"):
        st.mode_surrogate("squeal", {"friction": (0.8, 1.2)}, (100.0, 1e4), **FEW)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"kind": "neural"}, "kind must be chaos or kriging|kind must be one of"),
        ({"band": (2.0, 1.0)}, "band"),
        ({"band": (1.0, 2.0, 3.0)}, "be a lowest and a highest frequency"),
        ({"samples": 5}, "samples"),
        ({"checks": 1}, "checks"),
        ({"tolerance": 2.0}, "tolerance"),
        ({"uncertain": {}}, "distributions"),
    ],
)
def test_wrong_arguments_are_refused_in_a_line(given, message):
    words = {"uncertain": {"friction": (0.2, 0.4)}, "band": (0.1, 0.5)} | given
    with pytest.raises(ValueError, match=message) as refused:
        st.mode_surrogate(hoffmann().system, **words)
    assert "\n" not in str(refused.value)
