"""Bodies in space as drawn in pictures, films and views: positions and velocities of their corners."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import Array
from ..bodies import BodyPoint
from ..bodies.drawn_surfaces import DrawnSurface, is_drawn
from ..checks import ArgumentError, instance
from ..contact import PointContact
from ..system import System
from .motion import ModalMotion
from .rigid_surfaces import rigid_surfaces

# Cosine between an outward normal and the direction of the eye below which a side is hidden, also in perspective.
AWAY = -0.3


@dataclass(frozen=True)
class ShownBody:
    """A body with a surface.

    Attributes
    ----------
    name : str
        Name of the body.
    surface : DrawnSurface
        Its surface.
    seen : ndarray of bool, shape (polygons,)
        Whether each of its polygons can be seen.
    """

    name: str
    surface: DrawnSurface
    seen: Array


class MovedBodies:
    """Bodies of a system that have a surface, frame by frame.

    Parameters
    ----------
    system : System
        The system.
    motion : ModalMotion
        Motion of its modes.
    exaggeration : float
        Factor by which departures from the mean are drawn larger.
    eye : ndarray, shape (3,)
        Direction of the eye; if zero, all polygons are seen.

    Attributes
    ----------
    bodies : list of ShownBody
        The bodies.
    numbers : list of int
        Numbers of the contacts whose place is known.
    """

    def __init__(self, system: System, motion: ModalMotion, exaggeration: float, eye: Array) -> None:
        self.motion, self.exaggeration, self.bodies = motion, exaggeration, surfaces_of(system, eye)
        self.numbers, self.points = places_of_contacts(system)
        self.mean = {name: values.mean(axis=0) for name, values in motion.displacement.items()}

    @property
    def largest_velocity(self) -> float:
        """Largest velocity across the visible surfaces in all frames [m/s]."""
        return max(
            float(np.abs(self.velocities(one, frame)).max())
            for frame in range(self.motion.frames)
            for one in self.bodies
        )

    def places(self, one: ShownBody, frame: int) -> Array:
        """Return the places of the corners of a body [m], shape (corners, 3)."""
        return np.asarray(one.surface.place + one.surface.shapes @ self._departure(one.name, frame))

    def velocities(self, one: ShownBody, frame: int) -> Array:
        """Return the outward velocities of the visible polygons [m/s], means over their corners."""
        speed = one.surface.shapes @ self.motion.velocity[one.name][frame]
        mean = speed[one.surface.polygons[one.seen]].mean(axis=1)
        return np.asarray(np.einsum("pi,pi->p", mean, one.surface.normals[one.seen]))

    def contacts(self, frame: int) -> Array:
        """Return the places of the contacts whose place is known [m], shape (contacts, 3)."""
        return np.array([one.at(self._departure(one.body, frame)) for one in self.points]).reshape(-1, 3)

    def _departure(self, name: str, frame: int) -> Array:
        """Return the displacement of the modes of a body with its departure from the mean exaggerated."""
        mean = self.mean[name]
        return np.asarray(mean + self.exaggeration * (self.motion.displacement[name][frame] - mean))


@dataclass(frozen=True)
class PlacedContact:
    """Place of a contact, on a body whose place is known.

    Attributes
    ----------
    contact : PointContact
        The contact.
    system : System
        Its system.
    """

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

    @property
    def at_rest(self) -> Array:
        """Place at rest [m], shape (3,)."""
        body: Any = self._end.body
        return np.asarray(body.place(self._end.position))

    def at(self, modal: Array) -> Array:
        """Return the place with the modes displaced [m], shape (3,)."""
        body: Any = self._end.body
        return np.asarray(self.at_rest + body.trace(self._end.position) @ modal)


def places_of_contacts(system: System) -> tuple[list[int], list[PlacedContact]]:
    """Return the numbers and the places of the contacts whose place is known."""
    numbers = [k for k, contact in enumerate(system.contacts) if contact.placed_end is not None]
    return numbers, [PlacedContact(system.contacts[k], system) for k in numbers]


def surfaces_of(system: System, eye: Array, moving: bool = True) -> list[ShownBody]:
    """Return the drawn bodies of a system, with the polygons that face the eye.

    These are the bodies that have a surface, and rigid bodies joined to one of them. With ``moving=False`` the modes of
    the bodies are not computed.
    """
    shown: dict[Any, Any] = {body: body for body in system.bodies if is_drawn(body)}
    surfaces = {body: (one.drawn if moving else one.drawn_at_rest).swept for body, one in shown.items()}
    surfaces |= rigid_surfaces(system, surfaces.values())
    return [
        ShownBody(system.body_name(body), surface, surface.normals @ eye > AWAY) for body, surface in surfaces.items()
    ]


def has_surfaces(system: System) -> bool:
    """Return whether a system has a body with a known surface."""
    instance("system", system, System)
    return any(is_drawn(body) for body in system.bodies)


def check_surfaces(system: System) -> None:
    """Raise ValueError unless a system has a body with a known surface."""
    if not has_surfaces(system):
        kinds = sorted({type(body).__name__ for body in system.bodies})
        words = "have a SolidBody or an AxisymmetricBody, whose surface is drawn"
        raise ArgumentError("system", words, system, got=", ".join(kinds))


def largest_departure(bodies: list[ShownBody], motion: ModalMotion) -> float:
    """Return the largest departure of a place from its mean [m]."""
    largest = 0.0
    for one in bodies:
        moved = motion.displacement[one.name]
        apart = moved - moved.mean(axis=0)
        for row in apart:
            largest = max(largest, float(np.abs(one.surface.shapes @ row).max()))
    return largest


def extent_of(bodies: list[ShownBody]) -> float:
    """Return the largest extent of the drawn bodies [m]."""
    return float(np.ptp(np.concatenate([one.surface.place for one in bodies]), axis=0).max())
