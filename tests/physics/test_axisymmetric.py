"""Bodies of revolution: against plates, rings, shafts, bars and spheres whose frequencies are known, and symmetry."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq
from scipy.special import iv, ivp, jv, jvp, kv, kvp, spherical_jn, yv, yvp

import stridula as st
from stridula.bodies.revolution.axisymmetric_body import _solution
from stridula.bodies.revolution.fourier_elements import fourier_elements
from stridula.bodies.revolution.profile_modes import families

STEEL = st.Material(2.1e11, 7800.0, 0.3)
STIFF = st.Material(2.1e11, 7800.0, 0.0)
HATTED = st.AxisymmetricBody(
    st.RectangleProfile({"disc": ((0.03, 0.12), (0.0, 0.01)), "hat": ((0.03, 0.06), (0.01, 0.03))}, size=0.006),
    STEEL,
    cutoff=9000.0,
)


def solid(
    outer: float, height: float, material: st.Material = STEEL, inner: float = 0.0, **given
) -> st.AxisymmetricBody:
    """A disc, ring or shaft."""
    profile = st.RectangleProfile({"solid": ((inner, outer), (0.0, height))}, size=given.pop("size", None))
    return st.AxisymmetricBody(profile, material, **given)


def firsts(body: st.AxisymmetricBody, order: int, side: int = 0) -> np.ndarray:
    """Frequencies of an order, of one of each pair."""
    numbers = body.numbers
    return body.modes().frequency[(numbers[:, 0] == order) & (numbers[:, 2] == side)]


def roots(equation, low: float, high: float, count: int, steps: int = 4000) -> np.ndarray:
    """First roots of an equation."""
    at = np.linspace(low, high, steps)
    values = np.array([equation(x) for x in at])
    found = [brentq(equation, at[k], at[k + 1], xtol=1e-13) for k in np.flatnonzero(values[:-1] * values[1:] < 0.0)]
    assert len(found) >= count
    return np.array(found[:count])


def thin_annulus(n: int, inner: float, nu: float) -> float:
    """First lambda² of a thin annulus of radius 1, clamped inside, free outside: Kirchhoff."""
    kinds = ((jv, jvp, -1.0), (yv, yvp, -1.0), (iv, ivp, 1.0), (kv, kvp, 1.0))

    def equation(k):
        rows = np.zeros((4, 4))
        for column, (shape, slope, sign) in enumerate(kinds):
            w, dw, laplacian = shape(n, k), k * slope(n, k), sign * k**2
            # w'' from the Laplacian, which is a multiple of the shape.
            moment = laplacian * w - (1.0 - nu) * (dw - n**2 * w)
            shear = laplacian * dw - (1.0 - nu) * n**2 * (dw - w)
            rows[:, column] = shape(n, k * inner), k * slope(n, k * inner), moment, shear
        return np.linalg.det(rows / np.abs(rows).max(axis=0))

    return roots(equation, 0.8, 6.0, 1, 800)[0] ** 2


def thin(body_of_thickness, order: int, scale, count: int = 1) -> np.ndarray:
    """Limit of scaled frequencies of an order for thin plates.

    From three thicknesses h, h / 2, h / 4, without the parts that go with h, a clamp that holds the faces and a free
    edge that twists, and with h², shear and rotatory inertia; and each from cells of h and of h / 2, whose error falls
    by four.
    """
    found = []
    for share in (1.0, 0.5, 0.25):
        body, h = body_of_thickness(share)
        sizes = [replace(body, profile=replace(body.profile, size=size)) for size in (h, 0.5 * h)]
        coarse, fine = (scale(h) * firsts(one, order)[:count] for one in sizes)
        found.append((4.0 * fine - coarse) / 3.0)
    return (found[0] - 6.0 * found[1] + 8.0 * found[2]) / 3.0


@pytest.mark.parametrize(("n", "known"), [(0, 6.660), (1, 6.552), (2, 7.956), (3, 13.27)])
def test_a_thin_annulus_is_that_of_leissa(n, known):
    """Leissa 1969, Vibration of Plates, table 2.24, whose four digits also follow from Kirchhoff's equation.

    The cube of the thickness, at k h = 0.1, may leave some 1e-4.
    """
    radius = 0.15

    def body(share):
        h = 0.004 * share
        return solid(radius, h, inner=0.3 * radius, cutoff=160e3 * h, held="inner", orders=n), h

    def scale(h):
        return 2.0 * math.pi * radius**2 * math.sqrt(12.0 * 7800.0 * (1.0 - 0.3**2) / (2.1e11 * h**2))

    exact = thin_annulus(n, 0.3, 0.3)
    # One unit of the last digit.
    assert exact == pytest.approx(known, abs=0.01 if n == 3 else 0.001)
    assert thin(body, n, scale)[0] == pytest.approx(exact, rel=1e-4)
    # Negative control: another Poisson's ratio.
    assert abs(thin_annulus(n, 0.3, 0.31) / exact - 1.0) > 1e-4


def test_a_thin_disc_clamped_outside_is_that_of_vm181():
    """Three modes of order 0, Kirchhoff: J0 I1 + J1 I0 = 0. Shear is worth 1.5 % of the third at the disc's thickness.

    The cube of the thickness leaves less than a tenth of ``(k h)³``, 1e-3 for the third mode.
    """
    inch, psi = 0.0254, 6894.757293168361
    material = st.Material(30e6 * psi, 0.00073 * psi / inch**2, 0.3)
    radius, whole = 17.0 * inch, 0.5 * inch
    k = roots(lambda k: jv(0, k) * iv(1, k) + jv(1, k) * iv(0, k), 1.0, 12.0, 3)

    def scale(h):
        return 2.0 * math.pi * radius**2 / math.sqrt(material.young * h**2 / (12.0 * 0.91 * material.density))

    # The manual's density has two digits.
    np.testing.assert_allclose(k**2 / scale(whole), [172.64, 671.79, 1505.7], rtol=0.005 / 7.3)

    def body(share):
        h = 0.5 * share * whole
        return solid(radius, h, material, cutoff=1600.0 * h / whole, held="outer", orders=0), h

    np.testing.assert_allclose(thin(body, 0, scale, 3), k**2, rtol=2e-4)


RADIUS, THIN = 0.08756, 0.00088


def ring(material: st.Material) -> st.AxisymmetricBody:
    """A free ring 20 mm wide, as wide as VM302's."""
    return solid(RADIUS + THIN / 2, 0.02, material, inner=RADIUS - THIN / 2, cutoff=450.0)


def curved_beam(material: st.Material, n: int) -> float:
    """Frequency of a thin ring in its plane [Hz]: Hoppe 1871."""
    factor = n * (n**2 - 1) / math.sqrt(n**2 + 1)
    return factor * math.sqrt(material.young * THIN**2 / 12.0 / material.density) / RADIUS**2 / (2.0 * math.pi)


@pytest.mark.parametrize("n", [2, 3, 4])
def test_a_ring_without_lateral_contraction_bends_as_a_curved_beam(n):
    """Slower by shear and rotatory inertia, ``(n h / R)² / 24 (1 + E / kappa G)`` with kappa = 5/6.

    Its curvature is worth some ``(h / R)² / 12``.
    """
    slower = (n * THIN / RADIUS) ** 2 / 24.0 * (1.0 + 2.0 * 6.0 / 5.0)
    found = firsts(ring(STIFF), n)[0] / curved_beam(STIFF, n) - 1.0
    assert found == pytest.approx(-slower, abs=3.0 * (THIN / RADIUS) ** 2 / 12.0)


def test_a_ring_of_steel_lies_between_a_beam_and_a_plate():
    """Ansys VM302, after Genta 2005, has 209.929 Hz for n = 3, in shells of finite size, and 75.299 Hz for n = 2.

    The latter is not that of a free ring: its frequencies are in the ratio 2.828 for any bending stiffness.
    """
    steel = st.Material(2.1e11, 7850.0, 0.3)
    body = ring(steel)
    for n in (2, 3):
        beam = curved_beam(steel, n)
        assert beam < firsts(body, n)[0] < beam / math.sqrt(1.0 - 0.3**2)
    assert firsts(body, 3)[0] == pytest.approx(209.929, rel=1e-3)
    assert firsts(body, 3)[0] / firsts(body, 2)[0] == pytest.approx(2.0 * math.sqrt(2.0), rel=1e-3)


def wave_error(number: float, size: float) -> float:
    """Largest relative error of quadratic elements in the frequency of plane waves: too high, in leading order."""
    return (number * size) ** 4 / 1440.0


@pytest.mark.parametrize(("inner", "held"), [(0.0, ()), (0.02, ()), (0.0, "bottom"), (0.02, "bottom")])
def test_shafts_twist_as_a_string_swings(inner, held):
    """``c_T k / 2 pi`` with ``k L = pi, 2 pi, ...`` for free ends, ``pi / 2, 3 pi / 2, ...`` for one that is held."""
    length, size = 0.4, 0.02
    body = solid(0.05, length, inner=inner, cutoff=20e3, held=held, orders=0, size=size)
    found = firsts(body, 0, side=1)
    if not held:
        assert found[0] == 0.0
        found = found[1:]
    numbers = np.pi / length * (np.arange(1, len(found) + 1) - (0.5 if held else 0.0))
    exact = math.sqrt(2.1e11 / 2.6 / 7800.0) * numbers / (2.0 * math.pi)
    # Uniform twist over the section is lowest; others begin at x = 5.136, J2(x) = 0, that is at 53 kHz.
    excess = found / exact - 1.0
    assert len(found) >= 4
    assert (excess > -1e-9).all()
    assert (excess < 1.05 * wave_error(numbers, size)).all()
    assert excess[-1] > 0.5 * wave_error(numbers, size)[-1]


def test_bars_stretch_as_strings_swing_without_lateral_contraction():
    length, size = 0.4, 0.02
    body = solid(0.01, length, STIFF, cutoff=30e3, orders=0, size=size)
    found = firsts(body, 0)[1:]
    numbers = np.pi / length * np.arange(1, len(found) + 1)
    excess = found / (math.sqrt(2.1e11 / 7800.0) * numbers / (2.0 * math.pi)) - 1.0
    assert len(found) >= 4
    assert ((excess > -1e-9) & (excess < 1.05 * wave_error(numbers, size))).all()


def test_lateral_contraction_slows_bars_as_rayleigh_says():
    """By ``(nu k r)² / 4``; Pochhammer's next term is of its order times ``(k r)²``."""
    length, radius = 0.4, 0.01
    body = solid(radius, length, cutoff=15e3, orders=0, size=0.005)
    found = firsts(body, 0)[1:]
    numbers = np.pi / length * np.arange(1, len(found) + 1)
    slower = 1.0 - found / (math.sqrt(2.1e11 / 7800.0) * numbers / (2.0 * math.pi))
    expected = (0.3 * numbers * radius) ** 2 / 4.0
    assert len(found) == 2
    np.testing.assert_array_less(np.abs(slower - expected), expected * (numbers * radius) ** 2 + 1e-6)


def test_two_materials_in_a_row_share_their_waves():
    """A bar clamped at its steel end: ``tan(k1 L1) tan(k2 L2) = sqrt(E1 rho1 / E2 rho2)``."""
    soft, first, second, size = st.Material(5e9, 1200.0, 0.0), 0.2, 0.1, 0.005
    profile = st.RectangleProfile(
        {"steel": ((0.0, 0.01), (0.0, first)), "soft": ((0.0, 0.01), (first, first + second))}, size=size
    )
    body = st.AxisymmetricBody(profile, {"soft": soft, "steel": STIFF}, 15e3, "bottom", orders=0)
    slow = [math.sqrt(one.density / one.young) for one in (STIFF, soft)]

    def equation(angular):
        stiff = [math.sqrt(one.young * one.density) for one in (STIFF, soft)]
        a, b = angular * slow[0] * first, angular * slow[1] * second
        return stiff[1] * math.sin(a) * math.sin(b) - stiff[0] * math.cos(a) * math.cos(b)

    exact = roots(equation, 100.0, 2 * np.pi * 14e3, 2)
    excess = firsts(body, 0)[:2] * 2.0 * math.pi / exact - 1.0
    assert ((excess > -1e-9) & (excess < 1.05 * wave_error(exact * slow[1], size))).all()


def ball(rings: int, radius: float = 0.1) -> st.MeshProfile:
    """Half a disc of triangles, its corners on circles."""
    nodes, first, cells = [(0.0, 0.0)], [0], []
    for ring_number in range(1, rings + 1):
        first.append(len(nodes))
        share = radius * ring_number / rings
        nodes += [(share * math.sin(a), -share * math.cos(a)) for a in np.linspace(0.0, np.pi, 3 * ring_number + 1)]
    cells += [(0, 1 + k, 2 + k) for k in range(3)]
    for outer in range(2, rings + 1):
        inside, outside, j, k = 3 * (outer - 1), 3 * outer, 0, 0
        while j < inside or k < outside:
            if j == inside or (k < outside and (k + 1) * inside <= (j + 1) * outside):
                cells.append((first[outer - 1] + j, first[outer] + k, first[outer] + k + 1))
                k += 1
            else:
                cells.append((first[outer - 1] + j, first[outer] + k, first[outer - 1] + j + 1))
                j += 1
    return st.MeshProfile(nodes, cells)


def test_a_ball_has_the_same_modes_about_any_axis():
    """Lamb 1882: a mode of degree l is there in the orders 0 to l alike, one frequency for 2 l + 1 modes.

    Torsional: ``(l - 1) j_l(x) = x j_l+1(x)`` with ``x = w R / c_T``; breathing: ``(1 - (c_L x / 2 c_T)²) tan x = x``
    with ``x = w R / c_L``. Straight sides between corners on circles remove a part of the ball that falls by four; what
    remains is the error of the coarser elements.
    """
    radius, slow = 0.1, math.sqrt(2.1e11 / 2.6 / 7800.0)
    fast = slow * math.sqrt(3.5)
    second, third = (
        roots(lambda x, d=d: (d - 1) * spherical_jn(d, x) - x * spherical_jn(d + 1, x), 1.0, 5.0, 1)[0] for d in (2, 3)
    )
    breathing = roots(lambda x: (1.0 - 3.5 * x**2 / 4.0) * math.sin(x) - x * math.cos(x), 1.0, 3.0, 1)[0]
    bodies = [st.AxisymmetricBody(ball(rings, radius), STEEL, 27e3, orders=3) for rings in (8, 16)]
    for x, speed, where in (
        (second, slow, [(0, 1, 1), (1, 2, 0), (2, 0, 0)]),
        (third, slow, [(0, 2, 1), (1, 5, 0), (2, 2, 0), (3, 0, 0)]),
        (breathing, fast, [(0, 4, 0)]),
    ):
        exact = x * speed / (2.0 * math.pi * radius)
        for order, index, side in where:
            coarse, fine = (firsts(body, order, side)[index] for body in bodies)
            assert (coarse / exact - 1.0) / (fine / exact - 1.0) == pytest.approx(4.0, abs=0.2)
            left = wave_error(x / radius, radius / 8.0)
            assert (4.0 * fine - coarse) / 3.0 == pytest.approx(exact, rel=left)


def test_frequencies_fall_by_the_fourth_power_of_the_size_of_cells():
    """A thick free ring, whose corners all point outwards."""
    body = solid(0.1, 0.04, inner=0.06, cutoff=12e3, orders=3)
    sizes = (0.02, 0.01, 0.005)
    coarse, middle, fine = (
        replace(body, profile=replace(body.profile, size=size)).modes().frequency[6:] for size in sizes
    )
    assert len(coarse) == len(middle) == len(fine) > 4
    order = np.log2((coarse - middle) / (middle - fine))
    assert (order > 3.0).all()
    assert (coarse > middle).all()


SPOTS = [(0.12, 0.3, 0.01), (0.03, -2.0, 0.0), (0.05, 1.1, 0.03), (0.06, 4.0, 0.02), (0.1, 0.0, 0.004)]


def test_a_free_body_has_six_motions_without_frequency():
    """They are rigid motions, and carry the whole mass."""
    modes = HATTED.modes()
    assert (modes.frequency[:6] == 0.0).all()
    assert (modes.frequency[6:] > 100.0).all()
    rows = np.concatenate([HATTED.trace(spot)[:, :6] for spot in SPOTS])
    places = [HATTED.place(spot) for spot in SPOTS]
    rigid = np.concatenate([np.hstack([np.eye(3), np.cross(np.eye(3), place).T]) for place in places])
    fit = rigid @ np.linalg.lstsq(rigid, rows, rcond=None)[0]
    np.testing.assert_allclose(rows, fit, atol=1e-11 * np.abs(rows).max())
    assert np.linalg.matrix_rank(rows) == 6
    mass = math.pi * 7800.0 * (0.01 * (0.12**2 - 0.03**2) + 0.02 * (0.06**2 - 0.03**2))
    assert HATTED.total_mass == pytest.approx(mass, rel=1e-13)
    along = modes.translation
    np.testing.assert_allclose(along[:, :6] @ along[:, :6].T, mass * np.eye(3), atol=1e-12 * mass)
    np.testing.assert_allclose(along[:, 6:], 0.0, atol=1e-9 * math.sqrt(mass))
    # Its rigid translation agrees with the modes.
    for spot in SPOTS:
        np.testing.assert_allclose(HATTED.trace(spot) @ along.T, np.eye(3), atol=1e-10)


def test_a_held_body_moves_with_less_than_its_mass():
    modes = replace(HATTED, held="inner").modes()
    shares = np.einsum("ak,bk->ab", modes.translation, modes.translation) / HATTED.total_mass
    assert (np.diag(shares) < 1.0).all()
    assert (np.diag(shares) > 0.3).all()
    np.testing.assert_allclose(shares - np.diag(np.diag(shares)), 0.0, atol=1e-12)
    assert (modes.frequency > 0.0).all()


@pytest.mark.parametrize(
    ("held", "rigid"),
    [
        (st.Held("bottom", "z"), 4 - 1),
        (st.Held("bottom", ("r", "z")), 1),
        (st.Held("inner", ("r", "theta")), 1),
        (st.Held("bottom", "theta"), 3),
        ("bottom", 0),
    ],
)
def test_directions_that_are_not_held_stay_free(held, rigid):
    """A face held along the axis slides and turns in its plane; one held round the axis moves along it and tilts."""
    frequencies = replace(HATTED, held=held, cutoff=26e3).modes().frequency
    assert (frequencies == 0.0).sum() == rigid
    assert frequencies[rigid] > 100.0


def elastic(body: st.AxisymmetricBody) -> np.ndarray:
    return body.modes().frequency > 0.0


def compliance(body: st.AxisymmetricBody, position: tuple[float, float, float]) -> np.ndarray:
    """Static compliance along r, theta and z of the elastic modes [m/N]."""
    _, theta, _ = position
    turn = np.array([[np.cos(theta), np.sin(theta), 0.0], [-np.sin(theta), np.cos(theta), 0.0], [0.0, 0.0, 1.0]])
    rows = turn @ body.trace(position)[:, elastic(body)] / body.modes().angular_frequency[elastic(body)]
    return rows @ rows.T


@pytest.mark.parametrize("r", [0.12, 0.05])
def test_the_compliance_of_a_point_does_not_depend_on_its_angle(r):
    known = compliance(HATTED, (r, 0.0, 0.004))
    for theta in (0.1, 1.0, 2.5, -3.0, 40.0):
        np.testing.assert_allclose(compliance(HATTED, (r, theta, 0.004)), known, atol=1e-13 * np.abs(known).max())
    # Forces along r and z do not twist it.
    np.testing.assert_allclose(known[[0, 2], 1], 0.0, atol=1e-13 * np.abs(known).max())
    # Negative control: half of each pair.
    half = HATTED.numbers[elastic(HATTED), 2] == 0
    rows = [HATTED.trace((r, theta, 0.004))[2, elastic(HATTED)][half] for theta in (0.0, 1.0)]
    assert abs(np.sum(rows[0] ** 2) / np.sum(rows[1] ** 2) - 1.0) > 0.1


def test_pairs_have_one_frequency_and_stand_together():
    numbers, frequencies = HATTED.numbers, HATTED.modes().frequency
    assert (np.diff(frequencies) >= 0.0).all()
    first = np.flatnonzero((numbers[:, 0] > 0) & (numbers[:, 2] == 0))
    np.testing.assert_array_equal(numbers[first + 1], numbers[first] + [0, 0, 1])
    assert (frequencies[first] == frequencies[first + 1]).all()
    assert len({tuple(one) for one in numbers.tolist()}) == len(numbers)
    # The second of a pair is the first, turned by a quarter of its wave.
    for k in first:
        turn = np.pi / 2.0 / numbers[k, 0]
        one = HATTED.trace((0.1, 0.3, 0.002))[2, k]
        assert HATTED.trace((0.1, 0.3 + turn, 0.002))[2, k + 1] == pytest.approx(one, abs=1e-12 * max(1.0, abs(one)))


def test_shapes_are_orthogonal_and_of_unit_mass():
    """By an integral over the whole body, with independent Gauss points.

    Products of two quadratic shapes and r are of degree 5 in r, and have six waves round the axis.
    """
    x, weight = np.polynomial.legendre.leggauss(3)
    body = replace(HATTED, profile=replace(HATTED.profile, size=0.01), cutoff=6000.0, orders=3)
    angles = 2.0 * np.pi * np.arange(7) / 7.0
    total = 0.0
    for cell in body.mesh.cells:
        low, high = body.mesh.nodes[cell].min(axis=0), body.mesh.nodes[cell].max(axis=0)
        for a, wa in zip(x, weight, strict=True):
            for b, wb in zip(x, weight, strict=True):
                r, z = low + (high - low) * (np.array([a, b]) + 1.0) / 2.0
                share = 7800.0 * r * wa * wb / 4.0 * np.prod(high - low) * 2.0 * np.pi / len(angles)
                for theta in angles:
                    rows = body.trace((r, theta, z))
                    total = total + share * rows.T @ rows
    np.testing.assert_allclose(total, np.eye(len(total)), atol=1e-10)


def test_no_mode_below_the_cutoff_is_missed():
    """All modes of dense matrices, and none in the orders after the last."""
    body = replace(HATTED, profile=replace(HATTED.profile, size=0.03))
    elements = fourier_elements(body.mesh, [STEEL, STEEL])
    count, last = elements.count, int(body.numbers[:, 0].max())
    mass = scipy.linalg.block_diag(*[elements.mass.toarray()] * 3)
    for order in range(last + 1):
        squared = scipy.linalg.eigh(elements.stiffness_of(order).toarray(), mass, eigvals_only=True)
        assert squared.size == 3 * count
        rounding = 1e-15 * squared[-1]
        known = np.sqrt(np.where(squared < 100.0 * rounding, 0.0, squared)) / (2.0 * math.pi)
        known = known[known <= body.cutoff]
        found = np.sort(np.concatenate([firsts(body, order), firsts(body, order, 1) if order == 0 else []]))
        assert found.size == known.size
        np.testing.assert_allclose(found**2, known**2, atol=rounding)
    assert min(one.lowest for one in families(elements, [], body.cutoff, range(last + 1, 4 * last))) > body.cutoff


def test_a_thin_flange_on_a_thick_hub_has_all_its_orders():
    """Those of the flange, whose waves are a fifth as long as the hub's; or the requested number."""
    profile = st.RectangleProfile({"hub": ((0.0, 0.02), (0.0, 0.04)), "flange": ((0.02, 0.06), (0.0, 0.001))})
    body = st.AxisymmetricBody(profile, STEEL, 6000.0)
    last = int(body.numbers[:, 0].max())
    assert last >= 8
    beyond = families(_solution(body).elements, [], body.cutoff, range(last + 1, last + 6))
    assert min(one.lowest for one in beyond) > body.cutoff
    few = replace(body, orders=3)
    kept = body.numbers[:, 0] <= 3
    np.testing.assert_array_equal(few.numbers, body.numbers[kept])
    np.testing.assert_array_equal(few.modes().frequency, body.modes().frequency[kept])


def test_like_discs_on_one_shaft_have_their_modes_twice():
    """Both of two frequencies that differ by rounding only are found."""
    shaft, length = ((0.0, 0.01), (0.0, 0.6)), 0.6
    discs = [((0.01, 0.1), (0.1, 0.104)), ((0.01, 0.1), (length - 0.104, length - 0.1))]
    profile = st.RectangleProfile([("steel", one) for one in (shaft, *discs)], size=0.02)
    body = st.AxisymmetricBody(profile, STEEL, 4000.0)
    for n in (2, 3, 4):
        found = firsts(body, n)
        assert found.size >= 2
        np.testing.assert_allclose(found[::2], found[1::2], rtol=1e-6)


SOFTER = replace(HATTED, held="hat.top", orders=4, residual_at=[(0.11, 0.01), (0.1, 0.002)], cutoff=4000.0)


def yielding(body: st.AxisymmetricBody, first, second) -> np.ndarray:
    """Static displacements along x, y and z of one point under unit forces at another, rigid motions aside [m/N]."""
    stiffness = body.modes().stiffness
    kept = stiffness > 0.0
    return (body.trace(first)[:, kept] / stiffness[kept]) @ body.trace(second)[:, kept].T


@pytest.mark.parametrize("held", ["hat.top", (), st.Held("inner", "r")])
def test_with_residual_shapes_points_yield_alike_whatever_the_cutoff(held):
    first, second = (0.11, 0.3, 0.01), (0.1, -1.2, 0.002)
    low, high = (replace(SOFTER, held=held, cutoff=cutoff) for cutoff in (4e3, 25e3))
    plain = replace(low, residual_at=())
    for one, other in ((first, first), (first, second)):
        known = yielding(high, one, other)
        np.testing.assert_allclose(yielding(low, one, other), known, atol=1e-10 * np.abs(known).max())
    assert yielding(plain, first, first)[0, 0] < 0.5 * yielding(low, first, first)[0, 0]
    modes = low.modes()
    residual = modes.massless
    assert not residual[: plain.modes().count].any()
    assert residual[plain.modes().count :].all()
    assert not modes.damping_rate[residual].any()
    np.testing.assert_array_equal(low.numbers[~residual], plain.numbers)
    assert residual.sum() <= (3 * 2 + 1) * 9
    # Forces along r give the same at all angles.
    turned = yielding(low, (0.11, 1.3, 0.01), (0.11, 1.3, 0.01))
    assert np.trace(turned) == pytest.approx(np.trace(yielding(low, first, first)), rel=1e-12)


def test_residual_shapes_give_the_static_answer_of_each_order():
    """A force along z on a held body: the sum over orders of dense solutions; also under its own weight."""
    elements = _solution(SOFTER).elements
    held = elements.points_on(SOFTER.mesh.sides_of("hat.top"))
    count = elements.count
    free = np.setdiff1d(np.arange(3 * count), np.concatenate([held, held + count, held + 2 * count]))
    points, values = elements.shape_functions(0.11, 0.01)
    force, weight = np.zeros(3 * count), np.zeros(3 * count)
    force[2 * count + points] = values
    weight[2 * count :] = 2.0 * math.pi * np.asarray(elements.mass.sum(axis=1)).ravel()
    total = 0.0
    for order in range(5):
        stiffness = (2.0 if order == 0 else 1.0) * math.pi * elements.stiffness_of(order).toarray()[np.ix_(free, free)]
        total += force[free] @ np.linalg.solve(stiffness, force[free])
        if order == 0:
            sag = force[free] @ np.linalg.solve(stiffness, weight[free])
    place = (0.11, 0.7, 0.01)
    assert yielding(SOFTER, place, place)[2, 2] == pytest.approx(total, rel=1e-9)
    modes = SOFTER.modes()
    assert SOFTER.trace(place)[2] @ (modes.translation[2] / modes.stiffness) == pytest.approx(sag, rel=1e-9)


def test_it_stands_where_axis_and_origin_say():
    axis = (1.0, -2.0, 0.5)
    leaning = replace(HATTED, axis=axis, origin=(0.1, 0.2, 0.3))
    turn = leaning.frame
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(turn) == pytest.approx(1.0, abs=1e-15)
    np.testing.assert_allclose(turn[2], np.array(axis) / np.linalg.norm(axis), rtol=1e-15)
    for spot in SPOTS:
        np.testing.assert_allclose(leaning.trace(spot), turn.T @ HATTED.trace(spot), atol=1e-14)
        np.testing.assert_allclose(leaning.place(spot), [0.1, 0.2, 0.3] + turn.T @ HATTED.place(spot), atol=1e-15)
    np.testing.assert_allclose(leaning.modes().translation, turn.T @ HATTED.modes().translation, atol=1e-13)


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -1), (0, 0, 5.0), (1, 0, 0), (0, -1, 0), (1e-9, 0, -1)])
def test_the_frame_is_right_handed_for_any_axis(axis):
    frame = replace(HATTED, axis=axis).frame
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-15)
    assert np.linalg.det(frame) == pytest.approx(1.0, abs=1e-15)
    if axis[2] > 0:
        np.testing.assert_array_equal(frame, np.eye(3))


def test_a_straight_line_with_a_thickness_is_a_rectangle():
    lined = st.LineProfile([(0.05, 0.0), (0.05, 0.06)], 0.004, size=0.004)
    body = st.AxisymmetricBody(lined, STEEL, 6000.0, "start")
    boxed = solid(0.052, 0.06, inner=0.048, cutoff=6000.0, held="bottom", size=0.004)
    np.testing.assert_allclose(body.modes().frequency, boxed.modes().frequency, rtol=1e-9)


def test_regions_of_one_material_do_not_matter():
    split = st.RectangleProfile({"a": ((0.03, 0.06), (0.0, 0.01)), "b": ((0.06, 0.12), (0.0, 0.01))}, size=0.003)
    whole = st.RectangleProfile({"a": ((0.03, 0.12), (0.0, 0.01))}, size=0.003)
    both = {"a": STEEL, "b": replace(STEEL)}
    first = st.AxisymmetricBody(split, both, 8000.0, ["a.inner"])
    second = st.AxisymmetricBody(whole, STEEL, 8000.0, ["inner"])
    np.testing.assert_allclose(first.modes().frequency, second.modes().frequency, rtol=1e-9)
    light = replace(first, material={"a": STEEL, "b": replace(STEEL, density=3900.0)})
    assert light.modes().frequency[0] > 1.2 * first.modes().frequency[0]
