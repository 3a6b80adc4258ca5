"""The slip velocity on its way through a step for contacts in space, as a vector of the tangent plane.

As in `slipping`, of which this is the vector form: ``u' = drive - P r`` with the matrix P of the tangents in place of
``pull``, and a ratio r along the slip. Motion along a line is the same to rounding.
"""

import math
from typing import Any

from ..lanes.compiled import strict, strict_pasted
from ..lanes.operations import Number, Numbers, Pair
from ..layout import columns as at
from ..layout.contact_values import BeforeInSpace, ComplianceInSpace, FreeInSpace, Law
from ..layout.laws import BRISTLE_DAMPING, BRISTLE_STIFFNESS, BRISTLE_VISCOUS
from .friction import (
    bristle_limit,
    bristles_over,
    holding_ratio,
    next_state,
    ratio_after,
    sliding_ratio,
    speed_scale,
    state_ratio,
)
from .slipping import (
    GROWTH_AT_STAGE,
    MOST_PARTS,
    SEPARATED,
    SLIDING,
    STAGE,
    STICKING,
    STOPPED,
    changed_to,
    moments,
    part_of,
    parts_with_state,
)
from .slipping import slide_through as slide_on_line

# Relative determinant of the matrix of the tangents below which it moves along one direction only.
SINGULAR = 1e-12
# Motion across a line that counts as rounding.
ROUNDING = 1e-9
# Most parts of a step in which the slip turns or stops.
MOST_TURNS = 16
# Trials of a search for a speed, and its relative accuracy.
TRIALS, SETTLED = 200, 1e-15
# A ratio that nothing holds.
BEYOND = 1e300


@strict_pasted
def plus(first: Pair, share: Number, second: Pair) -> Pair:
    """Return ``first + share second`` for vectors."""
    return first[0] + share * second[0], first[1] + share * second[1]


@strict_pasted
def times(matrix: Numbers, vector: Pair) -> Pair:
    """Return the product of a matrix, rows in turn, and a vector."""
    return matrix[0] * vector[0] + matrix[1] * vector[1], matrix[2] * vector[0] + matrix[3] * vector[1]


@strict_pasted
def along(vector: Pair, way: Pair) -> Number:
    """Return the component of a vector along a direction."""
    return vector[0] * way[0] + vector[1] * way[1]


@strict_pasted
def size_of(vector: Pair) -> Number:
    """Return the length of a vector."""
    return math.hypot(vector[0], vector[1])


@strict_pasted
def direction_of(vector: Pair, otherwise: Pair) -> Pair:
    """Return the direction of a vector, another one if it has none."""
    size = math.hypot(vector[0], vector[1])
    return (vector[0] / size, vector[1] / size) if size > 0.0 else otherwise


@strict_pasted
def scaled(matrix: Numbers, by: Number) -> Numbers:
    """Return a matrix times a number."""
    return by * matrix[0], by * matrix[1], by * matrix[2], by * matrix[3]


@strict_pasted
def moments_of(begin: Number, end: Number, first: Pair, middle: Pair, last: Pair) -> tuple[Pair, Pair]:
    """Do `slipping.moments` for vectors: the integrals with ``1 - s``, then those with ``s``."""
    one, other = moments(begin, end, first[0], middle[0], last[0]), moments(begin, end, first[1], middle[1], last[1])
    return (one[0], other[0]), (one[1], other[1])


@strict_pasted
def stage_moments(begin: Number, size: Number, first: Pair, second: Pair) -> tuple[Pair, Pair]:
    """Return the integrals of the ratio of two stages over a part, with the weights of this step and of the next.

    The mean of the slip over the part is that of its stages.
    """
    left = 1.0 - begin - size
    one, other = (1.0 - STAGE) * (2.0 * STAGE * size + left), STAGE * (STAGE * size + left)
    later = size * (one * first[0] + other * second[0]), size * (one * first[1] + other * second[1])
    one, other = 1.0 - STAGE - one, STAGE - other
    return later, (size * (one * first[0] + other * second[0]), size * (one * first[1] + other * second[1]))


@strict
def undone_by(matrix: Numbers, vector: Pair) -> Pair:
    """Return the force whose displacement under a compliance is a vector, beyond all bounds where there is none."""
    a, b, c, d = matrix
    determinant, trace = a * d - b * c, a + d
    if abs(determinant) > SINGULAR * trace * trace:
        return (d * vector[0] - b * vector[1]) / determinant, (a * vector[1] - c * vector[0]) / determinant
    size = size_of(vector)
    if size == 0.0:
        return 0.0, 0.0
    way = direction_of((a, c) if a >= d else (b, d), (1.0, 0.0))
    moved = along(vector, way)
    if trace > 0.0 and size_of(plus(vector, -moved, way)) <= ROUNDING * size:
        return way[0] * moved / trace, way[1] * moved / trace
    return BEYOND * vector[0] / size, BEYOND * vector[1] / size


@strict_pasted
def breaks_at(ratio: Pair, grows: Pair, held: Number) -> Number:
    """Return the share of a step after which a ratio that grows in a straight line from below `held` reaches it."""
    square, half = along(grows, grows), along(ratio, grows)
    missing = held * held - along(ratio, ratio)
    if missing <= 0.0 or square == 0.0:
        return 0.0 if missing <= 0.0 else 1.0
    root = math.sqrt(half * half + square * missing)
    return min(missing / (half + root) if half >= 0.0 else (root - half) / square, 1.0)


@strict
def slip_after(free: Pair, pull: Numbers, law: Law, step: Number) -> tuple[Pair, Pair]:
    """Return the slip ``u = free - pull r`` under a set-valued law, and its ratio: the secant method within a bracket.

    The ratio of incipient sliding brings it to rest.
    """
    needed, most = undone_by(pull, free), sliding_ratio(law, 0.0)
    asked = size_of(needed)
    if asked <= most:
        return (0.0, 0.0), needed
    # With (speed + ratio pull) way = free, the error is the length of 1 over that of the way, less one.
    low, low_error = 0.0, most / asked - 1.0
    high, high_error, side = size_of(free), 1.0, 0
    speed, ratio, way = high, most, free
    for _ in range(TRIALS):
        ratio = sliding_ratio(law, speed / step)
        stiff = speed + ratio * pull[0], ratio * pull[1], ratio * pull[2], speed + ratio * pull[3]
        way = undone_by(stiff, free)
        error = 1.0 / size_of(way) - 1.0
        if abs(error) <= SETTLED:
            break
        if error > 0.0:
            high, high_error = speed, error
            low_error = 0.5 * low_error if side > 0 else low_error
            side = 1
        else:
            low, low_error = speed, error
            high_error = 0.5 * high_error if side < 0 else high_error
            side = -1
        if high - low <= SETTLED * high:
            break
        speed = low - low_error * (high - low) / (high_error - low_error)
        if not low < speed < high:
            speed = 0.5 * (low + high)
    way = direction_of(way, (1.0, 0.0))
    return (speed * way[0], speed * way[1]), (ratio * way[0], ratio * way[1])


@strict_pasted
def is_straight(
    slip: Pair,
    drive: tuple[Pair, Pair],
    pull: Numbers,
    way: Pair,
) -> bool:
    """Return whether a slip stays on its line but for rounding."""
    dragged = times(pull, way)
    reach = size_of(slip) + size_of(drive[0]) + size_of(drive[1]) + size_of(dragged)
    across = -way[1], way[0]
    strays = abs(along(slip, across)) + abs(along(drive[0], across)) + abs(along(drive[1], across))
    return strays + abs(along(dragged, across)) <= ROUNDING * reach


@strict
def slide_straight(
    slip: Pair, begin: Number, drive: tuple[Pair, Pair], pull: Numbers, way: Pair, law: Law, step: Number
) -> tuple[Pair, Pair, Number]:
    """Slide along a line, as in the plane."""
    drives = along(drive[0], way), along(drive[1], way)
    pulled = along(way, times(pull, way))
    later, past, stuck = slide_on_line(along(slip, way), begin, drives, pulled, 1.0, law, step)
    return (later * way[0], later * way[1]), (past * way[0], past * way[1]), stuck


@strict
def hold_from(begin: Number, drive: tuple[Pair, Pair], pull: Numbers, held: Number) -> tuple[Pair, Pair, Number]:
    """Return the ratios that hold a contact at rest from a time of the step on, until it breaks away or the step ends.

    Returns
    -------
    later, past : tuple of float
        Integrals of the ratio, with the weights of this step and of the next.
    end : float
        Time at which it breaks away.
    """
    first = undone_by(pull, plus(drive[0], begin, drive[1]))
    if size_of(first) > held:
        return (0.0, 0.0), (0.0, 0.0), begin
    last = undone_by(pull, plus(drive[0], 1.0, drive[1]))
    grows = plus(last, -1.0, first)
    share = 1.0 if size_of(last) <= held else breaks_at(first, grows, held)
    end = begin + share * (1.0 - begin) if share < 1.0 else 1.0
    last = plus(first, share, grows)
    later, past = moments_of(begin, end, first, plus(first, 0.5 * share, grows), last)
    return later, past, end


@strict_pasted
def part_in_space(slip: Pair, drive: Pair, pull: Numbers, law: Law, step: Number) -> Number:
    """Return the size of the next part of the way: as `slipping.part_of`, and where the slip turns or ends, small."""
    speed = size_of(slip)
    if speed == 0.0:
        return 1.0 / MOST_TURNS
    friction, way = sliding_ratio(law, speed / step), (slip[0] / speed, slip[1] / speed)
    dragged = times(pull, way)
    rate = size_of(plus(drive, -friction, dragged))
    part = part_of(speed, rate, friction, along(way, dragged), law, step)
    return max(1.0 / (1.0 / part + rate / speed), min(part, 1.0 / MOST_TURNS))


@strict
def slide_through(
    slip: Pair, begin: Number, drive: tuple[Pair, Pair], pull: Numbers, way: Pair, law: Law, step: Number
) -> tuple[Pair, Pair, Number]:
    """Slide from a time of the step on, under a set-valued law.

    `drive` are its value at the beginning of the step and its change over it, `way` the direction if the slip is on a
    line. Each part takes the rule of two stages of laws with a state, which finds slip or rest in each; it is
    continuous where a slip turns about zero. Returns the same as `slipping.slide_through`.
    """
    if is_straight(slip, drive, pull, way):
        return slide_straight(slip, begin, drive, pull, way, law, step)
    later, past, held = (0.0, 0.0), (0.0, 0.0), holding_ratio(law, True)
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
        driven = plus(drive[0], begin, drive[1])
        size = min(part_in_space(slip, driven, pull, law, step), 1.0 - begin)
        matrix = scaled(pull, STAGE * size)
        free = plus(plus(slip, size * STAGE, driven), size * GROWTH_AT_STAGE * size, drive[1])
        _, first = slip_after(free, matrix, law, step)
        driven = plus(driven, 0.5 * size, drive[1])
        free = plus(plus(slip, size, driven), -size * (1.0 - STAGE), times(pull, first))
        slip, second = slip_after(free, matrix, law, step)
        more, less = stage_moments(begin, size, first, second)
        later, past, begin = plus(later, 1.0, more), plus(past, 1.0, less), begin + size
        rested = slip[0] == 0.0 and slip[1] == 0.0
    return later, past, 0.0


@strict
def ratio_of_stick(gap: Number, missed: Pair, w: ComplianceInSpace, otherwise: Pair) -> Pair:
    """Return the ratios of the forces that close the gap and undo both slips (5b), others if they pull."""
    pressed, first, second = sticking_forces(gap, missed, w)
    if not pressed > 0.0 or max(abs(first), abs(second)) >= 0.5 * BEYOND:
        return otherwise
    return first / pressed, second / pressed


@strict
def sticking_forces(gap: Number, slips: Pair, w: ComplianceInSpace) -> Numbers:
    """Return the forces that close `gap` and undo both slips (5b), beyond all bounds if no force moves a tangent."""
    tangents = (
        w.aa - w.an * w.na / w.nn,
        w.ab - w.an * w.nb / w.nn,
        w.ba - w.bn * w.na / w.nn,
        w.bb - w.bn * w.nb / w.nn,
    )
    first, second = undone_by(tangents, (slips[0] - w.an * gap / w.nn, slips[1] - w.bn * gap / w.nn))
    if max(abs(first), abs(second)) >= 0.5 * BEYOND:
        return -gap / w.nn, first, second
    return (w.na * first + w.nb * second - gap) / w.nn, first, second


@strict
def after_break(
    earlier: Pair,
    needed: Pair,
    driven: Pair,
    held: Number,
    drive: tuple[Pair, Pair],
    pull: Numbers,
    law: Law,
    step: Number,
) -> tuple[Any, ...]:
    """Slide on from a stick that broke within the last step; results as those of `ratio_over_step`."""
    grows = plus(needed, -1.0, earlier)
    broke = breaks_at(earlier, grows, held)
    sliding = sliding_ratio(law, 0.0)
    way = direction_of(plus(earlier, broke, grows) if broke > 0.0 else needed, (1.0, 0.0))
    friction = sliding * way[0], sliding * way[1]
    stuck, left, third = 0.5 * broke * broke, 0.5 * (1.0 - broke * broke), broke**3 / 3.0
    past = (
        stuck * earlier[0] + grows[0] * third + left * friction[0],
        stuck * earlier[1] + grows[1] * third + left * friction[1],
    )
    # Ratios without which it would have kept still, then those of the change of its normal force.
    free = plus(plus(earlier, -1.0, friction), 1.0, plus(driven, -1.0, needed))
    begun = plus(((1.0 / 3.0 - third) * drive[1][0], (1.0 / 3.0 - third) * drive[1][1]), left, times(pull, free))
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
    pull = normal * w.aa, normal * w.ab, normal * w.ba, normal * w.bb
    moved = slips[0] + w.an * normal, slips[1] + w.bn * normal
    held = holding_ratio(law, was == STICKING and free.let_go <= 0.5)
    missed = moved[0] + strays[0], moved[1] + strays[1]
    driven = undone_by(pull, missed)
    needed = driven if was == SLIDING else ratio_of_stick(gap, plus(slips, 1.0, strays), w, driven)
    asked = size_of(needed)
    if was == STICKING and last[0] == 0.0 and last[1] == 0.0:
        # At rest for a step or more: the force grows through the step as it did in the last one.
        share = 1.0 / before.normal if before.normal > 0.0 else 0.0
        earlier = (share * before.tangential[0], share * before.tangential[1]) if share > 0.0 else needed
        grows = plus(needed, -1.0, earlier)
        beyond = plus(needed, 1.0, grows)
        if free.let_go <= 0.5 and asked <= held and size_of(beyond) <= held:
            return needed, (0.5 * needed[0] + grows[0] / 3.0, 0.5 * needed[1] + grows[1] / 3.0), STICKING, 1.0
        drive = missed, times(pull, grows) if asked < BEYOND else (0.0, 0.0)
        if asked > held:
            return after_break(earlier, needed, driven, held, drive, pull, law, step)
        broke = breaks_at(needed, grows, held)
        at_break = plus(needed, broke, grows)
        way = direction_of(at_break, direction_of(beyond, (1.0, 0.0)))
        first, less = moments_of(0.0, broke, needed, plus(needed, 0.5 * broke, grows), at_break)
        more, rest, stuck = slide_through((0.0, 0.0), broke, drive, pull, way, law, step)
        ratio = plus(first, 1.0, more)
        ratio = ratio[0] + 0.5 * needed[0] - grows[0] / 6.0, ratio[1] + 0.5 * needed[1] - grows[1] / 6.0
        return ratio, plus(less, 1.0, rest), STOPPED if stuck > 0.0 else SLIDING, broke + stuck
    rests = needed, (0.5 * needed[0], 0.5 * needed[1]), STICKING, 1.0
    if was == STICKING:
        # It came to rest within the last step.
        if free.let_go <= 0.5 and 2.0 * size_of(plus(needed, -1.0, past)) <= held:
            return rests
        left = plus(missed, -1.0, times(pull, past))
        left = 2.0 * left[0], 2.0 * left[1]
        way = direction_of(left, (1.0, 0.0))
        more, rest, stuck = slide_through((0.0, 0.0), 0.0, (left, (0.0, 0.0)), pull, way, law, step)
        return plus(past, 1.0, more), rest, STOPPED if stuck > 0.0 else SLIDING, stuck
    begun = 0.5 * (last[0] + moved[0]), 0.5 * (last[1] + moved[1])
    change = moved[0] - last[0], moved[1] - last[1]
    if was != SLIDING:
        # It lands: half of its force acts before the step.
        if free.let_go <= 0.5 and asked <= held:
            return rests
        speed, way = size_of(begun), direction_of(begun, direction_of(change, (1.0, 0.0)))
        friction = 0.5 * sliding_ratio(law, speed / step)
        past = friction * way[0], friction * way[1]
    slip = plus(begun, -1.0, times(pull, past))
    way = direction_of(slip, direction_of(change, (1.0, 0.0)))
    more, rest, stuck = slide_through(slip, 0.0, (change, (0.0, 0.0)), pull, way, law, step)
    return plus(past, 1.0, more), rest, STOPPED if stuck > 0.0 else SLIDING, stuck


@strict_pasted
def friction_after(law: Law, state: Pair, speed: Number, time: Number) -> Pair:
    """Return the factors of the state and of the slip velocity in the ratio of a law with internal state after a time.

    Both depend on the speed alone; only LuGre's bristles contribute the first.
    """
    table, row = law.table, law.row
    if law.code == at.LUGRE:
        kept, share, _, _, _ = bristles_over(law, speed, time)
        felt = table[row, BRISTLE_STIFFNESS] - table[row, BRISTLE_DAMPING] * speed / bristle_limit(law, speed)[0]
        return felt * kept, felt * time * share + table[row, BRISTLE_DAMPING] + table[row, BRISTLE_VISCOUS]
    ratio, slope = ratio_after(law, state[0], speed, time)
    return 0.0, ratio / speed if speed > 0.0 else slope


@strict_pasted
def moved_at(speed: Number, free: Pair, pull: Numbers, law: Law, state: Pair, time: Number) -> tuple[Pair, Pair]:
    """Return the slip velocity that follows from an assumed speed, and the ratios."""
    holds, drags = friction_after(law, state, speed, time)
    kept = holds * state[0], holds * state[1]
    left = plus(free, -1.0, times(pull, kept))
    stiff = 1.0 + drags * pull[0], drags * pull[1], drags * pull[2], 1.0 + drags * pull[3]
    share = 1.0 / (stiff[0] * stiff[3] - stiff[1] * stiff[2])
    velocity = share * (stiff[3] * left[0] - stiff[1] * left[1]), share * (stiff[0] * left[1] - stiff[2] * left[0])
    return velocity, plus(kept, drags, velocity)


@strict
def velocity_after(free: Pair, pull: Numbers, guess: Number, law: Law, state: Pair, time: Number) -> tuple[Pair, Pair]:
    """Return the slip velocity ``v = free - pull r`` and the ratios of a law with internal state after some time.

    At a given speed the law is linear in the velocity; the speed sought is that which results, on the scale
    ``sinh(y)``, so that creep and sliding share one scale: the secant method within a bracket.
    """
    scale = speed_scale(law, state[0])
    velocity, ratio = moved_at(0.0, free, pull, law, state, time)
    speed = size_of(velocity)
    if speed == 0.0:
        return velocity, ratio
    # The error is the assumed speed relative to that which results, less one.
    low, low_error = 0.0, -1.0
    high = math.asinh((guess if guess > 0.0 else speed) / scale)
    high_error = 1.0
    for _ in range(TRIALS):
        speed = scale * math.sinh(high)
        velocity, ratio = moved_at(speed, free, pull, law, state, time)
        reached = size_of(velocity)
        if reached == 0.0:
            high_error = 1.0
            break
        high_error = speed / reached - 1.0
        if high_error >= 0.0:
            break
        low, low_error, high = high, high_error, max(1.5 * high, math.asinh(2.0 * speed / scale))
    side = 0
    for _ in range(TRIALS):
        if high_error == 0.0 or high - low <= SETTLED * high:
            break
        y = low - low_error * (high - low) / (high_error - low_error)
        if not low < y < high:
            y = 0.5 * (low + high)
            if not low < y < high:
                break
        speed = scale * math.sinh(y)
        velocity, ratio = moved_at(speed, free, pull, law, state, time)
        reached = size_of(velocity)
        error = speed / reached - 1.0 if reached > 0.0 else 1.0
        if abs(error) <= SETTLED:
            break
        if error > 0.0:
            high, high_error = y, error
            low_error = 0.5 * low_error if side > 0 else low_error
            side = 1
        else:
            low, low_error = y, error
            high_error = 0.5 * high_error if side < 0 else high_error
            side = -1
    return velocity, ratio


@strict_pasted
def state_after(law: Law, state: Pair, velocity: Pair, time: Number) -> Pair:
    """Return the internal states after some time at a constant slip velocity, exactly."""
    speed = size_of(velocity)
    if law.code == at.LUGRE:
        kept, share, _, _, _ = bristles_over(law, speed, time)
        taken = time * share
        return kept * state[0] + taken * velocity[0], kept * state[1] + taken * velocity[1]
    return next_state(law, state[0], speed, time), state[1]


@strict
def ratio_of_state(law: Law, state: Pair, velocity: Pair) -> Pair:
    """Return the ratios of a law with internal state at a slip velocity."""
    table, row = law.table, law.row
    speed = size_of(velocity)
    if law.code == at.LUGRE:
        turned = plus(velocity, -speed / bristle_limit(law, speed)[0], state)
        stiffness, damping, viscous = (
            table[row, BRISTLE_STIFFNESS],
            table[row, BRISTLE_DAMPING],
            table[row, BRISTLE_VISCOUS],
        )
        return (
            stiffness * state[0] + damping * turned[0] + viscous * velocity[0],
            stiffness * state[1] + damping * turned[1] + viscous * velocity[1],
        )
    ratio, way = state_ratio(law, state[0], speed), direction_of(velocity, (1.0, 0.0))
    return ratio * way[0], ratio * way[1]


@strict
def ratio_with_state(
    normal: Number, slips: Pair, w: ComplianceInSpace, law: Law, before: BeforeInSpace, step: Number
) -> tuple[Pair, ...]:
    """Return the ratios of forces over a step under a law with internal state, past parts, and the new states.

    As `slipping.ratio_with_state`.
    """
    was, last, earlier, state, past = before.status, before.slip, before.earlier_slip, before.state, before.past
    pull = normal * w.aa, normal * w.ab, normal * w.ba, normal * w.bb
    moved = slips[0] + w.an * normal, slips[1] + w.bn * normal
    begun, drive = (0.5 * (last[0] + moved[0]), 0.5 * (last[1] + moved[1])), plus(moved, -1.0, last)
    grows = 0.0, 0.0
    if was == SEPARATED:
        past = ratio_of_state(law, state, (begun[0] / step, begun[1] / step))
        past = 0.5 * past[0], 0.5 * past[1]
    elif before.normal > 0.0:
        share = changed_to(normal, before.normal)
        dragged = times((share * w.aa, share * w.ab, share * w.ba, share * w.bb), before.tangential)
        grows = (
            drive[0] - (last[0] - earlier[0]) - dragged[0] / before.normal,
            drive[1] - (last[1] - earlier[1]) - dragged[1] / before.normal,
        )
    slip = plus(plus(begun, -1.0, times(pull, past)), -1.0 / 6.0, grows)
    squares = along(slip, slip) + along(drive, drive)
    pulled = 0.5 * (pull[0] + pull[3])
    if squares > 0.0:
        pulled = (along(slip, times(pull, slip)) + along(drive, times(pull, drive))) / squares
    count = parts_with_state(size_of(slip), size_of(drive), pulled, law, step)
    size, later, rest, speed = 1.0 / count, (0.0, 0.0), (0.0, 0.0), size_of(slip) / step
    time, matrix = STAGE * size * step, scaled(pull, STAGE * size / step)
    for k in range(count):
        begin = k * size
        driven = plus(drive, begin, grows)
        free = plus(plus(slip, size * STAGE, driven), size * GROWTH_AT_STAGE * size, grows)
        free = free[0] / step, free[1] / step
        velocity, first = velocity_after(free, matrix, speed, law, state, time)
        state, speed = state_after(law, state, velocity, size * step - time), size_of(velocity)
        driven = plus(driven, 0.5 * size, grows)
        free = plus(plus(slip, size, driven), -size * (1.0 - STAGE), times(pull, first))
        free = free[0] / step, free[1] / step
        velocity, second = velocity_after(free, matrix, speed, law, state, time)
        state, speed = state_after(law, state, velocity, time), size_of(velocity)
        more, less = stage_moments(begin, size, first, second)
        later, rest = plus(later, 1.0, more), plus(rest, 1.0, less)
        slip = velocity[0] * step, velocity[1] * step
    return plus(past, 1.0, later), rest, state
