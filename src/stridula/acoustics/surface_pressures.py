"""Bodies of any form by the pressure on their surface, patch by patch.

Helmholtz's integral over the surface of a body, n outward, with the normal acceleration a,

    p(x) / 2 = integral of (p dG/dn + rho a G) dS, G = exp(-i k R) / (4 pi R),

is an equation for the pressure p there; beyond the body the same integral is the pressure itself, within it is zero. At
frequencies at which the inside resonates only this last statement tells the pressure: it is asked for at some points
within, in least squares (Schenck 1968, J. Acoust. Soc. Am. 44, 41-58). Unlike sources that lie within, a pressure is
finite at edges, so that patches need not get smaller towards them.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..bodies.body_surfaces import PointSurface, inscribed_radius
from .equivalent_sources import Fit, least_squares

# Points of the surface for one within, and the ball around these, over the side of a patch, that is free of surface.
POINTS_TO_ONE_WITHIN, FREE = 12, 1.5


@dataclass(frozen=True, eq=False)
class SurfacePressures:
    """A body as the pressures on the patches of its surface.

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
    def within(self) -> Array:
        """Points within the body, away from its surface [m], shape (points, 3): middles of balls that fit into it."""
        points, normals = self.surface.points, self.surface.normals
        ball = inscribed_radius(points, normals, points)
        wide = np.flatnonzero(np.isfinite(ball) & (ball > FREE * np.sqrt(self.surface.areas)))
        chosen = wide[:: max(1, POINTS_TO_ONE_WITHIN * wide.size // len(points))]
        return np.asarray(points[chosen] - ball[chosen, None] * normals[chosen])

    @cached_property
    def still(self) -> Array:
        """What each patch adds at its own place: all together see half of all directions, shape (points,)."""
        away, slopes = self._on_surface
        seen = (self.surface.areas / (4.0 * np.pi) * slopes / away).sum(axis=1, dtype=float)
        return np.asarray(-0.5 + seen)

    def fit(self, wavenumber: float) -> Fit:
        """Return the pressures on the surface at a wavenumber of the sound [rad/m].

        Errors are those of the equations together, on the surface and within, over what the motion gives there.
        """
        areas, shapes = self.surface.areas, self.surface.shapes.astype(np.float32)
        double, single = self._layers(wavenumber, *self._on_surface)
        # A patch at its own middle, as a disc.
        own = 0.5 * np.sqrt(areas / np.pi) - 1j * wavenumber * areas / (4.0 * np.pi)
        single[np.diag_indices_from(single)] = own
        matrix = -double
        matrix[np.diag_indices_from(matrix)] = 0.5 - self.still
        aims = single @ shapes
        if len(self.within):
            double, single = self._layers(wavenumber, *self._inside)
            matrix, aims = np.concatenate([matrix, -double]), np.concatenate([aims, single @ shapes])
        pressures = least_squares(matrix, aims)
        size = np.linalg.norm(aims, axis=0)
        errors = np.linalg.norm(matrix @ pressures - aims, axis=0) / np.where(size > 0.0, size, 1.0)
        return Fit((pressures,), errors.astype(float))

    def heard(self, fit: Fit, wavenumber: float, places: Array) -> Array:
        """Return the pressures at places (listeners, 3) [m] for unit modal accelerations, shape (listeners, modes)."""
        double, single = self._layers(wavenumber, *self._apart(places))
        return np.asarray(double @ fit.strengths[0] + single @ self.surface.shapes)

    @cached_property
    def _on_surface(self) -> tuple[Array, Array]:
        """What `_apart` tells of the patches themselves, without the share of each at its own place."""
        away, slopes = self._apart(self.surface.points)
        slopes[np.diag_indices_from(slopes)] = 0.0
        # Patches are better conditioned than single precision by far, and right to percents.
        return away.astype(np.float32), slopes.astype(np.float32)

    @cached_property
    def _inside(self) -> tuple[Array, Array]:
        """What `_apart` tells of the points within."""
        away, slopes = self._apart(self.within)
        return away.astype(np.float32), slopes.astype(np.float32)

    def _apart(self, places: Array) -> tuple[Array, Array]:
        """Return distances of the patches from places, and their slopes along the normals over themselves.

        Shape (places, points) each; no distance is zero.
        """
        square, toward = np.zeros((2, len(places), len(self.surface.areas)))
        for axis in range(3):
            apart = self.surface.points[:, axis] - places[:, axis, None]
            square += apart**2
            toward += apart * self.surface.normals[:, axis]
        square[square == 0.0] = 1.0
        return np.sqrt(square), toward / square

    def _layers(self, wavenumber: float, away: Array, slopes: Array) -> tuple[Array, Array]:
        """Return what unit pressures and unit accelerations of the patches give at places, shape (places, points) each.

        In the precision of the distances.
        """
        phase = away.dtype.type(wavenumber) * away
        size = (self.surface.areas / (4.0 * np.pi)).astype(away.dtype) / away
        cosine, sine = size * np.cos(phase), size * np.sin(phase)
        single = np.empty(away.shape, dtype=np.result_type(away.dtype, np.complex64))
        double = np.empty_like(single)
        single.real, single.imag = cosine, -sine
        # -(1 + i k R) exp(-i k R)
        double.real, double.imag = -slopes * (cosine + phase * sine), slopes * (sine - phase * cosine)
        return double, single
