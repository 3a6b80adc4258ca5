"""Frequency weighting A and the time weightings of sound level meters (IEC 61672-1)."""

from __future__ import annotations

import numpy as np
import scipy  # its parts are imported on first use
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq

from ..arrays import Array

# Poles of IEC 61672-1:2013, annex E [Hz]; those at the ends are double. The gain at 1 kHz is one.
POLES = (20.598997, 107.65265, 737.86223, 12194.217)
# Time constants of the time weightings [s].
TIME_CONSTANTS = {"fast": 0.125, "slow": 1.0}
# Silence added at the end [s], in which the slowest pole dies away by 100 dB.
TAIL = 0.1


def a_weighting(frequency: Array) -> Array:
    """Return the complex gain of the analogue A-weighting of IEC 61672-1 at frequencies [Hz], one at 1 kHz."""
    low, second, third, high = (2.0 * np.pi * pole for pole in POLES)

    def gain(hertz: Array) -> Array:
        s = 2.0j * np.pi * np.asarray(hertz, dtype=float)
        return s**4 / ((s + low) ** 2 * (s + second) * (s + third) * (s + high) ** 2)

    return np.asarray(gain(frequency) / np.abs(gain(np.array(1000.0))))


def a_weighted(values: Array, rate: float) -> Array:
    """Return sound pressures A-weighted, by the analogue filter itself.

    In the frequency domain, with silence after the end: a filter in the time domain with the same poles would err at
    high frequencies.

    Parameters
    ----------
    values : ndarray, shape (samples, signals)
        Sound pressures.
    rate : float
        Sample rate [Hz].

    Returns
    -------
    ndarray, shape (samples, signals)
    """
    size = next_fast_len(values.shape[0] + int(np.ceil(TAIL * rate)), real=True)
    gain = a_weighting(rfftfreq(size, 1.0 / rate))
    return np.asarray(irfft(rfft(values, size, axis=0) * gain[:, None], size, axis=0)[: values.shape[0]])


def time_weighted(squares: Array, rate: float, response: str) -> Array:
    """Return the exponential mean of squares, from silence, with the time constant of ``fast`` or ``slow``."""
    keeps = np.exp(-1.0 / (TIME_CONSTANTS[response] * rate))
    return np.asarray(scipy.signal.lfilter([1.0 - keeps], [1.0, -keeps], squares, axis=0))
