"""Systems with limit cycles whose period, shape and multipliers are computed by SciPy, from event to event.

Every change of status ends a piece, and the variational equations are integrated with the motion (DOP853, 1e-11). Where
forces are continuous at an event, the derivative of the motion is continuous, too.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import cos, exp, pi, sin
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ...arrays import Array
from ...bodies import PointMass, ReducedBody
from ...connections import Dashpot, Spring
from ...contact import Coulomb, ExponentialWeakening, LinearStiffness, PointContact, RigidTrack
from ...drives import Drive, Force, InitialState
from ...histories import Harmonic
from ...system import System
from .mode_coupling import AT_CONTACT, GROUNDED
from .on_belts import Slider, den_hartog

ACCURACY: dict[str, Any] = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13}
# Accuracy of the transient before the search, and its length in expected periods.
SETTLING: dict[str, Any] = {"method": "LSODA", "rtol": 1e-8, "atol": 1e-10}
SETTLED = 300
# Expected periods in which a motion comes back, and its distance then, relative to the largest.
RETURNS, NEAR = 4.5, 0.02
# Most steps of Newton's method, and the residual that ends it, relative to the size of the state.
MOST_STEPS, CLOSED = 20, 1e-10
# Samples of a period.
SAMPLES = 8192


class NotPeriodic(RuntimeError):
    """A motion does not come back."""


@dataclass(frozen=True)
class Cycle:
    """One period of a periodic motion.

    Attributes
    ----------
    period : float
        Period [s].
    multipliers : ndarray of complex
        Floquet multipliers without that of the motion along the cycle, the largest first.
    lowest, highest : ndarray
        Ends of the motion of each coordinate [m].
    open : float
        Share of the period during which the contact is open [1].
    places : ndarray, shape (samples, coordinates)
        Coordinates at evenly spaced times of a period, beginning at its start [m].
    """

    period: float
    multipliers: Array
    lowest: Array
    highest: Array
    open: float
    places: Array

    @property
    def times(self) -> Array:
        """Times of the samples [s]."""
        return self.period * np.arange(len(self.places)) / len(self.places)

    def harmonic(self, number: int) -> Array:
        """Return the amplitude of a harmonic of each coordinate [m]."""
        return np.asarray(2.0 * np.abs(np.fft.rfft(self.places, axis=0)[number]) / len(self.places))


@dataclass(frozen=True)
class _Passed:
    """A motion from event to event.

    Attributes
    ----------
    end : ndarray, shape (4,)
        State at the end.
    derivative : ndarray, shape (4, 4)
        Derivative of that by the state at the start.
    turns : list of ndarray
        Values of each coordinate where it turns round [m].
    open : float
        Time during which the contact is open [s].
    pieces : list of callable
        State over time, between events.
    events : list of float
        Times of the events, with the start and the end [s].
    """

    end: Array
    derivative: Array
    turns: list[Array]
    open: float
    pieces: list[Callable[[Array], Array]]
    events: list[float]

    def at(self, times: Array) -> Array:
        """Return the coordinates at times, shape (times, 2) [m]."""
        number = np.clip(np.searchsorted(self.events, times, side="right") - 1, 0, len(self.pieces) - 1)
        found = np.zeros((times.size, 2))
        for k, piece in enumerate(self.pieces):
            found[number == k] = piece(times[number == k])[:2].T
        return found


@dataclass(frozen=True)
class OneContact:
    """Two coordinates with a contact spring: ``q'' + C q' + K q = f + g cos(w t) + p N``, ``N = k max(d q - gap, 0)``.

    Attributes
    ----------
    stiffness, damping : ndarray, shape (2, 2)
        Matrices K and C for masses of 1 kg [N/m, N s/m].
    load, shaken : ndarray, shape (2,)
        Constant force f and amplitude g of a periodic one [N].
    angular : float
        Angular frequency w of the latter, 0 without [rad/s].
    contact : float
        Stiffness k of the contact [N/m].
    towards, pushed : ndarray, shape (2,)
        Row d, the approach of the contact by each coordinate, and p, the force on each for a normal force of 1 N [1].
    gap : float
        Gap at rest [m].
    """

    stiffness: Array
    damping: Array
    load: Array
    shaken: Array
    angular: float
    contact: float
    towards: Array
    pushed: Array
    gap: float

    def matrix(self, is_closed: bool) -> Array:
        """Return the derivative of the rates of the state by the state."""
        stiffness = self.stiffness - is_closed * self.contact * np.outer(self.pushed, self.towards)
        return np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -self.damping]])

    def depth(self, state: Array) -> float:
        """Return the approach of the contact beyond its gap [m]."""
        return float(self.towards @ state[:2] - self.gap)

    def rates(self, time: float, state: Array, is_closed: bool) -> Array:
        """Return the rates of the state."""
        force = self.load + self.shaken * cos(self.angular * time)
        if is_closed:
            force = force + self.pushed * self.contact * self.depth(state)
        return np.concatenate([state[2:], force - self.stiffness @ state[:2] - self.damping @ state[2:]])

    def sliding(self) -> Array:
        """Return the exponents of small motions with the contact closed [1/s], the fastest growing first."""
        found = np.linalg.eigvals(self.matrix(True))
        return found[np.argsort(-found.real, kind="stable")]

    def passed(self, start: Array, duration: float) -> _Passed:
        """Return the motion from a state, from event to event."""
        state, time, ends = np.concatenate([start, np.eye(4).ravel()]), 0.0, [0.0]
        is_closed = self._closes(0.0, start)
        turns: list[list[Array]] = [[], []]
        pieces, opened = [], 0.0
        while time < duration:
            matrix = self.matrix(is_closed)

            def both(t: float, y: Array, is_closed: bool = is_closed, matrix: Array = matrix) -> Array:
                return np.concatenate([self.rates(t, y[:4], is_closed), (matrix @ y[4:].reshape(4, 4)).ravel()])

            def changes(_: float, y: Array) -> float:
                return self.depth(y)

            changes.terminal, changes.direction = True, -1.0 if is_closed else 1.0  # type: ignore[attr-defined]
            stops = [changes, lambda _, y: y[2], lambda _, y: y[3]]
            piece = solve_ivp(both, (time, duration), state, events=stops, dense_output=True, **ACCURACY)
            for k in range(2):
                turns[k].append(piece.y_events[k + 1].reshape(-1, 20)[:, k])
            opened += 0.0 if is_closed else piece.t[-1] - time
            pieces.append(piece.sol)
            state, time = piece.y[:, -1], float(piece.t[-1])
            ends.append(time)
            is_closed = not is_closed
        extremes = [np.concatenate(one) for one in turns]
        return _Passed(state[:4], state[4:].reshape(4, 4), extremes, opened, pieces, ends)

    def _closes(self, time: float, state: Array) -> bool:
        """Return whether the contact is closed just after an instant."""
        depth = self.depth(state)
        return depth > 0.0 or (depth == 0.0 and float(self.towards @ state[2:]) > 0.0)

    def cycle(self, start: Array) -> Cycle:
        """Return the cycle that a motion reaches, by a transient and then by Newton's method.

        Raises
        ------
        NotPeriodic
            If the motion does not come back.
        """
        state, period = self._settled(start)
        for _ in range(MOST_STEPS):
            found = self.passed(state, period)
            missing = found.end - state
            if np.linalg.norm(missing) < CLOSED * max(float(np.linalg.norm(state)), 1e-3):
                return self._described(period, found)
            matrix = found.derivative - np.eye(4)
            if self.angular:
                state = state - np.linalg.solve(matrix, missing)
                continue
            flow, last = (self.rates(0.0, one, self._closes(0.0, one)) for one in (state, found.end))
            bordered = np.block([[matrix, last[:, None]], [flow[None, :], np.zeros((1, 1))]])
            change = np.linalg.solve(bordered, -np.append(missing, 0.0))
            state, period = state + change[:4], period + float(change[4])
        raise NotPeriodic("Newton's method finds no cycle")

    def _settled(self, start: Array) -> tuple[Array, float]:
        """Return a state after the transient, and the time after which it comes back [s]."""

        def rates(t: float, y: Array) -> Array:
            return self.rates(t, y, self.depth(y) > 0.0)

        expected = 2.0 * pi / (self.angular or abs(self.sliding()[0].imag))
        settled = SETTLED * expected
        state = solve_ivp(rates, (0.0, settled), start, t_eval=[settled], **SETTLING).y[:, -1]
        multiples = settled + expected * np.arange(1, int(RETURNS) + 1)
        times = np.union1d(np.linspace(settled, settled + RETURNS * expected, 2001), multiples)
        passed = solve_ivp(rates, times[[0, -1]], state, t_eval=times, **SETTLING).y
        distance = np.linalg.norm(passed - state[:, None], axis=0)
        if self.angular:
            near = np.flatnonzero(distance[np.searchsorted(times, multiples)] < NEAR * distance.max())
            if not near.size:
                raise NotPeriodic("the motion does not come back")
            return state, float((near[0] + 1) * expected)
        lowest = 1 + np.flatnonzero((distance[1:-1] < distance[:-2]) & (distance[1:-1] <= distance[2:]))
        lowest = lowest[distance[lowest] < NEAR * distance.max()]
        if not lowest.size or np.ptp(passed[0]) < 1e-6:
            raise NotPeriodic("the motion does not come back")
        return state, float(times[lowest[0]] - settled)

    def _described(self, period: float, found: _Passed) -> Cycle:
        multipliers = np.linalg.eigvals(found.derivative).astype(complex)
        if not self.angular:
            multipliers = np.delete(multipliers, np.argmin(np.abs(multipliers - 1.0)))
        return Cycle(
            period,
            multipliers[np.lexsort((multipliers.imag, -np.round(np.abs(multipliers), 9)))],
            np.array([one.min() for one in found.turns]),
            np.array([one.max() for one in found.turns]),
            found.open / period,
            found.at(period * np.arange(SAMPLES) / SAMPLES),
        )


@dataclass(frozen=True)
class LiftingMass:
    """Hoffmann's mass with dashpots on a belt towards -x, behind a contact spring that may lift off.

    Attributes
    ----------
    friction : float, optional
        Coefficient of friction [1].
    contact : float, optional
        Stiffness of the contact [N/m].
    damping : float, optional
        Coefficient of the dashpots along x and y [N s/m].
    grounded : tuple of (float, float), optional
        Stiffness [N/m] and direction [rad] of each spring to the ground.
    belt : float, optional
        Speed of the belt, faster than the mass [m/s].
    """

    friction: float = 0.9
    contact: float = AT_CONTACT
    damping: float = 0.05
    grounded: tuple[tuple[float, float], ...] = GROUNDED
    belt: float = 5.0

    @property
    def stiffness(self) -> Array:
        """Matrix of the springs to the ground [N/m]."""
        turns = [turn for _, turn in self.grounded]
        rays = np.array([np.cos(turns), np.sin(turns)])
        return np.asarray(rays * [stiffness for stiffness, _ in self.grounded] @ rays.T)

    def system(self) -> System:
        """Return its system, which starts beside the equilibrium of sliding."""
        start = self._start()
        body = ReducedBody(
            np.eye(2), self.stiffness, points={"foot": (0, 1)}, damping=self.damping * np.eye(2), name="mass"
        )
        contact = PointContact(
            body.at("foot"),
            RigidTrack(velocity=-self.belt),
            friction=Coulomb(self.friction),
            stiffness=LinearStiffness(self.contact),
        )
        return System(
            contact, [Force(body.at("foot"), y=-1.0), InitialState(body, tuple(start[:2]), velocity=tuple(start[2:]))]
        )

    def equations(self) -> OneContact:
        """Return its equations: the belt drags the mass with ``mu N`` towards -x."""
        return OneContact(
            self.stiffness,
            self.damping * np.eye(2),
            load=np.array([0.0, -1.0]),
            shaken=np.zeros(2),
            angular=0.0,
            contact=self.contact,
            towards=np.array([0.0, -1.0]),
            pushed=np.array([-self.friction, 1.0]),
            gap=0.0,
        )

    def cycle(self) -> Cycle:
        """Return its cycle.

        Raises
        ------
        NotPeriodic
            If the motion does not come back, or if the mass becomes as fast as the belt.
        """
        found = self.equations().cycle(self._start())
        if np.diff(found.places[:, 0]).min() <= -self.belt * found.times[1]:
            raise NotPeriodic("the mass is as fast as the belt")
        return found

    def _start(self) -> Array:
        equations = self.equations()
        rest = np.linalg.solve(-equations.matrix(True)[2:, :2], equations.load)
        return np.array([*rest, 0.0, 0.1])


@dataclass(frozen=True)
class Stopped:
    """Two masses of 1 kg in a row, shaken at the second; the first meets a stop.

    Attributes
    ----------
    angular : float
        Angular frequency of the force [rad/s].
    force : float, optional
        Its amplitude [N].
    springs : tuple of float, optional
        Stiffness of the springs between the masses, and of the second one to the wall [N/m].
    damping : float, optional
        Coefficient of the dashpots beside these springs [N s/m].
    stop : float, optional
        Stiffness of the stop [N/m].
    gap : float, optional
        Displacement of the first mass at which it meets the stop [m].
    """

    angular: float
    force: float = 0.1
    springs: tuple[float, float] = (1.0, 1.0)
    damping: float = 0.03
    stop: float = 100.0
    gap: float = 1.0

    def system(self) -> System:
        """Return its system: the masses move along y, towards -y to the stop; along x they are held and damped."""
        first, second = PointMass(1.0, name="first"), PointMass(1.0, name="second")
        between, wall = self.springs
        contact = PointContact(
            first.centre, RigidTrack(), friction=Coulomb(0.0), gap=self.gap, stiffness=LinearStiffness(self.stop)
        )
        shaken = Harmonic(self.angular / (2.0 * pi), phase=pi / 2.0)
        held: list[Any] = [
            Spring(first.centre, second.centre, stiffness=between, direction="y"),
            Dashpot(first.centre, second.centre, coefficient=self.damping, direction="y"),
            Spring(second.centre, stiffness=wall, direction="y"),
            Dashpot(second.centre, coefficient=self.damping, direction="y"),
        ]
        for mass in (first, second):
            held += [Spring(mass.centre, stiffness=1.0, direction="x")]
            held += [Dashpot(mass.centre, coefficient=2.0, direction="x")]
        drives: list[Drive] = [Force(second.centre, y=-self.force, history=shaken)]
        return System(contact, drives, held)

    def equations(self) -> OneContact:
        """Return its equations, for displacements towards the stop."""
        between, wall = self.springs
        return OneContact(
            np.array([[between, -between], [-between, between + wall]]),
            self.damping * np.array([[1.0, -1.0], [-1.0, 2.0]]),
            load=np.zeros(2),
            shaken=np.array([0.0, self.force]),
            angular=self.angular,
            contact=self.stop,
            towards=np.array([1.0, 0.0]),
            pushed=np.array([-1.0, 0.0]),
            gap=self.gap,
        )

    def cycle(self) -> Cycle:
        """Return the motion that it reaches from rest."""
        return self.equations().cycle(np.zeros(4))


@dataclass(frozen=True)
class Weakening:
    """A mass of 1 kg on a spring of 1 N/m, pressed with 1 N on a belt whose friction falls with the slip velocity.

    Attributes
    ----------
    belt : float
        Velocity of the belt [m/s].
    static, kinetic, velocity : float, optional
        Parameters of the law, ``kinetic + (static - kinetic) exp(-|slip| / velocity)`` [1, 1, m/s].
    dashpot : float, optional
        Coefficient of a dashpot to the ground [N s/m].
    """

    belt: float
    static: float = 1.0
    kinetic: float = 0.5
    velocity: float = 0.5
    dashpot: float = 0.1

    def system(self) -> System:
        """Return its system, which starts from rest."""
        law = ExponentialWeakening(static=self.static, kinetic=self.kinetic, velocity=self.velocity)
        return Slider(1.0, 1.0, 1.0, law, belt=self.belt, dashpot=self.dashpot).system()

    def friction(self, slip: float) -> float:
        """Return the coefficient of friction where the belt is faster by `slip` [m/s]."""
        return self.kinetic + (self.static - self.kinetic) * exp(-slip / self.velocity)

    @property
    def equilibrium(self) -> float:
        """Displacement in steady sliding [m]."""
        return self.friction(self.belt)

    def rates(self, _: float, state: Array) -> list[float]:
        """Return the rates of place, velocity and growth, while the mass is slower than the belt.

        The area of a set of states next to a motion in the phase plane grows at the rate of the trace of its derivative
        (Liouville), ``-c - mu'``.
        """
        place, velocity = float(state[0]), float(state[1])
        slip = self.belt - velocity
        slope = -(self.static - self.kinetic) / self.velocity * exp(-slip / self.velocity)
        return [velocity, self.friction(slip) - place - self.dashpot * velocity, -self.dashpot - slope]

    def stick_slip(self) -> Cycle:
        """Return the cycle from the break from sticking to the next one.

        Sticking makes all neighbouring motions one: both multipliers but that along the cycle are zero.
        """
        breaks = self.static - self.dashpot * self.belt

        def caught(_: float, y: Array) -> float:
            return self.belt - float(y[1])

        caught.terminal, caught.direction = True, -1.0  # type: ignore[attr-defined]
        slips = solve_ivp(
            self.rates,
            (0.0, 100.0),
            [breaks, self.belt, 0.0],
            events=[caught, lambda _, y: y[1]],
            dense_output=True,
            **ACCURACY,
        )
        slip, place = float(slips.t[-1]), float(slips.y[0, -1])
        if slips.status != 1 or abs(place + self.dashpot * self.belt) > self.static:
            raise NotPeriodic("the mass does not stick")
        period = slip + (breaks - place) / self.belt
        times = period * np.arange(SAMPLES) / SAMPLES
        places = np.where(times < slip, slips.sol(np.minimum(times, slip))[0], place + self.belt * (times - slip))
        turns = slips.y_events[1][:, 0]
        return Cycle(period, np.zeros(1), np.array([turns.min()]), np.array([turns.max()]), 0.0, places[:, None])

    def around_sliding(self, low: float, high: float) -> Cycle:
        """Return the smooth cycle about steady sliding whose amplitude is between two values [m]."""

        def gained(amplitude: float) -> float:
            return float(self._swing(amplitude)[1].y[0, -1]) - self.equilibrium - amplitude

        falling, rising = self._swing(float(brentq(gained, low, high, xtol=1e-13)))
        half, period = falling.t[-1], float(rising.t[-1])
        times = period * np.arange(SAMPLES) / SAMPLES
        places = np.where(times < half, falling.sol(np.minimum(times, half))[0], rising.sol(np.maximum(times, half))[0])
        growth = np.array([exp(rising.y[2, -1])])
        return Cycle(period, growth, falling.y[:1, -1], rising.y[:1, -1], 0.0, places[:, None])

    def _swing(self, amplitude: float) -> tuple[Any, Any]:
        """Return the motion from a highest place, beyond steady sliding by an amplitude [m], down and up again."""
        parts, time, state = [], 0.0, [self.equilibrium + amplitude, 0.0, 0.0]
        for direction in (1.0, -1.0):

            def turns(_: float, y: Array) -> float:
                return float(y[1])

            turns.terminal, turns.direction = True, direction  # type: ignore[attr-defined]
            part = solve_ivp(self.rates, (time, time + 100.0), state, events=turns, dense_output=True, **ACCURACY)
            time, state = part.t[-1], part.y[:, -1]
            parts.append(part)
        return parts[0], parts[1]


@dataclass(frozen=True)
class DenHartog:
    """A mass of 1 kg on a spring of 1 N/m under ``sin(w t)`` N, with dry friction and never at rest.

    Attributes
    ----------
    angular : float
        Angular frequency w of the force [rad/s].
    friction : float
        Force of friction [N].
    """

    angular: float
    friction: float

    @property
    def period(self) -> float:
        """Period of the force [s]."""
        return 2.0 * pi / self.angular

    @property
    def amplitude(self) -> float:
        """Amplitude of the motion [m]."""
        return den_hartog(self.angular, self.friction)

    def system(self) -> System:
        """Return its system."""
        return Slider(1.0, 1.0, 1.0, Coulomb(self.friction), push=Harmonic(1.0 / self.period)).system()

    @property
    def reversal(self) -> float:
        """Ratio of the accelerations after and before a reversal [1].

        From the highest place X, where the force is f, to the lowest one, the motion is ``mu + V cos(w t + p) - mu cos
        t + B sin t``, ``V = 1 / (1 - w²)``: thus ``X = V cos p``, ``f = cos p = (1 - w²) X``. There the acceleration
        changes from ``f - X - mu = -(w² X + mu)`` to ``-(w² X - mu)``.
        """
        inertia = self.angular**2 * self.amplitude
        return (inertia - self.friction) / (inertia + self.friction)

    @property
    def product(self) -> float:
        """Product of the two multipliers, which is the square of their size if they are a pair [1].

        At a reversal, where the velocity is zero, a neighbouring motion reverses a time ``t = -y' / a`` later, with a
        the acceleration before; until then its acceleration is a and not b, that after: its velocity becomes ``y' b /
        a`` (saltation), and its place remains, to first order. Between reversals the motion is without damping, and the
        area in the phase plane constant. So the determinant over a period is the product of b / a of both reversals,
        which are equal by symmetry.
        """
        return self.reversal**2

    @property
    def multipliers(self) -> Array:
        """Both multipliers, that with the positive imaginary part first.

        Half a period is a rotation by ``pi / w`` with a reversal, and the other half is the same, reflected.
        """
        half = pi / self.angular
        turned = np.array([[cos(half), sin(half)], [-sin(half), cos(half)]])
        found = np.linalg.eigvals(np.diag([1.0, self.reversal]) @ turned).astype(complex) ** 2
        return found[np.argsort(-found.imag)]

    def places(self, times: Array) -> Array:
        """Return the displacement at times since the highest place [m]."""
        friction, w = self.friction, self.angular
        wide = friction * sin(pi / w) / (w * (1.0 + cos(pi / w)))
        passed = np.mod(times, pi / w)
        swung = self.amplitude * np.cos(w * passed) + wide * np.sin(w * passed)
        bend = w * wide * np.sin(passed)
        falls = friction - friction * np.cos(passed) + swung - bend
        return np.where(np.mod(times, self.period) < pi / w, falls, -falls)
