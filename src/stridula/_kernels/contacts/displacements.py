"""Displacements of all contacts and their compliance.

Forces have the signs with which they act on the modes, ``(normal, -tangential)``, so that displacements are those
without forces plus the compliance times the forces.
"""

from ..lanes.compiled import inlined
from ..lanes.operations import Array, Number, Runs, component, fused, held, load, set_component, store
from ..layout import columns as at
from ..layout.contact_values import Compliance
from ..layout.rows import COMPLIANCE, DISPLACEMENT


@inlined
def own_compliance(faces: Array, i: int, runs: Runs) -> Compliance:
    """Return the compliance of contact `i` for its own forces, row by row."""
    n, t = 2 * i, 2 * i + 1
    return Compliance(
        component(faces, n, COMPLIANCE + n, runs),
        component(faces, n, COMPLIANCE + t, runs),
        component(faces, t, COMPLIANCE + n, runs),
        component(faces, t, COMPLIANCE + t, runs),
    )


@inlined
def displace(faces: Array, blocks: int, i: int, runs: Runs, normal: Number, tangential: Number) -> None:
    """Add the displacements due to changes of the forces of contact `i`."""
    for k in range(blocks):
        moved = fused(load(faces, COMPLIANCE + 2 * i, k, runs), normal, load(faces, DISPLACEMENT, k, runs))
        moved = fused(-load(faces, COMPLIANCE + 2 * i + 1, k, runs), tangential, moved)
        store(faces, DISPLACEMENT, k, runs, moved)


@inlined
def displace_in_space(
    faces: Array, blocks: int, i: int, runs: Runs, normal: Number, first: Number, second: Number
) -> None:
    """Add the displacements due to changes of the forces of contact `i` in space, which has no second normal."""
    for k in range(blocks):
        moved = fused(load(faces, COMPLIANCE + 2 * i, k, runs), normal, load(faces, DISPLACEMENT, k, runs))
        moved = fused(-load(faces, COMPLIANCE + 2 * i + 1, k, runs), first, moved)
        moved = fused(-load(faces, COMPLIANCE + 2 * i + 3, k, runs), second, moved)
        store(faces, DISPLACEMENT, k, runs, moved)


@inlined
def displace_freely(faces: Array, now: Array, count: int, runs: Runs) -> None:
    """Set the displacements without any force."""
    for i in range(count):
        set_component(faces, 2 * i, DISPLACEMENT, runs, held(now, i * at.IN_STEP + at.FREE_GAP, runs))
        set_component(faces, 2 * i + 1, DISPLACEMENT, runs, held(now, i * at.IN_STEP + at.FREE_SLIP, runs))
