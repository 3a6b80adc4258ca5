"""`stridula signal` and its figures: recordings of known tones, levels and squeals."""

from __future__ import annotations

import numpy as np
import pandas
import pytest
import soundfile
import xarray as xr

import stridula as st
from stridula import analysis, plot

RATE = 51200.0
TIME = np.arange(int(2.0 * RATE)) / RATE


def tone(frequency, level, span=(0.5, 1.5), seed=0):
    """Return a tone of an unweighted level [dB] in faint noise."""
    amplitude = 2e-5 * np.sqrt(2.0) * 10.0 ** (level / 20.0)
    here = (span[0] <= TIME) & (span[1] > TIME)
    noise = 1e-3 * np.random.default_rng(seed).standard_normal(TIME.size)
    values = amplitude * np.sin(2.0 * np.pi * frequency * TIME) * here + noise
    return xr.DataArray(values, {"time": TIME}, ("time",), "sound", {"units": "Pa"})


def a_weighting(f):
    """A-weighting of IEC 61672-1 [dB]."""
    top = 12194.0**2 * f**4
    below = (f**2 + 20.6**2) * np.sqrt((f**2 + 107.7**2) * (f**2 + 737.9**2)) * (f**2 + 12194.0**2)
    return 20.0 * np.log10(top / below) + 2.0


@pytest.mark.parametrize(("frequency", "level"), [(2300.0, 80.0), (6400.0, 92.0), (1500.0, 75.0)])
def test_a_squeal_of_known_level_is_printed_and_written(tmp_path, stridula, frequency, level):
    for number, one in enumerate([tone(frequency, level), tone(frequency, 40.0, seed=1)]):
        st.write_signal(tmp_path / f"stop{number}.wav", one, full_scale=10.0)
    files = [f"stop{number}.wav" for number in range(2)]
    code, out, _ = stridula("signal", *files, "--out", "a.csv", "--plot", "a.png")
    assert code == 0
    assert "1 squeal in 1 of 2 sounds, 70 dB(A) or more from 1250 to 16000 Hz" in out
    table = pandas.read_csv(tmp_path / "a.csv")
    assert list(table["sound"]) == ["stop0.wav"]
    assert table["frequency [Hz]"][0] == pytest.approx(frequency, abs=0.5)
    assert table["level [dB(A)]"][0] == pytest.approx(level + a_weighting(frequency), abs=0.1)
    assert table["start [s]"][0] == pytest.approx(0.5, abs=0.02)
    assert table["duration [s]"][0] == pytest.approx(1.0, abs=0.04)
    row = next(line for line in out.splitlines() if line.strip().startswith("stop0.wav"))
    assert {"51200", "Pa", "2"} <= set(row.split())
    # The tone takes half of the time.
    expected = level + a_weighting(frequency) - 10.0 * np.log10(2.0)
    assert f"LAeq {expected:.1f}" in row or f"LAeq {expected + 0.1:.1f}" in row or f"LAeq {expected - 0.1:.1f}" in row
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_channels_of_other_units_have_no_level_and_speeds_no_regime(tmp_path, stridula):
    speed = np.linspace(600.0, 300.0, TIME.size)
    shaking = 5.0 * np.sin(2.0 * np.pi * 2300.0 * TIME)
    rig = {"caliper": ("time", shaking, {"units": "m/s2"}), "speed": ("time", speed, {"units": "rpm"})}
    st.write_signal(tmp_path / "rig.uff", xr.Dataset(rig, {"time": TIME}))
    code, out, _ = stridula("signal", "rig.uff")
    caliper, turning = (next(line for line in out.splitlines() if f" {word} " in line) for word in rig)
    assert code == 0
    assert "squeal, 1.00" in caliper
    assert {"3.536", "5"} <= set(caliper.split())
    assert "2300" in caliper
    assert turning.split()[-4:] == ["-"] * 4
    assert "squeals" not in out
    code, _, error = stridula("signal", "rig.uff", "--out", "a.csv")
    assert (code, error.strip()) == (2, "stridula: --out must have a channel in Pa, whose squeals it shows, got none")
    assert not (tmp_path / "a.csv").exists()


def test_a_calibration_makes_full_scale_a_pressure(tmp_path, stridula):
    given = tone(2300.0, 80.0)
    st.write_signal(tmp_path / "a.wav", given / 10.0, full_scale=1.0)
    values, rate = soundfile.read(tmp_path / "a.wav")
    soundfile.write(tmp_path / "plain.wav", values, rate, "PCM_24")
    _, out, _ = stridula("signal", "plain.wav")
    assert "FS" in out
    assert "squeal in" not in out
    _, out, _ = stridula("signal", "plain.wav", "--calibration", "10", "--units", "Pa")
    assert "1 squeal in 1 of 1 sound" in out


def test_a_coarse_sound_says_up_to_where_squeals_are_sought(tmp_path, stridula):
    given = tone(2300.0, 85.0)
    coarse = given.isel(time=slice(None, None, 2))
    st.write_signal(tmp_path / "a.csv", coarse)
    _, out, _ = stridula("signal", "a.csv")
    assert "from 1250 to 12740 Hz" in out
    st.write_signal(tmp_path / "b.csv", given.isel(time=slice(None, None, 25)))
    _, out, _ = stridula("signal", "b.csv", "--lowest", "2 kHz")
    assert "no squeals are sought: the sound is known up to 964 Hz only" in out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["none.wav"], "stridula: cannot read 'none.wav': no such file or directory"),
        (["a.csv", "--channel", "x"], "stridula: --channel must be one of those of 'a.csv': 'sound', got 'x'"),
        (["a.csv", "--calibration", "x"], "stridula: --calibration must be a number, got 'x'"),
        (["a.csv", "--sample-rate", "x"], "stridula: --sample-rate must be"),
        (["a.csv", "--lowest", "0"], "stridula: --lowest must be above 0, got 0"),
        (["a.csv", "--out", "a.wav"], "stridula: --out must be a table, .csv"),
    ],
)
def test_wrong_options_are_refused_in_one_line(tmp_path, stridula, arguments, words):
    st.write_signal(tmp_path / "a.csv", tone(2300.0, 80.0))
    code, _, error = stridula("signal", *arguments)
    assert code == 2
    assert error.startswith(words)
    assert error.count("\n") == 1


def test_the_figure_of_squeals_has_events_and_shares():
    sounds = [
        tone(2300.0, 80.0, seed=0),
        tone(2310.0, 85.0, seed=1),
        tone(9000.0, 90.0, seed=2),
        tone(3000.0, 60.0, seed=3),
    ]
    found = st.squeal_events(sounds)
    above, below = plot.squeal_events(found, title="stops").axes
    squeals, quiet = above.lines[:2]
    np.testing.assert_allclose(np.sort(squeals.get_xdata()), [2.3, 2.31, 9.0], rtol=1e-3)
    assert quiet.get_ydata() == pytest.approx([60.0 + a_weighting(3000.0)], abs=0.1)
    shares = {round(bar.get_height(), 9) for bar in below.patches}
    assert shares == {0.0, 0.25, 0.5}
    bar = next(bar for bar in below.patches if bar.get_height() == 0.5)
    assert bar.get_x() < 2.3 < 2.31 < bar.get_x() + bar.get_width()
    none = plot.squeal_events(st.squeal_events(tone(3000.0, 20.0)))
    assert "squeals in 0 of 1 stop" in none.get_suptitle()
    with pytest.raises(ValueError, match=r"^found must be the result of squeal_events"):
        plot.squeal_events(found.drop_vars("level"))


def test_the_figure_of_orders_shows_levels_and_speed():
    turns = 12.0 * TIME - 1.25 * TIME**2
    shaking = xr.DataArray(np.cos(6.0 * np.pi * turns), {"time": TIME}, ("time",), attrs={"units": "m/s2"})
    speed = xr.DataArray(60.0 * (12.0 - 2.5 * TIME), {"time": TIME}, ("time",), attrs={"units": "rpm"})
    found = analysis.order_spectrum(shaking, speed)
    left, right, bar = plot.order_spectrum(found).axes
    levels = left.collections[0].get_array().reshape(found.shape)
    assert found["order"].values[levels.mean(axis=0).argmax()] == 3.0
    assert levels.max() == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(right.lines[0].get_xdata(), 60.0 * found["speed"])
    assert "dB re 0.707 m/s2" in bar.get_ylabel()
    with pytest.raises(ValueError, match=r"^found must be the result of order_spectrum"):
        plot.order_spectrum(shaking)
