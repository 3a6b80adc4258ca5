"""Steps of any number of contacts, or of coupled modes."""

import numba

from . import layout as at
from .block_rows import DISPLACEMENT
from .bookkeeping import (
    add,
    credit,
    driven_work,
    keep_anchor,
    keep_books,
    keep_forces,
    keep_motion,
    keep_place,
    keep_tangential,
    share_states,
    store_in,
)
from .circles import convected
from .contacts import solve_closed
from .faces import own_compliance
from .friction import set_valued
from .lanes import anywhere, choose, component, held, hold
from .leaving import any_beyond_ends
from .modes import OPTIONS, PASTED
from .solves import resting, strayed
from .space import (
    along,
    carried_in_space,
    direction,
    free_in_space,
    is_second,
    next_in_space,
    on,
    pair_of,
    softened,
    whole_compliance,
)
from .trying import complete_many, place_after, soften, try_many
from .yielding import comes_close

# Error of the contact forces, relative to the largest, above which the run stops.
UNBELIEVABLE = 1e-3


@numba.njit(**PASTED)
def solve_several(space, parts, run, runs, zero):
    """Set forces, status, gap and slip of all contacts (steps 4 and 5); return the error of the forces."""
    sizes, contacts, state, timing = parts.sizes, parts.contacts, parts.state, parts.timing
    now, faces, count = contacts.now, contacts.faces, sizes.contacts
    touching, closed = zero, zero
    for i in range(count):
        gap = held(now, i * at.IN_STEP + at.FREE_GAP, run, zero)
        close = comes_close(i, gap, contacts.constants, state.carried, run, zero)
        touching = choose(close > 0.5, 1.0, touching)
        closed = choose(held(state.carried, i * at.CARRIED + at.STATUS, run, zero) > 0.5, 1.0, closed)
    if sizes.paths and (anywhere(touching > 0.5) or anywhere(closed > 0.5)):
        soften(parts.modes, parts.paths, contacts, sizes, run, zero)
    made, error = solve_closed(space, contacts, state.carried, touching, sizes, timing, run, runs, zero)
    most = held(state.energies, at.ITERATIONS, run, zero)
    hold(state.energies, at.ITERATIONS, run, choose(made > most, made, most))
    add(state.energies, at.UNSOLVED, run, choose(error <= timing.tolerance, zero, 1.0), zero)
    for i in range(count):
        here, w = i * at.IN_STEP, own_compliance(faces, i, run, zero)
        normal, tangential = held(now, here + at.NORMAL_NOW, run, zero), held(now, here + at.TANGENTIAL_NOW, run, zero)
        gap, slip = (
            component(faces, 2 * i, DISPLACEMENT, run, zero),
            component(faces, 2 * i + 1, DISPLACEMENT, run, zero),
        )
        hold(now, here + at.NEW_GAP, run, gap)
        hold(now, here + at.NEW_SLIP, run, slip)
        # From here on, free gap and slip lack the forces of this contact only.
        hold(now, here + at.FREE_GAP, run, gap - w[0] * normal + w[1] * tangential)
        hold(now, here + at.FREE_SLIP, run, slip - w[2] * normal + w[3] * tangential)
    if space is not None:
        free_in_space(contacts, sizes, run, zero)
    return error


@numba.njit(**OPTIONS)
def keep_unsolved(contacts, state, sizes, unsolved, run, zero):
    """Carry the forces that did not converge, for the error message."""
    for i in range(sizes.contacts):
        here, base = i * at.IN_STEP, i * at.CARRIED
        for row, found in (
            (at.LAST_NORMAL, at.NORMAL_NOW),
            (at.LAST_TANGENTIAL, at.TANGENTIAL_NOW),
            (at.STATUS, at.STATUS_NOW),
        ):
            value = held(contacts.now, here + found, run, zero)
            kept = choose(unsolved > 0.5, value, held(state.carried, base + row, run, zero))
            hold(state.carried, base + row, run, kept)


@numba.njit(**PASTED)
def keep_books_in_space(i, contacts, state, imposed, timing, n, run, runs, zero):
    """Do the bookkeeping of contact `i` in space: along the direction of its friction, then for each tangent."""
    now, carried, here, base = contacts.now, state.carried, i * at.IN_STEP, i * at.CARRIED
    normal, status = held(now, here + at.NORMAL_NOW, run, zero), held(now, here + at.STATUS_NOW, run, zero)
    forces = pair_of(now, here + at.TANGENTIAL_NOW, at.IN_STEP, run, zero)
    slips = pair_of(now, here + at.NEW_SLIP, at.IN_STEP, run, zero)
    free = pair_of(now, here + at.FREE_SLIP, at.IN_STEP, run, zero)
    was, last, earlier, states, last_normal, last_forces, pasts = carried_in_space(carried, i, run, zero)
    c, s = direction(forces, last_forces)
    before = (
        was,
        on(last, c, s),
        on(earlier, c, s),
        states[0],
        last_normal,
        on(last_forces, c, s),
        on(pasts, c, s),
    )
    law = contacts.codes[i]
    store_in(i, held(now, here + at.NEW_GAP, run, zero), contacts, state, run, zero)
    stuck = zero
    if not set_valued(law) or anywhere(status + was > 0.5):
        give, beyond = held(now, here + at.GIVE, run, zero), held(now, here + at.BEYOND, run, zero)
        moved = (
            held(now, here + at.FREE_GAP, run, zero) + beyond,
            on(free, c, s),
            held(now, here + at.NEW_GAP, run, zero),
            on(slips, c, s),
        )
        touch = (normal, on(forces, c, s), status, held(now, here + at.JAMMED_NOW, run, zero))
        whole = whole_compliance(contacts.faces, i, run, zero)
        w = along(softened(whole, give), c, s)
        strays = strayed(carried, i, run, zero), strayed(carried, i + 1, run, zero)
        at_rest = held(contacts.constants, i * at.CONTACT_CONSTANTS + at.AT_REST, run, zero)
        away = on(strays, c, s)
        closed = share_states(i, touch, moved, before, carried, contacts.sums, w, away, law, at_rest, run, zero)
        for k in range(2):
            keep_anchor(i + k, slips[k], law, status, was, carried, run, zero)
        if imposed.motion.shape[0] > 1:
            pushes = (normal, forces[0]), (zero, forces[1])
            driven = driven_work(i, pushes[0], imposed.motion, n, run, runs, zero)
            driven += driven_work(i + 1, pushes[1], imposed.motion, n, run, runs, zero)
            add(state.energies, at.CONTACT_WORK, run, -driven, zero)
            add(state.energies, at.DRIVE_WORK, run, driven, zero)
        past, states, stuck = next_in_space(
            (normal, status),
            moved[0],
            free,
            strays,
            softened(whole, give),
            law,
            contacts.laws,
            i * runs + run,
            (was, last, earlier, states, last_normal, last_forces, forces, pasts),
            held(now, here + at.LET_GO, run, zero),
            timing.step,
        )
        hold(carried, base + at.STUCK_SHARE, run, stuck)
        for k in range(2):
            hold(carried, base + k * at.CARRIED + at.PAST_RATIO, run, past[k])
            hold(carried, base + k * at.CARRIED + at.FRICTION_STATE, run, states[k])
        lost = keep_forces(i, touch, moved, carried, contacts, closed, run, zero)
        add(state.energies, at.FRICTION_LOSS, run, lost, zero)
        for k in range(2):
            keep_tangential(i + k, forces[k], carried, contacts.sums, run, zero)
        hold(carried, base + at.CARRIED + at.STATUS, run, resting(status))
        hold(carried, base + at.CARRIED + at.LAST_NORMAL, run, normal)
    gap = held(now, here + at.NEW_GAP, run, zero)
    for k in range(2):
        keep_motion(i + k, (gap, gap, gap, slips[k]), stuck, (was, last[k]), carried, run, zero)


@numba.njit(**PASTED)
def keep_books_of(i, contacts, state, imposed, timing, n, run, runs, zero):
    """Do the bookkeeping of contact `i` among several."""
    now, here = contacts.now, i * at.IN_STEP
    touch = (
        held(now, here + at.NORMAL_NOW, run, zero),
        held(now, here + at.TANGENTIAL_NOW, run, zero),
        held(now, here + at.STATUS_NOW, run, zero),
        held(now, here + at.JAMMED_NOW, run, zero),
    )
    moved = (
        held(now, here + at.FREE_GAP, run, zero),
        held(now, here + at.FREE_SLIP, run, zero),
        held(now, here + at.NEW_GAP, run, zero),
        held(now, here + at.NEW_SLIP, run, zero),
    )
    w = own_compliance(contacts.faces, i, run, zero)
    keep_books(i, w, touch, moved, contacts, state, imposed, timing, n, run, runs, zero)


@numba.njit(**PASTED)
def touch_many(space, parts, n, ended, run, runs, zero):
    """Try step `n` and solve for the forces of all contacts (steps 1 to 5); return where a run leaves, and why."""
    sizes, contacts, state = parts.sizes, parts.contacts, parts.state
    after = n + 2 if parts.imposed.motion.shape[0] > 1 else 0
    try_many(space, parts, after, ended, run, runs, zero)
    leaves, why = zero, zero
    if sizes.paths:
        leaves, why = any_beyond_ends(sizes, parts.paths, contacts, state, run, zero)
    error = solve_several(space, parts, run, runs, zero)
    unsolved = choose(leaves > 0.5, zero, choose(error <= UNBELIEVABLE, zero, 1.0))
    if anywhere(unsolved > 0.5):
        keep_unsolved(contacts, state, sizes, choose(ended > 0.0, zero, unsolved), run, zero)
        why = choose(unsolved > 0.5, zero + at.CONTACT_UNSOLVED, why)
        leaves = choose(unsolved > 0.5, 1.0, leaves)
    return leaves, why


@numba.njit(**PASTED)
def keep_many(space, parts, n, run, runs, zero):
    """Complete step `n` under the forces of all contacts (step 6), and do their bookkeeping."""
    contacts, state, imposed = parts.contacts, parts.state, parts.imposed
    after = n + 2 if imposed.motion.shape[0] > 1 else 0
    work, lost = complete_many(parts.modes, parts.paths, contacts, parts.sizes, run, zero)
    credit(state.energies, work, lost, zero, run, zero)
    for i in range(parts.sizes.contacts):
        in_space = is_second(contacts.codes, i + 1)
        if space is not None and in_space:
            keep_books_in_space(i, contacts, state, imposed, parts.timing, n, run, runs, zero)
        if not (in_space or is_second(contacts.codes, i)):
            keep_books_of(i, contacts, state, imposed, parts.timing, n, run, runs, zero)
        place, slope = place_after(i, parts.modes, parts.paths, contacts, state, imposed, after, run, runs, zero)
        goes_round = parts.sizes.circles and parts.paths.body_of[i] >= 0
        if space is not None and goes_round and not is_second(contacts.codes, i):
            work = convected(i, place, parts.modes, parts.paths, contacts, parts.turning, state.carried, run, zero)
            add(state.energies, at.CONVECTION_WORK, run, work, zero)
        way = keep_place(i, state.carried, place, run, zero)
        add(state.energies, at.CONVECTION_WORK, run, slope * way, zero)
