"""The last seconds played as files: they open elsewhere and hold the sound that was heard."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest
import soundfile

import stridula as st
from stridula.app import now
from stridula.app.instrument import Instrument
from stridula.app.parts import Part
from stridula.app.playable import playable
from stridula.records.variables import CONTACT, STATUS, STATUS_SHARE

from .conversation import RATE, Conversation

FRICTION = "contact.friction.coefficient"


@pytest.mark.parametrize("format", ["wav", "nc"])
def test_what_was_not_played_cannot_be_saved(talk, format):
    talk.scene()
    talk.say("save", format=format)
    (problem,) = talk.until("problem", "file")["problems"]
    assert problem == "page must have played something before it can save, got nothing yet"
    assert len(talk.play(480).sound) == 480


def heard(talk: Conversation, source: str, seconds: float) -> np.ndarray:
    talk.say("listen", source=source)
    talk.scene()
    return talk.play(round(seconds * RATE)).sound.astype(float)


def test_the_sound_of_the_pressure_is_in_pascals(talk, tmp_path):
    sound = heard(talk, "pressure", 0.5)
    file = tmp_path / "heard.wav"
    file.write_bytes(talk.save("wav"))
    pressure = st.read_wav(file)
    assert pressure.sizes == {"time": RATE // 2, "listener": 1}
    assert 1.0 / float(pressure.time[1] - pressure.time[0]) == pytest.approx(RATE)
    assert np.abs(sound).max() > 1e-3
    assert np.allclose(pressure.values[:, 0], sound, atol=1e-6 * np.abs(sound).max())
    # A second file begins at its time of playing.
    talk.play(480)
    file.write_bytes(talk.save("wav"))
    assert st.read_wav(file).sizes["time"] == RATE // 2 + 480


@pytest.mark.parametrize(("source", "unit"), [("force", "N"), ("acceleration", "m/s²")])
def test_other_sounds_state_their_full_scale(talk, source, unit):
    sound = heard(talk, source, 0.2)
    with soundfile.SoundFile(io.BytesIO(talk.save("wav"))) as file:
        comment, samples = file.comment, file.read()
        assert (file.samplerate, file.channels, file.subtype) == (RATE, 1, "PCM_24")
    words, _, scale = comment.removesuffix(f" {unit}").rpartition(" ")
    assert words.endswith("full scale is")
    wanted = sound - sound.mean() * (source == "force")
    assert np.allclose(samples * float(scale), wanted, atol=1e-5 * np.abs(wanted).max())
    assert np.abs(samples).max() == pytest.approx(10 ** (-1 / 20), abs=1e-3)


def test_only_the_present_source_is_in_the_sound(talk):
    heard(talk, "force", 0.1)
    talk.say("listen", source="acceleration")
    talk.play(4800)
    samples, _ = soundfile.read(io.BytesIO(talk.save("wav")))
    assert len(samples) == 4800


def test_the_record_opens_and_equals_that_of_the_run(talk, tmp_path):
    heard(talk, "pressure", 0.2)
    file = tmp_path / "played.nc"
    file.write_bytes(talk.save("nc"))
    record, run = st.load(file), st.load_scenario("squeal").simulate(duration=0.2, sample_rate=RATE)
    names = [variable.name for variable in (*CONTACT, STATUS, STATUS_SHARE)]
    for name in names:
        for word in ("units", "long_name"):
            assert record[name].attrs[word] == run[name].attrs[word]
        assert record[name].dims == run[name].dims
        scale = float(np.abs(run[name].values).max())
        assert np.allclose(record[name].values, run[name].values, rtol=1e-6, atol=1e-6 * scale)
    assert {"acceleration", "stroke"} <= set(record.data_vars)
    assert record.time.values == pytest.approx(run.time.values)
    assert record.attrs["steps_per_sample"] == run.attrs["steps_per_sample"]
    assert record.attrs["stridula_version"] == st.__version__


def changed_on_the_way(talk: Conversation, folder: Path) -> Path:
    """Return the record of a tenth of a second and, at more friction, another."""
    talk.scene("stable-sliding")
    talk.play(4800)
    talk.scene("stable-sliding", {FRICTION: 0.7})
    talk.play(4800)
    file = folder / "played.nc"
    file.write_bytes(talk.save("nc"))
    return file


def test_the_record_reruns_the_last_scenario(talk, tmp_path):
    file = changed_on_the_way(talk, tmp_path)
    again = st.load_scenario(file)
    assert again.system == st.load_scenario("stable-sliding", {FRICTION: 0.7}).system
    assert again.simulate(duration=0.01).attrs["ended"] == "finished"


@pytest.mark.parametrize("case", ["weak-pressure", "violin", "glass"])
def test_the_regime_shown_is_that_of_the_record(case, tmp_path):
    """Over the last second, in which a value was changed and energies restarted."""
    instrument = Instrument(playable(case, None, {}))
    key = {"weak-pressure": FRICTION, "violin": "drives.*.x", "glass": "drives.0.z"}[case]
    value = instrument.played.turned.values[key]
    for _ in range(100):
        list(instrument.play(480))
    instrument.change(playable(case, None, {key: 1.02 * value}), 1)
    for _ in range(60):
        list(instrument.play(480))
    told = {name: now.said(values) for name, values in instrument.last_seconds.moment(1.0)[0].items()}
    shown = now.measured(1.0 / RATE, instrument.played.system.contact_names, told)
    file = tmp_path / "played.nc"
    file.write_bytes(instrument.last_seconds.record(instrument.played, instrument.live.ratio))
    run = st.load(file)
    assert (np.diff(run.damping_loss) >= -1e-12 * float(run.damping_loss[-1])).all()
    saved = st.regime(run.isel(time=slice(-RATE, None)), start=0.0)
    assert shown["regime"] == saved.regime.item()
    # Judder has no tone.
    if case != "weak-pressure":
        assert shown["frequency"] == pytest.approx(saved.frequency.item(), rel=1e-3)


def test_the_record_lists_changes_with_their_times(talk, tmp_path):
    file = changed_on_the_way(talk, tmp_path)
    changes = json.loads(st.load(file).attrs["changes"])
    assert [change["time"] for change in changes] == pytest.approx([0.0, 0.1])
    for change, friction in zip(changes, (0.5, 0.7), strict=True):
        (tmp_path / "one.toml").write_text(change["scenario"], encoding="utf-8")
        found = st.load_scenario(tmp_path / "one.toml").system
        assert found == st.load_scenario("stable-sliding", {FRICTION: friction}).system


def test_changes_without_sound_merge_and_old_ones_are_dropped(talk, tmp_path):
    talk.scene("stable-sliding")
    for friction in (0.5, 0.6, 0.7):
        talk.scene("stable-sliding", {FRICTION: friction})
    talk.play(4800)
    file = tmp_path / "played.nc"
    file.write_bytes(talk.save("nc"))
    (change,) = json.loads(st.load(file).attrs["changes"])
    assert "coefficient = 0.7" in change["scenario"]


def test_ten_seconds_are_kept():
    instrument = Instrument(playable("stable-sliding", None, {}), "force")
    parts = [part for _ in range(1100) for part in instrument.play(480) if isinstance(part, Part)]
    played = np.concatenate([part.sound for part in parts])
    samples, _ = soundfile.read(io.BytesIO(instrument.last_seconds.wav()))
    assert len(samples) == 10 * RATE
    last = played[-len(samples) :] - played[-len(samples) :].mean()
    assert np.corrcoef(samples, last)[0, 1] > 0.999
