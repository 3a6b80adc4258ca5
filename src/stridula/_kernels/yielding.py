"""Step 5 for contacts with a stiffness: a force that grows with the indentation replaces the unilateral constraint."""

from typing import Any

from . import layout as at
from .compiled import called, inlined, pasted
from .contact_values import Before, BeforeInSpace, Compliance, Indentations, Yielding
from .lanes import Array, Number, Numbers, Pair, Runs, anywhere, choose, everywhere, held, magnitude
from .pressing import press, share_of
from .solves import forces_of_one
from .space import softened_in_space, solve_in_space

# Smallest slope of the force, times the compliance of the bodies: where the force falls or is flat, Newton's method
# takes this slope, which only costs it a few more steps.
FLATTEST = 1e-4
# Largest number of steps of Newton's method, and the relative change of the indentation that counts as round-off.
STEPS, SETTLED = 40, 1e-14


@inlined
def yields_of(i: int, constants: Array, runs: Runs) -> Yielding:
    """Return how contact `i` yields."""
    base = i * at.CONTACT_CONSTANTS
    return Yielding(
        held(constants, base + at.YIELD_STIFFNESS, runs),
        held(constants, base + at.YIELD_EXPONENT, runs),
        held(constants, base + at.YIELD_DAMPING, runs),
        held(constants, base + at.YIELD_RATE, runs),
        held(constants, base + at.YIELD_REACH, runs),
    )


@inlined
def path_of(i: int, carried: Array, runs: Runs) -> Indentations:
    """Return the indentations of contact `i` at the last three steps, the latest first."""
    base = i * at.CARRIED
    return Indentations(
        -held(carried, base + at.LAST_GAP, runs),
        -held(carried, base + at.EARLIER_GAP, runs),
        -held(carried, base + at.EARLIEST_GAP, runs),
    )


@inlined
def comes_close(i: int, gap: Number, constants: Array, carried: Array, runs: Runs) -> Number:
    """Return where a contact has to be solved: it would overlap, or was indented in the last two steps."""
    soft = held(constants, i * at.CONTACT_CONSTANTS + at.YIELD_STIFFNESS, runs) > 0.0
    now, before, _ = path_of(i, carried, runs)
    was = choose(soft, choose(now > before, now, before), runs.zero)
    return choose(gap < 0.0, 1.0, choose(was > 0.0, 1.0, runs.zero))


@inlined
def softened(w: Compliance, give: Number) -> Compliance:
    """Return a compliance with an additional one of the normal."""
    return Compliance(w.nn + give, w.nt, w.tn, w.tt)


@inlined
def give_of(
    x: Number,
    path: Indentations,
    yields: Yielding,
    share: Number,
    w_nn: Number,
    step: Number,
    zero: Number,
) -> Pair:
    """Return the linearised yielding about an indentation: give for a unit of force, and indentation without force."""
    force, slope = press(x, path, yields, share, step)
    least = FLATTEST / w_nn
    give = 1.0 / choose(slope > least, slope, least)
    soft = yields.stiffness > 0.0
    return choose(soft, give, zero), choose(soft, x - give * force, zero)


@inlined
def is_settled(
    reached: Number, normal: Number, give: Number, beyond: Number, w_nn: Number, gap: Number, yields: Yielding
) -> Number:
    """Return whether an indentation agrees with its force, for the linearised yielding `give` and `beyond` there."""
    left = (reached - beyond - give * normal) * w_nn / (w_nn + give)
    near = magnitude(left) <= SETTLED * (magnitude(reached) + magnitude(gap))
    return choose(yields.stiffness > 0.0, choose(near, 1.0, 0.0), 1.0)


@pasted
def forces_of_any(
    free: tuple[Number, Number, Number, Compliance],
    friction: tuple[int, Array, int, Number],
    before: Before,
    let_go: Number,
    step: Number,
    yields: Yielding,
    path: Indentations,
    zero: Number,
) -> Numbers:
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


@called
def forces_yielding(
    free: tuple[Any, ...],
    friction: tuple[int, Array, int, Number],
    before: Before,
    let_go: Number,
    step: Number,
    yields: Yielding,
    path: Indentations,
    zero: Number,
) -> Numbers:
    """Do `forces_of_any` for a contact that yields, by Newton's method for the indentation, from that without force.

    Runs with a rigid contact beside it are solved once. It is called, not inlined: rigid contacts do not pay for it.
    """
    gap, slip, away, w = free
    law, laws, number, at_rest = friction
    done = zero
    normal, tangential, status, jammed, give, beyond = zero, zero, zero, zero, zero, zero
    share = share_of(-gap, path, yields)
    softer, further = give_of(-gap, path, yields, share, w.nn, step, zero)
    for _ in range(STEPS):
        one = forces_of_one(
            gap + further,
            slip,
            away,
            softened(w, softer),
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
        reached = -(gap + w.nn * normal - w.nt * tangential)
        softer, further = give_of(reached, path, yields, share, w.nn, step, zero)
        done = choose(goes_on, is_settled(reached, normal, softer, further, w.nn, gap, yields), 1.0)
        if everywhere(done > 0.5):
            break
    return normal, tangential, status, jammed, give, beyond


@pasted
def forces_of_any_in_space(
    free: tuple[Any, ...],
    friction: tuple[int, Array, int],
    before: BeforeInSpace,
    let_go: Number,
    step: Number,
    yields: Yielding,
    path: Indentations,
    zero: Number,
) -> Numbers:
    """Do `forces_of_any` for a contact in space, as `solve_in_space`."""
    if yields_anywhere(yields):
        return forces_yielding_in_space(free, friction, before, let_go, step, yields, path, zero)
    gap, slips, strays, w = free
    law, laws, number = friction
    one = solve_in_space(gap, slips, strays, w, law, laws, number, before, let_go, step)
    return one[0], one[1], one[2], one[3], one[4], zero, zero


@called
def forces_yielding_in_space(
    free: tuple[Any, ...],
    friction: tuple[int, Array, int],
    before: BeforeInSpace,
    let_go: Number,
    step: Number,
    yields: Yielding,
    path: Indentations,
    zero: Number,
) -> Numbers:
    """Do `forces_yielding` for a contact in space."""
    gap, slips, strays, w = free
    law, laws, number = friction
    done = zero
    normal, first, second, status, jammed, give, beyond = zero, zero, zero, zero, zero, zero, zero
    share = share_of(-gap, path, yields)
    softer, further = give_of(-gap, path, yields, share, w.nn, step, zero)
    for _ in range(STEPS):
        one = solve_in_space(
            gap + further, slips, strays, softened_in_space(w, softer), law, laws, number, before, let_go, step
        )
        goes_on = done < 0.5
        normal, first, second = (
            choose(goes_on, one[0], normal),
            choose(goes_on, one[1], first),
            choose(goes_on, one[2], second),
        )
        status, jammed = choose(goes_on, one[3], status), choose(goes_on, one[4], jammed)
        give, beyond = choose(goes_on, softer, give), choose(goes_on, further, beyond)
        reached = -(gap + w.nn * normal - w.na * first - w.nb * second)
        softer, further = give_of(reached, path, yields, share, w.nn, step, zero)
        done = choose(goes_on, is_settled(reached, normal, softer, further, w.nn, gap, yields), 1.0)
        if everywhere(done > 0.5):
            break
    return normal, first, second, status, jammed, give, beyond


@inlined
def yields_anywhere(yields: Yielding) -> bool:
    """Return whether a contact yields in any run."""
    return anywhere(yields.stiffness > 0.0)
