"""The request of the page for a map, and its rows; without a browser."""

from __future__ import annotations

from typing import Any

import pytest

from stridula.app.playable import playable

from .scripting import result_of

REQUEST = """import { MapRequest } from "./request.js";
import { mock } from "node:test";
mock.timers.enable({ apis: ["setTimeout"] });
const said = [], told = [];
const request = new MapRequest(4, (message) => said.push(message), (words) => told.push(words));
const acts = {
  ask: (revision) => request.ask({ x: "x", y: "y" }, revision, 700),
  pass: (time) => mock.timers.tick(time),
  row: (revision, row) => request.take({ revision, row, regimes: [] }),
  done: (revision) => request.done({ revision }),
  drop: () => request.drop(),
  hold: () => request.hold(),
};
for (const [name, ...words] of given) acts[name](...words);
const words = said.map(({ type, revision, on }) => [type, revision ?? on ?? null]);
result = { said: words, told, rows: [...request.cells.keys()] };"""
MAP = """import { RegimeMap } from "./map.js";
import { mock } from "node:test";
mock.timers.enable({ apis: ["setTimeout"] });
const one = () => ({ addEventListener() {}, replaceChildren() {}, dataset: {}, checked: true });
globalThis.document = { getElementById: one };
globalThis.Option = class {};
const numbers = ["a", "b"].map((key) => ({ key, label: key, low: 0, high: 1, scale: 1 }));
const said = [];
const controls = { numbers: () => numbers, values: { a: 0.5, b: 0.5 }, ends: ({ low, high }) => [low, high] };
const map = new RegimeMap(null, controls, {}, (message) => said.push(message));
const acts = {
  follow: (revision) => map.follow(revision),
  leave: () => map.leave(),
  pass: (time) => mock.timers.tick(time),
  key: (key) => {
    numbers[1] = { ...numbers[1], key };
    controls.values = { a: 0.5, [key]: 0.5 };
  },
};
for (const [name, ...words] of given) acts[name](...words);
result = said.map(({ type, revision, x, y }) => [type, revision, x.key, y.key]);"""

AXES = """import { axes } from "./map.js";
result = given.map(([numbers, values]) => axes(numbers, values));"""


def requested(folder, *acts: tuple[Any, ...]) -> dict[str, Any]:
    return result_of(folder, REQUEST, acts)


def test_a_request_waits_for_a_quiet_time_and_the_last_one_counts(tmp_path):
    found = requested(tmp_path, ("ask", 1), ("pass", 600), ("ask", 2), ("pass", 600), ("pass", 200))
    assert found["said"] == [["map", 2]]


def test_only_rows_of_the_last_request_are_kept(tmp_path):
    acts = [("ask", 1), ("pass", 700), ("row", 1, 0), ("ask", 2), ("row", 1, 2), ("pass", 700), ("row", 1, 3)]
    found = requested(tmp_path, *acts, ("row", 2, 1), ("done", 1))
    assert found["said"] == [["map", 1], ["no map", None], ["map", 2]]
    assert found["rows"] == [1]
    assert found["told"][-1] == "25 % computed"


def test_a_map_is_suspended_after_drop_outs_and_keeps_its_rows(tmp_path):
    begins = [("hold",), ("ask", 1), ("pass", 700), ("row", 1, 0)]
    acts = [*begins, ("hold",), ("row", 1, 2), ("pass", 4000), ("hold",), ("pass", 4000)]
    found = requested(tmp_path, *acts)
    assert found["said"] == [["map", 1], ["hold map", True]]
    assert found["told"][-1] == "suspended in favour of the sound"
    found = requested(tmp_path, *acts, ("pass", 1000), ("row", 1, 1), ("row", 1, 3), ("done", 1), ("hold",))
    assert found["said"] == [["map", 1], ["hold map", True], ["hold map", False]]
    assert found["rows"] == [0, 2, 1, 3]
    assert found["told"][-1] == "runs of up to 1 s from the start"


def test_a_long_wait_for_the_first_row_is_explained(tmp_path):
    assert requested(tmp_path, ("ask", 1), ("pass", 700), ("pass", 5000))["told"][-1].startswith("computing the first")
    assert requested(tmp_path, ("ask", 1), ("pass", 700), ("drop",), ("pass", 5000))["told"] == ["computing"]


def test_no_request_around_a_case_is_sent_once_another_is_on_its_way(tmp_path):
    chosen = [("follow", 1), ("pass", 600), ("leave",), ("pass", 5000)]
    assert result_of(tmp_path, MAP, chosen) == []
    # The next case has other keys; or the change was refused and the first one plays on.
    assert result_of(tmp_path, MAP, [*chosen, ("key", "c"), ("follow", 2), ("pass", 700)]) == [["map", 2, "a", "c"]]
    assert result_of(tmp_path, MAP, [*chosen, ("follow", 1), ("pass", 700)]) == [["map", 1, "a", "b"]]


@pytest.mark.parametrize(
    ("case", "wanted"),
    [
        ("squeal", ["contact.friction.coefficient", "slider.angle"]),
        ("weak-pressure", ["contact.friction.coefficient", "slider.angle"]),
        ("squeal-on-plate", ["contacts.0.friction.coefficient", "bodies.slider.angle"]),
        ("violin", ["contacts.*.surface_velocity", "drives.*.x"]),
        ("belt", ["contacts.0.track.velocity", "drives.0.y"]),
        ("glass", ["bodies.glass.turning", "drives.0.z"]),
    ],
)
def test_first_axes_are_friction_and_angle_or_speed_and_load(tmp_path, case, wanted):
    turned = playable(case, None, {}).turned
    numbers = [vars(one) for one in turned.controls if one.key in turned.values]
    assert result_of(tmp_path, AXES, [[numbers, turned.values]]) == [wanted]
