"""Figures of mobilities over frequency: magnitude and phase."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from ..checks import ArgumentError, instance
from .colours import LINES

# Phases that are multiples of a quarter turn: of a spring, of a resonance, of a mass.
QUARTERS = (-180, -90, 0, 90, 180)


def mobility(found: xr.DataArray | Mapping[str, xr.DataArray], *, title: str = "") -> Figure:
    """Draw mobilities over frequency: magnitude above, phase below.

    The scale of frequency is logarithmic. The mobility of a spring rises with frequency, that of a mass falls, and
    resonances are in phase with the force.

    Parameters
    ----------
    found : xarray.DataArray or mapping
        Result of `mobility`, or several of them by label in the legend.
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If it is not a mobility, or has fewer than 2 frequencies.

    Examples
    --------
    >>> import stridula as st
    >>> beam = st.ModalBeam(st.Material(2.1e11, 7800.0), st.Rectangle(0.02, 0.01), 0.8, damping=0.01)
    >>> driving, transfer = st.mobility(beam.centre), st.mobility(beam.at(0.1), beam.centre)
    >>> figure = st.plot.mobility({"centre": driving, "centre to 0.1 m": transfer})
    """
    named = {"": found} if isinstance(found, xr.DataArray) else found
    instance("found", named, Mapping)
    if not named:
        raise ArgumentError("found", "hold at least one mobility", found, got="none")
    for name, one in named.items():
        _check(f"found[{name!r}]" if isinstance(found, Mapping) else "found", one)
    figure = Figure(figsize=(9.0, 5.6), layout="constrained", dpi=120)
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=[2.2, 1.0])
    for number, (label, one) in enumerate(named.items()):
        frequency, values = one["frequency"].values, one.values
        look = {"color": LINES[number % len(LINES)], "linewidth": 1.0, "label": label}
        above.loglog(frequency, np.abs(values), **look)
        below.semilogx(frequency, np.degrees(np.angle(values)), **look)
    above.set_ylabel("magnitude of the mobility\n[m/(N s)]")
    below.set_ylabel("phase [deg]")
    below.set_xlabel("frequency [Hz]")
    below.set_yticks(QUARTERS)
    below.set_ylim(-195.0, 195.0)
    for axes in (above, below):
        axes.grid(alpha=0.3, linewidth=0.5, which="both" if axes is above else "major")
        axes.margins(x=0.0)
    if any(named):
        above.legend(fontsize=8, frameon=False)
    figure.suptitle(title, fontsize=11)
    return figure


def _check(name: str, one: object) -> None:
    if not isinstance(one, xr.DataArray) or one.dims != ("frequency",) or not np.iscomplexobj(one.values):
        raise ArgumentError(name, "be the result of mobility, complex over frequency", one)
    if one.size < 2:
        raise ArgumentError(name, "have at least 2 frequencies", one, got=one.size)
