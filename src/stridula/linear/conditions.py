"""Inequalities of an equilibrium: forces press, open contacts have a gap, sliding goes on, friction can hold."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

import numpy as np
import scipy.linalg

from ..arrays import Array
from ..contact.stiffness import indentation_under
from .balance import (
    ROUND_OFF,
    Balance,
    held_rows,
    largest_acceleration,
    largest_force,
    motions_held,
    moved_by,
    rank,
    rigid_rows,
)
from .structure import SEPARATED, SLIDING, STICKING, UNMOVED, Structure

# Rounding error of a gap, relative to the displacements of the modes that add up to it.
ROUNDING = 1e-14
# Largest number of contacts with which all minors are checked.
MOST_CONTACTS = 10


def margins_of(structure: Structure, at: Balance) -> Array:
    """Return the force of each closed contact and the gap of each open one, relative, below zero where violated.

    A contact that opens by a rigid motion has a gap in any case, one that such a motion closes has none. Where no force
    of a stiffness was found that fits its indentation, the misfit is a violation.

    Parameters
    ----------
    structure : Structure
        The system.
    at : Balance
        Balance of forces.
    """
    force = max(float(np.abs(at.normal_force).max()), largest_force(structure)) or 1.0
    gaps = at.opening / _length(structure, at)
    for motion in _opening_motions(structure, at):
        gaps = np.where(np.abs(motion) > ROUND_OFF, motion, gaps)
    closed = np.array([one != SEPARATED for one in at.status])
    pushes = np.minimum(at.normal_force / force, -_misfit(structure, at) / _length(structure, at))
    return np.where(closed, pushes, gaps) + ROUND_OFF


def fits(structure: Structure, at: Balance) -> bool:
    """Return whether every stiffness is indented as its force asks, where it pushes: whether forces were found.

    Parameters
    ----------
    structure : Structure
        The system.
    at : Balance
        Balance of forces.
    """
    return bool((_misfit(structure, at) <= ROUND_OFF * _length(structure, at)).all())


def _misfit(structure: Structure, at: Balance) -> Array:
    """Return the distance [m] of closed contacts with a stiffness from the indentation under their force, if they push.

    Zero for all others.
    """
    missed = np.zeros(len(at.status))
    for k, contact in enumerate(structure.system.contacts):
        if contact.yields is not None and at.status[k] != SEPARATED and at.normal_force[k] > 0.0:
            missed[k] = abs(at.opening[k] + indentation_under(contact.yields, float(at.normal_force[k])))
    return missed


def _opening_motions(structure: Structure, at: Balance) -> tuple[Array, Array]:
    """Return relative accelerations and velocities at which rigid motions open contacts; the latter matter more."""
    gains = at.opening_acceleration / (largest_acceleration(structure) or 1.0)
    rows = np.array([line.normal for line in structure.lines])
    rates = structure.rates[1] + rows @ structure.following(at.status)
    return gains, rates / (float(np.abs(structure.rates).max()) or 1.0)


def is_leaving(structure: Structure, at: Balance) -> bool:
    """Return whether a rigid motion opens a contact more and more.

    Parameters
    ----------
    structure : Structure
        The system.
    at : Balance
        Balance of forces.
    """
    opened = np.array([one == SEPARATED for one in at.status])
    return any(bool((motion[opened] > ROUND_OFF).any()) for motion in _opening_motions(structure, at))


def _length(structure: Structure, at: Balance) -> float:
    """Return the size of the openings of contacts [m], by which their rounding is judged."""
    largest = float(np.abs(np.concatenate([at.opening, at.opening - structure.gaps, structure.gaps])).max())
    return max(largest, ROUNDING / ROUND_OFF * float(np.max(at.terms))) or 1.0


def stopping(structure: Structure, at: Balance) -> list[int]:
    """Return sliding contacts that friction stops, empty if all slide on.

    A contact that friction slows down is returned alone, since others may slide on once it sticks; those that nothing
    moves are returned together, without those that the others also hold.

    Parameters
    ----------
    structure : Structure
        The system.
    at : Balance
        Balance of forces.
    """
    least, still = ROUND_OFF * largest_acceleration(structure), list[int]()
    held: Array | None = None
    for k, status in enumerate(at.status):
        if status != SLIDING or not at.ratio[k] > 0.0:
            continue
        gains = at.slip_acceleration[k] * at.sense[k]
        if gains > least or (at.slip_velocity[k] and gains >= -least):
            continue
        held = motions_held(structure, at.status) if held is None else held
        free = moved_by(structure.lines[k].tangent, held)
        if not free.any() or (still and gains < -least):
            continue
        if gains < -least:
            return [k]
        still.append(k)
        held = np.vstack([held, free])
        across = moved_by(structure.lines[k].across, held)
        held = np.vstack([held, across]) if across.any() else held
    return still


def broken(structure: Structure, at: Balance) -> list[str]:
    """Return each inequality that a balance of forces violates, in words.

    Parameters
    ----------
    structure : Structure
        The system.
    at : Balance
        Balance of forces.
    """
    names, words = structure.system.contact_names, []
    if not np.isfinite(at.normal_force).all():
        return ["no forces balance"]
    margins, length = margins_of(structure, at), ROUND_OFF * _length(structure, at)
    for k in np.flatnonzero(~(margins >= 0.0)).tolist():
        if at.status[k] != SEPARATED and at.normal_force[k] > 0.0:
            words.append(f"the indentation of {names[k]} does not fit its force")
        elif at.status[k] != SEPARATED:
            words.append(f"{names[k]} pulls with {-float(at.normal_force[k]):.3g} N")
        elif at.opening[k] < -length:
            words.append(f"{names[k]} is open {-float(at.opening[k]):.3g} m below the surface")
        else:
            words.append(f"{names[k]} is open, but a rigid motion closes it")
    for k, status in enumerate(at.status):
        if status != SEPARATED and structure.is_rigid(k) and abs(float(at.opening[k])) > length:
            words.append(f"{names[k]} is closed at a distance of {float(at.opening[k]):.3g} m")
    words += [f"friction stops {names[k]}" for k in stopping(structure, at)]
    return words + beyond_friction(structure, at)


def beyond_friction(structure: Structure, at: Balance) -> list[str]:
    """Return each sticking contact that friction cannot hold, in words.

    Parameters
    ----------
    structure : Structure
        The system.
    at : Balance
        Balance of forces.
    """
    least = ROUND_OFF * float(np.abs([at.normal_force, at.tangential_force]).max(initial=0.0))
    words = []
    for k, contact in enumerate(structure.system.contacts):
        if at.status[k] == STICKING:
            most = float(contact.law.under(float(at.normal_force[k])).coefficient_at(0.0)) * float(at.normal_force[k])
            pulled = float(np.hypot(at.tangential_force[k], at.lateral_force[k]))
            if pulled > most + least:
                name = structure.system.contact_names[k]
                words.append(f"{name} sticks with {pulled:.3g} N of at most {most:.3g} N")
    return words


def slides_on(structure: Structure, status: Sequence[str], share: Array) -> bool:
    """Return whether contact forces exist for every motion: no impulse on a sliding contact jams it (Painlevé).

    With the instantaneous compliance W of the contacts, ``W_NN - share W_NT`` must have positive principal minors. If
    residual shapes respond instantaneously, the response of modes is negligible.

    Parameters
    ----------
    structure : Structure
        The system.
    status : sequence of str
        Status of each contact.
    share : ndarray, shape (contacts,)
        Signed tangential over normal force of sliding contacts [1].
    """
    held, pushes, closed, stuck = held_rows(structure, status, share)
    # Compliant contacts respond to any impulse.
    rigid = rigid_rows(structure, closed, stuck)
    size = sum(structure.is_rigid(k) for k in closed)
    held, pushes = held[rigid], pushes[rigid]
    kept = _independent(held)
    held, pushes, size = held[kept], pushes[kept], sum(row < size for row in kept)
    whole = held * structure.promptness @ pushes.T
    compliance = whole[:size, :size]
    if len(held) > size:
        compliance = compliance - whole[:size, size:] @ np.linalg.solve(whole[size:, size:], whole[size:, :size])
    # With many contacts only the smallest minors and the determinant are checked, as their number doubles with each.
    sizes = range(1, size + 1) if size <= MOST_CONTACTS else (1, size)
    chosen = [list(some) for count in sizes for some in combinations(range(size), count)]
    return all(np.linalg.slogdet(compliance[np.ix_(some, some)])[0] > 0.0 for some in chosen)


def _independent(rows: Array) -> list[int]:
    """Return the numbers of linearly independent rows that span the others: all of them, if none depends on others."""
    if rank(rows) == len(rows):
        return list(range(len(rows)))
    sizes = np.linalg.norm(rows, axis=1, keepdims=True)
    triangle, order = scipy.linalg.qr((rows / sizes).T, mode="r", pivoting=True)
    size = np.abs(np.diag(triangle))
    return sorted(order[: int(np.sum(size >= UNMOVED * size[0]))].tolist())
