"""Bookkeeping of a contact after a step: shares of its states, anchor, work of its forces, state of its law."""

import numba

from . import layout as at
from .contact import SLIDING, STICKING, closed_share, landed_share, stuck_share
from .friction import set_valued
from .lanes import anywhere, choose, held, hold, magnitude, read
from .modes import OPTIONS
from .pressing import stored_in
from .solves import anchor_after, carried_by, next_on_way, resting, strayed
from .yielding import path_of, yields_of


@numba.njit(**OPTIONS)
def add(array, row, run, value, zero):
    """Add to a row."""
    hold(array, row, run, held(array, row, run, zero) + value)


@numba.njit(**OPTIONS)
def share_states(i, touch, moved, before, carried, sums, w, away, law, at_rest, run, zero):
    """Divide the last step among the states of contact `i` and count this one; return the closed share of this one."""
    base, tally = i * at.CARRIED, i * at.SUMS
    _, _, status, jammed = touch
    free_gap, free_slip, gap, _ = moved
    was, last_normal, last_tangential = before[0], before[4], before[5]
    stuck, touched = magnitude(was - STICKING) < 0.5, was > 0.5 * STICKING
    apart = status < 0.5 * STICKING
    closed = held(carried, base + at.CLOSED_SHARE, run, zero)
    opened = choose(touched, choose(apart, last_normal, zero), zero) > 0.0
    if anywhere(opened):
        # A damped contact ceases to press while it is still indented.
        above = choose(gap > 0.0, gap, zero)
        left = closed - 1.0 + closed_share(choose(opened, last_normal, 1.0), last_tangential, above, w[0], w[1])
        closed = choose(opened, choose(left < 0.0, zero, left), closed)
    stayed = choose(stuck, closed, zero)
    slips = choose(stuck, status, zero) > SLIDING - 0.5
    if law == at.COULOMB and anywhere(slips):
        kept = stuck_share(last_normal, last_tangential, free_gap, free_slip + away, w, at_rest)
        stayed = choose(slips, kept * stayed, stayed)
    elif law != at.COULOMB and set_valued(law):
        stayed = closed * held(carried, base + at.STUCK_SHARE, run, zero)
    add(sums, tally + at.STUCK, run, stayed, zero)
    add(sums, tally + at.SLID, run, closed - stayed, zero)
    if not anywhere(status > 0.5 * STICKING):
        return zero
    landed = choose(touched, zero, choose(apart, zero, 1.0))
    closed = choose(touched, 1.0, landed_share(held(carried, base + at.LAST_GAP, run, zero), free_gap))
    sticks = magnitude(resting(status) - STICKING) < 0.5
    add(sums, tally + at.TOUCHDOWNS, run, landed, zero)
    add(sums, tally + at.JAMS, run, jammed, zero)
    add(sums, tally + at.STUCK_STEPS, run, choose(sticks, 1.0, zero), zero)
    add(sums, tally + at.SLID_STEPS, run, choose(sticks, zero, choose(apart, zero, 1.0)), zero)
    return choose(apart, zero, closed)


@numba.njit(**OPTIONS)
def keep_anchor(i, slip, law, status, was, carried, run, zero):
    """Carry the anchor of a stick of contact `i`; on its way through the step a contact may stop after a slip."""
    base = i * at.CARRIED
    place = held(carried, base + at.MATERIAL, run, zero) + (zero if law == at.COULOMB else slip)
    anchor = held(carried, base + at.ANCHOR, run, zero)
    hold(carried, base + at.ANCHOR, run, anchor_after(anchor, place, status, was))


@numba.njit(**OPTIONS)
def centred(motion, n, column, zero):
    """Return the motion of a step, half the sum over the steps before and after."""
    return 0.5 * (read(motion, n + 2, column, zero) - read(motion, n, column, zero))


@numba.njit(**OPTIONS)
def driven_work(i, touch, motion, n, run, runs, zero):
    """Return the work of the motions imposed on contact `i` through its forces in step `n`."""
    column = i * at.MOTIONS * runs + run
    tip = centred(motion, n, column + at.TIP_MOTION * runs, zero)
    track = centred(motion, n, column + at.TRACK_MOTION * runs, zero)
    lift = centred(motion, n, column + at.GAP_MOTION * runs, zero)
    return touch[1] * (tip - track) - touch[0] * lift


@numba.njit(**OPTIONS)
def next_of(i, touch, moved, w, away, before, contacts, step, run, runs, zero):
    """Return the past part of the ratio of contact `i` for the next step, the state of its law, its share of stick."""
    law, laws, number = contacts.codes[i], contacts.laws, i * runs + run
    if law == at.COULOMB:
        return zero, before[3], zero
    let_go = held(contacts.now, i * at.IN_STEP + at.LET_GO, run, zero)
    return next_on_way((touch[0], touch[2]), moved[0], moved[1], away, w, law, laws, number, before, let_go, step)


@numba.njit(**OPTIONS)
def keep_forces(i, touch, moved, carried, contacts, closed, run, zero):
    """Carry status and normal force of contact `i` to the next step; return the loss to friction."""
    base, law = i * at.CARRIED, contacts.codes[i]
    normal, tangential, status, _ = touch
    slip = moved[3]
    add(contacts.sums, i * at.SUMS + at.NORMALS, run, normal, zero)
    hold(carried, base + at.STATUS, run, resting(status))
    hold(carried, base + at.CLOSED_SHARE, run, closed)
    hold(carried, base + at.LAST_NORMAL, run, normal)
    # In a step in which the slip turns round, its mean force and the slip have opposite signs.
    return magnitude(tangential * slip) if set_valued(law) else tangential * slip


@numba.njit(**OPTIONS)
def keep_tangential(i, tangential, carried, sums, run, zero):
    """Carry and sum the force along the tangent of contact `i`."""
    add(sums, i * at.SUMS + at.TANGENTIALS, run, tangential, zero)
    hold(carried, i * at.CARRIED + at.LAST_TANGENTIAL, run, tangential)


@numba.njit(**OPTIONS)
def keep_motion(i, moved, stuck, before, carried, run, zero):
    """Carry gap and slip of contact `i` to the next step; none where it sticks throughout, as it is rounding."""
    base = i * at.CARRIED
    hold(carried, base + at.EARLIER_SLIP, run, before[1])
    hold(carried, base + at.LAST_SLIP, run, choose(stuck >= 1.0, zero, moved[3]))
    hold(carried, base + at.EARLIEST_GAP, run, held(carried, base + at.EARLIER_GAP, run, zero))
    hold(carried, base + at.EARLIER_GAP, run, held(carried, base + at.LAST_GAP, run, zero))
    hold(carried, base + at.LAST_GAP, run, moved[2])
    add(carried, base + at.MATERIAL, run, moved[3], zero)


@numba.njit(**OPTIONS)
def keep_place(i, carried, place, run, zero):
    """Carry the place of contact `i`; return half its advance in the last two steps."""
    base = i * at.CARRIED
    way = 0.5 * (place - held(carried, base + at.ABSCISSA_BEFORE, run, zero))
    hold(carried, base + at.ABSCISSA_BEFORE, run, held(carried, base + at.ABSCISSA, run, zero))
    hold(carried, base + at.ABSCISSA, run, place)
    return way


@numba.njit(**OPTIONS)
def store_in(i, gap, contacts, state, run, zero):
    """Add the energy that a yielding contact stores in this step to the work of the contacts."""
    yields = yields_of(i, contacts.constants, run, zero)
    if anywhere(yields[0] > 0.0):
        now, before, _ = path_of(i, state.carried, run, zero)
        stored = stored_in(-gap, now, yields) - stored_in(now, before, yields)
        add(state.energies, at.CONTACT_WORK, run, stored, zero)


@numba.njit(**OPTIONS)
def stored_in_contacts(contacts, carried, count, run, zero):
    """Return the energy stored in yielding contacts half a step ago."""
    energy = zero
    for i in range(count):
        yields = yields_of(i, contacts.constants, run, zero)
        if anywhere(yields[0] > 0.0):
            now, before, _ = path_of(i, carried, run, zero)
            energy += stored_in(now, before, yields)
    return energy


@numba.njit(**OPTIONS)
def keep_books(i, w, touch, moved, contacts, state, imposed, timing, n, run, runs, zero):
    """Do the bookkeeping of contact `i` in step `n`, except for its place.

    `touch` are normal and tangential force, status and whether it jams, `moved` gap and slip without these forces, then
    with them.
    """
    law, carried, sums = contacts.codes[i], state.carried, contacts.sums
    before = carried_by(carried, i, run, zero)
    store_in(i, moved[2], contacts, state, run, zero)
    give, beyond = (
        held(contacts.now, i * at.IN_STEP + at.GIVE, run, zero),
        held(contacts.now, i * at.IN_STEP + at.BEYOND, run, zero),
    )
    stuck = zero
    w, moved = (w[0] + give, w[1], w[2], w[3]), (moved[0] + beyond, moved[1], moved[2], moved[3])
    if not set_valued(law) or anywhere(touch[2] + before[0] > 0.5):
        away = strayed(carried, i, run, zero)
        at_rest = held(contacts.constants, i * at.CONTACT_CONSTANTS + at.AT_REST, run, zero)
        closed = share_states(i, touch, moved, before, carried, sums, w, away, law, at_rest, run, zero)
        keep_anchor(i, moved[3], law, touch[2], before[0], carried, run, zero)
        if imposed.motion.shape[0] > 1:
            driven = driven_work(i, touch, imposed.motion, n, run, runs, zero)
            add(state.energies, at.CONTACT_WORK, run, -driven, zero)
            add(state.energies, at.DRIVE_WORK, run, driven, zero)
        past, friction_state, stuck = next_of(i, touch, moved, w, away, before, contacts, timing.step, run, runs, zero)
        hold(carried, i * at.CARRIED + at.STUCK_SHARE, run, stuck)
        hold(carried, i * at.CARRIED + at.PAST_RATIO, run, past)
        hold(carried, i * at.CARRIED + at.FRICTION_STATE, run, friction_state)
        lost = keep_forces(i, touch, moved, carried, contacts, closed, run, zero)
        keep_tangential(i, touch[1], carried, sums, run, zero)
        add(state.energies, at.FRICTION_LOSS, run, lost, zero)
    keep_motion(i, moved, stuck, before, carried, run, zero)


@numba.njit(**OPTIONS)
def credit(energies, work, lost, convected, run, zero):
    """Add the energies of a step of the modes: work of the contacts, loss to damping, convection work."""
    add(energies, at.CONTACT_WORK, run, work, zero)
    add(energies, at.DAMPING_LOSS, run, lost, zero)
    add(energies, at.CONVECTION_WORK, run, convected, zero)
