"""Runs that end before the others."""

import numba

from . import layout as at
from .bookkeeping import stored_in_contacts
from .coupled import energy_of
from .lanes import anywhere, choose, held, hold, magnitude, write
from .modes import OPTIONS, PASTED

# Result of a run: samples completed, reason of its end.
COMPLETED, ENDED = range(2)


@numba.njit(**OPTIONS)
def leave(ended, completed, leaves, why, sample, state, run, zero):
    """Return reasons of the end and numbers of samples of runs, where some leave now; save their contacts."""
    newly = choose(ended > 0.0, zero, leaves) > 0.5
    for row in range(state.carried.shape[0]):
        kept = choose(newly, held(state.carried, row, run, zero), held(state.at_end, row, run, zero))
        hold(state.at_end, row, run, kept)
    return choose(newly, why, ended), choose(newly, zero + sample, completed)


@numba.njit(**OPTIONS)
def beyond_ends(i, place, contacts, state, run, zero):
    """Return where contact `i` is beyond the ends of its path, and why: by its motion, or because it diverges."""
    base = i * at.CONTACT_CONSTANTS
    low, high = held(contacts.constants, base + at.LOW, run, zero), held(contacts.constants, base + at.HIGH, run, zero)
    leaves = choose(choose(place > low, high - place, zero) > 0.0, zero, 1.0)
    if not anywhere(leaves > 0.5):
        return leaves, leaves
    # A tip that crosses the whole track in one step diverges.
    within = magnitude(place - held(state.carried, i * at.CARRIED + at.ABSCISSA, run, zero)) < high - low
    return leaves, choose(within, zero + at.OFF_TRACK, zero + at.NOT_FINITE)


@numba.njit(**OPTIONS)
def any_beyond_ends(sizes, paths, contacts, state, run, zero):
    """Return where any contact is beyond the ends of its path, and why."""
    leaves, why = zero, zero
    for i in range(sizes.contacts):
        if paths.path_of[i] >= 0:
            place = held(contacts.now, i * at.IN_STEP + at.PLACE, run, zero)
            here, because = beyond_ends(i, place, contacts, state, run, zero)
            leaves, why = choose(here > 0.5, here, leaves), choose(here > 0.5, because, why)
    return leaves, why


@numba.njit(**PASTED)
def end(parts, ended, completed, run, zero):
    """Record the results of the runs; restore the contacts of ended runs to those at their end."""
    carried, stops = parts.state.carried, parts.records.stops
    write(stops, COMPLETED, run, choose(ended > 0.0, completed, zero + parts.records.energies.shape[0]))
    write(stops, ENDED, run, ended)
    for row in range(carried.shape[0]):
        kept = choose(ended > 0.0, held(parts.state.at_end, row, run, zero), held(carried, row, run, zero))
        hold(carried, row, run, kept)
    stored = energy_of(parts.modes, parts.sizes, run, zero)
    stored += stored_in_contacts(parts.contacts, carried, parts.sizes.contacts, run, zero)
    hold(parts.state.energies, at.STORED, run, stored)
