"""Measured friction: tables and users' formulas in a run, in linear theory and beside the laws that they sample."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st
from physics.own_friction import OwnStribeck, Polymer

STRIBECK = st.Stribeck(0.5, 0.3, 0.05)


def on_a_belt(law, mass=0.5, stiffness=900.0, load=5.0, belt=0.03):
    body = st.PointMass(mass)
    contact = st.PointContact(body.centre, st.RigidTrack(velocity=belt), friction=law)
    return st.System(contact, [st.Force(body.centre, y=-load)], [st.Spring(body.centre, stiffness=stiffness)])


def from_event_to_event(law, mass, stiffness, load, belt, times):
    """Place of a mass at rest on a belt, by DOP853 from stop to start to stop, at some times."""
    holds, place, velocity, time, stuck, sense = float(law.coefficient_at(0.0)) * load, 0.0, 0.0, 0.0, False, -1.0
    found = np.full(times.shape, np.nan)
    while time < times[-1]:
        if stuck:
            until = time + (holds - stiffness * place) / (stiffness * belt)
            here = (times >= time) & (times <= until)
            found[here] = place + belt * (times[here] - time)
            place, time, stuck, sense = place + belt * (until - time), until, False, -1.0
            continue
        begun = time

        def rates(_, y, sense=sense):
            slip = max(abs(y[1] - belt), 1e-300)
            return [y[1], (-stiffness * y[0] - sense * float(law.coefficient_at(slip)) * load) / mass]

        def stops(now, y, sense=sense, begun=begun):
            return (y[1] - belt) * sense if now > begun + 1e-9 else 1.0

        stops.terminal, stops.direction = True, -1
        start, span = [place, velocity], (time, times[-1])
        slide = solve_ivp(rates, span, start, "DOP853", rtol=1e-11, atol=1e-14, events=stops, dense_output=True)
        here = (times >= time) & (times <= slide.t[-1])
        found[here] = slide.sol(times[here])[0]
        place, velocity, time = slide.y[0, -1], belt, slide.t[-1]
        stuck, sense = abs(stiffness * place) <= holds, -np.sign(place)
    return found


@pytest.mark.parametrize("seed", range(10))
def test_a_mass_on_a_belt_under_a_random_table_moves_as_from_event_to_event(seed):
    """At default settings, over eight periods of slip, and of stick and slip."""
    random = np.random.default_rng(seed)
    top, count = 10.0 ** random.uniform(-1.0, 1.0), random.integers(3, 12)
    speeds, values = [0.0, *np.sort(random.uniform(0.0, top, count))], random.uniform(0.1, 0.6, count + 1)
    law = st.TabulatedFriction(speeds, values, max(values[0], random.uniform(0.3, 0.7)))
    mass, stiffness, load = random.uniform(0.5, 2.0), 10.0 ** random.uniform(2.0, 4.0), random.uniform(5.0, 50.0)
    belt = 0.3 * top * random.uniform(0.05, 0.8)
    system = on_a_belt(law, mass, stiffness, load, belt)
    run = st.simulate(
        system, 16.0 * np.pi * np.sqrt(mass / stiffness), probes=[st.Displacement(system.bodies[0].centre, "x")]
    )
    expected = from_event_to_event(law, mass, stiffness, load, belt, run["time"].values)
    found = run["displacement"].values[:, 0]
    assert np.abs(found - expected).max() < 1e-6 * np.ptp(expected)


def test_an_own_law_moves_as_the_law_of_the_package():
    own = OwnStribeck(0.5, 0.3, 0.05)
    runs = [st.simulate(on_a_belt(law), 1.0, step=1e-4) for law in (own, STRIBECK)]
    assert {1.0, 2.0} <= set(np.unique(runs[0]["status"]))
    for name in ("tangential_force", "slip_velocity"):
        one, other = (run[name].values for run in runs)
        assert np.abs(one - other).max() < 1e-7 * np.abs(other).max()


def places(law, belt):
    system = on_a_belt(law, belt=belt)
    run = st.simulate(system, 0.5, step=1e-4, probes=[st.Displacement(system.bodies[0].centre, "x")])
    return run["displacement"].values[:, 0]


def test_a_table_approaches_the_law_that_it_samples():
    """The error of monotone cubic interpolation falls with the square of the distance of the points, or faster."""
    exact, errors = places(STRIBECK, 0.1), []
    for points in (20, 40, 80, 160):
        speeds = np.linspace(0.0, 0.25, points)
        table = st.TabulatedFriction(speeds, STRIBECK.coefficient_at(speeds))
        errors.append(np.abs(places(table, 0.1) - exact).max() / np.ptp(exact))
    assert errors[-1] < 1e-5
    assert (np.log2(np.divide(errors[:-1], errors[1:])) > 2.0).all()


@pytest.mark.parametrize("law", [Polymer(0.3, 0.2, 0.05), st.TabulatedFriction([0.0, 0.1, 0.4], [0.5, 0.35, 0.3])])
@pytest.mark.parametrize("belt", [0.02, 0.1, 0.3])
def test_growth_in_a_run_is_that_of_linear_theory(law, belt):
    """A small vibration about steady sliding grows, or decays, as the slope of the law says."""
    mass, stiffness, load = 0.5, 9e4, 5.0
    system = on_a_belt(law, mass, stiffness, load, belt)
    (growth,) = st.sliding_stability(system)["growth_rate"].values[:1]
    slope = float(law.coefficient_at(belt * (1.0 + 1e-7)) - law.coefficient_at(belt * (1.0 - 1e-7))) / (2e-7 * belt)
    assert growth == pytest.approx(-slope * load / (2.0 * mass), rel=1e-4, abs=1e-6)
    body = st.PointMass(mass)
    contact = st.PointContact(body.centre, st.RigidTrack(velocity=belt), friction=law)
    place = float(law.coefficient_at(belt)) * load / stiffness + 1e-5 * belt / np.sqrt(stiffness / mass)
    drives = [st.Force(body.centre, y=-load), st.InitialState(body, displacement=(place, 0.0))]
    small = st.System(contact, drives, [st.Spring(body.centre, stiffness=stiffness)])
    run = st.simulate(small, 0.4, step=2e-5, sample_rate=5e4)
    slip = run["slip_velocity"].values + belt
    time = run["time"].values
    ends = [
        np.sqrt(np.mean(slip[(time > a) & (time <= a + 10 * 2 * np.pi * np.sqrt(mass / stiffness))] ** 2))
        for a in (0.0, 0.2)
    ]
    assert np.log(ends[1] / ends[0]) / 0.2 == pytest.approx(growth, rel=1e-2, abs=1e-3)


def test_one_table_serves_many_contacts_and_runs_side_by_side():
    """Runs of tables of different lengths march side by side as alone."""
    laws = [st.TabulatedFriction(np.linspace(0.0, 0.2, n), np.linspace(0.5, 0.3, n) + 0.01 * n) for n in range(2, 12)]
    systems = [on_a_belt(law) for law in laws]
    together = st.simulate_many(systems, 0.2)
    for system, run in zip(systems, together, strict=True):
        alone = st.simulate(system, 0.2)
        np.testing.assert_allclose(run["tangential_force"], alone["tangential_force"], rtol=1e-12, atol=1e-12)


def test_a_slip_beyond_the_table_is_noted():
    system = on_a_belt(st.TabulatedFriction([0.0, 0.01, 0.05], [0.5, 0.4, 0.3]), belt=0.2)
    notes = st.simulate(system, 0.01).attrs["notes"]
    assert "slid at up to 0.2 m/s, but its friction was measured up to 0.05 m/s" in notes
    inside = on_a_belt(st.TabulatedFriction([0.0, 0.01, 0.5], [0.5, 0.4, 0.3]), belt=0.2)
    assert "measured" not in st.simulate(inside, 0.01).attrs["notes"]


@pytest.mark.parametrize("law", [st.TabulatedFriction([0.0, 0.02, 0.1], [0.5, 0.4, 0.35]), Polymer(0.3, 0.1, 0.05)])
@pytest.mark.parametrize("rate", [{}, {"surface_rate": "all"}])
def test_a_face_under_measured_friction_slides_on_its_curve(law, rate):
    """In space, with the points of a face solved together, recorded as a face or point by point."""
    lining = st.Material(1e9, 2000.0, 0.3)
    pad = st.SolidBody.block((0.06, 0.02, 0.03), (4, 1, 2), lining, cutoff=2e4, damping=0.3, contact_faces=["bottom"])
    face = st.SurfaceContact(pad, "bottom", st.RigidTrack(velocity=0.3), friction=law, stiffness=2e11, name="lining")
    held = [st.Spring(pad.at("top"), stiffness=1e6, direction=way) for way in "xz"]
    system = st.System([face], [st.Force(pad.at("top"), y=-500.0), st.InitialEquilibrium()], held)
    run = st.simulate(system, 4e-3, **rate)
    last = run.isel(time=-1)
    pushed = float(last["tangential_force"].sel(tangent="first").sum())
    assert abs(pushed) / float(last["normal_force"].sum()) == pytest.approx(float(law.coefficient_at(0.3)), rel=1e-3)
    beyond = "slid at up to 0.3 m/s, but its friction was measured up to 0.1 m/s"
    assert (beyond in run.attrs["notes"]) == isinstance(law, st.TabulatedFriction)
