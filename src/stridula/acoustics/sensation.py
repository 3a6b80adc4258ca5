"""Psychoacoustics: loudness, sharpness, roughness, prominent tones, computed by MoSQITo (imported only here)."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from importlib.util import find_spec
from typing import Any

import numpy as np
import xarray as xr

from ..arrays import Array
from ..checks import choice
from ..extras import named_extras
from .pressures import channels, check_length, check_rate, of_listeners, over_time
from .sample_rates import resampled

RATE = 48000
FIELDS = ("free", "diffuse")
# Shortest sounds [s]: for the filters of the lowest bands to settle, for the temporal weighting, for one frame.
SHORTEST_STEADY, SHORTEST_VARYING, FRAME = 0.5, 0.25, 0.2
# Lowest sample rate [Hz] that leaves no band of the models empty: their highest ends at 14.1 kHz.
LOWEST_RATE = 28.3e3
# Loudness [sone] below which sharpness has no meaning.
FAINTEST = 0.1


def is_available() -> bool:
    """Return whether MoSQITo is installed."""
    return find_spec("mosqito") is not None


def loudness(pressure: xr.DataArray, field: str = "free") -> xr.DataArray:
    """Return the loudness of a steady sound (ISO 532-1:2017, method for stationary sounds).

    The bands are filtered from silence, so that a sound that starts abruptly is a little louder than a lasting one:
    2 s of 1 kHz at 40, 60 and 80 dB have 1.006, 4.067 and 16.84 sone, 0.5 s have 1.005, 4.14 and 17.5, where the
    definition has 1, 4 and 16. For intermittent sounds use `loudness_over_time`.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], at 28.3 kHz or more; at least 0.5 s.
    field : {"free", "diffuse"}, optional
        Sound field: from the front, or from everywhere.

    Returns
    -------
    xarray.DataArray, shape () or (listener,)
        Loudness [sone].

    Raises
    ------
    ValueError
        If the sound is too short or sampled too slowly, or an argument is out of its range.
    ImportError
        If the extra ``psycho`` is not installed.
    """
    choice("field", field, FIELDS)
    metrics = _metrics()
    sounds = _sounds(pressure, SHORTEST_STEADY, "the loudness of a steady sound")
    values = _each(sounds, lambda sound: float(metrics.loudness_zwst(sound, RATE, field_type=field)[0]))
    return of_listeners(pressure, np.array(values), "loudness", "sone", "loudness, ISO 532-1, stationary")


def loudness_over_time(pressure: xr.DataArray, field: str = "free") -> xr.DataArray:
    """Return the loudness of a sound that varies (ISO 532-1:2017, method for time-varying sounds).

    Its largest value is Nmax; N5, exceeded in 5 % of the time, corresponds to the perceived loudness of the whole
    sound: ``loudness_over_time(pressure).quantile(0.95, "time")``. It rises from silence in about 0.1 s.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], at 28.3 kHz or more; at least 0.25 s.
    field : {"free", "diffuse"}, optional
        Sound field: from the front, or from everywhere.

    Returns
    -------
    xarray.DataArray, shape (times,) or (times, listener)
        Loudness [sone] every 2 ms.

    Raises
    ------
    ValueError
        If the sound is too short or sampled too slowly, or an argument is out of its range.
    ImportError
        If the extra ``psycho`` is not installed.
    """
    choice("field", field, FIELDS)
    metrics = _metrics()
    sounds = _sounds(pressure, SHORTEST_VARYING, "loudness over time")
    values = _each(sounds, lambda sound: metrics.loudness_zwtv(sound, RATE, field_type=field)[0])
    # MoSQITo spreads the times to the last sample; its values are 2 ms apart.
    time = 2e-3 * np.arange(len(values[0]))
    return over_time(pressure, time, np.stack(values, axis=1), "loudness", "sone", "loudness, ISO 532-1, time-varying")


def sharpness(pressure: xr.DataArray, field: str = "free") -> xr.DataArray:
    """Return the sharpness of a steady sound (DIN 45692:2009).

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], at 28.3 kHz or more; at least 0.5 s.
    field : {"free", "diffuse"}, optional
        Sound field: from the front, or from everywhere.

    Returns
    -------
    xarray.DataArray, shape () or (listener,)
        Sharpness [acum]; NaN for sounds below 0.1 sone.

    Raises
    ------
    ValueError
        If the sound is too short or sampled too slowly, or an argument is out of its range.
    ImportError
        If the extra ``psycho`` is not installed.
    """
    choice("field", field, FIELDS)
    metrics = _metrics()
    sounds = _sounds(pressure, SHORTEST_STEADY, "sharpness")

    def of_one(sound: Array) -> float:
        total, specific, _ = metrics.loudness_zwst(sound, RATE, field_type=field)
        if total < FAINTEST:
            return float("nan")
        return float(metrics.sharpness_din_from_loudness(total, specific, weighting="din"))

    return of_listeners(pressure, np.array(_each(sounds, of_one)), "sharpness", "acum", "sharpness, DIN 45692")


def roughness(pressure: xr.DataArray) -> xr.DataArray:
    """Return the roughness of a sound over time (Daniel & Weber 1997, Acustica 83, 113-123).

    A tone of 1 kHz at 60 dB, fully modulated at 70 Hz, defines 1 asper; the result here is 1.019.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], at 28.3 kHz or more; at least 0.2 s.

    Returns
    -------
    xarray.DataArray, shape (frames,) or (frames, listener)
        Roughness [asper] of frames of 0.2 s, every 0.1 s, at their middles.

    Raises
    ------
    ValueError
        If the sound is too short or sampled too slowly.
    ImportError
        If the extra ``psycho`` is not installed.
    """
    metrics = _metrics()
    sounds = _sounds(pressure, FRAME, "roughness")
    values = _each(sounds, lambda sound: np.atleast_1d(metrics.roughness_dw(sound, RATE, overlap=0.5)[0]))
    time = 0.5 * FRAME + 0.5 * FRAME * np.arange(len(values[0]))
    return over_time(pressure, time, np.stack(values, axis=1), "roughness", "asper", "roughness, Daniel & Weber")


def prominent_tones(pressure: xr.DataArray) -> xr.Dataset:
    """Return the tones that stand out of a steady sound, by their prominence ratio (ECMA-418-1:2022).

    The prominence ratio is the level of the critical band around a tone over the mean of both its neighbours. A tone is
    prominent from 9 dB on, below 1 kHz from ``9 dB + 10 lg(1 kHz / frequency)`` dB on. Of several tones in a critical
    band only the strongest is named, and partials in neighbouring bands hide each other: the ratio of a partial of a
    periodic sound may be small though it is heard. Sounds without any noise, such as computed ones, have ratios of 100
    dB and more.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], at 28.3 kHz or more; at least 0.5 s. The sounds of several listeners are judged each.

    Returns
    -------
    xarray.Dataset
        Over ``tone`` (and ``listener``), by falling ratio: ``frequency`` [Hz], ``prominence_ratio`` [dB] and whether
        the tone is ``prominent``. Tones whose ratio is not above 0 dB are left out; listeners with fewer tones than
        others have NaN and False behind theirs.

    Raises
    ------
    ValueError
        If the sound is too short or sampled too slowly.
    ImportError
        If the extra ``psycho`` is not installed.
    """
    metrics = _metrics()
    sounds = _sounds(pressure, SHORTEST_STEADY, "tones")
    found = _each(sounds, lambda sound: _tones_of(sound, metrics))
    values = np.full((max(map(len, found)), len(found), 3), np.nan)
    for number, tones in enumerate(found):
        values[: len(tones), number] = tones
    along = ("tone", "listener") if "listener" in pressure.dims else ("tone",)
    values = values if "listener" in pressure.dims else values[:, 0]
    names = (("frequency", "Hz", "frequency of the tone"), ("prominence_ratio", "dB", "prominence ratio, ECMA-418-1"))
    data = {
        name: (along, values[..., k], {"units": units, "long_name": meaning})
        for k, (name, units, meaning) in enumerate(names)
    }
    judged = (along, values[..., 2] == 1.0, {"long_name": "whether the tone is prominent, ECMA-418-1"})
    kept = {name: one for name, one in pressure.coords.items() if one.dims == ("listener",)}
    return xr.Dataset({**data, "prominent": judged}, kept)


def _tones_of(sound: Array, metrics: Any) -> Array:
    """Return frequency [Hz], prominence ratio [dB] and prominence of the tones of a sound, shape (tones, 3)."""
    _, ratios, judged, places = metrics.pr_ecma_st(sound, RATE, prominence=False)
    found = np.column_stack([np.atleast_1d(one).astype(float) for one in (places, ratios, judged)]).reshape(-1, 3)
    found = found[np.isfinite(found).all(axis=1) & (found[:, 1] > 0.0)]
    # The library names the edge of a line of its spectrum.
    spectrum = np.abs(np.fft.rfft(sound * np.hanning(sound.size)))
    found[:, 0] = [_top_near(spectrum, one * sound.size / RATE) * RATE / sound.size for one in found[:, 0]]
    return found[np.argsort(-found[:, 1], kind="stable")]


def _top_near(spectrum: Array, place: float) -> float:
    """Return the place of the highest line within two of a place, by a parabola through its logarithm."""
    first = max(round(place) - 2, 1)
    top = first + int(np.argmax(spectrum[first : round(place) + 3]))
    if not 0 < top < spectrum.size - 1 or not spectrum[top - 1 : top + 2].all():
        return float(top)
    left, middle, right = np.log(spectrum[top - 1 : top + 2])
    return float(top + 0.5 * (left - right) / (left - 2.0 * middle + right))


def _metrics() -> Any:
    with _quiet(), named_extras():
        import mosqito.sq_metrics
    return mosqito.sq_metrics


def _sounds(pressure: xr.DataArray, shortest: float, what: str) -> Array:
    """Return the sounds of all listeners at 48 kHz, shape (samples, listeners)."""
    values, rate = channels(pressure)
    check_length(pressure, shortest, what)
    check_rate(rate, LOWEST_RATE, what)
    return resampled(values, rate, RATE)


def _each(sounds: Array, of_one: Callable[[Array], Any]) -> list[Any]:
    with _quiet():
        return [of_one(np.ascontiguousarray(sound)) for sound in sounds.T]


@contextmanager
def _quiet() -> Iterator[None]:
    """Suppress warnings of NumPy inside, such as that of the logarithm of silence."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        yield
