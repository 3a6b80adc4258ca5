"""The march of a system, chunk by chunk: by the kernel that its contacts and modes ask for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from copy import deepcopy
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, Protocol

import numpy as np
from numba.core import config

from .._kernels import layout as at
from .._kernels.march import march
from .._kernels.one_contact import march_one_by_one, march_run, march_runs
from .._kernels.vectors import LANES
from ..assembly import Assembly
from ..bodies.modes import Array
from ..records.state import State
from .blocks import Blocks
from .contact_solve import GaussSeidel
from .packing import aligned, numbers_of, pack, places, rows_of, side_by_side

# Whether numba has been told to compile nothing.
PLAIN = bool(config.DISABLE_JIT)  # type: ignore[attr-defined]


@dataclass(frozen=True)
class Imposed:
    """What is imposed on a chunk of steps; one row of each serves the march of one contact where nothing varies.

    Attributes
    ----------
    signals : ndarray, shape (steps, signals)
        Amplitude of each load, then the imposed displacement, velocity and acceleration.
    motion : ndarray, shape (steps + 2, contacts, motions)
        Motions imposed on each contact, from the step before to the one after.
    """

    signals: Array
    motion: Array


def imposed_on(arrays: Assembly, heard: Sequence[int], first: int, steps: int, step: float) -> Imposed:
    """Return what is imposed on `steps` steps from number `first` on; signals that are not heard are left zero."""
    times = np.arange(first - 1, first + steps + 1) * step
    signals = np.zeros((steps, len(arrays.signals)))
    for j in heard:
        signals[:, j] = arrays.signals[j](times[1:-1], step)
    return Imposed(signals, arrays.motion(times, step))


class Impositions:
    """What is imposed on a system, stretch after stretch of its steps.

    Parameters
    ----------
    arrays : Assembly
        The system as flat arrays.
    blocks : Blocks
        The same as the march reads it.
    step : float
        Time step [s].
    """

    def __init__(self, arrays: Assembly, blocks: Blocks, step: float) -> None:
        self.arrays, self.heard, self.step = arrays, blocks.heard, step
        self.is_steady = blocks.is_simple and arrays.prescribed.is_steady

    def on(self, first: int, steps: int) -> Imposed:
        """Return what is imposed on `steps` steps from number `first` on, in one row where nothing varies."""
        return self._steady if self.is_steady else imposed_on(self.arrays, self.heard, first, steps, self.step)

    @cached_property
    def _steady(self) -> Imposed:
        imposed = imposed_on(self.arrays, self.heard, 0, 1, self.step)
        return Imposed(imposed.signals, imposed.motion[:1])


@dataclass(frozen=True)
class Chunk:
    """What a chunk of a march left.

    Attributes
    ----------
    energies : ndarray, shape (samples, energies)
        Energies at every sample.
    contacts : ndarray, shape (samples, contacts, columns)
        Record of the contacts.
    raw : ndarray, shape (steps, probes)
        Probes at every step.
    completed, ended : int
        Samples completed, and what ended the march.
    """

    energies: Array
    contacts: Array
    raw: Array
    completed: int
    ended: int


class March(Protocol):
    """A system on the march."""

    @property
    def kernel(self) -> Any:
        """What marches: a function of numba, or anything else where nothing is compiled for the processor."""
        ...

    @property
    def states(self) -> list[State]:
        """Where each run is."""
        ...

    def advance(self, imposed: Sequence[Imposed], samples: int) -> list[Chunk]:
        """March `samples` samples on and return what each run left, to be read before the next call."""
        ...

    def copy(self) -> March:
        """Return another march that is where this one is."""
        ...


def march_of(blocks: Blocks, state: State, step: float, ratio: int, solve: GaussSeidel) -> March:
    """Return the march of one system, `ratio` steps of length `step` [s] a sample."""
    if blocks.is_simple:
        return SimpleMarch([blocks], [state], step, ratio)
    return GeneralMarch(blocks, state, step, ratio, solve)


class GeneralMarch:
    """Any number of contacts, modes coupled or not."""

    def __init__(self, blocks: Blocks, state: State, step: float, ratio: int, solve: GaussSeidel) -> None:
        self.blocks, self.state, self.step, self.ratio, self.solve = blocks, state, step, ratio, solve

    @property
    def kernel(self) -> Any:
        """What marches."""
        return march

    @property
    def states(self) -> list[State]:
        """Where the run is."""
        return [self.state]

    def copy(self) -> GeneralMarch:
        """Return another march that is where this one is."""
        return GeneralMarch(self.blocks, deepcopy(self.state), self.step, self.ratio, self.solve)

    def advance(self, imposed: Sequence[Imposed], samples: int) -> list[Chunk]:
        """March on."""
        modes, contacts, probes, state = self.blocks.modes, self.blocks.contacts, self.blocks.probes, self.state
        energies = np.empty((samples, at.ENERGIES))
        record = np.empty((samples, len(contacts.constants), at.COLUMNS))
        raw = np.empty((samples * self.ratio, len(probes.direct)))
        completed, ended = self.kernel(
            self.ratio,
            self.step,
            self.solve.tolerance,
            self.solve.sweeps,
            modes.block,
            modes.matrices,
            contacts.constants,
            contacts.laws,
            contacts.spans,
            contacts.half_waves,
            contacts.shares,
            contacts.rows,
            contacts.compliance,
            state.modal,
            state.carried,
            state.energies,
            modes.loads,
            imposed[0].signals,
            imposed[0].motion,
            probes.rows,
            probes.spans,
            probes.direct,
            probes.contact,
            energies,
            record,
            raw,
        )
        return [Chunk(energies, record, raw, completed, ended)]


class SimpleMarch:
    """One contact between bodies of uncoupled modes: of one run, or of several of the same kind side by side.

    Runs of the same kind have the same modes in number, law of friction, drives and probes.
    """

    def __init__(self, blocks: Sequence[Blocks], states: Sequence[State], step: float, ratio: int) -> None:
        first, self.given = blocks[0], len(blocks)
        self.step, self.ratio = step, ratio
        self.runs, per_block, width = self._layout()
        blocks = [*blocks, *[blocks[-1]] * (self.runs - self.given)]
        states = [*states, *[states[-1]] * (self.runs - self.given)]
        self.places = places(first.contacts, per_block)
        known = [rows_of(one, state) for one, state in zip(blocks, states, strict=True)]
        rows, self.scales = zip(*known, strict=True)
        self.rows = pack(self.places, rows, width)
        self.carried = side_by_side([state.carried[0] for state in states])
        self.energies = side_by_side([state.energies for state in states])
        self.law = int(first.contacts.constants[0, at.LAW])
        self.laws = np.concatenate([one.contacts.laws for one in blocks])
        self.numbers = side_by_side([numbers_of(one.contacts) for one in blocks])
        self.work_of_loads = aligned(len(first.modes.loads), self.runs)
        self.probe_count = len(first.probes.direct)
        self.room: tuple[Array, ...] = (aligned(0, 0),)
        self.heard = sorted({j for one in blocks for j in one.heard})
        self.probes = (
            first.probes.kinds,
            self._probe_spans(),
            side_by_side([one.probes.direct[:, self.heard] for one in blocks]),
            side_by_side([one.probes.contact.reshape(-1) for one in blocks]),
            aligned(self.probe_count, self.runs),
        )

    def _layout(self) -> tuple[int, int, int]:
        """Return how many runs march, how many modes of each lie in a block, and how wide a block is.

        A vector of runs is filled up with copies of the last.
        """
        if PLAIN:
            return self.given, 1, self.given
        return (1, LANES, LANES) if self.given == 1 else (LANES, 1, LANES)

    def _probe_spans(self) -> Array:
        """Return the first block that each probe sees, and the one after the last."""
        spans = np.zeros((self.probe_count, 2), dtype=np.int64)
        first = self.rows.shape[1] - self.probe_count
        for i, span in enumerate(spans):
            seen = np.flatnonzero(self.rows[:, first + i].any(axis=1))
            span[:] = (seen[0], seen[-1] + 1) if seen.size else (0, 0)
        return spans

    @property
    def kernel(self) -> Any:
        """What marches."""
        if PLAIN:
            return partial(march_one_by_one, self.runs)
        return march_run if self.runs == 1 else march_runs

    @property
    def states(self) -> list[State]:
        """Where each run is."""
        found = []
        for run, scale in enumerate(self.scales[: self.given]):
            rows = self.rows[self.places.block, :2, self.places.lane + run].T
            modal = rows * scale
            carried, energies = self.carried[None, :, run].copy(), self.energies[:, run].copy()
            found.append(State(modal, rows - modal / scale, carried, energies))
        return found

    def copy(self) -> SimpleMarch:
        """Return another march that is where this one is."""
        return deepcopy(self)

    def _room(self, samples: int) -> tuple[Array, Array, Array, Array]:
        """Return where a chunk is written to: the same memory as for the last one if that is enough."""
        if samples > len(self.room[0]):
            columns = at.ENERGIES, at.COLUMNS
            records = [aligned(samples, count * self.runs) for count in columns]
            self.room = (*records, aligned(samples * self.ratio, self.probe_count * self.runs), aligned(2, self.runs))
        energies, record, raw, stops = self.room
        return energies[:samples], record[:samples], raw[: samples * self.ratio], stops

    def advance(self, imposed: Sequence[Imposed], samples: int) -> list[Chunk]:
        """March on."""
        steps, runs = samples * self.ratio, self.runs
        imposed = [*imposed, *[imposed[-1]] * (runs - self.given)]
        energies, record, raw, stops = self._room(samples)
        signals = _each(lambda one: one.signals[:, self.heard], imposed)
        motions = _each(lambda one: one.motion[:, 0], imposed)
        if all((one == one[0]).all() for one in signals):
            signals = [one[:1] for one in signals]
        if not any(one.any() for one in motions):
            motions = [one[:1] for one in motions]
        self._march(_beside(signals), _beside(motions), energies, record, raw, stops)
        energies, record = energies.reshape(samples, -1, runs), record.reshape(samples, 1, -1, runs)
        raw = raw.reshape(steps, -1, runs)
        return [
            Chunk(energies[..., run], record[..., run], raw[..., run], int(stops[0, run]), int(stops[1, run]))
            for run in range(self.given)
        ]

    def _march(self, signals: Array, motion: Array, *outputs: Array) -> None:
        """March through a chunk and fill `outputs`: energies, record, probes at every step, what became of each run."""
        self.kernel(
            self.places.blocks,
            self.ratio,
            self.step,
            self.law,
            self.laws,
            self.numbers,
            self.rows,
            self.carried,
            self.energies,
            self.work_of_loads,
            signals,
            motion,
            self.probes,
            *outputs,
        )


def _beside(imposed: Sequence[Array]) -> Array:
    """Return numbers of runs at every step, shape (steps, numbers) for each, side by side."""
    first, rows = imposed[0], max(map(len, imposed))
    if any(one is not first for one in imposed):
        # What does not vary has one row.
        return side_by_side([np.broadcast_to(one, (rows, one.shape[1])) for one in imposed])
    return np.ascontiguousarray(first) if len(imposed) == 1 else np.repeat(first, len(imposed), axis=1)


def _each(change: Callable[[Imposed], Array], imposed: Sequence[Imposed]) -> list[Array]:
    """Return what a function makes of each, made once of one that serves several runs."""
    made = {id(one): change(one) for one in {id(one): one for one in imposed}.values()}
    return [made[id(one)] for one in imposed]
