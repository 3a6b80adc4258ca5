"""Bodies in space in perspective: their surfaces, coloured by the velocity across them, and where they touch."""

from __future__ import annotations

from dataclasses import dataclass
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
from ..bodies import BodyPoint
from ..bodies.drawn_surfaces import DrawnSurface, is_drawn
from ..cards import eye_of
from ..checks import STATUS_WORDS, ArgumentError, finite, instance
from ..contact import PointContact
from ..system import System
from .colours import STATUS_COLOURS
from .motion import ModalMotion
from .rigid_surfaces import rigid_surfaces

VELOCITIES = "RdBu_r"
# Of units of velocity, and what they stand for.
PREFIXES = (("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9))
# Darkest a side that turns away from the light gets.
DARK = 0.72
# Cosine between an outward normal and the direction of the eye below which a side is not seen, perspective included.
AWAY = -0.3
# Share of the room that bodies at rest fill.
FILLED = 0.92
MARKER = 3.5
# Radius of the ball of a rigid body without points round it, as a share of the extent of the others.
BALL = 0.03


@dataclass(frozen=True)
class _Body:
    """A body with a surface: its name, the surface, and which of its polygons can be seen."""

    name: str
    surface: DrawnSurface
    seen: Array


class Scene:
    """The bodies of a system that have a surface, in perspective, to be drawn frame by frame.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        The figure.
    room : tuple of float
        Where in it: left and lower edge, width and height, shares of the figure.
    system : System
        The system.
    motion : ModalMotion
        Motion of its modes.
    exaggeration : float
        How many times larger than life departures from the mean are drawn.
    view : tuple of float
        Elevation and azimuth of the eye [rad].

    Attributes
    ----------
    axes : mpl_toolkits.mplot3d.axes3d.Axes3D
        The axes.
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
        eye = eye_of(view)
        self._figure, self._room = figure, room
        self.motion, self.exaggeration, self.bodies = motion, exaggeration, surfaces_of(system, eye)
        self.points = [_Place(contact, system) for contact in system.contacts if contact.placed_end is not None]
        self.numbers = [k for k, contact in enumerate(system.contacts) if contact.placed_end is not None]
        self.mean = {name: values.mean(axis=0) for name, values in motion.displacement.items()}
        self.axes = _axes_in_space(figure, room)
        light = eye_of((view[0] + 0.5, view[1] - 0.5))
        normals = np.concatenate([one.surface.normals[one.seen] for one in self.bodies])
        self._shade = DARK + (1.0 - DARK) * np.clip(normals @ light, 0.0, 1.0)
        self.scale = Normalize(-1.0, 1.0)
        self.sides: Any = Poly3DCollection(self._polygons(0), linewidths=0.15, edgecolors="0.45", zorder=1)
        # The axes are a square in the middle of their room, which may be wider.
        self.sides.set_clip_on(False)
        self.axes.add_collection3d(self.sides)
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
        self._set_view(view)

    @property
    def largest_velocity(self) -> float:
        """Largest velocity across the surfaces that are seen, of all frames [m/s]."""
        return max(float(np.abs(self._velocities(frame)).max()) for frame in range(self.motion.frames))

    def colour_bar(
        self, axes: Axes, largest: float, words: str = "velocity out of the surface", unit: str = "m/s"
    ) -> None:
        """Have colours go up to a velocity, and say so, with a prefix to its unit that leaves short numbers."""
        largest = largest or 1.0
        self.scale = Normalize(-largest, largest)
        prefix, size = next((one for one in PREFIXES if largest >= one[1]), PREFIXES[-1])
        shown = ScalarMappable(Normalize(-largest / size, largest / size), VELOCITIES)
        self._figure.colorbar(shown, cax=axes).set_label(f"{words} [{prefix}{unit}]", fontsize=9)
        axes.tick_params(labelsize=8)

    def fill(self) -> None:
        """Draw the bodies as large as the room lets them be."""
        self._figure.draw_without_rendering()
        places = np.concatenate([one.surface.place for one in self.bodies])
        x, y, _ = proj3d.proj_transform(*places.T, self.axes.get_proj())
        drawn = self.axes.transData.transform(np.stack([x, y], axis=1))
        at = self._figure.transFigure.inverted().transform(drawn)
        left, low, width, height = self._room
        reach = np.abs(at - [left + 0.5 * width, low + 0.5 * height]).max(axis=0)
        zoom = FILLED * 0.5 * float((np.array([width, height]) / reach).min())
        self.axes.set_box_aspect(self._sides, zoom=zoom)

    def show(self, frame: int, status: Array | None = None) -> None:
        """Draw a frame; `status` is that of each contact, of which none is drawn without."""
        self.sides.set_verts(self._polygons(frame))
        self.values = self._velocities(frame)
        colours = colormaps[VELOCITIES](self.scale(self.values))
        colours[:, :3] *= self._shade[:, None]
        self.sides.set_facecolor(colours)
        if status is None:
            return
        places = np.array([one.at(self._departure(one.body, frame)) for one in self.points]).reshape(-1, 3)
        for number, word in enumerate(STATUS_WORDS):
            self.markers[word].set_data_3d(*places[status[self.numbers] == number].T)

    def _departure(self, name: str, frame: int) -> Array:
        """Return the displacement of the modes of a body with what departs from the mean exaggerated."""
        mean = self.mean[name]
        return np.asarray(mean + self.exaggeration * (self.motion.displacement[name][frame] - mean))

    def _polygons(self, frame: int) -> Array:
        found = []
        for one in self.bodies:
            place = one.surface.place + one.surface.shapes @ self._departure(one.name, frame)
            found.append(place[one.surface.polygons[one.seen]])
        most = max(corners.shape[1] for corners in found)
        # All with as many corners: drawn at once they hide each other as they should.
        return np.concatenate([np.pad(one, ((0, 0), (0, most - one.shape[1]), (0, 0)), mode="edge") for one in found])

    def _velocities(self, frame: int) -> Array:
        """Return the velocities out of the polygons that are seen [m/s], means over their corners."""
        found = []
        for one in self.bodies:
            speed = one.surface.shapes @ self.motion.velocity[one.name][frame]
            mean = speed[one.surface.polygons[one.seen]].mean(axis=1)
            found.append(np.einsum("pi,pi->p", mean, one.surface.normals[one.seen]))
        return np.concatenate(found)

    def _set_view(self, view: tuple[float, float]) -> None:
        places = np.concatenate([one.surface.place for one in self.bodies])
        low, high = places.min(axis=0), places.max(axis=0)
        margin = 0.03 * float((high - low).max())
        low, high = low - margin, high + margin
        self.axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
        self.axes.view_init(*np.degrees(view), vertical_axis="y")
        self._sides = tuple((high - low).tolist())
        self.axes.set_box_aspect(self._sides)
        self.axes.set_axis_off()


@dataclass(frozen=True)
class _Place:
    """Where a contact is: a place of a body whose place is known."""

    contact: PointContact
    system: System

    @property
    def _end(self) -> BodyPoint:
        end = self.contact.placed_end
        assert end is not None
        return end

    @property
    def body(self) -> str:
        """Name of the body."""
        return self.system.body_name(self._end.body)

    def at(self, modal: Array) -> Array:
        """Return where it is, with its modes displaced [m], shape (3,)."""
        body: Any = self._end.body
        return np.asarray(body.place(self._end.position) + body.trace(self._end.position) @ modal)


def surfaces_of(system: System, eye: Array) -> list[_Body]:
    """Return the bodies of a system that are drawn, and which of their polygons face the eye.

    Those that have a surface, and rigid bodies that are joined to one of them.
    """
    surfaces = {body: body.drawn.swept for body in system.bodies if is_drawn(body)}
    places = np.concatenate([surface.place for surface in surfaces.values()])
    surfaces |= rigid_surfaces(system, BALL * float(np.ptp(places, axis=0).max()))
    return [_Body(system.body_name(body), surface, surface.normals @ eye > AWAY) for body, surface in surfaces.items()]


def has_surfaces(system: System) -> bool:
    """Return whether a system has bodies whose surface is known."""
    instance("system", system, System)
    return any(is_drawn(body) for body in system.bodies)


def check_surfaces(system: System) -> None:
    """Raise ValueError unless a system has a body whose surface is known."""
    if not has_surfaces(system):
        kinds = sorted({type(body).__name__ for body in system.bodies})
        words = "have a SolidBody or an AxisymmetricBody, whose surface is drawn"
        raise ArgumentError("system", words, system, got=", ".join(kinds))


def largest_departure(bodies: list[_Body], motion: ModalMotion) -> float:
    """Return the largest departure of a place from its mean [m]."""
    largest = 0.0
    for one in bodies:
        moved = motion.displacement[one.name]
        apart = moved - moved.mean(axis=0)
        for row in apart:
            largest = max(largest, float(np.abs(one.surface.shapes @ row).max()))
    return largest


def extent_of(bodies: list[_Body]) -> float:
    """Return the largest extent of what is drawn [m]."""
    return float(np.ptp(np.concatenate([one.surface.place for one in bodies]), axis=0).max())


def checked_view(view: Any) -> tuple[float, float]:
    """Return elevation and azimuth as two finite numbers."""
    if not isinstance(view, (tuple, list)) or len(view) != 2:
        raise ArgumentError("view", "be an elevation and an azimuth [rad]", view)
    return finite("view[0]", view[0]), finite("view[1]", view[1])


def _axes_in_space(figure: Figure, room: tuple[float, float, float, float]) -> Any:
    return figure.add_axes(room, projection="3d", computed_zorder=False)
