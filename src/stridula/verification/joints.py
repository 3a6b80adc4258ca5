"""Contacts with a joint along their tangents, and a mass that falls on a spring, of a published test manual."""

from __future__ import annotations

from math import asin, pi, sqrt

import numpy as np

from ..analysis.stability import sliding_stability
from ..bodies import PointMass
from ..connections import Dashpot, Spring
from ..contact import Coulomb, PointContact, RigidTrack
from ..drives import Force
from ..histories import Harmonic
from ..integration import simulate
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, schemes

# VM320: mass [kg], stiffness of the mount and of the joint [N/m], dashpot [N s/m], limit of friction and force [N].
MASS, MOUNT, JOINT, DASHPOT, LIMIT, FORCE = 944.6, 2.4e7, 2.4e7, 7700.0, 246.048, 123.024
# Frequency of the force [rad/s], duration until the start has decayed [s], and periods that are evaluated.
DRIVEN, DURATION, LAST = 209.0, 3.0, 10
# VM65: mass [kg], stiffness [N/m], gravity [m/s²] and height of the fall [m], in any consistent units.
FALLING, SPRING, GRAVITY, HEIGHT = 0.5, 1973.92, 386.0, 1.0


def machine(driven: bool) -> System:
    """Return the mass on its mount beside the friction damper, at rest or driven by a cosine."""
    mass = PointMass(MASS, name="machine")
    contact = PointContact(mass.centre, RigidTrack(), friction=Coulomb(0.5), tangential_stiffness=JOINT, name="damper")
    pressed = Force(mass.centre, y=-2.0 * LIMIT)
    shaken = Force(mass.centre, x=FORCE, history=Harmonic(DRIVEN / (2.0 * pi), phase=0.5 * pi))
    mount: list[Spring | Dashpot] = [Spring(mass.centre, stiffness=MOUNT), Dashpot(mass.centre, coefficient=DASHPOT)]
    return System(contact, [pressed, shaken] if driven else [pressed], mount)


def damper() -> Outcome:
    """The first harmonic of the driven machine, and its resonances with the damper stuck and slipping."""
    system = machine(True)
    rows, curves = list[Row](), list[Curve]()
    for scheme in schemes():
        probes = [Displacement(system.bodies[0].centre, "x")]
        run = simulate(system, DURATION, scheme=scheme, probes=probes)
        time, place = run["time"].values, run["displacement"].values[:, 0]
        late = time >= time[-1] - LAST * 2.0 * pi / DRIVEN
        turning = place[late] * np.exp(-1j * DRIVEN * time[late])
        harmonic = float(abs(2.0 * np.trapezoid(turning, time[late]) / np.ptp(time[late])))
        rows.append(Row("first harmonic", 1.505369e-5, harmonic, 1e-3 * 1.505369e-5, "a thousandth", "m", scheme.name))
        force = run["tangential_force"].values.ravel()[late]
        curves.append(Curve(1e6 * place[late], force, scheme.name))
    resting = machine(False)
    for words, found, expected in (
        ("stuck", sliding_stability(resting, status="sticking"), sqrt((MOUNT + JOINT) / MASS)),
        ("slipping", sliding_stability(resting, velocity=0.1), sqrt(MOUNT / MASS)),
    ):
        exponents = found["growth_rate"].values + 2j * pi * found["frequency"].values
        # In space the mass also moves across, where it has no mount: slower, or without an oscillation.
        along = float(np.abs(exponents[exponents.imag.argmax()]))
        rows.append(Row(f"resonance, {words}", expected, along, 1e-9 * expected, "round-off", "rad/s"))
    return Outcome(rows, Sketch("displacement [µm]", "force of the damper [N]", curves))


def fall() -> Outcome:
    """The lowest point of a mass that falls on a spring, and its time, in closed form."""
    speed, rate, rest = sqrt(2.0 * GRAVITY * HEIGHT), sqrt(SPRING / FALLING), FALLING * GRAVITY / SPRING
    swing = sqrt(rest**2 + (speed / rate) ** 2)
    lowest = -HEIGHT - rest - swing
    when = sqrt(2.0 * HEIGHT / GRAVITY) + (0.5 * pi + asin(rest / swing)) / rate
    mass = PointMass(FALLING)
    rows, curves = list[Row](), list[Curve]()
    contact = PointContact(mass.centre, RigidTrack(), stiffness=SPRING, gap=HEIGHT)
    system = System(contact, [Force(mass.centre, y=-FALLING * GRAVITY)])
    for scheme in schemes():
        run = simulate(system, 0.25, scheme=scheme, probes=[Displacement(mass.centre, "y")])
        time, height = run["time"].values, run["displacement"].values[:, 0]
        first = int(height.argmin())
        a, b, c = np.polyfit(time[first - 2 : first + 3] - time[first], height[first - 2 : first + 3], 2)
        found, at = c - b * b / (4.0 * a), time[first] - b / (2.0 * a)
        rows += [
            Row("lowest point", lowest, float(found), 1e-4, "a ten-thousandth of the fall", "m", scheme.name),
            Row("its time", when, float(at), 1e-4 * when, "a ten-thousandth", "s", scheme.name),
        ]
        curves.append(Curve(time, height, scheme.name))
    return Outcome(rows, Sketch("time [s]", "height [m]", curves))


CASES = (
    Case(
        "friction-damper",
        "A machine with a friction damper in series with a spring",
        "Ansys Mechanical APDL Verification Manual, VM320: first harmonic; closed form of the resonances",
        damper,
    ),
    Case(
        "fall-on-a-spring",
        "A mass that falls on a spring",
        "Ansys Mechanical APDL Verification Manual, VM65 (lowest point -1.5506 at 0.10037), closed form",
        fall,
    ),
)
