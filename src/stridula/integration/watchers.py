"""What happens between chunks of a march: progress."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """How far a march has come.

    Attributes
    ----------
    time : float
        Simulated time done in this run [s].
    duration : float
        Simulated time asked for [s].
    wall_time : float
        Time it took so far [s].
    """

    time: float
    duration: float
    wall_time: float


Watcher = Callable[[Progress], None]
