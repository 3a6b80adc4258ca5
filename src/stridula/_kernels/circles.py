"""Contacts that move round a body along a circle, a closed path.

After a contact has advanced by an angle, its rows on a pair of order n are its initial rows, turned by n times that
angle. Its slip is relative to the material under it, hence evaluated with the rows at the new place.
"""

import math

import numba

from . import layout as at
from .block_rows import CONTACTS, POSITION, Q
from .lanes import fused, held, hold, load, read, spread, store, total
from .modes import OPTIONS, product, two_products
from .space import is_second
from .turning import (
    ADVANCE,
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
from .waves import sine_and_cosine_of_half_turns


@numba.njit(**OPTIONS)
def set_rows_at(rows, at_start, turns, begin, end, i, angle, run):
    """Set the rows of contact `i` and of its second tangent at an angle from its initial place (step 2)."""
    for k in range(begin, end, 2):
        s, c = sine_and_cosine_of_half_turns(load(turns, k, ORDER, run) * (angle / math.pi))
        for row in (2 * i, 2 * i + 1, 2 * i + 3):
            first, second = load(at_start, k, row, run), load(at_start, k + 1, row, run)
            store(rows, k, CONTACTS + row, run, fused(c, first, -s * second))
            store(rows, k + 1, CONTACTS + row, run, fused(s, first, c * second))


@numba.njit(**OPTIONS)
def product_of(rows, row, others, other, begin, end, run, zero):
    """Return the product of a row with one of another array over a span of blocks."""
    value = spread(0.0)
    for k in range(begin, end):
        value = fused(load(rows, k, row, run), load(others, k, other, run), value)
    return total(value, zero)


@numba.njit(**OPTIONS)
def go_round(i, moved, modes, paths, contacts, turning, state, imposed, n, run, runs, zero):
    """Advance contact `i` along its circle (steps 2 and 3); return what its body adds to the gap there, and its slip.

    `moved` are its abscissa at the end of the step, and the advance of the surface along the circle by turning.
    """
    place, track = moved
    rows, turns, body = modes.rows, turning.rows, paths.body_of[i]
    begin, end = turning.spans[body, BEGIN], turning.spans[body, END]
    if not is_second(contacts.codes, i):
        base = i * at.CONTACT_CONSTANTS
        phase = held(contacts.constants, base + at.ALONG_PHASE, run, zero)
        angle = fused(held(contacts.constants, base + at.ALONG, run, zero), place, phase)
        set_rows_at(rows, paths.at_start, turns, begin, end, i, angle, run)
    row, first = CONTACTS + 2 * i, begin
    for s in range(paths.first_span[i], paths.first_span[i + 1]):
        if paths.spans[s, at.KIND] == at.ROUND:
            first = paths.spans[s, at.BEGIN]
    rise, slip = two_products(rows, row, POSITION, first, end, run, zero)
    # The present place of the material that will be under the contact.
    slip -= product(rows, row + 1, Q, first, begin, run, zero)
    slip -= product_of(rows, row + 1, turns, PASSED, begin, end, run, zero)
    before = read(imposed.motion, n - 1 if n > 0 else 0, (i * at.MOTIONS + at.TRACK_MOTION) * runs + run, zero)
    slip += (place - held(state.carried, i * at.CARRIED + at.ABSCISSA, run, zero)) - (track - before)
    here = i * OF_CONTACT
    hold(turning.contacts, here + RISE, run, product_of(rows, row, turns, RISEN, begin, end, run, zero))
    hold(turning.contacts, here + ADVANCE, run, product_of(rows, row + 1, turns, ADVANCED, begin, end, run, zero))
    return rise, slip


@numba.njit(**OPTIONS)
def convected(i, place, modes, paths, contacts, turning, carried, run, zero):
    """Return the convection work of contact `i`, from the slope of its body along the circle.

    It is the change of its rows over the last two steps, times the displacements two steps ago.
    """
    rows, turns, row, body, value = modes.rows, turning.rows, CONTACTS + 2 * i, paths.body_of[i], spread(0.0)
    rate = held(contacts.constants, i * at.CONTACT_CONSTANTS + at.ALONG, run, zero)
    angle = rate * (place - held(carried, i * at.CARRIED + at.ABSCISSA_BEFORE, run, zero))
    for k in range(turning.spans[body, BEGIN], turning.spans[body, END], 2):
        versine, sine = small_turn(load(turns, k, ORDER, run) * angle)
        first, second = load(rows, k, row, run), load(rows, k + 1, row, run)
        value = fused(fused(versine, first, -sine * second), load(turns, k, EARLIER, run), value)
        value = fused(fused(versine, second, sine * first), load(turns, k + 1, EARLIER, run), value)
    return -0.5 * held(contacts.now, i * at.IN_STEP + at.NORMAL_NOW, run, zero) * total(value, zero)
