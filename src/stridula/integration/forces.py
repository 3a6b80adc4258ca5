"""Forces of closed contacts in one step, solved as in the march."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._kernels.contact.slipping import STICKING
from .._kernels.contact.solves import solve
from .._kernels.contacts.sweeps import solve_closed
from .._kernels.lanes.operations import Runs
from .._kernels.lanes.vectors import LANES
from .._kernels.layout import columns as at
from .._kernels.layout.contact_values import Before, Compliance, Free, Law
from .._kernels.layout.laws import STATIC
from .._kernels.layout.parts import Contacts, Sizes, Timing
from ..arrays import Array
from ..lowering.packing import PLAIN, aligned, columns, compliance_in_blocks, room_to_solve, side_by_side
from .contact_solve import GaussSeidel

FREE_SLIPS = [at.FREE_SLIP, at.FREE_SLIP_B]
FORCES = [at.NORMAL_NOW, at.TANGENTIAL_NOW, at.TANGENTIAL_NOW_B]


class Solved(NamedTuple):
    """Contacts solved in one step.

    Attributes
    ----------
    now : ndarray, shape (contacts, numbers)
        State of each in the step.
    sweeps : int
        Number of sweeps, or of steps of Newton's method.
    error : float
        Error of the forces, relative to the largest.
    """

    now: Array
    sweeps: int
    error: float

    def forces(self, tangents: int) -> Array:
        """Return the normal and the tangential forces of each [N], shape (contacts, 1 + tangents)."""
        return np.asarray(self.now[:, FORCES[: 1 + tangents]])


def forces_of(
    gaps: Array,
    slips: Array,
    compliance: Array,
    laws: tuple[Array, Array],
    carried: Array,
    step: float,
    solve: GaussSeidel,
    first_rows: Array | None = None,
) -> Array:
    """Return the normal and the tangential forces of each contact [N], shape (contacts, 1 + tangents).

    Parameters
    ----------
    gaps : ndarray, shape (contacts,)
        Gap at the end of a step, without contact forces [m].
    slips : ndarray, shape (contacts, tangents)
        Slips in it [m]; those of tangents that a contact does not have are not used.
    compliance : ndarray, shape (rows, rows)
        Displacements along normal and tangents of each contact for unit forces on each [m/N].
    laws : tuple of ndarray
        Codes of the friction laws, shape (contacts,), and their parameters, a row for each contact.
    carried : ndarray, shape (contacts, scalars)
        Scalars of each contact in the march.
    step : float
        Time step [s].
    solve : GaussSeidel
        Settings of the simultaneous solution.
    first_rows : ndarray of int, shape (contacts + 1,), optional
        First row of each contact, and the end of the last; by default all have the same tangents.
    """
    tangents = slips.shape[1]
    if len(compliance) == 2:
        alone = _force_of_one(float(gaps[0]), float(slips[0, 0]), compliance, laws, carried[0], step)
        return np.pad(alone, ((0, 0), (0, tangents - 1)))
    return solved(gaps, slips, compliance, laws, carried, step, solve, first_rows).forces(tangents)


def solved(
    gaps: Array,
    slips: Array,
    compliance: Array,
    laws: tuple[Array, Array],
    carried: Array,
    step: float,
    solve: GaussSeidel,
    first_rows: Array | None = None,
    *,
    constants: Array | None = None,
) -> Solved:
    """Return contacts solved as in the march, rigid ones if no `constants` of theirs are given; see `forces_of`."""
    count, tangents = slips.shape
    if first_rows is None:
        first_rows = (1 + tangents) * np.arange(count + 1)
    if constants is None:
        constants = np.zeros((count, at.CONTACT_CONSTANTS))
        constants[:, at.AT_REST] = laws[1][:, STATIC]
    space, rows = bool((np.diff(first_rows) > 2).any()), int(first_rows[-1])
    per_block = 1 if PLAIN else LANES
    sizes = Sizes(0, 0, per_block, count, -(-rows // per_block), rows, 0, False, False, space)
    now = np.zeros((count, at.IN_STEP))
    now[:, at.FREE_GAP], now[:, FREE_SLIPS[:tangents]] = gaps, slips
    contacts = Contacts(
        *laws,
        first_rows,
        columns(side_by_side([constants.ravel()])),
        columns(aligned(3, 1)),
        compliance_in_blocks([compliance], sizes, per_block),
        *room_to_solve(sizes, per_block),
        columns(side_by_side([now.ravel()])),
        columns(aligned(count * at.SUMS, 1)),
        np.zeros((count, 0)),
    )
    timing, touching = Timing(1, step, solve.tolerance, solve.sweeps), 1.0
    carried = columns(side_by_side([carried.ravel()]))
    made, error = solve_closed(space or None, contacts, carried, touching, sizes, timing, Runs(0, 1, 0.0))
    return Solved(contacts.now.reshape(count, at.IN_STEP), int(made), float(error))


def _force_of_one(
    gap: float, slip: float, compliance: Array, laws: tuple[Array, Array], carried: Array, step: float
) -> Array:
    """Return the forces of a single contact, without the solution of several, which would have to be compiled first."""
    away = carried[at.MATERIAL] - carried[at.ANCHOR] if carried[at.STATUS] == STICKING else 0.0
    slips, forces = (at.LAST_SLIP, at.EARLIER_SLIP), (at.LAST_NORMAL, at.LAST_TANGENTIAL)
    before = (at.STATUS, *slips, at.FRICTION_STATE, *forces, at.PAST_RATIO)
    free = Free(gap, slip, float(away), Compliance(*map(float, compliance.ravel())), 0.0)
    law = Law(int(laws[0][0]), laws[1], 0, float(laws[1][0, STATIC]), 0.0)
    touch = solve(free, law, Before(*(float(carried[one]) for one in before)), step)
    return np.array([[touch.normal, touch.tangential]])
