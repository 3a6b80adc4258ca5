"""What joins bodies for good: springs and dashpots."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar

import numpy as np

from .arrays import Array
from .bodies import BodyPoint
from .checks import ArgumentError, brief, instance
from .declared import Axis, Number, check_declared


@dataclass(frozen=True)
class Spring:
    """A massless linear spring between two points, or between a point and the ground, unstressed at the start.

    Parameters
    ----------
    first : BodyPoint
        One end.
    second : BodyPoint, optional
        The other end, of the same or another body; the ground if left out.
    stiffness : float
        Stiffness [N/m]; force per unit of relative displacement.
    direction : {"x", "y", "z"} or sequence of float, optional
        World direction along which it acts: x, y, z, or its three components, of any length.
    """

    first: BodyPoint
    second: BodyPoint | None = None
    kind: ClassVar[str] = "spring"
    stiffness: Annotated[float, Number("N/m", above=0.0)] = field(kw_only=True)
    direction: Axis = field(default="x", kw_only=True)

    def __post_init__(self) -> None:
        _check_ends(self.first, self.second)
        check_declared(self)

    @property
    def rates(self) -> tuple[float, float]:
        """Force per unit of relative displacement [N/m] and per unit of relative velocity [N s/m]."""
        return self.stiffness, 0.0

    def __str__(self) -> str:
        return f"spring {self.stiffness:.4g} N/m along {_along(self)}"


@dataclass(frozen=True)
class Dashpot:
    """A massless viscous damper between two points, or between a point and the ground.

    Parameters
    ----------
    first : BodyPoint
        One end.
    second : BodyPoint, optional
        The other end, of the same or another body; the ground if left out.
    coefficient : float
        Force per unit of relative velocity [N s/m].
    direction : {"x", "y", "z"} or sequence of float, optional
        World direction along which it acts: x, y, z, or its three components, of any length.
    """

    first: BodyPoint
    second: BodyPoint | None = None
    kind: ClassVar[str] = "dashpot"
    coefficient: Annotated[float, Number("N s/m", above=0.0)] = field(kw_only=True)
    direction: Axis = field(default="x", kw_only=True)

    def __post_init__(self) -> None:
        _check_ends(self.first, self.second)
        check_declared(self)

    @property
    def rates(self) -> tuple[float, float]:
        """Force per unit of relative displacement [N/m] and per unit of relative velocity [N s/m]."""
        return 0.0, self.coefficient

    def __str__(self) -> str:
        return f"dashpot {self.coefficient:.4g} N s/m along {_along(self)}"


Connection = Spring | Dashpot
CONNECTIONS = (Spring, Dashpot)


def unit(connection: Connection) -> Array:
    """Return the world direction of a connection, a unit vector, shape (3,)."""
    if isinstance(connection.direction, str):
        return np.eye(3)["xyz".index(connection.direction)]
    components = np.array(connection.direction)
    return np.asarray(components / np.linalg.norm(components))


def _along(connection: Connection) -> str:
    """Return the direction of a connection in words."""
    if isinstance(connection.direction, str):
        return connection.direction
    return f"({', '.join(f'{one:.3g}' for one in connection.direction)})"


def ends(connection: Connection) -> tuple[BodyPoint, ...]:
    """Return the points that a connection joins, the ground left out."""
    return (connection.first,) if connection.second is None else (connection.first, connection.second)


def _check_ends(first: BodyPoint, second: BodyPoint | None) -> None:
    instance("first", first, BodyPoint)
    if second is not None:
        instance("second", second, BodyPoint)
        if second == first:
            words = "be another point than first (equal bodies need names)"
            raise ArgumentError("second", words, second, got=f"{brief(second)} for both")
