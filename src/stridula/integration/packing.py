"""Runs of one contact as the march lays them out: eight modes of one run in a block, or one mode of eight runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .._kernels import layout as at
from .._kernels.block_rows import LOADS, NUMBER, WAVES
from .._kernels.vectors import LANES
from ..bodies.modes import Array
from ..records.state import State
from .blocks import Blocks, ContactBlocks


@dataclass(frozen=True)
class Places:
    """Where the modes of a run lie: fixed ones in the first blocks, then bending and axial harmonics.

    Attributes
    ----------
    block, lane : ndarray of int, shape (modes,)
        Block of each mode, and its place in it, of the first of runs side by side.
    blocks : tuple of int
        Number of blocks of each kind.
    """

    block: Array
    lane: Array
    blocks: tuple[int, int, int]


def places(contacts: ContactBlocks, per_block: int) -> Places:
    """Return where the modes lie, `per_block` of each run in a block."""
    count = contacts.rows.shape[2]
    bending, axial, end = (int(contacts.spans[0, k]) for k in (at.BENDING, at.AXIAL, at.AXIAL_END))
    kinds = (np.r_[0:bending, end:count], np.r_[bending:axial], np.r_[axial:end])
    fixed, bends, stretches = (-(-kind.size // per_block) for kind in kinds)
    block, lane = np.empty((2, count), dtype=np.int64)
    for kind, first in zip(kinds, (0, fixed, fixed + bends), strict=True):
        block[kind], lane[kind] = np.divmod(np.arange(kind.size), per_block)
        block[kind] += first
    return Places(block, lane, (fixed, bends, stretches))


def pack(where: Places, rows: Sequence[Array], width: int) -> Array:
    """Return rows over modes, shape (rows, modes) for each run, as blocks, shape (blocks, rows, width)."""
    blocks, count = sum(where.blocks), len(rows[0])
    out = aligned(blocks, count * width).reshape(blocks, count, width)
    for run, values in enumerate(rows):
        out[where.block, :, where.lane + run] = values.T
    out[:, NUMBER] = np.arange(blocks * width).reshape(blocks, width) + 1.0 - where.blocks[0] * width
    return out


def side_by_side(rows: Sequence[Array]) -> Array:
    """Return what belongs to runs, shape (rows, ...) for each, with a column for each run, in groups where needed."""
    stacked = np.stack(rows, axis=-1)
    out = aligned(len(stacked), int(np.prod(stacked.shape[1:])))
    out[:] = stacked.reshape(out.shape)
    return out


def aligned(rows: int, columns: int) -> Array:
    """Return zeros whose first vector lies in a line of the cache."""
    memory = np.zeros(rows * columns + LANES)
    skipped = (-memory.ctypes.data // 8) % LANES
    return memory[skipped : skipped + rows * columns].reshape(rows, columns)


def rows_of(blocks: Blocks, state: State) -> tuple[Array, Array]:
    """Return all rows over the modes of a run, and the scale of its state."""
    contacts, block = blocks.contacts, blocks.modes.block
    scale = np.sqrt(block[at.LOAD])
    harmonic = np.zeros(scale.size)
    for first, end in ((at.BENDING, at.BENDING_END), (at.AXIAL, at.AXIAL_END)):
        span = slice(int(contacts.spans[0, first]), int(contacts.spans[0, end]))
        harmonic[span] = np.arange(1, span.stop - span.start + 1)
    # A mode is fixed or a harmonic: its rows at the contact or the amplitudes of its trace.
    amplitude = contacts.constants[0, at.AMPLITUDE] * (harmonic > 0.0)
    at_contact = contacts.rows[0] + [amplitude, contacts.constants[0, at.WAVENUMBER] * harmonic * amplitude]
    working = np.zeros((LOADS - WAVES, scale.size))
    return np.concatenate(
        [
            state.modal / scale + state.remainder,
            block[[at.B, at.R]],
            np.zeros((1, scale.size)),
            at_contact * scale,
            working,
            blocks.modes.loads / scale,
            blocks.probes.row * scale,
        ]
    ), scale


def numbers_of(contacts: ContactBlocks) -> Array:
    """Return the numbers of a run that the march reads."""
    constants, w = contacts.constants[0], contacts.compliance
    own = constants[[at.START, at.GAP, at.HIGH, at.WAVENUMBER]]
    return np.array([*own, w[0, 0], w[0, 1], w[1, 1], contacts.laws[0, 0]])
