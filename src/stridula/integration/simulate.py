"""The only Python time loop: check, flatten, march in chunks, label."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from .._kernels import layout as at
from .._kernels.march import march, stored_energy
from ..assembly import Assembly, assemble
from ..bodies.modes import Array
from ..checks import instance, positive
from ..records import Acceleration, Probe
from ..records.dataset import State, to_dataset
from ..records.provenance import scenario_toml
from ..system import System
from ..version import __version__
from .decimation import Decimator
from .interrupts import DeferredInterrupt
from .schemes import CentralDifference, ExactModal, Scheme
from .watchers import Progress, Watcher

STEPS_PER_CHUNK = 20_000
LARGEST_RECORD = 8e9
ENDED = {at.FINISHED: "finished", at.OFF_TRACK: "off the track", at.NOT_FINITE: "not finite"}


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


def simulate(
    system: System,
    duration: float,
    *,
    scheme: Scheme | None = None,
    step: float | None = None,
    sample_rate: float = 100e3,
    probes: Sequence[Probe] | None = None,
    start: xr.Dataset | None = None,
    watchers: Sequence[Watcher] = (),
    title: str = "",
) -> xr.Dataset:
    """March a system in time and return its record.

    Parameters
    ----------
    system : System
        What to simulate, at rest at the start unless a drive or `start` says otherwise.
    duration : float
        Time to simulate [s], rounded to whole sample intervals.
    scheme : CentralDifference or ExactModal, optional
        Time scheme, the exact modal one if left out.
    step : float, optional
        Time step [s]; if left out, the scheme's stated fraction of its limit for the modes kept, lowered to a whole
        division of the sample interval.
    sample_rate : float, optional
        Samples per second to record [Hz]; with a step given, the nearest rate at which a sample is a whole number
        of steps.
    probes : sequence of Displacement, Velocity, Acceleration or Reaction, optional
        What else to record; the acceleration of the track's centre along y if left out.
    start : xarray.Dataset, optional
        A record of the same system, scheme and step to go on from; the new record begins where it ended.
    watchers : sequence of callable, optional
        Called with a `Progress` between chunks of the march.
    title : str, optional
        Title of the record.

    Returns
    -------
    xarray.Dataset
        Forces (means over each sample interval), contact, energies and probes over ``time`` [s], with units and
        meanings in the attributes. ``attrs["ended"]`` is ``finished`` or ``off the track``; ``attrs["scenario"]`` is
        TOML that runs it again. The forces follow the convention: normal compressive, tangential on the track
        along +x.

    Raises
    ------
    ValueError
        If an argument is out of its range, among them a step at or beyond the limit of the scheme.
    Interrupted
        On Ctrl-C, with the record so far.
    Diverged
        If the state is no longer finite, with the record so far.
    """
    instance("system", system, System)
    chosen: Scheme = scheme or ExactModal()
    instance("scheme", chosen, (CentralDifference, ExactModal))
    declared = tuple(probes) if probes is not None else (Acceleration(system.track.centre, "y"),)
    for number, probe in enumerate(declared):
        instance(f"probes[{number}]", probe, Probe.__args__)
    arrays = assemble(system, declared)
    timing = choose_timing(arrays, chosen, duration, step, sample_rate)
    if len(declared) + at.COLUMNS > LARGEST_RECORD / 8 / max(timing.samples, 1):
        raise ValueError(
            f"duration must give a record below {LARGEST_RECORD / 1e9:g} GB, got {duration!r} s at "
            f"{1 / timing.interval:.6g} Hz: lower sample_rate"
        )
    run = _Run(system, arrays, chosen, timing, declared, start, title)
    return run.march(watchers)


def choose_timing(arrays: Assembly, scheme: Scheme, duration: float, step: float | None, sample_rate: float) -> Timing:
    """Return the step and the sampling that the arguments of `simulate` ask for."""
    positive("duration", duration)
    wanted = 1.0 / positive("sample_rate", sample_rate)
    limit = scheme.limit(arrays.angular_frequency, arrays.damping)
    if step is None:
        ratio = max(1, int(np.ceil(wanted / (scheme.default_fraction * limit) - 1e-9)))
        step = wanted / ratio
    elif positive("step", step) >= limit:
        raise ValueError(f"step must be below the {scheme.name} scheme's limit of {limit:.6g} s, got {step!r}")
    else:
        ratio = max(1, round(wanted / step))
    return Timing(step, ratio, max(1, round(duration / (step * ratio))))


class _Run:
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
        self.system, self.arrays, self.scheme, self.timing, self.probes = (
            system,
            arrays,
            scheme,
            timing,
            probes,
        )
        self.title = title
        self.block, self.loads = _blocks(arrays, scheme, timing.step)
        self.constants = _constants(system, arrays, self.block, timing.step)
        self.probe_rows, self.probe_spans, self.probe_direct = _probe_blocks(arrays, timing.step)
        self.first_step = 0
        if start is None:
            self.state, self.carried = _at_rest(system, arrays, scheme, timing.step)
            self.decimator = Decimator(timing.ratio)
            self.initial_energy = float(stored_energy(self.block, self.state))
        else:
            self._go_on_from(start)
        self.record = np.empty((timing.samples, at.COLUMNS))
        self.values = np.empty((timing.samples, len(probes)))
        self.done = 0
        self.raw_tail = np.empty((0, len(probes)))

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
                self._remember(raw)
                seconds = clock.perf_counter() - began
                try:
                    for watch in watchers:
                        watch(Progress(self.done * self.timing.interval, whole, seconds))
                except KeyboardInterrupt:
                    interrupt.requested = True
        interrupted = interrupt.requested and self.done < self.timing.samples
        filled = self._look_ahead(filled, ended)
        words = "interrupted" if interrupted else ENDED[ended]
        record = self._dataset(words, clock.perf_counter() - began)
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
        signals = np.array([signal(times[:-1]) for signal in self.arrays.signals])
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
            np.ascontiguousarray(self.arrays.imposed(times), dtype=float),
            self.probe_rows,
            self.probe_spans,
            self.probe_direct,
            record,
            raw,
        )
        kept = min(completed, self.timing.samples - first_sample)
        self.record[first_sample : first_sample + kept] = record[:kept]
        return raw[: completed * ratio], completed, ended

    def _keep(self, samples: Array, filled: int) -> int:
        count = min(samples.shape[0], self.timing.samples - filled)
        self.values[filled : filled + count] = samples[:count]
        return filled + count

    def _remember(self, raw: Array) -> None:
        joined = np.concatenate([self.raw_tail, raw])
        self.raw_tail = joined[max(0, joined.shape[0] - self.decimator.memory) :]

    def _look_ahead(self, filled: int, ended: int) -> int:
        """Complete the last samples of the probes from a march of a copy beyond the end, or from the last value."""
        if not self.probes or filled >= self.done:
            return filled
        raw = np.empty((0, len(self.probes)))
        if ended == at.FINISHED:
            beyond = -(-self.decimator.lookahead // self.timing.ratio)
            raw, _, _ = self._chunk(self.state.copy(), self.carried.copy(), self.done, beyond)
        missing = self.decimator.lookahead - raw.shape[0]
        if missing > 0:
            last = raw[-1:] if raw.shape[0] else self.raw_tail[-1:]
            last = last if last.shape[0] else np.zeros((1, len(self.probes)))
            raw = np.concatenate([raw, np.repeat(last, missing + self.timing.ratio, axis=0)])
        return self._keep(self.decimator.feed(raw), filled)

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
        self.state = np.array(start["state_modal"].values, dtype=float)
        self.carried = np.array(start["state_carried"].values, dtype=float)
        self.first_step = int(attributes["last_step"])
        self.decimator = Decimator(self.timing.ratio, np.array(start["state_raw"].values, dtype=float))
        self.initial_energy = float(attributes["initial_energy"])

    def _dataset(self, ended: str, wall_time: float) -> xr.Dataset:
        timing, done = self.timing, self.done
        record = self.record[:done]
        names = {
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
        columns = {name: record[:, column].copy() for name, column in names.items()}
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
            "duration": timing.samples * timing.interval,
            "scheme": self.scheme.name,
            "step": timing.step,
            "sample_rate": 1.0 / timing.interval,
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
            record[:, [at.SEPARATED, at.STICKING, at.SLIDING]].copy(),
            self.probes,
            self.values[:done],
            State(self.state, self.carried, self.raw_tail),
            attributes,
        )


def _blocks(arrays: Assembly, scheme: Scheme, step: float) -> tuple[Array, Array]:
    """Return the coefficient block of the march and the load increments for unit signals."""
    k = scheme.coefficients(arrays.angular_frequency, arrays.damping, step)
    block = np.zeros((at.COEFFICIENT_ROWS, arrays.mode_count))
    block[at.B], block[at.R], block[at.CH] = k.b, k.r, k.c * step
    block[at.HALF_OVER_CH] = 0.5 / block[at.CH]
    block[at.HALF_LOSS] = (1.0 - k.b) / 2.0
    block[[at.TIP_X, at.TIP_Y], : arrays.sizes[0]] = arrays.tip
    return block, arrays.loads * k.load


def _constants(system: System, arrays: Assembly, block: Array, step: float) -> Array:
    track, contact = system.track, system.contact
    ch = block[at.CH, : arrays.sizes[0]]
    tip_x, tip_y = arrays.tip
    constants = np.empty(at.CONSTANTS)
    constants[at.STEP] = step
    constants[at.START] = contact.at
    constants[at.GAP] = contact.gap
    constants[at.WAVENUMBER] = np.pi / track.length
    constants[at.AMPLITUDE] = track.amplitude
    constants[at.LENGTH] = track.length
    constants[at.MU] = contact.friction.coefficient
    constants[at.W_NN] = np.sum(ch * tip_y * tip_y)
    constants[at.W_NT] = np.sum(ch * tip_x * tip_y)
    constants[at.W_TT] = np.sum(ch * tip_x * tip_x)
    return constants


def _probe_blocks(arrays: Assembly, step: float) -> tuple[Array, Array, Array]:
    """Return the probes' rows on q, d[n+1] + d[n] and d[n+1] - d[n], their non-zero spans, and direct shares."""
    count = len(arrays.probes)
    rows = np.zeros((count, 3, arrays.mode_count))
    spans = np.zeros((count, 3, 2), dtype=np.int64)
    direct = np.zeros((count, len(arrays.signals)))
    scale = np.array([1.0, 0.5 / step, 1.0 / step**2])
    for p, probe in enumerate(arrays.probes):
        rows[p] = probe.rows * scale[:, None]
        direct[p] = probe.direct
        for kind in range(3):
            used = np.flatnonzero(rows[p, kind])
            if used.size:
                spans[p, kind] = used[0], used[-1] + 1
    return rows, spans, direct


def _at_rest(system: System, arrays: Assembly, scheme: Scheme, step: float) -> tuple[Array, Array]:
    """Return the state at the start, whose first increment makes the scheme of second order from the first step on."""
    zero = np.zeros(1)
    factors = np.array([signal(zero)[0] for signal in arrays.signals[: arrays.loads.shape[0]]])
    state = np.zeros((2, arrays.mode_count))
    state[at.D] = scheme.first_increment(
        arrays.angular_frequency, arrays.damping, step, state[at.Q], arrays.velocity, factors @ arrays.loads
    )
    carried = np.zeros(at.CARRIED)
    start = system.contact.at
    before = arrays.tip[0] @ state[at.D, : arrays.sizes[0]]
    carried[at.MATERIAL] = carried[at.ABSCISSA] = start
    carried[at.ABSCISSA_BEFORE] = start - before - (arrays.imposed(zero + step)[0] - arrays.imposed(zero)[0])
    return state, carried
