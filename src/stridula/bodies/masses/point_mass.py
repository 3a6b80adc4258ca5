"""A mass without shape or stiffness."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from ...arrays import Array
from ...checks import ArgumentError
from ...declared import Name, Number, check_declared
from ..matrix_input import numbers
from ..modes import Modes
from ..named_points import NamedPoints
from ..points import BodyPoint

# Below this, stiffness over mass overflows.
SMALLEST_MASS = 1e-100


@dataclass(frozen=True)
class PointMass(NamedPoints):
    """A point mass that moves freely along world x and y and does not turn.

    Parameters
    ----------
    mass : float
        Mass [kg]; at least 1e-100.
    name : str, optional
        Name in records; distinguishes equal bodies.

    Raises
    ------
    ValueError
        If an argument is out of its range.
    """

    kind: ClassVar[str] = "point mass"
    point_names: ClassVar[tuple[str, ...]] = ("centre",)
    is_spatial: ClassVar[bool] = False
    has_translation: ClassVar[bool] = True
    is_lumped: ClassVar[bool] = True
    without_surface: ClassVar[str] = "which has no modes that vibrate"
    mass: Annotated[float, Number("kg", above=0.0)]
    name: Name = ""

    def __post_init__(self) -> None:
        check_declared(self)
        if self.mass < SMALLEST_MASS:
            raise ArgumentError("mass", f"be at least {SMALLEST_MASS:g}", self.mass)

    @property
    def centre(self) -> BodyPoint:
        """Its only point."""
        return BodyPoint(self, "centre")

    @property
    def axes(self) -> Array:
        """World components of its two axes, which are x and y, shape (2, 2)."""
        return np.eye(2)

    @property
    def total_mass(self) -> float:
        """Mass [kg]."""
        return float(self.mass)

    def modes(self, held_x: bool = False) -> Modes:
        """Return both rigid modes, along x and along y; `held_x` is for bodies with a driven end and must be false."""
        if held_x:
            raise ArgumentError("held_x", "be False for a PointMass: it has no driven end", held_x)
        return Modes(np.zeros(2), np.zeros(2), np.eye(2) * np.sqrt(self.mass))

    def trace(self, position: str, held_x: bool = False) -> Array:
        """Return the rows that give the displacement (x, y) from the modes, shape (2, 2)."""
        self.check_position(position)
        self.modes(held_x)
        return np.eye(2) / np.sqrt(self.mass)

    def modal_coordinates(self, vector: Any) -> Array:
        """Return the modal coordinates of a displacement [m] or a velocity [m/s] along (x, y), shape (2,)."""
        wrong = ArgumentError("vector", "be two finite numbers, along x and y", vector)
        try:
            values = numbers("vector", vector)
        except ArgumentError:
            raise wrong from None
        if values.shape != (2,) or not np.isfinite(values).all():
            raise wrong
        return np.sqrt(self.mass) * values
