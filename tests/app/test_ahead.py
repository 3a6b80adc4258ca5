"""Sound computed ahead and its replacement after a change; without a browser."""

from __future__ import annotations

import pytest

from .scripting import result_of

AHEAD = """import { Ahead } from "./ahead.js";
const ahead = new Ahead();
const take = (at, name) => ahead.take({ at, end: at + 480, name });
const due = (sample) => ahead.due(sample).map(({ name }) => name);
result = [];
for (let k = 0; k < 6; k++) take(480 * k, `old ${k}`);
result.push(ahead.left, due(500), ahead.left);
ahead.cut(1440);
result.push(ahead.left);
for (let k = 3; k < 5; k++) take(480 * k, `new ${k}`);
result.push(ahead.left, due(2400));
// This change comes too late: the sound from 1920 on has been shown.
ahead.cut(1920);
take(1920, "late 4");
take(2400, "late 5");
result.push(due(2500));
ahead.begin(0);
take(0, "first");
result.push(due(1));"""


def test_parts_are_shown_when_they_are_heard_and_not_if_they_are_replaced(tmp_path):
    assert result_of(tmp_path, AHEAD) == [
        2880, ["old 0", "old 1"], 2380, 940, 1900, ["old 2", "new 3", "new 4"], ["late 5"], ["first"],
    ]  # fmt: skip


SILENT = """import { Ahead } from "./ahead.js";
const ahead = new Ahead();
const take = (at, name, sounds) => ahead.take({ at, end: at + 480, name }, sounds);
const due = (sample) => ahead.due(sample).map(({ name }) => name);
result = [];
for (let k = 0; k < 6; k++) take(480 * k, `old ${k}`, true);
// A case too slow to sound is computed from 1440 on, while the earlier sound continues to its end.
ahead.cut(1440);
result.push(due(2880));
for (let k = 3; k < 5; k++) {
  take(480 * k, `new ${k}`, false);
  result.push(due(ahead.end));
}
result.push(ahead.heard, ahead.left);"""


def test_without_sound_no_part_is_too_late(tmp_path):
    heard = [f"old {k}" for k in range(6)]
    assert result_of(tmp_path, SILENT) == [heard, ["new 3"], ["new 4"], 2400, 0]


LEAD = """import { Lead } from "./ahead.js";
const lead = new Lead();
result = given.map((spare) => (lead.arrived(spare), lead.length));"""


def test_the_lead_grows_with_late_changes_and_shrinks_slowly(tmp_path):
    given = [-0.05, -0.002, *[0.02] * 100]
    late, later, *early = result_of(tmp_path, LEAD, given)
    # A single very late change does not delay the next ones as much.
    assert late == pytest.approx(0.03 + 0.004)
    assert later == pytest.approx(late + 0.002)
    assert early[0] == pytest.approx(later - 0.1 * 0.02)
    assert early == sorted(early, reverse=True)
    assert early[-1] == pytest.approx(0.005)
    assert result_of(tmp_path, LEAD, [-5.0] * 100)[-1] == pytest.approx(0.25)


EAR = """import { Ear } from "./ahead.js";
const ear = new Ear(48000);
result = [ear.at(0) === -Infinity];
for (const [sample, now] of given) {
  ear.hears(sample, now);
  result.push(ear.at(30));
}"""


def test_the_ear_knows_what_is_heard_between_reports(tmp_path):
    """The report that came with the least delay counts, until it is old: after a drop-out all come later."""
    reports = [(480, 13.0), (960, 21.0), (1440, 35.0), *((1920 + 480 * k, 60.0 + 10.0 * k) for k in range(16))]
    empty, *found = result_of(tmp_path, EAR, reports)
    assert empty
    assert found[:3] == pytest.approx([48.0 * 27.0, 48.0 * 29.0, 48.0 * 29.0])
    assert found[3:-2] == pytest.approx([48.0 * 29.0] * 14)
    assert found[-1] == pytest.approx(48.0 * 10.0)


# The output without levels, limits and high-pass is the queue itself.
PLAYER = """import { Voice } from "./player.js";
const told = [];
const voice = new Voice(48000, ({ revision }) => revision !== undefined && told.push(revision));
voice.low = 0;
const port = { postMessage: (one) => told.push(one) };
voice.told({ stream: port });
const values = [];
const next = (count) => {
  for (let k = 0; k < count; k++) {
    voice.fill(new Float32Array(1));
    values.push(voice.last);
  }
};
const take = (at, value, revision) => voice.take({ at, revision, sound: new Float32Array(480).fill(value) });
for (let k = 0; k < 4; k++) take(480 * k, 1, 1);
next(500);
take(960, 2, 2);
take(1440, 3, 2);
next(1420);
const whole = values.splice(0);
const spares = told.filter((one) => one.spare !== undefined).map(({ spare }) => spare);
const heard = told.findLast((one) => one.heard !== undefined).heard;
take(1440, 9, 3);
take(1920, 9, 3);
next(480);
const late = values.splice(0);
// A change of which only the first part comes in time: the sound before it continues, and then that of the change.
take(2400, 4, 3);
take(2880, 4, 3);
next(240);
take(2640, 5, 4);
next(600);
take(3120, 5, 4);
next(360);
const lates = told.filter((one) => one.spare !== undefined).map(({ spare }) => spare);
const revisions = told.filter(Number.isFinite);
result = { whole, spares, heard, late, interrupted: values, lates, revisions, dropouts: voice.dropouts };"""


def test_the_player_replaces_sound_that_is_not_heard_yet(tmp_path):
    found = result_of(tmp_path, PLAYER)
    assert found["whole"] == [1.0] * 960 + [2.0] * 480 + [3.0] * 480
    assert found["spares"] == [960 - 500]
    assert found["heard"] == 1920
    assert found["revisions"] == [1, 2, 3, 4]
    # A late change begins where the sound is, without a jump.
    assert found["late"][0] == pytest.approx(3.0, abs=0.1)
    assert found["late"][-1] == pytest.approx(9.0, abs=1.0)
    # 120 samples of the part that comes late are over.
    interrupted = found["interrupted"]
    assert interrupted[239] == pytest.approx(4.0, abs=2.0)
    assert interrupted[719] == pytest.approx(5.0, abs=0.1)
    assert max(interrupted[720:840]) < 5.1
    assert interrupted[839] == pytest.approx(4.0, abs=0.7)
    assert interrupted[-1] == pytest.approx(5.0, abs=0.3)
    steps = [abs(one - other) for one, other in zip(interrupted[1:], interrupted, strict=False)]
    assert max(steps[240:]) < 0.1
    assert found["lates"] == [460, 1440 - 1920, 0]
    assert found["dropouts"] == 0


# A part that comes again begins before the sound that is heard; the change after it is still to come.
AGAIN = """import { Voice } from "./player.js";
const voice = new Voice(48000, () => {});
const told = [];
voice.told({ stream: { postMessage: ({ spare }) => spare !== undefined && told.push(spare) } });
const wave = (at, count, size) => Float32Array.from({ length: count }, (_, k) => size * Math.sin(0.1 * (at + k)));
const values = [];
const next = (count) => {
  for (let k = 0; k < count; k++) {
    voice.fill(new Float32Array(1));
    values.push(voice.last);
  }
};
for (let k = 0; k < 4; k++) voice.take({ at: 480 * k, revision: 1, sound: wave(480 * k, 480, 1) });
next(600);
voice.take({ at: 480, revision: 1, sound: wave(480, 220, 1) });
voice.take({ at: 700, revision: 2, sound: wave(700, 480, 3) });
next(400);
result = { values, told, wanted: [...wave(0, 700, 1), ...wave(700, 300, 3)] };"""


def test_sound_that_comes_again_up_to_a_change_is_heard_as_it_was(tmp_path):
    found = result_of(tmp_path, AGAIN)
    assert found["values"] == found["wanted"]
    assert found["told"] == [100]
