"""Step 5 for all contacts together, a run at a time: see `newton`."""

from ..contact.exact import SLIDING, STICKING
from ..contact.pressing import share_of
from ..contact.solves import strayed
from ..contact.yielding import give_of, path_of, yields_of
from ..lanes.compiled import called, inlined
from ..lanes.operations import (
    Array,
    Number,
    Runs,
    component,
    held,
    hold,
    lane,
    lanes_of,
    set_component,
    with_lane,
)
from ..layout import columns as at
from ..layout.parts import Contacts, Sizes
from ..layout.rows import COMPLIANCE, DISPLACEMENT, has_b
from .newton import FORCES, FREE, RATIO, Face, Way, face_of, find_forces, project

# Ways that are tried in turn, and whether each starts from the forces of the last step, not from those of the sweeps.
WAYS = (
    Way(3.0, 0.0, False),
    Way(3.0, 0.0, False),
    Way(3.0, 1.0, True),
    Way(1.0, 0.1, True),
    Way(1.0, 0.0, False),
    Way(10.0, 0.0, False),
)
AGAIN = True, False, True, False, True, False
# Most indentations about which contacts yield, and the change of force that is settled, relative to the largest.
SOFTENINGS, SETTLED = 20, 1e-11


@inlined
def all_under_coulomb(codes: Array) -> bool:
    """Return whether all contacts have Coulomb's law."""
    others = 0
    for code in codes:
        others += 0 if code == at.COULOMB else 1
    return others == 0


@inlined
def tangents_of(contacts: Contacts, i: int) -> int:
    """Return the number of tangents of contact `i`."""
    return 2 if has_b(contacts.rows, i) else 1


@inlined
def column(k: int, along_a: int, along_b: int) -> int:
    """Return the column of tangent `k`."""
    return along_a if k == 0 else along_b


@inlined
def set_face(face: Face, again: bool, contacts: Contacts, carried: Array, i: int, one: int, runs: Runs) -> None:
    """Set the numbers of contact `i` in lane `one`: its ratio, its motion, its forces."""
    now, rows, here, base = contacts.now, face.rows, i * at.IN_STEP, i * at.CARRIED
    n = i * face.own
    rows[RATIO, n] = lane(held(contacts.constants, i * at.CONTACT_CONSTANTS + at.AT_REST, runs), one)
    closed = lane(held(carried, base + at.STATUS, runs), one) > 0.5 * STICKING
    last = lane(held(carried, base + at.LAST_NORMAL, runs), one) if closed else 0.0
    rows[FORCES, n] = last if again else lane(held(now, here + at.NORMAL_NOW, runs), one)
    rows[FREE, n] = lane(held(now, here + at.FREE_GAP, runs) + held(now, here + at.BEYOND, runs), one)
    for k in range(face.own - 1):
        rows[FORCES, n + 1 + k], rows[FREE, n + 1 + k] = 0.0, 0.0
        if k < tangents_of(contacts, i):
            was = lane(held(carried, base + column(k, at.LAST_TANGENTIAL, at.LAST_TANGENTIAL_B), runs), one)
            found = lane(held(now, here + column(k, at.TANGENTIAL_NOW, at.TANGENTIAL_NOW_B), runs), one)
            rows[FORCES, n + 1 + k] = -((was if closed else 0.0) if again else found)
            # Slips are those from the anchor where a contact stuck before.
            places = column(k, at.MATERIAL, at.MATERIAL_B), column(k, at.ANCHOR, at.ANCHOR_B)
            slip = held(now, here + column(k, at.FREE_SLIP, at.FREE_SLIP_B), runs)
            rows[FREE, n + 1 + k] = lane(slip + strayed(carried, base, places[0], places[1], runs), one)


@called
def put_face(face: Face, again: bool, contacts: Contacts, carried: Array, one: int, runs: Runs) -> None:
    """Set the compliance and the numbers of all contacts in lane `one`; a contact with a stiffness gives more.

    A tangent that a contact does not have in a system with others in space has no compliance.
    """
    own = face.own
    for i in range(contacts.codes.size):
        set_face(face, again, contacts, carried, i, one, runs)
        for k in range(own):
            for j in range(contacts.codes.size):
                for other in range(own):
                    soft = 0.0
                    if k <= tangents_of(contacts, i) and other <= tangents_of(contacts, j):
                        row, unit = contacts.rows[i] + k, contacts.rows[j] + other
                        soft = lane(component(contacts.faces, row, COMPLIANCE + unit, runs), one)
                    face.compliance[i * own + k, j * own + other] = soft
        face.compliance[i * own, i * own] += lane(held(contacts.now, i * at.IN_STEP + at.GIVE, runs), one)


@inlined
def put_in_lane(array: Array, row: int, one: int, number: float, runs: Runs) -> None:
    """Set the number of a run in lane `one`."""
    hold(array, row, runs, with_lane(held(array, row, runs), one, number))


@called
def accept(face: Face, contacts: Contacts, one: int, runs: Runs) -> None:
    """Set forces, states and displacements of all contacts to those found."""
    now = contacts.now
    for i in range(contacts.codes.size):
        here, n, found = i * at.IN_STEP, i * face.own, project(face, i * face.own, 0.0)
        normal, slides = max(found.normal, 0.0), found.size > found.radius
        kept = found.radius / found.size if slides else 1.0
        status = 0.0 if normal == 0.0 else float(SLIDING if slides else STICKING)
        face.rows[FORCES, n] = normal
        put_in_lane(now, here + at.NORMAL_NOW, one, normal, runs)
        put_in_lane(now, here + at.STATUS_NOW, one, status, runs)
        put_in_lane(now, here + at.JAMMED_NOW, one, 0.0, runs)
        if normal > 0.0:
            put_in_lane(now, here + at.MAY_TOUCH, one, 1.0, runs)
        for k in range(tangents_of(contacts, i)):
            pulled = kept * found.pulled[k]
            face.rows[FORCES, n + 1 + k] = pulled
            put_in_lane(now, here + column(k, at.TANGENTIAL_NOW, at.TANGENTIAL_NOW_B), one, -pulled, runs)
    displace_anew(face, contacts, one, runs)


@inlined
def displace_anew(face: Face, contacts: Contacts, one: int, runs: Runs) -> None:
    """Set the displacements under the forces found."""
    for i in range(contacts.codes.size):
        here, n = i * at.IN_STEP, i * face.own
        for k in range(1 + tangents_of(contacts, i)):
            free = at.FREE_GAP if k == 0 else column(k - 1, at.FREE_SLIP, at.FREE_SLIP_B)
            moved = lane(held(contacts.now, here + free, runs), one)
            for other in range(len(face.compliance)):
                moved += face.compliance[n + k, other] * face.rows[FORCES, other]
            if k == 0:
                moved -= lane(held(contacts.now, here + at.GIVE, runs), one) * face.rows[FORCES, n]
            row = contacts.rows[i] + k
            was = component(contacts.faces, row, DISPLACEMENT, runs)
            set_component(contacts.faces, row, DISPLACEMENT, runs, with_lane(was, one, moved))


@called
def soften_anew(face: Face, contacts: Contacts, carried: Array, one: int, step: Number, runs: Runs) -> bool:
    """Set how contacts yield about their indentations in lane `one`; return whether their forces are those there."""
    rows, wrong, largest = face.rows, 0.0, 0.0
    for i in range(contacts.codes.size):
        here, n, row = i * at.IN_STEP, i * face.own, contacts.rows[i]
        yields, path = yields_of(i, contacts.constants, runs), path_of(i, carried, runs)
        largest = max(largest, rows[FORCES, n])
        if lane(yields.stiffness, one) > 0.0:
            inside = -lane(component(contacts.faces, row, DISPLACEMENT, runs), one)
            soft = component(contacts.faces, row, COMPLIANCE + row, runs)
            # Without the forces of the contact itself it is deeper.
            deeper = inside + lane(soft, one) * rows[FORCES, n]
            for k in range(1, face.own):
                deeper += face.compliance[n, n + k] * rows[FORCES, n + k]
            share = share_of(with_lane(runs.zero, one, deeper), path, yields)
            give, beyond = give_of(with_lane(runs.zero, one, inside), path, yields, share, soft, step, runs.zero)
            softer, further = lane(give, one), lane(beyond, one)
            wrong = max(wrong, abs(inside - further - softer * rows[FORCES, n]) / (lane(soft, one) + softer))
            put_in_lane(contacts.now, here + at.GIVE, one, softer, runs)
            put_in_lane(contacts.now, here + at.BEYOND, one, further, runs)
    return wrong <= SETTLED * largest


@called
def solve_together(
    contacts: Contacts, carried: Array, sizes: Sizes, attempt: int, tried: Number, step: Number, runs: Runs
) -> Number:
    """Seek the forces of all contacts in runs `tried`; return where they are found.

    Contacts that yield do so about their last indentations, until these do not change.
    """
    found = runs.zero
    face = face_of(contacts.dense[runs.first], sizes.contacts, 3 if sizes.space else 2)
    way = attempt % len(WAYS)
    for one in range(lanes_of(runs.zero)):
        if lane(tried, one) > 0.5:
            again = AGAIN[way]
            for _ in range(SOFTENINGS):
                put_face(face, again, contacts, carried, one, runs)
                if not find_forces(face, WAYS[way]):
                    break
                accept(face, contacts, one, runs)
                again = False
                if soften_anew(face, contacts, carried, one, step, runs):
                    found = with_lane(found, one, 1.0)
                    break
    return found
