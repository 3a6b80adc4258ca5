"""Ends and direction of a connection."""

from __future__ import annotations

from typing import Any

from ..arrays import Array
from ..bodies import BodyPoint
from ..checks import ArgumentError, brief, instance
from ..declared import Way


def unit(connection: Any) -> Array:
    """Return the world direction of a connection, a unit vector, shape (3,)."""
    return Way().along(connection.direction)


def ends(connection: Any) -> tuple[BodyPoint, ...]:
    """Return the points that a connection joins, without the ground."""
    return (connection.first,) if connection.second is None else (connection.first, connection.second)


def along(connection: Any) -> str:
    """Return the direction of a connection in words."""
    if isinstance(connection.direction, str):
        return connection.direction
    return f"({', '.join(f'{one:.3g}' for one in connection.direction)})"


def check_ends(first: BodyPoint, second: BodyPoint | None) -> None:
    """Raise ValueError unless these are different points, or the second is the ground."""
    instance("first", first, BodyPoint)
    if second is not None:
        instance("second", second, BodyPoint)
        if second == first:
            words = "be a point other than first (equal bodies need names)"
            raise ArgumentError("second", words, second, got=f"{brief(second)} for both")
