"""Bodies of any form by the pressure on their surface, patch by patch.

Helmholtz's integral over the surface of a body, n outward, with the normal acceleration a,

    p(x) / 2 = integral of (p dG/dn + rho a G) dS, G = exp(-i k R) / (4 pi R),

is an equation for the pressure p there; outside the body the same integral is the pressure itself, inside it is zero.
At frequencies at which the inside resonates only this last condition determines the pressure: it is required at some
points within, in least squares (Schenck 1968, J. Acoust. Soc. Am. 44, 41-58).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..bodies.body_surfaces import PointSurface, inscribed_radius
from .equivalent_sources import Fit, least_squares
from .flat_patches import patch_integrals

# Points of the surface for one within, and distance of the latter from the surface over the reach of a patch.
POINTS_TO_ONE_WITHIN, FREE = 12, 2.0
# Distance over the reach of a patch up to which it is not taken as a point.
NEAR = 4.0
# Fraction of a turn whose multiples fill it evenly.
GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)


@dataclass(frozen=True)
class _Static:
    """Integrals over patches at places at zero frequency, shape (places, points) each, taken as points.

    Attributes
    ----------
    away : ndarray
        Distances [m]; zero from a patch to itself.
    double, single : ndarray
        Integrals over the patches of -dG/dn and of G, exact for a patch at its own place.
    near : tuple of ndarray, shape (pairs,)
        Numbers of places and of patches near to each other.
    more_double, more_single : ndarray, shape (pairs,)
        Differences of the integrals over these from those over points.
    more_bent : ndarray, shape (pairs,)
        Differences in the part of the integrals of -dG/dn that grows with the square of the wavenumber.
    """

    away: Array
    double: Array
    single: Array
    near: tuple[Array, Array]
    more_double: Array
    more_single: Array
    more_bent: Array

    @property
    def rounded(self) -> _Static:
        """The same in single precision, enough for these well-conditioned matrices."""
        pairs = (self.more_double, self.more_single, self.more_bent)
        away, double, single, *more = (one.astype(np.float32) for one in (self.away, self.double, self.single, *pairs))
        return _Static(away, double, single, self.near, *more)


@dataclass(frozen=True, eq=False)
class SurfacePressures:
    """A body as the pressures on the patches of its surface.

    Attributes
    ----------
    surface : PointSurface
        The surface.
    """

    error_in: ClassVar[str] = "its normal motion"
    surface: PointSurface

    @property
    def size(self) -> float:
        """Largest extent of the body [m]."""
        return float(np.linalg.norm(np.ptp(self.surface.points, axis=0)))

    @cached_property
    def within(self) -> Array:
        """Points within the body, away from its surface [m], shape (points, 3).

        They lie in inscribed balls, at all depths up to their centres: a sphere has only one centre, where many of the
        resonant fields of the inside are zero.
        """
        points, normals = self.surface.points, self.surface.normals
        ball, least = inscribed_radius(points, normals, points), FREE * self._reach
        wide = np.flatnonzero(np.isfinite(ball) & (ball > least))
        chosen = wide[:: max(1, POINTS_TO_ONE_WITHIN * wide.size // len(points))]
        share = GOLDEN * np.arange(1, chosen.size + 1) % 1.0
        depth = least[chosen] + share * (ball - least)[chosen]
        return np.asarray(points[chosen] - depth[:, None] * normals[chosen])

    @cached_property
    def _reach(self) -> Array:
        """Largest distances of the corners of patches from their points [m]."""
        surface = self.surface
        away = surface.corners.reshape(-1, 4, 3) - surface.points[surface.owners, None]
        found = np.zeros(len(surface.points))
        np.maximum.at(found, surface.owners, np.linalg.norm(away, axis=2).max(axis=1))
        return found

    def fit(self, wavenumber: float) -> Fit:
        """Return the pressures on the surface at a wavenumber of the sound [rad/m].

        Errors are residuals of all equations, on the surface and within, over their right-hand sides.
        """
        shapes = self.surface.shapes.astype(np.float32)
        double, single = _layers(wavenumber, self._on_surface)
        itself = np.diag_indices_from(single)
        single[itself] -= 1j * wavenumber * self.surface.areas / (4.0 * np.pi)
        matrix = -double
        matrix[itself] += 0.5
        aims = single @ shapes
        if len(self.within):
            double, single = _layers(wavenumber, self._inside)
            matrix, aims = np.concatenate([matrix, -double]), np.concatenate([aims, single @ shapes])
        pressures = least_squares(matrix, aims)
        size = np.linalg.norm(aims, axis=0)
        errors = np.linalg.norm(matrix @ pressures - aims, axis=0) / np.where(size > 0.0, size, 1.0)
        return Fit((pressures,), errors.astype(float))

    def heard(self, fit: Fit, wavenumber: float, places: Array) -> Array:
        """Return the pressures at places (listeners, 3) [m] for unit modal accelerations, shape (listeners, modes)."""
        double, single = _layers(wavenumber, self._apart(places))
        return np.asarray(double @ fit.strengths[0] + single @ self.surface.shapes)

    @cached_property
    def _on_surface(self) -> _Static:
        """Integrals at the patches' own points: their solid angles add up to half of all directions."""
        static = self._apart(self.surface.points)
        place, patch = static.near
        static.more_double[place == patch] = 0.0
        static.double[np.diag_indices_from(static.double)] = (
            0.5 - static.double.sum(axis=1) - np.bincount(place, static.more_double, len(static.double))
        )
        return static.rounded

    @cached_property
    def _inside(self) -> _Static:
        """Integrals at the points within."""
        return self._apart(self.within).rounded

    def _apart(self, places: Array) -> _Static:
        """Return the integrals over patches at places: near ones in closed form, others as points."""
        surface = self.surface
        square, toward = np.zeros((2, len(places), len(surface.areas)))
        for axis in range(3):
            apart = surface.points[:, axis] - places[:, axis, None]
            square += apart**2
            toward += apart * surface.normals[:, axis]
        away = np.sqrt(square)
        square[square == 0.0] = np.inf
        single = surface.areas / (4.0 * np.pi) / np.sqrt(square)
        double = single * toward / square
        place, patch = np.nonzero(away < NEAR * self._reach)
        near = place, patch
        of_double, of_single = self._pieces(places, *near)
        ahead = ((surface.points[patch] - places[place]) * surface.normals[patch]).sum(axis=1)
        # Of (1 + i k R) exp(-i k R) / R³ over a patch across a thin body, also 1 / R has no value at its middle.
        more_bent = 0.5 * (ahead * of_single - double[near] * away[near] ** 2)
        return _Static(away, double, single, near, of_double - double[near], of_single - single[near], more_bent)

    def _pieces(self, places: Array, place: Array, patch: Array) -> tuple[Array, Array]:
        """Return the integrals over patches at places in closed form, of -dG/dn and of G, shape (pairs,) each."""
        owners = self.surface.owners
        order, many = np.argsort(owners, kind="stable"), np.bincount(owners, minlength=len(self.surface.points))
        # The pieces of the patch of each pair, one after the other.
        count = many[patch]
        pair = np.repeat(np.arange(patch.size), count)
        first = np.cumsum(many) - many
        number = np.arange(pair.size) - np.repeat(np.cumsum(count) - count, count)
        piece = order[first[patch[pair]] + number]
        inverse, angle = patch_integrals(places[place[pair]], self.surface.corners[piece].reshape(-1, 4, 3))
        double, single = (np.bincount(pair, one, patch.size) / (4.0 * np.pi) for one in (angle, inverse))
        return double, single


def _layers(wavenumber: float, static: _Static) -> tuple[Array, Array]:
    """Return the matrices of unit pressures and unit accelerations of the patches, shape (places, points) each.

    In the precision of the distances.
    """
    phase = static.away.dtype.type(wavenumber) * static.away
    cosine, sine = np.cos(phase), np.sin(phase)
    single = np.empty(phase.shape, dtype=np.result_type(phase.dtype, np.complex64))
    double = np.empty_like(single)
    single.real, single.imag = static.single * cosine, -static.single * sine
    # -(1 + i k R) exp(-i k R)
    double.real, double.imag = -static.double * (cosine + phase * sine), static.double * (sine - phase * cosine)
    double[static.near] -= static.more_double + float(wavenumber) ** 2 * static.more_bent
    single[static.near] += static.more_single
    return double, single
