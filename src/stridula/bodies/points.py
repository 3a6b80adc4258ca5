"""Points of bodies: alone, driven, or on a circle along which other bodies slide."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, Any, Protocol, TypeGuard

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, instance
from ..declared import Number, check_declared
from ..histories import HISTORIES, Constant, History
from .modes import Body, Modes


@dataclass(frozen=True)
class BodyPoint:
    """A point of a body.

    Attributes
    ----------
    body : FiniteElementBeam, ModalBeam, ModalPlate, ReducedBody or PointMass
        The body.
    position : float, tuple of float or str
        On beams the distance along the axis from the first end [m]: from the tip of a slider, from the left end of a
        track. On plates the abscissa along the line, or the distances along length and width [m]. On bodies of
        revolution radius, angle and height (r, theta, z) [m, rad, m]. On other bodies the name of the point.

    Raises
    ------
    ValueError
        If the position is not on the body.
    """

    body: Body
    position: float | tuple[float, ...] | str

    def __post_init__(self) -> None:
        check = getattr(self.body, "check_position", None)
        if check is None or isinstance(self.body, type):
            raise ArgumentError("body", "be a body of stridula", self.body)
        if isinstance(self.position, np.generic):
            # Comparing a NumPy number with a pair gives an array.
            object.__setattr__(self, "position", self.position.item())
        check(self.position)

    @property
    def label(self) -> str:
        """Name, or the numbers of its position in full precision."""
        return (
            self.position if isinstance(self.position, str) else ", ".join(map(repr, np.ravel(self.position).tolist()))
        )

    @property
    def point_name(self) -> str | None:
        """Name among the points of its body, None for a position between them."""
        if isinstance(self.position, str):
            return self.position
        named = ((name, getattr(self.body, name).position) for name in self.body.point_names)
        return next((name for name, position in named if position == self.position), None)

    @property
    def place(self) -> Array | None:
        """World place at rest [m], shape (3,), None if it is not known."""
        found = getattr(self.body, "place", None)
        return None if found is None else found(self.position)

    @property
    def circle(self) -> CircularPath | None:
        """The closed path that it represents, None for a point alone."""
        return None

    @property
    def turning_velocity(self) -> Array:
        """World components of the velocity of the material there if the body turns [m/s], shape (3,)."""
        found = getattr(self.body, "turning_velocity", None)
        return np.zeros(3) if found is None else np.asarray(found(self.position))


@dataclass(frozen=True)
class CircularPath(BodyPoint):
    """The circle through a point of a body of revolution, round its axis: a track without ends.

    The abscissa is the distance along it, in the sense of the angle theta.

    Parameters
    ----------
    body : AxisymmetricBody or ModalBody
        The body.
    position : tuple of float or str
        Point where the abscissa is zero: (r, theta, z) [m, rad, m], or the name of a point with a circle.
    velocity : float, optional
        Velocity at which a slider on it is carried along as a whole [m/s], as by an arm that turns about the axis: the
        displacements of the slider are relative to that arm.
    history : Constant, Ramp, Harmonic or Sampled, optional
        Factor on that velocity over time.

    Raises
    ------
    ValueError
        If the point is not in the body, or an argument is out of its range.
    """

    velocity: Annotated[float, Number("m/s")] = 0.0
    history: History = field(default_factory=Constant)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not hasattr(self.body, "circle_at"):
            raise ArgumentError("body", "be a body of revolution", self.body)
        if not self.radius > 0.0:
            raise ArgumentError("position", "be off the axis, r above 0", self.position)
        check_declared(self)
        instance("history", self.history, HISTORIES)

    @property
    def circle(self) -> CircularPath:
        """Itself."""
        return self

    @property
    def radius(self) -> float:
        """Distance from the axis [m]."""
        return float(self._place(None)[0])

    @property
    def length(self) -> float:
        """Length of one turn, its period [m]."""
        return 2.0 * math.pi * self.radius

    def point_at(self, abscissa: float) -> BodyPoint:
        """Return the point at an abscissa [m]."""
        return BodyPoint(self.body, self._place(abscissa)[1])

    def direction(self, abscissa: float) -> Array:
        """Return the world components of its direction at an abscissa [m], shape (3,)."""
        return np.asarray(self._place(abscissa)[2])

    def _place(self, abscissa: float | None) -> tuple[float, Any, Array]:
        body: Any = self.body
        found: tuple[float, Any, Array] = body.circle_at(self.position, abscissa)
        return found

    def travel(self, time: Array) -> Array:
        """Return the distance by which a slider on it has been carried along [m]."""
        return np.asarray(self.velocity * self.history.integral(time))


class HasRoot(Protocol):
    """A body with a driven end, its root."""

    @property
    def root(self) -> BodyPoint:
        """The driven end."""

    @property
    def tip_support(self) -> str:
        """Support of the other end."""

    def modes(self, held_x: bool = False) -> Modes:
        """Return the modes; with `held_x` those with the root held along x."""

    def root_lever(self, position: Any) -> Array:
        """Return forces and moment at the root for forces at `position` along world x and y, shape (3, 2)."""

    def root_reaction(self, held_x: bool = False) -> Any:
        """Return the force of the support of the root as a function of the motion."""


def has_root(body: Any) -> TypeGuard[HasRoot]:
    """Return whether a body has a driven end."""
    return hasattr(body, "root_reaction")
