"""March of the modes, block by block.

A block is as wide as a vector: eight modes of one run, filled up with zeros, or one mode of eight runs. All rows of a
block are adjacent in memory. States are scaled by the root of the mobility, ``q / sqrt(l)``, and so are loads and
rows: a unit force adds its row to the increment, and the energy half a step ago is
``[(1 + b) / 2 d² + r q[n] q[n-1]] / 2``.

One contact between bodies of uncoupled modes: a step is completed under its forces (step 6) together with the trial of
the next one (step 1), so that the modes are read once a step (`pass_fixed`, `pass_waves`). Any number of contacts: a
step is tried, the displacements of all contacts are summed, and the step is completed under the push of all.
"""

from typing import Any

import numba

from . import layout as at
from .block_rows import (
    AMPLITUDE,
    CONTACTS,
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
from .lanes import entry, fused, load, spread, store, total

# No reference counting: arrays come from Python and stay.
SHARED: dict[str, Any] = {"cache": True, "error_model": "numpy", "_nrt": False, "no_cfunc_wrapper": True}
# No wrapper for callers in Python, which takes a sixth of the compilation: called from there, these functions crash.
INNER: dict[str, Any] = {**SHARED, "no_cpython_wrapper": True, "fastmath": False}
# Strict arithmetic: a step is the same to the last bit wherever it is completed.
OPTIONS: dict[str, Any] = {**INNER, "forceinline": True}
# For functions that mainly call others, inlined as Python: compiled apart, all that they call would be optimised again.
PASTED: dict[str, Any] = {**INNER, "inline": "always"}
# For functions called from Python, which let other threads run.
ENTRY: dict[str, Any] = {**SHARED, "nogil": True, "fastmath": False}


@numba.njit(**OPTIONS)
def block_at(rows, k, run):
    """Return position, last increment, share kept, stiffness and load of a block."""
    return (
        load(rows, k, Q, run),
        load(rows, k, D, run),
        load(rows, k, KEPT, run),
        load(rows, k, STIFFNESS, run),
        load(rows, k, FORCE, run),
    )


@numba.njit(**OPTIONS)
def complete(rows, k, run, q, d, increment):
    """Complete the step of a block by an increment (step 6); return the position and the sum of both increments."""
    q = q + increment
    store(rows, k, Q, run, q)
    store(rows, k, D, run, increment)
    return q, increment + d


@numba.njit(**OPTIONS)
def pass_fixed(rows, begin, end, run, pending, normal, tangential):
    """Complete a pending step of modes with constant rows (step 6) and try the next (step 1).

    Returns
    -------
    along, across, works, losses : vector
        Trial displacements of the contact along tangent and normal; twice the work of the contact in the step
        completed, four times the loss to damping.
    """
    along, across, works, losses = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for k in range(begin, end):
        q, d, kept, stiffness, force = block_at(rows, k, run)
        upright, level = load(rows, k, NORMAL, run), load(rows, k, TANGENTIAL, run)
        if pending:
            push = fused(upright, normal, -level * tangential)
            increment = fused(kept, d, fused(-stiffness, q, force + push))
            q, both = complete(rows, k, run, q, d, increment)
            d = increment
            works = fused(push, both, works)
            losses = fused((1.0 - kept) * both, both, losses)
        position = q + fused(kept, d, fused(-stiffness, q, force))
        along = fused(level, position, along)
        across = fused(upright, position, across)
    return along, across, works, losses


@numba.njit(**OPTIONS)
def trace_of(rows, k, waves, here, number, products, sine, cosines, run, like):
    """Return the displacement of a path for a unit of the modes in block `k`, by the waves in rows from `sine` on.

    `here` is the block of the waves along the path, `number` the entry of the wave across it.
    """
    if not products:
        return load(rows, k, AMPLITUDE, run) * load(waves, here, sine + cosines, run)
    trace = (load(rows, k, AMPLITUDE, run) * load(waves, here, sine + 1 - cosines, run)) * entry(
        waves, number, sine, run, like
    )
    if products > 1:
        other = load(rows, k, OTHER_AMPLITUDE, run) * load(waves, here, sine + cosines, run)
        trace = fused(other, entry(waves, number, sine + 1, run, like), trace)
    return trace


@numba.njit(**OPTIONS)
def slope_of(rows, k, waves, here, number, products, sine, cosines, run, like):
    """Return the derivative along a path of `trace_of`."""
    if not products:
        return load(rows, k, SLOPE, run) * load(waves, here, sine + 1 - cosines, run)
    slope = (load(rows, k, SLOPE, run) * load(waves, here, sine + cosines, run)) * entry(waves, number, sine, run, like)
    other = load(rows, k, OTHER_SLOPE, run) * load(waves, here, sine + 1 - cosines, run)
    return fused(other, entry(waves, number, sine + 1, run, like), slope)


@numba.njit(**OPTIONS)
def pass_waves(modes, paths, s, run, pending, pull, last, now, like):
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
        q, d, kept, stiffness, force = block_at(rows, k, run)
        here, number = paths.wave_of[k], paths.sets[0, ZEROTH] + paths.across_of[k]
        row = trace_of(rows, k, waves, here, number, products, now, cosines, run, like)
        if pending:
            push = pull * trace_of(rows, k, waves, here, number, products, last, cosines, run, like)
            increment = fused(kept, d, fused(-stiffness, q, force + push))
            q, both = complete(rows, k, run, q, d, increment)
            d = increment
            works = fused(push, both, works)
            losses = fused((1.0 - kept) * both, both, losses)
            slope = slope_of(rows, k, waves, here, number, products, last, cosines, run, like)
            slopes = fused(slope, q, slopes)
        trace = fused(row, q + fused(kept, d, fused(-stiffness, q, force)), trace)
        softness = fused(row, row, softness)
    return trace, softness, slopes, works, losses


@numba.njit(**OPTIONS)
def try_all(rows, begin, end, run):
    """Set increment and position at the end of the step without contact force in uncoupled modes (step 1)."""
    for k in range(begin, end):
        q, d, kept, stiffness, force = block_at(rows, k, run)
        increment = fused(kept, d, fused(-stiffness, q, force))
        store(rows, k, INCREMENT, run, increment)
        store(rows, k, POSITION, run, q + increment)


@numba.njit(**OPTIONS)
def set_path_rows(rows, paths, i, s, row, sine, run, like):
    """Set the row of contact `i` in span `s` to minus the trace of its path (step 2)."""
    spans, first, zeroth = paths.spans, paths.sets[i, FIRST], paths.sets[i, ZEROTH]
    products, cosines = spans[s, at.PRODUCTS], spans[s, at.COSINES]
    for k in range(spans[s, at.BEGIN], spans[s, at.END]):
        here, number = first + paths.wave_of[k], zeroth + paths.across_of[k]
        store(rows, k, row, run, -trace_of(rows, k, paths.waves, here, number, products, sine, cosines, run, like))


@numba.njit(**OPTIONS)
def slope_along(rows, paths, i, s, sine, run, like):
    """Return the derivative of a path's displacement along it at contact `i`, by the modes of span `s`."""
    spans, first, zeroth = paths.spans, paths.sets[i, FIRST], paths.sets[i, ZEROTH]
    products, cosines = spans[s, at.PRODUCTS], spans[s, at.COSINES]
    slopes = spread(0.0)
    for k in range(spans[s, at.BEGIN], spans[s, at.END]):
        here, number = first + paths.wave_of[k], zeroth + paths.across_of[k]
        slope = slope_of(rows, k, paths.waves, here, number, products, sine, cosines, run, like)
        slopes = fused(slope, load(rows, k, Q, run), slopes)
    return total(slopes, like)


@numba.njit(**OPTIONS)
def clear_push(rows, blocks, run):
    """Set the push on the modes to zero."""
    for k in range(blocks):
        store(rows, k, PUSH, run, spread(0.0))


@numba.njit(**OPTIONS)
def add_push(rows, i, begin, end, run, normal, tangential):
    """Add the forces of contact `i` to the push on the modes."""
    for k in range(begin, end):
        push = fused(load(rows, k, CONTACTS + 2 * i, run), normal, load(rows, k, PUSH, run))
        store(rows, k, PUSH, run, fused(-load(rows, k, CONTACTS + 2 * i + 1, run), tangential, push))


@numba.njit(**OPTIONS)
def complete_all(rows, begin, end, run, zero):
    """Complete the step of uncoupled modes under their push (step 6); return work of the push and loss to damping."""
    works, losses = spread(0.0), spread(0.0)
    for k in range(begin, end):
        q, d, push = load(rows, k, Q, run), load(rows, k, D, run), load(rows, k, PUSH, run)
        _, both = complete(rows, k, run, q, d, load(rows, k, INCREMENT, run) + push)
        works = fused(push, both, works)
        losses = fused((1.0 - load(rows, k, KEPT, run)) * both, both, losses)
    return 0.5 * total(works, zero), 0.25 * total(losses, zero)


@numba.njit(**OPTIONS)
def set_load(rows, j, row, blocks, run, factor):
    """Add a unit load, times a factor, to the loads of this step; the first replaces them."""
    for k in range(blocks):
        before = load(rows, k, FORCE, run) if j else spread(0.0)
        store(rows, k, FORCE, run, fused(factor, load(rows, k, row, run), before))


@numba.njit(**OPTIONS)
def work_of_unit_load(rows, row, blocks, run, zero):
    """Return the work of a constant unit load up to now, up to a constant."""
    work = spread(0.0)
    for k in range(blocks):
        work = fused(load(rows, k, row, run), load(rows, k, Q, run) - 0.5 * load(rows, k, D, run), work)
    return total(work, zero)


@numba.njit(**OPTIONS)
def stored_energy(rows, begin, end, run, zero):
    """Return the energy of uncoupled modes half a step ago."""
    energy = spread(0.0)
    for k in range(begin, end):
        q, d = load(rows, k, Q, run), load(rows, k, D, run)
        energy += (0.5 + 0.5 * load(rows, k, KEPT, run)) * d * d + load(rows, k, STIFFNESS, run) * q * (q - d)
    return 0.5 * total(energy, zero)


@numba.njit(**OPTIONS)
def product(rows, row, other, begin, end, run, zero):
    """Return the product of two rows over a span of blocks."""
    value = spread(0.0)
    for k in range(begin, end):
        value = fused(load(rows, k, row, run), load(rows, k, other, run), value)
    return total(value, zero)


@numba.njit(**OPTIONS)
def two_products(rows, row, other, begin, end, run, zero):
    """Return the products of a row and of the next one with a third over a span of blocks."""
    first, second = spread(0.0), spread(0.0)
    for k in range(begin, end):
        factor = load(rows, k, other, run)
        first = fused(load(rows, k, row, run), factor, first)
        second = fused(load(rows, k, row + 1, run), factor, second)
    return total(first, zero), total(second, zero)
