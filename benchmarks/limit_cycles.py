"""Limit cycles: time to find one, over that of the run that settles to it, and periods marched.

The wine glass is sung up from a small vibration. The search begins where its vibration has grown to half of its final
size; the run goes on from there until the size stays within 1 %. Both agree in the amplitude of the rim.
"""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np
import xarray as xr

import stridula as st
from ratios import REPEATS, WARM_UP, Ratio, must_agree, over, seconds, show, sized

TITLE = "limit cycles: time over that of the transient, periods marched over the bar"
# Most periods marched for a cycle with its multipliers, and most seconds for a branch of 30 points.
MARCHED, BRANCH = 500.0, 60.0
GROWN, SETTLED = 0.5, 0.01
POINTS = sized(30, 4)


def rows() -> Iterator[Ratio]:
    """Yield the lines of the wine glass and of a branch."""
    scenario = st.load_scenario("glass")
    system, probes = scenario.system, scenario.probes
    begin, until = _times(system, probes)
    half = st.simulate(system, begin, probes=probes)
    found: list[xr.Dataset] = []

    def transient() -> float:
        run = st.simulate(system, until - begin, start=half, probes=probes)
        return float(np.ptp(run["velocity"].values[-2000:, 0]) / 2.0)

    def cycle() -> float:
        found.append(st.limit_cycle(system, half, probes=probes))
        return float(found[-1]["velocity_amplitude"][0])

    taken = seconds(transient, cycle, agree=lambda a, b: must_agree("velocities of the rim", a, b, 2.0 * SETTLED))
    yield Ratio(f"wine glass: cycle with multipliers over {until - begin:.2g} s of transient", over(taken[1], taken[0]))
    marched = float(found[-1]["periods_marched"]) / MARCHED
    yield Ratio(f"wine glass: periods marched over {MARCHED:g}", [marched], most=1.0)
    yield Ratio(f"branch of {POINTS} points of a block on a belt over {BRANCH:g} s", _branches(), most=1.0)


def _times(system: st.System, probes: object) -> tuple[float, float]:
    """Return the times at which the vibration has half its size and from which it stays within 1 % [s]."""
    run = st.simulate(system, 2.0, probes=probes)
    speed = np.abs(run["velocity"].values[:, 0])
    peaks = speed[: len(speed) // 200 * 200].reshape(-1, 200).max(axis=1)
    last = peaks[-1]
    grown = int(np.argmax(peaks > GROWN * last))
    away = np.flatnonzero(np.abs(peaks - last) > SETTLED * last)
    interval = 200 * float(run.attrs["sample_interval"])
    return (grown + 1) * interval, (int(away[-1]) + 2) * interval


def _branches() -> list[float]:
    """Return the time of a branch over its bar."""
    taken = []
    for _ in range(WARM_UP + REPEATS):
        began = time.perf_counter()
        st.follow_cycle(_rubbed, "velocity", 0.9, 2.0, value=1.0, step=0.02, points=POINTS)
        taken.append((time.perf_counter() - began) / BRANCH)
    return taken[WARM_UP:]


def _rubbed(velocity: float) -> st.System:
    block = st.PointMass(1.0)
    law = st.ExponentialWeakening(static=1.0, kinetic=0.5, velocity=0.5)
    contact = st.PointContact(block.centre, st.RigidTrack(velocity=velocity), friction=law)
    held = [st.Spring(block.centre, stiffness=1.0), st.Dashpot(block.centre, coefficient=0.1)]
    return st.System(contact, [st.Force(block.centre, y=-1.0)], held)


if __name__ == "__main__":
    show(TITLE, rows())
