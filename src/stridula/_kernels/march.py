"""The march of increments: recurrence, trial, contact, correction, ledger, record."""

import math

import numba
import numpy as np

from . import layout as at
from .contact import SEPARATED, STICKING, solve_contact
from .traces import FASTMATH, harmonics


@numba.njit(cache=True, fastmath=FASTMATH, nogil=True)
def stored_energy(block, state):
    """Return the energy half a step ago, ``[(1+b)/2 d² + r q[n] q[n-1]] / (2 c h)`` summed over the modes."""
    energy = 0.0
    for k in range(state.shape[1]):
        q, d = state[at.Q, k], state[at.D, k]
        energy += ((1.0 - block[at.HALF_LOSS, k]) * d * d + block[at.R, k] * q * (q - d)) * block[at.HALF_OVER_CH, k]
    return energy


@numba.njit(cache=True, fastmath=FASTMATH, nogil=True)
def march(
    steps_per_sample,
    sizes,
    constants,
    block,
    state,
    carried,
    loads,
    signals,
    imposed,
    probe_rows,
    probe_kinds,
    probe_direct,
    probe_contact,
    record,
    raw,
):
    """March through ``record.shape[0]`` samples and return (samples completed, what ended the march).

    `sizes` holds the numbers of slider, bending and axial modes. `loads` has a row of load increments for each of the
    first signals, `signals` a row of amplitudes a step, `imposed` the imposed displacement of the slider at
    every step and the one after. `state` and `carried` are updated in place; `record` gets a row a sample and `raw` the
    probes at every step.
    """
    n_slider, n_bending, n_axial = sizes[0], sizes[1], sizes[2]
    n_track = n_slider + n_bending
    n_modes = n_track + n_axial
    step, start, gap0 = constants[at.STEP], constants[at.START], constants[at.GAP]
    wavenumber, amplitude, length = constants[at.WAVENUMBER], constants[at.AMPLITUDE], constants[at.LENGTH]
    mu = constants[at.MU]
    amplitude2 = amplitude * amplitude

    sines = np.empty(max(n_bending, n_axial))
    cosines = np.empty_like(sines)
    load = np.zeros(n_modes)
    new = np.empty(n_modes)
    steady = loads.shape[0] == 0

    material, anchor = carried[at.MATERIAL], carried[at.ANCHOR]
    status = int(carried[at.STATUS])
    abscissa, abscissa_before = carried[at.ABSCISSA], carried[at.ABSCISSA_BEFORE]
    drive, contact = carried[at.DRIVE], carried[at.CONTACT]
    friction, convection, damping = carried[at.FRICTION], carried[at.CONVECTION], carried[at.DAMPING]

    n = 0
    for sample in range(record.shape[0]):
        sum_normal = sum_tangential = 0.0
        share_separated = share_sticking = share_sliding = jams = 0
        first_material = material
        height = gap = 0.0
        for _ in range(steps_per_sample):
            if not steady:
                if loads.shape[0] == 1:
                    factor = signals[n, 0]
                    for k in range(n_modes):
                        load[k] = factor * loads[0, k]
                else:
                    for k in range(n_modes):
                        load[k] = 0.0
                    for j in range(loads.shape[0]):
                        factor = signals[n, j]
                        for k in range(n_modes):
                            load[k] += factor * loads[j, k]

            # Trial: the state at n + 1 without contact force.
            tip_x = tip_y = 0.0
            for k in range(n_slider):
                increment = block[at.B, k] * state[at.D, k] - block[at.R, k] * state[at.Q, k] + load[k]
                new[k] = increment
                position = state[at.Q, k] + increment
                tip_x += block[at.TIP_X, k] * position
                tip_y += block[at.TIP_Y, k] * position
            for k in range(n_slider, n_modes):
                new[k] = block[at.B, k] * state[at.D, k] - block[at.R, k] * state[at.Q, k] + load[k]

            trial = start + imposed[n + 1] + tip_x
            if not 0.0 < trial < length:
                # A tip does not cross the whole track in one step: that is a march that diverges.
                return sample, (at.OFF_TRACK if abs(trial - abscissa) < length else at.NOT_FINITE)
            harmonics(wavenumber * trial, sines, cosines)
            bend = w_bending = 0.0
            for k in range(n_bending):
                j = n_slider + k
                bend += sines[k] * (state[at.Q, j] + new[j])
                w_bending += sines[k] * sines[k] * block[at.CH, j]
            stretch = w_axial = 0.0
            for k in range(n_axial):
                j = n_track + k
                stretch += sines[k] * (state[at.Q, j] + new[j])
                w_axial += sines[k] * sines[k] * block[at.CH, j]

            gap = gap0 + tip_y - amplitude * bend
            material_trial = trial - amplitude * stretch
            w_nn = constants[at.W_NN] + amplitude2 * w_bending
            w_nt = constants[at.W_NT]
            w_tt = constants[at.W_TT] + amplitude2 * w_axial
            target = anchor if status == STICKING else material
            before = material
            was_sticking = status == STICKING
            normal, tangential, status, jammed = solve_contact(gap, material_trial - target, w_nn, w_nt, w_tt, mu)

            material = material_trial + w_nt * normal - w_tt * tangential
            if status == STICKING and not was_sticking:
                anchor = before
            gap += w_nn * normal - w_nt * tangential
            height = gap0 + tip_y + constants[at.W_NN] * normal - w_nt * tangential
            abscissa_new = trial + w_nt * normal - constants[at.W_TT] * tangential

            # Correction by the contact force, ledger.
            given = lost = 0.0
            if status == SEPARATED:
                share_separated += 1
                for k in range(n_modes):
                    both = new[k] + state[at.D, k]
                    given += load[k] * both * block[at.HALF_OVER_CH, k]
                    lost += block[at.HALF_LOSS, k] * both * both * block[at.HALF_OVER_CH, k]
            else:
                if status == STICKING:
                    share_sticking += 1
                    if jammed:
                        jams += 1
                else:
                    share_sliding += 1
                exchanged = 0.0
                for k in range(n_slider):
                    push = block[at.TIP_Y, k] * normal - block[at.TIP_X, k] * tangential
                    new[k] += block[at.CH, k] * push
                    both = new[k] + state[at.D, k]
                    exchanged += push * both
                    given += load[k] * both * block[at.HALF_OVER_CH, k]
                    lost += block[at.HALF_LOSS, k] * both * both * block[at.HALF_OVER_CH, k]
                bend_slope = stretch_slope = 0.0
                for k in range(n_bending):
                    j = n_slider + k
                    push = -amplitude * sines[k] * normal
                    new[j] += block[at.CH, j] * push
                    both = new[j] + state[at.D, j]
                    exchanged += push * both
                    given += load[j] * both * block[at.HALF_OVER_CH, j]
                    lost += block[at.HALF_LOSS, j] * both * both * block[at.HALF_OVER_CH, j]
                    bend_slope += (k + 1) * cosines[k] * (state[at.Q, j] + new[j])
                for k in range(n_axial):
                    j = n_track + k
                    push = amplitude * sines[k] * tangential
                    new[j] += block[at.CH, j] * push
                    both = new[j] + state[at.D, j]
                    exchanged += push * both
                    given += load[j] * both * block[at.HALF_OVER_CH, j]
                    lost += block[at.HALF_LOSS, j] * both * both * block[at.HALF_OVER_CH, j]
                    stretch_slope += (k + 1) * cosines[k] * (state[at.Q, j] + new[j])
                driven = tangential * (imposed[n + 1] - imposed[n])
                slope = wavenumber * amplitude * (normal * bend_slope - tangential * stretch_slope)
                contact += 0.5 * exchanged - driven
                drive += driven
                friction += tangential * (material - before)
                convection += slope * 0.5 * (abscissa_new - abscissa_before)
                sum_normal += normal
                sum_tangential += tangential
            drive += given
            damping += lost

            for p in range(probe_rows.shape[0]):
                value = probe_contact[p, 0] * normal + probe_contact[p, 1] * tangential
                for j in range(signals.shape[1]):
                    value += probe_direct[p, j] * signals[n, j]
                for kind in range(3):
                    first, last = probe_kinds[p, kind, 0], probe_kinds[p, kind, 1]
                    if kind == at.DISPLACEMENT:
                        for k in range(first, last):
                            value += probe_rows[p, kind, k] * state[at.Q, k]
                    elif kind == at.VELOCITY:
                        for k in range(first, last):
                            value += probe_rows[p, kind, k] * (new[k] + state[at.D, k])
                    else:
                        for k in range(first, last):
                            value += probe_rows[p, kind, k] * (new[k] - state[at.D, k])
                raw[n, p] = value

            for k in range(n_modes):
                state[at.D, k] = new[k]
                state[at.Q, k] += new[k]
            abscissa_before, abscissa = abscissa, abscissa_new
            n += 1

        stored = stored_energy(block, state)
        if not math.isfinite(stored):
            return sample, at.NOT_FINITE
        record[sample, at.NORMAL_FORCE] = sum_normal / steps_per_sample
        record[sample, at.TANGENTIAL_FORCE] = sum_tangential / steps_per_sample
        record[sample, at.SEPARATED] = share_separated / steps_per_sample
        record[sample, at.STICKING] = share_sticking / steps_per_sample
        record[sample, at.SLIDING] = share_sliding / steps_per_sample
        record[sample, at.CONTACT_POSITION] = abscissa
        record[sample, at.CONTACT_HEIGHT] = height
        record[sample, at.CONTACT_GAP] = gap
        record[sample, at.SLIP] = (material - first_material) / (steps_per_sample * step)
        record[sample, at.JAMMED] = jams
        record[sample, at.STORED] = stored
        record[sample, at.DRIVE_WORK] = drive
        record[sample, at.CONTACT_WORK] = contact
        record[sample, at.FRICTION_LOSS] = friction
        record[sample, at.CONVECTION_WORK] = convection
        record[sample, at.DAMPING_LOSS] = damping
        carried[at.MATERIAL], carried[at.ANCHOR], carried[at.STATUS] = material, anchor, status
        carried[at.ABSCISSA], carried[at.ABSCISSA_BEFORE] = abscissa, abscissa_before
        carried[at.DRIVE], carried[at.CONTACT] = drive, contact
        carried[at.FRICTION], carried[at.CONVECTION], carried[at.DAMPING] = friction, convection, damping
    return record.shape[0], at.FINISHED
