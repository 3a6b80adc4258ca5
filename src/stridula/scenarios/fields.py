"""Types of values in scenario tables: checked when read, described in the JSON schema."""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, singledispatch
from itertools import pairwise
from numbers import Integral
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import BaseModel, ConfigDict, Discriminator, GetCoreSchemaHandler, GetJsonSchemaHandler, Tag
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import no_info_plain_validator_function

from .. import declared as declarations
from ..arrays import Array
from ..bodies import Rayleigh
from ..bodies.axisymmetric_body import DIRECTIONS
from ..bodies.damping import DAMPING_LAWS
from ..checks import ArgumentError
from ..declared import Number, declared, texts
from ..records.packed import is_packed, unpacked
from .quantities import UNITS, is_quantity, quantity


class Table(BaseModel):
    """A table with a fixed set of keys; the string below each key is its description."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    @classmethod
    def descriptions(cls) -> dict[str, str]:
        """Return the description of each key.

        Read on request: storing them in the fields costs more than loading a scenario.
        """
        own = [table for table in cls.__mro__[::-1] if issubclass(table, Table)]
        return {key: text for table in own for key, text in table._own_descriptions().items()}

    @classmethod
    def _own_descriptions(cls) -> dict[str, str]:
        return _texts(cls.__module__)[cls.__name__]

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        node = handler(schema)
        known = handler.resolve_ref_schema(node)["properties"]
        for key, text in cls.descriptions().items():
            known[key]["description"] = text
        return node


@cache
def _texts(module: str) -> dict[str, dict[str, str]]:
    """Return the descriptions below the keys of each class in a module."""
    tree = ast.parse(inspect.getsource(sys.modules[module]))
    return {node.name: _texts_in(node) for node in tree.body if isinstance(node, ast.ClassDef)}


def _texts_in(table: ast.ClassDef) -> dict[str, str]:
    texts = {}
    for pair in pairwise(table.body):
        match pair:
            case ast.AnnAssign(target=ast.Name(id=key)), ast.Expr(value=ast.Constant(value=str(text))):
                texts[key] = inspect.cleandoc(text)
    return texts


class _Kind:
    """A value read by `read`, which raises ArgumentError; the caller adds the key and the value to the message."""

    def read(self, value: Any) -> Any:
        raise NotImplementedError

    def json_schema(self) -> dict[str, Any]:
        raise NotImplementedError

    def or_each(self) -> _Kind:
        """Return the type of one such value or a list of them."""
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return no_info_plain_validator_function(_in_words(self.read))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return self.json_schema()


def _in_words(read: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def validate(value: Any) -> Any:
        try:
            return read(value)
        except ArgumentError as error:
            # Passed as a value, so that braces in it are not taken for placeholders.
            raise PydanticCustomError("words", "{words}", {"words": f"must {error.allowed}"}) from None

    return validate


class Quantity(Number, _Kind):
    """A number in a range, or a text with such a number and a unit.

    Attributes
    ----------
    unit, above, least, below, meaning : str, float or None
        As of `Number`.
    """

    def or_each(self) -> _Kind:
        return OneOrEach(self)

    def read(self, value: Any) -> float:
        return self.check("value", quantity(value, self.unit))

    def json_schema(self) -> dict[str, Any]:
        limits = {"exclusiveMinimum": self.above, "minimum": self.least, "exclusiveMaximum": self.below}
        number = {"type": "number", **{word: limit for word, limit in limits.items() if limit is not None}}
        return {"anyOf": [number, {"type": "string", "pattern": pattern_of(self.unit)}]}


def pattern_of(unit: str) -> str:
    """Return the pattern of texts that hold a number in a spelling of this SI unit."""
    return rf"^\s*[-+0-9.eE]+\s*({'|'.join(UNITS[unit])})?\s*$"


@dataclass(frozen=True)
class OneOrEach(_Kind):
    """One quantity, or a list of them.

    Attributes
    ----------
    one : Quantity
        Type of each.
    """

    one: Quantity

    def read(self, value: Any) -> Any:
        return [self.one.read(each) for each in value] if isinstance(value, list) else self.one.read(value)

    def json_schema(self) -> dict[str, Any]:
        one = self.one.json_schema()
        return {"anyOf": [*one["anyOf"], {"type": "array", "items": one}]}


@dataclass(frozen=True)
class OneOrByName(_Kind):
    """One quantity, or one for each name.

    Attributes
    ----------
    one : Quantity
        Type of each.
    """

    one: Quantity

    def read(self, value: Any) -> Any:
        if not isinstance(value, dict):
            return self.one.read(value)
        return {name: self.one.read(each) for name, each in value.items()}

    def json_schema(self) -> dict[str, Any]:
        one = self.one.json_schema()
        return {"anyOf": [*one["anyOf"], {"type": "object", "additionalProperties": one}]}


@dataclass(frozen=True)
class DampingTable(_Kind):
    """A law of damping: its name and its parameters."""

    forms: ClassVar[dict[str, type]] = {law.form: law for law in DAMPING_LAWS}

    def read(self, value: Any) -> Any:
        form = value.get("form", Rayleigh.form)
        if not isinstance(form, str) or form not in self.forms:
            raise _refused(f"have a form that is one of {', '.join(self.forms)}")
        parameters = declared(self.forms[form])
        if value.keys() - {"form"} != {parameter.name for parameter in parameters}:
            names = " and ".join(parameter.name for parameter in parameters)
            raise _refused(f"have, in the form {form}, {names}")
        given = {}
        for parameter in parameters:
            try:
                given[parameter.name] = read_as(parameter.kind).read(value[parameter.name])
            except ArgumentError as error:
                raise _refused(f"have a {parameter.name} that must {error.allowed}") from None
        try:
            self.forms[form](**given)
        except ArgumentError as error:
            raise _refused(f"be in order: {error}") from None
        return {"form": form, **given}

    def json_schema(self) -> dict[str, Any]:
        laws = []
        for form, law in self.forms.items():
            name = {"const": form, "description": f"form of damping: {', '.join(self.forms)}"}
            words = texts(law)
            keys = {
                parameter.name: read_as(parameter.kind).json_schema() | {"description": words[parameter.name]}
                for parameter in declared(law)
            }
            laws.append({"type": "object", "properties": {"form": name, **keys}, "additionalProperties": False})
        return {"anyOf": laws}


@singledispatch
def read_as(kind: Any) -> _Kind:
    """Return the type in scenario tables of a declared kind of field."""
    raise TypeError(f"no scenario can give {kind}")


@read_as.register
def _number(kind: declarations.Number) -> _Kind:
    return Quantity(**vars(kind))


@read_as.register
def _choice(kind: declarations.Choice) -> _Kind:
    return Words(kind.words)


@read_as.register
def _number_or_word(kind: declarations.NumberOrWord) -> _Kind:
    return NumberOrWord(Words(kind.words))


@read_as.register
def _way(kind: declarations.Way) -> _Kind:
    return Way(kind)


@read_as.register
def _whole(kind: declarations.Whole) -> _Kind:
    return Whole(kind.least)


@read_as.register
def _own(kind: declarations.Own) -> _Kind:
    if kind.what == "plane":
        return Numbers((2,))
    if kind.what != "damping":
        raise TypeError(f"no scenario can give {kind}")
    return RatioOrLaw(each=True)


@read_as.register(declarations.OneOrEach)
@read_as.register(declarations.Each)
def _each(kind: declarations.OneOrEach | declarations.Each) -> _Kind:
    return read_as(kind.one).or_each()


LAW_OF_DAMPING = DampingTable()


@dataclass(frozen=True)
class RatioOrLaw(_Kind):
    """A damping ratio, a list with one for each mode where allowed, or a law of damping.

    Attributes
    ----------
    each : bool
        Whether a list is allowed.
    """

    each: bool

    def read(self, value: Any) -> Any:
        return LAW_OF_DAMPING.read(value) if isinstance(value, dict) else self._ratios.read(value)

    def json_schema(self) -> dict[str, Any]:
        return {"anyOf": [*self._ratios.json_schema()["anyOf"], *LAW_OF_DAMPING.json_schema()["anyOf"]]}

    @property
    def _ratios(self) -> Quantity | OneOrEach:
        one = Quantity("1", least=0.0, below=1.0)
        return OneOrEach(one) if self.each else one


@dataclass(frozen=True)
class Words(_Kind):
    """A word of a choice, or a list of such words where allowed.

    Attributes
    ----------
    allowed : tuple of str
        The words.
    each : bool
        Whether a list is allowed.
    """

    allowed: tuple[str, ...]
    each: bool = False

    def or_each(self) -> _Kind:
        return replace(self, each=True)

    def read(self, value: Any) -> Any:
        words = value if self.each and isinstance(value, list) else [value]
        if any(word not in self.allowed for word in words):
            raise _refused(f"be one of {', '.join(self.allowed)}{' or a list of them' if self.each else ''}")
        return value

    def json_schema(self) -> dict[str, Any]:
        word = {"enum": list(self.allowed)}
        return {"anyOf": [word, {"type": "array", "items": word}]} if self.each else word


@dataclass(frozen=True)
class Whole(_Kind):
    """A whole number.

    Attributes
    ----------
    least : int
        Smallest allowed number.
    """

    least: int

    def read(self, value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, Integral):
            raise _refused("be a whole number")
        if value < self.least:
            raise _refused(f"be at least {self.least}")
        return int(value)

    def json_schema(self) -> dict[str, Any]:
        return {"type": "integer", "minimum": self.least}


@dataclass(frozen=True)
class NumberOrWord(_Kind):
    """A whole number from 0 on, or a word of a choice.

    Attributes
    ----------
    words : Words
        The words.
    """

    words: Words

    def read(self, value: Any) -> int | str:
        try:
            return self.words.read(value) if isinstance(value, str) else Whole(0).read(value)
        except ArgumentError:
            raise _refused(f"be a whole number from 0 on or {' or '.join(self.words.allowed)}") from None

    def json_schema(self) -> dict[str, Any]:
        return {"anyOf": [Whole(0).json_schema(), self.words.json_schema()]}


@dataclass(frozen=True)
class QuantityOrWord(_Kind):
    """A quantity, or a word in its place.

    Attributes
    ----------
    one : Quantity
        The quantity.
    word : str
        The word.
    """

    one: Quantity
    word: str

    def read(self, value: Any) -> float | str:
        if value == self.word:
            return self.word
        try:
            return self.one.read(value)
        except ArgumentError as error:
            raise _refused(f"{error.allowed} or {self.word!r}") from None

    def json_schema(self) -> dict[str, Any]:
        return {"anyOf": [*self.one.json_schema()["anyOf"], {"const": self.word}]}


@dataclass(frozen=True)
class Way(_Kind):
    """A direction: a word, or three numbers.

    Attributes
    ----------
    way : Way
        Declaration, with the allowed words.
    """

    way: declarations.Way

    def read(self, value: Any) -> Any:
        try:
            return self.way.check("value", value)
        except ArgumentError:
            raise _refused(f"be {', '.join(self.way.words)} or a list of three numbers, not all zero") from None

    def json_schema(self) -> dict[str, Any]:
        row = {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3}
        return {"anyOf": [{"enum": list(self.way.words)}, row]}


@dataclass(frozen=True)
class Row(_Kind):
    """A fixed number of values in order, such as the coordinates of a point.

    Attributes
    ----------
    each : tuple of Quantity or Whole
        Types of the values.
    words : str
        Description of the values, for messages.
    """

    each: tuple[Quantity | Whole, ...]
    words: str

    def read(self, value: Any) -> tuple[Any, ...]:
        if not isinstance(value, (list, tuple)) or len(value) != len(self.each):
            raise _refused(f"be {self.words}")
        try:
            return tuple(kind.read(one) for kind, one in zip(self.each, value, strict=True))
        except ArgumentError as error:
            share = "each" if len(set(self.each)) == 1 else "one"
            raise _refused(f"be {self.words}, {share} of which must {error.allowed}") from None

    def json_schema(self) -> dict[str, Any]:
        size = {"minItems": len(self.each), "maxItems": len(self.each)}
        first, *others = self.each
        if all(other == first for other in others):
            return {"type": "array", "items": first.json_schema(), **size}
        return {"type": "array", "prefixItems": [kind.json_schema() for kind in self.each], **size}


DISTANCES = Row((Quantity("m"), Quantity("m")), "two distances, along length and width")
COORDINATES = Row((Quantity("m"),) * 3, "three distances, along x, y and z")
AROUND = Row((Quantity("m"), Quantity("rad"), Quantity("m")), "(r, theta, z), two distances and an angle between them")


@dataclass(frozen=True)
class Place(_Kind):
    """A point of a body.

    One of its named points, a position along a beam, two distances on a plate, or (r, theta, z) in a body of
    revolution.
    """

    names = ("tip", "root", "centre")

    def read(self, value: Any) -> Any:
        if isinstance(value, str):
            return value
        if isinstance(value, (list, tuple)):
            return (AROUND if len(value) == 3 else DISTANCES).read(value)
        try:
            return quantity(value, "m")
        except ArgumentError as error:
            raise _refused(f"be the name of a point or a position, which must {error.allowed}") from None

    def json_schema(self) -> dict[str, Any]:
        positions = [{"type": "number"}, DISTANCES.json_schema(), AROUND.json_schema()]
        return {"anyOf": [{"enum": list(self.names)}, {"type": "string"}, *positions]}


@dataclass(frozen=True)
class Node(_Kind):
    """A node of a mesh: the name of a set of one node, its number, or its coordinates."""

    def read(self, value: Any) -> Any:
        if isinstance(value, str):
            return value
        return COORDINATES.read(value) if isinstance(value, (list, tuple)) else Whole(0).read(value)

    def json_schema(self) -> dict[str, Any]:
        return {"anyOf": [{"type": "string"}, Whole(0).json_schema(), COORDINATES.json_schema()]}


@dataclass(frozen=True)
class Fixed(_Kind):
    """Groups of faces or nodes that are held: their names, or the held directions by name."""

    def read(self, value: Any) -> Any:
        given = value.values() if isinstance(value, dict) else value
        if not isinstance(value, (dict, list)) or not all(isinstance(one, str) for one in given):
            raise _refused('be a list of names, or directions by name, such as {top = "xz"}')
        return value

    def json_schema(self) -> dict[str, Any]:
        word = {"type": "string"}
        return {"anyOf": [{"type": "array", "items": word}, {"type": "object", "additionalProperties": word}]}


@dataclass(frozen=True)
class Divided(_Kind):
    """Faces in contact: their names, or their divisions into points by name."""

    def read(self, value: Any) -> Any:
        if isinstance(value, list) and all(isinstance(one, str) for one in value):
            return value
        if not isinstance(value, dict) or not all(map(self._is_division, value.values())):
            raise _refused("be a list of names, or divisions by name, such as {bottom = 30} or {bottom = [6, 5]}")
        return {name: tuple(one) if isinstance(one, list) else one for name, one in value.items()}

    @staticmethod
    def _is_division(one: Any) -> bool:
        return _is_whole(one) or one == "integration" or (isinstance(one, list) and all(map(_is_whole, one)))

    def json_schema(self) -> dict[str, Any]:
        number = {"type": "integer", "minimum": 1}
        pair = {"type": "array", "items": number, "minItems": 2, "maxItems": 2}
        one = {"anyOf": [number, pair, {"const": "integration"}]}
        names = {"type": "array", "items": {"type": "string"}}
        return {"anyOf": [names, {"type": "object", "additionalProperties": one}]}


@dataclass(frozen=True)
class Numbers(_Kind):
    """A list of numbers or a matrix, written out or packed; where allowed also a number, a law of damping or a file.

    Attributes
    ----------
    dimensions : tuple of int
        Allowed dimensions: 0 for one number, 1 for a list, 2 for a matrix.
    file : bool
        Whether a text may be the name of a file.
    damping : bool
        Whether a law of damping is allowed.
    """

    dimensions: tuple[int, ...]
    file: bool = False
    damping: bool = False

    def read(self, value: Any) -> Any:
        array: Array | None
        if isinstance(value, str) and is_packed(value):
            array = unpacked(value)
        elif self.file and isinstance(value, str) and not (0 in self.dimensions and is_quantity(value, "1")):
            return value
        elif self.damping and isinstance(value, dict):
            return LAW_OF_DAMPING.read(value)
        elif 0 in self.dimensions and not isinstance(value, list):
            return quantity(value, "1")
        else:
            array = _array(value)
        if array is None or array.ndim not in self.dimensions:
            raise _refused(self._words())
        if not np.isfinite(array).all():
            raise _refused("hold finite numbers only")
        return array

    def json_schema(self) -> dict[str, Any]:
        row = {"type": "array", "items": {"type": "number"}}
        kinds = {0: {"type": "number"}, 1: row, 2: {"type": "array", "items": row}}
        laws = LAW_OF_DAMPING.json_schema()["anyOf"] if self.damping else []
        return {"anyOf": [*(kinds[dimension] for dimension in self.dimensions), *laws, {"type": "string"}]}

    def _words(self) -> str:
        kinds = {0: "a number", 1: "a list of numbers", 2: "a matrix, a list of rows of numbers"}
        words = [kinds[dimension] for dimension in self.dimensions]
        words += ["a law of damping"] if self.damping else []
        words += ["a file"] if self.file else []
        return f"be {' or '.join(words)}"


@dataclass(frozen=True)
class Points(_Kind):
    """Points of a reduced body by name: rows, degrees of freedom or labels along x and y, a node or a place."""

    def read(self, value: Any) -> dict[str, Any]:
        if not isinstance(value, dict):
            raise _refused("be a table of points by name")
        return {name: self._point(name, point) for name, point in value.items()}

    def json_schema(self) -> dict[str, Any]:
        rows = Numbers((2,)).json_schema()
        label = {"anyOf": [{"type": "integer"}, {"type": "array", "items": {"type": "integer"}}]}
        along = dict.fromkeys("xyz", label)
        axes = {"type": "object", "properties": along, "additionalProperties": False}
        pair = {"type": "array", "items": label}
        node, place = {"type": "integer"}, {"type": "array", "items": {"type": "number"}}
        return {"type": "object", "additionalProperties": {"anyOf": [axes, pair, node, place, *rows["anyOf"]]}}

    def _point(self, name: str, point: Any) -> Any:
        if isinstance(point, dict) and set(point) <= {"x", "y", "z"}:
            point = [point.get(axis) for axis in ("xyz" if "z" in point else "xy")]
        if isinstance(point, list) and len(point) in (2, 3) and all(map(_is_label_or_none, point)):
            return tuple(tuple(label) if isinstance(label, list) else label for label in point)
        if _is_whole(point):
            return point
        place = _array(point)
        if place is not None and place.shape == (3,) and np.isfinite(place).all():
            return tuple(place.tolist())
        try:
            return Numbers((2,)).read(point)
        except ArgumentError:
            raise _refused(
                f"give the point {name} as rows over the degrees of freedom, shape (2, n) or (3, n), or by the degrees "
                "of freedom that it moves with: {x = 0, y = 1}, or as a node or a place where files have them"
            ) from None


@dataclass(frozen=True)
class Places(_Kind):
    """Places of points by name: three numbers each, along x, y and z [m]."""

    def read(self, value: Any) -> dict[str, Any]:
        if not isinstance(value, dict):
            raise _refused("be a table of points by name")
        return {name: tuple(Numbers((1,)).read(place).tolist()) for name, place in value.items()}

    def json_schema(self) -> dict[str, Any]:
        return {"type": "object", "additionalProperties": {"type": "array", "items": {"type": "number"}}}


@dataclass(frozen=True)
class Motion(_Kind):
    """Effect of a translation on the degrees of freedom: rows, or with labels the numbers of those along x, y and z."""

    def read(self, value: Any) -> Any:
        if isinstance(value, list) and len(value) in (2, 3) and all(map(_is_whole, value)):
            return tuple(value)
        return Numbers((2,)).read(value)

    def json_schema(self) -> dict[str, Any]:
        return {"anyOf": [{"type": "array", "items": {"type": "integer"}}, *Numbers((2,)).json_schema()["anyOf"]]}


# Tags of unions without a key that distinguishes them; pydantic puts them into the paths of errors.
TEXT, ONE, BY_NAME = "a text", "one table", "tables by name"


def text_or(table: Any) -> Any:
    """Return the type of a text or a table."""
    return Annotated[Annotated[str, Tag(TEXT)] | Annotated[table, Tag(ONE)], Discriminator(_text_or_one)]


def one_or_by_name(table: Any) -> Any:
    """Return the type of one table, or of tables by name."""
    several = Annotated[dict[str, table], Tag(BY_NAME)]
    return Annotated[Annotated[table, Tag(ONE)] | several, Discriminator(_one_or_by_name)]


def holds_tables(value: Any) -> bool:
    """Return whether a table holds tables by name."""
    return isinstance(value, dict) and any(isinstance(each, (dict, BaseModel)) for each in value.values())


def _text_or_one(value: Any) -> str:
    return TEXT if isinstance(value, str) else ONE


def _one_or_by_name(value: Any) -> str:
    return BY_NAME if holds_tables(value) else ONE


def _refused(allowed: str) -> ArgumentError:
    return ArgumentError("value", allowed)


def _array(value: Any) -> Array | None:
    """Return lists of real numbers as an array of floats, None for anything else."""
    if not isinstance(value, (list, tuple, np.ndarray)):
        return None
    try:
        array = np.array(value)
    except ValueError:
        return None
    flat = value if isinstance(value, np.ndarray) else [entry for row in value for entry in _entries(row)]
    is_real = array.dtype.kind in "iuf" and not any(isinstance(entry, bool) for entry in flat)
    return array.astype(float) if is_real else None


def _entries(row: Any) -> Any:
    return row if isinstance(row, list) else [row]


def _is_whole(value: Any) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool)


def _is_label_or_none(value: Any) -> bool:
    is_label = isinstance(value, list) and len(value) == 2 and all(map(_is_whole, value))
    return value is None or _is_whole(value) or is_label


Damping = Annotated[Any, RatioOrLaw(each=False)]
Mass = Annotated[float, Quantity("kg", above=0.0)]
Length = Annotated[float, Quantity("m", above=0.0)]
Distance = Annotated[float, Quantity("m", least=0.0)]
Angle = Annotated[float, Quantity("rad")]
Frequency = Annotated[float, Quantity("Hz", above=0.0, below=1e12)]
FrequencyOrAll = Annotated[float | str, QuantityOrWord(Quantity("Hz", above=0.0, below=1e12), "all")]
Time = Annotated[float, Quantity("s", above=0.0)]
Velocity = Annotated[float, Quantity("m/s")]
AnyAcceleration = Annotated[float, Quantity("m/s2")]
Count = Annotated[int, Whole(1)]
Counts = Annotated[tuple[int, int], Row((Whole(1),) * 2, "two whole numbers, along length and width")]
CountsOrNone = Annotated[tuple[int, int], Row((Whole(0),) * 2, "two whole numbers, along length and width")]
Divisions = Annotated[tuple[int, int, int], Row((Whole(1),) * 3, "three whole numbers")]
Point = Annotated[Any, Place()]
Spot = Annotated[tuple[float, float], DISTANCES]
Position = Annotated[float, Quantity("m")]
PositiveRatio = Annotated[float, Quantity("1", above=0.0)]
Matrix = Annotated[Any, Numbers((2,), file=True)]
ModalDamping = Annotated[Any, RatioOrLaw(each=True)]
ReducedDamping = Annotated[Any, Numbers((0, 1, 2), file=True, damping=True)]
Vector = Annotated[Any, Numbers((1,))]
Rows = Annotated[Any, Numbers((2,))]
Stiffness = Annotated[float, Quantity("N/m", above=0.0)]
StiffnessOfArea = Annotated[float, Quantity("N/m3", above=0.0)]
AngularVelocity = Annotated[float, Quantity("rad/s")]
PointTable = Annotated[Any, Points()]
PlaceTable = Annotated[Any, Places()]
Inertia = Annotated[Any, Numbers((0, 1, 2))]
Translation = Annotated[Any, Motion()]
Lengths = Annotated[tuple[float, float, float], Row((Quantity("m", above=0.0),) * 3, "three lengths")]
Offset = Annotated[tuple[float, float, float], Row((Quantity("m"),) * 3, "three lengths")]
Direction = Annotated[tuple[float, float, float], Row((Quantity("1"),) * 3, "three numbers")]
Rotation = Annotated[tuple[float, float, float], Row((Quantity("rad"),) * 3, "three angles")]
LengthOrLayers = Annotated[Any, OneOrByName(Quantity("m", above=0.0))]
Radii = Annotated[tuple[float, float], Row((Quantity("m", above=0.0),) * 2, "two radii")]
Angles = Annotated[tuple[float, float], Row((Quantity("rad"),) * 2, "two angles")]
OfProfile = Annotated[tuple[float, float], Row((Quantity("m"),) * 2, "(r, z), two distances")]
LengthOrEach = Annotated[Any, OneOrEach(Quantity("m", above=0.0))]
MeshNode = Annotated[Any, Node()]
FixedGroups = Annotated[Any, Fixed()]
DividedFaces = Annotated[Any, Divided()]
Directions = Annotated[Any, Words(DIRECTIONS, each=True)]

# In the JSON schema the unit of a number is identified by the allowed spellings of its text.
UNIT_OF_PATTERN = {Quantity(unit).json_schema()["anyOf"][1]["pattern"]: unit for unit in UNITS}
