"""Planar bodies that may be placed in any plane of space."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import Array, in_space
from ..checks import ArgumentError
from .cards import HasCard
from .matrix_input import numbers

# Largest error of unit vectors at right angles due to rounding.
SQUARE = 1e-12


def checked_plane(name: str, given: Any) -> tuple[tuple[float, ...], ...]:
    """Return the directions in space of x and y of a plane, two unit vectors at right angles."""
    axes = numbers(name, given)
    if axes.shape != (2, 3) or not np.allclose(axes @ axes.T, np.eye(2), rtol=0.0, atol=SQUARE):
        raise ArgumentError(name, "be unit vectors at right angles, three numbers each", given)
    return tuple(tuple(axis) for axis in axes.tolist())


class InPlane(HasCard):
    """Base class of tracks in a plane of their own, or in the plane of world x and y."""

    plane: Any

    @property
    def is_spatial(self) -> bool:
        """Whether its plane is given; without one it may also be in systems in space, rigid along world z."""
        return self.plane is not None

    @property
    def axes(self) -> Array:
        """Unit vectors along it and along its normal in the world frame, shape (2, 2) or (2, 3)."""
        return np.eye(2) if self.plane is None else np.array(self.plane)

    @property
    def frame(self) -> Array:
        """World components of the directions along it, across it to the left and along its normal, shape (3, 3)."""
        along, normal = (in_space(axis) for axis in self.axes)
        return np.array([along, np.cross(normal, along), normal])

    def in_the_world(self, rows: Array) -> Array:
        """Return rows along world x, y and, in space, z from those along it and along its normal, shape (2, modes)."""
        return rows if self.plane is None else np.asarray(self.axes.T @ rows)
