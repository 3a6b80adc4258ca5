"""Levels of a sound in third-octave bands."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ..acoustics.levels import AUDIBLE, BANDS, NOMINAL, SHORTEST, equivalent_level, third_octave_levels
from ..acoustics.pressures import channels, positions
from ..acoustics.squeals import HIGHEST, LOWEST
from ..arrays import Array
from ..checks import ArgumentError, finite, positive
from ..weighting import a_weighting
from .colours import LINES

RANGE = 60.0
# Ratio of the upper edge of a band to its centre.
EDGE = 10.0**0.05


def third_octaves(
    pressure: xr.DataArray, *, limit: float | None = None, dynamic_range: float = RANGE, title: str = ""
) -> Figure:
    """Draw the levels of a sound in third-octave bands, as a staircase for each listener.

    Bands from 25 Hz to 16 kHz are drawn where the duration and the sample rate of the sound suffice. The legend gives
    LAeq of each listener.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa].
    limit : float, optional
        A-weighted level of a tone [dB(A)], such as the 70 dB of SAE J2521, drawn over the band of `squeal_events` as
        the level that it has without weighting.
    dynamic_range : float, optional
        Range of the levels [dB], below the largest.
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If the sound is silent, or too short or too coarse for any band.
    """
    positive("dynamic_range", dynamic_range)
    if limit is not None:
        finite("limit", limit)
    values, rate = channels(pressure)
    levels = third_octave_levels(pressure, *_ends(len(values) / rate, rate))
    rows = np.atleast_2d(levels.transpose(..., "band").values)
    top = 5.0 * np.ceil(rows.max() / 5.0)
    if not np.isfinite(top):
        raise ArgumentError("pressure", "hold a sound", pressure, got="silence")
    figure = Figure(figsize=(9.0, 4.2), layout="constrained", dpi=120)
    axes = figure.subplots()
    edges = np.append(levels.centre.values / EDGE, levels.centre.values[-1] * EDGE)
    bottom = top - dynamic_range
    if limit is not None:
        tones, allowed = _limit(limit)
        top, bottom = max(top, 5.0 * np.ceil(allowed.max() / 5.0)), min(bottom, 5.0 * np.floor(allowed.min() / 5.0))
        axes.plot(tones, allowed, color="0.2", linewidth=1.0, linestyle="--", label=f"a tone of {limit:g} dB(A)")
    for number, (row, label) in enumerate(zip(rows, _labels(pressure, len(values) / rate, rate), strict=True)):
        colour = LINES[number % len(LINES)]
        axes.stairs(np.maximum(row, bottom), edges, baseline=bottom, color=colour, linewidth=1.3, label=label)
        if len(rows) == 1:
            axes.stairs(np.maximum(row, bottom), edges, baseline=bottom, color=colour, alpha=0.3, fill=True)
    axes.set_xscale("log")
    axes.set_xlim(edges[0], edges[-1])
    axes.set_ylim(bottom, top)
    # Bands of an octave.
    shown = np.flatnonzero(np.rint(10.0 * np.log10(levels.centre.values)) % 3 == 0)
    axes.set_xticks(levels.centre.values[shown], [_short(band) for band in levels.band.values[shown]])
    axes.minorticks_off()
    axes.set_xlabel("centre of the band [Hz]")
    axes.set_ylabel("level [dB re 20 µPa]")
    axes.grid(alpha=0.3, linewidth=0.5)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(fontsize=8, frameon=False)
    axes.set_title(title, fontsize=11)
    return figure


def _limit(level: float) -> tuple[Array, Array]:
    """Return frequencies [Hz] in the band of squeal, and the levels there of tones with an A-weighted level [dB]."""
    tones = np.geomspace(LOWEST, HIGHEST, 200)
    return tones, level - 20.0 * np.log10(np.abs(a_weighting(tones)))


def _ends(lasts: float, rate: float) -> tuple[float, float]:
    """Return the nominal centres of the lowest and of the highest band for a sound."""
    # Up to 16 kHz.
    numbers = BANDS[:-1]
    exact = 10.0 ** (numbers / 10.0)
    fits = (exact * (EDGE - 1.0 / EDGE) * lasts >= 1.0) & (2.0 * exact * EDGE <= rate)
    known = NOMINAL[numbers - 10][fits]
    if not known.size:
        raise ArgumentError("pressure", "be long enough for a band", got=f"{lasts:.3g} s at {rate:.4g} Hz")
    return float(known[0]), float(known[-1])


def _labels(pressure: xr.DataArray, lasts: float, rate: float) -> list[str]:
    """Return a label for each listener, with LAeq where sample rate and duration suffice."""
    places = positions(pressure)
    count = pressure.sizes.get("listener", 1)
    names = ["" if count == 1 else f"listener {number}" for number in range(1, count + 1)]
    if places is not None:
        names = [f"({', '.join(f'{x:.4g}' for x in place)}) m" for place in places]
    if rate < 2.0 * AUDIBLE or lasts < SHORTEST:
        return names
    loud: Array = np.atleast_1d(equivalent_level(pressure, "A").values)
    return [f"{name}{': ' * bool(name)}LAeq {level:.1f} dB" for name, level in zip(names, loud, strict=True)]


def _short(band: float) -> str:
    return f"{band / 1e3:g}k" if band >= 1e3 else f"{band:g}"
