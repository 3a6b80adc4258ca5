"""Declared kinds of fields in scenario tables: how each is read, and its JSON schema."""

from __future__ import annotations

from dataclasses import dataclass
from functools import singledispatch
from typing import Any

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import no_info_plain_validator_function

from ..checks import ArgumentError
from ..declared import Choice, Each, Number, NumberOrWord, OneOrEach, Way, Whole
from .quantities import UNITS, quantity

Schema = dict[str, Any]
NUMBER: Schema = {"type": "number"}
INTEGER: Schema = {"type": "integer"}
TEXT: Schema = {"type": "string"}


@singledispatch
def read(kind: Any, value: Any) -> Any:
    """Return a value of a table in the form of the Python API; kinds that only scenarios have read themselves.

    Raises
    ------
    ArgumentError
        If the kind does not allow it; the caller adds the key and the value to the message.
    """
    return kind.read(value)


@singledispatch
def schema(kind: Any) -> Schema:
    """Return the JSON schema of a kind; numbers name their unit, which the published schema leaves out."""
    described: Schema = kind.schema
    return described


@dataclass(frozen=True)
class Read:
    """Mark of a type whose values are read as a kind.

    Attributes
    ----------
    kind : object
        A declared kind, or one with `read` and `schema`.
    """

    kind: Any

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return no_info_plain_validator_function(self._validated)

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> Schema:
        # A copy, to which pydantic adds the title and the default.
        return dict(schema(self.kind))

    def _validated(self, value: Any) -> Any:
        try:
            return read(self.kind, value)
        except ArgumentError as error:
            # Passed as a value, so that braces in it are not taken for placeholders.
            raise PydanticCustomError("words", "{words}", {"words": f"must {error.allowed}"}) from None


def refused(allowed: str) -> ArgumentError:
    """Return the error of a value, without its key."""
    return ArgumentError("value", allowed)


def any_of(*schemas: Schema) -> Schema:
    """Return the schema of a value that one of several describes."""
    return {"anyOf": [variant for one in schemas for variant in one.get("anyOf", [one])]}


def list_of(one: Schema, size: int | None = None) -> Schema:
    """Return the schema of a list, of any size unless it is given."""
    return {"type": "array", "items": one} | ({} if size is None else {"minItems": size, "maxItems": size})


def by_name(one: Schema) -> Schema:
    """Return the schema of a table of values by name."""
    return {"type": "object", "additionalProperties": one}


@read.register
def _number(kind: Number, value: Any) -> float:
    return kind.check("value", quantity(value, kind.unit))


@schema.register
def _of_number(kind: Number) -> Schema:
    limits = {"exclusiveMinimum": kind.above, "minimum": kind.least, "exclusiveMaximum": kind.below}
    number = NUMBER | {word: limit for word, limit in limits.items() if limit is not None}
    if kind.unit not in UNITS:
        raise LookupError(f"unit {kind.unit!r} of a declared field must be entered in UNITS of scenarios/quantities.py")
    pattern = rf"^\s*[-+0-9.eE]+\s*({'|'.join(UNITS[kind.unit])})?\s*$"
    return any_of(number, TEXT | {"pattern": pattern, "unit": kind.unit})


@read.register(Choice)
@read.register(Whole)
def _checked(kind: Choice | Whole, value: Any) -> Any:
    return kind.check("value", value)


@schema.register
def _of_choice(kind: Choice) -> Schema:
    return {"enum": list(kind.words)}


@schema.register
def _of_whole(kind: Whole) -> Schema:
    return INTEGER | {"minimum": kind.least}


@read.register
def _number_or_word(kind: NumberOrWord, value: Any) -> int | str:
    try:
        return kind.check("value", value)
    except ArgumentError:
        raise refused(f"be a whole number from 0 on or {' or '.join(kind.words)}") from None


@schema.register
def _of_number_or_word(kind: NumberOrWord) -> Schema:
    return any_of(schema(Whole(0)), schema(Choice(kind.words)))


@read.register
def _way(kind: Way, value: Any) -> str | tuple[float, ...]:
    try:
        return kind.check("value", value)
    except ArgumentError:
        raise refused(f"be {', '.join(kind.words)} or a list of three numbers, not all zero") from None


@schema.register
def _of_way(kind: Way) -> Schema:
    return any_of(schema(Choice(kind.words)), list_of(NUMBER, 3))


@read.register(OneOrEach)
@read.register(Each)
def _one_or_each(kind: OneOrEach | Each, value: Any) -> Any:
    try:
        return [read(kind.one, one) for one in value] if isinstance(value, list) else read(kind.one, value)
    except ArgumentError as error:
        raise refused(f"{error.allowed}{' or a list of them' if hasattr(kind.one, 'words') else ''}") from None


@schema.register(OneOrEach)
@schema.register(Each)
def _of_one_or_each(kind: OneOrEach | Each) -> Schema:
    one = schema(kind.one)
    return any_of(one, list_of(one))
