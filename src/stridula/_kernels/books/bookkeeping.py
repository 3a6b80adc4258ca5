"""Bookkeeping of a contact after a step: shares of its states, anchor, work of its forces, state of its law."""

from ..contact.exact import SLIDING, STICKING, closed_share, landed_share, stuck_share
from ..contact.friction import set_valued
from ..contact.pressing import stored_in
from ..contact.solves import anchor_after, carried_by, law_of, resting
from ..contact.yielding import path_of, yields_of
from ..lanes.compiled import inlined
from ..lanes.operations import Array, Number, Pair, Runs, add, anywhere, choose, held, hold, magnitude, read
from ..layout import columns as at
from ..layout.contact_values import Before, Free, Moved, Touch
from ..layout.parts import Carried, Contacts, Parts


@inlined
def share_states(i: int, touch: Touch, free: Free, gap: Number, before: Before, parts: Parts, runs: Runs) -> Number:
    """Divide the last step among the states of contact `i` and count this one; return the closed share of this one."""
    base, tally, sums, carried = i * at.CARRIED, i * at.SUMS, parts.contacts.sums, parts.state.carried
    law, w = parts.contacts.codes[i], free.w
    stuck, touched = magnitude(before.status - STICKING) < 0.5, before.status > 0.5 * STICKING
    apart = touch.status < 0.5 * STICKING
    closed = held(carried, base + at.CLOSED_SHARE, runs)
    opened = choose(touched, choose(apart, before.normal, runs.zero), runs.zero) > 0.0
    if anywhere(opened):
        # A damped contact ceases to press while it is still indented.
        above = choose(gap > 0.0, gap, runs.zero)
        left = closed - 1.0 + closed_share(choose(opened, before.normal, 1.0), before.tangential, above, w)
        closed = choose(opened, choose(left < 0.0, runs.zero, left), closed)
    stayed = choose(stuck, closed, runs.zero)
    slips = choose(stuck, touch.status, runs.zero) > SLIDING - 0.5
    if law == at.COULOMB and anywhere(slips):
        kept = stuck_share(before.normal, before.tangential, free, law_of(i, parts.contacts, runs).at_rest)
        stayed = choose(slips, kept * stayed, stayed)
    elif law != at.COULOMB and set_valued(law):
        stayed = closed * held(carried, base + at.STUCK_SHARE, runs)
    add(sums, tally + at.STUCK, runs, stayed)
    add(sums, tally + at.SLID, runs, closed - stayed)
    if not anywhere(touch.status > 0.5 * STICKING):
        return runs.zero
    landed = choose(touched, runs.zero, choose(apart, runs.zero, 1.0))
    closed = choose(touched, 1.0, landed_share(held(carried, base + at.LAST_GAP, runs), free.gap))
    sticks = magnitude(resting(touch.status) - STICKING) < 0.5
    add(sums, tally + at.TOUCHDOWNS, runs, landed)
    add(sums, tally + at.JAMS, runs, touch.jammed)
    add(sums, tally + at.STUCK_STEPS, runs, choose(sticks, 1.0, runs.zero))
    add(sums, tally + at.SLID_STEPS, runs, choose(sticks, runs.zero, choose(apart, runs.zero, 1.0)))
    return choose(apart, runs.zero, closed)


@inlined
def keep_anchor(carried: Array, material: int, anchor: int, law: int, slip: Number, status: Pair, runs: Runs) -> None:
    """Carry the anchor of a stick along the tangent of two rows; on its way through the step it may stop after a slip.

    `status` are those of this step and of the last.
    """
    now, was = status
    place = held(carried, material, runs) + (runs.zero if law == at.COULOMB else slip)
    hold(carried, anchor, runs, anchor_after(held(carried, anchor, runs), place, now, was))


@inlined
def centred(motion: Array, n: int, column: int, zero: Number) -> Number:
    """Return the motion of a step, half the sum over the steps before and after."""
    return 0.5 * (read(motion, n + 2, column, zero) - read(motion, n, column, zero))


@inlined
def driven_along_b(i: int, tangential: Number, motion: Array, n: int, runs: Runs) -> Number:
    """Return the work of the motions imposed on contact `i` along tangent b through its force in step `n`."""
    column = i * at.MOTIONS * runs.columns + runs.first
    tip = centred(motion, n, column + at.TIP_MOTION_B * runs.columns, runs.zero)
    return tangential * (tip - centred(motion, n, column + at.TRACK_MOTION_B * runs.columns, runs.zero))


@inlined
def driven_work(i: int, normal: Number, tangential: Number, motion: Array, n: int, runs: Runs) -> Number:
    """Return the work of the motions imposed on contact `i` through its forces in step `n`."""
    column = i * at.MOTIONS * runs.columns + runs.first
    tip = centred(motion, n, column + at.TIP_MOTION * runs.columns, runs.zero)
    track = centred(motion, n, column + at.TRACK_MOTION * runs.columns, runs.zero)
    lift = centred(motion, n, column + at.GAP_MOTION * runs.columns, runs.zero)
    return tangential * (tip - track) - normal * lift


@inlined
def keep_forces(
    i: int,
    touch: Touch,
    moved: Moved,
    carried: Array,
    contacts: Contacts,
    closed: Number,
    runs: Runs,
) -> Number:
    """Carry status and normal force of contact `i` to the next step; return the loss to friction."""
    base, law = i * at.CARRIED, contacts.codes[i]
    normal, tangential, status, slip = touch.normal, touch.tangential, touch.status, moved.slip
    add(contacts.sums, i * at.SUMS + at.NORMALS, runs, normal)
    hold(carried, base + at.STATUS, runs, resting(status))
    hold(carried, base + at.CLOSED_SHARE, runs, closed)
    hold(carried, base + at.LAST_NORMAL, runs, normal)
    # In a step in which the slip turns round, its mean force and the slip have opposite signs.
    return magnitude(tangential * slip) if set_valued(law) else tangential * slip


@inlined
def keep_tangential(i: int, tangential: Number, carried: Array, sums: Array, runs: Runs) -> None:
    """Carry and sum the force along the tangent of contact `i`."""
    add(sums, i * at.SUMS + at.TANGENTIALS, runs, tangential)
    hold(carried, i * at.CARRIED + at.LAST_TANGENTIAL, runs, tangential)


@inlined
def keep_gap(i: int, gap: Number, carried: Array, runs: Runs) -> None:
    """Carry the gap of contact `i` to the next step."""
    base = i * at.CARRIED
    hold(carried, base + at.EARLIEST_GAP, runs, held(carried, base + at.EARLIER_GAP, runs))
    hold(carried, base + at.EARLIER_GAP, runs, held(carried, base + at.LAST_GAP, runs))
    hold(carried, base + at.LAST_GAP, runs, gap)


@inlined
def keep_slip(carried: Array, material: int, last: int, earlier: int, slip: Number, stuck: Number, runs: Runs) -> None:
    """Carry the slip along the tangent of three rows; none where it sticks throughout, as it is rounding."""
    hold(carried, earlier, runs, held(carried, last, runs))
    hold(carried, last, runs, choose(stuck >= 1.0, runs.zero, slip))
    add(carried, material, runs, slip)


@inlined
def keep_place(i: int, carried: Array, place: Number, runs: Runs) -> Number:
    """Carry the place of contact `i`; return half its advance in the last two steps."""
    base = i * at.CARRIED
    way = 0.5 * (place - held(carried, base + at.ABSCISSA_BEFORE, runs))
    hold(carried, base + at.ABSCISSA_BEFORE, runs, held(carried, base + at.ABSCISSA, runs))
    hold(carried, base + at.ABSCISSA, runs, place)
    return way


@inlined
def store_in(i: int, gap: Number, contacts: Contacts, state: Carried, runs: Runs) -> None:
    """Add the energy that a yielding contact stores in this step to the work of the contacts."""
    yields = yields_of(i, contacts.constants, runs)
    if anywhere(yields.stiffness > 0.0):
        now, before, _ = path_of(i, state.carried, runs)
        stored = stored_in(-gap, now, yields) - stored_in(now, before, yields)
        add(state.energies, at.CONTACT_WORK, runs, stored)


@inlined
def stored_in_contacts(contacts: Contacts, carried: Array, count: int, runs: Runs) -> Number:
    """Return the energy stored in yielding contacts half a step ago."""
    energy = runs.zero
    for i in range(count):
        yields = yields_of(i, contacts.constants, runs)
        if anywhere(yields.stiffness > 0.0):
            now, before, _ = path_of(i, carried, runs)
            energy += stored_in(now, before, yields)
    return energy


@inlined
def keep_books(i: int, free: Free, touch: Touch, moved: Moved, parts: Parts, n: int, runs: Runs) -> None:
    """Do the bookkeeping of contact `i` in step `n`, except for its place; `free` tells how it yields."""
    contacts, state, base = parts.contacts, parts.state, i * at.CARRIED
    law, carried = contacts.codes[i], state.carried
    before, stuck, lost = carried_by(carried, i, runs), runs.zero, runs.zero
    store_in(i, moved.gap, contacts, state, runs)
    if not set_valued(law) or anywhere(touch.status + before.status > 0.5):
        closed = share_states(i, touch, free, moved.gap, before, parts, runs)
        status = touch.status, before.status
        keep_anchor(carried, base + at.MATERIAL, base + at.ANCHOR, law, moved.slip, status, runs)
        if parts.imposed.motion.shape[0] > 1:
            driven = driven_work(i, touch.normal, touch.tangential, parts.imposed.motion, n, runs)
            add(state.energies, at.CONTACT_WORK, runs, -driven)
            add(state.energies, at.DRIVE_WORK, runs, driven)
        if law != at.COULOMB:
            past, friction_state, stuck = touch.way
            hold(carried, base + at.STUCK_SHARE, runs, stuck)
            hold(carried, base + at.PAST_RATIO, runs, past)
            hold(carried, base + at.FRICTION_STATE, runs, friction_state)
        lost = keep_forces(i, touch, moved, carried, contacts, closed, runs)
        keep_tangential(i, touch.tangential, carried, contacts.sums, runs)
        add(state.energies, at.FRICTION_LOSS, runs, lost)
    hold(contacts.now, i * at.IN_STEP + at.LOST, runs, lost)
    keep_gap(i, moved.gap, carried, runs)
    keep_slip(carried, base + at.MATERIAL, base + at.LAST_SLIP, base + at.EARLIER_SLIP, moved.slip, stuck, runs)


@inlined
def credit(energies: Array, work: Number, lost: Number, convected: Number, runs: Runs) -> None:
    """Add the energies of a step of the modes: work of the contacts, loss to damping, convection work."""
    add(energies, at.CONTACT_WORK, runs, work)
    add(energies, at.DAMPING_LOSS, runs, lost)
    add(energies, at.CONVECTION_WORK, runs, convected)
