"""Connections between bodies: springs and dashpots, also nonlinear, viscoelastic springs, bushings, rigid joints."""

from __future__ import annotations

from ..arrays import Array
from ..bodies import BodyPoint
from ..histories import History
from .dashpots import TabulatedDashpot
from .elements import elements_of, held_motions
from .ends import ends, unit
from .layers import viscoelastic_layer
from .linear import Dashpot, Spring
from .nonlinear import CubicSpring, NonlinearSpring, TabulatedSpring
from .opposite import opposite_points
from .rigid import Bushing, RigidJoint
from .viscoelastic import ViscoelasticSpring

__all__ = [
    "CONNECTIONS",
    "Bushing",
    "Connection",
    "CubicSpring",
    "Dashpot",
    "NonlinearSpring",
    "RigidJoint",
    "Spring",
    "TabulatedDashpot",
    "TabulatedSpring",
    "ViscoelasticSpring",
    "elements_of",
    "ends",
    "held_motions",
    "opposite_points",
    "pushes",
    "unit",
    "viscoelastic_layer",
]

Connection = Spring | Dashpot | NonlinearSpring | TabulatedDashpot | ViscoelasticSpring | Bushing | RigidJoint
CONNECTIONS = (Spring, Dashpot, CubicSpring, TabulatedSpring, TabulatedDashpot, ViscoelasticSpring, Bushing, RigidJoint)


def pushes(connection: Connection) -> list[tuple[History, BodyPoint, Array]]:
    """Return the forces of a connection with an offset or a velocity: history, point, and x, y and z [N]."""
    if not connection.moved_by:
        return []
    force = connection.moved_by * unit(connection)
    return [
        (connection.history, point, sign * force) for point, sign in zip(ends(connection), (1.0, -1.0), strict=False)
    ]
