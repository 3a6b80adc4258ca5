"""Surfaces in contact given by their points without a mesh, as in records."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..checks import counted
from .point_contact import PointContact


@dataclass(frozen=True, repr=False)
class SurfacePoints:
    """The contacts of the points of a surface, each with its area and a tip of known place.

    Parameters
    ----------
    name : str
        Name of the surface.
    contacts : tuple of PointContact
        The contacts of its points.
    """

    name: str
    contacts: tuple[PointContact, ...]

    def __repr__(self) -> str:
        return f"SurfacePoints({self.name!r}, {counted(len(self.contacts), 'point')})"

    @property
    def areas(self) -> Array:
        """Areas of the points [m²], shape (points,)."""
        return np.array([one.area for one in self.contacts])

    @property
    def places(self) -> Array:
        """Places of the points [m], shape (points, 3)."""
        return np.array([one.tip.place for one in self.contacts])


def surfaces_among(contacts: Sequence[PointContact]) -> list[SurfacePoints]:
    """Return the surfaces among contacts: those all of whose points have an area and a place."""
    found: dict[str, list[PointContact]] = {}
    for one in contacts:
        if one.surface:
            found.setdefault(one.surface, []).append(one)
    return [
        SurfacePoints(name, tuple(points))
        for name, points in found.items()
        if all(one.is_spatial and one.area > 0.0 and one.tip.place is not None for one in points)
    ]
