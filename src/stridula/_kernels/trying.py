"""Trial and completion of steps of the modes (1 to 4, 6): with one contact in one pass, with several in three."""

import numba
import numpy as np

from . import layout as at
from .block_rows import CONTACTS, POSITION, SINE, Q
from .circles import go_round
from .compliance import set_compliance, set_compliance_of_coupled
from .coupled import complete_coupled, try_coupled
from .lanes import anywhere, choose, fused, held, hold, read, total
from .modes import (
    OPTIONS,
    PASTED,
    add_push,
    clear_push,
    complete_all,
    pass_fixed,
    pass_waves,
    product,
    set_path_rows,
    slope_along,
    try_all,
    two_products,
)
from .waves import set_waves


@numba.njit(**OPTIONS)
def place_of(i, constants, motion, n, tip, run, runs, zero):
    """Return the abscissa of contact `i` for a tip displaced along the tangent, and the motion of its track."""
    column = i * at.MOTIONS * runs + run
    place = held(constants, i * at.CONTACT_CONSTANTS + at.START, run, zero)
    place += read(motion, n, column + at.TIP_MOTION * runs, zero) + tip
    return place, read(motion, n, column + at.TRACK_MOTION * runs, zero)


@numba.njit(**OPTIONS)
def gap_of(i, constants, motion, n, run, runs, zero):
    """Return the gap of contact `i` without displacements of the bodies."""
    lift = read(motion, n, (i * at.MOTIONS + at.GAP_MOTION) * runs + run, zero)
    return held(constants, i * at.CONTACT_CONSTANTS + at.GAP, run, zero) + lift


@numba.njit(**OPTIONS)
def set_waves_at(i, paths, constants, place, sine, run, zero):
    """Set the waves of the path of contact `i` at an abscissa (step 2)."""
    base = i * at.CONTACT_CONSTANTS
    along = fused(held(constants, base + at.ALONG, run, zero), place, held(constants, base + at.ALONG_PHASE, run, zero))
    across = fused(
        held(constants, base + at.ACROSS, run, zero), place, held(constants, base + at.ACROSS_PHASE, run, zero)
    )
    set_waves(paths.waves, paths.sets, i, along, across, sine, run)


@numba.njit(**OPTIONS)
def put_free(i, now, place, gap, slip, run):
    """Save place, gap and slip of contact `i` without its forces (step 3)."""
    here = i * at.IN_STEP
    hold(now, here + at.PLACE, run, place)
    hold(now, here + at.FREE_GAP, run, gap)
    hold(now, here + at.FREE_SLIP, run, slip)


@numba.njit(**OPTIONS)
def try_one(modes, paths, contacts, state, imposed, n, touch, pending, sine, run, runs, zero):
    """Complete a pending step of a single contact (step 6) and try the next (steps 1 to 4), in one pass over the modes.

    Returns
    -------
    free : tuple of float or vector
        Abscissa, gap and slip of the contact without its forces.
    w_nn, w_tt : float or vector
        Compliances of the contact at its new place.
    done : tuple of float or vector
        Work of the contact, loss to damping and force along the path by its slope, in the step completed.
    """
    rows, spans = modes.rows, paths.spans
    normal, tangential = touch[0], touch[1]
    # Step 6 of the last step, step 1 of this one.
    along, across, works, losses = pass_fixed(
        rows, spans[0, at.BEGIN], spans[0, at.END], run, pending, normal, tangential
    )
    place, track = place_of(0, contacts.constants, imposed.motion, n, total(along, zero), run, runs, zero)
    gap = gap_of(0, contacts.constants, imposed.motion, n, run, runs, zero) + total(across, zero)
    slip = place - track - held(state.carried, at.MATERIAL, run, zero)
    w_nn, w_tt = held(contacts.fixed, 0, run, zero), held(contacts.fixed, 2, run, zero)
    slope = zero
    if paths.first_span[1] > 1:
        # Step 2, then 3 and 4.
        last, sine = sine, 2 - sine
        set_waves_at(0, paths, contacts.constants, place, sine, run, zero)
        for s in range(1, paths.first_span[1]):
            upright = spans[s, at.KIND] == at.PATH_NORMAL
            pull = -normal if upright else tangential
            trace, softness, slopes, work, loss = pass_waves(modes, paths, s, run, pending, pull, last, sine, zero)
            works, losses = works + work, losses + loss
            if upright:
                gap -= total(trace, zero)
                w_nn += total(softness, zero)
                slope += normal * total(slopes, zero)
            else:
                slip -= total(trace, zero)
                w_tt += total(softness, zero)
                slope -= tangential * total(slopes, zero)
    return (place, gap, slip), w_nn, w_tt, (0.5 * total(works, zero), 0.25 * total(losses, zero), slope)


@numba.njit(**OPTIONS)
def complete_one(modes, paths, touch, sine, run, zero):
    """Complete a step of a single contact without trying the next (step 6); return `done` as in `try_one`."""
    rows, spans = modes.rows, paths.spans
    normal, tangential = touch[0], touch[1]
    pending = np.bool_(True)
    _, _, works, losses = pass_fixed(rows, spans[0, at.BEGIN], spans[0, at.END], run, pending, normal, tangential)
    slope = zero
    for s in range(1, paths.first_span[1]):
        upright = spans[s, at.KIND] == at.PATH_NORMAL
        pull = -normal if upright else tangential
        _, _, slopes, work, loss = pass_waves(modes, paths, s, run, pending, pull, sine, sine, zero)
        works, losses = works + work, losses + loss
        slope += normal * total(slopes, zero) if upright else -tangential * total(slopes, zero)
    return 0.5 * total(works, zero), 0.25 * total(losses, zero), slope


@numba.njit(**OPTIONS)
def try_many(space, parts, n, ended, run, runs, zero):
    """Try a step of all modes, and set place, gap and slip of each contact without contact forces (steps 1 to 3)."""
    sizes, modes, paths, contacts = parts.sizes, parts.modes, parts.paths, parts.contacts
    turning, state, imposed = parts.turning, parts.state, parts.imposed
    rows, spans, now = modes.rows, paths.spans, contacts.now
    # Step 1.
    places = sizes.coupled * sizes.per_block
    try_coupled(rows, modes.matrices, modes.reach, sizes.coupled, places, run, zero)
    try_all(rows, sizes.coupled, sizes.blocks, run)
    for i in range(sizes.contacts):
        across, along = zero, zero
        for s in range(paths.first_span[i], paths.first_span[i + 1]):
            if spans[s, at.KIND] == at.CONSTANT:
                found = two_products(rows, CONTACTS + 2 * i, POSITION, spans[s, at.BEGIN], spans[s, at.END], run, zero)
                across, along = across + found[0], along + found[1]
        place, track = place_of(i, contacts.constants, imposed.motion, n, along, run, runs, zero)
        gap = gap_of(i, contacts.constants, imposed.motion, n, run, runs, zero) + across
        slip = place - track - held(state.carried, i * at.CARRIED + at.MATERIAL, run, zero)
        if paths.path_of[i] >= 0:
            # Steps 2 and 3.
            set_waves_at(i, paths, contacts.constants, place, SINE, run, zero)
            for s in range(paths.first_span[i], paths.first_span[i + 1]):
                kind, begin, end = spans[s, at.KIND], spans[s, at.BEGIN], spans[s, at.END]
                if kind != at.CONSTANT:
                    upright = kind == at.PATH_NORMAL
                    row = CONTACTS + 2 * i + (0 if upright else 1)
                    set_path_rows(rows, paths, i, s, row, SINE, run, zero)
                    moved = product(rows, row, POSITION, begin, end, run, zero)
                    gap += moved if upright else zero
                    slip += zero if upright else moved
        elif space is not None and sizes.circles and paths.body_of[i] >= 0:
            moved = (place, track)
            rise, slip = go_round(i, moved, modes, paths, contacts, turning, state, imposed, n, run, runs, zero)
            gap += rise
        put_free(i, now, place, choose(ended > 0.0, zero, gap), slip, run)


@numba.njit(**PASTED)
def soften(modes, paths, contacts, sizes, run, zero):
    """Set the compliance of contacts on paths at their new places (step 4)."""
    if sizes.coupled_paths:
        places = sizes.coupled * sizes.per_block
        set_compliance_of_coupled(modes, contacts.faces, sizes.blocks, sizes.coupled, places, sizes.contacts, run, zero)
    elif sizes.paths:
        set_compliance(modes.rows, contacts.faces, paths.spans, paths.first_span, paths, sizes.contacts, run, zero)


@numba.njit(**OPTIONS)
def complete_many(modes, paths, contacts, sizes, run, zero):
    """Complete the step of all modes under the contact forces (step 6); return their work and the loss to damping."""
    rows, spans, now = modes.rows, paths.spans, contacts.now
    clear_push(rows, sizes.blocks, run)
    for i in range(sizes.contacts):
        here = i * at.IN_STEP
        if anywhere(held(now, here + at.STATUS_NOW, run, zero) > 0.5):
            normal, tangential = (
                held(now, here + at.NORMAL_NOW, run, zero),
                held(now, here + at.TANGENTIAL_NOW, run, zero),
            )
            for s in range(paths.first_span[i], paths.first_span[i + 1]):
                add_push(rows, i, spans[s, at.BEGIN], spans[s, at.END], run, normal, tangential)
    places = sizes.coupled * sizes.per_block
    work, lost = complete_coupled(rows, modes.matrices, modes.reach, sizes.coupled, places, run, zero)
    more, taken = complete_all(rows, sizes.coupled, sizes.blocks, run, zero)
    return work + more, lost + taken


@numba.njit(**OPTIONS)
def place_after(i, modes, paths, contacts, state, imposed, n, run, runs, zero):
    """Return the abscissa of contact `i` after the step, and the force along the path due to its slope."""
    rows, spans, here = modes.rows, paths.spans, i * at.IN_STEP
    along, slope = zero, zero
    if paths.path_of[i] < 0 and paths.body_of[i] < 0:
        # The track of such a contact moves only as imposed.
        track = read(imposed.motion, n, (i * at.MOTIONS + at.TRACK_MOTION) * runs + run, zero)
        return held(state.carried, i * at.CARRIED + at.MATERIAL, run, zero) + track, slope
    for s in range(paths.first_span[i], paths.first_span[i + 1]):
        kind, begin, end = spans[s, at.KIND], spans[s, at.BEGIN], spans[s, at.END]
        if kind == at.CONSTANT:
            along += product(rows, CONTACTS + 2 * i + 1, Q, begin, end, run, zero)
            continue
        if kind == at.ROUND:
            continue
        found = slope_along(rows, paths, i, s, SINE, run, zero)
        if kind == at.PATH_NORMAL:
            slope += held(contacts.now, here + at.NORMAL_NOW, run, zero) * found
        else:
            slope -= held(contacts.now, here + at.TANGENTIAL_NOW, run, zero) * found
    place, _ = place_of(i, contacts.constants, imposed.motion, n, along, run, runs, zero)
    return place, slope
