"""Pictures of bodies in the plane: lines, the surfaces that they slide on, and their contacts."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.ticker import EngFormatter

from ..arrays import Array
from ..checks import STATUS_WORDS
from ..lines import Line, Touch
from .colours import LINE, STATUS_COLOURS
from .plane_motion import Surface, extent_of

# Thickness of the lines of bodies [points], and diameters of the marks of a single contact and of several contacts.
THICK, MARKER, SMALL_MARKER = 2.5, 8.0, 5.5
TRACK = "0.45"
# Strokes of a surface: distance between them and length along and across the surface, as shares of the picture's
# extent.
STROKES, STROKE = 0.03, 0.012
# Smallest height of a picture, as a share of its width.
LOWEST = 0.3
MARGIN = 0.04


class PlaneScene:
    """The bodies of a system in the plane, to be drawn frame by frame.

    Parameters
    ----------
    axes : Axes
        Axes to draw in.
    lines : list of Line
        The bodies.
    touches : list of Touch
        Places where they touch.
    places : list of ndarray, shape (frames, points, 2)
        World places of the points of each line, as they are drawn [m].
    surfaces : list of Surface, optional
        Surfaces that they slide on.
    exaggeration : float, optional
        Factor by which departures of surfaces are drawn larger.

    Attributes
    ----------
    bodies : list of Line2D
        Line of each body.
    markers : dict
        Line of the contacts in each status.
    frames : int
        Number of frames.
    """

    def __init__(
        self,
        axes: Axes,
        lines: list[Line],
        touches: list[Touch],
        places: list[Array],
        surfaces: list[Surface] | None = None,
        exaggeration: float = 1.0,
    ) -> None:
        self.lines, self.touches, self.places = lines, touches, places
        self.surfaces, self._exaggeration, self.frames = surfaces or [], exaggeration, len(places[0])
        self._draw_swept(axes)
        self._strokes: list[Any] = [
            axes.add_collection(LineCollection([], colors="0.55", linewidths=0.8)) for _ in self.surfaces
        ]
        tips = {one.tip[0] for one in touches}
        # The surface that slides past is drawn instead of these bodies.
        hidden = {one.tip[0] for one in touches if one.touched is not None and one.contact.surface_velocities[0]}
        self.bodies = [
            axes.plot(
                [],
                [],
                color=LINE if number in tips else TRACK,
                linewidth=THICK,
                solid_capstyle="round",
                marker="o" if line.count == 1 and number not in hidden else "",
                markersize=0.5 * SMALL_MARKER,
                zorder=3 if number in tips else 2,
            )[0]
            for number, line in enumerate(lines)
        ]
        size = MARKER if len(touches) == 1 else SMALL_MARKER
        look: dict[str, Any] = {"markeredgecolor": "black", "markeredgewidth": 0.8, "zorder": 4}
        self.markers = {
            word: axes.plot([], [], "o", markersize=size, color=colour, **look)[0]
            for word, colour in STATUS_COLOURS.items()
        }
        self._set_limits(axes)
        axes.set_xlabel("x along the cut through the plate [m]" if any(one.is_cut for one in lines) else "x [m]")
        axes.set_ylabel("y [m]")
        for label in (axes.xaxis.label, axes.yaxis.label):
            label.set_fontsize(8)
        axes.tick_params(labelsize=8)

    def draw_scale(self, axes: Axes, length: float) -> None:
        """Draw a scale bar for a length of the vibration [m] in the lower right corner."""
        (_, right), (low, _) = axes.get_xlim(), axes.get_ylim()
        room = MARGIN * self.extent
        x, y = right - 0.5 * room, low + 0.5 * room
        axes.plot([x, x], [y, y + self._exaggeration * length], color="black", linewidth=2.0, solid_capstyle="butt")
        words = f"vibration of {EngFormatter('m')(length)} "
        axes.text(x - 0.2 * room, y, words, fontsize=8, horizontalalignment="right", verticalalignment="bottom")

    def show(self, frame: int, status: Array | None = None) -> None:
        """Draw a frame; `status` is that of each contact, and without it no contact is drawn."""
        for drawn, line, places in zip(self.bodies, self.lines, self.places, strict=True):
            drawn.set_data(*places[frame, : line.count].T)
        for strokes, surface in zip(self._strokes, self.surfaces, strict=True):
            strokes.set_segments(self._segments(surface, frame))
        if status is None:
            return
        marks = np.array([self._mark(one, frame) for one in self.touches])
        for number, word in enumerate(STATUS_WORDS):
            self.markers[word].set_data(*marks[status == number].T)

    def _mark(self, touch: Touch, frame: int) -> Array:
        """Return where a contact is marked: at the touched point, or else at the sliding tip."""
        line, row = touch.fixed or touch.tip
        found: Array = self.places[line][frame, row]
        return found

    def _segments(self, surface: Surface, frame: int) -> list[Array]:
        """Return a surface as a line with strokes that move along with it."""
        times = self._exaggeration
        place = surface.place[frame] + times * surface.departure[frame]
        low, high = self._ends(surface)
        distance, size = STROKES * self.extent, STROKE * self.extent
        travel = surface.travel[frame] * (times if surface.is_exaggerated else 1.0)
        along = np.arange(math.ceil((low - travel) / distance), (high - travel) / distance) * distance + travel
        strokes = place + along[:, None] * surface.tangent
        # Perpendicular strokes of a surface that slides past several points would look like a ladder.
        slant = size * (surface.outwards - (0.0 if surface.is_exaggerated else surface.tangent))
        return [place + np.outer([low, high], surface.tangent), *np.stack([strokes, strokes + slant], axis=1)]

    def _ends(self, surface: Surface) -> Array:
        """Return the abscissas between which a surface is drawn [m]."""
        if not surface.is_exaggerated:
            return surface.ends
        return surface.ends * self._exaggeration + np.array([-1.0, 1.0]) * MARGIN * self.extent

    def _draw_swept(self, axes: Axes) -> None:
        """Draw the region swept by bodies without a tip, to show how far they move."""
        for number, (line, places) in enumerate(zip(self.lines, self.places, strict=True)):
            if number not in {one.tip[0] for one in self.touches} and line.count > 1:
                x, y = places[:, : line.count].mean(axis=0)[:, 0], places[:, : line.count, 1]
                axes.fill_between(x, y.min(axis=0), y.max(axis=0), color="0.93", linewidth=0.0, zorder=0)

    def _set_limits(self, axes: Axes) -> None:
        self.extent = extent_of(self.places)
        everything = [places.reshape(-1, 2) for places in self.places]
        for surface in self.surfaces:
            ends = np.multiply.outer(self._ends(surface), surface.tangent)
            places = surface.place + self._exaggeration * surface.departure
            everything.append((places[:, None] + ends).reshape(-1, 2))
        low, high = (getattr(np.concatenate(everything), name)(axis=0) for name in ("min", "max"))
        size = (high - low).max() or self.extent
        room = np.maximum(high - low, [LOWEST * size, LOWEST * size]) + 2.0 * MARGIN * size
        middle = 0.5 * (low + high)
        axes.set_xlim(middle[0] - 0.5 * room[0], middle[0] + 0.5 * room[0])
        axes.set_ylim(middle[1] - 0.5 * room[1], middle[1] + 0.5 * room[1])
        axes.set_aspect("equal")
