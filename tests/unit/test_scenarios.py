"""Scenario files: units, bases, keys, messages, and the round trip with records."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as some

import stridula as st
from stridula.records.provenance import scenario_toml
from stridula.scenarios.quantities import quantity

CASES = ["axial-sliding", "judder", "squeal", "stable-sliding", "strong-pressure", "weak-pressure"]
STEEL = st.Material(young=2.1e11, density=7800.0)
SIMULATION = {"duration": 0.5, "scheme": "central difference", "step": 1e-6, "sample_rate": 5e4}


def problems(text: str, folder: Path, overrides: dict[str, object] | None = None) -> tuple[str, ...]:
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario(path, overrides)
    return caught.value.problems


@pytest.mark.parametrize(
    ("text", "unit", "expected"),
    [
        ("45 deg", "rad", math.pi / 4),
        ("1 cm/s", "m/s", 0.01),
        ("20 mm", "m", 0.020),
        ("9.8mm", "m", 0.0098),
        ("5 us", "s", 5e-6),
        ("15 kHz", "Hz", 15e3),
        ("2.1e11", "Pa", 2.1e11),
        ("210 GPa", "Pa", 2.1e11),
        ("-3 N", "N", -3.0),
        ("7.8 g/cm³", "kg/m3", 7800.0),
        ("75.5e-2 %", "1", 0.00755),
        (np.float32(0.5), "m", 0.5),
        (3, "m", 3.0),
    ],
)
def test_quantities_become_exact_si(text, unit, expected):
    assert quantity(text, unit) == expected


@given(some.floats(allow_nan=False, allow_infinity=False))
def test_every_number_is_read_as_python_reads_it(number):
    assert quantity(repr(number), "m") == number
    assert quantity(f"{number!r} m", "m") == number


@pytest.mark.parametrize("value", ["20 mm", "x", "", "1 2", "0x10", True, None, [1.0], "1e5 rad/s"])
def test_a_quantity_of_another_dimension_is_refused(value):
    with pytest.raises(ValueError, match="must be a number in rad or deg"):
        quantity(value, "rad")


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e999", math.nan, math.inf, 10**400])
def test_a_quantity_must_be_finite(value):
    with pytest.raises(ValueError, match="must be finite"):
        quantity(value, "m")


def test_the_cases_of_the_paper_are_listed_in_its_order():
    cases = st.list_scenarios()
    assert sorted(case.name for case in cases) == CASES
    assert [case.source for case in cases] == sorted(case.source for case in cases)
    assert cases[0].name == "stable-sliding"


def test_all_cases_share_one_set_of_beams():
    systems = {name: st.load_scenario(name).system for name in CASES}
    assert len({system.track for system in systems.values()}) == 1
    sliders = {name: system.slider for name, system in systems.items()}
    assert {sliders[name].angle for name in CASES if "pressure" in name} == {-math.pi / 4}
    assert {sliders[name].angle for name in CASES if "pressure" not in name} == {math.pi / 4}
    assert len({(slider.length, slider.material, slider.section, slider.damping) for slider in sliders.values()}) == 1


@pytest.mark.parametrize("name", CASES)
def test_what_is_shown_loads_as_the_same_scenario(name, tmp_path):
    path = tmp_path / "copy.toml"
    path.write_text(st.scenario_text(name), encoding="utf-8")
    assert "base =" not in path.read_text(encoding="utf-8")
    assert st.load_scenario(path) == st.load_scenario(name)


@pytest.mark.parametrize("name", CASES)
def test_every_case_survives_provenance(name, tmp_path):
    scenario = st.load_scenario(name)
    assert reloaded(scenario.system, (), tmp_path).system == scenario.system


def reloaded(system, probes, folder):
    path = folder / "provenance.toml"
    path.write_text(scenario_toml(system, probes, SIMULATION), encoding="utf-8")
    return st.load_scenario(path)


def make(section=None, drives=lambda slider, track: [], **slider_fields):
    section = section or st.Rectangle(0.02, 0.0098)
    slider = st.FiniteElementBeam(STEEL, section, **{"length": 0.5, "angle": 0.3, "elements": 4} | slider_fields)
    track = st.ModalBeam(STEEL, section, length=0.9, bending_modes=7, axial_modes=3, damping=0.01)
    contact = st.PointContact(slider.tip, track, at=0.3, friction=st.Coulomb(0.4), gap=2e-6)
    return st.System(contact, drives(slider, track))


HISTORIES = [
    st.Constant(),
    st.Ramp(0.1),
    st.Harmonic(120.0, amplitude=0.5, mean=1.0, phase=0.2),
    st.Sampled(time=(0.0, 0.1, 0.3), value=(0.0, -1.0, 2.0)),
]


@pytest.mark.parametrize("history", HISTORIES, ids=lambda history: type(history).__name__)
@pytest.mark.parametrize("kind", ["force", "imposed velocity"])
def test_every_drive_and_history_survives_provenance(kind, history, tmp_path):
    def drives(slider, track):
        if kind == "imposed velocity":
            return [st.ImposedVelocity(slider.root, 0.01, normal_load=5.0, history=history)]
        return [
            st.Force(slider.root, axial=-1.0, transverse=2.0, history=history),
            st.Force(slider.at(0.123), x=3.0, y=np.float64(-4.0)),
            st.Force(track.at(0.4), y=1.0),
            st.Force(track.centre, y=1.0),
            st.Gravity(1.62),
            st.InitialVelocity(slider, x=0.5),
            st.InitialVelocity(track, y=-0.5),
        ]

    system = make(drives=drives)
    assert reloaded(system, (), tmp_path).system == system


@pytest.mark.parametrize("section", [st.Rectangle(0.02, 0.01), st.Circle(0.012), st.Section(2e-4, 3e-9)])
def test_every_section_survives_provenance(section, tmp_path):
    system = make(section=section, cutoff=20e3, root_support="free", mass="lumped", damping=np.float32(0.25))
    assert reloaded(system, (), tmp_path).system == system


def test_every_probe_and_the_simulation_survive_provenance(tmp_path):
    system = make()
    probes = (
        st.Acceleration(system.track.centre, "y"),
        st.Velocity(system.slider.tip, "axial"),
        st.Displacement(system.slider.at(0.2), "transverse"),
        st.Displacement(system.track.at(0.2), "x"),
        st.Reaction(system.slider, "x"),
    )
    scenario = reloaded(system, probes, tmp_path)
    assert scenario.probes == probes
    assert (scenario.duration, scenario.step, scenario.sample_rate) == (0.5, 1e-6, 5e4)
    assert scenario.scheme == st.CentralDifference()


def test_a_record_runs_again_from_its_file(tmp_path):
    scenario = st.load_scenario("squeal", {"duration": "2 ms"})
    record = scenario.simulate()
    st.save(record, tmp_path / "run.nc")
    again = st.load_scenario(tmp_path / "run.nc")
    assert again.title == scenario.title
    repeated = again.simulate()
    np.testing.assert_array_equal(repeated["normal_force"], record["normal_force"])


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


def test_a_base_cannot_lead_back_to_itself(tmp_path):
    (tmp_path / "other.toml").write_text('base = "case.toml"')
    assert "must not lead back to itself" in problems('base = "other.toml"', tmp_path)[0]


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


def test_a_shared_key_changes_both_bodies_of_a_record(tmp_path):
    path = tmp_path / "provenance.toml"
    path.write_text(scenario_toml(make(), (), SIMULATION))
    system = st.load_scenario(path, {"material.young": 7e10, "damping": 0.03}).system
    assert system.slider.material == system.track.material == st.Material(7e10, 7800.0)
    assert system.slider.damping == system.track.damping == 0.03


def test_another_shape_starts_a_section_afresh():
    system = st.load_scenario("squeal", {"section.shape": "circle", "diameter": "20 mm"}).system
    assert system.slider.section == system.track.section == st.Circle(0.020)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        ({"length": 1}, "key must mean one place, got 'length', which fits slider.length, track.length"),
        ({"frction": 1}, "key must be one of the scenario's, got 'frction'; did you mean 'friction'?"),
        ({"drives.3.x": 1}, "got 'drives.3.x'; did you mean 'drives.0.x'?"),
        ({"contact": 1}, "set one of its keys at, friction, gap, point"),
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
def test_a_change_that_cannot_be_says_why(overrides, message):
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario("squeal", overrides)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_step_above_the_limit_names_its_key():
    with pytest.raises(st.ScenarioError, match=r"^simulation\.step must be below .* limit of .*, got 0.001$"):
        st.load_scenario("squeal", {"step": 1e-3}).simulate()


def test_every_problem_of_a_file_is_told(tmp_path):
    found = problems(
        'base = "squeal"\n[slider]\nlenght = 3\nangle = nan\n[material]\nyoung = -1\n[[drives]]\nkind = "forc"\n'
        '[[drives]]\nkind = "force"\naxial = "x {y}"\n[simulation]\nprobes = [{quantity = "speed"}]\n',
        tmp_path,
    )
    assert sorted(found) == [
        "drives.0.kind must be one of force, imposed velocity, gravity, initial velocity, got 'forc'; "
        "did you mean 'force'?",
        "drives.1.axial must be a number in N, mN or kN, got 'x {y}'",
        "material.young must be above 0, got -1",
        "simulation.probes.0.quantity must be one of displacement, velocity, acceleration, reaction, got 'speed'",
        "slider.angle must be finite, got nan",
        "slider.lenght must be one of the known keys material, section, length, angle, elements, damping, "
        "root_support, tip_support, mass, cutoff, got lenght = 3; did you mean 'length'?",
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "scenario must not be empty"),
        ("# nothing\n", "scenario must not be empty"),
        ("a = 1\nb = ]\n", "line 2"),
        ("a = [\n", "line 1"),
        ("a = " + "[" * 5000, "must be TOML"),
        ('base = "sqeal"', "did you mean 'squeal'?"),
        ("base = 3", "base must be a scenario file"),
        ("slider = 3", "slider must be a table, got 3"),
        ("drives = 3", "drives must be a list, got 3"),
        ('base = "squeal"\ntitle = 3', "title must be a text, got 3"),
        ('base = "squeal"\nlength = 3', "did you mean 'track.length'?"),
        ('base = "squeal"\n[[drives]]\nx = 1', "drives.0.kind must be given"),
        ('base = "squeal"\n[[drives]]\nkind = "force"\npoint = "centre"', "drives.0.point must be tip or root or"),
        ('base = "squeal"\n[[drives]]\nkind = "force"\npoint = 9', "drives.0.point must be from 0 to "),
        (
            'base = "squeal"\n[[drives]]\nkind = "force"\nhistory = {kind = "sampled", time = [1, 0], value = [1, 1]}',
            "drives.0.history.time must rise",
        ),
        (
            'base = "weak-pressure"\n[slider]\nroot_support = "pinned"',
            "slider.root_support must be guided or free under an imposed velocity",
        ),
        ("[contact]\nat = 1\n", "slider must be given"),
    ],
)
def test_a_bad_file_says_what_is_wrong(text, message, tmp_path):
    assert any(message in problem for problem in problems(text, tmp_path))


def test_what_is_no_scenario_file_is_refused(tmp_path):
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00\x81")
    (tmp_path / "cut.nc").write_bytes(b"\x89HDF\r\n\x1a\nrest")
    for name, message in [
        ("binary.toml", "text file in UTF-8"),
        ("cut.nc", "damaged"),
        ("", "a directory"),
        ("none.toml", "must be a file or one of"),
    ]:
        with pytest.raises(ValueError, match=message):
            st.load_scenario(tmp_path / name)
    with pytest.raises(st.ScenarioError, match="did you mean 'squeal'"):
        st.load_scenario("sqeal")


def test_the_schema_knows_every_key_and_forbids_others():
    schema = st.scenario_schema()
    assert "required" not in str(schema)
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
