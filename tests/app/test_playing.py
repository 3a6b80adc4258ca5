"""Playing: parts of the stream, continuity at changes, ends of strokes."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.app.playable import PRESETS
from stridula.app.sources import SOURCES

from .conversation import RATE, Conversation, conversation, parts_of

FRICTION, ANGLE, LENGTH, AT = "contact.friction.coefficient", "slider.angle", "slider.length", "contact.at"


@pytest.fixture(scope="module")
def run():
    """Return the first tenth of a second of a squeal as a run computes it."""
    return st.load_scenario("squeal").simulate(duration=0.1, sample_rate=RATE)


@pytest.fixture(scope="module")
def hello(server):
    """Return the greeting of a page."""
    with conversation(server) as talk:
        return talk.until("hello")


def listening(talk: Conversation, source: str, case: str = "squeal", **overrides: float) -> Conversation:
    talk.say("listen", source=source)
    assert talk.scene(case, overrides)["type"] == "scene"
    return talk


def test_the_greeting_names_cases_controls_and_sources(hello):
    assert (hello["version"], hello["rate"]) == (st.__version__, RATE)
    assert {"squeal", "judder", "stable-sliding"} <= {one["name"] for one in hello["presets"]}
    assert all(one["title"] and one["description"] for one in hello["presets"])
    for control in hello["controls"]:
        # Only a friction coefficient has no unit.
        assert bool(control["unit"]) != (control["label"].lower().endswith(("friction", "coefficient")))
        assert control["words"].endswith(".")
        assert "\n" not in control["words"]
        assert control["low"] < control["high"]
        assert 0.0 < control["step"] < control["high"] - control["low"]
        assert control["scale"] > 0.0
    for one in [*hello["controls"], *hello["choices"]]:
        assert one["group"] in hello["groups"]


def test_a_scene_lists_its_sources(talk):
    sources = talk.scene("squeal")["sources"]
    units = {name: source["unit"] for name, source in sources.items()}
    assert units == {"pressure": "Pa", "force": "N", "friction": "N", "acceleration": "m/s²"}
    assert all(source["words"] and source["full_scale"] > 0.0 for source in sources.values())
    assert talk.asks("listen", "problem", source="loudness")["problems"]


def test_every_control_changes_something_in_some_case(hello, talk):
    seen: dict[str, object] = {}
    for preset in PRESETS:
        seen |= talk.scene(preset)["values"]
    seen |= talk.scene("squeal", {"damping": 0.01})["values"]
    for choice in hello["choices"]:
        for kind, begins in choice["begins"].items():
            seen |= talk.scene("squeal", {choice["key"]: kind} | begins)["values"]
    assert set(seen) == {one["key"] for one in [*hello["controls"], *hello["choices"]]}


def test_parts_are_the_run_and_the_pictures_its_means(talk, run):
    played = listening(talk, "force").play(4800)
    assert len(played.parts) == 10
    assert played.sound.max() > 1.0
    assert np.array_equal(played.sound, run.normal_force.values.astype("f4"))
    for name in ("normal_force", "tangential_force"):
        assert np.allclose(getattr(played, name), run[name].values.reshape(-1, 4).mean(axis=1), rtol=1e-6, atol=1e-6)
    assert np.allclose(played.places, run.contact_position.values[3::4], rtol=0.0, atol=1e-8)
    assert np.allclose(played.slip_velocity, run.slip_velocity.values[::4], rtol=1e-6)
    shares = run.status_share.values.reshape(-1, 4, 3).mean(axis=1)
    assert np.array_equal(np.take_along_axis(shares, played.status[:, None], 1)[:, 0], shares.max(axis=1))
    assert [part.clock for part in played.parts] == pytest.approx(0.01 * np.arange(1, 11))
    assert [part.place for part in played.parts] == pytest.approx(run.contact_position.values[479::480], abs=1e-12)
    assert [part.height for part in played.parts] == pytest.approx(run.contact_height.values[479::480], rel=1e-6)
    for part in played.parts:
        assert part.slider.shape == (21, 2)
        assert np.all(part.slider[0] == 0.0)
        assert np.abs(part.slider).max() > 0.0
        assert part.track.shape == (65,)
        assert np.abs(part.track[[0, -1]]).max() < 1e-9
    assert np.abs(played.parts[-1].track).max() > 1e-7


def test_the_acceleration_is_that_of_the_run_a_little_later(talk, run):
    heard = listening(talk, "acceleration").play(4800).sound
    wanted = run.acceleration.values[:, 0].astype("f4")
    later = [late for late in range(200) if np.array_equal(heard[late:], wanted[: len(heard) - late])]
    assert len(later) == 1


def test_the_pressure_is_what_the_forces_radiate(talk, run):
    heard = listening(talk, "pressure").play(4800).sound
    track = st.load_scenario("squeal").system.track
    wanted = st.radiate(run, track, (track.length / 2.0, 0.0, 0.5)).values[:, 0]
    # The low-passes at both ends depend on samples beyond.
    inner = slice(int(np.flatnonzero(wanted)[0]), len(wanted) - 100)
    loudest = np.abs(wanted).max()
    assert loudest > 1e-3
    # The streamed signal is one sample late.
    assert np.abs(heard[1:] - wanted[:-1])[inner].max() < 1e-5 * loudest


@pytest.mark.parametrize("source", ["pressure", "force", "acceleration"])
def test_a_part_does_not_depend_on_the_requested_length(server, source):
    heard = []
    for sizes in ((1920,), (1, 7, 479, 2, 3, 480, 468, 480)):
        with conversation(server) as talk:
            talk.until("hello")
            listening(talk, source)
            heard.append(np.concatenate([talk.play(size).sound for size in sizes]))
    one, other = heard
    assert len(one) == len(other) == 1920
    assert np.allclose(one, other, rtol=1e-5, atol=1e-6 * np.abs(one).max())


def test_another_source_is_heard_at_once_and_without_a_click(server, talk):
    before = listening(talk, "force", "stable-sliding").play(24_000).sound
    with conversation(server) as other:
        other.until("hello")
        wanted = listening(other, "acceleration", "stable-sliding").play(28_800).sound[24_000:]
    talk.say("listen", source="acceleration")
    after = talk.play(4800).sound
    # It starts at the level at which the other ended, which decays within some milliseconds.
    last = before[-1] * SOURCES["acceleration"].full_scale / SOURCES["force"].full_scale
    assert after[0] == pytest.approx(last, rel=1e-3)
    assert np.abs(wanted[0] - last) > 0.01 * last
    assert np.allclose(after[2400:], wanted[2400:], rtol=0.0, atol=1e-4 * before[-1])


def test_a_change_keeps_the_motion_and_comes_back_with_its_number(talk):
    talk.scene("stable-sliding")
    before = talk.play(4800)
    answer = talk.scene("stable-sliding", {FRICTION: 0.45})
    assert (answer["type"], answer["goes_on"], answer["values"][FRICTION]) == ("scene", True, 0.45)
    after = talk.play(4800)
    assert set(before.revision) == {1}
    assert set(after.revision) == {2}
    assert set(after.stroke) == {1}
    assert after.clock[0] == pytest.approx(0.11)
    steps = np.abs(np.diff(np.concatenate([before.places, after.places])))
    assert np.abs(after.places[0] - before.places[-1]) <= 2.0 * steps[1000:].max() < 1e-3
    # A restart jumps, or this test shows nothing.
    talk.say("restart")
    again = talk.play(480)
    assert set(again.stroke) == {2}
    assert np.abs(again.places[0] - after.places[-1]) > 10.0 * steps.max()


@pytest.mark.parametrize(("key", "value"), [(ANGLE, 0.6), (LENGTH, 0.6), ("section.height", 0.007), ("damping", 0.02)])
def test_bodies_change_during_a_run(talk, key, value):
    talk.scene("stable-sliding")
    before = talk.play(4800)
    answer = talk.scene("stable-sliding", {key: value})
    assert answer["goes_on"]
    assert answer["values"][key] == pytest.approx(value)
    after = talk.play(4800)
    assert set(after.stroke) == {1}
    assert np.abs(after.places[0] - before.places[-1]) < 1e-3
    assert np.isfinite(after.sound).all()
    if key in (ANGLE, LENGTH):
        name = key.partition(".")[2]
        assert answer["slider"][name] == pytest.approx(value)


def test_another_case_or_another_kind_of_drive_begins_a_stroke(talk):
    talk.scene("stable-sliding")
    talk.play(480)
    assert not talk.scene("squeal")["goes_on"]
    assert set(talk.play(480).stroke) == {2}
    # An imposed velocity of the root cannot change into a force.
    drawn = talk.scene(
        "squeal", {"drives.0.kind": "imposed velocity", "drives.0.velocity": 0.01, "drives.0.normal_load": 2}
    )
    assert not drawn["goes_on"]
    assert set(talk.play(480).stroke) == {3}


def test_more_friction_turns_sliding_into_stick_slip_and_jumps_within_a_second(talk):
    talk.scene("stable-sliding")
    before = talk.play(RATE // 2).shares
    assert talk.scene("stable-sliding", {FRICTION: 1.5})["goes_on"]
    after = talk.play(RATE).shares
    assert before[2] > 0.9
    assert after[2] < before[2] - 0.3


def test_without_repeating_a_stroke_ends_off_the_track_and_reports_it(talk):
    talk.say("repeat", on=False)
    track = talk.scene("stable-sliding")["track"]["length"]
    near = {AT: track - 0.005}
    talk.scene("stable-sliding", near)
    played = talk.play(RATE // 2)
    assert [(stop["why"], stop["goes_on"]) for stop in played.stops] == [("off the track", False)]
    assert 0 < len(played.sound) < RATE // 2
    assert played.places[-1] == pytest.approx(track, abs=1e-3)
    assert talk.play(480).parts == []
    talk.say("restart")
    again = talk.play(480)
    assert set(again.stroke) == {played.parts[-1].stroke + 1}
    assert again.places[0] == pytest.approx(near[AT], abs=1e-3)


def test_strokes_follow_each_other_off_the_track(talk):
    track = talk.scene("stable-sliding")["track"]["length"]
    talk.scene("stable-sliding", {AT: track - 0.002})
    played = talk.play(RATE // 2)
    assert {(stop["why"], stop["goes_on"]) for stop in played.stops} == {("off the track", True)}
    assert len(played.sound) == RATE // 2
    # A stroke ends where another begins; the time played continues over strokes.
    assert played.stroke[-1] - played.stroke[0] == len(played.stops)
    assert np.all(np.diff(played.clock) > 0.0)
    assert np.all(np.diff(played.clock) <= 0.01 + 1e-9)


def test_a_tip_at_rest_begins_another_stroke(talk):
    talk.scene("stable-sliding", {"drives.0.transverse": 0.5, FRICTION: 2.0, "damping": 0.1})
    played = talk.play(RATE)
    assert [stop["why"] for stop in played.stops] == ["at rest"]
    assert played.stops[0]["goes_on"]
    assert played.stroke[-1] == played.stroke[0] + 1
    talk.say("repeat", on=False)
    still = talk.play(RATE)
    assert still.stops == []
    assert set(still.stroke) == {played.stroke[-1]}


def test_linear_theory_lists_growing_modes(talk):
    talk.scene("stable-sliding")
    theory = talk.until("theory")
    found = st.sliding_stability(st.load_scenario("stable-sliding").system)
    assert theory["equilibrium"] == found.attrs["equilibrium"] == "sliding"
    assert len(theory["modes"]) == min(12, int(found["unstable"].sum()))


def test_a_case_sounds_until_another_one_is_ready(talk):
    talk.scene("squeal")
    before = talk.revision
    talk.revision += 1
    talk.say("scene", revision=talk.revision, case="wheel", overrides={}, text=None)
    talk.say("pull", parts=2, samples=480)
    heard = []
    while not heard or not isinstance(heard[-1], dict) or heard[-1]["type"] != "scene":
        heard.append(talk.hear())
    (parts,) = [parts_of(one) for one in heard if isinstance(one, bytes)]
    assert [(part.revision, len(part.sound)) for part in parts] == [(before, 480)] * 2
    assert {part.revision for part in talk.play(960).parts} == {talk.revision}
