"""Loudness, sharpness and roughness: guard values, definitions, and refused sounds."""

from __future__ import annotations

import sys

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula.acoustics import sensation

from .sounds import heard, tone

pytestmark = pytest.mark.skipif(not sensation.is_available(), reason="takes mosqito")


def modulated(duration=0.4, level=60.0, carrier=1000.0, modulation=70.0, rate=48e3):
    """Return a tone with full amplitude modulation, of a total level."""
    time = np.arange(round(duration * rate)) / rate
    values = (1.0 + np.sin(2.0 * np.pi * modulation * time)) * np.sin(2.0 * np.pi * carrier * time)
    return heard(values * 20e-6 * 10.0 ** (level / 20.0) / np.sqrt(np.mean(values**2)), rate)


@pytest.mark.parametrize(("level", "guard"), [(40.0, 1.006), (60.0, 4.067), (80.0, 16.84)])
def test_loudness_of_1_khz(level, guard):
    assert float(st.loudness(tone(level=level, duration=2.0))) == pytest.approx(guard, rel=1e-3)


def test_loudness_does_not_depend_on_the_sample_rate():
    levels = [float(st.loudness(tone(3150.0, 65.0, 1.0, rate))) for rate in (44.1e3, 48e3, 100e3)]
    assert np.ptp(levels) < 5e-3 * levels[0]


def test_diffuse_sound_is_another_sound():
    free, diffuse = (float(st.loudness(tone(4000.0), field)) for field in sensation.FIELDS)
    assert abs(free - diffuse) > 0.1


def test_loudness_of_a_burst_comes_and_goes():
    burst = tone(level=60.0, duration=1.0)
    burst[24000:] = 0.0
    found = st.loudness_over_time(burst)
    assert float(found.sel(time=0.4, method="nearest")) == pytest.approx(4.0, rel=0.02)
    assert float(found.sel(time=0.9, method="nearest")) < 0.05
    np.testing.assert_allclose(np.diff(found.time), 2e-3, rtol=1e-9)


def test_sharpness_of_the_tone_that_defines_it_about():
    """DIN 45692 defines 1 acum by noise one critical band wide about 1 kHz, at 60 dB; a tone there comes close."""
    assert float(st.sharpness(tone(duration=0.5))) == pytest.approx(1.002, rel=2e-3)


def test_higher_sounds_are_sharper():
    values = [float(st.sharpness(tone(frequency, duration=0.5))) for frequency in (500.0, 1000.0, 4000.0, 8000.0)]
    assert values == sorted(values)


def test_roughness_of_the_tone_that_defines_it():
    found = st.roughness(modulated())
    np.testing.assert_allclose(found, 1.019, rtol=1e-3)
    np.testing.assert_allclose(found.time, [0.1, 0.2, 0.3])
    assert found.attrs["units"] == "asper"


def test_roughness_needs_modulation():
    assert float(st.roughness(tone(duration=0.2))[0]) < 0.02
    assert float(st.roughness(modulated(modulation=5.0))[0]) < 0.3


def bandwidth(frequency):
    """Width of the critical band about a frequency [Hz], ECMA-418-1."""
    return 25.0 + 75.0 * (1.0 + 1.4 * (frequency / 1e3) ** 2) ** 0.69


def in_noise(frequency, ratio, seed, duration=3.0):
    """Return a tone whose critical band in white noise has a level [dB] over that of the noise alone."""
    noise = np.random.default_rng(seed).standard_normal(round(48e3 * duration))
    time = np.arange(noise.size) / 48e3
    size = np.sqrt(2.0 * bandwidth(frequency) / 24e3 * (10.0 ** (ratio / 10.0) - 1.0))
    return heard(1e-2 * (noise + size * np.sin(2.0 * np.pi * frequency * time + seed)))


@pytest.mark.parametrize("seed", range(10))
def test_tones_in_noise_have_the_ratio_of_their_bands(seed):
    random = np.random.default_rng(seed)
    frequency, ratio = 10.0 ** random.uniform(2.4, 3.9), random.uniform(6.0, 40.0)
    found = st.prominent_tones(in_noise(frequency, ratio, seed))
    first = found.isel(tone=0)
    assert float(first.frequency) == pytest.approx(frequency, abs=0.1)
    # Bands beside it are not quite as wide, and the power of noise in three seconds of a band scatters.
    assert float(first.prominence_ratio) == pytest.approx(ratio, abs=1.5)
    assert (np.diff(found.prominence_ratio) <= 0.0).all()
    assert not found.prominent[1:].any()


@pytest.mark.parametrize("frequency", [400.0, 1500.0, 5000.0])
def test_a_tone_is_prominent_from_nine_decibels_on(frequency):
    limit = 9.0 + 10.0 * max(np.log10(1e3 / frequency), 0.0)
    for beyond in (-2.0, 2.0):
        first = st.prominent_tones(in_noise(frequency, limit + beyond, 3)).isel(tone=0)
        assert float(first.frequency) == pytest.approx(frequency, abs=0.5)
        assert bool(first.prominent) == (beyond > 0.0)


def test_tones_of_listeners_noise_and_silence():
    quiet, loud = heard(1e-3 * np.random.default_rng(0).standard_normal(48_000)), in_noise(2800.0, 30.0, 1, 1.0)
    both = xr.concat([loud, quiet, 0.0 * quiet], "listener").transpose("time", "listener")
    found = st.prominent_tones(both.assign_coords(listener=["ear", "noise", "silence"]))
    assert found.prominent.sum("tone").values.tolist() == [1, 0, 0]
    alone = st.prominent_tones(loud)
    xr.testing.assert_allclose(found.sel(listener="ear", drop=True).isel(tone=slice(alone.sizes["tone"])), alone)
    assert np.isnan(found.frequency.sel(listener="silence")).all()
    assert st.prominent_tones(0.0 * quiet).sizes["tone"] == 0
    assert found.prominence_ratio.attrs["units"] == "dB"


@pytest.mark.parametrize("function", [st.loudness, st.loudness_over_time, st.sharpness, st.roughness])
def test_each_listener_has_its_own_value(function):
    one = modulated(0.6)
    two = xr.concat([one, 0.0 * one], "listener").transpose("time", "listener").assign_coords(listener=["ear", "wall"])
    found = function(two)
    assert list(found.listener.values) == ["ear", "wall"]
    xr.testing.assert_allclose(found.sel(listener="ear", drop=True), function(one))
    quiet = found.sel(listener="wall")
    assert bool((np.isnan(quiet) if function is st.sharpness else quiet == 0.0).all())


@pytest.mark.parametrize(
    ("function", "duration", "message"),
    [
        (st.loudness, 0.4, "pressure must last at least 0.5 s for the loudness of a steady sound, got 0.4 s"),
        (st.loudness_over_time, 0.2, "pressure must last at least 0.25 s for loudness over time, got 0.2 s"),
        (st.sharpness, 0.4, "pressure must last at least 0.5 s for sharpness, got 0.4 s"),
        (st.prominent_tones, 0.4, "pressure must last at least 0.5 s for tones, got 0.4 s"),
        (st.roughness, 0.1, "pressure must last at least 0.2 s for roughness, got 0.1 s"),
    ],
)
def test_too_short_and_too_slow(function, duration, message):
    with pytest.raises(ValueError, match=message):
        function(tone(duration=duration))
    with pytest.raises(ValueError, match=r"pressure must be sampled at 28300 Hz or more for .*, got 16000 Hz"):
        function(tone(rate=16e3))


def test_fields_are_named():
    with pytest.raises(ValueError, match="field must be one of free, diffuse, got 'frontal'"):
        st.loudness(tone(), "frontal")


def test_a_missing_package_is_reported_with_its_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "mosqito.sq_metrics", None)
    monkeypatch.setitem(sys.modules, "mosqito", None)
    with pytest.raises(
        ImportError, match=r"need mosqito, which is not installed: pip install \"\.\[psycho\]\" in the so"
    ):
        st.loudness(tone())
