"""Sounds weighted as sound level meters do: in frequency by A, and in time (IEC 61672-1)."""

from __future__ import annotations

import numpy as np
import scipy  # its parts are imported on first use
from scipy.fft import irfft, next_fast_len, rfft, rfftfreq

from ..arrays import Array
from ..weighting import a_weighting

# Time constants of the time weightings [s].
TIME_CONSTANTS = {"fast": 0.125, "slow": 1.0}
# Silence added at the end [s], in which the slowest pole dies away by 100 dB.
TAIL = 0.1


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
