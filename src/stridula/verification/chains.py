"""A cyclic chain of masses on cubic springs, of a published test manual, and its equation integrated apart."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
from scipy.integrate import solve_ivp

from ..arrays import Array
from ..bodies import PointMass
from ..connections import Connection, CubicSpring, Dashpot, Spring
from ..contact import PointContact, RigidTrack
from ..drives import Force, InitialState
from ..histories import Harmonic
from ..integration import simulate
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, schemes

# Masses [kg], spring to the ground [N/m, N/m³], spring between neighbours [N/m], damping [N s/m], force on each [N].
MASSES, MASS, GROUND, CUBIC, NEIGHBOUR, FORCE = 6, 1.0, 8766.2, 4.6752e7, 148.36, 0.125
DAMPING = sqrt(GROUND * MASS) / 200.0
# Angular frequency of the peak [rad/s], and the amplitude of the first harmonic printed there [m].
PEAK, PRINTED = 95.09, 2.80e-3
# Duration until the start has decayed [s], and periods that are evaluated.
DURATION, LAST = 25.0, 20


def chain() -> System:
    """Return the chain, in motion on its upper branch, with forces in phase."""
    masses = [PointMass(MASS, name=f"mass {number + 1}") for number in range(MASSES)]
    connections = list[Connection]()
    for one, other in zip(masses, [*masses[1:], masses[0]], strict=True):
        connections += [
            CubicSpring(one.centre, stiffness=GROUND, cubic=CUBIC),
            Spring(one.centre, other.centre, stiffness=NEIGHBOUR),
            Dashpot(one.centre, coefficient=DAMPING),
        ]
    history = Harmonic(PEAK / (2.0 * pi))
    forces = [Force(one.centre, x=FORCE, history=history) for one in masses]
    starts = [InitialState(one, displacement=(-PRINTED, 0.0)) for one in masses]
    pressed = Force(masses[0].centre, y=-1.0)
    return System(PointContact(masses[0].centre, RigidTrack()), [*forces, *starts, pressed], connections)


def first_harmonic(time: Array, place: Array) -> float:
    """Return the amplitude of the first harmonic [m]."""
    return float(abs(2.0 * np.trapezoid(place * np.exp(-1j * PEAK * time), time) / np.ptp(time)))


def _rates(time: float, state: Array) -> list[float]:
    place, speed = state
    pull = GROUND * place + CUBIC * place**3 + DAMPING * speed
    return [speed, (FORCE * np.sin(PEAK * time) - pull) / MASS]


def cubic_chain() -> Outcome:
    """The peak of the chain, which moves as one mass."""
    apart = solve_ivp(_rates, (0.0, DURATION), [-PRINTED, 0.0], "DOP853", None, True, rtol=1e-10, atol=1e-13)
    system, rows, curves = chain(), list[Row](), list[Curve]()
    for scheme in schemes():
        probes = [Displacement(body.centre, "x") for body in system.bodies]
        run = simulate(system, DURATION, scheme=scheme, probes=probes)
        late = run["time"].values >= DURATION - LAST * 2.0 * pi / PEAK
        time, places = run["time"].values[late], run["displacement"].values[late]
        expected, found = (first_harmonic(time, one) for one in (apart.sol(time)[0], places[:, 0]))
        apart_by = float(np.ptp(places, axis=1).max())
        rows += [
            Row("first harmonic at the peak", PRINTED, found, 5e-3 * PRINTED, "the digits printed", "m", scheme.name),
            Row("the same", expected, found, 1e-5 * expected, "a hundred-thousandth", "m", scheme.name),
            Row("difference between the masses", 0.0, apart_by, 1e-12, "round-off", "m", scheme.name),
        ]
        curves.append(Curve(1e3 * (time - time[0]), 1e3 * places[:, 0], scheme.name))
    return Outcome(rows, Sketch("time [ms]", "displacement [mm]", curves))


CASES = (
    Case(
        "cubic-chain",
        "A cyclic chain of masses on cubic springs at its peak",
        "Ansys Mechanical APDL Verification Manual, VM319: 2.80 mm at 95.09 rad/s; its equation by an adaptive method",
        cubic_chain,
    ),
)
