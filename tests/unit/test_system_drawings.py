"""Drawings of systems before their run: places, directions and labels."""

from __future__ import annotations

import dataclasses
import re

import numpy as np
import pytest
from matplotlib.text import Annotation

import stridula as st
from stridula import plot
from stridula.bodies import ModalBeam, SolidBody
from stridula.linear.structure import Structure
from stridula.plot import slidings, symbols
from stridula.plot.plane_drawings import clustered, spoken_small, thickness_of

STEEL = st.Material(2.1e11, 7800.0, 0.3)
MASS = st.PointMass(2.0, name="block")


def on_belt(track=None, drives=(), **options):
    contact = st.PointContact(MASS.centre, st.RigidTrack(velocity=0.5) if track is None else track, **options)
    return st.System(contact, drives)


def said(figure) -> list[str]:
    """Return all texts of a figure."""
    words = [text.get_text() for axes in figure.axes for text in axes.texts]
    words += [axes.get_title("left") for axes in figure.axes] + [text.get_text() for text in figure.texts]
    return words + [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def arrows(figure, colour) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return tail and head of each arrow of a colour."""
    found = [one for one in figure.axes[0].texts if isinstance(one, Annotation) and one.arrowprops]
    mine = [one for one in found if one.arrowprops["color"] == colour and one.xycoords == "data"]
    return [(np.array(one.xyann), np.array(one.xy)) for one in mine]


PLANE = ("squeal", "belt", "lugre", "weak-pressure", "squeal-on-plate", "violin")


@pytest.mark.parametrize("name", PLANE)
def test_prescribed_sliding_is_that_of_linear_theory(name):
    system = st.load_scenario(name).system
    structure = Structure(system, 0.0)
    for number, contact in enumerate(system.contacts):
        found = slidings.sliding_of(contact, system)
        rate = float(structure.rates[0, number])
        if rate:
            np.testing.assert_allclose(found.way, np.sign(rate) * contact.frame[1], atol=1e-12)
            assert found.words == f"{abs(rate):.4g} m/s"
        else:
            pushed = sum(drive.push[2][:2] for drive in system.drives if drive.push) @ contact.frame[1]
            np.testing.assert_allclose(found.way, np.sign(pushed) * contact.frame[1], atol=1e-12)
            assert found.words == ""


@pytest.mark.parametrize("name", ["wheel", "glass", "pin-on-disc"])
def test_prescribed_sliding_in_space_is_that_of_linear_theory(name):
    system = st.load_scenario(name).system
    structure = Structure(system, 0.0)
    contact = system.contacts[0]
    found = slidings.sliding_of(contact, system)
    way = structure.ways[0] @ contact.frame[1:]
    np.testing.assert_allclose(found.way, np.sign(structure.rates[0, 0]) * way, atol=1e-9)
    assert found.words == f"{abs(structure.rates[0, 0]):.4g} m/s"


def test_a_start_and_a_weight_say_where_a_tip_slides():
    still = st.RigidTrack()
    started = on_belt(still, [st.InitialVelocity(MASS, x=-0.2)])
    found = slidings.sliding_of(started.contacts[0], started)
    assert (found.way[0], found.words) == (-1.0, "0.2 m/s at the start")
    leaning = on_belt(still, [st.Gravity()], inclination=0.3)
    np.testing.assert_allclose(slidings.sliding_of(leaning.contacts[0], leaning).way, [-np.cos(0.3), -np.sin(0.3)])
    flat = on_belt(still, [st.Gravity()])
    assert slidings.sliding_of(flat.contacts[0], flat) is None


@pytest.mark.parametrize("name", PLANE)
def test_no_modes_are_computed(name, monkeypatch):
    system = st.load_scenario(name).system

    def modes(*_, **__):
        raise AssertionError("modes were asked for")

    for body in system.bodies:
        monkeypatch.setattr(type(body), "modes", modes)
    figure = plot.system(system, title=name)
    (axes,) = figure.axes
    assert axes.get_aspect() == 1.0
    assert axes.get_xlabel().endswith("[m]")
    assert axes.get_ylabel() == "y [m]"
    names = [system.body_name(body) for body in system.bodies]
    text = "\n".join(said(figure))
    assert names[0] in text
    assert names[-1] in text


def test_arrows_are_where_forces_and_velocities_are_and_point_their_way():
    system = st.load_scenario("weak-pressure").system
    figure = plot.system(system)
    root = system.slider.root
    place = plot.plane_drawings.places_in(system)(root)
    ((tail, head),) = arrows(figure, plot.plane_drawings.FORCE)
    np.testing.assert_allclose(head, place)
    np.testing.assert_allclose((head - tail) / np.linalg.norm(head - tail), [0.0, -1.0], atol=1e-12)
    ((tail, head),) = arrows(figure, plot.plane_drawings.VELOCITY)
    np.testing.assert_allclose(tail, place)
    assert head[0] > tail[0]
    words = said(figure)
    assert "2 N" in words
    assert words.count("0.01 m/s") == 2, "of the root and of the slip"
    assert "contact: friction 1.2, gap 10.22 µm" in words


def test_a_surface_has_one_line_with_the_range_of_its_gaps():
    """The points of a curved face on a mesh have gaps that differ in the last digits."""
    steel, sectors = st.Material(young=210e9, density=7800.0), ((0.05, 0.0599), (0.06, 0.07))
    meshes = [st.SolidMesh.sector(radii, (-0.3, 0.3), 0.02, (1, 3 + k, 1), axis="z") for k, radii in enumerate(sectors)]
    shoe, drum = (
        st.SolidBody(mesh, steel, cutoff=2e4, name=name) for mesh, name in zip(meshes, ("shoe", "drum"), strict=True)
    )
    face = st.SurfaceContact(shoe, "outer", drum, "inner", friction=st.Coulomb(0.3), stiffness=1e12, name="lining")
    words = said(plot.system(st.System(face, [st.Force(shoe.at("inner"), x=1.0)])))
    (line,) = [one for text in words for one in text.splitlines() if one.startswith("lining")]
    found = re.fullmatch(r"lining, 12 points: friction 0.3, gap ([\d.]+) µm to ([\d.]+) µm", line)
    assert found is not None, line
    gaps = sorted(1e6 * one.gap for one in face.contacts)
    assert [float(one) for one in found.groups()] == pytest.approx([gaps[0], gaps[-1]], rel=1e-3)


def test_bodies_are_as_thick_as_they_are():
    section = st.Section(1e-4, 1e-4 * 0.01**2 / 12.0)
    beam = st.ModalBeam(STEEL, section, 0.5, bending_modes=2, axial_modes=0)
    assert thickness_of(beam) == pytest.approx(0.01)
    rod = st.FiniteElementBeam(STEEL, st.Circle(0.02), 0.3, root_support="clamped", tip_support="free")
    plate = st.ModalPlate(STEEL, 0.003, 0.6, 0.4, bending_modes=(1, 1))
    assert (thickness_of(rod), thickness_of(plate), thickness_of(MASS)) == (0.02, 0.003, 0.0)
    system = st.System(st.PointContact(rod.tip, beam, at=0.2), [st.Gravity()])
    figure = plot.system(system)
    upright, lying = (patch.get_path().vertices for patch in reversed(figure.axes[0].patches[:2]))
    assert np.ptp(upright, axis=0) == pytest.approx([0.02, 0.3])
    assert np.ptp(lying, axis=0) == pytest.approx([0.5, 0.01])
    words = said(figure)
    assert {"clamped end", "pinned end", "gravity 9.807 m/s²"} <= set(words)
    assert "guided end" not in words


def test_equal_neighbouring_symbols_are_drawn_once():
    figure = plot.system(st.load_scenario("violin").system)
    words = said(figure)
    assert "0.22 N, each of 5" in words
    assert "spring 3.4 kN/m, each of 5" in words
    assert "hair 1 to hair 5" in words
    assert len(arrows(figure, plot.plane_drawings.FORCE)) == 1
    things = [(k, "kind", "words", np.array([0.1 * k, 0.0])) for k in range(4)]
    assert [one.things for one in clustered(things, 0.15)] == [[0, 1], [2, 3]]


def test_symbols_begin_and_end_where_they_should():
    start, end = np.array([1.0, 2.0]), np.array([1.3, 2.4])
    for lines in (symbols.spring(start, end, 0.05), symbols.dashpot(start, end, 0.05)):
        places = np.concatenate(lines)
        assert np.linalg.norm(places - start, axis=1).min() == pytest.approx(0.0, abs=1e-12)
        assert np.linalg.norm(places - end, axis=1).min() == pytest.approx(0.0, abs=1e-12)
        beside = np.abs((places - start) @ symbols.across((end - start) / 0.5))
        assert beside.max() == pytest.approx(0.025)
    for support in symbols.SUPPORTS.values():
        places = np.concatenate(support(start, np.array([0.0, -1.0]), 0.1))
        assert places[:, 1].max() == pytest.approx(start[1]), "nothing of it is inside the body"
        assert places[:, 1].min() < start[1]


def test_parts_without_a_place_are_listed():
    pair = st.ReducedBody(np.eye(4), np.eye(4) * 1e6, {"tip": (0, 1), "back": (2, 3)}, name="pad")
    contact = st.PointContact(pair.at("tip"), st.RigidTrack(velocity=1.0), friction=st.Coulomb(0.3))
    spring = st.Spring(pair.at("back"), stiffness=1e3)
    words = said(plot.system(st.System(contact, [st.Force(pair.at("back"), y=-5.0)], [spring])))
    assert "spring 1 kN/m, not drawn\ncontact: friction 0.3\npad: force y -5 N at back, constant, not drawn" in words


def test_small_lengths_have_a_prefix():
    assert [spoken_small(one) for one in (1.5, 0.0123, 1.02e-5, 3e-10)] == ["1.5 m", "12.3 mm", "10.2 µm", "0.3 nm"]


@pytest.mark.parametrize("name", ["brake", "glass", "pin-on-disc"])
def test_bodies_in_space_are_drawn_with_arrows_and_names(name, monkeypatch):
    system = st.load_scenario(name).system

    def modes(*_, **__):
        raise AssertionError("modes were asked for")

    for body in system.bodies:
        # Those of rigid bodies are at hand.
        if body.kind != "rigid body":
            monkeypatch.setattr(type(body), "modes", modes)
    figure = plot.system(system, view=(0.3, 0.2))
    figure.draw_without_rendering()
    words = said(figure)
    for body in system.bodies:
        assert any(one.startswith(system.body_name(body)) for one in words)
    assert {"contact", "normal of a contact", "force"} <= set(words)
    assert any(one.startswith("x, y and z: ") for one in words)
    # All drawn parts lie in the box.
    (axes,) = figure.axes
    lines = np.concatenate([np.column_stack(line.get_data_3d()) for line in axes.get_lines()])
    x, y, _ = plot.scenes.proj3d.proj_transform(*lines.T, axes.get_proj())
    at = figure.transFigure.inverted().transform(axes.transData.transform(np.stack([x, y], axis=1)))
    left, low, width, height = plot.space_sketches.ROOM
    assert (at > [left, low]).all()
    assert (at < [left + width, low + height]).all()
    assert np.ptp(at, axis=0).max() > 0.5 * min(width, height)


@pytest.mark.parametrize("wrong", [None, MASS, "squeal"])
def test_other_objects_are_refused(wrong):
    with pytest.raises(ValueError, match="system must be a System"):
        plot.system(wrong)


def test_a_system_in_space_without_surfaces_is_refused():
    lump = st.RigidBody(1.0)
    system = st.System(st.PointContact(lump.centre, st.RigidTrack()))
    with pytest.raises(ValueError, match="whose surface is drawn"):
        plot.system(system)
    block = SolidBody.block((0.04, 0.01, 0.02), (2, 1, 1), STEEL, cutoff=30e3, name="block")
    beam = ModalBeam(STEEL, st.Circle(0.01), 0.5, plane=((1, 0, 0), (0, 1, 0)), name="beam")
    joined = st.System(st.PointContact(block.at((0.02, 0.0, 0.01)), beam, at=0.2))
    assert any("not drawn, as their places are not known: beam" in one for one in said(plot.system(joined)))


def test_the_command_line_draws_a_system(stridula, tmp_path):
    code, out, err = stridula("show", "belt", "--plot", "belt.png")
    assert (code, out, err) == (0, "belt.png\n", "")
    assert (tmp_path / "belt.png").read_bytes().startswith(b"\x89PNG")
    assert stridula("show", "belt", "--plot", "again.svg", "--out", "belt.toml")[0] == 0
    assert {path.name for path in tmp_path.iterdir()} == {"belt.png", "again.svg", "belt.toml"}
    code, _, err = stridula("show", "belt", "--plot", "belt.xyz")
    assert code == 2
    assert "--plot must end in one of" in err


def test_the_motion_of_a_track_is_labelled():
    shaken = dataclasses.replace(st.RigidTrack(velocity=0.5), normal_velocity=-0.1, normal_history=st.Harmonic(50.0))
    words = said(plot.system(on_belt(shaken)))
    assert {"track 0.5 m/s", "track 0.1 m/s, harmonic"} <= set(words)
