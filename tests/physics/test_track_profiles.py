"""Masses on tracks with a profile, against closed forms and against SciPy's integration of the same equations."""

from __future__ import annotations

import numpy as np
import pytest
from kernels.systems import SYSTEMS
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import stridula as st
from physics.into_space import IntoSpace

MASS, LOAD = 0.2, 20.0
AMPLITUDE, WAVELENGTH = 5e-6, 0.02
WAVE = 2 * np.pi / WAVELENGTH
TOP = st.Profile.sine(AMPLITUDE, WAVELENGTH, np.pi / 2)


def on_belt(profile, speed, *, friction=0.0, at=0.0, held=None, start=None, **contact) -> st.System:
    """A mass pressed on a belt, held by a spring along it where there is friction."""
    mass = st.PointMass(MASS)
    track = st.RigidTrack(velocity=speed, profile=profile)
    touch = st.PointContact(mass.centre, track, at=at, friction=st.Coulomb(friction), **contact)
    joints = [] if held is None else [st.Spring(mass.centre, stiffness=held)]
    drives = [st.Force(mass.centre, y=-LOAD)]
    if start is not None:
        drives.append(st.InitialState(mass, *start))
    return st.System(touch, drives, joints)


def sampled_every_step(system, duration, step=None, **settings):
    """The run at its default step, or at another, with each step a sample."""
    if step is None:
        step = st.simulate(system, 1e-3, probes=[], sample_rate=1e3).attrs["step"]
    return st.simulate(system, duration, step=step, sample_rate=1 / step, probes=[], **settings)


def checked(run):
    """A run whose laws hold at every step, and whose ledger is closed."""
    terms = ("kinetic_and_elastic", "drive_work", "contact_work", "friction_loss", "convection_work")
    largest = max(float(np.abs(run[name]).max()) for name in terms)
    assert float(np.abs(run.ledger_residual).max()) <= 1e-12 * largest
    assert float(run.normal_force.min()) >= 0.0
    return run


# Contact with a stiffness: excitation of the base through the spring of the contact.

STIFFNESS, DASHPOT = 1e6, 20.0


def excited(step=None, speed=1.0):
    """Largest relative error of the steady response of a mass on its contact, in amplitude and phase together."""
    angular = WAVE * speed
    # The height under the mass is that of the sine at -speed t.
    amplitude = 2e-7
    response = (STIFFNESS + 1j * angular * DASHPOT) / (STIFFNESS - MASS * angular**2 + 1j * angular * DASHPOT)
    rise, rate = (amplitude * np.imag(-response * (1j * angular) ** k) for k in range(2))
    start = ((0.0, rise - LOAD / STIFFNESS), (0.0, rate))
    yields = st.LinearStiffness(STIFFNESS, DASHPOT)
    system = on_belt(st.Profile.sine(amplitude, WAVELENGTH), speed, stiffness=yields, start=start)
    run = checked(sampled_every_step(system, 0.05, step))
    time = run.time.values
    expected = amplitude * np.imag(-response * np.exp(1j * angular * time)) - LOAD / STIFFNESS
    moved = run.contact_height.values
    assert np.ptp(moved) > 1.9 * amplitude * abs(response)
    assert float(run.normal_force.min()) > 0.0
    return np.abs(moved - expected).max() / (amplitude * abs(response))


@pytest.mark.parametrize("speed", [1.0, 5.0, 7.0, 12.0])
def test_base_excitation_through_a_contact(speed):
    """Below, near and above the resonance at 7.1 m/s; at the default step, which the profile decides at 12 m/s."""
    assert excited(speed=speed) < 1e-3


def test_base_excitation_converges_at_second_order_or_better():
    errors = [excited(step, speed=5.0) for step in (2e-4, 1e-4)]
    assert errors[1] < errors[0] / 3.5


# Rigid contact: the mass follows the surface.


def followed(step=None, speed=0.5):
    """Largest error of the normal force, relative to its change, on a mass that follows the surface of a belt."""
    run = checked(sampled_every_step(on_belt(TOP, speed), 0.05, step))
    h = float(run.attrs["step"])
    # The force of a sample acts at the beginning of its last step.
    force = LOAD - MASS * speed**2 * AMPLITUDE * WAVE**2 * np.cos(WAVE * speed * (run.time.values - h))
    assert float(np.abs(run.gap).max()) < 1e-17
    height = AMPLITUDE * np.cos(WAVE * speed * run.time.values)
    np.testing.assert_allclose(run.contact_height.values, height, atol=1e-3 * AMPLITUDE)
    return np.abs(run.normal_force.values - force).max() / np.ptp(force)


def test_mass_follows_the_surface_without_losing_contact():
    assert followed() < 1e-3


def test_force_on_a_surface_converges_at_second_order():
    """From a step at which the force has errors well above those of the spline."""
    errors = [followed(step) for step in (2e-3, 1e-3)]
    assert errors[1] < errors[0] / 3.5


def test_work_of_the_surface_is_the_energy_of_the_mass():
    """Without friction and damping all that the surface gives is kinetic energy and work against the load."""
    run = sampled_every_step(on_belt(TOP, 0.5), 0.013)
    given = float(run.convection_work[-1])
    assert given == pytest.approx(float(run.contact_work[-1]), rel=1e-9)
    assert abs(float(run.impact_loss[-1])) < 1e-9 * LOAD * AMPLITUDE
    lowered = AMPLITUDE * (1 - np.cos(WAVE * 0.5 * 0.013))
    assert given == pytest.approx(-LOAD * lowered, rel=1e-2)


def test_lift_off_and_flight_against_scipy():
    """Above 14.2 m/s the mass leaves the crests; the flight ends where it meets the surface again."""
    speed = 17.0
    angular = WAVE * speed
    assert MASS * angular**2 * AMPLITUDE > LOAD

    def height(t):
        return -AMPLITUDE * np.cos(angular * t)

    # From the trough on the load and the inertia balance at the crest side.
    leaves = np.arccos(-LOAD / (MASS * angular**2 * AMPLITUDE)) / angular

    def meets(t, y):
        return y[0] - height(t) if t > leaves + 1e-5 else 1.0

    meets.terminal, meets.direction = True, -1.0
    at = [height(leaves), AMPLITUDE * angular * np.sin(angular * leaves)]
    flight = solve_ivp(
        lambda t, y: [y[1], -LOAD / MASS], (leaves, 1.0), at, events=meets, rtol=1e-11, atol=1e-16, max_step=1e-6
    )
    lands = float(flight.t_events[0][0])
    trough = st.Profile.sine(AMPLITUDE, WAVELENGTH, -np.pi / 2)
    system = on_belt(trough, speed)
    run = checked(sampled_every_step(system, 1.3 * lands))
    time, h, apart = run.time.values, float(run.attrs["step"]), run.gap.values > 1e-15
    first = time[apart.argmax()]
    again = time[apart.argmax() + np.argmin(apart[apart.argmax() :])]
    assert leaves < first <= leaves + 2 * h
    assert lands <= again <= lands + 2 * h
    inside = (time > leaves) & (time < lands)
    expected = solve_ivp(
        lambda t, y: [y[1], -LOAD / MASS], (leaves, lands), at, t_eval=time[inside], rtol=1e-11, atol=1e-16
    ).y[0]
    # A lift-off within a step leaves a velocity that is wrong by at most half its jerk times the square of the step.
    slack = 0.5 * AMPLITUDE * angular**3 * h**2 * (time[inside] - leaves + h)
    assert np.all(np.abs(run.contact_height.values[inside] - expected) < slack)


# Other systems.


@pytest.mark.parametrize("name", ["mass on a rough belt", "mass thrown over a dip"])
def test_profiles_in_space_are_those_of_the_plane(name):
    """The height varies along the first tangent, whatever the direction of the plane."""
    make, step = SYSTEMS[name]
    flat, settings = make(), {"step": step, "sample_rate": 1 / step, "probes": []}
    expected = st.simulate(flat, 0.05, **settings)
    turned = IntoSpace(Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix())
    run = turned.simulate(flat, 0.05, **settings)
    assert float(expected.convection_work[-1]) != 0.0
    for name in ("contact_height", "normal_force", "contact_position", "convection_work"):
        scale = float(np.abs(expected[name]).max())
        np.testing.assert_allclose(run[name], expected[name], rtol=0, atol=1e-6 * scale)


def test_a_slow_tip_follows_a_dip_between_springs():
    """Pressed by springs alone, slowly over a dip: the force follows the depth."""
    mass = st.PointMass(MASS)
    dip = st.Profile(np.linspace(0.01, 0.03, 5), [0.0, -1e-5, -2e-5, -1e-5, 0.0])
    contact = st.PointContact(mass.centre, st.RigidTrack(velocity=-0.1, profile=dip))
    joints = [st.Spring(mass.centre, stiffness=1e5), st.Spring(mass.centre, stiffness=1e5, direction="y")]
    run = checked(st.simulate(st.System(contact, [st.Force(mass.centre, y=-LOAD)], joints), 0.4, probes=[]))
    depth = dip.height_at(0.1 * run.time.values)
    np.testing.assert_allclose(run.contact_height, depth, atol=1e-9)
    np.testing.assert_allclose(run.normal_force, LOAD + 1e5 * depth, atol=1e-2)


# Random profiles, with friction.

MU, SPRING = 0.3, 2e4


def rough_reference(profile, speed, yields, duration, times):
    """Displacements along and across, and velocities, of a mass on a rough belt, by SciPy."""

    def force(t, x, y, u, w):
        place, slip = x - speed * t, u - speed
        over = profile.height_at(place) - y
        return max(STIFFNESS * over + DASHPOT * (profile.slope_at(place) * slip - w), 0.0) if over > 0.0 else 0.0

    def rates(t, z):
        x, y, u, w = z
        if yields:
            normal = force(t, x, y, u, w)
            return [u, w, (-SPRING * x + MU * normal) / MASS, (normal - LOAD) / MASS]
        place, slip = x - speed * t, u - speed
        slope, bend = profile.slope_at(place), profile._spline(np.mod(place, profile.place[-1]), 2)
        # The mass follows the surface, whose height changes with its own acceleration along it.
        free = (-SPRING * x + MU * (LOAD + MASS * bend * slip**2)) / MASS
        along = free / (1.0 - MU * slope)
        return [u, w, along, slope * along + bend * slip**2]

    height, slope = float(profile.height_at(0.0)), float(profile.slope_at(0.0))
    start = [0.0, height - LOAD / STIFFNESS, 0.0, 0.0] if yields else [0.0, height, 0.0, -slope * speed]
    solved = solve_ivp(rates, (0.0, duration), start, t_eval=times, rtol=1e-9, atol=1e-13, max_step=1e-5)
    return start, solved.y


def rough_error(seed, speed, yields, step=None, duration=0.02):
    """Largest errors along and across, relative to the largest motions, of a mass on a rough belt."""
    profile = st.Profile.random(2e-6, 5e-3, 0.1, seed=seed)
    start = rough_reference(profile, speed, yields, 0.0, None)[0]
    given = {"stiffness": st.LinearStiffness(STIFFNESS, DASHPOT)} if yields else {}
    # Displacements are those from the surface under the mass at the start.
    state = ((start[0], start[1] - float(profile.height_at(0.0))), (start[2], start[3]))
    system = on_belt(profile, speed, friction=MU, held=SPRING, start=state, **given)
    run = checked(sampled_every_step(system, duration, step))
    x, y, *_ = rough_reference(profile, speed, yields, float(run.time[-1]), run.time.values)[1]
    if not yields:
        np.testing.assert_allclose(y, surface := profile.height_at(x - speed * run.time.values), atol=1e-11)
        y = surface
    assert float(run.normal_force.min()) > 0.0
    assert np.all(run.tangential_force.values >= -MU * run.normal_force.values * (1 + 1e-12))
    bent = y - y.mean()
    wrong = [run.contact_position.values - x, run.contact_height.values - y]
    return [np.abs(one).max() / np.abs(all_).max() for one, all_ in zip(wrong, (x, bent), strict=True)]


@pytest.mark.parametrize("yields", [True, False], ids=["yielding", "rigid"])
@pytest.mark.parametrize(("seed", "speed"), [(0, 0.5), (1, 1.0), (2, 2.0), (3, 1.5)])
def test_rough_belts_against_scipy(seed, speed, yields):
    assert max(rough_error(seed, speed, yields)) < 1e-3


@pytest.mark.parametrize("yields", [True, False], ids=["yielding", "rigid"])
def test_rough_belts_converge_at_second_order(yields):
    steps = (2e-4, 1e-4) if yields else (8e-4, 4e-4)
    coarse, fine = (np.array(rough_error(1, 1.0, yields, step)) for step in steps)
    assert np.all(fine < coarse / 3.3)
