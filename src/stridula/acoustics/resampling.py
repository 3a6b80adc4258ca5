"""Resampling from the rate of a record to that of a sound, with nothing above the bandwidth."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import scipy  # its parts are imported on first use

from ..arrays import Array
from ..checks import ArgumentError, at_least, at_most, positive
from .sample_rates import low_pass

# Fraction of the lower sample rate up to which sound is complete.
BANDWIDTH = 5.0 / 12.0
LOWEST = 1000.0
# Attenuation of frequencies above half the lower sample rate [dB].
ATTENUATION = 80.0
# Largest numerator and denominator of the ratio of sample rates, largest drift over a signal in samples.
LARGEST = 4000
DRIFT = 0.01


def ratio_of(sample_rate: float | None, recorded: float, samples: int) -> Fraction:
    """Return the wanted sample rate over that of the record.

    Raises
    ------
    ValueError
        If it exceeds that of the record, is below 1000 Hz, or is not in a ratio of whole numbers up to 4000.
    """
    if sample_rate is None:
        return Fraction(1)
    wanted = positive("sample_rate", sample_rate)
    highest = recorded * (1.0 + 1e-9)
    if wanted > highest:
        raise ArgumentError("sample_rate", f"be at most the record's {at_most(highest, 8)} Hz", sample_rate)
    if wanted < min(LOWEST, recorded):
        raise ArgumentError("sample_rate", f"be at least {at_least(min(LOWEST, recorded))} Hz", sample_rate)
    found = Fraction(wanted / recorded).limit_denominator(LARGEST)
    if found == 0 or abs(float(found) * recorded / wanted - 1.0) * samples > DRIFT:
        raise ArgumentError(
            "sample_rate",
            f"be in a ratio of whole numbers up to {LARGEST} to the record's {recorded:.8g} Hz",
            sample_rate,
        )
    return found


def bandwidth_of(ratio: Fraction, recorded: float) -> float:
    """Return the frequency [Hz] up to which sound is complete."""
    return BANDWIDTH * recorded * min(1.0, float(ratio))


def resample(signals: Array, ratio: Fraction) -> Array:
    """Return signals at `ratio` times their sample rate, without delay, low-passed.

    A Kaiser-windowed sinc: flat to 0.01 % up to 5/12 of the lower rate, 80 dB down above half of it.

    Parameters
    ----------
    signals : ndarray, shape (signals, samples)
        The signals, zero before their start and after their end.
    ratio : Fraction
        New over old sample rate, at most 1.
    """
    taps = low_pass(ratio, 2.0 * BANDWIDTH, ATTENUATION)
    if ratio == 1:
        return np.asarray(scipy.signal.oaconvolve(signals, taps[None, :], mode="same", axes=1))
    return np.asarray(scipy.signal.resample_poly(signals, ratio.numerator, ratio.denominator, axis=1, window=taps))
