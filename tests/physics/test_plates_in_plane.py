"""Plates that also move in their plane: against elements in plane stress, beams and symmetry."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest
import scipy.sparse
import scipy.sparse.linalg
from kernels.systems import on_a_soft_plate, soft

import stridula as st
from physics.cases import STEEL, dragged, slider
from physics.test_plates import LEANING, STEP, assert_same, recorded
from stridula.verification.prony import exponents

SHEET = st.ModalPlate(STEEL, 0.002, 0.4, 0.3, in_plane=True, in_plane_modes=(32, 24))


def in_plane(sheet: st.ModalPlate, values: np.ndarray) -> np.ndarray:
    """Those of the modes in the plane."""
    return values[..., sheet.harmonics[0] :]


def elements(sheet: st.ModalPlate, cells: tuple[int, int]):
    """Stiffness and mass of bilinear elements with 2 x 2 Gauss points, and their nodes; edges held along normals."""
    (nx, ny), nu = cells, sheet.material.poisson
    dx, dy = sheet.length / nx, sheet.width / ny
    law = np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, (1.0 - nu) / 2.0]])
    law *= sheet.material.young * sheet.thickness / (1.0 - nu**2)
    sx, sy = np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])
    stiffness, mass = np.zeros((8, 8)), np.zeros((8, 8))
    for a in (-(3**-0.5), 3**-0.5):
        for b in (-(3**-0.5), 3**-0.5):
            along, across = sx * (1 + sy * b) / 2 / dx, sy * (1 + sx * a) / 2 / dy
            strain = np.zeros((3, 8))
            strain[0, ::2], strain[1, 1::2], strain[2, ::2], strain[2, 1::2] = along, across, across, along
            rows = np.kron((1 + sx * a) * (1 + sy * b) / 4, np.eye(2))
            stiffness += strain.T @ law @ strain * dx * dy / 4
            mass += rows.T @ rows * sheet.surface_density * dx * dy / 4
    i, j = (one.ravel() for one in np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij"))
    nodes = np.stack([i * (ny + 1) + j, (i + 1) * (ny + 1) + j, (i + 1) * (ny + 1) + j + 1, i * (ny + 1) + j + 1], 1)
    freedoms = np.stack([2 * nodes, 2 * nodes + 1], 2).reshape(-1, 8)
    places = np.repeat(freedoms, 8, 1).ravel(), np.tile(freedoms, (1, 8)).ravel()
    x, y = np.meshgrid(np.linspace(0, sheet.length, nx + 1), np.linspace(0, sheet.width, ny + 1), indexing="ij")
    free = np.ones((*x.shape, 2), dtype=bool)
    free[[0, -1], :, 0] = free[:, [0, -1], 1] = False
    kept, size = np.flatnonzero(free), 2 * x.size
    matrices = (
        scipy.sparse.csc_matrix((np.tile(one.ravel(), len(nodes)), places), (size, size)) for one in (stiffness, mass)
    )
    return *(one[kept][:, kept] for one in matrices), x, y, kept


def test_frequencies_are_those_of_elements():
    """The error of elements falls by four as they are halved; the extrapolated error is of fourth order."""
    exact, found = in_plane(SHEET, SHEET.modes().frequency)[:8], []
    for cells in ((16, 12), (32, 24)):
        stiffness, mass, *_ = elements(SHEET, cells)
        squared = scipy.sparse.linalg.eigsh(stiffness, 8, mass, sigma=0.0, return_eigenvectors=False)
        found.append(np.sqrt(np.sort(squared)) / (2.0 * pi))
    np.testing.assert_allclose((found[0] - exact) / (found[1] - exact), 4.0, atol=0.06)
    np.testing.assert_allclose((4.0 * found[1] - found[0]) / 3.0, exact, rtol=1e-4)
    # Negative control: a slightly different Poisson's ratio.
    other = replace(SHEET, material=replace(STEEL, poisson=0.301))
    assert abs(in_plane(other, other.modes().frequency)[:8] / exact - 1.0).max() > 3e-4


def test_a_push_moves_it_as_far_as_elements_say():
    """A push over a patch of the sheet, leaning; both displacements elsewhere, to 2e-6."""
    direction, place = np.array([np.cos(0.5), np.sin(0.5)]), (0.25, 0.075)

    def pressure(x, y):
        far = np.hypot(x - 0.16, y - 0.12)
        return np.where(far < 0.08, np.cos(pi * far / 0.16) ** 4, 0.0)

    x, y = (np.arange(80) + 0.5)[:, None] / 80 * 0.4, (np.arange(60) + 0.5) / 60 * 0.3
    pushed = (pressure(x, y)[..., None] * direction).ravel() * 0.12 / 4800
    force = pushed @ SHEET.in_plane_shapes(x, y).reshape(9600, -1)
    still = SHEET.in_plane_shapes(*place) @ (force / in_plane(SHEET, SHEET.modes().angular_frequency) ** 2)
    found = []
    for cells in ((32, 24), (64, 48), (128, 96)):
        stiffness, mass, x, y, kept = elements(SHEET, cells)
        load = (pressure(x, y)[..., None] * direction).ravel()[kept] / SHEET.surface_density
        moved = np.zeros(2 * x.size)
        moved[kept] = scipy.sparse.linalg.spsolve(stiffness, mass @ load)
        found.append(moved.reshape(*x.shape, 2)[np.isclose(x, place[0]) & np.isclose(y, place[1])][0])
    errors = np.array(found) / still - 1.0
    np.testing.assert_allclose(errors[1] / errors[2], 4.0, atol=0.02)
    np.testing.assert_allclose((4.0 * found[2] - found[1]) / 3.0, still, rtol=5e-6)


def test_modes_have_unit_mass_and_move_with_a_translation():
    """By the midpoint rule, exact for products of so few half-waves, and of second order for one."""
    sheet = replace(SHEET, in_plane_modes=(5, 4), line=LEANING)
    x, y = (np.arange(64) + 0.5)[:, None] / 64 * 0.4, (np.arange(64) + 0.5) / 64 * 0.3
    shapes = sheet.in_plane_shapes(x, y).reshape(64 * 64, 2, -1)
    share = sheet.total_mass / 64**2
    found = np.einsum("pim,pin->mn", shapes, shapes) * share
    np.testing.assert_allclose(found, np.eye(len(found)), atol=1e-12)
    assert len(found) == 5 * 4 * 2 + 5 + 4
    moved = np.einsum("pim,i->m", shapes, sheet.line.tangent) * share
    translation = in_plane(sheet, sheet.modes().translation)
    np.testing.assert_allclose(translation[0], moved, atol=1e-2 * abs(moved).max())
    assert not translation[1].any()
    assert not sheet.modes().translation[0, : sheet.harmonics[0]].any()


def test_modes_obey_the_equations_and_the_edges():
    """By differences: ``w² rho u`` is the divergence of stress; edges are held along normals and bear no shear."""
    sheet = replace(SHEET, in_plane_modes=(3, 2))
    h, nu, c = 1e-4, 0.3, 2.1e11 / (1.0 - 0.3**2) / 7800.0
    squared = in_plane(sheet, sheet.modes().angular_frequency) ** 2

    def at(x, y):
        return sheet.in_plane_shapes(x, y)

    x, y = 0.13, 0.11
    middle = at(x, y)
    xx, yy = (at(x + h, y) + at(x - h, y) - 2 * middle) / h**2, (at(x, y + h) + at(x, y - h) - 2 * middle) / h**2
    xy = (at(x + h, y + h) - at(x + h, y - h) - at(x - h, y + h) + at(x - h, y - h)) / (4 * h**2)
    accelerated = [
        c * (xx[0] + (1 - nu) / 2 * yy[0] + (1 + nu) / 2 * xy[1]),
        c * (yy[1] + (1 - nu) / 2 * xx[1] + (1 + nu) / 2 * xy[0]),
    ]
    np.testing.assert_allclose(accelerated, -squared * middle, atol=1e-5 * squared.max())
    for normal, (x, y) in ((0, (0.0, 0.11)), (0, (0.4, 0.11)), (1, (0.13, 0.0)), (1, (0.13, 0.3))):
        shear = (at(x, y + h) - at(x, y - h))[0] / (2 * h) + (at(x + h, y) - at(x - h, y))[1] / (2 * h)
        np.testing.assert_allclose(at(x, y)[normal], 0.0, atol=1e-13)
        np.testing.assert_allclose(shear, 0.0, atol=1e-8)
        assert abs(at(x, y)[1 - normal]).max() > 0.1


@pytest.mark.parametrize("line", [None, st.Line((0.3, 0.1), pi), st.Line((0.04, 0.16), -0.7)])
def test_slopes_are_the_derivative_of_traces_along_the_line(line):
    sheet = soft(line)
    low, high = sheet.ends
    for place in np.linspace(low + 0.01, high - 0.01, 5):
        there = (sheet.trace(place + 1e-6) - sheet.trace(place - 1e-6)) / 2e-6
        np.testing.assert_allclose(sheet.path().traces(place)[1], there, atol=1e-6 * abs(there).max())
        np.testing.assert_array_equal(sheet.trace(place), sheet.trace(sheet.track_line.point(place)))
        assert not sheet.trace(place)[1, sheet.harmonics[0] :].any()


def bar() -> tuple[st.ModalPlate, st.ModalBeam]:
    """A wide strip that cannot narrow and stretches along its length only, and the beam as heavy.

    A quarter of its width from the edge it bends by ``sin(pi/4)`` of its amplitude ``sqrt(4 / M)``: as the beam does.
    """
    width, thickness = 4000.0, 0.02
    light = st.Material(2e8 / width, 150.0 / width, 0.0)
    words = {"bending_modes": (12, 1), "in_plane": True, "in_plane_modes": (8, 0), "damping": 0.02}
    wide = st.ModalPlate(light, thickness, 0.8, width, line=st.Line((0.0, width / 4.0)), **words)
    section = st.Section(thickness * width, thickness**3 * width / 12.0)
    return wide, st.ModalBeam(light, section, 0.8, bending_modes=12, axial_modes=8, damping=0.02)


def test_stretched_along_its_length_only_it_is_a_beam():
    wide, beam = bar()
    np.testing.assert_allclose(wide.modes().frequency[12:], beam.modes().frequency[12:], rtol=1e-12)
    np.testing.assert_allclose(wide.modes().translation[0], beam.modes().translation[0], rtol=1e-12, atol=1e-12)
    for place in (0.1, 0.3, 0.77):
        np.testing.assert_allclose(wide.trace(place), beam.trace(place), atol=1e-12)
        np.testing.assert_allclose(wide.path().traces(place)[1][0], beam.path().traces(place)[1][0], atol=1e-10)


def test_a_slider_on_it_is_on_a_beam():
    """Under friction that falls with velocity, which motion along the track feeds."""

    def on(track):
        rod = slider(-30.0, cutoff=8e3)
        law = st.LinearWeakening(0.7, 2.0, 0.3)
        contact = st.PointContact(rod.tip, track, at=0.2, friction=law, gap=1e-8)
        return st.System(contact, dragged(0.05, 30.0)(rod))

    words = {"step": STEP, "sample_rate": 2e4}
    probes = [[st.Velocity(track.at(0.3), "x")] for track in bar()]
    on_plate, on_beam = (
        st.simulate(on(track), 0.015, probes=seen, **words) for track, seen in zip(bar(), probes, strict=True)
    )
    assert on_beam.status_share.mean("time")[2] > 0.01
    for name in ("normal_force", "contact_position", "convection_work", "friction_loss", "velocity"):
        scale = np.abs(on_beam[name].values).max()
        np.testing.assert_allclose(on_plate[name].values, on_beam[name].values, atol=1e-4 * scale)
    stable, other = (st.sliding_stability(on(track)) for track in bar())
    np.testing.assert_allclose(stable.frequency, other.frequency, rtol=1e-6, atol=1e-4)
    np.testing.assert_allclose(stable.growth_rate, other.growth_rate, rtol=1e-5, atol=1e-4)
    # Negative control: it differs from a rigid one.
    still = st.simulate(on(replace(bar()[0], in_plane=False)), 0.015, **words)
    assert abs(still.normal_force - on_beam.normal_force).max() > 0.1 * on_beam.normal_force.max()


SOFT_LINE = st.Line((0.02, 0.03), 0.5)


@pytest.mark.parametrize(
    ("line", "other"),
    [
        (None, st.Line((0.3, 0.1), pi)),
        (st.Line((0.0, 0.06)), st.Line((0.0, 0.14))),
        (SOFT_LINE, st.Line((0.02, 0.17), -0.5)),
        (SOFT_LINE, st.Line((0.28, 0.03), pi - 0.5)),
        (SOFT_LINE, st.Line((0.28, 0.17), pi + 0.5)),
    ],
)
def test_mirrored_lines_are_the_same_track(line, other):
    assert_same(recorded(on_a_soft_plate(line)), recorded(on_a_soft_plate(other)))


def test_a_plate_turned_by_a_right_angle_is_the_same():
    turned = replace(soft(), length=0.2, width=0.3, line=st.Line((0.03, 0.02), pi / 2.0 - 0.5))
    system = on_a_soft_plate(SOFT_LINE)
    contact = replace(system.contact, track=turned)
    assert_same(recorded(system), recorded(replace(system, contact=contact)))
    # Negative control: another angle.
    other = replace(turned, line=replace(turned.line, direction=pi / 2.0 - 0.51))
    with pytest.raises(AssertionError):
        assert_same(recorded(system), recorded(replace(system, contact=replace(contact, track=other))))


def test_motion_in_the_plane_moves_no_normal_and_friction_does_not_bend():
    """A smooth contact never moves it in its plane; under friction it moves along, and bends as the rigid one."""
    sheet, rod = soft(SOFT_LINE), slider(-30.0, cutoff=8e3)
    points = [sheet.at((0.2, 0.05)), sheet.at(0.15)]
    probes = [st.Displacement(point, axis) for point in points for axis in "xy"]
    smooth, rough = (
        st.simulate(
            st.System(
                st.PointContact(rod.tip, sheet, at=0.1, friction=st.Coulomb(mu), gap=1e-8), dragged(0.05, 3.0)(rod)
            ),
            0.01,
            step=STEP,
            probes=probes,
        )
        for mu in (0.0, 0.5)
    )
    assert not smooth.displacement[:, ::2].any()
    assert smooth.displacement[:, 1::2].any()
    assert abs(rough.displacement[:, ::2]).max() > 0.01 * abs(rough.displacement[:, 1::2]).max()


def test_a_push_along_the_line_moves_it_by_its_compliance():
    """At rest under a constant force, which the exact scheme has exactly; the modes' sum, its damping strong."""
    sheet, ball = soft(SOFT_LINE, damping=0.5), st.PointMass(1.0)
    place = sheet.at((0.11, 0.07))
    system = st.System(st.PointContact(ball.centre, sheet, at=0.1, gap=1.0), [st.Force(place, x=2.0)])
    run = st.simulate(system, 0.3, step=2e-5, sample_rate=1e3, probes=[st.Displacement(place, axis) for axis in "xy"])
    shapes = np.array(SOFT_LINE.tangent) @ sheet.in_plane_shapes(0.11, 0.07)
    compliance = np.sum((shapes / in_plane(sheet, sheet.modes().angular_frequency)) ** 2)
    assert float(run.displacement[-1, 0]) == pytest.approx(2.0 * compliance, rel=1e-6)
    assert not run.displacement[:, 1].any()


LOAD, SLOPE = 8.0, 15.0


def rubbed(at: float = 0.1, **changes) -> st.System:
    """A stiff upright block dragged over a soft plate under friction that falls with the velocity."""
    rod = st.FiniteElementBeam(STEEL, st.Rectangle(0.02, 0.02), 0.05, elements=2, damping=0.2, cutoff=3e4)
    words = {"damping": 0.005, "cutoff": None, "bending_modes": (4, 3), "in_plane_modes": (1, 1)} | changes
    contact = st.PointContact(
        rod.tip, soft(st.Line((0.05, 0.04), 0.5), **words), at=at, friction=st.LinearWeakening(1.2, SLOPE, 0.02)
    )
    return st.System(contact, [st.ImposedVelocity(rod.root, 0.05, normal_load=LOAD)])


def grows(system: st.System) -> complex:
    found = st.sliding_stability(system)
    fastest = int(np.argmax(found.growth_rate.values))
    return complex(found.growth_rate[fastest], 2.0 * pi * found.frequency[fastest])


def test_falling_friction_feeds_it():
    """A rigid rider sees ``T = (static - slope (v - t q')) N``: a damping matrix ``-slope N t^T t`` on the modes."""
    system = rubbed()
    sheet = system.track
    modes, trace = sheet.modes(), in_plane(sheet, sheet.trace(0.1))[0]
    w, zeta = (in_plane(sheet, one) for one in (modes.angular_frequency, modes.damping))
    braked = np.diag(2.0 * zeta * w) - LOAD * SLOPE * np.outer(trace, trace)
    zero, one = np.zeros_like(braked), np.eye(len(w))
    known = np.linalg.eigvals(np.block([[zero, one], [-np.diag(w**2), -braked]]))
    known = known[known.imag > 0.0]
    known = known[np.argmax(known.real)]
    found = grows(system)
    # Effect of the rider's compliance: 1e-4 of the frequency.
    assert found.real == pytest.approx(known.real, rel=3e-4)
    assert found.imag == pytest.approx(known.imag, rel=1e-4)
    # Negative control: a plate that is rigid in its plane does not grow.
    assert grows(rubbed(in_plane=False)).real < 0.0


def test_it_grows_in_time_as_its_exponent_says():
    """Before it stops sliding; the contact moves by 2 mm meanwhile, which moves the exponent by 2e-3."""
    sheet = rubbed().track
    probes = [st.Displacement(sheet.at(place), "x") for place in ((0.11, 0.07), (0.21, 0.03))]
    run = st.simulate(rubbed(), 0.1, step=2e-6, sample_rate=5e4, probes=probes)
    assert bool((run.status == 2).all())
    seen = exponents(run.displacement.values[3000::10], 2e-4, 1e-4, 2)[0]
    known = grows(rubbed(at=float(run.contact_position[4000])))
    assert seen.real == pytest.approx(known.real, rel=0.01)
    assert seen.imag == pytest.approx(known.imag, rel=2e-4)


def test_it_radiates_no_sound_and_sound_does_not_damp_it():
    words = {"damping": 0.02, "cutoff": 15e3}
    rigid = st.ModalPlate(STEEL, 0.02, 0.25, 0.15, **words)
    sheet = replace(rigid, in_plane=True)
    bending, count = sheet.harmonics
    assert count > 0
    taken = st.radiation_damping(sheet)
    np.testing.assert_array_equal(taken[:bending], st.radiation_damping(rigid))
    assert not taken[bending:].any()
    assert taken.size == bending + count
    np.testing.assert_array_equal(st.radiation_efficiency(sheet, 1e3), st.radiation_efficiency(rigid, 1e3))
    damped = replace(sheet, damping=sheet.modes().damping + taken)
    np.testing.assert_array_equal(damped.modes().damping[bending:], 0.02)
    ball = st.PointMass(0.01)
    contact = st.PointContact(ball.centre, sheet, at=0.1, gap=1e-5)
    run = st.simulate(st.System(contact, [st.InitialVelocity(ball, y=-0.1)]), 10e-3, sample_rate=1e5)
    np.testing.assert_array_equal(st.radiate(run, sheet).values, st.radiate(run, rigid).values)
    assert float(abs(st.radiate(run, sheet)).max()) > 0.0


def test_a_cutoff_keeps_all_modes_below_it():
    sheet = soft(cutoff=1.5e3)
    whole = replace(sheet, cutoff=None, bending_modes=(30, 30), in_plane_modes=(30, 30))
    for kept, every in zip(
        np.split(sheet.modes().frequency, [sheet.harmonics[0]]),
        np.split(whole.modes().frequency, [whole.harmonics[0]]),
        strict=True,
    ):
        np.testing.assert_array_equal(kept, every[every <= 1.5e3])
        assert np.all(np.diff(kept) >= 0.0)
    exactly = replace(sheet, cutoff=float(in_plane(sheet, sheet.modes().frequency)[5]))
    assert exactly.harmonics[1] == 6
