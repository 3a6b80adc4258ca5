"""Many runs at once against the same runs one after the other: whole runs, and the march alone."""

from __future__ import annotations

import os
from collections.abc import Iterator

import stridula as st
from ratios import Ratio, must_agree, over, seconds, show, sized
from stridula._kernels.lanes.vectors import LANES
from stridula.integration.marches import Chunk, March
from systems import FORCES, GIVEN, RUNS, SIZES, TOLERANCE, beams, case_of, limit_of, marching, same_start, squeals

TITLE = "many runs: throughput over that of single runs in sequence"
BAR = 3.0
SAMPLES, RATIO = sized(400, 10), 100


def rows() -> Iterator[Ratio]:
    """Yield whole runs, then the march alone over the number of modes."""
    systems, cores = squeals(RUNS), os.cpu_count() or 1
    sequence, one, all_cores = seconds(
        lambda: [st.simulate(system, **GIVEN) for system in systems],
        lambda: st.simulate_many(systems, workers=1, **GIVEN),
        lambda: st.simulate_many(systems, workers=cores, **GIVEN),
        agree=same_start,
    )
    yield Ratio(f"{RUNS} squeals of {GIVEN['duration']:g} s, one worker: lanes alone", over(sequence, one))
    yield Ratio(
        f"{RUNS} squeals of {GIVEN['duration']:g} s, {cores} workers: lanes and threads",
        over(sequence, all_cores),
        least=BAR,
    )
    for modes in SIZES:
        yield Ratio(f"march alone, {LANES} runs of some {modes} modes", of_the_march(modes))


def of_the_march(modes: int) -> list[float]:
    """Return the time of runs marched one after the other over that of the same runs side by side."""
    system = beams(SIZES[modes], "sliding")
    step = 0.2 * limit_of(system)
    some = [case_of(system, step)] * LANES
    single, vector = (
        March([one.blocks for one in group], [one.state for one in group], step, RATIO) for group in (some[:1], some)
    )
    one, together = marching(single, some[:1], SAMPLES), marching(vector, some, SAMPLES)
    sequence, side_by_side = seconds(lambda: [one()[0] for _ in some], together, agree=same_march)
    return over(sequence, side_by_side)


def same_march(found: list[Chunk], expected: list[Chunk]) -> None:
    """Exit if the recorded forces differ."""
    here, there = ([run.contacts[..., FORCES] for run in runs] for runs in (found, expected))
    must_agree("forces of runs marched side by side and alone", here, there, TOLERANCE)


if __name__ == "__main__":
    show(TITLE, rows())
