"""Bodies of any form as point sources: one under each patch of the surface."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..bodies.body_surfaces import PointSurface, inscribed_radius
from .equivalent_sources import DEPTH_OF_BALL, DEPTH_OF_SPACING, Fit, fitted

# Points of the surface to a source, and most sources.
POINTS_TO_SOURCE, MOST = 2.5, 1200


@dataclass(frozen=True, eq=False)
class PointSources:
    """A body as point sources.

    Attributes
    ----------
    surface : PointSurface
        The surface.
    """

    surface: PointSurface

    @property
    def size(self) -> float:
        """Largest extent of the body [m]."""
        return float(np.linalg.norm(np.ptp(self.surface.points, axis=0)))

    @cached_property
    def ball(self) -> Array:
        """Radii of the largest balls within the body that touch it at the points [m], shape (points,)."""
        return inscribed_radius(self.surface.points, self.surface.normals, self.surface.points)

    @cached_property
    def sources(self) -> Array:
        """Where the sources are [m], shape (sources, 3): under points as far from each other as sources may be."""
        surface = self.surface
        reach = np.sqrt(POINTS_TO_SOURCE * surface.areas)
        few = np.sqrt(len(surface.areas) / POINTS_TO_SOURCE / MOST)
        chosen = _apart(surface.points, reach * max(1.0, few))
        depth = np.minimum(DEPTH_OF_SPACING * reach, DEPTH_OF_BALL * self.ball)
        return np.asarray((surface.points - depth[:, None] * surface.normals)[chosen])

    def fit(self, wavenumber: float) -> Fit:
        """Return the strengths of the sources at a wavenumber of the sound [rad/m]."""
        apart = self.surface.points[:, None] - self.sources[None]
        away = np.linalg.norm(apart, axis=2)
        along = np.einsum("psx,px->ps", apart, self.surface.normals) / away
        slopes = -(1.0 + 1j * wavenumber * away) * np.exp(-1j * wavenumber * away) * along / (4.0 * np.pi * away**2)
        areas = self.surface.areas
        strengths, errors = fitted(slopes, -self.surface.shapes, areas, np.sqrt(areas))
        return Fit((strengths,), errors)

    def heard(self, fit: Fit, wavenumber: float, places: Array) -> Array:
        """Return the pressures at places (listeners, 3) [m] for unit modal accelerations, shape (listeners, modes)."""
        away = np.linalg.norm(places[:, None] - self.sources[None], axis=2)
        return np.asarray(np.exp(-1j * wavenumber * away) / (4.0 * np.pi * away) @ fit.strengths[0])


def _apart(points: Array, reach: Array) -> Array:
    """Return the numbers of points of which none lies within the reach of another one."""
    order, left, found = np.argsort(reach, kind="stable"), np.ones(len(points), dtype=bool), []
    for number in order:
        if left[number]:
            found.append(number)
            left &= ((points - points[number]) ** 2).sum(axis=1) >= reach[number] ** 2
    return np.array(found)
