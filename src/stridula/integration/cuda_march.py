"""March of any number of runs of the same kind on a GPU, one in each thread."""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from importlib.util import find_spec
from typing import Any

from numba.core import config

from .._kernels.layout.parts import Imposed, Parts, Records
from ..arrays import Array
from ..extras import how_to_install
from ..lowering.blocks import Blocks
from ..records.state import State
from .contact_solve import GaussSeidel
from .marches import March

# A thread needs some two hundred registers: with more threads in a block, fewer blocks fit a multiprocessor.
THREADS_PER_BLOCK = 64


def require_cuda() -> None:
    """Raise a RuntimeError that names the missing part, unless there is a GPU or numba's simulator of one."""
    missing = "" if config.ENABLE_CUDASIM else _missing()  # type: ignore[attr-defined]
    if missing:
        raise RuntimeError(f'device="cuda" needs {missing}')


def _missing() -> str:
    """Return the missing part in words; empty if a GPU can be used."""
    if find_spec("numba_cuda") is None:
        return f"numba-cuda, which is not installed: {how_to_install('cuda')}"
    from numba import cuda

    if cuda.is_available() and len(cuda.gpus):
        return ""
    error = " ".join(str(cuda.cuda_error() or "").split())
    if "library cannot be found" in error:
        return "the NVIDIA driver, which was not found"
    if "NO_DEVICE" in error or not error:
        return "a GPU: there is a driver but no GPU"
    return f"CUDA to work: {error}"


class CudaMarch(March):
    """Any number of runs of the same kind, each a thread on a GPU.

    Inputs and state of the march stay on the card between chunks.
    """

    def __init__(
        self,
        blocks: Sequence[Blocks],
        states: Sequence[State],
        step: float,
        ratio: int,
        solve: GaussSeidel | None = None,
        threads_per_block: int = THREADS_PER_BLOCK,
    ) -> None:
        require_cuda()
        from numba import cuda

        super().__init__(blocks, states, step, ratio, solve)
        self.cuda, self.threads_per_block = cuda, threads_per_block
        parts = self.modes, self.paths, self.contacts, self.turning, self.springs, self.heating, self.carried
        self.there = [self._moved(part) for part in (*parts, self.probes)]

    def _moved(self, part: Any) -> Any:
        """Return a tuple of arrays on the card."""
        return type(part)(*(self.cuda.to_device(array) for array in part))

    def _arrangement(self) -> tuple[int, int, int]:
        return self.given, 1, self.given

    @property
    def is_compiled(self) -> bool:
        """True, as nothing is compiled for the processor."""
        return True

    @property
    def states(self) -> list[State]:
        """State of each run."""
        modes, _, _, _, springs, _, carried, _ = self.there
        self.springs = self.springs._replace(now=springs.now.copy_to_host())
        self.modes = self.modes._replace(rows=modes.rows.copy_to_host())
        self.carried = type(carried)(*(array.copy_to_host() for array in carried))
        return super().states

    def copy(self) -> CudaMarch:
        """Return a copy in the same state."""
        twin = copy(self)
        twin.there = [type(part)(*(self._twin_of(array) for array in part)) for part in self.there]
        return twin

    def _twin_of(self, array: Array) -> Array:
        """Return a copy of an array on the card."""
        if not array.size:
            return array
        twin = self.cuda.device_array_like(array)
        twin.copy_to_device(array)
        return twin

    def _march(self, imposed: Imposed, records: Records) -> None:
        from .._kernels.cuda import marches

        imposed, filled = self._moved(imposed), self._moved(records)
        modes, paths, contacts, turning, springs, heating, carried, probes = self.there
        fixed = self.layout.sizes, self.timing, modes, paths, contacts, turning, springs, heating
        parts = Parts(*fixed, carried, imposed, probes, filled)
        grid = -(-self.runs // self.threads_per_block)
        marches[self.kind][grid, self.threads_per_block](self.runs, parts)
        for array, output in zip(filled, records, strict=True):
            array.copy_to_host(output)
