"""Probes: declarations of what else to record."""

from __future__ import annotations

from dataclasses import dataclass

from ..bodies import BodyPoint, FiniteElementBeam
from ..checks import ArgumentError, choice, instance

DIRECTIONS = ("x", "y", "z", "axial", "transverse")


@dataclass(frozen=True)
class _Motion:
    point: BodyPoint
    direction: str = "y"

    def __post_init__(self) -> None:
        instance("point", self.point, BodyPoint)
        choice("direction", self.direction, DIRECTIONS)
        if self.direction == "z" and not self.point.body.is_spatial:
            raise ArgumentError("direction", "be another than z on a body in the plane", self.direction)


class Displacement(_Motion):
    """Displacement of a point of a body along a direction [m].

    Parameters
    ----------
    point : BodyPoint
        Where.
    direction : {"y", "x", "z", "axial", "transverse"}, optional
        World direction, or along or across the body's own axis.
    """


class Velocity(_Motion):
    """Velocity of a point of a body along a direction [m/s], centred difference over two steps.

    Parameters
    ----------
    point : BodyPoint
        Where.
    direction : {"y", "x", "z", "axial", "transverse"}, optional
        World direction, or along or across the body's own axis.
    """


class Acceleration(_Motion):
    """Acceleration of a point of a body along a direction [m/s²], second difference over two steps.

    Parameters
    ----------
    point : BodyPoint
        Where.
    direction : {"y", "x", "z", "axial", "transverse"}, optional
        World direction, or along or across the body's own axis.
    """


@dataclass(frozen=True)
class Reaction:
    """Force that the support of a slider's root exerts on it, along world x or y [N], or its moment [N m].

    Zero in a direction in which the root is free. The moment counts positive when it raises the slope of the
    transverse displacement along the axis from tip to root.

    Parameters
    ----------
    body : FiniteElementBeam
        The slider.
    component : {"x", "y", "moment"}, optional
        Which one.
    """

    body: FiniteElementBeam
    component: str = "moment"

    def __post_init__(self) -> None:
        instance("body", self.body, FiniteElementBeam)
        choice("component", self.component, ("x", "y", "moment"))


Probe = Displacement | Velocity | Acceleration | Reaction
