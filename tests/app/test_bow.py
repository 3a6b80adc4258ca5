"""Dragging on the picture, without a page."""

from __future__ import annotations

import pytest

from stridula.app.playable import CASES, playable

from .scripting import result_of

PLAYED = """import { played } from "./bow.js";
result = given.map(([controls, values]) => {
  const { velocity, force } = played(controls.filter(({ key }) => key in values), values);
  return [velocity?.key ?? null, force?.key ?? null];
});"""
HAND = """import { Hand, TICK } from "./bow.js";
const hand = new Hand(given.what, given.values, ...given.path[0]);
result = given.path.slice(1).map((place) => {
  hand.moves(...place);
  return hand.tick(TICK);
});"""
LEFT = """import { Bow } from "./bow.js";
import { Scene } from "./scene.js";
import { Slots } from "./slots.js";
const told = [];
const on = {};
const canvas = { clientWidth: 100, clientHeight: 100, setPointerCapture() {}, classList: { toggle() {} } };
canvas.addEventListener = (name, then) => (on[name] = then);
const controls = { numbers: () => [given.control], values: { [given.control.key]: 2 } };
let bow;
const scene = new Scene(() => told.push(structuredClone(scene.now)), () => bow.release());
const slots = new Slots(scene);
bow = new Bow(canvas, scene, controls, () => {});
const leaves = {
  setting: () => slots.go("B"),
  case: () => scene.set({ case: "belt", overrides: {} }),
  value: () => scene.values({ other: 1 }),
  undo: () => scene.undo(),
  link: () => scene.read("#case=belt"),
};
scene.set({ case: "judder" });
on.pointerdown({ button: 0, pointerId: 1, clientX: 50, clientY: 50 });
on.pointermove({ clientX: 50, clientY: 75 });
const passes = () => new Promise((then) => setTimeout(then, 150));
await passes();
const pressed = told.at(-1).overrides;
await leaves[given.leaves]();
const left = told.length;
await passes();
result = { pressed, now: scene.now, other: slots.other?.now ?? null, more: told.length - left };"""
LOAD = {"key": "load", "low": 0, "high": 100, "scale": 1, "step": 0.1}
BOTH_WAYS = {"key": "speed", "low": -10, "high": 10, "scale": 0.01, "step": 0.01}
ONE_WAY = {"key": "speed", "low": -100, "high": -4, "scale": 0.01, "step": 0.01}
TICK = 0.05


def moved(folder, what, values, path):
    return result_of(folder, HAND, {"what": {"velocity": None, "force": None} | what, "values": values, "path": path})


def test_each_case_offers_its_values_for_dragging(tmp_path):
    turned = {name: playable(name, None, {}).turned for name in CASES}
    given = [[one.described["controls"], one.values] for one in turned.values()]
    found = dict(zip(turned, result_of(tmp_path, PLAYED, given), strict=True))
    assert found["weak-pressure"] == ["drives.0.velocity", "drives.0.normal_load"]
    assert found["squeal"] == [None, "drives.0.transverse"]
    assert found["judder"] == [None, "drives.0.axial"]
    assert found["violin"] == ["contacts.*.surface_velocity", "drives.*.x"]
    assert found["belt"] == ["contacts.0.track.velocity", "drives.0.y"]
    for name, keys in found.items():
        assert set(keys) - {None} <= set(turned[name].values)


def test_dragging_at_a_steady_speed_gives_a_steady_velocity(tmp_path):
    # Half a width per second, to the right and back.
    path = [[0.2 + 0.5 * TICK * k, 0.5] for k in range(15)] + [[0.55 - 0.5 * TICK * k, 0.5] for k in range(15)]
    found = [one["speed"] for one in moved(tmp_path, {"velocity": BOTH_WAYS}, {}, path)]
    assert found[13] == pytest.approx(0.05, rel=0.01)
    assert found[-1] == pytest.approx(-0.05, rel=0.01)
    # A value with one sign keeps it for both directions of the hand, and never becomes zero.
    found = [one["speed"] for one in moved(tmp_path, {"velocity": ONE_WAY}, {}, path)]
    assert found[13] == found[-1] == pytest.approx(-0.5, rel=0.01)
    assert max(found) <= -0.04


def test_a_hand_that_rests_comes_to_rest(tmp_path):
    path = [[0.0, 0.5], [0.3, 0.5], *[[0.3, 0.5]] * 20]
    found = [one["speed"] for one in moved(tmp_path, {"velocity": BOTH_WAYS}, {}, path)]
    assert found[0] == 0.1
    assert abs(found[-1]) < 1e-5


@pytest.mark.parametrize("start", [0.1, 2.0, 30.0])
def test_down_presses_harder_within_the_slider(tmp_path, start):
    path = [[0.5, 0.5], [0.5, 0.5], [0.5, 0.75], [0.5, 1.0], [0.5, 0.0], [0.5, 9.0]]
    found = [one["load"] for one in moved(tmp_path, {"force": LOAD}, {"load": start}, path)]
    wanted = [start, 2 * start, 4 * start, start / 4, 100.0]
    assert found == pytest.approx([min(one, 100.0) for one in wanted], rel=1e-2)


def test_a_force_keeps_its_sense_and_one_that_is_zero_begins_small(tmp_path):
    axial = LOAD | {"low": -20, "high": 20}
    down = [[0.5, 0.2], [0.5, 0.7]]
    assert moved(tmp_path, {"force": axial}, {"load": -0.5}, down) == [{"load": -2.0}]
    assert moved(tmp_path, {"force": axial}, {"load": 0.0}, down) == [{"load": 0.4}]


@pytest.mark.parametrize(
    ("leaves", "case", "overrides"),
    [
        ("setting", "judder", {}),
        ("case", "belt", {}),
        ("value", "judder", {"other": 1}),
        ("undo", "glass", {}),
        ("link", "belt", {}),
    ],
)
def test_a_hand_lets_go_before_something_else_is_played(tmp_path, leaves, case, overrides):
    control = LOAD | {"key": "drives.0.normal_load", "unit": "N"}
    found = result_of(tmp_path, LEFT, {"control": control, "leaves": leaves})
    assert found["pressed"] == {"drives.0.normal_load": 4.0}
    assert found["now"] == {"case": case, "text": None, "overrides": overrides}
    assert found["more"] == 0
    if leaves == "setting":
        assert found["other"]["overrides"] == {}


def test_forces_are_recognised_by_their_unit(tmp_path):
    units = ["mN", "MN", "µN", "N", "N/m", "Nm", "mm"]
    given = [[[LOAD | {"key": "drives.0.load", "unit": unit}], {"drives.0.load": 1.0}] for unit in units]
    assert [force is not None for _, force in result_of(tmp_path, PLAYED, given)] == [True] * 4 + [False] * 3
