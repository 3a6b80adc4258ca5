"""Maps of regimes around what is played, computed beside it in a process of low priority."""

from __future__ import annotations

import asyncio
import contextlib
import json
import sys
from collections.abc import AsyncIterator
from typing import Any

import numpy as np

from .messages import Axis, Map
from .playable import Playable

# What each point of a map is marched for at most [s].
DURATION = 1.0
# Longest line of a row [bytes].
LONGEST = 1_000_000


class MapMaker:
    """The process that computes maps, row by row for one page after the other; it is there while a page is open."""

    def __init__(self) -> None:
        self._process: asyncio.subprocess.Process | None = None
        self._turn = asyncio.Lock()
        self._closed = 0

    async def rows(self, played: Playable, wanted: Map) -> AsyncIterator[tuple[int, list[str]]]:
        """Yield the number of a row and the regimes along it, empty where there is none, rough rows first."""
        across, along = values_of(wanted.x, wanted.points), values_of(wanted.y, wanted.points)
        simulation = {**played.tables["simulation"], "duration": min(played.scenario.duration, DURATION), "probes": []}
        asked: dict[str, Any] = {"tables": played.tables | {"simulation": simulation}}
        asked["keys"] = [wanted.x.key, wanted.y.key]
        for row in rough_first(wanted.points):
            asked["points"] = [[value, along[row]] for value in across]
            yield row, await self._answer(json.dumps(asked))

    def close(self) -> None:
        """End the process."""
        if self._process is not None and self._process.returncode is None:
            with contextlib.suppress(ProcessLookupError):
                self._process.kill()
        self._process = None
        self._closed += 1

    async def _answer(self, line: str) -> list[str]:
        """Return a row in its turn; one that nobody waits for any more is not begun, for it would begin the process."""
        await self._turn.acquire()
        # Once begun it is computed to its end, so that answers keep their order.
        return await asyncio.shield(asyncio.ensure_future(self._computed(line, self._closed)))

    async def _computed(self, line: str, closed: int) -> list[str]:
        try:
            if closed != self._closed:
                return []
            process = await self._started()
            if closed != self._closed:
                # The last page went while the process began.
                self.close()
                return []
            assert process.stdin is not None
            assert process.stdout is not None
            with contextlib.suppress(ConnectionError):
                process.stdin.write(line.encode() + b"\n")
                await process.stdin.drain()
            found = await process.stdout.readline()
            # The last page has gone, and the process with it.
            return json.loads(found) if found else []
        finally:
            self._turn.release()

    async def _started(self) -> asyncio.subprocess.Process:
        if self._process is None or self._process.returncode is not None:
            pipe = asyncio.subprocess.PIPE
            self._process = await asyncio.create_subprocess_exec(
                sys.executable, "-m", "stridula.app.map_worker", stdin=pipe, stdout=pipe, limit=LONGEST
            )
        return self._process


def values_of(axis: Axis, points: int) -> list[float]:
    """Return the values along a side of a map, in SI."""
    return [float(value) for value in np.linspace(axis.low, axis.high, points)]


def rough_first(rows: int) -> list[int]:
    """Return the numbers of rows so that any first few lie far apart."""
    bits = max(1, (rows - 1).bit_length())
    order = [int(f"{number:0{bits}b}"[::-1], 2) for number in range(2**bits)]
    return [number for number in order if number < rows]
