"""Bodies in space in perspective: surfaces coloured by their outward velocity, and contacts."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import proj3d
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from ..arrays import Array
from ..cards import eye_of
from ..checks import STATUS_WORDS, ArgumentError, within_a_turn
from ..system import System
from .colours import STATUS_COLOURS
from .motion import ModalMotion
from .moved_bodies import MovedBodies, ShownBody

VELOCITIES = "RdBu_r"
# Prefixes of units of velocity, and their factors.
PREFIXES = (("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9))
# Brightness of a side that faces away from the light.
DARK = 0.72
# Share of the available area that bodies at rest fill, and rounds in the search for the zoom.
FILLED, ROUNDS = 0.92, 3
MARKER = 3.5


class Stage:
    """Axes in space for polygons in perspective, as large at rest as their area in a figure allows.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    room : tuple of float
        Area in the figure: left and lower edge, width and height, as shares of the figure.
    bodies : list of ShownBody
        Bodies to draw.
    view : tuple of float
        Elevation and azimuth of the eye [rad].

    Attributes
    ----------
    axes : mpl_toolkits.mplot3d.axes3d.Axes3D
        The axes.
    shade : ndarray, shape (polygons,)
        Brightness of the visible polygons, body by body.
    """

    def __init__(
        self,
        figure: Figure,
        room: tuple[float, float, float, float],
        bodies: list[ShownBody],
        view: tuple[float, float],
    ) -> None:
        self._figure, self._room, self.bodies = figure, room, bodies
        self.axes = _axes_in_space(figure, room)
        light = eye_of((view[0] + 0.5, view[1] - 0.5))
        normals = np.concatenate([one.surface.normals[one.seen] for one in bodies])
        self.shade = DARK + (1.0 - DARK) * np.clip(normals @ light, 0.0, 1.0)
        places = np.concatenate([one.surface.place for one in bodies])
        low, high = places.min(axis=0), places.max(axis=0)
        margin = 0.03 * float((high - low).max())
        low, high = low - margin, high + margin
        self.axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
        self.axes.view_init(*np.degrees(view), vertical_axis="y")
        self._sides = tuple((high - low).tolist())
        self.axes.set_box_aspect(self._sides)
        self.axes.set_axis_off()

    def drawn(self, polygons: Array, **look: Any) -> Any:
        """Draw polygons, and return them."""
        sides: Any = Poly3DCollection(polygons, zorder=1, **look)
        # The axes are a square in the middle of their area, which may be wider.
        sides.set_clip_on(False)
        self.axes.add_collection3d(sides)
        return sides

    def polygons(self, places: list[Array]) -> Array:
        """Return the visible polygons of all bodies at places."""
        found = [place[one.surface.polygons[one.seen]] for one, place in zip(self.bodies, places, strict=True)]
        most = max(corners.shape[1] for corners in found)
        # All get the same number of corners: polygons hide each other correctly only if drawn at once.
        return np.concatenate([np.pad(one, ((0, 0), (0, most - one.shape[1]), (0, 0)), mode="edge") for one in found])

    def seen_at(self, places: Array) -> Array:
        """Return the positions of places in the figure, as shares of it, shape (places, 2)."""
        x, y, _ = proj3d.proj_transform(*places.T, self.axes.get_proj())
        drawn = self.axes.transData.transform(np.stack([x, y], axis=1))
        return np.asarray(self._figure.transFigure.inverted().transform(drawn))

    def fill(self) -> None:
        """Draw the bodies as large as their area allows."""
        self._figure.draw_without_rendering()
        at = self.seen_at(np.concatenate([one.surface.place for one in self.bodies]))
        left, low, width, height = self._room
        reach = np.abs(at - [left + 0.5 * width, low + 0.5 * height]).max(axis=0)
        zoom = FILLED * 0.5 * float((np.array([width, height]) / reach).min())
        self.axes.set_box_aspect(self._sides, zoom=zoom)

    def fill_with(self, places: Array) -> None:
        """Draw places as large as the area allows, in its middle."""
        left, low, width, height = self._room
        corner, room, zoom = np.array([left, low]), np.array([width, height]), 1.0
        # In perspective, sizes are not exactly proportional to the zoom.
        for _ in range(ROUNDS):
            self._figure.draw_without_rendering()
            at = self.seen_at(places)
            zoom *= FILLED * float((room / np.ptp(at, axis=0)).min())
            self.axes.set_box_aspect(self._sides, zoom=zoom)
        self._figure.draw_without_rendering()
        at = self.seen_at(places)
        moved = corner + 0.5 * room - 0.5 * (at.min(axis=0) + at.max(axis=0))
        self.axes.set_position((*(corner + moved).tolist(), width, height))


class Scene(Stage):
    """Bodies of a system that have a surface, in perspective, to be drawn frame by frame.

    Parameters
    ----------
    figure, room, view : Figure and tuples of float
        As of `Stage`.
    system : System
        The system.
    motion : ModalMotion
        Motion of its modes.
    exaggeration : float
        Factor by which departures from the mean are drawn larger.

    Attributes
    ----------
    sides : Poly3DCollection
        The polygons of all bodies.
    markers : dict
        Line of the contact points in each status.
    """

    def __init__(
        self,
        figure: Figure,
        room: tuple[float, float, float, float],
        system: System,
        motion: ModalMotion,
        exaggeration: float,
        view: tuple[float, float],
    ) -> None:
        self.moved = MovedBodies(system, motion, exaggeration, eye_of(view))
        super().__init__(figure, room, self.moved.bodies, view)
        self.scale = Normalize(-1.0, 1.0)
        self.sides: Any = self.drawn(self._polygons(0), linewidths=0.15, edgecolors="0.45")
        self.markers: dict[str, Any] = {
            word: self.axes.plot(
                [],
                [],
                [],
                "o",
                linestyle="none",
                markersize=MARKER,
                color=colour,
                markeredgecolor="black",
                zorder=2,
                markeredgewidth=0.4,
                label=word,
                clip_on=False,
            )[0]
            for word, colour in STATUS_COLOURS.items()
        }

    def colour_bar(
        self, axes: Axes, largest: float, words: str = "velocity out of the surface", unit: str = "m/s"
    ) -> None:
        """Scale the colours to a velocity and draw their bar, with a unit prefix that keeps the numbers short."""
        largest = largest or 1.0
        self.scale = Normalize(-largest, largest)
        prefix, size = next((one for one in PREFIXES if largest >= one[1]), PREFIXES[-1])
        shown = ScalarMappable(Normalize(-largest / size, largest / size), VELOCITIES)
        self._figure.colorbar(shown, cax=axes).set_label(f"{words} [{prefix}{unit}]", fontsize=9)
        axes.tick_params(labelsize=8)

    def show(self, frame: int, status: Array | None = None) -> None:
        """Draw a frame; `status` is that of each contact, and without it no contact is drawn."""
        self.sides.set_verts(self._polygons(frame))
        self.values = np.concatenate([self.moved.velocities(one, frame) for one in self.bodies])
        colours = colormaps[VELOCITIES](self.scale(self.values))
        colours[:, :3] *= self.shade[:, None]
        self.sides.set_facecolor(colours)
        if status is None:
            return
        places = self.moved.contacts(frame)
        for number, word in enumerate(STATUS_WORDS):
            self.markers[word].set_data_3d(*places[status[self.moved.numbers] == number].T)

    def _polygons(self, frame: int) -> Array:
        return self.polygons([self.moved.places(one, frame) for one in self.bodies])


def checked_view(view: Any) -> tuple[float, float]:
    """Return elevation and azimuth, each of at most a turn."""
    if not isinstance(view, (tuple, list)) or len(view) != 2:
        raise ArgumentError("view", "be an elevation and an azimuth [rad]", view)
    return within_a_turn("view[0]", view[0]), within_a_turn("view[1]", view[1])


def _axes_in_space(figure: Figure, room: tuple[float, float, float, float]) -> Any:
    return figure.add_axes(room, projection="3d", computed_zorder=False)
