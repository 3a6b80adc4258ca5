"""Channels of a file, with their names, units and times."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError

# Units of a signal whose file does not say them, and of a sound file without a calibration, whose full scale is 1.
UNKNOWN, FULL_SCALE = "unknown", "FS"
# Names of a column of times, in small letters.
TIMES = ("time", "t")
# Seconds of the units of times.
SECONDS = {"s": 1.0, "sec": 1.0, "second": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "min": 60.0}
# Fraction of the interval by which samples may be off an even grid, beyond the last digit of their times.
EVEN = 1e-2
# Times whose last digit is more than this fraction of their interval do not show whether a sample is missing.
COARSE = 0.25
# Relative difference of steps that is due to rounding.
EXACT = 1e-6


@dataclass(frozen=True)
class Channel:
    """A channel of a file.

    Attributes
    ----------
    name : str
        Its name.
    units : str
        Its units, `UNKNOWN` or `FULL_SCALE` where the file does not say them.
    values : ndarray, shape (samples,)
        Finite samples.
    rate : float
        Sample rate [Hz].
    start : float
        Time of the first sample [s].
    meaning : str
        Description.
    """

    name: str
    units: str
    values: Array
    rate: float
    start: float = 0.0
    meaning: str = ""


class Uneven(ValueError):
    """Times that are not evenly spaced.

    Attributes
    ----------
    sample : int
        Number of the first sample that is off, from 0.
    words : str
        What is wrong there.
    """

    def __init__(self, sample: int, words: str) -> None:
        self.sample, self.words = sample, words
        super().__init__(words)


def plain_units(units: str) -> str:
    """Return units as the package writes them: ``m/s2`` for ``m/s^2``, ``m/s²`` and ``m/s**2``."""
    text = units.strip().translate(str.maketrans("²³μ", "23µ"))
    return re.sub(r"(?:\*\*|\^)(?=-?\d)", "", text)


def seconds(units: str) -> float | None:
    """Return the seconds of a unit of times, None for other units."""
    return SECONDS.get(plain_units(units).lower())


def grid(times: Array, digit: Array | float) -> tuple[float, float]:
    """Return start [s] and sample rate [Hz] of evenly spaced times.

    Parameters
    ----------
    times : ndarray, shape (samples,)
        Times [s].
    digit : float or ndarray, shape (samples,)
        Value of the last digit with which each is written [s].

    Raises
    ------
    Uneven
        If they are not evenly spaced.
    """
    if times.size < 2:
        raise Uneven(0, "must have at least 2 samples")
    steps = np.diff(times)
    interval = float(np.median(steps))
    if not interval > 0.0 or (steps <= 0.0).any():
        raise Uneven(int(np.argmax(steps <= 0.0)) + 1, "times must increase")
    last = np.broadcast_to(np.asarray(digit, dtype=float), times.shape)
    mean = float((times[-1] - times[0]) / (times.size - 1))
    if np.abs(steps - mean).max() > EXACT * mean:
        _check_even(times, steps, interval, last)
    return float(times[0]), round_rate(1.0 / mean, float(last[-1]) / float(times[-1] - times[0]))


def _check_even(times: Array, steps: Array, interval: float, last: Array) -> None:
    """Raise `Uneven` if times are off an even grid by more than their last digit and a hundredth of the interval."""
    # Digits too coarse to tell rounding from a missing sample explain no difference.
    allowed = EVEN * interval + 0.5 * np.where(last > COARSE * interval, 0.0, last)
    off = np.abs(steps - interval) > 1.001 * (allowed[1:] + allowed[:-1])
    if off.any():
        wrong = int(np.argmax(off))
        raise Uneven(wrong + 1, f"times must be evenly spaced by {interval:.6g} s, got a step of {steps[wrong]:.6g} s")
    even = np.linspace(times[0], times[-1], times.size)
    drift = np.abs(times - even) > 2.0 * allowed
    if drift.any():
        wrong = int(np.argmax(drift))
        raise Uneven(wrong, f"times must be evenly spaced, got {times[wrong]:.9g} s instead of {even[wrong]:.9g} s")


def round_rate(rate: float, error: float) -> float:
    """Return a sample rate [Hz], rounded to a whole number or a tenth of one if it is that within a relative error."""
    for nearest in (round(rate), round(10.0 * rate) / 10.0):
        if abs(rate - nearest) <= max(2.0 * error, 1e-12) * rate and nearest > 0.0:
            return float(nearest)
    return rate


def checked_rate(path: str, stated: float, given: float | None, error: float = 1e-3) -> float:
    """Return the sample rate [Hz] that is given, after comparing it with the one that a file states."""
    if given is None:
        return stated
    if abs(stated - given) > error * given:
        raise ArgumentError("sample_rate", f"be that of {path}, {stated:.6g} Hz", given)
    return given


def chosen(path: str, names: Sequence[str], name: str) -> int:
    """Return the place of a channel by its name."""
    if name in names:
        return list(names).index(name)
    raise ArgumentError("channel", f"be one of those of {path}: {', '.join(map(repr, names))}", name)
