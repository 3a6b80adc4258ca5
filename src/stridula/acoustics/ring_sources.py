"""Bodies of revolution as rings of sources: a small fit for each number of waves round the axis.

A ring of radius r' at z' with a strength of ``cos n theta`` has the field ``cos n theta g_n(r, z)``,

    g_n = 1 / (8 pi²) integral of cos(n t) exp(-i k R) / R dt, R² = r² + r'² - 2 r r' cos t + (z - z')².

Close to a ring the integrand of its derivative has a sharp peak. It is split: ``(1 + i k R) exp(-i k R)`` less
``1 + k² R² / 2`` is smooth, and the part subtracted depends on the frequency through ``k²`` alone, so that it is
integrated once, with as many angles as it needs.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..bodies.body_surfaces import RingSurface, inscribed_radius
from .equivalent_sources import Fit, depths, fitted

# Angles round a ring: for the width of the sharp part, for each radian of the waves of sound, and beyond the order.
SHARPEST, SMOOTH, MORE = 12.0, 1.4, 40
# Gauss points in each part of half a turn, beyond the order.
GAUSS = 10
# Numbers held at once, few enough for the cache of a processor.
AT_ONCE = 30_000


@dataclass(frozen=True, eq=False)
class RingSources:
    """A body of revolution as rings of sources, one under each pair of rings of its surface.

    Attributes
    ----------
    surface : RingSurface
        The surface.
    """

    error_in: ClassVar[str] = "its normal motion"
    surface: RingSurface

    @property
    def size(self) -> float:
        """Largest extent of the body [m]."""
        r, z = self.surface.places.T
        return float(np.hypot(2.0 * r.max(), np.ptp(z)))

    @cached_property
    def sources(self) -> Array:
        """Where the rings of sources are, r and z [m], shape (sources, 2)."""
        surface = self.surface
        middle = 0.5 * (surface.places[::2] + surface.places[1::2])
        inward = -(surface.normals[::2] + surface.normals[1::2])
        inward = inward / np.linalg.norm(inward, axis=1)[:, None]
        mirrored = surface.places * np.array([-1.0, 1.0])
        ball = inscribed_radius(middle, -inward, np.concatenate([surface.places, mirrored]))
        spacing = surface.widths[::2] + surface.widths[1::2]
        return np.asarray(middle + depths(spacing, ball)[:, None] * inward)

    @cached_property
    def orders(self) -> Array:
        """Numbers of waves of the modes round the axis."""
        return np.unique(self.surface.orders)

    def fit(self, wavenumber: float) -> Fit:
        """Return the strengths of the sources at a wavenumber of the sound [rad/m], order by order."""
        surface, found, errors = self.surface, [], np.zeros(self.surface.orders.size)
        areas = surface.places[:, 0] * surface.widths
        for slope, order in zip(self._slopes(wavenumber), self.orders, strict=True):
            those = surface.orders == order
            strengths, errors[those] = fitted(slope, -surface.shapes[:, those], areas, surface.widths)
            # Pressures stay accurate to 1e-5 even close to the surface.
            found.append(strengths.astype(np.complex64))
        return Fit(tuple(found), errors)

    def heard(self, fit: Fit, wavenumber: float, places: Array) -> Array:
        """Return the pressures at places (listeners, 3) [m] for unit modal accelerations, shape (listeners, modes)."""
        around = self._around(places)
        found = np.zeros((len(places), self.surface.orders.size), dtype=complex)
        fields = self._fields(wavenumber, around[:, [0, 2]])
        for strengths, field, order in zip(fit.strengths, fields, self.orders, strict=True):
            found[:, self.surface.orders == order] = field @ strengths
        return np.asarray(found * self.surface.round(around[:, 1]))

    def _around(self, places: Array) -> Array:
        """Return r, theta and z of places, shape (places, 3)."""
        x, y, z = self.surface.frame @ (places - self.surface.origin).T
        return np.stack([np.hypot(x, y), np.arctan2(y, x), z], axis=1)

    def _slopes(self, wavenumber: float) -> Array:
        """Return the derivatives of the fields along the normals of the surface, shape (orders, rings, sources)."""
        still, bent = self._sharp
        found = (still + wavenumber**2 * bent).astype(complex)
        reach = wavenumber * float(self.surface.places[:, 0].max())
        angles, weights = _half_turn(int(SMOOTH * reach) + int(self.orders.max()) + MORE)
        cosines = _cosines(self.orders, angles, weights).astype(np.float32)
        for rings in self._few(angles.size):
            # Single precision loses 1e-7 of the smooth part, which is added to the sharp one.
            away, slope = self._distances(rings, angles, np.float32)
            scale = slope / (away * away)
            phase = np.float32(wavenumber) * away
            cosine, sine = np.cos(phase), np.sin(phase)
            rest = (cosine - np.float32(1.0) + phase * (sine - np.float32(0.5) * phase)) * scale
            found.real[:, rings] -= np.moveaxis(rest @ cosines, -1, 0)
            found.imag[:, rings] -= np.moveaxis(((phase * cosine - sine) * scale) @ cosines, -1, 0)
        return found

    @cached_property
    def _sharp(self) -> tuple[Array, Array]:
        """Parts of the derivatives that are constant and that grow with the square of the wavenumber."""
        shape = (len(self.orders), len(self.surface.places), len(self.sources))
        still, bent = np.empty(shape), np.empty(shape)
        apart = np.linalg.norm(self.surface.places[:, None] - self.sources[None], axis=2)
        nearest = float((apart / self.surface.places[:, 0, None]).min())
        angles, weights = _towards_zero(nearest, int(self.orders.max()))
        cosines = _cosines(self.orders, angles, weights)
        for rings in self._few(angles.size):
            away, slope = self._distances(rings, angles)
            still[:, rings] = -np.moveaxis((slope / away**2) @ cosines, -1, 0)
            bent[:, rings] = -0.5 * np.moveaxis(slope @ cosines, -1, 0)
        return still, bent

    def _few(self, angles: int) -> Iterator[slice]:
        """Yield the rings of the surface, a few at a time."""
        few = max(1, AT_ONCE // (len(self.sources) * angles))
        for first in range(0, len(self.surface.places), few):
            yield slice(first, first + few)

    def _distances(self, rings: slice, angles: Array, precision: type[np.floating] = np.float64) -> tuple[Array, Array]:
        """Return the distances between some rings of the surface and the sources, and their slopes along the normals.

        Shape (rings, sources, angles) each.
        """
        (r, z), (across, along) = self.surface.places[rings].T[..., None], self.surface.normals[rings].T[..., None]
        radius, up = self.sources[:, 0], z - self.sources[:, 1]
        square, around = (r - radius) ** 2 + up**2, 2.0 * r * radius
        level, turned = across * (r - radius) + along * up, across * radius
        # No differences of nearly equal numbers remain.
        square, around, level, turned = (part[..., None].astype(precision) for part in (square, around, level, turned))
        off = (2.0 * np.sin(0.5 * angles) ** 2).astype(precision)
        away = np.sqrt(square + around * off)
        return away, (level + turned * off) / away

    def _fields(self, wavenumber: float, places: Array) -> Array:
        """Return the fields of the sources at places r, z, shape (orders, places, sources)."""
        found = np.zeros((len(self.orders), len(places), len(self.sources)), dtype=complex)
        r, z = self.sources[:, 0, None], self.sources[:, 1, None]
        count = int(SMOOTH * wavenumber * float(r.max())) + int(self.orders.max()) + MORE
        for number, (radius, height) in enumerate(places):
            nearest = float((np.hypot(radius - r, height - z) / np.maximum(radius, r)).min())
            several = count + int(SHARPEST / min(nearest, 1.0))
            angles, weights = _half_turn(several)
            along = radius - r * np.cos(angles)
            away = np.sqrt(along**2 + (height - z) ** 2 + (r * np.sin(angles)) ** 2)
            found[:, number] = ((np.exp(-1j * wavenumber * away) / away) @ _cosines(self.orders, angles, weights)).T
        return found


def _half_turn(count: int) -> tuple[Array, Array]:
    """Return even angles from 0 to pi, and their weights in a mean over the turn."""
    angles = np.linspace(0.0, np.pi, count // 2 + 1)
    weights = np.full(angles.size, 1.0 / (angles.size - 1))
    weights[[0, -1]] *= 0.5
    return angles, weights


def _towards_zero(nearest: float, order: int) -> tuple[Array, Array]:
    """Return angles from 0 to pi, closer together towards 0, and their weights in a mean over the turn.

    Gauss points in parts each as long as all before it together, the first as long as the smallest distance.
    """
    halvings = max(1, int(np.ceil(np.log2(np.pi / min(nearest, 1.0)))))
    ends = np.append(0.0, np.pi * 0.5 ** np.arange(halvings, -1.0, -1.0))
    nodes, rates = np.polynomial.legendre.leggauss(GAUSS + order)
    angles = ends[:-1, None] + 0.5 * (nodes + 1.0) * np.diff(ends)[:, None]
    return angles.ravel(), (0.5 / np.pi * rates * np.diff(ends)[:, None]).ravel()


def _cosines(orders: Array, angles: Array, weights: Array) -> Array:
    """Return the matrix from values at angles, with weights in a mean, to harmonics over ``4 pi``: (angles, orders)."""
    return np.asarray(weights[:, None] * np.cos(np.outer(angles, orders)) / (4.0 * np.pi))
