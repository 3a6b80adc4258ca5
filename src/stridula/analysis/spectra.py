"""Frequencies of recorded signals."""

from __future__ import annotations

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_most, positive
from .signals import blocks, checked_intervals, pieces, samples

PERIODS = 10.0
FINEST = 2.0
# Above this sample rate a spectrum this fine does not fit into memory [Hz].
FASTEST = 1e8


def spectrum(signal: xr.DataArray, intervals: Array | None = None) -> tuple[Array, Array]:
    """Return the energy spectrum of a signal, summed over intervals of time.

    Each interval is taken without its mean, under a Hann window, padded to a common grid of 2 Hz or finer.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,)
        A recorded signal, such as ``run.normal_force``.
    intervals : ndarray, shape (intervals, 2), optional
        Starts and ends [s]; the whole signal if left out.

    Returns
    -------
    frequency : ndarray, shape (frequencies,)
        Frequencies [Hz].
    energy : ndarray, shape (frequencies,)
        Energy spectral density, in units of the signal squared times s².
    """
    values, interval = samples(signal)
    if interval * FASTEST < 1.0:
        raise ArgumentError("signal", f"be sampled at {FASTEST:g} Hz at most", signal, got=f"{1.0 / interval:.6g} Hz")
    chosen = pieces(signal, values, intervals)
    longest = max((piece.size for piece in chosen), default=0)
    size = 2 ** int(np.ceil(np.log2(max(longest, 1.0 / (FINEST * interval), 2))))
    energy = np.zeros(size // 2 + 1)
    for piece in chosen:
        window = np.hanning(piece.size + 1)[:-1]
        mean = np.sum(window * piece) / max(np.sum(window), 1e-300)
        energy += np.abs(np.fft.rfft((piece - mean) * window, size)) ** 2
    return np.fft.rfftfreq(size, interval), energy * interval**2


def dominant_frequency(signal: xr.DataArray, intervals: Array | None = None, lowest: float | None = None) -> float:
    """Return the frequency at which a signal has most energy [Hz].

    The largest local peak of `spectrum`, refined by a parabola through its logarithm.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,)
        A recorded signal.
    intervals : ndarray, shape (intervals, 2), optional
        Starts and ends [s]; the whole signal if left out.
    lowest : float, optional
        Frequencies below this are ignored [Hz]; by default ten periods in the median interval.

    Returns
    -------
    float
        NaN if there is no peak, as in a constant signal or without intervals.
    """
    frequency, energy = spectrum(signal, intervals)
    if lowest is None:
        lowest = PERIODS / _median_length(signal, intervals)
    positive("lowest", lowest)
    peaks = _peaks(energy)
    peaks = peaks[frequency[peaks] >= lowest]
    if peaks.size == 0:
        return float("nan")
    top = peaks[np.argmax(energy[peaks])]
    return _refined(frequency, energy, int(top))


def tones(
    signal: xr.DataArray, intervals: Array | None = None, resolution: float = 20.0, prominence: float = 6.0
) -> tuple[Array, Array]:
    """Return the tones that stand out of the spectrum of a signal, the strongest first.

    The energy spectrum is averaged over bands of `resolution`; a tone is a local maximum whose prominence is at least
    `prominence`, and has the frequency of the strongest line of its band.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,)
        A signal, such as a sound pressure or a recorded force.
    intervals : ndarray, shape (intervals, 2), optional
        Starts and ends [s]; the whole signal if left out.
    resolution : float, optional
        Width of the bands [Hz].
    prominence : float, optional
        Smallest prominence of a tone [dB].

    Returns
    -------
    frequency : ndarray, shape (tones,)
        Frequencies [Hz].
    level : ndarray, shape (tones,)
        Levels relative to the strongest [dB].
    """
    # Slow to import and seldom needed.
    from scipy.signal import find_peaks

    positive("prominence", prominence)
    frequency, energy = spectrum(signal, intervals)
    if positive("resolution", resolution) > frequency[-1]:
        raise ArgumentError("resolution", f"be at most {at_most(float(frequency[-1]))} Hz", resolution)
    width = max(1, round(resolution / frequency[1]))
    smooth = np.convolve(energy, np.full(width, 1.0 / width), "same")
    level = 10.0 * np.log10(smooth / max(float(smooth.max()), 1e-300) + 1e-30)
    peaks, _ = find_peaks(level, prominence=prominence)
    order = peaks[np.argsort(-level[peaks], kind="stable")]
    return np.array([_line(frequency, energy, frequency[one], resolution) for one in order]), level[order]


def _line(frequency: Array, energy: Array, about: float, width: float) -> float:
    """Return the frequency of the strongest line in a band [Hz]."""
    first, end = np.searchsorted(frequency, (about - 0.5 * width, about + 0.5 * width))
    return _refined(frequency, energy, int(first + np.argmax(energy[first : max(end, first + 1)])))


def _refined(frequency: Array, energy: Array, top: int) -> float:
    """Return the frequency of a local maximum [Hz], that of the parabola through its logarithm."""
    if not 0 < top < energy.size - 1:
        return float(frequency[top])
    left, middle, right = np.log(energy[top - 1 : top + 2] + 1e-300)
    curvature = left - 2.0 * middle + right
    shift = 0.5 * (left - right) / curvature if curvature < 0.0 else 0.0
    return float(frequency[top] + np.clip(shift, -1.0, 1.0) * frequency[1])


def frequency_resolution(signal: xr.DataArray, intervals: Array | None = None) -> float:
    """Return the frequency resolution of the median interval, the inverse of its length [Hz]."""
    return 1.0 / _median_length(signal, intervals)


def envelope(signal: xr.DataArray, window: float = 5e-3) -> Array:
    """Return the root mean square of a signal less its mean over successive windows of `window` s, shape (windows,)."""
    values, interval = samples(signal)
    windows = blocks(values - values.mean(), positive("window", window), interval)
    return np.sqrt(np.mean(windows**2, axis=1))


def envelope_correlation(first: xr.DataArray, second: xr.DataArray, window: float = 5e-3) -> float:
    """Return the correlation coefficient [1] of the envelopes of two signals on one time axis, NaN for a steady one."""
    one, other = envelope(first, window), envelope(second, window)
    if one.shape != other.shape:
        raise ArgumentError("second", f"have as many windows as first, {one.size}", second, got=other.size)
    if one.size < 2 or not np.ptp(one) > 0.0 or not np.ptp(other) > 0.0:
        return float("nan")
    return float(np.corrcoef(one, other)[0, 1])


def _peaks(values: Array) -> Array:
    """Return the indices of the local maxima, the middle of flat ones; the ends do not count."""
    edges = np.flatnonzero(np.diff(values, prepend=np.nan))
    level = values[edges]
    top = 1 + np.flatnonzero((level[1:-1] > level[:-2]) & (level[1:-1] > level[2:]))
    return (edges[top] + edges[top + 1] - 1) // 2


def _median_length(signal: xr.DataArray, intervals: Array | None) -> float:
    if intervals is None:
        values, interval = samples(signal)
        return values.size * interval
    lengths = np.diff(checked_intervals(intervals), axis=1)
    return float(np.median(lengths)) if lengths.size else 1.0
