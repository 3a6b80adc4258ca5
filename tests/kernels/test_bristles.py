"""LuGre's bristles in space: one step against root finding, and a march against a slow twin of its equations."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from physics.cases import SCHEME_NAMES
from scipy.optimize import root

import stridula as st
from kernels.general_twin import before_start, central, exact
from stridula._kernels import layout as at
from stridula.integration.contact_solve import GaussSeidel
from stridula.integration.forces import forces_of

LAW = st.LuGre(0.6, 0.35, 0.05, 2e4, 8.0, 0.2)


def bristles_after(law, z, v, h):
    """Deflections after `h` at the constant slip velocity `v`, both vectors: a relaxation to the slip's direction."""
    speed = np.linalg.norm(v)
    curve = law.kinetic + (law.static - law.kinetic) * np.exp(-((speed / law.velocity) ** 2))
    rate = law.stiffness * speed / curve
    if rate * h < 1e-9:
        return z + (v - rate * z) * h
    return v / rate + (z - v / rate) * np.exp(-rate * h)


def ratios(law, z, v, h):
    """Ratios of forces along both tangents over a step: with the mean of the bristles, and their rate."""
    new = bristles_after(law, z, v, h)
    return law.stiffness * (z + new) / 2 + law.damping * (new - z) / h + law.viscous * v


def forces_by_roots(law, gap, slip, w, z, last, earlier, h):
    """Normal force, tangential forces and slip velocity of a closed contact, from three equations in three unknowns."""
    free = (9 * slip + 6 * last + earlier) / (16 * h)
    size = -gap / w[0, 0]
    moves = np.abs(free).max() + 9 / (16 * h) * np.abs(w[1:]).max() * size

    def pushed(x):
        normal, v = size * x[0], moves * x[1:]
        return normal, v, np.array([normal, *(-normal * ratios(law, z, v, h))])

    def left(x):
        _, v, forces = pushed(x)
        reached = (9 * (slip + w[1:] @ forces) + 6 * last + earlier) / (16 * h)
        return np.array([(gap + w[0] @ forces) / -gap, *((v - reached) / moves)])

    found = []
    for start in (
        (3 * last - earlier) / (2 * h * moves),
        free / moves,
        np.zeros(2),
        -free / moves,
        1e-3 * free / moves,
    ):
        solved = root(left, np.array([1.0, *start]), tol=1e-15)
        # Once more from there, to round-off.
        solved = root(left, solved.x, tol=1e-15)
        if np.abs(left(solved.x)).max() < 1e-12 and solved.x[0] > 0:
            found.append(solved.x)
    assert found
    assert np.ptp(found, axis=0).max() < 1e-8
    normal, v, forces = pushed(found[0])
    return normal, -forces[1:], v


def test_one_step_has_the_forces_of_root_finding():
    random, step, speeds = np.random.default_rng(11), 1e-4, []
    codes = np.array([at.LUGRE, at.SECOND_TANGENT])
    laws = np.zeros((2, at.LAW_PARAMETERS))
    laws[:, :6] = list(LAW.parameters().values())
    for _ in range(300):
        half = random.standard_normal((3, 3))
        w = 1e-8 * 10.0 ** random.uniform(-1.0, 1.0) * (half @ half.T + 1.5 * np.eye(3))
        gap = -(10.0 ** random.uniform(-8.0, -5.0))
        last = step * 10.0 ** random.uniform(-4.0, 0.5) * random.standard_normal(2)
        earlier = last * (1.0 + 0.1 * random.standard_normal(2))
        slip = last + abs(gap) * random.standard_normal(2)
        z = 0.6 * LAW.kinetic / LAW.stiffness * random.standard_normal(2)
        normal, pulled, v = forces_by_roots(LAW, gap, slip, w, z, last, earlier, step)
        compliance = np.zeros((4, 4))
        compliance[np.ix_([0, 1, 3], [0, 1, 3])] = w
        carried = np.zeros((2, at.CARRIED))
        carried[:, at.FRICTION_STATE], carried[:, at.LAST_SLIP], carried[:, at.EARLIER_SLIP] = z, last, earlier
        found = forces_of(np.array([gap, 0.0]), slip, compliance, (codes, laws), carried, step, GaussSeidel())
        assert found[0, 0] == pytest.approx(normal, rel=1e-10)
        np.testing.assert_allclose(found[:, 1], pulled, atol=1e-9 * normal)
        speeds.append(np.linalg.norm(v))
    # Creep and sliding.
    assert np.mean(np.array(speeds) < LAW.velocity) > 0.1
    assert np.mean(np.array(speeds) > LAW.velocity) > 0.1


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
    z, out = np.zeros(2), SimpleNamespace(normal=[], tangential=[], state=[], slip=[])
    for n in range(STEPS):
        free = a @ q - b @ q_before + load @ force
        # For the integral of the sine from zero.
        rise = LIFT * (1 - np.cos(2 * np.pi * FREQUENCY * (n + 1) * STEP)) / (2 * np.pi * FREQUENCY)
        gap, slip = GAP - rise + rows[0] @ free, rows[1:] @ (free - q) - belt * STEP
        pushes, velocity = np.zeros(3), None
        if gap < 0:
            normal, pulled, velocity = forces_by_roots(law, gap, slip, w, z, last, earlier, STEP)
            pushes = np.array([normal, *-pulled])
        q_before, q = q, free + load @ rows.T @ pushes
        z = np.zeros(2) if velocity is None else bristles_after(law, z, velocity, STEP)
        last, earlier = rows[1:] @ (q - q_before) - belt * STEP, last
        for name, value in (("normal", pushes[0]), ("tangential", -pushes[1:]), ("state", z), ("slip", last / STEP)):
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
