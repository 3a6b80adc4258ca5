"""The forces of contacts whose states are given: one linear system.

Unknown are the normal forces of those that are closed and the tangential forces of those that are held; where a contact
slides, its tangential force is the ratio found last times its normal force. The system lies in blocks like the
compliance, ``scratch[row, block, lane]``: a row for each equation, one for right sides, one to work with. Runs side by
side have the equations of all of them.
"""

import numba

from . import layout as at
from .block_rows import COMPLIANCE
from .contact import STICKING
from .faces import displace
from .friction import set_valued
from .lanes import anywhere, choose, component, fused, held, hold, lane, load, magnitude, set_component, store
from .modes import OPTIONS
from .solves import strayed
from .space import is_second

# Share of the cone that a force may be beyond it by rounding.
BEYOND = 1.0 + 1e-9


@numba.njit(**OPTIONS)
def solve_states(contacts, carried, sizes, run, tried, zero):
    """Put the forces of the states found into what the contacts are, ratios of sliding kept, and what they displace.

    `tried` says in which runs. Where the states admit no forces nothing is changed.
    """
    now, codes, scratch = contacts.now, contacts.codes, contacts.scratch
    size = number_equations(now, codes, sizes.contacts, run, zero)
    for j in range(sizes.contacts):
        if equation(now, j, at.NORMAL_EQUATION, run, zero) >= 0:
            in_space = sizes.space and is_second(codes, j + 1)
            put_columns(contacts, sizes, j, in_space, run, zero)
            put_rights(contacts, carried, j, in_space, size, run, zero)
    blocks = (size + sizes.per_block - 1) // sizes.per_block
    regular = eliminate(scratch, size, blocks, sizes.per_block, run, tried, zero)
    for j in range(sizes.contacts):
        if equation(now, j, at.NORMAL_EQUATION, run, zero) >= 0:
            in_space = sizes.space and is_second(codes, j + 1)
            regular = admitted(contacts, j, in_space, size, regular, run, zero)
    for j in range(sizes.contacts):
        if equation(now, j, at.NORMAL_EQUATION, run, zero) >= 0:
            take(contacts, sizes, j, j, size, regular, run, zero)
            if sizes.space and is_second(codes, j + 1):
                take(contacts, sizes, j, j + 1, size, regular, run, zero)


@numba.njit(**OPTIONS)
def equation(now, i, which, run, zero):
    """Return the number of an equation of contact `i`, the same in all runs, below 0 without one."""
    return int(lane(held(now, i * at.IN_STEP + which, run, zero), 0))


@numba.njit(**OPTIONS)
def number_equations(now, codes, count, run, zero):
    """Number the equations of all contacts and put their ratios; return how many equations there are."""
    size = 0
    for i in range(count):
        here = i * at.IN_STEP
        of_normal, of_tangential = -1, -1
        status = held(now, here + at.STATUS_NOW, run, zero)
        closed, sticks = status > 0.5 * STICKING, magnitude(status - STICKING) < 0.5
        mirrors = is_second(codes, i)
        law = codes[i - 1] if mirrors else codes[i]
        holds = choose(sticks, 1.0, zero) if set_valued(law) else zero
        if not mirrors and anywhere(closed):
            of_normal, size = size, size + 1
        if anywhere(holds > 0.5):
            of_tangential, size = size, size + 1
        normal, tangential = (
            held(now, here + at.NORMAL_NOW, run, zero),
            held(now, here + at.TANGENTIAL_NOW, run, zero),
        )
        ratio = choose(normal > 0.0, tangential, zero) / choose(normal > 0.0, normal, 1.0)
        hold(now, here + at.NORMAL_EQUATION, run, zero + float(of_normal))
        hold(now, here + at.TANGENTIAL_EQUATION, run, zero + float(of_tangential))
        hold(now, here + at.RATIO, run, choose(holds > 0.5, zero, ratio))
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
def put_columns(contacts, sizes, j, in_space, run, zero):
    """Put the columns of the forces of contact `j`: what they displace at every equation."""
    now, faces, scratch = contacts.now, contacts.faces, contacts.scratch
    column = equation(now, j, at.NORMAL_EQUATION, run, zero)
    first = equation(now, j, at.TANGENTIAL_EQUATION, run, zero)
    ratio, swerve, second = held(now, j * at.IN_STEP + at.RATIO, run, zero), zero, -1
    if in_space:
        swerve = held(now, (j + 1) * at.IN_STEP + at.RATIO, run, zero)
        second = equation(now, j + 1, at.TANGENTIAL_EQUATION, run, zero)
    n, t, b = COMPLIANCE + 2 * j, COMPLIANCE + 2 * j + 1, COMPLIANCE + 2 * j + 3
    give = held(now, j * at.IN_STEP + at.GIVE, run, zero)
    # What the normal force displaces with the tangential one that goes with it, in the last row.
    last = 2 * sizes.contacts + 1
    for block in range(sizes.faces):
        along = fused(-ratio, load(faces, t, block, run), load(faces, n, block, run))
        store(scratch, last, block, run, fused(-swerve, load(faces, b, block, run), along) if in_space else along)
    for i in range(sizes.contacts):
        for k in range(2):
            which = at.NORMAL_EQUATION if k == 0 else at.TANGENTIAL_EQUATION
            row = equation(now, i, which, run, zero)
            if row < 0:
                continue
            moves = is_closed(now, i, run, zero) if k == 0 else is_held(now, i, run, zero)
            # Where this run has no such equation, the unknown is zero.
            idle = zero + 1.0
            along = component(scratch, 2 * i + k, last, run, zero)
            if row == column:
                along += give
            set_component(scratch, column, row, run, choose(moves, along, idle if row == column else zero))
            if first >= 0:
                pulled = component(faces, 2 * i + k, t, run, zero)
                set_component(scratch, first, row, run, choose(moves, pulled, idle if row == first else zero))
            if second >= 0:
                across = component(faces, 2 * i + k, b, run, zero)
                set_component(scratch, second, row, run, choose(moves, across, idle if row == second else zero))


@numba.njit(**OPTIONS)
def put_rights(contacts, carried, j, in_space, size, run, zero):
    """Put the right sides of contact `j`: gap and slip undone."""
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
    """Return the normal force of contact `j` and the tangential one of its pair `i` that were found."""
    now, scratch = contacts.now, contacts.scratch
    normal = component(scratch, equation(now, j, at.NORMAL_EQUATION, run, zero), size, run, zero)
    tangential = held(now, i * at.IN_STEP + at.RATIO, run, zero) * normal
    of_tangential = equation(now, i, at.TANGENTIAL_EQUATION, run, zero)
    if of_tangential >= 0:
        pulled = -component(scratch, of_tangential, size, run, zero)
        tangential = choose(is_held(now, i, run, zero), pulled, tangential)
    return normal, tangential


@numba.njit(**OPTIONS)
def admitted(contacts, j, in_space, size, regular, run, zero):
    """Return in which runs the forces found for contact `j` press and, where it is held, lie in the cone.

    Where more contacts stick than bodies have motions, elimination divides by round-off.
    """
    normal, tangential = found_forces(contacts, j, j, size, run, zero)
    regular = choose(normal >= 0.0, regular, zero)
    if set_valued(contacts.codes[j]):
        most = BEYOND * held(contacts.constants, j * at.CONTACT_CONSTANTS + at.AT_REST, run, zero) * normal
        squared = tangential * tangential
        if in_space:
            across = found_forces(contacts, j, j + 1, size, run, zero)[1]
            squared += across * across
        regular = choose(squared > most * most, zero, regular)
    return regular


@numba.njit(**OPTIONS)
def take(contacts, sizes, j, i, size, regular, run, zero):
    """Take the forces found for pair `i` of contact `j` in runs that are `regular`."""
    now, here = contacts.now, i * at.IN_STEP
    normal, tangential = held(now, here + at.NORMAL_NOW, run, zero), held(now, here + at.TANGENTIAL_NOW, run, zero)
    pressed, pulled = found_forces(contacts, j, i, size, run, zero)
    pressed, pulled = choose(regular > 0.5, pressed, normal), choose(regular > 0.5, pulled, tangential)
    hold(now, here + at.NORMAL_NOW, run, pressed)
    hold(now, here + at.TANGENTIAL_NOW, run, pulled)
    # The pair without a normal has the force of its contact, which displaces nothing there.
    displace(contacts.faces, sizes.faces, i, run, pressed - normal if i == j else zero, pulled - tangential)


@numba.njit(**OPTIONS)
def eliminate(scratch, size, blocks, per_block, run, regular, zero):
    """Solve the system in place by Gauss's elimination without exchange of rows; return where it is regular.

    A contact's own compliance is on the diagonal. What this loses of digits, the sweep that follows finds.
    """
    for k in range(size):
        pivot = component(scratch, k, k, run, zero)
        regular = choose(magnitude(pivot) > 0.0, regular, zero)
        inverse = 1.0 / choose(regular > 0.5, pivot, 1.0)
        right = component(scratch, k, size, run, zero)
        for row in range(k + 1, size):
            factor = component(scratch, k, row, run, zero) * inverse
            if anywhere(magnitude(factor) > 0.0):
                for block in range(k // per_block, blocks):
                    changed = fused(-factor, load(scratch, k, block, run), load(scratch, row, block, run))
                    store(scratch, row, block, run, changed)
                set_component(scratch, row, size, run, fused(-factor, right, component(scratch, row, size, run, zero)))
    for back in range(size):
        k = size - 1 - back
        pivot = choose(regular > 0.5, component(scratch, k, k, run, zero), 1.0)
        found = component(scratch, k, size, run, zero) / pivot
        set_component(scratch, k, size, run, found)
        for row in range(k):
            left = fused(-component(scratch, k, row, run, zero), found, component(scratch, row, size, run, zero))
            set_component(scratch, row, size, run, left)
    return regular
