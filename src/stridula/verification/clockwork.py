"""Stick-slip of a mass on a belt under every law of friction, in few steps a period."""

from __future__ import annotations

from math import exp, log, pi
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from ..arrays import Array
from ..contact import (
    ExponentialWeakening,
    FrictionLaw,
    LinearWeakening,
    LuGre,
    RateAndState,
    StaticKinetic,
    Stribeck,
    TabulatedFriction,
)
from ..lowering.schemes import ExactModal
from .case import Case, Curve, Outcome, Row, Sketch
from .systems.on_belts import Slider, rubbing_of

# The mass is 1 kg and swings once a second, pressed by the force of its spring at a stretch of one metre.
STIFFNESS = 4.0 * pi**2
LAWS: dict[str, FrictionLaw] = {
    "static and kinetic": StaticKinetic(0.6, 0.3),
    "Stribeck": Stribeck(0.6, 0.3, velocity=0.3, viscous=0.02),
    "exponential": ExponentialWeakening(0.6, 0.3, velocity=0.3),
    "linear": LinearWeakening(0.6, slope=0.5, kinetic=0.3),
    "tabulated": TabulatedFriction([0.0, 0.1, 0.3, 0.6, 1.2, 2.0, 4.0], [0.6, 0.52, 0.41, 0.34, 0.3, 0.31, 0.33], 0.6),
    "LuGre": LuGre(0.6, 0.3, velocity=0.3, stiffness=100.0, damping=1.0),
    "rate and state, aging": RateAndState(0.5, a=0.01, b=0.05, slip_distance=0.05, velocity=0.4),
    "rate and state, slip": RateAndState(0.5, a=0.01, b=0.05, slip_distance=0.05, velocity=0.4, evolution="slip"),
}
SLOWER, FASTER = 0.4, 1.5
SETTLED, PERIODS = 20.0, 40.0
COUNTS = (50, 20)
REASON = "one per cent at twenty steps a period, and so many at fifty"


def is_aged(law: FrictionLaw) -> bool:
    """Return whether the state of a law is a time."""
    return law.state_units == "s"


def slider(law: FrictionLaw, belt: float) -> Slider:
    """Return the mass on a belt, at rest with it where friction at rest just holds the spring."""
    start = getattr(law, "static", 0.5)
    return Slider(1.0, STIFFNESS, STIFFNESS, law, position=0.999 * start, velocity=0.0, belt=belt)


def cycle(law: Any, belt: float) -> tuple[float, float, float]:
    """Return period [s] and ends of the motion [m] of the cycle of stick and slip under a set-valued law.

    The mass breaks away where the spring takes all that friction holds, slides until it moves with the belt again, and
    is carried to where it broke away.
    """

    def sliding(_: float, y: Array) -> list[float]:
        back = belt - float(y[1])
        ratio = float(law.kinetic if law.law == "static-kinetic" else law.coefficient_at(back))
        return [float(y[1]), STIFFNESS * (ratio - float(y[0]))]

    def caught(time: float, y: Array) -> float:
        return float(y[1]) - belt if time > 0.01 else -1.0

    def turned(_: float, y: Array) -> float:
        return float(y[1])

    caught.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(
        sliding, (0.0, 10.0), [law.static, belt], method="DOP853", rtol=1e-12, atol=1e-14, events=(caught, turned)
    )
    slip, place = found.t_events[0][0], found.y_events[0][0][0]
    ends = found.y_events[1][:, 0]
    return float(slip + (law.static - place) / belt), float(ends.min()), float(ends.max())


def swings(law: Any, belt: float) -> tuple[float, float, float]:
    """Return period [s] and ends of the motion [m] under a law with internal state, by LSODA.

    The age of a contact is taken as its logarithm.
    """
    mass, rubbing, aged = slider(law, belt), rubbing_of(law), is_aged(law)

    def rates(_: float, y: Array) -> list[float]:
        state = exp(y[2]) if aged else float(y[2])
        ratio, rate = rubbing(float(y[1]) - belt, state)
        return [float(y[1]), -STIFFNESS * (float(y[0]) + ratio), rate / state if aged else rate]

    def turned(_: float, y: Array) -> float:
        return float(y[1])

    start = [mass.position, 0.0, log(law.state_at_start) if aged else 0.0]
    span = (0.0, SETTLED + PERIODS)
    found = solve_ivp(rates, span, start, method="LSODA", rtol=1e-10, atol=1e-12, events=turned, max_step=0.02)
    late = found.t_events[0] > SETTLED
    time, place = found.t_events[0][late], found.y_events[0][late, 0]
    top = place > place.mean()
    return float(np.diff(time[top]).mean()), float(place[~top].mean()), float(place[top].mean())


def extremes(time: Array, place: Array) -> tuple[Array, Array]:
    """Return times and heights of the peaks of a sampled motion, by parabolas."""
    top = np.flatnonzero((place[1:-1] > place[:-2]) & (place[1:-1] >= place[2:]) & (place[1:-1] > place.mean())) + 1
    before, at, after = place[top - 1], place[top], place[top + 1]
    bent = 2.0 * at - before - after
    return time[top] + (after - before) / (2.0 * bent) * (time[1] - time[0]), at + (after - before) ** 2 / (8.0 * bent)


def clockwork() -> Outcome:
    """Period and swing of the cycle under eight laws at two velocities of the belt, in 50 and in 20 steps a period."""
    rows, curves, scheme = [], [], ExactModal()
    for name, law in LAWS.items():
        for belt in (0.5 * SLOWER, SLOWER) if is_aged(law) else (SLOWER, FASTER):
            period, lowest, highest = (cycle if law.set_valued else swings)(law, belt)
            for count in COUNTS:
                run = slider(law, belt).run(SETTLED + PERIODS, 1.0 / count, scheme)
                time, place = run["time"].values, run["displacement"].values[:, 0]
                late = time > SETTLED
                tops, heights = extremes(time[late], place[late])
                _, depths = extremes(time[late], -place[late])
                at = f"{name}, belt {belt:g} m/s, {count} steps"
                wide = float(heights.mean() + depths.mean())
                rows += [
                    Row(f"{at}: period", period, float(np.diff(tops).mean()), 0.01 * period, REASON, "s"),
                    Row(f"{at}: swing", highest - lowest, wide, 0.01 * (highest - lowest), REASON, "m"),
                ]
                if belt == SLOWER and count == COUNTS[-1]:
                    span = late & (time < SETTLED + 4.0)
                    curves.append(Curve(time[span] - SETTLED, place[span], name, marks=True))
    return Outcome(rows, Sketch("time [s]", "displacement [m]", curves))


CASES = (
    Case(
        "clockwork",
        "Stick-slip of a mass on a belt under eight laws, in few steps a period",
        "integration from stop to start by scipy's DOP853 to 1e-12; LSODA to 1e-10 for laws with a state",
        clockwork,
    ),
)
