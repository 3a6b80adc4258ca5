"""Figures of squeal events: level over frequency."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullLocator

from ..checks import ArgumentError, counted, instance
from .colours import LINE, LINES

NEEDED = ("frequency", "level", "squeals", "peak_level", "peak_frequency", "occurrence")
SETTINGS = ("threshold", "lowest", "highest")
# Frequencies with a label [kHz], and bands of the occurrence to an octave.
LABELS = (0.5, 1, 1.25, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20)
BANDS = 3
# Range of levels above the threshold and below it that is always drawn [dB].
ABOVE, BELOW = 30.0, 10.0


def squeal_events(found: xr.Dataset, *, title: str = "") -> Figure:
    """Draw squeal events as peak level over frequency, and the share of stops that squeal in each third octave.

    Lines mark the lowest level of a squeal and the ends of the band. Stops without a squeal are drawn hollow at their
    strongest tone in the band, if they have one.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `squeal_events`.
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `found` is anything else.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> import stridula as st
    >>> time = np.arange(48000) / 48e3
    >>> tone = xr.DataArray(np.sin(2 * np.pi * 3e3 * time), {"time": time}, ("time",), attrs={"units": "Pa"})
    >>> figure = st.plot.squeal_events(st.squeal_events([tone, 1e-3 * tone]))
    """
    instance("found", found, xr.Dataset)
    if any(name not in found for name in NEEDED) or any(name not in found.attrs for name in SETTINGS):
        raise ArgumentError("found", "be the result of squeal_events", found)
    threshold, lowest, highest = (float(found.attrs[name]) for name in SETTINGS)
    figure = Figure(figsize=(9.0, 5.6), layout="constrained", dpi=120)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[3.0, 1.0])
    frequency, level = found["frequency"].values / 1e3, found["level"].values
    above.plot(frequency, level, "o", color=LINE, alpha=0.6, markersize=5, label=f"squeals ({level.size})")
    quiet = ~found["squeals"].values.astype(bool) & np.isfinite(found["peak_level"].values)
    if quiet.any():
        words = f"strongest tone of stops without squeal ({int(quiet.sum())})"
        x, y = found["peak_frequency"].values[quiet] / 1e3, found["peak_level"].values[quiet]
        above.plot(x, y, "o", color="none", markeredgecolor="0.5", markersize=5, label=words)
    above.axhline(threshold, color=LINES[1], linewidth=1.0, label=f"{threshold:g} dB(A)")
    for axes in (above, below):
        for end in (lowest, highest):
            axes.axvline(end / 1e3, color=LINES[1], linewidth=1.0, linestyle="--")
        axes.grid(alpha=0.3, linewidth=0.5)
    every = np.concatenate([level, found["peak_level"].values[quiet], [threshold + ABOVE, threshold - BELOW]])
    above.set_ylim(every.min() - 3.0, every.max() + 3.0)
    above.set_ylabel("A-weighted level of the tone\n[dB re 20 µPa]")
    above.legend(fontsize=8, frameon=False, loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)
    edges, shares = _shares(found, lowest, highest)
    below.bar(edges[:-1], shares, np.diff(edges), align="edge", color=LINE, alpha=0.35, edgecolor=LINE, linewidth=0.5)
    below.set_ylim(0.0, 1.0)
    below.set_ylabel("share of stops")
    below.set_xscale("log")
    below.set_xlim(0.9 * lowest / 1e3, 1.1 * highest / 1e3)
    below.set_xticks([one for one in LABELS if 0.9 * lowest <= 1e3 * one <= 1.1 * highest])
    below.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    below.xaxis.set_minor_locator(NullLocator())
    below.set_xlabel("frequency [kHz]")
    words = f"squeals in {int(found['squeals'].sum())} of {counted(found.sizes['stop'], 'stop')}"
    figure.suptitle(f"{title}: {words}" if title else words, fontsize=11)
    return figure


def _shares(found: xr.Dataset, lowest: float, highest: float) -> tuple[np.ndarray, np.ndarray]:
    """Return edges of bands of equal ratio [kHz], and the share of stops with a squeal in each."""
    count = max(1, round(BANDS * np.log2(highest / lowest)))
    edges = np.geomspace(lowest, highest, count + 1)
    band = np.clip(np.searchsorted(edges, found["frequency"].values, side="right") - 1, 0, count - 1)
    stops = found["event_stop"].values.astype(str)
    shares = [np.unique(stops[band == number]).size / found.sizes["stop"] for number in range(count)]
    return edges / 1e3, np.array(shares)
