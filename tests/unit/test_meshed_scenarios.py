"""Scenarios of bodies of revolution and of bodies meshed in space."""

from __future__ import annotations

import json
import math
from pathlib import Path

import meshio
import numpy as np
import pytest
import tomli_w
import xarray as xr

import stridula as st
from stridula import analysis
from stridula.scenarios.load import with_matrices
from stridula.scenarios.read import read_tables, tables_of_text

ALUMINIUM = st.Material(7e10, 2700.0, 0.33)
STEEL, IRON = st.Material(2.1e11, 7800.0), st.Material(1.1e11, 7100.0, 0.28)
REST = """
[[contacts]]
tip = { body = "a", point = "p" }
track = { kind = "rigid" }
[simulation]
duration = "1 ms"
"""
RING = {"shape": "rectangle", "inner": 0.03, "outer": 0.1, "bottom": -0.01, "top": 0.0}
CUBE = {"shape": "block", "lengths": [0.02, 0.02, 0.02], "divisions": [1, 1, 1]}
METAL = {"young": 2.1e11, "density": 7800.0}
# A square of four cells and one of two triangles, in millimetres.
GRID = 10.0 * np.stack(np.meshgrid([3.0, 4.0, 5.0], [0.0, 1.0, 2.0], indexing="ij"), axis=2).reshape(-1, 2)
SQUARES = np.array([[0, 3, 4, 1], [3, 6, 7, 4], [1, 4, 5, 2], [4, 7, 8, 5]])


def on_disc(disc: dict, folder: Path, **rest: object) -> st.Scenario:
    """Return a mass on a disc, its table as given."""
    tables = {
        "bodies": {"mass": {"kind": "point mass", "mass": 1.0}, "disc": {"kind": "axisymmetric", **disc}},
        "contacts": [
            {
                "tip": {"body": "mass"},
                "track": {"kind": "point", "body": "disc", "point": ["50 mm", "30 deg", 0.0]},
                "normal": [0.0, 0.0, 1.0],
                "surface_velocity": ["20 cm/s", 0.1],
            }
        ],
        "simulation": {"duration": "1 ms"},
    }
    return loaded(tables | rest, folder)


def with_solid(body: dict, folder: Path, point: object = "p") -> st.Scenario:
    """Return a solid body on a rigid track, its table as given."""
    tables = {
        "bodies": {"a": {"kind": "solid", **body}},
        "contacts": [{"tip": {"body": "a", "point": point}, "track": {"kind": "rigid"}}],
        "simulation": {"duration": "1 ms"},
    }
    return loaded(tables, folder)


def loaded(tables: dict, folder: Path) -> st.Scenario:
    (folder / "case.toml").write_text(tomli_w.dumps(tables), encoding="utf-8")
    return st.load_scenario(folder / "case.toml")


def told(make, *arguments) -> str:
    """Return the problems, each of one line."""
    with pytest.raises(st.ScenarioError) as caught:
        make(*arguments)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def write_squares(path: Path) -> None:
    """Write the square in the plane of x and z, with a region and an edge."""
    lines = np.array([[0, 1], [1, 2]])
    mesh = meshio.Mesh(
        np.insert(GRID, 1, 0.0, axis=1),
        [("line", lines), ("quad", SQUARES)],
        cell_sets={
            "shaft": [np.array([0, 1]), np.array([], dtype=int)],
            "low": [np.array([], dtype=int), np.array([0, 1])],
        },
    )
    mesh.write(path, file_format="abaqus")


# The shipped ones.


def pin_on_disc() -> st.System:
    """Return the shipped rig as written in Python."""
    normal = (0.0697564737441253, 0.9975640502598242, 0.0)
    places = 0.0025 * np.arange(5)
    radii = [0.157, 0.1595, 0.162, 0.1645, 0.167]
    disc = st.AxisymmetricBody(
        st.RectangleProfile({"body": ((0.008, 0.179), (-0.025, 0.0))}),
        ALUMINIUM,
        cutoff=6e3,
        held=["inner"],
        residual_at=[(radius, 0.0) for radius in radii],
        axis=normal,
        origin=(0.0, 0.0, -0.157),
        name="disc",
    )
    pin = st.SolidBody.block(
        (0.010, 0.149, 0.010),
        (2, 16, 2),
        ALUMINIUM,
        points={f"node {k}": (0.0, 0.0, place) for k, place in enumerate(places)},
        fixed=["top"],
        cutoff=20e3,
        name="pin",
    )
    contacts = [
        st.PointContact(
            pin.at(f"node {k}"),
            disc.at((radius, math.radians(-94.0), 0.0)),
            friction=st.Coulomb(0.152),
            normal=normal,
            tangent=(normal[1], -normal[0], 0.0),
            surface_velocity=1.0,
            name=f"node {k}",
        )
        for k, radius in enumerate(radii)
    ]
    return st.System(contacts, [st.Force(one.tip, x=-6.976, y=-99.76, history=st.Ramp(0.01)) for one in contacts])


def test_the_pin_on_disc_is_the_one_written_in_python():
    case = st.load_scenario("pin-on-disc")
    assert case.system == pin_on_disc()
    assert case.probes == (st.Velocity(case.system.bodies[0].at("node 0"), "x"),)


@pytest.mark.parametrize("name", ["pin-on-disc", "pad-on-disc", "brake"])
def test_bodies_that_touch_stand_where_they_touch(name):
    """As drawn in pictures, within the rounding of angles."""
    for contact in st.load_scenario(name).system.contacts:
        tip, touched = (end.body.place(end.position) for end in (contact.tip, contact.touched_point))
        np.testing.assert_allclose(tip, touched, atol=2e-6)


def test_the_pin_on_disc_squeals_at_its_unstable_mode():
    theory = st.sliding_stability(st.load_scenario("pin-on-disc").system)
    (grows,) = np.flatnonzero(theory.unstable)
    assert theory.frequency.values[grows] == pytest.approx(2272.5, abs=0.5)
    assert theory.growth_rate.values[grows] == pytest.approx(417.1, abs=1.0)
    run = st.load_scenario("pin-on-disc", {"simulation.duration": "60 ms"}).simulate(sample_rate=2e4)
    found = analysis.regime_of(run.sel(contact="node 0"))
    assert found["regime"] == "squeal"
    assert 2250.0 < found["frequency"] < 2350.0


def test_its_friction_and_its_thickness_go_by_one_key():
    found = st.sweep(
        "pin-on-disc",
        {"friction": [0.05, 0.2], "bottom": ["-25 mm", "-20 mm"]},
        "stability",
        duration="1 ms",
    )
    growth = found.growth_rate
    assert (growth.sel(friction=0.05) < 1.0).all()
    assert growth.sel(friction=0.2, bottom=-25.0) > 400.0
    thinner = st.load_scenario("pin-on-disc", {"friction": 0.2, "bottom": "-20 mm"}).system
    assert thinner.bodies[1].profile.rectangles[0][1][1] == (-0.02, 0.0)
    assert {contact.friction for contact in thinner.contacts} == {st.Coulomb(0.2)}
    expected = float(st.sliding_stability(thinner).growth_rate.max())
    assert float(growth.sel(friction=0.2, bottom=-20.0)) == pytest.approx(expected, rel=1e-9)


def test_the_pad_on_disc_is_the_one_written_in_python():
    case = st.load_scenario("pad-on-disc")
    pad, disc = case.system.bodies
    assert disc == st.AxisymmetricBody(
        st.RectangleProfile({"body": ((0.04, 0.13), (-0.012, 0.0))}),
        IRON,
        cutoff=8e3,
        held="inner",
        damping=0.001,
        residual_at=[(radius, 0.0) for radius in (0.08, 0.1, 0.12)],
        axis=(0.0, 1.0, 0.0),
        name="disc",
    )
    turn = math.radians(20.0)
    assert pad.mesh == st.SolidMesh.sector((0.08, 0.12), (-turn, turn), 0.015, (2, 4, 2), axis="y")
    # Every foot is at the point of the disc that it touches, and is dragged by the turning disc.
    for contact in case.system.contacts:
        there = disc.place(contact.track.position)
        np.testing.assert_allclose(pad.mesh.nodes[pad.points[contact.tip.position]], there, atol=1e-6)
        turned = 30.0 * np.cross((0.0, 1.0, 0.0), there)
        np.testing.assert_allclose(contact.frame[1] * contact.surface_velocity, turned, atol=1e-3)
    assert len(case.system.connections) == 12


def test_the_pad_on_disc_runs_and_has_modes_that_grow():
    case = st.load_scenario("pad-on-disc")
    assert int(st.sliding_stability(case.system).unstable.sum()) == 3
    run = case.simulate(duration=2e-3, sample_rate=2e4)
    assert float(run.normal_force.max()) > 0.0


# Tables.

LENGTHS = ["3 cm", 0.05]
PROFILES = {
    "rectangle": (RING, st.RectangleProfile({"body": ((0.03, 0.1), (-0.01, 0.0))})),
    "rectangles": (
        {
            "shape": "rectangles",
            "size": "4 mm",
            "rectangles": [
                {"region": "hat", "inner": "30 mm", "outer": "50 mm", "bottom": 0.0, "top": "2 cm"},
                {"region": "disc", "inner": 0.05, "outer": 0.1, "bottom": "0 mm", "top": "1 cm"},
                {"region": "disc", "inner": 0.03, "outer": 0.05, "bottom": -0.01, "top": 0.0},
            ],
        },
        st.RectangleProfile(
            [
                ("hat", ((0.03, 0.05), (0.0, 0.02))),
                ("disc", ((0.05, 0.1), (0.0, 0.01))),
                ("disc", ((0.03, 0.05), (-0.01, 0.0))),
            ],
            size=0.004,
        ),
    ),
    "line": (
        {"shape": "line", "points": [["3 cm", 0.0], [0.1, "10 mm"]], "thickness": ["4 mm", 0.002]},
        st.LineProfile([(0.03, 0.0), (0.1, 0.01)], [0.004, 0.002]),
    ),
    "cells": (
        {
            "shape": "cells",
            "nodes": (1e-3 * GRID).tolist(),
            "cells": SQUARES.tolist(),
            "regions": {"low": [0, 1, 2, 3]},
        },
        st.MeshProfile(1e-3 * GRID, SQUARES, {"low": range(4)}),
    ),
}


@pytest.mark.parametrize(("table", "profile"), PROFILES.values(), ids=PROFILES)
def test_every_profile_is_the_one_written_in_python(table, profile, tmp_path):
    disc = {"profile": table, "material": METAL, "cutoff": "5 kHz"}
    tables = {
        "bodies": {"mass": {"kind": "point mass", "mass": 1.0}, "disc": {"kind": "axisymmetric", **disc}},
        "contacts": [{"tip": {"body": "mass"}, "track": {"kind": "rigid"}}],
        "connections": [
            {
                "kind": "spring",
                "stiffness": 1.0,
                "first": {"body": "mass"},
                "second": {"body": "disc", "point": [float(one) for one in np.insert(profile_point(profile), 1, 0.4)]},
            }
        ],
        "simulation": {"duration": "1 ms"},
    }
    system = loaded(tables, tmp_path).system
    assert system.bodies[1] == st.AxisymmetricBody(profile, STEEL, cutoff=5e3, name="disc")


def profile_point(profile) -> np.ndarray:
    """Return a place in a profile."""
    mesh = profile.mesh(lambda thickness, region: thickness)
    return mesh.nodes[mesh.cells[0]].mean(axis=0)


def test_every_key_of_a_body_of_revolution(tmp_path):
    disc = {
        "profile": PROFILES["rectangles"][0],
        "material": {"hat": METAL, "disc": {"young": "110 GPa", "density": "7.1 g/cm3", "poisson": 0.28}},
        "cutoff": "5 kHz",
        "held": [
            "hat.top",
            {"place": "hat.inner", "directions": ["r", "z"]},
            {"place": {"inner": 0.03, "outer": "4 cm", "bottom": -0.01, "top": "-1 cm"}, "directions": "theta"},
        ],
        "orders": 4,
        "damping": {"form": "rayleigh", "mass": "3 1/s", "stiffness": "1 us"},
        "residual_at": [["50 mm", 0.0], [0.06, "1 cm"]],
        "axis": [0.0, 1.0, 0.2],
        "origin": ["1 cm", 0.0, -0.1],
    }
    case = on_disc(disc, tmp_path)
    body = st.AxisymmetricBody(
        PROFILES["rectangles"][1],
        {"hat": STEEL, "disc": IRON},
        cutoff=5e3,
        held=["hat.top", st.Held("hat.inner", ["r", "z"]), st.Held(((0.03, 0.04), (-0.01, -0.01)), "theta")],
        orders=4,
        damping=st.Rayleigh(3.0, 1e-6),
        residual_at=[(0.05, 0.0), (0.06, 0.01)],
        axis=(0.0, 1.0, 0.2),
        origin=(0.01, 0.0, -0.1),
        name="disc",
    )
    contact = case.system.contact
    assert contact.track == body.at((0.05, math.radians(30.0), 0.0))
    assert contact.surface_velocities == (0.2, 0.1)


MESHES = {
    "block": (CUBE, st.SolidMesh.block((0.02, 0.02, 0.02), (1, 1, 1))),
    "sector": (
        {
            "shape": "sector",
            "radii": ["8 cm", 0.1],
            "angles": ["-10 deg", 0.2],
            "height": "2 cm",
            "divisions": [1, 2, 1],
            "axis": "z",
        },
        st.SolidMesh.sector((0.08, 0.1), (math.radians(-10.0), 0.2), 0.02, (1, 2, 1), axis="z"),
    ),
    "extrusion": (
        {
            "shape": "extrusion",
            "nodes": (1e-3 * GRID).tolist(),
            "quadrilaterals": SQUARES.tolist(),
            "height": "20 mm",
            "layers": 2,
            "axis": "y",
        },
        st.SolidMesh.extrusion(1e-3 * GRID, SQUARES, 0.02, 2, axis="y"),
    ),
    "elements": (
        {
            "shape": "elements",
            "kind": "tetra",
            "nodes": [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]],
            "elements": [[0, 1, 2, 3]],
            "volumes": {"all": [0]},
            "faces": {"side": [[0, 0]]},
            "node_sets": {"p": [3]},
        },
        st.SolidMesh(
            [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]],
            [[0, 1, 2, 3]],
            "tetra",
            {"all": [0]},
            {"side": [[0, 0]]},
            {"p": [3]},
        ),
    ),
}


@pytest.mark.parametrize(("table", "mesh"), MESHES.values(), ids=MESHES)
def test_every_mesh_is_the_one_written_in_python(table, mesh, tmp_path):
    body = {"mesh": table, "materials": METAL, "points": {"p": 3}, "damping": "1 %", "residual_flexibility": False}
    case = with_solid(body, tmp_path)
    assert case.system.slider == st.SolidBody(mesh, STEEL, {"p": 3}, damping=0.01, residual_flexibility=False, name="a")


def test_every_key_of_a_solid(tmp_path):
    mesh = MESHES["elements"]
    body = {
        "mesh": mesh[0],
        "materials": {"all": METAL},
        "points": {"tip": "p", "foot": ["10 cm", 0.0, 0.0], "zero": 0},
        "fixed": {"side": "xz"},
        "cutoff": "90 kHz",
        "damping": [0.01] * 6,
        "linear": True,
    }
    found = with_solid(body, tmp_path, "tip").system.slider
    points = {"tip": "p", "foot": (0.1, 0.0, 0.0), "zero": 0}
    expected = st.SolidBody(mesh[1], {"all": STEEL}, points, {"side": "xz"}, 9e4, [0.01] * 6, linear=True, name="a")
    assert found == expected
    assert found.point_names == ("p", "tip", "foot", "zero")


def test_springs_forces_and_probes_reach_points_by_their_places(tmp_path):
    more = {
        "connections": [
            {
                "kind": "dashpot",
                "coefficient": 2.0,
                "first": {"body": "disc", "point": [0.06, 0.0, "-10 mm"]},
                "direction": [0.0, 1.0, 1.0],
            }
        ],
        "drives": [{"kind": "force", "body": "disc", "point": ["6 cm", "90 deg", 0.0], "z": -5.0}],
    }
    more["simulation"] = {
        "duration": "1 ms",
        "probes": [{"quantity": "velocity", "body": "disc", "point": [0.1, "180 deg", 0.0], "direction": "z"}],
    }
    case = on_disc({"profile": RING, "material": METAL, "cutoff": 5e3}, tmp_path, **more)
    disc = case.system.bodies[1]
    assert case.system.connections[0].first == disc.at((0.06, 0.0, -0.01))
    assert case.system.drives[0].point == disc.at((0.06, math.radians(90.0), 0.0))
    assert case.probes == (st.Velocity(disc.at((0.1, math.pi, 0.0)), "z"),)
    assert np.abs(case.simulate().velocity.values).max() > 0.0


# Files.


def write_cube(path: Path) -> None:
    mesh = st.SolidMesh.block((20.0, 20.0, 20.0), (1, 1, 1))
    sets = {"corner": np.array([0]), "left": mesh.nodes_of("left")}
    cells = [("hexahedron20", mesh.elements)]
    meshio.Mesh(mesh.nodes, cells, point_sets=sets, cell_sets={"all": [np.array([0])]}).write(
        path, file_format="abaqus"
    )


def of_files(folder: Path) -> Path:
    """Write a scenario whose bodies are from files in a separate folder, and one elsewhere based on it."""
    (folder / "sub").mkdir()
    write_squares(folder / "sub" / "ring.inp")
    write_cube(folder / "sub" / "cube.inp")
    (folder / "sub" / "base.toml").write_text(
        """
        friction = 0.3
        [bodies.cube]
        kind = "solid"
        mesh = { shape = "file", file = "cube.inp", scale = "1 mm" }
        materials = { all = { young = "210 GPa", density = 7800 } }
        points = { foot = "corner" }
        cutoff = "100 kHz"
        damping = "1 %"
        [bodies.ring]
        kind = "axisymmetric"
        profile = { shape = "mesh", file = "ring.inp", scale = "1 mm", plane = "xz" }
        material.low = { young = "110 GPa", density = 7100, poisson = 0.28 }
        material.body = { young = "210 GPa", density = 7800 }
        cutoff = "40 kHz"
        held = ["shaft"]
        [[contacts]]
        tip = { body = "cube", point = "foot" }
        track = { kind = "point", body = "ring", point = ["40 mm", 0.0, "20 mm"] }
        normal = [0.0, 0.0, 1.0]
        surface_velocity = 0.5
        [[drives]]
        kind = "force"
        body = "cube"
        point = "foot"
        z = -20
        [simulation]
        duration = "1 ms"
        step = "1 us"
        """,
        encoding="utf-8",
    )
    path = folder / "case.toml"
    path.write_text('base = "sub/base.toml"\n[bodies.ring]\ndamping = "0.5 %"\n', encoding="utf-8")
    return path


def test_meshes_are_found_beside_the_scenario_that_names_them(tmp_path):
    system = st.load_scenario(of_files(tmp_path)).system
    cube, ring = system.bodies
    profile = st.MeshProfile.read(tmp_path / "sub" / "ring.inp", 1e-3, "xz")
    assert ring.profile == profile
    assert ring.held == (st.Held("shaft"),)
    assert ring.materials == {"low": IRON, "body": STEEL}
    assert cube.mesh == st.SolidMesh.read(tmp_path / "sub" / "cube.inp", 1e-3)
    assert cube.total_mass == pytest.approx(7800.0 * 0.02**3)


def test_a_record_of_meshed_bodies_runs_again_without_their_files(tmp_path):
    path = of_files(tmp_path)
    record = st.load_scenario(path).simulate()
    st.save(record, tmp_path / "run.nc")
    for file in (tmp_path / "sub").iterdir():
        file.unlink()
    again = st.load_scenario(tmp_path / "run.nc")
    assert {body.kind for body in again.system.bodies} == {"modal body"}
    repeated = again.simulate()
    assert repeated.attrs["scenario"] == record.attrs["scenario"]
    xr.testing.assert_equal(repeated.drop_attrs(), record.drop_attrs())
    onwards = again.simulate(duration=1e-3, start=record)
    assert onwards.time.values[0] > record.time.values[-1]
    with pytest.raises(st.ScenarioError, match="base must be a scenario file"):
        st.load_scenario(path)


def test_a_sweep_takes_meshes_along_and_reads_them_once(tmp_path):
    path = of_files(tmp_path)
    found = st.sweep(path, {"friction": [0.1, 0.3]}, ["mean_force"], duration="1 ms")
    assert np.isfinite(found.mean_force.values).all()
    assert ".inp" not in found.attrs["scenario"]
    filled = with_matrices(read_tables(path), read_tables(path))
    (tmp_path / "filled.toml").write_text(tomli_w.dumps(filled), encoding="utf-8")
    assert st.load_scenario(tmp_path / "filled.toml").system == st.load_scenario(path).system
    for key in ("bodies.ring.profile.scale", "cube.mesh.file"):
        with pytest.raises(st.ScenarioError, match=rf"key must not be bodies.*: meshes are read once .* got '{key}'"):
            st.sweep(path, {key: ["1 mm", "2 mm"]}, ["mean_force"])
    cutoffs = st.sweep(path, {"ring.cutoff": ["40 kHz", "50 kHz"]}, ["mean_force"], duration="1 ms")
    assert np.isfinite(cutoffs.mean_force.values).all()


def test_a_text_may_not_name_meshes():
    text = '[bodies.a]\nkind = "solid"\nmesh = { shape = "file", file = "/etc/passwd" }\n'
    with pytest.raises(st.ScenarioError, match=r"bodies must not name files in a text, got '/etc/passwd'"):
        tables_of_text(text, "text")


# Errors.

BAD_DISCS = {
    "a rectangle inside out": ({"profile.outer": "2 cm"}, "bodies.disc.profile.outer must be above inner, 0.03 m, got"),
    "a flat one": ({"profile.top": -0.01}, "bodies.disc.profile.top must be above bottom, -0.01 m, got -0.01"),
    "across the axis": ({"profile.inner": -0.01}, "bodies.disc.profile.inner must be 0 or above, got -0.01"),
    "a line across the axis": (
        {"profile": {"shape": "line", "points": [[0.0, 0.0], [-0.1, 0.0]], "thickness": 0.01}},
        "bodies.disc.profile.points and thickness must not cross the axis: r >= 0, got r = -0.1 m",
    ),
    "a line across itself": (
        {
            "profile": {
                "shape": "line",
                "points": [[0.1, 0.0], [0.2, 0.0], [0.2, 0.1], [0.15, 0.1], [0.15, -0.1]],
                "thickness": 0.01,
            }
        },
        "bodies.disc.profile.points and thickness must not cross or touch itself",
    ),
    "rectangles apart": (
        {
            "profile": {
                "shape": "rectangles",
                "rectangles": [
                    {"inner": 0.1, "outer": 0.2, "bottom": 0.0, "top": 0.1},
                    {"inner": 0.3, "outer": 0.4, "bottom": 0.0, "top": 0.1},
                ],
            }
        },
        "bodies.disc.profile.rectangles must be in one piece",
    ),
    "one of several inside out": (
        {
            "profile": {
                "shape": "rectangles",
                "rectangles": [
                    {"inner": 0.1, "outer": 0.2, "bottom": 0.0, "top": 0.1},
                    {"inner": 0.3, "outer": 0.2, "bottom": 0.0, "top": 0.1},
                ],
            }
        },
        "bodies.disc.profile.rectangles.1.outer must be above inner, 0.3 m, got 0.2",
    ),
    "no file": (
        {"profile": {"shape": "mesh", "file": "none.msh"}},
        "none.msh': no such file or directory",
    ),
    "another file": (
        {"profile": {"shape": "mesh", "file": "case.toml"}},
        "bodies.disc.profile.file must be a file of a mesh, got '",
    ),
    "another shape": (
        {"profile": {"shape": "rectangel"}},
        "bodies.disc.profile.shape must be one of rectangle, rectangles, line, mesh, cells, got 'rectangel'; "
        "did you mean 'rectangle'?",
    ),
    "too many cells": ({"profile.size": 1e-9}, "bodies.disc.profile.size must leave at most 10000 cells"),
    "an unknown place": (
        {"held": ["inner", "rim"]},
        "bodies.disc.held.1 must be one of inner, outer, bottom, top, got 'rim'",
    ),
    "an empty box": (
        {"held": [{"place": {"inner": 0.5, "outer": 0.6, "bottom": 0.0, "top": 0.1}}]},
        "bodies.disc.held.0 must hold a side of a cell or more, got none at ((0.5, 0.6), (0.0, 0.1))",
    ),
    "a box inside out": (
        {"held": [{"place": {"inner": 0.5, "outer": 0.4, "bottom": 0.0, "top": 0.1}}]},
        "bodies.disc.held.0.place.outer must not be below inner, 0.5 m, got 0.4",
    ),
    "half a box": ({"held": [{"place": {"inner": 0.5}}]}, "bodies.disc.held.0.place.outer must be given: largest"),
    "an unknown direction": (
        {"held": [{"place": "inner", "directions": ["x"]}]},
        "bodies.disc.held.0.directions must be one of r, theta, z or a list of them, got ['x']",
    ),
    "an unknown region": (
        {"material": {"hub": METAL}},
        "bodies.disc.material must be one of body, got 'hub'",
    ),
    "a bad material of a region": (
        {"material": {"body": METAL | {"young": -1.0}}},
        "bodies.disc.material.body.young must be above 0, got -1.0",
    ),
    "half a material": ({"material": {"young": 1e11}}, "bodies.disc.material.density must be given: mass density"),
    "no mode": ({"cutoff": "10 Hz", "held": ["inner"]}, "bodies.disc.cutoff must leave at least one mode (first at "),
    "a place outside": ({"residual_at": [[0.5, 0.0]]}, "bodies.disc.residual_at.0 must be (r, z) in the profile, got"),
    "half a place": ({"residual_at": [[0.5]]}, "bodies.disc.residual_at.0 must be (r, z), two distances, got [0.5]"),
    "no axis": ({"axis": [0.0, 0.0, 0.0]}, "bodies.disc.axis must be a direction, of a length above 0"),
    "another unit": ({"origin": ["1 s", 0, 0]}, "bodies.disc.origin.0 must be a number in m, cm, mm or um, got '1 s'"),
    "a wrong key": ({"materials": METAL}, "bodies.disc.materials must be one of the known keys"),
}


@pytest.mark.parametrize(("changes", "message"), BAD_DISCS.values(), ids=BAD_DISCS)
def test_errors_of_a_body_of_revolution_are_explained(changes, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    disc = {"profile": dict(RING), "material": METAL, "cutoff": 5e3}
    for key, value in changes.items():
        *tables, last = key.split(".")
        (disc[tables[0]] if tables else disc)[last] = value
    assert message in told(on_disc, disc, tmp_path)


BAD_SOLIDS = {
    "an unknown face": (
        {"fixed": ["tpo"]},
        "bodies.a.fixed must be one of left, right, bottom, top, back, front, got 'tpo'; did you mean 'top'?",
    ),
    "an unknown direction": (
        {"fixed": {"top": "w"}},
        "bodies.a.fixed.top must be directions of x, y and z, such as 'xz', got 'w'",
    ),
    "a number that is fixed": (
        {"fixed": [3]},
        'bodies.a.fixed must be a list of names, or directions by name, such as {top = "xz"}, got [3]',
    ),
    "tonnes and millimetres": (
        {"materials": {"young": 2.1e11, "density": 7.8e-9}},
        "bodies.a.materials must carry waves of at most 30 km/s, got 5.189e+06 km/s from young=2.1e+11 and "
        "density=7.8e-09: give Pa and kg/m³, not tonnes and millimetres",
    ),
    "an unknown group": ({"materials": {"steel": METAL}}, "bodies.a.materials must be one of none, got 'steel'"),
    "a point beside": ({"points": {"p": [1, 2, 3]}}, "bodies.a.points.p must be within "),
    "a point in a plane": (
        {"points": {"p": [1, 2]}},
        "bodies.a.points.p must be three distances, along x, y and z, got [1, 2]",
    ),
    "no such node": ({"points": {"p": 99}}, "bodies.a.points.p must be at most 19, got 99"),
    "no such set": ({"points": {"p": "q"}}, "bodies.a.points.p must be one of none, got 'q'"),
    "no file": ({"mesh": {"shape": "file", "file": "none.msh"}}, "none.msh': no such file or directory"),
    "another file": ({"mesh": {"shape": "file", "file": "case.toml"}}, "bodies.a.mesh.file must end in .inp, .bdf, "),
    "another shape": (
        {"mesh": {"shape": "ring"}},
        "bodies.a.mesh.shape must be one of block, sector, extrusion, file, elements, tied, got 'ring'",
    ),
    "two lengths": (
        {"mesh": CUBE | {"lengths": [1, 2]}},
        "bodies.a.mesh.lengths must be three lengths, got [1, 2]",
    ),
    "too many elements": (
        {"mesh": CUBE | {"divisions": [20000, 20000, 20000]}},
        "bodies.a.mesh.divisions must make at most 200000 nodes",
    ),
    "radii that fall": (
        {"mesh": MESHES["sector"][0] | {"radii": [0.2, 0.1]}},
        "bodies.a.mesh.radii must increase, got (0.2, 0.1)",
    ),
    "nothing free": (
        {"fixed": ["left", "right", "bottom", "top", "back", "front"]},
        "bodies.a.fixed must leave something free, got all nodes held",
    ),
    "dampings of other modes": ({"damping": [0.1, 0.2]}, "bodies.a.damping must "),
}


@pytest.mark.parametrize(("changes", "message"), BAD_SOLIDS.values(), ids=BAD_SOLIDS)
def test_errors_of_a_solid_are_explained(changes, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    body = {"mesh": CUBE, "materials": METAL, "points": {"p": 0}, **changes}
    assert message in told(with_solid, body, tmp_path)


@pytest.mark.parametrize(
    ("point", "message"),
    [
        (0.15, "contacts.0.track.point must be three numbers, (r, theta, z), got 0.15"),
        ([0.05, 0.1], "contacts.0.track.point must be three numbers, (r, theta, z), got (0.05, 0.1)"),
        ([0.05, 0.0, 0.1], "contacts.0.track.point must be (r, theta, z) in the profile, got (0.05, 0.0, 0.1)"),
        (
            [0.05, "1 m", 0.0],
            "contacts.0.track.point must be (r, theta, z), two distances and an angle between them, one of which must "
            "be a number in rad or deg, got [0.05, '1 m', 0.0]",
        ),
        ("rim", "contacts.0.track.point must be a position, got 'rim'"),
        (None, "contacts.0.track.point must be given: a position, as the body has no named points"),
    ],
)
def test_a_missing_point_is_reported(point, message, tmp_path):
    disc = {"profile": RING, "material": METAL, "cutoff": 5e3}
    on_disc(disc, tmp_path)
    tables = read_tables(tmp_path / "case.toml")
    track = tables["contacts"][0]["track"]
    track |= {"point": point}
    tables["contacts"][0]["track"] = {key: value for key, value in track.items() if value is not None}
    assert message in told(loaded, tables, tmp_path)


# Keys.


def test_entries_of_lists_are_keys():
    case = st.load_scenario(
        "pin-on-disc",
        {"lengths.1": "140 mm", "contacts.2.track.point.0": 0.1621, "residual_at.2.0": 0.1621, "divisions.1": 14},
    )
    pin, disc = case.system.bodies
    assert pin.mesh == st.SolidMesh.block((0.01, 0.14, 0.01), (2, 14, 2)).quadratic()
    assert case.system.contacts[2].track == disc.at((0.1621, math.radians(-94.0), 0.0))
    assert disc.residual_at[2] == (0.1621, 0.0)
    with pytest.raises(st.ScenarioError, match=r"key must be a key of the scenario, got 'lengths\.3'"):
        st.load_scenario("pin-on-disc", {"lengths.3": "140 mm"})


def test_the_schema_describes_both_and_every_key_is_shown():
    schema = json.loads(json.dumps(st.scenario_schema()))
    for name in ("AxisymmetricBody", "SolidBody"):
        properties = schema["$defs"][name]["properties"]
        assert all(entry.get("description") for entry in properties.values())
    shown = st.scenario_text("pin-on-disc")
    assert 'inner = "8 mm"                    # smallest distance from the axis [m]' in shown
    assert 'lengths = ["10 mm", "149 mm", "10 mm"]  # sides along x, y and z from the origin [m]' in shown


def test_the_command_line_runs_and_refuses_them(stridula):
    code, out, _ = stridula("stability", "pin-on-disc")
    assert code == 0
    assert "2272." in out
    assert "1 mode grows" in out
    assert stridula("run", "pin-on-disc", "--duration", "1 ms")[0] == 0
    assert stridula("show", "pad-on-disc")[0] == 0
    code, _, error = stridula("run", "pin-on-disc", "--set", 'bodies.pin.fixed=["tpo"]')
    assert code == 2
    assert "bodies.pin.fixed must be one of left, right" in error
    assert "Traceback" not in error
