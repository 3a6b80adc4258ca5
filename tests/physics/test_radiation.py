"""The sound of a track: its motion against the march, the pressure against spectra, air, added mass.

Piston, monopole, Wallace's efficiencies, directivities and the balance of energy are cases of `stridula verify`;
negative controls are here.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from math import pi, sqrt

import numpy as np
import pytest
import xarray as xr
from scipy.special import erf, h2vp, hankel2

import stridula as st
from stridula.acoustics import bodies_sound
from stridula.acoustics.delays import Sampling
from stridula.acoustics.dipoles import dipole_response, moved_area
from stridula.acoustics.driven import LEAD, accelerations, first_time, steady, undo_mean
from stridula.acoustics.panels import line_of, panel_of
from stridula.acoustics.rayleigh import baffled_response
from stridula.acoustics.recorded import pressing
from stridula.acoustics.resampling import bandwidth_of, ratio_of
from stridula.acoustics.surfaces import Surface, surface_of
from stridula.verification import radiation

from .cases import STEEL

AIR = st.Air()
RATE = 100e3
# Short and stiff: the response to a blow decays within 40 ms.
BEAM = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.02), 0.25, damping=0.03, cutoff=15e3)
PLATE = st.ModalPlate(STEEL, 0.02, 0.25, 0.15, damping=0.02, cutoff=15e3)
PLACE = 0.09
# A blow at 2 ms, 30 us wide: 1e-5 of it is left at 26 kHz.
BLOW, WIDTH = 2e-3, 30e-6


def record(samples: int = 2000, at: float = PLACE, rate: float = RATE, height: float = 1.0, **attributes) -> xr.Dataset:
    """A record of one blow, its means exact."""
    time = np.arange(1, samples + 1) / rate
    passed = sqrt(pi) / 2.0 * WIDTH * erf((np.concatenate([[0.0], time]) - BLOW) / WIDTH)
    force = height * np.diff(passed) * rate
    data = {"normal_force": ("time", force), "contact_position": ("time", np.full(samples, at))}
    return xr.Dataset(data, {"time": time}, attributes)


def blow(frequency: np.ndarray) -> np.ndarray:
    """The Fourier transform of the blow."""
    angular = 2.0 * pi * frequency
    return sqrt(pi) * WIDTH * np.exp(-((angular * WIDTH / 2.0) ** 2) - 1j * angular * BLOW)


def mobility(panel, frequency: np.ndarray, at: float) -> np.ndarray:
    """Accelerations of the modes for a unit force on the track, which presses it down, shape (modes, frequencies)."""
    angular = 2.0 * pi * frequency
    own, rate = panel.angular_frequency[:, None], panel.damping_rate[:, None]
    shapes = panel.shapes(*(np.atleast_1d(part) for part in panel.place(np.array([at]))))[0]
    return shapes[:, None] * angular**2 / (own**2 - angular**2 + 1j * rate * angular)


def baffled_spectrum(panel, listener: np.ndarray, frequency: np.ndarray) -> np.ndarray:
    """Rayleigh's integral of every mode by the midpoint rule, shape (modes, frequencies).

    It is also, by reciprocity, the force on the mode from a source of unit volume acceleration at the listener.
    """
    nx, ny = (400, 16) if panel.width < 0.1 else (100, 60)
    x = (np.arange(nx) + 0.5) / nx * panel.length
    y = panel.edge + (np.arange(ny) + 0.5) / ny * panel.width
    x, y = (part.ravel() for part in np.meshgrid(x, y, indexing="ij"))
    away = np.sqrt((x - listener[0]) ** 2 + (y - listener[1]) ** 2 + listener[2] ** 2)
    area = panel.length * panel.width / (nx * ny)
    weights = AIR.density / (2.0 * pi) * area * panel.shapes(x, y).T / away
    return turned(weights, away, frequency)


def turned(weights: np.ndarray, away: np.ndarray, frequency: np.ndarray) -> np.ndarray:
    """Weights at distances, each delayed, summed, shape (modes, frequencies); frequencies are evenly spaced."""
    turn = np.exp(-2j * pi * (frequency[1] - frequency[0]) / AIR.speed * away)
    phase = np.exp(-2j * pi * frequency[0] / AIR.speed * away)
    found = np.empty((len(weights), len(frequency)), dtype=complex)
    for number in range(len(frequency)):
        found[:, number] = weights @ phase
        phase *= turn
    return found


def dipole_spectrum(panel, area: float, listener: np.ndarray, frequency: np.ndarray) -> np.ndarray:
    """The line of dipoles by the midpoint rule, shape (modes, frequencies)."""
    x = (np.arange(600) + 0.5) / 600 * panel.length
    away = np.sqrt((x - listener[0]) ** 2 + listener[1] ** 2 + listener[2] ** 2)
    weights = AIR.density * area / (4.0 * pi) * panel.length / 600 * panel.shapes(x, 0.0 * x).T * listener[2] / away**2
    waves = 2j * pi * frequency / AIR.speed
    return waves * turned(weights, away, frequency) + turned(weights / away, away, frequency)


def known(panel, paths, samples: int) -> np.ndarray:
    """The pressure in time, from spectra on a period of 80 ms."""
    frequency = np.fft.rfftfreq(8000, 1.0 / RATE)
    low = frequency <= 28e3
    spectrum = np.zeros(frequency.size, dtype=complex)
    motion = mobility(panel, frequency[low], PLACE) * blow(frequency[low])
    spectrum[low] = np.sum(motion * paths(frequency[low]), axis=0)
    return np.fft.irfft(spectrum, 8000)[:samples] * RATE


def error(found: np.ndarray, expected: np.ndarray) -> float:
    """Largest distance over the largest value."""
    return float(np.abs(found - expected).max() / np.abs(expected).max())


# The motion


@pytest.fixture(scope="module")
def squeal():
    """A scenario recorded at every step, and the track's centre."""
    scenario = st.load_scenario("squeal", {"duration": "80 ms", "sample_rate": "200 kHz"})
    return scenario.system.track, scenario.simulate()


def centre_acceleration(track, run, droop=1.0) -> np.ndarray:
    """The acceleration of the centre at the record's times, driven again."""
    panel, pressed = panel_of(track), pressing(run, panel_of(track))
    shapes = panel.shapes(np.array([track.length / 2.0]), np.zeros(1))[0] * droop
    moved = shapes @ accelerations(panel, pressed)
    spectrum, size = np.fft.rfft(moved, 2 * moved.size), 2 * moved.size
    ahead = (run.time.values[0] - first_time(pressed)) / pressed.interval
    shifted = np.fft.irfft(spectrum * np.exp(2j * pi * np.fft.rfftfreq(size) * ahead), size)
    return shifted[: run.sizes["time"]]


def test_the_track_moves_again_as_it_did_in_the_march(squeal):
    """If each step is a sample, exactly the same, except for the band above 5/12 of the rate.

    The probe is a second difference over steps h, with a gain of ``sinc²(f h)``. In the march a force moves a mode like
    a constant one, ``tan(w h / 2) / (w h / 2)`` times as much as the impulse that it is.
    """
    track, run = squeal
    assert run.attrs["steps_per_sample"] == 1
    half = panel_of(track).angular_frequency * run.attrs["step"] / 2.0
    droop = np.sinc(half / pi) ** 2 * np.tan(half) / half
    found, probe = centre_acceleration(track, run, droop), run.acceleration.values[:, 0]
    spectra = [np.fft.rfft(values * np.hanning(values.size)) for values in (found, probe)]
    low = np.fft.rfftfreq(probe.size, run.attrs["sample_interval"]) < 20e3
    assert np.abs(spectra[0] - spectra[1])[low].max() < 1e-4 * np.abs(spectra[1]).max()
    # Negative control: the wrong place, 5 mm beside.
    beside = run.assign(contact_position=run.contact_position + 0.005)
    other = np.fft.rfft(centre_acceleration(track, beside, droop) * np.hanning(probe.size))
    assert np.abs(other - spectra[1])[low].max() > 1e-2 * np.abs(spectra[1]).max()


def test_means_over_two_steps_are_enough_below_ten_kilohertz():
    """At the default 100 kHz the error is the force above 50 kHz, aliased."""
    scenario = st.load_scenario("squeal", {"duration": "80 ms"})
    run = scenario.simulate()
    assert run.attrs["steps_per_sample"] == 2
    found, probe = centre_acceleration(scenario.system.track, run), run.acceleration.values[:, 0]
    spectra = [np.fft.rfft(values * np.hanning(values.size)) for values in (found, probe)]
    frequency = np.fft.rfftfreq(probe.size, run.attrs["sample_interval"])
    for highest, least in ((5e3, 0.9999), (10e3, 0.999)):
        low = frequency < highest
        one, other = (np.where(low, spectrum, 0.0) for spectrum in spectra)
        correlation = np.vdot(one, other).real / (np.linalg.norm(one) * np.linalg.norm(other))
        assert correlation > least
        # The probe's own second difference takes (pi f h)² / 3, 0.8 % at 10 kHz.
        assert np.linalg.norm(one) == pytest.approx(np.linalg.norm(other), rel=0.01)


@pytest.mark.parametrize("steps", [1, 2, 3, 7, 10**6])
def test_means_are_undone(steps):
    frequency = np.linspace(0.0, 5.0 / 12.0, 97)
    taps = np.exp(-2j * pi * frequency[:, None] * np.arange(-LEAD, LEAD + 1)) @ undo_mean(steps)
    parts = (np.arange(min(steps, 1000)) + 0.5) / min(steps, 1000) - 0.5
    mean = np.exp(2j * pi * frequency[:, None] * parts).mean(axis=1)
    np.testing.assert_allclose(taps * mean, 1.0, atol=1e-5)


# The whole computation


@pytest.mark.parametrize(
    ("track", "listener"),
    [
        (BEAM, (0.2, 0.15, 0.4)),
        (BEAM, (0.1, 0.0, 0.004)),
        (PLATE, (0.2, -0.15, 0.4)),
        (PLATE, (0.1, 0.1, 0.02)),
    ],
    ids=["strip, far", "strip, close", "plate, far", "plate, close"],
)
def test_sound_of_a_blow_is_that_of_spectra(track, listener):
    """Driving and delays in time against mobilities and Rayleigh's integral in frequency.

    Recurrences are right to 0.3 % per percent of damping away from resonance: 1 %.
    """
    panel, samples = panel_of(track), 1500
    found = st.radiate(record(samples), track, listener, air=AIR)
    expected = known(panel, lambda f: baffled_spectrum(panel, np.array(listener), f), samples)
    assert found.dims == ("time", "listener")
    assert error(found.values[:, 0], expected) < 0.01
    # Negative controls: a sample late, and the other sign.
    assert error(found.values[1:, 0], expected[:-1]) > 0.05
    assert error(-found.values[:, 0], expected) > 1.0


def test_sound_of_a_blow_in_free_air():
    samples, listener = 1500, (0.1, 0.2, 0.1)
    panel, area = line_of(BEAM), moved_area(BEAM.section)
    found = st.radiate(record(samples), BEAM, listener, baffled=False, air=AIR).values[:, 0]
    expected = known(panel, lambda f: dipole_spectrum(panel, area, np.array(listener), f), samples)
    assert error(found, expected) < 0.01
    below = st.radiate(record(samples), BEAM, (0.1, 0.2, -0.1), baffled=False, air=AIR).values[:, 0]
    np.testing.assert_allclose(below, -found, atol=1e-12 * np.abs(found).max())


@pytest.mark.parametrize("away", [0.05, 0.4])
def test_a_long_round_beam_sounds_like_a_cylinder(away):
    """The middle of 100 m in one half-wave against an oscillating cylinder of radius a.

    Exact in the plane: ``p = i rho c v H1(k r) / H1'(k a)`` on its axis of motion (Morse & Ingard 1968, section 7.3),
    of which the line of dipoles is the limit of small ka: terms of (ka)² ln ka. The half-wave changes it by (away / 100
    m).
    """
    radius, frequency, interval = 0.002, 2000.0, 1.0 / 16e3
    section = st.Circle(2.0 * radius)
    panel = line_of(st.ModalBeam(STEEL, section, 100.0, bending_modes=1, axial_modes=0))
    place = np.array([50.0, 0.0, away])
    response = dipole_response(panel, moved_area(section), place, AIR, Sampling(interval, 0.25 / interval))
    samples = response.first + np.arange(len(response.taps))
    found = np.exp(-2j * pi * frequency * interval * samples) @ response.taps[:, 0] / panel.amplitude
    number = 2.0 * pi * frequency / AIR.speed
    # For unit acceleration, v = 1 / (i w); Hankel functions of the second kind go with e^(i w t).
    exact = -1j * AIR.impedance * hankel2(1, number * away) / h2vp(1, number * radius) / (2j * pi * frequency)
    assert abs(found / exact - 1.0) < 3.0 * (number * radius) ** 2 * abs(np.log(number * radius))


def test_contacts_add_and_doubled_forces_double():
    one, other = record(800), record(800, at=0.15, height=-0.3)
    both = xr.concat([one, other], dim="contact")
    heard = [st.radiate(run, BEAM, (0.2, 0.1, 0.5)).values for run in (one, other, both, record(800, height=2.0))]
    largest = np.abs(heard[0]).max()
    np.testing.assert_allclose(heard[2], heard[0] + heard[1], atol=1e-10 * largest)
    np.testing.assert_allclose(heard[3], 2.0 * heard[0], atol=1e-10 * largest)


def test_modes_in_parts_sound_as_at_once(monkeypatch):
    whole = st.radiate(record(800), BEAM, (0.2, 0.1, 0.5)).values
    monkeypatch.setattr(bodies_sound, "MEMORY", 8 * 3 * 800 * 2)
    parts = st.radiate(record(800), BEAM, (0.2, 0.1, 0.5)).values
    np.testing.assert_allclose(parts, whole, atol=1e-12 * np.abs(whole).max())


def test_the_other_side_of_the_middle_sounds_the_same():
    """Mirrored blow and listener."""
    one = st.radiate(record(800), BEAM, (0.2, 0.1, 0.5)).values
    other = st.radiate(record(800, at=0.25 - PLACE), BEAM, (0.05, -0.1, 0.5)).values
    np.testing.assert_allclose(one, other, atol=1e-9 * np.abs(one).max())


@pytest.mark.parametrize("rate", [48e3, 44.1e3, 22.05e3, 8e3])
def test_other_sample_rates_carry_the_same_sound(rate):
    """Below both bandwidths: spectra agree; nothing above half the new rate could be aliased."""
    fine = st.radiate(record(5000), BEAM, (0.2, 0.1, 0.5))
    coarse = st.radiate(record(5000), BEAM, (0.2, 0.1, 0.5), sample_rate=rate)
    bandwidth = coarse.attrs["bandwidth"]
    assert bandwidth == pytest.approx(5.0 / 12.0 * rate)
    frequency = np.arange(100.0, bandwidth, 97.0)
    spectra = [
        np.exp(-2j * pi * frequency[:, None] * sound.time.values) @ sound.values[:, 0] * np.diff(sound.time.values[:2])
        for sound in (fine, coarse)
    ]
    assert error(spectra[1], spectra[0]) < 2e-3


def test_nothing_is_heard_before_it_arrives():
    """The first sound comes from the nearest point; the small pre-ringing of the band limit is cut off."""
    run = record(2000)
    found = st.radiate(run, BEAM, [(PLACE, 0.0, 0.4), (PLACE, 0.0, 1.5)])
    time, values = found.time.values, found.values
    for number, away in enumerate((0.4, 1.5)):
        assert found.attrs["distance"][number] == pytest.approx(away)
        assert not values[time < away / AIR.speed, number].any()
        # Four widths before its peak the blow has 1e-7 of its height.
        early = time < BLOW - 4.0 * WIDTH + away / AIR.speed
        assert np.abs(values[early, number]).max() < 1e-3 * np.abs(values[:, number]).max()
    assert time[0] == 0.0


def spectra_of(response) -> np.ndarray:
    """Transforms of impulse responses up to the bandwidth, shape (frequencies, modes)."""
    share = np.linspace(0.0, bandwidth_of(Fraction(1), 1.0), 60)[:, None]
    return np.exp(-2j * pi * share * (response.first + np.arange(len(response.taps)))) @ response.taps


def test_quadrature_is_fine_enough():
    """With cells of half the size no response moves by 1e-5 of its largest value."""
    sampling = Sampling(1 / RATE, bandwidth_of(Fraction(1), RATE))
    number = 2.0 * pi * bandwidth_of(Fraction(1), RATE) / AIR.speed
    for panel, listener in (
        (panel_of(BEAM), (0.1, 0.05, 0.01)),
        (panel_of(BEAM), (0.1, 0.0, 0.001)),
        (panel_of(PLATE), (0.1, 0.1, 0.02)),
        (panel_of(PLATE), (0.5, 0.3, 0.3)),
    ):
        place = np.array(listener)
        surfaces = [surface_of(panel, place, number, fine) for fine in (1.0, 2.0)]
        found = [spectra_of(baffled_response(one, place, AIR, sampling)) for one in surfaces]
        assert error(*found) < 1e-5
    line, place = line_of(BEAM), np.array([0.1, 0.03, 0.02])
    found = [spectra_of(dipole_response(line, 1e-4, place, AIR, sampling, refinement=fine)) for fine in (1.0, 2.0)]
    assert error(*found) < 1e-5


def test_source_and_listener_are_reciprocal():
    """Reciprocity: exchanging a small source and the listener does not change the sound."""
    sampling, heard = Sampling(1 / RATE, 0.4 * RATE), []
    for source, listener in (((0.1, 0.2), (0.4, -0.1)), ((0.4, -0.1), (0.1, 0.2))):
        element = Surface(np.array([source]), np.array([1e-4]), lambda at: np.ones((len(at), 1)))
        heard.append(baffled_response(element, np.array([*listener, 0.3]), AIR, sampling))
    assert heard[0].first == heard[1].first
    np.testing.assert_allclose(heard[0].taps, heard[1].taps, rtol=1e-12, atol=1e-12)


# Air, section, damping


def test_air_is_that_of_the_standard():
    """IEC 61094-2: 1.186 kg/m³ and 345.87 m/s at 23 degrees, 101 325 Pa, 50 %; Cramer: 343.37 m/s in dry air at 20."""
    air = st.Air(23.0)
    assert air.density == pytest.approx(1.1860, abs=1e-4)
    assert air.speed == pytest.approx(345.87, abs=0.01)
    assert st.Air(20.0, humidity=0.0).speed == pytest.approx(343.37, abs=0.005)
    assert st.Air(0.0, humidity=0.0).speed == pytest.approx(331.45, abs=0.05)


@pytest.mark.parametrize(
    ("ratio", "coefficient"), [(10, 1.14), (5, 1.21), (2, 1.36), (1, 1.51), (0.5, 1.70), (0.2, 1.98), (0.1, 2.23)]
)
def test_added_mass_of_rectangles(ratio, coefficient):
    """DNV-RP-C205, table D-1: over that of the circle of the same width, printed to 2 digits (and 2.23 for 2.22)."""
    section = st.Rectangle(1.0, 1.0 / ratio)
    added = moved_area(section) - section.area
    assert added / (pi / 4.0) == pytest.approx(coefficient, abs=0.011)


def test_the_thinnest_strip_and_the_circle():
    assert moved_area(st.Rectangle(1.0, 1e-6)) == pytest.approx(pi / 4.0, rel=1e-4)
    circle = st.Circle(0.02)
    assert moved_area(circle) == 2.0 * circle.area


def test_damping_by_sound_is_light_and_largest_near_coincidence():
    """Above coincidence the efficiency of a mode nears 1, so ``zeta w = rho c / 2 rho_s h``; below it is small."""
    body = st.ModalPlate(STEEL, 0.01, 0.5, 0.5, bending_modes=(12, 12))
    damping, angular = st.radiation_damping(body), body.modes().angular_frequency
    full = AIR.impedance / (2.0 * STEEL.density * 0.01 * angular)
    critical = AIR.speed**2 * sqrt(body.surface_density / body.rigidity)
    assert damping[angular > 3.0 * critical] == pytest.approx(full[angular > 3.0 * critical], rel=0.3)
    assert (damping[0:1] < full[0:1]).all()
    efficiency = st.radiation_efficiency(body, angular / (2.0 * pi))
    np.testing.assert_allclose(damping, full * efficiency, rtol=1e-12)


# Negative controls of cases


def missed(outcome) -> int:
    return sum(not row.holds for row in outcome.rows)


@pytest.mark.parametrize("speed", [1.001, 0.999])
def test_piston_in_other_air_falls_short(monkeypatch, speed):
    air = radiation.AIR
    wrong = type("Other", (), {"speed": air.speed * speed, "density": air.density, "impedance": air.impedance})()
    right = radiation.baffled_pressure
    monkeypatch.setattr(radiation, "baffled_pressure", lambda *words: right(*words[:4], wrong, words[5]))
    assert missed(radiation.piston())


def test_wallace_close_by_falls_short(monkeypatch):
    monkeypatch.setattr(radiation, "WALLACE", {1.0: radiation.WALLACE[1.0]})
    monkeypatch.setattr(radiation, "AIR", replace(radiation.AIR, temperature=25.0))
    assert missed(radiation.wallace()) == 0, "efficiencies do not depend on the air"
    monkeypatch.setattr(radiation, "FAR", 3.0)
    assert missed(radiation.wallace()) == 1, "three sides away is not far for a quadrupole"


# Refusals and notes


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"listener": (0.1, 0.0, 0.0)}, "in the surface"),
        ({"listener": (0.1, 0.0, -1.0)}, "behind the baffle"),
        ({"listener": (0.1, 0.005, 0.001), "baffled": False}, "from the beam's axis"),
        ({"listener": (0.1, 0.0)}, "listener must be three distances"),
        ({"listener": [(0.1, 0.0, 1.0), (0.1, np.nan, 1.0)]}, r"listener\[1\].y must be finite"),
        ({"listener": "near"}, "listener must be"),
        ({"listener": []}, "listener must be"),
        ({"listener": (0.0, 0.0, 5e3)}, "within 1000 m"),
        ({"sample_rate": 192e3}, "at most the record's 100000 Hz"),
        ({"sample_rate": 100.0}, "at least 1000 Hz"),
        ({"sample_rate": -1.0}, "sample_rate must be above 0"),
        ({"air": 343.0}, "air must be an Air, got 343.0"),
        ({"baffled": 1}, "baffled must be a bool"),
        ({"track": st.ModalBeam(STEEL, st.Circle(0.01), 0.8)}, "must have a Rectangle"),
        ({"track": st.ModalBeam(STEEL, st.Section(1e-4, 1e-9), 0.8), "baffled": False}, "a Rectangle or a Circle"),
        ({"track": PLATE, "baffled": False, "listener": (0.1, 0.05, 1e-4)}, "at least 0.000292 m from the plate"),
        ({"track": st.RigidTrack()}, "must be a ModalBeam or a ModalPlate, got a RigidTrack$"),
        ({"track": replace(BEAM, length=0.08)}, "must include all contact positions"),
        ({"run": record(1)}, "at least 2 samples"),
        ({"run": record(100, ended="energy created")}, "energy created"),
        ({"run": record(100).drop_vars("normal_force")}, "run must be a record with normal_force, got one"),
        ({"run": None}, "run must be a record"),
        ({"run": record(100).assign_coords(time=np.arange(100) ** 2.0)}, "evenly sampled"),
        ({"run": record(100, at=np.nan)}, "contact_position must be finite"),
        ({"run": record(100, height=np.nan)}, "normal_force must be finite"),
    ],
)
def test_bad_arguments_are_refused(words, message):
    given = {"run": record(100), "track": BEAM, "listener": (0.1, 0.0, 1.0)} | words
    with pytest.raises(ValueError, match=message) as caught:
        st.radiate(given.pop("run"), given.pop("track"), given.pop("listener"), **given)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"temperature": 293.15}, "temperature must be from 0 to 30"),
        ({"pressure": 101.325}, "pressure must be from 75000 to 102000"),
        ({"humidity": 50.0}, "humidity must be from 0 to 1"),
    ],
)
def test_air_out_of_range_is_refused(words, message):
    with pytest.raises(ValueError, match=message):
        st.Air(**words)


def test_a_ratio_of_rates_that_would_drift_is_refused():
    assert ratio_of(44.1e3, RATE, 10**7) == Fraction(441, 1000)
    with pytest.raises(ValueError, match="whole numbers up to 4000"):
        ratio_of(12345.678901, RATE, 10**7)


def test_silence_is_reported():
    quiet = st.radiate(record(100, height=0.0), BEAM, (0.1, 0.0, 1.0))
    assert not quiet.values.any()
    assert "never presses" in quiet.attrs["notes"]
    far = st.radiate(record(500), BEAM, [(0.1, 0.0, 1.0), (0.1, 0.0, 100.0)])
    assert "does not arrive" in far.attrs["notes"]
    assert far.values[:, 0].any()
    assert not far.values[:, 1].any()


def test_omissions_are_reported():
    many = replace(BEAM, cutoff=None, bending_modes=20)
    heard = st.radiate(record(500), many, (0.1, 0.0, 0.5))
    assert heard.attrs["modes"] < 20
    assert "left out" in heard.attrs["notes"]
    later = record(500).assign_coords(time=1.0 + np.arange(1, 501) / RATE)
    sound = st.radiate(later, BEAM, (0.1, 0.0, 0.5))
    assert (
        "the record continues another one; vibration left from the earlier record is not included"
        in sound.attrs["notes"]
    )
    assert float(sound.time[0]) == pytest.approx(1.0)


def test_a_run_off_the_track_can_be_heard():
    assert st.radiate(record(500, ended="off the track"), BEAM, (0.1, 0.0, 0.5)).values.any()


def test_the_force_before_and_after_a_record():
    """Zero before, its last value after."""
    force = steady(np.ones((1, 50)), 10)
    assert force.shape == (1, 50 + 2 * LEAD)
    assert force[0, -1] == pytest.approx(1.0)
    assert force[0, 0] == pytest.approx(0.0, abs=0.05)
