"""Memory layout of runs in the march: eight numbers of one run in a block, or one number of eight runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numba.core import config

from .._kernels.contacts.direct import FURTHER_ROWS, SAVED
from .._kernels.contacts.newton import ROWS
from .._kernels.lanes.vectors import LANES
from .._kernels.layout import columns as at
from .._kernels.layout.parts import Sizes
from .._kernels.layout.rows import AMPLITUDE, COMPLIANCE, CONTACTS, NUMBER, WAVE_ROWS, WAVE_SET
from .._kernels.modes.turning import DRAG, TURN_ROWS
from ..arrays import Array
from ..bodies.paths import Waves
from .blocks import Blocks, ContactBlocks, PathModes, Recurrence, TurningBlocks

# Whether numba's compilation is disabled.
PLAIN = bool(config.DISABLE_JIT)  # type: ignore[attr-defined]
# Kinds of the spans of a path.
PATH_KINDS = (at.PATH_NORMAL, at.PATH_TANGENTIAL)


@dataclass(frozen=True)
class Layout:
    """Memory layout of the numbers of a run.

    Attributes
    ----------
    sizes : Sizes
        Numbers of blocks of each kind.
    block, lane : ndarray of int, shape (modes,)
        Block of each mode, and its place in it for the first of the runs side by side.
    wave_of, across_of : ndarray of int, shape (blocks,)
        Wave of each block of a path, and multiple of the angle across.
    spans, first_span : ndarray of int
        Spans of blocks that act on each contact.
    path_of : ndarray of int, shape (contacts,)
        First block of the path of each contact, -1 for none.
    sets, numbers : ndarray
        Waves of each contact; multiples of the angles, a row for each block of waves.
    turning : ndarray of int, shape (bodies, 2)
        First block of the pairs of each body that turns, and end of their range.
    circles : ndarray of int, shape (contacts,)
        The turning body that each contact moves round, -1 for none.
    """

    sizes: Sizes
    block: Array
    lane: Array
    wave_of: Array
    across_of: Array
    spans: Array
    first_span: Array
    path_of: Array
    sets: Array
    numbers: Array
    turning: Array
    circles: Array

    @property
    def coupled_places(self) -> Array:
        """Places of the coupled modes in their blocks."""
        inside = self.block < self.sizes.coupled
        return np.asarray(self.block[inside] * self.sizes.per_block + self.lane[inside])


def layout_of(runs: Sequence[Blocks], per_block: int) -> Layout:
    """Return the layout of runs of the same kind, with `per_block` numbers of each in a block."""
    contacts, modes = runs[0].contacts, runs[0].modes
    places = _Places(contacts, modes.coupled, modes.block.shape[1], per_block, runs[0].turning)
    acts = np.any([one.contacts.rows != 0.0 for one in runs], axis=0)
    seen = np.logical_or.reduceat(acts, contacts.first_rows[:-1])
    spans: list[tuple[int, ...]] = []
    first_span = [0]
    for i, along in enumerate(contacts.paths):
        if len(contacts.rows) == 2 and not modes.coupled:
            spans.append((0, places.plain, at.CONSTANT, 0, 0))
        else:
            body = int(contacts.circles[i])
            if body >= 0:
                seen[i, runs[0].turning[body].pairs] = seen[i, runs[0].turning[body].others] = False
            spans += [(*span, at.CONSTANT, 0, 0) for span in _runs_of(places.block[seen[i]])]
            if body >= 0:
                spans.append((*places.round_spans[body], at.ROUND, 0, 0))
        if along is not None:
            spans += places.path_spans[_key(along)]
        first_span.append(len(spans))
    sets, numbers = _wave_sets(contacts, per_block)
    count, rows = len(contacts.paths), int(contacts.first_rows[-1])
    sizes = Sizes(
        places.blocks,
        places.coupled,
        per_block,
        count,
        -(-rows // per_block),
        rows,
        len(modes.loads),
        any(along is not None for along in contacts.paths) or bool((contacts.circles >= 0).any()),
        any(along is not None and along.normal.start < modes.coupled for along in contacts.paths)
        or any(runs[0].turning[body].pairs.min() < modes.coupled for body in contacts.circles if body >= 0),
        bool((np.diff(contacts.first_rows) > 2).any()),
        bool((contacts.circles >= 0).any()),
        len(runs[0].springs.pulls),
        max(one.springs.kinks for one in runs),
        max(one.heat.layers for one in runs),
    )
    along_of, across_of = np.array(places.waves, dtype=np.int64).reshape(-1, 2).T.copy()
    path_of = [-1 if along is None else places.path_spans[_key(along)][0][0] for along in contacts.paths]
    return Layout(
        sizes,
        places.block,
        places.lane,
        along_of,
        across_of,
        np.array(spans, dtype=np.int64).reshape(-1, at.SPAN),
        np.array(first_span),
        np.array(path_of),
        sets,
        numbers,
        np.array(places.turning, dtype=np.int64).reshape(-1, 2),
        contacts.circles,
    )


def _key(along: PathModes) -> int:
    return int(along.normal.start)


def _runs_of(numbers: Array) -> Iterator[tuple[int, int]]:
    """Yield spans of successive numbers."""
    numbers = np.unique(numbers)
    if numbers.size:
        for run in np.split(numbers, np.flatnonzero(np.diff(numbers) > 1) + 1):
            yield int(run[0]), int(run[-1]) + 1


class _Places:
    """Blocks in the order in which they are filled: coupled modes, then others; then pairs that turn, in alternate
    blocks; modes of a path last, wave by wave."""

    def __init__(
        self, contacts: ContactBlocks, coupled: int, count: int, per_block: int, bodies: Sequence[TurningBlocks]
    ) -> None:
        self.per_block, self.blocks = per_block, 0
        self.block, self.lane = np.zeros((2, count), dtype=np.int64)
        self.path_spans: dict[int, list[tuple[int, ...]]] = {}
        self.waves: list[tuple[int, int]] = []
        self.bodies, self.turning = bodies, list[tuple[int, int]]()
        self.round_spans: list[tuple[int, int]] = []
        paths = {_key(along): along for along in contacts.paths if along is not None}
        self._fill(0, coupled, paths)
        self.coupled = self.blocks
        self._fill(coupled, count, paths)

    def _fill(self, begin: int, end: int, paths: dict[int, PathModes]) -> None:
        inside = [along for along in paths.values() if begin <= along.normal.start < end]
        turning = [one for one in self.bodies if begin <= one.pairs.min() < end]
        others = np.setdiff1d(
            np.arange(begin, end),
            [
                *(k for along in inside for k in range(along.normal.start, along.tangential.stop)),
                *(k for one in turning for k in (*one.pairs.ravel(), *one.others)),
            ],
        )
        self.block[others] = self.blocks + np.arange(others.size) // self.per_block
        self.lane[others] = np.arange(others.size) % self.per_block
        self.plain = self._take(-(-others.size // self.per_block))
        for one in turning:
            first = self.blocks
            self.block[one.others] = first + np.arange(one.others.size) // self.per_block
            self.lane[one.others] = np.arange(one.others.size) % self.per_block
            self._take(-(-one.others.size // self.per_block))
            self.plain = self._take_pairs(one.pairs)
            self.round_spans.append((first, self.plain))
        for along in inside:
            first = first_multiple(along)
            spans = []
            for kind, span, waves in zip(
                PATH_KINDS, (along.normal, along.tangential), (along.path.normal, along.path.tangential), strict=True
            ):
                start = self.blocks
                for numbers in _groups(waves):
                    self._take_group(span.start + numbers, waves.multiples[numbers], first)
                spans.append((start, self.blocks, kind, waves.products, int(waves.cosines)))
            self.path_spans[_key(along)] = [span for span in spans if span[1] > span[0]]

    def _take(self, blocks: int, along: int = 0, across: int = 0) -> int:
        self.blocks += blocks
        self.waves += [(along, across)] * blocks
        return self.blocks

    def _take_pairs(self, modes: Array) -> int:
        """Put pairs of modes, shape (pairs, 2), into alternate blocks and return the block after the last."""
        first, number = self.blocks, np.arange(len(modes))
        for side in (0, 1):
            self.block[modes[:, side]] = first + 2 * (number // self.per_block) + side
            self.lane[modes[:, side]] = number % self.per_block
        self.turning.append((first, self._take(2 * -(-len(modes) // self.per_block))))
        return self.blocks

    def _take_group(self, modes: Array, multiples: Array, first: int) -> None:
        """Put modes with the same second multiple at places given by the first."""
        wave, lane = np.divmod(multiples[:, 0] - first, self.per_block)
        for number in np.unique(wave).tolist():
            here = wave == number
            self.block[modes[here]], self.lane[modes[here]] = self.blocks, lane[here]
            self._take(1, number, int(multiples[0, 1]))


def _groups(waves: Waves) -> list[Array]:
    """Return groups of modes that may share blocks: same second multiple, no first multiple twice."""
    if not waves.multiples[:, 1].any() and np.unique(waves.multiples[:, 0]).size == len(waves.multiples):
        return [np.arange(len(waves.multiples))] if len(waves.multiples) else []
    seen: dict[tuple[int, int], int] = {}
    groups: dict[tuple[int, int], list[int]] = {}
    for number, (m, n) in enumerate(waves.multiples.tolist()):
        times = seen[m, n] = seen.get((m, n), -1) + 1
        groups.setdefault((n, times), []).append(number)
    return [np.array(groups[key]) for key in sorted(groups)]


def _both(along: PathModes) -> Array:
    return np.concatenate([along.path.normal.multiples, along.path.tangential.multiples])


def first_multiple(along: PathModes) -> int:
    """Return the first multiple of the angle along a path that its waves need: 0 or 1."""
    return min(1, int(_both(along)[:, 0].min()))


def along_blocks(along: PathModes, per_block: int) -> int:
    """Return the number of blocks for the waves along a path."""
    return int(-(-(_both(along)[:, 0].max() + 1 - first_multiple(along)) // per_block))


def across_blocks(along: PathModes, per_block: int) -> int:
    """Return the number of blocks for the waves across it, from the multiple 0 on; 0 if all are along it."""
    highest = int(_both(along)[:, 1].max())
    return -(-(highest + 1) // per_block) if highest else 0


def _wave_sets(contacts: ContactBlocks, per_block: int) -> tuple[Array, Array]:
    """Return the waves of each contact, and their multiples."""
    sets: list[list[int]] = []
    numbers: list[Array] = []
    lanes = np.arange(LANES)
    for along in contacts.paths:
        if along is None:
            sets.append([0] * WAVE_SET)
            continue
        first = len(numbers)
        low, counts = first_multiple(along), (along_blocks(along, per_block), across_blocks(along, per_block))
        numbers += [low + per_block * k + lanes for k in range(counts[0])]
        numbers += [per_block * k + lanes for k in range(counts[1])]
        sets.append([first, *counts, 1 - low, (first + counts[0]) * per_block])
    return np.array(sets, dtype=np.int64), np.array(numbers, dtype=float).reshape(-1, LANES)


def pack(where: Layout, rows: Sequence[Array], width: int) -> Array:
    """Return rows over modes, shape (rows, modes) for each run, as blocks, shape (blocks, rows, width)."""
    blocks, count = where.sizes.blocks, len(rows[0])
    out = aligned(blocks, count * width).reshape(blocks, count, width)
    for run, values in enumerate(rows):
        out[where.block, :, where.lane + run] = values.T
    return out


def side_by_side(rows: Sequence[Array]) -> Array:
    """Return arrays of runs, shape (rows, ...) each, as one array with a column for each run."""
    stacked = np.stack(rows, axis=-1)
    out = aligned(len(stacked), int(np.prod(stacked.shape[1:])))
    out[:] = stacked.reshape(out.shape)
    return out


def columns(array: Array) -> Array:
    """Return an array of runs in the form for the march: without columns for one run if compiled."""
    return array if PLAIN or array.shape[1] > 1 else array[:, 0]


def aligned(rows: int, columns: int) -> Array:
    """Return zeros aligned to the lines of the cache."""
    memory = np.zeros(rows * columns + LANES)
    skipped = (-memory.ctypes.data // 8) % LANES
    return memory[skipped : skipped + rows * columns].reshape(rows, columns)


def scale_of(modes: Recurrence) -> Array:
    """Return the scale of the state of each mode in the march: square root of its mobility, 1 for coupled modes."""
    scale = np.sqrt(modes.block[at.LOAD])
    scale[: modes.coupled] = 1.0
    return np.asarray(scale)


def rows_of(blocks: Blocks, scale: Array) -> Array:
    """Return all rows over the modes of a run, those of its state, the first two, without values."""
    contacts, modes = blocks.contacts, blocks.modes
    springs = blocks.springs
    used = CONTACTS + len(contacts.rows) + 2 * (len(modes.loads) + len(springs.pulls)) + len(blocks.probes.rows)
    # The number of vectors is odd, so that the same rows of all blocks do not share a part of the cache.
    rows = np.zeros((used + 1 - used % 2, scale.size))
    rows[2:4] = modes.block[[at.B, at.R]]
    for along in contacts.paths:
        if along is not None:
            _put_waves(rows[AMPLITUDE:CONTACTS], along)
    rows[AMPLITUDE:CONTACTS] *= scale
    parts = (
        contacts.rows * scale,
        modes.loads / scale,
        modes.forces * scale,
        springs.pulls / scale,
        springs.stretches * scale,
        blocks.probes.rows * scale,
    )
    rows[CONTACTS:used] = np.concatenate(parts)
    return rows


def _put_waves(rows: Array, along: PathModes) -> None:
    """Put amplitudes and slopes of the waves, or of their products, of the modes of a path."""
    path = along.path
    for span, waves in ((along.normal, path.normal), (along.tangential, path.tangential)):
        amplitude, slope = waves.amplitude.T, waves.slopes(path.rate).T
        if waves.products:
            rows[0, span], rows[2, span] = amplitude[::-1]
            rows[1::2, span] = slope
        else:
            rows[0, span], rows[1, span] = amplitude[0], slope[1]


def matrices_of(where: Layout, runs: Sequence[Recurrence], width: int) -> Array:
    """Return the matrices of coupled modes in blocks, shape (blocks, kinds times places, width)."""
    coupled, per_block = where.sizes.coupled, where.sizes.per_block
    places = coupled * per_block
    out = aligned(coupled, at.MATRICES * places * width).reshape(coupled, at.MATRICES, places, width)
    here = where.coupled_places
    block, lane = np.divmod(here, per_block)
    for run, modes in enumerate(runs):
        # Rows of a matrix are spread over blocks and lanes, columns over places.
        out[block[:, None], :, here[None, :], (lane + run)[:, None]] = modes.matrices.transpose(1, 2, 0)
    return out.reshape(coupled, at.MATRICES * places, width)


def reach_of(where: Layout, runs: Sequence[Recurrence]) -> Array:
    """Return the first place of a coupled mode that acts on each block, and the end of the range."""
    here, found = where.coupled_places, np.zeros((where.sizes.coupled, 2), dtype=np.int64)
    acts = np.any([(modes.matrices != 0.0).any(axis=0) for modes in runs], axis=0)
    for block in range(where.sizes.coupled):
        places = here[acts[here // where.sizes.per_block == block].any(axis=0)]
        if places.size:
            found[block] = places.min(), places.max() + 1
    return found


def compliance_in_blocks(compliances: Sequence[Array], sizes: Sizes, width: int) -> Array:
    """Return the compliances of runs with space for displacements of their contacts, shape (rows, blocks, width)."""
    size = sizes.rows
    rows = COMPLIANCE + 2 * size
    out = aligned(rows, sizes.faces * width).reshape(rows, sizes.faces, width)
    block, lane = np.divmod(np.arange(size), sizes.per_block)
    for run, compliance in enumerate(compliances):
        for first in (COMPLIANCE, COMPLIANCE + size):
            out[first + np.arange(size)[None, :], block[:, None], (lane + run)[:, None]] = compliance
    return out


def room_to_solve(sizes: Sizes, width: int) -> tuple[Array, Array, Array]:
    """Return space for the equations of all contact forces, shape (rows, blocks, width), and for places in them.

    Space to solve for the forces of one run together, shape (runs, rows, numbers), is the last: the processor solves
    for one run after the other.
    """
    rows = sizes.rows + FURTHER_ROWS + sizes.per_block
    out = aligned(rows, sizes.faces * width).reshape(rows, sizes.faces, width)
    if sizes.faces and sizes.per_block > 1:
        out[SAVED - sizes.per_block : SAVED, 0] = np.tri(width, k=-1).T[::-1]
    numbers = sizes.rows if sizes.contacts > 1 else 0
    dense = np.zeros((1 if sizes.per_block > 1 else width, numbers + ROWS, numbers))
    return out, np.zeros((sizes.rows, width), dtype=np.int64), dense


def turns_of(where: Layout, bodies: Sequence[Sequence[TurningBlocks]], width: int) -> Array:
    """Return the phases of the pairs of turning bodies of each run with space for turns, (blocks, rows, width)."""
    blocks = where.sizes.blocks if len(where.turning) else 0
    out = aligned(blocks, TURN_ROWS * width).reshape(blocks, TURN_ROWS, width)
    for run, own in enumerate(bodies):
        for one in own:
            out[where.block[one.pairs[:, 0]], DRAG : DRAG + 2, where.lane[one.pairs[:, 0]] + run] = one.turns.T
    return out


def at_start(where: Layout, rows: Array) -> Array:
    """Return the rows of the contacts at the start, shape (blocks, rows, width); none if none moves round."""
    count = where.sizes.rows if where.sizes.circles else 0
    kept = rows[:, CONTACTS : CONTACTS + count]
    out = aligned(len(rows), kept.shape[1] * rows.shape[2]).reshape(kept.shape)
    out[:] = kept
    return out


def waves_of(where: Layout, width: int) -> Array:
    """Return space for the waves of all contacts, shape (blocks, rows, width)."""
    blocks = len(where.numbers)
    out = aligned(blocks, WAVE_ROWS * width).reshape(blocks, WAVE_ROWS, width)
    out[:, NUMBER] = where.numbers[:, : out.shape[2]] if width <= LANES else 0.0
    return out
