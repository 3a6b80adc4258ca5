"""Maps of regimes around what is played, computed beside it in a process of low priority."""

from __future__ import annotations

import asyncio
import contextlib
import multiprocessing
import os
from collections.abc import AsyncIterator
from concurrent.futures import ProcessPoolExecutor
from typing import Any

import numpy as np

from .messages import Axis, Map
from .playable import Playable

# What each point of a map is marched for at most [s].
DURATION = 1.0
NICENESS = 10


class MapMaker:
    """The process that computes maps, row by row; it is there while a page is open."""

    def __init__(self) -> None:
        self._pool: ProcessPoolExecutor | None = None

    async def rows(self, played: Playable, wanted: Map) -> AsyncIterator[tuple[int, list[str]]]:
        """Yield the number of a row and the regimes along it, empty where there is none, rough rows first."""
        across, along = values_of(wanted.x, wanted.points), values_of(wanted.y, wanted.points)
        simulation = {**played.tables["simulation"], "duration": min(played.scenario.duration, DURATION), "probes": []}
        tables = played.tables | {"simulation": simulation}
        loop = asyncio.get_running_loop()
        for row in rough_first(wanted.points):
            points = [(value, along[row]) for value in across]
            found = await loop.run_in_executor(self._started(), regimes, tables, (wanted.x.key, wanted.y.key), points)
            yield row, found

    def close(self) -> None:
        """Let the process end."""
        if self._pool is not None:
            self._pool.shutdown(wait=False, cancel_futures=True)
            self._pool = None

    def _started(self) -> ProcessPoolExecutor:
        if self._pool is None:
            context = multiprocessing.get_context("spawn")
            self._pool = ProcessPoolExecutor(1, mp_context=context, initializer=_begin)
        return self._pool


def values_of(axis: Axis, points: int) -> list[float]:
    """Return the values along a side of a map, in SI."""
    return [float(value) for value in np.linspace(axis.low, axis.high, points)]


def rough_first(rows: int) -> list[int]:
    """Return the numbers of rows so that any first few lie far apart."""
    bits = max(1, (rows - 1).bit_length())
    order = [int(f"{number:0{bits}b}"[::-1], 2) for number in range(2**bits)]
    return [number for number in order if number < rows]


def regimes(tables: dict[str, Any], keys: tuple[str, str], points: list[tuple[float, float]]) -> list[str]:
    """Return the regime at some points, empty where there is none."""
    from ..scenarios.keys import located
    from ..studies.measures import asked_for
    from ..studies.sweeps import SAMPLE_RATE
    from ..studies.task import Task

    changed, places, problems = located(tables, dict(zip(keys, points[0], strict=True)))
    if problems:
        return [""] * len(points)
    task = Task(changed, tuple(places[key] for key in keys), asked_for(["regime"]), SAMPLE_RATE, False)
    return [str(outcome["values"].get("regime", "")) for outcome in task.outcomes(points)]


def _begin() -> None:
    """Stand back behind the sound."""
    import signal

    from ..studies.task import use_one_thread

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with contextlib.suppress(OSError, AttributeError):
        os.nice(NICENESS)
    use_one_thread()
