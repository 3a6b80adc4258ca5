"""Sound at another sample rate, by a ratio of whole numbers and one linear-phase low-pass."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from scipy.signal import firwin, kaiserord, resample_poly

from ..arrays import Array

# Attenuation from half of the lower rate on [dB], and how far below that the pass band ends: 20 kHz at 44.1 kHz.
STOP_BAND = 110.0
PASS_BAND = 0.907
# Rates that are not in a ratio of such numbers are off by one part in 1e7, by some in 1e6 where they are far apart.
LARGEST_DENOMINATOR = 5000


def ratio(rate: float, wanted: float) -> Fraction:
    """Return `wanted` over `rate` [Hz] as a ratio of whole numbers, exactly where they are below 5000."""
    return Fraction(wanted / rate).limit_denominator(LARGEST_DENOMINATOR)


def resampled(values: Array, rate: float, wanted: float) -> Array:
    """Return signals at another sample rate; before their first sample and after their last there is silence.

    A Kaiser-windowed sinc: flat within 0.0001 dB up to 0.907 of half of the lower rate, 110 dB down from that half on.
    Nothing that is heard is folded back, and no image is left.

    Parameters
    ----------
    values : ndarray, shape (samples, signals)
        The signals.
    rate, wanted : float
        Their sample rate and the other one [Hz].

    Returns
    -------
    ndarray, shape (other samples, signals)
        The first sample is at the time of the first one.
    """
    by = ratio(rate, wanted)
    if by == 1:
        return values
    return np.asarray(resample_poly(values, by.numerator, by.denominator, axis=0, window=low_pass(by)))


def low_pass(by: Fraction, pass_band: float = PASS_BAND, stop_band: float = STOP_BAND) -> Array:
    """Return the taps of a Kaiser-windowed sinc at the least common multiple of two sample rates.

    Parameters
    ----------
    by : Fraction
        New over old sample rate.
    pass_band : float, optional
        Share of half of the lower rate up to which it is flat [1].
    stop_band : float, optional
        Attenuation from that half on [dB].
    """
    # In units of half of the rate at which it works.
    stop = 1.0 / max(by.numerator, by.denominator)
    size, beta = kaiserord(stop_band, (1.0 - pass_band) * stop)
    return np.asarray(firwin(size | 1, 0.5 * (1.0 + pass_band) * stop, window=("kaiser", beta)))
