"""Tables of scenario files: their keys with descriptions, and types of keys that hold tables of several forms."""

from __future__ import annotations

import ast
import inspect
import sys
from functools import cache
from itertools import pairwise
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Discriminator, GetJsonSchemaHandler, Tag
from pydantic_core import CoreSchema

# Tags of unions without a key that distinguishes them; pydantic puts them into the paths of errors.
TEXT, NUMBER, ONE, BY_NAME = FORMS = ("a text", "a number", "one table", "tables by name")


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


def text_or(table: Any) -> Any:
    """Return the type of a text or a table."""
    return Annotated[Annotated[str, Tag(TEXT)] | Annotated[table, Tag(ONE)], Discriminator(_text_or_one)]


def number_or(number: Any, table: Any) -> Any:
    """Return the type of a number or a table."""
    return Annotated[Annotated[number, Tag(NUMBER)] | Annotated[table, Tag(ONE)], Discriminator(_number_or_one)]


def one_or_by_name(table: Any) -> Any:
    """Return the type of one table, or of tables by name."""
    several = Annotated[dict[str, table], Tag(BY_NAME)]
    return Annotated[Annotated[table, Tag(ONE)] | several, Discriminator(_one_or_by_name)]


def holds_tables(value: Any) -> bool:
    """Return whether a table holds tables by name."""
    return isinstance(value, dict) and any(isinstance(each, (dict, BaseModel)) for each in value.values())


def _text_or_one(value: Any) -> str:
    return TEXT if isinstance(value, str) else ONE


def _number_or_one(value: Any) -> str:
    return ONE if isinstance(value, (dict, BaseModel)) else NUMBER


def _one_or_by_name(value: Any) -> str:
    return BY_NAME if holds_tables(value) else ONE
