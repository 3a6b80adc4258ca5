"""Squeal events of sounds, after the definition of SAE J2521."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import scipy  # its parts are imported on first use
import xarray as xr

from ..arrays import Array
from ..checks import ArgumentError, at_most, finite, instance, positive, within
from ..weighting import a_weighting
from .levels import REFERENCE
from .pressures import channels, check_length, is_enough

# SAE J2521: peak level from which a tone is a squeal [dB(A)], and the band [Hz] for whole suspension corners; for
# others it begins at 2 kHz.
THRESHOLD, LOWEST, HIGHEST = 70.0, 1250.0, 16000.0
# Length of a frame [s] and smallest prominence of a tone [dB].
FRAME, PROMINENCE = 0.05, 10.0
# Frames in the length of one, and fewest of an event: a peak of noise is in fewer.
OVERLAP, FEWEST = 4, 3
# Bins beside the peak of a tone that hold all but 0.003 dB of its power under a Hann window, and their mean square over
# that of the window [1].
LOBE, NOISE_BANDWIDTH = 2, 1.5
# Ratio of frequencies of the edges of the neighbourhood of a tone to the tone.
NEAR = 10.0**0.05
# Largest difference of frequencies of one event between frames, in bins and relative to the frequency.
STRAY, GLIDE = 1.5, 0.01
# Frames searched at once.
BLOCK = 2048


class _Event(NamedTuple):
    """An event: frames, frequencies [Hz] and levels [dB] of its tone."""

    frames: list[int]
    frequencies: list[float]
    levels: list[float]


def squeal_events(
    sound: xr.DataArray | Sequence[xr.DataArray] | Mapping[str, xr.DataArray],
    stops: Any = None,
    *,
    threshold: float = THRESHOLD,
    lowest: float = LOWEST,
    highest: float = HIGHEST,
    frame: float = FRAME,
    prominence: float = PROMINENCE,
) -> xr.Dataset:
    """Return the squeal events of sounds.

    A squeal is a tone with an A-weighted level of 70 dB or more between 1.25 kHz (2 kHz without a suspension) and
    16 kHz, as SAE J2521 defines it. Tones are sought in frames under a Hann window that overlap by three quarters:
    local maxima of the spectrum that stand out from what is between them and from the median of the third octave about
    them. The level of a tone is that of its peak with two bins on each side. A tone that lasts over three successive
    frames or more is one event.

    Parameters
    ----------
    sound : xarray.DataArray, or sequence or mapping of them
        Sound pressure [Pa], recorded or computed, of shape (time,) or (time, listener). Several are one for each stop.
    stops : array_like, shape (stops, 2), optional
        Starts and ends [s] of the stops in one sound, which may overlap; if left out, the whole sound is one stop.
    threshold : float, optional
        Lowest level of a squeal [dB(A)].
    lowest, highest : float, optional
        Band of frequencies [Hz].
    frame : float, optional
        Length of the frames [s]; their spectra have a spacing of one over it, and ends of events are known to half of
        it.
    prominence : float, optional
        Smallest prominence of a tone, and smallest level above the median of its third octave [dB].

    Returns
    -------
    xarray.Dataset
        Over ``event``: ``event_stop``, ``event_listener``, ``start`` and ``end`` [s], ``duration`` [s], ``frequency``
        [Hz] and ``level`` [dB(A)] at the loudest frame. Over ``stop``: ``events``, ``squeals``, ``peak_level`` [dB(A)],
        the highest of any tone in the band (minus infinity without one), and ``peak_frequency`` [Hz]. ``occurrence``
        [1] is the share of stops that squeal.

    Raises
    ------
    ValueError
        If a sound is not in pascals, is shorter than a frame, or is sampled at less than twice `highest`.
    """
    settings = _checked(threshold, lowest, highest, frame, prominence)
    rows: list[tuple[Any, ...]] = []
    peaks: list[tuple[float, float]] = []
    names, parts = _parts(sound, stops)
    for number, (one, span) in enumerate(parts):
        found, peak = _of_stop(one, span, settings)
        rows += [(names[number], *row) for row in found]
        peaks.append(peak)
    return _table(names, rows, peaks, settings)


def _checked(threshold: float, lowest: float, highest: float, frame: float, prominence: float) -> dict[str, float]:
    finite("threshold", threshold)
    positive("lowest", lowest)
    if positive("highest", highest) <= lowest:
        raise ArgumentError("highest", f"be above the lowest frequency, {lowest!r} Hz", highest)
    if positive("frame", frame) * lowest < 4.0 * LOBE:
        raise ArgumentError("frame", f"last at least {4 * LOBE} periods of {lowest!r} Hz", frame)
    within("prominence", prominence, 0.0, 200.0, ends=False)
    return {
        "threshold": threshold,
        "lowest": lowest,
        "highest": highest,
        "frame": frame,
        "prominence": prominence,
    }


def _parts(sound: Any, stops: Any) -> tuple[list[Any], list[tuple[xr.DataArray, tuple[float, float] | None]]]:
    """Return the labels of the stops, and for each its sound and its span in it."""
    if isinstance(sound, xr.DataArray):
        if stops is None:
            return [0], [(sound, None)]
        try:
            spans = np.asarray(stops, dtype=float)
        except (TypeError, ValueError):
            spans = np.empty(0)
        if spans.ndim != 2 or spans.shape[1:] != (2,) or not len(spans) or not np.isfinite(spans).all():
            raise ArgumentError("stops", "be pairs of start and end in s", stops)
        if (spans[:, 1] <= spans[:, 0]).any():
            raise ArgumentError("stops", "end after they start", stops)
        return list(range(len(spans))), [(sound, (start, end)) for start, end in spans.tolist()]
    if stops is not None:
        raise ArgumentError("stops", "be left out with a sound for each stop", stops)
    if isinstance(sound, Mapping):
        names: list[Any] = [str(name) for name in sound]
        sounds = list(sound.values())
    elif isinstance(sound, Sequence) and not isinstance(sound, (str, bytes)):
        sounds = list(sound)
        names = list(range(len(sounds)))
    else:
        instance("sound", sound, xr.DataArray)
    if not sounds:
        raise ArgumentError("sound", "have a stop", got="none")
    return names, [(one, None) for one in sounds]


def _of_stop(
    sound: Any, span: tuple[float, float] | None, settings: dict[str, float]
) -> tuple[list[tuple[Any, ...]], tuple[float, float]]:
    """Return listener, start, end, frequency and level of each event of a stop, and its highest level and frequency."""
    instance("sound", sound, xr.DataArray)
    if span is not None and "time" in sound.coords and sound["time"].dims == ("time",):
        time = sound["time"].values
        if span[0] < time[0] - 1e-9 or span[1] > time[-1] + 1.5 * (time[-1] - time[0]) / max(time.size - 1, 1):
            got = f"{span[0]:g} to {span[1]:g} s in {time[0]:g} to {time[-1]:g} s"
            raise ArgumentError("stops", "lie in the sound", got=got)
        sound = sound.isel(time=(time >= span[0]) & (time < span[1]))
    values, rate = channels(sound)
    check_length(sound, settings["frame"], "a frame of squeal")
    _check_band(rate, sound, settings)
    begin = float(sound["time"].values[0])
    rows, peak = [], (-np.inf, np.nan)
    has_names = sound.ndim == 2 and "listener" in sound.coords
    labels: list[Any] = sound["listener"].values.tolist() if has_names else list(range(values.shape[1]))
    for column, label in zip(values.T, labels, strict=True):
        tones, size, hop = _tones(column, rate, settings)
        lasting = _lasting(tones, 1.0 / settings["frame"])
        tops = [pair for one in lasting for pair in zip(one.levels, one.frequencies, strict=True)]
        peak = max(peak, *tops, key=lambda pair: pair[0]) if tops else peak
        events = [event for one in lasting for event in _loud(one, settings["threshold"])]
        for event in sorted(events, key=lambda event: (event.frames[0], event.frequencies[0])):
            middle = begin + (0.5 * (size - 1) + hop * np.array(event.frames)) / rate
            start, end = _ends(event, middle, hop / rate, settings["threshold"])
            top = int(np.argmax(event.levels))
            rows.append((label, start, end, event.frequencies[top], event.levels[top]))
    return rows, peak


def _check_band(rate: float, sound: xr.DataArray, settings: dict[str, float]) -> None:
    """Raise ValueError if a sound does not reach the highest frequency."""
    highest = settings["highest"]
    reach = min(0.5 * rate - (LOBE + 1) / settings["frame"], float(sound.attrs.get("bandwidth", np.inf)))
    if not is_enough(reach, highest):
        raise ArgumentError(
            "highest", f"be at most {at_most(reach)} Hz, up to which the sound is known", highest, got=f"{highest!r} Hz"
        )


def _tones(values: Array, rate: float, settings: dict[str, float]) -> tuple[list[list[tuple[float, float]]], int, int]:
    """Return the tones in the band of each frame, as frequencies [Hz] and levels [dB(A)], and the samples of frame and
    hop.
    """
    size = round(settings["frame"] * rate)
    hop = max(size // OVERLAP, 1)
    window = np.hanning(size + 1)[:-1]
    frequency = np.arange(size // 2 + 1) * rate / size
    # Mean squares of both sides of the spectrum, A-weighted.
    scale = 2.0 * np.abs(a_weighting(frequency)) ** 2 / (np.sum(window) ** 2 * NOISE_BANDWIDTH)
    begins = np.arange(0, values.size - size + 1, hop)
    tones: list[list[tuple[float, float]]] = []
    for block in range(0, begins.size, BLOCK // 4):
        pieces = values[begins[block : block + BLOCK // 4, None] + np.arange(size)]
        power = np.abs(np.fft.rfft((pieces - pieces.mean(axis=1, keepdims=True)) * window, axis=1)) ** 2 * scale
        tones += [_tones_of(one, frequency, settings) for one in power]
    return tones, size, hop


def _tones_of(power: Array, frequency: Array, settings: dict[str, float]) -> list[tuple[float, float]]:
    """Return frequencies [Hz] and levels [dB(A)] of the tones of a frame."""
    step, margin = frequency[1], 10.0 ** (settings["prominence"] / 10.0)
    lobes = np.convolve(power, np.ones(2 * LOBE + 1), "same")
    if not lobes.max() > 0.0:
        return []
    levels = 10.0 * np.log10(np.maximum(lobes, 1e-20 * lobes.max()) / REFERENCE**2)
    tops, _ = scipy.signal.find_peaks(levels, prominence=settings["prominence"])
    found = []
    for k in tops[(tops > 2 * LOBE) & (tops < power.size - LOBE - 1)]:
        peak = int(k) - LOBE + int(np.argmax(power[k - LOBE : k + LOBE + 1]))
        at = frequency[peak] + step * _offset(power, peak)
        if not settings["lowest"] * (1.0 - 1e-9) <= at <= settings["highest"] * (1.0 + 1e-9):
            continue
        first, last = np.searchsorted(frequency, (at / NEAR, at * NEAR))
        about = lobes[min(first, peak - 3 * LOBE) : max(last, peak + 3 * LOBE + 1)]
        if lobes[peak] >= float(np.median(about)) * margin:
            found.append((float(at), float(levels[peak])))
    return found


def _offset(power: Array, k: int) -> float:
    """Return the distance of a tone from the peak of its spectrum [bins], exact for a steady one."""
    side = 1 if power[k + 1] > power[k - 1] else -1
    ratio = float(np.sqrt(power[k + side] / power[k]))
    return side * (2.0 * ratio - 1.0) / (1.0 + ratio)


def _lasting(tones: list[list[tuple[float, float]]], step: float) -> list[_Event]:
    """Return the tones of nearly the same frequency in at least `FEWEST` successive frames."""
    done: list[_Event] = []
    open_ones: list[_Event] = []
    for number, one in enumerate(tones):
        going: list[_Event] = []
        for frequency, level in sorted(one, key=lambda tone: -tone[1]):
            near = max(STRAY * step, GLIDE * frequency)
            last = [event for event in open_ones if abs(event.frequencies[-1] - frequency) <= near]
            event = _Event([], [], [])
            if last:
                event = min(last, key=lambda event: abs(event.frequencies[-1] - frequency))
                open_ones.remove(event)
            event.frames.append(number)
            event.frequencies.append(frequency)
            event.levels.append(level)
            going.append(event)
        done += open_ones
        open_ones = going
    return [event for event in done + open_ones if len(event.frames) >= min(FEWEST, len(tones))]


def _loud(tone: _Event, threshold: float) -> list[_Event]:
    """Return the parts of a tone at the threshold or above."""
    loud = np.concatenate([[False], np.array(tone.levels) >= threshold, [False]])
    edges = np.flatnonzero(np.diff(loud)).reshape(-1, 2).tolist()
    return [_Event(tone.frames[a:b], tone.frequencies[a:b], tone.levels[a:b]) for a, b in edges]


def _ends(event: _Event, middle: Array, hop: float, threshold: float) -> tuple[float, float]:
    """Return start and end of an event [s].

    A frame whose middle is at the start of a lasting tone has half of its amplitude. So the ends are where the level is
    6 dB below that of the tone next to it, or at the threshold if that is higher.
    """
    levels = np.array(event.levels)
    reach = OVERLAP
    first = max(threshold, float(levels[: reach + 1].max()) - 20.0 * np.log10(2.0))
    last = max(threshold, float(levels[-reach - 1 :].max()) - 20.0 * np.log10(2.0))
    starts, ends = np.flatnonzero(levels >= first), np.flatnonzero(levels >= last)
    return float(middle[starts[0]] - 0.5 * hop), float(middle[ends[-1]] + 0.5 * hop)


def _table(
    names: list[Any], rows: list[tuple[Any, ...]], peaks: list[tuple[float, float]], settings: dict[str, float]
) -> xr.Dataset:
    columns = list(zip(*rows, strict=True)) if rows else [()] * 6
    counts = [sum(1 for row in rows if row[0] == name) for name in names]
    level = {"units": "dB(A)", "long_name": "A-weighted level of the tone re 20 µPa"}
    hertz, second = {"units": "Hz"}, {"units": "s"}
    start, end = np.array(columns[2], dtype=float), np.array(columns[3], dtype=float)
    squeals = np.array(counts) > 0
    return xr.Dataset(
        {
            "event_stop": ("event", np.array(columns[0]), {"long_name": "stop of the event"}),
            "event_listener": ("event", np.array(columns[1]), {"long_name": "listener of the event"}),
            "start": ("event", start, second),
            "end": ("event", end, second),
            "duration": ("event", end - start, second | {"long_name": "duration of the squeal"}),
            "frequency": ("event", np.array(columns[4], dtype=float), hertz | {"long_name": "frequency of the squeal"}),
            "level": ("event", np.array(columns[5], dtype=float), level),
            "events": ("stop", np.array(counts), {"long_name": "number of events"}),
            "squeals": ("stop", squeals, {"long_name": "whether the stop squeals"}),
            "peak_level": ("stop", np.array([one[0] for one in peaks]), level),
            "peak_frequency": ("stop", np.array([one[1] for one in peaks]), hertz),
            "occurrence": ((), float(squeals.mean()), {"units": "1", "long_name": "share of stops that squeal"}),
        },
        {"stop": names},
        {"definition": "after SAE J2521", **settings},
    )


def squeal_words(events: xr.Dataset) -> str:
    """Return in words whether a sound squeals, at which level and frequency.

    Parameters
    ----------
    events : xarray.Dataset
        Result of `squeal_events` for one stop.
    """
    limit, low, high = (events.attrs[name] for name in ("threshold", "lowest", "highest"))
    rule = f"a squeal has {limit:g} dB(A) or more from {low / 1e3:g} to {high / 1e3:g} kHz"
    levels, frequencies = events["peak_level"].values, events["peak_frequency"].values
    peak, frequency = float(levels.max()), float(frequencies[levels.argmax()])
    if not np.isfinite(peak):
        return f"no: no tone lasts; {rule}"
    word = "yes" if bool(events["squeals"].any()) else "no"
    return f"{word}: the loudest tone has {peak:.1f} dB(A) at {frequency:.4g} Hz; {rule}"
