"""Time integration of one run, or of several side by side, with any number of contacts.

Steps 1 to 6 in docstrings and comments of this package are those of *Contact in one step* in `docs/model.rst`.
"""

import math

from .books.bookkeeping import credit, stored_in_contacts
from .books.leaving import end, leave
from .books.recording import (
    begin_sample,
    height_of,
    keep_probes,
    record_along_b,
    record_contact,
    record_energies,
    remember_probes,
)
from .contacts.heating import set_laws
from .lanes.compiled import entry, pasted
from .lanes.operations import INTEGER, TRUTH, Runs, anywhere, choose, everywhere, held, hold, magnitude, placed
from .layout import columns as at
from .layout.contact_values import Compliance, Touch, Tried, Way
from .layout.parts import Parts
from .layout.rows import SINE, first_probe
from .modes.coupled import energy_of
from .modes.loads import change_loads, credit_loads, differ
from .modes.springs import credit_springs
from .modes.turning import credit_turning, turn_bodies
from .several import keep_many, touch_many
from .single import keep_one, touch_one
from .trying import complete_one, gap_of


@pasted
def begin(parts: Parts, runs: Runs) -> None:
    """Save the initial values of the probes, and let laws act at the temperatures at the start."""
    probes = parts.probes
    if parts.sizes.layers:
        set_laws(parts, runs)
    remember_probes(parts.modes.rows, first_probe(parts.sizes), probes.kinds, probes.spans, probes.last, runs)


@pasted
def begin_row(space: bool | None, parts: Parts, runs: Runs) -> None:
    """Begin the sums of a sample."""
    begin_sample(space, parts.contacts.sums, parts.state.carried, parts.sizes.contacts, runs)
    hold(parts.state.energies, at.ITERATIONS, runs, runs.zero)
    hold(parts.state.energies, at.UNSOLVED, runs, runs.zero)


@pasted
def record_row(space: bool | None, parts: Parts, sample: int, n: int, runs: Runs) -> None:
    """Record energies and contacts after the steps of a sample."""
    contacts, paths, state = parts.contacts, parts.paths, parts.state
    record_energies(state.energies, parts.records.energies, sample, runs)
    after = n + 1 if parts.imposed.motion.shape[0] > 1 else 0
    for i in range(parts.sizes.contacts):
        height = gap_of(i, contacts.constants, parts.imposed.motion, after, runs)
        spans, normal = paths.spans, contacts.rows[i]
        height += height_of(parts.modes.rows, normal, spans, paths.first_span[i], paths.first_span[i + 1], runs)
        record_contact(i, height, parts, sample, runs)
        if space is not None:
            record_along_b(i, parts, sample, runs)


@entry
def march(single: bool | None, several: bool | None, space: bool | None, place: tuple[int, int], parts: Parts) -> None:
    """March through the samples of the records, or until all runs have ended.

    Quantities of a run have a column for each run; several numbers of a kind have groups of columns. The runs that
    march together follow from `place`, as in `lanes.placed`. `several` is None for a single contact between bodies of
    uncoupled modes that do not turn, else `single` is None; `space` is None where no body turns and every contact has
    one tangent. Only the steps of one kind are compiled.
    """
    runs = placed(place)
    zero = runs.zero
    sizes, timing, signals = parts.sizes, parts.timing, parts.imposed.signals
    begin(parts, runs)
    ended, completed = zero, zero
    touch = Touch(zero, zero, zero, zero, Way(zero, zero, zero))
    tried = Tried(zero, zero, zero, Compliance(zero, zero, zero, zero))
    n, pending, sine, advance = INTEGER(0), TRUTH(False), INTEGER(SINE), zero
    for sample in range(parts.records.energies.shape[0]):
        begin_row(space, parts, runs)
        for i in range(timing.steps_per_sample):
            change_loads(parts, n, runs)
            if single is not None:
                loop = (touch, pending, sine, advance)
                tried, touch, leaves, why = touch_one(parts, n, loop, ended, runs)
                sine = 2 - sine
            if several is not None:
                if space is not None:
                    turn_bodies(parts, n, runs)
                leaves, why = touch_many(space, parts, n, ended, runs)
            if anywhere(leaves > 0.5):
                ended, completed = leave(ended, completed, leaves, why, sample, parts.state, runs)
                if everywhere(ended > 0.0):
                    break
            if single is not None:
                advance = keep_one(parts, n, tried, touch, runs)
                following = i + 1 < timing.steps_per_sample
                pending = following and not differ(signals, n + 1, sizes.loads, runs)
                if not pending:
                    done = complete_one(parts.modes, parts.paths, touch, sine, runs)
                    credit(parts.state.energies, done.work, done.lost, done.slope * advance, runs)
            if several is not None:
                keep_many(space, parts, n, runs)
                if space is not None:
                    credit_turning(parts, runs)
            if not pending:
                keep_probes(space, parts, n, runs)
            n += 1
        if everywhere(ended > 0.0):
            break
        credit_loads(parts, n, runs)
        if several is not None:
            credit_springs(parts, n, runs)
        stored = energy_of(parts.modes, sizes, runs) + held(parts.state.energies, at.STORED_IN_SPRINGS, runs)
        stored += stored_in_contacts(parts.contacts, parts.state.carried, sizes.contacts, runs)
        hold(parts.state.energies, at.STORED, runs, stored)
        finite = choose(ended > 0.0, zero, magnitude(stored)) < math.inf
        if not everywhere(finite):
            leaves, why = choose(finite, zero, 1.0), zero + at.NOT_FINITE
            ended, completed = leave(ended, completed, leaves, why, sample, parts.state, runs)
            if everywhere(ended > 0.0):
                break
        record_row(space, parts, sample, n, runs)
    end(parts, ended, completed, runs)
