"""Rigid joints and bushings against closed forms, wholes of their parts, and equations with multipliers."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stridula as st
from stridula.linear.structure import Structure

STEEL = st.Material(2.1e11, 7800.0, 0.3)
BELT = st.RigidTrack(velocity=0.5)
ONE_MASS, TWO_MASSES = [st.PointMass(1.3)], [st.PointMass(0.5, "a"), st.PointMass(0.8, "b")]


def beam(length, elements, angle=0.0, tip="free", root="free", name="", **words):
    section = st.Rectangle(0.02, 0.009)
    return st.FiniteElementBeam(
        STEEL, section, length, angle, elements, root_support=root, tip_support=tip, name=name, **words
    )


def frequencies(system, least=1.0):
    found = np.sort(st.sliding_stability(system)["frequency"].values)
    return found[found > least]


def pressed(body, friction=0.0, track=BELT, load=0.0, place="tip"):
    """A contact that is open, so that the bodies are free of it, and with it their modes."""
    return st.PointContact(body.tip if place == "tip" else body.centre, track, friction=st.Coulomb(friction), gap=1.0)


def modes_of(system):
    """Natural frequencies [Hz] of a system without its contacts."""
    structure = Structure(system)
    moving = structure.mass > 0.0
    squared = np.linalg.eigvalsh(structure.stiffness[np.ix_(moving, moving)])
    return np.sqrt(np.maximum(squared, 0.0)) / (2.0 * np.pi)


@pytest.mark.parametrize("angle", [0.0, 0.7])
@pytest.mark.parametrize("share", [5, 2])
def test_welded_parts_of_a_beam_equal_the_whole(angle, share):
    """The elements are the same, and so are all frequencies, of the free beam and of the clamped one."""
    whole = beam(0.5, 10, angle, root="clamped")
    first = beam(0.05 * share, share, angle, name="first")
    second = beam(0.05 * (10 - share), 10 - share, angle, root="clamped", name="second")
    weld = st.RigidJoint(first.root, second.tip, rotations=True)
    joined = modes_of(st.System(pressed(first), [], [weld]))
    alone = modes_of(st.System(pressed(whole), []))
    np.testing.assert_allclose(joined[-alone.size :], alone, rtol=1e-7)
    assert not joined[: -alone.size].any()


def test_a_pin_leaves_the_beam_a_hinge():
    """Two clamped halves pinned together at their ends, against matrices of the same elements with a hinge."""
    left, right = beam(0.25, 6, tip="clamped", name="left"), beam(0.25, 6, root="clamped", name="right")
    pin = st.RigidJoint(left.root, right.tip)
    found = modes_of(st.System(pressed(right), [], [pin]))
    rows = np.hstack([left.trace(0.25), -right.trace(0.0)])
    squared = np.concatenate([body.modes().angular_frequency ** 2 for body in (left, right)])
    free = scipy.linalg.null_space(rows)
    expected = np.sqrt(np.maximum(np.linalg.eigvalsh((free.T * squared) @ free), 0.0)) / (2.0 * np.pi)
    np.testing.assert_allclose(found[-expected.size :], expected, rtol=1e-8)
    welded = modes_of(st.System(pressed(right), [], [st.RigidJoint(left.root, right.tip, rotations=True)]))
    assert found[found > 0.0][0] < 0.9 * welded[welded > 0.0][0]


def test_parts_below_a_cutoff_come_nearer_from_above():
    """Modes below a cutoff are too stiff at a joint, and less so the more there are."""

    def hinged(cutoff):
        first, second = (
            beam(0.2, 40, name="first", cutoff=cutoff),
            beam(0.3, 60, root="clamped", name="second", cutoff=cutoff),
        )
        found = modes_of(st.System(pressed(first), [], [st.RigidJoint(first.root, second.tip)]))
        return found[found > 1.0][:4]

    exact = hinged(None)
    coarse, fine = hinged(2e3) / exact - 1.0, hinged(8e3) / exact - 1.0
    assert (fine > -1e-9).all()
    assert (fine < 0.5 * coarse).all()
    assert coarse.max() < 0.02


def reduced(body, at, name, **words):
    """The matrices of a beam with points of it, its modes below a cutoff."""
    modes = body.modes()
    rows = {point: body.trace(place) for point, place in at.items()}
    return st.ReducedBody(np.eye(modes.count), np.diag(modes.angular_frequency**2), points=rows, name=name, **words)


def test_residual_flexibility_yields_at_a_joint():
    """The static flexibility of the modes left out yields at a joint: the error falls with a higher order."""
    first, second = beam(0.2, 20, name="first"), beam(0.3, 30, root="clamped", name="second")
    exact = modes_of(st.System(pressed(first), [], [st.RigidJoint(first.root, second.tip)]))
    exact = exact[exact > 1.0][:4]

    def error(cutoff, flexible):
        words = {"cutoff": cutoff, "residual_flexibility": flexible}
        one = reduced(first, {"tip": 0.0, "root": 0.2}, "first", **words)
        two = reduced(second, {"tip": 0.0}, "second", **words)
        contact = st.PointContact(one.at("tip"), BELT, gap=1.0)
        found = modes_of(st.System(contact, [], [st.RigidJoint(one.at("root"), two.at("tip"))]))
        return (found[found > 1.0][:4] / exact - 1.0).max()

    assert error(2e3, True) < 0.2 * error(2e3, False)
    assert error(8e3, True) < 0.02 * error(2e3, True)


@pytest.mark.parametrize("seed", range(4))
def test_masses_on_a_joint_slide_as_one(seed):
    """Stick-slip of two joined masses is that of one with both masses, to round-off; a third joint changes nothing."""
    random = np.random.default_rng(seed)
    sizes = random.uniform(0.2, 2.0, 3)
    masses = [st.PointMass(size, f"mass {k}") for k, size in enumerate(sizes)]
    stiffness, load, law = random.uniform(5.0, 80.0), random.uniform(3.0, 15.0), st.StaticKinetic(0.5, 0.3)
    joints = [st.RigidJoint(masses[0].centre, masses[k].centre) for k in (1, 2)]
    joints += [st.RigidJoint(masses[1].centre, masses[2].centre)] * (seed % 2)

    def run(sliding, held, pushed, more):
        system = st.System(
            st.PointContact(sliding.centre, BELT, friction=law),
            [st.Force(pushed.centre, y=-load)],
            [st.Spring(held.centre, stiffness=stiffness), *more],
        )
        return st.simulate(system, 10.0, step=1e-3, probes=[st.Displacement(held.centre, "x")])

    apart, one = run(*masses, joints), st.PointMass(sizes.sum())
    whole = run(one, one, one, [])
    assert np.abs(whole["displacement"]).max() > 1e-2
    np.testing.assert_allclose(apart["displacement"].values, whole["displacement"].values, atol=1e-9)
    assert float(np.abs(apart["ledger_residual"]).max()) < 1e-9


def multipliers(matrix, rows, force):
    """Acceleration under forces and the forces of joints, ``M a = f + J^T l``, ``J a = 0``."""
    size = len(rows)
    together = np.block([[matrix, rows.T], [rows, np.zeros((size, size))]])
    return np.linalg.lstsq(together, np.concatenate([force, np.zeros(size)]), rcond=None)[0][: len(matrix)]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("scheme", [st.ExactModal(), st.CentralDifference()], ids=["exact", "central"])
def test_joined_bodies_move_as_with_multipliers(seed, scheme):
    """Two rigid bodies in space and a mass, with springs, a bushing and a joint in some directions, by SciPy."""
    random = np.random.default_rng(seed)
    corner = {"corner": tuple(random.uniform(-0.1, 0.1, 3))}
    one = st.RigidBody(random.uniform(0.5, 2.0), random.uniform(2e-3, 8e-3, 3), corner, "one")
    two = st.RigidBody(random.uniform(0.5, 2.0), random.uniform(2e-3, 8e-3, 3), {"side": (0.03, -0.02, 0.05)}, "two")
    axes, turning = [("x", "y", "z"), ("x", "z"), ("y",)][seed % 3], bool(seed % 2)
    joint = st.RigidJoint(one.at("corner"), two.at("side"), axes=axes, rotations=turning)
    mount = st.Bushing(
        two.centre,
        stiffness=random.uniform(2e3, 9e3, 3),
        damping=random.uniform(0.0, 9.0, 3),
        rotational_stiffness=random.uniform(5.0, 20.0, 3),
        rotational_damping=random.uniform(0.0, 0.02, 3),
    )
    between = st.Bushing(one.centre, two.centre, stiffness=(900.0, 0.0, 300.0), rotational_stiffness=(3.0, 0.0, 1.0))
    grounded = st.Bushing(one.centre, stiffness=(400.0, 500.0, 600.0), rotational_stiffness=(2.0, 2.0, 2.0))
    push = st.Force(one.at("corner"), x=3.0, y=-1.0, z=2.0, history=st.Harmonic(7.0))
    contact = st.PointContact(one.centre, st.RigidTrack(), gap=1.0)
    probes = [
        st.Displacement(body.at(point), axis) for body, point in ((one, "corner"), (two, "side")) for axis in "xyz"
    ]
    system = st.System(contact, [push], [joint, mount, between, grounded])
    run = st.simulate(system, 0.6, step=2e-4, sample_rate=5e3, scheme=scheme, probes=probes)

    def point(body, place):
        own = np.hstack([np.eye(3), -crossed(place)])
        return np.hstack([own, np.zeros((3, 6))] if body is one else [np.zeros((3, 6)), own])

    turns = np.hstack([np.zeros((3, 3)), np.eye(3), np.zeros((3, 6))]), np.hstack([np.zeros((3, 9)), np.eye(3)])
    at_one, at_two = point(one, np.array(corner["corner"])), point(two, np.array([0.03, -0.02, 0.05]))
    chosen = ["xyz".index(axis) for axis in axes]
    rows = (at_one - at_two)[chosen]
    rows = np.vstack([rows, (turns[0] - turns[1])[chosen]]) if turning else rows
    mass = np.diag([*[one.mass] * 3, *np.diag(inertia(one)), *[two.mass] * 3, *np.diag(inertia(two))])
    stiffness, damping = np.zeros((2, 12, 12))
    centres = point(one, np.zeros(3)), point(two, np.zeros(3))
    for bushing, along, about in (
        (mount, centres[1], turns[1]),
        (between, centres[0] - centres[1], turns[0] - turns[1]),
        (grounded, centres[0], turns[0]),
    ):
        stiffness += (along.T * bushing.stiffness) @ along + (about.T * bushing.rotational_stiffness) @ about
        damping += (along.T * bushing.damping) @ along + (about.T * bushing.rotational_damping) @ about
    pushed = at_one.T @ np.array([3.0, -1.0, 2.0])

    def rates(t, y):
        q, v = y.reshape(2, -1)
        return np.concatenate(
            [v, multipliers(mass, rows, pushed * np.sin(14.0 * np.pi * t) - stiffness @ q - damping @ v)]
        )

    times = run["time"].values
    exact = solve_ivp(rates, (0.0, times[-1]), np.zeros(24), "DOP853", times, rtol=1e-9, atol=1e-12).y[:12]
    expected = np.vstack([at_one @ exact, at_two @ exact])
    found = run["displacement"].values.T
    assert np.abs(found - expected).max() < 2e-4 * np.abs(expected).max()
    np.testing.assert_allclose(found[chosen], found[[3 + k for k in chosen]], atol=1e-12 * np.abs(found).max())


def crossed(place):
    x, y, z = place
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def inertia(body):
    return np.diag(np.asarray(body.inertia)) if np.ndim(body.inertia) == 1 else np.asarray(body.inertia)


def test_a_mass_bolted_to_a_beam_lowers_its_frequency_as_the_closed_form():
    """A pinned beam with a mass in its middle: roots of ``tan b - tanh b = 2 m_beam / (m b)`` for its half."""
    bar = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.009), 1.0, bending_modes=60, axial_modes=0)
    mass = st.PointMass(0.5)
    own = STEEL.density * bar.section.area * bar.length
    stiffness = STEEL.young * bar.section.second_moment
    joint = st.RigidJoint(mass.centre, bar.at(0.5), axes="y")
    found = modes_of(st.System(pressed(mass, place="centre"), [], [joint]))
    found = found[found > 1.0]

    def residual(b):
        return np.tan(b) - np.tanh(b) - 2.0 * own / (0.5 * b)

    for number, (low, high) in enumerate([(0.1, 1.57), (3.2, 4.712)]):
        b = brentq(residual, low, high)
        exact = (2.0 * b / bar.length) ** 2 * np.sqrt(stiffness * bar.length / own) / (2.0 * np.pi)
        # Every other mode has a node in the middle.
        assert found[2 * number] == pytest.approx(exact, rel=2e-3)


def test_linear_theory_and_the_start_know_the_joint():
    """Mode coupling of a slider in two joined parts is that of the slider in one."""

    def slider(parts):
        springs = [
            st.Spring(parts[0].centre, stiffness=1000.0),
            st.Spring(parts[0].centre, stiffness=900.0, direction=(1.0, 1.0, 0.0)),
            st.Spring(parts[-1].centre, stiffness=600.0, direction="y"),
        ]
        joints = [st.RigidJoint(parts[0].centre, parts[1].centre)] if len(parts) > 1 else []
        return st.System(
            st.PointContact(parts[-1].centre, BELT, friction=st.Coulomb(0.6), stiffness=800.0),
            [st.Force(parts[0].centre, y=-20.0), st.InitialEquilibrium()],
            [*springs, *joints],
        )

    whole = st.sliding_stability(slider(ONE_MASS))
    apart = st.sliding_stability(slider(TWO_MASSES))
    for name in ("growth_rate", "frequency"):
        np.testing.assert_allclose(np.sort(apart[name]), np.sort(whole[name]), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(apart["tip_displacement"], whole["tip_displacement"], rtol=1e-9)
    np.testing.assert_allclose(apart["energy_share"].sum("body"), 1.0, rtol=1e-9)
    np.testing.assert_allclose(apart["energy_share"].sel(body="a"), 0.5 / 1.3, rtol=1e-9)
    runs = [st.simulate(slider(parts), 0.05)["normal_force"] for parts in (ONE_MASS, TWO_MASSES)]
    np.testing.assert_allclose(runs[1], runs[0], rtol=1e-12)
    np.testing.assert_allclose(runs[1], runs[1].mean(), rtol=1e-7)


def stick_slip(parts):
    joints = [st.RigidJoint(parts[0].centre, parts[1].centre)] if len(parts) > 1 else []
    track = st.RigidTrack(velocity=0.2)
    contact = st.PointContact(parts[-1].centre, track, friction=st.StaticKinetic(0.6, 0.3))
    spring = st.Spring(parts[0].centre, stiffness=60.0)
    return st.System(contact, [st.Force(parts[0].centre, y=-10.0)], [spring, *joints])


def test_cycles_are_those_of_the_whole():
    systems = [stick_slip(parts) for parts in (ONE_MASS, TWO_MASSES)]
    whole, apart = (st.limit_cycle(system, st.simulate(system, 12.0)) for system in systems)
    assert float(apart["frequency"]) == pytest.approx(float(whole["frequency"]), rel=1e-6)


def test_derivatives_of_modes_are_those_of_the_whole():
    """By springs and friction, and by the mass of each part as by that of the whole."""

    def slider(parts):
        joints = [st.RigidJoint(parts[0].centre, parts[1].centre)] if len(parts) > 1 else []
        return st.System(
            st.PointContact(parts[-1].centre, BELT, friction=st.Coulomb(0.5), stiffness=800.0),
            [st.Force(parts[0].centre, y=-20.0), st.InitialEquilibrium()],
            [
                st.Spring(parts[0].centre, stiffness=1000.0, direction=(1.0, 1.0, 0.0)),
                st.Dashpot(parts[0].centre, coefficient=3.0),
                st.Spring(parts[-1].centre, stiffness=700.0, direction="y"),
                *joints,
            ],
        )

    whole, apart = (st.mode_sensitivity(slider(parts)) for parts in (ONE_MASS, TWO_MASSES))
    for parameter in whole["parameter"].values.tolist():
        others = ["bodies.a.mass", "bodies.b.mass"] if "mass" in parameter else [parameter]
        for name in ("d_frequency", "d_growth_rate"):
            expected = whole[name].sel(parameter=parameter).values
            for other in others:
                found = apart[name].sel(parameter=other).values
                np.testing.assert_allclose(found, expected, rtol=1e-6, atol=1e-9)


def test_sound_from_forces_is_refused():
    first = beam(0.2, 5, name="first")
    second = beam(0.3, 5, root="clamped", name="second")
    track = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.009), 1.1, damping=0.01, cutoff=1.5e3)
    contact = st.PointContact(first.tip, track, at=0.5)
    joint = st.RigidJoint(first.root, second.tip, rotations=True)
    system = st.System(contact, [st.Force(first.root, y=-1.0)], [joint])
    run = st.simulate(system, 0.01)
    with pytest.raises(ValueError, match="system must have no rigid joint, whose forces are in no record"):
        st.radiate(run, system, [(0.5, 0.5, 1.0)])


def test_a_run_continues_bit_by_bit_and_can_be_run_again():
    one, two = st.PointMass(0.5, "a"), st.PointMass(0.8, "b")
    contact = st.PointContact(two.centre, BELT, friction=st.StaticKinetic(0.5, 0.3))
    mount = st.Bushing(one.centre, stiffness=(50.0, 0.0, 0.0), damping=(0.1, 0.0, 0.0))
    joint = st.RigidJoint(one.centre, two.centre, axes=["x", "y"])
    system = st.System(contact, [st.Force(one.centre, y=-8.0)], [mount, joint])
    words = {"step": 1e-3, "sample_rate": 1e3, "probes": [st.Displacement(one.centre, "x")]}
    whole = st.simulate(system, 2.0, **words)
    rest = st.simulate(system, 1.0, start=st.simulate(system, 1.0, **words), **words)
    np.testing.assert_array_equal(whole["displacement"].values[-rest.sizes["time"] :], rest["displacement"].values)
    again = st.load_scenario(whole).simulate()
    np.testing.assert_array_equal(again["displacement"], whole["displacement"])


def two_masses(joint_of, drives=(), contacts=None):
    one, two = st.PointMass(0.5, "a"), st.PointMass(0.8, "b")
    contact = contacts(one, two) if contacts else st.PointContact(two.centre, BELT)
    return st.System(contact, [d(one, two) for d in drives], [joint_of(one, two)])


def test_a_start_that_parts_the_joint_is_refused():
    def together(one, two):
        return st.RigidJoint(one.centre, two.centre)

    alone = two_masses(together, [lambda one, _: st.InitialVelocity(one, x=1.0)])
    with pytest.raises(ValueError, match="drives must move bodies with a rigid joint together at the start"):
        st.simulate(alone, 0.1)
    both = [lambda one, _: st.InitialVelocity(one, x=1.0), lambda _, two: st.InitialVelocity(two, x=1.0)]
    system = two_masses(together, both)
    run = st.simulate(system, 0.5, step=1e-3, probes=[st.Displacement(system.bodies[0].centre, "x")])
    assert float(run["displacement"][-1, 0]) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("joint", "words"),
    [
        (lambda a, b: st.RigidJoint(a.centre, b.centre, axes="z"), "act along x and y and about z alone"),
        (lambda a, b: st.RigidJoint(a.centre, b.centre, rotations=True), "act on rotations only of beams and of rigid"),
        (lambda a, b: st.Bushing(a.centre, b.centre, stiffness=(1.0, 1.0, 1.0)), "act along x and y and about z alone"),
        (lambda a, b: st.Spring(a.centre, b.centre, stiffness=1.0, direction="z"), "act along x and y and about z"),
    ],
)
def test_connections_that_cannot_act_are_refused(joint, words):
    with pytest.raises(ValueError, match=rf"^connections\[0\] must {words}"):
        two_masses(joint)


def test_a_joint_to_a_track_with_a_path_is_refused():
    bar, mass = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.009), 1.0, cutoff=1e3), st.PointMass(0.1)
    contact = st.PointContact(mass.centre, bar, at=0.5)
    with pytest.raises(ValueError, match=r"^connections\[0\] must not be a rigid joint of a body along which"):
        st.System(contact, [], [st.RigidJoint(mass.centre, bar.at(0.3))])


def pad_on_piston(joined, named=True, friction=0.45):
    """A lined block on a plane, its back on a rigid piston at eight nodes by a function of two points."""
    mesh = st.SolidMesh.block((0.08, 0.016, 0.04), (4, 1, 2))
    places = {
        f"p{k}": (x, 0.016, z) for k, (x, z) in enumerate((x, z) for x in (0.0, 0.02, 0.06, 0.08) for z in (0.0, 0.04))
    }
    steel = st.Material(2e11, 7800.0, 0.3)
    pad = st.SolidBody(mesh, steel, points=places if named else {}, cutoff=12e3, contact_faces=["bottom"], name="pad")
    offsets = {name: (x - 0.04, 0.0, z - 0.02) for name, (x, _, z) in places.items()}
    piston = st.RigidBody(0.6, [3e-4, 5e-4, 3e-4], offsets, "piston")
    ends = [(piston.at(name), pad.at(name if named else places[name])) for name in places]
    held = [st.Spring(piston.centre, stiffness=2e7, direction=way) for way in ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0))]
    face = st.SurfaceContact(pad, "bottom", st.RigidTrack(velocity=2.0), friction=st.Coulomb(friction), stiffness=1e11)
    return st.System(face, [st.Force(piston.centre, y=-2000.0)], [*held, *(joined(*pair) for pair in ends)])


def test_a_pad_on_a_piston_is_the_limit_of_stiff_mounts():
    """Linear theory with joints is that with mounts of ever larger stiffness, and nothing grows without bound."""
    joined = st.sliding_stability(pad_on_piston(st.RigidJoint))

    def mounted(stiffness):
        return st.sliding_stability(pad_on_piston(lambda one, two: st.Bushing(one, two, stiffness=[stiffness] * 3)))

    def pitches(found):
        frequency = np.sort(found["frequency"].values)
        return frequency[(frequency > 10.0) & (frequency < 8e3)]

    expected = pitches(joined)
    assert expected.size >= 5
    apart = [np.abs(pitches(mounted(stiffness)) / expected - 1.0).max() for stiffness in (1e9, 1e12)]
    assert apart[1] < 1e-3 < apart[0]
    assert float(joined["growth_rate"].max()) < 1e4


def test_a_joint_where_a_solid_does_not_yield_is_refused():
    """Its contacts would lose their flexibility to it; a lone mass rides on what there is."""
    with pytest.raises(
        ValueError, match=r"must be at points at which pad yields: name them in its points, got one at \(0"
    ):
        pad_on_piston(st.RigidJoint, named=False)
    mounted = pad_on_piston(lambda one, two: st.Bushing(one, two, stiffness=[1e9] * 3), named=False)
    pad = mounted.bodies[0]
    heavier = st.modify(mounted, masses=[(pad.at((0.04, 0.016, 0.02)), 0.05)])
    assert len(st.sliding_stability(heavier)["mode"]) > 6


def test_growth_without_bound_is_noted(monkeypatch):
    """The same joints without the check: parts without mass grow, faster than anything vibrates."""
    monkeypatch.setattr("stridula.system.check_connections", lambda system: None)
    brake = st.load_scenario("brake").system
    pistons = []
    for pad, sign in zip((body for body in brake.bodies if "pad" in body.name), (1.0, -1.0), strict=True):
        spread = [(x, z) for x in (-0.03, -0.01, 0.01, 0.03) for z in (0.088, 0.1, 0.112)]
        offsets = {f"p{k}": (x, 0.0, z - 0.1) for k, (x, z) in enumerate(spread)}
        places = {f"p{k}": (x, sign * 0.026, z) for k, (x, z) in enumerate(spread)}
        piston = st.RigidBody(0.6, [3e-4, 5e-4, 3e-4], offsets, f"on {pad.name}")
        pistons += [st.RigidJoint(piston.at(name), pad.at(place)) for name, place in places.items()]
        pistons += [st.Spring(piston.centre, stiffness=1e6, direction=way) for way in "xz"]
    found = st.sliding_stability(st.modify(brake, connections=pistons))
    assert "faster than any mode that is kept vibrates" in found.attrs["notes"]
    assert "faster than" not in st.sliding_stability(brake).attrs["notes"]


def test_a_bushing_along_one_axis_is_drawn():
    mass = st.PointMass(2.0)
    mount = st.Bushing(mass.centre, stiffness=[50.0, 0.0, 0.0])
    figure = st.plot.system(st.System(st.PointContact(mass.centre, st.RigidTrack()), [], [mount]))
    words = " ".join(text.get_text() for text in figure.findobj(match=lambda one: hasattr(one, "get_text")))
    assert "bushing 50, 0, 0 N/m along x, y, z" in words


def test_joints_and_bushings_are_drawn_and_named():
    one, two = st.PointMass(0.5, "a"), st.PointMass(0.8, "b")
    contact = st.PointContact(two.centre, BELT)
    joints = [st.RigidJoint(one.centre, two.centre), st.Bushing(one.centre, stiffness=(50.0, 20.0, 0.0))]
    system = st.System(contact, [], joints)
    figure = st.plot.system(system)
    words = " ".join(text.get_text() for text in figure.findobj(match=lambda one: hasattr(one, "get_text")))
    assert "rigid joint along x, y, z" in words
    assert "bushing 50, 20, 0 N/m along x, y, z" in words
    assert "joined   rigid joint along x, y, z from a to b" in str(system)
