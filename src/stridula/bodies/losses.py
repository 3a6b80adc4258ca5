"""Loss factors of materials in the modes of a body: each counts by its share of the strain energy."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..arrays import Array
from .sections import Material


def one_loss(materials: Iterable[Material]) -> float | None:
    """Return the loss factor of all materials [1], None if they differ."""
    factors = {material.loss_factor for material in materials}
    return factors.pop() if len(factors) == 1 else None


def losses_of(stiffness: Any, stiffened: Any, shapes: Array) -> Array:
    """Return the loss factors of modes [1], none for motions without strain.

    The modal strain energy method (Ungar & Kerwin 1962, J. Acoust. Soc. Am. 34).

    Parameters
    ----------
    stiffness, stiffened : sparse, shape (n, n)
        Stiffness, and that of materials stiffened by their loss factors, see `with_losses`.
    shapes : ndarray, shape (n, modes)
        Shapes of the modes.
    """
    own, more = ((shapes * (matrix @ shapes)).sum(axis=0) for matrix in (stiffness, stiffened))
    return np.asarray(np.maximum(more / np.where(own > 0.0, own, 1.0) - 1.0, 0.0) * (own > 0.0))


def with_losses(materials: Sequence[Material]) -> list[Material]:
    """Return materials with Young's moduli larger by their loss factors: a stiffness ``sum (1 + loss) K``."""
    return [replace(one, young=one.young * (1.0 + one.loss_factor)) for one in materials]
