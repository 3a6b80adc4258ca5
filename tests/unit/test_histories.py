"""Histories: consistency of factor and integral, and refused arguments."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import stridula as st

NAN, INF = float("nan"), float("inf")
HISTORIES = [
    st.Constant(),
    st.Ramp(0.3),
    st.Harmonic(2.3, amplitude=0.7, mean=0.4, phase=1.1),
    st.Sampled((0.0, 0.2, 0.5, 0.9), (1.0, -2.0, 0.5, 0.25)),
    st.Sampled((0.15, 0.4), (3.0, 1.0)),
    st.Sampled((0.0, 0.2, 0.2, 0.3, 0.5, 0.5, 0.9), (1.0, 2.0, -1.0, 0.5, 0.5, 3.0, 0.0)),
    st.Sampled((0.15, 0.15, 0.4, 0.4), (0.0, 1.0, 1.0, 0.0)),
]
KNOTS = [0.15, 0.2, 0.3, 0.4, 0.5, 0.9]
IDS = ["constant", "ramp", "harmonic", "sampled", "sampled late", "jumps", "on and off"]


@pytest.mark.parametrize("history", HISTORIES, ids=IDS)
@pytest.mark.parametrize(("rate", "integral"), [("factor", "integral"), ("integral", "second_integral")])
def test_integral_is_the_area_under_the_factor(history, rate, integral):
    for end in (0.0, 0.1, 0.2, 0.35, 0.77, 1.4):
        # From one kink or jump to the next.
        ends = [0.0, *(knot for knot in KNOTS if knot < end), end]
        pieces = [
            quad(lambda t: float(getattr(history, rate)(np.array([t]))[0]), *piece, limit=200)[0]
            for piece in pairwise(ends)
        ]
        assert getattr(history, integral)(np.array([end]))[0] == pytest.approx(sum(pieces), abs=1e-10)


@pytest.mark.parametrize("history", HISTORIES, ids=IDS)
def test_vectorised_and_pure(history):
    t = np.linspace(0, 1.2, 7)
    for function in (history.factor, history.integral, history.second_integral):
        values = function(t)
        assert values.shape == t.shape
        np.testing.assert_array_equal(values, [function(np.array([x]))[0] for x in t])
        values[:] = 0.0
    assert t[-1] == 1.2, "a history must not hand its argument back"
    assert hash(history) == hash(history)


def test_closed_forms():
    ramp = st.Ramp(0.5)
    np.testing.assert_allclose(ramp.factor(np.array([0.0, 0.25, 0.5, 2.0])), [0, 0.5, 1, 1])
    np.testing.assert_allclose(ramp.integral(np.array([0.5, 1.5])), [0.25, 1.25])
    tone = st.Harmonic(10.0, phase=np.pi / 2)
    np.testing.assert_allclose(tone.factor(np.array([0.0, 0.05])), [1.0, -1.0])
    sampled = st.Sampled([0.1, 0.2], [1.0, 3.0])
    np.testing.assert_allclose(sampled.factor(np.array([0.0, 0.1, 0.15, 0.2, 9.0])), [1, 1, 2, 3, 3])
    assert sampled == st.Sampled((0.1, 0.2), (1.0, 3.0))


def test_a_jump_is_the_mean_of_its_sides_at_its_time_however_that_is_rounded():
    switched = st.Sampled((0.0, 0.2, 0.2), (1.0, 1.0, 0.0))
    np.testing.assert_array_equal(switched.factor(np.array([0.0, 0.2 - 1e-9, 0.2, 0.2 + 1e-9, 5.0])), [1, 1, 0.5, 0, 0])
    step = 0.2 / 7_000
    assert 7_000 * step == 0.2
    rounded = np.array([np.nextafter(0.2, 0.0), 0.2, np.nextafter(0.2, 1.0)])
    np.testing.assert_array_equal(switched.factor(rounded), 0.5)
    np.testing.assert_allclose(switched.integral(rounded), 0.2, rtol=1e-15)
    np.testing.assert_allclose(switched.second_integral(np.array([0.2, 1.2])), [0.02, 0.22], rtol=1e-15)
    close = st.Sampled((0.1, 0.1, 0.1 + 1e-9, 0.1 + 1e-9), (0.0, 1.0, 1.0, 5.0))
    np.testing.assert_array_equal(close.factor(np.array([0.1, 0.1 + 5e-10, 0.1 + 1e-9])), [0.5, 1.0, 3.0])


POSITIVE = [NAN, INF, 0.0, -1.0, True, "1", None]
FINITE = [NAN, INF, True, "1", None]
MAKERS = {
    "Ramp.duration": (lambda v: st.Ramp(v), "duration", POSITIVE),
    "Harmonic.frequency": (lambda v: st.Harmonic(v), "frequency", POSITIVE),
    "Harmonic.amplitude": (lambda v: st.Harmonic(1.0, amplitude=v), "amplitude", FINITE),
    "Harmonic.mean": (lambda v: st.Harmonic(1.0, mean=v), "mean", FINITE),
    "Harmonic.phase": (lambda v: st.Harmonic(1.0, phase=v), "phase", FINITE),
    "Sampled.time": (
        lambda v: st.Sampled(v, (0.0, 1.0)),
        "time",
        [None, 1.0, "01", (1.0, 0.0), (-1.0, 0.0), (0.0, 0.0), (-1.0, -1.0)],
    ),
    "Sampled.value": (lambda v: st.Sampled((0.0, 1.0), v), "value", [None, 1.0, "01"]),
}
CASES = [pytest.param(*rest[:2], v, id=f"{k}={v!r}"[:60]) for k, rest in MAKERS.items() for v in rest[2]]


@pytest.mark.parametrize(("make", "name", "value"), CASES)
def test_bad_arguments_are_named_with_value_and_range(make, name, value):
    with pytest.raises(ValueError, match=rf"^{name} must ") as caught:
        make(value)
    assert repr(value) in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("value", [NAN, INF, "1", None, True])
@pytest.mark.parametrize("name", ["time", "value"])
def test_a_bad_number_in_a_table_is_named_with_its_place(name, value):
    table = {"time": [0.0, 1.0], "value": [0.0, 1.0]}
    table[name][1] = value
    with pytest.raises(ValueError, match=rf"^{name}\[1\] must ") as caught:
        st.Sampled(**table)
    assert repr(value) in str(caught.value)


@pytest.mark.parametrize(("time", "value"), [((0.0,), (1.0,)), ((), ()), ((0.0, 1.0), (1.0,))])
def test_tables_of_unequal_or_too_short_length(time, value):
    with pytest.raises(ValueError, match=r"^time and value must have the same length, at least 2"):
        st.Sampled(time, value)


@pytest.mark.parametrize(
    ("time", "message"),
    [
        ((0.0, 1.0, 0.5), r"time must increase, got (0.0, 1.0, 0.5), with time[2] = 0.5 after 1.0"),
        (
            (0.0, 1.0, 1.0, 1.0),
            "time must have at most two points, a jump, at the same time, got (0.0, 1.0, 1.0, 1.0), ",
        ),
        ((0.0, 0.0, 1.0), "time must be above 0 at a jump, got (0.0, 0.0, 1.0)"),
        ((*range(10_000), 1.0), "time must increase, got a tuple, with time[10000] = 1.0 after 9999.0"),
    ],
)
def test_times_that_do_not_rise(time, message):
    with pytest.raises(ValueError) as caught:
        st.Sampled(time, (0.0,) * len(time))
    assert str(caught.value).startswith(message)
    assert len(str(caught.value)) < 150
