"""Regime and bursts from a vibration alone: known signals, and the accelerations of shipped cases."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula import analysis

RATE = 20e3
TIME = np.arange(int(2 * RATE)) / RATE


def vibration(values, units="m/s2", rate=RATE):
    return xr.DataArray(values, {"time": np.arange(len(values)) / rate}, ("time",), attrs={"units": units})


def noise(seed=0):
    return np.random.default_rng(seed).standard_normal(TIME.size)


def pulses(rate, length=2e-3, seed=None):
    """Return decaying clicks at a rate [1/s], at random times with a seed."""
    count = int(2 * rate)
    at = np.arange(count) / rate if seed is None else np.sort(np.random.default_rng(seed).uniform(0, 2, count))
    values = np.zeros(TIME.size)
    dice = np.random.default_rng(5)
    click = np.exp(-np.arange(400) / (length * RATE))
    shape = click * dice.standard_normal(400)
    for begin in (at * RATE).astype(int):
        end = min(begin + 400, TIME.size)
        values[begin:end] += shape[: end - begin]
    return values


@pytest.mark.parametrize("frequency", [350.0, 1234.5, 4000.0])
def test_a_tone_in_noise_is_squeal_from_half_of_the_power_on(frequency):
    tone = np.sin(2.0 * np.pi * frequency * TIME)
    for share in (0.95, 0.7):
        white = noise() * np.sqrt(0.5 * (1.0 / share - 1.0) * 2.0)
        found = analysis.vibration_regime(vibration(tone + 0.5 * white))
        assert found.regime == "squeal"
        assert float(found.frequency) == pytest.approx(frequency, rel=2e-3)
    assert analysis.vibration_regime(vibration(0.1 * tone + noise())).regime == "judder"


@pytest.mark.parametrize("rate", [20.0, 75.0, 150.0])
def test_pulses_that_recur_slowly_are_stick_slip(rate):
    found = analysis.vibration_regime(vibration(pulses(rate) + 0.01 * noise()))
    assert found.regime == "stick-slip"
    assert float(found.frequency) == pytest.approx(rate, rel=0.02)
    assert float(found.confidence) <= 0.75
    assert "separates" in found.attrs["unknown"]


def test_a_harmonic_of_slow_cycles_is_no_certain_squeal():
    """The seventh one of 98 Hz, in an acceleration of stick-slip; a tone in noise is certain, as is one of a siren."""
    slow = sum(
        np.sin(2.0 * np.pi * 98.0 * k * TIME + k) * (1.0, 0.3, 0.5, 0.4, 0.5, 0.9, 1.5)[k - 1] for k in range(1, 8)
    )
    found = analysis.vibration_regime(vibration(slow + 0.02 * noise()))
    assert found.regime == "squeal"
    assert float(found.confidence) == 0.75
    assert "a harmonic of cycles at 98.0" in found.attrs["unknown"]
    tone = np.sin(2.0 * np.pi * 685.0 * TIME)
    for values in (tone + 0.02 * noise(), tone + 0.4 * noise(), tone * (1.0 + 0.3 * np.sin(2.0 * np.pi * 10.0 * TIME))):
        found = analysis.vibration_regime(vibration(values))
        assert float(found.confidence) > 0.9
        assert "harmonic" not in found.attrs["unknown"]


def test_pulses_at_random_are_judder():
    found = analysis.vibration_regime(vibration(pulses(60.0, seed=4) + 0.01 * noise()))
    assert found.regime == "judder"
    assert float(found.confidence) <= 0.75


def test_noise_may_be_that_of_the_sensor():
    """Judder has a confidence above one half only if the noise of the sensor is known to be weaker."""
    alone = analysis.vibration_regime(vibration(noise()))
    assert (alone.regime, float(alone.confidence)) == ("judder", 0.5)
    assert "noise of steady sliding or of the sensor" in alone.attrs["unknown"]
    above = analysis.vibration_regime(vibration(noise()), floor=0.01)
    assert (above.regime, float(above.confidence)) == ("judder", 0.75)
    assert analysis.vibration_regime(vibration(noise()), floor=1.0).regime == "quiet"


@pytest.mark.parametrize("frequency", [12.0, 50.0, 130.0])
def test_slow_cycles_have_their_own_frequency(frequency):
    """A slow sine has its frequency, not that of its envelope, twice as high."""
    found = analysis.vibration_regime(vibration(np.sin(2.0 * np.pi * frequency * TIME) + 1e-3 * noise()))
    assert found.regime == "stick-slip"
    assert float(found.frequency) == pytest.approx(frequency, rel=1e-2)


def test_a_vibration_that_dies_away_or_is_as_faint_as_the_floor_is_quiet():
    ringing = np.exp(-TIME / 0.1) * np.sin(2.0 * np.pi * 900.0 * TIME)
    assert analysis.vibration_regime(vibration(ringing)).regime == "quiet"
    tone = vibration(np.sin(2.0 * np.pi * 900.0 * TIME))
    assert analysis.vibration_regime(tone, floor=0.1).regime == "squeal"
    assert analysis.vibration_regime(tone, floor=0.6).regime == "quiet"
    assert analysis.vibration_regime(vibration(np.zeros(TIME.size))).regime == "quiet"


@pytest.mark.parametrize("seed", range(20))
def test_slow_vibration_that_dies_away_is_quiet_and_stick_slip_that_stops_is_not(seed):
    dice = np.random.default_rng(seed)
    frequency, decay = 10.0 ** dice.uniform(1.2, 2.2), TIME[-1] / dice.uniform(3.0, 12.0)
    swing = np.sin(2.0 * np.pi * frequency * TIME + dice.uniform(0.0, 6.0))
    assert analysis.vibration_regime(vibration(np.exp(-TIME / decay) * swing + 1e-3 * noise(seed))).regime == "quiet"
    stopped = np.where(dice.uniform(0.4, 0.8) * TIME[-1] > TIME, swing, 0.0)
    assert analysis.vibration_regime(vibration(stopped + 1e-3 * noise(seed))).regime == "stick-slip"


@pytest.mark.parametrize("seed", range(20))
def test_bodies_that_ring_after_a_stroke_are_quiet(seed):
    """Random modes, some in pairs that beat, with random damping, in noise, after what is ignored."""
    dice, ringing = np.random.default_rng(seed), 1e-3 * noise(seed)
    for frequency in 10.0 ** dice.uniform(2.6, 3.8, 3):
        decay = np.where(TIME > 0.2, np.exp((0.2 - TIME) / 10.0 ** dice.uniform(-2.3, -0.6)), 0.0)
        beat = dice.uniform(5.0, 30.0) * (dice.random() < 0.3)
        for one in (frequency, frequency + beat):
            ringing += dice.uniform(0.3, 1.0) * decay * np.sin(2.0 * np.pi * one * TIME)
    assert analysis.vibration_regime(vibration(ringing)).regime == "quiet"


@pytest.mark.parametrize(("begin", "end"), [(0.5, 0.9), (0.0, 0.5), (0.1, 0.35), (0.25, 0.45), (0.2, 0.3)])
@pytest.mark.parametrize("strength", [1e-3, 0.05])
def test_a_squeal_that_ends_within_the_signal_is_squeal(begin, end, strength):
    """Also at the beginning, of which a tenth is ignored."""
    rise = np.clip((TIME - begin) / 0.02, 0.0, 1.0) * np.exp(-np.maximum(TIME - end, 0.0) / 5e-3)
    tone = np.sin(2.0 * np.pi * 900.0 * TIME) * rise
    assert analysis.vibration_regime(vibration(tone + strength * noise())).regime == "squeal"


@cache
def case(name):
    return st.load_scenario(name).simulate()


def shaken(name):
    """Return the first probe of a case."""
    run = case(name)
    probed = run["acceleration"] if "acceleration" in run else run["displacement"]
    return probed.isel({probed.dims[1]: 0})


QUIET = {"stable sliding": "quiet", "sticking": "quiet", "off the track": "quiet"}


@pytest.mark.parametrize(
    "name", ["stable-sliding", "axial-sliding", "squeal", "weak-pressure", "judder", "judder-on-plate", "belt", "lugre"]
)
def test_the_regime_of_a_case_follows_from_its_vibration(name):
    known = str(st.regime(case(name)).regime.values)
    found = analysis.vibration_regime(shaken(name))
    assert str(found.regime.values) == QUIET.get(known, known)
    assert 0.5 <= float(found.confidence) <= (0.75 if known in ("stick-slip", "judder") else 1.0)


def test_the_regime_does_not_depend_on_the_units_or_the_rate_of_the_sensor():
    whole = shaken("squeal")
    rough = (whole[: whole.size // 4 * 4].coarsen(time=4).mean() * 1e3).assign_attrs(units="mm/s2")
    assert analysis.vibration_regime(rough).regime == "squeal"
    np.testing.assert_allclose(
        analysis.vibration_regime(rough).tonality, analysis.vibration_regime(whole).tonality, atol=0.05
    )


def test_bursts_of_a_tone_are_found_at_their_ends():
    ends = np.array([[0.2, 0.25], [0.4, 0.5], [0.9, 0.93], [1.5, 1.9]])
    values = 1e-3 * noise() + 5.0 * np.sin(2.0 * np.pi * 30.0 * TIME)
    for begin, end in ends:
        inside = slice(round(begin * RATE), round(end * RATE))
        values[inside] += np.sin(2.0 * np.pi * 2000.0 * TIME[inside])
    found = analysis.vibration_bursts(vibration(values))
    np.testing.assert_allclose(found, ends, atol=2.5e-3)
    # Shorter pauses than the shortest stop do not end a burst, and the ends of the signal cut one.
    values[(TIME >= 0.44) & (TIME < 0.455)] *= 1e-3
    np.testing.assert_allclose(analysis.vibration_bursts(vibration(values)), ends, atol=2.5e-3)
    cut = vibration(values[int(0.22 * RATE) : int(1.7 * RATE)])
    np.testing.assert_allclose(analysis.vibration_bursts(cut), ends[1:3] - 0.22, atol=2.5e-3)


def test_bursts_of_a_case_follow_from_its_vibration():
    known = analysis.bursts(case("strong-pressure"))
    found = analysis.vibration_bursts(shaken("strong-pressure"))
    assert len(found) == len(known)
    near = np.abs(found[:, 0] - known[:, 0]) < 10e-3
    assert np.count_nonzero(near) >= 0.8 * len(known)


@pytest.mark.parametrize("name", ["judder", "weak-pressure"])
def test_a_case_without_stops_has_no_bursts(name):
    assert len(analysis.bursts(case(name))) == 0
    assert len(analysis.vibration_bursts(shaken(name))) == 0


def shaking(rate=RATE, count=TIME.size):
    return vibration(noise()[:count], rate=rate)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: analysis.vibration_regime(shaking(count=100)),
            r"^signal must last at least 0\.06 s and be finite, got",
        ),
        (lambda: analysis.vibration_regime(shaking(500.0)), r"^signal must be sampled at 600 Hz or more, got 500 Hz$"),
        (lambda: analysis.vibration_regime(shaking(), floor=-1.0), r"^floor must be above 0, got -1\.0$"),
        (lambda: analysis.vibration_regime(shaking() + np.nan), r"be finite, got values that are not finite$"),
        (lambda: analysis.vibration_bursts(shaking(500.0)), r"^signal must be sampled at 600 Hz or more"),
        (lambda: analysis.vibration_bursts(shaking(), smoothing=9.0), r"^smoothing must be at most (1|0\.9+) s, got 9"),
        (lambda: analysis.vibration_bursts(shaking() + np.nan), r"^signal must be finite, got values that are not$"),
        (
            lambda: st.regime(shaking()),
            r"^run must be a record, a Dataset \(analysis.vibration_regime takes a signal\), got a DataArray$",
        ),
    ],
)
def test_other_signals_are_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()
