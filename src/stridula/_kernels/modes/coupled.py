"""March of modes coupled by springs or by their damping: the first blocks, whose states are not scaled.

The matrices lie in blocks like the modes, ``matrices[block, kind * places + j, lane]``: the effect of mode `j` on a
block. ``reach[block]`` has the first such mode and the one after the last: springs couple few modes, and residual
shapes none.
"""

from ..lanes.compiled import inlined
from ..lanes.operations import Array, Pair, Runs, entry, fused, load, spread, store, total
from ..layout.columns import ELASTIC, KEPT, KINETIC, LOSS, MOBILITY, STIFFNESS, TURN
from ..layout.parts import Modes, Sizes
from ..layout.rows import FORCE, INCREMENT, POSITION, PUSH, D, Q
from .blocks import complete, stored_energy


@inlined
def try_coupled(rows: Array, matrices: Array, reach: Array, coupled: int, places: int, runs: Runs) -> None:
    """Set increment and position at the end of the step without contact force in the rows (step 1)."""
    for k in range(coupled):
        increment = load(rows, k, FORCE, runs)
        for j in range(reach[k, 0], reach[k, 1]):
            increment = fused(load(matrices, k, KEPT * places + j, runs), entry(rows, j, D, runs), increment)
            lowered = load(matrices, k, STIFFNESS * places + j, runs) * entry(rows, j, Q, runs)
            increment = increment - lowered
        store(rows, k, INCREMENT, runs, increment)
        store(rows, k, POSITION, runs, load(rows, k, Q, runs) + increment)


@inlined
def respond(
    rows: Array, matrices: Array, reach: Array, coupled: int, places: int, runs: Runs, row: int, response: int
) -> None:
    """Set a row to the increments for forces on the modes, given by another row."""
    for k in range(coupled):
        moved = spread(0.0)
        for j in range(reach[k, 0], reach[k, 1]):
            moved = fused(load(matrices, k, MOBILITY * places + j, runs), entry(rows, j, row, runs), moved)
        store(rows, k, response, runs, moved)


@inlined
def complete_coupled(rows: Array, matrices: Array, reach: Array, coupled: int, places: int, runs: Runs) -> Pair:
    """Complete the step under the push of the contacts (step 6); return work of the push and loss to damping."""
    respond(rows, matrices, reach, coupled, places, runs, PUSH, POSITION)
    for k in range(coupled):
        store(rows, k, INCREMENT, runs, load(rows, k, INCREMENT, runs) + load(rows, k, POSITION, runs))
    works, losses = spread(0.0), spread(0.0)
    for k in range(coupled):
        loss = spread(0.0)
        for j in range(reach[k, 0], reach[k, 1]):
            before = entry(rows, j, D, runs)
            both = entry(rows, j, INCREMENT, runs) + before
            loss = fused(load(matrices, k, LOSS * places + j, runs), both, loss)
            loss = loss - load(matrices, k, TURN * places + j, runs) * before
        both = load(rows, k, INCREMENT, runs) + load(rows, k, D, runs)
        works = fused(load(rows, k, PUSH, runs), both, works)
        losses = fused(loss, both, losses)
    for k in range(coupled):
        complete(rows, k, runs, load(rows, k, Q, runs), spread(0.0), load(rows, k, INCREMENT, runs))
    return 0.5 * total(works, runs.zero), total(losses, runs.zero)


@inlined
def energy_of_coupled(rows: Array, matrices: Array, reach: Array, coupled: int, places: int, runs: Runs) -> float:
    """Return the energy half a step ago."""
    energy = spread(0.0)
    for k in range(coupled):
        kinetic, elastic = spread(0.0), spread(0.0)
        for j in range(reach[k, 0], reach[k, 1]):
            q, d = entry(rows, j, Q, runs), entry(rows, j, D, runs)
            kinetic = fused(load(matrices, k, KINETIC * places + j, runs), d, kinetic)
            elastic = fused(load(matrices, k, ELASTIC * places + j, runs), q - d, elastic)
        energy = fused(kinetic, load(rows, k, D, runs), fused(elastic, load(rows, k, Q, runs), energy))
    return total(energy, runs.zero)


@inlined
def energy_of(modes: Modes, sizes: Sizes, runs: Runs) -> float:
    """Return the energy half a step ago."""
    places = sizes.coupled * sizes.per_block
    coupled = energy_of_coupled(modes.rows, modes.matrices, modes.reach, sizes.coupled, places, runs)
    return coupled + stored_energy(modes.rows, sizes.coupled, sizes.blocks, runs)
