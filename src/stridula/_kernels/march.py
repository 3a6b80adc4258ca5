"""The march of increments for any number of contacts and coupled modes: trial, contacts, correction, ledger, record."""

import math

import numba
import numpy as np

from . import layout as at
from .contact import SEPARATED, SLIDING, STICKING, closed_share, landed_share, stuck_share, velocity_at
from .friction import next_state, set_valued
from .gauss_seidel import displacement, own_compliance, solve_all, strayed
from .traces import FASTMATH, harmonics

# Error of the contact forces, relative to the largest, beyond which none can be believed.
UNBELIEVABLE = 1e-3


@numba.njit(cache=True, fastmath=FASTMATH, nogil=True)
def stored_energy(block, matrices, state):
    """Return the energy half a step ago, ``[(1+b)/2 d² + r q[n] q[n-1]] / (2 l)`` summed over the modes."""
    energy = 0.0
    coupled = matrices.shape[1]
    for k in range(coupled):
        kinetic = elastic = 0.0
        for j in range(coupled):
            kinetic += matrices[at.KINETIC, k, j] * state[at.D, j]
            elastic += matrices[at.ELASTIC, k, j] * (state[at.Q, j] - state[at.D, j])
        energy += kinetic * state[at.D, k] + elastic * state[at.Q, k]
    for k in range(state.shape[1]):
        q, d = state[at.Q, k], state[at.D, k]
        energy += ((1.0 - block[at.HALF_LOSS, k]) * d * d + block[at.R, k] * q * (q - d)) * block[at.HALF_OVER_LOAD, k]
    return energy


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def set_load(loads, signals, n, load):
    """Put the sum of the load increments, each times its signal at step `n`, into `load`."""
    for k in range(load.size):
        load[k] = signals[n, 0] * loads[0, k]
    for j in range(1, loads.shape[0]):
        for k in range(load.size):
            load[k] += signals[n, j] * loads[j, k]


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def trial_increments(block, matrices, state, load, new, position):
    """Put increments and positions at the end of the step without contact force into `new` and `position`."""
    for k in range(new.size):
        increment = block[at.B, k] * state[at.D, k] - block[at.R, k] * state[at.Q, k] + load[k]
        new[k] = increment
        position[k] = state[at.Q, k] + increment
    for k in range(matrices.shape[1]):
        for j in range(matrices.shape[1]):
            new[k] += matrices[at.KEPT, k, j] * state[at.D, j] - matrices[at.STIFFNESS, k, j] * state[at.Q, j]
        position[k] = state[at.Q, k] + new[k]


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def along(rows, i, side, vector, first, last):
    """Return the displacement along a row of contact `i` over a span."""
    total = 0.0
    for k in range(first, last):
        total += rows[i, side, k] * vector[k]
    return total


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def set_harmonics(contacts, spans, i, place, rows, waves, slopes):
    """Put minus the trace of a beam at abscissa `place`, and its slope, into the harmonic spans of contact `i`."""
    sines, cosines = waves[0], waves[1]
    first, first_axial = spans[i, at.BENDING], spans[i, at.AXIAL]
    wavenumber, amplitude = contacts[i, at.WAVENUMBER], contacts[i, at.AMPLITUDE]
    count = np.int64(spans[i, at.WAVES])
    harmonics(contacts[i, at.PHASE] + wavenumber * place, count, sines, cosines)
    for k in range(first, spans[i, at.BENDING_END]):
        rows[i, at.NORMAL, k] = -amplitude * sines[k - first]
    for k in range(first_axial, spans[i, at.AXIAL_END]):
        rows[i, at.TANGENTIAL, k] = -amplitude * sines[k - first_axial]
    for k in range(count):
        slopes[i, k] = -amplitude * wavenumber * (k + 1.0) * cosines[k]


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def set_products(contacts, spans, half_waves, shares, i, place, rows, waves, slopes):
    """Put minus the trace of a plate at abscissa `place` of its line, and its slope, into the span of contact `i`."""
    sines, cosines, cross_sines, cross_cosines = waves[0], waves[1], waves[2], waves[3]
    first, amplitude = spans[i, at.BENDING], contacts[i, at.AMPLITUDE]
    rate, cross_rate = contacts[i, at.WAVENUMBER], contacts[i, at.CROSS_WAVENUMBER]
    harmonics(contacts[i, at.PHASE] + rate * place, np.int64(spans[i, at.WAVES]), sines, cosines)
    phase = contacts[i, at.CROSS_PHASE] + cross_rate * place
    harmonics(phase, np.int64(spans[i, at.CROSS_WAVES]), cross_sines, cross_cosines)
    for k in range(first, spans[i, at.BENDING_END]):
        m, n = half_waves[at.ALONG, k], half_waves[at.ACROSS, k]
        rows[i, at.NORMAL, k] = -amplitude * sines[m] * cross_sines[n]
        turn = rate * (m + 1.0) * cosines[m] * cross_sines[n] + cross_rate * (n + 1.0) * sines[m] * cross_cosines[n]
        slopes[i, k - first] = -amplitude * turn
    for k in range(spans[i, at.AXIAL], spans[i, at.AXIAL_END]):
        m, n = half_waves[at.ALONG, k], half_waves[at.ACROSS, k]
        sine, cosine, cross_sine, cross_cosine = sines[m], cosines[m], cross_sines[n], cross_cosines[n]
        moved = shares[at.SINE_COSINE, k] * sine * cross_cosine + shares[at.COSINE_SINE, k] * cosine * cross_sine
        rows[i, at.TANGENTIAL, k] = -moved
        turn = shares[at.BOTH_COSINES, k] * cosine * cross_cosine + shares[at.BOTH_SINES, k] * sine * cross_sine
        slopes[i, k - first] = -turn


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def set_compliance(block, matrices, rows, response, compliance):
    """Put the relative displacements of all contacts for unit forces on each into `compliance`.

    It is symmetric but where stiffness and damping of coupled modes do not commute.
    """
    coupled = matrices.shape[1] > 0
    for i in range(rows.shape[0]):
        for side in range(2):
            for k in range(response.size):
                response[k] = block[at.LOAD, k] * rows[i, side, k]
            for k in range(matrices.shape[1]):
                for j in range(matrices.shape[1]):
                    response[k] += matrices[at.MOBILITY, k, j] * rows[i, side, j]
            for j in range(rows.shape[0] if coupled else i + 1):
                for other in range(2):
                    value = along(rows, j, other, response, 0, response.size)
                    compliance[2 * j + other, 2 * i + side] = value
                    if not coupled:
                        compliance[2 * i + side, 2 * j + other] = value


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def add_push(spans, rows, i, normal, tangential, push):
    """Add the modal forces of contact `i` to `push`."""
    for k in range(spans[i, at.FIXED], spans[i, at.FIXED_END]):
        push[k] += rows[i, at.NORMAL, k] * normal - rows[i, at.TANGENTIAL, k] * tangential
    for k in range(spans[i, at.BENDING], spans[i, at.BENDING_END]):
        push[k] += rows[i, at.NORMAL, k] * normal
    for k in range(spans[i, at.AXIAL], spans[i, at.AXIAL_END]):
        push[k] -= rows[i, at.TANGENTIAL, k] * tangential


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def correct(block, matrices, state, push, new):
    """Add what the contact forces do to the increments; return their work."""
    for k in range(matrices.shape[1]):
        for j in range(matrices.shape[1]):
            new[k] += matrices[at.MOBILITY, k, j] * push[j]
    exchanged = 0.0
    for k in range(new.size):
        new[k] += block[at.LOAD, k] * push[k]
        exchanged += push[k] * (new[k] + state[at.D, k])
    return 0.5 * exchanged


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def work_of_loads_and_damping(block, matrices, state, load, new):
    """Return what the loads give and what damping takes in a step."""
    coupled = matrices.shape[1]
    given = lost = 0.0
    for k in range(new.size):
        both = new[k] + state[at.D, k]
        given += load[k] * both * block[at.HALF_OVER_LOAD, k]
        lost += block[at.HALF_LOSS, k] * both * both * block[at.HALF_OVER_LOAD, k]
    for k in range(coupled):
        impulse = loss = 0.0
        for j in range(coupled):
            impulse += matrices[at.IMPULSE, k, j] * load[j]
            loss += matrices[at.LOSS, k, j] * (new[j] + state[at.D, j]) - matrices[at.TURN, k, j] * state[at.D, j]
        given += impulse * (new[k] + state[at.D, k])
        lost += loss * (new[k] + state[at.D, k])
    return given, lost


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def convecting_force(spans, i, slopes, normal, tangential, state, new):
    """Return the force along the track that its slopes make of the forces of contact `i`."""
    first, first_axial = spans[i, at.BENDING], spans[i, at.AXIAL]
    # Both kinds of modes of a beam share their slopes.
    first_stretched = first if spans[i, at.CROSS_WAVES] > 0 else first_axial
    bend = stretch = 0.0
    for k in range(first, spans[i, at.BENDING_END]):
        bend += slopes[i, k - first] * (state[at.Q, k] + new[k])
    for k in range(first_axial, spans[i, at.AXIAL_END]):
        stretch += slopes[i, k - first_stretched] * (state[at.Q, k] + new[k])
    return tangential * stretch - normal * bend


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def closed_before(carried, i, status, gap, w):
    """Return the share of the last step in which contact `i` was closed; `status` and `gap` are those of this step."""
    closed = carried[i, at.CLOSED_SHARE]
    normal, tangential = carried[i, at.LAST_NORMAL], carried[i, at.LAST_TANGENTIAL]
    if status != SEPARATED or int(carried[i, at.STATUS]) == SEPARATED or normal <= 0.0:
        return closed
    return max(0.0, closed - 1.0 + closed_share(normal, tangential, gap, w[2 * i, 2 * i], w[2 * i, 2 * i + 1]))


@numba.njit(cache=True, fastmath=FASTMATH, inline="always")
def keep_probes(rows, kinds, direct, shares, state, new, signals, n, forces, raw):
    """Put the values of the probes at step `n` into ``raw[n]``."""
    for p in range(rows.shape[0]):
        value = 0.0
        for i in range(forces.shape[0]):
            value += shares[p, i, 0] * forces[i, 0] + shares[p, i, 1] * forces[i, 1]
        for j in range(signals.shape[1]):
            value += direct[p, j] * signals[n, j]
        for k in range(kinds[p, at.DISPLACEMENT, 0], kinds[p, at.DISPLACEMENT, 1]):
            value += rows[p, at.DISPLACEMENT, k] * state[at.Q, k]
        for k in range(kinds[p, at.VELOCITY, 0], kinds[p, at.VELOCITY, 1]):
            value += rows[p, at.VELOCITY, k] * (new[k] + state[at.D, k])
        for k in range(kinds[p, at.ACCELERATION, 0], kinds[p, at.ACCELERATION, 1]):
            value += rows[p, at.ACCELERATION, k] * (new[k] - state[at.D, k])
        raw[n, p] = value


@numba.njit(cache=True, fastmath=FASTMATH, nogil=True)
def march(
    steps_per_sample,
    step,
    tolerance,
    sweeps,
    block,
    matrices,
    contacts,
    laws,
    spans,
    half_waves,
    shares,
    rows,
    compliance,
    state,
    carried,
    energies,
    loads,
    signals,
    motion,
    probe_rows,
    probe_kinds,
    probe_direct,
    probe_shares,
    energy_record,
    record,
    raw,
):
    """March through ``record.shape[0]`` samples and return (samples completed, what ended the march).

    `loads` has a row of load increments for each of the first signals, `signals` a row of amplitudes a step, `motion`
    the motions imposed on each contact at every step, the one before and the one after. `half_waves` are those of
    the modes of plates, `shares` what their products give of those in the plane. `rows` are the contacts' traces, their
    harmonic spans filled here; `compliance` is that of the fixed parts. `state`, `carried` and `energies` are updated
    in place; `energy_record` and `record` get a row a sample, `raw` the probes at every step.
    """
    n_modes, n_contacts = block.shape[1], contacts.shape[0]
    n_harmonic = 0
    for i in range(n_contacts):
        n_harmonic += spans[i, at.BENDING_END] > spans[i, at.BENDING]
    waves, slopes = np.zeros((4, 2 * n_modes + 1)), np.zeros((n_contacts, n_modes))
    waves[1, 2 * n_modes] = waves[3, 2 * n_modes] = 1.0
    load, new, position = np.zeros(n_modes), np.empty(n_modes), np.empty(n_modes)
    push, work = np.empty(n_modes), np.empty(n_modes)
    gaps, slips, places = np.empty(n_contacts), np.empty(n_contacts), np.empty(n_contacts)
    forces, statuses = np.zeros((n_contacts, 2)), np.zeros(n_contacts, dtype=np.int64)
    jammed = np.zeros(n_contacts, dtype=np.bool_)
    w = compliance.copy()
    sums, steps_in = np.zeros((n_contacts, at.COLUMNS)), np.zeros((n_contacts, 3), dtype=np.int64)
    first_material = np.empty(n_contacts)
    drive, contact = energies[at.DRIVE_WORK], energies[at.CONTACT_WORK]
    friction, convection = energies[at.FRICTION_LOSS], energies[at.CONVECTION_WORK]
    damping = energies[at.DAMPING_LOSS]

    n = 0
    for sample in range(record.shape[0]):
        sums[:], steps_in[:] = 0.0, 0
        most_sweeps = unsolved = 0
        for i in range(n_contacts):
            first_material[i] = carried[i, at.MATERIAL]
        for _ in range(steps_per_sample):
            changed = n == 0
            for j in range(loads.shape[0]):
                changed = changed or signals[n, j] != signals[n - 1, j]
            if changed and loads.shape[0]:
                set_load(loads, signals, n, load)
            trial_increments(block, matrices, state, load, new, position)

            for i in range(n_contacts):
                first, last = spans[i, at.FIXED], spans[i, at.FIXED_END]
                gap = (
                    contacts[i, at.GAP]
                    + motion[n + 2, i, at.GAP_MOTION]
                    + along(rows, i, at.NORMAL, position, first, last)
                )
                place = (
                    contacts[i, at.START]
                    + motion[n + 2, i, at.TIP_MOTION]
                    + along(rows, i, at.TANGENTIAL, position, first, last)
                )
                material = place - motion[n + 2, i, at.TRACK_MOTION]
                bending, bending_end = spans[i, at.BENDING], spans[i, at.BENDING_END]
                if bending_end > bending:
                    low, high = contacts[i, at.LOW], contacts[i, at.HIGH]
                    if not low < place < high:
                        # A tip does not cross the whole track in one step: that is a march that diverges.
                        crossed = abs(place - carried[i, at.ABSCISSA]) < high - low
                        return sample, (at.OFF_TRACK if crossed else at.NOT_FINITE)
                    if spans[i, at.CROSS_WAVES] > 0:
                        set_products(contacts, spans, half_waves, shares, i, place, rows, waves, slopes)
                    else:
                        set_harmonics(contacts, spans, i, place, rows, waves, slopes)
                    gap += along(rows, i, at.NORMAL, position, bending, bending_end)
                    material += along(rows, i, at.TANGENTIAL, position, spans[i, at.AXIAL], spans[i, at.AXIAL_END])
                gaps[i], slips[i], places[i] = gap, material - carried[i, at.MATERIAL], place

            touching = opening = False
            for i in range(n_contacts):
                touching = touching or gaps[i] < 0.0
                opening = opening or int(carried[i, at.STATUS]) != SEPARATED
            if n_harmonic and (touching or opening):
                set_compliance(block, matrices, rows, work, w)
            if touching:
                for i in range(n_contacts):
                    forces[i, 0], forces[i, 1] = 0.0, 0.0
                made, error = solve_all(
                    gaps, slips, w, contacts, laws, carried, step, tolerance, sweeps, forces, statuses, jammed
                )
                most_sweeps = max(most_sweeps, made)
                unsolved += not error <= tolerance
                if not error <= UNBELIEVABLE:
                    for i in range(n_contacts):
                        carried[i, at.LAST_NORMAL], carried[i, at.LAST_TANGENTIAL] = forces[i, 0], forces[i, 1]
                        carried[i, at.STATUS] = statuses[i]
                    return sample, at.CONTACT_UNSOLVED
            else:
                for i in range(n_contacts):
                    forces[i, 0], forces[i, 1], statuses[i] = 0.0, 0.0, SEPARATED

            if touching:
                for k in range(n_modes):
                    push[k] = 0.0
                for i in range(n_contacts):
                    if statuses[i] != SEPARATED:
                        add_push(spans, rows, i, forces[i, 0], forces[i, 1], push)
                contact += correct(block, matrices, state, push, new)
            given, lost = work_of_loads_and_damping(block, matrices, state, load, new)
            drive += given
            damping += lost

            for i in range(n_contacts):
                normal, tangential = forces[i, 0], forces[i, 1]
                gap, slip, place = gaps[i], slips[i], places[i]
                if touching:
                    for j in range(n_contacts):
                        gap += displacement(w, 2 * i, j, forces)
                        slip += displacement(w, 2 * i + 1, j, forces)
                    place = contacts[i, at.START] + motion[n + 2, i, at.TIP_MOTION]
                    for k in range(spans[i, at.FIXED], spans[i, at.FIXED_END]):
                        place += rows[i, at.TANGENTIAL, k] * (state[at.Q, k] + new[k])
                before = carried[i, at.MATERIAL]
                material = before + slip
                status, was = statuses[i], int(carried[i, at.STATUS])
                closed = closed_before(carried, i, status, gap, w)
                sums[i, at.SEPARATED] += 1.0 - closed
                held = closed if was == STICKING else 0.0
                if was == STICKING and status == SLIDING and set_valued(int(contacts[i, at.LAW])):
                    own = own_compliance(w, i)
                    alone = gap - displacement(w, 2 * i, i, forces), slip - displacement(w, 2 * i + 1, i, forces)
                    last = carried[i, at.LAST_NORMAL], carried[i, at.LAST_TANGENTIAL]
                    held *= stuck_share(last[0], last[1], alone[0], alone[1] + strayed(carried, i), own, laws[i, 0])
                sums[i, at.STICKING] += held
                sums[i, at.SLIDING] += closed - held
                steps_in[i, status] += 1
                closed = 0.0
                if status != SEPARATED:
                    closed = 1.0
                    if was == SEPARATED:
                        sums[i, at.LANDINGS] += 1
                        closed = landed_share(carried[i, at.LAST_GAP], gap - displacement(w, 2 * i, i, forces))
                    if status == STICKING:
                        sums[i, at.JAMMED] += jammed[i]
                        if was != STICKING:
                            carried[i, at.ANCHOR] = before
                    tip = 0.5 * (motion[n + 2, i, at.TIP_MOTION] - motion[n, i, at.TIP_MOTION])
                    track = 0.5 * (motion[n + 2, i, at.TRACK_MOTION] - motion[n, i, at.TRACK_MOTION])
                    lift = 0.5 * (motion[n + 2, i, at.GAP_MOTION] - motion[n, i, at.GAP_MOTION])
                    driven = tangential * (tip - track) - normal * lift
                    contact -= driven
                    drive += driven
                    # In a step in which the slip turns round, its mean force and the slip have opposite signs.
                    given_back = not set_valued(int(contacts[i, at.LAW]))
                    friction += tangential * slip if given_back else abs(tangential * slip)
                    if spans[i, at.BENDING_END] > spans[i, at.BENDING]:
                        slope = convecting_force(spans, i, slopes, normal, tangential, state, new)
                        convection += slope * 0.5 * (place - carried[i, at.ABSCISSA_BEFORE])
                    sums[i, at.NORMAL_FORCE] += normal
                    sums[i, at.TANGENTIAL_FORCE] += tangential
                law = int(contacts[i, at.LAW])
                if not set_valued(law):
                    if status == SEPARATED:
                        carried[i, at.FRICTION_STATE] = laws[i, at.LAW_PARAMETERS - 1]
                    else:
                        slips_before = status, carried[i, at.LAST_SLIP], carried[i, at.EARLIER_SLIP]
                        velocity = velocity_at(slip, slips_before, step)
                        old = carried[i, at.FRICTION_STATE]
                        carried[i, at.FRICTION_STATE] = next_state(law, laws, i, old, velocity, step)
                carried[i, at.STATUS], carried[i, at.MATERIAL] = status, material
                carried[i, at.EARLIER_SLIP], carried[i, at.LAST_SLIP] = carried[i, at.LAST_SLIP], slip
                carried[i, at.LAST_GAP], carried[i, at.CLOSED_SHARE] = gap, closed
                carried[i, at.ABSCISSA_BEFORE], carried[i, at.ABSCISSA] = carried[i, at.ABSCISSA], place
                carried[i, at.LAST_NORMAL], carried[i, at.LAST_TANGENTIAL] = normal, tangential
                gaps[i] = gap

            keep_probes(probe_rows, probe_kinds, probe_direct, probe_shares, state, new, signals, n, forces, raw)
            for k in range(n_modes):
                state[at.D, k] = new[k]
                state[at.Q, k] += new[k]
            n += 1

        stored = stored_energy(block, matrices, state)
        if not math.isfinite(stored):
            return sample, at.NOT_FINITE
        energies[at.STORED], energies[at.DRIVE_WORK], energies[at.CONTACT_WORK] = stored, drive, contact
        energies[at.FRICTION_LOSS], energies[at.CONVECTION_WORK] = friction, convection
        energies[at.DAMPING_LOSS] = damping
        energies[at.ITERATIONS], energies[at.UNSOLVED] = most_sweeps, unsolved
        for k in range(at.ENERGIES):
            energy_record[sample, k] = energies[k]
        for i in range(n_contacts):
            for column in range(at.SLIDING + 1):
                record[sample, i, column] = sums[i, column] / steps_per_sample
            record[sample, i, at.CONTACT_POSITION] = carried[i, at.ABSCISSA]
            height = contacts[i, at.GAP] + motion[n + 1, i, at.GAP_MOTION]
            for k in range(spans[i, at.FIXED], spans[i, at.FIXED_END]):
                height += rows[i, at.NORMAL, k] * state[at.Q, k]
            record[sample, i, at.CONTACT_HEIGHT] = height
            record[sample, i, at.CONTACT_GAP] = gaps[i]
            record[sample, i, at.SLIP_VELOCITY] = (carried[i, at.MATERIAL] - first_material[i]) / (
                steps_per_sample * step
            )
            record[sample, i, at.JAMMED] = sums[i, at.JAMMED]
            record[sample, i, at.LANDINGS] = sums[i, at.LANDINGS]
            record[sample, i, at.LAW_STATE] = carried[i, at.FRICTION_STATE]
            # Of equal numbers of steps the later state wins.
            record[sample, i, at.DOMINANT] = 2 - np.argmax(steps_in[i, ::-1])
    return record.shape[0], at.FINISHED
