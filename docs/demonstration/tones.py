"""Lines of a periodic signal: its base frequency and the complex amplitudes of its multiples."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.signal.windows import hann

Array = np.ndarray[Any, np.dtype[Any]]

# Periods of the pitch that a cycle may take. Further lines must carry this share of the power: noise gives them some.
PERIODS, WORTH = (1, 2, 3, 4), 0.05


def amplitudes(signals: Array, rate: float, base: float, count: int) -> Array:
    """Return the complex amplitudes at the first multiples of a frequency.

    Parameters
    ----------
    signals : ndarray, shape (samples, signals)
        Signals; with amplitudes ``a`` they are the sum of ``Re(a exp(2 pi i k base t))``, t from the first sample.
    rate : float
        Sample rate [Hz].
    base : float
        The frequency [Hz].
    count : int
        Number of multiples.

    Returns
    -------
    ndarray, shape (count, signals)
        Amplitudes, in the unit of the signals, under Hann's window.
    """
    time, window = np.arange(len(signals)) / rate, hann(len(signals), sym=False)
    turns = np.exp(-2j * np.pi * base * np.outer(np.arange(1, count + 1), time))
    return np.asarray(2.0 * (turns * window) @ signals / window.sum())


def power(signal: Array) -> float:
    """Return the mean square of a signal about its mean, under the window of `amplitudes`."""
    window = hann(len(signal), sym=False)
    mean = window @ signal / window.sum()
    return float(window @ (signal - mean) ** 2 / window.sum())


def refined(signal: Array, rate: float, frequency: float) -> float:
    """Return the frequency of a line near another one [Hz], from the turn of its phase between two halves."""
    half = len(signal) // 2
    for _ in range(3):
        first, second = (amplitudes(part[:, None], rate, frequency, 1)[0, 0] for part in halves(signal, half))
        turned = np.angle(second / first * np.exp(-2j * np.pi * frequency * half / rate))
        frequency += turned * rate / (2.0 * np.pi * half)
    return frequency


def halves(signal: Array, half: int) -> tuple[Array, Array]:
    """Return both halves of a signal."""
    return signal[:half], signal[half : 2 * half]


def base_of(signal: Array, rate: float, pitch: float, highest: float) -> tuple[float, float]:
    """Return base frequency [Hz] of a signal and the share of its power in the multiples of it.

    Parameters
    ----------
    signal : ndarray, shape (samples,)
        The signal.
    rate : float
        Its sample rate [Hz].
    pitch : float
        Its pitch [Hz], near a multiple of the base frequency.
    highest : float
        Frequency up to which multiples count [Hz].
    """
    spectrum = np.abs(np.fft.rfft((signal - signal.mean()) * hann(len(signal), sym=False)))
    peak = float(spectrum.argmax() * rate / len(signal))
    exact = refined(signal, rate, peak)
    whole = power(signal)
    found = []
    for periods in PERIODS:
        base = exact / max(round(periods * peak / pitch), 1)
        lines = amplitudes(signal[:, None], rate, base, int(highest / base))[:, 0]
        found.append((base, min(float(0.5 * np.sum(np.abs(lines) ** 2)) / whole, 1.0)))
    best = max(share for _, share in found)
    return next(one for one in found if one[1] > best - WORTH)


def looped(signals: Array, count: int) -> Array:
    """Return a stretch that can be repeated: its beginning fades in over what follows its end, at equal power.

    Parameters
    ----------
    signals : ndarray, shape (samples, signals)
        Signals, of a fifth more samples than the stretch.
    count : int
        Samples of the stretch.
    """
    fade = count // 5
    rise = np.sin(0.5 * np.pi * np.arange(fade) / fade)[:, None]
    stretch = signals[:count].copy()
    stretch[:fade] = rise * signals[:fade] + np.sqrt(1.0 - rise**2) * signals[count : count + fade]
    return stretch


def lines_of(stretch: Array) -> Array:
    """Return the complex amplitudes of a stretch that is repeated, at all multiples of its frequency below half."""
    return np.asarray(2.0 * np.fft.rfft(stretch, axis=0)[1:-1] / len(stretch))
