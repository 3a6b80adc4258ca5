"""Thin flat bodies in open air as sheets of dipoles.

The pressures in front of a thin plate and behind it differ by mu(y), and both sides have the same motion. The pressure
is an integral over the plate,

    p(x) = integral of mu dG/dn dS, G = exp(-i k R) / (4 pi R).

With the acceleration a of the plate along the normal n, dp/dn = -rho a on the plate is an equation for mu, the finite
part of

    integral of mu (1 + i k R) exp(-i k R) / (4 pi R³) dS = -rho a.

Strengths are constant on patches between the Chebyshev points of each side, and the equations hold at the points
between these: Multhopp's rule for wings (Lan 1974, J. Aircraft 11, 518-527), which includes the decrease of mu to zero
at edges. A coarser sheet of the same plate tells how much the points matter: the error of a mode is the relative
difference of the force of the air on it, ``integral of mu shape dS``, between the two. The parts ``1 / R³`` and
``k² / 2 R`` of the kernel are integrated in closed form over the patches; the rest is smooth. A rectangle is symmetric
about both of its middle lines: modes that are even or odd about each need only a quarter of the points.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import ceil, pi, sqrt
from typing import ClassVar

import numpy as np

from ..arrays import Array
from ..bodies.body_surfaces import SOUND
from .equivalent_sources import Fit
from .panels import Panel

# Points along a side for each wave of sound or of the modes, additional points for the edges, and largest total number.
POINTS_A_WAVE, FOR_EDGES, MOST = 3.0, 12, 2400
# Points along a side of the coarser sheet, relative to those of the sheet.
COARSER = 0.7
# Images of a point in both middle lines; 1 where it is mirrored.
IMAGES = ((0, 0), (1, 0), (0, 1), (1, 1))


@dataclass(frozen=True, eq=False)
class Sheet:
    """A rectangle that moves out of its plane, with a corner at x = 0 and y = `edge`.

    Attributes
    ----------
    length, width, edge : float
        Sides along x and y, and smallest y [m].
    counts : tuple of int
        Numbers of cuts along x and along y, odd; the points lie between them.
    shapes : ndarray, shape (quarter of the points, modes)
        Motion of the modes at the points next to the corner [kg^(-1/2)].
    parities : ndarray of int, shape (modes, 2)
        Signs of the modes at the images of these points along x and along y, 1 or -1.
    coarser : Sheet or None
        The same rectangle with fewer points, for errors; nan without it.
    """

    form: ClassVar[str] = "sheet"
    length: float
    width: float
    edge: float
    counts: tuple[int, int]
    shapes: Array
    parities: Array
    coarser: Sheet | None = None

    @property
    def content(self) -> tuple[bytes, ...]:
        """All that fits depend on, for comparison."""
        sides = np.array([self.length, self.width, self.edge, *self.counts])
        own = sides.tobytes(), self.shapes.tobytes(), self.parities.tobytes()
        return own if self.coarser is None else (*own, *self.coarser.content)

    @property
    def frequency(self) -> float:
        """Frequency up to which its points are enough for the sound [Hz]."""
        sides = zip((self.length, self.width), self.counts, strict=True)
        return min(SOUND * (count - FOR_EDGES) / (POINTS_A_WAVE * 0.5 * pi * side) for side, count in sides)


def sheet_of(panel: Panel, frequency: float) -> Sheet:
    """Return a panel as a sheet with points for its modes and for sound up to a frequency [Hz]."""
    sides, waves = (
        np.array([panel.length, panel.width]),
        np.maximum(panel.wavenumbers.max(axis=0), 2.0 * pi * frequency / SOUND),
    )
    # In the middle, the distance of points is pi / 2 times its mean.
    wanted = POINTS_A_WAVE * sides * waves / 4.0 + FOR_EDGES
    wanted *= min(1.0, sqrt(MOST / float(wanted.prod())))
    return replace(_with_points(panel, wanted), coarser=_with_points(panel, COARSER * wanted))


def _with_points(panel: Panel, wanted: Array) -> Sheet:
    """Return a panel as a sheet with at least the wanted numbers of points along its sides."""
    sides = panel.length, panel.width
    counts = tuple(2 * ceil(0.5 * (float(one) - 1.0)) + 1 for one in wanted)
    x, y = (_points(count, side)[: count // 2] for count, side in zip(counts, sides, strict=True))
    x, y = (part.ravel() for part in np.meshgrid(x, panel.edge + y, indexing="ij"))
    shapes = panel.shapes(x, y)
    images = panel.shapes(panel.length - x, y), panel.shapes(x, 2.0 * panel.edge + panel.width - y)
    parities = np.stack([np.where((shapes * other).sum(axis=0) < 0.0, -1, 1) for other in images], axis=1)
    return Sheet(panel.length, panel.width, panel.edge, (counts[0], counts[1]), shapes, parities)


@dataclass(frozen=True, eq=False)
class SheetDipoles:
    """A thin flat body as dipoles along its normal.

    Attributes
    ----------
    surface : Sheet
        The body.
    """

    error_in: ClassVar[str] = "the force of the air on it"
    surface: Sheet

    @property
    def size(self) -> float:
        """Largest extent of the body [m]."""
        return float(np.hypot(self.surface.length, self.surface.width))

    def fit(self, wavenumber: float) -> Fit:
        """Return the differences of pressure at a quarter of the points, for a wavenumber of the sound [rad/m]."""
        found = self._differences(wavenumber)
        errors = np.full(len(self.surface.parities), np.nan)
        if self._coarser is not None:
            own, other = (
                one.carried(strengths)
                for one, strengths in ((self, found), (self._coarser, self._coarser._differences(wavenumber)))
            )
            errors = np.abs(own - other) / np.abs(own)
        return Fit((found,), errors)

    def carried(self, differences: Array) -> Array:
        """Return the forces of the air on the modes, over its density, for unit modal accelerations, shape (modes,)."""
        return 4.0 * np.asarray(self._areas @ (differences * self.surface.shapes))

    @cached_property
    def _coarser(self) -> SheetDipoles | None:
        coarser = self.surface.coarser
        return None if coarser is None else SheetDipoles(coarser)

    def _differences(self, wavenumber: float) -> Array:
        """Return the differences of pressure at a quarter of the points."""
        away, still, bent = self._pairs
        phase = wavenumber * away
        # (1 + i k R) exp(-i k R) less 1 + k² R² / 2, near R = 0 equal to -i k³ R³ / 3.
        rest = (1.0 + 1j * phase) * np.exp(-1j * phase) - 1.0 - 0.5 * phase**2
        with np.errstate(invalid="ignore", divide="ignore"):
            rest = np.where(away > 0.0, rest / away**3, -1j * wavenumber**3 / 3.0)
        parts = (still + 0.5 * wavenumber**2 * bent + rest * self._areas) / (4.0 * pi)
        found = np.empty(self.surface.shapes.shape, dtype=np.complex64)
        for parity in np.unique(self.surface.parities, axis=0):
            those = (self.surface.parities == parity).all(axis=1)
            matrix = np.tensordot(_signs(parity[None])[:, 0], parts, 1)
            found[:, those] = np.linalg.solve(matrix, -self.surface.shapes[:, those])
        return found

    def heard(self, fit: Fit, wavenumber: float, places: Array) -> Array:
        """Return the pressures at places (listeners, 3) [m] for unit modal accelerations, shape (listeners, modes)."""
        found = np.zeros((len(places), self.surface.shapes.shape[1]), dtype=complex)
        for (x, y), sign in zip(self._images, _signs(self.surface.parities), strict=True):
            square = (places[:, 0, None] - x) ** 2 + (places[:, 1, None] - y) ** 2 + places[:, 2, None] ** 2
            away = np.sqrt(square)
            phase = wavenumber * away
            path = (1.0 + 1j * phase) * np.exp(-1j * phase) * places[:, 2, None] / (4.0 * pi * away**3)
            found += sign * ((path * self._areas) @ fit.strengths[0])
        return found

    @cached_property
    def _sides(self) -> list[tuple[Array, Array]]:
        """Cuts and points of both sides [m]."""
        surface = self.surface
        lows, sides = (0.0, surface.edge), (surface.length, surface.width)
        return [
            (low + _cuts(count, side), low + _points(count, side))
            for low, side, count in zip(lows, sides, surface.counts, strict=True)
        ]

    @cached_property
    def _images(self) -> list[tuple[Array, Array]]:
        """Places x and y of the points of a quarter and of their images, shape (quarter,) each."""
        (_, x), (_, y) = self._sides
        halves = [[part[: part.size // 2], part[::-1][: part.size // 2]] for part in (x, y)]
        found = []
        for across, along in IMAGES:
            one, other = np.meshgrid(halves[0][across], halves[1][along], indexing="ij")
            found.append((one.ravel(), other.ravel()))
        return found

    @cached_property
    def _areas(self) -> Array:
        """Areas of the patches of a quarter [m²]."""
        first, second = (np.diff(cuts)[: cuts.size // 2] for cuts, _ in self._sides)
        return np.outer(first, second).ravel()

    @cached_property
    def _pairs(self) -> tuple[Array, Array, Array]:
        """Distances of the points of a quarter from the images [m], and integrals over the patches of the images.

        The integrals are those of ``1 / R³`` and ``1 / R``; shape (4, quarter, quarter) each.
        """
        x, y = self._images[0]
        away = np.array([np.hypot(x[:, None] - one, y[:, None] - other) for one, other in self._images])
        along, across = ((cuts - points[: points.size // 2, None]) for cuts, points in self._sides)
        a, b = along[:, None, :, None], across[None, :, None, :]
        square = np.hypot(a, b)
        still = _over_patches(-square / (a * b))
        bent = _over_patches(a * np.arcsinh(b / np.abs(a)) + b * np.arcsinh(a / np.abs(b)))
        return away, _by_image(still), _by_image(bent)


def _cuts(count: int, side: float) -> Array:
    """Return the Chebyshev points of a side, which separate patches [m]."""
    return np.asarray(0.5 * side * (1.0 - np.cos((np.arange(count) + 0.5) * pi / count)))


def _points(count: int, side: float) -> Array:
    """Return the points between the cuts [m]."""
    return np.asarray(0.5 * side * (1.0 - np.cos(np.arange(1, count) * pi / count)))


def _signs(parities: Array) -> Array:
    """Return the signs of modes, shape (modes, 2), at the images, shape (4, modes)."""
    return np.array([parities[:, 0] ** x * parities[:, 1] ** y for x, y in IMAGES])


def _over_patches(corners: Array) -> Array:
    """Return integrals over patches from their primitive at the cuts, along the last two axes."""
    return np.asarray(np.diff(np.diff(corners, axis=-1), axis=-2))


def _by_image(found: Array) -> Array:
    """Return values of all patches, shape (x, y, patches along x, along y), by image, shape (4, quarter, quarter)."""
    one, other = (size // 2 for size in found.shape[2:])
    quarter = found.shape[0] * found.shape[1]
    flipped = [[found, found[..., ::-1]], [found[..., ::-1, :], found[..., ::-1, ::-1]]]
    return np.array([flipped[x][y][..., :one, :other].reshape(quarter, quarter) for x, y in IMAGES])
