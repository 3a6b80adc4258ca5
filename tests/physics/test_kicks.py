"""Smallest kicks that start a squeal, against an independent integration of the same equations."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st

from .mode_coupling import MODEL, flutter

STATIC, KINETIC, CREEP, DAMPING = 1.0, 0.5, 0.5, 0.1


def rubbed(velocity: float, damping: float = DAMPING, creep: float = CREEP) -> st.System:
    """A block on a belt whose friction falls with speed, of unit mass, stiffness and load."""
    block = st.PointMass(1.0)
    law = st.ExponentialWeakening(static=STATIC, kinetic=KINETIC, velocity=creep)
    contact = st.PointContact(block.centre, st.RigidTrack(velocity=velocity), friction=law)
    held = [st.Spring(block.centre, stiffness=1.0), st.Dashpot(block.centre, coefficient=damping)]
    return st.System(contact, [st.Force(block.centre, y=-1.0)], held)


def drag(slip: float, creep: float) -> float:
    return KINETIC + (STATIC - KINETIC) * np.exp(-slip / creep)


def squeals(kick: float, velocity: float, damping: float, creep: float) -> bool:
    """Return whether a motion from a kick of the decaying mode grows until the block sticks, by SciPy."""
    slope = -(STATIC - KINETIC) / creep * np.exp(-velocity / creep)
    growth = -0.5 * (damping + slope)
    exponent = growth + 1j * np.sqrt(1.0 - growth**2)

    def rates(_: float, state: np.ndarray) -> list[float]:
        place, speed = state
        return [speed, drag(velocity - speed, creep) - place - damping * speed]

    def sticks(_: float, state: np.ndarray) -> float:
        return velocity - state[1]

    def rests(_: float, state: np.ndarray) -> float:
        return np.hypot(state[0] - drag(velocity, creep), state[1]) - 0.2 * kick

    sticks.terminal = rests.terminal = True
    start = [drag(velocity, creep) + kick, (exponent * kick).real]
    found = solve_ivp(rates, (0.0, 5000.0), start, events=(sticks, rests), rtol=1e-9, atol=1e-12)
    assert found.status == 1
    return bool(found.t_events[0].size)


def threshold(*given: float) -> float:
    low, high = 0.0, given[0]
    while high - low > 1e-4 * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if squeals(middle, *given) else (middle, high)
    return high


def cases(seed: int, count: int):
    """Yield belts a little faster than that at which sliding becomes stable."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        damping, creep = random.uniform(0.05, 0.2), random.uniform(0.3, 0.7)
        critical = creep * np.log((STATIC - KINETIC) / (creep * damping))
        yield pytest.param(critical * random.uniform(1.03, 1.2), damping, creep)


@pytest.mark.parametrize(("velocity", "damping", "creep"), list(cases(4, 4)))
def test_the_smallest_kick_is_that_of_an_independent_integration(velocity, damping, creep):
    """The survey finds it to 1 %, just above, and the unstable cycle behind it."""

    def turning(velocity: float) -> st.System:
        return rubbed(velocity, damping, creep)

    found = st.squeal_survey(turning, {"velocity": [velocity]}, longest=4000.0, sample_rate=20.0).squeeze()
    known = threshold(velocity, damping, creep)
    assert found.verdict.item() == "stable"
    assert 0.999 * known <= float(found.kick) <= 1.012 * known
    # Negative control: 5 % more damping.
    other = threshold(velocity, 1.05 * damping, creep)
    assert abs(other / known - 1.0) > 0.02
    cycle = st.limit_cycle(
        turning(velocity), st.InitialEquilibrium(mode="most unstable", amplitude=float(found.kick)), settle=3
    )
    assert not bool(cycle.stable)
    assert float(found.unstable_frequency) == pytest.approx(float(cycle.frequency), rel=1e-6)
    # Samples are a step apart, at other phases.
    assert float(found.unstable_amplitude) == pytest.approx(float(cycle.displacement_amplitude.max()), rel=2e-3)


@pytest.mark.parametrize("seed", range(3))
def test_a_kick_that_makes_a_block_stick_is_in_closed_form(seed):
    """With constant kinetic friction motion is linear until the block has the velocity of the belt; then it sticks."""
    random = np.random.default_rng(seed)
    stiffness, damping, velocity = random.uniform(3.0, 5.0), random.uniform(0.03, 0.1), random.uniform(0.1, 0.5)

    def belt(speed: float) -> st.System:
        block = st.PointMass(1.0)
        law = st.StaticKinetic(static=0.4, kinetic=0.25)
        contact = st.PointContact(block.centre, st.RigidTrack(velocity=speed), friction=law)
        held = [
            st.Spring(block.centre, stiffness=stiffness),
            st.Dashpot(block.centre, coefficient=damping),
        ]
        return st.System(contact, [st.Force(block.centre, y=-10.0)], held)

    found = st.squeal_survey(belt, {"speed": [velocity]}, longest=400.0, sample_rate=50.0).squeeze()
    exponent = -0.5 * damping + 1j * np.sqrt(stiffness - 0.25 * damping**2)
    times = np.linspace(0.0, 2.0 * np.pi / exponent.imag, 100001)
    known = velocity / (exponent * np.exp(exponent * times)).real.max()
    assert found.verdict.item() == "stable"
    # Up to 1 % above it, and 1.6 % of a step of a twentieth of a period, (0.1 pi)²/6, below or above.
    assert abs(float(found.kick) / known - 1.005) <= 0.005 + 0.016
    # Squeal begins where the block sticks: there is no cycle between.
    assert np.isnan(found.unstable_amplitude.item())


def test_known_unstable_cycle_of_a_weakening_law():
    """At 1.2 m/s it has a period of 6.285167 s and goes 0.457845 m beyond steady sliding."""
    found = st.squeal_survey(rubbed, {"velocity": [1.0, 1.2, 1.9]}, longest=3000.0, sample_rate=20.0)
    assert found.verdict.values.tolist() == ["unstable", "stable", "stable"]
    # Beyond the fold at 1.837 m/s nothing squeals.
    assert np.isfinite(found.kick.values).tolist() == [False, True, False]
    assert 1.0 / float(found.unstable_frequency[1]) == pytest.approx(6.285167, rel=1e-3)
    assert float(found.unstable_amplitude[1]) == pytest.approx(0.457845, rel=0.04)
    # The growing mode ends in the stick-slip cycle of known period.
    assert 1.0 / float(found.cycle_frequency[0, 0]) == pytest.approx(6.431383, rel=1e-3)
    assert bool(found.cycle_stable[0, 0])


@pytest.mark.parametrize("options", [{"longest": 3000.0, "kicks": 0}, {"longest": 1000.0}])
def test_no_kick_is_searched_where_none_is_asked_for_or_a_run_could_not_tell(options):
    """At 1.2 m/s a small motion takes 1077 s to fall by a factor of 150."""
    found = st.squeal_survey(rubbed, {"velocity": [1.2]}, sample_rate=20.0, **options)
    assert found.verdict.item() == "stable"
    assert np.isnan(found.kick.item())


def swing_after(kick: float, friction: float, number: int, duration: float = 0.05) -> float:
    """Return the range of the displacement along the belt at the end of a motion from a kick, from event to event.

    The mass flutters behind its foot, which lifts off and lands without rebound.
    """
    mass, damping, stiffness = MODEL.mass, MODEL.damping, MODEL.stiffness
    push = np.array([0.0, -100.0, 0.0])

    def pressed(state: np.ndarray) -> float:
        return float(stiffness[2] @ state[:3] + damping[2] @ state[3:])

    def rates(state: np.ndarray, closed: bool) -> np.ndarray:
        forces = push - stiffness @ state[:3] - damping @ state[3:]
        if closed:
            forces[0] -= friction * pressed(state)
            forces[2] = 0.0
        return np.append(state[3:], forces / np.diag(mass))

    sliding = MODEL.sliding(friction)
    rest = np.linalg.solve(sliding, push[:2])
    first = np.block([[np.zeros((2, 2)), np.eye(2)], [-sliding, -damping[:2, :2]]])
    values, vectors = np.linalg.eig(first)
    turning = np.flatnonzero(values.imag > 0.0)
    chosen = turning[np.argsort(values[turning].imag)[number]]
    shape = kick * vectors[:2, chosen] / vectors[0, chosen]
    state = np.concatenate([rest + shape.real, [0.0], (values[chosen] * shape).real, [0.0]])
    time, closed, late = 0.0, pressed(state) > 0.0, []
    while time < duration:

        def ends(_: float, state: np.ndarray, closed: bool) -> float:
            return pressed(state) if closed else float(state[2])

        ends.direction, ends.terminal = -1.0, True
        found = solve_ivp(
            lambda _, state, closed: rates(state, closed),
            (time, duration),
            state,
            events=ends,
            args=(closed,),
            rtol=1e-8,
            atol=1e-16,
            max_step=4e-6,
        )
        late.extend(found.y[0, found.t > 0.9 * duration])
        time, state = found.t[-1], found.y[:, -1].copy()
        if found.status == 1 and closed:
            closed, state[2] = False, 0.0
        elif found.status == 1:
            state[3] += friction * mass[2, 2] * state[5] / mass[0, 0]
            state[2] = state[5] = 0.0
            closed = pressed(state) > 0.0
    return float(np.ptp(late))


def test_a_kick_lifts_a_foot_off_as_from_event_to_event():
    """The survey's kick, 1 % above the threshold and 1 % off by its step, separates dying from squeal."""
    found = st.squeal_survey(flutter, {"friction": [0.68]}).squeeze()
    frequencies = sorted(abs(MODEL.exponents(0.68).imag) / (2.0 * np.pi))
    number = int(np.argmin(np.abs(np.array(frequencies) - float(found.kicked_mode))))
    dies, squeals = (swing_after(share * float(found.kick), 0.68, number) for share in (0.97, 1.02))
    assert dies < 0.02 * squeals
    # The squeal swings more than the unstable cycle.
    assert squeals > float(found.unstable_amplitude)
