"""Steps of a single contact between bodies of uncoupled modes."""

from typing import Any

from . import layout as at
from .bookkeeping import credit, keep_books, keep_place
from .compiled import pasted
from .contact_values import Compliance, Free, Moved, Touch
from .lanes import Array, Number, Numbers, Runs, anywhere, choose, held, hold
from .leaving import beyond_ends
from .parts import Contacts, Parts, Timing
from .recording import keep_probes_at
from .solves import carried_by, law_of, strayed
from .trying import try_one
from .yielding import comes_close, path_of, solve_any, yields_of


@pasted
def solve_single(free: Numbers, contacts: Contacts, carried: Array, w: Compliance, timing: Timing, runs: Runs) -> Touch:
    """Return normal and tangential force, status and whether it jams, for a single contact (step 5)."""
    _, gap, slip = free
    hold(contacts.now, at.GIVE, runs, runs.zero)
    hold(contacts.now, at.BEYOND, runs, runs.zero)
    if not anywhere(comes_close(0, gap, contacts.constants, carried, runs) > 0.5):
        return Touch(runs.zero, runs.zero, runs.zero, runs.zero)
    alone = Free(gap, slip, strayed(carried, 0, runs), w, runs.zero)
    law, before = law_of(0, contacts, runs), carried_by(carried, 0, runs)
    yields, path = yields_of(0, contacts.constants, runs), path_of(0, carried, runs)
    touch, give, beyond = solve_any(alone, law, before, yields, path, timing.step, runs.zero)
    hold(contacts.now, at.GIVE, runs, give)
    hold(contacts.now, at.BEYOND, runs, beyond)
    return touch


@pasted
def touch_one(
    parts: Parts, n: int, loop: tuple[Touch, bool, int, Number], ended: Number, runs: Runs
) -> tuple[Any, ...]:
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
    free, w_nn, w_tt, done = try_one(modes, paths, contacts, state, parts.imposed, after, last, pending, sine, runs)
    if pending:
        credit(state.energies, done[0], done[1], done[2] * advance, runs)
        keep_probes_at(parts, n - 1, runs)
    # A run that has ended has no contact.
    free = (free[0], choose(ended > 0.0, runs.zero, free[1]), free[2])
    w_nt = held(contacts.fixed, 1, runs)
    w = Compliance(w_nn, w_nt, w_nt, choose(ended > 0.0, 1.0, w_tt))
    leaves, why = runs.zero, runs.zero
    if parts.sizes.paths:
        leaves, why = beyond_ends(0, free[0], contacts, state, runs)
    return free, w, solve_single(free, contacts, state.carried, w, parts.timing, runs), leaves, why


@pasted
def keep_one(parts: Parts, n: int, free: Numbers, w: Compliance, touch: Touch, runs: Runs) -> Number:
    """Do the bookkeeping of a single contact; return half its advance in the last two steps."""
    contacts, state = parts.contacts, parts.state
    normal, tangential = touch.normal, touch.tangential
    gap, slip = free[1] + w.nn * normal - w.nt * tangential, free[2] + w.tn * normal - w.tt * tangential
    place = free[0] + w.nt * normal - held(contacts.fixed, 2, runs) * tangential
    moved = Moved(free[1], free[2], gap, slip)
    keep_books(0, w, touch, moved, contacts, state, parts.imposed, parts.timing, n, runs)
    hold(contacts.now, at.NORMAL_NOW, runs, normal)
    hold(contacts.now, at.TANGENTIAL_NOW, runs, tangential)
    return keep_place(0, state.carried, place, runs)
