"""Bodies in space: contacts with two tangents against closed forms, brute force and the plane under rotations."""

from __future__ import annotations

from math import cos, hypot, pi, radians, sin, sqrt

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import stridula as st
from stridula._kernels.layout import columns as at
from stridula._kernels.layout.laws import LAW_COLUMNS
from stridula.integration.contact_solve import GaussSeidel
from stridula.integration.forces import forces_of
from stridula.verification.surfaces import RADIUS, WEIGHT, coin
from stridula.verification.systems.in_space import MASS, PRINTED_RATIO, RATIO, STIFFNESS, swinging, thrown_on_a_slope

from .checks import goes_on, same_side_by_side
from .lattice import lattice, matrices
from .test_equilibrium_starts import growth

SEPARATED, STICKING, SLIDING = 0, 1, 2
TURNED = Rotation.from_rotvec([0.3, -0.7, 1.1]).as_matrix()
SCHEMES = [pytest.param(st.CentralDifference(), id="central"), pytest.param(st.ExactModal(), id="exact")]
LAWS = [
    st.Coulomb(0.3),
    st.StaticKinetic(0.4, 0.3),
    st.Stribeck(0.4, 0.3, 0.5),
    st.LinearWeakening(0.4, 0.1, 0.2),
    st.TabulatedFriction([0.0, 0.2, 0.5, 1.0, 2.0], [0.35, 0.3, 0.27, 0.25, 0.26], 0.4),
    st.RateAndState(0.5, 0.02, 0.01, 1e-4, 1e-3),
    st.LuGre(0.4, 0.3, 0.05, 2e4, 5.0, 0.1),
]


# One contact: forces by brute force.


def reference(gap, slip, w, mu, before=(0.0, 0.0)):
    """Forces of one closed contact under Coulomb's law, its direction of sliding by bisection on a fine grid.

    It is that of the slip and a share of those `before`.
    """
    held = np.linalg.solve(w, -np.array([gap, *slip]))
    if held[0] >= 0.0 and hypot(*held[1:]) <= mu * held[0]:
        return held[0], -held[1:]

    def slide(angle):
        u = np.array([np.cos(angle), np.sin(angle)])
        normal = -gap / (w[0, 0] - mu * w[0, 1:] @ u)
        velocity = np.add(slip, before) + np.multiply.outer(normal, w[1:, 0]) - (mu * normal * (w[1:, 1:] @ u)).T
        return normal, u, velocity

    def across(angle):
        _, u, velocity = slide(angle)
        return u[0] * velocity[..., 1] - u[1] * velocity[..., 0]

    angles = np.linspace(-pi, pi, 2001)
    found = []
    for k in np.flatnonzero(np.diff(np.sign(across(angles)))):
        normal, u, velocity = slide(brentq(across, angles[k], angles[k + 1], xtol=1e-15))
        if normal > 0.0 and u @ velocity >= 0.0:
            found.append((normal, mu * normal * u))
    assert len(found) == 1
    return found[0]


@pytest.mark.parametrize("mu", [0.0, 0.2, 0.6])
def test_one_contact_has_the_forces_found_by_brute_force(mu):
    random = np.random.default_rng(5)
    states = set()
    for _ in range(200):
        half = random.standard_normal((3, 3))
        w = half @ half.T + 1.5 * np.eye(3)
        gap, slip = -abs(random.standard_normal()), 2.0 * random.standard_normal(2)
        known = reference(gap, slip, w, mu)
        laws = np.array([at.COULOMB]), np.full((1, LAW_COLUMNS), mu)
        carried = np.zeros((1, at.CARRIED))
        normal, *pulled = forces_of(np.array([gap]), slip[None], w, laws, carried, 1.0, GaussSeidel())[0]
        assert normal == pytest.approx(known[0], rel=1e-10)
        np.testing.assert_allclose(pulled, known[1], atol=1e-9 * known[0])
        states.add(bool(hypot(*pulled) < mu * normal * (1.0 - 1e-9)))
    assert states == ({False} if mu == 0.0 else {False, True})


# Systems of the plane, turned in space.


def in_the_plane(law, belt: float = 0.8) -> st.System:
    """The lattice on two feet over belts that are shaken, pushed about by a harmonic force."""
    return _on_feet(lattice(1500.0, damping=0.01), law, belt, np.eye(3)[:, :2], {})


def turned(law, rotation: np.ndarray, belt: float = 0.8) -> st.System:
    """The same in space, under a rotation of the world."""
    mass, stiffness = matrices()
    flat = lattice(None)
    body = st.ReducedBody(
        mass,
        stiffness,
        {name: rotation[:, :2] @ rows for name, rows in flat.points.items()},
        translation=rotation[:, :2] @ flat.translation,
        cutoff=1500.0,
        damping=0.01,
        name="block",
    )
    directions = {"normal": rotation[:, 1], "tangent": rotation[:, 0]}
    return _on_feet(body, law, belt, rotation, directions)


def _on_feet(body, law, belt, rotation, directions) -> st.System:
    contacts = [
        st.PointContact(
            body.at(foot),
            st.RigidTrack(velocity=belt, normal_velocity=0.01, normal_history=st.Harmonic(300.0), name=foot),
            friction=law,
            gap=1e-6 * number,
            **directions,
        )
        for number, foot in enumerate(("foot", "heel"))
    ]
    along = dict(zip("xyz", rotation @ np.array([20.0, -300.0, 0.0])[: rotation.shape[1]], strict=True))
    down = rotation @ np.array([0.0, -1.0, 0.0])[: rotation.shape[1]]
    push = st.Force(body.at("back"), **along, history=st.Harmonic(200.0, mean=0.5))
    return st.System(contacts, [push, st.Gravity(9.81, direction=down)])


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
@pytest.mark.parametrize("rotation", [np.eye(3), TURNED], ids=["upright", "turned"])
def test_a_planar_system_moves_equally_under_any_rotation(law, rotation):
    """Landings, sticks and reversals, which amplify rounding."""
    words = {"step": 5e-6, "sample_rate": 2e5, "probes": []}
    flat, space = (st.simulate(system, 0.01, **words) for system in (in_the_plane(law), turned(law, rotation)))
    size = float(flat.normal_force.max())
    np.testing.assert_allclose(space.normal_force, flat.normal_force, atol=1e-8 * size)
    np.testing.assert_allclose(space.tangential_force[..., 0], flat.tangential_force, atol=1e-7 * size)
    # Creep that reverses passes velocities of the size of rounding across: 1e-17 m/s there tilts a friction force.
    across = 1e-8 if law.set_valued or law.law == "lugre" else 2e-4
    np.testing.assert_allclose(space.tangential_force[..., 1], 0.0, atol=across * size)
    np.testing.assert_allclose(space.status_share, flat.status_share, atol=1e-6)
    assert int(flat.landings.sum()) >= 3
    for term in ("kinetic_and_elastic", "friction_loss", "drive_work", "contact_work"):
        np.testing.assert_allclose(space[term], flat[term], atol=1e-8 * float(np.abs(flat.drive_work).max()))


@pytest.mark.parametrize("friction", [0.1, 0.9])
def test_linear_theory_is_that_of_the_plane(friction):
    def sprung(system, rotation):
        body = system.bodies[0]
        springs = [st.Spring(body.at("back"), stiffness=2e6, direction=way) for way in "xyz"[: len(rotation)]]
        pushed = dict(zip("xyz", -400.0 * rotation[:, 1], strict=False))
        still = [
            st.PointContact(
                one.tip,
                st.RigidTrack(velocity=0.8, name=one.track.name),
                friction=one.friction,
                normal=one.normal,
                tangent=one.tangent,
            )
            for one in system.contacts
        ]
        return st.System(still, [st.Force(body.at("back"), **pushed)], springs)

    law = st.Coulomb(friction)
    flat = st.sliding_stability(sprung(in_the_plane(law), np.eye(2)))
    space = st.sliding_stability(sprung(turned(law, TURNED), TURNED))
    np.testing.assert_allclose(space.normal_force, flat.normal_force, rtol=1e-10)
    np.testing.assert_allclose(space.tangential_force[:, 0], flat.tangential_force, rtol=1e-10)
    np.testing.assert_allclose(space.frequency, flat.frequency, rtol=1e-8)
    np.testing.assert_allclose(space.growth_rate, flat.growth_rate, atol=1e-6 * float(flat.frequency.max()))
    assert bool(flat.unstable.any()) == (friction > 0.5)


# Friction in two directions.


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_particle_on_a_slope_ends_straight_downhill_at_half_its_speed(scheme):
    """Total speed falls as downhill speed rises: their sum stays the initial speed."""
    errors = []
    for step in (4e-3, 2e-3, 1e-3):
        run = st.simulate(thrown_on_a_slope(), 10.0, step=step, sample_rate=25.0, scheme=scheme, probes=[])
        along, up = run.slip_velocity.values[-1]
        assert abs(along) < 1e-9
        errors.append(-up / 0.5 - 1.0)
    errors = np.array(errors)
    assert abs(errors[-1]) < 1e-5
    # Second order.
    np.testing.assert_allclose(errors[:-1] / errors[1:], 4.0, rtol=0.02)


@pytest.mark.parametrize("degrees", [0.0, 30.0, 135.0, 290.0])
def test_a_mass_is_held_equally_in_all_directions(degrees):
    """A force that rises from 0 to 2 N in 1 s along any direction moves 1 kg off at mu N = 1 N, after 0.5 s."""
    mass = st.RigidBody(1.0)
    contact = st.PointContact(mass.centre, st.RigidTrack(), friction=st.Coulomb(0.1))
    way = radians(degrees)
    push = st.Force(mass.centre, x=2.0 * cos(way), z=2.0 * sin(way), history=st.Ramp(1.0))
    run = st.simulate(st.System(contact, [st.Gravity(10.0), push]), 0.7, step=1e-3, sample_rate=1e3, probes=[])
    moving = run.time.values[run.status.values == SLIDING]
    # Loads are taken at the beginning of a step, samples at its end.
    assert 0.5 < moving[0] < 0.5025
    np.testing.assert_allclose(run.tangential_force.values[-1], [cos(way), sin(way)], atol=1e-9)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_a_mass_is_stopped_equally_in_all_directions(law):
    """Thrown along either tangent or between them it slides equally far, from the first step on."""
    found = []
    for degrees in (0.0, 90.0, 215.0):
        mass, way = st.RigidBody(1.0), radians(degrees)
        thrown = st.InitialVelocity(mass, x=0.05 * cos(way), z=0.05 * sin(way))
        contact = st.PointContact(mass.centre, st.RigidTrack(), friction=law)
        system = st.System(contact, [st.Gravity(10.0), thrown])
        run = st.simulate(system, 0.02, step=1e-4, sample_rate=1e4, probes=[])
        found.append(run.slip_velocity.values @ [cos(way), sin(way)])
    for other in found[1:]:
        np.testing.assert_allclose(other, found[0], atol=1e-9 * 0.05)


@pytest.mark.parametrize("direction", [(1.0, 0.0), (0.6, -0.8)])
def test_friction_damps_motion_across_the_slip(direction):
    """Ratio mu N / (2 v sqrt(k m)) = 0.000498012 across, none along (Ansys VM274)."""
    assert pytest.approx(PRINTED_RATIO, abs=5e-10) == RATIO
    found = st.sliding_stability(swinging(direction))
    np.testing.assert_allclose(np.sort(found.damping_ratio), [0.0, RATIO], atol=1e-12)
    np.testing.assert_allclose(found.tangential_force, 0.5 * np.array(direction), atol=1e-15)
    np.testing.assert_allclose(found.slip_velocity, 10.0 * np.array(direction), rtol=1e-12)


def test_motion_across_the_slip_decays_in_time_as_in_theory():
    """A swing across of 1 mm/s against the 10 m/s of the belt, over 30 periods."""
    system, own = swinging(across=1e-3), sqrt(STIFFNESS / MASS)
    probe, step = st.Displacement(system.slider.centre, "z"), 2.0 * pi / own / 400.0
    run = st.simulate(system, 30.0 * 400.0 * step, step=step, sample_rate=1.0 / step, probes=[probe])
    z = run.displacement.values[:, 0]
    peaks = np.array([np.abs(z[400 * k : 400 * k + 400]).max() for k in range(30)])
    decay = -np.polyfit(np.arange(30) * 400.0 * step, np.log(peaks), 1)[0]
    assert decay == pytest.approx(RATIO * own, rel=2e-3)


# Many contacts.


def pillar(cutoff: float | None = 2500.0, **words) -> st.ReducedBody:
    """A free lattice of 2 x 3 x 2 masses in space, joined by springs along edges and diagonals."""
    places = np.array([(x, y, z) for x in range(2) for y in range(3) for z in range(2)], dtype=float)
    count = len(places)
    mass = np.repeat(0.02 * (1.0 + 0.1 * np.arange(count)), 3)
    stiffness = np.zeros((3 * count, 3 * count))
    for i in range(count):
        for j in range(i):
            way = places[i] - places[j]
            size = np.linalg.norm(way)
            if size < 1.8:
                spring = np.zeros(3 * count)
                spring[3 * i : 3 * i + 3], spring[3 * j : 3 * j + 3] = way / size, -way / size
                stiffness += 5e6 / size * np.outer(spring, spring)
    feet = {
        f"foot {k}": tuple(range(3 * n, 3 * n + 3)) for k, n in enumerate(np.flatnonzero(places[:, 1] == 0.0).tolist())
    }
    top = int(np.flatnonzero(places[:, 1] == 2.0)[0])
    points = feet | {"top": tuple(range(3 * top, 3 * top + 3))}
    translation = np.tile(np.eye(3), count)
    return st.ReducedBody(
        np.diag(mass),
        stiffness,
        points,
        translation=translation,
        cutoff=cutoff,
        **{"damping": 0.01, "name": "pillar"} | words,
    )


def standing(law=None, **words) -> st.System:
    """The pillar on four feet over a table that turns below it, pushed about at its top."""
    body = pillar(**words)
    places = [(-0.5, -0.5), (-0.5, 0.5), (0.5, -0.5), (0.5, 0.5)]
    contacts = [
        st.PointContact(
            body.at(f"foot {k}"),
            st.RigidTrack(velocity=0.3 + 0.4 * z, lateral_velocity=-0.4 * x, name=f"table {k}"),
            friction=law or st.Coulomb(0.4),
            gap=2e-6 * k,
        )
        for k, (x, z) in enumerate(places)
    ]
    shaken = st.Force(body.at("top"), x=30.0, y=-60.0, z=15.0, history=st.Harmonic(180.0, mean=0.6))
    springs = [st.Spring(body.at("top"), stiffness=2e4, direction=way) for way in ("x", "z")]
    return st.System(contacts, [shaken, st.Gravity(9.81)], springs)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_contacts_in_space_obey_their_laws_at_every_step(law, scheme):
    step, count = 4e-6, 5000
    run = st.simulate(standing(law), count * step, step=step, sample_rate=1.0 / step, scheme=scheme, probes=[])
    assert run.attrs["ended"] == "finished"
    assert int(run.unsolved_steps.sum()) == 0
    normal, tangential = run.normal_force.values, run.tangential_force.values
    pulled, slip = np.hypot(*tangential.T).T, run.slip_velocity.values * step
    size = normal.max()
    assert (normal >= 0.0).all()
    assert np.abs(run.gap.values * normal).max() < 1e-9 * size * np.abs(run.gap.values).max()
    status = run.status.values
    assert {SEPARATED, SLIDING} <= set(np.unique(status))
    if law.set_valued:
        highest = float(law.coefficient_at(0.0))
        assert (pulled <= highest * normal + 1e-9 * size).all()
        held = (status[1:] == STICKING) & (status[:-1] == STICKING)
        # Abscissas are rounded.
        assert np.abs(slip[1:][held]).max(initial=0.0) < 3e-9 * np.abs(slip).max()
    if isinstance(law, st.Coulomb):
        sliding = (status[2:] == SLIDING) & (status[1:-1] == SLIDING) & (status[:-2] == SLIDING)
        velocity = 9.0 * slip[2:] + 6.0 * slip[1:-1] + slip[:-2]
        crossed = tangential[2:, :, 0] * velocity[..., 1] - tangential[2:, :, 1] * velocity[..., 0]
        along = (tangential[2:] * velocity).sum(axis=-1)
        assert sliding.sum() > 1000
        assert np.abs(crossed[sliding]).max() < 1e-8 * np.abs(along[sliding]).max()
        assert (along[sliding] >= 0.0).all()
    terms = ["kinetic_and_elastic", "damping_loss", "drive_work", "contact_work"]
    largest = max(np.abs(run[term].values).max() for term in terms)
    assert np.abs(run.ledger_residual.values).max() < 1e-11 * largest
    assert (np.diff(run.friction_loss.values) >= -1e-12 * largest).all() or law.has_state


def test_runs_side_by_side_are_those_alone():
    systems = [standing(st.Coulomb(0.1 * k)) for k in range(1, 10)]
    same_side_by_side(systems, 2e-3, step=4e-6, sample_rate=5e4, probes=[])


def dragged(friction: float, damping: float) -> st.System:
    """The pillar, sprung and pressed at its feet, which a turning table drags in four directions."""
    system = standing(damping=damping)
    return st.System(
        [st.PointContact(one.tip, one.track, friction=st.Coulomb(friction)) for one in system.contacts],
        [*(st.Force(one.tip, y=-15.0) for one in system.contacts), st.Gravity(9.81)],
        [st.Spring(system.slider.at("top"), stiffness=2e4, direction=way) for way in ("x", "y", "z")]
        + [st.Spring(system.slider.at("foot 3"), stiffness=2e4, direction=way) for way in ("x", "z")],
    )


@pytest.mark.parametrize("scheme", SCHEMES)
def test_growth_in_time_is_that_of_linear_theory(scheme):
    """Mode coupling through friction in four directions, with the damping of friction across each."""
    system = dragged(0.5, 0.002)
    probe = st.Displacement(system.slider.at("top"), "z")
    known, seen, _ = growth(system, probe, 2e-6, 4e-3, 20, scheme, amplitude=1e-10)
    assert known.real > 1.0
    assert seen == pytest.approx(known, rel=2e-3)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_start_in_sliding_equilibrium_stays_there(scheme):
    moving = dragged(0.1, 0.1)
    # Rigid motions have no damping of their own.
    brakes = [st.Dashpot(one.tip, coefficient=20.0, direction=way) for one in moving.contacts for way in ("x", "z")]
    moving = st.System(moving.contact, moving.drives, [*moving.connections, *brakes])
    still = st.System(moving.contact, [*moving.drives, st.InitialEquilibrium()], moving.connections)
    theory = st.sliding_stability(moving)
    assert theory.attrs["equilibrium"] == "sliding"
    assert not theory.unstable.any()
    run = st.simulate(still, 0.02, scheme=scheme, probes=[])
    assert (run.status == SLIDING).all()
    np.testing.assert_allclose(
        run.normal_force, np.broadcast_to(theory.normal_force, run.normal_force.shape), rtol=1e-8
    )
    known = np.broadcast_to(theory.tangential_force, run.tangential_force.shape)
    np.testing.assert_allclose(run.tangential_force, known, atol=1e-8 * float(np.abs(known).max()))


# Bodies that come to rest.


def test_a_coin_that_slides_and_spins_stops_doing_both_at_once():
    """At v / (R w) = 0.652998 the ratio stays; there F = 0.616031 mu N and T = 0.471694 mu N R (Farkas et al. 2003).

    Forty-eight points, three motions: when it stops, the sticking forces are not unique, and a solution is found.
    """
    known, spin = 0.652998, 20.0
    system, places = coin(4, 12, known * RADIUS * spin, spin)
    run = st.simulate(system, 1.4, step=2e-4, sample_rate=1e3, probes=[])
    assert int(run.unsolved_steps.sum()) == 0
    forces = run.tangential_force.values
    moment = (forces[..., 0] * places[:, 1] - forces[..., 1] * places[:, 0]).sum(axis=1)
    # A field of directions that turns about a point inside the disc, by 4 x 12 points.
    assert forces[5, :, 0].sum() == pytest.approx(0.616031 * 0.2 * WEIGHT, rel=5e-3)
    assert moment[5] == pytest.approx(0.471694 * 0.2 * WEIGHT * RADIUS, rel=5e-3)
    slips = run.slip_velocity.values
    along = slips.mean(axis=1)[:, 0]
    turning = (slips[..., 0] * places[:, 1] - slips[..., 1] * places[:, 0]).sum(axis=1) / (places**2).sum()
    stopped = int(np.flatnonzero(np.abs(slips).max(axis=(1, 2)) > 1e-9)[-1])
    assert run.time.values[stopped] < 1.39
    assert float(run.kinetic_and_elastic[-1]) < 1e-15 * float(run.kinetic_and_elastic[0])
    for part in (0.3, 0.6, 0.9):
        sample = int(part * stopped)
        assert along[sample] / (RADIUS * turning[sample]) == pytest.approx(known, rel=1e-2)


# Rigid bodies.


def test_a_rigid_body_turns_about_its_principal_axes():
    """Velocity of a point of a body that spins: v + w x r, for any inertia; kinetic energy is that of the motion."""
    random = np.random.default_rng(7)
    half = random.standard_normal((3, 3))
    inertia = half @ half.T + 3.0 * np.eye(3)
    place, velocity, spin = random.standard_normal((3, 3))
    body = st.RigidBody(2.0, inertia, {"corner": place})
    moved = body.modal_coordinates([*velocity, *spin])
    np.testing.assert_allclose(body.trace("corner") @ moved, velocity + np.cross(spin, place), atol=1e-12)
    np.testing.assert_allclose(body.trace("centre") @ moved, velocity, atol=1e-12)
    assert moved @ moved == pytest.approx(2.0 * velocity @ velocity + spin @ inertia @ spin, rel=1e-12)
    np.testing.assert_allclose(body.modes().translation @ moved, 2.0 * velocity, atol=1e-12)


def test_a_plate_on_three_feet_shares_its_weight():
    """By the lever: feet of a triangle, the centre of mass nearer to one of them."""
    feet = {"a": (0.0, -0.1, 0.3), "b": (-0.2, -0.1, -0.1), "c": (0.3, -0.1, -0.2)}
    body = st.RigidBody(3.0, (0.2, 0.3, 0.25), feet)
    contacts = [
        st.PointContact(body.at(foot), st.RigidTrack(velocity=0.3, name=foot), friction=st.Coulomb(0.2))
        for foot in feet
    ]
    springs = [st.Spring(body.centre, stiffness=1e3, direction=way) for way in ("x", "z")]
    springs += [st.Spring(body.at("c"), stiffness=1e3, direction="z")]
    run = st.simulate(
        st.System(contacts, [st.Gravity(10.0), st.InitialEquilibrium()], springs), 0.1, step=1e-4, probes=[]
    )
    known = st.sliding_stability(st.System(contacts, [st.Gravity(10.0)], springs))
    assert float(known.normal_force.sum()) == pytest.approx(30.0, rel=1e-12)
    np.testing.assert_allclose(run.normal_force, np.broadcast_to(known.normal_force, run.normal_force.shape), rtol=1e-8)
    # Without friction the lever alone: three forces that balance weight and moments about x and z.
    places = np.array(list(feet.values()))
    lever = np.linalg.solve(np.stack([np.ones(3), places[:, 0], places[:, 2]]), [30.0, 0.0, 0.0])
    smooth = [st.PointContact(one.tip, one.track, friction=st.Coulomb(0.0)) for one in contacts]
    np.testing.assert_allclose(
        st.sliding_stability(st.System(smooth, [st.Gravity(10.0)], springs)).normal_force, lever, rtol=1e-10
    )


def test_a_spring_acts_along_any_direction(tmp_path):
    """A mass on one spring along (1, 2, 2) swings along it, held across by two others, at sqrt(k / m) each."""
    mass = st.RigidBody(2.0)
    ways = {(1.0, 2.0, 2.0): 1e3, (2.0, 1.0, -2.0): 3e3, (2.0, -2.0, 1.0): 5e3}
    springs = [st.Spring(mass.centre, stiffness=rate, direction=way) for way, rate in ways.items()]
    contact = st.PointContact(mass.centre, st.RigidTrack(), gap=1.0)
    system = st.System(contact, [st.InitialVelocity(mass, x=0.1, y=0.2, z=0.2)], springs)
    found = st.sliding_stability(system, status="separated")
    np.testing.assert_allclose(found.frequency, np.sqrt(np.array(list(ways.values())) / 2.0) / (2.0 * pi), rtol=1e-12)
    probes = [st.Displacement(mass.centre, way) for way in "xyz"]
    run = st.simulate(system, 0.1, step=1e-4, sample_rate=1e4, probes=probes)
    own = sqrt(1e3 / 2.0)
    known = 0.1 / own * np.sin(own * run.time.values)[:, None] * [1.0, 2.0, 2.0]
    np.testing.assert_allclose(run.displacement, known, atol=1e-12)
    assert st.load_scenario(run).system == system


def rubbing(space: bool) -> st.System:
    """Two masses on springs, the surface of the lower one moving under the upper one; 10 N press them together."""

    def body(mass: float, name: str):
        if space:
            return st.RigidBody(mass, name=name)
        return st.PointMass(mass, name=name)

    upper, lower = body(1.0, "upper"), body(2.0, "lower")
    moving = {"surface_velocity": (0.6, -0.8) if space else 1.0}
    contact = st.PointContact(upper.centre, lower.centre, friction=st.Coulomb(0.3), **moving)
    springs = [
        st.Spring(one.centre, stiffness=rate, direction=way)
        for one, rate in ((upper, 100.0), (lower, 300.0))
        for way in ("xyz" if space else "xy")
    ]
    return st.System(contact, [st.Force(upper.centre, y=-10.0)], springs)


@pytest.mark.parametrize("space", [False, True])
def test_a_surface_that_moves_drags_both_bodies_apart(space):
    """The upper moves with it by mu N / k, the lower the other way; N is 10 N less the force of the upper's spring."""
    system = rubbing(space)
    way = np.array([0.6, -0.8]) if space else np.array([1.0])
    theory = st.sliding_stability(system)
    # Both go down together: springs of 100 and 300 N/m share 10 N.
    normal = 10.0 * 300.0 / 400.0
    assert float(theory.normal_force) == pytest.approx(normal, rel=1e-12)
    np.testing.assert_allclose(np.ravel(theory.tangential_force), -0.3 * normal * way, rtol=1e-12)
    np.testing.assert_allclose(np.ravel(theory.slip_velocity), -way, rtol=1e-12)
    moved = theory.tip_displacement.values[[0, 2] if space else [0]]
    np.testing.assert_allclose(moved, 0.3 * normal / 100.0 * way, rtol=1e-12)
    held = theory.track_displacement.values[[0, 2] if space else [0]]
    np.testing.assert_allclose(held, -0.3 * normal / 300.0 * way, rtol=1e-12)
    still = st.System(system.contact, [*system.drives, st.InitialEquilibrium()], system.connections)
    run = st.simulate(still, 0.5, step=1e-3, probes=[])
    np.testing.assert_allclose(run.normal_force, normal, rtol=1e-9)
    # The drive supplies the loss of friction: 1 m/s against mu N.
    assert float(run.drive_work[-1]) == pytest.approx(0.3 * normal * 0.5, rel=1e-2)
    assert float(run.friction_loss[-1]) == pytest.approx(0.3 * normal * 0.5, rel=1e-9)
    assert st.load_scenario(run).system == still


def test_a_body_given_by_its_modes_moves_like_the_original():
    """With residual shapes, in both schemes, to round-off."""
    system = standing()
    whole = system.slider
    modes = whole.modes()
    held = ~modes.massless
    body = st.ModalBody(
        modes.angular_frequency[held],
        {name: whole.trace(name) for name in whole.points},
        modes.damping_rate[held],
        modes.translation,
        int(modes.massless.sum()),
        "pillar",
    )
    assert body.residual > 0
    contacts = [
        st.PointContact(body.at(one.tip.position), one.track, friction=one.friction, gap=one.gap)
        for one in system.contacts
    ]
    push = system.drives[0]
    loads = [st.Force(body.at("top"), x=push.x, y=push.y, z=push.z, history=push.history), system.drives[1]]
    springs = [
        st.Spring(body.at("top"), stiffness=one.stiffness, direction=one.direction) for one in system.connections
    ]
    words = {"step": 4e-6, "sample_rate": 2.5e5, "probes": []}
    known, found = (st.simulate(one, 2e-3, **words) for one in (system, st.System(contacts, loads, springs)))
    np.testing.assert_array_equal(found.normal_force, known.normal_force)
    again = st.load_scenario(found).simulate()
    np.testing.assert_array_equal(again.normal_force, known.normal_force)


# Records, restart, scenarios.


def test_an_ensemble_of_a_system_in_space_starts_from_small_changes():
    """Landings that come a little later, or a slider that starts a little faster."""
    for system in (standing(), dragged(0.4, 0.01)):
        found = st.ensemble(system, 2e-3, {"force": lambda run: float(run.normal_force.sum("contact").mean())}, runs=3)
        assert np.isfinite(found.force).all()
        assert 0.0 < float(np.ptp(found.force.values)) < 0.5 * float(found.force_mean)


def test_a_run_in_space_continues_and_runs_again(tmp_path):
    system = standing()
    probes = [st.Displacement(system.slider.at("top"), "z"), st.Velocity(system.slider.at("foot 1"), "z")]
    names = ("normal_force", "tangential_force", "contact_position")
    words = {"step": 4e-6, "sample_rate": 5e4, "probes": probes}
    whole, *_, scenario = goes_on(system, 2e-3, names, tmp_path, **words)
    assert whole.tangential_force.dims == ("time", "contact", "tangent")
    assert whole.normal_force.dims == ("time", "contact")
    again = scenario.simulate()
    np.testing.assert_array_equal(again.tangential_force, whole.tangential_force)
    np.testing.assert_array_equal(again.displacement, whole.displacement)


def test_a_rigid_body_is_one_of_a_scenario():
    body = st.RigidBody(2.0, (0.1, 0.2, 0.25), {"corner": (0.1, -0.2, 0.3)}, name="die")
    table = st.RigidTrack(velocity=0.2, lateral_velocity=-0.1)
    contact = st.PointContact(body.at("corner"), table, friction=st.Coulomb(0.2), normal=(0.0, 2.0, 0.5), gap=1e-5)
    system = st.System(contact, [st.Gravity(9.81, direction=(0.0, -1.0, 0.1)), st.InitialVelocity(body, z=0.1)])
    run = st.simulate(system, 0.05, step=1e-4, probes=[])
    again = st.load_scenario(run)
    assert again.system == system
    np.testing.assert_array_equal(again.simulate().normal_force, run.normal_force)


BODY = st.RigidBody(1.0)
FLAT = st.PointMass(1.0)
BAD = {
    "inertia": (lambda: st.RigidBody(1.0, (1.0, 1.0, 3.0)), "inertia must have no principal moment above the sum"),
    "inertia sign": (
        lambda: st.RigidBody(1.0, -1.0),
        "inertia must be positive definite, got a principal moment of -1",
    ),
    "inertia shape": (lambda: st.RigidBody(1.0, (1.0, 1.0)), "inertia must be one number, three, or a matrix"),
    "point": (lambda: st.RigidBody(1.0, points={"a": (1.0, 2.0)}), "points.'a'. must be three numbers"),
    "centre": (lambda: st.RigidBody(1.0, points={"centre": (1.0, 2.0, 3.0)}), "points must have names that are text"),
    "z force": (lambda: st.Force(FLAT.centre, z=1.0), "z must be 0 on a body in the plane, got 1"),
    "z velocity": (lambda: st.InitialVelocity(FLAT, z=1.0), "z must be 0 on a body in the plane, got 1"),
    "z probe": (lambda: st.Displacement(FLAT.centre, "z"), "direction must not be z on a body in the plane"),
    "normal in the plane": (
        lambda: st.PointContact(FLAT.centre, st.RigidTrack(), normal=(0.0, 1.0, 0.0)),
        "normal must be left out between bodies in the plane",
    ),
    "no normal": (
        lambda: st.PointContact(BODY.centre, st.RigidTrack(), normal=(0.0, 0.0, 0.0)),
        "normal must be three numbers, not all zero",
    ),
    "tangent along the normal": (
        lambda: st.PointContact(BODY.centre, st.RigidTrack(), normal=(0.0, 1.0, 0.0), tangent=(0.0, 2.0, 0.0)),
        "tangent must not lie along the normal",
    ),
    "lateral in the plane": (
        lambda: st.PointContact(FLAT.centre, st.RigidTrack(lateral_velocity=1.0)),
        "track.lateral_velocity must be 0 under a body in the plane",
    ),
    "bristles across in the plane": (
        lambda: st.PointContact(
            FLAT.centre, st.RigidTrack(), friction=st.LuGre(0.4, 0.3, 0.1, 1e4, initial_state=(0.0, 1e-6))
        ),
        r"friction.initial_state.1. must be 0 under a body in the plane, got 1e-06",
    ),
    "three bristles": (
        lambda: st.LuGre(0.4, 0.3, 0.1, 1e4, initial_state=(0.0, 1e-6, 0.0)),
        "initial_state must be one number, or two in space, got",
    ),
    "surface of a track": (
        lambda: st.PointContact(BODY.centre, st.RigidTrack(), surface_velocity=1.0),
        "surface_velocity must be 0 except against a point of a body",
    ),
    "two velocities in the plane": (
        lambda: st.PointContact(FLAT.centre, st.PointMass(2.0, name="b").centre, surface_velocity=(1.0, 2.0)),
        "surface_velocity must be one number, or two in space",
    ),
    "no modes": (lambda: st.ModalBody([], {"a": np.zeros((2, 0))}), "angular_frequency must be a list of numbers"),
    "mode below zero": (lambda: st.ModalBody([-1.0], {"a": np.ones((2, 1))}), "angular_frequency must be 0 or above"),
    "rows of modes": (lambda: st.ModalBody([1.0], {"a": np.ones((2, 2))}), "points.'a'. must have the shape .2, 1."),
    "no direction": (
        lambda: st.Spring(BODY.centre, stiffness=1.0, direction=(0.0, 0.0, 0.0)),
        "direction must be x, y, z or three numbers, not all zero, got .0.0, 0.0, 0.0.",
    ),
    "mixed points": (
        lambda: st.ReducedBody(np.eye(3), np.eye(3), {"a": (0, 1, 2), "b": (0, 1)}),
        "points.'b'. must move along as many directions as the first point, 3, got 2",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_arguments_in_space_are_refused(name):
    make, message = BAD[name]
    with pytest.raises(st.ArgumentError, match=message) as refused:
        make()
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("evolution", ["aging", "slip"])
def test_creep_under_rate_and_state_is_that_in_the_plane(evolution, scheme):
    """A mass that a belt draws against a spring, slower than the law counts as sliding."""
    law, records = st.RateAndState(0.5, 0.02, 0.01, 1e-4, 1e-3, evolution), []
    for mass in (st.PointMass(1.0), st.RigidBody(1.0)):
        contact = st.PointContact(mass.centre, st.RigidTrack(velocity=2e-4), friction=law)
        spring = st.Spring(mass.centre, stiffness=2e4, direction="x")
        system = st.System(contact, [st.Force(mass.centre, y=-10.0)], [spring])
        records.append(st.simulate(system, 2.0, scheme=scheme, step=1e-3, sample_rate=1e3, probes=[]))
    assert ["tangent" in run.dims for run in records] == [False, True]
    plane, space = (np.abs(run.tangential_force.values.reshape(2000, -1)[:, 0]) for run in records)
    np.testing.assert_allclose(space, plane, rtol=1e-7)
