"""Closed paths: circles round the axis of a body of revolution along which other bodies slide."""

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
