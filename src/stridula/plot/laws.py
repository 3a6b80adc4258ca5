"""Figures of friction laws."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..arrays import Array
from ..checks import ArgumentError
from ..contact import FrictionLaw
from ..contact.laws import check_friction
from .colours import LINE, LINES


def friction(law: FrictionLaw, velocities: Array | Sequence[float] | None = None) -> Figure:
    """Draw the coefficient of friction of a law over slip velocity, in steady sliding.

    The range of forces that the law can hold at rest is a vertical line, solid for sticking and dotted for bristles.
    Rate and state, which spans decades of speed, is drawn over the logarithm of speed, for forward sliding only.

    Parameters
    ----------
    law : FrictionLaw
        The law, of the package, such as `Coulomb` or `Stribeck`, or a user's own.
    velocities : array_like, optional
        Slip velocities at which to draw it [m/s], of either or both signs; if left out, a range that covers the law.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If an argument is of the wrong type, or there are fewer than 2 velocities.
    """
    check_friction("law", law)
    chosen = np.unique(_shown_range(law) if velocities is None else _velocities(velocities))
    if law.over_decades:
        chosen = chosen[chosen > 0.0]
        if chosen.size < 2:
            raise ArgumentError("velocities", f"be at least 2 above 0 for {law.law}", velocities)
    figure = Figure(figsize=(6.4, 4.2), layout="constrained", dpi=120)
    axes = figure.subplots()
    shades = np.linspace(1.0, 0.3, len(law.sections))
    for one, shade, words in zip(law.sections, shades, _conditions(law), strict=True):
        for side in (chosen[chosen < 0.0], chosen[chosen > 0.0]):
            label = words if side.size and side[-1] == chosen[-1] else None
            values = np.sign(side) * one.coefficient_at(side)
            axes.plot(side, values, color=LINE, alpha=shade, linewidth=1.5, label=label)
    if not law.over_decades:
        _draw_rest(axes, law, chosen)
        axes.axhline(0.0, color="0.6", linewidth=0.6, zorder=0)
    else:
        axes.set_xscale("log")
    axes.set_xlabel("slip velocity [m/s]")
    axes.set_ylabel("tangential over normal force [1]")
    axes.grid(alpha=0.3, linewidth=0.5)
    words = str(law) if str(law)[0].isalpha() else f"{law.law}, {law}"
    axes.set_title(words[0].upper() + words[1:], fontsize=11)
    return figure


def _conditions(law: FrictionLaw) -> list[str | None]:
    """Return temperature or place, and pressure, of each section of a law in words, none without either."""
    if law.at_values:
        return [
            f"{value:.4g} {getattr(law, 'unit', '')}" + ("" if words is None else f", {words}")
            for value, one in law.at_values
            for words in _conditions(one)
        ]
    given = getattr(law, "pressure", None)
    return [None] if given is None else [f"{one:.3g} Pa" for one in given]


def _velocities(given: Array | Sequence[float]) -> Array:
    try:
        values = np.asarray(given, dtype=float)
    except (TypeError, ValueError):
        values = np.empty(0)
    if values.ndim != 1 or values.size < 2 or not np.isfinite(values).all():
        raise ArgumentError("velocities", "be a list of at least 2 finite numbers", given)
    return values


def _shown_range(law: FrictionLaw) -> Array:
    """Return velocities that cover the whole characteristic of a law."""
    if law.over_decades:
        return law.reach * np.geomspace(1e-8, 1.0, 401)
    # Points are dense near rest, where most laws fall.
    forward = law.reach * np.linspace(0.0, 1.0, 401)[1:] ** 2
    return np.concatenate([-forward, forward])


def _draw_rest(axes: Axes, law: FrictionLaw, velocities: Array) -> None:
    """Draw the range that a law can hold at rest, if the velocities include rest."""
    if velocities[0] > 0.0 or velocities[-1] < 0.0:
        return
    style, words = ("-", "sticking") if law.set_valued else (":", "bristles hold")
    ends = [-law.holding if velocities[0] < 0.0 else 0.0, law.holding if velocities[-1] > 0.0 else 0.0]
    axes.plot([0.0, 0.0], ends, color=LINES[1], linewidth=1.5, linestyle=style, label=words)
    axes.legend(fontsize=8, frameon=False, loc="upper left")
