"""Linear systems of any size: elimination by columns with the largest pivots, and substitution.

A matrix is given transposed, ``matrix[column, row]``: columns are adjacent in memory.
"""

from ..lanes.compiled import called, inlined
from ..lanes.operations import Array, fused

# Smallest number on the diagonal, relative to the largest below it, that is taken as the pivot.
LEAST_PIVOT = 0.1


@called
def add_product(out: Array, column: Array, factor: float) -> None:
    """Add a multiple of a column."""
    for k in range(out.size):
        out[k] = fused(factor, column[k], out[k])


@called
def subtract_four(out: Array, first: Array, second: Array, third: Array, fourth: Array, factors: Array) -> None:
    """Subtract multiples of four columns."""
    f, g, h, i = factors[0], factors[1], factors[2], factors[3]
    for k in range(out.size):
        out[k] -= fused(f, first[k], g * second[k]) + fused(h, third[k], i * fourth[k])


@inlined
def exchange(column: Array, one: int, other: int) -> None:
    """Exchange two numbers of a column."""
    kept = column[one]
    column[one] = column[other]
    column[other] = kept


@called
def reduce_column(matrix: Array, c: int, size: int) -> None:
    """Subtract multiples of the columns before a column, such that it is zero above its diagonal."""
    column, k = matrix[c], 0
    while k + 4 <= c:
        for below in range(1, 4):
            for above in range(below):
                column[k + below] -= column[k + above] * matrix[k + above, k + below]
        rest, four = slice(k + 4, size), column[k : k + 4]
        subtract_four(
            column[rest], matrix[k][rest], matrix[k + 1][rest], matrix[k + 2][rest], matrix[k + 3][rest], four
        )
        k += 4
    while k < c:
        add_product(column[k + 1 : size], matrix[k, k + 1 : size], -column[k])
        k += 1


@called
def eliminate(matrix: Array, pivots: Array, size: int) -> bool:
    """Factorise a matrix in place, and set the row of each pivot; return whether it is regular."""
    exchanged = 0
    for c in range(size):
        column = matrix[c]
        for k in range(exchanged):
            exchange(column, k, int(pivots[k]))
        reduce_column(matrix, c, size)
        best, most = c, abs(column[c])
        for row in range(c + 1, size):
            if abs(column[row]) > most:
                best, most = row, abs(column[row])
        if not most > 0.0:
            return False
        if abs(column[c]) >= LEAST_PIVOT * most:
            best = c
        pivots[c] = best
        if best != c:
            exchanged = c + 1
            for k in range(c + 1):
                exchange(matrix[k], c, best)
        inverse = 1.0 / column[c]
        for row in range(c + 1, size):
            column[row] *= inverse
    return True


@called
def substitute(matrix: Array, pivots: Array, right: Array, size: int) -> None:
    """Solve a factorised system in place of its right side."""
    for k in range(size):
        exchange(right, k, int(pivots[k]))
    for k in range(size):
        add_product(right[k + 1 : size], matrix[k, k + 1 : size], -right[k])
    for back in range(size):
        k = size - 1 - back
        right[k] /= matrix[k, k]
        add_product(right[:k], matrix[k, :k], -right[k])
