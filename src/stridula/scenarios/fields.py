"""Kinds of values that only scenario tables have, and the types of keys."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Integral
from typing import Annotated, Any, ClassVar

import numpy as np

from ..arrays import Array
from ..bodies import Rayleigh
from ..bodies.damping import DAMPING_LAWS
from ..bodies.revolution.axisymmetric_body import DIRECTIONS
from ..checks import ArgumentError
from ..declared import FREQUENCY, Choice, Number, OneOrEach, Whole, declared, texts
from ..records.packed import is_packed, unpacked
from .kinds import INTEGER, NUMBER, TEXT, Read, Schema, any_of, by_name, list_of, read, refused, schema
from .quantities import is_quantity, quantity

METRES, RADIANS = Number("m"), Number("rad")
LENGTH = Number("m", above=0.0)
RATIO = Number(least=0.0, below=1.0)
FROM_0, FROM_1 = Whole(0), Whole(1)
LIST_OF_NUMBERS = list_of(NUMBER)


@dataclass(frozen=True)
class OneOrByName:
    """One number, or one for each name.

    Attributes
    ----------
    one : Number
        Kind of each.
    """

    one: Number

    @property
    def schema(self) -> Schema:
        one = schema(self.one)
        return any_of(one, by_name(one))

    def read(self, value: Any) -> Any:
        is_table = isinstance(value, dict)
        return {name: read(self.one, each) for name, each in value.items()} if is_table else read(self.one, value)


@dataclass(frozen=True)
class NumberOr:
    """A number, or a word in its place.

    Attributes
    ----------
    one : Number
        Kind of the number.
    word : str
        The word.
    """

    one: Number
    word: str

    @property
    def schema(self) -> Schema:
        return any_of(schema(self.one), {"const": self.word})

    def read(self, value: Any) -> float | str:
        if value == self.word:
            return self.word
        try:
            number: float = read(self.one, value)
        except ArgumentError as error:
            raise refused(f"{error.allowed} or {self.word!r}") from None
        return number


@dataclass(frozen=True)
class Row:
    """A fixed number of values in order, such as the coordinates of a point.

    Attributes
    ----------
    each : tuple of Number or Whole
        Kinds of the values.
    words : str
        Description of the values, for messages.
    """

    each: tuple[Number | Whole, ...]
    words: str

    @property
    def schema(self) -> Schema:
        size, one = len(self.each), schema(self.each[0])
        if len(set(self.each)) == 1:
            return list_of(one, size)
        each = [schema(kind) for kind in self.each]
        return {"type": "array", "prefixItems": each, "minItems": size, "maxItems": size}

    def read(self, value: Any) -> tuple[Any, ...]:
        if not isinstance(value, (list, tuple)) or len(value) != len(self.each):
            raise refused(f"be {self.words}")
        try:
            return tuple(read(kind, one) for kind, one in zip(self.each, value, strict=True))
        except ArgumentError as error:
            share = "each" if len(set(self.each)) == 1 else "one"
            raise refused(f"be {self.words}, {share} of which must {error.allowed}") from None


DISTANCES = Row((METRES, METRES), "two distances, along length and width")
COORDINATES = Row((METRES,) * 3, "three distances, along x, y and z")
AROUND = Row((METRES, RADIANS, METRES), "(r, theta, z), two distances and an angle between them")


class LawOfDamping:
    """A law of damping: its name and its parameters."""

    forms: ClassVar = {law.form: law for law in DAMPING_LAWS}

    @property
    def schema(self) -> Schema:
        return any_of(*(self._schema_of(form, law) for form, law in self.forms.items()))

    def _schema_of(self, form: str, law: type) -> Schema:
        name = {"const": form, "description": f"form of damping: {', '.join(self.forms)}"}
        words = texts(law)
        keys = {each.name: schema(each.kind) | {"description": words[each.name]} for each in declared(law)}
        return {"type": "object", "properties": {"form": name, **keys}, "additionalProperties": False}

    def read(self, value: Any) -> Any:
        form = value.get("form", Rayleigh.form)
        if not isinstance(form, str) or form not in self.forms:
            raise refused(f"have a form that is one of {', '.join(self.forms)}")
        parameters = declared(self.forms[form])
        if value.keys() - {"form"} != {parameter.name for parameter in parameters}:
            names = " and ".join(parameter.name for parameter in parameters)
            raise refused(f"have, in the form {form}, {names}")
        given = {}
        for parameter in parameters:
            try:
                given[parameter.name] = read(parameter.kind, value[parameter.name])
            except ArgumentError as error:
                raise refused(f"have a {parameter.name} that must {error.allowed}") from None
        try:
            self.forms[form](**given)
        except ArgumentError as error:
            raise refused(f"be in order: {error}") from None
        return {"form": form, **given}


LAW_OF_DAMPING = LawOfDamping()


@dataclass(frozen=True)
class OrLaw:
    """Damping ratios, or a law of damping.

    Attributes
    ----------
    ratios : Number or OneOrEach
        Kind of the ratios.
    """

    ratios: Number | OneOrEach

    @property
    def schema(self) -> Schema:
        return any_of(schema(self.ratios), LAW_OF_DAMPING.schema)

    def read(self, value: Any) -> Any:
        return read(LAW_OF_DAMPING if isinstance(value, dict) else self.ratios, value)


class Place:
    """A point of a body.

    One of its named points, a position along a beam, two distances on a plate, or (r, theta, z) in a body of
    revolution.
    """

    schema = any_of({"enum": ["tip", "root", "centre"]}, TEXT, NUMBER, DISTANCES.schema, AROUND.schema)

    def read(self, value: Any) -> Any:
        if isinstance(value, str):
            return value
        if isinstance(value, (list, tuple)):
            return (AROUND if len(value) == 3 else DISTANCES).read(value)
        try:
            return quantity(value, "m")
        except ArgumentError as error:
            raise refused(f"be the name of a point or a position, which must {error.allowed}") from None


class Node:
    """A node of a mesh: the name of a set of one node, its number, or its coordinates."""

    schema = any_of(TEXT, schema(FROM_0), COORDINATES.schema)

    def read(self, value: Any) -> Any:
        if isinstance(value, str):
            return value
        return read(COORDINATES if isinstance(value, (list, tuple)) else FROM_0, value)


class Fixed:
    """Groups of faces or nodes that are held: their names, or the held directions by name."""

    schema = any_of(list_of(TEXT), by_name(TEXT))

    def read(self, value: Any) -> Any:
        given = value.values() if isinstance(value, dict) else value
        if not isinstance(value, (dict, list)) or not all(isinstance(one, str) for one in given):
            raise refused('be a list of names, or directions by name, such as {top = "xz"}')
        return value


class Pair:
    """Two faces of a tie by their names."""

    schema = list_of(TEXT, 2)

    def read(self, value: Any) -> Any:
        if not isinstance(value, (list, tuple)) or len(value) != 2 or not all(isinstance(one, str) for one in value):
            raise refused('be two names of faces, such as ["plate/front", "lining/back"]')
        return value


class Divided:
    """Faces in contact: their names, or their divisions into points by name."""

    schema = any_of(
        list_of(TEXT),
        by_name(any_of(schema(FROM_1), list_of(schema(FROM_1), 2), {"const": "integration"})),
    )

    def read(self, value: Any) -> Any:
        if isinstance(value, (list, tuple)) and all(isinstance(one, str) for one in value):
            return value
        if not isinstance(value, dict) or not all(map(self._is_division, value.values())):
            raise refused("be a list of names, or divisions by name, such as {bottom = 30} or {bottom = [6, 5]}")
        return {name: tuple(one) if isinstance(one, list) else one for name, one in value.items()}

    @staticmethod
    def _is_division(one: Any) -> bool:
        return _is_whole(one) or one == "integration" or (isinstance(one, (list, tuple)) and all(map(_is_whole, one)))


@dataclass(frozen=True)
class Numbers:
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

    @property
    def schema(self) -> Schema:
        numbers = [(NUMBER, LIST_OF_NUMBERS, list_of(LIST_OF_NUMBERS))[dimension] for dimension in self.dimensions]
        return any_of(*numbers, *([LAW_OF_DAMPING.schema] if self.damping else []), TEXT)

    def read(self, value: Any) -> Any:
        array: Array | None
        if isinstance(value, str) and is_packed(value):
            array = unpacked(value)
        elif self.file and isinstance(value, str) and not (0 in self.dimensions and is_quantity(value, "1")):
            return value
        elif self.damping and isinstance(value, dict):
            return LAW_OF_DAMPING.read(value)
        elif 0 in self.dimensions and not isinstance(value, (list, tuple, np.ndarray)):
            return quantity(value, "1")
        else:
            array = _array(value)
        if array is None or array.ndim not in self.dimensions:
            raise refused(self._words())
        if not np.isfinite(array).all():
            raise refused("hold finite numbers only")
        return array

    def _words(self) -> str:
        kinds = ("a number", "a list of numbers", "a matrix, a list of rows of numbers")
        words = [kinds[dimension] for dimension in self.dimensions]
        words += ["a law of damping"] if self.damping else []
        words += ["a file"] if self.file else []
        return f"be {' or '.join(words)}"


VECTOR, MATRIX = Numbers((1,)), Numbers((2,))
LABEL = any_of(INTEGER, list_of(INTEGER))
ALONG_AXES = {"type": "object", "properties": dict.fromkeys("xyz", LABEL), "additionalProperties": False}


class Points:
    """Points of a reduced body by name: rows, degrees of freedom or labels along x and y, a node or a place."""

    schema = by_name(any_of(ALONG_AXES, list_of(LABEL), INTEGER, LIST_OF_NUMBERS, MATRIX.schema))

    def read(self, value: Any) -> dict[str, Any]:
        return {name: self._point(name, point) for name, point in _by_name(value).items()}

    def _point(self, name: str, point: Any) -> Any:
        if isinstance(point, dict) and set(point) <= {"x", "y", "z"}:
            point = [point.get(axis) for axis in ("xyz" if "z" in point else "xy")]
        if isinstance(point, (list, tuple)) and len(point) in (2, 3) and all(map(_is_label_or_none, point)):
            return tuple(tuple(label) if isinstance(label, list) else label for label in point)
        if _is_whole(point):
            return point
        place = _array(point)
        if place is not None and place.shape == (3,) and np.isfinite(place).all():
            return tuple(place.tolist())
        try:
            return MATRIX.read(point)
        except ArgumentError:
            raise refused(
                f"give the point {name} as rows over the degrees of freedom, shape (2, n) or (3, n), or by the degrees "
                "of freedom that it moves with: {x = 0, y = 1}, or as a node or a place where files have them"
            ) from None


class Places:
    """Places of points by name: three distances each, along x, y and z."""

    schema = by_name(COORDINATES.schema)

    def read(self, value: Any) -> dict[str, Any]:
        return {name: self._place(name, place) for name, place in _by_name(value).items()}

    def _place(self, name: str, place: Any) -> Any:
        try:
            return COORDINATES.read(place)
        except ArgumentError as error:
            raise refused(f"give the point {name} a place that must {error.allowed}") from None


class Vectors:
    """Three numbers for each name, along x, y and z or as their key says."""

    schema = by_name(LIST_OF_NUMBERS)

    def read(self, value: Any) -> dict[str, Any]:
        return {name: tuple(VECTOR.read(vector).tolist()) for name, vector in _by_name(value).items()}


class Motion:
    """Effect of a translation on the degrees of freedom: rows, or with labels the numbers of those along x, y and z."""

    schema = any_of(list_of(INTEGER), MATRIX.schema)

    def read(self, value: Any) -> Any:
        if isinstance(value, (list, tuple)) and len(value) in (2, 3) and all(map(_is_whole, value)):
            return tuple(value)
        return MATRIX.read(value)


def _by_name(value: Any) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise refused("be a table of points by name")
    return value


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
    return row if isinstance(row, (list, tuple)) else [row]


def _is_whole(value: Any) -> bool:
    return isinstance(value, Integral) and not isinstance(value, bool)


def _is_label_or_none(value: Any) -> bool:
    is_label = isinstance(value, (list, tuple)) and len(value) == 2 and all(map(_is_whole, value))
    return value is None or _is_whole(value) or is_label


Mass = Annotated[float, Read(Number("kg", above=0.0))]
Length = Annotated[float, Read(LENGTH)]
Distance = Annotated[float, Read(Number("m", least=0.0))]
Position = Annotated[float, Read(METRES)]
Angle = Annotated[float, Read(RADIANS)]
Frequency = Annotated[float, Read(FREQUENCY)]
FrequencyOrAll = Annotated[float | str, Read(NumberOr(FREQUENCY, "all"))]
Time = Annotated[float, Read(Number("s", above=0.0))]
Velocity = Annotated[float, Read(Number("m/s"))]
AngularVelocity = Annotated[float, Read(Number("rad/s"))]
Stiffness = Annotated[float, Read(Number("N/m", above=0.0))]
Viscosity = Annotated[float, Read(Number("N s/m", least=0.0))]
StiffnessOfArea = Annotated[float, Read(Number("N/m3", above=0.0))]
PositiveRatio = Annotated[float, Read(Number(above=0.0))]
Count = Annotated[int, Read(FROM_1)]
CountFrom0 = Annotated[int, Read(FROM_0)]
LengthOrEach = Annotated[Any, Read(OneOrEach(LENGTH))]
LengthOrLayers = Annotated[Any, Read(OneOrByName(LENGTH))]
Directions = Annotated[Any, Read(OneOrEach(Choice(DIRECTIONS)))]
Damping = Annotated[Any, Read(OrLaw(RATIO))]
ModalDamping = Annotated[Any, Read(OrLaw(OneOrEach(RATIO)))]
ReducedDamping = Annotated[Any, Read(Numbers((0, 1, 2), file=True, damping=True))]
Counts = Annotated[tuple[int, int], Read(Row((FROM_1,) * 2, "two whole numbers, along length and width"))]
CountsOrNone = Annotated[tuple[int, int], Read(Row((FROM_0,) * 2, "two whole numbers, along length and width"))]
Divisions = Annotated[tuple[int, int, int], Read(Row((FROM_1,) * 3, "three whole numbers"))]
Spot = Annotated[tuple[float, float], Read(DISTANCES)]
OfProfile = Annotated[tuple[float, float], Read(Row((METRES,) * 2, "(r, z), two distances"))]
Radii = Annotated[tuple[float, float], Read(Row((LENGTH,) * 2, "two radii"))]
Angles = Annotated[tuple[float, float], Read(Row((RADIANS,) * 2, "two angles"))]
Lengths = Annotated[tuple[float, float, float], Read(Row((LENGTH,) * 3, "three lengths"))]
Offset = Annotated[tuple[float, float, float], Read(Row((METRES,) * 3, "three lengths"))]
Direction = Annotated[tuple[float, float, float], Read(Row((Number(),) * 3, "three numbers"))]
Rotation = Annotated[tuple[float, float, float], Read(Row((RADIANS,) * 3, "three angles"))]
Vector = Annotated[Any, Read(VECTOR)]
Rows = Annotated[Any, Read(MATRIX)]
Matrix = Annotated[Any, Read(Numbers((2,), file=True))]
Inertia = Annotated[Any, Read(Numbers((0, 1, 2)))]
Translation = Annotated[Any, Read(Motion())]
Point = Annotated[Any, Read(Place())]
PointTable = Annotated[Any, Read(Points())]
PlaceTable = Annotated[Any, Read(Places())]
VectorTable = Annotated[Any, Read(Vectors())]
MeshNode = Annotated[Any, Read(Node())]
FixedGroups = Annotated[Any, Read(Fixed())]
TiedFaces = Annotated[Any, Read(Pair())]
DividedFaces = Annotated[Any, Read(Divided())]
