"""Layers between faces in scenario files: the springs that the Python API makes, and their problems by key."""

from __future__ import annotations

import copy
from random import Random

import pytest
import xarray as xr

import stridula as st
from stridula.records.provenance import toml
from stridula.scenarios.load import scenario_of_tables

STEEL = {"young": "210 GPa", "density": 7800}
PAD = {"shape": "block", "lengths": [0.08, 0.012, 0.04], "divisions": [4, 1, 2]}
PLATE = {
    "shape": "block",
    "lengths": [0.09, 0.005, 0.05],
    "divisions": [3, 1, 3],
    "offset": [-0.005, "12.5 mm", -0.005],
}
TABLES = {
    "bodies": {
        "pad": {"kind": "solid", "materials": STEEL, "cutoff": "9 kHz", "mesh": PAD},
        "plate": {"kind": "solid", "materials": STEEL, "cutoff": "9 kHz", "mesh": PLATE},
        "mass": {"kind": "point mass", "mass": 1},
    },
    "contacts": [
        {"tip": {"body": "mass"}, "track": {"kind": "rigid"}, "friction": {"law": "coulomb", "coefficient": 0.3}}
    ],
    "layers": [
        {
            "first": {"body": "pad", "face": "top"},
            "second": {"body": "plate", "face": "bottom"},
            "frequency": "2 kHz",
            "stiffness": {"y": "4e8 N/m"},
            "loss_factor": 0.2,
        }
    ],
    "connections": [{"kind": "spring", "first": {"body": "mass"}, "stiffness": 1e3}],
    "simulation": {"duration": 1e-3},
}


def with_layer(**changes):
    tables = copy.deepcopy(TABLES)
    tables["layers"][0] |= changes
    return tables


def problems(**changes) -> str:
    tables = with_layer(**changes)
    # Each body stays in some connection.
    tables["connections"] += [
        {"kind": "dashpot", "first": {"body": name}, "coefficient": 1.0} for name in ("pad", "plate")
    ]
    with pytest.raises(st.ScenarioError) as found:
        scenario_of_tables(tables)
    return str(found.value)


def on_ground(**changes):
    tables = with_layer(**changes)
    del tables["layers"][0]["second"], tables["bodies"]["plate"]
    return tables


@pytest.mark.parametrize("to_ground", [False, True], ids=["between bodies", "to the ground"])
@pytest.mark.parametrize("seed", range(4))
def test_a_layer_is_that_of_the_python_api(seed, to_ground):
    random = Random(seed)
    count = random.choice([1, 2, 4])
    frequency = sorted(random.uniform(100.0, 8e3) for _ in range(count))
    axes = [axis for axis in "xyz" if random.random() < 0.5] or ["y"]
    stiffness = {axis: [1e7 * (1.0 + 0.05 * k) * random.uniform(1.0, 1.02) for k in range(count)] for axis in axes}
    losses = {axis: random.uniform(0.02, 0.05) for axis in axes}
    table = {
        "frequency": frequency if count > 1 else frequency[0],
        "stiffness": stiffness,
        # A number stands for the same at each frequency.
        "loss_factor": random.choice([losses, losses[axes[0]]]),
        "points": random.choice([4, 9]),
    }
    system = scenario_of_tables(on_ground(**table) if to_ground else with_layer(**table)).system
    spring, *layer = system.connections
    # The numbers of connections in probes stay those of the file.
    assert str(spring).startswith("spring")
    faces = (layer[0].first.body, "top") if to_ground else (layer[0].first.body, "top", layer[0].second.body, "bottom")
    first, second, area = st.opposite_points(*faces, points=table["points"])
    one = table["loss_factor"]
    each = {axis: [one[axis] if isinstance(one, dict) else one] * count for axis in axes}
    assert layer == st.viscoelastic_layer(
        first, second, area=area, frequency=frequency, stiffness=stiffness, loss_factor=each
    )
    for axis in axes:
        shares = [one.stiffness[0] for one in layer if one.direction == axis]
        assert sum(shares) == pytest.approx(stiffness[axis][0], rel=1e-12)


def test_a_load_moves_a_body_by_the_stiffness_of_its_layer():
    tables = on_ground(stiffness={"x": "2e6 N/m", "y": "3e6 N/m", "z": "2e6 N/m"}, loss_factor=0.0)
    tables["contacts"][0]["gap"] = "1 mm"
    tables["connections"] += [
        {"kind": "dashpot", "first": {"body": "pad", "point": "top"}, "direction": axis, "coefficient": 800.0}
        for axis in "xyz"
    ]
    tables["drives"] = [{"kind": "force", "body": "pad", "point": "top", "x": 40.0, "y": -90.0}]
    tables["simulation"] = {
        "duration": "40 ms",
        "probes": [
            {"quantity": "displacement", "body": "pad", "point": "top", "direction": axis} for axis in ("x", "y")
        ],
    }
    run = scenario_of_tables(tables).simulate()
    moved = run.displacement.isel(time=-1).values
    assert moved == pytest.approx([40.0 / 2e6, -90.0 / 3e6], rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"first": {"body": "pod", "face": "top"}}, "layers.0.first.body must be one of pad, plate, mass, got 'pod'"),
        ({"second": {"body": "mass", "face": "top"}}, "layers.0.second.body must be a body of the kind solid"),
        ({"first": {"body": "pad", "face": "tip"}}, "layers.0.first.face must be one of"),
        ({"second": {"body": "plate", "face": "tip"}}, "layers.0.second.face must be one of"),
        ({"second": {"body": "plate", "face": "left"}}, "layers.0.second.face must lie opposite the whole face 'top'"),
        ({"farthest": "0.1 mm"}, "layers.0.farthest must be at least the distance between the faces, got 0.0005 m"),
        ({"frequency": [2e3, 1e3]}, "layers.0.frequency.1 must be above 2000.0, the one before it, got 1000.0"),
        ({"frequency": [], "stiffness": {"y": 4e8}}, "layers.0.frequency must have one value or more"),
        ({"frequency": -1}, "layers.0.frequency must be above 0"),
        ({"stiffness": {"y": [4e8, 5e8]}}, "layers.0.stiffness must have as many values as frequency, 1, got 2"),
        ({"stiffness": {}}, "layers.0.stiffness must have tables by direction, x, y or z, got none"),
        ({"stiffness": {"y": 0}}, "layers.0.stiffness.y must be above 0"),
        ({"stiffness": 4e8}, "layers.0.stiffness must be a table"),
        ({"loss_factor": {"x": 0.2}}, "layers.0.loss_factor must have the directions of stiffness, y, got x"),
        ({"loss_factor": [0.2, 0.3]}, "layers.0.loss_factor must have as many values as frequency, 1, got 2"),
        ({"loss_factor": -0.1}, "layers.0.loss_factor must be 0 or above"),
        ({"points": 0}, "layers.0.points must be at least 1, got 0"),
        ({"thickness": 1}, "layers.0.thickness must be one of the known keys"),
    ],
)
def test_problems_name_their_key(changes, words):
    assert words in problems(**changes)


def test_values_of_a_layer_are_set_by_key_and_kept_in_records(tmp_path):
    scenario = tmp_path / "pad.toml"
    scenario.write_text(toml(with_layer(points=2)))
    first, stiffer = (st.load_scenario(scenario, {"layers.0.stiffness.y": value}) for value in ("4e8 N/m", 8e8))
    pairs = zip(first.system.connections[1:], stiffer.system.connections[1:], strict=True)
    assert [b.stiffness[0] / a.stiffness[0] for a, b in pairs] == pytest.approx([2.0, 2.0], rel=1e-15)
    record = first.simulate()
    again = st.load_scenario(record)
    assert list(map(str, again.system.connections)) == list(map(str, first.system.connections))
    xr.testing.assert_identical(again.simulate().drop_attrs(), record.drop_attrs())
