"""A march without end of a system that may be changed while it runs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from copy import copy, deepcopy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .._kernels import layout as at
from .._kernels.contact import SEPARATED
from ..arrays import Array
from ..checks import instance, positive
from ..lowering import Assembly, assemble, with_travel
from ..lowering.blocks import Blocks, blocks_of
from ..lowering.carry_over import Before
from ..lowering.schemes import ExactModal, Scheme
from ..lowering.signals import later
from ..records import Probe
from ..records.state import State
from ..records.variables import ALONG_TANGENTS
from ..system import System
from .belief import Belief
from .contact_solve import GaussSeidel
from .decimation import Decimator
from .equilibrium_start import in_equilibrium
from .marches import Impositions, March
from .run import CONTACT_COLUMN, ENERGY_COLUMN, along_both
from .start import state_at_start, stored_in_contacts
from .stops import ENDED
from .timing import choose_timing

# Share of the lowest frequency of vibration below which a mode counts as free when contacts are opened.
SOFT = 0.3
ON_THE_TRACK = (at.MATERIAL, at.ANCHOR, at.ABSCISSA, at.ABSCISSA_BEFORE)


@dataclass(frozen=True)
class LiveChunk:
    """Record of a part of a live march.

    Attributes
    ----------
    time : ndarray, shape (samples,)
        Time since the start of the stroke at the end of every sample interval [s].
    contacts : dict of ndarray, shape (contacts, samples)
        Variables of the contacts, by their names in records; in space along the first tangent.
    status_shares : ndarray, shape (contacts, samples, 3)
        Share of each interval separated, sticking and sliding.
    energies : dict of ndarray, shape (samples,)
        Energies since the start or the last change, by their names in records.
    probes : ndarray, shape (samples, probes)
        Probes, delayed by `LiveMarch.delay` samples.
    along_tangents : dict of ndarray, shape (contacts, samples, 2)
        Variables of contacts in space along both tangents, by their names in records; empty in the plane.
    """

    time: Array
    contacts: dict[str, Array]
    status_shares: Array
    energies: dict[str, Array]
    probes: Array
    along_tangents: dict[str, Array]

    @property
    def contact(self) -> dict[str, Array]:
        """Variables of the first contact."""
        return {name: values[0] for name, values in self.contacts.items()}

    @property
    def status_share(self) -> Array:
        """Status shares of the first contact."""
        found: Array = self.status_shares[0]
        return found


@dataclass(frozen=True)
class Moment:
    """A moment of a live march, to which it can return.

    Attributes
    ----------
    attributes : dict
        System, time and filters of the march.
    state : State
        State of its system.
    """

    attributes: dict[str, Any]
    state: State


class LiveMarch:
    """A march of a system, sample by sample, without a fixed end.

    The system may be changed in between, and its motion continues. Friction, forces and the velocities of rigid tracks
    and of surfaces change at once; changed bodies keep their deflections, contacts their gap and their place on the
    track. A contact that is moved along the track keeps its gap there.

    Parameters
    ----------
    system : System
        The system.
    probes : sequence of Displacement, Velocity, Acceleration, Reaction, SupportForce, ModalDisplacement, ModalVelocity
        Quantities to record besides those of the contacts.
    scheme : CentralDifference or ExactModal, optional
        Time scheme; the exact modal one if left out.
    sample_rate : float, optional
        Samples per second [Hz].
    """

    # System and state of the march, set anew at every change.
    system: System
    probes: tuple[Probe, ...]
    scheme: Scheme
    step: float
    ratio: int
    _described: Assembly
    _arrays: Assembly
    _blocks: Blocks
    _march: March
    _impositions: Impositions
    _belief: Belief

    def __init__(
        self,
        system: System,
        probes: Sequence[Probe],
        scheme: Scheme | None = None,
        sample_rate: float = 48e3,
        step: float | None = None,
    ) -> None:
        self.interval = 1.0 / positive("sample_rate", sample_rate)
        self._take(system, probes, ExactModal() if scheme is None else scheme, step)
        self.restart()

    @property
    def time(self) -> float:
        """Time since the start of the stroke [s]."""
        return self._sample * self.interval

    @property
    def delay(self) -> int:
        """Samples by which probes are delayed."""
        return -(-self._decimator.lookahead // self.ratio)

    @property
    def position(self) -> Array:
        """Present modal displacements, shape (modes,); the range of each body is in `spans`."""
        return self._of_bodies(self._march.states[0].modal[at.Q])

    @property
    def motion(self) -> tuple[Array, Array]:
        """Present modal displacements and velocities, both as in `position`."""
        modal = self._march.states[0].modal
        return self._of_bodies(modal[at.Q]), self._of_bodies(modal[at.D] / self.step)

    @property
    def spans(self) -> dict[str, tuple[int, int]]:
        """First mode of each body, and end of its range."""
        return self._arrays.spans

    @property
    def passed(self) -> Array:
        """Distance by which the track of each contact has been moved along itself so far, shape (contacts,) [m]."""
        return self._imposed_now()[self._arrays.firsts, at.TRACK_MOTION]

    @property
    def moment(self) -> Moment:
        """The present moment."""
        return Moment(_apart(vars(self)), self._march.states[0])

    def return_to(self, moment: Moment) -> None:
        """Return to an earlier moment; the march continues from it to the last bit as it did then."""
        vars(self).update(_apart(moment.attributes))
        self._march.put([moment.state])

    def restart(self) -> None:
        """Return to the start."""
        self._sample, self._travel = 0, 0.0
        self._gaps = np.array([contact.gap for contact in self.system.contacts])
        self._lay_out(in_equilibrium(self.system, self._described))
        self._go(state_at_start(self._arrays, self.scheme, self.step, self._blocks, GaussSeidel()))
        self._begin_probes()

    def advance(self, samples: int) -> tuple[LiveChunk, str]:
        """Continue the march and return its record, and the reason of its end.

        Parameters
        ----------
        samples : int
            Samples to march.

        Returns
        -------
        chunk : LiveChunk
            Record, with fewer samples if the march ended early.
        ended : str
            ``finished``, ``off the track``, ``not finite``, ``contact unsolved`` or ``energy created``; except after
            the first, the march must be started again with `restart` or `begin`.
        """
        imposed = self._impositions.on(self._sample * self.ratio, samples * self.ratio)
        (chunk,) = self._march.advance([imposed], samples)
        done, ended = self._belief.of(chunk)
        time = (self._sample + np.arange(1, done + 1)) * self.interval
        self._sample += done
        pairs, energy = chunk.contacts[:done].transpose(1, 2, 0), chunk.energies[:done].T
        firsts = self._arrays.firsts
        record = pairs[firsts]
        self._gaps = record[:, at.CONTACT_GAP, -1].copy() if done else self._gaps
        contacts = {name: record[:, column].copy() for name, column in CONTACT_COLUMN.items()}
        energies = {name: energy[column].copy() for name, column in ENERGY_COLUMN.items()}
        shares = record[:, at.SEPARATED : at.SLIDING + 1].transpose(0, 2, 1).copy()
        doubled = () if firsts.all() else ALONG_TANGENTS
        tangents = {name: along_both(pairs[:, CONTACT_COLUMN[name]], firsts) for name in doubled}
        return LiveChunk(time, contacts, shares, energies, self._low_passed(chunk.raw, done), tangents), ENDED[ended]

    def begin(
        self, system: System, probes: Sequence[Probe], scheme: Scheme | None = None, step: float | None = None
    ) -> None:
        """Start again with another system, in any state of the march.

        Parameters
        ----------
        system : System
            New system.
        probes : sequence of probe
            Quantities to record from now on besides those of the contacts.
        scheme : CentralDifference or ExactModal, optional
            Time scheme; unchanged if left out.
        step : float, optional
            Longest time step [s]; the scheme's default if left out.

        Raises
        ------
        ValueError
            As at the start; then nothing is changed.
        """
        with self._as_it_was_if_refused():
            self._take(system, probes, self.scheme if scheme is None else scheme, step)
            self.restart()

    def change(
        self, system: System, probes: Sequence[Probe], scheme: Scheme | None = None, step: float | None = None
    ) -> bool:
        """Continue with another system.

        Parameters
        ----------
        system : System
            New system.
        probes : sequence of probe
            Quantities to record from now on besides those of the contacts.
        scheme : CentralDifference or ExactModal, optional
            Time scheme; unchanged if left out.
        step : float, optional
            Longest time step [s]; the scheme's default if left out.

        Returns
        -------
        bool
            Whether the motion continued; otherwise the march starts again, because the motion cannot be transferred to
            the other system, or its tip would not be on the track.

        Raises
        ------
        ValueError
            As at the start; then the march continues unchanged.
        """
        with self._as_it_was_if_refused():
            return self._change(system, probes, scheme, step)

    @contextmanager
    def _as_it_was_if_refused(self) -> Iterator[None]:
        kept = dict(vars(self))
        try:
            yield
        except (ValueError, MemoryError):
            vars(self).update(kept)
            raise

    def _change(self, system: System, probes: Sequence[Probe], scheme: Scheme | None, step: float | None) -> bool:
        before, state = Before(self.system, self.scheme, self.spans, self.step), deepcopy(self._march.states[0])
        root = self._root_at(self._arrays)
        self._take(system, probes, before.scheme if scheme is None else scheme, step)
        arrays, firsts = self._described, self._arrays.firsts
        self._travel = root - self._root_at(arrays)
        self._begin_probes()
        if not before.goes_on_as(system):
            self.restart()
            return False
        pairs = zip(before.system.contacts, system.contacts, strict=True)
        moved = np.array([now.at - then.at for then, now in pairs])
        places = state.carried[firsts, at.ABSCISSA] + moved
        if not all(contact.reaches(place) for contact, place in zip(system.contacts, places, strict=True)):
            self.restart()
            return False
        position, velocity = before.motion_as(system, arrays, state, self.time)
        if before.has_modes_of(system) and (self.step, self.scheme) == (before.step, before.scheme) and not moved.any():
            self._go_on(state, places, position, velocity, before.system)
            return True
        if not all(one.is_steady for one in arrays.turning):
            # A turning velocity with a history would start from its beginning.
            self.restart()
            return False
        yields = np.array([contact.yields is not None for contact in system.contacts])
        is_closed = state.carried[firsts, at.STATUS] != SEPARATED
        self._start_from(position, velocity, places, np.where(is_closed & ~yields, 0.0, self._gaps))
        return True

    def _take(self, system: System, probes: Sequence[Probe], scheme: Scheme, step: float | None) -> None:
        instance("system", system, System)
        if step is not None:
            step = self.interval / max(1.0, np.ceil(self.interval / positive("step", step) - 1e-9))
        arrays = assemble(system, probes)
        timing = choose_timing(arrays, scheme, self.interval, step, 1.0 / self.interval)
        self.system, self.probes, self.scheme = system, tuple(probes), scheme
        self._described, self.step, self.ratio = arrays, timing.step, timing.ratio

    def _begin_probes(self) -> None:
        self._decimator, self._waiting = Decimator(self.ratio), np.zeros((0, len(self._described.probes)))

    def _lay_out(self, arrays: Assembly) -> None:
        """Set the system, as flat arrays, that marches."""
        self._arrays, self._blocks = arrays, blocks_of(arrays, self.scheme, self.step)
        self._impositions = Impositions(arrays, self._blocks, self.step)

    def _go(self, state: State) -> None:
        """Continue from a state."""
        state.energies[:] = 0.0
        in_contacts = stored_in_contacts(self._arrays, state.carried)
        state.energies[at.STORED] = self._blocks.modes.stored_energy(state.modal) + in_contacts
        stored = float(state.energies[at.STORED])
        self._belief = Belief(self.system, self._arrays, self._blocks, state.energies, stored)
        self._march = March([self._blocks], [state], self.step, self.ratio)

    def _low_passed(self, raw: Array, samples: int) -> Array:
        """Return as many samples of the probes as of the rest; the first or zero before the low-pass gives any."""
        waiting = np.concatenate([self._waiting, self._decimator.feed(raw[: samples * self.ratio])])
        missing = max(0, samples - len(waiting))
        first = waiting[:1] if len(waiting) else np.zeros((1, len(self._described.probes)))
        waiting = np.concatenate([np.repeat(first, missing, axis=0), waiting])
        self._waiting = waiting[samples:]
        return waiting[:samples]

    def _of_bodies(self, modal: Array) -> Array:
        """Return values of the modes of the march as values of the modes of the bodies."""
        blend, found = self._arrays.blend, np.array(modal)
        found[: len(blend)] = blend @ found[: len(blend)]
        return found

    def _root_at(self, arrays: Assembly) -> float:
        """Return the distance by which an imposed velocity has moved the root of a system so far [m]."""
        return float(arrays.signals.displacement(np.array([self.time]), self.step)[0])

    def _shifted(self, places: Array, position: Array, before: Array) -> Assembly:
        """Return the system whose tips are at given places now: the sum of start, displacement and imposed motion.

        Other imposed motions of contacts continue from `before`, shape (contacts, motions).
        """
        moved = with_travel(self._described, self.system, self._travel)
        described, now = moved.motion, np.array([self.time])
        imposed, offset, contacts = described(now, self.step)[0], np.zeros(before.shape), []
        for number, (one, place) in enumerate(zip(moved.contacts, places[moved.contact_numbers], strict=True)):
            if one.contact.path_body is None or one.is_second:
                offset[number] = before[number] - imposed[number]
                contacts.append(one)
                continue
            offset[number, at.TIP_MOTION] = -imposed[number, at.TIP_MOTION] - one.fixed[1] @ position
            contacts.append(replace(one, contact=replace(one.contact, at=float(place))))
        return replace(moved, contacts=contacts, motion=lambda times, step: described(times, step) + offset)

    def _imposed_now(self) -> Array:
        """Return the motions imposed on contacts now, shape (contacts, motions)."""
        return np.asarray(self._arrays.motion(np.array([self.time]), self.step)[0])

    def _go_on(self, state: State, places: Array, position: Array, velocity: Array, before: System) -> None:
        """Continue with the same modes under other forces and other friction."""
        self._lay_out(self._shifted(places, position, self._imposed_now()))
        state.modal[at.D] = velocity * self.step
        firsts, numbers = self._arrays.firsts, self._arrays.contact_numbers
        for own, number, is_first in zip(state.carried, numbers, firsts, strict=True):
            law = self.system.contacts[number].friction
            if type(law) is not type(before.contacts[number].friction):
                own[at.FRICTION_STATE] = law.states_at_start[0 if is_first else 1]
        self._put(state, places)

    def _start_from(self, position: Array, velocity: Array, places: Array, gaps: Array) -> None:
        """Continue with other modes or at other places on the track, with contacts opened by their gaps."""
        imposed, now = self._imposed_now(), self.time
        shifted = self._shifted(places, position, imposed)
        raised = shifted.motion(np.array([now]), self.step)[0, shifted.firsts, at.GAP_MOTION]
        position = position + _opening(shifted, places, position, gaps - raised)
        self._lay_out(self._shifted(places, position, imposed))
        arrays = replace(
            self._arrays,
            position=position,
            velocity=velocity,
            signals=self._arrays.signals.since(now),
            motion=later(self._arrays.motion, now),
        )
        self._put(state_at_start(arrays, self.scheme, self.step, self._blocks, GaussSeidel()), places)

    def _put(self, state: State, places: Array) -> None:
        """Continue from a state with tips at given places on the track."""
        for row, contact, place in zip(np.flatnonzero(self._arrays.firsts), self.system.contacts, places, strict=True):
            own = state.carried[row]
            if contact.path_body is not None:
                own[list(ON_THE_TRACK)] += place - own[at.ABSCISSA]
        self._go(state)


def _apart(attributes: dict[str, Any]) -> dict[str, Any]:
    """Return the attributes of a march, with copies of those that it changes in place, other than its state."""
    return attributes | {name: copy(attributes[name]) for name in ("_decimator", "_belief")}


def _opening(arrays: Assembly, places: Array, position: Array, gaps: Array) -> Array:
    """Return the displacement that opens contacts to given gaps, as by contact forces, rigid motions first."""
    firsts = [one for one in arrays.contacts if not one.is_second]
    rows = np.array([one.rows_at(place)[0] for one, place in zip(firsts, places, strict=True)])
    squared = arrays.all_stiffness
    vibrating = np.diag(squared)[np.diag(squared) > 0.0]
    squared += SOFT**2 * (vibrating.min() if vibrating.size else 1.0) * np.eye(rows.shape[1])
    yielded = np.linalg.solve(squared, rows.T)
    missing = gaps - np.array([one.contact.gap for one in firsts]) - rows @ position
    return np.asarray(yielded @ np.linalg.lstsq(rows @ yielded, missing)[0])
