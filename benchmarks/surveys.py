"""A squeal survey over two parameters of a brake, with a run for each mode that grows."""

from __future__ import annotations

import time
from collections.abc import Iterator

import numpy as np

import stridula as st
from ratios import Ratio, show, sized

POINTS, WORKERS, DURATION = sized((10, 2, 0.04), (1, 1, 2e-4))
TITLE = f"survey of {POINTS} x {POINTS} points: a brake over friction and turning, runs of {DURATION:g} s"
# The shipped brake with 16 points on each pad; a mode starts at a twentieth of its linear range.
PADS = {f"bodies.{side} pad.mesh.divisions": [2, 2, 1] for side in ("upper", "lower")}
AMPLITUDE = 0.05


def rows() -> Iterator[Ratio]:
    """Yield the time of the survey, measured once: it is long compared with disturbances."""
    frictions, speeds = np.linspace(0.35, 0.55, POINTS), np.linspace(10.0, 30.0, POINTS)
    grid = st.Grid({"friction": frictions, "bodies.disc.turning": speeds})
    began = time.perf_counter()
    found = st.squeal_survey(
        "brake", grid, overrides=PADS, duration=DURATION, amplitude=AMPLITUDE, workers=WORKERS, sample_rate=44100.0
    )
    minutes = (time.perf_counter() - began) / 60.0
    if failed := [message for message in found.message.values.ravel().tolist() if message]:
        raise SystemExit(f"every point of the survey must be computed, got {failed[0]}")
    grown = int(found.unstable_modes.sum())
    yield Ratio(f"{grown} growing modes, each with its run, {WORKERS} workers: time over 1 min", [minutes])


if __name__ == "__main__":
    show(TITLE, rows())
