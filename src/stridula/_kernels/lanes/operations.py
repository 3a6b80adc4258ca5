"""Elementary operations of the march, on vectors of modes or runs where the processor has them.

A vector holds `LANES` modes of one run, or one mode of `LANES` runs. A quantity of a run is a number in the first case
and a vector in the second, the type of the `zero` of the `runs` that march. In plain Python and on a graphics card all
values are numbers: one mode of one run.
"""

import inspect
import math
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numba.core import types
from numba.extending import overload
from numpy.typing import NDArray

from .compiled import inlined, overloaded

Array: TypeAlias = NDArray[Any]
# A number of one run, or a vector with one for each of several.
Number: TypeAlias = float
Numbers: TypeAlias = tuple[Number, ...]
# One for each of two tangents.
Pair: TypeAlias = tuple[Number, Number]


# Conversions of constants, which then have no literal types, for each of which functions would be compiled again.
INTEGER: Any = np.int64
TRUTH: Any = np.bool_


class Runs(NamedTuple):
    """The runs that march together.

    Attributes
    ----------
    first, columns : int
        The first of them, and the number of columns of arrays with one for each run.
    zero : float or vector
        Zero for each.
    """

    first: int
    columns: int
    zero: Number


def placed(place: tuple[int, int]) -> Runs:
    """Return the runs that march together.

    Compiled code marches a single run if `place` is None, and a vector of runs if it is True; elsewhere it is one run
    of several, and their number.
    """
    return Runs(place[0], place[1], 0.0)


def load(rows: Array, k: int, row: int, runs: Runs) -> Number:
    """Return a row of block `k`."""
    return rows[k, row, runs.first]


def store(rows: Array, k: int, row: int, runs: Runs, value: Number) -> None:
    """Put modes into a row of block `k`."""
    rows[k, row, runs.first] = value


def entry(rows: Array, k: int, row: int, runs: Runs) -> Number:
    """Return number `k` of a row that spans all blocks, for each run."""
    return rows[k, row, runs.first]


def set_entry(rows: Array, k: int, row: int, runs: Runs, value: Number) -> None:
    """Set number `k` of a row that spans all blocks, for each run."""
    rows[k, row, runs.first] = value


def component(rows: Array, k: int, row: int, runs: Runs) -> Number:
    """Return number `k` of a row that is contiguous over all blocks, for each run."""
    return rows[row, k, runs.first]


def set_component(rows: Array, k: int, row: int, runs: Runs, value: Number) -> None:
    """Set number `k` of a row that is contiguous over all blocks, for each run."""
    rows[row, k, runs.first] = value


def read(array: Array, row: int, column: int, like: Number) -> Number:
    """Return the number of a run, or of each of several, from a row of `array`, of the type of `like`."""
    return array[row, column]


def write(array: Array, row: int, column: int, value: Number) -> None:
    """Set the number of a run, or of each of several, in a row of `array`."""
    array[row, column] = value


def held(array: Array, row: int, runs: Runs) -> Number:
    """Return the number of a run, or of each of several, from a row of an array with one number for each run."""
    return array[row, runs.first]


def hold(array: Array, row: int, runs: Runs, value: Number) -> None:
    """Set the number of a run, or of each of several, in a row of an array with one number for each run."""
    array[row, runs.first] = value


def spread(value: Number) -> Number:
    """Return a number in every lane."""
    return value


def total(value: Number, like: Number) -> Number:
    """Return the sum over the modes in a vector, for each run in it, of the type of `like`."""
    return value


def choose(condition: bool, yes: Number, no: Number) -> Number:
    """Return `yes` where `condition` holds, `no` elsewhere."""
    return yes if condition else no


def fused(a: Number, b: Number, c: Number) -> Number:
    """Return ``a b + c``, rounded once where the processor can, the same everywhere in the code."""
    return a * b + c


def whole(value: Number) -> Number:
    """Return the largest whole number not above `value`."""
    return math.floor(value)


def magnitude(value: Number) -> Number:
    """Return the absolute value."""
    return abs(value)


def anywhere(condition: bool) -> bool:
    """Return whether `condition` holds in any lane."""
    return condition


def everywhere(condition: bool) -> bool:
    """Return whether `condition` holds in all lanes."""
    return condition


def lane(value: Number, i: int) -> Number:
    """Return the number in a lane of a vector."""
    return value


def with_lane(value: Number, i: int, number: Number) -> Number:
    """Return a vector with another number in a lane."""
    return number


def rows_of_run(rows: Array, first: int, one: int, runs: Runs) -> Array:
    """Return the rows from `first` on, each contiguous over all blocks, of the run in lane `one`, as a matrix."""
    return rows[first:, :, runs.first]


def lanes_of(like: Number) -> int:
    """Return the number of runs of which a value has numbers."""
    return 1


# Compiled versions for numbers of one run; those for vectors are in `vectors`.


def _for_numbers(function: Any, accepts: Any) -> Any:
    """Let compiled code call the plain function on numbers."""

    def implementation(*kinds: Any) -> Any:
        return function if accepts(*kinds) else None

    implementation.__signature__ = inspect.signature(function)  # type: ignore[attr-defined]
    overload(function)(implementation)


def _is_number(*kinds: Any) -> bool:
    return all(isinstance(kind, (types.Number, types.Boolean)) for kind in kinds)


# One run has its numbers in blocks as wide as a vector.
WIDTH, SHIFT = 8, 3


@overloaded(placed)
def _placed(place: Any) -> Any:
    # Constants let the compiler know all strides.
    if isinstance(place, types.NoneType):
        return lambda place: Runs(INTEGER(0), INTEGER(1), 0.0)
    return lambda place: Runs(INTEGER(0), INTEGER(WIDTH), spread(0.0))


def of_one(runs: Any) -> bool:
    """Return whether a type of `Runs` is that of a single one."""
    return _is_number(runs[Runs._fields.index("zero")])


@overloaded(entry)
def _entry(rows: Any, k: Any, row: Any, runs: Any) -> Any:
    if not of_one(runs):
        return lambda rows, k, row, runs: load(rows, k, row, runs)
    return lambda rows, k, row, runs: rows[k >> SHIFT, row, k & (WIDTH - 1)]


@overloaded(set_entry)
def _set_entry(rows: Any, k: Any, row: Any, runs: Any, value: Any) -> Any:
    if not _is_number(value):
        return lambda rows, k, row, runs, value: store(rows, k, row, runs, value)

    def implementation(rows: Any, k: Any, row: Any, runs: Any, value: Any) -> None:
        rows[k >> SHIFT, row, k & (WIDTH - 1)] = value

    return implementation


@overloaded(component)
def _component(rows: Any, k: Any, row: Any, runs: Any) -> Any:
    if not of_one(runs):
        return lambda rows, k, row, runs: load(rows, row, k, runs)
    return lambda rows, k, row, runs: rows[row, k >> SHIFT, k & (WIDTH - 1)]


@overloaded(set_component)
def _set_component(rows: Any, k: Any, row: Any, runs: Any, value: Any) -> Any:
    if not _is_number(value):
        return lambda rows, k, row, runs, value: store(rows, row, k, runs, value)

    def implementation(rows: Any, k: Any, row: Any, runs: Any, value: Any) -> None:
        rows[row, k >> SHIFT, k & (WIDTH - 1)] = value

    return implementation


@overloaded(rows_of_run, returns_arrays=True)
def _rows_of_run(rows: Any, first: Any, one: Any, runs: Any) -> Any:
    if not of_one(runs):
        return lambda rows, first, one, runs: rows[first:, :, one]

    def implementation(rows: Any, first: Any, one: Any, runs: Any) -> Any:
        return rows[first:].reshape((rows.shape[0] - first, rows.shape[1] * rows.shape[2]))

    return implementation


@overloaded(held)
def _held(array: Any, row: Any, runs: Any) -> Any:
    # The numbers of a single run lie in a row of its own.
    return (lambda array, row, runs: array[row]) if of_one(runs) else None


@overloaded(hold)
def _hold(array: Any, row: Any, runs: Any, value: Any) -> Any:
    if not _is_number(value):
        return None

    def implementation(array: Any, row: Any, runs: Any, value: Any) -> None:
        array[row] = value

    return implementation


@inlined
def add(array: Array, row: int, runs: Runs, value: Number) -> None:
    """Add to a row."""
    hold(array, row, runs, held(array, row, runs) + value)


_for_numbers(read, lambda array, row, column, like: _is_number(like))
_for_numbers(write, lambda array, row, column, value: _is_number(value))
_for_numbers(lane, lambda value, i: _is_number(value))
_for_numbers(with_lane, lambda value, i, number: _is_number(value))
_for_numbers(lanes_of, _is_number)
for _function in (choose, magnitude, anywhere, everywhere):
    _for_numbers(_function, _is_number)
