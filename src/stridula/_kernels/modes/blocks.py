"""March of the modes, block by block.

A block is as wide as a vector: eight modes of one run, filled up with zeros, or one mode of eight runs. All rows of a
block are adjacent in memory. States are scaled by the root of the mobility, ``q / sqrt(l)``, and so are loads and
rows: a unit force adds its row to the increment, and the energy half a step ago is
``[(1 + b) / 2 d² + r q[n] q[n-1]] / 2``.

One contact between bodies of uncoupled modes: a step is completed under its forces (step 6) together with the trial of
the next one (step 1), so that the modes are read once a step (`pass_fixed`, `pass_waves`). Any number of contacts: a
step is tried, the displacements of all contacts are summed, and the step is completed under the push of all.
"""

from typing import NamedTuple

from ..lanes.compiled import inlined
from ..lanes.operations import Array, Numbers, Pair, Runs, entry, fused, load, spread, store, total
from ..layout import columns as at
from ..layout.parts import Modes, Paths
from ..layout.rows import (
    AMPLITUDE,
    FIRST,
    FORCE,
    INCREMENT,
    KEPT,
    NORMAL,
    OTHER_AMPLITUDE,
    OTHER_SLOPE,
    POSITION,
    PUSH,
    SLOPE,
    STIFFNESS,
    TANGENTIAL,
    ZEROTH,
    D,
    Q,
)


@inlined
def block_at(rows: Array, k: int, runs: Runs) -> Numbers:
    """Return position, last increment, share kept, stiffness and load of a block."""
    return (
        load(rows, k, Q, runs),
        load(rows, k, D, runs),
        load(rows, k, KEPT, runs),
        load(rows, k, STIFFNESS, runs),
        load(rows, k, FORCE, runs),
    )


@inlined
def complete(rows: Array, k: int, runs: Runs, q: float, d: float, increment: float) -> Pair:
    """Complete the step of a block by an increment (step 6); return the position and the sum of both increments."""
    q = q + increment
    store(rows, k, Q, runs, q)
    store(rows, k, D, runs, increment)
    return q, increment + d


@inlined
def pass_fixed(
    rows: Array, begin: int, end: int, runs: Runs, pending: bool, normal: float, tangential: float
) -> Numbers:
    """Complete a pending step of modes with constant rows (step 6) and try the next (step 1).

    Returns
    -------
    along, across, works, losses : vector
        Trial displacements of the contact along tangent and normal; twice the work of the contact in the step
        completed, four times the loss to damping.
    """
    along, across, works, losses = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for k in range(begin, end):
        q, d, kept, stiffness, force = block_at(rows, k, runs)
        upright, level = load(rows, k, NORMAL, runs), load(rows, k, TANGENTIAL, runs)
        if pending:
            push = fused(upright, normal, -level * tangential)
            increment = fused(kept, d, fused(-stiffness, q, force + push))
            q, both = complete(rows, k, runs, q, d, increment)
            d = increment
            works = fused(push, both, works)
            losses = fused((1.0 - kept) * both, both, losses)
        position = q + fused(kept, d, fused(-stiffness, q, force))
        along = fused(level, position, along)
        across = fused(upright, position, across)
    return along, across, works, losses


class WavesOfBlock(NamedTuple):
    """Waves of a block of modes on a path: block of those along it, entry of that across it, and their kinds."""

    along: int
    across: int
    products: int
    cosines: int


@inlined
def trace_of(rows: Array, k: int, waves: Array, of_block: WavesOfBlock, sine: int, runs: Runs) -> float:
    """Return the displacement of a path for a unit of the modes in block `k`, by the waves in rows from `sine` on."""
    here, number, products, cosines = of_block
    if not products:
        return load(rows, k, AMPLITUDE, runs) * load(waves, here, sine + cosines, runs)
    trace = (load(rows, k, AMPLITUDE, runs) * load(waves, here, sine + 1 - cosines, runs)) * entry(
        waves, number, sine, runs
    )
    if products > 1:
        other = load(rows, k, OTHER_AMPLITUDE, runs) * load(waves, here, sine + cosines, runs)
        trace = fused(other, entry(waves, number, sine + 1, runs), trace)
    return trace


@inlined
def slope_of(rows: Array, k: int, waves: Array, of_block: WavesOfBlock, sine: int, runs: Runs) -> float:
    """Return the derivative along a path of `trace_of`."""
    here, number, products, cosines = of_block
    if not products:
        return load(rows, k, SLOPE, runs) * load(waves, here, sine + 1 - cosines, runs)
    slope = (load(rows, k, SLOPE, runs) * load(waves, here, sine + cosines, runs)) * entry(waves, number, sine, runs)
    other = load(rows, k, OTHER_SLOPE, runs) * load(waves, here, sine + 1 - cosines, runs)
    return fused(other, entry(waves, number, sine + 1, runs), slope)


@inlined
def pass_waves(
    modes: Modes, paths: Paths, s: int, runs: Runs, pending: bool, pull: float, last: int, now: int
) -> Numbers:
    """Complete a pending step of the modes of span `s` under a force (step 6), and try the next (steps 1 to 4).

    `last` and `now` are the first rows of the waves at the contact in the step completed and in the next.

    Returns
    -------
    trace, softness, slopes, works, losses : vector
        Trial displacement of the path at the contact, displacement for a unit force, slope of the path there after the
        step completed; works and losses of that step as in `pass_fixed`.
    """
    rows, waves, spans = modes.rows, paths.waves, paths.spans
    products, cosines = spans[s, at.PRODUCTS], spans[s, at.COSINES]
    trace, softness, slopes = spread(0.0), spread(0.0), spread(0.0)
    works, losses = spread(0.0), spread(0.0)
    for k in range(spans[s, at.BEGIN], spans[s, at.END]):
        q, d, kept, stiffness, force = block_at(rows, k, runs)
        of_block = WavesOfBlock(paths.wave_of[k], paths.sets[0, ZEROTH] + paths.across_of[k], products, cosines)
        row = trace_of(rows, k, waves, of_block, now, runs)
        if pending:
            push = pull * trace_of(rows, k, waves, of_block, last, runs)
            increment = fused(kept, d, fused(-stiffness, q, force + push))
            q, both = complete(rows, k, runs, q, d, increment)
            d = increment
            works = fused(push, both, works)
            losses = fused((1.0 - kept) * both, both, losses)
            slope = slope_of(rows, k, waves, of_block, last, runs)
            slopes = fused(slope, q, slopes)
        trace = fused(row, q + fused(kept, d, fused(-stiffness, q, force)), trace)
        softness = fused(row, row, softness)
    return trace, softness, slopes, works, losses


@inlined
def try_all(rows: Array, begin: int, end: int, runs: Runs) -> None:
    """Set increment and position at the end of the step without contact force in uncoupled modes (step 1)."""
    for k in range(begin, end):
        q, d, kept, stiffness, force = block_at(rows, k, runs)
        increment = fused(kept, d, fused(-stiffness, q, force))
        store(rows, k, INCREMENT, runs, increment)
        store(rows, k, POSITION, runs, q + increment)


@inlined
def set_path_rows(rows: Array, paths: Paths, i: int, s: int, row: int, sine: int, runs: Runs) -> None:
    """Set the row of contact `i` in span `s` to minus the trace of its path (step 2)."""
    spans, first, zeroth = paths.spans, paths.sets[i, FIRST], paths.sets[i, ZEROTH]
    products, cosines = spans[s, at.PRODUCTS], spans[s, at.COSINES]
    for k in range(spans[s, at.BEGIN], spans[s, at.END]):
        of_block = WavesOfBlock(first + paths.wave_of[k], zeroth + paths.across_of[k], products, cosines)
        store(rows, k, row, runs, -trace_of(rows, k, paths.waves, of_block, sine, runs))


@inlined
def slope_along(rows: Array, paths: Paths, i: int, s: int, sine: int, runs: Runs) -> float:
    """Return the derivative of a path's displacement along it at contact `i`, by the modes of span `s`."""
    spans, first, zeroth = paths.spans, paths.sets[i, FIRST], paths.sets[i, ZEROTH]
    products, cosines = spans[s, at.PRODUCTS], spans[s, at.COSINES]
    slopes = spread(0.0)
    for k in range(spans[s, at.BEGIN], spans[s, at.END]):
        of_block = WavesOfBlock(first + paths.wave_of[k], zeroth + paths.across_of[k], products, cosines)
        slope = slope_of(rows, k, paths.waves, of_block, sine, runs)
        slopes = fused(slope, load(rows, k, Q, runs), slopes)
    return total(slopes, runs.zero)


@inlined
def clear_push(rows: Array, blocks: int, runs: Runs) -> None:
    """Set the push on the modes to zero."""
    for k in range(blocks):
        store(rows, k, PUSH, runs, spread(0.0))


@inlined
def add_push(rows: Array, row: int, begin: int, end: int, runs: Runs, normal: float, tangential: float) -> None:
    """Add the forces along two successive rows, normal and tangent of a contact, to the push on the modes."""
    for k in range(begin, end):
        push = fused(load(rows, k, row, runs), normal, load(rows, k, PUSH, runs))
        store(rows, k, PUSH, runs, fused(-load(rows, k, row + 1, runs), tangential, push))


@inlined
def add_push_along(rows: Array, row: int, begin: int, end: int, runs: Runs, tangential: float) -> None:
    """Add the force along the row of a tangent to the push on the modes."""
    for k in range(begin, end):
        push = load(rows, k, PUSH, runs)
        store(rows, k, PUSH, runs, fused(-load(rows, k, row, runs), tangential, push))


@inlined
def complete_all(rows: Array, begin: int, end: int, runs: Runs) -> Pair:
    """Complete the step of uncoupled modes under their push (step 6); return work of the push and loss to damping."""
    works, losses = spread(0.0), spread(0.0)
    for k in range(begin, end):
        q, d, push = load(rows, k, Q, runs), load(rows, k, D, runs), load(rows, k, PUSH, runs)
        _, both = complete(rows, k, runs, q, d, load(rows, k, INCREMENT, runs) + push)
        works = fused(push, both, works)
        losses = fused((1.0 - load(rows, k, KEPT, runs)) * both, both, losses)
    return 0.5 * total(works, runs.zero), 0.25 * total(losses, runs.zero)


@inlined
def set_load(rows: Array, j: int, row: int, blocks: int, runs: Runs, factor: float) -> None:
    """Add a unit load, times a factor, to the loads of this step; the first replaces them."""
    for k in range(blocks):
        before = load(rows, k, FORCE, runs) if j else spread(0.0)
        store(rows, k, FORCE, runs, fused(factor, load(rows, k, row, runs), before))


@inlined
def work_of_unit_load(rows: Array, row: int, blocks: int, runs: Runs) -> float:
    """Return the work of a constant unit load up to now, up to a constant."""
    work = spread(0.0)
    for k in range(blocks):
        work = fused(load(rows, k, row, runs), load(rows, k, Q, runs) - 0.5 * load(rows, k, D, runs), work)
    return total(work, runs.zero)


@inlined
def stored_energy(rows: Array, begin: int, end: int, runs: Runs) -> float:
    """Return the energy of uncoupled modes half a step ago."""
    energy = spread(0.0)
    for k in range(begin, end):
        q, d = load(rows, k, Q, runs), load(rows, k, D, runs)
        energy += (0.5 + 0.5 * load(rows, k, KEPT, runs)) * d * d + load(rows, k, STIFFNESS, runs) * q * (q - d)
    return 0.5 * total(energy, runs.zero)


@inlined
def product(rows: Array, row: int, other: int, begin: int, end: int, runs: Runs) -> float:
    """Return the product of two rows over a span of blocks."""
    value = spread(0.0)
    for k in range(begin, end):
        value = fused(load(rows, k, row, runs), load(rows, k, other, runs), value)
    return total(value, runs.zero)


@inlined
def two_products(rows: Array, row: int, other: int, begin: int, end: int, runs: Runs) -> Pair:
    """Return the products of a row and of the next one with a third over a span of blocks."""
    first, second = spread(0.0), spread(0.0)
    for k in range(begin, end):
        factor = load(rows, k, other, runs)
        first = fused(load(rows, k, row, runs), factor, first)
        second = fused(load(rows, k, row + 1, runs), factor, second)
    return total(first, runs.zero), total(second, runs.zero)
