"""Direct solve for the forces of all contacts, from their last states: linear systems, until no state has to change.

The unknowns are the normal forces of closed contacts and the tangential forces of held contacts; where a contact
slides, its tangential force is the last ratio times its normal force. Then contacts that pull open, open contacts that
overlap close, contacts held beyond their cone slide and contacts that slide against their friction are held: an active
set. The system lies in blocks like the compliance, ``scratch[row, block, lane]``: a row for each unknown, with its
displacements at all equations, a row for right sides, then those named below. Runs side by side share all equations.
Nothing is compiled for contacts in space if `space` is None.
"""

import math

from ..contact.exact import SLIDING, STICKING
from ..contact.friction import set_valued
from ..contact.in_space import direction, displaced_in_space, strayed_in_space
from ..contact.pressing import share_of
from ..contact.solves import strayed_in_plane
from ..contact.tangents import choose_along, held_along, hold_along, plus, scaled
from ..contact.yielding import give_of, path_of, yields_anywhere, yields_of
from ..lanes.compiled import inlined
from ..lanes.operations import (
    Array,
    Number,
    Numbers,
    Pair,
    Runs,
    anywhere,
    choose,
    component,
    fused,
    held,
    hold,
    lane,
    load,
    magnitude,
    set_component,
    store,
)
from ..layout import columns as at
from ..layout.contact_values import Tangents
from ..layout.parts import Contacts, Sizes
from ..layout.rows import COMPLIANCE, DISPLACEMENT, has_b
from .displacements import displace, displace_in_space

# Rows of the scratch before its end: displacements to restore, multipliers of two unknowns, displacements under a
# normal force with its tangential force, and whether a run has an equation.
SAVED, MULTIPLIERS, MORE_MULTIPLIERS, ALONG, HAS = range(-5, 0)
# Before these lie masks of the lanes of a block that follow each lane, last lane first.
# Rows of the scratch other than the masks and those of the unknowns.
FURTHER_ROWS = 6

# Ratio by which a force may exceed its cone by rounding.
BEYOND = 1.0 + 1e-9
# Largest number of systems solved before giving up, and of successive systems without fewer contacts at odds in which
# all of these change state; after that only the last of them changes (Judice & Pires 1994).
TRIALS, BLOCKS_IN_VAIN = 100, 3
# Overlap of an open contact that is rounding, relative to the largest displacement without forces.
TOUCH = 1e-12


@inlined
def solve_states(
    space: bool | None, contacts: Contacts, carried: Array, sizes: Sizes, step: Number, runs: Runs, tried: Number
) -> Number:
    """Solve for forces, states and displacements of all contacts, with the ratios of sliding kept, in runs `tried`.

    Nothing changes in runs where no consistent states are found; returns where that is so.
    """
    now, scratch = contacts.now, contacts.scratch
    keep_found(space, contacts, sizes, runs)
    slack = TOUCH * farthest(space, now, sizes.contacts, runs)
    active, given_up = choose(tried > 0.5, 1.0, runs.zero), runs.zero
    fewest, vain = runs.zero + math.inf, runs.zero
    for _ in range(TRIALS):
        size = number_equations(space, contacts, sizes.contacts, runs)
        for j in range(sizes.contacts):
            if equation(now, j, at.NORMAL_EQUATION, runs) >= 0:
                put_columns(space, contacts, sizes, j, size, runs)
                put_rights(space, contacts, carried, j, size, runs)
        regular = eliminate(scratch, size, sizes.per_block, runs, active)
        for j in range(sizes.contacts):
            if equation(now, j, at.NORMAL_EQUATION, runs) >= 0:
                take(space, contacts, sizes, j, size, regular, runs)
        given_up = choose(active - regular > 0.5, 1.0, given_up)
        at_odds, last, fails = compare(space, contacts, carried, sizes, slack, regular, runs)
        given_up = choose(fails > 0.5, 1.0, given_up)
        active = choose(given_up > 0.5, runs.zero, choose(at_odds > 0.5, regular, runs.zero))
        if not anywhere(active > 0.5):
            break
        vain = choose(at_odds < fewest, runs.zero, vain + 1.0)
        fewest = choose(at_odds < fewest, at_odds, fewest)
        for j in range(sizes.contacts):
            alone = choose(vain > BLOCKS_IN_VAIN, choose(magnitude(last - j) < 0.5, active, runs.zero), active)
            change(space, contacts, carried, sizes, j, step, alone, runs)
    given_up = choose(active > 0.5, 1.0, given_up)
    put_back(space, contacts, sizes, given_up, runs)
    return given_up


@inlined
def farthest(space: bool | None, now: Array, count: int, runs: Runs) -> Number:
    """Return the largest gap or slip of all contacts without their forces."""
    found = runs.zero
    for i in range(count):
        gap = magnitude(held(now, i * at.IN_STEP + at.FREE_GAP, runs))
        slip = magnitude(held(now, i * at.IN_STEP + at.FREE_SLIP, runs))
        found = choose(gap > found, gap, found)
        found = choose(slip > found, slip, found)
        if space is not None:
            slip = magnitude(held(now, i * at.IN_STEP + at.FREE_SLIP_B, runs))
            found = choose(slip > found, slip, found)
    return found


@inlined
def keep_found(space: bool | None, contacts: Contacts, sizes: Sizes, runs: Runs) -> None:
    """Save forces, states and displacements to restore, and set the ratios of sliding contacts."""
    now, saved = contacts.now, contacts.scratch.shape[0] + SAVED
    for i in range(sizes.contacts):
        here = i * at.IN_STEP
        normal, tangential, status = (
            held(now, here + at.NORMAL_NOW, runs),
            held(now, here + at.TANGENTIAL_NOW, runs),
            held(now, here + at.STATUS_NOW, runs),
        )
        hold(now, here + at.NORMAL_KEPT, runs, normal)
        hold(now, here + at.TANGENTIAL_KEPT, runs, tangential)
        hold(now, here + at.STATUS_KEPT, runs, status)
        ratio = choose(normal > 0.0, tangential, runs.zero) / choose(normal > 0.0, normal, 1.0)
        hold(now, here + at.RATIO, runs, ratio)
        if space is not None:
            tangential = held(now, here + at.TANGENTIAL_NOW_B, runs)
            hold(now, here + at.TANGENTIAL_KEPT_B, runs, tangential)
            ratio = choose(normal > 0.0, tangential, runs.zero) / choose(normal > 0.0, normal, 1.0)
            hold(now, here + at.RATIO_B, runs, ratio)
    for k in range(sizes.rows):
        set_component(contacts.scratch, k, saved, runs, component(contacts.faces, k, DISPLACEMENT, runs))


@inlined
def put_back(space: bool | None, contacts: Contacts, sizes: Sizes, given_up: Number, runs: Runs) -> None:
    """Restore the saved values in runs that are given up."""
    if not anywhere(given_up > 0.5):
        return
    now, saved = contacts.now, contacts.scratch.shape[0] + SAVED
    for i in range(sizes.contacts):
        here = i * at.IN_STEP
        for row, kept in (
            (at.NORMAL_NOW, at.NORMAL_KEPT),
            (at.TANGENTIAL_NOW, at.TANGENTIAL_KEPT),
            (at.STATUS_NOW, at.STATUS_KEPT),
        ):
            found = held(now, here + row, runs)
            hold(now, here + row, runs, choose(given_up > 0.5, held(now, here + kept, runs), found))
        if space is not None:
            found, kept_b = held(now, here + at.TANGENTIAL_NOW_B, runs), held(now, here + at.TANGENTIAL_KEPT_B, runs)
            hold(now, here + at.TANGENTIAL_NOW_B, runs, choose(given_up > 0.5, kept_b, found))
    for k in range(sizes.rows):
        found = component(contacts.faces, k, DISPLACEMENT, runs)
        before = component(contacts.scratch, k, saved, runs)
        set_component(contacts.faces, k, DISPLACEMENT, runs, choose(given_up > 0.5, before, found))


@inlined
def compare(
    space: bool | None, contacts: Contacts, carried: Array, sizes: Sizes, slack: Number, active: Number, runs: Runs
) -> Numbers:
    """Set the state that each contact wants, in runs that are `active`.

    Under laws other than Coulomb's, only a sweep decides when a contact breaks away or comes to rest.

    Returns
    -------
    at_odds, last : float or vector
        Number of contacts that want another state, and the index of the last of them.
    fails : float or vector
        Where a contact has no consistent state.
    """
    now, at_odds, last, fails = contacts.now, runs.zero, runs.zero - 1.0, runs.zero
    for j in range(sizes.contacts):
        here = j * at.IN_STEP
        status, normal = held(now, here + at.STATUS_NOW, runs), held(now, here + at.NORMAL_NOW, runs)
        gap = component(contacts.faces, contacts.rows[j], DISPLACEMENT, runs)
        closed, sticks = status > 0.5 * STICKING, magnitude(status - STICKING) < 0.5
        wanted = choose(
            closed, choose(normal < 0.0, runs.zero, status), choose(gap < -slack, runs.zero + SLIDING, runs.zero)
        )
        if set_valued(contacts.codes[j]):
            square, power = pulled_with(space, contacts, carried, j, runs)
            most = BEYOND * held(contacts.constants, j * at.CONTACT_CONSTANTS + at.AT_REST, runs) * normal
            beyond = choose(sticks, square, runs.zero) > most * most
            breaks = choose(beyond, choose(normal < 0.0, runs.zero, 1.0), runs.zero)
            if contacts.codes[j] == at.COULOMB:
                wanted = choose(breaks > 0.5, runs.zero + SLIDING, wanted)
                free = held(now, here + at.LET_GO, runs) > 0.5
                against = choose(free, runs.zero, power) < 0.0
                slides = choose(sticks, runs.zero, choose(normal < 0.0, runs.zero, 1.0))
                wanted = choose(choose(against, slides, runs.zero) > 0.5, runs.zero + STICKING, wanted)
            else:
                fails = choose(choose(active > 0.5, breaks, runs.zero) > 0.5, 1.0, fails)
        wanted = choose(active > 0.5, wanted, status)
        odd = magnitude(wanted - status) > 0.5
        at_odds += choose(odd, 1.0, runs.zero)
        last = choose(odd, runs.zero + float(j), last)
        hold(now, here + at.STATUS_WANTED, runs, wanted)
    return at_odds, last, fails


@inlined
def pulled_with(space: bool | None, contacts: Contacts, carried: Array, j: int, runs: Runs) -> Pair:
    """Return the square of the tangential force of contact `j`, and its product with the velocity that it opposes."""
    here = j * at.IN_STEP
    if space is not None and has_b(contacts.rows, j):
        pulled = held_along(contacts.now, here + at.TANGENTIAL_NOW, here + at.TANGENTIAL_NOW_B, runs)
        velocity = velocity_in_space(contacts, carried, j, runs)
        return pulled.a * pulled.a + pulled.b * pulled.b, pulled.a * velocity.a + pulled.b * velocity.b
    pull = held(contacts.now, here + at.TANGENTIAL_NOW, runs)
    return pull * pull, pull * (9.0 * component(contacts.faces, contacts.rows[j] + 1, DISPLACEMENT, runs))


@inlined
def velocity_in_space(contacts: Contacts, carried: Array, i: int, runs: Runs) -> Tangents:
    """Return the velocity of contact `i` that friction opposes, in units of a ninth of a slip."""
    base = i * at.CARRIED
    _, slips = displaced_in_space(contacts.faces, contacts.rows[i], runs)
    last = held_along(carried, base + at.LAST_SLIP, base + at.LAST_SLIP_B, runs)
    earlier = held_along(carried, base + at.EARLIER_SLIP, base + at.EARLIER_SLIP_B, runs)
    late = held(contacts.now, i * at.IN_STEP + at.LET_GO, runs) > 0.0
    carried_on = choose_along(late, Tangents(runs.zero, runs.zero), plus(scaled(6.0, last), 1.0, earlier))
    return plus(scaled(9.0, slips), 1.0, carried_on)


@inlined
def change(
    space: bool | None,
    contacts: Contacts,
    carried: Array,
    sizes: Sizes,
    j: int,
    step: Number,
    active: Number,
    runs: Runs,
) -> None:
    """Give contact `j` the state that it wants, in runs that are `active`."""
    now, here = contacts.now, j * at.IN_STEP
    status, wanted = held(now, here + at.STATUS_NOW, runs), held(now, here + at.STATUS_WANTED, runs)
    wanted = choose(active > 0.5, wanted, status)
    if not anywhere(magnitude(wanted - status) > 0.5):
        return
    opens = choose(wanted < 0.5 * STICKING, status, runs.zero) > 0.5 * STICKING
    closes = choose(status < 0.5 * STICKING, wanted, runs.zero) > 0.5 * STICKING
    moves = choose(status < SLIDING - 0.5, wanted, runs.zero) > SLIDING - 0.5
    stops = choose(wanted < SLIDING - 0.5, status, runs.zero) > SLIDING - 0.5
    hold(now, here + at.STATUS_NOW, runs, wanted)
    hold(now, here + at.JAMMED_NOW, runs, choose(closes, runs.zero, held(now, here + at.JAMMED_NOW, runs)))
    hold(now, here + at.MAY_TOUCH, runs, choose(closes, 1.0, held(now, here + at.MAY_TOUCH, runs)))
    hold(now, here + at.BROKE, runs, choose(moves, 1.0, held(now, here + at.BROKE, runs)))
    soften_closed(contacts, carried, j, closes, step, runs)
    # A contact that closes slides in the direction of its motion, one that breaks away in that of its force.
    in_space = False
    if space is not None:
        in_space = has_b(contacts.rows, j)
        if in_space:
            pulled = held_along(now, here + at.TANGENTIAL_NOW, here + at.TANGENTIAL_NOW_B, runs)
            way = choose_along(closes, velocity_in_space(contacts, carried, j, runs), pulled)
            way = direction(way, Tangents(runs.zero, runs.zero))
            set_ratio(contacts, j, at.RATIO, moves, stops, way.a, runs)
            set_ratio(contacts, j, at.RATIO_B, moves, stops, way.b, runs)
            let_open_in_space(contacts, sizes, j, opens, runs)
    if not in_space:
        slip = component(contacts.faces, contacts.rows[j] + 1, DISPLACEMENT, runs)
        along = choose(closes, 9.0 * slip, held(now, here + at.TANGENTIAL_NOW, runs))
        set_ratio(contacts, j, at.RATIO, moves, stops, sense_of(along, runs), runs)
        let_open(contacts, sizes, j, opens, runs)


@inlined
def sense_of(along: Number, runs: Runs) -> Number:
    """Return 1 or -1 with the sign of a force or a motion, 1 for none."""
    return choose(along < 0.0, runs.zero - 1.0, 1.0)


@inlined
def set_ratio(
    contacts: Contacts, j: int, column: int, moves: bool, stops: bool, component_of_way: Number, runs: Runs
) -> None:
    """Set the ratio along a tangent of contact `j`: that of its cone where it now moves, none where it stops."""
    now, row = contacts.now, j * at.IN_STEP + column
    at_rest = held(contacts.constants, j * at.CONTACT_CONSTANTS + at.AT_REST, runs)
    ratio = choose(moves, at_rest * component_of_way, held(now, row, runs))
    hold(now, row, runs, choose(stops, runs.zero, ratio))


@inlined
def let_open(contacts: Contacts, sizes: Sizes, j: int, opens: bool, runs: Runs) -> None:
    """Take away the forces of contact `j` where it opens."""
    now, here = contacts.now, j * at.IN_STEP
    normal, pulled = held(now, here + at.NORMAL_NOW, runs), held(now, here + at.TANGENTIAL_NOW, runs)
    pressed, left = choose(opens, runs.zero, normal), choose(opens, runs.zero, pulled)
    hold(now, here + at.NORMAL_NOW, runs, pressed)
    hold(now, here + at.TANGENTIAL_NOW, runs, left)
    displace(contacts.faces, sizes.faces, contacts.rows[j], runs, pressed - normal, left - pulled)


@inlined
def let_open_in_space(contacts: Contacts, sizes: Sizes, j: int, opens: bool, runs: Runs) -> None:
    """Do `let_open` for a contact in space."""
    now, here = contacts.now, j * at.IN_STEP
    normal = held(now, here + at.NORMAL_NOW, runs)
    pulled = held_along(now, here + at.TANGENTIAL_NOW, here + at.TANGENTIAL_NOW_B, runs)
    pressed = choose(opens, runs.zero, normal)
    left = choose_along(opens, Tangents(runs.zero, runs.zero), pulled)
    hold(now, here + at.NORMAL_NOW, runs, pressed)
    hold_along(now, here + at.TANGENTIAL_NOW, here + at.TANGENTIAL_NOW_B, runs, left)
    less = plus(left, -1.0, pulled)
    displace_in_space(contacts.faces, sizes.faces, contacts.rows[j], runs, pressed - normal, less)


@inlined
def soften_closed(contacts: Contacts, carried: Array, j: int, closes: bool, step: Number, runs: Runs) -> None:
    """Set the yielding of contact `j` about its indentation, in runs in which it has closed."""
    yields = yields_of(j, contacts.constants, runs)
    if not yields_anywhere(yields):
        return
    here, n = j * at.IN_STEP, contacts.rows[j]
    own = component(contacts.faces, n, COMPLIANCE + n, runs)
    indented = -component(contacts.faces, n, DISPLACEMENT, runs)
    path = path_of(j, carried, runs)
    share = share_of(indented, path, yields)
    give, beyond = give_of(indented, path, yields, share, own, step, runs.zero)
    hold(contacts.now, here + at.GIVE, runs, choose(closes, give, held(contacts.now, here + at.GIVE, runs)))
    kept = held(contacts.now, here + at.BEYOND, runs)
    hold(contacts.now, here + at.BEYOND, runs, choose(closes, beyond, kept))


@inlined
def equation(now: Array, i: int, which: int, runs: Runs) -> int:
    """Return the number of an equation of contact `i`, the same in all runs, below 0 without one."""
    return int(lane(held(now, i * at.IN_STEP + which, runs), 0))


@inlined
def number_equations(space: bool | None, contacts: Contacts, count: int, runs: Runs) -> int:
    """Number the equations of all contacts, set their places and whether a run has each; return their number."""
    now, size = contacts.now, 0
    for i in range(count):
        here, n = i * at.IN_STEP, contacts.rows[i]
        status = held(now, here + at.STATUS_NOW, runs)
        closed, sticks = choose(status > 0.5 * STICKING, 1.0, runs.zero), magnitude(status - STICKING) < 0.5
        holds = choose(sticks, 1.0, runs.zero) if set_valued(contacts.codes[i]) else runs.zero
        size = number_equation(contacts, here + at.NORMAL_EQUATION, n, closed, size, runs)
        size = number_equation(contacts, here + at.TANGENTIAL_EQUATION, n + 1, holds, size, runs)
        hold(now, here + at.RATIO, runs, choose(holds > 0.5, runs.zero, held(now, here + at.RATIO, runs)))
        if space is not None and has_b(contacts.rows, i):
            size = number_equation(contacts, here + at.TANGENTIAL_EQUATION_B, n + 2, holds, size, runs)
            hold(now, here + at.RATIO_B, runs, choose(holds > 0.5, runs.zero, held(now, here + at.RATIO_B, runs)))
    return size


@inlined
def number_equation(contacts: Contacts, row: int, place: int, has: Number, size: int, runs: Runs) -> int:
    """Give an equation the number `size` if any run has it, and put that into a row; return the next number."""
    number = -1
    if anywhere(has > 0.5):
        set_component(contacts.scratch, size, contacts.scratch.shape[0] + HAS, runs, has)
        contacts.places[size, runs.first] = place
        number, size = size, size + 1
    hold(contacts.now, row, runs, runs.zero + float(number))
    return size


@inlined
def is_closed(now: Array, i: int, runs: Runs) -> bool:
    """Return whether contact `i` is closed."""
    return held(now, i * at.IN_STEP + at.STATUS_NOW, runs) > 0.5 * STICKING


@inlined
def is_held(now: Array, i: int, runs: Runs) -> bool:
    """Return whether contact `i` sticks; one with an equation of its tangential force is then held."""
    return magnitude(held(now, i * at.IN_STEP + at.STATUS_NOW, runs) - STICKING) < 0.5


@inlined
def put_columns(space: bool | None, contacts: Contacts, sizes: Sizes, j: int, size: int, runs: Runs) -> None:
    """Set the displacements under the forces of contact `j` at every equation."""
    now, faces, scratch, here = contacts.now, contacts.faces, contacts.scratch, j * at.IN_STEP
    ratio, n, together = held(now, here + at.RATIO, runs), COMPLIANCE + contacts.rows[j], scratch.shape[0] + ALONG
    for block in range(sizes.faces):
        along = fused(-ratio, load(faces, n + 1, block, runs), load(faces, n, block, runs))
        store(scratch, together, block, runs, along)
    of_tangential = equation(now, j, at.TANGENTIAL_EQUATION, runs)
    if of_tangential >= 0:
        put_column(scratch, contacts.places, faces, n + 1, of_tangential, runs.zero, size, runs)
    if space is not None and has_b(contacts.rows, j):
        ratio = held(now, here + at.RATIO_B, runs)
        for block in range(sizes.faces):
            along = fused(-ratio, load(faces, n + 2, block, runs), load(scratch, together, block, runs))
            store(scratch, together, block, runs, along)
        of_tangential = equation(now, j, at.TANGENTIAL_EQUATION_B, runs)
        if of_tangential >= 0:
            put_column(scratch, contacts.places, faces, n + 2, of_tangential, runs.zero, size, runs)
    of_normal, give = equation(now, j, at.NORMAL_EQUATION, runs), held(now, here + at.GIVE, runs)
    put_column(scratch, contacts.places, scratch, together, of_normal, give, size, runs)


@inlined
def put_column(
    scratch: Array, places: Array, displaced: Array, row: int, column: int, give: Number, size: int, runs: Runs
) -> None:
    """Set the displacements under an unknown at every equation, from a row, with the additional give of its contact.

    The unknown is zero where this run has no such equation.
    """
    has = scratch.shape[0] + HAS
    for i in range(size):
        value = component(displaced, places[i, runs.first], row, runs) * component(scratch, i, has, runs)
        set_component(scratch, i, column, runs, value)
    own, value = component(scratch, column, has, runs), component(scratch, column, column, runs)
    set_component(scratch, column, column, runs, choose(own > 0.5, value + give, 1.0))


@inlined
def put_rights(space: bool | None, contacts: Contacts, carried: Array, j: int, size: int, runs: Runs) -> None:
    """Set the right sides of contact `j`: gap and slip to undo."""
    now, here = contacts.now, j * at.IN_STEP
    gap, beyond = held(now, here + at.FREE_GAP, runs), held(now, here + at.BEYOND, runs)
    put_right(contacts, j, at.NORMAL_EQUATION, is_closed(now, j, runs), gap + beyond, size, runs)
    if space is not None and has_b(contacts.rows, j):
        free = held_along(now, here + at.FREE_SLIP, here + at.FREE_SLIP_B, runs)
        slips = plus(free, 1.0, strayed_in_space(carried, j, runs))
        put_right(contacts, j, at.TANGENTIAL_EQUATION, is_held(now, j, runs), slips.a, size, runs)
        put_right(contacts, j, at.TANGENTIAL_EQUATION_B, is_held(now, j, runs), slips.b, size, runs)
    else:
        slip = held(now, here + at.FREE_SLIP, runs) + strayed_in_plane(carried, j, runs)
        put_right(contacts, j, at.TANGENTIAL_EQUATION, is_held(now, j, runs), slip, size, runs)


@inlined
def put_right(contacts: Contacts, j: int, which: int, has: bool, undone: Number, size: int, runs: Runs) -> None:
    """Set the right side of an equation of contact `j`, if there is one, to undo a displacement where a run has it."""
    number = equation(contacts.now, j, which, runs)
    if number >= 0:
        set_component(contacts.scratch, number, size, runs, choose(has, -undone, runs.zero))


@inlined
def found_tangential(
    contacts: Contacts, j: int, which: int, ratio: Number, normal: Number, size: int, runs: Runs
) -> Number:
    """Return the force of contact `j` along a tangent: from its equation where it is held, else by its ratio."""
    tangential, number = ratio * normal, equation(contacts.now, j, which, runs)
    if number >= 0:
        pulled = -component(contacts.scratch, number, size, runs)
        tangential = choose(is_held(contacts.now, j, runs), pulled, tangential)
    return tangential


@inlined
def take(space: bool | None, contacts: Contacts, sizes: Sizes, j: int, size: int, regular: Number, runs: Runs) -> None:
    """Accept the forces of contact `j` with their displacements, in runs that are `regular`."""
    now, here, n = contacts.now, j * at.IN_STEP, contacts.rows[j]
    normal = held(now, here + at.NORMAL_NOW, runs)
    found = component(contacts.scratch, equation(now, j, at.NORMAL_EQUATION, runs), size, runs)
    pressed = choose(regular > 0.5, found, normal)
    hold(now, here + at.NORMAL_NOW, runs, pressed)
    was, ratio = held(now, here + at.TANGENTIAL_NOW, runs), held(now, here + at.RATIO, runs)
    pulled = found_tangential(contacts, j, at.TANGENTIAL_EQUATION, ratio, found, size, runs)
    pulled = choose(regular > 0.5, pulled, was)
    hold(now, here + at.TANGENTIAL_NOW, runs, pulled)
    if space is not None and has_b(contacts.rows, j):
        was_b, ratio = held(now, here + at.TANGENTIAL_NOW_B, runs), held(now, here + at.RATIO_B, runs)
        pulled_b = found_tangential(contacts, j, at.TANGENTIAL_EQUATION_B, ratio, found, size, runs)
        pulled_b = choose(regular > 0.5, pulled_b, was_b)
        hold(now, here + at.TANGENTIAL_NOW_B, runs, pulled_b)
        more = Tangents(pulled - was, pulled_b - was_b)
        displace_in_space(contacts.faces, sizes.faces, n, runs, pressed - normal, more)
    else:
        displace(contacts.faces, sizes.faces, n, runs, pressed - normal, pulled - was)


@inlined
def eliminate(scratch: Array, size: int, per_block: int, runs: Runs, regular: Number) -> Number:
    """Solve the system in place by Gaussian elimination without pivoting; return where it is regular.

    A contact's own compliance is on the diagonal. The next sweep recovers the digits lost here. Two unknowns are
    eliminated from all later equations at once.
    """
    one, other = scratch.shape[0] + MULTIPLIERS, scratch.shape[0] + MORE_MULTIPLIERS
    blocks = (size + per_block - 1) // per_block
    for k in range(0, size, 2):
        begin = k // per_block
        regular = put_multipliers(scratch, k, one, begin, blocks, per_block, runs, regular)
        if k + 1 < size:
            factor = component(scratch, k, k + 1, runs)
            for block in range(begin, blocks):
                left = fused(-factor, load(scratch, one, block, runs), load(scratch, k + 1, block, runs))
                store(scratch, k + 1, block, runs, left)
            regular = put_multipliers(scratch, k + 1, other, begin, blocks, per_block, runs, regular)
            between = component(scratch, k + 1, one, runs)
            for column in range(k + 2, size + 1):
                factor = component(scratch, k, column, runs)
                more = fused(-factor, between, component(scratch, k + 1, column, runs))
                for block in range(begin, blocks):
                    left = fused(-factor, load(scratch, one, block, runs), load(scratch, column, block, runs))
                    store(scratch, column, block, runs, fused(-more, load(scratch, other, block, runs), left))
    for back in range(size):
        k = size - 1 - back
        pivot = choose(regular > 0.5, component(scratch, k, k, runs), 1.0)
        found = component(scratch, k, size, runs) / pivot
        set_component(scratch, k, size, runs, found)
        whole = k // per_block
        for block in range(whole):
            left = fused(-found, load(scratch, k, block, runs), load(scratch, size, block, runs))
            store(scratch, size, block, runs, left)
        for row in range(whole * per_block, k):
            left = fused(-found, component(scratch, row, k, runs), component(scratch, row, size, runs))
            set_component(scratch, row, size, runs, left)
    return regular


@inlined
def put_multipliers(
    scratch: Array, k: int, row: int, begin: int, blocks: int, per_block: int, runs: Runs, regular: Number
) -> Number:
    """Set the multipliers that eliminate unknown `k` from the later equations; return where that is possible."""
    pivot = component(scratch, k, k, runs)
    regular = choose(magnitude(pivot) > 0.0, regular, runs.zero)
    inverse = 1.0 / choose(regular > 0.5, pivot, 1.0)
    own, mask = k // per_block, scratch.shape[0] + SAVED - 1 - k % per_block
    for block in range(begin, own):
        store(scratch, row, block, runs, 0.0 * load(scratch, mask, 0, runs))
    after = load(scratch, k, own, runs) * load(scratch, mask, 0, runs)
    store(scratch, row, own, runs, after * inverse)
    for block in range(own + 1, blocks):
        store(scratch, row, block, runs, load(scratch, k, block, runs) * inverse)
    return regular
