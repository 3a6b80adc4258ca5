"""Friction in two directions: a particle on a slope, and motion across the slip."""

from __future__ import annotations

from math import pi, sin, sqrt

import numpy as np

from ..integration import simulate
from ..linear.equilibrium import find_equilibrium
from ..linear.modes import modes_of
from ..linear.structure import Structure
from ..linear.vibration import vibration
from ..lowering.schemes import Scheme
from ..records import Displacement
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme
from .systems.in_space import (
    GRAVITY,
    MASS,
    PRINTED_RATIO,
    RATIO,
    SLOPE,
    STIFFNESS,
    THROWN,
    swinging,
    thrown_on_a_slope,
)


def slope() -> Outcome:
    """A particle thrown along a slope of friction's own angle: its speed and its speed downhill add up to a constant.

    Friction and weight along the slope are equal in size, so the speed loses what the speed downhill gains. In the end
    it moves straight down, at half its initial speed.
    """
    system, step = thrown_on_a_slope(), 1e-3
    # It turns within v / g sin.
    share = (step * GRAVITY * sin(SLOPE) / THROWN) ** 2
    curves = [Curve(np.array([0.0, 5.0]), np.full(2, THROWN / 2.0), "half the speed at the start")]

    def rows(scheme: Scheme) -> list[Row]:
        run = simulate(system, 5.0, scheme=scheme, step=step, sample_rate=1.0 / step, probes=[])
        along, up = run["slip_velocity"].values.T
        speed = np.hypot(along, up)
        curves.append(Curve(run["time"].values, speed, f"speed, {scheme.name}"))
        whole, reason = speed - up, "second order of the step over the time in which it turns"
        worst = float(whole[np.abs(whole - THROWN).argmax()])
        return [
            Row("speed in the end", THROWN / 2.0, float(speed[-1]), share * THROWN, reason, "m/s", scheme.name),
            Row(
                "speed plus downhill speed, at the largest error",
                THROWN,
                worst,
                2.0 * share * THROWN,
                reason,
                "m/s",
                scheme.name,
            ),
            Row("velocity across in the end", 0.0, float(along[-1]), 1e-9, "falls exponentially", "m/s", scheme.name),
        ]

    return Outcome(by_scheme(rows), Sketch("time [s]", "speed [m/s]", curves))


def across() -> Outcome:
    """8 kg on 315 N/m across a slip of 10 m/s under 1 N and mu = 0.5: friction damps it by mu N / (2 v sqrt(k m))."""
    known, own, periods = RATIO, sqrt(STIFFNESS / MASS), 30
    system, moving = swinging(), swinging(across=1e-3)
    structure = Structure(system)
    found = modes_of(structure, vibration(structure, find_equilibrium(structure, np.zeros(1)))).values
    theory = float((-found.real / np.abs(found)).max())
    printed = [
        Row("damping ratio, linear theory", known, theory, 1e-12, "round-off"),
        Row("damping ratio as printed", PRINTED_RATIO, known, 5e-10, "digits printed by Ansys VM274"),
    ]
    per_period = 400
    step = 2.0 * pi / own / per_period
    curves = []

    def rows(scheme: Scheme) -> list[Row]:
        probes = [Displacement(moving.contacts[0].tip, "z")]
        run = simulate(
            moving, periods * per_period * step, scheme=scheme, step=step, sample_rate=1.0 / step, probes=probes
        )
        swings = np.abs(run["displacement"].values[:, 0]).reshape(periods, per_period).max(axis=1)
        # The largest value of a period comes first, after a quarter of it.
        times = (np.arange(periods) + 0.25) * per_period * step
        curves.append(Curve(times, 1e3 * swings, scheme.name, marks=True))
        ratio = -float(np.polyfit(times, np.log(swings), 1)[0]) / own
        # Peaks between samples, and the slip velocity of friction from three slips, both have a relative error of
        # (w h)² / 2.
        tolerance = 2.0 * (own * step) ** 2 * known + 0.5 * (own * step) ** 2 / (periods * own * per_period * step)
        return [Row("damping ratio, decay", known, ratio, tolerance, "sampling and step, (w h)²", "1", scheme.name)]

    measured = by_scheme(rows)
    times = np.linspace(0.0, periods * per_period * step, 50)
    decay = Curve(times, 1e3 * 1e-3 / own * np.exp(-known * own * times), "closed form")
    return Outcome([*printed, *measured], Sketch("time [s]", "swing across [mm]", [decay, *curves]))


CASES = (
    Case(
        "particle-on-a-slope",
        "A particle thrown along a slope at the angle of friction",
        "energy and momentum along the slope, closed form",
        slope,
    ),
    Case(
        "transverse-damping",
        "Friction damps motion across the slip",
        "Ansys VM274 (transverse vibration of a mass on a belt)",
        across,
    ),
)
