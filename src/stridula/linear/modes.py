"""Numbered modes of small vibration about an equilibrium."""

from __future__ import annotations

from functools import cache

import numpy as np
from threadpoolctl import ThreadpoolController

from ..arrays import Array
from .massless import massless_exponents
from .structure import Structure
from .vibration import Exponents, Vibration, all_exponents, nearest_exponents

# Largest number of modes for which all exponents are computed; for more modes, only the COUNT lowest.
LARGEST_DENSE = 600
COUNT = 100
# Number of exponents computed in addition to the wanted ones.
SPARE = 8
# Growth, relative to the highest angular frequency, that counts as round-off.
ROUND_OFF = 1e-9


def modes_of(structure: Structure, motion: Vibration, modes: int | None = None, near: float = 0.0) -> Exponents:
    """Return exponents by increasing frequency, with shapes of norm 1 whose largest entry is real.

    Parameters
    ----------
    structure : Structure
        The system.
    motion : Vibration
        Its small motions.
    modes : int, optional
        Number of modes; all if left out, or the lowest 100 of more than 600 modes.
    near : float, optional
        Frequency [Hz] about which a limited number is computed.
    """
    found = _chosen(structure, motion, modes, near)
    order = np.lexsort((-found.values.real, np.round(found.values.imag, 6)))
    return Exponents(found.values[order], _normalised(found.shapes[:, order]))


def exponents_alone(structure: Structure, motion: Vibration) -> Array:
    """Return the exponents [1/s] of the same modes without shapes, in any order."""
    if has_all_exponents(structure):
        return _all(motion, shapes=False).values
    return _nearest(structure, motion, COUNT, 0.0).values


def has_all_exponents(structure: Structure) -> bool:
    """Return whether `exponents_alone` finds all exponents, and not only the lowest ones."""
    return _moving(structure) <= LARGEST_DENSE


def round_off(structure: Structure) -> float:
    """Return the growth that may be due to rounding [1/s]."""
    return ROUND_OFF * float(np.sqrt(_moving_stiffness(structure).max(initial=0.0)))


def _moving(structure: Structure) -> int:
    """Return the number of modes with mass: only these are certain to have exponents."""
    return int(np.count_nonzero(structure.mass))


def _moving_stiffness(structure: Structure) -> Array:
    """Return the stiffness of each mode with mass [1/s²]."""
    return np.maximum(np.diag(structure.stiffness)[structure.mass > 0.0], 0.0)


def _chosen(structure: Structure, motion: Vibration, modes: int | None, near: float) -> Exponents:
    moving = _moving(structure)
    wanted = COUNT if modes is None and moving > LARGEST_DENSE else modes
    if wanted is not None and 4 * wanted < moving and structure.stiffness.any():
        return _nearest(structure, motion, wanted, near)
    found = _all(motion)
    if wanted is None:
        return found
    order = np.argsort(np.abs(found.values - 2.0j * np.pi * near), kind="stable")[:wanted]
    return Exponents(found.values[order], found.shapes[:, order])


def _all(motion: Vibration, shapes: bool = True) -> Exponents:
    # Threads hardly help for matrices of this size, and wait for each other if the processors are busy.
    with _libraries().limit(limits=1):
        return (all_exponents if motion.mass.all() else massless_exponents)(motion, shapes)


@cache
def _libraries() -> ThreadpoolController:
    """Return the libraries of linear algebra, whose search takes longer than the modes of small systems."""
    return ThreadpoolController()


def _nearest(structure: Structure, motion: Vibration, wanted: int, near: float) -> Exponents:
    """Return the exponents nearest to a frequency [Hz], with a shift off the imaginary axis, away from exponents."""
    elastic = np.sqrt(_moving_stiffness(structure))
    lowest = float(elastic[elastic > 0.0].min(initial=np.inf))
    centre = 2.0 * np.pi * near
    # Both exponents of a pair may be found, in an order other than that of the distance from the frequency.
    sought = min(2 * wanted + SPARE, 2 * _moving(structure) - 2)
    found = nearest_exponents(motion, sought, complex(0.1 * lowest, centre))
    order = np.argsort(np.abs(found.values - 1.0j * centre), kind="stable")[:wanted]
    return Exponents(found.values[order], found.shapes[:, order])


def _normalised(shapes: Array) -> Array:
    """Return shapes of norm 1 whose largest entry is real."""
    if not shapes.size:
        return shapes
    largest = np.take_along_axis(shapes, np.abs(shapes).argmax(axis=0)[None], axis=0)
    # A state without influence on forces decays without any motion.
    largest = np.where(largest == 0.0, 1.0, largest)
    turned = shapes * (np.abs(largest) / largest)
    size = np.linalg.norm(turned, axis=0)
    return np.asarray(turned / np.where(size > 0.0, size, 1.0))
