"""The state of modes and contacts at the start of a march."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from .._kernels.contact.exact import SEPARATED, SLIDING, STICKING
from .._kernels.contact.friction import next_state, set_valued, sliding_ratio, state_ratio
from .._kernels.contact.pressing import stored_in
from .._kernels.contact.slipping_in_space import ratio_of_state, state_after
from .._kernels.layout import columns as at
from .._kernels.layout.contact_values import Law, Tangents, Yielding
from .._kernels.layout.laws import STATIC
from ..arrays import Array
from ..checks import ArgumentError
from ..lowering import Assembly, ContactRows
from ..lowering.blocks import Blocks
from ..lowering.heating import temperatures_at_start
from ..lowering.schemes import Scheme
from ..lowering.stepping import Stepping
from ..records.state import State
from .contact_solve import GaussSeidel
from .forces import forces_of

# Relative rounding error of a gap whose terms are results of sums or solutions.
ROUND_OFF = 512.0 * np.finfo(float).eps
# Give of compliant contacts at the start, over the compliance of the bodies.
FLAT = 1e6
# Passes for friction that depends on the pressure, and the relative change of forces that ends them.
PASSES, SETTLED = 40, 1e-13
# Relative stiffness of coupled modes that is due to rounding.
STIFFLESS = 1e-13
# Columns along both tangents.
MATERIAL, ANCHOR, ABSCISSA = [at.MATERIAL, at.MATERIAL_B], [at.ANCHOR, at.ANCHOR_B], [at.ABSCISSA, at.ABSCISSA_B]
LAST_SLIP, EARLIER_SLIP = [at.LAST_SLIP, at.LAST_SLIP_B], [at.EARLIER_SLIP, at.EARLIER_SLIP_B]
LAST_TANGENTIAL, PAST_RATIO = [at.LAST_TANGENTIAL, at.LAST_TANGENTIAL_B], [at.PAST_RATIO, at.PAST_RATIO_B]
FRICTION_STATE = [at.FRICTION_STATE, at.FRICTION_STATE_B]
TIP, TRACK = [at.TIP_MOTION, at.TIP_MOTION_B], [at.TRACK_MOTION, at.TRACK_MOTION_B]


def state_at_start(arrays: Assembly, scheme: Scheme, step: float, blocks: Blocks, solve: GaussSeidel) -> State:
    """Return the state at the start.

    The first increment is that of motion under the loads and the forces of closed contacts, so that the scheme is of
    second order from the first step on. A closed contact that does not slide sticks.

    Raises
    ------
    ValueError
        If a contact overlaps.
    """
    modes = blocks.modes
    start = _Start(arrays, scheme, step, blocks)
    force = start.force
    first = start.increment(force)
    carried = start.carried(first)
    closed = np.flatnonzero(start.is_closed)
    if closed.size:
        forces = start.forces(closed, first, carried, solve)
        first = start.increment(force + start.along_rows(closed, forces) @ start.pushes(closed))
        first += start.increment_of_rates(closed, forces)
        carried = start.carried(first)
        if blocks.contacts.profiles.size:
            carried[:, at.PUSHED] = start.pushed(closed, forces)
        carried[closed[:, None], [at.LAST_NORMAL, *LAST_TANGENTIAL[: start.tangents]]] = forces
        presses = forces[:, 0] > 0.0
        pressed = closed[presses]
        carried[pressed[:, None], PAST_RATIO[: start.tangents]] = 0.5 * forces[presses, 1:] / forces[presses, :1]
        carried[pressed, at.CLOSED_SHARE] = 1.0
        carried[pressed, at.STATUS] = np.where(start.slip_speeds[pressed] == 0.0, STICKING, SLIDING)
        carried[pressed, at.STUCK_SHARE] = carried[pressed, at.STATUS] == STICKING
    modal, energies = np.stack([arrays.position, first]), np.zeros(at.ENERGIES)
    energies[at.STORED_IN_SPRINGS] = arrays.springs.energy(arrays.position - 0.5 * first)
    energies[at.STORED] = modes.stored_energy(modal) + stored_in_contacts(arrays, carried)
    energies[at.STORED] += energies[at.STORED_IN_SPRINGS]
    springs = arrays.springs.rows @ (3.0 * first - 2.0 * step * arrays.velocity)
    return State(modal, np.zeros_like(modal), carried, springs, energies)


def stored_in_contacts(arrays: Assembly, carried: Array) -> float:
    """Return the energy stored in compliant contacts half a step before the start [J]."""
    energy = 0.0
    for one, own in zip(arrays.contacts, carried, strict=True):
        if one.yields is not None:
            stiffness, exponent, damping, rate = one.yields.numbers
            yields = Yielding(stiffness, exponent, damping, rate, 0.0)
            energy += stored_in(-own[at.LAST_GAP], -own[at.EARLIER_GAP], yields)
    return energy


class _Start:
    """A system about its start, from one step before to one step after."""

    def __init__(self, arrays: Assembly, scheme: Scheme, step: float, blocks: Blocks) -> None:
        times = np.array([-step, 0.0, step])
        self.arrays, self.stepping, self.step = arrays, Stepping(arrays, scheme), step
        self.modes, self.contacts = blocks.modes, blocks.contacts
        self.before, self.after = np.diff(arrays.motion(times, step), axis=0)
        self.factors = arrays.signals.factors(times[1:2], step)[:, 0]
        # Number of tangents of each contact, and the most of any: rows of the tangents that others lack are zero.
        self.counts = np.array([len(one.fixed) - 1 for one in arrays.contacts])
        self.tangents = int(self.counts.max())
        self.travels = self._padded([one.fixed for one in arrays.contacts])[:, 1:]
        if any(one.circle is not None for one in arrays.contacts):
            self.travels = self._padded([np.vstack([one.fixed[:1], one.travel]) for one in arrays.contacts])[:, 1:]
        moved = arrays.motion(times[1:2], step)[0, :, at.TIP_MOTION] + self.travels[:, 0] @ arrays.position
        places = [one.at + shift for one, shift in zip(arrays.contacts, moved.tolist(), strict=True)]
        self.rows = self._rows_at(places)
        self.pull = arrays.springs.forces(arrays.position, arrays.velocity)
        self.force = self.factors @ arrays.loads + self.pull
        terms = _terms(arrays, self.force)
        self.materials = np.array([one.at for one in arrays.contacts]) + self.rows[:, 1] @ arrays.position
        given = zip(arrays.contacts, self.rows, self._heights(self.materials).tolist(), strict=True)
        self.gaps = np.array([_gap(*one, arrays, terms) for one in given])
        self.velocity = arrays.velocity.copy()
        for one in arrays.turning:
            # Increments are relative to the pairs as they are carried round.
            rate = float(one.turning.rate(times[1:2])[0]) * np.array(one.turning.drag)
            first, second = one.pairs.T
            self.velocity[first] += rate * arrays.position[second]
            self.velocity[second] -= rate * arrays.position[first]

    def _padded(self, rows: list[Array]) -> Array:
        """Return rows of all contacts as one array, (contacts, 1 + tangents, modes)."""
        found = np.zeros((len(rows), 1 + self.tangents, self.arrays.mode_count))
        for own, given in zip(found, rows, strict=True):
            own[: len(given)] = given
        return found

    def _rows_at(self, places: list[float]) -> Array:
        """Return the rows of all contacts with the tips at abscissas [m], (contacts, 1 + tangents, modes)."""
        return self._padded([one.rows_at(place) for one, place in zip(self.arrays.contacts, places, strict=True)])

    def _heights(self, places: Array) -> Array:
        """Return the heights of the tracks at places along their material [m]."""
        return np.array([one.height_at(place) for one, place in zip(self.arrays.contacts, places, strict=True)])

    def _slips(self, values: Array) -> Array:
        """Return the displacements along the tangents for modal displacements, (contacts, tangents)."""
        return np.stack([self.rows[:, 1 + k] @ values for k in range(self.tangents)], axis=1)

    def along_rows(self, closed: Array, forces: Array) -> Array:
        """Return the forces of closed contacts, (closed, 1 + tangents), along the rows of `pushes`."""
        signed = forces * [1.0, *[-1.0] * self.tangents]
        return signed[np.arange(1 + self.tangents) <= self.counts[closed, None]]

    @property
    def is_closed(self) -> Array:
        """Whether each contact is closed: rigid ones without a gap, compliant ones if they are indented."""
        rigid = np.array([one.contact.yields is None for one in self.arrays.contacts])
        return (self.gaps < 0.0) | (rigid & (self.gaps == 0.0))

    def increment(self, force: Array) -> Array:
        """Return the increment before the start of motion under constant modal forces."""
        return self.stepping.first_increment(self.step, self.arrays.position, self.velocity, force)

    @cached_property
    def speeds(self) -> Array:
        """Slip velocities of each contact at the start [m/s], exactly zero if round-off, (contacts, tangents)."""
        moved = (self.before + self.after) * 0.5 / self.step
        tip, track = moved[:, TIP[: self.tangents]], moved[:, TRACK[: self.tangents]]
        terms = self.rows[:, 1:] * self.arrays.velocity
        scale = np.abs(terms).sum(axis=2) + (np.abs(tip) + np.abs(track))
        speeds = terms.sum(axis=2) + (tip - track)
        return np.where(np.abs(speeds) > ROUND_OFF * scale, speeds, 0.0)

    @cached_property
    def slip_speeds(self) -> Array:
        """Slip speed of each contact at the start [m/s]."""
        return np.asarray(np.hypot.reduce(self.speeds, axis=1, initial=0.0))

    def _known_ratios(self, carried: Array, normals: Array) -> Array:
        """Return the ratios of tangential to normal force of contacts whose motion determines them, NaN for others.

        `normals` are the forces from which friction takes its pressure [N].
        """
        ratios, laws = np.full(self.speeds.shape, np.nan), self.contacts.laws
        for i, speeds in enumerate(self.speeds):
            whole = float(self.slip_speeds[i])
            law = Law(int(self.contacts.codes[i]), laws, i, laws[i, STATIC], float(normals[i]))
            if law.code == at.IN_SERIES:
                # Its force is known, not the ratio.
                continue
            if self.arrays.contacts[i].contact.has_state_vector:
                states, velocity = Tangents(*carried[i, FRICTION_STATE]), Tangents(*speeds)
                after = state_after(law, states, velocity, self.step)
                middle = Tangents(*0.5 * (np.array(states) + np.array(after)))
                ratios[i] = ratio_of_state(law, middle, velocity)
            elif not set_valued(law.code):
                for k, share in enumerate(speeds / whole if whole else np.zeros(self.tangents)):
                    # Signed by the sense of slip, as bristles may be bent either way.
                    sense = -1.0 if share == -1.0 else 1.0
                    state = carried[i, at.FRICTION_STATE]
                    later = 0.5 * (state + next_state(law, state, sense * whole, self.step))
                    found = state_ratio(law, later, sense * whole)
                    ratios[i, k] = found * (sense * share if whole else float(k == 0))
            elif whole:
                ratios[i] = speeds / whole * sliding_ratio(law, whole)
        return ratios

    def _forces_of_joints(self, carried: Array) -> Array:
        """Return the tangential forces [N] of contacts in series with a joint, NaN for others."""
        forces = np.full(self.speeds.shape, np.nan)
        for i, one in enumerate(self.arrays.contacts):
            if one.contact.tangential_stiffness is not None:
                forces[i] = one.contact.tangential_stiffness * carried[i, FRICTION_STATE][: self.tangents]
        return forces

    def carried(self, first: Array) -> Array:
        """Return the scalars of each contact after a first increment."""
        carried = np.zeros((len(self.arrays.contacts), at.CARRIED))
        some, position = slice(self.tangents), self.arrays.position
        for i, one in enumerate(self.arrays.contacts):
            for k in range(self.tangents):
                start = one.at if k == 0 else 0.0
                carried[i, MATERIAL[k]] = start + self.rows[i, 1 + k] @ position
                carried[i, ABSCISSA[k]] = start + self.travels[i, k] @ position
            carried[i, at.STATUS] = STICKING if self.is_closed[i] and self.slip_speeds[i] == 0.0 else SEPARATED
            states = self.arrays.friction_state[i]
            carried[i, FRICTION_STATE] = states if one.contact.has_state_vector else (states[0], 0.0)
        carried[:, at.TEMPERATURE :] = temperatures_at_start(self.arrays.contacts)
        carried[:, ANCHOR], carried[:, at.LAST_GAP] = carried[:, MATERIAL], self.gaps
        passed = self._slips(first)[:, 0] + self.before[:, at.TIP_MOTION] - self.before[:, at.TRACK_MOTION]
        carried[:, at.LAST_HEIGHT] = self._heights(self.materials)
        carried[:, at.EARLIER_HEIGHT] = self._heights(self.materials - passed)
        risen = carried[:, at.LAST_HEIGHT] - carried[:, at.EARLIER_HEIGHT]
        carried[:, at.EARLIER_GAP] = self.gaps - self.rows[:, 0] @ first - self.before[:, at.GAP_MOTION] + risen
        # Two steps earlier, with the same acceleration.
        speeds = self.gap_speeds
        carried[:, at.EARLIEST_GAP] = 4.0 * carried[:, at.EARLIER_GAP] - 3.0 * self.gaps + 2.0 * self.step * speeds
        advance = self.travels[:, 0] @ first
        carried[:, at.ABSCISSA_BEFORE] = carried[:, at.ABSCISSA] - advance - self.before[:, at.TIP_MOTION]
        slips = self._slips(first) + self.before[:, TIP[some]] - self.before[:, TRACK[some]]
        # A contact at rest has not slipped, for what its forces will turn out to be.
        slips[carried[:, at.STATUS] == STICKING] = 0.0
        # One step earlier, with the same acceleration.
        carried[:, LAST_SLIP[some]], carried[:, EARLIER_SLIP[some]] = slips, 3.0 * slips - 2.0 * self.step * self.speeds
        return carried

    def pushes(self, closed: Array) -> Array:
        """Return the rows of closed contacts, those of the normal and the tangents of one after the other."""
        return np.concatenate([self.rows[i, : 1 + self.counts[i]] for i in closed])

    def pushed(self, closed: Array, forces: Array) -> Array:
        """Return the slip of each contact along the first tangent in a step by the forces of closed contacts [m]."""
        return np.asarray(self.rows[:, 1] @ self.modes.mobility(self.along_rows(closed, forces) @ self.pushes(closed)))

    def forces(self, closed: Array, first: Array, carried: Array, solve: GaussSeidel) -> Array:
        """Return the normal and the tangential forces of closed contacts, shape (closed, 1 + tangents).

        Friction that depends on the pressure takes it from the forces of a pass before.
        """
        normals = np.zeros(len(self.gaps))
        over_pressure = any(self.arrays.contacts[i].contact.law.depends_on_pressure for i in closed)
        for _ in range(PASSES if over_pressure else 1):
            forces = self._forces_under(normals, closed, first, carried, solve)
            before, normals[closed] = normals[closed], forces[:, 0]
            if np.abs(forces[:, 0] - before).max() <= SETTLED * np.abs(before).max():
                break
        return forces

    def _forces_under(self, normals: Array, closed: Array, first: Array, carried: Array, solve: GaussSeidel) -> Array:
        """Do a pass of `forces`, with friction under these normal forces [N]."""
        around, beyond = self._turned(self.arrays.position)
        free = self.modes.free(self.arrays.position + around, first + self._turned(first)[0])
        pushed = self.factors @ self.modes.loads + self.modes.mobility(self.pull[None])[0]
        gap, slip = self._at_first_step(free + pushed)
        gap, slip = gap + self.rows[:, 0] @ around, slip + self._slips(beyond)
        compliance = self._compliance(self.pushes(closed))
        first_rows = np.cumsum([0, *(1 + self.counts[closed])])
        for n, i in zip(first_rows, closed, strict=False):
            if self.arrays.contacts[i].yields is not None:
                # Its force is known; a give that large makes it the result of the solution.
                give = FLAT * compliance[n, n]
                compliance[n, n] += give
                gap[i] = -(compliance[n, n]) * self.pressing[i]
        codes, laws = self.contacts.codes[closed], self.contacts.laws[closed]
        joints = self._forces_of_joints(carried)[closed]
        for i in np.flatnonzero(codes == at.IN_SERIES):
            # A known force moves the contacts, and leaves one without friction.
            n, end = first_rows[i : i + 2]
            moved = -compliance[:, n + 1 : end] @ joints[i, : end - n - 1]
            gap[closed] += moved[first_rows[:-1]]
            for k in range(self.tangents):
                has = self.counts[closed] > k
                slip[closed[has], k] += moved[first_rows[:-1][has] + 1 + k]
            codes[i], laws[i, STATIC] = at.COULOMB, 0.0
        ratios = self._known_ratios(carried, normals)[closed]
        for i in np.flatnonzero(np.isfinite(ratios[:, 0])):
            # With a known ratio, the contact is equivalent to one without friction and with an inclined force.
            n, end = first_rows[i : i + 2]
            inclined = compliance[:, n]
            for ratio, row in zip(ratios[i], range(n + 1, end), strict=False):
                inclined = inclined - ratio * compliance[:, row]
            if inclined[n] > 0.0:
                compliance[:, n], codes[i], laws[i, STATIC] = inclined, at.COULOMB, 0.0
            else:
                ratios[i] = np.nan
        given = gap[closed], slip[closed], compliance, (codes, laws), carried[closed]
        forces = forces_of(*given, self.step, solve, first_rows)
        soft = np.array([self.arrays.contacts[i].yields is not None for i in closed])
        forces[:, 0] = np.where(soft, self.pressing[closed], forces[:, 0])
        forces[:, 1:] = np.where(np.isfinite(ratios), ratios * forces[:, :1], forces[:, 1:])
        forces[:, 1:] = np.where(np.isfinite(joints), joints, forces[:, 1:])
        return forces

    def increment_of_rates(self, closed: Array, forces: Array) -> Array:
        """Return the part of the increment before the start that is due to the change of forces on compliant contacts.

        Under a force with the rate f' the position a step earlier is lower by ``h³ f' / 6 m``. The tangential force of
        a contact changes with its normal force, in the ratio of both.
        """
        ratios = forces[:, 1:] / np.where(forces[:, :1] > 0.0, forces[:, :1], 1.0)
        rates = self.pressing_rates[closed, None]
        rates = self.along_rows(closed, np.concatenate([rates, ratios * rates], axis=1))
        moved = self.modes.mobility(rates @ self.pushes(closed)) * self.step / 6.0
        return np.where(self.arrays.massless, 0.0, moved)

    @cached_property
    def gap_speeds(self) -> Array:
        """Velocity of the gap of each contact at the start [m/s]."""
        imposed = (self.before + self.after)[:, at.GAP_MOTION] * 0.5 / self.step
        steep = [one.slope_at(place) for one, place in zip(self.arrays.contacts, self.materials, strict=True)]
        return np.asarray(self.rows[:, 0] @ self.arrays.velocity + imposed - steep * self.speeds[:, 0])

    @cached_property
    def pressing(self) -> Array:
        """Normal force of each compliant contact at the start [N], 0 for rigid ones."""
        forces = np.zeros(len(self.gaps))
        for i, one in enumerate(self.arrays.contacts):
            if one.yields is not None:
                forces[i] = one.force_at(-float(self.gaps[i]), -float(self.gap_speeds[i]))
        return forces

    @cached_property
    def pressing_rates(self) -> Array:
        """Rate of the elastic part of that force [N/s]."""
        rates = np.zeros(len(self.gaps))
        for i, one in enumerate(self.arrays.contacts):
            if one.yields is not None and self.pressing[i] > 0.0:
                rates[i] = -one.stiffness_at(-float(self.gaps[i])) * self.gap_speeds[i]
        return rates

    def _turned(self, modal: Array) -> tuple[Array, Array]:
        """Return the change of modal values by turning in the first step, and the same relative to the material."""
        around, passed = np.zeros((2, modal.size))
        for one in self.arrays.turning:
            angle = float(one.turning.angles(np.array([0.0, self.step]), self.step)[0])
            around += one.turned(modal, angle * np.array(one.turning.drag))
            passed += one.turned(modal, angle * np.array(one.turning.order))
        return around, around - passed

    def _at_first_step(self, increments: Array) -> tuple[Array, Array]:
        """Return gaps and slips after the first step without contact force, at the new places of the tips."""
        tips = self.after[:, at.TIP_MOTION]
        there = self._rows_at(
            [
                one.at + travel @ (self.arrays.position + increments) + moved
                for one, travel, moved in zip(self.arrays.contacts, self.travels[:, 0], tips, strict=True)
            ]
        )
        # The change of the rows is small: a separate difference keeps its digits.
        travelled = (there - self.rows) @ (self.arrays.position + increments)
        for i, one in enumerate(self.arrays.contacts):
            if one.circle is not None:
                # The slip is relative to the material, which has the same rows before and after.
                travelled[i, 1:] = (there[i, 1:] - self.rows[i, 1:]) @ increments
        gaps = self.gaps + self.rows[:, 0] @ increments + travelled[:, 0] + self.after[:, at.GAP_MOTION]
        some = slice(self.tangents)
        slips = self._slips(increments) + travelled[:, 1:] + self.after[:, TIP[some]] - self.after[:, TRACK[some]]
        gaps -= self._heights(self.materials + slips[:, 0]) - self._heights(self.materials)
        return gaps, slips

    def _compliance(self, pushes: Array) -> Array:
        """Return the displacements of rows after the first step for constant unit forces on them."""
        still = np.zeros(self.arrays.mode_count)
        none = np.zeros_like(pushes)
        increments = self.stepping.first_increment(self.step, none, none, pushes)
        answers = [
            self.modes.free(still, first) + self.modes.mobility(push)
            for push, first in zip(pushes, increments, strict=True)
        ]
        return np.ascontiguousarray(pushes @ np.array(answers).T)


def _terms(arrays: Assembly, force: Array) -> Array:
    """Return the size of the terms of modal positions: their values, and the deflections by the loads alone."""
    size, stiffness = arrays.coupled, np.where(arrays.massless, 1.0, arrays.angular_frequency) ** 2
    free = stiffness == 0.0
    deflected = np.where(free, 0.0, force / np.where(free, 1.0, stiffness))
    if not arrays.position.any():
        return np.zeros_like(force)
    deflected[:size] = np.linalg.pinv(arrays.stiffness, rcond=STIFFLESS, hermitian=True) @ force[:size]
    return np.hypot(arrays.position, deflected)


def _gap(one: ContactRows, rows: Array, height: float, arrays: Assembly, terms: Array) -> float:
    """Return the gap of a contact over a height of its track at the start, exactly zero if it is closed.

    A displacement has the rounding error of the largest term of its body, in any direction of the contact.
    """
    gap = float(one.height - height + rows[0] @ arrays.position)
    spans = [slice(*span) for span in arrays.spans.values()] if terms.any() else []
    felt = sum(float(np.linalg.norm(rows[0, span]) * np.linalg.norm(terms[span])) for span in spans)
    scale = one.gap + abs(height) + felt
    if one.contact.yields is not None:
        return gap if abs(gap) > ROUND_OFF * scale else 0.0
    if gap < -ROUND_OFF * scale:
        raise ArgumentError("gap", "leave the bodies apart at the start", got=f"an overlap of {-gap:.3g} m")
    return gap if gap > ROUND_OFF * scale else 0.0
