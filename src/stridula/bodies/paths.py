"""Paths: mode shapes of a body along a line on which other bodies slide."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, TypeGuard

import numpy as np

from ..arrays import Array
from .modes import Body, BodyPoint


@dataclass(frozen=True)
class Waves:
    """The traces of some modes along a path: sines, or cosines, of ``m a + n b`` and ``m a - n b``.

    Attributes
    ----------
    multiples : ndarray of int, shape (modes, 2)
        Multiples (m, n) of the two angles of the path.
    amplitude : ndarray, shape (modes, 2)
        Amplitudes for the sum and the difference of the angles [kg^(-1/2)]; the second is zero where n is.
    cosines : bool, optional
        Whether they are cosines instead of sines.
    """

    multiples: Array
    amplitude: Array
    cosines: bool = False

    @property
    def has_two(self) -> bool:
        """Whether modes are made of two waves."""
        return bool(self.multiples[:, 1].any())

    @property
    def of_products(self) -> Array:
        """Amplitudes of the products of waves of the two angles, shape (2, modes).

        Sines of sum and difference are ``cos(m a) sin(n b)`` and ``sin(m a) cos(n b)``; cosines are
        ``sin(m a) sin(n b)`` and ``cos(m a) cos(n b)``.
        """
        total, difference = self.amplitude.sum(axis=1), self.amplitude[:, 0] - self.amplitude[:, 1]
        return np.stack([-difference if self.cosines else difference, total])

    @property
    def products(self) -> int:
        """Number of products that modes consist of, 0 if all are waves of the first angle."""
        return 0 if not self.has_two else 1 + bool(self.of_products[1].any())

    def rates(self, rate: Array) -> Array:
        """Return the wavenumbers of the two waves of each mode [rad/m], shape (modes, 2)."""
        return np.asarray(self.multiples @ (rate * [[1.0, 1.0], [1.0, -1.0]]).T)

    def traces(self, path: Path, abscissa: float) -> tuple[Array, Array]:
        """Return the trace of each mode at an abscissa [m] and its derivative along the path."""
        rates = self.rates(path.rate)
        angles = rates * abscissa + self.rates(path.phase)
        if self.cosines:
            return (self.amplitude * np.cos(angles)).sum(axis=1), (-self.amplitude * rates * np.sin(angles)).sum(axis=1)
        return (self.amplitude * np.sin(angles)).sum(axis=1), (self.amplitude * rates * np.cos(angles)).sum(axis=1)

    def along(self, path: Path, abscissas: Array) -> Array:
        """Return the trace of each mode at many abscissas [m], shape (modes, abscissas)."""
        angles = self.rates(path.rate)[..., None] * abscissas + self.rates(path.phase)[..., None]
        return np.asarray((self.amplitude[..., None] * (np.cos if self.cosines else np.sin)(angles)).sum(axis=1))


@dataclass(frozen=True)
class Path:
    """A line on a body along which every mode is at most two sinusoids of the abscissa s.

    Their arguments are combinations of two angles, ``rate s + phase``, each from 0 to pi between the ends. Modes along
    the normal come first, then modes along the tangent.

    Attributes
    ----------
    ends : tuple of float
        Abscissas between which a contact may move [m].
    rate, phase : ndarray, shape (2,)
        Rates of the angles along the path [rad/m], and their values at abscissa zero [rad].
    normal, tangential : Waves
        Displacement along the normal and along the tangent.
    """

    ends: tuple[float, float]
    rate: Array
    phase: Array
    normal: Waves
    tangential: Waves

    def traces(self, abscissa: float) -> tuple[Array, Array]:
        """Return the displacements (tangent, normal) at an abscissa [m] from the modes, and their derivatives along it.

        Both have the shape (2, modes).
        """
        bending = len(self.normal.multiples)
        rows, slopes = np.zeros((2, 2, bending + len(self.tangential.multiples)))
        rows[1, :bending], slopes[1, :bending] = self.normal.traces(self, abscissa)
        rows[0, bending:], slopes[0, bending:] = self.tangential.traces(self, abscissa)
        return rows, slopes


class Track(Body, Protocol):
    """A body on which other bodies slide: any with a path."""

    @property
    def ends(self) -> tuple[float, float]:
        """Abscissas of the ends of its path [m]."""

    @property
    def centre(self) -> BodyPoint:
        """The point in its middle."""

    def path(self) -> Path:
        """Return the path along which other bodies slide."""


def is_track(body: Any) -> TypeGuard[Track]:
    """Return whether other bodies slide along a body; faster than a check of the Protocol."""
    return hasattr(body, "path")


def along_one_angle(numbers: Array, amplitude: float | Array, cosines: bool = False) -> Waves:
    """Return modes that are sines of multiples of the first angle alone."""
    amplitudes = np.zeros((numbers.size, 2))
    amplitudes[:, 0] = amplitude
    return Waves(np.stack([numbers, np.zeros_like(numbers)], axis=1), amplitudes, cosines)
