"""The tables of probes in a scenario file."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING, Annotated, Any, Literal

from ..declared import Whole, declared
from ..records import probes
from . import fields as is_
from .derived import Keys, one_of, table_of
from .kinds import Read

*FIRST, LAST = (kind.quantity for kind in probes.PROBES)
KINDS = f"{', '.join(FIRST)} or {LAST}"
BODY = "body: slider, track or its name; the track if left out, the slider on a rigid track"
CONNECTION = "number of the connection, from 0 in the order of the connections"
POINT = "point: tip, root, centre, the name of a point or a position [m]; centre or tip if left out"
# Keys with another name than the argument.
RENAMED: dict[str, Keys] = {"reaction": {"direction": (Literal[probes.COMPONENTS], "moment", "x, y or moment")}}


def _place(on: str) -> Keys:
    """Return the keys of the place of a probe, none for that of the slider."""
    if on == "connection":
        return {"connection": (Annotated[Any, Read(Whole(0))], ..., CONNECTION)}
    body: Keys = {} if on == "slider" else {"body": (str | None, None, BODY)}
    return {**body, "point": (is_.Point | None, None, POINT)} if on == "point" else body


def _fields(kind: Any) -> Any:
    return kind.on, declared(kind)


def _table(kind: type[probes.Probe], *others: type[probes.Probe]) -> Any:
    """Return the table of probes with the same fields."""
    quantities = tuple(one.quantity for one in (kind, *others))
    return table_of(kind, "quantity", quantities, KINDS, before=_place(kind.on), after=RENAMED.get(kind.quantity))


if TYPE_CHECKING:
    Probe = Any
else:
    Probe = one_of("quantity", (_table(*alike) for _, alike in groupby(probes.PROBES, _fields)))
