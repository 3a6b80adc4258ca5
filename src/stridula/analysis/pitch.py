"""Pitch of recorded forces in bursts, as an ear would name it, and the other tones beside it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ..arrays import Array
from ..weighting import a_weighting

# Lowest frequency of a spectrum, relative to the lowest tone.
BELOW = 0.75
# Smallest number of samples in a frame.
FEWEST = 8
# Number of points in the spectrum for each point that a frame resolves: enough for a parabola to find the top of a
# peak.
FINE = 4
# A tone may be the pitch instead of the strongest one if it has at least the first share of that one's power [1]; the
# second is the share of the audible power that must repeat itself with the period of the tone [1].
NEARLY, REPEATS = 0.5, 0.3
# Longest period for which repetition is measured, in frames.
LONGEST = 0.5
# A tone may be a partial of the cycles if it is this close to a multiple of their frequency [1], and if repetition with
# its own period is at most the second value times that with the period of the cycles [1]: of the second partial, if the
# odd ones have a tenth of the audible power.
NEAR, ALONE = 0.02, 0.8
# The number of a partial is certain if the tone is this close to the multiple, in points that a frame resolves.
CERTAIN = 0.1
# Other tones are at most this far below the strongest [dB], and stand out by this much [dB].
DEEP, PROMINENT = 20.0, 6.0


@dataclass(frozen=True)
class AudibleSpectrum:
    """Power of the forces in bursts over frequency, averaged over frames without their mean.

    Attributes
    ----------
    frequency : ndarray, shape (frequencies,)
        Frequencies [Hz], from somewhat below the lowest tone on, so that its peak has both sides.
    power : ndarray, shape (frequencies,)
        Power of all forces, per point [N²].
    frame : float
        Length of the frames [s].
    lowest : float
        Lowest tone [Hz].
    """

    frequency: Array
    power: Array
    frame: float
    lowest: float

    @property
    def level(self) -> float:
        """Root mean square of the forces above the lowest tone [N]."""
        return float(np.sqrt(self.power[self.frequency >= self.lowest].sum()))

    @property
    def pitch(self) -> float:
        """Frequency that an ear would name [Hz], NaN if there is no tone.

        The strongest tone under A-weighting; of several nearly as strong, such as the partials of one sound, the tone
        with whose period most of the power repeats itself.
        """
        heard = self._weighted
        tops = self._tops(heard)
        if not tops.size:
            return float("nan")
        strong = tops[heard[tops] >= NEARLY * heard[tops].max()]
        found = np.array([self._at(int(top)) for top in strong])
        repeats = self._repetition(1.0 / found)
        return float(found[np.argmax(repeats if repeats.max() >= REPEATS else heard[strong])])

    def tones(self, most: int) -> Array:
        """Return the frequencies of the tones that stand out [Hz], the strongest first, at most `most` of them."""
        tops = self._tops(self.power)
        order = tops[np.argsort(-self.power[tops], kind="stable")]
        level = 10.0 * np.log10(np.maximum(self.power, 1e-30 * self.power.max(initial=0.0) + 1e-300))
        kept = [top for top in order if level[top] > level[order[0]] - DEEP and _stands_out(level, int(top))]
        return np.array([self._at(int(top)) for top in kept[:most]])

    def beside(self, pitch: float, most: int) -> Array:
        """Return the frequencies of tones that are neither a pitch nor a partial of it [Hz], the strongest first."""
        found = self.tones(self.power.size)
        numbers = np.maximum(np.round(found / pitch), 1.0)
        return found[np.abs(found - numbers * pitch) > np.maximum(1.0 / self.frame, NEAR * found)][:most]

    def pitch_among(self, cycle: float) -> float:
        """Return the pitch of a contact whose status recurs [Hz]: that of its cycles if the tone is a partial of these.

        Parameters
        ----------
        cycle : float
            Frequency of the cycles [Hz], NaN if none recur.
        """
        pitch = self.pitch
        if not (pitch > 0.0 and cycle > 0.0):
            return pitch
        alone, together = self._repetition(np.array([1.0 / pitch, 1.0 / cycle]))
        number = round(pitch / cycle)
        is_near = number > 1 and abs(pitch - number * cycle) <= max(0.5 / self.frame, NEAR * pitch)
        is_measured = cycle * self.frame * LONGEST >= 1.0
        if alone >= max(REPEATS, is_near * is_measured * ALONE * together):
            return pitch
        # The pitch is that of the cycles, from their loudest partial if its number is certain.
        is_certain = number > 1 and abs(pitch - number * cycle) <= CERTAIN / self.frame
        return pitch / number if is_certain else cycle

    @cached_property
    def _weighted(self) -> Array:
        gain = np.abs(a_weighting(self.frequency)) * (self.frequency >= self.lowest)
        return np.asarray(self.power * gain**2)

    def _tops(self, values: Array) -> Array:
        """Return the indices of the local maxima from the lowest tone on."""
        rises, falls = values[1:-1] > values[:-2], values[1:-1] >= values[2:]
        peaks = 1 + np.flatnonzero(rises & falls)
        # The weighting can make the first point a peak that the power itself does not have.
        edge = np.searchsorted(self.frequency, self.lowest)
        return peaks[(peaks > edge) | ((peaks == edge) & (self.power[peaks] > self.power[peaks - 1]))]

    def _repetition(self, periods: Array) -> Array:
        """Return the autocorrelation at some lags [s] over that at lag zero, without the decay of the window."""
        waves = np.cos(2.0 * np.pi * np.outer(periods, self.frequency))
        return np.asarray(waves @ self._weighted / (self._weighted.sum() * _overlap(periods / self.frame)))

    def _at(self, top: int) -> float:
        """Return the frequency of the peak of power at or above a point [Hz], by a parabola through its logarithm."""
        while 0 < top < self.power.size - 1 and self.power[top] < (beside := self.power[[top - 1, top + 1]]).max():
            top += 1 if beside[1] > beside[0] else -1
        step = self.frequency[1] - self.frequency[0]
        if not 0 < top < self.power.size - 1:
            return float(self.frequency[top])
        left, middle, right = np.log(self.power[top - 1 : top + 2] + 1e-300)
        curvature = left - 2.0 * middle + right
        return float(self.frequency[top] + (0.5 * (left - right) / curvature if curvature < 0.0 else 0.0) * step)


def audible_spectrum(forces: Array, interval: float, bursts: Array, frame: float, lowest: float) -> AudibleSpectrum:
    """Return the power of forces in bursts from the lowest tone on.

    Each burst is divided into frames that overlap by half, or is one frame if it is shorter. A frame is taken without
    its mean, under a Hann window.

    Parameters
    ----------
    forces : ndarray, shape (forces, samples)
        Recorded forces [N], whose powers are added.
    interval : float
        Interval of the samples [s].
    bursts : ndarray, shape (bursts, 2)
        Starts and ends of the bursts [samples].
    frame : float
        Length of a frame [s].
    lowest : float
        Lowest tone [Hz].
    """
    longest = max(FEWEST, round(min(frame / interval, forces.shape[1])))
    padded = 2 ** int(np.ceil(np.log2(FINE * longest)))
    first = int(BELOW * lowest * padded * interval)
    frequency = np.arange(first, padded // 2 + 1) / (padded * interval)
    power, energy, sizes = np.zeros(frequency.size), 0.0, []
    for begin, size in _frames(bursts, longest, forces.shape[1]):
        piece, window = forces[:, begin : begin + size], _window(size)
        about = piece - (piece @ window / window.sum())[:, None]
        spectra = np.fft.rfft(about * window, padded, axis=1)[:, first:]
        power += np.sum(spectra.real**2 + spectra.imag**2, axis=0)
        energy += float(window @ window)
        sizes.append(size)
    length = float(np.median(sizes)) * interval if sizes else frame
    return AudibleSpectrum(frequency, 2.0 * power / (padded * max(energy, 1e-300)), length, lowest)


def _frames(bursts: Array, longest: int, count: int) -> Iterator[tuple[int, int]]:
    """Yield first sample and number of samples of each frame."""
    for start, end in bursts:
        begin, stop = max(int(np.ceil(start - 1e-9)), 0), min(int(end + 1e-9), count)
        size = min(stop - begin, longest)
        if size < FEWEST:
            continue
        frames = 1 + int(np.ceil((stop - begin - size) / max(size // 2, 1)))
        for number in range(frames):
            yield begin + round(number * (stop - begin - size) / max(frames - 1, 1)), size


@lru_cache(maxsize=64)
def _window(size: int) -> Array:
    return np.hanning(size + 1)[:-1]


def _overlap(lag: Array) -> Array:
    """Return the overlap of a Hann window with itself over that without a lag, for lags in lengths of the window."""
    at = np.minimum(lag, LONGEST)
    turn = 2.0 * np.pi * at
    return np.asarray((1.0 - at) * (2.0 + np.cos(turn)) / 3.0 + np.sin(turn) / (2.0 * np.pi))


def _stands_out(level: Array, top: int) -> bool:
    """Return whether the level falls by `PROMINENT` on both sides of a peak before it rises above it."""
    for side in (level[top::-1], level[top:]):
        higher = np.flatnonzero(side > level[top])
        if side[: higher[0] if higher.size else None].min() > level[top] - PROMINENT and higher.size:
            return False
    return True
