"""Progress of a march, reported between its chunks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """Progress of a march.

    Attributes
    ----------
    time : float
        Simulated time so far in this run [s].
    duration : float
        Total time to simulate [s].
    wall_time : float
        Elapsed time [s].
    """

    time: float
    duration: float
    wall_time: float


Watcher = Callable[[Progress], None]
