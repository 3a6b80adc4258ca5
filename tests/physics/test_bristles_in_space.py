"""LuGre's bristles in space: steady sliding in any direction, slips that turn, and small motions about sliding."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import atan, cos, pi, radians, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st

from .checks import FORCES, goes_on, same_side_by_side
from .test_equilibrium_starts import growth, starting
from .test_space import SCHEMES, TURNED, dragged, in_the_plane, standing, turned

STICKING, SLIDING = 1, 2
LAW = st.LuGre(0.4, 0.3, 0.05, 2e4, 5.0, 0.1)
WEIGHT = 10.0


def curve(law, speed):
    return law.kinetic + (law.static - law.kinetic) * np.exp(-((speed / law.velocity) ** 2))


# The plane.


def skewed(law, along: float) -> st.System:
    """The lattice turned in space, its tangents turned about the normal by an angle, above the same belts."""
    system = turned(law, TURNED)
    way = cos(along) * TURNED[:, 0] + sin(along) * TURNED[:, 2]
    contacts = []
    for one in system.contacts:
        _, first, second = replace(one, tangent=way).frame @ TURNED[:, 0] * one.track.velocity
        contacts.append(replace(one, tangent=way, track=replace(one.track, velocity=first, lateral_velocity=second)))
    return replace(system, contact=contacts)


@pytest.mark.parametrize("along", [0.0, 0.7, -2.0])
def test_the_plane_is_returned_under_any_rotation(along):
    """Landings, sticks and reversals; also with the tangents turned about the normal."""
    words = {"step": 5e-6, "sample_rate": 2e5, "probes": []}
    system = skewed(LAW, along)
    flat, space = (st.simulate(one, 0.01, **words) for one in (in_the_plane(LAW), system))
    ways = np.array([one.frame[1:] @ TURNED[:, 0] for one in system.contacts])
    size = float(flat.normal_force.max())
    np.testing.assert_allclose(space.normal_force, flat.normal_force, atol=1e-9 * size)
    for name in ("tangential_force", "friction_state", "slip_velocity"):
        known = flat[name].values[..., None] * ways
        np.testing.assert_allclose(space[name], known, atol=1e-9 * np.abs(known).max())
    np.testing.assert_array_equal(space.status, flat.status)
    assert int(flat.landings.sum()) >= 3


# Steady sliding.


def sprung(degrees: float, speed: float, law=LAW, mass: float = 0.5, spring: float = 2e4) -> st.System:
    """A mass on springs along both tangents, pressed on a belt that moves in any direction."""
    way, body = radians(degrees), st.RigidBody(mass)
    belt = st.RigidTrack(velocity=-speed * cos(way), lateral_velocity=-speed * sin(way))
    contact = st.PointContact(body.centre, belt, friction=law)
    springs = [st.Spring(body.centre, stiffness=spring, direction=axis) for axis in "xz"]
    dashpots = [st.Dashpot(body.centre, coefficient=30.0, direction=axis) for axis in "xz"]
    return st.System(contact, [st.Force(body.centre, y=-WEIGHT)], springs + dashpots)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("degrees", [0.0, 30.0, 100.0, 180.0, 265.0, 301.0])
def test_steady_sliding_has_its_force_along_the_slip(degrees, scheme):
    """``(g + viscous |v|) N`` on the track along the slip; a start in equilibrium stays there, others converge."""
    speed, system = 0.1, sprung(degrees, 0.1)
    way = np.array([cos(radians(degrees)), sin(radians(degrees))])
    force, bristles = (curve(LAW, speed) + LAW.viscous * speed) * WEIGHT, curve(LAW, speed) / LAW.stiffness
    rest = st.simulate(starting(system), 0.02, scheme=scheme, probes=[])
    later = st.simulate(system, 0.6, scheme=scheme, probes=[])
    theory = st.sliding_stability(system)
    np.testing.assert_allclose(theory.tangential_force, force * way, atol=1e-12 * force)
    np.testing.assert_allclose(rest.tangential_force, np.tile(force * way, (rest.time.size, 1)), atol=1e-9 * force)
    np.testing.assert_allclose(rest.friction_state, np.tile(bristles * way, (rest.time.size, 1)), atol=1e-9 * bristles)
    np.testing.assert_allclose(later.tangential_force[-1], force * way, atol=1e-6 * force)
    np.testing.assert_allclose(later.slip_velocity[-1], speed * way, atol=1e-6 * speed)
    # Straight bristles at first.
    assert np.abs(later.tangential_force[0] - force * way).max() > 0.1 * force


# A slip that turns.

SOFT = st.LuGre(0.4, 0.3, 0.05, 60.0, 0.5, 0.2)
RADIUS, TURNING = 0.02, 6.0 * pi
SPRING, MASS = 2e4, 0.1


def rider(start, width: float, law=SOFT) -> st.System:
    """A rider on springs whose other ends go round in an ellipse; `start` are place, slip velocity and bristles."""
    body = st.RigidBody(MASS)
    contact = st.PointContact(body.centre, st.RigidTrack(), friction=replace(law, initial_state=tuple(start[4:])))
    springs = [
        st.Spring(
            body.centre,
            stiffness=SPRING,
            direction=axis,
            offset=size,
            history=st.Harmonic(TURNING / (2.0 * pi), phase=phase),
        )
        for axis, size, phase in (("x", RADIUS, 0.5 * pi), ("z", width, 0.0))
    ]
    placed = st.InitialState(body, (start[0], 0.0, start[1]), (start[2], 0.0, start[3]))
    return st.System(contact, [st.Force(body.centre, y=-WEIGHT), placed], springs)


def by_equations(start, width: float, duration: float, law=SOFT):
    """Place, slip velocity and bristles of that rider, from its equations of motion, as a function of time."""

    def rate(t, y):
        place, velocity, z = y[:2], y[2:4], y[4:]
        speed = np.linalg.norm(velocity)
        turned = velocity - law.stiffness * speed / curve(law, speed) * z
        ratio = law.stiffness * z + law.damping * turned + law.viscous * velocity
        pulled = SPRING * (np.array([RADIUS * cos(TURNING * t), width * sin(TURNING * t)]) - place)
        return np.concatenate([velocity, (pulled - WEIGHT * ratio) / MASS, turned])

    moved = solve_ivp(rate, (0.0, duration), start, "DOP853", dense_output=True, rtol=1e-11, atol=1e-14).sol
    return lambda times: moved(times).T


@cache
def on_an_ellipse():
    """Start near the steady motion on an ellipse, after some rounds, its width, two periods, and the motion in them."""
    width, period = 0.6 * RADIUS, 2.0 * pi / TURNING
    before = np.array([RADIUS, 0.0, 0.0, TURNING * width, 0.0, 0.0])
    start = by_equations(before, width, 5.0 * period)(5.0 * period)
    return start, width, 2.0 * period, by_equations(start, width, 2.0 * period)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_rider_on_an_ellipse_moves_by_its_equations(scheme):
    """1e-3 at the default step of 0.5 ms, and of second order: speed and direction vary, and bristles follow them."""
    start, width, duration, moved = on_an_ellipse()
    words = {"scheme": scheme, "sample_rate": 2e3, "probes": []}

    def errors(**own):
        run = st.simulate(rider(start, width), duration, **words, **own)
        known = moved(run.time.values)
        place, bristles = run.contact_position.values - known[:, :2], run.friction_state.values - known[:, 4:]
        return np.abs(place).max() / np.abs(known[:, :2]).max(), np.abs(bristles).max() / np.abs(known[:, 4:]).max()

    assert max(errors()) < 1e-3
    found = [errors(step=step) for step in (2e-4, 1e-4, 5e-5)]
    np.testing.assert_allclose(np.log2(np.divide(found[:-1], found[1:])), 2.0, atol=0.1)


def steady_circle(law=SOFT) -> tuple[complex, complex]:
    """Place and bristles of the rider on a circle at the start, x and z as one complex number."""
    place = RADIUS + 0.0j
    for _ in range(100):
        velocity = 1j * TURNING * place
        z = velocity / (law.stiffness * abs(velocity) / curve(law, abs(velocity)) + 1j * TURNING)
        ratio = (law.stiffness + 1j * TURNING * law.damping) * z + law.viscous * velocity
        place = (SPRING * RADIUS - WEIGHT * ratio) / (SPRING - MASS * TURNING**2)
    return place, z


def test_bristles_lag_behind_a_slip_in_a_circle():
    """By ``tan(lag) = turning g / stiffness |v|``; friction lies between the two."""
    place, z = steady_circle()
    start = [part for one in (place, 1j * TURNING * place, z) for part in (one.real, one.imag)]
    step = 5e-5
    run = st.simulate(rider(start, RADIUS), 1.0, step=step, sample_rate=1.0 / step, probes=[])
    slip, bristles, pulled = (
        run[name].values @ [1.0, 1.0j] for name in ("slip_velocity", "friction_state", "tangential_force")
    )
    speed = TURNING * abs(place)
    np.testing.assert_allclose(np.abs(slip), speed, rtol=2e-4)
    # Slips belong to the middle of a step, bristles to its end, forces to its beginning.
    bristles = bristles * np.exp(-0.5j * TURNING * step)
    lag = atan(TURNING * curve(SOFT, speed) / (SOFT.stiffness * speed))
    np.testing.assert_allclose(np.angle(slip / bristles), lag, rtol=5e-4)
    ratio = (SOFT.stiffness + 1j * TURNING * SOFT.damping) * z + SOFT.viscous * 1j * TURNING * place
    known = WEIGHT * ratio * np.exp(1j * TURNING * (run.time.values - step))
    np.testing.assert_allclose(pulled, known, atol=3e-4 * abs(known[0]))
    assert 0.1 * lag < np.angle(ratio / z) < 0.9 * lag


# Small motions about steady sliding.


@pytest.mark.parametrize("degrees", [0.0, 45.0, 200.0])
def test_motion_across_the_slip_has_the_roots_of_its_cubic(degrees):
    """``m x'' + c x' + k x + N ((s0 + s1 s) z + s2 s x) = 0`` with ``z' = x' - s0 V z / g``."""
    speed = 0.03
    known = st.sliding_stability(sprung(degrees, speed))
    found = known.growth_rate.values + 2j * pi * known.frequency.values
    rate = LAW.stiffness * speed / curve(LAW, speed)
    mass, spring, brake = 0.5, 2e4, 30.0 + WEIGHT * LAW.viscous
    cubic = np.polymul([mass, brake, spring], [1.0, rate])
    cubic = np.polyadd(cubic, WEIGHT * np.array([LAW.damping, LAW.stiffness, 0.0]))
    for root in np.roots(cubic):
        if root.imag >= 0.0:
            assert np.abs(found - root).min() < 1e-8 * abs(root)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_motion_across_the_slip_decays_in_time_as_in_theory(scheme):
    """From the equilibrium with the mode across on top, its bristles too."""
    speed, step = 0.03, 2e-5
    system = sprung(40.0, speed)
    known = st.sliding_stability(system)
    found = known.growth_rate.values + 2j * pi * known.frequency.values
    way = np.array([-sin(radians(40.0)), cos(radians(40.0))])
    shapes = known.mode_shape.values @ [1.0, 1.0j]
    # Modal displacements are those along x, y and z times the root of the mass.
    across = np.abs(shapes[:, [0, 2]] @ way)
    number = int(np.argmax(np.where(found.imag > 0.0, across, 0.0)))
    assert across[number] > 0.999
    words = {"scheme": scheme, "step": step, "sample_rate": 1.0 / step, "probes": []}
    run = st.simulate(starting(system, mode=number, amplitude=1e-7), 0.02, **words)
    rest = st.simulate(starting(system), 0.02, **words)
    away = (run.friction_state.values - rest.friction_state.values) @ way
    exponent = found[number]
    times = run.time.values - 0.5 * step
    basis = np.stack([np.exp(exponent * times).real, np.exp(exponent * times).imag], axis=1)
    left = away - basis @ np.linalg.lstsq(basis, away, rcond=None)[0]
    assert np.abs(left).max() < 1e-3 * np.abs(away).max()
    along = (run.friction_state.values - rest.friction_state.values) @ [way[1], -way[0]]
    assert np.abs(along).max() < 1e-3 * np.abs(away).max()


def bristled(law, damping: float = 0.002) -> st.System:
    """The pillar of four feet that a turning table drags in four directions, on bristles."""
    system = dragged(0.5, damping)
    return replace(system, contact=[replace(one, friction=law) for one in system.contacts])


@pytest.mark.parametrize("scheme", SCHEMES)
def test_growth_in_time_is_that_of_linear_theory(scheme):
    system = bristled(st.LuGre(0.6, 0.5, 0.3, 3e5, 2.0, 0.05))
    probe = st.Displacement(system.slider.at("top"), "z")
    known, seen, _ = growth(system, probe, 2e-6, 4e-3, 20, scheme, amplitude=1e-10)
    assert known.real > 1.0
    assert seen == pytest.approx(known, rel=2e-3)


# Records, restart, runs side by side, surfaces.


def test_a_run_continues_with_both_bristles_and_runs_again(tmp_path):
    system = standing(replace(LAW, initial_state=(1e-6, -2e-6)))
    names = ("normal_force", "tangential_force", "friction_state")
    whole, *_, again = goes_on(system, 2e-3, names, tmp_path, step=4e-6, sample_rate=5e4, probes=[])
    assert whole.friction_state.dims == ("time", "contact", "tangent")
    assert np.ptp(whole.friction_state.values[..., 1]) > 1e-6
    assert again.system == system
    np.testing.assert_array_equal(again.simulate().friction_state, whole.friction_state)


def test_a_number_for_the_bristles_at_the_start_is_along_the_first_tangent():
    pair, one = (
        st.simulate(standing(replace(LAW, initial_state=given)), 1e-4, step=4e-6, probes=[])
        for given in ((1e-5, 0.0), 1e-5)
    )
    np.testing.assert_array_equal(pair.friction_state, one.friction_state)


def test_bristles_beside_a_law_with_one_state():
    """That has none along the second tangent."""
    system = standing(LAW)
    aging = st.RateAndState(0.5, 0.02, 0.01, 1e-4, 1e-3)
    laws = (LAW, aging, st.Coulomb(0.4), LAW)
    contacts = [replace(one, friction=law) for one, law in zip(system.contacts, laws, strict=True)]
    run = st.simulate(replace(system, contact=contacts), 2e-3, step=4e-6, probes=[])
    known = np.array([[True, True], [True, False], [False, False], [True, True]])
    np.testing.assert_array_equal(np.isfinite(run.friction_state.values), np.tile(known, (run.time.size, 1, 1)))
    assert run.friction_state.attrs["units"] == "m or s"
    assert int(run.unsolved_steps.sum()) == 0


def test_runs_side_by_side_are_those_alone():
    systems = [standing(replace(LAW, kinetic=0.03 * k, static=0.05 * k)) for k in range(1, 10)]
    same_side_by_side(systems, 2e-3, (*FORCES, "friction_state"), step=4e-6, sample_rate=5e4, probes=[])


@pytest.mark.parametrize("law", [LAW, st.Coulomb(curve(LAW, 0.2) + LAW.viscous * 0.2)], ids=lambda law: law.law)
def test_a_face_slides_steadily_on_bristles(law):
    """As under constant friction equal to theirs at that speed."""
    material = st.Material(2e9, 2000.0, 0.3)
    pad = st.SolidBody.block(
        (0.04, 0.01, 0.03), (2, 1, 2), material, fixed=["top"], contact_faces=["bottom"], cutoff=2e4, damping=0.05
    )
    disc = st.RigidTrack(velocity=-0.2 * cos(0.5), lateral_velocity=-0.2 * sin(0.5), normal_velocity=1e-4)
    disc = replace(disc, normal_history=st.Sampled((0.0, 1e-3, 1.1e-3), (1.0, 1.0, 0.0)))
    surface = st.SurfaceContact(pad, "bottom", disc, friction=law, stiffness=1e12)
    run = st.simulate(st.System(surface), 0.02, sample_rate=2e4, probes=[], surface_rate="all")
    normal, pulled = run.normal_force.values[-1], run.tangential_force.values[-1]
    slips = run.slip_velocity.values[-1]
    assert normal.sum() > 10.0
    np.testing.assert_allclose(slips, np.tile([0.2 * cos(0.5), 0.2 * sin(0.5)], (len(slips), 1)), atol=2e-3)
    known = (curve(LAW, 0.2) + LAW.viscous * 0.2) * normal.sum() * np.array([cos(0.5), sin(0.5)])
    np.testing.assert_allclose(pulled.sum(axis=0), known, rtol=1e-2)
    largest = max(np.abs(run[name].values).max() for name in ("kinetic_and_elastic", "drive_work", "contact_work"))
    assert np.abs(run.ledger_residual.values).max() < 1e-10 * largest
