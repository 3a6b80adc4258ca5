"""Records: energies and contacts, a row a sample; probes, a row a step."""

from ..contact.exact import SLIDING, STICKING
from ..lanes.compiled import inlined, pasted
from ..lanes.operations import Array, Number, Runs, choose, held, hold, read, write
from ..layout import columns as at
from ..layout.parts import Parts
from ..layout.rows import CONTACTS, D, Q, first_probe, has_b
from ..modes.blocks import product


@inlined
def remember_probes(rows: Array, first: int, kinds: Array, spans: Array, last: Array, runs: Runs) -> None:
    """Save the values of the probes for the differences of the next step."""
    for i in range(kinds.size):
        seen = Q if kinds[i] == at.DISPLACEMENT else D
        hold(last, i, runs, product(rows, first + i, seen, spans[i, 0], spans[i, 1], runs))


@pasted
def keep_probes(space: bool | None, parts: Parts, n: int, runs: Runs) -> None:
    """Record the values of the probes at step `n`, which is complete."""
    sizes, rows, now = parts.sizes, parts.modes.rows, parts.contacts.now
    kinds, spans, direct, shares, last, passing = parts.probes
    first, signals, of_contacts = first_probe(sizes), parts.imposed.signals, parts.contacts.rows
    for p in range(kinds.size):
        seen = Q if kinds[p] == at.DISPLACEMENT else D
        found = product(rows, first + p, seen, spans[p, 0], spans[p, 1], runs)
        value = held(last, p, runs)
        hold(last, p, runs, found)
        passed, passes = held(passing, 2 * p, runs), held(passing, 2 * p + 1, runs)
        if kinds[p] == at.VELOCITY:
            value = (found + passes) + (value + passed)
        elif kinds[p] == at.ACCELERATION:
            value = (found + passes) - (value + passed)
        for i in range(sizes.contacts):
            here, share = i * at.IN_STEP, p * sizes.rows + of_contacts[i]
            value += held(shares, share, runs) * held(now, here + at.NORMAL_NOW, runs)
            value += held(shares, share + 1, runs) * held(now, here + at.TANGENTIAL_NOW, runs)
            if space is not None and has_b(of_contacts, i):
                value += held(shares, share + 2, runs) * held(now, here + at.TANGENTIAL_NOW_B, runs)
        for j in range(signals.shape[1] // runs.columns):
            column = j * runs.columns + runs.first
            factor = read(signals, n if signals.shape[0] > 1 else 0, column, runs.zero)
            value += read(direct, p, column, runs.zero) * factor
        write(parts.records.raw, n, p * runs.columns + runs.first, value)


@inlined
def begin_sample(space: bool | None, sums: Array, carried: Array, count: int, runs: Runs) -> None:
    """Begin the sums of a sample."""
    for i in range(count):
        for column in range(at.FIRST_MATERIAL):
            hold(sums, i * at.SUMS + column, runs, runs.zero)
        material = held(carried, i * at.CARRIED + at.MATERIAL, runs)
        hold(sums, i * at.SUMS + at.FIRST_MATERIAL, runs, material)
        if space is not None:
            hold(sums, i * at.SUMS + at.TANGENTIALS_B, runs, runs.zero)
            material = held(carried, i * at.CARRIED + at.MATERIAL_B, runs)
            hold(sums, i * at.SUMS + at.FIRST_MATERIAL_B, runs, material)


@inlined
def record_energies(energies: Array, record: Array, sample: int, runs: Runs) -> None:
    """Write the energies to a row of their record."""
    for column in range(at.ENERGIES):
        write(record, sample, column * runs.columns + runs.first, held(energies, column, runs))


@inlined
def record_contact(i: int, height: Number, parts: Parts, sample: int, runs: Runs) -> None:
    """Write contact `i` to a row of its record: means over the sample, and values at its end."""
    sums, carried, record = parts.contacts.sums, parts.state.carried, parts.records.contacts
    steps, step = parts.timing.steps_per_sample, parts.timing.step
    tally, base, share = i * at.SUMS, i * at.CARRIED, 1.0 / steps
    column = i * at.COLUMNS * runs.columns + runs.first
    sticking, sliding = held(sums, tally + at.STUCK, runs), held(sums, tally + at.SLID, runs)
    moved = held(carried, base + at.MATERIAL, runs) - held(sums, tally + at.FIRST_MATERIAL, runs)
    write(record, sample, at.NORMAL_FORCE * runs.columns + column, held(sums, tally + at.NORMALS, runs) * share)
    write(record, sample, at.TANGENTIAL_FORCE * runs.columns + column, held(sums, tally + at.TANGENTIALS, runs) * share)
    write(record, sample, at.SEPARATED * runs.columns + column, (steps - sticking - sliding) * share)
    write(record, sample, at.STICKING * runs.columns + column, sticking * share)
    write(record, sample, at.SLIDING * runs.columns + column, sliding * share)
    write(record, sample, at.CONTACT_POSITION * runs.columns + column, held(carried, base + at.ABSCISSA, runs))
    write(record, sample, at.CONTACT_HEIGHT * runs.columns + column, height)
    write(record, sample, at.CONTACT_GAP * runs.columns + column, held(carried, base + at.LAST_GAP, runs))
    write(record, sample, at.SLIP_VELOCITY * runs.columns + column, moved * (share / step))
    write(record, sample, at.JAMMED * runs.columns + column, held(sums, tally + at.JAMS, runs))
    write(record, sample, at.LANDINGS * runs.columns + column, held(sums, tally + at.TOUCHDOWNS, runs))
    write(record, sample, at.LAW_STATE * runs.columns + column, held(carried, base + at.FRICTION_STATE, runs))
    write(record, sample, at.HOT * runs.columns + column, held(carried, base + at.TEMPERATURE, runs))
    # With equal numbers of steps, the later state in the list is recorded.
    stuck, slid = held(sums, tally + at.STUCK_STEPS, runs), held(sums, tally + at.SLID_STEPS, runs)
    apart = steps - stuck - slid
    dominant = choose(stuck < apart, 0.0, runs.zero + STICKING)
    most = choose(stuck < apart, apart, stuck)
    write(record, sample, at.DOMINANT * runs.columns + column, choose(slid < most, dominant, runs.zero + SLIDING))


@inlined
def record_along_b(i: int, parts: Parts, sample: int, runs: Runs) -> None:
    """Write what a contact has along tangent b to its record."""
    sums, carried, record = parts.contacts.sums, parts.state.carried, parts.records.contacts
    step, tally, base, share = parts.timing.step, i * at.SUMS, i * at.CARRIED, 1.0 / parts.timing.steps_per_sample
    column = i * at.COLUMNS * runs.columns + runs.first
    moved = held(carried, base + at.MATERIAL_B, runs) - held(sums, tally + at.FIRST_MATERIAL_B, runs)
    pulled = held(sums, tally + at.TANGENTIALS_B, runs) * share
    write(record, sample, at.TANGENTIAL_FORCE_B * runs.columns + column, pulled)
    place = held(carried, base + at.ABSCISSA_B, runs)
    write(record, sample, at.CONTACT_POSITION_B * runs.columns + column, place)
    write(record, sample, at.SLIP_VELOCITY_B * runs.columns + column, moved * (share / step))
    write(record, sample, at.LAW_STATE_B * runs.columns + column, held(carried, base + at.FRICTION_STATE_B, runs))


@inlined
def height_of(rows: Array, normal: int, spans: Array, first: int, end: int, runs: Runs) -> Number:
    """Return the displacement of the constant rows of a contact along the row of its normal."""
    height = runs.zero
    for s in range(first, end):
        if spans[s, at.KIND] == at.CONSTANT:
            height += product(rows, CONTACTS + normal, Q, spans[s, at.BEGIN], spans[s, at.END], runs)
    return height
