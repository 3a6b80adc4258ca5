"""Sound files: they are read back in pascals, without clipping or aliasing."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import soundfile
import xarray as xr

import stridula as st
from stridula.acoustics.sample_rates import ratio, resampled

from .sounds import heard, tone


def amplitude(values, rate, frequency):
    """Return the amplitude of a tone in the middle half of a signal, under a Blackman-Harris-like window."""
    middle = np.asarray(values)[values.shape[0] // 4 : 3 * values.shape[0] // 4]
    window = np.blackman(middle.size)
    time = np.arange(middle.size) / rate
    return 2.0 * np.abs(np.sum(window * middle * np.exp(-2j * np.pi * frequency * time))) / window.sum()


@pytest.mark.parametrize(("subtype", "error"), [("PCM_24", 2.0**-24), ("FLOAT", 2.0**-24)])
@pytest.mark.parametrize("rate", [44100, 48000, 96000])
def test_a_file_at_its_own_rate_gives_the_samples_back(tmp_path, subtype, error, rate):
    given = heard(np.random.default_rng(0).uniform(-1.9, 1.9, (4000, 2)), rate, start=0.25, units="Pa")
    said = st.write_wav(tmp_path / "a.wav", given, sample_rate=rate, full_scale=2.0, subtype=subtype)
    back = st.read_wav(tmp_path / "a.wav")
    assert np.abs(back.values - given.values).max() <= 2.0 * error * 1.0000001
    np.testing.assert_allclose(back.time, given.time, rtol=1e-12)
    assert back.dims == ("time", "listener")
    assert back.attrs["full_scale"] == said.full_scale == 2.0
    assert soundfile.info(tmp_path / "a.wav").subtype == subtype
    assert "calibrated" in str(said)


@pytest.mark.parametrize("rate", [100e3, 20e3, 1.0 / 9.9873e-6, 44100.0])
@pytest.mark.parametrize("wanted", [44100, 48000, 96000])
@pytest.mark.parametrize("frequency", [31.25, 1000.0, 8000.0])
def test_a_tone_keeps_its_level(tmp_path, rate, wanted, frequency):
    st.write_wav(tmp_path / "a.wav", tone(frequency, 94.0, 0.5, rate), sample_rate=wanted, full_scale=2.0)
    back = st.read_wav(tmp_path / "a.wav").values[:, 0]
    level = 20.0 * np.log10(amplitude(back, wanted, frequency) / np.sqrt(2.0) / 20e-6)
    assert level == pytest.approx(94.0, abs=1e-3)


@pytest.mark.parametrize(("wanted", "frequencies"), [(44100, (22100.0, 25e3, 43.1e3)), (48000, (24.1e3, 47e3))])
def test_inaudible_frequencies_are_not_aliased(wanted, frequencies):
    for frequency in frequencies:
        inside = resampled(tone(frequency, 94.0, 0.2, 100e3).values[:, None], 100e3, wanted)[:, 0]
        folded = abs(frequency - wanted)
        assert amplitude(inside, wanted, folded) < 10.0 ** (-100.0 / 20.0) * np.sqrt(2.0)
        middle = inside[inside.size // 4 : 3 * inside.size // 4]
        assert np.abs(middle).max() < 10.0 ** (-100.0 / 20.0) * np.sqrt(2.0)


def test_a_plain_decimation_would_alias():
    """Negative control of the measure above."""
    every_second = tone(30e3, 94.0, 0.2, 96e3).values[::2]
    assert amplitude(every_second, 48e3, 18e3) == pytest.approx(np.sqrt(2.0), rel=0.01)


@pytest.mark.parametrize("rate", [8e3, 20e3, 31234.5])
def test_no_image_is_left_above_the_original_band(rate):
    frequency = 0.4 * rate
    finer = resampled(tone(frequency, 94.0, 0.2, rate).values[:, None], rate, 96e3)[:, 0]
    assert amplitude(finer, 96e3, rate - frequency) < 1e-5


def test_rates_are_in_a_ratio_of_whole_numbers():
    assert ratio(100e3, 44100.0) == ratio(1.0 / 1e-5, 44100.0) == Fraction(441, 1000)
    assert ratio(48e3, 44100.0) == Fraction(147, 160)
    for rate in (1.0 / 9.9873e-6, 12345.678, 1e6 * np.pi):
        assert float(ratio(rate, 48000.0)) == pytest.approx(48000.0 / rate, rel=4e-6)


def test_a_later_ear_is_the_second_channel(tmp_path):
    """A click reaches the left ear first: listener 0 is channel 0."""
    values = np.zeros((480, 2))
    values[100, 0] = values[130, 1] = 0.5
    st.write_wav(tmp_path / "a.wav", heard(values), full_scale=1.0)
    samples, rate = soundfile.read(tmp_path / "a.wav")
    assert (rate, list(samples.argmax(axis=0))) == (48000, [100, 130])


def test_the_file_states_its_scale_to_other_programs(tmp_path):
    st.write_wav(tmp_path / "a.wav", tone(start=0.5), full_scale=0.1)
    with soundfile.SoundFile(tmp_path / "a.wav") as file:
        assert file.comment == "stridula: full_scale_pascal=0.1 start_second=0.5"


def test_a_normalised_file_peaks_one_decibel_below_full_scale(tmp_path):
    said = st.write_wav(tmp_path / "a.wav", tone(level=100.0))
    peak = np.sqrt(2.0) * 2.0
    assert said.normalised
    assert said.full_scale == pytest.approx(peak * 10.0**0.05, rel=1e-6)
    assert f"normalised by a gain of {1.0 / said.full_scale:.4g} /Pa" in str(said)
    assert np.abs(soundfile.read(tmp_path / "a.wav")[0]).max() == pytest.approx(10.0**-0.05, rel=1e-6)
    assert np.abs(st.read_wav(tmp_path / "a.wav")).max() == pytest.approx(peak, rel=1e-6)


def test_silence_stays_silence_and_is_reported(tmp_path):
    said = st.write_wav(tmp_path / "a.wav", heard(np.zeros((100, 2))))
    assert "silence (full scale 1 Pa)" in str(said)
    assert not st.read_wav(tmp_path / "a.wav").values.any()


def test_nothing_is_clipped(tmp_path):
    path = tmp_path / "a.wav"
    said = r"full_scale must be at least 2\.00001 Pa for a peak of 2 Pa, got 2\.0 Pa: it would be clipped"
    with pytest.raises(ValueError, match=said):
        st.write_wav(path, heard([0.0, 2.0, -1.0]), full_scale=2)
    assert not path.exists()
    st.write_wav(path, heard([0.0, 2.0, -1.0]), full_scale=2.00001)
    st.write_wav(path, heard([0.0, 2.0, -3.0]), full_scale=1.0, subtype="FLOAT")
    assert list(st.read_wav(path).values[:, 0]) == [0.0, 2.0, -3.0]


@pytest.mark.parametrize(("period", "grows"), [(50, True), (1, False)])
@pytest.mark.parametrize("subtype", ["PCM_24", "FLOAT"])
def test_the_peak_is_that_of_the_file_at_its_own_rate(tmp_path, subtype, period, grows):
    """A low-pass lets a square wave overshoot, and a click sink."""
    path = tmp_path / "a.wav"
    values = np.sign(np.sin(2.0 * np.pi * np.arange(4000.0) / period + 0.1)) if grows else np.eye(1, 4000, 2000)[0]
    given = heard(values, 100e3)
    normalised = st.write_wav(path, given, subtype=subtype)
    peak = float(np.abs(st.read_wav(path)).max())
    assert normalised.peak == pytest.approx(peak, rel=1e-6)
    assert f"peak as written {peak:.4g} Pa" in str(normalised)
    assert normalised.full_scale == pytest.approx(peak * 10.0**0.05, rel=1e-6)
    assert (peak > 1.05) is grows
    assert (peak < 0.6) is not grows
    if subtype == "PCM_24":
        # Between the peak of the sound and that of the file.
        between = 0.5 * (1.0 + peak)
        if grows:
            with pytest.raises(ValueError, match=f"full_scale must be at least .* for a peak of {peak:.4}.*clipped"):
                st.write_wav(path, given, full_scale=between)
        else:
            st.write_wav(path, given, full_scale=between)
    calibrated = st.write_wav(path, given, full_scale=peak * 1.00001, subtype=subtype)
    assert float(np.abs(st.read_wav(path)).max()) == pytest.approx(calibrated.peak, rel=1e-6)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"sample_rate": 22050}, "sample_rate must be one of 44100, 48000, 96000 Hz, got 22050"),
        ({"subtype": "PCM_16"}, "subtype must be one of PCM_24, FLOAT, got 'PCM_16'; did you mean 'PCM_24'"),
        ({"full_scale": "normalized"}, "full_scale must be one of normalised, got 'normalized'; did you mean"),
        ({"full_scale": 0.0}, r"full_scale must be above 0, got 0\.0"),
    ],
)
def test_arguments_out_of_range(tmp_path, words, message):
    with pytest.raises(ValueError, match=message):
        st.write_wav(tmp_path / "a.wav", tone(), **words)
    assert not any(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("pressure", "message"),
    [
        (np.zeros(5), "pressure must be a DataArray, got"),
        (heard(np.zeros(1)), r"at least 2 samples\) and listener, got {'time': 1}"),
        (heard(np.zeros((3, 2))).T, "pressure must have the dimensions time"),
        (heard(np.zeros((3, 0))), "pressure must have the dimensions time"),
        (heard([0.0, np.nan]), "pressure must be finite, got 1 values"),
        (heard([0.0, 1.0], units="N"), "pressure must be in Pa, got 'N'"),
        (heard([0.0, 1.0]).drop_vars("time"), "pressure must have the coordinate time"),
        (heard([0.0, 1.0, 2.0]).assign_coords(time=[0.0, 1.0, 5.0]), "pressure must be evenly sampled"),
        (heard([0.0, 1.0]).assign_coords(time=[0.0, 0.0]), "pressure must be evenly sampled"),
    ],
)
def test_bad_sound_pressures_are_refused(tmp_path, pressure, message):
    with pytest.raises(ValueError, match=message):
        st.write_wav(tmp_path / "a.wav", pressure)


def test_places_that_cannot_be_written(tmp_path):
    with pytest.raises(OSError, match=r"cannot write .*: there is no folder"):
        st.write_wav(tmp_path / "nowhere" / "a.wav", tone())


def test_files_without_sound_or_scale_are_refused(tmp_path):
    path = Path(tmp_path / "a.wav")
    with pytest.raises(FileNotFoundError, match="cannot read"):
        st.read_wav(path)
    path.write_bytes(b"no sound")
    with pytest.raises(ValueError, match=r"^path must be a sound file, got '.*a\.wav': Format not recognised\.$"):
        st.read_wav(path)
    soundfile.write(path, np.array([0.0, 0.5]), 8000, subtype="PCM_16")
    with pytest.raises(ValueError, match="full_scale must be given for a file without a stated full scale"):
        st.read_wav(path)
    assert list(st.read_wav(path, full_scale=4.0).values[:, 0]) == [0.0, 2.0]


def test_a_rate_that_is_an_array_is_refused_in_one_line(tmp_path):
    rate = xr.DataArray(np.arange(3.0))
    with pytest.raises(ValueError, match=r"^sample_rate must be one of 44100, 48000, 96000 Hz, got .*$") as refused:
        st.write_wav(tmp_path / "a.wav", rate, sample_rate=rate[1])
    assert "\n" not in str(refused.value)
