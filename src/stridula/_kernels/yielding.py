"""Step 5 for contacts with a stiffness: a force that grows with the indentation, in place of a unilateral constraint.

The force of a step is the change of the energy stored in the indentation from the step before to the step after, over
the change of the indentation: the stored energy is returned exactly (Chatziioannou & van Walstijn 2015).
"""

import math

import numba
from numba.extending import overload

from . import layout as at
from .friction import STRICT
from .lanes import anywhere, choose, everywhere, held, lane, magnitude, spread, with_lane
from .modes import OPTIONS
from .solves import forces_of_one
from .space import solve_in_space
from .vectors import LANES, VECTOR

# Change of the indentation, relative to its mean, below which the quotient is computed by its series.
SMALL = 0.01
# Smallest slope of the force, times the compliance of the bodies.
FLATTEST = 1e-12
# Largest number of steps of Newton's method, and the relative change of the indentation that counts as round-off.
STEPS, SETTLED = 40, 1e-14


@numba.njit(**STRICT)
def power(x, exponent):
    """Return a power of a number that is not negative."""
    if exponent == 1.5:
        return x * math.sqrt(x)
    return x if exponent == 1.0 else x**exponent


@numba.njit(**STRICT)
def quotient(x, before, exponent):
    """Return ``(U(x) - U(before)) / (x - before)`` for ``U' = x^exponent`` from zero on, and its slope in x."""
    inside, was = max(x, 0.0), max(before, 0.0)
    mean, change = 0.5 * (inside + was), x - before
    if inside > 0.0 and was > 0.0 and abs(change) <= SMALL * mean:
        p, share = exponent, (change / mean) ** 2
        bend = p * (p - 1.0) / 24.0
        force = power(mean, p) * (1.0 + bend * share * (1.0 + (p - 2.0) * (p - 3.0) / 80.0 * share))
        return force, power(mean, p) / mean * (0.5 * p + 2.0 * bend * change / mean)
    if change == 0.0:
        return 0.0, 0.0
    stored = (inside * power(inside, exponent) - was * power(was, exponent)) / (exponent + 1.0)
    force = stored / change
    return force, (power(inside, exponent) - force) / change


@numba.njit(**STRICT)
def press_one(x, before, stiffness, exponent, damping, rate, step):
    """Return the force of an indentation and its slope; `before` is the indentation two steps earlier."""
    force, slope = quotient(x, before, exponent)
    velocity = 0.5 * (max(x, 0.0) - max(before, 0.0)) / step
    braked = stiffness * force * rate + damping
    found = stiffness * force + braked * velocity
    if found <= 0.0:
        return 0.0, 0.0
    return found, stiffness * slope * (1.0 + rate * velocity) + (0.5 * braked / step if x > 0.0 else 0.0)


def press(x, before, yields, step):
    """Return the forces of indentations and their slopes."""
    return press_one(x, before, *yields, step)


@numba.njit(**STRICT)
def press_runs(x, before, yields, step):
    """Do `press` for vectors of runs."""
    force, slope = spread(0.0), spread(0.0)
    k, p, c, r = yields
    for i in range(LANES):
        one = press_one(lane(x, i), lane(before, i), lane(k, i), lane(p, i), lane(c, i), lane(r, i), step)
        force, slope = with_lane(force, i, one[0]), with_lane(slope, i, one[1])
    return force, slope


@overload(press)
def _press(x, before, yields, step):
    if x is VECTOR:
        return lambda x, before, yields, step: press_runs(x, before, yields, step)
    return lambda x, before, yields, step: press_one(x, before, yields[0], yields[1], yields[2], yields[3], step)


def stored_in(x, yields):
    """Return the energies stored in indentations."""
    inside = max(x, 0.0)
    return yields[0] * inside * power(inside, yields[1]) / (yields[1] + 1.0) if yields[0] > 0.0 else 0.0


@numba.njit(**STRICT)
def stored_in_one(x, stiffness, exponent):
    """Do `stored_in` for one run."""
    inside = max(x, 0.0)
    return stiffness * inside * power(inside, exponent) / (exponent + 1.0) if stiffness > 0.0 else 0.0


@numba.njit(**STRICT)
def stored_in_runs(x, yields):
    """Do `stored_in` for vectors of runs."""
    energy = spread(0.0)
    for i in range(LANES):
        energy = with_lane(energy, i, stored_in_one(lane(x, i), lane(yields[0], i), lane(yields[1], i)))
    return energy


@overload(stored_in)
def _stored_in(x, yields):
    if x is VECTOR:
        return lambda x, yields: stored_in_runs(x, yields)
    return lambda x, yields: stored_in_one(x, yields[0], yields[1])


@numba.njit(**OPTIONS)
def yields_of(i, constants, run, zero):
    """Return stiffness, its exponent, damping and damping rate of contact `i`; rigid ones have no stiffness."""
    base = i * at.CONTACT_CONSTANTS
    return (
        held(constants, base + at.YIELD_STIFFNESS, run, zero),
        held(constants, base + at.YIELD_EXPONENT, run, zero),
        held(constants, base + at.YIELD_DAMPING, run, zero),
        held(constants, base + at.YIELD_RATE, run, zero),
    )


@numba.njit(**OPTIONS)
def comes_close(i, gap, constants, carried, run, zero):
    """Return where a contact has to be solved: it would overlap, or was indented two steps earlier."""
    soft = held(constants, i * at.CONTACT_CONSTANTS + at.YIELD_STIFFNESS, run, zero) > 0.0
    was = choose(soft, held(carried, i * at.CARRIED + at.EARLIER_GAP, run, zero), zero)
    return choose(gap < 0.0, 1.0, choose(was < 0.0, 1.0, zero))


@numba.njit(**OPTIONS)
def give_of(x, before, yields, w_nn, step, zero):
    """Return the linearised yielding about an indentation: give for a unit of force, and indentation without force."""
    force, slope = press(x, before, yields, step)
    least = FLATTEST / w_nn
    give = 1.0 / choose(slope > least, slope, least)
    soft = yields[0] > 0.0
    return choose(soft, give, zero), choose(soft, x - give * force, zero)


@numba.njit(**OPTIONS)
def is_settled(reached, normal, give, beyond, gap, yields):
    """Return whether an indentation agrees with its force, for the linearised yielding `give` and `beyond` there."""
    left = reached - beyond - give * normal
    near = magnitude(left) <= SETTLED * (magnitude(reached) + magnitude(gap))
    return choose(yields[0] > 0.0, choose(near, 1.0, 0.0), 1.0)


@numba.njit(**OPTIONS)
def forces_yielding(free, friction, before, let_go, step, yields, earlier, zero):
    """Return the result of `forces_of_one` for a yielding contact, with its give and the indentation beyond that.

    Newton's method for the indentation, from that without force: the force is convex, so that it converges from above.
    `free` are gap, slip, distance of a stick from its anchor, compliance; `friction` the law, all laws, the number
    among these and the ratio at rest.
    """
    gap, slip, away, w = free
    law, laws, number, at_rest = friction
    done = zero
    normal, tangential, status, jammed, give, beyond = zero, zero, zero, zero, zero, zero
    softer, further = give_of(-gap, earlier, yields, w[0], step, zero)
    for _ in range(STEPS):
        one = forces_of_one(
            gap + further,
            slip,
            away,
            (w[0] + softer, w[1], w[2], w[3]),
            law,
            laws,
            number,
            at_rest,
            before,
            let_go,
            step,
            zero,
        )
        goes_on = done < 0.5
        normal, tangential = choose(goes_on, one[0], normal), choose(goes_on, one[1], tangential)
        status, jammed = choose(goes_on, one[2], status), choose(goes_on, one[3], jammed)
        give, beyond = choose(goes_on, softer, give), choose(goes_on, further, beyond)
        reached = -(gap + w[0] * normal - w[1] * tangential)
        softer, further = give_of(reached, earlier, yields, w[0], step, zero)
        done = choose(goes_on, is_settled(reached, normal, softer, further, gap, yields), 1.0)
        if everywhere(done > 0.5):
            break
    return normal, tangential, status, jammed, give, beyond


@numba.njit(**OPTIONS)
def forces_yielding_in_space(free, friction, before, let_go, step, yields, earlier, zero):
    """Do `forces_yielding` for a contact in space, as `solve_in_space`."""
    gap, slips, strays, w = free
    law, laws, number = friction
    done = zero
    normal, first, second, status, jammed, give, beyond = zero, zero, zero, zero, zero, zero, zero
    softer, further = give_of(-gap, earlier, yields, w[0], step, zero)
    for _ in range(STEPS):
        softened = (w[0] + softer, w[1], w[2], w[3], w[4], w[5], w[6], w[7], w[8])
        one = solve_in_space(gap + further, slips, strays, softened, law, laws, number, before, let_go, step)
        goes_on = done < 0.5
        normal, first, second = (
            choose(goes_on, one[0], normal),
            choose(goes_on, one[1], first),
            choose(goes_on, one[2], second),
        )
        status, jammed = choose(goes_on, one[3], status), choose(goes_on, one[4], jammed)
        give, beyond = choose(goes_on, softer, give), choose(goes_on, further, beyond)
        reached = -(gap + w[0] * normal - w[1] * first - w[2] * second)
        softer, further = give_of(reached, earlier, yields, w[0], step, zero)
        done = choose(goes_on, is_settled(reached, normal, softer, further, gap, yields), 1.0)
        if everywhere(done > 0.5):
            break
    return normal, first, second, status, jammed, give, beyond


@numba.njit(**OPTIONS)
def yields_anywhere(yields):
    """Return whether a contact yields in any run."""
    return anywhere(yields[0] > 0.0)
