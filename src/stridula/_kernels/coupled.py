"""March of modes coupled by springs or by their damping: the first blocks, whose states are not scaled.

The matrices lie in blocks like the modes, ``matrices[block, kind * places + j, lane]``: the effect of mode `j` on a
block. ``reach[block]`` has the first such mode and the one after the last: springs couple few modes, and residual
shapes none.
"""

import numba

from .block_rows import FORCE, INCREMENT, POSITION, PUSH, D, Q
from .lanes import entry, fused, load, spread, store, total
from .layout import ELASTIC, KEPT, KINETIC, LOSS, MOBILITY, STIFFNESS, TURN
from .modes import OPTIONS, complete, stored_energy


@numba.njit(**OPTIONS)
def try_coupled(rows, matrices, reach, coupled, places, run, zero):
    """Set increment and position at the end of the step without contact force in the rows (step 1)."""
    for k in range(coupled):
        increment = load(rows, k, FORCE, run)
        for j in range(reach[k, 0], reach[k, 1]):
            increment = fused(load(matrices, k, KEPT * places + j, run), entry(rows, j, D, run, zero), increment)
            lowered = load(matrices, k, STIFFNESS * places + j, run) * entry(rows, j, Q, run, zero)
            increment = increment - lowered
        store(rows, k, INCREMENT, run, increment)
        store(rows, k, POSITION, run, load(rows, k, Q, run) + increment)


@numba.njit(**OPTIONS)
def respond(rows, matrices, reach, coupled, places, run, row, response, zero):
    """Set a row to the increments for forces on the modes, given by another row."""
    for k in range(coupled):
        moved = spread(0.0)
        for j in range(reach[k, 0], reach[k, 1]):
            moved = fused(load(matrices, k, MOBILITY * places + j, run), entry(rows, j, row, run, zero), moved)
        store(rows, k, response, run, moved)


@numba.njit(**OPTIONS)
def complete_coupled(rows, matrices, reach, coupled, places, run, zero):
    """Complete the step under the push of the contacts (step 6); return work of the push and loss to damping."""
    respond(rows, matrices, reach, coupled, places, run, PUSH, POSITION, zero)
    for k in range(coupled):
        store(rows, k, INCREMENT, run, load(rows, k, INCREMENT, run) + load(rows, k, POSITION, run))
    works, losses = spread(0.0), spread(0.0)
    for k in range(coupled):
        loss = spread(0.0)
        for j in range(reach[k, 0], reach[k, 1]):
            before = entry(rows, j, D, run, zero)
            both = entry(rows, j, INCREMENT, run, zero) + before
            loss = fused(load(matrices, k, LOSS * places + j, run), both, loss)
            loss = loss - load(matrices, k, TURN * places + j, run) * before
        both = load(rows, k, INCREMENT, run) + load(rows, k, D, run)
        works = fused(load(rows, k, PUSH, run), both, works)
        losses = fused(loss, both, losses)
    for k in range(coupled):
        complete(rows, k, run, load(rows, k, Q, run), spread(0.0), load(rows, k, INCREMENT, run))
    return 0.5 * total(works, zero), total(losses, zero)


@numba.njit(**OPTIONS)
def energy_of_coupled(rows, matrices, reach, coupled, places, run, zero):
    """Return the energy half a step ago."""
    energy = spread(0.0)
    for k in range(coupled):
        kinetic, elastic = spread(0.0), spread(0.0)
        for j in range(reach[k, 0], reach[k, 1]):
            q, d = entry(rows, j, Q, run, zero), entry(rows, j, D, run, zero)
            kinetic = fused(load(matrices, k, KINETIC * places + j, run), d, kinetic)
            elastic = fused(load(matrices, k, ELASTIC * places + j, run), q - d, elastic)
        energy = fused(kinetic, load(rows, k, D, run), fused(elastic, load(rows, k, Q, run), energy))
    return total(energy, zero)


@numba.njit(**OPTIONS)
def energy_of(modes, sizes, run, zero):
    """Return the energy half a step ago."""
    places = sizes.coupled * sizes.per_block
    coupled = energy_of_coupled(modes.rows, modes.matrices, modes.reach, sizes.coupled, places, run, zero)
    return coupled + stored_energy(modes.rows, sizes.coupled, sizes.blocks, run, zero)
