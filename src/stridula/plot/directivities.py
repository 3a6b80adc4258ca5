"""Levels over the angle around a source."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ..acoustics.levels import equivalent_level, third_octave_levels
from ..acoustics.pressures import positions
from ..arrays import Array
from ..checks import ArgumentError, choice, finite, positive
from .colours import LINES

PLANES = ("xy", "xz", "yz")
RANGE = 40.0


def directivity(
    pressure: xr.DataArray,
    *,
    centre: Sequence[float] = (0.0, 0.0, 0.0),
    plane: str = "xy",
    bands: Sequence[float] = (),
    weighting: str = "Z",
    dynamic_range: float = RANGE,
    title: str = "",
) -> Figure:
    """Draw levels over the angle of listeners around a point, as a polar diagram.

    Parameters
    ----------
    pressure : xarray.DataArray, shape (time, listener)
        Sound pressure [Pa], with the positions of the listeners as coordinates ``x``, ``y``, ``z`` [m].
    centre : sequence of float, shape (3,), optional
        Point around which the angle is taken [m].
    plane : {"xy", "xz", "yz"}, optional
        Plane of the angle, which counts from its first axis to its second.
    bands : sequence of float, optional
        Nominal centres of third-octave bands [Hz], a line for each; if left out, the overall level.
    weighting : {"Z", "A"}, optional
        Weighting of the overall level.
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
        If there are no positions, fewer than 3 listeners off the centre in this plane, or only silence.
    """
    positive("dynamic_range", dynamic_range)
    angles = _angles(pressure, centre, plane)
    lines = {f"{band:g} Hz": _band(pressure, band) for band in bands}
    if not lines:
        lines = {"": equivalent_level(pressure, weighting).values}
    top = 5.0 * np.ceil(max(levels.max() for levels in lines.values()) / 5.0)
    if not np.isfinite(top):
        raise ArgumentError("pressure", "hold a sound", pressure, got="silence")
    figure = Figure(figsize=(6.4, 6.2), layout="constrained", dpi=120)
    axes = figure.add_subplot(projection="polar")
    order = np.argsort(angles)
    # Around a full circle the line is closed; a gap wider than a right angle stays open.
    closed = order[[*range(order.size), 0]] if _goes_round(angles[order]) else order
    for number, (label, levels) in enumerate(lines.items()):
        shown = np.maximum(levels, top - dynamic_range)
        colour = LINES[number % len(LINES)]
        axes.plot(angles[closed], shown[closed], color=colour, linewidth=1.3, marker=".", markersize=4, label=label)
    axes.set_ylim(top - dynamic_range, top)
    axes.set_rlabel_position(100.0)  # type: ignore[attr-defined]
    axes.tick_params(axis="y", labelsize=8)
    words = "band level" if bands else "L" + ("A" if weighting == "A" else "") + "eq"
    axes.set_title(title, fontsize=11)
    axes.set_xlabel(f"angle from {plane[0]} to {plane[1]}; {words} [dB re 20 µPa]", fontsize=9)
    if bands:
        figure.legend(loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def _angles(pressure: xr.DataArray, centre: Sequence[float], plane: str) -> Array:
    choice("plane", plane, PLANES)
    places = positions(pressure)
    if places is None:
        raise ArgumentError("pressure", "have the places of its listeners as coordinates x, y, z", pressure, got="none")
    axes = ["xyz".index(letter) for letter in plane]
    arms = places - np.array([finite(f"centre[{k}]", value) for k, value in enumerate(centre)])
    across, along = arms[:, axes[0]], arms[:, axes[1]]
    if pressure.sizes["listener"] < 3 or not np.hypot(across, along).min() > 0.0:
        raise ArgumentError(
            "pressure",
            f"have at least 3 listeners, off the centre in the plane {plane}",
            pressure,
            got=pressure.sizes["listener"],
        )
    return np.asarray(np.arctan2(along, across) % (2.0 * np.pi))


def _goes_round(angles: Array) -> bool:
    return bool(np.diff(angles, append=angles[0] + 2.0 * np.pi).max() <= 0.5 * np.pi)


def _band(pressure: xr.DataArray, band: float) -> Array:
    return np.asarray(third_octave_levels(pressure, band, band).values[0])
