"""Displacements of all contacts and their compliance.

Forces have the signs with which they act on the modes, ``(normal, -tangential)``, so that displacements are those
without forces plus the compliance times the forces.
"""

from ..lanes.compiled import inlined
from ..lanes.operations import Array, Number, Runs, component, fused, held, load, set_component, store
from ..layout import columns as at
from ..layout.contact_values import Compliance, Tangents
from ..layout.parts import Contacts
from ..layout.rows import COMPLIANCE, DISPLACEMENT, has_b


@inlined
def own_compliance(faces: Array, n: int, runs: Runs) -> Compliance:
    """Return the compliance of a contact for its own forces, row by row from that of its normal on."""
    t = n + 1
    return Compliance(
        component(faces, n, COMPLIANCE + n, runs),
        component(faces, n, COMPLIANCE + t, runs),
        component(faces, t, COMPLIANCE + n, runs),
        component(faces, t, COMPLIANCE + t, runs),
    )


@inlined
def displace(faces: Array, blocks: int, n: int, runs: Runs, normal: Number, tangential: Number) -> None:
    """Add the displacements due to changes of the forces of a contact, by the row of its normal."""
    for k in range(blocks):
        moved = fused(load(faces, COMPLIANCE + n, k, runs), normal, load(faces, DISPLACEMENT, k, runs))
        moved = fused(-load(faces, COMPLIANCE + n + 1, k, runs), tangential, moved)
        store(faces, DISPLACEMENT, k, runs, moved)


@inlined
def displace_in_space(faces: Array, blocks: int, n: int, runs: Runs, normal: Number, pulled: Tangents) -> None:
    """Add the displacements due to changes of the forces of a contact in space."""
    for k in range(blocks):
        moved = fused(load(faces, COMPLIANCE + n, k, runs), normal, load(faces, DISPLACEMENT, k, runs))
        moved = fused(-load(faces, COMPLIANCE + n + 1, k, runs), pulled.a, moved)
        moved = fused(-load(faces, COMPLIANCE + n + 2, k, runs), pulled.b, moved)
        store(faces, DISPLACEMENT, k, runs, moved)


@inlined
def displace_freely(space: bool | None, contacts: Contacts, count: int, runs: Runs) -> None:
    """Set the displacements without any force."""
    faces, now = contacts.faces, contacts.now
    for i in range(count):
        n, here = contacts.rows[i], i * at.IN_STEP
        set_component(faces, n, DISPLACEMENT, runs, held(now, here + at.FREE_GAP, runs))
        set_component(faces, n + 1, DISPLACEMENT, runs, held(now, here + at.FREE_SLIP, runs))
        if space is not None and has_b(contacts.rows, i):
            set_component(faces, n + 2, DISPLACEMENT, runs, held(now, here + at.FREE_SLIP_B, runs))
