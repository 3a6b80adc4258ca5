"""Materials, and cross-sections of beams."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ..checks import ArgumentError, positive, within


@dataclass(frozen=True)
class Material:
    """A homogeneous, isotropic, linear elastic material.

    Parameters
    ----------
    young : float
        Young's modulus [Pa].
    density : float
        Mass density [kg/m³].
    poisson : float, optional
        Poisson's ratio [1], from -1 to 0.5 (both excluded); of no effect on beams.
    """

    young: float
    density: float
    poisson: float = 0.3

    def __post_init__(self) -> None:
        positive("young", self.young)
        positive("density", self.density)
        within("poisson", self.poisson, -1.0, 0.5, ends=False)


@dataclass(frozen=True)
class Section:
    """A cross-section given by its two properties.

    Parameters
    ----------
    area : float
        Area [m²].
    second_moment : float
        Second moment of area about the axis normal to the plane of motion [m⁴].
    """

    area: float
    second_moment: float

    def __post_init__(self) -> None:
        positive("area", self.area)
        positive("second_moment", self.second_moment)


@dataclass(frozen=True)
class Rectangle:
    """A rectangular cross-section.

    Parameters
    ----------
    width : float
        Side normal to the plane of motion [m].
    height : float
        Side in the plane of motion, the one that bends [m].
    """

    width: float
    height: float

    def __post_init__(self) -> None:
        positive("width", self.width)
        positive("height", self.height)
        _check_ordinary("width and height", self)

    @property
    def area(self) -> float:
        """Area [m²]."""
        return self.width * self.height

    @property
    def second_moment(self) -> float:
        """Second moment of area [m⁴], ``width height³ / 12``."""
        return self.width * self.height**3 / 12.0


@dataclass(frozen=True)
class Circle:
    """A solid circular cross-section.

    Parameters
    ----------
    diameter : float
        Diameter [m].
    """

    diameter: float

    def __post_init__(self) -> None:
        positive("diameter", self.diameter)
        _check_ordinary("diameter", self)

    @property
    def area(self) -> float:
        """Area [m²]."""
        return math.pi * self.diameter**2 / 4.0

    @property
    def second_moment(self) -> float:
        """Second moment of area [m⁴], ``pi diameter⁴ / 64``."""
        return math.pi * self.diameter**4 / 64.0


def _check_ordinary(sides: str, section: Rectangle | Circle) -> None:
    """Raise ValueError where sides are so small or so large that numbers cannot hold what follows from them."""
    try:
        is_ordinary = 0.0 < section.area < math.inf and 0.0 < section.second_moment < math.inf
    except OverflowError:
        is_ordinary = False
    if not is_ordinary:
        raise ArgumentError(sides, "be of ordinary size", got=section)
