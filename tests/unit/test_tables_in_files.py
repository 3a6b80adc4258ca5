"""Tables of friction, profiles and springs in text files that a scenario names."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.scenarios.read import tables_of_text

LINING = "speed,mu\n0,0.5\n10,0.42\n50,0.36\n300,0.33\n"
RAIL = "x;z\n0;0\n5;4\n10;0\n15;-4\n20;0\n"
STOP = "# mm N\n1.1 50\n-1 0\n1 0\n-1.1 -50\n"
DAMPER = "velocity;force\n-100;-3\n0;0\n200;2\n"
SCENARIO = """
[bodies.block]
kind = "point mass"
mass = 1.0
[[contacts]]
tip = { body = "block" }
track.kind = "rigid"
track.velocity = 0.05
track.profile = { file = "rail.csv", place_unit = 1e-3, height_unit = 1e-6, periodic = true }
friction = { law = "tabulated", file = "lining.csv", columns = ["speed", "mu"], speed_unit = 1e-3 }
stiffness = 1e6
[[connections]]
kind = "tabulated spring"
first = { body = "block" }
file = "stop.txt"
displacement_unit = 1e-3
[[connections]]
kind = "tabulated dashpot"
first = { body = "block" }
file = "damper.csv"
velocity_unit = 1e-3
[[drives]]
kind = "force"
body = "block"
y = -10
[simulation]
duration = 0.01
"""


@pytest.fixture
def scenario(tmp_path):
    """A function that writes a changed scenario beside its tables and loads it."""
    for name, text in (("lining.csv", LINING), ("rail.csv", RAIL), ("stop.txt", STOP), ("damper.csv", DAMPER)):
        (tmp_path / name).write_text(text)

    def load(before="", after=""):
        assert before in SCENARIO
        (tmp_path / "block.toml").write_text(SCENARIO.replace(before, after))
        return st.load_scenario(tmp_path / "block.toml")

    return load


def test_tables_are_those_of_the_files(scenario):
    system = scenario().system
    damper = system.connections[1]
    assert (damper.velocity, damper.force) == ((-0.1, 0.0, 0.2), (-3.0, 0.0, 2.0))
    law, profile, stop = system.contact.friction, system.contact.track.profile, system.connections[0]
    assert law == st.TabulatedFriction([0.0, 0.01, 0.05, 0.3], [0.5, 0.42, 0.36, 0.33])
    np.testing.assert_allclose(profile.place, [0.0, 5e-3, 0.01, 0.015, 0.02])
    np.testing.assert_allclose(profile.height, [0.0, 4e-6, 0.0, -4e-6, 0.0])
    assert profile.periodic
    np.testing.assert_allclose(stop.displacement, [-1.1e-3, -1e-3, 1e-3, 1.1e-3])
    assert stop.force == (-50.0, 0.0, 0.0, 50.0)


def test_a_record_has_the_tables_and_runs_without_the_files(scenario, tmp_path):
    run = scenario().simulate()
    for name in ("lining.csv", "rail.csv", "stop.txt", "damper.csv"):
        (tmp_path / name).unlink()
    again = st.load_scenario(run).simulate()
    np.testing.assert_array_equal(again["tangential_force"], run["tangential_force"])


@pytest.mark.parametrize(
    ("before", "after", "words"),
    [
        ('"lining.csv"', '"none.csv"', r"contacts\.0\.friction: cannot read '.*none\.csv'"),
        ('file = "lining', 'velocity = [0, 1], file = "lining', "friction.file must be left out with velocity"),
        ('file = "stop.txt"\n', "", "displacement_unit must be left out without a file"),
        ('file = "stop.txt"\ndisplacement_unit = 1e-3\n', "", "displacement must be given, unless a file has it"),
        ('["speed", "mu"]', '["speed", "v"]', r"lining\.csv, line 1: columns must be out of speed, mu, got 'v'"),
        ("displacement_unit = 1e-3", "columns = [0, 1, 2]", "columns must be two, of displacement and force"),
        ("displacement_unit = 1e-3", "displacement_unit = -1", "displacement_unit must be above 0"),
    ],
)
def test_what_is_wrong_is_named(scenario, before, after, words):
    with pytest.raises(st.ScenarioError, match=words):
        scenario(before, after)


def test_a_text_without_a_place_names_no_files():
    with pytest.raises(st.ScenarioError, match=r"^contacts must not name files in a text"):
        tables_of_text(SCENARIO, "text")
