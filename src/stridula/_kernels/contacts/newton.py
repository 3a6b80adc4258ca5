"""Forces of many contacts together: steps of Newton's method, on plain arrays.

Each contact has a normal force and one or two tangential ones, with the signs with which they act on the modes,
``(normal, -tangential)``. Under Coulomb's law they are an apex, which is given, plus forces ``y`` within the cone of
friction, for which ``y = P(y - r w)``: `w` are the gap, and the slips plus a shift; `r` is a stiffness of the contact,
and ``P`` the projection on its cone, along its axis for the normal force and within the disc of that radius for the
tangential one (Alart & Curnier 1991). The step is semi-smooth: an open contact has no unknown; one that sticks has all
its forces; one that slides has its normal force and, where it moves slowly, the force across the direction in which
friction acts. For contacts under other laws see `on_ways`.
"""

import math
from typing import NamedTuple

from ..lanes.compiled import called, inlined
from ..lanes.operations import Array, fused
from .elimination import add_product, eliminate, substitute

# Rows of numbers, one for each force: motions without forces, forces, motions under them; apex, shift of the slips,
# last slips, direction of friction; equations, right sides, rows of pivots; forces and motions before a step, to
# restore; motions of a column; motions in an equation: a number, its share and that of the number after it.
(
    FREE,
    FORCES,
    MOTIONS,
    APEX,
    SHIFT,
    LAST,
    WAY,
    EQUATION,
    RIGHT,
    PIVOT,
    OLD_FORCES,
    OLD_MOTIONS,
    COLUMN,
    PLACE,
    SHARE,
    NEXT_SHARE,
) = range(16)
# Numbers of a contact, at its first number.
RATIO, STIFFNESS, GIVE, BEYOND, STATE, KEPT, FACTORISED, WAS, ENDS, STATUS, JAMS, BROKE, LET_GO, COUPLED = range(16, 30)
# Of a contact under another law, for its tangents: ratio of forces, what the forces miss under the normal force, the
# change of friction with the normal force, and the inverse of that with the slips.
PULL, MISSED, BY_NORMAL, INVERSE_A, INVERSE_B = range(30, 35)
# Of the run: size of the system whose factors are kept from step to step, 0 without one, and the largest friction of
# which the direction is not an unknown in it.
FACTORS = 35
ROWS = 36

# States of a contact in a step: open, held, sliding with its normal force as unknown, sliding with two unknowns, and
# with friction that depends on its slips.
OPEN, HELD, SLIDING, TURNING, WHOLE = range(5)
# Largest friction, in units of the force that undoes the slip, of which the direction is that of the slip, not an
# unknown: in first steps, which find the states of contacts, and in later ones.
SWIFT, SWIFTER = 0.25, 1e-4

# A normal force and tangential ones, or changes of them; the last is zero in the plane.
Vector = tuple[float, float, float]


class Face(NamedTuple):
    """Contacts of a run.

    Attributes
    ----------
    soft : ndarray, shape (numbers, numbers)
        Compliance: a row of displacements for a unit of each force.
    matrix : ndarray, shape (numbers, numbers)
        Equations of a step: a row for each unknown.
    rows : ndarray, shape (ROWS, numbers)
        Numbers.
    first : ndarray of int, shape (contacts + 1,)
        First number of each contact, that of its normal force, and the end of the last.
    """

    soft: Array
    matrix: Array
    rows: Array
    first: Array


@called
def add_three(out: Array, first: Array, second: Array, third: Array, factors: Vector) -> None:
    """Add multiples of three rows."""
    f, g, h = factors
    for k in range(out.size):
        out[k] = fused(f, first[k], fused(g, second[k], fused(h, third[k], out[k])))


@inlined
def add_motions(face: Face, out: Array, n: int, two: bool, forces: Vector) -> None:
    """Add the motions under forces of the contact whose numbers begin with `n`."""
    size = out.size
    if two:
        add_three(out, face.soft[n, :size], face.soft[n + 1, :size], face.soft[n + 2, :size], forces)
    else:
        add_product(out, face.soft[n, :size], forces[0])
        add_product(out, face.soft[n + 1, :size], forces[1])


@called
def move(face: Face, i: int, changes: Vector) -> None:
    """Add changes to the forces of contact `i`, and to all motions what they do."""
    rows, n, two = face.rows, face.first[i], face.first[i + 1] - face.first[i] > 2
    rows[FORCES, n] += changes[0]
    rows[FORCES, n + 1] += changes[1]
    if two:
        rows[FORCES, n + 2] += changes[2]
    if changes[0] != 0.0 or changes[1] != 0.0 or changes[2] != 0.0:
        add_motions(face, rows[MOTIONS], n, two, changes)


@called
def set_out(face: Face, stiffness: float) -> None:
    """Set the stiffnesses, in units of those of the own compliance of a contact, and the motions under the forces."""
    rows = face.rows
    for k in range(rows.shape[1]):
        rows[MOTIONS, k] = rows[FREE, k]
    for i in range(face.first.size - 1):
        n, soft, own = face.first[i], 0.0, face.first[i + 1] - face.first[i]
        for k in range(n, n + own):
            soft += face.soft[k, k]
        rows[STIFFNESS, n] = stiffness * own / soft
        if rows[FORCES, n] != 0.0:
            forces = rows[FORCES, n], rows[FORCES, n + 1], rows[FORCES, n + 2] if own > 2 else 0.0
            add_motions(face, rows[MOTIONS], n, own > 2, forces)


@inlined
def gap_of(face: Face, n: int) -> float:
    """Return the gap of the contact whose numbers begin with `n`, as it yields."""
    rows = face.rows
    return rows[MOTIONS, n] + rows[BEYOND, n] + rows[GIVE, n] * rows[FORCES, n]


@called
def judge(face: Face, i: int, swift: float) -> float:
    """Set state and direction of contact `i`; return the square of what its forces miss.

    It slides with a given direction if its friction is below a share `swift` of the force that undoes the slip.
    """
    rows, n = face.rows, face.first[i]
    two, stiff, normal = face.first[i + 1] - n > 2, rows[STIFFNESS, n], rows[FORCES, n] - rows[APEX, n]
    first, second = rows[FORCES, n + 1] - rows[APEX, n + 1], rows[FORCES, n + 2] - rows[APEX, n + 2] if two else 0.0
    missed = stiff / (1.0 + stiff * rows[GIVE, n]) * gap_of(face, n)
    pressed = normal - missed
    rows[KEPT, n] = 1.0
    if pressed <= 0.0:
        rows[STATE, n] = OPEN
        return normal * normal + first * first + second * second
    slip, across = rows[MOTIONS, n + 1] + rows[SHIFT, n + 1], 0.0
    if two:
        across = rows[MOTIONS, n + 2] + rows[SHIFT, n + 2]
    along_a, along_b = first - stiff * slip, second - stiff * across
    size, radius = math.sqrt(along_a * along_a + along_b * along_b), rows[RATIO, n] * pressed
    rows[STATE, n] = HELD
    if size > radius:
        kept, fast = radius / size, stiff * math.sqrt(slip * slip + across * across)
        rows[KEPT, n] = kept
        rows[STATE, n] = TURNING if two and radius > swift * fast else SLIDING
        rows[WAY, n + 1] = along_a / size
        if two and rows[STATE, n] == TURNING:
            rows[WAY, n + 2] = along_b / size
        elif two:
            rows[WAY, n + 1], rows[WAY, n + 2] = -stiff * slip / fast, -stiff * across / fast
        along_a, along_b = kept * along_a, kept * along_b
    first, second = first - along_a, second - along_b
    return missed * missed + first * first + second * second


@called
def settle(face: Face, least: float) -> None:
    """Do what needs no equation: open contacts lose their forces, friction of sliding ones has its direction.

    Changes up to `least` are left to later steps.
    """
    rows = face.rows
    for i in range(face.first.size - 1):
        n, state = face.first[i], rows[STATE, face.first[i]]
        two = face.first[i + 1] - n > 2
        normal, first = rows[FORCES, n] - rows[APEX, n], rows[FORCES, n + 1] - rows[APEX, n + 1]
        second = rows[FORCES, n + 2] - rows[APEX, n + 2] if two else 0.0
        if state == OPEN:
            move(face, i, (-normal, -first, -second))
        elif state in (SLIDING, TURNING):
            way, aside = rows[WAY, n + 1], rows[WAY, n + 2] if two else 0.0
            pulled = rows[RATIO, n] * normal
            if state == TURNING:
                # Its force across the direction is an unknown.
                pulled -= first * way + second * aside
                first, second = 0.0, 0.0
            first, second = pulled * way - first, pulled * aside - second
            if abs(first) + abs(second) > least:
                move(face, i, (0.0, first, second))


@called
def number_equations(face: Face) -> int:
    """Number the unknown forces, and equations, of contacts in their states; return their number."""
    rows, size = face.rows, 0
    for i in range(face.first.size - 1):
        n, state = face.first[i], rows[STATE, face.first[i]]
        rows[EQUATION, n] = size
        if state == OPEN:
            continue
        size = put_equation(face, size, n, 1.0, 0.0)
        if state in (HELD, WHOLE):
            for k in range(n + 1, face.first[i + 1]):
                size = put_equation(face, size, k, 1.0, 0.0)
        elif state == TURNING:
            size = put_equation(face, size, n + 1, -rows[WAY, n + 2], rows[WAY, n + 1])
    return size


@inlined
def put_equation(face: Face, size: int, place: int, share: float, next_share: float) -> int:
    """Set the motions in the next equation, shares of a number and of that after it; return their number."""
    face.rows[PLACE, size], face.rows[SHARE, size], face.rows[NEXT_SHARE, size] = place, share, next_share
    return size + 1


@called
def same_states(face: Face) -> bool:
    """Return whether contacts have the states with which the matrix was factorised."""
    for i in range(face.first.size - 1):
        if face.rows[STATE, face.first[i]] != face.rows[FACTORISED, face.first[i]]:
            return False
    return True


@called
def put_column(face: Face, unknown: int, size: int, n: int, two: bool, forces: Vector) -> None:
    """Put the motions for a unit of a combination of the forces of a contact into the equations."""
    rows, column, out = face.rows, face.rows[COLUMN], face.matrix[unknown]
    for k in range(column.size):
        column[k] = 0.0
    add_motions(face, column, n, two, forces)
    last = column.size - 1
    for row in range(size):
        place = int(rows[PLACE, row])
        after = min(place + 1, last)
        out[row] = rows[SHARE, row] * column[place] + rows[NEXT_SHARE, row] * column[after]


@inlined
def turning_stiffness(face: Face, n: int) -> float:
    """Return the slip across the direction of friction for a unit of force across, at which this keeps its size."""
    kept = face.rows[KEPT, n]
    return (1.0 - kept) / (kept * face.rows[STIFFNESS, n])


@inlined
def undo(face: Face, n: int, row: int, friction: tuple[float, float], two: bool) -> float:
    """Return the slip, along the tangent of a row of the inverse, that changes friction so far."""
    slip = face.rows[row, n + 1] * friction[0]
    if two:
        slip += face.rows[row, n + 2] * friction[1]
    return slip


@called
def put_friction(face: Face, i: int, at: int) -> None:
    """Put friction that depends on the slips into the equations of contact `i`, from row `at` on.

    The slips are those without its own forces.
    """
    n, own = face.first[i], face.first[i + 1] - face.first[i]
    by_normal = face.rows[BY_NORMAL, n + 1], face.rows[BY_NORMAL, n + 2] if own > 2 else 0.0
    for k in range(own):
        friction = by_normal if k == 0 else (1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0)
        for m in range(1, own):
            slip = undo(face, n, INVERSE_A if m == 1 else INVERSE_B, friction, own > 2)
            face.matrix[at + k, at + m] += slip - face.soft[n + k, n + m]


@called
def factorise(face: Face, size: int, guard: float) -> bool:
    """Set the matrix of contacts in their states, and factorise it; return whether it is regular.

    The guard is added to the diagonal, relative to it: the step has the least change of forces where many close the
    same gaps.
    """
    rows, matrix = face.rows, face.matrix
    for i in range(face.first.size - 1):
        n, state, two = face.first[i], rows[STATE, face.first[i]], face.first[i + 1] - face.first[i] > 2
        rows[FACTORISED, n] = state
        if state == OPEN:
            continue
        at, mu, mean = int(rows[EQUATION, n]), rows[RATIO, n], 1.0 / rows[STIFFNESS, n]
        way, aside = rows[WAY, n + 1], rows[WAY, n + 2] if two else 0.0
        whole = state in (HELD, WHOLE)
        pulled = (0.0, 0.0) if whole else (mu * way, mu * aside)
        put_column(face, at, size, n, two, (1.0, pulled[0], pulled[1]))
        matrix[at, at] += rows[GIVE, n] + guard * (mean + rows[GIVE, n])
        if whole:
            for k in range(1, face.first[i + 1] - n):
                put_column(face, at + k, size, n, two, (0.0, 1.0 if k == 1 else 0.0, 1.0 if k == 2 else 0.0))
                matrix[at + k, at + k] += guard * mean
            if state == WHOLE:
                put_friction(face, i, at)
        elif state == TURNING:
            put_column(face, at + 1, size, n, two, (0.0, -aside, way))
            matrix[at + 1, at + 1] += turning_stiffness(face, n) + guard * mean
    return eliminate(matrix, rows[PIVOT], size)


@called
def take_step(face: Face, size: int) -> None:
    """Solve the factorised equations for the changes of the forces, and make them."""
    rows = face.rows
    right = rows[RIGHT]
    for i in range(face.first.size - 1):
        n, state = face.first[i], rows[STATE, face.first[i]]
        if state == OPEN:
            continue
        at, two = int(rows[EQUATION, n]), face.first[i + 1] - n > 2
        right[at] = -gap_of(face, n)
        if state == HELD:
            for k in range(1, face.first[i + 1] - n):
                right[at + k] = -(rows[MOTIONS, n + k] + rows[SHIFT, n + k])
        elif state == WHOLE:
            missed = rows[MISSED, n + 1], rows[MISSED, n + 2] if two else 0.0
            right[at + 1] = -undo(face, n, INVERSE_A, missed, two)
            if two:
                right[at + 2] = -undo(face, n, INVERSE_B, missed, two)
        elif state == TURNING:
            way, aside = rows[WAY, n + 1], rows[WAY, n + 2]
            slip, swerved = rows[MOTIONS, n + 1] + rows[SHIFT, n + 1], rows[MOTIONS, n + 2] + rows[SHIFT, n + 2]
            first, second = rows[FORCES, n + 1] - rows[APEX, n + 1], rows[FORCES, n + 2] - rows[APEX, n + 2]
            soft = turning_stiffness(face, n)
            right[at + 1] = -(way * swerved - aside * slip) - soft * (way * second - aside * first)
    substitute(face.matrix, rows[PIVOT], right, size)
    for i in range(face.first.size - 1):
        n, state = face.first[i], rows[STATE, face.first[i]]
        if state == OPEN:
            continue
        at, two = int(rows[EQUATION, n]), face.first[i + 1] - n > 2
        pressed = right[at]
        if state in (HELD, WHOLE):
            move(face, i, (pressed, right[at + 1], right[at + 2] if two else 0.0))
            continue
        pulled, swerved = rows[RATIO, n] * pressed, right[at + 1] if state == TURNING else 0.0
        way, aside = rows[WAY, n + 1], rows[WAY, n + 2] if two else 0.0
        move(face, i, (pressed, pulled * way - swerved * aside, pulled * aside + swerved * way))
