"""Audible power of the recorded forces, and its tonal part, in short frames."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..arrays import Array

# Fewest samples in a frame.
FEWEST = 8


@dataclass(frozen=True)
class Frames:
    """Audible forces in successive frames, which overlap by half.

    Attributes
    ----------
    amplitude : ndarray, shape (frames,)
        Root mean square of the forces above the lowest tone [N].
    repeating : ndarray, shape (frames,)
        Share of that power that repeats itself within a period of the lowest tone [1].
    """

    amplitude: Array
    repeating: Array

    @property
    def tonality(self) -> float:
        """Mean repeating share [1], weighted by the amplitude of the frames."""
        total = float(self.amplitude.sum())
        return float(self.amplitude @ self.repeating) / total if total > 0.0 else 0.0

    @property
    def level(self) -> float:
        """Root mean square over all frames [N]."""
        return float(np.sqrt(np.mean(self.amplitude**2))) if self.amplitude.size else 0.0

    @property
    def growth(self) -> float:
        """Root mean square of the later half of the frames over that of the earlier half [1]; NaN for one frame."""
        middle = self.amplitude.size // 2
        early = float(np.sum(self.amplitude[:middle] ** 2))
        late = float(np.sum(self.amplitude[self.amplitude.size - middle :] ** 2))
        return float(np.sqrt(late / early)) if early > 0.0 else float("nan")

    def later_half(self) -> Frames:
        """Return the later half of the frames."""
        middle = self.amplitude.size // 2
        return Frames(self.amplitude[middle:], self.repeating[middle:])


def frames(forces: Array, interval: float, length: float, lowest: float) -> Frames:
    """Return the audible forces in each frame.

    Each frame is taken without its mean, under a Hann window, without its spectrum below `lowest`. The share of power
    that repeats itself is the highest value, beyond the first negative one, of the autocorrelation at lags up to
    ``1 / lowest``: for a tone in noise it is the tone's share of the power.

    Parameters
    ----------
    forces : ndarray, shape (forces, samples)
        Recorded forces [N], whose powers are added.
    interval : float
        Interval of the samples [s].
    length : float
        Length of a frame [s]; at most the whole record.
    lowest : float
        Lowest tone [Hz].
    """
    size = round(min(length / interval, forces.shape[1]))
    lags = int(np.ceil(min(1.0 / (lowest * interval), size))) + 1
    if size < FEWEST:
        return Frames(np.zeros(0), np.zeros(0))
    pieces = _pieces(forces, size, max(size // 2, 1))
    padded = 2 ** int(np.ceil(np.log2(size + lags)))
    first = int(np.ceil(lowest * padded * interval))
    window, waves = _basis(size, padded, first, min(lags, size // 2))
    spectra = np.fft.rfft((pieces - pieces.mean(axis=2, keepdims=True)) * window, padded, axis=2)[:, :, first:]
    correlation = np.sum(spectra.real**2 + spectra.imag**2, axis=0) @ waves
    power = np.maximum(correlation[:, 0], 0.0)
    beyond = np.logical_or.accumulate(correlation < 0.0, axis=1)
    highest = np.where(beyond, correlation, 0.0).max(axis=1)
    return Frames(np.sqrt(power), np.clip(highest / np.maximum(power, 1e-300), 0.0, 1.0))


def _pieces(forces: Array, size: int, apart: int) -> Array:
    """Return frames of `size` samples that begin `apart` samples apart, shape (forces, frames, size)."""
    whole = np.ascontiguousarray(forces)
    along = whole.strides[1]
    shape = (len(whole), (whole.shape[1] - size) // apart + 1, size)
    return np.ndarray(shape, whole.dtype, whole, 0, (whole.strides[0], along * apart, along))


@lru_cache(maxsize=16)
def _basis(size: int, padded: int, first: int, lags: int) -> tuple[Array, Array]:
    """Return a Hann window, and the matrix from power spectra, from `first` on, to the autocorrelation at first lags.

    Both sides of the spectrum count, and the result is divided by the overlap of the window with itself.
    """
    window = np.hanning(size + 1)[:-1]
    overlap = np.array([window[lag:] @ window[: size - lag] for lag in range(lags)])
    number = np.arange(first, padded // 2 + 1)
    sides = np.where((number == 0) | (number == padded // 2), 1.0, 2.0)
    waves = np.cos(2.0 * np.pi / padded * np.outer(number, np.arange(lags)))
    return window, sides[:, None] * waves / (padded * overlap)
