"""Step 5, the state of one point contact with friction: the exact solution over one step."""

import math

import numba

from . import layout as at
from .friction import (
    STRICT,
    corner_between,
    holding_ratio,
    least_ratio,
    ratio_and_slope,
    set_valued,
    sliding_ratio,
    speed_scale,
    state_ratio,
    state_ratio_and_slope,
    sticking_speed,
)
from .lanes import choose, magnitude

SEPARATED, STICKING, SLIDING = 0, 1, 2
# Steps of Newton's or Halley's method for a slip velocity; a bracketed search takes over where they fail.
NEWTON = 12
# Relative steps of these methods whose square, and whose cube, are round-off.
QUADRATIC, CUBIC = 1e-8, 1e-4
# Trials of a root search; each at least halves the bracket in the end.
TRIALS = 200
# Halvings that reduce a bracket to round-off.
HALVINGS = 60


@numba.njit(inline="always", **STRICT)
def solve_contact(gap, slip, strayed, w, law, laws, i, before, let_go, step):
    """Return (normal force, tangential force, status, jammed) that close `gap` under a law of friction (step 5).

    `gap` is the gap [m] at the end of the step without contact force, `slip` the motion of the tip along the track in
    the step without it [m], `strayed` the distance of a stick from its anchor [m]. The compliance `w` [m/N], rows (nn,
    nt, tn, tt), is the relative displacement of the tip against the track for unit forces (on the tip and its opposite
    on the track), the first index that of the displacement. The tangential force acts on the track along the tangent.
    `before` are status, slips of the last two steps, the later first, internal state and both forces of the last step.
    Velocity-dependent laws see the slip velocity of `velocity_at`. A contact that was let go is no longer held by its
    static coefficient, and slides where both states are consistent.
    """
    if gap >= 0.0:
        return 0.0, 0.0, SEPARATED, False
    if not set_valued(law):
        return slide_with_state(gap, slip, w, law, laws, i, before, step)
    if w[3] == 0.0:
        return slide_as_prescribed(gap, slip, strayed, w[0], law, laws, i, before, step)
    if law == at.COULOMB:
        normal, tangential, status, jammed = solve_coulomb(gap, slip + strayed, w, laws[i, 0])
    else:
        if law > at.STATIC_KINETIC and before[0] == SLIDING:
            ratio = slide_on(gap, slip, w, law, laws, i, before, step)
            if ratio != 0.0:
                normal = -gap / (w[0] - ratio * w[1])
                return normal, ratio * normal, SLIDING, False
        normal, tangential, status, jammed = stick_or_slide(gap, slip, strayed, w, law, laws, i, before, let_go, step)
    last_slip = before[1]
    if before[0] == SLIDING and (status == STICKING or tangential * last_slip < 0.0):
        ratio = sliding_ratio(law, laws, i, 0.0)
        held = holding_ratio(law, laws, i, not let_go)
        turns, pressed, turned, slides = turn_round(gap, slip, last_slip, w, ratio, held)
        if turns:
            return pressed, turned, SLIDING if slides else STICKING, False
    return normal, tangential, status, jammed


@numba.njit(**STRICT)
def stick_or_slide(gap, slip, strayed, w, law, laws, i, before, let_go, step):
    """Return the contact (5b, 5c) under a law with a static coefficient, or whose ratio depends on the slip speed."""
    normal, tangential = sticking_forces(gap, slip + strayed, w)
    sense = 1.0 if tangential >= 0.0 else -1.0
    held = holding_ratio(law, laws, i, before[0] == STICKING and not let_go)
    ratio, travelled = sense * sliding_ratio(law, laws, i, 0.0), sense
    if abs(tangential) <= held * normal:
        velocity = 0.0
        if let_go and law > at.STATIC_KINETIC:
            velocity = slipping_velocity(gap, slip, w, law, laws, i, before, sense, step)
            ratio = sense * sliding_ratio(law, laws, i, abs(velocity))
            travelled = slip_at(velocity, before, step)
        if velocity == 0.0 or sense * travelled <= 0.0:
            return normal, tangential, STICKING, w[0] - sense * held * w[1] <= 0.0
    elif law > at.STATIC_KINETIC:
        velocity, ratio = sliding_velocity(gap, slip, w, law, laws, i, before, sense, step)
        if sense * slip_at(velocity, before, step) < 0.0:
            # Friction brings the contact to rest within the step, viscous friction even beyond the static ratio.
            most = max(held, abs(ratio))
            if abs(tangential) <= most * normal:
                return normal, tangential, STICKING, False
            ratio = sense * most
    normal = -gap / (w[0] - ratio * w[1])
    return normal, ratio * normal, SLIDING, False


@numba.njit(**STRICT)
def sticking_forces(gap, slip, w):
    """Return the normal and the tangential force that close `gap` and undo `slip` (5b)."""
    w_nn, w_nt, w_tn, w_tt = w
    determinant = w_nn * w_tt - w_nt * w_tn
    return (w_nt * slip - w_tt * gap) / determinant, (w_nn * slip - w_tn * gap) / determinant


@numba.njit(**STRICT)
def solve_coulomb(gap, slip, w, mu):
    """Return the contact (5b, 5c) that closes a `gap` below zero under one coefficient of friction."""
    normal, tangential = sticking_forces(gap, slip, w)
    sense = 1.0 if tangential >= 0.0 else -1.0
    free = w[0] - sense * mu * w[1]
    if abs(tangential) <= mu * normal:
        return normal, tangential, STICKING, free <= 0.0
    normal = -gap / free
    return normal, sense * mu * normal, SLIDING, False


@numba.njit(**STRICT)
def turn_round(gap, slip, last_slip, w, ratio, held):
    """Return the contact of a slip that ends within the step (5d), as numbers of runs.

    The contact slides on for the share of the step until it stops; for the rest it is held, or slides back where
    holding takes more than the ratio `held`. The forces are means over the step. Where the slip does not end, or would
    jam, `turns` is false and the other results have no meaning.

    Returns
    -------
    turns : bool
        Whether the slip ends within the step.
    normal, tangential : float
        Forces [N].
    slides : bool
        Whether the contact slides back.
    """
    w_nn, w_nt, w_tn, w_tt = w
    along = choose(last_slip < 0.0, -ratio, ratio)
    free_on, free_back = w_nn - along * w_nt, w_nn + along * w_nt
    on, back = -gap / free_on, -gap / free_back
    farther = slip + (w_tn - along * w_tt) * on
    share = last_slip / (last_slip - farther)
    # Held from where it stops: the last slip is used up by then.
    undone, area = slip - last_slip, 1.0 / (w_nn * w_tt - w_nt * w_tn)
    pressed, needed = (w_nt * undone - w_tt * gap) * area, (w_nn * undone - w_tn * gap) * area
    slides = magnitude(needed) > held * pressed
    left = 1.0 - share
    normal = share * on + left * choose(slides, back, pressed)
    tangential = share * along * on + left * choose(slides, -along * back, needed)
    clear = choose(free_on < free_back, free_on, free_back)
    turns = choose(clear > 0.0, farther * last_slip, 0.0) < 0.0
    return turns, normal, tangential, slides


@numba.njit(**STRICT)
def slide_as_prescribed(gap, slip, strayed, w_nn, law, laws, i, before, step):
    """Return the contact of bodies that no force moves along the tangent: the slip is given."""
    status, last_slip = before[0], before[1]
    normal = -gap / w_nn
    if slip == 0.0 or slip + strayed == 0.0:
        return normal, 0.0, STICKING, False
    ratio = sliding_ratio(law, laws, i, abs(velocity_at(slip, before, step)))
    if status == SLIDING and last_slip * slip < 0.0:
        # Sliding on until it stops, then back (5d).
        ratio *= (slip + last_slip) / (slip - last_slip)
    return normal, math.copysign(1.0, slip) * ratio * normal, SLIDING, False


@numba.njit(inline="always", **STRICT)
def velocity_at(slip, before, step):
    """Return the slip velocity at the middle of the last step and this one, of second order.

    The mean would not see a sawtooth from step to step. Among the second-order combinations of three slips this one
    damps it best: under stiff friction it falls to a third in each step.
    """
    return (9.0 * slip + 6.0 * before[1] + before[2]) / (16.0 * step)


@numba.njit(inline="always", **STRICT)
def slip_at(velocity, before, step):
    """Return the slip of a step with the slip velocity `velocity` at its beginning."""
    return (16.0 * step * velocity - 6.0 * before[1] - before[2]) / 9.0


@numba.njit(**STRICT)
def velocity_under(ratio, gap, slip, w, before, step):
    """Return the slip velocity under forces of a given ratio that close the gap, infinite where that jams."""
    w_nn, w_nt, w_tn, w_tt = w
    free = w_nn - ratio * w_nt
    if free <= 0.0:
        return -math.copysign(math.inf, ratio)
    return velocity_at(slip - gap / free * (w_tn - ratio * w_tt), before, step)


@numba.njit(inline="always", **STRICT)
def slide_on(gap, slip, w, law, laws, i, before, step):
    """Return the ratio of forces of a contact that slides on in its sense, 0 where that is not certain at once."""
    w_nn, w_nt, w_tn, w_tt = w
    # The first parameter of every such law is its ratio at rest.
    at_rest = math.copysign(laws[i, 0], before[1])
    free = w_nn - at_rest * w_nt
    if before[1] == 0.0 or free <= 0.0 or (slip - gap / free * (w_tn - at_rest * w_tt)) * before[1] <= 0.0:
        return 0.0
    velocity, ratio = sliding_velocity(gap, slip, w, law, laws, i, before, math.copysign(1.0, before[1]), step)
    return ratio if slip_at(velocity, before, step) * before[1] > 0.0 else 0.0


@numba.njit(inline="always", **STRICT)
def sliding_velocity(gap, slip, w, law, laws, i, before, sense, step):
    """Return slip velocity and ratio of forces of a contact that slides under a law whose ratio depends on the speed.

    Halley's method for the speed, from the speed under the ratio of the last step: mostly one evaluation of the law,
    whose expansion gives the ratio at the result.
    """
    w_nn, w_nt, w_tn, w_tt = w
    ratio = abs(before[5] / before[4]) if before[4] > 0.0 else sliding_ratio(law, laws, i, 0.0)
    free = w_nn - sense * ratio * w_nt
    share = 1.0 / (16.0 * step)
    moved = sense * (9.0 * slip + 6.0 * before[1] + before[2]) * share
    speed = moved - sense * 9.0 * share * gap / free * (w_tn - sense * ratio * w_tt)
    area = 9.0 * share * (w_nn * w_tt - w_nt * w_tn)
    for _ in range(NEWTON):
        if not 0.0 < speed < math.inf:
            break
        ratio, slope, bend = ratio_and_slope(law, laws, i, speed)
        free = w_nn - sense * ratio * w_nt
        if free <= 0.0:
            break
        freed = 1.0 / free
        normal = -gap * freed
        reached = moved + sense * 9.0 * share * normal * (w_tn - sense * ratio * w_tt)
        softness = normal * freed * area
        steepness = 1.0 + softness * slope
        if steepness <= 0.0:
            break
        change = (reached - speed) / steepness
        curvature = softness * (bend + 2.0 * slope * slope * sense * w_nt * freed)
        change -= 0.5 * curvature / steepness * change * change
        speed += change
        if abs(change) <= CUBIC * speed and not corner_between(law, laws, i, speed - change, speed):
            return sense * speed, sense * (ratio + (slope + 0.5 * bend * change) * change)
    at_rest = sliding_ratio(law, laws, i, 0.0)
    if sense * velocity_under(sense * at_rest, gap, slip, w, before, step) <= 0.0:
        return 0.0, sense * at_rest
    velocity = slip_velocity(gap, slip, w, law, laws, i, before, sense, step)
    return velocity, sense * sliding_ratio(law, laws, i, abs(velocity))


@numba.njit(**STRICT)
def slide_with_state(gap, slip, w, law, laws, i, before, step):
    """Return the contact under a law with internal state, which never sticks exactly."""
    w_nn, w_nt, w_tn, w_tt = w
    velocity, ratio, slope = velocity_with_state(gap, slip, w, law, laws, i, before, step)
    status = STICKING if abs(velocity) < sticking_speed(law, laws, i) else SLIDING
    # A ratio that is flat in the velocity gives the forces to round-off; a steep one, in creep, gives the motion.
    free = w_nn - ratio * w_nt
    if -gap / (free * free) * (w_nn * w_tt - w_nt * w_tn) * 9.0 * slope <= 16.0 * step:
        normal = -gap / (w_nn - ratio * w_nt)
        return normal, ratio * normal, status, False
    travelled = slip_at(velocity, before, step)
    tangential = (slip - w_tn / w_nn * gap - travelled) / (w_tt - w_nt * w_tn / w_nn)
    normal = (w_nt * tangential - gap) / w_nn
    return normal, tangential, status, False


@numba.njit(inline="always", **STRICT)
def velocity_with_state(gap, slip, w, law, laws, i, before, step):
    """Return the slip velocity under a law with internal state, the ratio of the forces there and its slope.

    Newton's method from the velocity of the last two slips, with steps that keep more than a hundredth of it: the ratio
    of a law with age depends on the logarithm.
    """
    w_nn, w_nt, w_tn, w_tt = w
    velocity = (3.0 * before[1] - before[2]) / (2.0 * step)
    area = (w_nn * w_tt - w_nt * w_tn) * 9.0 / (16.0 * step)
    for _ in range(NEWTON):
        ratio, slope = state_ratio_and_slope(law, laws, i, before[3], velocity, step)
        free = w_nn - ratio * w_nt
        steepness = 1.0 - gap / (free * free) * area * slope
        if free <= 0.0 or not steepness > 0.0:
            break
        change = (velocity_under(ratio, gap, slip, w, before, step) - velocity) / steepness
        if abs(change) <= QUADRATIC * abs(velocity + change):
            return velocity + change, ratio + slope * change, slope
        if law != at.LUGRE and velocity * (velocity + change) <= 0.01 * velocity * velocity:
            break
        velocity += change
    velocity = slip_velocity(gap, slip, w, law, laws, i, before, 0.0, step)
    ratio, slope = state_ratio_and_slope(law, laws, i, before[3], velocity, step)
    return velocity, ratio, slope


@numba.njit(**STRICT)
def slip_velocity(gap, slip, w, law, laws, i, before, sense, step):
    """Return the slip velocity that results from the forces at that velocity.

    `sense` is the sense of sliding of a set-valued law, 0 for a law with internal state. The root is bracketed and
    found by false position (Illinois), with the velocity as ``scale sinh(y)``, so that creep and sliding share one
    scale.
    """
    state = before[3]
    ratio = ratio_at(law, laws, i, state, 0.0, sense, step)
    at_rest = velocity_under(ratio, gap, slip, w, before, step)
    if sense == 0.0:
        sense = 1.0 if at_rest >= 0.0 else -1.0
    elif sense * at_rest <= 0.0:
        return 0.0
    reach = abs(at_rest)
    if math.isinf(reach):
        reach = max(abs(slip) + abs(before[1]), 1e-300) / (2.0 * step)
    if reach == 0.0:
        return 0.0
    scale = speed_scale(law, laws, i, state)
    low, below = 0.0, -abs(at_rest)
    high, above, velocity = low, below, 0.0
    for _ in range(TRIALS):
        velocity = sense * reach
        ratio = ratio_at(law, laws, i, state, velocity, sense, step)
        high = math.asinh(reach / scale)
        above = reach - sense * velocity_under(ratio, gap, slip, w, before, step)
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
        error = sense * (velocity - velocity_under(ratio, gap, slip, w, before, step))
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


@numba.njit(**STRICT)
def slipping_velocity(gap, slip, w, law, laws, i, before, sense, step):
    """Return the largest slip velocity under a weakening law where sticking is also possible, 0 if there is none."""
    highest = sense * velocity_under(sense * least_ratio(law, laws, i), gap, slip, w, before, step)
    low, high = 0.0, highest
    for _ in range(HALVINGS):
        ratio = sense * sliding_ratio(law, laws, i, max(high, 0.0))
        if high - sense * velocity_under(ratio, gap, slip, w, before, step) < 0.0:
            low, high = high, 2.0 * high
            break
        high *= 0.5
    if low == 0.0:
        return 0.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        ratio = sense * sliding_ratio(law, laws, i, middle)
        if middle < sense * velocity_under(ratio, gap, slip, w, before, step):
            low = middle
        else:
            high = middle
    return sense * low


@numba.njit(**STRICT)
def ratio_at(law, laws, i, state, velocity, sense, step):
    """Return tangential over normal force at a slip velocity; at rest, that of incipient sliding in `sense`."""
    if set_valued(law):
        return sense * sliding_ratio(law, laws, i, abs(velocity))
    return state_ratio(law, laws, i, state, velocity, step)


@numba.njit(inline="always", **STRICT)
def landed_share(gap_before, gap):
    """Return the share of a step that remains after an open contact closes; without contact `gap` would be reached."""
    return choose(gap < 0.0, gap, -1.0) / (choose(gap < 0.0, gap, -1.0) - gap_before)


@numba.njit(inline="always", **STRICT)
def closed_share(normal, tangential, gap, w_nn, w_nt):
    """Return the share of the step before in which a contact that is open now was still closed.

    The force is taken straight from `normal` through zero to the force that would hold the contact closed, at the same
    ratio.
    """
    free = w_nn - tangential / normal * w_nt
    return normal / (normal + gap / choose(free > 0.0, free, w_nn))


@numba.njit(inline="always", **STRICT)
def stuck_share(normal, tangential, gap, slip, w, mu):
    """Return the share of the step before in which a contact that slides now still stuck.

    The tangential force is taken straight from `tangential` through the border of the cone to the force that would keep
    it stuck.
    """
    pressed, needed = sticking_forces(gap, slip, w)
    sense = choose(needed < 0.0, -1.0, 1.0)
    inside, outside = mu * normal - sense * tangential, sense * needed - mu * pressed
    return choose(outside > 0.0, inside, 1.0) / choose(outside > 0.0, inside + outside, 1.0)
