"""Direct solve for the forces of all contacts, from their last states: linear systems, until no state has to change.

The unknowns are the normal forces of closed contacts and the tangential forces of held contacts; where a contact
slides, its tangential force is the last ratio times its normal force. Then contacts that pull open, open contacts that
overlap close, contacts held beyond their cone slide and contacts that slide against their friction are held: an active
set. The system lies in blocks like the compliance, ``scratch[row, block, lane]``: a row for each unknown, with its
displacements at all equations, a row for right sides, then those named below. Runs side by side share all equations.
"""

import math

from ..contact.exact import SLIDING, STICKING
from ..contact.friction import set_valued
from ..contact.in_space import direction, is_second
from ..contact.pressing import share_of
from ..contact.solves import strayed
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
from ..layout.rows import COMPLIANCE, DISPLACEMENT
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
def solve_states(contacts: Contacts, carried: Array, sizes: Sizes, step: Number, runs: Runs, tried: Number) -> Number:
    """Solve for forces, states and displacements of all contacts, with the ratios of sliding kept, in runs `tried`.

    Nothing changes in runs where no consistent states are found; returns where that is so.
    """
    now, codes, scratch = contacts.now, contacts.codes, contacts.scratch
    keep_found(contacts, sizes, runs)
    slack = TOUCH * farthest(now, sizes.contacts, runs)
    active, given_up = choose(tried > 0.5, 1.0, runs.zero), runs.zero
    fewest, vain = runs.zero + math.inf, runs.zero
    for _ in range(TRIALS):
        size = number_equations(contacts, sizes.contacts, runs)
        for j in range(sizes.contacts):
            if equation(now, j, at.NORMAL_EQUATION, runs) >= 0:
                in_space = is_second(codes, j + 1)
                put_columns(contacts, sizes, j, in_space, size, runs)
                put_rights(contacts, carried, j, in_space, size, runs)
        regular = eliminate(scratch, size, sizes.per_block, runs, active)
        for j in range(sizes.contacts):
            if equation(now, j, at.NORMAL_EQUATION, runs) >= 0:
                more, pulled = take(contacts, j, j, size, regular, runs)
                if is_second(codes, j + 1):
                    _, swerved = take(contacts, j, j + 1, size, regular, runs)
                    displace_in_space(contacts.faces, sizes.faces, j, runs, more, pulled, swerved)
                else:
                    displace(contacts.faces, sizes.faces, j, runs, more, pulled)
        given_up = choose(active - regular > 0.5, 1.0, given_up)
        at_odds, last, fails = compare(contacts, carried, sizes, slack, regular, runs)
        given_up = choose(fails > 0.5, 1.0, given_up)
        active = choose(given_up > 0.5, runs.zero, choose(at_odds > 0.5, regular, runs.zero))
        if not anywhere(active > 0.5):
            break
        vain = choose(at_odds < fewest, runs.zero, vain + 1.0)
        fewest = choose(at_odds < fewest, at_odds, fewest)
        for j in range(sizes.contacts):
            alone = choose(vain > BLOCKS_IN_VAIN, choose(magnitude(last - j) < 0.5, active, runs.zero), active)
            if not is_second(codes, j):
                in_space = is_second(codes, j + 1)
                change(contacts, carried, sizes, j, in_space, step, alone, runs)
    given_up = choose(active > 0.5, 1.0, given_up)
    put_back(contacts, sizes, given_up, runs)
    return given_up


@inlined
def farthest(now: Array, count: int, runs: Runs) -> Number:
    """Return the largest gap or slip of all contacts without their forces."""
    found = runs.zero
    for i in range(count):
        gap = magnitude(held(now, i * at.IN_STEP + at.FREE_GAP, runs))
        slip = magnitude(held(now, i * at.IN_STEP + at.FREE_SLIP, runs))
        found = choose(gap > found, gap, found)
        found = choose(slip > found, slip, found)
    return found


@inlined
def keep_found(contacts: Contacts, sizes: Sizes, runs: Runs) -> None:
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
        for k in range(2 * i, 2 * i + 2):
            set_component(contacts.scratch, k, saved, runs, component(contacts.faces, k, DISPLACEMENT, runs))


@inlined
def put_back(contacts: Contacts, sizes: Sizes, given_up: Number, runs: Runs) -> None:
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
        for k in range(2 * i, 2 * i + 2):
            found = component(contacts.faces, k, DISPLACEMENT, runs)
            before = component(contacts.scratch, k, saved, runs)
            set_component(contacts.faces, k, DISPLACEMENT, runs, choose(given_up > 0.5, before, found))


@inlined
def compare(contacts: Contacts, carried: Array, sizes: Sizes, slack: Number, active: Number, runs: Runs) -> Numbers:
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
        if is_second(contacts.codes, j):
            continue
        here, in_space = j * at.IN_STEP, is_second(contacts.codes, j + 1)
        status, normal = held(now, here + at.STATUS_NOW, runs), held(now, here + at.NORMAL_NOW, runs)
        gap = component(contacts.faces, 2 * j, DISPLACEMENT, runs)
        closed, sticks = status > 0.5 * STICKING, magnitude(status - STICKING) < 0.5
        wanted = choose(
            closed, choose(normal < 0.0, runs.zero, status), choose(gap < -slack, runs.zero + SLIDING, runs.zero)
        )
        first, second = held(now, here + at.TANGENTIAL_NOW, runs), runs.zero
        along, across = velocity_of(contacts, carried, j, runs), runs.zero
        if in_space:
            second = held(now, here + at.IN_STEP + at.TANGENTIAL_NOW, runs)
            across = velocity_of(contacts, carried, j + 1, runs)
        if set_valued(contacts.codes[j]):
            most = BEYOND * held(contacts.constants, j * at.CONTACT_CONSTANTS + at.AT_REST, runs) * normal
            beyond = choose(sticks, first * first + second * second, runs.zero) > most * most
            breaks = choose(beyond, choose(normal < 0.0, runs.zero, 1.0), runs.zero)
            if contacts.codes[j] == at.COULOMB:
                wanted = choose(breaks > 0.5, runs.zero + SLIDING, wanted)
                free = held(now, here + at.LET_GO, runs) > 0.5
                against = choose(free, runs.zero, first * along + second * across) < 0.0
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
def change(
    contacts: Contacts, carried: Array, sizes: Sizes, j: int, in_space: bool, step: Number, active: Number, runs: Runs
) -> None:
    """Give contact `j` the state that it wants, in runs that are `active`."""
    now, faces, here = contacts.now, contacts.faces, j * at.IN_STEP
    there = here + at.IN_STEP
    status, wanted = held(now, here + at.STATUS_NOW, runs), held(now, here + at.STATUS_WANTED, runs)
    wanted = choose(active > 0.5, wanted, status)
    if not anywhere(magnitude(wanted - status) > 0.5):
        return
    opens = choose(wanted < 0.5 * STICKING, status, runs.zero) > 0.5 * STICKING
    closes = choose(status < 0.5 * STICKING, wanted, runs.zero) > 0.5 * STICKING
    moves = choose(status < SLIDING - 0.5, wanted, runs.zero) > SLIDING - 0.5
    stops = choose(wanted < SLIDING - 0.5, status, runs.zero) > SLIDING - 0.5
    normal = held(now, here + at.NORMAL_NOW, runs)
    first, second = held(now, here + at.TANGENTIAL_NOW, runs), runs.zero
    # A contact that closes slides in the direction of its motion, one that breaks away in that of its force.
    along, across = choose(closes, velocity_of(contacts, carried, j, runs), first), runs.zero
    if in_space:
        second = held(now, there + at.TANGENTIAL_NOW, runs)
        across = choose(closes, velocity_of(contacts, carried, j + 1, runs), second)
    at_rest = held(contacts.constants, j * at.CONTACT_CONSTANTS + at.AT_REST, runs)
    c, s = direction(Tangents(along, across), Tangents(runs.zero, runs.zero))
    ratio = choose(moves, at_rest * c, held(now, here + at.RATIO, runs))
    hold(now, here + at.RATIO, runs, choose(stops, runs.zero, ratio))
    hold(now, here + at.STATUS_NOW, runs, wanted)
    hold(now, here + at.JAMMED_NOW, runs, choose(closes, runs.zero, held(now, here + at.JAMMED_NOW, runs)))
    hold(now, here + at.MAY_TOUCH, runs, choose(closes, 1.0, held(now, here + at.MAY_TOUCH, runs)))
    hold(now, here + at.BROKE, runs, choose(moves, 1.0, held(now, here + at.BROKE, runs)))
    soften_closed(contacts, carried, j, closes, step, runs)
    left, pulled = choose(opens, runs.zero, normal), choose(opens, runs.zero, first)
    hold(now, here + at.NORMAL_NOW, runs, left)
    hold(now, here + at.TANGENTIAL_NOW, runs, pulled)
    if not in_space:
        displace(faces, sizes.faces, j, runs, left - normal, pulled - first)
    else:
        ratio = choose(moves, at_rest * s, held(now, there + at.RATIO, runs))
        hold(now, there + at.RATIO, runs, choose(stops, runs.zero, ratio))
        hold(now, there + at.STATUS_NOW, runs, wanted)
        hold(now, there + at.NORMAL_NOW, runs, left)
        swerved = choose(opens, runs.zero, second)
        hold(now, there + at.TANGENTIAL_NOW, runs, swerved)
        displace_in_space(faces, sizes.faces, j, runs, left - normal, pulled - first, swerved - second)


@inlined
def velocity_of(contacts: Contacts, carried: Array, i: int, runs: Runs) -> Number:
    """Return the velocity along the tangent of pair `i` that friction opposes, in units of a ninth of a slip."""
    slip = component(contacts.faces, 2 * i + 1, DISPLACEMENT, runs)
    if not (is_second(contacts.codes, i) or is_second(contacts.codes, i + 1)):
        return 9.0 * slip
    base, first = i * at.CARRIED, i - 1 if is_second(contacts.codes, i) else i
    last, earlier = (
        held(carried, base + at.LAST_SLIP, runs),
        held(carried, base + at.EARLIER_SLIP, runs),
    )
    late = held(contacts.now, first * at.IN_STEP + at.LET_GO, runs) > 0.0
    return 9.0 * slip + choose(late, runs.zero, 6.0 * last + earlier)


@inlined
def soften_closed(contacts: Contacts, carried: Array, j: int, closes: bool, step: Number, runs: Runs) -> None:
    """Set the yielding of contact `j` about its indentation, in runs in which it has closed."""
    yields = yields_of(j, contacts.constants, runs)
    if not yields_anywhere(yields):
        return
    here, n = j * at.IN_STEP, 2 * j
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
def number_equations(contacts: Contacts, count: int, runs: Runs) -> int:
    """Number the equations of all contacts, set their places and whether a run has each; return their number."""
    now, codes, scratch = contacts.now, contacts.codes, contacts.scratch
    size, has = 0, scratch.shape[0] + HAS
    for i in range(count):
        here = i * at.IN_STEP
        of_normal, of_tangential = -1, -1
        status = held(now, here + at.STATUS_NOW, runs)
        closed, sticks = status > 0.5 * STICKING, magnitude(status - STICKING) < 0.5
        mirrors = is_second(codes, i)
        law = codes[i - 1] if mirrors else codes[i]
        holds = choose(sticks, 1.0, runs.zero) if set_valued(law) else runs.zero
        if not mirrors and anywhere(closed):
            set_component(scratch, size, has, runs, choose(closed, 1.0, runs.zero))
            contacts.places[size, runs.first] = 2 * i
            of_normal, size = size, size + 1
        if anywhere(holds > 0.5):
            set_component(scratch, size, has, runs, holds)
            contacts.places[size, runs.first] = 2 * i + 1
            of_tangential, size = size, size + 1
        hold(now, here + at.NORMAL_EQUATION, runs, runs.zero + float(of_normal))
        hold(now, here + at.TANGENTIAL_EQUATION, runs, runs.zero + float(of_tangential))
        hold(now, here + at.RATIO, runs, choose(holds > 0.5, runs.zero, held(now, here + at.RATIO, runs)))
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
def put_columns(contacts: Contacts, sizes: Sizes, j: int, in_space: bool, size: int, runs: Runs) -> None:
    """Set the displacements under the forces of contact `j` at every equation."""
    now, faces, scratch = contacts.now, contacts.faces, contacts.scratch
    ratio, swerve = held(now, j * at.IN_STEP + at.RATIO, runs), runs.zero
    if in_space:
        swerve = held(now, (j + 1) * at.IN_STEP + at.RATIO, runs)
    n, t, b = COMPLIANCE + 2 * j, COMPLIANCE + 2 * j + 1, COMPLIANCE + 2 * j + 3
    together = scratch.shape[0] + ALONG
    for block in range(sizes.faces):
        along = fused(-ratio, load(faces, t, block, runs), load(faces, n, block, runs))
        along = fused(-swerve, load(faces, b, block, runs), along) if in_space else along
        store(scratch, together, block, runs, along)
    column = equation(now, j, at.NORMAL_EQUATION, runs)
    give = held(now, j * at.IN_STEP + at.GIVE, runs)
    put_column(scratch, contacts.places, scratch, together, column, give, size, runs)
    first = equation(now, j, at.TANGENTIAL_EQUATION, runs)
    if first >= 0:
        put_column(scratch, contacts.places, faces, t, first, runs.zero, size, runs)
    second = equation(now, j + 1, at.TANGENTIAL_EQUATION, runs) if in_space else -1
    if second >= 0:
        put_column(scratch, contacts.places, faces, b, second, runs.zero, size, runs)


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
def put_rights(contacts: Contacts, carried: Array, j: int, in_space: bool, size: int, runs: Runs) -> None:
    """Set the right sides of contact `j`: gap and slip to undo."""
    now, scratch, here = contacts.now, contacts.scratch, j * at.IN_STEP
    gap, beyond = held(now, here + at.FREE_GAP, runs), held(now, here + at.BEYOND, runs)
    of_normal = equation(now, j, at.NORMAL_EQUATION, runs)
    set_component(scratch, of_normal, size, runs, choose(is_closed(now, j, runs), -gap - beyond, runs.zero))
    for i in range(j, j + 2 if in_space else j + 1):
        of_tangential = equation(now, i, at.TANGENTIAL_EQUATION, runs)
        if of_tangential >= 0:
            slip = held(now, i * at.IN_STEP + at.FREE_SLIP, runs) + strayed(carried, i, runs)
            holds = is_held(now, i, runs)
            set_component(scratch, of_tangential, size, runs, choose(holds, -slip, runs.zero))


@inlined
def found_forces(contacts: Contacts, j: int, i: int, size: int, runs: Runs) -> Pair:
    """Return the normal force of contact `j` and the tangential force of its pair `i` from the solution."""
    now, scratch = contacts.now, contacts.scratch
    normal = component(scratch, equation(now, j, at.NORMAL_EQUATION, runs), size, runs)
    tangential = held(now, i * at.IN_STEP + at.RATIO, runs) * normal
    of_tangential = equation(now, i, at.TANGENTIAL_EQUATION, runs)
    if of_tangential >= 0:
        pulled = -component(scratch, of_tangential, size, runs)
        tangential = choose(is_held(now, i, runs), pulled, tangential)
    return normal, tangential


@inlined
def take(contacts: Contacts, j: int, i: int, size: int, regular: Number, runs: Runs) -> Pair:
    """Accept the forces of pair `i` of contact `j` in runs that are `regular`; return their changes."""
    now, here = contacts.now, i * at.IN_STEP
    normal, tangential = held(now, here + at.NORMAL_NOW, runs), held(now, here + at.TANGENTIAL_NOW, runs)
    pressed, pulled = found_forces(contacts, j, i, size, runs)
    pressed, pulled = choose(regular > 0.5, pressed, normal), choose(regular > 0.5, pulled, tangential)
    hold(now, here + at.NORMAL_NOW, runs, pressed)
    hold(now, here + at.TANGENTIAL_NOW, runs, pulled)
    return pressed - normal, pulled - tangential


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
