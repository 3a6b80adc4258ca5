"""A rigid body in space."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Annotated, Any, ClassVar

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError, instance
from ...declared import Name, Number, Own, check_declared
from ...doubtful import doubts_of_size, warn_of
from ..matrix_input import check_finite, numbers
from ..modes import Modes
from ..named_points import NamedPoints
from ..points import BodyPoint
from .point_mass import SMALLEST_MASS

CENTRE = "centre"
# Allowed relative asymmetry of an inertia, and relative excess of a principal moment over the sum of the others.
ROUND_OFF = 1e-9


@dataclass(frozen=True, eq=False)
class RigidBody(NamedPoints):
    """A rigid body that moves freely in space, with small rotations; without an inertia it does not turn.

    Parameters
    ----------
    mass : float
        Mass [kg]; at least 1e-100.
    inertia : float, sequence of float or array_like, shape (3, 3), optional
        Moments of inertia about the centre of mass, along world x, y and z [kg m²]: one for all three, one for each, or
        the symmetric tensor; if left out, the body does not turn.
    points : mapping, optional
        Places of points relative to the centre of mass along world (x, y, z) [m], by name, besides ``"centre"``.
    name : str, optional
        Name in records; distinguishes equal bodies.

    Raises
    ------
    ValueError
        If an argument is out of its range, or no body has such moments of inertia.
    """

    kind: ClassVar[str] = "rigid body"
    has_translation: ClassVar[bool] = True
    is_lumped: ClassVar[bool] = True
    without_surface: ClassVar[str] = "which has no modes that vibrate"
    is_spatial: ClassVar[bool] = True
    mass: Annotated[float, Number("kg", above=0.0)]
    inertia: Annotated[Any, Own("inertia")] = None
    points: Annotated[Mapping[str, Any], Own("points")] = field(default_factory=dict)
    name: Name = ""

    def __post_init__(self) -> None:
        check_declared(self)
        if self.mass < SMALLEST_MASS:
            raise ArgumentError("mass", f"be at least {SMALLEST_MASS:g}", self.mass)
        if self.inertia is not None:
            object.__setattr__(self, "inertia", _tensor(self.inertia))
        instance("points", self.points, Mapping)
        places = {name: _place(name, place) for name, place in self.points.items()}
        object.__setattr__(self, "points", MappingProxyType(places))
        warn_of(doubts_of_size(self.largest_side))

    @property
    def point_names(self) -> tuple[str, ...]:
        """Names of its points."""
        return (CENTRE, *self.points)

    @property
    def largest_side(self) -> float:
        """Largest extent of its points along x, y and z [m]."""
        return float(np.ptp([(0.0, 0.0, 0.0), *self.points.values()], axis=0).max())

    @property
    def centre(self) -> BodyPoint:
        """Its centre of mass."""
        return BodyPoint(self, CENTRE)

    @property
    def axes(self) -> Array:
        """World components of its axes, which are those of the world, shape (3, 3)."""
        return np.eye(3)

    @property
    def total_mass(self) -> float:
        """Mass [kg]."""
        return float(self.mass)

    def modes(self, held_x: bool = False) -> Modes:
        """Return the rigid modes: three of translation, and three about its principal axes if it turns."""
        if held_x:
            raise ArgumentError("held_x", "be False for a RigidBody: it has no driven end", held_x)
        count = 3 if self.inertia is None else 6
        return Modes(np.zeros(count), np.zeros(count), np.eye(3, count) * np.sqrt(self.mass))

    def trace(self, position: str, held_x: bool = False) -> Array:
        """Return the rows that give the displacement of a point from the modes, shape (3, modes)."""
        self.modes(held_x)
        return np.asarray(self.shapes_at(self.offset(position)[None])[0])

    @property
    def has_rotations(self) -> bool:
        """Whether it turns, so that connections may act on its rotations."""
        return self.inertia is not None

    def rotation(self, position: str, held_x: bool = False) -> Array:
        """Return the rows that give the rotation about x, y and z from the modes, shape (3, modes) [rad]."""
        rows = np.zeros((3, self.modes(held_x).count))
        rows[:, 3:] = self._turns.T
        return rows

    def offset(self, position: str) -> Array:
        """Return the place of a point at rest relative to the centre of mass [m], shape (3,)."""
        self.check_position(position)
        return np.zeros(3) if position == CENTRE else np.array(self.points[position])

    def shapes_at(self, offsets: Array) -> Array:
        """Return the displacements for unit modes at places relative to the centre of mass [m], (places, 3, modes)."""
        count = self.modes().count
        rows = np.tile(np.eye(3, count) / np.sqrt(self.mass), (len(offsets), 1, 1))
        if count == 6:
            rows[:, :, 3:] = np.cross(self._turns, offsets[:, None]).transpose(0, 2, 1)
        return rows

    def modal_coordinates(self, vector: Any) -> Array:
        """Return the modal coordinates of displacements [m, rad] or velocities along, then about x, y, z, (modes,)."""
        count = self.modes().count
        values = numbers("vector", vector)
        if values.shape != (count,):
            words = "along x, y, z" if count == 3 else "along, then about x, y, z"
            raise ArgumentError("vector", f"be {count} numbers, {words}", vector, got=values.shape)
        check_finite("vector", values)
        found = np.sqrt(self.mass) * values
        if count == 6:
            moments, axes = self._principal
            found[3:] = np.sqrt(moments) * (axes.T @ values[3:])
        return found

    @cached_property
    def _principal(self) -> tuple[Array, Array]:
        """Principal moments of inertia and their axes as columns."""
        tensor = np.asarray(self.inertia)
        if not (tensor - np.diag(np.diag(tensor))).any():
            return np.diag(tensor).copy(), np.eye(3)
        moments, axes = np.linalg.eigh(tensor)
        return moments, axes

    @property
    def _turns(self) -> Array:
        """Rotation vectors of the modes about the principal axes, shape (3, 3)."""
        moments, axes = self._principal
        return np.asarray((axes / np.sqrt(moments)).T)

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self._content == other._content

    def __hash__(self) -> int:
        return hash(self._content)

    def __reduce__(self) -> tuple[Any, ...]:
        return RigidBody, (self.mass, self.inertia, dict(self.points), self.name)

    @cached_property
    def _content(self) -> tuple[Any, ...]:
        inertia = None if self.inertia is None else tuple(np.asarray(self.inertia).ravel().tolist())
        return self.mass, inertia, tuple(sorted(self.points.items())), self.name


def _tensor(inertia: Any) -> Array:
    """Return moments of inertia as a tensor after checks, shape (3, 3)."""
    values = numbers("inertia", inertia)
    if values.shape not in ((), (3,), (3, 3)):
        raise ArgumentError(
            "inertia", "be one number, three, or a matrix of the shape (3, 3)", inertia, got=values.shape
        )
    check_finite("inertia", np.atleast_1d(values))
    tensor = values if values.ndim == 2 else np.diag(np.broadcast_to(values, 3))
    if np.abs(tensor - tensor.T).max() > ROUND_OFF * np.abs(tensor).max():
        raise ArgumentError("inertia", "be symmetric", inertia)
    tensor = 0.5 * (tensor + tensor.T)
    moments = np.linalg.eigvalsh(tensor)
    if moments[0] <= 0.0:
        raise ArgumentError(
            "inertia", "be positive definite", inertia, got=f"a principal moment of {moments[0]:.6g} kg m²"
        )
    if moments[2] > (moments[0] + moments[1]) * (1.0 + ROUND_OFF):
        words = "have no principal moment above the sum of the other two, which no body has"
        raise ArgumentError("inertia", words, inertia, got=", ".join(f"{moment:.6g}" for moment in moments) + " kg m²")
    tensor.flags.writeable = False
    return tensor


def _place(name: Any, place: Any) -> tuple[float, ...]:
    if not isinstance(name, str) or not name or name == CENTRE:
        raise ArgumentError("points", f"have names that are text, other than {CENTRE!r}", name)
    values = numbers(f"points[{name!r}]", place)
    if values.shape != (3,):
        raise ArgumentError(f"points[{name!r}]", "be three numbers, along x, y and z", place, got=values.shape)
    check_finite(f"points[{name!r}]", values)
    return tuple(values.tolist())
