"""Scenario files: units, bases, keys, messages, and the round trip with records."""

from __future__ import annotations

import dataclasses
import math
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
import scipy.io
import scipy.sparse
import xarray as xr
from hypothesis import given
from hypothesis import strategies as some

import stridula as st
from stridula.records.packed import packed, unpacked
from stridula.records.provenance import scenario_toml, toml
from stridula.scenarios.quantities import quantity

CASES = ["axial-sliding", "judder", "squeal", "stable-sliding", "strong-pressure", "weak-pressure"]
MASSES = ["belt", "lugre"]
PLATES = ["judder-on-plate", "squeal-on-plate"]
MESHED = ["brake", "glass", "pad-on-disc", "pin-on-disc", "wheel"]
STRINGS = ["violin"]
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
def test_what_is_shown_loads_as_the_same_scenario(name, tmp_path):
    path = tmp_path / "copy.toml"
    path.write_text(st.scenario_text(name), encoding="utf-8")
    assert "base =" not in path.read_text(encoding="utf-8")
    assert st.load_scenario(path) == st.load_scenario(name)


@pytest.mark.parametrize("name", CASES + MASSES + PLATES)
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


def test_a_string_survives_provenance(tmp_path):
    system = make()
    string = dataclasses.replace(system.track, tension=250.0)
    stretched = st.System(dataclasses.replace(system.contacts[0], track=string))
    probes = (st.SupportForce(string), st.SupportForce(string, "right"))
    again = reloaded(stretched, probes, tmp_path)
    assert again.probes == probes
    assert again.system == stretched
    assert again.system.track.tension == 250.0


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


STARTS = [
    st.InitialEquilibrium(),
    st.InitialEquilibrium(status="sliding", velocity=-0.1),
    st.InitialEquilibrium(mode=np.int64(4), amplitude=1e-6, phase=0.3),
    st.InitialEquilibrium(status=["sliding"], velocity=[0.2], mode="most unstable", amplitude=np.float32(0.5)),
]


@pytest.mark.parametrize("start", STARTS)
def test_every_initial_equilibrium_survives_provenance(start, tmp_path):
    system = make(drives=lambda slider, track: [st.Gravity(), start])
    scenario = reloaded(system, (), tmp_path)
    assert scenario.system == system
    (tmp_path / "shown.toml").write_text(st.scenario_text(tmp_path / "provenance.toml"), encoding="utf-8")
    assert st.load_scenario(tmp_path / "shown.toml").system == system


def test_an_initial_equilibrium_is_changed_by_key(tmp_path):
    path = tmp_path / "start.toml"
    path.write_text(
        MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nmode = 0\namplitude = "2 um"\n', encoding="utf-8"
    )
    changes = {
        "mode": "most unstable",
        "amplitude": "3 mm",
        "drives.0.velocity": "-5 cm/s",
        "drives.0.status": "sliding",
    }
    (start,) = st.load_scenario(path, changes).system.drives
    assert start == st.InitialEquilibrium("sliding", -0.05, "most unstable", 0.003)
    assert st.load_scenario(path).system.initial_equilibrium == st.InitialEquilibrium(mode=0, amplitude=2e-6)


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
        ({"contact": 1}, "set one of its keys at, friction, gap, stiffness, point, name"),
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


def test_unknown_keys_and_bad_values_are_told_at_once():
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario("squeal", {"foo": 1, "slider.mass": "lump", "friction": "3 m"})
    found = caught.value.problems
    assert len(found) == 3
    for words in ("got 'foo'", "slider.mass must be one of", "contact.friction.coefficient must be"):
        assert any(words in problem for problem in found)


BELT = """
[bodies.m]
kind = "point mass"
mass = 1.0
[[contacts]]
name = "guide"
tip = {body = "m"}
track = {kind = "rigid"}
[[contacts]]
name = "leading"
tip = {body = "m"}
track = {kind = "rigid", velocity = 0.1}
friction = 0.3
[[connections]]
kind = "spring"
first = {body = "m"}
stiffness = 100.0
[simulation]
duration = 0.01
"""


@pytest.mark.parametrize(
    ("key", "nearest"),
    [
        ("leading.velocity", "contacts.1.track.velocity"),
        ("guide.velocty", "contacts.0.track.velocity"),
        ("leading.coefficient", "contacts.1.friction.coefficient"),
        ("leading.xyz", "contacts.1"),
    ],
)
def test_the_name_of_a_contact_leads_to_its_keys(key, nearest, tmp_path):
    (found,) = problems(BELT, tmp_path, {key: 1.0})
    assert found == f"key must be one of the scenario's, got {key!r}; did you mean {nearest!r}?"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"bodies.m.mass": 1e-320}, "bodies.m.mass must be at least 1e-100, got 1e-320"),
        ({"bodies.m.mass": 1e-90, "stiffness": 1e250}, "scenario must hold numbers of ordinary size"),
    ],
)
@pytest.mark.filterwarnings("ignore:.*encountered in:RuntimeWarning")
def test_numbers_out_of_range_are_named(changes, message, tmp_path):
    (tmp_path / "case.toml").write_text(BELT)
    with pytest.raises(st.ScenarioError, match=message) as caught:
        st.load_scenario(tmp_path / "case.toml", changes).simulate()
    assert "infs" not in str(caught.value)


def test_bodies_out_of_range_are_named(tmp_path):
    reduced = 'kind = "reduced"\nmass = [[1e-300]]\nstiffness = [[1e10]]\npoints = {a = {x = 0}}'
    text = BELT.replace('kind = "point mass"\nmass = 1.0', reduced)
    (found,) = problems(text, tmp_path)
    assert found.startswith("bodies.m.stiffness must be of a size that mass can carry, got up to 1e+10 N/m on masses")
    with pytest.raises(st.ScenarioError, match=r"must hold numbers of ordinary size: its modes overflow"):
        st.load_scenario("squeal", {"density": 1e-320})


def test_a_record_is_a_scenario():
    run = st.load_scenario("squeal", {"duration": "1 ms"}).simulate()
    again = st.load_scenario(run)
    assert (again.system, again.duration) == (st.load_scenario("squeal").system, 0.001)
    xr.testing.assert_identical(again.simulate().drop_attrs(deep=False), run.drop_attrs(deep=False))
    assert again.title == run.attrs["title"]
    assert st.load_scenario(run, {"duration": "2 ms"}).duration == 0.002
    assert st.scenario_text(run).startswith("title")


@pytest.mark.parametrize("given", [3, None, b"squeal", ["squeal"], {"title": "x"}, xr.Dataset()])
def test_what_is_no_name_no_path_and_no_record_is_refused(given):
    with pytest.raises(st.ScenarioError, match=r"^scenario must be a ") as caught:
        st.load_scenario(given)
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
        "drives.0.kind must be one of force, imposed velocity, gravity, initial velocity, initial state, "
        "initial equilibrium, "
        "got 'forc'; "
        "did you mean 'force'?",
        "drives.1.axial must be a number in N, mN or kN, got 'x {y}'",
        "material.young must be above 0, got -1",
        "simulation.probes.0.quantity must be one of displacement, velocity, acceleration, reaction, support_force, "
        "modal_displacement, modal_velocity, "
        "got 'speed'",
        "slider.angle must be finite, got nan",
        "slider.lenght must be one of the known keys material, section, length, angle, elements, damping, "
        "root_support, tip_support, mass, cutoff, name, got lenght = 3; did you mean 'length'?",
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


@pytest.mark.parametrize(
    "text", ["[" + ".".join("a" * 20_000) + "]\n", "a = " + "[" * 20_000, "a" + ".a" * 60 + " = 1\n"]
)
def test_tables_nested_thousands_deep_are_refused_in_one_line(text, tmp_path):
    (problem,) = problems(text, tmp_path)
    assert problem.startswith("scenario must ")
    assert len(problem) < 300


def test_what_is_no_scenario_file_is_refused(tmp_path):
    (tmp_path / "binary.toml").write_bytes(b"\xff\x00\x80")
    (tmp_path / "cut.nc").write_bytes(b"\x89HDF\r\n\x1a\nrest")
    for name, message in [
        ("binary.toml", "text in UTF-8"),
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


LAWS = [
    st.Coulomb(0.3),
    st.StaticKinetic(0.4, 0.25),
    st.Stribeck(0.5, 0.3, 0.01, exponent=1.5, viscous=0.2),
    st.ExponentialWeakening(0.5, 0.3, 0.01),
    st.LinearWeakening(0.5, 2.0, kinetic=0.1),
    st.LuGre(0.5, 0.3, 1e-3, stiffness=1e5, damping=3.0, viscous=0.4),
    st.RateAndState(0.6, 0.01, 0.015, 1e-5, 1e-6, evolution="slip", initial_state=3.0),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_every_law_survives_provenance(law, tmp_path):
    system = make()
    pair = st.System(dataclasses.replace(system.contact, friction=law, name="tip on track"))
    assert reloaded(pair, (), tmp_path).system == pair
    mass = st.PointMass(0.3)
    alone = st.System(st.PointContact(mass.centre, st.RigidTrack(velocity=0.2), friction=law))
    assert reloaded(alone, (), tmp_path).system == alone


def chain(size: int, **options) -> st.ReducedBody:
    """Return a chain of equal masses on springs, along x and y, its last one the tip."""
    line = 2.1e5 * np.eye(size) - 1e5 * (np.eye(size, k=1) + np.eye(size, k=-1))
    stiffness = np.kron(line, np.diag([1.0, 1.7]))
    points = {
        "tip": (2 * size - 2, 2 * size - 1),
        "20 mm": np.full((2, 2 * size), 1.0 / 3.0),
        "x only": (0, None),
        "y half": [[0.0] * 2 * size, [0.0, 0.5] + [0.0] * (2 * size - 2)],
    }
    return st.ReducedBody(np.eye(2 * size) * 0.1, stiffness, **{"points": points} | options)


def alternating(size: int) -> np.ndarray:
    return np.kron(np.ones(size), np.eye(2))


REDUCED = {
    "ratio": chain(2, damping=0.01),
    "ratios": chain(2, damping=[0.01, 0.02, 0.03, 0.04], name="pad"),
    "shares": chain(2, damping=st.Rayleigh(2.0, 1e-6), name='a "b".c'),
    "matrix": chain(2, damping=np.eye(4) * 0.7, translation=alternating(2), cutoff=300.0),
    "large": chain(20, damping=np.diag(np.linspace(0.1, 1.0, 40)), translation=alternating(20), name="slider"),
}


@pytest.mark.parametrize("body", REDUCED.values(), ids=REDUCED)
def test_every_reduced_body_survives_provenance(body, tmp_path):
    size = body.mass.shape[0]
    start = st.InitialState(body, displacement=np.linspace(0.0, 1e-6, size), velocity=np.full(size, 1 / 3))
    system = st.System(
        [
            st.PointContact(body.at("tip"), st.RigidTrack(), gap=1e-6, friction=st.Coulomb(0.3)),
            st.PointContact(body.at("20 mm"), st.RigidTrack(velocity=-0.1, name="belt"), inclination=0.5),
        ],
        [st.Force(body.at("x only"), x=1.0), start],
    )
    probes = (st.Velocity(body.at("20 mm"), "x"),)
    again = reloaded(system, probes, tmp_path)
    assert again.system == system
    assert again.probes == probes
    assert again.system.slider.damping is not None


def general() -> tuple[st.System, tuple[object, ...]]:
    """Return a system with all that a pair of beams has not, and its probes."""
    section = st.Circle(0.01)
    rod = st.FiniteElementBeam(STEEL, section, 0.3, angle=0.3, elements=3, cutoff=8e3, root_support="free")
    plate = st.ModalBeam(STEEL, section, 0.8, bending_modes=5, axial_modes=2, name="plate")
    block, other, far = st.PointMass(0.2, name="track"), st.PointMass(0.2), chain(1)
    belt = st.RigidTrack(
        velocity=0.1,
        normal_velocity=0.01,
        history=st.Ramp(0.1),
        normal_history=st.Harmonic(50.0),
        name="belt",
        normal_acceleration=0.3,
    )
    contacts = [
        st.PointContact(rod.tip, plate, at=0.3, gap=1e-6, friction=st.Coulomb(0.4), name="rod on plate"),
        st.PointContact(block.centre, belt, at=-2.0, inclination=np.float64(0.1), friction=LAWS[5]),
        st.PointContact(other.centre, st.BodyPoint(plate, 0.4), gap=2e-6, inclination=np.pi, friction=LAWS[6]),
        st.PointContact(rod.at(0.1), block.centre, gap=1.0),
    ]
    drives = [
        st.ImposedVelocity(rod.root, 0.01, normal_load=20.0),
        st.InitialVelocity(block, x=0.05),
        st.InitialState(other, velocity=(0.0, 0.01)),
        st.Force(far.at("tip"), y=3.0, history=st.Sampled((0.0, 0.1, 0.1), (1.0, 2.0, 0.0))),
    ]
    connections = [
        st.Spring(block.centre, rod.at(0.2), stiffness=5e3, direction="y"),
        st.Spring(other.centre, stiffness=2e3),
        st.Dashpot(other.centre, plate.at(0.1), coefficient=3.0, direction="y"),
        st.Dashpot(far.at("tip"), coefficient=4.0),
    ]
    probes = (
        st.Acceleration(plate.centre),
        st.Displacement(rod.at(0.1), "transverse"),
        st.Velocity(block.centre, "x"),
        st.Velocity(far.at("tip")),
    )
    return st.System(contacts, drives, connections), probes


def test_a_record_of_many_bodies_runs_again_bit_by_bit(tmp_path):
    system, probes = general()
    options = {"probes": probes, "contact_solve": st.GaussSeidel(tolerance=1e-9, sweeps=500), "sample_rate": 2e4}
    record = st.simulate(system, 2e-3, title="all", **options)
    assert 'name = ""' not in record.attrs["scenario"]
    st.save(record, tmp_path / "run.nc")
    again = st.load_scenario(tmp_path / "run.nc")
    assert again.contact_solve == options["contact_solve"]
    assert again.system.bodies == system.bodies
    assert again.system.contacts == system.contacts
    assert again.probes == probes
    repeated = again.simulate()
    assert repeated.attrs["scenario"] == record.attrs["scenario"]
    xr.testing.assert_equal(repeated.drop_attrs(), record.drop_attrs())


def test_a_record_of_many_bodies_is_shown_as_the_same_scenario_and_gone_on_from(tmp_path):
    system, probes = general()
    record = st.simulate(system, 1e-3, probes=probes)
    st.save(record, tmp_path / "run.nc")
    (tmp_path / "shown.toml").write_text(st.scenario_text(tmp_path / "run.nc"), encoding="utf-8")
    shown = st.load_scenario(tmp_path / "shown.toml")
    assert shown == st.load_scenario(tmp_path / "run.nc")
    onwards = shown.simulate(duration=1e-3, start=record)
    assert onwards["time"].values[0] > record["time"].values[-1]
    other = st.load_scenario(tmp_path / "run.nc", {"contacts.1.friction.law": "coulomb", "contacts.1.friction": 0.3})
    with pytest.raises(ValueError, match="same contacts"):
        other.simulate(start=record)


SHAKEN = """
[bodies.block]
kind = "point mass"
mass = "2 kg"
[[contacts]]
tip = { body = "block" }
[contacts.track]
kind = "rigid"
velocity = "5 cm/s"
acceleration = "1.5 m/s2"
normal_acceleration = -2
history = { kind = "sampled", time = ["0 s", "10 ms", "10 ms"], value = [0, 1, 0] }
normal_history = { kind = "sampled", time = [0, 0.01, 0.02], value = [0, 1, 0] }
[[drives]]
kind = "gravity"
[simulation]
duration = "30 ms"
sample_rate = "10 kHz"
"""


def test_a_ground_of_an_accelerogram_and_back_again(tmp_path):
    path = tmp_path / "shaken.toml"
    path.write_text(SHAKEN, encoding="utf-8")
    case = st.load_scenario(path)
    track = case.system.contacts[0].track
    assert track == st.RigidTrack(
        velocity=0.05,
        acceleration=1.5,
        normal_acceleration=-2.0,
        history=st.Sampled((0.0, 0.01, 0.01), (0.0, 1.0, 0.0)),
        normal_history=st.Sampled((0.0, 0.01, 0.02), (0.0, 1.0, 0.0)),
    )
    # 5 cm/s and half of 1.5 m/s² for 10 ms.
    assert track.speed(np.array([0.03])) == pytest.approx(0.0575)
    record = case.simulate()
    again = st.load_scenario(record)
    assert again.system == case.system
    xr.testing.assert_equal(again.simulate().drop_attrs(), record.drop_attrs())
    shown = st.scenario_text(record)
    assert re.search(r"normal_acceleration = -2.0 +# acceleration along its normal, .* shaken ground \[m/s²\]", shown)
    assert "time = [0.0, 0.01, 0.01]" in shown
    found = problems(SHAKEN.replace('"10 ms", "10 ms"', '"10 ms", "9 ms"').replace("-2", '"2 m/s"'), tmp_path)
    assert len(found) == 1
    assert found[0].startswith("contacts.0.track.normal_acceleration must be a number in m/s2, got '2 m/s'")
    (found,) = problems(SHAKEN.replace('"10 ms", "10 ms"', '"10 ms", "9 ms"'), tmp_path)
    assert found.startswith("contacts.0.track.history.time must rise, got (0.0, 0.01, 0.009)")


def test_matrices_written_out_are_the_same_as_their_file(tmp_path):
    body = chain(3, damping=0.01, name="pad")
    body.save(tmp_path / "pad.npz")
    rest = '[[contacts]]\ntip = {body = "pad", point = "tip"}\ntrack = {kind = "rigid"}\n[simulation]\nduration = 1.0\n'
    (tmp_path / "file.toml").write_text(f'[bodies.pad]\nkind = "reduced"\nfile = "pad.npz"\n{rest}')
    # Rows in full, as one would write them by hand.
    rows = {name: getattr(body, name).tolist() for name in ("mass", "stiffness")}
    points = "\n".join(f'"{name}" = {value.tolist()}' for name, value in body.points.items())
    (tmp_path / "rows.toml").write_text(
        f'[bodies.pad]\nkind = "reduced"\ndamping = "1 %"\nmass = {rows["mass"]}\nstiffness = {rows["stiffness"]}\n'
        f"[bodies.pad.points]\n{points}\n{rest}"
    )
    for name in ("mass", "stiffness"):
        scipy.io.mmwrite(tmp_path / f"{name}.mtx", scipy.sparse.coo_array(getattr(body, name)), precision=17)
    (tmp_path / "files.toml").write_text(
        '[bodies.pad]\nkind = "reduced"\ndamping = 0.01\nmass = "mass.mtx"\nstiffness = "stiffness.mtx"\n'
        f"[bodies.pad.points]\n{points}\n{rest}"
    )
    systems = [st.load_scenario(tmp_path / f"{name}.toml").system for name in ("file", "rows", "files")]
    assert systems[0] == systems[1] == systems[2]
    assert systems[0].slider == body


def test_files_are_found_from_the_file_that_names_them(tmp_path):
    (tmp_path / "sub").mkdir()
    chain(2, name="pad").save(tmp_path / "sub" / "pad.npz")
    (tmp_path / "sub" / "base.toml").write_text(
        '[bodies.pad]\nkind = "reduced"\nfile = "pad.npz"\n[[contacts]]\ntip = {body = "pad", point = "tip"}\n'
        'track = {kind = "rigid"}\n[simulation]\nduration = 1.0\n'
    )
    (tmp_path / "case.toml").write_text('base = "sub/base.toml"\n[bodies.pad]\ncutoff = "1 kHz"\n')
    assert st.load_scenario(tmp_path / "case.toml").system.slider.cutoff == 1e3


def test_equal_bodies_are_told_apart_by_their_names_in_the_file(tmp_path):
    (tmp_path / "case.toml").write_text(
        '[bodies]\nslider = {kind = "point mass", mass = 1}\ntrack = {kind = "point mass", mass = 1}\n'
        '[[contacts]]\ntip = {body = "slider"}\ntrack = {kind = "point", body = "track"}\n'
        "[simulation]\nduration = 1.0\n"
    )
    system = st.load_scenario(tmp_path / "case.toml").system
    assert [body.name for body in system.bodies] == ["slider", "track"]
    assert reloaded(system, (), tmp_path).system == system


TWO = """
density = 3
[bodies.a]
kind = "point mass"
mass = "3 m"
[bodies.b]
kind = "reduced"
mass = [[1, 2], [3]]
points = 3
[bodies.c]
kind = "mass"
[[contacts]]
tip = {body = "a", pint = "centre"}
track = {kind = "belt"}
friction = {law = "stribek"}
[[connections]]
kind = "spring"
first = {body = "a"}
[simulation]
duration = 1
contact_solve = {sweeps = 0}
"""


def test_every_problem_of_bodies_and_contacts_is_told(tmp_path):
    found = "\n".join(problems(TWO, tmp_path))
    for words in (
        "density must be one of the known keys",
        "bodies.a.mass must be a number in kg, g or t, got '3 m'",
        "bodies.b.mass must be a matrix, a list of rows of numbers or a file, got [[1, 2], [3]]",
        "bodies.b.points must be a table of points by name, got 3",
        "bodies.c.kind must be one of finite-element beam, modal beam, modal plate, point mass, reduced, rigid body, "
        "modal body, axisymmetric, solid, got 'mass'",
        "contacts.0.tip.pint must be one of the known keys body, point, got pint = 'centre'; did you mean 'point'?",
        "contacts.0.track.kind must be one of beam, plate, rigid, point, circle, got 'belt'",
        "contacts.0.friction.law must be one of coulomb, static-kinetic, stribeck",
        "did you mean 'stribeck'?",
        "connections.0.stiffness must be given: stiffness [N/m]",
        "simulation.contact_solve.sweeps must be at least 1, got 0",
    ):
        assert words in found


MASS_ON_FLOOR = (
    '[bodies.a]\nkind = "point mass"\nmass = 1\n[[contacts]]\ntip = {body = "a"}\ntrack = {kind = "rigid"}\n'
    "[simulation]\nduration = 1\n"
)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('base = "squeal"\n' + MASS_ON_FLOOR, "slider must be left out where there are bodies and contacts, got both"),
        ("[[contacts]]\ntip = 3\n", "bodies must be given: what vibrates, by name"),
        ("contacts = []\nbodies = {}\n" + "[simulation]\nduration = 1\n", "contacts must not be empty, got []"),
        ("cutoff = 3\n" + MASS_ON_FLOOR, "cutoff must stand in a body"),
        (
            MASS_ON_FLOOR + '[bodies.b]\nkind = "point mass"\nmass = 1\n',
            "bodies.b must be in a contact or a connection",
        ),
        (MASS_ON_FLOOR.replace('body = "a"', 'body = "b"'), "contacts.0.tip.body must be one of a, got 'b'"),
        (MASS_ON_FLOOR.replace('"rigid"', '"beam", body = "a"'), "contacts.0.track.body must be a modal beam, got 'a'"),
        (MASS_ON_FLOOR + '[[drives]]\nkind = "imposed velocity"\nvelocity = 1\n', "must be a finite-element beam"),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial state"\nvelocity = [1]\n',
            "drives.0.velocity must be two finite",
        ),
        (MASS_ON_FLOOR + '[[drives]]\nkind = "force"\nbody = "b"\n', "drives.0.body must be one of "),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nmode = "fast"\n',
            "drives.0.mode must be a whole number from 0 on or most unstable, got 'fast'",
        ),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nmode = -1\n',
            "drives.0.mode must be a whole number from 0 on or most unstable, got -1",
        ),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nstatus = ["sliding", "stuck"]\n',
            "drives.0.status must be one of separated, sticking, sliding or a list of them",
        ),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\nvelocity = "fast"\n',
            "drives.0.velocity must be a number in m/s",
        ),
        (
            MASS_ON_FLOOR + '[[drives]]\nkind = "initial equilibrium"\namplitude = 1e-6\n',
            "drives.0.amplitude must be 0 without a mode that has it, got 1e-06",
        ),
        (MASS_ON_FLOOR + '[[simulation.probes]]\nquantity = "velocity"\nbody = "b"\n', "probes.0.body must be one of "),
    ],
)
def test_a_bad_file_of_bodies_says_what_is_wrong(text, message, tmp_path):
    assert any(message in problem for problem in problems(text, tmp_path))


def test_a_damaged_packed_matrix_is_told(tmp_path):
    text = MASS_ON_FLOOR.replace("mass = 1", 'stiffness = [[1]]\npoints = {p = {x = 0}}\nmass = "float64 1x1 eJx"')
    found = problems(text.replace("point mass", "reduced"), tmp_path)
    assert found == ("bodies.a.mass must be a whole packed array, as records have them, got 'float64 1x1 eJx'",)


@given(some.integers(0, 3), some.integers(0, 4), some.integers(0, 2**32 - 1))
def test_packed_arrays_come_back_bit_by_bit(rows, columns, seed):
    array = np.random.default_rng(seed).standard_normal((rows, columns)) * 1e-300
    np.testing.assert_array_equal(unpacked(packed(array)), array)


def test_keys_reach_bodies_and_contacts():
    belt = st.load_scenario("belt", {"block.mass": "2 kg", "kinetic": 0.3, "connections.0.stiffness": "5 N/m"}).system
    assert (belt.slider.mass, belt.contact.friction.kinetic, belt.connections[0].stiffness) == (2.0, 0.3, 5.0)
    other = st.load_scenario("belt", {"friction.law": "coulomb", "coefficient": 0.3}).system
    assert other.contact.friction == st.Coulomb(0.3)
    with pytest.raises(st.ScenarioError, match="got 'cutoff'"):
        st.load_scenario("belt", {"cutoff": 1e3})


def test_the_belt_sticks_and_slips_as_the_closed_form_says():
    run = st.load_scenario("belt").simulate()
    sliding = run["status"].values == 2
    left = run["time"].values[1:][np.diff(sliding.astype(int)) == 1]
    reach, angular = 0.15 * 10.0 / 4.0, 2.0
    period = 2.0 / angular * (math.pi - math.atan(reach * angular / 0.5)) + 2.0 * reach / 0.5
    np.testing.assert_allclose(np.diff(left), period, atol=4e-3)


def test_the_pull_test_peaks_just_below_the_static_limit():
    run = st.load_scenario("lugre").simulate()
    force = run["tangential_force"].values
    assert 1.45 < force.max() < 1.5
    assert force[run["time"].values > 12.0].min() > 0.6


PLATE = """
damping = "1 %"
cutoff = "2 kHz"
material = {young = "210 GPa", density = 7800, poisson = 0.28}
section = {shape = "circle", diameter = "5 mm"}
[bodies.rod]
kind = "finite-element beam"
length = 0.3
[bodies.sheet]
kind = "modal plate"
thickness = "1 mm"
length = "30 cm"
width = "20 cm"
bending_modes = [5, 4]
line = {origin = ["5 cm", 0.04], direction = "30 deg"}
[[contacts]]
tip = {body = "rod"}
track = {kind = "plate", body = "sheet"}
at = "10 cm"
friction = 0.5
[[drives]]
kind = "force"
body = "sheet"
point = ["20 cm", 0.1]
y = 1.0
[[simulation.probes]]
quantity = "velocity"
body = "sheet"
point = "centre"
[[simulation.probes]]
quantity = "velocity"
body = "sheet"
point = 0.05
[simulation]
duration = "1 ms"
"""


def test_a_plate_takes_what_stands_at_the_top_and_survives_provenance(tmp_path):
    (tmp_path / "plate.toml").write_text(PLATE, encoding="utf-8")
    case = st.load_scenario(tmp_path / "plate.toml")
    steel, line = st.Material(2.1e11, 7800.0, 0.28), st.Line((0.05, 0.04), math.radians(30.0))
    sheet = st.ModalPlate(steel, 0.001, 0.3, 0.2, (5, 4), 0.01, 2e3, line, "sheet")
    assert case.system.track == sheet
    assert case.system.drives[0].point == sheet.at((0.2, 0.1))
    assert case.probes == (st.Velocity(sheet.centre), st.Velocity(sheet.at(0.05)))
    record = case.simulate()
    again = st.load_scenario(record)
    assert (again.system, again.probes) == (case.system, case.probes)
    assert again.simulate().attrs["scenario"] == record.attrs["scenario"]
    turned = st.load_scenario(tmp_path / "plate.toml", {"direction": "60 deg", "poisson": 0.3}).system.track
    assert turned.line.direction == math.radians(60.0)
    assert turned.material.poisson == 0.3


def test_a_plate_moves_in_its_plane_where_its_table_says_so(tmp_path):
    flat = PLATE.replace("bending_modes = [5, 4]", "bending_modes = [5, 4]\nin_plane = true\nin_plane_modes = [2, 0]")
    (tmp_path / "plate.toml").write_text(flat.replace("cutoff", "# cutoff"), encoding="utf-8")
    case = st.load_scenario(tmp_path / "plate.toml")
    assert case.system.track.in_plane
    assert case.system.track.harmonics == (20, 2)
    record = case.simulate()
    again = st.load_scenario(record)
    assert (again.system, again.probes) == (case.system, case.probes)
    assert again.simulate().attrs["scenario"] == record.attrs["scenario"]
    rigid = st.load_scenario(tmp_path / "plate.toml", {"in_plane": False}).system.track
    assert rigid.harmonics == (20, 0)
    with pytest.raises(
        ValueError, match=r"in_plane_modes must be two whole numbers.* each of which must be at least 0"
    ):
        st.load_scenario(tmp_path / "plate.toml", {"in_plane_modes": [2, -1]})
    with pytest.raises(ValueError, match=r"in_plane_modes must be two whole numbers of at least 0.* not both 0"):
        st.load_scenario(tmp_path / "plate.toml", {"in_plane_modes": [0, 0]})
    with pytest.raises(ValueError, match="cutoff must leave at least one mode in the plane"):
        st.load_scenario(tmp_path / "plate.toml", {"cutoff": "2 kHz"})


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("[5, 4]", "5", "bodies.sheet.bending_modes must be two whole numbers, along length and width, got 5"),
        ("[5, 4]", "[5, 0]", "along length and width, each of which must be at least 1, got [5, 0]"),
        ('["5 cm", 0.04]', '["5 kg", 0.04]', "bodies.sheet.line.origin must be two distances"),
        (
            '["5 cm", 0.04]',
            "[0.5, 0.04]",
            "bodies.sheet.line must have its origin on the plate, got Line(origin=(0.5, 0.04)",
        ),
        (
            '["20 cm", 0.1]',
            "[0.2, 0.3]",
            "drives.0.point must be on the plate, from (0, 0) to (0.3, 0.2), got (0.2, 0.3)",
        ),
        ('"30 deg"', "7", "bodies.sheet.line.direction must be from -2 pi to 2 pi rad, got 7"),
        ("point = 0.05", "point = 2", "simulation.probes.1.point must be from"),
        ('point = "centre"', 'point = "tip"', "simulation.probes.0.point must be centre or a position"),
        ('kind = "plate"', 'kind = "beam"', "contacts.0.track.body must be a modal beam, got 'sheet'"),
        ("poisson = 0.28", "poisson = 0.7", "poisson must be below 0.5, got 0.7"),
        ("thickness", 'section = {shape = "circle", diameter = 1}\nthickness', "must be one of the known keys"),
        ("2 kHz", "20 Hz", "cutoff must leave at least one mode (first at"),
    ],
)
def test_a_bad_plate_says_what_is_wrong(old, new, message, tmp_path):
    assert old in PLATE
    assert message in "\n".join(problems(PLATE.replace(old, new), tmp_path))


def test_records_without_poisson_load_as_before(tmp_path):
    record = st.simulate(st.load_scenario("squeal").system, 1e-4)
    old = "\n".join(line for line in record.attrs["scenario"].split("\n") if not line.startswith("poisson"))
    assert old != record.attrs["scenario"]
    (tmp_path / "old.toml").write_text(old, encoding="utf-8")
    assert st.load_scenario(tmp_path / "old.toml").system == st.load_scenario("squeal").system


TWO_CONTACTS = """
friction = 0.3
[bodies.m]
kind = "point mass"
mass = 1.0
[[contacts]]
tip = {body = "m"}
track = {kind = "rigid", velocity = 0.1}
[[contacts]]
tip = {body = "m"}
track = {kind = "rigid", velocity = 0.2}
gap = "1 mm"
[simulation]
duration = 0.01
"""


def frictions(path, **overrides) -> list[object]:
    return [contact.friction for contact in st.load_scenario(path, overrides).system.contacts]


def test_a_friction_at_the_top_is_that_of_every_contact_without_its_own(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(TWO_CONTACTS)
    assert frictions(path) == [st.Coulomb(0.3)] * 2
    own = TWO_CONTACTS.replace('gap = "1 mm"', 'friction = {law = "static-kinetic", static = 0.5, kinetic = 0.4}')
    path.write_text(own)
    assert frictions(path) == [st.Coulomb(0.3), st.StaticKinetic(0.5, 0.4)]
    # A part of a law is that of the top with what is its own; a bare number is a law of its own.
    stribeck = TWO_CONTACTS.replace(
        "friction = 0.3", 'friction = {law = "stribeck", static = 0.5, kinetic = 0.3, velocity = 0.1}'
    )
    path.write_text(stribeck.replace('gap = "1 mm"', "friction = {kinetic = 0.2}"))
    assert frictions(path) == [st.Stribeck(0.5, 0.3, 0.1), st.Stribeck(0.5, 0.2, 0.1)]
    path.write_text(stribeck.replace('gap = "1 mm"', "friction = 0"))
    assert frictions(path) == [st.Stribeck(0.5, 0.3, 0.1), st.Coulomb(0.0)]


def test_a_friction_set_at_the_top_is_that_of_all_contacts(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(TWO_CONTACTS.replace('gap = "1 mm"', "friction = 0.1"))
    assert frictions(path) == [st.Coulomb(0.3), st.Coulomb(0.1)]
    assert frictions(path, friction=0.7) == [st.Coulomb(0.7)] * 2
    law = {"friction.law": "static-kinetic", "friction.static": 0.6, "friction.kinetic": 0.2}
    path.write_text(TWO_CONTACTS)
    assert frictions(path, **law) == [st.StaticKinetic(0.6, 0.2)] * 2
    assert frictions(path, **{"contacts.1.friction.coefficient": 0.9}) == [st.Coulomb(0.3), st.Coulomb(0.9)]
    (found,) = problems(TWO_CONTACTS.replace("friction = 0.3", 'friction = "x"'), tmp_path)
    assert found == "friction.coefficient must be a number, got 'x'"
    # Without one at the top it must be said which contact is meant.
    (found,) = problems(TWO_CONTACTS.replace("friction = 0.3", ""), tmp_path, {"coefficient": 0.5})
    assert "contacts.0.friction.coefficient" in found
    assert "contacts.1.friction.coefficient" in found


def test_a_pair_takes_the_friction_at_the_top(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text('base = "squeal"\nfriction = {law = "static-kinetic", static = 0.5, kinetic = 0.4}\n')
    assert st.load_scenario(path).system.contact.friction == st.load_scenario("squeal").system.contact.friction


def test_entries_of_a_list_are_keys_where_it_is_short(tmp_path):
    path = tmp_path / "shaken.toml"
    path.write_text(SHAKEN, encoding="utf-8")
    history = st.load_scenario(path, {"track.history.value.1": 0.5}).system.contact.track.history
    assert history.value == (0.0, 0.5, 0.0)
    with pytest.raises(st.ScenarioError, match=r"must mean one place, got 'value\.1'"):
        st.load_scenario(path, {"value.1": 0.5})
    times = ", ".join(str(0.01 * k) for k in range(65))
    path.write_text(SHAKEN.replace("time = [0, 0.01, 0.02], value = [0, 1, 0]", f"time = [{times}], value = [{times}]"))
    with pytest.raises(st.ScenarioError, match="key must be one of the scenario's"):
        st.load_scenario(path, {"track.normal_history.value.1": 0.5})


def test_packed_arrays_are_written_beside_texts_that_look_alike():
    array = packed(np.arange(100.0))
    tables = {"a": {"matrix": array, "rows": [array, 'float64 3 "quoted"']}, "title": "float64 2x2 a\\b"}
    assert tomllib.loads(toml(tables)) == tables
