"""Plates as tracks: against closed forms, beams, and symmetry.

A plate far wider than long, bent without Poisson's effect, is a beam: ``(m/a)² + (1/b)²`` tends to ``(m/a)²``, and the
modes (m, 1) move at mid-width as those of a beam of half the mass, whose amplitude ``sqrt(2/M)`` is ``sqrt(4/2M)``.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from kernels.systems import SYSTEMS, on_a_plate, plate

import stridula as st
from physics.cases import SCHEME_NAMES, SCHEMES, STEEL, dragged, slider

STEP = 5e-6
SHEET = st.ModalPlate(STEEL, 0.002, 0.4, 0.3, cutoff=2e3, damping=0.01)
PLATES = [name for name in SYSTEMS if "plate" in name]


def test_modes_are_those_of_the_closed_form():
    found = dict(zip(map(tuple, SHEET.numbers.tolist()), SHEET.modes().frequency, strict=True))
    for pair, known in {(1, 1): 85.640, (2, 1): 178.132, (1, 2): 250.070, (2, 2): 342.561}.items():
        assert found[pair] == pytest.approx(known, abs=6e-4)
    assert np.all(np.diff(SHEET.modes().frequency) >= 0.0)
    beyond = replace(SHEET, cutoff=None, bending_modes=(40, 40)).modes().frequency
    np.testing.assert_array_equal(SHEET.modes().frequency, beyond[beyond <= 2e3])


def test_modes_have_unit_mass_and_move_with_a_translation():
    """By the midpoint rule, exact for products of so few half-waves."""
    x, y = (np.arange(64) + 0.5)[:, None] / 64 * 0.4, (np.arange(64) + 0.5) / 64 * 0.3
    shapes = SHEET.shapes(x, y).reshape(64 * 64, -1)
    share = SHEET.total_mass / 64**2
    np.testing.assert_allclose(shapes.T @ shapes * share, np.eye(len(SHEET.numbers)), atol=1e-12)
    # The mean of one half-wave converges in second order only.
    moved = shapes.sum(axis=0) * share
    np.testing.assert_allclose(SHEET.modes().translation[1], moved, atol=2e-2 * abs(moved).max())
    assert not SHEET.modes().translation[0].any()


@pytest.mark.parametrize("line", [None, st.Line((0.4, 0.15), pi), st.Line((0.05, 0.25), -0.7)])
def test_slopes_are_the_derivative_of_traces_along_the_line(line):
    sheet = replace(SHEET, line=line)
    low, high = sheet.ends
    for place in np.linspace(low + 0.01, high - 0.01, 5):
        there = (sheet.trace(place + 1e-6) - sheet.trace(place - 1e-6)) / 2e-6
        np.testing.assert_allclose(sheet.path().traces(place)[1], there, atol=1e-6 * abs(there).max())
        np.testing.assert_array_equal(sheet.trace(place), sheet.trace(sheet.track_line.point(place)))


def strip(width: float) -> tuple[st.ModalPlate, st.ModalBeam]:
    """A plate without Poisson's effect, `width` [m] wide, and the beam of half its mass."""
    light, thickness = st.Material(2.1e11 * 0.02 / width, 7800.0 * 0.02 / width, 0.0), 0.004
    wide = st.ModalPlate(light, thickness, 0.8, width, bending_modes=(12, 1), damping=0.02)
    section = st.Section(thickness * width / 2.0, thickness**3 * width / 24.0)
    return wide, st.ModalBeam(light, section, 0.8, bending_modes=12, axial_modes=0, damping=0.02)


def test_a_plate_far_wider_than_long_is_a_beam():
    for width in (4.0, 100.0):
        wide, beam = strip(width)
        ratio = wide.modes().frequency / beam.modes().frequency
        m = np.arange(1, 13)
        np.testing.assert_allclose(ratio, 1.0 + (0.8 / (m * width)) ** 2, rtol=1e-12)
        np.testing.assert_allclose(wide.trace(0.3), beam.trace(0.3), atol=1e-12)


def on_a_strip(track) -> st.System:
    rod = slider(-30.0, cutoff=8e3)
    contact = st.PointContact(rod.tip, track, at=0.2, friction=st.Coulomb(0.9), gap=1e-8)
    return st.System(contact, dragged(0.05, 3.0)(rod))


def test_a_slider_on_it_is_on_a_beam():
    wide, beam = strip(4000.0)
    words = {"step": STEP, "sample_rate": 2e4, "probes": []}
    on_plate, on_beam = (st.simulate(on_a_strip(track), 0.05, **words) for track in (wide, beam))
    for name in ("normal_force", "contact_position", "convection_work", "friction_loss"):
        scale = np.abs(on_beam[name]).max()
        np.testing.assert_allclose(on_plate[name], on_beam[name], atol=1e-4 * scale)
    stable, other = (st.sliding_stability(on_a_strip(track)) for track in (wide, beam))
    np.testing.assert_allclose(stable.frequency, other.frequency, rtol=1e-6, atol=1e-4)
    np.testing.assert_allclose(stable.growth_rate, other.growth_rate, rtol=1e-5, atol=1e-4)


def recorded(system, duration=0.02):
    return st.simulate(system, duration, step=STEP, sample_rate=2e4, probes=[])


def assert_same(one, other, sense=1.0, turned_at=0.0):
    """The same runs up to round-off that friction and impacts amplify; positions mirrored if `sense` is -1."""
    for name in ("normal_force", "gap", "kinetic_and_elastic", "convection_work"):
        np.testing.assert_allclose(one[name], other[name], atol=1e-6 * np.abs(one[name]).max())
    np.testing.assert_allclose(sense * one.tangential_force, other.tangential_force, atol=1e-5)
    np.testing.assert_allclose(sense * one.contact_position + turned_at, other.contact_position, atol=1e-9)


LEANING = st.Line((0.02, 0.03), 0.5)


@pytest.mark.parametrize(
    ("line", "other"),
    [
        (None, st.Line((0.3, 0.1), pi)),
        (st.Line((0.0, 0.06)), st.Line((0.0, 0.14))),
        (LEANING, st.Line((0.02, 0.17), -0.5)),
        (LEANING, st.Line((0.28, 0.03), pi - 0.5)),
        (LEANING, st.Line((0.28, 0.17), pi + 0.5)),
    ],
)
def test_mirrored_lines_are_the_same_track(line, other):
    assert_same(recorded(on_a_plate(line)), recorded(on_a_plate(other)))


def test_a_plate_turned_by_a_right_angle_is_the_same():
    turned = replace(plate(), length=0.2, width=0.3, line=st.Line((0.03, 0.02), pi / 2.0 - 0.5))
    system = on_a_plate(LEANING)
    contact = replace(system.contact, track=turned)
    assert_same(recorded(system), recorded(replace(system, contact=contact)))


def test_what_slides_back_is_the_mirror_image():
    forth = on_a_plate(LEANING)
    sheet, rod = plate(LEANING), slider(-30.0, cutoff=8e3)
    back = replace(sheet, line=st.Line(LEANING.point(0.2), LEANING.direction))
    contact = st.PointContact(rod.tip, back, at=-0.1, friction=st.Coulomb(0.9), gap=1e-8)
    mirrored = replace(sheet, line=st.Line(LEANING.point(0.2), LEANING.direction - pi))
    drives = dragged(0.05, 3.0)(slider(30.0, cutoff=8e3))
    there = st.System(replace(forth.contact, track=mirrored, at=0.1), drives)
    assert_same(recorded(there), recorded(st.System(contact, dragged(-0.05, 3.0)(rod))), -1.0)


def test_other_lines_are_other_tracks():
    """Negative control."""
    with pytest.raises(AssertionError):
        assert_same(recorded(on_a_plate(LEANING)), recorded(on_a_plate(replace(LEANING, direction=0.51))))


def test_even_modes_across_do_not_see_a_line_at_mid_width():
    odd = plate(bending_modes=(6, 3), cutoff=None)
    sheet = replace(odd, bending_modes=(6, 4))
    assert len(sheet.numbers) > len(odd.numbers)
    systems = [on_a_plate(bending_modes=(6, n), cutoff=None) for n in (3, 4)]
    assert_same(*map(recorded, systems))


def test_the_track_ends_where_the_line_leaves_the_plate():
    sheet = plate(st.Line((0.15, 0.1), radians(60.0)))
    assert sheet.ends == pytest.approx((-0.1 / np.sin(radians(60.0)), 0.1 / np.sin(radians(60.0))))
    low, high = sheet.ends
    for sense, end in ((-1.0, low), (1.0, high)):
        ball = st.PointMass(0.01)
        contact = st.PointContact(ball.centre, sheet, at=end - sense * 1e-3)
        run = st.simulate(st.System(contact, [st.InitialVelocity(ball, x=sense), st.Gravity()]), 0.01, sample_rate=1e5)
        assert run.attrs["ended"] == "off the track"
        assert 0.0 < sense * (end - float(run.contact_position[-1])) < 2e-5
        with pytest.raises(ValueError, match="at must be strictly between"):
            replace(contact, at=end)


def test_a_mass_at_rest_bends_the_plate_as_far_as_statics_says():
    """A contact pushes in impulses: a mode rests ``(w h)² / 12`` off, 1e-3 of the highest and 1e-6 of the lowest."""
    sheet = plate(st.Line((0.05, 0.04), 0.5), damping=0.3)
    ball = st.PointMass(0.3)
    system = st.System(st.PointContact(ball.centre, sheet, at=0.1), [st.Gravity()])
    run = st.simulate(system, 0.5, step=STEP, sample_rate=1e4, probes=[st.Displacement(sheet.centre)])
    modes, g = sheet.modes(), 9.80665
    force = -g * (modes.translation[1] + 0.3 * sheet.trace(0.1)[1])
    still = force / modes.angular_frequency**2
    assert float(run.normal_force[-1]) == pytest.approx(0.3 * g, rel=1e-8)
    assert float(run.contact_height[-1]) == pytest.approx(sheet.trace(0.1)[1] @ still, rel=3e-5)
    assert float(run.displacement[-1, 0]) == pytest.approx(sheet.shapes(0.15, 0.1) @ still, rel=3e-5)


def test_a_harmonic_force_moves_it_as_the_modes_sum_says():
    """Driving-point mobility by the march; the load's steps cost (w h)² / 24 of it, 3e-6 here."""
    sheet, frequency, ball = plate(damping=0.05), 270.0, st.PointMass(1.0)
    place = sheet.at((0.11, 0.07))
    system = st.System(
        st.PointContact(ball.centre, sheet, at=0.1, gap=1.0),
        [st.Force(place, y=2.0, history=st.Harmonic(frequency))],
    )
    run = st.simulate(system, 0.6, step=STEP, sample_rate=2e4, probes=[st.Displacement(place)])
    time, values = run.time.values[-2000:], run.displacement.values[-2000:, 0]
    turns = np.exp(2j * pi * frequency * time)
    (in_phase, out_of_phase), *_ = np.linalg.lstsq(np.stack([turns.real, turns.imag], axis=1), values, rcond=None)
    modes, w = sheet.modes(), 2 * pi * frequency
    own, shape = modes.angular_frequency, sheet.shapes(0.11, 0.07)
    receptance = np.sum(shape**2 / (own**2 - w**2 + 2j * modes.damping * own * w))
    assert np.hypot(in_phase, out_of_phase) == pytest.approx(2.0 * abs(receptance), rel=1e-4)


@pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
@pytest.mark.parametrize("name", PLATES)
def test_the_ledger_closes(name, scheme):
    make, step = SYSTEMS[name]
    run = st.simulate(make(), 0.02, scheme=scheme, step=step, probes=[])
    flow = float(np.abs(run.drive_work).max() + run.kinetic_and_elastic.max())
    assert float(np.abs(run.ledger_residual).max()) < 1e-11 * flow
    # The effect of the moving contact point on the plate exceeds round-off.
    assert float(np.abs(run.convection_work).max()) > 1e-9 * flow


@pytest.mark.parametrize("name", PLATES)
def test_a_run_continues_to_the_last_bit(name):
    make, step = SYSTEMS[name]
    words = {"step": step, "sample_rate": 0.1 / step}
    whole, first = (st.simulate(make(), duration, **words) for duration in (0.02, 0.01))
    second = st.simulate(make(), 0.01, start=first, **words)
    for one in ("normal_force", "contact_position", "acceleration", "convection_work"):
        if one in whole:
            np.testing.assert_array_equal(whole[one].values[-len(second.time) :], second[one].values)


def test_probes_on_plates_are_named_and_the_centre_is_heard():
    sheet = plate()
    run = recorded(on_a_plate(), 1e-3)
    assert "acceleration" not in run
    heard = st.simulate(on_a_plate(), 1e-3, step=STEP)
    assert list(heard.acceleration_probe.values) == ["track centre y"]
    probes = [
        st.Velocity(sheet.at((0.1, 0.05))),
        st.Velocity(sheet.at(np.float64(0.25))),
        st.Velocity(sheet.at(0.15), "x"),
    ]
    several = st.simulate(on_a_plate(), 1e-3, step=STEP, probes=probes)
    assert list(several.velocity_probe.values) == ["track (0.1, 0.05) m y", "track 0.25 m y", "track 0.15 m x"]
    assert not several.velocity[:, 2].any()
