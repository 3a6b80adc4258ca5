"""Faces in contact in scenarios: the table, the shipped brake, refusals."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stridula as st
from stridula.scenarios.load import scenario_of_tables
from stridula.scenarios.read import read_tables

BLOCK = """
friction = 0.3
[bodies.die]
kind = "solid"
mesh = { shape = "block", lengths = [0.02, 0.01, 0.02], divisions = [1, 1, 1], offset = [0.01, 0.0, 0.01] }
materials = { young = "5 GPa", density = 2500 }
contact_faces = ["bottom"]

[bodies.bed]
kind = "solid"
mesh = { shape = "block", lengths = [0.04, 0.01, 0.04], divisions = [1, 1, 1], offset = [0.0, -0.01, 0.0] }
materials = { young = "5 GPa", density = 2500 }
fixed = ["bottom"]
contact_faces = ["top"]

[[surfaces]]
name = "sole"
body = "die"
face = "bottom"
track = { kind = "solid", body = "bed", face = "top" }
stiffness = "1000 N/mm3"

[[drives]]
kind = "force"
body = "die"
point = "top"
y = -10.0

[[drives]]
kind = "initial equilibrium"

[simulation]
duration = "1 ms"
"""


@pytest.fixture
def block(tmp_path):
    (tmp_path / "block.toml").write_text(BLOCK, encoding="utf-8")
    return tmp_path / "block.toml"


def problems(path, overrides):
    with pytest.raises(st.ScenarioError) as caught:
        st.load_scenario(path, overrides)
    return caught.value.problems


def test_a_surface_is_the_one_written_in_python(block):
    system = st.load_scenario(block, {"overlay": True}).system
    die, bed = system.bodies
    expected = st.SurfaceContact(
        die, "bottom", bed, "top", friction=st.Coulomb(0.3), stiffness=1e12, overlay=True, name="sole"
    )
    assert system.contact == expected
    assert system.contact_names[0] == "sole 1"
    assert system.drives[0].point == die.at("top")


@pytest.mark.parametrize("axis", [None, [0.0, 2.0, 0.0]])
def test_a_meshed_track_turns(block, axis):
    given = {"turning": "20 rad/s", "origin": ["20 mm", 0.0, "0.3 m"]} | ({} if axis is None else {"axis": axis})
    changes = {f"surfaces.0.track.{key}": value for key, value in given.items()}
    if axis is None:
        (first,) = problems(block, changes)
        assert "turning must move the track along its surface" in first
        return
    system = st.load_scenario(block, changes).system
    die, bed = system.bodies
    expected = st.SurfaceContact(
        die,
        "bottom",
        bed,
        "top",
        st.Coulomb(0.3),
        stiffness=1e12,
        turning=((0, 1, 0), (0.02, 0, 0.3), 20.0),
        name="sole",
    )
    assert system.contact == expected
    assert system.contacts[0].surface_velocity[0] == pytest.approx(20.0 * 0.28, rel=0.05)


def test_a_surface_stands_on_a_plane_beside_a_contact(block):
    tables = read_tables(block)
    tables["contacts"] = [
        {"tip": {"body": "die", "point": [0.03, 0.0, 0.02]}, "track": {"kind": "rigid"}, "normal": [0.0, 1.0, 0.0]}
    ]
    tables["surfaces"][0]["track"] = {"kind": "rigid", "velocity": 0.1}
    del tables["bodies"]["bed"]
    system = scenario_of_tables(tables).system
    point, *sole = system.contacts
    assert point.tip.position == (0.03, 0.0, 0.02)
    assert len(sole) == 4
    assert {contact.rigid_track for contact in sole} == {st.RigidTrack(velocity=0.1)}


def test_a_force_on_a_face_presses_evenly(block):
    """The surface carries it with equal pressure at every point, up to the bending of a wider bed."""
    case = st.load_scenario(block, {"friction": 0.0})
    run = case.simulate()
    force = run.normal_force.isel(time=-1)
    assert float(force.sum()) == pytest.approx(10.0, rel=1e-3)
    np.testing.assert_allclose(force / force.mean(), 1.0, atol=0.05)


@pytest.mark.parametrize(
    ("division", "count"), [({"bottom": [3, 2]}, 6), ({"bottom": 9}, 9), ({"bottom": "integration"}, 4)]
)
def test_faces_are_divided_as_given(block, division, count):
    system = st.load_scenario(block, {"bodies.die.contact_faces": division, "drives.1.status": "sticking"}).system
    assert len(system.contacts) == count
    record = st.simulate(system, 1e-4)
    again = st.simulate(st.load_scenario(record).system, 1e-4)
    np.testing.assert_array_equal(record.surface_force, again.surface_force)


@pytest.mark.parametrize(
    ("overrides", "message"),
    [
        ({"surfaces.0.body": "dye"}, "surfaces.0.body must be one of die, bed, got 'dye'; did you mean 'die'?"),
        (
            {"surfaces.0.face": "sole"},
            "surfaces.0.face must be one of left, right, bottom, top, back, front, got 'sole'",
        ),
        (
            {"track.face": "tip"},
            "surfaces.0.track.face must be one of left, right, bottom, top, back, front, got 'tip'",
        ),
        ({"track.kind": "axisymmetric"}, "surfaces.0.track.body must be given"),
        ({"surfaces.0.stiffness": "3 N/m"}, "surfaces.0.stiffness"),
        ({"gap": "-1 mm"}, "surfaces.0.gap must leave the faces apart"),
        ({"surfaces.0.tangent": [1.0, 0.0]}, "surfaces.0"),
        ({"bodies.die.contact_faces": ["sole"]}, "bodies.die.contact_faces.0 must be one of left, right"),
        ({"bodies.die.contact_faces": {"bottom": 0}}, "bodies.die.contact_faces"),
        ({"bodies.die.contact_faces": {"bottom": "all"}}, "divisions by name, such as {bottom = 30}"),
        ({"bodies.die.contact_faces": 3}, "bodies.die.contact_faces must be a list of names, or divisions by name"),
        ({"bodies.die.mesh.offset": [0.05, 0.0, 0.0]}, "must lie opposite the whole face"),
        ({"drives.0.point": "crown"}, "drives.0.point must be"),
    ],
)
def test_bad_surfaces_are_refused_in_one_line(block, overrides, message):
    (first, *_) = problems(block, overrides)
    assert message in first
    assert "\n" not in first


def test_a_body_of_another_kind_is_reported(block):
    tables = read_tables(block)
    tables["surfaces"][0]["track"] = {"kind": "axisymmetric", "body": "bed"}
    with pytest.raises(st.ScenarioError) as caught:
        scenario_of_tables(tables)
    assert caught.value.problems == ("surfaces.0.track.body must be a body of the kind axisymmetric, got 'bed'",)


def test_a_contact_is_required(block):
    tables = read_tables(block)
    for given, message in (
        ({}, "contacts must be given: contacts of bodies at points, in place of contact"),
        ({"surfaces": []}, "surfaces must not be empty, got []"),
    ):
        without = {key: value for key, value in tables.items() if key != "surfaces"} | given
        with pytest.raises(st.ScenarioError) as caught:
            scenario_of_tables(without)
        assert message in caught.value.problems


def test_layers_and_a_turned_mesh(tmp_path):
    case = st.load_scenario("brake")
    upper, lower = case.system.contact[0].body, case.system.contact[1].body
    half = math.radians(23.0)
    heights = {"lining": 0.01, "plate": 0.006}
    mesh = st.SolidMesh.sector((0.085, 0.125), (-half, half), heights, (2, 4, 1))
    assert upper.mesh == mesh.moved((0.0, 0.01, 0.0))
    assert {name: len(those) for name, those in mesh.volumes.items()} == {"lining": 8, "plate": 8}
    height = mesh.nodes[mesh.elements, 1]
    np.testing.assert_allclose(np.unique(height[mesh.volumes["lining"]].round(9)), [0.0, 0.005, 0.01])
    np.testing.assert_allclose(np.unique(height[mesh.volumes["plate"]].round(9)), [0.01, 0.013, 0.016])
    np.testing.assert_allclose(lower.mesh.nodes, upper.mesh.nodes * [-1.0, -1.0, 1.0], atol=1e-15)


def test_the_brake_grows_as_linear_theory_has_it():
    case = st.load_scenario("brake")
    assert len(case.system.contacts) == 64
    theory = st.sliding_stability(case.system)
    grows = np.flatnonzero(theory.unstable)
    np.testing.assert_allclose(theory.frequency.values[grows], [2822.4, 6360.6], atol=1.0)
    rate = float(theory.growth_rate[grows[0]])
    run = case.simulate(duration=0.03)
    velocity = run.velocity.values[:, 0]
    early, late = (np.sqrt(np.mean(velocity[at : at + 500] ** 2)) for at in (1000, 2500))
    assert np.log(late / early) / 0.015 == pytest.approx(rate, rel=0.03)
