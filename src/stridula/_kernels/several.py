"""Steps of any number of contacts, or of coupled modes."""

from .books.bookkeeping import (
    credit,
    driven_along_b,
    driven_work,
    keep_anchor,
    keep_books,
    keep_forces,
    keep_gap,
    keep_place,
    keep_slip,
    share_states,
    store_in,
)
from .books.leaving import any_beyond_ends
from .contact.friction import set_valued
from .contact.in_space import (
    carried_in_space,
    direction,
    free_along,
    free_in_space,
    past_along,
    strayed_in_space,
    whole_compliance,
)
from .contact.law_in_space import next_in_space
from .contact.solves import carried_by, law_of, no_way, strayed_in_plane, way_of
from .contact.tangents import along, held_along, hold_along
from .contact.yielding import about_indentation, comes_close
from .contacts.circles import convected
from .contacts.displacements import own_compliance
from .contacts.heating import heat_contacts
from .contacts.profiles import follow_profile
from .contacts.sweeps import solve_closed
from .lanes.compiled import inlined, pasted
from .lanes.operations import Number, Pair, Runs, add, anywhere, choose, component, held, hold
from .layout import columns as at
from .layout.contact_values import Free, FreeInSpace, Moved, Tangents, Touch
from .layout.parts import Carried, Contacts, Parts, Sizes
from .layout.rows import DISPLACEMENT, has_b
from .modes.springs import pull_springs
from .trying import complete_many, place_after, place_after_along_b, soften, try_many

# Error of the contact forces, relative to the largest, above which the run stops.
UNBELIEVABLE = 1e-3


@pasted
def solve_several(space: bool | None, parts: Parts, runs: Runs) -> Number:
    """Set forces, status, gap and slip of all contacts (steps 4 and 5); return the error of the forces."""
    sizes, contacts, state, timing = parts.sizes, parts.contacts, parts.state, parts.timing
    now, count = contacts.now, sizes.contacts
    touching, closed = runs.zero, runs.zero
    for i in range(count):
        gap = held(now, i * at.IN_STEP + at.FREE_GAP, runs)
        close = comes_close(i, gap, contacts.constants, state.carried, runs)
        touching = choose(close > 0.5, 1.0, touching)
        closed = choose(held(state.carried, i * at.CARRIED + at.STATUS, runs) > 0.5, 1.0, closed)
    if sizes.paths and (anywhere(touching > 0.5) or anywhere(closed > 0.5)):
        soften(space, parts.modes, parts.paths, contacts, sizes, runs)
    made, error = solve_closed(space, contacts, state.carried, touching, sizes, timing, runs)
    most = held(state.energies, at.ITERATIONS, runs)
    hold(state.energies, at.ITERATIONS, runs, choose(made > most, made, most))
    add(state.energies, at.UNSOLVED, runs, choose(error <= timing.tolerance, runs.zero, 1.0))
    for i in range(count):
        # From here on, free gap and slip lack the forces of this contact only.
        if space is not None and has_b(contacts.rows, i):
            free_in_space(i, contacts, runs)
        else:
            free_in_plane(i, contacts, runs)
    return error


@inlined
def free_in_plane(i: int, contacts: Contacts, runs: Runs) -> None:
    """Set gap and slip of contact `i`, and those that lack its own forces."""
    now, n, here = contacts.now, contacts.rows[i], i * at.IN_STEP
    w = own_compliance(contacts.faces, n, runs)
    normal, tangential = held(now, here + at.NORMAL_NOW, runs), held(now, here + at.TANGENTIAL_NOW, runs)
    gap, slip = component(contacts.faces, n, DISPLACEMENT, runs), component(contacts.faces, n + 1, DISPLACEMENT, runs)
    hold(now, here + at.NEW_GAP, runs, gap)
    hold(now, here + at.NEW_SLIP, runs, slip)
    hold(now, here + at.FREE_GAP, runs, gap - w.nn * normal + w.nt * tangential)
    hold(now, here + at.FREE_SLIP, runs, slip - w.tn * normal + w.tt * tangential)


@inlined
def keep_unsolved(contacts: Contacts, state: Carried, sizes: Sizes, unsolved: Number, runs: Runs) -> None:
    """Carry the forces that did not converge, for the error message."""
    for i in range(sizes.contacts):
        here, base = i * at.IN_STEP, i * at.CARRIED
        for row, found in (
            (at.LAST_NORMAL, at.NORMAL_NOW),
            (at.LAST_TANGENTIAL, at.TANGENTIAL_NOW),
            (at.STATUS, at.STATUS_NOW),
        ):
            value = held(contacts.now, here + found, runs)
            kept = choose(unsolved > 0.5, value, held(state.carried, base + row, runs))
            hold(state.carried, base + row, runs, kept)


@inlined
def free_of_contact(i: int, parts: Parts, forces: Tangents, runs: Runs) -> FreeInSpace:
    """Return the motion of contact `i` in space without its own forces, yielding linearly about its indentation."""
    contacts, now, here = parts.contacts, parts.contacts.now, i * at.IN_STEP
    free = FreeInSpace(
        held(now, here + at.FREE_GAP, runs),
        held_along(now, here + at.FREE_SLIP, here + at.FREE_SLIP_B, runs),
        strayed_in_space(parts.state.carried, i, runs),
        whole_compliance(contacts.faces, contacts.rows[i], runs),
        held(now, here + at.LET_GO, runs),
        forces,
    )
    give, beyond = held(now, here + at.GIVE, runs), held(now, here + at.BEYOND, runs)
    yielding: FreeInSpace = about_indentation(free, give, beyond)
    return yielding


@pasted
def keep_books_in_space(i: int, parts: Parts, n: int, runs: Runs) -> None:
    """Do the bookkeeping of contact `i` in space: along the direction of its friction, then for each tangent."""
    contacts, state, motion = parts.contacts, parts.state, parts.imposed.motion
    now, carried, here, base = contacts.now, state.carried, i * at.IN_STEP, i * at.CARRIED
    normal, status = held(now, here + at.NORMAL_NOW, runs), held(now, here + at.STATUS_NOW, runs)
    forces = held_along(now, here + at.TANGENTIAL_NOW, here + at.TANGENTIAL_NOW_B, runs)
    slips = held_along(now, here + at.NEW_SLIP, here + at.NEW_SLIP_B, runs)
    carried_on = carried_in_space(carried, i, runs)
    way = direction(forces, carried_on.tangential)
    before = past_along(carried_on, way)
    law, gap = contacts.codes[i], held(now, here + at.NEW_GAP, runs)
    store_in(i, gap, contacts, state, runs)
    stuck, lost = runs.zero, runs.zero
    if not set_valued(law) or anywhere(status + before.status > 0.5):
        free = free_of_contact(i, parts, forces, runs)
        touch = Touch(normal, along(forces, way), status, held(now, here + at.JAMMED_NOW, runs), no_way(runs))
        closed = share_states(i, touch, free_along(free, way), gap, before, parts, runs)
        both = status, before.status
        keep_anchor(carried, base + at.MATERIAL, base + at.ANCHOR, law, slips.a, both, runs)
        keep_anchor(carried, base + at.MATERIAL_B, base + at.ANCHOR_B, law, slips.b, both, runs)
        if motion.shape[0] > 1:
            driven = driven_work(i, normal, forces.a, motion, n, runs) + driven_along_b(i, forces.b, motion, n, runs)
            add(state.energies, at.CONTACT_WORK, runs, -driven)
            add(state.energies, at.DRIVE_WORK, runs, driven)
        of_law = law_of(i, contacts, runs)
        past, states, stuck = next_in_space((normal, status), free, of_law, carried_on, parts.timing.step)
        hold(carried, base + at.STUCK_SHARE, runs, stuck)
        hold_along(carried, base + at.PAST_RATIO, base + at.PAST_RATIO_B, runs, past)
        hold_along(carried, base + at.FRICTION_STATE, base + at.FRICTION_STATE_B, runs, states)
        lost = keep_forces(i, touch, Moved(gap, along(slips, way)), carried, contacts, closed, runs)
        add(state.energies, at.FRICTION_LOSS, runs, lost)
        add(contacts.sums, i * at.SUMS + at.TANGENTIALS, runs, forces.a)
        add(contacts.sums, i * at.SUMS + at.TANGENTIALS_B, runs, forces.b)
        hold_along(carried, base + at.LAST_TANGENTIAL, base + at.LAST_TANGENTIAL_B, runs, forces)
    hold(now, here + at.LOST, runs, lost)
    keep_gap(i, gap, carried, runs)
    keep_slip(carried, base + at.MATERIAL, base + at.LAST_SLIP, base + at.EARLIER_SLIP, slips.a, stuck, runs)
    keep_slip(carried, base + at.MATERIAL_B, base + at.LAST_SLIP_B, base + at.EARLIER_SLIP_B, slips.b, stuck, runs)


@pasted
def keep_books_of(i: int, parts: Parts, n: int, runs: Runs) -> None:
    """Do the bookkeeping of contact `i` among several."""
    contacts, carried = parts.contacts, parts.state.carried
    now, here = contacts.now, i * at.IN_STEP
    alone = Free(
        held(now, here + at.FREE_GAP, runs),
        held(now, here + at.FREE_SLIP, runs),
        strayed_in_plane(carried, i, runs),
        own_compliance(contacts.faces, contacts.rows[i], runs),
        held(now, here + at.LET_GO, runs),
    )
    free: Free = about_indentation(alone, held(now, here + at.GIVE, runs), held(now, here + at.BEYOND, runs))
    normal, status = held(now, here + at.NORMAL_NOW, runs), held(now, here + at.STATUS_NOW, runs)
    way = no_way(runs)
    if contacts.codes[i] != at.COULOMB:
        law, before = law_of(i, contacts, runs), carried_by(carried, i, runs)
        way = way_of((normal, status), free, law, before, parts.timing.step)
    tangential, jammed = held(now, here + at.TANGENTIAL_NOW, runs), held(now, here + at.JAMMED_NOW, runs)
    touch = Touch(normal, tangential, status, jammed, way)
    moved = Moved(held(now, here + at.NEW_GAP, runs), held(now, here + at.NEW_SLIP, runs))
    keep_books(i, free, touch, moved, parts, n, runs)


@pasted
def touch_many(space: bool | None, parts: Parts, n: int, ended: Number, runs: Runs) -> Pair:
    """Try step `n` and solve for the forces of all contacts (steps 1 to 5); return where a run leaves, and why."""
    sizes, contacts, state = parts.sizes, parts.contacts, parts.state
    after = n + 2 if parts.imposed.motion.shape[0] > 1 else 0
    leaves = pull_springs(parts, n, runs)
    why = leaves * at.TOO_STIFF
    try_many(space, parts, after, ended, runs)
    if sizes.paths:
        beyond, because = any_beyond_ends(sizes, parts.paths, contacts, state, runs)
        leaves, why = choose(beyond > 0.5, beyond, leaves), choose(beyond > 0.5, because, why)
    error = solve_several(space, parts, runs)
    unsolved = choose(leaves > 0.5, runs.zero, choose(error <= UNBELIEVABLE, runs.zero, 1.0))
    if anywhere(unsolved > 0.5):
        keep_unsolved(contacts, state, sizes, choose(ended > 0.0, runs.zero, unsolved), runs)
        why = choose(unsolved > 0.5, runs.zero + at.CONTACT_UNSOLVED, why)
        leaves = choose(unsolved > 0.5, 1.0, leaves)
    return leaves, why


@pasted
def keep_many(space: bool | None, parts: Parts, n: int, runs: Runs) -> None:
    """Complete step `n` under the forces of all contacts (step 6), and do their bookkeeping."""
    contacts, state, imposed = parts.contacts, parts.state, parts.imposed
    after = n + 2 if imposed.motion.shape[0] > 1 else 0
    work, lost = complete_many(space, parts.modes, parts.paths, contacts, parts.sizes, runs)
    credit(state.energies, work, lost, runs.zero, runs)
    for i in range(parts.sizes.contacts):
        if space is not None and has_b(contacts.rows, i):
            keep_books_in_space(i, parts, n, runs)
            place_b = place_after_along_b(i, parts, after, runs)
            hold(state.carried, i * at.CARRIED + at.ABSCISSA_B, runs, place_b)
        else:
            keep_books_of(i, parts, n, runs)
        if contacts.profiles.shape[1]:
            normal = held(contacts.now, i * at.IN_STEP + at.NORMAL_NOW, runs)
            slip = held(contacts.now, i * at.IN_STEP + at.NEW_SLIP, runs)
            follow_profile(i, normal, slip, contacts, state, runs)
        place, slope = place_after(i, parts, after, runs)
        goes_round = parts.sizes.circles and parts.paths.body_of[i] >= 0
        if space is not None and goes_round:
            work = convected(i, place, parts, runs)
            add(state.energies, at.CONVECTION_WORK, runs, work)
        way = keep_place(i, state.carried, place, runs)
        add(state.energies, at.CONVECTION_WORK, runs, slope * way)
    if parts.sizes.layers:
        heat_contacts(parts, runs)
