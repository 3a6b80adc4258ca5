"""The march of one contact between bodies whose modes are uncoupled: of one run, or of several side by side."""

import math

import numba

from . import layout as at
from .block_rows import LOADS, NORMAL, WAVES, D, Q
from .contact import SLIDING, STICKING, closed_share, landed_share, stuck_share, velocity_at
from .friction import set_valued
from .lanes import anywhere, choose, everywhere, magnitude, read, spread, total, write
from .mode_rows import (
    pass_fixed,
    pass_harmonics,
    product,
    set_load,
    stored_energy,
    work_of_unit_load,
)
from .solves import coulomb, next_states, solve, turned_round
from .traces import IN_ORDER, set_harmonics
from .vectors import LANES

# Numbers of a run: of the contact, compliances of the fixed rows, coefficient of Coulomb's law.
START, GAP, LENGTH, WAVENUMBER, W_NN, W_NT, W_TT, COEFFICIENT = range(8)
# What became of a run: samples completed, what ended it.
COMPLETED, ENDED = range(2)


@numba.njit(cache=True)
def differ(signals, n, loads, run, runs, zero):
    """Return whether a load at step `n` is another than at the step before."""
    if n == 0 or n >= signals.shape[0]:
        return n == 0
    for j in range(loads):
        column = j * runs + run
        if anywhere(magnitude(read(signals, n, column, zero) - read(signals, n - 1, column, zero)) > 0.0):
            return True
    return False


@numba.njit(cache=True, inline="always")
def centred(motion, n, column, zero):
    """Return the motion of a step, half that of the step before and after."""
    return 0.5 * (read(motion, n + 2, column, zero) - read(motion, n, column, zero))


@numba.njit(cache=True)
def keep(array, row, run, ended, value, zero):
    """Put numbers of runs that go on into a row of `array`."""
    write(array, row, run, choose(ended > 0.0, read(array, row, run, zero), value))


@numba.njit(cache=True)
def keep_probes(rows, probes, signals, loads, n, run, runs, normal, tangential, raw, zero):
    """Put the values of the probes at step `n`, which is complete, into a row of `raw`."""
    kinds, spans, direct, shares, last = probes
    for i in range(kinds.size):
        seen = Q if kinds[i] == at.DISPLACEMENT else D
        now = product(rows, LOADS + loads + i, seen, spans[i, 0], spans[i, 1], run, zero)
        value = read(last, i, run, zero)
        write(last, i, run, now)
        if kinds[i] == at.VELOCITY:
            value = now + value
        elif kinds[i] == at.ACCELERATION:
            value = now - value
        value += read(shares, 2 * i, run, zero) * normal + read(shares, 2 * i + 1, run, zero) * tangential
        for j in range(signals.shape[1] // runs):
            column = j * runs + run
            factor = read(signals, n if signals.shape[0] > 1 else 0, column, zero)
            value += read(direct, i, column, zero) * factor
        write(raw, n, i * runs + run, value)


@numba.njit(nogil=True, cache=True, fastmath=IN_ORDER, error_model="numpy")
def steps(
    zero,
    run,
    runs,
    blocks,
    steps_per_sample,
    step,
    law,
    laws,
    numbers,
    rows,
    carried,
    energies,
    given,
    signals,
    motion,
    probes,
    energy_record,
    record,
    raw,
    stops,
):
    """March through ``record.shape[0]`` samples, or until no run goes on.

    What belongs to a run has a column for each run; where there are several numbers of a kind, they come in groups of
    columns. `signals` and `motion` have one row where they do not vary.

    Parameters
    ----------
    zero : float or vector
        Zero, of the kind that numbers of a run have.
    run, runs : int
        First column of these runs, and how many columns there are.
    blocks : tuple of int
        Number of blocks of fixed, bending and axial modes.
    law, laws : int, ndarray of shape (runs, parameters)
        Code of the law of friction, and its parameters in each run.
    numbers, carried, energies : ndarray, one column a run
        Constants of the contact; what it carries from step to step; energies since the start. The last two are updated.
    rows : ndarray, shape (blocks, rows, lanes)
        What is known of the modes; the state in them is updated.
    given : ndarray, shape (loads, runs)
        Scratch: work of each unit load when its amplitude last changed.
    signals, motion : ndarray, one row a step, or one
        Amplitudes of the loads and what else is imposed; motions imposed on the contact, from a step before the first.
    probes : tuple of ndarray
        Kinds, spans of blocks, shares of the signals and of the contact forces, values at the last step.
    energy_record, record, raw : ndarray
        A row a sample for energies and contact, a row a step for the probes.
    stops : ndarray, shape (2, runs)
        What became of each run.
    """
    fixed, bending, axial = blocks
    whole, loads = fixed + bending + axial, given.shape[0]
    start, open_gap = read(numbers, START, run, zero), read(numbers, GAP, run, zero)
    length, wavenumber = read(numbers, LENGTH, run, zero), read(numbers, WAVENUMBER, run, zero)
    fixed_nn, fixed_tt = read(numbers, W_NN, run, zero), read(numbers, W_TT, run, zero)
    w_nt, coefficient = read(numbers, W_NT, run, zero), read(numbers, COEFFICIENT, run, zero)
    material, anchor = read(carried, at.MATERIAL, run, zero), read(carried, at.ANCHOR, run, zero)
    status, last_slip = read(carried, at.STATUS, run, zero), read(carried, at.LAST_SLIP, run, zero)
    place, place_before = read(carried, at.ABSCISSA, run, zero), read(carried, at.ABSCISSA_BEFORE, run, zero)
    earlier_slip, law_state = read(carried, at.EARLIER_SLIP, run, zero), read(carried, at.FRICTION_STATE, run, zero)
    drive, contact = read(energies, at.DRIVE_WORK, run, zero), read(energies, at.CONTACT_WORK, run, zero)
    friction, convection = read(energies, at.FRICTION_LOSS, run, zero), read(energies, at.CONVECTION_WORK, run, zero)
    damping = read(energies, at.DAMPING_LOSS, run, zero)
    normal, tangential = read(carried, at.LAST_NORMAL, run, zero), read(carried, at.LAST_TANGENTIAL, run, zero)
    gap, closed = read(carried, at.LAST_GAP, run, zero), read(carried, at.CLOSED_SHARE, run, zero)
    advance, ended, completed = zero, zero, zero
    varying, moving, with_state = signals.shape[0] > 1, motion.shape[0] > 1, not set_valued(law)
    kinds, spans, _, _, last_seen = probes
    for i in range(kinds.size):
        seen = Q if kinds[i] == at.DISPLACEMENT else D
        at_start = product(rows, LOADS + loads + i, seen, spans[i, 0], spans[i, 1], run, zero)
        write(last_seen, i, run, at_start)

    n, pending, sines = 0, False, WAVES
    for sample in range(record.shape[0]):
        normals, tangentials, jams, landings, sticking, sliding = zero, zero, zero, zero, zero, zero
        stuck_steps, slid_steps = zero, zero
        first_material = material
        for i in range(steps_per_sample):
            if differ(signals, n, loads, run, runs, zero):
                for j in range(loads):
                    work = work_of_unit_load(rows, j, whole, run, zero)
                    if n > 0:
                        drive += read(signals, n - 1, j * runs + run, zero) * (work - read(given, j, run, zero))
                    write(given, j, run, work)
                    set_load(rows, j, whole, run, read(signals, n, j * runs + run, zero))

            along, across, works, losses = pass_fixed(rows, fixed, run, pending, normal, tangential)
            now = n + 2 if moving else 0
            new_place = start + read(motion, now, at.TIP_MOTION * runs + run, zero) + total(along, zero)
            new_gap = open_gap + read(motion, now, at.GAP_MOTION * runs + run, zero) + total(across, zero)
            slip = new_place - read(motion, now, at.TRACK_MOTION * runs + run, zero) - material
            w_nn, w_tt, slope = fixed_nn, fixed_tt, zero
            if bending:
                # A run that has ended is not looked at again.
                room = choose(ended > 0.0, 1.0, choose(new_place > 0.5 * length, length - new_place, new_place))
                if not everywhere(room > 0.0):
                    keep(carried, at.STATUS, run, ended, status, zero)
                    keep(carried, at.ABSCISSA, run, ended, place, zero)
                    keep(carried, at.LAST_NORMAL, run, ended, normal, zero)
                    keep(carried, at.LAST_TANGENTIAL, run, ended, tangential, zero)
                    # A tip does not cross the whole track in one step: that is a march that diverges.
                    why = choose(magnitude(new_place - place) < length, float(at.OFF_TRACK), float(at.NOT_FINITE))
                    completed = choose(room > 0.0, completed, float(sample))
                    ended = choose(room > 0.0, ended, why)
                    write(stops, COMPLETED, run, completed)
                    write(stops, ENDED, run, ended)
                    if everywhere(ended > 0.0):
                        return
                last_sines, sines = sines, 2 * WAVES + 2 - sines
                set_harmonics(wavenumber * new_place, max(bending, axial), rows, fixed, sines, run)
                trace, softness, bends, work, loss = pass_harmonics(
                    rows, fixed, bending, fixed, run, pending, -normal, last_sines, sines
                )
                works, losses = works + work, losses + loss
                new_gap -= total(trace, zero)
                w_nn += total(softness, zero)
                trace, softness, stretches, work, loss = pass_harmonics(
                    rows, fixed + bending, axial, fixed, run, pending, tangential, last_sines, sines
                )
                works, losses = works + work, losses + loss
                slip -= total(trace, zero)
                w_tt += total(softness, zero)
                slope = normal * total(bends, zero) - tangential * total(stretches, zero)
            if pending:
                contact += 0.5 * total(works, zero)
                damping += 0.25 * total(losses, zero)
                convection += slope * advance
                keep_probes(rows, probes, signals, loads, n - 1, run, runs, normal, tangential, raw, zero)

            before = (status, last_slip, earlier_slip, law_state, normal, tangential)
            stuck, touched = magnitude(status - STICKING) < 0.5, status > 0.5 * STICKING
            last_gap, gap = gap, choose(ended > 0.0, zero, new_gap)
            if anywhere(choose(touched, gap, -1.0) >= 0.0):
                left = closed - 1.0 + closed_share(normal, tangential, gap, w_nn, w_nt)
                closed = choose(choose(touched, gap, -1.0) < 0.0, closed, choose(left < 0.0, zero, left))
            sticking += choose(stuck, closed, zero)
            sliding += choose(stuck, zero, closed)
            was_closed = closed
            normal, tangential, new_status, jammed, closed = zero, zero, zero, zero, zero
            if anywhere(gap < 0.0):
                strayed = choose(stuck, material - anchor, zero)
                w = (w_nn, w_nt, w_nt, w_tt)
                if law == at.COULOMB and everywhere(choose(ended > 0.0, 1.0, w_tt) > 0.0):
                    normal, tangential, new_status, jammed = coulomb(gap, slip + strayed, w, coefficient)
                    slid = choose(status > SLIDING - 0.5, last_slip, zero)
                    on = choose(new_status > SLIDING - 0.5, tangential * slid, zero) > 0.0
                    if anywhere(choose(on, zero, choose(gap < 0.0, magnitude(slid), zero)) > 0.0):
                        normal, tangential, new_status = turned_round(
                            gap, slip, slid, w, coefficient, normal, tangential, new_status
                        )
                else:
                    normal, tangential, new_status, jammed = solve(gap, slip, strayed, w, law, laws, run, before, step)
                slips = choose(stuck, new_status, zero) > SLIDING - 0.5
                if not with_state and anywhere(slips):
                    held = stuck_share(before[4], before[5], gap, slip + strayed, w, coefficient)
                    sooner = choose(slips, (1.0 - held) * was_closed, zero)
                    sticking -= sooner
                    sliding += sooner
                closed = choose(touched, 1.0, landed_share(last_gap, gap))
                closed = choose(gap < 0.0, closed, zero)
                gap += w_nn * normal - w_nt * tangential
                slip += w_nt * normal - w_tt * tangential
                new_place += w_nt * normal - fixed_tt * tangential
                sticks = magnitude(new_status - STICKING) < 0.5
                anchor = choose(sticks, choose(stuck, anchor, material), anchor)
                stuck_steps += choose(sticks, 1.0, 0.0)
                slid_steps += choose(new_status > SLIDING - 0.5, 1.0, 0.0)
                jams += jammed
                landings += choose(touched, 0.0, choose(new_status > 0.5 * STICKING, 1.0, 0.0))
                if moving:
                    tip_motion = centred(motion, n, at.TIP_MOTION * runs + run, zero)
                    track_motion = centred(motion, n, at.TRACK_MOTION * runs + run, zero)
                    lift = centred(motion, n, at.GAP_MOTION * runs + run, zero)
                    driven = tangential * (tip_motion - track_motion) - normal * lift
                    contact -= driven
                    drive += driven
                # In a step in which the slip turns round, its mean force and the slip have opposite signs.
                friction += tangential * slip if with_state else magnitude(tangential * slip)
                normals += normal
                tangentials += tangential
            if with_state:
                velocity = velocity_at(slip, before, step)
                law_state = next_states(law, laws, run, new_status, law_state, velocity, step)
            material += slip
            status, last_slip, earlier_slip = new_status, slip, last_slip
            advance = 0.5 * (new_place - place_before)
            place_before, place = place, new_place
            n += 1

            pending = i + 1 < steps_per_sample and not differ(signals, n, loads, run, runs, zero)
            if not pending:
                _, _, works, losses = pass_fixed(rows, fixed, run, True, normal, tangential)
                _, _, bends, work, loss = pass_harmonics(rows, fixed, bending, fixed, run, True, -normal, sines, sines)
                works, losses = works + work, losses + loss
                _, _, stretches, work, loss = pass_harmonics(
                    rows, fixed + bending, axial, fixed, run, True, tangential, sines, sines
                )
                contact += 0.5 * total(works + work, zero)
                damping += 0.25 * total(losses + loss, zero)
                convection += (normal * total(bends, zero) - tangential * total(stretches, zero)) * advance
                keep_probes(rows, probes, signals, loads, n - 1, run, runs, normal, tangential, raw, zero)

        for j in range(loads):
            work = work_of_unit_load(rows, j, whole, run, zero)
            factor = read(signals, n - 1 if varying else 0, j * runs + run, zero)
            drive += factor * (work - read(given, j, run, zero))
            write(given, j, run, work)
        energy = stored_energy(rows, whole, run, zero)
        size = choose(ended > 0.0, zero, magnitude(energy))
        if not everywhere(size < math.inf):
            completed = choose(size < math.inf, completed, float(sample))
            ended = choose(size < math.inf, ended, float(at.NOT_FINITE))
            write(stops, COMPLETED, run, completed)
            write(stops, ENDED, run, ended)
            if everywhere(ended > 0.0):
                return
        height = open_gap + product(rows, NORMAL, Q, 0, fixed, run, zero)
        lift = read(motion, n + 1 if moving else 0, at.GAP_MOTION * runs + run, zero)
        share = 1.0 / steps_per_sample
        write(energy_record, sample, at.STORED * runs + run, energy)
        write(energy_record, sample, at.DRIVE_WORK * runs + run, drive)
        write(energy_record, sample, at.CONTACT_WORK * runs + run, contact)
        write(energy_record, sample, at.FRICTION_LOSS * runs + run, friction)
        write(energy_record, sample, at.CONVECTION_WORK * runs + run, convection)
        write(energy_record, sample, at.DAMPING_LOSS * runs + run, damping)
        write(record, sample, at.NORMAL_FORCE * runs + run, normals * share)
        write(record, sample, at.TANGENTIAL_FORCE * runs + run, tangentials * share)
        write(record, sample, at.SEPARATED * runs + run, (steps_per_sample - sticking - sliding) * share)
        write(record, sample, at.STICKING * runs + run, sticking * share)
        write(record, sample, at.SLIDING * runs + run, sliding * share)
        write(record, sample, at.CONTACT_POSITION * runs + run, place)
        write(record, sample, at.CONTACT_HEIGHT * runs + run, height + lift)
        write(record, sample, at.CONTACT_GAP * runs + run, gap)
        write(record, sample, at.SLIP_VELOCITY * runs + run, (material - first_material) * (share / step))
        write(record, sample, at.JAMMED * runs + run, jams)
        write(record, sample, at.LANDINGS * runs + run, landings)
        write(record, sample, at.LAW_STATE * runs + run, law_state)
        apart_steps = steps_per_sample - stuck_steps - slid_steps
        dominant = choose(stuck_steps < apart_steps, 0.0, float(STICKING))
        most = choose(stuck_steps < apart_steps, apart_steps, stuck_steps)
        write(record, sample, at.DOMINANT * runs + run, choose(slid_steps < most, dominant, float(SLIDING)))

    write(stops, COMPLETED, run, choose(ended > 0.0, completed, float(record.shape[0])))
    write(stops, ENDED, run, ended)
    keep(carried, at.MATERIAL, run, ended, material, zero)
    keep(carried, at.ANCHOR, run, ended, anchor, zero)
    keep(carried, at.STATUS, run, ended, status, zero)
    keep(carried, at.ABSCISSA, run, ended, place, zero)
    keep(carried, at.ABSCISSA_BEFORE, run, ended, place_before, zero)
    keep(carried, at.LAST_SLIP, run, ended, last_slip, zero)
    keep(carried, at.EARLIER_SLIP, run, ended, earlier_slip, zero)
    keep(carried, at.LAST_GAP, run, ended, gap, zero)
    keep(carried, at.CLOSED_SHARE, run, ended, closed, zero)
    keep(carried, at.FRICTION_STATE, run, ended, law_state, zero)
    keep(carried, at.LAST_NORMAL, run, ended, normal, zero)
    keep(carried, at.LAST_TANGENTIAL, run, ended, tangential, zero)
    write(energies, at.STORED, run, stored_energy(rows, whole, run, zero))
    write(energies, at.DRIVE_WORK, run, drive)
    write(energies, at.CONTACT_WORK, run, contact)
    write(energies, at.FRICTION_LOSS, run, friction)
    write(energies, at.CONVECTION_WORK, run, convection)
    write(energies, at.DAMPING_LOSS, run, damping)


@numba.njit(cache=True, nogil=True)
def march_run(blocks, *arguments):
    """March one run."""
    steps(0.0, 0, 1, blocks, *arguments)


@numba.njit(cache=True, nogil=True)
def march_runs(blocks, *arguments):
    """March `LANES` runs side by side."""
    steps(spread(0.0), 0, LANES, blocks, *arguments)


def march_one_by_one(runs, blocks, *arguments):
    """March runs one after the other in plain Python, where nothing is compiled."""
    for run in range(runs):
        steps(0.0, run, runs, blocks, *arguments)
