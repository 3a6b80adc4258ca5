"""The slip velocity on its way through a step for contacts in space, as a vector of the tangent plane.

As in `slipping`, of which this is the vector form: ``u' = drive - P r`` with the matrix P of the tangents in place of
``pull``, and a ratio r along the slip. Motion along a line is the same to rounding.
"""

import math
from typing import Any

from ..lanes.compiled import strict, strict_pasted
from ..lanes.operations import Number, Pair
from ..layout import columns as at
from ..layout.contact_values import (
    BeforeInSpace,
    ComplianceInSpace,
    Drive,
    DriveInSpace,
    FreeInSpace,
    Law,
    Matrix,
    Tangents,
)
from ..layout.laws import BRISTLE_DAMPING, BRISTLE_STIFFNESS, BRISTLE_VISCOUS
from .friction import (
    LEAST_FORCE,
    bristle_limit,
    bristles_over,
    changed_by_normal,
    deflected,
    holding_ratio,
    holding_under,
    joint_of,
    next_normal,
    next_state,
    ratio_after,
    sliding_ratio,
    speed_scale,
    state_ratio,
    under,
)
from .slipping import (
    GROWTH_AT_STAGE,
    MOST_PARTS,
    SEPARATED,
    SLIDING,
    STAGE,
    STICKING,
    STOPPED,
    beyond_hold,
    changed_to,
    moments,
    part_of,
    parts_of_joint,
    parts_with_state,
    ratio_and_bend,
)
from .slipping import slide_through as slide_on_line
from .tangents import (
    ALONG_A,
    NOTHING,
    along,
    by_normal,
    direction_of,
    left_of,
    of_tangents,
    over,
    plus,
    scaled,
    scaled_matrix,
    size_of,
    stiffened,
    times,
    under_closed,
)

# Relative determinant of the matrix of the tangents below which it moves along one direction only.
SINGULAR = 1e-12
# Motion across a line that counts as rounding.
ROUNDING = 1e-9
# Most parts of a step in which the slip turns or stops.
MOST_TURNS = 16
# Trials of a search for a speed, and its relative accuracy.
TRIALS, SETTLED = 200, 1e-15
# Size of a ratio relative to its limit that is reached but for rounding.
AT_LIMIT = 1e-14
# Trials of such a search of which the last takes the middle of its bracket.
UNTRUSTED = 8
# Slip relative to the limit deflection of bristles below which what they take up is computed by its series.
SHORT = 1e-8
# A ratio that nothing holds; its square is still a number.
BEYOND = 1e150


@strict_pasted
def moments_of(
    begin: Number, end: Number, first: Tangents, middle: Tangents, last: Tangents
) -> tuple[Tangents, Tangents]:
    """Do `slipping.moments` for vectors: the integrals with ``1 - s``, then those with ``s``."""
    later_a, past_a = moments(begin, end, first.a, middle.a, last.a)
    later_b, past_b = moments(begin, end, first.b, middle.b, last.b)
    return Tangents(later_a, later_b), Tangents(past_a, past_b)


@strict_pasted
def stage_moments(begin: Number, size: Number, first: Tangents, second: Tangents) -> tuple[Tangents, Tangents]:
    """Return the integrals of the ratio of two stages over a part, with the weights of this step and of the next.

    The mean of the slip over the part is that of its stages.
    """
    left = 1.0 - begin - size
    one, other = (1.0 - STAGE) * (2.0 * STAGE * size + left), STAGE * (STAGE * size + left)
    later = scaled(size, plus(scaled(one, first), other, second))
    one, other = 1.0 - STAGE - one, STAGE - other
    return later, scaled(size, plus(scaled(one, first), other, second))


@strict
def undone_by(matrix: Matrix, vector: Tangents, usual: Number) -> Tangents:
    """Return the force whose displacement under a compliance is a vector, beyond all bounds where there is none.

    Motion that no force undoes is rounding beside the motion itself, or beside that of a `usual` force: where the force
    passes zero, the vector itself is rounding.
    """
    a, b, c, d = matrix
    determinant, trace = a * d - b * c, a + d
    if abs(determinant) > SINGULAR * trace * trace:
        return Tangents((d * vector.a - b * vector.b) / determinant, (a * vector.b - c * vector.a) / determinant)
    size = size_of(vector)
    if size == 0.0:
        return NOTHING
    way = direction_of(Tangents(a, c) if a >= d else Tangents(b, d), ALONG_A)
    moved = along(vector, way)
    if trace > 0.0 and size_of(plus(vector, -moved, way)) <= ROUNDING * max(size, trace * usual):
        return Tangents(way.a * moved / trace, way.b * moved / trace)
    return Tangents(BEYOND * vector.a / size, BEYOND * vector.b / size)


@strict_pasted
def solved(matrix: Matrix, vector: Tangents) -> Tangents:
    """Return the vector whose product with a regular matrix is given."""
    a, b, c, d = matrix
    share = 1.0 / (a * d - b * c)
    return Tangents(share * (d * vector.a - b * vector.b), share * (a * vector.b - c * vector.a))


@strict_pasted
def breaks_at(ratio: Tangents, grows: Tangents, held: Number, held_grows: Number) -> Number:
    """Return the share of a step after which a ratio that grows in a straight line reaches a limit that does so."""
    square = along(grows, grows) - held_grows * held_grows
    half, missing = along(ratio, grows) - held * held_grows, held * held - along(ratio, ratio)
    if missing <= 0.0 or (square <= 0.0 and half <= 0.0):
        return 0.0 if missing <= 0.0 else 1.0
    root = math.sqrt(max(half * half + square * missing, 0.0))
    return min(missing / (half + root) if half >= 0.0 else (root - half) / square, 1.0)


@strict_pasted
def next_trial(low: Number, high: Number, near: Number, trial: int) -> Number:
    """Return the next trial of a search within a bracket: `near`, or its middle where that is outside or too slow."""
    if low < near < high and trial % UNTRUSTED != UNTRUSTED - 1:
        return near
    return 0.5 * (low + high)


@strict
def slip_after(free: Tangents, pull: Matrix, law: Law, step: Number) -> tuple[Tangents, Tangents]:
    """Return the slip ``u = free - pull r`` under a set-valued law, and its ratio: the secant method within a bracket.

    The ratio of incipient sliding brings it to rest.
    """
    size, most = size_of(free), sliding_ratio(law, 0.0)
    # A faster slip is not undone by any friction.
    if size <= 2.0 * most * (pull.aa + pull.bb):
        needed = undone_by(pull, free, 1.0)
        if size_of(needed) <= most:
            return NOTHING, needed
    # With (speed + ratio pull) way = free, the error is the length of 1 over that of the way, less one. The first trial
    # has the friction along the slip without it.
    low, high, last, error_before = 0.0, size, 0.0, 0.0
    drag = along(free, times(pull, free)) / (size * size)
    speed = next_trial(low, high, size - drag * sliding_ratio(law, size / step), 0)
    ratio, way = most, free
    for trial in range(TRIALS):
        ratio = sliding_ratio(law, speed / step)
        way = solved(stiffened(speed, ratio, pull), free)
        error = 1.0 / math.sqrt(way.a * way.a + way.b * way.b) - 1.0
        if error > 0.0:
            high = speed
        else:
            low = speed
        if abs(error) <= SETTLED or high - low <= SETTLED * high:
            break
        near = speed / (1.0 + error)
        if trial > 0 and error != error_before:
            near = speed - error * (speed - last) / (error - error_before)
        if near == speed:
            break
        last, error_before, speed = speed, error, next_trial(low, high, near, trial)
    way = direction_of(way, ALONG_A)
    return scaled(speed, way), scaled(ratio, way)


@strict_pasted
def is_straight(
    slip: Tangents,
    drive: DriveInSpace,
    pull: Matrix,
    way: Tangents,
) -> bool:
    """Return whether a slip stays on its line but for rounding."""
    dragged = times(pull, way)
    reach = size_of(slip) + size_of(drive.begin) + size_of(drive.grows) + size_of(dragged)
    left = left_of(way)
    strays = abs(along(slip, left)) + abs(along(drive.begin, left)) + abs(along(drive.grows, left))
    return strays + abs(along(dragged, left)) <= ROUNDING * reach


@strict
def slide_straight(
    slip: Tangents, begin: Number, drive: DriveInSpace, pull: Matrix, way: Tangents, law: Law, step: Number
) -> tuple[Tangents, Tangents, Number]:
    """Slide along a line, as in the plane."""
    drives = Drive(along(drive.begin, way), along(drive.grows, way))
    pulled = along(way, times(pull, way))
    later, past, stuck = slide_on_line(along(slip, way), begin, drives, pulled, 1.0, law, step)
    return scaled(later, way), scaled(past, way), stuck


@strict
def hold_from(begin: Number, drive: DriveInSpace, pull: Matrix, held: Number) -> tuple[Tangents, Tangents, Number]:
    """Return the ratios that hold a contact at rest from a time of the step on, until it breaks away or the step ends.

    Returns
    -------
    later, past : tuple of float
        Integrals of the ratio, with the weights of this step and of the next.
    end : float
        Time at which it breaks away.
    """
    first = undone_by(pull, plus(drive.begin, begin, drive.grows), 1.0)
    if size_of(first) > held:
        return NOTHING, NOTHING, begin
    last = undone_by(pull, plus(drive.begin, 1.0, drive.grows), 1.0)
    grows = plus(last, -1.0, first)
    share = 1.0 if size_of(last) <= held else breaks_at(first, grows, held, 0.0)
    end = begin + share * (1.0 - begin) if share < 1.0 else 1.0
    last = plus(first, share, grows)
    later, past = moments_of(begin, end, first, plus(first, 0.5 * share, grows), last)
    return later, past, end


@strict_pasted
def part_in_space(slip: Tangents, drive: Tangents, pull: Matrix, law: Law, step: Number) -> Number:
    """Return the size of the next part of the way: as `slipping.part_of`, and where the slip turns or ends, small."""
    speed = size_of(slip)
    if speed == 0.0:
        return 1.0 / MOST_TURNS
    way = over(slip, speed)
    dragged = times(pull, way)
    friction, per_slip, steep, _ = ratio_and_bend(speed, 1.0, along(way, dragged), law, step)
    rate = size_of(plus(drive, -friction, dragged))
    part = part_of(rate, per_slip, steep)
    return max(1.0 / (1.0 / part + rate / speed), min(part, 1.0 / MOST_TURNS))


@strict
def slide_through(
    slip: Tangents, begin: Number, drive: DriveInSpace, pull: Matrix, way: Tangents, law: Law, step: Number
) -> tuple[Tangents, Tangents, Number]:
    """Slide from a time of the step on, under a set-valued law.

    `drive` are its value at the beginning of the step and its change over it, `way` the direction if the slip is on a
    line. Each part takes the rule of two stages of laws with a state, which finds slip or rest in each; it is
    continuous where a slip turns about zero. Returns the same as `slipping.slide_through`.
    """
    if is_straight(slip, drive, pull, way):
        return slide_straight(slip, begin, drive, pull, way, law, step)
    later, past, held = NOTHING, NOTHING, holding_ratio(law, True)
    # From here on at rest, which it is not yet at the beginning.
    rested = False
    for _ in range(2 * MOST_PARTS):
        if begin >= 1.0:
            break
        if rested:
            more, less, end = hold_from(begin, drive, pull, held)
            later, past = plus(later, 1.0, more), plus(past, 1.0, less)
            if end >= 1.0:
                return later, past, 1.0 - begin
            begin = end
        driven = plus(drive.begin, begin, drive.grows)
        size = min(part_in_space(slip, driven, pull, law, step), 1.0 - begin)
        matrix = scaled_matrix(STAGE * size, pull)
        free = plus(plus(slip, size * STAGE, driven), size * GROWTH_AT_STAGE * size, drive.grows)
        _, first = slip_after(free, matrix, law, step)
        driven = plus(driven, 0.5 * size, drive.grows)
        free = plus(plus(slip, size, driven), -size * (1.0 - STAGE), times(pull, first))
        slip, second = slip_after(free, matrix, law, step)
        more, less = stage_moments(begin, size, first, second)
        later, past, begin = plus(later, 1.0, more), plus(past, 1.0, less), begin + size
        rested = slip.a == 0.0 and slip.b == 0.0
    return later, past, 0.0


@strict
def ratio_of_stick(gap: Number, missed: Tangents, w: ComplianceInSpace, otherwise: Tangents) -> Tangents:
    """Return the ratios of the forces that close the gap and undo both slips (5b), others if they pull."""
    pressed, held = sticking_forces(gap, missed, w)
    if not pressed > 0.0 or is_beyond(held):
        return otherwise
    return over(held, pressed)


@strict
def sticking_forces(gap: Number, slips: Tangents, w: ComplianceInSpace) -> tuple[Number, Tangents]:
    """Return the forces that close `gap` and undo both slips (5b), beyond all bounds if no force moves a tangent."""
    missed = Tangents(slips.a - w.an * gap / w.nn, slips.b - w.bn * gap / w.nn)
    held = undone_by(under_closed(w), missed, abs(gap) / w.nn)
    if is_beyond(held):
        return -gap / w.nn, held
    return (w.na * held.a + w.nb * held.b - gap) / w.nn, held


@strict_pasted
def is_beyond(force: Tangents) -> bool:
    """Return whether nothing holds a force of `undone_by`."""
    return max(abs(force.a), abs(force.b)) >= 0.5 * BEYOND


@strict
def after_break(
    earlier: Tangents,
    needed: Tangents,
    driven: Tangents,
    broke: Number,
    drive: DriveInSpace,
    pull: Matrix,
    law: Law,
    step: Number,
) -> tuple[Any, ...]:
    """Slide on from a stick that broke within the last step; results as those of `ratio_over_step`."""
    grows = plus(needed, -1.0, earlier)
    sliding = sliding_ratio(law, 0.0)
    way = direction_of(plus(earlier, broke, grows) if broke > 0.0 else needed, ALONG_A)
    friction = scaled(sliding, way)
    stuck, left, third = 0.5 * broke * broke, 0.5 * (1.0 - broke * broke), broke**3 / 3.0
    past = plus(plus(scaled(stuck, earlier), third, grows), left, friction)
    # Ratios without which it would have kept still, then those of the change of its normal force.
    free = plus(plus(earlier, -1.0, friction), 1.0, plus(driven, -1.0, needed))
    begun = plus(scaled(1.0 / 3.0 - third, drive.grows), left, times(pull, free))
    more, rest, stuck = slide_through(begun, 0.0, drive, pull, way, law, step)
    return plus(past, 1.0, more), rest, STOPPED if stuck > 0.0 else SLIDING, stuck


@strict
def ratio_over_step(
    normal: Number, free: FreeInSpace, law: Law, before: BeforeInSpace, step: Number
) -> tuple[Any, ...]:
    """Return the ratios of forces over a step under a set-valued law, past parts, status and share of stick.

    As `slipping.ratio_over_step`; `gap` and `slips` are those without the forces of this contact.
    """
    gap, slips, strays, w = free.gap, free.slips, free.strays, free.w
    was, last, past = before.status, before.slip, before.past
    pull, moved = scaled_matrix(normal, of_tangents(w)), plus(slips, normal, by_normal(w))
    if was == SLIDING:
        past = scaled(changed_by_normal(law, before.normal, size_of(last) / step), past)
        return slide_on(past, moved, last, pull, law, step)
    held = holding_ratio(law, was == STICKING and free.let_go <= 0.5)
    missed = plus(moved, 1.0, strays)
    driven = undone_by(pull, missed, 1.0)
    needed = ratio_of_stick(gap, plus(slips, 1.0, strays), w, driven)
    driven = needed if is_beyond(driven) else driven
    asked = size_of(needed)
    if was == STICKING and last.a == 0.0 and last.b == 0.0:
        # At rest for a step or more: as in the plane.
        earlier = scaled(2.0, past) if before.normal > 0.0 else needed
        grows = plus(needed, -1.0, earlier)
        beyond = plus(needed, 1.0, grows)
        held_later = holding_under(law, next_normal(normal, before.normal), held)
        if free.let_go <= 0.5 and asked <= held and size_of(beyond) <= held_later:
            return needed, scaled(0.5, needed), STICKING, 1.0
        drive = DriveInSpace(missed, NOTHING if is_beyond(needed) else times(pull, grows))
        if asked > held:
            held_before = holding_under(law, before.normal, held)
            broke = breaks_at(earlier, grows, held_before, held - held_before)
            return after_break(earlier, needed, driven, broke, drive, pull, law, step)
        broke = breaks_at(needed, grows, held, held_later - held)
        at_break = plus(needed, broke, grows)
        way = direction_of(at_break, direction_of(beyond, ALONG_A))
        first, less = moments_of(0.0, broke, needed, plus(needed, 0.5 * broke, grows), at_break)
        more, rest, stuck = slide_through(NOTHING, broke, drive, pull, way, law, step)
        ratio = plus(plus(plus(first, 1.0, more), 0.5, needed), -1.0, over(grows, 6.0))
        return ratio, plus(less, 1.0, rest), STOPPED if stuck > 0.0 else SLIDING, broke + stuck
    if was == STICKING:
        # It came to rest within the last step.
        half = plus(needed, -1.0, past)
        if free.let_go <= 0.5 and 2.0 * size_of(half) <= held:
            return needed, half, STICKING, 1.0
        left = scaled(2.0, plus(missed, -1.0, times(pull, past)))
        # As in the plane.
        slip = plus(scaled(0.5, plus(last, 1.0, missed)), -1.0, times(pull, past))
        slip = shortened(slip, beyond_hold(size_of(left), 2.0 * size_of(half), held))
        way = direction_of(slip, direction_of(left, ALONG_A))
        more, rest, stuck = slide_through(
            slip, 0.0, DriveInSpace(plus(left, -2.0, slip), NOTHING), pull, way, law, step
        )
        return plus(past, 1.0, more), rest, STOPPED if stuck > 0.0 else SLIDING, stuck
    # It lands: half of its force acts before the step.
    if free.let_go <= 0.5 and asked <= held:
        return needed, scaled(0.5, needed), STICKING, 1.0
    begun, change = scaled(0.5, plus(last, 1.0, moved)), plus(moved, -1.0, last)
    speed, way = size_of(begun), direction_of(begun, direction_of(change, ALONG_A))
    past = scaled(0.5 * sliding_ratio(law, speed / step), way)
    return slide_on(past, moved, last, pull, law, step)


@strict_pasted
def slide_on(past: Tangents, moved: Tangents, last: Tangents, pull: Matrix, law: Law, step: Number) -> tuple[Any, ...]:
    """Do `ratio_over_step` for a contact that slides at the beginning of the step."""
    begun, change = scaled(0.5, plus(last, 1.0, moved)), plus(moved, -1.0, last)
    slip = plus(begun, -1.0, times(pull, past))
    way = direction_of(slip, direction_of(change, ALONG_A))
    more, rest, stuck = slide_through(slip, 0.0, DriveInSpace(change, NOTHING), pull, way, law, step)
    return plus(past, 1.0, more), rest, STOPPED if stuck > 0.0 else SLIDING, stuck


@strict_pasted
def friction_after(law: Law, state: Tangents, speed: Number, time: Number) -> Pair:
    """Return the factors of the state and of the slip velocity in the ratio of a law with internal state after a time.

    Both depend on the speed alone; only LuGre's bristles contribute the first.
    """
    table, row = law.table, law.row
    if law.code == at.LUGRE:
        limit, _ = bristle_limit(law, speed)
        passed = speed * time / limit
        lost = math.expm1(-passed)
        kept, share = 1.0 + lost, -lost / passed if passed > SHORT else 1.0 - 0.5 * passed
        felt = table[row, BRISTLE_STIFFNESS] - table[row, BRISTLE_DAMPING] * speed / limit
        return felt * kept, felt * time * share + table[row, BRISTLE_DAMPING] + table[row, BRISTLE_VISCOUS]
    ratio, slope = ratio_after(law, state.a, speed, time)
    return 0.0, ratio / speed if speed > 0.0 else slope


@strict_pasted
def moved_at(
    speed: Number, free: Tangents, pull: Matrix, law: Law, state: Tangents, time: Number
) -> tuple[Tangents, Tangents]:
    """Return the slip velocity that follows from an assumed speed, and the ratios."""
    if law.code == at.IN_SERIES:
        return moved_at_joint(speed, free, pull, law, state, time)
    holds, drags = friction_after(law, state, speed, time)
    kept = scaled(holds, state)
    velocity = solved(stiffened(1.0, drags, pull), plus(free, -1.0, times(pull, kept)))
    return velocity, plus(kept, drags, velocity)


@strict
def moved_at_joint(
    speed: Number, free: Tangents, pull: Matrix, law: Law, state: Tangents, time: Number
) -> tuple[Tangents, Tangents]:
    """Do `moved_at` for friction in series with a joint.

    Beyond the limit the ratio r has its size, and what the joint alone would have in addition is along it: with the
    matrix ``A`` of the joint, ``(A + share) r`` is what it has without friction; Newton's method for the share.
    """
    stiffness, damping = joint_of(law)
    firm, most = stiffness * time + damping, sliding_ratio(law, speed)
    felt, matrix = plus(scaled(stiffness, state), firm, free), stiffened(1.0, firm, pull)
    ratio, share = solved(matrix, felt), 0.0
    for _ in range(TRIALS):
        size = size_of(ratio)
        if size <= most * (1.0 + AT_LIMIT):
            break
        if most == 0.0:
            ratio = NOTHING
            break
        # The inverse of the size is concave over the share, nearly straight: it is approached from below.
        slope = along(ratio, solved(stiffened(share, 1.0, matrix), ratio)) / (size * size)
        share += (size / most - 1.0) / slope
        ratio = solved(stiffened(share, 1.0, matrix), felt)
    return plus(free, -1.0, times(pull, ratio)), ratio


@strict_pasted
def on_scale(speed: Number, scale: Number, logarithmic: bool) -> Number:
    """Return a speed on the scale of `velocity_after`."""
    return math.asinh(speed / scale) if logarithmic else speed / scale


@strict
def velocity_after(
    free: Tangents, pull: Matrix, guess: Number, law: Law, state: Tangents, time: Number
) -> tuple[Tangents, Tangents]:
    """Return the slip velocity ``v = free - pull r`` and the ratios of a law with internal state after some time.

    At a given speed the law is linear in the velocity; the speed sought is that which results: the secant method within
    a bracket. The scale of rate and state is ``sinh(y)``, so that creep and sliding share one.
    """
    scale, logarithmic = speed_scale(law, state.a), law.code == at.AGING or law.code == at.SLIP
    speed = guess
    if not speed > 0.0:
        velocity, ratio = moved_at(0.0, free, pull, law, state, time)
        speed = size_of(velocity)
        if speed == 0.0:
            return velocity, ratio
    # The error is the assumed speed relative to that which results, less one.
    low, high, last, error_before = 0.0, math.inf, 0.0, 0.0
    y = on_scale(speed, scale, logarithmic)
    for trial in range(TRIALS):
        speed = scale * (math.sinh(y) if logarithmic else y)
        velocity, ratio = moved_at(speed, free, pull, law, state, time)
        reached = size_of(velocity)
        error = speed / reached - 1.0 if reached > 0.0 else 1.0
        if error >= 0.0:
            high = y
        else:
            low = y
        if abs(error) <= SETTLED or (high < math.inf and high - low <= SETTLED * high):
            break
        near = on_scale(reached, scale, logarithmic)
        if trial > 0 and error != error_before:
            near = y - error * (y - last) / (error - error_before)
        if near == y:
            break
        last, error_before = y, error
        most = min(high, on_scale(4.0 * speed, scale, logarithmic))
        y = next_trial(low, most, near, trial) if high < math.inf or near < most else most
    return velocity, ratio


@strict_pasted
def shortened(ratio: Tangents, most: Number) -> Tangents:
    """Return a ratio, or one of the size that it exceeds along it."""
    size = size_of(ratio)
    return scaled(most / size, ratio) if size > most else ratio


@strict_pasted
def joint_after(law: Law, deflection: Tangents, ratio: Tangents, stage: Number, time: Number) -> Tangents:
    """Do `friction.deflected` along both tangents."""
    a = deflected(law, deflection.a, ratio.a, stage, time)
    return Tangents(a, deflected(law, deflection.b, ratio.b, stage, time))


@strict_pasted
def state_after(law: Law, state: Tangents, velocity: Tangents, time: Number) -> Tangents:
    """Return the internal states after some time at a constant slip velocity, exactly."""
    speed = size_of(velocity)
    if law.code == at.LUGRE:
        kept, share, _, _, _ = bristles_over(law, speed, time)
        return plus(scaled(kept, state), time * share, velocity)
    if law.code == at.IN_SERIES:
        stiffness, damping = joint_of(law)
        firm, held = stiffness * time + damping, scaled(stiffness, state)
        ratio = shortened(plus(held, firm, velocity), sliding_ratio(law, speed))
        return joint_after(law, state, ratio, time, time)
    return Tangents(next_state(law, state.a, speed, time), state.b)


@strict_pasted
def state_between(
    law: Law, state: Tangents, velocity: Tangents, ratio: Tangents, stage: Number, time: Number
) -> Tangents:
    """Do `state_after` from the beginning of a stage to that of the next one; a joint has the rate of the stage."""
    if law.code == at.IN_SERIES:
        return joint_after(law, state, ratio, stage, time)
    return state_after(law, state, velocity, time)


@strict
def ratio_of_state(law: Law, state: Tangents, velocity: Tangents) -> Tangents:
    """Return the ratios of a law with internal state at a slip velocity."""
    table, row = law.table, law.row
    speed = size_of(velocity)
    if law.code == at.LUGRE:
        limit, _ = bristle_limit(law, speed)
        turned = plus(velocity, -speed / limit, state)
        bent = plus(scaled(table[row, BRISTLE_STIFFNESS], state), table[row, BRISTLE_DAMPING], turned)
        return plus(bent, table[row, BRISTLE_VISCOUS], velocity)
    if law.code == at.IN_SERIES:
        stiffness, damping = joint_of(law)
        return shortened(plus(scaled(stiffness, state), damping, velocity), sliding_ratio(law, speed))
    return scaled(state_ratio(law, state.a, speed), direction_of(velocity, ALONG_A))


@strict
def ratio_with_state(
    normal: Number, slips: Tangents, w: ComplianceInSpace, law: Law, before: BeforeInSpace, step: Number
) -> tuple[Tangents, ...]:
    """Return the ratios of forces over a step under a law with internal state, past parts, and the new states.

    As `slipping.ratio_with_state`.
    """
    was, last, earlier, state, past = before.status, before.slip, before.earlier_slip, before.state, before.past
    pull, moved = scaled_matrix(normal, of_tangents(w)), plus(slips, normal, by_normal(w))
    begun, drive, grows = scaled(0.5, plus(last, 1.0, moved)), plus(moved, -1.0, last), NOTHING
    elastic, pressed_now = law.code == at.IN_SERIES, max(normal, LEAST_FORCE)
    rises = next_normal(normal, before.normal) / pressed_now - 1.0 if elastic else 0.0
    if was == SEPARATED:
        past = scaled(0.5, ratio_of_state(law, state, over(begun, step)))
    elif before.normal > 0.0:
        # The force of a joint does not change with the normal force.
        share = 1.0 if elastic else changed_to(normal, before.normal) / before.normal
        dragged = times(scaled_matrix(share, of_tangents(w)), before.tangential)
        grows = plus(plus(drive, -1.0, plus(last, -1.0, earlier)), -1.0, dragged)
        past = scaled(before.normal / pressed_now, past) if elastic else past
    slip = plus(plus(begun, -1.0, times(pull, past)), -1.0 / 6.0, grows)
    squares = along(slip, slip) + along(drive, drive)
    pulled = 0.5 * (pull.aa + pull.bb)
    if squares > 0.0:
        pulled = (along(slip, times(pull, slip)) + along(drive, times(pull, drive))) / squares
    if elastic:
        count = parts_of_joint(pulled / pressed_now, size_of(last), before.normal, law)
    else:
        count = parts_with_state(size_of(slip), size_of(drive), pulled, law, step)
    size, later, rest, speed = 1.0 / count, NOTHING, NOTHING, size_of(slip) / step
    time, matrix = STAGE * size * step, scaled_matrix(STAGE * size / step, pull)
    for k in range(count):
        begin = k * size
        driven = plus(drive, begin, grows)
        free = plus(plus(slip, size * STAGE, driven), size * GROWTH_AT_STAGE * size, grows)
        risen = 1.0 + rises * (begin + STAGE * size)
        pressed = under(law, risen * normal) if elastic else law
        velocity, first = velocity_after(over(free, step), scaled_matrix(risen, matrix), speed, pressed, state, time)
        state, speed = state_between(pressed, state, velocity, first, time, size * step - time), size_of(velocity)
        first = scaled(risen, first)
        driven = plus(driven, 0.5 * size, grows)
        free = plus(plus(slip, size, driven), -size * (1.0 - STAGE), times(pull, first))
        risen = 1.0 + rises * (begin + size)
        pressed = under(law, risen * normal) if elastic else law
        velocity, second = velocity_after(over(free, step), scaled_matrix(risen, matrix), speed, pressed, state, time)
        state, speed = state_after(pressed, state, velocity, time), size_of(velocity)
        second = scaled(risen, second)
        more, less = stage_moments(begin, size, first, second)
        later, rest = plus(later, 1.0, more), plus(rest, 1.0, less)
        slip = scaled(step, velocity)
    if elastic:
        # As in the plane.
        most = max(sliding_ratio(law, size_of(last) / step), sliding_ratio(law, speed))
        most = max(most, sliding_ratio(law, size_of(begun) / step))
        return shortened(plus(past, 1.0, later), most), rest, state
    return plus(past, 1.0, later), rest, state
