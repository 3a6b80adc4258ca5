"""The piece of a curve in which a value lies."""

from ..lanes.compiled import strict_pasted
from ..lanes.operations import Array, Number


@strict_pasted
def piece_at(table: Array, row: int, first: int, pieces: int, value: Number) -> int:
    """Return the piece in which a value lies, of those between rising numbers from `first` on.

    Beyond the ends it is the first or the last.
    """
    low, high = 0, pieces
    while high - low > 1:
        middle = (low + high) // 2
        if table[row, first + middle] <= value:
            low = middle
        else:
            high = middle
    return low
