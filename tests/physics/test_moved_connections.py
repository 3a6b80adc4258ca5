"""Springs and dashpots whose ends are moved: closed forms, equilibrium, ledger, scenarios."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula.records.provenance import scenario_toml

STIFFNESS, MASS, COEFFICIENT = 4e3, 0.1, 2.0
FORCED = 60.0


def away(mass: st.PointMass, *connections: st.Spring | st.Dashpot) -> st.System:
    """A mass far from the floor."""
    return st.System(st.PointContact(mass.centre, st.RigidTrack(), gap=1.0), [], connections)


def moved(connections, duration: float = 0.5, scheme: st.ExactModal | st.CentralDifference | None = None):
    mass = st.PointMass(MASS)
    system = away(mass, *(make(mass) for make in connections))
    return st.simulate(
        system, duration, scheme=scheme or st.ExactModal(), step=1e-5, probes=[st.Displacement(mass.centre, "x")]
    )


@pytest.mark.parametrize("scheme", [st.ExactModal(), st.CentralDifference()])
def test_a_shaken_support_follows_the_closed_form(scheme):
    """A mass at rest on a spring to a ground that moves as u sin(w t)."""
    amplitude, rate, own = 1e-3, 2.0 * np.pi * FORCED, np.sqrt(STIFFNESS / MASS)
    shaken = st.Harmonic(FORCED)
    run = moved(
        [lambda mass: st.Spring(mass.centre, stiffness=STIFFNESS, offset=amplitude, history=shaken)], scheme=scheme
    )
    time = run.time.values
    forced, free = own**2 / (own**2 - rate**2), -rate / own * own**2 / (own**2 - rate**2)
    expected = amplitude * (forced * np.sin(rate * time) + free * np.sin(own * time))
    size = np.abs(expected).max()
    np.testing.assert_allclose(run.displacement.values[:, 0], expected, atol=2e-4 * size)
    assert np.abs(run.ledger_residual).max() < 1e-11 * run.attrs["largest_energy"]


def test_a_dashpot_to_a_moving_ground_carries_along():
    """The mass takes on the velocity w as 1 - exp(-c t / m)."""
    run = moved([lambda mass: st.Dashpot(mass.centre, coefficient=COEFFICIENT, velocity=0.3)])
    time, decay = run.time.values, COEFFICIENT / MASS
    expected = 0.3 * (time - (1.0 - np.exp(-decay * time)) / decay)
    np.testing.assert_allclose(run.displacement.values[:, 0], expected, rtol=1e-6, atol=1e-9)


def test_an_actuator_between_two_masses_pushes_both():
    first, second = st.PointMass(MASS, name="first"), st.PointMass(3.0 * MASS, name="second")
    system = st.System(
        [
            st.PointContact(first.centre, st.RigidTrack(), gap=1.0, name="one"),
            st.PointContact(second.centre, st.RigidTrack(), gap=1.0, name="other"),
        ],
        [],
        [st.Spring(first.centre, second.centre, stiffness=STIFFNESS, offset=1e-3)],
    )
    run = st.simulate(system, 0.2, probes=[st.Displacement(body.centre, "x") for body in (first, second)])
    one, other = run.displacement.values.T
    np.testing.assert_allclose(MASS * one + 3.0 * MASS * other, 0.0, atol=1e-12)
    own = np.sqrt(STIFFNESS / (0.75 * MASS))
    np.testing.assert_allclose(one - other, 1e-3 * (1.0 - np.cos(own * run.time)), atol=1e-9)


def test_equilibrium_includes_the_force_of_a_moved_spring():
    """A mass on a belt, pressed by a spring: N = k (offset - 0), and carried by friction against another."""
    mass = st.PointMass(MASS)
    system = st.System(
        st.PointContact(mass.centre, st.RigidTrack(velocity=0.5), friction=st.Coulomb(0.4)),
        [],
        [
            st.Spring(mass.centre, stiffness=STIFFNESS, direction="y", offset=-1e-2),
            st.Spring(mass.centre, stiffness=STIFFNESS, direction="x"),
        ],
    )
    theory = st.sliding_stability(system)
    assert float(theory.normal_force) == pytest.approx(40.0, rel=1e-12)
    run = st.simulate(
        st.System(system.contact, [st.InitialEquilibrium()], system.connections),
        0.05,
        probes=[st.Displacement(mass.centre, "x")],
    )
    np.testing.assert_allclose(run.normal_force, 40.0, rtol=1e-9)
    np.testing.assert_allclose(run.displacement[:, 0], 0.4 * 40.0 / STIFFNESS, rtol=1e-6)


def test_a_history_that_never_settles_is_reported():
    mass = st.PointMass(MASS)
    spring = st.Spring(mass.centre, stiffness=STIFFNESS, direction="y", offset=-1e-2, history=st.Harmonic(10.0))
    system = st.System(st.PointContact(mass.centre, st.RigidTrack()), [], [spring])
    with pytest.raises(st.ArgumentError, match=r"connections\[0\], which never stops varying"):
        st.sliding_stability(system)


def test_a_record_runs_again(tmp_path):
    mass = st.PointMass(MASS)
    system = away(
        mass,
        st.Spring(mass.centre, stiffness=STIFFNESS, offset=1e-3, history=st.Harmonic(FORCED)),
        st.Dashpot(mass.centre, coefficient=COEFFICIENT, velocity=0.1),
        st.Dashpot(mass.centre, coefficient=COEFFICIENT, direction="y"),
    )
    text = scenario_toml(system, [], {"duration": 0.01})
    assert text.count("offset") == 1
    assert text.count("\nvelocity = 0.1\n") == 1
    run = st.simulate(system, 0.01)
    again = st.load_scenario(run).simulate()
    np.testing.assert_array_equal(run.contact_position, again.contact_position)
    assert st.load_scenario(run).system.connections == system.connections


@pytest.mark.parametrize("wrong", [{"offset": np.nan}, {"offset": "1 mm"}, {"history": 3.0}])
def test_bad_arguments_are_refused(wrong):
    mass = st.PointMass(MASS)
    with pytest.raises(st.ArgumentError, match=next(iter(wrong))):
        st.Spring(mass.centre, stiffness=1.0, **wrong)
