"""Scenarios of plates, belts, moving ground and several contacts."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import xarray as xr
from unit.scenario_texts import chain, problems

import stridula as st
from stridula.scenarios import outline
from stridula.scenarios.keys import find
from stridula.studies.values_by_key import si_tables

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
    assert found.startswith("contacts.0.track.history.time must increase, got (0.0, 0.01, 0.009)")


def test_files_are_found_from_the_file_that_names_them(tmp_path):
    (tmp_path / "sub").mkdir()
    chain(2, name="pad").save(tmp_path / "sub" / "pad.npz")
    (tmp_path / "sub" / "base.toml").write_text(
        '[bodies.pad]\nkind = "reduced"\nfile = "pad.npz"\n[[contacts]]\ntip = {body = "pad", point = "tip"}\n'
        'track = {kind = "rigid"}\n[simulation]\nduration = 1.0\n'
    )
    (tmp_path / "case.toml").write_text('base = "sub/base.toml"\n[bodies.pad]\ncutoff = "1 kHz"\n')
    assert st.load_scenario(tmp_path / "case.toml").system.slider.cutoff == 1e3


def test_keys_reach_bodies_and_contacts():
    belt = st.load_scenario("belt", {"block.mass": "2 kg", "kinetic": 0.3, "connections.0.stiffness": "5 N/m"}).system
    assert (belt.slider.mass, belt.contact.friction.kinetic, belt.connections[0].stiffness) == (2.0, 0.3, 5.0)
    other = st.load_scenario("belt", {"friction.law": "coulomb", "coefficient": 0.3}).system
    assert other.contact.friction == st.Coulomb(0.3)
    with pytest.raises(st.ScenarioError, match="got 'cutoff'"):
        st.load_scenario("belt", {"cutoff": 1e3})


@pytest.mark.parametrize("case", ["belt", "brake", "violin"])
def test_the_full_path_of_a_number_is_its_key(case):
    tables = si_tables(st.load_scenario(case).system, {})
    given = [path for path, _ in outline.paths(tables) if isinstance(outline.look_up(tables, path), float)]
    # Names of points that have a dot cannot be parts of a key.
    keys = {".".join(map(str, path)): path for path in given if not any("." in str(part) for part in path)}
    assert sum(any(isinstance(part, int) for part in path) for path in keys.values()) > 3
    for key, path in keys.items():
        assert find(key, tables) == path


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


def test_a_plate_takes_values_at_the_top_and_survives_provenance(tmp_path):
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
def test_errors_of_a_plate_are_explained(old, new, message, tmp_path):
    assert old in PLATE
    assert message in "\n".join(problems(PLATE.replace(old, new), tmp_path))


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
    # A partial law is merged with that at the top; a bare number is a complete law.
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
    # Without one at the top the contact must be named.
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
    with pytest.raises(st.ScenarioError, match=r"must name one place, got 'value\.1'"):
        st.load_scenario(path, {"value.1": 0.5})
    times = ", ".join(str(0.01 * k) for k in range(65))
    path.write_text(SHAKEN.replace("time = [0, 0.01, 0.02], value = [0, 1, 0]", f"time = [{times}], value = [{times}]"))
    with pytest.raises(st.ScenarioError, match="key must be a key of the scenario"):
        st.load_scenario(path, {"track.normal_history.value.1": 0.5})
