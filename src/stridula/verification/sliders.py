"""One mass on a spring, rubbed: turning points, rest, stick-slip on a belt."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, cos, hypot, pi, sin, sqrt

import numpy as np
import xarray as xr

from ..arrays import Array
from ..bodies import PointMass
from ..connections import Spring
from ..contact import Coulomb, FrictionLaw, PointContact, RigidTrack, StaticKinetic
from ..drives import Force, InitialState
from ..histories import Harmonic
from ..integration import simulate
from ..lowering.schemes import Scheme
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme

STICKING, SLIDING = 1, 2


@dataclass(frozen=True)
class Slider:
    """A mass on a spring, pressed on a floor: ``m x'' + k x = -mu N sign(x' - belt)``.

    Attributes
    ----------
    mass, stiffness, normal : float
        Mass [kg], stiffness of its spring [N/m], force that presses it on the floor [N].
    friction : Coulomb, StaticKinetic or another law without internal state
        Law of friction.
    position, velocity : float
        Start [m, m/s].
    belt : float, optional
        Velocity of the floor [m/s].
    push : Harmonic, optional
        Factor on a force of 1 N along the floor; none if left out.
    """

    mass: float
    stiffness: float
    normal: float
    friction: FrictionLaw
    position: float
    velocity: float = 0.0
    belt: float = 0.0
    push: Harmonic | None = None

    def run(self, duration: float, step: float, scheme: Scheme) -> xr.Dataset:
        """Simulate and record every step."""
        body = PointMass(self.mass)
        system = System(
            PointContact(body.centre, RigidTrack(velocity=self.belt), friction=self.friction),
            drives=[
                Force(body.centre, y=-self.normal),
                InitialState(body, displacement=(self.position, 0.0), velocity=(self.velocity, 0.0)),
                *([Force(body.centre, x=1.0, history=self.push)] if self.push else []),
            ],
            connections=[Spring(body.centre, stiffness=self.stiffness)],
        )
        probes = [Displacement(body.centre, "x")]
        return simulate(system, duration, scheme=scheme, step=step, sample_rate=1.0 / step, probes=probes)


def turning_points(position: float, velocity: float, angular: float, offset: float) -> tuple[list[float], float]:
    """Return the turning points of a mass on a spring under Coulomb friction, the last being its rest, and their times.

    It swings about ``-offset sign(x')`` with ``offset = mu N / k``: the amplitude falls by ``2 offset`` every half
    period, and it stays at the first turning point within the offset.
    """
    if velocity == 0.0:
        sense, first, time = (-1.0 if position > 0 else 1.0), position, 0.0
        points = []
    else:
        sense = 1.0 if velocity > 0 else -1.0
        centre = -offset * sense
        first = centre + sense * hypot(position - centre, velocity / angular)
        # Phase from the start to the turning point of the circle about the centre.
        time = atan(abs(velocity) / angular / abs(position - centre)) / angular
        points, sense = [first], -sense
    place = first
    while abs(place) > offset:
        place = -place - 2.0 * offset * sense
        points.append(place)
        time += pi / angular
        sense = -sense
    return points, time


def turned(position: Array) -> Array:
    """Return the sampled turning points of a motion."""
    moves = np.flatnonzero(np.diff(position) != 0.0)
    ways = np.sign(np.diff(position)[moves])
    return position[moves[1:][ways[1:] != ways[:-1]]]


def stuck_from(run: xr.Dataset) -> float:
    """Return the time from which a run sticks permanently [s]; NaN if it does not."""
    moving = np.flatnonzero(run["status"].values != STICKING)
    if moving.size and moving[-1] == run.sizes["time"] - 1:
        return float("nan")
    return float(run["time"].values[moving[-1]]) if moving.size else 0.0


def _settles(slider: Slider, step: float, units: str = "m") -> Outcome:
    angular = sqrt(slider.stiffness / slider.mass)
    offset = slider.friction.coefficient * slider.normal / slider.stiffness  # type: ignore[attr-defined]
    points, time = turning_points(slider.position, slider.velocity, angular, offset)
    curves = [Curve(_turning_times(points, time, angular), np.array(points), "expected turning points", marks=True)]
    # Friction reverses at a step instead of inside it.
    largest = max(abs(point) for point in [slider.position, *points])
    kick = (slider.stiffness * largest + offset * slider.stiffness) / slider.mass * step

    def rows(scheme: Scheme) -> list[Row]:
        run = slider.run(1.2 * time, step, scheme)
        place = run["displacement"].values[:, 0]
        curves.append(Curve(run["time"].values, place, scheme.name))
        found = np.append(turned(place), place[-1])
        found = np.append(found, np.full(max(0, len(points) - found.size), np.nan))
        reason = "each reversal a step late or early: n (k x + mu N) h² / m"
        turning = [
            Row(
                "place of rest" if n == len(points) else f"turning point {n}",
                point,
                float(found[n - 1]),
                n * kick * step,
                reason,
                units,
                scheme.name,
            )
            for n, point in enumerate(points, start=1)
        ]
        late = (len(points) + 1) * step
        reason = "a step for each reversal and for the start"
        return [*turning, Row("sticks permanently from", time, stuck_from(run), late, reason, "s", scheme.name)]

    return Outcome(by_scheme(rows), Sketch("time [s]", "displacement [m]", curves))


def _turning_times(points: list[float], last: float, angular: float) -> Array:
    return last - np.arange(len(points))[::-1] * pi / angular


def sdnd100() -> Outcome:
    """Slider released from 0.85 mm: m = 1, k = 1e4, N = 10, mu = 0.1."""
    return _settles(Slider(1.0, 1e4, 10.0, Coulomb(0.1), position=0.85e-3), step=1e-5)


def relay() -> Outcome:
    """Relay oscillator ``x'' + x = -sign x'`` from x = 12, x' = 6."""
    return _settles(Slider(1.0, 1.0, 1.0, Coulomb(1.0), position=12.0, velocity=6.0), step=5e-4)


BELT = Slider(1.0, 4.0, 10.0, StaticKinetic(0.4, 0.25), position=0.0, velocity=0.5, belt=0.5)


@dataclass(frozen=True)
class StickSlip:
    """The cycle of a mass on a belt with constant static and kinetic friction.

    Attributes
    ----------
    slip, stick : float
        Times of slip and of stick [s].
    lowest, highest : float
        Ends of the motion [m].
    slowest : float
        Least velocity [m/s].
    """

    slip: float
    stick: float
    lowest: float
    highest: float
    slowest: float


def stick_slip(slider: Slider) -> StickSlip:
    """Return the cycle: from the static limit the mass swings about the kinetic one until it moves with the belt again.

    With ``D = (mu_s - mu_k) N / k`` it leaves at ``x_k + D`` with the belt's velocity v, so its amplitude is
    ``sqrt(D² + (v/w)²)``, and it comes back to v at ``x_k - D``.
    """
    law = slider.friction
    assert isinstance(law, StaticKinetic)
    angular = sqrt(slider.stiffness / slider.mass)
    reach = (law.static - law.kinetic) * slider.normal / slider.stiffness
    middle = law.kinetic * slider.normal / slider.stiffness
    amplitude = hypot(reach, slider.belt / angular)
    return StickSlip(
        slip=2.0 / angular * (pi - atan(reach * angular / slider.belt)),
        stick=2.0 * reach / slider.belt,
        lowest=middle - amplitude,
        highest=middle + amplitude,
        slowest=-amplitude * angular,
    )


def belt() -> Outcome:
    """Stick-slip of a mass on a belt."""
    known, step = stick_slip(BELT), 2e-4
    angular = sqrt(BELT.stiffness / BELT.mass)
    curves: list[Curve] = []

    def rows(scheme: Scheme) -> list[Row]:
        run = BELT.run(24.0, step, scheme)
        time, place, status = (run[name].values for name in ("time", "displacement", "status"))
        place = place[:, 0]
        curves.append(Curve(time, place, scheme.name))
        slides = (status == SLIDING).astype(int)
        left, caught = time[np.flatnonzero(np.diff(slides) == 1)], time[np.flatnonzero(np.diff(slides) == -1)]
        cycles = min(left.size, caught.size) - 1
        slips, sticks = caught[:cycles] - left[:cycles], left[1 : cycles + 1] - caught[:cycles]
        both, late = slips + sticks, time > left[1]
        velocity = np.gradient(place, step)[late][1:-1]
        instants = "it lets go and is caught within a step each, and travels v h meanwhile"
        places = "leaves within v h of the static limit"
        drift = 2.0 * BELT.belt * step
        return [
            Row("time of slip", known.slip, float(slips.mean()), 4 * step, instants, "s", scheme.name),
            Row("time of stick", known.stick, float(sticks.mean()), 4 * step, instants, "s", scheme.name),
            Row("period", known.slip + known.stick, float(both.mean()), 4 * step, instants, "s", scheme.name),
            Row("lowest", known.lowest, float(place[late].min()), drift, places, "m", scheme.name),
            Row("highest", known.highest, float(place[late].max()), drift, places, "m", scheme.name),
            Row("least velocity", known.slowest, float(velocity.min()), drift * angular, places, "m/s", scheme.name),
        ]

    return Outcome(by_scheme(rows), Sketch("time [s]", "displacement [m]", curves))


def belt_without_jump() -> Outcome:
    """Equal static and kinetic friction: from rest on the belt the swing is v / w, and neither grows nor falls."""
    step, cycles = 5e-4, 30
    same = Slider(1.0, 4.0, 10.0, StaticKinetic(0.3, 0.3), position=0.0, velocity=0.5, belt=0.5)
    angular = sqrt(same.stiffness / same.mass)
    middle, swing = 0.3 * same.normal / same.stiffness, same.belt / angular
    curves: list[Curve] = []

    def rows(scheme: Scheme) -> list[Row]:
        begin = middle / same.belt
        run = same.run(begin + cycles * 2.0 * pi / angular, step, scheme)
        place = run["displacement"].values[:, 0] - middle
        curves.append(Curve(run["time"].values, place, scheme.name))
        last = place[run["time"].values > begin + (cycles - 2) * 2.0 * pi / angular]
        # The limit is reached within a step, v h away; each time it grazes the belt's velocity adds the effect
        # of the spring within a step.
        tolerance = same.belt * step + cycles * swing * (angular * step) ** 2
        reason = "leaves within v h of the limit; grazes the belt for a step a cycle: v h + n (v/w) (w h)²"
        return [Row("amplitude after 30 cycles", swing, float(np.ptp(last) / 2), tolerance, reason, "m", scheme.name)]

    found = by_scheme(rows)
    return Outcome(found, Sketch("time [s]", "displacement from the kinetic limit [m]", curves))


FREQUENCY, FRICTION = 0.8, 0.2


def den_hartog() -> Outcome:
    """Mass and spring of 1 under ``cos(w t)`` N, under little friction, never at rest: amplitude by steps per period.

    With ``V = 1 / (1 - w²)`` and ``U = sin(pi/w) / (w (1 + cos(pi/w)))`` it is ``sqrt(V² - (U mu N)²)``.
    """
    high = 1.0 / (1.0 - FREQUENCY**2)
    wide = sin(pi / FREQUENCY) / (FREQUENCY * (1.0 + cos(pi / FREQUENCY)))
    amplitude, period = sqrt(high**2 - (wide * FRICTION) ** 2), 2.0 * pi / FREQUENCY
    swung = Slider(1.0, 1.0, 1.0, Coulomb(FRICTION), 0.0, push=Harmonic(1.0 / period))
    counts = np.array([100.0, 200.0, 400.0, 800.0])
    curves: list[Curve] = []

    def peak(scheme: Scheme, count: float) -> float:
        place = swung.run(150.0 * period, period / count, scheme)["displacement"].values[-int(20 * count) :, 0]
        top = np.flatnonzero((place[1:-1] > place[:-2]) & (place[1:-1] >= place[2:])) + 1
        before, highest, after = place[top - 1], place[top], place[top + 1]
        return float(np.mean(highest + (before - after) ** 2 / (8.0 * (2.0 * highest - before - after))))

    def rows(scheme: Scheme) -> list[Row]:
        errors = np.array([abs(peak(scheme, float(count)) / amplitude - 1.0) for count in counts])
        curves.append(Curve(period / counts, errors, scheme.name, marks=True))
        found = peak(scheme, 400.0)
        words = "(w h)² of it: reversals are of second order, also with whole numbers of steps a period"
        within = amplitude * (2.0 * pi / 400.0) ** 2
        order = -float(np.polyfit(np.log(counts), np.log(errors), 1)[0])
        return [
            Row("amplitude, 400 steps a period", amplitude, found, within, words, "m", scheme.name),
            Row("order of the amplitude", 2.0, order, 0.1, "declared order within 0.1", "1", scheme.name),
        ]

    sketch = Sketch("step [s]", "relative error of the amplitude", curves, logarithmic=True)
    return Outcome(by_scheme(rows), sketch)


CASES = (
    Case(
        "den-hartog",
        "Forced oscillator with dry friction, without stops",
        "J. P. Den Hartog 1931, Trans. ASME 53, APM-107: closed form of the amplitude",
        den_hartog,
    ),
    Case(
        "sdnd100",
        "Slider with Coulomb friction, let go",
        "Code_Aster V5.02.100, SDND100: sliding of a mass on a spring with Coulomb friction",
        sdnd100,
    ),
    Case(
        "relay",
        "Relay oscillator x'' + x = -sign x'",
        "Siconos examples, RelayOscillator / FrictionOscillator (INRIA); closed form by half periods",
        relay,
    ),
    Case(
        "belt",
        "Stick-slip of a mass on a moving belt",
        "closed form by pieces; e.g. Leine, van Campen, de Kraker & van den Steen 1998, Nonlinear Dynamics 16",
        belt,
    ),
    Case(
        "belt-equal",
        "Mass on a moving belt, static equal to kinetic friction",
        "closed form: no stick-slip without a fall of friction; e.g. Leine et al. 1998, Nonlinear Dynamics 16",
        belt_without_jump,
    ),
)
