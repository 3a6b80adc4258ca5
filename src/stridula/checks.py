"""Checks of arguments: each says in one line what was wrong, its value and what is allowed."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from difflib import get_close_matches
from numbers import Integral, Real
from typing import Any, TypeVar

T = TypeVar("T")
# What a contact does, as numbers from 0 on in records.
STATUS_WORDS = ("separated", "sticking", "sliding")
# Longest value that a message shows as it is written.
LONGEST = 80
# Longest list of names in a message, but for one that is longer.
LONGEST_LIST = 160


def finite(name: str, value: Any) -> float:
    """Return `value` as a float if it is a finite real number."""
    # Asking whether a thing is a Real takes ten times as long.
    if type(value) is not float and (isinstance(value, bool) or not isinstance(value, Real)):
        raise ValueError(f"{name} must be a number, got {value!r}")
    if not math.isfinite(value):
        raise ValueError(f"{name} must be finite, got {value!r}")
    return float(value)


def positive(name: str, value: Any) -> float:
    """Return `value` as a float if it is finite and above zero."""
    number = finite(name, value)
    if number <= 0.0:
        raise ValueError(f"{name} must be above 0, got {value!r}")
    return number


def non_negative(name: str, value: Any) -> float:
    """Return `value` as a float if it is finite and not below zero."""
    number = finite(name, value)
    if number < 0.0:
        raise ValueError(f"{name} must be 0 or above, got {value!r}")
    return number


def within(name: str, value: Any, low: float, high: float, *, ends: bool = True) -> float:
    """Return `value` as a float if it lies between `low` and `high` (ends included or not)."""
    number = finite(name, value)
    inside = low <= number <= high if ends else low < number < high
    if not inside:
        least, most = bounds(low, high)
        words = f"from {least} to {most}" if ends else f"strictly between {least} and {most}"
        raise ValueError(f"{name} must be {words}, got {value!r}")
    return number


def count(name: str, value: Any, low: int = 1) -> int:
    """Return `value` as an int if it is a whole number of at least `low`."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise ValueError(f"{name} must be a whole number, got {value!r}")
    if value < low:
        raise ValueError(f"{name} must be at least {low}, got {value!r}")
    return int(value)


def choice(name: str, value: Any, allowed: Sequence[str]) -> str:
    """Return `value` if it is one of the words in `allowed`."""
    if value not in allowed:
        raise ValueError(f"{name} must be one of {', '.join(allowed)}, got {value!r}{suggestion(value, allowed)}")
    return str(value)


def one_or_each(name: str, value: Any, check: Callable[[str, Any], T], size: int | None = None) -> T | tuple[T, ...]:
    """Return `value` as `check` does, or each of a sequence of them, which holds `size` if that is given."""
    if isinstance(value, str) or not (hasattr(value, "__len__") and hasattr(value, "__getitem__")):
        return check(name, value)
    if size is not None and len(value) != size:
        raise ValueError(f"{name} must hold one for each contact, {size} in all, got {value!r}")
    return tuple(check(f"{name}[{number}]", one) for number, one in enumerate(value))


def instance(name: str, value: Any, kinds: type | tuple[type, ...]) -> None:
    """Raise if `value` is not an instance of one of `kinds`."""
    if not isinstance(value, kinds):
        words = " or ".join(kind.__name__ for kind in (kinds if isinstance(kinds, tuple) else (kinds,)))
        raise ValueError(f"{name} must be {_article(words)} {words}, got {brief(value)}")


def brief(value: Any) -> str:
    """Return a value as it is written, or its kind and its name where that would be long."""
    text = repr(value)
    if "\n" not in text and len(text) <= LONGEST:
        return text
    kind, name = type(value).__name__, getattr(value, "name", None)
    return f"{_article(kind)} {kind}" + (f" named {name!r}" if name and isinstance(name, str) else "")


def at_most(limit: float, digits: int = 6) -> str:
    """Return a limit in few digits, not above it: what must be below or at most that is so."""
    return _rounded(limit, digits, ROUND_FLOOR)


def at_least(limit: float, digits: int = 6) -> str:
    """Return a limit in few digits, not below it: what must be above or at least that is so."""
    return _rounded(limit, digits, ROUND_CEILING)


def bounds(low: float, high: float, digits: int = 6) -> tuple[str, str]:
    """Return the ends of a range in few digits, rounded inwards; in more where that would leave nothing between."""
    for enough in (digits, 9, 12):
        least, most = at_least(low, enough), at_most(high, enough)
        if float(least) < float(most):
            return least, most
    return repr(low), repr(high)


def _rounded(limit: float, digits: int, way: str) -> str:
    # The shortest decimal that is the number, so that 0.1 is 0.1 either way.
    near = Context(prec=digits, rounding=way).plus(Decimal(repr(float(limit))))
    return f"{float(near):.{digits}g}"


def listed(words: Iterable[str], joint: str = ", ", longest: int = LONGEST_LIST) -> str:
    """Return the first few of many words, and how many others there are; ``none`` if there is none."""
    every = list(words) or ["none"]
    shown = every[:1]
    for word in every[1:]:
        if len(joint.join([*shown, word])) > longest:
            break
        shown.append(word)
    others = len(every) - len(shown)
    return joint.join(shown) + (f" and {others} other{'s' if others > 1 else ''}" if others else "")


def _article(word: str) -> str:
    return "an" if word[0] in "AEIOaeio" else "a"


def suggestion(word: Any, known: Sequence[str]) -> str:
    """Return ``"; did you mean 'x'?"`` for the known word nearest to `word`, or nothing."""
    nearest = get_close_matches(str(word), known, n=1, cutoff=0.6)
    return f"; did you mean {nearest[0]!r}?" if nearest else ""
