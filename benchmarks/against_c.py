"""The march against hand-written C of the same step (step.c): time per step as a ratio to C's.

One contact on a beam, Coulomb's law, ledger and one probe, for some 30, 100 and 400 modes, separated, sticking and
sliding. Needs gcc; skipped without.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator
from copy import deepcopy
from itertools import count
from pathlib import Path

import numpy as np

import stridula as st
from ratios import Ratio, show
from stridula._kernels import layout as at
from stridula.assembly import assemble
from stridula.integration.blocks import blocks_of
from stridula.integration.marches import Imposed, SimpleMarch
from stridula.integration.packing import aligned
from stridula.integration.start import state_at_start
from systems import REGIMES, SCHEME, SIZES, beams

TITLE = "time of a step over that of hand-written C"
SOURCE = Path(__file__).with_name("step.c")
FLAGS = ("-O3", "-march=native", "-ffast-math", "-shared", "-fPIC")
REPEATS = 7
STEPS = 40_000
RATIO = 10
LEDGER = [at.DRIVE_WORK, at.CONTACT_WORK, at.FRICTION_LOSS, at.CONVECTION_WORK, at.DAMPING_LOSS]
BAR = 1.25
MODES = (30, 100, 400)


class Pair:
    """One system, ready to be marched by the package and by C."""

    def __init__(self, given: st.System, compiled: ctypes.CDLL) -> None:
        probe = st.Acceleration(given.track.centre, "y")
        self.arrays = assemble(given, (probe,))
        self.step = 0.2 * SCHEME.limit(self.arrays.angular_frequency, self.arrays.damping)
        self.blocks = blocks_of(self.arrays, SCHEME, self.step)
        self.state = state_at_start(self.arrays, SCHEME, self.step, self.blocks, st.GaussSeidel())
        self.compiled = compiled

    def ours(self) -> tuple[Callable[[], None], Callable[[], np.ndarray]]:
        """Return what marches by the package, and what it gives: positions, ledger, steps in each state."""
        march = SimpleMarch([self.blocks], [deepcopy(self.state)], self.step, RATIO)
        imposed = Imposed(np.array([[1.0, 0.0, 0.0, 0.0]]), np.zeros((1, 1, at.MOTIONS)))
        chunks = []

        def run() -> None:
            chunks.extend(march.advance([imposed], STEPS // RATIO))

        def result() -> np.ndarray:
            (state,) = march.states
            states = chunks[-1].contacts[:, 0, at.SEPARATED : at.SLIDING + 1].sum(axis=0) * RATIO
            return np.concatenate([state.modal[0], state.energies[LEDGER], states])

        return run, result

    def theirs(self) -> tuple[Callable[[], None], Callable[[], np.ndarray]]:
        """Return what marches by C, and what it gives."""
        block, one, state = self.blocks.modes.block, self.arrays.contacts[0], self.state
        slider, (bending, axial), (_, end) = one.bending[0], one.bending, one.axial
        constants, w = self.blocks.contacts.constants[0], self.blocks.contacts.compliance
        carried = state.carried[0, [at.MATERIAL, at.ANCHOR, at.STATUS, at.ABSCISSA, at.ABSCISSA_BEFORE]].copy()
        numbers = np.array(
            [*constants[: at.AMPLITUDE + 1], one.contact.friction.coefficient, w[0, 0], w[0, 1], w[1, 1]]
        )
        loss = block[at.HALF_LOSS] * block[at.HALF_OVER_LOAD]
        rows = apart([block[at.B], block[at.R], block[at.LOAD], block[at.HALF_OVER_LOAD], loss, one.fixed[1], one.fixed[0],
                      self.blocks.modes.loads[0], self.blocks.probes.row[0, bending:axial], *state.modal,
                      *np.zeros((3, end))])  # fmt: skip
        sums, raw = np.zeros(10), np.empty(STEPS)
        given = [*rows[:9], numbers, *rows[9:], carried, sums, raw]
        pointers = [array.ctypes.data_as(ctypes.c_void_p) for array in given]
        sizes = [ctypes.c_int(number) for number in (slider, axial - bending, end - axial)]

        def run() -> None:
            self.compiled.march(ctypes.c_long(STEPS), *sizes, *pointers)

        def result() -> np.ndarray:
            return np.concatenate([rows[9][:end], sums[:5], sums[7:10]])

        return run, result


def apart(rows: list[np.ndarray]) -> np.ndarray:
    """Return rows laid out so that no load of one looks like the store of another: a page apart would cost C dearly."""
    width = max(row.size for row in rows)
    length = next(n for n in count(width) if n % 8 == 0 and all(off_page(n * k) >= 256 for k in range(1, len(rows))))
    out = aligned(len(rows), length)
    for place, row in zip(out, rows, strict=True):
        place[: row.size] = row
    return out


def off_page(numbers: int) -> int:
    """Return the distance in bytes between two places, whole pages of 4096 bytes left out."""
    return min(8 * numbers % 4096, -8 * numbers % 4096)


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
    worst = np.abs(found - expected)[:-3].max() / np.abs(expected[:-3]).max()
    if not worst < 1e-6:
        raise SystemExit(f"the two marches must agree, differ by {worst:.1e}")
    return taken, found[-3:]


def rows() -> Iterator[Ratio | str]:
    """Compile the C step, march both and yield the ratios."""
    if shutil.which("gcc") is None:
        yield "skipped: gcc is not installed, so there is no C to compare with"
        return
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "step.so"
        subprocess.run(["gcc", *FLAGS, "-o", target, SOURCE, "-lm"], check=True)
        compiled = ctypes.CDLL(str(target))
        for modes in MODES:
            for regime in REGIMES:
                pair = Pair(beams(SIZES[modes], regime), compiled)
                taken, states = ratios(pair)
                if not states[REGIMES.index(regime)] > 0.9 * STEPS:
                    raise SystemExit(f"{regime} must last, got {states} steps separated, sticking, sliding")
                yield Ratio(f"{pair.arrays.mode_count} modes, {regime}", taken, most=BAR)


if __name__ == "__main__":
    show(TITLE, rows())
