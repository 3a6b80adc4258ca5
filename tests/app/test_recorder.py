"""Recordings of the page as files."""

from __future__ import annotations

import base64

import numpy as np
import pytest
import soundfile

from .conversation import RATE
from .scripting import result_of

RECORDED = """import { Recorder } from "./recorder.js";
const recorder = new Recorder(48000);
recorder.begin(0, true);
const room = given.map(([values, scale, unit]) => recorder.take(Float32Array.from(values), { scale, unit }));
const seconds = recorder.seconds;
const bytes = recorder.end(1);
result = { room, seconds, on: recorder.on, bytes: bytes && Buffer.from(bytes).toString("base64") };"""
LONG = """import { Recorder } from "./recorder.js";
const recorder = new Recorder(48000);
recorder.begin(0, true);
let parts = 0;
while (recorder.take(new Float32Array(48000 * 7 + 13).fill(0.5), { scale: 1, unit: "Pa" })) parts += 1;
result = [parts, recorder.seconds];"""

GAPS = """import { Recorder } from "./recorder.js";
result = given.map((acts) => {
  const recorder = new Recorder(48000);
  for (const [name, ...words] of acts) {
    if (name === "take") recorder.take(new Float32Array(48000 * words[0]).fill(0.5), { scale: 1, unit: "Pa" });
    else recorder[name](...words);
  }
  return Number(recorder.missing.toFixed(6));
});"""


def recorded(folder, parts):
    found = result_of(folder, RECORDED, [[part.tolist(), *source] for part, *source in parts])
    if found["bytes"] is not None:
        (folder / "found.wav").write_bytes(base64.b64decode(found["bytes"]))
    return found


def test_a_recording_holds_what_was_heard_1_db_below_full_scale(tmp_path):
    time = np.arange(RATE // 4) / RATE
    # A tone on a constant weight, which is not audible.
    sound = 5.0 + 0.02 * np.sin(2.0 * np.pi * 1000.0 * time)
    found = recorded(tmp_path, [(part, 10.0, "Pa") for part in np.split(sound, 5)])
    assert (found["seconds"], found["on"]) == (0.25, False)
    values, rate = soundfile.read(tmp_path / "found.wav")
    assert rate == RATE
    assert len(values) == len(time)
    assert np.abs(values).max() == pytest.approx(10.0 ** (-1.0 / 20.0), rel=1e-3)
    with soundfile.SoundFile(tmp_path / "found.wav") as file:
        comment = file.comment
    assert comment.startswith("stridula: recorded on the page, full scale is ")
    assert comment.endswith(" Pa")
    full = float(comment.split()[-2])
    assert full * values[2000:] == pytest.approx(sound[2000:] - 5.0, abs=5e-4)


@pytest.mark.parametrize("other", [(0.05, "Pa"), (10.0, "N")], ids=["scale", "unit"])
def test_several_sources_have_no_common_full_scale(tmp_path, other):
    noise = np.random.default_rng(2).normal(size=480)
    recorded(tmp_path, [(noise, 10.0, "Pa"), (noise, *other)])
    with soundfile.SoundFile(tmp_path / "found.wav") as file:
        assert file.comment == "stridula: recorded on the page, several sources"


def test_silence_is_a_file_and_an_empty_recording_is_not(tmp_path):
    recorded(tmp_path, [(np.zeros(480), 10.0, "Pa")])
    assert not soundfile.read(tmp_path / "found.wav")[0].any()
    assert recorded(tmp_path, [])["bytes"] is None


def test_a_recording_ends_after_a_minute(tmp_path):
    assert result_of(tmp_path, LONG) == [8, 60]


def test_sound_that_did_not_come_is_missing_and_pauses_are_not(tmp_path):
    gap = [["begin", 10.0, True], ["take", 1.8], ["end", 13.0]]
    whole = [["begin", 10.0, True], ["take", 2.95], ["end", 13.0]]
    pause = [
        ["begin", 10.0, True],
        ["take", 1.0],
        ["hears", False, 11.0],
        ["hears", True, 20.0],
        ["take", 2.0],
        ["end", 22.0],
    ]
    late = [["hears", True, 0.0], ["begin", 10.0, False], ["hears", True, 11.0], ["take", 0.5], ["end", 12.0]]
    assert result_of(tmp_path, GAPS, [gap, whole, pause, late]) == [1.2, 0.0, 0.0, 0.5]
