"""Contacts that yield themselves: rough or lined surfaces, and round bodies pressed together."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Real
from typing import Annotated, Any, ClassVar, Protocol

from ..bodies import Material
from ..checks import instance
from ..declared import Number, check_declared

# How much a contact yields that does not touch yet [m/N].
FLAT = 1e6
Newtons = Annotated[float, Number("N/m", above=0.0)]


class ContactStiffness(Protocol):
    """A normal force that grows with the indentation of the contact: ``(K d^p) (1 + r d') + c d'``, never below 0.

    ``d`` is the indentation, the gap below zero, ``d'`` its velocity. Each is a frozen dataclass.

    Attributes
    ----------
    kind : str
        Its name in scenarios.
    """

    kind: ClassVar[str]

    @property
    def numbers(self) -> tuple[float, float, float, float]:
        """Stiffness K [N/m^p], exponent p, damping c [N s/m] and damping rate r [s/m]."""


def force_at(stiffness: ContactStiffness, indentation: float) -> float:
    """Return the force at an indentation [m] that stays, in newtons."""
    k, p, *_ = stiffness.numbers
    return float(k * max(indentation, 0.0) ** p)


def indentation_under(stiffness: ContactStiffness, force: float) -> float:
    """Return the indentation under a force [N] that stays, in metres."""
    k, p, *_ = stiffness.numbers
    return float((max(force, 0.0) / k) ** (1.0 / p))


def stored_at(stiffness: ContactStiffness, indentation: float) -> float:
    """Return the energy stored at an indentation [m], in joules."""
    _, p, *_ = stiffness.numbers
    return force_at(stiffness, indentation) * max(indentation, 0.0) / (p + 1.0)


def tangent_of(stiffness: ContactStiffness, indentation: float) -> tuple[float, float]:
    """Return how a contact yields about an indentation [m]: more for a unit of force [m/N], and beyond that [m]."""
    force = force_at(stiffness, indentation)
    if force == 0.0:
        k, p, *_ = stiffness.numbers
        return (1.0 / k, 0.0) if p == 1.0 else (FLAT, indentation)
    give = 1.0 / slopes_at(stiffness, force)[0]
    return give, indentation - give * force


def per_area(stiffness: ContactStiffness, area: float) -> ContactStiffness:
    """Return the stiffness of an area [m²] of one that is for a unit of area."""
    k, p, damping, rate = stiffness.numbers
    return LinearStiffness(area * k, area * damping) if p == 1.0 and not rate else PowerStiffness(area * k, p, rate)


def slopes_at(stiffness: ContactStiffness, force: float) -> tuple[float, float]:
    """Return how the force changes with the indentation [N/m] and with its velocity [N s/m] about one that stays."""
    k, p, damping, rate = stiffness.numbers
    slope = k if p == 1.0 else k * p * indentation_under(stiffness, force) ** (p - 1.0)
    return slope, damping + rate * force


@dataclass(frozen=True)
class LinearStiffness:
    """A contact with a spring and a dashpot: a lining, a layer, or a rough surface about its load.

    Parameters
    ----------
    stiffness : float
        Force for a unit of the indentation [N/m].
    damping : float, optional
        Force for a unit of the velocity of the indentation [N s/m]; the whole force never pulls.
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
    """A contact whose force goes with a power of the indentation (Hunt & Crossley 1975): rough or round surfaces.

    Parameters
    ----------
    coefficient : float
        Force at an indentation of 1 m [N/m^p].
    exponent : float, optional
        The power p, from 1 on, below 10: 1.5 of a ball on a plane, 2 to 3.5 of rough surfaces.
    damping : float, optional
        Share by which the force is larger for a unit of the velocity of the indentation [s/m].
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
        Radius of the sphere on a plane, of two spheres ``1 / R = 1 / R1 + 1 / R2`` [m].
    modulus : float
        Modulus of both together, ``1 / E* = (1 - nu1²) / E1 + (1 - nu2²) / E2`` [Pa].
    damping : float, optional
        Share by which the force is larger for a unit of the velocity of the indentation [s/m].
    """

    kind: ClassVar[str] = "hertz"
    radius: Annotated[float, Number("m", above=0.0)]
    modulus: Annotated[float, Number("Pa", above=0.0)]
    damping: Annotated[float, Number("s/m", least=0.0)] = 0.0

    def __post_init__(self) -> None:
        check_declared(self)

    @classmethod
    def between(cls, first: Material, second: Material, radius: float, damping: float = 0.0) -> HertzStiffness:
        """Return the stiffness of bodies of two materials.

        Parameters
        ----------
        first, second : Material
            What they are made of.
        radius : float
            Radius of the sphere on a plane, of two spheres ``1 / R = 1 / R1 + 1 / R2`` [m].
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
    """Return the stiffness of a contact, of a number [N/m] a linear one, None where it is rigid.

    Raises
    ------
    ValueError
        If it is neither.
    """
    if given is None or isinstance(given, STIFFNESSES):
        return given
    instance("stiffness", given, (Real, *STIFFNESSES))
    return LinearStiffness(float(given))
