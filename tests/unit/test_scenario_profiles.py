"""Surfaces of touched bodies that are not flat, in scenario files and in records."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

import stridula as st

PAIR = """
base = "squeal"
[contact.profile]
place = [0.0, "0.1 mm", "0.2 mm", "0.3 mm", "0.4 mm"]
height = [0.0, "2 um", 0.0, "-2 um", 0.0]
periodic = true
[simulation]
duration = "30 ms"
"""
MASSES = """
[bodies]
tip = { kind = "point mass", mass = 0.2 }
wheel = { kind = "point mass", mass = 3.0 }
[[contacts]]
tip = { body = "tip" }
track = { kind = "point", body = "wheel" }
at = "3 mm"
surface_velocity = "2 m/s"
stiffness = "1 kN/mm"
friction = 0.3
profile = { file = "wave.csv", columns = ["place", "height"], place_unit = 1e-3, height_unit = 1e-6, periodic = true }
[[connections]]
kind = "spring"
first = { body = "tip" }
stiffness = 2e4
[[drives]]
kind = "force"
body = "tip"
y = -20
[simulation]
duration = "5 ms"
"""
BRAKE = """
[bodies.pad]
kind = "solid"
materials = { young = "5 GPa", density = 2500 }
cutoff = "15 kHz"
damping = "2 %"
contact_faces = { bottom = [2, 2] }
[bodies.pad.mesh]
shape = "block"
lengths = ["30 mm", "15 mm", "20 mm"]
divisions = [2, 1, 2]
offset = ["95 mm", "10 mm", "-10 mm"]
[bodies.disc]
kind = "axisymmetric"
material = { young = "210 GPa", density = 7800 }
cutoff = "3 kHz"
damping = "1 %"
axis = [0, 1, 0]
held = ["inner"]
turning = "20 rad/s"
profile = { shape = "rectangle", inner = 0.05, outer = 0.15, bottom = 0.0, top = 0.01 }
[[surfaces]]
name = "lining"
body = "pad"
face = "bottom"
friction = 0.3
stiffness = "3e11 N/m3"
track = { kind = "axisymmetric", body = "disc" }
run_out = { file = "disc.csv", angle_unit = 0.017453292519943295, height_unit = 1e-6 }
[[drives]]
kind = "force"
body = "pad"
point = "top"
y = -200
[simulation]
duration = "2 ms"
"""


def again(record):
    """The record of a run from the scenario in another one."""
    run = st.load_scenario(record).simulate()
    xr.testing.assert_identical(run.drop_attrs(), record.drop_attrs())
    return run


def test_the_track_of_a_pair_of_beams_has_a_profile(tmp_path):
    file = tmp_path / "pair.toml"
    file.write_text(PAIR)
    flat = tmp_path / "flat.toml"
    flat.write_text(PAIR[: PAIR.index("[contact.profile]")] + PAIR[PAIR.index("[simulation]") :])
    scenario = st.load_scenario(file)
    assert scenario.system.contacts[0].profile == st.Profile(
        [0.0, 1e-4, 2e-4, 3e-4, 4e-4], [0.0, 2e-6, 0.0, -2e-6, 0.0], periodic=True
    )
    run = again(scenario.simulate())
    assert float(np.abs(run.gap - st.load_scenario(flat).simulate().gap).max()) > 1e-7


def test_a_point_of_a_body_has_a_profile_from_a_file(tmp_path):
    place = np.linspace(0.0, 40.0, 41)
    lines = [f"{s},{5 * math.sin(2 * math.pi * s / 40)}" for s in place]
    (tmp_path / "wave.csv").write_text("\n".join(["place,height", *lines]))
    file = tmp_path / "masses.toml"
    file.write_text(MASSES)
    contact = st.load_scenario(file).system.contacts[0]
    assert contact.at == 3e-3
    assert float(contact.profile.height_at(0.01)) == pytest.approx(5e-6, rel=1e-4)
    again(st.load_scenario(file).simulate())


def test_a_face_has_a_run_out_from_a_file(tmp_path):
    lines = [f"{a}, {12 * math.cos(math.radians(a)) + 3 * math.cos(math.radians(2 * a))}" for a in range(0, 360, 10)]
    (tmp_path / "disc.csv").write_text("\n".join(lines))
    file = tmp_path / "brake.toml"
    file.write_text(BRAKE)
    scenario = st.load_scenario(file)
    profiles = [one.profile for one in scenario.system.contacts]
    assert len(profiles) == 4
    around = [
        one.at / math.hypot(*face[[0, 2]])
        for one, face in zip(scenario.system.contacts, scenario_places(), strict=True)
    ]
    waves = st.RunOut.waves({1: 12e-6, 2: 3e-6})
    for one, profile, angle in zip(scenario.system.contacts, profiles, around, strict=True):
        assert float(profile.height_at(one.at)) == pytest.approx(float(waves.height_at(angle)), abs=2e-9)
    again(scenario.simulate())


def scenario_places():
    """Centres of the patches of the pad."""
    return np.array([(x, 0.01, z) for x in (0.1025, 0.1175) for z in (-0.005, 0.005)])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (('turning = "20 rad/s"\n', ""), "surfaces.0.run_out must be left out on a track that does not turn"),
        (("disc.csv", "disk.csv"), "surfaces.0.run_out: cannot read"),
        (("0.017453292519943295", "1"), r"angle must be within one turn"),
        (("angle_unit", "angel_unit"), "surfaces.0.run_out.angel_unit must be one of the known keys"),
    ],
)
def test_problems_name_their_key(tmp_path, change, words):
    (tmp_path / "disc.csv").write_text("\n".join(f"{a}, {a % 7}" for a in range(0, 360, 10)))
    file = tmp_path / "brake.toml"
    file.write_text(BRAKE.replace(*change))
    with pytest.raises(st.ScenarioError) as found:
        st.load_scenario(file)
    assert words in str(found.value)
