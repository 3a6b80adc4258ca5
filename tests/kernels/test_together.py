"""Forces of many contacts, whose compliance may be singular: found, lawful, whatever the order."""

from __future__ import annotations

import numpy as np
import pytest

import stridula as st
from stridula._kernels.contact.in_space import solve_in_space
from stridula._kernels.layout import columns as at
from stridula._kernels.layout.contact_values import BeforeInSpace, ComplianceInSpace, FreeInSpace, Law, Tangents
from stridula._kernels.layout.laws import LAW_COLUMNS, NEW_STATE, STATIC
from stridula.integration.contact_solve import GaussSeidel
from stridula.integration.forces import forces_of, solved
from stridula.lowering.own_laws import law_of_march

from .twin import faces

# Largest violation of the law of a contact, relative to the largest force.
LAWFUL = 1e-9


def forces(compliance, free, friction, tangents):
    """Return the forces that the kernel finds from rest, ``(normal, -tangential)`` of each contact."""
    count = len(friction)
    laws = np.zeros((count, LAW_COLUMNS))
    laws[:, STATIC] = friction
    given = (np.full(count, at.COULOMB), laws), np.zeros((count, at.CARRIED))
    found = forces_of(free[:, 0], free[:, 1:], compliance, *given, 1e-5, GaussSeidel())
    return found * [1.0, *[-1.0] * tangents]


def violation(force, compliance, free, friction):
    """Return the largest violation of the laws of contact and friction, in units of the largest force."""
    moved = free + (compliance @ force.ravel()).reshape(force.shape)
    normal, pulled, gap, slip = force[:, 0], force[:, 1:], moved[:, 0], moved[:, 1:]
    count, own = force.shape
    soft = np.array([np.trace(compliance[i * own :][:own, i * own :][:, :own]) / own for i in range(count)])
    size, speed = np.linalg.norm(pulled, axis=1), np.linalg.norm(slip, axis=1) / soft
    within = np.maximum(size - friction * normal, 0.0)
    # Friction is at the border of its cone where the contact slides, against the slip; at rest there is no slip.
    against = np.minimum(speed, np.abs(friction * normal - size))
    along = np.einsum("ij,ij->i", pulled, slip / soft[:, None])
    wrong_way = np.where(speed > 0.0, (along + size * speed) / np.maximum(speed, 1e-300), 0.0)
    wrong_way = np.minimum(wrong_way, speed)
    parts = (np.maximum(-normal, 0.0), np.maximum(-gap / soft, 0.0), np.minimum(normal, np.abs(gap) / soft))
    return max(np.max(part) for part in (*parts, within, against, wrong_way)) / normal.max()


def face(random, tangents):
    """Return a random problem: compliance of rank 50 to 100 %, motion without forces, friction of each contact.

    The motion is one under forces in and beyond their cones, some contacts nearly unloaded, and one without forces.
    """
    count, own = int(random.integers(4, 25)), 1 + tangents
    modes = random.standard_normal((own * count, int(np.ceil(own * count * random.uniform(0.5, 1.0)))))
    compliance = modes @ modes.T / modes.shape[1]
    normal = np.abs(random.standard_normal(count)) * random.choice([0.01, 1.0], count)
    spread = random.choice([0.0, 0.3, 1.0])
    given = np.column_stack([normal, spread * normal[:, None] * random.standard_normal((count, tangents))])
    free = -compliance @ given.ravel() + random.choice([0.0, 0.05]) * modes @ random.standard_normal(modes.shape[1])
    return compliance, free.reshape(count, own), np.full(count, random.choice([0.1, 0.3, 0.6]))


@pytest.mark.parametrize("tangents", [1, 2])
def test_forces_of_random_faces_are_lawful(tangents):
    random, statuses = np.random.default_rng(tangents), set()
    for _ in range(150):
        compliance, free, friction = face(random, tangents)
        found = forces(compliance, free, friction, tangents)
        assert violation(found, compliance, free, friction) < LAWFUL
        size = np.linalg.norm(found[:, 1:], axis=1)
        statuses |= set(np.where(found[:, 0] == 0.0, 0, np.where(size < 0.999 * friction * found[:, 0], 1, 2)))
    assert statuses == {0, 1, 2}


def test_the_law_can_be_violated():
    """Negative control: forces of another friction, without the last contact, or pointing along the slip."""
    random = np.random.default_rng(7)
    compliance, free, friction = face(random, 2)
    found = forces(compliance, free, friction, 2)
    for wrong in (1.001 * found, found * [1.0, -1.0, 1.0], np.where(np.arange(len(found))[:, None] == 0, 0.0, found)):
        assert violation(wrong, compliance, free, friction) > 1e-6
    assert violation(found, compliance, free, 0.9 * friction) > 1e-6


@pytest.mark.parametrize("tangents", [1, 2])
def test_motions_do_not_depend_on_the_order_of_contacts(tangents):
    """With little friction: with more, several forces may be lawful."""
    random = np.random.default_rng(10 + tangents)
    for _ in range(60):
        compliance, free, friction = face(random, tangents)
        friction[:] = 0.1
        order = random.permutation(len(friction))
        rows = ((1 + tangents) * order[:, None] + np.arange(1 + tangents)).ravel()
        one = forces(compliance, free, friction, tangents)
        other = np.empty_like(one)
        other[order] = forces(compliance[np.ix_(rows, rows)], free[order], friction[order], tangents)
        moved = compliance @ (one - other).ravel()
        assert np.abs(moved).max() < 1e-8 * np.abs(free).max()


def moving(random, tangents):
    """Return a random step of contacts that were open, stuck or slid, with a compliance of full rank."""
    count, own = int(random.integers(16, 24)), 1 + tangents
    modes = random.standard_normal((own * count, 2 * own * count))
    compliance = modes @ modes.T / modes.shape[1]
    given = np.abs(random.standard_normal((count, 1))) * [1.0, *[0.3 * random.choice([0.1, 1.0, 3.0])] * tangents]
    free = -(compliance @ (given * random.choice([-1.0, 1.0], (count, own)) ** [0, *[1] * tangents]).ravel())
    status = random.choice([0, faces.STICKING, faces.SLIDING], count, p=[0.2, 0.4, 0.4])
    speed = random.choice([0.03, 0.3, 3.0])
    last = speed * random.standard_normal((count, tangents)) * (status != faces.STICKING)[:, None]
    earlier = last * random.uniform(0.8, 1.2, (count, 1))
    away = 0.01 * random.standard_normal((count, tangents)) * (status == faces.STICKING)[:, None]
    # Contacts that slid are likely to slide on: their slips without forces are about those before.
    free = free.reshape(count, own)
    free[:, 1:] += last * random.choice([0.0, 1.0])
    force = np.where((status > 0)[:, None], np.abs(given), 0.0)
    return faces.Step(compliance, free, np.full(count, 0.2), status, away, last, earlier, force)


def carried_of(step):
    count, tangents = step.last.shape
    carried = np.zeros((count, at.CARRIED))
    carried[:, at.STATUS], carried[:, at.LAST_NORMAL] = step.status, step.force[:, 0]
    names = ("MATERIAL", "LAST_SLIP", "EARLIER_SLIP", "LAST_TANGENTIAL")
    numbers = (step.away, step.last, step.earlier, -step.force[:, 1:])
    for k in range(tangents):
        for name, values in zip(names, numbers, strict=True):
            carried[:, getattr(at, name + ("", "_B")[k])] = values[:, k]
    return carried


@pytest.mark.parametrize("tangents", [1, 2])
def test_contacts_that_moved_have_the_forces_of_the_plain_method(tangents):
    """Landings, slips that end or turn round, break-aways: held against the twin, which finds no forces in a few.

    With many slips that end at once there may be several forces.
    """
    random, compared, alike, ended = np.random.default_rng(20 + tangents), 0, 0, 0
    for _ in range(60):
        step = moving(random, tangents)
        count, carried = len(step.ratio), carried_of(step)
        expected = faces.forces(step)
        if expected is None:
            continue
        laws = np.zeros((count, LAW_COLUMNS))
        laws[:, STATIC] = step.ratio
        given = (np.full(count, at.COULOMB), laws), carried
        found = forces_of(step.free[:, 0], step.free[:, 1:], step.compliance, *given, 1e-5, GaussSeidel())
        found = found * [1.0, *[-1.0] * tangents]
        compared += 1
        if np.abs(found - expected).max() < 1e-8 * expected.max():
            alike, ended = alike + 1, ended + int(step.apex.any(axis=1).sum())
    assert compared > 40
    assert alike >= 0.95 * compared
    assert ended > 20


STEP = 1e-5
# Slips of the random steps are of the order of one; the speed of one a step.
SPEED = 1.0 / STEP
OTHER_LAWS = {
    "static and kinetic": st.StaticKinetic(0.3, 0.2),
    "Stribeck": st.Stribeck(0.3, 0.2, SPEED),
    "linear weakening": st.LinearWeakening(0.3, 0.1 / SPEED, 0.2),
    "tabulated": st.TabulatedFriction(SPEED * np.array([0.0, 0.3, 1.0, 3.0]), [0.25, 0.22, 0.2, 0.21], 0.3),
    "LuGre": st.LuGre(0.3, 0.2, SPEED, stiffness=1.0),
    "rate and state": st.RateAndState(0.2, 0.01, 0.015, 3.0, SPEED),
}


def carried_under(law, step):
    """Return what contacts carry whose friction was that of the last slip, or a share of it where they stuck."""
    carried, slid = carried_of(step), step.status == faces.SLIDING
    size = np.linalg.norm(step.last, axis=1)
    way = step.last / np.where(size > 0.0, size, 1.0)[:, None]
    stuck = np.clip(-step.force[:, 1:] / np.maximum(step.force[:, :1], 1e-9), -0.2, 0.2)
    ratio = np.where(slid[:, None], 0.2 * way, stuck) * (step.status > 0)[:, None]
    for k, b in enumerate(("", "_B")):
        carried[:, getattr(at, "LAST_TANGENTIAL" + b)] = ratio[:, k] * step.force[:, 0]
        carried[:, getattr(at, "PAST_RATIO" + b)] = 0.5 * ratio[:, k]
        if isinstance(law, st.LuGre):
            carried[:, getattr(at, "FRICTION_STATE" + b)] = ratio[:, k] / law.stiffness
    if isinstance(law, st.RateAndState):
        aged = law.slip_distance / np.maximum(size * SPEED, 1e-3 * SPEED)
        carried[:, at.FRICTION_STATE] = np.where(step.status > 0, aged, law_of_march(law)[1][NEW_STATE])
    return carried


def alone(i, step, moved, force, law, carried, let_go):
    """Return the forces of contact `i` alone under those of the others, ``(normal, -tangential)``."""
    w = step.own(i)
    gap, *slips = moved[i] - w @ force[i]
    away = Tangents(*step.away[i]) if step.status[i] == faces.STICKING else Tangents(0.0, 0.0)
    free = FreeInSpace(
        gap, Tangents(*slips), away, ComplianceInSpace(*map(float, w.ravel())), let_go, Tangents(*-force[i, 1:])
    )

    def of(name):
        return Tangents(float(carried[i, getattr(at, name)]), float(carried[i, getattr(at, name + "_B")]))

    slip, earlier, states = of("LAST_SLIP"), of("EARLIER_SLIP"), of("FRICTION_STATE")
    status, normal = float(carried[i, at.STATUS]), float(carried[i, at.LAST_NORMAL])
    before = BeforeInSpace(status, slip, earlier, states, normal, of("LAST_TANGENTIAL"), of("PAST_RATIO"))
    touch = solve_in_space(free, law, before, STEP)
    return np.array([touch.normal, -touch.tangential.a, -touch.tangential.b]), int(touch.status)


def misses_of_each(step, force, laws, carried, now):
    """Return how far forces are from those of each contact alone, relative to the largest, and the states found."""
    moved, misses, statuses = step.moved(force), [], set()
    for i in range(len(force)):
        own = Law(laws[0][i], laws[1], i, float(laws[1][i, STATIC]), 0.0)
        expected, status = alone(i, step, moved, force, own, carried, float(now[i, at.LET_GO]))
        misses.append(np.abs(force[i] - expected).max() / force[:, 0].max())
        statuses.add(status)
    return max(misses), statuses


@pytest.mark.parametrize("law", OTHER_LAWS.values(), ids=OTHER_LAWS)
def test_contacts_under_other_laws_have_the_forces_of_each_alone(law):
    """The forces of each contact close its gap under its law, with those of the others held."""
    random, seen = np.random.default_rng(30), set()
    code, row = law_of_march(law)
    for _ in range(40):
        step = moving(random, 2)
        count, carried = len(step.ratio), carried_under(law, step)
        laws, constants = (np.full(count, code), np.tile(row, (count, 1))), np.zeros((count, at.CONTACT_CONSTANTS))
        constants[:, at.AT_REST] = row[STATIC]
        given = laws, carried, STEP, GaussSeidel()
        found = solved(step.free[:, 0], step.free[:, 1:], step.compliance, *given, constants=constants)
        assert found.error <= GaussSeidel().tolerance
        force = found.forces(2) * [1.0, -1.0, -1.0]
        missed, statuses = misses_of_each(step, force, laws, carried, found.now)
        assert missed < LAWFUL
        assert misses_of_each(step, 1.001 * force, laws, carried, found.now)[0] > 1e-6
        seen |= statuses
    assert seen >= {0, 1, 2}
