"""Systems in space on the page: sound, messages, drawings and their cost."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.app import drawing_space, thinned
from stridula.app.drawing import drawing_of
from stridula.app.instrument import Instrument
from stridula.app.now import heard, said
from stridula.app.parts import Part
from stridula.app.playable import IN_SPACE, playable
from stridula.bodies.drawn_surfaces import DrawnSurface, drawn_table
from stridula.scenarios import ScenarioError
from stridula.scenarios.show import scenario_text

from .conversation import RATE, parts_of
from .scripting import result_of

# A body in the page's own scripts, and its corners for some modal values.
MOVED = """import { Body } from "./surfaces.js";
result = given.map(({ described, numbers, rates, steady }) => {
  const body = new Body(described);
  const most = body.move(numbers, rates, steady);
  const { departed, velocity, mean, source, index, edges } = body;
  const touching = body.rows.shape[0] ? body.touching(0, [1, 2, 3], 10, steady) : null;
  const { place } = body.surface;
  const arrays = Object.entries({ departed, velocity, mean, source, index, edges, place });
  return { most, touching, ...Object.fromEntries(arrays.map(([name, one]) => [name, Array.from(one)])) };
});"""
FINE = """
[bodies.block]
kind = "solid"
mesh = { shape = "block", lengths = [0.1, 0.1, 0.1], divisions = [30, 30, 30] }
materials = { young = 2e11, density = 7800.0, poisson = 0.3 }
cutoff = 1e4

[bodies.ball]
kind = "rigid body"
mass = 1.0

[[contacts]]
tip = { body = "ball" }
track = { kind = "point", body = "block", point = [0.05, 0.1, 0.05] }
normal = [0.0, 1.0, 0.0]
"""


@pytest.mark.parametrize("case", IN_SPACE)
def test_every_system_in_space_is_played_and_drawn(talk, case):
    scene = talk.scene(case)
    assert scene["type"] == "scene"
    assert scene["speed"] > 0.0
    assert scene["turned"]["controls"]
    samples = 480 if case in ("glass", "wheel") else 24
    played = talk.play(samples)
    assert np.isfinite(played.sound).all()
    numbers = sum(body["numbers"] for body in scene["surfaces"])
    for part in played.parts:
        assert part.slider.size == 0
        assert part.track.shape == (2 * numbers,)
        assert part.contacts.shape == (len(scene["touches"]), 2)
    assert np.abs(played.parts[-1].track).max() > 0.0
    names = {body["name"]: body for body in scene["surfaces"]}
    for touch in scene["touches"]:
        rows = heard(names[touch["body"]]["rows"])
        assert rows[touch["row"]].shape == (3, names[touch["body"]]["numbers"])
    assert 0.0 < scene["seconds_kept"] <= 10.0
    # Small enough to be sent again when bodies change.
    assert len(str(scene)) < 3_000_000


def test_bodies_already_drawn_are_not_sent_again(talk):
    first = talk.scene("glass")
    again = talk.scene("glass", {"contacts.0.friction.kinetic": 0.31})
    assert again["drawn"] == first["drawn"]
    assert again["goes_on"]
    assert not {"surfaces", "touches", "up"} & set(again)
    other = talk.scene("glass", {"bodies.glass.material.young": 8e10})
    assert other["drawn"] != first["drawn"]
    assert {"surfaces", "touches", "up"} <= set(other)
    assert "drawn" not in talk.scene("belt")
    assert "surfaces" in talk.scene("glass")


def test_a_text_in_space_is_played_as_it_is_described(talk):
    scene = talk.scene(text=scenario_text("glass"))
    assert scene["type"] == "scene"
    # Its bodies are not replaced by lists of shapes.
    assert 'shape = "line"' in scene["toml"]
    assert len(scene["toml"]) < 5000
    assert talk.scene("glass")["toml"] == scene["toml"]


def test_the_scenario_of_the_page_runs_the_same(tmp_path):
    played = playable("brake", None, {"surfaces.*.friction.coefficient": 0.5})
    file = tmp_path / "scenario.toml"
    file.write_text(played.toml, encoding="utf-8")
    assert st.load_scenario(file).system == played.system
    assert {contact.friction.coefficient for contact in played.system.contacts} == {0.5}


@pytest.mark.parametrize("case", ["glass", "pin-on-disc"])
def test_the_sound_is_that_of_a_run(case):
    instrument = Instrument(playable(case, None, {}), "probe 1")
    parts = [part for part in instrument.play(480) if isinstance(part, Part)]
    sound = np.concatenate([part.sound for part in parts])
    run = st.load_scenario(case).simulate(duration=0.02, sample_rate=RATE)
    wanted = run.velocity.values[:, 0]
    later = instrument.live.delay
    assert np.abs(wanted[: len(sound)]).max() > 0.0
    assert np.allclose(sound[later:], wanted[: len(sound) - later], rtol=0.0, atol=1e-9)


@pytest.mark.parametrize("case", ["glass", "pin-on-disc", "brake"])
def test_controls_change_loads_and_friction_first_and_no_mesh(case):
    before = playable(case, None, {})
    controls = before.turned.controls
    assert controls[0].group == "Friction"
    keys = [control.key for control in controls]
    assert not any(word in key for key in keys for word in ("profile", "mesh", "cutoff", "residual", "origin"))
    quick = [control for control in controls if "material" not in control.key]
    # Each of them has an effect, and none requires modes to be computed again.
    for control in quick[:8]:
        value = before.turned.values[control.key]
        assert control.low * control.scale <= value <= control.high * control.scale
        after = playable(case, None, {control.key: 0.99 * value})
        assert after.turned.values[control.key] == pytest.approx(0.99 * value)
        assert after.system != before.system


def test_the_turning_speed_of_a_glass_is_among_its_drives(talk):
    scene = talk.scene("glass")
    keys = [control["key"] for control in scene["turned"]["controls"]]
    assert keys.index("bodies.glass.turning") < keys.index("bodies.glass.material.young")
    talk.play(480)
    faster = talk.scene("glass", {"bodies.glass.turning": 4.0})
    assert faster["goes_on"]
    assert set(talk.play(480).stroke) == {1}


def test_too_large_bodies_are_refused_before_modes_are_computed():
    with pytest.raises(
        ScenarioError, match=r"block.mesh.divisions must make at most 4000 elements to be played"
    ) as told:
        playable("", FINE, {})
    assert "got [30, 30, 30]" in str(told.value)


def test_slow_systems_are_sent_in_pieces(talk):
    """No request delays other pages for long: slow systems return what is computed quickly."""
    assert talk.scene("brake")["speed"] < 0.5
    talk.say("pull", parts=20, samples=480)
    parts = parts_of(talk.bytes())
    assert 0 < sum(len(part.sound) for part in parts) < 9600
    assert all(len(part.sound) <= 480 for part in parts)


def test_a_record_in_space_opens_like_any_other(talk, tmp_path):
    talk.scene("pin-on-disc")
    talk.play(2400)
    file = tmp_path / "played.nc"
    file.write_bytes(talk.save("nc"))
    record = st.load(file)
    assert record.normal_force.dims == ("time", "contact")
    assert record.tangential_force.dims == ("time", "contact", "tangent")
    assert record.sizes["contact"] == 5
    assert list(record.tangent.values) == ["first", "second"]
    assert st.load_scenario(file).system == st.load_scenario("pin-on-disc").system
    run = st.load_scenario("pin-on-disc").simulate(duration=0.05, sample_rate=RATE)
    assert np.allclose(record.tangential_force, run.tangential_force, rtol=1e-6)


def test_points_of_a_surface_count_as_one_contact_in_the_last_seconds(talk, tmp_path):
    instrument = Instrument(playable("brake", None, {}))
    list(instrument.play(24))
    variables, _ = instrument.last_seconds.moment(1.0)
    assert variables["normal_force"].shape == (24, 2)
    assert variables["status_share"].shape == (24, 2, 3)
    assert variables["normal_force"].mean(axis=0) == pytest.approx([2000.0, 2000.0], rel=0.1)
    # For 64 contacts less than ten seconds are kept.
    assert 0.5 < instrument.last_seconds.seconds < 5.0


def moved_in_python(drawn, numbers):
    return (drawn.swept.shapes @ numbers).ravel()


@pytest.mark.parametrize("case", ["pin-on-disc", "glass"])
def test_the_page_puts_bodies_where_their_modes_do(tmp_path, case):
    system = st.load_scenario(case).system
    drawing = drawing_of(system)
    given, random = [], np.random.default_rng(1)
    for body in drawing.bodies:
        numbers, rates, steady = random.normal(size=(3, body.numbers))
        given.append(
            {
                "described": body.described,
                **{
                    k: v.tolist() for k, v in zip(("numbers", "rates", "steady"), (numbers, rates, steady), strict=True)
                },
            }
        )
    for body, told, found in zip(drawing.bodies, given, result_of(tmp_path, MOVED, given), strict=True):
        numbers, rates, steady = (np.array(told[name]) for name in ("numbers", "rates", "steady"))
        for name, wanted in (("departed", numbers - steady), ("velocity", rates), ("mean", steady)):
            expected = moved_in_python(body.drawn, wanted)
            np.testing.assert_allclose(found[name], expected, atol=1e-5 * np.abs(expected).max())
        assert found["most"] == pytest.approx(np.abs(found["departed"]).max())
        np.testing.assert_allclose(found["place"], body.drawn.swept.place.ravel(), atol=1e-6)
        if found["touching"]:
            wanted = [1, 2, 3] + body.rows[0] @ (steady + 10 * (numbers - steady))
            np.testing.assert_allclose(found["touching"], wanted, rtol=1e-5)


def test_a_block_is_split_along_its_edges(tmp_path):
    pin = next(body for body in drawing_of(st.load_scenario("pin-on-disc").system).bodies if body.name == "pin")
    still = [0.0] * pin.numbers
    (found,) = result_of(
        tmp_path, MOVED, [{"described": pin.described, "numbers": still, "rates": still, "steady": still}]
    )
    place = np.array(found["place"]).reshape(-1, 3)
    corners = place[np.array(found["source"])[np.array(found["index"])]].reshape(-1, 3, 3)
    areas = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    # All of its sides once, each from outside: 10 x 149 x 10 mm.
    assert np.linalg.norm(areas, axis=1).sum() == pytest.approx(2 * 0.01 * 0.01 + 4 * 0.01 * 0.149, rel=1e-5)
    assert (np.linalg.norm(areas, axis=1) > 0.0).all()
    assert np.einsum("ti,ti->", areas, corners.mean(axis=1)) / 3.0 == pytest.approx(0.01 * 0.149 * 0.01, rel=1e-5)
    # Its drawn edges are its twelve edges.
    ends = place[np.array(found["source"])[np.array(found["edges"])]].reshape(-1, 2, 3)
    assert np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1).sum() == pytest.approx(8 * 0.01 + 4 * 0.149, rel=1e-5)


def test_large_surfaces_have_fewer_corners():
    body = st.SolidBody.block((0.1, 0.02, 0.05), (10, 2, 5), st.Material(2e11, 7800.0, 0.3), cutoff=2e4)
    whole = body.drawn
    few = thinned.clustered(whole, 100)
    assert len(few.place) <= 100
    assert few.polygons.max() < len(few.place)
    # Corners are those of the whole surface, and move with it.
    apart = np.linalg.norm(few.place[:, None] - whole.place[None], axis=2)
    nearest = apart.argmin(axis=1)
    assert apart.min(axis=1).max() == 0.0
    assert np.array_equal(few.shapes, whole.shapes[nearest])
    assert np.ptp(few.place, axis=0) == pytest.approx(np.ptp(whole.place, axis=0), rel=0.25)
    assert thinned.clustered(whole, 10_000) is whole


def test_outlines_with_fewer_corners_keep_their_shape():
    glass = next(body for body in st.load_scenario("glass").system.bodies if body.name == "glass").drawn
    few = thinned.with_fewer_corners(glass, 100)
    assert len(few.place) == 100
    assert np.array_equal(np.bincount(few.sides.ravel()), np.full(100, 2))

    def area(rings):
        (r, z), (s, t) = (rings.place[corner].T for corner in rings.sides.T)
        return abs(0.5 * np.sum(r * t - s * z))

    assert area(few) == pytest.approx(area(glass), rel=0.02)
    assert thinned.with_fewer_corners(glass, 10_000).place.shape == glass.place.shape


def test_only_visible_modes_are_kept_of_many(monkeypatch):
    block = st.SolidBody.block((0.1, 0.02, 0.05), (6, 2, 3), st.Material(2e11, 7800.0, 0.3), cutoff=4e4)
    whole = drawing_space._Body("block", block.drawn)
    monkeypatch.setattr(drawing_space, "MOST_NUMBERS", 8 * block.drawn.shapes[..., 0].size)
    few = drawing_space._small(whole)
    assert few.numbers == 8 < whole.numbers
    modal = np.random.default_rng(3).normal(size=whole.numbers)
    missed = few.drawn.shapes @ few.of(modal) - whole.drawn.shapes @ modal
    strengths = np.linalg.svd(whole.drawn.shapes.reshape(-1, whole.numbers), compute_uv=False)
    assert np.linalg.norm(missed) <= strengths[8] * np.linalg.norm(modal) * (1.0 + 1e-9)
    assert np.linalg.norm(missed) > 0.0


def test_the_page_receives_the_whole_surface():
    drawn = DrawnSurface(np.eye(3), np.array([[0, 1, 2]]), np.ones((3, 3, 2)))
    told = drawing_space._Body("plate", drawn).described
    assert {name: heard(told[name]).tolist() for name in drawn_table(drawn)} == {
        name: values.tolist() for name, values in drawn_table(drawn).items()
    }
    assert told["rows"] == said(np.zeros((0, 3, 2)))
