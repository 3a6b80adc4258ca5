"""Beams and plates in space along which contacts move, against the plane and against equations of motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import stridula as st

from .checks import goes_on, same_side_by_side
from .into_space import IntoSpace

STEEL, STRIP = st.Material(2.1e11, 7800.0, 0.3), st.Rectangle(0.02, 0.009)
ROD = st.FiniteElementBeam(STEEL, STRIP, 0.3, angle=np.radians(-40.0), damping=0.01, cutoff=8e3, name="rod")
BEAM = st.ModalBeam(STEEL, STRIP, 0.8, damping=0.01, cutoff=6e3, name="track")
PLATE = st.ModalPlate(
    STEEL,
    0.003,
    0.6,
    0.5,
    damping=0.01,
    bending_modes=(6, 5),
    line=st.Line((0.1, 0.12), 0.5),
    name="track",
    in_plane=True,
    in_plane_modes=(1, 1),
)
TURNED = Rotation.from_rotvec([0.3, -0.7, 1.1]).as_matrix()
WORDS = {"step": 2e-6, "sample_rate": 5e4}


def rubbed(track, law=None, connections=()) -> st.System:
    """A rod that is pushed along a planar track and presses on it, moving by some millimetres."""
    contact = st.PointContact(ROD.tip, track, at=0.3, friction=law or st.Coulomb(0.3), gap=1e-5)
    push = st.Force(ROD.root, x=40.0, y=-60.0, history=st.Ramp(1e-3))
    return st.System(contact, [push], connections)


def joined(track, law=None) -> st.System:
    """The same with a spring from the track to the rod, which couples their modes."""
    return rubbed(track, law, [st.Spring(track.at(0.25), ROD.root, stiffness=2e4, direction=(0.6, 0.8, 0.0))])


def two(track, law=None) -> st.System:
    """Two masses that slide on a track, each under its own weight."""
    masses = [st.PointMass(0.2, name="first"), st.PointMass(0.3, name="second")]
    contacts = [
        st.PointContact(mass.centre, track, at=place, friction=law or st.Coulomb(0.3), gap=1e-5, name=mass.name)
        for mass, place in zip(masses, (0.2, 0.33), strict=True)
    ]
    pushed = [st.Force(mass.centre, y=-40.0, history=st.Harmonic(300.0, mean=0.6)) for mass in masses]
    return st.System(contacts, [*pushed, *(st.InitialVelocity(mass, x=0.5) for mass in masses)])


LAWS = [st.Coulomb(0.3), st.StaticKinetic(0.5, 0.3), st.LuGre(0.4, 0.3, 0.05, 2e4, 5.0, 0.1)]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
@pytest.mark.parametrize("track", [BEAM, PLATE], ids=lambda one: one.kind)
@pytest.mark.parametrize("made", [rubbed, joined, two], ids=lambda one: one.__name__)
@pytest.mark.parametrize("rotation", [np.eye(3), TURNED], ids=["upright", "turned"])
def test_results_do_not_depend_on_the_plane_of_a_track(made, track, law, rotation):
    space, flat = IntoSpace(rotation), made(track, law)
    probes = [
        st.Acceleration(track.at(0.2), "y"),
        st.Displacement(flat.slider.centre if made is two else ROD.root, "x"),
    ]
    run, known = (ask(flat, 0.006, probes=probes, **WORDS) for ask in (space.simulate, st.simulate))
    assert np.ptp(known.contact_position.values) > 1e-4
    assert int(known.landings.sum()) > 0
    assert space.across < 1e-9
    names = "normal_force", "tangential_force", "contact_position", "contact_height", "acceleration", "displacement"
    for name in (*names, "convection_work", "friction_loss"):
        size = float(np.abs(known[name]).max())
        np.testing.assert_allclose(run[name], known[name], atol=1e-7 * size)
    largest = max(float(np.abs(known[name]).max()) for name in ("drive_work", "kinetic_and_elastic"))
    assert float(np.abs(run.ledger_residual).max()) < 1e-10 * largest


def test_a_track_without_a_plane_lies_in_that_of_the_world():
    given = replace(BEAM, plane=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    runs = []
    for track in (BEAM, given):
        mass = st.RigidBody(0.3)
        contact = st.PointContact(mass.centre, track, at=0.2, friction=st.Coulomb(0.2))
        system = st.System(contact, [st.Gravity(), st.InitialVelocity(mass, x=1.0, z=0.5)])
        runs.append(st.simulate(system, 2e-3, **WORDS))
    for name in ("normal_force", "tangential_force", "contact_position"):
        np.testing.assert_allclose(runs[0][name], runs[1][name], rtol=1e-12)
    np.testing.assert_allclose(runs[0]["acceleration"], runs[1]["acceleration"], rtol=1e-9)
    assert list(runs[1].acceleration_probe.values) == ["track centre transverse"]


def test_its_rows_are_turned():
    turned = replace(PLATE, plane=(TURNED[:, 0], TURNED[:, 1]))
    for rows, known in ((turned.trace(0.2), PLATE.trace(0.2)), (turned.modes().translation, PLATE.modes().translation)):
        np.testing.assert_allclose(rows, TURNED[:, :2] @ known, atol=1e-15 * np.abs(known).max())
    assert turned.is_spatial
    assert not PLATE.is_spatial
    assert hash(turned) == hash(replace(PLATE, plane=TURNED[:, :2].T))


# Also with friction across the track.

# The weight rises in 10 ms: there is no sudden friction at the start.
MASS, WEIGHT, FRICTION, RISE = 0.3, 30.0, 0.2, 0.01
SPEED = np.array([2.0, 1.5])
LIGHT = st.ModalBeam(STEEL, st.Rectangle(0.02, 0.003), 0.8, bending_modes=2, axial_modes=0, damping=0.02)


def thrown(rotation) -> st.System:
    """A mass thrown along and across a soft beam on which it is pressed."""
    beam = replace(LIGHT, plane=(rotation[:, 0], rotation[:, 1]))
    mass = st.RigidBody(MASS)
    velocity, weight = rotation @ [SPEED[0], 0.0, SPEED[1]], rotation @ [0.0, -WEIGHT, 0.0]
    drives = [
        st.InitialVelocity(mass, **dict(zip("xyz", velocity.tolist(), strict=True))),
        st.Force(mass.centre, history=st.Ramp(RISE), **dict(zip("xyz", weight.tolist(), strict=True))),
    ]
    return st.System(st.PointContact(mass.centre, beam, at=0.2, friction=st.Coulomb(FRICTION)), drives)


def by_equations(times):
    """Place along and across, and normal force, from the equations of motion with the constraint ``y = phi(x) q``."""
    modes, path = LIGHT.modes(), LIGHT.path()
    squared, damping = modes.angular_frequency**2, modes.damping_rate
    rates = path.normal.multiples[:, 0] * path.rate[0]

    def normal_force(t, y):
        x, (q, p), v = y[0], y[4:].reshape(2, -1), y[2:4]
        shape, slope = path.normal.traces(path, x)
        bend = -(rates**2) * shape
        # y'' = shape q'' + 2 slope p x' + (bend x'² + slope x'') q = N / m - W / m, x'' = -mu N v / |v| m.
        free = shape @ (-damping * p - squared * q) + 2.0 * slope @ p * v[0] + bend @ q * v[0] ** 2
        free += WEIGHT / MASS * min(t / RISE, 1.0)
        pull = FRICTION * v[0] / np.linalg.norm(v) / MASS * (slope @ q)
        return free / (1.0 / MASS + shape @ shape + pull)

    def rate(t, y):
        (q, p), v, force = y[4:].reshape(2, -1), y[2:4], normal_force(t, y)
        shape, _ = path.normal.traces(path, y[0])
        brake = -FRICTION * force / MASS * v / np.linalg.norm(v)
        return np.concatenate([v, brake, p, -damping * p - squared * q - shape * force])

    start = np.concatenate([[0.2, 0.0], SPEED, np.zeros(2 * squared.size)])
    words = {"method": "DOP853", "t_eval": times, "rtol": 1e-11, "atol": 1e-14, "max_step": RISE / 10.0}
    found = solve_ivp(rate, (0.0, times[-1]), start, **words).y.T
    return found[:, :2], np.array([normal_force(t, y) for t, y in zip(times, found, strict=True)])


@pytest.mark.parametrize("rotation", [np.eye(3), TURNED], ids=["upright", "turned"])
@pytest.mark.parametrize("scheme", [st.CentralDifference(), st.ExactModal()], ids=lambda one: one.name)
def test_a_mass_thrown_across_a_soft_beam_moves_by_its_equations(scheme, rotation):
    """Of first order in the step, as in the plane: the force of a step acts at the place of the contact at its end."""
    errors, swings = [], []
    for step in (4e-5, 2e-5, 1e-5):
        run = st.simulate(thrown(rotation), 0.05, scheme=scheme, step=step, sample_rate=1.0 / step, probes=[])
        known, force = by_equations(run.time.values)
        errors.append(np.abs(run.contact_position.values - known).max())
        swings.append(force)
    assert np.ptp(swings[0]) > 0.5 * WEIGHT
    assert known[-1, 0] > 0.28
    assert errors[-1] < 2e-6 * (known[-1, 0] - 0.2)
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 1.0, atol=0.05)
    size = float(np.abs(run.drive_work).max() + run.attrs["initial_energy"])
    assert float(np.abs(run.ledger_residual).max()) < 1e-10 * size


def test_friction_is_along_the_slip_on_a_track():
    run = st.simulate(thrown(TURNED), 0.05, step=1e-5, sample_rate=1e5, probes=[])
    slip, pulled = run.slip_velocity.values[5:], run.tangential_force.values[5:]
    size = np.hypot(*pulled.T)
    np.testing.assert_allclose(size, FRICTION * run.normal_force.values[5:], rtol=1e-9)
    across = np.abs(slip[:, 0] * pulled[:, 1] - slip[:, 1] * pulled[:, 0]) / (np.hypot(*slip.T) * size)
    assert across.max() < 1e-3
    assert np.degrees(np.ptp(np.arctan2(slip[:, 1], slip[:, 0]))) < 1.0


# Records, restart, runs side by side, the ends, sound.


def test_a_run_continues_and_runs_again(tmp_path):
    system, names = thrown(TURNED), ("normal_force", "tangential_force", "contact_position", "acceleration")
    whole, *_, again = goes_on(system, 0.02, names, tmp_path, step=2e-5, sample_rate=5e4)
    assert again.system == system
    np.testing.assert_array_equal(again.simulate().normal_force, whole.normal_force)
    plate = IntoSpace(TURNED).system(rubbed(PLATE))[0]
    assert st.load_scenario(st.simulate(plate, 1e-4, **WORDS)).system.contacts == plate.contacts


def test_runs_side_by_side_are_those_alone():
    systems = [thrown(Rotation.random(random_state=seed).as_matrix()) for seed in range(9)]
    names = ("normal_force", "tangential_force", "contact_position")
    same_side_by_side(systems, 5e-3, names, step=2e-5, sample_rate=5e4, probes=[])


def test_a_tip_leaves_at_the_end():
    system = replace(SYSTEM, contact=replace(SYSTEM.contact, at=0.75))
    run = st.simulate(system, 0.1, step=2e-5, sample_rate=5e3, probes=[])
    assert run.attrs["ended"] == "off the track"
    assert float(run.contact_position[-1, 0]) == pytest.approx(LIGHT.length, abs=1e-3)


@pytest.mark.parametrize("baffled", [True, False])
def test_a_track_in_space_sounds_as_in_the_plane(baffled):
    flat, turned = rubbed(BEAM), IntoSpace(TURNED).system(rubbed(BEAM))[0]
    listener = (0.3, 0.1, 0.7)
    known, found = (
        st.radiate(st.simulate(system, 0.01, **WORDS), system.track, listener, baffled=baffled)
        for system in (flat, turned)
    )
    np.testing.assert_allclose(found, known, atol=1e-8 * float(np.abs(known).max()))


SYSTEM = thrown(TURNED)
REFUSED = {
    "no unit vectors": (lambda: replace(BEAM, plane=((2.0, 0.0, 0.0), (0.0, 1.0, 0.0))), "plane must be unit vectors"),
    "slanted": (lambda: replace(PLATE, plane=((1.0, 0.0, 0.0), (0.8, 0.6, 0.0))), "plane must be unit vectors"),
    "one vector": (lambda: replace(BEAM, plane=(1.0, 0.0, 0.0)), "plane must be unit vectors"),
    "a normal": (lambda: replace(SYSTEM.contact, normal=(0.0, 1.0, 0.0)), "normal must be left out on a beam"),
    "a tangent": (lambda: replace(SYSTEM.contact, tangent=(1.0, 0.0, 0.0)), "tangent must be left out on a beam"),
    "a film": (lambda: st.plot.animate(SYSTEM, "film.gif"), "system must be in the plane, or have a SolidBody"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_arguments_are_refused(case):
    make, words = REFUSED[case]
    with pytest.raises(st.ArgumentError, match=f"^{words}"):
        make()
