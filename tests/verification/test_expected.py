"""Expected values of the cases, derived in the code, against published numbers."""

from __future__ import annotations

from math import atan, gamma, pi, radians

import numpy as np
import pytest

import stridula as st
from stridula.verification import (
    clockwork,
    jams,
    laws,
    linings,
    partial_slip,
    shaken,
    sliders,
    sounding_spheres,
    stability,
    strings,
)
from stridula.verification.systems import bars, beams, mode_coupling, on_belts


def test_sdnd100():
    points, time = on_belts.turning_points(0.85e-3, 0.0, 100.0, 1e-4)
    assert points == pytest.approx([-0.65e-3, 0.45e-3, -0.25e-3, 0.05e-3], abs=1e-12)
    assert time == pytest.approx(0.125664, abs=5e-7)
    assert time == pytest.approx(4 * pi / 100)


def test_relay():
    points, time = on_belts.turning_points(12.0, 6.0, 1.0, 1.0)
    printed = [13.317821, -11.317821, 9.317821, -7.317821, 5.317821, -3.317821, 1.317821, 0.682179]
    assert points == pytest.approx(printed, abs=5e-7)
    assert time == pytest.approx(22.423556, abs=5e-7)
    assert time == pytest.approx(atan(6 / 13) + 7 * pi)


def test_belt():
    known = on_belts.stick_slip(sliders.BELT)
    assert known.slip == pytest.approx(2.158799, abs=5e-7)
    assert known.stick == pytest.approx(1.5)
    assert known.slip + known.stick == pytest.approx(3.658799, abs=5e-7)
    assert (known.lowest, known.highest) == pytest.approx((0.174306, 1.075694), abs=5e-7)
    assert known.slowest == pytest.approx(-0.901388, abs=5e-7)


@pytest.mark.parametrize("belt", [clockwork.SLOWER, clockwork.FASTER])
def test_stick_slip_from_stop_to_start_is_that_of_the_closed_form(belt):
    law = clockwork.LAWS["static and kinetic"]
    known = on_belts.stick_slip(clockwork.slider(law, belt))
    found = clockwork.cycle(law, belt)
    assert found == pytest.approx((known.slip + known.stick, known.lowest, known.highest), rel=1e-9)


def test_a_lining_flutters_as_hoffmanns_contact():
    lined, model = linings.Lined(1e3, 0.9), mode_coupling.hoffmann()
    assert lined.exponents() / lined.rate == pytest.approx(model.exponents(0.9), rel=1e-9)


def test_the_time_of_an_impact():
    """Printed as 2.94 depth / speed (Love 1927, section 140; Johnson 1985, section 11.4)."""
    exact = 0.8 * pi**0.5 * gamma(0.4) / gamma(0.9)
    assert pytest.approx(exact, abs=5e-7) == linings.LASTS
    assert round(exact, 2) == 2.94


@pytest.mark.parametrize("surface", [shaken.plate(), shaken.beam()], ids=["plate", "beam"])
def test_closed_forms_of_shaken_tracks_have_unit_modal_mass(surface):
    """The modes at points of Gauss, whose masses add up to that of the track."""
    (left, right), (low, high) = surface.sides
    (x, wide), (y, deep) = (np.polynomial.legendre.leggauss(30) for _ in range(2))
    x, y = (0.5 * (a + b + (b - a) * one) for (a, b), one in zip(surface.sides, (x, y), strict=True))
    mass = surface.track.total_mass / 4.0 * np.outer(wide, deep).ravel()
    shapes = surface.shapes(*(part.ravel() for part in np.meshgrid(x, y, indexing="ij")))
    np.testing.assert_allclose(shapes.T @ (mass[:, None] * shapes), np.eye(surface.angular.size), atol=1e-9)
    assert (right - left, high - low) == (shaken.LENGTH, shaken.STRIP if low else shaken.WIDTH)


def test_hoffmann():
    model = mode_coupling.hoffmann()
    np.testing.assert_allclose(model.sliding(0.3), [[2.0, 1.0 - 4.0 * 0.3 / 3.0], [1.0, 2.0]], atol=1e-12)
    assert model.exponents(0.5).imag == pytest.approx([1.605413, 1.192749], abs=5e-7)
    assert model.exponents(0.5).real == pytest.approx([0.0, 0.0], abs=1e-12)
    fastest = model.exponents(0.9)[0]
    assert (fastest.real, fastest.imag) == pytest.approx((0.157147, 1.422918), abs=5e-7)
    assert model.exponents(0.7499)[0].real == pytest.approx(0.0, abs=1e-9)
    assert model.exponents(0.7501)[0].real > 1e-3
    assert model.exponents(0.7501)[0].imag == pytest.approx(2**0.5, abs=1e-4)


@pytest.mark.parametrize(
    ("damping", "printed"), [((0.0, 0.0), 0.2916667), ((0.02, 0.02), 0.289367), ((0.02, 0.06), 0.271790)]
)
def test_sinou(damping, printed):
    """The limit by Hurwitz is where the growth of the eigenvalues passes zero."""
    limit, model = mode_coupling.sinou_limit(damping), mode_coupling.sinou(damping)
    assert limit == pytest.approx(printed, abs=5e-7)
    assert model.exponents(limit * (1 - 1e-4))[0].real < 1e-7
    assert model.exponents(limit * (1 + 1e-4))[0].real > 1e-4


def test_sinou_flutters_at_88_hertz():
    model = mode_coupling.sinou()
    met = model.exponents(mode_coupling.sinou_limit((0.0, 0.0)))
    assert met.imag / (2 * pi) == pytest.approx([88.3883, 88.3883], abs=1e-3)


def test_sliding_stability():
    """By the formula; the mesh of 30 elements moves the last digit of 3486.1 Hz and 4595 1/s."""
    free = stability.Pair().formula(0.0).imag / (2 * pi)
    assert free[:6] == pytest.approx([0.0, 109.2, 403.8, 588.2, 1210.7, 2352.8], abs=0.05)
    growing = stability.growing(stability.Pair().formula(1.5))[:2]
    assert growing.imag / (2 * pi) == pytest.approx([891.4, 3486.1], abs=0.1)
    assert growing.real == pytest.approx([1454.0, 4595.0], abs=0.6)
    assert not stability.growing(stability.Pair().formula(0.5)).size


def test_impact():
    assert bars.WALL.plateau(0.1) == pytest.approx(1270.83, abs=0.005)
    assert 5e-4 + bars.WALL.crossing == pytest.approx(8.854e-4, abs=5e-8)
    assert 2 * bars.WALL.mass * 0.1 == pytest.approx(0.489840, abs=5e-7)


@pytest.mark.parametrize(("courant", "printed"), [(0.9, 0.026), (0.5, 0.079)])
def test_printed_overshoots_are_those_of_the_scheme(courant, printed):
    """Printed to 0.1 %; from the closed form of lumped mass and central differences, with this gap."""
    words = {"gap": bars.GAP, "velocity": bars.VELOCITY, "duration": bars.DURATION}
    force = bars.force_of_scheme(bars.WALL, "lumped", True, bars.WALL.step(courant), **words)
    assert force.max() / bars.WALL.plateau(0.1) - 1 == pytest.approx(printed, abs=5e-4)


def test_bouncing_bar():
    assert bars.contacts() == pytest.approx((1.0, 1.6667, 3.6667, 4.3333), abs=5e-5)
    times = (0.0, 0.5, 1.3, 2.0, 2.5, 8 / 3, 4.0, 16 / 3)
    heights = (5.0, 3.75, 0.0, 1.666667, 4.027778, 3.888889, 0.0, 5.0)
    assert [bars.bounce(time) for time in times] == pytest.approx(heights, abs=5e-7)
    assert bars.BALL.plateau(10.0) == pytest.approx(300.0)
    # Momentum: the pressure 300 + 300 s over 2/3 s turns -10 m/s of 10 kg into +10 m/s against their weight.
    crossing = bars.BALL.crossing
    assert 300 * crossing + 150 * crossing**2 == pytest.approx(10 * (20 + 10 * crossing))


@pytest.mark.parametrize(
    ("degrees", "printed"), [(30, 2.501851), (45, 1.666667), (60, 1.347151), (75, 1.601283), (63.4349, 4 / 3)]
)
def test_painleve(degrees, printed):
    assert jams.painleve_limit(radians(degrees)) == pytest.approx(printed, abs=5e-7)


def test_lugre():
    """The period is printed as 6.3625; LSODA, Radau and BDF all give 6.36272."""
    period, peak, least = laws.lugre_reference()
    assert period == pytest.approx(6.3625, abs=2.5e-4)
    assert period == pytest.approx(6.36272, abs=5e-6)
    assert peak == pytest.approx(1.50799, abs=5e-6)
    assert least == pytest.approx(0.7412, abs=5e-5)


def test_velocity_step_starts_and_ends_where_it_must():
    time = np.array([0.0, 1e3])
    for evolution in ("aging", "slip"):
        first, last = laws.velocity_step(evolution, time)
        assert first == pytest.approx(laws.steady(laws.BEFORE) + laws.AGE.a * np.log(laws.AFTER / laws.BEFORE))
        assert last == pytest.approx(laws.steady(laws.AFTER))


def test_frequencies():
    found = beams.bending(beams.SUPPORTS["simply supported"].roots, 0.3)[:3]
    np.testing.assert_allclose(found, [261.43, 1045.70, 2352.84], atol=0.0051)
    found = beams.bending(beams.SUPPORTS["guided-free"].roots, 0.15)[:3]
    np.testing.assert_allclose(found, [592.62, 3202.49, 7908.14], atol=0.0051)
    np.testing.assert_allclose(
        beams.SUPPORTS["guided-free"].roots, [2.3650204, 5.4978039, 8.6393798, 11.7809725], atol=5e-8
    )


def test_schellengs_least_force_is_the_swing_that_the_losses_ask_for():
    """Each mode of Helmholtz motion requires ``2 s rho S L v / (beta k pi)²`` for a bow near the bridge, in phase.

    From ``q'' + 2 s q' + w² q = phi f`` in resonance, with the rectangles of the velocity under the bow; the cosines
    add up to a parabola that swings by ``pi² / 4`` times the first, and friction can swing by ``dmu F``.
    """
    case = strings.Bowed(0.01, 0.3)
    mass = case.string.total_mass
    numbers = np.arange(1, 200_001)
    forces = 2 * case.decay * mass * case.speed / (case.place * numbers * pi) ** 2
    swing = forces.sum() - (forces * (-1.0) ** numbers).sum()
    assert swing == pytest.approx(case.contrast * case.least, rel=1e-5)


def test_the_string_of_the_bow_has_its_period_and_impedance():
    case = strings.Bowed(0.1, 0.3)
    string = case.string
    assert string.modes().frequency[0] == pytest.approx(196.0 * np.sqrt(1 + case.inharmonicity), rel=1e-12)
    assert np.sqrt(string.tension * string.total_mass / string.length) == pytest.approx(case.impedance, rel=1e-12)


def test_cattaneo():
    """The numbers of CONTACT's case, printed to a radius of 1 mm."""
    known = partial_slip.closed_form()
    assert known == pytest.approx((1e-3, 2e-5, 4.390480e6, 8.172412e-6, 5e-4), rel=2e-7)


def test_nafems_levels_are_effective_values():
    for frequency, level in sounding_spheres.LEVELS.items():
        assert sounding_spheres.level_of_nafems(frequency) == pytest.approx(level, abs=6e-4)


def test_elastic_sphere(monkeypatch):
    """Printed for Poisson's ratio 1/4 (Love 1927, section 195) as 0.8160 pi and 0.840 pi."""
    monkeypatch.setattr(sounding_spheres, "STEEL", st.Material(1.0, 1.0, 0.25))
    size = 2.0 * pi * sounding_spheres.RADIUS
    assert sounding_spheres.breathing() * size / 1.2**0.5 == pytest.approx(0.8160 * pi, abs=5e-5 * pi)
    assert sounding_spheres.oblate() * size / 0.4**0.5 == pytest.approx(0.840 * pi, abs=5e-4 * pi)
