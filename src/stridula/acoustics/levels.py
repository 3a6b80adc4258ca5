"""Levels of sound: equivalent, over time, in third-octave bands."""

from __future__ import annotations

import numpy as np
import xarray as xr
from scipy.fft import next_fast_len, rfft, rfftfreq

from ..arrays import Array
from ..checks import ArgumentError, choice, count, positive
from .pressures import channels, check_length, check_rate, is_enough, of_listeners
from .weighting import TIME_CONSTANTS, a_weighted, time_weighted

# Reference sound pressure [Pa] (ISO 1683).
REFERENCE = 20e-6
WEIGHTINGS = ("Z", "A")
# Requirements of weighted levels: samples up to 10 kHz, beyond which class 2 of IEC 61672-1 requires nothing, and a
# period of 20 Hz.
LOWEST_RATE, SHORTEST = 20e3, 0.05
# End of the audible range [Hz]: levels of sounds that end below it say so.
AUDIBLE = 20e3
# Order of the band filters.
ORDER = 6
# Numbers of the bands from 25 Hz to 20 kHz; their exact centres are 10^(n/10) Hz.
BANDS = np.arange(14, 44)
NOMINAL = np.outer([10.0, 100.0, 1000.0, 10000.0], [1.0, 1.25, 1.6, 2.0, 2.5, 3.15, 4.0, 5.0, 6.3, 8.0]).ravel()


def equivalent_level(pressure: xr.DataArray, weighting: str = "Z") -> xr.DataArray:
    """Return the equivalent sound pressure level over the whole of a sound, Leq or LAeq.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa].
    weighting : {"Z", "A"}, optional
        None, or A of IEC 61672-1, which requires samples at 20 kHz or more.

    Returns
    -------
    xarray.DataArray, shape () or (listener,)
        Level [dB] re 20 µPa; minus infinity for silence. Below 40 kHz its attribute ``bandwidth`` [Hz] and its
        ``long_name`` say up to which frequency sound is counted.

    Raises
    ------
    ValueError
        If the sound lasts less than 0.05 s or is sampled too slowly, or an argument is out of its range.
    """
    squares = np.mean(_weighted(pressure, weighting)[0] ** 2, axis=0)
    name = "LAeq" if weighting == "A" else "Leq"
    words = f"equivalent sound pressure level {name} re 20 µPa"
    return _up_to(of_listeners(pressure, decibels(squares), name, "dB", words), pressure)


def sound_level(pressure: xr.DataArray, weighting: str = "A", response: str = "fast") -> xr.DataArray:
    """Return the sound level over time as a sound level meter shows it, such as LAF.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], silence before it.
    weighting : {"A", "Z"}, optional
        A of IEC 61672-1, or none.
    response : {"fast", "slow"}, optional
        Time weighting F (0.125 s) or S (1 s).

    Returns
    -------
    xarray.DataArray, shape of `pressure`
        Level [dB] re 20 µPa. Its largest value is LAFmax. Its attributes are as for `equivalent_level`.

    Raises
    ------
    ValueError
        If the sound lasts less than 0.05 s or is sampled too slowly, or an argument is out of its range.
    """
    choice("response", response, tuple(TIME_CONSTANTS))
    values, rate = _weighted(pressure, weighting)
    levels = decibels(time_weighted(values**2, rate, response)).reshape(pressure.shape)
    name = f"L{weighting}{response[0].upper()}"
    words = {"units": "dB", "long_name": f"sound level {name} re 20 µPa"}
    return _up_to(pressure.copy(data=levels).rename(name).assign_attrs(words), pressure)


def harmonic_levels(pressure: xr.DataArray, most: int = 40) -> xr.DataArray:
    """Return the levels of the harmonics of a periodic sound.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        One or more periods of sound pressure [Pa], as of `radiate` for a limit cycle.
    most : int, optional
        Most harmonics.

    Returns
    -------
    xarray.DataArray, shape (harmonic,) or (harmonic, listener)
        Level [dB] re 20 µPa of each, of its effective value; minus infinity where there is none. ``frequency`` [Hz] is
        along ``harmonic``.

    Raises
    ------
    ValueError
        If the sound has no period, or does not last whole ones.
    """
    values, rate = channels(pressure)
    period = pressure.attrs.get("period")
    if period is None:
        raise ArgumentError(
            "pressure", "be the sound of a limit cycle, with its period", got="a sound without a period"
        )
    lasts = len(values) / (rate * float(period))
    periods = round(lasts)
    if periods < 1 or abs(lasts - periods) * len(values) > 0.1 * periods or len(values) % periods:
        raise ArgumentError("pressure", "last whole periods", got=f"{lasts:.6g} of them")
    kept = min(count("most", most), (len(values) // periods - 1) // 2)
    amplitudes = 2.0 * np.abs(rfft(values, axis=0))[periods : (kept + 1) * periods : periods] / len(values)
    words = {"long_name": "harmonic", "units": "1"}
    at = xr.Variable("harmonic", np.arange(1, kept + 1), words)
    bare = pressure.isel(time=0, drop=True).expand_dims(harmonic=at)
    levels = bare.copy(data=decibels(0.5 * amplitudes**2).reshape(bare.shape)).rename("harmonic_level")
    frequency = ("harmonic", np.arange(1, kept + 1) / float(period), {"units": "Hz", "long_name": "frequency"})
    return levels.assign_coords(frequency=frequency).assign_attrs(
        units="dB", long_name="sound pressure level of the harmonics re 20 µPa"
    )


def third_octave_levels(pressure: xr.DataArray, lowest: float = 25.0, highest: float = 16000.0) -> xr.DataArray:
    """Return equivalent levels in the third-octave bands of IEC 61260-1 (base ten, class 1).

    The bands are analogue Butterworth filters of order 6, their mean squares taken from the spectrum of the whole sound
    (Parseval). No filter has to settle, none is distorted near half of the sample rate, and the bands add up to within
    0.05 dB of the whole; a sound that starts abruptly spreads into other bands, as it does in any filter.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa].
    lowest, highest : float, optional
        Nominal centres of the first and the last band [Hz], from 25 to 20000.

    Returns
    -------
    xarray.DataArray, shape (band,) or (band, listener)
        Levels [dB] re 20 µPa over the nominal centres ``band`` [Hz]; ``centre`` has the exact ones.

    Raises
    ------
    ValueError
        If the sound lasts less than one over the width of the lowest band, is sampled at less than twice the upper edge
        of the highest one, or an argument is out of its range.
    """
    numbers = np.arange(_band("lowest", lowest), _band("highest", highest) + 1)
    if not numbers.size:
        raise ArgumentError("highest", f"be at or above the lowest band of {lowest!r} Hz", highest)
    centres = 10.0 ** (numbers / 10.0)
    values, rate = channels(pressure)
    narrowest = centres[0] * (10.0**0.05 - 10.0**-0.05)
    check_length(pressure, 1.0 / narrowest, f"a lowest band of {lowest:g} Hz")
    check_rate(rate, 2.0 * centres[-1] * 10.0**0.05, f"a highest band of {highest:g} Hz")
    size = next_fast_len(2 * values.shape[0], real=True)
    frequency = rfftfreq(size, 1.0 / rate)
    # Each frequency also stands for its negative one.
    energy = 2.0 * np.abs(rfft(values, size, axis=0)) ** 2 / size
    squares = np.array([band_gain(frequency, centre) @ energy for centre in centres]) / values.shape[0]
    words = {"units": "Hz", "long_name": "nominal centre frequency"}
    at = xr.Variable("band", NOMINAL[numbers - 10], words)
    bare = pressure.isel(time=0, drop=True).expand_dims(band=at)
    levels = bare.copy(data=decibels(squares).reshape(bare.shape)).rename("third_octave_level")
    exact = ("band", centres, {"units": "Hz", "long_name": "exact centre frequency"})
    return levels.assign_coords(centre=exact).assign_attrs(
        units="dB", long_name="sound pressure level in third-octave bands re 20 µPa"
    )


def band_gain(frequency: Array, centre: float) -> Array:
    """Return the gain in power of the third-octave filter about an exact centre [Hz] at frequencies [Hz]."""
    width = 10.0**0.05 - 10.0**-0.05
    with np.errstate(divide="ignore"):
        off = (frequency / centre - centre / frequency) / width
    return np.asarray(1.0 / (1.0 + off ** (2 * ORDER)))


def decibels(squares: Array) -> Array:
    """Return the levels re 20 µPa [dB] of mean squares [Pa²]."""
    with np.errstate(divide="ignore"):
        return np.asarray(10.0 * np.log10(squares / REFERENCE**2))


def _up_to(level: xr.DataArray, pressure: xr.DataArray) -> xr.DataArray:
    """Return a level with the end of the band of its sound, where that is below the audible range."""
    reach = min(0.5 * channels(pressure)[1], float(pressure.attrs.get("bandwidth", np.inf)))
    if is_enough(reach, AUDIBLE):
        return level
    return level.assign_attrs(bandwidth=reach, long_name=f"{level.attrs['long_name']}, up to {reach / 1e3:.4g} kHz")


def _weighted(pressure: xr.DataArray, weighting: str) -> tuple[Array, float]:
    choice("weighting", weighting, WEIGHTINGS)
    values, rate = channels(pressure)
    check_length(pressure, SHORTEST, "a level")
    if weighting == "Z":
        return values, rate
    check_rate(rate, LOWEST_RATE, "A-weighting")
    return a_weighted(values, rate), rate


def _band(name: str, nominal: float) -> int:
    """Return the number of the band with a nominal centre."""
    positive(name, nominal)
    known = NOMINAL[BANDS - 10]
    nearest = int(np.argmin(np.abs(np.log(known) - np.log(nominal))))
    if abs(known[nearest] - nominal) > 1e-6 * nominal:
        raise ArgumentError(
            name,
            "be the nominal centre of a third-octave band from 25 to 20000 Hz",
            nominal,
            got=f"{nominal!r}; the nearest is {known[nearest]:g}",
        )
    return int(BANDS[nearest])
