"""Scenario files: bases, keys and the shipped cases."""

from __future__ import annotations

import math

import numpy as np
import pytest
from unit.scenario_texts import CASES, MASSES, PLATES

import stridula as st

MESHED = ["brake", "glass", "pad-on-disc", "pin-on-disc", "wheel"]
STRINGS = ["violin"]


def test_the_cases_are_listed_by_their_sources():
    cases = st.list_scenarios()
    assert sorted(case.name for case in cases) == sorted(CASES + MASSES + PLATES + MESHED + STRINGS)
    assert all(case.source for case in cases)
    assert [case.source for case in cases] == sorted(case.source for case in cases)


def test_all_cases_share_one_set_of_beams():
    systems = {name: st.load_scenario(name).system for name in CASES}
    assert len({system.track for system in systems.values()}) == 1
    sliders = {name: system.slider for name, system in systems.items()}
    assert {sliders[name].angle for name in CASES if "pressure" in name} == {-math.pi / 4}
    assert {sliders[name].angle for name in CASES if "pressure" not in name} == {math.pi / 4}
    assert len({(slider.length, slider.material, slider.section, slider.damping) for slider in sliders.values()}) == 1


@pytest.mark.parametrize("name", CASES + MASSES + PLATES + MESHED + STRINGS)
def test_shown_scenarios_load_as_the_same_scenario(name, tmp_path):
    path = tmp_path / "copy.toml"
    path.write_text(st.scenario_text(name), encoding="utf-8")
    assert "base =" not in path.read_text(encoding="utf-8")
    assert st.load_scenario(path) == st.load_scenario(name)


def test_a_body_changes_what_both_share(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(
        'base = "squeal"\n[track]\ndamping = 0.02\nmaterial = {density = 2700.0}\n'
        'section = {shape = "circle", diameter = "20 mm"}\n'
    )
    system, before = st.load_scenario(path).system, st.load_scenario("squeal").system
    assert system.slider == before.slider
    assert system.track.damping == 0.02
    assert system.track.material == st.Material(before.track.material.young, 2700.0)
    assert system.track.section == st.Circle(0.020)


def test_a_base_is_found_beside_the_file_that_names_it(tmp_path):
    (tmp_path / "sub").mkdir()
    (tmp_path / "mine.toml").write_text('base = "squeal"\ntitle = "mine"\n[contact]\nfriction = 0.7\n')
    (tmp_path / "sub" / "case.toml").write_text('base = "../mine.toml"\n[slider]\nangle = "30 deg"\n')
    scenario = st.load_scenario(tmp_path / "sub" / "case.toml")
    assert scenario.title == "mine"
    assert scenario.system.contact.friction == st.Coulomb(0.7)
    assert scenario.system.slider.angle == math.radians(30)


@pytest.mark.parametrize(
    ("key", "value", "read"),
    [
        ("contact.friction.coefficient", 1.2, lambda s: s.system.contact.friction.coefficient == 1.2),
        ("coefficient", "1.2", lambda s: s.system.contact.friction.coefficient == 1.2),
        ("friction", "1.2", lambda s: s.system.contact.friction.coefficient == 1.2),
        ("angle", "30 deg", lambda s: s.system.slider.angle == math.radians(30)),
        ("slider.length", 0.5, lambda s: s.system.slider.length == 0.5 < s.system.track.length),
        ("drives.0.transverse", 5, lambda s: s.system.drives[0].transverse == 5.0),
        ("simulation.step", 1e-6, lambda s: s.step == 1e-6),
        ("slider.mass", "lumped", lambda s: s.system.slider.mass == "lumped"),
        ("damping", 0.01, lambda s: s.system.slider.damping == s.system.track.damping == 0.01),
        ("material.young", 7e10, lambda s: s.system.slider.material.young == s.system.track.material.young == 7e10),
        ("track.material.young", 7e10, lambda s: s.system.slider.material != s.system.track.material),
        ("history", {"kind": "ramp", "duration": 0.1}, lambda s: s.system.drives[0].history == st.Ramp(0.1)),
        ("elements", np.int64(7), lambda s: s.system.slider.elements == 7),
    ],
)
def test_a_key_changes_what_it_names(key, value, read):
    assert not read(st.load_scenario("squeal"))
    assert read(st.load_scenario("squeal", {key: value}))


def test_another_shape_starts_a_section_afresh():
    system = st.load_scenario("squeal", {"section.shape": "circle", "diameter": "20 mm"}).system
    assert system.slider.section == system.track.section == st.Circle(0.020)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        ({"length": 1}, "key must name one place, got 'length', which fits slider.length, track.length"),
        ({"frction": 1}, "key must be a key of the scenario, got 'frction'; did you mean 'friction'?"),
        ({"drives.3.x": 1}, "got 'drives.3.x'; did you mean 'drives.0.x'?"),
        (
            {"contact": 1},
            "set one of its keys at, friction, gap, stiffness, tangential_stiffness, tangential_damping, heating, "
            "profile, point, name",
        ),
        ({"angle": "20 mm"}, "slider.angle must be a number in rad or deg, got '20 mm'"),
        ({"angle": "95 deg"}, "slider.angle must be strictly between -pi/2 and pi/2"),
        ({"elements": True}, "slider.elements must be a whole number, got True"),
        ({"elements": "1.5"}, "slider.elements must be a whole number, got 1.5"),
        ({"friction": "true"}, "contact.friction.coefficient must be a number, got True"),
        ({"slider.mass": "lump"}, "must be one of consistent, lumped, got 'lump'; did you mean 'lumped'?"),
        ({"damping": 2}, "damping must be below 1, got 2"),
        ({"cutoff": 1}, "cutoff must leave at least one bending mode"),
        ({"duration": 0}, "simulation.duration must be above 0, got 0"),
        ({"contact.at": 20.0}, "contact.at must be strictly between 0 and "),
        ({"gap": -1e-6}, "contact.gap must be 0 or above, got -1e-06"),
    ],
)
def test_impossible_changes_are_explained(overrides, message):
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario("squeal", overrides)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_the_schema_knows_every_key_and_forbids_others():
    schema = st.scenario_schema()
    assert "required" not in str(schema)
    assert "'unit'" not in str(schema)
    assert set(schema["properties"]) >= {"base", "slider", "track", "contact", "drives", "simulation"}
    slider = schema["$defs"]["Slider"]
    assert slider["additionalProperties"] is False
    assert slider["properties"]["elements"] == {
        "default": 20,
        "description": "number of finite elements",
        "minimum": 1,
        "title": "Elements",
        "type": "integer",
    }
