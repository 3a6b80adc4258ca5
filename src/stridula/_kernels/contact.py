"""The exact solve of one point contact with friction over one step."""

import math

import numba

from . import layout as at
from .friction import (
    holding_ratio,
    least_ratio,
    set_valued,
    sliding_ratio,
    speed_scale,
    state_ratio,
    sticking_speed,
)

SEPARATED, STICKING, SLIDING = 0, 1, 2
# Whether a contact that would stick is held by the static coefficient.
FREE, HELD, LET_GO = 0, 1, 2
# Trials of a root search; each at least halves the bracket in the end.
TRIALS = 200
# Relative distance over which the slope of a ratio is seen.
NEARBY = 1e-6
# Halvings of a bracket that leave nothing of it.
HALVINGS = 60


@numba.njit(cache=True, inline="always")
def solve_contact(gap, slip, freed, w_nn, w_nt, w_tt, law, laws, i, state, last_slip, grip, step):
    """Return (normal force, tangential force, status, jammed) that close `gap` under a law of friction.

    `gap` is the gap [m] at the end of the step without contact force, `slip` how far the tip is then from where
    sticking would hold it, `freed` how far it is from where it was. The compliances [m/N] are the relative
    displacement of the tip against the track for unit forces (on the tip and its opposite on the track). The
    tangential force acts on the track along the tangent. Velocity-dependent laws see the centred slip velocity. `grip`
    says whether the static coefficient holds, or whether of two consistent states sliding is taken.
    """
    if gap >= 0.0:
        return 0.0, 0.0, SEPARATED, False
    if not set_valued(law):
        return slide_with_state(gap, freed, w_nn, w_nt, w_tt, law, laws, i, state, last_slip, step)
    if law == at.COULOMB and w_tt > 0.0:
        return solve_coulomb(gap, slip, w_nn, w_nt, w_tt, laws[i, 0])
    if w_tt == 0.0:
        return slide_as_prescribed(gap, slip, freed, w_nn, law, laws, i, last_slip, step)
    normal, tangential = sticking_forces(gap, slip, w_nn, w_nt, w_tt)
    sense = 1.0 if tangential >= 0.0 else -1.0
    held = holding_ratio(law, laws, i, grip == HELD)
    velocity = 0.0
    if abs(tangential) <= held * normal:
        if grip == LET_GO and law > at.STATIC_KINETIC:
            velocity = slipping_velocity(gap, freed, w_nn, w_nt, w_tt, law, laws, i, last_slip, sense, step)
        if sense * (2.0 * step * velocity - last_slip) <= 0.0 or velocity == 0.0:
            return normal, tangential, STICKING, w_nn - sense * held * w_nt <= 0.0
    elif law > at.STATIC_KINETIC:
        velocity = slip_velocity(gap, freed, w_nn, w_nt, w_tt, law, laws, i, state, last_slip, sense, step)
        if sense * (2.0 * step * velocity - last_slip) < 0.0:
            # Viscous friction above the static one brings it to rest within the step.
            return normal, tangential, STICKING, False
    ratio = sliding_ratio(law, laws, i, abs(velocity))
    normal = -gap / (w_nn - sense * ratio * w_nt)
    return normal, sense * ratio * normal, SLIDING, False


@numba.njit(cache=True)
def sticking_forces(gap, slip, w_nn, w_nt, w_tt):
    """Return the normal and the tangential force that close `gap` and undo `slip`."""
    determinant = w_nn * w_tt - w_nt * w_nt
    return (w_nt * slip - w_tt * gap) / determinant, (w_nn * slip - w_nt * gap) / determinant


@numba.njit(cache=True)
def solve_coulomb(gap, slip, w_nn, w_nt, w_tt, mu):
    """Return the contact that closes `gap` below zero under one coefficient of friction."""
    normal, tangential = sticking_forces(gap, slip, w_nn, w_nt, w_tt)
    sense = 1.0 if tangential >= 0.0 else -1.0
    free = w_nn - sense * mu * w_nt
    if abs(tangential) <= mu * normal:
        return normal, tangential, STICKING, free <= 0.0
    normal = -gap / free
    return normal, sense * mu * normal, SLIDING, False


@numba.njit(cache=True)
def slide_as_prescribed(gap, slip, freed, w_nn, law, laws, i, last_slip, step):
    """Return the contact of bodies that no force moves along the tangent: the slip is what it is."""
    normal = -gap / w_nn
    if abs(freed) == 0.0 or slip == 0.0:
        return normal, 0.0, STICKING, False
    ratio = sliding_ratio(law, laws, i, abs(freed + last_slip) / (2.0 * step))
    return normal, math.copysign(ratio * normal, freed), SLIDING, False


@numba.njit(cache=True)
def slide_with_state(gap, freed, w_nn, w_nt, w_tt, law, laws, i, state, last_slip, step):
    """Return the contact under a law with internal state, which never sticks exactly."""
    velocity = slip_velocity(gap, freed, w_nn, w_nt, w_tt, law, laws, i, state, last_slip, 0.0, step)
    status = STICKING if abs(velocity) < sticking_speed(law, laws, i) else SLIDING
    # Where the ratio is flat in the velocity it gives the forces to round-off, where it is steep, in creep, the motion.
    ratio = state_ratio(law, laws, i, state, velocity, step)
    led_to = velocity_under(ratio, gap, freed, w_nn, w_nt, w_tt, last_slip, step)
    nearby = state_ratio(law, laws, i, state, velocity * (1.0 + NEARBY), step)
    change = velocity_under(nearby, gap, freed, w_nn, w_nt, w_tt, last_slip, step) - led_to
    if abs(change) <= abs(NEARBY * velocity):
        normal = -gap / (w_nn - ratio * w_nt)
        return normal, ratio * normal, status, False
    slip = 2.0 * step * velocity - last_slip
    tangential = (freed - w_nt / w_nn * gap - slip) / (w_tt - w_nt * w_nt / w_nn)
    normal = (w_nt * tangential - gap) / w_nn
    return normal, tangential, status, False


@numba.njit(cache=True)
def slip_velocity(gap, freed, w_nn, w_nt, w_tt, law, laws, i, state, last_slip, sense, step):
    """Return the centred slip velocity that the forces at that velocity lead to.

    `sense` is that of a law which was found to slide, 0 for a law with internal state. The root is bracketed and found
    by false position (Illinois), with the velocity as ``scale sinh(y)``, so that creep and sliding are on one line.
    """
    ratio = ratio_at(law, laws, i, state, 0.0, sense, step)
    at_rest = velocity_under(ratio, gap, freed, w_nn, w_nt, w_tt, last_slip, step)
    if sense == 0.0:
        sense = 1.0 if at_rest >= 0.0 else -1.0
    elif sense * at_rest <= 0.0:
        return 0.0
    reach = abs(at_rest)
    if math.isinf(reach):
        reach = max(abs(freed) + abs(last_slip), 1e-300) / (2.0 * step)
    if reach == 0.0:
        return 0.0
    scale = speed_scale(law, laws, i, state)
    low, below = 0.0, -abs(at_rest)
    high, above, velocity = low, below, 0.0
    for _ in range(TRIALS):
        velocity = sense * reach
        ratio = ratio_at(law, laws, i, state, velocity, sense, step)
        high = math.asinh(reach / scale)
        above = reach - sense * velocity_under(ratio, gap, freed, w_nn, w_nt, w_tt, last_slip, step)
        if above >= 0.0:
            break
        low, below, reach = high, above, 2.0 * reach
    kept = 0
    for _ in range(TRIALS):
        if above <= 0.0 or high - low <= 1e-15 * high:
            break
        y = 0.5 * (low + high)
        if math.isfinite(above) and math.isfinite(below):
            secant = (low * above - high * below) / (above - below)
            y = secant if low < secant < high else y
        velocity = sense * scale * math.sinh(y)
        ratio = ratio_at(law, laws, i, state, velocity, sense, step)
        error = sense * (velocity - velocity_under(ratio, gap, freed, w_nn, w_nt, w_tt, last_slip, step))
        if abs(error) <= 4e-16 * abs(velocity):
            break
        if error > 0.0:
            high, above = y, error
            below *= 0.5 if kept == -1 else 1.0
            kept = -1
        else:
            low, below = y, error
            above *= 0.5 if kept == 1 else 1.0
            kept = 1
    return velocity


@numba.njit(cache=True)
def slipping_velocity(gap, freed, w_nn, w_nt, w_tt, law, laws, i, last_slip, sense, step):
    """Return the largest slip velocity that a weakening law leads to where it could also stick, 0 if none."""
    highest = sense * velocity_under(sense * least_ratio(law, laws, i), gap, freed, w_nn, w_nt, w_tt, last_slip, step)
    low, high = 0.0, highest
    for _ in range(HALVINGS):
        ratio = sense * sliding_ratio(law, laws, i, max(high, 0.0))
        if high - sense * velocity_under(ratio, gap, freed, w_nn, w_nt, w_tt, last_slip, step) < 0.0:
            low, high = high, 2.0 * high
            break
        high *= 0.5
    if low == 0.0:
        return 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        ratio = sense * sliding_ratio(law, laws, i, middle)
        if middle < sense * velocity_under(ratio, gap, freed, w_nn, w_nt, w_tt, last_slip, step):
            low = middle
        else:
            high = middle
    return sense * low


@numba.njit(cache=True)
def ratio_at(law, laws, i, state, velocity, sense, step):
    """Return tangential over normal force at a slip velocity, at rest about to slide in `sense`."""
    if set_valued(law):
        return sense * sliding_ratio(law, laws, i, abs(velocity))
    return state_ratio(law, laws, i, state, velocity, step)


@numba.njit(cache=True)
def velocity_under(ratio, gap, freed, w_nn, w_nt, w_tt, last_slip, step):
    """Return the centred slip velocity under a ratio of forces that closes the gap, endless where that jams."""
    free = w_nn - ratio * w_nt
    if free <= 0.0:
        return -math.copysign(math.inf, ratio)
    return (freed - gap / free * (w_nt - ratio * w_tt) + last_slip) / (2.0 * step)
