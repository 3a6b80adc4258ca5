"""Contact stiffness: rough or lined surfaces, and round bodies pressed together."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real
from typing import Annotated, Any, ClassVar, Protocol

from ..bodies import Material
from ..checks import instance
from ..declared import Number, check_declared
from ..doubtful import doubts_of_modulus, warn_of

# Flexibility of a contact that does not touch yet [m/N].
FLAT = 1e6
Newtons = Annotated[float, Number("N/m", above=0.0)]


class ContactStiffness(Protocol):
    """A normal force that increases with the indentation of the contact: ``(K d^p) (1 + r d') + c d'``, never below 0.

    ``d`` is the indentation, a negative gap, ``d'`` its velocity. Implementations are frozen dataclasses.

    Attributes
    ----------
    kind : str
        Name in scenarios.
    """

    kind: ClassVar[str]

    @property
    def numbers(self) -> tuple[float, float, float, float]:
        """Stiffness K [N/m^p], exponent p, damping c [N s/m] and damping rate r [s/m]."""


def force_at(stiffness: ContactStiffness, indentation: float, velocity: float = 0.0) -> float:
    """Return the force [N] at an indentation [m] that grows with a velocity [m/s]."""
    k, p, damping, rate = stiffness.numbers
    if indentation <= 0.0:
        return 0.0
    return float(max(k * indentation**p * (1.0 + rate * velocity) + damping * velocity, 0.0))


def indentation_under(stiffness: ContactStiffness, force: float) -> float:
    """Return the indentation [m] under a constant force [N]."""
    k, p, *_ = stiffness.numbers
    return float((max(force, 0.0) / k) ** (1.0 / p))


def tangent_of(stiffness: ContactStiffness, indentation: float) -> tuple[float, float]:
    """Return the tangent of indentation over force about an indentation [m]: flexibility [m/N] and intercept [m]."""
    force = force_at(stiffness, indentation)
    if force == 0.0:
        k, p, *_ = stiffness.numbers
        return (1.0 / k, 0.0) if p == 1.0 else (FLAT, indentation)
    give = 1.0 / slopes_at(stiffness, force)[0]
    return give, indentation - give * force


def per_area(stiffness: ContactStiffness, area: float) -> ContactStiffness:
    """Return the stiffness of an area [m²] from the stiffness per unit of area."""
    k, p, damping, rate = stiffness.numbers
    return LinearStiffness(area * k, area * damping) if p == 1.0 and not rate else PowerStiffness(area * k, p, rate)


def slopes_at(stiffness: ContactStiffness, force: float) -> tuple[float, float]:
    """Return the derivatives of the force by indentation [N/m] and its velocity [N s/m] about a constant force."""
    k, p, damping, rate = stiffness.numbers
    slope = k if p == 1.0 else k * p * indentation_under(stiffness, force) ** (p - 1.0)
    return slope, damping + rate * force


@dataclass(frozen=True)
class LinearStiffness:
    """A contact with a spring and a dashpot: a lining, a layer, or a rough surface linearised about its load.

    Parameters
    ----------
    stiffness : float
        Force per indentation [N/m].
    damping : float, optional
        Force per velocity of the indentation [N s/m]; the total force is never tensile.
    """

    kind: ClassVar[str] = "linear"
    stiffness: Newtons
    damping: Annotated[float, Number("N s/m", least=0.0)] = 0.0

    def __post_init__(self) -> None:
        check_declared(self)

    @property
    def numbers(self) -> tuple[float, float, float, float]:
        """Stiffness, exponent 1, damping and no damping rate."""
        return self.stiffness, 1.0, self.damping, 0.0


@dataclass(frozen=True)
class PowerStiffness:
    """A contact whose force is a power of the indentation (Hunt & Crossley 1975): rough or round surfaces.

    Parameters
    ----------
    coefficient : float
        Force at an indentation of 1 m [N/m^p].
    exponent : float, optional
        Exponent p, at least 1 and below 10: 1.5 for a ball on a plane, 2 to 3.5 for rough surfaces.
    damping : float, optional
        Relative increase of the force per velocity of the indentation [s/m].
    """

    kind: ClassVar[str] = "power law"
    coefficient: Annotated[float, Number(above=0.0)]
    exponent: Annotated[float, Number(least=1.0, below=10.0)] = 1.5
    damping: Annotated[float, Number("s/m", least=0.0)] = 0.0

    def __post_init__(self) -> None:
        check_declared(self)

    @property
    def numbers(self) -> tuple[float, float, float, float]:
        """Coefficient, exponent, no damping, and the damping rate."""
        return self.coefficient, self.exponent, 0.0, self.damping


@dataclass(frozen=True)
class HertzStiffness:
    """A round body on another, elastic and smooth (Hertz 1882): ``4/3 E* sqrt(R) d^1.5``.

    Parameters
    ----------
    radius : float
        Radius of the sphere on a plane [m]; for two spheres ``1 / R = 1 / R1 + 1 / R2``.
    modulus : float
        Combined modulus, ``1 / E* = (1 - nu1²) / E1 + (1 - nu2²) / E2`` [Pa].
    damping : float, optional
        Relative increase of the force per velocity of the indentation [s/m].
    """

    kind: ClassVar[str] = "hertz"
    radius: Annotated[float, Number("m", above=0.0)]
    modulus: Annotated[float, Number("Pa", above=0.0)]
    damping: Annotated[float, Number("s/m", least=0.0)] = 0.0

    def __post_init__(self) -> None:
        check_declared(self)
        warn_of(doubts_of_modulus("combined modulus", self.modulus))

    @classmethod
    def between(cls, first: Material, second: Material, radius: float, damping: float = 0.0) -> HertzStiffness:
        """Return the stiffness between bodies of two materials.

        Parameters
        ----------
        first, second : Material
            Materials of the bodies.
        radius : float
            Radius of the sphere on a plane [m]; for two spheres ``1 / R = 1 / R1 + 1 / R2``.
        damping : float, optional
            Damping rate [s/m].
        """
        softness = 0.0
        for name, material in (("first", first), ("second", second)):
            instance(name, material, Material)
            softness += (1.0 - material.poisson**2) / material.young
        return cls(radius, 1.0 / softness, damping)

    @property
    def numbers(self) -> tuple[float, float, float, float]:
        """Coefficient, exponent 1.5, no damping, and the damping rate."""
        return 4.0 / 3.0 * self.modulus * math.sqrt(self.radius), 1.5, 0.0, self.damping


STIFFNESSES = (LinearStiffness, PowerStiffness, HertzStiffness)


def checked_stiffness(given: Any) -> ContactStiffness | None:
    """Return the stiffness of a contact, a linear one for a number [N/m], None if it is rigid.

    Raises
    ------
    ValueError
        If it is none of these.
    """
    if given is None or isinstance(given, STIFFNESSES):
        return given
    instance("stiffness", given, (Real, *STIFFNESSES))
    return LinearStiffness(float(given))
