"""Step 4 for contacts that move along paths: relative displacements of all contacts for unit forces on each."""

from ..lanes.compiled import inlined
from ..lanes.operations import Array, Runs, component, set_component
from ..layout import columns as at
from ..layout.parts import Modes, Paths
from ..layout.rows import COMPLIANCE, CONTACTS, POSITION
from ..modes.blocks import product, two_products
from ..modes.coupled import respond


@inlined
def set_compliance(
    rows: Array, faces: Array, spans: Array, first_span: Array, paths: Paths, count: int, runs: Runs
) -> None:
    """Set the compliance of bodies of uncoupled modes: that of constant rows plus that of paths.

    Contacts that share a path, or lie on the body of another contact's path, are coupled.
    """
    for i in range(count):
        if not moves_along(paths, i):
            continue
        for j in range(count):
            # Each pair of contacts on paths is taken once.
            if j > i and moves_along(paths, j):
                continue
            set_pair(rows, faces, spans, first_span, i, j, 2 * count, runs)


@inlined
def moves_along(paths: Paths, i: int) -> bool:
    """Return whether contact `i` moves along a path or round a body."""
    return paths.path_of[i] >= 0 or paths.body_of[i] >= 0


@inlined
def set_pair(rows: Array, faces: Array, spans: Array, first_span: Array, i: int, j: int, size: int, runs: Runs) -> None:
    """Set the compliance of contact `i`, which is on a path, for forces on contact `j`, and the reverse."""
    for side in range(2):
        normal = component(faces, 2 * i + side, COMPLIANCE + size + 2 * j, runs)
        tangential = component(faces, 2 * i + side, COMPLIANCE + size + 2 * j + 1, runs)
        for s in range(first_span[i], first_span[i + 1]):
            if spans[s, at.KIND] != at.CONSTANT:
                begin, end = spans[s, at.BEGIN], spans[s, at.END]
                along = two_products(rows, CONTACTS + 2 * j, CONTACTS + 2 * i + side, begin, end, runs)
                normal, tangential = normal + along[0], tangential + along[1]
        for s in range(first_span[j], first_span[j + 1]):
            if spans[s, at.KIND] != at.CONSTANT and not shared(spans, first_span, i, spans[s, at.BEGIN]):
                begin, end = spans[s, at.BEGIN], spans[s, at.END]
                along = two_products(rows, CONTACTS + 2 * j, CONTACTS + 2 * i + side, begin, end, runs)
                normal, tangential = normal + along[0], tangential + along[1]
        for other, value in ((2 * j, normal), (2 * j + 1, tangential)):
            set_component(faces, 2 * i + side, COMPLIANCE + other, runs, value)
            set_component(faces, other, COMPLIANCE + 2 * i + side, runs, value)


@inlined
def shared(spans: Array, first_span: Array, i: int, begin: int) -> bool:
    """Return whether a span of a path also belongs to contact `i`."""
    for s in range(first_span[i], first_span[i + 1]):
        if spans[s, at.KIND] != at.CONSTANT and spans[s, at.BEGIN] == begin:
            return True
    return False


@inlined
def set_compliance_of_coupled(
    modes: Modes, faces: Array, blocks: int, coupled: int, places: int, count: int, runs: Runs
) -> None:
    """Set the compliance of bodies of which some have coupled modes.

    It is symmetric except where stiffness and damping of these modes do not commute.
    """
    rows = modes.rows
    for j in range(2 * count):
        respond(rows, modes.matrices, modes.reach, coupled, places, runs, CONTACTS + j, POSITION)
        for i in range(2 * count):
            value = product(rows, CONTACTS + i, POSITION, 0, coupled, runs)
            value += product(rows, CONTACTS + i, CONTACTS + j, coupled, blocks, runs)
            set_component(faces, i, COMPLIANCE + j, runs, value)
