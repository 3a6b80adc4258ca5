"""Step 5 for any number of contacts: block Gauss-Seidel over the exact solution of one, from the last forces.

Numbers of contact `i` of a run lie in rows ``i * count + kind``. Nothing is compiled for contacts in space
if `space` is None.
"""

import math
from typing import NamedTuple

from ..contact.exact import SLIDING, STICKING
from ..contact.in_space import carried_in_space, free_of_own
from ..contact.solves import carried_by, no_way, strayed_in_plane
from ..contact.tangents import choose_along, held_along
from ..contact.yielding import comes_close, solve_and_keep
from ..lanes.compiled import entry, inlined, pasted
from ..lanes.operations import Array, Number, Pair, Runs, anywhere, choose, component, everywhere, held, hold, magnitude
from ..layout import columns as at
from ..layout.contact_values import Free, Tangents, Touch, TouchInSpace
from ..layout.parts import Contacts, Sizes, Timing
from ..layout.rows import COMPLIANCE, DISPLACEMENT, has_b
from .direct import solve_states
from .displacements import displace, displace_freely, displace_in_space, own_compliance
from .together import AT_ONCE, all_under_coulomb, solve_together

# Sweeps before the first direct solve for the forces of the states found, and between direct solves.
FIRST_DIRECT_SOLVE, SWEEPS_PER_DIRECT_SOLVE = 1, 8
# Sweeps after which contacts are solved together, and contacts under laws other than Coulomb's that have broken away in
# this step are no longer held by their static coefficient; most attempts to solve contacts together.
PATIENCE, ATTEMPTS = 24, 24
# Number of contacts in space from which they are solved together at once.
MANY = 16
# Mark of contacts whose friction then acts against the slip of the step alone.
LATE = 0.25
# Tolerance of the gaps and slips that remain, relative to those that the forces undo, over that of the forces.
GAPS = 0.01
# Smallest ratio assumed of the changes still to come to the last change, and that where changes do not fall.
LEAST_TO_COME, MOST_TO_COME = 0.1, 1e3
# Change of a force by rounding alone, relative to the largest.
ROUND_OFF = 1e-14
# Relative rounding of the difference of two abscissas.
ROUNDING = 1e-15


@inlined
def is_alone(sizes: Sizes) -> bool:
    """Return whether there is one contact."""
    return sizes.contacts == 1


@inlined
def start_from_last(
    space: bool | None, contacts: Contacts, carried: Array, touching: Number, sizes: Sizes, runs: Runs
) -> None:
    """Start contacts that were closed from the forces of the last step, in runs with any contact touching."""
    faces, now = contacts.faces, contacts.now
    # A single contact needs no start: it is solved at once.
    warm = runs.zero if is_alone(sizes) else choose(touching > 0.5, 1.0, runs.zero)
    displace_freely(space, contacts, sizes.contacts, runs)
    for i in range(sizes.contacts):
        here, base = i * at.IN_STEP, i * at.CARRIED
        was_closed = warm * held(carried, base + at.STATUS, runs) > 0.5 * STICKING
        normal = choose(was_closed, held(carried, base + at.LAST_NORMAL, runs), runs.zero)
        tangential = choose(was_closed, held(carried, base + at.LAST_TANGENTIAL, runs), runs.zero)
        hold(now, here + at.NORMAL_NOW, runs, normal)
        hold(now, here + at.TANGENTIAL_NOW, runs, tangential)
        status = choose(normal > 0.0, held(carried, base + at.STATUS, runs), runs.zero)
        hold(now, here + at.STATUS_NOW, runs, status)
        hold(now, here + at.JAMMED_NOW, runs, runs.zero)
        close = comes_close(i, held(now, here + at.FREE_GAP, runs), contacts.constants, carried, runs)
        hold(now, here + at.MAY_TOUCH, runs, choose(normal > 0.0, 1.0, close))
        hold(now, here + at.GIVE, runs, runs.zero)
        hold(now, here + at.BEYOND, runs, runs.zero)
        hold(now, here + at.BROKE, runs, runs.zero)
        hold(now, here + at.LET_GO, runs, runs.zero)
        in_space = False
        if space is not None:
            in_space = has_b(contacts.rows, i)
            if in_space:
                last = held_along(carried, base + at.LAST_TANGENTIAL, base + at.LAST_TANGENTIAL_B, runs)
                pulled = choose_along(was_closed, last, Tangents(runs.zero, runs.zero))
                hold(now, here + at.TANGENTIAL_NOW_B, runs, pulled.b)
                if anywhere(normal > 0.0):
                    displace_in_space(faces, sizes.faces, contacts.rows[i], runs, normal, pulled)
        if not in_space and anywhere(normal > 0.0):
            displace(faces, sizes.faces, contacts.rows[i], runs, normal, tangential)


class Sweep(NamedTuple):
    """Result of a sweep over all contacts.

    Attributes
    ----------
    change, largest : number
        Largest change of a force, and the largest force [N].
    misfit, reach : number
        Largest gap or slip that a contact still had to undo, and the largest gap that the force of one undoes [m].
    settled : number
        Whether no state changed.
    """

    change: Number
    largest: Number
    misfit: Number
    reach: Number
    settled: Number


@pasted
def touch_in_plane(i: int, contacts: Contacts, carried: Array, step: Number, runs: Runs) -> Touch:
    """Solve contact `i` of the plane without its own forces."""
    now, here, n = contacts.now, i * at.IN_STEP, contacts.rows[i]
    w = own_compliance(contacts.faces, n, runs)
    normal, tangential = held(now, here + at.NORMAL_NOW, runs), held(now, here + at.TANGENTIAL_NOW, runs)
    gap = component(contacts.faces, n, DISPLACEMENT, runs) - (w.nn * normal - w.nt * tangential)
    slip = component(contacts.faces, n + 1, DISPLACEMENT, runs) - (w.tn * normal - w.tt * tangential)
    free = Free(gap, slip, strayed_in_plane(carried, i, runs), w, held(now, here + at.LET_GO, runs))
    return solve_and_keep(i, free, carried_by(carried, i, runs), contacts, carried, step, runs)


@pasted
def touch_in_space(i: int, contacts: Contacts, carried: Array, step: Number, runs: Runs) -> TouchInSpace:
    """Solve contact `i` of space without its own forces."""
    now, here = contacts.now, i * at.IN_STEP
    normal = held(now, here + at.NORMAL_NOW, runs)
    pulled = held_along(now, here + at.TANGENTIAL_NOW, here + at.TANGENTIAL_NOW_B, runs)
    free, before = free_of_own(contacts, carried, i, normal, pulled, runs), carried_in_space(carried, i, runs)
    return solve_and_keep(i, free, before, contacts, carried, step, runs)


@inlined
def put_touch(i: int, touch: Touch, done: Number, contacts: Contacts, runs: Runs) -> tuple[Number, Number, Number]:
    """Set forces and status of contact `i` in runs not `done`; return the changes of its forces and of its status."""
    now, here, goes_on = contacts.now, i * at.IN_STEP, done < 0.5
    was_normal, was_tangential = held(now, here + at.NORMAL_NOW, runs), held(now, here + at.TANGENTIAL_NOW, runs)
    was, was_jammed = held(now, here + at.STATUS_NOW, runs), held(now, here + at.JAMMED_NOW, runs)
    normal, tangential = choose(goes_on, touch.normal, was_normal), choose(goes_on, touch.tangential, was_tangential)
    status = choose(goes_on, touch.status, was)
    hold(now, here + at.NORMAL_NOW, runs, normal)
    hold(now, here + at.TANGENTIAL_NOW, runs, tangential)
    hold(now, here + at.STATUS_NOW, runs, status)
    hold(now, here + at.JAMMED_NOW, runs, choose(goes_on, touch.jammed, was_jammed))
    hold(now, here + at.BROKE, runs, choose(status > SLIDING - 0.5, 1.0, held(now, here + at.BROKE, runs)))
    return normal - was_normal, tangential - was_tangential, status - was


@inlined
def put_touch_in_space(
    i: int, touch: TouchInSpace, done: Number, contacts: Contacts, runs: Runs
) -> tuple[Number, Tangents, Number]:
    """Do `put_touch` for a contact in space."""
    now, b = contacts.now, i * at.IN_STEP + at.TANGENTIAL_NOW_B
    was = held(now, b, runs)
    along_a = Touch(touch.normal, touch.tangential.a, touch.status, touch.jammed, no_way(runs))
    more, pulled, turned = put_touch(i, along_a, done, contacts, runs)
    hold(now, b, runs, choose(done < 0.5, touch.tangential.b, was))
    return more, Tangents(pulled, held(now, b, runs) - was), turned


@pasted
def sweep_once(
    space: bool | None, contacts: Contacts, carried: Array, sizes: Sizes, step: Number, done: Number, runs: Runs
) -> Sweep:
    """Solve contacts that may touch in turn, in runs not `done`."""
    faces, now = contacts.faces, contacts.now
    change, largest, misfit, reach, settled = runs.zero, runs.zero, runs.zero, runs.zero, runs.zero + 1.0
    for i in range(sizes.contacts):
        here, n = i * at.IN_STEP, contacts.rows[i]
        may_touch = held(now, here + at.MAY_TOUCH, runs)
        may_touch = choose(component(faces, n, DISPLACEMENT, runs) < 0.0, 1.0, may_touch)
        if not anywhere(may_touch > 0.5):
            continue
        hold(now, here + at.MAY_TOUCH, runs, may_touch)
        w, more, pulled, turned = own_compliance(faces, n, runs), runs.zero, runs.zero, runs.zero
        in_space = False
        if space is not None:
            in_space = has_b(contacts.rows, i)
            if in_space:
                pressed = touch_in_space(i, contacts, carried, step, runs)
                more, changed, turned = put_touch_in_space(i, pressed, done, contacts, runs)
                displace_in_space(faces, sizes.faces, n, runs, more, changed)
                change, pulled = largest_of(change, magnitude(changed.b)), changed.a
                misfit = largest_of(misfit, slipped_along_b(faces, n, changed.b, runs))
        if not in_space:
            touch = touch_in_plane(i, contacts, carried, step, runs)
            more, pulled, turned = put_touch(i, touch, done, contacts, runs)
            displace(faces, sizes.faces, n, runs, more, pulled)
        settled = choose(magnitude(turned) > 0.5, runs.zero, settled)
        normal, tangential = held(now, here + at.NORMAL_NOW, runs), held(now, here + at.TANGENTIAL_NOW, runs)
        change = largest_of(change, largest_of(magnitude(more), magnitude(pulled)))
        largest = largest_of(largest, largest_of(normal, magnitude(tangential)))
        opened, slipped = magnitude(w.nn * more - w.nt * pulled), magnitude(w.tn * more - w.tt * pulled)
        misfit = largest_of(misfit, largest_of(opened, slipped))
        reach = largest_of(reach, w.nn * normal)
    return Sweep(change, largest, misfit, reach, settled)


@inlined
def slipped_along_b(faces: Array, n: int, changed: Number, runs: Runs) -> Number:
    """Return the slip along tangent b that a change of the force along it undoes."""
    return magnitude(component(faces, n + 2, COMPLIANCE + n + 2, runs) * changed)


@inlined
def rounding_of_slips(space: bool | None, carried: Array, sizes: Sizes, runs: Runs) -> Number:
    """Return the rounding error of slips, which are differences of abscissas."""
    farthest = runs.zero
    for i in range(sizes.contacts):
        farthest = largest_of(farthest, magnitude(held(carried, i * at.CARRIED + at.MATERIAL, runs)))
        if space is not None:
            farthest = largest_of(farthest, magnitude(held(carried, i * at.CARRIED + at.MATERIAL_B, runs)))
    return ROUNDING * farthest


@inlined
def largest_of(one: Number, other: Number) -> Number:
    """Return the larger of two numbers, the first if either is not a number."""
    return choose(other > one, other, one)


@inlined
def become_late(contacts: Contacts, sizes: Sizes, together: bool, runs: Runs) -> None:
    """Let friction act against the slip of the step alone; hold no contact that has broken away under other laws."""
    for i in range(sizes.contacts):
        here = i * at.IN_STEP
        broke = choose(held(contacts.now, here + at.BROKE, runs) > 0.5, 1.0, runs.zero + LATE)
        hold(contacts.now, here + at.LET_GO, runs, runs.zero + LATE if together else broke)


@entry
def solve_closed(
    space: bool | None, contacts: Contacts, carried: Array, touching: Number, sizes: Sizes, timing: Timing, runs: Runs
) -> Pair:
    """Solve contacts in turn until no force changes; return the number of sweeps and the error from the changes.

    Runs without any contact `touching` have no forces. The error is relative to the largest force. Many contacts in
    space are solved together first. A direct solve helps sweeps that converge slowly with unchanged states; contacts
    that still do not settle are solved together. Under laws other than Coulomb's a contact that was held and breaks
    away may have no consistent state in which it could be held again: it is then let go. Results do not depend on the
    runs side by side: a run that is done does not change.
    Compiled once for the march and for the start.
    """
    start_from_last(space, contacts, carried, touching, sizes, runs)
    if not anywhere(touching > 0.5):
        return runs.zero, runs.zero
    done = choose(touching > 0.5, runs.zero, 1.0)
    rounding = rounding_of_slips(space, carried, sizes, runs)
    made, error, before = runs.zero, choose(touching > 0.5, math.inf, runs.zero), runs.zero + math.inf
    given_up, together = runs.zero, all_under_coulomb(contacts.codes)
    if sizes.space and sizes.contacts >= MANY:
        found, made, left = solve_together(space, contacts, carried, sizes, (0, AT_ONCE), 1.0 - done, timing, runs)
        error, done = choose(found > 0.5, left, error), choose(found > 0.5, 1.0, done)
        if everywhere(done > 0.5):
            return made, error
    for sweep in range(timing.sweeps):
        change, largest, misfit, reach, settled = sweep_once(space, contacts, carried, sizes, timing.step, done, runs)
        goes_on = done < 0.5
        exact = change <= ROUND_OFF * largest
        # The changes of a linear iteration fall by a constant factor, which gives the sum of those still to come. From
        # forces that were nearly right, the first changes fall faster.
        falls = choose(change < before, before, math.inf) < math.inf
        size = choose(largest > 0.0, largest, 1.0)
        to_come = largest_of(change / choose(falls, before - change, 1.0), runs.zero + LEAST_TO_COME)
        estimate = change / size * choose(falls, to_come, MOST_TO_COME)
        estimate = choose(exact, change / size, estimate)
        # With more rows than modes, forces keep drifting among sets that close the same gaps.
        closed = misfit <= GAPS * timing.tolerance * reach + rounding
        estimate = choose(closed, choose(reach > 0.0, misfit, runs.zero) / choose(reach > 0.0, reach, 1.0), estimate)
        error, made = choose(goes_on, estimate, error), choose(goes_on, sweep + 1.0, made)
        done = choose(exact, 1.0, choose(error <= timing.tolerance, 1.0, done))
        if is_alone(sizes):
            return made, runs.zero
        if everywhere(done > 0.5):
            break
        before = change
        # In space the directions of friction turn from sweep to sweep: a direct solve after each of the first sweeps is
        # Newton's method for them. Late solves only find other forces for the same motions.
        early = sweep + 1 <= SWEEPS_PER_DIRECT_SOLVE if sizes.space else sweep + 1 == FIRST_DIRECT_SOLVE
        late = (sizes.space or together) and sweep + 1 > PATIENCE
        if early or ((sweep + 1) % SWEEPS_PER_DIRECT_SOLVE == 0 and not late):
            changeable = choose(given_up > 0.5, settled, runs.zero + 1.0) if early else settled
            tried = choose(done < 0.5, changeable, runs.zero)
            if anywhere(tried > 0.5):
                given_up = solve_states(space, contacts, carried, sizes, timing.step, runs, tried)
                again = sizes.space and sweep > 0 and early
                before = choose(tried > 0.5, change if again else runs.zero + math.inf, before)
        if sweep + 1 == PATIENCE:
            become_late(contacts, sizes, together, runs)
        attempt = sweep + 1 - PATIENCE
        if attempt % SWEEPS_PER_DIRECT_SOLVE == 0 and 0 <= attempt < ATTEMPTS * SWEEPS_PER_DIRECT_SOLVE:
            attempt //= SWEEPS_PER_DIRECT_SOLVE
            tried = choose(done > 0.5, runs.zero, 1.0)
            found, _, left = solve_together(
                space, contacts, carried, sizes, (attempt, attempt + 1), tried, timing, runs
            )
            error, done = choose(found > 0.5, left, error), choose(found > 0.5, 1.0, done)
            before = runs.zero + math.inf
            if everywhere(done > 0.5):
                break
    return made, error
