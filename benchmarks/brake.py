"""A brake of 2 x 60 points and some 400 modes against hand-written C of the same step (brake.c) and against real time.

Two pads with modes coupled by springs, on a turning disc, with friction at which the brake squeals: timed at the start,
when all points slide, and in squeal, when points lift off. Without gcc there is no ratio to C.
"""

from __future__ import annotations

import ctypes
import os
import sys
import tempfile
from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

import stridula as st
from against_c import Result, built, parameters, without_gcc
from ratios import Ratio, must_agree, over, peak_memory, seconds, show, sized
from space import IRON, LINING
from stridula._kernels.contacts import sweeps as kernel
from stridula._kernels.layout import columns as at
from stridula.integration.equilibrium_start import in_equilibrium
from stridula.integration.marches import March, imposed_on
from stridula.integration.start import state_at_start
from stridula.lowering import assemble
from stridula.lowering.blocks import blocks_of
from stridula.lowering.packing import aligned, scale_of
from systems import SCHEME, Case

TITLE = "a brake of two pads on a disc that turns"
SOURCE = Path(__file__).with_name("brake.c")
DIVISIONS = sized((3, 5, 1), (1, 2, 1))
# 0.2 of the shortest period of the bodies over pi; the default step is shorter, as it resolves pads on their linings.
STEP, RATIO = 5e-6, 10
# Steps before those that are timed, and their number.
BEFORE = {"sliding": 10, "squealing": sized(1000, 40)}
STEPS = {"sliding": sized(50, 20), "squealing": sized(200, 20)}
# Largest differences. In squeal the runs part at the first slip that turns round, for which C has another rule: there
# resultants and losses are compared.
TOLERANCE, CHAOTIC, BAR = 1e-6, 0.02, 1.6
LAST_FORCES = [at.LAST_NORMAL, at.LAST_TANGENTIAL, at.LAST_TANGENTIAL_B]
MATRICES = [at.KEPT, at.STIFFNESS, at.MOBILITY, at.LOSS]


def pad(side: float, disc: st.AxisymmetricBody) -> tuple[st.SurfaceContact, st.Force, list[st.Spring]]:
    """Return a pad above or below the disc, with the force that presses it and the springs that hold it."""
    mesh = st.SolidMesh.sector((0.085, 0.125), (-0.4, 0.4), 0.012, DIVISIONS, axis="y")
    mesh = mesh.moved((0.0, 0.01 * side, 0.0), (0.0, 0.0, 0.5 * np.pi * (1.0 - side)))
    name = "upper pad" if side > 0.0 else "lower pad"
    body = st.SolidBody(mesh, LINING, cutoff=12e3, damping=0.01, contact_faces=["bottom"], name=name)
    face = st.SurfaceContact(body, "bottom", disc, friction=st.Coulomb(0.45), stiffness=3e12, name=name)
    springs = [st.Spring(body.at(end), stiffness=2e7, direction=way) for end in ("start", "end") for way in "xz"]
    return face, st.Force(body.at("top"), y=-2000.0 * side), springs


def brake(turning: float = 20.0) -> st.System:
    """Return two pads pressed on a turning disc, in equilibrium at the start; on a slow disc they soon stick."""
    profile = st.RectangleProfile({"disc": ((0.06, 0.13), (-0.01, 0.01))})
    disc = st.AxisymmetricBody(profile, IRON, 17e3, "inner", damping=0.001, axis=(0.0, 1.0, 0.0), turning=turning)
    faces, loads, springs = zip(*(pad(side, disc) for side in (1.0, -1.0)), strict=True)
    return st.System(faces, [*loads, st.InitialEquilibrium()], [spring for own in springs for spring in own])


class Pair:
    """The brake some steps after its start, prepared for the march of the package and of C."""

    def __init__(self, system: st.System, before: int, steps: int) -> None:
        arrays = assemble(system, [])
        blocks = blocks_of(arrays, SCHEME, STEP)
        state = state_at_start(in_equilibrium(system, arrays), SCHEME, STEP, blocks, st.GaussSeidel())
        earlier = March([blocks], [state], STEP, RATIO)
        (chunk,) = earlier.advance([imposed_on(arrays, blocks.used, 0, before, STEP)], before // RATIO)
        if chunk.ended != at.FINISHED:
            sys.exit(f"the brake stopped in the {before} steps before those that are compared: code {chunk.ended}")
        (state,) = earlier.states
        # Recorded energies start from zero in both.
        state = replace(state, energies=np.zeros(at.ENERGIES))
        self.before, self.steps, self.arrays = before, steps, arrays
        self.case = Case(blocks, state, imposed_on(arrays, blocks.used, before, steps, STEP))
        self.march = March([blocks], [state], STEP, RATIO)

    def ours(self) -> Result:
        """March the package and return its results."""
        march = self.march.copy()
        (chunk,) = march.advance([self.case.imposed], self.steps // RATIO)
        (state,) = march.states
        forces = chunk.contacts[:, :, [at.NORMAL_FORCE, at.TANGENTIAL_FORCE, at.TANGENTIAL_FORCE_B]]
        return {
            "forces": forces.sum(axis=(0, 1)),
            "last forces": state.carried[:, LAST_FORCES],
            "positions": state.modal[at.Q],
            "ledgers": state.energies[[at.CONTACT_WORK, at.FRICTION_LOSS, at.DAMPING_LOSS]],
        }

    def steps_of_newton(self) -> float:
        """Return the mean number of steps of Newton's method in a step."""
        case = self.case
        (chunk,) = March([case.blocks], [case.state], STEP, 1).advance([case.imposed], self.steps)
        return float(chunk.energies[:, at.ITERATIONS].mean())

    def order(self) -> np.ndarray:
        """Return the modes in the order of C: pads, pairs of the disc in two rows, other modes of the disc."""
        coupled, (disc,) = self.case.blocks.modes.coupled, self.case.blocks.turning
        pairs = disc.pairs.T.ravel()
        others = np.setdiff1d(np.arange(coupled, self.arrays.mode_count), pairs)
        return np.concatenate([np.arange(coupled), pairs, others])

    def turns(self) -> np.ndarray:
        """Return the turns of the pairs in a step: one minus the cosines, and sines, of pairs, material and both."""
        (disc,), (angle,) = self.case.blocks.turning, self.case.imposed.angles[0]
        drag, order = disc.turns * angle
        between = order - drag
        return np.array([f(x) for x in (drag, order, between) for f in (lambda x: 2.0 * np.sin(0.5 * x) ** 2, np.sin)])

    def in_c(self) -> dict[str, np.ndarray]:
        """Return the arrays that C reads and writes."""
        modes, contacts, state = self.case.blocks.modes, self.case.blocks.contacts, deepcopy(self.case.state)
        scale, order, count = scale_of(modes), self.order(), len(contacts.codes)
        size, pad = 3 * count, modes.coupled // 2
        matrices = modes.matrices[MATRICES]
        own = np.array([matrices[:, here, here] for here in (slice(0, pad), slice(pad, None))])
        loads = self.case.imposed.signals[0, : len(modes.loads)] @ modes.loads
        q, d = (state.modal / scale)[:, order]
        motion = self.case.imposed.motion
        return {
            "kept": modes.block[at.B, order], "stiffness": modes.block[at.R, order], "load": (loads / scale)[order],
            "matrices": own, "turns": self.turns(),
            "rows": (contacts.rows * scale)[:, order], "w": contacts.compliance.T,
            "opening": contacts.constants[:, at.GAP], "yields": contacts.constants[:, at.YIELD_STIFFNESS],
            "reaches": contacts.constants[:, at.YIELD_REACH], "mu": contacts.laws[:, 0],
            "belts": (motion[1] - motion[0])[:, [at.TRACK_MOTION, at.TRACK_MOTION_B]],
            "q": q, "d": d, "carried": state.carried, "ledger": np.zeros(at.ENERGIES), "sums": np.zeros(7),
            "scratch": aligned(1, 10 * scale.size + 12 * size + size * size)[0],
        }  # fmt: skip

    def theirs(self, compiled: ctypes.CDLL) -> Result:
        """March C and return its results."""
        arrays = {name: np.ascontiguousarray(array).copy() for name, array in self.in_c().items()}
        modes, solve = self.case.blocks.modes, st.GaussSeidel()
        sizes = {
            "modes": self.arrays.mode_count, "pads": 2, "pad": modes.coupled // 2, "most_sweeps": solve.sweeps,
            "pairs": len(self.case.blocks.turning[0].pairs), "count": len(arrays["mu"]),
        }  # fmt: skip
        given = {
            "first_step": ctypes.c_long(self.before),
            "steps": ctypes.c_long(self.steps),
            "tolerance": ctypes.c_double(solve.tolerance),
            **{name: ctypes.c_int(size) for name, size in sizes.items()},
            **{name: array.ctypes.data_as(ctypes.c_void_p) for name, array in arrays.items()},
        }
        compiled.march(*(given[name] for name in parameters(SOURCE)))
        positions = np.empty(self.arrays.mode_count)
        positions[self.order()] = arrays["q"]
        return {
            "forces": arrays["sums"][1:4] / RATIO,
            "last forces": arrays["carried"][:, LAST_FORCES],
            "positions": positions * scale_of(modes),
            "ledgers": arrays["ledger"][[at.CONTACT_WORK, at.FRICTION_LOSS, at.DAMPING_LOSS]],
        }


QUANTITIES = ("forces", "last forces", "positions", "ledgers")


def agree(
    found: Result, expected: Result, quantities: Sequence[str] = QUANTITIES, tolerance: float = TOLERANCE
) -> None:
    """Exit if results of the two marches differ."""
    for quantity in quantities:
        must_agree(f"{quantity} of the march and of brake.c", found[quantity], expected[quantity], tolerance)


AGREE = {"sliding": agree, "squealing": partial(agree, quantities=("forces", "ledgers"), tolerance=CHAOTIC)}


def rows() -> Iterator[Ratio | str]:
    """Yield memory, then speed, steps of Newton's method and the ratio to C, sliding and squealing."""
    if not hasattr(os, "wait4"):
        yield "memory: skipped, this system does not report the memory of a process"
    else:
        yield Ratio("peak memory of a fresh process, from meshes to record, over 1 GB", [peak()])
    system = brake()
    for regime, before in BEFORE.items():
        yield from ratios(regime, Pair(system, before, STEPS[regime]))


def ratios(regime: str, pair: Pair) -> Iterator[Ratio | str]:
    """Yield the results of the marches of a pair."""
    words = f"{len(pair.arrays.contacts)} points, {pair.arrays.mode_count} modes, {regime}"
    if missing := without_gcc():
        (ours,) = seconds(pair.ours)
    else:
        with tempfile.TemporaryDirectory() as folder:
            compiled = built(Path(folder), SOURCE, vars(kernel))
            theirs, ours = seconds(lambda: pair.theirs(compiled), pair.ours, agree=AGREE[regime])
    yield Ratio(f"{words}: simulated time over wall time of the march", over([pair.steps * STEP] * len(ours), ours))
    yield Ratio(f"{words}: steps of Newton's method per step", [pair.steps_of_newton()])
    yield missing or Ratio(f"{words}: time of a step over that of hand-written C", over(ours, theirs), most=BAR)


def peak() -> float:
    """Return the peak memory of a fresh process that marches the brake [GB]."""
    return peak_memory(__file__) / 1e9


if __name__ == "__main__":
    if "child" in sys.argv:
        st.simulate(brake(), STEPS["squealing"] * STEP, probes=[], surface_rate="all")
    else:
        show(TITLE, rows())
