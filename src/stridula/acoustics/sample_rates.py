"""Sound at another sample rate, by a ratio of whole numbers and one linear-phase low-pass."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import scipy  # its parts are imported on first use

from ..arrays import Array

# Attenuation above half of the lower rate [dB], and end of the pass band over that half: 20 kHz at 44.1 kHz.
STOP_BAND = 110.0
PASS_BAND = 0.907
# Rates without a ratio of such numbers are off by one part in 1e7, by some in 1e6 where they are far apart.
LARGEST_DENOMINATOR = 5000


def ratio(rate: float, wanted: float) -> Fraction:
    """Return `wanted` over `rate` [Hz] as a ratio of whole numbers, exactly where they are below 5000."""
    return Fraction(wanted / rate).limit_denominator(LARGEST_DENOMINATOR)


def resampled(values: Array, rate: float, wanted: float) -> Array:
    """Return signals at another sample rate, with silence before their first sample and after their last.

    A Kaiser-windowed sinc: flat within 0.0001 dB up to 0.907 of half of the lower rate, 110 dB down above that half.
    There is no audible aliasing and no image.

    Parameters
    ----------
    values : ndarray, shape (samples, signals)
        The signals.
    rate, wanted : float
        Their sample rate and the other one [Hz].

    Returns
    -------
    ndarray, shape (other samples, signals)
        Signals whose first sample is at the same time.
    """
    by = ratio(rate, wanted)
    if by == 1:
        return values
    return np.asarray(scipy.signal.resample_poly(values, by.numerator, by.denominator, axis=0, window=low_pass(by)))


def low_pass(by: Fraction, pass_band: float = PASS_BAND, stop_band: float = STOP_BAND) -> Array:
    """Return the taps of a Kaiser-windowed sinc at the least common multiple of two sample rates.

    Parameters
    ----------
    by : Fraction
        New over old sample rate.
    pass_band : float, optional
        Fraction of half of the lower rate up to which it is flat [1].
    stop_band : float, optional
        Attenuation above that half [dB].
    """
    # In units of half the rate of the filter.
    stop = 1.0 / max(by.numerator, by.denominator)
    size, beta = scipy.signal.kaiserord(stop_band, (1.0 - pass_band) * stop)
    return np.asarray(scipy.signal.firwin(size | 1, 0.5 * (1.0 + pass_band) * stop, window=("kaiser", beta)))
