"""Materials, and cross-sections of beams."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, ClassVar

from ..checks import ArgumentError
from ..declared import Area, Length, Number, check_declared
from ..doubtful import doubts_of_modulus, doubts_of_size, warn_of

# From foam to osmium [kg/m3]; a value below the other is probably in t/mm3: aluminium has 2.7e-9.
DENSITY, TONNES = (10.0, 3e4), 1e-6


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
        Poisson's ratio [1], for plates and solids; from -1 to 0.5, both excluded.
    loss_factor : float, optional
        Loss factor [1], twice a damping ratio: a mode loses ``2 pi`` times this share of the strain energy that it has
        in the material in a period. It adds to the damping of a body.

    Warns
    -----
    DoubtfulValue
        If Young's modulus or the density is that of no solid, as without the prefix of its unit.
    """

    young: Annotated[float, Number("Pa", above=0.0)]
    density: Annotated[float, Number("kg/m3", above=0.0)]
    poisson: Annotated[float, Number(above=-1.0, below=0.5)] = 0.3
    loss_factor: Annotated[float, Number(least=0.0, below=1.0)] = 0.0

    def __post_init__(self) -> None:
        check_declared(self)
        warn_of(self.doubts)

    @property
    def doubts(self) -> list[str]:
        """Values that are probably mistaken, in words."""
        return doubts_of_material(self.young, self.density)


def doubts_of_material(young: float, density: float) -> list[str]:
    """Return doubts about Young's modulus [Pa] and density [kg/m³]."""
    found = doubts_of_modulus("Young's modulus", young)
    if not DENSITY[0] <= density <= DENSITY[1]:
        unit = "t/mm3, as in finite-element programs" if density < TONNES else "g/cm3"
        found.append(f"density of {density:.4g} kg/m3; did you mean {unit}?")
    return found


@dataclass(frozen=True)
class Section:
    """A cross-section given by its two properties.

    Parameters
    ----------
    area : float
        Area [m²].
    second_moment : float
        Second moment of area in the plane of motion [m⁴], about the axis normal to it.
    """

    shape: ClassVar[str] = "general"
    area: Area
    second_moment: Annotated[float, Number("m4", above=0.0)]

    def __post_init__(self) -> None:
        check_declared(self)

    @property
    def depth(self) -> float:
        """Height of the rectangle with the same radius of gyration [m]."""
        return math.sqrt(12.0 * self.second_moment / self.area)


@dataclass(frozen=True)
class Rectangle:
    """A rectangular cross-section.

    Parameters
    ----------
    width : float
        Side normal to the plane of motion [m].
    height : float
        Side in the plane of motion, across which it bends [m].
    """

    shape: ClassVar[str] = "rectangle"
    width: Length
    height: Length

    def __post_init__(self) -> None:
        check_declared(self)
        _check_ordinary("width and height", self)
        warn_of(doubts_of_size(self.largest_side))

    @property
    def area(self) -> float:
        """Area [m²]."""
        return self.width * self.height

    @property
    def second_moment(self) -> float:
        """Second moment of area [m⁴], ``width height³ / 12``."""
        return self.width * self.height**3 / 12.0

    @property
    def largest_side(self) -> float:
        """Larger side [m]."""
        return max(self.width, self.height)

    @property
    def depth(self) -> float:
        """Side across which it bends [m]."""
        return self.height

    @property
    def across(self) -> float:
        """Largest distance between two of its points [m]."""
        return math.hypot(self.width, self.height)


@dataclass(frozen=True)
class Circle:
    """A solid circular cross-section.

    Parameters
    ----------
    diameter : float
        Diameter [m].
    """

    shape: ClassVar[str] = "circle"
    diameter: Length

    def __post_init__(self) -> None:
        check_declared(self)
        _check_ordinary("diameter", self)
        warn_of(doubts_of_size(self.diameter))

    @property
    def area(self) -> float:
        """Area [m²]."""
        return math.pi * self.diameter**2 / 4.0

    @property
    def second_moment(self) -> float:
        """Second moment of area [m⁴], ``pi diameter⁴ / 64``."""
        return math.pi * self.diameter**4 / 64.0

    @property
    def largest_side(self) -> float:
        """Its diameter [m]."""
        return self.diameter

    @property
    def depth(self) -> float:
        """Its diameter [m]."""
        return self.diameter

    @property
    def across(self) -> float:
        """Its diameter [m]."""
        return self.diameter


def _check_ordinary(sides: str, section: Rectangle | Circle) -> None:
    """Raise ValueError if sides are so small or so large that area or second moment underflow or overflow."""
    try:
        is_ordinary = 0.0 < section.area < math.inf and 0.0 < section.second_moment < math.inf
    except OverflowError:
        is_ordinary = False
    if not is_ordinary:
        raise ArgumentError(sides, "be of ordinary size", got=section)


# Shortest wave of bending that thin beams and plates have, over their depth: Euler and Bernoulli's frequency is there
# 14 to 17 % above Timoshenko's, Kirchhoff's 14 to 18 % above Mindlin's.
SHORTEST_WAVE = 6.0
SECTIONS = (Rectangle, Circle, Section)
