"""Runs that stop with an error: time, place and cause are reported, and the record before is kept."""

from __future__ import annotations

from math import radians

import numpy as np
import pytest
from physics.cases import SCHEME_NAMES, SCHEMES

import stridula as st
from stridula._kernels.books.ledger import Account, believed
from stridula._kernels.layout import columns as layout
from stridula.integration import together as together_module
from stridula.integration.marches import March
from stridula.integration.stops import CAUSE, ENDED, WHAT
from stridula.lowering import blocks as blocks_module

BOTH = pytest.mark.parametrize("scheme", SCHEMES, ids=SCHEME_NAMES)
STEP = 1e-4
MASS = st.PointMass(0.2)


def oscillator(law=None, history=None, size=0.0) -> st.System:
    """A mass on a belt on a spring; a force of `size` along x from a history."""
    contact = st.PointContact(MASS.centre, st.RigidTrack(0.1), friction=law or st.Coulomb(0.3), name="shoe", gap=1e-6)
    drives = [st.Force(MASS.centre, y=-2.0), st.Force(MASS.centre, x=size, history=history or st.Constant())]
    joints = [st.Spring(MASS.centre, stiffness=500.0), st.Dashpot(MASS.centre, coefficient=0.5)]
    return st.System(contact, drives, joints)


def stopped(system, duration=0.2, **words):
    """The exception that a run ends with; its message is one line."""
    with pytest.raises(st.Diverged) as caught:
        st.simulate(system, duration, **{"step": STEP, "sample_rate": 1e4, "probes": []} | words)
    assert "\n" not in str(caught.value)
    return caught.value


def check(stop, ended, until, name="shoe"):
    """The end is named in record and message, with time, contact and cause; the record before it is complete."""
    record, message = stop.record, str(stop)
    assert record.attrs["ended"] == ended
    assert WHAT[ended] in message
    assert f"likely cause: {CAUSE[ended]}" in message
    assert f"step {STEP:.3g} s" in message
    assert f"after t = {record.sizes['time'] * STEP:.6g} s" in message
    assert f"{name} s" in message
    for word in (" at ", "N normal", "N tangential"):
        assert word in message
    assert until[0] <= record.sizes["time"] <= until[1]
    for column in record.data_vars:
        if "time" in record[column].dims:
            assert np.all(np.isfinite(record[column])), column


def check_refused(stop, system, **words):
    with pytest.raises(
        ValueError, match=rf"^start must be a run that can be continued, got one that ended '{ended_of(stop)}'"
    ):
        st.simulate(system, 0.1, **{"step": STEP, "sample_rate": 1e4, "probes": [], "start": stop.record} | words)


def ended_of(stop):
    return stop.record.attrs["ended"]


def test_every_failure_has_a_message():
    for ended in ENDED.values():
        assert (ended in WHAT) == (ended in CAUSE) == (ended not in ("finished", "off the track"))


@BOTH
def test_not_finite(scheme):
    """A force that overflows at 0.1 s."""
    system = oscillator(history=st.Sampled((0.0, 0.1, 0.101), (0.0, 0.0, 1.0)), size=1e200)
    stop = stopped(system, scheme=scheme)
    check(stop, "not finite", (990, 1010))
    check_refused(stop, system, scheme=scheme)


def faulty(monkeypatch, change):
    """Put a fault into the arrays that the march reads."""
    recurrence = blocks_module.recurrence

    def wrong(*arguments):
        modes = recurrence(*arguments)
        change(modes)
        return modes

    monkeypatch.setattr(blocks_module, "recurrence", wrong)


def chain() -> st.System:
    """Two masses coupled by a spring and a dashpot."""
    other = st.PointMass(0.1, "other")
    joints = [st.Spring(MASS.centre, other.centre, stiffness=800.0), st.Dashpot(other.centre, coefficient=1.0)]
    alone = oscillator()
    return st.System(alone.contact, alone.drives, [*alone.connections, *joints])


def damping_below_zero(modes):
    """A dashpot with negative damping: increments that grow."""
    modes.block[layout.B, 0] += 0.02 * (modes.block[layout.B, 0] > 0)
    modes.matrices[layout.KEPT, :1, :1] += 0.02


def heavier_answer(modes):
    """Contact forces that move bodies by more than their mass allows."""
    modes.matrices[layout.MOBILITY] *= 1.001


def leaking_energy(modes):
    """A kinetic energy that differs from that of the march."""
    modes.matrices[layout.KINETIC] *= 1.0 + 1e-6


@BOTH
@pytest.mark.parametrize(
    ("make", "fault"),
    [
        (oscillator, damping_below_zero),
        (chain, damping_below_zero),
        (chain, heavier_answer),
        (chain, leaking_energy),
    ],
)
def test_created_energy(make, fault, scheme, monkeypatch):
    """A fault in the recurrence shows in the energies, long before anything overflows.

    The march of one contact has no coefficients of its own for energies, which could differ from those of the motion.
    """
    system = make()
    st.simulate(system, 0.2, scheme=scheme, step=STEP, sample_rate=1e4, probes=[])
    faulty(monkeypatch, fault)
    stop = stopped(system, scheme=scheme)
    check(stop, "energy created", (0, 1000))
    monkeypatch.undo()
    check_refused(stop, system, scheme=scheme)


@BOTH
def test_a_state_modified_from_outside(scheme, monkeypatch):
    """A position moved by a part in ten thousand between two chunks of a march."""
    advance = March.advance

    def stray(march, *arguments):
        march.modes.rows[0, 0] *= 1.0 + 1e-4
        return advance(march, *arguments)

    monkeypatch.setattr(March, "advance", stray)
    monkeypatch.setattr(together_module, "STEPS_PER_CHUNK", 100)
    check(stopped(oscillator(), scheme=scheme), "energy created", (0, 1000))


def test_created_energy_keeps_the_earlier_samples(monkeypatch):
    """The record kept is that of the correct run, bit for bit, up to the wrong sample."""
    system = oscillator(history=st.Harmonic(20.0), size=1.0)
    words = {"step": STEP, "sample_rate": 1e4, "probes": [st.Velocity(MASS.centre, "x")]}
    whole = st.simulate(system, 0.2, **words)
    advance = March.advance

    def wrong(*arguments):
        (chunk,) = advance(*arguments)
        chunk.energies[700:, layout.DRIVE_WORK] += 1.0
        return [chunk]

    monkeypatch.setattr(March, "advance", wrong)
    stop = stopped(system, probes=words["probes"])
    check(stop, "energy created", (700, 700))
    for name in ("normal_force", "tangential_force", "kinetic_and_elastic", "velocity"):
        # The last sample of a probe lacks later values for the filter.
        np.testing.assert_array_equal(stop.record[name][:699], whole[name][:699])


def damping_that_gives(energies):
    """Energy from damping, in a ledger that closes."""
    energies[layout.STORED, 60:] += 1e-3
    energies[layout.DAMPING_LOSS, 60:] -= 1e-3


def created_at(energies, dissipative=True, passive=True):
    """Return the first sample at which energy was created, or None."""
    account = Account(np.zeros(layout.ENERGIES), 0.0, 1.0, 0.0, passive, dissipative, True)
    sample, ended, _ = believed(energies, 0, energies.shape[1], account)
    return sample if ended == layout.ENERGY_CREATED else None


@pytest.mark.parametrize(
    ("change", "wrong"),
    [
        (lambda e: None, None),
        (lambda e: e[layout.DRIVE_WORK].__setitem__(slice(30, None), 2.0), 30),
        (lambda e: e[layout.STORED].__setitem__(slice(40, None), -1e-3), 40),
        (lambda e: e[layout.FRICTION_LOSS].__setitem__(slice(50, None), -1e-3), 50),
        (damping_that_gives, 60),
    ],
)
def test_definition_of_created_energy(change, wrong):
    """A ledger that does not close, stored energy below zero, friction that adds energy."""
    energies = np.zeros((layout.ENERGIES, 100))
    energies[layout.STORED] = energies[layout.DRIVE_WORK] = np.linspace(0.0, 1.0, 100)
    change(energies)
    assert created_at(energies) == wrong


def test_friction_of_a_law_with_state_may_give_back_what_it_stored():
    energies = np.zeros((layout.ENERGIES, 100))
    energies[layout.STORED] = energies[layout.DRIVE_WORK] = 1.0
    energies[layout.FRICTION_LOSS, :50] = 1e-3
    assert created_at(energies) == 50
    assert created_at(energies, dissipative=False) is None


def test_bristles_under_a_growing_normal_force_may_give_more_than_they_took():
    energies = np.zeros((layout.ENERGIES, 100))
    energies[layout.STORED, 50:] = energies[layout.CONTACT_WORK, 50:] = 0.1
    assert created_at(energies) == 50
    assert created_at(energies, passive=False) is None


def groove(opening, mu=0.0, history=None) -> st.System:
    """A mass pressed by 1 N, constant or times a history, into a groove with walls at an angle of `opening` [deg]."""
    steep = radians(90.0 - opening / 2.0)
    walls = [
        st.PointContact(MASS.centre, st.RigidTrack(), inclination=lean, friction=st.Coulomb(mu), name=name)
        for name, lean in (("left", -steep), ("right", steep))
    ]
    press = {} if history is None else {"history": history}
    return st.System(walls, [st.Force(MASS.centre, y=-1.0, **press)])


# The forces of a step differ from those of the previous one.
CHANGING = st.Harmonic(100.0)


def test_a_wide_groove_is_solved():
    """Each wall carries 1 / (2 sin(half the opening)) N."""
    run = st.simulate(groove(20.0), 0.01, step=STEP, sample_rate=1e4, probes=[])
    assert not run.unsolved_steps.any()
    assert run.contact_sweeps.max() > 1
    np.testing.assert_allclose(run.normal_force.values[-1], 0.5 / np.sin(radians(10.0)), rtol=1e-9)


@pytest.mark.parametrize("opening", [1.0, 0.3, 0.1, 0.01])
@pytest.mark.parametrize("mu", [0.0, 0.01])
def test_a_narrow_groove_is_counted_or_stopped_or_right(opening, mu):
    """It needs far more sweeps than allowed. No force may count as a solution that leaves the walls overlapped.

    An exact solution, a step counted as unsolved with forces within the tolerance of a stop, or a stop; never a run
    that continues with a hundredth of the force.
    """
    try:
        run = st.simulate(groove(opening, mu), 0.01, step=STEP, sample_rate=1e4, probes=[])
    except st.Diverged as stop:
        check(stop, "contact unsolved", (0, 99), name="left")
        check_refused(stop, groove(opening, mu))
        return
    fall = STEP**2 / 0.2 * np.sin(radians(opening / 2.0))
    assert run.gap.values.min() > -1e-2 * fall
    if mu == 0.0:
        np.testing.assert_allclose(run.normal_force.values[-1], 0.5 / np.sin(radians(opening / 2.0)), rtol=1e-2)


def test_too_few_sweeps_are_counted():
    """One sweep is not enough: every step in which both walls press is counted, or the run stops."""
    try:
        run = st.simulate(
            groove(60.0, history=CHANGING),
            0.01,
            step=STEP,
            sample_rate=1e4,
            probes=[],
            contact_solve=st.GaussSeidel(sweeps=1),
        )
    except st.Diverged as stop:
        check(stop, "contact unsolved", (0, 99), name="left")
        return
    assert run.unsolved_steps.values[:2].sum() > 0
    assert run.contact_sweeps.max() == 1


def test_a_stop_in_the_first_sample_keeps_an_empty_record():
    """Nothing was recorded before; the message still says where the contacts are."""
    with pytest.raises(st.Diverged) as caught:
        st.simulate(
            groove(60.0, history=CHANGING),
            0.01,
            step=STEP,
            sample_rate=1e3,
            probes=[],
            contact_solve=st.GaussSeidel(sweeps=1),
        )
    check(caught.value, "contact unsolved", (0, 0), name="left")


def walking_block(law) -> st.System:
    """A block on two feet that is pressed and shaken; each foot slips while the other one holds."""
    half, mass = 0.03, 0.5
    points, k = {}, np.zeros((7, 7))
    for n, place in enumerate((-half, half)):
        own = slice(3 + 2 * n, 5 + 2 * n)
        k[own, own] = [[1e5, 3e4], [3e4, 2e5]]
        points[f"foot {n}"] = np.zeros((2, 7))
        points[f"foot {n}"][:, :3] = [[1.0, 0.0, 0.02], [0.0, 1.0, place]]
        points[f"foot {n}"][:, own] = np.eye(2)
    points["back"] = np.zeros((2, 7))
    points["back"][:, :3] = [[1.0, 0.0, -0.02], [0.0, 1.0, 0.0]]
    m = np.diag([mass, mass, mass * 4e-4] + [0.05 * mass] * 4)
    block = st.ReducedBody(m, k, points, damping=1e-4 * k, name="block")
    feet = [st.PointContact(block.at(f"foot {n}"), st.RigidTrack(), friction=law, name=f"foot {n}") for n in range(2)]
    drives = [
        st.Force(block.at("back"), y=-20.0),
        st.Force(block.at("back"), x=9.0, history=st.Harmonic(60.0)),
    ]
    return st.System(feet, drives, [st.Spring(block.at("back"), stiffness=1e4)])


@BOTH
@pytest.mark.parametrize("law", [st.Coulomb(0.6), st.StaticKinetic(0.6, 0.3), st.Stribeck(0.6, 0.3, 0.01)])
def test_two_feet_that_let_go_find_their_forces(law, scheme):
    """A foot that breaks away unloads by the drop from the static to the kinetic force, and the effect on the other
    foot must not make the first one stick again: every step has a solution, whichever foot slips first."""
    run = st.simulate(walking_block(law), 0.3, scheme=scheme, step=5e-5, sample_rate=2e4, probes=[])
    assert not run.unsolved_steps.any()
    assert {1, 2} <= set(np.unique(run.status.values))
