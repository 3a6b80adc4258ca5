"""Simulation of many systems: side by side in vectors, and on all processors."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from typing import Any, Literal, TypeVar, Unpack, overload

import xarray as xr

from .._kernels.lanes.vectors import LANES
from .._kernels.layout.columns import FINISHED
from ..checks import ArgumentError, choice, count, counted
from ..lowering import Assembly, ContactRows
from ..records.dataset import RECORDED
from ..records.plain import PlainRecord
from ..system import System
from .bars import time_shown
from .cuda_march import CudaMarch, require_cuda
from .marches import March
from .preparation import Arrays, Preparation
from .run import Run
from .settings import Given, settings_of, shows_settings
from .surface_records import ALL_POINTS
from .together import march_together
from .watchers import Progress, Watcher

# Modes above which runs side by side exceed a processor's first-level cache, so that single runs are as fast.
MOST_MODES = 120
# Least number of runs in a vector, as a vector costs the same whether it is full or not.
FEWEST_RUNS = 4
# Most runs at a time on a card, limited by the memory for their records.
MOST_ON_A_CARD = 16_384
DEVICES: dict[str, type[March]] = {"cpu": March, "cuda": CudaMarch}
T = TypeVar("T")


class Options(Given, total=False):
    """Arguments of `simulate_many` that do not change the type of its result."""

    device: str
    workers: int | None
    watchers: Sequence[Watcher]
    progress: bool
    title: str
    provenance: bool
    variables: Sequence[str] | None


@overload
def simulate_many(
    systems: Sequence[System],
    duration: float,
    reduce: None = None,
    *,
    errors: Literal["raise"] = "raise",
    labelled: Literal[True] = True,
    **options: Unpack[Options],
) -> list[xr.Dataset]: ...


@overload
def simulate_many(
    systems: Sequence[System],
    duration: float,
    reduce: None = None,
    *,
    errors: Literal["raise"] = "raise",
    labelled: Literal[False],
    **options: Unpack[Options],
) -> list[PlainRecord]: ...


@overload
def simulate_many(
    systems: Sequence[System],
    duration: float,
    reduce: Callable[[Any], T],
    *,
    errors: Literal["raise"] = "raise",
    labelled: bool = True,
    **options: Unpack[Options],
) -> list[T]: ...


@overload
def simulate_many(
    systems: Sequence[System],
    duration: float,
    reduce: Callable[[Any], Any] | None = None,
    *,
    errors: str,
    labelled: bool = True,
    **options: Unpack[Options],
) -> list[Any]: ...


@shows_settings
def simulate_many(
    systems: Sequence[System],
    duration: float,
    reduce: Callable[[Any], Any] | None = None,
    *,
    device: str = "cpu",
    workers: int | None = None,
    watchers: Sequence[Watcher] = (),
    title: str = "",
    errors: str = "raise",
    provenance: bool = True,
    labelled: bool = True,
    variables: Sequence[str] | None = None,
    progress: bool = False,
    **settings: Unpack[Given],
) -> list[Any]:
    """March many systems in time, several at once on each processor.

    Runs of the same kind march side by side: runs with the same numbers of modes, contacts and loads, paths of the same
    waves, friction laws and kinds of probes, and at most some 120 modes. Coefficients, angles, loads, damping and
    lengths may differ. All others march one by one.

    Side by side, sums over modes have another order than in single runs: records differ by round-off, which chaotic
    runs amplify. The grouping of runs in vectors has no effect.

    Parameters
    ----------
    systems : sequence of System
        Systems to simulate.
    duration : float
        Time to simulate [s].
    reduce : callable, optional
        Called with each record as soon as it is complete, in a thread; its result is kept in place of the record.
    **settings
        Settings of the run.
    device : {"cpu", "cuda"}, optional
        Device for runs of the same kind: the processors, or an NVIDIA GPU with all at once, one in each thread.
    workers : int, optional
        Number of runs or groups of them at a time; the number of processors if left out.
    watchers : sequence of callable, optional
        Called with the `Progress` of all runs, from threads; simulated times are sums over the runs.
    title : str, optional
        Title of the records.
    errors : {"raise", "return"}, optional
        Whether a system that cannot be simulated, or a record on which `reduce` fails, ends all runs, or has its
        exception as result while the others continue.
    provenance : bool, optional
        Whether each record has its scenario in ``attrs["scenario"]``; records that are reduced at once may not need it.
    labelled : bool, optional
        Whether records are labelled Datasets; else each is a `PlainRecord`, arrays over time by name, which takes a
        fraction of the time. `analysis.regime_of` accepts both.
    variables : sequence of str, optional
        Names of the variables in plain records; all if left out.
    progress : bool, optional
        Whether to show a bar on standard error with the total simulated time of all runs, the speed and the time left.

    Returns
    -------
    list
        The record of each system, or the result of `reduce`, in the order of `systems`. A run that diverged has the
        record up to that point, with the kind of divergence in ``attrs["ended"]``, place and cause in
        ``attrs["message"]``.

    Raises
    ------
    ValueError
        If an argument is out of its range, or if a system cannot be simulated with it and `errors` is ``"raise"``.
    RuntimeError
        If a GPU is requested and cannot be used; the message names the missing part.

    See Also
    --------
    simulate : Simulate one system; describes the content of a record.
    """
    asked = settings_of("simulate_many", settings)
    if not isinstance(systems, Sequence) or isinstance(systems, str):
        raise ArgumentError("systems", "be a list of systems", systems)
    if reduce is not None and not callable(reduce):
        raise ArgumentError("reduce", "be a function of a record", reduce)
    if workers is not None:
        count("workers", workers)
    if not isinstance(watchers, Sequence):
        raise ArgumentError("watchers", "be a list of callables", watchers)
    if not isinstance(device, str) or device not in DEVICES:
        raise ArgumentError("device", f"be one of {', '.join(DEVICES)}", device)
    choice("errors", errors, ("raise", "return"))
    wanted = _wanted(variables, labelled)
    if device == "cuda":
        require_cuda()
    if asked.surface_rate is None and not labelled:
        asked = replace(asked, surface_rate=ALL_POINTS)
    preparation = Preparation(duration, asked)
    results = _Results(errors == "return")
    record = partial(Run.record, provenance=provenance) if labelled else Run.plain_record
    with time_shown(progress, title or f"simulate {counted(len(systems), 'system')}") as more:
        arrays, preparation = _arrays(systems, preparation, results)
        told = [*watchers, *more]
        together = _Together(
            preparation,
            arrays,
            record=record,
            reduce=reduce,
            watchers=told,
            side_by_side=DEVICES[device],
            title=title,
            results=results,
            wanted=wanted,
        )
        together.march_all(_groups(arrays, device), workers or os.cpu_count() or 1)
    return [results.found[number] for number in range(len(systems))]


def _arrays(
    systems: Sequence[System], preparation: Preparation, results: _Results
) -> tuple[dict[int, Arrays], Preparation]:
    """Return the systems that can be simulated as flat arrays, and their preparation at the shortest of their steps."""
    arrays: dict[int, Arrays] = {}
    steps = []
    for number, system in enumerate(systems):
        with results.failing(number, f"systems[{number}]"):
            one = preparation.arrays(system)
            steps.append(preparation.timing(one).step)
            arrays[number] = one
    is_given = preparation.settings.step is not None
    return arrays, preparation if is_given else replace(preparation, common_step=min(steps, default=None))


def _wanted(variables: Sequence[str] | None, labelled: bool) -> Sequence[str]:
    """Return the names of the variables in records."""
    if variables is None:
        return RECORDED
    if labelled or isinstance(variables, str) or not isinstance(variables, Sequence):
        raise ArgumentError("variables", "be a list of names, and labelled False", variables)
    for name in variables:
        choice("variables", name, RECORDED)
    return variables


class _Results:
    """Results of the systems, including exceptions if these do not end all runs."""

    def __init__(self, keeps_exceptions: bool) -> None:
        self.keeps_exceptions = keeps_exceptions
        self.found: dict[int, Any] = {}

    @contextmanager
    def failing(self, number: int, where: str = "") -> Iterator[None]:
        """Keep an exception as the result of a system, or raise it; a ValueError names the system.

        A MemoryError is always raised, as it is not due to the system.
        """
        try:
            yield
        except Exception as error:
            if self.keeps_exceptions and not isinstance(error, MemoryError):
                self.found[number] = error
            elif where and isinstance(error, ArgumentError):
                raise error.inside(where) from None
            elif where and isinstance(error, ValueError):
                raise ValueError(f"{where}: {error}") from None
            else:
                raise


def _groups(arrays: Mapping[int, Arrays], device: str = "cpu") -> list[list[int]]:
    """Return the numbers of the systems that march together, the largest groups first."""
    largest, fewest, most_modes = (LANES, FEWEST_RUNS, MOST_MODES) if device == "cpu" else (MOST_ON_A_CARD, 1, None)
    kinds: dict[Hashable, list[int]] = {}
    for number, one in arrays.items():
        kinds.setdefault(_kind(one, most_modes) or number, []).append(number)
    groups = []
    for numbers in kinds.values():
        for first in range(0, len(numbers), largest):
            group = numbers[first : first + largest]
            groups += [group] if len(group) >= fewest else [[number] for number in group]
    return sorted(groups, key=len, reverse=True)


def _kind(arrays: Arrays, most_modes: int | None) -> Hashable | None:
    """Return a key that is equal for runs that march side by side, None for a run that marches alone."""
    flat = arrays.flat
    if most_modes and flat.mode_count + flat.coupled**2 > most_modes:
        return None
    contacts = tuple(
        (one.bending, one.axial, len(one.fixed), _waves(one), _law(one), one.contact.layers_of_heat)
        for one in flat.contacts
    )
    probes = tuple(one.form for one in flat.probes)
    pushed = len(flat.loads), len(flat.springs.bends)
    return flat.mode_count, flat.coupled, contacts, _turned(flat), pushed, probes


def _turned(flat: Assembly) -> Hashable:
    """Return the pairs of modes that are carried round, and the bodies round which contacts move."""
    bodies = tuple((one.span, one.pairs.tobytes(), one.has_circle) for one in flat.turning)
    return bodies, tuple(one.circle and one.circle.span for one in flat.contacts)


def _law(one: ContactRows) -> Hashable:
    return one.contact.law.law, one.contact.law.kernel_code


def _waves(one: ContactRows) -> Hashable:
    """Return a key of the waves of the modes of a path."""
    if one.bending == one.axial:
        return None
    track: Any = one.contact.track
    path = track.path()
    return tuple((waves.multiples.tobytes(), waves.cosines, waves.products) for waves in (path.normal, path.tangential))


class _Cancelled(Exception):
    """Raised to stop a run because another one failed."""


class _Together:
    """Groups of runs in progress."""

    def __init__(
        self,
        preparation: Preparation,
        arrays: Mapping[int, Arrays],
        *,
        record: Callable[[Run], xr.Dataset | PlainRecord],
        reduce: Callable[[Any], Any] | None,
        watchers: Sequence[Watcher],
        side_by_side: type[March],
        title: str,
        results: _Results,
        wanted: Sequence[str] = RECORDED,
    ) -> None:
        self.side_by_side, self.title, self.began = side_by_side, title, time.perf_counter()
        self.preparation, self.arrays, self.reduce, self.watchers = preparation, arrays, reduce, watchers
        self.record, self.results, self.wanted = record, results, wanted
        self.stop, self.lock, self.simulated = threading.Event(), threading.Lock(), 0.0

    def march_all(self, groups: Sequence[Sequence[int]], workers: int) -> None:
        """March groups in threads; the first failure ends the others. The compiled march lets other threads run."""
        if not groups:
            return
        with ThreadPoolExecutor(min(workers, len(groups))) as pool:
            futures = [pool.submit(self.march, group) for group in groups]
            try:
                wait(futures, return_when=FIRST_EXCEPTION)
                for future in futures:
                    if future.done():
                        future.result()
            finally:
                self.stop.set()
                pool.shutdown(wait=False, cancel_futures=True)

    def march(self, group: Sequence[int]) -> None:
        """March a group and keep its results."""
        started: dict[int, Run] = {}
        for number in group:
            with self.results.failing(number):
                started[number] = self.preparation.run(self.arrays[number], title=self.title)
                if self.wanted is not RECORDED:
                    started[number].keep_only(self.wanted)
        runs = list(started.values())
        if not runs:
            return
        if march_together(runs, self._march_of(runs), [self._watch(runs)]):
            raise KeyboardInterrupt
        for number, run in started.items():
            record = self.record(run)
            if run.has_diverged:
                record.attrs["message"] = run.told_of_divergence()
            with self.results.failing(number):
                self.results.found[number] = record if self.reduce is None else self.reduce(record)

    def _march_of(self, runs: Sequence[Run]) -> March:
        timing = runs[0].timing
        blocks, states = [run.blocks for run in runs], [run.state for run in runs]
        return self.side_by_side(blocks, states, timing.step, timing.ratio, self.preparation.settings.solve)

    def _watch(self, runs: Sequence[Run]) -> Watcher:
        """Return a watcher that reports the progress of all runs, and stops the group if another one has failed."""
        before = 0.0

        def watch(progress: Progress) -> None:
            nonlocal before
            if self.stop.is_set():
                raise _Cancelled
            # A run that has ended counts as complete.
            over = all(run.ended != FINISHED for run in runs)
            reached = progress.duration if over else progress.time
            with self.lock:
                self.simulated += (reached - before) * len(runs)
                before = reached
                seconds = time.perf_counter() - self.began
                whole = Progress(self.simulated, progress.duration * len(self.arrays), seconds)
                for one in self.watchers:
                    one(whole)

        return watch
