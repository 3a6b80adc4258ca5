"""Turning bodies: before each step, pairs of modes are turned, with the material at contacts, loads and probes.

The cosine modes of as many pairs as fit lie in one block, their sine modes in the next. A pair turns by its drag times
the angle of the body in a step, the material by its order times that angle. Angles are small: a turn ``A`` is stored as
``A - 1``, which avoids cancellation.
"""

from ..lanes.compiled import inlined, pasted
from ..lanes.operations import Array, Number, Pair, Runs, add, anywhere, fused, held, hold, load, magnitude, read, store
from ..layout import columns as at
from ..layout.parts import Parts
from ..layout.rows import CONTACTS, INCREMENT, POSITION, PUSH, D, Q, first_probe, has_b
from .blocks import product

# Rows of a block: drag and order; one minus the cosine, and the sine, of the turn of the pairs in this step and in the
# last, and of the turn of the material in both.
DRAG, ORDER, VERSINE, SINE, LAST_VERSINE, LAST_SINE, PASSED_VERSINE, PASSED_SINE, MET_VERSINE, MET_SINE = range(10)
# For contacts that move round the body: half the rise and half the advance for units of the modes, the modes turned
# with the material, and the modes two steps before the end of this one.
RISEN, ADVANCED, PASSED, EARLIER = range(10, 14)
# An odd number of vectors, as for the modes.
TURN_ROWS = 15
# Blocks of a turning body: the first and the end.
BEGIN, END = range(2)
# Effect of turning on a contact in a step, beyond the motion of the modes: half the rise of the gap in the last two
# steps, and half the advance of the slip along each tangent.
RISE, ADVANCE, ADVANCE_B = range(3)
OF_CONTACT = 3


@inlined
def small_turn(angle: Number) -> Pair:
    """Return one minus the cosine, and the sine, of an angle up to half a radian, by their series."""
    z = angle * angle
    s = 1.0 - z / 156.0 * (1.0 - z / 210.0)
    s = 1.0 - z / 20.0 * (1.0 - z / 42.0 * (1.0 - z / 72.0 * (1.0 - z / 110.0 * s)))
    v = 1.0 - z / 90.0 * (1.0 - z / 132.0 * (1.0 - z / 182.0))
    v = 0.5 * z * (1.0 - z / 12.0 * (1.0 - z / 30.0 * (1.0 - z / 56.0 * v)))
    return v, angle * (1.0 - z / 6.0 * s)


@inlined
def set_turns(turns: Array, begin: int, end: int, angle: Number, last: Number, runs: Runs) -> None:
    """Set the turns of a body's pairs and of its material, for the angles of this step and of the last."""
    for k in range(begin, end, 2):
        drag, order = load(turns, k, DRAG, runs), load(turns, k, ORDER, runs)
        for factor, by, row in (
            (drag, angle, VERSINE),
            (drag, last, LAST_VERSINE),
            (order, angle, PASSED_VERSINE),
            (order, last, MET_VERSINE),
        ):
            versine, sine = small_turn(factor * by)
            store(turns, k, row, runs, versine)
            store(turns, k, row + 1, runs, sine)


@inlined
def carry_round(rows: Array, turns: Array, begin: int, end: int, runs: Runs) -> None:
    """Turn the pairs; set half the rise, half the advance, and the passing of the material for units of the modes.

    With turns ``A`` of this step, ``L`` of the last, those of the material ``R`` and ``S``, and ``x = q - d``:
    ``[(A - 1) + (1 - L^-1)] x / 2``, ``[(A - R) q + (1 - S L^-1) x - (A - 1) d] / 2`` and ``(R - 1) q``.
    """
    for k in range(begin, end, 2):
        v, s = load(turns, k, VERSINE, runs), load(turns, k, SINE, runs)
        lv, ls = load(turns, k, LAST_VERSINE, runs), load(turns, k, LAST_SINE, runs)
        rv, rs = load(turns, k, PASSED_VERSINE, runs), load(turns, k, PASSED_SINE, runs)
        mv, ms = load(turns, k, MET_VERSINE, runs), load(turns, k, MET_SINE, runs)
        # S L^-1 turns by the sine and cosine of the difference.
        bv, bs = mv + lv - fused(mv, lv, ms * ls), ms - ls - fused(ms, lv, -mv * ls)
        q, p, d, e = (
            load(rows, k, Q, runs),
            load(rows, k + 1, Q, runs),
            load(rows, k, D, runs),
            load(rows, k + 1, D, runs),
        )
        x, y = q - d, p - e
        along, across = -fused(v, d, s * e), fused(s, d, -v * e)
        store(rows, k, POSITION, runs, 0.5 * fused(lv - v, x, -(s + ls) * y))
        store(rows, k + 1, POSITION, runs, 0.5 * fused(s + ls, x, (lv - v) * y))
        first = fused(rv - v, q, (rs - s) * p) + fused(bv, x, bs * y)
        second = fused(rv - v, p, -(rs - s) * q) + fused(bv, y, -bs * x)
        store(rows, k, INCREMENT, runs, 0.5 * (first - along))
        store(rows, k + 1, INCREMENT, runs, 0.5 * (second - across))
        store(rows, k, PUSH, runs, -fused(rv, q, rs * p))
        store(rows, k + 1, PUSH, runs, fused(rs, q, -rv * p))
        store(rows, k, Q, runs, q - fused(v, q, s * p))
        store(rows, k + 1, Q, runs, p + fused(s, q, -v * p))
        store(rows, k, D, runs, d + along)
        store(rows, k + 1, D, runs, e + across)


@inlined
def keep_position(rows: Array, turns: Array, begin: int, end: int, runs: Runs) -> None:
    """Save the positions of pairs before they are turned."""
    for k in range(begin, end):
        store(turns, k, PASSED, runs, load(rows, k, Q, runs))


@inlined
def keep_carried(rows: Array, turns: Array, begin: int, end: int, runs: Runs) -> None:
    """Save the results of `carry_round` for units of the modes, since the rows of contacts are not yet known."""
    for k in range(begin, end):
        risen = load(rows, k, POSITION, runs)
        store(turns, k, RISEN, runs, risen)
        store(turns, k, EARLIER, runs, (load(rows, k, Q, runs) - load(rows, k, D, runs)) - 2.0 * risen)
        store(turns, k, ADVANCED, runs, load(rows, k, INCREMENT, runs))
        store(turns, k, PASSED, runs, load(turns, k, PASSED, runs) + load(rows, k, PUSH, runs))


@inlined
def look_ahead(rows: Array, turns: Array, begin: int, end: int, runs: Runs) -> None:
    """Set the motions of pairs by turning alone in the last step and in this, and their addition to work of loads.

    ``(1 - L^-1) x``, ``(A - 1) q`` and ``(A - 1) (q - d / 2)``.
    """
    for k in range(begin, end, 2):
        v, s = load(turns, k, VERSINE, runs), load(turns, k, SINE, runs)
        lv, ls = load(turns, k, LAST_VERSINE, runs), load(turns, k, LAST_SINE, runs)
        q, p, d, e = (
            load(rows, k, Q, runs),
            load(rows, k + 1, Q, runs),
            load(rows, k, D, runs),
            load(rows, k + 1, D, runs),
        )
        x, y = q - d, p - e
        store(rows, k, POSITION, runs, fused(lv, x, -ls * y))
        store(rows, k + 1, POSITION, runs, fused(ls, x, lv * y))
        store(rows, k, INCREMENT, runs, -fused(v, q, s * p))
        store(rows, k + 1, INCREMENT, runs, fused(s, q, -v * p))
        half, other = q - 0.5 * d, p - 0.5 * e
        store(rows, k, PUSH, runs, -fused(v, half, s * other))
        store(rows, k + 1, PUSH, runs, fused(s, half, -v * other))


@pasted
def turn_loads_and_probes(parts: Parts, begin: int, end: int, runs: Runs) -> None:
    """Exclude the motion by turning alone from the work of loads, and save its addition to the probes."""
    sizes, rows, probes = parts.sizes, parts.modes.rows, parts.probes
    first = CONTACTS + sizes.rows + sizes.loads
    for j in range(sizes.loads):
        add(parts.modes.given, j, runs, product(rows, first + j, PUSH, begin, end, runs))
    first = first_probe(sizes)
    for p in range(probes.kinds.size):
        if probes.kinds[p] != at.DISPLACEMENT and begin < probes.spans[p, 1] and probes.spans[p, 0] < end:
            hold(probes.passing, 2 * p, runs, product(rows, first + p, POSITION, begin, end, runs))
            hold(probes.passing, 2 * p + 1, runs, product(rows, first + p, INCREMENT, begin, end, runs))


@pasted
def turn_contacts(parts: Parts, begin: int, end: int, first_body: bool, runs: Runs) -> None:
    """Save the effect of turning on contacts fixed in space; their anchors move with the material."""
    rows, of_contacts, first_rows = parts.modes.rows, parts.turning.contacts, parts.contacts.rows
    for i in range(parts.sizes.contacts):
        if parts.sizes.circles and parts.paths.body_of[i] >= 0:
            continue
        row, here = CONTACTS + first_rows[i], i * OF_CONTACT
        rise = product(rows, row, POSITION, begin, end, runs)
        advance = product(rows, row + 1, INCREMENT, begin, end, runs)
        if not first_body:
            rise += held(of_contacts, here + RISE, runs)
            advance += held(of_contacts, here + ADVANCE, runs)
        hold(of_contacts, here + RISE, runs, rise)
        hold(of_contacts, here + ADVANCE, runs, advance)
        passed = product(rows, row + 1, PUSH, begin, end, runs)
        pass_on(parts, i * at.CARRIED, at.MATERIAL, at.ANCHOR, i * at.SUMS + at.FIRST_MATERIAL, passed, runs)
        if has_b(first_rows, i):
            advance = product(rows, row + 2, INCREMENT, begin, end, runs)
            if not first_body:
                advance += held(of_contacts, here + ADVANCE_B, runs)
            hold(of_contacts, here + ADVANCE_B, runs, advance)
            passed = product(rows, row + 2, PUSH, begin, end, runs)
            pass_on(parts, i * at.CARRIED, at.MATERIAL_B, at.ANCHOR_B, i * at.SUMS + at.FIRST_MATERIAL_B, passed, runs)


@inlined
def pass_on(parts: Parts, base: int, material: int, anchor: int, first: int, passed: Number, runs: Runs) -> None:
    """Move the anchor of a contact along a tangent, and the place from which its slip is counted, with the material."""
    add(parts.state.carried, base + material, runs, passed)
    add(parts.state.carried, base + anchor, runs, passed)
    add(parts.contacts.sums, first, runs, passed)


@pasted
def turn_bodies(parts: Parts, n: int, runs: Runs) -> None:
    """Turn the pairs of all turning bodies by their angles in step `n`."""
    turning, angles = parts.turning, parts.imposed.angles
    if turning.spans.shape[0] == 0:
        return
    for b in range(turning.spans.shape[0]):
        begin, end, column = turning.spans[b, BEGIN], turning.spans[b, END], b * runs.columns + runs.first
        now = n + 1 if angles.shape[0] > 1 else 0
        angle, last = (
            read(angles, now, column, runs.zero),
            read(angles, n if angles.shape[0] > 1 else 0, column, runs.zero),
        )
        changed = magnitude(angle - held(turning.turned, 2 * b, runs))
        changed += magnitude(last - held(turning.turned, 2 * b + 1, runs))
        if anywhere(changed > 0.0):
            set_turns(turning.rows, begin, end, angle, last, runs)
            hold(turning.turned, 2 * b, runs, angle)
            hold(turning.turned, 2 * b + 1, runs, last)
        if parts.sizes.loads or parts.probes.kinds.size:
            look_ahead(parts.modes.rows, turning.rows, begin, end, runs)
            turn_loads_and_probes(parts, begin, end, runs)
        if parts.sizes.circles:
            keep_position(parts.modes.rows, turning.rows, begin, end, runs)
        carry_round(parts.modes.rows, turning.rows, begin, end, runs)
        if parts.sizes.circles:
            keep_carried(parts.modes.rows, turning.rows, begin, end, runs)
        turn_contacts(parts, begin, end, b == 0, runs)


@pasted
def credit_turning(parts: Parts, runs: Runs) -> None:
    """Credit the work of turning through the contact forces of this step."""
    now, of_contacts, energies = parts.contacts.now, parts.turning.contacts, parts.state.energies
    if parts.turning.spans.shape[0] == 0:
        return
    for i in range(parts.sizes.contacts):
        normal = held(now, i * at.IN_STEP + at.NORMAL_NOW, runs)
        tangential = held(now, i * at.IN_STEP + at.TANGENTIAL_NOW, runs)
        driven = tangential * held(of_contacts, i * OF_CONTACT + ADVANCE, runs)
        driven -= normal * held(of_contacts, i * OF_CONTACT + RISE, runs)
        add(energies, at.CONTACT_WORK, runs, -driven)
        add(energies, at.DRIVE_WORK, runs, driven)
        if has_b(parts.contacts.rows, i):
            tangential = held(now, i * at.IN_STEP + at.TANGENTIAL_NOW_B, runs)
            driven = tangential * held(of_contacts, i * OF_CONTACT + ADVANCE_B, runs)
            add(energies, at.CONTACT_WORK, runs, -driven)
            add(energies, at.DRIVE_WORK, runs, driven)
