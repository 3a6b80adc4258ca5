"""Laws, mirror image and units on random systems: masses, blocks, sliders, springs, dashpots, 1 to 3 contacts.

A step is a sample, so that means are values. Steps in which several contacts have no common solution stop the run or
are counted; such runs are left out here, see `test_stopped_runs`.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as some
from physics.cases import SCHEME_NAMES, SCHEMES

import stridula as st
from invariants.laws import violations
from invariants.recipes import Foot, Recipe, Units, build, number, recipes, run_of
from stridula._kernels.layout import columns as layout
from stridula._kernels.layout.laws import LAW_COLUMNS

STEPS = 1000
schemes = some.sampled_from(SCHEMES)
BOTH = pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
QUICK = settings(max_examples=60, deadline=None)
SMOOTH = some.one_of(
    number(0.0, 0.8).map(st.Coulomb),
    number(0.1, 0.8).map(lambda mu: st.Stribeck(mu, 0.7 * mu, 0.3)),
    number(0.1, 0.8).map(lambda mu: st.LuGre(mu, 0.8 * mu, 0.1, 1e4)),
    number(0.3, 0.8).map(lambda mu: st.RateAndState(mu, 0.02, 0.01, 1e-4, 1e-2)),
)


def solved(recipe, scheme, steps, units=None):
    """The run of a recipe, left out where the contacts have no common solution."""
    try:
        run = run_of(recipe, scheme, steps, units)
    except st.Diverged as stop:
        if stop.record.attrs["ended"] != "contact unsolved":
            raise
        assume(False)
    assume("unsolved_steps" not in run or not run.unsolved_steps.any())
    return run


# A foot whose other end lands: in one step its normal force is 36 times that of the steps before and after.
STRUCK = Recipe(
    kind="chain",
    feet=(
        Foot(law=st.Coulomb(0.0), gap=0.0, inclination=0.0, belt=0.0, lift=0.0, frequency=30.0),
        Foot(
            law=st.RateAndState(1.0, 0.0156, 0.0156, 1e-3, 0.1),
            gap=0.0,
            inclination=0.0,
            belt=0.03,
            lift=0.02,
            frequency=106.0,
        ),
    ),
    masses=(1.0, 0.178),
    springs=(100.0, 1000.0),
    dashpots=(1.0, 1.0),
    load=1.0,
    speed=0.0,
    angle=0.0,
)


# Bristles bent under a small normal force and released under a large one: they give more energy than they took.
GIVING = Recipe(
    kind="block",
    feet=(Foot(law=st.LuGre(0.5, 0.5, 0.1, 1e3), gap=0.0, inclination=0.0, belt=0.0, lift=0.0, frequency=30.0),),
    masses=(0.1,),
    springs=(1000.0,),
    dashpots=(1.0,),
    load=1.0,
    speed=0.1,
    angle=0.0,
)


# Landing under friction that rises with the speed: within the step of the impulse the slip passes zero, not after it.
LANDING = Recipe(
    kind="slider",
    feet=(
        Foot(
            law=st.TabulatedFriction((0.0, 0.1, 0.3, 2.0), (0.25, 0.5, 0.5, 0.5)),
            gap=3e-5,
            inclination=0.0,
            belt=0.0,
            lift=0.0,
            frequency=30.0,
        ),
    ),
    masses=(1.0,),
    springs=(100.0,),
    dashpots=(1.0,),
    load=10.0,
    speed=0.0,
    angle=0.0,
)

# Struck as it lands, it stops, slides back and stops again in three steps that all count as sticking.
BENT = st.TabulatedFriction((0.0, 0.01, 0.03, 2.0), (0.5, 0.75, 0.75, 0.5))
REBOUNDING = replace(LANDING, feet=(replace(LANDING.feet[0], law=BENT),), load=5.05)


@given(recipes(), schemes)
@example(STRUCK, SCHEMES[0])
@example(GIVING, SCHEMES[0])
@example(LANDING, SCHEMES[0])
@example(LANDING, SCHEMES[1])
@example(REBOUNDING, SCHEMES[0])
@settings(max_examples=150, deadline=None)
def test_laws_hold_at_every_step(recipe, scheme):
    assert violations(solved(recipe, scheme, STEPS), build(recipe)) == set()


def test_one_contact_or_coulombs_law_always_has_a_solution():
    """Few random runs may be left out above: none of those with one contact, none under Coulomb's law."""
    left_out = []

    @given(recipes(kinds=("block", "chain"), law=number(0.0, 3.0).map(st.Coulomb)), schemes)
    @settings(max_examples=60, deadline=None)
    def coulomb(recipe, scheme):
        run = run_of(recipe, scheme, 300)
        left_out.append("unsolved_steps" in run and bool(run.unsolved_steps.any()))

    coulomb()
    assert not any(left_out)


def off(one, other):
    """Largest difference over the largest value, of numbers beyond round-off."""
    return float(np.abs(one - other).max() / max(np.abs(other).max(), 1e-12))


@given(recipes(law=SMOOTH), schemes)
@QUICK
def test_mirror_image(recipe, scheme):
    """x reversed: forces along x and positions change their sign and nothing else, to round-off.

    300 steps, too few for a perturbation of 1e-16 to be seen, and no law that jumps.
    """
    run, image = (solved(recipe, scheme, 300, Units(sense=sense)) for sense in (1.0, -1.0))
    same = run.status.values == image.status.values
    assert np.mean(same) > 0.999
    assume(np.all(same))
    assert off(image.normal_force.values, run.normal_force.values) < 1e-6
    assert off(-image.tangential_force.values, run.tangential_force.values) < 1e-6
    assert off(-image.slip_velocity.values, run.slip_velocity.values) < 1e-6
    assert off(image.kinetic_and_elastic.values, run.kinetic_and_elastic.values) < 1e-6


def test_mirror_rejects_half_a_mirror():
    """Negative control: the belt not reversed."""
    foot = Foot(st.Coulomb(0.5), 0.0, 0.0, 0.03, 0.0, 50.0)
    recipe = Recipe("chain", (foot,), (0.3,), (1e4,), (1.0,), 5.0, 0.0, 0.0)
    half = replace(recipe, feet=(replace(foot, belt=-0.03),))
    run, image = run_of(recipe, SCHEMES[1], 300), run_of(half, SCHEMES[1], 300, Units(sense=-1.0))
    assert off(-image.tangential_force.values, run.tangential_force.values) > 0.1


@given(recipes(), schemes, *[some.integers(-6, 6)] * 3)
@QUICK
def test_no_unit_is_special(recipe, scheme, length, mass, time):
    """Other units of length, mass and time, by powers of two so that they do not round: the same run."""
    units = Units(2.0**length, 2.0**mass, 2.0**time)
    one, other = solved(recipe, scheme, 300), solved(recipe, scheme, 300, units)
    np.testing.assert_array_equal(one.status.values, other.status.values)
    assert off(other.normal_force.values / units.force, one.normal_force.values) < 1e-8
    assert off(other.tangential_force.values / units.force, one.tangential_force.values) < 1e-8
    assert off(other.slip_velocity.values / units.velocity, one.slip_velocity.values) < 1e-8
    assert off(other.friction_loss.values / units.energy, one.friction_loss.values) < 1e-8
    assert off(other.kinetic_and_elastic.values / units.energy, one.kinetic_and_elastic.values) < 1e-8


def test_units_reject_a_length_that_is_not_scaled():
    """Negative control: the velocity of a law left in the old units."""
    foot = Foot(st.Stribeck(0.6, 0.3, 0.02), 0.0, 0.0, 0.03, 0.0, 50.0)
    recipe = Recipe("chain", (foot,), (0.3,), (1e4,), (1.0,), 5.0, 0.0, 0.0)
    units = Units(length=2.0)
    wrong = replace(recipe, feet=(replace(foot, law=st.Stribeck(0.6, 0.3, 0.01)),))
    one, other = run_of(recipe, SCHEMES[1], 300), run_of(wrong, SCHEMES[1], 300, units)
    assert off(other.tangential_force.values / units.force, one.tangential_force.values) > 1e-3


def sliding_block(law, speed=1.0):
    """A free flat block of 60 x 40 mm on two feet, thrown along a floor under its weight."""
    mass, half, height = 0.3, 0.03, 0.02
    inertia = mass * (half**2 + height**2) / 3.0
    feet = {
        name: np.array([[1.0, 0.0, height], [0.0, 1.0, place]]) for name, place in (("rear", -half), ("front", half))
    }
    block = st.ReducedBody(np.diag([mass, mass, inertia]), np.zeros((3, 3)), feet, translation=np.eye(2, 3))
    contacts = [st.PointContact(block.at(name), st.RigidTrack(), friction=law, name=name) for name in feet]
    return st.System(contacts, [st.Gravity(10.0), st.InitialVelocity(block, x=speed)])


@BOTH
@pytest.mark.parametrize("law", [st.Coulomb(0.4), st.Stribeck(0.6, 0.4, 0.2), st.LuGre(0.5, 0.4, 0.1, 1e4, 1.0)])
def test_a_free_flat_block_that_slides_does_not_lift(law, scheme):
    """Both feet stay down, the front one takes mu M g height / length more, and it slows down by mu g."""
    step = 1e-4
    run = st.simulate(sliding_block(law), 0.1, scheme=scheme, step=step, sample_rate=1 / step, probes=[])
    assert violations(run, sliding_block(law)) == set()
    assert not np.any(run.status.values == 0)
    assert np.abs(run.gap.values).max() < 1e-15
    last = run.isel(time=-1)
    ratio = float(np.abs(last.tangential_force).sum() / last.normal_force.sum())
    assert float(last.normal_force.sum()) == pytest.approx(3.0, rel=1e-9)
    # The friction -mu M g at the height 20 mm below the centre turns it forward.
    rear, front = last.normal_force.values
    assert front - rear == pytest.approx(ratio * 3.0 * 0.02 / 0.03, rel=1e-6)


def test_a_block_that_trips_lifts():
    """Negative control: beyond mu = half length / height = 1.5 it must turn over."""
    run = st.simulate(sliding_block(st.Coulomb(1.8)), 0.05, step=1e-4, sample_rate=1e4, probes=[])
    assert np.any(run.status.values[:, 0] == 0)


def shaken_and_stuck(law, force):
    """A block on two feet, pressed with 20 N and shaken along the floor within the cone."""
    foot = Foot(law, 0.0, 0.0, 0.0, 0.0, 50.0)
    recipe = Recipe("block", (foot, foot), (0.5, 1.0), (1e5, 2e5), (20.0, 30.0), 20.0, 0.0, 0.0)
    system = build(recipe)
    back = system.contacts[0].tip.body.at("back")
    shaking = st.Force(back, x=force, history=st.Harmonic(60.0))
    return st.System(system.contacts, [*system.drives, shaking], system.connections)


@BOTH
@pytest.mark.parametrize(
    "law", [st.Coulomb(0.6), st.StaticKinetic(0.6, 0.3), st.Stribeck(0.6, 0.3, 0.01), st.LinearWeakening(0.6, 5.0)]
)
def test_a_stuck_contact_does_not_creep(law, scheme):
    """A million steps within the cone: less than 1e-12 of a block of 60 mm."""
    step = 2e-5
    words = {"scheme": scheme, "step": step, "sample_rate": 1e3, "probes": []}
    system = shaken_and_stuck(law, 3.0)
    settled = st.simulate(system, 0.2, **words)
    run = st.simulate(system, 1e6 * step, start=settled, **words)
    assert np.all(run.status_share.values[..., 1] == 1.0)
    assert np.ptp(run.tangential_force.values) > 0.5
    drift = run.state_carried.values[:, layout.MATERIAL] - settled.state_carried.values[:, layout.MATERIAL]
    assert np.abs(drift).max() <= 1e-12 * 0.06


def test_creep_harness_rejects_a_law_that_creeps():
    """Negative control: bristles shaken within the cone wander."""
    words = {"step": 2e-5, "sample_rate": 1e3, "probes": []}
    system = shaken_and_stuck(st.LuGre(0.6, 0.3, 0.01, 1e4), 3.0)
    settled = st.simulate(system, 0.2, **words)
    run = st.simulate(system, 1.0, start=settled, **words)
    drift = run.state_carried.values[:, layout.MATERIAL] - settled.state_carried.values[:, layout.MATERIAL]
    assert np.abs(drift).max() > 1e-9


def broken(change, law):
    """Result of the harness for a mass on a belt under a law, with its record changed."""
    foot = Foot(law, 0.0, 0.0, 0.03, 0.02, 60.0)
    recipe = Recipe("chain", (foot,), (0.3,), (1e4,), (1.0,), 5.0, 0.1, 0.0)
    run = run_of(recipe, SCHEMES[1], 2000)
    assert violations(run, build(recipe)) == set()
    run = run.copy(deep=True)
    change(run)
    return violations(run, build(recipe))


def turned(run):
    run["tangential_force"] *= -1


def a_little_weaker(run):
    run["tangential_force"] *= 1 - 1e-6


def weaker(run):
    run["tangential_force"] *= 0.8


def overlapping(run):
    run["gap"] -= 1e-12


def creeping(run):
    run["slip_velocity"] += 1e-9


def leaking(run):
    run["ledger_residual"] += 1e-9


@pytest.mark.parametrize(
    ("change", "law", "words"),
    [
        (turned, st.Coulomb(0.4), "slides the wrong way"),
        (turned, st.Stribeck(0.5, 0.3, 0.02), "slides the wrong way"),
        (turned, st.LuGre(0.5, 0.3, 0.02, 1e4), "off the law"),
        (turned, st.RateAndState(0.5, 0.02, 0.01, 1e-4, 1e-2), "off the law"),
        (a_little_weaker, st.Coulomb(0.4), "slides inside the cone"),
        (weaker, st.ExponentialWeakening(0.5, 0.3, 0.02), "off the law"),
        (weaker, st.LuGre(0.5, 0.3, 0.02, 1e4, 1.0), "off the law"),
        (weaker, st.RateAndState(0.5, 0.02, 0.01, 1e-4, 1e-2, "slip"), "off the law"),
        (overlapping, st.Coulomb(0.4), "gap below zero"),
        (overlapping, st.Coulomb(0.4), "force at a distance"),
        (creeping, st.StaticKinetic(0.5, 0.3), "slip while sticking"),
        (leaking, st.Coulomb(0.4), "ledger does not close"),
    ],
)
def test_harness_rejects_a_broken_law(change, law, words):
    """Negative control: friction reversed or too weak, an overlap, a creep, a leak."""
    assert words in broken(change, law)


def test_harness_rejects_a_penalty_contact():
    """Negative control: a mass dropped on a stiff spring in place of the exact contact, marched here.

    Central differences of the same mass; the penalty of 1e7 N/m holds 1 N at 1e-7 m below the floor.
    """
    step, mass, stiffness, mu = 1e-5, 0.1, 1e7, 0.4
    body = st.PointMass(mass)
    contact = st.PointContact(body.centre, st.RigidTrack(0.2), friction=st.Coulomb(mu), gap=1e-6)
    system = st.System(contact, [st.Gravity(10.0)])
    run = st.simulate(system, 2000 * step, scheme=SCHEMES[0], step=step, sample_rate=1 / step, probes=[])
    assert violations(run, system) == set()
    height, before, rows = 1e-6, 1e-6 + 5.0 * step**2, []
    for _ in range(2000):
        normal = stiffness * max(-height, 0.0)
        height, before = 2 * height - before + step**2 * (normal / mass - 10.0), height
        rows.append((normal, height))
    normal, gap = np.array(rows).T
    penalty = run.copy(deep=True)
    penalty["normal_force"].values[:], penalty["gap"].values[:] = normal, gap
    penalty["tangential_force"].values[:] = mu * normal * np.sign(-run.slip_velocity.values)
    penalty["status"].values[:] = np.where(normal > 0, 2, 0)
    assert {"gap below zero", "force at a distance"} <= violations(penalty, system)


def test_harness_rejects_friction_with_the_wrong_sign():
    """Negative control: the solve of one contact in plain Python with reversed friction replaces the kernel's."""
    from stridula._kernels.contact import exact as kernel
    from stridula._kernels.layout.contact_values import Before, Compliance, Free, Law

    law, step = st.Coulomb(0.4), 1e-4
    marched = Law(layout.COULOMB, np.array([[0.4] + [0.0] * (LAW_COLUMNS - 1)]), 0, 0.4, 0.0)

    def record(sense):
        """A mass of 1 kg sliding at 1 m/s under 10 N, marched here with the kernel's solve."""
        system = st.System(
            st.PointContact(st.PointMass(1.0).centre, st.RigidTrack(-1.0), friction=law),
            [st.Force(st.PointMass(1.0).centre, y=-10.0)],
        )
        run = st.simulate(system, 200 * step, scheme=SCHEMES[0], step=step, sample_rate=1 / step, probes=[])
        slip, columns = step * 1.0, []
        compliance = Compliance(step**2, 0.0, 0.0, step**2)
        for _ in range(200):
            before = Before(2.0, slip, slip, 0.0, 10.0, 4.0, 0.0)
            free = Free(-10.0 * step**2, slip, 0.0, compliance, 0.0)
            normal, tangential, status, *_ = kernel.solve_contact.py_func(free, marched, before, step)
            tangential *= sense
            slip -= tangential * step**2
            columns.append((normal, tangential, status, slip / step))
        names = ("normal_force", "tangential_force", "status", "slip_velocity")
        for name, values in zip(names, np.array(columns).T, strict=True):
            run[name].values[:] = values
        run["friction_loss"].values[:] = np.cumsum(run.tangential_force.values * run.slip_velocity.values * step)
        return run, system

    assert violations(*record(1.0)) == set()
    assert {"friction gives energy", "slides the wrong way"} <= violations(*record(-1.0))
