"""One mass on a spring, rubbed: turning points, rest, stick-slip on a belt."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import xarray as xr

from ..arrays import Array
from ..contact import Coulomb, StaticKinetic
from ..lowering.schemes import Scheme
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme
from .systems.on_belts import Slider, den_hartog, stick_slip, swing, turning_points

STICKING, SLIDING = 1, 2


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
        # The limit is reached within a step, so the mass is at most v h away. Each time it grazes the belt's velocity,
        # the effect of the spring within a step is added.
        tolerance = same.belt * step + cycles * swing * (angular * step) ** 2
        reason = "leaves within v h of the limit; grazes the belt for a step a cycle: v h + n (v/w) (w h)²"
        return [Row("amplitude after 30 cycles", swing, float(np.ptp(last) / 2), tolerance, reason, "m", scheme.name)]

    found = by_scheme(rows)
    return Outcome(found, Sketch("time [s]", "displacement from the kinetic limit [m]", curves))


FREQUENCY, FRICTION = 0.8, 0.2


def forced() -> Outcome:
    """Mass and spring of 1 under ``cos(w t)`` N and little friction, never at rest: its amplitude."""
    amplitude, period = den_hartog(FREQUENCY, FRICTION), 2.0 * pi / FREQUENCY
    counts = np.array([100.0, 200.0, 400.0, 800.0])
    curves: list[Curve] = []

    def rows(scheme: Scheme) -> list[Row]:
        errors = np.array([abs(swing(FREQUENCY, FRICTION, float(count), scheme) / amplitude - 1.0) for count in counts])
        curves.append(Curve(period / counts, errors, scheme.name, marks=True))
        found = swing(FREQUENCY, FRICTION, 400.0, scheme)
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
        forced,
    ),
    Case(
        "sdnd100",
        "Slider with Coulomb friction, released",
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
