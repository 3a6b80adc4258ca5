"""The motion of the modes of a body, from whichever source: recorded, or driven again by forces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ..arrays import Array

CONTINUES = "the record continues another one; vibration left from the earlier record is not included"


@dataclass(frozen=True)
class Motion:
    """Motion of the modes of a body.

    Attributes
    ----------
    start, interval : float
        Time at which the record begins, and its sample interval [s].
    samples : int
        Number of its samples.
    first : float
        Time of the first acceleration [s].
    begins : float or None
        Time at which the body first moves [s from the start], None if it does not.
    carried : ndarray of int, shape (modes,)
        Numbers of the modes whose motion the samples can represent.
    accelerations : callable
        Takes numbers of such modes, returns their accelerations, shape (modes, samples or more) [m kg^(1/2) / s²].
    words : str
        Origin of the motion, for attributes.
    still : str
        Cause of silence if it does not move, for notes.
    notes : sequence of str
        Notes on missing parts.
    """

    start: float
    interval: float
    samples: int
    first: float
    begins: float | None
    carried: Array
    accelerations: Callable[[Array], Array]
    words: str = "driven again"
    still: str = "nothing pushes"
    notes: Sequence[str] = ()

    @property
    def shift(self) -> float:
        """Number of samples from the start of the record to the first acceleration."""
        return (self.first - self.start) / self.interval
