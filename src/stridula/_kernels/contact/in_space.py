"""Step 5 for contacts in space, which have two tangents.

Friction acts along one direction u of the tangent plane. Along u the contact is like one of the plane; u is the
direction without velocity across it. Under laws whose friction changes within a step the slip goes its way as a vector:
see `law_in_space`.
"""

import math

from ..lanes.compiled import inlined, strict, strict_pasted
from ..lanes.operations import Array, Number, Runs, component, held, hold
from ..layout import columns as at
from ..layout.contact_values import (
    Before,
    BeforeInSpace,
    Compliance,
    ComplianceInSpace,
    Free,
    FreeInSpace,
    Law,
    Tangents,
    Touch,
    TouchInSpace,
)
from ..layout.laws import STATIC
from ..layout.parts import Contacts
from ..layout.rows import COMPLIANCE, DISPLACEMENT
from .exact import NO_WAY, SLIDING
from .lanewise import lanewise
from .law_in_space import slide_on_its_way
from .solves import solve, strayed
from .tangents import (
    ALONG_A,
    NOTHING,
    across,
    along,
    by_normal,
    direction_of,
    held_along,
    hold_along,
    left_of,
    of_tangents,
    over,
    plus,
    scaled,
    size_of,
    times,
    to_normal,
    under_closed,
)

# Largest number of trials of a direction of friction; velocity across it that counts as round-off, relative to its
# terms.
TRIALS, ACROSS = 80, 1e-12
# Longest step of a search without a bracket [rad], and the step of Newton's method whose square is round-off.
LONGEST, SETTLED = 1.0, 1e-7
# Steps of Newton's method for a direction.
NEWTON = 12
# Largest change of a slip across the last slip, as a share of its total change, with which it reverses on its line.
STRAIGHT = 1e-6
# Relative determinant of the compliance of the tangents below which the slip alone gives the direction.
SINGULAR = 1e-12


@inlined
def whole_compliance(faces: Array, n: int, runs: Runs) -> ComplianceInSpace:
    """Return the compliance of a contact in space for forces ``(N, -Ta, -Tb)``, from the row of its normal on."""
    a, b = n + 1, n + 2
    return ComplianceInSpace(
        component(faces, n, COMPLIANCE + n, runs),
        component(faces, n, COMPLIANCE + a, runs),
        component(faces, n, COMPLIANCE + b, runs),
        component(faces, a, COMPLIANCE + n, runs),
        component(faces, a, COMPLIANCE + a, runs),
        component(faces, a, COMPLIANCE + b, runs),
        component(faces, b, COMPLIANCE + n, runs),
        component(faces, b, COMPLIANCE + a, runs),
        component(faces, b, COMPLIANCE + b, runs),
    )


@strict_pasted
def compliance_along(w: ComplianceInSpace, way: Tangents) -> Compliance:
    """Return the compliance of a contact in space along a direction of its tangent plane."""
    c, s = way
    return Compliance(
        w.nn,
        c * w.na + s * w.nb,
        c * w.an + s * w.bn,
        c * (c * w.aa + s * w.ab) + s * (c * w.ba + s * w.bb),
    )


@strict
def sticking_direction(gap: Number, missed: Tangents, w: ComplianceInSpace) -> tuple[Tangents, Number]:
    """Return the force that would hold a contact against its free displacements (5b): its direction, and its size.

    The size is relative to the normal force, infinite where that would pull.
    """
    soft = under_closed(w)
    force = Tangents(missed.a - w.an * gap / w.nn, missed.b - w.bn * gap / w.nn)
    determinant, trace = soft.aa * soft.bb - soft.ab * soft.ba, soft.aa + soft.bb
    if abs(determinant) > SINGULAR * trace * trace:
        turned = Tangents(soft.bb * force.a - soft.ab * force.b, soft.aa * force.b - soft.ba * force.a)
        force = over(turned, determinant)
    size, pressed = size_of(force), w.na * force.a + w.nb * force.b - gap
    if size == 0.0:
        return ALONG_A, 0.0
    return over(force, size), size * w.nn / pressed if pressed > 0.0 else math.inf


@strict
def sliding_direction(
    gap: Number, slips: Tangents, w: ComplianceInSpace, mu: Number, carried_on: Tangents, guess: Tangents
) -> tuple[Tangents, bool]:
    """Return the direction of friction under a ratio `mu`, by Newton's method, and whether it converged."""
    way = guess
    for _ in range(NEWTON):
        free = w.nn - mu * along(to_normal(w), way)
        if not free > 0.0:
            return way, False
        normal = -gap / free
        turning = normal * mu * across(to_normal(w), way) / free
        pulled, more = mu * normal, mu * turning
        left = left_of(way)
        soft, softer = times(of_tangents(w), way), times(of_tangents(w), left)
        moved = plus(scaled(9.0, plus(plus(slips, normal, by_normal(w)), -pulled, soft)), 1.0, carried_on)
        moving = scaled(9.0, plus(plus(scaled(turning, by_normal(w)), -more, soft), -pulled, softer))
        slope = across(moving, way) - along(moved, way)
        if not slope < 0.0:
            return way, False
        change = -across(moved, way) / slope
        if not abs(change) < LONGEST:
            return way, False
        # The tangent of a small angle equals the angle.
        way = plus(way, change, left)
        way = over(way, math.sqrt(way.a * way.a + way.b * way.b))
        if abs(change) < SETTLED:
            return way, True
    return way, False


@strict_pasted
def free_along(free: FreeInSpace, way: Tangents) -> Free:
    """Return the motion of a contact in space without its forces, along a direction."""
    return Free(free.gap, along(free.slips, way), along(free.strays, way), compliance_along(free.w, way), free.let_go)


@strict_pasted
def past_along(before: BeforeInSpace, way: Tangents) -> Before:
    """Return what a contact in space carries, along a direction."""
    return Before(
        before.status,
        along(before.slip, way),
        along(before.earlier_slip, way),
        before.state.a,
        before.normal,
        along(before.tangential, way),
        along(before.past, way),
    )


@strict
def solve_along(way: Tangents, free: FreeInSpace, law: Law, before: BeforeInSpace, step: Number) -> Touch:
    """Solve a contact in space under Coulomb's law as one of the plane along a direction."""
    status, slip, earlier, state, normal, tangential, past = past_along(before, way)
    # When it is late, no reversal within the step (5d) is considered.
    was = Before(status if free.let_go == 0.0 else 0.0, slip, earlier, state, normal, tangential, past)
    return solve(free_along(free, way), law, was, step)


@strict
def carried_on_by(before: BeforeInSpace, let_go: Number, pulled: Tangents) -> Tangents:
    """Return the share of the last two slips in the velocity along which friction acts, in units of a ninth of a slip.

    Contacts that come to rest together may have no consistent forces with this share; after some sweeps friction
    therefore acts along the slip alone. The same holds where a contact begins to slide against its last slips: it was
    at rest, without a direction.
    """
    moved = plus(scaled(6.0, before.slip), 1.0, before.earlier_slip)
    begins = before.status < SLIDING - 0.5 and along(pulled, moved) <= 0.0
    return NOTHING if let_go > 0.0 or begins else moved


@strict
def slip_under(way: Tangents, normal: Number, tangential: Number, slips: Tangents, w: ComplianceInSpace) -> Tangents:
    """Return the slip along both tangents under a normal force and one along a direction."""
    return plus(plus(slips, normal, by_normal(w)), -tangential, times(of_tangents(w), way))


@strict
def turns_on_its_line(free: FreeInSpace, mu: Number, size: Number, came: Tangents) -> bool:
    """Return whether friction along the last slip reverses it with only rounding across.

    The velocity then passes zero, near which no direction has velocity across it.
    """
    if size == 0.0:
        return False
    clear = free.w.nn - mu * along(to_normal(free.w), came)
    if clear <= 0.0:
        return False
    normal = -free.gap / clear
    slip = slip_under(came, normal, mu * normal, free.slips, free.w)
    farther = along(slip, came)
    return farther < 0.0 and abs(across(slip, came)) <= STRAIGHT * (size - farther)


@strict
def along_way(way: Tangents, touch: Touch) -> TouchInSpace:
    """Return a contact along a direction as one of space."""
    return TouchInSpace(touch.normal, scaled(touch.tangential, way), touch.status, touch.jammed)


@lanewise(TouchInSpace(0.0, NOTHING, 0.0, 0.0))
def solve_in_space(free: FreeInSpace, law: Law, before: BeforeInSpace, step: Number) -> TouchInSpace:
    """Do `solves.solve` for a contact in space."""
    gap, slips, w = free.gap, free.slips, free.w
    if gap >= 0.0:
        return TouchInSpace(0.0, NOTHING, 0.0, 0.0)
    if law.code != at.COULOMB:
        return slide_on_its_way(free, law, before, step)
    if free.let_go > 0.0:
        # One law for holding and sliding, so that all contacts together have forces: the slip is that from the anchor.
        slips = plus(slips, 1.0, free.strays)
        free = FreeInSpace(gap, slips, NOTHING, w, free.let_go, free.guess)
    pulled, held = sticking_direction(gap, plus(slips, 1.0, free.strays), w)
    mu, was, last = law.table[law.row, STATIC], before.status, before.slip
    may_hold = held <= mu or mu == 0.0
    if not may_hold:
        carried_on = carried_on_by(before, free.let_go, pulled)
        near = direction_of(free.guess, pulled)
        way, found = sliding_direction(gap, slips, w, mu, carried_on, near)
        if found:
            normal = -gap / (w.nn - mu * along(to_normal(w), way))
            slip = slip_under(way, normal, mu * normal, slips, w)
            # A reversal within the step (5d) is solved as a contact along a line only.
            turns = free.let_go == 0.0 and along(last, way) < 0.0
            if was < SLIDING - 0.5 or (along(slip, way) >= 0.0 and not turns):
                return TouchInSpace(normal, scaled(mu * normal, way), 2.0, 0.0)
            pulled = way
    size, came = size_of(last), direction_of(last, ALONG_A)
    slid = was > SLIDING - 0.5 and free.let_go == 0.0
    if slid and turns_on_its_line(free, mu, size, came):
        return along_way(came, solve_along(came, free, law, before, step))
    way, touch = searched(pulled, may_hold, free, law, before, step)
    if slid and abs(touch.status - SLIDING) < 0.5:
        moved = slip_under(way, touch.normal, touch.tangential, slips, w)
        if size > 0.0 and touch.tangential * along(moved, way) < 0.0:
            # It comes to rest or reverses within the step (5d): along the line of its last slip.
            way, touch = came, solve_along(came, free, law, before, step)
    return along_way(way, touch)


@strict
def searched(
    pulled: Tangents, may_hold: bool, free: FreeInSpace, law: Law, before: BeforeInSpace, step: Number
) -> tuple[Tangents, Touch]:
    """Return the direction of friction, by the secant method within a bracket, and the contact along it.

    A contact that may be held, and is held along the first direction, sticks.
    """
    carried_on, slips, w = carried_on_by(before, free.let_go, pulled), free.slips, free.w
    turn, low, high = 0.0, -math.inf, math.inf
    turn_before, before_off = math.nan, math.nan
    way, touch = pulled, Touch(0.0, 0.0, 0.0, 0.0, NO_WAY)
    for trial in range(TRIALS):
        way = plus(scaled(math.cos(turn), pulled), math.sin(turn), left_of(pulled))
        touch = solve_along(way, free, law, before, step)
        normal, tangential = touch.normal, touch.tangential
        if trial == 0 and may_hold and abs(touch.status - SLIDING) > 0.5:
            break
        # The direction is that of the velocity, see `exact.velocity_at`.
        moved = plus(scaled(9.0, slip_under(way, normal, tangential, slips, w)), 1.0, carried_on)
        off = across(moved, way)
        size = abs(slips.a) + abs(slips.b) + (abs(w.an) + abs(w.bn)) * normal + (w.aa + w.bb) * abs(tangential)
        if abs(off) <= ACROSS * (9.0 * size + abs(carried_on.a) + abs(carried_on.b)):
            break
        # A force of opposite sign has the slip on the other side.
        side = off if tangential >= 0.0 else -off
        if side > 0.0:
            low = max(low, turn)
        else:
            high = min(high, turn)
        soft = along(times(of_tangents(w), left_of(way)), left_of(way))
        stiff = abs(along(moved, way)) + 9.0 * abs(tangential) * soft
        change = side / stiff if stiff > 0.0 else math.inf
        if turn != turn_before and abs(off) < 0.5 * abs(before_off) and off != before_off:
            change = off * (turn - turn_before) / (before_off - off)
        turn_before, before_off = turn, off
        found = turn + min(max(change, -LONGEST), LONGEST)
        if not low < found < high:
            has_bracket = math.isfinite(low) and math.isfinite(high)
            found = 0.5 * (low + high) if has_bracket else turn + math.copysign(0.5, side)
        if found == turn or not low < found < high:
            break
        turn = found
    return way, touch


@inlined
def carried_in_space(carried: Array, i: int, runs: Runs) -> BeforeInSpace:
    """Return what a contact in space carries, along both tangents; see `carried_by`.

    Only bristles have a state along tangent b.
    """
    base = i * at.CARRIED
    return BeforeInSpace(
        held(carried, base + at.STATUS, runs),
        held_along(carried, base + at.LAST_SLIP, base + at.LAST_SLIP_B, runs),
        held_along(carried, base + at.EARLIER_SLIP, base + at.EARLIER_SLIP_B, runs),
        held_along(carried, base + at.FRICTION_STATE, base + at.FRICTION_STATE_B, runs),
        held(carried, base + at.LAST_NORMAL, runs),
        held_along(carried, base + at.LAST_TANGENTIAL, base + at.LAST_TANGENTIAL_B, runs),
        held_along(carried, base + at.PAST_RATIO, base + at.PAST_RATIO_B, runs),
    )


@inlined
def strayed_in_space(carried: Array, i: int, runs: Runs) -> Tangents:
    """Return the distance of contact `i` from the anchor of its stick, along both tangents."""
    base = i * at.CARRIED
    return Tangents(
        strayed(carried, base, at.MATERIAL, at.ANCHOR, runs), strayed(carried, base, at.MATERIAL_B, at.ANCHOR_B, runs)
    )


@inlined
def displaced_in_space(faces: Array, n: int, runs: Runs) -> tuple[Number, Tangents]:
    """Return gap and slips of a contact under all forces, from the row of its normal on."""
    gap = component(faces, n, DISPLACEMENT, runs)
    return gap, Tangents(component(faces, n + 1, DISPLACEMENT, runs), component(faces, n + 2, DISPLACEMENT, runs))


@inlined
def free_of_own(
    contacts: Contacts, carried: Array, i: int, normal: Number, pulled: Tangents, runs: Runs
) -> FreeInSpace:
    """Return the motion of contact `i` without its own forces."""
    n = contacts.rows[i]
    w, (gap, slips) = whole_compliance(contacts.faces, n, runs), displaced_in_space(contacts.faces, n, runs)
    gap -= w.nn * normal - w.na * pulled.a - w.nb * pulled.b
    slip_a = slips.a - (w.an * normal - w.aa * pulled.a - w.ab * pulled.b)
    slip_b = slips.b - (w.bn * normal - w.ba * pulled.a - w.bb * pulled.b)
    let_go = held(contacts.now, i * at.IN_STEP + at.LET_GO, runs)
    return FreeInSpace(gap, Tangents(slip_a, slip_b), strayed_in_space(carried, i, runs), w, let_go, pulled)


@lanewise(NOTHING)
def direction(force: Tangents, last: Tangents) -> Tangents:
    """Return the direction of a force along both tangents, that of the last force where there is none."""
    return direction_of(force if force.a != 0.0 or force.b != 0.0 else last, ALONG_A)


@inlined
def free_in_space(i: int, contacts: Contacts, runs: Runs) -> None:
    """Set gap and slips of contact `i` in space, and those that lack its own forces."""
    now, n, here = contacts.now, contacts.rows[i], i * at.IN_STEP
    w, (gap, slips) = whole_compliance(contacts.faces, n, runs), displaced_in_space(contacts.faces, n, runs)
    normal = held(now, here + at.NORMAL_NOW, runs)
    pulled = held_along(now, here + at.TANGENTIAL_NOW, here + at.TANGENTIAL_NOW_B, runs)
    hold(now, here + at.NEW_GAP, runs, gap)
    hold_along(now, here + at.NEW_SLIP, here + at.NEW_SLIP_B, runs, slips)
    hold(now, here + at.FREE_GAP, runs, gap - w.nn * normal + w.na * pulled.a + w.nb * pulled.b)
    free_a = slips.a - w.an * normal + w.aa * pulled.a + w.ab * pulled.b
    free_b = slips.b - w.bn * normal + w.ba * pulled.a + w.bb * pulled.b
    hold_along(now, here + at.FREE_SLIP, here + at.FREE_SLIP_B, runs, Tangents(free_a, free_b))
