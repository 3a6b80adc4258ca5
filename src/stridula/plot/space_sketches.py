"""Sketches in perspective: bodies in a colour each, with arrows, lines and a scale."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ..arrays import Array
from ..cards import eye_of
from .colours import LINES
from .moved_bodies import ShownBody
from .plane_drawings import ALONE, handle, spoken_small
from .reels import DPI, HEIGHT, WIDTH
from .scenes import Stage

ROOM = (0.02, 0.15, 0.96, 0.72)
# Length of the scale as a share of the extent, and tint of bodies.
SCALE, TINT = 0.25, 0.35
MOST_LINES = 6


class SpaceSketch:
    """Sketch of bodies in perspective, each in a colour.

    Parameters
    ----------
    shown : list of ShownBody
        The bodies.
    view : tuple of float
        Elevation and azimuth of the eye [rad].

    Attributes
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    """

    def __init__(self, shown: list[ShownBody], view: tuple[float, float]) -> None:
        self.figure = Figure(figsize=(WIDTH / DPI, HEIGHT / DPI), dpi=DPI)
        self._shown = shown
        self._stage = Stage(self.figure, ROOM, self._shown, view)
        self.axes: Any = self._stage.axes
        places = np.concatenate([one.surface.place for one in self._shown])
        self.low, self.middle = places.min(axis=0), 0.5 * (places.min(axis=0) + places.max(axis=0))
        self.extent = float(np.ptp(places, axis=0).max()) or ALONE
        self._seen, self.caption, self._handles = [places], list[str](), dict[str, Any]()

    def _draw_surfaces(self, words: Sequence[str], width: float = 0.15, edges: str = "0.55") -> None:
        """Draw the bodies, whose words stand in the legend; width and colour are those of the edges of their sides."""
        colours = []
        for number, (one, label) in enumerate(zip(self._shown, words, strict=True)):
            tint = 1.0 - TINT * (1.0 - np.array(to_rgb(LINES[number % len(LINES)])))
            colours.append(np.tile(tint, (int(one.seen.sum()), 1)))
            self._handles[f"body {number}"] = Patch(facecolor=tuple(tint.tolist()), edgecolor="0.4", label=label)
        shades = np.concatenate(colours) * self._stage.shade[:, None]
        places = [one.surface.place for one in self._shown]
        self._stage.drawn(self._stage.polygons(places), facecolors=shades, linewidths=width, edgecolors=edges)

    def _finish(self, title: str) -> None:
        """Draw scale, caption, legend and title."""
        self._draw_scale()
        self._stage.fill_with(np.concatenate(self._seen))
        lines = self.caption[:MOST_LINES]
        lines += [f"and {len(self.caption) - MOST_LINES} more"] if len(self.caption) > MOST_LINES else []
        self.figure.text(0.01, 0.985, "\n".join(lines), fontsize=8, verticalalignment="top")
        handles = list(self._handles.values())
        self.figure.legend(handles=handles, loc="lower center", ncols=3, fontsize=8, frameon=False)
        self.figure.suptitle(title, fontsize=11)

    def _draw_scale(self) -> None:
        """Draw the directions of the world, each as long as a round length."""
        length = 10.0 ** np.floor(np.log10(SCALE * self.extent))
        length *= max(step for step in (1.0, 2.0, 5.0) if step * length <= SCALE * self.extent)
        corner = self.low - 0.25 * length
        for way, name in zip(np.eye(3), "xyz", strict=True):
            self._arrow(corner, corner + length * way, "0.35", "", name, 1.2)
        self._handles["scale"] = handle(f"x, y and z: {spoken_small(length)} each", "0.35")

    def _arrow(
        self, tail: Array, head: Array, colour: str, words: str, label: str, width: float = 1.8, at_tail: bool = False
    ) -> None:
        self._line(np.array([tail, head]), colour, width)
        self._head(head, head - tail, colour)
        if label:
            where = tail + (1.08 if not at_tail else -0.08) * (head - tail)
            box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.5}
            self.axes.text(*where, label, color=colour, fontsize=8, ha="center", va="center", zorder=9, bbox=box)
        if words:
            self._legend(words, colour)

    def _head(self, place: Array, way: Array, colour: str) -> None:
        """Draw the head of an arrow as two strokes in the plane that the eye sees best."""
        way = way / np.linalg.norm(way)
        elevation, azimuth = np.radians(self.axes.elev), np.radians(self.axes.azim)
        side = np.cross(way, eye_of((elevation, azimuth)))
        size = float(np.linalg.norm(side))
        if size > 1e-3:
            reach = 0.025 * self.extent
            wings = [place - reach * (way + sign * 0.45 * side / size) for sign in (1.0, -1.0)]
            self._line(np.array([wings[0], place, wings[1]]), colour, 1.8)

    def _line(self, places: Array, colour: str, width: float, **look: Any) -> None:
        self.axes.plot(*places.T, color=colour, linewidth=width, clip_on=False, zorder=4, **look)
        self._seen.append(places)

    def _dots(self, places: Array, marker: str, colour: str, size: float, **look: Any) -> None:
        style = {"linestyle": "none", "clip_on": False, "zorder": 5}
        self.axes.plot(*places.T, marker=marker, color=colour, markersize=size, **style, **look)

    def _legend(self, words: str, colour: str) -> None:
        self._handles.setdefault(words, handle(words, colour, marker=">", markersize=5, linewidth=1.8))
