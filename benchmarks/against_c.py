"""The march against hand-written C of the same step (step.c): ratio of the times per step.

One contact on a beam, Coulomb's law, ledger and one probe, for some 30, 100 and 400 modes, separated, sticking and
sliding. Needs gcc; skipped without. C reads and writes by name: places in arrays are those of the package's layout, and
arguments those of `march` in step.c.
"""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from copy import deepcopy
from itertools import count
from pathlib import Path
from types import MappingProxyType

import numpy as np

import stridula as st
from ratios import WARM_UP, Ratio, must_agree, show, sized
from stridula._kernels.layout import columns as at
from stridula.integration.marches import Excitation, March
from stridula.integration.start import state_at_start
from stridula.lowering import assemble
from stridula.lowering.blocks import blocks_of
from stridula.lowering.packing import aligned
from systems import REGIMES, SCHEME, SIZES, beams

TITLE = "time of a step over that of hand-written C"
SOURCE = Path(__file__).with_name("step.c")
FLAGS = ("-O3", "-march=native", "-ffast-math", "-fPIC")
REPEATS = sized(7, 1)
STEPS = sized(40_000, 4_000)
RATIO = 10
LEDGER = [at.DRIVE_WORK, at.CONTACT_WORK, at.FRICTION_LOSS, at.CONVECTION_WORK, at.DAMPING_LOSS]
FORCES, STATES = [at.NORMAL_FORCE, at.TANGENTIAL_FORCE], [at.SEPARATED, at.STICKING, at.SLIDING]
TOLERANCE = 1e-6
BAR = 1.25
MODES = sized((30, 100, 400), (30,))
Result = dict[str, np.ndarray]


class Pair:
    """A system prepared for the march of the package and of C."""

    def __init__(self, given: st.System, compiled: ctypes.CDLL) -> None:
        probe = st.Acceleration(given.track.centre, "y")
        self.arrays = assemble(given, (probe,))
        self.step = 0.2 * SCHEME.limit(self.arrays.angular_frequency, self.arrays.damping_rate)
        self.blocks = blocks_of(self.arrays, SCHEME, self.step)
        self.state = state_at_start(self.arrays, SCHEME, self.step, self.blocks, st.GaussSeidel())
        self.compiled = compiled

    def ours(self) -> tuple[Callable[[], None], Callable[[], Result]]:
        """Return the march of the package, and a function that returns its results."""
        march = March([self.blocks], [deepcopy(self.state)], self.step, RATIO)
        imposed = Excitation(np.array([[1.0, 0.0, 0.0, 0.0]]), np.zeros((1, 1, at.MOTIONS)), np.zeros((1, 0)))
        chunks = []

        def run() -> None:
            chunks.extend(march.advance([imposed], STEPS // RATIO))

        def found() -> Result:
            (state,) = march.states
            return result(state.modal[at.Q], state.energies, chunks[-1].contacts[:, 0].sum(axis=0) * RATIO)

        return run, found

    def theirs(self) -> tuple[Callable[[], None], Callable[[], Result]]:
        """Return the march of C, and a function that returns its results."""
        block, one, state = self.blocks.modes.block, self.arrays.contacts[0], self.state
        slider, (bending, axial), (_, end) = one.bending[0], one.bending, one.axial
        w = self.blocks.contacts.compliance
        rows = apart({
            "b": block[at.B], "r": block[at.R], "l": block[at.LOAD], "half_l": block[at.HALF_OVER_LOAD],
            "loss": block[at.HALF_LOSS] * block[at.HALF_OVER_LOAD], "tip_x": one.fixed[1], "tip_y": one.fixed[0],
            "load": self.blocks.modes.loads[0], "probe": self.blocks.probes.rows[0, bending:axial],
            "q": state.modal[at.Q], "d": state.modal[at.D], "dn": np.zeros(end), "s": np.zeros(end), "c": np.zeros(end),
        })  # fmt: skip
        arrays = rows | {
            "constants": self.blocks.contacts.constants[0],
            "carried": state.carried[0].copy(),
            "energies": np.zeros(at.ENERGIES),
            "columns": np.zeros(at.COLUMNS),
            "raw": np.empty(STEPS),
        }
        numbers = {
            "mu": one.contact.friction.coefficient,
            "amplitude": one.contact.track.amplitude,
            "fixed_nn": w[at.NORMAL, at.NORMAL],
            "w_nt": w[at.NORMAL, at.TANGENTIAL],
            "fixed_tt": w[at.TANGENTIAL, at.TANGENTIAL],
        }
        sizes = {"slider": slider, "bending": axial - bending, "axial": end - axial}
        given = {
            "steps": ctypes.c_long(STEPS),
            **{name: ctypes.c_int(size) for name, size in sizes.items()},
            **{name: ctypes.c_double(number) for name, number in numbers.items()},
            **{name: array.ctypes.data_as(ctypes.c_void_p) for name, array in arrays.items()},
        }
        names = parameters()
        if sorted(names) != sorted(given):
            raise SystemExit(f"march of step.c must take {', '.join(given)}, takes {', '.join(names)}")
        arguments = [given[name] for name in names]

        def run() -> None:
            self.compiled.march(*arguments)

        return run, lambda: result(arrays["q"][:end], arrays["energies"], arrays["columns"])

    def agree(self, found: Result, expected: Result) -> None:
        """Exit if the results of the two marches differ."""
        for quantity, values in found.items():
            # Where a force only grazes the border of its cone, rounding affects the share of that step.
            tolerance = 4.0 / STEPS if quantity == "steps in each state" else TOLERANCE
            must_agree(f"{quantity} of the march and of step.c", values, expected[quantity], tolerance)


def result(positions: np.ndarray, energies: np.ndarray, columns: np.ndarray) -> Result:
    """Return the results that must agree; columns are sums over the steps."""
    return {
        "positions": positions,
        "ledgers": energies[LEDGER],
        "forces": columns[FORCES],
        "steps in each state": columns[STATES],
    }


def parameters(source: Path = SOURCE) -> list[str]:
    """Return the names of the arguments of the march in C, in order."""
    words = re.search(r"^void march\(([^)]*)\)", source.read_text(encoding="utf-8"), re.MULTILINE)
    return re.findall(r"(\w+)(?:,|$)", words[1])


def without_gcc() -> str:
    """Return the reason why there is no C to compare with, empty if there is."""
    return "" if shutil.which("gcc") else "skipped: gcc is not installed, so there is no C to compare with"


def built(folder: Path, source: Path = SOURCE, numbers: Mapping[str, object] = MappingProxyType({})) -> ctypes.CDLL:
    """Return a march in C, compiled with the places of the package's layout and other integers of the package."""
    known = {**vars(at), **numbers}
    places = {name: place for name, place in known.items() if name.isupper() and isinstance(place, int)}
    lines = [f"enum {{ {name} = {place} }};" for name, place in places.items()]
    (folder / "layout.h").write_text("\n".join(lines), encoding="utf-8")
    compiled, target = folder / "step.o", folder / "step.so"
    subprocess.run(["gcc", *FLAGS, "-I", folder, "-c", "-o", compiled, source], check=True)
    # Linked without -ffast-math, which would set numbers below the smallest normal one to zero in the whole process.
    subprocess.run(["gcc", "-shared", "-o", target, compiled, "-lm"], check=True)
    return ctypes.CDLL(str(target))


def apart(rows: Result) -> Result:
    """Return rows laid out so that no load aliases the store of another row: a page apart would slow C down much."""
    width = max(row.size for row in rows.values())
    length = next(n for n in count(width) if n % 8 == 0 and all(off_page(n * k) >= 256 for k in range(1, len(rows))))
    out = aligned(len(rows), length)
    for place, row in zip(out, rows.values(), strict=True):
        place[: row.size] = row
    return dict(zip(rows, out, strict=True))


def off_page(numbers: int) -> int:
    """Return the distance in bytes between two places, modulo pages of 4096 bytes."""
    return min(8 * numbers % 4096, -8 * numbers % 4096)


def ratios(pair: Pair) -> tuple[list[float], np.ndarray]:
    """Return the ratios of the repeats and the steps in each state; exit if the results of the two marches differ."""
    taken = []
    for repeat in range(WARM_UP + REPEATS):
        (ours, found), (theirs, expected) = pair.ours(), pair.theirs()
        times = []
        for march_on in (ours, theirs):
            began = time.perf_counter()
            march_on()
            times.append(time.perf_counter() - began)
        if repeat >= WARM_UP:
            taken.append(times[0] / times[1])
    pair.agree(found(), expected())
    return taken, found()["steps in each state"]


def rows() -> Iterator[Ratio | str]:
    """Compile the C step, march both and yield the ratios."""
    if missing := without_gcc():
        yield missing
        return
    with tempfile.TemporaryDirectory() as folder:
        compiled = built(Path(folder))
        for modes in MODES:
            for regime in REGIMES:
                pair = Pair(beams(SIZES[modes], regime), compiled)
                taken, states = ratios(pair)
                if not states[REGIMES.index(regime)] > 0.9 * STEPS:
                    raise SystemExit(f"{regime} must last, got {states} steps separated, sticking, sliding")
                yield Ratio(f"{pair.arrays.mode_count} modes, {regime}", taken, most=BAR)


if __name__ == "__main__":
    show(TITLE, rows())
