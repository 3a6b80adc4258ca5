"""Bodies whose points have names, without positions between them."""

from __future__ import annotations

from typing import ClassVar

from ..checks import choice
from .cards import HasCard
from .modes import Body, BodyPoint


class NamedPoints(HasCard):
    """Base class of bodies with named points; the names are those of `point_names`."""

    has_positions: ClassVar[bool] = False

    def at(self: Body, position: str) -> BodyPoint:
        """Return the point of the name `position`."""
        return BodyPoint(self, position)

    def check_position(self: Body, position: str) -> None:
        """Raise ValueError if no point has the name `position`."""
        choice("position", position, self.point_names)

    @property
    def dimensions(self) -> str:
        """Size in words, empty without one."""
        return ""

    @property
    def posture(self) -> str:
        """Orientation in words, empty without one."""
        return ""
