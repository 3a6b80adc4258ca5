"""Kinds of fields of a description: declared in `Annotated` beside each, checked here, read elsewhere."""

from __future__ import annotations

import dataclasses
import inspect
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, get_args, get_origin, get_type_hints

import numpy as np

from .arrays import Array, in_space
from .checks import ArgumentError, at_least, at_most, choice, count, finite, instance, one_or_each

_UNIT = re.compile(r"\s*\[([^\]]*)\]")
_NAMED_AFTER = re.compile(r"[A-Z]\w*'s\b")


@dataclass(frozen=True)
class Number:
    """A finite number in a range.

    Attributes
    ----------
    unit : str
        SI unit, "1" for a ratio.
    above, least, below : float or None
        Exclusive lower bound, inclusive lower bound, exclusive upper bound; no bound where None.
    meaning : str
        Meaning of `below`, for messages.
    """

    unit: str = "1"
    above: float | None = None
    least: float | None = None
    below: float | None = None
    meaning: str = ""

    def check(self, name: str, value: Any) -> float:
        """Return a value as a float if it is in the range."""
        number = finite(name, value)
        if self.above is not None and number <= self.above:
            raise ArgumentError(name, f"be above {at_least(self.above)}", value)
        if self.least is not None and number < self.least:
            raise ArgumentError(name, f"be {at_least(self.least)} or above", value)
        if self.below is not None and number >= self.below:
            meaning = f" ({self.meaning})" if self.meaning else ""
            raise ArgumentError(name, f"be below {at_most(self.below)}{meaning}", value)
        return number


@dataclass(frozen=True)
class Choice:
    """One of several words.

    Attributes
    ----------
    words : tuple of str
        The words.
    """

    words: tuple[str, ...]

    def check(self, name: str, value: Any) -> str:
        """Return a value if it is one of the words."""
        return choice(name, value, self.words)


@dataclass(frozen=True)
class Each:
    """A sequence of numbers, or of such sequences.

    Attributes
    ----------
    one : Number or OneOrEach
        Kind of each number.
    """

    one: Number | OneOrEach

    def check(self, name: str, value: Any) -> tuple[Any, ...]:
        """Return a sequence as a tuple if each number is in the range."""
        if isinstance(value, str) or not isinstance(value, (Sequence, np.ndarray)):
            raise ArgumentError(name, "be a list of numbers", value)
        rows = any(isinstance(one, (Sequence, np.ndarray)) for one in value)
        values = list(value) if rows else np.asarray(value).tolist()
        return tuple(self.one.check(f"{name}[{k}]", one) for k, one in enumerate(values))


@dataclass(frozen=True)
class OneOrEach:
    """One number or word, or a sequence of them.

    Attributes
    ----------
    one : Number or Choice
        Kind of each entry.
    """

    one: Number | Choice

    def check(self, name: str, value: Any) -> Any:
        """Return one, or a sequence as a tuple, if each is allowed."""
        return one_or_each(name, value, self.one.check)


@dataclass(frozen=True)
class NumberOrWord:
    """A whole number from 0 on, or one of several words.

    Attributes
    ----------
    words : tuple of str
        The words.
    """

    words: tuple[str, ...]

    def check(self, name: str, value: Any) -> int | str:
        """Return a value if it is such a number or one of the words."""
        return choice(name, value, self.words) if isinstance(value, str) else count(name, value, low=0)


@dataclass(frozen=True)
class Way:
    """A direction: a word for one of the world's axes, or three components, of any length.

    Attributes
    ----------
    words : tuple of str
        The words; a description may have more.
    """

    words: tuple[str, ...] = ("x", "y", "z")

    def check(self, name: str, value: Any) -> str | tuple[float, ...]:
        """Return a word, or three components as a tuple, if it is a direction."""
        if isinstance(value, str):
            return choice(name, value, self.words)
        allowed = f"be {', '.join(self.words)} or three numbers, not all zero"
        if not isinstance(value, (Sequence, np.ndarray)):
            raise ArgumentError(name, allowed, value)
        found = Each(Number()).check(name, value)
        if len(found) != 3 or not any(found):
            raise ArgumentError(name, allowed, value)
        return found

    def along(self, value: str | Sequence[float], axes: Iterable[Array] = ()) -> Array:
        """Return a direction as a unit vector, shape (3,); ``axial`` and ``transverse`` mean the `axes` of a body."""
        if isinstance(value, str):
            own = dict(zip(("axial", "transverse"), axes, strict=False))
            return in_space(own[value]) if value in own else np.eye(3)["xyz".index(value)]
        return np.asarray(np.array(value) / np.linalg.norm(value))


@dataclass(frozen=True)
class Whole:
    """A whole number.

    Attributes
    ----------
    least : int
        Smallest one allowed.
    """

    least: int = 1

    def check(self, name: str, value: Any) -> int:
        """Return a value as an int if it is a whole number of at least `least`."""
        return count(name, value, low=self.least)


@dataclass(frozen=True)
class Text:
    """A text."""

    def check(self, name: str, value: Any) -> str:
        """Return a value if it is a text."""
        instance(name, value, str)
        return str(value)


@dataclass(frozen=True)
class Switch:
    """True or False."""

    def check(self, name: str, value: Any) -> bool:
        """Return a value if it is true or false."""
        if not isinstance(value, bool | np.bool_):
            raise ArgumentError(name, "be True or False", value)
        return bool(value)


@dataclass(frozen=True)
class Own:
    """A field that the description checks itself.

    Attributes
    ----------
    what : str
        Name of its kind, for readers.
    """

    what: str

    def check(self, name: str, value: Any) -> Any:
        """Return a value as it is."""
        return value


Kind = Number | Choice | Each | OneOrEach | NumberOrWord | Way | Whole | Text | Switch | Own
# Kinds whose checked value replaces the given one: sequences become tuples, and NumPy numbers become Python numbers.
_KEPT = (Each, OneOrEach, NumberOrWord, Way, Switch)


@dataclass(frozen=True)
class Declared:
    """A declared field of a description.

    Attributes
    ----------
    name : str
        Name.
    kind : Number, Choice, Each, OneOrEach, NumberOrWord, Way, Whole, Text, Switch or Own
        Allowed values.
    is_optional : bool
        Whether it may also be None.
    default : object
        Default, `dataclasses.MISSING` if it must be given.
    """

    name: str
    kind: Kind
    is_optional: bool
    default: Any


@cache
def declared(description: type) -> tuple[Declared, ...]:
    """Return the declared fields of a dataclass, in order."""
    hints = get_type_hints(description, include_extras=True)
    found = []
    for field in dataclasses.fields(description):
        options = [hints[field.name], *get_args(hints[field.name])]
        kinds = [one for hint in options if get_origin(hint) is Annotated for one in hint.__metadata__]
        if kinds:
            found.append(Declared(field.name, kinds[0], type(None) in options, field.default))
    return tuple(found)


def check_declared(record: object) -> None:
    """Raise ArgumentError at the first declared field of a record that is not allowed; make lists tuples."""
    description: Any = type(record)
    for field in declared(description):
        value = getattr(record, field.name)
        if value is not None or not field.is_optional:
            checked = field.kind.check(field.name, value)
            if isinstance(field.kind, _KEPT):
                object.__setattr__(record, field.name, checked)


def texts(description: type) -> dict[str, str]:
    """Return a short description of each parameter of a class: the beginning of its entry in the docstring.

    Up to a semicolon or the end of the first sentence, the unit last.
    """
    found: dict[str, str] = {}
    names: list[str] = []
    _, _, parameters = (inspect.getdoc(description) or "").partition("Parameters\n----------\n")
    for line in parameters.splitlines():
        if line.startswith("---"):
            # The line before was the title of the next section.
            break
        if not line.startswith(" ") and " : " in line:
            names = line.partition(" : ")[0].split(", ")
            found |= dict.fromkeys(names, "")
        elif line.startswith(" "):
            found |= {name: f"{found[name]} {line.strip()}".strip() for name in names}
    return {name: _in_a_few_words(text) for name, text in found.items()}


def _in_a_few_words(text: str) -> str:
    words = re.split(r"; |\. |\.$", text, maxsplit=1)[0].replace("`", "")
    unit = _UNIT.search(words)
    if unit:
        words = _UNIT.sub("", words, count=1) + ("" if unit[1] == "1" else f" [{unit[1]}]")
    return words if _NAMED_AFTER.match(words) else words[:1].lower() + words[1:]


# Numbers that several descriptions share.
Ratio = Annotated[float, Number()]
PositiveRatio = Annotated[float, Number(above=0.0)]
DAMPING_RATIO = Number(least=0.0, below=1.0, meaning="critical")
DampingRatio = Annotated[float, DAMPING_RATIO]
Coefficient = Annotated[float, Number(least=0.0)]
Length = Annotated[float, Number("m", above=0.0)]
Distance = Annotated[float, Number("m", least=0.0)]
Position = Annotated[float, Number("m")]
Angle = Annotated[float, Number("rad")]
Area = Annotated[float, Number("m2", above=0.0)]
# Squares of frequencies far above any vibration of a body would overflow.
FREQUENCY = Number("Hz", above=0.0, below=1e12)
Frequency = Annotated[float, FREQUENCY]
Newtons = Annotated[float, Number("N")]
Tension = Annotated[float, Number("N", least=0.0)]
Velocity = Annotated[float, Number("m/s")]
Acceleration = Annotated[float, Number("m/s2")]
Axis = Annotated[str | Sequence[float], Way()]
Count = Annotated[int, Whole(1)]
CountFrom0 = Annotated[int, Whole(0)]
Name = Annotated[str, Text()]
Time = Annotated[float, Number("s", above=0.0)]
Speed = Annotated[float, Number("m/s", above=0.0)]
Slope = Annotated[float, Number("s/m", least=0.0)]
