"""Squeal events of sounds with known answers: levels, bands, times, stops."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula.weighting import a_weighting

from .sounds import heard, noise, tone


def weighted(frequency, level, duration=1.0, rate=48e3):
    """Return a tone of an A-weighted level [dB]."""
    gain = 20.0 * np.log10(abs(a_weighting(np.array(frequency))))
    return tone(frequency, level - gain, duration, rate)


def burst(sound, start, end, length=2.0):
    """Return a sound that is heard in an interval alone."""
    rate = 1.0 / float(sound.time[1] - sound.time[0])
    values = np.zeros(round(length * rate))
    first, last = round(start * rate), round(end * rate)
    values[first:last] = sound.values[: last - first]
    return heard(values, rate)


@pytest.mark.parametrize("frequency", [1251.0, 2013.7, 3150.0, 7777.3, 14990.0])
@pytest.mark.parametrize("rate", [30.2e3, 44.1e3, 51.2e3])
def test_a_squeal_has_70_decibels_or_more(frequency, rate):
    for level, squeals in ((69.9, False), (70.1, True), (69.99, False), (70.01, True)):
        found = st.squeal_events(weighted(frequency, level, rate=rate), highest=15e3)
        assert found.squeals.values.tolist() == [squeals], (level, frequency)
        assert float(found.peak_level[0]) == pytest.approx(level, abs=0.005)
        assert float(found.peak_frequency[0]) == pytest.approx(frequency, abs=0.1)
        assert float(found.occurrence) == squeals


def test_random_tones_have_their_levels_and_frequencies():
    dice = np.random.default_rng(3)
    for _ in range(40):
        frequency, level, rate = dice.uniform(1300, 9900), dice.uniform(60, 110), dice.uniform(20.5e3, 60e3)
        found = st.squeal_events(weighted(frequency, level, 0.3, rate), highest=10e3, threshold=50.0)
        assert found.sizes["event"] == 1
        assert float(found.level[0]) == pytest.approx(level, abs=0.01)
        assert float(found.frequency[0]) == pytest.approx(frequency, abs=0.2)


@pytest.mark.parametrize(
    ("frequency", "lowest", "inside"),
    [
        (1249.0, 1250.0, 0),
        (1251.0, 1250.0, 1),
        (1999.0, 2000.0, 0),
        (2001.0, 2000.0, 1),
        (15999.0, 1250.0, 1),
        (16001.0, 1250.0, 0),
    ],
)
def test_the_band_ends_at_its_edges(frequency, lowest, inside):
    found = st.squeal_events(weighted(frequency, 90.0), lowest=lowest)
    assert found.sizes["event"] == inside


def test_two_tones_are_two_events():
    both = weighted(2000.0, 85.0) + weighted(3000.0, 75.0)
    found = st.squeal_events(both)
    np.testing.assert_allclose(found.frequency, [2000.0, 3000.0], atol=0.1)
    np.testing.assert_allclose(found.level, [85.0, 75.0], atol=0.05)
    assert int(found.events[0]) == 2
    # One of them is too faint.
    found = st.squeal_events(weighted(2000.0, 85.0) + weighted(3000.0, 69.0))
    np.testing.assert_allclose(found.frequency, [2000.0], atol=0.1)


@pytest.mark.parametrize("level", [73.0, 80.0, 100.0])
def test_ends_are_known_to_half_a_frame(level):
    sound = burst(weighted(2500.0, level), 0.4, 0.9) + burst(weighted(2500.0, level), 1.3, 1.7)
    found = st.squeal_events(sound)
    np.testing.assert_allclose(found.start, [0.4, 1.3], atol=0.025)
    np.testing.assert_allclose(found.end, [0.9, 1.7], atol=0.025)
    np.testing.assert_allclose(found.duration, found.end - found.start)


def test_a_tone_that_glides_is_one_event():
    time = np.arange(96000) / 48e3
    phase = 2.0 * np.pi * (2000.0 * time + 0.5 * 200.0 * time**2)
    found = st.squeal_events(heard(np.sin(phase)))
    assert found.sizes["event"] == 1
    assert float(found.duration[0]) == pytest.approx(2.0, abs=0.05)


def test_noise_is_no_squeal():
    found = st.squeal_events(noise(95.0, 5.0))
    assert found.sizes["event"] == 0
    assert float(found.occurrence) == 0.0
    with_tone = noise(70.0, 1.0) + weighted(4000.0, 75.0)
    assert st.squeal_events(with_tone).frequency.values.tolist() == pytest.approx([4000.0], abs=1.0)


def test_occurrence_over_stops():
    sounds = {"warm": weighted(2500.0, 80.0), "cold": weighted(2500.0, 60.0), "wet": weighted(500.0, 90.0)}
    found = st.squeal_events(sounds)
    assert list(found.stop.values) == ["warm", "cold", "wet"]
    assert found.squeals.values.tolist() == [True, False, False]
    assert float(found.occurrence) == pytest.approx(1.0 / 3.0)
    assert found.event_stop.values.tolist() == ["warm"]
    assert st.squeal_events(list(sounds.values())).event_stop.values.tolist() == [0]


def test_overlapping_stops_of_one_recording_count_separately():
    sound = burst(weighted(2500.0, 80.0), 0.8, 1.2)
    found = st.squeal_events(sound, [(0.0, 1.0), (0.5, 1.5), (1.3, 2.0)])
    assert found.squeals.values.tolist() == [True, True, False]
    np.testing.assert_allclose(found.end, [1.0, 1.2], atol=0.025)
    np.testing.assert_allclose(found.start, [0.8, 0.8], atol=0.025)
    assert float(found.occurrence) == pytest.approx(2.0 / 3.0)


def test_each_listener_has_its_events():
    ears = np.stack([weighted(2500.0, 80.0).values, weighted(2500.0, 60.0).values], axis=1)
    found = st.squeal_events(heard(ears).assign_coords(listener=["near", "far"]))
    assert found.event_listener.values.tolist() == ["near"]
    assert float(found.peak_level[0]) == pytest.approx(80.0, abs=0.01)


def test_a_computed_sound_squeals_at_the_pitch_of_its_run_also_when_it_is_recorded(tmp_path):
    scenario = st.load_scenario("strong-pressure")
    run = scenario.simulate(duration=0.6)
    sound = st.radiate(run, scenario.system.track, (0.7, 0.0, 0.5)).isel(listener=0)
    found = st.squeal_events(sound)
    assert bool(found.squeals[0])
    np.testing.assert_allclose(found.frequency, float(st.regime(run).frequency), rtol=0.02)
    for name in ("a.wav", "a.flac", "a.csv", "a.uff"):
        st.write_signal(tmp_path / name, sound)
        recorded = st.squeal_events(st.read_signal(tmp_path / name))
        np.testing.assert_allclose(recorded.level, found.level, atol=0.01)
        np.testing.assert_allclose(recorded.start, found.start, atol=1e-6)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: st.squeal_events(tone(rate=25.6e3)), r"^highest must be at most 12740 Hz, up to which .*16000\.0 Hz$"),
        (lambda: st.squeal_events(tone(duration=0.01)), r"^pressure must last at least 0\.05 s for a frame of squeal"),
        (lambda: st.squeal_events(tone(units="FS")), r"^pressure must be in Pa, got 'FS', relative to full scale"),
        (lambda: st.squeal_events(tone(), [(0.0, 3.0)]), r"^stops must lie in the sound, got 0 to 3 s in 0 to 0\.99"),
        (lambda: st.squeal_events(tone(), [(0.5, 0.1)]), r"^stops must end after they start"),
        (lambda: st.squeal_events(tone(), 3.0), r"^stops must be pairs of start and end in s, got 3\.0$"),
        (lambda: st.squeal_events([]), r"^sound must have a stop, got none$"),
        (lambda: st.squeal_events([tone()], [(0.0, 0.5)]), r"^stops must be left out with a sound for each stop"),
        (lambda: st.squeal_events(tone(), lowest=17e3), r"^highest must be above the lowest frequency"),
        (lambda: st.squeal_events(tone(), frame=1e-3), r"^frame must last at least 8 periods of 1250\.0 Hz"),
        (lambda: st.squeal_events("a.wav"), r"^sound must be a DataArray, got 'a.wav'$"),
        (lambda: st.squeal_events([xr.Dataset()]), r"^sound must be a DataArray"),
    ],
)  # fmt: skip
def test_other_sounds_are_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
