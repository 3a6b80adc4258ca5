"""March of runs together, in chunks, to their ends."""

from __future__ import annotations

import time as clock
from collections.abc import Hashable, Sequence

from .._kernels.lanes.vectors import LANES
from .._kernels.layout.columns import FINISHED
from .interrupts import DeferredInterrupt
from .marches import Excitation, March, compilations
from .run import Run
from .watchers import Progress, Watcher

STEPS_PER_CHUNK, SAMPLES_PER_CHUNK = 20_000, 1000


def march_together(runs: Sequence[Run], march: March, watchers: Sequence[Watcher] = ()) -> bool:
    """March runs of the same timing to their ends, or to a Ctrl-C between chunks; return whether there was one."""
    timing, done = runs[0].timing, 0
    vectors = -(-len(runs) // LANES)
    samples_per_chunk = max(1, STEPS_PER_CHUNK // (timing.ratio * vectors))
    if all(run.impositions.is_steady and not run.probes for run in runs):
        # No array has a row for each step, so that chunks may be longer.
        samples_per_chunk = max(
            samples_per_chunk, min(SAMPLES_PER_CHUNK // vectors, 10 * STEPS_PER_CHUNK // timing.ratio)
        )
    with DeferredInterrupt() as interrupt:
        compile_time = _compiled(runs, march)
        began = clock.perf_counter()
        while done < timing.samples and any(run.ended == FINISHED for run in runs) and not interrupt.requested:
            count = min(samples_per_chunk, timing.samples - done)
            chunks = march.advance(_imposed(runs, done, count), count)
            for run, chunk in zip(runs, chunks, strict=True):
                run.take(chunk)
            done += count
            reached = max(run.done for run in runs) * timing.interval
            progress = Progress(reached, timing.samples * timing.interval, clock.perf_counter() - began)
            try:
                for watch in watchers:
                    watch(progress)
            except KeyboardInterrupt:
                interrupt.requested = True
        ahead = max(run.samples_ahead for run in runs)
        beyond = march.copy().advance(_imposed(runs, done, ahead), ahead) if ahead else None
    for number, (run, state) in enumerate(zip(runs, march.states, strict=True)):
        run.finish(state, beyond[number] if beyond and run.samples_ahead else None)
        run.compile_time, run.wall_time = compile_time, (clock.perf_counter() - began) / len(runs)
    return interrupt.requested


def _compiled(runs: Sequence[Run], march: March) -> float:
    """Compile the kernel, or load it from disk, before the clock starts; return the time of compilation [s]."""
    if march.is_compiled:
        return 0.0
    began, before = clock.perf_counter(), compilations()
    march.copy().advance(_imposed(runs, 0, 1), 1)
    return clock.perf_counter() - began if compilations() > before else 0.0


def _imposed(runs: Sequence[Run], first_sample: int, samples: int) -> list[Excitation]:
    """Return the imposed signals and motions of each run, the same object for runs that share them."""
    keys: list[Hashable] = [(run.arrays.prescribed, run.blocks.used, run.first_step) for run in runs]
    found: dict[Hashable, Excitation] = {}
    for run, key in zip(runs, keys, strict=True):
        if key not in found:
            found[key] = run.imposed(first_sample, samples)
    return [found[key] for key in keys]
