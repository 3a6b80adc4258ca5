"""Forces of connections: laws of springs and dashpots, and Newton's law for what they and rigid joints accelerate."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.integrate

import stridula as st

from .test_condensed_shapes import body

STEP = 1e-4
EACH_STEP = {"step": STEP, "sample_rate": 1.0 / STEP}
SCHEMES = [st.ExactModal(), st.CentralDifference()]
BELT = st.RigidTrack(velocity=0.3)


def forces(run):
    return run["connection_force"].values.T


def contact_force(run, name):
    """Return a force of the contact at the samples of the probes; records give its mean over the step before."""
    return np.append(run[name].values[1:], np.nan)


@pytest.mark.parametrize("scheme", SCHEMES, ids=str)
@pytest.mark.parametrize("seed", range(3))
def test_every_connection_pushes_as_its_law_and_newtons_law_say(scheme, seed):
    random = np.random.default_rng(seed)
    a, b, c = (st.PointMass(one, name) for one, name in zip(random.uniform(0.5, 2.0, 3), "abc", strict=True))
    stiffness, coefficient, cubic = random.uniform(500.0, 3e3), random.uniform(1.0, 5.0), random.uniform(1e5, 1e6)
    table, frequency = random.uniform(2.0, 9.0, 2), random.uniform(1.0, 4.0)
    joined = [
        st.Spring(a.centre, b.centre, stiffness=stiffness),
        st.Dashpot(a.centre, coefficient=coefficient),
        st.Spring(b.centre, stiffness=1e3, offset=0.01, history=st.Harmonic(3.0)),
        st.CubicSpring(b.centre, stiffness=100.0, cubic=cubic),
        st.TabulatedDashpot(b.centre, velocity=[-1.0, 0.0, 1.0], force=[-table[0], 0.0, table[1]]),
        st.ViscoelasticSpring(a.centre, frequency=[5.0, 20.0], stiffness=[300.0, 500.0], loss_factor=[0.3, 0.3]),
        st.RigidJoint(b.centre, c.centre, axes="x"),
        st.Bushing(c.centre, b.centre, stiffness=[0.0, 2e3, 0.0], damping=[0.0, 3.0, 0.0]),
        st.Spring(c.centre, stiffness=5e3, direction=(0.6, 0.8, 0.0)),
    ]
    contact = st.PointContact(a.centre, BELT, friction=st.StaticKinetic(0.5, 0.3))
    loads = [st.Force(a.centre, y=-20.0), st.Force(c.centre, x=5.0, y=2.0, history=st.Harmonic(frequency))]
    ways = [None] * 6 + ["x", "y", None]
    probes = [st.ConnectionForce(one, way) for one, way in zip(joined, ways, strict=True)]
    for one in (a, b, c):
        probes += [kind(one.centre, way) for kind in (st.Displacement, st.Velocity, st.Acceleration) for way in "xy"]
    run = st.simulate(st.System([contact], loads, joined), 0.5, scheme=scheme, probes=probes, **EACH_STEP)
    x, v, acceleration = (run[word].values.T.reshape(3, 2, -1) for word in ("displacement", "velocity", "acceleration"))
    time, found = run.time.values, forces(run)
    skew = 0.6 * x[2, 0] + 0.8 * x[2, 1]
    laws = {
        0: -stiffness * (x[0, 0] - x[1, 0]),
        1: -coefficient * v[0, 0],
        2: 1e3 * (0.01 * np.sin(6.0 * np.pi * time) - x[1, 0]),
        3: -100.0 * x[1, 0] - cubic * x[1, 0] ** 3,
        4: -np.where(v[1, 0] > 0.0, table[1], table[0]) * v[1, 0],
        7: -2e3 * (x[2, 1] - x[1, 1]) - 3.0 * (v[2, 1] - v[1, 1]),
        8: -5e3 * skew,
    }
    for number, law in laws.items():
        np.testing.assert_allclose(found[number], law, rtol=0, atol=1e-12 * np.abs(law).max(), err_msg=str(number))
    factor = np.sin(2.0 * np.pi * frequency * time)
    pushes = [
        found[0] + found[1] + found[5] - contact_force(run, "tangential_force"),
        -found[0] + found[2] + found[3] + found[4] + found[6],
        5.0 * factor - found[6] + 0.6 * found[8],
        2.0 * factor + found[7] + 0.8 * found[8],
    ]
    moved = [a.mass * acceleration[0, 0], b.mass * acceleration[1, 0], c.mass * acceleration[2, 0]]
    moved.append(c.mass * acceleration[2, 1])
    for mass, push in zip(moved, pushes, strict=True):
        off = np.abs(mass - push)[2:-2]
        # Second differences of the exact scheme are means over two steps, which its forces need not balance at once.
        assert np.median(off) < 1e-4 * np.abs(push)[2:-2].max()
        assert np.mean(off > 2e-3 * np.abs(push)[2:-2].max()) < 0.01


def test_the_force_of_a_viscoelastic_spring_follows_its_complex_stiffness():
    mass = st.PointMass(1.0)
    soft = st.ViscoelasticSpring(mass.centre, frequency=[5.0, 20.0], stiffness=[300.0, 500.0], loss_factor=[0.3, 0.2])
    drive = st.Force(mass.centre, x=3.0, history=st.Harmonic(8.0))
    system = st.System(
        [st.PointContact(mass.centre, BELT, friction=st.Coulomb(0.0))], [drive, st.Force(mass.centre, y=-1.0)], [soft]
    )
    probes = [st.ConnectionForce(soft), st.Displacement(mass.centre, "x")]
    run = st.simulate(system, 20.0, step=1e-3, sample_rate=1e3, probes=probes)
    turned = np.exp(-16j * np.pi * run.time.values)[-10_000:]
    force, moved = (values[-10_000:] @ turned for values in (forces(run)[0], run.displacement.values[:, 0]))
    assert abs(-force / moved / soft.complex_stiffness(8.0) - 1.0) < 1e-3


@pytest.mark.parametrize("axes", [2, 3])
@pytest.mark.parametrize("seed", range(3))
def test_a_rigid_joint_of_an_elastic_body_accelerates_the_mass_that_it_carries(axes, seed):
    """The body has residual shapes, a contact and a cubic spring; Newton's law of the mass is the judge."""
    elastic = body(seed, 20, "body", axes)
    mass = st.PointMass(1.3, "mass") if axes == 2 else st.RigidBody(1.3, name="mass")
    ways = {"normal": (0.0, 1.0, 0.0), "tangent": (1.0, 0.0, 0.0)} if axes == 3 else {}
    lateral = {"lateral_velocity": 0.2} if axes == 3 else {}
    belt = st.RigidTrack(velocity=-0.2, **lateral)
    joint = st.RigidJoint(elastic.at("q"), mass.centre)
    bent = st.CubicSpring(elastic.at("r"), stiffness=1e4, cubic=1e5, direction="y")
    loads = [st.Force(elastic.at("r"), y=-300.0), st.Force(mass.centre, x=7.0, history=st.Harmonic(40.0))]
    contact = st.PointContact(elastic.at("p"), belt, friction=st.Coulomb(0.3), **ways)
    system = st.System([contact], loads, [joint, bent])
    letters = "xyz"[:axes]
    probes = [st.ConnectionForce(joint, way) for way in letters] + [
        st.Acceleration(mass.centre, way) for way in letters
    ]
    run = st.simulate(system, 0.2, scheme=st.CentralDifference(), probes=probes, **EACH_STEP)
    loaded = np.zeros((axes, run.sizes["time"]))
    loaded[0] = 7.0 * np.sin(80.0 * np.pi * run.time.values)
    known = loaded - mass.mass * run.acceleration.values.T
    found = forces(run)
    scale = np.abs(known).max()
    assert scale > 1.0
    # Contact forces belong to the step before their sample.
    off = np.abs(found - known)[:, 2:-2]
    assert np.median(off) < 1e-7 * scale
    assert np.mean(off > 1e-5 * scale) < 0.02


@pytest.mark.parametrize("seed", range(4))
def test_a_weld_to_the_ground_carries_forces_and_moments_of_loads(seed):
    random = np.random.default_rng(seed)
    place, loaded, force = random.uniform(-0.3, 0.3, (3, 3))
    block = st.RigidBody(2.0, inertia=[0.01, 0.02, 0.015], points={"bolt": place, "load": loaded})
    tip, belt = st.PointMass(0.1, "tip"), st.RigidTrack(velocity=0.1)
    weld = st.RigidJoint(block.at("bolt"), rotations=True)
    contact = st.PointContact(tip.centre, belt, friction=st.Coulomb(0.1))
    joined = [weld, st.Spring(tip.centre, block.at("load"), stiffness=1e3)]
    x, y, z = 100.0 * force
    drives = [st.Force(block.at("load"), x=x, y=y, z=z), st.Gravity(9.81)]
    probes = [st.ConnectionForce(weld, way) for way in ("x", "y", "z", "moment x", "moment y", "moment z")]
    probes.append(st.ConnectionForce(joined[1]))
    run = st.simulate(st.System([contact], drives, joined), 0.05, probes=probes)
    found = forces(run)
    push, weight = 100.0 * force[:, None] - np.outer([1.0, 0.0, 0.0], found[6]), np.array([0.0, -2.0 * 9.81, 0.0])
    turning = np.cross(loaded - place, push.T).T - np.cross(place, weight)[:, None]
    assert np.ptp(found[6]) > 0.01
    np.testing.assert_allclose(found[:3], -push - weight[:, None], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(found[3:6], -turning, rtol=1e-9, atol=1e-9)


def test_a_load_cell_shows_the_friction_that_a_direct_integration_gives():
    """A block on a belt held by a load cell: the sum of spring and dashpot, against events integrated with SciPy."""
    block, stiffness, damping = st.PointMass(0.5), 2e4, 8.0
    cell = [st.Spring(block.centre, stiffness=stiffness), st.Dashpot(block.centre, coefficient=damping)]
    contact = st.PointContact(block.centre, BELT, friction=st.Coulomb(0.4))
    system = st.System([contact], [st.Force(block.centre, y=-50.0)], cell)
    run = st.simulate(system, 0.02, step=2e-6, sample_rate=5e4, probes=[st.ConnectionForce(one) for one in cell])

    def motion(_, state):
        return [state[1], (-stiffness * state[0] - damping * state[1] + 20.0) / 0.5]

    # The belt is faster than the block throughout.
    known = scipy.integrate.solve_ivp(motion, (0.0, 0.02), [0.0, 0.0], rtol=1e-10, atol=1e-12, t_eval=run.time.values)
    assert known.y[1].max() < 0.3
    total = forces(run).sum(axis=0)
    expected = -stiffness * known.y[0] - damping * known.y[1]
    assert np.abs(total - expected)[5:].max() < 1e-3 * np.abs(expected).max()


def test_forces_are_the_same_side_by_side_and_after_a_continuation(tmp_path):
    mass = st.PointMass(1.0)
    bent = st.CubicSpring(mass.centre, stiffness=1e3, cubic=1e6)
    both = [bent, st.Dashpot(mass.centre, coefficient=2.0)]

    def system(load):
        contact = st.PointContact(mass.centre, BELT, friction=st.StaticKinetic(0.5, 0.3))
        return st.System([contact], [st.Force(mass.centre, y=-load)], both)

    asked = {"sample_rate": 1e3, "step": 1e-4, "probes": [st.ConnectionForce(one) for one in both]}
    runs = [st.simulate(system(load), 0.5, **asked) for load in (10.0, 20.0)]
    together = st.simulate_many([system(10.0), system(20.0)], 0.5, **asked)
    for one, other in zip(runs, together, strict=True):
        np.testing.assert_array_equal(forces(one), np.asarray(other["connection_force"]).T)
    first = st.simulate(system(10.0), 0.2, **asked)
    second = st.simulate(system(10.0), 0.3, start=first, **asked)
    np.testing.assert_array_equal(np.hstack([forces(first), forces(second)])[:, 50:], forces(runs[0])[:, 50:])
    st.save(runs[0], tmp_path / "run.nc")
    kept = st.load(tmp_path / "run.nc")
    np.testing.assert_array_equal(forces(kept), forces(runs[0]))
    again = st.load_scenario(kept).simulate(duration=0.5)
    np.testing.assert_array_equal(forces(again), forces(runs[0]))


def test_equal_springs_side_by_side_carry_one_share_each():
    mass = st.PointMass(1.0)
    spring = st.Spring(mass.centre, stiffness=1e3)
    contact = st.PointContact(mass.centre, BELT, friction=st.Coulomb(0.5))
    system = st.System([contact], [st.Force(mass.centre, y=-10.0)], [spring, spring])
    equal = st.Spring(mass.centre, stiffness=1e3)
    probes = [st.ConnectionForce(equal), st.Displacement(mass.centre, "x")]
    run = st.simulate(system, 0.1, sample_rate=1e3, probes=probes)
    np.testing.assert_allclose(forces(run)[0], -1e3 * run.displacement.values[:, 0], rtol=1e-12)


def test_what_is_not_determined_is_refused():
    mass, other = st.PointMass(1.0, "mass"), st.PointMass(1.0, "other")
    spring, joint = st.Spring(mass.centre, stiffness=1e3), st.RigidJoint(mass.centre, other.centre)
    contact = st.PointContact(mass.centre, BELT, friction=st.Coulomb(0.5))
    with pytest.raises(ValueError, match="component must be one in which the spring acts, got 'y'"):
        st.ConnectionForce(spring, "y")
    with pytest.raises(ValueError, match="component must be one in which the rigid joint acts, got 'moment z'"):
        st.ConnectionForce(joint, "moment z")
    with pytest.raises(ValueError, match="component must be given for a rigid joint that acts in several: one of x, y"):
        st.ConnectionForce(joint)
    with pytest.raises(ValueError, match="connection must be"):
        st.ConnectionForce(mass)
    drives = [st.Force(mass.centre, y=-1.0)]
    with pytest.raises(ValueError, match="probe must be on a connection of this system"):
        st.simulate(st.System([contact], drives, [spring]), 0.01, probes=[st.ConnectionForce(joint, "x")])
    twice = st.System([contact], drives, [spring, joint, st.RigidJoint(other.centre, mass.centre, axes="x")])
    with pytest.raises(ValueError, match="other joints prevent the same motion, got one on connections"):
        st.simulate(twice, 0.01, probes=[st.ConnectionForce(joint, "x")])
    # Along y one joint alone acts.
    st.simulate(twice, 0.01, probes=[st.ConnectionForce(joint, "y")])
    # More joints than the body has motions.
    held, *more = (st.RigidJoint(mass.centre, axes=("x", "y")) for _ in range(3))
    bolted = st.System([contact], drives, [held, *more])
    with pytest.raises(ValueError, match="other joints prevent the same motion, got one on connections"):
        st.simulate(bolted, 0.01, probes=[st.ConnectionForce(held, "x")])


def test_offsets_that_balance_each_other_are_felt_by_their_springs():
    mass, history = st.PointMass(1.0), st.Ramp(0.1)
    pair = [st.Spring(mass.centre, stiffness=1e3, offset=sign * 1e-2, history=history) for sign in (1.0, -1.0)]
    contact = st.PointContact(mass.centre, BELT, friction=st.Coulomb(0.0))
    system = st.System([contact], [st.Force(mass.centre, y=-10.0)], pair)
    run = st.simulate(system, 0.2, sample_rate=1e3, probes=[st.ConnectionForce(one) for one in pair])
    np.testing.assert_allclose(forces(run)[:, -1], [10.0, -10.0], rtol=1e-9)
