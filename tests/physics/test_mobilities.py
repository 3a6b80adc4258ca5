"""Mobilities against the direct solution of the matrices, closed forms of infinite beams, and each other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stridula as st
from stridula import plot
from stridula.bodies.beams_and_plates.finite_elements import assemble, element_mass, element_stiffness

from .lattice import lattice

STEEL = st.Material(2.1e11, 7800.0, 0.3)
SECTION = st.Rectangle(0.02, 0.01)
FREQUENCY = np.array([3.0, 40.0, 171.0, 900.0, 2500.0])
RAYLEIGH = st.Rayleigh(30.0, 2e-6)


def matrices(elements: int, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness of a free beam along y, x, y and slope at each node."""
    size = length / elements
    stiffness = element_stiffness(STEEL.young * SECTION.area, STEEL.young * SECTION.second_moment, size)
    mass = element_mass(STEEL.density * SECTION.area, size, "consistent")
    return assemble(mass, 0.0, elements), assemble(stiffness, 0.0, elements)


def solved(mass, stiffness, damping, response, excitation, frequency):
    """Velocity over force from ``K + i w C - w² M`` at each frequency."""
    angular = 2.0 * np.pi * frequency
    answers = [np.linalg.solve(stiffness + 1j * w * damping - w**2 * mass, excitation) for w in angular]
    return 1j * angular * (np.array(answers) @ response)


@pytest.mark.parametrize(("response", "excitation", "direction"), [(0, 0, "x"), (6, 0, "x"), (3, 6, "y")])
def test_the_mobility_of_a_beam_of_elements_is_that_of_its_matrices(response, excitation, direction):
    elements, length = 6, 0.3
    beam = st.FiniteElementBeam(STEEL, SECTION, length, elements=elements, damping=RAYLEIGH, root_support="free")
    mass, stiffness = matrices(elements, length)
    places = np.linspace(0.0, length, elements + 1)
    rows = np.eye(len(mass))[[3 * node + "xy".index(direction) for node in (response, excitation)]]
    known = solved(mass, stiffness, 30.0 * mass + 2e-6 * stiffness, *rows, FREQUENCY)
    points = [beam.at(float(places[node])) for node in (response, excitation)]
    found = st.mobility(*points, direction=direction, frequency=FREQUENCY)
    np.testing.assert_allclose(found.values, known, rtol=1e-7)
    other_way = st.mobility(*reversed(points), direction=direction, frequency=FREQUENCY)
    np.testing.assert_allclose(other_way.values, found.values, rtol=1e-10, err_msg="not reciprocal")
    without = st.mobility(*points, direction=direction, frequency=[171.0], excitation_direction=direction)
    assert without.values[0] == pytest.approx(known[2], rel=1e-7)


def test_damping_that_couples_modes_is_that_of_the_matrix():
    mass, stiffness = matrices(3, 0.3)
    damping = 1e-6 * stiffness
    # A dashpot at the first node alone.
    damping[0, 0] += 5.0
    body = st.ReducedBody(mass, stiffness, {"tip": (0, 1), "end": (9, 10)}, damping=damping)
    assert body.modes().damping_matrix is not None
    rows = np.eye(len(mass))
    known = solved(mass, stiffness, damping, rows[9], rows[0], FREQUENCY)
    found = st.mobility(body.at("end"), body.at("tip"), direction="x", frequency=FREQUENCY)
    np.testing.assert_allclose(found.values, known, rtol=1e-6)


def test_modes_left_out_yield_statically():
    """Residual shapes leave an error of the square of the frequency over that of the first mode left out."""
    whole, cut = lattice(None), lattice(1500.0)
    plain = lattice(1500.0, residual_flexibility=False)
    natural = whole.modes().frequency
    low, beyond = np.array([200.0, 400.0]), natural[natural > 1500.0].min()
    known, found, bare = (st.mobility(one.at("foot"), frequency=low).values for one in (whole, cut, plain))
    beyond_it = natural > 1500.0
    left_out = (whole.trace("foot")[1] ** 2)[beyond_it] @ (1.0 / whole.modes().stiffness[beyond_it])
    angular = 2.0 * np.pi * low
    # At most the response of all modes left out with the frequency of the lowest of them, undamped.
    most = angular * left_out * ((low / beyond) ** 2 / (1.0 - (low / beyond) ** 2))
    assert (np.abs(found - known) <= 1.05 * most + 1e-9 * np.abs(known)).all()
    np.testing.assert_allclose(np.abs(bare - known), angular * left_out, rtol=0.2)


def endless(beam: st.ModalBeam, frequency: np.ndarray, zeta: float) -> np.ndarray:
    """Driving-point mobility of an infinite beam whose waves have the damping ratio of its modes.

    ``i w / m' 2 pi`` times the integral of ``1 / (W² + 2 i zeta w W - w²)`` over wavenumbers k, ``W = c k²``: by
    partial fractions in W, ``int dk / (k² - a²) = pi i / a``. Without damping it is ``(1 - i) / 4 m' c_B`` (Cremer).
    """
    angular, line = 2.0 * np.pi * frequency, beam.material.density * beam.section.area
    rate = np.sqrt(beam.material.young * beam.section.second_moment / line)
    first, second = (angular * (sign * np.sqrt(1.0 - zeta**2) - 1j * zeta) for sign in (1.0, -1.0))
    roots = []
    for one in (first, second):
        wavenumber = np.sqrt(one / rate + 0.0j)
        wavenumber = np.where(wavenumber.imag > 0.0, wavenumber, -wavenumber)
        roots.append(1j * np.pi / wavenumber / rate)
    return 1j * angular / (2.0 * np.pi * line) * (roots[0] - roots[1]) / (first - second)


def test_a_long_damped_beam_is_an_infinite_one():
    zeta, frequency = 0.1, np.array([400.0, 900.0, 1600.0])
    beam = st.ModalBeam(STEEL, SECTION, 30.0, bending_modes=8000, axial_modes=0, damping=zeta)
    found = st.mobility(beam.centre, frequency=frequency).values
    np.testing.assert_allclose(found, endless(beam, frequency, zeta), rtol=2e-4)
    line = STEEL.density * SECTION.area
    wave = (STEEL.young * SECTION.second_moment * (2.0 * np.pi * frequency) ** 2 / line) ** 0.25
    undamped = (1.0 - 1j) / (4.0 * line * wave)
    np.testing.assert_allclose(endless(beam, frequency, 1e-9), undamped, rtol=1e-8)
    assert (np.abs(found / undamped - 1.0) > 0.02).all(), "damping is seen"


def test_springs_of_a_system_hold_the_points():
    first, second = st.PointMass(2.0, name="first"), st.PointMass(0.5, name="second")
    spring = st.Spring(first.centre, second.centre, stiffness=8e4, direction="y")
    damper = st.Dashpot(second.centre, coefficient=3.0, direction="y")
    system = st.System(st.PointContact(first.centre, st.RigidTrack(), gap=1.0), connections=[spring, damper])
    mass, stiffness = np.diag([2.0, 0.5]), 8e4 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    known = solved(mass, stiffness, np.diag([0.0, 3.0]), *np.eye(2), FREQUENCY)
    found = st.mobility(first.centre, second.centre, frequency=FREQUENCY, system=system)
    np.testing.assert_allclose(found.values, known, rtol=1e-9)
    assert found.attrs["response"] == "first centre y"
    with pytest.raises(ValueError, match="excitation must be on the body of the response"):
        st.mobility(first.centre, second.centre, frequency=FREQUENCY)


def test_turning_modes_split_and_standing_ones_do_not():
    """In a fixed frame, a pair of waves of a turning disc has two peaks, split by its drag times the speed."""
    profile = st.RectangleProfile({"disc": ((0.05, 0.15), (0.0, 0.01))})
    standing = st.AxisymmetricBody(profile, STEEL, 1500.0, "inner", axis=(0.0, 1.0, 0.0), damping=1e-4, turning=0.0)
    turned = replace(standing, turning=20.0)
    point = (0.15, 0.0, 0.01)
    modes = turned.modes()
    pair = int(np.argmax(np.array(modes.turning.order) == 2))
    middle = modes.frequency[modes.turning.pairs[pair][0]]
    apart = abs(modes.turning.drag[pair]) * 20.0 / (2.0 * np.pi)
    near = np.linspace(middle - 2.0 * apart, middle + 2.0 * apart, 4001)
    still, moving = (np.abs(st.mobility(one.at(point), frequency=near).values) for one in (standing, turned))
    assert near[still.argmax()] == pytest.approx(middle, abs=0.5)
    halves = [near[:2000][moving[:2000].argmax()], near[2000:][moving[2000:].argmax()]]
    np.testing.assert_allclose(halves, [middle - apart, middle + apart], atol=0.05 * apart)


def test_frequencies_left_out_show_every_peak():
    beam = st.ModalBeam(STEEL, SECTION, 0.8, bending_modes=8, axial_modes=0, damping=1e-3)
    found = st.mobility(beam.at(0.113))
    values = np.abs(found.values)
    for frequency in beam.modes().frequency:
        near = np.abs(found["frequency"].values / frequency - 1.0) < 0.01
        dense = np.abs(st.mobility(beam.at(0.113), frequency=frequency * np.linspace(0.99, 1.01, 2001)).values)
        assert values[near].max() == pytest.approx(dense.max(), rel=0.01)
    bare = replace(beam, damping=0.0)
    assert np.isfinite(st.mobility(bare.centre).values).all()
    assert np.isinf(st.mobility(bare.centre, frequency=bare.modes().frequency[:1]).values).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"frequency": [0.0, 1.0]}, "frequency must be finite and above 0 Hz, got 0.0"),
        ({"frequency": "low"}, "frequency must be numbers, got 'low'"),
        ({"frequency": []}, "frequency must be a list of numbers"),
        ({"direction": "sideways"}, "direction must be one of"),
        ({"excitation_direction": "z"}, "excitation_direction must not be z"),
        ({"excitation": 0.1}, "excitation must be a BodyPoint"),
    ],
)
def test_bad_arguments_are_refused(arguments, message):
    beam = st.ModalBeam(STEEL, SECTION, 0.8, bending_modes=3)
    with pytest.raises(ValueError, match=message):
        st.mobility(beam.centre, **arguments)


def test_rigid_bodies_need_frequencies():
    mass = st.PointMass(2.0)
    found = st.mobility(mass.centre, frequency=[10.0])
    assert found.values[0] == pytest.approx(1.0 / (2j * np.pi * 10.0 * 2.0))
    with pytest.raises(ValueError, match="frequency must be given for bodies that are rigid"):
        st.mobility(mass.centre)


def test_mobilities_are_drawn_with_magnitude_and_phase():
    beam = st.ModalBeam(STEEL, SECTION, 0.8, bending_modes=3, damping=0.01)
    driving, transfer = st.mobility(beam.centre), st.mobility(beam.at(0.1), beam.centre)
    figure = plot.mobility({"driving": driving, "transfer": transfer}, title="beam")
    above, below = figure.axes
    assert above.get_xscale() == above.get_yscale() == below.get_xscale() == "log"
    np.testing.assert_allclose(above.get_lines()[1].get_ydata(), np.abs(transfer.values))
    np.testing.assert_allclose(below.get_lines()[0].get_ydata(), np.degrees(np.angle(driving.values)))
    assert [text.get_text() for text in above.get_legend().get_texts()] == ["driving", "transfer"]
    assert "[m/(N s)]" in above.get_ylabel()
    assert plot.mobility(driving).axes[0].get_legend() is None
    for wrong in (driving.real, driving.isel(frequency=[0]), {}, 3.0, {"one": 1.0}):
        with pytest.raises(ValueError, match="found"):
            plot.mobility(wrong)
