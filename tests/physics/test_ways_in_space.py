"""Slips that turn in the tangent plane under falling laws, against their equations of motion."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st

MASS, SPRING, WEIGHT, TURNING, RADIUS = 0.5, 2e3, 30.0, 40.0, 0.02
LAWS = {
    "coulomb": st.Coulomb(0.3),
    "stribeck": st.Stribeck(0.5, 0.3, 0.4, viscous=0.05),
    "exponential": st.ExponentialWeakening(0.5, 0.3, 0.3),
    "linear": st.LinearWeakening(0.5, 0.2, 0.3),
    "static-kinetic": st.StaticKinetic(0.5, 0.3),
}


def rider(law, start, width, length=RADIUS) -> st.System:
    """A mass pressed on a table, on springs whose other ends go round in an ellipse; `start` are place and velocity."""
    body = st.RigidBody(MASS)
    contact = st.PointContact(body.centre, st.RigidTrack(), friction=law)
    springs = [
        st.Spring(
            body.centre,
            stiffness=SPRING,
            direction=axis,
            offset=size,
            history=st.Harmonic(TURNING / (2.0 * pi), phase=phase),
        )
        for axis, size, phase in (("x", length, 0.5 * pi), ("z", width, 0.0))
    ]
    placed = st.InitialState(body, (start[0], 0.0, start[1]), (start[2], 0.0, start[3]))
    return st.System(contact, [st.Force(body.centre, y=-WEIGHT), placed], springs)


def by_equations(law, start, width, duration):
    """Place and velocity of a rider that slides all the time, as a function of time."""

    def rate(t, y):
        speed = np.hypot(*y[2:])
        friction = WEIGHT * float(law.coefficient_at(speed)) * y[2:] / speed
        pulled = SPRING * (np.array([RADIUS * cos(TURNING * t), width * sin(TURNING * t)]) - y[:2])
        return np.concatenate([y[2:], (pulled - friction) / MASS])

    return solve_ivp(rate, (0.0, duration), start, "DOP853", dense_output=True, rtol=1e-11, atol=1e-14).sol


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_a_rider_that_slides_round_an_ellipse_moves_by_its_equations(law):
    """2e-3 of its radius in 78 steps a round, the default, and of second order, as under Coulomb's law."""
    width, period = 0.6 * RADIUS, 2.0 * pi / TURNING
    before = np.array([RADIUS, 0.0, 0.0, TURNING * width])
    start = by_equations(law, before, width, 3.0 * period)(3.0 * period)
    moved = by_equations(law, start, width, 2.0 * period)
    speeds = np.hypot(*moved(np.linspace(0.0, 2.0 * period, 500))[2:])
    assert speeds.max() > 1.3 * speeds.min()

    def error(**own):
        run = st.simulate(rider(law, start, width), 2.0 * period, sample_rate=500.0, probes=[], **own)
        assert (run.status.values == 2).all()
        return np.abs(run.contact_position.values - moved(run.time.values)[:2].T).max() / RADIUS

    assert error() < 2e-3
    coarse, fine = error(step=1e-3), error(step=5e-4)
    assert 3.5 < coarse / fine < 4.6


@pytest.mark.parametrize(
    ("name", "length", "width", "allowed"),
    [("stribeck", 0.45, 0.1, (0.012, 0.001)), ("static-kinetic", 0.5, 0.03, (0.02, 0.005))],
)
def test_a_rider_that_stops_and_turns_does_not_depend_on_the_step(name, length, width, allowed):
    """It sticks at both ends of a narrow ellipse, and starts in other directions; at 80 and 320 steps a period."""
    law, length, width, period = LAWS[name], length * RADIUS, width * RADIUS, 2.0 * pi / TURNING

    def path(step):
        system = rider(law, np.zeros(4), width, length)
        run = st.simulate(system, 4.0 * period, step=step, sample_rate=80.0 / period, probes=[])
        assert run.status_share.sel(contact_status="sticking").values[20:].max() > 0.5
        ratio = np.linalg.norm(run.tangential_force.values, axis=1) / run.normal_force.values
        assert ratio.max() <= 1.01 * law.static
        return run.contact_position.values

    known = path(period / 8000.0)
    for steps, share in zip((80, 320), allowed, strict=True):
        assert np.abs(path(period / steps) - known).max() < share * length
