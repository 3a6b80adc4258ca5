"""Bodies whose points have names, without positions between them."""

from __future__ import annotations

from typing import ClassVar

from ..checks import ArgumentError, choice
from .body_surfaces import HIGHEST, BodySurface
from .cards import HasCard
from .modes import Body
from .points import BodyPoint


class NamedPoints(HasCard):
    """Base class of bodies with named points; the names are those of `point_names`."""

    has_positions: ClassVar[bool] = False
    # Why it has no surface, in words.
    without_surface: ClassVar[str] = "whose surface is not known"

    def at(self: Body, position: str) -> BodyPoint:
        """Return the point of the name `position`."""
        return BodyPoint(self, position)

    def check_position(self: Body, position: str) -> None:
        """Raise ValueError if no point has the name `position`."""
        choice("position", position, self.point_names)

    def surface(self, frequency: float = HIGHEST) -> BodySurface:
        """Return the outer surface and how modes move it.

        Raises
        ------
        ValueError
            If it has none.
        """
        words = f"a {type(self).__name__}, {self.without_surface}"
        raise ArgumentError("body", "have a surface that its modes move", got=words)

    @property
    def dimensions(self) -> str:
        """Size in words, empty without one."""
        return ""

    @property
    def posture(self) -> str:
        """Orientation in words, empty without one."""
        return ""
