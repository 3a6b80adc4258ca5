"""Strings: the force on their supports against statics, d'Alembert and momentum; bowed ones."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import stridula as st

LENGTH, TENSION = 0.33, 60.0
LIGHT = st.Material(1e9, 1000.0)
# Of no stiffness to speak of, as stiff as stretched, and a beam without tension.
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
    """Return a bound of the share of a force at a place that the modes left out of the series bring to a support.

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
    """Ten times the modes leave no more than a tenth of the bound; and the first modes alone are not enough."""
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

    In the middle of each the series of odd sines alternates: what is left out is at most the next term, of
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


def test_support_forces_go_on_in_a_run_that_is_continued():
    probes = [st.SupportForce(IDEAL, end) for end in ENDS]
    system = bowed(IDEAL, 0.05, velocity=0.1)
    words = {"probes": probes, "sample_rate": 5e4}
    whole = st.simulate(system, 4e-3, **words)
    half = st.simulate(system, 2e-3, **words)
    rest = st.simulate(system, 2e-3, start=half, **words)
    assert np.abs(whole.support_force.values).max() > 1e-3
    np.testing.assert_array_equal(whole.support_force.values[100:], rest.support_force.values)
