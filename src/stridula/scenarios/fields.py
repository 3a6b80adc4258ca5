"""Kinds of values in scenario tables: checked when read, described in the JSON schema."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from numbers import Integral
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import no_info_plain_validator_function

from .quantities import UNITS, quantity


class Table(BaseModel):
    """A table that knows its keys; the text under each is its description."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)


class _Kind:
    """A value read by `read`, which raises ValueError with the words that follow the key."""

    def read(self, value: Any) -> Any:
        raise NotImplementedError

    def json_schema(self) -> dict[str, Any]:
        raise NotImplementedError

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return no_info_plain_validator_function(_in_words(self.read))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return self.json_schema()


def _in_words(read: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def validate(value: Any) -> Any:
        try:
            return read(value)
        except ValueError as error:
            # The words go in as a value: braces in them are no placeholders.
            raise PydanticCustomError("words", "{words}", {"words": str(error)}) from None

    return validate


@dataclass(frozen=True)
class Quantity(_Kind):
    """A number with an SI unit, in a range.

    Attributes
    ----------
    unit : str
        SI unit.
    above, least, below : float or None
        Strictly above, from here on, strictly below; no bound where None.
    """

    unit: str
    above: float | None = None
    least: float | None = None
    below: float | None = None

    def read(self, value: Any) -> float:
        number = quantity(value, self.unit)
        if self.above is not None and number <= self.above:
            raise ValueError(f"must be above {self.above:g}")
        if self.least is not None and number < self.least:
            raise ValueError(f"must be {self.least:g} or above")
        if self.below is not None and number >= self.below:
            raise ValueError(f"must be below {self.below:g}")
        return number

    def json_schema(self) -> dict[str, Any]:
        limits = {"exclusiveMinimum": self.above, "minimum": self.least, "exclusiveMaximum": self.below}
        number = {"type": "number", **{word: limit for word, limit in limits.items() if limit is not None}}
        spellings = "|".join(UNITS[self.unit])
        return {"anyOf": [number, {"type": "string", "pattern": rf"^\s*[-+0-9.eE]+\s*({spellings})?\s*$"}]}


@dataclass(frozen=True)
class Whole(_Kind):
    """A whole number.

    Attributes
    ----------
    least : int
        Smallest one allowed.
    """

    least: int

    def read(self, value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, Integral):
            raise ValueError("must be a whole number")
        if value < self.least:
            raise ValueError(f"must be at least {self.least}")
        return int(value)

    def json_schema(self) -> dict[str, Any]:
        return {"type": "integer", "minimum": self.least}


@dataclass(frozen=True)
class Place(_Kind):
    """A point of a body: one of its named points, or a position along it."""

    names = ("tip", "root", "centre")

    def read(self, value: Any) -> str | float:
        if value in self.names:
            return str(value)
        try:
            return quantity(value, "m")
        except ValueError as error:
            raise ValueError(f"must be {', '.join(self.names)} or a position, which {error}") from None

    def json_schema(self) -> dict[str, Any]:
        return {"anyOf": [{"enum": list(self.names)}, *Quantity("m").json_schema()["anyOf"]]}


BodyName = Literal["slider", "track"]
Ratio = Annotated[float, Quantity("1")]
Friction = Annotated[float, Quantity("1", least=0.0)]
Damping = Annotated[float, Quantity("1", least=0.0, below=1.0)]
Length = Annotated[float, Quantity("m", above=0.0)]
Distance = Annotated[float, Quantity("m", least=0.0)]
Area = Annotated[float, Quantity("m2", above=0.0)]
SecondMoment = Annotated[float, Quantity("m4", above=0.0)]
Angle = Annotated[float, Quantity("rad")]
Modulus = Annotated[float, Quantity("Pa", above=0.0)]
Density = Annotated[float, Quantity("kg/m3", above=0.0)]
Frequency = Annotated[float, Quantity("Hz", above=0.0)]
Time = Annotated[float, Quantity("s", above=0.0)]
Instant = Annotated[float, Quantity("s", least=0.0)]
Newtons = Annotated[float, Quantity("N")]
Velocity = Annotated[float, Quantity("m/s")]
Acceleration = Annotated[float, Quantity("m/s2", above=0.0)]
Count = Annotated[int, Whole(1)]
CountOrNone = Annotated[int, Whole(0)]
Point = Annotated[str | float, Place()]
