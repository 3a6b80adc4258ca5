"""One mass on a spring, rubbed by a floor or a belt, under any law of friction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import asinh, atan, cos, exp, hypot, log, pi, sin, sqrt
from typing import Any, cast

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

from ...arrays import Array
from ...bodies import PointMass
from ...connections import Dashpot, Spring
from ...contact import Coulomb, FrictionLaw, PointContact, RigidTrack, StaticKinetic
from ...drives import Force, InitialState
from ...histories import Harmonic
from ...integration import simulate
from ...lowering.schemes import Scheme
from ...records import Displacement
from ...system import System

# A function of slip velocity and state that returns the ratio of forces and the rate of the state.
Rubbing = Callable[[float, float], tuple[float, float]]


@dataclass(frozen=True)
class Slider:
    """A mass on a spring, pressed on a floor: ``m x'' + c x' + k x = -mu N sign(x' - belt)``.

    Attributes
    ----------
    mass, stiffness, normal : float
        Mass [kg], stiffness of its spring [N/m], force that presses it on the floor [N].
    friction : FrictionLaw
        Law of friction.
    position, velocity : float, optional
        Start [m, m/s].
    belt : float, optional
        Velocity of the floor [m/s].
    push : Harmonic, optional
        Factor on a force of 1 N along the floor; none if left out.
    dashpot : float, optional
        Coefficient of a dashpot beside the spring [N s/m].
    """

    mass: float
    stiffness: float
    normal: float
    friction: FrictionLaw
    position: float = 0.0
    velocity: float = 0.0
    belt: float = 0.0
    push: Harmonic | None = None
    dashpot: float = 0.0

    def system(self, track: RigidTrack | None = None, **contact: Any) -> System:
        """Return its system, on `track` where given, with further arguments of its contact."""
        body = PointMass(self.mass)
        drives: list[Any] = [Force(body.centre, y=-self.normal)]
        if self.position or self.velocity:
            drives.append(InitialState(body, displacement=(self.position, 0.0), velocity=(self.velocity, 0.0)))
        if self.push:
            drives.append(Force(body.centre, x=1.0, history=self.push))
        held: list[Any] = [Spring(body.centre, stiffness=self.stiffness)]
        if self.dashpot:
            held.append(Dashpot(body.centre, coefficient=self.dashpot))
        track = track or RigidTrack(velocity=self.belt)
        return System(PointContact(body.centre, track, friction=self.friction, **contact), drives, held)

    def run(self, duration: float, step: float, scheme: Scheme) -> xr.Dataset:
        """Simulate and record every step."""
        system = self.system()
        probes = [Displacement(system.contacts[0].tip, "x")]
        return simulate(system, duration, scheme=scheme, step=step, sample_rate=1.0 / step, probes=probes)

    def rates(self, rubbing: Rubbing | None = None) -> Callable[[float, Array], list[float]]:
        """Return the rates of place, slip velocity and state of the law, as a solver takes them."""
        rubbing = rubbing or rubbing_of(self.friction)

        def rates(_: float, y: Array) -> list[float]:
            place, slip, state = (float(one) for one in y)
            velocity, (ratio, rate) = slip + self.belt, rubbing(slip, state)
            force = -self.stiffness * place - self.dashpot * velocity - ratio * self.normal
            return [velocity, force / self.mass, rate]

        return rates

    def turns(self, duration: float, state: float, rubbing: Rubbing | None = None) -> tuple[Array, Array]:
        """Return the times and places at which the mass turns round, by LSODA to 1e-11 from a state of the law."""

        def turned(_: float, y: Array) -> float:
            return float(y[1]) + self.belt

        found = solve_ivp(
            self.rates(rubbing),
            (0.0, duration),
            [self.position, self.velocity - self.belt, state],
            method="LSODA",
            rtol=1e-11,
            atol=1e-15,
            events=turned,
            max_step=duration / 2000.0,
        )
        return found.t_events[0], found.y_events[0][:, 0]


def rubbing_of(law: Any) -> Rubbing:
    """Return the equations of a law of friction, those with a state written out."""

    def plain(slip: float, _: float) -> tuple[float, float]:
        return float(np.sign(slip) * law.coefficient_at(slip)), 0.0

    def bristles(slip: float, z: float) -> tuple[float, float]:
        curve = law.kinetic + (law.static - law.kinetic) * exp(-((slip / law.velocity) ** 2))
        rate = slip - law.stiffness * abs(slip) * z / curve
        return law.stiffness * z + law.damping * rate + law.viscous * slip, rate

    def aged(slip: float, theta: float) -> tuple[float, float]:
        passed = abs(slip) * theta / law.slip_distance
        exponent = (law.reference + law.b * log(law.velocity * theta / law.slip_distance)) / law.a
        ratio = law.a * asinh(slip / (2.0 * law.velocity) * exp(exponent))
        return ratio, 1.0 - passed if law.evolution == "aging" else -passed * log(passed)

    return {"lugre": bristles, "rate and state": aged}.get(law.law, plain)


def turning_points(position: float, velocity: float, angular: float, offset: float) -> tuple[list[float], float]:
    """Return the turning points of a mass on a spring under Coulomb friction, the last being its rest, and their times.

    It swings about ``-offset sign(x')`` with ``offset = mu N / k``: the amplitude falls by ``2 offset`` every half
    period, and it stays at the first turning point within the offset.
    """
    if velocity == 0.0:
        sense, first, time = (-1.0 if position > 0 else 1.0), position, 0.0
        points = []
    else:
        sense = 1.0 if velocity > 0 else -1.0
        centre = -offset * sense
        first = centre + sense * hypot(position - centre, velocity / angular)
        # Phase from the start to the turning point of the circle about the centre.
        time = atan(abs(velocity) / angular / abs(position - centre)) / angular
        points, sense = [first], -sense
    place = first
    while abs(place) > offset:
        place = -place - 2.0 * offset * sense
        points.append(place)
        time += pi / angular
        sense = -sense
    return points, time


@dataclass(frozen=True)
class StickSlip:
    """The cycle of a mass on a belt with constant static and kinetic friction.

    Attributes
    ----------
    slip, stick : float
        Times of slip and of stick [s].
    lowest, highest : float
        Ends of the motion [m].
    slowest : float
        Least velocity [m/s].
    """

    slip: float
    stick: float
    lowest: float
    highest: float
    slowest: float


def stick_slip(slider: Slider) -> StickSlip:
    """Return the cycle under `StaticKinetic` friction.

    From the static limit the mass swings about the kinetic one until it moves with the belt again.

    With ``D = (mu_s - mu_k) N / k`` it leaves at ``x_k + D`` with the belt's velocity v, so its amplitude is
    ``sqrt(D² + (v/w)²)``, and it comes back to v at ``x_k - D``.
    """
    law = cast(StaticKinetic, slider.friction)
    angular = sqrt(slider.stiffness / slider.mass)
    reach = (law.static - law.kinetic) * slider.normal / slider.stiffness
    middle = law.kinetic * slider.normal / slider.stiffness
    amplitude = hypot(reach, slider.belt / angular)
    return StickSlip(
        slip=2.0 / angular * (pi - atan(reach * angular / slider.belt)),
        stick=2.0 * reach / slider.belt,
        lowest=middle - amplitude,
        highest=middle + amplitude,
        slowest=-amplitude * angular,
    )


def den_hartog(frequency: float, friction: float) -> float:
    """Return the amplitude of a mass on a spring, both 1, under ``cos(w t)`` N and little friction, never at rest.

    With ``V = 1 / (1 - w²)`` and ``U = sin(pi/w) / (w (1 + cos(pi/w)))`` it is ``sqrt(V² - (U mu N)²)``.
    """
    high = 1.0 / (1.0 - frequency**2)
    wide = sin(pi / frequency) / (frequency * (1.0 + cos(pi / frequency)))
    return sqrt(high**2 - (wide * friction) ** 2)


def swing(frequency: float, friction: float, count: float, scheme: Scheme) -> float:
    """Return the amplitude of the same mass, simulated in `count` steps per period; peaks by parabolas."""
    period = 2.0 * pi / frequency
    swung = Slider(1.0, 1.0, 1.0, Coulomb(friction), push=Harmonic(1.0 / period))
    place = swung.run(150.0 * period, period / count, scheme)["displacement"].values[-int(20 * count) :, 0]
    top = np.flatnonzero((place[1:-1] > place[:-2]) & (place[1:-1] >= place[2:])) + 1
    before, highest, after = place[top - 1], place[top], place[top + 1]
    return float(np.mean(highest + (before - after) ** 2 / (8.0 * (2.0 * highest - before - after))))
