"""Several contacts in one step: block Gauss-Seidel over the exact solve of one."""

import math

import numba
import numpy as np

from . import layout as at
from .contact import SEPARATED, SLIDING, STICKING, solve_contact
from .friction import STRICT, set_valued

# Sweeps between two direct solves of the states that the sweeps have found.
SWEEPS_PER_DIRECT_SOLVE = 8
# Sweeps after which a contact that has broken away in this step is no longer held by its static coefficient.
PATIENCE = 24
# Change of a force by rounding alone, relative to the largest.
ROUND_OFF = 1e-14


@numba.njit(inline="always", **STRICT)
def displacement(compliance, row, j, forces):
    """Return the relative displacement along a row of the compliance that contact `j` makes."""
    return compliance[row, 2 * j] * forces[j, 0] - compliance[row, 2 * j + 1] * forces[j, 1]


@numba.njit(inline="always", **STRICT)
def own_compliance(compliance, i):
    """Return the compliance of contact `i` for its own forces, row by row."""
    n, t = 2 * i, 2 * i + 1
    return compliance[n, n], compliance[n, t], compliance[t, n], compliance[t, t]


@numba.njit(inline="always", **STRICT)
def strayed(carried, i):
    """Return how far contact `i` is from the anchor of its stick."""
    if int(carried[i, at.STATUS]) != STICKING:
        return 0.0
    return carried[i, at.MATERIAL] - carried[i, at.ANCHOR]


@numba.njit(**STRICT)
def solve_one(i, gap, slip, w, contacts, laws, carried, let_go, step):
    """Return (normal force, tangential force, status, jammed) of contact `i`.

    `slip` is how far the tip moves along the track's material in the step without contact force.
    """
    before = (
        carried[i, at.STATUS],
        carried[i, at.LAST_SLIP],
        carried[i, at.EARLIER_SLIP],
        carried[i, at.FRICTION_STATE],
        carried[i, at.LAST_NORMAL],
        carried[i, at.LAST_TANGENTIAL],
    )
    law = int(contacts[i, at.LAW])
    return solve_contact(gap, slip, strayed(carried, i), w, law, laws, i, before, let_go, step)


@numba.njit(**STRICT)
def solve_all(gaps, slips, compliance, contacts, laws, carried, step, tolerance, sweeps, forces, statuses, jammed):
    """Solve every contact in turn until no force changes; return (sweeps made, error estimated from the changes).

    `forces` holds (normal, tangential) of every contact, on entry those to start from. The compliance, shape
    (2 contacts, 2 contacts), is ordered normal, tangential for each contact. The error is relative to the largest
    force. Sweeps that only creep towards the forces of states they have found are helped by a direct solve. A contact
    that was held and breaks away may find no consistent state in which it could be held again: it then lets go.
    """
    count = gaps.size
    let_go = np.zeros(count, dtype=np.bool_)
    broke = np.zeros(count, dtype=np.bool_)
    before, error = math.inf, math.inf
    for sweep in range(sweeps):
        change = largest = 0.0
        settled = True
        for i in range(count):
            gap, slip = gaps[i], slips[i]
            for j in range(count):
                if j != i:
                    gap += displacement(compliance, 2 * i, j, forces)
                    slip += displacement(compliance, 2 * i + 1, j, forces)
            status = statuses[i]
            normal, tangential, statuses[i], jammed[i] = solve_one(
                i,
                gap,
                slip,
                own_compliance(compliance, i),
                contacts,
                laws,
                carried,
                let_go[i],
                step,
            )
            settled = settled and statuses[i] == status
            broke[i] = broke[i] or statuses[i] == SLIDING
            change = max(change, abs(normal - forces[i, 0]), abs(tangential - forces[i, 1]))
            largest = max(largest, normal, abs(tangential))
            forces[i, 0], forces[i, 1] = normal, tangential
        if count == 1:
            return 1, 0.0
        if change <= ROUND_OFF * largest:
            return sweep + 1, (change / largest if largest > 0.0 else 0.0)
        # The changes of a linear iteration fall by a constant factor, which tells what is still to come.
        error = math.inf
        if change < before < math.inf:
            error = change / largest * change / (before - change)
        if error <= tolerance:
            return sweep + 1, error
        before = change
        if settled and (sweep + 1) % SWEEPS_PER_DIRECT_SOLVE == 0:
            solve_states(gaps, slips, compliance, contacts, carried, forces, statuses)
            before = math.inf
        if sweep + 1 == PATIENCE:
            for i in range(count):
                let_go[i] = broke[i]
    return sweeps, error


@numba.njit(**STRICT)
def solve_states(gaps, slips, compliance, contacts, carried, forces, statuses):
    """Put the forces of given states into `forces`, ratios of sliding contacts kept, unless the states admit none."""
    count = gaps.size
    size = 2 * count
    matrix, right = np.zeros((size, size)), np.zeros(size)
    for i in range(count):
        n, t = 2 * i, 2 * i + 1
        if statuses[i] == SEPARATED:
            matrix[n, n] = matrix[t, t] = compliance[n, n]
            continue
        for j in range(count):
            matrix[n, 2 * j], matrix[n, 2 * j + 1] = compliance[n, 2 * j], -compliance[n, 2 * j + 1]
        right[n] = -gaps[i]
        if statuses[i] == STICKING and set_valued(int(contacts[i, at.LAW])):
            for j in range(count):
                matrix[t, 2 * j], matrix[t, 2 * j + 1] = compliance[t, 2 * j], -compliance[t, 2 * j + 1]
            right[t] = -slips[i] - strayed(carried, i)
        else:
            ratio = forces[i, 1] / forces[i, 0] if forces[i, 0] > 0.0 else 0.0
            matrix[t, n], matrix[t, t] = -ratio * compliance[t, t], compliance[t, t]
    if not eliminate(matrix, right):
        return
    for i in range(count):
        if right[2 * i] < 0.0:
            return
    for i in range(count):
        forces[i, 0], forces[i, 1] = right[2 * i], right[2 * i + 1]


@numba.njit(**STRICT)
def eliminate(matrix, right):
    """Solve a linear system in place by Gauss's elimination with row pivots; return whether it is regular."""
    size = right.size
    smallest = 1e-13 * np.abs(matrix).max()
    for k in range(size):
        pivot = k + np.argmax(np.abs(matrix[k:, k]))
        if not abs(matrix[pivot, k]) > smallest:
            return False
        for j in range(size):
            matrix[k, j], matrix[pivot, j] = matrix[pivot, j], matrix[k, j]
        right[k], right[pivot] = right[pivot], right[k]
        for i in range(k + 1, size):
            factor = matrix[i, k] / matrix[k, k]
            for j in range(k, size):
                matrix[i, j] -= factor * matrix[k, j]
            right[i] -= factor * right[k]
    for k in range(size - 1, -1, -1):
        for j in range(k + 1, size):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]
    return True
