"""Strings: the force on their supports against statics, d'Alembert and momentum; bowed ones."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import stridula as st
from stridula import analysis

LENGTH, TENSION = 0.33, 60.0
LIGHT = st.Material(1e9, 1000.0)
# With negligible stiffness, as stiff as stretched, and a beam without tension.
IDEAL = st.ModalBeam(LIGHT, st.Section(1e-6, 1e-22), LENGTH, bending_modes=200, axial_modes=1, tension=TENSION)
STIFF = st.ModalBeam(LIGHT, st.Section(1e-6, 1e-9), LENGTH, bending_modes=200, axial_modes=1, tension=TENSION)
BEAM = st.ModalBeam(LIGHT, st.Section(1e-6, 1e-9), LENGTH, bending_modes=200, axial_modes=1)
ENDS = ("left", "right")


def bowed(string: st.ModalBeam, place: float, force: float = 0.5, drives=(), connections=(), **track) -> st.System:
    """Return a string pressed along x on a rigid bow that moves along y."""
    point = string.at(place)
    bow = st.RigidTrack(**{"velocity": 1.0} | track)
    contact = st.PointContact(point, bow, friction=st.Coulomb(0.4), inclination=np.pi / 2)
    return st.System(contact, [st.Force(point, x=force), *drives], connections)


def tail(string: st.ModalBeam, place: float) -> float:
    """Return a bound of the fraction of a force at a place that the modes left out carry to a support.

    Abel's: ``(2 / pi) sum of sin(k t) / k`` over k > n is at most ``2 / (pi (n + 1) sin(t / 2))``.
    """
    return 2.0 / (np.pi * (string.harmonics[0] + 1) * np.sin(np.pi * place / string.length / 2.0))


@pytest.mark.parametrize("string", [IDEAL, STIFF, BEAM], ids=["ideal", "stiff", "beam"])
def test_rows_are_slope_and_third_derivative_of_the_modes(string):
    numbers = np.arange(1, 201) * np.pi / LENGTH
    rigidity = LIGHT.young * string.section.second_moment
    # T w' - EI w''' of A sin(k x) at 0, and at L, where the cosine is (-1)^k, the opposite.
    left = string.amplitude * (string.tension * numbers + rigidity * numbers**3)
    np.testing.assert_allclose(string.support_force("left")[:200], left, rtol=1e-12)
    np.testing.assert_allclose(string.support_force("right")[:200], -left * np.cos(numbers * LENGTH), rtol=1e-12)
    assert not any(string.support_force(end)[200:].any() for end in ENDS)


@pytest.mark.parametrize("string", [IDEAL, STIFF, BEAM], ids=["ideal", "stiff", "beam"])
@pytest.mark.parametrize("place", [0.04, 0.165, 0.25])
def test_supports_share_a_constant_force_by_the_lever(string, place):
    """A bow that slides steadily pulls by mu N towards +y: the supports get that times 1 - a/L and a/L, towards +y."""
    system = bowed(string, place, drives=[st.InitialEquilibrium()])
    run = st.simulate(system, 1e-3, probes=[st.SupportForce(string, end) for end in ENDS])
    pull = 0.4 * 0.5
    for number, away in enumerate((place, LENGTH - place)):
        found = run.support_force.values[:, number]
        np.testing.assert_allclose(found, pull * (1 - away / LENGTH), atol=pull * tail(string, away))
        assert np.ptp(found) < 1e-9
    assert run.support_force.attrs["units"] == "N"
    assert list(run.support_force_probe.values) == ["slider left end", "slider right end"]


def test_the_series_converges_as_its_bound_says():
    """Ten times the modes reduce the error to a tenth of the bound; the first modes alone are not enough."""
    place, errors = 0.1, []
    for count in (20, 200, 2000):
        string = st.ModalBeam(LIGHT, IDEAL.section, LENGTH, bending_modes=count, axial_modes=1, tension=TENSION)
        static = string.trace(place)[1] / string.modes().angular_frequency ** 2
        errors.append(abs(string.support_force("left") @ static - (1 - place / LENGTH)))
        assert errors[-1] < tail(string, place)
    assert all(later < former for former, later in pairwise(errors))


def test_a_string_on_a_spring_balances_about_its_end():
    """Coupled modes: moments about the right end, of the pull at a, the spring at b and the left support."""
    place, held, stiffness = 0.1, 0.2, 500.0
    spring = st.Spring(IDEAL.at(held), stiffness=stiffness, direction="y")
    system = bowed(IDEAL, place, drives=[st.InitialEquilibrium()], connections=[spring])
    probes = [st.SupportForce(IDEAL), st.Displacement(IDEAL.at(held), "y")]
    run = st.simulate(system, 1e-4, probes=probes)
    pull, back = 0.4 * 0.5, stiffness * float(run.displacement.values[0, 0])
    known = pull * (1 - place / LENGTH) - back * (1 - held / LENGTH)
    assert back > 0.1 * pull
    allowed = pull * tail(IDEAL, place) + back * tail(IDEAL, held)
    assert float(run.support_force.values[0, 0]) == pytest.approx(known, abs=allowed)


def test_a_thrown_string_pulls_its_supports_by_a_square_wave():
    """Thrown down at V: ``T w'(0)`` is -Z V up to L/c and +Z V up to 2 L/c (d'Alembert), with ``Z = sqrt(T rho S)``.

    In the middle of each the series of odd sines alternates: the remainder is at most the next term, of
    ``4 / (pi (n + 1))``. The exact scheme moves free modes exactly, and the stiffness of 3e-9 not at all.
    """
    line = LIGHT.density * 1e-6
    impedance, period = np.sqrt(TENSION * line), 2 * LENGTH / np.sqrt(TENSION / line)
    throw = st.InitialVelocity(IDEAL, y=-2.0)
    system = bowed(IDEAL, 0.1, force=-1e-9, drives=[throw])
    step = period / 1000
    run = st.simulate(
        system, period, step=step, sample_rate=1 / step, probes=[st.SupportForce(IDEAL, end) for end in ENDS]
    )
    force = run.support_force.values / (2.0 * impedance)
    allowed = 4 / (np.pi * 201)
    np.testing.assert_allclose(force[[249, 749]], [[-1, -1], [1, 1]], atol=allowed + 1e-6)


def test_support_forces_continue_in_a_continued_run():
    probes = [st.SupportForce(IDEAL, end) for end in ENDS]
    system = bowed(IDEAL, 0.05, velocity=0.1)
    words = {"probes": probes, "sample_rate": 5e4}
    whole = st.simulate(system, 4e-3, **words)
    half = st.simulate(system, 2e-3, **words)
    rest = st.simulate(system, 2e-3, start=half, **words)
    assert np.abs(whole.support_force.values).max() > 1e-3
    np.testing.assert_array_equal(whole.support_force.values[100:], rest.support_force.values)


# The violin.


@pytest.fixture(scope="module")
def violin():
    """The shipped scenario, at its own step, and its record."""
    case = st.load_scenario("violin")
    return case, case.simulate()


def test_the_string_of_the_violin_is_a_g_string(violin):
    case, _ = violin
    string = case.system.contacts[0].track.body
    # G3, in equal temperament from an A of 440 Hz.
    assert string.modes().frequency[0] == pytest.approx(440.0 * 2.0 ** (-14.0 / 12.0), rel=1e-3)
    ratios = string.modes().damping_rate / (2.0 * string.modes().angular_frequency)
    assert 1.0 / (2.0 * ratios[0]) == pytest.approx(500.0, rel=0.05)
    places = np.array([contact.track.position for contact in case.system.contacts])
    assert places.mean() / string.length == pytest.approx(0.12)
    assert np.ptp(places) * 5.0 / 4.0 == pytest.approx(8e-3)


def test_the_violin_settles_in_helmholtz_motion(violin):
    """One slip in each period of the string, for some more than beta of it.

    Under a bow of finite width the string slips for beta, and while the corner passes from its one edge to the other:
    at most its width, 8 mm of 325, more. The velocity of the slips of an ideal string is ``-(1 - beta) / beta`` of the
    bow's; under this bow it is 2.5 % less, at this step as at a quarter of it.
    """
    _, run = violin
    assert int(run.unsolved_steps.sum()) == 0
    found = analysis.bowed_motion(run, 196.0)
    assert found.motion == "Helmholtz"
    # One slip more or fewer at the end.
    assert found.slips_per_period == pytest.approx(1.0, abs=1.0 / 98.0)
    # Flat by no more than a tenth of a semitone, as the bow delays the corner a little.
    assert 0.994 * 196.0 < found.frequency < 196.0
    assert 0.12 < found.slip_share < 0.12 + 8.0 / 325.0
    late = run.sel(time=slice(0.5, None))
    share = late.status_share.sel(contact="hair 3")
    slips, sticks = (share.sel(contact_status=word).values > 0.99 for word in ("sliding", "sticking"))
    velocity = late.velocity.values[:, 0]
    assert np.median(velocity[slips]) == pytest.approx(-0.2 * 0.88 / 0.12, rel=0.03)
    assert np.median(velocity[sticks]) == pytest.approx(0.2, rel=0.02)
    regime = st.regime(run, start=0.5)
    assert regime.regime == "stick-slip"
    assert regime.frequency == pytest.approx(float(found.frequency), rel=1e-3)
    assert regime.periodicity > 0.999


def test_the_bridge_of_the_violin_feels_a_sawtooth_of_its_height(violin):
    """In Helmholtz motion the force on the bridge rises by ``2 Z v / beta`` in a period (Schelleng 1973)."""
    case, run = violin
    string = case.system.contacts[0].track.body
    impedance = np.sqrt(string.tension * string.total_mass / string.length)
    force = run.sel(time=slice(0.5, None)).support_force.values[:, 0]
    # Waves between bridge and bow ripple on it: a mean over their period.
    smooth = np.convolve(force, np.full(29, 1.0 / 29.0), "valid")
    assert np.ptp(smooth) == pytest.approx(2.0 * impedance * 0.2 / 0.12, rel=0.15)


def test_a_light_bow_lets_the_string_slip_more_than_once():
    lighter = {f"drives.{number}.x": 0.1 for number in range(5)}
    run = st.load_scenario("violin", lighter).simulate(duration=0.6)
    assert analysis.bowed_motion(run, 196.0).slips_per_period > 1.5


def test_regime_and_motion_do_not_depend_on_the_step(violin):
    case, run = violin
    finer = st.simulate(case.system, 0.6, step=5e-7, sample_rate=48e3, probes=[])
    found, expected = analysis.bowed_motion(finer, 196.0), analysis.bowed_motion(run, 196.0)
    assert found.motion == expected.motion
    assert found.frequency == pytest.approx(float(expected.frequency), rel=1e-3)
    # The last strip lets go a little sooner or later.
    assert found.slip_share == pytest.approx(float(expected.slip_share), abs=2.0 / 325.0)
