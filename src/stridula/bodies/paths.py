"""Paths: mode shapes of a body along a line on which other bodies slide."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol, TypeGuard

import numpy as np

from ..arrays import Array
from .modes import Body
from .points import BodyPoint


@dataclass(frozen=True)
class Waves:
    """The traces of some modes along a path: products of sines and cosines of ``m a`` and ``n b``.

    Attributes
    ----------
    multiples : ndarray of int, shape (modes, 2)
        Multiples (m, n) of the two angles of the path.
    amplitude : ndarray, shape (modes, 2)
        Amplitudes of ``sin(m a) cos(n b)`` and of ``cos(m a) sin(n b)`` [kg^(-1/2)].
    cosines : bool, optional
        Whether the products are ``cos(m a) cos(n b)`` and ``sin(m a) sin(n b)`` instead.
    """

    multiples: Array
    amplitude: Array
    cosines: bool = False

    @property
    def products(self) -> int:
        """Number of products that modes consist of, 0 if all are waves of the first angle."""
        return 1 + bool(self.amplitude[:, 0].any()) if self.multiples[:, 1].any() else 0

    def slopes(self, rate: Array) -> Array:
        """Return the amplitudes of the derivatives along the path for the rates of the angles, shape (modes, 2).

        They are amplitudes of the other two products, those of ``sin(n b)`` first.
        """
        (first, second), (m, n) = self.amplitude.T, (self.multiples * rate).T
        sign = -1.0 if self.cosines else 1.0
        return np.stack([-sign * m * second - n * first, sign * m * first + n * second], axis=1)

    def traces(self, path: Path, abscissa: float) -> tuple[Array, Array]:
        """Return the trace of each mode at an abscissa [m] and its derivative along the path."""
        (one, other), (sine, cosine) = self._waves(path, np.array(abscissa))
        trace = self.amplitude * np.stack([one * cosine, other * sine], axis=1)
        slope = self.slopes(path.rate) * np.stack([one * sine, other * cosine], axis=1)
        return trace.sum(axis=1), slope.sum(axis=1)

    def along(self, path: Path, abscissas: Array) -> Array:
        """Return the trace of each mode at many abscissas [m], shape (modes, abscissas)."""
        (one, other), (sine, cosine) = self._waves(path, abscissas)
        first, second = self.amplitude.T[..., None]
        return np.asarray(first * one * cosine + second * other * sine)

    def _waves(self, path: Path, abscissas: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        """Return the wave of the first angle in the first product and its other, sine and cosine of the second."""
        along, across = (
            np.multiply.outer(numbers, rate * abscissas + phase)
            for numbers, rate, phase in zip(self.multiples.T, path.rate, path.phase, strict=True)
        )
        sine, cosine = np.sin(along), np.cos(along)
        return (cosine, sine) if self.cosines else (sine, cosine), (np.sin(across), np.cos(across))


@dataclass(frozen=True)
class Path:
    """A line on a body along which every mode is at most two products of sinusoids of the abscissa s.

    Their arguments are multiples of two angles, ``rate s + phase``, each from 0 to pi between the ends. Modes along
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
