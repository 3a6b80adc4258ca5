"""Step 5 for one contact in space under a law other than Coulomb's: the slip goes its way as a vector."""

import math
from typing import Any

from ..lanes.compiled import strict, strict_pasted
from ..lanes.operations import Pair
from ..layout import columns as at
from ..layout.contact_values import BeforeInSpace, ComplianceInSpace, FreeInSpace, Law, Tangents, TouchInSpace
from ..layout.laws import NEW_STATE, STATIC
from .exact import ENOUGH, PATIENCE, ROUND_OFF, SLIDING, STICKING, TRIALS, velocity_at
from .friction import joint_holds, joint_of, next_normal, set_valued, sliding_ratio, sticking_speed, under
from .lanewise import lanewise
from .slipping_in_space import ratio_over_step, ratio_with_state, sticking_forces
from .tangents import NOTHING, along, over, plus, scaled, size_of, to_normal


@strict
def is_prescribed(law: Law, w: ComplianceInSpace) -> bool:
    """Return whether no force moves a contact under a set-valued law along its tangents: its slip is given."""
    return set_valued(law.code) and w.aa == 0.0 and w.bb == 0.0


@strict
def ratio_under(normal: float, free: FreeInSpace, law: Law, before: BeforeInSpace, step: float) -> tuple[Any, ...]:
    """Return ratios over a step under a normal force, past parts, new states, status and share of stick.

    As `exact.ratio_under`.
    """
    slips, w, law = free.slips, free.w, under(law, normal)
    if set_valued(law.code):
        ratio, past, status, stuck = ratio_over_step(normal, free, law, before, step)
        return ratio, past, before.state, status, stuck
    ratio, past, states = ratio_with_state(normal, slips, w, law, before, step)
    per_normal = Tangents(w.an - w.aa * ratio.a - w.ab * ratio.b, w.bn - w.ba * ratio.a - w.bb * ratio.b)
    moved = plus(slips, normal, per_normal)
    if law.code == at.IN_SERIES:
        # As in the plane.
        law = under(law, next_normal(normal, before.normal))
        stiffness, damping = joint_of(law)
        felt = plus(scaled(stiffness, states), damping / step, moved)
        sticks = joint_holds(law, size_of(moved) / step, size_of(felt))
    else:
        sticks = size_of(moved) < step * sticking_speed(law)
    return ratio, past, states, STICKING if sticks else SLIDING, 0.0


@strict
def slide_as_prescribed(free: FreeInSpace, law: Law, before: BeforeInSpace, step: float) -> TouchInSpace:
    """Return the contact of bodies that no force moves along the tangents: as `exact.slide_as_prescribed`."""
    gap, slips, strays, w = free.gap, free.slips, free.strays, free.w
    was, last, earlier = before.status, before.slip, before.earlier_slip
    normal, size = -gap / w.nn, size_of(slips)
    law = under(law, normal)
    if size == 0.0 or size_of(plus(slips, 1.0, strays)) == 0.0:
        return TouchInSpace(normal, NOTHING, float(STICKING), 0.0)
    way = over(slips, size)
    back = along(last, way)
    velocity = Tangents(
        velocity_at(slips.a, last.a, earlier.a, step),
        velocity_at(slips.b, last.b, earlier.b, step),
    )
    speed = size_of(velocity)
    if was == SLIDING and back < 0.0:
        # Sliding on until it stops, then back (5d).
        turned = sliding_ratio(law, abs(along(velocity, way)))
        pulled = turned * (size + back) / (size - back) * normal
    else:
        pulled = sliding_ratio(law, speed) * normal
        if was == SLIDING and speed > 0.0:
            way = over(velocity, speed)
    return TouchInSpace(normal, scaled(pulled, way), float(SLIDING), 0.0)


@strict_pasted
def expected_ratio(before: BeforeInSpace) -> Tangents:
    """Return the ratios of forces to be expected: as `exact.expected_ratio`."""
    if before.normal <= 0.0:
        return NOTHING
    last = over(before.tangential, before.normal)
    return plus(scaled(3.0, before.past), -0.5, last) if before.status == SLIDING else last


@strict
def slide_on_its_way(free: FreeInSpace, law: Law, before: BeforeInSpace, step: float) -> TouchInSpace:
    """Return the contact under a law whose friction changes within the step: as `exact.slide_on_its_way`."""
    gap, slips, strays, w = free.gap, free.slips, free.strays, free.w
    if is_prescribed(law, w):
        return slide_as_prescribed(free, law, before, step)
    if set_valued(law.code) and before.status != SLIDING:
        pressed, held = sticking_forces(gap, plus(slips, 1.0, strays), w)
        if pressed > 0.0:
            _, _, _, status, _ = ratio_under(pressed, free, law, before, step)
            if status == STICKING:
                most, pulled = law.table[law.row, STATIC], size_of(held)
                lifted = most * along(held, to_normal(w)) / pulled if pulled > 0.0 else 0.0
                return TouchInSpace(pressed, held, float(STICKING), 1.0 if w.nn <= lifted else 0.0)
    ratio = expected_ratio(before)
    clear = w.nn - ratio.a * w.na - ratio.b * w.nb
    normal = -gap / (clear if clear > 0.0 else w.nn)
    status, last, error_before, ratio_before = SLIDING, 0.0, 0.0, ratio
    low, high, below, above, settled = 0.0, math.inf, ratio, ratio, False
    for trial in range(TRIALS):
        ratio, _, _, status, _ = ratio_under(normal, free, law, before, step)
        clear = w.nn - ratio.a * w.na - ratio.b * w.nb
        if clear <= 0.0:
            pressed, held = sticking_forces(gap, plus(slips, 1.0, strays), w)
            return TouchInSpace(pressed, held, float(STICKING), 1.0)
        found = -gap / clear
        error = found - normal
        settled = abs(error) <= ROUND_OFF * found or (w.na == 0.0 and w.nb == 0.0)
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
                    ratio = plus(ratio, (new - normal) / (normal - last), plus(ratio, -1.0, ratio_before))
                    normal, settled = new, True
                    break
        if trial > PATIENCE and low > 0.0 and high < math.inf:
            new = 0.5 * (low + high)
        last, error_before, ratio_before, normal = normal, error, ratio, new
        if normal == last:
            break
    if not settled and low > 0.0 and high < math.inf:
        # The ratio jumps at this normal force, where the contact stops or slides on: between both it closes the gap.
        lifted, more = along(below, to_normal(w)), along(above, to_normal(w))
        share = min(max((w.nn + gap / normal - lifted) / (more - lifted), 0.0), 1.0) if more != lifted else 0.0
        ratio = plus(below, share, plus(above, -1.0, below))
    return TouchInSpace(normal, scaled(normal, ratio), float(status), 0.0)


@lanewise((NOTHING, NOTHING, 0.0))
def next_in_space(
    touch: Pair, free: FreeInSpace, law: Law, before: BeforeInSpace, step: float
) -> tuple[Tangents, Tangents, float]:
    """Return past parts of the ratios for the next step, internal states and the share of stick of this step.

    `touch` are normal force and status. Where bodies are apart, states are those of new contacts.
    """
    normal, status = touch
    if status < 0.5:
        fresh = law.table[law.row, NEW_STATE]
        return NOTHING, Tangents(fresh, 0.0 if law.code == at.AGING or law.code == at.SLIP else fresh), 0.0
    if law.code == at.COULOMB or is_prescribed(law, free.w):
        return NOTHING, before.state, 1.0 if status == STICKING else 0.0
    _, past, states, _, stuck = ratio_under(normal, free, law, before, step)
    return past, states, stuck
