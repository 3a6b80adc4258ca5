"""Levels of sounds whose levels are known; filters within the limits of their standards."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.acoustics.levels import NOMINAL, band_gain
from stridula.weighting import a_weighting

from .sounds import heard, noise, tone

# IEC 61672-1:2013, table 3: A-weighting [dB] at 10^(n/10) Hz, n from 10 to 43; limits of class 1 below and above.
A_TABLE = """
-70.4 -inf 3.0|-63.4 -inf 2.5|-56.7 -4.0 2.0|-50.5 -2.0 2.0|-44.7 -1.5 2.0|-39.4 -1.5 1.5|-34.6 -1.0 1.0|
-30.2 -1.0 1.0|-26.2 -1.0 1.0|-22.5 -1.0 1.0|-19.1 -1.0 1.0|-16.1 -1.0 1.0|-13.4 -1.0 1.0|-10.9 -1.0 1.0|
-8.6 -1.0 1.0|-6.6 -1.0 1.0|-4.8 -1.0 1.0|-3.2 -1.0 1.0|-1.9 -1.0 1.0|-0.8 -1.0 1.0|0.0 -0.7 0.7|0.6 -1.0 1.0|
1.0 -1.0 1.0|1.2 -1.0 1.0|1.3 -1.0 1.0|1.2 -1.0 1.0|1.0 -1.0 1.0|0.5 -1.5 1.5|-0.1 -2.0 1.5|-1.1 -2.5 1.5|
-2.5 -3.0 2.0|-4.3 -5.0 2.0|-6.6 -16.0 2.5|-9.3 -inf 3.0
"""
A_ROWS = np.array([[float(word) for word in row.split()] for row in A_TABLE.replace("\n", "").split("|")])
EXACT = 10.0 ** (np.arange(10, 44) / 10.0)


def a_gain(frequency):
    """Return the A-weighting [dB] of IEC 61672-1:2013, annex E, from the frequencies that define its poles."""
    low, reference, high, weighting = 10.0**1.5, 1000.0, 10.0**3.9, 10.0**2.45
    half = np.sqrt(0.5)
    c = low**2 * high**2
    b = (reference**2 + c / reference**2 - half * (low**2 + high**2)) / (1.0 - half)
    first, last = (np.sqrt((-b + sign * np.sqrt(b**2 - 4.0 * c)) / 2.0) for sign in (-1.0, 1.0))
    second, third = ((3.0 + sign * np.sqrt(5.0)) / 2.0 * weighting for sign in (-1.0, 1.0))

    def weight(f):
        rest = np.sqrt((f**2 + second**2) * (f**2 + third**2))
        return last**2 * f**4 / ((f**2 + first**2) * rest * (f**2 + last**2))

    return 20.0 * np.log10(weight(frequency) / weight(reference))


def test_a_weighting_is_the_standards_to_its_last_digit():
    """Table and formula of the standard agree with each other and with the code."""
    np.testing.assert_array_equal(np.round(a_gain(EXACT), 1), A_ROWS[:, 0])
    gains = 20.0 * np.log10(np.abs(a_weighting(EXACT)))
    np.testing.assert_array_equal(np.round(gains, 1), A_ROWS[:, 0])
    np.testing.assert_allclose(gains, a_gain(EXACT), atol=1e-6)
    assert abs(a_weighting(np.array(1000.0))) == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize("rate", [48e3, 100e3])
def test_weighted_levels_of_tones_are_within_class_1(rate):
    for frequency, (gain, low, high) in zip(EXACT, A_ROWS, strict=True):
        # Faded in and out: an abrupt start would mask a tone weighted by -70 dB.
        sound = tone(frequency, 90.0, 2.0, rate)
        sound *= np.hanning(sound.size)
        change = float(st.equivalent_level(sound, "A") - st.equivalent_level(sound))
        assert gain + max(low, -0.1) <= change <= gain + min(high, 0.1), frequency


@pytest.mark.parametrize("rate", [25.6e3, 32e3])
def test_weighted_levels_are_those_of_the_table_at_lower_rates_and_say_where_they_end(rate):
    known = 0.5 * rate > EXACT
    for frequency, (gain, _, _) in zip(EXACT[known], A_ROWS[known], strict=True):
        sound = tone(frequency, 90.0, 2.0, rate)
        sound *= np.hanning(sound.size)
        level = st.equivalent_level(sound, "A")
        assert float(level - st.equivalent_level(sound)) == pytest.approx(gain, abs=0.1), frequency
    assert level.attrs["bandwidth"] == pytest.approx(0.5 * rate)
    assert level.attrs["long_name"].endswith(f", up to {rate / 2e3:.4g} kHz")
    assert st.sound_level(sound).attrs["bandwidth"] == pytest.approx(0.5 * rate)
    assert "bandwidth" not in st.equivalent_level(tone(rate=48e3), "A").attrs


def test_a_computed_sound_says_where_its_level_ends():
    level = st.equivalent_level(tone(bandwidth=8333.0), "A")
    assert level.attrs["long_name"].endswith(", up to 8.333 kHz")


def test_equivalent_level_of_a_tone_and_of_silence():
    two = heard(np.stack([tone(level=74.0).values, np.zeros(48000)], axis=1), units="Pa")
    two = two.assign_coords(listener=["ear", "wall"])
    levels = st.equivalent_level(two)
    assert levels.dims == ("listener",)
    assert float(levels.sel(listener="ear")) == pytest.approx(74.0, abs=1e-9)
    assert float(levels.sel(listener="wall")) == -np.inf
    assert (levels.name, levels.attrs["units"]) == ("Leq", "dB")
    assert float(st.equivalent_level(two, "A")[0]) == pytest.approx(74.0, abs=0.01)


def test_halved_time_halves_the_energy():
    burst = tone(level=80.0, duration=2.0)
    burst[48000:] = 0.0
    assert float(st.equivalent_level(burst)) == pytest.approx(80.0 - 10.0 * np.log10(2.0), abs=1e-9)


@pytest.mark.parametrize(("response", "constant"), [("fast", 0.125), ("slow", 1.0)])
def test_time_weighting_rises_and_falls_with_its_constant(response, constant):
    """IEC 61672-1: a tone burst of length T reads 10 lg(1 - exp(-T/tau)) below the steady tone, then decays."""
    burst = tone(4000.0, 90.0, 3.0)
    burst[48000:] = 0.0
    levels = st.sound_level(burst, "Z", response)
    assert levels.dims == burst.dims
    assert float(levels[47999]) == pytest.approx(90.0 + 10.0 * np.log10(1.0 - np.exp(-1.0 / constant)), abs=0.01)
    fall = float(levels.sel(time=1.5, method="nearest") - levels.sel(time=2.0, method="nearest"))
    assert fall == pytest.approx(0.5 / constant * 10.0 * np.log10(np.e), rel=1e-6)
    assert levels.name == {"fast": "LZF", "slow": "LZS"}[response]


# Class 1 [dB]: relative attenuation at G^x, at least and at most, the narrowest of the editions of 1995 and 2014.
CLASS_1 = (
    (0.0, -0.3, 0.3),
    (1 / 8, -0.3, 0.4),
    (1 / 4, -0.3, 0.6),
    (3 / 8, -0.3, 1.3),
    (0.4999, -0.3, 5.0),
    (0.5001, 2.0, np.inf),
    (1.0, 17.5, np.inf),
    (2.0, 42.0, np.inf),
    (3.0, 61.0, np.inf),
    (4.0, 70.0, np.inf),
)


@pytest.mark.parametrize(("power", "least", "most"), CLASS_1)
def test_bands_are_within_class_1(power, least, most):
    octave = 10.0**0.3
    third = 1.0 + (octave ** (1 / 6) - 1.0) / (octave**0.5 - 1.0) * (octave**power - 1.0)
    for side in (third, 1.0 / third):
        attenuation = -10.0 * np.log10(float(band_gain(np.array([1000.0 * side]), 1000.0)[0]))
        assert least <= attenuation <= most


def test_bands_are_as_wide_as_they_should_be():
    """IEC 61260-1: class 1 allows the effective bandwidth to be 0.4 dB off."""
    frequency = np.arange(1.0, 48e3)
    width = np.sum(band_gain(frequency, 1000.0)) / (1000.0 * (10.0**0.05 - 10.0**-0.05))
    assert abs(10.0 * np.log10(width)) < 0.06


def test_a_tone_is_in_its_band():
    levels = st.third_octave_levels(tone(1000.0, 70.0, 1.0), highest=20000.0)
    assert list(levels.band.values) == list(NOMINAL[4:34])
    assert levels.band.values[0] == 25.0
    assert float(levels.sel(band=1000.0)) == pytest.approx(70.0, abs=0.01)
    # Order 6 leaves -36.4 dB at the next centre, and an abrupt start spreads.
    assert float(levels.drop_sel(band=1000.0).max()) < 70.0 - 32.0
    assert float(levels.drop_sel(band=[800.0, 1000.0, 1250.0]).max()) < 70.0 - 40.0
    assert float(levels.centre.sel(band=1250.0)) == pytest.approx(1258.925, abs=1e-3)


@pytest.mark.parametrize("band", [25.0, 31.5, 160.0, 4000.0, 16000.0])
def test_every_centre_reads_its_level(band):
    centre = 10.0 ** (np.round(10.0 * np.log10(band)) / 10.0)
    levels = st.third_octave_levels(tone(centre, 70.0, 4.0, 100e3))
    assert float(levels.sel(band=band)) == pytest.approx(70.0, abs=0.15)


def test_bands_of_white_noise_rise_by_one_decibel_and_add_up():
    sound = noise(80.0, 20.0)
    levels = st.third_octave_levels(sound, lowest=100.0, highest=20000.0)
    slope = np.polyfit(np.arange(levels.size), levels.values, 1)[0]
    assert slope == pytest.approx(1.0, abs=0.02)
    share = (10.0**4.35 - 10.0**1.95) / 24e3
    total = 10.0 * np.log10(np.sum(10.0 ** (levels.values / 10.0)) / share)
    assert total == pytest.approx(80.0, abs=0.1)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: st.equivalent_level(tone(duration=0.01)),
            "pressure must last at least 0.05 s for a level, got 0.01 s",
        ),
        (
            lambda: st.equivalent_level(tone(rate=16e3), "A"),
            "sampled at 20000 Hz or more for A-weighting, got 16000 Hz",
        ),
        (lambda: st.equivalent_level(tone(), "C"), "weighting must be one of Z, A, got 'C'"),
        (lambda: st.sound_level(tone(), response="impulse"), "response must be one of fast, slow, got 'impulse'"),
        (
            lambda: st.third_octave_levels(tone(duration=0.1)),
            "pressure must last at least 0.173 s for a lowest band of",
        ),
        (
            lambda: st.third_octave_levels(tone(rate=20e3)),
            "sampled at 35565.6 Hz or more for a highest band of 16000 Hz",
        ),
        (
            lambda: st.third_octave_levels(tone(), lowest=26.0),
            "lowest must be the nominal centre .*; the nearest is 25",
        ),
        (lambda: st.third_octave_levels(tone(), highest=40e3), "highest must be the nominal centre"),
        (
            lambda: st.third_octave_levels(tone(), 1000.0, 100.0),
            r"highest must be at or above the lowest band of 1000\.0",
        ),
    ],
)
def test_unmeasurable_sounds_are_refused_in_one_line(call, message):
    with pytest.raises(ValueError, match=message):
        call()
