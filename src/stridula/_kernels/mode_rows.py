"""What the march of one contact does to the modes, block by block.

A block is as wide as a vector: eight modes of one run, filled up with zeros, or one mode of eight runs. The fixed modes
come first, then the bending and the axial harmonics of the track. All that is known of a block lies together.

States are scaled by the root of the mobility, ``q / sqrt(l)``, and so are loads and rows: a unit force adds its row
to the increment, and the energy half a step ago is ``[(1 + b) / 2 d² + r q[n] q[n-1]] / 2``. A step is completed, under
the forces of its contact, when the next one is tried, so that the modes are read once a step.
"""

from typing import Any

import numba

from .block_rows import AMPLITUDE, FORCE, KEPT, LOADS, NORMAL, SLOPE, STIFFNESS, TANGENTIAL, D, Q
from .lanes import fused, load, spread, store, total

# No rule of arithmetic is relaxed: a step is the same to the last bit wherever it is completed.
OPTIONS: dict[str, Any] = {"cache": True, "error_model": "numpy", "forceinline": True}


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
def complete(rows, k, run, q, d, kept, stiffness, force, push):
    """Complete the step of a block under a modal force; return position, increment, and the sum of both increments."""
    increment = fused(kept, d, fused(-stiffness, q, force + push))
    both = increment + d
    q = q + increment
    store(rows, k, Q, run, q)
    store(rows, k, D, run, increment)
    return q, increment, both


@numba.njit(**OPTIONS)
def pass_fixed(rows, blocks, run, pending, normal, tangential):
    """Complete a pending step of the fixed modes and try the next.

    Returns
    -------
    along, across, works, losses : vector
        Trial displacements of the contact along tangent and normal; twice the work of the contact in the step
        completed, four times what damping took.
    """
    along, across, works, losses = spread(0.0), spread(0.0), spread(0.0), spread(0.0)
    for k in range(blocks):
        q, d, kept, stiffness, force = block_at(rows, k, run)
        upright, level = load(rows, k, NORMAL, run), load(rows, k, TANGENTIAL, run)
        if pending:
            push = fused(upright, normal, -level * tangential)
            q, d, both = complete(rows, k, run, q, d, kept, stiffness, force, push)
            works = fused(push, both, works)
            losses = fused((1.0 - kept) * both, both, losses)
        position = q + fused(kept, d, fused(-stiffness, q, force))
        along = fused(level, position, along)
        across = fused(upright, position, across)
    return along, across, works, losses


@numba.njit(**OPTIONS)
def pass_harmonics(rows, begin, blocks, wave, run, pending, pull, last, now):
    """Complete a pending step of harmonics that a force pulls at, and try the next.

    `last` and `now` are the rows of sines at the contact in the step completed and in the next.

    Returns
    -------
    trace, softness, slopes, works, losses : vector
        Trial displacement of the track at the contact, that for a unit force, its derivative along the track after the
        step completed; works and losses of that step as above.
    """
    trace, softness, slopes = spread(0.0), spread(0.0), spread(0.0)
    works, losses = spread(0.0), spread(0.0)
    for k in range(begin, begin + blocks):
        q, d, kept, stiffness, force = block_at(rows, k, run)
        here = k - begin + wave
        amplitude = load(rows, k, AMPLITUDE, run)
        row = amplitude * load(rows, here, now, run)
        if pending:
            push = pull * amplitude * load(rows, here, last, run)
            q, d, both = complete(rows, k, run, q, d, kept, stiffness, force, push)
            works = fused(push, both, works)
            losses = fused((1.0 - kept) * both, both, losses)
            slopes = fused(load(rows, k, SLOPE, run) * load(rows, here, last + 1, run), q, slopes)
        trace = fused(row, q + fused(kept, d, fused(-stiffness, q, force)), trace)
        softness = fused(row, row, softness)
    return trace, softness, slopes, works, losses


@numba.njit(**OPTIONS)
def set_load(rows, j, blocks, run, factor):
    """Add a unit load, times a factor, to the loads of this step; the first one replaces them."""
    for k in range(blocks):
        before = load(rows, k, FORCE, run) if j else spread(0.0)
        store(rows, k, FORCE, run, fused(factor, load(rows, k, LOADS + j, run), before))


@numba.njit(**OPTIONS)
def work_of_unit_load(rows, j, blocks, run, zero):
    """Return the work of a constant unit load up to now, up to a constant."""
    work = spread(0.0)
    for k in range(blocks):
        work = fused(load(rows, k, LOADS + j, run), load(rows, k, Q, run) - 0.5 * load(rows, k, D, run), work)
    return total(work, zero)


@numba.njit(**OPTIONS)
def stored_energy(rows, blocks, run, zero):
    """Return the energy half a step ago."""
    energy = spread(0.0)
    for k in range(blocks):
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
