"""The tones of a limit cycle, and which modes of linear theory they belong to."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from ..analysis import tones
from ..arrays import Array

# Tones that are kept, and how far below the strongest they still count [dB].
MOST, FAINTEST = 8, -40.0
# Width of the bands of the spectrum, and lowest tone, over the resolution of the window.
BANDS, LOWEST = 4.0, 4.0
# Highest multiple of half of a tone that is told from a tone of its own.
HIGHEST_MULTIPLE = 40


class Tone(NamedTuple):
    """A tone of a limit cycle.

    Attributes
    ----------
    frequency : float
        Frequency [Hz].
    level : float
        Level below the strongest [dB].
    mode : int
        Number of the mode that it belongs to, -1 for none.
    order : float
        Its frequency over that of the tone that it is a multiple of, 1 for one that stands for itself.
    """

    frequency: float
    level: float
    mode: int
    order: float


def tones_of(signal: xr.DataArray, exponents: Array, grows: Array, resolution: float) -> list[Tone]:
    """Return the tones of a signal, the strongest first, each with the mode that it belongs to.

    A tone belongs to the nearest mode that grows; else it is a multiple of half of a tone that does; else it belongs to
    the nearest of the other modes; each within the resolution.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,)
        A recorded signal.
    exponents : ndarray of complex
        Exponents of the modes [1/s].
    grows : ndarray of int
        Numbers of the modes that grow.
    resolution : float
        Largest distance of a tone from its mode, relative to it [1].
    """
    time = signal["time"].values
    step = 1.0 / (time[-1] - time[0])
    found, levels = tones(signal, resolution=min(BANDS * step, 0.1 / (time[1] - time[0])))
    kept = [(f, level) for f, level in zip(found.tolist(), levels.tolist(), strict=True) if f > LOWEST * step]
    if not kept:
        return []
    strongest = kept[0][1]
    kept = [(f, level - strongest) for f, level in kept if level - strongest > FAINTEST][:MOST]
    frequencies = np.abs(exponents.imag) / (2.0 * np.pi)
    others = np.setdiff1d(np.flatnonzero(frequencies > 0.0), grows)
    own = {f: number for f, _ in kept if (number := _nearest(f, frequencies, grows, resolution)) >= 0}
    named = []
    for f, level in kept:
        mode, order = own.get(f, -1), 1.0
        if mode < 0:
            mode, order = _multiple(f, own, 2.0 * step)
        if mode < 0:
            mode = _nearest(f, frequencies, others, resolution)
        named.append(Tone(f, level, mode, order))
    return named


def _nearest(frequency: float, frequencies: Array, numbers: Array, resolution: float) -> int:
    """Return which of some modes is nearest to a frequency [Hz], -1 if none is near."""
    if not numbers.size:
        return -1
    number = int(numbers[np.abs(frequencies[numbers] - frequency).argmin()])
    return number if abs(frequencies[number] - frequency) <= resolution * frequencies[number] else -1


def _multiple(frequency: float, own: dict[float, int], slack: float) -> tuple[int, float]:
    """Return the mode of the tone that a frequency [Hz] is a multiple of, and the multiple; -1 and 1 if of none."""
    for tone, mode in own.items():
        halves = round(2.0 * frequency / tone)
        if 1 <= halves <= HIGHEST_MULTIPLE and abs(frequency - 0.5 * halves * tone) <= slack * max(1.0, 0.5 * halves):
            return mode, 0.5 * halves
    return -1, 1.0
