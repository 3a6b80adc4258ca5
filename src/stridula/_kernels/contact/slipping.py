"""Step 5c for laws whose friction changes within a step: the slip velocity on its way through the step.

The tangential force of step n is the mean over the two steps about it, weighted by a triangle, which moves a mass
exactly. Its second half lies on the way from n to n + 1, which the slip takes under its own friction: stops, reversals
and starts lie where they are on it, and only one solution exists however steeply a law falls. The first half was found
on the way before; a contact carries it as its `past` ratio. Times s are shares of the step, velocities are slips ``u``
in a step: ``u' = drive - pull r`` with the ratio r of the forces, ``pull`` the slip for a ratio of one in a step.
"""

import math

from ..lanes.compiled import strict, strict_pasted
from ..lanes.operations import Number, Numbers, Pair
from ..layout import columns as at
from ..layout.contact_values import Before, Compliance, Drive, Free, Law, Piece
from ..layout.laws import (
    BRISTLE_STIFFNESS,
    FLOOR,
    JOINT_STIFFNESS,
    KINETIC,
    SLIP_DISTANCE,
    SLOPE,
    STATIC,
    VELOCITY,
    VISCOUS,
)
from .friction import (
    LEAST_FORCE,
    NO_PIECE,
    changed_by_normal,
    curve_at,
    deflected,
    holding_ratio,
    holding_under,
    next_normal,
    next_state,
    on_piece,
    ratio_after,
    sliding_ratio,
    speed_scale,
    state_ratio,
    under,
    within,
)

# A contact that stopped slid in this step and is at rest at its end: the next step finds it sticking.
SEPARATED, STICKING, SLIDING, STOPPED = 0, 1, 2, 3
# Most parts into which the way through a step is divided, and reversals on it.
MOST_PARTS, REVERSALS = 64, 3
# Bend of the law in a part; phase of bristles in a part; ageing in a part.
PART, PHASE, AGEING = 0.5, 0.25, 1.0
# Bend that is added to that of a part: a way that bends by less than a tenth has one part.
LEAST_BEND = 0.4
# Most deflections of a joint that divide the slip of a step; where it passes more, the joint hardly matters.
REACHES = 8.0
# First stage of the implicit rule, as a share of a part.
STAGE = 1.0 - math.sqrt(0.5)
# What the growth of the drive adds to the slip of that stage, so that the mean of the stages is that of the drive.
GROWTH_AT_STAGE = (1.0 / 6.0 - 0.5 * STAGE) / (1.0 - STAGE)
# Steps of Newton's method and trials of a bracketed search for the velocity of a part, and their relative accuracy.
NEWTON, TRIALS, SETTLED = 8, 200, 1e-13


@strict_pasted
def moments(begin: Number, end: Number, first: Number, middle: Number, last: Number) -> Pair:
    """Return the integrals of a ratio over a part with the weights ``1 - s`` and ``s``, by Simpson's rule."""
    half, size = 0.5 * (begin + end), (end - begin) / 6.0
    later = size * ((1.0 - begin) * first + 4.0 * (1.0 - half) * middle + (1.0 - end) * last)
    return later, size * (begin * first + 4.0 * half * middle + end * last)


@strict_pasted
def ratio_of(slip: Number, sense: Number, law: Law, step: Number) -> Number:
    """Return the signed ratio of a set-valued law at a slip, that of incipient sliding if it is against the sense."""
    return sense * sliding_ratio(law, max(sense * slip, 0.0) / step)


@strict_pasted
def ratio_near(piece: Piece, slip: Number, sense: Number, law: Law, per_step: Number) -> Number:
    """Do `ratio_of`, for curves sooner if the slip speed lies on a piece."""
    speed = max(sense * slip, 0.0) * per_step
    if piece.begin <= speed < piece.end:
        return sense * on_piece(piece, law, speed)
    return sense * sliding_ratio(law, speed)


@strict_pasted
def ratio_and_bend(
    slip: Number, sense: Number, pull: Number, law: Law, step: Number
) -> tuple[Number, Number, Number, Piece]:
    """Return the signed ratio of a set-valued law at a slip, how it bends with the slip, and its change under a pull.

    The last result is the piece of a curve on which it is.
    """
    table, row, size = law.table, law.row, max(sense * slip, 0.0)
    if law.code == at.CURVE:
        ratio, slope, bend, piece = curve_at(law, size / step)
        return sense * ratio, 1.0 / (bend * step), pull * abs(slope) / step, piece
    ratio = sliding_ratio(law, size / step)
    if law.code == at.STATIC_KINETIC:
        return sense * ratio, 0.0, 0.0, NO_PIECE
    scale = speed_scale(law, 0.0) * step
    if law.code == at.LINEAR_WEAKENING:
        steep = table[row, SLOPE] / step if ratio > table[row, FLOOR] else 0.0
    else:
        viscous = table[row, VISCOUS] / step
        steep = (ratio - table[row, KINETIC] - viscous * size) / scale + viscous
    return sense * ratio, 1.0 / (scale + size), pull * steep, NO_PIECE


@strict_pasted
def part_of(rate: Number, per_slip: Number, steep: Number) -> Number:
    """Return the size of the next part of the way, within which the ratio of a set-valued law hardly bends.

    It depends continuously on its arguments, so that the solution does on those of the step.
    """
    return min(max(PART / (abs(rate) * per_slip + steep + LEAST_BEND), 1.0 / MOST_PARTS), 1.0)


@strict
def slide_through(
    slip: Number, begin: Number, drive: Drive, pull: Number, sense: Number, law: Law, step: Number
) -> Numbers:
    """Slide from a time of the step on, under a set-valued law.

    `drive` are its value at the beginning of the step and its change over it.

    Returns
    -------
    later, past : float
        Ratio of the rest of the step, weighted for this step and for the next.
    stuck : float
        Share of the step for which the contact is at rest at its end.
    """
    later, past, per_step = 0.0, 0.0, 1.0 / step
    for _ in range(REVERSALS):
        stops = False
        while begin < 1.0:
            r1, per_slip, steep, piece = ratio_and_bend(slip, sense, pull, law, step)
            rate = drive.begin + drive.grows * begin - pull * r1
            end = min(begin + part_of(rate, per_slip, steep), 1.0)
            size = end - begin
            middle = drive.begin + drive.grows * (begin + 0.5 * size)
            r2 = ratio_near(piece, slip + 0.5 * size * rate, sense, law, per_step)
            r3 = ratio_near(piece, slip + 0.5 * size * (middle - pull * r2), sense, law, per_step)
            r4 = ratio_near(piece, slip + size * (middle - pull * r3), sense, law, per_step)
            new = slip + size * (middle - pull * (r1 + 2.0 * (r2 + r3) + r4) / 6.0)
            if sense * new < 0.0:
                # It stops on the parabola with this beginning, slope and end.
                bent = (new - slip - rate * size) / (size * size)
                under = math.sqrt(max(rate * rate - 4.0 * bent * slip, 0.0))
                after = -2.0 * slip / (rate - sense * under) if slip != 0.0 else 0.0
                after = min(max(after, 0.0), size)
                half = slip + 0.5 * after * (rate + 0.5 * after * bent)
                at_half, at_end = ratio_of(half, sense, law, step), ratio_of(0.0, sense, law, step)
                more, less = moments(begin, begin + after, r1, at_half, at_end)
                later, past, begin, stops = later + more, past + less, begin + after, True
                break
            more, less = moments(begin, end, r1, 0.5 * (r2 + r3), r4)
            later, past, begin, slip = later + more, past + less, end, new
        if not stops:
            return later, past, 0.0
        held = holding_ratio(law, True)
        first, last = drive.begin + drive.grows * begin, drive.begin + drive.grows
        if max(abs(first), abs(last)) <= held * pull and pull > 0.0:
            more, less = moments(begin, 1.0, first / pull, 0.5 * (first + last) / pull, last / pull)
            return later + more, past + less, 1.0 - begin
        if abs(first) <= held * pull:
            # It is held until its drive has grown.
            end = begin + (1.0 - begin) * (math.copysign(held * pull, last) - first) / (last - first)
            at_end = math.copysign(held, last)
            more, less = moments(begin, end, first / pull, 0.5 * (first / pull + at_end), at_end)
            later, past, begin, first = later + more, past + less, end, last
        slip, sense = 0.0, 1.0 if first > 0.0 else -1.0
    return later, past, 0.0


@strict_pasted
def breaks_at(ratio: Number, grows: Number, held: Number, held_grows: Number, sense: Number) -> Number:
    """Return the share of a step after which a ratio that grows in a straight line reaches a limit that does so."""
    nearer = sense * grows - held_grows
    return min(max((held - sense * ratio) / nearer, 0.0), 1.0) if nearer != 0.0 else 0.0


@strict_pasted
def broken_before(
    earlier: float, grows: float, broke: Number, sliding: float, sense: Number
) -> tuple[float, float, float]:
    """Return the past part of the ratio of a stick that broke within the last step, and its slip for a pull of one.

    The ratio grew from `earlier` until it `broke` and has been that of `sliding` since. The last value is the share of
    the last step that slid, weighted.
    """
    stuck, left = 0.5 * broke * broke, 0.5 * (1.0 - broke * broke)
    past = stuck * earlier + grows * broke**3 / 3.0 + left * sense * sliding
    return past, grows * (1.0 - broke**3) / 3.0 + left * (earlier - sense * sliding), left


@strict_pasted
def ratio_of_stick(gap: Number, missed: Number, w: Compliance, otherwise: Number) -> Number:
    """Return the ratio of the forces that close the gap and undo a slip, another one if they pull."""
    pressed, held = w.nt * missed - w.tt * gap, w.nn * missed - w.tn * gap
    return held / pressed if pressed * (w.nn * w.tt - w.nt * w.tn) > 0.0 else otherwise


@strict_pasted
def beyond_hold(slip: Number, ratio: Number, held: Number) -> Number:
    """Return the share of a slip that remains of its ratio beyond the one that holds."""
    return slip * (1.0 - held / ratio) if ratio > held else 0.0


@strict
def ratio_over_step(
    normal: Number, free: Free, law: Law, before: Before, step: Number
) -> tuple[Number, Number, int, Number]:
    """Return the ratio of forces over a step under a set-valued law, its past part, status and share of stick.

    `normal` is the normal force, `gap` and `slip` those without the forces of this contact; other arguments as in
    `exact.solve_contact`. A contact that sticks does so throughout the step. Whether it does, and when it breaks,
    follows from the forces with which it would stick; what it is driven by after that from its normal force.
    """
    gap, slip, strayed, w = free.gap, free.slip, free.strayed, free.w
    was, last, past = before.status, before.slip, before.past
    pull, moved = w.tt * normal, slip + w.tn * normal
    held = 0.0 if was == SLIDING else holding_ratio(law, was == STICKING and free.let_go <= 0.5)
    driven = (moved + strayed) / pull if pull > 0.0 else math.copysign(math.inf, moved + strayed)
    needed = driven if was == SLIDING else ratio_of_stick(gap, slip + strayed, w, driven)
    if was == STICKING and last == 0.0:
        # At rest for a step or more: the force grows through the step as it did in the last one, from the ratio that
        # held it there, twice its past part.
        earlier = 2.0 * past if before.normal > 0.0 else needed
        grows = needed - earlier
        held_later = holding_under(law, next_normal(normal, before.normal), held)
        if free.let_go <= 0.5 and abs(needed) <= held and abs(needed + grows) <= held_later:
            return needed, 0.5 * needed, STICKING, 1.0
        drive = Drive(pull * driven, pull * grows)
        if abs(needed) > held:
            sense = 1.0 if needed > 0.0 else -1.0
            slides = sense * ratio_of(0.0, sense, law, step)
            held_before = holding_under(law, before.normal, held)
            broke = breaks_at(earlier, grows, held_before, held - held_before, sense)
            past, begun, left = broken_before(earlier, grows, broke, slides, sense)
            begun += left * (driven - needed)
            more, rest, stuck = slide_through(pull * begun, 0.0, drive, pull, sense, law, step)
            return past + more, rest, STOPPED if stuck > 0.0 else SLIDING, stuck
        sense = 1.0 if needed + grows > 0.0 else -1.0
        broke = breaks_at(needed, grows, held, held_later - held, sense)
        first, less = moments(0.0, broke, needed, needed + 0.5 * broke * grows, needed + broke * grows)
        more, rest, stuck = slide_through(0.0, broke, drive, pull, sense, law, step)
        ratio = 0.5 * needed - grows / 6.0 + first + more
        return ratio, less + rest, STOPPED if stuck > 0.0 else SLIDING, broke + stuck
    if was == STICKING:
        # It came to rest within the last step.
        short = 2.0 * (needed - past)
        if free.let_go <= 0.5 and abs(short) <= held:
            return needed, 0.5 * short, STICKING, 1.0
        # What cannot be held has the slip that this normal force leaves it, at most as much as what exceeds the hold.
        left = 2.0 * pull * (driven - past)
        slip_at_step = within(0.5 * (last + moved + strayed) - pull * past, beyond_hold(abs(left), abs(short), held))
        sense = 1.0 if slip_at_step > 0.0 or (slip_at_step == 0.0 and short > 0.0) else -1.0
        drive = Drive(left - 2.0 * slip_at_step, 0.0)
        more, rest, stuck = slide_through(slip_at_step, 0.0, drive, pull, sense, law, step)
        return past + more, rest, STOPPED if stuck > 0.0 else SLIDING, stuck
    begun = 0.5 * (last + moved)
    if was == SLIDING:
        past *= changed_by_normal(law, before.normal, abs(last) / step)
    else:
        # It lands: half of its force acts before the step.
        if free.let_go <= 0.5 and abs(needed) <= held:
            return needed, 0.5 * needed, STICKING, 1.0
        sense = 1.0 if begun > 0.0 else -1.0
        past = 0.5 * ratio_of(begun, sense, law, step)
    slip_at_step, change = begun - pull * past, moved - last
    sense = 1.0 if slip_at_step > 0.0 or (slip_at_step == 0.0 and change > 0.0) else -1.0
    more, rest, stuck = slide_through(slip_at_step, 0.0, Drive(change, 0.0), pull, sense, law, step)
    return past + more, rest, STOPPED if stuck > 0.0 else SLIDING, stuck


@strict
def velocity_after(free: Number, pulled: Number, guess: Number, law: Law, state: Number, time: Number) -> Pair:
    """Return the slip velocity ``v = free - pulled r`` and the ratio r of a law with internal state after some time.

    Newton's method from a guess, then a bracketed search on the scale ``sinh(y)``, so that creep and sliding share one
    scale.
    """
    velocity = guess
    for _ in range(NEWTON):
        ratio, slope = ratio_after(law, state, velocity, time)
        steepness = 1.0 + pulled * slope
        if not steepness > 0.0:
            break
        change = (free - pulled * ratio - velocity) / steepness
        if abs(change) <= SETTLED * abs(velocity + change):
            return velocity + change, ratio + slope * change
        if law.code != at.LUGRE and velocity * (velocity + change) <= 0.01 * velocity * velocity:
            break
        velocity += change
    sense = 1.0 if free - pulled * ratio_after(law, state, 0.0, time)[0] >= 0.0 else -1.0
    scale, reach = speed_scale(law, state), max(abs(free), 1e-300)
    low, high = 0.0, 0.0
    for _ in range(TRIALS):
        velocity = sense * reach
        high = math.asinh(reach / scale)
        if sense * (velocity - free + pulled * ratio_after(law, state, velocity, time)[0]) >= 0.0:
            break
        low, reach = high, 2.0 * reach
    for _ in range(TRIALS):
        if high - low <= 1e-15 * high:
            break
        y = 0.5 * (low + high)
        velocity = sense * scale * math.sinh(y)
        if sense * (velocity - free + pulled * ratio_after(law, state, velocity, time)[0]) >= 0.0:
            high = y
        else:
            low = y
    velocity = sense * scale * math.sinh(0.5 * (low + high))
    return velocity, ratio_after(law, state, velocity, time)[0]


@strict
def parts_with_state(slip: Number, drive: Number, pull: Number, law: Law, step: Number) -> int:
    """Return the number of parts of the way under a law with internal state."""
    table, row = law.table, law.row
    if law.code == at.LUGRE:
        change = (abs(drive) + pull * table[row, STATIC]) / (4.0 * table[row, VELOCITY] * step)
        count = 1.0 + max(math.sqrt(pull * table[row, BRISTLE_STIFFNESS]) / PHASE, change)
    else:
        count = 2.0 + (abs(slip) + abs(drive)) / (AGEING * table[row, SLIP_DISTANCE])
    return int(min(count, float(MOST_PARTS)))


@strict
def parts_of_joint(softness: Number, last_slip: Number, last_normal: Number, law: Law) -> int:
    """Return the number of parts of the way of a contact in series with a joint, for a compliance of the bodies.

    It does not depend on the forces sought, which it would otherwise change by jumps.
    """
    stiffness = law.table[law.row, JOINT_STIFFNESS]
    limit = max(sliding_ratio(law, 0.0) * last_normal, LEAST_FORCE)
    passed = 2.0 * last_slip * stiffness / limit
    if passed > REACHES:
        passed = REACHES * REACHES / passed
    count = 1.0 + max(math.sqrt(softness * stiffness) / PHASE, passed)
    return int(min(count, float(MOST_PARTS)))


@strict_pasted
def changed_to(normal: Number, last: Number) -> Number:
    """Return the normal force that the friction of the last step is taken to have changed to in this one.

    A change that goes on is part of the growth of the drive; an impulse would not go on, so that a change counts for at
    most the smaller of both forces.
    """
    most = min(normal, last)
    return min(max(normal, last - most), last + most)


@strict
def ratio_with_state(normal: Number, slip: Number, w: Compliance, law: Law, before: Before, step: Number) -> Numbers:
    """Return the ratio of forces over a step under a law with internal state, its past part, and the new state.

    Each part takes the diagonally implicit rule of two stages and second order that forgets what a stiff contact would
    not keep: a contact that creeps takes its velocity from its friction, whatever its last one was. The drive goes on
    through the step as it changed in the last one, in which it was the change of the slip and the ratio: a law whose
    velocity depends on the logarithm of the force would notice its jumps.
    """
    was, last, state, past = before.status, before.slip, before.state, before.past
    pull, moved = w.tt * normal, slip + w.tn * normal
    begun, drive, grows = 0.5 * (last + moved), moved - last, 0.0
    elastic, pressed_now = law.code == at.IN_SERIES, max(normal, LEAST_FORCE)
    # Within the step the limit of a joint changes with the normal force, by this share of it.
    rises = next_normal(normal, before.normal) / pressed_now - 1.0 if elastic else 0.0
    if was == SEPARATED:
        past = 0.5 * state_ratio(law, state, begun / step)
    elif before.normal > 0.0:
        # The force of a joint does not change with the normal force.
        share = 1.0 if elastic else changed_to(normal, before.normal) / before.normal
        grows = drive - (last - before.earlier_slip) - w.tt * share * before.tangential
        past = past * before.normal / pressed_now if elastic else past
    slip_now = begun - pull * past - grows / 6.0
    if elastic:
        count = parts_of_joint(w.tt, abs(last), before.normal, law)
    else:
        count = parts_with_state(slip_now, drive, pull, law, step)
    size, later, rest, velocity = 1.0 / count, 0.0, 0.0, slip_now / step
    time, pulled = STAGE * size * step, STAGE * size * pull / step
    for k in range(count):
        begin, left = k * size, 1.0 - (k + 1.0) * size
        driven = drive + grows * begin
        free = slip_now + size * (STAGE * driven + GROWTH_AT_STAGE * size * grows)
        risen = 1.0 + rises * (begin + STAGE * size)
        pressed = under(law, risen * normal) if elastic else law
        velocity, first = velocity_after(free / step, pulled * risen, velocity, pressed, state, time)
        rest_of_part = size * step - time
        if elastic:
            state = deflected(pressed, state, first, time, rest_of_part)
            first *= risen
        else:
            state = next_state(law, state, velocity, rest_of_part)
        free = slip_now + size * (driven + 0.5 * size * grows - (1.0 - STAGE) * pull * first)
        risen = 1.0 + rises * (begin + size)
        pressed = under(law, risen * normal) if elastic else law
        velocity, second = velocity_after(free / step, pulled * risen, velocity, pressed, state, time)
        state, second = next_state(pressed, state, velocity, time), second * risen
        # Weights with which the mean of the slip over the part is that of its stages.
        more = (1.0 - STAGE) * (2.0 * STAGE * size + left) * first + STAGE * (STAGE * size + left) * second
        later, rest = later + size * more, rest + size * ((1.0 - STAGE) * first + STAGE * second - more)
        slip_now = velocity * step
    if elastic:
        # Friction that changes with the speed had its limit at the last slip, too.
        most = max(sliding_ratio(law, abs(last) / step), sliding_ratio(law, abs(velocity)))
        most = max(most, sliding_ratio(law, abs(begun) / step))
        return within(past + later, most), rest, state
    return past + later, rest, state
