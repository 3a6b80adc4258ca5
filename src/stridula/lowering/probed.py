"""A probe as rows on modal motion, and as shares of signals, contact forces and nonlinear pulls."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ..arrays import Array


@dataclass(frozen=True)
class ProbeRows:
    """Coefficients of one probe: rows on modal motion, and shares of the signals and of the contact forces.

    Attributes
    ----------
    rows : ndarray, shape (3, modes)
        Rows on q, q' and q''.
    loads : ndarray, shape (loads,)
        Shares of the factors of the loads.
    imposed : ndarray, shape (3,)
        Shares of the imposed displacement, velocity and acceleration.
    contact : ndarray, shape (rows,)
        Shares of the normal and the tangential forces of all contacts.
    springs : dict
        Shares of the pulls of nonlinear springs and dashpots beyond their linear parts, by their number.
    is_of_body : bool
        Whether it is from a probe of all modes of a body.
    """

    rows: Array
    loads: Array
    imposed: Array
    contact: Array
    springs: Mapping[int, float] = field(default_factory=dict)
    is_of_body: bool = False

    @property
    def form(self) -> tuple[bytes, tuple[int, ...]]:
        """A key that is equal for probes with the same rows in a march."""
        return self.rows.any(axis=1).tobytes(), tuple(self.springs)

    @property
    def direct(self) -> Array:
        """Shares of all signals, in the order of `Signals`."""
        return np.concatenate([self.loads, self.imposed])
