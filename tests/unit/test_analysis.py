"""Measures on synthetic records whose answers are known by construction."""

import numpy as np
import pytest
import scipy.ndimage
import scipy.signal
import xarray as xr

from stridula import analysis
from stridula.analysis.phases import moving_mean
from stridula.analysis.spectra import _peaks

RATE = 100e3
WORDS = ("separated", "sticking", "sliding")


def record(pieces, force=None, position=None):
    """Return a record whose status follows (status, seconds) pieces, with a force and a position over time."""
    status = np.concatenate([np.full(round(seconds * RATE), WORDS.index(word)) for word, seconds in pieces])
    time = np.arange(1, status.size + 1) / RATE
    values = np.zeros(status.size) if force is None else force(time)
    place = time if position is None else position(time)
    return xr.Dataset(
        {
            "status_share": (("time", "contact_status"), np.eye(3)[status]),
            "normal_force": ("time", values),
            "contact_position": ("time", place),
        },
        {"time": time, "contact_status": list(WORDS)},
    )


def squealing(count=8, stop=0.07, burst=0.03):
    """Stops with chatter of 1 ms inside, and bursts that slide, separate and stick in turn at 900 Hz."""
    cycle = [("sliding", 0.0005), ("separated", 0.0004), ("sticking", 0.0002)]
    one_burst = cycle * round(burst / 0.0011)
    one_stop = [("sticking", stop / 2), ("sliding", 0.001), ("sticking", stop / 2 - 0.001)]
    return record((one_burst + one_stop) * count + one_burst)


def test_stops_bridge_chatter_and_keep_their_length():
    run = squealing()
    found = analysis.stops(run)
    assert len(found) == 8
    # Bursts of 27 cycles of 1.1 ms; the edges of a smoothed share stay within half a cycle of the truth.
    np.testing.assert_allclose(np.diff(found, axis=1), 0.07, atol=0.0012)


def test_bursts_lie_between_stops():
    run = squealing()
    found = analysis.bursts(run)
    assert len(found) == 7
    np.testing.assert_allclose(np.diff(found, axis=1), 27 * 0.0011, atol=0.0012)
    np.testing.assert_allclose(np.diff(found[:, 0]), 0.07 + 27 * 0.0011, atol=1e-4)


def test_a_burst_that_sticks_for_part_of_each_cycle_is_no_stop():
    run = record([("sliding", 0.0007), ("sticking", 0.0004)] * 200)
    assert len(analysis.stops(run)) == 0


def test_short_sticks_are_no_stops_and_no_stops_give_no_bursts():
    run = record([("sliding", 0.05), ("sticking", 0.015), ("sliding", 0.05)])
    assert len(analysis.stops(run)) == 0
    assert analysis.bursts(run).shape == (0, 2)
    assert len(analysis.stops(run, shortest=0.01)) == 1


@pytest.mark.parametrize("width", [1, 3, 51, 1001])
def test_moving_mean_is_that_of_scipy(width):
    """To round-off; importing scipy.ndimage takes longer than all measures of a run."""
    share = np.random.default_rng(1).integers(0, 4, 600) / 3
    expected = scipy.ndimage.uniform_filter1d(share, width, mode="reflect")
    np.testing.assert_allclose(moving_mean(share, width), expected, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("size", [1, 2, 7])
def test_moving_mean_wider_than_the_record_is_its_mean(size):
    share = np.arange(float(size))
    np.testing.assert_array_equal(moving_mean(share, 1001), np.full(size, share.mean()))


@pytest.mark.parametrize("cut", range(1, 50, 4))
def test_a_record_that_ends_in_a_fast_cycle_has_no_phase_at_its_end(cut):
    """It sticks for 0.9 of each millisecond, or for 0.1; the record ends in a stick or in a slip."""
    size = 20_000 + 2 * cut
    for share, words, other in ((0.9, "sticking", "sliding"), (0.1, "sliding", "sticking")):
        slides = np.arange(size) % 100 >= 100 * share
        run = record([("sticking", size / RATE)])
        run["status_share"] = (("time", "contact_status"), np.eye(3)[np.where(slides, 2, 1)])
        np.testing.assert_allclose(analysis.phases(run, words), [[0.0, size / RATE]], atol=2e-5)
        assert len(analysis.phases(run, other)) == 0


def test_complete_drops_what_the_record_cuts():
    run = record([("sticking", 0.05), ("sliding", 0.03), ("sticking", 0.04), ("sliding", 0.03), ("sticking", 0.05)])
    found = analysis.complete(analysis.stops(run), run)
    np.testing.assert_allclose(found, [[0.08, 0.12]], atol=2e-5)


def test_settling_time_is_the_end_of_the_last_state_that_is_not_sliding():
    run = record([("separated", 0.1), ("sliding", 0.2), ("sticking", 0.01), ("sliding", 0.5)])
    assert analysis.settling_time(run) == pytest.approx(0.31, abs=1e-9)
    assert np.isnan(analysis.settling_time(record([("sliding", 0.2), ("separated", 0.01)])))
    assert analysis.settling_time(record([("sliding", 0.2)])) == pytest.approx(0.0, abs=1e-12)


def test_one_step_that_does_not_slide_is_enough_to_unsettle():
    run = record([("sliding", 0.4)])
    run["status_share"][20_000] = [0.1, 0.0, 0.9]
    assert analysis.settling_time(run) == pytest.approx(0.20001, abs=1e-9)


def test_longest_unchanged():
    run = record([("separated", 0.01), ("sliding", 0.03), ("sticking", 0.02)])
    assert analysis.longest_unchanged(run) == pytest.approx(0.03, abs=1e-9)
    run["status_share"][2500] = [0.5, 0.5, 0.0]
    assert analysis.longest_unchanged(run) == pytest.approx(0.02, abs=1e-9)


def test_status_share_in_intervals():
    run = record([("separated", 0.1), ("sliding", 0.3)])
    assert analysis.status_share(run, "separated") == pytest.approx(0.25)
    assert analysis.status_share(run, "separated", np.array([[0.05, 0.15]])) == pytest.approx(0.5, abs=1e-3)
    assert np.isnan(analysis.status_share(run, "sliding", np.empty((0, 2))))


def test_advance_in_intervals_is_net():
    run = record([("sliding", 1.0)], position=lambda t: 0.3 + 0.01 * t)
    assert analysis.advance(run) == pytest.approx(0.01, rel=1e-4)
    assert analysis.advance(run, np.array([[0.2, 0.4], [0.7, 0.8]])) == pytest.approx(0.003, rel=1e-6)


@pytest.mark.parametrize("tone", [450.0, 900.0, 2512.3])
def test_dominant_frequency_of_bursts(tone):
    """Tone bursts of 30 ms on a slow swell twice as strong: the tone is found to 1 % of the 33 Hz resolution."""
    intervals = np.array([[0.1 * k, 0.1 * k + 0.03] for k in range(1, 8)])

    def force(time):
        inside = np.any([(time > a) & (time < b) for a, b in intervals], axis=0)
        return 5.0 + inside * (np.sin(2 * np.pi * tone * time) + 2.0 * np.sin(2 * np.pi * 40.0 * time))

    run = record([("sliding", 1.0)], force)
    assert analysis.dominant_frequency(run.normal_force, intervals) == pytest.approx(tone, abs=0.01 * 33.3 + 1.0)


def test_dominant_frequency_of_separated_pulses_is_their_rate():
    """Half-sine pulses, 0.3 ms long at 900 Hz: broad harmonics, the fundamental leads."""
    run = record([("sliding", 0.5)], lambda t: np.maximum(0.0, np.sin(2 * np.pi * 900.0 * t) - 0.5))
    assert analysis.dominant_frequency(run.normal_force) == pytest.approx(900.0, abs=1.0)


def test_dominant_frequency_of_nothing_is_nan():
    run = record([("sliding", 0.5)], lambda t: 0.0 * t)
    assert np.isnan(analysis.dominant_frequency(run.normal_force))
    assert np.isnan(analysis.dominant_frequency(run.normal_force, np.empty((0, 2))))


def test_dominant_frequency_ignores_fewer_than_ten_periods():
    run = record([("sliding", 0.1)], lambda t: 3.0 * np.sin(2 * np.pi * 60.0 * t) + np.sin(2 * np.pi * 700.0 * t))
    assert analysis.dominant_frequency(run.normal_force) == pytest.approx(700.0, abs=3.0)
    assert analysis.dominant_frequency(run.normal_force, lowest=30.0) == pytest.approx(60.0, abs=3.0)


@pytest.mark.parametrize("levels", [1, 2, 3, 10, 10**6])
def test_peaks_are_those_of_scipy(levels):
    """With few levels most peaks are flat, also at the ends."""
    random = np.random.default_rng(2)
    for size in (1, 2, 3, 8, 200):
        values = random.integers(0, levels, size).astype(float)
        np.testing.assert_array_equal(_peaks(values), scipy.signal.find_peaks(values)[0])


def test_spectrum_is_under_a_periodic_hann_window():
    run = record([("sliding", 0.5)], lambda time: np.random.default_rng(3).normal(size=time.size))
    force = run.normal_force.values
    window = scipy.signal.windows.hann(force.size, sym=False)
    expected = np.abs(np.fft.rfft((force - np.average(force, weights=window)) * window, 2**16)) ** 2 / RATE**2
    np.testing.assert_allclose(analysis.spectrum(run.normal_force)[1], expected, rtol=1e-9, atol=1e-12 * expected.max())


def test_spectrum_holds_the_energy_of_a_tone():
    """Parseval: the one-sided sum of |X|² df twice over is the energy under the Hann window, 3/8 of A²T/2."""
    run = record([("sliding", 1.0)], lambda t: 2.0 * np.sin(2 * np.pi * 1000.0 * t))
    frequency, energy = analysis.spectrum(run.normal_force)
    assert 2.0 * np.sum(energy) * frequency[1] == pytest.approx(3.0 / 8.0 * 2.0**2 / 2.0 * 1.0, rel=1e-3)


def test_frequency_resolution_is_one_over_the_median_interval():
    run = record([("sliding", 1.0)])
    intervals = np.array([[0.1, 0.12], [0.2, 0.225], [0.3, 0.4]])
    assert analysis.frequency_resolution(run.normal_force, intervals) == pytest.approx(40.0)


def test_envelope_correlation_sees_common_bursts_and_not_others():
    rng = np.random.default_rng(1)
    swell = lambda t, phase: 1.0 + np.sin(2 * np.pi * 5.0 * t + phase)  # noqa: E731
    noise = rng.normal(size=(2, 100_000))
    first = record([("sliding", 1.0)], lambda t: swell(t, 0.0) * noise[0]).normal_force
    same = record([("sliding", 1.0)], lambda t: 7.0 * swell(t, 0.0) * noise[1]).normal_force
    other = record([("sliding", 1.0)], lambda t: swell(t, np.pi) * noise[1]).normal_force
    assert analysis.envelope_correlation(first, same) > 0.95
    assert analysis.envelope_correlation(first, other) < 0.0


def test_peak_level_is_a_percentile_of_window_maxima():
    def force(time):
        peaks = np.zeros_like(time)
        peaks[50::100] = np.arange(1, 1 + peaks[50::100].size)
        return peaks

    run = record([("sliding", 1.0)], force)
    assert analysis.peak_level(run.normal_force) == pytest.approx(np.percentile(np.arange(1, 1001), 99.9))
    assert analysis.peak_level(run.normal_force, percentile=50.0) == pytest.approx(500.5)


def test_largest_jump_averages_down_first():
    def force(time):
        step = np.where(time > 0.050005, 3.0, 1.0)
        step[2001] += 5.0
        return step

    # The step of 2 stands between two blocks of 0.1 ms; the spike of 5 in one sample of ten counts 0.5.
    assert analysis.largest_jump(record([("sliding", 0.1)], force).normal_force) == pytest.approx(2.0, rel=1e-9)
    ramp = record([("sliding", 0.1)], lambda t: 100.0 * t).normal_force
    assert analysis.largest_jump(ramp) == pytest.approx(0.01, rel=1e-6)


def test_swing_is_peak_to_peak_over_mean():
    run = record([("sliding", 1.0)], lambda t: 2.0 + np.sin(2 * np.pi * 100.0 * t))
    assert analysis.swing(run.normal_force, np.array([[0.1, 0.3]])) == pytest.approx(1.0, rel=1e-3)
    assert np.isnan(analysis.swing(run.normal_force, np.empty((0, 2))))


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda run: analysis.phases(run, "slipping"), "status must be one of"),
        (lambda run: analysis.stops(run, shortest=-1.0), "shortest must be above 0"),
        (lambda run: analysis.peak_level(run.normal_force, percentile=120.0), "percentile must be from 0 to 100"),
        (lambda run: analysis.envelope(run.normal_force, window=9.0), "window must be at most"),
        (lambda run: analysis.spectrum(run.status_share), "signal must have the one dimension time"),
        (lambda run: analysis.settling_time(run.isel(time=slice(1))), "at least 2 samples"),
    ],
)
def test_bad_arguments(call, words):
    with pytest.raises(ValueError, match=words):
        call(record([("sliding", 0.1)]))


def test_tones_are_found_the_strongest_first():
    amplitudes = {900.0: 1.0, 2500.0: 2.0, 6000.0: 0.1}

    def force(time):
        noise = 1e-3 * np.random.default_rng(0).standard_normal(time.size)
        return 5.0 + noise + sum(a * np.sin(2 * np.pi * f * time) for f, a in amplitudes.items())

    frequency, level = analysis.tones(record([("sliding", 1.0)], force).normal_force, prominence=20.0)
    np.testing.assert_allclose(frequency, [2500.0, 900.0, 6000.0], atol=0.02)
    np.testing.assert_allclose(level, 20.0 * np.log10([1.0, 0.5, 0.05]), atol=0.1)


@pytest.mark.parametrize("seed", range(10))
def test_frequencies_of_tones_are_those_of_their_lines(seed):
    """To a fifth of the line width of a record of 0.7 s in noise; that of their bands of 20 Hz was 5 Hz away."""
    dice = np.random.default_rng(seed)
    lines = np.sort(dice.uniform(100.0, 8000.0, 4))
    lines = lines[np.diff(lines, prepend=-100.0) > 100.0]

    def force(time):
        shaken = sum(np.sin(2.0 * np.pi * f * time + dice.uniform(0.0, 6.0)) for f in lines)
        return shaken + 0.3 * dice.standard_normal(time.size)

    found = np.sort(analysis.tones(record([("sliding", 0.7)], force).normal_force, prominence=20.0)[0])
    np.testing.assert_allclose(found, lines, atol=0.2 / 0.7)


def test_tones_in_bursts_are_those_of_the_bursts():
    intervals = np.array([[0.1 * k, 0.1 * k + 0.05] for k in range(1, 8)])

    def force(time):
        inside = np.any([(time > a) & (time < b) for a, b in intervals], axis=0)
        return np.where(inside, np.sin(2 * np.pi * 900.0 * time), 5.0 * np.sin(2 * np.pi * 3000.0 * time))

    signal = record([("sliding", 1.0)], force).normal_force
    assert analysis.tones(signal, intervals)[0][0] == pytest.approx(900.0, abs=1.0)
    assert analysis.tones(signal)[0][0] == pytest.approx(3000.0, abs=1.0)


def test_a_tone_beside_a_stronger_one_must_stand_out():
    """One is 30 Hz and another 300 Hz away: bands of 20 Hz separate both, those of 100 Hz the second only."""
    lines = ((1000.0, 1.0), (1030.0, 0.5), (1300.0, 0.5))
    signal = record([("sliding", 1.0)], lambda t: sum(a * np.sin(2 * np.pi * f * t) for f, a in lines)).normal_force
    near = [np.count_nonzero(analysis.tones(signal, resolution=width)[0] < 1350.0) for width in (20.0, 100.0)]
    assert near == [3, 2]


def test_silence_has_no_tones_and_bad_numbers_are_refused():
    signal = record([("sliding", 0.5)], lambda t: 0.0 * t).normal_force
    for found in (*analysis.tones(signal), *analysis.tones(signal, np.empty((0, 2)))):
        assert found.size == 0
    for name in ("resolution", "prominence"):
        with pytest.raises(ValueError, match=f"{name} must be above 0"):
            analysis.tones(signal, **{name: 0.0})
