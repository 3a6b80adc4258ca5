"""The paper's cases against real time, on one core: simulated time over wall time of the whole `simulate`.

Alone, and as eight runs side by side; recorded at 1 kHz without probes and at the default 100 kHz with the
acceleration of the track; at the step that the package chooses and at 10 µs. The table
shows the slowest of the six cases.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator

import stridula as st
from ratios import REPEATS, WARM_UP, Ratio, show, sized
from stridula._kernels.lanes.vectors import LANES
from stridula.papers.laulagnet_2011.runs import CASES
from stridula.scenarios import load_scenario

TITLE = "simulated time over wall time, slowest case of the paper, one core"
BAR = 100.0
DURATION = sized(1.0, 0.01)
RECORDS = {"1 kHz": {"sample_rate": 1e3, "probes": ()}, "100 kHz": {}}
STEPS = {"default step": None, "10 us": 1e-5}


def rows() -> Iterator[Ratio]:
    """Yield the slowest case for each kind of run."""
    systems = {name: load_scenario(name).system for name in CASES}
    for record, options in RECORDS.items():
        for words, step in STEPS.items():
            given = {**options, "step": step}
            for way, speed in {"alone": alone, f"{LANES} side by side": side_by_side}.items():
                name, values = slowest(systems, lambda system, speed=speed, given=given: speed(system, given))
                yield Ratio(f"{record}, {words}, {way} ({name})", values, least=BAR)


def slowest(systems: dict[str, st.System], speed: Callable[[st.System], float]) -> tuple[str, list[float]]:
    """Return the case with the lowest median, and its values: all cases in each repeat, without the first round."""
    rounds = [{name: speed(system) for name, system in systems.items()} for _ in range(WARM_UP + REPEATS)][WARM_UP:]
    values = {name: [one[name] for one in rounds] for name in systems}
    return min(values.items(), key=lambda item: statistics.median(item[1]))


def alone(system: st.System, given: dict) -> float:
    """Return the speed of one run."""
    began = time.perf_counter()
    st.simulate(system, DURATION, **given)
    return DURATION / (time.perf_counter() - began)


def side_by_side(system: st.System, given: dict) -> float:
    """Return the speed of runs in one vector, with the sum of their simulated times."""
    began = time.perf_counter()
    st.simulate_many([system] * LANES, DURATION, workers=1, **given)
    return LANES * DURATION / (time.perf_counter() - began)


if __name__ == "__main__":
    show(TITLE, rows())
