"""A wine glass that sings: its modes, onset, growth, limit cycle, and waves carried round."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.signal import butter, hilbert, sosfiltfilt

import stridula as st
from stridula import analysis

RIM, HEIGHT = 0.0325, 0.17
PERIODS = 0.4


def glass(**changes: Any) -> st.System:
    return st.load_scenario("glass", changes).system


def fundamental(body: st.AxisymmetricBody, order: int = 2) -> tuple[float, np.ndarray]:
    """Frequency of the first pair of an order, and displacements of the rim at the angle 0, shape (3, 2)."""
    pair = [int(np.flatnonzero((body.numbers == (order, 0, side)).all(axis=1))[0]) for side in (0, 1)]
    return float(body.modes().frequency[pair[0]]), body.trace((RIM, 0.0, HEIGHT))[:, pair]


def growing(system: st.System) -> tuple[float, float]:
    """Frequency and growth of the mode that vibrates and grows fastest."""
    theory = st.sliding_stability(system)
    rates = np.where(theory.frequency.values > 1.0, theory.growth_rate.values, -np.inf)
    return float(theory.frequency[rates.argmax()]), float(rates.max())


def test_its_modes_bend_the_rim_without_stretching_it():
    """Rayleigh: ``u_r + du_theta / dtheta = 0``, so its tangential motion is 1 / n of the radial one."""
    body = glass().track
    for order in (2, 3, 4):
        frequency, rows = fundamental(body, order)
        assert abs(rows[1, 1] / rows[0, 0]) == pytest.approx(1.0 / order, rel=0.02)
        if order == 2:
            # French (1983) and Rossing (1990) have wine glasses from 400 to 900 Hz.
            assert 400.0 < frequency < 900.0


@pytest.mark.parametrize("load", [0.2, 0.5, 1.0])
def test_growth_is_what_friction_feeds_less_damping(load):
    """One mode with the shape s along the rim, and skin of the impedance ``Z = c + i (w m - k / w)`` in series.

    Friction that falls by ``a = -N mu'`` for a unit of the speed pushes the rim by ``a Z / (Z - a)`` times its
    velocity: the mode grows by half of the real part times s², less its damping.
    """
    system = glass(**{"drives.0.z": -load})
    frequency, rows = fundamental(system.track)
    w, shape = 2.0 * np.pi * frequency, rows[1, 1]
    law, speed = system.contact.friction, RIM * system.track.turning
    fall = load * (law.static - law.kinetic) / law.velocity * np.exp(-speed / law.velocity)
    skin = 1.5 + 1j * (w * 1e-4 - 1e3 / w)
    fed = 0.5 * shape**2 * (fall * skin / (skin - fall)).real
    _, growth = growing(system)
    # Turning mixes in a little of the other mode of the pair, which friction damps; other modes yield.
    assert growth == pytest.approx(fed - 5e-4 * w, rel=0.06, abs=0.5)


def test_it_sings_from_where_the_feed_beats_damping():
    onset = -float(st.critical_value("glass", "drives.0.z", -1.0, -0.05).value)
    assert 0.05 < onset < 0.2
    for load, grows in ((0.5 * onset, False), (2.0 * onset, True)):
        system = glass(**{"drives.0.z": -load})
        frequency, growth = growing(system)
        assert (growth > 0.0) == grows
        run = st.simulate(system, 2.0, sample_rate=2e4, probes=[st.Velocity(system.track.at((RIM, 0.0, HEIGHT)), "x")])
        size = np.abs(run.velocity.values[:, 0])
        early, late = (size[part].max() for part in (slice(8000, 12000), slice(-4000, None)))
        assert np.log(late / early) / 1.4 == pytest.approx(growth, rel=0.02, abs=0.01)
        assert frequency == pytest.approx(fundamental(system.track)[0], rel=1e-3)
    # Friction that does not fall adds no energy.
    steady = st.sliding_stability(glass(**{"friction.law": "coulomb", "friction.coefficient": 0.6}))
    assert not steady.unstable.any()


def test_a_survey_of_turning_has_growth_in_time_and_modes_that_live():
    """The energy from friction falls with the speed; the growth of each run is that of its eigenvalue."""
    found = st.squeal_survey("glass", {"turning": [3.0, 5.0, 8.0]}).isel(mode=0)
    assert (np.diff(found.growth_rate) < 0.0).all()
    np.testing.assert_allclose(found.seen_growth_rate, found.growth_rate, rtol=0.02)
    np.testing.assert_allclose(found.seen_frequency, found.frequency, rtol=1e-3)
    assert set(found.fate.values) == {"lives"}
    # Negative control: the eigenvalue of the next speed is another one.
    assert (np.abs(found.seen_growth_rate.values[:-1] / found.growth_rate.values[1:] - 1.0) > 0.2).all()


def test_a_survey_measures_slow_growth_by_the_slip_along_the_rim():
    """If the normal force hardly varies, tones are those of the slip, in space along one of its two tangents."""
    found = st.squeal_survey("glass", {"turning": [2.1], "drives.0.z": [-0.1]})
    assert found.message.values.tolist() == [[""]]
    assert found.verdict.values.tolist() == [["unstable"]]
    assert set(found.fate.values.ravel()) == {"not reached"}


def test_the_shipped_case_sticks_slips_and_sings_just_below_its_mode():
    case = st.load_scenario("glass")
    run = case.simulate()
    found = analysis.regime_of(run)
    assert found["regime"] == "squeal"
    frequency, _ = fundamental(case.system.track)
    late = run.velocity.values[run.time.values > PERIODS, 0]
    spectrum = np.abs(np.fft.rfft(late * np.hanning(late.size), 1 << 20))
    tone = np.fft.rfftfreq(1 << 20, float(run.attrs["sample_interval"]))[spectrum.argmax()]
    assert 0.995 * frequency < tone < frequency
    # While it sticks, the tangential velocity of the rim is that of turning, slightly more due to the skin's
    # compliance.
    speed = RIM * case.system.track.turning
    along = 0.5 * np.abs(late).max()
    assert speed < along < 2.0 * speed
    assert 0.2 < found["sticking"] < 0.6


def carried(duration: float, lifted: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, st.System]:
    """Time, and the velocity across the rim of two waves, an eighth of a turn from the finger and a quarter from it."""
    system = glass()
    body, root = system.track, np.sqrt(0.5)
    lift = st.Sampled((0.0, lifted, lifted + 0.01), (1.0, 1.0, -0.3))
    push = st.Force(system.bodies[0].centre, z=-1.0, history=lift)
    probes = [
        st.Velocity(body.at((RIM, angle, HEIGHT)), way)
        for angle, way in ((0.0, "x"), (np.pi / 4, "x"), (np.pi / 4, "y"))
    ]
    run = st.simulate(replace(system, drives=[push, system.drives[1]]), duration, sample_rate=2e4, probes=probes)
    at = run.velocity.values
    frequency, _ = fundamental(body)
    band = butter(4, [0.8 * frequency, 1.2 * frequency], "bandpass", fs=2e4, output="sos")
    most, node = (hilbert(sosfiltfilt(band, one)) for one in (at[:, 0], root * (at[:, 1] + at[:, 2])))
    return run.time.values, most, node, system


def test_the_wave_stays_with_the_finger_and_the_glass_beats():
    """The waves stand below the finger; a point of the glass passes 2 n nodes a turn, so it beats at 2 n turns."""
    time, most, node, system = carried(2.5, 9.0)
    turning = system.track.turning
    late = (time > 0.45) & (time < 2.45)
    sizes = np.abs(most[late])
    assert np.ptp(sizes) < 0.02 * sizes.mean()
    assert np.abs(node[late]).max() < 0.06 * sizes.mean()
    seen = np.abs(np.cos(2.0 * turning * time) * most + np.sin(2.0 * turning * time) * node)[late] ** 2
    spectrum = np.abs(np.fft.rfft(seen - seen.mean()))
    beats = np.fft.rfftfreq(seen.size, 5e-5)[spectrum.argmax()]
    assert beats == pytest.approx(4.0 * turning / (2.0 * np.pi), rel=1e-3)
    assert seen.min() < 0.01 * seen.max()


def test_once_the_finger_is_lifted_waves_lag_behind_the_glass():
    """Coriolis forces: free waves turn by the drag n - g of the turning, of a thin ring n (n² - 1) / (n² + 1)."""
    time, most, node, system = carried(1.4, 0.6)
    angle = np.unwrap(2.0 * np.arctan((node / most).real)) / 2.0
    between = (time > 0.65) & (time < 1.3)
    rate = np.polyfit(time[between], angle[between], 1)[0]
    turning = system.track.modes().turning
    drag = turning.drag[turning.order.index(2.0)]
    assert rate == pytest.approx(drag * turning.velocity, rel=2e-3)
    # A ring has 1.2; the bowl below the rim moves across more than along.
    assert drag == pytest.approx(2.0 * 3.0 / 5.0, rel=0.05)
    # Negative control: the waves are fixed neither to the glass nor in space.
    assert abs(rate / (2.0 * turning.velocity) - 1.0) > 0.3
