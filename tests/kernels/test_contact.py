"""Properties of the exact solve of one contact, on random symmetric positive definite compliances."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as some

import stridula as st
from kernels.twin import states, way
from stridula._kernels.contact import solves
from stridula._kernels.contact.exact import solve_contact
from stridula._kernels.layout import columns as layout
from stridula._kernels.layout.contact_values import Before, Compliance, Free, Law
from stridula._kernels.layout.laws import LAW_COLUMNS

SEPARATED, STICKING, SLIDING = 0, 1, 2

# Round-off of a 2 x 2 solve: eps times the condition number of W, here at most 1e8 by the bounds below.
CONDITION = 1e8
ROUND_OFF = 100 * CONDITION * np.finfo(float).eps

lengths = some.floats(-1.0, 1.0).filter(lambda x: x == 0 or abs(x) > 1e-6)
# W = R diag(1, flat) R^T, turned by any angle: every symmetric positive definite matrix up to its scale.
turns = some.floats(0.0, np.pi)
flats = some.floats(10.0 / CONDITION, 1.0)
frictions = some.one_of(some.just(0.0), some.floats(1e-3, 4.0))


def compliance(turn, flat):
    c, s = np.cos(turn), np.sin(turn)
    rotation = np.array([[c, -s], [s, c]])
    w = rotation @ np.diag([1.0, flat]) @ rotation.T
    w[1, 0] = w[0, 1]
    return w


def contact_states(gap, slip, w, mu, last_slip=0.0):
    """Every consistent state of the twin, as status, normal and tangential force."""
    before = way.Before(st.Coulomb(mu), SLIDING if last_slip else SEPARATED, last_slip)
    found = states.consistent(states.Contacts([before], [way.Free(gap, slip, 0.0, w)], w, 1.0))
    return [tuple(touch[:3]) for _, (touch,) in found]


def coulomb(gap, slip, w, mu, last_slip=0.0):
    """The kernel's solve under Coulomb's law, of a contact that slid by `last_slip` in the step before."""
    laws = np.array([[mu] + [0.0] * (LAW_COLUMNS - 1)])
    before = Before(float(SLIDING if last_slip else SEPARATED), last_slip, last_slip, 0.0, 0.0, 0.0, 0.0)
    free, law = Free(gap, slip, 0.0, Compliance(*w.ravel()), 0.0), Law(layout.COULOMB, laws, 0, mu, 0.0)
    return solve_contact(free, law, before, 1.0)


def solve(gap, slip, w, mu, last_slip=0.0):
    normal, tangential, status, jammed, _ = coulomb(gap, slip, w, mu, last_slip)
    after = np.array([gap, slip]) + w @ [normal, -tangential]
    return normal, tangential, status, jammed, after[0], after[1]


def clear_of_borders(gap, slip, w, mu):
    """Avoid the border of the cone, where round-off decides between two states with the same forces."""
    if gap >= 0:
        return True
    normal, minus = np.linalg.solve(w, [-gap, -slip])
    size = abs(normal) + abs(minus)
    border = abs(abs(minus) - mu * normal) > ROUND_OFF * size
    compliances = [w[0, 0] - s * mu * w[0, 1] for s in (1, -1)]
    return border and all(abs(value) > ROUND_OFF for value in compliances)


@given(lengths, lengths, turns, flats, frictions)
@settings(max_examples=400, deadline=None)
@example(-1.0, 0.0, 0.3, 0.5, 0.0)
@example(0.0, 1.0, 0.3, 0.5, 1.0)
def test_exactly_one_state_is_consistent_and_it_is_found(gap, slip, turn, flat, mu):
    w = compliance(turn, flat)
    assume(clear_of_borders(gap, slip, w, mu))
    found = contact_states(gap, slip, w, mu)
    if mu == 0.0 and gap < 0:
        found = [state for state in found if state[0] != STICKING] or found  # No friction: both senses are one state.
        assert {abs(state[2]) for state in found} == {0.0}
        found = found[:1]
    assert len(found) == 1
    normal, tangential, status, *_ = solve(gap, slip, w, mu)
    assert status == found[0][0]
    scale = abs(found[0][1]) + abs(found[0][2])
    assert normal == pytest.approx(found[0][1], abs=ROUND_OFF * scale)
    assert tangential == pytest.approx(found[0][2], abs=ROUND_OFF * scale)


@given(lengths, lengths, turns, flats, frictions)
@settings(max_examples=400, deadline=None)
def test_laws_hold(gap, slip, turn, flat, mu):
    """Signorini, the cone, no slip while sticking, and friction against the slip."""
    w = compliance(turn, flat)
    assume(clear_of_borders(gap, slip, w, mu))
    normal, tangential, status, _, gap_after, slip_after = solve(gap, slip, w, mu)
    small = ROUND_OFF * (abs(gap) + abs(slip) + abs(normal) + abs(tangential))
    assert normal >= 0.0
    assert gap_after >= -small
    assert abs(gap_after) <= small or normal == 0.0
    assert abs(tangential) <= mu * normal * (1 + 1e-15)
    if status == SEPARATED:
        assert (normal, tangential) == (0.0, 0.0)
    if status == STICKING:
        assert abs(slip_after) <= small
    if status == SLIDING:
        assert abs(tangential) == pytest.approx(mu * normal, rel=1e-15)
        assert tangential * slip_after >= -small * abs(tangential)


@given(lengths, lengths, turns, flats, frictions)
@settings(max_examples=300, deadline=None)
def test_mirror_image(gap, slip, turn, flat, mu):
    """Reversing x changes the sign of slip, W_NT and tangential force, and nothing else: bit for bit."""
    w = compliance(turn, flat)
    mirrored = w * np.array([[1, -1], [-1, 1]])
    one, other = solve(gap, slip, w, mu), solve(gap, -slip, mirrored, mu)
    assert (one[0], one[1], one[2:4]) == (other[0], -other[1], other[2:4])


@given(lengths, lengths, turns, flats, frictions, some.floats(-20, 20))
@settings(max_examples=200, deadline=None)
def test_forces_scale_with_displacements_and_stiffness(gap, slip, turn, flat, mu, power):
    """The laws have no scale: displacements times 2^p and compliances times 2^m give forces times 2^(p-m)."""
    w, p = compliance(turn, flat), 2.0 ** round(power)
    normal, tangential, status, jammed, *_ = solve(gap, slip, w, mu)
    larger = solve(gap * p, slip * p, w * 4.0, mu)
    assert larger[:4] == (normal * p / 4.0, tangential * p / 4.0, status, jammed)


@given(lengths, lengths, turns, flats, frictions)
@settings(max_examples=300, deadline=None)
def test_jams_only_inside_the_cone(gap, slip, turn, flat, mu):
    """A jam is a stick whose slide in the same sense has no positive normal force."""
    w = compliance(turn, flat)
    assume(clear_of_borders(gap, slip, w, mu))
    normal, tangential, status, jammed, *_ = solve(gap, slip, w, mu)
    if jammed:
        assert status == STICKING
        assert abs(tangential) <= mu * normal
        assert w[0, 0] - np.copysign(mu, tangential) * w[0, 1] <= 0
    elif status != SEPARATED and tangential != 0:
        assert w[0, 0] - np.copysign(mu, tangential) * w[0, 1] > 0


def test_painleve_jam_is_reached():
    """W_NT / W_NN = 0.8: sliding jams beyond mu = 1.25; a push into the cone then sticks and is counted."""
    w = np.array([[1.0, 0.8], [0.8, 1.0]])
    assert solve(-1.0, 0.1, w, 1.2)[2:4] == (STICKING, False)
    assert solve(-1.0, 0.1, w, 1.3)[2:4] == (STICKING, True)
    # Whatever the slip, beyond the limit no slide in the jamming sense is ever returned.
    slips = np.linspace(-50, 50, 2001)
    senses = {np.sign(solve(-1.0, s, w, 1.3)[1]) for s in slips if solve(-1.0, s, w, 1.3)[2] == SLIDING}
    assert senses == {-1.0}


def test_harness_rejects_a_wrong_solve():
    """Negative control: with the sign of W_NT reversed, the state found is not consistent for most random cases."""
    random = np.random.default_rng(7)
    wrong = 0
    for _ in range(200):
        w = compliance(random.uniform(0, np.pi), random.uniform(0.05, 0.5))
        gap, slip, mu = -random.uniform(), random.uniform(-1, 1), random.uniform(0, 2)
        normal, tangential, *_ = coulomb(gap, slip, w * [[1, -1], [-1, 1]], mu)
        _, right_normal, right_tangential = contact_states(gap, slip, w, mu)[0]
        wrong += abs(normal - right_normal) + abs(tangential - right_tangential) > 1e-6
    assert wrong > 150


@given(lengths, lengths, turns, flats, frictions, lengths.filter(bool))
@settings(max_examples=400, deadline=None)
def test_the_solve_without_branches_is_the_same(gap, slip, turn, flat, mu, last_slip):
    w = compliance(turn, flat)
    assume(clear_of_borders(gap, slip, w, mu) and clear_of_borders(gap, slip - last_slip, w, mu))
    normal, tangential, status, jammed, _ = coulomb(gap, slip, w, mu, last_slip)
    rows = Compliance(*w.ravel())
    other = solves.coulomb(float(gap), float(slip), rows, float(mu))
    turned = solves.turned_round(float(gap), float(slip), float(last_slip), rows, float(mu), other)
    assert turned[2] == status
    if turned == other:
        assert other.jammed == jammed
    scale = abs(normal) + abs(tangential)
    np.testing.assert_allclose(turned[:2], (normal, tangential), rtol=1e-6, atol=1e-12 * scale)


@given(lengths, lengths, turns, flats, frictions.filter(bool), lengths.filter(bool))
@settings(max_examples=600, deadline=None)
def test_a_slip_that_ends_within_the_step(gap, slip, turn, flat, mu, last_slip):
    """One state is found, that of the twin, whose forces close the gap and lie in the cone.

    It either sticks, and does not slip, or slides back, and then against the sense of the slip before.
    """
    w = compliance(turn, flat)
    assume(clear_of_borders(gap, slip, w, mu) and clear_of_borders(gap, slip - last_slip, w, mu))
    found = contact_states(gap, slip, w, mu, last_slip)
    assume(len(found) == 1)
    normal, tangential, status, _, gap_after, slip_after = solve(gap, slip, w, mu, last_slip)
    assert status == found[0][0]
    scale = abs(normal) + abs(tangential) + abs(gap) + abs(slip) + abs(last_slip)
    assert (normal, tangential) == pytest.approx(found[0][1:], abs=ROUND_OFF * scale)
    assert abs(tangential) <= mu * normal + ROUND_OFF * scale
    assert gap_after >= -ROUND_OFF * scale
    if status == STICKING:
        assert abs(slip_after) <= ROUND_OFF * scale
    if status == SLIDING and abs(tangential) < mu * normal - ROUND_OFF * scale:
        assert slip_after * last_slip <= ROUND_OFF * scale * abs(last_slip)


def test_a_block_that_turns_round_moves_as_its_two_parabolas():
    """Mass m under a push F, friction mu N, h = 1: v = d before, then v' = (F -+ mu N)/m up to and after its stop.

    Over a step about the stop the velocity goes from d to (1 - d / (F + mu N)) times -(F - mu N), for any share;
    without the treatment it is 0 or d - (F - mu N).
    """
    mass, push, mu, normal = 2.0, 3.0, 0.5, 1.6
    w = np.array([[1.0, 0.0], [0.0, 1.0 / mass]])
    for share in (0.05, 0.3, 0.5, 0.9, 0.99):
        last = share * (push + mu * normal) / mass
        slip = last - push / mass
        pressed, tangential, status, _, gap_after, slip_after = solve(-normal, slip, w, mu, last)
        assert (pressed, gap_after, status) == (pytest.approx(normal), pytest.approx(0.0, abs=1e-15), SLIDING)
        assert slip_after == pytest.approx(-(1 - share) * (push - mu * normal) / mass)
        assert tangential == pytest.approx(mu * normal * (2 * share - 1))
    # A push below the cone holds it where it stops.
    assert solve(-normal, 0.1 - 0.7 / mass, w, mu, 0.1)[2] == STICKING
