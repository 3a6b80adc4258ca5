"""Step 5 for any number of contacts: block Gauss-Seidel over the exact solution of one, from the last forces.

Numbers of contact `i` of a run lie in rows ``i * count + kind``.
"""

import math

import numba

from . import layout as at
from .block_rows import COMPLIANCE, DISPLACEMENT
from .contact import SLIDING, STICKING
from .direct import solve_states
from .faces import displace, displace_freely, displace_in_space, own_compliance
from .lanes import anywhere, choose, component, everywhere, held, hold, magnitude
from .modes import ENTRY, OPTIONS, PASTED
from .solves import carried_by, strayed
from .space import free_of_own, is_second, put_second
from .yielding import comes_close, forces_of_any, forces_of_any_in_space, path_of, yields_of

# Sweeps before the first direct solve for the forces of the states found, and between direct solves.
FIRST_DIRECT_SOLVE, SWEEPS_PER_DIRECT_SOLVE = 1, 8
# Sweeps after which a contact that has broken away in this step is no longer held by its static coefficient.
PATIENCE = 24
# Mark of the other contacts, so that those in space know that it is late.
LATE = 0.25
# Tolerance of the gaps and slips that remain, relative to those that the forces undo, over that of the forces.
GAPS = 0.01
# Smallest ratio assumed of the changes still to come to the last change.
LEAST_TO_COME = 0.1
# Change of a force by rounding alone, relative to the largest.
ROUND_OFF = 1e-14
# Relative rounding of the difference of two abscissas.
ROUNDING = 1e-15


@numba.njit(**OPTIONS)
def is_alone(sizes):
    """Return whether there is one contact, which in space has two pairs of rows."""
    return sizes.contacts == (2 if sizes.space else 1)


@numba.njit(**OPTIONS)
def start_from_last(contacts, carried, touching, sizes, run, zero):
    """Start contacts that were closed from the forces of the last step, in runs with any contact touching."""
    faces, now = contacts.faces, contacts.now
    # A single contact needs no start: it is solved at once.
    warm = zero if is_alone(sizes) else choose(touching > 0.5, 1.0, zero)
    displace_freely(faces, now, sizes.contacts, run, zero)
    for i in range(sizes.contacts):
        here, base = i * at.IN_STEP, i * at.CARRIED
        was_closed = warm * held(carried, base + at.STATUS, run, zero) > 0.5 * STICKING
        normal = choose(was_closed, held(carried, base + at.LAST_NORMAL, run, zero), zero)
        tangential = choose(was_closed, held(carried, base + at.LAST_TANGENTIAL, run, zero), zero)
        hold(now, here + at.NORMAL_NOW, run, normal)
        hold(now, here + at.TANGENTIAL_NOW, run, tangential)
        status = choose(normal > 0.0, held(carried, base + at.STATUS, run, zero), zero)
        hold(now, here + at.STATUS_NOW, run, status)
        hold(now, here + at.JAMMED_NOW, run, zero)
        close = comes_close(i, held(now, here + at.FREE_GAP, run, zero), contacts.constants, carried, run, zero)
        hold(now, here + at.MAY_TOUCH, run, choose(normal > 0.0, 1.0, close))
        hold(now, here + at.GIVE, run, zero)
        hold(now, here + at.BEYOND, run, zero)
        hold(now, here + at.BROKE, run, zero)
        hold(now, here + at.LET_GO, run, zero)
        if anywhere(normal > 0.0):
            displace(faces, sizes.faces, i, run, normal, tangential)


@numba.njit(**PASTED)
def forces_of_this(i, gap, slip, w, contacts, carried, let_go, step, run, runs, zero):
    """Return normal force, tangential force, status and whether it jams, for contact `i` of the plane."""
    away, at_rest = (
        strayed(carried, i, run, zero),
        held(contacts.constants, i * at.CONTACT_CONSTANTS + at.AT_REST, run, zero),
    )
    law, number = contacts.codes[i], i * runs + run
    before = carried_by(carried, i, run, zero)
    yields, path = yields_of(i, contacts.constants, run, zero), path_of(i, carried, run, zero)
    friction = (law, contacts.laws, number, at_rest)
    normal, tangential, status, jammed, give, beyond = forces_of_any(
        (gap, slip, away, w), friction, before, let_go, step, yields, path, zero
    )
    hold(contacts.now, i * at.IN_STEP + at.GIVE, run, give)
    hold(contacts.now, i * at.IN_STEP + at.BEYOND, run, beyond)
    return normal, tangential, status, jammed


@numba.njit(**PASTED)
def forces_of_this_in_space(i, contacts, carried, let_go, step, run, runs, zero):
    """Return normal force, both tangential forces, status and whether it jams, for contact `i` in space."""
    free, laws = free_of_own(contacts, carried, i, run, runs, zero)
    gap, slips, strays, w, law, number, before = free
    yields, path = yields_of(i, contacts.constants, run, zero), path_of(i, carried, run, zero)
    normal, first, second, status, jammed, give, beyond = forces_of_any_in_space(
        (gap, slips, strays, w), (law, laws, number), before, let_go, step, yields, path, zero
    )
    hold(contacts.now, i * at.IN_STEP + at.GIVE, run, give)
    hold(contacts.now, i * at.IN_STEP + at.BEYOND, run, beyond)
    return normal, first, second, status, jammed


@numba.njit(**PASTED)
def sweep_once(space, contacts, carried, sizes, step, done, run, runs, zero):
    """Solve contacts that may touch in turn, in runs not `done`; return the changes.

    Nothing is compiled for contacts with two tangents if `space` is None.

    Returns
    -------
    change, largest : float or vector
        Largest change of a force, and the largest force.
    misfit, reach : float or vector
        Largest gap or slip that a contact still had to undo, and the largest gap that the force of one undoes.
    settled : float or vector
        Whether no state changed.
    """
    faces, now = contacts.faces, contacts.now
    change, largest, misfit, reach, settled = zero, zero, zero, zero, zero + 1.0
    for i in range(sizes.contacts):
        here = i * at.IN_STEP
        if is_second(contacts.codes, i):
            continue
        gap = component(faces, 2 * i, DISPLACEMENT, run, zero)
        may_touch = held(now, here + at.MAY_TOUCH, run, zero)
        may_touch = choose(gap < 0.0, 1.0, may_touch)
        if not anywhere(may_touch > 0.5):
            continue
        hold(now, here + at.MAY_TOUCH, run, may_touch)
        slip = component(faces, 2 * i + 1, DISPLACEMENT, run, zero)
        was_normal, was_tangential = (
            held(now, here + at.NORMAL_NOW, run, zero),
            held(now, here + at.TANGENTIAL_NOW, run, zero),
        )
        was, let_go = held(now, here + at.STATUS_NOW, run, zero), held(now, here + at.LET_GO, run, zero)
        w = own_compliance(faces, i, run, zero)
        second, normal, tangential, status, jammed = zero, zero, zero, zero, zero
        in_space = False
        if space is not None:
            in_space = is_second(contacts.codes, i + 1)
            if in_space:
                normal, tangential, second, status, jammed = forces_of_this_in_space(
                    i, contacts, carried, let_go, step, run, runs, zero
                )
        if not in_space:
            gap -= w[0] * was_normal - w[1] * was_tangential
            slip -= w[2] * was_normal - w[3] * was_tangential
            normal, tangential, status, jammed = forces_of_this(
                i, gap, slip, w, contacts, carried, let_go, step, run, runs, zero
            )
        goes_on = done < 0.5
        normal, tangential = choose(goes_on, normal, was_normal), choose(goes_on, tangential, was_tangential)
        status = choose(goes_on, status, was)
        hold(now, here + at.NORMAL_NOW, run, normal)
        hold(now, here + at.TANGENTIAL_NOW, run, tangential)
        hold(now, here + at.STATUS_NOW, run, status)
        hold(now, here + at.JAMMED_NOW, run, choose(goes_on, jammed, held(now, here + at.JAMMED_NOW, run, zero)))
        broke = held(now, here + at.BROKE, run, zero)
        hold(now, here + at.BROKE, run, choose(status > SLIDING - 0.5, 1.0, broke))
        settled = choose(magnitude(status - was) > 0.5, zero, settled)
        more, pulled = normal - was_normal, tangential - was_tangential
        if not in_space:
            displace(faces, sizes.faces, i, run, more, pulled)
        elif space is not None:
            swerved = put_second(contacts, i, run, goes_on, normal, second, status, zero)
            displace_in_space(faces, sizes.faces, i, run, more, pulled, swerved)
            change = largest_of(change, magnitude(swerved))
            across = component(faces, 2 * i + 3, COMPLIANCE + 2 * i + 3, run, zero)
            misfit = largest_of(misfit, magnitude(across * swerved))
        change = largest_of(change, largest_of(magnitude(more), magnitude(pulled)))
        largest = largest_of(largest, largest_of(normal, magnitude(tangential)))
        opened, slipped = magnitude(w[0] * more - w[1] * pulled), magnitude(w[2] * more - w[3] * pulled)
        misfit = largest_of(misfit, largest_of(opened, slipped))
        reach = largest_of(reach, w[0] * normal)
    return change, largest, misfit, reach, settled


@numba.njit(**OPTIONS)
def rounding_of_slips(carried, sizes, run, zero):
    """Return the rounding error of slips, which are differences of abscissas."""
    farthest = zero
    for i in range(sizes.contacts):
        farthest = largest_of(farthest, magnitude(held(carried, i * at.CARRIED + at.MATERIAL, run, zero)))
    return ROUNDING * farthest


@numba.njit(**OPTIONS)
def largest_of(one, other):
    """Return the larger of two numbers, the first if either is not a number."""
    return choose(other > one, other, one)


@numba.njit(**ENTRY)
def solve_closed(space, contacts, carried, touching, sizes, timing, run, runs, zero):
    """Solve contacts in turn until no force changes; return the number of sweeps and the error from the changes.

    Runs without any contact `touching` have no forces. The error is relative to the largest force. A direct solve helps
    sweeps that converge slowly with unchanged states. A contact that was held and breaks away may have no consistent
    state in which it could be held again: it is then let go. Results do not depend on the runs side by side: a run that
    is done does not change. Compiled once for the march and for the start.
    """
    start_from_last(contacts, carried, touching, sizes, run, zero)
    if not anywhere(touching > 0.5):
        return zero, zero
    done = choose(touching > 0.5, zero, 1.0)
    rounding = rounding_of_slips(carried, sizes, run, zero)
    made, error, before = zero, choose(touching > 0.5, math.inf, zero), zero + math.inf
    given_up = zero
    for sweep in range(timing.sweeps):
        change, largest, misfit, reach, settled = sweep_once(
            space, contacts, carried, sizes, timing.step, done, run, runs, zero
        )
        goes_on = done < 0.5
        exact = change <= ROUND_OFF * largest
        # The changes of a linear iteration fall by a constant factor, which gives the sum of those still to come. From
        # forces that were nearly right, the first changes fall faster.
        falls = choose(change < before, before, math.inf) < math.inf
        size = choose(largest > 0.0, largest, 1.0)
        to_come = largest_of(change / choose(falls, before - change, 1.0), zero + LEAST_TO_COME)
        estimate = choose(falls, change / size * to_come, math.inf)
        estimate = choose(exact, change / size, estimate)
        # With more rows than modes, forces keep drifting among sets that close the same gaps.
        closed = misfit <= GAPS * timing.tolerance * reach + rounding
        estimate = choose(closed, choose(reach > 0.0, misfit, zero) / choose(reach > 0.0, reach, 1.0), estimate)
        error, made = choose(goes_on, estimate, error), choose(goes_on, sweep + 1.0, made)
        done = choose(exact, 1.0, choose(error <= timing.tolerance, 1.0, done))
        if is_alone(sizes):
            return made, zero
        if everywhere(done > 0.5):
            break
        before = change
        # In space the directions of friction turn from sweep to sweep: a direct solve after each of the first sweeps is
        # Newton's method for them. Late solves only find other forces for the same motions.
        early = sweep + 1 <= SWEEPS_PER_DIRECT_SOLVE if sizes.space else sweep + 1 == FIRST_DIRECT_SOLVE
        late = sizes.space and sweep + 1 > PATIENCE
        if early or ((sweep + 1) % SWEEPS_PER_DIRECT_SOLVE == 0 and not late):
            changeable = choose(given_up > 0.5, settled, zero + 1.0) if early else settled
            tried = choose(done < 0.5, changeable, zero)
            if anywhere(tried > 0.5):
                given_up = solve_states(contacts, carried, sizes, timing.step, run, tried, zero)
                again = sizes.space and sweep > 0 and early
                before = choose(tried > 0.5, change if again else zero + math.inf, before)
        if sweep + 1 == PATIENCE:
            for i in range(sizes.contacts):
                here = i * at.IN_STEP
                broke = held(contacts.now, here + at.BROKE, run, zero)
                hold(contacts.now, here + at.LET_GO, run, choose(broke > 0.5, 1.0, zero + LATE))
    return made, error
