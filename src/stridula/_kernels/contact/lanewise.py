"""Functions of the numbers of one run, done for each lane of vectors, and operations on all numbers in tuples."""

from collections.abc import Callable
from typing import Any, TypeVar

import numba

from ..lanes.compiled import overloaded, strict
from ..lanes.operations import choose, lane, spread, with_lane
from ..lanes.vectors import LANES, VECTOR
from ..layout.contact_values import HeatedLaw, Law, Profile

# Stubs lack what types of tuples have.
types: Any = numba.core.types
F = TypeVar("F", bound=Callable[..., Any])
T = TypeVar("T")


def lane_of(values: T, i: int) -> T:
    """Return the numbers in a lane of vectors, in tuples if these are; what all runs share stays as it is."""
    return values


def with_lane_of(values: T, i: int, numbers: T) -> T:
    """Return vectors in tuples with other numbers in a lane."""
    return numbers


def spread_of(numbers: T) -> T:
    """Return vectors in tuples with a number in every lane."""
    return numbers


def choose_all(condition: bool, yes: T, no: T) -> T:
    """Do `choose` for each of the numbers in tuples."""
    return yes if condition else no


def _written(kind: Any, of_kind: Callable[..., str | None], makers: dict[str, Any], *values: str) -> str:
    """Return an expression for tuples of a type, from those of `of_kind` for what is in them; add their classes."""
    known = of_kind(kind, *values)
    if known is not None:
        return known
    members = (_written(one, of_kind, makers, *(f"{value}[{k}]" for value in values)) for k, one in enumerate(kind))
    if not isinstance(kind, types.BaseNamedTuple):
        return f"({', '.join(members)},)"
    make = kind.instance_class
    makers[make.__name__] = make
    return f"{make.__name__}({', '.join(members)})"


def _expanded(arguments: str, kind: Any, of_kind: Callable[..., str | None], *values: str) -> Any:
    """Return a function that does for tuples of a type, written out, what `of_kind` says for what is in them."""
    names = {one.__name__: one for one in (choose, lane, spread, with_lane, HeatedLaw, Law, Profile)}
    written = _written(kind, of_kind, names, *values)
    return eval(f"lambda {arguments}: {written}", names)


def _in_lane(kind: Any, value: str) -> str | None:
    if kind is VECTOR:
        return f"lane({value}, i)"
    if isinstance(kind, types.BaseNamedTuple) and "row" in kind.fields:
        # The numbers of each run have a row.
        members = (_in_lane(one, f"{value}.{name}") for name, one in zip(kind.fields, kind, strict=True))
        rows = (f"{one} + i" if name == "row" else one for name, one in zip(kind.fields, members, strict=True))
        return f"{kind.instance_class.__name__}({', '.join(map(str, rows))})"
    return None if isinstance(kind, types.BaseTuple) else value


@overloaded(lane_of)
def _lane_of(values: Any, i: Any) -> Any:
    return _expanded("values, i", values, _in_lane, "values")


@overloaded(with_lane_of)
def _with_lane_of(values: Any, i: Any, numbers: Any) -> Any:
    def put(kind: Any, value: str, number: str) -> str | None:
        return f"with_lane({value}, i, {number})" if kind is VECTOR else None

    return _expanded("values, i, numbers", values, put, "values", "numbers")


@overloaded(spread_of)
def _spread_of(numbers: Any) -> Any:
    def put(kind: Any, number: str) -> str | None:
        return None if isinstance(kind, types.BaseTuple) else f"spread({number})"

    return _expanded("numbers", numbers, put, "numbers")


@overloaded(choose_all)
def _choose_all(condition: Any, yes: Any, no: Any) -> Any:
    def chosen(kind: Any, one: str, other: str) -> str | None:
        return None if isinstance(kind, types.BaseTuple) else f"choose(condition, {one}, {other})"

    return _expanded("condition, yes, no", yes, chosen, "yes", "no")


def _has_vector(kind: Any) -> bool:
    return kind is VECTOR or (isinstance(kind, types.BaseTuple) and any(map(_has_vector, kind)))


def lanewise(nothing: Any) -> Callable[[F], F]:
    """Let a function of the numbers of one run take vectors, too.

    Parameters
    ----------
    nothing : float or tuple
        A result of the type of those of the function: a number, or numbers in tuples.
    """

    def declare(function: F) -> F:
        of_one: Any = strict(function)

        @strict
        def of_runs(arguments: Any) -> Any:
            results = spread_of(nothing)
            for i in range(LANES):
                results = with_lane_of(results, i, of_one(*lane_of(arguments, i)))
            return results

        def either(*arguments: Any) -> Any:
            return of_one(*arguments)

        @overloaded(either)
        def _either(*arguments: Any) -> Any:
            if any(map(_has_vector, arguments)):
                return lambda *arguments: of_runs(arguments)
            return lambda *arguments: of_one(*arguments)

        either.__doc__ = function.__doc__
        # As numba's functions have: the card compiles it for one run.
        either.py_func = function  # type: ignore[attr-defined]
        return either  # type: ignore[return-value]

    return declare
