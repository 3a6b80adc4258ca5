"""Compliant contacts: a ball on a wall and on a beam under Hertz's law."""

from __future__ import annotations

from math import pi

import numpy as np

from ..bodies import Material, ModalBeam, PointMass, Rectangle
from ..contact import HertzStiffness, PointContact, RigidTrack
from ..drives import InitialVelocity
from ..integration import simulate
from ..lowering.schemes import Scheme
from ..records import Velocity
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme

STEEL = Material(2.157463e11, 7960.0, 0.29)
RADIUS, SPEED = 0.01, 0.01
MASS = 4.0 / 3.0 * pi * RADIUS**3 * STEEL.density
STIFFNESS = HertzStiffness.between(STEEL, STEEL, RADIUS)
# Time of an impact under Hertz's law over depth and speed: twice the integral of 1 / sqrt(1 - x^2.5) from 0 to 1.
LASTS = 2.943275


def wall() -> Outcome:
    """A ball of 10 mm meets a wall at 10 mm/s: ``m v² / 2 = 0.4 k d^2.5``, and it rebounds at the same speed."""
    ball = PointMass(MASS)
    contact = PointContact(ball.centre, RigidTrack(), stiffness=STIFFNESS)
    system = System(contact, [InitialVelocity(ball, y=-SPEED)])
    k = STIFFNESS.numbers[0]
    depth = (1.25 * MASS * SPEED**2 / k) ** 0.4
    curves = []

    def rows(scheme: Scheme) -> list[Row]:
        step = 2.5e-7
        probes = [Velocity(ball.centre, "y")]
        run = simulate(system, 2.2e-4, scheme=scheme, step=step, sample_rate=1.0 / step, probes=probes)
        force, time = run["normal_force"].values, run["time"].values
        curves.append(Curve(1e6 * time, force, scheme.name))
        # Second order in the step over the time of contact.
        share = (pi * step * SPEED / (LASTS * depth)) ** 2
        lasts = float(np.ptp(time[force > 0.0])) + step
        return [
            Row(
                "largest force",
                k * depth**1.5,
                float(force.max()),
                share * k * depth**1.5,
                "second order",
                "N",
                scheme.name,
            ),
            Row("time of contact", LASTS * depth / SPEED, lasts, 2.0 * step, "two steps", "s", scheme.name),
            Row(
                "rebound",
                SPEED,
                float(run["velocity"][-1, 0]),
                share**2 * SPEED,
                "fourth order",
                "m/s",
                scheme.name,
            ),
        ]

    found = by_scheme(rows)
    return Outcome(found, Sketch("time [us]", "force [N]", curves))


def beam() -> Outcome:
    """The ball meets the middle of a simply supported steel beam, 10 x 10 x 153.5 mm, which absorbs most of its energy.

    Force, times and rebound of Timoshenko's problem (1913) by a fine integration of its integral equation, as used to
    compare contact codes.
    """
    bar = ModalBeam(STEEL, Rectangle(0.01, 0.01), 0.1535, bending_modes=40, axial_modes=1)
    ball = PointMass(MASS)
    contact = PointContact(ball.centre, bar, 0.1535 / 2.0, stiffness=STIFFNESS)
    system = System(contact, [InitialVelocity(ball, y=-SPEED)])
    curves = []

    def rows(scheme: Scheme) -> list[Row]:
        probes = [Velocity(ball.centre, "y")]
        step = 2.5e-7 if scheme.name == "exact modal" else None
        run = simulate(system, 4e-4, scheme=scheme, step=step, sample_rate=4e6, probes=probes)
        force, time = run["normal_force"].values, run["time"].values
        curves.append(Curve(1e6 * time, force, scheme.name))
        reason = "digits given, and the step over the rise"
        lasts = float(np.ptp(time[force > 0.0]))
        return [
            Row("largest force", 4.9669, float(force.max()), 2e-3, reason, "N", scheme.name),
            Row("time of it", 72.8e-6, float(time[force.argmax()]), 5e-7, reason, "s", scheme.name),
            Row("time of contact", 156.7e-6, lasts, 5e-7, reason, "s", scheme.name),
            Row("rebound", 3.0267e-3, float(run["velocity"][-1, 0]), 5e-6, reason, "m/s", scheme.name),
        ]

    found = by_scheme(rows)
    return Outcome(found, Sketch("time [us]", "force [N]", curves))


CASES = (
    Case("hertz-on-a-wall", "A ball on a wall under Hertz's law", "Hertz (1882), closed form", wall),
    Case(
        "hertz-on-a-beam", "A ball on a beam under Hertz's law", "Timoshenko (1913); benchmark of contact codes", beam
    ),
)
