"""Steps of a single contact between bodies of uncoupled modes."""

import numba

from . import layout as at
from .bookkeeping import credit, keep_books, keep_place
from .lanes import anywhere, choose, held, hold
from .leaving import beyond_ends
from .modes import PASTED
from .recording import keep_probes_at
from .solves import carried_by, strayed
from .trying import try_one
from .yielding import comes_close, forces_of_any, path_of, yields_of


@numba.njit(**PASTED)
def solve_single(free, contacts, carried, w, timing, run, zero):
    """Return normal and tangential force, status and whether it jams, for a single contact (step 5)."""
    _, gap, slip = free
    hold(contacts.now, at.GIVE, run, zero)
    hold(contacts.now, at.BEYOND, run, zero)
    if not anywhere(comes_close(0, gap, contacts.constants, carried, run, zero) > 0.5):
        return zero, zero, zero, zero
    law, at_rest = contacts.codes[0], held(contacts.constants, at.AT_REST, run, zero)
    away, before = strayed(carried, 0, run, zero), carried_by(carried, 0, run, zero)
    yields, path = yields_of(0, contacts.constants, run, zero), path_of(0, carried, run, zero)
    friction = (law, contacts.laws, run, at_rest)
    normal, tangential, status, jammed, give, beyond = forces_of_any(
        (gap, slip, away, w), friction, before, zero, timing.step, yields, path, zero
    )
    hold(contacts.now, at.GIVE, run, give)
    hold(contacts.now, at.BEYOND, run, beyond)
    return normal, tangential, status, jammed


@numba.njit(**PASTED)
def touch_one(parts, n, loop, ended, run, runs, zero):
    """Complete a pending step of a single contact (step 6), try step `n`, and solve for the forces (steps 1 to 5).

    `loop` are forces and status of the step before, whether it is pending, the rows of its waves, the advance since.

    Returns
    -------
    free, w, touch : tuple
        Abscissa, gap and slip without the forces; compliance; forces, status and whether it jams.
    leaves, why : float or vector
        Where the contact leaves its path, and why.
    """
    modes, paths, contacts, state = parts.modes, parts.paths, parts.contacts, parts.state
    last, pending, sine, advance = loop
    after = n + 2 if parts.imposed.motion.shape[0] > 1 else 0
    free, w_nn, w_tt, done = try_one(
        modes, paths, contacts, state, parts.imposed, after, last, pending, sine, run, runs, zero
    )
    if pending:
        credit(state.energies, done[0], done[1], done[2] * advance, run, zero)
        keep_probes_at(parts, n - 1, run, runs, zero)
    # A run that has ended has no contact.
    free = (free[0], choose(ended > 0.0, zero, free[1]), free[2])
    w_nt = held(contacts.fixed, 1, run, zero)
    w = (w_nn, w_nt, w_nt, choose(ended > 0.0, 1.0, w_tt))
    leaves, why = zero, zero
    if parts.sizes.paths:
        leaves, why = beyond_ends(0, free[0], contacts, state, run, zero)
    return free, w, solve_single(free, contacts, state.carried, w, parts.timing, run, zero), leaves, why


@numba.njit(**PASTED)
def keep_one(parts, n, free, w, touch, run, runs, zero):
    """Do the bookkeeping of a single contact; return half its advance in the last two steps."""
    contacts, state = parts.contacts, parts.state
    normal, tangential = touch[0], touch[1]
    gap, slip = free[1] + w[0] * normal - w[1] * tangential, free[2] + w[2] * normal - w[3] * tangential
    place = free[0] + w[1] * normal - held(contacts.fixed, 2, run, zero) * tangential
    moved = (free[1], free[2], gap, slip)
    keep_books(0, w, touch, moved, contacts, state, parts.imposed, parts.timing, n, run, runs, zero)
    hold(contacts.now, at.NORMAL_NOW, run, normal)
    hold(contacts.now, at.TANGENTIAL_NOW, run, tangential)
    return keep_place(0, state.carried, place, run, zero)
