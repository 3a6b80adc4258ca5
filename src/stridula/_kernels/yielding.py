"""Step 5 for contacts with a stiffness: a force that grows with the indentation replaces the unilateral constraint."""

import numba

from . import layout as at
from .lanes import anywhere, choose, everywhere, held, magnitude
from .modes import INNER, OPTIONS, PASTED
from .pressing import press, share_of
from .solves import forces_of_one
from .space import solve_in_space

# Smallest slope of the force, times the compliance of the bodies: where the force falls or is flat, Newton's method
# takes this slope, which only costs it a few more steps.
FLATTEST = 1e-4
# Largest number of steps of Newton's method, and the relative change of the indentation that counts as round-off.
STEPS, SETTLED = 40, 1e-14


@numba.njit(**OPTIONS)
def yields_of(i, constants, run, zero):
    """Return stiffness, its exponent, damping, damping rate and reach of contact `i`; rigid ones have no stiffness."""
    base = i * at.CONTACT_CONSTANTS
    return (
        held(constants, base + at.YIELD_STIFFNESS, run, zero),
        held(constants, base + at.YIELD_EXPONENT, run, zero),
        held(constants, base + at.YIELD_DAMPING, run, zero),
        held(constants, base + at.YIELD_RATE, run, zero),
        held(constants, base + at.YIELD_REACH, run, zero),
    )


@numba.njit(**OPTIONS)
def path_of(i, carried, run, zero):
    """Return the indentations of contact `i` at the last three steps, the latest first."""
    base = i * at.CARRIED
    return (
        -held(carried, base + at.LAST_GAP, run, zero),
        -held(carried, base + at.EARLIER_GAP, run, zero),
        -held(carried, base + at.EARLIEST_GAP, run, zero),
    )


@numba.njit(**OPTIONS)
def comes_close(i, gap, constants, carried, run, zero):
    """Return where a contact has to be solved: it would overlap, or was indented in the last two steps."""
    soft = held(constants, i * at.CONTACT_CONSTANTS + at.YIELD_STIFFNESS, run, zero) > 0.0
    now, before, _ = path_of(i, carried, run, zero)
    was = choose(soft, choose(now > before, now, before), zero)
    return choose(gap < 0.0, 1.0, choose(was > 0.0, 1.0, zero))


@numba.njit(**OPTIONS)
def give_of(x, path, yields, share, w_nn, step, zero):
    """Return the linearised yielding about an indentation: give for a unit of force, and indentation without force."""
    force, slope = press(x, path, yields, share, step)
    least = FLATTEST / w_nn
    give = 1.0 / choose(slope > least, slope, least)
    soft = yields[0] > 0.0
    return choose(soft, give, zero), choose(soft, x - give * force, zero)


@numba.njit(**OPTIONS)
def is_settled(reached, normal, give, beyond, w_nn, gap, yields):
    """Return whether an indentation agrees with its force, for the linearised yielding `give` and `beyond` there."""
    left = (reached - beyond - give * normal) * w_nn / (w_nn + give)
    near = magnitude(left) <= SETTLED * (magnitude(reached) + magnitude(gap))
    return choose(yields[0] > 0.0, choose(near, 1.0, 0.0), 1.0)


@numba.njit(**PASTED)
def forces_of_any(free, friction, before, let_go, step, yields, path, zero):
    """Return the result of `forces_of_one` for a contact that may yield, its give and the indentation beyond that.

    `free` are gap, slip, distance of a stick from its anchor, compliance; `friction` the law, all laws, the number
    among these and the ratio at rest; `path` the indentations of the last three steps.
    """
    if yields_anywhere(yields):
        return forces_yielding(free, friction, before, let_go, step, yields, path, zero)
    gap, slip, away, w = free
    law, laws, number, at_rest = friction
    one = forces_of_one(gap, slip, away, w, law, laws, number, at_rest, before, let_go, step, zero)
    return one[0], one[1], one[2], one[3], zero, zero


@numba.njit(**INNER)
def forces_yielding(free, friction, before, let_go, step, yields, path, zero):
    """Do `forces_of_any` for a contact that yields, by Newton's method for the indentation, from that without force.

    Runs with a rigid contact beside it are solved once. It is called, not inlined: rigid contacts do not pay for it.
    """
    gap, slip, away, w = free
    law, laws, number, at_rest = friction
    done = zero
    normal, tangential, status, jammed, give, beyond = zero, zero, zero, zero, zero, zero
    share = share_of(-gap, path, yields)
    softer, further = give_of(-gap, path, yields, share, w[0], step, zero)
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
        softer, further = give_of(reached, path, yields, share, w[0], step, zero)
        done = choose(goes_on, is_settled(reached, normal, softer, further, w[0], gap, yields), 1.0)
        if everywhere(done > 0.5):
            break
    return normal, tangential, status, jammed, give, beyond


@numba.njit(**PASTED)
def forces_of_any_in_space(free, friction, before, let_go, step, yields, path, zero):
    """Do `forces_of_any` for a contact in space, as `solve_in_space`."""
    if yields_anywhere(yields):
        return forces_yielding_in_space(free, friction, before, let_go, step, yields, path, zero)
    gap, slips, strays, w = free
    law, laws, number = friction
    one = solve_in_space(gap, slips, strays, w, law, laws, number, before, let_go, step)
    return one[0], one[1], one[2], one[3], one[4], zero, zero


@numba.njit(**INNER)
def forces_yielding_in_space(free, friction, before, let_go, step, yields, path, zero):
    """Do `forces_yielding` for a contact in space."""
    gap, slips, strays, w = free
    law, laws, number = friction
    done = zero
    normal, first, second, status, jammed, give, beyond = zero, zero, zero, zero, zero, zero, zero
    share = share_of(-gap, path, yields)
    softer, further = give_of(-gap, path, yields, share, w[0], step, zero)
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
        softer, further = give_of(reached, path, yields, share, w[0], step, zero)
        done = choose(goes_on, is_settled(reached, normal, softer, further, w[0], gap, yields), 1.0)
        if everywhere(done > 0.5):
            break
    return normal, first, second, status, jammed, give, beyond


@numba.njit(**OPTIONS)
def yields_anywhere(yields):
    """Return whether a contact yields in any run."""
    return anywhere(yields[0] > 0.0)
