"""The directions in which a connection acts, and those in which it lets nothing move."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..arrays import Array
from .branches import Branch
from .ends import unit


class Motion(NamedTuple):
    """A motion of the first end of a connection relative to the other.

    Attributes
    ----------
    way : ndarray, shape (3,)
        World direction along which it is a displacement, or about which it is a rotation.
    turns : bool
        Whether it is a rotation.
    """

    way: Array
    turns: bool = False


class Element(NamedTuple):
    """A linear part of a connection.

    Attributes
    ----------
    motion : Motion
        Motion against which it acts.
    stiffness, damping : float
        Force or moment per unit of the motion [N/m, N m] and of its rate [N s/m, N m s], before the branches relax.
    branches : tuple of Branch
        Parts of the stiffness that relax.
    """

    motion: Motion
    stiffness: float
    damping: float
    branches: tuple[Branch, ...] = ()


# Displacements along and rotations about the world's axes.
DISPLACEMENTS = tuple(Motion(way) for way in np.eye(3))
ROTATIONS = tuple(Motion(way, True) for way in np.eye(3))


def elements_of(connection: Any) -> tuple[Element, ...]:
    """Return the linear parts of a connection."""
    own: tuple[Element, ...] | None = getattr(connection, "elements", None)
    return (Element(Motion(unit(connection)), *connection.rates),) if own is None else own


def held_motions(connection: Any) -> tuple[Motion, ...]:
    """Return the motions that a connection prevents."""
    return getattr(connection, "held", ())
