"""Runs that end before the others."""

from ..lanes.compiled import inlined, pasted
from ..lanes.operations import Number, Pair, Runs, anywhere, choose, held, hold, magnitude, write
from ..layout import columns as at
from ..layout.parts import Carried, Contacts, Parts, Paths, Sizes
from ..modes.coupled import energy_of
from .bookkeeping import stored_in_contacts

# Result of a run: samples completed, reason of its end.
COMPLETED, ENDED = range(2)


@inlined
def leave(
    ended: Number, completed: Number, leaves: Number, why: Number, sample: int, state: Carried, runs: Runs
) -> Pair:
    """Return reasons of the end and numbers of samples of runs, where some leave now; save their contacts."""
    newly = choose(ended > 0.0, runs.zero, leaves) > 0.5
    for row in range(state.carried.shape[0]):
        kept = choose(newly, held(state.carried, row, runs), held(state.at_end, row, runs))
        hold(state.at_end, row, runs, kept)
    return choose(newly, why, ended), choose(newly, runs.zero + sample, completed)


@inlined
def beyond_ends(i: int, place: Number, contacts: Contacts, state: Carried, runs: Runs) -> Pair:
    """Return where contact `i` is beyond the ends of its path, and why: by its motion, or because it diverges."""
    base = i * at.CONTACT_CONSTANTS
    low, high = held(contacts.constants, base + at.LOW, runs), held(contacts.constants, base + at.HIGH, runs)
    leaves = choose(choose(place > low, high - place, runs.zero) > 0.0, runs.zero, 1.0)
    if not anywhere(leaves > 0.5):
        return leaves, leaves
    # A tip that crosses the whole track in one step diverges.
    within = magnitude(place - held(state.carried, i * at.CARRIED + at.ABSCISSA, runs)) < high - low
    return leaves, choose(within, runs.zero + at.OFF_TRACK, runs.zero + at.NOT_FINITE)


@inlined
def any_beyond_ends(sizes: Sizes, paths: Paths, contacts: Contacts, state: Carried, runs: Runs) -> Pair:
    """Return where any contact is beyond the ends of its path, and why."""
    leaves, why = runs.zero, runs.zero
    for i in range(sizes.contacts):
        if paths.path_of[i] >= 0:
            place = held(contacts.now, i * at.IN_STEP + at.PLACE, runs)
            here, because = beyond_ends(i, place, contacts, state, runs)
            leaves, why = choose(here > 0.5, here, leaves), choose(here > 0.5, because, why)
    return leaves, why


@pasted
def end(parts: Parts, ended: Number, completed: Number, runs: Runs) -> None:
    """Record the results of the runs; restore the contacts of ended runs to those at their end."""
    carried, stops = parts.state.carried, parts.records.stops
    write(stops, COMPLETED, runs.first, choose(ended > 0.0, completed, runs.zero + parts.records.energies.shape[0]))
    write(stops, ENDED, runs.first, ended)
    for row in range(carried.shape[0]):
        kept = choose(ended > 0.0, held(parts.state.at_end, row, runs), held(carried, row, runs))
        hold(carried, row, runs, kept)
    stored = energy_of(parts.modes, parts.sizes, runs) + held(parts.state.energies, at.STORED_IN_SPRINGS, runs)
    stored += stored_in_contacts(parts.contacts, carried, parts.sizes.contacts, runs)
    hold(parts.state.energies, at.STORED, runs, stored)
