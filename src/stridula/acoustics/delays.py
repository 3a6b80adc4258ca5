"""Impulse responses of sound that arrives from many points, each after its own time, on a grid of samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
import scipy.sparse
import scipy.special

from ..arrays import Array

# Largest error of a delay within the bandwidth [dB].
ATTENUATION = 100.0
# Degree of the polynomials that represent the taps over a sample.
DEGREE = 20


@dataclass(frozen=True)
class Interpolation:
    """Kaiser-windowed sinc, which delays by any fraction of a sample.

    Exact to `ATTENUATION` up to the bandwidth given to `interpolation` (Kaiser 1974: an attenuation A in dB and a
    transition D, a fraction of the sample rate, require ``(A - 8) / (2.285 2 pi D)`` taps).

    Attributes
    ----------
    half_span : int
        Samples on each side.
    beta : float
        Shape of the window.
    """

    half_span: int
    beta: float

    def values(self, offset: Array) -> Array:
        """Return its values at distances from the delay in samples, zero beyond its span."""
        inside = np.sqrt(np.maximum(1.0 - (offset / self.half_span) ** 2, 0.0))
        window = scipy.special.i0(self.beta * inside) / scipy.special.i0(self.beta)
        return np.asarray(np.sinc(offset) * window)

    def rates(self, offset: Array) -> Array:
        """Return its derivative at distances from the delay, per sample."""
        inside = np.sqrt(np.maximum(1.0 - (offset / self.half_span) ** 2, 0.0))
        scale = scipy.special.i0(self.beta)
        window = scipy.special.i0(self.beta * inside) / scale
        # I1(z) / z is 1/2 at zero.
        ratio = np.where(inside > 1e-9, scipy.special.i1(self.beta * inside) / np.maximum(inside, 1e-9), self.beta / 2)
        sloped = -self.beta * offset / self.half_span**2 * ratio / scale
        near = np.abs(offset) < 1e-4
        safe = np.where(near, 1.0, offset)
        slope = np.where(near, -(np.pi**2) * offset / 3.0, (np.cos(np.pi * safe) - np.sinc(safe)) / safe)
        return np.asarray(slope * window + np.sinc(offset) * sloped)


def interpolation(share: float, attenuation: float = ATTENUATION) -> Interpolation:
    """Return the interpolation that is accurate up to `share` of the sample rate, below one half."""
    taps = (attenuation - 8.0) / (2.285 * 2.0 * np.pi * (1.0 - 2.0 * share))
    return Interpolation(half_span=int(np.ceil(taps / 2.0)) + 1, beta=0.1102 * (attenuation - 8.7))


@dataclass(frozen=True)
class Sampling:
    """Sampling of impulse responses.

    Attributes
    ----------
    interval : float
        Time between samples [s].
    bandwidth : float
        Frequency up to which responses are complete [Hz], below half the sample rate.
    shift : float, optional
        Number of samples added to every delay.
    attenuation : float, optional
        Largest error of a delay within the bandwidth [dB].
    """

    interval: float
    bandwidth: float
    shift: float = 0.0
    attenuation: float = ATTENUATION

    @cached_property
    def kernel(self) -> Interpolation:
        """Interpolation between the samples."""
        return interpolation(self.bandwidth * self.interval, self.attenuation)

    def delays(self, distances: Array, speed: float) -> Array:
        """Return the travel times over distances [m] at a speed of sound [m/s], in samples."""
        return np.asarray(distances / (speed * self.interval) + self.shift)


@dataclass(frozen=True)
class Response:
    """Impulse responses of the modes at a listener.

    Attributes
    ----------
    first : int
        Sample of the first tap; may be below zero.
    taps : ndarray, shape (taps, modes)
        The responses.
    """

    first: int
    taps: Array


def response(first: int, count: int, modes: int) -> Response:
    """Return an empty response."""
    return Response(first, np.zeros((count, modes)))


def span(least: float, largest: float, kernel: Interpolation) -> tuple[int, int]:
    """Return the first tap of delays from `least` to `largest` in samples, and the number of taps."""
    first = int(np.floor(least)) - kernel.half_span
    return first, int(np.floor(largest)) + kernel.half_span + 1 - first


def add(to: Response, delays: Array, strengths: Array, kernel: Interpolation, derivative: bool = False) -> None:
    """Add the sound that arrives from points.

    Parameters
    ----------
    to : Response
        The response to which it is added.
    delays : ndarray, shape (points,)
        Travel times in samples.
    strengths : ndarray, shape (points, modes)
        Strength of each mode at each point.
    kernel : Interpolation
        The interpolation.
    derivative : bool, optional
        Whether the derivative per sample of the strengths arrives.
    """
    to.taps[...] += arrivals(to, delays, kernel, derivative=derivative) @ strengths


def arrivals(
    to: Response, delays: Array, kernel: Interpolation, group: Array | None = None, derivative: bool = False
) -> Any:
    """Return the taps of points as a sparse matrix.

    Parameters
    ----------
    to : Response
        The response whose taps they are.
    delays : ndarray, shape (points,)
        Travel times in samples.
    kernel : Interpolation
        The interpolation.
    group : ndarray, shape (points,), optional
        Number of the group of each point, from 0.
    derivative : bool, optional
        Whether the derivative per sample arrives.

    Returns
    -------
    csc_array, shape (groups taps, points)
        The taps of each group one after the other.
    """
    whole = np.floor(delays).astype(np.int64)
    data = _polynomials(kernel, derivative)(delays - whole)
    first, groups = whole + 1 - kernel.half_span - to.first, 1
    if group is not None:
        first, groups = first + len(to.taps) * group, int(group.max()) + 1
    rows = first[:, None] + np.arange(data.shape[1])
    columns = np.arange(len(delays) + 1) * rows.shape[1]
    return scipy.sparse.csc_array((data.ravel(), rows.ravel(), columns), shape=(groups * len(to.taps), len(delays)))


@lru_cache(maxsize=64)
def _polynomials(kernel: Interpolation, derivative: bool) -> Callable[[Array], Array]:
    """Return a function of fractions of a sample, from 0 to 1, that returns the taps, shape (fractions, taps).

    The taps are entire functions of the fraction; their Chebyshev polynomials are exact to rounding.
    """
    nodes = np.polynomial.chebyshev.chebpts1(DEGREE + 1)
    taps = np.arange(1 - kernel.half_span, kernel.half_span + 1) - 0.5 * (nodes + 1.0)[:, None]
    values = kernel.rates(taps) if derivative else kernel.values(taps)
    series = np.linalg.solve(np.polynomial.chebyshev.chebvander(nodes, DEGREE), values)
    return lambda fraction: np.polynomial.chebyshev.chebvander(2.0 * fraction - 1.0, DEGREE) @ series
