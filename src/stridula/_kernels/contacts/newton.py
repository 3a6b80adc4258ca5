"""Forces of all contacts together under Coulomb's law, by Newton's method, where sweeps do not settle.

With friction against the slip of the step, forces solve ``x = P(x - r u(x))``: ``u`` are gaps and slips, ``r`` a
stiffness of each contact, and ``P`` the projection on its cone of friction, along its axis for the normal force and
within the disc of that radius for the tangential one (Alart & Curnier 1991). Semi-smooth Newton; the step has the least
change of forces where many close the same gaps (Levenberg & Marquardt). Forces have the signs with which they act on
the modes, ``(normal, -tangential)``; each contact has 2 or 3 successive numbers.
"""

import math
from typing import NamedTuple

from ..lanes.compiled import called, strict
from ..lanes.operations import Array, Pair

# Rows of numbers: gaps and slips without forces, forces, gaps and slips under them, the changes of both in a step, the
# right side, the places of the unknowns; at the first number of a contact the ratio at rest, and its stiffness.
FREE, FORCES, MOTIONS, MORE_FORCES, MORE_MOTIONS, RIGHT, PLACES, RATIO, STIFFNESS = range(9)
ROWS = 9

# Largest number of steps, and that of halvings of one.
STEPS, HALVINGS = 40, 10
# Residual, relative to the largest force, below which the forces are found, and the decrease asked of a step.
FOUND, DECREASE = 1e-12, 1e-4
# Smallest and largest addition to the diagonal of the matrix.
LEAST_GUARD, MOST_GUARD = 1e-9, 0.1


class Face(NamedTuple):
    """Contacts of a run: compliance and slopes of the residual, (numbers, numbers), rows, and numbers of a contact."""

    compliance: Array
    slopes: Array
    rows: Array
    own: int


class Way(NamedTuple):
    """How forces are sought.

    Attributes
    ----------
    stiffness : float
        That of a contact in units of that of its own compliance.
    guard : float
        Addition to the diagonal per relative residual.
    searches : bool
        Whether steps are searched along. Whole steps pass kinks of the projection where a search would stop.
    """

    stiffness: float
    guard: float
    searches: bool


class Projected(NamedTuple):
    """Forces of a contact to project, the radius of the disc, and what the projection leaves: normal, tangents."""

    normal: float
    pulled: Pair
    size: float
    radius: float
    left: float
    missed: Pair


@strict
def face_of(dense: Array, count: int, own: int) -> Face:
    """Return the parts of an array, shape (2 numbers + ROWS, numbers)."""
    n = count * own
    return Face(dense[:n, :n], dense[n : 2 * n, :n], dense[2 * n :, :n], own)


@called
def project(face: Face, n: int, share: float) -> Projected:
    """Project the forces of the contact whose numbers begin with `n`, after a share of the step."""
    rows, stiff = face.rows, face.rows[STIFFNESS, n]
    force = rows[FORCES, n] + share * rows[MORE_FORCES, n]
    normal = force - stiff * (rows[MOTIONS, n] + share * rows[MORE_MOTIONS, n])
    first, second, across = rows[FORCES, n + 1] + share * rows[MORE_FORCES, n + 1], 0.0, 0.0
    along = first - stiff * (rows[MOTIONS, n + 1] + share * rows[MORE_MOTIONS, n + 1])
    if face.own > 2:
        second = rows[FORCES, n + 2] + share * rows[MORE_FORCES, n + 2]
        across = second - stiff * (rows[MOTIONS, n + 2] + share * rows[MORE_MOTIONS, n + 2])
    pressed, size = max(normal, 0.0), math.hypot(along, across)
    radius = rows[RATIO, n] * pressed
    kept = radius / size if size > radius else 1.0
    missed = first - kept * along, second - kept * across
    return Projected(normal, (along, across), size, radius, force - pressed, missed)


@called
def residual(face: Face, share: float) -> Pair:
    """Return the size of the residual after a share of the step, and the largest force."""
    left, largest = 0.0, 0.0
    for n in range(0, len(face.compliance), face.own):
        one = project(face, n, share)
        left += one.left * one.left + one.missed[0] * one.missed[0] + one.missed[1] * one.missed[1]
        largest = max(largest, one.normal)
    return math.sqrt(left), largest


@called
def set_out(face: Face, way: Way) -> None:
    """Set stiffnesses, and the displacements under the forces."""
    compliance, rows, own = face.compliance, face.rows, face.own
    for n in range(0, len(compliance), own):
        soft = 0.0
        for k in range(n, n + own):
            soft += compliance[k, k]
        rows[STIFFNESS, n] = way.stiffness * own / soft
    for k in range(len(compliance)):
        moved = rows[FREE, k]
        for j in range(len(compliance)):
            moved += compliance[k, j] * rows[FORCES, j]
        rows[MOTIONS, k] = moved
        rows[MORE_FORCES, k], rows[MORE_MOTIONS, k] = 0.0, 0.0


@called
def number_unknowns(face: Face) -> int:
    """Number the forces that may change; return their number."""
    rows, size = face.rows, 0
    for n in range(0, len(face.compliance), face.own):
        acts = project(face, n, 0.0).normal > 0.0
        for k in range(n, n + face.own):
            acts = acts or rows[FORCES, k] != 0.0
        if acts:
            for k in range(n, n + face.own):
                rows[PLACES, size] = k
                size += 1
    return size


@called
def fill(face: Face, size: int, guard: float) -> None:
    """Set the slopes of the residual, a row for each unknown, and the right side."""
    rows, slopes, own = face.rows, face.slopes, face.own
    for k in range(0, size, own):
        n = int(rows[PLACES, k])
        one, stiff, at_rest = project(face, n, 0.0), rows[STIFFNESS, n], rows[RATIO, n]
        slides = one.size > one.radius
        kept = one.radius / one.size if slides else 1.0
        along, across = (one.pulled[0] / one.size, one.pulled[1] / one.size) if slides else (0.0, 0.0)
        for j in range(size):
            row = int(rows[PLACES, j])
            # Change of the argument of the projection with the unknown, then of the projection.
            pressed, pulled = -stiff * face.compliance[n, row], -stiff * face.compliance[n + 1, row]
            swerved = -stiff * face.compliance[n + 2, row] if own > 2 else 0.0
            pressed += 1.0 if j == k else 0.0
            pulled += 1.0 if j == k + 1 else 0.0
            swerved += 1.0 if j == k + 2 and own > 2 else 0.0
            if one.normal <= 0.0:
                pressed, pulled, swerved = 0.0, 0.0, 0.0
            elif slides:
                on = along * pulled + across * swerved
                pulled = kept * (pulled - along * on) + at_rest * along * pressed
                swerved = kept * (swerved - across * on) + at_rest * across * pressed
            slopes[k, j] = -pressed
            slopes[k + 1, j] = -pulled
            if own > 2:
                slopes[k + 2, j] = -swerved
        for line in range(k, k + own):
            slopes[line, line] += 1.0 + (guard if one.normal > 0.0 else 0.0)
        rows[RIGHT, k], rows[RIGHT, k + 1] = -one.left, -one.missed[0]
        if own > 2:
            rows[RIGHT, k + 2] = -one.missed[1]


@called
def solve_linear(matrix: Array, right: Array, size: int) -> bool:
    """Solve a linear system in place by elimination with the largest pivots; return whether it is regular."""
    for k in range(size):
        best = k
        for line in range(k + 1, size):
            if abs(matrix[line, k]) > abs(matrix[best, k]):
                best = line
        if not abs(matrix[best, k]) > 0.0:
            return False
        if best != k:
            for column in range(k, size):
                matrix[k, column], matrix[best, column] = matrix[best, column], matrix[k, column]
            right[k], right[best] = right[best], right[k]
        for line in range(k + 1, size):
            factor = matrix[line, k] / matrix[k, k]
            if factor != 0.0:
                for column in range(k + 1, size):
                    matrix[line, column] -= factor * matrix[k, column]
                right[line] -= factor * right[k]
    for back in range(size):
        k = size - 1 - back
        found = right[k]
        for column in range(k + 1, size):
            found -= matrix[k, column] * right[column]
        right[k] = found / matrix[k, k]
    return True


@called
def put_changes(face: Face, size: int) -> None:
    """Set the changes of the forces and of the displacements in the step that was solved for."""
    rows, compliance = face.rows, face.compliance
    for k in range(len(compliance)):
        rows[MORE_FORCES, k] = 0.0
    for k in range(size):
        rows[MORE_FORCES, int(rows[PLACES, k])] = rows[RIGHT, k]
    for k in range(len(compliance)):
        moved = 0.0
        for j in range(len(compliance)):
            moved += compliance[k, j] * rows[MORE_FORCES, j]
        rows[MORE_MOTIONS, k] = moved


@called
def take_step(face: Face, share: float) -> None:
    """Change forces and displacements by a share of the step."""
    rows = face.rows
    for k in range(len(face.compliance)):
        rows[FORCES, k] += share * rows[MORE_FORCES, k]
        rows[MOTIONS, k] += share * rows[MORE_MOTIONS, k]
        rows[MORE_FORCES, k], rows[MORE_MOTIONS, k] = 0.0, 0.0


@strict
def find_forces(face: Face, way: Way) -> bool:
    """Change the forces until they are found; return whether they are."""
    set_out(face, way)
    left, largest = residual(face, 0.0)
    # A step may reach one of the last residuals again.
    second, third, fourth, fifth = left, left, left, left
    for _ in range(STEPS):
        if left <= FOUND * largest:
            return True
        size = number_unknowns(face)
        relative = left / largest if largest > 0.0 else 1.0
        fill(face, size, min(MOST_GUARD, max(LEAST_GUARD, way.guard * relative)))
        if not solve_linear(face.slopes, face.rows[RIGHT], size):
            return False
        put_changes(face, size)
        share, most, was = 1.0, max(left, second, third, fourth, fifth), left
        left, largest = residual(face, share)
        for _ in range(HALVINGS if way.searches else 0):
            if left <= (1.0 - DECREASE * share) * most:
                break
            share *= 0.5
            left, largest = residual(face, share)
        if way.searches and not left <= most:
            return False
        take_step(face, share)
        second, third, fourth, fifth = was, second, third, fourth
    return False
