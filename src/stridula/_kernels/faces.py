"""Displacements of all contacts and their compliance.

Forces have the signs with which they act on the modes, ``(normal, -tangential)``, so that displacements are those
without forces plus the compliance times the forces.
"""

import numba

from . import layout as at
from .block_rows import COMPLIANCE, DISPLACEMENT
from .lanes import component, fused, held, load, set_component, store
from .modes import OPTIONS


@numba.njit(**OPTIONS)
def own_compliance(faces, i, run, zero):
    """Return the compliance of contact `i` for its own forces, row by row."""
    n, t = 2 * i, 2 * i + 1
    return (
        component(faces, n, COMPLIANCE + n, run, zero),
        component(faces, n, COMPLIANCE + t, run, zero),
        component(faces, t, COMPLIANCE + n, run, zero),
        component(faces, t, COMPLIANCE + t, run, zero),
    )


@numba.njit(**OPTIONS)
def displace(faces, blocks, i, run, normal, tangential):
    """Add the displacements due to changes of the forces of contact `i`."""
    for k in range(blocks):
        moved = fused(load(faces, COMPLIANCE + 2 * i, k, run), normal, load(faces, DISPLACEMENT, k, run))
        moved = fused(-load(faces, COMPLIANCE + 2 * i + 1, k, run), tangential, moved)
        store(faces, DISPLACEMENT, k, run, moved)


@numba.njit(**OPTIONS)
def displace_in_space(faces, blocks, i, run, normal, first, second):
    """Add the displacements due to changes of the forces of contact `i` in space, which has no second normal."""
    for k in range(blocks):
        moved = fused(load(faces, COMPLIANCE + 2 * i, k, run), normal, load(faces, DISPLACEMENT, k, run))
        moved = fused(-load(faces, COMPLIANCE + 2 * i + 1, k, run), first, moved)
        moved = fused(-load(faces, COMPLIANCE + 2 * i + 3, k, run), second, moved)
        store(faces, DISPLACEMENT, k, run, moved)


@numba.njit(**OPTIONS)
def displace_freely(faces, now, count, run, zero):
    """Set the displacements without any force."""
    for i in range(count):
        set_component(faces, 2 * i, DISPLACEMENT, run, held(now, i * at.IN_STEP + at.FREE_GAP, run, zero))
        set_component(faces, 2 * i + 1, DISPLACEMENT, run, held(now, i * at.IN_STEP + at.FREE_SLIP, run, zero))
