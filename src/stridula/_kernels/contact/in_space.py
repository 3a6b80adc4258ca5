"""Step 5 for contacts in space, which have two tangents.

The march has two pairs of rows for each: the normal with the first tangent, then no normal with the second tangent.
Friction acts along one direction u of the tangent plane. Along u the contact is like one of the plane; u is the
direction without velocity across it. Under laws whose friction changes within a step the slip goes its way as a vector:
see `law_in_space`.
"""

import math

from ..lanes.compiled import inlined, strict, strict_pasted
from ..lanes.operations import Array, Number, Numbers, Pair, Runs, choose, component, held, hold
from ..layout import columns as at
from ..layout.contact_values import (
    Before,
    BeforeInSpace,
    Compliance,
    ComplianceInSpace,
    Free,
    FreeInSpace,
    Law,
    Touch,
    TouchInSpace,
)
from ..layout.laws import STATIC
from ..layout.parts import Contacts, Sizes
from ..layout.rows import COMPLIANCE, DISPLACEMENT
from .exact import SLIDING
from .lanewise import lanewise
from .law_in_space import slide_on_its_way
from .solves import carried_by, solve, strayed

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
def is_second(codes: Array, i: int) -> bool:
    """Return whether pair `i` is the second of a contact in space."""
    return i < codes.size and codes[i] == at.SECOND_TANGENT


@inlined
def whole_compliance(faces: Array, i: int, runs: Runs) -> ComplianceInSpace:
    """Return the compliance of a contact in space, rows of normal and tangents, for forces ``(N, -T1, -T2)``."""
    n, t, b = 2 * i, 2 * i + 1, 2 * i + 3
    return ComplianceInSpace(
        component(faces, n, COMPLIANCE + n, runs),
        component(faces, n, COMPLIANCE + t, runs),
        component(faces, n, COMPLIANCE + b, runs),
        component(faces, t, COMPLIANCE + n, runs),
        component(faces, t, COMPLIANCE + t, runs),
        component(faces, t, COMPLIANCE + b, runs),
        component(faces, b, COMPLIANCE + n, runs),
        component(faces, b, COMPLIANCE + t, runs),
        component(faces, b, COMPLIANCE + b, runs),
    )


@strict_pasted
def along(w: ComplianceInSpace, way: Pair) -> Compliance:
    """Return the compliance of a contact in space along a direction of its tangent plane."""
    c, s = way
    return Compliance(
        w.nn,
        c * w.na + s * w.nb,
        c * w.an + s * w.bn,
        c * (c * w.aa + s * w.ab) + s * (c * w.ba + s * w.bb),
    )


@strict
def sticking_direction(gap: Number, first: Number, second: Number, w: ComplianceInSpace) -> Numbers:
    """Return the force that would hold a contact against its free displacements (5b): its direction, and its size.

    The size is relative to the normal force, infinite where that would pull.
    """
    a, b = w.aa - w.an * w.na / w.nn, w.ab - w.an * w.nb / w.nn
    c, d = w.ba - w.bn * w.na / w.nn, w.bb - w.bn * w.nb / w.nn
    first, second = first - w.an * gap / w.nn, second - w.bn * gap / w.nn
    determinant = a * d - b * c
    if abs(determinant) > SINGULAR * (a + d) * (a + d):
        first, second = (d * first - b * second) / determinant, (a * second - c * first) / determinant
    size, pressed = math.hypot(first, second), w.na * first + w.nb * second - gap
    if size == 0.0:
        return 1.0, 0.0, 0.0
    return first / size, second / size, size * w.nn / pressed if pressed > 0.0 else math.inf


@strict
def sliding_direction(
    gap: Number,
    slips: Pair,
    w: ComplianceInSpace,
    mu: Number,
    carried_on: Pair,
    guess: Pair,
) -> tuple[Number, Number, bool]:
    """Return the direction of friction under a ratio `mu`, by Newton's method, and whether it converged."""
    c, s = guess
    for _ in range(NEWTON):
        free = w.nn - mu * (c * w.na + s * w.nb)
        if not free > 0.0:
            return c, s, False
        normal = -gap / free
        turning = normal * mu * (c * w.nb - s * w.na) / free
        pulled, more = mu * normal, mu * turning
        first, second = c * w.aa + s * w.ab, c * w.ba + s * w.bb
        moved = 9.0 * (slips[0] + w.an * normal - first * pulled) + carried_on[0]
        swerved = 9.0 * (slips[1] + w.bn * normal - second * pulled) + carried_on[1]
        across = c * swerved - s * moved
        moving = 9.0 * (w.an * turning - first * more - (c * w.ab - s * w.aa) * pulled)
        swerving = 9.0 * (w.bn * turning - second * more - (c * w.bb - s * w.ba) * pulled)
        slope = c * swerving - s * moving - (c * moved + s * swerved)
        if not slope < 0.0:
            return c, s, False
        change = -across / slope
        if not abs(change) < LONGEST:
            return c, s, False
        # The tangent of a small angle equals the angle.
        c, s = c - s * change, s + c * change
        size = math.sqrt(c * c + s * s)
        c, s = c / size, s / size
        if abs(change) < SETTLED:
            return c, s, True
    return c, s, False


@strict_pasted
def on(vector: Pair, way: Pair) -> Number:
    """Return the component of a vector along a direction."""
    return way[0] * vector[0] + way[1] * vector[1]


@strict_pasted
def free_along(free: FreeInSpace, way: Pair) -> Free:
    """Return the motion of a contact in space without its forces, along a direction."""
    return Free(free.gap, on(free.slips, way), on(free.strays, way), along(free.w, way), free.let_go)


@strict_pasted
def past_along(before: BeforeInSpace, way: Pair) -> Before:
    """Return what a contact in space carries, along a direction."""
    return Before(
        before.status,
        on(before.slip, way),
        on(before.earlier_slip, way),
        before.state[0],
        before.normal,
        on(before.tangential, way),
        on(before.past, way),
    )


@strict
def solve_along(way: Pair, free: FreeInSpace, law: Law, before: BeforeInSpace, step: Number) -> Touch:
    """Solve a contact in space under Coulomb's law as one of the plane along a direction."""
    status, slip, earlier, state, normal, tangential, past = past_along(before, way)
    # When it is late, no reversal within the step (5d) is considered.
    was = Before(status if free.let_go == 0.0 else 0.0, slip, earlier, state, normal, tangential, past)
    return solve(free_along(free, way), law, was, step)


@strict
def carried_on_by(before: BeforeInSpace, let_go: Number, pulled: Pair) -> Pair:
    """Return the share of the last two slips in the velocity along which friction acts, in units of a ninth of a slip.

    Contacts that come to rest together may have no consistent forces with this share; after some sweeps friction
    therefore acts along the slip alone. The same holds where a contact begins to slide against its last slips: it was
    at rest, without a direction.
    """
    moved, swerved = 6.0 * before.slip[0] + before.earlier_slip[0], 6.0 * before.slip[1] + before.earlier_slip[1]
    begins = before.status < SLIDING - 0.5 and pulled[0] * moved + pulled[1] * swerved <= 0.0
    if let_go > 0.0 or begins:
        return 0.0, 0.0
    return moved, swerved


@strict
def slip_under(way: Pair, normal: Number, tangential: Number, slips: Pair, w: ComplianceInSpace) -> Pair:
    """Return the slip along both tangents under a normal force and one along a direction."""
    c, s = way
    first = slips[0] + w.an * normal - (c * w.aa + s * w.ab) * tangential
    return first, slips[1] + w.bn * normal - (c * w.ba + s * w.bb) * tangential


@strict
def turns_on_its_line(free: FreeInSpace, mu: Number, size: Number, came: Pair) -> bool:
    """Return whether friction along the last slip reverses it with only rounding across.

    The velocity then passes zero, near which no direction has velocity across it.
    """
    if size == 0.0:
        return False
    (c, s), w = came, free.w
    clear = w.nn - mu * (c * w.na + s * w.nb)
    if clear <= 0.0:
        return False
    normal = -free.gap / clear
    slip, swerve = slip_under(came, normal, mu * normal, free.slips, w)
    farther, across = c * slip + s * swerve, c * swerve - s * slip
    return farther < 0.0 and abs(across) <= STRAIGHT * (size - farther)


@strict
def along_way(way: Pair, touch: Touch) -> TouchInSpace:
    """Return a contact along a direction as one of space."""
    pulled = touch.tangential * way[0], touch.tangential * way[1]
    return TouchInSpace(touch.normal, pulled, touch.status, touch.jammed)


@lanewise(TouchInSpace(0.0, (0.0, 0.0), 0.0, 0.0))
def solve_in_space(free: FreeInSpace, law: Law, before: BeforeInSpace, step: Number) -> TouchInSpace:
    """Do `solves.solve` for a contact in space."""
    gap, slips, strays, w = free.gap, free.slips, free.strays, free.w
    if gap >= 0.0:
        return TouchInSpace(0.0, (0.0, 0.0), 0.0, 0.0)
    if law.code != at.COULOMB:
        return slide_on_its_way(free, law, before, step)
    first, second, held = sticking_direction(gap, slips[0] + strays[0], slips[1] + strays[1], w)
    mu, was, last, guess = law.table[law.row, STATIC], before.status, before.slip, free.guess
    may_hold = held <= mu or mu == 0.0
    if not may_hold:
        strength = math.hypot(guess[0], guess[1])
        near = (guess[0] / strength, guess[1] / strength) if strength > 0.0 else (first, second)
        carried_on = carried_on_by(before, free.let_go, (first, second))
        c, s, found = sliding_direction(gap, slips, w, mu, carried_on, near)
        if found:
            normal = -gap / (w.nn - mu * (c * w.na + s * w.nb))
            slip, swerve = slip_under((c, s), normal, mu * normal, slips, w)
            # A reversal within the step (5d) is solved as a contact along a line only.
            turns = free.let_go == 0.0 and c * last[0] + s * last[1] < 0.0
            if was < SLIDING - 0.5 or (c * slip + s * swerve >= 0.0 and not turns):
                return TouchInSpace(normal, (mu * normal * c, mu * normal * s), 2.0, 0.0)
            first, second = c, s
    size = math.hypot(last[0], last[1])
    came = (last[0] / size, last[1] / size) if size > 0.0 else (1.0, 0.0)
    slid = was > SLIDING - 0.5 and free.let_go == 0.0
    if slid and turns_on_its_line(free, mu, size, came):
        return along_way(came, solve_along(came, free, law, before, step))
    way, touch = searched((first, second), may_hold, free, law, before, step)
    if slid and abs(touch.status - SLIDING) < 0.5:
        moved = slip_under(way, touch.normal, touch.tangential, slips, w)
        if size > 0.0 and touch.tangential * on(moved, way) < 0.0:
            # It comes to rest or reverses within the step (5d): along the line of its last slip.
            way, touch = came, solve_along(came, free, law, before, step)
    return along_way(way, touch)


@strict
def searched(
    pulled: Pair, may_hold: bool, free: FreeInSpace, law: Law, before: BeforeInSpace, step: Number
) -> tuple[Pair, Touch]:
    """Return the direction of friction, by the secant method within a bracket, and the contact along it.

    A contact that may be held, and is held along the first direction, sticks.
    """
    carried_on, slips, w = carried_on_by(before, free.let_go, pulled), free.slips, free.w
    turn, low, high = 0.0, -math.inf, math.inf
    turn_before, across_before = math.nan, math.nan
    (c, s), touch = pulled, Touch(0.0, 0.0, 0.0, 0.0)
    for trial in range(TRIALS):
        cosine, sine = math.cos(turn), math.sin(turn)
        c, s = pulled[0] * cosine - pulled[1] * sine, pulled[1] * cosine + pulled[0] * sine
        touch = solve_along((c, s), free, law, before, step)
        normal, tangential = touch.normal, touch.tangential
        if trial == 0 and may_hold and abs(touch.status - SLIDING) > 0.5:
            break
        # The direction is that of the velocity, see `contact.velocity_at`.
        slip, swerve = slip_under((c, s), normal, tangential, slips, w)
        moved, swerved = 9.0 * slip + carried_on[0], 9.0 * swerve + carried_on[1]
        across = c * swerved - s * moved
        size = abs(slips[0]) + abs(slips[1]) + (abs(w.an) + abs(w.bn)) * normal + (w.aa + w.bb) * abs(tangential)
        if abs(across) <= ACROSS * (9.0 * size + abs(carried_on[0]) + abs(carried_on[1])):
            break
        # A force of opposite sign has the slip on the other side.
        side = across if tangential >= 0.0 else -across
        if side > 0.0:
            low = max(low, turn)
        else:
            high = min(high, turn)
        soft = s * (s * w.aa - c * w.ab) + c * (c * w.bb - s * w.ba)
        stiff = abs(c * moved + s * swerved) + 9.0 * abs(tangential) * soft
        change = side / stiff if stiff > 0.0 else math.inf
        if turn != turn_before and abs(across) < 0.5 * abs(across_before) and across != across_before:
            change = across * (turn - turn_before) / (across_before - across)
        turn_before, across_before = turn, across
        found = turn + min(max(change, -LONGEST), LONGEST)
        if not low < found < high:
            has_bracket = math.isfinite(low) and math.isfinite(high)
            found = 0.5 * (low + high) if has_bracket else turn + math.copysign(0.5, side)
        if found == turn or not low < found < high:
            break
        turn = found
    return (c, s), touch


@inlined
def carried_in_space(carried: Array, i: int, runs: Runs) -> BeforeInSpace:
    """Return what a contact in space carries, along both tangents; see `carried_by`.

    Only bristles have a state along the second tangent.
    """
    first, second = carried_by(carried, i, runs), carried_by(carried, i + 1, runs)
    return BeforeInSpace(
        first.status,
        (first.slip, second.slip),
        (first.earlier_slip, second.earlier_slip),
        (first.state, second.state),
        first.normal,
        (first.tangential, second.tangential),
        (first.past, second.past),
    )


@inlined
def free_of_own(contacts: Contacts, carried: Array, i: int, normal: Number, pulled: Pair, runs: Runs) -> FreeInSpace:
    """Return the motion of contact `i` without its own forces."""
    faces, w, (first, second) = contacts.faces, whole_compliance(contacts.faces, i, runs), pulled
    gap = component(faces, 2 * i, DISPLACEMENT, runs) - (w.nn * normal - w.na * first - w.nb * second)
    slip = component(faces, 2 * i + 1, DISPLACEMENT, runs) - (w.an * normal - w.aa * first - w.ab * second)
    swerve = component(faces, 2 * i + 3, DISPLACEMENT, runs) - (w.bn * normal - w.ba * first - w.bb * second)
    strays = strayed(carried, i, runs), strayed(carried, i + 1, runs)
    return FreeInSpace(gap, (slip, swerve), strays, w, held(contacts.now, i * at.IN_STEP + at.LET_GO, runs), pulled)


@inlined
def put_second(contacts: Contacts, i: int, runs: Runs, goes_on: bool, second: Number) -> Number:
    """Set the force along the second tangent of contact `i`; return its change."""
    now, here, there = contacts.now, i * at.IN_STEP, (i + 1) * at.IN_STEP
    was = held(now, there + at.TANGENTIAL_NOW, runs)
    second = choose(goes_on, second, was)
    hold(now, there + at.TANGENTIAL_NOW, runs, second)
    # The pair without a normal repeats force and status of its contact, so that it is carried and shared likewise.
    hold(now, there + at.NORMAL_NOW, runs, held(now, here + at.NORMAL_NOW, runs))
    hold(now, there + at.STATUS_NOW, runs, held(now, here + at.STATUS_NOW, runs))
    return second - was


@lanewise((0.0, 0.0))
def direction(force: Pair, last: Pair) -> Pair:
    """Return the direction of a force along both tangents, that of the last force where there is none."""
    first, second = force if force[0] != 0.0 or force[1] != 0.0 else last
    size = math.hypot(first, second)
    return (first / size, second / size) if size > 0.0 else (1.0, 0.0)


@inlined
def pair_of(array: Array, row: int, further: int, runs: Runs) -> Pair:
    """Return the numbers of a contact in space along both tangents."""
    return held(array, row, runs), held(array, row + further, runs)


@inlined
def free_in_space(contacts: Contacts, sizes: Sizes, runs: Runs) -> None:
    """Set the displacements without the own forces of each contact in space, in place of those for one tangent."""
    now, faces = contacts.now, contacts.faces
    for i in range(sizes.contacts):
        if is_second(contacts.codes, i + 1):
            here = i * at.IN_STEP
            w = whole_compliance(faces, i, runs)
            normal = held(now, here + at.NORMAL_NOW, runs)
            first, second = pair_of(now, here + at.TANGENTIAL_NOW, at.IN_STEP, runs)
            gap, slip = held(now, here + at.NEW_GAP, runs), held(now, here + at.NEW_SLIP, runs)
            swerve = held(now, here + at.IN_STEP + at.NEW_SLIP, runs)
            hold(now, here + at.FREE_GAP, runs, gap - w.nn * normal + w.na * first + w.nb * second)
            hold(now, here + at.FREE_SLIP, runs, slip - w.an * normal + w.aa * first + w.ab * second)
            swerve = swerve - w.bn * normal + w.ba * first + w.bb * second
            hold(now, here + at.IN_STEP + at.FREE_SLIP, runs, swerve)
