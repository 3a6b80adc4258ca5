"""Messages from a page, checked, with bounded sizes and rates."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

# Largest message [bytes].
LARGEST = 100_000
# Greatest length of a line about an invalid message.
LONGEST = 300
Number = Annotated[float, Field(allow_inf_nan=False, ge=-1e15, le=1e15)]
Revision = Annotated[int, Field(ge=0, le=2**50)]
Key = Annotated[str, Field(max_length=100)]
# Number of samples that the page keeps. It has not played the later ones yet, so these are computed again.
Kept = Annotated[int, Field(ge=0, le=2**50)] | None


class _Message(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class Scene(_Message):
    """Scenario to play: a shipped case or a text, with values set by key."""

    type: Literal["scene"]
    revision: Revision
    case: Annotated[str, Field(max_length=100)] = "squeal"
    text: Annotated[str, Field(max_length=60_000)] | None = None
    overrides: Annotated[dict[Key, Number | int | Key], Field(max_length=40)] = {}
    kept: Kept = None


class Pull(_Message):
    """Number of parts and samples to play next."""

    type: Literal["pull"]
    parts: Annotated[int, Field(ge=1, le=20)]
    samples: Annotated[int, Field(ge=1, le=480)]


class Listen(_Message):
    """Source of the sound."""

    type: Literal["listen"]
    source: Annotated[str, Field(max_length=40)]
    kept: Kept = None


class Restart(_Message):
    """Request to begin a stroke."""

    type: Literal["restart"]
    kept: Kept = None


class Repeat(_Message):
    """Whether strokes are repeated."""

    type: Literal["repeat"]
    on: bool


class Save(_Message):
    """Request for the last seconds as a file."""

    type: Literal["save"]
    format: Literal["wav", "nc"]


class Axis(_Message):
    """A side of a map."""

    key: Key
    low: Number
    high: Number


class Map(_Message):
    """Request for a map of regimes around the scenario that was played at a revision."""

    type: Literal["map"]
    revision: Revision
    x: Axis
    y: Axis
    points: Annotated[int, Field(ge=2, le=24)] = 16


class NoMap(_Message):
    """Request to stop the map."""

    type: Literal["no map"]


class HoldMap(_Message):
    """Whether the map waits before its next row."""

    type: Literal["hold map"]
    on: bool


class Take(_Message):
    """Challenge to judge from now on, None for none."""

    type: Literal["challenge"]
    name: Annotated[str, Field(max_length=40)] | None


class Fit(_Message):
    """Request for the wall of a glass that sings at a frequency [Hz]."""

    type: Literal["fit"]
    revision: Revision
    frequency: Annotated[float, Field(gt=0.0, le=20_000.0, allow_inf_nan=False)]


Message = Scene | Pull | Listen | Restart | Repeat | Save | Map | NoMap | HoldMap | Take | Fit
_ADAPTER: TypeAdapter[Any] = TypeAdapter(Annotated[Message, Field(discriminator="type")])


def message_of(text: str) -> Message:
    """Return the message in a text.

    Raises
    ------
    ValueError
        If the text is not a valid message.
    """
    try:
        found: Message = _ADAPTER.validate_json(text)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "message"
        raise ValueError(_line(f"{where} must be valid: {first['msg'].lower()}")) from None
    return found


def _line(text: str) -> str:
    """Return a text in one line of limited length."""
    line = " ".join(text.split())
    return line if len(line) <= LONGEST else f"{line[: LONGEST - 3]}..."
