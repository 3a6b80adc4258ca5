"""Limit cycles found directly, with their multipliers, against integration from event to event."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from ..arrays import Array
from ..cycles import limit_cycle
from ..drives import InitialEquilibrium
from ..lowering.schemes import ExactModal, Scheme
from ..records import Displacement
from ..system import System
from .case import Case, Curve, Outcome, Row, Sketch, by_scheme
from .frequencies import fitted_order
from .systems.cycles import Cycle, DenHartog, LiftingMass, Stopped, Weakening

ORDER, WITHIN = 2.0, 0.3
# Largest error relative to the size of a quantity at the default step of a scheme, and at a fine one.
USUAL_BAR, FINE_BAR = 1e-3, 1e-4


@dataclass(frozen=True)
class Way:
    """A way to find a cycle, and the accuracy expected of it.

    Attributes
    ----------
    scheme : Scheme
        Time scheme.
    step : float or None
        Longest step [s]; None for that of the scheme.
    """

    scheme: Scheme
    step: float | None

    @property
    def bar(self) -> float:
        """Largest error relative to the size of a quantity [1]."""
        return USUAL_BAR if self.step is None else FINE_BAR

    @property
    def words(self) -> str:
        """The step in words."""
        return "default step" if self.step is None else f"step {self.step:g} s"

    def row(self, quantity: str, expected: float, obtained: float, size: float, units: str = "1") -> Row:
        """Return a row whose tolerance is relative to a size."""
        reason = f"the bar of limit cycles: {self.bar:g} of its size at the {self.words}, of second order"
        name = f"{self.words}, {quantity}"
        return Row(name, expected, obtained, self.bar * size, reason, units, self.scheme.name)

    def multipliers(self, known: Array, cycle: xr.Dataset, words: str = "") -> Iterator[Row]:
        """Yield the rows of multipliers: of each, or of each pair, the real and the imaginary part."""
        found = nearest(known, multipliers_of(cycle))
        upper = [(a, b) for a, b in zip(known.astype(complex), found, strict=True) if a.imag >= 0.0]
        for number, (expected, obtained) in enumerate(upper, start=1):
            name = f"{words}multiplier {number}" if len(upper) > 1 else f"{words}multiplier"
            yield self.row(f"{name}, real part", expected.real, obtained.real, abs(expected))
            if expected.imag:
                yield self.row(f"{name}, imaginary part", expected.imag, obtained.imag, abs(expected))


def ways(scheme: Scheme, fine: float) -> list[Way]:
    """Return the ways of the two bars: at default settings (exact modal), with a fine step [s]."""
    return [Way(scheme, None), Way(scheme, fine)] if scheme.name == ExactModal.name else [Way(scheme, fine)]


def multipliers_of(cycle: xr.Dataset) -> Array:
    """Return the multipliers of a record but the trivial one, the largest first."""
    real, imaginary = cycle["multiplier"].values.T
    return np.asarray((real + 1j * imaginary)[~cycle["trivial"].values])


def nearest(known: Array, found: Array) -> list[complex]:
    """Return the nearest obtained multiplier to each known one; NaN where there are none."""
    if not found.size:
        return [complex(np.nan, np.nan)] * len(known)
    return [complex(found[np.argmin(np.abs(found - one))]) for one in known]


def highest(values: Array) -> float:
    """Return the highest value of a period, by a parabola through three samples."""
    top = int(np.argmax(values))
    before, middle, after = values[top - 1], values[top], values[(top + 1) % values.size]
    curved = 2.0 * middle - before - after
    return float(middle + (before - after) ** 2 / (8.0 * curved)) if curved > 0.0 else float(middle)


def share_above(values: Array, level: float) -> float:
    """Return the share of a period in which values are above a level, by straight lines between samples."""
    first, second = values - level, np.roll(values, -1) - level
    crosses = (first > 0.0) != (second > 0.0)
    rise = np.where(crosses, np.abs(first) + np.abs(second), 1.0)
    parts = np.where(crosses, np.maximum(first, second) / rise, first > 0.0)
    return float(parts.mean())


def places_of(cycle: xr.Dataset, number: int = 0) -> Array:
    """Return the displacement at a probe over a period [m]."""
    return np.asarray(cycle["displacement"].values[:, number])


def from_highest(places: Array, period: float, label: str) -> Curve:
    """Return a line over time since the highest place."""
    return Curve(period / places.size * np.arange(places.size), np.roll(places, -int(np.argmax(places))), label)


def drawn(cycle: xr.Dataset, places: Array, label: str) -> Curve:
    """Return the line of an obtained displacement, its samples marked."""
    line = from_highest(places, float(cycle["period"]), label)
    return Curve(line.x, line.y, line.label, marks=True)


def ends(way: Way, known: Cycle, number: int, places: Array, words: str) -> list[Row]:
    """Return the rows of both ends of a displacement, with tolerances relative to its range."""
    low, high = float(known.lowest[number]), float(known.highest[number])
    return [
        way.row(f"{words}lowest", low, -highest(-places), high - low, "m"),
        way.row(f"{words}highest", high, highest(places), high - low, "m"),
    ]


def order_row(quantity: str, steps: Sequence[float], error: Callable[[float], float], scheme: Scheme) -> Row:
    """Return the row of the observed order of an error in the step."""
    order = fitted_order(np.array(steps), np.array([abs(error(step)) for step in steps]))
    reason = "the bar of limit cycles: declared order within 0.3"
    return Row(f"order of the {quantity}", ORDER, order, WITHIN, reason, "1", scheme.name)


def weakening() -> Outcome:
    """Stick-slip, and the unstable cycle that separates it from stable sliding."""
    sticks, slides = Weakening(1.0), Weakening(1.2)
    known, smooth = sticks.stick_slip(), slides.around_sliding(0.3, 0.5)
    curves = [from_highest(known.places[:, 0], known.period, "sticking: expected")]
    curves.append(from_highest(smooth.places[:, 0], smooth.period, "unstable: expected"))

    def found(way: Way, start: InitialEquilibrium | None = None) -> xr.Dataset:
        return limit_cycle((slides if start else sticks).system(), start, scheme=way.scheme, step=way.step)

    def rows(scheme: Scheme) -> Iterator[Row]:
        near = InitialEquilibrium(mode="most unstable", amplitude=0.45)
        for way in ways(scheme, 0.01):
            cycle = found(way)
            yield way.row("sticking: period", known.period, float(cycle["period"]), known.period, "s")
            yield from ends(way, known, 0, places_of(cycle), "sticking: ")
            largest = max(np.abs(multipliers_of(cycle)), default=0.0)
            yield way.row("sticking: largest multiplier", 0.0, float(largest), 1.0)
            unstable = found(way, near)
            yield way.row("unstable: period", smooth.period, float(unstable["period"]), smooth.period, "s")
            amplitude, places = float(smooth.highest[0]) - slides.equilibrium, places_of(unstable)
            reached = highest(places) - slides.equilibrium
            yield way.row("unstable: amplitude", amplitude, reached, amplitude, "m")
            yield from way.multipliers(smooth.multipliers, unstable, "unstable: ")
            yield way.row("unstable: found stable", 0.0, float(unstable["stable"]), 1.0)
            if way.step is None:
                curves.append(drawn(cycle, places_of(cycle), f"sticking: {scheme.name}"))
                curves.append(drawn(unstable, places, f"unstable: {scheme.name}"))
        steps = (0.02, 0.01, 0.005)
        yield order_row(
            "period, sticking", steps, lambda step: float(found(Way(scheme, step))["period"]) - known.period, scheme
        )
        yield order_row(
            "period, unstable",
            (0.08, 0.04, 0.02),
            lambda step: float(found(Way(scheme, step), near)["period"]) - smooth.period,
            scheme,
        )

    found_rows = by_scheme(lambda scheme: list(rows(scheme)))
    return Outcome(found_rows, Sketch("time since the highest place [s]", "displacement [m]", curves))


def mode_coupling() -> Outcome:
    """The cycle in which flutter ends: the mass leaves the belt for a third of the time."""
    mass = LiftingMass()
    known, curves = mass.cycle(), []
    curves.append(from_highest(known.places[:, 1], known.period, "expected"))
    largest = -mass.contact * float(known.lowest[1])

    def found(way: Way) -> xr.Dataset:
        return limit_cycle(mass.system(), scheme=way.scheme, step=way.step)

    def rows(scheme: Scheme) -> Iterator[Row]:
        for way in ways(scheme, 0.01):
            cycle = found(way)
            along, above = places_of(cycle), places_of(cycle, 1)
            yield way.row("period", known.period, float(cycle["period"]), known.period, "s")
            yield from ends(way, known, 0, along, "along the belt: ")
            yield from ends(way, known, 1, above, "above the belt: ")
            pressed = highest(cycle["normal_force"].values.ravel())
            yield way.row("largest normal force", largest, pressed, largest, "N")
            yield way.row("share of time open", known.open, share_above(above, 0.0), known.open)
            yield from way.multipliers(known.multipliers, cycle)
            if way.step is None:
                curves.append(drawn(cycle, above, scheme.name))
        yield order_row(
            "period",
            (0.04, 0.02, 0.01),
            lambda step: float(found(Way(scheme, step))["period"]) - known.period,
            scheme,
        )

    found_rows = by_scheme(lambda scheme: list(rows(scheme)))
    return Outcome(found_rows, Sketch("time since the highest place [s]", "height above the belt [m]", curves))


def both_masses(system: System) -> list[Displacement]:
    """Return the probes of the two masses of `Stopped`."""
    return [Displacement(system.contacts[0].tip, "y"), Displacement(system.drives[0].point, "y")]  # type: ignore[attr-defined]


def stop() -> Outcome:
    """Two masses under a periodic force, without contact and against a stop."""
    curves = []
    masses = {angular: Stopped(angular) for angular in (0.5, 0.65)}
    known = {angular: one.cycle() for angular, one in masses.items()}

    def found(angular: float, way: Way) -> xr.Dataset:
        system = masses[angular].system()
        return limit_cycle(system, scheme=way.scheme, step=way.step, probes=both_masses(system))

    for angular, one in known.items():
        curves.append(from_highest(one.places[:, 0], one.period, f"{angular:g} rad/s: expected"))

    def first_harmonic(cycle: xr.Dataset) -> float:
        return float(cycle["displacement_harmonic"].values[0, 1])

    def rows(scheme: Scheme) -> Iterator[Row]:
        for way in ways(scheme, 0.005):
            for angular, one in known.items():
                cycle = found(angular, way)
                words, places = f"{angular:g} rad/s: ", -places_of(cycle)
                harmonic = float(one.harmonic(1)[1])
                yield way.row(f"{words}period", one.period, float(cycle["period"]), one.period, "s")
                yield way.row(f"{words}first harmonic of mass 2", harmonic, first_harmonic(cycle), harmonic, "m")
                yield way.row(
                    f"{words}highest of mass 1", float(one.highest[0]), highest(places), float(one.highest[0]), "m"
                )
                yield from way.multipliers(one.multipliers, cycle, words)
                if way.step is None:
                    curves.append(drawn(cycle, places, f"{angular:g} rad/s: {scheme.name}"))
        harmonic = float(known[0.65].harmonic(1)[1])
        yield order_row(
            "first harmonic of mass 2 at 0.65 rad/s",
            (0.02, 0.01, 0.005),
            lambda step: first_harmonic(found(0.65, Way(scheme, step))) - harmonic,
            scheme,
        )

    found_rows = by_scheme(lambda scheme: list(rows(scheme)))
    return Outcome(found_rows, Sketch("time since the highest place [s]", "displacement of mass 1 [m]", curves))


def den_hartog_cycle() -> Outcome:
    """Mass and spring of 1 under ``sin(w t)`` N and little friction, never at rest: amplitude and multipliers."""
    rubbed = DenHartog(0.8, 0.2)
    times = rubbed.period * np.arange(400) / 400
    curves = [Curve(times, rubbed.places(times), "expected")]

    def found(way: Way) -> xr.Dataset:
        return limit_cycle(rubbed.system(), scheme=way.scheme, step=way.step)

    def rows(scheme: Scheme) -> Iterator[Row]:
        for way in ways(scheme, 0.0025):
            cycle = found(way)
            places = places_of(cycle)
            yield way.row("amplitude", rubbed.amplitude, highest(places), rubbed.amplitude, "m")
            product = float(np.prod(nearest(rubbed.multipliers, multipliers_of(cycle))).real)
            yield way.row("product of both multipliers", rubbed.product, product, rubbed.product)
            yield from way.multipliers(rubbed.multipliers, cycle)
            if way.step is None:
                curves.append(drawn(cycle, places, scheme.name))
        counts = (100, 200, 400, 800)
        yield order_row(
            "amplitude",
            [rubbed.period / count for count in counts],
            lambda step: highest(places_of(found(Way(scheme, step)))) - rubbed.amplitude,
            scheme,
        )

    found_rows = by_scheme(lambda scheme: list(rows(scheme)))
    return Outcome(found_rows, Sketch("time since the highest place [s]", "displacement [m]", curves))


CASES = (
    Case(
        "weakening-cycle",
        "Limit cycles of a mass on a belt under friction that falls with speed",
        "integration by DOP853 from event to event; multiplier after Liouville",
        weakening,
    ),
    Case(
        "mode-coupling-cycle",
        "Limit cycle of mode coupling with lift-off",
        "integration by DOP853 from event to event with the variational equations; system of Hoffmann, Fischer, "
        "Allgaier & Gaul 2002",
        mode_coupling,
    ),
    Case(
        "stop-cycle",
        "Periodic motion of two masses against a stop",
        "integration by DOP853 from event to event with the variational equations",
        stop,
    ),
    Case(
        "den-hartog-cycle",
        "Multipliers of a forced oscillator with dry friction",
        "closed form: J. P. Den Hartog 1931, Trans. ASME 53, APM-107, with the saltation of both reversals",
        den_hartog_cycle,
    ),
)
