"""Pitches, slips and regimes of clockwork: any pitch and share of sticking, cut anywhere, in bursts and in noise."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from clockwork import Clockwork

import stridula as st
from stridula import analysis
from stridula.analysis.pitch import audible_spectrum
from stridula.analysis.recurrences import recurrence
from stridula.analysis.status_cycles import StatusCycles
from stridula.weighting import a_weighting

LOWEST, HIGHEST = 20.0, 8000.0
# Clear of the lowest tone, which divides stick-slip from squeal.
SLOW, FAST = 270.0, 330.0


def regime_of(pitch: float) -> set[str]:
    return {"stick-slip"} if pitch < SLOW else {"squeal"} if pitch > FAST else {"stick-slip", "squeal"}


def drawn(seed: int, *, burst: bool = False, noise: float = 0.0) -> Clockwork:
    random = np.random.default_rng(seed)
    pitch = float(np.exp(random.uniform(np.log(100.0 if burst else LOWEST), np.log(HIGHEST))))
    return Clockwork(
        pitch,
        float(random.uniform(0.02, 0.95)),
        phase=float(random.random()),
        rate=float(random.choice([48e3, 50e3, 100e3])),
        duration=float(random.uniform(0.4, 1.0)),
        noise=noise,
        burst=max(float(random.uniform(0.02, 0.06)), 8.0 / pitch) if burst else 0.0,
        stop=float(random.uniform(0.02, 0.1)) if burst else 0.0,
        swing=float(random.choice([0.0, 0.3])),
        seed=seed,
    )


@pytest.mark.parametrize("seed", range(40))
def test_clockwork_has_its_pitch_and_its_slips(seed):
    one = drawn(seed)
    found = analysis.regime_of(one.record())
    assert found["frequency"] == pytest.approx(one.pitch, rel=2e-3)
    assert found["regime"] in regime_of(one.pitch)
    # The record has one slip more or fewer.
    assert found["slip_rate"] == pytest.approx(one.pitch, rel=1e-3, abs=2.0 / (0.9 * one.duration))
    assert found["periodicity"] > 0.99


@pytest.mark.parametrize("seed", range(100, 140))
def test_clockwork_in_bursts_has_the_pitch_of_its_bursts(seed):
    one = drawn(seed, burst=True)
    found = analysis.regime_of(one.record())
    assert found["frequency"] == pytest.approx(one.pitch, rel=1e-2)
    assert found["regime"] in regime_of(one.pitch)


@pytest.mark.parametrize("noise", [0.1, 0.5])
@pytest.mark.parametrize("seed", range(200, 215))
def test_noise_of_the_forces_does_not_move_the_pitch(seed, noise):
    one = drawn(seed, noise=noise, burst=bool(seed % 2))
    found = analysis.regime_of(one.record())
    assert found["frequency"] == pytest.approx(one.pitch, rel=1e-2)


@pytest.mark.parametrize("pitch", [1072.0, 2144.0, 3574.0])
@pytest.mark.parametrize("phase", np.linspace(0.0, 0.95, 8))
def test_the_cut_of_a_record_does_not_move_the_pitch(pitch, phase):
    for stick in (0.05, 0.5, 0.9):
        found = analysis.regime_of(Clockwork(pitch, stick, phase, rate=20e3, duration=0.5).record())
        assert (found["regime"], found["frequency"]) == ("squeal", pytest.approx(pitch, rel=2e-3))


@pytest.mark.parametrize("seconds", [0.05, 0.1, 0.3])
def test_short_records_have_their_pitch(seconds):
    for pitch in (340.0, 1072.0, 5000.0):
        found = analysis.regime_of(Clockwork(pitch, 0.6, 0.3, duration=seconds).record())
        assert found["frequency"] == pytest.approx(pitch, rel=1e-2)


@pytest.mark.parametrize("rate", [12e3, 20e3, 200e3])
def test_the_pitch_does_not_depend_on_the_sample_rate(rate):
    found = analysis.regime_of(Clockwork(3574.0, 0.6, 0.3, rate=rate, duration=0.5).record())
    assert found["frequency"] == pytest.approx(3574.0, rel=2e-3)


# Runs.


def relay(pitch: float) -> st.System:
    """A block on a belt, so stiff that it sticks and slips at a pitch [Hz]."""
    factor = pitch / 0.27335
    block = st.PointMass(1.0)
    belt = st.RigidTrack(velocity=0.5 / factor)
    contact = st.PointContact(block.centre, belt, friction=st.StaticKinetic(0.4, 0.25))
    drives = [st.Force(block.centre, y=-10.0), st.InitialVelocity(block, x=0.5 / factor)]
    return st.System(contact, drives, [st.Spring(block.centre, stiffness=4.0 * factor**2, direction="x")])


@pytest.mark.parametrize("pitch", [1072.0, 2144.0, 3574.0])
def test_a_block_that_squeals_has_its_pitch_wherever_its_record_ends(pitch):
    run = st.simulate(relay(pitch), 0.3, step=1.0 / (200.0 * pitch), sample_rate=50e3, probes=[])
    for cut in range(1, 30, 4):
        found = analysis.regime_of(run.isel(time=slice(0, -cut)))
        # It sticks and slips within a step each.
        assert found["frequency"] == pytest.approx(pitch, rel=1e-2)
        assert found["slip_rate"] == pytest.approx(pitch, rel=2e-2)
        assert found["regime"] == "squeal"


# The parts.


def series(places: np.ndarray) -> np.ndarray:
    """Return events that last for a tenth of their mean distance and end at some places."""
    return np.stack([places - 0.1 * np.diff(places).mean(), places], axis=1)


def test_events_recur_after_the_shortest_pattern():
    assert recurrence(series(np.arange(30.0) * 7.3)) == (pytest.approx(7.3), 1.0)
    # Two slips in each period.
    assert recurrence(series(np.sort(np.append(np.arange(20) * 10.0, np.arange(20) * 10.0 + 3.0))))[0] == 10.0
    # Every tenth is missing.
    places = np.arange(100) * 5.0
    assert recurrence(series(places[np.arange(100) % 10 != 0]))[0] == pytest.approx(5.0)
    # To the nearest sample.
    assert recurrence(series(np.round(np.arange(200) * 3.4)))[0] == pytest.approx(3.4, rel=1e-2)


def test_random_events_do_not_recur():
    for seed in range(50):
        places = np.cumsum(np.random.default_rng(seed).exponential(20.0, 300))
        assert np.isnan(recurrence(series(places))[0])
    assert np.isnan(recurrence(np.empty((0, 2)))[0])
    assert np.isnan(recurrence(np.array([[0.0, 1.0], [2.0, 3.0]]))[0])


def test_bursts_of_fast_cycles_lie_between_their_stops():
    """Bursts of 40 ms and stops of 60 ms, the record begins and ends in a burst."""
    one = Clockwork(1000.0, 0.3, phase=0.2, duration=0.55, burst=0.04, stop=0.06)
    sticking = one.record()["status_share"].values[:, 1]
    found = StatusCycles(sticking, 0.0, one.rate / 300.0).bursts / one.rate
    starts = np.array([0.0, 0.08, 0.18, 0.28, 0.38, 0.48])
    np.testing.assert_allclose(found[:, 0], starts, atol=1e-3)
    np.testing.assert_allclose(found[:, 1], np.append(0.02, starts[1:] + 0.04), atol=1e-3)
    assert StatusCycles(np.ones(1000), 0.0, 100.0).bursts.tolist() == [[0, 1000]]
    assert StatusCycles(np.zeros(1000), 0.0, 100.0).bursts.tolist() == [[0, 1000]]


def tone(*frequencies: float, rate: float = 20e3, seconds: float = 0.5, mean: float = 5.0) -> np.ndarray:
    time = np.arange(round(rate * seconds)) / rate
    return mean + sum(np.sin(2.0 * np.pi * frequency * time + frequency) for frequency in frequencies)[None]


@pytest.mark.parametrize("frequency", [310.0, 451.3, 999.0, 2950.0, 8123.0])
def test_a_tone_is_found_within_a_hertz(frequency):
    whole = np.array([[0, 10_000]])
    found = audible_spectrum(tone(frequency), 5e-5, whole, 0.03, 300.0)
    assert found.pitch == pytest.approx(frequency, abs=1.0)
    # Half of the peak of 310 Hz lies below 300 Hz.
    assert found.level == pytest.approx(np.sqrt(0.5), rel=0.2 if frequency < 400.0 else 1e-2)
    np.testing.assert_allclose(found.tones(3), [frequency], atol=1.0)
    # In bursts of other means.
    bursts = np.array([[100, 700], [900, 1500], [5000, 5600]])
    steps = np.repeat([0.0, 30.0, -7.0, 100.0], 2500)
    assert audible_spectrum(tone(frequency) + steps, 5e-5, bursts, 0.03, 300.0).pitch == pytest.approx(
        frequency, abs=2.0
    )


def test_a_constant_force_has_no_pitch():
    whole = np.array([[0, 10_000]])
    assert np.isnan(audible_spectrum(np.zeros((2, 10_000)), 5e-5, whole, 0.03, 300.0).pitch)
    assert np.isnan(audible_spectrum(np.full((2, 4), 7.0), 5e-5, np.array([[0, 4]]), 0.03, 300.0).pitch)


def test_the_pitch_is_the_tone_with_which_its_partials_repeat():
    whole = np.array([[0, 10_000]])
    partials = sum(tone(900.0 * number, mean=0.0) for number in (1, 2, 3))
    assert audible_spectrum(partials, 5e-5, whole, 0.03, 300.0).pitch == pytest.approx(900.0, abs=1.0)
    # Of two tones apart the ear prefers that of kilohertz.
    apart = audible_spectrum(tone(330.0) + tone(1030.0, mean=0.0), 5e-5, whole, 0.03, 300.0)
    assert apart.pitch == pytest.approx(1030.0, abs=1.0)
    assert sorted(apart.tones(2)) == pytest.approx([330.0, 1030.0], abs=1.0)


@pytest.mark.parametrize("seed", range(12))
def test_cycles_have_the_pitch_if_odd_partials_have_a_tenth_of_the_audible_power(seed):
    """The second partial is the strongest; phases are random, and powers are those under the weighting."""
    random = np.random.default_rng(seed)
    first, odd = random.uniform(320.0, 900.0), 0.05 if seed % 2 else 0.2
    time, numbers = np.arange(24_000) / 48e3, np.arange(1, 7)
    shares = random.uniform(0.05, 0.3, numbers.size)
    shares[1] = 1.0
    is_odd = numbers % 2 == 1
    shares[is_odd] *= odd / (1.0 - odd) * shares[~is_odd].sum() / shares[is_odd].sum()
    sizes = np.sqrt(shares) / np.abs(a_weighting(first * numbers))
    force = np.sum(
        [
            size * np.cos(2.0 * np.pi * (first * n * time + random.random()))
            for size, n in zip(sizes, numbers, strict=True)
        ],
        axis=0,
    )
    found = audible_spectrum(force[None], 1.0 / 48e3, np.array([[0, force.size]]), 0.03, 300.0)
    assert found.pitch == pytest.approx(2.0 * first, rel=2e-3)
    assert found.pitch_among(first) == pytest.approx(first if odd > 0.1 else 2.0 * first, rel=2e-3)


def test_a_record_in_single_precision_has_its_pitch():
    run = Clockwork(1072.0, 0.5, 0.3).record()
    small = xr.Dataset({name: values.astype("f4") for name, values in run.items()}, run.coords, run.attrs)
    assert analysis.regime_of(small)["frequency"] == pytest.approx(1072.0, rel=2e-3)
