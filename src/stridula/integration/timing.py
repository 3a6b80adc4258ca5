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
    """

    step: float
    ratio: int
    samples: int

    @property
    def interval(self) -> float:
        """Time between samples [s]."""
        return self.step * self.ratio
