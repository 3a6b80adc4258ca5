"""Contacts with a stiffness at default settings: vibration, impact, and squeal on a lining."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi, sqrt
from typing import Any

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

from ..arrays import Array
from ..bodies import Material, PointMass
from ..connections import Dashpot, Spring
from ..contact import Coulomb, HertzStiffness, PointContact, RigidTrack
from ..drives import Force, InitialState, InitialVelocity
from ..integration import simulate
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch
from .prony import exponents, only_sliding
from .systems.mode_coupling import AT_CONTACT, GROUNDED

# Frequencies of a mass on its contact [Hz], and number of periods over which its phase is followed.
VIBRATIONS, PERIODS = (1e3, 1e4, 3e4, 1e5), 200
STEEL = Material(2.1e11, 7800.0, 0.3)
# Radius [m] and speed [m/s] of each ball.
BALLS = ((1e-2, 1.0), (1e-3, 0.1), (5e-2, 0.01))
# Time of an impact under Hertz's law over depth and speed: twice the integral of 1 / sqrt(1 - x^2.5) from 0 to 1.
LASTS = 2.943275
# Frequencies of the squeal [Hz], coefficients of friction for small motion and for the cycle with lift-off.
SQUEALS, SMALL, LARGE = (300.0, 1e3, 2e3, 5e3), (0.76, 0.8, 0.9), (0.8, 0.9, 1.0)
# Damping of the mass in its cycle, relative to the root of mass times stiffness, and number of cycles until the cycle
# is reached.
DAMPING, SETTLED = 0.05, 40.0


def every_step(system: System, duration: float) -> xr.Dataset:
    """Simulate at the default step and record every step of it."""
    step = float(simulate(system, duration, probes=[]).attrs["step"])
    return simulate(system, duration, step=step, sample_rate=1.0 / step, probes=[])


def vibration() -> Outcome:
    """A mass that stays closed on the spring of its contact, at four frequencies."""
    rows, curves = [], []
    for frequency in VIBRATIONS:
        rate, load, weight = 2.0 * pi * frequency, 50.0, 0.1
        mass, depth = PointMass(weight), load / (weight * rate**2)
        contact = PointContact(mass.centre, RigidTrack(), stiffness=weight * rate**2)
        start = InitialState(mass, displacement=(0.0, -depth), velocity=(0.0, 0.5 * depth * rate))
        run = every_step(System(contact, [Force(mass.centre, y=-load), start]), PERIODS / frequency)
        time, motion = run["time"].values, run["gap"].values / depth + 1.0
        seen = _frequency(time, motion, rate) / (2.0 * pi)
        words = f"{frequency / 1e3:g} kHz"
        known = 0.5 * np.sin(rate * time)
        largest = float(np.abs(motion).max() / np.abs(known).max())
        rows += [
            Row(f"{words}: frequency", frequency, seen, 1e-3 * frequency, "a thousandth", "Hz"),
            Row(f"{words}: largest sample, over that of the closed form", 1.0, largest, 1e-3, "a thousandth"),
        ]
        early = time * frequency < 10.0
        curves.append(Curve(frequency * time[early], motion[early], words, marks=True))
    return Outcome(rows, Sketch("periods", "displacement over rest", curves))


def _frequency(time: Array, motion: Array, rate: float) -> float:
    """Return the angular frequency of a sampled sine near `rate`, from its phase over the run."""
    phases, middles = [], []
    # The parts are so short that the phase of a frequency 10 % off turns by less than half a turn from one to the next.
    for part in np.array_split(np.arange(time.size), PERIODS // 4):
        waves = np.stack([np.sin(rate * time[part]), np.cos(rate * time[part]), np.ones(part.size)], axis=-1)
        sine, cosine, _ = np.linalg.lstsq(waves, motion[part], rcond=None)[0]
        phases.append(np.arctan2(cosine, sine))
        middles.append(time[part].mean())
    turned = np.unwrap(phases)
    return float(rate + (turned[-1] - turned[0]) / (middles[-1] - middles[0]))


def impact() -> Outcome:
    """Three balls meet a wall under Hertz's law: ``m v² / 2 = 0.4 k d^2.5``, and each rebounds at the same speed."""
    rows, curves = [], []
    for radius, speed in BALLS:
        mass, stiffness = 4.0 / 3.0 * pi * radius**3 * STEEL.density, HertzStiffness.between(STEEL, STEEL, radius)
        k = stiffness.numbers[0]
        depth = (1.25 * mass * speed**2 / k) ** 0.4
        lasts = LASTS * depth / speed
        ball = PointMass(mass)
        system = System(PointContact(ball.centre, RigidTrack(), stiffness=stiffness), [InitialVelocity(ball, y=-speed)])
        run = every_step(system, 2.0 * lasts)
        force, time, gap = run["normal_force"].values, run["time"].values, run["gap"].values
        last = int(np.flatnonzero(gap < 0.0)[-1])
        leaves = float(np.interp(0.0, gap[last : last + 2], time[last : last + 2]))
        words = f"radius {1e3 * radius:g} mm, {speed:g} m/s"
        peak = k * depth**1.5
        rebound = speed * sqrt(1.0 - float(run["impact_loss"][-1]) / float(run["kinetic_and_elastic"][0]))
        rows += [
            Row(f"{words}: largest force", peak, float(force.max()), 0.01 * peak, "one per cent", "N"),
            Row(f"{words}: time of contact", lasts, leaves, 0.01 * lasts, "one per cent", "s"),
            Row(f"{words}: speed of rebound", speed, rebound, 1e-4 * speed, "fourth order", "m/s"),
        ]
        curves.append(Curve(time / lasts, force / peak, words, marks=True))
    return Outcome(rows, Sketch("time over that of contact", "force over the largest", curves))


@dataclass(frozen=True)
class Lined:
    """Hoffmann's mass of 1 kg on a lining, the spring of its contact, over a belt that runs towards -x.

    Attributes
    ----------
    frequency : float
        Frequency at which it flutters [Hz].
    friction : float
        Coefficient of friction.
    damping : float, optional
        Of the mass against the ground, over the root of stiffness times mass.
    """

    frequency: float
    friction: float
    damping: float = 0.0

    @property
    def rate(self) -> float:
        """Root of the unit of stiffness over the mass [1/s]: both natural frequencies lie about sqrt(2) of it."""
        return 2.0 * pi * self.frequency / sqrt(2.0)

    @property
    def sliding(self) -> Array:
        """Stiffness matrix of sliding, in units of mass times the square of the rate."""
        return grounded() + AT_CONTACT * np.array([[0.0, -self.friction], [0.0, 1.0]])

    @property
    def rest(self) -> Array:
        """Sliding equilibrium under 1 N, in the same units [m]."""
        found: Array = np.linalg.solve(self.sliding, [0.0, -1.0])
        return found

    def exponents(self) -> Array:
        """Return the exponents of sliding motion with positive frequency [1/s], the fastest growing first."""
        squares = np.linalg.eigvals(self.sliding).astype(complex)
        roots = -0.5 * self.damping + np.sqrt(0.25 * self.damping**2 - squares)
        roots = np.where(roots.imag > 0.0, roots, -self.damping - roots)
        found: Array = roots[np.lexsort((-roots.imag, -np.round(roots.real, 9)))] * self.rate
        return found

    def run(self, periods: float, kick: float) -> xr.Dataset:
        """Simulate it at default settings from a place displaced by a share of its equilibrium."""
        mass, unit = PointMass(1.0), self.rate**2
        # The belt is too fast for the mass to stick.
        belt = RigidTrack(velocity=-100.0 / self.rate)
        contact = PointContact(
            mass.centre, belt, friction=Coulomb(self.friction), stiffness=AT_CONTACT * unit, name="lining"
        )
        links: list[Spring | Dashpot] = [
            Spring(mass.centre, stiffness=unit * k, direction=(np.cos(angle), np.sin(angle), 0.0))
            for k, angle in GROUNDED
        ]
        if self.damping:
            for direction in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)):
                links.append(Dashpot(mass.centre, coefficient=self.damping * self.rate, direction=direction))
        place = (self.rest + kick * np.linalg.norm(self.rest) * np.array([1.0, 0.6])) / unit
        start = InitialState(mass, displacement=tuple(place))
        system = System(contact, [Force(mass.centre, y=-1.0), start], links)
        probes = [Displacement(mass.centre, "x"), Displacement(mass.centre, "y")]
        return simulate(system, periods / self.frequency, probes=probes)

    def cycle(self) -> tuple[float, float, float]:
        """Return frequency [Hz] and ends of the height [m] of the cycle with lift-off, by DOP853 between events."""
        stiff, unit = grounded(), self.rate**2

        def rates(_: float, y: Array, pressed: bool) -> list[float]:
            force = -(stiff @ y[:2]) - self.damping * y[2:] + np.array([0.0, -1.0])
            normal = -AT_CONTACT * y[1] if pressed else 0.0
            return [float(y[2]), float(y[3]), float(force[0] - self.friction * normal), float(force[1] + normal)]

        def lifts(_: float, y: Array, pressed: bool) -> float:
            return float(y[1])

        def turns(_: float, y: Array, pressed: bool) -> float:
            return float(y[3])

        time, span = 0.0, sqrt(2.0) * pi * (SETTLED + 20.0)
        y = np.array([*(self.rest + 0.5 * np.linalg.norm(self.rest) * np.array([1.0, 0.6])), 0.0, 0.0])
        pressed = bool(y[1] < 0.0)
        times, heights = [], []
        lifts.terminal = True  # type: ignore[attr-defined]
        while time < span:
            lifts.direction = 1.0 if pressed else -1.0  # type: ignore[attr-defined]
            found: Any = solve_ivp(
                rates, (time, span), y, "DOP853", events=(lifts, turns), args=(pressed,), rtol=1e-11, atol=1e-13
            )
            times += list(found.t_events[1])
            heights += [float(state[1]) for state in found.y_events[1]]
            time, y, pressed = float(found.t[-1]), found.y[:, -1].copy(), not pressed
            y[1] = 0.0
        late = np.array(times) > sqrt(2.0) * pi * SETTLED
        when, height = np.array(times)[late], np.array(heights)[late] / unit
        low = height < 0.5 * (height.min() + height.max())
        period = float(np.diff(when[low]).mean()) / self.rate
        return 1.0 / period, float(height.min()), float(height.max())


def grounded() -> Array:
    """Return the stiffness matrix of Hoffmann's springs to the ground."""
    stiffness = [k * np.outer((np.cos(a), np.sin(a)), (np.cos(a), np.sin(a))) for k, a in GROUNDED]
    return np.asarray(sum(stiffness))


def squeal() -> Outcome:
    """Growth of small motion, and the cycle with lift-off into which it grows, at four frequencies."""
    rows, curves, reason = [], [], "one per cent"
    for frequency in SQUEALS:
        for friction in SMALL:
            lined = Lined(frequency, friction)
            known = lined.exponents()[0]
            run = lined.run(10.0, 1e-4)
            only_sliding(run)
            interval = float(np.diff(run["time"].values[:2])[0])
            every = max(1, round(0.1 / (frequency * interval)))
            found = exponents(run["displacement"].values[::every], every * interval, 1.0 / lined.rate)[0]
            words = f"{frequency:g} Hz, friction {friction:g}"
            rows += [
                Row(f"{words}: growth", known.real, found.real, 0.01 * known.real, reason, "1/s"),
                Row(f"{words}: frequency", known.imag, found.imag, 0.01 * known.imag, reason, "rad/s"),
            ]
        for friction in LARGE:
            lined = Lined(frequency, friction, DAMPING)
            pitch, lowest, highest = lined.cycle()
            run = lined.run(SETTLED + 200.0, 0.5)
            late = run["time"].values > SETTLED / frequency
            time, height = run["time"].values[late], run["displacement"].values[late, 1]
            swing = highest - lowest
            words = f"{frequency:g} Hz, friction {friction:g}, cycle"
            seen = _frequency(time, height, 2.0 * pi * pitch) / (2.0 * pi)
            rows += [
                Row(f"{words}: frequency", pitch, seen, 0.01 * pitch, reason, "Hz"),
                Row(f"{words}: swing", swing, float(np.ptp(height)), 0.01 * swing, reason, "m"),
                Row(f"{words}: highest", highest, float(height.max()), 0.01 * swing, f"{reason} of the swing", "m"),
            ]
            if friction == LARGE[-1]:
                early = time * frequency < SETTLED + 4.0
                curves.append(
                    Curve(frequency * time[early], height[early] * lined.rate**2, f"{frequency:g} Hz", marks=True)
                )
    return Outcome(rows, Sketch("periods", "height, in units of load over stiffness", curves))


CASES = (
    Case("contact-spring", "A mass on the stiffness of its contact", "closed form", vibration),
    Case("hertz-impacts", "Three balls on a wall under Hertz's law", "Hertz (1882), closed form", impact),
    Case(
        "lining",
        "Mode coupling on a lining, and its cycle with lift-off",
        "Hoffmann, Fischer, Allgaier & Gaul 2002, Mech. Res. Commun. 29, the spring of its contact as a lining: closed "
        "form of the growth; the cycle by scipy's DOP853 from event to event",
        squeal,
    ),
)
