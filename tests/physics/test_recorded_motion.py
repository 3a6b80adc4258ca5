"""Sound from recorded motion of modes, against that of motion driven again by forces."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula.acoustics.recorded_motion import VARIABLE, recorded_motion
from stridula.acoustics.redriven import redriven

from .test_turning import disc, struck

PLACE = (0.3, 0.1, 0.5)
# Middles of thirds of an octave [Hz].
BANDS = (500.0, 1e3, 2e3, 4e3, 8e3)


def motions(*bodies):
    return [st.ModalMotion(body) for body in bodies]


def levels(signal, interval, bands=BANDS):
    """Levels of the later half of a signal in bands [dB]."""
    late = signal[len(signal) // 2 :]
    power = np.abs(np.fft.rfft(late * np.hanning(len(late)))) ** 2
    frequency = np.fft.rfftfreq(len(late), interval)
    edge = 2.0 ** (1.0 / 6.0)
    return np.array([10.0 * np.log10(power[(frequency > f / edge) & (frequency < f * edge)].sum()) for f in bands])


@pytest.fixture(scope="module")
def squeal():
    """The squealing pair, its motion recorded at 50 kHz, and its sound from forces at every step."""
    scenario = st.load_scenario("squeal", {"duration": "60 ms", "step": "5 us"})
    system = scenario.system
    run = scenario.simulate(sample_rate=50e3, probes=motions(system.slider, system.track))
    full = scenario.simulate(sample_rate=200e3, probes=[])
    known = st.radiate(full, system, PLACE, sample_rate=50e3)
    return system, run, known.values[:, 0]


def test_the_sound_of_a_squealing_pair_is_that_of_its_forces_at_every_step(squeal):
    system, run, known = squeal
    found = st.radiate(run, system, PLACE)
    again = st.radiate(run.drop_vars(VARIABLE), system, PLACE)
    assert [one.attrs["motion"] for one in (found, again)] == ["recorded", "driven again"]
    true = levels(known, 2e-5)
    assert np.abs(levels(found.values[:, 0], 2e-5) - true).max() < 0.1
    # Means over four steps alias frequencies above 25 kHz.
    assert np.abs(levels(again.values[:, 0], 2e-5) - true).max() > 0.2


def test_it_is_kept_in_single_precision_with_the_names_of_bodies(squeal):
    system, run, _ = squeal
    counts = {"slider": system.slider.modes(system.is_held(system.slider)).count, "track": system.track.modes().count}
    assert run[VARIABLE].dtype == np.float32
    assert run[VARIABLE].nbytes == 4 * run.sizes["time"] * sum(counts.values())
    assert run.modal_motion_body.values.tolist() == [name for name, count in counts.items() for _ in range(count)]
    assert run.modal_motion_probe.values[counts["slider"]] == "track mode 0"
    one = st.simulate(
        system, 2e-3, step=5e-6, sample_rate=50e3, probes=[st.ModalVelocity(system.track, 3), *motions(system.track)]
    )
    known = one.modal_velocity.values[:, 0]
    np.testing.assert_allclose(one[VARIABLE].values[:, 3], known, atol=1e-6 * np.abs(known).max())
    assert st.load_scenario(run).probes == tuple(motions(system.slider, system.track))


@pytest.fixture(scope="module")
def apart():
    """The squealing pair recorded at 200 kHz, its motion at 50 kHz."""
    scenario = st.load_scenario("squeal", {"duration": "60 ms", "step": "5 us"})
    return scenario, scenario.simulate(sample_rate=200e3, motion_rate=48e3)


def test_motion_at_a_rate_of_its_own_is_that_of_a_record_at_this_rate(squeal, apart):
    (system, known, _), run = squeal, apart[1]
    assert run[VARIABLE].dims == ("motion_time", "modal_motion_probe")
    np.testing.assert_array_equal(run[VARIABLE], known[VARIABLE])
    np.testing.assert_allclose(run.motion_time, known.time, rtol=1e-12)
    # The middle of the track is recorded as usual.
    assert run.acceleration.dims == ("time", "acceleration_probe")
    found, same = (st.radiate(one, system, PLACE) for one in (run, known))
    assert found.attrs["motion"] == "recorded"
    # The mean place of the slider, from which it is heard, is that of more samples.
    np.testing.assert_allclose(found, same, atol=1e-4 * np.abs(same).max())
    np.testing.assert_array_equal(*(st.radiate(one, system.track, PLACE) for one in (run, known)))
    again = st.load_scenario(run)
    assert again.motion_rate == pytest.approx(50e3)
    xr.testing.assert_equal(again.simulate(duration=2e-3)[VARIABLE], run[VARIABLE].isel(motion_time=slice(100)))


def test_a_part_of_such_a_record_has_the_sound_of_that_part(apart):
    scenario, run = apart
    whole = st.radiate(run, scenario.system, PLACE)
    part = st.radiate(run.sel(time=slice(0.02, 0.05)), scenario.system, PLACE)
    assert (part.time[0], part.time[-1]) == pytest.approx((0.02 - 2e-5, 0.05 - 2e-5), abs=2e-5)
    later = part.values[500:, 0]
    np.testing.assert_allclose(later, whole.interp(time=part.time).values[500:, 0], atol=0.02 * np.abs(later).max())


def test_bodies_are_all_driven_again_where_such_motion_is_not_that_of_all(apart):
    scenario, run = apart
    less = run.isel({f"{VARIABLE}_probe": run.modal_motion_body.values == "track"})
    assert st.radiate(less, scenario.system, PLACE).attrs["motion"] == "driven again"
    assert st.radiate(less, scenario.system, PLACE, bodies=[scenario.system.track]).attrs["motion"] == "recorded"
    only = scenario.simulate(duration=1e-3, motion_rate=50e3, probes=motions(scenario.system.track))
    assert set(only.modal_motion_body.values) == {"track"}


def test_a_continued_record_continues_such_motion_and_an_interrupted_one_has_all_up_to_its_end():
    scenario = st.load_scenario("squeal", {"duration": "20 ms"})
    words = {"motion_rate": 20e3, "sample_rate": 100e3, "step": 5e-6, "probes": []}
    whole, first = scenario.simulate(**words), scenario.simulate(duration=0.01, **words)
    later = scenario.simulate(duration=0.01, start=first, **words)
    xr.testing.assert_equal(later[VARIABLE], whole[VARIABLE].isel(motion_time=slice(200, None)))

    def interrupt(progress):
        raise KeyboardInterrupt

    with pytest.raises(st.Interrupted) as stopped:
        scenario.simulate(duration=1.0, watchers=[interrupt], **words)
    record = stopped.value.record
    assert record.sizes["motion_time"] == record.sizes["time"] // 5
    kept = min(record.sizes["motion_time"], whole.sizes["motion_time"]) - 20
    np.testing.assert_array_equal(record[VARIABLE][:kept], whole[VARIABLE][:kept])
    # From the place of the interruption, wherever in an interval it is.
    goes_on = scenario.simulate(duration=0.01, start=record, **words)
    assert goes_on.motion_time[0] == pytest.approx(record.time[-1] + 5e-5)


def test_such_a_record_goes_through_a_file_and_through_a_sweep(apart, tmp_path):
    scenario, run = apart
    st.save(run, tmp_path / "run.nc")
    xr.testing.assert_identical(st.load(tmp_path / "run.nc")[VARIABLE], run[VARIABLE])
    (found,) = st.simulate_many([scenario.system], 2e-3, motion_rate=50e3, sample_rate=200e3, step=5e-6)
    np.testing.assert_allclose(found[VARIABLE], run[VARIABLE][:100], atol=1e-4 * np.abs(run[VARIABLE]).max())
    # Records of sweeps have 20 kHz.
    words = {"duration": 2e-3, "motion_rate": 48e3}
    found = st.sweep(
        lambda first: (scenario.system if first else None, words),
        {"first": [True]},
        {"size": lambda run: float(run[VARIABLE].max())},
        probes=True,
    )
    assert found["size"].item() > 0.0


@pytest.mark.parametrize(
    ("rate", "words"),
    [
        (0.0, "motion_rate must be"),
        (float("nan"), "motion_rate must be"),
        (2e5, "motion_rate must be at most the sample rate, 100000 Hz, got 200000.0"),
        ("fast", "motion_rate must be"),
    ],
)
def test_rates_of_motion_that_cannot_be_are_refused(rate, words):
    scenario = st.load_scenario("squeal")
    with pytest.raises(st.ArgumentError, match=f"^{words}"):
        st.simulate(scenario.system, 1e-3, motion_rate=rate)


def test_only_a_track_of_the_same_modes_is_heard_so(squeal):
    system, run, _ = squeal
    own, other = system.track, replace(system.track, length=1.01 * system.track.length)
    assert st.radiate(run, own, PLACE).attrs["motion"] == "recorded"
    assert st.radiate(run, other, PLACE).attrs["motion"] == "driven again"
    # The recorded motion of one of two bodies is not enough.
    less = run.isel({f"{VARIABLE}_probe": run.modal_motion_body.values == "track"})
    assert recorded_motion(less, system.slider, "slider", system.is_held(system.slider)) is None
    assert st.radiate(less, system, PLACE).attrs["motion"] == "recorded or driven again"


@pytest.mark.parametrize("turning", [0.0, 100.0])
def test_a_disc_moves_as_its_forces_imply_turning_or_not(turning):
    system, plate = struck(turning)
    run = st.simulate(system, 0.03, step=1.0 / 480e3, sample_rate=48e3, probes=motions(plate))
    name, modes = system.body_name(plate), np.arange(plate.modes().count)
    found, known = recorded_motion(run, plate, name), redriven(run, system).of(name)
    bands = (500.0, 800.0, 1600.0, 2500.0)
    # At the same times, to half a sample.
    ahead = round((found.first - known.first) / found.interval)
    rows = found.accelerations(modes), known.accelerations(modes)[:, ahead : ahead + found.samples]
    direction = np.where(plate.modes().massless, 0.0, plate.trace((0.1, 2.0, 0.01))[2])
    heard, again = (levels(direction @ row, found.interval, bands) for row in rows)
    np.testing.assert_allclose(heard, again, atol=0.1)


def test_vibration_before_a_record_and_at_its_start_is_heard():
    """For a continued record, against the same time of an uncut one; and for a body struck beforehand."""
    scenario = st.load_scenario("squeal", {"duration": "20 ms"})
    track = scenario.system.track
    words = {"probes": motions(track), "sample_rate": 50e3, "step": 5e-6}
    whole, first = scenario.simulate(**words), scenario.simulate(duration=0.01, **words)
    later = scenario.simulate(duration=0.01, start=first, **words)
    np.testing.assert_array_equal(later[VARIABLE], whole[VARIABLE].values[len(first.time) :])
    known, found = (st.radiate(run, track, PLACE).values[-400:, 0] for run in (whole, later))
    again = st.radiate(later.drop_vars(VARIABLE), track, PLACE)
    size = np.abs(known).max()
    # Late sound of the first record is missing only for its travel time along the track.
    assert np.abs(found - known)[120:].max() < 0.01 * size
    assert np.abs(again.values[-400:, 0] - known)[120:].max() > 0.1 * size
    assert "continues another" in again.attrs["notes"]
    assert "continues another" not in st.radiate(later, track, PLACE).attrs["notes"]


def test_a_body_in_space_that_starts_in_motion_is_heard():
    plate = disc(0.0, cutoff=800.0)
    apart = st.RigidBody(1.0, points={"tip": (0.0, 0.0, 0.0)})
    contact = st.PointContact(apart.at("tip"), plate.at((0.1, 0.0, 0.01)), gap=1.0, normal=(0.0, 0.0, 1.0))
    system = st.System(contact, [st.InitialVelocity(plate, z=0.1)])
    run = st.simulate(system, 4e-3, sample_rate=1e4, probes=motions(plate))
    heard = st.radiate(run, system, (0.3, 0.3, 0.5))
    assert heard.values.any()
    assert heard.attrs["motion"] == "recorded"
    assert "starts with" not in heard.attrs["notes"]
    again = st.radiate(run.drop_vars(VARIABLE), system, (0.3, 0.3, 0.5))
    assert "vibration at the start" not in again.attrs["notes"]
    late = slice(15, -5)
    assert np.abs(again.values - heard.values)[late].max() < 0.02 * np.abs(heard.values).max()


def test_runs_side_by_side_also_record_it():
    scenario = st.load_scenario("squeal", {"duration": "2 ms"})
    system = scenario.system
    probes = motions(system.track)
    runs = st.simulate_many([system] * 2, 2e-3, probes=probes)
    alone = st.simulate(system, 2e-3, probes=probes)
    np.testing.assert_allclose(runs[1][VARIABLE], alone[VARIABLE], atol=1e-4 * np.abs(alone[VARIABLE]).max())


def test_only_bodies_have_modes_and_numbers_are_finite(squeal):
    system, run, _ = squeal
    broken = run.assign({VARIABLE: run[VARIABLE].where(run.time > 0.01)})
    with pytest.raises(ValueError, match=r"^modal_motion must be finite, got nan"):
        st.radiate(broken, system, PLACE)
    with pytest.raises(ValueError, match=r"^body must be a body of stridula"):
        st.ModalMotion("track")
