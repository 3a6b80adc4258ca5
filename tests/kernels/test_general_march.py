"""The compiled march against the twin, step by step, for everything that a system may hold."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from physics.cases import SCHEMES

import stridula as st
from kernels import systems, twin
from kernels.agreement import disagreements
from kernels.systems import SYSTEMS
from kernels.twin import laws
from kernels.twin.contact import Contact

STEPS = 1000
BOTH = [pytest.param(SCHEMES[0], twin.central, id="central"), pytest.param(SCHEMES[1], twin.exact, id="exact")]


def both(system, scheme, form, step, steps=STEPS):
    run = st.simulate(system, steps * step, scheme=scheme, step=step, sample_rate=1 / step, probes=[])
    return run, twin.march(system, form, step, steps)


@cache
def both_of(name, exact=True):
    """Run and trail of one of `SYSTEMS`, which several tests compare."""
    make, step = SYSTEMS[name]
    scheme, form = BOTH[exact].values
    return both(make(), scheme, form, step)


@pytest.mark.parametrize("exact", [pytest.param(False, id="central"), pytest.param(True, id="exact")])
@pytest.mark.parametrize("name", SYSTEMS)
def test_kernel_and_twin_agree_at_every_step(name, exact):
    run, trail = both_of(name, exact)
    assert disagreements(run, trail) == {}
    # All combinations of states were tried at one step in ten: never more than one was consistent.
    assert set(trail.solutions) == {1}
    assert "unsolved_steps" not in run or not run.unsolved_steps.any()
    assert set(np.unique(trail.status)) - {0}, "no contact in the steps compared: the case tests nothing"


def test_the_systems_visit_all_states():
    """Each state fills a tenth of some contact, sticking and separation under laws with and without state."""
    shares = {}
    for make, step in SYSTEMS.values():
        system = make()
        run = st.simulate(system, STEPS * step, step=step, sample_rate=1 / step, probes=[])
        parts = run.status_share.values.reshape(STEPS, -1, 3).mean(axis=0)
        for contact, part in zip(system.contacts, parts, strict=True):
            kind = type(contact.friction)
            shares[kind] = np.maximum(shares.get(kind, 0.0), part)
    assert np.all(shares[st.Coulomb] > 0.1)
    assert np.all(shares[st.StaticKinetic] > 0.1)
    assert np.all(shares[st.LuGre] > 0.05)
    assert np.all(shares[st.RateAndState] > 0.02)
    for kind in (st.Stribeck, st.LinearWeakening, st.TabulatedFriction):
        assert np.all(shares[kind][1:] > 0.1)
    assert shares[st.ExponentialWeakening][2] > 0.1


def slightly(change, system):
    """The system with one number or one part changed, or left out."""
    contacts, joints = list(system.contacts), list(system.connections)
    law = contacts[0].friction
    if change == "damping of the bristles":
        contacts[0] = replace(contacts[0], friction=replace(law, damping=law.damping * (1 + 1e-3)))
    elif change == "effect of age":
        contacts[0] = replace(contacts[0], friction=replace(law, b=law.b * (1 + 1e-4)))
    elif change == "velocity of weakening":
        contacts[0] = replace(contacts[0], friction=replace(law, velocity=law.velocity * (1 + 1e-4)))
    elif change == "velocity of the belt":
        contacts[0] = replace(contacts[0], track=replace(contacts[0].track, velocity=0.02 * (1 + 1e-5)))
    elif change == "height of the surface":
        profile = contacts[0].track.profile
        higher = replace(profile, height=(1 + 1e-3) * np.array(profile.height))
        contacts[0] = replace(contacts[0], track=replace(contacts[0].track, profile=higher))
    elif change == "capacity":
        layers = contacts[0].heating
        larger = replace(layers, capacity=(1 + 1e-4) * np.array(layers.capacity))
        contacts[0] = replace(contacts[0], heating=larger)
    elif change == "inclination":
        contacts[0] = replace(contacts[0], inclination=contacts[0].inclination * (1 + 1e-5))
    elif change == "direction of the line":
        sheet = contacts[0].track
        line = replace(sheet.line, direction=sheet.line.direction + 1e-4)
        contacts[0] = replace(contacts[0], track=replace(sheet, line=line))
    elif change == "dashpot left out":
        joints = [joint for joint in joints if not isinstance(joint, st.Dashpot)]
    elif change == "cubic":
        joints = [replace(one, cubic=one.cubic * (1 + 1e-4)) if hasattr(one, "cubic") else one for one in joints]
    elif change == "kink":
        tables = [one for one in joints if hasattr(one, "displacement")]
        moved = {one: replace(one, displacement=np.multiply(one.displacement, 1.0 + 1e-4)) for one in tables}
        joints = [moved.get(one, one) for one in joints]
    elif change == "valve":
        tables = [one for one in joints if isinstance(one, st.TabulatedDashpot)]
        moved = {one: replace(one, force=np.multiply(one.force, 1.0 + 1e-4)) for one in tables}
        joints = [moved.get(one, one) for one in joints]
    elif change == "spring":
        joints[0] = replace(joints[0], stiffness=joints[0].stiffness * (1 + 1e-5))
    return st.System(contacts, system.drives, joints)


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ("damping of the bristles", "mass on a belt, bristles"),
        ("effect of age", "mass on a belt, aging"),
        ("velocity of weakening", "chain on a belt"),
        ("velocity of the belt", "mass on a belt, static and kinetic"),
        ("height of the surface", "mass on a rough belt"),
        ("height of the surface", "mass thrown over a dip"),
        ("capacity", "mass on a belt, fading"),
        ("inclination", "inclined plane"),
        ("inclination", "groove"),
        ("dashpot left out", "beam on a spring"),
        ("dashpot left out", "chain on a belt"),
        ("spring", "frozen contact"),
        ("cubic", "chain of nonlinear springs"),
        ("cubic", "beam with a stop"),
        ("kink", "chain of nonlinear springs"),
        ("kink", "beam with a stop"),
        ("valve", "chain of nonlinear dashpots"),
        ("direction of the line", "diagonal of a plate"),
    ],
)
def test_comparison_rejects_a_wrong_twin(change, name):
    """Negative control: a shared value is slightly different in the twin."""
    make, step = SYSTEMS[name]
    run, _ = both_of(name)
    assert disagreements(run, twin.march(slightly(change, make()), twin.exact, step, STEPS))


@pytest.mark.parametrize("wrong", ["polarisations", "slopes"])
def test_comparison_detects_wrong_motion_in_the_plane(wrong, monkeypatch):
    """Negative control: shear modes that move the other way across; slopes of the plane left out of the ledger."""
    name = "sprung plate soft in its plane"
    make, step = SYSTEMS[name]
    run, trail = both_of(name)
    assert disagreements(run, trail) == {}
    if wrong == "polarisations":
        sheet = make().contacts[0].track
        monkeypatch.setattr(st.ModalPlate, "polarisations", abs(sheet.polarisations))
    else:
        right = Contact.traces_at

        def without_slopes(self, x):
            traces = right(self, x)
            return traces._replace(slopes=traces.slopes * [[0.0], [1.0]])

        monkeypatch.setattr(Contact, "traces_at", without_slopes)
    found = disagreements(run, twin.march(make(), twin.exact, step, STEPS))
    assert "convection_work" in found
    assert (wrong == "slopes") == (len(found) == 1)


def test_comparison_distinguishes_an_exact_damping_matrix_from_its_diagonal():
    """Negative control: the block's damping, which couples its modes, projected on the diagonal."""
    make, step = SYSTEMS["thrown block"]
    system = make()
    block = system.contacts[0].tip.body
    diagonal = np.diag(np.diag(block.modes().damping_matrix))
    inverse = np.linalg.inv(block.shapes)
    projected = replace(block, damping=inverse.T @ diagonal @ inverse)
    ratios = projected.modes()
    assert ratios.damping_matrix is None
    np.testing.assert_allclose(2 * ratios.damping * ratios.angular_frequency, np.diag(diagonal), atol=1e-9)
    moved = [
        replace(contact, tip=projected.at(contact.tip.position), friction=contact.friction)
        for contact in system.contacts
    ]
    drives = [replace(system.drives[0], body=projected), system.drives[1]]
    other = st.System(moved, drives, [replace(system.connections[0], first=projected.at("back"))])
    run = st.simulate(other, STEPS * step, step=step, sample_rate=1 / step, probes=[])
    assert disagreements(run, twin.march(other, twin.exact, step, STEPS)) == {}
    assert disagreements(run, both_of("thrown block")[1])


def test_comparison_distinguishes_the_motion_of_bristles_from_eulers(monkeypatch):
    """Negative control: bristles that move on by explicit Euler's rule."""

    def by_euler(law, state, v, h):
        limit = laws.curve(law, abs(v)) / law.stiffness
        return state + h * (v - abs(v) * state / limit)

    run, trail = both_of("mass on a belt, bristles")
    assert disagreements(run, trail) == {}
    monkeypatch.setattr(laws, "state_after", by_euler)
    assert disagreements(run, twin.march(systems.oscillator(systems.BRISTLES), twin.exact, 2e-4, STEPS))


def test_one_contact_of_coupled_modes_takes_one_sweep():
    """It is solved exactly, without iteration."""
    make, step = SYSTEMS["frozen contact"]
    words = {"step": step, "sample_rate": 1 / step, "probes": []}
    once = st.simulate(make(), 2000 * step, contact_solve=st.GaussSeidel(sweeps=1), **words)
    np.testing.assert_array_equal(once.normal_force, st.simulate(make(), 2000 * step, **words).normal_force)
