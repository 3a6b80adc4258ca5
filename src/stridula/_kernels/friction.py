"""Laws of friction: the ratio of tangential to normal force at a slip velocity, and the motion of internal states.

Every function takes the code of the law, the parameters of all contacts and the number of one. Arrays come whole: a
view of a row costs more than what is done with it.
"""

import math
from typing import Any

import numba

from . import layout as at

# Said out loud: else a function compiled for the general march inherits its leave to add in another order, and rounds
# the distance from an anchor, slip + (material - anchor), as if it were one of abscissas.
STRICT: dict[str, Any] = {"cache": True, "fastmath": False, "error_model": "numpy"}


@numba.njit(**STRICT)
def set_valued(law):
    """Return whether a law sticks exactly."""
    return law <= at.LINEAR_WEAKENING


@numba.njit(**STRICT)
def holding_ratio(law, laws, i, was_sticking):
    """Return the ratio up to which a contact under a set-valued law is held."""
    if law == at.STATIC_KINETIC and not was_sticking:
        return laws[i, 1]
    return laws[i, 0]


@numba.njit(**STRICT)
def sliding_ratio(law, laws, i, speed):
    """Return the ratio of a set-valued law in sliding at `speed`."""
    if law == at.COULOMB:
        return laws[i, 0]
    if law == at.STATIC_KINETIC:
        return laws[i, 1]
    if law == at.STRIBECK:
        return (
            laws[i, 1]
            + (laws[i, 0] - laws[i, 1]) * math.exp(-((speed / laws[i, 2]) ** laws[i, 3]))
            + laws[i, 4] * speed
        )
    return max(laws[i, 0] - laws[i, 1] * speed, laws[i, 2])


@numba.njit(**STRICT)
def ratio_and_slope(law, laws, i, speed):
    """Return the ratio of a law that depends on the slip speed, above zero, and its derivative [s/m]."""
    if law == at.LINEAR_WEAKENING:
        ratio = laws[i, 0] - laws[i, 1] * speed
        return (ratio, -laws[i, 1]) if ratio > laws[i, 2] else (laws[i, 2], 0.0)
    exponent, relative = laws[i, 3], speed / laws[i, 2]
    if exponent != 1.0:
        relative = relative * relative if exponent == 2.0 else relative**exponent
    weakened = (laws[i, 0] - laws[i, 1]) * math.exp(-relative)
    return laws[i, 1] + weakened + laws[i, 4] * speed, laws[i, 4] - weakened * exponent * relative / speed


@numba.njit(**STRICT)
def least_ratio(law, laws, i):
    """Return the ratio that a weakening law falls to, but for its viscous part."""
    return laws[i, 1] if law == at.STRIBECK else laws[i, 2]


@numba.njit(**STRICT)
def speed_scale(law, laws, i, state):
    """Return the slip speed above which the ratio of a law begins to bend."""
    if law == at.LINEAR_WEAKENING:
        return laws[i, 3]
    if law <= at.LUGRE:
        return laws[i, 2]
    # a asinh(V / w): w = 2 V0 exp(-(reference + b ln(V0 theta / D)) / a), kept above the smallest numbers.
    exponent = (laws[i, 0] + laws[i, 2] * math.log(laws[i, 4] * state / laws[i, 3])) / laws[i, 1]
    return 2.0 * laws[i, 4] * math.exp(-min(exponent, 600.0))


@numba.njit(**STRICT)
def next_state(law, laws, i, state, velocity, step):
    """Return the internal state after a step at constant slip velocity, exactly."""
    speed = abs(velocity)
    if law == at.LUGRE:
        limit = (laws[i, 1] + (laws[i, 0] - laws[i, 1]) * math.exp(-((speed / laws[i, 2]) ** 2))) / laws[i, 3]
        passed = speed * step / limit
        share = 1.0 - 0.5 * passed if passed < 1e-8 else -math.expm1(-passed) / passed
        return state * math.exp(-passed) + velocity * step * share
    turned = speed * step / laws[i, 3]
    if law == at.AGING:
        share = 1.0 - 0.5 * turned if turned < 1e-8 else -math.expm1(-turned) / turned
        return state * math.exp(-turned) + step * share
    if turned == 0.0:
        return state
    age = speed * state / laws[i, 3]
    return state * age ** math.expm1(-turned)


@numba.njit(**STRICT)
def state_ratio(law, laws, i, state, velocity, step):
    """Return the ratio of a law with internal state over a step: with mean and rate of the state over it."""
    new = next_state(law, laws, i, state, velocity, step)
    middle = 0.5 * (state + new)
    if law == at.LUGRE:
        return laws[i, 3] * middle + laws[i, 4] * (new - state) / step + laws[i, 5] * velocity
    if velocity == 0.0:
        return 0.0
    exponent = (laws[i, 0] + laws[i, 2] * math.log(laws[i, 4] * middle / laws[i, 3])) / laws[i, 1] + math.log(
        abs(velocity) / (2.0 * laws[i, 4])
    )
    ratio = exponent + math.log(2.0) if exponent > 30.0 else math.asinh(math.exp(exponent))
    return math.copysign(laws[i, 1] * ratio, velocity)


@numba.njit(**STRICT)
def sticking_speed(law, laws, i):
    """Return the slip speed below which a law with internal state counts as sticking."""
    return laws[i, 2] if law == at.LUGRE else laws[i, 4]
