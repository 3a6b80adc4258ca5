"""Forces of many contacts under Coulomb's law, whose compliance may be singular: found, lawful, whatever the order."""

from __future__ import annotations

import numpy as np
import pytest

from stridula._kernels.layout import columns as at
from stridula._kernels.layout.laws import LAW_COLUMNS, STATIC
from stridula.integration.contact_solve import GaussSeidel
from stridula.integration.forces import forces_of

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
