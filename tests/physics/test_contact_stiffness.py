"""Compliant contacts: against Hertz, Hoffmann's mass, closed forms of a spring, and linear theory."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stridula as st
from stridula._kernels.contact.pressing import press, share_of
from stridula._kernels.layout import columns as at
from stridula._kernels.layout.contact_values import Indentations, Yielding
from stridula.contact.stiffness import force_at
from stridula.lowering import assemble
from stridula.lowering.blocks import blocks_of
from stridula.verification.systems.mode_coupling import AT_CONTACT, GROUNDED

from .checks import goes_on, same_side_by_side
from .test_equilibrium_starts import growth, starting
from .test_space import SCHEMES, dragged, standing

SEPARATED, STICKING, SLIDING = 0, 1, 2
BALL = 4.0 / 3.0 * pi * 0.01**3 * 7960.0
KINDS = [st.LinearStiffness(2e6), st.PowerStiffness(1.570377e10), st.PowerStiffness(1e12, 2.5)]


def thrown(stiffness, speed: float = 0.01, mass: float = BALL, gap: float = 0.0) -> st.System:
    ball = st.RigidBody(mass)
    contact = st.PointContact(ball.centre, st.RigidTrack(), stiffness=stiffness, gap=gap)
    return st.System(contact, [st.InitialVelocity(ball, y=-speed)])


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("stiffness", KINDS, ids=str)
def test_a_ball_bounces_back_as_fast_as_it_came(stiffness, scheme):
    """The velocity comes back to fourth order, wherever the steps lie in the impact, and the ledger is exact."""
    worst = []
    for step in (4e-5, 2e-5):
        errors = []
        for gap in np.linspace(0.0, 0.01 * step, 9):
            system = thrown(stiffness, gap=float(gap))
            run = st.simulate(system, 8e-3, scheme=scheme, step=step, sample_rate=1.0 / step, probes=[])
            energy, first = run.kinetic_and_elastic.values, run.attrs["initial_energy"]
            assert (run.normal_force.values >= 0.0).all()
            assert float(run.normal_force.max()) > 0.0
            assert float(run.ledger_residual.max()) < 1e-12 * first
            assert np.abs(energy + run.impact_loss.values - first).max() < 1e-12 * first
            errors.append(abs(float(run.impact_loss[-1])) / first)
        worst.append(max(errors))
    assert worst[1] < 2e-5
    assert worst[1] < worst[0] / 12.0


@pytest.mark.parametrize("frequency", [1e3, 1e4, 3e4, 1e5])
@pytest.mark.parametrize("sample_rate", [2e3, 1e5])
def test_a_mass_on_its_contact_at_the_default_step(frequency, sample_rate):
    """Twenty periods of a mass that stays closed on a contact spring, in closed form."""
    mass, load, rate = st.PointMass(0.1), 50.0, 2.0 * pi * frequency
    stiffness = 0.1 * rate**2
    contact = st.PointContact(mass.centre, st.RigidTrack(), stiffness=stiffness)
    depth = load / stiffness
    start = st.InitialState(mass, displacement=(0.0, -depth), velocity=(0.0, 0.3 * depth * rate))
    system = st.System(contact, [st.Force(mass.centre, y=-load), start])
    run = st.simulate(system, max(20.0 / frequency, 5.0 / sample_rate), sample_rate=sample_rate, probes=[])
    phase = rate * run.time.values
    known = depth * (0.3 * np.sin(phase) - 1.0)
    # A phase error of a thousandth of the frequency.
    assert np.abs(run.gap.values - known).max() < 0.3 * depth * 1e-3 * phase[-1]
    assert np.abs(run.impact_loss.values).max() < 1e-11 * load * depth


@pytest.mark.parametrize(("radius", "speed"), [(1e-2, 1.0), (1e-3, 0.1), (5e-2, 0.01), (3e-3, 20.0)])
@pytest.mark.parametrize("gap", [0.0, 1e-5])
def test_hertz_impacts_at_the_default_step(radius, speed, gap):
    """Peak force and duration of Hertz's impact, with enough samples to see the peak."""
    steel = st.Material(2.1e11, 7800.0, 0.3)
    stiffness = st.HertzStiffness.between(steel, steel, radius)
    k, mass = stiffness.numbers[0], 4.0 / 3.0 * pi * radius**3 * 7800.0
    deepest = (1.25 * mass * speed**2 / k) ** 0.4
    lasts = 2.943275 * deepest / speed
    system = thrown(stiffness, speed, mass, gap)
    alone = st.simulate(system, gap / speed + 3.0 * lasts + 2e-5, probes=[])
    step = float(alone.attrs["step"])
    run = st.simulate(system, gap / speed + 3.0 * lasts, step=step, sample_rate=1.0 / step, probes=[])
    force = run.normal_force.values
    assert force.max() == pytest.approx(k * deepest**1.5, rel=1e-2)
    # From the moments of the force, which the steps at both ends hardly change.
    assert 1.0 - float(run.impact_loss[-1]) / float(run.kinetic_and_elastic[0]) == pytest.approx(1.0, abs=1e-5)
    assert force.sum() * step == pytest.approx(2.0 * mass * speed, rel=1e-5)
    centre = np.average(np.arange(force.size) * step, weights=force)
    spread = np.sqrt(np.average((np.arange(force.size) * step - centre) ** 2, weights=force))
    assert spread == pytest.approx(spread_of_hertz() * lasts, rel=1e-2)


def spread_of_hertz() -> float:
    """Return the standard deviation in time of the force of an impact, over its duration, by integrating it."""
    found = solve_ivp(
        lambda _, y: (y[1], -(max(y[0], 0.0) ** 1.5)), (0.0, 6.0), (0.0, 1.0), rtol=1e-11, atol=1e-13, max_step=0.01
    )
    time, force = found.t, np.maximum(found.y[0], 0.0) ** 1.5
    weight = force * np.gradient(time)
    centre = np.average(time, weights=weight)
    deepest = 1.25**0.4
    return float(np.sqrt(np.average((time - centre) ** 2, weights=weight)) / (2.943275 * deepest))


def test_hertz_on_a_wall():
    """Force and time of an impact in closed form: m v² / 2 = 0.4 k d^2.5, t = 2.9432 d / v."""
    stiffness = st.HertzStiffness.between(
        st.Material(2.157463e11, 7960.0, 0.29), st.Material(2.157463e11, 7960.0, 0.29), 0.01
    )
    k, speed = stiffness.numbers[0], 0.01
    assert k == pytest.approx(1.570377e10, rel=1e-6)
    deepest = (1.25 * BALL * speed**2 / k) ** 0.4
    run = st.simulate(thrown(stiffness), 2.5e-4, step=2.5e-7, sample_rate=4e6, probes=[])
    force, time = run.normal_force.values, run.time.values
    assert force.max() == pytest.approx(k * deepest**1.5, rel=2e-5)
    assert force.max() == pytest.approx(7.0851, rel=2e-5)
    assert np.ptp(time[force > 0.0]) == pytest.approx(2.943275 * deepest / speed, rel=5e-3)


def test_damping_follows_its_coefficient():
    """A mass on a contact's spring and dashpot, pressed so that it never opens: the oscillator in closed form."""
    stiffness, damping, mass, push = 1e6, 20.0, 0.1, 100.0
    body = st.RigidBody(mass)
    contact = st.PointContact(body.centre, st.RigidTrack(), stiffness=st.LinearStiffness(stiffness, damping))
    system = st.System(contact, [st.Force(body.centre, y=-push)])
    errors = []
    for step in (8e-6, 4e-6):
        run = st.simulate(system, 5e-3, step=step, sample_rate=1.0 / step, probes=[])
        time = run.time.values
        w, rate = sqrt(stiffness / mass), 0.5 * damping / mass
        fast = sqrt(w**2 - rate**2)
        known = (
            -push / stiffness * (1.0 - np.exp(-rate * time) * (np.cos(fast * time) + rate / fast * np.sin(fast * time)))
        )
        errors.append(np.abs(run.gap.values - known).max() * stiffness / push)
        lost = float(run.impact_loss[-1])
        assert lost > 0.0
        assert float(run.ledger_residual.max()) < 1e-13
    assert errors[1] < 5e-8
    # The load begins at once, which is of third order.
    assert errors[0] / errors[1] == pytest.approx(8.0, rel=0.1)


def decaying(count: int, share: float) -> tuple[float, float]:
    """Return the relative errors of decay rate and frequency of a mass that vibrates on a damped linear contact.

    `count` are the steps in a period without damping, `share` is that of the critical damping.
    """
    frequency, load, mass = 1000.0, 50.0, st.PointMass(0.1)
    rate, per_second = 2.0 * pi * frequency, count * frequency
    stiffness = 0.1 * rate**2
    contact = st.PointContact(
        mass.centre, st.RigidTrack(), stiffness=st.LinearStiffness(stiffness, 0.2 * share * rate), gap=0.0
    )
    start = st.InitialState(mass, displacement=(0.0, -1.5 * load / stiffness))
    system = st.System(contact, [st.Force(mass.centre, y=-load), start])
    run = st.simulate(system, 20.0 / frequency, step=1.0 / per_second, sample_rate=per_second, probes=[])
    motion = run.gap.values[3:] + load / stiffness
    before, *_ = np.linalg.lstsq(np.stack([motion[1:-1], motion[:-2]], axis=1), motion[2:])
    root = np.log(max(np.roots([1.0, *-before]), key=np.imag)) * per_second
    return -root.real / (share * rate) - 1.0, root.imag / (rate * sqrt(1.0 - share**2)) - 1.0


@pytest.mark.parametrize("share", [0.02, 0.1])
@pytest.mark.parametrize("count", [50, 20, 10])
def test_a_vibration_decays_as_it_should(count, share):
    """Of fourth order, beside a small term of third order: the third difference is half a step late."""
    angle = 2.0 * pi / count
    decay, frequency = decaying(count, share)
    late, further = share * angle**3 / 6.0, angle**4 / 144.0
    assert decay == pytest.approx(late - further, abs=0.5 * (late + further))
    assert abs(frequency) < 1.5 * (share * angle**3 / 24.0 + angle**4 / 480.0)


@pytest.mark.parametrize("rate", [0.1, 0.5])
def test_rebound_by_hunt_and_crossley(rate):
    """The speed of the rebound under a damping rate, against an integration of the impact, wherever the steps lie."""
    stiffness, speed = st.PowerStiffness(1.570377e10, 1.5, rate), 1.0
    lasts = 2.943275 * (1.25 * BALL * speed**2 / stiffness.coefficient) ** 0.4 / speed

    def moves(_, y):
        return y[1], -max(force_at(stiffness, y[0], y[1]), 0.0) / BALL

    known = solve_ivp(moves, (0.0, 4.0 * lasts), (0.0, speed), rtol=1e-11, atol=1e-15, max_step=lasts / 100.0)
    errors = []
    for step in (lasts / 20.0, lasts / 40.0):
        found = []
        for share in np.arange(8) / 8.0:
            gap = (1.0 + share) * step * speed
            run = st.simulate(
                thrown(stiffness, speed, gap=gap), 3.0 * lasts, step=step, sample_rate=1.0 / step, probes=[]
            )
            found.append((run.gap.values[-1] - run.gap.values[-2]) / step)
        errors.append(np.abs(np.array(found) / -known.y[1, -1] - 1.0).max())
    assert errors[0] < 1e-4 * rate
    assert errors[1] < errors[0] / 5.0


@pytest.mark.parametrize("share", [1.0, 10.0])
@pytest.mark.parametrize("count", [40, 20, 10, 5])
def test_a_stiff_dashpot_is_stable(count, share):
    """A mass on a lining, displaced from its equilibrium, comes to rest at any step."""
    frequency, load, mass = 1000.0, 50.0, st.PointMass(0.1)
    rate, per_second = 2.0 * pi * frequency, count * frequency
    lining = st.LinearStiffness(0.1 * rate**2, 0.2 * share * rate)
    contact = st.PointContact(mass.centre, st.RigidTrack(), stiffness=lining)
    depth = load / lining.stiffness
    start = st.InitialState(mass, displacement=(0.0, -1.5 * depth))
    system = st.System(contact, [st.Force(mass.centre, y=-load), start])
    run = st.simulate(system, 20.0 * share / frequency, step=1.0 / per_second, sample_rate=per_second, probes=[])
    away = np.abs(run.gap.values + depth) / depth
    assert away.max() < 1.0
    assert away[-1] < 1e-4
    assert float(run.ledger_residual.max()) < 1e-12 * load * depth


def hoffmann(friction: float, **start) -> st.System:
    """Hoffmann's mass (2002) with the spring that it has at its contact: K = [[2, 1 - 4 mu / 3], [1, 2]]."""
    mass = st.PointMass(1.0)
    belt = st.RigidTrack(velocity=-5.0)
    contact = st.PointContact(mass.centre, belt, friction=st.Coulomb(friction), stiffness=AT_CONTACT)
    connections = [
        st.Spring(mass.centre, stiffness=rate, direction=(np.cos(by), np.sin(by), 0.0)) for rate, by in GROUNDED
    ]
    return st.System(contact, [st.Force(mass.centre, y=-10.0)], connections)


@pytest.mark.parametrize(("friction", "known"), [(0.5, (1.192749, 1.605413)), (0.9, (1.422918,))])
def test_linear_theory_is_hoffmanns(friction, known):
    theory = st.sliding_stability(hoffmann(friction))
    found = 2.0 * pi * theory.frequency.values
    for one in known:
        assert np.abs(found - one).min() < 1e-6
    assert float(theory.growth_rate.max()) == pytest.approx(0.157147 if friction == 0.9 else 0.0, abs=1e-6)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_growth_in_time_is_hoffmanns(scheme):
    system = hoffmann(0.9)
    probe = st.Displacement(system.slider.centre, "x")
    known, seen, _ = growth(system, probe, 5e-3, 40.0, 200, scheme, amplitude=1e-4)
    assert known.real == pytest.approx(0.157147, abs=1e-6)
    assert seen == pytest.approx(known, rel=1e-3)


@pytest.mark.parametrize("damping", [0.1, 0.3])
def test_growth_on_a_damped_contact_is_that_of_linear_theory(damping):
    """The mass with a dashpot at its contact, at about eighty steps in a period."""
    system = hoffmann(0.9)
    damped = st.LinearStiffness(float(AT_CONTACT), damping)
    system = replace(system, contact=replace(system.contact, stiffness=damped))
    probe = st.Displacement(system.slider.centre, "x")
    known, seen, _ = growth(system, probe, 5e-2, 40.0, 1, st.ExactModal(), amplitude=1e-4)
    assert known.real > 0.1
    assert abs(seen / known - 1.0) < 3e-6


def on_layers(stiffness, friction: float = 0.3, **words) -> st.System:
    """A pillar that stands in space, every foot on a layer."""
    system = standing(st.Coulomb(friction), **words)
    kinds = stiffness if isinstance(stiffness, list) else [stiffness] * len(system.contacts)
    contacts = [replace(one, stiffness=kind) for one, kind in zip(system.contacts, kinds, strict=True)]
    return replace(system, contact=contacts)


MIXED = [st.LinearStiffness(1e6, 10.0), st.PowerStiffness(1e10), None, st.PowerStiffness(1e13, 2.0, 0.1)]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_several_contacts_obey_their_laws_at_every_step(scheme):
    count, step = 2500, 4e-6
    system = on_layers([MIXED[k % 4] for k in range(len(standing().contacts))])
    run = st.simulate(system, count * step, step=step, sample_rate=1.0 / step, scheme=scheme, probes=[])
    assert run.attrs["ended"] == "finished"
    assert int(run.unsolved_steps.sum()) == 0
    normal, gap = run.normal_force.values, run.gap.values
    size = normal.max()
    pulled = np.hypot(*np.moveaxis(run.tangential_force.values, -1, 0))
    assert (normal >= 0.0).all()
    assert (pulled <= 0.3 * normal + 1e-9 * size).all()
    arrays = assemble(system)
    reach, seen = blocks_of(arrays, scheme, step).contacts.constants[:, at.YIELD_REACH], 0
    for k, contact in enumerate(system.contacts):
        if contact.yields is None:
            assert np.abs(gap[:, k] * normal[:, k]).max() < 1e-9 * size * np.abs(gap).max()
            continue
        indented = -gap[:, k]
        path = list(zip(indented[3:], indented[2:-1], indented[1:-2], indented[:-3], strict=True))
        yields = Yielding(*contact.yields.numbers, reach[k])
        known = [
            press(x, past, yields, share_of(x, past, yields), step)[0]
            for x, past in ((one[0], Indentations(*one[1:])) for one in path)
        ]
        # The share of the quotient depends on the indentation without force, which a record does not have.
        wary = yields._replace(reach=4.0 * yields.reach)
        resolved = [share_of(one[0], Indentations(*one[1:]), wary) == 0.0 for one in path]
        pressed = np.array(resolved) & (normal[3:, k] > 0.0)
        np.testing.assert_allclose(normal[3:, k][pressed], np.array(known)[pressed], rtol=1e-6, atol=1e-9 * size)
        seen += int(pressed.sum())
    assert seen > 1000
    terms = ["kinetic_and_elastic", "damping_loss", "drive_work", "contact_work"]
    largest = max(np.abs(run[term].values).max() for term in terms)
    assert np.abs(run.ledger_residual.values).max() < 1e-11 * largest


@pytest.mark.parametrize(
    "damped", [lambda k: st.PowerStiffness(10.0**k, 1.5, 0.05), lambda k: st.LinearStiffness(10.0 ** (k - 5.0), 10.0)]
)
def test_runs_side_by_side_are_those_alone(damped):
    systems = [on_layers(damped(k)) for k in np.linspace(10.0, 12.0, 9)]
    same_side_by_side(systems, 2e-3, step=4e-6, sample_rate=5e4, probes=[])


@pytest.mark.parametrize("stiffness", [st.PowerStiffness(1e12, 1.5, 0.05), st.LinearStiffness(1e6, 10.0)], ids=str)
def test_a_run_continues_to_the_last_bit_and_runs_again(stiffness, tmp_path):
    system = on_layers(stiffness)
    names = ("normal_force", "tangential_force", "kinetic_and_elastic")
    whole, *_, again = goes_on(system, 2e-3, names, tmp_path, step=4e-6, sample_rate=5e4, probes=[])
    np.testing.assert_array_equal(again.simulate().normal_force, whole.normal_force)


def test_a_stiff_contact_is_a_rigid_one():
    """With growing stiffness, equilibrium and modes approach those of rigid contacts."""
    rigid = dragged(0.4, 0.01)
    known, apart = st.sliding_stability(rigid), []

    def lowest(theory) -> np.ndarray:
        exponents = theory.growth_rate.values + 2j * pi * theory.frequency.values
        return exponents[exponents.imag > 1.0][:8]

    for stiffness in (1e9, 1e10, 1e11):
        contacts = [replace(one, stiffness=stiffness) for one in rigid.contacts]
        found = st.sliding_stability(replace(rigid, contact=contacts))
        forces = float(np.abs(found.normal_force / known.normal_force - 1.0).max())
        apart.append([forces, np.abs(lowest(found) - lowest(known)).max()])
    ratios = np.array(apart[1:]) / np.array(apart[:-1])
    np.testing.assert_allclose(ratios, 0.1, rtol=0.3)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("stiffness", KINDS, ids=str)
def test_a_start_in_equilibrium_stays_there(stiffness, scheme):
    system = hoffmann(0.3)
    system = replace(system, contact=replace(system.contact, stiffness=stiffness))
    theory = st.sliding_stability(system)
    run = st.simulate(starting(system), 0.5, scheme=scheme, step=2e-5, probes=[])
    assert (run.status == SLIDING).all()
    np.testing.assert_allclose(run.normal_force.values, float(theory.normal_force), rtol=1e-9)
    assert force_at(stiffness, -float(run.gap[-1])) == pytest.approx(float(theory.normal_force), rel=1e-8)


BAD = {
    "number": (lambda: st.LinearStiffness(0.0), "stiffness must be above 0"),
    "exponent": (lambda: st.PowerStiffness(1.0, 0.5), "exponent must be 1 or above"),
    "kind": (lambda: st.PointContact(st.RigidBody(1.0).centre, st.RigidTrack(), stiffness="soft"), "stiffness must be"),
    "below": (lambda: st.PointContact(st.RigidBody(1.0).centre, st.RigidTrack(), stiffness=-1.0), "stiffness must be"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_arguments_are_refused(name):
    make, words = BAD[name]
    with pytest.raises(ValueError, match=words):
        make()
