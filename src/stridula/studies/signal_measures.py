"""Measures by which a computed vibration is compared with a recorded one, and how well a recording gives them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import scipy  # its parts are imported on first use
import xarray as xr

from ..analysis.regimes import TRANSIENT
from ..analysis.signals import samples
from ..analysis.spectra import dominant_frequency
from ..arrays import Array
from ..checks import ArgumentError, by_key, count, instance, listed, positive
from .calibration import Target

Signal = str | Callable[[xr.Dataset], xr.DataArray]
OfSignal = Callable[[xr.DataArray], float]
# Units that neither a file nor a function states.
UNKNOWN = "unknown"
# Centres of bands that are compared: a third of an octave apart, those at most this level below the strongest [dB].
THIRD, BELOW = 2.0 ** (1.0 / 3.0), 20.0
# Harmonics that are compared, the share of the power that makes a tone with them [1], half of the width of their bands
# over the frequency of the first, the power of those that count over that of the noise about them, and over the first.
HARMONICS, TONAL, HALF, CLEAR, FAINT = 6, 0.8, 0.25, 4.0, 1e-6
# Fewest cycles of a tone in a part of a recording.
CYCLES = 4.0
# Fewest frequencies below a third of an octave in which noise is measured.
FEWEST = 40
# Least standard deviations, as no chain of sensors is known better: of a frequency [1], of a level [dB].
LEAST_FREQUENCY, LEAST_LEVEL = 1e-3, 0.1


def frequency(signal: xr.DataArray) -> float:
    """Return the frequency at which a signal has most energy, above that of some cycles in its length [Hz]."""
    values, interval = samples(signal)
    return dominant_frequency(signal, lowest=CYCLES / (values.size * interval))


def level(signal: xr.DataArray) -> float:
    """Return the level of a signal without its mean and its noise, under a Hann window [dB re 1 of its unit]."""
    power, found = _powers(signal)
    return _decibels(float((power - _noise(power, found)).sum()))


@dataclass(frozen=True)
class BandLevel:
    """The level of a signal in a band.

    Its weight falls over a third of an octave without an edge, so that the level changes smoothly as a tone moves.

    Attributes
    ----------
    centre : float
        Centre of the band [Hz].
    """

    centre: float

    def __call__(self, signal: xr.DataArray) -> float:
        """Return the level without that of the noise [dB re 1 of the unit of the signal]."""
        power, found = _powers(signal)
        return _decibels(float((power - _noise(power, found))[1:] @ _weights(found, self.centre)))


@dataclass(frozen=True)
class HarmonicLevel:
    """The level of a harmonic of a signal.

    Attributes
    ----------
    number : int
        Its frequency over that at which the signal has most energy.
    """

    number: int

    def __call__(self, signal: xr.DataArray) -> float:
        """Return the level without that of noise about it [dB re 1 of the unit of the signal]."""
        power, found = _powers(signal)
        first = frequency(signal)
        within = np.abs(found - self.number * first) < HALF * first
        return _decibels(float(power[within].sum() - _mean_of_noise(power) * within.sum()))


# Units of functions that return a number alone.
OF_FUNCTIONS: tuple[tuple[OfSignal, str], ...] = ((frequency, "Hz"), (dominant_frequency, "Hz"))


def shape_of(signal: xr.DataArray) -> dict[str, OfSignal]:
    """Return the levels of the harmonics of a tone above the noise, or that of any other signal and its bands."""
    power, found = _powers(signal)
    first, noise = frequency(signal), float(np.median(power))
    within = [np.abs(found - k * first) < HALF * first for k in range(1, HARMONICS + 1)]
    if not sum(float(power[one].sum()) for one in within) > TONAL * float(power.sum()):
        return {"level": level, **bands_of(signal)}
    least = FAINT * float(power[within[0]].sum())
    clear = [k for k, one in enumerate(within, 1) if power[one].sum() > max(CLEAR * noise * one.sum(), least)]
    return {f"harmonic_{k}": HarmonicLevel(k) for k in clear}


def bands_of(signal: xr.DataArray) -> dict[str, OfSignal]:
    """Return the levels of the bands in which a signal has most of its power, by name."""
    power, found = _powers(signal)
    most = float(found[1:][np.argmax(power[1:])])
    low, high = 4.0 * found[1], 0.8 * found[-1]
    reach = range(int(np.ceil(np.log2(low / most) * 3.0)), int(np.log2(high / most) * 3.0) + 1)
    bands = [BandLevel(float(f"{most * THIRD**k:.3g}")) for k in reach]
    levels = [band(signal) for band in bands]
    noise = [CLEAR * _noise(power, found) * float(_weights(found, band.centre).sum()) for band in bands]
    least = [max(max(levels) - BELOW, _decibels(one)) for one in noise]
    each = zip(bands, levels, least, strict=True)
    return {f"band_{one.centre:g}": one for one, size, low in each if size >= low}


def _weights(found: Array, centre: float) -> Array:
    """Return the weights of a band at frequencies above 0."""
    return np.asarray(np.exp(-18.0 * np.log2(found[1:] / centre) ** 2))


def _noise(power: Array, found: Array) -> float:
    """Return the mean power of white noise at a frequency: that of the quietest third of an octave."""
    edges = np.searchsorted(found, found[-1] * THIRD ** -np.arange(int(3.0 * np.log2(found[-1] / found[FEWEST])) + 1.0))
    return min((_mean_of_noise(power[low:high]) for high, low in pairwise(edges)), default=0.0)


def _mean_of_noise(power: Array) -> float:
    """Return the mean power of noise, which is distributed exponentially, from its median: lines do not count."""
    return float(np.median(power) / np.log(2.0))


def _decibels(power: float) -> float:
    return 10.0 * float(np.log10(max(power, 1e-300)))


def _powers(signal: xr.DataArray) -> tuple[Array, Array]:
    """Return mean square values without the mean at frequencies [Hz], under a Hann window."""
    values, interval = samples(signal)
    found, power = scipy.signal.periodogram(values, 1.0 / interval, "hann", scaling="spectrum")
    return power / 1.5, found


@dataclass(frozen=True)
class OfRecord:
    """A measure of the vibration in a record, without its beginning.

    Attributes
    ----------
    signal : str or callable
        A variable of the record, or a function of it.
    measure : callable
        A function of the vibration.
    units : str
        Units of the recording, empty if they are unknown.
    """

    signal: Signal
    measure: OfSignal
    units: str

    def __call__(self, record: xr.Dataset) -> float:
        """Return the measure."""
        vibration = vibration_of(record, self.signal)
        units = str(vibration.attrs.get("units", ""))
        if units and self.units and units != self.units:
            raise ArgumentError("signal", f"be in {self.units}, as the recording", got=units)
        return float(self.measure(without_beginning(vibration)))


def vibration_of(record: xr.Dataset, signal: Signal) -> xr.DataArray:
    """Return the vibration in a record, given by a variable, the only one of its other dimensions, or by a function."""
    if callable(signal):
        found = signal(record)
    elif signal in record:
        found = record[signal].squeeze(
            [one for one in record[signal].dims if one != "time" and record[signal].sizes[one] == 1]
        )
    else:
        raise ArgumentError("signal", f"be a variable of the record ({listed(map(str, record.data_vars))})", signal)
    if not isinstance(found, xr.DataArray) or found.dims != ("time",):
        got = f"dimensions {listed(map(str, found.dims))}" if isinstance(found, xr.DataArray) else type(found).__name__
        raise ArgumentError("signal", "give values over time alone; a function of the record may select them", got=got)
    return found


def without_beginning(signal: xr.DataArray) -> xr.DataArray:
    """Return a computed vibration without the part in which it still depends on its start."""
    return signal.isel(time=slice(round(TRANSIENT * signal.sizes["time"]), None))


@dataclass(frozen=True)
class Measured:
    """Measures of a recording.

    Attributes
    ----------
    measures : dict
        Functions of a vibration by name.
    values, deviations : ndarray, shape (measures,)
        Their values for the recording, and their standard deviations.
    units : str
        Units of the recording, empty if they are unknown.
    measure_units : tuple of str
        Units of the measures, `UNKNOWN` where a function does not say them.
    """

    measures: dict[str, OfSignal]
    values: Array
    deviations: Array
    units: str
    measure_units: tuple[str, ...]

    def of_record(self, signal: Signal) -> dict[str, OfRecord]:
        """Return the measures as functions of a record."""
        return {name: OfRecord(signal, one, self.units) for name, one in self.measures.items()}

    def targets(self, near: float) -> dict[str, Target]:
        """Return targets that are met within some standard deviations."""
        each = zip(self.measures, self.values, self.deviations, strict=True)
        return {name: Target(float(value - near * size), float(value + near * size)) for name, value, size in each}


def measured_of(
    recording: xr.DataArray,
    measures: Mapping[str, OfSignal] | None,
    parts: int,
    deviations: Mapping[str, float] | None,
) -> Measured:
    """Return the measures of a recording, with deviations from those of its parts; see `calibrate_to`."""
    values, _ = samples(recording)
    if not np.isfinite(values).all() or float(np.ptp(values)) == 0.0:
        raise ArgumentError(
            "recording", "be finite and vibrate", recording, got="values that are not finite, or constant"
        )
    taken = {"frequency": frequency, **shape_of(recording)} if measures is None else _own(measures)
    results = [one(recording) for one in taken.values()]
    found = np.array([float(one) for one in results])
    lacking = [name for name, value in zip(taken, found, strict=True) if not np.isfinite(value)]
    if lacking:
        raise ArgumentError("recording", "have these measures", got=f"none of {listed(lacking)}")
    size = values.size // count("parts", parts, low=4)
    pieces = [recording.isel(time=slice(k * size, (k + 1) * size)) for k in range(parts)]
    spread = np.array([[float(one(piece)) for piece in pieces] for one in taken.values()])
    known = np.isfinite(spread).all(axis=1)
    own = np.where(known, np.std(np.where(known[:, None], spread, 0.0), axis=1, ddof=1) / np.sqrt(parts), 0.0)
    is_level = np.array([measures is None and name != "frequency" for name in taken])
    sizes = np.maximum(own, np.where(is_level, LEAST_LEVEL, LEAST_FREQUENCY * np.abs(found)))
    for name, size_given in by_key("deviations", deviations).items():
        if name not in taken:
            raise ArgumentError("deviations", f"be of {listed(taken)}", name)
        sizes[list(taken).index(name)] = positive(f"deviations[{name!r}]", size_given)
    if not (sizes > 0.0).all():
        zero = listed(name for name, one in zip(taken, sizes, strict=True) if not one > 0.0)
        raise ArgumentError("deviations", f"be given for {zero}, which is the same in all parts of the recording")
    units = str(recording.attrs.get("units", ""))
    units = "" if units == UNKNOWN else units
    of_level = f"dB re 1 {units}" if units else "dB"
    each = zip(taken.values(), results, is_level, strict=True)
    words = tuple(of_level if level else _units_of(one, result) for one, result, level in each)
    return Measured(taken, found, sizes, units, words)


def _units_of(measure: OfSignal, result: Any) -> str:
    """Return the units of a measure: those of its result, its attribute, or those of a function of this package."""
    given = getattr(result, "attrs", {}).get("units", getattr(measure, "units", None))
    if isinstance(given, str) and given:
        return given
    return next((units for one, units in OF_FUNCTIONS if one is measure), UNKNOWN)


def _own(measures: Any) -> dict[str, OfSignal]:
    instance("measures", measures, Mapping)
    if not measures or not all(isinstance(name, str) and callable(one) for name, one in measures.items()):
        raise ArgumentError("measures", "be functions of a vibration by name", measures)
    return dict(measures)
