"""Step 4 for contacts that move along paths: relative displacements of all contacts for unit forces on each."""

from ..lanes.compiled import inlined
from ..lanes.operations import Array, Number, Runs, component, set_component
from ..layout import columns as at
from ..layout.parts import Contacts, Modes, Paths, Sizes
from ..layout.rows import COMPLIANCE, CONTACTS, POSITION, has_b
from ..modes.blocks import product, two_products
from ..modes.coupled import respond


@inlined
def set_compliance(
    space: bool | None, modes: Modes, paths: Paths, contacts: Contacts, sizes: Sizes, runs: Runs
) -> None:
    """Set the compliance of bodies of uncoupled modes: that of constant rows plus that of paths.

    Contacts that share a path, or lie on the body of another contact's path, are coupled.
    """
    for i in range(sizes.contacts):
        if not moves_along(paths, i):
            continue
        for j in range(sizes.contacts):
            # Each pair of contacts on paths is taken once.
            if j > i and moves_along(paths, j):
                continue
            for side in range(contacts.rows[i], contacts.rows[i + 1]):
                set_pair(modes.rows, contacts, paths, (i, j), side, sizes.rows, runs)
                if space is not None and has_b(contacts.rows, j):
                    set_along_b(modes.rows, contacts, paths, (i, j), side, sizes.rows, runs)


@inlined
def moves_along(paths: Paths, i: int) -> bool:
    """Return whether contact `i` moves along a path or round a body."""
    return paths.path_of[i] >= 0 or paths.body_of[i] >= 0


@inlined
def set_pair(
    rows: Array, contacts: Contacts, paths: Paths, pair: tuple[int, int], side: int, size: int, runs: Runs
) -> None:
    """Set the compliance of a row of a contact, which is on a path, for forces on another contact, and the reverse.

    The latter are those along its normal and its tangent a.
    """
    (i, j), spans, first_span = pair, paths.spans, paths.first_span
    n = contacts.rows[j]
    normal = component(contacts.faces, side, COMPLIANCE + size + n, runs)
    tangential = component(contacts.faces, side, COMPLIANCE + size + n + 1, runs)
    for s in range(first_span[i], first_span[i + 1]):
        if spans[s, at.KIND] != at.CONSTANT:
            begin, end = spans[s, at.BEGIN], spans[s, at.END]
            more, further = two_products(rows, CONTACTS + n, CONTACTS + side, begin, end, runs)
            normal, tangential = normal + more, tangential + further
    for s in range(first_span[j], first_span[j + 1]):
        if spans[s, at.KIND] != at.CONSTANT and not shared(spans, first_span, i, spans[s, at.BEGIN]):
            begin, end = spans[s, at.BEGIN], spans[s, at.END]
            more, further = two_products(rows, CONTACTS + n, CONTACTS + side, begin, end, runs)
            normal, tangential = normal + more, tangential + further
    set_both_ways(contacts.faces, side, n, runs, normal)
    set_both_ways(contacts.faces, side, n + 1, runs, tangential)


@inlined
def set_along_b(
    rows: Array, contacts: Contacts, paths: Paths, pair: tuple[int, int], side: int, size: int, runs: Runs
) -> None:
    """Do `set_pair` for forces along tangent b."""
    (i, j), spans, first_span = pair, paths.spans, paths.first_span
    b = contacts.rows[j] + 2
    moved = component(contacts.faces, side, COMPLIANCE + size + b, runs)
    for s in range(first_span[i], first_span[i + 1]):
        if spans[s, at.KIND] != at.CONSTANT:
            moved += product(rows, CONTACTS + b, CONTACTS + side, spans[s, at.BEGIN], spans[s, at.END], runs)
    for s in range(first_span[j], first_span[j + 1]):
        if spans[s, at.KIND] != at.CONSTANT and not shared(spans, first_span, i, spans[s, at.BEGIN]):
            moved += product(rows, CONTACTS + b, CONTACTS + side, spans[s, at.BEGIN], spans[s, at.END], runs)
    set_both_ways(contacts.faces, side, b, runs, moved)


@inlined
def set_both_ways(faces: Array, one: int, other: int, runs: Runs, value: Number) -> None:
    """Set the compliance of two rows for forces on each other."""
    set_component(faces, one, COMPLIANCE + other, runs, value)
    set_component(faces, other, COMPLIANCE + one, runs, value)


@inlined
def shared(spans: Array, first_span: Array, i: int, begin: int) -> bool:
    """Return whether a span of a path also belongs to contact `i`."""
    for s in range(first_span[i], first_span[i + 1]):
        if spans[s, at.KIND] != at.CONSTANT and spans[s, at.BEGIN] == begin:
            return True
    return False


@inlined
def set_compliance_of_coupled(modes: Modes, faces: Array, sizes: Sizes, runs: Runs) -> None:
    """Set the compliance of bodies of which some have coupled modes.

    It is symmetric except where stiffness and damping of these modes do not commute.
    """
    rows, coupled, places = modes.rows, sizes.coupled, sizes.coupled * sizes.per_block
    for j in range(sizes.rows):
        respond(rows, modes.matrices, modes.reach, coupled, places, runs, CONTACTS + j, POSITION)
        for i in range(sizes.rows):
            value = product(rows, CONTACTS + i, POSITION, 0, coupled, runs)
            value += product(rows, CONTACTS + i, CONTACTS + j, coupled, sizes.blocks, runs)
            set_component(faces, i, COMPLIANCE + j, runs, value)
