"""Connections between bodies: springs, linear and not, and dashpots."""

from __future__ import annotations

from ..arrays import Array
from ..bodies import BodyPoint
from ..histories import History
from .ends import ends, unit
from .linear import Dashpot, Spring
from .nonlinear import CubicSpring, NonlinearSpring, TabulatedSpring

__all__ = [
    "CONNECTIONS",
    "Connection",
    "CubicSpring",
    "Dashpot",
    "NonlinearSpring",
    "Spring",
    "TabulatedSpring",
    "ends",
    "pushes",
    "unit",
]

Connection = Spring | Dashpot | NonlinearSpring
CONNECTIONS = (Spring, Dashpot, CubicSpring, TabulatedSpring)


def pushes(connection: Connection) -> list[tuple[History, BodyPoint, Array]]:
    """Return the forces of a connection with an offset or a velocity: history, point, and x, y and z [N]."""
    if not connection.moved_by:
        return []
    force = connection.moved_by * unit(connection)
    return [
        (connection.history, point, sign * force) for point, sign in zip(ends(connection), (1.0, -1.0), strict=False)
    ]
