"""Bodies with a surface that is not flat: profiles under points against SciPy, run-out under faces against a plane."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st

STEEL = st.Material(2.1e11, 7800.0, 0.3)


def checked(run):
    """A run whose ledger is closed and whose contacts only press."""
    terms = ("kinetic_and_elastic", "drive_work", "contact_work", "friction_loss", "convection_work")
    largest = max(float(np.abs(run[name]).max()) for name in terms)
    assert float(np.abs(run.ledger_residual).max()) <= 1e-11 * largest
    assert float(run.normal_force.min()) >= 0.0
    return run


def drawn(seed):
    random = np.random.default_rng(seed)
    rough = st.Profile.random(rms=random.uniform(1e-6, 4e-6), correlation_length=4e-3, length=0.1, seed=seed)
    sense = -1.0 if seed % 2 else 1.0
    return random, rough, sense * random.uniform(0.5, 2.0), random.uniform(0.05, 0.4)


@pytest.mark.parametrize("seed", range(4))
def test_two_masses_that_touch_with_a_profile_between_them(seed):
    random, rough, speed, friction = drawn(seed)
    mass, under, begin = random.uniform(0.05, 0.3), random.uniform(0.1, 0.5), random.uniform(-0.2, 0.2)
    k, c, spring, side, load = 1e6, 30.0, 2e5, 4e4, 40.0
    tip, track = st.PointMass(mass, "tip"), st.PointMass(under, "track")
    contact = st.PointContact(
        tip.centre,
        track.centre,
        at=begin,
        friction=st.Coulomb(friction),
        surface_velocity=speed,
        stiffness=st.LinearStiffness(k, c),
        profile=rough,
    )
    joints = [
        st.Spring(track.centre, stiffness=spring, direction="y"),
        st.Spring(track.centre, stiffness=side),
        st.Spring(tip.centre, stiffness=side),
    ]
    sink = (load / k + load / spring, load / spring)
    drives = [
        st.Force(tip.centre, y=-load),
        st.InitialState(tip, (0.0, -sink[0])),
        st.InitialState(track, (0.0, -sink[1])),
    ]
    moves = [st.Displacement(point, way) for point in (tip.centre, track.centre) for way in "xy"]
    run = checked(st.simulate(st.System(contact, drives, joints), 0.05, step=1e-5, sample_rate=1e5, probes=moves))

    def rates(time, state):
        x1, y1, x2, y2, *speeds = state
        vx1, vy1, vx2, vy2 = speeds
        place = begin + x1 - x2 - speed * time
        gap = y1 - y2 - float(rough.height_at(place)) + float(rough.height_at(begin))
        rate = vy1 - vy2 - float(rough.slope_at(place)) * (vx1 - vx2 - speed)
        normal = max(-k * gap - c * rate, 0.0) if gap < 0.0 else 0.0
        # It slides in one sense throughout.
        along = math.copysign(friction * normal, speed)
        forces = (along - side * x1) / mass, (normal - load) / mass
        below = (-along - side * x2) / under, (-normal - spring * y2) / under
        return [*speeds, *forces, *below]

    start = [0.0, -sink[0], 0.0, -sink[1], 0.0, 0.0, 0.0, 0.0]
    found = solve_ivp(
        rates, (0.0, 0.05), start, method="DOP853", t_eval=run.time.values, rtol=1e-10, atol=1e-13, max_step=1e-4
    )
    assert float((run.slip_velocity * -speed).min()) > 0.0
    assert np.ptp(found.y[1]) > 2e-6
    for moved, expected in zip(run.displacement.values.T, found.y, strict=False):
        assert np.abs(moved - expected).max() < 1e-4 * np.ptp(expected)


@pytest.mark.parametrize("seed", range(3))
def test_a_body_that_is_touched_may_have_the_profile_of_a_belt(seed):
    _, rough, speed, friction = drawn(seed)
    mass = st.PointMass(0.2, "tip")
    drives, words = [st.Force(mass.centre, y=-20.0)], {"friction": st.Coulomb(friction), "stiffness": 1e6, "at": 0.03}
    joint = st.Spring(mass.centre, stiffness=2e4)
    belt = st.PointContact(mass.centre, st.RigidTrack(velocity=speed, profile=rough), **words)
    heavy = st.PointMass(1e9, "belt")
    on_mass = st.PointContact(mass.centre, heavy.centre, surface_velocity=speed, profile=rough, **words)
    runs = [
        checked(st.simulate(st.System(one, drives, [joint]), 0.03, step=1e-5, sample_rate=1e4, probes=[]))
        for one in (belt, on_mass)
    ]
    for name in ("normal_force", "tangential_force", "gap", "contact_position"):
        first, other = (one[name].values for one in runs)
        assert np.abs(first - other).max() < 1e-6 * np.abs(first).max()


@pytest.mark.parametrize("seed", range(2))
def test_a_mass_rides_over_a_corrugated_beam(seed):
    random, rough, _, _ = drawn(seed)
    section = st.Rectangle(0.03, 0.01)
    beam = st.ModalBeam(STEEL, section, length=1.0, cutoff=400.0, name="rail", axial_modes=1)
    mass, k, load, speed, begin = 0.3, 1e6, 30.0, random.uniform(2.0, 4.0), 0.2
    tip = st.PointMass(mass, "tip")
    contact = st.PointContact(tip.centre, beam, at=begin, stiffness=k, profile=rough)
    drives = [
        st.Force(tip.centre, y=-load),
        st.InitialState(tip, (0.0, -load / k), (speed, 0.0)),
    ]
    moves = [st.Displacement(tip.centre, "y"), st.Displacement(beam.at(0.37), "y")]
    run = checked(st.simulate(st.System(contact, drives), 0.1, step=2e-5, sample_rate=5e4, probes=moves))
    bending = 0.5 * 0.01 / math.sqrt(3.0) * math.sqrt(2.1e11 / 7800.0) * np.pi**2
    count = int(math.sqrt(2.0 * np.pi * 400.0 / bending))
    size = math.sqrt(2.0 / (7800.0 * 0.03 * 0.01))
    angular = bending * np.arange(1, count + 1) ** 2
    orders = np.arange(1, count + 1)

    def rates(time, state):
        y, vy, *modal = state
        q, dq = np.array(modal[:count]), np.array(modal[count:])
        place = begin + speed * time
        shape = size * np.sin(np.pi * orders * place)
        gap = y - shape @ q - float(rough.height_at(place)) + float(rough.height_at(begin))
        normal = max(-k * gap, 0.0)
        return [vy, (normal - load) / mass, *dq, *(-(angular**2) * q - shape * normal)]

    start = np.zeros(2 + 2 * count)
    start[0] = -load / k
    found = solve_ivp(
        rates, (0.0, 0.1), start, method="DOP853", t_eval=run.time.values, rtol=1e-9, atol=1e-12, max_step=1e-4
    )
    below = size * np.sin(np.pi * orders * 0.37) @ found.y[2 : 2 + count]
    assert np.ptp(below) > 1e-6
    for moved, expected in zip(run.displacement.values.T, (found.y[0], below), strict=True):
        assert np.abs(moved - expected).max() < 1e-3 * np.ptp(expected)


INNER, OUTER, THICK = 0.05, 0.15, 0.01
AXIS, ORIGIN = (0.0, 1.0, 0.0), (0.0, 0.0, 0.0)


@cache
def meshed():
    mesh = st.SolidMesh.sector((INNER, OUTER), (0.0, 2.0 * math.pi), THICK, (2, 24, 1))
    return st.SolidBody(
        mesh,
        STEEL,
        fixed=["inner"],
        cutoff=4e3,
        damping=0.05,
        contact_faces={"top": "integration"},
        name="disc",
    )


def revolved(speed):
    profile = st.RectangleProfile({"disc": ((INNER, OUTER), (0.0, THICK))})
    return st.AxisymmetricBody(
        profile, STEEL, 4e3, "inner", orders=4, damping=0.05, axis=AXIS, turning=speed, name="disc"
    )


def braked(speed, run_out, kind, angle):
    """A pad at an angle about the axis of a disc, which may move along the axis and tilt."""
    mesh = (
        st.SolidMesh.block((0.06, 0.015, 0.03), (3, 1, 2))
        .moved((0.08, THICK, -0.015))
        .moved(rotation=(0.0, angle, 0.0))
    )
    pad = st.SolidBody(
        mesh, STEEL, fixed={"top": "xz"}, cutoff=3e4, damping=0.05, contact_faces={"bottom": (3, 3)}, name="pad"
    )
    track = revolved(speed) if kind == "revolved" else meshed()
    words = {} if kind == "revolved" else {"turning": (AXIS, ORIGIN, speed)}
    face = st.SurfaceContact(
        pad, "bottom", track, "" if kind == "revolved" else "top", stiffness=1e11, run_out=run_out, **words
    )
    joints = [st.Dashpot(pad.at("top"), coefficient=3e3, direction="y")]
    return face, st.System(face, [st.Force(pad.at("top"), y=-2e3)], joints)


@pytest.mark.parametrize("kind", ["revolved", "meshed"])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_pad_follows_the_plane_through_the_heights_below_it(kind, sense):
    speed, angle = sense * 20.0, 0.6
    run_out = st.RunOut.waves({1: 20e-6, 3: 4e-6}, {1: 0.4, 3: -1.0})
    face, system = braked(speed, run_out, kind, angle)
    time_of_turn = 2.0 * math.pi / 20.0
    probe = st.Displacement(face.body.at("bottom"), "y")
    run = checked(st.simulate(system, time_of_turn, probes=[probe], sample_rate=1e3))
    time = run.time.values
    x, _, z = face.places.T
    around, about = np.arctan2(-z, x), face.contacts[0].profile
    assert about.periodic
    heights = run_out.height_at(around[None] - speed * time[:, None])
    # The plane of least squares, as under a rigid pad on equal springs.
    plane = np.stack([np.ones(x.size), x - x.mean(), z - z.mean()], axis=1)
    mean = np.linalg.lstsq(plane, heights.T, rcond=None)[0][0]
    moved = run.displacement.values[:, 0]
    late = time > 0.1
    apart = (moved - moved[late].mean()) - (mean - mean[late].mean())
    assert np.ptp(mean[late]) > 30e-6
    assert np.abs(apart[late]).max() < 0.02 * np.ptp(mean)


def test_a_tip_carried_round_a_circle_rides_over_the_profile_of_a_plane():
    disc, radius, speed = revolved(0.0), 0.12, 1.0
    mass = st.RigidBody(0.05, name="tip")
    profile = st.RunOut.waves({4: 5e-6}).around(radius)
    moved = []
    for track, words in (
        (disc.circle((radius, 0.3, THICK), speed), {"profile": profile}),
        (st.RigidTrack(velocity=-speed, profile=profile), {"tangent": (1.0, 0.0, 0.0)}),
    ):
        words |= {"normal": (0.0, 1.0, 0.0), "at": 0.3 * radius, "stiffness": 1e6}
        contact = st.PointContact(mass.centre, track, **words)
        joints = [st.Spring(mass.centre, stiffness=1e5, direction=axis) for axis in "xz"]
        joints.append(st.Dashpot(mass.centre, coefficient=30.0, direction="y"))
        system = st.System(contact, [st.Force(mass.centre, y=-20.0)], joints)
        run = checked(st.simulate(system, 0.4, probes=[st.Displacement(mass.centre, "y")], sample_rate=2e3))
        moved.append(run.displacement.values[400:, 0])
    first, other = (each - each.mean() for each in moved)
    # The disc bends under a constant force, which its axial symmetry leaves out of this difference.
    assert np.abs(first - other).max() < 1e-4 * np.ptp(other)


def test_the_highest_point_of_a_surface_is_where_it_would_be_if_it_were_flat():
    run_out = st.RunOut.waves({2: 15e-6}, {2: 1.1})
    face, _ = braked(10.0, run_out, "revolved", 0.3)
    flat = replace(face, run_out=None)
    gaps, plain = (np.array([one.gap for one in each.contacts]) for each in (face, flat))
    x, _, z = face.places.T
    heights = run_out.height_at(np.arctan2(-z, x))
    np.testing.assert_allclose(gaps, plain + 15e-6 - heights, atol=1e-12)


def test_a_pad_follows_the_bumps_of_a_plane():
    bumps = st.Profile.random(rms=5e-6, correlation_length=0.06, length=0.6, seed=3)
    mesh = st.SolidMesh.block((0.06, 0.015, 0.03), (3, 1, 2)).moved((0.2, 0.0, -0.015))
    pad = st.SolidBody(mesh, STEEL, fixed={"top": "xz"}, cutoff=3e4, damping=0.05, contact_faces={"bottom": (3, 3)})
    speed = -0.6
    face = st.SurfaceContact(pad, "bottom", st.RigidTrack(velocity=speed, profile=bumps), stiffness=1e11)
    drives = [st.Force(pad.at("top"), y=-4e3), st.InitialEquilibrium()]
    joints = [st.Dashpot(pad.at("top"), coefficient=3e3, direction="y")]
    probe = st.Displacement(pad.at("bottom"), "y")
    run = checked(st.simulate(st.System(face, drives, joints), 0.5, probes=[probe], sample_rate=1e3))
    x, _, z = face.places.T
    heights = bumps.height_at(x[None] - 0.23 - speed * run.time.values[:, None])
    plane = np.stack([np.ones(x.size), x - x.mean(), z - z.mean()], axis=1)
    mean = np.linalg.lstsq(plane, heights.T, rcond=None)[0][0]
    moved = run.displacement.values[:, 0]
    assert np.ptp(mean) > 1e-5
    assert np.abs((moved - moved.mean()) - (mean - mean.mean())).max() < 0.02 * np.ptp(mean)


def test_a_table_of_one_turn_is_closed_and_read(tmp_path):
    degrees = np.arange(0.0, 360.0, 5.0)
    height = 12e-6 * np.cos(np.radians(degrees) + 0.3)
    table = tmp_path / "disc.csv"
    table.write_text("angle;height\n" + "\n".join(f"{a};{1e6 * h}" for a, h in zip(degrees, height, strict=True)))
    read = st.RunOut.read(table, ("angle", "height"), angle_unit=math.pi / 180.0, height_unit=1e-6)
    waves = st.RunOut.waves({1: 12e-6}, {1: 0.3})
    angles = np.linspace(-9.0, 9.0, 200)
    np.testing.assert_allclose(read.height_at(angles), waves.height_at(angles), atol=1e-10)
    for sense in (1.0, -1.0):
        around = waves.around(0.12, sense)
        np.testing.assert_allclose(around.height_at(sense * 0.12 * angles), waves.height_at(angles), atol=1e-15)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"angle": [0, 1, 2], "height": [0, 1e-6, 0]}, "angle must have 4 values or more"),
        ({"angle": [0, 1, 2, 3], "height": [0, 1e-6, 0, 0]}, "angle must go round one turn"),
        ({"angle": [0, 90, 180, 270], "height": [0, 1e-6, 0, 0]}, "angle must be within one turn"),
        ({"angle": [0, 2, 1, 4], "height": [0, 1e-6, 0, 0]}, r"angle\[2\] must be above 2"),
        ({"angle": [0, 2, 4, 6], "height": [0, 1e-6, 0]}, "height must have as many values as angle, 4"),
        ({"angle": [0, 2, 4, 2 * math.pi], "height": [0, 1e-6, 0, 2e-6]}, r"height\[3\] must be 0"),
    ],
)
def test_tables_that_do_not_go_round_are_refused(given, words):
    with pytest.raises(ValueError, match=words):
        st.RunOut(**given)


def test_surfaces_that_do_not_turn_are_refused():
    face, _ = braked(10.0, st.RunOut.waves({1: 1e-6}), "meshed", 0.0)
    with pytest.raises(ValueError, match="run_out must be left out on a track that does not turn"):
        replace(face, turning=None)
    with pytest.raises(ValueError, match="profile must be left out on a rigid track, which has its own"):
        st.PointContact(st.PointMass(1.0).centre, st.RigidTrack(), profile=st.Profile.sine(1e-6, 0.01))
    with pytest.raises(ValueError, match="run_out must be left out"):
        st.sliding_stability(braked(10.0, st.RunOut.waves({1: 1e-6}), "revolved", 0.0)[1])


def test_a_start_in_equilibrium_over_a_surface_that_is_not_flat():
    run_out = st.RunOut.waves({2: 15e-6}, {2: 1.1})
    face, system = braked(5.0, run_out, "revolved", 0.3)
    face = replace(face, friction=st.Coulomb(0.3))
    run = st.simulate(st.System(face, [*system.drives, st.InitialEquilibrium()], system.connections), 0.01, probes=[])
    loads = run.normal_force.values if run.normal_force.ndim == 1 else run.normal_force.values.sum(axis=1)
    # The pad moves on as the disc turns, without the blow of a load that is set on it.
    assert np.abs(loads - 2e3).max() < 20.0
    with_mode = st.InitialEquilibrium(mode="most unstable", amplitude=1e-9)
    st.simulate(st.System(face, [*system.drives, with_mode], system.connections), 1e-3, probes=[])
    rigid = replace(face, stiffness=None)
    with pytest.raises(ValueError, match="run_out must be left out in linear theory, and in equilibrium unless"):
        st.simulate(st.System(rigid, [*system.drives, st.InitialEquilibrium()], system.connections), 1e-3)
