"""Modes as a file of results has them: undamped, real, at nodes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ..reading.deck_error import DeckError

# Share of the highest frequency, and frequency [Hz], below which a negative eigenvalue is that of a rigid motion.
RIGID, SLOWEST = 1e-3, 1e-6


class Units(NamedTuple):
    """Length and force of a file per metre and per newton."""

    length: float
    force: float


@dataclass(frozen=True)
class ComputedModes:
    """Modes of a model.

    Attributes
    ----------
    nodes : ndarray of int, shape (nodes,)
        Numbers of the nodes, in rising order.
    places : ndarray, shape (nodes, 3)
        World places of the nodes in the unit of the file.
    frequency : ndarray, shape (modes,)
        Frequencies [Hz].
    shapes : ndarray, shape (nodes, 3, modes)
        Displacements in world directions.
    masses : ndarray, shape (modes,), or None
        Modal masses in the unit of the file, if it has them.
    where : tuple of str
        Place of each mode in the file, such as "line 12".
    units : Units or None
        Units that the file states.
    doubts : tuple of str
        Parts of the file that are left out, in words.
    """

    nodes: Array
    places: Array
    frequency: Array
    shapes: Array
    masses: Array | None
    where: tuple[str, ...]
    units: Units | None = None
    doubts: tuple[str, ...] = ()


def frequencies_of(eigenvalues: Array, where: tuple[str, ...]) -> Array:
    """Return the frequencies [Hz] of eigenvalues [rad^2/s^2], 0 for rigid motions with rounding.

    Raises
    ------
    DeckError
        If a mode grows.
    """
    signed = np.sign(eigenvalues) * np.sqrt(np.abs(eigenvalues)) / (2.0 * np.pi)
    wrong = np.flatnonzero(signed < -max(RIGID * float(np.abs(signed).max(initial=0.0)), SLOWEST))
    if wrong.size:
        words = f"the mode has the negative eigenvalue {eigenvalues[wrong[0]]:.6g} rad^2/s^2: it grows, or its model"
        raise DeckError(0, f"{where[wrong[0]]}: {words} is preloaded beyond buckling")
    return np.maximum(signed, 0.0)
