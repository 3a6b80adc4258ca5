"""What a page may say: every message checked, sizes and rates bounded."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

# Largest message [bytes].
LARGEST = 100_000
# Longest line that says what is wrong with one.
LONGEST = 300
Number = Annotated[float, Field(allow_inf_nan=False, ge=-1e15, le=1e15)]
Revision = Annotated[int, Field(ge=0, le=2**50)]
Key = Annotated[str, Field(max_length=100)]


class _Message(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class Scene(_Message):
    """What is to be played: a shipped case or a text, with values set by key."""

    type: Literal["scene"]
    revision: Revision
    case: Annotated[str, Field(max_length=100)] = "squeal"
    text: Annotated[str, Field(max_length=60_000)] | None = None
    overrides: Annotated[dict[Key, Number | int | Key], Field(max_length=40)] = {}


class Pull(_Message):
    """How much is to be played next, in parts."""

    type: Literal["pull"]
    parts: Annotated[int, Field(ge=1, le=20)]
    samples: Annotated[int, Field(ge=1, le=480)]


class Listen(_Message):
    """What is to be heard."""

    type: Literal["listen"]
    source: Annotated[str, Field(max_length=40)]


class Restart(_Message):
    """Begin a stroke."""

    type: Literal["restart"]


class Repeat(_Message):
    """Whether strokes follow each other."""

    type: Literal["repeat"]
    on: bool


class Save(_Message):
    """What was played last, as a file."""

    type: Literal["save"]
    format: Literal["wav", "nc"]


class Axis(_Message):
    """A side of a map."""

    key: Key
    low: Number
    high: Number


class Map(_Message):
    """The regimes around what is played."""

    type: Literal["map"]
    x: Axis
    y: Axis
    points: Annotated[int, Field(ge=2, le=24)] = 16


class NoMap(_Message):
    """No map any more."""

    type: Literal["no map"]


Message = Scene | Pull | Listen | Restart | Repeat | Save | Map | NoMap
_ADAPTER: TypeAdapter[Any] = TypeAdapter(Annotated[Message, Field(discriminator="type")])


def message_of(text: str) -> Message:
    """Return the message that a text is.

    Raises
    ------
    ValueError
        If it is none.
    """
    try:
        found: Message = _ADAPTER.validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "message"
        raise ValueError(_line(f"{where} must be what the page sends: {first['msg'].lower()}")) from None
    return found


def _line(text: str) -> str:
    """Return a text in one line that is not too long, whatever of a message stands in it."""
    line = " ".join(text.split())
    return line if len(line) <= LONGEST else f"{line[: LONGEST - 3]}..."
