"""Trial and completion of steps of the modes (1 to 4, 6): with one contact in one pass, with several in three."""

from .contacts.circles import go_round
from .contacts.compliance import set_compliance, set_compliance_of_coupled
from .contacts.profiles import set_height
from .lanes.compiled import inlined, pasted
from .lanes.operations import TRUTH, Array, Number, Pair, Runs, anywhere, choose, fused, held, hold, read, total
from .layout import columns as at
from .layout.contact_values import Compliance, Done, Tangents, Touch, Tried
from .layout.parts import Contacts, Modes, Parts, Paths, Sizes
from .layout.rows import CONTACTS, POSITION, SINE, Q, has_b
from .modes.blocks import (
    add_push,
    add_push_along,
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
from .modes.coupled import complete_coupled, try_coupled
from .modes.waves import set_waves


@inlined
def place_of(i: int, constants: Array, motion: Array, n: int, tip: Number, runs: Runs) -> Pair:
    """Return the abscissa of contact `i` for a tip displaced along the tangent, and the motion of its track."""
    column = i * at.MOTIONS * runs.columns + runs.first
    place = held(constants, i * at.CONTACT_CONSTANTS + at.START, runs)
    place += read(motion, n, column + at.TIP_MOTION * runs.columns, runs.zero) + tip
    return place, read(motion, n, column + at.TRACK_MOTION * runs.columns, runs.zero)


@inlined
def place_along_b(i: int, motion: Array, n: int, tip: Number, runs: Runs) -> Pair:
    """Do `place_of` for tangent b, whose abscissas begin at zero."""
    column = i * at.MOTIONS * runs.columns + runs.first
    place = read(motion, n, column + at.TIP_MOTION_B * runs.columns, runs.zero) + tip
    return place, read(motion, n, column + at.TRACK_MOTION_B * runs.columns, runs.zero)


@inlined
def gap_of(i: int, constants: Array, motion: Array, n: int, runs: Runs) -> Number:
    """Return the gap of contact `i` without displacements of the bodies."""
    lift = read(motion, n, (i * at.MOTIONS + at.GAP_MOTION) * runs.columns + runs.first, runs.zero)
    return held(constants, i * at.CONTACT_CONSTANTS + at.GAP, runs) + lift


@inlined
def set_waves_at(i: int, paths: Paths, constants: Array, place: Number, sine: int, runs: Runs) -> None:
    """Set the waves of the path of contact `i` at an abscissa (step 2)."""
    base = i * at.CONTACT_CONSTANTS
    along = fused(held(constants, base + at.ALONG, runs), place, held(constants, base + at.ALONG_PHASE, runs))
    across = fused(held(constants, base + at.ACROSS, runs), place, held(constants, base + at.ACROSS_PHASE, runs))
    set_waves(paths.waves, paths.sets, i, along, across, sine, runs)


@inlined
def put_free(i: int, now: Array, place: Number, gap: Number, slip: Number, runs: Runs) -> None:
    """Save place, gap and slip of contact `i` without its forces (step 3)."""
    here = i * at.IN_STEP
    hold(now, here + at.PLACE, runs, place)
    hold(now, here + at.FREE_GAP, runs, gap)
    hold(now, here + at.FREE_SLIP, runs, slip)


@inlined
def try_one(parts: Parts, n: int, touch: Touch, pending: bool, sine: int, runs: Runs) -> tuple[Tried, Done]:
    """Complete a pending step of a single contact (step 6) and try the next (steps 1 to 4), in one pass over the modes.

    Returns the contact without its forces, and the energies of the step completed.
    """
    modes, paths, contacts, motion = parts.modes, parts.paths, parts.contacts, parts.imposed.motion
    rows, spans = modes.rows, paths.spans
    normal, tangential = touch.normal, touch.tangential
    # Step 6 of the last step, step 1 of this one.
    along, across, works, losses = pass_fixed(
        rows, spans[0, at.BEGIN], spans[0, at.END], runs, pending, normal, tangential
    )
    place, track = place_of(0, contacts.constants, motion, n, total(along, runs.zero), runs)
    gap = gap_of(0, contacts.constants, motion, n, runs) + total(across, runs.zero)
    slip = place - track - held(parts.state.carried, at.MATERIAL, runs)
    w_nn, w_tt = held(contacts.fixed, 0, runs), held(contacts.fixed, 2, runs)
    slope = runs.zero
    if paths.first_span[1] > 1:
        # Step 2, then 3 and 4.
        last, sine = sine, 2 - sine
        set_waves_at(0, paths, contacts.constants, place, sine, runs)
        for s in range(1, paths.first_span[1]):
            upright = spans[s, at.KIND] == at.PATH_NORMAL
            pull = -normal if upright else tangential
            trace, softness, slopes, work, loss = pass_waves(modes, paths, s, runs, pending, pull, last, sine)
            works, losses = works + work, losses + loss
            if upright:
                gap -= total(trace, runs.zero)
                w_nn += total(softness, runs.zero)
                slope += normal * total(slopes, runs.zero)
            else:
                slip -= total(trace, runs.zero)
                w_tt += total(softness, runs.zero)
                slope -= tangential * total(slopes, runs.zero)
    if contacts.profiles.shape[1]:
        gap -= set_height(0, slip, contacts, parts.state.carried, runs)
    w_nt = held(contacts.fixed, 1, runs)
    tried = Tried(place, gap, slip, Compliance(w_nn, w_nt, w_nt, w_tt))
    return tried, Done(0.5 * total(works, runs.zero), 0.25 * total(losses, runs.zero), slope)


@inlined
def complete_one(modes: Modes, paths: Paths, touch: Touch, sine: int, runs: Runs) -> Done:
    """Complete a step of a single contact without trying the next (step 6)."""
    rows, spans = modes.rows, paths.spans
    normal, tangential = touch.normal, touch.tangential
    pending = TRUTH(True)
    _, _, works, losses = pass_fixed(rows, spans[0, at.BEGIN], spans[0, at.END], runs, pending, normal, tangential)
    slope = runs.zero
    for s in range(1, paths.first_span[1]):
        upright = spans[s, at.KIND] == at.PATH_NORMAL
        pull = -normal if upright else tangential
        _, _, slopes, work, loss = pass_waves(modes, paths, s, runs, pending, pull, sine, sine)
        works, losses = works + work, losses + loss
        slope += normal * total(slopes, runs.zero) if upright else -tangential * total(slopes, runs.zero)
    return Done(0.5 * total(works, runs.zero), 0.25 * total(losses, runs.zero), slope)


@inlined
def try_many(space: bool | None, parts: Parts, n: int, ended: Number, runs: Runs) -> None:
    """Try a step of all modes, and set place, gap and slip of each contact without contact forces (steps 1 to 3)."""
    sizes, modes, paths, contacts = parts.sizes, parts.modes, parts.paths, parts.contacts
    state, imposed = parts.state, parts.imposed
    rows, spans, now = modes.rows, paths.spans, contacts.now
    # Step 1.
    places = sizes.coupled * sizes.per_block
    try_coupled(rows, modes.matrices, modes.reach, sizes.coupled, places, runs)
    try_all(rows, sizes.coupled, sizes.blocks, runs)
    for i in range(sizes.contacts):
        across, along, row = runs.zero, runs.zero, CONTACTS + contacts.rows[i]
        for s in range(paths.first_span[i], paths.first_span[i + 1]):
            if spans[s, at.KIND] == at.CONSTANT:
                rise, way = two_products(rows, row, POSITION, spans[s, at.BEGIN], spans[s, at.END], runs)
                across, along = across + rise, along + way
        place, track = place_of(i, contacts.constants, imposed.motion, n, along, runs)
        gap = gap_of(i, contacts.constants, imposed.motion, n, runs) + across
        slip = place - track - held(state.carried, i * at.CARRIED + at.MATERIAL, runs)
        place_b, track_b = runs.zero, runs.zero
        if space is not None and has_b(contacts.rows, i):
            along = along_constant(rows, paths, i, row + 2, POSITION, runs)
            place_b, track_b = place_along_b(i, imposed.motion, n, along, runs)
            slip_b = place_b - track_b - held(state.carried, i * at.CARRIED + at.MATERIAL_B, runs)
            hold(now, i * at.IN_STEP + at.FREE_SLIP_B, runs, slip_b)
        if paths.path_of[i] >= 0:
            # Steps 2 and 3.
            set_waves_at(i, paths, contacts.constants, place, SINE, runs)
            for s in range(paths.first_span[i], paths.first_span[i + 1]):
                kind, begin, end = spans[s, at.KIND], spans[s, at.BEGIN], spans[s, at.END]
                if kind != at.CONSTANT:
                    upright = kind == at.PATH_NORMAL
                    on_path = row if upright else row + 1
                    set_path_rows(rows, paths, i, s, on_path, SINE, runs)
                    moved = product(rows, on_path, POSITION, begin, end, runs)
                    gap += moved if upright else runs.zero
                    slip += runs.zero if upright else moved
        elif space is not None and sizes.circles and paths.body_of[i] >= 0:
            rise, slips = go_round(i, Tangents(place, place_b), Tangents(track, track_b), parts, n, runs)
            gap += rise
            slip = slips.a
            hold(now, i * at.IN_STEP + at.FREE_SLIP_B, runs, slips.b)
        if contacts.profiles.shape[1]:
            gap -= set_height(i, slip, contacts, state.carried, runs)
        put_free(i, now, place, choose(ended > 0.0, runs.zero, gap), slip, runs)


@inlined
def along_constant(rows: Array, paths: Paths, i: int, row: int, other: int, runs: Runs) -> Number:
    """Return the product of two rows over the constant spans of contact `i`."""
    along, spans = runs.zero, paths.spans
    for s in range(paths.first_span[i], paths.first_span[i + 1]):
        if spans[s, at.KIND] == at.CONSTANT:
            along += product(rows, row, other, spans[s, at.BEGIN], spans[s, at.END], runs)
    return along


@pasted
def soften(space: bool | None, modes: Modes, paths: Paths, contacts: Contacts, sizes: Sizes, runs: Runs) -> None:
    """Set the compliance of contacts on paths at their new places (step 4)."""
    if sizes.coupled_paths:
        set_compliance_of_coupled(modes, contacts.faces, sizes, runs)
    elif sizes.paths:
        set_compliance(space, modes, paths, contacts, sizes, runs)


@inlined
def complete_many(space: bool | None, modes: Modes, paths: Paths, contacts: Contacts, sizes: Sizes, runs: Runs) -> Pair:
    """Complete the step of all modes under the contact forces (step 6); return their work and the loss to damping."""
    rows, spans, now = modes.rows, paths.spans, contacts.now
    clear_push(rows, sizes.blocks, runs)
    for i in range(sizes.contacts):
        here = i * at.IN_STEP
        if anywhere(held(now, here + at.STATUS_NOW, runs) > 0.5):
            normal, tangential = (
                held(now, here + at.NORMAL_NOW, runs),
                held(now, here + at.TANGENTIAL_NOW, runs),
            )
            row = CONTACTS + contacts.rows[i]
            for s in range(paths.first_span[i], paths.first_span[i + 1]):
                add_push(rows, row, spans[s, at.BEGIN], spans[s, at.END], runs, normal, tangential)
            if space is not None and has_b(contacts.rows, i):
                tangential = held(now, here + at.TANGENTIAL_NOW_B, runs)
                for s in range(paths.first_span[i], paths.first_span[i + 1]):
                    add_push_along(rows, row + 2, spans[s, at.BEGIN], spans[s, at.END], runs, tangential)
    places = sizes.coupled * sizes.per_block
    work, lost = complete_coupled(rows, modes.matrices, modes.reach, sizes.coupled, places, runs)
    more, taken = complete_all(rows, sizes.coupled, sizes.blocks, runs)
    return work + more, lost + taken


@inlined
def place_after(i: int, parts: Parts, n: int, runs: Runs) -> Pair:
    """Return the abscissa of contact `i` after the step, and the force along the path due to its slope."""
    paths, contacts, motion = parts.paths, parts.contacts, parts.imposed.motion
    rows, spans, here = parts.modes.rows, paths.spans, i * at.IN_STEP
    along, slope = runs.zero, runs.zero
    if paths.path_of[i] < 0 and paths.body_of[i] < 0:
        # The track of such a contact moves only as imposed.
        track = read(motion, n, (i * at.MOTIONS + at.TRACK_MOTION) * runs.columns + runs.first, runs.zero)
        return held(parts.state.carried, i * at.CARRIED + at.MATERIAL, runs) + track, slope
    for s in range(paths.first_span[i], paths.first_span[i + 1]):
        kind, begin, end = spans[s, at.KIND], spans[s, at.BEGIN], spans[s, at.END]
        if kind == at.CONSTANT:
            along += product(rows, CONTACTS + contacts.rows[i] + 1, Q, begin, end, runs)
            continue
        if kind == at.ROUND:
            continue
        found = slope_along(rows, paths, i, s, SINE, runs)
        if kind == at.PATH_NORMAL:
            slope += held(contacts.now, here + at.NORMAL_NOW, runs) * found
        else:
            slope -= held(contacts.now, here + at.TANGENTIAL_NOW, runs) * found
    place, _ = place_of(i, contacts.constants, motion, n, along, runs)
    return place, slope


@inlined
def place_after_along_b(i: int, parts: Parts, n: int, runs: Runs) -> Number:
    """Return the abscissa of contact `i` along tangent b after the step; no path moves along it."""
    if parts.paths.body_of[i] < 0:
        column = (i * at.MOTIONS + at.TRACK_MOTION_B) * runs.columns + runs.first
        track = read(parts.imposed.motion, n, column, runs.zero)
        return held(parts.state.carried, i * at.CARRIED + at.MATERIAL_B, runs) + track
    along = along_constant(parts.modes.rows, parts.paths, i, CONTACTS + parts.contacts.rows[i] + 2, Q, runs)
    place, _ = place_along_b(i, parts.imposed.motion, n, along, runs)
    return place
