"""An elastic bar against a rigid wall: a single impact, and bouncing under gravity."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np
import xarray as xr

from ..arrays import Array
from ..contact import PointContact, RigidTrack
from ..drives import Gravity, InitialVelocity
from ..integration import simulate
from ..lowering.schemes import CentralDifference, Scheme
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, schemes
from .systems.bars import (
    BALL,
    DURATION,
    FALL,
    GAP,
    HEIGHT,
    VELOCITY,
    WALL,
    Bar,
    bounce,
    contacts,
    force_of_scheme,
    front,
)

# The number is just below 1, since the limit itself is refused.
ONE = 0.9999
# Printed peaks relative to the plateau, less 1, with lumped mass and central differences with forward-increment
# multipliers.
PRINTED_PEAKS = {ONE: 0.0, 0.9: 0.026, 0.5: 0.079}


def hit(mass: str, scheme: Scheme, courant: float) -> xr.Dataset:
    """Simulate a bar that hits the wall, recording every step."""
    body, step = WALL.body(mass), WALL.step(courant)
    system = System(PointContact(body.tip, RigidTrack(), gap=GAP), drives=[InitialVelocity(body, y=-VELOCITY)])
    return simulate(system, DURATION, scheme=scheme, step=step, sample_rate=1.0 / step, probes=[])


def _steps(mass: str, scheme: Scheme) -> list[float]:
    angular, _ = WALL.frequencies(mass)
    limit = scheme.limit(angular, np.zeros_like(angular))
    return [courant for courant in (ONE, 0.9, 0.5) if WALL.step(courant) < limit]


def _impact_rows(run: xr.Dataset, mass: str, scheme: Scheme, courant: float) -> list[Row]:
    central = scheme == CentralDifference()
    step, plateau = run.attrs["step"], WALL.plateau(VELOCITY)
    force = run["normal_force"].values
    own = force_of_scheme(WALL, mass, central, step, GAP, VELOCITY, DURATION)[: force.size]
    own = np.pad(own, (0, force.size - own.size))
    pressing = np.flatnonzero(force > 0.0)
    times, start = run["time"].values, GAP / VELOCITY
    inner = (times > start + 0.1 * WALL.crossing) & (times - step < start + 0.9 * WALL.crossing)
    ends = 2.0 * step / (0.8 * WALL.crossing) * own.max()
    spread = front(WALL, courant, mass, central) + WALL.step(1.0) + step
    late = "the front's width by dispersion (Airy), an element and a step"
    case = f"{mass} mass, Courant {1 if courant == ONE else courant:g}"

    def row(quantity: str, expected: float, obtained: float, tolerance: float, reason: str, units: str = "1") -> Row:
        return Row(f"{case}: {quantity}", expected, obtained, tolerance, reason, units, scheme.name)

    rows = [
        row("first contact", start, times[pressing[0]] - step / 2.0, step, "a step", "s"),
        row("time in contact", WALL.crossing, (pressing[-1] - pressing[0] + 1) * step, spread, late, "s"),
        row("mean force, middle 80 %", plateau, force[inner].mean(), ends, "ends of the span, a step of the peak", "N"),
        row(
            "impulse",
            2.0 * WALL.mass * VELOCITY,
            force.sum() * step,
            2.0 * WALL.mass * VELOCITY * spread / WALL.crossing,
            f"{late}, times the plateau",
            "N s",
        ),
        row(
            "force at every step, largest distance over the plateau",
            0.0,
            float(np.abs(force - own).max()) / plateau,
            1e-6,
            "closed form of the scheme on these elements; round-off over a thousand steps",
        ),
    ]
    if mass == "lumped" and central:
        words = "printed to 0.1 %" if courant != ONE else "exact at 1; dispersion of the last 1e-4 below"
        peak = PRINTED_PEAKS[courant]
        rows.append(row("peak over plateau, less 1", peak, force.max() / plateau - 1.0, 1e-3, words))
    else:
        words = "closed form of the scheme on these elements; round-off"
        rows.append(row("peak over plateau, less 1", own.max() / plateau - 1, force.max() / plateau - 1, 1e-6, words))
    return rows


def wall() -> Outcome:
    """Bar of 1 m hits a wall: lumped and consistent mass, Courant numbers 1, 0.9 and 0.5 where allowed."""
    plateau, start = WALL.plateau(VELOCITY), GAP / VELOCITY
    known = np.array([0.0, start, start, start + WALL.crossing, start + WALL.crossing, DURATION])
    curves = [Curve(known, np.array([0.0, 0.0, 1.0, 1.0, 0.0, 0.0]) * plateau, "exact")]
    rows = []
    for mass in ("lumped", "consistent"):
        for scheme in schemes():
            for courant in _steps(mass, scheme):
                run = hit(mass, scheme, courant)
                rows += _impact_rows(run, mass, scheme, courant)
                if mass == "lumped" and courant != ONE:
                    words = f"{scheme.name}, {courant:g}"
                    curves.append(Curve(run["time"].values, run["normal_force"].values, words))
    return Outcome(rows, Sketch("time [s]", "force [N]", curves))


def drop(bar: Bar, mass: str, scheme: Scheme, courant: float, duration: float, every: int = 1) -> xr.Dataset:
    """Simulate a bar dropped from the height."""
    body, step = bar.body(mass), bar.step(courant)
    system = System(PointContact(body.tip, RigidTrack(), gap=HEIGHT), drives=[Gravity(FALL)])
    probes = [Displacement(body.tip, "y")]
    return simulate(system, duration, scheme=scheme, step=step, sample_rate=1.0 / step / every, probes=probes)


PERIODS = 20
PERIOD = 16.0 / 3.0
# Courant numbers allowed by each scheme: lumped mass near its limit, consistent mass below 1 / sqrt 3.
DROPS = (("lumped", 0.9), ("consistent", 0.5))


def _mechanical(run: xr.Dataset) -> Array:
    """Return the change of the energy, including potential energy, over the initial ``M g h``."""
    energy = run["kinetic_and_elastic"].values - run["drive_work"].values - run.attrs["initial_energy"]
    return energy / (BALL.mass * FALL * HEIGHT)


def bouncing() -> Outcome:
    """Bouncing bar: heights and contacts of the first period, and the energy over twenty."""
    rows: list[Row] = []
    notes: list[str] = []
    times = np.linspace(0.0, PERIOD, 600)
    curves = [Curve(times, np.array([bounce(float(t)) for t in times]), "exact")]
    for mass, courant in DROPS:
        for scheme in schemes():
            run = drop(BALL, mass, scheme, courant, PERIOD)
            height = HEIGHT + run["displacement"].values[:, 0]
            curves.append(Curve(run["time"].values, height, f"{scheme.name}, {mass}"))
            rows += _bounce_rows(run, mass, courant, scheme)
            rows.append(_loss_order(mass, courant, scheme))
            long = _mechanical(drop(BALL, mass, scheme, courant, PERIODS * PERIOD, every=20))
            words = "largest rise of the energy in 20 periods"
            reason = "an impact without restitution only dissipates energy; round-off"
            rows.append(Row(f"{mass} mass: {words}", 0.0, max(0.0, float(long.max())), 1e-9, reason, "1", scheme.name))
            lost = ", ".join(f"{-100 * long[int(n * long.size / PERIODS) - 1]:.3g} % after {n}" for n in (1, 5, 10, 20))
            notes.append(
                f"Energy lost, {mass} mass, Courant number {courant:g}, {scheme.name}: {lost} periods. Every closing "
                "takes the kinetic energy of the tip's node; dispersed waves make it close more and more often."
            )
    return Outcome(rows, Sketch("time [s]", "height of the bottom [m]", curves), notes)


def _bounce_rows(run: xr.Dataset, mass: str, courant: float, scheme: Scheme) -> list[Row]:
    step, speed = run.attrs["step"], FALL * sqrt(2.0 * HEIGHT / FALL)
    spread = front(BALL, courant, mass, scheme == CentralDifference()) + BALL.step(1.0) + step
    time, height = run["time"].values, HEIGHT + run["displacement"].values[:, 0]
    touching = run["normal_force"].values > 0.0
    touch, leave, land, lift = contacts()
    width = "a front's width (Airy), an element and a step"
    late = f"{width}, w; the velocity 2 v w / T off afterwards"

    def off(at: float) -> float:
        """Largest error of the times of events in flight [s]."""
        return spread * (1.0 + 2.0 * max(0.0, at - leave) / BALL.crossing)

    def row(quantity: str, expected: float, obtained: float, tolerance: float, reason: str, units: str) -> Row:
        return Row(f"{mass} mass: {quantity}", expected, obtained, tolerance, reason, units, scheme.name)

    middle = (touch + lift) / 2.0
    instants = (
        ("touches", touch, time[touching][0] - step / 2.0, step, "a step"),
        ("leaves", leave, time[touching & (time < middle)][-1], spread, width),
        ("lands", land, time[touching & (time > middle)][0] - step, off(land), late),
        ("leaves again", lift, time[touching][-1], off(land) + spread, late),
    )
    rows = [row(what, known, found, within, why, "s") for what, known, found, within, why in instants]
    falling = "free fall at a sample half a step away at most"
    for at in (0.5, 2.0, 2.5, 8.0 / 3.0):
        nearest = float(height[np.argmin(np.abs(time - at))])
        tolerance, reason = (speed * off(at), late) if at > touch else (speed * step, falling)
        rows.append(row(f"height at {at:.4g} s", bounce(at), nearest, tolerance, reason, "m"))
    return rows


def _loss_order(mass: str, courant: float, scheme: Scheme) -> Row:
    counts = np.array([50, 100, 200])
    lost = []
    for count in counts:
        run = drop(replace(BALL, elements=int(count)), mass, scheme, courant, PERIOD / 2.0)
        lost.append(-float(_mechanical(run)[-1]))
    order = float(np.polyfit(np.log(1.0 / counts), np.log(lost), 1)[0])
    reason = "the tip's node loses its kinetic energy, of order 1 in the element; within 0.1"
    return Row(f"{mass} mass: order of the energy lost in the first contact", 1.0, order, 0.1, reason, "1", scheme.name)


CASES = (
    Case(
        "impact",
        "Elastic bar hits a wall",
        "closed form rho c S v during 2 L / c; Siconos example ImpactingBar, Code_Aster V5.03, SDNV100; schemes: "
        "Carpenter, Taylor & Katona 1991, Int. J. Numer. Meth. Eng. 32; dispersion: Belytschko & Mullen 1978, Int. J. "
        "Numer. Meth. Eng. 12",
        wall,
    ),
    Case(
        "bouncing",
        "Bouncing bar under gravity",
        "Doyen, Ern & Piperno 2011, SIAM J. Sci. Comput. 33, 223-249; energy of the contact node: Di Stasio, "
        "Dureisseix, Gravouil, Georges & Homolle 2019, Adv. Model. Simul. Eng. Sci. 6:2",
        bouncing,
    ),
)
