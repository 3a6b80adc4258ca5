"""What every linear body ends as: mass-normalised modes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..checks import within

Array = NDArray[Any]


@dataclass(frozen=True)
class Modes:
    """Mass-normalised modes of a body in the plane: ``q'' + 2 zeta w q' + w² q = Phi^T f``.

    Attributes
    ----------
    angular_frequency : ndarray, shape (modes,)
        Undamped angular frequencies w [rad/s], rising; exactly zero for rigid modes.
    damping : ndarray, shape (modes,)
        Damping ratios zeta [1].
    translation : ndarray, shape (2, modes)
        ``Phi^T M 1``: how a uniform acceleration along world x and y drives each mode [kg^(1/2)].
    """

    angular_frequency: Array
    damping: Array
    translation: Array

    @property
    def count(self) -> int:
        """Number of modes."""
        return int(self.angular_frequency.size)

    @property
    def frequency(self) -> Array:
        """Natural frequencies [Hz], shape (modes,)."""
        return self.angular_frequency / (2.0 * np.pi)


@dataclass(frozen=True)
class BodyPoint:
    """A point of a body.

    Attributes
    ----------
    body : FiniteElementBeam or ModalBeam
        The body.
    position : float
        Distance along the body's axis from its first end [m]: from the tip of a slider, from the left end of a track.

    Raises
    ------
    ValueError
        If the position is not on the body.
    """

    body: object
    position: float

    def __post_init__(self) -> None:
        length = getattr(self.body, "length", None)
        if length is None:
            raise ValueError(f"body must be a FiniteElementBeam or ModalBeam, got {self.body!r}")
        within("position", self.position, 0.0, length)
