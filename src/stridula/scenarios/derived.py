"""Tables of a scenario file derived from the dataclasses that they describe."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from functools import reduce, singledispatch
from operator import or_
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, create_model

from ..declared import Choice, Declared, Each, Own, Switch, Text, declared, texts
from .fields import ModalDamping, Rows
from .kinds import Read
from .tables import Table

# Type, default (... if required) and description by key.
Keys = Mapping[str, tuple[Any, Any, str]]
# Types of fields that descriptions check themselves, by the name of their kind.
OWN = {"damping": ModalDamping, "laws": Any, "plane": Rows}


class Derived(Table):
    """A table whose keys are the declared fields of a dataclass, plus a tag that selects the dataclass."""

    made: ClassVar[type]
    own_texts: ClassVar[Mapping[str, str]]

    @classmethod
    def _own_descriptions(cls) -> dict[str, str]:
        if cls is Derived:
            return {}
        return {key: text for key, text in texts(cls.made).items() if key in cls.model_fields} | dict(cls.own_texts)


def table_of(
    description: type,
    tag: str = "",
    word: str | tuple[str, ...] = "",
    text: str = "",
    *,
    title: str = "",
    is_usual: bool = False,
    before: Keys | None = None,
    after: Keys | None = None,
    from_file: Keys | None = None,
) -> type[Table]:
    """Return the table of a dataclass.

    Parameters
    ----------
    description : type
        The dataclass.
    tag, word, text : str or tuple of str, optional
        Key that distinguishes several kinds of tables, its value or values for this kind, and its description; empty
        if there is only one kind.
    title : str, optional
        Title in the schema, by default the name of the dataclass.
    is_usual : bool, optional
        Whether this is the kind of a table without the tag.
    before, after : mapping, optional
        Type, default and description of other keys, before and after the declared fields.
    from_file : mapping, optional
        The same of keys with which a file has the declared fields that must be given.
    """
    before, after = before or {}, {**(after or {}), **(from_file or {})}
    keys: dict[str, Any] = {tag: (Literal[word], word if is_usual else ...)} if tag else {}
    keys |= {key: (kind, default) for key, (kind, default, _) in before.items()}
    keys |= {
        field.name: (_read(field) | None, None)
        if from_file and field.default is dataclasses.MISSING
        else (_read(field), ... if field.default is dataclasses.MISSING else field.default)
        for field in declared(description)
    }
    keys |= {key: (kind, default) for key, (kind, default, _) in after.items()}
    table = create_model(title or description.__name__, __base__=Derived, __module__=__name__, **keys)
    others = {key: words for key, (*_, words) in {**before, **after}.items()}
    table.made, table.own_texts = description, ({tag: text} if tag else {}) | others
    return table


def one_of(tag: str, tables: Iterable[type[Table]]) -> Any:
    """Return the type of a table of one of several kinds, selected by its `tag`."""
    return Annotated[reduce(or_, tables), Field(discriminator=tag)]


def _read(field: Declared) -> Any:
    """Return the type of a declared field in a table."""
    kind = _typed(field.kind)
    return kind | None if field.is_optional else kind


@singledispatch
def _typed(kind: Any) -> Any:
    return Annotated[Any, Read(kind)]


@_typed.register
def _choice(kind: Choice) -> Any:
    return Literal[kind.words]


@_typed.register
def _each(kind: Each) -> Any:
    return list[Annotated[float, Read(kind.one)]]


@_typed.register
def _switch(_: Switch) -> Any:
    return bool


@_typed.register
def _text(kind: Text) -> Any:
    return str


@_typed.register
def _own(kind: Own) -> Any:
    return OWN[kind.what]
