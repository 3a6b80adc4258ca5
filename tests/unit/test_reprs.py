"""Texts of objects with arrays or many parts: short, and no part of what a record keeps."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st

STEEL, LINING = st.Material(2.1e11, 7800.0, 0.3), st.Material(5e9, 2500.0, 0.3)


def disc(turning=30.0):
    profile = st.RectangleProfile({"disc": ((0.05, 0.15), (0.0, 0.01))})
    return st.AxisymmetricBody(profile, STEEL, 3e3, "inner", axis=(0.0, 1.0, 0.0), turning=turning, name="disc")


def slid():
    mass = st.PointMass(1.0, name="mass")
    return st.System(st.PointContact(mass.centre, st.RigidTrack(1.0)), [st.Force(mass.centre, y=-1.0)])


def braked(divisions=(2, 1, 2), above=0.0):
    """Return a pad held by many springs over a turning disc, at a height above it."""
    mesh = st.SolidMesh.block((0.03, 0.015, 0.02), divisions).moved((0.095, 0.01 + above, -0.01))
    pad = st.SolidBody(mesh, LINING, cutoff=2e4, contact_faces=["bottom"], name="pad")
    face = st.SurfaceContact(pad, "bottom", disc(), friction=st.Coulomb(0.3), stiffness=5e11, name="lining")
    springs = [
        st.Spring(pad.at(place), stiffness=1e7, direction=way)
        for place in pad.face_points("top").place[::3].tolist()
        for way in "xyz"
    ]
    return st.System(face, [st.Force(pad.at("top"), y=-200.0)], springs)


def test_a_system_has_a_line_for_each_body_and_surface():
    system = braked()
    lines = repr(system).splitlines()
    assert len(lines) < 15
    assert lines[1].startswith("  pad: solid, 0.03 x 0.015 x 0.02 m")
    assert lines[3] == "  lining: surface of 16 points, pad on disc, friction 0.3"
    assert sum("spring" in line for line in lines) == 6
    assert "  and 12 other connections" in lines
    # As points without their surface, as from a record, there is still one line.
    points = st.System(system.contacts, system.drives, system.connections)
    assert repr(points) == repr(system)
    (face,) = (line for line in str(points).splitlines() if "lining" in line)
    assert face == "lining   16 points, gap 0 m, friction 0.3"


def test_the_text_of_a_system_needs_no_modes():
    mesh = st.SolidMesh.block((0.03, 0.015, 0.02), (8, 4, 6))
    pad = st.SolidBody(mesh, LINING, cutoff=1.71e4, name="pad")
    assert "found on first use" in repr(st.System(st.PointContact(pad.at((0.0, 0.0, 0.0)), st.RigidTrack(1.0))))
    assert not pad.has_modes_at_hand


MANY = {f"point {k}": np.ones((3, 40)) for k in range(200)}
SHOWN = {
    "Face": lambda pad, turning: pad.face("bottom"),
    "SurfaceContact": lambda pad, turning: braked().contact,
    "Modes": lambda pad, turning: pad.modes(),
    "PointSurface": lambda pad, turning: pad.surface(),
    "RingSurface": lambda pad, turning: turning.surface(),
    "DrawnSurface": lambda pad, turning: pad.drawn,
    "DrawnRings": lambda pad, turning: turning.drawn,
    "Turning": lambda pad, turning: turning.modes().turning,
    "ModalBody": lambda pad, turning: st.ModalBody(np.arange(40.0), MANY, name="many"),
    "Sampled": lambda pad, turning: st.Sampled(np.arange(2000.0), np.arange(2000.0)),
    "PlainRecord": lambda pad, turning: st.simulate_many([slid()], 1e-3, labelled=False)[0],
    "ReducedBody": lambda pad, turning: st.ReducedBody(
        np.eye(40), np.eye(40), {name: rows[:2] for name, rows in MANY.items()}
    ),
}


@pytest.mark.parametrize("name", SHOWN)
def test_the_text_of_arrays_is_one_short_line(name):
    text = repr(SHOWN[name](*braked().bodies))
    assert text.startswith(f"{name}(")
    assert "\n" not in text
    assert "array" not in text
    assert len(text) < 320


def test_a_short_history_is_written_out():
    assert repr(st.Sampled((0.0, 1.0), (2, 3.0))) == "Sampled(time=(0.0, 1.0), value=(2.0, 3.0))"
    assert repr(st.Sampled(np.arange(20.0), np.ones(20))) == "Sampled(20 points from 0.0 to 19.0 s)"


def test_texts_of_modes_and_faces_count_them():
    pad = braked().bodies[0]
    assert repr(pad.face("bottom")) == "Face(4 faces of elements, 0.0006 m²)"
    assert repr(pad.modes()) == "Modes(9 modes to 1.797e+04 Hz and 45 residual shapes)"
    assert repr(st.Modes(np.array([0.0]), np.zeros(1), np.ones((2, 1)))) == "Modes(1 mode to 0 Hz)"


def test_a_record_is_the_same_whatever_the_texts(monkeypatch):
    mass = st.ModalBody([0.0, 300.0], {"tip": [[1.0, 0.5], [0.0, 1.0]]}, name="mass")
    system = st.System(st.PointContact(mass.at("tip"), st.RigidTrack(1.0)), [st.Force(mass.at("tip"), y=-1.0)])
    before = st.simulate(system, 1e-3).attrs["scenario"]
    for kind in (st.System, st.ModalBody, st.Modes):
        monkeypatch.setattr(kind, "__repr__", lambda self: "another text")
    assert st.simulate(system, 1e-3).attrs["scenario"] == before
