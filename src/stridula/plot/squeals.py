"""Maps of squeal surveys over two parameters: persistent vibrations, and the bounds of linear theory."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from ..arrays import Array
from ..checks import ArgumentError, instance
from .colours import FAILED_COLOUR, REGIME_COLOURS
from .maps import draw_bound, edges, in_order, name_axis, places_of

NEEDED = ("verdict", "fate", "tone_frequency", "normal_force_rms")
# Colours of points without vibration, by state; the other points are coloured by frequency.
QUIET = {
    "stable": REGIME_COLOURS["stable sliding"],
    "no steady sliding": REGIME_COLOURS["sticking"],
    "unstable, not reached": "#ffffff",
    "unstable, dies": "#f6d6e6",
    "failed": FAILED_COLOUR,
}
LINEAR = ("stable", "unstable")
VIBRATES = ("lives", "joins", "changes")
FREQUENCIES = "viridis"
# Ratio of the highest to the lowest frequency above which the colour scale is logarithmic.
WIDE = 4.0
# Largest number of cells into which the number of living modes is written.
MOST_NUMBERS = 400


def squeal_map(found: xr.Dataset) -> Figure:
    """Draw the vibrations of a survey over two parameters, overlaid with the bounds of linear theory.

    The first parameter is along x. Colours show the frequency of the strongest tone of the run whose normal force
    fluctuates most; numbers count the modes that persist in limit cycles of their own. A thick line bounds the region
    where a mode of linear theory grows; a dashed line bounds the region of steady sliding. Triangles mark stable points
    that a kick lets squeal.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `squeal_survey` for a grid of two parameters.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If it is not a survey over two parameters of at least 2 values each.
    """
    instance("found", found, xr.Dataset)
    if any(name not in found for name in NEEDED) or found["verdict"].ndim != 2 or min(found["verdict"].shape) < 2:
        shape = dict(found["verdict"].sizes) if "verdict" in found else "none"
        raise ArgumentError("found", "be a survey over two parameters of at least 2 values each", found, got=shape)
    across, along = (str(name) for name in found["verdict"].dims)
    found = in_order(in_order(found, across), along)
    figure = Figure(figsize=(8.0, 6.0), layout="constrained", dpi=120)
    axes = figure.subplots()
    x, y = places_of(found, across), places_of(found, along)
    tones, quiet = strongest_tones(found), _quiet(found)
    patches = _draw_quiet(axes, np.where(np.isfinite(tones), len(QUIET), quiet), x, y)
    scale = _scale(tones)
    if scale is not None:
        mesh = axes.pcolormesh(edges(x), edges(y), tones.T, cmap=FREQUENCIES, norm=scale, rasterized=True)
        figure.colorbar(mesh, ax=axes, label="strongest tone [Hz]", format="%g")
    if scale is not None and tones.size <= MOST_NUMBERS:
        _write_numbers(axes, found["living_modes"].values, scale(tones), x, y)
        patches.append(Line2D([], [], linestyle="none", marker="$n$", color="black", label="n modes live"))
    patches += _draw_kicks(axes, found, x, y)
    lines = _draw_bounds(axes, found["verdict"].values, x, y)
    name_axis(axes, found, across, "x")
    name_axis(axes, found, along, "y")
    axes.set_title(str(found.attrs.get("title", "")), fontsize=11)
    figure.legend(handles=[*patches, *lines], loc="outside lower center", ncols=3, fontsize=8, frameon=False)
    return figure


def strongest_tones(found: xr.Dataset) -> Array:
    """Return the frequency of the strongest tone at each point [Hz], NaN where nothing vibrates.

    Parameters
    ----------
    found : xarray.Dataset
        A survey.
    """
    vibrates = np.isin(found["fate"].values.astype(str), VIBRATES)
    tones = np.where(vibrates, found["tone_frequency"].values[..., 0], np.nan)
    level = np.where(np.isfinite(tones), found["normal_force_rms"].values, -1.0)
    if not level.shape[-1]:
        return np.full(level.shape[:-1], np.nan)
    return np.take_along_axis(tones, level.argmax(axis=-1)[..., None], axis=-1)[..., 0]


def _quiet(found: xr.Dataset) -> Array:
    """Return the number in `QUIET` of each point, regardless of vibration."""
    verdict, fates = found["verdict"].values.astype(str), found["fate"].values.astype(str)
    words = list(QUIET)
    quiet = np.full(verdict.shape, words.index("no steady sliding"))
    quiet[verdict == "stable"] = words.index("stable")
    quiet[verdict == "unstable"] = words.index("unstable, not reached")
    quiet[(fates == "dies").any(axis=-1) & ~(fates == "not reached").any(axis=-1)] = words.index("unstable, dies")
    quiet[
        np.isin(verdict, ("not built", "not started")) | (fates == "failed").all(axis=-1) & (verdict == "unstable")
    ] = words.index("failed")
    return quiet


def _draw_quiet(axes: Axes, quiet: Array, x: Array, y: Array) -> list[Any]:
    """Draw the points as if none vibrated, and return the handles of the legend."""
    # Vibrating bodies are drawn over it.
    colours = np.array([_rgb(colour) for colour in (*QUIET.values(), "#ffffff")])
    axes.pcolormesh(edges(x), edges(y), colours[quiet.T], rasterized=True)
    return [
        Patch(facecolor=colour, edgecolor="0.5", linewidth=0.5, label=f"{word} ({np.count_nonzero(quiet == k)})")
        for k, (word, colour) in enumerate(QUIET.items())
        if (quiet == k).any()
    ]


def _rgb(colour: str) -> tuple[float, ...]:
    return tuple(int(colour[k : k + 2], 16) / 255.0 for k in (1, 3, 5))


def _scale(tones: Array) -> Normalize | None:
    """Return the colour scale of frequencies, logarithmic over a wide range; None if there are none."""
    known = tones[np.isfinite(tones)]
    if not known.size:
        return None
    low, high = float(known.min()), float(known.max())
    return (LogNorm if high > WIDE * low else Normalize)(low, high)


def _write_numbers(axes: Axes, living: Array, shade: Array, x: Array, y: Array) -> None:
    for i, j in zip(*np.nonzero(np.isfinite(living) & ~np.ma.getmaskarray(shade) & np.isfinite(shade)), strict=True):
        colour = "white" if shade[i, j] < 0.5 else "black"
        axes.text(x[i], y[j], f"{int(living[i, j])}", ha="center", va="center", fontsize=7, color=colour)


def _draw_kicks(axes: Axes, found: xr.Dataset, x: Array, y: Array) -> list[Line2D]:
    """Mark the stable points that a kick lets squeal, and return the handles of the legend."""
    kicked = np.isfinite(found["kick"].values) if "kick" in found else np.zeros((1, 1), dtype=bool)
    if not kicked.any():
        return []
    i, j = np.nonzero(kicked)
    words = f"stable, squeals after a kick ({i.size})"
    return axes.plot(x[i], y[j], "^", color="none", markeredgecolor="black", markersize=5, label=words)


def _draw_bounds(axes: Axes, verdict: Array, x: Array, y: Array) -> list[Line2D]:
    """Draw the bounds of linear theory, and return the handles of the legend."""
    slides, grows = np.isin(verdict, LINEAR), verdict == "unstable"
    handles = []
    if grows.any():
        words = "linear theory: a mode grows everywhere" if grows.all() else "linear theory: bound of growth"
        handles.append(draw_bound(axes, np.where(slides, grows, np.nan), x, y, "-", words))
    if slides.any() and not slides.all():
        handles.append(draw_bound(axes, slides.astype(float), x, y, "--", "linear theory: bound of steady sliding"))
    return handles
