"""Sensitivity: closed forms, scipy's own indices, probabilities with intervals, failed and constant outputs."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
import scipy.stats
import xarray as xr

import stridula as st
from stridula.studies import sobol

A, B = 7.0, 0.1
CIRCLE = dict.fromkeys(("x", "y", "z"), (-math.pi, math.pi))


def ishigami(x, y, z):
    return np.sin(x) + A * np.sin(y) ** 2 + B * z**4 * np.sin(x)


@pytest.fixture
def computed(monkeypatch):
    """Replace a sweep by a function of the points, which returns values over the points by name."""

    def put(function):
        def sweep(scenario, points, measures, **options):
            columns = {key: np.array([point[key] for point in points]) for key in points[0]}
            found = {name: np.asarray(values) for name, values in function(**columns).items()}
            message = found.pop("message", np.full(len(points), "", dtype=object))
            data = {name: ("point", values) for name, values in (found | {"message": message}).items()}
            return xr.Dataset(data)

        monkeypatch.setattr(sobol, "sweep", sweep)

    return put


def test_indices_of_the_ishigami_function(computed):
    computed(lambda x, y, z: {"f": ishigami(x, y, z)})
    found = st.sensitivity("any", CIRCLE, "travel", samples=4096, resamples=99)
    variance = A**2 / 8.0 + B * math.pi**4 / 5.0 + B**2 * math.pi**8 / 18.0 + 0.5
    alone = 0.5 * (1.0 + B * math.pi**4 / 5.0) ** 2
    together = B**2 * math.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    first = np.array([alone, A**2 / 8.0, 0.0]) / variance
    total = np.array([alone + together, A**2 / 8.0, together]) / variance
    one = found.sel(output="f")
    np.testing.assert_allclose(one["first_order"], first, atol=0.02)
    np.testing.assert_allclose(one["total_order"], total, atol=0.02)
    for name in ("first_order", "total_order"):
        low, high = one[f"{name}_interval"].transpose("bound", "parameter").values
        assert (low <= one[name].values).all()
        assert (one[name].values <= high).all()
        assert (high - low < 0.15).all()
    assert found.attrs == {"confidence": 0.95, "samples": 4096, "seed": 0}


def test_indices_are_those_of_scipy():
    random = np.random.default_rng(3)
    sets = random.random((5, 64))
    first, total = sobol._sobol(sets)
    given = {"f_A": sets[None, 0], "f_B": sets[None, 1], "f_AB": sets[2:, None, :]}
    theirs = scipy.stats.sobol_indices(func=given, n=64)
    np.testing.assert_allclose(first, theirs.first_order.ravel(), rtol=1e-12)
    np.testing.assert_allclose(total, theirs.total_order.ravel(), rtol=1e-12)


def test_points_follow_their_distributions(computed):
    seen = {}

    def keep(**columns):
        seen.update(columns)
        return {"f": columns["a"]}

    computed(keep)
    log = st.Range(1.0, 100.0, logarithmic=True)
    st.sensitivity("any", {"a": scipy.stats.norm(3.0, 0.5), "b": log, "c": ("1 mm", "2 mm")}, samples=256, resamples=9)
    # Set A, without those of set B.
    drawn = seen["a"][:256]
    assert scipy.stats.kstest(drawn, scipy.stats.norm(3.0, 0.5).cdf).pvalue > 0.5
    assert np.median(seen["b"]) == pytest.approx(10.0, rel=0.02)
    assert all(text.endswith(" mm") for text in seen["c"])
    assert len(drawn) * 5 == len(seen["a"])


def test_probabilities_have_wilsons_interval_and_count_independent_draws_only(computed):
    computed(lambda a: {"regime": np.where(a < 0.25, "squeal", "sticking").astype(object)})
    found = st.sensitivity("any", {"a": (0.0, 1.0)}, samples=64, confidence=0.9, resamples=99)
    squeal = found.sel(regime="squeal")
    assert float(squeal["probability"]) == pytest.approx(0.25, abs=0.02)
    z, n, p = scipy.stats.norm.ppf(0.95), 128, float(squeal["probability"])
    middle, half = p + z**2 / (2 * n), z * math.sqrt(p * (1 - p) / n + z**2 / (4 * n**2))
    expected = np.array([middle - half, middle + half]) / (1 + z**2 / n)
    np.testing.assert_allclose(squeal["probability_interval"], expected)
    assert float(found["probability"].sum()) == pytest.approx(1.0)
    # The only parameter causes all of the variance.
    assert float(found["first_order"].sel(output="is squeal", parameter="a")) == pytest.approx(1.0, abs=0.1)
    assert np.isnan(found["first_order"].sel(output="is judder")).all()


def test_samples_with_a_run_that_failed_are_left_out_and_counted(computed):
    def some_fail(a, b):
        bad = a > 0.75
        return {
            "f": np.where(bad, np.nan, a + 2.0 * b),
            "regime": np.where(bad, "", "squeal").astype(object),
            "message": np.where(bad, "no", "").astype(object),
        }

    computed(some_fail)
    found = st.sensitivity("any", {"a": (0.0, 1.0), "b": (0.0, 1.0)}, samples=256, resamples=9)
    assert int(found["runs"]) == 1024
    assert 0.2 < int(found["failed"]) / 1024 < 0.3
    # Both a of set A and a of set B are good in 9 samples of 16.
    assert int(found["used"].sel(output="f")) == pytest.approx(256 * 9 / 16, abs=8)
    good = found["first_order"].sel(output="f")
    # Variances of a below 0.75 and of 2 b.
    share = 0.75**2 / (0.75**2 + 4.0)
    np.testing.assert_allclose(good, [share, 1.0 - share], atol=0.1)
    assert float(found["probability"].sel(regime="squeal")) == 1.0


@pytest.mark.parametrize(
    "outputs",
    [
        lambda a: {"f": np.full(a.size, 3.0)},
        lambda a: {"f": np.full(a.size, np.nan)},
        lambda a: {"f": np.where(np.arange(a.size) % 16 < 9, np.nan, a)},
    ],
    ids=["constant", "NaN", "too few"],
)
def test_outputs_that_hardly_vary_have_no_indices_and_no_warning(computed, outputs):
    computed(outputs)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = st.sensitivity("any", {"a": (0.0, 1.0)}, samples=16)
    assert np.isnan(found["first_order"]).all()
    assert np.isnan(found["total_order_interval"]).all()


def test_an_output_that_varies_in_one_sample_gives_no_warning(computed):
    computed(lambda a: {"f": (np.arange(a.size) == 3).astype(float)})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = st.sensitivity("any", {"a": (0.0, 1.0)}, samples=8, resamples=1, seed=1)
    assert np.isfinite(found["first_order"]).all()


def test_equal_seeds_give_equal_results(computed):
    computed(lambda x, y, z: {"f": ishigami(x, y, z)})
    one, same, other = (st.sensitivity("any", CIRCLE, samples=16, resamples=9, seed=seed) for seed in (1, 1, 2))
    assert one.identical(same)
    assert not np.array_equal(one["first_order"], other["first_order"])


def test_a_scenario_is_swept():
    found = st.sensitivity(
        "squeal",
        {"friction": (0.2, 0.9), "angle": ("40 deg", "95 deg")},
        ["stability", "mean_force"],
        samples=8,
        resamples=9,
        duration="2 ms",
    )
    assert found.sizes["parameter"] == 2
    assert {"growth_rate", "mean_force"} <= set(found["output"].values.tolist())
    assert int(found["runs"]) == 32
    assert 0 < int(found["failed"]) < 16
    assert "probability" not in found


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"samples": 7}, "samples must be a power of 2, got 7"),
        ({"samples": 0}, "samples must be at least 1, got 0"),
        ({"samples": 2.0}, "samples must be a whole number, got 2.0"),
        ({"resamples": 0}, "resamples must be at least 1, got 0"),
        ({"confidence": 1.0}, "confidence must be strictly between 0 and 1, got 1.0"),
        ({"seed": -1}, "seed must be at least 0, got -1"),
        ({"uncertain": {}}, "uncertain must be distributions by key, got {}"),
        ({"uncertain": {"friction": 0.3}}, "uncertain['friction'] must be a Range or its two ends, got 0.3"),
        ({"uncertain": {"friction": (2, 1)}}, "uncertain['friction']: high must be above low (2), got 1"),
        ({"uncertain": {"friction": scipy.stats.norm([0, 1])}}, "must be a frozen distribution of one number"),
        ({"uncertain": {"frition": (0, 1)}}, "did you mean 'friction'?"),
        ({"measures": "regim"}, "did you mean 'regime'?"),
    ],
)
def test_bad_arguments_are_one_line(given, message):
    arguments = {"uncertain": {"friction": (0.2, 0.4)}} | given
    with pytest.raises(ValueError) as error:
        st.sensitivity("squeal", **arguments)
    assert message in str(error.value)
    assert "\n" not in str(error.value)
