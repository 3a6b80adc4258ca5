"""The tables of drives and their histories in a scenario file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .. import drives, histories
from . import fields as is_
from .derived import Keys, one_of, table_of

HISTORIES = "constant, ramp, harmonic or sampled"
KINDS = "force, imposed velocity, gravity, initial velocity, initial state or initial equilibrium"
BODIES = {
    "force": "body it acts on: slider, track or its name",
    "imposed velocity": "beam whose root moves: slider or its name",
    "initial velocity": "body that moves at the start: slider, track or its name",
    "initial state": "point mass or reduced body in this state: slider, track or its name",
}
POINT = "point of action: tip, root, centre, the name of a point or a position [m]; root or centre if left out"
FACTORS = {
    "force": "factor over time, constant if left out",
    "imposed velocity": "factor on the velocity over time, constant if left out",
}
VECTORS: Keys = {
    name: (is_.Vector | None, None, f"{name} of every degree of freedom at the start, zero if left out [{unit}]")
    for name, unit in (("displacement", "m"), ("velocity", "m/s"))
}


def _drive(kind: type[drives.Drive]) -> Any:
    """Return the table of a drive, with its place first and its history last."""
    where: dict[str, Any] = {"body": (str, "slider", BODIES[kind.kind])} if kind.place else {}
    if kind.place == "point":
        where["point"] = (is_.Point | None, None, POINT)
    rest = {"history": (History | None, None, FACTORS[kind.kind])} if kind.kind in FACTORS else {}
    if kind is drives.InitialState:
        rest |= VECTORS
    return table_of(kind, "kind", kind.kind, KINDS, before=where, after=rest)


if TYPE_CHECKING:
    History = Any
    Drive = Any
else:
    History = one_of("kind", [table_of(kind, "kind", kind.kind, HISTORIES) for kind in histories.HISTORIES])
    Drive = one_of("kind", map(_drive, drives.DRIVES))
