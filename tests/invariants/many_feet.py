"""Random blocks on one to eight feet under every law of friction: solved, laws at every step, ledger.

As a program, ``python -m invariants.many_feet --count 10000`` in the folder of the tests, it runs that number from a
seed and prints a line of counts; failures are printed with their number.
"""

from __future__ import annotations

import argparse

import numpy as np
from physics.cases import SCHEMES

import stridula as st

from .laws import violations
from .recipes import Foot, Recipe, build, run_of

STEPS, MOST = 150, 8


def law_of(random: np.random.Generator, name: str):
    """Return a law of friction with drawn numbers."""
    kinetic, more = random.uniform(0.05, 0.6), random.uniform(0.0, 0.4)
    velocity = 10.0 ** random.uniform(-3.0, -0.5)
    static = kinetic + more
    if name == "coulomb":
        return st.Coulomb(kinetic)
    if name == "static":
        return st.StaticKinetic(static, kinetic)
    if name == "stribeck":
        return st.Stribeck(static, kinetic, velocity, random.uniform(0.5, 2.0), random.uniform(0.0, 1.0))
    if name == "exponential":
        return st.ExponentialWeakening(static, kinetic, velocity)
    if name == "linear":
        return st.LinearWeakening(static, random.uniform(0.0, 2.0), kinetic)
    if name == "tabulated":
        return st.TabulatedFriction([0.0, velocity, 3.0 * velocity, 1.0], random.uniform(0.05, 0.8, 4))
    if name == "lugre":
        return st.LuGre(static, kinetic, velocity, 10.0 ** random.uniform(3.0, 6.0), random.uniform(0.0, 2.0))
    a, b = random.uniform(0.005, 0.03, 2)
    return st.RateAndState(static, a, b, 10.0 ** random.uniform(-6.0, -3.0), velocity, name)


LAWS = ("coulomb", "static", "stribeck", "exponential", "linear", "tabulated", "lugre", "aging", "slip")


def drawn(seed: int, number: int) -> Recipe:
    """Return a block on one to eight feet in turn, with mixed laws."""
    random = np.random.default_rng((seed, number))
    count = 1 + number % MOST
    feet = tuple(
        Foot(
            law_of(random, str(random.choice(LAWS))),
            float(random.choice([0.0, random.uniform(0.0, 1e-6)])),
            0.0,
            float(random.choice([-1.0, 1.0]) * 10.0 ** random.uniform(-3.0, 0.0)),
            float(random.choice([0.0, random.uniform(0.0, 1e-6)])),
            float(random.uniform(20.0, 500.0)),
        )
        for _ in range(count)
    )
    springs = tuple(10.0 ** random.uniform(4.0, 6.0, count))
    dashpots = tuple(10.0 ** random.uniform(-1.0, 1.0, count))
    mass, load = 10.0 ** random.uniform(-1.0, 1.0), 10.0 ** random.uniform(-1.0, 2.0)
    speed = float(random.choice([0.0, random.uniform(0.0, 1.0)]))
    return Recipe("block", feet, (mass,), springs, dashpots, load, speed, 0.0)


def solution_and_faults(seed: int, number: int) -> tuple[str, set[str]]:
    """Return whether a drawn system is solved, and the laws that its run breaks."""
    recipe = drawn(seed, number)
    try:
        run = run_of(recipe, SCHEMES[number // MOST % 2], STEPS)
    except st.Diverged as stop:
        return stop.record.attrs["ended"], set()
    if "unsolved_steps" in run and run.unsolved_steps.any():
        return "unsolved steps", set()
    return "solved", violations(run, build(recipe))


def main() -> None:
    """Run many and print the results."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--number", type=int, help="take this one alone")
    asked = parser.parse_args()
    numbers = range(asked.count) if asked.number is None else [asked.number]
    counts: dict[str, int] = {}
    for number in numbers:
        how, broken = solution_and_faults(asked.seed, number)
        counts[how] = counts.get(how, 0) + 1
        if how != "solved" or broken:
            print(f"number {number}, {1 + number % MOST} contacts: {how} {', '.join(sorted(broken))}", flush=True)
    print(f"{len(numbers)} systems: {', '.join(f'{count} {how}' for how, count in sorted(counts.items()))}")


if __name__ == "__main__":
    main()
