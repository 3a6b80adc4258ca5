"""Growth of time with modes, laws of friction, contacts, runs and cores."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

import stridula as st
from ratios import Ratio, over, seconds, show, sized
from stridula.integration.marches import March
from systems import (
    FEET,
    GIVEN,
    LINES,
    RUNS,
    SIZES,
    beams,
    case_of,
    limit_of,
    marching,
    on_a_beam,
    on_a_plate,
    pad,
    same_start,
    squeals,
)

TITLE = "scaling"
SAMPLES, RATIO = sized(200, 10), 100


@dataclass(frozen=True)
class Weakening(st.FrictionLaw):
    """A law written by a user."""

    static: float = 0.12
    kinetic: float = 0.1
    velocity: float = 0.1

    def coefficient_at(self, velocity: np.ndarray) -> np.ndarray:
        """Return the coefficients at slip velocities [m/s]."""
        return self.kinetic + (self.static - self.kinetic) * np.exp(-np.abs(velocity) / self.velocity)


SPEEDS = np.linspace(0.0, 5.0, 40)
# Laws with about the ratio of the sliding case, and the largest time of a step over that under Coulomb's law.
LAWS = {
    "exponential weakening": st.ExponentialWeakening(0.12, 0.1, 0.1),
    "linear weakening": st.LinearWeakening(0.12, 0.1, 0.1),
    "Stribeck, exponent 1.5": st.Stribeck(0.12, 0.1, 0.1, exponent=1.5),
    "LuGre": st.LuGre(0.12, 0.1, 0.1, stiffness=1e4, damping=10.0),
    "rate and state": st.RateAndState(0.1, 0.01, 0.008, 1e-4, 1e-2),
    "a table": st.TabulatedFriction(SPEEDS, 0.1 + 0.02 * np.exp(-2.0 * SPEEDS)),
    "a law of one's own": Weakening(),
}
LAW_BARS, LAW_MODES = {"a table": 2.0, "a law of one's own": 2.0}, 60
CONTACT_BARS = {2: 6.0, 8: 30.0}
PLATES, PLATE_BAR = sized((100, 300), (100,)), 1.6


def rows() -> Iterator[Ratio]:
    """Yield every scaling."""
    yield from modes()
    yield from laws()
    yield from contacts()
    yield from plates()
    yield from runs()
    yield from cores()


def modes() -> Iterator[Ratio]:
    """Yield the time of a step over that with some 30 modes; sliding."""
    first, *others = seconds(*(stepping(beams(size, "sliding")) for size in SIZES.values()))
    for number, times in zip(list(SIZES)[1:], others, strict=True):
        yield Ratio(f"time of a step, some {number} modes over 30", over(times, first))


def laws() -> Iterator[Ratio]:
    """Yield the time of a step under laws that depend on the slip speed over that under Coulomb's; sliding."""
    system = beams(SIZES[LAW_MODES], "sliding")
    others = [replace(system, contact=replace(system.contacts[0], friction=law)) for law in LAWS.values()]
    first, *timed = seconds(*(stepping(one) for one in (system, *others)))
    for name, times in zip(LAWS, timed, strict=True):
        quantity = f"time of a step, {name} over Coulomb, some {LAW_MODES} modes"
        yield Ratio(quantity, over(times, first), most=LAW_BARS.get(name, 1.5))


def contacts() -> Iterator[Ratio]:
    """Yield the time of a step over that with one contact."""
    numbers = [2**power for power in range(FEET.bit_length())]
    first, *others = seconds(*(stepping(pad(number)) for number in numbers))
    for number, times in zip(numbers[1:], others, strict=True):
        yield Ratio(
            f"time of a step, {number} sliding contacts over 1", over(times, first), most=CONTACT_BARS.get(number)
        )


def plates() -> Iterator[Ratio]:
    """Yield the time of a step on a plate over that on a beam of as many modes; sliding."""
    for number in PLATES:
        beam, *others = seconds(stepping(on_a_beam(number)), *(stepping(on_a_plate(number, line)) for line in LINES))
        for line, times in zip(LINES, others, strict=True):
            quantity = f"time of a step, {number} modes of a plate over a beam, {line}"
            yield Ratio(quantity, over(times, beam), most=PLATE_BAR)


def stepping(system: st.System) -> Callable[[], object]:
    """Return a function that marches a system."""
    step = 0.2 * limit_of(system)
    case = case_of(system, step)
    return marching(March([case.blocks], [case.state], step, RATIO), [case], SAMPLES)


def runs() -> Iterator[Ratio]:
    """Yield the throughput of runs at once over that of one by `simulate`, with one worker."""
    systems = squeals(RUNS)
    numbers = [2**power for power in range(RUNS.bit_length())]
    many = [lambda number=number: st.simulate_many(systems[:number], workers=1, **GIVEN) for number in numbers]
    single, *others = seconds(lambda: st.simulate(systems[0], **GIVEN), *many)
    for number, times in zip(numbers, others, strict=True):
        yield Ratio(
            f"throughput of runs at once over one alone, {number} at a time, one worker", over(single, times, number)
        )


def cores() -> Iterator[Ratio]:
    """Yield the throughput of many runs over that of one worker."""
    systems, most = squeals(RUNS), os.cpu_count() or 1
    workers = [1, *sorted({2**power for power in range(1, most.bit_length())} | {most} - {1})]
    many = [lambda n=n: st.simulate_many(systems, workers=n, **GIVEN) for n in workers]
    first, *others = seconds(*many, agree=same_start)
    for number, times in zip(workers[1:], others, strict=True):
        yield Ratio(f"throughput, {RUNS} runs, {number} workers over 1", over(first, times))


if __name__ == "__main__":
    show(TITLE, rows())
