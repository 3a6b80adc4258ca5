"""Friction laws with an internal state: LuGre's bristles, and the age of a contact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from math import asinh, exp, log, sqrt

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

from ..arrays import Array
from ..bodies import PointMass
from ..connections import Spring
from ..contact import LuGre, PointContact, RateAndState, RigidTrack
from ..drives import Force, InitialState
from ..integration import simulate
from ..lowering.schemes import Scheme
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme
from .frequencies import fitted_order


@dataclass(frozen=True)
class Pulled:
    """A mass under a force of 1 N on a belt that runs towards -x, held by a spring: pulled, as seen from the belt.

    Attributes
    ----------
    friction : LuGre or RateAndState
        Law of friction.
    mass, stiffness : float
        Mass [kg], stiffness of the spring [N/m].
    speed : float
        Velocity of the belt, or of the spring's end as seen from it [m/s].
    stretch : float
        Force of the spring at the start [N].
    slip : float
        Slip velocity at the start [m/s].
    """

    friction: LuGre | RateAndState
    mass: float
    stiffness: float
    speed: float
    stretch: float = 0.0
    slip: float = 0.0

    def run(self, duration: float, step: float, scheme: Scheme) -> tuple[Array, Array, xr.Dataset]:
        """Simulate and return time, force of the spring [N], and the record of every step."""
        body = PointMass(self.mass)
        track = RigidTrack(velocity=-self.speed)
        start = InitialState(
            body, displacement=(-self.stretch / self.stiffness, 0.0), velocity=(self.slip - self.speed, 0.0)
        )
        system = System(
            PointContact(body.centre, track, friction=self.friction),
            drives=[Force(body.centre, y=-1.0), start],
            connections=[Spring(body.centre, stiffness=self.stiffness)],
        )
        probes = [Displacement(body.centre, "x")]
        run = simulate(system, duration, scheme=scheme, step=step, sample_rate=1.0 / step, probes=probes)
        return run["time"].values, -self.stiffness * run["displacement"].values[:, 0], run

    def reference(
        self, duration: float, state: float, friction: Callable[[float, float], tuple[float, float]]
    ) -> tuple[Array, Array]:
        """Return times and forces of the spring at its longest and shortest, by LSODA to 1e-11.

        `friction` is a function of slip velocity and state that returns the ratio of forces and the rate of the state.
        """

        def rates(time: float, y: Array) -> list[float]:
            ratio, rate = friction(y[1], y[2])
            return [self.speed - y[1], (y[0] * self.stiffness - ratio) / self.mass, rate]

        def turns(time: float, y: Array) -> float:
            return self.speed - float(y[1])

        found = solve_ivp(
            rates,
            (0.0, duration),
            [self.stretch / self.stiffness, self.slip, state],
            method="LSODA",
            rtol=1e-11,
            atol=1e-15,
            events=turns,
            max_step=duration / 2000.0,
        )
        return found.t_events[0], found.y_events[0][:, 0] * self.stiffness


def extremes(time: Array, force: Array) -> tuple[Array, Array, Array]:
    """Return times and heights of the sampled peaks, and the troughs between."""
    inner = force[1:-1]
    peaks = np.flatnonzero((inner > force[:-2]) & (inner >= force[2:]) & (inner > force.mean())) + 1
    troughs = np.flatnonzero((inner < force[:-2]) & (inner <= force[2:]) & (inner < force.mean())) + 1
    return time[peaks], force[peaks], force[troughs]


BRISTLES = LuGre(static=1.5, kinetic=1.0, velocity=1e-3, stiffness=1e5, damping=sqrt(1e5), viscous=0.4)
PULL = Pulled(BRISTLES, mass=1.0, stiffness=2.0, speed=0.1)


@lru_cache
def lugre_reference() -> tuple[float, float, float]:
    """Return period [s], peak and least force of the spring [N] of the pull test."""
    law = BRISTLES

    def friction(velocity: float, z: float) -> tuple[float, float]:
        curve = law.kinetic + (law.static - law.kinetic) * exp(-((velocity / law.velocity) ** 2))
        rate = velocity - law.stiffness * abs(velocity) * z / curve
        return law.stiffness * z + law.damping * rate + law.viscous * velocity, rate

    time, force = PULL.reference(40.0, 0.0, friction)
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
        steps, errors = (1e-2, 1e-3, 3e-4, 1e-4), []
        for step in steps:
            time, force, _ = PULL.run(40.0, step, scheme)
            tops, peaks, troughs = extremes(time, force)
            errors.append(abs(peaks[1:].mean() - peak))
            if step == 3e-4:
                continue
            if step == 1e-2:
                curves.append(Curve(time, force, f"{scheme.name}, step {step:g} s"))
            away = "it breaks away within a step: k v h"
            drift = PULL.stiffness * PULL.speed * step
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
        order = fitted_order(np.array(steps[1:]), np.array(errors[1:]))
        reason = "second order where the step resolves the bristles; within 0.1"
        return [*found, Row("order of the peak force", 2.0, order, 0.1, reason, "1", scheme.name)]

    return Outcome(by_scheme(rows), Sketch("time [s]", "force of the spring [N]", curves))


AGE = RateAndState(reference=0.6, a=0.010, b=0.015, slip_distance=1e-3, velocity=1e-3)
# So heavy that friction hardly changes its velocity, and the slip velocity is known before and after.
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
            # With one step per sample, a force is that at the start of the step.
            instants = run["time"].values - step
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
SLOW = Pulled(CREEP, mass=1.0, stiffness=60.0, speed=1e-3, stretch=0.6 * 0.999, slip=1e-3)
SETTLED = 30.0


@lru_cache
def slow_reference() -> tuple[float, float, float, float]:
    """Return period [s], peak and least force of the spring [N], and largest slip velocity [m/s] of the cycle."""
    law, fastest = CREEP, [0.0]

    def friction(velocity: float, theta: float) -> tuple[float, float]:
        fastest[0] = max(fastest[0], abs(velocity))
        exponent = (law.reference + law.b * log(law.velocity * theta / law.slip_distance)) / law.a
        ratio = law.a * asinh(velocity / (2.0 * law.velocity) * exp(exponent))
        return ratio, 1.0 - abs(velocity) * theta / law.slip_distance

    time, force = SLOW.reference(2.0 * SETTLED, law.state_at_start, friction)
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
            time, force, _ = SLOW.run(2.0 * SETTLED, step, scheme)
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
