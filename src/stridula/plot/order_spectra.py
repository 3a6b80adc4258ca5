"""Figures of orders of a vibration over the time of a run-up or a stop."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ..checks import ArgumentError, instance, positive
from .colours import LINE

RANGE = 50.0


def order_spectrum(found: xr.DataArray, *, dynamic_range: float = RANGE, title: str = "") -> Figure:
    """Draw orders over time with the speed of the shaft beside them.

    Colours are levels of effective values below the largest; orders above half of the sample rate are left empty.

    Parameters
    ----------
    found : xarray.DataArray, shape (time, order)
        Result of `analysis.order_spectrum`.
    dynamic_range : float, optional
        Range of the colours [dB], below the largest.
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If `found` is anything else, or has fewer than 2 windows or orders.
    """
    instance("found", found, xr.DataArray)
    if set(found.dims) != {"time", "order"} or "speed" not in found.coords:
        raise ArgumentError("found", "be the result of order_spectrum", found, got=dict(found.sizes))
    positive("dynamic_range", dynamic_range)
    if min(found.shape) < 2:
        raise ArgumentError("found", "have at least 2 windows and orders", got=dict(found.sizes))
    values = found.transpose("time", "order").values
    largest = float(np.nanmax(values)) if np.isfinite(values).any() else 0.0
    if not largest > 0.0:
        raise ArgumentError("found", "have a value above 0", got="none")
    levels = 20.0 * np.log10(np.maximum(values / largest, 1e-15))
    figure = Figure(figsize=(9.0, 5.2), layout="constrained", dpi=120)
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=[3.2, 1.0])
    drawn = left.pcolormesh(
        found["order"].values,
        found["time"].values,
        levels,
        cmap="magma",
        vmin=-dynamic_range,
        vmax=0.0,
        shading="nearest",
        rasterized=True,
    )
    left.set_xlabel("order")
    left.set_ylabel("time [s]")
    units = str(found.attrs.get("units", "1"))
    left.xaxis.set_major_locator(MaxNLocator(integer=True))
    figure.colorbar(drawn, ax=right, label=f"effective value [dB re {largest:.3g} {units}]")
    right.plot(60.0 * found["speed"].values, found["time"].values, color=LINE, linewidth=1.2)
    right.set_xlabel("speed [1/min]")
    right.set_xlim(left=0.0)
    right.grid(alpha=0.3, linewidth=0.5)
    left.set_title(title, fontsize=11)
    return figure
