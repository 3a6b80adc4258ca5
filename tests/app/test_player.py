"""Levelling of the player, at which its limiter is inactive; without a browser."""

from __future__ import annotations

import numpy as np
import pytest

from stridula.app.instrument import Instrument
from stridula.app.parts import Part
from stridula.app.playable import PRESETS, playable
from stridula.app.sources import SOURCES

from .conversation import RATE
from .scripting import result_of

CEILING, MOST = 0.7, 30.0
WORDS = """import { levelWords } from "./level.js";
result = given.map((words) => levelWords(...words));"""
BLOCK = 4800
# For each tenth of a second: the largest output and the largest reduction by the limiter [dB].
PLAYER = """import { Voice } from "./player.js";
result = given.map(({ levelled, sound }) => {
  const voice = new Voice(48000, (said) => "peak" in said && reductions.push(said.reduction));
  let reductions = [];
  voice.told({ volume: 1, levelled });
  const found = [];
  for (let at = 0; at + 4800 <= sound.length; at += 4800) {
    voice.take({ sound: Float32Array.from(sound.slice(at, at + 4800)), revision: 1, at });
    const out = new Float32Array(4800);
    for (let k = 0; k < 4800; k += 96) voice.fill(out.subarray(k, k + 96));
    const reduction = Math.max(0, ...reductions.map((one) => -20 * Math.log10(one)));
    reductions = [];
    found.push([Math.max(...out.map(Math.abs)), reduction]);
  }
  return found;
});"""


def played(folder, *sounds: np.ndarray, levelled: bool = True) -> np.ndarray:
    """Return the loudest and the reduction of each tenth of a second, shape (sounds, tenths, 2)."""
    given = [{"levelled": levelled, "sound": [float(f"{value:.6g}") for value in sound]} for sound in sounds]
    return np.array(result_of(folder, PLAYER, given))


def tone(amplitude: float, seconds: float) -> np.ndarray:
    return amplitude * np.sin(2000.0 * np.pi * np.arange(round(seconds * RATE)) / RATE)


@pytest.mark.parametrize("amplitude", [0.03, 0.3, 3.0, 80.0])
def test_levelled_sounds_are_equally_loud(tmp_path, amplitude):
    (found,) = played(tmp_path, tone(amplitude, 8.0))
    assert found[-10:, 0] == pytest.approx(CEILING, rel=0.02)
    assert found[12:, 1].max() < 0.01


def test_amplification_is_limited_and_silence_stays_silent(tmp_path):
    (faint,) = played(tmp_path, tone(1e-4, 8.0))
    assert 0.0021 < faint[-1, 0] < 0.0033
    (after,) = played(tmp_path, np.concatenate([tone(0.3, 3.0), np.zeros(30 * RATE), tone(0.3, 1.0)]))
    assert after[-10, 1] < MOST / 2.0


def test_the_page_says_how_the_level_is_set(tmp_path):
    pressure = {"full_scale": 0.1, "unit": "Pa"}
    gains = [1.0, 20.0, 10.0 ** (MOST / 20.0)]
    fixed, *levelled = result_of(tmp_path, WORDS, [[pressure, False, 1.0], *([pressure, True, gain] for gain in gains)])
    assert fixed == "At 0 dB, 0.1 Pa is full scale."
    reached = "Automatic level: the loudest sound of the last 4 s comes to 3 dB below full scale."
    assert levelled[:2] == [reached, reached]
    assert levelled[2] == "Automatic level: the sound is so faint that it is amplified by 30 dB, the most possible."
    # At this gain it is below that level: the words of the others would be wrong.
    (faint,) = played(tmp_path, tone(1e-4, 8.0))
    assert faint[-1, 0] < CEILING / 100.0


def test_a_level_falls_at_once_and_rises_within_seconds(tmp_path):
    (found,) = played(tmp_path, np.concatenate([tone(0.05, 6.0), tone(5.0, 2.0), tone(0.05, 8.0)]))
    loudest, reduction = found.T
    assert loudest.max() <= CEILING + 1e-6
    assert reduction[65:80].max() < 1.0
    assert loudest[85] < 0.02
    assert loudest[-1] == pytest.approx(CEILING, rel=0.05)


def test_sounds_without_levelling_are_limited(tmp_path):
    loud, low = played(tmp_path, tone(7.0, 1.0), tone(0.3, 1.0), levelled=False)
    assert loud[-1, 1] == pytest.approx(20.0, abs=0.5)
    assert low[-1, 0] == pytest.approx(0.3, rel=0.01)
    assert low[:, 1].max() == 0.0


def test_the_limiter_rests_in_every_case(tmp_path):
    sounds = [heard(case, 6.0) / SOURCES["pressure"].full_scale for case in PRESETS]
    for case, found in zip(PRESETS, played(tmp_path, *sounds), strict=True):
        assert np.median(found[:, 1]) < 0.1, case
        assert np.mean(found[:, 1] > 3.0) < 0.1, case
        assert found[20:, 0].max() > 0.3, case


def test_without_a_level_the_limiter_never_rests_in_a_loud_case(tmp_path):
    (found,) = played(tmp_path, heard("strong-pressure", 2.0) / SOURCES["pressure"].full_scale, levelled=False)
    assert np.median(found[:, 1]) > 10.0


def heard(case: str, seconds: float) -> np.ndarray:
    """Return the sound of a case [Pa]."""
    instrument = Instrument(playable(case, None, {}))
    blocks = [one for _ in range(round(10 * seconds)) for one in instrument.play(BLOCK)]
    return np.concatenate([one.sound for one in blocks if isinstance(one, Part)])


@pytest.mark.parametrize(("before", "now"), [("force", "pressure"), ("pressure", "force"), ("force", "acceleration")])
def test_another_source_starts_at_the_level_of_the_previous_one(before, now):
    instrument = Instrument(playable("strong-pressure", None, {}), before)
    last = [one for one in instrument.play(BLOCK) if isinstance(one, Part)][-1].sound[-1]
    instrument.listen_to(now)
    first = next(one for one in instrument.play(BLOCK) if isinstance(one, Part)).sound[0]
    assert first / SOURCES[now].full_scale == pytest.approx(last / SOURCES[before].full_scale)
