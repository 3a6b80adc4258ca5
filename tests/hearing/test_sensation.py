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
