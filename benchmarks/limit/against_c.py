"""The march against hand-written C of the same step (step.c), in one run: time per step as a ratio to C's.

One contact on a beam, Coulomb's law, ledger and one probe, for some 30, 100 and 400 modes, separated, sticking and
sliding. Needs gcc; skipped without. Prints minimum, median and maximum over the repeats; 1.25 is the bar.
"""

from __future__ import annotations

import ctypes
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from math import radians
from pathlib import Path

import numpy as np

import stridula as st
from stridula._kernels import layout as at
from stridula._kernels.march import march
from stridula.assembly import assemble
from stridula.integration.blocks import contact_blocks, probe_blocks, recurrence
from stridula.integration.start import at_start

SOURCE = Path(__file__).with_name("step.c")
FLAGS = ("-O3", "-march=native", "-ffast-math", "-shared", "-fPIC")
REPEATS = 7
STEPS = 40_000
BAR = 1.25
# Elements of the slider, bending and axial modes of the track.
SIZES = ((4, 10, 6), (19, 25, 17), (80, 100, 60))
SCHEME = st.ExactModal()
STEEL, STRIP = st.Material(2.1e11, 7800.0), st.Rectangle(0.020, 0.008)


def system(size: tuple[int, int, int], regime: str) -> st.System:
    """Return a slider on a track that stays in a regime."""
    elements, bending, axial = size
    rod = st.FiniteElementBeam(STEEL, STRIP, 0.5, radians(20.0), elements=elements, damping=0.2)
    track = st.ModalBeam(STEEL, STRIP, 1.3, bending_modes=bending, axial_modes=axial, damping=0.2)
    choices = {"separated": (0.5, 0.5, 0.0), "sticking": (3.0, 0.0, 0.1), "sliding": (0.1, 0.0, 0.3)}
    friction, gap, push = choices[regime]
    contact = st.PointContact(rod.tip, track, at=0.3, friction=st.Coulomb(friction), gap=gap)
    return st.System(contact, [st.Force(rod.root, y=-1.0, x=push)])


class Pair:
    """One system, ready to be marched by the package and by C."""

    def __init__(self, given: st.System, compiled: ctypes.CDLL) -> None:
        probe = st.Acceleration(given.track.centre, "y")
        self.arrays = assemble(given, (probe,))
        limit = SCHEME.limit(self.arrays.angular_frequency, self.arrays.damping)
        self.step = 0.2 * limit
        self.modes = recurrence(self.arrays, SCHEME, self.step)
        self.contacts = contact_blocks(self.arrays, self.modes)
        self.probes = probe_blocks(self.arrays, self.step)
        self.given, self.compiled = given, compiled

    def start(self) -> tuple[np.ndarray, np.ndarray]:
        """Return modes and contact at the start."""
        return at_start(self.arrays, SCHEME, self.step, self.modes, self.contacts, st.GaussSeidel())

    def ours(self) -> tuple[Callable[[], None], Callable[[], np.ndarray]]:
        """Return what marches by the package, and what it gives: positions, shares of the states, ledger."""
        state, carried = self.start()
        energies, times = np.zeros(at.ENERGIES), np.zeros((STEPS, 4))
        times[:, 0] = 1.0
        record, kept = np.empty((STEPS // 10, 1, at.COLUMNS)), np.empty((STEPS // 10, at.ENERGIES))
        raw, motion = np.empty((STEPS, 1)), np.zeros((STEPS + 2, 1, at.MOTIONS))

        def run() -> None:
            march(10, self.step, 1e-10, 10, self.modes.block, self.modes.matrices, self.contacts.constants,
                  self.contacts.laws, self.contacts.spans, self.contacts.rows, self.contacts.compliance, state, carried,
                  energies, self.modes.loads, times, motion, *self.probes, kept, record, raw)  # fmt: skip

        def result() -> np.ndarray:
            ledger = energies[[at.DRIVE_WORK, at.CONTACT_WORK, at.FRICTION_LOSS, at.CONVECTION_WORK, at.DAMPING_LOSS]]
            states = record[:, 0, at.SEPARATED : at.SLIDING + 1].sum(axis=0) * 10
            return np.concatenate([state[at.Q], ledger, states])

        return run, result

    def theirs(self) -> tuple[Callable[[], None], Callable[[], np.ndarray]]:
        """Return what marches by C, and what it gives."""
        state, carried = self.start()
        block, one = self.modes.block, self.arrays.contacts[0]
        slider, (bending, axial), (_, end) = one.bending[0], one.bending, one.axial
        q, d = state[at.Q].copy(), state[at.D].copy()
        c_carried = carried[0, [at.MATERIAL, at.ANCHOR, at.STATUS, at.ABSCISSA, at.ABSCISSA_BEFORE]].copy()
        w = self.contacts.compliance
        constants = np.array([*self.contacts.constants[0, : at.AMPLITUDE + 1], one.contact.friction.coefficient,
                              w[0, 0], w[0, 1], w[1, 1]])  # fmt: skip
        probe = np.ascontiguousarray(self.probes[0][0, at.ACCELERATION, bending:axial])
        fixed = np.ascontiguousarray(one.fixed[::-1, :slider])
        loss = block[at.HALF_LOSS] * block[at.HALF_OVER_CH]
        scratch = [np.zeros(q.size), np.zeros(2 * q.size), np.zeros(2 * q.size)]
        sums, raw = np.zeros(10), np.empty(STEPS)
        given = [block[at.B], block[at.R], block[at.CH], block[at.HALF_OVER_CH], loss, fixed[0], fixed[1],
                 self.modes.loads[0], probe, constants, q, d, *scratch, c_carried, sums, raw]  # fmt: skip
        pointers = [array.ctypes.data_as(ctypes.c_void_p) for array in given]
        sizes = [ctypes.c_int(number) for number in (slider, axial - bending, end - axial)]

        def run() -> None:
            self.compiled.march(ctypes.c_long(STEPS), *sizes, *pointers)

        def result() -> np.ndarray:
            return np.concatenate([q, sums[:5], sums[7:10]])

        return run, result


def ratios(pair: Pair) -> tuple[list[float], np.ndarray]:
    """Return the ratios of the repeats and the steps in each state."""
    taken = []
    for repeat in range(REPEATS + 1):
        (ours, result), (theirs, reference) = pair.ours(), pair.theirs()
        times = []
        for march_on in (ours, theirs):
            began = time.perf_counter()
            march_on()
            times.append(time.perf_counter() - began)
        # The first one compiles.
        if repeat:
            taken.append(times[0] / times[1])
    found, expected = result(), reference()
    worst = np.abs(found - expected).max() / np.abs(expected[:-3]).max()
    if not worst < 1e-6:
        raise SystemExit(f"the two marches must agree, differ by {worst:.1e}")
    return taken, found[-3:]


def main() -> None:
    """Compile the C step, march both and print the ratios."""
    if shutil.which("gcc") is None:
        print("SKIPPED: gcc is not installed, so there is no C to compare with")
        return
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "step.so"
        subprocess.run(["gcc", *FLAGS, "-o", target, SOURCE, "-lm"], check=True)
        compiled = ctypes.CDLL(str(target))
        print(f"time per step over C's (bar {BAR})      min   median  max")
        for size in SIZES:
            for regime in ("separated", "sticking", "sliding"):
                pair = Pair(system(size, regime), compiled)
                taken, states = ratios(pair)
                if not states[("separated", "sticking", "sliding").index(regime)] > 0.9 * STEPS:
                    raise SystemExit(f"{regime} must last, got {states} steps separated, sticking, sliding")
                numbers = f"{min(taken):.2f}  {statistics.median(taken):.2f}    {max(taken):.2f}"
                print(f"{pair.arrays.mode_count:4d} modes, {regime:<10}                {numbers}")


if __name__ == "__main__":
    sys.exit(main())
