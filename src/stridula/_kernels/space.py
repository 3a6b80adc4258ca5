"""Step 5 for contacts in space, which have two tangents.

The march has two pairs of rows for each: the normal with the first tangent, then no normal with the second tangent.
Friction acts along one direction u of the tangent plane. Along u the contact is like one of the plane; u is the
direction without velocity across it. Under laws whose friction changes within a step the slip goes its way as a vector:
see `contact_in_space`.
"""

import math
from typing import Any

from . import layout as at
from .block_rows import COMPLIANCE, DISPLACEMENT
from .compiled import inlined, overloaded, pasted, strict
from .contact import SLIDING
from .contact_in_space import next_on_way_of_run, slide_on_its_way
from .contact_values import Before, BeforeInSpace, Compliance, ComplianceInSpace
from .lanes import Array, Number, Numbers, Pair, Runs, choose, component, held, hold, lane, spread, with_lane
from .law_columns import STATIC
from .parts import Contacts, Sizes
from .solves import carried_by, solve_one_run, strayed
from .vectors import LANES, VECTOR

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


@inlined
def softened_in_space(w: ComplianceInSpace, give: Number) -> ComplianceInSpace:
    """Return a compliance in space with an additional one of the normal."""
    return ComplianceInSpace(w.nn + give, w.na, w.nb, w.an, w.aa, w.ab, w.bn, w.ba, w.bb)


@inlined
def along(w: ComplianceInSpace, c: Number, s: Number) -> Compliance:
    """Return the compliance (nn, nt, tn, tt) of a contact in space along the direction (c, s) of its tangent plane."""
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


@strict
def solve_along(
    c: Number,
    s: Number,
    free: tuple[Any, ...],
    laws: Array,
    number: int,
    before: BeforeInSpace,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Solve a contact in space as one of the plane along a direction; `free` are gap, slips, strays and compliance."""
    gap, slips, strays, w = free
    was, last, earlier, state, last_normal, last_forces, _, pasts = before
    # When it is late, no reversal within the step (5d) is considered.
    was = was if let_go == 0.0 else 0.0
    return solve_one_run(
        gap,
        c * slips[0] + s * slips[1],
        c * strays[0] + s * strays[1],
        along(w, c, s),
        at.COULOMB,
        laws,
        number,
        Before(
            was,
            c * last[0] + s * last[1],
            c * earlier[0] + s * earlier[1],
            state[0],
            last_normal,
            c * last_forces[0] + s * last_forces[1],
            c * pasts[0] + s * pasts[1],
        ),
        let_go,
        step,
    )


@strict
def carried_on_by(before: BeforeInSpace, let_go: Number, first: Number, second: Number) -> Pair:
    """Return the share of the last two slips in the velocity along which friction acts, in units of a ninth of a slip.

    Contacts that come to rest together may have no consistent forces with this share; after some sweeps friction
    therefore acts along the slip alone. The same holds where a contact begins to slide against its last slips: it was
    at rest, without a direction.
    """
    moved, swerved = 6.0 * before.slip[0] + before.earlier_slip[0], 6.0 * before.slip[1] + before.earlier_slip[1]
    begins = before.status < SLIDING - 0.5 and first * moved + second * swerved <= 0.0
    if let_go > 0.0 or begins:
        return 0.0, 0.0
    return moved, swerved


@strict
def slip_under(c: Number, s: Number, normal: Number, tangential: Number, slips: Pair, w: ComplianceInSpace) -> Pair:
    """Return the slip along both tangents under a normal force and one along a direction."""
    first = slips[0] + w.an * normal - (c * w.aa + s * w.ab) * tangential
    return first, slips[1] + w.bn * normal - (c * w.ba + s * w.bb) * tangential


@strict
def turns_on_its_line(free: tuple[Any, ...], mu: Number, size: Number, came: Pair) -> bool:
    """Return whether friction along the last slip reverses it with only rounding across.

    The velocity then passes zero, near which no direction has velocity across it.
    """
    gap, slips, _, w = free
    if size == 0.0:
        return False
    c, s = came
    clear = w[0] - mu * (c * w[1] + s * w[2])
    if clear <= 0.0:
        return False
    normal = -gap / clear
    slip, swerve = slip_under(c, s, normal, mu * normal, slips, w)
    farther, across = c * slip + s * swerve, c * swerve - s * slip
    return farther < 0.0 and abs(across) <= STRAIGHT * (size - farther)


@strict
def solve_one_in_space(
    gap: Number,
    slips: Pair,
    strays: Pair,
    w: ComplianceInSpace,
    law: int,
    laws: Array,
    number: int,
    before: BeforeInSpace,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Return normal force, both tangential forces, status and whether it jams.

    Arguments are those of `contact.solve_contact`, with a number for each tangent; `before` are status, slips of the
    last two steps, internal states, forces of the last step, a guess of those along the tangents, the past parts of the
    ratios.
    """
    if gap >= 0.0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    if law != at.COULOMB:
        return slide_on_its_way(gap, slips, strays, w, law, laws, number, before, let_go > 0.5, step)
    first, second, held = sticking_direction(gap, slips[0] + strays[0], slips[1] + strays[1], w)
    mu, was, last, guess = laws[number, STATIC], before.status, before.slip, before.guess
    may_hold = held <= mu or mu == 0.0
    if not may_hold:
        strength = math.hypot(guess[0], guess[1])
        near = (guess[0] / strength, guess[1] / strength) if strength > 0.0 else (first, second)
        carried_on = carried_on_by(before, let_go, first, second)
        c, s, found = sliding_direction(gap, slips, w, mu, carried_on, near)
        if found:
            normal = -gap / (w.nn - mu * (c * w.na + s * w.nb))
            slip, swerve = slip_under(c, s, normal, mu * normal, slips, w)
            # A reversal within the step (5d) is solved as a contact along a line only.
            turns = let_go == 0.0 and c * last[0] + s * last[1] < 0.0
            if was < SLIDING - 0.5 or (c * slip + s * swerve >= 0.0 and not turns):
                return normal, mu * normal * c, mu * normal * s, 2.0, 0.0
            first, second = c, s
    free = (gap, slips, strays, w)
    size = math.hypot(last[0], last[1])
    came = (last[0] / size, last[1] / size) if size > 0.0 else (1.0, 0.0)
    slid = was > SLIDING - 0.5 and let_go == 0.0
    if slid and turns_on_its_line(free, mu, size, came):
        c, s = came
        normal, tangential, status, jammed = solve_along(c, s, free, laws, number, before, let_go, step)
        return normal, tangential * c, tangential * s, status, jammed
    c, s, normal, tangential, status, jammed = searched(
        first, second, may_hold, free, laws, number, before, let_go, step
    )
    if slid and abs(status - SLIDING) < 0.5:
        slip, swerve = slip_under(c, s, normal, tangential, slips, w)
        if size > 0.0 and tangential * (c * slip + s * swerve) < 0.0:
            # It comes to rest or reverses within the step (5d): along the line of its last slip.
            c, s = came
            normal, tangential, status, jammed = solve_along(c, s, free, laws, number, before, let_go, step)
    return normal, tangential * c, tangential * s, status, jammed


@strict
def searched(
    first: Number,
    second: Number,
    may_hold: bool,
    free: tuple[Any, ...],
    laws: Array,
    number: int,
    before: BeforeInSpace,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Return the direction of friction, by the secant method within a bracket, and the contact along it.

    A contact that may be held, and is held along the first direction, sticks.
    """
    carried_on, (_, slips, _, w) = carried_on_by(before, let_go, first, second), free
    turn, low, high = 0.0, -math.inf, math.inf
    turn_before, across_before = math.nan, math.nan
    c, s, normal, tangential, status, jammed = first, second, 0.0, 0.0, 0.0, 0.0
    for trial in range(TRIALS):
        cosine, sine = math.cos(turn), math.sin(turn)
        c, s = first * cosine - second * sine, second * cosine + first * sine
        normal, tangential, status, jammed = solve_along(c, s, free, laws, number, before, let_go, step)
        if trial == 0 and may_hold and abs(status - SLIDING) > 0.5:
            break
        # The direction is that of the velocity, see `contact.velocity_at`.
        slip, swerve = slip_under(c, s, normal, tangential, slips, w)
        moved, swerved = 9.0 * slip + carried_on[0], 9.0 * swerve + carried_on[1]
        across = c * swerved - s * moved
        size = abs(slips[0]) + abs(slips[1]) + (abs(w[3]) + abs(w[6])) * normal + (w[4] + w[8]) * abs(tangential)
        if abs(across) <= ACROSS * (9.0 * size + abs(carried_on[0]) + abs(carried_on[1])):
            break
        # A force of opposite sign has the slip on the other side.
        side = across if tangential >= 0.0 else -across
        if side > 0.0:
            low = max(low, turn)
        else:
            high = min(high, turn)
        soft = s * (s * w[4] - c * w[5]) + c * (c * w[8] - s * w[7])
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
    return c, s, normal, tangential, status, jammed


def solve_in_space(
    gap: Number,
    slips: Pair,
    strays: Pair,
    w: ComplianceInSpace,
    law: int,
    laws: Array,
    number: int,
    before: BeforeInSpace,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Do `solve_one_in_space` for numbers of runs."""
    return solve_one_in_space(gap, slips, strays, w, law, laws, number, before, let_go, step)


@strict
def lane_of_pair(pair: Pair, i: int) -> Pair:
    """Return the numbers in a lane of two vectors."""
    return lane(pair[0], i), lane(pair[1], i)


@strict
def lanes_of_compliance(w: ComplianceInSpace, i: int) -> ComplianceInSpace:
    """Return the numbers in a lane of a compliance."""
    return ComplianceInSpace(
        lane(w.nn, i),
        lane(w.na, i),
        lane(w.nb, i),
        lane(w.an, i),
        lane(w.aa, i),
        lane(w.ab, i),
        lane(w.bn, i),
        lane(w.ba, i),
        lane(w.bb, i),
    )


@strict
def lanes_of_past(before: BeforeInSpace, i: int) -> BeforeInSpace:
    """Return the numbers in a lane of the past of a contact."""
    return BeforeInSpace(
        lane(before.status, i),
        lane_of_pair(before.slip, i),
        lane_of_pair(before.earlier_slip, i),
        lane_of_pair(before.state, i),
        lane(before.normal, i),
        lane_of_pair(before.tangential, i),
        lane_of_pair(before.guess, i),
        lane_of_pair(before.past, i),
    )


@strict
def solve_runs_in_space(
    gap: Number,
    slips: Pair,
    strays: Pair,
    w: ComplianceInSpace,
    law: int,
    laws: Array,
    number: int,
    before: BeforeInSpace,
    let_go: Number,
    step: Number,
) -> Numbers:
    """Do `solve_one_in_space` for vectors of runs."""
    normal, first, second, new, jammed = spread(0.0), spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for i in range(LANES):
        one = solve_one_in_space(
            lane(gap, i),
            lane_of_pair(slips, i),
            lane_of_pair(strays, i),
            lanes_of_compliance(w, i),
            law,
            laws,
            number + i,
            lanes_of_past(before, i),
            lane(let_go, i),
            step,
        )
        normal, first, second = with_lane(normal, i, one[0]), with_lane(first, i, one[1]), with_lane(second, i, one[2])
        new, jammed = with_lane(new, i, one[3]), with_lane(jammed, i, one[4])
    return normal, first, second, new, jammed


@overloaded(solve_in_space)
def _overload_solve_in_space(
    gap: Any, slips: Any, strays: Any, w: Any, law: Any, laws: Any, number: Any, before: Any, let_go: Any, step: Any
) -> Any:
    chosen = solve_runs_in_space if gap is VECTOR else solve_one_in_space
    return lambda gap, slips, strays, w, law, laws, number, before, let_go, step: chosen(
        gap, slips, strays, w, law, laws, number, before, let_go, step
    )


@inlined
def carried_in_space(carried: Array, i: int, guess: Pair, runs: Runs) -> BeforeInSpace:
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
        guess,
        (first.past, second.past),
    )


@pasted
def free_of_own(contacts: Contacts, carried: Array, i: int, runs: Runs) -> tuple[tuple[Any, ...], Array]:
    """Return the arguments of `solve_in_space` for a contact, without its own forces, and the laws."""
    faces, now = contacts.faces, contacts.now
    w = whole_compliance(faces, i, runs)
    here = i * at.IN_STEP
    normal = held(now, here + at.NORMAL_NOW, runs)
    first = held(now, here + at.TANGENTIAL_NOW, runs)
    second = held(now, here + at.IN_STEP + at.TANGENTIAL_NOW, runs)
    gap = component(faces, 2 * i, DISPLACEMENT, runs) - (w.nn * normal - w.na * first - w.nb * second)
    slip = component(faces, 2 * i + 1, DISPLACEMENT, runs) - (w.an * normal - w.aa * first - w.ab * second)
    swerve = component(faces, 2 * i + 3, DISPLACEMENT, runs) - (w.bn * normal - w.ba * first - w.bb * second)
    strays = strayed(carried, i, runs), strayed(carried, i + 1, runs)
    before = carried_in_space(carried, i, (first, second), runs)
    return (gap, (slip, swerve), strays, w, contacts.codes[i], i * runs.columns + runs.first, before), contacts.laws


@inlined
def put_second(
    contacts: Contacts, i: int, runs: Runs, goes_on: bool, normal: Number, second: Number, status: Number
) -> Number:
    """Set the force along the second tangent of contact `i`; return its change."""
    now, here = contacts.now, (i + 1) * at.IN_STEP
    was = held(now, here + at.TANGENTIAL_NOW, runs)
    second = choose(goes_on, second, was)
    hold(now, here + at.TANGENTIAL_NOW, runs, second)
    # The pair without a normal repeats force and status of its contact, so that it is carried and shared likewise.
    hold(now, here + at.NORMAL_NOW, runs, normal)
    hold(now, here + at.STATUS_NOW, runs, status)
    return second - was


def direction(force: Pair, last: Pair) -> Pair:
    """Return the direction of a force along both tangents, that of the last force where there is none."""
    return direction_of_one(force, last)


@strict
def direction_of_one(force: Pair, last: Pair) -> Pair:
    """Do `direction` for one run."""
    first, second = force if force[0] != 0.0 or force[1] != 0.0 else last
    size = math.hypot(first, second)
    return (first / size, second / size) if size > 0.0 else (1.0, 0.0)


@strict
def direction_of_runs(force: Pair, last: Pair) -> Pair:
    """Do `direction` for vectors of runs."""
    first, second = spread(0.0), spread(0.0)
    for i in range(LANES):
        one = direction_of_one(lane_of_pair(force, i), lane_of_pair(last, i))
        first, second = with_lane(first, i, one[0]), with_lane(second, i, one[1])
    return first, second


@overloaded(direction)
def _overload_direction(force: Any, last: Any) -> Any:
    chosen = direction_of_runs if force[0] is VECTOR else direction_of_one
    return lambda force, last: chosen(force, last)


@inlined
def pair_of(array: Array, row: int, further: int, runs: Runs) -> Pair:
    """Return the numbers of a contact in space along both tangents."""
    return held(array, row, runs), held(array, row + further, runs)


@inlined
def on(pair: Pair, c: Number, s: Number) -> Number:
    """Return the component of a pair along the direction (c, s)."""
    return c * pair[0] + s * pair[1]


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


def next_in_space(
    touch: Pair,
    gap: Number,
    slips: Pair,
    strays: Pair,
    w: ComplianceInSpace,
    law: int,
    laws: Array,
    number: int,
    before: BeforeInSpace,
    let_go: Number,
    step: Number,
) -> tuple[Pair, Pair, Number]:
    """Return past parts of the ratios, internal states and share of stick: `contact_in_space.next_on_way_of_run`."""
    return next_on_way_of_run(touch, gap, slips, strays, w, law, laws, number, before, let_go, step)


@strict
def next_of_runs_in_space(
    touch: Pair,
    gap: Number,
    slips: Pair,
    strays: Pair,
    w: ComplianceInSpace,
    law: int,
    laws: Array,
    number: int,
    before: BeforeInSpace,
    let_go: Number,
    step: Number,
) -> tuple[Any, ...]:
    """Do `next_in_space` for vectors of runs."""
    past, other_past, state, other_state, stuck = spread(0.0), spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for i in range(LANES):
        one = next_on_way_of_run(
            lane_of_pair(touch, i),
            lane(gap, i),
            lane_of_pair(slips, i),
            lane_of_pair(strays, i),
            lanes_of_compliance(w, i),
            law,
            laws,
            number + i,
            lanes_of_past(before, i),
            lane(let_go, i),
            step,
        )
        past, other_past = with_lane(past, i, one[0][0]), with_lane(other_past, i, one[0][1])
        state, other_state = with_lane(state, i, one[1][0]), with_lane(other_state, i, one[1][1])
        stuck = with_lane(stuck, i, one[2])
    return (past, other_past), (state, other_state), stuck


@overloaded(next_in_space)
def _overload_next_in_space(
    touch: Any,
    gap: Any,
    slips: Any,
    strays: Any,
    w: Any,
    law: Any,
    laws: Any,
    number: Any,
    before: Any,
    let_go: Any,
    step: Any,
) -> Any:
    chosen = next_of_runs_in_space if slips[0] is VECTOR else next_on_way_of_run
    return lambda touch, gap, slips, strays, w, law, laws, number, before, let_go, step: chosen(
        touch, gap, slips, strays, w, law, laws, number, before, let_go, step
    )
