"""One run: its state and its record, chunk by chunk."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from copy import deepcopy
from dataclasses import asdict
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from .._kernels.layout import columns as at
from ..arrays import Array
from ..linear.free_motions import free_words
from ..lowering import Assembly
from ..lowering.blocks import blocks_of
from ..lowering.model_ends import notes_of
from ..lowering.passages import notes_of_passage
from ..records import Probe
from ..records.dataset import RECORDED, over_time, to_dataset
from ..records.plain import PlainRecord
from ..records.provenance import scenario_toml
from ..records.state import LAYOUT, State
from ..records.variables import ALONG_TANGENTS, FRICTION_STATE, STATUS_SHARE
from ..system import System
from ..version import __version__
from .belief import Belief
from .contact_solve import GaussSeidel
from .equilibrium_start import in_equilibrium, note_of_start
from .marches import Chunk, Excitation, Impositions
from .probe_records import ProbeRecords
from .restart import imposed_at, motion_about, moved_on, state_of
from .settings import Settings
from .start import state_at_start, stored_in_contacts
from .stops import ENDED, contact_words, divergence_words, rank_words
from .surface_records import ALL_POINTS, SurfaceRecord
from .timing import Timing

CONTACT_COLUMN = {
    "normal_force": at.NORMAL_FORCE,
    "tangential_force": at.TANGENTIAL_FORCE,
    "contact_position": at.CONTACT_POSITION,
    "contact_height": at.CONTACT_HEIGHT,
    "gap": at.CONTACT_GAP,
    "slip_velocity": at.SLIP_VELOCITY,
    "jammed_steps": at.JAMMED,
    "landings": at.LANDINGS,
    "friction_state": at.LAW_STATE,
    "status": at.DOMINANT,
    "temperature": at.HOT,
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
    "heat": at.HEAT,
    "stored_heat": at.STORED_HEAT,
}
# Columns along both tangents of contacts in space.
ALONG_BOTH = {
    "tangential_force": (at.TANGENTIAL_FORCE, at.TANGENTIAL_FORCE_B),
    "contact_position": (at.CONTACT_POSITION, at.CONTACT_POSITION_B),
    "slip_velocity": (at.SLIP_VELOCITY, at.SLIP_VELOCITY_B),
    "friction_state": (at.LAW_STATE, at.LAW_STATE_B),
}
ALONG_B = {b for _, b in ALONG_BOTH.values()}


class Midway(NamedTuple):
    """A state within a motion, from which a run begins.

    Attributes
    ----------
    state : State
        The state, without energies.
    first_step : int
        Number of steps before it.
    """

    state: State
    first_step: int


class Run:
    """One run: the arrays of a system under a time scheme, its state and its record."""

    def __init__(
        self,
        system: System,
        arrays: Assembly,
        probes: Sequence[Probe],
        settings: Settings,
        timing: Timing,
        *,
        start: xr.Dataset | None,
        title: str,
        surfaces: SurfaceRecord | None = None,
        midway: Midway | None = None,
    ) -> None:
        scheme = settings.scheme
        self.system, self.arrays, self.probes = system, arrays, probes
        self.settings, self.timing, self.title = settings, timing, title
        self.blocks = blocks_of(arrays, scheme, timing.step)
        self.described, self.offset = arrays.motion, np.zeros((len(arrays.contacts), at.MOTIONS))
        before = None
        if midway is not None:
            self.state, self.first_step = deepcopy(midway.state), midway.first_step
            stored = self.blocks.modes.stored_energy(self.state.modal)
            self.initial_energy = float(stored + stored_in_contacts(arrays, self.state.carried))
            self.state.energies[at.STORED] = self.initial_energy
        elif start is None:
            placed = in_equilibrium(system, arrays)
            self.state = state_at_start(placed, scheme, timing.step, self.blocks, settings.solve)
            self.first_step, self.initial_energy = 0, float(self.state.energies[at.STORED])
        else:
            self.state = state_of(start, system, arrays, scheme, timing, probes)
            self.arrays, self.offset = moved_on(start, system, arrays, self.blocks.modes, self.state, timing.step)
            self.first_step, self.initial_energy = int(start.attrs["last_step"]), float(start.attrs["initial_energy"])
            before = np.array(start["state_raw"].values, dtype=float)
        self.places = self.state.carried[:, at.MATERIAL].copy()
        # Rounding errors of large energies remain when these are gone.
        met = 0.0 if start is None else float(start.attrs.get("largest_energy", 0.0))
        self.belief = Belief(system, arrays, self.blocks, self.state.energies, self.initial_energy, met)
        self.impositions = Impositions(self.arrays, self.blocks, timing.step)
        self.energy_record = np.empty((at.ENERGIES, timing.samples))
        # Compact record of the surfaces.
        self.surfaces = surfaces
        count = len(arrays.contacts) if surfaces is None else len(surfaces.shown)
        self.contact_record = np.empty((at.COLUMNS, count, timing.samples))
        of_bodies = np.array([one.is_of_body for one in arrays.probes], dtype=bool)
        self.probed = ProbeRecords(of_bodies, timing, before)
        self.wanted: Collection[str] = RECORDED
        unused = () if system.has_two_tangents else ALONG_B
        self.columns: tuple[int, ...] = tuple(column for column in range(at.COLUMNS) if column not in unused)
        self.done = 0
        self.ended = at.FINISHED
        self.compile_time = self.wall_time = 0.0

    def keep_only(self, wanted: Collection[str]) -> None:
        """Restrict the plain record to some variables."""
        shares = range(at.SEPARATED, at.SLIDING + 1) if STATUS_SHARE.name in wanted else ()
        columns = [column for name, column in CONTACT_COLUMN.items() if name in wanted]
        if self.system.has_two_tangents:
            columns += [b for name, (_, b) in ALONG_BOTH.items() if name in wanted]
        self.wanted, self.columns = wanted, (*columns, *shares)

    @property
    def has_diverged(self) -> bool:
        """Whether the result is no longer valid."""
        return self.ended not in (at.FINISHED, at.OFF_TRACK)

    @property
    def samples_ahead(self) -> int:
        """Number of samples beyond the end that the low-passes of the probes need."""
        return -(-self.probed.ahead(self.done) // self.timing.ratio) if self.ended == at.FINISHED else 0

    def imposed(self, first_sample: int, samples: int) -> Excitation:
        """Return the imposed signals and motions of the steps of some samples."""
        ratio = self.timing.ratio
        return self.impositions.on(self.first_step + first_sample * ratio, samples * ratio)

    def take(self, chunk: Chunk) -> None:
        """Record a chunk, up to the end of the run."""
        if self.ended != at.FINISHED:
            return
        completed, self.ended = self.belief.of(chunk, self.energy_record, self.done)
        kept = slice(self.done, self.done + completed)
        contacts = chunk.contacts[:completed]
        if self.surfaces is not None:
            contacts = self.surfaces.take(contacts)
        for column in self.columns:
            self.contact_record[column, :, kept] = contacts[:, :, column].T
        self.done += completed
        if self.probes:
            self.probed.take(chunk.raw[: completed * self.timing.ratio])

    def finish(self, state: State, ahead: Chunk | None) -> None:
        """Set the final state, and complete the probes from a chunk beyond it, or from the last value."""
        self.state = state
        self.probed.finish(self.done, None if ahead is None else ahead.raw[: ahead.completed * self.timing.ratio])

    def why_diverged(self) -> str:
        """Return the contacts when the run diverged, and where they matter their rank and free motions, in words."""
        words = contact_words(self.system.contact_names, self.state.carried)
        if self.ended != at.CONTACT_UNSOLVED:
            return words
        free = free_words(self.system)
        moves = f"; nothing but friction holds {free}" if free else ""
        return f"{words}; {rank_words(self.arrays, self.blocks, self.state)}{moves}"

    def told_of_divergence(self) -> str:
        """Return time and cause of the divergence in words."""
        timing = self.timing
        return divergence_words(ENDED[self.ended], self.done * timing.interval, timing.step, self.why_diverged())

    def record(self, interrupted: bool = False, provenance: bool = True) -> xr.Dataset:
        """Return the record, with its scenario in the attributes unless `provenance` is false."""
        timing, done = self.timing, self.done
        last_step, surfaces = self._last_step, self.surfaces
        record = to_dataset(
            self.system,
            self._time(),
            *self._over_time(),
            self.probes,
            (*self.probed.values(done), None if timing.motion_every == 1 else self._time(timing.motion_every)),
            self.state,
            motion=np.concatenate([motion_about(self.described, last_step, timing.step), self.offset[None]]),
            raw=self.probed.state,
            attributes=self._attributes(interrupted, {"scenario": self._scenario()} if provenance else {}),
            shown=None if surfaces is None else dict(zip(surfaces.shown, surfaces.names, strict=True)),
        )
        return record if surfaces is None else surfaces.add_to(record, self.first_step * timing.step, timing.interval)

    def plain_record(self) -> PlainRecord:
        """Return the record as plain arrays, in a fraction of the time."""
        surfaces = self.surfaces
        over = over_time(
            self.system, *self._over_time(), self.wanted, shown=None if surfaces is None else surfaces.shown
        )
        variables = {name: values for name, (_, values) in over.items()}
        names, points = self.system.contact_names, self.system.surface_names
        if surfaces is not None:
            names, points = surfaces.names, ()
        return PlainRecord(self._time(), variables, names, self._attributes(False, {}), points)

    @property
    def _shown(self) -> tuple[Sequence[str], Sequence[int]]:
        """Names of the rows of the record of contacts, and the number of a contact that each represents."""
        if self.surfaces is not None:
            return self.surfaces.names, self.surfaces.shown
        return self.system.contact_names, range(len(self.system.contacts))

    def _notes_of_contacts(self) -> list[str]:
        """Return notes if nothing pressed, as under a load that pulls, and on slips beyond the measured friction."""
        if "normal_force" not in self.wanted:
            # The row has no values.
            return []
        pressed = self.contact_record[at.NORMAL_FORCE, :, : self.done]
        if pressed.size and not pressed.any():
            return ["no contact pressed at any time"]
        if "slip_velocity" not in self.wanted:
            return []
        return [*self._notes_of_speeds(pressed), *self._notes_of_temperatures(), *self._notes_of_profiles()]

    def _notes_of_speeds(self, pressed: Array) -> list[str]:
        """Return a note on what slid farthest beyond the speeds of its measured friction, faces as a whole."""
        names, numbers = self._shown
        measured = np.array([self.system.contacts[number].friction.fastest for number in numbers])
        if not pressed.size or not np.isfinite(measured).any():
            return []
        columns = [at.SLIP_VELOCITY, *([at.SLIP_VELOCITY_B] if self.system.has_two_tangents else [])]
        slips = [self.contact_record[column, :, : self.done] for column in columns]
        speeds = np.where(pressed > 0.0, np.hypot.reduce(slips, axis=0, initial=0.0), 0.0).max(axis=1)
        farthest = int(np.argmax(speeds / measured))
        if speeds[farthest] <= measured[farthest]:
            return []
        return [
            f"{names[farthest]} slid at up to {speeds[farthest]:.3g} m/s, but its friction was measured up to "
            f"{measured[farthest]:.3g} m/s and is taken as constant beyond"
        ]

    def _notes_of_temperatures(self) -> list[str]:
        """Return a note on the contact farthest outside the temperatures of its measured friction."""
        if "temperature" not in self.wanted:
            # The row has no values.
            return []
        found: list[tuple[float, str]] = []
        for name, number, own in zip(*self._shown, self.contact_record[at.HOT, :, : self.done], strict=True):
            given = [temperature for temperature, _ in self.system.contacts[number].friction.at_values]
            if not given or not own.size:
                continue
            for reached, end, beyond in (
                (own.max(), given[-1], own.max() - given[-1]),
                (own.min(), given[0], given[0] - own.min()),
            ):
                words = (
                    f"{name} was at {reached:.4g} degC, but its friction was measured from {given[0]:.4g} to "
                    f"{given[-1]:.4g} degC and is taken as that at {end:.4g} degC beyond"
                )
                found += [(float(beyond), words)] if beyond > 0.0 else []
        return [max(found)[1]] if found else []

    def _notes_of_profiles(self) -> list[str]:
        """Return notes on tips that passed the waves of a profile in few steps, or left it."""
        slips = self.contact_record[at.SLIP_VELOCITY, :, : self.done]
        found: list[str] = []
        for name, number, own in zip(*self._shown, slips, strict=True):
            profile = self.arrays.contacts[number].profile
            if profile is not None:
                found += notes_of_passage(name, profile, self.places[number], own, self.timing.step, self._time())
        return found

    @property
    def _last_step(self) -> int:
        return self.first_step + self.done * self.timing.ratio

    def _time(self, every: int = 1) -> Array:
        """Return the time at the end of each interval of `every` samples [s]."""
        first_sample = self.first_step // self.timing.ratio
        return np.asarray((first_sample + np.arange(every, self.done + 1, every)) * self.timing.interval)

    def _over_time(self) -> tuple[dict[str, Array], Array, dict[str, Array]]:
        """Return the columns of the contacts, their status shares and the energies, up to the end."""
        done = self.done
        record, energies = self.contact_record[:, :, :done], self.energy_record[:, :done]
        columns = {name: record[column] for name, column in CONTACT_COLUMN.items()}
        if self.system.has_two_tangents:
            doubled = (*ALONG_TANGENTS, FRICTION_STATE.name) if self.system.has_state_vectors else ALONG_TANGENTS
            columns |= {name: np.stack([record[one] for one in ALONG_BOTH[name]], axis=-1) for name in doubled}
        sums = {name: energies[column] for name, column in ENERGY_COLUMN.items()}
        if "impact_loss" in self.wanted:
            sums["impact_loss"] = sums["convection_work"] - sums["friction_loss"] - sums["contact_work"]
        if "ledger_residual" in self.wanted:
            sums["ledger_residual"] = (
                (sums["kinetic_and_elastic"] - self.initial_energy)
                + sums["damping_loss"]
                - sums["drive_work"]
                - sums["contact_work"]
            )
        return columns, record[at.SEPARATED : at.SLIDING + 1].transpose(2, 1, 0), sums

    def _attributes(self, interrupted: bool, scenario: dict[str, str]) -> dict[str, Any]:
        """Return the attributes of the record."""
        timing, last_step = self.timing, self._last_step
        notes = notes_of(self.system, self.arrays, timing.samples * timing.interval)
        return {
            "title": self.title,
            "source": f"stridula {__version__}",
            "stridula_version": __version__,
            **scenario,
            "scheme": self.settings.scheme.name,
            "step": timing.step,
            "steps_per_sample": timing.ratio,
            "sample_interval": timing.interval,
            "modes": self.arrays.mode_count,
            "notes": "; ".join([*notes, *note_of_start(self.system), *self._notes_of_contacts()]),
            "contact_tolerance": self.settings.solve.tolerance,
            "initial_energy": self.initial_energy,
            "largest_energy": self.belief.largest_energy,
            "state_layout": LAYOUT,
            "last_step": last_step,
            **(imposed_at(self.arrays, last_step, timing.step) if self.system.imposed_velocity else {}),
            "compile_time": self.compile_time,
            "wall_time": self.wall_time,
            "ended": "interrupted" if interrupted and self.done < timing.samples else ENDED[self.ended],
        }

    def _scenario(self) -> str:
        """Return the scenario that repeats this run, as TOML."""
        timing = self.timing
        simulation: dict[str, Any] = {
            "duration": self.first_step * timing.step + timing.samples * timing.interval,
            "scheme": self.settings.scheme.name,
            "step": timing.step,
            "sample_rate": float(f"{1.0 / timing.interval:.12g}"),
        }
        if timing.motion_every > 1:
            simulation["motion_rate"] = float(f"{1.0 / (timing.interval * timing.motion_every):.12g}")
        if self.surfaces is not None:
            if self.surfaces.points is None:
                simulation["surface_rate"] = float(f"{1.0 / (timing.interval * self.surfaces.every):.12g}")
        elif self.system.faces:
            simulation["surface_rate"] = ALL_POINTS
        if self.settings.solve != GaussSeidel():
            simulation["contact_solve"] = asdict(self.settings.solve)
        return scenario_toml(self.system, self.probes, simulation | self.settings.others)
