"""Ends of the sliders of a scenario, between which no value contradicts another one or makes it too large."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from ..scenarios.outline import look_up
from .playable import MOST_OF_SYSTEMS, Playable

# Ends of keys, the first with the smaller value.
ORDERED = (("friction.kinetic", "friction.static"), ("contact.at", "track.length"))
# Exponents of the number of modes of a plate, and the share of the largest number that sliders reach.
OF_PLATES, FILLED = {"length": 1, "width": 1, "cutoff": 1, "thickness": -1}, 0.95


def bounds_of(played: Playable) -> dict[str, tuple[float, float]]:
    """Return the ends of sliders that other values bound, in SI, by key."""
    found, room = {}, _room(played)
    for control in played.turned.controls:
        if control.key not in played.turned.values:
            continue
        ends = control.scale * control.low, control.scale * control.high
        step = control.scale * control.step
        below, above = _around(control.key, played, room)
        low, high = max([ends[0], *(one + step for one in below)]), min([ends[1], *(one - step for one in above)])
        if (low, high) != ends and low < high:
            found[control.key] = (low, high)
    return found


def _around(key: str, played: Playable, room: float) -> tuple[list[float], list[float]]:
    """Return the values above which the value of a key lies, and those below which it lies."""
    values, tables = played.turned.values, played.tables
    below, above = [], []
    for smaller, larger in ORDERED:
        if key.endswith(smaller):
            above.append(values.get(key.removesuffix(smaller) + larger))
        if key.endswith(larger):
            below.append(values.get(key.removesuffix(larger) + smaller))
    table, _, place = key.partition(".")
    body, _, name = place.rpartition(".")
    if table == "bodies" and name == "length":
        below += _places_on(body, tables)
    power = OF_PLATES.get(name) if look_up(tables, ("bodies", body, "kind")) == "modal plate" else None
    if power == 1:
        above.append(room * values[key])
    elif power == -1:
        below.append(values[key] / room)
    return [one for one in below if one is not None], [one for one in above if one is not None]


def _room(played: Playable) -> float:
    """Return the factor by which the number of modes of a system may grow."""
    if played.before is None:
        return 1.0
    return FILLED * MOST_OF_SYSTEMS / sum(body.modes().count for body in played.system.bodies)


def _places_on(body: str, tables: dict[str, Any]) -> Iterator[float]:
    """Yield the places along a body at which something touches, holds or drives it [m]."""
    for name in ("contacts", "connections", "drives"):
        for entry in look_up(tables, (name,)) or ():
            for part in (entry, *entry.values()):
                if isinstance(part, dict) and part.get("body") == body:
                    where = [part.get("point"), entry.get("at") if part is entry.get("track") else None]
                    yield from (float(one) for one in where if isinstance(one, (int, float)))
