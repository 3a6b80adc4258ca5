"""Figures of spectra over a parameter or over time, one behind the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.signal import welch

from ..arrays import Array
from ..checks import ArgumentError, count, finite, listed, positive
from .colours import LINE, LINES
from .sounds import one_signal, reference

HIGHEST, RESOLUTION, RANGE = 16e3, 10.0, 60.0
# Largest number of lines labelled with their value.
MOST_WORDS = 30
# Default number of pieces of one signal, and largest number of spectra in a figure.
PIECES, MOST = 24, 100
# Height of the range of levels, relative to the distance between spectra.
OVERLAP = 2.0
# Values that differ by less than this share of the distance count as the same.
SAME = 1e-6
GROWS = LINES[1]
# Smallest number of samples for a spectrum.
FEWEST = 16


def waterfall(
    signals: xr.DataArray | Mapping[float, xr.DataArray],
    theory: xr.Dataset | Mapping[float, xr.Dataset] | None = None,
    *,
    parameter: str = "",
    highest: float = HIGHEST,
    resolution: float = RESOLUTION,
    dynamic_range: float = RANGE,
    pieces: int = PIECES,
    title: str = "",
) -> Figure:
    """Draw spectra over a parameter, or over the time of one signal: a line for each, one behind the other.

    A pure tone shows its own level, in dB re 20 µPa for a sound pressure and in dB re its unit for other signals. The
    base of each line is at its value on the axis of the parameter, at a level `dynamic_range` below the loudest of all;
    a bar shows the height of 20 dB. Modes that grow by linear theory are marked on the line of their value.

    Parameters
    ----------
    signals : xarray.DataArray or mapping
        Signals over ``time`` by the value of the parameter; a DataArray of them over ``time`` and a dimension of
        numbers; or one signal over ``time``, which is cut into pieces.
    theory : xarray.Dataset or mapping, optional
        Modes that grow: result of `root_loci` over the parameter, results of `sliding_stability` by the value of the
        parameter, or one such result for all spectra.
    parameter : str, optional
        Label of the parameter with its unit, such as ``friction [1]``; name and unit of the dimension if left out.
    highest : float, optional
        Upper end of the frequency axis [Hz], at most half the sample rate.
    resolution : float, optional
        Frequency spacing [Hz], at least the inverse of the duration of the signal.
    dynamic_range : float, optional
        Range of the levels [dB], below the loudest.
    pieces : int, optional
        Number of pieces into which one signal is cut.
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If an argument is out of its range, values are not numbers or fewer than 2, or signals differ in unit or rate.

    Examples
    --------
    >>> import stridula as st
    >>> values = [0.8, 1.0, 1.2, 1.4]
    >>> runs = {mu: st.load_scenario("squeal", {"friction": mu, "duration": 0.2}).simulate() for mu in values}
    >>> forces = {mu: run.normal_force for mu, run in runs.items()}
    >>> figure = st.plot.waterfall(forces, parameter="friction [1]", highest=5e3)
    """
    for name, value in (("highest", highest), ("resolution", resolution), ("dynamic_range", dynamic_range)):
        positive(name, value)
    given, label = _named(signals, count("pieces", pieces, low=2, high=MOST))
    spectra = _spectra(given, highest, resolution)
    figure = Figure(figsize=(9.0, float(np.clip(2.4 + 0.22 * len(given), 4.0, 10.0))), layout="constrained", dpi=120)
    axes = figure.subplots()
    _draw(axes, spectra, dynamic_range)
    if theory is not None:
        _draw_growing(axes, theory, spectra, dynamic_range)
    # The last frequency lies less than one spacing below the end.
    axes.set_xlim(0.0, min(highest, spectra.frequency[-1] + spectra.frequency[0]) / 1e3)
    axes.set_xlabel("frequency [kHz]")
    axes.set_ylabel(parameter or label)
    axes.set_title(title, fontsize=11)
    axes.grid(axis="x", alpha=0.3, linewidth=0.5)
    return figure


@dataclass(frozen=True)
class _Spectra:
    """Levels of spectra by value.

    Attributes
    ----------
    values : ndarray, shape (spectra,)
        Values of the parameter, rising.
    frequency : ndarray, shape (frequencies,)
        Frequencies [Hz].
    levels : ndarray, shape (spectra, frequencies)
        Levels [dB].
    words : str
        Unit of the levels.
    """

    values: Array
    frequency: Array
    levels: Array
    words: str

    @property
    def step(self) -> float:
        """Mean distance of the values."""
        return float(np.ptp(self.values)) / (self.values.size - 1)

    def heights(self, dynamic_range: float) -> Array:
        """Return the height of each level above its value, a range [dB] below the loudest, (spectra, levels)."""
        above = self.levels - self.levels.max() + dynamic_range
        return np.asarray(OVERLAP * self.step / dynamic_range * np.maximum(above, 0.0))

    def at(self, value: float, frequency: float, dynamic_range: float) -> float:
        """Return the place of a frequency [Hz] on the spectrum of a value; on its base if there is no spectrum."""
        (row,) = np.nonzero(np.isclose(self.values, value, rtol=0.0, atol=SAME * self.step))
        if not row.size:
            return value
        return value + float(np.interp(frequency, self.frequency, self.heights(dynamic_range)[row[0]]))


def _named(signals: Any, pieces: int) -> tuple[dict[float, xr.DataArray], str]:
    """Return the signals by value, rising, and the label of their axis."""
    if hasattr(signals, "dims"):
        named, label = _of_array(signals, pieces)
    elif hasattr(signals, "items"):
        named, label = dict(signals.items()), "parameter"
    else:
        raise ArgumentError("signals", "be a DataArray over time, or DataArrays by the value of a parameter", signals)
    if not 2 <= len(named) <= MOST:
        raise ArgumentError("signals", f"have from 2 to {MOST} values", signals, got=len(named))
    found = {finite(f"signals[{value!r}]", value): one for value, one in named.items()}
    return dict(sorted(found.items())), label


def _of_array(signals: xr.DataArray, pieces: int) -> tuple[dict[Any, xr.DataArray], str]:
    others = [str(name) for name in signals.dims if name != "time" and signals.sizes[name] > 1]
    if "time" not in signals.dims or len(others) > 1:
        raise ArgumentError("signals", "be over time, or over time and one parameter", signals, got=listed(others))
    if not others:
        whole = signals.squeeze([name for name in signals.dims if name != "time"])
        size = whole.sizes["time"] // pieces
        if size < FEWEST:
            words = f"leave at least {FEWEST} samples in each section"
            raise ArgumentError("pieces", words, pieces, got=f"{pieces} of {whole.sizes['time']} samples")
        parts = [whole.isel(time=slice(k * size, (k + 1) * size)) for k in range(pieces)]
        return {float(one["time"].mean()): one for one in parts}, "time [s]"
    (key,) = others
    if key not in signals.coords or signals[key].dtype.kind not in "fiu":
        raise ArgumentError("signals", f"have numbers along {key}", signals, got="none")
    units = str(signals[key].attrs.get("units", ""))
    named = {value: signals.sel({key: value}) for value in signals[key].values.tolist()}
    return named, f"{key} [{units}]" if units else key


def _spectra(signals: Mapping[float, xr.DataArray], highest: float, resolution: float) -> _Spectra:
    """Return the levels of signals up to a frequency, a tone at its own level."""
    sampled = {value: one_signal(one) for value, one in signals.items()}
    intervals = {round(one, 15) for _, one in sampled.values()}
    units = {reference(one).words for one in signals.values()}
    for name, found in (("sample interval", intervals), ("unit", units)):
        if len(found) > 1:
            raise ArgumentError("signals", f"have one {name}", signals, got=listed(map(str, sorted(found))))
    interval = intervals.pop()
    shortest = min(values.size for values, _ in sampled.values())
    size = min(shortest, round(1.0 / (resolution * interval)))
    if size < FEWEST:
        raise ArgumentError("signals", f"have at least {FEWEST} samples for a spectrum", signals, got=size)
    level, rows = reference(next(iter(signals.values()))), []
    for values, _ in sampled.values():
        frequency, power = welch(values, 1.0 / interval, nperseg=size, detrend="constant", scaling="spectrum")
        rows.append(level.decibels(power))
    # At frequency 0 only a residue of the mean is left.
    kept = (frequency > 0.0) & (frequency <= highest)
    if np.count_nonzero(kept) < 2:
        raise ArgumentError("highest", f"be at least {2.0 * float(frequency[1]):.4g} Hz at this resolution", highest)
    return _Spectra(np.array(list(signals)), frequency[kept], np.array(rows)[:, kept], level.words)


def _draw(axes: Axes, spectra: _Spectra, dynamic_range: float) -> None:
    """Draw the spectra, those in front hiding those behind."""
    top = float(spectra.levels.max())
    scale, heights = OVERLAP * spectra.step / dynamic_range, spectra.heights(dynamic_range)
    kilohertz = spectra.frequency / 1e3
    every = -(-spectra.values.size // MOST_WORDS)
    for number, (value, height) in enumerate(zip(spectra.values, heights, strict=True)):
        # Spectra with low values are in front.
        order = 2.0 + spectra.values.size - number
        axes.fill_between(kilohertz, value, value + height, facecolor="white", linewidth=0.0, zorder=order)
        axes.axhline(value, color="0.85", linewidth=0.6, zorder=order)
        axes.plot(kilohertz, value + height, color=LINE, linewidth=0.8, zorder=order)
        if number % every == 0:
            at = (kilohertz[-1], value + height[-1])
            look: dict[str, Any] = {"textcoords": "offset points", "fontsize": 7, "color": "0.25"}
            axes.annotate(f"{value:.4g}", at, (5, 0), ha="left", va="center", **look)
    highest = float((spectra.values[:, None] + heights).max())
    axes.set_ylim(spectra.values[0] - 0.5 * spectra.step, highest + 0.5 * spectra.step)
    low, high = axes.get_ylim()
    share = scale * 20.0 / (high - low)
    axes.plot([1.05, 1.05], [0.05, 0.05 + share], color="black", linewidth=2.0, transform=axes.transAxes, clip_on=False)
    words = f"20 dB; the highest is {top:.1f} {spectra.words}"
    axes.text(1.06, 0.05, words, fontsize=8, rotation=90, va="bottom", transform=axes.transAxes)


def _draw_growing(axes: Axes, theory: Any, spectra: _Spectra, dynamic_range: float) -> None:
    """Mark the modes that grow: on the spectra of their values, or through all spectra."""
    front = 3.0 + spectra.values.size
    if _is_one(theory):
        found: list[Any] = [one for one in _growing(theory) if one <= spectra.frequency[-1]]
        for number, frequency in enumerate(found):
            look: dict[str, Any] = {} if number else {"label": "grows by linear theory"}
            axes.axvline(frequency / 1e3, color=GROWS, linewidth=1.0, linestyle="--", zorder=front, **look)
    else:
        low, high = axes.get_ylim()
        every = [(f / 1e3, value) for value, one in _by_value(theory) for f in _growing(one)]
        shown = [(f, value) for f, value in every if 1e3 * f <= spectra.frequency[-1] and low <= value <= high]
        found = [(f, spectra.at(value, 1e3 * f, dynamic_range)) for f, value in shown]
        if found:
            ring: dict[str, Any] = {"markerfacecolor": "none", "markeredgewidth": 1.3, "linestyle": "none"}
            x, y = np.array(found).T
            axes.plot(x, y, "o", color=GROWS, markersize=5.5, label="grows by linear theory", zorder=front, **ring)
    if found:
        axes.legend(fontsize=8, loc="upper right").set_zorder(front + 1.0)


def _is_one(theory: Any) -> bool:
    return hasattr(theory, "data_vars") and "frequency" in theory and theory["frequency"].dims == ("mode",)


def _by_value(theory: Any) -> list[tuple[float, xr.Dataset]]:
    """Return the theory of each value."""
    if hasattr(theory, "data_vars"):
        if not {"frequency", "unstable", "equilibrium"} <= set(theory.data_vars) or theory["equilibrium"].ndim != 1:
            raise ArgumentError("theory", "be the result of root_loci or sliding_stability", theory)
        key = theory["equilibrium"].dims[0]
        return [(float(value), theory.sel({key: value})) for value in theory[key].values]
    if not hasattr(theory, "items") or not all(map(_is_one, theory.values())):
        raise ArgumentError("theory", "be the result of root_loci or sliding_stability", theory)
    return [(finite("theory", value), one) for value, one in theory.items()]


def _growing(theory: xr.Dataset) -> list[float]:
    """Return the frequencies of the modes that grow [Hz]."""
    if "unstable" not in theory:
        raise ArgumentError("theory", "be the result of root_loci or sliding_stability", theory)
    found = theory["frequency"].values[theory["unstable"].values.astype(bool)]
    return [float(one) for one in found[found > 0.0]]
