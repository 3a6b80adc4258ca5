"""Records: energies and contacts, a row a sample; probes, a row a step."""

import numba

from . import layout as at
from .block_rows import CONTACTS, D, Q
from .contact import SLIDING, STICKING
from .lanes import choose, held, hold, read, write
from .modes import OPTIONS, PASTED, product


@numba.njit(**OPTIONS)
def remember_probes(rows, first, kinds, spans, last, run, zero):
    """Save the values of the probes for the differences of the next step."""
    for i in range(kinds.size):
        seen = Q if kinds[i] == at.DISPLACEMENT else D
        hold(last, i, run, product(rows, first + i, seen, spans[i, 0], spans[i, 1], run, zero))


@numba.njit(**OPTIONS)
def keep_probes(rows, first, probes, imposed, now, count, n, run, runs, raw, zero):
    """Write the values of the probes at step `n`, which is complete, to a row of `raw`."""
    kinds, spans, direct, shares, last, passing = probes
    signals = imposed.signals
    for p in range(kinds.size):
        seen = Q if kinds[p] == at.DISPLACEMENT else D
        found = product(rows, first + p, seen, spans[p, 0], spans[p, 1], run, zero)
        value = held(last, p, run, zero)
        hold(last, p, run, found)
        passed, passes = held(passing, 2 * p, run, zero), held(passing, 2 * p + 1, run, zero)
        if kinds[p] == at.VELOCITY:
            value = (found + passes) + (value + passed)
        elif kinds[p] == at.ACCELERATION:
            value = (found + passes) - (value + passed)
        for i in range(count):
            here, share = i * at.IN_STEP, 2 * (p * count + i)
            value += held(shares, share, run, zero) * held(now, here + at.NORMAL_NOW, run, zero)
            value += held(shares, share + 1, run, zero) * held(now, here + at.TANGENTIAL_NOW, run, zero)
        for j in range(signals.shape[1] // runs):
            column = j * runs + run
            factor = read(signals, n if signals.shape[0] > 1 else 0, column, zero)
            value += read(direct, p, column, zero) * factor
        write(raw, n, p * runs + run, value)


@numba.njit(**OPTIONS)
def begin_sample(sums, carried, count, run, zero):
    """Begin the sums of a sample."""
    for i in range(count):
        for column in range(at.FIRST_MATERIAL):
            hold(sums, i * at.SUMS + column, run, zero)
        material = held(carried, i * at.CARRIED + at.MATERIAL, run, zero)
        hold(sums, i * at.SUMS + at.FIRST_MATERIAL, run, material)


@numba.njit(**OPTIONS)
def record_energies(energies, record, sample, run, runs, zero):
    """Write the energies to a row of their record."""
    for column in range(at.ENERGIES):
        write(record, sample, column * runs + run, held(energies, column, run, zero))


@numba.njit(**OPTIONS)
def record_contact(i, sums, carried, height, steps, step, record, sample, run, runs, zero):
    """Write contact `i` to a row of its record: means over the sample, and values at its end."""
    tally, base, share = i * at.SUMS, i * at.CARRIED, 1.0 / steps
    column = i * at.COLUMNS * runs + run
    sticking, sliding = held(sums, tally + at.STUCK, run, zero), held(sums, tally + at.SLID, run, zero)
    moved = held(carried, base + at.MATERIAL, run, zero) - held(sums, tally + at.FIRST_MATERIAL, run, zero)
    write(record, sample, at.NORMAL_FORCE * runs + column, held(sums, tally + at.NORMALS, run, zero) * share)
    write(record, sample, at.TANGENTIAL_FORCE * runs + column, held(sums, tally + at.TANGENTIALS, run, zero) * share)
    write(record, sample, at.SEPARATED * runs + column, (steps - sticking - sliding) * share)
    write(record, sample, at.STICKING * runs + column, sticking * share)
    write(record, sample, at.SLIDING * runs + column, sliding * share)
    write(record, sample, at.CONTACT_POSITION * runs + column, held(carried, base + at.ABSCISSA, run, zero))
    write(record, sample, at.CONTACT_HEIGHT * runs + column, height)
    write(record, sample, at.CONTACT_GAP * runs + column, held(carried, base + at.LAST_GAP, run, zero))
    write(record, sample, at.SLIP_VELOCITY * runs + column, moved * (share / step))
    write(record, sample, at.JAMMED * runs + column, held(sums, tally + at.JAMS, run, zero))
    write(record, sample, at.LANDINGS * runs + column, held(sums, tally + at.TOUCHDOWNS, run, zero))
    write(record, sample, at.LAW_STATE * runs + column, held(carried, base + at.FRICTION_STATE, run, zero))
    # With equal numbers of steps, the later state in the list is recorded.
    stuck, slid = held(sums, tally + at.STUCK_STEPS, run, zero), held(sums, tally + at.SLID_STEPS, run, zero)
    apart = steps - stuck - slid
    dominant = choose(stuck < apart, 0.0, zero + STICKING)
    most = choose(stuck < apart, apart, stuck)
    write(record, sample, at.DOMINANT * runs + column, choose(slid < most, dominant, zero + SLIDING))


@numba.njit(**OPTIONS)
def height_of(rows, i, spans, first, end, run, zero):
    """Return the displacement along the normal of the constant rows of contact `i`."""
    height = zero
    for s in range(first, end):
        if spans[s, at.KIND] == at.CONSTANT:
            height += product(rows, CONTACTS + 2 * i, Q, spans[s, at.BEGIN], spans[s, at.END], run, zero)
    return height


@numba.njit(**PASTED)
def keep_probes_at(parts, n, run, runs, zero):
    """Record the probes at step `n`, which is complete."""
    sizes = parts.sizes
    first, count = CONTACTS + 2 * sizes.contacts + 2 * sizes.loads, sizes.contacts
    raw, now = parts.records.raw, parts.contacts.now
    keep_probes(parts.modes.rows, first, parts.probes, parts.imposed, now, count, n, run, runs, raw, zero)
