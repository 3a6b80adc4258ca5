"""The forces of contacts whose states are given: one linear system.

It lies in blocks like the compliance, ``scratch[block, row, lane]``: a row for each equation, one more for right sides.
"""

import numba

from . import layout as at
from .block_rows import COMPLIANCE
from .contact import STICKING
from .faces import displace
from .friction import set_valued
from .lanes import anywhere, choose, entry, fused, held, hold, load, magnitude, set_entry, store
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
    now, faces, scratch = contacts.now, contacts.faces, contacts.scratch
    size = 2 * sizes.contacts
    for i in range(sizes.contacts):
        set_equations(contacts, carried, sizes, i, size, run, zero)
    regular = eliminate(scratch, size, sizes.faces, sizes.per_block, run, tried, zero)
    for i in range(sizes.contacts):
        pressed = entry(scratch, 2 * i, size, run, zero)
        regular = choose(pressed >= 0.0, regular, zero)
        # Where more contacts stick than bodies have motions, elimination divides by round-off.
        if set_valued(contacts.codes[i]):
            most = BEYOND * held(contacts.constants, i * at.CONTACT_CONSTANTS + at.AT_REST, run, zero) * pressed
            pulled = magnitude(entry(scratch, 2 * i + 1, size, run, zero))
            regular = choose(pulled > most, zero, regular)
    for i in range(sizes.contacts):
        here = i * at.IN_STEP
        normal, tangential = held(now, here + at.NORMAL_NOW, run, zero), held(now, here + at.TANGENTIAL_NOW, run, zero)
        pressed, pulled = entry(scratch, 2 * i, size, run, zero), -entry(scratch, 2 * i + 1, size, run, zero)
        pressed, pulled = choose(regular > 0.5, pressed, normal), choose(regular > 0.5, pulled, tangential)
        hold(now, here + at.NORMAL_NOW, run, pressed)
        hold(now, here + at.TANGENTIAL_NOW, run, pulled)
        displace(faces, sizes.faces, i, run, pressed - normal, pulled - tangential)


@numba.njit(**OPTIONS)
def set_equations(contacts, carried, sizes, i, size, run, zero):
    """Put the two equations of contact `i`: gap and slip undone, or forces at a known ratio, or none."""
    now, faces, scratch = contacts.now, contacts.faces, contacts.scratch
    n, t = 2 * i, 2 * i + 1
    here = i * at.IN_STEP
    status = held(now, here + at.STATUS_NOW, run, zero)
    normal, tangential = held(now, here + at.NORMAL_NOW, run, zero), held(now, here + at.TANGENTIAL_NOW, run, zero)
    closed, sticks = status > 0.5 * STICKING, magnitude(status - STICKING) < 0.5
    ratio = choose(normal > 0.0, tangential, zero) / choose(normal > 0.0, normal, 1.0)
    holds = choose(sticks, 1.0, zero) if set_valued(contacts.codes[i]) else zero
    own_n, own_t = entry(faces, n, COMPLIANCE + n, run, zero), entry(faces, t, COMPLIANCE + t, run, zero)
    give, beyond = held(now, here + at.GIVE, run, zero), held(now, here + at.BEYOND, run, zero)
    mirrors = sizes.space and is_second(contacts.codes, i)
    own_n = zero + 1.0 if mirrors else own_n
    for j in range(size):
        upright, level = entry(faces, n, COMPLIANCE + j, run, zero), entry(faces, t, COMPLIANCE + j, run, zero)
        diagonal_n, diagonal_t = (own_n if j == n else zero), (own_t if j == t else zero)
        if mirrors:
            # The second pair of rows has the normal force of the first.
            upright = zero - 1.0 if j == n - 2 else diagonal_n
        elif j == n:
            upright = upright + give
        if j == n:
            diagonal_t = choose(closed, ratio * own_t, zero)
        set_entry(scratch, j, n, run, choose(closed, upright, diagonal_n))
        set_entry(scratch, j, t, run, choose(holds > 0.5, level, diagonal_t))
    gap, slip = held(now, here + at.FREE_GAP, run, zero), held(now, here + at.FREE_SLIP, run, zero)
    set_entry(scratch, n, size, run, zero if mirrors else choose(closed, -gap - beyond, zero))
    set_entry(scratch, t, size, run, choose(holds > 0.5, -slip - strayed(carried, i, run, zero), zero))


@numba.njit(**OPTIONS)
def eliminate(scratch, size, blocks, per_block, run, regular, zero):
    """Solve the system in place by Gauss's elimination without exchange of rows; return where it is regular.

    A contact's own compliance is on the diagonal. What this loses of digits, the sweep that follows finds.
    """
    for k in range(size):
        pivot = entry(scratch, k, k, run, zero)
        regular = choose(magnitude(pivot) > 0.0, regular, zero)
        inverse = 1.0 / choose(regular > 0.5, pivot, 1.0)
        right = entry(scratch, k, size, run, zero)
        for row in range(k + 1, size):
            factor = entry(scratch, k, row, run, zero) * inverse
            if anywhere(magnitude(factor) > 0.0):
                for block in range(k // per_block, blocks):
                    changed = fused(-factor, load(scratch, block, k, run), load(scratch, block, row, run))
                    store(scratch, block, row, run, changed)
                set_entry(scratch, row, size, run, fused(-factor, right, entry(scratch, row, size, run, zero)))
    for back in range(size):
        k = size - 1 - back
        pivot = choose(regular > 0.5, entry(scratch, k, k, run, zero), 1.0)
        found = entry(scratch, k, size, run, zero) / pivot
        set_entry(scratch, k, size, run, found)
        for row in range(k):
            left = fused(-entry(scratch, k, row, run, zero), found, entry(scratch, row, size, run, zero))
            set_entry(scratch, row, size, run, left)
    return regular
