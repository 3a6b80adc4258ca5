"""Bristles of LuGre's law in space, where their deflection and friction are vectors in the tangent plane.

Over a step at the slip velocity v the ratio of forces is ``holds z + drags v``, for the deflection z at its beginning
and two functions of the slip speed |v| alone. At a given speed friction is thus linear; the speed sought is the one at
which the contact then slides.
"""

import math

import numba
from numba.extending import overload

from . import layout as at
from .contact import SLIDING, STICKING, velocity_at
from .friction import STRICT, bristles_over, sticking_speed
from .lanes import lane, with_lane
from .vectors import LANES, VECTOR

# Relative rounding of a normal force, and of the terms of a velocity.
ROUND_OFF = 1e-15
# Trials of a root search, and the relative step of Newton's method whose square is round-off.
TRIALS, QUADRATIC = 200, 1e-8


@numba.njit(inline="always", **STRICT)
def shares_at(laws, number, speed, step):
    """Return the factors of deflection and slip velocity in the ratio over a step at a speed, and their slopes."""
    kept, share, passed, passed_slope, share_slope = bristles_over(laws, number, speed, step)
    # The ratio uses the mean deflection, hence half of its change over the step, and its rate.
    felt = 0.5 * laws[number, 3] + laws[number, 4] / step
    holds, drags = laws[number, 3] - felt * passed * share, felt * step * share + laws[number, 5]
    return holds, drags, -felt * kept * passed_slope, felt * step * share_slope * passed_slope


@numba.njit(**STRICT)
def bristles_ratio(laws, number, state, velocity, step):
    """Return the ratios of forces along both tangents over a step at a slip velocity."""
    holds, drags, _, _ = shares_at(laws, number, math.hypot(velocity[0], velocity[1]), step)
    return holds * state[0] + drags * velocity[0], holds * state[1] + drags * velocity[1]


@numba.njit(inline="always", **STRICT)
def braked(drag, matrix, pull, right):
    """Return the two unknowns of ``(1 + drag matrix) x = pull right``, rows of the matrix in turn."""
    a, b, c, d = 1.0 + drag * matrix[0], drag * matrix[1], drag * matrix[2], 1.0 + drag * matrix[3]
    size = pull / (a * d - b * c)
    return size * (d * right[0] - b * right[1]), size * (a * right[1] - c * right[0])


@numba.njit(**STRICT)
def pressed_at(holds, drags, normal, free, state, w):
    """Return normal force, slip velocity and ratios under ``holds z + drags v``, by Newton's method within a bracket.

    `free` are gap and slip velocity without forces, and the velocity for a unit of displacement; `normal` is a guess.
    """
    gap, velocity, rate = free
    pulled = holds * state[0], holds * state[1]
    tangents = w[4], w[5], w[7], w[8]
    low, high = 0.0, math.inf
    moved, ratio = velocity, pulled
    for _ in range(TRIALS):
        pushed = rate * normal
        right = (
            velocity[0] + pushed * (w[3] - w[4] * pulled[0] - w[5] * pulled[1]),
            velocity[1] + pushed * (w[6] - w[7] * pulled[0] - w[8] * pulled[1]),
        )
        moved = braked(pushed * drags, tangents, 1.0, right)
        ratio = pulled[0] + drags * moved[0], pulled[1] + drags * moved[1]
        clear = w[0] - w[1] * ratio[0] - w[2] * ratio[1]
        error = normal * clear + gap
        if error > 0.0:
            high = normal
        else:
            low = normal
        driven = (
            w[3] - w[4] * ratio[0] - w[5] * ratio[1],
            w[6] - w[7] * ratio[0] - w[8] * ratio[1],
        )
        more = braked(pushed * drags, tangents, rate * drags, driven)
        slope = clear - normal * (w[1] * more[0] + w[2] * more[1])
        found = normal - error / slope if slope > 0.0 else -1.0
        if abs(found - normal) <= ROUND_OFF * normal:
            break
        if not low < found < high:
            found = 2.0 * normal if high == math.inf else 0.5 * (low + high)
        normal = found
    return normal, moved, ratio


@numba.njit(**STRICT)
def slope_of_speed(shares, normal, moved, ratio, rate, state, w):
    """Return the derivative of the assumed speed minus the resulting slip speed, by the assumed speed."""
    _, drags, holds_slope, drags_slope = shares
    size = math.hypot(moved[0], moved[1])
    if size == 0.0:
        return 1.0
    bent = holds_slope * state[0] + drags_slope * moved[0], holds_slope * state[1] + drags_slope * moved[1]
    driven = w[3] - w[4] * ratio[0] - w[5] * ratio[1], w[6] - w[7] * ratio[0] - w[8] * ratio[1]
    clear = w[0] - w[1] * ratio[0] - w[2] * ratio[1]
    # Compliance of the tangents with the gap kept closed.
    matrix = (
        w[4] - driven[0] * w[1] / clear,
        w[5] - driven[0] * w[2] / clear,
        w[7] - driven[1] * w[1] / clear,
        w[8] - driven[1] * w[2] / clear,
    )
    pull = matrix[0] * bent[0] + matrix[1] * bent[1], matrix[2] * bent[0] + matrix[3] * bent[1]
    swerve = braked(rate * normal * drags, matrix, -rate * normal, pull)
    return 1.0 - (moved[0] * swerve[0] + moved[1] * swerve[1]) / size


@numba.njit(**STRICT)
def slide_on_bristles(gap, slips, w, laws, number, before, step):
    """Return normal force, both tangential forces, status and whether it jams, under LuGre's law.

    Newton's method for the slip speed within a bracket, from that of the last two slips. Arguments are those of
    `space.solve_one_in_space`.
    """
    was, last, earlier, state = before[0], before[1], before[2], before[3]
    rate = 9.0 / (16.0 * step)
    velocity = (
        velocity_at(slips[0], (was, last[0], earlier[0]), step),
        velocity_at(slips[1], (was, last[1], earlier[1]), step),
    )
    free = (gap, velocity, rate)
    speed = math.hypot(3.0 * last[0] - earlier[0], 3.0 * last[1] - earlier[1]) / (2.0 * step)
    low, high, normal, settled = 0.0, math.inf, -gap / w[0], False
    moved, ratio = velocity, state
    for _ in range(TRIALS):
        shares = shares_at(laws, number, speed, step)
        normal, moved, ratio = pressed_at(shares[0], shares[1], normal, free, state, w)
        if settled:
            break
        reached = math.hypot(moved[0], moved[1])
        error = speed - reached
        if error > 0.0:
            high = speed
        else:
            low = speed
        slope = slope_of_speed(shares, normal, moved, ratio, rate, state, w)
        found = speed - error / slope if slope > 0.0 else -1.0
        terms = abs(velocity[0]) + abs(velocity[1]) + rate * normal * (abs(w[3]) + abs(w[6]))
        terms += rate * normal * (w[4] + w[8]) * (abs(ratio[0]) + abs(ratio[1]))
        if abs(error) <= ROUND_OFF * terms:
            break
        settled = low <= found <= high and abs(found - speed) <= QUADRATIC * speed
        if not (settled or low < found < high):
            found = 2.0 * max(speed, reached) if high == math.inf else 0.5 * (low + high)
        if found == speed:
            break
        speed = found
    normal = -gap / (w[0] - w[1] * ratio[0] - w[2] * ratio[1])
    slow = math.hypot(moved[0], moved[1]) < sticking_speed(at.LUGRE, laws, number)
    return normal, normal * ratio[0], normal * ratio[1], float(STICKING if slow else SLIDING), 0.0


def next_bristles(laws, number, status, state, velocity, step):
    """Return the deflections of bristles along both tangents after a step, those at rest if the bodies are apart."""
    return next_bristles_of_run(laws, number, status, state, velocity, step)


@numba.njit(**STRICT)
def next_bristles_of_run(laws, number, status, state, velocity, step):
    """Do `next_bristles` for one run."""
    if status < 0.5:
        straight = laws[number, at.LAW_PARAMETERS - 1]
        return straight, straight
    kept, share, _, _, _ = bristles_over(laws, number, math.hypot(velocity[0], velocity[1]), step)
    return kept * state[0] + step * share * velocity[0], kept * state[1] + step * share * velocity[1]


@numba.njit(**STRICT)
def next_bristles_of_runs(laws, number, status, state, velocity, step):
    """Do `next_bristles` for vectors of runs."""
    first, second = state
    for i in range(LANES):
        one = next_bristles_of_run(
            laws,
            number + i,
            lane(status, i),
            (lane(state[0], i), lane(state[1], i)),
            (lane(velocity[0], i), lane(velocity[1], i)),
            step,
        )
        first, second = with_lane(first, i, one[0]), with_lane(second, i, one[1])
    return first, second


@overload(next_bristles)
def _overload_next_bristles(laws, number, status, state, velocity, step):
    chosen = next_bristles_of_runs if status is VECTOR else next_bristles_of_run

    def implementation(laws, number, status, state, velocity, step):
        return chosen(laws, number, status, state, velocity, step)

    return implementation
