"""Friction laws with an internal state: LuGre's bristles, and the age of a contact."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from math import log, sqrt

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import PointMass
from ..contact import LuGre, PointContact, RateAndState, RigidTrack
from ..drives import Force
from ..integration import simulate
from ..lowering.schemes import Scheme
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme
from .frequencies import fitted_order
from .systems.on_belts import Slider, rubbing_of


def pulled(slider: Slider, duration: float, step: float, scheme: Scheme) -> tuple[Array, Array]:
    """Simulate and return time [s] and force of the spring [N] at every step."""
    run = slider.run(duration, step, scheme)
    return run["time"].values, -slider.stiffness * run["displacement"].values[:, 0]


def extremes(time: Array, force: Array) -> tuple[Array, Array, Array]:
    """Return times and heights of the sampled peaks, and the troughs between."""
    inner = force[1:-1]
    peaks = np.flatnonzero((inner > force[:-2]) & (inner >= force[2:]) & (inner > force.mean())) + 1
    troughs = np.flatnonzero((inner < force[:-2]) & (inner <= force[2:]) & (inner < force.mean())) + 1
    return time[peaks], force[peaks], force[troughs]


BRISTLES = LuGre(static=1.5, kinetic=1.0, velocity=1e-3, stiffness=1e5, damping=sqrt(1e5), viscous=0.4)
# A belt that runs towards -x: as seen from it, the mass is pulled.
PULL = Slider(1.0, 2.0, 1.0, BRISTLES, velocity=-0.1, belt=-0.1)


@lru_cache
def lugre_reference() -> tuple[float, float, float]:
    """Return period [s], peak and least force of the spring [N] of the pull test."""
    time, place = PULL.turns(40.0, 0.0)
    force = -PULL.stiffness * place
    peaks = force > 1.0
    late = time > 10.0
    return (
        float(np.diff(time[peaks & late]).mean()),
        float(force[peaks & late].mean()),
        float(force[~peaks & late].mean()),
    )


def lugre() -> Outcome:
    """Pull test at three steps; the longest is unstable for an explicit treatment of the bristles."""
    period, peak, least = lugre_reference()
    curves: list[Curve] = []

    def rows(scheme: Scheme) -> list[Row]:
        found: list[Row] = []
        for step in (1e-2, 1e-3, 1e-4):
            time, force = pulled(PULL, 40.0, step, scheme)
            tops, peaks, troughs = extremes(time, force)
            if step == 1e-2:
                curves.append(Curve(time, force, f"{scheme.name}, step {step:g} s"))
            away = "it breaks away within a step: k v h"
            drift = PULL.stiffness * abs(PULL.belt) * step
            found += [
                Row(f"step {step:g} s: peak force", peak, peaks[1:].mean(), drift, away, "N", scheme.name),
                Row(f"step {step:g} s: least force", least, troughs.mean(), drift, away, "N", scheme.name),
                Row(
                    f"step {step:g} s: period",
                    period,
                    float(np.diff(tops[1:]).mean()),
                    2.0 * step,
                    "it breaks away within a step and is caught within a step",
                    "s",
                    scheme.name,
                ),
            ]
        return found

    return Outcome(by_scheme(rows), Sketch("time [s]", "force of the spring [N]", curves))


AGE = RateAndState(reference=0.6, a=0.010, b=0.015, slip_distance=1e-3, velocity=1e-3)
# The mass is so heavy that friction hardly changes its velocity: slip velocities are known before and after.
HEAVY, BEFORE, AFTER = 1e4, 1e-3, 1e-2


def steady(velocity: float) -> float:
    """Return the coefficient of friction [1] of `AGE` in steady sliding, ``mu0 + (a - b) ln(V / V0)``."""
    return AGE.reference + (AGE.a - AGE.b) * log(velocity / AGE.velocity)


def velocity_step(evolution: str, time: Array) -> Array:
    """Return the coefficient of friction [1] after the slip velocity has jumped from `BEFORE` to `AFTER`.

    ``mu0 + a ln(V/V0) + b ln(V0 theta / D)`` with, from theta = D / V1, for the aging law
    ``theta = D/V2 + (D/V1 - D/V2) exp(-V2 t / D)``, for the slip law ``ln(V2 theta / D) = ln(V2/V1) exp(-V2 t / D)``.
    """
    left, rise = np.exp(-AFTER * time / AGE.slip_distance), AFTER / BEFORE
    aged = np.log(1.0 + (rise - 1.0) * left) if evolution == "aging" else log(rise) * left
    return steady(AFTER) + AGE.b * aged


def _stepped(evolution: str, duration: float, step: float, scheme: Scheme) -> xr.Dataset:
    """Simulate a heavy mass whose belt moves with the second velocity, on a contact aged by the first."""
    law = replace(AGE, evolution=evolution, initial_state=AGE.slip_distance / BEFORE)
    body = PointMass(HEAVY)
    system = System(
        PointContact(body.centre, RigidTrack(velocity=-AFTER), friction=law),
        drives=[Force(body.centre, x=steady(AFTER), y=-1.0)],
    )
    return simulate(system, duration, scheme=scheme, step=step, sample_rate=1.0 / step, probes=[])


def age_steps() -> Outcome:
    """Velocity step of both evolution laws: direct effect, fall over the slip distance, new steady state."""
    step, duration = 2e-4, 10.0 * AGE.slip_distance / AFTER
    time = np.linspace(0.0, duration, 400)
    curves = [Curve(time, velocity_step(word, time), f"closed form, {word}") for word in ("aging", "slip")]
    passed = AFTER * step / AGE.slip_distance
    # Twice the slip law's excess of friction over the slip distance also bounds the aging law's.
    slowed = 2.0 * AGE.b * log(AFTER / BEFORE) * AGE.slip_distance / AFTER / (HEAVY * AFTER)
    rounded = np.finfo(float).eps * AFTER * duration * HEAVY / step**2
    tolerance = AGE.b * passed**2 + (AGE.a + AGE.b) * slowed + rounded
    reason = "b (V h / D)², a + b times the share of velocity lost, round-off of the travel times m / h²"

    def rows(scheme: Scheme) -> list[Row]:
        found = []
        for word in ("aging", "slip"):
            run = _stepped(word, duration, step, scheme)
            ratio = run["tangential_force"].values / run["normal_force"].values
            # With one step per sample, each force is that at the start of its step. The first one is that of the start,
            # which is a mean over the step after it.
            ratio = ratio[1:]
            instants = run["time"].values[1:] - step
            known = velocity_step(word, instants)
            for words, at in (("at once", 0), ("after D", round(1 / passed)), ("after 10 D", ratio.size - 1)):
                quantity = f"{word} law: coefficient {words}"
                found.append(Row(quantity, known[at], ratio[at], tolerance, reason, "1", scheme.name))
            worst = float(np.abs(ratio - known).max())
            found.append(Row(f"{word} law: largest distance", 0.0, worst, tolerance, reason, "1", scheme.name))
            curves.append(Curve(instants[::250], ratio[::250], f"{scheme.name}, {word}", marks=True))
        return found

    return Outcome(by_scheme(rows), Sketch("time [s]", "coefficient of friction", curves))


# Below the critical stiffness N (b - a) / D (1 + m V² / (N a D)) = 100 N/m (Rice & Ruina 1983).
CREEP = RateAndState(reference=0.6, a=0.010, b=0.015, slip_distance=1e-4, velocity=1e-3)
SLOW = Slider(1.0, 60.0, 1.0, CREEP, position=-0.6 * 0.999 / 60.0, belt=-1e-3)
SETTLED = 30.0


@lru_cache
def slow_reference() -> tuple[float, float, float, float]:
    """Return period [s], peak and least force of the spring [N], and largest slip velocity [m/s] of the cycle."""
    fastest, equations = [0.0], rubbing_of(CREEP)

    def rubbing(slip: float, theta: float) -> tuple[float, float]:
        fastest[0] = max(fastest[0], abs(slip))
        return equations(slip, theta)

    time, place = SLOW.turns(2.0 * SETTLED, CREEP.state_at_start, rubbing)
    force = -SLOW.stiffness * place
    time, force = time[time > SETTLED], force[time > SETTLED]
    peaks = force > force.mean()
    return float(np.diff(time[peaks]).mean()), float(force[peaks].mean()), float(force[~peaks].mean()), fastest[0]


def slow_stick_slip() -> Outcome:
    """Stick-slip cycle of a spring-slider with an aging contact, below its critical stiffness."""
    period, peak, least, fastest = slow_reference()
    curves: list[Curve] = []

    def rows(scheme: Scheme) -> list[Row]:
        steps, errors = (3e-3, 1e-3, 3e-4), []
        found: list[Row] = []
        for step in steps:
            time, force = pulled(SLOW, 2.0 * SETTLED, step, scheme)
            late = time > SETTLED
            tops, peaks, troughs = extremes(time[late], force[late])
            errors.append(abs(peaks.mean() - peak))
            if step != 1e-3:
                continue
            span = time < 15.0
            curves.append(Curve(time[span], force[span], f"{scheme.name}, step {step:g} s"))
            share = (fastest * step / CREEP.slip_distance) ** 2 / 12.0
            # Effect of one impulse per step on the rest point of the exact modal scheme's spring.
            rest = SLOW.stiffness / SLOW.mass * step**2 / 12.0 * peak
            close_force = share * (peak - least) + rest
            reason = "second order: (V h / D)² / 12 of the swing at the largest slip velocity, (w h)² / 12 of the force"
            instants = "second order: (V h / D)² / 12 of the period, and a step over the cycles seen"
            close = share * period + step / (peaks.size - 1)
            found += [
                Row("period", period, float(np.diff(tops).mean()), close, instants, "s", scheme.name),
                Row("peak force", peak, float(peaks.mean()), close_force, reason, "N", scheme.name),
                Row("least force", least, float(troughs.mean()), close_force, reason, "N", scheme.name),
            ]
        order = fitted_order(np.array(steps), np.array(errors))
        reason = "second order; within 0.1"
        return [*found, Row("order of the peak force", 2.0, order, 0.1, reason, "1", scheme.name)]

    return Outcome(by_scheme(rows), Sketch("time [s]", "force of the spring [N]", curves))


CASES = (
    Case(
        "lugre",
        "LuGre pull test",
        "Canudas de Wit, Olsson, Åström & Lischinsky 1995, IEEE Trans. Autom. Control 40, 419-425; reference by "
        "scipy's LSODA to 1e-11",
        lugre,
    ),
    Case(
        "velocity-step",
        "Rate-and-state friction after a velocity step",
        "closed forms of Dieterich's aging and Ruina's slip law; Ruina 1983, J. Geophys. Res. 88, 10359-10370",
        age_steps,
    ),
    Case(
        "slow-stick-slip",
        "Stick-slip of a spring-slider with an aging contact",
        "Rice & Ruina 1983, J. Appl. Mech. 50, 343-349 (critical stiffness); reference by scipy's LSODA to 1e-11",
        slow_stick_slip,
    ),
)
