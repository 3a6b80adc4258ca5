"""Checks of arguments: messages name in one line the argument, what is allowed and the value."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from difflib import get_close_matches
from itertools import pairwise
from numbers import Integral, Real
from typing import Any, TypeVar

T = TypeVar("T")
# States of a contact, as numbers from 0 on in records.
STATUS_WORDS = ("separated", "sticking", "sliding")
# Longest value that a message shows in full.
LONGEST = 80
# Longest list of names in a message, unless the first name alone is longer.
LONGEST_LIST = 160
# A turn [rad], with a margin for rounding.
WHOLE_TURN = 2.0 * math.pi * (1.0 + 1e-9)
_UNSAID: Any = object()


class ArgumentError(ValueError):
    """An argument with a value that is not allowed: ``"<argument> must <allowed>, got <value>"``.

    Parameters
    ----------
    argument : str
        Name of the argument.
    allowed : str
        Requirement, the words after "must".
    value : object, optional
        Given value; left out where there is nothing to show.
    got : object, optional
        Text that the message shows in place of the value.
    where : str, optional
        Owner of the argument, where several have it: a prefix of the message.

    Attributes
    ----------
    argument, allowed, got, where : str
        As given; `got` is empty where there is nothing to show.
    value : object
        Given value, None if the message does not show one.
    """

    def __init__(self, argument: str, allowed: str, value: Any = _UNSAID, *, got: Any = None, where: str = "") -> None:
        self.argument, self.allowed, self.where = argument, allowed, where
        self.value = None if value is _UNSAID else value
        self.got = str(got) if got is not None else "" if value is _UNSAID else brief(value)
        words = f"{argument} must {allowed}" + (f", got {self.got}" if self.got else "")
        super().__init__(f"{where}: {words}" if where else words)

    def renamed(self, argument: str) -> ArgumentError:
        """Return the same error under another name: that of an option, a key or the argument of another function."""
        return ArgumentError(argument, self.allowed, self.value, got=self.got, where=self.where)

    def inside(self, where: str) -> ArgumentError:
        """Return the same error with its owner, one of several that have such an argument."""
        inner = f"{where}: {self.where}" if self.where else where
        return ArgumentError(self.argument, self.allowed, self.value, got=self.got, where=inner)

    def __reduce__(self) -> tuple[Any, ...]:
        # A value that another process may not be able to read is passed on as text.
        value = self.value if isinstance(self.value, (str, Real, type(None))) else self.got
        return _argument_error, (self.argument, self.allowed, value, self.got, self.where)


def _argument_error(argument: str, allowed: str, value: Any, got: str, where: str) -> ArgumentError:
    return ArgumentError(argument, allowed, value, got=got, where=where)


def finite(name: str, value: Any) -> float:
    """Return `value` as a float if it is a finite real number."""
    # It is tested first since the check for a Real takes ten times as long.
    if type(value) is not float and (isinstance(value, bool) or not isinstance(value, Real)):
        raise ArgumentError(name, "be a number", value)
    if not _is_finite(value):
        raise ArgumentError(name, "be finite", value)
    return float(value)


def _is_finite(number: Real | float) -> bool:
    try:
        return math.isfinite(number)
    except OverflowError:
        return False


def rising(name: str, values: Sequence[float]) -> None:
    """Raise ValueError unless each value is above the one before it."""
    for number, (before, after) in enumerate(pairwise(values), start=1):
        if after <= before:
            raise ArgumentError(f"{name}[{number}]", f"be above {before!r}, the one before it", after)


def positive(name: str, value: Any) -> float:
    """Return `value` as a float if it is finite and above zero."""
    number = finite(name, value)
    if number <= 0.0:
        raise ArgumentError(name, "be above 0", value)
    return number


def non_negative(name: str, value: Any) -> float:
    """Return `value` as a float if it is finite and not below zero."""
    number = finite(name, value)
    if number < 0.0:
        raise ArgumentError(name, "be 0 or above", value)
    return number


def within(name: str, value: Any, low: float, high: float, *, ends: bool = True) -> float:
    """Return `value` as a float if it lies between `low` and `high` (ends included or not)."""
    number = finite(name, value)
    inside = low <= number <= high if ends else low < number < high
    if not inside:
        least, most = bounds(low, high)
        words = f"from {least} to {most}" if ends else f"strictly between {least} and {most}"
        raise ArgumentError(name, f"be {words}", value)
    return number


def within_a_turn(name: str, value: Any) -> float:
    """Return an angle [rad] as a float if it is at most a turn in either sense: degrees are refused."""
    number = finite(name, value)
    if abs(number) > WHOLE_TURN:
        raise ArgumentError(name, "be from -2 pi to 2 pi rad", value)
    return number


def count(name: str, value: Any, low: int = 1, high: int | None = None) -> int:
    """Return `value` as an int if it is a whole number of at least `low`, and at most `high` if that is given."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise ArgumentError(name, "be a whole number", value)
    if value < low:
        raise ArgumentError(name, f"be at least {low}", value)
    if high is not None and int(value) > high:
        raise ArgumentError(name, f"be at most {high}", value)
    return int(value)


def choice(name: str, value: Any, allowed: Sequence[str]) -> str:
    """Return `value` if it is one of the words in `allowed`."""
    if not isinstance(value, str) or value not in allowed:
        got = f"{brief(value)}{suggestion(value, allowed)}"
        raise ArgumentError(name, f"be one of {', '.join(allowed)}", value, got=got)
    return str(value)


def one_or_each(name: str, value: Any, check: Callable[[str, Any], T], size: int | None = None) -> T | tuple[T, ...]:
    """Return `value` as `check` does, or each of a sequence of values, of length `size` if that is given."""
    if isinstance(value, str) or not (hasattr(value, "__len__") and hasattr(value, "__getitem__")):
        return check(name, value)
    if size is not None and len(value) != size:
        raise ArgumentError(name, f"have one value for each contact, {size} in all", value)
    return tuple(check(f"{name}[{number}]", one) for number, one in enumerate(value))


def instance(name: str, value: Any, kinds: type | tuple[type, ...]) -> None:
    """Raise if `value` is not an instance of one of `kinds`."""
    if not isinstance(value, kinds):
        words = " or ".join(kind.__name__ for kind in (kinds if isinstance(kinds, tuple) else (kinds,)))
        raise ArgumentError(name, f"be {_article(words)} {words}", value)


def by_key(name: str, value: Any) -> Mapping[str, Any]:
    """Return values by key, an empty mapping for None."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise ArgumentError(name, "be values by key", value)
    for key in value:
        if not isinstance(key, str):
            raise ArgumentError(name, "have keys that are text", key)
    return value


def brief(value: Any) -> str:
    """Return the repr of a value; a long text cut, any other long value as its kind and name."""
    try:
        text = repr(value)
    except Exception:
        # A whole number of 5000 digits has no repr, and the repr of other classes may raise anything.
        text = ""
    if text and "\n" not in text and len(text) <= LONGEST:
        return text
    if isinstance(value, str):
        return f"{text[: LONGEST - 3]}..."
    kind, name = type(value).__name__, getattr(value, "name", None)
    return f"{_article(kind)} {kind}" + (f" named {name!r}" if name and isinstance(name, str) else "")


def at_most(limit: float, digits: int = 6) -> str:
    """Return a limit in few digits, rounded down: a value that satisfies it also satisfies the limit."""
    return _rounded(limit, digits, ROUND_FLOOR)


def at_least(limit: float, digits: int = 6) -> str:
    """Return a limit in few digits, rounded up: a value that satisfies it also satisfies the limit."""
    return _rounded(limit, digits, ROUND_CEILING)


def bounds(low: float, high: float, digits: int = 6) -> tuple[str, str]:
    """Return the ends of a range in few digits, rounded inwards; in more digits where nothing would be left."""
    for enough in (digits, 9, 12):
        least, most = at_least(low, enough), at_most(high, enough)
        if float(least) < float(most):
            return least, most
    return repr(low), repr(high)


def _rounded(limit: float, digits: int, way: str) -> str:
    # Rounds the shortest decimal of the number, so that 0.1 stays 0.1 either way.
    near = Context(prec=digits, rounding=way).plus(Decimal(repr(float(limit))))
    return f"{float(near):.{digits}g}"


def listed(words: Iterable[str], joint: str = ", ", longest: int = LONGEST_LIST) -> str:
    """Return the first few of many words and the number of the others; ``none`` if there is none."""
    every = list(words) or ["none"]
    shown = every[:1]
    for word in every[1:]:
        if len(joint.join([*shown, word])) > longest:
            break
        shown.append(word)
    others = len(every) - len(shown)
    return joint.join(shown) + (f" and {others} other{'s' if others > 1 else ''}" if others else "")


def counted(number: int, thing: str) -> str:
    """Return a number of things, such as ``1 mode`` and ``2 modes``."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"


def _article(word: str) -> str:
    return "an" if word[0] in "AEIOaeio" else "a"


def suggestion(word: Any, known: Sequence[str]) -> str:
    """Return ``"; did you mean 'x'?"`` for the known word nearest to `word`, or nothing; long texts are ignored."""
    nearest = get_close_matches(word, known, n=1, cutoff=0.6) if _is_word(word) else []
    return f"; did you mean {nearest[0]!r}?" if nearest else ""


def _is_word(value: Any) -> bool:
    return isinstance(value, str) and len(value) <= LONGEST


def in_one_line(error: BaseException, longest: int = LONGEST_LIST) -> str:
    """Return the message of an exception in one line, cut if it is long; its kind if the message is empty."""
    words = " ".join(str(error).split()) or type(error).__name__
    return words if len(words) <= longest else f"{words[: longest - 3]}..."
