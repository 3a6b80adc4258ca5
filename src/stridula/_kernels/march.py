"""The march in time: of one run, or of several side by side, with any number of contacts.

The numbers of its parts are those of the steps in `docs/model.rst`.
"""

import math
from typing import NamedTuple

import numba
import numpy as np

from . import layout as at
from .block_rows import CONTACTS, DISPLACEMENT, SINE
from .bookkeeping import add, driven_work, keep_forces, keep_motion, keep_place, share_states
from .contacts import solve_all, start_from_last
from .coupled import energy_of_coupled
from .faces import own_compliance
from .friction import set_valued
from .lanes import anywhere, choose, entry, everywhere, held, hold, magnitude, read, spread, write
from .modes import OPTIONS, set_load, stored_energy, work_of_unit_load
from .recording import begin_sample, height_of, keep_probes, record_contact, record_energies, remember_probes
from .solves import carried_by, forces_of_one, strayed
from .trying import complete_many, complete_one, gap_of, place_after, soften, try_many, try_one
from .vectors import LANES

# Error of the contact forces, relative to the largest, beyond which none can be believed.
UNBELIEVABLE = 1e-3
# What became of a run: samples completed, what ended it.
COMPLETED, ENDED = range(2)


class Sizes(NamedTuple):
    """How much there is of what.

    Attributes
    ----------
    blocks, coupled : int
        Blocks of modes, those of coupled modes, which come first.
    per_block : int
        Numbers of a run in a block.
    contacts, faces : int
        Contacts, blocks of their forces.
    loads : int
        Unit loads.
    paths, coupled_paths : bool
        Whether a contact is on a path, and on one whose modes are coupled.
    """

    blocks: int
    coupled: int
    per_block: int
    contacts: int
    faces: int
    loads: int
    paths: bool
    coupled_paths: bool


class Timing(NamedTuple):
    """Steps of a sample, their length [s], and how contacts are solved: tolerance and most sweeps."""

    steps_per_sample: int
    step: float
    tolerance: float
    sweeps: int


class Modes(NamedTuple):
    """Rows of all modes, ``(blocks, rows, lanes)``, matrices of coupled ones, work of each load when it last changed."""

    rows: np.ndarray
    matrices: np.ndarray
    given: np.ndarray


class Paths(NamedTuple):
    """The modes that each contact sees, and the waves of those that it moves along.

    Attributes
    ----------
    waves : ndarray, shape (blocks, rows, lanes)
        Sines and cosines at each contact.
    sets, pairs : ndarray of int
        Which waves each contact has, and which of them are sums and differences.
    wave_of : ndarray of int, shape (blocks of modes,)
        The wave of a block, from the first of a contact on.
    spans, first_span : ndarray of int
        Spans of blocks; those of contact i from ``first_span[i]`` to ``first_span[i + 1]``, constant ones first.
    path_of : ndarray of int, shape (contacts,)
        The first block of the path of a contact, -1 for none.
    """

    waves: np.ndarray
    sets: np.ndarray
    pairs: np.ndarray
    wave_of: np.ndarray
    spans: np.ndarray
    first_span: np.ndarray
    path_of: np.ndarray


class Contacts(NamedTuple):
    """Laws of friction, constants, compliances and what the contacts are in a step.

    Attributes
    ----------
    codes, laws : ndarray, shapes (contacts,), (contacts runs, parameters)
        Law of each contact and its parameters in each run.
    constants, fixed : ndarray, a column a run
        Constants of each contact; compliance of the only one on constant rows.
    faces, scratch : ndarray, shape (blocks, rows, lanes)
        Forces, displacements and compliances of all contacts; a linear system.
    now, sums : ndarray, a column a run
        What each contact is in a step; sums over a sample.
    """

    codes: np.ndarray
    laws: np.ndarray
    constants: np.ndarray
    fixed: np.ndarray
    faces: np.ndarray
    scratch: np.ndarray
    now: np.ndarray
    sums: np.ndarray


class Carried(NamedTuple):
    """What is carried from step to step, a column a run: of contacts, at their end if they have ended, of energies."""

    carried: np.ndarray
    at_end: np.ndarray
    energies: np.ndarray


class Imposed(NamedTuple):
    """Amplitudes of the loads and what else is imposed; motions of contacts, from a step before; a row a step, or one."""

    signals: np.ndarray
    motion: np.ndarray


class Probes(NamedTuple):
    """Kinds of probes, blocks they see, shares of signals and contact forces, values at the last step."""

    kinds: np.ndarray
    spans: np.ndarray
    direct: np.ndarray
    shares: np.ndarray
    last: np.ndarray


class Records(NamedTuple):
    """A row a sample for energies and contacts, a row a step for the probes; what became of each run."""

    energies: np.ndarray
    contacts: np.ndarray
    raw: np.ndarray
    stops: np.ndarray


@numba.njit(**OPTIONS)
def differ(signals, n, loads, run, runs, zero):
    """Return whether a load at step `n` is another than at the step before."""
    if n == 0 or n >= signals.shape[0]:
        return n == 0
    for j in range(loads):
        column = j * runs + run
        if anywhere(magnitude(read(signals, n, column, zero) - read(signals, n - 1, column, zero)) > 0.0):
            return True
    return False


@numba.njit(**OPTIONS)
def credit_loads(modes, sizes, energies, signals, n, first, run, runs, zero):
    """Add what the loads have given up to step `n` since their amplitudes changed, and begin anew."""
    for j in range(sizes.loads):
        work = work_of_unit_load(modes.rows, first + sizes.loads + j, sizes.blocks, run, zero)
        if n > 0:
            factor = read(signals, n - 1 if signals.shape[0] > 1 else 0, j * runs + run, zero)
            add(energies, at.DRIVE_WORK, run, factor * (work - held(modes.given, j, run, zero)), zero)
        hold(modes.given, j, run, work)


@numba.njit(**OPTIONS)
def leave(ended, completed, leaves, why, sample, state, run, zero):
    """Return what ended runs and how many samples they have, where some leave now; keep what their contacts are."""
    newly = choose(ended > 0.0, zero, leaves) > 0.5
    for row in range(state.carried.shape[0]):
        kept = choose(newly, held(state.carried, row, run, zero), held(state.at_end, row, run, zero))
        hold(state.at_end, row, run, kept)
    return choose(newly, why, ended), choose(newly, zero + sample, completed)


@numba.njit(**OPTIONS)
def beyond_ends(i, place, contacts, state, run, zero):
    """Return where contact `i` is beyond the ends of its path, and why: by its motion, or by one that diverges."""
    base = i * at.CONTACT_CONSTANTS
    low, high = held(contacts.constants, base + at.LOW, run, zero), held(contacts.constants, base + at.HIGH, run, zero)
    leaves = choose(choose(place > low, high - place, zero) > 0.0, zero, 1.0)
    if not anywhere(leaves > 0.5):
        return leaves, leaves
    # A tip does not cross the whole track in one step: that is a march that diverges.
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


@numba.njit(**OPTIONS)
def solve_single(free, contacts, carried, w, timing, run, zero):
    """Return normal and tangential force, status and whether it is jammed of the only contact."""
    _, gap, slip = free
    if not anywhere(gap < 0.0):
        return zero, zero, zero, zero
    law, at_rest = contacts.codes[0], held(contacts.constants, at.AT_REST, run, zero)
    away, before = strayed(carried, 0, run, zero), carried_by(carried, 0, run, zero)
    return forces_of_one(gap, slip, away, w, law, contacts.laws, run, at_rest, before, zero, timing.step, zero)


@numba.njit(**OPTIONS)
def solve_several(modes, paths, contacts, state, sizes, timing, run, runs, zero):
    """Put forces, status, gap and slip of all contacts; return the error of the forces."""
    now, faces, count = contacts.now, contacts.faces, sizes.contacts
    touching, closed = zero, zero
    for i in range(count):
        touching = choose(held(now, i * at.IN_STEP + at.FREE_GAP, run, zero) < 0.0, 1.0, touching)
        closed = choose(held(state.carried, i * at.CARRIED + at.STATUS, run, zero) > 0.5, 1.0, closed)
    if sizes.paths and (anywhere(touching > 0.5) or anywhere(closed > 0.5)):
        soften(modes, paths, contacts, sizes, run, zero)
    start_from_last(contacts, state.carried, touching, sizes, run, zero)
    made, error = zero, zero
    if anywhere(touching > 0.5):
        made, error = solve_all(contacts, state.carried, touching, sizes, timing, run, runs, zero)
    most = held(state.energies, at.ITERATIONS, run, zero)
    hold(state.energies, at.ITERATIONS, run, choose(made > most, made, most))
    add(state.energies, at.UNSOLVED, run, choose(error <= timing.tolerance, zero, 1.0), zero)
    for i in range(count):
        here, w = i * at.IN_STEP, own_compliance(faces, i, run, zero)
        normal, tangential = held(now, here + at.NORMAL_NOW, run, zero), held(now, here + at.TANGENTIAL_NOW, run, zero)
        gap, slip = entry(faces, 2 * i, DISPLACEMENT, run, zero), entry(faces, 2 * i + 1, DISPLACEMENT, run, zero)
        hold(now, here + at.NEW_GAP, run, gap)
        hold(now, here + at.NEW_SLIP, run, slip)
        # From here on without the forces of this contact alone.
        hold(now, here + at.FREE_GAP, run, gap - w[0] * normal + w[1] * tangential)
        hold(now, here + at.FREE_SLIP, run, slip - w[2] * normal + w[3] * tangential)
    return error


@numba.njit(**OPTIONS)
def keep_unsolved(contacts, state, sizes, unsolved, run, zero):
    """Carry the forces that were not found, for the message that says so."""
    for i in range(sizes.contacts):
        here, base = i * at.IN_STEP, i * at.CARRIED
        for row, found in (
            (at.LAST_NORMAL, at.NORMAL_NOW),
            (at.LAST_TANGENTIAL, at.TANGENTIAL_NOW),
            (at.STATUS, at.STATUS_NOW),
        ):
            value = held(contacts.now, here + found, run, zero)
            kept = choose(unsolved > 0.5, value, held(state.carried, base + row, run, zero))
            hold(state.carried, base + row, run, kept)


@numba.njit(**OPTIONS)
def keep_books(i, w, touch, moved, contacts, state, imposed, timing, n, run, runs, zero):
    """Do the bookkeeping of contact `i` in step `n`, but for where it is.

    `touch` are normal and tangential force, status and whether it is jammed, `moved` gap and slip without these forces,
    then with them.
    """
    law, carried, sums = contacts.codes[i], state.carried, contacts.sums
    before = carried_by(carried, i, run, zero)
    if not set_valued(law) or anywhere(touch[2] + before[0] > 0.5):
        away = strayed(carried, i, run, zero)
        at_rest = held(contacts.constants, i * at.CONTACT_CONSTANTS + at.AT_REST, run, zero)
        closed = share_states(i, touch, moved, before, carried, sums, w, away, law, at_rest, run, zero)
        if imposed.motion.shape[0] > 1:
            driven = driven_work(i, touch, imposed.motion, n, run, runs, zero)
            add(state.energies, at.CONTACT_WORK, run, -driven, zero)
            add(state.energies, at.DRIVE_WORK, run, driven, zero)
        number = i * runs + run
        lost = keep_forces(
            i, touch, moved, before, carried, sums, closed, law, contacts.laws, number, timing.step, run, zero
        )
        add(state.energies, at.FRICTION_LOSS, run, lost, zero)
    keep_motion(i, moved, before, carried, run, zero)


@numba.njit(**OPTIONS)
def keep_books_of(i, contacts, state, imposed, timing, n, run, runs, zero):
    """Do the bookkeeping of contact `i` among several."""
    now, here = contacts.now, i * at.IN_STEP
    touch = (
        held(now, here + at.NORMAL_NOW, run, zero),
        held(now, here + at.TANGENTIAL_NOW, run, zero),
        held(now, here + at.STATUS_NOW, run, zero),
        held(now, here + at.JAMMED_NOW, run, zero),
    )
    moved = (
        held(now, here + at.FREE_GAP, run, zero),
        held(now, here + at.FREE_SLIP, run, zero),
        held(now, here + at.NEW_GAP, run, zero),
        held(now, here + at.NEW_SLIP, run, zero),
    )
    w = own_compliance(contacts.faces, i, run, zero)
    keep_books(i, w, touch, moved, contacts, state, imposed, timing, n, run, runs, zero)


@numba.njit(**OPTIONS)
def credit(energies, work, lost, convected, run, zero):
    """Add what a step of the modes came to: work of the contacts, what damping took, work of slopes carried along."""
    add(energies, at.CONTACT_WORK, run, work, zero)
    add(energies, at.DAMPING_LOSS, run, lost, zero)
    add(energies, at.CONVECTION_WORK, run, convected, zero)


@numba.njit(**OPTIONS)
def energy_of(modes, sizes, run, zero):
    """Return the energy half a step ago."""
    places = sizes.coupled * sizes.per_block
    coupled = energy_of_coupled(modes.rows, modes.matrices, sizes.coupled, places, run, zero)
    return coupled + stored_energy(modes.rows, sizes.coupled, sizes.blocks, run, zero)


@numba.njit(**(OPTIONS | {"nogil": True, "forceinline": False}))
def march(zero, run, runs, sizes, timing, modes, paths, contacts, state, imposed, probes, records):
    """March through ``records.energies.shape[0]`` samples, or until no run goes on.

    What belongs to a run has a column for each run; where there are several numbers of a kind, they come in groups of
    columns. `zero` is of the kind that numbers of a run have: a number, or a vector of several runs; `run` is the first
    of these runs, `runs` how many columns there are.
    """
    count, energies, motion = sizes.contacts, state.energies, imposed.motion
    single, moving = count == 1 and sizes.coupled == 0, motion.shape[0] > 1
    first_load = CONTACTS + 2 * count
    first_probe = first_load + 2 * sizes.loads
    remember_probes(modes.rows, first_probe, probes.kinds, probes.spans, probes.last, run, zero)
    advance, ended, completed = zero, zero, zero
    n, pending, sine, touch = 0, False, SINE, (zero, zero, zero, zero)
    for sample in range(records.energies.shape[0]):
        begin_sample(contacts.sums, state.carried, count, run, zero)
        hold(energies, at.ITERATIONS, run, zero)
        hold(energies, at.UNSOLVED, run, zero)
        for i in range(timing.steps_per_sample):
            if differ(imposed.signals, n, sizes.loads, run, runs, zero):
                credit_loads(modes, sizes, energies, imposed.signals, n, first_load, run, runs, zero)
                for j in range(sizes.loads):
                    factor = read(imposed.signals, n, j * runs + run, zero)
                    set_load(modes.rows, j, first_load + j, sizes.blocks, run, factor)
            after = n + 2 if moving else 0
            leaves, why, w, free = zero, zero, (zero, zero, zero, zero), (zero, zero, zero)
            if single:
                free, w_nn, w_tt, done = try_one(
                    modes, paths, contacts, state, imposed, after, touch, pending, sine, run, runs, zero
                )
                sine = 2 - sine
                # A run that has ended is not looked at again.
                free = (free[0], choose(ended > 0.0, zero, free[1]), free[2])
                w_nt = held(contacts.fixed, 1, run, zero)
                w = (w_nn, w_nt, w_nt, choose(ended > 0.0, 1.0, w_tt))
                if pending:
                    credit(energies, done[0], done[1], done[2] * advance, run, zero)
                    keep_probes(modes.rows, first_probe, probes, imposed, contacts.now, 1, n - 1, run, runs, records.raw, zero)
                if sizes.paths:
                    leaves, why = beyond_ends(0, free[0], contacts, state, run, zero)
                touch = solve_single(free, contacts, state.carried, w, timing, run, zero)
            else:
                try_many(modes, paths, contacts, state, imposed, sizes, after, ended, run, runs, zero)
                if sizes.paths:
                    leaves, why = any_beyond_ends(sizes, paths, contacts, state, run, zero)
                error = solve_several(modes, paths, contacts, state, sizes, timing, run, runs, zero)
                unsolved = choose(leaves > 0.5, zero, choose(error <= UNBELIEVABLE, zero, 1.0))
                if anywhere(unsolved > 0.5):
                    keep_unsolved(contacts, state, sizes, choose(ended > 0.0, zero, unsolved), run, zero)
                    why = choose(unsolved > 0.5, zero + at.CONTACT_UNSOLVED, why)
                    leaves = choose(unsolved > 0.5, 1.0, leaves)
            if anywhere(leaves > 0.5):
                ended, completed = leave(ended, completed, leaves, why, sample, state, run, zero)
                if everywhere(ended > 0.0):
                    break
            if single:
                normal, tangential = touch[0], touch[1]
                gap, slip = free[1] + w[0] * normal - w[1] * tangential, free[2] + w[2] * normal - w[3] * tangential
                place = free[0] + w[1] * normal - held(contacts.fixed, 2, run, zero) * tangential
                moved = (free[1], free[2], gap, slip)
                keep_books(0, w, touch, moved, contacts, state, imposed, timing, n, run, runs, zero)
                hold(contacts.now, at.NORMAL_NOW, run, normal)
                hold(contacts.now, at.TANGENTIAL_NOW, run, tangential)
                advance = keep_place(0, state.carried, place, run, zero)
                n += 1
                pending = i + 1 < timing.steps_per_sample and not differ(imposed.signals, n, sizes.loads, run, runs, zero)
                if not pending:
                    done = complete_one(modes, paths, touch, sine, run, zero)
                    credit(energies, done[0], done[1], done[2] * advance, run, zero)
            else:
                work, lost = complete_many(modes, paths, contacts, sizes, run, zero)
                credit(energies, work, lost, zero, run, zero)
                for j in range(count):
                    keep_books_of(j, contacts, state, imposed, timing, n, run, runs, zero)
                    place, slope = place_after(j, modes, paths, contacts, imposed, after, run, runs, zero)
                    way = keep_place(j, state.carried, place, run, zero)
                    add(energies, at.CONVECTION_WORK, run, slope * way, zero)
                n += 1
            if not pending:
                keep_probes(modes.rows, first_probe, probes, imposed, contacts.now, count, n - 1, run, runs, records.raw, zero)
        if everywhere(ended > 0.0):
            break
        credit_loads(modes, sizes, energies, imposed.signals, n, first_load, run, runs, zero)
        stored = energy_of(modes, sizes, run, zero)
        hold(energies, at.STORED, run, stored)
        size = choose(ended > 0.0, zero, magnitude(stored))
        if not everywhere(size < math.inf):
            leaves = choose(size < math.inf, zero, 1.0)
            ended, completed = leave(ended, completed, leaves, zero + at.NOT_FINITE, sample, state, run, zero)
            if everywhere(ended > 0.0):
                break
        record_energies(energies, records.energies, sample, run, runs, zero)
        for i in range(count):
            height = gap_of(i, contacts.constants, motion, n + 1 if moving else 0, run, runs, zero)
            height += height_of(modes.rows, i, paths.spans, paths.first_span[i], paths.first_span[i + 1], run, zero)
            record_contact(
                i, contacts.sums, state.carried, height, timing.steps_per_sample, timing.step, records.contacts, sample, run, runs, zero
            )
    write(records.stops, COMPLETED, run, choose(ended > 0.0, completed, zero + records.energies.shape[0]))
    write(records.stops, ENDED, run, ended)
    for row in range(state.carried.shape[0]):
        last = choose(ended > 0.0, held(state.at_end, row, run, zero), held(state.carried, row, run, zero))
        hold(state.carried, row, run, last)
    hold(energies, at.STORED, run, energy_of(modes, sizes, run, zero))


@numba.njit(cache=True, nogil=True, _nrt=False)
def march_run(*arguments):
    """March one run."""
    march(0.0, 0, 1, *arguments)


@numba.njit(cache=True, nogil=True, _nrt=False)
def march_runs(*arguments):
    """March `LANES` runs side by side."""
    march(spread(0.0), 0, LANES, *arguments)


def march_one_by_one(runs, *arguments):
    """March runs one after the other in plain Python, where nothing is compiled."""
    for run in range(runs):
        march(0.0, run, runs, *arguments)
