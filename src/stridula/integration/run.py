"""One run: the march in chunks, its state, and its record."""

from __future__ import annotations

import time as clock
import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from .._kernels import layout as at
from .._kernels.march import march, stored_energy
from ..assembly import Assembly
from ..bodies.modes import Array
from ..checks import instance
from ..records import Probe
from ..records.dataset import State, to_dataset
from ..records.provenance import scenario_toml
from ..system import System
from ..version import __version__
from .blocks import at_rest, coefficient_block, constants, probe_blocks
from .decimation import Decimator
from .interrupts import DeferredInterrupt
from .schemes import Scheme
from .watchers import Progress, Watcher

STEPS_PER_CHUNK = 20_000
# What a run that goes on from another must share with it; friction and drives may change.
FROZEN = (
    ("slider",),
    ("track",),
    ("contact", "at"),
    ("contact", "gap"),
    ("contact", "point"),
    ("simulation", "probes"),
)
ENDED = {at.FINISHED: "finished", at.OFF_TRACK: "off the track", at.NOT_FINITE: "not finite"}
COLUMN = {
    "normal_force": at.NORMAL_FORCE,
    "tangential_force": at.TANGENTIAL_FORCE,
    "contact_position": at.CONTACT_POSITION,
    "contact_height": at.CONTACT_HEIGHT,
    "gap": at.CONTACT_GAP,
    "slip_velocity": at.SLIP,
    "jammed_steps": at.JAMMED,
    "kinetic_and_elastic": at.STORED,
    "drive_work": at.DRIVE_WORK,
    "contact_work": at.CONTACT_WORK,
    "friction_loss": at.FRICTION_LOSS,
    "convection_work": at.CONVECTION_WORK,
    "damping_loss": at.DAMPING_LOSS,
}


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a run; what was recorded so far is in `record`."""

    def __init__(self, record: xr.Dataset) -> None:
        super().__init__(
            f"interrupted at t = {record.sizes['time'] * record.attrs['sample_interval']:.6g} s; see .record"
        )
        self.record = record


class Diverged(RuntimeError):
    """A run whose state is no longer finite; what was recorded before is in `record`."""

    def __init__(self, record: xr.Dataset) -> None:
        done = record.sizes["time"] * record.attrs["sample_interval"]
        super().__init__(f"the state is no longer finite after t = {done:.6g} s (step {record.attrs['step']:.3g} s)")
        self.record = record


@dataclass(frozen=True)
class Timing:
    """Step and sampling of a run.

    Attributes
    ----------
    step : float
        Time step [s].
    ratio : int
        Steps per recorded sample.
    samples : int
        Number of samples to record.
    """

    step: float
    ratio: int
    samples: int

    @property
    def interval(self) -> float:
        """Time between samples [s]."""
        return self.step * self.ratio


class Run:
    """One march: the flat arrays of a system under a scheme, its state, and its record."""

    def __init__(
        self,
        system: System,
        arrays: Assembly,
        scheme: Scheme,
        timing: Timing,
        probes: Sequence[Probe],
        start: xr.Dataset | None,
        title: str,
    ) -> None:
        self.system, self.arrays, self.scheme = system, arrays, scheme
        self.timing, self.probes, self.title = timing, probes, title
        self.block, self.loads = coefficient_block(arrays, scheme, timing.step)
        self.constants = constants(system, arrays, self.block, timing.step)
        self.probe_blocks = probe_blocks(arrays, timing.step)
        self.first_step = 0
        if start is None:
            self.state, self.carried = at_rest(system, arrays, scheme, timing.step)
            self.decimator = Decimator(timing.ratio)
            self.initial_energy = float(stored_energy(self.block, self.state))
        else:
            self._go_on_from(start)
        self.record = np.empty((at.COLUMNS, timing.samples))
        self.values = np.empty((timing.samples, len(probes)))
        self.done = 0

    def march(self, watchers: Sequence[Watcher]) -> xr.Dataset:
        """March to the end, or to what stops it, and return the record."""
        began = clock.perf_counter()
        samples_per_chunk = max(1, STEPS_PER_CHUNK // self.timing.ratio)
        whole = self.timing.samples * self.timing.interval
        ended, filled = at.FINISHED, 0
        with DeferredInterrupt() as interrupt:
            while self.done < self.timing.samples and ended == at.FINISHED and not interrupt.requested:
                count = min(samples_per_chunk, self.timing.samples - self.done)
                raw, completed, ended = self._chunk(self.state, self.carried, self.done, count)
                self.done += completed
                filled = self._keep(self.decimator.feed(raw), filled)
                seconds = clock.perf_counter() - began
                try:
                    for watch in watchers:
                        watch(Progress(self.done * self.timing.interval, whole, seconds))
                except KeyboardInterrupt:
                    interrupt.requested = True
        interrupted = interrupt.requested and self.done < self.timing.samples
        tail = self.decimator.tail
        self._look_ahead(filled, ended)
        words = "interrupted" if interrupted else ENDED[ended]
        record = self._dataset(words, clock.perf_counter() - began, tail)
        if interrupted:
            raise Interrupted(record)
        if ended == at.NOT_FINITE:
            raise Diverged(record)
        return record

    def _chunk(self, state: Array, carried: Array, first_sample: int, count: int) -> tuple[Array, int, int]:
        """March `count` samples and return (probes at the steps done, samples done, what ended the march)."""
        ratio, step = self.timing.ratio, self.timing.step
        first = self.first_step + first_sample * ratio
        times = np.arange(first, first + count * ratio + 1) * step
        signals = np.stack([signal(times[:-1], step) for signal in self.arrays.signals], axis=1)
        raw = np.empty((count * ratio, len(self.probes)))
        record = np.empty((count, at.COLUMNS))
        completed, ended = march(
            ratio,
            np.array(self.arrays.sizes),
            self.constants,
            self.block,
            state,
            carried,
            self.loads,
            signals,
            np.ascontiguousarray(self.arrays.imposed(times, step), dtype=float),
            *self.probe_blocks,
            record,
            raw,
        )
        kept = min(completed, self.timing.samples - first_sample)
        self.record[:, first_sample : first_sample + kept] = record[:kept].T
        return raw[: completed * ratio], completed, ended

    def _keep(self, samples: Array, filled: int) -> int:
        count = min(samples.shape[0], self.timing.samples - filled)
        self.values[filled : filled + count] = samples[:count]
        return filled + count

    def _look_ahead(self, filled: int, ended: int) -> None:
        """Complete the last samples of the probes from a march of a copy beyond the end, or from the last value."""
        if not self.probes or filled >= self.done:
            return
        raw = np.empty((0, len(self.probes)))
        if ended == at.FINISHED:
            beyond = -(-self.decimator.lookahead // self.timing.ratio)
            raw, _, _ = self._chunk(self.state.copy(), self.carried.copy(), self.done, beyond)
        missing = self.decimator.lookahead - raw.shape[0]
        if missing > 0:
            last = raw[-1:] if raw.shape[0] else self.decimator.last
            last = np.zeros((1, len(self.probes))) if last is None else last
            raw = np.concatenate([raw, np.repeat(last, missing + self.timing.ratio, axis=0)])
        self._keep(self.decimator.feed(raw), filled)

    def _go_on_from(self, start: xr.Dataset) -> None:
        instance("start", start, xr.Dataset)
        needed = ("state_modal", "state_carried", "state_raw")
        if any(name not in start for name in needed):
            raise ValueError(f"start must be a record of simulate with its final state, got variables {list(start)}")
        attributes = start.attrs
        if attributes["ended"] in ("off the track", "not finite"):
            raise ValueError(f"start must be a run that can go on, got one that ended {attributes['ended']!r}")
        expected = {
            "scheme": self.scheme.name,
            "step": self.timing.step,
            "steps_per_sample": self.timing.ratio,
        }
        for name, value in expected.items():
            if attributes[name] != value:
                raise ValueError(f"start must have the same {name} as this run, {value!r}, got {attributes[name]!r}")
        if start["state_modal"].shape[1] != self.arrays.mode_count:
            raise ValueError(
                f"start must have the same number of modes as this system, {self.arrays.mode_count}, "
                f"got {start['state_modal'].shape[1]}"
            )
        if start["state_raw"].shape[1] != len(self.probes):
            raise ValueError(
                f"start must have the same number of probes, {len(self.probes)}, got {start['state_raw'].shape[1]}"
            )
        before, now = (
            tomllib.loads(text) for text in (attributes["scenario"], scenario_toml(self.system, self.probes, {}))
        )
        for path in FROZEN:
            old, new = (_at(tables, path) for tables in (before, now))
            if old != new:
                raise ValueError(f"start must have the same {'.'.join(path)} as this run, {new!r}, got {old!r}")
        self.state = np.array(start["state_modal"].values, dtype=float)
        self.carried = np.array(start["state_carried"].values, dtype=float)
        self.first_step = int(attributes["last_step"])
        self.decimator = Decimator(self.timing.ratio, np.array(start["state_raw"].values, dtype=float))
        self.initial_energy = float(attributes["initial_energy"])

    def _dataset(self, ended: str, wall_time: float, tail: Array | None) -> xr.Dataset:
        timing, done = self.timing, self.done
        record = self.record[:, :done]
        columns = {name: record[column] for name, column in COLUMN.items()}
        columns["impact_loss"] = columns["convection_work"] - columns["friction_loss"] - columns["contact_work"]
        columns["ledger_residual"] = (
            (columns["kinetic_and_elastic"] - self.initial_energy)
            + columns["damping_loss"]
            - columns["drive_work"]
            - columns["contact_work"]
        )
        first_sample = self.first_step // timing.ratio
        last_step = self.first_step + done * timing.ratio
        simulation = {
            "duration": self.first_step * timing.step + timing.samples * timing.interval,
            "scheme": self.scheme.name,
            "step": timing.step,
            "sample_rate": float(f"{1.0 / timing.interval:.12g}"),
        }
        attributes: dict[str, Any] = {
            "title": self.title,
            "source": f"stridula {__version__}",
            "stridula_version": __version__,
            "scenario": scenario_toml(self.system, self.probes, simulation),
            "scheme": self.scheme.name,
            "step": timing.step,
            "steps_per_sample": timing.ratio,
            "sample_interval": timing.interval,
            "modes": self.arrays.mode_count,
            "slider_modes": self.arrays.sizes[0],
            "track_bending_modes": self.arrays.sizes[1],
            "track_axial_modes": self.arrays.sizes[2],
            "initial_energy": self.initial_energy,
            "last_step": last_step,
            "wall_time": wall_time,
            "ended": ended,
        }
        return to_dataset(
            (first_sample + np.arange(1, done + 1)) * timing.interval,
            columns,
            record[at.SEPARATED : at.SLIDING + 1].T,
            self.probes,
            self.values[:done],
            State(self.state, self.carried, np.empty((0, len(self.probes))) if tail is None else tail),
            attributes,
        )


def _at(tables: dict[str, Any], path: Sequence[str]) -> Any:
    """Return the value at a path of nested tables."""
    value: Any = tables
    for name in path:
        value = value[name]
    return value
