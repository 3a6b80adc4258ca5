"""Spectrograms, with the state of the contact."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.signal import ShortTimeFFT
from scipy.signal.windows import hann

from ..analysis.signals import record_of_one
from ..arrays import Array
from ..checks import ArgumentError, bounds, positive
from .sounds import Reference, one_signal, reference
from .timelines import draw_line, draw_status

COLUMNS = 800
WINDOW, HIGHEST, RANGE = 0.02, 16e3, 70.0


def spectrogram(
    signal: xr.DataArray,
    run: xr.Dataset | None = None,
    *,
    window: float = WINDOW,
    highest: float = HIGHEST,
    dynamic_range: float = RANGE,
    title: str | None = None,
) -> Figure:
    """Draw the spectrogram of a sound or of a recorded signal, with the contact on the same time axis.

    A pure tone shows its own level, in dB re 20 µPa for a sound pressure and in dB re its unit for other signals. With
    a record, the normal force is drawn above and the status below. Sound is delayed by its travel, 3 ms per metre.

    Parameters
    ----------
    signal : xarray.DataArray, shape (time,) or (time, 1)
        Sound pressure [Pa] of one listener, or a recorded signal such as ``run.normal_force``.
    run : xarray.Dataset, optional
        Record with one contact, the source of the sound.
    window : float, optional
        Length of the Hann window [s]; the frequency resolution is 1.5 divided by it.
    highest : float, optional
        Upper end of the frequency axis [Hz], at most half the sample rate.
    dynamic_range : float, optional
        Range of the colours [dB], below the loudest.
    title : str, optional
        Title of the figure; if left out, that of the record.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If the signal is of several listeners or contacts, or shorter than the window.
    """
    values, interval = one_signal(signal)
    for name, value in (("window", window), ("highest", highest), ("dynamic_range", dynamic_range)):
        positive(name, value)
    size = round(window / interval)
    if not 8 <= size <= values.size:
        least, most = bounds(8 * interval, values.size * interval, digits=3)
        raise ArgumentError("window", f"be from {least} to {most} s", window)
    time, frequency, levels = _levels(values, interval, size, reference(signal))
    heights = [1.0] if run is None else [0.6, 1.6, 0.35]
    figure = Figure(figsize=(9.0, 1.2 + 2.4 * sum(heights)), layout="constrained", dpi=120)
    panels = figure.subplots(len(heights), 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    middle = panels[len(heights) // 2]
    start = float(signal["time"][0])
    drawn = middle.pcolormesh(
        start + time,
        frequency / 1e3,
        levels,
        cmap="magma",
        vmax=levels.max(),
        vmin=levels.max() - dynamic_range,
        shading="nearest",
        rasterized=True,
    )
    middle.set_ylim(0.0, min(highest, 0.5 / interval) / 1e3)
    middle.set_ylabel("frequency [kHz]")
    figure.colorbar(drawn, ax=middle, label=f"level [{reference(signal).words}]", pad=0.01)
    if run is not None:
        _draw_contact(panels[0], panels[2], record_of_one(run, "normal_force", "status_share"))
    panels[-1].set_xlim(start, start + (values.size - 1) * interval)
    panels[-1].set_xlabel("time [s]")
    words = title if title is not None else run.attrs.get("title", "") if run is not None else ""
    figure.suptitle(words, fontsize=11)
    return figure


def _levels(values: Array, interval: float, size: int, level: Reference) -> tuple[Array, Array, Array]:
    """Return times [s], frequencies [Hz] and levels [dB] of a signal, a tone at its own level."""
    hop = max(size // 8, values.size // COLUMNS, 1)
    transform = ShortTimeFFT(hann(size, sym=False), hop, 1.0 / interval, scale_to="magnitude")
    first, last = transform.lower_border_end[1], transform.upper_border_begin(values.size)[1]
    # Only windows inside the signal are used; for a signal as short as one window, the window about its middle.
    first, last = (first, last) if last > first else ((values.size // 2) // hop, (values.size // 2) // hop + 1)
    # A tone shares its amplitude with its negative frequency, so that its mean square is twice the square of either.
    squares = 2.0 * np.abs(transform.stft(values, p0=first, p1=last)) ** 2
    return transform.t(values.size, p0=first, p1=last), transform.f, level.decibels(squares)


def _draw_contact(above: Axes, below: Axes, run: xr.Dataset) -> None:
    draw_line(above, run, "normal_force")
    draw_status(below, run, "status")
