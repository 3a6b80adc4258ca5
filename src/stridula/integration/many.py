"""Many runs at once: side by side in vectors, and on all processors."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Hashable, Sequence
from concurrent.futures import FIRST_EXCEPTION, ThreadPoolExecutor, wait
from typing import TypeVar

import xarray as xr

from .._kernels.vectors import LANES
from ..checks import count, instance
from ..records import Probe
from ..system import System
from .contact_solve import GaussSeidel
from .marches import SimpleMarch, march_of
from .run import Run
from .schemes import Scheme
from .simulate import Request, request
from .stops import Diverged
from .together import march_together
from .watchers import Progress, Watcher

Result = TypeVar("Result")
Handler = Callable[[int, xr.Dataset, Diverged | None], Result]

# Modes above which runs side by side no longer fit a processor's first cache, so that one at a time is faster.
MOST_MODES = 160
# Fewer runs of a kind than these march one by one: a vector has to be paid whole.
FEWEST_RUNS = LANES // 2


def simulate_each(
    systems: Sequence[System],
    duration: float,
    handle: Handler[Result],
    *,
    scheme: Scheme | None = None,
    step: float | None = None,
    sample_rate: float = 100e3,
    probes: Sequence[Probe] | None = None,
    contact_solve: GaussSeidel | None = None,
    workers: int | None = None,
    watchers: Sequence[Watcher] = (),
) -> list[Result]:
    """Simulate systems and return what `handle` makes of each record.

    Runs of the same kind march side by side: those of one contact between bodies of uncoupled modes that have the same
    number of modes, law of friction, drives in number, and kinds of probes. Others march one by one. Both on as many
    processors as there are workers.

    Parameters
    ----------
    systems : sequence of System
        What to simulate.
    duration : float
        Time to simulate [s].
    handle : callable
        Called in a worker with the number of the system, its record and, where the run diverged, the exception.
    scheme, step, sample_rate, contact_solve
        As for `simulate`, the same for all; a step that is left out is the shortest of the steps that they take alone.
    probes : sequence, optional
        What else to record, on bodies of every system.
    workers : int, optional
        Threads; as many as there are processors if left out.
    watchers : sequence of callable, optional
        Called with the progress of all runs together.
    """
    asked = request(systems, duration, scheme, step, sample_rate, probes, contact_solve)
    if workers is not None:
        count("workers", workers)
    total = Total(len(systems), watchers)
    groups = together(asked)

    def march(group: Sequence[int]) -> list[tuple[int, Result]]:
        runs = [asked.run(number) for number in group]
        timing = runs[0].timing
        watch = total.watcher(len(group))
        if len(runs) == 1:
            on_the_way = march_of(runs[0].blocks, runs[0].state, timing.step, timing.ratio, asked.solve)
        else:
            blocks, states = [run.blocks for run in runs], [run.state for run in runs]
            on_the_way = SimpleMarch(blocks, states, timing.step, timing.ratio)
        march_together(runs, on_the_way, [watch])
        return [(number, _handled(handle, number, run)) for number, run in zip(group, runs, strict=True)]

    found = dict(_in_threads(march, groups, workers or os.cpu_count() or 1, total))
    return [found[number] for number in range(len(systems))]
