"""Friction that depends on the pressure: in runs from event to event, in equilibria and in linear theory."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st

AREA = 2e-4
SPEEDS, PRESSURES = [0.0, 0.01, 0.05, 0.2], [1e4, 5e4, 2e5]
FALLING = st.TabulatedFriction(
    SPEEDS, [[0.6, 0.5, 0.42, 0.4], [0.5, 0.42, 0.36, 0.33], [0.42, 0.36, 0.3, 0.28]], pressure=PRESSURES
)


def drawn(seed: int):
    """A law, and a mass on a spring and a belt under a load that varies through its pressures."""
    random = np.random.default_rng(seed)
    top = 10.0 ** random.uniform(-1.0, 0.0)
    speeds = [0.0, *np.sort(random.uniform(0.0, top, 4)).tolist()]
    pressures = np.cumsum(random.uniform(1e4, 1e5, 3))
    values = random.uniform(0.15, 0.5, (3, 5))
    statics = np.maximum(values[:, 0], random.uniform(0.3, 0.7, 3))
    law = st.TabulatedFriction(speeds, values.tolist(), statics.tolist(), pressures.tolist())
    mass, stiffness = random.uniform(0.5, 2.0), 10.0 ** random.uniform(2.0, 4.0)
    return (
        law,
        mass,
        stiffness,
        AREA * pressures.mean(),
        0.3 * top * random.uniform(0.05, 0.8),
        random.uniform(0.2, 0.5),
    )


def from_event_to_event(law, mass, stiffness, load, belt, swing, times):
    """Place of a mass at rest on a belt, by DOP853 from stop to start to stop, at some times."""
    w, place, velocity, time, stuck, sense = 0.7 * sqrt(stiffness / mass), 0.0, 0.0, 0.0, False, -1.0
    found = np.full(times.shape, np.nan)

    def normal(now):
        return load * (1.0 + swing * np.sin(w * now))

    def friction(speed, now):
        return float(law.under(normal(now) / AREA).coefficient_at(speed)) * normal(now)

    while time < times[-1] * (1.0 - 1e-12):
        begun = time

        def rates(now, y, stuck=stuck, sense=sense):
            if stuck:
                return [belt, 0.0]
            slip = max(abs(y[1] - belt), 1e-300)
            return [y[1], (-stiffness * y[0] - sense * friction(slip, now)) / mass]

        def changes(now, y, stuck=stuck, sense=sense, begun=begun):
            if stuck:
                return abs(stiffness * y[0]) - friction(0.0, now)
            return (y[1] - belt) * sense if now > begun + 1e-9 else 1.0

        changes.terminal, changes.direction = True, 1 if stuck else -1
        options = {"rtol": 1e-10, "atol": 1e-13, "max_step": 0.05 / w}
        part = solve_ivp(
            rates, (time, times[-1]), [place, velocity], "DOP853", events=changes, dense_output=True, **options
        )
        here = (times >= time) & (times <= part.t[-1])
        if here.any():
            found[here] = part.sol(times[here])[0]
        place, velocity, time = part.y[0, -1], belt, part.t[-1]
        stuck, sense = not stuck and abs(stiffness * place) <= friction(0.0, time), -np.sign(place)
    return found


def on_a_belt(law, mass, stiffness, load, belt, swing):
    body = st.PointMass(mass)
    contact = st.PointContact(body.centre, st.RigidTrack(velocity=belt), friction=law, area=AREA)
    pressed = st.Force(body.centre, y=-load, history=st.Harmonic(0.7 * sqrt(stiffness / mass) / (2.0 * pi), swing, 1.0))
    return st.System(contact, [pressed], [st.Spring(body.centre, stiffness=stiffness)])


@pytest.mark.parametrize("seed", range(6))
def test_a_mass_under_a_varying_load_moves_as_from_event_to_event(seed):
    law, *numbers = drawn(seed)
    system = on_a_belt(law, *numbers)
    probes = [st.Displacement(system.bodies[0].centre, "x")]
    run = st.simulate(system, 12.0 * pi * sqrt(numbers[0] / numbers[1]), probes=probes)
    expected = from_event_to_event(law, *numbers, run["time"].values)
    assert np.abs(run["displacement"].values[:, 0] - expected).max() < 1e-4 * np.ptp(expected)


@pytest.mark.parametrize("normal", [1.0, 6.0, 23.0, 90.0])
@pytest.mark.parametrize("speed", [0.005, 0.03, 0.3])
def test_sliding_has_the_friction_of_its_pressure(normal, speed):
    """Below, between and above the pressures of the table, at the start and after, with and without a joint."""
    body = st.PointMass(0.5)
    low, high = np.searchsorted(PRESSURES, normal / AREA) - 1, np.searchsorted(PRESSURES, normal / AREA)
    ends = [st.TabulatedFriction(SPEEDS, FALLING.coefficient[int(np.clip(one, 0, 2))]) for one in (low, high)]
    share = 0.0 if low < 0 or high > 2 else (normal / AREA - PRESSURES[low]) / (PRESSURES[high] - PRESSURES[low])
    ratio = (1.0 - share) * float(ends[0].coefficient_at(speed)) + share * float(ends[1].coefficient_at(speed))
    for joint in ({}, {"tangential_stiffness": 1e6}):
        contact = st.PointContact(body.centre, st.RigidTrack(velocity=speed), friction=FALLING, area=AREA, **joint)
        dashpot = st.Dashpot(body.centre, coefficient=1e3)
        system = st.System(
            contact,
            [st.Force(body.centre, y=-normal), st.InitialEquilibrium()],
            [st.Spring(body.centre, stiffness=1e4), dashpot],
        )
        force = st.simulate(system, 0.005)["tangential_force"].values
        np.testing.assert_allclose(force, -ratio * normal, rtol=1e-10)


def leaning(velocity=0.03, **changes):
    """A mass on an inclined belt, held so that friction changes its normal force."""
    body = st.RigidBody(0.5)
    contact = st.PointContact(
        body.centre, st.RigidTrack(velocity=velocity), friction=FALLING, area=AREA, stiffness=2e5, **changes
    )
    along, up = (np.cos(0.6), np.sin(0.6), 0.0), (-np.sin(0.6), np.cos(0.6), 0.0)
    springs = [st.Spring(body.centre, stiffness=k, direction=d) for k, d in ((3e4, along), (6e4, up), (4e4, "z"))]
    dashpots = [st.Dashpot(body.centre, coefficient=c, direction=d) for c, d in ((6.0, along), (2.0, up), (4.0, "z"))]
    return body, contact, [*springs, *dashpots]


def test_linear_theory_has_the_slope_over_the_pressure():
    """Exponents by the equations of motion, whose friction is differentiated numerically about the equilibrium."""
    body, contact, joints = leaning()
    system = st.System(contact, [st.Force(body.centre, y=-20.0)], joints)
    found = st.sliding_stability(system)
    normal, speed = float(found["normal_force"].values.ravel()[0]), 0.03
    axes = np.array([[np.cos(0.6), np.sin(0.6)], [-np.sin(0.6), np.cos(0.6)]])
    stiffness, damping = axes.T @ np.diag([3e4, 6e4]) @ axes, axes.T @ np.diag([6.0, 2.0]) @ axes

    def friction(force, slip):
        return float(FALLING.on(AREA).under(force).coefficient_at(slip)) * force

    assert friction(normal, speed) != pytest.approx(0.0)
    by_force = (friction(normal * (1 + 1e-6), speed) - friction(normal * (1 - 1e-6), speed)) / (2e-6 * normal)
    by_slip = (friction(normal, speed * (1 + 1e-6)) - friction(normal, speed * (1 - 1e-6))) / (2e-6 * speed)
    # The belt slides past the tip towards +x: friction on the tip is along +x, and grows with the indentation -y.
    stiffness = stiffness + 2e5 * np.array([[0.0, by_force], [0.0, 1.0]])
    damping = damping + np.array([[by_slip, 0.0], [0.0, 0.0]])
    first = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness / 0.5, -damping / 0.5]])
    exponents = found["growth_rate"].values + 2j * pi * found["frequency"].values
    for root in np.linalg.eigvals(first):
        if root.imag >= 0.0:
            assert np.abs(exponents - root).min() < 1e-5 * abs(root)


def test_growth_in_a_run_is_that_of_linear_theory():
    body, contact, joints = leaning()
    system = st.System(contact, [st.Force(body.centre, y=-20.0)], joints)
    found = st.sliding_stability(system)
    mode = int(found["growth_rate"].values.argmax())
    growth = float(found["growth_rate"][mode])
    start = st.InitialEquilibrium(mode=mode, amplitude=1e-9)
    started = st.System(contact, [*system.drives, start], joints)
    period = 1.0 / float(found["frequency"][mode])
    probe = st.Displacement(body.centre, "x")
    run = st.simulate(started, 20.0 * period, step=period / 400, sample_rate=400 / period, probes=[probe])
    moved = run["displacement"].values[:, 0]
    moved = moved - float(
        st.simulate(
            st.System(contact, [*system.drives, st.InitialEquilibrium()], joints),
            period,
            step=period / 400,
            sample_rate=400 / period,
            probes=[probe],
        )["displacement"].values[-1, 0]
    )
    peaks = [np.abs(moved[k * 400 : (k + 1) * 400]).max() for k in range(20)]
    rate = np.polyfit(np.arange(20) * period, np.log(peaks), 1)[0]
    assert rate == pytest.approx(growth, rel=1e-2, abs=0.05)


def test_points_of_a_face_have_their_own_pressures():
    """A block on a plane under an eccentric load: each point slides with the friction of its own pressure."""
    block = st.SolidBody.block(
        (0.04, 0.02, 0.03), (2, 1, 1), st.Material(2e11, 7800.0, 0.3), cutoff=2e4, contact_faces=["bottom"]
    )
    face = st.SurfaceContact(block, "bottom", st.RigidTrack(velocity=0.03), friction=FALLING, stiffness=1e11)
    held = [st.Spring(block.at("top"), stiffness=1e6, direction=axis) for axis in "xz"]
    damped = [st.Dashpot(block.at("top"), coefficient=300.0, direction=axis) for axis in "xz"]
    drives = [st.Force(block.at("top"), y=-60.0), st.InitialEquilibrium()]
    run = st.simulate(st.System([face], drives, [*held, *damped]), 2e-4, surface_rate="all")
    last = run.isel(time=-1)
    normal, force = last["normal_force"].values, last["tangential_force"].isel(tangent=0).values
    assert np.ptp(normal / face.areas) > 1e4
    expected = [
        float(FALLING.on(area).under(one).coefficient_at(0.03)) * one
        for one, area in zip(normal.tolist(), face.areas.tolist(), strict=True)
    ]
    np.testing.assert_allclose(np.abs(force), expected, rtol=1e-6)


def test_a_table_with_pressures_is_read_and_refused(tmp_path):
    lines = ["speed,bar,mu"] + [
        f"{v * 1e3},{p / 1e5},{mu}"
        for p, row in zip(PRESSURES, FALLING.coefficient, strict=True)
        for v, mu in zip(SPEEDS, row, strict=True)
    ]
    path = tmp_path / "lining.csv"
    path.write_text("\n".join([lines[0], *reversed(lines[1:])]))
    words = {"speed_unit": 1e-3, "pressure_unit": 1e5}
    found = st.TabulatedFriction.read(path, ("speed", "mu", "bar"), **words)
    np.testing.assert_allclose(found.coefficient, FALLING.coefficient)
    np.testing.assert_allclose(found.pressure, PRESSURES)
    path.write_text("\n".join(lines[:-1]))
    with pytest.raises(
        ValueError, match=r"have each speed once at each pressure, got 11 lines for 4 speeds and 3 pres"
    ):
        st.TabulatedFriction.read(path, ("speed", "mu", "bar"), **words)
    with pytest.raises(ValueError, match=r"pressure must be chosen .* use law\.under\(pressure\)"):
        FALLING.coefficient_at(0.1)
    with pytest.raises(ValueError, match="area must be given under friction that depends on the pressure"):
        st.PointContact(st.PointMass(1.0).centre, st.RigidTrack(), friction=FALLING)
