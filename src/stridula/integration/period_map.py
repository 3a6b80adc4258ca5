"""The motion of a system after a period as a function of that at its start: one march, made periodic."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from .._kernels.layout import columns as at
from ..arrays import Array
from ..lowering import Assembly
from ..lowering.blocks import blocks_of
from ..lowering.schemes import Scheme
from ..records.state import State
from .contact_solve import GaussSeidel
from .marches import Chunk, Excitation, Impositions, March
from .stops import ENDED, WHAT

# Columns of the place of a tip on its track, and of the material that it has passed, along each tangent.
PLACES = ((at.ABSCISSA, at.ABSCISSA_BEFORE), (at.ABSCISSA_B,))
MATERIALS = ((at.MATERIAL, at.ANCHOR), (at.MATERIAL_B, at.ANCHOR_B))
TIPS, TRACKS = (at.TIP_MOTION, at.TIP_MOTION_B), (at.TRACK_MOTION, at.TRACK_MOTION_B)
LAW_STATES = [at.LAW_STATE, at.LAW_STATE_B]
# Instants of a period at which its motion is kept.
INSTANTS = 8


class MarchEnded(Exception):
    """A march ended within a period; the message has the reason in words."""


class Passed(NamedTuple):
    """A period of a march.

    Attributes
    ----------
    state, before : State
        State at its end and a step earlier, carried back to where tips and tracks were at its start.
    motions : ndarray, shape (instants, 2, modes)
        Positions and increments of the modes at some instants.
    friction_states : ndarray, shape (contacts, 2)
        Largest size of the internal states of the friction laws.
    stops : bool
        Whether a contact with friction sticks, or slides in both senses.
    """

    state: State
    before: State
    motions: Array
    friction_states: Array
    stops: bool


@dataclass
class Counter:
    """A count that several maps share.

    Attributes
    ----------
    marched : float
        Number of periods marched.
    """

    marched: float = 0.0


@dataclass(frozen=True)
class _Prepared:
    """A march at one step, with the motions that are imposed in its ranges of steps.

    Attributes
    ----------
    march : March
        The march.
    imposed : Impositions
        Imposed motions.
    ranges : dict
        Those of ranges of steps that have been marched, by their first step and their number.
    """

    march: March
    imposed: Impositions
    ranges: dict[tuple[int, int], Excitation] = field(default_factory=dict)

    def advance(self, first: int, count: int) -> Chunk:
        """March some steps.

        Raises
        ------
        MarchEnded
            If it is not finite, or if the forces of its contacts are not found.
        """
        if (first, count) not in self.ranges:
            self.ranges[first, count] = self.imposed.on(first, count)
        chunk = self.march.advance([self.ranges[first, count]], count)[0]
        if chunk.completed < count:
            word = ENDED[chunk.ended]
            raise MarchEnded(WHAT.get(word, word))
        return chunk


@dataclass(frozen=True)
class PeriodMap:
    """The march of a system over a period of a fixed number of steps, whose length follows the period.

    Attributes
    ----------
    arrays : Assembly
        The system as flat arrays.
    scheme : Scheme
        Time scheme.
    solve : GaussSeidel
        Simultaneous solution of several contacts.
    steps : int
        Steps of a period.
    first_step : int
        Number of the first step: drives have settled by then, and it begins a period of those that never settle.
    counter : Counter
        Periods marched so far, shared with maps of other systems.
    kept : dict
        The last march, by its step [s].
    """

    arrays: Assembly
    scheme: Scheme
    solve: GaussSeidel
    steps: int
    first_step: int = 0
    counter: Counter = field(default_factory=Counter)
    kept: dict[float, _Prepared] = field(default_factory=dict)

    def end(self, state: State, period: float) -> State:
        """Return the state a period [s] later, as in `after`.

        Raises
        ------
        MarchEnded
            As there.
        """
        step = period / self.steps
        prepared = self._prepared(state, step)
        self.counter.marched += 1.0
        prepared.advance(self.first_step, self.steps)
        return carried_on(self.arrays, prepared.march.states[0], self._back(step, self.steps))

    def after(self, state: State, period: float, steps: int | None = None) -> Passed:
        """Return the motion a period [s] later, or after some steps of it.

        Raises
        ------
        MarchEnded
            If it is not finite, or if the forces of its contacts are not found.
        """
        step, steps = period / self.steps, self.steps if steps is None else steps
        prepared = self._prepared(state, step)
        self.counter.marched += steps / self.steps
        ends = sorted({*(np.arange(1, INSTANTS + 1) * steps // INSTANTS).tolist(), steps - 1} - {0})
        states, sizes, rubbed, first = [prepared.march.states[0]], [], [], 0
        for end in ends:
            chunk = prepared.advance(self.first_step + first, end - first)
            sizes.append(np.abs(chunk.contacts[:, :, LAW_STATES]).max(axis=0))
            slips, forces = chunk.contacts[:, :, at.SLIP_VELOCITY], np.abs(chunk.contacts[:, :, at.TANGENTIAL_FORCE])
            sticking = chunk.contacts[:, :, at.STICKING]
            rubbed.append([-slips.min(axis=0), slips.max(axis=0), sticking.max(axis=0), forces.max(axis=0)])
            states.append(prepared.march.states[0])
            first = end
        back = self._back(step, steps)
        before, last = (carried_on(self.arrays, one, back) for one in states[-2:])
        backwards, forwards, sticking, forces = np.max(rubbed, axis=0) > 0.0
        stops = bool((forces & (sticking | (backwards & forwards))).any())
        return Passed(last, before, np.array([one.modal for one in states[1:]]), np.max(sizes, axis=0), stops)

    def _back(self, step: float, steps: int) -> Array:
        """Return the motion [m] that carries contacts back over some steps, shape (contacts, motions)."""
        return -travel(self.arrays, self.first_step * step, (self.first_step + steps) * step, step)

    def _prepared(self, state: State, step: float) -> _Prepared:
        """Return the march from a state; that of the last step is used again."""
        state = replace(state, energies=np.zeros_like(state.energies))
        if step in self.kept:
            self.kept[step].march.put([state])
            return self.kept[step]
        blocks = blocks_of(self.arrays, self.scheme, step)
        march = March([blocks], [state], step, 1, self.solve)
        self.kept.clear()
        self.kept[step] = _Prepared(march, Impositions(self.arrays, blocks, step))
        return self.kept[step]


def travel(arrays: Assembly, begin: float, end: float, step: float) -> Array:
    """Return the motion imposed on each contact [m] between two times [s], shape (contacts, motions)."""
    return np.asarray(np.diff(arrays.motion(np.array([begin, end]), step), axis=0)[0])


def moving_along(arrays: Assembly, begin: float) -> list[int]:
    """Return the numbers of the contacts that travel along a track with ends from a time [s] on."""
    moved = travel(arrays, begin, begin + 1.0, 1.0)[:, at.TIP_MOTION]
    tracks = [one.circle is None and one.contact.path_body is not None for one in arrays.contacts]
    return np.flatnonzero((moved != 0.0) & np.array(tracks)).tolist()


def carried_on(arrays: Assembly, state: State, travelled: Array) -> State:
    """Return a state with tips and tracks carried on by imposed motions [m], shape (contacts, motions).

    Waves round a body are carried on with the contacts that move round it.
    """
    state = deepcopy(state)
    for places, materials, tip, track in zip(PLACES, MATERIALS, TIPS, TRACKS, strict=True):
        state.carried[:, places] += travelled[:, [tip]]
        state.carried[:, materials] += travelled[:, [tip]] - travelled[:, [track]]
    bodies = {}
    for contact, moved in zip(arrays.contacts, travelled[:, at.TIP_MOTION].tolist(), strict=True):
        if contact.circle is not None and moved:
            bodies[contact.circle.span] = contact.circle, moved * contact.rate
    for body, angle in bodies.values():
        for values in state.modal:
            values += body.turned(values, angle * body.orders)
    return state
