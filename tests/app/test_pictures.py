"""Drawings of the page, without a page."""

from __future__ import annotations

import pytest

from .scripting import result_of

ANEW = """import { Spectrogram } from "./spectrogram.js";
const spectrogram = new Spectrogram();
const sound = Float32Array.from({ length: 1 << 20 }, (_, i) => Math.sin(i));
spectrogram.hear(sound);
const kept = spectrogram.columns.length;
spectrogram.loudest = 7;
spectrogram.clear();
result = { kept, after: [spectrogram.columns.length, spectrogram.loudest] };"""
TIMES = """import { History } from "./history.js";
const history = new History();
const seen = [1, 2, 3].map((value) => Float32Array.of(value, value));
result = given.map((clock) => {
  history.take({ clock, stroke: 1, place: 0, interval: 0.1 }, [seen[0], seen[1], seen[2], seen[0]]);
  return [history.count, history.since(1).length];
});"""
LOOP = """import { Loop } from "./loop.js";
let started = 0;
const node = () => ({ connect: (next) => next, start: () => (started += 1), stop: () => (started -= 1), gain: {} });
globalThis.AudioContext = class {
  resume = () => new Promise(() => {});
  createBuffer = () => ({ copyToChannel() {} });
  createBufferSource = node;
  createGain = node;
};
const loop = new Loop(() => {});
loop.take(Float32Array.from({ length: 4800 }, (_, i) => Math.sin(i)));
result = [];
for (let press = 0; press < 3; press++) {
  if (loop.source) loop.stop();
  else loop.play(0);
  result.push(started);
}"""
TOP = """import { Top } from "./timeline.js";
const top = new Top();
result = given.map(([largest, now]) => top.follow(largest, now));"""
ENDS = """import { Ends } from "./phase.js";
const ends = new Ends();
result = given.map((words) => ends.follow(...words));"""
PARTS = """import { Pictures } from "./pictures.js";
globalThis.document = { getElementById: () => ({}), documentElement: { dataset: {} } };
globalThis.getComputedStyle = () => ({ getPropertyValue: () => "" });
const pictures = new Pictures({ describe() {} });
const part = (revision, nodes) => {
  const counts = [1, 1, nodes, 0, 0, 0];
  pictures.take({ head: [revision, 0, 0, ...counts], values: new Float32Array(7 + 2 * nodes) });
  return pictures.shapes && pictures.shapes.slider.length / 2;
};
const lines = (...counts) => counts.map((count) => ({ places: Array(count).fill([0, 0]) }));
const [two, three] = [lines(2, 3), lines(4)];
const scenes = { space: { drawn: "hash" }, beams: { track: {} }, two: { lines: two }, three: { lines: three } };
result = given.map(([name, ...words]) => {
  if (name === "part") return part(...words);
  pictures.describe({ revision: words[0], ...scenes[name] });
  return null;
});"""
BESIDE = """import { besideTip } from "./pictures.js";
result = given.map((words) => besideTip(...words));"""
LINES = """import { Frame, mark, placed } from "./lines.js";
const scene = { lines: given.lines, contacts: given.contacts, joined: [] };
const frame = new Frame();
result = given.values.map((values) => {
  const lines = placed(scene, Float32Array.from(values));
  const much = frame.follow(lines, scene);
  return [much, frame.extent, scene.contacts.map((one) => mark(one, lines, much))];
});"""
# Width of a word in pixels, over a tip at this height.
WORD, TIP, WIDTH = 60.0, 200.0, 700.0


@pytest.mark.parametrize("pictures", [15, 30])
def test_the_axis_of_the_force_shrinks_within_two_seconds_after_a_loud_case(tmp_path, pictures):
    times = [1000.0 * k / pictures for k in range(6 * pictures)]
    # The last second is visible.
    seen = [79.0 if now < 3000.0 else 10.0 for now in times]
    tops = result_of(tmp_path, TOP, list(zip(seen, times, strict=True)))
    assert all(top >= 1.05 * force for top, force in zip(tops, seen, strict=True))
    assert tops[2 * pictures] == pytest.approx(1.05 * 79.0)
    # It was loud until 2 s.
    assert tops[4 * pictures] < 1.1 * 10.5
    # The axis must not jump.
    assert tops[3 * pictures + 1] > 50.0


@pytest.mark.parametrize("lean", [-1.2, -0.3, 0.0, 0.3, 1.2])
@pytest.mark.parametrize("x", [10.0, 40.0, 120.0, 350.0, 640.0, 690.0])
def test_the_word_beside_the_tip_lies_in_the_picture_and_not_over_the_slider(tmp_path, lean, x):
    ((left, base),) = result_of(tmp_path, BESIDE, [[x, TIP, lean, WORD, WIDTH]])
    assert 0.0 <= left <= left + WORD <= WIDTH
    if base < TIP:
        assert left + WORD < x if lean > 0.0 else left > x
    else:
        assert base - 12.0 > TIP + 8.0


def test_lines_travel_to_scale_and_depart_exaggerated(tmp_path):
    beam = {"places": [[0.0, 0.0], [1.0, 0.0]], "count": 2}
    block = {"places": [[0.25, 0.0]], "count": 1}
    contacts = [{"tip": [1, 0], "touched": None}]
    # Travel of each line, then the departures from it.
    still, moved = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 1e-4, 0.5, 0, 0, -2e-4]
    given = {"lines": [beam, block], "contacts": contacts, "values": [still, moved, moved]}
    (rest, first, second) = result_of(tmp_path, LINES, given)
    assert rest[0] == 0.0
    assert rest[2] == [[0.25, 0.0]]
    much, extent, [[x, y]] = first
    assert extent == pytest.approx(1.0)
    assert much * 2e-4 == pytest.approx(0.06)
    assert (x, y) == (pytest.approx(0.75), pytest.approx(-0.06))
    assert second == first


def test_the_scale_of_smaller_vibrations_grows_slowly(tmp_path):
    beam = {"places": [[0.0, 0.0], [1.0, 0.0]], "count": 2}
    values = [[0, 0, 0, 0, 0, size] for size in (1e-4, 1e-5, 1e-3)]
    loud, quiet, louder = (
        one[0] for one in result_of(tmp_path, LINES, {"lines": [beam], "contacts": [], "values": values})
    )
    assert quiet == pytest.approx(1.01 * loud)
    assert louder == pytest.approx(0.06 / 1e-3)


def test_a_spectrogram_keeps_a_while_and_drops_earlier_sound(tmp_path):
    found = result_of(tmp_path, ANEW)
    assert 2000 <= found["kept"] <= 4000
    assert found["after"] == [0, 1e-9]


def test_a_restarted_server_restarts_the_history(tmp_path):
    assert result_of(tmp_path, TIMES, [50.0, 50.2, 0.2, 0.4]) == [[2, 2], [4, 4], [2, 2], [4, 4]]


def test_a_loop_that_is_pressed_again_while_it_begins_ends(tmp_path):
    assert result_of(tmp_path, LOOP) == [1, 0, 1]


def test_the_portrait_has_the_range_of_its_velocities_within_two_seconds(tmp_path):
    loud, soft = (-0.001, 0.012), (-0.002, 0.002)
    times = [100.0 * k for k in range(40)]
    seen = [loud if now < 1000.0 else soft for now in times]
    found = result_of(tmp_path, ENDS, [[*ends, now] for ends, now in zip(seen, times, strict=True)])
    assert all(low <= ends[0] and ends[1] <= high for (low, high), ends in zip(found, seen, strict=True))
    assert found[5] == pytest.approx([-0.0015, 0.015])
    assert found[30] == pytest.approx([-0.0025, 0.0025])
    # By time, whatever the number of pictures: the axis must not jump.
    assert found[11][1] >= 0.008


def test_a_slip_in_one_direction_fills_the_portrait(tmp_path):
    ((low, high),) = result_of(tmp_path, ENDS, [[0.0, 0.2, 0.0]])
    assert 0.2 <= high <= 0.3
    assert -0.1 * high <= low < 0.0


def test_parts_of_another_kind_of_system_are_not_drawn_as_this_one(tmp_path):
    acts = [["space", 1], ["part", 1, 0], ["beams", 2], ["part", 1, 0], ["part", 2, 5], ["beams", 3], ["part", 2, 5]]
    assert result_of(tmp_path, PARTS, acts) == [None, 0, None, None, 5, None, 5]
    acts = [["two", 1], ["part", 1, 7], ["three", 2], ["part", 1, 7], ["part", 2, 5], ["three", 3], ["part", 2, 5]]
    assert result_of(tmp_path, PARTS, acts) == [None, 7, None, None, 5, None, 5]
