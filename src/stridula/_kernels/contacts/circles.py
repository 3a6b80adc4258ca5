"""Contacts that move round a body along a circle, a closed path.

After a contact has advanced by an angle, its rows on a pair of order n are its initial rows, turned by n times that
angle. Its slip is relative to the material under it, hence evaluated with the rows at the new place.
"""

import math

from ..lanes.compiled import inlined
from ..lanes.operations import Array, Number, Runs, fused, held, hold, load, read, spread, store, total
from ..layout import columns as at
from ..layout.contact_values import Tangents
from ..layout.parts import Parts
from ..layout.rows import CONTACTS, POSITION, Q
from ..modes.blocks import product, two_products
from ..modes.turning import (
    ADVANCE,
    ADVANCE_B,
    ADVANCED,
    BEGIN,
    EARLIER,
    END,
    OF_CONTACT,
    ORDER,
    PASSED,
    RISE,
    RISEN,
    small_turn,
)
from ..modes.waves import sine_and_cosine_of_half_turns


@inlined
def set_rows_at(
    rows: Array, at_start: Array, turns: Array, begin: int, end: int, n: int, angle: Number, runs: Runs
) -> None:
    """Set the rows of a contact, from that of its normal on, at an angle from its initial place (step 2)."""
    for k in range(begin, end, 2):
        s, c = sine_and_cosine_of_half_turns(load(turns, k, ORDER, runs) * (angle / math.pi))
        for row in (n, n + 1, n + 2):
            first, second = load(at_start, k, row, runs), load(at_start, k + 1, row, runs)
            store(rows, k, CONTACTS + row, runs, fused(c, first, -s * second))
            store(rows, k + 1, CONTACTS + row, runs, fused(s, first, c * second))


@inlined
def product_of(rows: Array, row: int, others: Array, other: int, begin: int, end: int, runs: Runs) -> Number:
    """Return the product of a row with one of another array over a span of blocks."""
    value = spread(0.0)
    for k in range(begin, end):
        value = fused(load(rows, k, row, runs), load(others, k, other, runs), value)
    return total(value, runs.zero)


@inlined
def go_round(i: int, places: Tangents, tracks: Tangents, parts: Parts, n: int, runs: Runs) -> tuple[Number, Tangents]:
    """Advance contact `i` along its circle (steps 2 and 3); return what its body adds to the gap there, and its slips.

    At the end of the step `places` are its abscissas, along the circle and along tangent b; `tracks` is the imposed
    motion of the surface.
    """
    paths, contacts, turning, carried = parts.paths, parts.contacts, parts.turning, parts.state.carried
    rows, turns, body, normal = parts.modes.rows, turning.rows, paths.body_of[i], contacts.rows[i]
    begin, end = turning.spans[body, BEGIN], turning.spans[body, END]
    base = i * at.CONTACT_CONSTANTS
    phase = held(contacts.constants, base + at.ALONG_PHASE, runs)
    angle = fused(held(contacts.constants, base + at.ALONG, runs), places.a, phase)
    set_rows_at(rows, paths.at_start, turns, begin, end, normal, angle, runs)
    row, first = CONTACTS + normal, begin
    for s in range(paths.first_span[i], paths.first_span[i + 1]):
        if paths.spans[s, at.KIND] == at.ROUND:
            first = paths.spans[s, at.BEGIN]
    rise, slip = two_products(rows, row, POSITION, first, end, runs)
    slip = slip_round(rows, turns, row + 1, (first, begin, end), slip, runs)
    slip_b = product(rows, row + 2, POSITION, first, end, runs)
    slip_b = slip_round(rows, turns, row + 2, (first, begin, end), slip_b, runs)
    column, before, own = i * at.MOTIONS * runs.columns + runs.first, n - 1 if n > 0 else 0, i * at.CARRIED
    passed = tracks.a - read(parts.imposed.motion, before, column + at.TRACK_MOTION * runs.columns, runs.zero)
    slip += (places.a - held(carried, own + at.ABSCISSA, runs)) - passed
    passed = tracks.b - read(parts.imposed.motion, before, column + at.TRACK_MOTION_B * runs.columns, runs.zero)
    slip_b += (places.b - held(carried, own + at.ABSCISSA_B, runs)) - passed
    here = i * OF_CONTACT
    hold(turning.contacts, here + RISE, runs, product_of(rows, row, turns, RISEN, begin, end, runs))
    hold(turning.contacts, here + ADVANCE, runs, product_of(rows, row + 1, turns, ADVANCED, begin, end, runs))
    hold(turning.contacts, here + ADVANCE_B, runs, product_of(rows, row + 2, turns, ADVANCED, begin, end, runs))
    return rise, Tangents(slip, slip_b)


@inlined
def slip_round(rows: Array, turns: Array, row: int, blocks: tuple[int, int, int], slip: Number, runs: Runs) -> Number:
    """Return the slip along a tangent by the modes, less the present place of the material that will be under it.

    `blocks` are the first one of the modes without waves round the axis, that of the pairs, and the end.
    """
    first, begin, end = blocks
    slip -= product(rows, row, Q, first, begin, runs)
    return slip - product_of(rows, row, turns, PASSED, begin, end, runs)


@inlined
def convected(i: int, place: Number, parts: Parts, runs: Runs) -> Number:
    """Return the convection work of contact `i`, from the slope of its body along the circle.

    It is the change of its rows over the last two steps, times the displacements two steps ago.
    """
    contacts, turning, carried = parts.contacts, parts.turning, parts.state.carried
    rows, turns, row, body, value = (
        parts.modes.rows,
        turning.rows,
        CONTACTS + contacts.rows[i],
        parts.paths.body_of[i],
        spread(0.0),
    )
    rate = held(contacts.constants, i * at.CONTACT_CONSTANTS + at.ALONG, runs)
    angle = rate * (place - held(carried, i * at.CARRIED + at.ABSCISSA_BEFORE, runs))
    for k in range(turning.spans[body, BEGIN], turning.spans[body, END], 2):
        versine, sine = small_turn(load(turns, k, ORDER, runs) * angle)
        first, second = load(rows, k, row, runs), load(rows, k + 1, row, runs)
        value = fused(fused(versine, first, -sine * second), load(turns, k, EARLIER, runs), value)
        value = fused(fused(versine, second, sine * first), load(turns, k + 1, EARLIER, runs), value)
    return -0.5 * held(contacts.now, i * at.IN_STEP + at.NORMAL_NOW, runs) * total(value, runs.zero)
