"""Bodies that the recorded force of a string drives: against spectra, and against the march of the same force."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import stridula as st
from stridula.acoustics.panels import panel_of
from stridula.verification.systems.discs import HERE, struck

from .test_open_air import EARS
from .test_radiation import AIR, BLOW, PLATE, RATE, WIDTH, baffled_spectrum, error, known

# Level of the violin through a plate of spruce a metre above it [dB].
LEVEL = 89.0


def record(force: np.ndarray, rate: float = RATE) -> xr.Dataset:
    """A record with the force of a string on its support, and of another string that is silent."""
    time = np.arange(1, len(force) + 1) / rate
    forces = np.stack([0.0 * force, force], axis=1)
    names = ("support_force_probe", ["G string left end", "D string left end"])
    return xr.Dataset(
        {"support_force": (("time", "support_force_probe"), forces), "normal_force": ("time", 0.0 * force)},
        {"time": time, "support_force_probe": names},
    )


def test_a_plate_under_a_string_sounds_as_spectra_say():
    """An upward force sounds like a downward one with the other sign; the place is that of a contact's line."""
    samples, listener = 1500, (0.2, -0.15, 0.4)
    blow = record(np.exp(-(((np.arange(1, samples + 1) / RATE - BLOW) / WIDTH) ** 2)))
    x, y = panel_of(PLATE).place(np.array(0.09))
    for point in (PLATE.at(0.09), PLATE.at((float(x), float(y)))):
        found = st.radiate(blow, st.Bridge(point, probe="D string left end"), listener, air=AIR)
        expected = known(panel_of(PLATE), lambda f: baffled_spectrum(panel_of(PLATE), np.array(listener), f), samples)
        assert float(found.time[0]) == pytest.approx(0.0, abs=1e-12)
        assert error(-found.values[:, 0], expected) < 0.01
        assert found.attrs["notes"] == ""
        # Negative control: a sample late.
        assert error(-found.values[1:, 0], expected[:-1]) > 0.05
    elsewhere = st.radiate(blow, st.Bridge(PLATE.at(0.2), probe="D string left end"), listener, air=AIR)
    assert error(-elsewhere.values[:, 0], expected) > 0.5
    silent = st.radiate(blow, st.Bridge(PLATE.at(0.2), probe="G string left end"), listener, air=AIR)
    assert not silent.values.any()
    assert silent.attrs["notes"] == "silence: nothing pushes"


def test_a_body_in_space_sounds_as_the_march_of_the_same_force():
    system, disc = struck(0.0, damping=0.06)
    run = st.simulate(system, 0.02, step=5e-6, sample_rate=4e4)
    marched = st.radiate(run, system, EARS)
    (blow,) = system.drives
    force = np.interp(run.time.values, blow.history.time, blow.history.value) * blow.z
    bridged = record(force, 4e4)
    found = st.radiate(bridged, st.Bridge(disc.at(HERE), "z", "D string left end"), EARS)
    for ear in range(2):
        again = np.interp(marched.time, found.time, found.values[:, ear])
        assert error(again[:-4], marched.values[:-4, ear]) < 0.03
    twice = st.radiate(record(2.0 * force, 4e4), st.Bridge(disc.at(HERE), (0, 0, -1), "D string left end"), EARS)
    np.testing.assert_allclose(twice.values, -2.0 * found.values, atol=1e-9 * np.abs(found.values).max())


def test_the_violin_is_heard_through_a_plate():
    """A typical use: the string of the shipped case on the middle of a thin plate of spruce."""
    run = st.load_scenario("violin", {"simulation.duration": 0.3}).simulate()
    spruce = st.Material(8e9, 430.0, 0.3)
    top = st.ModalPlate(spruce, 3e-3, 0.35, 0.2, cutoff=10e3, damping=0.01, name="top")
    heard = st.radiate(run, st.Bridge(top.at((0.19, 0.1))), (0.17, 0.1, 1.0))
    late = heard.values[len(heard) // 2 :, 0]
    spectrum = np.abs(np.fft.rfft(late * np.hanning(len(late))))
    frequency = np.fft.rfftfreq(len(late), float(heard.time[1] - heard.time[0]))
    # Partials of the string, each through the response of the top.
    harmonic = np.abs(frequency / 195.4 - np.round(frequency / 195.4)) < 0.1
    assert (spectrum[harmonic] ** 2).sum() > 0.9 * (spectrum**2).sum()
    assert "continues another" not in heard.attrs["notes"]
    assert float(st.equivalent_level(heard).max()) == pytest.approx(LEVEL, abs=1.0)


def test_a_force_present_before_the_start_makes_no_transient():
    cut = record(np.full(500, 3.0)).assign_coords(time=0.1 + np.arange(500) / RATE)
    steady = st.radiate(cut, st.Bridge(PLATE.at(0.09), probe="D string left end"), air=AIR)
    assert not steady.values.any()
    assert "the record continues another one" in steady.attrs["notes"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({}, "probe must be one of G string left end, D string left end, got none"),
        ({"probe": "E"}, "probe must be one of G string left end, D string left end, got 'E'"),
        ({"probe": "D string left end", "direction": "x"}, "direction must have a part along the normal of the body"),
    ],
)
def test_bad_arguments_are_refused(words, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        st.radiate(record(np.ones(100)), st.Bridge(PLATE.at(0.1), **words))


def test_records_without_a_support_force_are_refused():
    run = record(np.ones(100)).drop_vars("support_force")
    with pytest.raises(ValueError, match=r"^run must have a SupportForce probe for a Bridge"):
        st.radiate(run, st.Bridge(PLATE.at(0.1)))
    with pytest.raises(ValueError, match=r"^bodies must be left out unless a System is given"):
        st.radiate(run, st.Bridge(PLATE.at(0.1)), bodies=[PLATE])
    with pytest.raises(ValueError, match=r"^point must be a BodyPoint"):
        st.Bridge(PLATE)
    turning = struck(100.0)[1]
    with pytest.raises(ValueError, match="point must be on a body that does not turn"):
        st.radiate(record(np.ones(100)), st.Bridge(turning.at(HERE), "z", "D string left end"))
    rod = st.load_scenario("squeal").system.slider
    with pytest.raises(ValueError, match="point must be a ModalBeam or a ModalPlate"):
        st.radiate(record(np.ones(100)), st.Bridge(rod.tip, probe="D string left end"))
    broken = record(np.where(np.arange(100) == 50, np.nan, 1.0))
    with pytest.raises(ValueError, match="support_force must be finite, got nan"):
        st.radiate(broken, st.Bridge(PLATE.at(0.1), probe="D string left end"))
