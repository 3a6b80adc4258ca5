"""Points of a study in parts, computed here or on other machines, saved on disk and resumed from there."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import xarray as xr

from ..bars.line_bars import Show
from ..checks import ArgumentError, count, instance
from ..integration.bars import bar
from .machines import on_machines
from .parts import Parts
from .processes import Helpers
from .task import Outcome, Stopped, Work, one_thread_each


@dataclass(frozen=True)
class SweepProgress:
    """Progress of a sweep or a survey.

    Attributes
    ----------
    done : int
        Number of points done, including those of an earlier call.
    points : int
        Total number of points.
    wall_time : float
        Time since the start of this call [s].
    resumed : int
        Number of points done in earlier calls.
    """

    done: int
    points: int
    wall_time: float
    resumed: int = 0


Watcher = Callable[[SweepProgress], None]


@dataclass(frozen=True)
class Plan:
    """A study to be computed.

    Attributes
    ----------
    study : str
        Kind of study in one word; also the name of the attribute with its arguments.
    work : Work
        Work at each point.
    values : list of tuple
        Values of the keys at each point.
    size : int
        Number of points of a part, the unit of computation on every machine.
    attributes : dict of str
        Attributes of the result, which record its origin.
    labelled : callable
        Function of the outcomes of all points that returns the result.
    """

    study: str
    work: Work
    values: list[tuple[Any, ...]]
    size: int
    attributes: dict[str, str]
    labelled: Callable[[Sequence[Outcome]], xr.Dataset]

    @property
    def identity(self) -> dict[str, str]:
        """Attributes that distinguish this study from others."""
        return {name: value for name, value in self.attributes.items() if name != "title"}

    @cached_property
    def parts(self) -> dict[int, list[tuple[Any, ...]]]:
        """Values of the points of each part."""
        starts = range(0, len(self.values), self.size)
        return {number: self.values[first : first + self.size] for number, first in enumerate(starts)}


def told_of_points(show: Show) -> Watcher:
    """Return a watcher that shows the points done in a bar."""

    def watch(reached: SweepProgress) -> None:
        words = f"{reached.done} of {reached.points} points"
        show(reached.done, reached.points, words, reached.resumed)

    return watch


def check_options(workers: Any, client: Any, watchers: Any, progress: Any) -> None:
    """Raise ValueError unless these options of a study are valid."""
    if workers is not None:
        count("workers", workers)
    if not isinstance(watchers, Sequence):
        raise ArgumentError("watchers", "be a list of callables", watchers)
    instance("progress", progress, bool)
    if client is not None and not callable(getattr(client, "submit", None)):
        raise ArgumentError("client", "be a client of dask.distributed", client)


def computed(
    plan: Plan,
    out: str | Path | None,
    workers: int | None,
    client: Any,
    watchers: Sequence[Watcher],
    progress: bool = False,
) -> xr.Dataset:
    """Compute the remaining points of a study and return all of it, with a bar on request."""
    if not progress:
        return _computed(plan, out, workers, client, watchers)
    with bar(plan.attributes.get("title", "") or plan.study, asked=True) as show:
        return _computed(plan, out, workers, client, [*watchers, told_of_points(show)])


def _computed(
    plan: Plan, out: str | Path | None, workers: int | None, client: Any, watchers: Sequence[Watcher]
) -> xr.Dataset:
    """Compute the remaining points of a study and return all of it.

    Parameters
    ----------
    plan : Plan
        The study.
    out : str, Path or None
        File to write; finished parts are kept beside it.
    workers : int or None
        Parts at a time; one per processor if None.
    client : distributed.Client or None
        Machines that compute the parts, in place of this one.
    watchers : sequence of callable
        Called with a `SweepProgress` after each part.

    Raises
    ------
    ValueError
        If `out` is another file or that of another study.
    OSError
        If the file or a part cannot be written; finished parts are kept.
    RuntimeError
        If a part fails on other machines; finished parts are kept.
    """
    began = time.perf_counter()
    store = None if out is None else Parts(out, plan.identity, plan.study)
    if store is not None and store.finished is not None:
        store.clear()
        return store.finished
    done = {} if store is None else store.done({number: len(part) for number, part in plan.parts.items()})
    left = {number: part for number, part in plan.parts.items() if number not in done}
    resumed = sum(map(len, done.values()))

    def report() -> None:
        reached = sum(map(len, done.values()))
        for watch in watchers:
            watch(SweepProgress(reached, len(plan.values), time.perf_counter() - began, resumed))

    if done:
        report()
    with one_thread_each():
        found = _here(plan.work, left, workers) if client is None else on_machines(client, plan.work, left)
        with closing(found):
            for number, outcomes in found:
                if store is not None:
                    store.keep(number, outcomes)
                done[number] = outcomes
                report()
    whole = plan.labelled([outcome for number in plan.parts for outcome in done[number]])
    if store is not None:
        store.finish(whole)
    return whole


def _here(
    work: Work, parts: Mapping[int, Sequence[Sequence[Any]]], workers: int | None
) -> Generator[tuple[int, list[Outcome]]]:
    """Yield the parts with their outcomes as they are finished on this machine.

    Threads compute them, and also processes once that is faster.
    """
    if not parts:
        return
    processors = workers or os.cpu_count() or 1
    threads = min(processors, len(parts))
    stop = threading.Event()

    def watch() -> None:
        if stop.is_set():
            raise Stopped

    pool, helpers = ThreadPoolExecutor(threads), Helpers(work, len(parts), threads)
    try:
        futures = {pool.submit(helpers.outcomes, part, processors // threads, watch): n for n, part in parts.items()}
        for future in as_completed(futures):
            yield futures[future], future.result()
    finally:
        stop.set()
        helpers.close()
        pool.shutdown(wait=False, cancel_futures=True)
