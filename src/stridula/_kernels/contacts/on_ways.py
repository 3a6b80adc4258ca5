"""Contacts of a face under laws whose friction changes within a step (5c), in the steps of Newton's method of `newton`.

The ratio of forces of such a contact follows from its slip without its own forces. A contact that sticks closes its gap
and undoes its slip, as under Coulomb's law. Of one that slides the normal force is unknown or, where its friction
depends strongly on the slips, all its forces are (`WHOLE`): ``y_T + N r(N, s) = 0`` for the slips s without its own
forces.
"""

from typing import NamedTuple

from ..contact.exact import ratio_under as ratio_in_plane
from ..contact.exact import slide_as_prescribed as prescribed_in_plane
from ..contact.exact import sticking_forces as sticking_in_plane
from ..contact.friction import set_valued
from ..contact.in_space import carried_in_space, free_along, past_along, strayed_in_space
from ..contact.lanewise import lane_of
from ..contact.law_in_space import is_prescribed, ratio_under, slide_as_prescribed
from ..contact.slipping import SLIDING as SLID
from ..contact.slipping import STICKING
from ..contact.slipping_in_space import sticking_forces
from ..contact.solves import law_of
from ..contact.tangents import ALONG_A, along, over, plus, scaled, size_of, to_normal
from ..lanes.compiled import called, inlined
from ..lanes.operations import Array, Runs
from ..layout.contact_values import BeforeInSpace, ComplianceInSpace, FreeInSpace, Law, Tangents
from ..layout.laws import STATIC
from ..layout.parts import Contacts
from .newton import (
    BEYOND,
    BROKE,
    BY_NORMAL,
    COUPLED,
    FACTORISED,
    FORCES,
    GIVE,
    HELD,
    INVERSE_A,
    INVERSE_B,
    JAMS,
    LET_GO,
    MISSED,
    MOTIONS,
    OPEN,
    PULL,
    RATIO,
    SLIDING,
    STATE,
    STATUS,
    STIFFNESS,
    WAY,
    WHOLE,
    Face,
)

# Change of a slip for a difference of friction, relative to the slip, and for a contact without one to the motion of
# its own forces.
DIFFERENCE, AT_REST = 1e-5, 1e-9
# Share of the friction from which all forces are unknown below which they no longer are.
STAYS = 0.5
# Least change of friction with the slips that counts, times the compliance of the contact.
LEAST_CHANGE = 1e-9


class OnWay(NamedTuple):
    """A contact in a step.

    Attributes
    ----------
    free : FreeInSpace
        Its motion without its own forces; one of the plane has nothing along tangent b.
    law : Law
        Its law of friction.
    before : BeforeInSpace
        What it carries from the steps before.
    in_space : bool
        Whether it has two tangents.
    step : float
        Step [s].
    """

    free: FreeInSpace
    law: Law
    before: BeforeInSpace
    in_space: bool
    step: float


@inlined
def on_way(face: Face, i: int, contacts: Contacts, carried: Array, one: int, step: float, runs: Runs) -> OnWay:
    """Return contact `i` of the run in lane `one`, yielding linearly about its indentation."""
    rows, soft, n = face.rows, face.soft, face.first[i]
    a, b, two = n + 1, n + 2, face.first[i + 1] - n > 2
    normal, first, second = rows[FORCES, n], rows[FORCES, a], rows[FORCES, b] if two else 0.0
    w = ComplianceInSpace(
        soft[n, n] + rows[GIVE, n],
        soft[a, n],
        soft[b, n] if two else 0.0,
        soft[n, a],
        soft[a, a],
        soft[b, a] if two else 0.0,
        soft[n, b] if two else 0.0,
        soft[a, b] if two else 0.0,
        soft[b, b] if two else 0.0,
    )
    gap = rows[MOTIONS, n] + rows[BEYOND, n] - soft[n, n] * normal - w.na * first - w.nb * second
    slip_a = rows[MOTIONS, a] - w.an * normal - w.aa * first - w.ab * second
    slip_b = rows[MOTIONS, b] - w.bn * normal - w.ba * first - w.bb * second if two else 0.0
    strays = lane_of(strayed_in_space(carried, i, runs), one)
    last = Tangents(-first, -second)
    free = FreeInSpace(gap, Tangents(slip_a, slip_b), strays, w, rows[LET_GO, n], last)
    law, before = lane_of(law_of(i, contacts, runs), one), lane_of(carried_in_space(carried, i, runs), one)
    return OnWay(free, law, before, two, step)


@called
def ratio_of(space: bool | None, normal: float, contact: OnWay) -> tuple[Tangents, float]:
    """Return the ratio of forces over the step under a normal force, and the status."""
    free, law, before, in_space, step = contact
    if space is not None and in_space:
        ratio, _, _, status, _ = ratio_under(normal, free, law, before, step)
        return ratio, float(status)
    along_a, _, _, status, _ = ratio_in_plane(normal, free_along(free, ALONG_A), law, past_along(before, ALONG_A), step)
    return Tangents(along_a, 0.0), float(status)


@called
def forces_of_stick(space: bool | None, contact: OnWay) -> tuple[float, Tangents]:
    """Return the forces that close the gap and undo the slips."""
    free = contact.free
    if space is not None and contact.in_space:
        return sticking_forces(free.gap, plus(free.slips, 1.0, free.strays), free.w)
    reduced = free_along(free, ALONG_A)
    pressed, held = sticking_in_plane(reduced.gap, reduced.slip + reduced.strayed, reduced.w)
    return pressed, Tangents(held, 0.0)


@called
def prescribed(space: bool | None, contact: OnWay) -> tuple[Tangents, float]:
    """Do `ratio_of` for a contact that no force moves along its tangents."""
    free, law, before, in_space, step = contact
    if space is not None and in_space:
        touch = slide_as_prescribed(free, law, before, step)
        return over(touch.tangential, touch.normal), touch.status
    pressed = prescribed_in_plane(free_along(free, ALONG_A), law, past_along(before, ALONG_A), step)
    return Tangents(pressed.tangential / pressed.normal, 0.0), pressed.status


@inlined
def hold_still(face: Face, i: int, pressed: float, held: Tangents, jams: bool) -> float:
    """Set contact `i` as one that sticks; return the square of what its forces miss."""
    rows, n, two = face.rows, face.first[i], face.first[i + 1] - face.first[i] > 2
    rows[STATE, n], rows[STATUS, n], rows[JAMS, n] = HELD, STICKING, 1.0 if jams else 0.0
    missed, first = rows[FORCES, n] - pressed, rows[FORCES, n + 1] + held.a
    second = rows[FORCES, n + 2] + held.b if two else 0.0
    return missed * missed + first * first + second * second


@called
def judge_on_way(space: bool | None, face: Face, i: int, contact: OnWay, swift: float) -> float:
    """Set state and ratio of contact `i`; return the square of what its forces miss.

    All its forces are unknown if it slides and its friction exceeds a share `swift` of the force that undoes the slip
    or, under a law with internal state, changes so much with the slips.
    """
    rows, n, two = face.rows, face.first[i], contact.in_space
    free, law, before, _, _ = contact
    rows[JAMS, n] = 0.0
    normal, first, second = rows[FORCES, n], rows[FORCES, n + 1], rows[FORCES, n + 2] if two else 0.0
    if free.gap >= 0.0:
        rows[STATE, n], rows[STATUS, n] = OPEN, 0.0
        return normal * normal + first * first + second * second
    given = is_prescribed(law, free.w)
    if set_valued(law.code) and before.status != SLID and not given:
        pressed, held = forces_of_stick(space, contact)
        if pressed > 0.0:
            _, status = ratio_of(space, pressed, contact)
            if status == STICKING:
                pulled = size_of(held)
                lifted = law.table[law.row, STATIC] * along(held, to_normal(free.w)) / pulled if pulled > 0.0 else 0.0
                return hold_still(face, i, pressed, held, free.w.nn <= lifted)
    pressed = normal if normal > 0.0 else -free.gap / free.w.nn
    ratio, status = prescribed(space, contact) if given else ratio_of(space, pressed, contact)
    clear = free.w.nn - along(ratio, to_normal(free.w))
    if clear <= 0.0:
        pressed, held = forces_of_stick(space, contact)
        return hold_still(face, i, pressed, held, True)
    rows[STATE, n] = WHOLE if not given and is_whole(face, n, pressed * size_of(ratio), contact, swift) else SLIDING
    rows[STATUS, n], rows[BROKE, n], found = status, 1.0, -free.gap / clear
    size = size_of(ratio)
    way = over(ratio, -size) if size > 0.0 else ratio
    rows[RATIO, n], rows[WAY, n + 1], rows[PULL, n + 1] = size, way.a, ratio.a
    rows[MISSED, n + 1] = first + pressed * ratio.a
    if two:
        rows[WAY, n + 2], rows[PULL, n + 2] = way.b, ratio.b
        rows[MISSED, n + 2] = second + pressed * ratio.b
    missed, first, second = normal - found, first + found * ratio.a, second + found * ratio.b
    return missed * missed + first * first + second * second


@inlined
def is_whole(face: Face, n: int, pulled: float, contact: OnWay, swift: float) -> bool:
    """Return whether all forces of a contact that slides are unknown; factors that are kept have their say."""
    rows = face.rows
    least = STAYS * swift if rows[FACTORISED, n] == WHOLE else swift
    if not set_valued(contact.law.code):
        return rows[COUPLED, n] > least
    slip = size_of(Tangents(rows[MOTIONS, n + 1], rows[MOTIONS, n + 2] if contact.in_space else 0.0))
    return pulled > least * rows[STIFFNESS, n] * slip


@called
def differentiate(space: bool | None, face: Face, i: int, contact: OnWay) -> None:
    """Set how friction of contact `i` changes with its normal force and its slips."""
    rows, n, free, two = face.rows, face.first[i], contact.free, contact.in_space
    normal = rows[FORCES, n] if rows[FORCES, n] > 0.0 else -free.gap / free.w.nn
    own = 0.5 * (free.w.aa + free.w.bb) if two else free.w.aa
    slip = Tangents(rows[MOTIONS, n + 1], rows[MOTIONS, n + 2] if two else 0.0)
    change = max(DIFFERENCE * size_of(slip), AT_REST * own * normal)
    here, least = Tangents(rows[PULL, n + 1], rows[PULL, n + 2] if two else 0.0), LEAST_CHANGE / own
    more = (1.0 + DIFFERENCE) * normal
    ratio, _ = ratio_of(space, more, contact)
    by_normal = over(plus(scaled(more, ratio), -normal, here), more - normal)
    by_a = friction_beside(space, contact, normal, here, Tangents(change, 0.0))
    by_b = friction_beside(space, contact, normal, here, Tangents(0.0, change)) if two else Tangents(0.0, least)
    aa, ab, ba, bb = by_a.a, by_b.a, by_a.b, by_b.b
    largest = max(abs(aa), abs(ab), abs(ba), abs(bb), least)
    rows[COUPLED, n], rows[BY_NORMAL, n + 1] = own * largest, by_normal.a
    if abs(aa * bb - ab * ba) <= least * largest:
        aa, bb = aa + least, bb + least
    determinant = aa * bb - ab * ba
    rows[INVERSE_A, n + 1] = bb / determinant
    if two:
        rows[BY_NORMAL, n + 2] = by_normal.b
        rows[INVERSE_A, n + 2], rows[INVERSE_B, n + 1] = -ab / determinant, -ba / determinant
        rows[INVERSE_B, n + 2] = aa / determinant


@inlined
def friction_beside(space: bool | None, contact: OnWay, normal: float, here: Tangents, change: Tangents) -> Tangents:
    """Return the change of friction with a change of the slips, for one of their unit."""
    free, law, before, in_space, step = contact
    moved = FreeInSpace(free.gap, plus(free.slips, 1.0, change), free.strays, free.w, free.let_go, free.guess)
    ratio, _ = ratio_of(space, normal, OnWay(moved, law, before, in_space, step))
    difference: Tangents = scaled(normal / (change.a + change.b), plus(ratio, -1.0, here))
    return difference
