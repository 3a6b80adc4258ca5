"""Elementary operations of the march, on vectors of modes or runs where the processor has them.

A vector holds `LANES` modes of one run, or one mode of `LANES` runs. A quantity of a run is a number in the first case
and a vector in the second; functions take the type from an argument `like`, whose value does not matter. In plain
Python and on a graphics card all values are numbers: one mode of one run.
"""

import inspect
import math

from numba.core import types
from numba.extending import overload


def placed(place):
    """Return a zero of the type of the numbers of a run, the first run and the number of columns.

    Compiled code marches a single run if `place` is None, and a vector of runs if it is True; elsewhere it is one run
    of several, and their number.
    """
    return 0.0, place[0], place[1]


def load(rows, k, row, run):
    """Return a row of block `k`, of the runs from `run` on."""
    return rows[k, row, run]


def store(rows, k, row, run, value):
    """Put modes into a row of block `k`."""
    rows[k, row, run] = value


def entry(rows, k, row, run, like):
    """Return number `k` of a row that spans all blocks, for each run."""
    return rows[k, row, run]


def set_entry(rows, k, row, run, value):
    """Set number `k` of a row that spans all blocks, for each run."""
    rows[k, row, run] = value


def component(rows, k, row, run, like):
    """Return number `k` of a row that is contiguous over all blocks, for each run."""
    return rows[row, k, run]


def set_component(rows, k, row, run, value):
    """Set number `k` of a row that is contiguous over all blocks, for each run."""
    rows[row, k, run] = value


def read(array, row, column, like):
    """Return the number of a run, or of each of several, from a row of `array`."""
    return array[row, column]


def write(array, row, column, value):
    """Set the number of a run, or of each of several, in a row of `array`."""
    array[row, column] = value


def held(array, row, run, like):
    """Return the number of a run, or of each of several, from a row of an array with one number for each run."""
    return array[row, run]


def hold(array, row, run, value):
    """Set the number of a run, or of each of several, in a row of an array with one number for each run."""
    array[row, run] = value


def spread(value):
    """Return a number in every lane."""
    return value


def total(value, like):
    """Return the sum over the modes in a vector, for each run in it."""
    return value


def choose(condition, yes, no):
    """Return `yes` where `condition` holds, `no` elsewhere."""
    return yes if condition else no


def fused(a, b, c):
    """Return ``a b + c``, rounded once where the processor can, the same everywhere in the code."""
    return a * b + c


def whole(value):
    """Return the largest whole number not above `value`."""
    return math.floor(value)


def magnitude(value):
    """Return the absolute value."""
    return abs(value)


def anywhere(condition):
    """Return whether `condition` holds in any lane."""
    return condition


def everywhere(condition):
    """Return whether `condition` holds in all lanes."""
    return condition


def lane(value, i):
    """Return the number in a lane of a vector."""
    return value


def with_lane(value, i, number):
    """Return a vector with another number in a lane."""
    return number


# Compiled versions for numbers of one run; those for vectors are in `vectors`.


def _for_numbers(function, accepts):
    """Let compiled code call the plain function on numbers."""

    def implementation(*kinds):
        return function if accepts(*kinds) else None

    implementation.__signature__ = inspect.signature(function)
    overload(function)(implementation)


def _is_number(*kinds):
    return all(isinstance(kind, (types.Number, types.Boolean)) for kind in kinds)


# One run has its numbers in blocks as wide as a vector.
WIDTH, SHIFT = 8, 3


@overload(placed)
def _placed(place):
    # Constants let the compiler know all strides; converted, they have no literal types, each of which is a kind apart.
    if isinstance(place, types.NoneType):
        return lambda place: (0.0, types.int64(0), types.int64(1))
    return lambda place: (spread(0.0), types.int64(0), types.int64(WIDTH))


@overload(entry)
def _entry(rows, k, row, run, like):
    if not _is_number(like):
        return lambda rows, k, row, run, like: load(rows, k, row, run)
    return lambda rows, k, row, run, like: rows[k >> SHIFT, row, k & (WIDTH - 1)]


@overload(set_entry)
def _set_entry(rows, k, row, run, value):
    if not _is_number(value):
        return lambda rows, k, row, run, value: store(rows, k, row, run, value)

    def implementation(rows, k, row, run, value):
        rows[k >> SHIFT, row, k & (WIDTH - 1)] = value

    return implementation


@overload(component)
def _component(rows, k, row, run, like):
    if not _is_number(like):
        return lambda rows, k, row, run, like: load(rows, row, k, run)
    return lambda rows, k, row, run, like: rows[row, k >> SHIFT, k & (WIDTH - 1)]


@overload(set_component)
def _set_component(rows, k, row, run, value):
    if not _is_number(value):
        return lambda rows, k, row, run, value: store(rows, row, k, run, value)

    def implementation(rows, k, row, run, value):
        rows[row, k >> SHIFT, k & (WIDTH - 1)] = value

    return implementation


@overload(held)
def _held(array, row, run, like):
    # The numbers of a single run lie in a row of its own.
    return (lambda array, row, run, like: array[row]) if _is_number(like) else None


@overload(hold)
def _hold(array, row, run, value):
    if not _is_number(value):
        return None

    def implementation(array, row, run, value):
        array[row] = value

    return implementation


_for_numbers(read, lambda array, row, column, like: _is_number(like))
_for_numbers(write, lambda array, row, column, value: _is_number(value))
_for_numbers(lane, lambda value, i: _is_number(value))
for _function in (choose, magnitude, anywhere, everywhere):
    _for_numbers(_function, _is_number)
