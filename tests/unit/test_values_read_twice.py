"""Tables in SI are tables of a scenario again: what the page and reports pass on is read a second time."""

from __future__ import annotations

import numpy as np
import pytest

from stridula.scenarios.fields import Divided, Motion, Numbers, Pair, Points
from stridula.scenarios.load import scenario_of_tables, tables_in_si
from stridula.scenarios.read import read_tables
from stridula.scenarios.shipped import shipped

CONTACT = {"tip": {"body": "a"}, "track": {"kind": "rigid"}, "friction": {"law": "coulomb", "coefficient": 0.3}}
BLOCK = {"shape": "block", "lengths": ["20 mm", "10 mm", "20 mm"], "divisions": [2, 1, 2]}
TIED = {
    "shape": "tied",
    "parts": {"lower": BLOCK, "upper": BLOCK | {"offset": [0, "10 mm", 0]}},
    "ties": [["lower/top", "upper/bottom"]],
}
SOLID = {"kind": "solid", "materials": {"young": "5 GPa", "density": 2500}, "cutoff": "60 kHz"}
SIX = {"mass": np.eye(6).tolist(), "stiffness": np.diag([1e6] * 6).tolist()}
BODIES = {
    "rigid body": {"kind": "rigid body", "mass": "2 kg", "inertia": [1, 2, 3], "points": {"foot": [0, "-1 cm", 0]}},
    "rigid body with a matrix": {"kind": "rigid body", "mass": 2, "inertia": np.eye(3).tolist()},
    "degrees of freedom": {
        "kind": "reduced",
        **SIX,
        "damping": 0.01,
        "points": {"tip": {"x": 0, "y": 1, "z": 2}, "end": {"x": 3, "y": 4, "z": 5}},
    },
    "rows": {
        "kind": "reduced",
        **SIX,
        "damping": {"form": "rayleigh", "mass": 1.0, "stiffness": "1e-6 s"},
        "points": {"tip": np.eye(6)[:3].tolist()},
    },
    "division": SOLID | {"mesh": BLOCK, "contact_faces": {"bottom": [2, 1]}, "fixed": {"top": "xz"}},
    "faces": SOLID | {"mesh": BLOCK, "contact_faces": ["bottom"], "fixed": ["top"], "points": {"tip": [0, 0, 0]}},
    "tied": SOLID | {"mesh": TIED, "damping": "1 %", "points": {"tip": [0, 0, 0]}},
}


def same(one, other) -> bool:
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[key], other[key]) for key in one)
    if isinstance(one, (list, tuple)) and any(isinstance(each, (dict, list, tuple, np.ndarray)) for each in one):
        return len(one) == len(other) and all(map(same, one, other))
    return bool(np.all(np.asarray(one) == np.asarray(other)))


def agree(tables):
    once = tables_in_si(tables)
    twice = tables_in_si(once)
    assert same(once, twice)
    return once


@pytest.mark.parametrize("name", sorted(shipped("cases")))
def test_shipped_scenarios(name):
    agree(read_tables(name))


@pytest.mark.parametrize("name", BODIES)
def test_bodies(name):
    tables = {"bodies": {"a": BODIES[name]}, "contacts": [CONTACT], "simulation": {"duration": "1 ms"}}
    if name in ("rigid body", "rigid body with a matrix"):
        tables["contacts"] = [CONTACT | {"tip": {"body": "a", "point": "centre"}}]
    if BODIES[name]["kind"] == "solid":
        face = "lower/bottom" if name == "tied" else "bottom"
        surface = {"name": "face", "body": "a", "face": face, "track": {"kind": "rigid"}}
        del tables["contacts"]
        tables["surfaces"] = [surface | {"friction": CONTACT["friction"]}]
    if name == "degrees of freedom":
        tables["contacts"] = [CONTACT | {"tip": {"body": "a", "point": "tip"}}]
    once = agree(tables)
    assert scenario_of_tables(once).system == scenario_of_tables(tables).system


@pytest.mark.parametrize(
    ("kind", "value"),
    [
        (Points(), {"tip": [[1, 1], [1, 2], [1, 3]], "end": {"x": 0, "y": None, "z": 2}, "node": 7}),
        (Motion(), [1, 2, 3]),
        (Divided(), {"bottom": [6, 5], "top": 3, "side": "integration"}),
        (Pair(), ("plate/front", "lining/back")),
        (Numbers((0, 1, 2)), [[1.0, 0.0], [0.0, 2.0]]),
    ],
)
def test_kinds(kind, value):
    once = kind.read(value)
    assert same(kind.read(once), once)


def test_the_place_of_a_point_of_a_rigid_body_is_explained():
    body = {"kind": "rigid body", "mass": 1, "points": {"foot": [0, "1 kg", 0]}}
    tables = {"bodies": {"a": body}, "contacts": [CONTACT], "simulation": {"duration": "1 ms"}}
    with pytest.raises(ValueError, match=r"bodies\.a\.points must give the point foot a place that must be three dist"):
        tables_in_si(tables)
