"""Cattaneo's problem: a ball pressed on a plane and pulled along it sticks in the middle and slips around it."""

from __future__ import annotations

from math import pi, sqrt
from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..bodies import Material, ModalBody
from ..contact import Coulomb, PointContact
from ..drives import Force
from ..histories import Sampled
from ..integration import simulate
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch

RADIUS, SHEAR, POISSON = 0.05, 2e8, 0.42
PRESSED, FRICTION, PULLED = 9.1954, 0.4, 7.0 / 8.0
# Squares over the diameter of the contact; odd, so that one lies in the middle.
GRIDS = (11, 19)
# Steps of the rise of forces, and of the settling of the ball.
RISE, REST = 30, 40
STEP = 1e-3


class Known(NamedTuple):
    """Closed form: Hertz for the pressure, Cattaneo and Mindlin for the shear; lengths in m, pressures in Pa."""

    radius: float
    approach: float
    peak: float
    shift: float
    stuck: float


class Found(NamedTuple):
    """Final state of a run: the quantities of the closed form, and the tractions over the squares."""

    known: Known
    distance: Array
    pressure: Array
    shear: Array


def closed_form(pulled: float = PULLED) -> Known:
    """Return the answer for a pull of `pulled` times the force of full slip, for equal ball and plane."""
    radius = (3.0 * (1.0 - POISSON) * PRESSED * RADIUS / (4.0 * SHEAR)) ** (1.0 / 3.0)
    stuck = (1.0 - pulled) ** (1.0 / 3.0)
    shift = 3.0 * FRICTION * PRESSED * (2.0 - POISSON) / (8.0 * SHEAR * radius) * (1.0 - stuck**2)
    return Known(radius, radius**2 / RADIUS, 1.5 * PRESSED / (pi * radius**2), shift, stuck * radius)


def press_and_pull(squares: int, pulled: float = PULLED) -> Found:
    """Press the ball on a half-space of squares, pull it, and measure; `squares` over the diameter of the contact."""
    known = closed_form()
    side = 2.0 * known.radius / squares
    line = side * np.arange(-(squares // 2 + 1), squares // 2 + 2)
    places = np.stack(np.meshgrid(line, 0.0, line, indexing="ij"), axis=-1).reshape(-1, 3)
    distance = np.linalg.norm(places, axis=1)
    near = distance < known.radius + side
    places, distance = places[near], distance[near]
    # Ball and plane are equal, so that the compliance is twice that of one.
    material = Material(SHEAR * (1.0 + POISSON), 1000.0, POISSON)
    plane = ModalBody.half_space(material, places, side, coupled=False, name="plane")
    # Mass and damping are chosen so that the ball comes to rest within a few steps without oscillation.
    rate = 1.2 / STEP
    mass = 1.5 * PRESSED / known.approach / rate**2
    ball = ModalBody(np.zeros(3), {"middle": np.eye(3) / sqrt(mass)}, 2.0 * rate, name="ball")
    contacts = [
        PointContact(
            ball.at("middle"),
            plane.at(str(number + 1)),
            friction=Coulomb(FRICTION),
            gap=far**2 / (2.0 * RADIUS),
            name=f"square {number + 1}",
            surface="face",
        )
        for number, far in enumerate(distance.tolist())
    ]
    times = STEP * np.cumsum([0, RISE, REST, RISE, REST])
    pressing, pulling = (Sampled(tuple(times[k : k + 2].tolist()), (0.0, 1.0)) for k in (0, 2))
    pushes = [
        Force(ball.at("middle"), y=-PRESSED, history=pressing),
        Force(ball.at("middle"), x=pulled * FRICTION * PRESSED, history=pulling),
    ]
    probes = [Displacement(ball.at("middle"), way) for way in "xy"]
    system = System(contacts, pushes)
    run = simulate(system, float(times[-1]), step=STEP, sample_rate=1.0 / STEP, probes=probes)
    normal, (shift, sunk) = run["normal_force"].values[-1], run["displacement"].values[-1]
    # At rest nothing slides; points that stick have not slid since the start of the pull.
    slid = (run["status_share"].values[RISE + REST :, :, 2] > 0.0).any(axis=0)
    radius, stuck = (side * sqrt(float(count) / pi) for count in ((normal > 0.0).sum(), (~slid & (normal > 0.0)).sum()))
    pressure, shear = normal / side**2, run["tangential_force"].values[-1, :, 0] / side**2
    return Found(Known(radius, -float(sunk), float(pressure.max()), float(shift), stuck), distance, pressure, shear)


def cattaneo() -> Outcome:
    """A ball of 50 mm on a plane, both of 200 MPa in shear, pulled by 7/8 of the force of full slip."""
    known, rows, errors = closed_form(), [], []
    curves = _closed_curves(known)
    for squares in GRIDS:
        run = press_and_pull(squares)
        found, side = run.known, 2.0 * known.radius / squares
        errors.append(found.approach - known.approach)
        rows += _rows(known, found, side, f"{squares} squares across")
    share, reason = GRIDS[0] / GRIDS[1], "second order of the side, at least first"
    name = f"approach: error with {GRIDS[1]} squares over that with {GRIDS[0]}"
    rows.append(Row(name, share**2, errors[1] / errors[0], share - share**2, reason))
    for values, label in ((run.pressure, "pressure"), (run.shear, "shear")):
        curves.append(Curve(1e3 * run.distance, 1e-6 * values, f"{label}, {GRIDS[1]} squares across", marks=True))
    return Outcome(rows, Sketch("distance from the middle [mm]", "traction [MPa]", curves))


def _rows(known: Known, found: Known, side: float, grid: str) -> list[Row]:
    """Yield the results on a grid of squares beside the closed form."""
    # The mean gap of a ball over a square exceeds that at its middle by side² / 12 R.
    gap, half = side**2 / (12.0 * RADIUS), 0.5 * side
    share, slipping = gap / known.approach, known.radius**2 - known.stuck**2
    # The shift is proportional to the approach of the whole contact less that of the sticking part (Cattaneo).
    pulled = 2.0 * share * known.radius**2 / slipping
    by_gap = "gap in the middle of a square for its mean"
    return [
        Row(f"{grid}: radius of contact", known.radius, found.radius, half, "half a square", "m"),
        Row(f"{grid}: radius that sticks", known.stuck, found.stuck, half, "half a square", "m"),
        Row(f"{grid}: approach", known.approach, found.approach, gap, by_gap, "m"),
        # The pressure in the middle square is a mean, too.
        Row(f"{grid}: peak pressure", known.peak, found.peak, 2.0 * share * known.peak, f"{by_gap}, twice", "Pa"),
        Row(f"{grid}: shift", known.shift, found.shift, pulled * known.shift, f"{by_gap}, twice", "m"),
    ]


def _closed_curves(known: Known) -> list[Curve]:
    """Return pressure and shear over the distance from the middle, in closed form."""
    far = np.linspace(0.0, known.radius, 200)
    whole, inner = (np.sqrt(np.maximum(1.0 - (far / one) ** 2, 0.0)) for one in (known.radius, known.stuck))
    shear = FRICTION * known.peak * (whole - known.stuck / known.radius * inner)
    return [
        Curve(1e3 * far, 1e-6 * known.peak * whole, "pressure, closed form"),
        Curve(1e3 * far, 1e-6 * shear, "shear, closed form"),
    ]


CASES = (
    Case(
        "cattaneo",
        "A ball pressed on a plane and pulled: stick and slip",
        "Cattaneo 1938, Mindlin 1949, closed form; numbers as in Kalker's CONTACT",
        cattaneo,
    ),
)
