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
from .._kernels.march import march, stored_energy
from ..assembly import Assembly
from ..bodies.modes import Array
from ..checks import instance
from ..contact import LAWS
from ..records import Probe
from ..records.dataset import State, to_dataset
from ..records.provenance import scenario_toml
from ..system import System
from ..version import __version__
from .blocks import contact_blocks, probe_blocks, recurrence
from .contact_solve import GaussSeidel
from .decimation import Decimator
from .interrupts import DeferredInterrupt
from .schemes import Scheme
from .start import at_start
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
        self.modes = recurrence(arrays, scheme, timing.step)
        self.contacts = contact_blocks(arrays, self.modes)
        self.probe_blocks = probe_blocks(arrays, timing.step)
        self.dissipative = not any(contact.friction.state_units for contact in system.contacts)
        self.first_step = 0
        if start is None:
            self.state, self.carried = at_start(arrays, scheme, timing.step, self.modes, self.contacts, solve)
            self.decimator = Decimator(timing.ratio)
            self.initial_energy = float(stored_energy(self.modes.block, self.modes.matrices, self.state))
            self.energies = np.zeros(at.ENERGIES)
            self.energies[at.STORED] = self.initial_energy
        else:
            self._go_on_from(start)
        self.largest_energy = float(np.abs(self.energies[: at.DAMPING_LOSS + 1]).max())
        self.energy_of_loads = self.modes.energy_of_loads()
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
                raw, completed, ended = self._chunk(self.state, self.carried, self.energies, self.done, count)
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
            raise Diverged(record, contact_words(self.system.contact_names, self.carried))
        return record

    def _chunk(
        self, state: Array, carried: Array, energies: Array, first_sample: int, count: int
    ) -> tuple[Array, int, int]:
        """March `count` samples and return (probes at the steps done, samples done, what ended the march)."""
        ratio, step = self.timing.ratio, self.timing.step
        first = self.first_step + first_sample * ratio
        times = np.arange(first - 1, first + count * ratio + 1) * step
        signals = np.stack([signal(times[1:-1], step) for signal in self.arrays.signals], axis=1)
        raw = np.empty((count * ratio, len(self.probes)))
        before, record = energies.copy(), np.empty((count, len(self.system.contacts), at.COLUMNS))
        energy_record = np.empty((count, at.ENERGIES))
        completed, ended = march(
            ratio,
            step,
            self.solve.tolerance,
            self.solve.sweeps,
            self.modes.block,
            self.modes.matrices,
            self.contacts.constants,
            self.contacts.laws,
            self.contacts.spans,
            self.contacts.rows,
            self.contacts.compliance,
            state,
            carried,
            energies,
            self.modes.loads,
            signals,
            self.arrays.motion(times, step),
            *self.probe_blocks,
            energy_record,
            record,
            raw,
        )
        bad = np.flatnonzero(~np.isfinite(energy_record[:completed]).all(axis=1))
        if bad.size:
            completed, ended = int(bad[0]), at.NOT_FINITE
        done = energy_record[:completed].T
        wrong = energy_created(
            done, before, self.initial_energy, self.largest_energy, self.energy_of_loads, self.dissipative
        )
        if wrong is not None:
            completed, ended = wrong, at.ENERGY_CREATED
        elif completed:
            self.largest_energy = max(self.largest_energy, float(np.abs(done[: at.DAMPING_LOSS + 1]).max()))
        kept = slice(first_sample, min(first_sample + completed, self.timing.samples))
        size = kept.stop - kept.start
        self.energy_record[:, kept] = done[:, :size]
        self.record[:, :, kept] = record[:size].transpose(2, 1, 0)
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
            raw, _, _ = self._chunk(self.state.copy(), self.carried.copy(), self.energies.copy(), self.done, beyond)
        missing = self.decimator.lookahead - raw.shape[0]
        if missing > 0:
            last = raw[-1:] if raw.shape[0] else self.decimator.last
            last = np.zeros((1, len(self.probes))) if last is None else last
            raw = np.concatenate([raw, np.repeat(last, missing + self.timing.ratio, axis=0)])
        self._keep(self.decimator.feed(raw), filled)

    def _go_on_from(self, start: xr.Dataset) -> None:
        instance("start", start, xr.Dataset)
        needed = ("state_modal", "state_carried", "state_energies", "state_raw")
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
        self.state = np.array(start["state_modal"].values, dtype=float)
        self.carried = np.array(start["state_carried"].values, dtype=float)
        self.energies = np.array(start["state_energies"].values, dtype=float)
        self.first_step = int(attributes["last_step"])
        self.decimator = Decimator(self.timing.ratio, np.array(start["state_raw"].values, dtype=float))
        self.initial_energy = float(attributes["initial_energy"])

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
            State(self.state, self.carried, self.energies, np.empty((0, len(self.probes))) if tail is None else tail),
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
