"""One run: the march in chunks, its state, and its record."""

from __future__ import annotations

import time as clock
import tomllib
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
import xarray as xr

from .._kernels import layout as at
from ..assembly import Assembly
from ..bodies.modes import Array
from ..checks import instance
from ..contact import LAWS
from ..records import Probe
from ..records.dataset import to_dataset
from ..records.provenance import scenario_toml
from ..records.state import State
from ..system import System
from ..version import __version__
from .blocks import blocks_of
from .contact_solve import GaussSeidel
from .decimation import Decimator
from .interrupts import DeferredInterrupt
from .marches import March, imposed_on, march_of
from .schemes import Scheme
from .start import state_at_start
from .stops import ENDED, Diverged, Interrupted, contact_words, energy_created
from .watchers import Progress, Watcher

# Laws whose internal state is carried on: another law has no use for it.
STATEFUL = tuple(law.law for law in LAWS if law.state_units)
STEPS_PER_CHUNK = 20_000
CONTACT_COLUMN = {
    "normal_force": at.NORMAL_FORCE,
    "tangential_force": at.TANGENTIAL_FORCE,
    "contact_position": at.CONTACT_POSITION,
    "contact_height": at.CONTACT_HEIGHT,
    "gap": at.CONTACT_GAP,
    "slip_velocity": at.SLIP_VELOCITY,
    "jammed_steps": at.JAMMED,
    "friction_state": at.LAW_STATE,
}
ENERGY_COLUMN = {
    "kinetic_and_elastic": at.STORED,
    "drive_work": at.DRIVE_WORK,
    "contact_work": at.CONTACT_WORK,
    "friction_loss": at.FRICTION_LOSS,
    "convection_work": at.CONVECTION_WORK,
    "damping_loss": at.DAMPING_LOSS,
    "contact_sweeps": at.ITERATIONS,
    "unsolved_steps": at.UNSOLVED,
}


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
        solve: GaussSeidel,
        start: xr.Dataset | None,
        title: str,
    ) -> None:
        self.system, self.arrays, self.scheme = system, arrays, scheme
        self.timing, self.probes, self.solve, self.title = timing, probes, solve, title
        blocks = blocks_of(arrays, scheme, timing.step)
        self.dissipative = not any(contact.friction.state_units for contact in system.contacts)
        self.first_step = 0
        if start is None:
            state = state_at_start(arrays, scheme, timing.step, blocks, solve)
            self.decimator = Decimator(timing.ratio)
            self.initial_energy = float(state.energies[at.STORED])
        else:
            state = self._go_on_from(start)
        self.on_the_way = march_of(blocks, state, timing.step, timing.ratio, solve)
        self.energies = state.energies
        self.largest_energy = float(np.abs(self.energies[: at.DAMPING_LOSS + 1]).max())
        self.energy_of_loads = blocks.modes.energy_of_loads()
        self.damped_alone = not arrays.coupled
        self.energy_record = np.empty((at.ENERGIES, timing.samples))
        self.record = np.empty((at.COLUMNS, len(system.contacts), timing.samples))
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
                raw, completed, ended = self._chunk(self.on_the_way, self.done, count)
                self.done += completed
                filled = self._keep(self.decimator.feed(raw), filled)
                seconds = clock.perf_counter() - began
                try:
                    for watch in watchers:
                        watch(Progress(self.done * self.timing.interval, whole, seconds))
                except KeyboardInterrupt:
                    interrupt.requested = True
        cut_short = interrupt.requested and self.done < self.timing.samples
        tail = self.decimator.tail
        self._look_ahead(filled, ended)
        words = "interrupted" if cut_short else ENDED[ended]
        record = self._dataset(words, clock.perf_counter() - began, tail)
        if interrupt.requested:
            raise Interrupted(record)
        if ended not in (at.FINISHED, at.OFF_TRACK):
            raise Diverged(record, contact_words(self.system.contact_names, self.on_the_way.states[0].carried))
        return record

    def _chunk(self, march: March, first_sample: int, count: int) -> tuple[Array, int, int]:
        """March `count` samples and return (probes at the steps done, samples done, what ended the march)."""
        ratio = self.timing.ratio
        imposed = imposed_on(self.arrays, self.first_step + first_sample * ratio, count * ratio, self.timing.step)
        before = march.states[0].energies.copy()
        (chunk,) = march.advance([imposed], count)
        completed, ended = chunk.completed, chunk.ended
        bad = np.flatnonzero(~np.isfinite(chunk.energies[:completed]).all(axis=1))
        if bad.size:
            completed, ended = int(bad[0]), at.NOT_FINITE
        done = chunk.energies[:completed].T
        wrong = energy_created(
            done,
            before,
            self.initial_energy,
            self.largest_energy,
            self.energy_of_loads,
            self.dissipative,
            self.damped_alone,
        )
        if wrong is not None:
            completed, ended = wrong, at.ENERGY_CREATED
        elif completed:
            self.largest_energy = max(self.largest_energy, float(np.abs(done[: at.DAMPING_LOSS + 1]).max()))
        kept = slice(first_sample, min(first_sample + completed, self.timing.samples))
        size = kept.stop - kept.start
        self.energy_record[:, kept] = done[:, :size]
        self.record[:, :, kept] = chunk.contacts[:size].transpose(2, 1, 0)
        return chunk.raw[: completed * ratio], completed, ended

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
            raw, _, _ = self._chunk(self.on_the_way.copy(), self.done, beyond)
        missing = self.decimator.lookahead - raw.shape[0]
        if missing > 0:
            last = raw[-1:] if raw.shape[0] else self.decimator.last
            last = np.zeros((1, len(self.probes))) if last is None else last
            raw = np.concatenate([raw, np.repeat(last, missing + self.timing.ratio, axis=0)])
        self._keep(self.decimator.feed(raw), filled)

    def _go_on_from(self, start: xr.Dataset) -> State:
        instance("start", start, xr.Dataset)
        needed = ("state_modal", "state_remainder", "state_carried", "state_energies", "state_raw")
        if any(name not in start for name in needed):
            raise ValueError(f"start must be a record of simulate with its final state, got variables {list(start)}")
        attributes = start.attrs
        if attributes["ended"] not in ("finished", "interrupted"):
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
        _check_frozen(_frozen(before), _frozen(now))
        self.first_step = int(attributes["last_step"])
        self.decimator = Decimator(self.timing.ratio, np.array(start["state_raw"].values, dtype=float))
        self.initial_energy = float(attributes["initial_energy"])
        return State(
            *(
                np.array(start[f"state_{name}"].values, dtype=float, order="C")
                for name in ("modal", "remainder", "carried", "energies")
            )
        )

    def _dataset(self, ended: str, wall_time: float, tail: Array | None) -> xr.Dataset:
        timing, done = self.timing, self.done
        record, energies = self.record[:, :, :done], self.energy_record[:, :done]
        columns = {name: record[column] for name, column in CONTACT_COLUMN.items()}
        sums = {name: energies[column] for name, column in ENERGY_COLUMN.items()}
        sums["impact_loss"] = sums["convection_work"] - sums["friction_loss"] - sums["contact_work"]
        sums["ledger_residual"] = (
            (sums["kinetic_and_elastic"] - self.initial_energy)
            + sums["damping_loss"]
            - sums["drive_work"]
            - sums["contact_work"]
        )
        first_sample = self.first_step // timing.ratio
        last_step = self.first_step + done * timing.ratio
        simulation: dict[str, Any] = {
            "duration": self.first_step * timing.step + timing.samples * timing.interval,
            "scheme": self.scheme.name,
            "step": timing.step,
            "sample_rate": float(f"{1.0 / timing.interval:.12g}"),
        }
        if self.solve != GaussSeidel():
            simulation["contact_solve"] = asdict(self.solve)
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
            "contact_tolerance": self.solve.tolerance,
            "initial_energy": self.initial_energy,
            "last_step": last_step,
            "wall_time": wall_time,
            "ended": ended,
        }
        return to_dataset(
            self.system,
            (first_sample + np.arange(1, done + 1)) * timing.interval,
            columns,
            record[at.SEPARATED : at.SLIDING + 1].transpose(2, 1, 0),
            sums,
            self.probes,
            self.values[:done],
            self.on_the_way.states[0],
            np.empty((0, len(self.probes))) if tail is None else tail,
            attributes,
        )


def _frozen(tables: dict[str, Any]) -> dict[str, Any]:
    """Return what a run that goes on from another must share with it: all but drives, friction and timing."""
    kept = {name: value for name, value in tables.items() if name not in ("drives", "simulation")}
    kept["probes"] = tables["simulation"]["probes"]
    if "contact" in kept:
        kept["contact"] = _without_friction(kept["contact"])
    if "contacts" in kept:
        kept["contacts"] = [_without_friction(contact) for contact in kept["contacts"]]
    return kept


def _without_friction(contact: dict[str, Any]) -> dict[str, Any]:
    name = contact["friction"]["law"]
    return {**contact, "friction": name if name in STATEFUL else None}


def _check_frozen(before: dict[str, Any], now: dict[str, Any], path: str = "") -> None:
    """Raise a ValueError that names the first value that differs."""
    for name in dict.fromkeys((*now, *before)):
        old, new = before.get(name), now.get(name)
        if isinstance(old, dict) and isinstance(new, dict):
            _check_frozen(old, new, f"{path}{name}.")
        elif old != new:
            raise ValueError(f"start must have the same {path}{name} as this run, {new!r}, got {old!r}")
