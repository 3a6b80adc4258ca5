"""March a little of every kind of run and print, as JSON, the signatures that were compiled and loaded.

A separate program, `python -m kernels.every_kind`, that starts with the numba cache only. With `alone` and `abreast` it
makes only the runs, or the groups of runs, that compile everything; with `other type` one run, and a call that
is not in the cache.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import islice

import numpy as np
from physics.cases import CASES, SCHEMES, STEP, pair, slider, track, transverse

import stridula as st
from kernels.systems import AGING, BELT, SYSTEMS, WEAK, block_on_a_plane, oscillator, pad_on
from stridula.integration.compiled_code import compiled_functions

STEPS = 40
# The first and the end of the runs of each word.
SPANS = {"": (0, None), "alone": (0, 3), "abreast": (3, 6), "other type": (0, 1)}


def marched(system: st.System, step: float = STEP, **words):
    return st.simulate(system, STEPS * step, step=step, **{"sample_rate": 1.0 / step, **words})


def several(make: Callable[[], st.System], count: int):
    return st.simulate_many([make() for _ in range(count)], STEPS * STEP, step=STEP, sample_rate=0.2 / STEP, workers=1)


def runs() -> Iterator[Callable[[], object]]:
    """One contact first, then several in the plane and in space, all side by side, everything else after these."""
    yield lambda: marched(CASES["squeal"]())
    yield lambda: marched(pad_on(BELT, [WEAK] * 2), 1e-4)
    yield lambda: marched(block_on_a_plane())
    yield lambda: several(CASES["squeal"], 8)
    yield lambda: several(lambda: pad_on(BELT, [WEAK] * 2), 8)
    yield lambda: several(block_on_a_plane, 8)
    for count, make in ((4, CASES["judder"]), (9, CASES["dragged on a ramp"]), (5, lambda: oscillator(AGING))):
        yield lambda count=count, make=make: several(make, count)
    for make in CASES.values():
        yield lambda make=make: marched(make())
    for make, step in SYSTEMS.values():
        for scheme in SCHEMES:
            yield lambda make=make, step=step, scheme=scheme: marched(make(), step, scheme=scheme, probes=[])
    yield from sizes()
    yield from options()
    yield from other_numbers()


def sizes() -> Iterator[Callable[[], object]]:
    """Few and many modes, contacts and loads, and none."""
    for cutoff in (60.0, 2e3, 40e3):
        yield lambda cutoff=cutoff: st.simulate(
            pair(transverse(), 0.5, rod=slider(cutoff=cutoff), bar=track(cutoff=cutoff)), 1e-4
        )
    for count in (1, 2, 4):
        yield lambda count=count: marched(pad_on(BELT, [WEAK] * count), 1e-4)
    mass = st.PointMass(0.4)
    for drives in (
        [],
        [st.InitialVelocity(mass, y=-0.1)],
        [st.Gravity(), *(st.Force(mass.centre, x=1.0, history=st.Harmonic(10.0 * n)) for n in range(1, 4))],
    ):
        yield lambda drives=drives: marched(st.System(st.PointContact(mass.centre, BELT), drives), 1e-4)


def options() -> Iterator[Callable[[], object]]:
    """Samples of many steps, one step, all probes, continued runs, records from files."""
    system = CASES["squeal"]()
    points = (system.track.centre, system.slider.at(0.1))
    probes = [kind(point, "x") for kind in (st.Displacement, st.Velocity, st.Acceleration) for point in points]
    yield lambda: marched(system, sample_rate=0.1 / STEP, probes=[*probes, st.Reaction(system.slider, "moment")])
    yield lambda: st.simulate(system, STEP, step=STEP, sample_rate=1.0 / STEP)
    yield lambda: marched(system, start=marched(system))
    yield lambda: st.load_scenario(marched(SYSTEMS["pad on a beam"][0]())).simulate(duration=1e-4)
    yield lambda: marched(oscillator(AGING), 2e-4, contact_solve=st.GaussSeidel(1e-8, 20))
    yield lambda: st.ensemble(system, 1e-4, runs=2, measures={"force": lambda run: float(run.normal_force.mean())})


def other_numbers() -> Iterator[Callable[[], object]]:
    """Integers and NumPy scalars in place of floats in every argument."""
    system = SYSTEMS["chain on a belt"][0]()
    solve = st.GaussSeidel(np.float32(1e-6), np.int32(50))
    yield lambda: st.simulate(system, np.float32(0.1), step=np.float32(1e-4), sample_rate=10_000, contact_solve=solve)
    yield lambda: marched(oscillator(replace(AGING, initial_state=1)), 2e-4)
    yield lambda: marched(oscillator(replace(AGING, initial_state=np.float32(0.1), slip_distance=1, velocity=1)), 2e-4)
    slow = st.PointMass(1)
    held = [st.Spring(slow.centre, stiffness=1, direction="x")]
    contact = st.PointContact(slow.centre, st.RigidTrack(1), friction=st.Coulomb(1), at=0, gap=0)
    yield lambda: st.simulate(
        st.System(contact, [st.Force(slow.centre, y=-1)], held), 4, step=np.float64(0.5), sample_rate=2
    )


def main(words: str) -> None:
    made = [run() for run in islice(runs(), *SPANS[words])]
    functions = compiled_functions("stridula._kernels")
    if words == "other type":
        functions["contact.friction.set_valued"](np.int8(0))
    seen = {
        name: {
            "signatures": [str(signature) for signature in function.signatures],
            "compiled": sum(function.stats.cache_misses.values()),
            "loaded": sum(function.stats.cache_hits.values()),
        }
        for name, function in functions.items()
    }
    waited = [one.attrs["compile_time"] for one in made[:1] if not isinstance(one, list)]
    print(json.dumps({"functions": seen, "compile_times": waited}))


if __name__ == "__main__":
    main(" ".join(sys.argv[1:]))
