"""The tones of a limit cycle, and their modes of linear theory."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr

from ..analysis import tones
from ..arrays import Array

# Largest number of tones kept, and their lowest level relative to the strongest [dB].
MOST, FAINTEST = 8, -40.0
# Width of the bands of the spectrum, and lowest tone, relative to the resolution of the window.
BANDS, LOWEST = 4.0, 4.0
# Highest multiple of half the frequency of a tone that is recognised.
HIGHEST_MULTIPLE = 40


class Tone(NamedTuple):
    """A tone of a limit cycle.

    Attributes
    ----------
    frequency : float
        Frequency [Hz].
    level : float
        Level relative to the strongest [dB].
    mode : int
        Number of its mode, -1 for none.
    order : float
        Its frequency over that of its fundamental tone, 1 if it is not a multiple of another.
    """

    frequency: float
    level: float
    mode: int
    order: float


def tones_of(signal: xr.DataArray, exponents: Array, grows: Array, resolution: float) -> list[Tone]:
    """Return the tones of a signal, the strongest first, each with its mode.

    A tone belongs to the nearest growing mode; else it is a multiple of half of such a tone; else it belongs to the
    nearest of the other modes; each within the resolution.

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
    """Return the mode nearest to a frequency [Hz], -1 if none is within the resolution."""
    if not numbers.size:
        return -1
    number = int(numbers[np.abs(frequencies[numbers] - frequency).argmin()])
    return number if abs(frequencies[number] - frequency) <= resolution * frequencies[number] else -1


def _multiple(frequency: float, own: dict[float, int], slack: float) -> tuple[int, float]:
    """Return the mode of the tone whose multiple a frequency [Hz] is, and the factor; -1 and 1 if there is none."""
    for tone, mode in own.items():
        halves = round(2.0 * frequency / tone)
        if 1 <= halves <= HIGHEST_MULTIPLE and abs(frequency - 0.5 * halves * tone) <= slack * max(1.0, 0.5 * halves):
            return mode, 0.5 * halves
    return -1, 1.0
