"""Regime and bursts from a vibration alone, without the status of a contact."""

from __future__ import annotations

import math

import numpy as np
import scipy  # its parts are imported on first use
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_most, positive, within
from .heard import Frames, frames
from .phases import moving_mean
from .pitch import audible_spectrum
from .regime_measures import Thresholds
from .regimes import JUDDERS, KEPT, SLIPS, SQUEALS, TRANSIENT, above, odds_above
from .signals import samples

QUIET = "quiet"
# Highest confidence in a regime whose contact a vibration does not show, and what it does not show.
UNSEEN = 0.75
UNKNOWN = {
    QUIET: "whether the contact slides, sticks or is separated",
    SQUEALS: "whether the contact sticks, slides or separates within a cycle, and how the force compares with its mean",
    SLIPS: "whether the contact sticks in each cycle, as it would here, or separates",
    JUDDERS: "whether the contact separates, as it would here, or sticks and slips at random",
}
NOISE = "; without a floor, whether it is more than the noise of steady sliding or of the sensor"
# Similarity of a vibration to itself one cycle later, from which it recurs [1], and longest cycle over its length [1].
RECURS, LONGEST = 0.5, 0.4
# Share of a tone that does not repeat itself from which it may be a harmonic of slow cycles [1], and how many times
# more that is than one cycle later.
IMPURE, MORE_EXACT = 0.1, 4.0
# Relative difference of the frequency of an envelope from twice that of its vibration, up to which it is just this.
TWICE = 0.02
# Length of the windows of an envelope [s], and ratios of the level of bursts to the threshold and to that between them.
SMOOTHING, HALF, CLEAR = 5e-3, 2.0, 10.0
SHORTEST_STOP = 20e-3
# A vibration that dies away is strongest in this share of the time at the beginning [1]. If it was sustained before,
# for longer than some windows, the times in which it falls by half and to a tenth, or to twice what is left, are at
# least in this ratio, relative to that of free vibration.
BEGINNING, TENTH, SUSTAINED, WINDOWS = 0.2, 0.1, 1.8, 4.0
# Cycles in the windows of the envelope of slow cycles.
CYCLES = 2.0
# Percentiles of the envelope that stand for bursts and for stops.
LOUD, SILENT = 90.0, 10.0
MEANINGS = {
    "confidence": "confidence in the regime, 0.5 at a threshold",
    "tonality": "share of the audible power that repeats itself",
    "audibility": "audible part over the whole vibration",
    "growth": "audible part of the later half of the time over that of the earlier half",
    "recurrence": "similarity to itself, or of its envelope, one cycle slower than the lowest tone later",
}


def vibration_regime(
    signal: xr.DataArray,
    *,
    start: float | None = None,
    floor: float | None = None,
    tonal: float = Thresholds.tonal,
    faint: float = Thresholds.faint,
    lowest_tone: float = Thresholds.lowest_tone,
    frame: float = Thresholds.frame,
    rate: float = Thresholds.rate,
) -> xr.Dataset:
    """Return the regime that a vibration alone suggests.

    A vibration that dies away from the beginning on, as bodies ring after a stroke, or is no stronger than the `floor`,
    is quiet; one that is sustained for a while at the beginning is not. Else it is squeal if its part above the lowest
    tone is tonal; stick-slip if it recurs in cycles slower than that; and judder if it does neither. Without the status
    of the contact the last two are not told apart for certain: their confidence is at most 0.75, and that of judder
    without a `floor` 0.5, as steady sliding makes noise, too. That of squeal is at most 0.75 if its tone may be a
    harmonic of slow cycles, which an acceleration lifts above them.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,)
        An acceleration, a velocity, a displacement, a force or a sound pressure.
    start : float, optional
        Time at the beginning that is ignored [s]; a tenth of the signal if left out.
    floor : float, optional
        Root mean square of the signal at rest, in its units.
    tonal : float, optional
        Share of the power above the lowest tone, from which a tone is squeal [1], as for `regime`.
    faint : float, optional
        Share of the vibration above the lowest tone, below which its tone does not count [1].
    lowest_tone, frame, rate : float, optional
        Lowest frequency of a tone [Hz], length of frames [s] and sample rate of their means [Hz], as for `regime`.

    Returns
    -------
    xarray.Dataset
        Scalars: ``regime`` (``quiet``, ``stick-slip``, ``squeal`` or ``judder``), ``confidence``, ``level`` in units of
        the signal, ``frequency`` [Hz], ``tonality``, ``audibility``, ``growth`` and ``recurrence`` [1]. The attribute
        ``unknown`` says what the vibration does not show.

    Raises
    ------
    ValueError
        If the signal is too short, is sampled at less than four times the lowest tone, or an argument is out of range.
    """
    limits = Thresholds(tonal=tonal, faint=faint, lowest_tone=lowest_tone, frame=frame, rate=rate)
    values, interval = samples(signal)
    if interval * 2.0 * lowest_tone > 1.0 + 1e-9:
        got = f"{1.0 / interval:.6g} Hz"
        raise ArgumentError("signal", f"be sampled at {2.0 * lowest_tone:g} Hz or more", signal, got=got)
    length = values.size * interval
    first = TRANSIENT * length if start is None else within("start", start, 0.0, length)
    kept = values[min(round(first / interval), values.size - 1) :]
    if not np.isfinite(kept).all() or kept.size * interval < 2.0 * frame:
        got = "values that are not finite" if not np.isfinite(kept).all() else f"{at_most(kept.size * interval, 3)} s"
        raise ArgumentError("signal", f"last at least {2.0 * frame:g} s and be finite", signal, got=got)
    still = 0.0 if floor is None else positive("floor", floor)
    about = kept - kept.mean()
    level = float(np.sqrt(np.mean(about**2)))
    heard = _audible(about, interval, limits)
    recurrence, cycle = _recurrence(about, interval, lowest_tone)
    lasts = _lasting(about, interval, heard, lowest_tone)
    name, margin = _decided(level, still, heard, lasts, recurrence, limits)
    if name == SLIPS:
        turning = _lasting_cycles(about, interval, cycle)
        name, margin = (SLIPS, min(margin, turning)) if turning >= 0.0 else (QUIET, -turning)
    spectrum = audible_spectrum(about[None], interval, np.array([[0, about.size]]), frame, lowest_tone)
    frequency = {SQUEALS: spectrum.pitch, SLIPS: cycle}.get(name, math.nan)
    is_noise, buzzes = name == JUDDERS and floor is None, name == SQUEALS and _buzzes(heard.tonality, recurrence)
    most = 0.5 if is_noise else UNSEEN if name in (SLIPS, JUDDERS) or buzzes else 1.0
    harmonic = f"; whether the tone is a harmonic of cycles at {cycle:.4g} Hz, which repeat themselves more exactly"
    unknown = UNKNOWN[name] + (NOISE if is_noise else harmonic if buzzes else "")
    numbers = {
        "confidence": min(0.5 + 0.5 * min(1.0, margin), most),
        "tonality": heard.tonality,
        "audibility": heard.level / level if level > 0.0 else 0.0,
        "growth": heard.growth,
        "recurrence": recurrence,
    }
    measures = {word: ((), numbers[word], {"units": "1", "long_name": MEANINGS[word]}) for word in MEANINGS}
    size = ((), level, {"units": str(signal.attrs.get("units", "1")), "long_name": "root mean square less its mean"})
    pitch = ((), frequency, {"units": "Hz", "long_name": "pitch of the tone, or frequency of the cycles"})
    words = {"units": "1", "long_name": "regime that the vibration suggests"}
    return xr.Dataset(
        {"regime": ((), name, words), **measures, "level": size, "frequency": pitch}, attrs={"unknown": unknown}
    )


def vibration_bursts(
    signal: xr.DataArray,
    *,
    shortest_stop: float = SHORTEST_STOP,
    smoothing: float = SMOOTHING,
    lowest_tone: float = Thresholds.lowest_tone,
) -> Array:
    """Return the bursts of a vibration between quiet times, shape (bursts, 2) [s].

    The envelope is the root mean square above the lowest tone over a centred window; bursts lie above half of its 90th
    percentile. Bodies that ring end a burst later than the contact does: the time in which their vibration falls by
    half is not known from the vibration alone.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,)
        A vibration.
    shortest_stop : float, optional
        Shorter quiet times do not end a burst [s].
    smoothing : float, optional
        Length of the window [s].
    lowest_tone : float, optional
        Lowest frequency that counts [Hz].

    Returns
    -------
    ndarray, shape (bursts, 2)
        Starts and ends of bursts that begin and end within the signal; none if the 90th percentile of the envelope is
        less than ten times the 10th.
    """
    positive("shortest_stop", shortest_stop)
    positive("smoothing", smoothing)
    positive("lowest_tone", lowest_tone)
    values, interval = samples(signal)
    if interval * 2.0 * lowest_tone > 1.0 + 1e-9:
        got = f"{1.0 / interval:.6g} Hz"
        raise ArgumentError("signal", f"be sampled at {2.0 * lowest_tone:g} Hz or more", signal, got=got)
    if not np.isfinite(values).all():
        raise ArgumentError("signal", "be finite", signal, got="values that are not")
    if values.size * interval < 2.0 * smoothing:
        raise ArgumentError("smoothing", f"be at most {at_most(0.5 * values.size * interval)} s", smoothing)
    level = _envelope(values, interval, smoothing, lowest_tone)
    loud, silent = np.percentile(level, (LOUD, SILENT))
    if not loud > CLEAR * silent:
        return np.empty((0, 2))
    edges = np.flatnonzero(np.diff(np.concatenate([[False], level > loud / HALF, [False]]))).reshape(-1, 2)
    spans: list[list[int]] = []
    for begin, end in edges.tolist():
        if spans and (begin - spans[-1][1]) * interval < shortest_stop:
            spans[-1][1] = end
        else:
            spans.append([begin, end])
    inside = [span for span in spans if span[0] > 0 and span[1] < values.size]
    return np.asarray(float(signal["time"].values[0]) + interval * np.array(inside, dtype=float).reshape(-1, 2))


def _envelope(values: Array, interval: float, smoothing: float, lowest_tone: float) -> Array:
    """Return the root mean square of a vibration above the lowest tone over a centred window."""
    filtered = scipy.signal.butter(4, lowest_tone, "highpass", fs=1.0 / interval, output="sos")
    above_tone = scipy.signal.sosfiltfilt(filtered, values - values.mean())
    return _moving_size(above_tone, interval, smoothing)


def _moving_size(values: Array, interval: float, window: float) -> Array:
    """Return the root mean square over a centred window [s]."""
    width = max(1, 2 * round(window / interval / 2.0) + 1)
    return np.sqrt(np.maximum(moving_mean(values**2, width), 0.0))


def _lasting(values: Array, interval: float, heard: Frames, lowest_tone: float) -> float:
    """Return the margin by which a vibration does not die away from the beginning on, in factors of two."""
    if not heard.amplitude.size or not math.isfinite(heard.growth):
        return math.inf
    if np.argmax(heard.amplitude) >= BEGINNING * heard.amplitude.size:
        return math.inf
    level = _envelope(values, interval, SMOOTHING, lowest_tone)
    return max(above(heard.growth, KEPT), _sustained(level, interval, SMOOTHING))


def _lasting_cycles(values: Array, interval: float, frequency: float) -> float:
    """Return the margin by which slow cycles do not die away from the beginning on, in factors of two."""
    if not frequency > 0.0:
        return math.inf
    smoothing = CYCLES / frequency
    level = _moving_size(values, interval, smoothing)
    if np.argmax(level) >= BEGINNING * level.size:
        return math.inf
    half = values.size // 2
    growth = math.sqrt(float(np.mean(values[half:] ** 2)) / float(np.mean(values[:half] ** 2)))
    return max(above(growth, KEPT), _sustained(level, interval, smoothing))


def _sustained(level: Array, interval: float, smoothing: float) -> float:
    """Return the margin by which an envelope falls late and fast, not as a free vibration, in factors of two.

    A free vibration takes the times ``ln 2`` to ``ln 10`` to fall by half and to a tenth.
    """
    top = float(level.max())
    lowest = max(TENTH, 2.0 * float(np.median(level[level.size // 2 :])) / top)
    loud, heard = (np.flatnonzero(level >= share * top) for share in (0.5, lowest))
    if lowest >= 0.5 or loud.size * interval <= WINDOWS * smoothing:
        return -math.inf
    # Of two modes that beat the last times tell, of strokes that follow each other the total ones.
    share = min((loud[-1] - loud[0]) / (heard[-1] - loud[0]), loud.size / heard.size)
    return math.log2(share * math.log(1.0 / lowest) / math.log(2.0) / SUSTAINED)


def _audible(values: Array, interval: float, limits: Thresholds) -> Frames:
    """Return the part of a vibration above the lowest tone, averaged to about the rate over whole samples."""
    ratio = max(1, int(min(1.0 / (limits.rate * interval), values.size) * (1.0 + 1e-9)))
    means = values[: values.size // ratio * ratio].reshape(-1, ratio).mean(axis=1)
    return frames(means[None], ratio * interval, limits.frame, limits.lowest_tone)


def _recurrence(values: Array, interval: float, lowest_tone: float) -> tuple[float, float]:
    """Return the recurrence of a vibration or of its envelope, whichever is larger, and its frequency [Hz].

    The envelope shows cycles whose vibration starts anew each time; that of one that recurs itself has twice its
    frequency.
    """
    size = _moving_size(values, interval, 0.25 / lowest_tone)
    own, found = _cycle(values, interval, lowest_tone), _cycle(size - size.mean(), interval, lowest_tone)
    is_twice = own[0] >= RECURS and abs(found[1] / own[1] - 2.0) < TWICE
    return own if is_twice else max(own, found, key=lambda pair: pair[0])


def _buzzes(tonality: float, recurrence: float) -> bool:
    """Return whether a vibration is far more similar to itself one slow cycle later than one period of its tone."""
    return 1.0 - tonality > max(IMPURE, MORE_EXACT * (1.0 - recurrence))


def _cycle(values: Array, interval: float, lowest_tone: float) -> tuple[float, float]:
    """Return the similarity of a vibration to itself one cycle later, and the frequency of these cycles [Hz].

    Cycles are slower than the lowest tone and repeat themselves at least twice; the similarity is the largest
    autocorrelation beyond the first negative one.
    """
    size = scipy.fft.next_fast_len(2 * values.size, real=True)
    power = np.abs(scipy.fft.rfft(values, size)) ** 2
    lags = int(LONGEST * values.size)
    correlation = scipy.fft.irfft(power, size)[:lags] / (values.size - np.arange(lags))
    if not correlation[0] > 0.0 or not (correlation < 0.0).any():
        return 0.0, math.nan
    first = max(int(np.argmax(correlation < 0.0)), math.ceil(1.0 / (lowest_tone * interval)))
    if first >= lags - 1:
        return 0.0, math.nan
    at = first + int(np.argmax(correlation[first:]))
    highest = float(correlation[at] / correlation[0])
    # The first lag that is nearly as similar is the cycle, not a multiple of it.
    tops, _ = scipy.signal.find_peaks(correlation[first:], height=0.9 * max(highest, 0.0) * correlation[0])
    at = first + int(tops[0]) if tops.size else at
    return min(max(highest, 0.0), 1.0), 1.0 / (at * interval)


def _decided(
    level: float, floor: float, heard: Frames, lasting: float, recurrence: float, limits: Thresholds
) -> tuple[str, float]:
    """Return the regime and its margin, in factors of two from the nearest threshold."""
    loud = above(level, 2.0 * floor) if floor > 0.0 else (math.inf if level > 0.0 else -math.inf)
    lasts = min(loud, lasting)
    if lasts < 0.0:
        return QUIET, -lasts
    audible = above(heard.level / level, limits.faint)
    squeals = min(audible, odds_above(heard.tonality, limits.tonal))
    if squeals >= 0.0:
        return SQUEALS, min(lasts, squeals)
    recurs = odds_above(recurrence, RECURS)
    return (SLIPS, min(lasts, -squeals, recurs)) if recurs >= 0.0 else (JUDDERS, min(lasts, -squeals, -recurs))
