"""Many runs at once against the same runs one after the other: whole runs, and the march alone."""

from __future__ import annotations

import os
from collections.abc import Iterator

import stridula as st
from ratios import Ratio, over, seconds, show
from stridula._kernels.vectors import LANES
from stridula.integration.marches import SimpleMarch
from systems import SIZES, beams, case_of, limit_of, marching, squeals

TITLE = "many runs: throughput over that of single runs in sequence"
BAR = 3.0
RUNS = 64
GIVEN = {"duration": 1.0, "sample_rate": 1e3, "probes": ()}
SAMPLES, RATIO = 400, 100


def rows() -> Iterator[Ratio]:
    """Yield whole runs, then the march alone over the number of modes."""
    systems, cores = squeals(RUNS), os.cpu_count() or 1
    sequence, one, all_cores = seconds(
        lambda: [st.simulate(system, **GIVEN) for system in systems],
        lambda: st.simulate_many(systems, workers=1, **GIVEN),
        lambda: st.simulate_many(systems, workers=cores, **GIVEN),
    )
    yield Ratio(f"{RUNS} squeals of 1 s, one worker: lanes alone", over(sequence, one))
    yield Ratio(f"{RUNS} squeals of 1 s, {cores} workers: lanes and threads", over(sequence, all_cores), least=BAR)
    for modes in SIZES:
        yield Ratio(f"march alone, {LANES} runs of some {modes} modes", of_the_march(modes))


def of_the_march(modes: int) -> list[float]:
    """Return the time of runs marched one after the other over that of the same runs side by side."""
    system = beams(SIZES[modes], "sliding")
    step = 0.2 * limit_of(system)
    some = [case_of(system, step)] * LANES
    single, vector = (
        SimpleMarch([one.blocks for one in group], [one.state for one in group], step, RATIO)
        for group in (some[:1], some)
    )
    one, together = marching(single, some[:1], SAMPLES), marching(vector, some, SAMPLES)
    sequence, side_by_side = seconds(lambda: [one() for _ in some], together)
    return over(sequence, side_by_side)


if __name__ == "__main__":
    show(TITLE, rows())
