"""Spectra, with the natural frequencies of the bodies and the modes that grow."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.signal import welch

from ..arrays import Array
from ..checks import instance, positive
from ..system import System
from .colours import LINES
from .sounds import one_signal, reference

HIGHEST, RESOLUTION, RANGE = 16e3, 5.0, 90.0
GROWS = "#000000"


def spectrum(
    signal: xr.DataArray,
    system: System | None = None,
    stability: xr.Dataset | None = None,
    *,
    highest: float = HIGHEST,
    resolution: float = RESOLUTION,
    title: str = "",
) -> Figure:
    """Draw the power spectral density of a sound or a recorded signal.

    Natural frequencies of the bodies without contact are ticks above the spectrum, a row for each body. Modes of
    sliding that grow are dashed lines, labelled with frequency and growth rate.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,) or (time, listener)
        Sound pressure [Pa], with a line for each listener, or a recorded signal.
    system : System, optional
        The system, for natural frequencies.
    stability : xarray.Dataset, optional
        Result of `sliding_stability`, for modes that grow.
    highest : float, optional
        Upper end of the frequency axis [Hz], at most half the sample rate.
    resolution : float, optional
        Frequency spacing [Hz], at least the inverse of the duration of the signal.
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If an argument is of the wrong type or out of its range.
    """
    positive("highest", highest)
    positive("resolution", resolution)
    signals = _signals(signal)
    level = reference(signal, "/Hz")
    figure = Figure(figsize=(9.0, 4.6), layout="constrained", dpi=120)
    axes = figure.subplots()
    curves = [_density(one, resolution) for one in signals.values()]
    for number, (label, (frequency, density)) in enumerate(zip(signals, curves, strict=True)):
        axes.plot(
            frequency / 1e3, level.decibels(density), color=LINES[number % len(LINES)], linewidth=0.9, label=label
        )
    top = max(float(level.decibels(density).max()) for _, density in curves)
    end = min(highest, curves[0][0][-1])
    axes.set_xlim(0.0, end / 1e3)
    axes.set_ylim(top - RANGE, top + 10.0)
    if stability is not None:
        _draw_growing(axes, stability, end)
    if system is not None:
        _draw_natural(axes, system, end)
    axes.set_xlabel("frequency [kHz]")
    axes.set_ylabel(f"power spectral density\n[{level.words}]")
    axes.grid(alpha=0.3, linewidth=0.5)
    if len(signals) > 1:
        axes.legend(fontsize=8, frameon=False, loc="lower right")
    axes.set_title(title, fontsize=11)
    return figure


def _signals(signal: xr.DataArray) -> dict[str, xr.DataArray]:
    """Return the signals by label."""
    instance("signal", signal, xr.DataArray)
    if "listener" not in signal.dims:
        return {"": signal}
    names = signal["listener"].values if "listener" in signal.coords else range(signal.sizes["listener"])
    return {f"listener {name}": signal.isel(listener=number) for number, name in enumerate(names)}


def _density(signal: xr.DataArray, resolution: float) -> tuple[Array, Array]:
    values, interval = one_signal(signal)
    size = min(values.size, round(1.0 / (resolution * interval)))
    frequency, density = welch(values, 1.0 / interval, nperseg=max(size, 2), detrend="constant")
    # At frequency 0 only a residue of the mean is left.
    return frequency[1:], density[1:]


def _draw_growing(axes: Axes, stability: xr.Dataset, end: float) -> None:
    growing = stability.isel(mode=np.flatnonzero(stability["unstable"].values))
    for frequency, rate in zip(growing["frequency"].values, growing["growth_rate"].values, strict=True):
        if frequency > end:
            continue
        axes.axvline(frequency / 1e3, color=GROWS, linewidth=1.0, linestyle="--", zorder=1)
        axes.annotate(
            f"{frequency:.0f} Hz, grows by {rate:.0f} /s",
            (frequency / 1e3, 0.02),
            (2, 0),
            xycoords=("data", "axes fraction"),
            textcoords="offset points",
            rotation=90,
            va="bottom",
            fontsize=8,
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.5},
        )


def _draw_natural(axes: Axes, system: System, end: float) -> None:
    instance("system", system, System)
    top = axes.get_ylim()[1]
    row = 0.03 * (top - axes.get_ylim()[0])
    for number, body in enumerate(system.bodies):
        frequency = body.modes(system.is_held(body)).frequency
        shown = frequency[(frequency > 0.0) & (frequency <= end)]
        bottom = top + (number + 0.2) * row
        colour = LINES[(2 + number) % len(LINES)]
        axes.vlines(shown / 1e3, bottom, bottom + 0.7 * row, color=colour, linewidth=1.0)
        axes.text(
            1.005, bottom + 0.35 * row, system.body_name(body), color=colour, fontsize=8, va="center",
            transform=axes.get_yaxis_transform(), clip_on=False,
        )  # fmt: skip
    axes.set_ylim(top=top + (len(system.bodies) + 0.3) * row)
