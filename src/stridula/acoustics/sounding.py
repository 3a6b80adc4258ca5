"""Sound of bodies in space: by their closed surface in open air, as lines of dipoles, or as flat bodies."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

import numpy as np

from ..arrays import Array, in_space
from ..bodies import Modes
from ..bodies.body_surfaces import HIGHEST as FINE_ENOUGH
from ..checks import ArgumentError, listed
from .air import Air
from .delays import Sampling
from .open_surfaces import HIGHEST, Heard, open_surface
from .panels import is_flat
from .responses import Way, way_of
from .slim_beams import SlimBeam, line_along, slim_below

# Frequency up to which a beam must be slim to be a line of dipoles, over that of its highest mode.
BEYOND = 1.2
# Largest distance of parallel flat bodies in one baffle [m], and smallest cosine of the angle between their normals.
LEVEL, PARALLEL = 1e-9, 1.0 - 1e-12


@dataclass(frozen=True)
class Wall:
    """A rigid infinite wall.

    Attributes
    ----------
    origin, normal : ndarray, shape (3,)
        One of its points [m], and its normal towards the listeners.
    """

    origin: Array
    normal: Array

    def check(self, places: Array) -> None:
        """Raise ValueError if one of the places is not in front of it."""
        for place, height in zip(places, self.heights(places), strict=True):
            if height <= 0.0:
                raise ArgumentError("listener", "be in front of the baffle", got=f"{tuple(place.tolist())}")

    def heights(self, places: Array) -> Array:
        """Return the distances of places in front of it [m], negative behind it."""
        return np.asarray((places - self.origin) @ self.normal)

    def images(self, places: Array) -> Array:
        """Return the mirror images of places in it [m]."""
        return np.asarray(places - 2.0 * np.outer(self.heights(places), self.normal))


class Sounding(Protocol):
    """A body in space as a source of sound.

    Attributes
    ----------
    is_line : bool
        Whether it is a line of dipoles.
    """

    is_line: ClassVar[bool]

    @property
    def name(self) -> str:
        """Name of the body."""

    @property
    def most(self) -> float:
        """Largest bandwidth of its sound [Hz]."""

    @property
    def numbers(self) -> Array:
        """Numbers of its modes that sound, shape (modes,)."""

    @property
    def points(self) -> Array:
        """Places on it in the world [m], shape (points, 3)."""

    @property
    def wall(self) -> Wall | None:
        """The baffle with which it is flush, None in open air."""

    def distances(self, places: Array) -> Array:
        """Return the distances of places to it [m]; raise ValueError for places inside it or behind the baffle."""

    def heard(self, moving: Array, places: Array, air: Air, sampling: Sampling) -> Heard:
        """Return its sound at places; `moving` are the numbers of the modes that move."""


@dataclass(frozen=True)
class Flat:
    """A flat body, in a baffle or in open air.

    Attributes
    ----------
    name : str
        Name of the body.
    way : Way
        How it radiates.
    frame : ndarray, shape (3, 3)
        World components of its x, y and z axes.
    corner : ndarray, shape (3,)
        Place in the world where its x, y and z are zero [m].
    """

    is_line: ClassVar[bool] = False
    name: str
    way: Way
    frame: Array
    corner: Array

    @property
    def most(self) -> float:
        """Largest bandwidth of its sound [Hz]."""
        return self.way.most

    @property
    def numbers(self) -> Array:
        """Numbers of the modes that bend it; modes with the same sine along x are adjacent."""
        return np.argsort(self.way.panel.wavenumbers[:, 0], kind="stable")

    @property
    def points(self) -> Array:
        """Its four corners."""
        panel = self.way.panel
        x, y = np.meshgrid([0.0, panel.length], [panel.edge, panel.edge + panel.width])
        return np.asarray(self.corner + np.column_stack([x.ravel(), y.ravel()]) @ self.frame[:2])

    @property
    def wall(self) -> Wall | None:
        """The wall around it, None in open air."""
        return Wall(self.corner, self.frame[2]) if self.way.in_a_wall else None

    def distances(self, places: Array) -> Array:
        """Return the distances to its surface."""
        if self.wall is not None:
            self.wall.check(places)
        return self.way.distances(self._own(places), places)

    def heard(self, moving: Array, places: Array, air: Air, sampling: Sampling) -> Heard:
        """Return the sound of the modes that bend it."""
        bending = self.numbers[np.isin(self.numbers, moving)]
        return self.way.heard(bending, self._own(places), air, sampling) if bending.size else Heard(bending, [])

    def _own(self, places: Array) -> Array:
        return np.asarray((places - self.corner) @ self.frame.T)


def sounding_of(name: str, body: Any, held: bool, origin: Array, baffled: bool, air: Air) -> Sounding:
    """Return a body that has a surface as a source of sound.

    Parameters
    ----------
    name : str
        Its name.
    body : object
        The body.
    held : bool
        Whether its root follows an imposed velocity.
    origin : ndarray, shape (3,)
        Place of its origin in the world [m].
    baffled : bool
        Whether flat bodies are in a baffle.
    air : Air
        The air.
    """
    if is_flat(body) and (baffled or not hasattr(body, "section")):
        way = way_of(body, baffled, name)
        away = np.array([*way.panel.place(np.zeros(())), 0.0])
        return Flat(name, way, body.frame, origin - away @ body.frame)
    modes = body.modes(held)
    if not hasattr(body, "section"):
        return open_surface(name, body.surface(), modes, origin)
    line = line_in_space(name, body, held, origin)
    if is_slim(line, modes, air):
        return line
    surface = body.surface(held_x=True) if held else body.surface()
    # A beam of finite elements may have more modes than its surface resolves.
    return open_surface(name, surface, modes, origin, FINE_ENOUGH)


def line_in_space(name: str, beam: Any, held: bool, origin: Array) -> SlimBeam:
    """Return a beam in space as a line of dipoles, with the modes that bend it."""
    along, across = (in_space(axis) for axis in beam.axes)
    return line_along(name, beam, held, along, across, origin)


def is_slim(line: SlimBeam, modes: Modes, air: Air) -> bool:
    """Return whether a beam is slim at all frequencies of its sound."""
    highest = float(modes.frequency[line.numbers].max(initial=0.0))
    return slim_below(line.body, air) >= min(HIGHEST, BEYOND * highest)


def wall_of(heard: Sequence[Sounding]) -> Wall | None:
    """Return the baffle of bodies, None in open air.

    Raises
    ------
    ValueError
        If flat bodies lie in different planes, or others behind the baffle.
    """
    walls = [one.wall for one in heard if one.wall is not None]
    if not walls:
        return None
    wall = walls[0]
    for other in walls:
        if float(wall.normal @ other.normal) < PARALLEL or abs(float(wall.heights(other.origin))) > LEVEL:
            raise ArgumentError("baffled", "be False where flat bodies do not lie in one plane", got=True)
    behind = [one.name for one in heard if one.wall is None and float(wall.heights(one.points).mean()) < 0.0]
    if behind:
        raise ArgumentError("baffled", f"be False with bodies behind the baffle: {listed(behind)}", got=True)
    return wall
