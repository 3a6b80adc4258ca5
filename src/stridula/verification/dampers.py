"""A mass that coasts against a damper with a valve: its motion and its loss in closed form."""

from __future__ import annotations

from math import exp, log

import numpy as np

from ..arrays import Array
from ..bodies import PointMass
from ..connections import TabulatedDashpot
from ..contact import Coulomb, PointContact, RigidTrack
from ..drives import Force, InitialVelocity
from ..integration import simulate
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, schemes

# Mass [kg], damping [N s/m] below the velocity [m/s] at which the valve opens and above it, velocity at the start.
MASS, SHUT, OPENS, OPEN, START = 2.0, 40.0, 0.5, 8.0, 2.0
DURATION = 0.6
# Force of the open valve beyond its damping [N].
HELD = (SHUT - OPEN) * OPENS


def damper() -> System:
    """Return the mass on a plane without friction, against the damper."""
    mass = PointMass(MASS)
    velocity, force = [-OPENS, 0.0, OPENS, 2.0 * OPENS], [-3.0, 0.0, SHUT * OPENS, (SHUT + OPEN) * OPENS]
    contact = PointContact(mass.centre, RigidTrack(), friction=Coulomb(0.0))
    drives = [Force(mass.centre, y=-1.0), InitialVelocity(mass, x=START)]
    return System(contact, drives, [TabulatedDashpot(mass.centre, velocity=velocity, force=force)])


def closing() -> tuple[float, float]:
    """Return the time [s] and the displacement [m] at which the valve closes."""
    time = MASS / OPEN * log((START + HELD / OPEN) / (OPENS + HELD / OPEN))
    return time, MASS / OPEN * (START - OPENS) - HELD / OPEN * time


def coasted(time: Array) -> tuple[Array, Array]:
    """Return displacement [m] and velocity [m/s] over time."""
    closes, way = closing()
    early = (START + HELD / OPEN) * np.exp(-OPEN / MASS * time)
    late = OPENS * np.exp(-SHUT / MASS * np.maximum(time - closes, 0.0))
    first = MASS / OPEN * (START + HELD / OPEN - early) - HELD / OPEN * time
    is_open = time < closes
    place = np.where(is_open, first, way + MASS / SHUT * (OPENS - late))
    return place, np.where(is_open, early - HELD / OPEN, late)


def valve() -> Outcome:
    """The way of the mass, and the loss in the damper."""
    closes, way = closing()
    end = way + MASS / SHUT * OPENS * (1.0 - exp(-SHUT / MASS * (DURATION - closes)))
    rows, curves = list[Row](), list[Curve]()
    for scheme in schemes():
        system = damper()
        run = simulate(system, DURATION, scheme=scheme, probes=[Displacement(system.bodies[0].centre, "x")])
        time, found = run["time"].values, run["displacement"].values[:, 0]
        # Losses are those until half a step before, since half a step before the start.
        half = 0.5 * float(run.attrs["step"])
        given = SHUT * OPENS + OPEN * (START - OPENS)
        lost = 0.5 * MASS * (START**2 - float(coasted(time[-1:] - half)[1][0]) ** 2) + given * START * half
        rows += [
            Row(
                "way when the valve closes",
                way,
                float(np.interp(closes, time, found)),
                1e-6 * way,
                "1e-6",
                "m",
                scheme.name,
            ),
            Row("way at the end", end, float(found[-1]), 1e-6 * end, "1e-6", "m", scheme.name),
            Row("loss in the damper", lost, float(run["damping_loss"][-1]), 1e-6 * lost, "1e-6", "J", scheme.name),
        ]
        curves.append(Curve(1e3 * time, 1e3 * found, scheme.name))
    return Outcome(rows, Sketch("time [ms]", "displacement [mm]", curves))


CASES = (
    Case(
        "valve-damper",
        "A mass that coasts against a damper with a valve",
        "closed form: two exponential functions, joined where the valve closes",
        valve,
    ),
)
