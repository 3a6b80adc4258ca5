"""Natural frequencies against closed forms, and the observed order of the finite elements.

Orders. Hermite cubics give eigenvalues to order 2 (4 - 2) = 4, linear bars with consistent mass
``w² = (c k)² (1 + (k h)²/12)`` and lumped ``(1 - (k h)²/12)``: order 2.
"""

from __future__ import annotations

from math import radians

import numpy as np
import pytest

import stridula as st
from stridula.verification.systems.beams import SQUARE, STEEL, SUPPORTS, beam_of, bending, families, stretching


@pytest.mark.parametrize("supports", SUPPORTS)
def test_closed_forms_and_rigid_motions(supports):
    """24 elements: bending within (x/24)^4/720 of the eigenvalue, x <= 11 for three modes; bar (n pi/24)²/24
    and its next term, 3 % of that."""
    known = SUPPORTS[supports]
    body = beam_of(supports, elements=24)
    bent, rod = families(body)
    np.testing.assert_allclose(bent[:3], bending(known.roots[:3], 0.3), rtol=(11 / 24) ** 4 / 720)
    np.testing.assert_allclose(rod[:3], stretching(known.multiples[:3], 0.3), rtol=(3 * np.pi / 24) ** 2 / 23)
    assert np.all(rod[:3] > stretching(known.multiples[:3], 0.3)), "consistent mass: from above"
    assert np.sum(body.modes().frequency == 0.0) == known.rigid


@pytest.mark.parametrize(
    ("supports", "length", "expected"),
    [
        ("simply supported", 0.3, [261.43, 1045.70, 2352.84]),
        ("guided-free", 0.15, [592.62, 3202.49, 7908.14]),
    ],
)
def test_printed_numbers(supports, length, expected):
    """Steel, 10 x 10 mm; printed to 0.005 Hz."""
    np.testing.assert_allclose(families(beam_of(supports, elements=60, length=length))[0][:3], expected, atol=0.0051)


def test_printed_roots():
    np.testing.assert_allclose(SUPPORTS["guided-free"].roots, [2.3650204, 5.4978039, 8.6393798, 11.7809725], atol=5e-8)


@pytest.mark.parametrize("supports", SUPPORTS)
@pytest.mark.parametrize("length", [0.3, 1.0, 7.0])
def test_modes_are_normalised_and_rigid_ones_carry_the_mass(supports, length):
    """``Phi^T M Phi = 1`` shows as: the sum over all modes of (Phi^T M 1)² is the mass that the supports let move.

    With a free or guided beam that is all of it. For a rigid motion the strain is nought: the trace at any point is
    linear in s.
    """
    body = beam_of(supports, elements=5, length=length, angle=0.4)
    modes = body.modes()
    moving = np.sum(modes.translation**2, axis=1)
    if SUPPORTS[supports].rigid >= 2:
        np.testing.assert_allclose(moving, body.total_mass, rtol=1e-12)
    else:
        assert np.all(moving < body.total_mass)
    rigid = modes.frequency == 0
    ends, middle = (body.trace(0.0) + body.trace(length)) / 2, body.trace(length / 2)
    np.testing.assert_allclose(ends[:, rigid], middle[:, rigid], atol=1e-11 * np.abs(middle).max())
    # Kinetic energy of a rigid motion from its traces: Simpson's rule is exact for the square of a line.
    square = sum(
        weight * np.sum(body.trace(s) ** 2, axis=0)
        for s, weight in ((0.0, 1 / 6), (length / 2, 4 / 6), (length, 1 / 6))
    )
    np.testing.assert_allclose(square[rigid] * body.total_mass, 1.0, rtol=1e-10)


@pytest.mark.parametrize("supports", SUPPORTS)
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_angle_does_not_change_frequencies(supports, mass):
    """Round-off of the eigenvalues is eps times the largest: relative to the lowest, 2e-16 (8^4) 1e2 = 1e-10."""
    level = beam_of(supports, elements=8, mass=mass).modes().frequency
    for degrees in (-80, -45, 10, 30, 60, 89):
        turned = beam_of(supports, elements=8, mass=mass, angle=radians(degrees)).modes().frequency
        np.testing.assert_allclose(turned, level, rtol=1e-9)


def test_held_root_is_clamped_across_when_upright_and_along_when_flat():
    """With x held at a guided root, an upright beam bends as clamped-free and is free along; both are the extremes."""
    body = beam_of("guided-free", elements=24)
    frequency = body.modes(held_x=True).frequency
    assert np.sum(frequency == 0) == 1
    np.testing.assert_allclose(frequency[1:4], bending(SUPPORTS["clamped-free"].roots[:3], 0.3), rtol=(11 / 24) ** 4)
    flat = beam_of("guided-free", elements=24, angle=radians(89.999999)).modes(held_x=True).frequency
    np.testing.assert_allclose(flat[1:3], bending(SUPPORTS["guided-free"].roots[:2], 0.3), rtol=1e-4)


def observed_order(frequency_of, exact, counts):
    """Order of the eigenvalue w² from the last two refinements by two."""
    errors = [abs((frequency_of(n) / exact) ** 2 - 1) for n in counts]
    return np.log2(errors[-2] / errors[-1])


@pytest.mark.parametrize("supports", SUPPORTS)
@pytest.mark.parametrize("mode", [1, 2])
def test_order_of_hermite_bending_is_four(supports, mode):
    exact = bending(SUPPORTS[supports].roots[mode], 0.3)
    order = observed_order(lambda n: families(beam_of(supports, elements=n))[0][mode], exact, (16, 32))
    assert order == pytest.approx(4.0, abs=0.1)


@pytest.mark.parametrize("supports", SUPPORTS)
@pytest.mark.parametrize("mass", ["consistent", "lumped"])
def test_order_of_linear_bar_is_two(supports, mass):
    exact = stretching(SUPPORTS[supports].multiples[1], 0.3)
    order = observed_order(lambda n: families(beam_of(supports, elements=n, mass=mass))[1][1], exact, (12, 24))
    assert order == pytest.approx(2.0, abs=0.1)


def test_order_of_lumped_bending_is_two():
    """A lumped mass is accurate to second order only, for any shape functions."""
    exact = bending(2 * np.pi, 0.3)
    words = {"supports": "simply supported", "mass": "lumped"}
    order = observed_order(lambda n: families(beam_of(elements=n, **words))[0][1], exact, (16, 32))
    assert order == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize(("mass", "sign"), [("consistent", 1.0), ("lumped", -1.0)])
def test_dispersion_of_the_bar_is_exact(mass, sign):
    """On a uniform mesh, held at both ends: consistent ``w² = 6 (c/h)² (1 - cos kh)/(2 + cos kh)``, lumped
    ``w² = 2 (c/h)² (1 - cos kh)``, with kh = n pi / elements: for every mode, to round-off."""
    count = 12
    kh = np.arange(1, count) * np.pi / count
    c_over_h = np.sqrt(STEEL.young / STEEL.density) * count / 0.3
    shape = 6 * (1 - np.cos(kh)) / (2 + np.cos(kh)) if mass == "consistent" else 2 * (1 - np.cos(kh))
    rod = families(beam_of("simply supported", elements=count, mass=mass))[1]
    np.testing.assert_allclose(rod, c_over_h * np.sqrt(shape) / 2 / np.pi, rtol=1e-9)
    assert np.all(sign * (rod - stretching(np.arange(1, count), 0.3)) > 0)


def test_cutoff_keeps_exactly_the_lower_modes():
    whole, cut = beam_of("guided-free", elements=8), beam_of("guided-free", elements=8, cutoff=5e3)
    kept = whole.modes().frequency <= 5e3
    np.testing.assert_array_equal(cut.modes().frequency, whole.modes().frequency[kept])
    np.testing.assert_array_equal(cut.trace(0.1), whole.trace(0.1)[:, kept])


def test_modal_beam_has_the_closed_forms():
    """Simply supported in bending, clamped in traction, modal mass rho S L / 2 at amplitude 1."""
    bar = st.ModalBeam(STEEL, SQUARE, 0.3, bending_modes=3, axial_modes=2)
    frequency = bar.modes().frequency
    np.testing.assert_allclose(frequency[:3], [261.43, 1045.70, 2352.84], atol=0.0051)
    np.testing.assert_allclose(frequency[3:], stretching(np.array([1, 2]), 0.3), rtol=1e-14)
    mass = STEEL.density * SQUARE.area * 0.3
    np.testing.assert_allclose(bar.trace(0.15)[1, 0] ** 2, 2 / mass, rtol=1e-14)
    # All the mass moves with the sum of all modes: 8/pi² sum of 1/k² over odd k; 200 modes leave 2/(pi² 100) x 2.
    many = st.ModalBeam(STEEL, SQUARE, 0.3, bending_modes=200, axial_modes=200)
    carried = np.sum(many.modes().translation ** 2, axis=1) / mass
    np.testing.assert_allclose(carried, 1 - 4 / (np.pi**2 * 200), atol=1e-5)


def test_a_string_has_the_closed_form_of_fletcher():
    """``f_k = k f sqrt(1 + B k²)`` with ``f = sqrt(T / rho S) / 2L`` and ``B = pi² EI / T L²`` (Fletcher 1964)."""
    tension, numbers = 700.0, np.arange(1, 41)
    wire = st.Circle(0.001)
    string = st.ModalBeam(STEEL, wire, 0.65, bending_modes=40, axial_modes=2, tension=tension)
    ideal = np.sqrt(tension / (STEEL.density * wire.area)) / (2 * 0.65)
    stiffness = np.pi**2 * STEEL.young * wire.second_moment / (tension * 0.65**2)
    frequency = string.modes().frequency
    np.testing.assert_allclose(frequency[:40], numbers * ideal * np.sqrt(1 + stiffness * numbers**2), rtol=1e-13)
    np.testing.assert_allclose(frequency[40:], stretching(np.array([1, 2]), 0.65), rtol=1e-14)


def test_no_tension_is_no_tension_to_the_last_bit():
    """The frequencies are ``(k pi/L)² sqrt(EI / rho S)`` exactly, and a cutoff keeps the same modes."""
    rigidity, line = STEEL.young * SQUARE.second_moment, STEEL.density * SQUARE.area
    numbers = np.arange(1, 51)
    known = (numbers * np.pi / 0.3) ** 2 * np.sqrt(rigidity / line)
    bar = st.ModalBeam(STEEL, SQUARE, 0.3, bending_modes=50, axial_modes=0, tension=0.0)
    np.testing.assert_array_equal(bar.modes().angular_frequency, known)
    for cutoff in np.geomspace(300.0, 1e6, 200):
        counted = st.ModalBeam(STEEL, SQUARE, 0.3, cutoff=float(cutoff)).harmonics[0]
        assert counted == int(np.sqrt(2 * np.pi * cutoff * (1 + 1e-12) / known[0]))


def test_a_string_gives_way_as_its_statics_say():
    """A stretched wire under a force at a point is two straight lines: compliance ``a (L - a) / T L``.

    Stiffness has a share of the order of ``sqrt(EI / T) / L``, 1e-4 of it here; the tail of 4000 modes is at most
    ``2 L / (pi² T 4000)``, 2.5e-4 of it.
    """
    wire, tension, a = st.Section(1e-6, 1e-17), 700.0, 0.2
    string = st.ModalBeam(STEEL, wire, 0.65, bending_modes=4000, axial_modes=0, tension=tension)
    row, modes = string.trace(a)[1], string.modes()
    found = float(np.sum((row / modes.angular_frequency) ** 2))
    known = a * (0.65 - a) / (tension * 0.65)
    tail = 2 * 0.65 / (np.pi**2 * tension * 4000)
    assert -tail - np.sqrt(STEEL.young * wire.second_moment / tension) / tension < found - known < 0.0


def test_modal_beam_is_the_limit_of_finite_elements():
    """A pinned beam of 24 elements against the modal one: frequencies, and the static compliance at a point."""
    bar = st.ModalBeam(STEEL, SQUARE, 0.3, bending_modes=60, axial_modes=60)
    body = beam_of("simply supported", elements=24)
    np.testing.assert_allclose(families(body)[0][:3], bar.modes().frequency[:3], rtol=1e-4)

    def compliance(matrix, modes):
        return matrix @ np.diag(1 / modes.angular_frequency**2) @ matrix.T

    # The upright finite-element beam bends along world x.
    modal, elements = compliance(bar.trace(0.1), bar.modes()), compliance(body.trace(0.1), body.modes())[::-1, ::-1]
    left, right = 0.1, 0.2
    bending = left**2 * right**2 / (3 * STEEL.young * SQUARE.second_moment * 0.3)
    rod = left * right / (STEEL.young * SQUARE.area * 0.3)
    # At a node of the mesh finite elements are exact; 60 modes leave a tail of 2/(pi² 60) / (2/9) of the bar's
    # compliance at most, and the square of the small ratio 1/60 less of the beam's.
    np.testing.assert_allclose(np.diag(elements), [rod, bending], rtol=1e-9)
    assert modal[1, 1] == pytest.approx(bending, rel=1e-5)
    assert rod * (1 - 9 / (np.pi**2 * 60)) < modal[0, 0] < rod


@pytest.mark.parametrize("wrong", ["clamped-clamped", "guided-pinned", "pinned-free"])
def test_harness_rejects_wrong_supports(wrong):
    """Negative control: each other support misses the closed form of the simply supported beam."""
    exact = bending(SUPPORTS["simply supported"].roots[:3], 0.3)
    assert not np.allclose(families(beam_of(wrong, elements=24))[0][:3], exact, rtol=1e-2)


def test_harness_rejects_lumped_mass_as_fourth_order():
    """Negative control: a lumped mass in bending has lost the fourth order."""
    exact = bending(2 * np.pi, 0.3)
    order = observed_order(
        lambda n: families(beam_of("simply supported", elements=n, mass="lumped"))[0][1], exact, (8, 16)
    )
    assert abs(order - 4.0) > 0.1
