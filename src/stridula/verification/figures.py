"""The small figure of a case."""

from __future__ import annotations

from matplotlib.figure import Figure

from .case import Case, Sketch

# Okabe & Ito's colours, distinguishable by colour-blind readers; known answers are black.
COLOURS = ("#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00")


def draw(case: Case, sketch: Sketch) -> Figure:
    """Draw the lines and marks of a case in one figure."""
    figure = Figure(figsize=(6.0, 3.4), layout="constrained", dpi=100)
    axes = figure.subplots()
    for number, curve in enumerate(sketch.curves):
        style = {"linestyle": "none", "marker": "o", "markersize": 4.0} if curve.marks else {"linewidth": 1.0}
        axes.plot(curve.x, curve.y, color=COLOURS[number % len(COLOURS)], label=curve.label, **style)
    if sketch.logarithmic:
        axes.set_xscale("log")
        axes.set_yscale("log")
    axes.set_xlabel(sketch.x)
    axes.set_ylabel(sketch.y)
    axes.set_title(case.title, fontsize=10)
    axes.grid(alpha=0.3, linewidth=0.5)
    if sketch.curves:
        axes.legend(fontsize=8, frameon=False)
    return figure
