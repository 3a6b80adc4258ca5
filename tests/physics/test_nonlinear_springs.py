"""Nonlinear springs against integrations of the same equations, and against contacts that do the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

import stridula as st

FAST = st.RigidTrack(velocity=50.0)


def held_by(spring_of, mass, friction=0.0, load=1.0, drives=(), track=FAST):
    """A mass on a belt that never sticks, held along it by springs, the results of a function of its centre."""
    contact = st.PointContact(mass.centre, track, friction=st.Coulomb(friction))
    return st.System(contact, [st.Force(mass.centre, y=-load), *drives], spring_of(mass.centre))


def random_spring(random, point, second=None, **words):
    """A cubic spring, or a table of kinks about the start, in turn."""
    if random.random() < 0.5:
        stiffness = random.choice([0.0, random.uniform(-500.0, 2000.0)])
        return st.CubicSpring(point, second, stiffness=stiffness, cubic=10.0 ** random.uniform(4.0, 7.0), **words)
    places = np.sort(random.uniform(-0.05, 0.05, random.integers(2, 8)))
    forces = np.cumsum(random.uniform(0.0, 30.0, places.size))
    return st.TabulatedSpring(
        point, second, displacement=places, force=forces - np.interp(0.0, places, forces), **words
    )


def motion(rates, start, times, kinks=1e-3):
    return solve_ivp(
        rates, (0.0, times[-1]), start, method="DOP853", rtol=1e-11, atol=1e-13, t_eval=times, max_step=kinks
    ).y


@pytest.mark.parametrize("seed", range(12))
def test_a_mass_moves_as_its_equation_says(seed):
    """Under a constant friction, from rest or with a velocity, at the default step."""
    random = np.random.default_rng(seed)
    mass, load, velocity = st.PointMass(random.uniform(0.5, 2.0)), random.uniform(1.0, 5.0), random.uniform(-1.0, 1.0)
    springs = [random_spring(random, mass.centre) for _ in range(1 + seed % 2)]
    system = held_by(lambda _: springs, mass, 0.3, load, [st.InitialVelocity(mass, x=velocity)])
    run = st.simulate(system, 1.0, probes=[st.Displacement(mass.centre, "x")])
    times, found = run["time"].values, run["displacement"].values[:, 0]

    def rates(_, y):
        return [y[1], (0.3 * load - sum(one.pull(y[0]) for one in springs)) / mass.mass]

    place, speed = motion(rates, [0.0, velocity], times)
    assert np.abs(found - place).max() < 1e-5 * np.abs(place).max()
    stored = [
        0.5 * mass.mass * speed[k] ** 2 + sum(energy(one, place[k]) for one in springs) for k in (99, 100, -2, -1)
    ]
    kept = run["kinetic_and_elastic"].values
    # It is that half a step ago.
    np.testing.assert_allclose(kept[[100, -1]], np.reshape(stored, (2, 2)).mean(axis=1), atol=1e-6 * np.abs(kept).max())
    assert np.abs(run["ledger_residual"]).max() < 1e-9 * run["kinetic_and_elastic"].max()


def energy(spring, stretch):
    """Energy stored in a spring by its pull [J]."""
    return quad(spring.pull, 0.0, stretch, limit=400)[0]


@pytest.mark.parametrize("seed", range(4))
def test_two_masses_and_the_ground(seed):
    """A spring between two bodies, in both schemes; stick-slip of both against SciPy is left to the twin."""
    random = np.random.default_rng(100 + seed)
    one, two = st.PointMass(random.uniform(0.5, 2.0), "one"), st.PointMass(random.uniform(0.5, 2.0), "two")
    between, ground = random_spring(random, one.centre, two.centre), random_spring(random, two.centre)
    contacts = [st.PointContact(body.centre, FAST, friction=st.Coulomb(0.2), name=body.name) for body in (one, two)]
    drives = [st.Force(one.centre, y=-2.0), st.Force(two.centre, y=-3.0), st.InitialVelocity(one, x=0.8)]
    scheme = [st.ExactModal(), st.CentralDifference()][seed % 2]
    probes = [st.Displacement(body.centre, "x") for body in (one, two)]
    run = st.simulate(st.System(contacts, drives, [between, ground]), 0.6, scheme=scheme, probes=probes)

    def rates(_, y):
        inner, outer = between.pull(y[0] - y[1]), ground.pull(y[1])
        return [y[2], y[3], (0.4 - inner) / one.mass, (0.6 + inner - outer) / two.mass]

    found = motion(rates, [0.0, 0.0, 0.8, 0.0], run["time"].values)[:2]
    assert np.abs(run["displacement"].values.T - found).max() < 1e-5 * np.abs(found).max()


def test_the_error_falls_with_the_square_of_the_step():
    mass = st.PointMass(1.0)
    spring = st.CubicSpring(mass.centre, stiffness=100.0, cubic=1e6)
    system = held_by(lambda _: [spring], mass, drives=[st.InitialVelocity(mass, x=0.5)])
    errors = []
    for step in (4e-4, 2e-4, 1e-4):
        run = st.simulate(system, 0.8, step=step, sample_rate=1.0 / step, probes=[st.Displacement(mass.centre, "x")])
        exact = motion(lambda _, y: [y[1], -spring.pull(y[0])], [0.0, 0.5], run["time"].values)[0]
        errors.append(np.abs(run["displacement"].values[:, 0] - exact).max())
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2.0, atol=0.1)


def test_a_play_is_that_of_two_contacts_with_a_stiffness():
    """Between two walls that yield a mass moves as on a spring with a play, with the contacts' own solution."""
    mass, stiffness, play = st.PointMass(0.2), 3e4, 1e-3
    thrown = [st.InitialVelocity(mass, x=0.4)]
    table = [-2.0 * play, -play, play, 2.0 * play]
    force = [-stiffness * play, 0.0, 0.0, stiffness * play]
    bumped = held_by(lambda at: [st.TabulatedSpring(at, displacement=table, force=force)], mass, drives=thrown)
    walls = [
        st.PointContact(
            mass.centre, st.RigidTrack(), inclination=side * np.pi / 2, gap=play, stiffness=stiffness, name=name
        )
        for name, side in (("left", -1.0), ("right", 1.0))
    ]
    words = {"step": 2e-6, "sample_rate": 1e4, "probes": [st.Displacement(mass.centre, "x")]}
    spring = st.simulate(bumped, 0.1, **words)["displacement"].values
    between = st.simulate(st.System(walls, thrown), 0.1, **words)["displacement"].values
    assert np.abs(spring).max() > 1.5 * play
    assert np.abs(spring - between).max() < 1e-5 * np.abs(spring).max()


def test_a_beam_with_a_stop_moves_as_its_modes_do():
    """The modes of a track with a stop and a hardening spring, under a force, integrated by SciPy."""
    beam = st.ModalBeam(st.Material(2.1e11, 7800.0, 0.3), st.Rectangle(0.02, 0.009), 1.1, damping=0.01, cutoff=1.5e3)
    stop = st.TabulatedSpring(beam.at(0.4), direction="y", displacement=[-1e-4, -2e-5, 0.0], force=[-40.0, 0.0, 0.0])
    hard = st.CubicSpring(beam.at(0.7), direction="y", stiffness=2e3, cubic=5e13)
    mass = st.PointMass(0.1)
    contact = st.PointContact(mass.centre, beam, at=0.5, gap=1.0)
    push = st.Force(beam.at(0.3), y=-20.0, history=st.Harmonic(60.0))
    system = st.System(contact, [push], [stop, hard])
    run = st.simulate(system, 0.1, probes=[st.Displacement(beam.at(0.4), "y")])
    modes = beam.modes()
    w, d = modes.angular_frequency, modes.damping_rate
    at_stop, at_hard, at_push = (beam.trace(x)[1] for x in (0.4, 0.7, 0.3))

    def rates(t, y):
        q, v = y.reshape(2, -1)
        pulled = stop.pull(at_stop @ q) * at_stop + hard.pull(at_hard @ q) * at_hard
        return np.concatenate([v, -d * v - w**2 * q - pulled - 20.0 * np.sin(2.0 * np.pi * 60.0 * t) * at_push])

    times = run["time"].values
    exact = at_stop @ motion(rates, np.zeros(2 * w.size), times, 1e-4)[: w.size]
    assert exact.min() < -4e-5
    assert np.abs(run["displacement"].values[:, 0] - exact).max() < 2e-3 * np.abs(exact).max()


@pytest.mark.parametrize("seed", range(6))
def test_the_equilibrium_is_that_of_the_forces(seed):
    """Sliding on a belt: the pull balances friction; a run stays there; linear theory has the stiffness there."""
    random = np.random.default_rng(200 + seed)
    mass = st.PointMass(random.uniform(0.5, 2.0))
    spring = random_spring(random, mass.centre)
    pull = 0.3 * 20.0
    stretch = brentq(lambda s: spring.pull(s) - pull, -100.0, 100.0, xtol=1e-15)
    system = held_by(lambda _: [spring], mass, 0.3, 20.0, [st.InitialEquilibrium()])
    found = st.sliding_stability(system)
    assert float(found["tip_displacement"].sel(direction="x").squeeze()) == pytest.approx(stretch, rel=1e-9)
    tangent = (spring.pull(stretch + 1e-7) - spring.pull(stretch - 1e-7)) / 2e-7
    expected = np.sqrt(max(tangent, 0.0) / mass.mass) / (2.0 * np.pi)
    assert float(found["frequency"].max()) == pytest.approx(expected, rel=1e-5, abs=1e-9)
    run = st.simulate(system, 0.2, probes=[st.Displacement(mass.centre, "x")])
    np.testing.assert_allclose(run["displacement"].values, stretch, rtol=1e-9)


def test_the_middle_of_a_double_well_is_an_equilibrium_that_grows():
    """Stiffness below zero at the start, about which the search begins; a run leaves it for a well."""
    mass = st.PointMass(1.0)
    spring = st.CubicSpring(mass.centre, stiffness=-400.0, cubic=1e6)
    system = held_by(
        lambda at: [spring, st.Dashpot(at, coefficient=20.0)], mass, drives=[st.Force(mass.centre, x=1e-3)]
    )
    found = st.sliding_stability(system)
    assert float(found["tip_displacement"].sel(direction="x").squeeze()) == pytest.approx(-2.5e-6, rel=1e-3)
    # The root of r² + 20 r - 400.
    assert float(found["growth_rate"].max()) == pytest.approx(-10.0 + np.sqrt(500.0), rel=1e-6)
    run = st.simulate(system, 4.0, step=1e-4, probes=[st.Displacement(mass.centre, "x")])
    well = brentq(lambda s: spring.pull(s) - 1e-3, 0.01, 0.03)
    assert float(run["displacement"][-1, 0]) == pytest.approx(well, rel=1e-6)


def test_a_step_that_is_too_long_is_named():
    mass = st.PointMass(1.0)
    system = held_by(
        lambda at: [st.CubicSpring(at, stiffness=100.0, cubic=1e8)], mass, drives=[st.InitialVelocity(mass, x=3.0)]
    )
    with pytest.raises(
        st.Diverged, match="too long for the slope that a nonlinear spring or dashpot has reached"
    ) as stopped:
        st.simulate(system, 1.0, step=5e-3)
    assert stopped.value.record.attrs["ended"] == "spring too stiff"
    times = st.simulate(system, 0.2, step=1e-5, probes=[st.Displacement(mass.centre, "x")])
    exact = motion(lambda _, y: [y[1], -100.0 * y[0] - 1e8 * y[0] ** 3], [0.0, 3.0], times["time"].values)[0]
    assert np.abs(times["displacement"].values[:, 0] - exact).max() < 1e-3 * np.abs(exact).max()


def springs_of(k):
    """The same mass on springs of several shapes."""
    mass = st.PointMass(1.0)
    kinds = [
        st.CubicSpring(mass.centre, stiffness=100.0 + 10.0 * k, cubic=1e6),
        st.TabulatedSpring(mass.centre, displacement=[-0.01, 0.0, 0.002 * (k + 1), 0.03], force=[-1.0, 0.0, 0.1, 4.0]),
    ]
    return held_by(lambda _: kinds, mass, 0.2, 3.0, [st.InitialVelocity(mass, x=0.3)])


def test_runs_side_by_side_are_those_alone():
    systems = [springs_of(k) for k in range(8)]
    words = {"step": 1e-4, "probes": [st.Displacement(systems[0].bodies[0].centre, "x")]}
    together = st.simulate_many(systems, 0.2, **words)
    for system, found in zip(systems, together, strict=True):
        alone = st.simulate(system, 0.2, **words)
        np.testing.assert_allclose(found["displacement"], alone["displacement"], rtol=0.0, atol=1e-12)


def test_a_run_continues_bit_by_bit_and_can_be_run_again():
    system = springs_of(2)
    words = {"step": 1e-4, "probes": [st.Displacement(system.bodies[0].centre, "x")]}
    whole = st.simulate(system, 0.2, **words)
    first = st.simulate(system, 0.1, **words)
    rest = st.simulate(system, 0.1, start=first, **words)
    np.testing.assert_array_equal(whole["displacement"].values[-rest.sizes["time"] :], rest["displacement"].values)
    np.testing.assert_allclose(rest["kinetic_and_elastic"][-1], whole["kinetic_and_elastic"][-1], rtol=1e-9)
    again = st.load_scenario(whole).simulate()
    np.testing.assert_array_equal(again["displacement"], whole["displacement"])


def test_a_limit_cycle_with_a_hardening_spring_is_that_of_the_equation():
    """Stick-slip of a mass on a hardening spring, found directly, has the period of an integration by events."""
    mass, belt = st.PointMass(1.0), st.RigidTrack(velocity=0.2)
    spring = st.CubicSpring(mass.centre, stiffness=50.0, cubic=2e3)
    contact = st.PointContact(mass.centre, belt, friction=st.StaticKinetic(0.6, 0.3))
    system = st.System(contact, [st.Force(mass.centre, y=-10.0)], [spring])
    cycle = st.limit_cycle(system, st.simulate(system, 12.0))
    assert 1.0 / float(cycle["frequency"]) == pytest.approx(stick_slip_period(spring, 1.0, 0.2, 6.0, 3.0), rel=1e-3)


def stick_slip_period(spring, mass, speed, holds, slides):
    """Period [s] of a mass that sticks to a belt until its spring pulls more than friction holds, then slips."""
    begin = brentq(lambda s: spring.pull(s) - holds, 0.0, 10.0)

    def rates(_, y):
        return [y[1], (slides - spring.pull(y[0])) / mass]

    def stops(_, y):
        return y[1] - speed

    stops.terminal, stops.direction = True, 1.0
    slip = solve_ivp(rates, (0.0, 100.0), [begin, speed - 1e-12], events=stops, rtol=1e-11, atol=1e-13, max_step=1e-2)
    return slip.t[-1] + (begin - slip.y[0, -1]) / speed


def test_sound_from_forces_is_refused():
    beam = st.ModalBeam(st.Material(2.1e11, 7800.0, 0.3), st.Rectangle(0.02, 0.009), 1.1, damping=0.01, cutoff=1.5e3)
    mass = st.PointMass(0.1)
    hard = st.CubicSpring(beam.at(0.7), direction="y", stiffness=2e3, cubic=1e8)
    system = st.System(st.PointContact(mass.centre, beam, at=0.5), [st.Force(mass.centre, y=-1.0)], [hard])
    run = st.simulate(system, 0.05)
    with pytest.raises(ValueError, match="linear springs"):
        st.radiate(run, system, [(0.5, 0.5, 1.0)])


def test_a_changed_spring_is_another_one():
    mass = st.PointMass(1.0)
    spring = st.TabulatedSpring(mass.centre, displacement=[0.0, 1.0], force=[1.0, 2.0])
    assert replace(spring, force=[1.0, 3.0]) != spring
    assert spring.pull(0.0) == 1.0
    assert spring.pull(-1.0) == 0.0


def test_drawings_name_the_stiffness_at_rest():
    figure = st.plot.system(springs_of(0))
    words = " ".join(text.get_text() for text in figure.findobj(match=lambda one: hasattr(one, "get_text")))
    assert "cubic spring 100 N/m at rest" in words
    assert "tabulated spring 50 N/m at rest" in words
