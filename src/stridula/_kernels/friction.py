"""Laws of friction: the ratio of tangential to normal force at a slip velocity, and the motion of internal states.

Every function takes the code of the law, the parameters of all contacts and the number of one. Arrays are passed whole:
a view of a row would cost more than the computation.
"""

import math

from . import layout as at
from .compiled import strict, strict_pasted
from .lanes import Array, Number, Numbers, Pair
from .law_columns import (
    BRISTLE_DAMPING,
    BRISTLE_STIFFNESS,
    BRISTLE_VISCOUS,
    DIRECT,
    END,
    EVOLVING,
    EXPONENT,
    FLOOR,
    KINETIC,
    REFERENCE,
    REFERENCE_VELOCITY,
    SET_VALUED,
    SLIP_DISTANCE,
    SLOPE,
    STATIC,
    VELOCITY,
    VISCOUS,
)


@strict
def set_valued(law: int) -> bool:
    """Return whether a law sticks exactly."""
    return SET_VALUED[law]


@strict
def holding_ratio(law: int, laws: Array, i: int, was_sticking: bool) -> Number:
    """Return the ratio up to which a contact under a set-valued law is held."""
    if law == at.STATIC_KINETIC and not was_sticking:
        return laws[i, KINETIC]
    return laws[i, STATIC]


@strict
def sliding_ratio(law: int, laws: Array, i: int, speed: Number) -> Number:
    """Return the ratio of a set-valued law in sliding at `speed`."""
    if law == at.COULOMB:
        return laws[i, STATIC]
    if law == at.STATIC_KINETIC:
        return laws[i, KINETIC]
    if law == at.STRIBECK:
        return (
            laws[i, KINETIC]
            + (laws[i, STATIC] - laws[i, KINETIC]) * math.exp(-((speed / laws[i, VELOCITY]) ** laws[i, EXPONENT]))
            + laws[i, VISCOUS] * speed
        )
    return max(laws[i, STATIC] - laws[i, SLOPE] * speed, laws[i, FLOOR])


@strict
def speed_scale(law: int, laws: Array, i: int, state: Number) -> Number:
    """Return the slip speed above which the ratio of a law begins to bend."""
    if law == at.LINEAR_WEAKENING:
        return laws[i, END]
    if law == at.STRIBECK or law == at.LUGRE:
        return laws[i, VELOCITY]
    # a asinh(V / w): w = 2 V0 exp(-(reference + b ln(V0 theta / D)) / a), kept above the smallest numbers.
    return 2.0 * laws[i, REFERENCE_VELOCITY] * math.exp(-min(ageing(laws, i, state), 600.0))


@strict_pasted
def bristle_limit(laws: Array, i: int, speed: Number) -> Pair:
    """Return the deflection of LuGre's bristles in steady sliding at a speed, and its derivative by the speed."""
    weakened = (laws[i, STATIC] - laws[i, KINETIC]) * math.exp(-((speed / laws[i, VELOCITY]) ** 2))
    return (laws[i, KINETIC] + weakened) / laws[i, BRISTLE_STIFFNESS], -2.0 * speed / (
        laws[i, VELOCITY] * laws[i, VELOCITY]
    ) * weakened / laws[i, BRISTLE_STIFFNESS]


@strict_pasted
def bristles_over(laws: Array, i: int, speed: Number, step: Number) -> Numbers:
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
    limit, limit_slope = bristle_limit(laws, i, speed)
    passed = speed * step / limit
    passed_slope = step / limit * (1.0 - speed * limit_slope / limit)
    kept = math.exp(-passed)
    share = 1.0 - 0.5 * passed if passed < 1e-8 else -math.expm1(-passed) / passed
    share_slope = passed / 3.0 - 0.5 if passed < 1e-4 else (kept - share) / passed
    return kept, share, passed, passed_slope, share_slope


@strict
def next_state(law: int, laws: Array, i: int, state: Number, velocity: Number, step: Number) -> Number:
    """Return the internal state after a step at constant slip velocity, exactly."""
    speed = abs(velocity)
    if law == at.LUGRE:
        kept, share, _, _, _ = bristles_over(laws, i, speed, step)
        return state * kept + velocity * step * share
    turned = speed * step / laws[i, SLIP_DISTANCE]
    if law == at.AGING:
        share = 1.0 - 0.5 * turned if turned < 1e-8 else -math.expm1(-turned) / turned
        return state * math.exp(-turned) + step * share
    if turned == 0.0:
        return state
    age = speed * state / laws[i, SLIP_DISTANCE]
    return state * age ** math.expm1(-turned)


@strict
def state_ratio(law: int, laws: Array, i: int, state: Number, velocity: Number) -> Number:
    """Return the ratio of a law with internal state at a slip velocity."""
    speed = abs(velocity)
    if law == at.LUGRE:
        rate = velocity - speed * state / bristle_limit(laws, i, speed)[0]
        return (
            laws[i, BRISTLE_STIFFNESS] * state + laws[i, BRISTLE_DAMPING] * rate + laws[i, BRISTLE_VISCOUS] * velocity
        )
    if velocity == 0.0:
        return 0.0
    exponent = ageing(laws, i, state) + math.log(speed / (2.0 * laws[i, REFERENCE_VELOCITY]))
    ratio = exponent + math.log(2.0) if exponent > 30.0 else math.asinh(math.exp(exponent))
    return math.copysign(laws[i, DIRECT] * ratio, velocity)


@strict_pasted
def ageing(laws: Array, i: int, state: Number) -> Number:
    """Return the logarithm of the velocity of the law over that at which a contact of this state creeps."""
    return (
        laws[i, REFERENCE] + laws[i, EVOLVING] * math.log(laws[i, REFERENCE_VELOCITY] * state / laws[i, SLIP_DISTANCE])
    ) / laws[i, DIRECT]


@strict
def ratio_after(law: int, laws: Array, i: int, state: Number, velocity: Number, time: Number) -> Pair:
    """Return the ratio of a law with internal state after some time at a slip velocity, and its derivative by it."""
    speed = abs(velocity)
    if law == at.LUGRE:
        kept, share, _, by_speed, share_slope = bristles_over(laws, i, speed, time)
        sense = math.copysign(1.0, velocity)
        new = state * kept + velocity * time * share
        new_slope = -state * kept * sense * by_speed + time * (share + speed * share_slope * by_speed)
        limit, limit_slope = bristle_limit(laws, i, speed)
        bent = sense * new / limit
        rate_slope = 1.0 - bent - speed / limit * (new_slope - bent * limit_slope)
        ratio = (
            laws[i, BRISTLE_STIFFNESS] * new
            + laws[i, BRISTLE_DAMPING] * velocity * (1.0 - bent)
            + laws[i, BRISTLE_VISCOUS] * velocity
        )
        return ratio, laws[i, BRISTLE_STIFFNESS] * new_slope + laws[i, BRISTLE_DAMPING] * rate_slope + laws[
            i, BRISTLE_VISCOUS
        ]
    turned = speed * time / laws[i, SLIP_DISTANCE]
    new, new_slope = state, 0.0
    if law == at.AGING:
        kept = math.exp(-turned)
        share = 1.0 - 0.5 * turned if turned < 1e-8 else -math.expm1(-turned) / turned
        share_slope = turned / 3.0 - 0.5 if turned < 1e-4 else (kept - share) / turned
        new = state * kept + time * share
        new_slope = (time * share_slope - state * kept) * time / laws[i, SLIP_DISTANCE]
    elif turned > 0.0:
        kept, age = math.expm1(-turned), math.log(speed * state / laws[i, SLIP_DISTANCE])
        new = state * math.exp(age * kept)
        new_slope = new * (kept / speed - age * (kept + 1.0) * time / laws[i, SLIP_DISTANCE])
    if speed == 0.0:
        return 0.0, laws[i, DIRECT] * math.exp(min(ageing(laws, i, new), 600.0)) / (2.0 * laws[i, REFERENCE_VELOCITY])
    exponent = ageing(laws, i, new) + math.log(speed / (2.0 * laws[i, REFERENCE_VELOCITY]))
    argument = math.exp(min(exponent, 300.0))
    ratio = exponent + math.log(2.0) if exponent > 30.0 else math.asinh(argument)
    bent = argument / math.sqrt(1.0 + argument * argument)
    slope = laws[i, DIRECT] * bent * (1.0 / speed + laws[i, EVOLVING] / laws[i, DIRECT] * new_slope / new)
    return math.copysign(laws[i, DIRECT] * ratio, velocity), slope


@strict
def sticking_speed(law: int, laws: Array, i: int) -> Number:
    """Return the slip speed below which a law with internal state counts as sticking."""
    return laws[i, VELOCITY] if law == at.LUGRE else laws[i, REFERENCE_VELOCITY]
