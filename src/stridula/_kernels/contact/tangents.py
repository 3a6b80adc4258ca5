"""Vectors of the tangent plane of a contact in space, by their components along its tangents a and b."""

import math

from ..lanes.compiled import inlined, strict_pasted
from ..lanes.operations import Array, Number, Runs, choose, held, hold
from ..layout.contact_values import ComplianceInSpace, Matrix, Tangents

# The vector of length zero, and the direction of tangent a for vectors without one.
NOTHING, ALONG_A = Tangents(0.0, 0.0), Tangents(1.0, 0.0)


@inlined
def held_along(array: Array, a: int, b: int, runs: Runs) -> Tangents:
    """Return the vector whose components are in two rows of an array with one number for each run."""
    return Tangents(held(array, a, runs), held(array, b, runs))


@inlined
def hold_along(array: Array, a: int, b: int, runs: Runs, vector: Tangents) -> None:
    """Put the components of a vector into two rows of such an array."""
    hold(array, a, runs, vector.a)
    hold(array, b, runs, vector.b)


@inlined
def choose_along(condition: bool, yes: Tangents, no: Tangents) -> Tangents:
    """Return `yes` where `condition` holds, `no` elsewhere."""
    return Tangents(choose(condition, yes.a, no.a), choose(condition, yes.b, no.b))


@strict_pasted
def plus(first: Tangents, share: Number, other: Tangents) -> Tangents:
    """Return ``first + share other``."""
    return Tangents(first.a + share * other.a, first.b + share * other.b)


@strict_pasted
def scaled(share: Number, vector: Tangents) -> Tangents:
    """Return a vector times a number."""
    return Tangents(share * vector.a, share * vector.b)


@strict_pasted
def over(vector: Tangents, number: Number) -> Tangents:
    """Return a vector divided by a number."""
    return Tangents(vector.a / number, vector.b / number)


@strict_pasted
def along(vector: Tangents, way: Tangents) -> Number:
    """Return the component of a vector along a direction."""
    return vector.a * way.a + vector.b * way.b


@strict_pasted
def across(vector: Tangents, way: Tangents) -> Number:
    """Return the component of a vector across a direction, positive to its left."""
    return way.a * vector.b - way.b * vector.a


@strict_pasted
def left_of(way: Tangents) -> Tangents:
    """Return the direction across another one."""
    return Tangents(-way.b, way.a)


@strict_pasted
def size_of(vector: Tangents) -> Number:
    """Return the length of a vector."""
    return math.sqrt(vector.a * vector.a + vector.b * vector.b)


@strict_pasted
def direction_of(vector: Tangents, otherwise: Tangents) -> Tangents:
    """Return the direction of a vector, another one if it has none."""
    size = size_of(vector)
    return over(vector, size) if size > 0.0 else otherwise


@strict_pasted
def times(matrix: Matrix, vector: Tangents) -> Tangents:
    """Return the product of a matrix and a vector."""
    return Tangents(
        matrix.aa * vector.a + matrix.ab * vector.b,
        matrix.ba * vector.a + matrix.bb * vector.b,
    )


@strict_pasted
def scaled_matrix(share: Number, matrix: Matrix) -> Matrix:
    """Return a matrix times a number."""
    return Matrix(share * matrix.aa, share * matrix.ab, share * matrix.ba, share * matrix.bb)


@strict_pasted
def stiffened(size: Number, share: Number, matrix: Matrix) -> Matrix:
    """Return a number on the diagonal plus a share of a matrix."""
    return Matrix(size + share * matrix.aa, share * matrix.ab, share * matrix.ba, size + share * matrix.bb)


@strict_pasted
def of_tangents(w: ComplianceInSpace) -> Matrix:
    """Return the part of a compliance that couples forces and displacements along the tangents."""
    return Matrix(w.aa, w.ab, w.ba, w.bb)


@strict_pasted
def by_normal(w: ComplianceInSpace) -> Tangents:
    """Return the displacement along the tangents for a unit normal force."""
    return Tangents(w.an, w.bn)


@strict_pasted
def to_normal(w: ComplianceInSpace) -> Tangents:
    """Return the displacement along the normal for a unit force along each tangent."""
    return Tangents(w.na, w.nb)


@strict_pasted
def under_closed(w: ComplianceInSpace) -> Matrix:
    """Return the compliance of the tangents while the normal force keeps the gap."""
    return Matrix(
        w.aa - w.an * w.na / w.nn,
        w.ab - w.an * w.nb / w.nn,
        w.ba - w.bn * w.na / w.nn,
        w.bb - w.bn * w.nb / w.nn,
    )
