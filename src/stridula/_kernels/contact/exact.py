"""Step 5, the state of one point contact with friction: the exact solution over one step."""

import math
from typing import Any

from ..lanes.compiled import strict, strict_pasted
from ..lanes.operations import Number, Pair, choose, magnitude
from ..layout import columns as at
from ..layout.contact_values import Before, Compliance, Free, Law, Touch, Way
from ..layout.laws import NEW_STATE, STATIC
from .friction import joint_holds, joint_of, next_normal, set_valued, sliding_ratio, sticking_speed, under
from .slipping import SEPARATED, SLIDING, STICKING, ratio_over_step, ratio_with_state

# Most evaluations of the ratio for the normal force, those before it is sought by bisection, and the relative change of
# that force that is round-off.
TRIALS, PATIENCE, ROUND_OFF = 80, 25, 1e-15
# Product of the distances of a step of the secant method from the last two trials, relative to the force, below which
# the error that it leaves is round-off.
ENOUGH = 1e-13
# Under Coulomb's law there is nothing to keep of the way.
NO_WAY = Way(0.0, 0.0, 0.0)


@strict_pasted
def solve_contact(free: Free, law: Law, before: Before, step: Number) -> Touch:
    """Return the contact that closes the gap under a law of friction (step 5).

    The compliance is the relative displacement of the tip against the track for unit forces on the tip and their
    opposites on the track. The tangential force acts on the track along the tangent.
    """
    gap, slip, strayed, w = free.gap, free.slip, free.strayed, free.w
    if gap >= 0.0:
        return Touch(0.0, 0.0, float(SEPARATED), 0.0, new_way(law))
    if set_valued(law.code) and w.tt == 0.0:
        return slide_as_prescribed(free, law, before, step)
    if law.code != at.COULOMB:
        return slide_on_its_way(free, law, before, step)
    mu, last_slip = law.table[law.row, STATIC], before.slip
    touch = solve_coulomb(gap, slip + strayed, w, mu)
    if (
        before.status == SLIDING
        and free.let_go == 0.0
        and (touch.status == STICKING or touch.tangential * last_slip < 0.0)
    ):
        turns, pressed, turned, slides = turn_round(gap, slip, last_slip, w, mu, mu)
        if turns:
            return Touch(pressed, turned, float(SLIDING if slides else STICKING), 0.0, NO_WAY)
    return touch


@strict
def ratio_under(normal: Number, free: Free, law: Law, before: Before, step: Number) -> tuple[Any, ...]:
    """Return the ratio of forces over a step under a normal force, its past part, new state, status and stuck share.

    Under a law with internal state nothing sticks, however slowly it creeps. See `slipping`.
    """
    slip, w, law = free.slip, free.w, under(law, normal)
    if set_valued(law.code):
        ratio, past, status, stuck = ratio_over_step(normal, free, law, before, step)
        return ratio, past, before.state, status, stuck
    ratio, past, state = ratio_with_state(normal, slip, w, law, before, step)
    moved = slip + (w.tn - ratio * w.tt) * normal
    if law.code == at.IN_SERIES:
        # A joint that slips is at the limit of the next step.
        law = under(law, next_normal(normal, before.normal))
        stiffness, damping = joint_of(law)
        sticks = joint_holds(law, abs(moved) / step, abs(stiffness * state + damping * moved / step))
    else:
        sticks = abs(moved) < step * sticking_speed(law)
    return ratio, past, state, STICKING if sticks else SLIDING, 0.0


@strict_pasted
def expected_ratio(before: Before) -> Number:
    """Return the ratio of forces to be expected: that from which it went in a straight line to its past part."""
    if before.normal <= 0.0:
        return 0.0
    last = before.tangential / before.normal
    return 3.0 * before.past - 0.5 * last if before.status == SLIDING else last


@strict
def new_way(law: Law) -> Way:
    """Return the way of bodies apart, with the internal state of a new contact."""
    return Way(0.0, law.table[law.row, NEW_STATE], 0.0)


@strict
def way_under(normal: Number, free: Free, law: Law, before: Before, step: Number) -> Way:
    """Return the way of the slip under a normal force."""
    _, past, state, _, stuck = ratio_under(normal, free, law, before, step)
    return Way(past, state, stuck)


@strict_pasted
def farther(way: Way, last: Way, share: Number) -> Way:
    """Return a way on the straight line through two, a share of their distance beyond the first."""
    past, state = way.past + share * (way.past - last.past), way.state + share * (way.state - last.state)
    return Way(past, state, way.stuck)


@strict
def slide_on_its_way(free: Free, law: Law, before: Before, step: Number) -> Touch:
    """Return the contact under a law whose friction changes within the step (5c).

    The normal force that closes the gap depends on the ratio, and this on the normal force: the secant method.
    """
    gap, slip, strayed, w = free.gap, free.slip, free.strayed, free.w
    w_nn, w_nt = w.nn, w.nt
    if set_valued(law.code) and before.status != SLIDING:
        pressed, needed = sticking_forces(gap, slip + strayed, w)
        if pressed > 0.0:
            _, past, state, status, stuck = ratio_under(pressed, free, law, before, step)
            if status == STICKING:
                sense = 1.0 if needed >= 0.0 else -1.0
                jams = w_nn - sense * law.table[law.row, STATIC] * w_nt <= 0.0
                return Touch(pressed, needed, float(STICKING), 1.0 if jams else 0.0, Way(past, state, stuck))
    ratio = expected_ratio(before)
    clear = w_nn - ratio * w_nt
    normal = -gap / (clear if clear > 0.0 else w_nn)
    way = NO_WAY
    status, last, error_before, ratio_before, way_before = SLIDING, 0.0, 0.0, ratio, way
    low, high, below, above, settled = 0.0, math.inf, ratio, ratio, False
    for trial in range(TRIALS):
        ratio, past, state, status, stuck = ratio_under(normal, free, law, before, step)
        way, clear = Way(past, state, stuck), w_nn - ratio * w_nt
        if clear <= 0.0:
            pressed, needed = sticking_forces(gap, slip + strayed, w)
            return Touch(pressed, needed, float(STICKING), 1.0, way_under(pressed, free, law, before, step))
        found = -gap / clear
        error = found - normal
        settled = abs(error) <= ROUND_OFF * found or w_nt == 0.0
        if settled:
            normal = found
            break
        if error > 0.0:
            low, below = normal, ratio
        else:
            high, above = normal, ratio
        new = found
        if trial > 0 and error != error_before:
            secant = normal - error * (normal - last) / (error - error_before)
            if 0.5 * found < secant < 2.0 * found:
                new = secant
                if abs(new - normal) * abs(new - last) <= ENOUGH * new * new:
                    share = (new - normal) / (normal - last)
                    ratio, way = ratio + share * (ratio - ratio_before), farther(way, way_before, share)
                    normal, settled = new, True
                    break
        if trial > PATIENCE and low > 0.0 and high < math.inf:
            new = 0.5 * (low + high)
        last, error_before, ratio_before, way_before, normal = normal, error, ratio, way, new
        if normal == last:
            break
    if not settled:
        if low > 0.0 and high < math.inf and above != below:
            # The ratio jumps at this normal force, where the contact stops or slides on: between both it closes the
            # gap.
            share = min(max((w_nn + gap / normal - below * w_nt) / (w_nt * (above - below)), 0.0), 1.0)
            ratio = below + share * (above - below)
        way = way_under(normal, free, law, before, step)
    return Touch(normal, ratio * normal, float(status), 0.0, way)


@strict
def sticking_forces(gap: Number, slip: Number, w: Compliance) -> Pair:
    """Return the normal and the tangential force that close `gap` and undo `slip` (5b)."""
    w_nn, w_nt, w_tn, w_tt = w
    determinant = w_nn * w_tt - w_nt * w_tn
    return (w_nt * slip - w_tt * gap) / determinant, (w_nn * slip - w_tn * gap) / determinant


@strict
def solve_coulomb(gap: Number, slip: Number, w: Compliance, mu: Number) -> Touch:
    """Return the contact (5b, 5c) that closes a `gap` below zero under one coefficient of friction."""
    normal, tangential = sticking_forces(gap, slip, w)
    sense = 1.0 if tangential >= 0.0 else -1.0
    free = w.nn - sense * mu * w.nt
    if abs(tangential) <= mu * normal:
        return Touch(normal, tangential, float(STICKING), 1.0 if free <= 0.0 else 0.0, NO_WAY)
    normal = -gap / free
    return Touch(normal, sense * mu * normal, float(SLIDING), 0.0, NO_WAY)


@strict
def turn_round(
    gap: Number, slip: Number, last_slip: Number, w: Compliance, ratio: Number, held: Number
) -> tuple[bool, Number, Number, bool]:
    """Return the contact of a slip that ends within the step (5d), as numbers of runs.

    The contact slides on for the share of the step until it stops; for the rest it is held, or slides back where
    holding takes more than the ratio `held`. The forces are means over the step. Where the slip does not end, or would
    jam, `turns` is false and the other results have no meaning.

    Returns
    -------
    turns : bool
        Whether the slip ends within the step.
    normal, tangential : float
        Forces [N].
    slides : bool
        Whether the contact slides back.
    """
    w_nn, w_nt, w_tn, w_tt = w
    along = choose(last_slip < 0.0, -ratio, ratio)
    free_on, free_back = w_nn - along * w_nt, w_nn + along * w_nt
    on, back = -gap / free_on, -gap / free_back
    farther = slip + (w_tn - along * w_tt) * on
    share = last_slip / (last_slip - farther)
    # Held from where it stops: the last slip is used up by then.
    undone, area = slip - last_slip, 1.0 / (w_nn * w_tt - w_nt * w_tn)
    pressed, needed = (w_nt * undone - w_tt * gap) * area, (w_nn * undone - w_tn * gap) * area
    slides = magnitude(needed) > held * pressed
    left = 1.0 - share
    normal = share * on + left * choose(slides, back, pressed)
    tangential = share * along * on + left * choose(slides, -along * back, needed)
    clear = choose(free_on < free_back, free_on, free_back)
    turns = choose(clear > 0.0, farther * last_slip, 0.0) < 0.0
    return turns, normal, tangential, slides


@strict
def slide_as_prescribed(free: Free, law: Law, before: Before, step: Number) -> Touch:
    """Return the contact of bodies that no force moves along the tangent: the slip is given."""
    slip, last_slip = free.slip, before.slip
    normal = -free.gap / free.w.nn
    law = under(law, normal)
    if slip == 0.0 or slip + free.strayed == 0.0:
        return Touch(normal, 0.0, float(STICKING), 0.0, Way(0.0, before.state, 1.0))
    ratio = sliding_ratio(law, abs(velocity_at(slip, last_slip, before.earlier_slip, step)))
    if before.status == SLIDING and last_slip * slip < 0.0:
        # Sliding on until it stops, then back (5d).
        ratio *= (slip + last_slip) / (slip - last_slip)
    tangential = math.copysign(1.0, slip) * ratio * normal
    return Touch(normal, tangential, float(SLIDING), 0.0, Way(0.0, before.state, 0.0))


@strict_pasted
def velocity_at(slip: Number, last: Number, earlier: Number, step: Number) -> Number:
    """Return the slip velocity at the middle of the last step and this one, of second order.

    The mean would not see a sawtooth from step to step. Among the second-order combinations of three slips this one
    damps it best: under stiff friction it falls to a third in each step.
    """
    return (9.0 * slip + 6.0 * last + earlier) / (16.0 * step)


@strict_pasted
def landed_share(gap_before: Number, gap: Number) -> Number:
    """Return the share of a step that remains after an open contact closes; without contact `gap` would be reached."""
    return choose(gap < 0.0, gap, -1.0) / (choose(gap < 0.0, gap, -1.0) - gap_before)


@strict_pasted
def closed_share(normal: Number, tangential: Number, gap: Number, w: Compliance) -> Number:
    """Return the share of the step before in which a contact that is open now was still closed.

    The force is taken straight from `normal` through zero to the force that would hold the contact closed, at the same
    ratio.
    """
    clear = w.nn - tangential / normal * w.nt
    return normal / (normal + gap / choose(clear > 0.0, clear, w.nn))


@strict_pasted
def stuck_share(normal: Number, tangential: Number, free: Free, mu: Number) -> Number:
    """Return the share of the step before in which a contact that slides now still stuck.

    The tangential force is taken straight from `tangential` through the border of the cone to the force that would keep
    it stuck.
    """
    pressed, needed = sticking_forces(free.gap, free.slip + free.strayed, free.w)
    sense = choose(needed < 0.0, -1.0, 1.0)
    inside, outside = mu * normal - sense * tangential, sense * needed - mu * pressed
    return choose(outside > 0.0, inside, 1.0) / choose(outside > 0.0, inside + outside, 1.0)
