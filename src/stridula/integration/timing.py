"""Step and sampling of a run."""

from __future__ import annotations

from dataclasses import dataclass


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
