"""Figures of sounds with known content."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula import plot

from .sounds import heard, tone


@pytest.fixture(scope="module")
def squeal():
    """Return a short run of the squealing pair, and its scenario."""
    scenario = st.load_scenario("squeal", {"duration": 0.05})
    return scenario.simulate(), scenario


def mesh(figure):
    """Return times, frequencies [kHz] and levels of the spectrogram in a figure."""
    axes = next(axes for axes in figure.axes if axes.get_ylabel() == "frequency [kHz]")
    (drawn,) = (one for one in axes.collections if type(one).__name__ == "QuadMesh")
    corners = drawn.get_coordinates()
    middles = 0.25 * (corners[1:, 1:] + corners[1:, :-1] + corners[:-1, 1:] + corners[:-1, :-1])
    return middles[0, :, 0], middles[:, 0, 1], drawn.get_array().data.reshape(middles.shape[:2])


def test_a_tone_is_drawn_at_its_frequency_level_and_time():
    sound = tone(3000.0, 74.0, 1.0, units="Pa")
    sound[:24000] = 0.0
    time, frequency, levels = mesh(plot.spectrogram(sound.assign_coords(time=sound.time + 2.0)))
    after = levels[:, time > 2.55]
    assert frequency[after[:, 0].argmax()] == pytest.approx(3.0, abs=0.05)
    np.testing.assert_allclose(after.max(axis=0), 74.0, atol=0.05)
    assert levels[:, time < 2.45].max() <= -200.0 + 1e-9


def test_contact_and_sound_share_one_time_axis(squeal):
    run, _ = squeal
    figure = plot.spectrogram(run.normal_force, run)
    force, sound, status, colours = figure.axes
    assert [axes.get_ylabel() for axes in (force, status)] == ["normal force\n[N]", "status"]
    assert force.get_xlim() == sound.get_xlim() == status.get_xlim()
    assert status.get_xlabel() == "time [s]"
    assert colours.get_ylabel() == "level [dB re 1 N]"
    assert sorted(text.get_text() for text in status.get_legend().get_texts()) == ["separated", "sliding", "sticking"]


def test_a_signal_as_short_as_the_window_is_drawn():
    time, _, levels = mesh(plot.spectrogram(tone(duration=0.02), window=0.02))
    assert time.size == levels.shape[1] == 1


def test_density_of_white_noise_is_flat_and_that_of_a_tone_stands_out():
    values = np.random.default_rng(2).standard_normal(96000)
    (axes,) = plot.spectrum(heard(values, units="Pa"), highest=24e3).axes
    (line,) = axes.get_lines()
    expected = 10.0 * np.log10(1.0 / 24e3 / (20e-6) ** 2)
    assert np.median(line.get_ydata()) == pytest.approx(expected, abs=0.5)
    assert axes.get_ylabel() == "power spectral density\n[dB re (20 µPa)²/Hz]"
    (line,) = plot.spectrum(tone(5000.0)).axes[0].get_lines()
    assert line.get_xdata()[line.get_ydata().argmax()] == pytest.approx(5.0, abs=1e-3)


def test_natural_frequencies_and_growing_modes_are_marked():
    scenario = st.load_scenario("strong-pressure", {"duration": 0.05})
    run = scenario.simulate()
    stability = st.sliding_stability(scenario.system)
    (axes,) = plot.spectrum(run.normal_force, scenario.system, stability).axes
    growing = stability.frequency.values[stability.unstable.values]
    growing = growing[growing <= 16e3]
    assert growing.size > 0
    lines = [line.get_xdata()[0] for line in axes.get_lines() if line.get_linestyle() == "--"]
    np.testing.assert_allclose(lines, growing / 1e3)
    texts = [text.get_text() for text in axes.texts]
    assert f"{growing[0]:.0f} Hz, grows by {stability.growth_rate.values[stability.unstable.values][0]:.0f} /s" in texts
    assert {"slider", "track"} <= set(texts)
    ticks = [segment[0][0] for one in axes.collections for segment in one.get_segments()]
    for body in scenario.system.bodies:
        frequency = body.modes(scenario.system.is_held(body)).frequency
        assert set(np.round(frequency[(frequency > 0) & (frequency <= 16e3)] / 1e3, 9)) <= set(np.round(ticks, 9))


def test_each_listener_is_a_line():
    two = heard(np.random.default_rng(0).standard_normal((4800, 2)))
    (axes,) = plot.spectrum(two).axes
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["listener 0", "listener 1"]


def circle(count=36, duration=0.2):
    """Return a dipole along x at 1 kHz, heard on a circle about (1, 2, 3), with listeners in mixed order."""
    angle = np.random.default_rng(0).permutation(2.0 * np.pi * np.arange(count) / count)
    one = tone(1000.0, 80.0, duration)
    places = {"x": ("listener", 1.0 + np.cos(angle)), "y": ("listener", 2.0 + np.sin(angle))}
    return heard(np.outer(one, np.cos(angle))).assign_coords(places | {"z": ("listener", np.full(count, 3.0))})


def test_a_dipole_has_two_lobes():
    (axes,) = plot.directivity(circle(), centre=(1.0, 2.0, 3.0)).axes
    (line,) = axes.get_lines()
    angle, levels = line.get_data()
    assert angle.size == 37
    assert angle[0] == angle[-1]
    assert np.all(np.diff(angle[:-1]) > 0.0)
    expected = 80.0 + 20.0 * np.log10(np.maximum(np.abs(np.cos(angle)), 1e-6))
    np.testing.assert_allclose(levels, np.maximum(expected, axes.get_ylim()[0]), atol=0.01)
    assert "Leq [dB re 20 µPa]" in axes.get_xlabel()


def test_bands_are_lines_and_half_a_circle_stays_open():
    sound = circle()
    half = sound.isel(listener=np.flatnonzero(sound.x.values > 1.3))
    figure = plot.directivity(half, centre=(1.0, 2.0, 3.0), bands=[1000.0, 2000.0])
    lines = figure.axes[0].get_lines()
    assert [line.get_label() for line in lines] == ["1000 Hz", "2000 Hz"]
    assert lines[0].get_xdata().size == half.sizes["listener"]


def test_a_tone_stands_in_its_band():
    """1 Pa rms at 1 kHz is 94 dB; the second of two listeners hears half."""
    time = np.arange(24_000) / 48e3
    tone = np.sqrt(2.0) * np.sin(2.0 * np.pi * 1000.0 * time)
    (axes,) = plot.third_octaves(heard(np.stack([tone, 0.5 * tone], axis=1))).axes
    for stairs, level in zip(axes.patches, (93.98, 87.96), strict=True):
        values, edges, _ = stairs.get_data()
        band = int(np.flatnonzero((edges[:-1] < 1000.0) & (edges[1:] > 1000.0))[0])
        assert values[band] == pytest.approx(level, abs=0.05)
        assert values.argmax() == band
    words = [text.get_text() for text in axes.get_legend().get_texts()]
    assert ["LAeq 94.0 dB" in words[0], "LAeq 88.0 dB" in words[1]] == [True, True]
    # A short sound has no low bands, and a very short one no level; octaves are named.
    (short,) = plot.third_octaves(heard(tone[:1200])).axes
    assert short.patches[0].get_data()[1][0] > 150.0
    assert short.get_legend() is None
    assert [label.get_text() for label in short.get_xticklabels()] == ["250", "500", "1k", "2k", "4k", "8k", "16k"]
    with pytest.raises(ValueError, match="pressure must hold a sound, got silence"):
        plot.third_octaves(heard(0.0 * tone))


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: plot.spectrogram(heard(np.zeros((999, 2)))), "signal must be of one listener, got 2: choose one with"),
        (lambda: plot.spectrogram(tone(duration=0.01)), r"window must be from 0\.000167 to 0\.01 s, got 0\.02"),
        (lambda: plot.spectrogram(tone(), highest=0.0), "highest must be above 0"),
        (lambda: plot.spectrum(np.zeros(9)), "signal must be a DataArray"),
        (lambda: plot.spectrum(tone(), resolution=-1.0), "resolution must be above 0"),
        (lambda: plot.spectrum(tone(), "squeal"), "system must be a System"),
        (lambda: plot.directivity(heard(np.zeros((999, 3)))), "pressure must have the places of its listeners"),
        (lambda: plot.directivity(circle(), plane="yx"), "plane must be one of xy, xz, yz, got 'yx'"),
        (lambda: plot.directivity(circle(2, 0.1)), "pressure must have at least 3 listeners"),
        (lambda: plot.directivity(0.0 * circle()), "pressure must hold a sound, got silence"),
    ],
)
def test_bad_arguments_are_refused_in_one_line(call, message):
    with pytest.raises(ValueError, match=message):
        call()
