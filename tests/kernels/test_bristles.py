"""Slips in space on their way through a step: one step against root finding, a march against its slow twin."""

from __future__ import annotations

from functools import partial
from types import SimpleNamespace

import numpy as np
import pytest
from physics.cases import SCHEME_NAMES

import stridula as st
from kernels.twin.modes import before_start, central, exact
from kernels.twin.way import SEPARATED, SLIDING, Before
from kernels.twin.way_in_space import closing, on_bristles, sliding
from stridula._kernels.layout import columns as at
from stridula._kernels.layout.laws import LAW_COLUMNS
from stridula.integration.contact_solve import GaussSeidel
from stridula.integration.forces import forces_of

LAW = st.LuGre(0.6, 0.35, 0.05, 2e4, 8.0, 0.2)


def test_one_step_has_the_forces_of_root_finding():
    random, step, speeds = np.random.default_rng(11), 1e-4, []
    codes, laws = np.array([at.LUGRE]), np.zeros((1, LAW_COLUMNS))
    laws[:, :6] = list(LAW.parameters().values())
    for _ in range(100):
        w, gap = compliance_of(random), -(10.0 ** random.uniform(-8.0, -5.0))
        last = step * 10.0 ** random.uniform(-4.0, 0.5) * random.standard_normal(2)
        earlier = last * (1.0 + 0.1 * random.standard_normal(2))
        slip = last + abs(gap) * random.standard_normal(2)
        z = 0.6 * LAW.kinetic / LAW.stiffness * random.standard_normal(2)
        before = Before(
            LAW,
            status=SLIDING,
            slip=last,
            earlier_slip=earlier,
            state=z,
            normal=abs(gap) / w[0, 0],
            tangential=0.3 * abs(gap) / w[0, 0] * random.standard_normal(2),
            past=0.15 * random.standard_normal(2),
        )
        normal, (ratios, _, after) = closing(gap, w, partial(on_bristles, before, slip, w, step))
        carried = carried_of(before, z)
        found = forces_of(np.array([gap]), slip[None], w, (codes, laws), carried, step, GaussSeidel())
        assert found[0, 0] == pytest.approx(normal, rel=1e-9)
        np.testing.assert_allclose(found[0, 1:], normal * ratios, atol=1e-8 * normal)
        speeds.append(np.linalg.norm(after - z) / step)
    # Creep and sliding.
    assert np.mean(np.array(speeds) < LAW.velocity) > 0.1
    assert np.mean(np.array(speeds) > 0.1 * LAW.velocity) > 0.1


@pytest.mark.parametrize("law", [st.StaticKinetic(0.5, 0.3), st.Stribeck(0.5, 0.3, 0.05)], ids=["constant", "falling"])
def test_one_step_of_a_slip_that_turns_has_the_forces_of_root_finding(law):
    random, step, turned = np.random.default_rng(12), 1e-4, []
    codes = np.array([at.STATIC_KINETIC if law.law == "static-kinetic" else at.STRIBECK])
    laws = np.zeros((1, LAW_COLUMNS))
    laws[:, : len(law.parameters())] = list(law.parameters().values())
    for _ in range(100):
        w, gap = compliance_of(random), -(10.0 ** random.uniform(-7.0, -6.0))
        last = step * 10.0 ** random.uniform(-3.5, -1.5) * random.standard_normal(2)
        slip = last + 0.5 * abs(gap) * random.standard_normal(2)
        way = last / np.linalg.norm(last)
        before = Before(law, SLIDING, slip=last, earlier_slip=last, tangential=np.zeros(2), past=0.15 * way)
        normal, found = closing(gap, w, partial(sliding, law, last, before.past, slip, w, step))
        if found is None:
            continue
        carried = carried_of(before, np.zeros(2))
        forces = forces_of(np.array([gap]), slip[None], w, (codes, laws), carried, step, GaussSeidel())
        assert forces[0, 0] == pytest.approx(normal, rel=1e-9)
        np.testing.assert_allclose(forces[0, 1:], normal * found[0], atol=1e-8 * normal)
        turned.append(abs(way[0] * found[0][1] - way[1] * found[0][0]) / np.linalg.norm(found[0]))
    assert len(turned) > 30
    assert np.mean(np.array(turned) > 0.1) > 0.2


def compliance_of(random):
    """A random compliance of normal and tangents [m/N], normal first."""
    half = random.standard_normal((3, 3))
    return 1e-8 * 10.0 ** random.uniform(-1.0, 1.0) * (half @ half.T + 4.0 * np.eye(3))


def carried_of(before, state):
    """What a contact of that past carries."""
    carried = np.zeros((1, at.CARRIED))
    carried[0, at.STATUS], carried[0, at.LAST_NORMAL] = before.status, before.normal
    for along_a, along_b, values in (
        (at.LAST_SLIP, at.LAST_SLIP_B, before.slip),
        (at.EARLIER_SLIP, at.EARLIER_SLIP_B, before.earlier_slip),
        (at.LAST_TANGENTIAL, at.LAST_TANGENTIAL_B, before.tangential),
        (at.PAST_RATIO, at.PAST_RATIO_B, before.past),
        (at.FRICTION_STATE, at.FRICTION_STATE_B, state),
    ):
        carried[0, [along_a, along_b]] = values
    return carried


# A march.

STIFFNESS = 1e5 * np.array(
    [[3.0, 0.8, -0.5, -0.3], [0.8, 2.0, 0.6, 0.2], [-0.5, 0.6, 4.0, -0.7], [-0.3, 0.2, -0.7, 5.0]]
)
DAMPING = 3e-4 * STIFFNESS + 2.0 * np.eye(4)
# Displacement of the point along x, y and z.
POINT = np.array([[1.0, 0.3, 0.0, -0.4], [0.2, 1.0, -0.3, 0.5], [0.0, 0.4, 1.1, 0.3]])
BELT, LATERAL, LIFT, FREQUENCY = 0.06, -0.03, 0.3, 70.0
LOAD = np.array([0.0, -40.0, 0.0])
GAP = 7e-4
STEP, STEPS = 5e-5, 1600


def pressed() -> st.System:
    """A body of four modes that push each other, on a shaken table that moves along both tangents."""
    body = st.ReducedBody(np.eye(4), STIFFNESS, {"foot": POINT}, damping=DAMPING, name="body")
    shaking = st.Harmonic(FREQUENCY)
    table = st.RigidTrack(velocity=BELT, lateral_velocity=LATERAL, normal_velocity=LIFT, normal_history=shaking)
    contact = st.PointContact(body.at("foot"), table, friction=LAW, gap=GAP)
    return st.System(contact, [st.Force(body.at("foot"), y=LOAD[1])])


def twin(scheme, law=LAW):
    """Every step of that body, from its equations."""
    rows = POINT[[1, 0, 2]]
    a, b, load = scheme(STIFFNESS, DAMPING, STEP)
    w = rows @ load @ rows.T
    force = POINT.T @ LOAD
    still = np.zeros(4)
    q, q_before = still, before_start(scheme, STIFFNESS, DAMPING, STEP, still, still, force)
    belt = np.array([BELT, LATERAL])
    last = rows[1:] @ (q - q_before) - belt * STEP
    earlier = 3 * last + 2 * STEP * belt
    past = Before(law, SEPARATED, last, earlier, state=np.zeros(2), tangential=np.zeros(2), past=np.zeros(2))
    out = SimpleNamespace(normal=[], tangential=[], state=[], slip=[])
    for n in range(STEPS):
        free = a @ q - b @ q_before + load @ force
        # For the integral of the sine from zero.
        rise = LIFT * (1 - np.cos(2 * np.pi * FREQUENCY * (n + 1) * STEP)) / (2 * np.pi * FREQUENCY)
        gap, slip = GAP - rise + rows[0] @ free, rows[1:] @ (free - q) - belt * STEP
        pushes, ratios, rest, z = np.zeros(3), np.zeros(2), np.zeros(2), np.zeros(2)
        if gap < 0:
            normal, (ratios, rest, z) = closing(gap, w, partial(on_bristles, past, slip, w, STEP))
            pushes = np.array([normal, *(-normal * ratios)])
        q_before, q = q, free + load @ rows.T @ pushes
        past = Before(
            law,
            status=SLIDING if gap < 0 else SEPARATED,
            slip=rows[1:] @ (q - q_before) - belt * STEP,
            earlier_slip=past.slip,
            state=z,
            normal=pushes[0],
            tangential=-pushes[1:],
            past=rest,
        )
        for name, value in (
            ("normal", pushes[0]),
            ("tangential", -pushes[1:]),
            ("state", z),
            ("slip", past.slip / STEP),
        ):
            getattr(out, name).append(value)
    return SimpleNamespace(**{name: np.array(values) for name, values in vars(out).items()})


def off(values, known):
    return np.abs(values - known).max() / np.abs(known).max()


@pytest.mark.parametrize("scheme", [central, exact], ids=SCHEME_NAMES)
def test_the_march_is_that_of_the_twin(scheme):
    own = {central: st.CentralDifference(), exact: st.ExactModal()}[scheme]
    run = st.simulate(pressed(), STEPS * STEP, scheme=own, step=STEP, sample_rate=1 / STEP, probes=[])
    known = twin(scheme)
    assert run.friction_state.dims == run.tangential_force.dims == ("time", "tangent")
    assert off(run.normal_force.values, known.normal) < 1e-9
    assert off(run.tangential_force.values, known.tangential) < 1e-9
    assert off(run.slip_velocity.values, known.slip) < 1e-9
    assert off(run.friction_state.values, known.state) < 1e-9
    assert set(np.unique(run.status)) == {0, 1, 2}
    assert int(run.landings.sum()) > 3
    # Friction is not along the slip, to which bristles would be held.
    crossed = known.tangential[:, 0] * known.slip[:, 1] - known.tangential[:, 1] * known.slip[:, 0]
    pulled = np.linalg.norm(known.tangential, axis=1) * np.linalg.norm(known.slip, axis=1)
    assert np.abs(crossed).max() > 0.1 * pulled.max()
