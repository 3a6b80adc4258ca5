"""The march of systems, chunk by chunk."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numba
import numpy as np

from .._kernels.contacts.newton import FACTORS
from .._kernels.lanes.vectors import LANES
from .._kernels.layout import columns as at
from .._kernels.layout.parts import (
    Carried,
    Contacts,
    Heating,
    Imposed,
    Modes,
    Parts,
    Paths,
    Probes,
    Records,
    Springs,
    Timing,
    Turning,
)
from .._kernels.layout.rows import CONTACTS
from .._kernels.march import march
from .._kernels.modes.turning import OF_CONTACT
from ..arrays import Array
from ..lowering import Assembly
from ..lowering.blocks import Blocks, ContactBlocks, ProbeBlocks, SpringBlocks
from ..lowering.heating import HeatBlocks
from ..lowering.own_laws import of_one_width
from ..lowering.packing import (
    PLAIN,
    aligned,
    at_start,
    columns,
    compliance_in_blocks,
    layout_of,
    matrices_of,
    pack,
    reach_of,
    room_to_solve,
    rows_of,
    scale_of,
    side_by_side,
    turns_of,
    waves_of,
)
from ..records.state import State
from .compiled_code import forget_other_sources, store_one_at_a_time
from .contact_solve import GaussSeidel

_compiled: Any = march
if not PLAIN:
    forget_other_sources(march.__module__.rpartition(".")[0])
    store_one_at_a_time()


@dataclass(frozen=True)
class Excitation:
    """Imposed signals and motions of a chunk of steps, in one row each if nothing varies.

    Attributes
    ----------
    signals : ndarray, shape (steps, signals)
        Amplitude of each load, then the imposed displacement, velocity and acceleration.
    motion : ndarray, shape (steps + 2, contacts, motions)
        Motions imposed on each contact, from the step before to the one after.
    angles : ndarray, shape (steps + 1, bodies)
        Angles by which bodies turn in each step [rad], from the step before on.
    """

    signals: Array
    motion: Array
    angles: Array


def imposed_on(arrays: Assembly, used: Sequence[int], first: int, steps: int, step: float) -> Excitation:
    """Return the imposed signals and motions of `steps` steps from `first` on; unused signals stay zero."""
    times = np.arange(first - 1, first + steps + 1) * step
    signals = np.zeros((steps, len(arrays.signals)))
    for j, signal in enumerate(arrays.signals):
        if j in used:
            signals[:, j] = signal(times[1:-1], step)
    angles = [one.turning.angles(times, step) for one in arrays.turning]
    return Excitation(signals, arrays.motion(times, step), np.array(angles).reshape(len(angles), steps + 1).T)


class Impositions:
    """Imposed signals and motions of a system for consecutive ranges of steps.

    Parameters
    ----------
    arrays : Assembly
        The system as flat arrays.
    blocks : Blocks
        The same in the form for the march.
    step : float
        Time step [s].
    """

    def __init__(self, arrays: Assembly, blocks: Blocks, step: float) -> None:
        self.arrays, self.used, self.step = arrays, blocks.used, step
        self.is_steady = arrays.prescribed.is_steady

    def on(self, first: int, steps: int) -> Excitation:
        """Return the imposed signals and motions of `steps` steps from `first` on, in one row if nothing varies."""
        return self._steady if self.is_steady else imposed_on(self.arrays, self.used, first, steps, self.step)

    @cached_property
    def _steady(self) -> Excitation:
        imposed = imposed_on(self.arrays, self.used, 0, 1, self.step)
        return Excitation(imposed.signals, imposed.motion[:1], imposed.angles[:1])


@dataclass(frozen=True)
class Chunk:
    """Record of a chunk of a march.

    Attributes
    ----------
    energies : ndarray, shape (samples, energies)
        Energies at every sample.
    contacts : ndarray, shape (samples, contacts, columns)
        Variables of the contacts.
    raw : ndarray, shape (steps, probes)
        Probes at every step.
    completed, ended : int
        Number of completed samples, and the code of the end of the march.
    """

    energies: Array
    contacts: Array
    raw: Array
    completed: int
    ended: int


class Factors(NamedTuple):
    """Factors of the equations of many contacts that are kept from step to step.

    Attributes
    ----------
    rows : ndarray, shape (runs, rows, numbers)
        Numbers of the contacts when they were factorised.
    matrix : ndarray, shape (runs, unknowns, unknowns)
        The factors.
    """

    rows: Array
    matrix: Array


class March:
    """The march of one run, or of several of the same kind side by side.

    Runs of the same kind have the same number of modes, contacts on paths of the same waves, friction laws, drives and
    probes.

    Parameters
    ----------
    blocks : sequence of Blocks
        Each system in the form for the march.
    states : sequence of State
        State of each.
    step : float
        Time step [s].
    ratio : int
        Steps per sample.
    solve : GaussSeidel, optional
        Settings of the simultaneous solution of several contacts.
    """

    def __init__(
        self,
        blocks: Sequence[Blocks],
        states: Sequence[State],
        step: float,
        ratio: int,
        solve: GaussSeidel | None = None,
    ) -> None:
        first, self.given, self.ratio = blocks[0], len(blocks), ratio
        solve = GaussSeidel() if solve is None else solve
        self.timing = Timing(ratio, step, solve.tolerance, solve.sweeps)
        self.runs, per_block, width = self._arrangement()
        self.layout = layout_of(blocks, per_block)
        blocks = [*blocks, *[blocks[-1]] * (self.runs - self.given)]
        self.scales = [scale_of(one.modes) for one in blocks]
        rows = [rows_of(*each) for each in zip(blocks, self.scales, strict=True)]
        self.contact_count, runs = len(first.contacts.codes), self.runs
        self.modes = Modes(
            pack(self.layout, rows, width),
            matrices_of(self.layout, [one.modes for one in blocks], width),
            reach_of(self.layout, [one.modes for one in blocks]),
            columns(aligned(len(first.modes.loads), runs)),
        )
        self.paths = self._paths(width)
        self.contacts = self._contacts([one.contacts for one in blocks], width)
        self.turning = Turning(
            turns_of(self.layout, [one.turning for one in blocks], width),
            self.layout.turning,
            columns(aligned(2 * len(first.turning), runs)),
            columns(aligned(OF_CONTACT * self.contact_count if first.turning else 0, runs)),
        )
        self.springs = self._springs([one.springs for one in blocks])
        self.heating = self._heating([one.heat for one in blocks])
        numbers = self.contact_count * at.CARRIED, self.contact_count * at.CARRIED, at.ENERGIES
        self.carried = Carried(*(columns(aligned(count, runs)) for count in numbers))
        self.probe_count = len(first.probes.kinds)
        self.used = sorted({j for one in blocks for j in one.used})
        self.probes = self._probes([one.probes for one in blocks])
        self.probed = [one.probes for one in blocks]
        self.room: tuple[Array, ...] = (aligned(0, 0),)
        self.put(states)

    def _arrangement(self) -> tuple[int, int, int]:
        """Return the number of runs, the number of modes of each in a block, and the width of a block.

        A vector of runs is filled up with copies of the last one.
        """
        if PLAIN:
            return self.given, 1, self.given
        return (1, LANES, LANES) if self.given == 1 else (LANES, 1, LANES)

    def _paths(self, width: int) -> Paths:
        where = self.layout
        waves = waves_of(where, width)
        spans = where.wave_of, where.across_of, where.spans, where.first_span, where.path_of
        return Paths(waves, where.sets, *spans, where.circles, at_start(where, self.modes.rows))

    def _contacts(self, contacts: Sequence[ContactBlocks], width: int) -> Contacts:
        runs, count, sizes = self.runs, self.contact_count, self.layout.sizes
        return Contacts(
            contacts[0].codes,
            np.stack(of_one_width([one.laws for one in contacts]), axis=1).reshape(count * runs, -1),
            contacts[0].first_rows,
            columns(side_by_side([one.constants.reshape(-1) for one in contacts])),
            columns(side_by_side([one.compliance[[0, 0, 1], [0, 1, 1]] for one in contacts])),
            compliance_in_blocks([one.compliance for one in contacts], sizes, width),
            *room_to_solve(sizes, width),
            columns(aligned(count * at.IN_STEP, runs)),
            columns(aligned(count * at.SUMS, runs)),
            np.concatenate(np.stack(of_one_width([one.profiles for one in contacts]), axis=1)),
        )

    def _springs(self, springs: Sequence[SpringBlocks]) -> Springs:
        each = [one.ravel() for one in of_one_width([one.numbers for one in springs])]
        return Springs(
            columns(side_by_side(each)),
            columns(aligned(len(springs[0].numbers) * at.SPRING_STATE, self.runs)),
        )

    def _heating(self, heat: Sequence[HeatBlocks]) -> Heating:
        return Heating(
            columns(side_by_side([one.numbers.ravel() for one in heat])),
            columns(aligned(at.LAYERS, self.runs)),
            np.concatenate(np.stack(of_one_width([one.laws for one in heat]), axis=1)),
        )

    def _probes(self, probes: Sequence[ProbeBlocks]) -> Probes:
        spans = np.zeros((self.probe_count, 2), dtype=np.int64)
        sizes = self.layout.sizes
        first = CONTACTS + sizes.rows + 2 * (sizes.loads + sizes.springs)
        for i, span in enumerate(spans):
            seen = np.flatnonzero(self.modes.rows[:, first + i].any(axis=1))
            span[:] = (seen[0], seen[-1] + 1) if seen.size else (0, 0)
        return Probes(
            probes[0].kinds,
            spans,
            side_by_side([one.direct[:, self.used] for one in probes]),
            columns(side_by_side([one.contact.reshape(-1) for one in probes])),
            columns(aligned(self.probe_count, self.runs)),
            columns(aligned(2 * self.probe_count, self.runs)),
        )

    @property
    def places(self) -> list[Any]:
        """Places of the runs, as in `lanes.placed`: of all in a call, or of each in turn in plain Python."""
        return [(run, self.runs) for run in range(self.runs)] if PLAIN else [None if self.runs == 1 else True]

    @property
    def is_single(self) -> bool:
        """Whether there is one contact in the plane, no heating, coupled or turning modes, or nonlinear springs."""
        sizes = self.layout.sizes
        one = sizes.contacts == 1 and not sizes.space
        more = sizes.coupled or sizes.springs or sizes.layers or len(self.layout.turning)
        return one and not more

    @property
    def kind(self) -> tuple[bool | None, bool | None, bool | None]:
        """The arguments of `march` that select the steps."""
        in_space = self.layout.sizes.space or len(self.layout.turning) > 0
        return (True, None, None) if self.is_single else (None, True, in_space or None)

    @property
    def is_compiled(self) -> bool:
        """Whether nothing has to be compiled, or loaded, for a march of this kind."""
        types = tuple(map(numba.typeof, (*self.kind, self.places[0])))
        return PLAIN or types in [signature[:4] for signature in _compiled.signatures]

    @property
    def states(self) -> list[State]:
        """State of each run."""
        found, where = [], self.layout
        all_carried = self.carried.carried.reshape(-1, self.runs)
        springs = self.springs.now.reshape(-1, at.SPRING_STATE, self.runs)
        energies = self.carried.energies.reshape(-1, self.runs)
        for run, scale in enumerate(self.scales[: self.given]):
            rows = self.modes.rows[where.block, :2, where.lane + run].T
            modal = rows * scale
            carried = all_carried[:, run].reshape(self.contact_count, at.CARRIED).copy()
            own = springs[:, at.EARLIER_INCREMENT, run].copy()
            found.append(State(modal, rows - modal / scale, carried, own, energies[:, run].copy()))
        return found

    def put(self, states: Sequence[State], factors: Factors | None = None) -> None:
        """Continue from given states of the systems; with the factors kept then, as then to the last bit."""
        where = self.layout
        states = [*states, *[states[-1]] * (self.runs - self.given)]
        for run, (state, scale) in enumerate(zip(states, self.scales, strict=True)):
            self.modes.rows[where.block, :2, where.lane + run] = (state.modal / scale + state.remainder).T
        carried = np.stack([state.carried.reshape(-1) for state in states], axis=1)
        energies = np.stack([state.energies for state in states], axis=1)
        for own, given in zip(self.carried, (carried, carried, energies), strict=True):
            own.reshape(given.shape)[:] = given
        increments = np.stack([state.springs for state in states], axis=1)
        self.springs.now.reshape(-1, at.SPRING_STATE, self.runs)[:, at.EARLIER_INCREMENT] = increments
        dense, rows = self.contacts.dense, self.layout.sizes.rows
        if factors is not None:
            most = factors.matrix.shape[1]
            dense[:, rows:], dense[:, :most, :most] = factors
        elif dense.size:
            dense[:, rows + FACTORS] = 0.0

    @property
    def factors(self) -> Factors | None:
        """The factors kept for the next step, None without any."""
        dense, rows = self.contacts.dense, self.layout.sizes.rows
        most = int(dense[:, rows + FACTORS, 0].max()) if dense.size else 0
        return Factors(dense[:, rows:].copy(), dense[:, :most, :most].copy()) if most else None

    def copy(self) -> March:
        """Return a copy in the same state."""
        return deepcopy(self)

    def _room(self, samples: int) -> tuple[Array, Array, Array, Array]:
        """Return memory for a chunk: that of the last one if it is large enough."""
        if samples > len(self.room[0]):
            columns = at.ENERGIES, at.COLUMNS * self.contact_count
            records = [aligned(samples, count * self.runs) for count in columns]
            self.room = (*records, aligned(samples * self.ratio, self.probe_count * self.runs), aligned(2, self.runs))
        energies, record, raw, stops = self.room
        return energies[:samples], record[:samples], raw[: samples * self.ratio], stops

    def advance(self, imposed: Sequence[Excitation], samples: int) -> list[Chunk]:
        """March `samples` samples and return the record of each run, to be read before the next call."""
        steps, runs = samples * self.ratio, self.runs
        imposed = [*imposed, *[imposed[-1]] * (runs - self.given)]
        energies, record, raw, stops = self._room(samples)
        signals = _each(lambda one: one.signals[:, self.used], imposed)
        motions = _each(lambda one: one.motion.reshape(len(one.motion), -1), imposed)
        if all((one == one[0]).all() for one in signals):
            signals = [one[:1] for one in signals]
        if not any(one.any() for one in motions):
            motions = [one[:1] for one in motions]
        angles = _each(lambda one: one.angles, imposed)
        if all((one == one[0]).all() for one in angles):
            angles = [one[:1] for one in angles]
        given = Imposed(_beside(signals), _beside(motions), _beside(angles))
        self._march(given, Records(energies, record, raw, stops))
        energies, record = energies.reshape(samples, -1, runs), record.reshape(samples, self.contact_count, -1, runs)
        raw = raw.reshape(steps, -1, runs)
        return [
            Chunk(
                energies[..., run], record[..., run], probed.summed(raw[..., run]), *stops[:2, run].astype(int).tolist()
            )
            for run, probed in zip(range(self.given), self.probed, strict=False)
        ]

    def _march(self, imposed: Imposed, records: Records) -> None:
        """March through a chunk and fill `records`."""
        parts = self.modes, self.paths, self.contacts, self.turning, self.springs, self.heating, self.carried, imposed
        for place in self.places:
            march(*self.kind, place, Parts(self.layout.sizes, self.timing, *parts, self.probes, records))


def compilations() -> int:
    """Return the number of kinds of the march that this process has compiled."""
    return 0 if PLAIN else sum(_compiled.stats.cache_misses.values())


def _beside(imposed: Sequence[Array]) -> Array:
    """Return arrays of runs over the steps, shape (steps, numbers) each, side by side."""
    first, rows = imposed[0], max(map(len, imposed))
    if any(one is not first for one in imposed):
        # Constant values have one row.
        return side_by_side([np.broadcast_to(one, (rows, one.shape[1])) for one in imposed])
    return np.ascontiguousarray(first) if len(imposed) == 1 else np.repeat(first, len(imposed), axis=1)


def _each(change: Callable[[Excitation], Array], imposed: Sequence[Excitation]) -> list[Array]:
    """Return the results of a function for each, computed once for an object shared by several runs."""
    made = {id(one): change(one) for one in {id(one): one for one in imposed}.values()}
    return [made[id(one)] for one in imposed]
