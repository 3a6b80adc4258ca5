"""Step and sampling of a run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..checks import ArgumentError, at_least, at_most, positive
from ..lowering import Assembly
from ..lowering.schemes import Scheme
from ..lowering.stepping import Stepping
from .default_step import default_step

LARGEST_RATIO = 1_000_000
SMALLEST_SHARE = 1e-7


@dataclass(frozen=True)
class Timing:
    """Step and sampling of a run.

    Attributes
    ----------
    step : float
        Time step [s].
    ratio : int
        Steps per recorded sample.
    samples : int
        Number of samples to record.
    motion_every : int, optional
        Samples in an interval at whose end the motion of bodies is recorded.
    """

    step: float
    ratio: int
    samples: int
    motion_every: int = 1

    @property
    def interval(self) -> float:
        """Time between samples [s]."""
        return self.step * self.ratio


def choose_timing(arrays: Assembly, scheme: Scheme, duration: float, step: float | None, sample_rate: float) -> Timing:
    """Return the step and the sampling for the arguments of `simulate`."""
    positive("duration", duration)
    wanted = 1.0 / positive("sample_rate", sample_rate)
    if step is None:
        ratio = max(1, int(np.ceil(wanted / default_step(arrays, scheme, duration) - 1e-9)))
        step = wanted / ratio
    else:
        step, limit = positive("step", step), Stepping(arrays, scheme).limit
        if step >= limit:
            raise ArgumentError("step", f"be below the {scheme.name} scheme's limit of {at_most(limit)} s", step)
        if step < SMALLEST_SHARE * limit < np.inf:
            raise ArgumentError("step", f"be at least {at_least(SMALLEST_SHARE * limit, 3)} s for these modes", step)
        ratio = max(1, round(wanted / step))
    if ratio > LARGEST_RATIO:
        raise ArgumentError(
            "sample_rate",
            f"be at least {at_least(1.0 / (LARGEST_RATIO * step), 3)} Hz at a step of {step:.3g} s",
            sample_rate,
        )
    return sampled(step, ratio, duration)


def sampled(step: float, ratio: int, duration: float) -> Timing:
    """Return a step with whole numbers of steps in a sample and of samples in a duration [s]."""
    interval = step * ratio
    if duration < 0.5 * interval:
        raise ArgumentError("duration", f"be at least half a sample interval of {at_least(interval)} s", duration)
    return Timing(step, ratio, max(1, round(duration / interval)))
