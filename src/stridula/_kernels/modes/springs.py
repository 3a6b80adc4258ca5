"""Nonlinear springs and dashpots: their pull beyond their linear part, as a load that depends on the motion."""

from ..lanes.compiled import inlined, pasted
from ..lanes.operations import Array, Number, Pair, Runs, add, choose, fused, held, hold, load, spread, total
from ..layout import columns as at
from ..layout.parts import Parts
from ..layout.rows import D, Q, first_spring
from .blocks import set_load

# Stiffness times the sawtooth of a unit force from which a step is too long: a vibration turns by half a radian in it.
STIFF = 1.0 / 16.0


@inlined
def stretch_of(rows: Array, row: int, blocks: int, runs: Runs) -> Pair:
    """Return the stretch of a spring, and its last increment."""
    stretch, increment = spread(0.0), spread(0.0)
    for k in range(blocks):
        trace = load(rows, k, row, runs)
        stretch = fused(trace, load(rows, k, Q, runs), stretch)
        increment = fused(trace, load(rows, k, D, runs), increment)
    return total(stretch, runs.zero), total(increment, runs.zero)


@inlined
def pull_at(numbers: Array, first: int, kinks: int, stretch: Number, runs: Runs) -> Pair:
    """Return the pull of a spring beyond its linear part, and its stiffness there."""
    linear, curved = held(numbers, first + at.LINEAR, runs), held(numbers, first + at.CUBIC, runs) * stretch * stretch
    pull = fused(linear + curved, stretch, held(numbers, first + at.CONSTANT_PULL, runs))
    stiffness = linear + 3.0 * curved
    for kink in range(first + at.OF_SPRING, first + at.OF_SPRING + at.OF_KINK * kinks, at.OF_KINK):
        beyond = stretch - held(numbers, kink, runs)
        change = choose(beyond > 0.0, held(numbers, kink + 1, runs), held(numbers, kink + 2, runs))
        pull = fused(change, beyond, pull)
        stiffness += change
    return pull, stiffness


@inlined
def credit_spring(k: int, parts: Parts, n: int, middle: Number, runs: Runs) -> None:
    """Add the work against the pull of a spring up to step `n`, whose stretch half a step ago was `middle`."""
    now, here = parts.springs.now, k * at.SPRING_STATE
    if n > 0:
        pull, moved = held(now, here + at.PULL, runs), middle - held(now, here + at.STRETCH, runs)
        work = pull * moved
        # The pull of a dashpot at rest is a constant force, whose work is stored.
        constant = held(parts.springs.numbers, first_number(k, parts) + at.CONSTANT_PULL, runs)
        lost = choose(per_rate(k, parts, runs) > 0.0, (pull - constant) * moved, runs.zero)
        add(parts.state.energies, at.STORED_IN_SPRINGS, runs, work - lost)
        add(parts.state.energies, at.DAMPING_LOSS, runs, lost)
    hold(now, here + at.STRETCH, runs, middle)


@inlined
def per_rate(k: int, parts: Parts, runs: Runs) -> Number:
    """Return 1 over twice the step where spring `k` is a dashpot, else 0."""
    return held(parts.springs.numbers, first_number(k, parts) + at.PER_RATE, runs)


@inlined
def first_number(k: int, parts: Parts) -> int:
    """Return the first of the numbers of spring `k`."""
    return k * (at.OF_SPRING + at.OF_KINK * parts.sizes.kinks)


@pasted
def credit_springs(parts: Parts, n: int, runs: Runs) -> None:
    """Add the work against the pulls of the springs up to step `n`."""
    sizes, rows = parts.sizes, parts.modes.rows
    for k in range(sizes.springs):
        stretch, increment = stretch_of(rows, first_spring(sizes) + sizes.springs + k, sizes.blocks, runs)
        credit_spring(k, parts, n, stretch - 0.5 * increment, runs)


@pasted
def pull_springs(parts: Parts, n: int, runs: Runs) -> Number:
    """Add the pulls of the springs to the loads of step `n`; return where the step is too long for one of them."""
    sizes, modes, numbers = parts.sizes, parts.modes, parts.springs.numbers
    pulls = first_spring(sizes)
    too_stiff = runs.zero
    for k in range(sizes.springs):
        stretch, increment = stretch_of(modes.rows, pulls + sizes.springs + k, sizes.blocks, runs)
        credit_spring(k, parts, n, stretch - 0.5 * increment, runs)
        first, here = first_number(k, parts), k * at.SPRING_STATE
        # The velocity now follows from the last two increments, to second order.
        rate, before = per_rate(k, parts, runs), held(parts.springs.now, here + at.EARLIER_INCREMENT, runs)
        moved = choose(rate > 0.0, rate * (3.0 * increment - before), stretch)
        hold(parts.springs.now, here + at.EARLIER_INCREMENT, runs, increment)
        pull, stiffness = pull_at(numbers, first, sizes.kinks, moved, runs)
        hold(parts.springs.now, here + at.PULL, runs, pull)
        set_load(modes.rows, sizes.loads + k, pulls + k, sizes.blocks, runs, -pull)
        stiff = choose(stiffness * held(numbers, first + at.SPRING_REACH, runs) > STIFF, 1.0, runs.zero)
        too_stiff = choose(stiff > 0.5, stiff, too_stiff)
    return too_stiff
