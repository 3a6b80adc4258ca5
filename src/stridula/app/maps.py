"""Maps of regimes around the played scenario, row by row."""

from __future__ import annotations

from collections.abc import AsyncIterator

import numpy as np

from .beside import Beside
from .messages import Axis, Map
from .playable import Playable
from .turned import keys_of

# Longest time simulated at each point of a map [s].
DURATION = 1.0


async def rows(beside: Beside, played: Playable, wanted: Map) -> AsyncIterator[tuple[int, list[str]]]:
    """Yield the number of each row and the regimes along it, empty where there is none, in a coarse order first."""
    across, along = values_of(wanted.x, wanted.points), values_of(wanted.y, wanted.points)
    simulation = {**played.tables["simulation"], "duration": min(played.scenario.duration, DURATION), "probes": []}
    tables = played.tables | {"simulation": simulation}
    across_keys, along_keys = (keys_of(side.key, tables) for side in (wanted.x, wanted.y))
    for row in rough_first(wanted.points):
        # A key for several places sets all of them.
        keys = [*across_keys, *along_keys]
        points = [[value] * len(across_keys) + [along[row]] * len(along_keys) for value in across]
        found = await beside.ask("regimes", tables=tables, keys=keys, points=points)
        yield row, found or []


def values_of(axis: Axis, points: int) -> list[float]:
    """Return the values along a side of a map, in SI."""
    return [float(value) for value in np.linspace(axis.low, axis.high, points)]


def rough_first(rows: int) -> list[int]:
    """Return the row numbers in an order whose first ones lie far apart."""
    bits = max(1, (rows - 1).bit_length())
    order = [int(f"{number:0{bits}b}"[::-1], 2) for number in range(2**bits)]
    return [number for number in order if number < rows]
