"""Damping in scenarios: every form from TOML, by key, on the card and in the schema; refusals in one line."""

from __future__ import annotations

import json
import tomllib

import pytest

import stridula as st

RISING = {"form": "rising", "ratio": "0.3 %", "rise": "0.008 1/kHz"}


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("1 %", 0.01),
        (RISING, st.RisingDamping(0.003, 8e-6)),
        ({"form": "rayleigh", "mass": "3 1/s", "stiffness": "2 us"}, st.Rayleigh(3.0, 2e-6)),
        ({"mass": 3.0, "stiffness": 2e-6}, st.Rayleigh(3.0, 2e-6)),
        (
            {"form": "sampled", "frequency": ["100 Hz", "2 kHz"], "ratio": [0.01, "2 %"]},
            st.SampledDamping([100.0, 2000.0], [0.01, 0.02]),
        ),
    ],
)
def test_all_beams_take_every_form(given, expected):
    system = st.load_scenario("squeal", {"damping": given}).system
    assert system.slider.damping == system.track.damping == expected


def test_a_body_has_a_form_of_its_own():
    system = st.load_scenario("squeal", {"track.damping": RISING, "slider.damping": 0.02}).system
    assert system.track.damping == st.RisingDamping(0.003, 8e-6)
    assert system.slider.damping == 0.02


def test_a_law_is_set_key_by_key_and_changed_by_one_key():
    keys = {"damping.form": "rising", "damping.ratio": "1 %", "damping.rise": 1e-6}
    assert st.load_scenario("squeal", keys).system.track.damping == st.RisingDamping(0.01, 1e-6)
    assert st.load_scenario("squeal", keys | {"rise": 2e-6}).system.track.damping == st.RisingDamping(0.01, 2e-6)
    assert st.load_scenario("squeal", keys | {"damping": 0.03}).system.track.damping == 0.03


def test_keys_of_laws_that_are_not_there_hide_no_others():
    assert st.load_scenario("squeal", {"mass": "lumped"}).system.slider.mass == "lumped"


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (1.0, "damping must be below 1, got 1.0"),
        ("much", "damping must be a number, got 'much'"),
        ({"form": "rise"}, "damping must have a form that is one of rayleigh, rising, sampled, got {'form': 'rise'}"),
        ({"form": "rising", "ratio": 0.1}, "damping must have, in the form rising, ratio and rise"),
        (RISING | {"mass": 1.0}, "damping must have, in the form rising, ratio and rise"),
        (RISING | {"ratio": 2}, "damping must have a ratio that must be below 1"),
        (RISING | {"rise": "3 m"}, "damping must have a rise that must be a number in 1/Hz or 1/kHz"),
        (
            {"form": "sampled", "frequency": [2, 1], "ratio": [0, 0]},
            r"damping must be in order: frequency\[1\] must be above 2.0",
        ),
        (
            {"form": "sampled", "frequency": [2], "ratio": [0, 0]},
            "damping must be in order: ratio must have as many values as frequency",
        ),
    ],
)
def test_refusals_are_one_line(given, message):
    with pytest.raises(st.ScenarioError, match=message) as caught:
        st.load_scenario("squeal", {"damping": given})
    assert len(str(caught.value).splitlines()) == 1


def test_show_explains_the_law_and_comes_back():
    text = st.scenario_text("squeal")
    tables = tomllib.loads(text) | {"damping": RISING}
    assert st.load_scenario("squeal", {"damping": tables["damping"]}).system.track.damping.rise == 8e-6
    assert '"rising"' in json.dumps(st.scenario_schema())


def test_numbers_of_a_law_are_varied_in_a_sweep():
    points = [{"damping.form": "rising", "damping.ratio": 0.003, "damping.rise": slope} for slope in (1e-6, 2e-5)]
    found = st.sweep("squeal", points, ["travel"], duration=0.02)
    assert (found["message"].values == "").all()
    assert found["travel"].values[0] != found["travel"].values[1]
