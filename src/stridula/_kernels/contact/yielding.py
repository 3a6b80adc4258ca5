"""Step 5 for contacts with a stiffness: a force that grows with the indentation replaces the unilateral constraint."""

from typing import Any

from ..lanes.compiled import called, inlined, pasted
from ..lanes.operations import Array, Number, Pair, Runs, anywhere, choose, everywhere, held, hold, magnitude
from ..layout import columns as at
from ..layout.contact_values import (
    Compliance,
    ComplianceInSpace,
    Free,
    FreeInSpace,
    Indentations,
    Law,
    Tangents,
    Touch,
    TouchInSpace,
    Way,
    Yielding,
)
from ..layout.parts import Contacts
from .in_space import solve_in_space
from .lanewise import choose_all
from .pressing import press, share_of
from .solves import law_of, solve_in_plane

# Tells the types apart while compiling: branches for the other are left out, unless the function is pasted.
IN_PLANE = len(Free._fields)

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
def about_indentation(free: Any, give: Number, beyond: Number) -> Any:
    """Return a contact of the plane or of space that yields linearly about an indentation as a rigid one."""
    gap, w, let_go = free.gap + beyond, free.w, free.let_go
    if len(free) == IN_PLANE:
        return Free(gap, free.slip, free.strayed, Compliance(w.nn + give, w.nt, w.tn, w.tt), let_go)
    w = ComplianceInSpace(w.nn + give, w.na, w.nb, w.an, w.aa, w.ab, w.bn, w.ba, w.bb)
    return FreeInSpace(gap, free.slips, free.strays, w, let_go, free.guess)


@inlined
def gap_under(free: Any, touch: Any) -> Number:
    """Return the gap of a contact of the plane or of space under its own forces."""
    pressed, w = free.gap + free.w.nn * touch.normal, free.w
    if len(free) == IN_PLANE:
        return pressed - w.nt * touch.tangential
    return pressed - w.na * touch.tangential.a - w.nb * touch.tangential.b


@inlined
def solve_rigid(free: Any, law: Law, before: Any, step: Number, zero: Number) -> Any:
    """Return the contact of the plane or of space with the compliance given."""
    if len(free) == IN_PLANE:
        return solve_in_plane(free, law, before, step, zero)
    return solve_in_space(free, law, before, step)


@inlined
def without_forces(free: Any, zero: Number) -> Any:
    """Return a contact of the plane or of space without forces."""
    if len(free) == IN_PLANE:
        return Touch(zero, zero, zero, zero, Way(zero, zero, zero))
    return TouchInSpace(zero, Tangents(zero, zero), zero, zero)


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
def solve_any(
    free: Any, law: Law, before: Any, yields: Yielding, path: Indentations, step: Number, zero: Number
) -> tuple[Any, Number, Number]:
    """Return a contact of the plane or of space that may yield, its give and the indentation beyond that.

    `path` are the indentations of the last three steps.
    """
    if yields_anywhere(yields):
        return solve_yielding(free, law, before, yields, path, step, zero)
    return solve_rigid(free, law, before, step, zero), zero, zero


@called
def solve_yielding(
    free: Any, law: Law, before: Any, yields: Yielding, path: Indentations, step: Number, zero: Number
) -> tuple[Any, Number, Number]:
    """Do `solve_any` for a contact that yields, by Newton's method for the indentation, from that without force.

    Runs with a rigid contact beside it are solved once. It is called, not inlined: rigid contacts do not pay for it.
    """
    gap, own, done = free.gap, free.w.nn, zero
    touch, give, beyond = without_forces(free, zero), zero, zero
    share = share_of(-gap, path, yields)
    softer, further = give_of(-gap, path, yields, share, own, step, zero)
    for _ in range(STEPS):
        goes_on = done < 0.5
        found = solve_rigid(about_indentation(free, softer, further), law, before, step, zero)
        touch = choose_all(goes_on, found, touch)
        give, beyond = choose(goes_on, softer, give), choose(goes_on, further, beyond)
        reached = -gap_under(free, touch)
        softer, further = give_of(reached, path, yields, share, own, step, zero)
        done = choose(goes_on, is_settled(reached, touch.normal, softer, further, own, gap, yields), 1.0)
        if everywhere(done > 0.5):
            break
    return touch, give, beyond


@pasted
def solve_and_keep(i: int, free: Any, before: Any, contacts: Contacts, carried: Array, step: Number, runs: Runs) -> Any:
    """Solve contact `i` of the plane or of space, and keep how it yields."""
    yields, path = yields_of(i, contacts.constants, runs), path_of(i, carried, runs)
    law = law_of(i, contacts, runs)
    touch, give, beyond = solve_any(free, law, before, yields, path, step, runs.zero)
    hold(contacts.now, i * at.IN_STEP + at.GIVE, runs, give)
    hold(contacts.now, i * at.IN_STEP + at.BEYOND, runs, beyond)
    return touch


@inlined
def yields_anywhere(yields: Yielding) -> bool:
    """Return whether a contact yields in any run."""
    return anywhere(yields.stiffness > 0.0)
