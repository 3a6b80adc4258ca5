"""A march under way as a value: its beginning, and its continuation with another system."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .._kernels.contact.exact import SEPARATED
from .._kernels.layout import columns as at
from ..arrays import Array
from ..checks import instance, positive
from ..lowering import Assembly, assemble, with_travel
from ..lowering.blocks import Blocks, blocks_of
from ..lowering.carry_over import Before
from ..lowering.heating import temperatures_at_start
from ..lowering.schemes import Scheme
from ..lowering.signals import later
from ..records import Probe
from ..records.state import State
from ..system import System
from .belief import Belief
from .contact_solve import GaussSeidel
from .decimation import DelayedProbes
from .equilibrium_start import in_equilibrium
from .marches import Impositions, March
from .start import state_at_start, stored_in_contacts
from .timing import choose_timing

# Share of the lowest frequency of vibration below which a mode counts as free when contacts are opened.
SOFT = 0.3
ON_THE_TRACK = (at.MATERIAL, at.ANCHOR, at.ABSCISSA, at.ABSCISSA_BEFORE)


@dataclass(frozen=True)
class Marched:
    """A system that is marched sample by sample.

    Attributes
    ----------
    system : System
        The system.
    probes : tuple of Probe
        Quantities to record besides those of the contacts.
    scheme : Scheme
        Time scheme.
    step, interval : float
        Time step, and time between samples [s].
    ratio : int
        Steps per sample.
    described : Assembly
        System and probes as flat arrays, at the start of a stroke.
    """

    system: System
    probes: tuple[Probe, ...]
    scheme: Scheme
    step: float
    interval: float
    ratio: int
    described: Assembly

    @classmethod
    def of(
        cls, system: System, probes: tuple[Probe, ...], scheme: Scheme, interval: float, longest: float | None
    ) -> Marched:
        """Return a system with the default step, or the largest division of the interval up to a `longest` one [s].

        Raises
        ------
        ValueError
            If the system or a probe is wrong, or the step is too long.
        """
        instance("system", system, System)
        step = longest
        if longest is not None:
            step = interval / max(1.0, np.ceil(interval / positive("step", longest) - 1e-9))
        described = assemble(system, probes)
        timing = choose_timing(described, scheme, interval, step, 1.0 / interval)
        return cls(system, probes, scheme, timing.step, interval, timing.ratio, described)


@dataclass(frozen=True)
class UnderWay:
    """A march under way; what it contains marches on, all else stays as it is.

    Attributes
    ----------
    marched : Marched
        The system.
    arrays : Assembly
        The system as flat arrays, as it continues from earlier ones.
    blocks : Blocks
        The same in the form for the march.
    march : March
        Its march.
    impositions : Impositions
        Signals and motions imposed on it.
    belief : Belief
        Checks of its energies.
    probed : DelayedProbes
        Its probes on their way through the low-pass.
    sample : int
        Samples since the start of the stroke.
    travel : float
        Displacement of the root beside that of its present drive [m].
    gaps : ndarray, shape (contacts,)
        Last recorded gaps [m].
    """

    marched: Marched
    arrays: Assembly
    blocks: Blocks
    march: March
    impositions: Impositions
    belief: Belief
    probed: DelayedProbes
    sample: int
    travel: float
    gaps: Array

    @property
    def time(self) -> float:
        """Time since the start of the stroke [s]."""
        return self.sample * self.marched.interval

    @property
    def state(self) -> State:
        """A copy of the present state."""
        return self.march.states[0]

    @property
    def imposed(self) -> Array:
        """Present motions imposed on contacts, shape (pairs, motions) [m]."""
        return np.asarray(self.arrays.motion(np.array([self.time]), self.marched.step)[0])

    def apart(self) -> UnderWay:
        """Return the same with copies of those parts, other than the march, that change in place."""
        return replace(self, belief=self.belief.copy(), probed=self.probed.copy())


def begun(marched: Marched) -> UnderWay:
    """Return the start of a stroke."""
    arrays = in_equilibrium(marched.system, marched.described)
    blocks = blocks_of(arrays, marched.scheme, marched.step)
    state = state_at_start(arrays, marched.scheme, marched.step, blocks, GaussSeidel())
    gaps = np.array([contact.gap for contact in marched.system.contacts])
    return _from(marched, arrays, blocks, state, 0, 0.0, gaps)


def changed(before: UnderWay, marched: Marched) -> UnderWay | None:
    """Return a march that continues with another system.

    None if the motion cannot be transferred to it, or its tips would not be on the track.
    """
    was, system = before.marched, marched.system
    kept = Before(was.system, was.scheme, before.arrays.spans, before.arrays.relaxing, was.step)
    if not kept.goes_on_as(system):
        return None
    change = _Change(before, marched)
    if not all(contact.reaches(place) for contact, place in zip(system.contacts, change.places, strict=True)):
        return None
    position, velocity = kept.motion_as(system, marched.described, change.state, before.time)
    is_alike = kept.has_modes_of(system) and (marched.step, marched.scheme) == (was.step, was.scheme)
    if is_alike and not change.moved.any():
        return change.with_same_modes(position, velocity)
    if not all(one.is_steady for one in marched.described.turning):
        # A turning velocity with a history would start from its beginning.
        return None
    if any(one.profile is not None for one in marched.described.contacts):
        # The place along a profile would start from its beginning.
        return None
    return change.with_other_modes(position, velocity)


class _Change:
    """A march under way and the system with which it continues."""

    def __init__(self, before: UnderWay, marched: Marched) -> None:
        self.before, self.marched, self.state = before, marched, before.state
        pairs = zip(before.marched.system.contacts, marched.system.contacts, strict=True)
        self.moved = np.array([now.at - then.at for then, now in pairs])
        self.places = self.state.carried[:, at.ABSCISSA] + self.moved
        self.travel = self._root_of(before.arrays, before.marched.step) - self._root_of(marched.described, marched.step)

    def with_same_modes(self, position: Array, velocity: Array) -> UnderWay:
        """Return the march under other forces and other friction."""
        arrays, state, was = self._shifted(position), self.state, self.before.marched.system
        state.modal[at.D] = velocity * self.marched.step
        state.springs = arrays.springs.rows @ state.modal[at.D]
        for own, before, now in zip(state.carried, was.contacts, self.marched.system.contacts, strict=True):
            if type(now.law) is not type(before.law):
                own[[at.FRICTION_STATE, at.FRICTION_STATE_B]] = now.law.states_at_start
        self._keep_warm(state)
        return self._put(arrays, blocks_of(arrays, self.marched.scheme, self.marched.step), state)

    def with_other_modes(self, position: Array, velocity: Array) -> UnderWay:
        """Return the march with other modes or at other places on the track, with contacts opened by their gaps."""
        marched, now = self.marched, self.before.time
        yields = np.array([contact.yields is not None for contact in marched.system.contacts])
        is_closed = self.state.carried[:, at.STATUS] != SEPARATED
        gaps = np.where(is_closed & ~yields, 0.0, self.before.gaps)
        shifted = self._shifted(position)
        raised = shifted.motion(np.array([now]), marched.step)[0, :, at.GAP_MOTION]
        position = position + _opening(shifted, self.places, position, gaps - raised)
        arrays = self._shifted(position)
        blocks = blocks_of(arrays, marched.scheme, marched.step)
        starting = replace(
            arrays,
            position=position,
            velocity=velocity,
            signals=arrays.signals.since(now),
            motion=later(arrays.motion, now),
        )
        state = state_at_start(starting, marched.scheme, marched.step, blocks, GaussSeidel())
        state.carried[:, at.TEMPERATURE :] = self.state.carried[:, at.TEMPERATURE :]
        self._keep_warm(state)
        return self._put(arrays, blocks, state)

    def _keep_warm(self, state: State) -> None:
        """Set the temperatures of contacts whose layers are others than before to those at a start."""
        pairs = zip(self.before.marched.system.contacts, self.marched.system.contacts, strict=True)
        start = temperatures_at_start(self.marched.described.contacts)
        for own, values, (before, now) in zip(state.carried, start, pairs, strict=True):
            if before.layers_of_heat != now.layers_of_heat:
                own[at.TEMPERATURE :] = values

    def _root_of(self, arrays: Assembly, step: float) -> float:
        """Return the distance by which an imposed velocity has moved the root of a system so far [m]."""
        return float(arrays.signals.displacement(np.array([self.before.time]), step)[0])

    def _shifted(self, position: Array) -> Assembly:
        """Return the system whose tips are at their places now: the sum of start, displacement and imposed motion.

        Other imposed motions of contacts continue from those before.
        """
        moved = with_travel(self.marched.described, self.marched.system, self.travel)
        described, step, before = moved.motion, self.marched.step, self.before.imposed
        imposed, offset, contacts = described(np.array([self.before.time]), step)[0], np.zeros(before.shape), []
        for number, (one, place) in enumerate(zip(moved.contacts, self.places, strict=True)):
            offset[number] = before[number] - imposed[number]
            if one.contact.path_body is None:
                contacts.append(one)
                continue
            offset[number, [at.TRACK_MOTION, at.GAP_MOTION]] = 0.0
            offset[number, at.TIP_MOTION] = -imposed[number, at.TIP_MOTION] - one.fixed[1] @ position
            contacts.append(replace(one, contact=replace(one.contact, at=float(place))))
        return replace(moved, contacts=contacts, motion=lambda times, step: described(times, step) + offset)

    def _put(self, arrays: Assembly, blocks: Blocks, state: State) -> UnderWay:
        """Return the march from a state with tips at their places on the track."""
        for own, contact, place in zip(state.carried, self.marched.system.contacts, self.places, strict=True):
            if contact.path_body is not None:
                own[list(ON_THE_TRACK)] += place - own[at.ABSCISSA]
        return _from(self.marched, arrays, blocks, state, self.before.sample, self.travel, self.before.gaps)


def _from(
    marched: Marched, arrays: Assembly, blocks: Blocks, state: State, sample: int, travel: float, gaps: Array
) -> UnderWay:
    """Return a march that continues from a state."""
    state.energies[:] = 0.0
    state.energies[at.STORED_IN_SPRINGS] = arrays.springs.energy(state.modal[at.Q] - 0.5 * state.modal[at.D])
    stored = (
        state.energies[at.STORED_IN_SPRINGS]
        + blocks.modes.stored_energy(state.modal)
        + stored_in_contacts(arrays, state.carried)
    )
    state.energies[at.STORED] = stored
    return UnderWay(
        marched=marched,
        arrays=arrays,
        blocks=blocks,
        march=March([blocks], [state], marched.step, marched.ratio),
        impositions=Impositions(arrays, blocks, marched.step),
        belief=Belief(marched.system, arrays, blocks, state.energies, float(stored)),
        probed=DelayedProbes(marched.ratio, len(marched.described.probes)),
        sample=sample,
        travel=travel,
        gaps=gaps,
    )


def _opening(arrays: Assembly, places: Array, position: Array, gaps: Array) -> Array:
    """Return the displacement that opens contacts to given gaps, as by contact forces, rigid motions first."""
    rows = np.array([one.rows_at(place)[0] for one, place in zip(arrays.contacts, places, strict=True)])
    squared = arrays.all_stiffness
    vibrating = np.diag(squared)[np.diag(squared) > 0.0]
    squared += SOFT**2 * (vibrating.min() if vibrating.size else 1.0) * np.eye(rows.shape[1])
    yielded = np.linalg.solve(squared, rows.T)
    missing = gaps - np.array([one.contact.gap for one in arrays.contacts]) - rows @ position
    return np.asarray(yielded @ np.linalg.lstsq(rows @ yielded, missing)[0])
