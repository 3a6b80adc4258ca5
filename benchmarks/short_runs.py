"""Many short squeals with their regimes over the march alone: the overhead of Python beside the compiled loop."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import stridula as st
from ratios import Ratio, over, seconds, show, sized
from stridula._kernels.lanes.vectors import LANES
from stridula.analysis.regimes import TAKEN, regime_of
from stridula.integration.marches import March
from systems import SCHEME, Case, case_of, limit_of, marching, squeals

# The ratio equals that of 10 000 runs: the part that does not grow with the runs takes a millisecond.
RUNS, DURATION = sized((1000, 0.2), (8, 0.02))
WORKERS, RATE = 2, 20e3
TITLE = f"{RUNS} squeals of {DURATION:g} s with their regimes, {WORKERS} workers"
BAR = 1.6


def rows() -> Iterator[Ratio]:
    """Yield the time of all over that of the march alone."""
    systems = squeals(RUNS)
    whole, march = seconds(lambda: regimes(systems), marches(systems))
    yield Ratio("whole study over the march alone", over(whole, march), most=BAR)


def regimes(systems: Sequence[st.System]) -> list[Any]:
    """Simulate systems without any cached results, and return their regimes."""
    given = {"sample_rate": RATE, "probes": (), "workers": WORKERS, "labelled": False, "variables": TAKEN}
    return st.simulate_many([replace(system) for system in systems], DURATION, regime_of, **given)


def marches(systems: Sequence[st.System]) -> Any:
    """Return a function that marches the same systems, prepared before, eight side by side in each thread."""
    interval = 1.0 / RATE
    shortest = min(SCHEME.default_fraction * limit_of(system) for system in systems)
    ratio = int(-(-interval // shortest))
    step, samples = interval / ratio, round(DURATION / interval)
    cases: list[Case] = [case_of(system, step) for system in systems]
    groups = [cases[first : first + LANES] for first in range(0, len(cases), LANES)]
    ready = [
        marching(March([one.blocks for one in some], [one.state for one in some], step, ratio), some, samples)
        for some in groups
    ]

    def march() -> None:
        with ThreadPoolExecutor(WORKERS) as pool:
            list(pool.map(lambda one: one() and None, ready))

    return march


if __name__ == "__main__":
    show(TITLE, rows())
