"""Tangential stiffness in series with friction: integrations from event to event, closed forms, linear theory."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st
from stridula.contact.elastic import ElasticFriction

AXES = "xz"


@dataclass(frozen=True)
class Damper:
    """A mass on springs and dashpots along one axis or two, beside a contact with a joint, under harmonic forces."""

    mass: float
    springs: np.ndarray
    dashpots: np.ndarray
    normal: float
    friction: float
    stiffness: float
    damping: float
    amplitudes: np.ndarray
    angular: np.ndarray
    phases: np.ndarray

    @property
    def axes(self) -> str:
        return AXES[: len(self.springs)]

    @property
    def period(self) -> float:
        """Of the mass on its joint alone."""
        return 2.0 * pi * sqrt(self.mass / self.stiffness)

    def system(self) -> st.System:
        body = st.PointMass(self.mass) if len(self.axes) == 1 else st.RigidBody(self.mass)
        contact = st.PointContact(
            body.centre,
            st.RigidTrack(),
            friction=st.Coulomb(self.friction),
            tangential_stiffness=self.stiffness,
            tangential_damping=self.damping,
        )
        drives, joints = [st.Force(body.centre, y=-self.normal)], []
        for k, axis in enumerate(self.axes):
            history = st.Harmonic(self.angular[k] / (2.0 * pi), phase=self.phases[k])
            drives.append(st.Force(body.centre, **{axis: self.amplitudes[k]}, history=history))
            joints.append(st.Spring(body.centre, stiffness=self.springs[k], direction=axis))
            joints.append(st.Dashpot(body.centre, coefficient=self.dashpots[k], direction=axis))
        return st.System(contact, drives, joints)

    def places(self, times: np.ndarray) -> np.ndarray:
        """Places from rest on, by DOP853 from each slip and stick to the next."""
        n, limit = len(self.springs), self.friction * self.normal
        k, c = self.stiffness, self.damping
        found, y, time, slips = np.full((times.size, n), np.nan), np.zeros(3 * n), 0.0, False

        def felt(y):
            return k * y[2 * n :] + c * y[n : 2 * n]

        while time < times[-1] * (1.0 - 1e-12):
            if slips:
                y[2 * n :] *= min(1.0, limit / (k * np.linalg.norm(y[2 * n :])))

            def rates(now, y, slips=slips):
                place, velocity, deflection = y[:n], y[n : 2 * n], y[2 * n :]
                force, rate = felt(y), velocity
                if slips and c:
                    force = limit * force / np.linalg.norm(force)
                    rate = (force - k * deflection) / c
                elif slips:
                    way = deflection / np.linalg.norm(deflection)
                    force, rate = limit * way, velocity - way * (way @ velocity)
                load = self.amplitudes * np.sin(self.angular * now + self.phases)
                pull = load - self.springs * place - self.dashpots * velocity - force
                return np.concatenate([velocity, pull / self.mass, rate])

            def changes(_, y, slips=slips):
                if slips and not c:
                    return y[2 * n :] @ y[n : 2 * n]
                return np.linalg.norm(felt(y)) - limit

            changes.terminal, changes.direction = True, -1 if slips else 1
            options = {"rtol": 1e-10, "atol": 1e-15, "max_step": self.period / 50.0}
            part = solve_ivp(rates, (time, times[-1]), y, "DOP853", events=changes, dense_output=True, **options)
            here = (times >= time) & (times <= part.t[-1])
            if here.any():
                found[here] = part.sol(times[here])[:n].T
            time, y, slips = part.t[-1], part.y[:, -1].copy(), not slips
            if not slips and not c:
                # Rounding must not have it beyond its limit from the beginning.
                y[2 * n :] *= 1.0 - 1e-12
        return found


def drawn(seed: int, axes: int, damped: bool) -> Damper:
    random = np.random.default_rng(seed)
    mass, stiffness = 10.0 ** random.uniform(-1.0, 1.0), 10.0 ** random.uniform(4.0, 6.0)
    normal, friction, springs = (
        10.0 ** random.uniform(1.0, 2.0),
        random.uniform(0.2, 0.8),
        random.uniform(0.05, 1, axes),
    )
    return Damper(
        mass,
        stiffness * springs,
        0.02 * np.sqrt(stiffness * springs * mass),
        normal,
        friction,
        stiffness,
        0.05 * sqrt(stiffness * mass) if damped else 0.0,
        friction * normal * random.uniform(0.3, 3.0, axes),
        sqrt(stiffness / mass) * random.uniform(0.3, 1.5, axes),
        random.uniform(-3.0, 3.0, axes),
    )


def run_of(damper: Damper, periods: float, **settings):
    """Times, places and the record of a run from rest."""
    system, duration = damper.system(), periods * damper.period
    probes = [st.Displacement(system.bodies[0].centre, axis) for axis in damper.axes]
    run = st.simulate(system, duration, probes=probes, **settings)
    return run["time"].values, run["displacement"].values, run


@pytest.mark.parametrize("damped", [False, True])
@pytest.mark.parametrize("axes", [1, 2])
@pytest.mark.parametrize("seed", range(4))
def test_random_dampers_move_as_from_event_to_event(seed, axes, damped):
    """At default settings: sticking, slipping, and turning in space; the force stays within the cone."""
    damper = drawn(seed, axes, damped)
    times, places, run = run_of(damper, 8.0)
    expected = damper.places(times)
    assert np.abs(places - expected).max() < 2e-4 * np.abs(expected).max()
    force = run["tangential_force"].values.reshape(times.size, axes)
    limit = damper.friction * run["normal_force"].values.ravel()
    assert (np.linalg.norm(force, axis=1) <= limit * (1.0 + 1e-12)).all()
    assert {1.0, 2.0} <= set(np.unique(run["status"]))


@pytest.mark.parametrize("axes", [1, 2])
def test_errors_fall_with_the_square_of_the_step(axes):
    damper, errors = drawn(2, axes, True), []
    for steps in (50, 100, 200, 400):
        times, places, _ = run_of(damper, 4.0, step=damper.period / steps, sample_rate=steps / damper.period)
        expected = damper.places(times)
        errors.append(np.abs(places - expected).max() / np.abs(expected).max())
    assert np.log2(errors[0] / errors[-1]) > 3 * 1.8


def on_a_belt_by_events(law, mass, spring, dashpot, normal, belt, joint, times):
    """Places of a mass at rest on a belt, with a joint under friction that changes with the speed, as above."""
    found, y, time, sense = np.full(times.size, np.nan), np.zeros(3), 0.0, 0.0

    def limit(slip):
        return float(law.coefficient_at(max(abs(slip), 1e-14))) * normal

    def patch(y, sense):
        """Acceleration, and the slip velocity of the surface, which the limit moves by its change."""
        slip = y[1] - belt
        force = sense * limit(slip) if sense else joint * y[2]
        acceleration = (-spring * y[0] - dashpot * y[1] - force) / mass
        slope = np.sign(slip) * law.linearised_at(max(abs(slip), 1e-14)).slope * normal
        return acceleration, slip - sense * slope * acceleration / joint

    while time < times[-1] * (1.0 - 1e-12):

        def rates(_, y, sense=sense):
            acceleration, slipped = patch(y, sense)
            return [y[1], acceleration, y[1] - belt - (slipped if sense else 0.0)]

        def changes(_, y, sense=sense):
            return sense * patch(y, sense)[1] if sense else abs(joint * y[2]) - limit(y[1] - belt)

        changes.terminal, changes.direction = True, -1 if sense else 1
        options = {"rtol": 1e-10, "atol": 1e-14, "max_step": 0.02 * sqrt(mass / joint)}
        part = solve_ivp(rates, (time, times[-1]), y, "DOP853", events=changes, dense_output=True, **options)
        here = (times >= time) & (times <= part.t[-1])
        if here.any():
            found[here] = part.sol(times[here])[0]
        time, y = part.t[-1], part.y[:, -1].copy()
        sense = 0.0 if sense else float(np.sign(y[2]))
        y[2] *= 1.0 if sense else 1.0 - 1e-10
    return found


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_joints_under_falling_friction_move_as_from_event_to_event(seed, in_space):
    """At default settings, over eight periods of stick and slip; in space along a line of both tangents."""
    random = np.random.default_rng(100 + seed)
    mass, spring = random.uniform(0.3, 2.0), 10.0 ** random.uniform(3.0, 4.0)
    normal, belt = random.uniform(5.0, 30.0), random.uniform(0.01, 0.1)
    dashpot, joint = 0.02 * sqrt(spring * mass), spring * random.uniform(3.0, 30.0)
    law = st.Stribeck(random.uniform(0.4, 0.6), random.uniform(0.2, 0.4), random.uniform(0.05, 0.3))
    body = st.RigidBody(mass) if in_space else st.PointMass(mass)
    along = {"velocity": 0.6 * belt, "lateral_velocity": 0.8 * belt} if in_space else {"velocity": belt}
    contact = st.PointContact(body.centre, st.RigidTrack(**along), friction=law, tangential_stiffness=joint)
    axes = AXES if in_space else "x"
    springs = [st.Spring(body.centre, stiffness=spring, direction=axis) for axis in axes]
    dashpots = [st.Dashpot(body.centre, coefficient=dashpot, direction=axis) for axis in axes]
    system = st.System(contact, [st.Force(body.centre, y=-normal)], [*springs, *dashpots])
    probe = st.Displacement(body.centre, "x")
    run = st.simulate(system, 16.0 * pi * sqrt(mass / spring), probes=[probe]).isel(time=slice(None, None, 20))
    expected = on_a_belt_by_events(law, mass, spring, dashpot, normal, belt, joint, run["time"].values)
    found = run["displacement"].values[:, 0] / (0.6 if in_space else 1.0)
    assert np.abs(found - expected).max() < 1e-5 * np.ptp(expected)
    assert {1.0, 2.0} <= set(np.unique(run["status"]))


VM320 = Damper(
    944.6, np.array([2.4e7]), np.array([7700.0]), 492.096, 0.5, 2.4e7, 0.0, *np.array([[123.024], [209.0], [pi / 2]])
)


def test_the_friction_damper_of_the_literature():
    """Ansys' verification case VM320: the first harmonic of the displacement, and both resonances."""
    # The decay of the start, exp(-C t / 2 M), is over after three seconds.
    times, places, _ = run_of(VM320, 3.0 / VM320.period)
    here = times >= times[-1] - 20.0 * pi / 209.0 * (1.0 + 1e-9)
    turning = np.exp(-209j * times[here])
    harmonic = 2.0 * np.trapezoid(places[here, 0] * turning, times[here]) / np.ptp(times[here])
    assert abs(harmonic) == pytest.approx(1.505369e-5, rel=1e-3)
    system = VM320.system()
    quiet = st.System(system.contacts, system.drives[:1], system.connections)
    for asked, expected in (({"status": "sticking"}, 225.422), ({"velocity": 0.1}, 159.398)):
        found = 2.0 * pi * st.sliding_stability(quiet, **asked)["frequency"].values[0]
        assert found == pytest.approx(expected, rel=4e-4)


def feet_under_a_block(count: int, in_space: bool) -> tuple[st.System, np.ndarray, np.ndarray]:
    """A block that does not turn, on feet with joints under unequal loads; their limits and stiffnesses."""
    random = np.random.default_rng(count)
    shares, joints = random.uniform(0.2, 1.0, (2, count))
    shares, joints = shares / shares.sum(), 1e7 * joints / joints.sum()
    body = st.RigidBody(2.0) if in_space else st.PointMass(2.0)
    contacts = [
        st.PointContact(
            body.centre,
            st.RigidTrack(),
            friction=st.Coulomb(0.4),
            stiffness=2e7 * share,
            tangential_stiffness=joint,
            name=f"foot {n}",
        )
        for n, (share, joint) in enumerate(zip(shares.tolist(), joints.tolist(), strict=True))
    ]
    # So slow that the spring moves it, to and fro by 1.5 times the deflection at which all feet slip.
    driven = st.Spring(body.centre, stiffness=1e9, offset=1.5 * 120.0 / 1e7, history=st.Harmonic(10.0))
    drives = [st.Force(body.centre, y=-300.0), st.InitialEquilibrium(status="sticking")]
    held = [driven, st.Dashpot(body.centre, coefficient=2e4)]
    return st.System(contacts, drives, held), 0.4 * 300.0 * shares, joints


@pytest.mark.parametrize(("count", "in_space"), [(3, False), (20, False), (4, True), (20, True)])
def test_feet_slip_one_after_the_other(count, in_space):
    """The force over the displacement is that of Iwan's model, and after a reversal twice as wide (Masing)."""
    system, limits, joints = feet_under_a_block(count, in_space)
    run = st.simulate(system, 0.15, step=2e-5, sample_rate=5e4)
    place = run["contact_position"].values.reshape(run.sizes["time"], count, -1)[:, 0, 0]
    force = run["tangential_force"].values.reshape(run.sizes["time"], count, -1)[..., 0].sum(axis=1)
    # Forces are those about the beginning of the step at whose end the places are.
    place, force = place[:-1], force[1:]

    def first(x):
        return np.minimum(joints[:, None] * np.abs(x), limits[:, None]).sum(axis=0) * np.sign(x)

    turns = np.flatnonzero(np.diff(np.sign(np.diff(place)))) + 1
    before = slice(1, turns[0])
    assert np.abs(force[before] - first(place[before])).max() < 2e-3 * limits.sum()
    for begin, end in pairwise(turns):
        back = place[begin + 2 : end - 1] - place[begin]
        expected = first(place[turns[:1]]) * np.sign(place[begin]) + 2.0 * first(back / 2.0)
        assert np.abs(force[begin + 2 : end - 1] - expected).max() < 4e-3 * limits.sum()
    # Work of the last cycle, by Masing's rule.
    cycle = slice(turns[-3], turns[-1] + 1)
    top = np.abs(place[turns[-1]])
    amplitudes = np.linspace(0.0, top, 20001)
    loss = 8.0 * np.trapezoid(first(amplitudes), amplitudes) - 4.0 * top * first(np.array([top]))[0]
    assert np.ptp(run["friction_loss"].values[[cycle.start, cycle.stop - 1]]) == pytest.approx(loss, rel=5e-3)


def sprung(law, damping=0.0, speed=0.1, across=0.0) -> st.System:
    """A mass of 0.5 kg on springs of 3e4 N/m along both tangents, on a belt, under 20 N, with a joint of 2e5 N/m."""
    body = st.RigidBody(0.5)
    belt = st.RigidTrack(velocity=-speed, lateral_velocity=across)
    joint = {"tangential_stiffness": 2e5, "tangential_damping": damping}
    contact = st.PointContact(body.centre, belt, friction=law, **joint)
    return st.System(
        contact, [st.Force(body.centre, y=-20.0)], [st.Spring(body.centre, stiffness=3e4, direction=a) for a in AXES]
    )


@pytest.mark.parametrize("damping", [0.0, 5.0])
def test_motion_across_the_slip_has_the_roots_of_its_cubic(damping):
    """The joint turns after the slip: ``w z' = mu N v - V k z``, with ``w = mu N + c V`` and the force mu N of it."""
    whole, pull = 0.3 * 20.0 + damping * 0.1, 0.3 * 20.0 / 0.5
    rates = [
        [0.0, 1.0, 0.0],
        [-3e4 / 0.5, -pull * damping / whole, -pull * 2e5 / whole],
        [0.0, 6.0 / whole, -0.1 * 2e5 / whole],
    ]
    roots = np.linalg.eigvals(rates)
    found = st.sliding_stability(sprung(st.Coulomb(0.3), damping))
    exponents = found["growth_rate"].values + 2j * pi * found["frequency"].values
    for root in roots[roots.imag >= 0.0]:
        assert np.abs(exponents - root).min() < 1e-8 * abs(root)
    # Along the slip the force is that of friction alone.
    assert np.abs(exponents - 1j * sqrt(3e4 / 0.5)).min() < 1e-6


@pytest.mark.parametrize("law", [st.Coulomb(0.3), st.Stribeck(0.4, 0.3, 0.05, 2.0, 0.2)])
@pytest.mark.parametrize("damping", [0.0, 5.0])
def test_steady_sliding_stays(law, damping):
    system = sprung(law, damping, across=0.05)
    started = st.System(system.contacts, [*system.drives, st.InitialEquilibrium()], system.connections)
    force = st.simulate(started, 0.01)["tangential_force"].values.reshape(-1, 2)
    ratio = float(law.coefficient_at(np.hypot(0.1, 0.05)))
    assert np.linalg.norm(force[0]) == pytest.approx(20.0 * ratio, rel=1e-12)
    assert np.ptp(force, axis=0).max() < 1e-9 * np.linalg.norm(force[0])


@pytest.mark.parametrize("in_space", [False, True])
def test_a_contact_at_rest_carries_its_share_of_a_load(in_space):
    """A spring of 3e4 N/m beside a joint of 2e5 N/m; in a run, and the frequency and decay of both together."""
    body = st.RigidBody(0.5) if in_space else st.PointMass(0.5)

    def loaded(force, **asked):
        joint = {"tangential_stiffness": 2e5, "tangential_damping": 10.0}
        contact = st.PointContact(body.centre, st.RigidTrack(), friction=st.Coulomb(0.5), **joint)
        drives = [st.Force(body.centre, x=force, y=-20.0), st.InitialEquilibrium(status="sticking")]
        axes = AXES if in_space else "x"
        return st.System(contact, drives, [st.Spring(body.centre, stiffness=3e4, direction=axis) for axis in axes])

    force = st.simulate(loaded(6.0), 0.01)["tangential_force"].values.reshape(-1, 1 + in_space)
    assert force[[0, -1], 0] == pytest.approx(6.0 * 2e5 / 2.3e5, rel=1e-12)
    assert np.ptp(force[:, 0]) < 1e-9
    found = st.sliding_stability(loaded(6.0), status="sticking")
    # The joint is damped by 10 N s/m: growth -c / 2 m.
    exponent = found["growth_rate"].values[0] + 2j * pi * found["frequency"].values[0]
    assert exponent == pytest.approx(-10.0 + 1j * sqrt(2.3e5 / 0.5 - 100.0), rel=1e-9)
    with pytest.raises(ValueError, match=r"would stick with 12\.2 N of at most 10 N"):
        st.simulate(loaded(14.0), 0.01)


def test_points_of_a_face_share_its_stiffness():
    """A lining in shear: a block glued by friction moves as on the sum over the areas."""
    block = st.SolidBody.block(
        (0.04, 0.02, 0.03), (2, 1, 1), st.Material(2e11, 7800.0, 0.3), cutoff=4e4, contact_faces=["bottom"]
    )
    face = st.SurfaceContact(
        block,
        "bottom",
        st.RigidTrack(),
        friction=st.Coulomb(0.5),
        stiffness=1e13,
        tangential_stiffness=1e10,
        tangential_damping=1e4,
    )
    assert sum(one.tangential_stiffness for one in face.contacts) == pytest.approx(1e10 * 0.04 * 0.03)
    assert sum(one.tangential_damping for one in face.contacts) == pytest.approx(1e4 * 0.04 * 0.03)
    found = st.sliding_stability(st.System([face], [st.Force(block.at("top"), y=-1e3)]), status="sticking")
    # Shear of the layer under a block so stiff that it moves as a whole along z, the short way of its rocking.
    expected = sqrt(1e10 * 0.04 * 0.03 / block.total_mass) / (2.0 * pi)
    assert np.abs(found["frequency"].values / expected - 1.0).min() < 0.05


def test_a_run_continues_and_runs_again(tmp_path):
    damper = drawn(1, 2, True)
    system, duration = damper.system(), 4.0 * damper.period
    whole = st.simulate(system, duration, step=duration / 2000, sample_rate=2000 / duration)
    half = st.simulate(system, duration / 2, step=duration / 2000, sample_rate=2000 / duration)
    st.save(half, tmp_path / "half.nc")
    rest = st.simulate(
        system, duration / 2, step=duration / 2000, sample_rate=2000 / duration, start=st.load(tmp_path / "half.nc")
    )
    np.testing.assert_array_equal(rest["tangential_force"].values, whole["tangential_force"].values[1000:])
    again = st.load_scenario(whole).simulate()
    np.testing.assert_array_equal(again["tangential_force"].values, whole["tangential_force"].values)


def test_wrong_joints_are_refused():
    body = st.PointMass(1.0)

    def contact(friction, **joint):
        return st.PointContact(body.centre, st.RigidTrack(), friction=friction, **joint)

    with pytest.raises(ValueError, match=r"tangential_stiffness must be above 0, got 0\.0"):
        contact(st.Coulomb(0.3), tangential_stiffness=0.0)
    with pytest.raises(ValueError, match="tangential_damping must be 0 without a tangential_stiffness"):
        contact(st.Coulomb(0.3), tangential_damping=1.0)
    with pytest.raises(ValueError, match="under lugre friction, which has its own"):
        contact(st.LuGre(0.4, 0.3, 0.05, 1e4), tangential_stiffness=1e6)
    with pytest.raises(ValueError, match=r"holds more at rest than in the slowest sliding, got 0\.5 and 0\.3"):
        contact(st.StaticKinetic(0.5, 0.3), tangential_stiffness=1e6)
    assert isinstance(contact(st.Coulomb(0.3), tangential_stiffness=1e6).law, ElasticFriction)
