"""Direct solve for the forces of all contacts, from their last states: linear systems, until no state has to change.

The unknowns are the normal forces of closed contacts and the tangential forces of held contacts; where a contact
slides, its tangential force is the last ratio times its normal force. Then contacts that pull open, open contacts that
overlap close, contacts held beyond their cone slide and contacts that slide against their friction are held: an active
set. The system lies in blocks like the compliance, ``scratch[row, block, lane]``: a row for each unknown, with its
displacements at all equations, a row for right sides, then those named below. Runs side by side share all equations.
"""

import math

import numba

from . import layout as at
from .block_rows import COMPLIANCE, DISPLACEMENT
from .contact import SLIDING, STICKING
from .faces import displace, displace_in_space
from .friction import set_valued
from .lanes import anywhere, choose, component, fused, held, hold, lane, load, magnitude, set_component, store
from .modes import OPTIONS
from .pressing import share_of
from .solves import strayed
from .space import direction, is_second
from .yielding import give_of, path_of, yields_anywhere, yields_of

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


@numba.njit(**OPTIONS)
def solve_states(contacts, carried, sizes, step, run, tried, zero):
    """Solve for forces, states and displacements of all contacts, with the ratios of sliding kept, in runs `tried`.

    Nothing changes in runs where no consistent states are found; returns where that is so.
    """
    now, codes, scratch = contacts.now, contacts.codes, contacts.scratch
    keep_found(contacts, sizes, run, zero)
    slack = TOUCH * farthest(now, sizes.contacts, run, zero)
    active, given_up = choose(tried > 0.5, 1.0, zero), zero
    fewest, vain = zero + math.inf, zero
    for _ in range(TRIALS):
        size = number_equations(contacts, sizes.contacts, run, zero)
        for j in range(sizes.contacts):
            if equation(now, j, at.NORMAL_EQUATION, run, zero) >= 0:
                in_space = is_second(codes, j + 1)
                put_columns(contacts, sizes, j, in_space, size, run, zero)
                put_rights(contacts, carried, j, in_space, size, run, zero)
        regular = eliminate(scratch, size, sizes.per_block, run, active, zero)
        for j in range(sizes.contacts):
            if equation(now, j, at.NORMAL_EQUATION, run, zero) >= 0:
                more, pulled = take(contacts, j, j, size, regular, run, zero)
                if is_second(codes, j + 1):
                    _, swerved = take(contacts, j, j + 1, size, regular, run, zero)
                    displace_in_space(contacts.faces, sizes.faces, j, run, more, pulled, swerved)
                else:
                    displace(contacts.faces, sizes.faces, j, run, more, pulled)
        given_up = choose(active - regular > 0.5, 1.0, given_up)
        at_odds, last, fails = compare(contacts, carried, sizes, slack, regular, run, zero)
        given_up = choose(fails > 0.5, 1.0, given_up)
        active = choose(given_up > 0.5, zero, choose(at_odds > 0.5, regular, zero))
        if not anywhere(active > 0.5):
            break
        vain = choose(at_odds < fewest, zero, vain + 1.0)
        fewest = choose(at_odds < fewest, at_odds, fewest)
        for j in range(sizes.contacts):
            alone = choose(vain > BLOCKS_IN_VAIN, choose(magnitude(last - j) < 0.5, active, zero), active)
            if not is_second(codes, j):
                in_space = is_second(codes, j + 1)
                change(contacts, carried, sizes, j, in_space, step, alone, run, zero)
    given_up = choose(active > 0.5, 1.0, given_up)
    put_back(contacts, sizes, given_up, run, zero)
    return given_up


@numba.njit(**OPTIONS)
def farthest(now, count, run, zero):
    """Return the largest gap or slip of all contacts without their forces."""
    found = zero
    for i in range(count):
        gap = magnitude(held(now, i * at.IN_STEP + at.FREE_GAP, run, zero))
        slip = magnitude(held(now, i * at.IN_STEP + at.FREE_SLIP, run, zero))
        found = choose(gap > found, gap, found)
        found = choose(slip > found, slip, found)
    return found


@numba.njit(**OPTIONS)
def keep_found(contacts, sizes, run, zero):
    """Save forces, states and displacements to restore, and set the ratios of sliding contacts."""
    now, saved = contacts.now, contacts.scratch.shape[0] + SAVED
    for i in range(sizes.contacts):
        here = i * at.IN_STEP
        normal, tangential, status = (
            held(now, here + at.NORMAL_NOW, run, zero),
            held(now, here + at.TANGENTIAL_NOW, run, zero),
            held(now, here + at.STATUS_NOW, run, zero),
        )
        hold(now, here + at.NORMAL_KEPT, run, normal)
        hold(now, here + at.TANGENTIAL_KEPT, run, tangential)
        hold(now, here + at.STATUS_KEPT, run, status)
        ratio = choose(normal > 0.0, tangential, zero) / choose(normal > 0.0, normal, 1.0)
        hold(now, here + at.RATIO, run, ratio)
        for k in range(2 * i, 2 * i + 2):
            set_component(contacts.scratch, k, saved, run, component(contacts.faces, k, DISPLACEMENT, run, zero))


@numba.njit(**OPTIONS)
def put_back(contacts, sizes, given_up, run, zero):
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
            found = held(now, here + row, run, zero)
            hold(now, here + row, run, choose(given_up > 0.5, held(now, here + kept, run, zero), found))
        for k in range(2 * i, 2 * i + 2):
            found = component(contacts.faces, k, DISPLACEMENT, run, zero)
            before = component(contacts.scratch, k, saved, run, zero)
            set_component(contacts.faces, k, DISPLACEMENT, run, choose(given_up > 0.5, before, found))


@numba.njit(**OPTIONS)
def compare(contacts, carried, sizes, slack, active, run, zero):
    """Set the state that each contact wants, in runs that are `active`.

    Under laws other than Coulomb's, only a sweep decides when a contact breaks away or comes to rest.

    Returns
    -------
    at_odds, last : float or vector
        Number of contacts that want another state, and the index of the last of them.
    fails : float or vector
        Where a contact has no consistent state.
    """
    now, at_odds, last, fails = contacts.now, zero, zero - 1.0, zero
    for j in range(sizes.contacts):
        if is_second(contacts.codes, j):
            continue
        here, in_space = j * at.IN_STEP, is_second(contacts.codes, j + 1)
        status, normal = held(now, here + at.STATUS_NOW, run, zero), held(now, here + at.NORMAL_NOW, run, zero)
        gap = component(contacts.faces, 2 * j, DISPLACEMENT, run, zero)
        closed, sticks = status > 0.5 * STICKING, magnitude(status - STICKING) < 0.5
        wanted = choose(closed, choose(normal < 0.0, zero, status), choose(gap < -slack, zero + SLIDING, zero))
        first, second = held(now, here + at.TANGENTIAL_NOW, run, zero), zero
        along, across = velocity_of(contacts, carried, j, run, zero), zero
        if in_space:
            second = held(now, here + at.IN_STEP + at.TANGENTIAL_NOW, run, zero)
            across = velocity_of(contacts, carried, j + 1, run, zero)
        if set_valued(contacts.codes[j]):
            most = BEYOND * held(contacts.constants, j * at.CONTACT_CONSTANTS + at.AT_REST, run, zero) * normal
            beyond = choose(sticks, first * first + second * second, zero) > most * most
            breaks = choose(beyond, choose(normal < 0.0, zero, 1.0), zero)
            if contacts.codes[j] == at.COULOMB:
                wanted = choose(breaks > 0.5, zero + SLIDING, wanted)
                free = held(now, here + at.LET_GO, run, zero) > 0.5
                against = choose(free, zero, first * along + second * across) < 0.0
                slides = choose(sticks, zero, choose(normal < 0.0, zero, 1.0))
                wanted = choose(choose(against, slides, zero) > 0.5, zero + STICKING, wanted)
            else:
                fails = choose(choose(active > 0.5, breaks, zero) > 0.5, 1.0, fails)
        wanted = choose(active > 0.5, wanted, status)
        odd = magnitude(wanted - status) > 0.5
        at_odds += choose(odd, 1.0, zero)
        last = choose(odd, zero + float(j), last)
        hold(now, here + at.STATUS_WANTED, run, wanted)
    return at_odds, last, fails


@numba.njit(**OPTIONS)
def change(contacts, carried, sizes, j, in_space, step, active, run, zero):
    """Give contact `j` the state that it wants, in runs that are `active`."""
    now, faces, here = contacts.now, contacts.faces, j * at.IN_STEP
    there = here + at.IN_STEP
    status, wanted = held(now, here + at.STATUS_NOW, run, zero), held(now, here + at.STATUS_WANTED, run, zero)
    wanted = choose(active > 0.5, wanted, status)
    if not anywhere(magnitude(wanted - status) > 0.5):
        return
    opens = choose(wanted < 0.5 * STICKING, status, zero) > 0.5 * STICKING
    closes = choose(status < 0.5 * STICKING, wanted, zero) > 0.5 * STICKING
    moves = choose(status < SLIDING - 0.5, wanted, zero) > SLIDING - 0.5
    stops = choose(wanted < SLIDING - 0.5, status, zero) > SLIDING - 0.5
    normal = held(now, here + at.NORMAL_NOW, run, zero)
    first, second = held(now, here + at.TANGENTIAL_NOW, run, zero), zero
    # A contact that closes slides in the direction of its motion, one that breaks away in that of its force.
    along, across = choose(closes, velocity_of(contacts, carried, j, run, zero), first), zero
    if in_space:
        second = held(now, there + at.TANGENTIAL_NOW, run, zero)
        across = choose(closes, velocity_of(contacts, carried, j + 1, run, zero), second)
    at_rest = held(contacts.constants, j * at.CONTACT_CONSTANTS + at.AT_REST, run, zero)
    c, s = direction((along, across), (zero, zero))
    ratio = choose(moves, at_rest * c, held(now, here + at.RATIO, run, zero))
    hold(now, here + at.RATIO, run, choose(stops, zero, ratio))
    hold(now, here + at.STATUS_NOW, run, wanted)
    hold(now, here + at.JAMMED_NOW, run, choose(closes, zero, held(now, here + at.JAMMED_NOW, run, zero)))
    hold(now, here + at.MAY_TOUCH, run, choose(closes, 1.0, held(now, here + at.MAY_TOUCH, run, zero)))
    hold(now, here + at.BROKE, run, choose(moves, 1.0, held(now, here + at.BROKE, run, zero)))
    soften_closed(contacts, carried, j, closes, step, run, zero)
    left, pulled = choose(opens, zero, normal), choose(opens, zero, first)
    hold(now, here + at.NORMAL_NOW, run, left)
    hold(now, here + at.TANGENTIAL_NOW, run, pulled)
    if not in_space:
        displace(faces, sizes.faces, j, run, left - normal, pulled - first)
    else:
        ratio = choose(moves, at_rest * s, held(now, there + at.RATIO, run, zero))
        hold(now, there + at.RATIO, run, choose(stops, zero, ratio))
        hold(now, there + at.STATUS_NOW, run, wanted)
        hold(now, there + at.NORMAL_NOW, run, left)
        swerved = choose(opens, zero, second)
        hold(now, there + at.TANGENTIAL_NOW, run, swerved)
        displace_in_space(faces, sizes.faces, j, run, left - normal, pulled - first, swerved - second)


@numba.njit(**OPTIONS)
def velocity_of(contacts, carried, i, run, zero):
    """Return the velocity along the tangent of pair `i` that friction opposes, in units of a ninth of a slip."""
    slip = component(contacts.faces, 2 * i + 1, DISPLACEMENT, run, zero)
    if not (is_second(contacts.codes, i) or is_second(contacts.codes, i + 1)):
        return 9.0 * slip
    base, first = i * at.CARRIED, i - 1 if is_second(contacts.codes, i) else i
    last, earlier = (
        held(carried, base + at.LAST_SLIP, run, zero),
        held(carried, base + at.EARLIER_SLIP, run, zero),
    )
    late = held(contacts.now, first * at.IN_STEP + at.LET_GO, run, zero) > 0.0
    return 9.0 * slip + choose(late, zero, 6.0 * last + earlier)


@numba.njit(**OPTIONS)
def soften_closed(contacts, carried, j, closes, step, run, zero):
    """Set the yielding of contact `j` about its indentation, in runs in which it has closed."""
    yields = yields_of(j, contacts.constants, run, zero)
    if not yields_anywhere(yields):
        return
    here, n = j * at.IN_STEP, 2 * j
    own = component(contacts.faces, n, COMPLIANCE + n, run, zero)
    indented = -component(contacts.faces, n, DISPLACEMENT, run, zero)
    path = path_of(j, carried, run, zero)
    share = share_of(indented, path, yields)
    give, beyond = give_of(indented, path, yields, share, own, step, zero)
    hold(contacts.now, here + at.GIVE, run, choose(closes, give, held(contacts.now, here + at.GIVE, run, zero)))
    kept = held(contacts.now, here + at.BEYOND, run, zero)
    hold(contacts.now, here + at.BEYOND, run, choose(closes, beyond, kept))


@numba.njit(**OPTIONS)
def equation(now, i, which, run, zero):
    """Return the number of an equation of contact `i`, the same in all runs, below 0 without one."""
    return int(lane(held(now, i * at.IN_STEP + which, run, zero), 0))


@numba.njit(**OPTIONS)
def number_equations(contacts, count, run, zero):
    """Number the equations of all contacts, set their places and whether a run has each; return their number."""
    now, codes, scratch = contacts.now, contacts.codes, contacts.scratch
    size, has = 0, scratch.shape[0] + HAS
    for i in range(count):
        here = i * at.IN_STEP
        of_normal, of_tangential = -1, -1
        status = held(now, here + at.STATUS_NOW, run, zero)
        closed, sticks = status > 0.5 * STICKING, magnitude(status - STICKING) < 0.5
        mirrors = is_second(codes, i)
        law = codes[i - 1] if mirrors else codes[i]
        holds = choose(sticks, 1.0, zero) if set_valued(law) else zero
        if not mirrors and anywhere(closed):
            set_component(scratch, size, has, run, choose(closed, 1.0, zero))
            contacts.places[size, run] = 2 * i
            of_normal, size = size, size + 1
        if anywhere(holds > 0.5):
            set_component(scratch, size, has, run, holds)
            contacts.places[size, run] = 2 * i + 1
            of_tangential, size = size, size + 1
        hold(now, here + at.NORMAL_EQUATION, run, zero + float(of_normal))
        hold(now, here + at.TANGENTIAL_EQUATION, run, zero + float(of_tangential))
        hold(now, here + at.RATIO, run, choose(holds > 0.5, zero, held(now, here + at.RATIO, run, zero)))
    return size


@numba.njit(**OPTIONS)
def is_closed(now, i, run, zero):
    """Return whether contact `i` is closed."""
    return held(now, i * at.IN_STEP + at.STATUS_NOW, run, zero) > 0.5 * STICKING


@numba.njit(**OPTIONS)
def is_held(now, i, run, zero):
    """Return whether contact `i` sticks; one with an equation of its tangential force is then held."""
    return magnitude(held(now, i * at.IN_STEP + at.STATUS_NOW, run, zero) - STICKING) < 0.5


@numba.njit(**OPTIONS)
def put_columns(contacts, sizes, j, in_space, size, run, zero):
    """Set the displacements under the forces of contact `j` at every equation."""
    now, faces, scratch = contacts.now, contacts.faces, contacts.scratch
    ratio, swerve = held(now, j * at.IN_STEP + at.RATIO, run, zero), zero
    if in_space:
        swerve = held(now, (j + 1) * at.IN_STEP + at.RATIO, run, zero)
    n, t, b = COMPLIANCE + 2 * j, COMPLIANCE + 2 * j + 1, COMPLIANCE + 2 * j + 3
    together = scratch.shape[0] + ALONG
    for block in range(sizes.faces):
        along = fused(-ratio, load(faces, t, block, run), load(faces, n, block, run))
        along = fused(-swerve, load(faces, b, block, run), along) if in_space else along
        store(scratch, together, block, run, along)
    column = equation(now, j, at.NORMAL_EQUATION, run, zero)
    give = held(now, j * at.IN_STEP + at.GIVE, run, zero)
    put_column(scratch, contacts.places, scratch, together, column, give, size, run, zero)
    first = equation(now, j, at.TANGENTIAL_EQUATION, run, zero)
    if first >= 0:
        put_column(scratch, contacts.places, faces, t, first, zero, size, run, zero)
    second = equation(now, j + 1, at.TANGENTIAL_EQUATION, run, zero) if in_space else -1
    if second >= 0:
        put_column(scratch, contacts.places, faces, b, second, zero, size, run, zero)


@numba.njit(**OPTIONS)
def put_column(scratch, places, displaced, row, column, give, size, run, zero):
    """Set the displacements under an unknown at every equation, from a row, with the additional give of its contact.

    The unknown is zero where this run has no such equation.
    """
    has = scratch.shape[0] + HAS
    for i in range(size):
        value = component(displaced, places[i, run], row, run, zero) * component(scratch, i, has, run, zero)
        set_component(scratch, i, column, run, value)
    own, value = component(scratch, column, has, run, zero), component(scratch, column, column, run, zero)
    set_component(scratch, column, column, run, choose(own > 0.5, value + give, 1.0))


@numba.njit(**OPTIONS)
def put_rights(contacts, carried, j, in_space, size, run, zero):
    """Set the right sides of contact `j`: gap and slip to undo."""
    now, scratch, here = contacts.now, contacts.scratch, j * at.IN_STEP
    gap, beyond = held(now, here + at.FREE_GAP, run, zero), held(now, here + at.BEYOND, run, zero)
    of_normal = equation(now, j, at.NORMAL_EQUATION, run, zero)
    set_component(scratch, of_normal, size, run, choose(is_closed(now, j, run, zero), -gap - beyond, zero))
    for i in range(j, j + 2 if in_space else j + 1):
        of_tangential = equation(now, i, at.TANGENTIAL_EQUATION, run, zero)
        if of_tangential >= 0:
            slip = held(now, i * at.IN_STEP + at.FREE_SLIP, run, zero) + strayed(carried, i, run, zero)
            holds = is_held(now, i, run, zero)
            set_component(scratch, of_tangential, size, run, choose(holds, -slip, zero))


@numba.njit(**OPTIONS)
def found_forces(contacts, j, i, size, run, zero):
    """Return the normal force of contact `j` and the tangential force of its pair `i` from the solution."""
    now, scratch = contacts.now, contacts.scratch
    normal = component(scratch, equation(now, j, at.NORMAL_EQUATION, run, zero), size, run, zero)
    tangential = held(now, i * at.IN_STEP + at.RATIO, run, zero) * normal
    of_tangential = equation(now, i, at.TANGENTIAL_EQUATION, run, zero)
    if of_tangential >= 0:
        pulled = -component(scratch, of_tangential, size, run, zero)
        tangential = choose(is_held(now, i, run, zero), pulled, tangential)
    return normal, tangential


@numba.njit(**OPTIONS)
def take(contacts, j, i, size, regular, run, zero):
    """Accept the forces of pair `i` of contact `j` in runs that are `regular`; return their changes."""
    now, here = contacts.now, i * at.IN_STEP
    normal, tangential = held(now, here + at.NORMAL_NOW, run, zero), held(now, here + at.TANGENTIAL_NOW, run, zero)
    pressed, pulled = found_forces(contacts, j, i, size, run, zero)
    pressed, pulled = choose(regular > 0.5, pressed, normal), choose(regular > 0.5, pulled, tangential)
    hold(now, here + at.NORMAL_NOW, run, pressed)
    hold(now, here + at.TANGENTIAL_NOW, run, pulled)
    return pressed - normal, pulled - tangential


@numba.njit(**OPTIONS)
def eliminate(scratch, size, per_block, run, regular, zero):
    """Solve the system in place by Gaussian elimination without pivoting; return where it is regular.

    A contact's own compliance is on the diagonal. The next sweep recovers the digits lost here. Two unknowns are
    eliminated from all later equations at once.
    """
    one, other = scratch.shape[0] + MULTIPLIERS, scratch.shape[0] + MORE_MULTIPLIERS
    blocks = (size + per_block - 1) // per_block
    for k in range(0, size, 2):
        begin = k // per_block
        regular = put_multipliers(scratch, k, one, begin, blocks, per_block, run, regular, zero)
        if k + 1 < size:
            factor = component(scratch, k, k + 1, run, zero)
            for block in range(begin, blocks):
                left = fused(-factor, load(scratch, one, block, run), load(scratch, k + 1, block, run))
                store(scratch, k + 1, block, run, left)
            regular = put_multipliers(scratch, k + 1, other, begin, blocks, per_block, run, regular, zero)
            between = component(scratch, k + 1, one, run, zero)
            for column in range(k + 2, size + 1):
                factor = component(scratch, k, column, run, zero)
                more = fused(-factor, between, component(scratch, k + 1, column, run, zero))
                for block in range(begin, blocks):
                    left = fused(-factor, load(scratch, one, block, run), load(scratch, column, block, run))
                    store(scratch, column, block, run, fused(-more, load(scratch, other, block, run), left))
    for back in range(size):
        k = size - 1 - back
        pivot = choose(regular > 0.5, component(scratch, k, k, run, zero), 1.0)
        found = component(scratch, k, size, run, zero) / pivot
        set_component(scratch, k, size, run, found)
        whole = k // per_block
        for block in range(whole):
            left = fused(-found, load(scratch, k, block, run), load(scratch, size, block, run))
            store(scratch, size, block, run, left)
        for row in range(whole * per_block, k):
            left = fused(-found, component(scratch, row, k, run, zero), component(scratch, row, size, run, zero))
            set_component(scratch, row, size, run, left)
    return regular


@numba.njit(**OPTIONS)
def put_multipliers(scratch, k, row, begin, blocks, per_block, run, regular, zero):
    """Set the multipliers that eliminate unknown `k` from the later equations; return where that is possible."""
    pivot = component(scratch, k, k, run, zero)
    regular = choose(magnitude(pivot) > 0.0, regular, zero)
    inverse = 1.0 / choose(regular > 0.5, pivot, 1.0)
    own, mask = k // per_block, scratch.shape[0] + SAVED - 1 - k % per_block
    for block in range(begin, own):
        store(scratch, row, block, run, 0.0 * load(scratch, mask, 0, run))
    after = load(scratch, k, own, run) * load(scratch, mask, 0, run)
    store(scratch, row, own, run, after * inverse)
    for block in range(own + 1, blocks):
        store(scratch, row, block, run, load(scratch, k, block, run) * inverse)
    return regular
