"""An elastic bar against a rigid floor: one impact, and bouncing under gravity."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from math import floor, pi, sqrt

import numpy as np

from ...arrays import Array
from ...bodies import FiniteElementBeam, Material, Section
from ...doubtful import DoubtfulValue

# Radius of gyration over the size of an element, so small that bending does not limit the step.
SLACK = 0.004


@dataclass(frozen=True)
class Bar:
    """A uniform elastic bar of equal elements, upright over a rigid floor.

    Attributes
    ----------
    young, density, area, length : float
        Modulus [Pa], density [kg/m³], section [m²], length [m].
    elements : int
        Number of elements.
    """

    young: float
    density: float
    area: float
    length: float
    elements: int

    @property
    def speed(self) -> float:
        """Speed of its waves [m/s]."""
        return sqrt(self.young / self.density)

    @property
    def crossing(self) -> float:
        """Time of a wave to the far end and back [s]."""
        return 2.0 * self.length / self.speed

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self.density * self.area * self.length

    def plateau(self, velocity: float) -> float:
        """Return the force of its impact ``rho c S v`` [N]."""
        return self.density * self.speed * self.area * velocity

    def step(self, courant: float) -> float:
        """Return the step [s] of a Courant number."""
        return courant * self.length / self.elements / self.speed

    def body(self, mass: str) -> FiniteElementBeam:
        """Return the bar in finite elements."""
        # One of the bars has units of its own.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DoubtfulValue)
            material = Material(self.young, self.density)
        return FiniteElementBeam(
            material,
            Section(self.area, self.area * (SLACK * self.length / self.elements) ** 2),
            self.length,
            elements=self.elements,
            mass=mass,
            root_support="free",
        )

    def frequencies(self, mass: str) -> tuple[Array, Array]:
        """Return angular frequencies [rad/s] and modal masses [kg] at a tip moved by 1, free-free, rigid mode excluded.

        The shapes are ``cos(j pi n / N)`` for both mass matrices.
        """
        turn = np.arange(1, self.elements + 1) * pi / self.elements
        per_element = self.speed * self.elements / self.length
        share = np.ones_like(turn) if mass == "lumped" else (2.0 + np.cos(turn)) / 3.0
        modal = self.mass / 2.0 * share
        modal[-1] *= 2.0
        return per_element * np.sqrt(2.0 * (1.0 - np.cos(turn)) / share), modal


def force_of_scheme(
    bar: Bar, mass: str, central: bool, step: float, gap: float, velocity: float, duration: float
) -> Array:
    """Return the force [N] of each step when a free bar hits a rigid floor, from the bar's closed-form modes alone.

    The tip's displacement n steps after the step of a unit impulse is, summed over the modes,
    ``2 tan(phi / 2) sin(n phi) / (w² h)`` with ``sin(phi / 2) = w h / 2`` for central differences and ``phi = w h`` for
    exact modes. Each step has the impulse that closes the gap at its end, or none if that would be tensile.
    """
    angular, modal = bar.frequencies(mass)
    count = floor(duration / step)
    n = np.arange(1, count + 1)
    phase = 2.0 * np.arcsin(angular * step / 2.0) if central else angular * step
    moved = 2.0 * np.tan(phase / 2.0) * np.sin(np.outer(n, phase)) / (angular**2 * step)
    response = n * step / bar.mass + moved @ (1.0 / modal)
    impulse = np.zeros(count)
    for k in range(count):
        trial = gap - velocity * (k + 1) * step + response[1 : k + 1][::-1] @ impulse[:k]
        impulse[k] = max(0.0, -trial / response[0])
    return impulse / step


def front(bar: Bar, courant: float, mass: str, central: bool) -> float:
    """Return the width of a front after one crossing [s].

    That is Airy's ``(|a| x)^(1/3) / c`` where ``w = c k (1 - a k² / 3)``.

    In time and space ``w = c k (1 - (k l)² (1 - C²) / 24)`` for lumped mass and central differences of Courant number
    C on elements l; for consistent mass the sign of the 1 is reversed, for exact modes C vanishes.
    """
    size = bar.length / bar.elements
    bent = (-1.0 if mass == "lumped" else 1.0) + (courant**2 if central else 0.0)
    return (abs(bent) * size**2 / 8.0 * 2.0 * bar.length) ** (1.0 / 3.0) / bar.speed


WALL = Bar(210e9, 7800.0, 3.14e-4, 1.0, elements=100)
GAP, VELOCITY, DURATION = 5e-5, 0.1, 1.2e-3
BALL = Bar(900.0, 1.0, 1.0, 10.0, elements=200)
FALL, HEIGHT = 10.0, 5.0


def bounce(time: float) -> float:
    """Return the height [m] of the bottom of the bouncing bar.

    It falls freely and hits the ground at t1 with ``v = g t1``. The pressure ``rho c v + rho g c s`` lasts
    ``T = 2L / c``. Then every point moves up with v, the strain is ``(2 g x / c - g T) / c``, and the bottom swings
    about the flight of the centre by ``g s (s - T)``, s since lift-off, repeated every T. The flight of ``2 v / g`` is
    three T, so that it lands in its state at lift-off, mirrored in time.
    """
    crossing, fallen = BALL.crossing, sqrt(2.0 * HEIGHT / FALL)
    flight = 2.0 * fallen
    period = 2.0 * (fallen + crossing) + flight
    time = min(time % period, period - time % period)
    if time < fallen:
        return HEIGHT - FALL * time**2 / 2.0
    flown = time - fallen - crossing
    if flown < 0.0:
        return 0.0
    within = flown % crossing
    return FALL * (fallen * flown - flown**2 / 2.0 + within * (within - crossing))


def contacts() -> tuple[float, float, float, float]:
    """Return the times at which the bouncing bar touches and leaves the ground, twice in its first period [s]."""
    fallen = sqrt(2.0 * HEIGHT / FALL)
    leaves = fallen + BALL.crossing
    lands = leaves + 2.0 * fallen
    return fallen, leaves, lands, lands + BALL.crossing
