"""Laws of friction: the ratio of tangential to normal force at a slip velocity, and the motion of internal states.

Parameters are read from the table of all contacts: a view of a row would cost more than the computation.
"""

import math

from ..lanes.compiled import strict, strict_pasted
from ..lanes.operations import Number, Numbers, Pair
from ..layout import columns as at
from ..layout.contact_values import Law, Piece
from ..layout.laws import (
    BRISTLE_DAMPING,
    BRISTLE_STIFFNESS,
    BRISTLE_VISCOUS,
    DIRECT,
    END,
    END_SLOPE,
    EVOLVING,
    EXPONENT,
    FIRST_SPEED,
    FLOOR,
    JOINT_DAMPING,
    JOINT_STIFFNESS,
    KINETIC,
    ORDER,
    PIECES,
    REFERENCE,
    REFERENCE_VELOCITY,
    SECTIONS,
    SET_VALUED,
    SLIP_DISTANCE,
    SLOPE,
    STATIC,
    VELOCITY,
    VISCOUS,
)
from .pieces import piece_at

# Normal force that stands for none [N]; share of the limit of friction from which it is reached but for rounding.
LEAST_FORCE, FULL = 1e-200, 1.0 - 1e-9
# No speed is on it.
NO_PIECE = Piece(0.0, 0.0, 0)


@strict
def set_valued(code: int) -> bool:
    """Return whether the law of a code sticks exactly."""
    return SET_VALUED[code]


@strict_pasted
def under(law: Law, normal: Number) -> Law:
    """Return a law with the normal force at which its ratio is evaluated."""
    return Law(law.code, law.table, law.row, law.at_rest, normal)


@strict
def holding_ratio(law: Law, was_sticking: bool) -> Number:
    """Return the ratio up to which a contact under a set-valued law is held."""
    table, row = law.table, law.row
    if law.code == at.STATIC_KINETIC and not was_sticking:
        return table[row, KINETIC]
    if law.code == at.CURVE:
        return static_of_curve(law) if was_sticking else curve_at(law, 0.0)[0]
    return table[row, STATIC]


@strict
def sliding_ratio(law: Law, speed: Number) -> Number:
    """Return the ratio of a set-valued law in sliding at `speed`."""
    table, row = law.table, law.row
    if law.code == at.COULOMB:
        return table[row, STATIC]
    if law.code == at.STATIC_KINETIC:
        return table[row, KINETIC]
    if law.code == at.STRIBECK:
        share, exponent = speed / table[row, VELOCITY], table[row, EXPONENT]
        # A power of any exponent takes longer than all the rest.
        powered = share if exponent == 1.0 else (share * share if exponent == 2.0 else share**exponent)
        weakened = (table[row, STATIC] - table[row, KINETIC]) * math.exp(-powered)
        return table[row, KINETIC] + weakened + table[row, VISCOUS] * speed
    if law.code == at.CURVE or law.code == at.IN_SERIES:
        return curve_at(law, speed)[0]
    return max(table[row, STATIC] - table[row, SLOPE] * speed, table[row, FLOOR])


@strict
def section_of(law: Law) -> tuple[int, Number, int]:
    """Return the section of a curve below the normal force, the share of the next one, and where forces begin."""
    table, row = law.table, law.row
    pieces, order, sections = int(table[row, PIECES]), int(table[row, ORDER]), int(table[row, SECTIONS])
    forces = FIRST_SPEED + pieces + 1 + sections * (pieces + 1 + pieces * order)
    if sections == 1 or law.normal <= table[row, forces]:
        return 0, 0.0, forces
    for k in range(sections - 1):
        below, above = table[row, forces + k], table[row, forces + k + 1]
        if law.normal < above:
            return k, (law.normal - below) / (above - below), forces
    return sections - 1, 0.0, forces


@strict
def static_of_curve(law: Law) -> Number:
    """Return the ratio up to which a curve holds at rest under the normal force."""
    table, row = law.table, law.row
    if table[row, SECTIONS] == 1.0:
        return table[row, STATIC]
    section, share, forces = section_of(law)
    statics = forces + int(table[row, SECTIONS]) + section
    return (
        table[row, statics] if share == 0.0 else (1.0 - share) * table[row, statics] + share * table[row, statics + 1]
    )


@strict
def curve_at(law: Law, speed: Number) -> tuple[Number, Number, Number, Piece]:
    """Return the ratio of a curve at a speed, its slope, and the change of the speed over which it bends.

    Under a normal force between those of two sections it lies on the straight line between them. Else the last result
    is the piece on which it has this ratio, which `on_piece` evaluates.
    """
    if law.table[law.row, SECTIONS] == 1.0:
        return curve_of_section(law, 0, speed)
    section, share, _ = section_of(law)
    ratio, slope, bend, piece = curve_of_section(law, section, speed)
    if share == 0.0:
        return ratio, slope, bend, piece
    other, steeper, sharper, _ = curve_of_section(law, section + 1, speed)
    ratio, slope = (1.0 - share) * ratio + share * other, (1.0 - share) * slope + share * steeper
    return ratio, slope, min(bend, sharper), NO_PIECE


@strict_pasted
def on_piece(piece: Piece, law: Law, speed: Number) -> Number:
    """Return the ratio of a curve at a speed on a piece of it."""
    table, row = law.table, law.row
    order = int(table[row, ORDER])
    place = (speed - piece.begin) * (2.0 / (piece.end - piece.begin)) - 1.0
    # Two powers at a time, which wait for each other half as long.
    square, first, ratio = place * place, piece.first, 0.0
    for k in range(order - 2, -1, -2):
        ratio = ratio * square + (table[row, first + k + 1] * place + table[row, first + k])
    return ratio if order % 2 == 0 else ratio * place + table[row, first]


@strict
def curve_of_section(law: Law, section: int, speed: Number) -> tuple[Number, Number, Number, Piece]:
    """Do `curve_at` for a section."""
    table, row = law.table, law.row
    pieces, order = int(table[row, PIECES]), int(table[row, ORDER])
    low = piece_at(table, row, FIRST_SPEED, pieces, speed)
    begin, end = table[row, FIRST_SPEED + low], table[row, FIRST_SPEED + low + 1]
    farther, per_speed = speed - end, 2.0 / (end - begin)
    # From -1 to 1 over the piece.
    place = min((speed - begin) * per_speed - 1.0, 1.0)
    bends = FIRST_SPEED + pieces + 1 + section * (pieces + 1 + pieces * order)
    first = bends + pieces + 1 + low * order
    bends += low
    ratio, slope = table[row, first + order - 1], 0.0
    for k in range(order - 2, -1, -1):
        slope = slope * place + ratio
        ratio = ratio * place + table[row, first + k]
    share = 0.5 * (place + 1.0)
    bend = (1.0 - share) * table[row, bends] + share * table[row, bends + 1]
    if farther > 0.0:
        return ratio + table[row, END_SLOPE] * farther, table[row, END_SLOPE], bend + farther, NO_PIECE
    return ratio, slope * per_speed, bend, Piece(begin, end, first)


@strict_pasted
def next_normal(normal: Number, last: Number) -> Number:
    """Return the normal force at the next step if it goes on as from the last one; an impulse does not go on."""
    most = min(normal, last)
    return normal + min(max(normal - last, -most), most)


@strict
def holding_under(law: Law, normal: Number, held: Number) -> Number:
    """Return the ratio that holds at rest under another normal force, `held` if it does not depend on that."""
    if law.code != at.CURVE or law.table[law.row, SECTIONS] == 1.0:
        return held
    return static_of_curve(under(law, normal))


@strict
def changed_by_normal(law: Law, last_normal: Number, speed: Number) -> Number:
    """Return the ratio of a set-valued law in sliding, over that under the normal force of the last step."""
    if law.code != at.CURVE or law.table[law.row, SECTIONS] == 1.0:
        return 1.0
    before = curve_at(under(law, last_normal), speed)[0]
    return curve_at(law, speed)[0] / before if before > 0.0 else 1.0


@strict
def speed_scale(law: Law, state: Number) -> Number:
    """Return the slip speed above which the ratio of a law begins to bend."""
    table, row = law.table, law.row
    if law.code == at.LINEAR_WEAKENING:
        return table[row, END]
    if law.code == at.STRIBECK or law.code == at.LUGRE:
        return table[row, VELOCITY]
    if law.code == at.CURVE or law.code == at.IN_SERIES:
        return curve_at(law, 0.0)[2]
    # a asinh(V / w): w = 2 V0 exp(-(reference + b ln(V0 theta / D)) / a), kept above the smallest numbers.
    return 2.0 * table[row, REFERENCE_VELOCITY] * math.exp(-min(ageing(law, state), 600.0))


@strict_pasted
def joint_of(law: Law) -> Pair:
    """Return stiffness [1/m] and damping [s/m] of the joint in series with the friction, for its normal force."""
    normal = max(law.normal, LEAST_FORCE)
    return law.table[law.row, JOINT_STIFFNESS] / normal, law.table[law.row, JOINT_DAMPING] / normal


@strict_pasted
def deflected(law: Law, deflection: Number, ratio: Number, stage: Number, time: Number) -> Number:
    """Return the deflection of a joint after some time at its rate in a stage, which ends with a ratio."""
    stiffness, damping = joint_of(law)
    return deflection + time * (ratio - stiffness * deflection) / (stiffness * stage + damping)


@strict_pasted
def within(ratio: Number, most: Number) -> Number:
    """Return a ratio, or the limit that it exceeds."""
    return min(max(ratio, -most), most)


@strict_pasted
def bristle_limit(law: Law, speed: Number) -> Pair:
    """Return the deflection of LuGre's bristles in steady sliding at a speed, and its derivative by the speed."""
    table, row = law.table, law.row
    weakened = (table[row, STATIC] - table[row, KINETIC]) * math.exp(-((speed / table[row, VELOCITY]) ** 2))
    return (table[row, KINETIC] + weakened) / table[row, BRISTLE_STIFFNESS], -2.0 * speed / (
        table[row, VELOCITY] * table[row, VELOCITY]
    ) * weakened / table[row, BRISTLE_STIFFNESS]


@strict_pasted
def bristles_over(law: Law, speed: Number, step: Number) -> Numbers:
    """Return the motion of LuGre's bristles over a step at constant slip speed.

    Returns
    -------
    kept : float
        Share of their deflection that they keep.
    share : float
        Share of the slip that they take up.
    passed, passed_slope, share_slope : float
        Slip relative to the limit deflection, its derivative by the speed, and the derivative of `share` by it.
    """
    limit, limit_slope = bristle_limit(law, speed)
    passed = speed * step / limit
    passed_slope = step / limit * (1.0 - speed * limit_slope / limit)
    kept = math.exp(-passed)
    share = 1.0 - 0.5 * passed if passed < 1e-8 else -math.expm1(-passed) / passed
    share_slope = passed / 3.0 - 0.5 if passed < 1e-4 else (kept - share) / passed
    return kept, share, passed, passed_slope, share_slope


@strict
def next_state(law: Law, state: Number, velocity: Number, step: Number) -> Number:
    """Return the internal state after a step at constant slip velocity, exactly."""
    table, row = law.table, law.row
    speed = abs(velocity)
    if law.code == at.LUGRE:
        kept, share, _, _, _ = bristles_over(law, speed, step)
        return state * kept + velocity * step * share
    if law.code == at.IN_SERIES:
        return deflected(law, state, ratio_after(law, state, velocity, step)[0], step, step)
    turned = speed * step / table[row, SLIP_DISTANCE]
    if law.code == at.AGING:
        share = 1.0 - 0.5 * turned if turned < 1e-8 else -math.expm1(-turned) / turned
        return state * math.exp(-turned) + step * share
    if turned == 0.0:
        return state
    age = speed * state / table[row, SLIP_DISTANCE]
    return state * age ** math.expm1(-turned)


@strict
def state_ratio(law: Law, state: Number, velocity: Number) -> Number:
    """Return the ratio of a law with internal state at a slip velocity."""
    table, row = law.table, law.row
    speed = abs(velocity)
    if law.code == at.LUGRE:
        rate = velocity - speed * state / bristle_limit(law, speed)[0]
        return (
            table[row, BRISTLE_STIFFNESS] * state
            + table[row, BRISTLE_DAMPING] * rate
            + table[row, BRISTLE_VISCOUS] * velocity
        )
    if law.code == at.IN_SERIES:
        stiffness, damping = joint_of(law)
        return within(stiffness * state + damping * velocity, sliding_ratio(law, speed))
    if velocity == 0.0:
        return 0.0
    exponent = ageing(law, state) + math.log(speed / (2.0 * table[row, REFERENCE_VELOCITY]))
    ratio = exponent + math.log(2.0) if exponent > 30.0 else math.asinh(math.exp(exponent))
    return math.copysign(table[row, DIRECT] * ratio, velocity)


@strict_pasted
def ageing(law: Law, state: Number) -> Number:
    """Return the logarithm of the velocity of the law over that at which a contact of this state creeps."""
    table, row = law.table, law.row
    return (
        table[row, REFERENCE]
        + table[row, EVOLVING] * math.log(table[row, REFERENCE_VELOCITY] * state / table[row, SLIP_DISTANCE])
    ) / table[row, DIRECT]


@strict
def ratio_after(law: Law, state: Number, velocity: Number, time: Number) -> Pair:
    """Return the ratio of a law with internal state after some time at a slip velocity, and its derivative by it."""
    table, row = law.table, law.row
    speed = abs(velocity)
    if law.code == at.LUGRE:
        kept, share, _, by_speed, share_slope = bristles_over(law, speed, time)
        sense = math.copysign(1.0, velocity)
        new = state * kept + velocity * time * share
        new_slope = -state * kept * sense * by_speed + time * (share + speed * share_slope * by_speed)
        limit, limit_slope = bristle_limit(law, speed)
        bent = sense * new / limit
        rate_slope = 1.0 - bent - speed / limit * (new_slope - bent * limit_slope)
        ratio = (
            table[row, BRISTLE_STIFFNESS] * new
            + table[row, BRISTLE_DAMPING] * velocity * (1.0 - bent)
            + table[row, BRISTLE_VISCOUS] * velocity
        )
        return ratio, table[row, BRISTLE_STIFFNESS] * new_slope + table[row, BRISTLE_DAMPING] * rate_slope + table[
            row, BRISTLE_VISCOUS
        ]
    if law.code == at.IN_SERIES:
        stiffness, damping = joint_of(law)
        firm, (most, slope, _, _) = stiffness * time + damping, curve_at(law, speed)
        ratio = stiffness * state + firm * velocity
        if abs(ratio) <= most:
            return ratio, firm
        return math.copysign(most, ratio), slope * math.copysign(1.0, ratio) * math.copysign(1.0, velocity)
    turned = speed * time / table[row, SLIP_DISTANCE]
    new, new_slope = state, 0.0
    if law.code == at.AGING:
        kept = math.exp(-turned)
        share = 1.0 - 0.5 * turned if turned < 1e-8 else -math.expm1(-turned) / turned
        share_slope = turned / 3.0 - 0.5 if turned < 1e-4 else (kept - share) / turned
        new = state * kept + time * share
        new_slope = (time * share_slope - state * kept) * time / table[row, SLIP_DISTANCE]
    elif turned > 0.0:
        kept, age = math.expm1(-turned), math.log(speed * state / table[row, SLIP_DISTANCE])
        new = state * math.exp(age * kept)
        new_slope = new * (kept / speed - age * (kept + 1.0) * time / table[row, SLIP_DISTANCE])
    if speed == 0.0:
        return 0.0, table[row, DIRECT] * math.exp(min(ageing(law, new), 600.0)) / (2.0 * table[row, REFERENCE_VELOCITY])
    exponent = ageing(law, new) + math.log(speed / (2.0 * table[row, REFERENCE_VELOCITY]))
    argument = math.exp(min(exponent, 300.0))
    ratio = exponent + math.log(2.0) if exponent > 30.0 else math.asinh(argument)
    bent = argument / math.sqrt(1.0 + argument * argument)
    slope = table[row, DIRECT] * bent * (1.0 / speed + table[row, EVOLVING] / table[row, DIRECT] * new_slope / new)
    return math.copysign(table[row, DIRECT] * ratio, velocity), slope


@strict
def sticking_speed(law: Law) -> Number:
    """Return the slip speed below which a law with internal state counts as sticking, without a joint."""
    table, row = law.table, law.row
    return table[row, VELOCITY] if law.code == at.LUGRE else table[row, REFERENCE_VELOCITY]


@strict
def joint_holds(law: Law, speed: Number, felt: Number) -> bool:
    """Return whether a contact in series with a joint sticks, at a slip speed: the ratio `felt` of its joint alone."""
    return felt < FULL * sliding_ratio(law, speed)
