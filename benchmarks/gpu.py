"""Many one-second runs of the squeal case on a GPU: runs per second, against the processor and the card's peak.

    python benchmarks/gpu.py              measure; without a GPU, print one line to that effect
    python benchmarks/gpu.py --dry-run    compile for compute capability 9.0 without a GPU: registers, local memory
    python benchmarks/gpu.py --map 1000   also a map of 1000 x 1000 runs, friction by angle
    python benchmarks/gpu.py --short      a few short runs against the processor, also on numba's simulator

Operations of a step, products and sums counted separately, from `_kernels.mode_rows`. A fixed mode takes 25: its push
3, its step 7, work 2 and loss 4, the next position 5, and 2 for each of its two sums. A harmonic takes 28: its row 1,
push 2, step 7, work 2 and loss 4, slope 3, trace 7, softness 2; and 6 for a sine and a cosine, which bending and axial
harmonics share. About 150 operations done once in each step are left out.

It moves 9 doubles for a fixed mode, 12 for a harmonic and 4 for a sine and cosine: a third of an operation a byte. The
memory of the card, not its arithmetic, is expected to limit one run per thread, at a few per cent of the peak in double
precision.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from importlib.util import find_spec
from itertools import islice
from math import radians
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

import stridula as st
from ratios import REPEATS, SHORT, Ratio, arguments, must_agree, show, sized
from stridula._kernels.lanes.vectors import LANES
from stridula._kernels.layout.parts import Imposed as ImposedOnRuns
from stridula._kernels.layout.parts import Parts, Records
from stridula.extras import how_to_install
from stridula.integration.cuda_march import CudaMarch, require_cuda
from stridula.integration.marches import Excitation, March, imposed_on
from stridula.integration.start import state_at_start
from stridula.lowering import assemble
from stridula.lowering.blocks import Blocks, blocks_of
from stridula.records.state import State
from systems import FORCES, TOLERANCE, Case, pad, squeal

TITLE = "runs per second on a GPU over those on all cores"
DURATION, SAMPLE_RATE = sized((1.0, 100.0), (1e-3, 1e4))
CHUNK = 10
# Number of samples over which runs on a card and on the processor agree.
SAMPLES_ALIKE = 2
RATIO_RUNS = sized((1_000, 10_000), (3,))
SIZES = (1_000, 3_000, 10_000, 30_000, 100_000)
THREADS = (32, 64, 128, 256)
RUNS_OF_THE_PROCESSOR = 4 * LANES
# Runs of a map on the card at a time.
RUNS_AT_A_TIME = 100_000
# Units of double precision in a multiprocessor, by compute capability (CUDA programming guide, arithmetic throughput).
UNITS = {(6, 0): 32, (7, 0): 32, (8, 0): 32, (9, 0): 64, (10, 0): 64, (6, 1): 4, (7, 5): 2, (8, 6): 2, (8, 9): 2}
REGISTERS, WARP, MOST_WARPS = 65_536, 32, 64
# Compute capability for which a dry run compiles, and its time step [s].
DRY, STEP = (9, 0), 1e-6


@dataclass(frozen=True)
class Timing:
    """Time step, steps in a sample and samples of a run.

    Attributes
    ----------
    step : float
        Time step [s].
    ratio, samples : int
        Steps in a sample, and samples of a run.
    """

    step: float
    ratio: int
    samples: int


def timing() -> Timing:
    """Return the default timing of the package."""
    chosen = st.simulate(squeal(radians(45.0), 1.5), 2.0 / SAMPLE_RATE, sample_rate=SAMPLE_RATE, probes=[]).attrs
    return Timing(chosen["step"], chosen["steps_per_sample"], round(DURATION * SAMPLE_RATE))


def cases(frictions: Iterable[float], angles: Iterable[float], step: float) -> Iterator[Case]:
    """Yield every friction at every angle; the start is separated and does not depend on friction."""
    scheme, frictions = st.ExactModal(), list(frictions)
    for angle in angles:
        arrays = assemble(squeal(angle, 1.0), [])
        blocks = blocks_of(arrays, scheme, step)
        state = state_at_start(arrays, scheme, step, blocks, st.GaussSeidel())
        whole = imposed_on(arrays, blocks.used, 0, 1, step)
        imposed = Excitation(whole.signals[:1], whole.motion[:1], whole.angles[:1])
        for friction in frictions:
            laws = blocks.contacts.laws.copy()
            laws[0, 0] = friction
            yield Case(replace(blocks, contacts=replace(blocks.contacts, laws=laws)), state, imposed)


def grid(runs: int, step: float) -> Iterator[Case]:
    """Yield `runs` runs and a few more, friction by angle."""
    side = int(np.ceil(np.sqrt(runs)))
    return cases(np.linspace(0.2, 2.0, side), np.radians(np.linspace(20.0, 70.0, side)), step)


def first(runs: int, step: float) -> list[Case]:
    """Return `runs` runs."""
    return list(islice(grid(runs, step), runs))


def batched(some: Iterable[Case], size: int) -> Iterator[list[Case]]:
    """Yield runs, `size` at a time."""
    rest = iter(some)
    while group := list(islice(rest, size)):
        yield group


def march_of(kind, some, at: Timing):
    """Return the march of some runs."""
    return kind([one.blocks for one in some], [one.state for one in some], at.step, at.ratio)


def go(march, some, samples: int) -> float:
    """March through some samples and return the wall time [s]."""
    imposed, began = [one.imposed for one in some], time.perf_counter()
    for done in range(0, samples, CHUNK):
        march.advance(imposed, min(CHUNK, samples - done))
    return time.perf_counter() - began


def agree(some: list[Case], at: Timing) -> None:
    """Exit if runs on the card and on the processor differ before chaos separates them."""
    few, sides = some[:LANES], []
    for kind in (CudaMarch, March):
        march = march_of(kind, few, at)
        chunks = march.advance([one.imposed for one in few], SAMPLES_ALIKE)
        sides.append(([state.modal for state in march.states], [chunk.contacts[..., FORCES] for chunk in chunks]))
    for quantity, here, there in zip(("motion", "forces"), *sides, strict=True):
        must_agree(f"{quantity} on the card and on the processor", here, there, TOLERANCE)


def on_the_processor(at: Timing) -> float:
    """Return one-second runs per second on all cores, eight side by side on each."""
    cores = os.cpu_count() or 1
    groups = list(batched(first(RUNS_OF_THE_PROCESSOR * cores, at.step), LANES))
    marches = [march_of(March, group, at) for group in groups]
    go(march_of(March, groups[0], at), groups[0], 1)
    began = time.perf_counter()
    with ThreadPoolExecutor(cores) as pool:
        list(pool.map(go, marches, groups, [at.samples] * len(groups)))
    return len(groups) * LANES / (time.perf_counter() - began)


def operations(blocks: Blocks) -> int:
    """Return the operations of a step, as counted above."""
    modes, path = blocks.contacts.rows.shape[1], blocks.contacts.paths[0]
    bending, axial = (0, 0) if path is None else (one.stop - one.start for one in (path.normal, path.tangential))
    return 25 * (modes - bending - axial) + 28 * (bending + axial) + 6 * max(bending, axial)


def peak(device) -> float:
    """Return the operations per second of a card in double precision, NaN for an unknown card."""
    units = UNITS.get(tuple(device.compute_capability), np.nan)
    return 2.0 * units * device.MULTIPROCESSOR_COUNT * 1e3 * device.CLOCK_RATE


def occupancy(registers: int, threads: int) -> float:
    """Return the share of the warps of a multiprocessor for which its registers suffice."""
    warps = threads // WARP
    per_warp = -(-registers * WARP // 256) * 256
    return REGISTERS // (per_warp * warps) * warps / MOST_WARPS


def rows() -> Iterator[Ratio | str]:
    """Yield the ratio to the processor, or the reason why there is none."""
    try:
        require_cuda()
    except RuntimeError as error:
        yield f"skipped: {error}"
        return
    at = timing()
    for runs in RATIO_RUNS:
        some = first(runs, at.step)
        agree(some, at)
        march = march_of(CudaMarch, some, at)
        go(march.copy(), some, 1)
        values = [runs / go(march.copy(), some, at.samples) / on_the_processor(at) for _ in range(REPEATS)]
        yield Ratio(f"{runs} squeals of {DURATION:g} s", values)


def measure(at: Timing) -> None:
    """Print runs per second over the number of runs and the threads in a block."""
    from numba import cuda

    device = cuda.get_current_device()
    name = device.name.decode() if isinstance(device.name, bytes) else device.name
    print(
        f"{name}, {device.MULTIPROCESSOR_COUNT} multiprocessors, {peak(device) / 1e12:.3g} Tflop/s in double precision"
    )
    processor = on_the_processor(at)
    print(f"processor, {os.cpu_count()} cores, {LANES} runs side by side: {processor:.4g} runs/s")
    print(f"{DURATION:g} s a run, {at.step * 1e6:.4g} us a step")
    print(
        f"{'runs':>8}{'threads':>9}{'pack s':>9}{'march s':>9}{'runs/s':>9}{'ratio':>8}{'of peak':>9}{'occupied':>10}"
    )
    for runs in SIZES:
        some = first(runs, at.step)
        began = time.perf_counter()
        try:
            march = march_of(CudaMarch, some, at)
        except cuda.cudadrv.driver.CudaAPIError as error:
            print(f"{runs:>8}  {error}")
            break
        packed = time.perf_counter() - began
        go(march.copy(), some, 1)
        kernel = marches_on_card()[march.kind]
        (registers,) = kernel.get_regs_per_thread().values()
        for threads in THREADS:
            trial = march.copy()
            trial.threads_per_block = threads
            seconds = go(trial, some, at.samples)
            rate = runs / seconds
            share = rate * operations(some[0].blocks) * at.ratio * at.samples / peak(device)
            print(
                f"{runs:>8}{threads:>9}{packed:>9.2f}{seconds:>9.2f}{rate:>9.4g}{rate / processor:>8.3g}"
                f"{share:>9.2%}{occupancy(registers, threads):>10.1%}"
            )
    print(f"{registers} registers a thread, local memory {kernel.get_local_mem_per_thread()}")


def map_of(side: int, at: Timing) -> None:
    """March a map of friction by angle and print its time, including the work of the processor."""
    began, marched = time.perf_counter(), 0.0
    for some in batched(grid(side * side, at.step), RUNS_AT_A_TIME):
        marched += go(march_of(CudaMarch, some, at), some, at.samples)
    whole = time.perf_counter() - began
    print(f"map of {side * side} runs of {DURATION:g} s: {whole:.4g} s, {marched:.4g} s of them on the card")


class DryMarch(CudaMarch):
    """A march that compiles the kernel for a card that is not present, and does not march."""

    def __init__(self, blocks: list[Blocks], states: list[State], step: float, ratio: int) -> None:
        March.__init__(self, blocks, states, step, ratio)
        parts = self.modes, self.paths, self.contacts, self.turning, self.springs, self.heating, self.carried
        self.there = [*parts, self.probes]

    def _moved(self, part: Any) -> Any:
        return part

    def _march(self, imposed: ImposedOnRuns, records: Records) -> None:
        from numba import cuda, typeof, types

        *fixed, carried, probes = self.there
        parts = Parts(self.layout.sizes, self.timing, *fixed, carried, imposed, probes, records)
        kernel = marches_on_card()[self.kind].py_func
        self.ptx, _ = cuda.compile_ptx(kernel, types.void(types.int64, typeof(parts)), cc=DRY)


def marches_on_card() -> dict[tuple[bool | None, ...], Any]:
    """Return the kernels of the card, by kind of systems."""
    from stridula._kernels.cuda import marches

    return marches


def prepared(system: st.System, step: float) -> Case:
    """Return a run of a system."""
    arrays, scheme = assemble(system, []), st.ExactModal()
    blocks = blocks_of(arrays, scheme, step)
    state = state_at_start(arrays, scheme, step, blocks, st.GaussSeidel())
    return Case(blocks, state, imposed_on(arrays, blocks.used, 0, 1, step))


def dry_run() -> None:
    """Compile the march for a card that is not present and print the resources of a thread."""
    if find_spec("numba_cuda") is None:
        print(f"nothing compiled: numba-cuda is not installed: {how_to_install('cuda')}")
        return
    from numba.cuda import dispatcher

    # Functions called by a kernel are compiled for the card at hand; here there is none.
    dispatcher.get_current_device = lambda: SimpleNamespace(compute_capability=DRY)
    at = Timing(STEP, 1, 1)
    disc = st.load_scenario("pin-on-disc").system
    for name, system in (("one contact", squeal(radians(45.0), 1.5)), ("several", pad(2)), ("in space", disc)):
        began, run = time.perf_counter(), prepared(system, at.step)
        march = march_of(DryMarch, [run, run], at)
        march.advance([run.imposed, run.imposed], 1)
        took = time.perf_counter() - began
        print(f"{name}: {len(march.ptx)} characters of PTX for compute capability {DRY[0]}.{DRY[1]}, {took:.1f} s")
        if name == "one contact":
            print(f"{operations(run.blocks)} operations a step")
        show_resources(march.ptx)


def show_resources(ptx: str) -> None:
    """Print the resources of a thread of a kernel."""
    assembler = shutil.which("ptxas") or next(
        (str(found) for folder in sys.path for found in Path(folder).glob("nvidia/*/bin/ptxas")), None
    )
    if assembler is None:
        print("registers are not known: no ptxas (pip install nvidia-cuda-nvcc-cu12)")
        return
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "march.ptx"
        source.write_text(ptx)
        print(f"{'at most':>8}{'registers':>11}{'stack B':>9}{'spilled B':>11}   occupied at 64 threads")
        for most in (255, 168, 128, 96):
            registers, stack, stored, loaded = _resources(assembler, source, most)
            room = occupancy(registers, 64)
            print(f"{most:>8}{registers:>11}{stack:>9}{f'{stored}+{loaded}':>11}   {room:.1%}")


def _resources(assembler: str, source: Path, most: int) -> tuple[int, ...]:
    """Return registers of a thread, bytes of its stack, and bytes stored and loaded for lack of registers."""
    target = f"-arch=sm_{DRY[0]}{DRY[1]}"
    command = [assembler, target, "-v", f"-maxrregcount={most}", str(source), "-o", str(source.with_suffix(".cubin"))]
    words = subprocess.run(command, check=True, capture_output=True, text=True).stderr
    found = re.search(
        r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads\n.*?Used (\d+)", words
    )
    stack, stored, loaded, registers = map(int, found.groups()) if found else (0, 0, 0, 0)
    return registers, stack, stored, loaded


def main() -> None:
    """Measure, or print why not."""
    words = arguments(__doc__)
    words.add_argument("--dry-run", action="store_true", help="compile without a GPU")
    words.add_argument("--map", type=int, default=0, metavar="SIDE", help="also a map of SIDE x SIDE runs")
    chosen = words.parse_args()
    if chosen.dry_run:
        dry_run()
        return
    if SHORT:
        show(TITLE, rows())
        return
    try:
        require_cuda()
    except RuntimeError as error:
        print(f"nothing measured: {error}")
        return
    at = timing()
    measure(at)
    if chosen.map:
        map_of(chosen.map, at)


if __name__ == "__main__":
    main()
