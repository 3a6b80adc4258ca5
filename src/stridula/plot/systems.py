"""Drawings of systems before their run."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from ..cards import VIEW
from ..checks import instance
from ..system import System
from .plane_drawings import PlaneDrawing
from .scenes import checked_view
from .space_drawings import SpaceDrawing

# Width of the figure, height of the texts above and below the drawing, and smallest and largest height [inches].
WIDTH, AROUND, HEIGHTS = 9.0, 1.5, (3.6, 9.0)
# Largest number of lines in the caption.
MOST_LINES = 7


def system(system: System, *, view: tuple[float, float] = VIEW, title: str = "") -> Figure:
    """Draw a system before its run: bodies, supports, contacts, connections and drives.

    In the plane bodies are to scale, also their thickness, with their supports; contacts are at the axes of beams and
    in the middle planes of plates. Each contact has its normal and its direction of sliding; there are forces and
    velocities with their values, springs and dashpots, gravity and rigid tracks. In space bodies are in perspective,
    with the same arrows. All arrows have the same length, and nearby things that are alike are drawn once. A direction
    of sliding without a speed is that in which forces push the tip. No modes are computed, however large the bodies.

    Parameters
    ----------
    system : System
        The system.
    view : tuple of float, optional
        In space, elevation of the eye above the plane across y and its azimuth from z towards x [rad].
    title : str, optional
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        Save it with `save`.

    Raises
    ------
    ValueError
        If it is not a system, or a system in space without a body that has a surface.

    Examples
    --------
    >>> import stridula as st
    >>> figure = st.plot.system(st.load_scenario("belt").system, title="Stick-slip on a belt")
    """
    instance("system", system, System)
    seen = checked_view(view)
    if system.is_spatial:
        return SpaceDrawing(system, seen, title).figure
    figure = Figure(figsize=(WIDTH, 6.0), layout="constrained", dpi=120)
    drawing = PlaneDrawing(figure.subplots(), system)
    figure.set_figheight(float(np.clip(0.9 * WIDTH * drawing.shape + AROUND, *HEIGHTS)))
    drawing.axes.set_title(caption(drawing.caption), loc="left", fontsize=8)
    figure.legend(handles=drawing.handles, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    figure.suptitle(title, fontsize=11)
    return figure


def caption(lines: Sequence[str]) -> str:
    """Return the first lines of a caption, and the number of others."""
    more = [f"and {len(lines) - MOST_LINES} more"] if len(lines) > MOST_LINES else []
    return "\n".join([*lines[:MOST_LINES], *more])
