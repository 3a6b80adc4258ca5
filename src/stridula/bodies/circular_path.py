"""Closed paths: circles round the axis of a body of revolution, along which others slide."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np

from ..arrays import Array
from ..checks import ArgumentError, instance
from ..declared import Number, check_declared
from ..histories import HISTORIES, Constant, History
from .modes import BodyPoint


@dataclass(frozen=True)
class CircularPath(BodyPoint):
    """The circle through a point of a body of revolution, round its axis: a track without ends.

    The abscissa is the distance along it from that point, in the sense of the angle theta.

    Parameters
    ----------
    body : AxisymmetricBody
        The body.
    position : tuple of float
        The point (r, theta, z) where the abscissa is zero [m, rad, m].
    velocity : float, optional
        Velocity at which what slides on it is carried along as a whole [m/s], as by an arm that turns about the axis:
        its displacements are those against that arm.
    history : Constant, Ramp, Harmonic or Sampled, optional
        How that velocity goes in time, a factor on it.

    Raises
    ------
    ValueError
        If the point is not in the body, or an argument is out of its range.
    """

    velocity: Annotated[float, Number("m/s")] = 0.0
    history: History = field(default_factory=Constant)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not hasattr(self.body, "direction_round"):
            raise ArgumentError("body", "be a body of revolution", self.body)
        if not self.radius > 0.0:
            raise ArgumentError("position", "be (r, theta, z) with r above 0", self.position)
        check_declared(self)
        instance("history", self.history, HISTORIES)

    @property
    def circle(self) -> CircularPath:
        """Itself."""
        return self

    @property
    def radius(self) -> float:
        """Distance from the axis [m]."""
        position: Any = self.position
        return float(position[0])

    @property
    def length(self) -> float:
        """Length of one turn, its period [m]."""
        return 2.0 * math.pi * self.radius

    def point_at(self, abscissa: float) -> BodyPoint:
        """Return the point at an abscissa [m]."""
        position: Any = self.position
        r, theta, z = position
        return BodyPoint(self.body, (r, theta + abscissa / r, z))

    def direction(self, abscissa: float) -> Array:
        """Return the world components of its direction at an abscissa [m], shape (3,)."""
        body: Any = self.body
        return np.asarray(body.direction_round(self.point_at(abscissa).position))

    def travel(self, time: Array) -> Array:
        """Return how far what slides on it has been carried along [m]."""
        return np.asarray(self.velocity * self.history.integral(time))
