"""The time loop: ends, extension, low-pass, sampling, interruption, and refusals."""

from __future__ import annotations

import itertools
import re
import signal
import tomllib
from dataclasses import replace

import numpy as np
import pytest
import scipy.signal
import xarray as xr
from physics.cases import (
    CASES,
    SCHEME_NAMES,
    SCHEMES,
    STEP,
    dragged,
    every_step,
    pair,
    shaken,
    slider,
    track,
    transverse,
)

import stridula as st
from stridula.integration import together as together_module
from stridula.integration.decimation import Decimator
from stridula.integration.marches import March
from stridula.lowering import assemble

BOTH = pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)


def probed(system):
    """Probes of each kind on both bodies."""
    rod, bar = system.slider, system.track
    return [
        st.Displacement(rod.tip, "y"),
        st.Velocity(rod.root, "x"),
        st.Acceleration(bar.centre, "y"),
        st.Displacement(bar.at(0.3), "x"),
        st.Reaction(rod, "moment"),
    ]


def assert_same(pieces, whole):
    """The records of the pieces, one after the other, are the record of the whole, bit for bit."""
    for name in whole.data_vars:
        if "time" in whole[name].dims:
            joined = np.concatenate([piece[name].values for piece in pieces])
            np.testing.assert_array_equal(joined, whole[name].values, err_msg=name)
    np.testing.assert_allclose(np.concatenate([piece.time for piece in pieces]), whole.time, rtol=1e-15)
    np.testing.assert_array_equal(pieces[-1].state_modal, whole.state_modal)
    np.testing.assert_array_equal(pieces[-1].state_carried, whole.state_carried)


@BOTH
@pytest.mark.parametrize("ratio", [1, 2, 7])
@pytest.mark.parametrize("name", CASES)
def test_two_halves_are_the_whole(name, ratio, scheme):
    system = CASES[name]()
    words = {"scheme": scheme, "step": STEP, "sample_rate": 1 / (ratio * STEP), "probes": probed(system)}
    half = 1000 * ratio * STEP if ratio == 1 else 140 * 7 * STEP
    whole = st.simulate(system, 2 * half, **words)
    first = st.simulate(system, half, **words)
    second = st.simulate(system, half, start=first, **words)
    assert_same([first, second], whole)


def test_a_run_continues_from_a_saved_file(tmp_path):
    system = CASES["squeal"]()
    words = {"step": STEP, "sample_rate": 50e3, "probes": probed(system)}
    whole = st.simulate(system, 0.01, **words)
    first = st.simulate(system, 0.005, **words)
    import xarray as xr

    first.to_netcdf(tmp_path / "first.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "first.nc", engine="h5netcdf") as reopened:
        second = st.simulate(system, 0.005, start=reopened.load(), **words)
    assert_same([first, second], whole)


def test_short_pieces_are_the_whole():
    """Pieces shorter than the memory of the low-pass, 7 samples: it must be passed on completely."""
    system = pair(shaken, mu=0.7)
    words = {"step": STEP, "sample_rate": 1 / (4 * STEP), "probes": probed(system)}
    whole = st.simulate(system, 20 * 4 * STEP, **words)
    pieces = [st.simulate(system, 3 * 4 * STEP, **words)]
    for samples in (2, 5, 1, 9):
        pieces.append(st.simulate(system, samples * 4 * STEP, start=pieces[-1], **words))
    assert_same(pieces, whole)


def test_chunks_do_not_affect_the_result(monkeypatch):
    """A run in small chunks equals that in one chunk; memory stays that of the record."""
    system = CASES["squeal"]()
    words = {"step": STEP, "sample_rate": 1 / (4 * STEP), "probes": probed(system)}
    whole = st.simulate(system, 0.02, **words)
    monkeypatch.setattr(together_module, "STEPS_PER_CHUNK", 12)
    assert_same([st.simulate(system, 0.02, **words)], whole)


@pytest.mark.parametrize("ratio", [1, 2, 5])
def test_samples_are_means_sums_and_ends_of_the_steps(ratio):
    """Forces and slip velocity are means of the steps, energies and positions the value at the last, shares count."""
    system = CASES["squeal"]()
    fine = every_step(system, 10_000, SCHEMES[1])
    coarse = st.simulate(system, 10_000 * STEP, scheme=SCHEMES[1], step=STEP, sample_rate=1 / (ratio * STEP))
    for name in ("normal_force", "tangential_force", "slip_velocity"):
        means = fine[name].values.reshape(-1, ratio).mean(axis=1)
        # The mean slip velocity is a difference of two abscissae of 0.2 m.
        np.testing.assert_allclose(coarse[name], means, rtol=1e-12, atol=1e-15 / STEP if "slip" in name else 1e-14)
    for name in ("contact_position", "contact_height", "gap", "kinetic_and_elastic", "friction_loss"):
        np.testing.assert_array_equal(coarse[name], fine[name].values[ratio - 1 :: ratio])
    # The work of a constant load is that between two samples.
    np.testing.assert_allclose(coarse["drive_work"], fine["drive_work"].values[ratio - 1 :: ratio], rtol=1e-12)
    shares = fine.status_share.values.reshape(-1, ratio, 3).mean(axis=1)
    np.testing.assert_allclose(coarse.status_share, shares, atol=1e-15)
    np.testing.assert_allclose(coarse.time, fine.time.values[ratio - 1 :: ratio], rtol=1e-12)
    impulse = fine.normal_force.values.sum() * STEP
    assert coarse.normal_force.values.sum() * ratio * STEP == pytest.approx(impulse, rel=1e-12)


@pytest.mark.parametrize("ratio", [2, 5, 20])
def test_low_pass_stops_tones_above_half_the_rate_and_passes_those_below_a_quarter(ratio):
    """Tones fed at every step: over 40 dB down from half the sample rate on, within 1 % up to a quarter of it."""
    steps = 400 * ratio
    n = np.arange(steps)
    centres = np.arange(1, 400) * ratio
    for cycles in (0.5, 0.55, 0.7, 0.93, 1.3, 0.5 * ratio):
        if cycles > 0.5 * ratio:
            continue
        tone = np.exp(2j * np.pi * cycles / ratio * n)
        kept = np.hypot(*(Decimator(ratio).feed(part[:, None])[20:-20, 0] for part in (tone.real, tone.imag)))
        assert kept.max() < 10 ** (-40 / 20), cycles
    for cycles in (0.0, 0.01, 0.1, 0.2, 0.25):
        tone = np.cos(2 * np.pi * cycles / ratio * n + 0.4)
        kept = Decimator(ratio).feed(tone[:, None])[:, 0]
        # No delay: sample k is the value at step (k + 1) ratio.
        expected = tone[centres[: kept.size]]
        assert np.abs(kept - expected)[20:].max() < 0.01, cycles


def test_low_pass_harness_rejects_plain_picking():
    """Negative control: every fifth value passes a tone above half the sample rate unchanged."""
    tone = np.cos(2 * np.pi * 0.7 / 5 * np.arange(2000))
    assert np.abs(tone[::5]).max() > 0.9


@pytest.mark.parametrize("pieces", [[1] * 40, [3, 37], [17, 1, 2, 20], [40]])
def test_low_pass_does_not_depend_on_the_pieces_fed(pieces):
    random = np.random.default_rng(3).normal(size=(40 * 6, 2))
    whole = Decimator(6).feed(random)
    decimator, start, kept = Decimator(6), 0, []
    for piece in pieces:
        kept.append(decimator.feed(random[start : start + piece * 6]))
        start += piece * 6
    np.testing.assert_allclose(np.concatenate(kept), whole, atol=1e-14)


@pytest.mark.parametrize("ratio", [2, 5, 20])
def test_low_pass_is_that_of_scipy(ratio):
    """SciPy's windowed design and its polyphase filter, to round-off; importing them takes longer than most runs."""
    taps = scipy.signal.firwin(16 * ratio + 1, 0.75 / ratio, window=("kaiser", 6.2))
    decimator = Decimator(ratio)
    np.testing.assert_allclose(decimator.taps, taps, rtol=1e-12, atol=1e-16)
    random = np.random.default_rng(4).normal(size=(100 * ratio, 3))
    kept = decimator.feed(random)
    before = np.repeat(random[:1], decimator.memory, axis=0)
    filtered = scipy.signal.upfirdn(taps, np.concatenate([before, random]), down=ratio, axis=0)
    np.testing.assert_allclose(kept, filtered[16 : 16 + len(kept)], atol=1e-14)


def test_low_pass_of_no_probes_keeps_count():
    assert Decimator(4).feed(np.empty((400, 0))).shape == (91, 0)


@BOTH
def test_decimated_probes_are_the_probes_of_every_step(scheme):
    """Smooth motion far below a quarter of the rate: the low-pass gives the values at the same instants to 1e-3."""
    bar, rod = track(damping=0.02, cutoff=500.0), slider(cutoff=500.0)
    system = pair(lambda _: [st.Force(bar.at(0.3), y=1.0, history=st.Harmonic(150.0))], 0.5, rod=rod, bar=bar, gap=1.0)
    probes = [kind(bar.at(0.3), "y") for kind in (st.Displacement, st.Velocity, st.Acceleration)]
    fine = every_step(system, 20_000, scheme, probes=probes)
    coarse = st.simulate(system, 0.1, scheme=scheme, step=STEP, sample_rate=10e3, probes=probes)
    for kind in ("displacement", "velocity", "acceleration"):
        expected = fine[kind].values[19::20]
        off = np.abs(coarse[kind].values - expected)[10:].max()
        assert off < 1e-3 * np.abs(expected).max(), kind


@BOTH
def test_probes_are_derivatives_of_each_other(scheme):
    """Velocity and acceleration are the centred differences of the displacement, exactly."""
    system = CASES["dragged to and fro"]()
    kinds = (st.Displacement, st.Velocity, st.Acceleration)
    for point in (system.track.at(0.2), system.slider.at(0.1)):
        run = every_step(system, 2000, scheme, probes=[kind(point, "x") for kind in kinds])
        u, v, a = (run[kind.__name__.lower()].values[:, 0] for kind in kinds)
        scale = np.abs(u).max()
        # The root's own velocity is that of its history, of which the centred difference is within (w h)²/6 = 1.06e-6.
        tolerance = 1e-15 + (1.1e-6 * 0.02 * STEP if point.body is system.slider else 0)
        np.testing.assert_allclose((u[2:] - u[:-2]) / 2, v[1:-1] * STEP, atol=1e-12 * scale + tolerance)
        np.testing.assert_allclose(u[2:] - 2 * u[1:-1] + u[:-2], a[1:-1] * STEP**2, atol=1e-12 * scale + tolerance)


@BOTH
@pytest.mark.parametrize("ratio", [1, 2, 10])
def test_a_tip_that_leaves_its_track_ends_the_run_there(ratio, scheme):
    """Dragged at 1 m/s from 5 mm before the end: 5 ms recorded of 20, the last abscissa within a sample of the end."""
    system = pair(dragged(1.0, 0.5), mu=0.1, at=0.795)
    probes = [st.Displacement(system.slider.root, "x"), st.Acceleration(system.track.centre)]
    run = st.simulate(system, 0.02, scheme=scheme, step=STEP, sample_rate=1 / (ratio * STEP), probes=probes)
    assert run.attrs["ended"] == "off the track"
    assert 0.004 < run.time.values[-1] < 0.006
    assert run.sizes["time"] * ratio == run.attrs["last_step"]
    assert 0.8 - 2.5 * ratio * STEP < run.contact_position.values[-1] < 0.8
    for name in run.data_vars:
        if "time" in run[name].dims:
            assert np.all(np.isfinite(run[name])), name
    with pytest.raises(ValueError, match="start must be a run that can be continued"):
        st.simulate(system, 0.01, scheme=scheme, step=STEP, sample_rate=1 / (ratio * STEP), probes=probes, start=run)


@pytest.mark.parametrize("ratio", [1, 2, 10])
def test_the_last_probe_sample_before_the_end_of_the_track_is_no_jump(ratio):
    """Beyond the end the low-pass uses the last value, not zero: a root at 1 m/s stays on its line."""
    system = pair(dragged(1.0, 0.5), mu=0.1, at=0.795)
    probes = [st.Displacement(system.slider.root, "x")]
    run = st.simulate(system, 0.02, step=STEP, sample_rate=1 / (ratio * STEP), probes=probes)
    root = run.displacement.values[:, 0]
    assert np.abs(root - run.time.values).max() < 8 * ratio * STEP


@BOTH
def test_off_the_track_at_the_left_end_too(scheme):
    run = st.simulate(pair(dragged(-1.0, 0.5), mu=0.1, at=0.005), 0.02, scheme=scheme, step=STEP)
    assert run.attrs["ended"] == "off the track"
    assert 0 < run.contact_position.values[-1] < 1e-4


def test_an_interrupted_run_keeps_its_record_and_can_continue():
    """A Ctrl-C between chunks: the record so far, and its extension is the run that was not interrupted."""
    system = CASES["squeal"]()
    words = {"step": STEP, "sample_rate": 50e3, "probes": probed(system)}
    whole = st.simulate(system, 0.4, **words)

    def stop(progress):
        if progress.time > 0.15:
            raise KeyboardInterrupt

    with pytest.raises(st.Interrupted) as caught:
        st.simulate(system, 0.4, watchers=[stop], **words)
    first = caught.value.record
    assert first.attrs["ended"] == "interrupted"
    assert 0.15 < first.time.values[-1] < 0.4
    second = st.simulate(system, 0.4 - first.time.values[-1], start=first, **words)
    assert_same([first, second], whole)


@pytest.fixture
def ctrl_c():
    """Python's own handler of SIGINT, independent of the test runner."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield lambda: signal.raise_signal(signal.SIGINT)
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_during_the_march_leaves_state_and_record_together(monkeypatch, ctrl_c):
    """Python delivers a Ctrl-C as the compiled march returns: state and record kept must be those of one instant."""
    system = CASES["squeal"]()
    words = {"step": STEP, "sample_rate": 50e3, "probes": probed(system)}
    whole = st.simulate(system, 0.4, **words)
    advance, calls = March.advance, []

    def struck(*arguments):
        result = advance(*arguments)
        calls.append(1)
        if len(calls) == 2:
            ctrl_c()
        return result

    monkeypatch.setattr(March, "advance", struck)
    with pytest.raises(st.Interrupted) as caught:
        st.simulate(system, 0.4, **words)
    monkeypatch.setattr(March, "advance", advance)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    first = caught.value.record
    second = st.simulate(system, 0.4 - first.sizes["time"] * first.attrs["sample_interval"], start=first, **words)
    assert_same([first, second], whole)


def test_a_state_that_is_not_finite_is_reported_with_the_record_kept():
    """A force of 1e200 N on the track, away from the slider, whose energy overflows: the run must end, not give NaN."""
    bar = track()
    late = st.Sampled((0.0, 1e-3, 2e-3), (0.0, 0.0, 1.0))
    system = pair(lambda _: [st.Force(bar.at(0.3), y=-1e200, history=late)], 0.5, bar=bar, gap=1.0)
    with pytest.raises(st.Diverged, match="no longer finite") as caught:
        st.simulate(system, 0.5, step=STEP)
    record = caught.value.record
    assert record.attrs["ended"] == "not finite"
    assert record.sizes["time"] == 100
    assert np.all(np.isfinite(record.kinetic_and_elastic))


def test_a_march_that_diverges_does_not_pass_for_a_tip_off_its_track(monkeypatch):
    """Without the limit of the step the tip leaves [0, L] before anything overflows."""
    monkeypatch.setattr(st.CentralDifference, "limit", lambda self, angular, damping: np.inf)
    with pytest.raises(st.Diverged):
        st.simulate(CASES["squeal"](), 0.2, scheme=st.CentralDifference(), step=2e-4, sample_rate=5e3)


def test_watchers_receive_rising_times():
    seen = []
    st.simulate(CASES["squeal"](), 0.5, step=STEP, watchers=[seen.append])
    times = [progress.time for progress in seen]
    assert times == sorted(times)
    assert len(times) >= 5
    assert times[-1] == pytest.approx(0.5)
    assert {progress.duration for progress in seen} == {seen[0].duration}


@BOTH
def test_step_at_or_above_the_limit_is_refused_with_the_limit(scheme):
    system = CASES["squeal"]()
    arrays = assemble(system)
    limit = scheme.limit(arrays.angular_frequency, arrays.damping_rate)
    highest = arrays.angular_frequency.max()
    expected = 2 / highest if scheme.name == "central difference" else np.pi / (highest * np.sqrt(1 - 0.02**2))
    assert limit == pytest.approx(expected, rel=1e-12)
    for step in (limit, 1.001 * limit, 1.0):
        with pytest.raises(ValueError, match=r"^step must be below .*limit of [0-9.e-]+ s, got") as caught:
            st.simulate(system, 0.01, scheme=scheme, step=step)
        said = float(re.search(r"limit of (\S+) s", str(caught.value))[1])
        assert limit * (1.0 - 1e-5) < said <= limit
    run = st.simulate(system, 0.005, scheme=scheme, step=limit * (1 - 1e-9))
    assert np.all(np.isfinite(run.kinetic_and_elastic))


@BOTH
@pytest.mark.parametrize("sample_rate", [44_100.0, 1e5, 3e6])
def test_default_step_divides_the_sample_and_stays_below_its_share_of_the_limit(sample_rate, scheme):
    system = CASES["squeal"]()
    run = st.simulate(system, 1e-3, scheme=scheme, sample_rate=sample_rate)
    arrays = assemble(system)
    limit = scheme.limit(arrays.angular_frequency, arrays.damping_rate)
    assert run.attrs["step"] <= scheme.default_fraction * limit * (1 + 1e-9)
    assert run.attrs["sample_interval"] == pytest.approx(1 / sample_rate, rel=1e-12)
    assert run.attrs["step"] * run.attrs["steps_per_sample"] == pytest.approx(1 / sample_rate, rel=1e-12)


SYSTEM = pair(transverse(), mu=0.5)
BAD = [
    ("duration", float("nan"), "finite"),
    ("duration", float("inf"), "finite"),
    ("duration", 0.0, "above 0"),
    ("duration", -1.0, "above 0"),
    ("duration", True, "number"),
    ("duration", "1", "number"),
    ("duration", None, "number"),
    ("duration", 1e9, "GB"),
    ("step", float("nan"), "finite"),
    ("step", 0.0, "above 0"),
    ("step", -1e-6, "above 0"),
    ("step", True, "number"),
    ("step", "1e-6", "number"),
    ("sample_rate", float("nan"), "finite"),
    ("sample_rate", float("inf"), "finite"),
    ("sample_rate", 0.0, "above 0"),
    ("sample_rate", -1.0, "above 0"),
    ("sample_rate", False, "number"),
    ("sample_rate", "fast", "number"),
    ("scheme", "exact modal", "CentralDifference or ExactModal"),
    ("scheme", 3, "CentralDifference or ExactModal"),
    ("system", None, "System"),
    ("system", "squeal", "System"),
    ("probes", [st.Coulomb(1.0)], "Displacement"),
    ("probes", ["tip"], "Displacement"),
    ("start", "run.nc", "Dataset"),
]


@pytest.mark.parametrize(("name", "value", "allowed"), BAD, ids=[f"{bad[0]}={bad[1]!r}"[:30] for bad in BAD])
def test_bad_arguments_are_named_with_value_and_range(name, value, allowed):
    words = {"system": SYSTEM, "duration": 1e-3} | {name: value}
    with pytest.raises(ValueError, match=allowed) as caught:
        st.simulate(words.pop("system"), words.pop("duration"), **words)
    message = str(caught.value)
    assert message.startswith(name)
    assert "\n" not in message
    if name != "probes":
        assert repr(value) in message


@pytest.mark.parametrize("value", [5, st.Coulomb(1.0)])
def test_probes_must_be_a_sequence(value):
    with pytest.raises(ValueError, match=r"^probes must be"):
        st.simulate(SYSTEM, 1e-3, probes=value)


@pytest.mark.parametrize("change", ["scheme", "step", "sample_rate", "modes", "probes", "variables"])
def test_a_start_of_another_run_is_refused(change):
    words = {"step": STEP, "sample_rate": 50e3}
    first = st.simulate(SYSTEM, 1e-3, **words)
    system = SYSTEM
    if change == "scheme":
        words["scheme"] = st.CentralDifference()
    elif change == "step":
        words["step"] = STEP / 2
    elif change == "sample_rate":
        words["sample_rate"] = 100e3
    elif change == "modes":
        system = pair(transverse(), mu=0.5, bar=track(cutoff=10e3))
    elif change == "probes":
        words["probes"] = []
    else:
        first = first.drop_vars("state_modal")
    with pytest.raises(ValueError, match=r"^start must") as caught:
        st.simulate(system, 1e-3, start=first, **words)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "change", "words"),
    [
        ("state_carried", lambda state: state[:, :-3], r"state_carried of shape \(1, 35\), .*, got \(1, 32\)"),
        ("state_energies", lambda state: state[:-1], "state_energies of shape"),
        ("state_modal", lambda state: state * np.nan, "a finite state_modal"),
        ("state_modal", lambda state: state[0, 0], "the same number of modes"),
        ("state_raw", lambda state: state[:-1], "state_raw of shape"),
        ("state_raw", lambda state: state[:, 0], "the same number of probes"),
        ("state_motion", lambda state: state[:2], "state_motion of shape"),
        ("state_carried", lambda state: state.astype(str), "a finite state_carried"),
    ],
)
def test_a_state_of_another_shape_is_refused(name, change, words):
    """Otherwise compiled code would read beyond its end."""
    record = st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3)
    values = change(record[name].values)
    damaged = record.drop_vars(name).assign({name: ([f"axis{k}" for k in range(values.ndim)], values)})
    with pytest.raises(ValueError, match=f"^start must have {'a ' if words.startswith('state') else ''}{words}"):
        st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3, start=damaged)


@pytest.mark.parametrize(
    "name", ["ended", "scenario", "scheme", "step", "steps_per_sample", "last_step", "initial_energy", "state_layout"]
)
def test_a_start_without_an_attribute_is_refused_by_its_name(name):
    record = st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3)
    del record.attrs[name]
    with pytest.raises(ValueError, match=rf"^start must have .*{name}"):
        st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3, start=record)


def test_a_start_whose_state_is_laid_out_otherwise_is_refused():
    record = st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3)
    record.attrs["state_layout"] += 1
    with pytest.raises(
        ValueError, match=r"^start must have the state_layout of this version, \d+, got \d+: a record of "
    ):
        st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3, start=record)


@pytest.mark.parametrize("kept", [slice(0, 20), slice(0, -1), slice(0, 0)])
def test_a_start_that_is_cut_is_refused(kept):
    """It holds the state at its former end."""
    record = st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3)
    message = (
        r"^start must be a complete record, up to its final state at 0\.001 s, got a last time of (none|0\.000\d+ s): "
    )
    with pytest.raises(ValueError, match=message) as caught:
        st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3, start=record.isel(time=kept))
    assert "\n" not in str(caught.value)


def test_a_start_may_lack_its_first_samples():
    record = st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3)
    late = record.isel(time=slice(-5, None))
    onwards = [st.simulate(SYSTEM, 1e-3, step=STEP, sample_rate=50e3, start=start) for start in (record, late)]
    xr.testing.assert_equal(*onwards)


def test_no_probes_and_no_drives_are_allowed():
    quiet = replace(SYSTEM, drives=())
    run = st.simulate(quiet, 1e-3, step=STEP, probes=[])
    assert np.all(run.kinetic_and_elastic == 0)
    assert np.all(run.status == 0)
    assert "acceleration" not in run


def test_probe_on_another_body_is_refused():
    other = replace(SYSTEM.track, length=0.7)
    with pytest.raises(ValueError, match=r"^probe.* must be on a body of this system"):
        st.simulate(SYSTEM, 1e-3, probes=[st.Acceleration(other.centre)])
    with pytest.raises(ValueError, match=r"^probe.* must be on the slider of this system"):
        st.simulate(SYSTEM, 1e-3, probes=[st.Reaction(replace(SYSTEM.slider, length=0.4))])


def test_a_run_continues_only_from_the_same_bodies_and_place():
    system = CASES["squeal"]()
    first = st.simulate(system, 1e-3, step=STEP)
    elsewhere = st.System(
        st.PointContact(system.slider.tip, system.track, at=0.3, friction=st.Coulomb(1.5), gap=1e-6), system.drives
    )
    with pytest.raises(ValueError, match=r"^start must have the same contact.at as this run, 0.3, got 0.2"):
        st.simulate(elsewhere, 1e-3, step=STEP, start=first)
    with pytest.raises(ValueError, match=r"^start must have the same probes.0.quantity as this run, 'velocity', got "):
        st.simulate(system, 1e-3, step=STEP, start=first, probes=[st.Velocity(system.track.centre)])
    rougher = st.PointContact(system.slider.tip, system.track, at=0.2, friction=st.Coulomb(2.0), gap=1e-6)
    assert st.simulate(st.System(rougher, system.drives), 1e-3, step=STEP, start=first).attrs["ended"] == "finished"


def test_the_scenario_of_an_extension_runs_the_whole():
    system = CASES["squeal"]()
    first = st.simulate(system, 1e-3, step=STEP)
    second = st.simulate(system, 2e-3, step=STEP, start=first)
    assert tomllib.loads(second.attrs["scenario"])["simulation"]["duration"] == pytest.approx(3e-3, rel=1e-12)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"duration": 1e-6}, r"^duration must be at least half a sample interval of 1e-05 s, got 1e-06"),
        ({"duration": 1.0, "step": 1e-300}, r"^step must be at least .* s for these modes, got 1e-300"),
        ({"duration": 1e4, "sample_rate": 1e-3}, r"^sample_rate must be at least .* Hz at a step of .*, got 0.001"),
        ({"duration": 1.0, "watchers": 5}, r"^watchers must be a list of callables, got 5"),
    ],
)
def test_impossible_timings_are_refused(words, message):
    with pytest.raises(ValueError, match=message):
        st.simulate(SYSTEM, **words)


@pytest.mark.parametrize("name", ["squeal", "squeal-on-plate"])
def test_a_march_that_had_to_be_compiled_first_is_the_same(name, monkeypatch):
    """It is compiled by a step of a copy, which does not affect either march."""
    case = st.load_scenario(name, {"duration": "20 ms"})
    # The first of a process loads the kernel.
    _, warm = case.simulate(), case.simulate()

    monkeypatch.setattr(March, "is_compiled", False)
    monkeypatch.setattr(together_module, "compilations", itertools.count().__next__)
    first = case.simulate()
    assert first.attrs["compile_time"] > 0.0 == warm.attrs["compile_time"]
    assert_same([first], warm)


def pulled(history: st.Constant | st.Sampled, velocity: float = 0.01) -> st.System:
    system = st.load_scenario("weak-pressure").system
    return st.System(system.contacts[0], [st.ImposedVelocity(system.slider.root, velocity, 2.0, history)])


@BOTH
def test_a_run_continues_at_another_velocity_from_the_place_of_the_tip(scheme):
    """As a run whose velocity changes on the way, over one step."""
    words = {"scheme": scheme, "step": 2.5e-6, "sample_rate": 100e3}
    half = 0.04
    first = st.simulate(pulled(st.Constant()), half, **words)
    second = st.simulate(pulled(st.Constant(), 0.02), 0.002, start=first, **words)
    times = [0.0, half, half + 2.5e-6, 1.0]
    whole = st.simulate(pulled(st.Sampled(times, [1.0, 1.0, 2.0, 2.0])), half + 0.002, **words)
    after = whole.isel(time=slice(first.sizes["time"], None))
    travelled = after.contact_position.values - first.contact_position.values[-1]
    assert np.abs(second.contact_position.values - after.contact_position.values).max() < 0.01 * np.ptp(travelled)
    # The step over which one of them changes is amplified by the impacts that follow.
    force = [np.cumsum(run.normal_force.values[:100]) for run in (second, after)]
    assert np.abs(force[0] - force[1]).max() < 0.02 * force[1][-1]
    assert np.abs(second.ledger_residual.values).max() < 1e-9 * np.abs(second.drive_work.values).max()
    third = st.simulate(pulled(st.Constant(), 0.02), 0.002, start=second, **words)
    both = st.simulate(pulled(st.Constant(), 0.02), 0.004, start=first, **words)
    assert np.array_equal(both.normal_force.values[second.sizes["time"] :], third.normal_force.values)
