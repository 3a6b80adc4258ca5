"""Step 5 for all contacts together, a run at a time: see `newton`, and `on_ways` for laws other than Coulomb's.

Under Coulomb's law a contact that stuck has its slip from the anchor; any other has the slip of this step with a share
of the last two, which makes the velocity of second order (5c). Where with this share a slip would end or turn round in
the step, the friction of the part before its end is given, an apex; the slip of the step counts for the rest (5d).
"""

import math
from typing import NamedTuple

from ..contact.exact import SLIDING, STICKING
from ..contact.friction import set_valued
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
    rows_of_run,
    set_component,
    with_lane,
)
from ..layout import columns as at
from ..layout.parts import Contacts, Sizes, Timing
from ..layout.rows import COMPLIANCE, DISPLACEMENT
from .newton import (
    APEX,
    BEYOND,
    BROKE,
    ENDS,
    FACTORS,
    FORCES,
    FREE,
    GIVE,
    HELD,
    JAMS,
    LAST,
    LET_GO,
    MOTIONS,
    OLD_FORCES,
    OLD_MOTIONS,
    OPEN,
    RATIO,
    SHIFT,
    STATE,
    STATUS,
    SWIFT,
    SWIFTER,
    WAS,
    WAY,
    WHOLE,
    Face,
    factorise,
    judge,
    number_equations,
    same_states,
    set_out,
    settle,
    take_step,
)
from .newton import SLIDING as SLIDES
from .on_ways import differentiate, judge_on_way, on_way


class Way(NamedTuple):
    """How forces are sought.

    Attributes
    ----------
    stiffness : float
        That of a contact in units of that of its own compliance.
    again : bool
        Whether it starts from the forces of the last step, not from those of the sweeps.
    second_order : bool
        Whether slips of the last steps count.
    searches : bool
        Whether steps are searched along. Whole steps pass kinks of the projection where a search would stop.
    steps : int
        Largest number of steps.
    guard : float
        Addition to the diagonal, see `factorise`, or 0 for a share of the residual. A larger one passes more kinks, and
        converges more slowly where equations are nearly singular.
    """

    stiffness: float
    again: bool
    second_order: bool
    searches: bool
    steps: int
    guard: float


# Ways that are tried in turn; those before any sweep, of which the last may leave a residual.
WAYS = (
    Way(1.0, True, True, False, 60, 0.0),
    Way(3.0, True, True, True, 60, 0.0),
    Way(1.0, True, True, True, 60, 0.0),
    Way(3.0, True, False, True, 100, 1e-6),
    Way(1.0, True, False, True, 100, 1e-6),
    Way(1.0, True, False, False, 100, 1e-4),
    Way(0.3, True, True, True, 60, 1e-5),
    Way(3.0, False, False, True, 60, 1e-5),
    Way(10.0, True, False, False, 40, 1e-5),
    Way(10.0, False, False, True, 60, 1e-5),
)
AT_ONCE = 6
# Residual, relative to the largest force, that it may leave: the step is then counted as unsolved.
CLOSE = 1e-6
# Share of the residual, relative to the largest force, that is added to the diagonal, and the limits of this addition.
GUARD, LEAST_GUARD, MOST_GUARD = 0.1, 1e-13, 1e-5
# Largest number of halvings of a step.
HALVINGS = 6
# Residual, relative to the largest force, below which the forces are found, and rounding of motions.
FOUND, ROUNDING = 1e-12, 1e-15
# Number of steps in which the residual must fall so far for factors to be kept, fewer where the states are those of the
# last step: then the next one may use them, too.
PATIENT, PATIENT_STEADY = 8, 3
# Steps after which directions of friction are unknowns anyhow.
STRICT = 12
# Whether a slip ends in the step, and with forces before its end.
GOES_ON, ENDS_PLAINLY, ENDS_WITH_APEX = range(3)
# Most rounds in which slips that end are found. Their ends move in each of the first steps, then where the residual has
# fallen to a share of the last change of forces before them, for a share of the steps; the change, relative to the
# largest force, at which they are settled.
ROUNDS, FREELY, FALLEN, MOVING, SETTLED = 4, 8, 0.1, 0.7, 1e-8


@inlined
def all_under_coulomb(codes: Array) -> bool:
    """Return whether all contacts have Coulomb's law."""
    others = 0
    for code in codes:
        others += 0 if code == at.COULOMB else 1
    return others == 0


@inlined
def column(k: int, along_a: int, along_b: int) -> int:
    """Return the column of tangent `k`."""
    return along_a if k == 0 else along_b


@inlined
def number_of(array: Array, row: int, one: int, runs: Runs) -> float:
    """Return the number of a run in lane `one`."""
    return lane(held(array, row, runs), one)


@inlined
def set_number(array: Array, row: int, one: int, number: float, runs: Runs) -> None:
    """Set the number of a run in lane `one`."""
    hold(array, row, runs, with_lane(held(array, row, runs), one, number))


@called
def put_contact(face: Face, way: Way, contacts: Contacts, carried: Array, i: int, one: int, runs: Runs) -> None:
    """Set the numbers of contact `i` in lane `one`: its ratio, its motion, its last slips and forces."""
    now, rows, n, here, base = contacts.now, face.rows, face.first[i], i * at.IN_STEP, i * at.CARRIED
    status = number_of(carried, base + at.STATUS, one, runs)
    was_closed = status > 0.5 * STICKING
    rows[RATIO, n] = number_of(contacts.constants, i * at.CONTACT_CONSTANTS + at.AT_REST, one, runs)
    rows[WAS, n], rows[ENDS, n] = status, GOES_ON
    rows[GIVE, n], rows[BEYOND, n], rows[APEX, n] = 0.0, 0.0, 0.0
    rows[BROKE, n], rows[LET_GO, n] = 0.0, number_of(now, here + at.LET_GO, one, runs)
    last = number_of(carried, base + at.LAST_NORMAL, one, runs) if was_closed else 0.0
    rows[FORCES, n] = last if way.again else number_of(now, here + at.NORMAL_NOW, one, runs)
    rows[FREE, n] = number_of(now, here + at.FREE_GAP, one, runs)
    for k in range(face.first[i + 1] - n - 1):
        put_tangent(face, way, contacts, carried, i, k, one, runs)


@inlined
def put_tangent(face: Face, way: Way, contacts: Contacts, carried: Array, i: int, k: int, one: int, runs: Runs) -> None:
    """Do `put_contact` for a tangent."""
    now, rows, n, here, base = contacts.now, face.rows, face.first[i], i * at.IN_STEP, i * at.CARRIED
    m, status = n + 1 + k, rows[WAS, n]
    was = number_of(carried, base + column(k, at.LAST_TANGENTIAL, at.LAST_TANGENTIAL_B), one, runs)
    found = number_of(now, here + column(k, at.TANGENTIAL_NOW, at.TANGENTIAL_NOW_B), one, runs)
    rows[FORCES, m] = -((was if status > 0.5 * STICKING else 0.0) if way.again else found)
    rows[FREE, m] = number_of(now, here + column(k, at.FREE_SLIP, at.FREE_SLIP_B), one, runs)
    last = number_of(carried, base + column(k, at.LAST_SLIP, at.LAST_SLIP_B), one, runs)
    earlier = number_of(carried, base + column(k, at.EARLIER_SLIP, at.EARLIER_SLIP_B), one, runs)
    material, anchor = column(k, at.MATERIAL, at.MATERIAL_B), column(k, at.ANCHOR, at.ANCHOR_B)
    shift = lane(strayed(carried, base, material, anchor, runs), one)
    carries_on = way.second_order and contacts.codes[i] == at.COULOMB
    if carries_on and face.first[i + 1] - n > 2 and abs(status - STICKING) > 0.5:
        shift = (6.0 * last + earlier) / 9.0
    rows[LAST, m], rows[APEX, m], rows[SHIFT, m], rows[WAY, m] = last, 0.0, shift, 0.0


@called
def soften(face: Face, contacts: Contacts, carried: Array, i: int, one: int, step: float, runs: Runs) -> None:
    """Set how contact `i` yields about its indentation in lane `one`."""
    yields = yields_of(i, contacts.constants, runs)
    if not lane(yields.stiffness, one) > 0.0:
        return
    rows, n, path = face.rows, face.first[i], path_of(i, carried, runs)
    inside = -rows[MOTIONS, n]
    # Without the forces of the contact itself it is deeper.
    deeper = inside
    for k in range(n, face.first[i + 1]):
        deeper += face.soft[k, n] * rows[FORCES, k]
    alike = with_lane(held(carried, i * at.CARRIED + at.LAST_GAP, runs), one, 0.0)
    share = share_of(with_lane(alike, one, deeper), path, yields)
    soft = with_lane(alike, one, face.soft[n, n])
    give, beyond = give_of(with_lane(alike, one, inside), path, yields, share, soft, step, runs.zero)
    rows[GIVE, n], rows[BEYOND, n] = lane(give, one), lane(beyond, one)


@called
def end_slip(face: Face, i: int) -> float:
    """Set the forces of contact `i` up to the end of its slip (5d); return their change.

    They are those with which it would slide on, times the share of the step before the end.
    """
    rows, n, size = face.rows, face.first[i], 0.0
    own = face.first[i + 1] - n
    for k in range(n + 1, n + own):
        size += rows[LAST, k] * rows[LAST, k]
    size = math.sqrt(size)
    gap = rows[MOTIONS, n] + rows[BEYOND, n]
    for k in range(n, n + own):
        gap -= face.soft[k, n] * rows[FORCES, k]
    clear = face.soft[n, n] + rows[GIVE, n]
    for k in range(n + 1, n + own):
        clear -= rows[RATIO, n] * face.soft[k, n] * rows[LAST, k] / size
    on = max(-gap / clear, 0.0) if clear > 0.0 else 0.0
    farther = 0.0
    for k in range(n + 1, n + own):
        slip = rows[MOTIONS, k] + on * face.soft[n, k] - face.soft[n, k] * rows[FORCES, n]
        for m in range(n + 1, n + own):
            slip -= face.soft[m, k] * (rows[FORCES, m] + rows[RATIO, n] * on * rows[LAST, m] / size)
        farther += slip * rows[LAST, k] / size
    share = size / (size - farther) if farther < 0.0 else 0.0
    changed = abs(share * on - rows[APEX, n])
    rows[APEX, n] = share * on
    for k in range(n + 1, n + own):
        rows[APEX, k] = -rows[RATIO, n] * share * on * rows[LAST, k] / size
    return changed


@called
def find_ends(face: Face, codes: Array) -> int:
    """Mark slips that end or turn round in this step, from the forces found with those of the last steps.

    Return their number. For them the slip of this step counts.
    """
    rows, found = face.rows, 0
    for i in range(face.first.size - 1):
        n, own = face.first[i], face.first[i + 1] - face.first[i]
        stuck = abs(rows[WAS, n] - STICKING) < 0.5
        if codes[i] != at.COULOMB or rows[ENDS, n] != GOES_ON or stuck or rows[STATE, n] == OPEN:
            continue
        slid, size, forward, on = rows[WAS, n] > SLIDING - 0.5, 0.0, 0.0, 0.0
        for k in range(n + 1, n + own):
            size += rows[LAST, k] * rows[LAST, k]
            forward -= rows[WAY, k] * rows[MOTIONS, k]
            on -= rows[WAY, k] * rows[LAST, k]
        slides = rows[STATE, n] != HELD
        if slides and forward >= 0.0 and (not slid or on >= 0.0):
            continue
        if not slid and own == 2:
            continue
        for k in range(n + 1, n + own):
            rows[SHIFT, k] = 0.0
        rows[ENDS, n] = ENDS_WITH_APEX if slid and size > 0.0 else ENDS_PLAINLY
        found += 1
    return found


@called
def evaluate(
    space: bool | None,
    face: Face,
    contacts: Contacts,
    carried: Array,
    one: int,
    step: float,
    ends_move: bool,
    runs: Runs,
) -> tuple[float, float, float]:
    """Set states, yielding and ends of slips; return the residual, the largest force, and how far ends have moved."""
    left, largest, moved, rows = 0.0, 0.0, 0.0, face.rows
    for i in range(face.first.size - 1):
        n = face.first[i]
        soften(face, contacts, carried, i, one, step, runs)
        if ends_move and rows[ENDS, n] == ENDS_WITH_APEX:
            moved = max(moved, end_slip(face, i))
        if contacts.codes[i] == at.COULOMB:
            left += judge(face, i, rows[FACTORS, 1])
        else:
            contact = on_way(face, i, contacts, carried, one, step, runs)
            left += judge_on_way(space, face, i, contact, rows[FACTORS, 1])
        largest = max(largest, rows[FORCES, n])
    return math.sqrt(left), largest, moved


@called
def differentiate_all(
    space: bool | None, face: Face, contacts: Contacts, carried: Array, one: int, step: float, runs: Runs
) -> None:
    """Set how friction changes with normal force and slips of each contact for which it may matter."""
    for i in range(face.first.size - 1):
        state, slides_with_state = face.rows[STATE, face.first[i]], not set_valued(contacts.codes[i])
        if state == WHOLE or (state == SLIDES and slides_with_state):
            differentiate(space, face, i, on_way(face, i, contacts, carried, one, step, runs))


@called
def let_go(face: Face) -> None:
    """Hold no contact that has broken away in this step by its static coefficient any more."""
    for i in range(face.first.size - 1):
        if face.rows[BROKE, face.first[i]] > 0.5:
            face.rows[LET_GO, face.first[i]] = 1.0


@called
def forget_ends(face: Face) -> None:
    """Let the slip of the step alone count where slips end: many that end together may not settle."""
    for i in range(face.first.size - 1):
        if face.rows[ENDS, face.first[i]] == ENDS_WITH_APEX:
            face.rows[ENDS, face.first[i]] = ENDS_PLAINLY
            for k in range(face.first[i], face.first[i + 1]):
                face.rows[APEX, k] = 0.0


@called
def keep_old(face: Face) -> None:
    """Keep forces and motions before a step."""
    rows = face.rows
    for k in range(rows.shape[1]):
        rows[OLD_FORCES, k], rows[OLD_MOTIONS, k] = rows[FORCES, k], rows[MOTIONS, k]


@called
def halve(face: Face) -> None:
    """Take back half of a step."""
    rows = face.rows
    for k in range(rows.shape[1]):
        rows[FORCES, k] = 0.5 * (rows[FORCES, k] + rows[OLD_FORCES, k])
        rows[MOTIONS, k] = 0.5 * (rows[MOTIONS, k] + rows[OLD_MOTIONS, k])


@called
def rounding_of(face: Face) -> float:
    """Return the rounding of forces that motions without forces bring."""
    farthest = 0.0
    for i in range(face.first.size - 1):
        n = face.first[i]
        farthest = max(farthest, abs(face.rows[FREE, n]) / face.soft[n, n])
    return ROUNDING * farthest


@called
def find_forces(
    space: bool | None, face: Face, way: Way, contacts: Contacts, carried: Array, one: int, timing: Timing, runs: Runs
) -> tuple[int, float]:
    """Change the forces until they are found; return the number of steps, and the residual, 0 if they are."""
    set_out(face, way.stiffness)
    factors, rounding, ends_move, before, halvings = face.rows[FACTORS], rounding_of(face), True, math.inf, 0
    # A step may reach one of the last residuals again.
    second, third, fourth, fresh, patience = math.inf, math.inf, math.inf, False, PATIENT
    moved, missed, largest = 0.0, math.inf, 0.0
    for trial in range(way.steps):
        move_now = ends_move and (trial < FREELY or before <= max(FALLEN * moved, SETTLED * largest))
        if trial == STRICT:
            let_go(face)
        left, largest, farther = evaluate(space, face, contacts, carried, one, timing.step, move_now, runs)
        if move_now:
            moved, second, third, fourth = farther, math.inf, math.inf, math.inf
        if ends_move and trial > MOVING * way.steps and moved > SETTLED * largest:
            forget_ends(face)
            ends_move = False
            continue
        ends_move = ends_move and trial <= MOVING * way.steps
        settled = not ends_move or (move_now and moved <= FOUND * largest)
        # Where many forces close the same gaps, rounding may leave more than is asked for.
        stalls = left <= timing.tolerance * largest and left > 0.1 * before
        if (stalls or left <= FOUND * largest + rounding) and settled:
            return trial, 0.0
        missed = left / largest if largest > 0.0 else math.inf
        if not left < math.inf or trial + 1 == way.steps:
            break
        # A step along which the residual nowhere falls is taken short.
        if way.searches and halvings < HALVINGS and not left <= max(before, second, third, fourth):
            halve(face)
            halvings += 1
            continue
        alike = factors[0] > 0.0 and same_states(face)
        if trial == 0:
            patience = PATIENT_STEADY if alike else PATIENT
        if not alike or left * (left / before) ** patience > FOUND * largest:
            # With the directions of friction as unknowns where these factors, of this step, are too slow.
            swift = SWIFTER if trial >= STRICT or (alike and fresh) else SWIFT
            if swift != factors[1]:
                factors[1] = swift
                left, largest, _ = evaluate(space, face, contacts, carried, one, timing.step, False, runs)
            differentiate_all(space, face, contacts, carried, one, timing.step, runs)
            size = number_equations(face)
            guard = max(LEAST_GUARD, min(GUARD * missed, MOST_GUARD)) if way.guard == 0.0 else way.guard
            fresh = factorise(face, size, guard)
            factors[0] = float(size) if fresh else 0.0
            if not fresh:
                break
        before, second, third, fourth, halvings = left, before, second, third, 0
        if way.searches:
            keep_old(face)
        settle(face, 0.1 * FOUND * largest)
        take_step(face, int(factors[0]))
    return way.steps, missed


@called
def jams(face: Face, n: int, own: int) -> bool:
    """Return whether a contact that is held would press itself open by sliding."""
    pulled, lifted = 0.0, 0.0
    for k in range(n + 1, n + own):
        pulled += face.rows[FORCES, k] ** 2
        lifted -= face.soft[k, n] * face.rows[FORCES, k]
    return pulled > 0.0 and face.soft[n, n] * math.sqrt(pulled) <= face.rows[RATIO, n] * lifted


@called
def accept(face: Face, contacts: Contacts, one: int, runs: Runs) -> None:
    """Set forces, states and displacements of all contacts to those found."""
    now, rows = contacts.now, face.rows
    for i in range(face.first.size - 1):
        here, n, own = i * at.IN_STEP, face.first[i], face.first[i + 1] - face.first[i]
        normal, state = max(rows[FORCES, n], 0.0), rows[STATE, n]
        status = 0.0 if normal == 0.0 else float(STICKING if state == HELD else SLIDING)
        set_number(now, here + at.NORMAL_NOW, one, normal, runs)
        set_number(now, here + at.STATUS_NOW, one, status, runs)
        set_number(now, here + at.JAMMED_NOW, one, 1.0 if status == STICKING and jams(face, n, own) else 0.0, runs)
        set_number(now, here + at.GIVE, one, rows[GIVE, n], runs)
        set_number(now, here + at.BEYOND, one, rows[BEYOND, n], runs)
        if normal > 0.0:
            set_number(now, here + at.MAY_TOUCH, one, 1.0, runs)
        for k in range(n, n + own):
            moved = with_lane(component(contacts.faces, k, DISPLACEMENT, runs), one, rows[MOTIONS, k])
            set_component(contacts.faces, k, DISPLACEMENT, runs, moved)
        on_its_way = contacts.codes[i] != at.COULOMB
        if on_its_way:
            set_number(now, here + at.STATUS_NOW, one, rows[STATUS, n] if normal > 0.0 else 0.0, runs)
            set_number(now, here + at.JAMMED_NOW, one, rows[JAMS, n] if normal > 0.0 else 0.0, runs)
            set_number(now, here + at.LET_GO, one, rows[LET_GO, n], runs)
        for k in range(own - 1):
            pulled = rows[FORCES, n + 1 + k] if normal > 0.0 else 0.0
            if status == SLIDING and not on_its_way:
                pulled = rows[APEX, n + 1 + k] + rows[RATIO, n] * (normal - rows[APEX, n]) * rows[WAY, n + 1 + k]
            set_number(now, here + column(k, at.TANGENTIAL_NOW, at.TANGENTIAL_NOW_B), one, -pulled, runs)


@called
def seek(
    space: bool | None,
    face: Face,
    way: Way,
    contacts: Contacts,
    carried: Array,
    one: int,
    timing: Timing,
    runs: Runs,
) -> tuple[int, float]:
    """Seek the forces of all contacts of the run in lane `one`; return the number of steps, and the residual."""
    for i in range(face.first.size - 1):
        put_contact(face, way, contacts, carried, i, one, runs)
    made, missed = 0, 0.0
    for _ in range(ROUNDS):
        steps, missed = find_forces(space, face, way, contacts, carried, one, timing, runs)
        made += steps
        if missed != 0.0 or not way.second_order or find_ends(face, contacts.codes) == 0:
            break
    return made, missed


@called
def solve_together(
    space: bool | None,
    contacts: Contacts,
    carried: Array,
    sizes: Sizes,
    attempts: tuple[int, int],
    tried: Number,
    timing: Timing,
    runs: Runs,
) -> tuple[Number, Number, Number]:
    """Seek the forces of all contacts in runs `tried` in some of the ways.

    Return where they are found, the number of steps, and the residual, relative to the largest force.
    """
    found, made, left, numbers = runs.zero, runs.zero, runs.zero, sizes.rows
    for one in range(lanes_of(runs.zero)):
        if lane(tried, one) > 0.5:
            dense = contacts.dense[runs.first + one]
            soft = rows_of_run(contacts.faces, COMPLIANCE, one, runs)
            face = Face(soft, dense[:numbers], dense[numbers:], contacts.rows)
            for attempt in range(attempts[0], attempts[1]):
                most = CLOSE if attempt - attempts[0] == AT_ONCE - 1 else 0.0
                steps, missed = seek(space, face, WAYS[attempt % len(WAYS)], contacts, carried, one, timing, runs)
                if missed <= most:
                    accept(face, contacts, one, runs)
                    found, made = with_lane(found, one, 1.0), with_lane(made, one, float(steps))
                    left = with_lane(left, one, missed)
                    break
    return found, made, left
