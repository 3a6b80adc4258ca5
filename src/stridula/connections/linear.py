"""Linear springs and dashpots."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Annotated, ClassVar

from ..bodies import BodyPoint
from ..checks import instance
from ..declared import Axis, Number, Position, Velocity, check_declared
from ..histories import HISTORIES, Constant, History
from .ends import along, check_ends


@dataclass(frozen=True)
class Spring:
    """A massless linear spring between two points, or between a point and the ground.

    Its force is the stiffness times the offset minus the displacement of the first end relative to the other: without
    an offset it is unstressed at the start, with one it acts as an actuator or as a moving support.

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
    offset : float, optional
        Displacement of the first end relative to the other at which it carries no force [m]; the displacement of the
        ground where that is the other end.
    history : Constant, Ramp, Harmonic or Sampled, optional
        Factor on the offset over time.
    """

    first: BodyPoint
    second: BodyPoint | None = None
    kind: ClassVar[str] = "spring"
    # A linear spring has no pull beyond its stiffness.
    bend: ClassVar[None] = None
    stiffness: Annotated[float, Number("N/m", above=0.0)] = field(kw_only=True)
    direction: Axis = field(default="x", kw_only=True)
    offset: Position = field(default=0.0, kw_only=True)
    history: History = field(default_factory=Constant, kw_only=True)

    def __post_init__(self) -> None:
        check_ends(self.first, self.second)
        check_declared(self)
        instance("history", self.history, HISTORIES)

    @property
    def moved_by(self) -> float:
        """Force on the first end with both ends undisplaced [N], times the history."""
        return self.stiffness * self.offset

    @property
    def rates(self) -> tuple[float, float]:
        """Force per unit of relative displacement [N/m] and per unit of relative velocity [N s/m]."""
        return self.stiffness, 0.0

    def __str__(self) -> str:
        moved = f", offset {self.offset:.4g} m, {self.history.kind}" if self.offset else ""
        return f"spring {self.stiffness:.4g} N/m along {along(self)}{moved}"


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
    velocity : float, optional
        Velocity of the first end relative to the other at which it carries no force [m/s]; the velocity of the ground
        where that is the other end.
    history : Constant, Ramp, Harmonic or Sampled, optional
        Factor on the velocity over time.
    """

    first: BodyPoint
    second: BodyPoint | None = None
    kind: ClassVar[str] = "dashpot"
    bend: ClassVar[None] = None
    coefficient: Annotated[float, Number("N s/m", above=0.0)] = field(kw_only=True)
    direction: Axis = field(default="x", kw_only=True)
    velocity: Velocity = field(default=0.0, kw_only=True)
    history: History = field(default_factory=Constant, kw_only=True)

    def __post_init__(self) -> None:
        check_ends(self.first, self.second)
        check_declared(self)
        instance("history", self.history, HISTORIES)

    @property
    def moved_by(self) -> float:
        """Force on the first end with both at rest [N], times the history."""
        return self.coefficient * self.velocity

    @property
    def rates(self) -> tuple[float, float]:
        """Force per unit of relative displacement [N/m] and per unit of relative velocity [N s/m]."""
        return 0.0, self.coefficient

    def __str__(self) -> str:
        moved = f", velocity {self.velocity:.4g} m/s, {self.history.kind}" if self.velocity else ""
        return f"dashpot {self.coefficient:.4g} N s/m along {along(self)}{moved}"
