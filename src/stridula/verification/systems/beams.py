"""Beams of steel on supports of every kind: frequencies in closed form.

A beam in bending obeys ``EI w'''' = rho S w_tt``. With ``w = A cos + B sin + C cosh + D sinh`` of ``b s`` and
``x = b L``, its frequency is ``(x/L)² sqrt(EI / rho S) / 2 pi``, where x follows from the supports:

- pinned-pinned (w = w'' = 0 at both ends): sin x = 0, so x = n pi;
- guided-free (w' = w''' = 0; w'' = w''' = 0): from the guided end w = A cos + C cosh; at the free one
  -A cos x + C cosh x = 0 and A sin x + C sinh x = 0, so tan x + tanh x = 0, and a translation at no frequency;
- guided-pinned: A cos x + C cosh x = 0 and -A cos x + C cosh x = 0, so cos x = 0, x = (j - 1/2) pi;
- pinned-free: w = B sin + D sinh; -B sin x + D sinh x = 0 and -B cos x + D cosh x = 0, so tan x = tanh x, and a
  rotation at no frequency;
- clamped-free: cos x cosh x = -1; free-free and clamped-clamped: cos x cosh x = 1.

A rod obeys ``E u'' = rho u_tt``: n c / 2L with both ends held or both free, (n - 1/2) c / 2L with one held. A guided
end is free in both translations, a pinned one held in both.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi, sqrt
from typing import Any

import numpy as np
from scipy.optimize import brentq

from ...arrays import Array
from ...bodies import FiniteElementBeam, Material, Rectangle

STEEL, SQUARE = Material(2.1e11, 7800.0), Rectangle(0.010, 0.010)
# Frequencies of each kind.
COUNT = 4
N = np.arange(1, COUNT + 1)


@dataclass(frozen=True)
class Supports:
    """Supports of a beam, and its frequencies on them.

    Attributes
    ----------
    root, tip : str
        Supports of the ends.
    roots, multiples : ndarray, shape (COUNT,)
        Roots x of the characteristic function of bending, multiples of c / 2L in stretching.
    rigid : int
        Number of rigid motions.
    """

    root: str
    tip: str
    roots: Array
    multiples: Array
    rigid: int


def roots(function: Callable[[float], float], starts: Array) -> Array:
    """Return the root of a characteristic function around each start."""
    return np.array([brentq(function, start - 0.5, start + 0.5, xtol=1e-14, rtol=1e-14) for start in starts])


def _guided_free(x: float) -> float:
    return float(np.sin(x) * np.cosh(x) + np.cos(x) * np.sinh(x))


def _pinned_free(x: float) -> float:
    return float(np.sin(x) * np.cosh(x) - np.cos(x) * np.sinh(x))


def _clamped_free(x: float) -> float:
    return float(np.cos(x) + 1.0 / np.cosh(x))


def _free_free(x: float) -> float:
    return float(np.cos(x) - 1.0 / np.cosh(x))


SUPPORTS = {
    "simply supported": Supports("pinned", "pinned", N * pi, N, 0),
    "guided-free": Supports("guided", "free", roots(_guided_free, (N - 0.25) * pi), N, 2),
    "guided-pinned": Supports("guided", "pinned", (N - 0.5) * pi, N - 0.5, 0),
    "pinned-free": Supports("pinned", "free", roots(_pinned_free, (N + 0.25) * pi), N - 0.5, 1),
    "clamped-free": Supports("clamped", "free", roots(_clamped_free, (N - 0.5) * pi), N - 0.5, 0),
    "clamped-clamped": Supports("clamped", "clamped", roots(_free_free, (N + 0.5) * pi), N, 0),
    "free-free": Supports("free", "free", roots(_free_free, (N + 0.5) * pi), N, 3),
    "guided-guided": Supports("guided", "guided", N * pi, N, 2),
}


def beam_of(supports: str, elements: int = 16, length: float = 0.3, **words: Any) -> FiniteElementBeam:
    """Return a beam of a length [m] on supports of a name, in finite elements."""
    held = SUPPORTS[supports]
    ends: dict[str, Any] = {"root_support": held.root, "tip_support": held.tip}
    return FiniteElementBeam(STEEL, SQUARE, length, elements=elements, **ends, **words)


def bending(roots: Array, length: float) -> Array:
    """Return ``(x / L)² sqrt(EI / rho S) / 2 pi`` [Hz] for the roots x of a beam's characteristic function."""
    return (roots / length) ** 2 * sqrt(STEEL.young * SQUARE.second_moment / (STEEL.density * SQUARE.area)) / (2.0 * pi)


def stretching(multiples: Array, length: float) -> Array:
    """Return ``n c / 2 L`` [Hz] of a rod."""
    return multiples * sqrt(STEEL.young / STEEL.density) / (2.0 * length)


def families(body: FiniteElementBeam) -> tuple[Array, Array]:
    """Return the frequencies above zero of bending and of stretching [Hz], distinguished by their motion.

    Raises
    ------
    RuntimeError
        If a mode both bends and stretches: nothing couples the two.
    """
    along, across = body.axes
    moved = np.array([body.trace(place) for place in np.linspace(0.0, body.length, 23)])
    bent, stretched = (np.sum(np.tensordot(moved, way, axes=(1, 0)) ** 2, axis=0) for way in (across, along))
    frequency = body.modes().frequency
    elastic = frequency > 0.0
    if not np.all((np.minimum(bent, stretched) / np.maximum(bent, stretched))[elastic] < 1e-6):
        raise RuntimeError("a mode must bend or stretch, not both")
    return frequency[elastic & (bent > stretched)], frequency[elastic & (stretched > bent)]
