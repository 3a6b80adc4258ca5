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
import scipy.linalg

from ..arrays import Array
from ..bodies.body_surfaces import PointSurface, inscribed_radius
from .equivalent_sources import Fit

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
        return np.asarray(-0.5 - self._layers(0.0, self.surface.points, True)[0].real.sum(axis=1))

    def fit(self, wavenumber: float) -> Fit:
        """Return the pressures on the surface at a wavenumber of the sound [rad/m].

        Errors are those of the equations together, on the surface and within, over what the motion gives there.
        """
        areas = self.surface.areas
        double, single = self._layers(wavenumber, self.surface.points, True)
        # A patch at its own middle, as a disc.
        own = 0.5 * np.sqrt(areas / np.pi) - 1j * wavenumber * areas / (4.0 * np.pi)
        single[np.diag_indices_from(single)] = own
        matrix = -double
        matrix[np.diag_indices_from(matrix)] = 0.5 - self.still
        aims = single @ self.surface.shapes
        if len(self.within):
            inside = self._layers(wavenumber, self.within, False)
            matrix = np.concatenate([matrix, -inside[0]])
            aims = np.concatenate([aims, inside[1] @ self.surface.shapes])
        square = matrix.conj().T @ matrix
        pressures = scipy.linalg.cho_solve(scipy.linalg.cho_factor(square), matrix.conj().T @ aims)
        size = np.linalg.norm(aims, axis=0)
        errors = np.linalg.norm(matrix @ pressures - aims, axis=0) / np.where(size > 0.0, size, 1.0)
        return Fit((pressures,), errors)

    def heard(self, fit: Fit, wavenumber: float, places: Array) -> Array:
        """Return the pressures at places (listeners, 3) [m] for unit modal accelerations, shape (listeners, modes)."""
        double, single = self._layers(wavenumber, places, False)
        return np.asarray(double @ fit.strengths[0] + single @ self.surface.shapes)

    def _layers(self, wavenumber: float, places: Array, own: bool) -> tuple[Array, Array]:
        """Return what unit pressures and unit accelerations of the patches give at places, shape (places, points) each.

        With `own` the places are those of the patches, and each gives nothing at its own.
        """
        surface = self.surface
        square, toward = np.zeros((2, len(places), len(surface.areas)))
        for axis in range(3):
            apart = surface.points[:, axis] - places[:, axis, None]
            square += apart**2
            toward += apart * surface.normals[:, axis]
        if own:
            square[np.diag_indices_from(square)] = 1.0
        away = np.sqrt(square)
        phase = wavenumber * away
        single = (np.cos(phase) - 1j * np.sin(phase)) * (surface.areas / (4.0 * np.pi * away))
        if own:
            single[np.diag_indices_from(single)] = 0.0
        return -(1.0 + 1j * phase) * single * toward / square, single
